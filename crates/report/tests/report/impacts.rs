//! Impacts, crossings and peaks are of the motion, not of the step.

use std::path::Path;
use teeter_report::{EndedWord, Recorder, Results, Summary};
use teeter_scenario::simulation::Simulation;

/// The summary of a run of `text`.
pub(crate) fn summary(name: &str, text: &str, sets: &[(&str, &str)]) -> Summary {
    let sets: Vec<_> = sets.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    let resolved = teeter_scenario::load(text.as_bytes(), name, name, &sets).unwrap();
    let mut simulation = Simulation::new(&resolved.scene).unwrap();
    let layout = simulation.layout.clone();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("impacts-{}", std::process::id())).join(name);
    let results = Results::create(&folder, true).unwrap();
    let mut tell = |_: &str| {};
    let mut recorder = Recorder::new(&results, &resolved.scene, &layout, &mut tell).unwrap();
    let ended = simulation.run(&mut [&mut recorder]).unwrap();
    let record = recorder.into_record();
    Summary::new(&resolved.scene, &layout, &simulation.state, &record, EndedWord::from(&ended), 0.25)
}

pub(crate) fn scenario(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios");
    std::fs::read_to_string(folder.join(format!("{name}.toml"))).unwrap()
}

#[test]
fn the_impacts_of_the_default_scene_do_not_grow_with_steps_and_elements() {
    let text = scenario("free-rocking-on-beam");
    let run = |step: &str, elements: &str| {
        let name = format!("beam-{}-{elements}", step.replace(' ', "-"));
        summary(&name, &text, &[("time.step", step), ("beam.table.elements", elements), ("time.end", "0.16 s")])
    };
    let runs = [run("100 us", "20"), run("20 us", "20"), run("50 us", "80")];
    for found in &runs {
        assert!(
            found.impacts[0].t > 0.1,
            "the first impact is that of the corner that comes down: {:?}",
            found.impacts[0]
        );
        assert!(found.impact_count <= 4, "{} impacts", found.impact_count);
    }
    assert!(runs.iter().any(|found| found.reclosure_count > 0), "what isn't an impact is counted all the same");
}

#[test]
fn a_block_that_rocks_on_rigid_ground_has_an_impact_at_each_crossing() {
    let text = scenario("free-rocking-on-ground");
    let counts = ["1 ms", "200 us", "50 us"].map(|step| {
        let found = summary(&format!("ground-{}", step.replace(' ', "-")), &text, &[("time.step", step)]);
        assert_eq!(found.impact_count, found.crossings.len() as u64, "{step}");
        for (impact, crossing) in found.impacts.iter().zip(&found.crossings) {
            assert!((impact.t - crossing.t).abs() < 4e-3, "{step}: {} {}", impact.t, crossing.t);
        }
        found.impact_count
    });
    assert!(counts.iter().all(|count| *count == counts[2] && *count >= 6), "{counts:?}");
}

#[test]
fn a_block_that_bounces_has_impacts_down_to_bounces_that_count_as_none() {
    let text = scenario("drop");
    let counts = ["200 us", "50 us", "20 us"].map(|step| {
        let found = summary(&format!("drop-{}", step.replace(' ', "-")), &text, &[("time.step", step)]);
        found.impact_count
    });
    // Two corners each time.
    assert!(counts.iter().all(|count| count.abs_diff(counts[2]) <= 2 && *count >= 10), "{counts:?}");
}

