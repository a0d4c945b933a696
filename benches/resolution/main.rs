//! `docs/resolution.md`: which runs are warned of, and which should be. Every scenario is run with steps from 10 µs to 5 ms, both schemes, meshes of 1 to
//! 40 elements and few to many modes, each against the scene's reference as `teeter tradeoff` has it; `benches/results/resolution.csv` has a row a run.
//! Arguments: scenes other than the scenarios, which are tried instead and told on standard output alone.

use std::error::Error;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use teeter_study::{Quantity, ReferenceComparison, Setting, StudyScene, runner};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

const STEPS: [&str; 10] = ["5 ms", "2 ms", "1 ms", "500 us", "200 us", "100 us", "50 us", "20 us", "10 us", "3.7 ms"];
const SCHEMES: [&str; 2] = ["moreau-jean", "moreau-jean-closed"];
const MESHES: [usize; 9] = [1, 2, 3, 4, 5, 8, 10, 20, 40];
const MODES: [usize; 6] = [1, 2, 3, 4, 8, 16];

/// A run with a larger error must be warned of, and one with a smaller error than the second must not.
const WRONG: f64 = 0.1;
const RIGHT: f64 = 0.01;

/// One run.
struct Row {
    setting: Setting,
    error: f64,
    /// Whether it was warned that it is off, before the run or by it, where the scene as it is was not.
    warned: bool,
}

/// How many runs there were of a kind, and how many of them were warned of.
#[derive(Clone, Copy, Default)]
struct Count {
    runs: usize,
    warned: usize,
}

impl Count {
    fn add(&mut self, warned: bool) {
        self.runs += 1;
        self.warned += usize::from(warned);
    }

    fn told(self) -> String {
        format!("{} | {}", self.runs, self.warned)
    }

    fn share(self) -> f64 {
        100.0 * self.warned as f64 / self.runs.max(1) as f64
    }
}

fn main() -> Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    // Cargo adds flags of its own.
    let named: Vec<PathBuf> =
        std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).map(PathBuf::from).collect();
    let mut scenes = named.clone();
    if scenes.is_empty() {
        let folder = std::fs::read_dir(root.join("scenarios"))?;
        scenes = folder.map(|entry| entry.map(|entry| entry.path())).collect::<std::io::Result<_>>()?;
        scenes.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
        scenes.sort();
    }
    let mut table = String::from(
        "| scene | runs | off by > 10 % | warned | within 1 % | warned | between | warned |\n|---|---|---|---|---|---|---|---|\n",
    );
    let mut csv = String::from("scene,setting,error,warned\n");
    let mut all = [Count::default(); 3];
    for path in &scenes {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let rows = swept(path, &stem)?;
        let mut counts = [Count::default(); 3];
        for row in &rows {
            let kind = if !(row.error <= WRONG) {
                0
            } else if row.error <= RIGHT {
                1
            } else {
                2
            };
            for counts in [&mut counts, &mut all] {
                counts[kind].add(row.warned);
            }
            let setting = row.setting.to_string().replace('"', "'");
            writeln!(csv, "{stem},\"{setting}\",{:.3e},{}", row.error, row.warned)?;
        }
        let [wrong, right, between] = counts.map(Count::told);
        writeln!(table, "| `{stem}` | {} | {wrong} | {right} | {between} |", rows.len())?;
        writeln!(std::io::stdout(), "{stem}: {} runs, {wrong}, {right}, {between}", rows.len())?;
    }
    let runs: usize = all.iter().map(|count| count.runs).sum();
    let [wrong, right, between] = all.map(Count::told);
    writeln!(table, "| all | {runs} | {wrong} | {right} | {between} |")?;
    let sentence = format!(
        "Of the runs off by more than 10 %, {:.1} % were warned of; of those within 1 %, {:.1} %.\n",
        all[0].share(),
        all[1].share()
    );
    write!(std::io::stdout(), "{table}\n{sentence}")?;
    if named.is_empty() {
        std::fs::write(root.join("benches/results/resolution.csv"), csv)?;
        let page = root.join("docs/resolution.md");
        let text = std::fs::read_to_string(&page)?;
        let (begin, end) = ("<!-- generated: counts -->\n", "<!-- end: counts -->\n");
        let (before, rest) = text.split_once(begin).ok_or("the page has no place for the counts")?;
        let (_, after) = rest.split_once(end).ok_or("the place for the counts has no end")?;
        std::fs::write(&page, format!("{before}{begin}{table}\n{sentence}{end}{after}"))?;
    }
    Ok(())
}

/// Whether a warning is of a motion that is off, and of nothing else: neither of energy that contacts made, nor of bodies that meet where no contact
/// is modelled, nor of times and rows that are not whole steps.
fn says_that_it_is_off(kind: &str) -> bool {
    const OTHERS: [&str; 6] =
        ["energy-made", "passes-through", "between-corners", "past-the-end", "time.end", "output."];
    !OTHERS.iter().any(|other| kind.starts_with(other))
}

fn swept(path: &Path, stem: &str) -> Result<Vec<Row>> {
    let folder = path.parent().map(Path::to_owned).unwrap_or_default();
    let mut read = |file: &str| std::fs::read(folder.join(file)).map_err(|error| error.to_string());
    let (source, resolved) = StudyScene::new(std::fs::read(path)?, stem, stem, &[], &mut read)?;
    let cancel = Arc::new(AtomicBool::new(false));
    let against = ReferenceComparison::new(&source, &resolved, runner::cores(), &cancel)?;
    let mut base = Setting::none();
    if against.horizon() < 0.99 * resolved.scene.time.end {
        base = base.set("time.end", format!("{:?} s", against.horizon()));
    }
    let beams = &resolved.scene.beams;
    let key = |beam: &teeter_scenario::scene::BeamScene, key: &str| format!("beam.{}.{key}", beam.name);
    let mut bodies = vec![Setting::none()];
    if !beams.is_empty() {
        bodies.extend(MESHES.iter().map(|n| {
            beams.iter().fold(Setting::none(), |setting, beam| setting.set(key(beam, "elements"), n.to_string()))
        }));
        bodies.extend(MODES.iter().map(|n| {
            beams.iter().fold(Setting::none(), |setting, beam| {
                setting.set(key(beam, "model"), "modes").set(key(beam, "modes"), format!("{{ count = {n} }}"))
            })
        }));
    }
    let mut jobs = Vec::new();
    for body in &bodies {
        for scheme in SCHEMES {
            for step in STEPS {
                jobs.push(base.clone().with(body).set("time.scheme", scheme).set("time.step", step));
            }
        }
    }
    let (_, own) = against.errors(&base, &cancel)?;
    let rows = runner::in_order(
        &jobs,
        runner::cores(),
        &cancel,
        |setting| {
            // A mesh or a number of modes that the scene can't have is no run.
            let (errors, warned) = against.errors(setting, &cancel).ok()?;
            let known = |kind: &str| !kind.starts_with("under-resolved") && own.iter().any(|own| own.kind == kind);
            Some(Row {
                setting: setting.clone(),
                error: errors.of(Quantity::Accuracy).unwrap_or(0.0),
                warned: warned.iter().any(|warned| says_that_it_is_off(&warned.kind) && !known(&warned.kind)),
            })
        },
        |_| {},
    );
    Ok(rows.into_iter().flatten().flatten().collect())
}
