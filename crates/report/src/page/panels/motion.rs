//! Plots of how blocks, beams, ground and supports move.

use super::{Curves, Line, Measure, Panels, Place, Portrait, PortraitLine, Source, TimePanel, coincident};
use crate::driven::Driven;
use crate::page::content::{ROUNDING, holds, largest, power_of_ten, travel};
use crate::page::notes::Note;
use crate::page::orbit::Point;
use crate::page::recorder::{BLOCK_COLUMNS, BLOCK_COORDINATES, PageRecorder, coordinate_in};
use crate::page::scenery::{BeamDrawn, FREE};
use crate::{shortest, with_digits};
use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::ops::Range;

/// A coordinate of a block.
struct Coordinate {
    id: &'static str,
    of: &'static str,
    velocity_id: &'static str,
    symbol: &'static str,
    velocity_symbol: &'static str,
    name: &'static str,
    /// As measured from the start.
    from_start: &'static str,
    velocity_name: &'static str,
}

/// In the order of the state.
const COORDINATES: [Coordinate; 3] = [
    Coordinate {
        id: "x",
        of: "change of x of",
        velocity_id: "vx",
        symbol: "x",
        velocity_symbol: "ẋ",
        name: "Position x",
        from_start: "Displacement x − x₀",
        velocity_name: "Velocity ẋ",
    },
    Coordinate {
        id: "y",
        of: "change of y of",
        velocity_id: "vy",
        symbol: "y",
        velocity_symbol: "ẏ",
        name: "Height y",
        from_start: "Displacement y − y₀",
        velocity_name: "Velocity ẏ",
    },
    Coordinate {
        id: "phi",
        of: "change of φ of",
        velocity_id: "omega",
        symbol: "φ",
        velocity_symbol: "ω",
        name: "Angle φ",
        from_start: "Angle φ − φ₀",
        velocity_name: "Angular velocity ω",
    },
];
const PHI: usize = 2;

/// Most points of all phase portraits together.
const PORTRAIT_POINTS: usize = 16_000;

/// A block that turns by this part of what it moves otherwise has φ in its phase portrait.
const TURNS: f64 = 0.01;