/// Shaken so that it only just lifts, a block opens and closes all the time without an impact.
#[test]
fn where_nothing_strikes_there_are_no_impulses_of_impacts() {
    let text = r#"
time = { end = "2 s", step = "200 us" }
ground.motion = { acceleration = ["2.5 m/s^2", "0 m/s^2"], signal = "shake" }
signal.shake = { shape = "harmonic", frequency = "2.5 Hz" }
material.marble.density = "2700 kg/m^3"
block.slab = { material = "marble", width = "25 cm", height = "1 m", depth = "20 cm", on = "ground", at = "0 m" }
contact.base = { between = ["slab", "ground"], friction = 0.6 }
"#;
    let run = crate::page::run("just-lifts", text);
    assert!(run.summary.impact_count == 0 && run.summary.reclosure_count > 0, "{}", run.summary.reclosure_count);
    let data = crate::page::data(&run.html);
    let points = data["forces"]["points"].as_array().unwrap();
    assert!(points.len() == 2 && points.iter().all(|point| point["impacts"].is_null()), "{points:?}");
}

const BLOCK: &str = r#"
time = { end = "1 s", step = "100 us" }
material.aluminium.density = "2700 kg/m^3"
block.rocker = { material = "aluminium", width = "3 cm", height = "13.5 cm", depth = "3 cm", on = "ground", at = "0 m", tilt = "TILT" }
contact.feet = { between = ["rocker", "ground"], friction = 0.5 }
"#;

#[test]
fn rocking_is_measured_from_the_surface_that_carries_the_block() {
    let inclined = format!("{}\nground.incline = \"5 deg\"\n", BLOCK.replace("TILT", "3 deg"));
    let found = summary("inclined", &inclined, &[]);
    assert!(found.crossings.len() >= 10, "{} crossings", found.crossings.len());
    assert!(
        (found.peaks[0].phi - 3_f64.to_radians()).abs() < 1e-12,
        "the release, from the incline: {:?}",
        found.peaks[0]
    );
    assert_eq!(found.impact_count, found.crossings.len() as u64);

    // Turned by 5 degrees within a second, by fits and starts, slowly enough for the block to stand.
    let turning = format!(
        "{}\nground.motion = {{ angular_acceleration = \"1 rad/s^2\", signal = \"slow\" }}\nsignal.slow = {{ shape = \"harmonic\", frequency = \"2 Hz\" }}\n",
        BLOCK.replace("TILT", "0 deg")
    );
    let found = summary("turning", &turning, &[]);
    assert!(found.crossings.is_empty() && found.peaks.is_empty(), "{:?}", found.crossings);
    assert_eq!(found.impact_count, 0);
}

/// One that lands flat is one bounce to a person, and two impacts.
#[test]
fn impacts_are_said_to_be_counted_by_corners() {
    let drop = crate::page::scenario("drop");
    assert_eq!(drop.summary.impact_count % 2, 0, "both corners of a flat base strike at once");
    assert!(drop.html.contains("<dt>Impacts (each corner counts)</dt>"));
}

/// Nothing strikes where nothing moves, and what stands is in its ground by no more than rounding.
#[test]
fn a_cube_that_stands_still_has_no_way_of_counting_impacts_and_no_penetration() {
    let run = crate::page::run("told-incline", &scenario("incline"));
    assert_eq!(run.summary.impact_count, 0);
    assert!(run.summary.max_penetration < 1e-15, "{}", run.summary.max_penetration);
    assert!(run.html.contains("<dt>Impacts</dt>"));
    let tile = &run.html[run.html.find("<dt>Deepest penetration").unwrap()..];
    let tile = &tile[..tile.find("</dd>").unwrap()];
    assert!(tile.ends_with(">0\u{a0}m"), "{tile}");
    assert_eq!((run.summary.strikers(), run.summary.told_penetration()), ("", 0.0));
    // Stones that slide on each other are a picometre deep, less than an atom, for good.
    let wall = crate::page::run("told-wall", &scenario("dry-stone-wall"));
    assert!((1e-13..1e-11).contains(&wall.summary.max_penetration), "{}", wall.summary.max_penetration);
    assert!(wall.html.contains("<dt>Deepest penetration</dt>"));
    assert_eq!(wall.summary.told_penetration(), 0.0);
}

