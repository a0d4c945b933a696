//! How a block stands: between which turns its weight brings it back, and where it lies beyond (`docs/verdict.md`).
//!
//! Held by a corner that doesn't slide, a block is lifted as it turns until its mass centre is over that corner, against gravity; past this it falls
//! to the next side. The height of the mass centre over whatever carries it is h(φ) = max over corners of the way down to the corner; its maxima are the
//! points of no return, between two of them there is one minimum: a side on which it lies.

use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::{Arc, Mutex, PoisonError};
use teeter_beam::Beam;
use teeter_scenario::scene::BlockScene;
use teeter_scenario::swing::Swing;

/// The sides to which a block can go: the right (φ falls) and the left (φ rises).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Way {
    /// To the left: counter-clockwise.
    Left,
    /// To the right: clockwise.
    Right,
}

impl Way {
    /// The side to which a tilt by this angle leans, rad.
    pub(crate) fn of(tilt: f64) -> Self {
        if tilt > 0.0 { Self::Left } else { Self::Right }
    }

    /// +1 for a turn to the left, −1 for one to the right.
    pub(crate) fn sign(self) -> f64 {
        if self == Self::Left { 1.0 } else { -1.0 }
    }

    /// The word for it.
    #[must_use]
    pub fn word(self) -> &'static str {
        if self == Self::Left { "left" } else { "right" }
    }
}

/// One way out of a stance. Angles are absolute, in rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Edge {
    /// Where the mass centre is over the corner: the point of no return.
    pub(crate) top: f64,
    /// Where it lies flat on the next side, on level ground, once that was asked for: see [`Outline::lies`].
    pub(crate) lies: Option<f64>,
    /// Distance from the mass centre to the corner, m.
    pub(crate) arm: f64,
}

/// How a block stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stance {
    /// Where it stands flat on level ground, rad.
    pub(crate) flat: f64,
    pub(crate) left: Edge,
    pub(crate) right: Edge,
}

/// A corner at a distance from the mass centre, m, in a direction, rad, with a rounding, m.
#[derive(Clone, Copy, Debug)]
struct Corner {
    arm: f64,
    direction: f64,
    rounding: f64,
}

impl Corner {
    /// How far down it reaches from the mass centre where this direction of the block points down, m.
    fn down(&self, direction: f64) -> f64 {
        self.arm * (direction - self.direction).cos() + self.rounding
    }
}

/// How far down the lowest of some corners reaches.
fn down(corners: &[Corner], direction: f64) -> f64 {
    corners.iter().map(|corner| corner.down(direction)).fold(f64::NEG_INFINITY, f64::max)
}

/// A corner that is no higher than this part of the block's size counts as a summit.
const ROUNDING: f64 = 1e-9;

/// Corners that differ in height by less than this part of the block's size are of one side, as it lies: the angle at which it does is only found so well.
const LEVEL: f64 = 1e-6;

/// What decides how a block stands.
#[derive(Clone, Debug)]
pub(crate) struct Outline {
    corners: Vec<Corner>,
    /// Largest distance of a point of it from the mass centre, m.
    size: f64,
    /// Direction of gravity, rad.
    pub(super) gamma: f64,
    shared: Option<Arc<SharedStances>>,
}

/// How the blocks of one run after another stand, found once for the same block at the same angle, and how their beams swing: for
/// [`Recorder::sharing`](crate::Recorder::sharing). It holds few of them, and may serve several threads.
#[derive(Debug, Default)]
pub struct SharedStances {
    stances: Mutex<KnownStances>,
    swings: Mutex<Vec<KnownSwing>>,
}

/// A beam with the shape from which it starts, and how it swings.
type KnownSwing = (Arc<Beam>, Vec<f64>, Option<Swing>);

#[derive(Debug, Default)]
struct KnownStances {
    /// By the bits of all numbers that decide them.
    entries: Vec<(Vec<u64>, Option<Stance>)>,
    searched: u64,
}

/// Most stances that are held: those of a scene of some blocks.
const MOST_STANCES: usize = 64;

/// Most swings that are held, with their beams: those of a scene of some beams.
const MOST_SWINGS: usize = 16;

impl SharedStances {
    /// How many stances were searched for.
    #[must_use]
    pub fn searched(&self) -> u64 {
        self.stances.lock().unwrap_or_else(PoisonError::into_inner).searched
    }

