//! The COSMOS Strong Motion Data Format, version 1.20 (COSMOS Strong Motion Programs Board, August
//! 15, 2001).
//!
//! A file is a sequence of blocks. Each has lines of text (the first gives their number), integers,
//! reals, comments, and the values. Each of these parts follows a line with their number and
//! Fortran format, such as
//! `7000  acceleration pts, approx   70 secs, units=cm/sec2(04),Format=(8F10.5)`. Of the headers,
//! integer 2 (the physical quantity, 1 for an acceleration), integer 3 (the unit) and real 62 (the
//! step in ms) are used. If a file has velocities besides an acceleration, the acceleration is
//! read; of several accelerations one must be chosen by its number.

use std::iter::Peekable;
use std::str::Lines;

use crate::error::{RecordError, shown};
use crate::format::Format;
use crate::numbers;
use crate::record::Record;
use crate::units;
use crate::{MOST_VALUES, STANDARD_GRAVITY};

/// Codes of acceleration units in the format's table 2, with their value in m/s².
const ACCELERATION_UNITS: [(i64, f64); 5] =
    [(2, STANDARD_GRAVITY), (4, 0.01), (7, 0.0254), (10, 0.01), (11, STANDARD_GRAVITY / 1000.0)];

/// The remaining lines of a file, with the number of the last one read.
struct CosmosReader<'a> {
    lines: Peekable<Lines<'a>>,
    line: usize,
}

/// One block of the file.
struct CosmosBlock {
    /// Number of the line that announces the values.
    line: usize,
    is_acceleration: bool,
    dt: f64,
    accelerations: Vec<f64>,
    station: String,
    description: String,
}

pub(crate) fn read(text: &str, component: Option<&str>) -> Result<Record, RecordError> {
    let mut reader = CosmosReader { lines: text.lines().peekable(), line: 0 };
    let wanted = component.map(|component| component.trim().parse::<usize>().unwrap_or(0));
    let (mut count, mut found, mut other): (usize, Option<CosmosBlock>, Option<usize>) = (0, None, None);
    while reader.skip_blank_lines() {
        let block = reader.block()?;
        if !block.is_acceleration {
            other = other.or(Some(block.line));
            continue;
        }
        count += 1;
        if let (Some(first), None) = (&found, wanted) {
            let line = block.line;
            let reason = format!(
                "a second acceleration block (the first is in line {}): choose one as a component, by its number",
                first.line
            );
            return Err(RecordError::Header { line, reason });
        }
        if wanted.is_none_or(|wanted| wanted == count) {
            found = Some(block);
        }
    }
    match (found, other) {
        (Some(block), _) => {
            Ok(Record::new("", block.dt, block.accelerations)?.described(&block.station, &block.description))
        }
        (None, _) if count > 0 => {
            let known = (1..=count).map(|k| k.to_string()).collect::<Vec<_>>().join(", ");
            Err(RecordError::Component { component: shown(component.unwrap_or_default()), known })
        }
        (None, Some(line)) => {
            let found = "no acceleration".to_owned();
            Err(RecordError::NotAcceleration { line, found, remedy: " (integer 2 of the header must be 1)" })
        }
        (None, None) => Err(RecordError::Empty),
    }
}

