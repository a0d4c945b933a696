//! The columns of a table of measured motion: which holds what, in which unit.

use super::layout::{ColumnLayout, ColumnSpec, NAMES};
use super::read::MeasuredError;
use super::table::{TextTable, is_not_a_number, number};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use teeter_scenario::diagnostic::printable;
use teeter_scenario::dimension::Dimension;
use teeter_scenario::quantity::{self, QuantityError};
use teeter_scenario::suggest::nearest;

/// The largest number accepted, as for keys of a scene.
const LARGEST: f64 = 1e15;

/// The columns of a table.
pub(super) struct Columns<'a> {
    pub(super) table: &'a TextTable,
    /// Titles and units of the heading.
    pub(super) names: Vec<(String, Option<String>)>,
    /// The columns that were read, each with what it holds.
    read: RefCell<BTreeMap<usize, String>>,
    /// Of these, what has no unit in the heading nor a given one.
    pub(super) without_unit: RefCell<BTreeSet<String>>,
}

impl<'a> Columns<'a> {
    /// Those of a table, of which none has been read.
    pub(super) fn new(table: &'a TextTable) -> Self {
        Self { table, names: names(table), read: RefCell::default(), without_unit: RefCell::default() }
    }

    pub(super) fn count(&self) -> usize {
        self.table.rows.first().map_or(0, |(_, cells)| cells.len())
    }

    /// The column of a quantity if it is given or has its name.
    pub(super) fn wanted(&self, layout: &ColumnLayout, name: &str, block: &str) -> Option<ColumnSpec> {
        let given = layout.columns.get(name).cloned().unwrap_or_default();
        if given.column.is_some() {
            return Some(given);
        }
        let names = match name {
            "t" => vec!["t".to_owned(), "time".to_owned()],
            "phi" => vec![format!("{block}.phi"), "phi".to_owned(), "φ".to_owned()],
            name => vec![format!("{block}.{name}"), name.to_owned()],
        };
        let found = names.into_iter().find(|name| self.place(name).is_some())?;
        Some(ColumnSpec { column: Some(found), unit: given.unit })
    }

    fn place(&self, column: &str) -> Option<usize> {
        let number = || column.trim().parse::<usize>().ok().and_then(|number| number.checked_sub(1));
        self.alike(column).first().copied().or_else(|| number().filter(|place| *place < self.count()))
    }

    /// The columns with this heading: as it stands there, with its unit, or by its title alone. In another unit a column holds
    /// the same once more.
    fn alike(&self, column: &str) -> Vec<usize> {
        let wanted = column.trim().to_lowercase();
        let headings = self.table.heading.iter().flat_map(|(_, cells)| cells);
        let whole: Vec<usize> =
            headings.enumerate().filter(|(_, cell)| cell.to_lowercase() == wanted).map(|(place, _)| place).collect();
        if !whole.is_empty() {
            return whole;
        }
        let titles = || self.names.iter().enumerate().filter(|(_, (name, _))| name.to_lowercase() == wanted);
        let unit = titles().next().map(|(_, (_, unit))| unit);
        titles().filter(|(_, (_, other))| Some(other) == unit).map(|(place, _)| place).collect()
    }

