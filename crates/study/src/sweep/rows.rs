//! Files of rows of a study, read a line at a time: a study of any size needs no table in memory.

use super::figures::TableError;
use super::number::in_table;
use super::output::one_line;
use super::{JournalError, Shard, Sweep};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use teeter_scenario::diagnostic::printable;

/// What the lines of a file have to be.
pub(super) struct Rows<'a> {
    sweep: &'a Sweep,
    header: String,
    /// Number of cells of a row.
    cells: usize,
    /// Number of cases.
    cases: u64,
    /// Whether the values of the keys follow from the number of a case.
    keys_are_known: bool,
}

impl<'a> Rows<'a> {
    /// Those of a study of so many cases. Where the sweep has another number of them, the files that its patterns match aren't
    /// known, and neither are the values of its keys.
    pub(super) fn new(sweep: &'a Sweep, cases: u64) -> Self {
        let header = sweep.header();
        let cells = cells_of(&header).map_or(0, |cells| cells.len());
        Self { sweep, header, cells, cases, keys_are_known: sweep.cases() == cases }
    }

    /// The first line, with its end.
    pub(super) fn header(&self) -> &str {
        &self.header
    }

    /// The case of a line with its end; `None` if it isn't a row of the study.
    ///
    /// # Errors
    /// If a key has another value in it than the study gives to this case.
    pub(super) fn case_of(&self, line: &[u8], path: &Path) -> Result<Option<u64>, JournalError> {
        let cells = std::str::from_utf8(line).ok().filter(|line| line.ends_with('\n')).and_then(cells_of);
        let Some(cells) = cells.filter(|cells| cells.len() == self.cells) else { return Ok(None) };
        let case = cells.get(0).and_then(|cell| cell.parse::<u64>().ok()).filter(|case| *case < self.cases);
        if let Some(case) = case.filter(|_| self.keys_are_known) {
            for ((key, written), found) in self.sweep.case(case).iter().zip(cells.iter().skip(1)) {
                let wanted = one_line(&in_table(key, written));
                if !is_same(&wanted, found) {
                    return Err(JournalError::AlteredKey {
                        path: path.to_owned(),
                        case,
                        key: printable(key),
                        found: printable(found),
                        wanted: printable(&wanted),
                    });
                }
            }
        }
        Ok(case)
    }
}

/// Whether two cells say the same, if only as numbers.
fn is_same(wanted: &str, found: &str) -> bool {
    wanted == found || wanted.parse::<f64>().ok().zip(found.parse::<f64>().ok()).is_some_and(|(a, b)| a == b)
}

/// The cells of a line; `None` if it is empty.
fn cells_of(line: &str) -> Option<csv::StringRecord> {
    let text = line.strip_suffix('\n').unwrap_or(line);
    // Most have nothing that a reader of CSV, which takes far longer to set up than to read a line, is needed for.
    if !text.is_empty() && !text.contains(['"', '\r', '\n', '\u{feff}']) {
        return Some(text.split(',').collect());
    }
    let mut record = csv::StringRecord::new();
    let mut builder = csv::ReaderBuilder::new();
    let mut reader = builder.has_headers(false).buffer_capacity(line.len().max(1)).from_reader(line.as_bytes());
    reader.read_record(&mut record).ok()?.then_some(record)
}

pub(super) fn io_error(path: &Path) -> impl FnOnce(io::Error) -> JournalError + '_ {
    |source| JournalError::Io { path: path.to_owned(), source }
}

/// Hands on each line of a file, with its end if it has one, and the place where it begins.
pub(super) fn each_line(
    path: &Path,
    mut take: impl FnMut(u64, &[u8]) -> Result<(), JournalError>,
) -> Result<(), JournalError> {
    let mut reader = BufReader::new(File::open(path).map_err(io_error(path))?);
    let (mut at, mut line) = (0, Vec::new());
    loop {
        line.clear();
        let length = reader.read_until(b'\n', &mut line).map_err(io_error(path))?;
        if length == 0 {
            return Ok(());
        }
        take(at, &line)?;
        at += length as u64;
    }
}

/// The rows of a shard in a file, in any order: of each only its place is held.
#[derive(Debug)]
pub(super) struct RowFile {
    reader: BufReader<File>,
    shard: Shard,
    /// By the cases of the shard: where the row begins, counted from 1; 0 for a case without a row.
    places: Vec<u64>,
    /// Where the reader is.
    at: u64,
    line: Vec<u8>,
}

