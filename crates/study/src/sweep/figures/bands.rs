//! Bands of a motion over an ensemble: what remains to be said of it beyond the horizon of a single run.

use super::super::counted;
use super::super::output::Output;
use super::super::spec::{Node, Reader, entries};
use super::label::{common, quantity};
use super::{Ensemble, StudyFigure, digits, text};
use crate::write::quoted;
use std::fmt::Write;
use teeter_plot::{Axis, AxisError, Figure, Legend, Panel, Series};
use teeter_scenario::dimension::Dimension;
use toml::de::DeTable;

/// `[bands]` of a sweep file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Bands {
    /// The column of `trajectory.csv`.
    pub(crate) of: String,
    /// The last time, s.
    until: f64,
    /// How many times after t = 0.
    count: u32,
    label: Option<String>,
}

const WORDS: [&str; 4] = ["of", "until", "times", "label"];
const EXAMPLE: &str = "such as of = \"rocker.phi\", until = \"5 s\", times = 100";
/// Times if none are given, and the most.
const TIMES: u32 = 100;
const MOST_TIMES: u32 = 1000;
/// The shares of the cases below the lines of the table.
const SHARES: [f64; 5] = [0.025, 0.16, 0.5, 0.84, 0.975];
/// Fewer cases than this have none outside a band of 95 %.
const FEWEST: usize = 40;

impl Bands {
    pub(super) fn read(reader: &mut Reader<'_>, table: &DeTable<'_>, node: &Node<'_, '_>) -> Option<Self> {
        let (mut of, mut until, mut count, mut label) = (None, None, TIMES, None);
        for (word, value) in entries(table) {
            let path = format!("bands.{word}");
            match word {
                "of" => of = Some(text(reader, &path, &value, EXAMPLE)?),
                "label" => label = Some(text(reader, &path, &value, EXAMPLE)?),
                "until" => match value.text().map(|time| teeter_scenario::quantity::parse(time, Dimension::TIME)) {
                    Some(Ok(time)) if time > 0.0 => until = Some(time),
                    Some(Err(error)) => {
                        reader.wrong(&path, Some(&value), &error.to_string(), EXAMPLE);
                        return None;
                    }
                    _ => {
                        reader.wrong(&path, Some(&value), "a time after 0 is expected, with its unit", EXAMPLE);
                        return None;
                    }
                },
                "times" => match value.whole().and_then(|times| u32::try_from(times).ok()) {
                    Some(times) if (1..=MOST_TIMES).contains(&times) => count = times,
                    _ => {
                        let rule = format!("a number of times from 1 to {MOST_TIMES} is expected");
                        reader.wrong(&path, Some(&value), &rule, EXAMPLE);
                        return None;
                    }
                },
                other => {
                    reader.unknown(&path, &value, other, &WORDS);
                    return None;
                }
            }
        }
        for (word, is_missing) in [("of", of.is_none()), ("until", until.is_none())] {
            if is_missing {
                reader.wrong(&format!("bands.{word}"), Some(node), "missing", EXAMPLE);
            }
        }
        Some(Self { of: of?, until: until?, count, label })
    }

    /// The times, s: the shortest numbers that are equal parts of the last one but for rounding.
    fn times(&self) -> impl Iterator<Item = f64> + '_ {
        (0..=self.count).map(|k| {
            let time = self.until * f64::from(k) / f64::from(self.count);
            format!("{time:.12e}").parse().unwrap_or(time)
        })
    }

    fn name(&self, t: f64) -> String {
        format!("{}@{t}", self.of)
    }

    /// The values at the times are outputs.
    pub(crate) fn outputs(&self) -> impl Iterator<Item = Output> + '_ {
        self.times().map(|t| Output::at(self.name(t), &self.of, t))
    }

    fn label(&self) -> String {
        self.label.clone().unwrap_or_else(|| quantity(&self.of))
    }
}

/// The value below which this share of an ascending sample lies, linear between its values.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = share * (sorted.len() as f64 - 1.0);
    let (low, high) = (place.floor() as usize, place.ceil() as usize);
    match (sorted.get(low), sorted.get(high)) {
        (Some(a), Some(b)) => a + (b - a) * (place - place.floor()),
        _ => f64::NAN,
    }
}

/// A time, and the values of which the shares of the cases are below.
struct Row {
    t: f64,
    cases: usize,
    below: [f64; SHARES.len()],
}

fn rows(study: &Ensemble, asked: &Bands) -> Vec<Row> {
    let at = |t: f64| {
        let mut values = study.table.numbers(&asked.name(t));
        values.retain(|value| value.is_finite());
        values.sort_by(f64::total_cmp);
        let row = Row { t, cases: values.len(), below: SHARES.map(|share| quantile(&values, share)) };
        (!values.is_empty()).then_some(row)
    };
    asked.times().filter_map(at).collect()
}

/// How many of the cases the bands are of at their end, and from when on some are missing; `None` if none is. `until` is the last time asked
/// for, at which no case may be left.
fn survivors(rows: &[Row], until: Option<f64>) -> Option<String> {
    let most = rows.iter().map(|row| row.cases).max()?;
    let last = rows.last()?;
    let fewer = rows.iter().find(|row| row.cases < most);
    let end = until.filter(|until| *until > last.t);
    let from = fewer.map(|row| row.t).or(end)?;
    let left = if end.is_some() { 0 } else { last.cases };
    Some(format!("from t = {} s on fewer than all {}, {left} at the end", digits(from), counted(most as u64)))
}

