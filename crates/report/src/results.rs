//! The folder that a run writes.

use crate::checkpoint::CHECKPOINT;
use crate::table::Table;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The files that a run may write; which of the figures, depends on its scene. They are removed in this order: no summary
/// outlives a table, and while there is anything, `scene.toml` says of what.
pub const FILES: [&str; 17] = [
    CHECKPOINT,
    "summary.json",
    "trajectory.csv",
    "contacts.csv",
    "impacts.csv",
    "energy.csv",
    "envelopes.csv",
    "report.html",
    "figures/phi.svg",
    "figures/omega.svg",
    "figures/w_mid.svg",
    "figures/section_forces.svg",
    "figures/envelopes.svg",
    "figures/contact_forces.svg",
    "figures/energy.svg",
    "figures/phase.svg",
    "scene.toml",
];

/// Why results can't be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ResultsError {
    /// There are results already.
    #[error("{} holds results already; --force replaces them", .0.display())]
    Exists(PathBuf),
    /// The name is taken by a file.
    #[error("{} is a file, not a folder", .0.display())]
    NotFolder(PathBuf),
    /// A folder or file that can't be made or written.
    #[error("can't write {}: {source}", path.display())]
    Io {
        /// The folder or file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
}

/// A folder for results, made if missing, free of results of an earlier run.
#[derive(Debug)]
pub struct Results {
    folder: PathBuf,
    files: &'static [&'static str],
}

impl ResultsError {
    /// Whether there was no room.
    #[must_use]
    pub fn is_disk_full(&self) -> bool {
        let full = [io::ErrorKind::StorageFull, io::ErrorKind::QuotaExceeded, io::ErrorKind::FileTooLarge];
        matches!(self, Self::Io { source, .. } if full.contains(&source.kind()))
    }
}

impl Results {
    /// Takes a folder for the results of a run. Nothing is replaced without `force`.
    ///
    /// # Errors
    /// If it holds results and `force` is not given, or it can't be made or written.
    pub fn create(folder: &Path, force: bool) -> Result<Self, ResultsError> {
        Self::create_of(&FILES, folder, force)
    }

    /// What [`Results::create_of`] would remove; changes nothing, so that who takes long can ask before and create after.
    ///
    /// # Errors
    /// If the folder is none, or holds results and `force` isn't given.
    pub fn replaced(files: &[&str], folder: &Path, force: bool) -> Result<Vec<PathBuf>, ResultsError> {
        if folder.exists() && !folder.is_dir() {
            return Err(ResultsError::NotFolder(folder.to_owned()));
        }
        let old: Vec<PathBuf> = files.iter().map(|file| folder.join(file)).filter(|path| path.exists()).collect();
        if !old.is_empty() && !force {
            return Err(ResultsError::Exists(folder.to_owned()));
        }
        Ok(old)
    }

    /// As [`Results::create`], for results that are other files than a run's: these, in the order in which they are removed.
    ///
    /// # Errors
    /// As [`Results::create`].
    pub fn create_of(files: &'static [&'static str], folder: &Path, force: bool) -> Result<Self, ResultsError> {
        let old = Self::replaced(files, folder, force)?;
        fs::create_dir_all(folder).map_err(|source| ResultsError::Io { path: folder.to_owned(), source })?;
        let results = Self { folder: folder.to_owned(), files };
        // Before anything old goes, it has to be sure that something new can come.
        let trial = results.temporary("trial");
        fs::write(&trial, b"").map_err(|source| ResultsError::Io { path: folder.to_owned(), source })?;
        let parts = results.files.iter().map(|file| results.temporary(file)).filter(|path| path.exists());
        let old: Vec<PathBuf> = parts.chain(old).collect();
        // An old summary beside new tables would look like one run.
        for path in old.into_iter().chain([trial]) {
            fs::remove_file(&path).map_err(|source| ResultsError::Io { path, source })?;
        }
        Ok(results)
    }

    /// Takes the folder of a run that goes on from a checkpoint: what it wrote at an earlier end goes, tables and checkpoint stay.
    ///
    /// # Errors
    /// If a file can't be removed.
    pub fn reopen(folder: &Path) -> Result<Self, ResultsError> {
        let results = Self { folder: folder.to_owned(), files: &FILES };
        // While the summary stands, the folder looks like one of a run that has ended.
        let (summary, trial) = (folder.join("summary.json"), results.temporary("trial"));
        let parts = results.files.iter().map(|file| results.temporary(file));
        for path in [summary, trial].into_iter().chain(parts).filter(|path| path.exists()) {
            fs::remove_file(&path).map_err(|source| ResultsError::Io { path, source })?;
        }
        Ok(results)
    }

    /// Where a file stands until it is complete.
    fn temporary(&self, name: &str) -> PathBuf {
        temporary(&self.folder.join(name))
    }

    /// The folder.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// A new table of the folder, with its header row.
    pub(crate) fn table(&self, name: &str, header: &str) -> Result<Table, ResultsError> {
        Table::create(&self.folder, name, header)
    }

    /// A table of the folder, cut to so many bytes.
    pub(crate) fn reopened_table(&self, name: &str, length: u64) -> Result<Table, ResultsError> {
        Table::reopen(&self.folder, name, length)
    }

    /// Removes a file, if it is there.
    ///
    /// # Errors
    /// If it is there to stay.
    pub fn remove(&self, name: &str) -> Result<(), ResultsError> {
        let path = self.folder.join(name);
        match fs::remove_file(&path) {
            Err(source) if source.kind() != io::ErrorKind::NotFound => Err(ResultsError::Io { path, source }),
            _ => Ok(()),
        }
    }

    /// Writes a whole file, under a temporary name until it is complete.
    ///
    /// # Errors
    /// If it can't be written.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> Result<(), ResultsError> {
        write_whole(&self.folder.join(name), content.as_ref())
    }
}

/// Writes a file and the folder that it is in, under a temporary name until it is complete.
pub(crate) fn write_whole(path: &Path, content: &[u8]) -> Result<(), ResultsError> {
    let temporary = temporary(path);
    let written = path
        .parent()
        .map_or(Ok(()), fs::create_dir_all)
        .and_then(|()| fs::write(&temporary, content))
        .and_then(|()| fs::rename(&temporary, path));
    written.map_err(|source| {
        // The first error is the one to tell; what is left of the file may stay where it can't be removed.
        let _ = fs::remove_file(&temporary);
        ResultsError::Io { path: path.to_owned(), source }
    })
}

/// Where a file stands until it is complete.
fn temporary(path: &Path) -> PathBuf {
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{file}.part"))
}
