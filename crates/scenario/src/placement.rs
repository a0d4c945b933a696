//! Where everything starts: blocks on their surfaces, beams straight or in equilibrium under the blocks.

use crate::scene::{BlockScene, Placement, Scene, Support};
use nalgebra::{Vector2, Vector3};
use teeter_beam::StaticError;
use teeter_detect::{Kinematics, plane_frame};
use teeter_integrator::{BeamBody, Rows, Subsystem};
use teeter_rigid::{Pose, Rectangle};

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
    /// The equilibrium was not found.
    #[error("beam `{beam}`: no static equilibrium found after {rounds} rounds (it still moved by {moved} m)")]
    Unsettled {
        /// The beam.
        beam: String,
        /// Rounds taken.
        rounds: usize,
        /// Last change of a deflection under a foot, m.
        moved: f64,
    },
    /// A corner is not over the surface that it should stand on.
    #[error("block `{block}`: the corner {corner} at x = {x} m is not over what the block stands on")]
    OffSurface {
        /// The block.
        block: String,
        /// The corner.
        corner: &'static str,
        /// Where it is, m.
        x: f64,
    },
}

/// Rounds of the fixed point between deflections and the forces under the blocks. One suffices for tilted blocks with
/// contact on the axis; a top surface or flat blocks take some ten.
const ROUNDS: usize = 1000;

/// Elements times rounds: with fine meshes fewer rounds are taken, so that a beam without equilibrium is refused within a second.
const MOST_WORK: usize = 500_000;

/// A round that changes deflections under feet by less than this part of the span ends the fixed point.
const SETTLED: f64 = 1e-15;

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

/// Where and how hard (m, N) a block presses on what it stands on, its weight shared evenly between its feet; `None` for a block
/// that stands on something else or nothing.
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

/// The shape of a beam at the start: straight, or in equilibrium under the blocks that stand on it, held upright or tilted
/// as placed by couples that are let go at t = 0 (`docs/theory.md` §8).
pub(crate) fn beam_shape(scene: &Scene, number: usize, body: &BeamBody) -> Result<Vec<f64>, PlacementError> {
    let beam = &scene.beams[number];
    let mut q = vec![0.0; body.beam().dofs()];
    if !beam.static_start {
        return Ok(q);
    }
    let weights: Vec<Weight<'_>> =
        scene.blocks.iter().filter_map(|block| Weight::new(scene, block, Support::Beam(number))).collect();
    let mut shares: Vec<f64> = weights.iter().map(|w| if w.count == 2 { 0.5 } else { 1.0 }).collect();
    let mut moved = f64::INFINITY;
    let rounds = (MOST_WORK / beam.spec.elements.max(1)).min(ROUNDS);
    for _ in 0..rounds {
        let mut load = vec![0.0; q.len()];
        for (standing, &share) in weights.iter().zip(&shares) {
            standing.add_load(body, &q, share, &mut load)?;
        }
        body.beam()
            .solve_static(&mut load)
            .map_err(|source| PlacementError::Static { beam: beam.name.clone(), source })?;
        moved = 0.0;
        for (standing, share) in weights.iter().zip(&mut shares) {
            for foot in &standing.feet[..standing.count] {
                let change = standing.height(body, &load, foot)? - standing.height(body, &q, foot)?;
                moved = moved.max(change.abs());
            }
            standing.share_out(body, &load, share)?;
        }
        q = load;
        if moved <= SETTLED * beam.spec.span {
            return Ok(q);
        }
    }
    Err(PlacementError::Unsettled { beam: beam.name.clone(), rounds, moved })
}

/// A block that stands on a beam: its feet and its weight.
struct Weight<'a> {
    block: &'a BlockScene,
    kinematics: Kinematics,
    feet: [Foot; 2],
    count: usize,
    weight: f64,
}

