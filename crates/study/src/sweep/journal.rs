//! The rows of a study on disk.
//!
//! While a study runs its rows stand in a journal, in the order in which cases end; a kill loses
//! at most the row that is being written. At the end they are sorted into `results.csv`.

use super::figures::{Ensemble, FIGURE_FILES, StudyTable, TableError};
use super::rows::{RowFile, Rows, each_line, io_error};
use super::{IDENTITY, Shard, Sweep, SweepIdentity, SweepIdentityError};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufReader, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use teeter_report::{Results, ResultsError};

/// The table of a study that has ended.
pub const RESULTS: &str = "results.csv";
/// The same table with the types of its columns.
pub const PARQUET: &str = "results.parquet";
/// The rows of a study that hasn't.
pub const JOURNAL: &str = "journal.csv";
/// The files that a study may write, in the order in which they are removed.
pub const FILES: [&str; FIGURE_FILES.len() + 4] = {
    let mut all = [RESULTS; FIGURE_FILES.len() + 4];
    let mut k = 0;
    while k < FIGURE_FILES.len() {
        all[k] = FIGURE_FILES[k];
        k += 1;
    }
    all[k + 1] = PARQUET;
    all[k + 2] = JOURNAL;
    all[k + 3] = IDENTITY;
    all
};

/// Why rows can't be kept, continued or merged.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum JournalError {
    /// A folder or file can't be read or written.
    #[error("{}: {source}", path.display())]
    Io {
        /// The folder or file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A folder of results can't be written.
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// The rows of a folder belong to another study or shard.
    #[error("{}: {source}", folder.display())]
    Foreign {
        /// The folder.
        folder: PathBuf,
        /// What differs.
        source: SweepIdentityError,
    },
    /// A folder without a study.
    #[error(
        "{}: {}; a folder that `teeter sweep` has written is expected",
        folder.display(),
        if folder.exists() { "there is no sweep.json in it" } else { "there is no such folder" }
    )]
    NoStudy {
        /// The folder.
        folder: PathBuf,
    },
    /// Rows of a study that nobody knows.
    #[error(
        "{}: there are rows in it, but no sweep.json, which says of which study they are: put it back, or begin anew in another folder or with \
         --force",
        .0.display()
    )]
    NoIdentity(PathBuf),
    /// A row whose case has another value of a key.
    #[error(
        "{}: the row of case {case} has {key} = {found}, but the study gives it {wanted}: delete that line, and --resume of that study runs \
         the case again",
        path.display()
    )]
    AlteredKey {
        /// The file.
        path: PathBuf,
        /// The case.
        case: u64,
        /// The key.
        key: String,
        /// Its value in the row.
        found: String,
        /// That of the case.
        wanted: String,
    },
    /// A shard that has not ended.
    #[error("{}: {missing} of its cases are still to do; continue it with --resume", folder.display())]
    Unfinished {
        /// The folder.
        folder: PathBuf,
        /// Number of cases without a row.
        missing: u64,
    },
    /// Rows of other cases than those of the shard.
    #[error("{}: its rows aren't those of shard {shard}: one is missing, or of another shard; run it again", path.display())]
    OtherRows {
        /// The file.
        path: PathBuf,
        /// The shard.
        shard: super::Shard,
    },
    /// A table that can't be read back.
    #[error("{}: {source}", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// Why.
        source: TableError,
    },
    /// A table that can't be written as Parquet.
    #[cfg(feature = "parquet")]
    #[error(transparent)]
    Parquet(#[from] super::ParquetTableError),
    /// Shards that are not there.
    #[error("shards are missing: {0}")]
    MissingShards(String),
    /// A shard that is there twice.
    #[error("shard {shard} is in {} and in {}", first.display(), second.display())]
    Twice {
        /// The shard.
        shard: super::Shard,
        /// A folder.
        first: PathBuf,
        /// The other folder.
        second: PathBuf,
    },
}

/// The journal of a study that runs.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
    done: Done,
    /// Lines that were none of this study's rows.
    rejected: usize,
}

