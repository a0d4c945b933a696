//! The folder that a run writes.

use crate::checkpoint::CHECKPOINT;
use crate::lock::FolderLock;
use crate::page::{VTK_SERIES, is_pair_figure, is_vtk_picture};
use crate::table::Table;
use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// The files that a run may write; which of the figures, depends on its scene. They are removed in this order: no summary
/// outlives a table, and while there is anything, `scene.toml` says of what.
pub const FILES: [&str; 40] = [
    CHECKPOINT,
    "summary.json",
    "trajectory.csv",
    "blocks.csv",
    "contacts.csv",
    "impacts.csv",
    "energy.csv",
    "envelopes.csv",
    "columns.json",
    "report.html",
    "figures/phi.svg",
    "figures/omega.svg",
    "figures/x.svg",
    "figures/vx.svg",
    "figures/y.svg",
    "figures/vy.svg",
    "figures/displacement.svg",
    "figures/w_mid.svg",
    "figures/shapes.svg",
    "figures/ground.svg",
    "figures/ground_v.svg",
    "figures/ground_a.svg",
    "figures/ground_phi.svg",
    "figures/ground_v_phi.svg",
    "figures/ground_a_phi.svg",
    "figures/contact_forces.svg",
    "figures/slip.svg",
    "figures/section_forces.svg",
    "figures/envelopes.svg",
    "figures/energy.svg",
    "figures/phase.svg",
    "figures/phase_x.svg",
    "figures/phase_y.svg",
    "figures/records.svg",
    "figures/spectra.svg",
    "figures/force_chains.svg",
    "figures/thrust_line.svg",
    "figures/eccentricity.svg",
    VTK_SERIES,
    "scene.toml",
];

/// The rows of a sweep that isn't finished.
const JOURNAL: &str = "journal.csv";

/// Why results can't be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ResultsError {
    /// There are results already.
    #[error("{} holds results already; --force replaces them", .0.display())]
    Exists(PathBuf),
    /// There is a run that can go on.
    #[error("{} holds results already, and a checkpoint: --resume goes on from it, --force replaces them all", .0.display())]
    Resumable(PathBuf),
    /// There is a study that can go on.
    #[error("{} holds part of a sweep: --resume goes on with it, --force begins anew", .0.display())]
    Unfinished(PathBuf),
    /// There are results of another command, some of them in files of the same names.
    #[error("{} holds the results of {command}, which are not to be mixed with others; take another folder (--out)", folder.display())]
    OfAnother {
        /// The folder.
        folder: PathBuf,
        /// The command.
        command: &'static str,
    },
    /// The name is taken by a file.
    #[error("{} is a file, not a folder", .0.display())]
    NotFolder(PathBuf),
    /// Somebody else is writing there.
    #[error("{holder} is writing results to {}; wait for it, or take another folder (--out)", folder.display())]
    InUse {
        /// The folder.
        folder: PathBuf,
        /// Who is writing, such as `process 4711`.
        holder: String,
    },
    /// A link that leads nowhere, or a link or file where a folder of results is to be.
    #[error("{} {what}; remove it, or take another folder (--out)", path.display())]
    Link {
        /// The link.
        path: PathBuf,
        /// What is wrong with it.
        what: String,
    },
    /// A file that a command reads would be replaced by one that it writes.
    #[error("{} is read by this command, and would be replaced by its own results; take another folder (--out)", .0.display())]
    Input(PathBuf),
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
    /// Nobody else writes there while this is.
    _lock: FolderLock,
}

/// A folder that nobody else writes to, with all that it held still there: for who takes long before there are results.
#[derive(Debug)]
pub struct Reserved {
    folder: PathBuf,
    files: &'static [&'static str],
    force: bool,
    /// Whether it wasn't there before.
    new: bool,
    lock: Option<FolderLock>,
}

/// Files that only one command writes.
const MARKS: [(&str, &str); 7] = [
    ("trajectory.csv", "`teeter run`"),
    ("summary.json", "`teeter run`"),
    (CHECKPOINT, "`teeter run`"),
    ("tradeoff.json", "`teeter tradeoff`"),
    ("sweep.json", "`teeter sweep`"),
    ("compare.json", "`teeter compare`"),
    ("fit.json", "`teeter fit`"),
];

