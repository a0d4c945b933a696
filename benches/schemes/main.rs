//! The schemes on every scenario that they take: accuracy, order, sensitivity, cost; a table in Markdown on standard output.
//!
//! The error is the largest difference from a reference at any multiple of 1 ms up to the horizon: of a block's angle relative to the
//! largest angle, of its place relative to its larger side. The reference is `event-driven`, and `moreau-jean-located` at 1 µs where that
//! refuses the scene; how far the others are from it at 1 µs, the table says.

use std::error::Error;
use std::fmt::Write as _;
use std::io::Write as _;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;
use teeter_integrator::{Model, Observer, ObserverError, State, StepReport, schemes};
use teeter_scenario::resolve::Resolved;
use teeter_scenario::simulation::Simulation;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// The reference where it takes the scene, and elsewhere.
const REFERENCES: [(&str, (f64, &str)); 2] = [("event-driven", (1e-3, "1 ms")), ("moreau-jean-located", FINE)];

/// Steps, s, and the text of each.
const STEPS: [(f64, &str); 3] = [(1e-3, "1 ms"), (1e-4, "100 us"), (1e-5, "10 us")];

const FINE: (f64, &str) = (1e-6, "1 us");

/// Time between samples, s.
const SAMPLE: f64 = 1e-3;

/// Scenarios and how far they are compared, s: a block that has fallen over, or left its impacts behind, has nothing to compare.
const SCENES: [(&str, &str); 9] = [
    ("free-rocking-on-ground", "1 s"),
    ("free-rocking-on-beam", "300 ms"),
    ("free-rocking-on-beam-undeformed-start", "300 ms"),
    ("drop", "500 ms"),
    ("sliding", "500 ms"),
    ("incline", "500 ms"),
    ("pushed-block", "500 ms"),
    ("shaken-ground", "500 ms"),
    ("compliant-drop", "200 ms"),
];

/// What one run showed.
struct Run {
    /// X, Y, φ of all blocks at each sample.
    samples: Vec<Vec<f64>>,
    /// Steps between two with contact, fewer than four: a contact that was lost and found again.
    drop_outs: u32,
    /// Largest rise of energy by contact in a step, J.
    rise: f64,
    seconds_per_step: f64,
}

struct Sampler {
    every: u64,
    blocks: usize,
    samples: Vec<Vec<f64>>,
    without: u32,
    drop_outs: u32,
}

impl Observer<2> for Sampler {
    fn observe(
        &mut self,
        _: &Model<2>,
        step: &StepReport<'_, 2>,
        state: &State,
    ) -> std::result::Result<ControlFlow<()>, ObserverError> {
        if step.contacts().any(|contact| contact.p[0] > 0.0) {
            self.drop_outs += u32::from((1..=3).contains(&self.without));
            self.without = 0;
        } else {
            self.without = self.without.saturating_add(1);
        }
        if state.step.is_multiple_of(self.every) {
            self.samples.push(state.q[..3 * self.blocks].to_vec());
        }
        Ok(ControlFlow::Continue(()))
    }
}

fn load(name: &str, scheme: &str, step: &str, end: &str) -> Result<Resolved> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios");
    let bytes = std::fs::read(folder.join(format!("{name}.toml")))?;
    let set = |key: &str, value: &str| (key.to_owned(), value.to_owned());
    let sets = [
        set("time.scheme", &format!("\"{scheme}\"")),
        set("time.step", &format!("\"{step}\"")),
        set("time.end", &format!("\"{end}\"")),
    ];
    let mut read = |path: &str| std::fs::read(folder.join(path)).map_err(|error| error.to_string());
    Ok(teeter_scenario::load_with(&bytes, name, name, &sets, &mut read)?)
}

fn run(name: &str, scheme: &str, (h, step): (f64, &str), end: &str, nudge: f64) -> Result<Run> {
    let resolved = load(name, scheme, step, end)?;
    let mut simulation = Simulation::new(&resolved.scene)?;
    let blocks = resolved.scene.blocks.len();
    for block in 0..blocks {
        simulation.state.q[3 * block + 2] += nudge;
    }
    let mut sampler =
        Sampler { every: (SAMPLE / h).round() as u64, blocks, samples: Vec::new(), without: 4, drop_outs: 0 };
    let clock = Instant::now();
    let _ = simulation.run(&mut [&mut sampler])?;
    let seconds = clock.elapsed().as_secs_f64();
    Ok(Run {
        samples: sampler.samples,
        drop_outs: sampler.drop_outs,
        rise: simulation.state.ledger.positive_contact_work.largest,
        seconds_per_step: seconds / simulation.state.step.max(1) as f64,
    })
}

