//! What slides: how far, which way, and how it ends.

use super::{FLOOR, ROCKER, Ran, folder, scene, what, written};
use std::path::Path;

/// Stones that lie on others without being placed `on` them slide along those, not along their neighbours.
#[test]
fn a_course_of_a_wall_slides_on_the_one_below() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/dry-stone-wall.toml");
    let ran = Ran::of(&file, &folder("verdict-wall"), &[]);
    for (block, below) in
        [("second-1", "lowest-1"), ("second-3", "lowest-3"), ("second-5", "lowest-6"), ("third-4", "second-5")]
    {
        let [x, base] = [block, below].map(|name| ran.column(&format!("{name}.x")));
        let moved = |x: &[f64]| x[x.len() - 1] - x[0];
        let slid = ran.verdict(block)["slid"].as_f64().unwrap();
        assert!((slid - (moved(&x) - moved(&base))).abs() < 1e-6, "{block}: {slid}");
    }
    let headline = ran.summary["headline"].as_str().unwrap();
    assert!(headline.contains("(5 after sliding)"), "{headline}");
}

#[test]
fn what_stopped_just_before_the_end_does_not_slide_on() {
    // √(R/g) is 40 ms; friction stops it after 204 ms.
    let block = ROCKER.replace("height = '13.5 cm'", "height = '1 cm'");
    let floor = FLOOR.replace("friction = 0.5", "friction = 0.25");
    let text = |end: &str| {
        format!("[time]\nend = '{end}'\nstep = '200 us'\n[ground]\n{block}velocity = ['0.5 m/s', '0 m/s']\n{floor}")
    };
    let headline = |name: &str, end: &str| scene(name, &text(end)).summary["headline"].as_str().unwrap().to_owned();
    assert!(headline("slides", "0.19 s").contains("slides on"));
    let still = headline("still", "0.21 s");
    assert!(still.contains("and has been still since t = 20"), "{still}");
    assert!(headline("rested", "0.4 s").contains("came to rest"));
    // What is shaken may slide again.
    let shaken = "motion = { acceleration = ['1 m/s^2', '0 m/s^2'], signal = 's' }\n[signal.s]\nshape = 'harmonic'\nfrequency = '3 Hz'\n";
    let shaken = text("0.18 s").replace("[ground]\n", &format!("[ground]\n{shaken}"));
    let headline = scene("shaken-still", &shaken).summary["headline"].as_str().unwrap().to_owned();
    assert!(headline.ends_with(" to the right on the moving ground"), "{headline}");
}

#[test]
fn what_slides_on_a_slope_does_so_up_or_down_it() {
    let block = ROCKER.replace("height = '13.5 cm'", "height = '1 cm'");
    for (incline, speed, way) in [
        ("20 deg", 0.5, "up the slope"),
        ("20 deg", -0.5, "down the slope"),
        ("-20 deg", -0.5, "up the slope"),
        ("0 deg", 0.5, "to the right"),
        ("0 deg", -0.5, "to the left"),
    ] {
        let text = format!(
            "[time]\nend = '0.4 s'\nstep = '200 us'\n[ground]\nincline = '{incline}'\n{block}velocity = ['{speed} m/s', '0 m/s']\n{FLOOR}"
        );
        let ran = scene(&format!("up-{incline}-{speed}"), &text.replace("friction = 0.5", "friction = 0.6"));
        let headline = ran.summary["headline"].as_str().unwrap();
        assert!(headline.contains("slid by") && headline.contains(way), "{incline} {speed}: {headline}");
    }
}

#[test]
fn a_block_that_slides_on_to_the_next_beam_has_not_left_it() {
    let beam = |name: &str, x: &str| {
        format!(
            "[beam.{name}]\nmaterial = 'a'\nspan = '36 cm'\nwidth = '3 cm'\nthickness = '1 cm'\nelements = 10\nposition = ['{x}', '0 m']\n"
        )
    };
    let text = format!(
        "[time]\nend = '0.3 s'\nstep = '200 us'\n{}{}\
         [block.b]\nmaterial = 'a'\nwidth = '4 cm'\nheight = '1 cm'\ndepth = '3 cm'\non = 't'\nat = '30 cm'\nvelocity = ['1 m/s', '0 m/s']\n\
         [contact.f]\nbetween = ['b', '*']\nfriction = 0.05\n",
        beam("t", "0 m"),
        beam("u", "36 cm")
    );
    let ran = scene("next-beam", &text);
    assert!(*ran.column("b.x").last().unwrap() > 0.45);
    assert_eq!(what(&ran), ("slid", None), "{}", ran.summary["headline"]);
}

