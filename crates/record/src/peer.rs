//! PEER's `.AT2`: three lines of text, one with the number of values and the step, then
//! accelerations in g, several per line.
//!
//! The line with number and step has two forms: `NPTS=  5437, DT=   .0050 SEC`, in any case and
//! spacing, with or without the unit, and in older files `5437   0.0050   NPTS, DT`.

use crate::cut::CutWatch;
use crate::error::{RecordError, shown};
use crate::format::Format;
use crate::numbers;
use crate::record::Record;
use crate::units;
use crate::{MOST_VALUES, STANDARD_GRAVITY};

/// Examples of a valid line with number and step, for messages.
const EXAMPLE: &str =
    "but the line must give both, such as `NPTS=  5437, DT=   .0050 SEC` or `5437   .0050   NPTS, DT`";

/// The velocity and displacement files of a record, by the quantity in their header.
const OTHERS: [(&str, &str); 2] = [
    ("VELOCITY", " (this is the .VT2 file: use the .AT2 file of the same record)"),
    ("DISPLACEMENT", " (this is the .DT2 file: use the .AT2 file of the same record)"),
];

pub(crate) fn read(text: &str) -> Result<Record, RecordError> {
    let mut lines = text.lines().enumerate().map(|(index, line)| (index + 1, line));
    let mut words: Vec<&str> = Vec::new();
    let mut unit = STANDARD_GRAVITY;
    let (at, numbers) = loop {
        let Some((line, text)) = lines.next() else {
            return Err(RecordError::Missing { format: Format::Peer, what: "line with NPTS and DT" });
        };
        let upper = text.to_ascii_uppercase();
        if upper.contains("NPTS") {
            break (line, upper);
        }
        if upper.contains("UNITS OF") {
            unit = unit_of(line, text, &upper)?;
        } else if !text.trim().is_empty() {
            words.push(text);
        }
    };
    let (announced, dt) = count_and_step(at, &numbers)?;
    let mut accelerations = Vec::new();
    let mut watch = CutWatch::default();
    for (line, text) in lines {
        numbers::free(line, text, |number, value| {
            if accelerations.len() == MOST_VALUES {
                return Err(RecordError::TooMany);
            }
            let scaled = value * unit;
            if !(scaled.abs() <= crate::LARGEST_ACCELERATION) {
                return Err(RecordError::Value { line, value });
            }
            accelerations.push(scaled);
            watch.add(line, number);
            Ok(())
        })?;
    }
    if accelerations.len() != announced {
        return Err(RecordError::Count { line: at, announced, found: accelerations.len() });
    }
    if let Some((line, number)) = watch.cut() {
        return Err(RecordError::CutNumber { line, number: shown(&number) });
    }
    // The first line names the database, the second event, station and component.
    let description = words.get(1).or(words.first()).copied().unwrap_or_default();
    Ok(Record::new("", dt, accelerations)?.described(station(description), description))
}

/// The unit of the values in m/s², from a line such as `ACCELERATION TIME HISTORY IN UNITS OF G`.
fn unit_of(line: usize, text: &str, upper: &str) -> Result<f64, RecordError> {
    if let Some((_, remedy)) = OTHERS.iter().find(|(quantity, _)| upper.contains(quantity)) {
        return Err(RecordError::NotAcceleration { line, found: shown(text), remedy });
    }
    let unit = upper.split("UNITS OF").nth(1).unwrap_or_default();
    let unit = unit.split_whitespace().next().unwrap_or_default().trim_end_matches(['.', ',', ';']);
    units::acceleration(line, unit)
}

