//! Overlaps of bodies where the model has no contact: they are reported, not prevented.

mod passing;

use crate::ground_profile;
use crate::overlap::{Outline, PlacedOutline, Sweep, each_overlap};
use crate::scene::{BlockScene, Crowd, Scene, SupportingBody};
use crate::simulation::Layout;
use nalgebra::Vector2;
use std::collections::BTreeSet;
use std::sync::Arc;
use teeter_detect::Profile;

/// Two overlapping bodies, by their numbers in the scene, without a contact that separates them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Meeting {
    /// Two blocks.
    Blocks(usize, usize),
    /// A block below ground with which it has no contact.
    Ground(usize),
    /// A block and a beam without a contact.
    Beam(usize, usize),
    /// A block and a beam that it touches only with its corners: the beam is inside the block
    /// between them.
    BetweenCorners(usize, usize),
    /// A block with corners past the end of a beam, below its surface.
    PastEnd(usize, usize),
}

/// Overlap up to this fraction of a block's shorter side is attributed to rounding and drift of
/// corners.
const MEETS: f64 = 3e-3;

/// Most pairs of neighbouring blocks that are checked; in a larger heap only what was found is
/// reported.
const MOST_PAIRS: usize = 20_000;

/// Positions along a beam that are checked under a block.
const PLACES: usize = 12;

/// With what a block can touch a beam.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum OnBeam {
    Nothing,
    Corners,
    Sides,
}

impl OnBeam {
    fn all(scene: &Scene, beam: usize) -> Vec<Self> {
        let mut all = vec![Self::Nothing; scene.blocks.len()];
        for contact in scene.contacts.iter().filter(|contact| contact.surface == SupportingBody::Beam(beam)) {
            all[contact.block] = if contact.sides { Self::Sides } else { Self::Corners };
        }
        all
    }
}

/// A beam's line in the plane.
#[derive(Debug, Clone, Copy)]
struct BeamShape {
    /// The contact surface at the left end without displacements, m.
    left: [f64; 2],
    span: f64,
}

/// The shapes of a scene's bodies, to find their overlaps.
#[derive(Debug, Clone)]
pub struct Shapes {
    outlines: Vec<Outline>,
    /// How deep each may penetrate, for rounding and drift, m.
    allowed: Vec<f64>,
    beams: Vec<BeamShape>,
    /// Slope of fixed ground; `None` without ground.
    incline: Option<f64>,
    /// The profile of the ground; `None` for a straight line.
    profile: Option<Arc<Profile>>,
    /// The corners of the blocks relative to their mass centres, with their radii, m; empty without
    /// a profile.
    corners: Vec<Vec<(Vector2<f64>, f64)>>,
    /// Blocks that have a contact with the ground, and with each beam.
    on_ground: Vec<bool>,
    /// Pairs of blocks with a listed contact, the lower number first.
    blocks: BTreeSet<(usize, usize)>,
    /// The contacts that are not listed.
    crowd: Option<Crowd>,
    /// The shortest side of all blocks, m.
    shortest: f64,
    /// For each beam, how each block can touch it.
    on_beam: Vec<Vec<OnBeam>>,
    boxes: Vec<PlacedOutline>,
    sweep: Sweep,
}

