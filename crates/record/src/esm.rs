//! ESM's ASCII files (also called DYNA): usually 64 lines `KEY: value`, then one acceleration per
//! line.

use crate::MOST_VALUES;
use crate::error::{RecordError, shown};
use crate::format::Format;
use crate::numbers;
use crate::record::Record;
use crate::units;

/// By how much a header's peak or duration may differ from the values', as a part of them, and a peak also in m/s².
const ROUNDED: f64 = 1e-2;
const LAST_DIGIT: f64 = 1e-5;

/// What a header says of the values.
#[derive(Clone, Copy)]
struct Stated<'a> {
    line: usize,
    /// The unit of the value, in SI units.
    unit: f64,
    value: &'a str,
}

/// The entries of a header that are used.
#[derive(Default)]
struct EsmHeader<'a> {
    count: Option<(usize, usize)>,
    step: Option<f64>,
    unit: Option<f64>,
    /// What it says of the values, for comparison.
    peak: Option<Stated<'a>>,
    duration: Option<Stated<'a>>,
    network: &'a str,
    station: &'a str,
    station_name: &'a str,
    event: &'a str,
    date: &'a str,
    stream: &'a str,
}

impl<'a> EsmHeader<'a> {
    fn take(&mut self, line: usize, key: &str, value: &'a str) -> Result<(), RecordError> {
        let number = || {
            let reason = format!("{key} is `{}`, but must be a number", shown(value));
            numbers::one(value).ok_or(RecordError::Header { line, reason })
        };
        match key {
            "NDATA" => {
                let count = number()?;
                if !(count >= 0.0 && count <= MOST_VALUES as f64 && count.fract() == 0.0) {
                    let reason = format!("NDATA is {count}, but must be a whole number from 2 to {MOST_VALUES}");
                    return Err(RecordError::Header { line, reason });
                }
                self.count = Some((line, count as usize));
            }
            "SAMPLING_INTERVAL_S" => self.step = Some(number()?),
            "DATA_TYPE" if !value.eq_ignore_ascii_case("ACCELERATION") => {
                return Err(RecordError::NotAcceleration { line, found: shown(value), remedy: "" });
            }
            "UNITS" => self.unit = Some(units::acceleration(line, value)?),
            "DURATION_S" => self.duration = Some(Stated { line, unit: 1.0, value }),
            "PGA_CM/S^2" => self.peak = Some(Stated { line, unit: 0.01, value }),
            "PGA_M/S^2" => self.peak = Some(Stated { line, unit: 1.0, value }),
            "NETWORK" => self.network = value,
            "STATION_CODE" => self.station = value,
            "STATION_NAME" => self.station_name = value,
            "EVENT_NAME" => self.event = value,
            "EVENT_DATE_YYYYMMDD" => self.date = value,
            "STREAM" => self.stream = value,
            _ => {}
        }
        Ok(())
    }

    /// Refuses values that the header contradicts: by their peak, or their duration. An entry that is empty, or no number, says
    /// nothing; both are rounded, and a duration may or may not count the last interval.
    fn check(&self, record: &Record) -> Result<(), RecordError> {
        let stated = |entry: Option<Stated<'a>>| entry.and_then(|of| Some((of, numbers::one(of.value)?)));
        let largest = record.accelerations().iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
        if let Some((Stated { line, unit, .. }, peak)) = stated(self.peak)
            && !((peak.abs() * unit - largest).abs() <= ROUNDED * largest + LAST_DIGIT)
        {
            let found = largest / unit;
            let reason = format!("the header gives a peak of {peak}, but the largest of the values is {found}");
            return Err(RecordError::Header { line, reason });
        }
        let (count, step) = (record.accelerations().len(), record.dt());
        let duration = step * count as f64;
        if let Some((Stated { line, .. }, stated)) = stated(self.duration)
            && !((stated - duration).abs() <= 1.5 * step + ROUNDED * duration)
        {
            let reason = format!(
                "the header gives a duration of {stated} s, but its {count} values at {step} s take {duration} s"
            );
            return Err(RecordError::Header { line, reason });
        }
        Ok(())
    }

    fn station(&self) -> String {
        let code =
            [self.network, self.station].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(".");
        if self.station_name.is_empty() { code } else { format!("{code} {}", self.station_name) }
    }

    fn description(&self) -> String {
        let parts = [self.event, self.date, self.stream];
        parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
    }
}

