//! Plain tables: time and acceleration, or acceleration alone.

use crate::decimal::has_decimal_commas;
use crate::error::{RecordError, shown};
use crate::record::{ReadSettings, Record};
use crate::{LARGEST_ACCELERATION, MOST_VALUES, numbers, units};

/// The separator of the columns.
#[derive(Clone, Copy, PartialEq)]
enum Separator {
    /// Numbers may have a decimal comma.
    Semicolon,
    Comma,
    Blanks,
}

/// The rows read so far. For a table with times, also the times and the resolution in s to which
/// they are written.
#[derive(Default)]
struct TableRows {
    lines: Vec<usize>,
    times: Vec<f64>,
    accelerations: Vec<f64>,
    resolution: f64,
}

/// Largest deviation of a time from a uniform one, as a fraction of the step, however few digits it
/// has.
const LARGEST_DEVIATION: f64 = 0.05;

const EXPECTED_COLUMNS: &str =
    "a table has time and acceleration, or acceleration alone, with equally many columns in each row";

const EQUAL_COLUMNS: &str = "the rows before have a different number";

/// Whether a row begins with a number, so isn't a heading.
pub(crate) fn begins_with_number(row: &str) -> bool {
    let cell = row.split([',', ';']).next().unwrap_or_default();
    cell.split_whitespace().next().is_some_and(|cell| numbers::one(cell).is_some())
}

/// Where time and acceleration are in a row.
#[derive(Clone, Copy)]
struct TableLayout {
    separator: Separator,
    /// Number of columns.
    columns: usize,
    /// Whether the first column is the time.
    timed: bool,
    /// The column of the acceleration.
    acceleration: usize,
    /// The units of time and acceleration, in s and m/s².
    scales: [f64; 2],
    /// Whether that of the acceleration is known, by the heading or by what is given.
    has_unit: bool,
}

pub(crate) fn read(text: &str, settings: &ReadSettings<'_>) -> Result<Record, RecordError> {
    let mut rows = TableRows { resolution: f64::INFINITY, ..TableRows::default() };
    let mut heading: Option<(usize, &str)> = None;
    // With a step there may be one column.
    let decimal = settings.step.is_some() && settings.component.is_none() && has_decimal_commas(text);
    let mut layout: Option<TableLayout> = None;
    let whole = text;
    for (index, text) in text.lines().enumerate() {
        let (line, text) = (index + 1, text.split('#').next().unwrap_or_default().trim());
        if text.is_empty() {
            continue;
        }
        if layout.is_none() && heading.is_none() && !begins_with_number(text) {
            heading = Some((line, text));
            continue;
        }
        let layout = match layout {
            Some(layout) => layout,
            None => *layout.insert(layout_of(line, text, whole, decimal, heading, settings)?),
        };
        rows.take(line, &cells(text, layout.separator), &layout)?;
    }
    let Some(layout) = layout else { return Err(RecordError::TooFew(0)) };
    if rows.accelerations.len() < 2 {
        return Err(RecordError::TooFew(rows.accelerations.len()));
    }
    let step = match (layout.timed, settings.step) {
        (false, None) => return Err(RecordError::StepNeeded),
        (false, Some(step)) => step,
        (true, given) => {
            let step = rows.step()?;
            if given.is_some() {
                return Err(RecordError::StepTwice { format: crate::Format::Table, step });
            }
            step
        }
    };
    let record = Record::new("", step, rows.accelerations)?;
    Ok(if layout.has_unit { record } else { record.assuming_its_unit() })
}

/// Whether the numbers of a table without a heading follow each other along the lines: the last of a
/// line is nearer to the first of the next than that is to the first before it, by far and on
/// average. Columns of a table don't do this, whether the first has times or not.
fn follows_along_lines(text: &str, separator: Separator) -> bool {
    /// Along the lines values are one step apart, along a column at least three.
    const NEARER: f64 = 0.5;
    let rows =
        text.lines().map(|text| text.split('#').next().unwrap_or_default().trim()).filter(|text| !text.is_empty());
    let (mut along, mut below) = (0.0, 0.0);
    let mut before: Option<[f64; 2]> = None;
    for row in rows {
        let cells = cells(row, separator);
        let ends = [cells.first(), cells.last()].map(|cell| cell.and_then(|cell| numbers::one(cell)));
        let [Some(first), Some(last)] = ends else { return false };
        if let Some([first_before, last_before]) = before {
            along += f64::abs(first - last_before);
            below += f64::abs(first - first_before);
        }
        before = Some([first, last]);
    }
    along < NEARER * below
}

