//! What decides the rows of a study: they can be continued and merged only where it is the same.

use super::{Shard, Sweep};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use teeter_report::content_hash;
use teeter_scenario::diagnostic::printable;

/// The file of a folder of results that holds it.
pub const IDENTITY: &str = "sweep.json";

/// The version of the program, the sweep, the scene and its files, and the shard.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SweepIdentity {
    /// The name of the sweep file, for titles; it decides nothing.
    title: String,
    program: String,
    sweep: String,
    inputs: String,
    /// The files that the scene reads, each with the beginning of its hash: what has changed is told by them.
    files: BTreeMap<String, String>,
    /// The files that each pattern of the sweep file matches, as the scene names them: with them the values of a case are known.
    matches: BTreeMap<String, Vec<String>>,
    cases: u64,
    shard: Shard,
}

/// Digits of the hash of a file.
const FILE_DIGITS: usize = 16;
/// Most files that a message names.
const MOST_NAMED: usize = 5;

/// Why rows don't belong together.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SweepIdentityError {
    /// The file doesn't hold an identity.
    #[error(
        "its sweep.json, which says of which study the rows are, isn't as `teeter sweep` wrote it: put that back, or begin anew in another \
         folder or with --force"
    )]
    Unreadable,
    /// Another version of the program, whose rows may differ.
    #[error("its rows are of version {then} of the program, not {now}")]
    Program {
        /// The version that wrote them.
        then: String,
        /// This one.
        now: String,
    },
    /// The sweep file is another one.
    #[error("the sweep file has changed since")]
    Sweep,
    /// The scene has changed, and no file that it reads.
    #[error("the scene file has changed since")]
    Scene,
    /// The scene, or a file that it reads, has changed: an older version didn't write which.
    #[error("the scene, or a file that it reads, has changed since")]
    Inputs,
    /// Files that the scene reads have changed, or the files that a pattern matches: which.
    #[error("files that the scene reads have changed since: {0}")]
    Files(String),
    /// The same patterns of files make another number of cases.
    #[error("the files that its patterns match have changed since: cases then: {then}, now: {now}")]
    Matches {
        /// The number of cases then.
        then: u64,
        /// Now.
        now: u64,
    },
    /// Another shard.
    #[error("it holds shard {then}, not {now}")]
    Shard {
        /// The shard of the folder.
        then: Shard,
        /// The shard asked for.
        now: Shard,
    },
}

