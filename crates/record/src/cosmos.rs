//! The COSMOS Strong Motion Data Format, version 1.20 (COSMOS Strong Motion Programs Board, August
//! 15, 2001).
//!
//! A file is a row of blocks. Each has lines of text (the first says how many), integers, reals,
//! comments, and the values, each part behind a line that says how many there are and in which
//! Fortran format, as
//! `7000  acceleration pts, approx   70 secs, units=cm/sec2(04),Format=(8F10.5)`. What the headers
//! are asked for: integer 2 is the physical quantity (1: an acceleration), integer 3 the unit, real
//! 62 the step in ms. A file of velocities beside an acceleration is read as its acceleration; one
//! with several accelerations is refused, because none of them is the record.

use std::iter::Peekable;
use std::str::Lines;

use crate::error::{RecordError, shown};
use crate::format::Format;
use crate::numbers;
use crate::record::Record;
use crate::{MOST_VALUES, STANDARD_GRAVITY};

/// Unit codes of the format's table 2 that are accelerations, and what they are in m/s².
const UNITS: [(i64, f64); 5] =
    [(2, STANDARD_GRAVITY), (4, 0.01), (7, 0.0254), (10, 0.01), (11, STANDARD_GRAVITY / 1000.0)];

/// The lines of a file, with the number of the last one taken.
struct Reader<'a> {
    lines: Peekable<Lines<'a>>,
    line: usize,
}

/// One block.
struct Block {
    /// The line that announces the values.
    line: usize,
    is_acceleration: bool,
    dt: f64,
    accelerations: Vec<f64>,
    station: String,
    description: String,
}

pub(crate) fn read(text: &str) -> Result<Record, RecordError> {
    let mut reader = Reader { lines: text.lines().peekable(), line: 0 };
    let (mut found, mut other): (Option<Block>, Option<usize>) = (None, None);
    while reader.skip_blank() {
        let block = reader.block()?;
        if !block.is_acceleration {
            other = other.or(Some(block.line));
        } else if let Some(first) = &found {
            let line = block.line;
            let reason = format!(
                "a second block of acceleration (the first is in line {}): keep the one that is meant, the others in files \
                 of their own",
                first.line
            );
            return Err(RecordError::Header { line, reason });
        } else {
            found = Some(block);
        }
    }
    match (found, other) {
        (Some(block), _) => {
            Ok(Record::new("", block.dt, block.accelerations)?.described(&block.station, &block.description))
        }
        (None, Some(line)) => {
            let found = "no acceleration".to_owned();
            Err(RecordError::NotAcceleration { line, found, remedy: " (integer 2 of the header must be 1)" })
        }
        (None, None) => Err(RecordError::Empty),
    }
}

impl<'a> Reader<'a> {
    /// Whether anything follows, past blank lines.
    fn skip_blank(&mut self) -> bool {
        while self.lines.next_if(|line| line.trim().is_empty()).is_some() {
            self.line += 1;
        }
        self.lines.peek().is_some()
    }