/// The layout of the rows, from the first of them, the whole file and the heading.
fn layout_of(
    line: usize,
    row: &str,
    whole: &str,
    decimal: bool,
    heading: Option<(usize, &str)>,
    settings: &ReadSettings<'_>,
) -> Result<TableLayout, RecordError> {
    let separator = match row {
        row if row.contains(';') || decimal => Separator::Semicolon,
        row if row.contains(',') => Separator::Comma,
        _ => Separator::Blanks,
    };
    let columns = cells(row, separator).len();
    if heading.is_none() && columns > 2 && follows_along_lines(whole, separator) {
        return Err(RecordError::RowsOfValues { line, found: columns });
    }
    let names = match heading {
        None => Vec::new(),
        Some((line, heading)) => {
            let names = headings(heading, separator, columns);
            if names.len() != columns {
                let wanted = "the rows below the heading have a different number";
                return Err(RecordError::Columns { line, found: names.len(), wanted });
            }
            names
        }
    };
    // Without a component there are one or two columns; with one, a step says that there is no time.
    let is_time = |name: &String| matches!(title(name).as_str(), "t" | "time");
    let named = names.first().is_some_and(is_time);
    let timed = columns > 1 && (settings.component.is_none() || settings.step.is_none() || named);
    let first = usize::from(timed);
    let acceleration = match settings.component {
        None if columns <= 2 => first,
        None => {
            return Err(RecordError::SeveralColumns {
                line,
                found: columns,
                known: known_columns(first..columns, &names),
            });
        }
        Some(component) => column_of(component, first..columns, &names)?,
    };
    let mut scales = [1.0, settings.unit.unwrap_or(1.0)];
    let Some((line, _)) = heading else {
        return Ok(TableLayout { separator, columns, timed, acceleration, scales, has_unit: settings.unit.is_some() });
    };
    let mut has_unit = settings.unit.is_some();
    for (k, name) in names.iter().enumerate() {
        let is_time = timed && k == 0;
        if !is_time && k != acceleration {
            continue;
        }
        let plain = plain(name);
        let title = title(name);
        if !is_time && matches!(title.as_str(), "t" | "time") {
            let reason = format!("heading `{}`: time must come first, then acceleration", shown(plain));
            return Err(RecordError::Header { line, reason });
        }
        if title.starts_with("vel") || title.starts_with("disp") {
            return Err(RecordError::NotAcceleration { line, found: shown(plain), remedy: "" });
        }
        match unit_of(plain) {
            Some(unit) if is_time => scales[0] = units::time(line, unit)?,
            Some(unit) => {
                scales[1] = units::acceleration(line, unit)?;
                has_unit = true;
                if settings.unit.is_some() {
                    return Err(RecordError::UnitTwice { line, unit: shown(unit) });
                }
            }
            None => {
                // Whoever gives the unit has answered the question.
                let settled = !is_time && settings.unit.is_some();
                if let Some(unit) = unit_without_brackets(line, plain, is_time).filter(|_| !settled) {
                    let (unit, heading) = (shown(unit), shown(plain));
                    return Err(RecordError::UnitWithoutBrackets { line, unit, heading });
                }
            }
        }
    }
    Ok(TableLayout { separator, columns, timed, acceleration, scales, has_unit })
}

/// The last word of a heading, if it is a unit that would change the numbers. It may also be a part
/// of the name: `a_g` is the acceleration of the ground.
fn unit_without_brackets(line: usize, name: &str, is_time: bool) -> Option<&str> {
    let (_, last) = name.rsplit_once(|c: char| c == '_' || c.is_whitespace())?;
    let scale = if is_time { units::time(line, last) } else { units::acceleration(line, last) };
    scale.is_ok_and(|scale| scale != 1.0).then_some(last)
}

