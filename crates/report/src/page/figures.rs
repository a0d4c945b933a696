//! The plots of the page as figures for a paper.

mod contact_forces;
mod cut_lines;
mod noted;

use super::accelerograms;
use super::bands::BAND_COLUMNS;
use super::content::largest;
use super::crowd::CrowdCurve;
use super::drawings;
use super::notes::{About, Note};
use super::opening::opening;
use super::panels::{Panels, Place, Portrait, PortraitLine, TimePanel, prefix, time_unit};
use super::recorder::{MANY_IMPACTS, PageRecorder};
use super::span;
use crate::with_digits;
use cut_lines::{cut_axis, cut_lines, range_of};
use noted::{Noted, noted_once};
use teeter_plot::{Axis, Figure, Legend, Panel, Series};

/// File names and SVG text of the figures that the scene has, of the width that it asks for. Over time: `x.svg`, `y.svg`, `phi.svg`
/// of blocks that move in these, their velocities `vx.svg`, `vy.svg` and `omega.svg`; `w_mid.svg`, the deflections of beams at midspan and at
/// probes; `ground.svg`, `ground_v.svg`, `ground_a.svg` and the same with `_phi` of ground and supports that move; `contact_forces.svg` and
/// `slip.svg`; `section_forces.svg`; `energy.svg`. Phase portraits `phase.svg` (φ), `phase_x.svg`, `phase_y.svg` of the coordinate in which a block
/// moves most. Over the span: `shapes.svg` and, where the scene asks for it, `envelopes.svg`. `records.svg` and
/// `spectra.svg` where records prescribe motions, `force_chains.svg` where contacts link three blocks or more at the end,
/// `thrust_line.svg` and `eccentricity.svg` where blocks form a [chain](super::thrust_lines). Of many blocks `phi.svg`,
/// `omega.svg` and `displacement.svg` show bands, and there are no portraits. What would show nothing but rounding has no figure.
#[must_use]
pub fn figures(recorder: &PageRecorder) -> Vec<(String, String)> {
    let panels = Panels::in_full(recorder);
    let moving = opening(recorder, &panels).map(|opening| opening.shown);
    let plots = Plots { recorder, panels: &panels, t: panels.curves.times(), moving };
    let scenery = &recorder.scenery;
    let width = 1e3 * scenery.display.figure_width;
    let mut figures = Vec::new();
    let mut add = |name: &str, figure: Figure| {
        figures.push((format!("{name}.svg"), figure.width_mm(width).legend(Legend::Rows).to_svg()));
    };
    if scenery.is_crowded() {
        add("phi", plots.crowd_phi());
        add("omega", plots.crowd_omega());
        add("displacement", plots.crowd_displacement());
    }
    for panel in panels.panels.iter().filter(|panel| panel.place == Place::Motion) {
        add(&panel.id, plots.while_moving(&panel.id, &panel.description, vec![plots.time_panel(panel)]));
    }
    if let Some(figure) = span::shapes(recorder, &panels.units, "shapes") {
        add("shapes", figure);
    }
    for (name, figure) in plots.contact_forces() {
        add(&name, figure);
    }
    for (name, figure) in plots.slips() {
        add(&name, figure);
    }
    for portrait in &panels.portraits {
        add(portrait.id, plots.portrait(portrait));
    }
    if let Some(figure) = span::envelopes(recorder, &panels.units, "envelopes") {
        add("envelopes", figure);
    }
    for (file, ids, title) in [
        ("section_forces", ["section-", "section-"], "What beams bear over time"),
        ("energy", ["energy", "works"], "Energies and works over time"),
    ] {
        let of_file = panels.panels.iter().filter(|panel| panel.place == Place::Forces);
        let own = of_file.filter(|panel| ids.iter().any(|id| panel.id.starts_with(id)));
        let own: Vec<Noted> = own.map(|panel| plots.time_panel(panel)).collect();
        if !own.is_empty() {
            add(file, plots.over_time(file, title, own));
        }
    }
    if let Some(figure) = accelerograms::histories(&scenery.records, [scenery.display.length; 2]) {
        add("records", figure);
    }
    if let Some(figure) = accelerograms::spectra(&scenery.records, scenery.display.length) {
        add("spectra", figure);
    }
    let lines = drawings::lines_of(recorder);
    if let Some(figure) = drawings::eccentricities(&lines) {
        add("eccentricity", figure);
    }
    if let Some(drawing) = drawings::force_chains(recorder) {
        figures.push(("force_chains.svg".to_owned(), drawing.width_mm(width).to_svg()));
    }
    if let Some(drawing) = drawings::thrust(recorder, &lines, panels.many_at_end()) {
        figures.push(("thrust_line.svg".to_owned(), drawing.width_mm(width).to_svg()));
    }
    figures
}

