//! Ground with a profile, under a block: its slope there, and how far along it a place is.

use std::ops::Range;
use std::sync::Arc;
use teeter_detect::Profile;
use teeter_scenario::ground_profile::{along, pieces_under};
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Layout;

/// A mass centre is over a crest if it is no farther beside it than this part of its distance from the base: rounding.
const ON_A_CREST: f64 = 1e-9;

/// Ground with a profile, and the corners of a block that stands on it.
#[derive(Debug)]
pub(super) struct Terrain {
    profile: Arc<Profile>,
    /// The indices of the coordinates of the ground, if it moves.
    ground: Option<Range<usize>>,
    /// The indices of the coordinates of the block.
    block: Range<usize>,
    /// In its frame, m.
    corners: Vec<[f64; 2]>,
    /// The slope of what is level for gravity, rad.
    level: f64,
}

impl Terrain {
    /// `None` where the ground is straight.
    pub(super) fn of(scene: &Scene, layout: &Layout, number: usize) -> Option<Self> {
        let profile = Arc::clone(scene.ground.as_ref()?.profile.as_ref()?);
        let corners = scene.blocks[number].corners().iter().map(|corner| [corner.x, corner.y]).collect();
        let [x, y] = scene.gravity;
        let level = if scene.gravity == [0.0; 2] { 0.0 } else { x.atan2(-y) };
        Some(Self {
            profile,
            ground: layout.ground.clone(),
            block: layout.blocks[number].range.clone(),
            corners,
            level,
        })
    }

    /// A point as the ground has it, and the turn of that, rad.
    fn local(&self, [x, y]: [f64; 2], q: &[f64]) -> ([f64; 2], f64) {
        let Some(range) = &self.ground else { return ([x, y], 0.0) };
        let [left, below, turn] = [0, 1, 2].map(|k| q[range.start + k]);
        let ((sin, cos), [x, y]) = (turn.sin_cos(), [x - left, y - below]);
        ([cos * x + sin * y, cos * y - sin * x], turn)
    }

    /// How far along the surface the ground under a point is, m.
    pub(super) fn along(&self, at: [f64; 2], q: &[f64]) -> f64 {
        along(&self.profile, self.local(at, q).0[0])
    }

    /// The slope with which the lowest side of the block would lie where it is, rad: over a crest on the side of it on which the mass centre is, to
    /// which it falls back, but on none on which it couldn't stand if it can on another. `None` of a block without sides, and where that side is upright.
    pub(super) fn slope(&self, q: &[f64]) -> Option<f64> {
        let own = &q[self.block.clone()];
        let (sin, cos) = own[2].sin_cos();
        let mut turn = 0.0;
        // The ends of that side are the two corners that are nearest to the ground.
        let mut lowest = [([0.0; 2], f64::INFINITY); 2];
        for [x, y] in &self.corners {
            let (at, turned) = self.local([own[0] + cos * x - sin * y, own[1] + sin * x + cos * y], q);
            let height = at[1] - self.profile.height(at[0]);
            if height < lowest[0].1 {
                lowest = [(at, height), lowest[0]];
            } else if height < lowest[1].1 {
                lowest[1] = (at, height);
            }
            turn = turned;
        }
        let [(mut left, _), (mut right, height)] = lowest;
        if !height.is_finite() {
            return None;
        }
        if left[0] > right[0] {
            (left, right) = (right, left);
        }
        let [width, rise] = [right[0] - left[0], right[1] - left[1]];
        let ([x, y], _) = self.local([own[0], own[1]], q);
        let (base, slope, level) = (width.hypot(rise), rise.atan2(width), self.level - turn);
        let [x, y] = [x - left[0], y - left[1]];
        let [along, height] = [(x * width + y * rise) / base, (y * width - x * rise) / base];
        // Where along that side, from its left end, the mass centre is over it if it has a slope.
        let over = |slope: f64| along - height * (slope - level).tan();
        let stands = |slope: f64| (0.0..=base).contains(&over(slope));
        let mut pieces = pieces_under(&self.profile, [left[0], right[0]]);
        if pieces.iter().any(|(_, slope)| stands(*slope)) {
            pieces.retain(|(_, slope)| stands(*slope));
        }
        let at = left[0] + over(slope) * slope.cos();
        let beside = |[from, to]: [f64; 2]| (from - at).max(at - to).max(0.0);
        let nearest = pieces.iter().map(|(ends, _)| beside(*ends)).reduce(f64::min)?;
        let there = pieces.iter().filter(|(ends, _)| beside(*ends) <= nearest + ON_A_CREST * height.abs());
        // Balanced on a crest it has any slope between the two.
        let [least, most] = there.map(|(_, slope)| [*slope; 2]).reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])?;
        // Not `clamp`: what is no number any more isn't to end the program.
        Some(turn + slope.max(least).min(most))
    }
}