/// The cases that have a row, a bit each.
#[derive(Clone, Debug, Default)]
struct Done {
    bits: Vec<u64>,
    count: u64,
}

impl Done {
    fn insert(&mut self, case: u64) {
        let (word, bit) = ((case / 64) as usize, 1 << (case % 64));
        if self.bits.len() <= word {
            self.bits.resize(word + 1, 0);
        }
        if self.bits[word] & bit == 0 {
            self.bits[word] |= bit;
            self.count += 1;
        }
    }

    fn has(&self, case: u64) -> bool {
        self.bits.get((case / 64) as usize).is_some_and(|word| word >> (case % 64) & 1 == 1)
    }
}

impl Journal {
    /// The journal of a new study in a folder that is free.
    ///
    /// # Errors
    /// If a file can't be written.
    pub fn create(results: &Results, identity: &SweepIdentity, sweep: &Sweep) -> Result<Self, JournalError> {
        let path = results.folder().join(JOURNAL);
        results.write(IDENTITY, identity.to_json())?;
        results.write(JOURNAL, sweep.header())?;
        let mut file = File::options().write(true).open(&path).map_err(io_error(&path))?;
        file.seek(SeekFrom::End(0)).map_err(io_error(&path))?;
        Ok(Self { path, file, done: Done::default(), rejected: 0 })
    }

    /// The journal of the study of `identity` in a folder, with the rows that it holds. A row that a
    /// kill cut is removed, and so are [lines that are no rows](Self::rejected). `None` if the folder holds no study; a study that has ended has all its
    /// rows.
    ///
    /// # Errors
    /// If the folder holds another study, or a file can't be read or written.
    pub fn reopen(results: &Results, identity: &SweepIdentity, sweep: &Sweep) -> Result<Option<Self>, JournalError> {
        let folder = results.folder();
        let place = folder.join(IDENTITY);
        let text = match fs::read_to_string(&place) {
            Ok(text) => text,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(io_error(&place)(error)),
        };
        let foreign = |source| JournalError::Foreign { folder: folder.to_owned(), source };
        identity.admit(&SweepIdentity::from_json(&text).map_err(foreign)?).map_err(foreign)?;
        let (ended, path) = (folder.join(RESULTS), folder.join(JOURNAL));
        let rows = Rows::new(sweep, sweep.cases());
        let (mut done, mut rejected, mut whole) = (Done::default(), 0, 0);
        let shard = identity.shard();
        let case_of = |line: &[u8], file: &Path| -> Result<Option<u64>, JournalError> {
            Ok(rows.case_of(line, file)?.filter(|case| shard.place(*case).is_some()))
        };
        // Nothing is changed before all rows are known to be those of the study.
        let place = if !path.exists() && ended.exists() { &ended } else { &path };
        if place.exists() {
            each_line(place, |at, line| {
                if !line.ends_with(b"\n") {
                    return Ok(());
                }
                whole = at + line.len() as u64;
                // Rows of other columns can't stand in one table with ours.
                if at == 0 {
                    let other = || JournalError::Table { path: place.clone(), source: TableError::OtherColumns };
                    return if line == rows.header().as_bytes() { Ok(()) } else { Err(other()) };
                }
                match case_of(line, place)? {
                    Some(case) => done.insert(case),
                    None => rejected += 1,
                }
                Ok(())
            })?;
        }
        // Nothing but `results.csv` of an ended study says what is in it.
        match fs::remove_file(folder.join(PARQUET)) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                return Err(io_error(&folder.join(PARQUET))(error));
            }
            _ => {}
        }
        if *place == ended {
            fs::rename(&ended, &path).map_err(io_error(&ended))?;
        }
        if whole == 0 {
            results.write(JOURNAL, rows.header())?;
        } else if rejected > 0 {
            results.write_with(JOURNAL, |out| {
                let copied = each_line(&path, |at, line| match at == 0 || case_of(line, &path)?.is_some() {
                    true => out.write_all(line).map_err(io_error(&path)),
                    false => Ok(()),
                });
                copied.map_err(io::Error::other)
            })?;
        }
        let mut file = File::options().write(true).open(&path).map_err(io_error(&path))?;
        if whole > 0 && rejected == 0 {
            file.set_len(whole).map_err(io_error(&path))?;
        }
        file.seek(SeekFrom::End(0)).map_err(io_error(&path))?;
        Ok(Some(Self { path, file, done, rejected }))
    }

    /// How many lines were removed when the journal was opened, as they were no rows of its study.
    #[must_use]
    pub fn rejected(&self) -> usize {
        self.rejected
    }

    /// Number of cases with a row.
    #[must_use]
    pub fn done(&self) -> u64 {
        self.done.count
    }

    /// The cases of an iterator that have no row yet.
    pub fn missing<I: Iterator<Item = u64>>(&self, cases: I) -> impl Iterator<Item = u64> + use<I> {
        let done = self.done.clone();
        cases.filter(move |case| !done.has(*case))
    }

    /// Adds the row of a case.
    ///
    /// # Errors
    /// If it can't be written; then it isn't there in part either.
    pub fn add(&mut self, case: u64, line: &str) -> Result<(), JournalError> {
        let before = self.file.stream_position().map_err(io_error(&self.path))?;
        if let Err(error) = self.file.write_all(line.as_bytes()) {
            // Half a row would read as a wrong one. Where even this fails, the next start cuts it.
            let _ = self.file.set_len(before);
            return Err(io_error(&self.path)(error));
        }
        self.done.insert(case);
        Ok(())
    }
}

