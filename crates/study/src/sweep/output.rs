//! The numbers that are wanted of each case.

use super::spec::{Node, Reader, entries};
use serde_json::Value;
use std::borrow::Cow;
use teeter_report::Summary;
use teeter_scenario::scene::Scene;

/// Which row of a column is wanted.
#[derive(Clone, Debug, PartialEq)]
enum Reduction {
    /// The largest value.
    Max,
    /// The smallest value.
    Min,
    /// The largest magnitude.
    MaxAbs,
    /// The last value.
    Final,
    /// The value at a time (s), interpolated linearly between rows.
    At(f64),
}

/// Where an output comes from.
#[derive(Clone, Debug, PartialEq)]
enum Origin {
    /// A value of `summary.json`, by the keys and positions that lead to it.
    Summary(String),
    /// A column of `trajectory.csv`.
    Column { name: String, reduction: Reduction },
    /// Whether any block has overturned.
    Overturned,
    /// The spectral acceleration, for 5 % damping, of a record as used: that of a table of the scene,
    /// such as `ground.motion.x`, or the first.
    Spectral { period: f64, of: Option<String> },
}

/// An output of a study: its name and where it comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    name: String,
    origin: Origin,
}

/// An output that may be off by more than this share of the largest value of its column has too few rows.
const COARSE: f64 = 0.01;

/// What a summary has in words.
const WORDS_OF_SUMMARY: [&str; 6] = ["title", "version", "scheme", "headline", "stopped_by", "ended"];

const WORDS: [&str; 7] = ["max", "min", "max_abs", "final", "at", "spectral_acceleration", "of"];

impl Output {
    /// Its name: the header of its column.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The column of `trajectory.csv` that it needs.
    #[must_use]
    pub fn column(&self) -> Option<&str> {
        match &self.origin {
            Origin::Column { name, .. } => Some(name),
            Origin::Summary(_) | Origin::Spectral { .. } | Origin::Overturned => None,
        }
    }

    /// The time of the row of that column that it is, s, if it is one.
    #[must_use]
    pub fn time(&self) -> Option<f64> {
        match &self.origin {
            Origin::Column { reduction: Reduction::At(t), .. } => Some(*t),
            _ => None,
        }
    }

    /// The place in `summary.json` where it is found.
    #[must_use]
    pub fn summary_path(&self) -> Option<&str> {
        match &self.origin {
            Origin::Summary(path) => Some(path),
            Origin::Column { .. } | Origin::Spectral { .. } | Origin::Overturned => None,
        }
    }