/// The figure of one study, or of several side by side.
pub(super) fn figure(studies: &[Ensemble]) -> Result<StudyFigure, AxisError> {
    let asked: Vec<&Bands> = studies.iter().filter_map(|study| study.sweep.wanted().bands.as_ref()).collect();
    let all: Vec<Vec<Row>> = studies.iter().zip(&asked).map(|(study, asked)| rows(study, asked)).collect();
    let label = common(&asked.iter().map(|asked| asked.label()).collect::<Vec<_>>());
    let x = Axis::linear("t (s)", all.iter().flatten().map(|row| row.t))?;
    let y = Axis::linear(&label, all.iter().flatten().flat_map(|row| row.below))?;
    let mut table = "study,t,cases,p2.5,p16,median,p84,p97.5\n".to_owned();
    let (mut series, mut summary, mut notes) = (Vec::new(), Vec::new(), Vec::new());
    let mut captions: Vec<String> = Vec::new();
    for (number, (study, rows)) in studies.iter().zip(&all).enumerate() {
        for Row { t, cases, below } in rows {
            let _ = write!(table, "{},{t:?},{cases}", quoted(&study.name));
            below.iter().for_each(|value| {
                let _ = write!(table, ",{value:?}");
            });
            table.push('\n');
        }
        for (low, high) in [(0, 4), (1, 3)] {
            let band = rows.iter().map(|row| (row.t, row.below[low], row.below[high]));
            series.push(Series::area("", band.collect::<Vec<_>>()).number(number));
        }
        let median = rows.iter().map(|row| (row.t, row.below[2])).collect::<Vec<_>>();
        let name = if study.name.is_empty() { "median".to_owned() } else { study.name.clone() };
        series.push(Series::line(name, median).number(number));
        let width = |row: &Row| row.below[4] - row.below[0];
        let widest = rows.iter().max_by(|a, b| width(a).total_cmp(&width(b)));
        if let (Some(last), Some(widest)) = (rows.last(), widest) {
            let at_end = rows.iter().map(|row| row.cases).max().filter(|most| last.cases < *most);
            summary.push(vec![
                study.name.clone(),
                rows.iter().map(|row| row.cases).max().unwrap_or(0).to_string(),
                at_end.map_or_else(String::new, |_| last.cases.to_string()),
                digits(width(widest)),
                digits(widest.t),
                digits(width(last)),
                digits(last.t),
            ]);
            if last.cases < FEWEST {
                notes.push(study.about(&format!(
                    "{}: the band of 95 % goes nearly from the least to the largest of them; {FEWEST} or more have some outside it.",
                    counted(last.cases as u64)
                )));
            }
        }
        if let Some(survivors) = survivors(rows, asked[number].times().last()) {
            notes.push(study.about(&format!(
                "{survivors}. Those that ended before, as by `time.stop`, are not in the bands from then on: these are of the others alone."
            )));
            captions.push(if study.name.is_empty() { survivors } else { format!("{}: {survivors}", study.name) });
        }
        if study.table.incomplete() > 0 {
            notes.push(study.left_out(study.table.incomplete(), "a result"));
        }
    }
    notes.push(
        "Outer band: the middle 95 % of the cases at each time; inner band: the middle 68 %; line: median. A single run is predictable up to \
         its horizon (`teeter run --horizon`); what the cases have in common is, beyond it, too."
            .to_owned(),
    );
    let title = format!("Bands: {label}");
    let panel = Panel::new(y).with(series).note((!captions.is_empty()).then(|| captions.join("; ")));
    Ok(StudyFigure {
        name: "bands",
        figure: Figure::new("bands", title.clone(), x).legend(Legend::Rows).panel(panel),
        title,
        more: Vec::new(),
        tables: vec![("bands.csv", table)],
        notes,
        summary: (
            ["Study", "Cases", "Cases at the end", "Largest width of 95 %", "at t (s)", "Width at the end", "t (s)"]
                .map(str::to_owned)
                .into(),
            summary,
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quantile_lies_between_the_values_beside_it() {
        let values: Vec<f64> = (0..=40).map(f64::from).collect();
        assert_eq!(quantile(&values, 0.025), 1.0);
        assert_eq!(quantile(&values, 0.5), 20.0);
        assert_eq!(quantile(&[1.0, 2.0], 0.25), 1.25);
        assert_eq!(quantile(&[3.0], 0.975), 3.0);
        assert!(quantile(&[], 0.5).is_nan());
    }

    #[test]
    fn bands_past_the_end_of_some_cases_say_so() {
        let rows = |cases: &[usize]| -> Vec<Row> {
            cases.iter().enumerate().map(|(k, cases)| Row { t: k as f64, cases: *cases, below: [0.0; 5] }).collect()
        };
        assert_eq!(survivors(&rows(&[40, 40, 40]), Some(2.0)), None);
        let told = |cases: &[usize], until| survivors(&rows(cases), Some(until)).unwrap();
        assert_eq!(told(&[40, 40, 38, 9], 3.0), "from t = 2 s on fewer than all 40 cases, 9 at the end");
        assert_eq!(told(&[40, 40], 2.0), "from t = 2 s on fewer than all 40 cases, 0 at the end");
    }

    #[test]
    fn times_are_parts_of_the_last_one() {
        let bands = Bands { of: "b.phi".to_owned(), until: 0.3, count: 3, label: None };
        assert_eq!(bands.times().collect::<Vec<_>>(), [0.0, 0.1, 0.2, 0.3]);
        assert_eq!(bands.outputs().last().map(|output| output.name().to_owned()).as_deref(), Some("b.phi@0.3"));
    }
}
