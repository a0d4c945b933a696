//! What can be wrong with a record.

use crate::format::Format;

/// Why a file isn't a record that can be read, or a record can't be changed as asked. Lines count
/// from 1.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RecordError {
    /// More bytes than are read.
    #[error("{bytes} bytes are more than {} MB, the limit of a record", crate::LARGEST_FILE / 1_000_000)]
    TooLarge {
        /// Bytes of the file.
        bytes: usize,
    },
    /// Nothing but blank lines and comments.
    #[error("the file is empty")]
    Empty,
    /// None of the formats.
    #[error(
        "line {line}: `{text}` begins no known form of a record: PEER .AT2, ESM and COSMOS files are read, and tables of \
         numbers"
    )]
    Unknown {
        /// The first line that has something.
        line: usize,
        /// What it has, shortened.
        text: String,
    },
    /// A header that lacks what the format requires.
    #[error("this {format} file has no {what} in its header")]
    Missing {
        /// The format.
        format: Format,
        /// What is missing, as the format calls it.
        what: &'static str,
    },
    /// A header line that can't be understood.
    #[error("line {line}: {reason}")]
    Header {
        /// The line.
        line: usize,
        /// What is wrong, and what would be right.
        reason: String,
    },
    /// A velocity, a displacement or another quantity.
    #[error("line {line}: the file holds `{found}`, but a record is an acceleration{remedy}")]
    NotAcceleration {
        /// The line that says so.
        line: usize,
        /// The quantity as the file calls it.
        found: String,
        /// Which file to take instead; may be empty.
        remedy: &'static str,
    },
    /// A unit that is none of an acceleration, or none that is known.
    #[error("line {line}: `{found}` is no known unit of {quantity}: {known}")]
    Unit {
        /// The line.
        line: usize,
        /// The unit as given.
        found: String,
        /// What it should be a unit of.
        quantity: &'static str,
        /// The known ones.
        known: &'static str,
    },
    /// Text where a number must be.
    #[error("line {line}: `{text}` is no number{hint}")]
    Number {
        /// The line.
        line: usize,
        /// The text, shortened.
        text: String,
        /// What may have happened; may be empty.
        hint: &'static str,
    },
    /// A value that is not finite, or larger than any acceleration.
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
    /// Another number of values than announced.
    #[error("line {line}: the header announces {announced} values, but the file has {found}")]
    Count {
        /// The line that announces them.
        line: usize,
        /// The number announced.
        announced: usize,
        /// The number found.
        found: usize,
    },
    /// A row of a table with too few or too many columns.
    #[error("line {line}: {found} column{}, but {wanted}", if *found == 1 { "" } else { "s" })]
    Columns {
        /// The line.
        line: usize,
        /// Columns found.
        found: usize,
        /// What must be there.
        wanted: &'static str,
    },
    /// Times that don't rise by a uniform step.
    #[error(
        "line {line}: the time {time} s is uneven: the other rows are {step} s apart, which makes {expected} s; give even \
         times with enough digits, or the accelerations alone with their step"
    )]
    Uneven {
        /// The line.
        line: usize,
        /// The time there, s.
        time: f64,
        /// The time that an even step would give, s.
        expected: f64,
        /// The step, s.
        step: f64,
    },
    /// Accelerations alone, without a step.
    #[error("the file has accelerations alone: their step must be given")]
    StepNeeded,
    /// A step for a file that says its own.
    #[error("the {format} file says its own step, {step} s: leave the given one out")]
    StepTwice {
        /// The format.
        format: Format,
        /// The step of the file, s.
        step: f64,
    },
    /// A step that none can be.
    #[error("the step is {0} s, but must be between 1e-9 s and 1e6 s")]
    Step(f64),
    /// Fewer than two values.
    #[error("a record needs two values or more, got {0}")]
    TooFew(usize),
    /// More values than are read.
    #[error("more than {} values, the limit of a record", crate::MOST_VALUES)]
    TooMany,
    /// A number of a correction or a measure out of its range.
    #[error("{what} is {value}, but must be {range}")]
    Parameter {
        /// What it is.
        what: &'static str,
        /// What was given.
        value: f64,
        /// What it must be.
        range: &'static str,
    },
    /// A cut that leaves less than two values.
    #[error("from {from} s to {to} s there are fewer than two values; the record goes from 0 s to {duration} s")]
    Cut {
        /// Begin of the cut, s.
        from: f64,
        /// End of the cut, s.
        to: f64,
        /// Duration of the record, s.
        duration: f64,
    },
    /// A record of zeros, which no factor gives a peak.
    #[error("the acceleration is 0 throughout: it can't be scaled to a peak")]
    Still,
}

/// A piece of a file for a message: without control characters, and not too long.
pub(crate) fn shown(text: &str) -> String {
    let clean = |c: char| if c.is_control() { '\u{fffd}' } else { c };
    let mut shown: String = text.trim().chars().take(40).map(clean).collect();
    if text.trim().chars().nth(40).is_some() {
        shown.push('…');
    }
    shown
}
