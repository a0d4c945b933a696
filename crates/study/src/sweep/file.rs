//! Sweep files.

use super::axes::{Axis, Samples, grid, samples, together};
use super::figures::{self, Wanted};
use super::find::{self, Find};
use super::number::{WrittenNumber, in_table};
use super::output::Output;
use super::spec::{Node, Reader, entries};
use crate::Setting;
use teeter_scenario::diagnostic::{Diagnostics, printable};

/// Lists the files that match a pattern (its second argument), relative to the sweep file, as the
/// scene (its first argument, relative to the sweep file) names them; or says why not.
pub type FilesOf<'a> = dyn Fn(&str, &str) -> Result<Vec<String>, String> + 'a;

/// Largest number of cases.
const MOST_CASES: u64 = 100_000_000;

/// A parameter study as its file describes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    scene: String,
    /// Keys that vary on their own, and those that vary together; the last one varies fastest.
    axes: Vec<Axis>,
    samples: Option<Samples>,
    find: Option<Find>,
    wanted: Wanted,
    outputs: Vec<Output>,
}

const TABLES: [&str; 10] =
    ["scene", "grid", "zip", "random", "find", "outputs", "fragility", "distribution", "overturning", "bands"];

/// What is given if a sweep file asks for nothing.
const DEFAULT_OUTPUTS: [&str; 4] = ["t", "impact_count", "energy.final", "energy.largest_residual"];