impl Panels {
    /// x, y, φ of the blocks and their velocities, of those that move in them.
    pub(super) fn motions(&mut self, recorder: &PageRecorder) {
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
                    self.leave_out(coordinate.of, Some((block.name.clone(), "blocks")), [travel(&values), scale], unit);
                }
            }
            // A ball that rolls by would make the rocking of all others a line.
            let rolls = |(_, values): &(usize, Vec<f64>)| c == PHI && travel(values) > PI;
            let (rolling, standing): (Vec<_>, Vec<_>) = moving.into_iter().partition(rolls);
            let beside = !standing.is_empty();
            self.motion(recorder, c, standing, false);
            self.motion(recorder, c, rolling, beside);
        }
    }

    /// A coordinate of blocks that move in it, and its velocity; of some that roll, or turn over, beside others that don't.
    fn motion(&mut self, recorder: &PageRecorder, c: usize, moving: Vec<(usize, Vec<f64>)>, rolls: bool) {
        if moving.is_empty() {
            return;
        }
        let display = recorder.scenery.display;
        let coordinate = &COORDINATES[c];
        let [id, velocity_id] = [coordinate.id, coordinate.velocity_id]
            .map(|id| if rolls { format!("{id}_rolling") } else { id.to_owned() });
        let of_whom = if rolls { ", of what turns by more than 180°" } else { "" };
        let reach = recorder.scenery.blocks.iter().fold(0.0, |most: f64, block| most.max(block.reach));
        let far = moving.iter().map(|(_, values)| travel(values)).fold(0.0, f64::max);
        // Blocks that stand far apart would all look still.
        let from_start = c != PHI && moving.len() > 1 && far < FAR * extent(&moving);
        let zero = |k: usize| match recorder.kept.frames.rows().next() {
            Some((_, start)) if from_start => coordinate_in(recorder, start, k, c),
            _ => 0.0,
        };
        // Lengths are in metres until the units of the page are chosen.
        let (unit, factor) = if c == PHI { (display.angle.symbol(), display.angle.per_radian()) } else { ("", 1.0) };
        let measures = if c == PHI { [Measure::Own; 2] } else { [Measure::Position, Measure::Velocity] };
        // Wide enough that what is at rest looks so, and rounding on top of it isn't seen.
        let least = if c == PHI { 4e-5 * factor } else { 1e-4 * reach * factor };
        let line = |curves: &Curves, k: usize, c: usize, zero: f64, factor: f64| {
            let source = Source { column: BLOCK_COLUMNS * k + c, zero, factor };
            Line::from_zero(curves, source, block_label(recorder, k), k)
        };
        let guides = if c == PHI { critical_angles(recorder, &moving, factor) } else { Vec::new() };
        let panel =
            |id: &str, title: &str, (measure, unit): (Measure, String), lines, guides, least, note: Option<Note>| {
                TimePanel {
                    id: id.to_owned(),
                    notes: note.into_iter().collect(),
                    of_contact: None,
                    title: title.to_owned(),
                    description: format!("{title} of the blocks over time"),
                    measure,
                    unit,
                    least,
                    guides,
                    t: None,
                    cut: false,
                    place: Place::Motion,
                    lines,
                }
            };
        let lines = moving.iter().map(|(k, _)| line(&self.curves, *k, c, zero(*k), factor)).collect();
        let on = from_base(recorder, &self.curves, c);
        let name = format!("{}{on}{of_whom}", if from_start { coordinate.from_start } else { coordinate.name });
        let size = |x: f64| match c {
            // As small as that it is no decimal number.
            PHI => match shortest(x * factor, 2) {
                text if text.contains('e') => format!("{}\u{a0}{unit}", power_of_ten(x * factor)),
                text => format!("{text}\u{a0}{unit}"),
            },
            _ => with_digits(x, "m", 2),
        };
        let note = unseen(moving.iter().map(|(k, values)| (block_label(recorder, *k), travel(values))), size);
        self.panels.push(panel(&id, &name, (measures[0], unit.to_owned()), lines, guides, least, note));
        let lines = moving.iter().map(|(k, _)| line(&self.curves, *k, 3 + c, 0.0, 1.0)).collect();
        let least = if c == PHI { 2e-3 } else { 1e-4 * reach };
        let unit = (measures[1], "rad/s".to_owned());
        let rates = moving.iter().map(|(k, _)| {
            (block_label(recorder, *k), largest(&self.curves.curve(BLOCK_COLUMNS * k + BLOCK_COORDINATES + c)))
        });
        let note = unseen(rates, |x| with_digits(x, if c == PHI { "rad/s" } else { "m/s" }, 2));
        self.panels.push(panel(
            &velocity_id,
            &format!("{}{on}{of_whom}", coordinate.velocity_name),
            unit,
            lines,
            Vec::new(),
            least,
            note,
        ));
    }

    /// The deflections of the beams at midspan and at their probes.
    pub(super) fn deflections(&mut self, recorder: &PageRecorder) {
        let scenery = &recorder.scenery;
        let several = scenery.beams.len() > 1;
        // Places without a probe have the colours after those of the probes.
        let (mut drawn, mut elsewhere) = (Vec::new(), 0);
        for (number, beam) in scenery.beams.iter().enumerate() {
            let first = scenery.beam_column(number);
            let middle = format!("{}, {}", middle_word(beam), recorder.place(0.5 * beam.span));
            let place = |x: f64| {
                let end = [0.0, beam.span].iter().zip(beam.supports).any(|(end, support)| *end == x && support == FREE);
                format!("{}{}", if end { "free end, " } else { "" }, recorder.place(x))
            };
            let places =
                std::iter::once((0.5 * beam.span, middle)).chain(beam.probes.iter().map(|(x, _)| (*x, place(*x))));
            for (k, (x, place)) in places.enumerate() {
                let values = self.curves.curve(first + k);
                let label = if several { format!("{} {place}", beam.name) } else { place.clone() };
                let what = if k > 0 || beam.probed_middle { "w at the probe" } else { "w at" };
                let colour = recorder.number_of_probe(number, x).unwrap_or_else(|| {
                    elsewhere += 1;
                    recorder.probe_count() + elsewhere - 1
                });
                if holds(largest(&values), 1e-3 * beam.span) {
                    drawn.push((label, first + k, colour));
                } else {
                    self.leave_out(what, Some((label, "places")), [largest(&values), 1e-3 * beam.span], "m");
                }
            }
        }
        if drawn.is_empty() {
            return;
        }
        let span = scenery.beams.iter().fold(0.0, |longest: f64, beam| beam.span.max(longest));
        let free: Vec<&str> =
            scenery.beams.iter().filter(|beam| beam.is_free()).map(|beam| beam.name.as_str()).collect();
        let note = (!free.is_empty()).then(|| {
            let holds =
                if several { format!("of {}, which no support holds, ", free.join(", ")) } else { String::new() };
            Note::of_plot(format!("{holds}measured from the line through the ends of the beam"))
        });
        let only_middle = drawn.len() == 1 && !several && drawn[0].0.starts_with(MIDSPAN);
        let lines = drawn.into_iter().map(|(label, column, number)| {
            let label = if only_middle { String::new() } else { label };
            Line::of(&self.curves, column, 1.0, label, number)
        });
        let lines = lines.collect();
        self.panels.push(TimePanel {
            id: "w_mid".to_owned(),
            notes: note.into_iter().collect(),
            of_contact: None,
            title: if only_middle { "Deflection at midspan w" } else { "Deflection w" }.to_owned(),
            description: "Deflection of the beams over time".to_owned(),
            measure: Measure::Deflection,
            unit: String::new(),
            least: ROUNDING * 1e-2 * span,
            guides: Vec::new(),
            t: None,
            cut: false,
            place: Place::Motion,
            lines,
        });
    }

    /// Displacement, velocity and acceleration of ground and supports.
    pub(super) fn prescribed(&mut self, recorder: &PageRecorder) {
        let scenery = &recorder.scenery;
        let display = scenery.display;
        for turns in [false, true] {
            let of_kind = || scenery.driven.iter().enumerate().filter(|(_, driven)| (driven.component == PHI) == turns);
            let several = of_kind().map(|(_, driven)| &driven.name).collect::<BTreeSet<_>>().len() > 1
                || scenery.driven.iter().any(|driven| driven.name != "ground");
            for (k, (id, title)) in [("ground", "displacement"), ("ground_v", "velocity"), ("ground_a", "acceleration")]
                .into_iter()
                .enumerate()
            {
                let moving: Vec<_> = of_kind()
                    .enumerate()
                    .map(|(number, (which, driven))| (number, driven, scenery.driven_column(which) + k))
                    .map(|(number, driven, column)| (number, driven, column, largest(&self.curves.curve(column))))
                    .filter(|(.., largest)| *largest > 0.0)
                    .collect();
                if moving.is_empty() {
                    continue;
                }
                let most = moving.iter().fold(0.0, |most: f64, (.., largest)| most.max(*largest));
                let (measure, unit, factor) = match (turns, k) {
                    (true, 0) => (Measure::Own, display.angle.symbol(), display.angle.per_radian()),
                    (true, _) => (Measure::Own, "rad", 1.0),
                    (false, 0) => (Measure::Position, "", 1.0),
                    (false, 1) => (Measure::Velocity, "", 1.0),
                    (false, _) => (Measure::Own, "m", 1.0),
                };
                let label = |driven: &Driven| {
                    let axis = COORDINATES[driven.component].symbol;
                    let name = driven.name.replace('.', " ");
                    if several { format!("{name} {axis}") } else { axis.to_owned() }
                };
                // Where curves have the extremes of many steps, what is smooth is drawn as that.
                let t = if self.curves.is_thinned() { smooth_times(&self.curves) } else { Vec::new() };
                let smooth: Option<Vec<Vec<f64>>> = moving
                    .iter()
                    .map(|(_, driven, column, _)| smooth(&t, |t| driven.prescribed(t)[k], &self.curves.curve(*column)))
                    .collect();
                let lines = moving.into_iter().enumerate().map(|(place, (number, driven, column, _))| {
                    let label = label(driven);
                    match &smooth {
                        Some(smooth) => {
                            let y = smooth[place].iter().map(|y| factor * y).collect();
                            Line { label, number, y, is_raw: false, itself: Vec::new(), of: None }
                        }
                        None => Line::of(&self.curves, column, factor, label, number),
                    }
                });
                let lines = lines.collect();
                let what = if several { "Prescribed" } else { "Ground" };
                let title = format!("{what} {}{title}", if turns { "angular " } else { "" });
                let title = title.replace("angular displacement", "angle");
                self.panels.push(TimePanel {
                    id: if turns { format!("{id}_phi") } else { id.to_owned() },
                    description: format!("{title} over time"),
                    notes: Vec::new(),
                    of_contact: None,
                    title,
                    measure,
                    unit: format!("{unit}{}", ["", "/s", "/s²"][k]),
                    least: ROUNDING * most * factor,
                    guides: Vec::new(),
                    t: smooth.is_some().then_some(t),
                    cut: false,
                    place: Place::Motion,
                    lines,
                });
            }
        }
    }

    /// How far a block goes along an axis beside what may carry it: of the world, or what it is plotted from, and the other prescribed motions
    /// along that axis, the one from which it goes least far.
    fn carried_travel(&self, recorder: &PageRecorder, block: usize, axis: usize) -> f64 {
        let own = self.curves.curve(BLOCK_COLUMNS * block + axis);
        let base = recorder.scenery.bases[axis];
        let along = recorder.scenery.driven.iter().enumerate();
        let along = along.filter(|(which, driven)| driven.component == axis && base != Some(*which));
        let beside = along.map(|(which, _)| {
            let carrier = self.curves.curve(recorder.scenery.driven_column(which));
            travel(&own.iter().zip(&carrier).map(|(own, carrier)| own - carrier).collect::<Vec<_>>())
        });
        beside.fold(travel(&own), f64::min)
    }

    /// The coordinate in which each block moves most over its velocity.
    pub(super) fn portraits(&mut self, recorder: &PageRecorder) {
        let display = recorder.scenery.display;
        let moves = |k: usize, c: usize| travel(&self.curves.curve(BLOCK_COLUMNS * k + c));
        let rocks = |k: usize| holds(moves(k, PHI), 1.0) && moves(k, PHI) <= PI;
        let others_rock = (0..recorder.scenery.blocks.len()).any(rocks);
        let choice = |k: usize| {
            let reach = recorder.scenery.blocks[k].reach;
            let [x, y, turn] = [0, 1, PHI].map(|c| moves(k, c));
            let [across, up] = [0, 1].map(|c| self.carried_travel(recorder, k, c));
            // Beside what rocks, a ball has its way in its portrait, as its turns would stretch the axis.
            let rolls = turn > PI && others_rock;
            if !rolls && holds(turn, 1.0) && turn * reach >= TURNS * across.max(up) {
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
            let points =
                |k: usize| recorder.kept.orbits[BLOCK_COORDINATES * k + c].points(PORTRAIT_POINTS / chosen.len());
            let orbits: Vec<(usize, Vec<Point>)> = blocks().filter_map(|k| Some((k, points(k)?))).collect();
            let untraced = blocks().filter(|k| orbits.iter().all(|(drawn, _)| drawn != k));
            self.untraced.extend(untraced.map(|k| recorder.scenery.blocks[k].name.clone()));
            if orbits.is_empty() {
                continue;
            }
            let (units, factors) = if c == PHI {
                ([display.angle.symbol(), "rad"], [display.angle.per_radian(), 1.0])
            } else {
                let most = |of: usize| largest(orbits.iter().flat_map(|(_, points)| points).map(|point| &point[of]));
                let [(x, a), (v, b)] = [(Measure::Position, 1), (Measure::Velocity, 2)]
                    .map(|(measure, of)| self.units.unit(measure, most(of)));
                ([x, v], [a, b])
            };
            let line = |(k, points): (usize, Vec<Point>)| {
                let strong = strong(&points);
                let values = |of: usize, factor: f64| points.iter().map(|point| point[of] * factor).collect();
                PortraitLine {
                    label: block_label(recorder, k),
                    number: k,
                    t: values(0, 1.0),
                    x: values(1, factors[0]),
                    v: values(2, factors[1]),
                    strong,
                    over: 0,
                    alone: Vec::new(),
                }
            };
            let coordinate = &COORDINATES[c];
            let reach = blocks().map(|k| recorder.scenery.blocks[k].reach).fold(0.0, f64::max);
            // Of several, only of those that come near: nobody could tell whose the others are.
            let alone = orbits.len() == 1;
            let near = |(k, points): &(usize, Vec<Point>)| {
                let tops = nears(recorder, *k, points.iter().map(|point| point[1]));
                if alone { recorder.points_of_no_return[*k] } else { tops }
            };
            let tops = orbits.iter().filter(|_| c == PHI).filter_map(near);
            let guides = guides(tops, factors[0]);
            let on = from_base(recorder, &self.curves, c);
            let strong = what_is_strong(orbits.iter().map(|(_, points)| (strong(points), points.len())));
            let mut lines: Vec<PortraitLine> = orbits.into_iter().map(line).collect();
            let coincide = match coincident::tell_apart(&mut lines) {
                0 => None,
                count => Some(format!("{count} curves coincide, wholly or in part")),
            };
            let notes: Vec<String> = strong.into_iter().chain(coincide).collect();
            let portrait = Portrait {
                id: ["phase_x", "phase_y", "phase"][c],
                title: format!("Phase portrait: {} over {}", coordinate.velocity_symbol, coordinate.symbol),
                x_label: format!("{}{on}", coordinate.name),
                y_label: format!("{}{on}", coordinate.velocity_name),
                x_unit: units[0].to_owned(),
                y_unit: format!("{}/s", units[1]),
                least: if c == PHI { [4e-5 * factors[0], 2e-3] } else { factors.map(|factor| 1e-4 * reach * factor) },
                guides,
                note: (!notes.is_empty()).then(|| notes.join("; ")),
                lines,
            };
            self.portraits.push(portrait);
        }
    }
}

