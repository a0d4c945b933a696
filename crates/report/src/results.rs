//! The folder that a run writes.

use crate::table::Table;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The files that a run may write; which of the figures, depends on its scene.
pub const FILES: [&str; 13] = [
    "trajectory.csv",
    "contacts.csv",
    "impacts.csv",
    "energy.csv",
    "scene.toml",
    "summary.json",
    "report.html",
    "figures/phi.svg",
    "figures/omega.svg",
    "figures/w_mid.svg",
    "figures/contact_forces.svg",
    "figures/energy.svg",
    "figures/phase.svg",
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
        if folder.exists() && !folder.is_dir() {
            return Err(ResultsError::NotFolder(folder.to_owned()));
        }
        let old: Vec<PathBuf> = FILES.iter().map(|file| folder.join(file)).filter(|path| path.exists()).collect();
        if !old.is_empty() && !force {
            return Err(ResultsError::Exists(folder.to_owned()));
        }
        fs::create_dir_all(folder).map_err(|source| ResultsError::Io { path: folder.to_owned(), source })?;
        let results = Self { folder: folder.to_owned() };
        // Before anything old goes, it has to be sure that something new can come.
        let trial = results.temporary("trial");
        fs::write(&trial, b"").map_err(|source| ResultsError::Io { path: folder.to_owned(), source })?;
        // An old summary beside new tables would look like one run.
        for path in old.into_iter().chain([trial]) {
            fs::remove_file(&path).map_err(|source| ResultsError::Io { path, source })?;
        }
        Ok(results)
    }

    /// Where a file stands until it is complete.
    fn temporary(&self, name: &str) -> PathBuf {
        let path = self.folder.join(name);
        let file = path.file_name().unwrap_or_default().to_string_lossy();
        path.with_file_name(format!(".{file}.part"))
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

    /// Writes a whole file, under a temporary name until it is complete.
    ///
    /// # Errors
    /// If it can't be written.
    pub fn write(&self, name: &str, text: &str) -> Result<(), ResultsError> {
        let path = self.folder.join(name);
        let temporary = self.temporary(name);
        let written = path
            .parent()
            .map_or(Ok(()), fs::create_dir_all)
            .and_then(|()| fs::write(&temporary, text))
            .and_then(|()| fs::rename(&temporary, &path));
        written.map_err(|source| {
            // The first error is the one to tell; what is left of the file may stay where it can't be removed.
            let _ = fs::remove_file(&temporary);
            ResultsError::Io { path, source }
        })
    }
}
