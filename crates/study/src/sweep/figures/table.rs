//! The table of a study, read back.

/// `results.csv` as cells.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyTable {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

/// Why a text is no table of results.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TableError {
    /// Not a table.
    #[error("the table can't be read: {0}")]
    Csv(#[from] csv::Error),
    /// Another table.
    #[error("the table has no column `status`: it is not the result of a sweep")]
    NoStatus,
    /// The columns of another version of the program.
    #[error(
        "its columns are not those that this program writes: run the study again, in another folder or with --force"
    )]
    OtherColumns,
}

impl StudyTable {
    /// Reads the text of `results.csv`.
    ///
    /// # Errors
    /// If it is none.
    pub fn read(text: &str) -> Result<Self, TableError> {
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let cells = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect::<Vec<_>>();
        let header = cells(reader.headers()?);
        let rows = reader.records().map(|record| Ok(cells(&record?))).collect::<Result<_, csv::Error>>()?;
        let table = Self { header, rows };
        if table.place("status").is_some() { Ok(table) } else { Err(TableError::NoStatus) }
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether it has no rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    fn place(&self, column: &str) -> Option<usize> {
        self.header.iter().position(|name| name == column)
    }

    /// The cells of a column for all cases that ran to their end; empty ones for a column that isn't
    /// there.
    pub(crate) fn completed(&self, column: &str) -> Vec<&str> {
        let place = self.place(column);
        self.rows
            .iter()
            .filter(|row| self.is_complete(row))
            .map(|row| place.and_then(|place| row.get(place)).map_or("", String::as_str))
            .collect()
    }

    /// The numbers of a column for all cases that ran to their end; NaN where there is none.
    pub(crate) fn numbers(&self, column: &str) -> Vec<f64> {
        self.completed(column).into_iter().map(|cell| cell.parse().unwrap_or(f64::NAN)).collect()
    }

    /// Number of cases with warnings.
    #[must_use]
    pub fn warned(&self) -> usize {
        let place = self.place("warnings");
        self.rows
            .iter()
            .filter(|row| place.and_then(|place| row.get(place)).is_some_and(|cell| !cell.is_empty()))
            .count()
    }

    /// Number of cases that didn't run to their end.
    #[must_use]
    pub fn incomplete(&self) -> usize {
        self.rows.iter().filter(|row| !self.is_complete(row)).count()
    }

    fn is_complete(&self, row: &[String]) -> bool {
        let status = self.place("status").and_then(|place| row.get(place));
        status.is_some_and(|status| status == "complete" || status == "stopped")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_of_the_cases_that_ended() {
        let text = "case,k,status,error\n0,\"a, b\",complete,\n1,2.5,diverged,why\n2,3,stopped,\n";
        let table = StudyTable::read(text).unwrap();
        assert_eq!((table.len(), table.incomplete()), (3, 1));
        assert_eq!(table.completed("k"), ["a, b", "3"]);
        assert!(table.numbers("k")[0].is_nan() && table.numbers("k")[1] == 3.0);
        assert_eq!(table.completed("none"), ["", ""]);
        assert!(matches!(StudyTable::read("t,x\n1,2\n"), Err(TableError::NoStatus)));
    }
}
