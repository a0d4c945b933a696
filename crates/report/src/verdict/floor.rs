//! The lowest that anything is which could hold a block, as it moves.

use super::carrier::{beam_origin, over_ground};
use std::ops::Range;
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Layout;

/// Between its ends a beam bends down by less than this part of its span: what is below that has left it.
const BENT: f64 = 0.5;

/// What can hold blocks: ground, beams, and blocks whose height is prescribed.
#[derive(Debug)]
pub(super) struct Floor {
    ground: Option<Ground>,
    /// Where the left ends of beams are while their supports don't move, m.
    beams: Vec<[f64; 2]>,
    /// The indices of the coordinates of blocks whose height is prescribed, and how far their points are from their mass centres, m.
    blocks: Vec<(Range<usize>, f64)>,
}

/// Ground: its lowest point from its origin, m, and its slope while it doesn't move, rad.
#[derive(Clone, Copy, Debug)]
struct Ground {
    lowest: f64,
    slope: f64,
}

/// A [`Floor`] at a time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Depth {
    ground: Option<Ground>,
    /// As low as beams may bend, and the lowest point of blocks, m; none without.
    lowest: Option<f64>,
}

impl Floor {
    pub(super) fn of(scene: &Scene, layout: &Layout) -> Self {
        let ground = scene.ground.as_ref().map(|ground| {
            let points = ground.profile.as_ref().map(|profile| profile.points().map(|point| point.y));
            Ground { lowest: points.map_or(0.0, |y| y.fold(f64::INFINITY, f64::min)), slope: ground.incline }
        });
        let held = scene.blocks.iter().zip(&layout.blocks).filter(|(block, _)| block.motion.0[1].is_some());
        Self {
            ground,
            beams: scene.beams.iter().map(|beam| beam.position).collect(),
            blocks: held.map(|(block, place)| (place.range.clone(), block.radius())).collect(),
        }
    }

    /// How low it is at these coordinates of the model.
    pub(super) fn depth(&self, layout: &Layout, q: &[f64]) -> Depth {
        let beams = self.beams.iter().zip(&layout.beams).enumerate().map(|(number, (position, place))| {
            let span = place.beam.spec().span;
            let end = |x: f64| place.deflection(&place.beam.shape_clamped(x), &q[place.range.clone()]).w;
            // Of one that is held at one end only, or not at all, the ends may be anywhere.
            beam_origin(number, *position, layout, q)[1] + end(0.0).min(end(span)) - BENT * span
        });
        let blocks = self.blocks.iter().map(|(range, reach)| q[range.start + 1] - reach);
        Depth { ground: self.ground, lowest: beams.chain(blocks).reduce(f64::min) }
    }
}

impl Depth {
    /// Whether a block with its mass centre at a point, whose points are up to `reach` (m) from there, is below all of it.
    pub(super) fn is_above(&self, at: [f64; 2], reach: f64, layout: &Layout, q: &[f64]) -> bool {
        let below_ground = self.ground.is_none_or(|of| over_ground(at, of.slope, layout, q) < of.lowest);
        let below_others = self.lowest.is_none_or(|lowest| at[1] + reach < lowest);
        // Without any of these there is nothing to be below of.
        (self.ground.is_some() || self.lowest.is_some()) && below_ground && below_others
    }
}
