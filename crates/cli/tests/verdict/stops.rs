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

/// The time at which a run of up to 2 s with `stop = ["rest"]` ended, s, and what stopped it.
fn stopped(name: &str, text: &str) -> (f64, Option<String>) {
    let head = "[time]\nend = '2 s'\nstep = '1 ms'\nstop = ['rest']\n";
    let ran = scene(name, &format!("{head}{text}"));
    (ran.summary["t"].as_f64().unwrap(), ran.summary["stopped_by"].as_str().map(str::to_owned))
}

#[test]
fn rest_does_not_stop_a_run_whose_prescribed_motion_goes_on() {
    let constant = "[signal.c]\nshape = 'constant'\nstart = '0.5 s'\n";
    let block = |name: &str, rest: &str| {
        format!("[block.{name}]\nmaterial = 'a'\nwidth = '6 cm'\nheight = '6 cm'\ndepth = '6 cm'\n{rest}\n")
    };
    let other = |rest: &str| {
        let touch = "[contact.d]\nbetween = ['b', 'z']\nfriction = 0.3\n";
        format!("[ground]\n{}{touch}{ROCKER}{FLOOR}", block("z", rest))
    };
    let ground = |motion: &str| format!("[ground]\nmotion = {{ {motion} }}\n{constant}{ROCKER}{FLOOR}");
    let beam = "[beam.t]\nmaterial = 'a'\nspan = '36 cm'\nwidth = '3 cm'\nthickness = '1 cm'\nelements = 4\n\
                start = 'static'\nmotion = { velocity = ['0.1 m/s', '0 m/s'] }\n";
    let on_beam = format!("{ROCKER}{FLOOR}").replace("'ground'", "'t'").replace("at = '0 m'", "at = '18 cm'");
    for (name, text) in [
        ("goes-on-turning", ground("angular_velocity = '0.1 rad/s'")),
        ("goes-on-faster", ground("acceleration = ['1 m/s^2', '0 m/s^2'], signal = 'c'")),
        ("goes-on-to-strike", other("position = ['1 m', '3 cm']\nmotion = { velocity = ['-0.6 m/s', '0 m/s'] }")),
        ("goes-on-with-supports", format!("{beam}{on_beam}{constant}")),
    ] {
        assert_eq!(stopped(name, &text), (2.0, None), "{name}");
    }
    // What is free in part falls onto the block.
    let falls = other("position = ['0 m', '1.2 m']\nmotion = { displacement = ['0 m', '0 m'], only = 'x' }");
    assert!(stopped("falls-onto-it", &falls).0 > 0.4);

    // A motion that comes to a stand is over, to rounding; and ground that carries all takes it along.
    let pulse = "[signal.p]\nshape = 'one-sine'\nperiod = '0.3 s'\n";
    let there = format!("{pulse}{}", ground("acceleration = ['1 m/s^2', '0 m/s^2'], signal = 'p'"));
    for (name, text) in [("is-over", there), ("all-moves", ground("velocity = ['0.1 m/s', '0 m/s']"))] {
        let (t, by) = stopped(name, &text);
        assert!(t < 2.0 && by.as_deref() == Some("rest"), "{name}: {t}");
    }
}

#[test]
fn where_no_block_is_free_the_sentence_says_what_moves() {
    let head = "[time]\nend = '0.4 s'\nstep = '1 ms'\n";
    let block =
        |rest: &str| format!("[block.b]\nmaterial = 'a'\nwidth = '6 cm'\nheight = '6 cm'\ndepth = '6 cm'\n{rest}\n");
    let told = |name: &str, text: &str| {
        let ran = scene(name, &format!("{head}{text}"));
        ran.summary["headline"].as_str().unwrap().to_owned()
    };
    let thrown = "position = ['0 m', '1 m']\nspin = '3 rad/s'\nvelocity = ['-1 m/s', '0 m/s']\n";
    let held = |motion: &str| format!("[ground]\n{}", block(&format!("{thrown}motion = {{ {motion} }}")));
    assert_eq!(
        told("y-held", &held("displacement = ['0 m', '0 m'], only = 'y'")),
        "no block is free; `b`, its y prescribed, ended 400 mm left of its start, turned by 68.8° counter-clockwise"
    );
    let fell = told("angle-held", &held("angle = '0 deg'").replace("spin = '3 rad/s'\n", ""));
    assert!(fell.contains("`b`, its φ prescribed, ended 400 mm left of its start, 78"), "{fell}");
    let (still, moves) =
        (block("position = ['0 m', '3 cm']\nfixed = true"), held("").replace(thrown, "position = ['0 m', '3 cm']\n"));
    assert_eq!(told("all-fixed", &format!("[ground]\n{still}")), "nothing moves up to t = 400 ms");
    let moves = moves.replace("{  }", "{ velocity = ['1 m/s', '0 m/s'], angle = '0 deg' }");
    assert_eq!(told("all-held", &moves), "nothing moves but as prescribed up to t = 400 ms");

    let beam = "[beam.t]\nmaterial = 'a'\nspan = '36 cm'\nwidth = '3 cm'\nthickness = '1 cm'\nelements = 4\n\
                supports = ['free', 'free']\nself_weight = true\n";
    let falls = told("beam-falls", &format!("{beam}{still}").replace("'3 cm']", "'-1 m']"));
    // g t²/2.
    assert_eq!(falls, "no block is free; `t` fell, 784.8 mm lower at the end");
}
