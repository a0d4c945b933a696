//! The plots of the page as figures for a paper.

use super::plot::{Band, Figure, KEY_WIDTH, Line, Panel, key_width, range_of, text_width};
use super::recorder::{BLOCK_COLUMNS, ENERGIES, ImpactMark, PageRecorder};
use super::rounded;
use super::scenery::CORNERS;
use crate::sections::Kind;
use teeter_beam::Envelope;
use teeter_integrator::ContactState;

/// File names and SVG text of the figures that the scene has: `phi.svg`, `omega.svg` and `phase.svg` with blocks,
/// `w_mid.svg` with beams, `section_forces.svg` and `envelopes.svg` where the scene asks for what beams bear, `contact_forces.svg` where contacts carried something, `energy.svg` always.
#[must_use]
pub fn figures(recorder: &PageRecorder) -> Vec<(String, String)> {
    let plots = Plots { recorder, t: recorder.kept.curves.times() };
    let scenery = &recorder.scenery;
    let mut figures = Vec::new();
    let mut add = |name: &str, figure: Figure| figures.push((name.to_owned(), figure.to_svg()));
    if !scenery.blocks.is_empty() {
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
    figures
}

/// Colours of sticking and slipping; an open contact has none.
const STICK: &str = "#56B4E9";
const SLIP: &str = "#D55E00";

/// Least range of angles (°) and angular velocities (rad/s).
const STILL: f64 = 2e-3;

struct Plots<'a> {
    recorder: &'a PageRecorder,
    t: Vec<f64>,
}

impl<'a> Plots<'a> {
    fn over_time(&self, id: &'static str, title: &str, panels: Vec<Panel>) -> Figure {
        let (start, end) = (self.t[0], self.t[self.t.len() - 1]);
        Figure {
            id,
            title: title.to_owned(),
            x_label: "Time t (s)".to_owned(),
            x_range: (start, if end > start { end } else { start + 1.0 }),
            panels,
            marks: self.recorder.kept.impacts.iter().map(|impact| impact.t).collect(),
        }
    }

    fn line(&self, label: &str, number: usize, column: usize, factor: f64) -> Line {
        let y = self.recorder.kept.curves.curve(column).into_iter().map(|y| factor * y).collect();
        Line { label: label.to_owned(), number, x: self.t.clone(), y }
    }

    /// A line for each block, from the column that is `offset` after its first.
    fn by_block(&self, offset: usize, factor: f64) -> Vec<Line> {
        let blocks = &self.recorder.scenery.blocks;
        let label = |name: &'a str| if blocks.len() > 1 { name } else { "" };
        blocks
            .iter()
            .enumerate()
            .map(|(k, block)| self.line(label(&block.name), k, BLOCK_COLUMNS * k + offset, factor))
            .collect()
    }

    fn phi(&self) -> Figure {
        let lines = self.by_block(0, 1f64.to_degrees());
        let panel = Panel { y_label: "Angle φ (°)".to_owned(), lines, least: STILL, ..Panel::default() };
        self.over_time("phi", "Angle of the blocks over time", vec![panel])
    }

    fn omega(&self) -> Figure {
        let lines = self.by_block(1, 1.0);
        let panel =
            Panel { y_label: "Angular velocity φ̇ (rad/s)".to_owned(), lines, least: STILL, ..Panel::default() };
        self.over_time("omega", "Angular velocity of the blocks over time", vec![panel])
    }

    fn phase(&self) -> Figure {
        let blocks = &self.recorder.scenery.blocks;
        let mut lines = self.by_block(1, 1.0);
        for (k, line) in lines.iter_mut().enumerate() {
            line.x = self.line("", k, BLOCK_COLUMNS * k, 1f64.to_degrees()).y;
        }
        let x_range = range_of(lines.iter().flat_map(|line| &line.x).copied(), STILL);
        // A block's critical angles, where one of them is reached: beyond, it overturns.
        let guides = blocks.iter().flat_map(|block| [-block.alpha.to_degrees(), block.alpha.to_degrees()]).collect();
        let panel =
            Panel {
                y_label: "Angular velocity φ̇ (rad/s)".to_owned(), lines, guides, least: STILL, ..Panel::default()
            };
        Figure {
            id: "phase",
            title: "Phase portrait of the blocks".to_owned(),
            x_label: "Angle φ (°)".to_owned(),
            x_range,
            panels: vec![panel],
            marks: Vec::new(),
        }
    }