/// The lock of a folder for results.
const LOCK: &str = ".teeter.lock";

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
    /// If the path is not a directory, leads out of itself by a link, or holds results and `force` isn't given; who is writing there is
    /// told first, as neither `force` nor going on is a way then.
    pub fn replaced(files: &[&str], folder: &Path, force: bool) -> Result<Vec<PathBuf>, ResultsError> {
        Self::old_files(files, folder, force).map_err(|error| FolderLock::holding(folder, LOCK).unwrap_or(error))
    }

    /// As [`Results::replaced`], whoever holds the lock.
    fn old_files(files: &[&str], folder: &Path, force: bool) -> Result<Vec<PathBuf>, ResultsError> {
        check_folder(folder)?;
        if !folder.exists() {
            return Ok(Vec::new());
        }
        check_inner_folders(files, folder)?;
        let mark = MARKS.iter().find(|(file, _)| !files.contains(file) && is_there(&folder.join(file)));
        if let Some((_, command)) = mark {
            return Err(ResultsError::OfAnother { folder: folder.to_owned(), command });
        }
        let series = files.iter().flat_map(|file| members_beside(&folder.join(file)));
        let named = files.iter().map(|file| folder.join(file)).filter(|path| is_there(path));
        // First of all, as the series that lists them is told of by its name.
        let old: Vec<PathBuf> = series.chain(named).collect();
        if !old.is_empty() && !force {
            let has = |file: &str| old.contains(&folder.join(file));
            let error = match (has(CHECKPOINT), has(JOURNAL)) {
                (true, _) => ResultsError::Resumable,
                (_, true) => ResultsError::Unfinished,
                _ => ResultsError::Exists,
            };
            return Err(error(folder.to_owned()));
        }
        Ok(old)
    }

    /// What is in a folder for results that is neither one of `files` nor hidden: how many, and the first by name. It stays where it is.
    #[must_use]
    pub fn foreign(files: &[&str], folder: &Path) -> Option<(usize, String)> {
        let ours: Vec<&str> = files.iter().filter_map(|file| file.split('/').next()).collect();
        let entries =
            fs::read_dir(folder).ok()?.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned());
        let others: Vec<String> =
            entries.filter(|name| !name.starts_with('.') && !ours.contains(&name.as_str())).collect();
        let first = others.iter().min()?.clone();
        Some((others.len(), first))
    }

    /// Refuses a folder where one of `inputs` stands in the place of one of `files`, which may also be absolute paths; links
    /// are followed. Changes nothing.
    ///
    /// # Errors
    /// If there is such a file.
    pub fn spares(files: &[&str], folder: &Path, inputs: &[PathBuf]) -> Result<(), ResultsError> {
        let outputs: Vec<PathBuf> = files.iter().filter_map(|file| real_place(&folder.join(file))).collect();
        let hit = inputs.iter().find(|input| {
            // The file itself, or a link to it that stands in the folder: either would be replaced.
            let places = [input.canonicalize().ok(), real_place(input)];
            places.into_iter().flatten().any(|place| outputs.contains(&place))
        });
        hit.map_or(Ok(()), |input| Err(ResultsError::Input(input.clone())))
    }

    /// As [`Results::create`], for results that are other files than a run's: these, in the order in which they are removed.
    ///
    /// # Errors
    /// As [`Results::create`].
    pub fn create_of(files: &'static [&'static str], folder: &Path, force: bool) -> Result<Self, ResultsError> {
        Self::reserve(files, folder, force)?.create()
    }

    /// Keeps a folder for such results, so that nobody else writes there; what it holds stays until [`Reserved::create`].
    ///
    /// # Errors
    /// As [`Results::create`].
    pub fn reserve(files: &'static [&'static str], folder: &Path, force: bool) -> Result<Reserved, ResultsError> {
        Self::replaced(files, folder, force)?;
        let new = !folder.exists();
        fs::create_dir_all(folder).map_err(|source| ResultsError::Io { path: folder.to_owned(), source })?;
        let mut reserved = Reserved { folder: folder.to_owned(), files, force, new, lock: None };
        reserved.lock = Some(FolderLock::take(folder, LOCK)?);
        Ok(reserved)
    }

    /// Takes the folder of a run that goes on from a checkpoint: what it wrote at an earlier end goes, tables and checkpoint stay.
    ///
    /// # Errors
    /// If somebody else writes there, or a file can't be removed.
    pub fn reopen(folder: &Path) -> Result<Self, ResultsError> {
        let results = Self::reopen_of(&FILES, folder)?;
        // While the summary stands, the folder looks like one of a run that has ended.
        results.remove("summary.json")?;
        // The whole run may have other figures than the part that had ended: something went its own way, or came to rest.
        for file in FILES.iter().filter(|file| **file == "report.html" || file.starts_with("figures/")) {
            let path = results.folder.join(file);
            for path in members_beside(&path).into_iter().chain([path]) {
                remove_if_there(&path)?;
            }
        }
        Ok(results)
    }

    /// Takes a folder with results that are other files than a run's, to continue them: all stay.
    ///
    /// # Errors
    /// If somebody else writes there, or what an earlier end left under temporary names can't be removed.
    pub fn reopen_of(files: &'static [&'static str], folder: &Path) -> Result<Self, ResultsError> {
        check_folder(folder)?;
        check_inner_folders(files, folder)?;
        let lock = FolderLock::take(folder, LOCK)?;
        let results = Self { folder: folder.to_owned(), files, _lock: lock };
        let parts = results.files.iter().map(|file| results.temporary(file));
        for path in [results.temporary("trial")].into_iter().chain(parts) {
            remove_if_there(&path)?;
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
        remove_if_there(&self.folder.join(name))
    }

    /// Writes a whole file, under a temporary name until it is complete.
    ///
    /// # Errors
    /// If it can't be written.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> Result<(), ResultsError> {
        write_whole(&self.folder.join(name), content.as_ref())
    }

    /// As [`Results::write`], for a file that `fill` writes piece by piece.
    ///
    /// # Errors
    /// If it can't be written, or `fill` fails.
    pub fn write_with(
        &self,
        name: &str,
        fill: impl FnOnce(&mut BufWriter<fs::File>) -> io::Result<()>,
    ) -> Result<(), ResultsError> {
        write_pieces(&self.folder.join(name), fill)
    }
}

