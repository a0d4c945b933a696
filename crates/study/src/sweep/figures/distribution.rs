//! The distribution of an output over an ensemble, and the comparison of several.

use super::super::spec::{Node, Reader, entries};
use super::label::{common, label};
use super::{Ensemble, SHARE_ROOM, StudyFigure, digits, text};
use crate::statistics::{KolmogorovSmirnov, share_at_most};
use crate::sweep::figures::overturning::number;
use crate::write::quoted;
use std::fmt::Write;
use teeter_plot::{Axis, AxisError, Figure, Legend, Panel, Series};
use toml::de::DeTable;

/// `[distribution]` of a sweep file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Distribution {
    /// The column.
    pub(crate) of: String,
    /// A column by whose values the cases are told apart.
    pub(crate) by: Option<String>,
    /// Larger values count as this one.
    pub(crate) at_most: Option<f64>,
    label: Option<String>,
}

const WORDS: [&str; 4] = ["of", "by", "at_most", "label"];

/// A value below this part of the largest, or of 1 in SI units, is 0 on the page and in tests: what rounding leaves of it is no motion,
/// and differs from study to study. The tables have it.
const ROUNDING: f64 = 1e-12;
const EXAMPLE: &str = "such as of = \"max_phi_over_alpha\", at_most = 1";

impl Distribution {
    pub(super) fn read(reader: &mut Reader<'_>, table: &DeTable<'_>, node: &Node<'_, '_>) -> Option<Self> {
        let (mut of, mut by, mut at_most, mut label) = (None, None, None, None);
        for (word, value) in entries(table) {
            let path = format!("distribution.{word}");
            match word {
                "of" => of = Some(text(reader, &path, &value, EXAMPLE)?),
                "by" => by = Some(text(reader, &path, &value, EXAMPLE)?),
                "label" => label = Some(text(reader, &path, &value, EXAMPLE)?),
                "at_most" => at_most = Some(number(reader, &path, &value, EXAMPLE)?),
                other => {
                    reader.unknown(&path, &value, other, &WORDS);
                    return None;
                }
            }
        }
        let Some(of) = of else {
            reader.wrong("distribution.of", Some(node), "missing: of which column?", EXAMPLE);
            return None;
        };
        Some(Self { of, by, at_most, label })
    }

    fn label(&self, study: &Ensemble) -> String {
        self.label.clone().unwrap_or_else(|| label(&study.sweep, &self.of))
    }
}

/// The values of a study, ascending, by the cell of another column; in the order in which these
/// cells come.
struct Samples {
    by: Vec<(String, Vec<f64>)>,
    /// Cases without a number.
    without: usize,
}

impl Samples {
    fn of(study: &Ensemble, asked: &Distribution) -> Self {
        let values = study.table.numbers(&asked.of);
        let cells = asked.by.as_ref().map(|column| study.table.completed(column));
        let (mut by, mut without): (Vec<(String, Vec<f64>)>, usize) = (Vec::new(), 0);
        for (k, value) in values.into_iter().enumerate() {
            if !value.is_finite() {
                without += 1;
                continue;
            }
            let value = asked.at_most.map_or(value, |most| value.min(most));
            let cell = cells.as_ref().and_then(|cells| cells.get(k)).copied().unwrap_or_default();
            match by.iter_mut().find(|(name, _)| name == cell) {
                Some((_, sample)) => sample.push(value),
                None => by.push((cell.to_owned(), vec![value])),
            }
        }
        by.iter_mut().for_each(|(_, sample)| sample.sort_by(f64::total_cmp));
        Self { by, without }
    }
}

