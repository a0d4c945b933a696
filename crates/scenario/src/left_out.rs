//! What a model leaves out, and why: said by the check before a run and by the summary after it.

use crate::scene::{BeamScene, Scene};
use teeter_beam::Axial;

/// What the model of a scene leaves out, each with its reason.
#[must_use]
pub fn left_out(scene: &Scene) -> Vec<&'static str> {
    let mut left_out = Vec::new();
    if scene.beams.is_empty() {
        left_out.push("no beam: no beam dofs, no factorisation");
    } else {
        let any = |is: fn(&BeamScene) -> bool| scene.beams.iter().any(is);
        if any(|beam| beam.spec.axial == Axial::Free) {
            left_out.push(if any(|beam| beam.motion.is_given()) {
                "axial motion of beams relative to their supports: these are free along the axis"
            } else {
                "axial motion of beams: their supports are free along the axis"
            });
        }
        if any(|beam| beam.spec.axial == Axial::Held) {
            left_out.push("axial inertia of beams held along their axis: the axial force is the same all along");
        }
        if any(|beam| matches!(beam.spec.axial, Axial::Elastic { .. })) {
            left_out.push("what deflections do to elastic axes: axial motion doesn't feel them");
        }
        if any(|beam| !beam.is_sheared()) {
            left_out.push("shear and rotatory inertia of beams of the theory euler-bernoulli");
        }
        if any(|beam| beam.reduction.is_some()) {
            left_out.push("the higher shapes of beams in modes: what an impact would stir in them");
        }
        if any(|beam| !beam.self_weight) {
            left_out.push("self-weight of beams: deflections count from the shape under it");
        }
    }
    if scene.blocks.len() > 1 {
        left_out.push("contact between blocks");
    }
    left_out
}
