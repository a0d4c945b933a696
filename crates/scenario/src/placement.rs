//! Initial positions of blocks: by their mass centre, or on a surface.

use crate::driven::BeamModel;
use crate::ground_profile;
use crate::scene::{self, BlockScene, Placement, Scene, SupportingBody};
use crate::simulation::BuildError;
use nalgebra::{Vector2, Vector3};
use std::f64::consts::FRAC_PI_2;
use teeter_beam::StaticError;
use teeter_detect::{
    BodyId, ContactDetector, DetectorMemory, Geometry, Kinematics, LawId, ShapeDetector, SidePair, Summit, SurfacePoint,
};
use teeter_integrator::{BeamFace, EquilibriumError, Subsystem};
use teeter_rigid::Pose;

/// Why a scene has no initial state.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlacementError {
    /// The beam has no equilibrium.
    #[error("beam `{beam}`: {source}")]
    Static {
        /// The beam.
        beam: String,
        /// Why.
        source: StaticError,
    },
    /// A block doesn't stay in its place.
    #[error("no static equilibrium: block `{block}` {motion}")]
    NoEquilibrium {
        /// The block.
        block: String,
        /// How it moves.
        motion: InstabilityMode,
    },
    /// The iteration for the equilibrium didn't converge.
    #[error(
        "beam `{beam}`: no static equilibrium found after {rounds} iterations (relative change in the last one: {change:e})"
    )]
    Unsettled {
        /// The beam, or the first of several.
        beam: String,
        /// Iterations.
        rounds: u32,
        /// Size of the last step, in the norm of energy, relative to the scene.
        change: f64,
    },
    /// The computation of the equilibrium failed.
    #[error("beam `{beam}`: no static equilibrium found: {source}")]
    Search {
        /// The beam, or the first of several.
        beam: String,
        /// Why.
        source: EquilibriumError,
    },
    /// A block can't be laid on the profile of the ground.
    #[error("block `{block}`: its base finds no rest on the ground at x = {at} m, which is too steep there")]
    TooSteep {
        /// The block.
        block: String,
        /// The position of its base, m.
        at: f64,
    },
    /// A corner is not above the surface that it should stand on.
    #[error("block `{block}`: the corner {corner} at x = {x} m is not above the surface that the block stands on")]
    OffSurface {
        /// The block.
        block: String,
        /// The corner.
        corner: String,
        /// Its position, m.
        x: f64,
    },
}

/// How a block leaves its position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum InstabilityMode {
    /// Its feet slide.
    Slides,
    /// It turns about a foot.
    Tips,
    /// It is lifted off.
    LiftsOff,
    /// It rolls: what it stands on is round.
    Rolls,
    /// It falls over the single corner on which it stands.
    FallsOver,
    /// Held at its tilt, it would stand on its other foot.
    ChangesFoot,
}

impl std::fmt::Display for InstabilityMode {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Slides => "slides, as friction can't hold it",
            Self::Tips => {
                "tips: the resultant of its weight and the forces on it doesn't pass between its feet, or the beam yields too much under them"
            }
            Self::Rolls => "rolls, as it is round where it stands, and the surface slopes there or a force pushes it along",
            Self::FallsOver => {
                "falls over the single corner on which it stands: the resultant of its weight and the forces on it doesn't pass through that"
            }
            Self::LiftsOff => "lifts off, as the forces on it point upwards",
            Self::ChangesFoot => "would stand on its other foot, as the slope under it exceeds its tilt",
        })
    }
}

/// A foot of a block: its corner, and its position.
#[derive(Clone, Copy, Debug)]
struct Foot {
    corner: usize,
    x: f64,
}

/// The feet that a block stands on: the corner about which it is tilted, or both.
fn feet(block: &BlockScene, at: f64, tilt: f64) -> ([Foot; 2], usize) {
    let half = 0.5 * block.base();
    let [left, right] = block.feet();
    let (left, right) = (Foot { corner: left, x: at - half }, Foot { corner: right, x: at + half });
    if left.corner == right.corner || tilt > 0.0 {
        ([left, left], 1)
    } else if tilt < 0.0 {
        ([right, right], 1)
    } else {
        ([left, right], 2)
    }
}

/// Positions and forces (m, N) of a block on `on`, with its weight divided equally between its
/// feet; `None` for a block that stands on something else or nothing.
pub(crate) fn weight_of(block: &BlockScene, on: SupportingBody, gravity: [f64; 2]) -> Option<Vec<(f64, f64)>> {
    let Placement::On { support, at, tilt, .. } = block.placement else { return None };
    let (feet, count) = feet(block, at, tilt);
    let force = weight(block, gravity) / count as f64;
    (support == on).then(|| feet[..count].iter().map(|foot| (foot.x, force)).collect())
}