/// The columns of several accelerations, for messages.
fn known_columns(columns: std::ops::Range<usize>, names: &[String]) -> String {
    let named = |k: usize| match names.get(k).map(|name| shown(&title(name))).filter(|name| !name.is_empty()) {
        Some(name) => format!("{name} (column {})", k + 1),
        None => format!("column {}", k + 1),
    };
    columns.map(named).collect::<Vec<_>>().join(", ")
}

/// The column with a component: by its heading, or by its number.
fn column_of(component: &str, columns: std::ops::Range<usize>, names: &[String]) -> Result<usize, RecordError> {
    let wanted = component.trim().to_lowercase();
    let by_name = columns.clone().find(|k| names.get(*k).is_some_and(|name| title(name) == wanted));
    let by_number = wanted.parse::<usize>().ok().and_then(|k| k.checked_sub(1)).filter(|k| columns.contains(k));
    by_name
        .or(by_number)
        .ok_or_else(|| RecordError::Component { component: shown(component), known: known_columns(columns, names) })
}

/// The text of a heading without quotes.
fn plain(name: &str) -> &str {
    name.trim_matches('"').trim()
}

/// The title of a column in lower case, without its unit.
fn title(name: &str) -> String {
    plain(name).split(['[', '(']).next().unwrap_or_default().trim().to_lowercase()
}

/// The names of the columns. With blanks as separator, a unit in brackets belongs to the word
/// before it.
fn headings(text: &str, separator: Separator, columns: usize) -> Vec<String> {
    match separator {
        _ if columns == 1 => vec![text.to_owned()],
        // The heading may have a different separator.
        Separator::Blanks if text.contains([',', ';']) => {
            text.split([',', ';']).map(|name| name.trim().to_owned()).collect()
        }
        Separator::Blanks => {
            let mut names: Vec<String> = Vec::new();
            for word in text.split_whitespace() {
                match names.last_mut() {
                    Some(name) if word.starts_with(['[', '(']) => *name = format!("{name} {word}"),
                    _ => names.push(word.to_owned()),
                }
            }
            names
        }
        other => cells(text, other).into_iter().map(str::to_owned).collect(),
    }
}

/// The unit in brackets at the end of a heading.
fn unit_of(name: &str) -> Option<&str> {
    let (open, inner) = match name.strip_suffix(']') {
        Some(inner) => ('[', inner),
        None => ('(', name.strip_suffix(')')?),
    };
    inner.split_once(open).map(|(_, unit)| unit.trim())
}

fn cells(row: &str, separator: Separator) -> Vec<&str> {
    match separator {
        Separator::Semicolon => row.split(';').map(str::trim).collect(),
        Separator::Comma => row.split(',').map(str::trim).collect(),
        Separator::Blanks => row.split_whitespace().collect(),
    }
}

impl TableRows {
    fn take(&mut self, line: usize, cells: &[&str], layout: &TableLayout) -> Result<(), RecordError> {
        if cells.len() != layout.columns {
            let wanted = if layout.columns > 2 { EQUAL_COLUMNS } else { EXPECTED_COLUMNS };
            return Err(RecordError::Columns { line, found: cells.len(), wanted });
        }
        if self.accelerations.len() == MOST_VALUES {
            return Err(RecordError::TooMany);
        }
        let number = |cell: &str| {
            let value = match layout.separator {
                Separator::Semicolon => numbers::one(&cell.replace(',', ".")),
                _ => numbers::one(cell),
            };
            value.ok_or_else(|| RecordError::Number { line, text: shown(cell), hint: "" })
        };
        let [time, acceleration] = layout.scales;
        if let (true, Some(t)) = (layout.timed, cells.first()) {
            self.times.push(number(t)? * time);
            self.resolution = self.resolution.min(resolution(t) * time);
        }
        let value = number(cells.get(layout.acceleration).copied().unwrap_or_default())?;
        if !((value * acceleration).abs() <= LARGEST_ACCELERATION) {
            return Err(RecordError::Value { line, value });
        }
        self.lines.push(line);
        self.accelerations.push(value * acceleration);
        Ok(())
    }

