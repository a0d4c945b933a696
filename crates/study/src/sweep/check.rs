//! What a sweep file and its scene say together: refused before the first case is run.

use super::Sweep;
use super::figures::Bands;
use super::file::SCENE_EXAMPLE;
use super::find::Find;
use super::output::Output;
use super::spec::{Node, Reader, entries};
use crate::{Setting, StudyScene};
use serde_json::Value;
use teeter_report::{EndedWord, Recorder, Summary};
use teeter_scenario::diagnostic::{Diagnostic, Diagnostics, Severity};
use teeter_scenario::keys::{self, PathTarget};
use teeter_scenario::suggest::nearest;

/// Parts of a summary that have all their keys in every run, whatever happens in it.
const FIXED_PARTS: [&str; 2] = ["contact", "energy"];
/// Cases that are looked at before a scene is said to be wrong in all of them.
const CASES_TRIED: u64 = 16;
/// Values of a key that are looked at before it is said to be wrong in all of them.
const VALUES_TRIED: u64 = 1000;
/// Values of a summary that the machine decides.
const CLOCKED: [&str; 2] = ["wall_seconds", "us_per_step"];
/// How many columns a message lists.
const MOST_LISTED: usize = 20;

/// What a run of a case offers to outputs.
struct Offered {
    /// End of the run, s.
    end: f64,
    columns: Vec<String>,
    summary: Summary,
}

/// Up to `most` of so many numbers from 0 on, all over them, the first and the last among them.
fn spread(count: u64, most: u64) -> impl Iterator<Item = u64> {
    let tried = count.clamp(1, most);
    let place = move |k: u64| u128::from(count.saturating_sub(1)) * u128::from(k) / u128::from((tried - 1).max(1));
    (0..tried).map(move |k| u64::try_from(place(k)).unwrap_or(0))
}

impl Sweep {
    /// That the scene can't be read, and why, at its name in the sweep file, whose text is `text`.
    #[must_use]
    pub fn unreadable_scene(text: &str, file: &str, why: &str) -> Diagnostics {
        let mut reader = Reader::new(file, text);
        reader.wrong("scene", None, why, SCENE_EXAMPLE);
        match reader.root() {
            Ok(root) => reader.placed_in(root.get_ref()),
            Err(found) => found,
        }
    }

    /// Refuses keys that the scene can't have, and those none of whose values can be read (of up to 1000, all over them), as they lack a unit
    /// or are out of range whatever the rest of the scene: every case would be a refused one. `text` is that of the sweep file, for the places of the
    /// findings.
    ///
    /// # Errors
    /// What is wrong with them.
    pub fn check_keys(&self, source: &StudyScene, text: &str, file: &str) -> Result<(), Diagnostics> {
        let mut reader = Reader::new(file, text);
        let root = reader.root()?;
        for key in self.keys().into_iter().chain(self.find().map(|find| find.key.as_str())) {
            let is_known = matches!(keys::find(key), Some(PathTarget::Key(..)));
            let refused = |value: String| {
                let setting = Setting::none().set(key.to_owned(), value);
                let found = if is_known { source.errors_of_text(&setting) } else { source.load(&setting).err()? };
                // Of a key that there is, only what is wrong with the key itself: the table may lack others, which isn't its fault.
                let is_own = |finding: &Diagnostic| !is_known || finding.path.starts_with(key);
                let is_of_value = |finding: &Diagnostic| finding.set.as_ref().is_some_and(|set| set.starts_with(key));
                found.0.into_iter().find(|finding| is_of_value(finding) && is_own(finding))
            };
            let tried = if is_known { VALUES_TRIED } else { 1 };
            // As soon as one value isn't refused, there is nothing to tell.
            let all: Option<Vec<Diagnostic>> = self.values_of(key, tried).map(refused).collect();
            let first = all.and_then(|all| all.into_iter().next());
            reader.found.0.extend(first.map(|finding| Diagnostic {
                file: file.to_owned(),
                set: None,
                position: None,
                span: None,
                written: None,
                path: key.to_owned(),
                ..finding
            }));
        }
        if reader.found.has_errors() { Err(reader.placed_in(root.get_ref())) } else { Ok(()) }
    }

