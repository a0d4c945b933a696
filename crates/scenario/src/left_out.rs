//! What a model leaves out, and why: said by the check before a run and by the summary after it.

use crate::scene::{BeamScene, Scene, Support};
use std::collections::BTreeSet;
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
    meetings(scene, &mut left_out);
    left_out
}

/// Where bodies can meet that the model keeps apart nowhere, or only at corners.
fn meetings(scene: &Scene, left_out: &mut Vec<&'static str>) {
    let blocks = scene.blocks.len();
    let paired = scene.contacts.iter().filter(|contact| contact.other_block().is_some()).count();
    if paired == 0 && blocks > 1 {
        left_out.push("contact between blocks: they pass through each other");
    } else if paired < blocks * blocks.saturating_sub(1) / 2 {
        left_out.push("contact between blocks that no contact joins: they pass through each other");
    }
    let joined: BTreeSet<(usize, Support)> =
        scene.contacts.iter().map(|contact| (contact.block, contact.surface)).collect();
    let mut pairs = (0..scene.blocks.len()).flat_map(|block| {
        let ground = scene.ground.iter().map(|_| Support::Ground);
        ground.chain((0..scene.beams.len()).map(Support::Beam)).map(move |surface| (block, surface))
    });
    if pairs.any(|pair| !joined.contains(&pair)) {
        left_out
            .push("contact of blocks with the ground or a beam that no contact joins them to: they pass through it");
    }
    if scene.beams.len() > 1 || (!scene.beams.is_empty() && scene.ground.is_some()) {
        left_out.push("contact of beams with each other and with the ground: they pass through it");
    }
    if scene.contacts.iter().any(|contact| matches!(contact.surface, Support::Beam(_))) {
        left_out.push(
            "contact of beams with blocks but at the blocks' corners: a hump or a support between two corners goes into the base, and \
             so does a beam's end when a corner is past it",
        );
    }
}
