//! The sentence on what became of a scene, where a word would say more than is true.

use crate::page::{run, scenario};
use teeter_report::half_cycles;

const BOUNCING: &str = "[time]\nend = '3 s'\nstep = '500 us'\n[ground]\nmotion = { displacement = ['0 mm', '8 mm'], signal = 'shake' }\n\
    [signal.shake]\nshape = 'harmonic'\nphase = '90 deg'\nfrequency = '9 Hz'\n[block.cube]\ndensity = '1000 kg/m^3'\nwidth = '20 cm'\n\
    height = '6 cm'\ndepth = '10 cm'\non = 'ground'\nat = '0 m'\ntilt = '4 deg'\n[contact.feet]\nbetween = ['cube', 'ground']\n\
    friction = 0.4\nrestitution = 0.6\n";

#[test]
fn what_bounces_neither_rocks_nor_slides() {
    let bouncing = run("bouncing", BOUNCING);
    let headline = &bouncing.summary.headline;
    assert!(headline.starts_with("`cube` is still bouncing"), "{headline}");
    assert!(!headline.contains("rocks") && !headline.contains("slid"), "{headline}");
    assert!(!bouncing.summary.crossings.is_empty() && half_cycles(&bouncing.page, &bouncing.summary).is_empty());
    assert!(!bouncing.html.contains("id=\"rocking\""));
}

/// Three blocks on each other, tilted as one, which rock on the base of the lowest.
#[test]
fn blocks_that_turn_as_one_rock_as_a_column() {
    let text = "[time]\nend = '2 s'\nstep = '500 us'\n[ground]\nmotion = { acceleration = ['2.5 m/s^2', '0 m/s^2'], signal = 'shake' }\n\
        [signal.shake]\nshape = 'one-sine'\nperiod = '0.8 s'\n[block.drum]\ndensity = '2700 kg/m^3'\nwidth = '1 m'\nheight = '1.5 m'\n\
        depth = '1 m'\non = 'ground'\nat = '0 m'\nrepeat = { count = COUNT, stacked = true }\n[contact.floor]\nbetween = ['*', 'ground']\n\
        friction = 0.7\n[contact.joints]\nbetween = ['*', '*']\nfriction = 0.7\n";
    let four = run("column-of-four", &text.replace("COUNT", "4"));
    let headline = &four.summary.headline;
    let told = "all 4 blocks rock on as one column on the base of `drum-1`; largest φ/α of the column ";
    let share: f64 = headline.strip_prefix(told).unwrap_or_else(|| panic!("{headline}")).parse().unwrap();
    // The angle is that of all of them, α not: atan(1/6) of the column, atan(1/1.5) of a drum.
    let own = four.summary.max_phi_over_alpha.unwrap();
    let wanted = own * (1.0_f64 / 1.5).atan() / (1.0_f64 / 6.0).atan();
    assert!((share / wanted - 1.0).abs() < 0.02, "{share} {wanted}");
    let two = run("column-of-two", &text.replace("COUNT", "2").replace("1.5 m", "3 m"));
    let headline = &two.summary.headline;
    assert!(
        headline.contains("`drum-1` rocks on") && headline.contains("`drum-2` rocks as one with `drum-1`"),
        "{headline}"
    );
    assert!(headline.contains("largest φ/α of the column"), "{headline}");
}

/// A couple of 0.14 N m lifts an edge of a plate that 0.137 N m would balance.
#[test]
fn a_plate_that_tips_does_not_tremble() {
    let tipping = |end: &str| {
        let text = format!(
            "[time]\nend = '{end}'\nstep = '100 us'\n[ground]\n[block.b]\ndensity = '700 kg/m^3'\nwidth = '20 cm'\nheight = '1 cm'\n\
             depth = '10 cm'\non = 'ground'\nat = '0 cm'\n[contact.c]\nbetween = ['b', 'ground']\nfriction = 0.6\n\
             [force.f]\non = 'b'\nforce = ['0 N', '0 N']\ncouple = '0.14 N m'\n"
        );
        run(&format!("tipping-{}", end.replace(' ', "-")), &text).summary.headline
    };
    assert_eq!(tipping("15 ms"), "`b` still moves");
    assert!(tipping("50 ms").starts_with("`b` is still tipping to the left: φ 0."), "{}", tipping("50 ms"));
}