impl<'a> CosmosReader<'a> {
    /// Skips blank lines; whether anything follows.
    fn skip_blank_lines(&mut self) -> bool {
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

    fn block(&mut self) -> Result<CosmosBlock, RecordError> {
        let first = self.next("text header")?;
        let count = self.text_lines(first)?;
        let mut text = vec![first];
        for _ in 1..count {
            text.push(self.next("complete text header (its first line gives more lines)")?);
        }
        let integers = self.numbers("integer")?;
        let at = self.line;
        let reals = self.numbers("real")?;
        self.comments()?;
        let (values, line, announced) = self.values()?;
        let integer = |k: usize| integers.get(k - 1).map(|value| *value as i64);
        let is_acceleration = integer(2) == Some(1);
        let mut block = CosmosBlock {
            line,
            is_acceleration,
            dt: 0.0,
            accelerations: Vec::new(),
            station: text.get(4).map(|line| station(line)).unwrap_or_default(),
            description: text.get(1).map(|line| (*line).to_owned()).unwrap_or_default(),
        };
        if is_acceleration {
            let unit = ACCELERATION_UNITS.iter().find(|(code, _)| integer(3) == Some(*code)).map(|(_, unit)| *unit);
            let Some(unit) = unit else {
                let found = integer(3).map_or_else(String::new, |code| format!("unit {code}"));
                let known = "2 (g), 4 (cm/s^2), 7 (in/s^2), 10 (gal), 11 (mg)";
                return Err(RecordError::Unit { line: at, found, quantity: "acceleration", known });
            };
            if let Some((words, other)) = unit_in_words(announced)
                && other != unit
            {
                let (code, words) = (integer(3).unwrap_or_default(), shown(words));
                let reason = format!(
                    "`units={words}` contradicts integer 3 of the header, which is {code} ({}): correct the one that is wrong",
                    name_of_unit(code)
                );
                return Err(RecordError::Header { line, reason });
            }
            let Some(step) = reals.get(61).copied() else {
                return Err(RecordError::Missing { format: Format::Cosmos, what: "step (real 62)" });
            };
            // Most files have a round step in ms; dividing gives the number nearest to it in s.
            block.dt = step / 1000.0;
            block.accelerations = values.into_iter().map(|value| value * unit).collect();
        }
        Ok(block)
    }

    /// The number of text lines of a block, from `(Format v01.20 with 13 text lines)`.
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
            return self.header(format!("format version `{}` isn't supported, only 1.20", shown(version)));
        }
        let count = behind.split_whitespace().nth(2).and_then(|word| word.parse::<usize>().ok());
        match count.filter(|count| (1..=1000).contains(count)) {
            Some(count) => Ok(count),
            None => self.header("the number of text lines is missing, such as `with 13 text lines`".to_owned()),
        }
    }

    /// Reads a header of numbers; `kind` is the first word after their count.
    fn numbers(&mut self, kind: &'static str) -> Result<Vec<f64>, RecordError> {
        let text = self.next(if kind == "real" { "real-header values" } else { "integer-header values" })?;
        if !text.to_ascii_lowercase().contains(kind) {
            return self.header(format!(
                "`{}`, but expected a line such as `100 {kind}-header values follow on  10 lines, Format= (10I8)`",
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
                "`{}`, but expected a line such as `2 Comment line(s) follow, each starting with a \"|\":`",
                shown(text)
            ));
        }
        for _ in 0..self.count(text)? {
            self.next("complete comments (fewer lines than announced)")?;
        }
        Ok(())
    }

    /// The values of a block, with the number of the line that announces them and its text.
    fn values(&mut self) -> Result<(Vec<f64>, usize, &'a str), RecordError> {
        let text = self.next("data line")?;
        let line = self.line;
        let count = self.count(text)?;
        let values = self.fields(count, text)?;
        // The end-of-data line is optional.
        if self.lines.next_if(|line| line.to_ascii_lowercase().contains("end-of-data")).is_some() {
            self.line += 1;
        }
        Ok((values, line, text))
    }

    /// The number at the beginning of a line.
    fn count(&self, text: &str) -> Result<usize, RecordError> {
        let word = text.split_whitespace().next().unwrap_or_default();
        match word.parse::<usize>() {
            Ok(count) if count <= MOST_VALUES => Ok(count),
            Ok(_) => Err(RecordError::TooMany),
            Err(_) => self.header(format!("`{}`, but the line must begin with a number of values", shown(text))),
        }
    }

    /// Reads `count` numbers in the Fortran format at the end of the line `text`.
    fn fields(&mut self, count: usize, text: &str) -> Result<Vec<f64>, RecordError> {
        let Some((per_line, width)) = fortran(text) else {
            return self.header(format!("`{}` must end with a number format such as (8F10.5)", shown(text)));
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
                let hint = "; numbers must be in the columns of the format";
                let value = numbers::one(field);
                values.push(value.ok_or_else(|| RecordError::Number { line, text: shown(field), hint })?);
                used += 1;
            }
            let rest = text.get(used * width..).unwrap_or_default().trim();
            if !rest.is_empty() {
                let hint = "; it is beyond the columns of the format or the announced number of values";
                return Err(RecordError::Number { line, text: shown(rest), hint });
            }
        }
        Ok(values)
    }
}

/// The unit of an acceleration in a line such as `... units=cm/sec2(04),Format=(8F10.5)`, in m/s²;
/// with its text; `None` if the line has none that is known.
fn unit_in_words(line: &str) -> Option<(&str, f64)> {
    const BEFORE: &str = "units=";
    let start = line.to_ascii_lowercase().find(BEFORE)? + BEFORE.len();
    let unit = line.get(start..)?.split(['(', ',']).next()?.trim();
    let inches = matches!(unit.to_ascii_lowercase().as_str(), "in/sec2" | "in/sec/sec" | "in/s2");
    let scale = if inches { Some(0.0254) } else { units::acceleration(0, unit).ok() };
    Some((unit, scale?))
}

