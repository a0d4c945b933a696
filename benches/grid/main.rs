//! What `teeter tradeoff` advises against the cheapest of the full grid: every combination of scheme, θ, mesh, modes and step of a scenario is run against the
//! study's own reference; in a scene without beams, where the grid is small, every solver and tolerance too.
//!
//!     cargo bench -p teeter-benches --bench grid -- FOLDER [SCENARIO ...]
//!
//! writes `FOLDER/NAME.csv`, every setting with its error and cost, and `FOLDER/summary.md`, advised against cheapest. Of a combination the steps finer than the
//! first two that are within 0.1 % in a row, and not warned of, are left out: they cost more and no accuracy that is asked for needs them.

use cpu_time::ThreadTime;
use std::error::Error;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;
use teeter_scenario::resolve::Resolved;
use teeter_scenario::simulation::Simulation;
use teeter_study::{Advice, Axes, ConfirmedErrors, Row, Setting, StudyScene, TARGETS, Tradeoff, runner};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// The finest accuracy that steps are refined for.
const FINEST: f64 = 1e-3;
/// Modelled cost of one run at the most, s.
const MOST_WORK_OF_ONE: f64 = 2.0;
/// How often a run is timed; the least counts.
const TIMED: usize = 5;

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1).filter(|argument| !argument.starts_with('-'));
    let folder = PathBuf::from(arguments.next().ok_or("name the folder for the tables")?);
    std::fs::create_dir_all(&folder)?;
    let named: Vec<String> = arguments.collect();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios");
    let mut scenes: Vec<PathBuf> =
        std::fs::read_dir(root)?.map(|entry| entry.map(|entry| entry.path())).collect::<std::io::Result<_>>()?;
    scenes.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    scenes.sort();
    let mut summary = String::from(
        "| scenario | accuracy | advised | cheapest of the grid | ratio of counted work | ratio of CPU time | study | tried | grid |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    for path in scenes {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if named.is_empty() || named.contains(&stem) {
            summary.push_str(&scenario(&path, &stem, &folder)?);
            std::fs::write(folder.join("summary.md"), &summary)?;
        }
    }
    Ok(())
}

fn scenario(path: &Path, stem: &str, folder: &Path) -> Result<String> {
    let parent = path.parent().map(Path::to_owned).unwrap_or_default();
    let mut read = |file: &str| std::fs::read(parent.join(file)).map_err(|error| error.to_string());
    let (source, resolved) = StudyScene::new(std::fs::read(path)?, stem, stem, &[], &mut read)?;
    let begin = Instant::now();
    let study =
        Tradeoff::of(&source, &resolved, runner::cores(), &Arc::new(AtomicBool::new(false)), &mut |_, _, _| {})?;
    let seconds = begin.elapsed().as_secs_f64();
    let rows = full_grid(&source, &resolved, &study)?;
    std::fs::write(folder.join(format!("{stem}.csv")), table(&rows))?;
    let mut text = String::new();
    let held = ConfirmedErrors::of(&rows, &study.axes);
    for (target, advice) in TARGETS.iter().zip(&study.advice) {
        if study.bar() >= *target || *target < FINEST {
            continue;
        }
        let cost = |row: &Row| row.modelled().unwrap_or(f64::INFINITY);
        let meeting = held.meeting(*target, study.bar()).map(|row| &rows[row]).filter(|row| is_clean(row, &study));
        let cheapest = meeting.min_by(|a, b| cost(a).total_cmp(&cost(b)));
        let advised = match advice {
            Advice::Take { row, .. } => Some(&study.rows[*row]),
            _ => None,
        };
        let name = |row: Option<&Row>| match row {
            Some(row) if row.setting.is_none() => "the scene as it is".to_owned(),
            Some(row) => format!("`{}`", row.setting),
            None => "none".to_owned(),
        };
        let (mut work, mut time) = (f64::NAN, f64::NAN);
        if let (Some(advised), Some(cheapest)) = (advised, cheapest) {
            work = cost(advised) / cost(cheapest);
            time = if advised.setting == cheapest.setting {
                1.0
            } else {
                timed(&source, &advised.setting)? / timed(&source, &cheapest.setting)?
            };
        }
        writeln!(
            text,
            "| {stem} | {} % | {} | {} | {work:.2} | {time:.2} | {seconds:.0} s | {} | {} |",
            100.0 * target,
            name(advised),
            name(cheapest),
            study.rows.len(),
            rows.len()
        )?;
    }
    Ok(text)
}