impl Shapes {
    /// The shapes of a scene.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let joined = |surface: SupportingBody| {
            let mut joined = vec![false; scene.blocks.len()];
            let contacts = scene.contacts.iter().filter(|contact| contact.surface == surface);
            contacts.for_each(|contact| joined[contact.block] = true);
            joined
        };
        let line = |beam: &crate::scene::BeamScene| {
            let offset = if beam.top { 0.5 * beam.thickness } else { 0.0 };
            BeamShape { left: [beam.position[0], beam.position[1] + offset], span: beam.spec.span }
        };
        Self {
            outlines: scene.blocks.iter().map(Outline::of).collect(),
            allowed: scene.blocks.iter().map(|block| MEETS * block.width.min(block.height)).collect(),
            beams: scene.beams.iter().map(line).collect(),
            incline: scene.ground.as_ref().map(|ground| ground.incline),
            profile: scene.ground.as_ref().and_then(|ground| ground.profile.clone()),
            corners: match ground_profile::of(scene) {
                Some(_) => scene.blocks.iter().map(rounded_corners).collect(),
                None => Vec::new(),
            },
            on_ground: joined(SupportingBody::Ground),
            blocks: scene
                .contacts
                .iter()
                .filter_map(|contact| Some((contact.block, contact.other_block()?)))
                .map(|(a, b)| (a.min(b), a.max(b)))
                .collect(),
            crowd: scene.crowd.clone(),
            shortest: scene.blocks.iter().map(|block| block.width.min(block.height)).fold(f64::INFINITY, f64::min),
            on_beam: (0..scene.beams.len()).map(|beam| OnBeam::all(scene, beam)).collect(),
            boxes: Vec::with_capacity(scene.blocks.len()),
            sweep: Sweep::with_capacity(scene.blocks.len()),
        }
    }

    /// Passes each overlap at coordinates `q` of the whole model to `each`, with its depth, m.
    pub fn meetings(&mut self, layout: &Layout, q: &[f64], mut each: impl FnMut(Meeting, f64)) {
        let Self {
            outlines,
            allowed,
            beams,
            incline,
            profile,
            corners,
            on_ground,
            blocks,
            crowd,
            on_beam,
            boxes,
            sweep,
            ..
        } = self;
        boxes.clear();
        boxes.extend(layout.blocks.iter().zip(outlines.iter()).map(|(place, outline)| {
            let q = &q[place.range.clone()];
            PlacedOutline::new([q[0], q[1]], q[2], outline)
        }));
        let allowed = |block: usize| allowed[block];
        if boxes.len() > 1 {
            each_overlap(boxes, allowed, MOST_PAIRS, sweep, |overlap| {
                let (a, b) = (overlap.first, overlap.second);
                let joined = blocks.contains(&(a, b)) || crowd.as_ref().is_some_and(|crowd| crowd.joins(a, b));
                if !joined {
                    each(Meeting::Blocks(overlap.first, overlap.second), overlap.depth);
                }
            });
        }
        if let (Some(profile), Some(_)) = (&*profile, &*incline) {
            let ground = layout
                .ground
                .as_ref()
                .map_or([0.0; 3], |range| [q[range.start], q[range.start + 1], q[range.start + 2]]);
            for (block, _) in on_ground.iter().enumerate().filter(|(_, joined)| !**joined) {
                let place = layout.blocks[block].range.start;
                let depth =
                    ground_profile::depth(profile, ground, &corners[block], [q[place], q[place + 1], q[place + 2]]);
                if depth > allowed(block) {
                    each(Meeting::Ground(block), depth);
                }
            }
        } else if let Some(incline) = *incline {
            let [x, y, slope] = match &layout.ground {
                Some(range) => [q[range.start], q[range.start + 1], q[range.start + 2]],
                None => [0.0, 0.0, incline],
            };
            let up = [-slope.sin(), slope.cos()];
            let level = x * up[0] + y * up[1];
            for (block, _) in on_ground.iter().enumerate().filter(|(_, joined)| !**joined) {
                let depth = level - boxes[block].projection(up)[0];
                if depth > allowed(block) {
                    each(Meeting::Ground(block), depth);
                }
            }
        }
        for (number, ((shape, place), joined)) in beams.iter().zip(&layout.beams).zip(on_beam.iter()).enumerate() {
            let moved = place.support_displacement(q);
            let own = &q[place.range.clone()];
            // A beam without hold along its axis drifts as one.
            let drift = place.axial_displacement_at(own, 0.5 * shape.span);
            let (left, bottom) = (shape.left[0] + moved[0] + drift, shape.left[1] + moved[1]);
            let depth_at = |block: &PlacedOutline, along: f64| {
                let w = place.deflection_at(own, along).map_or(f64::NAN, |at| at.w);
                block.depth_of([left + along, bottom + w])
            };
            // What touches with its sides penetrates no deeper than the detector tells.
            for (block, of) in boxes.iter().enumerate().filter(|(block, _)| joined[*block] != OnBeam::Sides) {
                let [low, high] = of.projection([1.0, 0.0]);
                let (from, to) = ((low - left).max(0.0), (high - left).min(shape.span));
                if from > to {
                    continue;
                }
                let along = |k: usize| from + (to - from) * (k as f64 / PLACES as f64);
                let deepest = (0..=PLACES).map(|k| depth_at(of, along(k))).fold(0.0, f64::max);
                if deepest > allowed(block) {
                    let at_end = [0.0, shape.span].into_iter().any(|end| depth_at(of, end) > allowed(block));
                    let meeting = match (joined[block], at_end) {
                        (OnBeam::Nothing | OnBeam::Sides, _) => Meeting::Beam(block, number),
                        (OnBeam::Corners, false) => Meeting::BetweenCorners(block, number),
                        (OnBeam::Corners, true) => Meeting::PastEnd(block, number),
                    };
                    each(meeting, deepest);
                }
            }
        }
    }
}

/// The corners of a block with their radii, m.
fn rounded_corners(block: &BlockScene) -> Vec<(Vector2<f64>, f64)> {
    block.corners().into_iter().enumerate().map(|(k, corner)| (corner, block.corner_radius(k))).collect()
}
