//! The scenes of `compare.py` in our program: jobs on standard input, an answer each (the protocol: README.md).
//!
//! Settings are keys of the scene with their values, as of `--set`, without spaces.
#![allow(clippy::print_stdout)] // its output is what it is for

use cpu_time::ProcessTime;
use std::error::Error;
use std::io::{BufRead, Write};
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Duration;
use teeter_integrator::{Model, Observer, ObserverError, State, StepReport};
use teeter_scenario::resolve::Resolved;
use teeter_scenario::simulation::Simulation;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Repetitions end here, however short a run is.
const MOST: usize = 51;

/// X, Y, φ of the block at every step, kept in memory.
struct Track(Vec<f64>);

impl Observer<2> for Track {
    fn observe(
        &mut self,
        _: &Model<2>,
        _: &StepReport<'_, 2>,
        state: &State,
    ) -> std::result::Result<ControlFlow<()>, ObserverError> {
        self.0.extend_from_slice(&state.q[..3]);
        Ok(ControlFlow::Continue(()))
    }
}

/// A stack of boxes of 0.1 m, the top one so many times heavier; X, Y, φ are those of the top one.
fn stack(boxes: usize, heavier: f64) -> String {
    let size = "width = \"10 cm\"\nheight = \"10 cm\"\ndepth = \"10 cm\"\nat = \"0 cm\"";
    let below = boxes - 1;
    format!(
        "version = 1\n[time]\nend = \"1 s\"\nstep = \"1 ms\"\n[ground]\n\
         [material.wood]\ndensity = \"700 kg/m^3\"\n[material.load]\ndensity = \"{} kg/m^3\"\n\
         [block.top]\nmaterial = \"load\"\non = \"box-{below}\"\n{size}\n\
         [block.box]\nmaterial = \"wood\"\non = \"ground\"\nrepeat = {{ count = {below}, stacked = true }}\n{size}\n\
         [contact.floor]\nbetween = [\"*\", \"ground\"]\nfriction = 0.5\n\
         [contact.joints]\nbetween = [\"*\", \"*\"]\nfriction = 0.5\n",
        700.0 * heavier
    )
}

fn load(scene: &str, elements: &str, step: f64, steps: usize, settings: &[&str]) -> Result<Resolved> {
    let set = |key: &str, value: String| (key.to_owned(), value);
    let mut sets = vec![
        set("time.step", format!("\"{step:e} s\"")),
        set("time.end", format!("\"{:e} s\"", step * steps as f64)),
        set("output.every", format!("\"{:e} s\"", step * steps as f64)),
    ];
    let (of_stack, settings): (Vec<&str>, Vec<&str>) =
        settings.iter().partition(|setting| scene == "stack" && setting.starts_with("top="));
    let given = settings.into_iter().map(|setting| {
        let (key, value) = setting.split_once('=').ok_or_else(|| format!("«{setting}» is no KEY=VALUE"))?;
        Ok(set(key, value.to_owned()))
    });
    let given = given.collect::<Result<Vec<_>>>()?;
    let name = match scene {
        "stack" => {
            let heavier = of_stack.first().map_or(Ok(1.0), |top| top["top=".len()..].parse())?;
            let text = stack(elements.parse()?, heavier);
            sets.extend(given);
            return Ok(teeter_scenario::load(text.as_bytes(), "stack", "stack", &sets)?);
        }
        "ground" => "free-rocking-on-ground",
        "beam" => {
            sets.push(set("beam.table.elements", elements.to_owned()));
            sets.push(set("beam.table.damping_ratio.ratio", "0.0".to_owned()));
            "free-rocking-on-beam-undeformed-start"
        }
        other => return Err(format!("no scene «{other}»; there are ground, beam and stack").into()),
    };
    sets.extend(given);
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios");
    let bytes = std::fs::read(folder.join(format!("{name}.toml")))?;
    let mut read = |path: &str| std::fs::read(folder.join(path)).map_err(|error| error.to_string());
    Ok(teeter_scenario::load_with(&bytes, name, name, &sets, &mut read)?)
}

fn job(line: &str) -> Result<Vec<f64>> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let [scene, elements, step, steps, budget, file, settings @ ..] = &words[..] else {
        return Err("a job is: SCENE ELEMENTS STEP STEPS BUDGET FILE KEY=VALUE…".into());
    };
    let (step, steps, budget): (f64, usize, f64) = (step.parse()?, steps.parse()?, budget.parse()?);
    let resolved = load(scene, elements, step, steps, settings)?;
    let mut track = Track(Vec::with_capacity(3 * (steps + 1)));
    let (mut times, mut spent) = (Vec::new(), Duration::ZERO);
    while times.is_empty() || (spent.as_secs_f64() < budget && times.len() < MOST) {
        let mut simulation = Simulation::new(&resolved.scene)?;
        track.0.clear();
        track.0.extend_from_slice(&simulation.state.q[..3]);
        let clock = ProcessTime::now();
        let _ = simulation.run(&mut [&mut track])?;
        let time = clock.elapsed();
        spent += time;
        times.push(time.as_secs_f64());
    }
    if track.0.len() != 3 * (steps + 1) {
        return Err(format!("the run ended after {} of {steps} steps", track.0.len() / 3 - 1).into());
    }
    let bytes: Vec<u8> = track.0.iter().flat_map(|x| x.to_le_bytes()).collect();
    std::fs::write(file, bytes)?;
    Ok(times)
}

fn main() -> Result<()> {
    for line in std::io::stdin().lock().lines() {
        match job(&line?) {
            Ok(times) => println!("{{\"cpu_s\": {times:?}}}"),
            Err(error) => println!("{{\"error\": {:?}}}", error.to_string()),
        }
        std::io::stdout().flush()?;
    }
    Ok(())
}