    /// Up to `most` values of a key, all over those that it takes; of one that is searched both ends.
    fn values_of<'s>(&'s self, key: &'s str, most: u64) -> Box<dyn Iterator<Item = String> + 's> {
        if let Some(find) = self.find().filter(|find| find.key == key) {
            return Box::new([find.low_text(), find.high_text()].into_iter());
        }
        if let Some(values) = self.listed(key) {
            let at = move |place| values.get(usize::try_from(place).ok()?).cloned();
            return Box::new(spread(values.len() as u64, most).filter_map(at));
        }
        let of_case = move |case| self.case(case).into_iter().find(|(name, _)| name == key).map(|(_, value)| value);
        Box::new(spread(self.samples(), most).filter_map(of_case))
    }

    /// Refuses a scene that can't be run whatever the values: of up to 16 cases all over the study, the first and the last among them, each
    /// is refused for the same errors of its text.
    ///
    /// # Errors
    /// These errors; their places are in the scene file.
    pub fn check_scene(&self, source: &StudyScene) -> Result<(), Diagnostics> {
        let low = self.find().map(Find::low_text);
        let mut common: Option<Vec<Diagnostic>> = None;
        for number in spread(self.cases(), CASES_TRIED) {
            let setting = self.setting(number, low.as_deref());
            let Err(Diagnostics(found)) = source.load(&setting) else { return Ok(()) };
            let of_text = |one: &Diagnostic| one.severity == Severity::Error && one.set.is_none();
            let known = |one: &Diagnostic| common.as_ref().is_none_or(|common| common.contains(one));
            let left: Vec<Diagnostic> = found.into_iter().filter(|one| of_text(one) && known(one)).collect();
            if left.is_empty() {
                return Ok(());
            }
            common = Some(left);
        }
        Err(Diagnostics(common.unwrap_or_default()))
    }

    /// Refuses outputs that no run of the scene has: a value that `summary.json` has in no run, or a
    /// column that neither the first case has in `trajectory.csv` nor the last. `text` is that of
    /// the sweep file, for the places of the findings.
    ///
    /// # Errors
    /// What is wrong with them.
    pub fn check_outputs(&self, source: &StudyScene, text: &str, file: &str) -> Result<(), Diagnostics> {
        let last = self.cases().saturating_sub(1);
        let offered: Vec<Offered> = [0, last]
            .into_iter()
            .take(if last > 0 { 2 } else { 1 })
            .filter_map(|case| self.offered(source, case))
            .collect();
        let mut reader = Reader::new(file, text);
        let root = reader.root()?;
        let tables = entries(root.get_ref());
        let written = tables.iter().find(|(name, _)| *name == "outputs").and_then(|(_, node)| node.table());
        let places: Vec<(&str, Node<'_, '_>)> = written.map(entries).unwrap_or_default();
        let of_bands: Vec<Output> = self.wanted().bands.iter().flat_map(Bands::outputs).collect();
        let end = offered.iter().map(|offered| offered.end).fold(0.0, f64::max);
        let end_is_known = !offered.is_empty() && !self.case(0).iter().any(|(key, _)| key == "time.end");
        let late = |output: &Output| past_end(output, end).filter(|_| end_is_known);
        if let Some(Missing { remedy, .. }) = of_bands.last().and_then(late) {
            let rule = format!("after the end of the runs, t = {end} s");
            reader.wrong("bands.until", None, &rule, remedy);
        }
        let missing =
            |output: &Output| missing(output, &offered).or_else(|| late(output).filter(|_| !of_bands.contains(output)));
        for output in self.outputs() {
            let Some(Missing { rule, meant, remedy }) = missing(output) else { continue };
            let is_of_bands = of_bands.contains(output);
            // Of the bands one is wrong as the others are.
            if is_of_bands && reader.found.0.iter().any(|finding| finding.path == "bands") {
                continue;
            }
            let (path, place) = if is_of_bands {
                ("bands".to_owned(), tables.iter().find(|(name, _)| *name == "bands"))
            } else {
                (format!("outputs.{}", output.name()), places.iter().find(|(name, _)| *name == output.name()))
            };
            reader.wrong(&path, place.map(|(_, node)| node), &rule, remedy);
            if let Some(finding) = reader.found.0.last_mut() {
                finding.did_you_mean = meant;
            }
        }
        if reader.found.has_errors() { Err(reader.placed_in(root.get_ref())) } else { Ok(()) }
    }