/// Least range of angles (°) and angular velocities (rad/s).
const STILL: f64 = 2e-3;

struct Plots<'a> {
    recorder: &'a PageRecorder,
    panels: &'a Panels,
    t: Vec<f64>,
    /// When anything moves, if that is a small part of the run, s.
    moving: Option<[f64; 2]>,
}

impl Plots<'_> {
    /// Of forces and energies, which may go on, or change, where nothing moves: the whole run.
    fn over_time(&self, id: &str, title: &str, panels: Vec<Noted>) -> Figure {
        self.figure(id, title, panels, None)
    }

    /// Of motions: the part of the run in which anything moves.
    fn while_moving(&self, id: &str, title: &str, panels: Vec<Noted>) -> Figure {
        self.figure(id, title, panels, self.moving)
    }

    fn figure(&self, id: &str, title: &str, panels: Vec<Noted>, part: Option<[f64; 2]>) -> Figure {
        let (start, end) = (self.t[0], self.t[self.t.len() - 1]);
        let end = if end > start { end } else { start + 1.0 };
        let [from, to] = part.unwrap_or([start, end]);
        let part =
            if to - from < end - start { format!(", of a run to {}", with_digits(end, "s", 6)) } else { String::new() };
        let (unit, factor) = time_unit(to - from);
        let x = Axis::between(format!("Time t ({unit}){part}"), from, to).shown_in(factor);
        let first = panels.iter().position(|(panel, _)| panel.has_ticks());
        let (panels, note) = noted_once(panels);
        let panels = panels.into_iter().enumerate();
        // Said once in a figure.
        let named = panels.map(|(k, panel)| if first == Some(k) { panel.ticks_named("impact") } else { panel });
        named.fold(Figure::new(id, title, x).note(note), Figure::panel)
    }

    /// A panel with the impacts marked, of one contact or of all: one by one, or how many about each time where they are many.
    fn marked(&self, panel: Panel, contact: Option<usize>) -> Panel {
        let about = self.recorder.impacts_about(contact);
        if about.iter().map(|(_, count)| u64::from(*count)).sum::<u64>() > MANY_IMPACTS {
            return panel.counts_at(about);
        }
        // So few are among the first that are kept, unless others were before them.
        let mine =
            self.recorder.kept.impacts.iter().filter(|impact| contact.is_none_or(|asked| impact.contact == asked));
        panel.ticks_at(mine.map(|impact| impact.t).collect())
    }

    /// A panel that the page has, too, with the impacts marked.
    fn time_panel(&self, panel: &TimePanel) -> Noted {
        let borders = self.panels.curves.borders();
        let lines = panel.lines.iter().map(|line| {
            let t = panel.t.as_ref().unwrap_or(if line.of.is_none() { &borders } else { &self.t });
            let points = t.iter().copied().zip(line.y.iter().copied());
            let series = Series::line(&line.label, points).number(line.number).dashed_but_at(line.itself.clone());
            if line.is_raw { series.faint() } else { series }
        });
        let lines: Vec<Series> = lines.collect();
        let label = format!("{} ({})", panel.title, panel.unit);
        let cut = panel.cut_at();
        let range = cut.map(|cut| range_of(&cut, &lines));
        let y = cut_axis(&label, range, values(&lines).chain(near(&panel.guides, values(&lines))), panel.least);
        let (lines, about_pale, told) = cut_lines(lines, cut, range, &panel.unit);
        let contact = panel.of_contact.as_ref();
        let name = contact.map(|(_, name)| name).filter(|name| !name.is_empty()).map(Note::of_plot);
        let own = panel.notes.iter().filter(|note| about_pale || note.about != About::Pale).cloned();
        let notes = own.chain(told.or(name)).collect();
        let drawn = Panel::new(y.clone()).with(lines).telling_apart();
        let drawn = guided(drawn.levels(panel.guides.clone()), &panel.guides, &y);
        (self.marked(drawn, contact.map(|(pair, _)| *pair)), notes)
    }

    fn portrait(&self, portrait: &Portrait) -> Figure {
        let part = |line: &PortraitLine, label: &str, points: std::ops::Range<usize>| {
            let alone = line.alone.get(points.clone()).unwrap_or_default().to_vec();
            let points = line.x[points.clone()].iter().copied().zip(line.v[points].iter().copied());
            Series::line(label, points).number(line.number).over(line.over).alone_at(alone)
        };
        // What is pale stays behind.
        let pale = portrait.lines.iter().flat_map(|line| {
            let [before, after] = [0..line.strong.start + 1, line.strong.end.saturating_sub(1)..line.t.len()];
            [before, after].into_iter().filter(|points| points.len() > 1).map(|points| part(line, "", points).faint())
        });
        let strong = portrait.lines.iter().map(|line| part(line, &line.label, line.strong.clone()));
        let lines: Vec<Series> = pale.chain(strong).collect();
        let x = || lines.iter().flat_map(Series::points).map(|point| point.0);
        let x = x().chain(near(&portrait.guides, x()));
        let x = Axis::around(format!("{} ({})", portrait.x_label, portrait.x_unit), x, portrait.least[0]);
        let y = Axis::around(format!("{} ({})", portrait.y_label, portrait.y_unit), values(&lines), portrait.least[1]);
        // A block's critical angles, where one of them is reached: beyond, it overturns.
        let panel = guided(Panel::new(y).with(lines).guides(portrait.guides.clone()), &portrait.guides, &x);
        Figure::new(portrait.id, &portrait.title, x).panel(panel.note(portrait.note.clone()))
    }

    /// Bands of many bodies, from those of [`BAND_NAMES`](super::bands::BAND_NAMES), over time.
    fn bands(t: &[f64], bands: &[Vec<f64>], factor: f64) -> Vec<Series> {
        let area = |label: &str, low: usize, high: usize| {
            let ends = bands[low].iter().zip(&bands[high]).map(|(a, b)| (factor * a, factor * b));
            Series::area(label, t.iter().zip(ends).map(|(&t, (a, b))| (t, a, b))).number(0)
        };
        let median = t.iter().copied().zip(bands[2].iter().map(|y| factor * y));
        vec![area("all bodies", 0, 4), area("8 of 10", 1, 3), Series::line("median", median).number(0)]
    }

    fn crowd_figure(&self, id: &str, title: &str, y_label: &str, lines: Vec<Series>) -> Figure {
        let y = Axis::around(y_label, values(&lines), STILL);
        self.over_time(id, title, vec![(Panel::new(y).with(lines), Vec::new())])
    }

    /// Bands at the times of the pictures, and the bodies in which the quantity becomes largest.
    fn crowd_chosen(&self, curve: CrowdCurve, factor: f64) -> Vec<Series> {
        let t: Vec<f64> = self.recorder.kept.frames.rows().map(|(t, _)| t).collect();
        let mut lines = Self::bands(&t, &curve.bands, factor);
        lines.extend(curve.chosen.iter().enumerate().map(|(k, (block, values))| {
            let points = t.iter().copied().zip(values.iter().map(|y| factor * y));
            Series::line(&self.recorder.scenery.blocks[*block].name, points).number(k + 1)
        }));
        lines
    }

    fn crowd_phi(&self) -> Figure {
        let lines = self.crowd_chosen(CrowdCurve::turns(self.recorder), 1f64.to_degrees());
        let label = "Turn since the start (°)";
        self.crowd_figure("phi", "Turn of the bodies over time, with those that turn furthest", label, lines)
    }

    fn crowd_displacement(&self) -> Figure {
        let curve = CrowdCurve::distances(self.recorder);
        let largest = curve.bands[BAND_COLUMNS - 1].iter().fold(0.0, |most: f64, x| most.max(*x));
        let (prefix, factor) = prefix(largest);
        let lines = self.crowd_chosen(curve, factor);
        let y = Axis::around(format!("Distance from the start ({prefix}m)"), values(&lines), 1e-6 * factor);
        let title = "Distance of the bodies from their start over time, with those that go furthest";
        self.over_time("displacement", title, vec![(Panel::new(y).with(lines), Vec::new())])
    }

    fn crowd_omega(&self) -> Figure {
        let bands: Vec<Vec<f64>> = (BAND_COLUMNS..2 * BAND_COLUMNS).map(|k| self.panels.curves.curve(k)).collect();
        let lines = Self::bands(&self.t, &bands, 1.0);
        self.crowd_figure("omega", "Angular velocity of the bodies over time", "Angular velocity ω (rad/s)", lines)
    }

    /// Of one pair or two a figure of all, if it fits a page; else one of each: of [`MOST_PAIRS`] at most, those with the largest values.
    fn by_pairs(&self, file: &str, title: &str, pairs: Vec<(usize, f64, Vec<Noted>)>) -> Vec<(String, Figure)> {
        if pairs.is_empty() {
            return Vec::new();
        }
        if pairs.len() <= TOGETHER {
            let panels = pairs.iter().flat_map(|(_, _, panels)| panels.clone()).collect();
            let all = self.over_time(file, title, panels).legend(Legend::Rows);
            let width = 1e3 * self.recorder.scenery.display.figure_width;
            if pairs.len() == 1 || all.clone().width_mm(width).height_mm() <= TALLEST {
                return vec![(file.to_owned(), all)];
            }
        }
        let mut sizes: Vec<f64> = pairs.iter().map(|(_, size, _)| *size).collect();
        sizes.sort_by(|a, b| b.total_cmp(a));
        let least = sizes[MOST_PAIRS.min(sizes.len()) - 1];
        let strongest = pairs.into_iter().filter(|(_, size, _)| *size >= least).take(MOST_PAIRS);
        let figure = |(pair, _, panels): (usize, f64, Vec<Noted>)| {
            let contact = &self.recorder.scenery.contacts[pair];
            let [upper, lower] = self.recorder.upper_and_lower(contact);
            let name = pair_file(file, upper, lower);
            let figure = self.over_time(&name, title, panels);
            (name, figure)
        };
        strongest.map(figure).collect()
    }

    fn slips(&self) -> Vec<(String, Figure)> {
        let panels = self.panels.panels.iter().filter_map(|panel| Some((panel.of_contact.as_ref()?.0, panel)));
        let pairs = panels.map(|(pair, panel)| {
            let most = largest(panel.lines.iter().flat_map(|line| &line.y)) / length_per_metre(&panel.unit);
            (pair, most, vec![self.time_panel(panel)])
        });
        self.by_pairs("slip", "Slip of the contacts over time", pairs.collect())
    }
}

