//! Maps of overturning over two keys.

use super::super::counted;
use super::super::criterion::Criterion;
use super::super::spec::{Node, Reader, entries};
use super::label::label;
use super::{Ensemble, StudyFigure, text};
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

    fn label(&self, place: usize, study: &Ensemble) -> String {
        let column = [&self.x, &self.y][place];
        self.labels[place].clone().unwrap_or_else(|| label(&study.sweep, column))
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

/// The values along an axis of the map, and the edges of the cells about them: half-way to the
/// neighbours, so that cells of uneven values touch, too.
struct Spread {
    values: Vec<f64>,
    edges: Vec<f64>,
    logarithmic: bool,
}

impl Spread {
    fn of(values: &[f64]) -> Self {
        let mut sorted: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let range = sorted.last().copied().unwrap_or(0.0) - sorted.first().copied().unwrap_or(0.0);
        // Values apart by rounding are one.
        sorted.dedup_by(|next, kept| *next - *kept <= 1e-9 * range);
        // Values are spaced by a factor if their logarithms lie more evenly than they do.
        let unevenness = |of: fn(f64) -> f64| {
            let apart = sorted.windows(2).map(|pair| of(pair[1]) - of(pair[0]));
            apart.clone().fold(0.0, f64::max) / apart.fold(f64::INFINITY, f64::min)
        };
        let positive = sorted.len() > 2 && sorted.first().is_some_and(|least| *least > 0.0);
        let logarithmic = positive && unevenness(f64::ln) < (1.0 - 1e-6) * unevenness(|x| x);
        let to = |x: f64| if logarithmic { x.ln() } else { x };
        let middles: Vec<f64> = sorted.windows(2).map(|pair| 0.5 * (to(pair[0]) + to(pair[1]))).collect();
        // The first and the last cell reach as far outwards as inwards; a single one is 1 wide.
        let mirrored = |end: Option<&f64>, middle: Option<&f64>, alone: f64| {
            let end = end.map_or(0.0, |end| to(*end));
            middle.map_or(end + alone, |middle| 2.0 * end - middle)
        };
        let mut edges = vec![mirrored(sorted.first(), middles.first(), -0.5)];
        edges.extend(&middles);
        edges.push(mirrored(sorted.last(), middles.last(), 0.5));
        if logarithmic {
            edges.iter_mut().for_each(|edge| *edge = edge.exp());
        }
        Self { values: sorted, edges, logarithmic }
    }

    /// The edges of the cell of a value.
    fn cell(&self, x: f64) -> (f64, f64) {
        let place = self.edges.partition_point(|edge| *edge <= x).clamp(1, self.values.len().max(1));
        (self.edges[place - 1], self.edges[place])
    }

    fn axis(&self, label: String) -> Axis {
        let (low, high) = (self.edges[0], self.edges[self.edges.len() - 1]);
        let between = if self.logarithmic { Axis::logarithmic_between } else { Axis::between };
        between(label, low, high)
    }
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
        let holds = asked.event.holds(event[k], study.sweep.outputs());
        let Some(holds) = holds.filter(|_| x.is_finite() && y.is_finite()) else { continue };
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
    let (across, up) = (Spread::of(&xs), Spread::of(&ys));
    let cells =
        |points: Vec<(f64, f64)>| points.into_iter().map(|(x, y)| (across.cell(x), up.cell(y))).collect::<Vec<_>>();
    let (x, y) = (across.axis(asked.label(0, study)), up.axis(asked.label(1, study)));
    let mut rows = Vec::new();
    let mut series: Vec<Series> = Vec::new();
    let mut rest: Vec<(f64, f64)> = Vec::new();
    for (number, (kind, points)) in groups.into_iter().enumerate() {
        let by = asked.by_label.clone().or_else(|| asked.by.clone()).unwrap_or_default();
        let name = if asked.by.is_some() { format!("{by} {kind}") } else { asked.event.words() };
        rows.push(vec![name.clone(), points.len().to_string()]);
        if number < MOST_KINDS {
            series.push(Series::cells(name, cells(points)).number(number));
        } else {
            rest.extend(points);
        }
    }
    if !rest.is_empty() {
        series.push(Series::cells("others", cells(rest)).number(MOST_KINDS));
    }
    let mut notes = vec![asked.event.counted(events, cases)];
    notes.extend(asked.event.absent(&event, study.sweep.outputs()));
    if event.len() > cases {
        notes.push(study.left_out(event.len() - cases, "the numbers for it"));
    }
    if study.table.incomplete() > 0 {
        notes.push(format!("{} without a result are left blank.", counted(study.table.incomplete() as u64)));
    }
    let title = format!("Where {}", asked.event.clause());
    let blank = match study.table.incomplete() {
        0 if events == cases => String::new(),
        0 => asked.event.opposite(),
        _ if events == cases => "no result".to_owned(),
        _ => format!("{}, or no result", asked.event.opposite()),
    };
    if cases > events {
        rows.push(vec![asked.event.opposite(), (cases - events).to_string()]);
    }
    let panel = Panel::new(y).with(series).blank_means(blank).height_mm(80.0);
    Ok(StudyFigure {
        name: "overturning",
        figure: Figure::new("overturning", title.clone(), x).legend(Legend::Rows).panel(panel),
        title,
        more: Vec::new(),
        tables: vec![("overturning.csv", table)],
        notes,
        summary: (["Event", "Cases"].map(str::to_owned).into(), rows),
    })
}

#[cfg(test)]
mod tests {
    use super::super::StudyTable;
    use super::*;
    use crate::sweep::Sweep;

    /// The figure of a study over two keys, whose cases all overturn, but the last if it stands.
    fn map(x: &str, y: &str, last_stands: bool) -> StudyFigure {
        let text = format!(
            "scene = \"s.toml\"\n[grid]\nsignal.w.frequency = {x}\nsignal.w.scale = {y}\n[outputs]\noverturned = \"overturned_at\"\n\
             [overturning]\nevent = \"overturned\"\nx = \"signal.w.frequency\"\ny = \"signal.w.scale\"\n"
        );
        let sweep = Sweep::read(&text, "f", &|_, _| Err("none".to_owned())).unwrap();
        let mut table = "case,signal.w.frequency,signal.w.scale,overturned,status,error\n".to_owned();
        for number in 0..sweep.cases() {
            let values: Vec<String> =
                sweep.case(number).into_iter().map(|(_, value)| value.trim_end_matches(" Hz").to_owned()).collect();
            let at = if last_stands && number + 1 == sweep.cases() { "" } else { "1.5" };
            let _ = writeln!(table, "{number},{},{at},complete,", values.join(","));
        }
        let asked = sweep.wanted().overturning.clone().unwrap();
        let table = StudyTable::read(table.as_bytes(), &sweep).unwrap();
        let study = Ensemble { name: "s".to_owned(), sweep, table };
        figure(&study, &asked).unwrap()
    }

    #[test]
    fn what_is_blank_on_a_map_is_said_and_counted() {
        let axis = "{ from = 1, to = 2, count = 3 }";
        let some = map("[\"1 Hz\", \"2 Hz\"]", axis, true);
        assert!(some.figure.to_svg().contains(">not overturned</text>"));
        assert_eq!(some.summary.1.last().unwrap(), &["not overturned", "1"]);
        assert_eq!(some.title, "Where a block overturns");
        assert!(!map("[\"1 Hz\", \"2 Hz\"]", axis, false).figure.to_svg().contains("not overturned"));
    }

    /// The share of the map that is filled if every case overturns.
    fn filled(x: &str, y: &str) -> f64 {
        let svg = map(x, y, false).figure.to_svg();
        let clip = svg.split("<clipPath").nth(1).unwrap();
        let side = |name: &str| {
            let text = clip.split(&format!("{name}=\"")).nth(1).unwrap().split('"').next().unwrap();
            text.parse::<f64>().unwrap()
        };
        // Rectangles as M left top H right V bottom H left z.
        let path = svg.split("stroke=\"none\"/>").next().unwrap().rsplit("d=\"").next().unwrap();
        let area = path.split('M').skip(1).map(|part| {
            let numbers: Vec<f64> = part.split([' ', 'H', 'V', 'z', '"']).flat_map(str::parse::<f64>).collect();
            (numbers[2] - numbers[0]) * (numbers[3] - numbers[1])
        });
        area.sum::<f64>() / (side("width") * side("height"))
    }

    #[test]
    fn a_map_on_which_all_overturns_has_no_blanks() {
        let even = ["{ from = \"1 Hz\", to = \"4 Hz\", count = 7 }", "{ from = 1, to = 2, count = 5 }"];
        let log =
            ["{ from = \"0.1 Hz\", to = \"20 Hz\", count = 9, spacing = \"log\" }", "[0.1, 0.2, 0.5, 1, 2, 5, 10]"];
        let uneven = ["[\"1 Hz\", \"2 Hz\", \"4 Hz\", \"5 Hz\"]", "[-1, 0, 3, 4.5]"];
        for x in [even[0], log[0], uneven[0], "[\"2 Hz\"]"] {
            for y in [even[1], log[1], uneven[1], "[3]"] {
                let share = filled(x, y);
                // Corners are written to 0.01 of some 50.
                assert!((share - 1.0).abs() < 2e-3, "{x} {y}: {share}");
            }
        }
    }
}
