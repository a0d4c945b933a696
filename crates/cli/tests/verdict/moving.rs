//! Blocks on beams, ground and blocks that move up or down: `sunk`, `fell` and `rests` go by where these are by then.

use super::{Ran, scene, what};

const BEAM: &str =
    "[beam.t]\nmaterial = 'a'\nspan = '36 cm'\nwidth = '3 cm'\nthickness = '1 cm'\nelements = 4\nstart = 'static'\n";
const CONSTANT: &str = "[signal.s]\nshape = 'constant'\n";
/// Its integral is 0.764 s.
const PULSE: &str = "[signal.s]\nshape = 'half-sine'\nduration = '1.2 s'\n";
const SINE: &str = "[signal.s]\nshape = 'harmonic'\nfrequency = '0.7 Hz'\n";
const PLATE: &str = "[block.b]\nmaterial = 'a'\nwidth = '6 cm'\nheight = '4 cm'\ndepth = '3 cm'\n";
const PLATFORM: &str = "[block.p]\nmaterial = 'a'\nwidth = '20 cm'\nheight = '10 cm'\ndepth = '3 cm'\n";

/// A scene of 1.4 s.
fn ran(name: &str, text: &str) -> Ran {
    scene(&format!("moving-{name}"), &format!("[time]\nend = '1.4 s'\nstep = '200 us'\n{text}"))
}

fn contact(between: [&str; 2]) -> String {
    let [a, b] = between;
    format!("[contact.{a}-{b}]\nbetween = ['{a}', '{b}']\nfriction = 0.5\n")
}

/// How high a block is over what it stands on at the end, m.
fn height_over(ran: &Ran, motion: &str) -> f64 {
    let last = |column: &str| *ran.column(column).last().unwrap();
    last("b.y") - last(motion)
}

#[test]
fn what_stands_on_a_beam_has_not_sunk_wherever_its_supports_are() {
    for (name, motion, signal, at) in [
        ("beam-starts-lower", "displacement = ['0 m', '-1 m']", CONSTANT, "18 cm"),
        ("beam-starts-higher", "displacement = ['0 m', '1 m']", CONSTANT, "18 cm"),
        ("beam-starts-aside", "displacement = ['1 m', '-1 m']", CONSTANT, "118 cm"),
        ("beam-goes-down", "velocity = ['0 m/s', '-1 m/s']", PULSE, "18 cm"),
        ("beam-is-shaken", "acceleration = ['0 m/s^2', '-2 m/s^2']", SINE, "18 cm"),
    ] {
        let on = format!("{BEAM}motion = {{ {motion}, signal = 's' }}\n{signal}{PLATE}on = 't'\nat = '{at}'\n");
        let ran = ran(name, &format!("{on}{}", contact(["b", "t"])));
        // Half its height, less what the beam bends.
        assert!((height_over(&ran, "t.support.y") - 0.02).abs() < 1e-3, "{name}");
        assert_eq!(what(&ran).0, "rests", "{name}: {}", ran.summary["headline"]);
        assert_eq!(ran.summary["headline"], "`b` stood on moving supports throughout", "{name}");
    }
}

/// The next beam continues the first where that is at the start, and doesn't where that would be without its displacement.
#[test]
fn what_slides_on_to_the_next_beam_leaves_the_first_where_they_are_not_level() {
    for (name, second, wanted) in [("next-level", "-80 cm", "slid"), ("next-higher", "0 cm", "left")] {
        let next = BEAM.replace("[beam.t]", "[beam.u]");
        let text = format!(
            "{BEAM}motion = {{ displacement = ['0 m', '-80 cm'], signal = 's' }}\n{CONSTANT}\
             {next}position = ['36 cm', '{second}']\n\
             {PLATE}on = 't'\nat = '30 cm'\nvelocity = ['1 m/s', '0 m/s']\n{}{}",
            contact(["b", "t"]),
            contact(["b", "u"])
        );
        let ran = ran(name, &text.replace("friction = 0.5", "friction = 0.3"));
        assert_eq!(what(&ran).0, wanted, "{name}: {}", ran.summary["headline"]);
        assert!(*ran.column("b.x").last().unwrap() > 0.36, "{name}: it is past the end of the first");
    }
}

