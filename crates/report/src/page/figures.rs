//! The plots of the page as figures for a paper.

use super::accelerograms;
use super::bands::BAND_COLUMNS;
use super::crowd::CrowdCurve;
use super::drawings;
use super::recorder::{BLOCK_COLUMNS, ENERGIES, MANY_IMPACTS, PageRecorder};
use super::rounded;
use crate::sections::Kind;
use teeter_beam::Envelope;
use teeter_integrator::ContactState;
use teeter_plot::{Axis, Band, Colour, Figure, LEGEND_WIDTH, Panel, Series, legend_width, text_width};

/// File names and SVG text of the figures that the scene has: `phi.svg`, `omega.svg` and `phase.svg` with blocks,
/// `w_mid.svg` with beams, `section_forces.svg` and `envelopes.svg` where the scene asks for what beams bear, `contact_forces.svg` where contacts carried something, `energy.svg` always, `records.svg` and
/// `spectra.svg` where records prescribe motions, `force_chains.svg` where two blocks or more touch something,
/// `thrust_line.svg` and `eccentricity.svg` where blocks form a [chain](super::thrust_lines). Of many blocks `phi.svg`,
/// `omega.svg` and `displacement.svg` show bands, and there is no `phase.svg`.
#[must_use]
pub fn figures(recorder: &PageRecorder) -> Vec<(String, String)> {
    let plots = Plots { recorder, t: recorder.kept.curves.times() };
    let scenery = &recorder.scenery;
    let mut figures = Vec::new();
    let mut add = |name: &str, figure: Figure| figures.push((name.to_owned(), figure.to_svg()));
    if scenery.is_crowded() {
        add("phi.svg", plots.crowd_phi());
        add("omega.svg", plots.crowd_omega());
        add("displacement.svg", plots.crowd_displacement());
    } else if !scenery.blocks.is_empty() {
        add("phi.svg", plots.phi());
        add("omega.svg", plots.omega());
        add("phase.svg", plots.phase());
    }
    if !scenery.beams.is_empty() {
        add("w_mid.svg", plots.w_mid());
    }
    if let Some(figure) = plots.section_forces() {
        add("section_forces.svg", figure);
    }
    if let Some(figure) = envelopes(recorder) {
        add("envelopes.svg", figure);
    }
    if let Some(figure) = plots.contact_forces() {
        add("contact_forces.svg", figure);
    }
    add("energy.svg", plots.energy());
    if let Some(figure) = accelerograms::histories(&scenery.records) {
        add("records.svg", figure);
    }
    if let Some(figure) = accelerograms::spectra(&scenery.records) {
        add("spectra.svg", figure);
    }
    if let Some(drawing) = drawings::force_chains(recorder) {
        figures.push(("force_chains.svg".to_owned(), drawing.to_svg()));
    }
    let lines = drawings::lines_of(recorder);
    if let Some(drawing) = drawings::thrust(recorder, &lines) {
        figures.push(("thrust_line.svg".to_owned(), drawing.to_svg()));
    }
    if let Some(figure) = drawings::eccentricities(&lines) {
        figures.push(("eccentricity.svg".to_owned(), figure.to_svg()));
    }
    figures
}

/// Colours of sticking and slipping; an open contact has none.
const STICK: Colour = Colour::Series(5);
const SLIP: Colour = Colour::Series(1);

/// Least range of angles (°) and angular velocities (rad/s).
const STILL: f64 = 2e-3;

struct Plots<'a> {
    recorder: &'a PageRecorder,
    t: Vec<f64>,
}

impl<'a> Plots<'a> {
    fn over_time(&self, id: &str, title: &str, panels: Vec<Panel>) -> Figure {
        let (start, end) = (self.t[0], self.t[self.t.len() - 1]);
        let x = Axis::between("Time t (s)", start, if end > start { end } else { start + 1.0 });
        panels.into_iter().fold(Figure::new(id, title, x), Figure::panel)
    }

    /// A panel of lines over time, with the impacts marked.
    fn panel(&self, y: Axis, lines: Vec<Series>) -> Panel {
        self.marked(Panel::new(y).with(lines), None)
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

    fn curve(&self, column: usize, factor: f64) -> impl Iterator<Item = f64> {
        self.recorder.kept.curves.curve(column).into_iter().map(move |y| factor * y)
    }

    fn line(&self, label: &str, number: usize, column: usize, factor: f64) -> Series {
        Series::line(label, self.t.iter().copied().zip(self.curve(column, factor))).number(number)
    }

    /// A line for each block, from the column that is `offset` after its first.
    fn by_block(&self, offset: usize, factor: f64) -> Vec<Series> {
        let line = |k: usize| self.line(self.block_label(k), k, BLOCK_COLUMNS * k + offset, factor);
        (0..self.recorder.scenery.blocks.len()).map(line).collect()
    }

    /// A block's name, if there are others.
    fn block_label(&self, k: usize) -> &'a str {
        let blocks = &self.recorder.scenery.blocks;
        if blocks.len() > 1 { &blocks[k].name } else { "" }
    }

