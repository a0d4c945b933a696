//! Blocks that are released beyond the angle at which they overturn.

use crate::diagnostic::Diagnostic;
use crate::document::Document;
use crate::overlap::{Outline, PlacedOutline};
use crate::resolve::names::table_of;
use crate::scene::{BlockScene, Placement, Scene, SupportingBody};
use std::f64::consts::FRAC_PI_2;
use teeter_rigid::Pose;

/// A tilt of at least this fraction of the critical angle gives a warning.
const NEAR_CRITICAL: f64 = 0.9;

/// A block that is this part of its size above what it can touch stands on it: places are given with few digits.
const STANDS: f64 = 0.01;

/// Warns of a block tilted so far that it may overturn.
pub(super) fn warning(
    (number, block): (usize, &BlockScene),
    incline: f64,
    scene: &Scene,
    document: &Document,
) -> Option<Diagnostic> {
    let table = table_of(document, &block.name);
    // What is thrown or spins isn't released at rest.
    if block.velocity != [0.0; 2] || block.spin != 0.0 {
        return None;
    }
    let (key, angle, [flat, alpha]) = match block.placement {
        Placement::On { tilt, .. } => ("tilt", incline + tilt, [0.0, block.critical_angle()?]),
        Placement::Free { angle, .. } => {
            let [flat, alpha] = block.flat_near(angle)?;
            // An angle at random is fine.
            let is_told = document.is_given(&format!("block.{table}.angle"));
            if !is_told || (angle - flat).abs() < alpha || !stands((number, block), scene) {
                return None;
            }
            ("angle", angle - flat, [flat, alpha])
        }
    };
    let on_side = (flat / FRAC_PI_2).rem_euclid(2.0) == 1.0;
    let (ratio, lies) = if on_side { ("height/width", ", which lies on its side") } else { ("width/height", "") };
    let critical = format!("the critical angle atan({ratio}) = {:.2} deg of this block{lies}", alpha.to_degrees());
    let rule = if angle.abs() >= alpha {
        format!("at or beyond {critical}: released at rest it overturns")
    } else if angle.abs() >= NEAR_CRITICAL * alpha {
        format!("within 10 % of {critical}: close to overturning")
    } else {
        return None;
    };
    Some(document.error(&format!("block.{table}.{key}"), rule, "check the angle and its unit").as_warning())
}

/// Whether a block that is placed by its mass centre stands on something: in flight no foot is there about which an angle could be critical. What it
/// would stand on has a known place, but for blocks that are placed on others.
fn stands((number, block): (usize, &BlockScene), scene: &Scene) -> bool {
    let Some((centre, angle)) = free(block) else { return false };
    let near = STANDS * block.radius();
    let lowest = |height: &dyn Fn(f64) -> f64| {
        let pose = Pose::new(&[centre[0], centre[1], angle].into());
        let clearance = |(k, corner)| {
            let at = pose.point(corner);
            at.y - block.corner_radius(k) - height(at.x)
        };
        block.corners().iter().enumerate().map(clearance).fold(f64::INFINITY, f64::min)
    };
    let on_block = |other: &BlockScene| {
        let outline = |(centre, angle), block| PlacedOutline::new(centre, angle, &Outline::of(block));
        free(other).is_some_and(|place| outline((centre, angle), block).depth(&outline(place, other)) > -near)
    };
    scene.contacts.iter().any(|contact| match contact.surface {
        SupportingBody::Block(other) if contact.block == number => on_block(&scene.blocks[other]),
        SupportingBody::Block(other) if other == number => on_block(&scene.blocks[contact.block]),
        _ if contact.block != number => false,
        SupportingBody::Block(_) => false,
        SupportingBody::Ground => scene.ground.as_ref().is_some_and(|ground| {
            let height = |x: f64| match &ground.profile {
                Some(profile) => profile.height(x),
                None => x * ground.incline.tan(),
            };
            lowest(&height) < near
        }),
        // As it is drawn, undeformed: what sags is lower.
        SupportingBody::Beam(beam) => {
            let beam = &scene.beams[beam];
            let top = beam.position[1] + if beam.top { 0.5 * beam.thickness } else { 0.0 };
            lowest(&|_| top) < near
        }
    })
}

/// Where a block's mass centre is, m, and its angle, rad, if it is placed by these.
fn free(block: &BlockScene) -> Option<([f64; 2], f64)> {
    match block.placement {
        Placement::Free { position, angle, .. } => Some((position, angle)),
        Placement::On { .. } => None,
    }
}
