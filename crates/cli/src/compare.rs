//! `teeter compare`.

use crate::console::{Console, print};
use crate::measured::{MeasuredOptions, bytes};
use crate::run::Exit;
use std::error::Error;
use std::path::{Path, PathBuf};
use teeter_report::{Reserved, Results, shortest};
use teeter_study::compare::{
    CompareSettings, Comparison, FILES, MotionTrace, TraceError, half_cycle_csv, impact_csv, json, page, rows_csv,
    sentences_of, svg_figures,
};
use teeter_study::measured::Channel;

#[derive(Debug)]
pub(crate) struct Options {
    /// The folder of a run.
    pub(crate) run: PathBuf,
    pub(crate) measured: MeasuredOptions,
    /// What the measured angle shows when the block stands upright, rad.
    pub(crate) offset: f64,
    pub(crate) out: Option<PathBuf>,
    /// Width of the figures, m.
    pub(crate) figure_width: f64,
    pub(crate) quiet: bool,
    pub(crate) force: bool,
}

/// What a run's folder says.
struct Run {
    title: String,
    block: String,
    horizon: Option<f64>,
    trace: MotionTrace,
    inputs: Vec<PathBuf>,
}

pub(crate) fn compare(options: &Options) -> Exit {
    let console = Console::new(options.quiet);
    let bad_input = |text: &str| {
        console.error(text);
        Exit::BadInput
    };
    let prepared = read_run(&options.run, options.measured.block.as_deref())
        .and_then(|run| Ok((options.measured.read(&run.block)?, run)));
    let (measured, run) = match prepared {
        Ok(prepared) => prepared,
        Err(text) => return bad_input(&text),
    };
    options.measured.tell_unread(&measured, console);
    let settings = CompareSettings {
        alignment: options.measured.alignment(),
        window: options.measured.window,
        offset: options.offset,
        horizon: run.horizon,
    };
    let Run { title, block, trace, inputs, .. } = run;
    let comparison = match Comparison::of(&measured, trace, settings) {
        Ok(comparison) => comparison,
        Err(error) => return bad_input(&format!("error: {}: {error}", options.measured.measured.display())),
    };
    let folder = options.out.clone().unwrap_or_else(|| beside(&options.run));
    let inputs: Vec<PathBuf> = inputs.into_iter().chain(options.measured.inputs()).collect();
    let reserved =
        Results::spares(&FILES, &folder, &inputs).and_then(|()| Results::reserve(&FILES, &folder, options.force));
    let reserved = match reserved {
        Ok(reserved) => reserved,
        Err(error) => return bad_input(&format!("error: {error}")),
    };
    let named = Names {
        title: &title,
        run: &options.run.display().to_string(),
        measured: &options.measured.measured.display().to_string(),
        block: &block,
    };
    match write_all(&comparison, reserved, &named, 1e3 * options.figure_width) {
        Ok(()) => {
            console.note(&format!("results in {0}, report in {0}/compare.html", folder.display()));
            Exit::FinishedRun
        }
        Err(error) => {
            console.error(&format!("error: {error}"));
            Exit::Failed
        }
    }
}

/// `runs/name-compare` for `runs/name`.
fn beside(run: &Path) -> PathBuf {
    let real = run.canonicalize().unwrap_or_else(|_| run.to_owned());
    let name = real.file_name().map_or_else(|| "run".into(), |name| name.to_string_lossy().into_owned());
    match run.parent() {
        Some(parent) if run.file_name().is_some() => parent.join(format!("{name}-compare")),
        _ => Path::new("runs").join(format!("{name}-compare")),
    }
}