/// What only a scene has, in a file that has nothing of a sweep (`find` and `outputs` aside).
fn part_of_a_scene<'a, 'n, 't>(tables: &'n [(&'a str, Node<'a, 't>)]) -> Option<(&'a str, &'n Node<'a, 't>)> {
    let has = |name: &&str| tables.iter().any(|(table, _)| table == name);
    if ["scene", "grid", "zip", "random"].iter().any(has) {
        return None;
    }
    let of_a_scene = |name: &str| ["time", "world", "material", "block", "beam", "ground", "contact"].contains(&name);
    tables.iter().find(|(name, node)| of_a_scene(name) && node.table().is_some()).map(|(name, node)| (*name, node))
}

impl Sweep {
    /// Reads the text of a sweep file; `file` is its name in messages.
    ///
    /// # Errors
    /// Everything that is wrong in it.
    pub fn read(text: &str, file: &str, files: &FilesOf<'_>) -> Result<Self, Diagnostics> {
        let mut reader = Reader::new(file, text);
        let root = reader.root()?;
        let mut sweep = Self {
            scene: String::new(),
            axes: Vec::new(),
            samples: None,
            find: None,
            wanted: Wanted::default(),
            outputs: Vec::new(),
        };
        let tables = entries(root.get_ref());
        if let Some((name, node)) = part_of_a_scene(&tables) {
            let rule = "this is a scene, not a sweep: a sweep file names a scene, and the keys that vary";
            let remedy = "run it with `teeter run`, or name it in a sweep file: scene = \"scene.toml\", and keys with \
                their values under [grid]";
            reader.wrong(name, Some(node), rule, remedy);
            return Err(reader.into_findings());
        }
        // Files are listed as the scene names them, wherever in the file it is named.
        let scene = tables.iter().find(|(name, _)| *name == "scene").and_then(|(_, node)| node.text());
        let files = &|pattern: &str| files(scene.unwrap_or_default(), pattern);
        for (name, node) in tables {
            match (name, node.table()) {
                ("scene", _) => match node.text() {
                    Some(scene) if !scene.trim().is_empty() => sweep.scene = scene.to_owned(),
                    _ => reader.wrong("scene", Some(&node), "the path of a scene file is expected", SCENE_EXAMPLE),
                },
                ("grid", Some(table)) => sweep.axes.extend(grid(&mut reader, table, "grid", files)),
                ("zip", Some(table)) => sweep.axes.extend(together(&mut reader, table, &node, files)),
                ("random", Some(table)) => sweep.samples = samples(&mut reader, table, &node),
                ("find", Some(table)) => sweep.find = Find::read(&mut reader, table, &node),
                (name, Some(table)) if figures::TABLES.contains(&name) => {
                    sweep.wanted.read(&mut reader, name, table, &node);
                }
                ("outputs", Some(table)) => {
                    for (name, node) in entries(table) {
                        sweep.outputs.extend(Output::read(&mut reader, name, &node));
                    }
                }
                (known, _) if TABLES.contains(&known) => {
                    reader.wrong(
                        known,
                        Some(&node),
                        "a table is expected",
                        &format!("write [{known}], and its keys below"),
                    );
                }
                (other, _) => reader.unknown(other, &node, other, &TABLES),
            }
        }
        if sweep.outputs.is_empty() && sweep.find.is_none() && sweep.wanted.is_empty() {
            sweep.outputs.extend(DEFAULT_OUTPUTS.map(Output::summary));
        }
        if let Some(find) = &sweep.find {
            find.until.claim(&mut reader, "find.until", &mut sweep.outputs);
        }
        sweep.wanted.claim(&mut reader, &mut sweep.outputs);
        if !reader.found.has_errors() {
            sweep.check(&mut reader);
        }
        if reader.found.has_errors() { Err(reader.placed_in(root.get_ref())) } else { Ok(sweep) }
    }

    /// The first case, and changes of it that take each key through all values that are not numbers:
    /// together they name every file that a case can read.
    pub fn settings_with_files(&self) -> impl Iterator<Item = Setting> + '_ {
        let first = self.setting(0, self.find.as_ref().map(Find::low_text).as_deref());
        let named = self.axes.iter().flat_map(|axis| {
            let words = |values: &[String]| values.iter().any(|value| WrittenNumber::read(value).is_none());
            let count = if axis.values.iter().any(|values| words(values)) { axis.len() } else { 0 };
            (1..usize::try_from(count).unwrap_or(0)).map(move |place| {
                let pairs = axis.keys.iter().zip(&axis.values);
                pairs.fold(Setting::none(), |setting, (key, values)| setting.set(key.clone(), values[place].clone()))
            })
        });
        let base = first.clone();
        std::iter::once(first).chain(named.map(move |setting| base.clone().with(&setting)))
    }

    /// Rules for the whole file.
    fn check(&self, reader: &mut Reader<'_>) {
        if self.scene.is_empty() {
            reader.wrong("scene", None, "missing: which scene varies?", SCENE_EXAMPLE);
        }
        let keys = self.keys();
        if keys.is_empty() && self.find.is_none() {
            let remedy = "give keys with their values under [grid], [zip] or [random], such as \
                contact.feet.friction = [0.3, 0.5] under [grid]";
            reader.wrong("", None, "nothing varies", remedy);
        }
        for (place, key) in keys.iter().enumerate() {
            if keys[..place].contains(key) {
                reader.wrong(key, None, "varies twice", "keep one of the two");
            }
        }
        if let Some(find) = self.find.as_ref().filter(|find| keys.contains(&find.key.as_str())) {
            reader.wrong(&find.key, None, "varies and is searched", "keep one of the two");
        }
        let names: Vec<&str> = self.outputs.iter().map(Output::name).collect();
        for (place, name) in names.iter().enumerate() {
            let searched = self.find.as_ref().is_some_and(|find| find.key == *name || find::COLUMNS.contains(name));
            let reserved = searched || RESERVED.contains(name) || keys.contains(name);
            if reserved || names[..place].contains(name) {
                let rule = "a column of that name is in the results already";
                reader.wrong(&format!("outputs.{name}"), None, rule, "take another name");
            }
            // The header of the table is one line, in which the column is found again by its name.
            if name.is_empty() || name.contains(char::is_control) {
                let rule = "the name of a column is one line of text";
                reader.wrong(&format!("outputs.{name}"), None, rule, "take another name");
            }
        }
        let searched = self.find.iter().flat_map(|find| std::iter::once(find.key.as_str()).chain(find::COLUMNS));
        let columns: Vec<&str> = keys.iter().copied().chain(searched).chain(names.iter().copied()).collect();
        self.wanted.check(reader, &columns);
        for (path, name) in self.wanted.of_numbers() {
            if let Some(why) = self.without_numbers(name) {
                let rule = format!("numbers are expected, but {why}");
                reader.wrong(path, None, &rule, "name a key or an output that is a number in each case");
            }
        }
        if self.checked_cases().is_none_or(|cases| cases > MOST_CASES) {
            let rule = format!("more than {MOST_CASES} cases");
            reader.wrong(self.longest(), None, &rule, "use fewer values, or random samples of the same keys");
        }
    }

    /// What has most values, by its path.
    fn longest(&self) -> &str {
        let random = self.samples.iter().map(|samples| (samples.count, "random.count"));
        let axes = self.axes.iter().filter_map(|axis| Some((axis.len(), axis.keys.first()?.as_str())));
        random.chain(axes).max_by_key(|(count, _)| *count).map_or("", |(_, path)| path)
    }

    /// What the column of a key or an output holds if it has no numbers.
    fn without_numbers(&self, name: &str) -> Option<String> {
        let of_key = self.axes.iter().flat_map(|axis| axis.keys.iter().zip(&axis.values)).find(|(key, _)| *key == name);
        let is_word = |value: &String| in_table(name, value).parse::<f64>().is_err();
        if let Some(word) =
            of_key.filter(|(_, values)| values.iter().all(is_word)).and_then(|(_, values)| values.first())
        {
            return Some(format!("the values of `{name}` are words, such as {}", printable(word)));
        }
        let output = self.outputs.iter().find(|output| output.name() == name)?;
        output.word().map(|what| format!("the output `{name}` is {what}"))
    }

    /// The path of the scene file, relative to the sweep file.
    #[must_use]
    pub fn scene(&self) -> &str {
        &self.scene
    }

    /// The keys that vary, in the order of the columns.
    #[must_use]
    pub fn keys(&self) -> Vec<&str> {
        let fixed = self.axes.iter().flat_map(|axis| &axis.keys);
        let random = self.samples.iter().flat_map(|samples| samples.keys.iter().map(|random| &random.key));
        fixed.chain(random).map(String::as_str).collect()
    }

    /// The values of a key that aren't random.
    pub(super) fn listed(&self, key: &str) -> Option<&[String]> {
        let mut pairs = self.axes.iter().flat_map(|axis| axis.keys.iter().zip(&axis.values));
        pairs.find(|(name, _)| *name == key).map(|(_, values)| values.as_slice())
    }

    /// Number of random samples of each combination.
    pub(super) fn samples(&self) -> u64 {
        self.samples.as_ref().map_or(1, |samples| samples.count)
    }

    /// The outputs, in the order of the columns.
    #[must_use]
    pub fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn checked_cases(&self) -> Option<u64> {
        self.axes.iter().try_fold(self.samples(), |cases, axis| cases.checked_mul(axis.len()))
    }

    /// Number of cases: all combinations of the axes, each with all samples.
    #[must_use]
    pub fn cases(&self) -> u64 {
        self.checked_cases().unwrap_or(u64::MAX)
    }

    /// The keys of a case, numbered from 0, with their values, in the order of [`Self::keys`].
    #[must_use]
    pub fn case(&self, number: u64) -> Vec<(String, String)> {
        let mut rest = number;
        let sample = match &self.samples {
            Some(samples) => {
                let sample = rest % samples.count;
                rest /= samples.count;
                sample
            }
            None => 0,
        };
        let mut fixed = Vec::new();
        for axis in self.axes.iter().rev() {
            let place = usize::try_from(rest % axis.len()).unwrap_or(0);
            rest /= axis.len();
            let pairs = axis.keys.iter().zip(&axis.values);
            fixed.extend(pairs.rev().filter_map(|(key, values)| Some((key.clone(), values.get(place)?.clone()))));
        }
        fixed.reverse();
        if let Some(samples) = &self.samples {
            for (place, random) in samples.keys.iter().enumerate() {
                let value = random.distribution.quantile(samples.sampler.share(place, sample));
                fixed.push((random.key.clone(), random.unit.text_of(value)));
            }
        }
        fixed
    }

    /// A case as changes to the scene, with this value of the key that is searched, if one is.
    pub(crate) fn setting(&self, number: u64, searched: Option<&str>) -> Setting {
        let fixed =
            self.case(number).into_iter().fold(Setting::none(), |setting, (key, value)| setting.set(key, value));
        match (&self.find, searched) {
            (Some(find), Some(value)) => fixed.set(find.key.clone(), value),
            _ => fixed,
        }
    }

    /// The limit that is searched in each case.
    pub(crate) fn find(&self) -> Option<&Find> {
        self.find.as_ref()
    }

    /// What is to be made of the table.
    pub(crate) fn wanted(&self) -> &Wanted {
        &self.wanted
    }

    /// Whether figures are to be made of the table.
    #[must_use]
    pub fn wants_figures(&self) -> bool {
        !self.wanted.is_empty()
    }

    /// Whether a limit is searched in each case without other values than those of the bisection.
    #[must_use]
    pub fn bisects_blindly(&self) -> bool {
        self.find.as_ref().is_some_and(|find| !find.scans())
    }

    /// The names of the columns of the results.
    #[must_use]
    pub fn header(&self) -> String {
        let keys = self.keys();
        let outputs = self.outputs.iter().map(Output::name);
        let found = self.find.iter().flat_map(|find| std::iter::once(find.key.as_str()).chain(find::COLUMNS));
        let names = std::iter::once("case").chain(keys.iter().copied()).chain(found).chain(outputs).chain(LAST_COLUMNS);
        names.map(super::output::quoted).collect::<Vec<_>>().join(",") + "\n"
    }
}

/// The columns after the outputs.
const LAST_COLUMNS: [&str; 4] = ["status", "unsolved_steps", "warnings", "error"];
/// Names that outputs can't have.
const RESERVED: [&str; 5] = ["case", "status", "unsolved_steps", "warnings", "error"];
pub(super) const SCENE_EXAMPLE: &str = "name it relative to the sweep file, such as scene = \"rocking.toml\"";
