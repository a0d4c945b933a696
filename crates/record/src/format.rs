//! The formats and their recognition.

use std::fmt;

use crate::error::{RecordError, shown};

/// A file format of records.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// The Pacific Earthquake Engineering Research Center's `.AT2`, in g.
    Peer,
    /// The Engineering Strong Motion database's ASCII, also called DYNA.
    Esm,
    /// The COSMOS Strong Motion Data Format, version 1.20 (August 15, 2001).
    Cosmos,
    /// A plain table of numbers.
    Table,
}

/// Lines in which the format is searched: PEER's header has 4, ESM's 64.
const HEADER: usize = 70;

impl Format {
    /// The format of a file, recognised by its content: COSMOS by `(Format v` in the first line,
    /// ESM by lines `NDATA:` or `SAMPLING_INTERVAL_S:`, PEER by `NPTS`, and a table by numbers,
    /// which may follow a heading and comments.
    ///
    /// # Errors
    /// If no format is recognised, or there are only blank lines.
    pub fn of(text: &str) -> Result<Self, RecordError> {
        let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
        let Some((_, first)) = lines.clone().next() else { return Err(RecordError::Empty) };
        if first.to_ascii_lowercase().contains("(format v") {
            return Ok(Self::Cosmos);
        }
        let is_key = |line: &str| {
            let key = line.split(':').next().unwrap_or_default().trim();
            line.contains(':') && matches!(key, "NDATA" | "SAMPLING_INTERVAL_S")
        };
        let header = || lines.clone().take(HEADER).map(|(_, line)| line).filter(|line| !line.starts_with('#'));
        if header().any(is_key) {
            return Ok(Self::Esm);
        }
        if header().any(|line| line.to_ascii_uppercase().contains("NPTS")) {
            return Ok(Self::Peer);
        }
        let mut rows = lines.by_ref().filter(|(_, line)| !line.trim_start().starts_with('#'));
        let Some((index, row)) = rows.next() else { return Err(RecordError::Empty) };
        let has_numbers = crate::table::begins_with_number(row)
            || rows.next().is_some_and(|(_, next)| crate::table::begins_with_number(next));
        if has_numbers { Ok(Self::Table) } else { Err(RecordError::Unknown { line: index + 1, text: shown(row) }) }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Peer => "PEER .AT2",
            Self::Esm => "ESM",
            Self::Cosmos => "COSMOS",
            Self::Table => "table",
        })
    }
}