    fn w_mid(&self) -> Figure {
        let first = BLOCK_COLUMNS * self.recorder.scenery.blocks.len();
        let beams = &self.recorder.scenery.beams;
        let label = |name: &'a str| if beams.len() > 1 { name } else { "" };
        let lines = beams.iter().enumerate().map(|(k, beam)| self.line(label(&beam.name), k, first + k, 1e3)).collect();
        let span = beams.iter().fold(0.0, |longest, beam| beam.span.max(longest));
        let panel =
            Panel { y_label: "Midspan deflection w (mm)".to_owned(), lines, least: 1e-6 * span, ..Panel::default() };
        self.over_time("w_mid", "Deflection of the beams at midspan over time", vec![panel])
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
            let mut lines: Vec<Line> = lines
                .map(|(number, (column, k))| self.line(&self.recorder.section_label(column), number, k, factor))
                .filter(|line| largest(std::slice::from_ref(line)) > 0.0)
                .collect();
            if lines.is_empty() {
                continue;
            }
            let least = 1e-6 * largest(&lines);
            let (range, note) = cut(&lines, least, y_label.rsplit(['(', ')']).nth(1).unwrap_or_default());
            let room = KEY_WIDTH - note.as_deref().map_or(0.0, text_width);
            keep_named(&mut lines, room);
            panels.push(Panel { y_label: y_label.to_owned(), lines, range, note, least, ..Panel::default() });
        }
        (!panels.is_empty()).then(|| self.over_time("section_forces", "What beams bear over time", panels))
    }

    fn contact_forces(&self) -> Option<Figure> {
        let scenery = &self.recorder.scenery;
        let borders = self.recorder.kept.curves.borders();
        let points = 0..CORNERS * scenery.contacts.len();
        let curves: Vec<_> = points.map(|point| self.recorder.kept.curves.forces(point)).collect();
        let strongest = curves.iter().flatten().flat_map(|forces| &forces.normal).fold(0.0, |most: f64, f| f.max(most));
        let least = 1e-6 * strongest;
        let mut panels = Vec::new();
        for (pair, contact) in scenery.contacts.iter().enumerate() {
            let (mut normal, mut tangential, mut bands) = (Vec::new(), Vec::new(), Vec::new());
            for point in 0..CORNERS {
                let Some(forces) = &curves[CORNERS * pair + point] else { continue };
                let label = scenery.corners[point].replace('-', " ");
                let step = |y: &[f64]| {
                    let (x, y) = steps(&borders, y);
                    Line { label: label.clone(), number: point, x, y }
                };
                normal.push(step(&forces.normal));
                tangential.push(step(&forces.tangential));
                bands.push(Band { label: label.clone(), stretches: stretches(&borders, &forces.state) });
            }
            if normal.is_empty() {
                continue;
            }
            let mine = |impact: &&ImpactMark| impact.contact == pair;
            let marks: Vec<f64> = self.recorder.kept.impacts.iter().filter(mine).map(|impact| impact.t).collect();
            for (what, lines) in [("Normal", normal), ("Tangential", tangential)] {
                let (range, cut) = cut(&lines, least, "N");
                let name = (scenery.contacts.len() > 1).then(|| contact.name.clone());
                let note = [name, cut].into_iter().flatten().collect::<Vec<_>>().join(": ");
                panels.push(Panel {
                    y_label: format!("{what} force (N)"),
                    lines,
                    range,
                    note: Some(note).filter(|note| !note.is_empty()),
                    least,
                    marks: Some(marks.clone()),
                    ..Panel::default()
                });
            }
            let band_key = vec![(STICK, "stick"), (SLIP, "slip"), ("#fff", "open")];
            panels.push(Panel { bands, band_key, ..Panel::default() });
        }
        (!panels.is_empty()).then(|| self.over_time("contact_forces", "Contact forces on the blocks over time", panels))
    }

    fn energy(&self) -> Figure {
        let scenery = &self.recorder.scenery;
        let first = BLOCK_COLUMNS * scenery.blocks.len() + scenery.beams.len();
        let column = |name: &str| first + ENERGIES.iter().position(|known| *known == name).unwrap_or(0);
        let named = |name: &'static str, label: &str, number: usize| self.line(label, number, column(name), 1.0);
        let mut energies = vec![named("kinetic", "kinetic", 0)];
        if !scenery.beams.is_empty() {
            energies.push(named("elastic", "elastic", 1));
        }
        energies.extend([named("gravity", "gravity (change)", 2), named("total", "total", 6)]);
        let scale = largest(&energies);
        let works = ["contact", "friction", "viscous", "numerical", "external", "projection"].into_iter().enumerate();
        let mut works: Vec<Line> = works.map(|(k, name)| named(name, name, k)).collect();
        // A work that is nothing but rounding is a line on the axis: chart junk.
        works.retain(|line| largest(std::slice::from_ref(line)) > 1e-9 * scale);
        let panel = |what: &str, mut lines: Vec<Line>| {
            let (prefix, factor) = prefix(largest(&lines));
            lines.iter_mut().flat_map(|line| &mut line.y).for_each(|y| *y *= factor);
            let least = 1e-6 * largest(&lines);
            Panel { y_label: format!("{what} ({prefix}J)"), lines, least, ..Panel::default() }
        };
        let mut panels = vec![panel("Energy", energies)];
        if !works.is_empty() {
            panels.push(panel("Work since t = 0", works));
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
                let y = pick(envelope).iter().map(|range| range[side]).collect();
                lines.push(Line { label, number: lines.len(), x: x.to_vec(), y });
            }
        }
        keep_named(&mut lines, KEY_WIDTH);
        let least = 1e-6 * largest(&lines);
        Panel { y_label: y_label.to_owned(), lines, least, ..Panel::default() }
    };
    let span = drawn().filter_map(|(_, x, _)| x.last().copied()).fold(0.0, f64::max);
    (span > 0.0).then(|| Figure {
        id: "envelopes",
        title: "Bending moment and transverse force over the span, least and largest of all steps".to_owned(),
        x_label: "Place along the beam x (m)".to_owned(),
        x_range: (0.0, span),
        panels: vec![
            panel("Bending moment M (N m)", &|envelope| envelope.moment.clone()),
            panel("Transverse force V (N)", &|envelope| envelope.shear.clone()),
        ],
        marks: Vec::new(),
    })
}