    /// The values of a column in SI units; NaN for empty cells.
    pub(super) fn read(&self, spec: &ColumnSpec, what: &str, dimension: Dimension) -> Result<Vec<f64>, MeasuredError> {
        let name = spec.column.as_deref().unwrap_or(what);
        let Some(place) = self.place(name) else { return Err(self.missing(name, what)) };
        let alike = self.alike(name);
        if alike.len() > 1 {
            let numbers: Vec<String> = alike.iter().map(|place| (place + 1).to_string()).collect();
            return Err(MeasuredError::Columns(format!(
                "{} columns are headed `{}`, {}: name one by its number, such as --column {what}={}",
                alike.len(),
                printable(name),
                numbers.join(" and "),
                numbers[0]
            )));
        }
        if let Some((line, cells)) = self.table.heading.as_ref().filter(|(_, cells)| cells.len() != self.count()) {
            return Err(MeasuredError::line(
                *line,
                format!("{} headings, but the rows have {} columns", cells.len(), self.count()),
            ));
        }
        let heading = self.names.get(place).and_then(|(_, unit)| unit.as_deref());
        // A unit with a number is the size of one, such as that of a pixel.
        let factor = |unit: &str| match unit.starts_with(|c: char| c.is_ascii_digit()) {
            true => quantity::parse(unit, dimension),
            false => quantity::parse(&format!("1 {unit}"), dimension),
        };
        if let Some(other) = self.read.borrow().get(&place) {
            let heading = self.table.heading.as_ref().and_then(|(_, cells)| cells.get(place));
            let headed = heading.map(|cell| format!(" (`{}`)", printable(cell))).unwrap_or_default();
            return Err(MeasuredError::Columns(format!(
                "column {}{headed} is read both as {other} and as {what}: give each its own column",
                place + 1
            )));
        }
        let contradicts = |given: &str, heading: &str| match (factor(given), factor(heading)) {
            (Ok(by_spec), Ok(by_heading)) => (by_spec - by_heading).abs() > 1e-12 * by_heading.abs(),
            // What stands in brackets may be no unit, as in `Angle (left)`; a unit of something else is one.
            (Ok(_), Err(QuantityError::WrongDimension { .. } | QuantityError::AngularFrequency { .. })) => true,
            _ => false,
        };
        if let (Some(given), Some(heading)) = (spec.unit.as_deref(), heading)
            && contradicts(given, heading)
        {
            return Err(MeasuredError::Columns(format!(
                "the unit `{}` of {what} contradicts its heading, which says `{}`: leave the unit out, or correct the heading",
                printable(given),
                printable(heading)
            )));
        }
        let scale = match spec.unit.as_deref().or(heading) {
            None => 1.0,
            Some(unit) => factor(unit).map_err(|error| {
                let told = match pixels(unit, dimension) {
                    Some(size) if what.starts_with("marker.") => {
                        format!("{error}; give the length of a pixel instead, such as unit = \"{size}\"")
                    }
                    Some(size) => {
                        format!("{error}; give the length of a pixel instead, such as --unit {what}=\"{size}\"")
                    }
                    None => error.with_remedy(),
                };
                MeasuredError::Columns(format!("the unit `{}` of {what}: {told}", printable(unit)))
            })?,
        };
        if let Some(unit) = spec.unit.as_deref().or(heading)
            && !(scale > 0.0)
        {
            let unit = printable(unit);
            return Err(MeasuredError::Columns(format!(
                "the unit `{unit}` of {what} has no size: it must be positive"
            )));
        }
        self.read.borrow_mut().insert(place, what.to_owned());
        if spec.unit.as_deref().or(heading).is_none() && dimension != Dimension::NONE {
            self.without_unit.borrow_mut().insert(what.to_owned());
        }
        let mut values = Vec::with_capacity(self.table.rows.len());
        for (line, cells) in &self.table.rows {
            let cell = cells[place].as_str();
            if cell.is_empty() {
                values.push(f64::NAN);
                continue;
            }
            let wrong = |why: &str| {
                MeasuredError::line(*line, format!("`{}` in column {} ({what}) {why}", printable(cell), place + 1))
            };
            if is_not_a_number(cell) {
                return Err(wrong("is not a number; leave the cell of a lost frame empty"));
            }
            let value = number(cell, self.table.decimal_comma).ok_or_else(|| wrong("is not a number"))? * scale;
            if !(value.abs() <= LARGEST) {
                return Err(wrong(&format!("is beyond {LARGEST:e}, the limit of numbers")));
            }
            values.push(value);
        }
        Ok(values)
    }

    /// The headings of what was not read, without those of other bodies and beams, as in `trajectory.csv`.
    pub(super) fn unread(&self) -> Vec<String> {
        let read = self.read.borrow();
        let of_another = |cell: &str| cell.split_once('.').is_some_and(|(name, _)| !name.is_empty());
        let headings = self.table.heading.iter().flat_map(|(_, cells)| cells).enumerate();
        headings
            // A comma at the end of the heading makes no column.
            .filter(|(place, cell)| !read.contains_key(place) && !of_another(cell) && !cell.trim().is_empty())
            .map(|(_, cell)| cell.clone())
            .collect()
    }

    /// The text in a row of the column that was read as this quantity, and the number of the column from 1.
    pub(super) fn cell_of(&self, what: &str, row: usize) -> Option<(&str, usize)> {
        let place = self.read.borrow().iter().find(|(_, read)| *read == what).map(|(place, _)| *place)?;
        Some((self.table.rows.get(row)?.1.get(place)?.as_str(), place + 1))
    }

    pub(super) fn missing(&self, name: &str, what: &str) -> MeasuredError {
        let titles = self.names.iter().map(|(name, _)| name.as_str());
        let near = nearest(name, titles.clone())
            .map(|near| format!("; did you mean `{}`?", printable(near)))
            .unwrap_or_default();
        let there: Vec<String> = titles.map(|name| format!("`{}`", printable(name))).collect();
        let there = match there.as_slice() {
            [] => format!("it has {} columns without headings", self.count()),
            there => format!("it has {}", there.join(", ")),
        };
        MeasuredError::Columns(format!("no column `{}` for {what}: {there}{near}", printable(name)))
    }

    /// A hint at the first column whose heading speaks of time.
    fn named_time(&self) -> String {
        let is_time =
            |name: &&str| name.to_lowercase().split(|c: char| !c.is_alphanumeric()).any(|word| word == "time");
        let name = self.names.iter().map(|(name, _)| name.as_str()).find(is_time);
        name.map(|name| format!("; if `{0}` has them, --column t=\"{0}\"", printable(name))).unwrap_or_default()
    }