/// Every setting of the grid that is a scene, as far as its steps are needed.
fn full_grid(source: &StudyScene, resolved: &Resolved, study: &Tradeoff) -> Result<Vec<Row>> {
    let cancel = Arc::new(AtomicBool::new(false));
    let mut open = combinations(&study.axes, resolved.scene.beams.is_empty());
    let mut rows: Vec<Row> = Vec::new();
    let mut within: Vec<u32> = vec![0; open.len()];
    for rung in 0..study.axes.step.options.len() {
        let mut jobs = Vec::new();
        for (number, combination) in open.iter().enumerate() {
            let setting = study.axes.ladder(combination).swap_remove(rung);
            if within[number] < 2 && is_affordable(source, &setting) {
                jobs.push((number, setting));
            }
        }
        let settings = jobs.iter().map(|(_, setting)| setting.clone()).collect();
        let ran = study.beside(settings, source, runner::cores(), &cancel)?;
        for ((number, _), row) in jobs.iter().zip(&ran) {
            let meets = row.accuracy().is_some_and(|accuracy| accuracy + study.bar() <= FINEST);
            within[*number] = if meets && is_clean(row, study) { within[*number] + 1 } else { 0 };
        }
        rows.extend(ran);
    }
    open.clear();
    Ok(rows)
}

/// Whether nothing warns of a row that the reference isn't warned of too.
fn is_clean(row: &Row, study: &Tradeoff) -> bool {
    let of_scene = |kind: &str| study.reference.warned.iter().any(|warned| warned.kind == kind);
    row.warned().iter().all(|warned| of_scene(&warned.kind))
}

fn combinations(axes: &Axes, all: bool) -> Vec<Setting> {
    let mut settings = axes.combinations();
    for axis in axes.others.iter().filter(|_| all) {
        settings =
            settings.iter().flat_map(|base| axis.options.iter().map(|option| axis.apply(option, base))).collect();
    }
    settings
}

fn is_affordable(source: &StudyScene, setting: &Setting) -> bool {
    let Ok(resolved) = source.load(setting) else { return false };
    let Ok(simulation) = Simulation::new(&resolved.scene) else { return false };
    teeter_study::Work::expected(&simulation).seconds() <= MOST_WORK_OF_ONE
}

/// The least CPU time of the steps of a run, s.
fn timed(source: &StudyScene, setting: &Setting) -> Result<f64> {
    let resolved = source.load(setting)?;
    let mut least = f64::INFINITY;
    for _ in 0..TIMED {
        let mut simulation = Simulation::new(&resolved.scene)?;
        let clock = ThreadTime::now();
        let _ = simulation.run(&mut [])?;
        least = least.min(clock.elapsed().as_secs_f64());
    }
    Ok(least)
}

fn table(rows: &[Row]) -> String {
    let mut text = String::from("setting,accuracy,modelled_ms,steps,warned\n");
    for row in rows {
        let setting = row.setting.to_string().replace('"', "\"\"");
        let (accuracy, modelled) = (row.accuracy(), row.modelled().map(|seconds| 1e3 * seconds));
        let number = |x: Option<f64>| x.map_or_else(String::new, |x| format!("{x:.4e}"));
        let steps = row.result.as_ref().map_or_else(|_| String::new(), |done| done.work.steps.to_string());
        let warned = row.warned().len();
        // Writing to a String can't fail.
        let _ = writeln!(text, "\"{setting}\",{},{},{steps},{warned}", number(accuracy), number(modelled));
    }
    text
}