/// So many points of a smooth motion, which are enough for its zoomed parts, too.
const SMOOTH: usize = 2000;

/// What is smooth lies between two of its points on their line, but for this part of its largest value.
const STRAIGHT: f64 = 5e-3;

/// Times for points of a smooth motion over a run, s.
fn smooth_times(curves: &Curves) -> Vec<f64> {
    let borders = curves.borders();
    let (start, end) = (borders[0], borders[borders.len() - 1]);
    (0..=SMOOTH).map(|k| start + (end - start) * k as f64 / SMOOTH as f64).collect()
}

/// A prescribed quantity at these times, beginning with the value of its `curve`, which may have an incline; `None` where these are too few for its course,
/// as of a record, or of a step: it isn't straight between them, or reaches farther in a step than at any of them.
fn smooth(t: &[f64], value: impl Fn(f64) -> f64, curve: &[f64]) -> Option<Vec<f64>> {
    let most = largest(curve);
    let from = curve.first()? - value(*t.first()?);
    let values: Vec<f64> = t.iter().map(|t| from + value(*t)).collect();
    let is_straight = |k: usize| {
        let middle = from + value(0.5 * (t[k] + t[k + 1]));
        (middle - 0.5 * (values[k] + values[k + 1])).abs() <= STRAIGHT * most
    };
    let ends = |values: &[f64]| values.iter().fold((0.0_f64, 0.0_f64), |(a, b), x| (a.min(*x), b.max(*x)));
    let ((low, high), (least, greatest)) = (ends(&values), ends(curve));
    let reaches = (low - least).abs().max((high - greatest).abs()) <= STRAIGHT * most;
    (reaches && (0..t.len() - 1).all(is_straight)).then_some(values)
}

