//! Errors of reading and changing records.

use crate::format::Format;

/// An end of a cut, in words.
fn bound(t: f64) -> String {
    match t {
        f64::INFINITY => "the end".to_owned(),
        f64::NEG_INFINITY => "the start".to_owned(),
        t => format!("{t} s"),
    }
}

/// A time without the rounding of its sums.
fn rounded(t: f64) -> f64 {
    format!("{t:.9e}").parse().unwrap_or(t)
}

/// Why a file can't be read as a record, or a record can't be changed as requested. Lines count
/// from 1.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RecordError {
    /// The file is too large.
    #[error("the file has {bytes} bytes, more than the limit of {} MB", crate::LARGEST_FILE / 1_000_000)]
    TooLarge {
        /// Its size in bytes.
        bytes: usize,
    },
    /// Only blank lines and comments.
    #[error("the file is empty")]
    Empty,
    /// No text.
    #[error("not a text file: byte {at} is {byte:#04x}")]
    NotText {
        /// Where its first byte is that no text has, from 0.
        at: usize,
        /// That byte.
        byte: u8,
    },
    /// The format isn't recognised.
    #[error(
        "line {line}: `{text}` doesn't begin a known record format: PEER .AT2, ESM and COSMOS files are read, and tables of \
         numbers"
    )]
    Unknown {
        /// The first line that isn't blank.
        line: usize,
        /// Its text, shortened.
        text: String,
    },
    /// A header without an entry that the format requires.
    #[error("this {format} file has no {what} in its header")]
    Missing {
        /// The format.
        format: Format,
        /// The missing entry, as named by the format.
        what: &'static str,
    },
    /// An invalid header line.
    #[error("line {line}: {reason}")]
    Header {
        /// The line.
        line: usize,
        /// What is wrong and what is expected.
        reason: String,
    },
    /// The values are a velocity, a displacement or another quantity.
    #[error("line {line}: the file contains `{found}`, but a record is an acceleration{remedy}")]
    NotAcceleration {
        /// The line with the quantity.
        line: usize,
        /// The quantity as named in the file.
        found: String,
        /// Which file to use instead; may be empty.
        remedy: &'static str,
    },
    /// An unknown unit, or one of another quantity.
    #[error("line {line}: `{found}` is not a known unit of {quantity}: {known}")]
    Unit {
        /// The line.
        line: usize,
        /// The unit as given.
        found: String,
        /// The quantity that it should measure.
        quantity: &'static str,
        /// The known units.
        known: &'static str,
    },
    /// Text where a number is expected.
    #[error("line {line}: `{text}` is not a number{hint}")]
    Number {
        /// The line.
        line: usize,
        /// The text, shortened.
        text: String,
        /// The likely cause; may be empty.
        hint: &'static str,
    },
    /// A value that isn't finite or is implausibly large.
    #[error(
        "line {line}: the acceleration {value:e} must be finite and at most {:e} m/s^2 in size",
        crate::LARGEST_ACCELERATION
    )]
    Value {
        /// The line (0 where there is no file).
        line: usize,
        /// The value, in the unit of the file.
        value: f64,
    },
    /// The number of values differs from the one announced.
    #[error("line {line}: the header announces {announced} values, but the file has {found}")]
    Count {
        /// The line that announces them.
        line: usize,
        /// The number announced.
        announced: usize,
        /// The number found.
        found: usize,
    },
    /// A last number that is only the beginning of one written like all others.
    #[error(
        "line {line}: the last number, `{number}`, is shorter than all others, which are written alike: the file was cut within it; get \
         the whole file again"
    )]
    CutNumber {
        /// The line.
        line: usize,
        /// The number as it stands there, shortened.
        number: String,
    },
    /// A row of a table with too few or too many columns.
    #[error("line {line}: {found} column{}, but {wanted}", if *found == 1 { "" } else { "s" })]
    Columns {
        /// The line.
        line: usize,
        /// Columns found.
        found: usize,
        /// What is expected.
        wanted: &'static str,
    },
    /// Several accelerations of which none is chosen.
    #[error("line {line}: {found} columns: which of them is the acceleration? The file has {known}")]
    SeveralColumns {
        /// The line.
        line: usize,
        /// Columns found.
        found: usize,
        /// The columns to choose from.
        known: String,
    },
    /// Numbers that follow each other along the lines, as in a file that lost its header.
    #[error(
        "line {line}: this looks like the values of one record, {found} in each line, as in a PEER .AT2 file without its header, \
         and not like a table with a row for each time"
    )]
    RowsOfValues {
        /// The line.
        line: usize,
        /// Values in it.
        found: usize,
    },
    /// A unit in a heading that may also be a part of the name.
    #[error(
        "line {line}: is `{unit}` in the heading `{heading}` a unit? A unit stands in brackets, such as `a [{unit}]`"
    )]
    UnitWithoutBrackets {
        /// The line.
        line: usize,
        /// What may be the unit.
        unit: String,
        /// The heading.
        heading: String,
    },
    /// Times that descend.
    #[error("line {line}: the times descend, from {before} s to {time} s")]
    Descending {
        /// The line.
        line: usize,
        /// The time before, s.
        before: f64,
        /// The time there, s.
        time: f64,
    },
    /// Times without a uniform step.
    #[error(
        "line {line}: the time {time} s doesn't fit a uniform step: the other rows are {} s apart, which gives {} s; use uniform \
         times with enough digits, or the accelerations alone with their step",
        rounded(*step),
        rounded(*expected)
    )]
    Uneven {
        /// The line.
        line: usize,
        /// The time there, s.
        time: f64,
        /// The time that a uniform step would give, s.
        expected: f64,
        /// The step, s.
        step: f64,
    },
    /// Accelerations without times and without a step.
    #[error("the file has accelerations without times: the step must be given")]
    StepNeeded,
    /// A step given for a file that has its own.
    #[error("the {format} file has its own step, {step} s: omit the given one")]
    StepTwice {
        /// The format.
        format: Format,
        /// The step of the file, s.
        step: f64,
    },
    /// A unit given for a file that states its own.
    #[error("line {line}: the unit is `{unit}` by the heading: omit the given one")]
    UnitTwice {
        /// The line that states it.
        line: usize,
        /// The unit of the file.
        unit: String,
    },
    /// A unit or a component given for a file of a format that has its own.
    #[error("{what} applies only to {applies_to}, and this is a {format} file: omit it")]
    NotForFormat {
        /// What was given.
        what: &'static str,
        /// The formats that it applies to.
        applies_to: &'static str,
        /// The format of the file.
        format: Format,
    },
    /// A component that the file doesn't have.
    #[error("there is no component `{component}`: the file has {known}")]
    Component {
        /// The component as given.
        component: String,
        /// Those of the file.
        known: String,
    },
    /// A step out of range.
    #[error("the step is {0} s, but must be between 1e-9 s and 1e6 s")]
    Step(f64),
    /// Fewer than two values.
    #[error("a record must have at least two values, but has {0}")]
    TooFew(usize),
    /// Too many values.
    #[error("the file has more than {} values, the limit of a record", crate::MOST_VALUES)]
    TooMany,
    /// A parameter of a correction or a measure out of range.
    #[error("{what} is {value}, but must be {range}")]
    Parameter {
        /// The parameter.
        what: &'static str,
        /// The value given.
        value: f64,
        /// The allowed range.
        range: &'static str,
    },
    /// A cut that leaves fewer than two values.
    #[error("from {} to {} there are fewer than two values; the record covers 0 s to {duration} s", bound(*from), bound(*to))]
    Cut {
        /// Start of the cut, s.
        from: f64,
        /// End of the cut, s.
        to: f64,
        /// Duration of the record, s.
        duration: f64,
    },
    /// A record of zeros, which can't be scaled to a value.
    #[error("the acceleration is 0 throughout: it can't be scaled to a peak")]
    Still,
}

/// A text of a file for a message, shortened and without control characters.
pub(crate) fn shown(text: &str) -> String {
    let clean = |c: char| if c.is_control() { '\u{fffd}' } else { c };
    let mut shown: String = text.trim().chars().take(40).map(clean).collect();
    if text.trim().chars().nth(40).is_some() {
        shown.push('…');
    }
    shown
}
