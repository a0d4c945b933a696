//! The measured table of `teeter compare` and `teeter fit`, and how it is laid out.

use crate::console::Console;
use crate::render::Presenter;
use clap::Args;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use teeter_scenario::diagnostic::printable;
use teeter_scenario::dimension::Dimension;
use teeter_scenario::quantity;
use teeter_study::compare::AlignmentSettings;
use teeter_study::measured::{ColumnLayout, LARGEST_FILE, LEAST_WINDOW, Measured, Sign, line_ranges};

/// How many columns that aren't read are named.
const MOST_NAMED: usize = 5;

/// Options that say where the quantities stand in a table of measured motion.
#[derive(Args, Debug)]
pub(crate) struct MeasuredOptions {
    /// Table of measured motion (CSV): columns t and phi, or others as told below; docs/compare.md
    #[arg(value_name = "MEASURED.csv")]
    pub(crate) measured: PathBuf,
    /// How the table is laid out: a TOML file with columns, units, markers
    #[arg(long, value_name = "FILE.toml")]
    columns: Option<PathBuf>,
    /// The column of t, phi, omega, x, y, vx or vy, by its heading or number, such as phi="Angle";
    /// may be repeated
    #[arg(long = "column", value_name = "NAME=COLUMN", value_parser = column)]
    column: Vec<(String, String)>,
    /// The unit of a column that has none in its heading, such as phi=deg; may be repeated
    #[arg(long = "unit", value_name = "NAME=UNIT", value_parser = unit)]
    unit: Vec<(String, String)>,
    /// Rows per second, for a table without times or with numbers of frames, such as "165 Hz"
    #[arg(long, value_name = "RATE", value_parser = rate, allow_hyphen_values = true)]
    rate: Option<f64>,
    /// Lines before the heading that are not read
    #[arg(long, value_name = "LINES", value_parser = skip, allow_negative_numbers = true)]
    skip: Option<usize>,
    /// Lines of the table whose frames are wrong and taken as lost, such as 62,90-95
    #[arg(long, value_name = "LINES", value_parser = lines)]
    leave_out: Option<Lines>,
    /// The block that was measured (default: the only one)
    #[arg(long, value_name = "NAME")]
    pub(crate) block: Option<String>,
    /// Time of the simulated motion at t = 0 of the table, such as "-1.2 s" (default: found)
    #[arg(long, value_name = "T", value_parser = time, allow_hyphen_values = true)]
    shift: Option<f64>,
    /// 1: seen as in the scene, -1: seen from behind, so that x and phi have the opposite sign
    /// (default: found)
    #[arg(long, value_name = "1|-1", value_parser = sign, allow_hyphen_values = true)]
    sign: Option<Sign>,
    /// Rows of the window through which both motions are smoothed and rates are found
    #[arg(long, value_name = "ROWS", default_value = "5", value_parser = window)]
    pub(crate) window: usize,
}

/// Lines of the table.
#[derive(Clone, Debug)]
struct Lines(Vec<RangeInclusive<usize>>);

fn column(text: &str) -> Result<(String, String), String> {
    crate::arguments::key_value(text).map_err(|_| "write NAME=COLUMN, such as phi=\"Angle\" or phi=2".to_owned())
}

fn unit(text: &str) -> Result<(String, String), String> {
    crate::arguments::key_value(text).map_err(|_| "write NAME=UNIT, such as phi=deg".to_owned())
}

fn skip(text: &str) -> Result<usize, String> {
    text.parse().map_err(|_| "a number of lines is expected, such as 3".to_owned())
}

/// The first quantity that is given twice, with both values.
fn twice(given: &[(String, String)]) -> Option<[&(String, String); 2]> {
    let first = |place: usize| given[..place].iter().find(|(name, _)| *name == given[place].0);
    (1..given.len()).find_map(|place| Some([first(place)?, &given[place]]))
}

fn lines(text: &str) -> Result<Lines, String> {
    line_ranges(text).map(Lines)
}

fn rate(text: &str) -> Result<f64, String> {
    match quantity::parse(text, Dimension::RATE) {
        Ok(rate) if rate > 0.0 => Ok(rate),
        Ok(_) => Err("must be positive, such as \"165 Hz\"".to_owned()),
        Err(error) => Err(error.with_remedy()),
    }
}

fn time(text: &str) -> Result<f64, String> {
    quantity::parse(text, Dimension::TIME).map_err(|error| error.to_string())
}

/// An angle with its unit.
fn angle(text: &str) -> Result<f64, String> {
    quantity::parse(text, Dimension::ANGLE).map_err(|error| error.to_string())
}

