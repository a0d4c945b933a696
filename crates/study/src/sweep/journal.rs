//! The rows of a study on disk.
//!
//! While a study runs its rows stand in a journal, in the order in which cases end; a kill loses
//! at most the row that is being written. At the end they are sorted into `results.csv`.

use super::figures::{Ensemble, FIGURE_FILES, StudyTable, TableError};
use super::{IDENTITY, Sweep, SweepIdentity, SweepIdentityError};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, Seek, SeekFrom, Write};
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

fn io_error(path: &Path) -> impl FnOnce(io::Error) -> JournalError + '_ {
    |source| JournalError::Io { path: path.to_owned(), source }
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
        // Nothing but `results.csv` of an ended study says what is in it.
        match fs::remove_file(folder.join(PARQUET)) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                return Err(io_error(&folder.join(PARQUET))(error));
            }
            _ => {}
        }
        if !path.exists() && ended.exists() {
            fs::rename(&ended, &path).map_err(io_error(&ended))?;
        }
        if !path.exists() {
            fs::write(&path, sweep.header()).map_err(io_error(&path))?;
        }
        let bytes = fs::read(&path).map_err(io_error(&path))?;
        // Rows of other columns can't stand in one table with ours.
        let header = bytes.split_inclusive(|&byte| byte == b'\n').next().unwrap_or_default();
        if header.ends_with(b"\n") && header != sweep.header().as_bytes() {
            return Err(JournalError::Table { path, source: TableError::OtherColumns });
        }
        let whole = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1);
        let columns = cells_of(&sweep.header()).unwrap_or(0);
        let (mut done, mut rejected, mut rows) = (Done::default(), 0, Vec::new());
        for line in bytes[..whole].split_inclusive(|&byte| byte == b'\n').skip(1) {
            match row_of(line, columns).filter(|&case| case < sweep.cases()) {
                Some(case) => {
                    done.insert(case);
                    rows.extend_from_slice(line);
                }
                None => rejected += 1,
            }
        }
        if whole == 0 || rejected > 0 {
            results.write(JOURNAL, [sweep.header().as_bytes(), &rows].concat())?;
        }
        let mut file = File::options().write(true).open(&path).map_err(io_error(&path))?;
        if whole > 0 && rejected == 0 {
            file.set_len(whole as u64).map_err(io_error(&path))?;
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

/// The case of a line with its end, if it is a row of so many columns.
fn row_of(line: &[u8], columns: usize) -> Option<u64> {
    let line = std::str::from_utf8(line).ok()?;
    number_of(line).filter(|_| cells_of(line) == Some(columns))
}

/// The number of cells of a line; `None` if it is empty.
fn cells_of(line: &str) -> Option<usize> {
    let mut record = csv::StringRecord::new();
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(line.as_bytes());
    reader.read_record(&mut record).ok()?.then_some(record.len())
}

/// The case of a row; `None` for the header.
fn number_of(line: &str) -> Option<u64> {
    line.split(',').next()?.parse().ok()
}

/// Sorts rows by their case. A case that ran twice, as after a kill between its row and the next
/// start, keeps its first row. A last row without its end was cut off: it is none.
fn sorted<'t>(texts: impl Iterator<Item = &'t str>) -> Vec<(u64, &'t str)> {
    let mut rows: Vec<(u64, &str)> = texts
        .flat_map(|text| text.split_inclusive('\n'))
        .filter(|line| line.ends_with('\n'))
        .filter_map(|line| Some((number_of(line)?, line)))
        .collect();
    rows.sort_by_key(|(case, _)| *case);
    rows.dedup_by_key(|(case, _)| *case);
    rows
}

/// Writes `results.csv` from the journal of a folder, whose study has all its rows, and removes the
/// journal.
///
/// # Errors
/// If a file can't be read or written.
pub fn write_results(results: &Results, sweep: &Sweep) -> Result<(), JournalError> {
    let path = results.folder().join(JOURNAL);
    let text = fs::read_to_string(&path).map_err(io_error(&path))?;
    let mut rows = sorted(std::iter::once(text.as_str()));
    rows.retain(|(case, _)| *case < sweep.cases());
    results.write(RESULTS, table(&sweep.header(), &rows))?;
    // On the disk before its only other copy goes: a power cut must not take a study.
    let written = results.folder().join(RESULTS);
    File::open(&written).and_then(|file| file.sync_all()).map_err(io_error(&written))?;
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
        let text = fs::read_to_string(&path).map_err(io_error(&path))?;
        results.write(PARQUET, super::parquet_table(&text, sweep)?)?;
        Ok(())
    }
    #[cfg(not(feature = "parquet"))]
    {
        let _ = sweep;
        Ok(results.remove(PARQUET)?)
    }
}