/// Writes `results.csv` from the journal of a folder, whose study has all its rows, and removes the
/// journal.
///
/// # Errors
/// If a file can't be read or written.
pub fn write_results(results: &Results, sweep: &Sweep, shard: Shard) -> Result<(), JournalError> {
    let rows = Rows::new(sweep, sweep.cases());
    let mut journal = RowFile::open(results.folder().join(JOURNAL), &rows, shard)?;
    results.write_with(RESULTS, |out| {
        out.write_all(rows.header().as_bytes())?;
        shard.cases(sweep.cases()).try_for_each(|case| journal.copy(case, out))
    })?;
    // On the disk before its only other copy goes: a power cut must not take a study.
    let written = results.folder().join(RESULTS);
    File::open(&written).and_then(|file| file.sync_all()).map_err(io_error(&written))?;
    drop(journal);
    Ok(results.remove(JOURNAL)?)
}

/// Writes `results.parquet` from the `results.csv` of a folder, under a temporary name until it is
/// complete; without the feature `parquet`, removes one of before.
///
/// # Errors
/// If a file can't be read or written.
pub fn write_parquet(results: &Results, sweep: &Sweep) -> Result<(), JournalError> {
    #[cfg(feature = "parquet")]
    {
        let path = results.folder().join(RESULTS);
        let mut why = None;
        let written = results.write_with(PARQUET, |out| {
            let written = super::parquet_table(|| File::open(&path), sweep, out);
            written.map_err(|error| {
                let text = error.to_string();
                why = Some(error);
                io::Error::other(text)
            })
        });
        match why {
            Some(error) => Err(error.into()),
            None => Ok(written?),
        }
    }
    #[cfg(not(feature = "parquet"))]
    {
        let _ = sweep;
        Ok(results.remove(PARQUET)?)
    }
}

/// What a folder says of its study.
fn identity_text(folder: &Path) -> Result<String, JournalError> {
    let place = folder.join(IDENTITY);
    fs::read_to_string(&place).map_err(|source| match source.kind() {
        io::ErrorKind::NotFound => JournalError::NoStudy { folder: folder.to_owned() },
        _ => JournalError::Io { path: place, source },
    })
}

/// The shards of a study, which are put together to the bytes of one run of all cases.
#[derive(Debug)]
pub struct Merged {
    study: SweepIdentity,
    sweep: Sweep,
    /// In the order of the shards.
    files: Vec<RowFile>,
}