    /// What it is, if it is no number in any case.
    pub(crate) fn word(&self) -> Option<&'static str> {
        match &self.origin {
            Origin::Overturned => Some("true or false"),
            Origin::Summary(path) if WORDS_OF_SUMMARY.contains(&path.as_str()) => Some("a text"),
            Origin::Summary(_) | Origin::Column { .. } | Origin::Spectral { .. } => None,
        }
    }

    /// Whether it is found in the summary of a run.
    pub(crate) fn needs_summary(&self) -> bool {
        matches!(self.origin, Origin::Summary(_) | Origin::Overturned)
    }

    /// The record whose spectral acceleration it is, if it is one; empty for the first.
    #[must_use]
    pub fn spectrum_of(&self) -> Option<&str> {
        match &self.origin {
            Origin::Spectral { of, .. } => Some(of.as_deref().unwrap_or_default()),
            Origin::Summary(_) | Origin::Column { .. } | Origin::Overturned => None,
        }
    }

    /// The natural period of its spectral acceleration, s, if it is one.
    pub(crate) fn period(&self) -> Option<f64> {
        match &self.origin {
            Origin::Spectral { period, .. } => Some(*period),
            Origin::Summary(_) | Origin::Column { .. } | Origin::Overturned => None,
        }
    }

    /// What it takes of a column of `trajectory.csv`, in words: of this symbol of this body.
    pub(crate) fn reduced(&self, symbol: &str, body: &str) -> Option<String> {
        let Origin::Column { reduction, .. } = &self.origin else { return None };
        Some(match reduction {
            Reduction::Max => format!("Largest {symbol} of {body}"),
            Reduction::Min => format!("Least {symbol} of {body}"),
            Reduction::MaxAbs => format!("Largest |{symbol}| of {body}"),
            Reduction::Final => format!("Final {symbol} of {body}"),
            Reduction::At(t) => format!("{symbol} of {body} at t = {t} s"),
        })
    }

    /// A value of the summary under its own path.
    pub(crate) fn summary(path: &str) -> Self {
        Self { name: path.to_owned(), origin: Origin::Summary(path.to_owned()) }
    }

    /// The value of a column at a time, s.
    pub(crate) fn at(name: String, column: &str, t: f64) -> Self {
        Self { name, origin: Origin::Column { name: column.to_owned(), reduction: Reduction::At(t) } }
    }

    /// Reads `name = "path.in.summary"` or `name = { max = "column" }`.
    pub(crate) fn read(reader: &mut Reader<'_>, name: &str, node: &Node<'_, '_>) -> Option<Self> {
        let path = format!("outputs.{name}");
        let example = "write the path of a number in summary.json, such as \"energy.largest_residual\", or a column of \
            trajectory.csv as { max = \"block.phi\" }, min, max_abs, final, or { at = \"0.5 s\", of = \"block.phi\" }, \
            or { spectral_acceleration = \"0.5 s\" } of the record at this period, or \"overturned\" for yes or no";
        if node.text() == Some("overturned") {
            return Some(Self { name: name.to_owned(), origin: Origin::Overturned });
        }
        if let Some(place) = node.text() {
            return Some(Self { name: name.to_owned(), origin: Origin::Summary(place.to_owned()) });
        }
        let Some(table) = node.table() else {
            reader.wrong(&path, Some(node), "not an output", example);
            return None;
        };
        let mut texts = Vec::new();
        for (word, value) in entries(table) {
            let inner = format!("{path}.{word}");
            match value.text() {
                _ if !WORDS.contains(&word) => {
                    reader.unknown(&inner, &value, word, &WORDS);
                    return None;
                }
                Some(text) => texts.push((word, text, value)),
                None => {
                    reader.wrong(&inner, Some(&value), "a text is expected", example);
                    return None;
                }
            }
        }
        let (column, reduction) = match texts.as_slice() {
            [("max", column, _)] => (*column, Reduction::Max),
            [("min", column, _)] => (*column, Reduction::Min),
            [("max_abs", column, _)] => (*column, Reduction::MaxAbs),
            [("final", column, _)] => (*column, Reduction::Final),
            [("at", time, value), ("of", column, _)] | [("of", column, _), ("at", time, value)] => {
                (*column, Reduction::At(time_of(reader, &format!("{path}.at"), time, value)?))
            }
            [("spectral_acceleration", period, value), rest @ ..]
            | [rest @ .., ("spectral_acceleration", period, value)]
                if matches!(rest, [] | [("of", ..)]) =>
            {
                let key = format!("{path}.spectral_acceleration");
                let period = time_of(reader, &key, period, value)?;
                if period <= 0.0 {
                    reader.wrong(&key, Some(value), "not a period", "give a period above 0, such as \"0.5 s\"");
                    return None;
                }
                let of = rest.first().map(|(_, record, _)| (*record).to_owned());
                return Some(Self { name: name.to_owned(), origin: Origin::Spectral { period, of } });
            }
            _ => {
                reader.wrong(
                    &path,
                    Some(node),
                    "one of max, min, max_abs, final, spectral_acceleration is expected, or at with of",
                    example,
                );
                return None;
            }
        };
        Some(Self { name: name.to_owned(), origin: Origin::Column { name: column.to_owned(), reduction } })
    }

    /// Whether it depends on what the motion does between rows.
    #[must_use]
    pub fn is_between_rows(&self) -> bool {
        matches!(&self.origin, Origin::Column { reduction, .. } if *reduction != Reduction::Final)
    }

    /// Whether rows are too far apart for it: what its interpolation between two rows, or a peak between rows, may be off by.
    pub(crate) fn is_coarse(&self, columns: &Columns) -> bool {
        let Origin::Column { name, reduction } = &self.origin else { return false };
        columns.may_be_off(name, reduction).is_some_and(|(off, scale)| off > COARSE * scale)
    }

    /// The text of its cell: empty where there is no such value.
    pub(crate) fn cell(&self, summary: Option<&Summary>, columns: &Columns, scene: &Scene) -> String {
        match &self.origin {
            Origin::Spectral { period, of } => {
                let mut records = scene.records();
                let record = records.find(|record| of.as_ref().is_none_or(|path| *path == record.path));
                let value = record.and_then(|record| record.spectral_acceleration(*period));
                value.map(|value| format!("{value:?}")).unwrap_or_default()
            }
            Origin::Summary(path) => {
                let (key, rest) = path.split_once('.').map_or((path.as_str(), None), |(key, rest)| (key, Some(rest)));
                let Some(value) = summary.and_then(|summary| summary.value(key)) else { return String::new() };
                let found = rest.map_or(Some(Cow::Borrowed(&value)), |rest| at_path(&value, rest));
                found.map(text_of).unwrap_or_default()
            }
            Origin::Overturned => {
                let overturned = |summary: &Summary| summary.value("overturned_at").is_some_and(|at| !at.is_null());
                summary.map(|summary| overturned(summary).to_string()).unwrap_or_default()
            }
            Origin::Column { name, reduction } => {
                columns.reduced(name, reduction).map(|value| format!("{value:?}")).unwrap_or_default()
            }
        }
    }
}

