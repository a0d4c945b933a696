//! What is refused, and with which words.

use teeter_scenario::decode::text;

use crate::{ROCKING, SHORT, findings, read};

#[test]
fn mistakes_are_told_at_once_in_the_order_of_the_file() {
    let source = "[time]\nend = 2\nstep = '1 kg'\nthetaa = 0.5\n[world]\ngravity = 'down'\n\
                  [contact.c]\nbetween = ['a', 'b']\nfriction = -0.1\nrestitution = 1.2\n";
    assert_eq!(
        findings(source, &[]),
        [
            "2:7 time.end: a time needs its unit, got a bare number",
            "3:8 time.step: a time (s) is expected, got a mass (kg)",
            "4:1 time.thetaa: unknown key",
            "6:11 world.gravity: an acceleration with its unit is expected, got a text that doesn't start with a number",
            "9:12 contact.c.friction: must be at least 0",
            "10:15 contact.c.restitution: must lie in [0, 1]",
        ]
    );
    let found = read(source, &[]).unwrap_err();
    assert_eq!(found.0[2].did_you_mean.as_deref(), Some("theta"));
    assert_eq!(found.0[1].written.as_deref(), Some("'1 kg'"));
    assert_eq!(&source[found.0[1].span.clone().unwrap()], "'1 kg'");
}

#[test]
fn a_diagnostic_names_file_place_key_value_rule_and_remedy() {
    let source = ROCKING.replace("\"0.15 cm\"", "\"-0.0015 m\"");
    let found = read(&source, &[]).unwrap_err();
    assert_eq!(
        found.to_string(),
        "error: scene.toml:22:13: beam.table.thickness = \"-0.0015 m\": must be greater than 0 m\n  \
         help: a length with its unit, such as \"1.5 mm\""
    );
}

#[test]
fn keys_given_twice_name_both_lines() {
    let source = "[time]\nend = '1 s'\nstep = '1 ms'\nend = '2 s'\n[time]\n[beam.t]\n\
                  damping_ratio = { mode = 1, mode = 2, ratio = 0.1 }\n";
    let found = findings(source, &[]);
    assert!(found.contains(&"4:1 time.end: given twice, first on line 2".to_owned()), "{found:#?}");
    assert!(found.contains(&"5:2 time: given twice, first on line 1".to_owned()), "{found:#?}");
    assert!(found.contains(&"7:29 beam.t.damping_ratio.mode: given twice".to_owned()), "{found:#?}");
}

#[test]
fn missing_keys_are_told_at_the_header_of_their_table() {
    let source = format!("{SHORT}[material.steel]\nyoungs_modulus = '210 GPa'\n");
    assert_eq!(findings(&source, &[]), ["4:1 material.steel.density: missing"]);
    assert_eq!(findings("[world]\n", &[]), ["time: the table [time] is missing"]);
    assert_eq!(findings(" \n# nothing\n", &[]), [": the file contains no scene: it is empty"]);
}

#[test]
fn syntax_errors_are_told_with_the_rest_and_do_not_make_keys_missing() {
    let source = "[time]\nend = 0.5 s\nstep\ntheta = 2\n[world]\ngravity = 9.81\n";
    assert_eq!(
        findings(source, &[]),
        [
            "2:7 time.end: a value with a unit is written in quotes, got 0.5 s",
            "3:5 time.step: a key without a value",
            "4:9 time.theta: must lie in [0, 1]",
            "6:11 world.gravity: an acceleration needs its unit, got a bare number",
        ]
    );
    let cut = "[time]\nend = '1 s'\nstep = '1 m";
    assert_eq!(findings(cut, &[]).len(), 1);
    assert_eq!(findings("[time\nend = '1 s'\n", &[]), ["1:6 : unclosed table, expected `]`"]);
}

#[test]
fn names_are_of_few_letters_and_unique_over_bodies() {
    let block = "material = 'm'\nwidth = '1 m'\nheight = '1 m'\ndepth = '1 m'\n";
    let beam = "material = 'm'\nspan = '1 m'\nwidth = '1 m'\nthickness = '1 m'\nelements = 1\n";
    let source = format!("{SHORT}[block.a]\n{block}[beam.a]\n{beam}[block.ground]\n{block}[block.'../x']\n{block}");
    assert_eq!(
        findings(&source, &[]),
        [
            "4:8 block.a: the name `a` is already used by beam.a on line 9",
            "15:8 block.ground: the name `ground` is reserved for the ground",
            "20:8 block.\"../x\": a name may contain only letters (a-z, A-Z), digits, `_` and `-`",
        ]
    );
}

#[test]
fn a_word_in_place_of_an_inline_table_is_refused() {
    let found = findings(ROCKING, &[("ground.profile", "hills.csv")]);
    assert_eq!(found.len(), 1, "{found:#?}");
    assert!(found[0].ends_with("ground.profile: this is a table, got a text"), "{found:#?}");
}

#[test]
fn a_table_in_the_wrong_shape_is_refused() {
    for source in ["beam = 3", "[beam]\nspan = '1 m'", "[[beam]]", "beam = []", "time = 1"] {
        let found = findings(&format!("{source}\n"), &[]);
        assert!(!found.is_empty(), "{source}");
    }
    assert_eq!(
        findings(&format!("{SHORT}[beam]\nspan = '1 m'\nwidth = '1 m'\n"), &[]),
        ["5:8 beam.span: each beam has a name and a table of its own"]
    );
}

#[test]
fn absurd_files_are_refused_fast_and_without_a_crash() {
    let deep = 100_000;
    // The thread's own time: a busy machine is no failure.
    let start = cpu_time::ThreadTime::now();
    for source in [
        format!("x = {}", "[".repeat(deep)),
        format!("x = {}", "{a=".repeat(deep)),
        format!("x = {}1{}", "[".repeat(deep), "]".repeat(deep)),
        format!("[{}]", vec!["a"; deep].join(".")),
        format!("{} = 1", vec!["a"; deep].join(".")),
        format!("{} = 1", "k".repeat(1_000_000)),
        format!("[block.{}]", "k".repeat(1_000_000)),
        format!("title = \"{}", "k".repeat(1_000_000)),
        "k\n".repeat(100_000),
        "k = 1\n".repeat(20_000),
        "\u{1}=,[}".repeat(50_000),
        "\0".to_owned(),
        "x".repeat(5 << 20),
    ] {
        let Err(found) = read(&source, &[]) else {
            panic!("accepted {} …", &source[..20.min(source.len())]);
        };
        let printed = found.to_string();
        assert!(printed.len() < 100_000);
        assert!(!printed.contains(|c: char| c.is_control() && c != '\n'));
    }
    // Thirteen files of about a megabyte each, unoptimised; each alone takes well under a second.
    assert!(start.elapsed().as_secs() < 60);
    assert!(text(&[0x89, b'P', b'N', b'G'], "x.toml").is_err());
    assert_eq!(text(b"a = 1", "x.toml"), Ok("a = 1"));
}
