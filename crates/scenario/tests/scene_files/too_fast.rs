//! What is too fast for the step, or does nothing: warned of, where it stands; and what is well is
//! not.

use teeter_scenario::load_with;
use teeter_scenario::resolve::Resolved;

const BLOCK: &str = "[time]\nend = '0.5 s'\nstep = '1 ms'\n[ground]\n[material.m]\ndensity = '1000 kg/m^3'\nyoungs_modulus = '10 GPa'\n\
    [block.b]\nmaterial = 'm'\nwidth = '10 cm'\nheight = '10 cm'\ndepth = '10 cm'\non = 'ground'\nat = '0 m'\n\
    [contact.c]\nbetween = ['b', 'ground']\nfriction = 0.5\n";

const PUSH: &str = "[force.f]\non = 'b'\nforce = ['3 N', '0 N']\nsignal = 's'\n[signal.s]\n";

fn resolved(text: &str, file: &str) -> Resolved {
    load_with(text.as_bytes(), "scene.toml", "scene", &[], &mut |_| Ok(file.as_bytes().to_vec())).unwrap()
}

/// Paths and rules of the warnings of the block with these lines.
fn warned(more: &str, file: &str) -> Vec<(String, String)> {
    let found = resolved(&format!("{BLOCK}{more}"), file);
    found.warnings.into_iter().map(|warning| (warning.path, warning.rule)).collect()
}

#[track_caller]
fn one(more: &str, file: &str, path: &str, part: &str) {
    let found = warned(more, file);
    let [(at, rule)] = found.as_slice() else { panic!("{more}: {found:?}") };
    assert!(at == path && rule.contains(part), "{more}: {at}: {rule}");
}

#[track_caller]
fn none(more: &str, file: &str) {
    assert_eq!(warned(more, file), [], "{more}");
}

fn table(rows: impl Iterator<Item = (f64, f64)>) -> String {
    rows.map(|(t, y)| format!("{t:?},{y:?}\n")).collect()
}

#[test]
fn signals_that_swing_faster_than_the_step_are_warned_of() {
    let push = |signal: &str| format!("{PUSH}{signal}");
    let half = |lasts: &str| push(&format!("shape = 'half-sine'\nstart = '0.1002 s'\nduration = '{lasts}'"));
    one(&half("0.6 ms"), "", "signal.s.duration", "600 us, 0.60 steps");
    one(&half("4.9 ms"), "", "signal.s.duration", "4.90 steps");
    none(&half("5 ms"), "");
    for shape in ["harmonic", "one-sine", "ricker\"\npeak = \"0.2 s"] {
        let of = |frequency: &str| push(&format!("shape = \"{shape}\"\n{frequency}"));
        one(&of("frequency = '1000 Hz'"), "", "signal.s.frequency", "1.00 steps");
        one(&of("period = '9.9 ms'"), "", "signal.s.period", "9.90 steps");
        none(&of("frequency = '100 Hz'"), "");
    }
    // Motions alike.
    let ground = "[signal.s]\nshape = 'harmonic'\nfrequency = '1000 Hz'\n";
    let moving =
        BLOCK.replace("[ground]", "[ground]\nmotion = { acceleration = ['50 m/s^2', '0 m/s^2'], signal = 's' }");
    let found = resolved(&format!("{moving}{ground}"), "").warnings;
    assert!(matches!(found.as_slice(), [one] if one.path == "signal.s.frequency"), "{found:?}");
}

#[test]
fn tables_with_more_in_a_step_than_it_shows_are_warned_of() {
    let push = format!("{PUSH}shape = 'table'\nfile = 'push.csv'\n");
    let zigzag = |rows: u32, every: f64| table((0..=rows).map(move |k| (f64::from(k) * every, f64::from(k % 2))));
    one(&push, &zigzag(1000, 0.5e-3), "signal.s.file", "as close as 500 us");
    none(&push, &zigzag(500, 1e-3));
    // A jump, and fine rows of something slow, lose nothing.
    none(&push, "0,0\n0.1005,0\n0.1005000001,1\n1,1\n");
    none(&push, &table((0..=5000).map(|k| f64::from(k) * 1e-4).map(|t| (t, (6.0 * t).sin()))));
    // Of milliseconds taken for seconds.
    let slow = table((0..=600).map(|k| (f64::from(k), f64::from(k).sin())));
    let found = resolved(&format!("{BLOCK}{push}"), &slow);
    assert!(found.warnings.is_empty() && found.notes.len() == 1, "{:?} {:?}", found.warnings, found.notes);
    assert!(found.notes[0].rule.contains("extends to 600 s, 1200 times the run"), "{}", found.notes[0].rule);
    let found = resolved(&format!("{BLOCK}{push}"), &format!("t [ms], F\n{slow}"));
    assert!(found.notes.is_empty(), "with its unit it is no longer than the run");
}