/// A code of [`ACCELERATION_UNITS`] in words.
fn name_of_unit(code: i64) -> &'static str {
    match code {
        2 => "g",
        4 => "cm/s^2",
        7 => "in/s^2",
        10 => "gal",
        _ => "mg",
    }
}

/// Numbers per line and characters per number in a format such as `(8F10.5)` or `(1P,5E15.7)`.
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

/// Number and name of the station from the fifth text line, without the label.
fn station(line: &str) -> String {
    line.trim().trim_start_matches("Statn No:").trim().to_owned()
}

#[cfg(test)]
mod tests {
    use crate::Record;

    /// A block with this quantity, unit, and values with the line that announces them.
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
        let in_g = DATA.replace("cm/sec2(04)", "g (02)");
        assert_eq!(read(&block(1, 2, &in_g)).unwrap().accelerations()[3], 2.5 * 9.80665);
        let message = read(&block(1, 2, DATA)).unwrap_err();
        let expected = "line 36: `units=cm/sec2` contradicts integer 3 of the header, which is 2 (g): correct the one that is wrong";
        assert_eq!(message, expected);
    }

    #[test]
    fn the_acceleration_among_other_blocks_is_taken() {
        let (velocity, acceleration) = (block(2, 5, DATA), block(1, 4, DATA));
        assert_eq!(read(&format!("{acceleration}{velocity}")).unwrap().len(), 5);
        assert_eq!(read(&format!("{acceleration}\n{velocity}\n")).unwrap().len(), 5);
        let message = read(&format!("{acceleration}{acceleration}")).unwrap_err();
        assert!(message.contains("a second acceleration block (the first is in line 36)"), "{message}");
        let other = block(1, 2, &DATA.replace("cm/sec2(04)", "g (02)"));
        let component = |name| {
            let settings = crate::ReadSettings { component: Some(name), ..Default::default() };
            let read = Record::read_with(format!("{acceleration}{velocity}{other}"), "R", &settings);
            read.map(|record| record.accelerations()[3]).map_err(|error| error.to_string())
        };
        assert_eq!((component("1"), component("2")), (Ok(2.5 * 0.01), Ok(2.5 * 9.80665)));
        assert_eq!(component("NS").unwrap_err(), "there is no component `NS`: the file has 1, 2");
        let message = read(&velocity).unwrap_err();
        assert!(message.ends_with("but a record is an acceleration (integer 2 of the header must be 1)"), "{message}");
    }

    #[test]
    fn errors_name_the_line() {
        let whole = block(1, 4, DATA);
        let message = |from: &str, to: &str| read(&whole.replace(from, to)).unwrap_err();
        assert_eq!(message("   5  acc", "   6  acc"), "line 36: the header announces 6 values, but the file has 5");
        assert!(message("   5  acc", "   4  acc").starts_with("line 38: `.00100` is not a number; it is beyond"));
        assert_eq!(
            message("2.50000    .00100", "2.50000 x  .00100"),
            "line 38: `x  .00100` is not a number; numbers must be in the columns of the format"
        );
        assert_eq!(
            message("12345.6789", "12345.6789 9"),
            "line 37: `9` is not a number; it is beyond the columns of the format or the announced number of values"
        );
        assert!(
            message("(3F10.5)", "(3X)").contains("line 36: ")
                && message("(3F10.5)", "(3X)").contains("such as (8F10.5)")
        );
        assert!(message("with 13 text", "with some text").starts_with("line 1: the number of text lines is missing"));
        assert!(message("v01.20", "v02.00").starts_with("line 1: format version `02.00` isn't supported, only 1.20"));
        assert!(message(" 100 Real-header", " 100 Other-header").starts_with("line 16: `100 Other-header"));
        assert!(message("   1 Comment", "   1 Remark").starts_with("line 34: `1 Remark"));
        assert!(
            read(&block(1, 50, DATA))
                .unwrap_err()
                .starts_with("line 15: `unit 50` is not a known unit of acceleration")
        );
        assert!(
            read("Corrected (Format v01.20 with 13 text lines)\n").unwrap_err().contains("no complete text header")
        );
        assert!(message("10.000000", " 0.000000").contains("the step is 0 s"));
    }
}
