//! Ground with a profile, under a block: its slope there, and how far along it a place is.

use std::ops::Range;
use std::sync::Arc;
use teeter_detect::Profile;
use teeter_scenario::ground_profile::{along, slopes_of_base};
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Layout;

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
}

impl Terrain {
    /// `None` where the ground is straight.
    pub(super) fn of(scene: &Scene, layout: &Layout, number: usize) -> Option<Self> {
        let profile = Arc::clone(scene.ground.as_ref()?.profile.as_ref()?);
        let corners = scene.blocks[number].corners().iter().map(|corner| [corner.x, corner.y]).collect();
        Some(Self { profile, ground: layout.ground.clone(), block: layout.blocks[number].range.clone(), corners })
    }

    /// A point as the ground has it, and the turn of that, rad.
    fn local(&self, [x, y]: [f64; 2], q: &[f64]) -> ([f64; 2], f64) {
        let Some(range) = &self.ground else { return ([x, y], 0.0) };
        let [left, below, turn] = [0, 1, 2].map(|k| q[range.start + k]);
        let ((sin, cos), [x, y]) = (turn.sin_cos(), [x - left, y - below]);
        ([cos * x + sin * y, cos * y - sin * x], turn)
    }

    /// How far along the surface a point is, m.
    pub(super) fn along(&self, at: [f64; 2], q: &[f64]) -> f64 {
        along(&self.profile, self.local(at, q).0)
    }

    /// The slope with which the lowest side of the block would lie where it is, rad: over a crest the one nearest to its own.
    /// `None` of a block without sides, and where that side is upright.
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
        let [least, most] = slopes_of_base(&self.profile, [left[0], right[0]])?;
        // Not `clamp`: what is no number any more isn't to end the program.
        Some(turn + rise.atan2(width).max(least).min(most))
    }
}