#[test]
fn blocks_and_grounds_that_turn_far_in_a_step_are_warned_of() {
    let spun =
        |spin: &str| BLOCK.replace("on = 'ground'\nat = '0 m'", &format!("position = ['0 m', '1 m']\nspin = '{spin}'"));
    let found = resolved(&spun("-100 rad/s"), "").warnings;
    assert!(
        matches!(found.as_slice(), [one] if one.path == "block.b.spin" && one.rule.contains("0.10 rad")),
        "{found:?}"
    );
    assert!(resolved(&spun("99 rad/s"), "").warnings.is_empty());
    let turning = |motion: &str| BLOCK.replace("[ground]", &format!("[ground]\nmotion = {{ {motion} }}"));
    let found = resolved(&turning("angular_velocity = '1e5 rad/s'"), "").warnings;
    assert!(matches!(found.as_slice(), [one] if one.path == "ground.motion.angular_velocity"), "{found:?}");
    let swung =
        format!("{}[signal.s]\nshape = 'harmonic'\nfrequency = '50 Hz'\n", turning("angle = '1 rad', signal = 's'"));
    let found = resolved(&swung, "").warnings;
    assert!(found.iter().any(|found| found.path == "ground.motion.angle"), "{found:?}");
    // A product turns as its factors do, times the bounds of the others: 0.5 rad × 2π 50 Hz × 3, 0.47 rad in a step of 1 ms.
    let product = "[signal.s]\nshape = 'product'\nfactors = ['level', 'swing']\n[signal.level]\nshape = 'constant'\nscale = 3\n\
        [signal.swing]\nshape = 'harmonic'\nfrequency = '50 Hz'\n";
    let turns = |angle: &str| {
        let found =
            resolved(&format!("{}{product}", turning(&format!("angle = '{angle}', signal = 's'"))), "").warnings;
        found.into_iter().find(|found| found.path == "ground.motion.angle" && found.rule.contains("it turns by"))
    };
    assert!(turns("0.5 rad").unwrap().rule.contains("it turns by 0.47 rad in a step"));
    assert!(turns("0.1 rad").is_none());
}