    fn find_or(&self, key: Vec<u64>, search: impl FnOnce() -> Option<Stance>) -> Option<Stance> {
        let lock = || self.stances.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, stance)) = lock().entries.iter().find(|(known, _)| *known == key) {
            return *stance;
        }
        let stance = search();
        let mut known = lock();
        known.searched += 1;
        if known.entries.len() == MOST_STANCES {
            known.entries.clear();
        }
        known.entries.push((key, stance));
        stance
    }

    /// How a beam swings that starts from this shape.
    pub(crate) fn swing(&self, beam: &Arc<Beam>, shape: &[f64], find: impl FnOnce() -> Option<Swing>) -> Option<Swing> {
        let lock = || self.swings.lock().unwrap_or_else(PoisonError::into_inner);
        let is_same = |(known, start, _): &&KnownSwing| Arc::ptr_eq(known, beam) && start == shape;
        if let Some((.., swing)) = lock().iter().find(is_same) {
            return *swing;
        }
        let swing = find();
        let mut known = lock();
        if known.len() == MOST_SWINGS {
            known.clear();
        }
        known.push((Arc::clone(beam), shape.to_vec(), swing));
        swing
    }
}

impl Outline {
    /// `None` for a block without a base, as a disc: what rolls does not overturn. Without gravity nothing does.
    pub(crate) fn of(block: &BlockScene, gravity: [f64; 2]) -> Option<Self> {
        if !(block.base() > 0.0) || gravity == [0.0; 2] {
            return None;
        }
        let corners = block.corners().into_iter().enumerate().map(|(number, at)| Corner {
            arm: at.norm(),
            direction: at.y.atan2(at.x),
            rounding: block.corner_radius(number),
        });
        let corners = corners.collect();
        Some(Self { corners, size: block.radius(), gamma: gravity[1].atan2(gravity[0]), shared: None })
    }

    /// From now on stances are taken from there, and entered.
    pub(super) fn share(&mut self, stances: &Arc<SharedStances>) {
        self.shared = Some(Arc::clone(stances));
    }

    /// The slope of what is level for gravity, rad.
    pub(super) fn level(&self) -> f64 {
        self.gamma + FRAC_PI_2
    }

    /// How far down the block reaches from its mass centre where this direction of it points down, m.
    fn down(&self, direction: f64) -> f64 {
        down(&self.corners, direction)
    }

    /// The corners at the ends of the side that is lowest where this direction (rad) of the block points down, left and right as seen then; `None`
    /// where a single one is.
    pub(super) fn lowest_at(&self, direction: f64) -> Option<[usize; 2]> {
        let least = self.down(direction) - LEVEL * self.size;
        let lowest = || {
            let of = |(number, corner): (usize, &Corner)| {
                let turn = direction - corner.direction;
                let is_low = corner.arm * turn.cos() + corner.rounding >= least;
                // With `direction` downwards, what is ahead of it counter-clockwise is to the right.
                is_low.then(|| (number, -corner.arm * turn.sin()))
            };
            self.corners.iter().enumerate().filter_map(of)
        };
        let (left, from) = lowest().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let (right, to) = lowest().max_by(|a, b| a.1.total_cmp(&b.1))?;
        (to - from > LEVEL * self.size).then_some([left, right])
    }

    /// How it stands at `angle` (rad).
    pub(crate) fn stance(&self, angle: f64) -> Option<Stance> {
        let Some(shared) = &self.shared else { return self.search(angle) };
        let of_corners = self.corners.iter().flat_map(|corner| [corner.arm, corner.direction, corner.rounding]);
        let key = of_corners.chain([self.size, self.gamma, angle]).map(f64::to_bits).collect();
        shared.find_or(key, || self.search(angle))
    }

    fn search(&self, angle: f64) -> Option<Stance> {
        let tops = self.tops();
        let (left, right) = (next(&tops, angle, Way::Left)?, next(&tops, angle, Way::Right)?);
        // A single top: it rolls about as a drum with an eccentric mass.
        let stands = left.top - right.top < TAU - ROUNDING;
        stands.then(|| Stance { flat: self.lowest(right.top, left.top), left, right })
    }

    /// Where a block that went past this edge lies flat on the next side, on level ground, rad: apart from the stance, as most
    /// blocks never get there.
    pub(crate) fn lies(&self, edge: Edge, way: Way) -> Option<f64> {
        let beyond = next(&self.tops(), edge.top, way)?;
        Some(self.lowest(edge.top, beyond.top))
    }