/// The angle that a block standing upright seems to have.
pub(crate) fn offset(text: &str) -> Result<f64, String> {
    let offset = angle(text)?;
    // A half turn may be written with less digits than π has.
    if offset.abs() > std::f64::consts::PI * (1.0 + 1e-3) {
        return Err("an angle from -180 deg to 180 deg is expected".to_owned());
    }
    Ok(offset)
}

fn sign(text: &str) -> Result<Sign, String> {
    match text {
        "1" | "+1" => Ok(Sign::AsIs),
        "-1" => Ok(Sign::Reversed),
        _ => Err("1 or -1 is expected".to_owned()),
    }
}

fn window(text: &str) -> Result<usize, String> {
    match text.parse::<usize>() {
        Ok(rows) if rows >= LEAST_WINDOW && rows % 2 == 1 && rows <= 999 => Ok(rows),
        _ => Err(format!("an odd number of rows from {LEAST_WINDOW} to 999 is expected")),
    }
}

/// A mistake in an option.
fn usage(option: &str, why: String) -> String {
    format!("error: --{option}: {why}")
}

impl MeasuredOptions {
    /// What is given of the alignment.
    pub(crate) fn alignment(&self) -> AlignmentSettings {
        AlignmentSettings { shift: self.shift, sign: self.sign }
    }

    /// The files that are read.
    pub(crate) fn inputs(&self) -> Vec<PathBuf> {
        self.columns.iter().cloned().chain([self.measured.clone()]).collect()
    }

    /// Reads the table; `block` is that of the run or scene.
    ///
    /// # Errors
    /// The text to print.
    pub(crate) fn read(&self, block: &str) -> Result<Measured, String> {
        let mut layout = match &self.columns {
            None => ColumnLayout::default(),
            Some(path) => {
                let name = path.display().to_string();
                let bytes = bytes(path)?;
                let text = String::from_utf8(bytes).map_err(|_| format!("error: {name}: not a text file in UTF-8"))?;
                ColumnLayout::read(&text, &name).map_err(|found| Presenter::new(&text).all(&found))?
            }
        };
        for (option, given) in [("column", &self.column), ("unit", &self.unit)] {
            if let Some([(name, first), (_, second)]) = twice(given) {
                let [name, first, second] = [name, first, second].map(|text| printable(text));
                return Err(usage(
                    option,
                    format!("{name} is given twice, as `{first}` and as `{second}`: keep one of the two"),
                ));
            }
        }
        for (name, column) in &self.column {
            layout.set_column(name, column).map_err(|why| usage("column", why))?;
        }
        for (name, unit) in &self.unit {
            layout.set_unit(name, unit).map_err(|why| usage("unit", why))?;
        }
        layout.rate = self.rate.or(layout.rate);
        layout.skip = self.skip.unwrap_or(layout.skip);
        if let Some(Lines(lines)) = &self.leave_out {
            layout.leave_out.clone_from(lines);
        }
        let bytes = bytes(&self.measured)?;
        let measured = Measured::read(&bytes, &layout, block)
            .map_err(|error| format!("error: {}: {error}", self.measured.display()))?;
        self.refuse_wide_window(&measured)?;
        Ok(measured)
    }

    /// Refuses a window that no row of the table has on both sides.
    fn refuse_wide_window(&self, measured: &Measured) -> Result<(), String> {
        let (window, motion) = (self.window, measured.motion(Sign::AsIs));
        for (channel, values) in motion.channels.iter().filter(|(channel, _)| channel.rate().is_some()) {
            let rows = values.iter().filter(|value| value.is_finite()).count();
            if window > rows {
                let most = if rows % 2 == 1 { rows } else { rows - 1 };
                return Err(usage(
                    "window",
                    format!(
                        "{window} rows, but the table has {} in {rows} rows, so that no row has a complete window: {most} at most",
                        channel.word()
                    ),
                ));
            }
        }
        Ok(())
    }

    /// Names the columns of the table that aren't read.
    pub(crate) fn tell_unread(&self, measured: &Measured, console: Console) {
        let unread: Vec<String> =
            measured.unread().iter().take(MOST_NAMED).map(|name| format!("`{}`", printable(name))).collect();
        if let [first, ..] = unread.as_slice() {
            let more = measured.unread().len() - unread.len();
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            console.note(&format!(
                "{}: not read: {}{more}; if one is needed, name it, such as --column phi=\"{}\"",
                self.measured.display(),
                unread.join(", "),
                first.trim_matches('`')
            ));
        }
    }
}

/// The bytes of a file; of one that is too large only enough to notice.
pub(crate) fn bytes(path: &Path) -> Result<Vec<u8>, String> {
    teeter_run::read_regular(path, LARGEST_FILE).map_err(|why| format!("error: {}: {why}", path.display()))
}