    /// The step of the times: the first step or the rounded mean if all rows fit it exactly, else
    /// the mean.
    fn step(&self) -> Result<f64, RecordError> {
        if let (true, [first, second, ..]) = (self.times.windows(2).all(|t| t[1] < t[0]), self.times.as_slice()) {
            return Err(RecordError::Descending { line: self.lines[1], before: *first, time: *second });
        }
        let (first, count) = (self.times[0], (self.times.len() - 1) as f64);
        let mean = (self.times[self.times.len() - 1] - first) / count;
        let round = format!("{mean:.9e}").parse().unwrap_or(mean);
        let off = |step: f64| {
            let even = self.times.iter().enumerate().map(move |(k, t)| (k, first + k as f64 * step, *t));
            even.map(|(k, even, t)| (k, even, (t - even).abs()))
        };
        let rounding = 8.0 * f64::EPSILON * self.times.iter().fold(0.0, |most: f64, t| most.max(t.abs()));
        for step in [self.times[1] - first, round] {
            if step > 0.0 && off(step).all(|(_, _, off)| off <= rounding.min(LARGEST_DEVIATION * step)) {
                return Ok(step);
            }
        }
        // A row may be off by half its last digit, and so may both ends, which determine the mean.
        let allowed = (self.resolution + rounding).min(LARGEST_DEVIATION * mean);
        let uneven = self.non_uniform_time(mean, allowed);
        match uneven {
            None => Ok(mean),
            Some(error) => Err(error),
        }
    }

    /// The error for uneven times: the first row that isn't one median step after the row before
    /// it.
    fn non_uniform_time(&self, mean: f64, allowed: f64) -> Option<RecordError> {
        let first = self.times[0];
        let worst = |(k, t): (usize, &f64)| !((t - (first + k as f64 * mean)).abs() <= allowed);
        if !self.times.iter().enumerate().any(worst) && mean > 0.0 {
            return None;
        }
        let mut steps: Vec<f64> = self.times.windows(2).map(|t| t[1] - t[0]).collect();
        steps.sort_by(f64::total_cmp);
        let step = steps[steps.len() / 2];
        let within = |t: &[f64]| (t[1] - t[0] - step).abs() <= (2.0 * self.resolution).min(LARGEST_DEVIATION * step);
        let at = self.times.windows(2).position(|t| !within(t)).map_or(self.times.len() - 1, |k| k + 1);
        let expected = self.times[at - 1] + step;
        Some(RecordError::Uneven { line: self.lines[at], time: self.times[at], expected, step })
    }
}

/// The value of one unit in the last digit of a number as written.
fn resolution(text: &str) -> f64 {
    let lower = text.to_ascii_lowercase().replace(',', ".");
    let (digits, power) = lower.split_once(['e', 'd']).unwrap_or((&lower, "0"));
    let decimals = digits.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let power: i32 = power.parse().unwrap_or(0);
    10f64.powi(power.saturating_sub(i32::try_from(decimals).unwrap_or(i32::MAX)))
}

#[cfg(test)]
mod tests {
    use crate::{ReadSettings, Record, STANDARD_GRAVITY};

    fn read(text: &str) -> Result<Record, String> {
        Record::read(text, "R").map_err(|error| error.to_string())
    }

    #[test]
    fn separators_headings_and_units_are_understood() {
        let tables = [
            "t,a\n0,1\n0.5,-2\n1,3\n",
            "\u{feff}# ours\r\n\r\ntime [s], a [m/s^2]\r\n0 , 1\r\n0.5,\t-2 # here\r\n1,3\r\n",
            "0 1\n.5 -2\n1.\t3\n",
            "t (ms);acc (cm/s^2)\n0;100\n500;-200\n1000;3e2\n",
            "t a\n5 1\n5.5 -2\n6 3\n",
            "time (s) acc (m/s2)\n0 1\n.5 -2\n1 3\n",
            "\"t\";\"a\"\n0;1,0\n0,5;-2\n1;3\n",
        ];
        for table in tables {
            let record = read(table).unwrap();
            assert_eq!((record.dt(), record.accelerations()), (0.5, &[1.0, -2.0, 3.0][..]), "{table}");
        }
        for heading in ["acc (g)", "acc [gn]"] {
            let record = Record::read_with_step(format!("{heading}\n1\n-2\n"), "R", Some(0.02)).unwrap();
            assert_eq!((record.dt(), record.accelerations()), (0.02, &[STANDARD_GRAVITY, -2.0 * STANDARD_GRAVITY][..]));
        }
    }