/// Contact can't pull, so upward gravity doesn't load the beam.
fn weight(block: &BlockScene, gravity: [f64; 2]) -> f64 {
    (-block.mass() * gravity[1]).max(0.0)
}

fn off_surface(block: &BlockScene, foot: &Foot) -> PlacementError {
    PlacementError::OffSurface { block: block.name.clone(), corner: block.corner_name(foot.corner), x: foot.x }
}

fn surface_height(
    block: &BlockScene,
    surface: &dyn Subsystem<2>,
    q: &[f64],
    kinematics: Kinematics,
    foot: &Foot,
) -> Result<f64, PlacementError> {
    let at = Vector2::new(foot.x, 0.0);
    surface.surface(0, q, kinematics, &at).map(|point| point.place.y).ok_or_else(|| off_surface(block, foot))
}

/// The initial configurations (X, Y, φ) of all blocks: on beams with these deflections, on ground
/// along the given line, on each other. Supports are displaced as at the start.
pub(crate) fn starting_poses(
    scene: &Scene,
    beams: &[BeamModel],
    deflections: &[Vec<f64>],
    ground: [f64; 3],
) -> Result<Vec<Vector3<f64>>, BuildError> {
    let mut poses: Vec<Option<Vector3<f64>>> = vec![None; scene.blocks.len()];
    let mut pile = Vec::new();
    for block in 0..scene.blocks.len() {
        // Blocks below come first; the resolver refuses cycles.
        let mut lower = Some(block).filter(|&block| poses[block].is_none());
        while let Some(block) = lower {
            pile.push(block);
            lower = below(scene, block).filter(|&below| poses[below].is_none() && pile.len() <= scene.blocks.len());
        }
        while let Some(number) = pile.pop() {
            let block = &scene.blocks[number];
            let pose = match block.placement {
                Placement::On { support: SupportingBody::Beam(k), .. } => {
                    let still = beams[k].still(&scene.beams[k])?.boxed();
                    block_pose(scene, block, &SupportSurface::Surface(still.as_ref(), &deflections[k]))?
                }
                Placement::On { support: SupportingBody::Block(below), at, tilt, stacked, .. } => {
                    let lower = &scene.blocks[below];
                    if lower.parts.is_some() {
                        let on = poses[below].unwrap_or_default();
                        poses[number] = Some(pose_on_block(block, lower, &on, at, stacked, tilt)?);
                        continue;
                    }
                    let top = TopSide::of(lower, &poses[below].unwrap_or_default());
                    let at = if stacked { top.line[0] + at * top.line[2].cos() } else { at };
                    if !top.is_under(block, at) {
                        return Err(off_surface(block, &Foot { corner: 0, x: at - 0.5 * block.width }).into());
                    }
                    pose_on_line(block, at, tilt, &top.line)
                }
                Placement::On { support: SupportingBody::Ground, at, .. } if ground_profile::of(scene).is_some() => {
                    let pose =
                        ground_profile::of(scene).and_then(|profile| ground_profile::pose(profile, block, ground));
                    pose.ok_or_else(|| PlacementError::TooSteep { block: block.name.clone(), at })?
                }
                _ => block_pose(scene, block, &SupportSurface::Line(ground))?,
            };
            poses[number] = Some(pose);
        }
    }
    Ok(poses.into_iter().map(Option::unwrap_or_default).collect())
}

/// The block on which a block stands.
pub(crate) fn below(scene: &Scene, block: usize) -> Option<usize> {
    match scene.blocks[block].placement {
        Placement::On { support: SupportingBody::Block(below), .. } => Some(below),
        _ => None,
    }
}

/// The beam that carries a block, directly or through the blocks below it, by the placements of
/// that many blocks, as far as they are known.
pub(crate) fn carried_by<'a>(
    blocks: usize,
    block: usize,
    placement: impl Fn(usize) -> Option<&'a Placement>,
) -> Option<usize> {
    let mut block = block;
    // The resolver refuses cycles, but may ask before.
    for _ in 0..=blocks {
        match placement(block)? {
            Placement::On { support: SupportingBody::Beam(beam), .. } => return Some(*beam),
            Placement::On { support: SupportingBody::Block(below), .. } => block = *below,
            _ => return None,
        }
    }
    None
}

/// The upper side of a block.
struct TopSide {
    /// Its midpoint, and its slope, rad.
    line: [f64; 3],
    /// Its extent along x, m.
    x: [f64; 2],
}

