//! The plots of the page as figures for a paper.

use super::plot::{Band, Figure, Line, Panel, range_of};
use super::recorder::{BLOCK_COLUMNS, ENERGIES, ImpactMark, PageRecorder};
use super::rounded;
use super::scenery::CORNERS;
use teeter_integrator::ContactState;

/// File names and SVG text of the figures that the scene has: `phi.svg`, `omega.svg` and `phase.svg` with blocks,
/// `w_mid.svg` with beams, `contact_forces.svg` where contacts carried something, `energy.svg` always.
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
                let (range, cut) = cut(&lines, least);
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
fn cut(lines: &[Line], least: f64) -> (Option<(f64, f64)>, Option<String>) {
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
    (Some((low, limit)), Some(format!("peaks cut, up to {} N", rounded(largest, 3))))
}