    #[test]
    fn a_component_is_chosen_by_its_heading_or_number() {
        let table = "t [s],EW [g],NS [cm/s^2],UD\n0,1,100,7\n0.5,-2,-200,8\n1,3,300,9\n";
        let read = |component, unit, step| {
            let settings = ReadSettings { component: Some(component), unit, step };
            Record::read_with(table, "R", &settings).map_err(|error| error.to_string())
        };
        assert_eq!(read("ns", None, None).unwrap().accelerations(), [1.0, -2.0, 3.0]);
        assert_eq!(read("3", None, None), read("NS", None, None));
        assert_eq!(read("UD", Some(0.01), None).unwrap().accelerations(), [0.07, 0.08, 0.09]);
        assert_eq!(
            read("EW", Some(0.01), None).unwrap_err(),
            "line 1: the unit is `g` by the heading: omit the given one"
        );
        assert_eq!(
            read("5", None, None).unwrap_err(),
            "there is no component `5`: the file has ew (column 2), ns (column 3), ud (column 4)"
        );
        assert!(read("1", None, None).is_err(), "the first column has the times");
        let twice = read("NS", None, Some(0.1)).unwrap_err();
        assert!(twice.contains("has its own step, 0.5 s"), "the heading says so: {twice}");
        // With a step all columns are accelerations.
        let plain = "1 2\n3 4\n";
        let settings = ReadSettings { component: Some("2"), unit: None, step: Some(0.1) };
        let record = Record::read_with(plain, "R", &settings).unwrap();
        assert_eq!((record.dt(), record.accelerations()), (0.1, &[2.0, 4.0][..]));
        let settings = ReadSettings { component: Some("3"), ..settings };
        let error = Record::read_with(plain, "R", &settings).unwrap_err().to_string();
        assert_eq!(error, "there is no component `3`: the file has column 1, column 2");
        let error =
            Record::read_with("0 1 2\n1 2\n", "R", &ReadSettings { component: Some("2"), ..Default::default() });
        assert_eq!(error.unwrap_err().to_string(), "line 2: 2 columns, but the rows before have a different number");
    }

    #[test]
    fn values_that_fill_lines_are_not_columns() {
        let value = |k: u32| (f64::from(k) / 20.0).sin();
        let line = |row: u32| (0..5).map(|k| format!(" {:.6E}", value(5 * row + k))).collect::<String>();
        let text: String = (0..40).map(|row| line(row) + "\n").collect();
        let settings = [ReadSettings::default(), ReadSettings { component: Some("1"), step: Some(0.05), unit: None }];
        for settings in settings {
            let error = Record::read_with(&text, "R", &settings).unwrap_err().to_string();
            assert!(error.starts_with("line 1: this looks like the values of one record, 5 in each line"), "{error}");
        }
        // Three accelerations without times are columns.
        let row = |k: u32| format!("{:.6} {:.6} {:.6}\n", value(k), 2.0 * value(k + 9), -value(k + 30));
        let text: String = (0..200).map(row).collect();
        let settings = ReadSettings { component: Some("2"), step: Some(0.05), unit: None };
        let record = Record::read_with(&text, "R", &settings).unwrap();
        assert!((record.accelerations()[1] - 2.0 * value(10)).abs() < 1e-6);
    }

    #[test]
    fn a_unit_that_nobody_gave_is_remembered_as_assumed() {
        let assumes = |text: &str, unit| {
            Record::read_with(text, "R", &ReadSettings { unit, ..Default::default() }).unwrap().assumes_its_unit()
        };
        assert!(assumes("0,1\n1,2\n", None) && assumes("t,a\n0,1\n1,2\n", None));
        assert!(!assumes("t,a [g]\n0,1\n1,2\n", None) && !assumes("t,acc_g\n0,1\n1,2\n", Some(9.8)));
    }