/// What the middle of a beam is called where it is that of a span.
const MIDSPAN: &str = "midspan";

/// What the middle of a beam is called: it may be that of no span, or a support.
fn middle_word(beam: &BeamDrawn) -> &'static str {
    let (middle, rounding) = (0.5 * beam.span, 1e-9 * beam.span);
    // How far the nearest supports, or ends, are on either side.
    let nearest = |side: f64| {
        let far = beam.inner.iter().map(|(x, _)| side * (x - middle)).filter(|far| *far >= -rounding);
        far.fold(middle, f64::min)
    };
    match [-1.0, 1.0].map(nearest) {
        [left, right] if left.max(right) <= rounding => "support",
        [left, right] if (left - right).abs() <= rounding => MIDSPAN,
        _ => "middle",
    }
}

/// Which parts of the blocks' curves are strong, of those that have pale ones: of some it may be the beginning, of others not.
fn what_is_strong(parts: impl Iterator<Item = (Range<usize>, usize)>) -> Option<String> {
    let starts: Vec<usize> =
        parts.filter(|(strong, all)| strong.len() < *all).map(|(strong, _)| strong.start).collect();
    let which = match (starts.contains(&0), starts.iter().any(|start| *start > 0)) {
        (false, false) => return None,
        (true, false) => {
            return Some(format!("strong: the first {STRONG} changes of sign of the velocity; pale: all later ones"));
        }
        (false, true) => "about the largest swing",
        (true, true) => "about the largest swing of each block, or the first ones",
    };
    Some(format!("strong: the {STRONG} changes of sign of the velocity {which}; pale: all others"))
}

