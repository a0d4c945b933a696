//! Records that prescribe motions, in the summary, in the figures and on the page.

use std::f64::consts::PI;
use teeter_report::{EndedWord, PageRecorder, Recorder, Results, Summary, figures, render};
use teeter_scenario::load_with;
use teeter_scenario::simulation::Simulation;

struct Run {
    summary: serde_json::Value,
    html: String,
    figures: Vec<(String, String)>,
}

fn run(name: &str, motion: &str) -> Run {
    run_to("50 ms", name, motion)
}

fn run_to(end: &str, name: &str, motion: &str) -> Run {
    let text = format!(
        "[time]\nend = '{end}'\nstep = '1 ms'\n[ground]\n{motion}\n[material.m]\ndensity = '1000 kg/m^3'\n\
         [block.b]\nmaterial = 'm'\nwidth = '10 cm'\nheight = '10 cm'\ndepth = '10 cm'\non = 'ground'\nat = '0 m'\n\
         [contact.c]\nbetween = ['b', 'ground']\nfriction = 0.9\n"
    );
    let file = "t,a\n0,0\n0.5,1\n1,0\n1.5,-1\n2,0\n";
    let resolved = load_with(text.as_bytes(), name, name, &[], &mut |_| Ok(file.into())).unwrap();
    let mut simulation = Simulation::new(&resolved.scene).unwrap();
    let layout = simulation.layout.clone();
    let folder =
        std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("records-{}-{name}", std::process::id()));
    let results = Results::create(&folder, true).unwrap();
    let mut tell = |_: &str| {};
    let mut recorder = Recorder::new(&results, &resolved.scene, &layout, &mut tell).unwrap();
    let mut page = PageRecorder::new(&resolved.scene, &layout);
    let ended = simulation.run(&mut [&mut recorder, &mut page]).unwrap();
    let record = recorder.into_record();
    let summary = Summary::new(&resolved.scene, &layout, &simulation.state, &record, EndedWord::from(&ended), 0.25);
    let html = render(&page, &summary, &resolved.document.to_toml());
    let figures = figures(&page);
    std::fs::remove_dir_all(folder).unwrap();
    Run { summary: serde_json::from_str(&summary.to_json().unwrap()).unwrap(), html, figures }
}

#[test]
fn a_record_is_measured_and_drawn() {
    let run = run("one", "motion.x = { record = 'quake.csv', scale = 2 }");
    let record = &run.summary["records"][0];
    assert_eq!((&record["motion"], &record["file"]), (&"ground.motion.x".into(), &"quake.csv".into()));
    let near = |key: &str, exact: f64| {
        let found = record[key].as_f64().unwrap();
        assert!((found / exact - 1.0).abs() < 1e-14, "{key}: {found} {exact}");
    };
    // Two triangles of 2 m/s² over 1 s each, one up and one down; ∫a² of a triangle is a²T/3.
    near("peak_acceleration", 2.0);
    near("peak_velocity", 1.0);
    near("peak_displacement", 1.0);
    near("arias_intensity", PI / (2.0 * 9.80665) * 2.0 * 4.0 / 3.0);
    near("duration", 2.0);
    near("step", 0.5);
    let names: Vec<&str> = run.figures.iter().map(|(name, _)| name.as_str()).collect();
    assert!(names.ends_with(&["energy.svg", "records.svg", "spectra.svg"]), "{names:?}");
    let figure = |name: &str| &run.figures.iter().find(|(file, _)| file == name).unwrap().1;
    for label in ["Acceleration a (m/s²)", "Velocity v (cm/s)", "Displacement d (cm)", "t (s)"] {
        assert!(figure("records.svg").contains(label), "{label}");
    }
    for label in ["Pseudo-acceleration S<tspan", "Displacement S<tspan", "Natural period T (s)"] {
        assert!(figure("spectra.svg").contains(label), "{label}");
    }
    assert!(run.html.contains("id=\"records\"") && run.html.contains("data-record=\"ground.motion.x\""));
    assert!(run.html.contains("Pseudo-acceleration S<tspan"));
    // Measures stand below each other, so that a telephone shows them all.
    assert!(run.html.contains("(PGA) <span class=\"unit\">(m/s²)</span></th><td>2</td></tr>"), "{}", run.html);
}

#[test]
fn two_records_share_their_figures_and_a_scene_without_has_none() {
    let two = run("two", "motion = { x = { record = 'a.csv' }, y = { record = 'b.csv', scale = 0.1 } }");
    assert_eq!(two.summary["records"].as_array().unwrap().len(), 2);
    let (_, svg) = two.figures.iter().find(|(file, _)| file == "records.svg").unwrap();
    assert!(svg.contains(">ground x<") && svg.contains(">ground y<"));
    let none = run("none", "");
    assert!(none.summary.get("records").is_none() && !none.html.contains("id=\"records\""));
    assert!(none.figures.iter().all(|(file, _)| file != "records.svg" && file != "spectra.svg"));
}

#[test]
fn a_record_that_the_plots_of_the_ground_show_is_not_drawn_again() {
    let motion = "motion.x = { record = 'quake.csv' }";
    let [part, whole] = [("part", "50 ms"), ("whole", "2 s")].map(|(name, end)| run_to(end, name, motion));
    let again = "Time since the start of the record";
    assert!(part.html.contains(again), "a run of 50 ms shows no record of 2 s");
    assert!(!whole.html.contains(again));
    for run in [part, whole] {
        assert!(run.html.contains("Pseudo-acceleration"));
        assert!(run.figures.iter().any(|(file, svg)| file == "records.svg" && svg.contains(again)));
    }
}

#[test]
fn the_peak_of_what_was_run_stands_beside_that_of_the_whole_record() {
    let motion = "motion.x = { record = 'quake.csv', scale = 2 }";
    let [part, whole] = [("cut", "0.25 s"), ("all", "2 s")].map(|(name, end)| run_to(end, name, motion));
    // Half-way up the first triangle.
    let record = &part.summary["records"][0];
    assert_eq!((&record["peak_acceleration"], &record["peak_acceleration_in_run"]), (&2.0.into(), &1.0.into()));
    let row = "PGA of the part that was run <span class=\"unit\">(m/s²)</span></th><td>1</td>";
    assert!(part.html.contains(row));
    assert!(
        whole.summary["records"][0].get("peak_acceleration_in_run").is_none() && !whole.html.contains("that was run")
    );
}