/// Reads what `teeter run` wrote; the text is the error to print.
fn read_run(folder: &Path, block: Option<&str>) -> Result<Run, String> {
    let [table, summary] = ["trajectory.csv", "summary.json"].map(|name| folder.join(name));
    if !folder.is_dir() {
        let what = if folder.exists() { "is a file, not the folder of a run" } else { "there is no such folder" };
        return Err(format!("error: {}: {what}; `teeter run SCENE.toml --out DIR` writes one", folder.display()));
    }
    if !table.exists() || !summary.exists() {
        return Err(format!(
            "error: {}: not the folder of a complete run: it needs trajectory.csv and summary.json, as `teeter run` writes \
             them",
            folder.display()
        ));
    }
    let told = |path: &Path, error: &dyn std::fmt::Display| format!("error: {}: {error}", path.display());
    // Of very many blocks each has rows instead of columns.
    let rows = folder.join("blocks.csv");
    let (table, read): (_, fn(&str, Option<&str>) -> _) =
        if rows.exists() { (rows, MotionTrace::read_rows) } else { (table, MotionTrace::read) };
    let text = std::fs::read_to_string(&table).map_err(|error| told(&table, &error))?;
    let of_run: serde_json::Value =
        serde_json::from_slice(&bytes(&summary)?).map_err(|error| told(&summary, &error))?;
    let (block, trace) = read(&text, block).map_err(|error| {
        let verdicts = of_run["verdict"].as_array().into_iter().flatten();
        let is_known = |name: &str| verdicts.clone().any(|verdict| verdict["body"] == name);
        match &error {
            TraceError::Block { block, .. } if is_known(block) => {
                let hint =
                    format!("{error}: its scene chooses the blocks that have columns, with `blocks` in [output]");
                told(&table, &hint)
            }
            error => told(&table, error),
        }
    })?;
    let title = of_run["title"].as_str().unwrap_or("a run").to_owned();
    Ok(Run { title, block, horizon: of_run["horizon"].as_f64(), trace, inputs: vec![table, summary] })
}

/// The names on the page.
struct Names<'a> {
    title: &'a str,
    run: &'a str,
    measured: &'a str,
    block: &'a str,
}

/// Writes the files, and the sentences to standard output.
fn write_all(
    comparison: &Comparison,
    reserved: Reserved,
    names: &Names<'_>,
    width_mm: f64,
) -> Result<(), Box<dyn Error>> {
    let Names { title, run, measured, block } = *names;
    let figures = svg_figures(comparison, width_mm)?;
    let html = page(comparison, title, [run, measured, block])?;
    let results = reserved.create()?;
    results.write("compare.csv", rows_csv(comparison))?;
    results.write("half-cycles.csv", half_cycle_csv(comparison))?;
    results.write("impact-pairs.csv", impact_csv(comparison))?;
    for (name, svg) in figures {
        results.write(&format!("figures/{name}"), svg)?;
    }
    results.write("compare.html", html)?;
    results.write("compare.json", json(comparison, block, run, measured))?;
    let mut text = String::new();
    for found in comparison.channels.iter().filter(|found| found.differences.rows > 0) {
        let ((_, factor), unit) = (found.channel.shown(), found.channel.shown_after(" "));
        let d = found.differences;
        let share = d.share(d.rms).map(|share| format!(" ({:.1} % of the largest)", 100.0 * share)).unwrap_or_default();
        text += &format!(
            "{}: root mean square difference {}{unit}{share}, at most {}{unit} at t = {:.4} s\n",
            found.channel.title(),
            shortest(factor * d.rms, 2),
            shortest(factor * d.max, 2),
            d.max_at
        );
    }
    let paired = comparison.impacts.iter().filter(|pair| pair.measured.is_some() && pair.simulated.is_some()).count();
    let count = |which: fn(&teeter_study::compare::ImpactPair) -> bool| {
        comparison.impacts.iter().filter(|pair| which(pair)).count()
    };
    text += &match comparison.channel(Channel::Phi) {
        Some(_) => format!(
            "impacts: {} measured, {} simulated, {paired} paired\n",
            count(|pair| pair.measured.is_some()),
            count(|pair| pair.simulated.is_some())
        ),
        // They are where the angle crosses zero.
        None => "impacts: not looked for, as the table has no angle (phi)\n".to_owned(),
    };
    for sentence in sentences_of(comparison) {
        text += &format!("  {sentence}\n");
    }
    Ok(print(&text)?)
}