#[cfg(test)]
mod strong_parts {
    use super::what_is_strong;

    #[test]
    fn the_note_on_strong_parts_holds_for_all_blocks() {
        let note = |parts: &[(std::ops::Range<usize>, usize)]| what_is_strong(parts.iter().cloned());
        assert_eq!(note(&[(0..9, 9)]), None);
        let both = note(&[(0..9, 90), (40..50, 90)]).unwrap();
        assert!(both.contains("about the largest swing of each block, or the first ones"), "{both}");
        assert!(note(&[(0..9, 90), (0..9, 9)]).unwrap().contains("all later ones"));
        assert!(!note(&[(40..50, 90)]).unwrap().contains("first"));
    }
}

/// A curve that goes less far than this part of the farthest is a line at its start.
const UNSEEN: f64 = 5e-3;

/// Says of which bodies the curves are too small to be seen beside the others, with how far they go.
fn unseen(bodies: impl Iterator<Item = (String, f64)>, size: impl Fn(f64) -> String) -> Option<Note> {
    let bodies: Vec<(String, f64)> = bodies.collect();
    let most = bodies.iter().fold(0.0, |most: f64, (_, far)| most.max(*far));
    // What is 0, or rounding beside the others, is seen as it is.
    let small = bodies.iter().filter(|(_, far)| (ROUNDING * most..UNSEEN * most).contains(far) && *far > 0.0);
    let told: Vec<String> = small.map(|(name, far)| format!("{name} (up to {})", size(*far))).collect();
    (!told.is_empty()).then(|| Note::of_plot(format!("too small to be seen here: {}", told.join(", "))))
}

