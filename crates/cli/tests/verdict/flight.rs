//! What begins in flight, and what turns over.

use super::{FLOOR, ROCKER, Ran, TIME, scene};
use serde_json::Value;

/// A block of 5 cm × 15 cm that begins somewhere above the ground.
const THROWN: &str = "[block.b]\nmaterial = 'a'\nwidth = '5 cm'\nheight = '15 cm'\ndepth = '5 cm'\n";

#[test]
fn what_comes_down_on_a_side_says_on_which() {
    for (name, start, side) in [
        ("right", "position = ['0 m', '30 cm']\nspin = '-4 rad/s'", "right side"),
        ("left", "position = ['0 m', '30 cm']\nspin = '4 rad/s'", "left side"),
        ("turned", "position = ['0 m', '20 cm']\nangle = '20 deg'", "left side"),
        ("upright", "position = ['0 m', '8 cm']", "base"),
    ] {
        let text = format!("{TIME}[ground]\n{THROWN}{start}\n[contact.f]\nbetween = ['b', 'ground']\nfriction = 0.6\n");
        let ran = scene(&format!("side-{name}"), &text);
        let (said, headline) = (ran.verdict("b"), ran.summary["headline"].as_str().unwrap());
        assert_eq!(said["lies_on"], side, "{said}");
        // It stood nowhere before, so it did not overturn.
        assert!(said["overturned_at"].is_null() && said["rests_from"].as_f64().unwrap() > 0.0, "{said}");
        assert_eq!(headline.contains(&format!(" on its {side}")), side != "base", "{headline}");
        let phi = ran.column("b.phi").last().unwrap().to_degrees();
        let wanted = match side {
            "right side" => -90.0,
            "left side" => 90.0,
            _ => 0.0,
        };
        assert!((phi - wanted).abs() < 0.01, "{phi} {headline}");
        assert!(ran.stderr.contains(headline), "{}", ran.stderr);
    }
}

/// A box of 3 cm × 13.5 cm or others that begins in the air.
fn from_the_air(name: &str, block: &str, rest: &str) -> Ran {
    let text = format!(
        "[time]\nend = '3 s'\nstep = '200 us'\n[block.b]\nmaterial = 'a'\ndepth = '3 cm'\n{block}\n{FLOOR}{rest}"
    );
    scene(name, &text)
}

#[test]
fn what_tumbles_through_the_air_does_not_overturn() {
    let thrown = "width = '6 cm'\nheight = '4 cm'\nposition = ['0 m', '1 m']\nvelocity = ['0.3 m/s', '1 m/s']\nspin = '15 rad/s'";
    let ran = from_the_air("thrown", thrown, "[ground]\n");
    assert!(ran.column("b.phi").iter().any(|phi| phi.abs() > std::f64::consts::TAU), "it turns over in the air");
    let of = ran.verdict("b");
    assert_eq!(of["what"], "rests", "{of}");
    assert!(ran.summary["overturned_at"].is_null() && of["overturned_at"].is_null(), "{of}");
    // From when it has settled φ/α is told, and by itself it stays below 1 then; how far it flew is no slide.
    assert!(of["max_phi_over_alpha"].as_f64().is_some_and(|part| part < 1.0), "{of}");
    assert!(of["slid"].as_f64().is_some_and(|slid| slid.abs() < 1e-3), "{of}");
    let turned = ran.column("b.phi").last().unwrap().abs().to_degrees();
    let headline = ran.summary["headline"].as_str().unwrap();
    assert!(headline.contains(&format!("tumbled by {turned:.0}°, then came to rest")), "{headline}");

    // One that never lands has no fate but that it moves.
    let ran = from_the_air("aloft", &thrown.replace("1 m/s", "40 m/s"), "[ground]\n");
    let of = ran.verdict("b");
    assert_eq!((&of["what"], &of["t"]), (&Value::from("moves"), &Value::Null), "{of}");
    assert!(of["slid"].is_null() && of["max_phi_over_alpha"].is_null(), "{of}");
    assert!(ran.summary["headline"].as_str().unwrap().contains("is still in flight"), "{}", ran.summary["headline"]);
}