/// A time from 0 on.
fn time_of(reader: &mut Reader<'_>, path: &str, text: &str, value: &Node<'_, '_>) -> Option<f64> {
    match teeter_scenario::quantity::parse(text, teeter_scenario::dimension::Dimension::TIME) {
        Ok(time) if time >= 0.0 => return Some(time),
        Ok(_) => reader.wrong(path, Some(value), "before the start", "give a time from 0 on"),
        Err(error) => {
            reader.wrong(path, Some(value), &error.to_string(), "give a time with its unit, such as \"0.5 s\"");
        }
    }
    None
}

/// The value at `energy.initial`, `peaks.0.phi` or `peaks.-1.phi`, the last of an array; `peaks.len`
/// is the length of an array.
fn at_path<'v>(value: &'v Value, path: &str) -> Option<Cow<'v, Value>> {
    let mut now = value;
    for part in path.split('.') {
        now = match now {
            Value::Object(map) => map.get(part)?,
            Value::Array(items) if part == "len" => return Some(Cow::Owned(Value::from(items.len()))),
            Value::Array(items) => match part.strip_prefix('-') {
                Some(back) => items.get(items.len().checked_sub(back.parse().ok()?)?)?,
                None => items.get(part.parse::<usize>().ok()?)?,
            },
            _ => return None,
        };
    }
    Some(Cow::Borrowed(now))
}

fn text_of(value: Cow<'_, Value>) -> String {
    match value.as_ref() {
        Value::Null => String::new(),
        Value::String(text) => quoted(text),
        Value::Number(number) => {
            number.as_f64().filter(|_| number.is_f64()).map_or_else(|| number.to_string(), |x| format!("{x:?}"))
        }
        other => quoted(&other.to_string()),
    }
}

/// A text as a cell of a table, in one line.
pub(crate) fn quoted(text: &str) -> String {
    crate::write::quoted(&one_line(text))
}

/// A text in one line.
pub(crate) fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// Columns of a trajectory, by the names that are wanted.
#[derive(Debug, Default)]
pub(crate) struct Columns {
    names: Vec<String>,
    times: Vec<f64>,
    values: Vec<Vec<f64>>,
}

impl Columns {
    /// Reads those of the names from the text of a table that it has, and the times.
    pub(crate) fn read(header: &str, rows: &str, wanted: &[&str]) -> Self {
        let header: Vec<&str> = header.trim_end().split(',').collect();
        let mut found = Self::default();
        let mut places = Vec::new();
        for name in wanted {
            if let Some(place) = header.iter().position(|column| column == name)
                && !found.names.iter().any(|known| known == name)
            {
                found.names.push((*name).to_owned());
                found.values.push(Vec::new());
                places.push(place);
            }
        }
        for line in rows.lines() {
            let cells: Vec<&str> = line.split(',').collect();
            let number = |place: usize| cells.get(place).and_then(|cell| cell.parse().ok()).unwrap_or(f64::NAN);
            found.times.push(number(0));
            for (values, place) in found.values.iter_mut().zip(&places) {
                values.push(number(*place));
            }
        }
        found
    }

    fn reduced(&self, name: &str, reduction: &Reduction) -> Option<f64> {
        let place = self.names.iter().position(|known| known == name)?;
        let values = self.values.get(place)?;
        match reduction {
            Reduction::Max => values.iter().copied().reduce(f64::max),
            Reduction::Min => values.iter().copied().reduce(f64::min),
            Reduction::MaxAbs => values.iter().map(|x| x.abs()).reduce(f64::max),
            Reduction::Final => values.last().copied(),
            Reduction::At(time) => self.interpolated(values, *time),
        }
    }

    /// Number of rows.
    pub(crate) fn rows(&self) -> usize {
        self.times.len()
    }