/// A portrait in which the velocity turns more often than this is a solid area: then as many turns as [`STRONG`] are drawn strong, the rest pale.
const MANY_TURNS: usize = 120;
const STRONG: usize = 20;

/// Which points of an orbit are drawn strong: of many turns those that cover most of its extent. Of a motion that decays these are the first; of one that
/// is shaken those about its largest swing, as the first ones would be hidden behind it; of one that overturns those that end in the fall.
fn strong(points: &[Point]) -> Range<usize> {
    let turns = points.windows(2).enumerate().filter(|(_, two)| two[0][2] * two[1][2] < 0.0).map(|(k, _)| k + 1);
    let turns: Vec<usize> = turns.collect();
    if turns.len() <= MANY_TURNS {
        return 0..points.len();
    }
    let window = |k: usize| {
        let begin = if k == 0 { 0 } else { turns[k] };
        begin..turns.get(k + STRONG).copied().unwrap_or(points.len())
    };
    let covers = |points: &[Point]| {
        [1, 2].map(|of| {
            let values = points.iter().map(|point| point[of]);
            let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
            high - low
        })
    };
    let all = covers(points).map(|range| if range > 0.0 { range } else { 1.0 });
    let part = |k: usize| covers(&points[window(k)]).into_iter().zip(all).map(|(own, all)| own / all).sum::<f64>();
    let parts: Vec<f64> = (0..=turns.len() - STRONG).map(part).collect();
    let most = parts.iter().copied().fold(0.0, f64::max);
    // The middle of those that are as good, unless the first is.
    let good = |k: &usize| parts[*k] >= AS_GOOD * most;
    let first = (0..parts.len()).find(good).unwrap_or(0);
    let count = (first..parts.len()).take_while(good).count();
    window(if first == 0 { 0 } else { first + count / 2 })
}