    fn next(&mut self, what: &'static str) -> Result<&'a str, RecordError> {
        self.line += 1;
        self.lines.next().ok_or(RecordError::Missing { format: Format::Cosmos, what })
    }

    fn header<T>(&self, reason: String) -> Result<T, RecordError> {
        Err(RecordError::Header { line: self.line, reason })
    }

    fn block(&mut self) -> Result<Block, RecordError> {
        let first = self.next("text header")?;
        let count = self.text_lines(first)?;
        let mut text = vec![first];
        for _ in 1..count {
            text.push(self.next("text header of the length that its first line gives")?);
        }
        let integers = self.numbers("integer")?;
        let at = self.line;
        let reals = self.numbers("real")?;
        self.comments()?;
        let (values, line) = self.values()?;
        let integer = |k: usize| integers.get(k - 1).map(|value| *value as i64);
        let is_acceleration = integer(2) == Some(1);
        let mut block = Block {
            line,
            is_acceleration,
            dt: 0.0,
            accelerations: Vec::new(),
            station: text.get(4).map(|line| station(line)).unwrap_or_default(),
            description: text.get(1).map(|line| (*line).to_owned()).unwrap_or_default(),
        };
        if is_acceleration {
            let unit = UNITS.iter().find(|(code, _)| integer(3) == Some(*code)).map(|(_, unit)| *unit);
            let Some(unit) = unit else {
                let found = integer(3).map_or_else(String::new, |code| format!("unit {code}"));
                let known = "2 (g), 4 (cm/s^2), 7 (in/s^2), 10 (gal), 11 (mg)";
                return Err(RecordError::Unit { line: at, found, quantity: "an acceleration", known });
            };
            let Some(step) = reals.get(61).copied() else {
                return Err(RecordError::Missing { format: Format::Cosmos, what: "step (real 62)" });
            };
            // The step of most files is a round number of ms: dividing makes the nearest number of
            // s.
            block.dt = step / 1000.0;
            block.accelerations = values.into_iter().map(|value| value * unit).collect();
        }
        Ok(block)
    }

    /// How many lines of text a block has: `(Format v01.20 with 13 text lines)`.
    fn text_lines(&self, first: &str) -> Result<usize, RecordError> {
        let lower = first.to_ascii_lowercase();
        let Some(behind) = lower.split("(format v").nth(1) else {
            return self.header(format!(
                "`{}`, but a block begins with a line such as `Corrected acceleration  (Format v01.20 with 13 text lines)`",
                shown(first)
            ));
        };
        let version = behind.split_whitespace().next().unwrap_or_default();
        if !matches!(numbers::one(version), Some(version) if (1.0..2.0).contains(&version)) {
            return self.header(format!("format version `{}`, but 1.20 is read", shown(version)));
        }
        let count = behind.split_whitespace().nth(2).and_then(|word| word.parse::<usize>().ok());
        match count.filter(|count| (1..=1000).contains(count)) {
            Some(count) => Ok(count),
            None => self.header("it doesn't say how many text lines there are, as `with 13 text lines`".to_owned()),
        }
    }

    /// A part of numbers, `kind` the first word behind their count.
    fn numbers(&mut self, kind: &'static str) -> Result<Vec<f64>, RecordError> {
        let text = self.next(if kind == "real" { "real-header values" } else { "integer-header values" })?;
        if !text.to_ascii_lowercase().contains(kind) {
            return self.header(format!(
                "`{}`, but a line such as `100 {kind}-header values follow on  10 lines, Format= (10I8)` must stand here",
                shown(text)
            ));
        }
        let count = self.count(text)?;
        self.fields(count, text)
    }

    fn comments(&mut self) -> Result<(), RecordError> {
        let text = self.next("comment lines")?;
        if !text.to_ascii_lowercase().contains("comment") {
            return self.header(format!(
                "`{}`, but a line such as `2 Comment line(s) follow, each starting with a \"|\":` must stand here",
                shown(text)
            ));
        }
        for _ in 0..self.count(text)? {
            self.next("comment lines of the number that is announced")?;
        }
        Ok(())
    }

    /// The values of a block, and the line that announces them.
    fn values(&mut self) -> Result<(Vec<f64>, usize), RecordError> {
        let text = self.next("data line")?;
        let line = self.line;
        let count = self.count(text)?;
        let values = self.fields(count, text)?;
        // What follows ends the block, if it isn't the next one.
        if self.lines.next_if(|line| line.to_ascii_lowercase().contains("end-of-data")).is_some() {
            self.line += 1;
        }
        Ok((values, line))
    }

    /// The number that a line begins with.
    fn count(&self, text: &str) -> Result<usize, RecordError> {
        let word = text.split_whitespace().next().unwrap_or_default();
        match word.parse::<usize>() {
            Ok(count) if count <= MOST_VALUES => Ok(count),
            Ok(_) => Err(RecordError::TooMany),
            Err(_) => self.header(format!("`{}`, but the line must begin with a number of values", shown(text))),
        }
    }

    /// `count` numbers in the fields of the Fortran format that a line ends with.
    fn fields(&mut self, count: usize, text: &str) -> Result<Vec<f64>, RecordError> {
        let Some((per_line, width)) = fortran(text) else {
            return self.header(format!("`{}` gives no format of numbers such as (8F10.5)", shown(text)));
        };
        let at = self.line;
        let mut values = Vec::new();
        while values.len() < count {
            let Some(text) = self.lines.next_if(|line| !line.to_ascii_lowercase().contains("end-of-data")) else {
                return Err(RecordError::Count { line: at, announced: count, found: values.len() });
            };
            self.line += 1;
            let line = self.line;
            let mut used = 0;
            while used < per_line && values.len() < count {
                let end = ((used + 1) * width).min(text.len());
                let field = text.get(used * width..end).unwrap_or_default().trim();
                if field.is_empty() {
                    break;
                }
                let hint = "; numbers have to stand in the columns of the format";
                let value = numbers::one(field);
                values.push(value.ok_or_else(|| RecordError::Number { line, text: shown(field), hint })?);
                used += 1;
            }
            let rest = text.get(used * width..).unwrap_or_default().trim();
            if !rest.is_empty() {
                let hint = "; it stands past the columns of the format, or past as many values as are announced";
                return Err(RecordError::Number { line, text: shown(rest), hint });
            }
        }
        Ok(values)
    }
}

/// Numbers a line and characters a number of a format such as `(8F10.5)` or `(1P,5E15.7)`.
fn fortran(text: &str) -> Option<(usize, usize)> {
    let upper = text.to_ascii_uppercase();
    let format = upper.rsplit('(').next()?.split(')').next()?;
    let format = format.split(',').next_back()?.trim();
    let format = format.strip_prefix("1P").unwrap_or(format);
    let letter = format.find(['E', 'F', 'G', 'I', 'D'])?;
    let (repeat, field) = format.split_at_checked(letter)?;
    let width = field.get(1..)?.split('.').next()?.trim().parse().ok()?;
    let repeat = if repeat.trim().is_empty() { 1 } else { repeat.trim().parse().ok()? };
    ((1..=1000).contains(&repeat) && (1..=100).contains(&width)).then_some((repeat, width))
}

/// Number and name of the station from the fifth line of text, without its titles.
fn station(line: &str) -> String {
    line.trim().trim_start_matches("Statn No:").trim().to_owned()
}

#[cfg(test)]
mod tests {
    use crate::Record;