    #[test]
    fn times_are_uniform_to_their_written_digits() {
        // 256 Hz to four digits, and hundredths of a second that fit a uniform step.
        let table: String = (0..200).map(|k| format!("{:.4},1\n", f64::from(k) / 256.0)).collect();
        assert!((read(&table).unwrap().dt() - 1.0 / 256.0).abs() < 1e-6);
        let table: String = (0..2000).map(|k| format!("{:.2},1\n", 7.0 + 0.01 * f64::from(k))).collect();
        assert_eq!(read(&table).unwrap().dt(), 0.01);
        let message = read("t,a\n0,1\n0.1,1\n0.2,1\n0.31,1\n0.4,1\n").unwrap_err();
        assert!(
            message.starts_with("line 5: the time 0.31 s doesn't fit a uniform step: the other rows are 0.1"),
            "{message}"
        );
        let message = read("0,1\n0.1,1\n0.2,1\n0.4,1\n0.5,1\n").unwrap_err();
        assert!(
            message.starts_with("line 4: the time 0.4 s doesn't fit a uniform step"),
            "a row is missing: {message}"
        );
        assert!(
            read("0,1\n0.1,1\n0.1,1\n0.2,1\n")
                .unwrap_err()
                .starts_with("line 3: the time 0.1 s doesn't fit a uniform step")
        );
        assert_eq!(read("1,1\n0.9,1\n0.8,1\n").unwrap_err(), "line 2: the times descend, from 1 s to 0.9 s");
        assert!(read("0,1\n0,1\n").unwrap_err().starts_with("line 2: the time 0 s doesn't fit a uniform step"));
    }

    #[test]
    fn errors_name_the_line() {
        let message = |text: &str| read(text).unwrap_err();
        assert_eq!(message("1\n2\n"), "the file has accelerations without times: the step must be given");
        assert_eq!(message("# nothing\n"), "the file is empty");
        assert_eq!(message(""), "the file is empty");
        assert_eq!(message("t,a\n0,1\n"), "a record must have at least two values, but has 1");
        assert_eq!(
            message("t,a\n0,1\n1\n"),
            "line 3: 1 column, but a table has time and acceleration, or acceleration alone, with equally many columns in each row"
        );
        assert_eq!(
            message("t,NS,EW\n0,1,2\n1,2,3\n"),
            "line 2: 3 columns: which of them is the acceleration? The file has ns (column 2), ew (column 3)"
        );
        assert!(message("0 7 2\n1 8 3\n").ends_with("The file has column 2, column 3"));
        for (text, unit) in [
            ("time_s,acc_g\n0,1\n1,2\n", "g"),
            ("t,acceleration cm/s2\n0,1\n1,2\n", "cm/s2"),
            ("t_ms,a\n0,1\n1,2\n", "ms"),
        ] {
            assert!(message(text).starts_with(&format!("line 1: is `{unit}` in the heading")), "{}", message(text));
        }
        assert_eq!(message("t,a\n0,1\n1,high\n"), "line 3: `high` is not a number");
        assert_eq!(message("a,t\n1,0\n1,1\n"), "line 1: heading `t`: time must come first, then acceleration");
        assert_eq!(
            message("x,y,z\n1,0\n1,1\n"),
            "line 1: 3 columns, but the rows below the heading have a different number"
        );
        assert_eq!(
            message("t,v [m/s]\n0,1\n1,1\n"),
            "line 1: `m/s` is not a known unit of acceleration: m/s^2, cm/s^2, mm/s^2, gal, g, gn"
        );
        assert_eq!(message("t [h],a\n0,1\n1,1\n"), "line 1: `h` is not a known unit of time: s, ms");
        assert_eq!(
            message("t,velocity\n0,1\n1,1\n"),
            "line 1: the file contains `velocity`, but a record is an acceleration"
        );
        assert_eq!(
            message("Dear reader,\nthis is a letter\n"),
            "line 1: `Dear reader,` doesn't begin a known record format: PEER .AT2, ESM and COSMOS files are read, and tables of \
             numbers"
        );
        let error = Record::read_with_step("0,1\n1,2\n", "R", Some(1.0)).unwrap_err();
        assert_eq!(error.to_string(), "the table file has its own step, 1 s: omit the given one");
    }
}