    /// How much a value may be off as its column is known in rows only, by the curvature of the rows about it, and the largest magnitude of the
    /// column.
    fn may_be_off(&self, name: &str, reduction: &Reduction) -> Option<(f64, f64)> {
        let place = self.names.iter().position(|known| known == name)?;
        let values = self.values.get(place)?;
        let scale = values.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        // Half of the second derivative at a row between two others.
        let bend = |row: usize| {
            let (a, b, c) = (row.checked_sub(1)?, row, row + 1);
            let slope = |from: usize, to: usize| -> Option<f64> {
                Some((values.get(to)? - values.get(from)?) / (self.times.get(to)? - self.times.get(from)?))
            };
            Some((slope(b, c)? - slope(a, b)?) / (self.times.get(c)? - self.times.get(a)?))
        };
        let off = match reduction {
            Reduction::Final => 0.0,
            Reduction::At(time) => {
                let after = self.times.partition_point(|t| *t < *time);
                let (before, t) = (after.checked_sub(1)?, *self.times.get(after)?);
                let largest = [before, after].into_iter().filter_map(bend).fold(0.0, |most: f64, x| most.max(x.abs()));
                largest * (time - self.times[before]) * (t - time)
            }
            Reduction::Max | Reduction::Min | Reduction::MaxAbs => {
                let height = |row: &usize| match reduction {
                    Reduction::Min => -values[*row],
                    Reduction::MaxAbs => values[*row].abs(),
                    _ => values[*row],
                };
                let top = (0..values.len()).max_by(|a, b| height(a).total_cmp(&height(b)))?;
                let (before, after) = (top.checked_sub(1)?, top + 1);
                let width = self.times.get(after)? - self.times[before];
                // The vertex of a parabola is at most half a distance of rows from its highest row.
                bend(top)?.abs() * (0.25 * width).powi(2)
            }
        };
        Some((off, scale))
    }

    /// `None` outside the times of the table.
    fn interpolated(&self, values: &[f64], time: f64) -> Option<f64> {
        let after = self.times.partition_point(|t| *t < time);
        let (t, x) = (*self.times.get(after)?, *values.get(after)?);
        if t == time {
            return Some(x);
        }
        let before = after.checked_sub(1)?;
        let (t0, x0) = (self.times[before], values[before]);
        Some(x0 + (x - x0) * ((time - t0) / (t - t0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_found_by_their_path() {
        let summary = serde_json::json!({
            "t": 1.0, "steps": 100, "ended": "complete", "horizon": null,
            "peaks": [{ "phi": 0.1 }, { "phi": -0.05 }], "energy": { "initial": 1e-20 },
        });
        let cell = |path: &str| at_path(&summary, path).map(text_of).unwrap_or_default();
        let cells = ["t", "steps", "ended", "horizon", "peaks.0.phi", "peaks.-1.phi", "peaks.len", "energy.initial"];
        assert_eq!(cells.map(cell), ["1.0", "100", "complete", "", "0.1", "-0.05", "2", "1e-20"]);
        assert_eq!(["peaks.2.phi", "peaks.-3.phi", "energy.none", "t.t"].map(cell), ["", "", "", ""]);
    }

    #[test]
    fn columns_are_reduced_to_a_number() {
        let columns = Columns::read("t,b.phi,b.x\n", "0.0,1.0,5\n0.5,-3.0,6\n1.0,2.0,7\n", &["b.phi", "none"]);
        let value = |reduction| columns.reduced("b.phi", &reduction);
        assert_eq!(value(Reduction::Max), Some(2.0));
        assert_eq!(value(Reduction::Min), Some(-3.0));
        assert_eq!(value(Reduction::MaxAbs), Some(3.0));
        assert_eq!(value(Reduction::Final), Some(2.0));
        assert_eq!(value(Reduction::At(0.5)), Some(-3.0));
        assert_eq!(value(Reduction::At(0.75)), Some(-0.5));
        assert_eq!(value(Reduction::At(1.25)), None);
        assert_eq!(columns.reduced("none", &Reduction::Max), None);
    }

    #[test]
    fn rows_that_are_too_far_apart_for_an_output_are_known() {
        let coarse = |distance: f64, reduction: Reduction| {
            let row = |k: u32| {
                let t = distance * f64::from(k);
                format!("{t:?},{:?}\n", (t + 0.3).sin())
            };
            let rows: String = (0..=(6.0 / distance) as u32).map(row).collect();
            let columns = Columns::read("t,b.phi\n", &rows, &["b.phi"]);
            let origin = Origin::Column { name: "b.phi".to_owned(), reduction };
            Output { name: "o".to_owned(), origin }.is_coarse(&columns)
        };
        // Linear between rows a sine is off by up to d²/8: more than 1 % beyond d = 0.28.
        for (distance, is_coarse) in [(0.05, false), (0.2, false), (0.4, true)] {
            for reduction in [Reduction::Max, Reduction::Min, Reduction::MaxAbs] {
                assert_eq!(coarse(distance, reduction.clone()), is_coarse, "{distance} {reduction:?}");
            }
            // In the middle between two rows near the top.
            let middle = ((1.25 / distance).floor() + 0.5) * distance;
            assert_eq!(coarse(distance, Reduction::At(middle)), is_coarse, "{distance}");
            assert!(!coarse(distance, Reduction::At(distance)) && !coarse(distance, Reduction::Final));
        }
    }

    #[test]
    fn a_text_stays_in_its_cell() {
        assert_eq!(quoted("a, \"b\"\nc"), "\"a, \"\"b\"\" c\"");
        assert_eq!(quoted("plain"), "plain");
    }
}