    /// The points of no return, each at one of the angles, a whole turn apart, where it is.
    fn tops(&self) -> Vec<Edge> {
        let least = ROUNDING * self.size;
        self.corners
            .iter()
            .filter(|corner| corner.arm > least)
            .filter(|corner| corner.arm + corner.rounding >= self.down(corner.direction) - least)
            // Turned by γ − direction the block has this direction pointing down.
            .map(|corner| Edge { top: self.gamma - corner.direction, lies: None, arm: corner.arm })
            .collect()
    }

    /// Where the mass centre is lowest between two tops that are neighbours, rad.
    fn lowest(&self, from: f64, to: f64) -> f64 {
        let near = self.reaching_down(self.gamma - from.max(to), self.gamma - from.min(to));
        lowest(|angle| down(&near, self.gamma - angle), from, to)
    }

    /// The corners that are lowest somewhere between two directions (rad, in ascending order), among a few others: the search for a side looks at
    /// them some hundred times.
    fn reaching_down(&self, from: f64, to: f64) -> Vec<Corner> {
        // Between the directions lies one that differs from `direction` by whole turns.
        let contains = |direction: f64| (direction - from).rem_euclid(TAU) <= to - from;
        let bounds = |corner: &Corner| {
            let [a, b] = [from, to].map(|direction| corner.down(direction));
            let most = if contains(corner.direction) { corner.arm + corner.rounding } else { a.max(b) };
            let least = if contains(corner.direction + PI) { corner.rounding - corner.arm } else { a.min(b) };
            (least, most)
        };
        let all: Vec<(f64, f64)> = self.corners.iter().map(bounds).collect();
        let reached = all.iter().map(|(least, _)| *least).fold(f64::NEG_INFINITY, f64::max) - ROUNDING * self.size;
        self.corners.iter().zip(all).filter(|(_, (_, most))| *most >= reached).map(|(corner, _)| *corner).collect()
    }
}

/// The next top on a way from an angle (rad).
fn next(tops: &[Edge], from: f64, way: Way) -> Option<Edge> {
    let sign = way.sign();
    // The least turn, beyond rounding, that leads from there to a top.
    let turn = |top: f64| (sign * (top - from) - ROUNDING).rem_euclid(TAU) + ROUNDING;
    let edge = tops.iter().min_by(|a, b| turn(a.top).total_cmp(&turn(b.top)))?;
    Some(Edge { top: from + sign * turn(edge.top), ..*edge })
}

impl Stance {
    pub(crate) fn edge(&self, way: Way) -> Edge {
        match way {
            Way::Left => self.left,
            Way::Right => self.right,
        }
    }

    pub(crate) fn edge_mut(&mut self, way: Way) -> &mut Edge {
        match way {
            Way::Left => &mut self.left,
            Way::Right => &mut self.right,
        }
    }

    /// The points of no return, to the right and to the left, rad.
    pub(crate) fn tops(&self) -> [f64; 2] {
        [self.right.top, self.left.top]
    }

    /// |φ|/α at an angle (rad) on ground with a slope (rad) against the level of gravity: the way from standing flat there to the point of
    /// no return, in parts; `None` where the slope alone is past it.
    pub(crate) fn part(&self, angle: f64, slope: f64) -> Option<f64> {
        let turned = angle - self.flat - slope;
        let edge = if turned > 0.0 { self.left } else { self.right };
        let room = (edge.top - self.flat - slope) * if turned > 0.0 { 1.0 } else { -1.0 };
        (room > ROUNDING).then(|| turned.abs() / room)
    }
}