#[test]
fn what_stands_on_a_beam_that_moves_says_so() {
    let text = "[time]\nend = '2 s'\nstep = '200 us'\n[material.steel]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n\
        [beam.bridge]\nmaterial = 'steel'\nsection = 'i-section'\nspan = '12 m'\nwidth = '10 cm'\nheight = '20 cm'\nweb = '5.6 mm'\n\
        flange = '8.5 mm'\nelements = 48\ndamping_ratio = { mode = 1, ratio = 0.01 }\nself_weight = true\nstart = 'static'\n\
        support.mid = { at = '5 m', kind = 'pinned' }\n[load.wagon]\non = 'bridge'\nat = '0 m'\nspeed = '8 m/s'\nforce = '-8 kN'\n\
        [block.crate]\ndensity = '1000 kg/m^3'\nwidth = '20 cm'\nheight = '60 cm'\ndepth = '50 cm'\non = 'bridge'\nat = '8 m'\n\
        [contact.b]\nbetween = ['crate', 'bridge']\nfriction = 0.4\n";
    let headline = run("on-a-bridge", text).summary.headline;
    assert_eq!(headline, "`crate` is still trembling where it stands, on a beam that moves");
}

/// The sentence at the head doesn't stand beside a warning against it as if that were not there.
#[test]
fn a_motion_that_steps_do_not_resolve_is_told_with_a_reserve() {
    let text = include_str!("../../../../scenarios/free-rocking-on-ground.toml");
    let [head, rest] = text.split_once("[time]").map(|(head, rest)| [head, rest]).unwrap();
    let own = |line: &&str| !line.starts_with("step") && !line.starts_with("scheme") && !line.starts_with("every");
    let rest = rest.lines().filter(own).collect::<Vec<_>>().join("\n");
    let coarse = run("coarse", &format!("{head}[time]\nstep = '2 ms'\nscheme = 'moreau-jean'{rest}"));
    let warning = coarse.summary.warnings.iter().find(|warning| warning.code == "under-resolved").unwrap();
    assert!(!warning.text.contains("all together") && !warning.text.contains("  "), "{}", warning.text);
    let verdict = &coarse.html[coarse.html.find("id=\"verdict\"").unwrap()..];
    let reserve = coarse.summary.reserve().unwrap();
    assert!(verdict[..verdict.find("</p>").unwrap()].contains(&format!("; {reserve}")));
    assert_eq!(scenario("free-rocking-on-ground").summary.reserve(), None);
}

#[test]
fn the_last_peak_of_the_headline_is_the_last_of_the_summary() {
    for name in ["free-rocking-on-beam", "free-rocking-on-ground"] {
        let summary = &scenario(name).summary;
        let last = summary.peaks.last().unwrap();
        assert_eq!((Some(last.phi), Some(last.t)), (summary.verdict[0].last_peak, summary.verdict[0].t), "{name}");
    }
}

/// A block that rides on one that rocks is tilted against it by rounding only.
#[test]
fn what_rides_on_a_block_that_rocks_does_not_tip() {
    for end in ["1.0 s", "1.15 s", "1.25 s"] {
        let text = format!(
            "[time]\nend = '{end}'\nstep = '500 us'\n[ground]\n\
             motion = {{ acceleration = ['3.6 m/s^2', '0 m/s^2'], signal = 'shake' }}\n[signal.shake]\nshape = 'one-sine'\n\
             period = '0.8 s'\n[block.base]\ndensity = '2700 kg/m^3'\nwidth = '1.2 m'\nheight = '4 m'\ndepth = '1 m'\n\
             on = 'ground'\nat = '0 m'\n[block.right]\ndensity = '2700 kg/m^3'\nwidth = '0.3 m'\nheight = '0.5 m'\n\
             depth = '1 m'\non = 'base'\nat = '0.3 m'\n[contact.floor]\nbetween = ['base', 'ground']\nfriction = 0.7\n\
             [contact.joint]\nbetween = ['right', 'base']\nfriction = 0.7\n"
        );
        let rider = run(&format!("rider-{}", end.replace(' ', "-")), &text);
        let headline = &rider.summary.headline;
        let (_, right) = headline.split_once("; `right` ").unwrap_or_else(|| panic!("{headline}"));
        assert!(
            !right.contains("tipping") && !right.contains("upright") && !right.contains("e\u{2212}"),
            "{end}: {headline}"
        );
    }
}