    /// A block of ours: quantity, unit, and the values with the line that announces them.
    fn block(quantity: usize, unit: usize, data: &str) -> String {
        let text: Vec<String> = (2..=13)
            .map(|k| if k == 5 { "Statn No: 01-1 Code:XX-A  Here".into() } else { format!("line {k}") })
            .collect();
        let integers = format!("{:8}{quantity:8}{unit:8}{:8}\n", 2, 120);
        let real = |k: usize| if k == 62 { 10.0 } else { -999.0 };
        let rows: Vec<String> = (0..17)
            .map(|row| (6 * row + 1..=(6 * row + 6).min(100)).map(|k| format!("{:13.6}", real(k))).collect::<String>())
            .collect();
        format!(
            "Corrected acceleration    (Format v01.20 with 13 text lines) Src: ours\n{}\n   4 Integer-header values follow on   1 \
             lines, Format= (10I8)\n{integers} 100 Real-header values follow on  17 lines, Format= (6F13.6)\n{}\n   1 Comment line(s) \
             follow, each starting with a \"|\":\n| made up\n{data}",
            text.join("\n"),
            rows.join("\n"),
        )
    }

    const DATA: &str = "   5  acceleration pts, approx   0 secs, units=cm/sec2(04),Format=(3F10.5)\n  \
        -1.50000-123.4567812345.6789\n   2.50000    .00100\nEnd-of-data for chan  1 acceleration\n";

    fn read(text: &str) -> Result<Record, String> {
        Record::read(text, "R").map_err(|error| error.to_string())
    }

    #[test]
    fn fields_of_fixed_width_are_read() {
        for text in [block(1, 4, DATA), block(1, 4, DATA).replace('\n', "\r\n")] {
            let record = read(&text).unwrap();
            let gal = [-1.5, -123.45678, 12345.6789, 2.5, 0.001];
            assert_eq!(record.accelerations(), gal.map(|a| a * 0.01));
            assert_eq!((record.dt(), record.station(), record.description()), (0.01, "01-1 Code:XX-A Here", "line 2"));
        }
        assert_eq!(read(&block(1, 2, DATA)).unwrap().accelerations()[3], 2.5 * 9.80665);
    }

    #[test]
    fn the_acceleration_among_other_blocks_is_taken() {
        let (velocity, acceleration) = (block(2, 5, DATA), block(1, 4, DATA));
        assert_eq!(read(&format!("{acceleration}{velocity}")).unwrap().len(), 5);
        assert_eq!(read(&format!("{acceleration}\n{velocity}\n")).unwrap().len(), 5);
        let told = read(&format!("{acceleration}{acceleration}")).unwrap_err();
        assert!(told.contains("a second block of acceleration (the first is in line 36)"), "{told}");
        let told = read(&velocity).unwrap_err();
        assert!(told.ends_with("but a record is an acceleration (integer 2 of the header must be 1)"), "{told}");
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        let whole = block(1, 4, DATA);
        let told = |from: &str, to: &str| read(&whole.replace(from, to)).unwrap_err();
        assert_eq!(told("   5  acc", "   6  acc"), "line 36: the header announces 6 values, but the file has 5");
        assert!(told("   5  acc", "   4  acc").starts_with("line 38: `.00100` is no number; it stands past"));
        assert_eq!(
            told("2.50000    .00100", "2.50000 x  .00100"),
            "line 38: `x  .00100` is no number; numbers have to stand in the columns of the format"
        );
        assert_eq!(
            told("12345.6789", "12345.6789 9"),
            "line 37: `9` is no number; it stands past the columns of the format, or past as many values as are announced"
        );
        assert!(
            told("(3F10.5)", "(3X)").contains("line 36: ") && told("(3F10.5)", "(3X)").contains("such as (8F10.5)")
        );
        assert!(told("with 13 text", "with some text").starts_with("line 1: it doesn't say how many text lines"));
        assert!(told("v01.20", "v02.00").starts_with("line 1: format version `02.00`, but 1.20 is read"));
        assert!(told(" 100 Real-header", " 100 Other-header").starts_with("line 16: `100 Other-header"));
        assert!(told("   1 Comment", "   1 Remark").starts_with("line 34: `1 Remark"));
        assert!(
            read(&block(1, 50, DATA))
                .unwrap_err()
                .starts_with("line 15: `unit 50` is no known unit of an acceleration")
        );
        assert!(
            read("Corrected (Format v01.20 with 13 text lines)\n")
                .unwrap_err()
                .contains("no text header of the length")
        );
        assert!(told("10.000000", " 0.000000").contains("the step is 0 s"));
    }
}