/// At a kink of the ground a corner touches two pieces of it in the step of its impact, which no located scheme finds: neither is a force.
#[test]
fn an_impact_at_a_kink_leaves_no_peak_in_the_force() {
    let text = "[time]\nend = '4 s'\nstep = '500 us'\n[ground]\nprofile = { points = [['-3 m', '1.5 m'], ['-0.5 m', '0 m'], \
        ['0.5 m', '0 m'], ['3 m', '1.5 m']] }\n[block.sled]\ndensity = '2700 kg/m^3'\nwidth = '20 cm'\nheight = '10 cm'\n\
        depth = '30 cm'\non = 'ground'\nat = '-2 m'\n[contact.base]\nbetween = ['sled', 'ground']\nfriction = 0.05\n";
    let run = crate::page::run("valley", text);
    assert!(run.summary.unlocated_steps > 0, "or the impacts are at instants of their own");
    let page = crate::page::data(&run.html);
    let points = page["forces"]["points"].as_array().unwrap().iter();
    let forces = points.flat_map(|point| [&point["normal"], &point["course"][0]["y"]]).flat_map(crate::page::numbers);
    let most = forces.fold(0.0, f64::max);
    // The block weighs 159 N, and no step without an impact has more than 102 N at a corner; with the impulse beside the impact it was 117 N.
    assert!((80.0..105.0).contains(&most), "{most}");
    // The slip of a point goes on where it comes to another piece of the ground.
    let table = std::fs::read_to_string(run.folder.join("contacts.csv")).unwrap();
    let mut slips = std::collections::BTreeMap::<&str, (f64, f64)>::new();
    for row in table.lines().skip(1).map(|row| row.split(',').collect::<Vec<_>>()) {
        let slip: f64 = row.last().unwrap().parse().unwrap();
        let (last, most) = slips.entry(row[4]).or_insert((slip, slip));
        assert!((slip - *last).abs() < 0.01, "{row:?} after {last}");
        (*last, *most) = (slip, most.max(slip));
    }
    let of = &run.summary.verdict[0];
    let (slid, farthest) = (of.slid.unwrap(), of.farthest.unwrap());
    assert!(slips.len() >= 2);
    // It rocks a little as it goes, so that one foot slips farther than the other.
    for (point, (last, most)) in slips {
        let of_sums = [last / slid, most / farthest];
        assert!(
            of_sums.iter().all(|part| (part - 1.0).abs() < 0.03),
            "{point}: {last} of {slid}, {most} of {farthest}"
        );
    }
}

/// Landings on springs are counted alike.
#[test]
fn impacts_on_springs_are_said_to_be_counted_by_corners() {
    let told = summary("told-springs", &scenario("compliant-drop"), &[]);
    assert_eq!((told.impact_count > 0, told.strikers()), (true, " (each corner counts)"));
}

/// A block that is given a spin about another point than its foot loses it in the first step: an impulse, which no table lists, and no force.
#[test]
fn the_impulse_with_which_a_run_begins_is_in_the_plot_of_impulses() {
    let text = r#"
time = { end = "0.1 s", step = "0.2 ms" }
ground = {}
block.west = { density = "2400 kg/m^3", width = "20 cm", height = "1 m", depth = "20 cm", on = "ground", at = "0 m", spin = "3 rad/s", tilt = "3 deg" }
contact.base = { between = ["west", "ground"], friction = 0.6 }
"#;
    let run = crate::page::run("spun", text);
    assert_eq!(run.summary.impact_count, 0);
    let page = crate::page::data(&run.html);
    let point = &page["forces"]["points"][0];
    let impulses = crate::page::numbers(&point["impacts"]);
    assert!((impulses[0] - 16.2).abs() < 0.2 && impulses[1..].iter().all(|p| *p == 0.0), "{impulses:?}");
    // It weighs 942 N.
    assert!(crate::page::numbers(&point["normal"]).iter().all(|force| *force < 1200.0), "{point}");
}