impl<'a> Weight<'a> {
    fn new(scene: &Scene, block: &'a BlockScene, on: Support) -> Option<Self> {
        let Placement::On { support, at, tilt, contact } = block.placement else { return None };
        if support != on {
            return None;
        }
        let (feet, count) = feet(block, at, tilt);
        Some(Self {
            block,
            kinematics: scene.contacts[contact].kinematics,
            feet,
            count,
            weight: weight(block, scene.gravity),
        })
    }

    /// Height of the surface under a foot.
    fn height(&self, body: &BeamBody, q: &[f64], foot: &Foot) -> Result<f64, PlacementError> {
        surface_height(self.block, body, q, self.kinematics, foot)
    }

    /// Adds the generalised force of the weight, `share` of it on the first foot.
    fn add_load(&self, body: &BeamBody, q: &[f64], share: f64, load: &mut [f64]) -> Result<(), PlacementError> {
        for (foot, part) in self.feet[..self.count].iter().zip([share, 1.0 - share]) {
            let at = Vector2::new(foot.x, 0.0);
            let point = body.surface(0, q, self.kinematics, &at).ok_or_else(|| off_surface(self.block, foot))?;
            let frame = plane_frame(&point.normal);
            let (mut columns, mut values) = ([0; 4], [Vector2::zeros(); 4]);
            let mut rows = Rows::new(&mut columns, &mut values);
            let n = body.rows(0, q, &point.material, &frame, &mut rows);
            let force = frame * Vector2::new(0.0, -self.weight * part);
            for (&c, value) in columns[..n].iter().zip(&values) {
                load[c] += value.dot(&force);
            }
        }
        Ok(())
    }

    /// Moves weight from the lower foot of an upright block to the higher one, by what would level them were the beam a
    /// spring under each; where one foot carries all, the other is lifted.
    fn share_out(&self, body: &BeamBody, q: &[f64], share: &mut f64) -> Result<(), PlacementError> {
        if self.count < 2 || self.weight == 0.0 {
            return Ok(());
        }
        let difference = self.height(body, q, &self.feet[0])? - self.height(body, q, &self.feet[1])?;
        // The compliance of the difference: what a couple of unit forces, up on one foot and down on the other, does.
        let mut couple = vec![0.0; q.len()];
        for (foot, sign) in self.feet.iter().zip([1.0, -1.0]) {
            let x = body.surface(0, q, self.kinematics, &Vector2::new(foot.x, 0.0)).map_or(0.0, |p| p.material.x);
            body.beam().shape_clamped(x).add_load(sign, 0.0, &mut couple);
        }
        let direction = couple.clone();
        let source = |source| PlacementError::Static { beam: String::new(), source };
        body.beam().solve_static(&mut couple).map_err(source)?;
        let compliance: f64 = direction.iter().zip(&couple).map(|(a, b)| a * b).sum();
        if compliance > 0.0 {
            *share = (*share + difference / (compliance * self.weight)).clamp(0.0, 1.0);
        }
        Ok(())
    }
}

fn off_surface(block: &BlockScene, foot: &Foot) -> PlacementError {
    PlacementError::OffSurface { block: block.name.clone(), corner: Rectangle::CORNER_NAMES[foot.corner], x: foot.x }
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

/// What a block can stand on.
pub(crate) enum Standing<'a> {
    /// A surface at its coordinates.
    Surface(&'a dyn Subsystem<2>, &'a [f64]),
    /// A straight line through a point x, y with a slope (rad): the ground.
    Line([f64; 3]),
}

/// The configuration (X, Y, φ) of a block at the start: as placed by its mass centre, or on what it stands on.
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
    // Upright it stands on the higher of its feet (equal ones, where it is held so by a static start).
    let mut height = height_at(&feet[0])?;
    if count == 2 {
        height = height.max(height_at(&feet[1])?);
        return Ok(Vector3::new(at, height + 0.5 * block.height, 0.0));
    }
    Ok(turned_about(block, &feet[0], Vector2::new(feet[0].x, height), tilt))
}

/// On a line the middle of the base is at x = `at`, the base lies along it, and the tilt is counted from it.
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