/// Where a function that falls and then rises is least: by thirds.
fn lowest(height: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let (mut from, mut to) = (from.min(to), from.max(to));
    for _ in 0..80 {
        let third = (to - from) / 3.0;
        let (a, b) = (from + third, to - third);
        if height(a) < height(b) { to = b } else { from = a }
    }
    0.5 * (from + to)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stance(block: &str, gravity: [f64; 2]) -> Option<Stance> {
        let scene = format!(
            "[time]\nend = '1 s'\nstep = '1 ms'\n[ground]\n[material.a]\ndensity = '1000 kg/m^3'\n[block.r]\nmaterial = 'a'\ndepth = '1 m'\n\
             position = ['0 m', '9 m']\n{block}\n"
        );
        let scene = teeter_scenario::load(scene.as_bytes(), "f", "f", &[]).unwrap().scene;
        let teeter_scenario::scene::Placement::Free { angle, .. } = scene.blocks[0].placement else { panic!("placed") };
        let outline = Outline::of(&scene.blocks[0], gravity)?;
        let mut stance = outline.stance(angle)?;
        stance.left.lies = outline.lies(stance.left, Way::Left);
        stance.right.lies = outline.lies(stance.right, Way::Right);
        Some(stance)
    }

    const DOWN: [f64; 2] = [0.0, -9.81];

    #[test]
    fn corners_that_are_left_out_of_a_search_are_nowhere_lowest() {
        // Of a rectangle the two above, of a polygon of many sides most.
        let corner = |x: f64, y: f64, rounding| Corner { arm: x.hypot(y), direction: y.atan2(x), rounding };
        let rectangle = [(-1.0, -3.0), (1.0, -3.0), (1.0, 3.0), (-1.0, 3.0)].map(|(x, y)| corner(x, y, 0.0));
        let many = (0..12)
            .map(|k| corner((f64::from(k) * 0.5).cos(), 1.3 * (f64::from(k) * 0.5).sin(), 0.01 * f64::from(k % 3)));
        for (corners, most) in [(rectangle.to_vec(), 2), (many.collect(), 5)] {
            let outline = Outline { corners, size: 3.2, gamma: -FRAC_PI_2, shared: None };
            for turn in 0..40 {
                let from = 0.3 * f64::from(turn) - 6.0;
                let near = outline.reaching_down(from, from + 0.4);
                for part in 0..=200 {
                    let at = from + 0.002 * f64::from(part);
                    assert_eq!(down(&near, at), outline.down(at), "{from} {at}");
                }
            }
            let near = outline.reaching_down(-FRAC_PI_2 - 0.2, -FRAC_PI_2 + 0.2);
            assert!(near.len() <= most, "{near:?}");
        }
    }

    #[test]
    fn a_rectangle_stands_between_plus_and_minus_alpha_and_then_lies_on_its_side() {
        let of = stance("width = '1 m'\nheight = '3 m'", DOWN).unwrap();
        let alpha = (1.0_f64 / 3.0).atan();
        for (found, wanted) in [
            (of.left.top, alpha),
            (of.right.top, -alpha),
            (of.flat, 0.0),
            (of.left.lies.unwrap(), 0.25 * TAU),
            (of.right.lies.unwrap(), -0.25 * TAU),
            (of.left.arm, 0.5 * 10_f64.sqrt()),
            (of.part(0.5 * alpha, 0.0).unwrap(), 0.5),
            // On a slope, standing flat leaves less room downhill, to the left of one that rises to the right.
            (of.part(0.1 + 0.5 * (alpha - 0.1), 0.1).unwrap(), 0.5),
            (of.part(0.1 - 0.5 * (alpha + 0.1), 0.1).unwrap(), 0.5),
        ] {
            assert!((found - wanted).abs() < 1e-7, "{found} {wanted}");
        }
        assert_eq!(of.part(0.41, 0.4), None, "it can't stand on so steep a slope");
    }

    #[test]
    fn what_starts_on_its_side_stands_there() {
        let of = stance("width = '1 m'\nheight = '3 m'\nangle = '80 deg'", DOWN).unwrap();
        let beta = 3_f64.atan();
        assert!((of.flat - 0.25 * TAU).abs() < 1e-7, "{of:?}");
        assert!((of.left.top - 0.25 * TAU - beta).abs() < 1e-7 && (of.right.top - 0.25 * TAU + beta).abs() < 1e-7);
    }

    #[test]
    fn gravity_that_leans_moves_the_points_of_no_return() {
        let of = stance("width = '1 m'\nheight = '3 m'", [9.81 * 0.1_f64.sin(), -9.81 * 0.1_f64.cos()]).unwrap();
        let alpha = (1.0_f64 / 3.0).atan();
        // It pulls to the right, so the block leans 0.1 rad to the left before it is upright.
        assert!((of.left.top - alpha - 0.1).abs() < 1e-7 && (of.right.top + alpha - 0.1).abs() < 1e-7, "{of:?}");
    }

    #[test]
    fn a_hexagon_goes_to_its_neighbouring_sides() {
        let of = stance("shape = { kind = 'regular', sides = 6, radius = '1 m' }", DOWN).unwrap();
        assert!((of.left.top - of.right.top - TAU / 6.0).abs() < 1e-7, "{of:?}");
        assert!((of.left.lies.unwrap() - of.flat - TAU / 6.0).abs() < 1e-7, "{of:?}");
    }

    #[test]
    fn what_rolls_or_weighs_nothing_does_not_overturn() {
        assert_eq!(stance("radius = '1 m'", DOWN), None);
        assert_eq!(stance("width = '1 m'\nheight = '3 m'", [0.0; 2]), None);
    }
}