/// Of two things that could hold it, the lower one counts, whatever it is.
#[test]
fn what_stands_lower_than_the_ground_or_a_beam_has_not_sunk() {
    let on = |what: &str| format!("{PLATE}on = '{what}'\nat = '18 cm'\n{}", contact(["b", what]));
    let low = "position = ['0 m', '-1 m']\n";
    let fixed = "position = ['18 cm', '-1 m']\nfixed = true\n";
    for (name, text) in [
        ("beam-below-ground", format!("[ground]\n{BEAM}{low}{}", on("t"))),
        ("block-below-ground", format!("[ground]\n{PLATFORM}{fixed}{}", on("p"))),
        ("block-below-beam", format!("{BEAM}{PLATFORM}{fixed}{}", on("p"))),
    ] {
        let ran = ran(name, &text);
        assert!(*ran.column("b.y").last().unwrap() < -0.9, "{name}");
        assert_eq!(what(&ran).0, "rests", "{name}: {}", ran.summary["headline"]);
    }
}

#[test]
fn a_stop_at_sunk_does_not_end_a_run_on_a_beam_that_goes_down() {
    let text = format!(
        "stop = ['sunk']\n{BEAM}motion = {{ velocity = ['0 m/s', '-1 m/s'], signal = 's' }}\n{PULSE}\
         {PLATE}on = 't'\nat = '18 cm'\n{}",
        contact(["b", "t"])
    );
    let ran = ran("stop", &text);
    assert_eq!((ran.summary["stopped_by"].as_str(), ran.summary["ended"].as_str()), (None, Some("complete")));
}

/// A block falls beside a beam that goes down less fast, or beside one that has gone up: it has sunk when it is lower by half the span.
#[test]
fn what_falls_beside_a_moving_beam_sinks_when_it_is_below_that() {
    for (name, speed) in [("beside-down", "-1 m/s"), ("beside-up", "1 m/s")] {
        let text = format!(
            "{BEAM}motion = {{ velocity = ['0 m/s', '{speed}'], signal = 's' }}\n{PULSE}\
             {PLATE}position = ['60 cm', '3 cm']\n{}",
            contact(["b", "t"])
        );
        let ran = ran(name, &text);
        assert_eq!(what(&ran).0, "sunk", "{name}: {}", ran.summary["headline"]);
        let [t, y, support] = ["t", "b.y", "t.support.y"].map(|column| ran.column(column));
        let reach = 0.5 * 0.06_f64.hypot(0.04);
        // The beam is hardly bent, as nothing is on it.
        let first = (0..t.len()).find(|k| y[*k] + reach < support[*k] - 0.18).unwrap();
        let told = ran.verdict("b")["t"].as_f64().unwrap();
        assert!((told - t[first]).abs() < 2e-3, "{name}: {told} instead of {}", t[first]);
    }
}

/// The upper of two blocks rocks while what carries them goes down by more than it is wide: it has not fallen from its place.
#[test]
fn what_rocks_on_a_block_that_goes_down_with_what_carries_it_has_not_fallen() {
    let go = "motion = { velocity = ['0 m/s', '-1 m/s'], signal = 's' }\n";
    let stack = |what: &str| {
        format!(
            "{PLATE}on = '{what}'\nat = '18 cm'\n{}\
             [block.u]\nmaterial = 'a'\nwidth = '4 cm'\nheight = '10 cm'\ndepth = '3 cm'\non = 'b'\nat = '18 cm'\n\
             tilt = '12 deg'\n{}",
            contact(["b", what]),
            contact(["u", "b"])
        )
    };
    let driven = "motion = { velocity = ['0 m/s', '-1 m/s'], angle = '0 deg', signal = 's' }\n";
    for (name, text) in [
        ("stack-on-beam", format!("[ground]\n{BEAM}{go}{PULSE}{}", stack("t"))),
        ("stack-on-block", format!("[ground]\n{PLATFORM}position = ['18 cm', '-1 m']\n{driven}{PULSE}{}", stack("p"))),
    ] {
        let ran = ran(name, &text);
        for block in ["b", "u"] {
            let said = ran.verdict(block);
            assert!(said["fell_at"].is_null() && said["what"] != "sunk", "{name}: {said}");
        }
    }
}

/// Relative to the block on which it stands, it is at rest while that moves.
#[test]
fn what_rides_on_a_driven_block_rests_on_it() {
    let text = format!(
        "[ground]\n{PLATFORM}position = ['0 m', '0.5 m']\n\
         motion = {{ velocity = ['0.2 m/s', '-0.1 m/s'], angle = '0 deg', signal = 's' }}\n{SINE}\
         {PLATE}on = 'p'\nat = '0 m'\n{}",
        contact(["b", "p"])
    );
    let ran = ran("rides", &text);
    assert_eq!(ran.summary["headline"], "`b` stood on a moving block throughout");
}
