//! Plots of how blocks move.

use super::{Curves, Line, Measure, Panels, Place, Source, TimePanel};
use crate::page::content::{ROUNDING, holds, largest, power_of_ten, travel};
use crate::page::notes::Note;
use crate::page::recorder::{BLOCK_COLUMNS, BLOCK_COORDINATES, PageRecorder, coordinate_in};
use crate::{shortest, with_digits};
use std::f64::consts::PI;

/// A coordinate of a block.
pub(super) struct Coordinate {
    id: &'static str,
    of: &'static str,
    velocity_id: &'static str,
    pub(super) symbol: &'static str,
    pub(super) velocity_symbol: &'static str,
    pub(super) name: &'static str,
    /// As measured from the start.
    pub(super) from_start: &'static str,
    pub(super) symbol_from_start: &'static str,
    pub(super) velocity_name: &'static str,
}

/// In the order of the state.
pub(super) const COORDINATES: [Coordinate; 3] = [
    Coordinate {
        id: "x",
        of: "change of x of",
        velocity_id: "vx",
        symbol: "x",
        velocity_symbol: "ẋ",
        name: "Position x",
        from_start: "Displacement x − x₀",
        symbol_from_start: "x − x₀",
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
        symbol_from_start: "y − y₀",
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
        symbol_from_start: "φ − φ₀",
        velocity_name: "Angular velocity ω",
    },
];
pub(super) const PHI: usize = 2;

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
        // Blocks that stand far apart would all look still, but for a few.
        let from_start = is_from_start(c, &moving);
        let zero = |k: usize| if from_start { zero(recorder, k, c) } else { 0.0 };
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

/// What is said of a coordinate that is plotted from ground or supports that move along it.
pub(super) fn from_base(recorder: &PageRecorder, curves: &Curves, coordinate: usize) -> String {
    let goes = |base: &usize| largest(&curves.curve(recorder.scenery.driven_column(*base))) > 0.0;
    match recorder.scenery.bases.get(coordinate).copied().flatten().filter(goes) {
        Some(_) => format!(" relative to {}", recorder.scenery.base()),
        None => String::new(),
    }
}

/// Where most blocks don't go farther than this part of the range in which all of them are, they are drawn from their starts.
const FAR: f64 = 0.5;

/// Whether a coordinate of these blocks is drawn from where each of them started.
pub(super) fn is_from_start(c: usize, moving: &[(usize, Vec<f64>)]) -> bool {
    c != PHI && moving.len() > 1 && usual_travel(moving) < FAR * extent(moving)
}

/// Where a block starts in a coordinate.
pub(super) fn zero(recorder: &PageRecorder, k: usize, c: usize) -> f64 {
    recorder.kept.frames.rows().next().map_or(0.0, |(_, start)| coordinate_in(recorder, start, k, c))
}

/// What half of the blocks don't go farther than: of two, the way of the one that goes less far.
fn usual_travel(moving: &[(usize, Vec<f64>)]) -> f64 {
    let mut ways: Vec<f64> = moving.iter().map(|(_, values)| travel(values)).collect();
    ways.sort_by(f64::total_cmp);
    ways.get((ways.len().max(1) - 1) / 2).copied().unwrap_or(0.0)
}

/// The range of all values.
fn extent(moving: &[(usize, Vec<f64>)]) -> f64 {
    let finite = || moving.iter().flat_map(|(_, values)| values).copied().filter(|x| x.is_finite());
    finite().fold(f64::NEG_INFINITY, f64::max) - finite().fold(f64::INFINITY, f64::min)
}

/// A block's name, if there are others.
pub(super) fn block_label(recorder: &PageRecorder, k: usize) -> String {
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
pub(super) fn nears(recorder: &PageRecorder, block: usize, mut angles: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let [right, left] = recorder.points_of_no_return[block]?;
    let (middle, room) = (0.5 * (left + right), 0.5 * (left - right));
    angles.any(|phi| (phi - middle).abs() > NEAR * room).then_some([right, left])
}

/// Lines across a plot at these angles of blocks, rad, in ascending order. Of blocks that have different ones there are none: nobody could tell
/// whose each is.
pub(super) fn guides(mut blocks: impl Iterator<Item = [f64; 2]>, factor: f64) -> Vec<f64> {
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
    fn critical_angles_are_drawn_where_all_blocks_have_the_same() {
        let of = |blocks: &[[f64; 2]]| guides(blocks.iter().copied(), 10.0);
        assert_eq!(of(&[[0.3, -0.3], [0.3, -0.3 - 1e-9]]), [-3.0, 3.0]);
        assert!(of(&[[0.3, -0.3], [0.4, -0.4]]).is_empty(), "whose?");
        assert!(of(&[]).is_empty());
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