/// The figure of one study, or of several side by side with tests against the first.
pub(super) fn figure(studies: &[Ensemble]) -> Result<StudyFigure, AxisError> {
    let asked: Vec<&Distribution> =
        studies.iter().filter_map(|study| study.sweep.wanted().distribution.as_ref()).collect();
    let samples: Vec<Samples> = studies.iter().zip(&asked).map(|(study, asked)| Samples::of(study, asked)).collect();
    let each = || asked.iter().zip(studies);
    let label_of_axis = common(&each().map(|(asked, study)| asked.label(study)).collect::<Vec<_>>());
    let by = |(asked, study): (&&Distribution, &Ensemble)| Some(label(&study.sweep, asked.by.as_deref()?));
    let by_label =
        Some(each().filter_map(by).collect::<Vec<_>>()).filter(|all| !all.is_empty()).map(|all| common(&all));
    let all = samples.iter().flat_map(|of| &of.by).flat_map(|(_, sample)| sample.iter().copied());
    let axis = Axis::linear(&label_of_axis, all)?;
    let end = axis.ends().1;
    let (mut table, mut rows, mut notes) = ("study,by,value,share\n".to_owned(), Vec::new(), Vec::new());
    let mut series = Vec::new();
    let largest =
        samples.iter().flat_map(|of| &of.by).flat_map(|(_, sample)| sample).fold(0.0, |most: f64, x| most.max(x.abs()));
    let rounding = ROUNDING * largest.max(1.0);
    let cell = |value: &str| value.parse::<f64>().map_or_else(|_| value.to_owned(), digits);
    for (number, (study, of)) in studies.iter().zip(&samples).enumerate() {
        for (place, (by, sample)) in of.by.iter().enumerate() {
            let mut points = vec![(axis.ends().0, 0.0)];
            for value in sample {
                let share = share_at_most(sample, *value);
                points.push((*value, share));
                let _ = writeln!(table, "{},{},{value:?},{share:?}", quoted(&study.name), quoted(by));
            }
            let name = [study.name.clone(), cell(by)].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>();
            let line = Series::staircase(name.join(", "), points, end);
            // The colour tells the samples apart, the dash the studies.
            let of_several = if studies.len() > 1 { place % 7 + 7 * number } else { place };
            series.push(line.number(if of.by.len() > 1 { of_several } else { number }));
            let quantile = |share: f64| {
                let place = (share * sample.len() as f64).ceil().max(1.0) as usize - 1;
                sample.get(place).copied().map_or_else(String::new, |x| digits(above(rounding, x)))
            };
            rows.push(vec![
                study.name.clone(),
                cell(by),
                sample.len().to_string(),
                quantile(0.16),
                quantile(0.5),
                quantile(0.84),
                quantile(1.0),
            ]);
        }
        if of.without > 0 {
            notes.push(study.left_out(of.without, "a number"));
        }
        if study.table.incomplete() > 0 {
            notes.push(study.left_out(study.table.incomplete(), "a result"));
        }
    }
    let mut tests = "study,against,by,distance,p_value,cases,cases_against\n".to_owned();
    if let (Some((first, rest)), Some(study)) = (samples.split_first(), studies.first()) {
        for (other, of) in studies.iter().skip(1).zip(rest) {
            for (by, sample) in &of.by {
                let Some((_, own)) = first.by.iter().find(|(name, _)| name == by) else { continue };
                let Some(KolmogorovSmirnov { distance, p_value }) = tested(own, sample, rounding) else {
                    continue;
                };
                let _ = writeln!(
                    tests,
                    "{},{},{},{distance:?},{p_value:?},{},{}",
                    quoted(&other.name),
                    quoted(&study.name),
                    quoted(by),
                    sample.len(),
                    own.len()
                );
                let at = if by.is_empty() {
                    String::new()
                } else {
                    format!(", {} = {}", by_label.as_deref().unwrap_or_default(), cell(by))
                };
                let says = if p_value < 0.05 {
                    "the distributions differ at the level of 5 %"
                } else {
                    "no difference is seen at the level of 5 %"
                };
                notes.push(format!(
                    "`{}` against `{}`{at}: {says} (largest distance {}, Kolmogorov–Smirnov p = {}).",
                    other.name,
                    study.name,
                    digits(distance),
                    digits(p_value)
                ));
            }
        }
        if !rest.is_empty() {
            notes.push(
                "The p-value is exact for independent samples without ties; with ties, as of values cut at a limit, and for \
                 runs with the same records in both studies, the true one is smaller."
                    .to_owned(),
            );
        }
    }
    if let Some(most) = asked.first().and_then(|asked| asked.at_most) {
        notes.push(format!("Values above {} count as {0}.", digits(most)));
    }
    let title = format!("Distribution: {label_of_axis}");
    let shares = Axis::between("Share of cases at or below", -SHARE_ROOM, 1.0 + SHARE_ROOM);
    let panel = Panel::new(shares).with(series).telling_apart().note(by_label.clone());
    let mut tables = vec![("distribution.csv", table)];
    if studies.len() > 1 {
        tables.push(("distribution_tests.csv", tests));
    }
    Ok(StudyFigure {
        name: "distribution",
        figure: Figure::new("distribution", title.clone(), axis).legend(Legend::Rows).panel(panel),
        title,
        more: Vec::new(),
        tables,
        notes,
        summary: (
            ["Study", &by_label.unwrap_or_default(), "Cases", "16 %", "Median", "84 %", "Largest"]
                .map(str::to_owned)
                .into(),
            rows,
        ),
    })
}

/// A value, 0 where it is below rounding.
fn above(rounding: f64, x: f64) -> f64 {
    if x.abs() < rounding { 0.0 } else { x }
}

/// The test of two samples without their rounding.
fn tested(own: &[f64], sample: &[f64], rounding: f64) -> Option<KolmogorovSmirnov> {
    let [own, sample] = [own, sample].map(|of| of.iter().map(|x| above(rounding, *x)).collect::<Vec<_>>());
    KolmogorovSmirnov::of(&own, &sample)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_of_what_stands_still_is_no_difference() {
        let test = tested(&[3.573e-15; 20], &[3.667e-15; 20], ROUNDING).unwrap();
        assert_eq!((test.distance, test.p_value), (0.0, 1.0));
    }
}
