//! The plots over time, the phase portraits and the contact forces.

use super::column::{Column, SEEN, SEEN_BELOW_PEAKS};
use super::{digits, time};
use crate::page::curves::Does;
use crate::page::notes::joined;
use crate::page::panels::{Cut, Line, Measure, Panels, Place, Source, unseen_slip};
use crate::page::recorder::{BLOCK_COLUMNS, BLOCK_COORDINATES, PageRecorder, coordinate_in};
use crate::page::scenery::ContactDrawn;
use crate::{shortest, with_digits};
use serde::Serialize;

/// A plot over time.
#[derive(Serialize)]
pub(super) struct PanelData {
    id: String,
    title: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    note: Option<String>,
    unit: String,
    least: f64,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    guides: Vec<f64>,
    /// Its times, where these are others than those of the curves or the borders.
    #[serde(skip_serializing_if = "Option::is_none")]
    t: Option<Column>,
    /// Where the axis ends if peaks are cut.
    #[serde(skip_serializing_if = "Option::is_none")]
    cut: Option<CutData>,
    /// The contact whose it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    contact: Option<usize>,
    /// Whether it stands after the contacts.
    late: bool,
    series: Vec<SeriesData>,
}

/// Where an axis ends, and how far what it cuts goes.
#[derive(Serialize)]
struct CutData {
    limit: f64,
    reach: String,
}

impl CutData {
    fn of(cut: Cut, unit: &str) -> Self {
        Self { limit: digits(cut.limit), reach: cut.reach(unit) }
    }
}

#[derive(Serialize)]
struct SeriesData {
    label: String,
    index: usize,
    /// Whether it stays pale behind a mean, which has its name.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    raw: bool,
    /// Of a line that is dashed where it is another quantity than itself: the points at which that changes, the first where it is itself.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    turns: Vec<usize>,
    /// Whether its times are the borders of the forces, not those of the curves.
    at_borders: bool,
    y: Column,
    /// The pictures at which the value is another than the curve's, which shows the extremes of many steps: each counted from
    /// the one before, the first from 0; and the values there.
    #[serde(skip_serializing_if = "Option::is_none")]
    other_at: Option<Column>,
    #[serde(skip_serializing_if = "Option::is_none")]
    others: Option<Column>,
}

impl SeriesData {
    fn of(line: &Line, recorder: &PageRecorder, panels: &Panels, least: f64, steps: f64) -> Self {
        let (mut other_at, mut others, mut before) = (Vec::new(), Vec::new(), 0);
        if let Some(source) = line.of.filter(|_| panels.curves.is_thinned()) {
            let pictures = || recorder.kept.frames.rows().map(|(t, _)| t);
            // More of them than are drawn.
            let values = match in_pictures(recorder, source.column) {
                Some(values) => values.into_iter().map(Some).collect(),
                None => {
                    let most = line.y.iter().filter(|y| y.is_finite()).fold(0.0, |most: f64, y| most.max(y.abs()));
                    recorder.kept.curves.values(source.column, pictures(), AS_GOOD * most / source.factor.abs())
                }
            };
            let drawn = linear(&panels.curves.times(), &line.y, pictures());
            for (picture, (value, drawn)) in values.into_iter().zip(drawn).enumerate() {
                let value = value.map(|value| source.drawn(value));
                // What a spring's force is before the first step is known from that alone, which is what is drawn.
                if picture == 0 && value.is_none_or(f64::is_nan) {
                    continue;
                }
                if value.is_some_and(|x| (x - drawn).abs() <= READ * x.abs().max(least)) {
                    continue;
                }
                other_at.push((picture - before) as f64);
                others.push(value.unwrap_or(f64::NAN));
                before = picture;
            }
        }
        let y = Column::of(&line.y, steps);
        let any = !others.is_empty();
        let (other_at, others) = (any.then(|| Column::counts(&other_at)), any.then(|| Column::of(&others, steps)));
        Self {
            label: line.label.clone(),
            index: line.number,
            raw: line.is_raw,
            turns: turns(&line.itself),
            at_borders: line.of.is_none(),
            y,
            other_at,
            others,
        }
    }
}

/// The points at which this changes, from not so at the beginning.
fn turns(is_so: &[bool]) -> Vec<usize> {
    (0..is_so.len()).filter(|k| is_so[*k] != (*k > 0 && is_so[k - 1])).collect()
}

