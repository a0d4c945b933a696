//! The surface that carries a block, and the block's angle relative to it.

use crate::ground_profile;
use crate::scene::{Placement, Scene, SupportingBody};
use crate::simulation::{BlockPlace, Layout};
use teeter_integrator::RockingMonitor;

/// The reference for the tilt of a block: what it is placed on, otherwise the ground or beam of its
/// first contact with one.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub enum TiltReference {
    /// A beam, whose undeformed axis is level, or nothing.
    #[default]
    Level,
    /// Fixed ground with this slope, rad.
    Incline(f64),
    /// Moving ground, or a block: the index of its slope in the state.
    Moving(usize),
    /// Moving ground with a profile: the index of its slope in the state, and the slope of the
    /// profile under the block relative to it, rad.
    MovingIncline(usize, f64),
}

/// The tilt references of the blocks at the given places; `slope` is the index of the slope of
/// moving ground.
pub(crate) fn tilt_references(scene: &Scene, blocks: &[BlockPlace], slope: Option<usize>) -> Vec<TiltReference> {
    let on_ground = match (slope, &scene.ground) {
        (Some(slope), _) => TiltReference::Moving(slope),
        (None, Some(ground)) if ground.incline != 0.0 => TiltReference::Incline(ground.incline),
        _ => TiltReference::Level,
    };
    let support = |(number, placement): (usize, &Placement)| match placement {
        Placement::On { support, .. } => Some(*support),
        Placement::Free { .. } => scene.first_touched(number),
    };
    let on_profile = |block: usize| {
        let under = ground_profile::slope_under(scene.ground.as_ref()?, &scene.blocks[block])?;
        Some(slope.map_or(TiltReference::Incline(under), |slope| TiltReference::MovingIncline(slope, under)))
    };
    let reference = |block: (usize, &Placement)| match support(block) {
        Some(SupportingBody::Ground) => on_profile(block.0).unwrap_or(on_ground),
        Some(SupportingBody::Block(below)) if stands(block.1) => TiltReference::Moving(blocks[below].range.start + 2),
        Some(SupportingBody::Beam(_) | SupportingBody::Block(_)) | None => TiltReference::Level,
    };
    scene.blocks.iter().map(|block| &block.placement).enumerate().map(reference).collect()
}

/// Whether the block stands on its reference: a block that only touches another, such as a
/// neighbour, isn't tilted when that turns.
fn stands(placement: &Placement) -> bool {
    matches!(placement, Placement::On { .. })
}

impl Layout {
    /// The angle of a block, by its number, relative to the surface that carries it, rad, for
    /// coordinates `q` of the whole model; on a beam relative to its undeformed axis.
    #[must_use]
    pub fn tilt(&self, block: usize, q: &[f64]) -> f64 {
        let place = &self.blocks[block];
        let phi = q[place.range.start + 2];
        match place.tilt_reference {
            TiltReference::Level => phi,
            TiltReference::Incline(slope) => phi - slope,
            TiltReference::Moving(slope) => phi - q[slope],
            TiltReference::MovingIncline(slope, under) => phi - q[slope] - under,
        }
    }

    /// As [`Layout::tilt`], for velocities `v`: the angular velocity of a block relative to the
    /// surface that carries it, rad/s.
    #[must_use]
    pub fn tilt_rate(&self, block: usize, v: &[f64]) -> f64 {
        let place = &self.blocks[block];
        let omega = v[place.range.start + 2];
        match place.tilt_reference {
            TiltReference::Level | TiltReference::Incline(_) => omega,
            TiltReference::Moving(slope) | TiltReference::MovingIncline(slope, _) => omega - v[slope],
        }
    }

    /// Monitors of the rocking of the blocks, starting at time `t` (s) with coordinates `q`.
    #[must_use]
    pub fn rocking_monitors(&self, t: f64, q: &[f64]) -> Vec<RockingMonitor> {
        let monitor = |block: usize| RockingMonitor::new(t, self.tilt(block, q)).with_least(self.blocks[block].still);
        (0..self.blocks.len()).map(monitor).collect()
    }
}