impl TopSide {
    fn of(block: &BlockScene, pose: &Vector3<f64>) -> Self {
        // Quarter turns that bring another side to the top.
        let quarters = (pose.z / FRAC_PI_2).round();
        let slope = pose.z - quarters * FRAC_PI_2;
        let sides =
            if quarters.rem_euclid(2.0) == 0.0 { [block.width, block.height] } else { [block.height, block.width] };
        let upright = Pose::new(&Vector3::new(pose.x, pose.y, slope));
        let end = |half: f64| upright.point(&Vector2::new(half * sides[0], 0.5 * sides[1]));
        let [left, middle, right] = [end(-0.5), end(0.0), end(0.5)];
        Self { line: [middle.x, middle.y, slope], x: [left.x, right.x] }
    }

    /// Whether it is under a part of the base of a block, whose midpoint is at `at` (m) before it
    /// is tilted.
    fn is_under(&self, block: &BlockScene, at: f64) -> bool {
        let half = 0.5 * block.base() * self.line[2].cos();
        at + half > self.x[0] && at - half < self.x[1]
    }
}

/// What a block can stand on.
pub(crate) enum SupportSurface<'a> {
    /// The surface of a body with its coordinates.
    Surface(&'a dyn Subsystem<2>, &'a [f64]),
    /// A straight line through a point x, y with a slope (rad): the ground.
    Line([f64; 3]),
}

/// The initial configuration (X, Y, φ) of a block: as placed by its mass centre, or on what it
/// stands on.
pub(crate) fn block_pose(
    scene: &Scene,
    block: &BlockScene,
    on: &SupportSurface<'_>,
) -> Result<Vector3<f64>, PlacementError> {
    let (at, tilt, contact) = match block.placement {
        Placement::Free { position, angle } => return Ok(Vector3::new(position[0], position[1], angle)),
        Placement::On { at, tilt, contact, .. } => (at, tilt, contact),
    };
    let (surface, q) = match on {
        SupportSurface::Surface(surface, q) => (*surface, *q),
        SupportSurface::Line(line) => return Ok(pose_on_line(block, at, tilt, line)),
    };
    let scene::ContactScene { kinematics, sides, .. } = scene.contacts[contact];
    let rest = |pose| if sides { on_sides(block, pose, surface, q) } else { Ok(pose) };
    if block.parts.is_some() {
        let start = pose_on_line(block, at, tilt, &[0.0; 3]);
        return rest(on_surface(block, start, |at| surface.surface(0, q, kinematics, at))?);
    }
    let (feet, count) = feet(block, at, tilt);
    let height_at = |foot: &Foot| surface_height(block, surface, q, kinematics, foot);
    if count == 2 {
        // An upright block stands on the higher of its feet; where one is past the end of the beam,
        // on the other one, and perhaps on that end.
        let heights = match (height_at(&feet[0]), height_at(&feet[1])) {
            (Ok(left), Ok(right)) => left.max(right),
            (Ok(one), Err(_)) | (Err(_), Ok(one)) if sides => one,
            (Err(error), _) | (_, Err(error)) => return Err(error),
        };
        return rest(Vector3::new(at, heights + 0.5 * block.height, 0.0));
    }
    rest(turned_about(block, &feet[0], Vector2::new(feet[0].x, height_at(&feet[0])?), tilt))
}

/// A block on the surface of a beam, moved up until neither a hump nor an end of the beam is inside
/// one of its sides.
fn on_sides(
    block: &BlockScene,
    mut pose: Vector3<f64>,
    surface: &dyn Subsystem<2>,
    q: &[f64],
) -> Result<Vector3<f64>, PlacementError> {
    let invalid = || off_surface(block, &Foot { corner: block.feet()[0], x: pose.x });
    let (body, law) = (BodyId(0), LawId(0));
    let pair = SidePair { pair: 0, law, body, surface: BodyId(1), kinematics: Kinematics::Deformed };
    let shapes = block.shapes().map_err(|_| invalid())?.into_iter().map(|shape| (body, shape)).collect();
    let detector = ShapeDetector::new(shapes, Vec::new()).and_then(|shapes| shapes.with_sides(vec![pair]));
    let detector = detector.map_err(|_| invalid())?;
    let (mut found, mut memory) = (Vec::new(), DetectorMemory::default());
    for _ in 0..ROUNDS {
        detector.detect(&OnBeam { pose: Pose::new(&pose), surface, q }, 0.0, &mut memory, &mut found);
        let rise = found.iter().map(|touch| -touch.gap / touch.frame[(0, 1)]).fold(0.0, f64::max);
        if rise <= f64::EPSILON * (pose.y.abs() + block.radius()) {
            break;
        }
        pose.y += rise;
    }
    Ok(pose)
}