    /// `None` where the case is refused.
    fn offered(&self, source: &StudyScene, case: u64) -> Option<Offered> {
        let scene = source.scene(&self.setting(case, self.find().map(Find::low_text).as_deref())).ok()?;
        let simulation = source.simulation(&scene).ok()?;
        let mut tell = |_: &str| {};
        let recorder = Recorder::in_memory(&scene, &simulation.layout, &mut tell).ok()?;
        let (header, _) = recorder.trajectory();
        let columns = header.trim_end().split(',').map(str::to_owned).collect();
        let record = recorder.into_record();
        let (layout, state) = (&simulation.layout, &simulation.state);
        let summary = Summary::of_keys(&["headline"], &scene, layout, state, &record, EndedWord::Complete, 0.0);
        Some(Offered { end: scene.time.end, columns, summary })
    }
}

/// Why an output can have no value, and what was probably meant.
struct Missing {
    rule: String,
    meant: Option<String>,
    remedy: &'static str,
}

impl Missing {
    fn new(rule: String, meant: Option<String>) -> Self {
        let remedy =
            "run one case with `teeter run`, and take a number of its summary.json or a column of its trajectory.csv";
        Self { rule, meant, remedy }
    }
}

/// `None` for an output that isn't after the end of the runs (s).
fn past_end(output: &Output, end: f64) -> Option<Missing> {
    let t = output.time().filter(|t| *t > end * (1.0 + 1e-12))?;
    let rule = format!("t = {t} s is after the end of the runs, t = {end} s");
    Some(Missing { rule, meant: None, remedy: "take a time up to there, or make the runs longer (`time.end`)" })
}

/// `None` where a run can have the output.
fn missing(output: &Output, offered: &[Offered]) -> Option<Missing> {
    if let Some(path) = output.summary_path() {
        return missing_value(path, offered.first().map(|offered| &offered.summary));
    }
    let name = output.column()?;
    let first = offered.first()?;
    if offered.iter().any(|offered| offered.columns.iter().any(|column| column == name)) {
        return None;
    }
    let known: Vec<&str> = first.columns.iter().map(String::as_str).collect();
    let more =
        if known.len() > MOST_LISTED { format!(" and {} more", known.len() - MOST_LISTED) } else { String::new() };
    let listed = known[..known.len().min(MOST_LISTED)].join(", ");
    let rule = format!("trajectory.csv has no column {name}; it has {listed}{more}");
    Some(Missing::new(rule, nearest(name, known).map(str::to_owned)))
}

fn missing_value(path: &str, summary: Option<&Summary>) -> Option<Missing> {
    let (key, inner) = path.split_once('.').map_or((path, None), |(key, inner)| (key, Some(inner)));
    if CLOCKED.contains(&key) {
        let rule = format!("{key} depends on the machine, and rows that are continued or merged must not");
        let remedy = "leave it out; `teeter run` of a case tells its time, and `teeter tradeoff` what accuracy costs";
        return Some(Missing { rule, meant: None, remedy });
    }
    let rule = || format!("summary.json has no value at {path}");
    if !Summary::KEYS.contains(&key) {
        let near = nearest(key, Summary::KEYS);
        let meant = near.map(|near| inner.map_or_else(|| near.to_owned(), |inner| format!("{near}.{inner}")));
        return Some(Missing::new(rule(), meant));
    }
    let inner = inner.filter(|_| FIXED_PARTS.contains(&key))?;
    let mut now = &summary?.value(key)?;
    let mut before = key.to_owned();
    for part in inner.split('.') {
        let map = match now {
            Value::Object(map) => map,
            // What a run may have.
            Value::Null => return None,
            _ => return Some(Missing::new(rule(), None)),
        };
        let Some(next) = map.get(part) else {
            let near = nearest(part, map.keys().map(String::as_str));
            return Some(Missing::new(rule(), near.map(|near| format!("{before}.{near}"))));
        };
        before = format!("{before}.{part}");
        now = next;
    }
    None
}