impl RowFile {
    /// Finds the rows of the cases of `shard`. A case that ran twice, as after a kill between its row and the next start, has its
    /// first row. A last line without its end was cut off: it is none.
    ///
    /// # Errors
    /// If the file can't be read, has other columns, or a line is no row of the shard.
    pub(super) fn open(path: PathBuf, rows: &Rows<'_>, shard: Shard) -> Result<Self, JournalError> {
        let count = usize::try_from(shard.count(rows.cases)).unwrap_or(usize::MAX);
        let mut places = vec![0_u64; count];
        let wrong = |source| JournalError::Table { path: path.clone(), source };
        let mut number = 0;
        each_line(&path, |at, line| {
            number += 1;
            if at == 0 && line != rows.header.as_bytes() {
                return Err(wrong(TableError::OtherColumns));
            }
            if at == 0 || !line.ends_with(b"\n") {
                return Ok(());
            }
            let Some(case) = rows.case_of(line, &path)? else { return Err(wrong(TableError::NotARow(number))) };
            let place = shard.place(case).and_then(|place| places.get_mut(usize::try_from(place).ok()?));
            let Some(place) = place else { return Err(JournalError::OtherRows { path: path.clone(), shard }) };
            if *place == 0 {
                *place = at + 1;
            }
            Ok(())
        })?;
        let reader = BufReader::new(File::open(&path).map_err(io_error(&path))?);
        Ok(Self { reader, shard, places, at: 0, line: Vec::new() })
    }

    /// Number of cases without a row.
    pub(super) fn missing(&self) -> u64 {
        self.places.iter().filter(|place| **place == 0).count() as u64
    }

    /// Writes the row of a case of the shard.
    pub(super) fn copy(&mut self, case: u64, out: &mut dyn Write) -> io::Result<()> {
        let place = self.shard.place(case).and_then(|place| self.places.get(usize::try_from(place).ok()?));
        let Some(begin) = place.and_then(|place| place.checked_sub(1)) else { return Ok(()) };
        // Cases end nearly in their order: most rows are in the buffer already.
        let ahead = i64::try_from(begin).unwrap_or(i64::MAX) - i64::try_from(self.at).unwrap_or(0);
        self.reader.seek_relative(ahead)?;
        self.line.clear();
        let length = self.reader.read_until(b'\n', &mut self.line)?;
        self.at = begin + length as u64;
        out.write_all(&self.line)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_in_any_order_are_found_and_an_altered_key_is_refused() {
        let text = "scene = 's.toml'\n[grid]\nblock.b.tilt = ['1 rad', '2 rad', '3 rad']\ntime.scheme = ['a, b']\n[outputs]\nn = 't'\n";
        let sweep = Sweep::read(text, "f", &|_, _| Err(String::new())).unwrap();
        let rows = Rows::new(&sweep, 3);
        let path = std::env::temp_dir().join(format!("teeter-rows-{}.csv", std::process::id()));
        let row = |case: u64, tilt: &str| format!("{case},{tilt},\"a, b\",7,complete,0,,\n");
        let open = |lines: &[String], shard: Shard| {
            std::fs::write(&path, rows.header().to_owned() + &lines.concat()).unwrap();
            RowFile::open(path.clone(), &rows, shard).map_err(|error| error.to_string())
        };
        let all = [row(2, "3.0"), row(0, "1"), row(1, "2.0"), row(0, "1.0"), "1,2.".to_owned()];
        let mut file = open(&all, Shard::ALL).unwrap();
        let mut out = Vec::new();
        (0..3).for_each(|case| file.copy(case, &mut out).unwrap());
        assert_eq!(String::from_utf8(out).unwrap(), [row(0, "1"), row(1, "2.0"), row(2, "3.0")].concat());
        assert_eq!((file.missing(), open(&all[..2], Shard::ALL).unwrap().missing()), (0, 1));
        let told = open(&[row(1, "2.5")], Shard::ALL).err().unwrap();
        assert!(told.contains("the row of case 1 has block.b.tilt = 2.5, but the study gives it 2.0"), "{told}");
        let told = open(&[row(1, "2.0"), "2,3.0\n".to_owned()], Shard::ALL).err().unwrap();
        assert!(told.contains("line 3 is no row of the study"), "{told}");
        assert!(open(&[row(1, "2.0")], Shard::new(1, 2).unwrap()).err().unwrap().contains("shard 1/2"));
        // Without the files that a pattern matched nobody knows the values.
        std::fs::write(&path, rows.header().to_owned() + &row(3, "9")).unwrap();
        assert!(RowFile::open(path.clone(), &Rows::new(&sweep, 4), Shard::ALL).is_ok());
        std::fs::remove_file(&path).unwrap();
    }
}