#[test]
fn keys_that_do_nothing_are_warned_of() {
    let with = |key: &str| BLOCK.replace("step = '1 ms'", &format!("step = '1 ms'\n{key}"));
    let warned = |text: &str| -> Vec<String> {
        resolved(text, "").warnings.into_iter().map(|warning| format!("{}: {}", warning.path, warning.rule)).collect()
    };
    let closed = "scheme = 'moreau-jean-closed'\n";
    assert!(warned(&with(closed)).is_empty(), "the default is no key that was given");
    for (text, path) in [
        (with(&format!("{closed}activation_gamma = 0.5")), "time.activation_gamma"),
        (with("allow_conditional_stability = true"), "time.allow_conditional_stability"),
        (format!("{BLOCK}[output]\nevery = '0.5 ms'\n"), "output.every"),
        (format!("{BLOCK}[output]\nevery = '0.6 s'\n"), "output.every"),
        (format!("{BLOCK}[material.n]\ndensity = '1 kg/m^3'\n"), "material.n"),
        (
            BLOCK.replace("friction = 0.5", "friction = 0.0\ntangential_restitution = 0.5"),
            "contact.c.tangential_restitution",
        ),
        (format!("{BLOCK}{PUSH}shape = 'half-sine'\nstart = '1 s'\nduration = '1 s'\n"), "signal.s"),
        (format!("{BLOCK}{PUSH}shape = 'constant'\nstart = '0.5 s'\n"), "signal.s"),
        (format!("{BLOCK}{PUSH}shape = 'ricker'\npeak = '-1 s'\nfrequency = '20 Hz'\n"), "signal.s"),
    ] {
        let found = warned(&text);
        assert!(found.len() == 1 && found[0].starts_with(&format!("{path}: ")), "{path}: {found:?}");
    }
    assert!(warned(&with("activation_gamma = 0.5")).is_empty());
    for every in ["1 ms", "0.5 s"] {
        assert!(warned(&format!("{BLOCK}[output]\nevery = '{every}'\n")).is_empty(), "{every}");
    }
    let beam = "[beam.t]\nmaterial = 'm'\nspan = '1 m'\nwidth = '3 cm'\nthickness = '3 cm'\nelements = 4\n";
    for (at, speed, meets) in [
        ("-0.2 m", "1 m/s", true),
        ("-0.6 m", "1 m/s", false),
        ("-0.1 m", "-1 m/s", false),
        ("1.2 m", "-1 m/s", true),
        ("1.2 m", "0 m/s", false),
        ("0 m", "-5 m/s", true),
    ] {
        let load = format!("{BLOCK}{beam}[load.l]\non = 't'\nat = '{at}'\nforce = '-1 N'\nspeed = '{speed}'\n");
        let found = warned(&load);
        assert_eq!(found.iter().any(|found| found.starts_with("load.l.at: ")), !meets, "{at} {speed}: {found:?}");
    }
}

/// The first are listed, the rest is counted: no flood, and no search of the whole scene for each.
#[test]
fn thousands_of_unused_signals_make_twenty_warnings() {
    let signals: String = (0..5000).map(|k| format!("[signal.s{k}]\nshape = 'constant'\n")).collect();
    let found = warned(&signals, "");
    assert_eq!(found.len(), 20);
    assert_eq!(found[0], ("signal.s0".to_owned(), "this signal is not used".to_owned()));
    assert_eq!(found[19].1, "this signal is not used, nor 4980 more");
}

#[test]
fn a_table_with_numbers_beyond_the_limits_of_keys_is_refused_by_its_signal() {
    let push = format!("{BLOCK}{PUSH}shape = 'table'\nfile = 'push.csv'\n");
    for rows in ["0,1e308\n1,-1e308\n", "0,3e300\n1,0\n", "0,1\n1e-320,2\n", "1e300,0\n1e301,1\n"] {
        let read = &mut |_: &str| Ok(rows.as_bytes().to_vec());
        let found = load_with(push.as_bytes(), "scene.toml", "scene", &[], read).unwrap_err();
        let first = found.0.first().unwrap();
        assert!(first.path == "signal.s.file" && first.rule.contains("the limit of numbers"), "{rows:?}: {first}");
    }
}

#[test]
fn a_displacement_that_moves_faster_than_steps_show_is_warned_of() {
    let moving = |by: &str, signal: &str| {
        let text = BLOCK.replace("[ground]", &format!("[ground]\nmotion = {{ {by}, signal = 's' }}"));
        format!("{text}[signal.s]\n{signal}")
    };
    let up = "displacement = ['0 m', '1 mm']";
    let ramp = |lasts: &str| format!("shape = 'ramp'\nstart = '50.2 ms'\nduration = '{lasts}'\n");
    let warned = |text: &str, file: &str| {
        let found = resolved(text, file).warnings;
        found.into_iter().map(|warning| (warning.path, warning.rule)).collect::<Vec<_>>()
    };
    // The attack's: the block is launched by 10 m/s, of which steps of 1 ms show 1 m/s.
    let found = warned(&moving(up, &ramp("0.1 ms")), "");
    let [(path, rule)] = found.as_slice() else { panic!("{found:?}") };
    assert!(path == "ground.motion.displacement" && rule.contains("0.10 steps"), "{path}: {rule}");
    assert_eq!(warned(&moving(up, &ramp("5 ms")), ""), []);
    // As a velocity, it is an acceleration that is short: the velocity is right.
    assert_eq!(warned(&moving("velocity = ['0 m/s', '1 m/s']", &ramp("0.1 ms")), ""), []);
    let found = warned(&moving("angle = '1 deg'", &ramp("1 ms")), "");
    assert!(matches!(found.as_slice(), [(path, _)] if path == "ground.motion.angle"), "{found:?}");
    // A monotone table, whose values have no peak.
    let file = "shape = 'table'\nfile = 's.csv'\n";
    let steep = table([(0.0, 0.0), (0.0502, 0.0), (0.0503, 1.0), (0.5, 1.0)].into_iter());
    let found = warned(&moving(up, file), &steep);
    assert!(
        matches!(found.as_slice(), [(path, rule)] if path == "ground.motion.displacement" && rule.contains("0.10 steps")),
        "{found:?}"
    );
    // Fine rows of what is slow are well.
    let slow = table((0..=5000).map(|i| 1e-4 * f64::from(i)).map(|t| (t, 1.0 - (20.0 * t).cos())));
    assert_eq!(warned(&moving(up, file), &slow), []);
}