    fn phi(&self) -> Figure {
        let lines = self.by_block(0, 1f64.to_degrees());
        let y = Axis::around("Angle φ (°)", values(&lines), STILL);
        self.over_time("phi", "Angle of the blocks over time", vec![self.panel(y, lines)])
    }

    fn omega(&self) -> Figure {
        let lines = self.by_block(1, 1.0);
        let y = Axis::around("Angular velocity φ̇ (rad/s)", values(&lines), STILL);
        self.over_time("omega", "Angular velocity of the blocks over time", vec![self.panel(y, lines)])
    }

    fn phase(&self) -> Figure {
        let blocks = &self.recorder.scenery.blocks;
        let line = |k: usize| {
            let column = BLOCK_COLUMNS * k;
            let points = self.curve(column, 1f64.to_degrees()).zip(self.curve(column + 1, 1.0));
            Series::line(self.block_label(k), points).number(k)
        };
        let lines: Vec<Series> = (0..blocks.len()).map(line).collect();
        let angles = lines.iter().flat_map(Series::points).map(|point| point.0);
        let x = Axis::around("Angle φ (°)", angles, STILL);
        let y = Axis::around("Angular velocity φ̇ (rad/s)", values(&lines), STILL);
        // A block's critical angles, where one of them is reached: beyond, it overturns.
        let guides = blocks
            .iter()
            .filter_map(|block| block.alpha)
            .flat_map(|alpha| [-alpha.to_degrees(), alpha.to_degrees()])
            .collect();
        Figure::new("phase", "Phase portrait of the blocks", x).panel(Panel::new(y).with(lines).guides(guides))
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
        self.over_time(id, title, vec![Panel::new(y).with(lines)])
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
        self.over_time("displacement", title, vec![Panel::new(y).with(lines)])
    }

    fn crowd_omega(&self) -> Figure {
        let bands: Vec<Vec<f64>> = (BAND_COLUMNS..2 * BAND_COLUMNS).map(|k| self.curve(k, 1.0).collect()).collect();
        let lines = Self::bands(&self.t, &bands, 1.0);
        self.crowd_figure("omega", "Angular velocity of the bodies over time", "Angular velocity φ̇ (rad/s)", lines)
    }

