//! Maps of overturning over two keys.

use super::super::criterion::Criterion;
use super::super::spec::{Node, Reader, entries};
use super::{Ensemble, StudyFigure, axis_label, text};
use std::fmt::Write;
use teeter_plot::{Axis, AxisError, Figure, Legend, Panel, Series};
use toml::de::DeTable;

/// `[overturning]` of a sweep file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Overturning {
    pub(crate) event: Criterion,
    /// The columns of the axes.
    pub(crate) x: String,
    pub(crate) y: String,
    /// A column by which events are told apart, such as the number of impacts before.
    pub(crate) by: Option<String>,
    labels: [Option<String>; 2],
    by_label: Option<String>,
}

const WORDS: [&str; 7] = ["event", "x", "y", "by", "x_label", "y_label", "by_label"];
const EXAMPLE: &str = "such as x = \"signal.shake.frequency\", y = \"signal.shake.scale\", event = \"overturned\"";

/// Kinds of events that have a colour of their own; the others share the last.
const MOST_KINDS: usize = 6;

impl Overturning {
    pub(super) fn read(reader: &mut Reader<'_>, table: &DeTable<'_>, node: &Node<'_, '_>) -> Option<Self> {
        let (mut event, mut x, mut y, mut by) = (None, None, None, None);
        let (mut labels, mut by_label) = ([None, None], None);
        for (word, value) in entries(table) {
            let path = format!("overturning.{word}");
            let word_text = |reader: &mut Reader<'_>| text(reader, &path, &value, EXAMPLE);
            match word {
                "event" => event = Some(Criterion::read(reader, &path, &value)?),
                "x" => x = Some(word_text(reader)?),
                "y" => y = Some(word_text(reader)?),
                "by" => by = Some(word_text(reader)?),
                "x_label" => labels[0] = Some(word_text(reader)?),
                "y_label" => labels[1] = Some(word_text(reader)?),
                "by_label" => by_label = Some(word_text(reader)?),
                other => {
                    reader.unknown(&path, &value, other, &WORDS);
                    return None;
                }
            }
        }
        let (Some(event), Some(x), Some(y)) = (event, x, y) else {
            reader.wrong("overturning", Some(node), "event, x and y belong together", EXAMPLE);
            return None;
        };
        Some(Self { event, x, y, by, labels, by_label })
    }

    fn label(&self, place: usize) -> String {
        let column = [&self.x, &self.y][place];
        self.labels[place].clone().unwrap_or_else(|| axis_label(column))
    }
}

/// A number under a word of a table, in SI units.
pub(super) fn number(reader: &mut Reader<'_>, path: &str, node: &Node<'_, '_>, remedy: &str) -> Option<f64> {
    let written = reader.written(node).replace('_', "");
    let number = written.parse::<f64>().ok().filter(|number| number.is_finite());
    if number.is_none() {
        reader.wrong(path, Some(node), "a number is expected", remedy);
    }
    number
}

/// The smallest distance between neighbouring values: the side of a cell.
fn spacing(values: &[f64]) -> f64 {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let range = sorted.last().copied().unwrap_or(0.0) - sorted.first().copied().unwrap_or(0.0);
    let apart = sorted.windows(2).map(|pair| pair[1] - pair[0]).filter(|apart| *apart > 1e-9 * range);
    apart.reduce(f64::min).unwrap_or(1.0)
}

/// The figure of a study.
pub(super) fn figure(study: &Ensemble, asked: &Overturning) -> Result<StudyFigure, AxisError> {
    let event = study.table.completed(asked.event.column(study.sweep.outputs()).unwrap_or_default());
    let (xs, ys) = (study.table.numbers(&asked.x), study.table.numbers(&asked.y));
    let kinds = asked.by.as_ref().map(|column| study.table.completed(column));
    let mut table = format!("x,y,event{}\n", if kinds.is_some() { ",by" } else { "" });
    let mut groups: Vec<(String, Vec<(f64, f64)>)> = Vec::new();
    let (mut events, mut cases) = (0_usize, 0_usize);
    for k in 0..event.len() {
        let (x, y) = (xs[k], ys[k]);
        let Some(holds) = asked.event.holds(event[k]).filter(|_| x.is_finite() && y.is_finite()) else { continue };
        cases += 1;
        events += usize::from(holds);
        let kind = kinds.as_ref().and_then(|kinds| kinds.get(k)).copied().unwrap_or_default();
        let told = if kinds.is_some() { format!(",{}", crate::write::quoted(kind)) } else { String::new() };
        let _ = writeln!(table, "{x:?},{y:?},{}{told}", if holds { "yes" } else { "no" });
        if !holds {
            continue;
        }
        match groups.iter_mut().find(|(name, _)| name == kind) {
            Some((_, points)) => points.push((x, y)),
            None => groups.push((kind.to_owned(), vec![(x, y)])),
        }
    }
    let order = |name: &str| name.parse::<f64>().unwrap_or(f64::INFINITY);
    groups.sort_by(|a, b| order(&a.0).total_cmp(&order(&b.0)).then(a.0.cmp(&b.0)));
    let sides = [spacing(&xs), spacing(&ys)];
    let ends = |values: &[f64], side: f64| {
        let finite = || values.iter().copied().filter(|x| x.is_finite());
        let (low, high) = (finite().reduce(f64::min).unwrap_or(0.0), finite().reduce(f64::max).unwrap_or(1.0));
        (low - 0.5 * side, high + 0.5 * side)
    };
    let ((left, right), (bottom, top)) = (ends(&xs, sides[0]), ends(&ys, sides[1]));
    let (x, y) = (Axis::between(asked.label(0), left, right), Axis::between(asked.label(1), bottom, top));
    let mut rows = Vec::new();
    let mut series: Vec<Series> = Vec::new();
    let mut rest: Vec<(f64, f64)> = Vec::new();
    for (number, (kind, points)) in groups.into_iter().enumerate() {
        let by = asked.by_label.clone().or_else(|| asked.by.clone()).unwrap_or_default();
        let name = if asked.by.is_some() { format!("{by} {kind}") } else { asked.event.words() };
        rows.push(vec![name.clone(), points.len().to_string()]);
        if number < MOST_KINDS {
            series.push(Series::cells(name, points, sides).number(number));
        } else {
            rest.extend(points);
        }
    }
    if !rest.is_empty() {
        series.push(Series::cells("others", rest, sides).number(MOST_KINDS));
    }
    let mut notes = vec![format!("{events} of {cases} cases: {}.", asked.event.words())];
    if study.table.incomplete() > 0 {
        notes.push(format!("{} cases without a result are left blank, too.", study.table.incomplete()));
    }
    let title = format!("Where the event `{}` comes", asked.event.words());
    let panel = Panel::new(y).with(series).height_mm(80.0);
    Ok(StudyFigure {
        name: "overturning",
        figure: Figure::new("overturning", title.clone(), x).legend(Legend::Rows).panel(panel),
        title,
        more: Vec::new(),
        tables: vec![("overturning.csv", table)],
        notes,
        summary: (vec!["Event", "Cases"], rows),
    })
}