impl Reserved {
    /// Removes the results that are there, and hands the folder over for new ones.
    ///
    /// # Errors
    /// As [`Results::create`].
    pub fn create(mut self) -> Result<Results, ResultsError> {
        let folder = self.folder.clone();
        // Somebody may have written there before the lock was ours.
        let old = Results::old_files(self.files, &folder, self.force)?;
        // Before anything old goes, it has to be sure that something new can come.
        let trial = temporary(&folder.join("trial"));
        remove_if_there(&trial)?;
        new_file(&trial).map_err(|source| ResultsError::Io { path: folder.clone(), source })?;
        let parts = self.files.iter().map(|file| temporary(&folder.join(file)));
        let old: Vec<PathBuf> = parts.chain(old).collect();
        // An old summary beside new tables would look like one run.
        for path in old.into_iter().chain([trial]) {
            remove_if_there(&path)?;
        }
        let Some(lock) = self.lock.take() else { return Err(ResultsError::Exists(folder)) };
        Ok(Results { folder, files: self.files, _lock: lock })
    }
}

impl Drop for Reserved {
    fn drop(&mut self) {
        // Nothing came of it: a folder that was made for it goes, if it is still empty.
        if self.lock.take().is_some() && self.new {
            let _ = fs::remove_dir(&self.folder);
        }
    }
}

/// Writes a file and the folder that it is in, under a temporary name until it is complete; one that is
/// there is replaced.
///
/// # Errors
/// If it can't be written; then what was there is still there.
pub fn write_whole(path: &Path, content: &[u8]) -> Result<(), ResultsError> {
    write_pieces(path, |file| file.write_all(content))
}