#[test]
fn a_block_that_slides_past_the_end_of_its_beam_has_left_it() {
    let text = "[time]\nend = '0.5 s'\nstep = '200 us'\n\
         [beam.t]\nmaterial = 'a'\nspan = '36 cm'\nwidth = '3 cm'\nthickness = '1 cm'\nelements = 10\n\
         [block.b]\nmaterial = 'a'\nwidth = '4 cm'\nheight = '1 cm'\ndepth = '3 cm'\non = 't'\nat = '30 cm'\nvelocity = ['1 m/s', '0 m/s']\n\
         [contact.f]\nbetween = ['b', 't']\nfriction = 0.05\n";
    let ran = scene("left", text);
    let at = ran.column("b.x");
    let gone = at.iter().position(|x| *x > 0.36).unwrap();
    let (kind, way) = what(&ran);
    assert_eq!((kind, way), ("left", Some("right")), "it has left, though it turns over as it falls");
    let when = ran.verdict("b")["t"].as_f64().unwrap();
    let t = ran.column("t");
    // It tips over the end first, and leaves it when the end presses on it for the last time.
    let contacts = std::fs::read_to_string(ran.folder.join("contacts.csv")).unwrap();
    let mut lines = contacts.lines();
    let p_n = lines.next().unwrap().split(',').position(|name| name == "p_n").unwrap();
    let rows = lines.map(|line| line.split(',').collect::<Vec<_>>());
    let pressed = rows.filter(|row| row[p_n].parse::<f64>().unwrap() > 0.0).map(|row| row[0].parse().unwrap());
    let last = pressed.fold(0.0, f64::max);
    assert!(last > t[gone], "{last}");
    assert_eq!(when, last);
    let early = scene("left-early", &text.replace("0.5 s", &format!("{} s", t[gone + 5])));
    let headline = early.summary["headline"].as_str().unwrap();
    assert!(headline.starts_with("`b` tipped over the right end of `t` at t = "), "{headline}");
    assert!(headline.ends_with(" and still touches it"), "{headline}");
    let tipped = early.verdict("b")["t"].as_f64().unwrap();
    assert!(t[gone - 1] <= tipped && tipped <= t[gone], "{tipped}");
    // Ten steps after the end pressed for the last time.
    let just = scene("left-just", &text.replace("0.5 s", &format!("{} s", last + 2e-3)));
    let headline = just.summary["headline"].as_str().unwrap();
    assert!(!headline.contains("still touches") && just.verdict("b")["t"] == last, "{headline}");
    assert!(ran.column("b.phi").last().unwrap() < &-1.5 && ran.summary["overturned_at"].is_null());
}

/// Two blocks of 10 cm, the upper one on the lower, which slides down a slope of 30° by more than they are high.
const RIDERS: &str = "[block.b]\nmaterial = 'a'\nwidth = '20 cm'\nheight = '10 cm'\ndepth = '10 cm'\non = 'ground'\nat = '0 m'\n\
    [block.rider]\nmaterial = 'a'\nwidth = '10 cm'\nheight = '5 cm'\ndepth = '10 cm'\non = 'b'\nat = '0 m'\n\
    [contact.rides]\nbetween = ['rider', 'b']\nfriction = 2.0\n";

#[test]
fn what_rides_down_a_slope_has_not_fallen() {
    let text = format!(
        "[time]\nend = '0.6 s'\nstep = '1 ms'\n[ground]\nincline = '-30 deg'\n{RIDERS}[contact.f]\nbetween = ['b', 'ground']\nfriction = 0.1\n"
    );
    let ran = scene("riders", &text);
    let y = ran.column("rider.y");
    assert!(y[0] - y.last().unwrap() > 0.2, "{y:?}");
    assert_ne!(ran.verdict("rider")["what"], "fell", "{}", ran.verdict("rider"));
}