/// The values of a column in all pictures: of coordinates of blocks, which each picture has.
fn in_pictures(recorder: &PageRecorder, column: usize) -> Option<Vec<f64>> {
    let (block, of) = (column / BLOCK_COLUMNS, column % BLOCK_COLUMNS);
    let scenery = &recorder.scenery;
    let has = !scenery.is_crowded() && block < scenery.blocks.len() && of < BLOCK_COORDINATES;
    has.then(|| recorder.kept.frames.rows().map(|(_, row)| coordinate_in(recorder, row, block, of)).collect())
}

/// Extremes that differ by this part of the largest value are as good as the value between them.
const AS_GOOD: f64 = 2e-3;

/// A curve's value is read off to this part of itself.
const READ: f64 = 5e-4;

/// A curve through points at ascending times, linear between them, at other ascending times.
fn linear(t: &[f64], y: &[f64], at: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut from = 0;
    let value = |x: f64| {
        while from + 2 < t.len() && t[from + 1] <= x {
            from += 1;
        }
        match (t.get(from + 1), y.get(from + 1)) {
            (Some(&end), Some(&last)) if end > t[from] => {
                y[from] + ((x - t[from]) / (end - t[from])).clamp(0.0, 1.0) * (last - y[from])
            }
            _ => y[from],
        }
    };
    at.map(value).collect()
}

/// A coordinate and its velocity, at times of their own.
#[derive(Serialize)]
pub(super) struct PortraitData {
    id: &'static str,
    title: String,
    x_label: String,
    unit: String,
    least: [f64; 2],
    guides: Vec<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    note: Option<String>,
    series: Vec<PortraitSeries>,
}

#[derive(Serialize)]
struct PortraitSeries {
    label: String,
    index: usize,
    /// The first point that is drawn strong and the first behind them, if not all are.
    #[serde(skip_serializing_if = "Option::is_none")]
    strong: Option<[usize; 2]>,
    /// On how many others it lies, and the points at which that changes: the first is where it leaves them, the next where it lies on them again.
    over: u8,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    turns: Vec<usize>,
    t: Column,
    x: Column,
    y: Column,
}

