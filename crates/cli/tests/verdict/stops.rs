//! Runs that end with what became of a block.

use super::{FLOOR, ROCKER, scene, what};

#[test]
fn a_run_stops_where_the_scene_says_and_tells() {
    let stop = |name: &str, words: &str, text: &str| {
        scene(name, &format!("[time]\nend = '3 s'\nstep = '200 us'\nstop = {words}\n{text}"))
    };
    let fall = format!("[ground]\n{ROCKER}tilt = '13 deg'\n{FLOOR}");
    let ran = stop("stop-overturned", "['overturned', 'rest']", &fall);
    assert_eq!(
        (ran.summary["ended"].as_str(), ran.summary["stopped_by"].as_str()),
        (Some("stopped"), Some("overturned"))
    );
    let end = *ran.column("t").last().unwrap();
    assert!(
        end < 3.0 && ran.summary["t"].as_f64() == Some(end) && ran.stderr.contains("stopped at t = "),
        "{}",
        ran.stderr
    );
    assert!(*ran.column("b.phi").last().unwrap() > 1.2, "it lies nearly on its side");
    // The rows up to there are those of the run that goes on.
    let on = scene("stop-not", &format!("[time]\nend = '3 s'\nstep = '200 us'\n{fall}"));
    assert_eq!(ran.rows[..ran.rows.len() - 1], on.rows[..ran.rows.len() - 1]);
    assert_eq!(on.summary["ended"], "complete");

    let slide = format!("[ground]\n{ROCKER}velocity = ['0.2 m/s', '0 m/s']\n{FLOOR}").replace("0.5", "0.1");
    let ran = stop("stop-rest", "['rest']", &slide);
    assert_eq!(ran.summary["stopped_by"], "rest");
    assert!(ran.verdict("b")["rests_from"].as_f64().unwrap() < ran.summary["t"].as_f64().unwrap());

    let through = ROCKER.replace("on = 'ground'\nat = '0 m'", "position = ['9 m', '1 m']");
    let beam = "[beam.t]\nmaterial = 'a'\nspan = '36 cm'\nwidth = '3 cm'\nthickness = '1 cm'\nelements = 4\n";
    let ran =
        stop("stop-sunk", "['sunk']", &format!("{beam}{through}[contact.f]\nbetween = ['b', 't']\nfriction = 0.5\n"));
    assert_eq!((ran.summary["stopped_by"].as_str(), what(&ran).0), (Some("sunk"), "sunk"));
}

#[test]
fn rest_does_not_stop_a_run_before_the_shaking_begins() {
    let text = format!(
        "[time]\nend = '3 s'\nstep = '200 us'\nstop = ['rest']\n\
         [ground]\nmotion = {{ acceleration = ['4 m/s^2', '0 m/s^2'], signal = 'shake' }}\n\
         [signal.shake]\nshape = 'one-sine'\nstart = '1 s'\nperiod = '0.2 s'\n{ROCKER}{FLOOR}"
    );
    let ran = scene("rest-later", &text);
    assert!(ran.summary["t"].as_f64().unwrap() > 1.2, "{}", ran.summary["t"]);
}
