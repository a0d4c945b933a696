//! Where blocks are put: by their mass centre, or on a surface.

use crate::driven::BeamModel;
use crate::scene::{BlockScene, Placement, Scene, Support};
use crate::simulation::BuildError;
use nalgebra::{Vector2, Vector3};
use std::f64::consts::FRAC_PI_2;
use teeter_beam::StaticError;
use teeter_detect::Kinematics;
use teeter_integrator::{EquilibriumError, Subsystem};
use teeter_rigid::Pose;

/// Why a scene has no start.
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
    /// A block doesn't stay where it was put.
    #[error("no static equilibrium: block `{block}` {motion}")]
    NoEquilibrium {
        /// The block.
        block: String,
        /// What it does.
        motion: Departure,
    },
    /// The equilibrium was not found.
    #[error(
        "beam `{beam}`: no static equilibrium found after {rounds} rounds (the last one moved by {change:e}, relative)"
    )]
    Unsettled {
        /// The beam, or the first of several.
        beam: String,
        /// Rounds taken.
        rounds: u32,
        /// Size of the last step, in the norm of energy, relative to the scene.
        change: f64,
    },
    /// The search itself failed.
    #[error("beam `{beam}`: no static equilibrium found: {source}")]
    Search {
        /// The beam, or the first of several.
        beam: String,
        /// Why.
        source: EquilibriumError,
    },
    /// A corner is not over the surface that it should stand on.
    #[error("block `{block}`: the corner {corner} at x = {x} m is not over what the block stands on")]
    OffSurface {
        /// The block.
        block: String,
        /// The corner.
        corner: String,
        /// Where it is, m.
        x: f64,
    },
}

/// How a block leaves its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Departure {
    /// Its feet slide.
    Slides,
    /// It turns about a foot.
    Tips,
    /// It is pulled off.
    LiftsOff,
    /// Held at its tilt, it comes to stand on its other foot.
    ChangesFoot,
}

impl std::fmt::Display for Departure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Slides => "slides: friction can't hold it where it was put",
            Self::Tips => {
                "tips: its weight and the forces on it don't pass between its feet, or the beam gives way under them"
            }
            Self::LiftsOff => "lifts off: the forces on it are upwards",
            Self::ChangesFoot => "comes to stand on its other foot: the slope under it is more than its tilt",
        })
    }
}

/// A foot under a block: its corner, and where it stands.
#[derive(Clone, Copy, Debug)]
struct Foot {
    corner: usize,
    x: f64,
}

/// The feet that a block stands on, by its tilt: the corner that it is turned about, or both.
fn feet(block: &BlockScene, at: f64, tilt: f64) -> ([Foot; 2], usize) {
    let half = 0.5 * block.width;
    let (left, right) = (Foot { corner: 0, x: at - half }, Foot { corner: 1, x: at + half });
    if tilt > 0.0 {
        ([left, left], 1)
    } else if tilt < 0.0 {
        ([right, right], 1)
    } else {
        ([left, right], 2)
    }
}

/// Where and how hard (m, N) a block presses on what it stands on, its weight shared evenly between
/// its feet; `None` for a block that stands on something else or nothing.
pub(crate) fn weight_of(block: &BlockScene, on: Support, gravity: [f64; 2]) -> Option<Vec<(f64, f64)>> {
    let Placement::On { support, at, tilt, .. } = block.placement else { return None };
    let (feet, count) = feet(block, at, tilt);
    let force = weight(block, gravity) / count as f64;
    (support == on).then(|| feet[..count].iter().map(|foot| (foot.x, force)).collect())
}

/// Contact can't pull: gravity that points up leaves the beam alone.
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

/// The configurations (X, Y, φ) of all blocks at the start: on beams with these deflections, on
/// ground whose line is given, on each other. Where supports start, a beam and what stands on it
/// are placed as if they stood still.
pub(crate) fn starting_poses(
    scene: &Scene,
    beams: &[BeamModel],
    deflections: &[Vec<f64>],
    ground: [f64; 3],
) -> Result<Vec<Vector3<f64>>, BuildError> {
    let mut poses: Vec<Option<Vector3<f64>>> = vec![None; scene.blocks.len()];
    let mut pile = Vec::new();
    for block in 0..scene.blocks.len() {
        // What is below comes first; the resolver refuses circles.
        let mut lower = Some(block).filter(|&block| poses[block].is_none());
        while let Some(block) = lower {
            pile.push(block);
            lower = below(scene, block).filter(|&below| poses[below].is_none() && pile.len() <= scene.blocks.len());
        }
        while let Some(number) = pile.pop() {
            let block = &scene.blocks[number];
            let pose = match block.placement {
                Placement::On { support: Support::Beam(k), .. } => {
                    let still = beams[k].still(&scene.beams[k])?.boxed();
                    block_pose(scene, block, &Standing::Surface(still.as_ref(), &deflections[k]))?
                }
                Placement::On { support: Support::Block(below), at, tilt, stacked, .. } => {
                    let carrier = &scene.blocks[below];
                    let top = Top::of(carrier, &poses[below].unwrap_or_default());
                    let at = if stacked { top.line[0] + at * top.line[2].cos() } else { at };
                    if !top.is_under(block, at) {
                        return Err(off_surface(block, &Foot { corner: 0, x: at - 0.5 * block.width }).into());
                    }
                    pose_on_line(block, at, tilt, &top.line)
                }
                _ => block_pose(scene, block, &Standing::Line(ground))?,
            };
            poses[number] = Some(pose);
        }
    }
    Ok(poses.into_iter().map(Option::unwrap_or_default).collect())
}