    fn w_mid(&self) -> Figure {
        let first = self.recorder.scenery.block_columns();
        let beams = &self.recorder.scenery.beams;
        let label = |name: &'a str| if beams.len() > 1 { name } else { "" };
        let line = |(k, name): (usize, &'a str)| self.line(label(name), k, first + k, 1e3);
        let lines: Vec<Series> = beams.iter().map(|beam| beam.name.as_str()).enumerate().map(line).collect();
        let span = beams.iter().fold(0.0, |longest, beam| beam.span.max(longest));
        let y = Axis::around("Midspan deflection w (mm)", values(&lines), 1e-6 * span);
        self.over_time("w_mid", "Deflection of the beams at midspan over time", vec![self.panel(y, lines)])
    }

    /// What beams bear at their probes and supports; the largest curves, as many as can be named.
    fn section_forces(&self) -> Option<Figure> {
        let mut panels = Vec::new();
        for (kind, y_label, factor) in [
            (Kind::Moment, "Bending moment M (N m)", 1.0),
            (Kind::Shear, "Transverse force V (N)", 1.0),
            (Kind::Stress, "Normal stress (MPa)", 1e-6),
            (Kind::AxialForce, "Axial force N (N)", 1.0),
            (Kind::Reaction, "Reactions (N)", 1.0),
            (Kind::ReactionCouple, "Couples of supports (N m)", 1.0),
        ] {
            let columns = self.recorder.sections.iter().zip(self.recorder.first_section()..);
            let lines = columns.filter(|(column, _)| column.kind == kind).enumerate();
            let mut lines: Vec<Series> = lines
                .map(|(number, (column, k))| self.line(&self.recorder.section_label(column), number, k, factor))
                .filter(|line| largest([line]) > 0.0)
                .collect();
            if lines.is_empty() {
                continue;
            }
            let least = 1e-6 * largest(&lines);
            let (range, note) = cut(&lines, least, y_label.rsplit(['(', ')']).nth(1).unwrap_or_default());
            keep_named(&mut lines, LEGEND_WIDTH - note.as_deref().map_or(0.0, text_width));
            let y = cut_axis(y_label, range, &lines, least);
            panels.push(self.panel(y, lines).note(note));
        }
        (!panels.is_empty()).then(|| self.over_time("section_forces", "What beams bear over time", panels))
    }

    fn contact_forces(&self) -> Option<Figure> {
        let scenery = &self.recorder.scenery;
        let borders = self.recorder.kept.curves.borders();
        let points = 0..scenery.points;
        let curves: Vec<_> = points.map(|point| self.recorder.kept.curves.forces(point)).collect();
        let strongest = curves.iter().flatten().flat_map(|forces| &forces.normal).fold(0.0, |most: f64, f| f.max(most));
        let least = 1e-6 * strongest;
        let mut panels = Vec::new();
        for (pair, contact) in scenery.contacts.iter().enumerate() {
            let (mut normal, mut tangential, mut bands) = (Vec::new(), Vec::new(), Vec::new());
            for (point, drawn) in contact.points.iter().enumerate() {
                let Some(forces) = &curves[contact.first + point] else { continue };
                let label = &drawn.label;
                let step = |y: &[f64]| {
                    let end = borders.last().copied().unwrap_or_default();
                    Series::staircase(label, borders.iter().copied().zip(y.iter().copied()), end).number(point)
                };
                normal.push(step(&forces.normal));
                tangential.push(step(&forces.tangential));
                bands.push(Band::new(label, stretches(&borders, &forces.state)));
            }
            if normal.is_empty() {
                continue;
            }
            for (what, lines) in [("Normal", normal), ("Tangential", tangential)] {
                let (range, cut) = cut(&lines, least, "N");
                let name = (scenery.contacts.len() > 1).then(|| contact.name.clone());
                let note = [name, cut].into_iter().flatten().collect::<Vec<_>>().join(": ");
                let y = cut_axis(&format!("{what} force (N)"), range, &lines, least);
                let note = Some(note).filter(|note| !note.is_empty());
                panels.push(self.marked(Panel::new(y).with(lines), Some(pair)).note(note));
            }
            panels.push(Panel::bands(bands, [(STICK, "stick"), (SLIP, "slip"), (Colour::Paper, "open")]));
        }
        (!panels.is_empty()).then(|| self.over_time("contact_forces", "Contact forces on the blocks over time", panels))
    }

    fn energy(&self) -> Figure {
        let scenery = &self.recorder.scenery;
        let first = scenery.block_columns() + scenery.beams.len();
        let column = |name: &str| first + ENERGIES.iter().position(|known| *known == name).unwrap_or(0);
        let line =
            |&(name, label, number): &(&str, &str, usize), factor: f64| self.line(label, number, column(name), factor);
        let mut energies = vec![("kinetic", "kinetic", 0)];
        if !scenery.beams.is_empty() {
            energies.push(("elastic", "elastic", 1));
        }
        energies.extend([("gravity", "gravity (change)", 2), ("total", "total", 6)]);
        let scale = largest(&energies.iter().map(|energy| line(energy, 1.0)).collect::<Vec<_>>());
        let works = ["contact", "friction", "viscous", "numerical", "external", "projection"].into_iter().enumerate();
        let mut works: Vec<_> = works.map(|(k, name)| (name, name, k)).collect();
        // A work that is nothing but rounding is a line on the axis: chart junk.
        works.retain(|work| largest([&line(work, 1.0)]) > 1e-9 * scale);
        let panel = |what: &str, quantities: &[(&str, &str, usize)]| {
            let lines = |factor: f64| quantities.iter().map(|of| line(of, factor)).collect::<Vec<_>>();
            let (prefix, factor) = prefix(largest(&lines(1.0)));
            let lines = lines(factor);
            let y = Axis::around(format!("{what} ({prefix}J)"), values(&lines), 1e-6 * largest(&lines));
            self.panel(y, lines)
        };
        let mut panels = vec![panel("Energy", &energies)];
        if !works.is_empty() {
            panels.push(panel("Work since t = 0", &works));
        }
        self.over_time("energy", "Energies and works over time", panels)
    }
}

/// Moment and transverse force over the span: their least and largest in the run.
pub(super) fn envelopes(recorder: &PageRecorder) -> Option<Figure> {
    let drawn = || {
        recorder.beams.iter().filter_map(|record| {
            let place = recorder.layout.beams.iter().find(|place| place.name == record.beam)?;
            Some((record, place.beam.node_positions(), record.envelope.as_ref()?))
        })
    };
    let several = recorder.scenery.beams.len() > 1;
    let panel = |y_label: &str, pick: &dyn Fn(&Envelope) -> Vec<[f64; 2]>| {
        let mut lines = Vec::new();
        for (record, x, envelope) in drawn() {
            for (side, word) in [(1, "largest"), (0, "least")] {
                let label = if several { format!("{} {word}", record.beam) } else { word.to_owned() };
                let y = pick(envelope).into_iter().map(|range| range[side]);
                lines.push(Series::line(label, x.iter().copied().zip(y)).number(lines.len()));
            }
        }
        keep_named(&mut lines, LEGEND_WIDTH);
        Panel::new(Axis::around(y_label, values(&lines), 1e-6 * largest(&lines))).with(lines)
    };
    let span = drawn().filter_map(|(_, x, _)| x.last().copied()).fold(0.0, f64::max);
    (span > 0.0).then(|| {
        let title = "Bending moment and transverse force over the span, least and largest of all steps";
        Figure::new("envelopes", title, Axis::between("Place along the beam x (m)", 0.0, span))
            .panel(panel("Bending moment M (N m)", &|envelope| envelope.moment.clone()))
            .panel(panel("Transverse force V (N)", &|envelope| envelope.shear.clone()))
    })
}

/// Keeps the lines with the largest values, as many as can be named in this width, and their order.
fn keep_named(lines: &mut Vec<Series>, width: f64) {
    let mut by_size: Vec<(usize, f64)> = lines.iter().enumerate().map(|(k, line)| (k, largest([line]))).collect();
    by_size.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut left = width;
    let named = by_size.iter().take_while(|(k, _)| {
        left -= legend_width(lines[*k].label());
        left >= 0.0
    });
    let kept: Vec<usize> = named.map(|(k, _)| *k).collect();
    let mut k = 0;
    lines.retain(|_| {
        k += 1;
        kept.is_empty() || kept.contains(&(k - 1))
    });
}

/// The y of all points.
fn values<'a>(lines: impl IntoIterator<Item = &'a Series>) -> impl Iterator<Item = f64> {
    lines.into_iter().flat_map(Series::points).map(|point| point.1)
}