#[test]
fn what_lands_and_is_then_knocked_over_has_overturned() {
    let dropped = "width = '3 cm'\nheight = '13.5 cm'\nposition = ['0 m', '0.1 m']";
    let push = "[force.push]\non = 'b'\ncouple = '0.3 N m'\nsignal = 'late'\n[signal.late]\nshape = 'one-sine'\nstart = '1.5 s'\nperiod = '0.4 s'\n";
    let ran = from_the_air("knocked", dropped, &format!("[ground]\n{push}"));
    let of = ran.verdict("b");
    assert_eq!(of["what"], "overturned", "{of}");
    assert!(of["t"].as_f64().is_some_and(|t| t > 1.5), "{of}");
}

#[test]
fn a_gap_too_small_to_turn_it_over_is_as_good_as_none() {
    // Half a millimetre above ground that takes it down before it could have settled.
    let placed = "width = '3 cm'\nheight = '13.5 cm'\nposition = ['0 m', '6.8 cm']";
    let ground = "[ground]\nmotion = { acceleration = ['5 m/s^2', '0 m/s^2'], signal = 'pulse' }\n[signal.pulse]\nshape = 'one-sine'\nstart = '0 s'\nperiod = '0.6 s'\n";
    let ran = from_the_air("gap", placed, ground);
    let of = ran.verdict("b");
    assert_eq!(of["what"], "overturned", "{of}");
    assert!(of["t"].as_f64().is_some_and(|t| t < 1.0), "{of}");
}

#[test]
fn a_block_that_rolls_over_sides_is_told_with_its_turns_and_on_what_it_rests() {
    let cube = ROCKER.replace("3 cm", "10 cm").replace("height = '13.5 cm'", "height = '10 cm'");
    let text = format!("{TIME}[ground]\n{cube}velocity = ['4 m/s', '0 m/s']\nspin = '-40 rad/s'\n{FLOOR}")
        .replace("friction = 0.5", "friction = 0.9\nrestitution = 0.4");
    let ran = scene("rolls-over", &text);
    let headline = ran.summary["headline"].as_str().unwrap();
    let phi = ran.column("b.phi");
    let turns = (phi.last().unwrap() - phi[0]).abs() / std::f64::consts::TAU;
    let told = if turns < 2.0 {
        format!(", turned by {:.0}° in all", 360.0 * turns)
    } else {
        format!(", made {turns:.2} turns in all").replace("0 turns", " turns")
    };
    assert!(turns > 0.4 && headline.contains(&told), "{turns}: {headline}");
}

/// Turns count from its angle at the start, whether it is placed with a tilt or at an angle.
#[test]
fn turns_count_from_the_angle_at_the_start() {
    let cube = "[block.b]\nmaterial = 'a'\nwidth = '10 cm'\nheight = '10 cm'\ndepth = '10 cm'\nvelocity = ['4 m/s', '0 m/s']\nspin = '-40 rad/s'\n";
    // The same cube on its left corner.
    let (sin, cos) = 20_f64.to_radians().sin_cos();
    let at = format!("position = ['{} cm', '{} cm']\nangle = '20 deg'\n", 5.0 * (cos - sin) - 5.0, 5.0 * (cos + sin));
    let floor = FLOOR.replace("friction = 0.5", "friction = 0.9\nrestitution = 0.4");
    let told = ["on = 'ground'\nat = '0 cm'\ntilt = '20 deg'\n".to_owned(), at].map(|start| {
        let name = format!("turns-{}", &start[..2]);
        let ran = scene(&name, &format!("{TIME}[ground]\n{cube}{start}{floor}"));
        let phi = ran.column("b.phi");
        let turned = (phi[phi.len() - 1] - phi[0]).abs().to_degrees();
        let headline = ran.summary["headline"].as_str().unwrap().to_owned();
        let words = if turned < 720.0 {
            format!("{turned:.0}°")
        } else {
            format!("made {:.2} turns in all", turned / 360.0).replace("0 turns", " turns")
        };
        assert!(turned > 140.0 && headline.contains(&words), "{turned}: {headline}");
        turned
    });
    assert!((told[0] - told[1]).abs() < 1.0, "{told:?}");
}
