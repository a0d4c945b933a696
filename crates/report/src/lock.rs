//! One writer a folder: two runs into the same one would mix their rows.

use crate::ResultsError;
use std::fs::{self, File, TryLockError};
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// An exclusive lock on a folder, as a file in it that says who holds it. The system lets go of it when the process
/// ends, however that is; a file left by a killed process is taken over.
#[derive(Debug)]
pub(crate) struct FolderLock {
    path: PathBuf,
    /// Locked while it is open.
    _file: File,
}

/// A lock file may be removed between being opened and being locked; then another one is there, and it is tried again.
const ATTEMPTS: usize = 100;

/// Tells the locks of one process apart.
static TAKEN: AtomicU64 = AtomicU64::new(0);

impl FolderLock {
    /// Locks `folder`, which is there, by the file `name` in it.
    ///
    /// # Errors
    /// If another process or another part of this one holds it, or the file can't be written.
    pub(crate) fn take(folder: &Path, name: &str) -> Result<Self, ResultsError> {
        let path = folder.join(name);
        let io_error = |source| ResultsError::Io { path: path.clone(), source };
        for _ in 0..ATTEMPTS {
            let mut file = match open(&path) {
                Err(source) if source.kind() == io::ErrorKind::NotFound => continue,
                opened => opened.map_err(io_error)?,
            };
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => {
                    return Err(ResultsError::InUse { folder: folder.to_owned(), holder: holder(&mut file) });
                }
                // A file system without locks: there is no way to tell, and no reason to refuse.
                Err(TryLockError::Error(source)) if source.kind() == io::ErrorKind::Unsupported => {}
                Err(TryLockError::Error(source)) => return Err(io_error(source)),
            }
            let own = format!("process {}, lock {}", std::process::id(), TAKEN.fetch_add(1, Ordering::Relaxed));
            let written = file.set_len(0).and_then(|()| file.write_all(own.as_bytes())).and_then(|()| file.flush());
            written.map_err(io_error)?;
            // The file that is locked must be the one that others find. Where a locked file can't be read through another
            // handle, it can't be removed either.
            match fs::read(&path) {
                Err(source) if source.kind() == io::ErrorKind::NotFound => {}
                Ok(found) if found != own.as_bytes() => {}
                _ => return Ok(Self { path, _file: file }),
            }
        }
        Err(io_error(io::ErrorKind::ResourceBusy.into()))
    }
    /// That another holds the lock of `folder`, without taking it.
    pub(crate) fn holding(folder: &Path, name: &str) -> Option<ResultsError> {
        let path = folder.join(name);
        let mut file = path.is_file().then(|| open(&path).ok()).flatten()?;
        // A shared lock, which lasts until the end of this function, is refused while there is an exclusive one.
        matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock))
            .then(|| ResultsError::InUse { folder: folder.to_owned(), holder: holder(&mut file) })
    }
}

/// Never through a link, which might lead out of the folder.
fn open(path: &Path) -> io::Result<File> {
    if fs::symlink_metadata(path).is_ok_and(|data| !data.is_file()) {
        return Err(io::Error::new(io::ErrorKind::AlreadyExists, "it is no regular file; remove it"));
    }
    File::options().read(true).write(true).create(true).truncate(false).open(path)
}

/// Who holds the lock, as its file says; it may just be being written.
fn holder(file: &mut File) -> String {
    let mut text = String::new();
    let read = file.rewind().and_then(|()| file.take(64).read_to_string(&mut text));
    match text.split_once(',') {
        Some((process, _)) if read.is_ok() && process.starts_with("process ") => process.to_owned(),
        _ => "another process".to_owned(),
    }
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        // While it is still locked. One that stays is taken over by the next.
        let _ = fs::remove_file(&self.path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("teeter-lock-{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    #[test]
    fn a_folder_has_one_writer_at_a_time() {
        let folder = folder("one");
        let first = FolderLock::take(&folder, ".lock").unwrap();
        let refused = FolderLock::take(&folder, ".lock").unwrap_err().to_string();
        let holder = format!("process {}", std::process::id());
        assert!(refused.contains(&holder) && refused.contains(&folder.display().to_string()), "{refused}");
        drop(first);
        assert!(!folder.join(".lock").exists());
        drop(FolderLock::take(&folder, ".lock").unwrap());
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_lock_file_that_a_killed_process_left_is_taken_over() {
        let folder = folder("stale");
        fs::write(folder.join(".lock"), "process 999999999 and some more").unwrap();
        let lock = FolderLock::take(&folder, ".lock").unwrap();
        let holder = format!("process {},", std::process::id());
        assert!(fs::read_to_string(folder.join(".lock")).unwrap().starts_with(&holder));
        drop(lock);
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn many_that_want_it_at_once_get_it_one_after_the_other() {
        use std::sync::atomic::AtomicUsize;
        let folder = folder("many");
        let (inside, taken) = (AtomicUsize::new(0), AtomicUsize::new(0));
        std::thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| {
                    for _ in 0..200 {
                        if let Ok(lock) = FolderLock::take(&folder, ".lock") {
                            assert_eq!(inside.fetch_add(1, Ordering::SeqCst), 0, "two hold it at once");
                            taken.fetch_add(1, Ordering::SeqCst);
                            inside.fetch_sub(1, Ordering::SeqCst);
                            drop(lock);
                        }
                    }
                });
            }
        });
        assert!(taken.load(Ordering::SeqCst) > 0);
        fs::remove_dir_all(&folder).unwrap();
    }
}
