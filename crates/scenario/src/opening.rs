//! The conditions for a contact to count as open, so that its closing is an impact
//! (`docs/impacts.md`).

use crate::scene::Scene;
use teeter_integrator::{Opening, Openings};

/// A gap up to this fraction of the block's shorter side doesn't count as open: 3 µm for a block of
/// 3 cm.
pub const OPEN_GAP: f64 = 1e-4;

/// The condition for each contact to count as open: a gap of more than [`OPEN_GAP`] of its block's
/// shorter side, for longer than a bounce of that height under the scene's gravity g, 2 √(2 gap/g).
/// Without gravity only the gap counts.
pub(crate) fn openings(scene: &Scene) -> Openings {
    let fall = scene.gravity[0].hypot(scene.gravity[1]);
    let opening = |block: usize| {
        let block = &scene.blocks[block];
        let gap = OPEN_GAP * block.width.min(block.height);
        let time = if fall > 0.0 { 2.0 * (2.0 * gap / fall).sqrt() } else { 0.0 };
        Opening { gap, time, fall }
    };
    let openings = Openings::of_pairs(scene.contacts.iter().map(|contact| opening(contact.block)).collect());
    match scene.crowd {
        Some(_) => openings.with_groups((0..scene.blocks.len()).map(opening).collect()),
        None => openings,
    }
}
