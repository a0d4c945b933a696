//! A table on disk that holds whole rows, whatever ends the run; but a kill may cut the row that is being written.

use crate::ResultsError;
use crate::results::new_file;
use std::fs::File;
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Rows are kept back until there are so many bytes of them: a run that is killed loses those, and nothing else.
const BUFFER: usize = 1 << 16;

/// A CSV file that grows row by row. What is on disk ends with a whole row after every write, also after one for which there
/// was no room.
#[derive(Debug)]
pub(crate) struct Table {
    path: PathBuf,
    /// None where the rows go nowhere, or stay in the buffer.
    file: Option<File>,
    /// Whether all rows stay in the buffer.
    in_memory: bool,
    buffer: Vec<u8>,
    /// Bytes of whole rows on disk.
    written: u64,
}

impl Table {
    /// A table whose rows go nowhere: of a run that is watched and not written.
    pub(crate) fn nowhere() -> Self {
        Self { path: PathBuf::new(), file: None, in_memory: false, buffer: Vec::new(), written: 0 }
    }

    /// A table whose rows, without a header, stay in memory.
    pub(crate) fn in_memory() -> Self {
        Self { in_memory: true, ..Self::nowhere() }
    }

    /// Whether its rows go anywhere, so that they are worth writing.
    pub(crate) fn takes_rows(&self) -> bool {
        self.in_memory || self.file.is_some()
    }

    /// The rows of a table in memory.
    pub(crate) fn kept(&self) -> &[u8] {
        if self.in_memory { &self.buffer } else { &[] }
    }

    /// A new table with its header row on disk.
    pub(crate) fn create(folder: &Path, name: &str, header: &str) -> Result<Self, ResultsError> {
        let path = folder.join(name);
        let file = create(&path).map_err(|source| ResultsError::Io { path: path.clone(), source })?;
        let mut table =
            Self { path, file: Some(file), in_memory: false, buffer: Vec::with_capacity(2 * BUFFER), written: 0 };
        table.rows(header)?;
        table.flush()?;
        Ok(table)
    }

    /// A table that is there, cut to so many bytes of whole rows, to be added to.
    pub(crate) fn reopen(folder: &Path, name: &str, length: u64) -> Result<Self, ResultsError> {
        let path = folder.join(name);
        let open = || {
            if std::fs::symlink_metadata(&path)?.is_symlink() {
                return Err(io::Error::new(
                    io::ErrorKind::InvalidInput,
                    "it is a link, and tables are not written through links",
                ));
            }
            let mut file = File::options().write(true).open(&path)?;
            file.set_len(length)?;
            file.seek(SeekFrom::Start(length))?;
            Ok(file)
        };
        match open() {
            Ok(file) => Ok(Self {
                path,
                file: Some(file),
                in_memory: false,
                buffer: Vec::with_capacity(2 * BUFFER),
                written: length,
            }),
            Err(source) => Err(ResultsError::Io { path, source }),
        }
    }

    /// Bytes of whole rows on disk.
    pub(crate) fn written(&self) -> u64 {
        self.written
    }

    /// Adds whole rows, each with its line end.
    pub(crate) fn rows(&mut self, text: &str) -> Result<(), ResultsError> {
        if self.file.is_none() {
            if self.in_memory {
                self.buffer.extend_from_slice(text.as_bytes());
            }
            return Ok(());
        }
        self.buffer.extend_from_slice(text.as_bytes());
        if self.buffer.len() >= BUFFER { self.flush() } else { Ok(()) }
    }

    /// Brings all rows to disk.
    pub(crate) fn flush(&mut self) -> Result<(), ResultsError> {
        let Some(file) = &mut self.file else { return Ok(()) };
        let (taken, result) = write_counted(file, &self.buffer);
        let whole = match result {
            Ok(()) => taken,
            Err(_) => self.buffer[..taken].iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1),
        };
        self.written += whole as u64;
        self.buffer.clear();
        result.map_err(|source| {
            // Half a row would read as a wrong number. Where even this fails, the error below is still the one to tell.
            let _ = file.set_len(self.written);
            ResultsError::Io { path: self.path.clone(), source }
        })
    }
}

/// An empty file; one of that name goes, and a link isn't followed.
fn create(path: &Path) -> io::Result<File> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => new_file(path),
    }
}

/// Writes as much as there is room for; how many bytes that was, and why not more.
fn write_counted(file: &mut dyn Write, bytes: &[u8]) -> (usize, io::Result<()>) {
    let mut taken = 0;
    while taken < bytes.len() {
        match file.write(&bytes[taken..]) {
            Ok(0) => return (taken, Err(io::ErrorKind::WriteZero.into())),
            Ok(n) => taken += n,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return (taken, Err(error)),
        }
    }
    (taken, Ok(()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disk with room for so many bytes.
    struct Disk(usize);

    impl Write for Disk {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            if self.0 == 0 {
                return Err(io::ErrorKind::StorageFull.into());
            }
            let taken = bytes.len().min(self.0);
            self.0 -= taken;
            Ok(taken)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn what_was_taken_is_known_when_the_disk_fills_up() {
        let (taken, result) = write_counted(&mut Disk(5), b"123456789");
        assert_eq!((taken, result.unwrap_err().kind()), (5, io::ErrorKind::StorageFull));
        assert!(write_counted(&mut Disk(9), b"123456789").1.is_ok());
    }

    #[test]
    fn a_table_goes_on_where_it_was_cut() {
        let folder = std::env::temp_dir().join(format!("teeter-table-again-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let mut table = Table::create(&folder, "t.csv", "a,b\n").unwrap();
        table.rows("1,1\n").unwrap();
        table.flush().unwrap();
        let length = table.written();
        table.rows("2,2\n3,3\n").unwrap();
        table.flush().unwrap();
        let mut again = Table::reopen(&folder, "t.csv", length).unwrap();
        again.rows("2,3\n").unwrap();
        again.flush().unwrap();
        assert_eq!(std::fs::read_to_string(folder.join("t.csv")).unwrap(), "a,b\n1,1\n2,3\n");
        assert_eq!(again.written(), length + 4);
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn rows_reach_the_disk_whole() {
        let folder = std::env::temp_dir().join(format!("teeter-table-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let mut table = Table::create(&folder, "t.csv", "a,b\n").unwrap();
        let on_disk = || std::fs::read_to_string(folder.join("t.csv")).unwrap();
        assert_eq!(on_disk(), "a,b\n");
        for k in 0..20_000 {
            table.rows(&format!("{k},{k}\n")).unwrap();
            if k % 5000 == 0 {
                assert!(on_disk().ends_with('\n'));
            }
        }
        table.flush().unwrap();
        assert_eq!(on_disk().lines().count(), 20_001);
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