/// A block in a pose, and a beam.
struct OnBeam<'a> {
    pose: Pose,
    surface: &'a dyn Subsystem<2>,
    q: &'a [f64],
}

impl Geometry<2> for OnBeam<'_> {
    fn place(&self, _: BodyId, local: &[Vector2<f64>], out: &mut [Vector2<f64>]) {
        out.iter_mut().zip(local).for_each(|(out, local)| *out = self.pose.point(local));
    }

    fn surface(&self, _: BodyId, kinematics: Kinematics, at: &Vector2<f64>) -> Option<SurfacePoint<2>> {
        self.surface.surface(BeamFace::Upper.fibre(), self.q, kinematics, at)
    }

    fn summits(
        &self,
        _: BodyId,
        _: Kinematics,
        direction: &Vector2<f64>,
        between: &[Vector2<f64>; 2],
        each: &mut dyn FnMut(Summit<2>),
    ) {
        self.surface.summits(BeamFace::Upper.fibre(), self.q, direction, between, each);
    }

    fn ends(&self, _: BodyId, _: Kinematics) -> [Option<SurfacePoint<2>>; 2] {
        self.surface.ends(BeamFace::Upper.fibre(), self.q)
    }
}

/// On a line the midpoint of the base is at x = `at`, the base lies along the line, and the tilt is
/// relative to it.
fn pose_on_line(block: &BlockScene, at: f64, tilt: f64, &[x, y, slope]: &[f64; 3]) -> Vector3<f64> {
    let line = Pose::new(&Vector3::new(at, y + (at - x) * slope.tan(), slope));
    if block.parts.is_some() {
        let centre = line.point(&centre_above(block, tilt));
        return Vector3::new(centre.x, centre.y, slope + tilt);
    }
    let (feet, count) = feet(block, 0.0, tilt);
    if count == 2 {
        let centre = line.point(&Vector2::new(0.0, 0.5 * block.height));
        return Vector3::new(centre.x, centre.y, slope);
    }
    turned_about(block, &feet[0], line.point(&Vector2::new(feet[0].x, 0.0)), slope + tilt)
}

/// The mass centre of a block above a level line that its lowest point touches, from the midpoint
/// of its base before it is tilted about an end of that.
pub(crate) fn centre_above(block: &BlockScene, tilt: f64) -> Vector2<f64> {
    let corners = block.corners();
    let [left, right] = block.feet().map(|foot| corners[foot]);
    let middle = 0.5 * (left + right);
    let pivot = if tilt > 0.0 {
        left
    } else if tilt < 0.0 {
        right
    } else {
        middle
    };
    let turned = Pose::new(&Vector3::new(0.0, 0.0, tilt));
    let height = |k: usize| turned.rotate(&corners[k]).y - block.corner_radius(k);
    let lowest = (0..corners.len()).map(height).fold(f64::INFINITY, f64::min);
    Vector2::new(pivot.x - middle.x - turned.rotate(&pivot).x, -lowest)
}

/// Rounds in which a block is moved up or down until it touches a surface that bends.
const ROUNDS: usize = 50;

/// A block moved up or down such that its lowest point touches a surface.
fn on_surface(
    block: &BlockScene,
    mut pose: Vector3<f64>,
    under: impl Fn(&Vector2<f64>) -> Option<SurfacePoint<2>>,
) -> Result<Vector3<f64>, PlacementError> {
    let corners = block.corners();
    for _ in 0..ROUNDS {
        let place = Pose::new(&pose);
        let above = |k: usize| {
            let (centre, radius) = (place.point(&corners[k]), block.corner_radius(k));
            let mut point = under(&centre)?;
            let mut lowest = centre;
            if radius > 0.0 {
                for _ in 0..ROUNDS {
                    lowest = centre - radius * point.normal;
                    point = under(&lowest)?;
                }
            }
            Some(point.normal.dot(&(lowest - point.place)) / point.normal.y)
        };
        let Some(gap) = (0..corners.len()).filter_map(above).reduce(f64::min) else {
            let [corner, _] = block.feet();
            return Err(off_surface(block, &Foot { corner, x: pose.x }));
        };
        pose.y -= gap;
        if gap.abs() <= f64::EPSILON * (pose.y.abs() + block.radius()) {
            break;
        }
    }
    Ok(pose)
}

