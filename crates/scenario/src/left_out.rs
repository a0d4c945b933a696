//! What the model of a scene leaves out, and why, for `check` and the summary.

use crate::scene::{BeamScene, Crowd, Scene, SupportingBody, pairs_between};
use std::collections::BTreeSet;
use teeter_beam::Axial;

/// What the model of a scene leaves out, with reasons.
#[must_use]
pub fn left_out(scene: &Scene) -> Vec<&'static str> {
    let mut left_out = Vec::new();
    let any = |is: fn(&BeamScene) -> bool| scene.beams.iter().any(is);
    if any(|beam| beam.spec.axial == Axial::Free) {
        left_out.push(if any(|beam| beam.motion.is_given()) {
            "axial motion of beams relative to their supports, which are axially free"
        } else {
            "axial motion of beams: their supports are axially free"
        });
    }
    if any(|beam| beam.spec.axial == Axial::Held) {
        left_out.push("axial inertia of beams held along their axis: the axial force is constant along the beam");
    }
    if any(|beam| matches!(beam.spec.axial, Axial::Elastic { .. })) {
        left_out.push("the effect of deflections on elastic axes: axial motion is not coupled to them");
    }
    if any(|beam| !beam.is_sheared()) {
        left_out.push("shear and rotatory inertia of beams of the theory euler-bernoulli");
    }
    if any(|beam| beam.reduction.is_some()) {
        left_out.push("the higher shapes of beams in modes, which an impact would excite");
    }
    if any(|beam| !beam.self_weight) {
        left_out.push("self-weight of beams: deflections are relative to the shape under it");
    }
    meetings(scene, &mut left_out);
    left_out
}

/// Adds the bodies between which the model has no contact, or only contact at corners.
fn meetings(scene: &Scene, left_out: &mut Vec<&'static str>) {
    let blocks = scene.blocks.len();
    let listed = scene.contacts.iter().filter(|contact| contact.other_block().is_some()).count();
    let paired = listed + scene.crowd.as_ref().map_or(0, Crowd::pair_count);
    if paired == 0 && blocks > 1 {
        left_out.push("contact between blocks: they pass through each other");
    } else if paired < pairs_between(blocks, blocks, true) {
        left_out.push("contact between blocks without a [contact]: they pass through each other");
    }
    let joined: BTreeSet<(usize, SupportingBody)> =
        scene.contacts.iter().map(|contact| (contact.block, contact.surface)).collect();
    let mut pairs = (0..scene.blocks.len()).flat_map(|block| {
        let ground = scene.ground.iter().map(|_| SupportingBody::Ground);
        ground.chain((0..scene.beams.len()).map(SupportingBody::Beam)).map(move |surface| (block, surface))
    });
    if pairs.any(|pair| !joined.contains(&pair)) {
        left_out.push("contact of blocks with the ground or a beam without a [contact]: they pass through it");
    }
    if scene.beams.len() > 1 || (!scene.beams.is_empty() && scene.ground.is_some()) {
        left_out.push("contact of beams with each other and with the ground: they pass through it");
    }
    if scene.contacts.iter().any(|contact| matches!(contact.surface, SupportingBody::Beam(_)) && !contact.sides) {
        left_out.push(
            "contact of beams with blocks, where it has points = \"corners\" or kinematics = \"linear\", except at the blocks' corners: a hump or a support between two corners penetrates the base, and \
             so does a beam's end when a corner is past it",
        );
    }
}
