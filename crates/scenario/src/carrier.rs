//! What carries a block, and the angle at which it stands on that.

use crate::scene::{Placement, Scene, Support};
use crate::simulation::{BlockPlace, Layout};
use teeter_integrator::RockingMonitor;

/// What carries a block, as far as its rocking goes: what it is placed on, else the surface of its
/// first contact in the file.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub enum Carrier {
    /// A beam, whose undeformed axis is level, or nothing at all.
    #[default]
    Level,
    /// Ground that stands still, with this slope, rad.
    Incline(f64),
    /// Ground that moves, or a block: the place of its slope in the state.
    Moving(usize),
}

/// The carriers of the blocks, whose places are given; `slope` is the place of the slope of ground
/// that moves.
pub(crate) fn carriers(scene: &Scene, blocks: &[BlockPlace], slope: Option<usize>) -> Vec<Carrier> {
    let on_ground = match (slope, &scene.ground) {
        (Some(slope), _) => Carrier::Moving(slope),
        (None, Some(ground)) if ground.incline != 0.0 => Carrier::Incline(ground.incline),
        _ => Carrier::Level,
    };
    let support = |(number, placement): (usize, &Placement)| match placement {
        Placement::On { support, .. } => Some(*support),
        Placement::Free { .. } => {
            scene.contacts.iter().find(|contact| contact.block == number).map(|contact| contact.surface)
        }
    };
    let carrier = |block| match support(block) {
        Some(Support::Ground) => on_ground,
        Some(Support::Block(below)) if stands(block.1) => Carrier::Moving(blocks[below].range.start + 2),
        Some(Support::Beam(_) | Support::Block(_)) | None => Carrier::Level,
    };
    scene.blocks.iter().map(|block| &block.placement).enumerate().map(carrier).collect()
}

/// Whether it stands on what carries it: what only touches a block, such as a neighbour, isn't
/// tilted by its turning.
fn stands(placement: &Placement) -> bool {
    matches!(placement, Placement::On { .. })
}

impl Layout {
    /// The angle of a block, by its number, from the surface that carries it, rad, for coordinates
    /// `q` of the whole model.
    #[must_use]
    pub fn tilt(&self, block: usize, q: &[f64]) -> f64 {
        let place = &self.blocks[block];
        let phi = q[place.range.start + 2];
        match place.carrier {
            Carrier::Level => phi,
            Carrier::Incline(slope) => phi - slope,
            Carrier::Moving(slope) => phi - q[slope],
        }
    }

    /// As [`Layout::tilt`], for velocities `v`: the rate at which it turns relative to what carries
    /// it, rad/s.
    #[must_use]
    pub fn tilt_rate(&self, block: usize, v: &[f64]) -> f64 {
        let place = &self.blocks[block];
        let omega = v[place.range.start + 2];
        match place.carrier {
            Carrier::Level | Carrier::Incline(_) => omega,
            Carrier::Moving(slope) => omega - v[slope],
        }
    }

    /// What watches the rocking of the blocks, from time `t` (s) and coordinates `q` on.
    #[must_use]
    pub fn rocking_monitors(&self, t: f64, q: &[f64]) -> Vec<RockingMonitor> {
        let monitor = |block: usize| RockingMonitor::new(t, self.tilt(block, q)).with_least(self.blocks[block].still);
        (0..self.blocks.len()).map(monitor).collect()
    }
}
