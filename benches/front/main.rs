//! Error against cost of all schemes for a block that rocks on a beam, after its impacts: a table
//! in Markdown on standard output, and a figure.
//!
//! The error is the root of the mean square, over scenes, of the difference of φ from a reference
//! at 0.15, 0.2, 0.25 and 0.3 s. There are two references that share neither formulation nor mesh:
//! `event-driven`, which takes impacts on the nodes of the scene's mesh one by one, and `resolved`
//! with steps of 20 µs on twice as many elements, which knows no impulses. Below their disagreement
//! no claim is made; the figure shows it as a band.
//!
//! ```text
//! cargo bench -p teeter-benches --bench front -- [--keep FOLDER] [FIGURE.svg]
//! ```
//!
//! With `--keep`, references are read from the folder, and written there where they are missing:
//! `event-driven` takes minutes.
#![allow(clippy::expect_used)] // a measurement that can't be set up has nothing to go on with

use std::error::Error;
use std::fmt::Write as _;
use std::io::Write as _;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use teeter_integrator::{Model, Observer, ObserverError, State, StepReport};
use teeter_plot::{Axis, Figure, Legend, Mark, Panel, Series};
use teeter_scenario::simulation::Simulation;
use teeter_study::Work;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// A scene: its name, and what it sets in the paper's one.
struct Scene {
    name: &'static str,
    sets: &'static [(&'static str, &'static str)],
}

/// The seven scenes of the scheme's first measurements, and six that were drawn later, with other
/// blocks, places, damping, supports.
const SCENES: [Scene; 13] = [
    Scene { name: "1.5 mm, undeformed", sets: &[("beam.table.start", "undeformed")] },
    Scene { name: "1.5 mm, static", sets: &[] },
    Scene { name: "3 mm, static", sets: &[("beam.table.thickness", "3 mm")] },
    Scene { name: "3 mm, undeformed", sets: &[("beam.table.thickness", "3 mm"), ("beam.table.start", "undeformed")] },
    Scene { name: "1.5 mm, static, 2°", sets: &[("block.rocker.tilt", "2 deg")] },
    Scene { name: "5 mm, static", sets: &[("beam.table.thickness", "5 mm")] },
    Scene { name: "1.5 mm, static, 10 elements", sets: &[("beam.table.elements", "10")] },
    Scene { name: "at a third of the span", sets: &[("block.rocker.at", "12 cm"), ("beam.table.thickness", "2 mm")] },
    Scene {
        name: "clamped, 1 mm",
        sets: &[("beam.table.supports", "[\"clamped\", \"clamped\"]"), ("beam.table.thickness", "1 mm")],
    },
    Scene {
        name: "wide block, 3°",
        sets: &[("block.rocker.width", "5 cm"), ("block.rocker.tilt", "3 deg"), ("beam.table.thickness", "2.5 mm")],
    },
    Scene {
        name: "little damping",
        sets: &[
            ("beam.table.damping_ratio.ratio", "1e-3"),
            ("beam.table.thickness", "2 mm"),
            ("block.rocker.tilt", "4 deg"),
        ],
    },
    Scene { name: "light block", sets: &[("block.rocker.depth", "1 cm"), ("block.rocker.tilt", "-4 deg")] },
    Scene {
        name: "on the top fibre",
        sets: &[("beam.table.surface", "top"), ("beam.table.thickness", "4 mm"), ("block.rocker.tilt", "3 deg")],
    },
];

/// Times at which φ is compared, s: the first impacts are over by 0.15 s.
const TIMES: [f64; 4] = [0.15, 0.2, 0.25, 0.3];
const END: &str = "300 ms";

/// Steps: all of them divide the times.
const STEPS: [&str; 9] = ["2 ms", "1 ms", "500 us", "200 us", "100 us", "50 us", "20 us", "10 us", "5 us"];