/// As [`write_whole`], of what `fill` writes.
fn write_pieces(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<fs::File>) -> io::Result<()>,
) -> Result<(), ResultsError> {
    let temporary = temporary(path);
    let written = path
        .parent()
        .map_or(Ok(()), fs::create_dir_all)
        .and_then(|()| match fs::remove_file(&temporary) {
            // Left by a run that was killed, or a link that is not to be followed.
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
            _ => {
                let mut file = BufWriter::new(new_file(&temporary)?);
                fill(&mut file).and_then(|()| file.flush())
            }
        })
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

/// A file that isn't there yet, nor a link of that name.
pub(crate) fn new_file(path: &Path) -> io::Result<fs::File> {
    fs::File::options().write(true).create_new(true).open(path)
}

/// Whether there is a file, or a link of that name, wherever it leads.
fn is_there(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok()
}

/// The pictures of a series, or the figures of single pairs, that belong to a file, by their names: of how many, no list of files
/// can know.
fn members_beside(series: &Path) -> Vec<PathBuf> {
    // The figure as PDF, of which the run that replaces it knows nothing.
    let pdf = series.with_extension("pdf");
    let is_figure = series.extension().is_some_and(|ending| ending == "svg");
    let pdf = Some(pdf).filter(|pdf| is_figure && is_there(pdf));
    let is_member: &dyn Fn(&str) -> bool = if series.ends_with(VTK_SERIES) {
        &is_vtk_picture
    } else if series.ends_with("figures/contact_forces.svg") {
        &|name| is_pair_figure("contact_forces", name)
    } else if series.ends_with("figures/slip.svg") {
        &|name| is_pair_figure("slip", name)
    } else {
        return pdf.into_iter().collect();
    };
    let entries = series.parent().and_then(|folder| fs::read_dir(folder).ok());
    let names = entries.into_iter().flatten().flatten().map(|entry| entry.path());
    let mut pictures: Vec<PathBuf> =
        names.filter(|path| path.file_name().and_then(|name| name.to_str()).is_some_and(is_member)).collect();
    pictures.extend(pdf);
    pictures.sort();
    pictures
}

fn remove_if_there(path: &Path) -> Result<(), ResultsError> {
    match fs::remove_file(path) {
        Err(source) if source.kind() != io::ErrorKind::NotFound => {
            Err(ResultsError::Io { path: path.to_owned(), source })
        }
        _ => Ok(()),
    }
}

/// Refuses a file, or a link that leads nowhere, where a folder is wanted; a link to a folder is one.
pub(crate) fn check_folder(folder: &Path) -> Result<(), ResultsError> {
    if folder.is_dir() {
        return Ok(());
    }
    match fs::symlink_metadata(folder) {
        Ok(data) if data.is_symlink() && !folder.exists() => {
            let to = fs::read_link(folder).unwrap_or_default();
            let what = format!("is a link to {}, which is not there", to.display());
            Err(ResultsError::Link { path: folder.to_owned(), what })
        }
        Ok(_) => Err(ResultsError::NotFolder(folder.to_owned())),
        Err(_) => Ok(()),
    }
}

/// Folders inside a folder for results belong to it: a link would lead out of it, into files of somebody else.
fn check_inner_folders(files: &[&str], folder: &Path) -> Result<(), ResultsError> {
    let inner = files.iter().filter_map(|file| Path::new(file).parent()).filter(|inner| !inner.as_os_str().is_empty());
    for inner in inner {
        let path = folder.join(inner);
        match fs::symlink_metadata(&path) {
            Ok(data) if data.is_symlink() => {
                let what = "is a link, and results are not written through links".to_owned();
                return Err(ResultsError::Link { path, what });
            }
            Ok(data) if !data.is_dir() => return Err(ResultsError::NotFolder(path)),
            _ => {}
        }
    }
    Ok(())
}

/// Where a file of that path is or would be, links of its folder followed but not its own; `None` without its folder.
pub(crate) fn real_place(path: &Path) -> Option<PathBuf> {
    let name = path.file_name()?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    Some(folder.canonicalize().ok()?.join(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_run_wrote_is_replaced_and_nothing_else() {
        let folder = std::env::temp_dir().join(format!("teeter-replaced-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        for inner in ["figures", "vtk"] {
            fs::create_dir_all(folder.join(inner)).unwrap();
        }
        let ours = [
            "summary.json",
            "figures/phase_x.svg",
            "figures/phase_x.pdf",
            "figures/slip-a-on-b.pdf",
            "vtk/picture-0000.vtu",
            "vtk/picture-12345.vtu",
            VTK_SERIES,
        ];
        let foreign = [
            "figures/mine.svg",
            "figures/mine.pdf",
            "notes.txt",
            "vtk/picture-1.vtu",
            "vtk/picture-000a.vtu",
            "vtk/my-picture-0001.vtu",
        ];
        for file in ours.iter().chain(&foreign) {
            fs::write(folder.join(file), "x").unwrap();
        }
        assert!(matches!(Results::create(&folder, false), Err(ResultsError::Exists(_))));
        drop(Results::create(&folder, true).unwrap());
        let left: Vec<_> = ours.iter().filter(|file| is_there(&folder.join(file))).collect();
        let gone: Vec<_> = foreign.iter().filter(|file| !is_there(&folder.join(file))).collect();
        assert!(left.is_empty() && gone.is_empty(), "left {left:?}, gone {gone:?}");
        fs::remove_dir_all(&folder).unwrap();
    }
}