#[test]
fn what_slides_back_is_told_with_how_far_it_was() {
    // It starts at 1 m/s to the right; friction of 0.1 m g and a force of 0.3 m g to the left stop it after 127 mm, then it comes back with 0.2 g.
    let block = "[block.b]\nmaterial = 'a'\nwidth = '20 cm'\nheight = '2 cm'\ndepth = '10 cm'\non = 'ground'\nat = '0 m'\nvelocity = ['1 m/s', '0 m/s']\n";
    let mass = 2700.0 * 0.2 * 0.02 * 0.1;
    let force = format!("[force.back]\non = 'b'\nforce = ['{} N', '0 N']\n", -0.3 * 9.81 * mass);
    let floor = FLOOR.replace("0.5", "0.1");
    let ran = scene("back", &format!("[time]\nend = '0.5 s'\nstep = '200 us'\n[ground]\n{block}{force}{floor}"));
    let of = ran.verdict("b");
    let farthest = of["farthest"].as_f64().unwrap();
    // v²/(2 a) with a = 0.4 g, to the steps of a first-order scheme.
    assert!((farthest - 1.0 / (2.0 * 0.4 * 9.81)).abs() < 1e-3, "{of}");
    let headline = ran.summary["headline"].as_str().unwrap();
    assert!(headline.contains("slid 12") && headline.contains("mm to the right, then back to "), "{headline}");
    assert!(headline.ends_with("mm right of its start so far"), "{headline}");
    // From the turning point on with 0.2 g, for what is left of 0.5 s.
    let turned_at = 1.0 / (0.4 * 9.81);
    assert!((of["speed"].as_f64().unwrap() - 0.2 * 9.81 * (0.5 - turned_at)).abs() < 3e-3, "{of}");
}

#[test]
fn a_tilted_block_that_came_down_and_slides_on_is_told_as_sliding() {
    let text = "[time]\nend = '1.2 s'\nstep = '1 ms'\n[ground]\nincline = '25 deg'\n\
        [block.b]\nmaterial = 'a'\nwidth = '10 cm'\nheight = '6 cm'\ndepth = '10 cm'\non = 'ground'\nat = '0 m'\ntilt = '0.532 deg'\n\
        [contact.f]\nbetween = ['b', 'ground']\nfriction = 0.3\n";
    let ran = scene("tilted-slides", text);
    assert_eq!(ran.summary["verdict"][0]["what"], "slid");
    let headline = ran.summary["headline"].as_str().unwrap();
    assert!(
        headline.starts_with("`b` slides on, slid by 1.06") && headline.contains("down the slope so far"),
        "{headline}"
    );
    assert!(!headline.contains("peak"), "{headline}");
}

/// The slip of each point of `b` on the ground at the end, as `contacts.csv` has it, m.
fn slips(ran: &Ran) -> Vec<f64> {
    let contacts = std::fs::read_to_string(ran.folder.join("contacts.csv")).unwrap();
    let rows: Vec<Vec<&str>> = contacts.lines().map(|line| line.split(',').collect()).collect();
    let [point, slip] = ["point", "slip"].map(|name| rows[0].iter().position(|column| *column == name).unwrap());
    let mut last: Vec<(&str, f64)> = Vec::new();
    for row in &rows[1..] {
        last.retain(|(of, _)| *of != row[point]);
        last.push((row[point], row[slip].parse().unwrap()));
    }
    last.into_iter().map(|(_, slip)| slip).collect()
}

/// A plate of 20 cm × 5 cm over the ground.
fn plate(name: &str, height: &str, velocity: &str, floor: &str) -> Ran {
    let text = format!(
        "[time]\nend = '3 s'\nstep = '200 us'\n[ground]\n[block.b]\nmaterial = 'a'\nwidth = '20 cm'\nheight = '5 cm'\ndepth = '10 cm'\n\
         position = ['0 m', '{height}']\nvelocity = {velocity}\n[contact.c]\nbetween = ['b', 'ground']\n{floor}"
    );
    scene(name, &text)
}