/// A panel with its critical angles named if one of them is on this axis.
fn guided(panel: Panel, angles: &[f64], axis: &Axis) -> Panel {
    let (low, high) = axis.ends();
    if angles.iter().any(|angle| (low..=high).contains(angle)) { panel.guides_named(GUIDES) } else { panel }
}

/// The angles right beyond the ends of these values: their lines would lie on the frame, or hardly outside of it.
fn near(angles: &[f64], values: impl Iterator<Item = f64>) -> impl Iterator<Item = f64> {
    let values = values.filter(|value| value.is_finite());
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
    let room = BEYOND * (high - low);
    angles.iter().copied().filter(move |at| (low - room..low).contains(at) || (high < *at && *at <= high + room))
}

/// So much of the range of a curve is beyond it right beyond.
const BEYOND: f64 = 0.1;

/// What the dashed lines of plots of φ are, as on the page.
const GUIDES: &str = "critical angle";

/// Tallest figure of several pairs, mm: on A4 there is room for its caption.
const TALLEST: f64 = 250.0;

/// Pairs whose contact forces are in one figure.
const TOGETHER: usize = 2;

/// Most pairs with a figure each.
const MOST_PAIRS: usize = 24;

/// What the figure of one of many pairs is called, without its ending.
fn pair_file(file: &str, block: &str, surface: &str) -> String {
    format!("{file}-{block}-on-{surface}")
}