/// Means between the times `borders`.
#[derive(Serialize)]
pub(super) struct ForceData {
    borders: Vec<f64>,
    /// What the contacts are between.
    names: Vec<String>,
    /// Of the units in which normal and tangential forces are plotted, by contacts: the prefix, and by what N are multiplied.
    units: Vec<[(&'static str, f64); 2]>,
    /// The period of the vibrations of which `mean` has only the slower ones, with its unit, and how far means reach.
    period: String,
    /// The longest time whose mean a force is, with its unit.
    bucket: String,
    /// What the plots of forces of springs show, if not each step.
    #[serde(skip_serializing_if = "Option::is_none")]
    springs: Option<String>,
    /// What those of forces of rigid contacts show.
    rigid: String,
    /// What those of impulses of impacts show.
    struck: String,
    /// The units of `impacts`, by contacts: the prefix, and by what N s are multiplied.
    impulse_units: Vec<(&'static str, f64)>,
    /// Where the axes of normal and tangential forces end if peaks are cut, by contacts, in their units.
    cuts: Vec<[Option<CutData>; 2]>,
    /// Where the axis of a second plot of the normal forces ends, in their unit, with the unit, by contacts: where the first one shows nothing of what rests.
    enlarged: Vec<Option<CutData>>,
    /// Contacts that only strike, without forces between impacts.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    forceless: Vec<usize>,
    /// Contacts whose tangential forces are rounding.
    frictionless: Vec<usize>,
    /// Contacts whose forces are one of many sets.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    redundant: Vec<usize>,
    /// Contacts whose points share their tangential force in one of many ways, of which the sum over the points is plotted.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    shares: Vec<usize>,
    /// These sums, with their contacts, where they are at the times of the curves.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    sums: Vec<(usize, Column)>,
    /// Contacts of which some points stick and slip by turns, with the names of these: the band shows what they do in most of a stretch.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    alternating: Vec<(usize, String)>,
    /// Contacts of which some points are drawn as they are though others are smoothed, with which these are.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    unsmoothed: Vec<(usize, String)>,
    /// Contacts that slip by so little in a stretch that it is drawn as sticking, with the most of it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    unseen_slip: Vec<(usize, String)>,
    /// Contacts with springs.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    compliant: Vec<usize>,
    points: Vec<PointForces>,
}

#[derive(Serialize)]
struct PointForces {
    contact: usize,
    point: usize,
    normal: Column,
    /// `normal` without fast vibrations, at the borders, where it differs.
    #[serde(skip_serializing_if = "Option::is_none")]
    mean: Option<Column>,
    tangential: Column,
    /// Both forces at the times of the curves, as they are plotted where means over the stretches would lose their peaks.
    #[serde(skip_serializing_if = "Option::is_none")]
    course: Option<[SeriesData; 2]>,
    /// The largest normal impulse of an impact, N s.
    #[serde(skip_serializing_if = "Option::is_none")]
    impacts: Option<Column>,
    /// A letter a value: `o` open, `b` presses briefly, `k` stick, `l` slip.
    state: String,
}

pub(super) fn time_panels(recorder: &PageRecorder, panels: &Panels) -> Vec<PanelData> {
    let panel = |panel: &crate::page::panels::TimePanel| PanelData {
        id: panel.id.clone(),
        title: match &panel.of_contact {
            Some((_, name)) if !name.is_empty() => format!("{}, {name}", panel.title),
            _ => panel.title.clone(),
        },
        contact: panel.of_contact.as_ref().map(|(pair, _)| *pair),
        note: joined(&panel.notes),
        unit: panel.unit.clone(),
        least: digits(panel.least),
        guides: panel.guides.iter().copied().map(digits).collect(),
        cut: panel.cut_at().map(|cut| CutData::of(cut, &panel.unit)),
        t: panel.t.as_ref().map(|t| Column::of(t, SEEN_BELOW_PEAKS)),
        late: panel.place == Place::Forces,
        series: {
            // Energies are read as a sum, in which the rounding of each would be seen.
            let is_sum = matches!(panel.measure, Measure::Energy);
            let steps = if panel.cut || is_sum { SEEN_BELOW_PEAKS } else { SEEN };
            panel.lines.iter().map(|line| SeriesData::of(line, recorder, panels, panel.least, steps)).collect()
        },
    };
    panels.panels.iter().map(panel).collect()
}

pub(super) fn portraits(panels: &Panels) -> Vec<PortraitData> {
    let portrait = |portrait: &crate::page::panels::Portrait| PortraitData {
        id: portrait.id,
        title: portrait.title.clone(),
        x_label: format!("{} ({})", portrait.x_label, portrait.x_unit),
        unit: portrait.y_unit.clone(),
        least: portrait.least.map(digits),
        guides: portrait.guides.iter().copied().map(digits).collect(),
        note: portrait.note.clone(),
        series: portrait
            .lines
            .iter()
            .map(|line| {
                let [x, y] = [&line.x, &line.v].map(|values| Column::of(values, SEEN));
                let t = Column::of(&line.t, SEEN_BELOW_PEAKS);
                let strong = Some([line.strong.start, line.strong.end]).filter(|_| line.strong.len() < line.t.len());
                PortraitSeries {
                    label: line.label.clone(),
                    index: line.number,
                    strong,
                    over: line.over,
                    turns: turns(&line.alone),
                    t,
                    x,
                    y,
                }
            })
            .collect(),
    };
    panels.portraits.iter().map(portrait).collect()
}

pub(super) fn forces(recorder: &PageRecorder, panels: &Panels) -> ForceData {
    let (period, means) = panels.means_of_contacts(recorder);
    let cuts = |pair: usize| {
        let cuts = panels.cuts_of_contact(recorder, pair, &means).into_iter().zip(panels.force_units[pair]);
        let mut cuts =
            cuts.map(|(cut, (prefix, factor))| cut.map(|cut| CutData::of(cut.scaled(factor), &format!("{prefix}N"))));
        std::array::from_fn(|_| cuts.next().flatten())
    };
    let enlarged = |pair: usize| {
        let [cut, _] = panels.cuts_of_contact(recorder, pair, &means);
        let (prefix, factor) = panels.force_units[pair][0];
        let end = panels.enlarged_normal(recorder, pair, &means, cut)? * factor;
        Some(CutData { limit: digits(end), reach: format!("up to {} {prefix}N", shortest(end, 2)) })
    };
    let contacts = recorder.scenery.contacts.iter().enumerate();
    let all = contacts.flat_map(|(contact, drawn)| (0..drawn.points.len()).map(move |point| (contact, drawn, point)));
    let points = all.filter_map(|(contact, drawn, point)| {
        let forces = panels.forces[drawn.first + point].as_ref()?;
        let state = (0..forces.state.len()).map(|bucket| match forces.does(bucket) {
            Does::Open => 'o',
            Does::Briefly => 'b',
            Does::Stick => 'k',
            Does::Slip => 'l',
        });
        Some(PointForces {
            contact,
            point,
            normal: Column::of(&forces.normal, SEEN_BELOW_PEAKS),
            mean: means[drawn.first + point].as_ref().map(|means| Column::of(means, SEEN)),
            tangential: Column::of(&forces.tangential, SEEN_BELOW_PEAKS),
            course: forces.course.as_ref().map(|course| {
                let column = recorder.spring_column(drawn.first + point);
                let of = |part: usize| {
                    let source = column.map(|column| Source { column: column + part, zero: 0.0, factor: 1.0 });
                    let line = Line {
                        label: String::new(),
                        number: 0,
                        y: course[part].clone(),
                        is_raw: false,
                        itself: Vec::new(),
                        of: source,
                    };
                    SeriesData::of(&line, recorder, panels, 0.0, if column.is_some() { SEEN } else { SEEN_BELOW_PEAKS })
                };
                [of(0), of(1)]
            }),
            impacts: (!forces.impacts.is_empty()).then(|| Column::of(&forces.impacts, SEEN)),
            state: state.collect(),
        })
    });
    let contacts = || recorder.scenery.contacts.iter().enumerate();
    let forces_of =
        |drawn: &ContactDrawn| panels.forces[drawn.first..drawn.first + drawn.points.len()].iter().flatten();
    let hiding = contacts().filter(|(_, drawn)| forces_of(drawn).any(|forces| forces.hides_slip));
    let alternating = contacts().filter_map(|(pair, drawn)| Some((pair, panels.alternating(drawn)?)));
    let unsmoothed = contacts().filter_map(|(pair, drawn)| Some((pair, panels.unsmoothed(drawn, &means)?)));
    let sums = panels
        .sums
        .iter()
        .enumerate()
        .filter_map(|(pair, sum)| Some((pair, sum.as_ref().filter(|sum| sum.is_course)?)));
    ForceData {
        names: recorder.scenery.contacts.iter().map(|contact| recorder.pair_name(contact)).collect(),
        borders: panels.curves.borders().into_iter().map(time).collect(),
        units: panels.force_units.clone(),
        period,
        bucket: with_digits(panels.curves.longest_bucket(), "s", 2),
        rigid: panels.told_of_rigid(""),
        springs: panels.told_of_springs().filter(|_| !recorder.springs.is_empty()),
        struck: format!("{}, which impacts.csv leaves out", panels.told_of_impacts()),
        impulse_units: panels.impulse_units.clone(),
        cuts: (0..recorder.scenery.contacts.len()).map(cuts).collect(),
        enlarged: (0..recorder.scenery.contacts.len()).map(enlarged).collect(),
        forceless: (0..panels.normal.len()).filter(|pair| !panels.normal[*pair]).collect(),
        frictionless: (0..panels.tangential.len()).filter(|pair| !panels.tangential[*pair]).collect(),
        redundant: (0..panels.redundant.len()).filter(|pair| panels.redundant[*pair].forces).collect(),
        shares: (0..panels.redundant.len()).filter(|pair| panels.sums_tangential(*pair)).collect(),
        sums: sums.map(|(pair, sum)| (pair, Column::of(&sum.y, SEEN_BELOW_PEAKS))).collect(),
        alternating: alternating.collect(),
        unsmoothed: unsmoothed.collect(),
        unseen_slip: hiding.map(|(pair, drawn)| (pair, with_digits(unseen_slip(recorder, drawn), "m", 1))).collect(),
        compliant: contacts().filter(|(_, drawn)| drawn.has_duration).map(|(pair, _)| pair).collect(),
        points: points.collect(),
    }
}