impl SweepIdentity {
    /// The identity of a study of so many cases by the sweep file `sweep`; `inputs` are the bytes of
    /// the scene and of the files that it reads.
    pub fn new<'a>(sweep: &str, inputs: impl IntoIterator<Item = &'a [u8]>, cases: u64, shard: Shard) -> Self {
        let inputs = content_hash(inputs).iter().map(|byte| format!("{byte:02x}")).collect();
        Self {
            title: String::new(),
            program: env!("CARGO_PKG_VERSION").to_owned(),
            sweep: sweep.to_owned(),
            inputs,
            files: BTreeMap::new(),
            matches: BTreeMap::new(),
            cases,
            shard,
        }
    }

    /// The same study with the names and bytes of the files that its scene reads.
    #[must_use]
    pub fn reading<'a>(self, files: impl IntoIterator<Item = (&'a str, &'a [u8])>) -> Self {
        let digits = |bytes: &[u8]| {
            let hash: String = content_hash([bytes]).iter().map(|byte| format!("{byte:02x}")).collect();
            hash[..FILE_DIGITS].to_owned()
        };
        let files = files.into_iter().map(|(name, bytes)| (name.to_owned(), digits(bytes))).collect();
        Self { files, ..self }
    }

    /// The same study with the files that its patterns match.
    #[must_use]
    pub fn matching(self, matches: BTreeMap<String, Vec<String>>) -> Self {
        Self { matches, ..self }
    }

    /// The study as its sweep file describes it, with the files that its patterns matched; they need not be here.
    ///
    /// # Errors
    /// If the sweep file can't be read.
    pub fn study(&self) -> Result<Sweep, SweepIdentityError> {
        // An older version tells no files: then a pattern stands for them.
        let matched =
            |_: &str, pattern: &str| Ok(self.matches.get(pattern).cloned().unwrap_or_else(|| vec![pattern.to_owned()]));
        Sweep::read(&self.sweep, IDENTITY, &matched).map_err(|_| SweepIdentityError::Unreadable)
    }

    /// The same study with a title.
    #[must_use]
    pub fn titled(self, title: &str) -> Self {
        Self { title: title.to_owned(), ..self }
    }

    /// The title of its page; empty if it has none.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The shard.
    #[must_use]
    pub fn shard(&self) -> Shard {
        self.shard
    }

    /// The identity of the same study with all cases.
    #[must_use]
    pub fn as_whole(&self) -> Self {
        Self { shard: Shard::ALL, ..self.clone() }
    }

    /// The number of cases of the whole study.
    #[must_use]
    pub fn cases(&self) -> u64 {
        self.cases
    }

    /// The sweep file.
    #[must_use]
    pub fn sweep(&self) -> &str {
        &self.sweep
    }

    /// As the text of its file.
    #[must_use]
    pub fn to_json(&self) -> String {
        let Self { title, program, sweep, inputs, files, matches, cases, shard } = self;
        let value = json!({
            "title": title, "program": program, "cases": cases, "shard": shard.to_string(), "inputs_sha256": inputs, "files": files,
            "matches": matches, "sweep": sweep,
        });
        format!("{value:#}\n")
    }

    /// Reads the text of its file.
    ///
    /// # Errors
    /// If it is another file.
    pub fn from_json(text: &str) -> Result<Self, SweepIdentityError> {
        let value: Value = serde_json::from_str(text).map_err(|_| SweepIdentityError::Unreadable)?;
        let text = |key: &str| value.get(key).and_then(Value::as_str).map(str::to_owned);
        let read = || {
            Some(Self {
                title: text("title").unwrap_or_default(),
                program: text("program")?,
                sweep: text("sweep")?,
                inputs: text("inputs_sha256")?,
                // Older versions don't write them.
                files: value.get("files").and_then(Value::as_object).map(files_of).unwrap_or_default(),
                matches: value.get("matches").and_then(Value::as_object).map(matches_of).unwrap_or_default(),
                cases: value.get("cases")?.as_u64()?,
                shard: text("shard")?.parse().ok()?,
            })
        };
        read().ok_or(SweepIdentityError::Unreadable)
    }

    /// Whether rows of the study `then` are rows of this one, whatever the shard.
    ///
    /// # Errors
    /// What differs.
    pub fn admit_study(&self, then: &Self) -> Result<(), SweepIdentityError> {
        if then.program != self.program {
            return Err(SweepIdentityError::Program { then: then.program.clone(), now: self.program.clone() });
        }
        if then.sweep != self.sweep {
            return Err(SweepIdentityError::Sweep);
        }
        if then.inputs == self.inputs && then.cases == self.cases {
            return Ok(());
        }
        Err(match self.changed(then) {
            Some(files) => SweepIdentityError::Files(files),
            None if then.cases != self.cases => SweepIdentityError::Matches { then: then.cases, now: self.cases },
            None if then.files == self.files => SweepIdentityError::Scene,
            None => SweepIdentityError::Inputs,
        })
    }

    /// The files that are not those of `then`; `None` if that is unknown, or they are the same.
    fn changed(&self, then: &Self) -> Option<String> {
        // An older version has named none.
        if then.files.is_empty() {
            return None;
        }
        let name = |name: &str, what: &str| format!("`{}` {what}", printable(name));
        let gone = then.files.keys().filter(|file| !self.files.contains_key(*file)).map(|file| name(file, "is gone"));
        let changed = self.files.iter().filter_map(|(file, hash)| match then.files.get(file) {
            None => Some(name(file, "is new")),
            Some(before) if before != hash => Some(name(file, "is another")),
            Some(_) => None,
        });
        let all: Vec<String> = gone.chain(changed).collect();
        let more = all.len().saturating_sub(MOST_NAMED);
        let and_more = if more > 0 { format!(" and {more} more") } else { String::new() };
        (!all.is_empty()).then(|| all[..all.len().min(MOST_NAMED)].join(", ") + &and_more)
    }

    /// Whether a folder of `then` can be continued as this study and shard.
    ///
    /// # Errors
    /// What differs.
    pub fn admit(&self, then: &Self) -> Result<(), SweepIdentityError> {
        self.admit_study(then)?;
        if then.shard == self.shard {
            Ok(())
        } else {
            Err(SweepIdentityError::Shard { then: then.shard, now: self.shard })
        }
    }
}

