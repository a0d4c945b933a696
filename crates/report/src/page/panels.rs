//! The plots over time that the page and the figures have in common: which quantities, of which bodies, in which units, by the
//! rule of [`content`](super::content).

use super::content::{LeftOut, ROUNDING, holds, largest, travel};
use super::curves::{Curves, ForceCurve};
use super::recorder::{BLOCK_COLUMNS, ENERGIES, NUMBERS, PageRecorder};
use crate::sections::Kind;
use teeter_scenario::scene::LengthUnit;

/// Where on the page a panel stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    /// Before the contacts.
    Motion,
    /// After them.
    Forces,
}

/// A plot of quantities over time.
#[derive(Debug, Clone)]
pub(crate) struct TimePanel {
    /// What its file and its place on the page are called.
    pub(crate) id: String,
    /// What is plotted.
    pub(crate) title: String,
    /// A sentence for those who can't see the figure.
    pub(crate) description: String,
    pub(crate) unit: String,
    /// Least height of its axis, in its unit.
    pub(crate) least: f64,
    /// Lines across it, in its unit.
    pub(crate) guides: Vec<f64>,
    /// Whether the peaks of impacts are cut.
    pub(crate) cut: bool,
    pub(crate) place: Place,
    pub(crate) lines: Vec<Line>,
}

/// A curve.
#[derive(Debug, Clone)]
pub(crate) struct Line {
    /// Empty if it is the only one that there can be.
    pub(crate) label: String,
    /// Number of its colour.
    pub(crate) number: usize,
    pub(crate) y: Vec<f64>,
    /// Whether its times are the borders of buckets, not those of the curves.
    pub(crate) at_borders: bool,
}

/// A coordinate and its velocity, one over the other.
#[derive(Debug, Clone)]
pub(crate) struct Portrait {
    pub(crate) id: &'static str,
    pub(crate) title: String,
    pub(crate) x_label: String,
    pub(crate) y_label: String,
    pub(crate) x_unit: String,
    pub(crate) y_unit: String,
    pub(crate) least: [f64; 2],
    pub(crate) guides: Vec<f64>,
    /// Block by block: label, number, and its values at the borders of the buckets.
    pub(crate) lines: Vec<(String, usize, Vec<f64>, Vec<f64>)>,
}

/// All that is drawn over time of a run, but contact forces, and what isn't.
#[derive(Debug)]
pub(crate) struct Panels {
    pub(crate) curves: Curves,
    pub(crate) forces: Vec<Option<ForceCurve>>,
    pub(crate) panels: Vec<TimePanel>,
    pub(crate) portraits: Vec<Portrait>,
    pub(crate) left_out: Vec<LeftOut>,
    /// Whether tangential forces are more than rounding, by contacts.
    pub(crate) tangential: Vec<bool>,
}

/// A coordinate of a block.
struct Coordinate {
    id: &'static str,
    velocity_id: &'static str,
    symbol: &'static str,
    velocity_symbol: &'static str,
    name: &'static str,
    velocity_name: &'static str,
}

/// In the order of the state.
const COORDINATES: [Coordinate; 3] = [
    Coordinate {
        id: "x",
        velocity_id: "vx",
        symbol: "x",
        velocity_symbol: "ẋ",
        name: "Position x",
        velocity_name: "Velocity ẋ",
    },
    Coordinate {
        id: "y",
        velocity_id: "vy",
        symbol: "y",
        velocity_symbol: "ẏ",
        name: "Height y",
        velocity_name: "Velocity ẏ",
    },
    Coordinate {
        id: "phi",
        velocity_id: "omega",
        symbol: "φ",
        velocity_symbol: "φ̇",
        name: "Angle φ",
        velocity_name: "Angular velocity φ̇",
    },
];
const PHI: usize = 2;

/// A block that turns by this part of what it moves otherwise has φ in its phase portrait.
const TURNS: f64 = 0.01;