/// Opens the results of all shards of a study.
///
/// # Errors
/// If a folder holds no study or another one, a shard is missing, twice there or unfinished, or a row isn't that of its case.
pub fn merge(folders: &[PathBuf]) -> Result<Merged, JournalError> {
    let mut shards: BTreeMap<u64, (&PathBuf, RowFile)> = BTreeMap::new();
    let mut known: Option<(SweepIdentity, Sweep)> = None;
    for folder in folders {
        let foreign = |source| JournalError::Foreign { folder: folder.clone(), source };
        let identity = SweepIdentity::from_json(&identity_text(folder)?).map_err(foreign)?;
        let (study, sweep) = match &known {
            Some((study, sweep)) => (study, sweep),
            None => {
                let sweep = identity.study().map_err(foreign)?;
                let (study, sweep) = known.insert((identity.clone(), sweep));
                (&*study, &*sweep)
            }
        };
        study.admit_study(&identity).map_err(foreign)?;
        let shard = identity.shard();
        if study.shard().of() != shard.of() {
            return Err(foreign(SweepIdentityError::Shard { then: shard, now: study.shard() }));
        }
        if let Some((first, _)) = shards.get(&shard.number()) {
            return Err(JournalError::Twice { shard, first: (*first).clone(), second: folder.clone() });
        }
        let (ended, running) = (folder.join(RESULTS), folder.join(JOURNAL));
        let place = if ended.exists() { ended } else { running };
        let rows = RowFile::open(place, &Rows::new(sweep, study.cases()), shard)?;
        if rows.missing() > 0 {
            return Err(JournalError::Unfinished { folder: folder.clone(), missing: rows.missing() });
        }
        shards.insert(shard.number(), (folder, rows));
    }
    let Some((study, sweep)) = known else { return Err(JournalError::MissingShards("all".to_owned())) };
    let of = study.shard().of();
    let missing: Vec<String> =
        (1..=of).filter(|number| !shards.contains_key(number)).map(|number| format!("{number}/{of}")).collect();
    if !missing.is_empty() {
        return Err(JournalError::MissingShards(missing.join(", ")));
    }
    let files = shards.into_values().map(|(_, rows)| rows).collect();
    Ok(Merged { study: study.as_whole(), sweep, files })
}

impl Merged {
    /// The study.
    #[must_use]
    pub fn sweep(&self) -> &Sweep {
        &self.sweep
    }

    /// Its title; empty if it has none.
    #[must_use]
    pub fn title(&self) -> &str {
        self.study.title()
    }

    /// Writes `sweep.json`, `results.csv` and `results.parquet`.
    ///
    /// # Errors
    /// If a file can't be read or written.
    pub fn write(&mut self, results: &Results) -> Result<(), JournalError> {
        results.write(IDENTITY, self.study.to_json())?;
        let Self { study, sweep, files } = self;
        let of = files.len() as u64;
        results.write_with(RESULTS, |out| {
            out.write_all(sweep.header().as_bytes())?;
            (0..study.cases()).try_for_each(|case| match files.get_mut(usize::try_from(case % of).unwrap_or(0)) {
                Some(rows) => rows.copy(case, out),
                None => Ok(()),
            })
        })?;
        write_parquet(results, sweep)
    }
}

/// The study in a folder that has ended, under this name in figures.
///
/// # Errors
/// If the folder holds none, or one that hasn't ended.
pub fn ended_study(folder: &Path, name: &str) -> Result<Ensemble, JournalError> {
    let foreign = |source| JournalError::Foreign { folder: folder.to_owned(), source };
    let identity = SweepIdentity::from_json(&identity_text(folder)?).map_err(foreign)?;
    let sweep = identity.study().map_err(foreign)?;
    let path = folder.join(RESULTS);
    let file = File::open(&path).map_err(io_error(&path))?;
    let table =
        StudyTable::read(BufReader::new(file), &sweep).map_err(|source| JournalError::Table { path, source })?;
    Ok(Ensemble { name: name.to_owned(), sweep, table })
}
