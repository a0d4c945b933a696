//! `docs/accuracy.md`: what accuracy costs in each scenario. Studies the scenarios named, or all, and puts table, sentences and figure in
//! their places in the page, between marks; what stands around them is written by hand.

use std::error::Error;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use teeter_study::{Advice, Quantity, StudyScene, TARGETS, Tradeoff, runner, write};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// The width of the figures, mm.
const FIGURE_WIDTH: f64 = 120.0;

fn main() -> Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    // Cargo adds flags of its own.
    let named: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    let mut scenes: Vec<PathBuf> = std::fs::read_dir(root.join("scenarios"))?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<std::io::Result<_>>()?;
    scenes.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    scenes.sort();
    for path in scenes {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if !named.is_empty() && !named.contains(&stem) {
            continue;
        }
        let study = studied(&path, &stem)?;
        let figures = write::figures(&study, FIGURE_WIDTH)?;
        let figure = figures.iter().find(|(name, _)| name == "accuracy.svg").map(|(_, svg)| svg);
        if let Some(svg) = figure {
            std::fs::write(root.join(format!("docs/figures/tradeoff-{stem}.svg")), svg)?;
        }
        let page = root.join("docs/accuracy.md");
        let text = std::fs::read_to_string(&page)?;
        std::fs::write(&page, with_part(&text, &stem, &part(&study, &stem, figure.is_some())?))?;
        writeln!(std::io::stdout(), "{stem}: done")?;
    }
    Ok(())
}

fn studied(path: &Path, stem: &str) -> Result<Tradeoff> {
    let folder = path.parent().map(Path::to_owned).unwrap_or_default();
    let mut read = |file: &str| std::fs::read(folder.join(file)).map_err(|error| error.to_string());
    let (source, resolved) = StudyScene::new(std::fs::read(path)?, stem, stem, &[], &mut read)?;
    Ok(Tradeoff::of(&source, &resolved, runner::cores(), &Arc::new(AtomicBool::new(false)), &mut |_, _, _| {})?)
}

/// Marks around what is generated for a scenario.
fn marks(stem: &str) -> (String, String) {
    (format!("<!-- generated: {stem} -->\n"), format!("<!-- end: {stem} -->\n"))
}

/// The page with the part of a scenario replaced, or at its end if it has none.
fn with_part(page: &str, stem: &str, part: &str) -> String {
    let (begin, end) = marks(stem);
    let known = page.split_once(&begin).and_then(|(before, rest)| Some((before, rest.split_once(&end)?.1)));
    let (before, after) = known.unwrap_or((page, ""));
    let gap = if known.is_some() { "" } else { "\n" };
    format!("{before}{gap}{begin}{part}{end}{after}")
}

fn part(study: &Tradeoff, stem: &str, figure: bool) -> Result<String> {
    let mut text = format!("### {}\n\n`scenarios/{stem}.toml`\n\n", study.title);
    writeln!(text, "| accuracy | setting | off by at most | CPU time |\n|---|---|---|---|")?;
    for (target, advice) in TARGETS.iter().zip(&study.advice) {
        let target = format!("{} %", 100.0 * target);
        match advice {
            Advice::Take { row, .. } => {
                let row = &study.rows[*row];
                let take =
                    if row.setting.is_none() { "the scene as it is".to_owned() } else { format!("`{}`", row.setting) };
                let accuracy = row.accuracy().unwrap_or(f64::NAN) + study.bar();
                let time = row.measured().unwrap_or(f64::NAN);
                writeln!(text, "| {target} | {take} | {accuracy:.1e} | {:.3} ms |", 1e3 * time)?;
            }
            Advice::NotReached => writeln!(
                text,
                "| {target} | none of the settings tried | {:.1e} at best | |",
                study.best().unwrap_or(f64::NAN)
            )?,
            Advice::Warned(_) => {
                writeln!(text, "| {target} | nothing: every setting that reaches it has a warning | | |")?
            }
            Advice::BeforeImpact => {
                writeln!(text, "| {target} | nothing: the horizon ends before the first impacts are compared | | |")?;
            }
            Advice::NotMeasurable => writeln!(text, "| {target} | not measurable | | |")?,
        }
    }
    text.push('\n');
    for line in write::findings(study) {
        writeln!(text, "- {line}")?;
    }
    if figure {
        writeln!(text, "\n![{} over CPU time](figures/tradeoff-{stem}.svg)", Quantity::Accuracy.title())?;
    }
    Ok(text)
}
