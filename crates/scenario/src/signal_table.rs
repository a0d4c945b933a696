//! Files of signals: time and value, or values at equal steps.

use crate::dimension::Dimension;
use crate::number_table::{NumberColumns, columns, two_columns};
use teeter_integrator::{SignalError, Table};

/// Shortest time between two rows, s, as for keys that are times.
const SHORTEST: f64 = 1e-15;

/// The columns of a signal's table. Its value is multiplied by an amplitude, which has the unit.
const SIGNAL: &[Dimension] = &[Dimension::TIME, Dimension::NONE];

/// Reads a table of two columns, t and value, with `start` (s) added to its times. The columns are the
/// only two, or those named by their headings or numbers; `time_unit` is the unit of times, and how many
/// make a second, if the heading has none.
///
/// # Errors
/// What is wrong, with the line.
pub(crate) fn of_columns(
    bytes: &[u8],
    start: f64,
    names: Option<[&str; 2]>,
    time_unit: Option<(&str, f64)>,
) -> Result<Table, String> {
    let found = match (names, time_unit) {
        (None, None) => columns(bytes, 2..=2, "two, t and value", SIGNAL)?,
        _ => two_columns(bytes, names, ("two, t and value", SIGNAL), time_unit, 1)?,
    };
    let [mut times, values] = <[Vec<f64>; 2]>::try_from(found.columns).unwrap_or_default();
    times.iter_mut().for_each(|t| *t += start);
    made(times, values, &found.lines)
}

/// Reads a table of one column, values `step` (s) apart, the first of them at `start` (s).
///
/// # Errors
/// What is wrong, with the line.
pub(crate) fn of_values(bytes: &[u8], start: f64, step: f64) -> Result<Table, String> {
    let decimal = std::str::from_utf8(bytes).ok().filter(|text| teeter_record::has_decimal_commas(text));
    // The heading of one column has no comma that matters.
    let points = decimal.map(|text| text.replace(',', "."));
    let bytes = points.as_deref().map_or(bytes, str::as_bytes);
    let expected = "one, values, with step (whose decimals have points if what stands before the commas ascends)";
    let NumberColumns { columns, lines } = columns(bytes, 1..=1, expected, &[Dimension::NONE])?;
    let values = columns.into_iter().next().unwrap_or_default();
    let times = (0..values.len()).map(|k| start + step * k as f64).collect();
    made(times, values, &lines)
}

fn made(times: Vec<f64>, values: Vec<f64>, lines: &[u64]) -> Result<Table, String> {
    // Keys accept no shorter times, and rates over them would exceed the range of numbers.
    if let Some(row) = times.windows(2).position(|t| t[1] > t[0] && t[1] - t[0] < SHORTEST) {
        let line = lines.get(row + 1).copied().unwrap_or_default();
        return Err(format!(
            "line {line}: {:e} s after the row before, below {SHORTEST:e} s, the limit of times",
            times[row + 1] - times[row]
        ));
    }
    Table::new(times, values).map_err(|error| match error {
        SignalError::Row { row, what } => {
            let line = row.checked_sub(1).and_then(|row| lines.get(row)).copied().unwrap_or_default();
            format!("line {line}: {what}")
        }
        SignalError::Rows(rows) => {
            format!("it has {rows} row{} of numbers, but a table needs two or more", if rows == 1 { "" } else { "s" })
        }
        error => error.to_string(),
    })
}