/// A label, a scheme, and what else is set.
type Setting = (&'static str, &'static str, &'static [(&'static str, &'static str)]);

/// What is measured.
const SETTINGS: [Setting; 8] = [
    ("moreau-jean", "moreau-jean", &[]),
    ("moreau-jean-closed", "moreau-jean-closed", &[]),
    ("moreau-jean-located", "moreau-jean-located", &[]),
    ("moreau-jean-projected", "moreau-jean-projected", &[]),
    ("generalized-alpha", "generalized-alpha", &[]),
    ("resolved", "resolved", &[]),
    ("resolved, 16 modes", "resolved", &[("beam.table.model", "modes"), ("beam.table.modes.count", "16")]),
    ("located, 16 modes", "moreau-jean-located", &[("beam.table.model", "modes"), ("beam.table.modes.count", "16")]),
];

struct Sampler {
    phi: Vec<f64>,
    body: usize,
}

impl Observer<2> for Sampler {
    fn observe(
        &mut self,
        _: &Model<2>,
        _: &StepReport<'_, 2>,
        state: &State,
    ) -> std::result::Result<ControlFlow<()>, ObserverError> {
        if self.phi.len() < TIMES.len() && state.t > TIMES[self.phi.len()] - 1e-9 {
            self.phi.push(state.q[self.body]);
        }
        Ok(ControlFlow::Continue(()))
    }
}

/// What a run showed.
#[derive(Clone)]
struct Run {
    phi: Vec<f64>,
    /// CPU time, s.
    cpu: f64,
    /// Counted work, s.
    work: f64,
    /// Largest energy that contacts made in a step, J.
    rise: f64,
    unsolved: u64,
}

fn run(scene: &Scene, scheme: &str, step: &str, more: &[(&str, &str)]) -> Result<Run> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios");
    let name = "free-rocking-on-beam.toml";
    let bytes = std::fs::read(folder.join(name))?;
    let mut sets: Vec<(String, String)> = Vec::new();
    let own = [("time.scheme", scheme), ("time.step", step), ("time.end", END)];
    for (key, value) in scene.sets.iter().chain(more).chain(&own) {
        sets.push(((*key).to_owned(), (*value).to_owned()));
    }
    let resolved = teeter_scenario::load(&bytes, name, name, &sets)?;
    let mut simulation = Simulation::new(&resolved.scene)?;
    let body = simulation.layout.blocks[0].range.start + 2;
    let mut sampler = Sampler { phi: Vec::new(), body };
    let clock = cpu_time::ThreadTime::now();
    let ended = simulation.run(&mut [&mut sampler])?;
    let cpu = clock.elapsed().as_secs_f64();
    if sampler.phi.len() < TIMES.len() {
        return Err(format!("{}: {scheme} at {step} ended early: {ended:?}", scene.name).into());
    }
    let ledger = &simulation.state.ledger;
    Ok(Run {
        phi: sampler.phi,
        cpu,
        work: Work::of(&simulation).seconds(),
        rise: ledger.positive_contact_work.largest,
        unsolved: simulation.state.tally.unconverged_steps,
    })
}

/// The reference of a scene: read from the folder where it is there, else computed and kept.
fn reference(scene: &Scene, number: usize, kind: &Reference, keep: Option<&Path>) -> Result<Vec<f64>> {
    let file = keep.map(|folder| folder.join(format!("{}-{number}.txt", kind.name)));
    if let Some(text) = file.as_ref().and_then(|file| std::fs::read_to_string(file).ok()) {
        return Ok(text.split_whitespace().map(str::parse).collect::<std::result::Result<_, _>>()?);
    }
    let phi = run(scene, kind.scheme, kind.step, kind.sets)?.phi;
    if let Some(file) = file {
        std::fs::write(file, phi.iter().map(|x| format!("{x:e}\n")).collect::<String>())?;
    }
    Ok(phi)
}

struct Reference {
    name: &'static str,
    scheme: &'static str,
    step: &'static str,
    sets: &'static [(&'static str, &'static str)],
}

const REFERENCES: [Reference; 2] = [
    Reference { name: "event-driven", scheme: "event-driven", step: "1 ms", sets: &[] },
    Reference { name: "resolved-fine", scheme: "resolved", step: "20 us", sets: &[("beam.table.elements", "40")] },
];

/// The root of the mean square over scenes and times.
fn rms(found: &[Vec<f64>], wanted: &[Vec<f64>]) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for (found, wanted) in found.iter().zip(wanted) {
        for (a, b) in found.iter().zip(wanted) {
            sum += (a - b).powi(2);
            count += 1.0;
        }
    }
    f64::sqrt(sum / count)
}