/// Parts of an orbit that cover this part of what another covers are as good.
const AS_GOOD: f64 = 0.99;

/// What is said of a coordinate that is plotted from ground or supports that move along it.
fn from_base(recorder: &PageRecorder, curves: &Curves, coordinate: usize) -> String {
    let goes = |base: &usize| largest(&curves.curve(recorder.scenery.driven_column(*base))) > 0.0;
    match recorder.scenery.bases.get(coordinate).copied().flatten().filter(goes) {
        Some(_) => format!(" relative to {}", recorder.scenery.base()),
        None => String::new(),
    }
}

/// Where no block goes farther than this part of the range in which all of them are, they are drawn from their starts.
const FAR: f64 = 0.5;

/// The range of all values.
fn extent(moving: &[(usize, Vec<f64>)]) -> f64 {
    let finite = || moving.iter().flat_map(|(_, values)| values).copied().filter(|x| x.is_finite());
    finite().fold(f64::NEG_INFINITY, f64::max) - finite().fold(f64::INFINITY, f64::min)
}

/// A block's name, if there are others.
fn block_label(recorder: &PageRecorder, k: usize) -> String {
    let blocks = &recorder.scenery.blocks;
    if blocks.len() > 1 { blocks[k].name.clone() } else { String::new() }
}

/// A block has come near the point of no return when it has turned by this part of the way there.
const NEAR: f64 = 0.8;

/// The points of no return, where the motion comes near them: elsewhere they would only squeeze the curve.
fn critical_angles(recorder: &PageRecorder, moving: &[(usize, Vec<f64>)], factor: f64) -> Vec<f64> {
    let near = |(k, values): &(usize, Vec<f64>)| nears(recorder, *k, values.iter().copied());
    guides(moving.iter().filter_map(near), factor)
}

/// The points of no return of a block, if one of these angles comes near them.
fn nears(recorder: &PageRecorder, block: usize, mut angles: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let [right, left] = recorder.points_of_no_return[block]?;
    let (middle, room) = (0.5 * (left + right), 0.5 * (left - right));
    angles.any(|phi| (phi - middle).abs() > NEAR * room).then_some([right, left])
}

/// Lines across a plot at these angles of blocks, rad, in ascending order. Of blocks that have different ones there are none: nobody could tell
/// whose each is.
fn guides(mut blocks: impl Iterator<Item = [f64; 2]>, factor: f64) -> Vec<f64> {
    let Some(first) = blocks.next() else { return Vec::new() };
    if blocks.any(|other| (0..2).any(|k| (other[k] - first[k]).abs() > SAME)) {
        return Vec::new();
    }
    let mut guides = first.map(|angle| factor * angle).to_vec();
    guides.sort_by(f64::total_cmp);
    guides
}