/// Keeps the lines with the largest values, as many as can be named in this width, and their order.
fn keep_named(lines: &mut Vec<Line>, width: f64) {
    let mut by_size: Vec<(usize, f64)> =
        lines.iter().enumerate().map(|(k, line)| (k, largest(std::slice::from_ref(line)))).collect();
    by_size.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut left = width;
    let named = by_size.iter().take_while(|(k, _)| {
        left -= key_width(&lines[*k].label);
        left >= 0.0
    });
    let kept: Vec<usize> = named.map(|(k, _)| *k).collect();
    let mut k = 0;
    lines.retain(|_| {
        k += 1;
        kept.is_empty() || kept.contains(&(k - 1))
    });
}

fn largest(lines: &[Line]) -> f64 {
    lines.iter().flat_map(|line| &line.y).fold(0.0, |largest, y| y.abs().max(largest))
}

/// The prefix of a unit, with its factor, that makes the largest of some values a handy number.
fn prefix(largest: f64) -> (&'static str, f64) {
    let prefixes = [("k", 1e-3), ("", 1.0), ("m", 1e3), ("µ", 1e6), ("n", 1e9)];
    prefixes.into_iter().find(|(_, factor)| largest * factor >= 0.5).unwrap_or(("", 1.0))
}

/// A value a bucket as a line of steps.
fn steps(borders: &[f64], y: &[f64]) -> (Vec<f64>, Vec<f64>) {
    borders.windows(2).zip(y).flat_map(|(ends, &y)| [(ends[0], y), (ends[1], y)]).unzip()
}

/// Neighbours in one state as one stretch; the open ones left out.
fn stretches(borders: &[f64], states: &[ContactState]) -> Vec<(f64, f64, &'static str)> {
    let mut stretches: Vec<(f64, f64, &'static str)> = Vec::new();
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
fn cut(lines: &[Line], least: f64, unit: &str) -> (Option<(f64, f64)>, Option<String>) {
    let mut sizes: Vec<f64> =
        lines.iter().flat_map(|line| &line.y).map(|y| y.abs()).filter(|y| *y > least && y.is_finite()).collect();
    sizes.sort_by(f64::total_cmp);
    let (Some(&usual), Some(&largest)) = (sizes.get(sizes.len() * 9 / 10), sizes.last()) else { return (None, None) };
    if largest <= PEAK * usual {
        return (None, None);
    }
    let limit = 0.5 * PEAK * usual;
    let negative = lines.iter().flat_map(|line| &line.y).any(|y| *y < -0.01 * limit);
    let low = if negative { -limit } else { -0.06 * limit };
    (Some((low, limit)), Some(format!("peaks cut, up to {} {unit}", rounded(largest, 3))))
}