fn count_and_step(line: usize, text: &str) -> Result<(usize, f64), RecordError> {
    let (count, step) = if text.contains('=') {
        (after(text, "NPTS"), after(text, "DT"))
    } else {
        let mut words = text.split(|c: char| c.is_whitespace() || c == ',').filter(|word| !word.is_empty());
        (words.next(), words.next())
    };
    let read = |word: Option<&str>, what: &str| match word {
        Some(word) => numbers::one(word).ok_or_else(|| format!("{what} is `{}`, {EXAMPLE}", shown(word))),
        None => Err(format!("{what} is missing, {EXAMPLE}")),
    };
    let both = || Ok((read(count, "NPTS")?, read(step, "DT")?));
    let (count, step) = both().map_err(|reason| RecordError::Header { line, reason })?;
    if !(count >= 0.0 && count <= MOST_VALUES as f64 && count.fract() == 0.0) {
        let reason = format!("NPTS is {count}, but must be a whole number from 2 to {MOST_VALUES}");
        return Err(RecordError::Header { line, reason });
    }
    Ok((count as usize, step))
}

/// The word after `KEY =`.
fn after<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    let mut behind = text.split(key).skip(1).filter_map(|rest| rest.trim_start().strip_prefix('='));
    let rest = behind.next()?.trim_start();
    rest.split(|c: char| c.is_whitespace() || c == ',').next().filter(|word| !word.is_empty())
}