/// The unit of lengths on an axis, with its number to a metre: the scene's, unless it makes numbers too small.
pub(crate) fn length_unit(of: LengthUnit, largest: f64) -> (&'static str, f64) {
    let units = [(of.word(), of.per_metre()), ("mm", 1e3), ("µm", 1e6), ("nm", 1e9)];
    let fits = |(_, factor): &&(&'static str, f64)| largest == 0.0 || largest * factor >= 0.5;
    units.iter().find(fits).copied().unwrap_or(("nm", 1e9))
}

/// The prefix of a unit, with its factor, that makes the largest of some values a handy number.
pub(crate) fn prefix(largest: f64) -> (&'static str, f64) {
    let prefixes = [("k", 1e-3), ("", 1.0), ("m", 1e3), ("µ", 1e6), ("n", 1e9)];
    prefixes.into_iter().find(|(_, factor)| largest * factor >= 0.5).unwrap_or(("", 1.0))
}

impl Panels {
    pub(crate) fn of(recorder: &PageRecorder) -> Self {
        let forces = |curves: &Curves| (0..recorder.scenery.points).map(|k| curves.forces(k)).collect::<Vec<_>>();
        let drawn = |curves: Curves| {
            let forces = forces(&curves);
            let mut panels = Self {
                tangential: vec![true; recorder.scenery.contacts.len()],
                curves,
                forces,
                panels: Vec::new(),
                portraits: Vec::new(),
                left_out: Vec::new(),
            };
            panels.fill(recorder);
            panels
        };
        let all = drawn(recorder.kept.curves.clone());
        let (buckets, numbers) = (all.curves.len(), all.numbers());
        if numbers <= NUMBERS {
            return all;
        }
        drawn(all.curves.in_at_most(buckets * NUMBERS / numbers))
    }

    fn fill(&mut self, recorder: &PageRecorder) {
        if !recorder.scenery.is_crowded() {
            self.motions(recorder);
        }
        self.deflections(recorder);
        self.prescribed(recorder);
        self.contacts(recorder);
        self.sections(recorder);
        self.energies(recorder);
        if !recorder.scenery.is_crowded() {
            self.portraits(recorder);
        }
    }

    /// How many numbers the curves take on the page.
    fn numbers(&self) -> usize {
        let lines = self.panels.iter().flat_map(|panel| &panel.lines).map(|line| line.y.len()).sum::<usize>();
        let portraits = self.portraits.iter().flat_map(|portrait| &portrait.lines).map(|line| 2 * line.2.len());
        let forces = self.forces.iter().flatten().map(|forces| 2 * forces.normal.len());
        lines + portraits.sum::<usize>() + forces.sum::<usize>() + 3 * self.curves.len()
    }

    fn leave_out(&mut self, what: impl Into<String>, largest: f64, unit: &str) {
        self.left_out.push(LeftOut { what: what.into(), largest, unit: unit.to_owned() });
    }

    /// x, y, φ of the blocks and their velocities, of those that move in them.
    fn motions(&mut self, recorder: &PageRecorder) {
        let display = recorder.scenery.display;
        // First of all how it rocks.
        for c in [PHI, 0, 1] {
            let coordinate = &COORDINATES[c];
            let mut moving = Vec::new();
            for (k, block) in recorder.scenery.blocks.iter().enumerate() {
                let values = self.curves.curve(BLOCK_COLUMNS * k + c);
                let (scale, unit) = if c == PHI { (1.0, "rad") } else { (block.reach, "m") };
                if holds(travel(&values), scale) {
                    moving.push((k, values));
                } else {
                    self.leave_out(format!("{} of {}", coordinate.symbol, block.name), travel(&values), unit);
                }
            }
            if moving.is_empty() {
                continue;
            }
            let reach = recorder.scenery.blocks.iter().fold(0.0, |most: f64, block| most.max(block.reach));
            let (unit, factor) = if c == PHI {
                (display.angle.symbol(), display.angle.per_radian())
            } else {
                length_unit(display.length, largest(moving.iter().flat_map(|(_, values)| values)))
            };
            // Wide enough that what is at rest looks so, and rounding on top of it isn't seen.
            let least = if c == PHI { 4e-5 * factor } else { 1e-4 * reach * factor };
            let line = |k: usize, values: &[f64], factor: f64| Line {
                label: block_label(recorder, k),
                number: k,
                y: values.iter().map(|x| factor * x).collect(),
                at_borders: false,
            };
            let guides = if c == PHI { critical_angles(recorder, &moving, factor) } else { Vec::new() };
            let panel = |id: &str, title: &str, unit: String, lines, guides, least| TimePanel {
                id: id.to_owned(),
                title: title.to_owned(),
                description: format!("{title} of the blocks over time"),
                unit,
                least,
                guides,
                cut: false,
                place: Place::Motion,
                lines,
            };
            let lines = moving.iter().map(|(k, values)| line(*k, values, factor)).collect();
            self.panels.push(panel(coordinate.id, coordinate.name, unit.to_owned(), lines, guides, least));
            let rates: Vec<_> =
                moving.iter().map(|(k, _)| (*k, self.curves.curve(BLOCK_COLUMNS * k + 3 + c))).collect();
            let (unit, factor) = if c == PHI {
                ("rad", 1.0)
            } else {
                length_unit(display.length, largest(rates.iter().flat_map(|(_, values)| values)))
            };
            let lines = rates.iter().map(|(k, values)| line(*k, values, factor)).collect();
            let least = if c == PHI { 2e-3 } else { 1e-4 * reach * factor };
            let unit = format!("{unit}/s");
            self.panels.push(panel(coordinate.velocity_id, coordinate.velocity_name, unit, lines, Vec::new(), least));
        }
    }

    /// The deflections of the beams at midspan and at their probes.
    fn deflections(&mut self, recorder: &PageRecorder) {
        let scenery = &recorder.scenery;
        let several = scenery.beams.len() > 1;
        let mut drawn = Vec::new();
        for (number, beam) in scenery.beams.iter().enumerate() {
            let first = scenery.beam_column(number);
            let middle = if beam.probed_middle {
                format!("midspan, {}", recorder.place(0.5 * beam.span))
            } else {
                "midspan".to_owned()
            };
            let places = std::iter::once(middle).chain(beam.probes.iter().map(|(x, _)| recorder.place(*x)));
            for (k, place) in places.enumerate() {
                let values = self.curves.curve(first + k);
                let label = if several { format!("{} {place}", beam.name) } else { place.clone() };
                let asked = k > 0 || beam.probed_middle;
                if holds(largest(&values), 1e-3 * beam.span) {
                    drawn.push((label, values));
                } else {
                    self.leave_out(
                        format!("w at {label}{}", if asked { ", a probe" } else { "" }),
                        largest(&values),
                        "m",
                    );
                }
            }
        }
        if drawn.is_empty() {
            return;
        }
        let (unit, factor) = length_unit(scenery.display.length, largest(drawn.iter().flat_map(|(_, values)| values)));
        let span = scenery.beams.iter().fold(0.0, |longest: f64, beam| beam.span.max(longest));
        let only_middle = drawn.len() == 1 && !several && drawn[0].0.starts_with("midspan");
        let lines = drawn.into_iter().enumerate().map(|(number, (label, values))| Line {
            label: if only_middle { String::new() } else { label },
            number,
            y: values.into_iter().map(|w| factor * w).collect(),
            at_borders: false,
        });
        self.panels.push(TimePanel {
            id: "w_mid".to_owned(),
            title: if only_middle { "Deflection at midspan w" } else { "Deflection w" }.to_owned(),
            description: "Deflection of the beams over time".to_owned(),
            unit: unit.to_owned(),
            least: ROUNDING * 1e-2 * span * factor,
            guides: Vec::new(),
            cut: false,
            place: Place::Motion,
            lines: lines.collect(),
        });
    }

    /// Displacement, velocity and acceleration of ground and supports.
    fn prescribed(&mut self, recorder: &PageRecorder) {
        let scenery = &recorder.scenery;
        let display = scenery.display;
        for turns in [false, true] {
            let of_kind = || scenery.driven.iter().enumerate().filter(|(_, driven)| (driven.component == PHI) == turns);
            let several = of_kind().map(|(_, driven)| &driven.name).collect::<std::collections::BTreeSet<_>>().len()
                > 1
                || scenery.driven.iter().any(|driven| driven.name != "ground");
            for (k, (id, title)) in [("ground", "displacement"), ("ground_v", "velocity"), ("ground_a", "acceleration")]
                .into_iter()
                .enumerate()
            {
                let mut lines: Vec<Line> = of_kind()
                    .enumerate()
                    .map(|(number, (which, driven))| {
                        let axis = COORDINATES[driven.component].symbol;
                        let name = driven.name.replace('.', " ");
                        let label = if several { format!("{name} {axis}") } else { axis.to_owned() };
                        Line {
                            label,
                            number,
                            y: self.curves.curve(scenery.driven_column(which) + k),
                            at_borders: false,
                        }
                    })
                    .filter(|line| largest(&line.y) > 0.0)
                    .collect();
                if lines.is_empty() {
                    continue;
                }
                let most = largest(lines.iter().flat_map(|line| &line.y));
                let (unit, factor) = match (turns, k) {
                    (true, 0) => (display.angle.symbol(), display.angle.per_radian()),
                    (true, _) => ("rad", 1.0),
                    (false, 2) => ("m", 1.0),
                    (false, _) => length_unit(display.length, most),
                };
                lines.iter_mut().for_each(|line| line.y.iter_mut().for_each(|y| *y *= factor));
                let what = if several { "Prescribed" } else { "Ground" };
                let title = format!("{what} {}{title}", if turns { "angular " } else { "" });
                let title = title.replace("angular displacement", "angle");
                self.panels.push(TimePanel {
                    id: if turns { format!("{id}_phi") } else { id.to_owned() },
                    description: format!("{title} over time"),
                    title,
                    unit: format!("{unit}{}", ["", "/s", "/s²"][k]),
                    least: ROUNDING * most * factor,
                    guides: Vec::new(),
                    cut: false,
                    place: Place::Motion,
                    lines,
                });
            }
        }
    }

    /// Slip of the contacts; and whether their tangential forces are worth a plot.
    fn contacts(&mut self, recorder: &PageRecorder) {
        let scenery = &recorder.scenery;
        let strongest = largest(self.forces.iter().flatten().flat_map(|forces| &forces.normal));
        let several = scenery.contacts.len() > 1;
        let mut panels = Vec::new();
        let mut left_out = Vec::new();
        for (pair, contact) in scenery.contacts.iter().enumerate() {
            let points = contact.points.iter().enumerate();
            let points: Vec<_> =
                points.filter_map(|(k, point)| Some((k, point, self.forces[contact.first + k].as_ref()?))).collect();
            if points.is_empty() {
                continue;
            }
            let force = largest(points.iter().flat_map(|(_, _, forces)| &forces.tangential));
            self.tangential[pair] = holds(force, strongest);
            let of = if several { format!(" of {}", contact.name) } else { String::new() };
            if !self.tangential[pair] {
                left_out.push((format!("tangential force{of}"), force, "N"));
            }
            let reach = scenery.blocks[contact.block].reach;
            let slipping: Vec<_> = points.iter().filter(|(_, _, forces)| holds(largest(&forces.slip), reach)).collect();
            if slipping.is_empty() {
                let most = largest(points.iter().flat_map(|(_, _, forces)| &forces.slip));
                left_out.push((format!("slip{of}"), most, "m"));
                continue;
            }
            let most = largest(slipping.iter().flat_map(|(_, _, forces)| &forces.slip));
            let (unit, factor) = length_unit(scenery.display.length, most);
            let lines = slipping.iter().map(|(number, point, forces)| Line {
                label: point.label.clone(),
                number: *number,
                y: std::iter::once(0.0).chain(forces.slip.iter().map(|slip| factor * slip)).collect(),
                at_borders: true,
            });
            panels.push(TimePanel {
                id: format!("slip-{pair}"),
                title: format!("Slip{}", if several { format!(", {}", contact.name) } else { String::new() }),
                description: "Slip of the contacts over time".to_owned(),
                unit: unit.to_owned(),
                least: 10.0 * ROUNDING * reach * factor,
                guides: Vec::new(),
                cut: false,
                place: Place::Forces,
                lines: lines.collect(),
            });
        }
        self.panels.extend(panels);
        left_out.into_iter().for_each(|(what, most, unit)| self.leave_out(what, most, unit));
    }

    /// What beams bear at their probes and supports.
    fn sections(&mut self, recorder: &PageRecorder) {
        let columns: Vec<_> = recorder.sections.iter().zip(recorder.first_section()..).collect();
        let values: Vec<Vec<f64>> = columns.iter().map(|(_, k)| self.curves.curve(*k)).collect();
        // Of a recorder on its own, which has seen no section forces, there is nothing to draw or to tell.
        if !values.iter().flatten().any(|value| value.is_finite()) {
            return;
        }
        let most = |kinds: &[Kind]| {
            let of_kind = columns.iter().zip(&values).filter(|((column, _), _)| kinds.contains(&column.kind));
            largest(of_kind.flat_map(|(_, values)| values))
        };
        let span = recorder.scenery.beams.iter().fold(0.0, |longest: f64, beam| beam.span.max(longest));
        let moment = most(&[Kind::Moment, Kind::ReactionCouple]);
        let force = most(&[Kind::Shear, Kind::AxialForce, Kind::Reaction]).max(moment / span);
        let moment = moment.max(force * span);
        for (kind, title, unit, scale) in [
            (Kind::Moment, "Bending moment M", "N m", moment),
            (Kind::Shear, "Transverse force V", "N", force),
            (Kind::Stress, "Largest normal stress", "Pa", most(&[Kind::Stress])),
            (Kind::AxialForce, "Axial force N", "N", force),
            (Kind::Reaction, "Reactions of the supports", "N", force),
            (Kind::ReactionCouple, "Couples of the supports", "N m", moment),
        ] {
            let mut lines = Vec::new();
            let of_kind = columns.iter().zip(&values).filter(|((column, _), _)| column.kind == kind);
            for (number, ((column, _), values)) in of_kind.enumerate() {
                let label = recorder.section_label(column);
                if holds(largest(values), scale) {
                    lines.push(Line { label, number, y: values.clone(), at_borders: false });
                } else {
                    let what = title.to_lowercase();
                    let what = what.trim_end_matches([' ', 'm', 'v', 'n']).trim_end();
                    self.leave_out(
                        format!("{what} {}{label}", if label.is_empty() { "" } else { "at " }),
                        largest(values),
                        unit,
                    );
                }
            }
            if lines.is_empty() {
                continue;
            }
            let most = largest(lines.iter().flat_map(|line| &line.y));
            let (prefix, factor) = if kind == Kind::Stress { ("M", 1e-6) } else { prefix(most) };
            lines.iter_mut().for_each(|line| line.y.iter_mut().for_each(|y| *y *= factor));
            let id =
                serde_json::to_value(kind).ok().and_then(|word| word.as_str().map(str::to_owned)).unwrap_or_default();
            self.panels.push(TimePanel {
                id: format!("section-{id}"),
                title: title.to_owned(),
                description: format!("{title} over time"),
                unit: format!("{prefix}{unit}"),
                least: 1e-6 * most * factor,
                guides: Vec::new(),
                cut: true,
                place: Place::Forces,
                lines,
            });
        }
    }

    fn energies(&mut self, recorder: &PageRecorder) {
        let first = recorder.scenery.energy_column();
        let of = |curves: &Curves, name: &str| {
            let column = ENERGIES.iter().position(|known| *known == name).unwrap_or(0);
            curves.curve(first + column)
        };
        let energies = [("kinetic", 0), ("elastic", 1), ("gravity", 2), ("total", 6)];
        let energies =
            energies.into_iter().filter(|(name, _)| *name != "elastic" || !recorder.scenery.beams.is_empty());
        let energies: Vec<_> = energies.map(|(name, number)| (name, number, of(&self.curves, name))).collect();
        let scale = largest(energies.iter().flat_map(|(.., values)| values)).max(recorder.scenery.weight_energy);
        let works = ["contact", "friction", "viscous", "numerical", "external", "projection"];
        let works: Vec<_> = works.into_iter().enumerate().map(|(k, name)| (name, k, of(&self.curves, name))).collect();
        for (id, title, all) in [("energy", "Energy", energies), ("works", "Work since t = 0", works)] {
            let mut lines = Vec::new();
            for (name, number, values) in all {
                if holds(largest(&values), scale) {
                    let label = if name == "gravity" { "gravity, change" } else { name }.to_owned();
                    lines.push(Line { label, number, y: values, at_borders: false });
                } else {
                    let what = if id == "energy" { "energy" } else { "work" };
                    self.leave_out(format!("{name} {what}"), largest(&values), "J");
                }
            }
            if lines.is_empty() {
                continue;
            }
            let most = largest(lines.iter().flat_map(|line| &line.y));
            let (prefix, factor) = prefix(most);
            lines.iter_mut().for_each(|line| line.y.iter_mut().for_each(|y| *y *= factor));
            self.panels.push(TimePanel {
                id: id.to_owned(),
                title: title.to_owned(),
                description: format!("{title} of the scene over time"),
                unit: format!("{prefix}J"),
                least: (1e-6 * most).max(ROUNDING * scale) * factor,
                guides: Vec::new(),
                cut: false,
                place: Place::Forces,
                lines,
            });
        }
    }

    /// The coordinate in which each block moves most over its velocity.
    fn portraits(&mut self, recorder: &PageRecorder) {
        let display = recorder.scenery.display;
        let moves = |k: usize, c: usize| travel(&self.curves.curve(BLOCK_COLUMNS * k + c));
        let choice = |k: usize| {
            let reach = recorder.scenery.blocks[k].reach;
            let [x, y, turn] = [0, 1, PHI].map(|c| moves(k, c));
            if holds(turn, 1.0) && turn * reach >= TURNS * x.max(y) {
                Some(PHI)
            } else {
                [(0, x), (1, y)]
                    .into_iter()
                    .filter(|(_, far)| holds(*far, reach))
                    .max_by(|a, b| a.1.total_cmp(&b.1))
                    .map(|(c, _)| c)
            }
        };
        let chosen: Vec<(usize, usize)> =
            (0..recorder.scenery.blocks.len()).filter_map(|k| Some((k, choice(k)?))).collect();
        for c in [PHI, 0, 1] {
            let blocks = || chosen.iter().filter(|(_, own)| *own == c).map(|(k, _)| *k);
            if blocks().next().is_none() {
                continue;
            }
            let samples = |k: usize, column: usize| self.curves.samples(BLOCK_COLUMNS * k + column);
            let (units, factors) = if c == PHI {
                ([display.angle.symbol(), "rad"], [display.angle.per_radian(), 1.0])
            } else {
                let most = |of: usize| blocks().map(|k| largest(&samples(k, of))).fold(0.0, f64::max);
                let [(x, a), (v, b)] = [c, 3 + c].map(|of| length_unit(display.length, most(of)));
                ([x, v], [a, b])
            };
            let line = |k: usize| {
                let [x, y] = [c, 3 + c].map(|column| samples(k, column));
                let scaled = |values: Vec<f64>, factor: f64| values.into_iter().map(|x| x * factor).collect();
                (block_label(recorder, k), k, scaled(x, factors[0]), scaled(y, factors[1]))
            };
            let coordinate = &COORDINATES[c];
            let reach = blocks().map(|k| recorder.scenery.blocks[k].reach).fold(0.0, f64::max);
            let alphas = blocks().filter_map(|k| recorder.scenery.blocks[k].alpha).filter(|_| c == PHI);
            let mut guides: Vec<f64> = alphas.flat_map(|alpha| [-alpha * factors[0], alpha * factors[0]]).collect();
            guides.sort_by(f64::total_cmp);
            guides.dedup();
            let portrait = Portrait {
                id: ["phase_x", "phase_y", "phase"][c],
                title: format!("Phase portrait: {} over {}", coordinate.velocity_symbol, coordinate.symbol),
                x_label: coordinate.name.to_owned(),
                y_label: coordinate.velocity_name.to_owned(),
                x_unit: units[0].to_owned(),
                y_unit: format!("{}/s", units[1]),
                least: if c == PHI { [4e-5 * factors[0], 2e-3] } else { factors.map(|factor| 1e-4 * reach * factor) },
                guides,
                lines: blocks().map(line).collect(),
            };
            self.portraits.push(portrait);
        }
    }
}

/// A block's name, if there are others.
fn block_label(recorder: &PageRecorder, k: usize) -> String {
    let blocks = &recorder.scenery.blocks;
    if blocks.len() > 1 { blocks[k].name.clone() } else { String::new() }
}

/// The critical angles, where the motion comes near them: elsewhere they would only squeeze the curve.
fn critical_angles(recorder: &PageRecorder, moving: &[(usize, Vec<f64>)], factor: f64) -> Vec<f64> {
    let near = |(k, values): &(usize, Vec<f64>)| {
        recorder.scenery.blocks[*k].alpha.filter(|alpha| largest(values) > 0.8 * alpha)
    };
    let mut guides: Vec<f64> =
        moving.iter().filter_map(near).flat_map(|alpha| [-alpha * factor, alpha * factor]).collect();
    guides.sort_by(f64::total_cmp);
    guides.dedup();
    guides
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_in_the_unit_of_the_scene_unless_too_small_for_it() {
        assert_eq!(length_unit(LengthUnit::Centimetre, 0.18), ("cm", 100.0));
        assert_eq!(length_unit(LengthUnit::Centimetre, 1.2e-3), ("mm", 1e3));
        assert_eq!(length_unit(LengthUnit::Metre, 3e-7), ("nm", 1e9));
        assert_eq!(length_unit(LengthUnit::Millimetre, 0.0), ("mm", 1e3));
    }
}
