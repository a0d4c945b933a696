//! What a model leaves out, and why: said by the check before a run and by the summary after it.

use crate::scene::Scene;

/// What the model of a scene leaves out, each with its reason.
#[must_use]
pub fn left_out(scene: &Scene) -> Vec<&'static str> {
    let mut left_out = Vec::new();
    if scene.beams.is_empty() {
        left_out.push("no beam: no beam dofs, no factorisation");
    } else {
        let moving = scene.beams.iter().any(|beam| beam.motion.is_given());
        left_out.push(if moving {
            "axial motion of beams relative to their supports: these are free along the axis"
        } else {
            "axial motion of beams: their supports are free along the axis"
        });
        left_out.push("self-weight of beams: deflections count from the shape under it");
    }
    if scene.blocks.len() > 1 {
        left_out.push("contact between blocks");
    }
    left_out
}