/// Files by their names.
fn files_of(map: &Map<String, Value>) -> BTreeMap<String, String> {
    map.iter().filter_map(|(name, hash)| Some((name.clone(), hash.as_str()?.to_owned()))).collect()
}

/// Lists of files by their patterns.
fn matches_of(map: &Map<String, Value>) -> BTreeMap<String, Vec<String>> {
    let names = |list: &Value| -> Option<Vec<String>> {
        list.as_array()?.iter().map(|name| name.as_str().map(str::to_owned)).collect()
    };
    map.iter().filter_map(|(pattern, list)| Some((pattern.clone(), names(list)?))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_reads_back_and_tells_what_differs() {
        let of = |sweep: &str, input: &[u8], shard: &str| SweepIdentity::new(sweep, [input], 4, shard.parse().unwrap());
        let own = of("scene = \"a\"\n", b"[time]", "1/2");
        assert_eq!(SweepIdentity::from_json(&own.to_json()), Ok(own.clone()));
        assert_eq!(own.admit(&of("scene = \"b\"\n", b"[time]", "1/2")), Err(SweepIdentityError::Sweep));
        assert_eq!(own.admit(&of("scene = \"a\"\n", b"[tim]", "1/2")), Err(SweepIdentityError::Scene));
        let read = own.clone().reading([("a.AT2", b"1".as_slice())]);
        assert_eq!(read.admit(&of("scene = \"a\"\n", b"[tim]", "1/2")), Err(SweepIdentityError::Inputs));
        let other = of("scene = \"a\"\n", b"[time]", "2/2");
        assert_eq!(own.admit(&other).unwrap_err().to_string(), "it holds shard 2/2, not 1/2");
        assert_eq!(own.admit_study(&other), Ok(()));
        let reading = |files: &[(&'static str, &'static [u8])], cases: u64| {
            let inputs: Vec<&[u8]> = files.iter().map(|(_, bytes)| *bytes).collect();
            SweepIdentity::new("s", inputs, cases, Shard::ALL).reading(files.iter().copied())
        };
        let own = reading(&[("a.AT2", b"1"), ("b.AT2", b"2"), ("d.AT2", b"2")], 3);
        assert_eq!(SweepIdentity::from_json(&own.to_json()), Ok(own.clone()));
        let told = |then: SweepIdentity| own.admit(&then).unwrap_err().to_string();
        assert_eq!(
            told(reading(&[("a.AT2", b"1"), ("b.AT2", b"3"), ("c.AT2", b"3")], 3)),
            "files that the scene reads have changed since: `c.AT2` is gone, `b.AT2` is another, `d.AT2` is new"
        );
        let older = SweepIdentity { files: BTreeMap::new(), ..reading(&[("a.AT2", b"1")], 1) };
        assert_eq!(told(older), "the files that its patterns match have changed since: cases then: 1, now: 3");
        assert_eq!(SweepIdentity::from_json("{}"), Err(SweepIdentityError::Unreadable));
    }

    #[test]
    fn it_knows_the_values_of_files_that_are_no_longer_there() {
        let text = "scene = \"s.toml\"\n[zip]\nground.motion.x.record = { files = \"*.AT2\" }\nground.motion.x.scale = [1, 2]\n";
        let files = vec!["a.AT2".to_owned(), "b.AT2".to_owned()];
        let matches = BTreeMap::from([("*.AT2".to_owned(), files)]);
        let identity = SweepIdentity::new(text, [], 2, Shard::ALL).matching(matches);
        let read = SweepIdentity::from_json(&identity.to_json()).unwrap();
        assert_eq!(read.study().unwrap().case(1)[0].1, "b.AT2");
    }
}
