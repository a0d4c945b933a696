//! The type of a record and its construction.

use crate::error::RecordError;
use crate::format::Format;
use crate::{LARGEST_ACCELERATION, LARGEST_FILE, MOST_VALUES};

/// An accelerogram: one component of ground acceleration, sampled at a uniform step and linear in
/// between. Time starts at 0 with the first value.
///
/// ```
/// use teeter_record::Record;
///
/// let record = Record::new("pulse", 0.01, vec![0.0, 3.0, 0.0])?;
/// assert_eq!((record.duration(), record.peak_acceleration()), (0.02, 3.0));
/// # Ok::<(), teeter_record::RecordError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    name: String,
    station: String,
    description: String,
    dt: f64,
    accelerations: Vec<f64>,
    unit_assumed: bool,
}

/// What a file doesn't say itself. The default leaves everything to the file.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ReadSettings<'a> {
    /// Time between two values, s, for a table of accelerations without times; `None`: the file
    /// gives it.
    pub step: Option<f64>,
    /// The unit of a table's accelerations, m/s², where its heading has none; `None`: m/s².
    pub unit: Option<f64>,
    /// One of several accelerations: of a table by the heading of its column, without regard to
    /// case, or by the number of the column from 1, that of the times included; of a COSMOS file by
    /// its number from 1. If a step is given too, a table has no times, unless its heading says so. `None`: the file has one only.
    pub component: Option<&'a str>,
}

impl Record {
    /// A record of accelerations in m/s² with the step `dt` in s. Station and description are
    /// empty.
    ///
    /// # Errors
    /// If there are fewer than two or more than [`MOST_VALUES`] values, if one isn't finite or is
    /// larger than [`LARGEST_ACCELERATION`], or if `dt` isn't between 1 ns and 1e6 s.
    pub fn new(name: &str, dt: f64, accelerations: Vec<f64>) -> Result<Self, RecordError> {
        if !(1e-9..=1e6).contains(&dt) {
            return Err(RecordError::Step(dt));
        }
        if accelerations.len() < 2 {
            return Err(RecordError::TooFew(accelerations.len()));
        }
        if accelerations.len() > MOST_VALUES {
            return Err(RecordError::TooMany);
        }
        if let Some(&value) = accelerations.iter().find(|a| !(a.abs() <= LARGEST_ACCELERATION)) {
            return Err(RecordError::Value { line: 0, value });
        }
        Ok(Self {
            name: name.to_owned(),
            station: String::new(),
            description: String::new(),
            dt,
            accelerations,
            unit_assumed: false,
        })
    }

    /// Reads a file of any known [`Format`], recognised by its content; `name` is the record's name
    /// (for example the file stem). Invalid UTF-8 is replaced, which can only affect names.
    ///
    /// # Errors
    /// If the format isn't recognised or the file violates it (with the line), if the file has no
    /// acceleration, or if it is a table of accelerations without times (see
    /// [`Record::read_with_step`]).
    pub fn read(file: impl AsRef<[u8]>, name: &str) -> Result<Self, RecordError> {
        Self::read_with_step(file, name, None)
    }

    /// Reads a file as [`Record::read`] does; `step` in s is for a table of accelerations without
    /// times.
    ///
    /// # Errors
    /// As [`Record::read`], and if a step is given for a file that has its own.
    pub fn read_with_step(file: impl AsRef<[u8]>, name: &str, step: Option<f64>) -> Result<Self, RecordError> {
        Self::read_with(file, name, &ReadSettings { step, ..ReadSettings::default() })
    }