fn main() -> Result<()> {
    let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
    let (mut keep, mut figure, mut only, mut steps, mut each) = (None, None, None, None, false);
    while let Some(word) = words.next() {
        match word.as_str() {
            "--keep" => keep = words.next().map(PathBuf::from),
            "--only" => only = words.next(),
            "--steps" => steps = words.next(),
            "--each" => each = true,
            _ => figure = Some(PathBuf::from(word)),
        }
    }
    let mut out = String::new();
    let mut known = Vec::new();
    for kind in &REFERENCES {
        let all = SCENES.iter().enumerate();
        known.push(all.map(|(k, scene)| reference(scene, k, kind, keep.as_deref())).collect::<Result<Vec<_>>>()?);
    }
    let disagreement = rms(&known[0], &known[1]);
    writeln!(
        out,
        "The references disagree by {disagreement:.1e} rad (rms over scenes and times); in single scenes:\n"
    )?;
    for (k, scene) in SCENES.iter().enumerate() {
        let off = rms(&known[0][k..=k], &known[1][k..=k]);
        writeln!(out, "- {}: {off:.1e}", scene.name)?;
    }
    let head = "\n| setting | step | rms error, rad | against the other reference | worst scene | counted work, ms | CPU time, ms | largest rise, J | unsolved |\n|---|---|---|---|---|---|---|---|---|\n";
    out.push_str(head);
    let mut fronts = Vec::new();
    for (label, scheme, more) in SETTINGS {
        if only.as_ref().is_some_and(|only| only != label) {
            continue;
        }
        let mut front = Vec::new();
        let wanted = |step: &str| steps.as_ref().is_none_or(|steps| steps.split(',').any(|only| only == step));
        for step in STEPS.iter().filter(|step| wanted(step)) {
            let runs = SCENES.iter().map(|scene| run(scene, scheme, step, more)).collect::<Result<Vec<_>>>()?;
            let phi: Vec<Vec<f64>> = runs.iter().map(|run| run.phi.clone()).collect();
            let mean = |of: fn(&Run) -> f64| 1e3 * runs.iter().map(of).sum::<f64>() / runs.len() as f64;
            let errors = [rms(&phi, &known[0]), rms(&phi, &known[1])];
            let single: Vec<f64> = (0..SCENES.len()).map(|k| rms(&phi[k..=k], &known[0][k..=k])).collect();
            let worst = single.iter().copied().fold(0.0, f64::max);
            let rise = runs.iter().map(|run| run.rise).fold(0.0, f64::max);
            let unsolved: u64 = runs.iter().map(|run| run.unsolved).sum();
            writeln!(
                out,
                "| {label} | {step} | {:.1e} | {:.1e} | {worst:.1e} | {:.2} | {:.2} | {rise:.0e} | {unsolved} |",
                errors[0],
                errors[1],
                mean(|run| run.work),
                mean(|run| run.cpu),
            )?;
            if each {
                writeln!(out, "  {}", single.iter().map(|e| format!("{e:.0e} ")).collect::<String>())?;
            }
            front.push((mean(|run| run.work), errors[0]));
        }
        fronts.push((label, front));
    }
    if let Some(file) = figure {
        std::fs::write(file, draw(&fronts, disagreement)?)?;
    }
    std::io::stdout().lock().write_all(out.as_bytes())?;
    Ok(())
}

/// Error over counted work, one line a setting.
fn draw(fronts: &[(&str, Vec<(f64, f64)>)], disagreement: f64) -> Result<String> {
    let all = || fronts.iter().flat_map(|(_, front)| front.iter().copied());
    let x = Axis::logarithmic("Counted work of 0.3 s (ms)", all().map(|point| point.0))?;
    let y = Axis::logarithmic("Error of φ, rms (rad)", all().map(|point| point.1).chain([disagreement]))?;
    let mut panel =
        Panel::new(y).shaded_below(disagreement, format!("the references disagree by {disagreement:.1e} rad"));
    for (k, (label, front)) in fronts.iter().enumerate() {
        panel = panel.with([
            Series::line("", front.clone()).number(k),
            Series::marks(*label, front.clone(), Mark::of(k)).number(k),
        ]);
    }
    let title = "A block that rocks on a beam: error after the impacts against counted work";
    Ok(Figure::new("front", title, x).panel(panel.height_mm(75.0)).legend(Legend::Rows).to_svg())
}