/// The error of a run's samples against another's.
fn error(name: &str, samples: &[Vec<f64>], reference: &[Vec<f64>]) -> Result<f64> {
    let scene = load(name, "auto", "1 ms", "10 ms")?.scene;
    let sides: Vec<f64> = scene.blocks.iter().map(|block| block.width.max(block.height)).collect();
    let largest =
        reference.iter().flat_map(|q| q.iter().skip(2).step_by(3)).fold(0.0_f64, |most, phi| most.max(phi.abs()));
    let mut worst = 0.0_f64;
    for (q, wanted) in samples.iter().zip(reference) {
        for k in 0..q.len() {
            let off = (q[k] - wanted[k]).abs();
            // A block that doesn't turn has no angle to be relative to.
            let size = if k % 3 == 2 { if largest > 1e-6 { largest } else { 1.0 } } else { sides[k / 3] };
            worst = worst.max(off / size);
        }
    }
    Ok(worst)
}

fn median(mut x: Vec<f64>) -> f64 {
    x.sort_by(f64::total_cmp);
    x[x.len() / 2]
}

fn main() -> Result<()> {
    let mut out = String::from(
        "| scenario | to | scheme | error at 1 ms | at 100 µs | at 10 µs | order | at 1 µs | moved by φ₀ ± 1e-13 | drop-outs | largest gain, J | µs a step |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    for (name, end) in SCENES {
        let reference = |(scheme, step)| run(name, scheme, step, end, 0.0).map(|run| (scheme, run));
        let (known, reference) = reference(REFERENCES[0]).or_else(|_| reference(REFERENCES[1]))?;
        writeln!(
            out,
            "| {name} | {end} | {known}: the reference | | | | | | | | | {:.2} |",
            1e6 * reference.seconds_per_step
        )?;
        let takes = |scheme: &&str| run(name, scheme, STEPS[0], end, 0.0).is_ok();
        let schemes: Vec<&str> = schemes()
            .iter()
            .map(|scheme| scheme.name)
            .filter(|scheme| *scheme != REFERENCES[0].0)
            .filter(takes)
            .collect();
        // Turn by turn, so that a busy moment of the machine falls on all.
        let mut times = vec![Vec::new(); schemes.len()];
        for _ in 0..7 {
            for (scheme, times) in schemes.iter().zip(&mut times) {
                times.push(run(name, scheme, STEPS[1], end, 0.0)?.seconds_per_step);
            }
        }
        for (scheme, times) in schemes.into_iter().zip(times) {
            let row = row(name, scheme, end, &reference)?;
            writeln!(out, "| {name} | {end} | {scheme} | {row} | {:.2} |", 1e6 * median(times))?;
        }
    }
    std::io::stdout().lock().write_all(out.as_bytes())?;
    Ok(())
}

/// The cells of a scheme in a scene, but for its time.
fn row(name: &str, scheme: &str, end: &str, reference: &Run) -> Result<String> {
    let runs = STEPS.into_iter().map(|step| run(name, scheme, step, end, 0.0)).collect::<Result<Vec<_>>>()?;
    let off = |run: &Run| error(name, &run.samples, &reference.samples);
    let errors = runs.iter().map(off).collect::<Result<Vec<_>>>()?;
    let mut moved = 0.0_f64;
    for nudge in [1e-13, -1e-13] {
        moved = moved.max(error(name, &run(name, scheme, STEPS[1], end, nudge)?.samples, &runs[1].samples)?);
    }
    let order = if errors[2] > 1e-9 { format!("{:.2}", (errors[1] / errors[2]).log10()) } else { "–".to_owned() };
    let at_fine = off(&run(name, scheme, FINE, end, 0.0)?)?;
    let rise = runs.iter().map(|run| run.rise).fold(0.0, f64::max);
    let lost = runs.iter().map(|run| run.drop_outs.to_string()).collect::<Vec<_>>().join(", ");
    let [long, middle, short] = [0, 1, 2].map(|k| errors[k]);
    Ok(format!("{long:.1e} | {middle:.1e} | {short:.1e} | {order} | {at_fine:.1e} | {moved:.1e} | {lost} | {rise:.0e}"))
}