fn table(header: &str, rows: &[(u64, &str)]) -> String {
    let mut all = header.to_owned();
    rows.iter().for_each(|(_, line)| all.push_str(line));
    all
}

/// What a folder says of its study.
fn identity_text(folder: &Path) -> Result<String, JournalError> {
    let place = folder.join(IDENTITY);
    fs::read_to_string(&place).map_err(|source| match source.kind() {
        io::ErrorKind::NotFound => JournalError::NoStudy { folder: folder.to_owned() },
        _ => JournalError::Io { path: place, source },
    })
}

/// Puts the results of all shards of a study together: the text of `results.csv` and that of the
/// identity of the whole study. The bytes are those of one run of all cases.
///
/// # Errors
/// If a folder holds no study or another one, a shard is missing, twice there or unfinished.
pub fn merge(folders: &[PathBuf]) -> Result<(String, String), JournalError> {
    let mut shards: BTreeMap<u64, &PathBuf> = BTreeMap::new();
    let mut study: Option<SweepIdentity> = None;
    let mut texts = Vec::new();
    for folder in folders {
        let foreign = |source| JournalError::Foreign { folder: folder.clone(), source };
        let identity = SweepIdentity::from_json(&identity_text(folder)?).map_err(foreign)?;
        if let Some(study) = &study {
            study.admit_study(&identity).map_err(foreign)?;
            if study.shard().of() != identity.shard().of() {
                let source = SweepIdentityError::Shard { then: identity.shard(), now: study.shard() };
                return Err(foreign(source));
            }
        }
        let shard = identity.shard();
        if let Some(first) = shards.insert(shard.number(), folder) {
            return Err(JournalError::Twice { shard, first: first.clone(), second: folder.clone() });
        }
        let (ended, running) = (folder.join(RESULTS), folder.join(JOURNAL));
        let place = if ended.exists() { ended } else { running };
        let rows = fs::read_to_string(&place).map_err(io_error(&place))?;
        let own = sorted(std::iter::once(rows.as_str()));
        let (expected, there) = (shard.count(identity.cases()), own.len() as u64);
        let header = |text: &str| text.lines().next().unwrap_or_default().to_owned();
        if texts.first().is_some_and(|first: &String| header(first) != header(&rows)) {
            return Err(JournalError::Table { path: place, source: TableError::OtherColumns });
        }
        if there < expected {
            return Err(JournalError::Unfinished { folder: folder.clone(), missing: expected - there });
        }
        // The rows may have been copied from another shard, or edited.
        let of_shard = shard.cases(identity.cases());
        if own.iter().map(|(case, _)| *case).ne(of_shard) {
            return Err(JournalError::OtherRows { path: place, shard });
        }
        let first = rows.split_inclusive('\n').next().unwrap_or_default();
        StudyTable::read(&table(first, &own)).map_err(|source| JournalError::Table { path: place, source })?;
        texts.push(rows);
        study.get_or_insert(identity);
    }
    let Some(study) = study else { return Err(JournalError::MissingShards("all".to_owned())) };
    let of = study.shard().of();
    let missing: Vec<String> =
        (1..=of).filter(|number| !shards.contains_key(number)).map(|number| format!("{number}/{of}")).collect();
    if !missing.is_empty() {
        return Err(JournalError::MissingShards(missing.join(", ")));
    }
    // The same sweep has the same columns.
    let header = texts.first().and_then(|text| text.split_inclusive('\n').next()).unwrap_or_default();
    Ok((table(header, &sorted(texts.iter().map(String::as_str))), study.as_whole().to_json()))
}

/// The study in a folder that has ended, under this name in figures.
///
/// # Errors
/// If the folder holds none, or one that hasn't ended.
pub fn ended_study(folder: &Path, name: &str) -> Result<Ensemble, JournalError> {
    let foreign = |source| JournalError::Foreign { folder: folder.to_owned(), source };
    let identity = SweepIdentity::from_json(&identity_text(folder)?).map_err(foreign)?;
    // The values are in the table; the files that a pattern once matched need not be here.
    let as_written = |_: &str, pattern: &str| Ok(vec![pattern.to_owned()]);
    let sweep =
        Sweep::read(identity.sweep(), IDENTITY, &as_written).map_err(|_| foreign(SweepIdentityError::Unreadable))?;
    let path = folder.join(RESULTS);
    let rows = fs::read_to_string(&path).map_err(io_error(&path))?;
    let table = StudyTable::read(&rows).map_err(|source| JournalError::Table { path, source })?;
    Ok(Ensemble { name: name.to_owned(), sweep, table })
}