    /// Refuses to take rows as equally spaced where a column counts frames and skips some.
    fn refuse_lost_frames(&self) -> Result<(), MeasuredError> {
        let counts = |name: &str| {
            let mut words = name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
            words
                .next()
                .is_some_and(|word| ["frame", "frames", "sample", "index"].contains(&word.to_lowercase().as_str()))
        };
        let Some(place) = self.names.iter().position(|(name, _)| counts(name)) else { return Ok(()) };
        let value = |(line, cells): &(usize, Vec<String>)| {
            Some((*line, number(cells.get(place)?, self.table.decimal_comma).filter(|value| value.fract() == 0.0)?))
        };
        let frames: Option<Vec<(usize, f64)>> = self.table.rows.iter().map(value).collect();
        let Some(frames) = frames else { return Ok(()) };
        let strides = || frames.windows(2).map(|pair| pair[1].1 - pair[0].1);
        let least = strides().fold(f64::INFINITY, f64::min);
        // Every tenth frame is as regular as every one.
        let Some(lost) = strides().position(|stride| stride > least).filter(|_| least > 0.0) else { return Ok(()) };
        let name = printable(&self.names[place].0);
        Err(MeasuredError::line(
            frames[lost + 1].0,
            format!(
                "the column `{name}` goes from {} to {}, elsewhere by {least}, so that rows aren't equally spaced: count by it, --column \
                 t=\"{name}\", with the rate of its frames",
                frames[lost].1,
                frames[lost + 1].1
            ),
        ))
    }

    pub(super) fn times(&self, layout: &ColumnLayout, block: &str) -> Result<Vec<f64>, MeasuredError> {
        let spec = self.wanted(layout, "t", block);
        if layout.rate.is_some() && layout.columns.get("t").is_some_and(|given| given.unit.is_some()) {
            return Err(MeasuredError::Columns(
                "with a rate the rows or frames are counted, which have no unit: leave out the unit of t, or the rate"
                    .to_owned(),
            ));
        }
        let times = match (layout.rate, spec) {
            (Some(rate), None) => {
                self.refuse_lost_frames()?;
                (0..self.table.rows.len()).map(|row| row as f64 / rate).collect()
            }
            // With a rate, a column of times counts frames.
            (Some(rate), Some(spec)) if layout.columns.contains_key("t") => {
                let frames = self.read(&ColumnSpec { unit: None, ..spec }, "t", Dimension::NONE)?;
                frames.into_iter().map(|frame| frame / rate).collect()
            }
            (Some(_), Some(_)) => {
                return Err(MeasuredError::Columns(
                    "the table has a column of times, so it needs no rate; if the column counts frames, name it: --column t=1"
                        .to_owned(),
                ));
            }
            (None, Some(spec)) => self.read(&spec, "t", Dimension::TIME)?,
            (None, None) => {
                let names = NAMES[1..].join(", ");
                return Err(match self.names.is_empty() {
                    true => MeasuredError::Columns(format!(
                        "the table has {} columns without headings: say which is which, such as --column t=1 --column phi=2 \
                         (or {names}); for rows at a constant rate, --rate \"165 Hz\"",
                        self.count()
                    )),
                    false => MeasuredError::Columns(format!(
                        "{}{}; for rows at a constant rate, give --rate \"165 Hz\"",
                        self.missing("t", "times"),
                        self.named_time()
                    )),
                });
            }
        };
        if let Some(row) = times.iter().position(|t| t.is_nan()) {
            return Err(MeasuredError::line(self.table.rows[row].0, "no time"));
        }
        if let Some(row) = times.windows(2).position(|t| !(t[1] > t[0])) {
            return Err(MeasuredError::line(
                self.table.rows[row + 1].0,
                format!("t = {} s is not after the row before, t = {} s", times[row + 1], times[row]),
            ));
        }
        Ok(times)
    }
}

/// What a unit of pixels could be instead, if that can be the unit of a quantity of this dimension.
fn pixels(unit: &str, dimension: Dimension) -> Option<&'static str> {
    let unit = unit.to_lowercase();
    let is_pixel = |unit: &str| matches!(unit, "px" | "pix" | "pixel" | "pixels");
    match dimension {
        Dimension::LENGTH if is_pixel(&unit) => Some("0.21 mm"),
        Dimension::VELOCITY if unit.strip_suffix("/s").is_some_and(|unit| is_pixel(unit.trim_end())) => {
            Some("0.21 mm/s")
        }
        _ => None,
    }
}

/// Titles and units of the heading.
fn names(table: &TextTable) -> Vec<(String, Option<String>)> {
    let one = |cell: &String| {
        let (open, close) = if cell.ends_with(']') { ('[', ']') } else { ('(', ')') };
        match cell.strip_suffix(close).and_then(|inner| inner.rsplit_once(open)) {
            Some((title, unit)) => (title.trim().to_owned(), Some(unit.trim().to_owned())),
            None => (cell.clone(), None),
        }
    };
    table.heading.iter().flat_map(|(_, cells)| cells.iter().map(one)).collect()
}