#[test]
fn what_hops_along_slid_only_while_it_pressed() {
    let ran = plate("hops-along", "2.5 cm", "['1 m/s', '0.8 m/s']", "friction = 0.3\nrestitution = 0.5\n");
    let (of, slips, x) = (ran.verdict("b"), slips(&ran), ran.column("b.x"));
    let moved = x[x.len() - 1] - x[0];
    let slid = of["slid"].as_f64().unwrap();
    // Both feet press alike, as it stays flat.
    assert!(slips.len() == 2 && slips.iter().all(|slip| (slip - slid).abs() < 1e-6), "{slid}: {slips:?}");
    assert!(moved > 10.0 * slid && slid > 0.01, "{slid} of {moved}");
    assert!((of["displaced"].as_f64().unwrap() - moved).abs() < 1e-6, "{of}");
    let headline = ran.summary["headline"].as_str().unwrap();
    assert!(
        headline.starts_with("`b` slid by 13.") && headline.contains(" mm to the right (with hops and flights 261."),
        "{headline}"
    );
}

#[test]
fn what_is_thrown_and_then_slides_has_slid_since_it_landed() {
    let ran = plate("thrown-flat", "50 cm", "['2 m/s', '0 m/s']", "friction = 0.2\n");
    let (t, x, y) = (ran.column("t"), ran.column("b.x"), ran.column("b.y"));
    let landed = y.iter().position(|y| *y < 0.0251).unwrap();
    let wanted = x[x.len() - 1] - x[landed];
    let slid = ran.verdict("b")["slid"].as_f64().unwrap();
    // Within what it flies in a row.
    assert!((slid - wanted).abs() < 2.0 * (t[landed] - t[landed - 1]) && wanted > 0.4, "{slid} of {wanted}");
    let headline = ran.summary["headline"].as_str().unwrap();
    assert!(
        headline.starts_with("`b` slid by 49")
            && headline.contains(" m right of where it was released) and came to rest"),
        "{headline}"
    );
}

#[test]
fn without_gravity_there_is_no_slope_to_slide_down() {
    let text = "[world]\ngravity = '0 m/s^2'\n[material.a]\ndensity = '2000 kg/m^3'\n[time]\nend = '1 s'\nstep = '1 ms'\n[ground]\n[block.b]\n\
                material = 'a'\nwidth = '20 cm'\nheight = '6 cm'\ndepth = '10 cm'\non = 'ground'\nat = '0 m'\nvelocity = ['1 m/s', '0 m/s']\n\
                [force.f]\non = 'b'\nforce = ['0 N', '-10 N']\n[contact.c]\nbetween = ['b', 'ground']\nfriction = 0.4\n";
    let ran = written(&folder("verdict-weightless"), text);
    let x = ran.column("b.x");
    assert!((ran.verdict("b")["slid"].as_f64().unwrap() - (x[x.len() - 1] - x[0])).abs() < 1e-9);
    let headline = ran.summary["headline"].as_str().unwrap();
    assert!(headline.starts_with("`b` slid") && headline.contains("to the right"), "{headline}");
}

/// The way along the surface is longer than its projection on the slope of the start.
#[test]
fn what_slides_from_one_piece_of_a_profile_to_the_next_does_not_hop() {
    let text = "[time]\nend = '1.5 s'\nstep = '200 us'\nscheme = 'moreau-jean-located'\n[ground.profile]\n\
        points = [['-1 m', '0.5 m'], ['0 m', '0 m'], ['3 m', '0 m']]\n[material.m]\ndensity = '2000 kg/m^3'\n[block.b]\nmaterial = 'm'\n\
        width = '10 cm'\nheight = '4 cm'\ndepth = '10 cm'\non = 'ground'\nat = '-0.5 m'\n[contact.g]\nbetween = ['b', 'ground']\nfriction = 0.2\n";
    let ran = written(&folder("verdict-profile"), text);
    let headline = ran.summary["headline"].as_str().unwrap();
    assert!(headline.starts_with("`b` slid by 1.05") && !headline.contains("hops"), "{headline}");
}
