//! Energy that contacts make is warned of, and what the warning says to take makes none.

use crate::page::run;
use std::fs;
use std::path::Path;
use teeter_report::{ENERGY_MADE, ENERGY_TAKEN, EndedWord, Record, Summary};
use teeter_scenario::simulation::Simulation;

/// The summary of a run in memory.
fn summary(text: &[u8], folder: &Path, sets: &[&str]) -> Summary {
    let pair = |set: &&str| set.split_once('=').map(|(key, value)| (key.to_owned(), value.to_owned()));
    let sets: Vec<(String, String)> = sets.iter().filter_map(pair).collect();
    let mut read = |file: &str| fs::read(folder.join(file)).map_err(|error| error.to_string());
    let resolved = teeter_scenario::load_with(text, "scene.toml", "scene", &sets, &mut read).unwrap();
    let mut simulation = Simulation::new(&resolved.scene).unwrap();
    let ended = simulation.run(&mut []).unwrap();
    let (layout, state) = (&simulation.layout, &simulation.state);
    Summary::new(&resolved.scene, layout, state, &Record::default(), EndedWord::from(&ended), 0.0)
}

fn warning(summary: &Summary) -> Option<&str> {
    summary.warnings.iter().find(|warning| warning.code == ENERGY_MADE).map(|warning| warning.text.as_str())
}

/// Warned of with `sets`; and not with the scheme that the warning names.
fn warns(text: &[u8], folder: &Path, sets: &[&str]) {
    let sets = &[sets, &["time.scheme=moreau-jean"]].concat()[..];
    let made = summary(text, folder, sets);
    let Some(told) = warning(&made) else { panic!("{sets:?}: {:?}", made.energy) };
    assert!(told.contains("`time.scheme = \"moreau-jean-closed\"`"), "{told}");
    let work = made.energy.positive_contact_work;
    for number in [work.sum, work.largest] {
        assert!(told.contains(&teeter_report::with_digits(number, "J", 3)), "{told}");
    }
    let closed = [sets, &["time.scheme=moreau-jean-closed"]].concat();
    let without = summary(text, folder, &closed);
    assert_eq!(warning(&without), None, "{sets:?}");
    let left = without.energy.positive_contact_work.sum;
    assert!(left <= 1e-4 * work.sum, "{sets:?}: still {left:e} J of {:e} J", work.sum);
}

#[test]
fn energy_made_in_impacts_with_friction_is_warned_of() {
    for law in ["newton", "poisson"] {
        for mu in ["0.5", "1000"] {
            let sets = [format!("contact.a.law={law}"), format!("contact.b.law={law}")];
            let friction = [format!("contact.a.friction={mu}"), format!("contact.b.friction={mu}")];
            let sets: Vec<&str> = sets.iter().chain(&friction).map(String::as_str).collect();
            warns(include_bytes!("two-blocks.toml"), Path::new("."), &sets);
        }
    }
}

#[allow(clippy::print_stderr)]
fn skip(name: &str) {
    eprintln!("skipped: {name}.toml is not here");
}

/// The scenes in which the trial found it.
#[test]
fn energy_made_by_the_scheme_is_warned_of() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/scenes");
    for (name, end) in [("timber-two-span", "0.5 s"), ("shaken-supports", "10 s")] {
        let Ok(text) = fs::read(folder.join(format!("{name}.toml"))) else {
            skip(name);
            continue;
        };
        let end = format!("time.end={end}");
        warns(&text, &folder, &[&end]);
    }
}

/// At their own settings: far below 1 % of the loss, or nothing.
#[test]
fn scenarios_that_make_none_are_not_warned_of() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios");
    for name in
        ["drop", "sliding", "incline", "pushed-block", "compliant-drop", "free-rocking-on-ground", "shaken-ground"]
    {
        let text = fs::read(folder.join(format!("{name}.toml"))).unwrap();
        assert_eq!(warning(&summary(&text, &folder, &[])), None, "{name}");
    }
}

/// What the filter of `resolved` and θ = 1 take from a beam that rattles under a block; what takes none isn't warned of.
#[test]
fn energy_that_a_scheme_takes_is_warned_of() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios");
    let text = fs::read_to_string(folder.join("free-rocking-on-beam-undeformed-start.toml")).unwrap();
    let taken = |text: &str, sets: &[&str]| {
        let summary = summary(text.as_bytes(), &folder, &[sets, &["time.end=0.2 s", "time.step=1 ms"]].concat());
        let told = summary.warnings.iter().find(|warning| warning.code == ENERGY_TAKEN)?;
        assert!(told.text.contains(&teeter_report::with_digits(summary.energy.scale, "J", 3)), "{}", told.text);
        Some(told.text.clone())
    };
    let theta = taken(&text, &["time.scheme=moreau-jean", "time.theta=1"]).unwrap();
    assert!(theta.contains("`time.theta = 0.5` takes none"), "{theta}");
    assert_eq!(taken(&text, &["time.scheme=moreau-jean", "time.theta=0.5"]), None);
    assert_eq!(taken(&text, &["time.scheme=resolved"]), None);
    // The block falls flat on the beam instead, from 2 cm.
    let places = ["on       = \"table\"\n", "at       = \"18 cm\"", "tilt     = \"5 deg\""];
    let dropped =
        places.iter().zip(["", "position = [\"18 cm\", \"9 cm\"]", ""]).fold(text.clone(), |text, (line, new)| {
            assert!(text.contains(line), "{line}");
            text.replace(line, new)
        });
    let filter = taken(&dropped, &["time.scheme=resolved"]).unwrap();
    assert!(filter.contains("oscillations of beams"), "{filter}");
    assert_eq!(taken(&dropped, &["time.scheme=moreau-jean-located"]), None);
}

#[test]
fn a_work_that_is_nothing_beside_the_energies_is_told_and_not_drawn() {
    let text = |friction: &str| {
        format!(
            "[time]\nend = '0.2 s'\nstep = '500 us'\n[ground]\n[block.slides]\ndensity = '1000 kg/m^3'\nwidth = '10 cm'\nheight = '5 cm'\n\
             depth = '10 cm'\non = 'ground'\nat = '0 m'\nvelocity = ['1 m/s', '0 m/s']\n[contact.floor]\nbetween = ['slides', 'ground']\n\
             friction = {friction}\n"
        )
    };
    let told = "Too small beside the energies for a plot: the work “friction” (at most";
    // It takes 2 µ g s/v² of the kinetic energy: 4 µ.
    let little = run("little-friction", &text("1e-6")).html;
    assert!(little.contains(told) && !little.contains("\"id\":\"works\""));
    let more = run("more-friction", &text("1e-3")).html;
    assert!(!more.contains(told) && more.contains("\"id\":\"works\""));
}