pub(crate) fn read(text: &str) -> Result<Record, RecordError> {
    let mut header = EsmHeader::default();
    let mut values: Vec<(usize, f64)> = Vec::new();
    for (index, text) in text.lines().enumerate() {
        let (line, text) = (index + 1, text.trim());
        if text.is_empty() {
            continue;
        }
        if let Some((key, value)) = text.split_once(':').filter(|_| values.is_empty()) {
            header.take(line, key.trim(), value.trim())?;
            continue;
        }
        if values.len() == MOST_VALUES {
            return Err(RecordError::TooMany);
        }
        let hint = if text.contains(char::is_whitespace) { "; an ESM file has one value per line" } else { "" };
        let bad = RecordError::Number { line, text: shown(text), hint };
        values.push((line, numbers::one(text).ok_or(bad)?));
    }
    let missing = |what| RecordError::Missing { format: Format::Esm, what };
    let (at, announced) = header.count.ok_or(missing("NDATA"))?;
    let step = header.step.ok_or(missing("SAMPLING_INTERVAL_S"))?;
    let unit = header.unit.ok_or(missing("UNITS"))?;
    if values.len() != announced {
        return Err(RecordError::Count { line: at, announced, found: values.len() });
    }
    let mut accelerations = Vec::with_capacity(values.len());
    for (line, value) in values {
        if !((value * unit).abs() <= crate::LARGEST_ACCELERATION) {
            return Err(RecordError::Value { line, value });
        }
        accelerations.push(value * unit);
    }
    let record = Record::new("", step, accelerations)?;
    header.check(&record)?;
    Ok(record.described(&header.station(), &header.description()))
}

#[cfg(test)]
mod tests {
    use crate::Record;

    const FILE: &str = "EVENT_NAME: None\nEVENT_DATE_YYYYMMDD: 20000823\nHYPOCENTER_REFERENCE: ISC: webservice\nNETWORK: XX\n\
        STATION_CODE: 1001\nSTATION_NAME:\nSAMPLING_INTERVAL_S: 0.005000\nNDATA: 3\nSTREAM: HNE\nUNITS: cm/s^2\n\
        DATABASE_VERSION: 0.5\nHEADER_FORMAT: DYNA 1.2\nDATA_TYPE: ACCELERATION\nUSER5:\n-1.5\n 25.0E+00\n0.000125\n";

    fn read(text: &str) -> Result<Record, String> {
        Record::read(text, "R").map_err(|error| error.to_string())
    }

    #[test]
    fn header_and_values_are_read() {
        for text in [FILE.to_owned(), FILE.replace('\n', "\r\n")] {
            let record = read(&text).unwrap();
            assert_eq!(record.accelerations(), [-1.5 * 0.01, 25.0 * 0.01, 0.000_125 * 0.01]);
            assert_eq!((record.dt(), record.station()), (0.005, "XX.1001"));
            assert_eq!(record.description(), "None, 20000823, HNE");
        }
        assert_eq!(read(&FILE.replace("cm/s^2", "m/s^2")).unwrap().accelerations()[1], 25.0);
    }

    #[test]
    fn errors_name_the_line() {
        let message = |from: &str, to: &str| read(&FILE.replace(from, to)).unwrap_err();
        assert_eq!(message("NDATA: 3", "NDATA: 4"), "line 8: the header announces 4 values, but the file has 3");
        assert_eq!(message("NDATA: 3", "NDATA: few"), "line 8: NDATA is `few`, but must be a number");
        assert!(message("NDATA: 3", "NDATA: -3").starts_with("line 8: NDATA is -3, but must be a whole number from 2"));
        assert_eq!(message("NDATA: 3\n", ""), "this ESM file has no NDATA in its header");
        assert_eq!(
            message("SAMPLING_INTERVAL_S: 0.005000\n", ""),
            "this ESM file has no SAMPLING_INTERVAL_S in its header"
        );
        assert_eq!(message("UNITS: cm/s^2\n", ""), "this ESM file has no UNITS in its header");
        let told = |entry: &str| read(&FILE.replace("USER5:", entry)).unwrap_err();
        assert_eq!(
            told("PGA_CM/S^2: 8.000"),
            "line 14: the header gives a peak of 8, but the largest of the values is 25"
        );
        assert_eq!(
            told("DURATION_S: 9.025"),
            "line 14: the header gives a duration of 9.025 s, but its 3 values at 0.005 s take 0.015 s"
        );
        for fits in [
            "PGA_CM/S^2: -25.000",
            "PGA_CM/S^2: 25.002",
            "PGA_M/S^2: 0.25",
            "PGA_CM/S^2:",
            "DURATION_S: 0.01",
            "DURATION_S: 0.015",
        ] {
            assert!(read(&FILE.replace("USER5:", fits)).is_ok(), "{fits}");
        }
        assert!(message("cm/s^2", "cm/s").starts_with("line 10: `cm/s` is not a known unit of acceleration: m/s^2, "));
        assert_eq!(
            message(": ACCELERATION", ": VELOCITY"),
            "line 13: the file contains `VELOCITY`, but a record is an acceleration"
        );
        assert_eq!(
            message("-1.5\n", "-1.5 2\n"),
            "line 15: `-1.5 2` is not a number; an ESM file has one value per line"
        );
        assert_eq!(message("0.000125", "0.0001x"), "line 17: `0.0001x` is not a number");
    }
}