/// Angles that differ by less are the same, rad.
const SAME: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_is_smooth_and_steps_and_noise_are_not() {
        let t: Vec<f64> = (0..=SMOOTH).map(|k| k as f64 / SMOOTH as f64).collect();
        let curve = |f: &dyn Fn(f64) -> f64| (0..=40_000).map(|k| f(k as f64 / 4e4)).collect::<Vec<_>>();
        let sine = |t: f64| (2.0 * PI * 10.0 * t).sin();
        let found = smooth(&t, sine, &curve(&sine)).unwrap();
        assert!(found.iter().zip(&t).all(|(x, t)| *x == sine(*t)));
        // With an incline.
        assert_eq!(smooth(&t, sine, &curve(&|t| 3.0 + sine(t))).unwrap()[0], 3.0);
        let step = |t: f64| if t < 0.3 { 0.0 } else { 1.0 };
        assert_eq!(smooth(&t, step, &curve(&step)), None);
        let fast = |t: f64| (2.0 * PI * 999.0 * t).sin();
        assert_eq!(smooth(&t, fast, &curve(&fast)), None);
        // Shorter than the time between two points.
        let blip = |t: f64| if (t - 0.50013).abs() < 1e-4 { 1.0 } else { 0.0 };
        assert_eq!(smooth(&t, blip, &curve(&blip)), None);
    }

    #[test]
    fn of_hundreds_of_bounces_the_first_are_strong_and_of_a_few_all() {
        let bounces = |count: usize| -> Vec<Point> {
            (0..4 * count).map(|k| [k as f64, 1.0, [1.0, 0.3, -0.3, -1.0][k % 4]]).collect()
        };
        // Each bounce turns twice: at its top, and at the ground.
        assert_eq!(strong(&bounces(291)), 0..42);
        assert_eq!(strong(&bounces(12)), 0..48);
        assert_eq!(strong(&[]), 0..0);
    }

    #[test]
    fn of_what_trembles_and_then_falls_the_fall_is_strong() {
        let points: Vec<Point> = (0..700)
            .map(|k| match k {
                0..600 => [f64::from(k), 1e-3, [0.1, 0.03, -0.03, -0.1][k as usize % 4]],
                k => [f64::from(k), -0.01 * f64::from(k - 600).powi(2), -0.02 * f64::from(k - 600)],
            })
            .collect();
        let strong = strong(&points);
        assert!(strong.contains(&600) && strong.end == 700 && strong.len() < 200, "{strong:?}");
    }

    #[test]
    fn critical_angles_are_drawn_where_all_blocks_have_the_same() {
        let of = |blocks: &[[f64; 2]]| guides(blocks.iter().copied(), 10.0);
        assert_eq!(of(&[[0.3, -0.3], [0.3, -0.3 - 1e-9]]), [-3.0, 3.0]);
        assert!(of(&[[0.3, -0.3], [0.4, -0.4]]).is_empty(), "whose?");
        assert!(of(&[]).is_empty());
    }

    #[test]
    fn of_many_swings_those_about_the_largest_are_strong() {
        let swing = |k: usize| (1.0 - (k as f64 / 500.0 - 0.6).abs()) * (0.5 * std::f64::consts::PI * k as f64).cos();
        let points: Vec<Point> = (0..1000).map(|k| [k as f64, swing(k), swing(k + 1)]).collect();
        let strong = strong(&points);
        assert!(strong.contains(&300) && strong.len() < 100, "{strong:?}");
        let turns = points[strong].windows(2).filter(|two| two[0][2] * two[1][2] < 0.0).count();
        assert!(turns <= STRONG, "{turns}");
    }

    #[test]
    fn what_is_nothing_is_not_told_as_too_small_to_be_seen() {
        let told = |far: [f64; 3]| {
            unseen(far.into_iter().zip(["a", "b", "c"]).map(|(far, name)| (name.to_owned(), far)), |x| x.to_string())
        };
        assert_eq!(told([1.0, 0.0, 1e-17]), None);
        assert_eq!(told([1.0, 0.0, 1e-3]).unwrap().text, "too small to be seen here: c (up to 0.001)");
        assert_eq!(told([0.0; 3]), None);
    }
}