#[test]
fn what_a_step_keeps_of_a_signal_is_told_by_its_use() {
    let fast = "[signal.s]\nshape = 'harmonic'\nfrequency = '1000 Hz'\n";
    let moving = BLOCK.replace("[ground]", "[ground]\nmotion = { velocity = ['1 m/s', '0 m/s'], signal = 's' }");
    let rule = |text: String| resolved(&text, "").warnings.remove(0).rule;
    let motion = rule(format!("{moving}{fast}"));
    assert!(motion.contains("the position stays right") && !motion.contains("impulse"), "{motion}");
    let load = rule(format!("{BLOCK}{PUSH}shape = 'harmonic'\nfrequency = '1000 Hz'\n"));
    assert!(load.contains("no impulse is lost") && !load.contains("position"), "{load}");
}

#[test]
fn a_beam_whose_supports_begin_fast_is_told_of() {
    let scene = |motion: &str| {
        format!(
            "[time]\nend = '0.5 s'\nstep = '100 us'\n[material.m]\ndensity = '2700 kg/m^3'\nyoungs_modulus = '69 GPa'\n\
             [beam.t]\nmaterial = 'm'\nspan = '36 cm'\nwidth = '3 cm'\nthickness = '4 mm'\nelements = 10\nstart = 'undeformed'\nmotion = {{ {motion} }}\n"
        )
    };
    let warned = |motion: &str, signal: &str| {
        let found = resolved(&format!("{}{signal}", scene(motion)), "").warnings;
        found.into_iter().map(|warning| warning.path).collect::<Vec<_>>()
    };
    let swing = |phase: &str| format!("[signal.s]\nshape = 'harmonic'\nfrequency = '5 Hz'\nphase = '{phase}'\n");
    let place = "displacement = ['0 m', '1 cm'], signal = 's'";
    assert_eq!(warned(place, &swing("0 deg")), ["beam.t.motion"]);
    assert_eq!(warned(place, &swing("90 deg")), Vec::<String>::new());
    assert_eq!(warned("acceleration = ['0 m/s^2', '1 m/s^2'], signal = 's'", &swing("0 deg")), Vec::<String>::new());
    // The same all the time is no shaking.
    assert_eq!(warned("velocity = ['0 m/s', '1 m/s']", ""), Vec::<String>::new());
}

#[test]
fn another_scheme_is_tried_and_a_scene_written_out_without_a_word_about_keys() {
    let load = |text: &str, sets: &[(&str, &str)]| {
        let sets: Vec<_> = sets.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
        load_with(text.as_bytes(), "scene.toml", "scene", &sets, &mut |_| Ok(Vec::new())).unwrap()
    };
    let closed = ("time.scheme", "moreau-jean-closed");
    let given = BLOCK.replace("step = '1 ms'", "step = '1 ms'\nactivation_gamma = 0.5");
    let tried = load(&given, &[closed]);
    assert_eq!(tried.warnings, []);
    // Asked for together, the key is meant to do something.
    let both = load(BLOCK, &[closed, ("time.activation_gamma", "0.4")]);
    assert!(matches!(both.warnings.as_slice(), [one] if one.path == "time.activation_gamma"), "{:?}", both.warnings);
    let written = load(BLOCK, &[closed]).document.to_toml();
    assert_eq!(load(&written, &[]).warnings, []);
}