/// A block dropped on another one that is no rectangle, its base level before it is tilted.
fn pose_on_block(
    block: &BlockScene,
    lower: &BlockScene,
    on: &Vector3<f64>,
    at: f64,
    stacked: bool,
    tilt: f64,
) -> Result<Vector3<f64>, PlacementError> {
    let place = Pose::new(on);
    let below: Vec<PlacedPart> = PlacedPart::all(lower, &place);
    let at = if stacked { top_middle(&below) + at } else { at };
    let centre = centre_above(block, tilt);
    let pose = Vector3::new(at + centre.x, centre.y, tilt);
    let above = PlacedPart::all(block, &Pose::new(&pose));
    let rise = |upper: &PlacedPart| below.iter().filter_map(|lower| upper.rise_above(lower)).reduce(f64::max);
    match above.iter().filter_map(rise).reduce(f64::max) {
        Some(rise) => Ok(Vector3::new(pose.x, pose.y + rise, tilt)),
        None => {
            let [corner, _] = block.feet();
            Err(off_surface(block, &Foot { corner, x: pose.x }))
        }
    }
}

/// x of the middle of the highest points, m.
fn top_middle(parts: &[PlacedPart]) -> f64 {
    let points = || parts.iter().flat_map(|part| part.core.iter().map(|corner| (corner.x, corner.y + part.radius)));
    let highest = points().map(|(_, y)| y).fold(f64::NEG_INFINITY, f64::max);
    let size = points().map(|(_, y)| highest - y).fold(0.0, f64::max);
    let top = || points().filter(|(_, y)| highest - y <= TOP * size).map(|(x, _)| x);
    0.5 * (top().fold(f64::INFINITY, f64::min) + top().fold(f64::NEG_INFINITY, f64::max))
}

/// Points that differ in height by this fraction of a block's height are level.
const TOP: f64 = 1e-9;

/// A part of a block in the world: all that is within a radius of its core.
struct PlacedPart {
    core: Vec<Vector2<f64>>,
    radius: f64,
}

impl PlacedPart {
    fn all(block: &BlockScene, place: &Pose) -> Vec<Self> {
        let of = |corners: &[Vector2<f64>], radius: f64| Self {
            core: corners.iter().map(|corner| place.point(corner)).collect(),
            radius,
        };
        match &block.parts {
            None => vec![of(&block.corners(), 0.0)],
            Some(parts) => parts.iter().map(|part| of(part.shape.core(), part.shape.radius())).collect(),
        }
    }

    /// How far up it must be moved to touch another part from above, m; `None` where it is beside
    /// that. The two cores are then the sum of their radii apart.
    fn rise_above(&self, lower: &Self) -> Option<f64> {
        let reach = self.radius + lower.radius;
        let over = self.core.iter().filter_map(|corner| Some(lower.height_at(corner.x, reach, 1.0)? - corner.y));
        let under = lower.core.iter().filter_map(|corner| Some(corner.y + self.height_at(corner.x, reach, -1.0)?));
        over.chain(under).reduce(f64::max)
    }

    /// The highest (`sign` 1) point at `x` of all that is within `reach` of the core, or minus the
    /// lowest one (−1); `None` where it doesn't extend there.
    fn height_at(&self, x: f64, reach: f64, sign: f64) -> Option<f64> {
        let arcs = self.core.iter().filter_map(|corner| {
            let off = x - corner.x;
            (off.abs() <= reach).then(|| sign * corner.y + (reach * reach - off * off).sqrt())
        });
        let n = self.core.len();
        let sides = (0..n).filter_map(|k| {
            let (from, to) = (self.core[k], self.core[(k + 1) % n]);
            let length = (to - from).norm();
            // Out of the part, as corners are counter-clockwise.
            let out = reach * Vector2::new(to.y - from.y, from.x - to.x) / length;
            let (from, to) = (from + out, to + out);
            let part = (x - from.x) / (to.x - from.x);
            (length > 0.0 && (0.0..=1.0).contains(&part)).then(|| sign * (from.y + part * (to.y - from.y)))
        });
        arcs.chain(sides).reduce(f64::max)
    }
}

/// A block with the corner of `foot` at `place`, turned by `angle`.
fn turned_about(block: &BlockScene, foot: &Foot, place: Vector2<f64>, angle: f64) -> Vector3<f64> {
    let corner = Vector2::new(if foot.corner == 0 { -0.5 } else { 0.5 } * block.width, -0.5 * block.height);
    let centre = place - Pose::new(&Vector3::new(0.0, 0.0, angle)).rotate(&corner);
    Vector3::new(centre.x, centre.y, angle)
}