    /// Reads a file as [`Record::read`] does, with what the file doesn't say itself.
    ///
    /// ```
    /// use teeter_record::{ReadSettings, Record};
    ///
    /// let file = "t,east,north\n0,10,0\n0.5,-20,10\n";
    /// let settings = ReadSettings { unit: Some(0.01), component: Some("east"), ..ReadSettings::default() };
    /// assert_eq!(Record::read_with(file, "both", &settings)?.accelerations(), [0.1, -0.2]);
    /// # Ok::<(), teeter_record::RecordError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Record::read`], and if something is given that the file has itself, or that doesn't
    /// apply to its format, or if there is no such component.
    pub fn read_with(file: impl AsRef<[u8]>, name: &str, settings: &ReadSettings<'_>) -> Result<Self, RecordError> {
        let bytes = file.as_ref();
        if bytes.len() > LARGEST_FILE {
            return Err(RecordError::TooLarge { bytes: bytes.len() });
        }
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let text = String::from_utf8_lossy(bytes);
        let format = Format::of(&text).map_err(|error| match binary_byte(bytes) {
            // Its bytes would say nothing.
            Some((at, byte)) if matches!(error, RecordError::Unknown { .. }) => RecordError::NotText { at, byte },
            _ => error,
        })?;
        if format != Format::Table && settings.unit.is_some() {
            return Err(RecordError::NotForFormat { what: "a unit", applies_to: "tables", format });
        }
        if matches!(format, Format::Peer | Format::Esm) && settings.component.is_some() {
            let (what, applies_to) = ("a component", "tables and COSMOS files");
            return Err(RecordError::NotForFormat { what, applies_to, format });
        }
        let record = match format {
            Format::Peer => crate::peer::read(&text)?,
            Format::Esm => crate::esm::read(&text)?,
            Format::Cosmos => crate::cosmos::read(&text, settings.component)?,
            Format::Table => crate::table::read(&text, settings)?,
        };
        match settings.step {
            Some(_) if format != Format::Table => Err(RecordError::StepTwice { format, step: record.dt }),
            _ => Ok(Self { name: name.to_owned(), ..record }),
        }
    }

    pub(crate) fn assuming_its_unit(self) -> Self {
        Self { unit_assumed: true, ..self }
    }

    /// Whether neither the file nor [`ReadSettings::unit`] gave a unit, so that m/s² was assumed.
    #[must_use]
    pub fn assumes_its_unit(&self) -> bool {
        self.unit_assumed
    }

    pub(crate) fn described(mut self, station: &str, description: &str) -> Self {
        (self.station, self.description) = (one_line(station), one_line(description));
        self
    }

    /// The record with other accelerations.
    pub(crate) fn with(&self, accelerations: Vec<f64>) -> Result<Self, RecordError> {
        let Self { name, station, description, dt, unit_assumed, .. } = self;
        let made = Self::new(name, *dt, accelerations)?;
        let (station, description) = (station.clone(), description.clone());
        Ok(Self { station, description, unit_assumed: *unit_assumed, ..made })
    }

    /// The record as a table: a heading with units, then time and acceleration. Reading it returns
    /// the same numbers.
    #[must_use]
    pub fn to_table(&self) -> String {
        let mut text = String::from("t [s],a [m/s^2]\n");
        for (k, a) in self.accelerations.iter().enumerate() {
            text.push_str(&format!("{},{a}\n", self.time(k)));
        }
        text
    }

    /// The name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The station as named in the file; may be empty.
    #[must_use]
    pub fn station(&self) -> &str {
        &self.station
    }

    /// The event and other text of the file; may be empty.
    #[must_use]
    pub fn description(&self) -> &str {
        &self.description
    }

    /// Time between two values, s.
    #[must_use]
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// The accelerations, m/s².
    #[must_use]
    pub fn accelerations(&self) -> &[f64] {
        &self.accelerations
    }

    /// Number of values, at least 2.
    #[must_use]
    pub fn len(&self) -> usize {
        self.accelerations.len()
    }

    /// Always false: a record has at least two values.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.accelerations.is_empty()
    }

    /// Time of the value with index k (from 0), s.
    #[must_use]
    pub fn time(&self, k: usize) -> f64 {
        k as f64 * self.dt
    }

    /// Time from the first value to the last, s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.time(self.accelerations.len() - 1)
    }
}

/// A header text on a single line.
fn one_line(text: &str) -> String {
    let blank = |c: char| c.is_whitespace() || c.is_control();
    text.split(blank).filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
}

/// The first byte that no text has, and its place from 0: files with one are binary.
#[must_use]
pub fn binary_byte(bytes: &[u8]) -> Option<(usize, u8)> {
    // A page break and the end of a file of old systems stand in texts, too.
    let is_text = |byte: u8| byte >= b' ' || matches!(byte, b'\t' | b'\n' | b'\r' | 0x0b | 0x0c | 0x1a);
    bytes.iter().position(|byte| !is_text(*byte)).map(|at| (at, bytes[at]))
}