fn largest<'a>(lines: impl IntoIterator<Item = &'a Series>) -> f64 {
    values(lines).fold(0.0, |largest, y| y.abs().max(largest))
}

/// The prefix of a unit, with its factor, that makes the largest of some values a handy number.
fn prefix(largest: f64) -> (&'static str, f64) {
    let prefixes = [("k", 1e-3), ("", 1.0), ("m", 1e3), ("µ", 1e6), ("n", 1e9)];
    prefixes.into_iter().find(|(_, factor)| largest * factor >= 0.5).unwrap_or(("", 1.0))
}

/// Neighbours in one state as one stretch; the open ones left out.
fn stretches(borders: &[f64], states: &[ContactState]) -> Vec<(f64, f64, Colour)> {
    let mut stretches: Vec<(f64, f64, Colour)> = Vec::new();
    for (ends, state) in borders.windows(2).zip(states) {
        let colour = match state {
            ContactState::Open => continue,
            ContactState::Stick => STICK,
            ContactState::Slip => SLIP,
        };
        match stretches.last_mut() {
            Some(last) if last.1 == ends[0] && last.2 == colour => last.1 = ends[1],
            _ => stretches.push((ends[0], ends[1], colour)),
        }
    }
    stretches
}

/// A force this many times the one that nine of ten samples stay below is a peak of an impact, whose height is that of
/// the sample's length; the axis then ends at half as much, for the rest to be legible.
const PEAK: f64 = 6.0;

/// The range that shows the forces between impacts, where those would dwarf them.
fn cut(lines: &[Series], least: f64, unit: &str) -> (Option<(f64, f64)>, Option<String>) {
    let mut sizes: Vec<f64> = values(lines).map(f64::abs).filter(|y| *y > least && y.is_finite()).collect();
    sizes.sort_by(f64::total_cmp);
    let (Some(&usual), Some(&largest)) = (sizes.get(sizes.len() * 9 / 10), sizes.last()) else { return (None, None) };
    if largest <= PEAK * usual {
        return (None, None);
    }
    let limit = 0.5 * PEAK * usual;
    let negative = values(lines).any(|y| y < -0.01 * limit);
    let low = if negative { -limit } else { -0.06 * limit };
    (Some((low, limit)), Some(format!("peaks cut, up to {} {unit}", rounded(largest, 3))))
}

/// The y axis of lines that may have been cut to a range.
fn cut_axis(label: &str, range: Option<(f64, f64)>, lines: &[Series], least: f64) -> Axis {
    match range {
        Some((low, high)) => Axis::between(label, low, high),
        None => Axis::around(label, values(lines), least),
    }
}