/// The block that a block stands on.
pub(crate) fn below(scene: &Scene, block: usize) -> Option<usize> {
    match scene.blocks[block].placement {
        Placement::On { support: Support::Block(below), .. } => Some(below),
        _ => None,
    }
}

/// The side of a block that is on top.
struct Top {
    /// Its middle, and its slope, rad.
    line: [f64; 3],
    /// From where to where it reaches along x, m.
    x: [f64; 2],
}

impl Top {
    fn of(block: &BlockScene, pose: &Vector3<f64>) -> Self {
        // Quarters of a turn by which the side that was on top has left it.
        let quarters = (pose.z / FRAC_PI_2).round();
        let slope = pose.z - quarters * FRAC_PI_2;
        let sides =
            if quarters.rem_euclid(2.0) == 0.0 { [block.width, block.height] } else { [block.height, block.width] };
        let upright = Pose::new(&Vector3::new(pose.x, pose.y, slope));
        let end = |half: f64| upright.point(&Vector2::new(half * sides[0], 0.5 * sides[1]));
        let [left, middle, right] = [end(-0.5), end(0.0), end(0.5)];
        Self { line: [middle.x, middle.y, slope], x: [left.x, right.x] }
    }

    /// Whether it is under some of the base of a block whose middle is at `at` (m) before it is
    /// tilted.
    fn is_under(&self, block: &BlockScene, at: f64) -> bool {
        let half = 0.5 * block.width * self.line[2].cos();
        at + half > self.x[0] && at - half < self.x[1]
    }
}

/// What a block can stand on.
pub(crate) enum Standing<'a> {
    /// A surface at its coordinates.
    Surface(&'a dyn Subsystem<2>, &'a [f64]),
    /// A straight line through a point x, y with a slope (rad): the ground.
    Line([f64; 3]),
}

/// The configuration (X, Y, φ) of a block at the start: as placed by its mass centre, or on what it
/// stands on.
pub(crate) fn block_pose(scene: &Scene, block: &BlockScene, on: &Standing<'_>) -> Result<Vector3<f64>, PlacementError> {
    let (at, tilt, contact) = match block.placement {
        Placement::Free { position, angle } => return Ok(Vector3::new(position[0], position[1], angle)),
        Placement::On { at, tilt, contact, .. } => (at, tilt, contact),
    };
    let (surface, q) = match on {
        Standing::Surface(surface, q) => (*surface, *q),
        Standing::Line(line) => return Ok(pose_on_line(block, at, tilt, line)),
    };
    let kinematics = scene.contacts[contact].kinematics;
    let (feet, count) = feet(block, at, tilt);
    let height_at = |foot: &Foot| surface_height(block, surface, q, kinematics, foot);
    // Upright it stands on the higher of its feet.
    let mut height = height_at(&feet[0])?;
    if count == 2 {
        height = height.max(height_at(&feet[1])?);
        return Ok(Vector3::new(at, height + 0.5 * block.height, 0.0));
    }
    Ok(turned_about(block, &feet[0], Vector2::new(feet[0].x, height), tilt))
}

/// On a line the middle of the base is at x = `at`, the base lies along it, and the tilt is counted
/// from it.
fn pose_on_line(block: &BlockScene, at: f64, tilt: f64, &[x, y, slope]: &[f64; 3]) -> Vector3<f64> {
    let line = Pose::new(&Vector3::new(at, y + (at - x) * slope.tan(), slope));
    let (feet, count) = feet(block, 0.0, tilt);
    if count == 2 {
        let centre = line.point(&Vector2::new(0.0, 0.5 * block.height));
        return Vector3::new(centre.x, centre.y, slope);
    }
    turned_about(block, &feet[0], line.point(&Vector2::new(feet[0].x, 0.0)), slope + tilt)
}

/// A block with the corner of `foot` at `place`, turned by `angle`.
fn turned_about(block: &BlockScene, foot: &Foot, place: Vector2<f64>, angle: f64) -> Vector3<f64> {
    let corner = Vector2::new(if foot.corner == 0 { -0.5 } else { 0.5 } * block.width, -0.5 * block.height);
    let centre = place - Pose::new(&Vector3::new(0.0, 0.0, angle)).rotate(&corner);
    Vector3::new(centre.x, centre.y, angle)
}