/// The station of a line such as `EVENT 01/01/70 1200, STATION, 090 (CDMG STATION 54100)`: the part
/// before the last comma, which precedes the component.
fn station(description: &str) -> &str {
    let mut parts = description.rsplit(',');
    match (parts.next(), parts.next(), parts.next()) {
        (_, Some(station), Some(_)) => station.trim(),
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use crate::{Record, STANDARD_GRAVITY};

    const HEAD: &str = "PEER NGA STRONG MOTION DATABASE RECORD\nEvent, 10/15/1979, El Somewhere, 230\nACCELERATION TIME SERIES IN UNITS OF G\n";

    fn read(text: &str) -> Result<Record, String> {
        Record::read(text, "R").map_err(|error| error.to_string())
    }

    #[test]
    fn new_and_old_headers_give_the_same() {
        let lines = [
            "NPTS=      4, DT=   .0050 SEC,",
            "NPTS=   4, dt=  .00500",
            "npts = 4 dt = 5e-3 sec",
            "DT=.005, NPTS=4",
            "   4    .0050   NPTS, DT",
            "4, 0.005 NPTS, DT",
        ];
        for line in lines {
            let text = format!("{HEAD}{line}\n  .5 -.25E+00\n.125-.0625\n\n");
            for text in [text.clone(), text.replace('\n', "\r\n"), format!("\u{feff}{text}")] {
                let record = read(&text).unwrap();
                assert_eq!(
                    record.accelerations(),
                    [0.5, -0.25, 0.125, -0.0625].map(|g| g * STANDARD_GRAVITY),
                    "{line}"
                );
                assert_eq!((record.dt(), record.name(), record.station()), (0.005, "R", "El Somewhere"));
                assert_eq!(record.description(), "Event, 10/15/1979, El Somewhere, 230");
            }
        }
    }

    #[test]
    fn units_are_those_of_the_header() {
        let text = HEAD.replace("UNITS OF G", "UNITS OF CM/SEC**2. FILTER POINTS") + "NPTS= 2, DT= 1\n100 50\n";
        assert_eq!(read(&text).unwrap().accelerations(), [1.0, 0.5]);
        let message = read(&(HEAD.replace("OF G", "OF FURLONGS") + "NPTS= 2, DT= 1\n1 2\n")).unwrap_err();
        assert_eq!(
            message,
            "line 3: `FURLONGS` is not a known unit of acceleration: m/s^2, cm/s^2, mm/s^2, gal, g, gn"
        );
    }

    #[test]
    fn a_file_cut_within_its_last_number_is_refused() {
        let head = format!("{HEAD}NPTS= 6, DT= .01\n");
        let whole =
            format!("{head}  .1234567E-03 -.2345678E-02\n  .3456789E-03 -.4567891E-03  .1234567E-04\n -.5678912E-04");
        assert!(read(&whole).is_ok());
        for cut in 1..=10 {
            let text = &whole[..whole.len() - cut];
            for text in [text.to_owned(), format!("{text}\n")] {
                let message = read(&text).unwrap_err();
                let expected = if cut == 2 || cut == 3 { "is not a number" } else { "line 7: the last number, `-.5" };
                assert!(message.contains(expected), "{cut}: {message}");
            }
        }
        let message = read(&whole[..whole.len() - 4]).unwrap_err();
        assert!(message.contains("`-.5678912`") && message.contains("get the whole file again"), "{message}");
        // Without exponents many numbers of one form tell it.
        let fixed = |count: usize, last: &str| {
            format!("{HEAD}NPTS= {}, DT= .01\n{}{last}\n", count + 1, " 0.01234 -0.12345\n".repeat(count / 2))
        };
        assert!(read(&fixed(100, "0.01")).unwrap_err().starts_with("line 55: the last number, `0.01`, is shorter"));
        assert!(read(&fixed(100, "0.01234")).is_ok());
    }

    #[test]
    fn free_numbers_may_end_with_a_short_one() {
        let values = |values: &str| {
            let count = values.split_whitespace().count();
            read(&format!("{HEAD}NPTS= {count}, DT= .01\n{values}\n"))
        };
        for free in [
            "0.25 0.75 0.35 0.15 0.5",
            "1.25e-3 7.5e-3 -1.25e-3 2.25e-3 1.5",
            ".1234E-03 .1234E-03 .1234E-03 .1234E-03 0",
            "1.2E-03 1.4",
            ".1234 .1234E-03 .1234E-03 .1234E-03 .1234E-03 .1234E-03",
        ] {
            assert!(values(free).is_ok(), "{free}: {:?}", values(free));
        }
    }

    #[test]
    fn errors_name_the_line() {
        let message = |line: &str, values: &str| read(&format!("{HEAD}{line}\n{values}\n")).unwrap_err();
        assert_eq!(message("NPTS= 5, DT= .01", "1 2 3"), "line 4: the header announces 5 values, but the file has 3");
        assert_eq!(message("NPTS= 2, DT= .01", "1 2\n3"), "line 4: the header announces 2 values, but the file has 3");
        assert_eq!(message("NPTS= 3, DT= .01", "1 2\n\nx"), "line 7: `x` is not a number");
        assert_eq!(message("NPTS= 2, DT= 0", "1 2"), "the step is 0 s, but must be between 1e-9 s and 1e6 s");
        assert!(message("NPTS= 2.5, DT= 1", "1 2").starts_with("line 4: NPTS is 2.5, but must be a whole number"));
        assert!(message("NPTS= 1e300, DT= 1", "1 2").starts_with("line 4: NPTS is 1000"));
        assert!(message("NPTS= many, DT= 1", "1 2").starts_with("line 4: NPTS is `MANY`, but the line must give both"));
        assert!(message("NPTS= 2", "1 2").starts_with("line 4: DT is missing, but the line must give both, such as"));
        assert_eq!(message("NPTS= 1, DT= 1", "1"), "a record must have at least two values, but has 1");
        assert_eq!(
            message("NPTS= 2, DT= 1", "1 1e300"),
            "line 5: the acceleration 1e300 must be finite and at most 1e12 m/s^2 in size"
        );
        for (quantity, file) in [("VELOCITY", ".VT2"), ("DISPLACEMENT", ".DT2")] {
            let text = HEAD.replace("ACCELERATION", quantity) + "NPTS= 2, DT= 1\n1 2\n";
            let message = read(&text).unwrap_err();
            assert!(
                message.starts_with(&format!("line 3: the file contains `{quantity} TIME SERIES IN UNITS OF G`")),
                "{message}"
            );
            assert!(message.contains(file) && message.contains("use the .AT2 file of the same record"), "{message}");
        }
    }
}