/// Whether a file of that name is the figure of one of many pairs, as `contact_forces` or `slip`, as SVG or PDF.
pub(crate) fn is_pair_figure(file: &str, name: &str) -> bool {
    let stem = name.strip_suffix(".svg").or_else(|| name.strip_suffix(".pdf"));
    let pair = stem.and_then(|stem| stem.strip_prefix(file)?.strip_prefix('-'));
    pair.is_some_and(|pair| {
        pair.split_once("-on-").is_some_and(|(block, surface)| !block.is_empty() && !surface.is_empty())
    })
}

/// Numbers in a unit of a length axis to a metre.
fn length_per_metre(unit: &str) -> f64 {
    match unit {
        "km" => 1e-3,
        "cm" => 1e2,
        "mm" => 1e3,
        "µm" => 1e6,
        "nm" => 1e9,
        _ => 1.0,
    }
}

/// The y of all points.
fn values<'a>(lines: impl IntoIterator<Item = &'a Series>) -> impl Iterator<Item = f64> {
    lines.into_iter().flat_map(Series::points).map(|point| point.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_critical_angle_right_beyond_a_curve_is_on_its_axis() {
        let values = [0.0, 10.0];
        let on = |angles: &[f64]| near(angles, values.into_iter()).collect::<Vec<_>>();
        assert_eq!(on(&[-0.5, 5.0, 10.9, 12.0, -20.0]), [-0.5, 10.9]);
        let axis = Axis::around("\u{3c6}", values.into_iter().chain(on(&[-0.5])), 0.0);
        assert!(axis.ends().0 < -0.7, "off the frame: {:?}", axis.ends());
    }
}
