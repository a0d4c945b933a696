//! `start = "static"`: beams in equilibrium under what stands on them (`docs/theory.md` §8).
//!
//! The equilibrium is computed in a separate model: the beams with this start, the blocks on them,
//! and the ground. Blocks are placed on the straight beam; then weight, and the loads and forces of
//! t = 0, act. A flat block follows the beam, held by friction if there is any. A tilted one is
//! held as placed by a couple that is released at t = 0: its angle and the position of its foot
//! stay. A beam in modes settles in its modes, so it is at rest in the model that runs.

use crate::driven::{self, BeamModel};
use crate::equilibrium_key::EquilibriumKey;
use crate::placement::{self, InstabilityMode, PlacementError, carried_by, starting_poses};
use crate::resolve::SharedParts;
use crate::scene::{ContactScene, Placement, Scene, SupportingBody};
use crate::simulation::{BlockBody, BuildError, Pairs, detector};
use nalgebra::{Vector2, Vector3};
use std::collections::BTreeSet;
use teeter_beam::{SpanLoad, StaticError};
use teeter_detect::{BodyId, PointPair, ShapePair, SidePair, SurfacePair};
use teeter_integrator::{
    BeamFace, BeamForces, BlockCoordinate, Blocks, Equilibrium, EquilibriumError, Mismatch, Model, ModelBuilder,
    Motion, PairLaw, PartPlace, SettlingLimits, SolverSettings, Workspace, settle,
};
use teeter_rigid::Pose;
use teeter_solvers::Auto;

/// The initial configuration, before and after settling.
pub(crate) struct InitialConfiguration<'a> {
    /// The bodies of the blocks, and their corners.
    pub(crate) blocks: &'a [BlockBody],
    /// X, Y, φ of each block.
    pub(crate) poses: Vec<Vector3<f64>>,
    /// The beams.
    pub(crate) beams: &'a [BeamModel],
    /// Their coordinates.
    pub(crate) deflections: Vec<Vec<f64>>,
    /// The coordinates of moving ground.
    pub(crate) ground: &'a [f64],
    /// The beams in equilibrium, with the contact forces on them; empty before settling.
    pub(crate) pressed: Vec<(usize, Vec<SpanLoad>)>,
}

/// A block that moves by this fraction of its width from its place has no equilibrium there.
const MOST_DISPLACEMENT: f64 = 0.1;

/// Friction under the foot of a held block, which doesn't slide. Its other corners have none.
const HELD_FRICTION: f64 = 1e3;

/// Residual of the contact problems, which limits the accuracy of the forces.
const TOLERANCE: f64 = 1e-13;

/// Iterations of a contact solve.
const ITERATIONS: u32 = 10_000;

/// Most times that held blocks are moved back: the top fibre of a rotating section carries them
/// along.
const MOST_RESETS: usize = 20;

/// Distance of a foot from its place, relative to its block's width, that counts as zero.
const FOOT_TOLERANCE: f64 = 1e-15;

impl<'a> InitialConfiguration<'a> {
    /// The configuration before settling: blocks on beams in their given shapes.
    ///
    /// # Errors
    /// If a corner is not above the surface that it should stand on, or a beam can't be evaluated.
    pub(crate) fn placed(
        scene: &Scene,
        blocks: &'a [BlockBody],
        beams: &'a [BeamModel],
        ground: &'a [f64],
    ) -> Result<Self, BuildError> {
        let incline = scene.ground.as_ref().map_or(0.0, |ground| ground.incline);
        let line = if let [x, y, slope] = *ground { [x, y, slope] } else { [0.0, 0.0, incline] };
        let deflections: Vec<Vec<f64>> =
            scene.beams.iter().zip(beams).map(|(of, model)| model.coordinates(&of.shape)).collect();
        let poses = starting_poses(scene, beams, &deflections, line)?;
        Ok(Self { blocks, poses, beams, deflections, ground, pressed: Vec::new() })
    }

    /// Coordinates and velocities of the whole model, which has this number of coordinates.
    pub(crate) fn coordinates(&self, scene: &Scene, dofs: usize) -> (Vec<f64>, Vec<f64>) {
        let (mut q, mut v) = (Vec::with_capacity(dofs), Vec::with_capacity(dofs));
        for (pose, block) in self.poses.iter().zip(&scene.blocks) {
            q.extend(pose.iter());
            v.extend([block.velocity[0], block.velocity[1], block.spin]);
        }
        for (deflection, model) in self.deflections.iter().zip(self.beams) {
            q.extend(deflection.iter().chain(&model.displaced));
        }
        q.extend(self.ground);
        v.resize(dofs, 0.0);
        (q, v)
    }

    /// Moves beams with a static start, and the blocks on them, to their equilibrium; `None` if
    /// there are no such beams.
    ///
    /// It is sought on corners alone first: most blocks rest on these, and humps that come and go
    /// under a base would keep the search from settling. Where a side is inside a beam then, or
    /// there is no such equilibrium, it is sought with sides.
    ///
    /// # Errors
    /// If there is no equilibrium, or it is not found.
    pub(crate) fn settle(
        &mut self,
        scene: &Scene,
        shared: Option<&SharedParts>,
    ) -> Result<Option<StaticStart>, BuildError> {
        let Some(shared) = shared.filter(|_| scene.beams.iter().any(|beam| beam.static_start)) else {
            return self.search(scene, shared);
        };
        let found = shared.settled(EquilibriumKey::of(scene, self), || {
            let start = self.search(scene, Some(shared))?;
            let (poses, deflections, pressed) = (self.poses.clone(), self.deflections.clone(), self.pressed.clone());
            Ok::<_, BuildError>(Settled { poses, deflections, pressed, start })
        })?;
        self.poses.clone_from(&found.poses);
        self.deflections.clone_from(&found.deflections);
        self.pressed.clone_from(&found.pressed);
        Ok(found.start.clone())
    }

    fn search(&mut self, scene: &Scene, shared: Option<&SharedParts>) -> Result<Option<StaticStart>, BuildError> {
        let placed = (self.poses.clone(), self.deflections.clone());
        let on_corners = self.settle_on(scene, Points::Corners, shared);
        let on_beams = scene.contacts.iter().any(|contact| {
            contact.sides && matches!(contact.surface, SupportingBody::Beam(k) if scene.beams[k].static_start)
        });
        match on_corners {
            Ok(found) if !on_beams || self.clears_sides(scene)? => Ok(found),
            Err(error) if !on_beams => Err(error),
            found => {
                (self.poses, self.deflections) = placed;
                self.pressed.clear();
                self.settle_on(scene, Points::All, shared).map_err(|error| found.err().unwrap_or(error))
            }
        }
    }

    /// Whether no side of a block is inside a beam.
    fn clears_sides(&self, scene: &Scene) -> Result<bool, BuildError> {
        let bodies = StaticModel::of(scene);
        let (model, pairs) = bodies.model(scene, self, Points::All)?;
        let mut candidates = Vec::new();
        model.candidates(&bodies.coordinates(self), 0.0, &mut candidates)?;
        Ok(candidates.iter().all(|candidate| {
            let pair = &pairs[candidate.id.pair() as usize];
            !pair.is_of_sides || -candidate.gap <= INSIDE * scene.blocks[scene.contacts[pair.contact].block].radius()
        }))
    }

    /// As [`settle`](Self::settle), with these points of blocks on beams.
    fn settle_on(
        &mut self,
        scene: &Scene,
        points: Points,
        shared: Option<&SharedParts>,
    ) -> Result<Option<StaticStart>, BuildError> {
        let beams: Vec<usize> = (0..scene.beams.len()).filter(|&k| scene.beams[k].static_start).collect();
        let Some(&first) = beams.first() else { return Ok(None) };
        for &k in &beams {
            // It is still straight, so an error here concerns its supports.
            let refused = |source| PlacementError::Static { beam: scene.beams[k].name.clone(), source };
            match self.beams[k].check_held() {
                // Blocks under it may hold what its supports don't.
                Err(StaticError::RigidMotion { .. }) if !props(scene, &[k]).is_empty() => {}
                found => found.map_err(refused)?,
            }
        }
        let bodies = StaticModel::of(scene);
        let (model, pairs) = bodies.model(scene, self, points)?;
        let reach: Vec<f64> = pairs
            .iter()
            .map(|pair| MOST_DISPLACEMENT * scene.blocks[scene.contacts[pair.contact].block].width)
            .collect();
        let mut limits = SettlingLimits {
            reach: &reach,
            margin: reach.iter().copied().fold(0.0, f64::max),
            tau: SettlingLimits::FIRST_TAU,
        };
        let held: Vec<HeldFoot> = bodies.blocks.iter().filter_map(|&k| HeldFoot::of(scene, self, k)).collect();
        let settings = SolverSettings { tolerance: TOLERANCE, max_iterations: ITERATIONS };
        let mut summary = StaticStart::default();
        for _ in 0..MOST_RESETS {
            let solver = shared.and_then(|shared| shared.solver(Auto::<2>::NAME));
            let solver = solver.unwrap_or_else(|| Box::new(Auto::new()));
            let mut work = Workspace::new(&model, solver, settings);
            let found = settle(&model, 0.0, &bodies.coordinates(self), &limits, &mut work)
                .map_err(|error| refusal(scene, &scene.beams[first].name, &pairs, error))?;
            limits.tau = found.tau;
            bodies.take(self, &found.q);
            self.pressed = bodies.pressed(scene, &model, &found)?;
            summary.rounds += found.rounds;
            summary.change = found.change;
            summary.forces.clear();
            for (id, force) in &found.forces {
                let Some(pair) = pairs.get(id.pair() as usize) else { continue };
                // The detector of a run numbers features of blocks in the same way.
                let point = pair.corners.get(id.point() as usize).map_or(id.point(), |&corner| corner as u32);
                let force = [force[0], force[1]];
                summary.forces.push(ContactForce { contact: pair.contact, point, force });
            }
            if let Some(foot) = held.iter().find(|foot| foot.is_left(scene, &summary.forces)) {
                let (block, motion) = (scene.blocks[foot.block].name.clone(), InstabilityMode::ChangesFoot);
                return Err(PlacementError::NoEquilibrium { block, motion }.into());
            }
            let mut there = true;
            for foot in &held {
                there &= foot.put_back(self);
            }
            if there {
                break;
            }
        }
        Ok(Some(summary))
    }
}

/// A configuration in equilibrium.
#[derive(Debug)]
pub(crate) struct Settled {
    poses: Vec<Vector3<f64>>,
    deflections: Vec<Vec<f64>>,
    pressed: Vec<(usize, Vec<SpanLoad>)>,
    start: Option<StaticStart>,
}

impl Settled {
    /// How many numbers it holds.
    pub(crate) fn size(&self) -> usize {
        3 * self.poses.len() + self.deflections.iter().map(Vec::len).sum::<usize>()
    }
}

/// The result for a static start.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct StaticStart {
    /// The loaded contacts.
    pub forces: Vec<ContactForce>,
    /// Number of iterations.
    pub rounds: u32,
    /// Size of the last iteration's change, in the energy norm, relative to the scene.
    pub change: f64,
}

/// A contact force of a static start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactForce {
    /// The contact, by its number in the scene.
    pub contact: usize,
    /// The touching point of the pair, as in the identity of its contact: for a pair with a surface
    /// the corner of the block, as in
    /// [`Rectangle::CORNER_NAMES`](teeter_rigid::Rectangle::CORNER_NAMES) or for a polygon
    /// counter-clockwise.
    pub point: u32,
    /// The force on the block along the contact's normal and tangent, N.
    pub force: [f64; 2],
}

/// The corner on which a tilted block stands and is held.
fn foot_of(scene: &Scene, block: usize) -> Option<usize> {
    match scene.blocks[block].placement {
        Placement::On { tilt, .. } if tilt != 0.0 => Some(scene.blocks[block].feet()[usize::from(tilt < 0.0)]),
        _ => None,
    }
}

/// Whether a contact is one of a block that is held as placed: its own friction then plays no part.
pub(crate) fn is_held(scene: &Scene, contact: &ContactScene) -> bool {
    [Some(contact.block), contact.other_block()].into_iter().flatten().any(|block| foot_of(scene, block).is_some())
}

/// The blocks that prop these beams from below, and those that carry them.
fn props(scene: &Scene, beams: &[usize]) -> BTreeSet<usize> {
    let below = scene.contacts.iter().filter(|contact| {
        contact.face == BeamFace::Lower && matches!(contact.surface, SupportingBody::Beam(k) if beams.contains(&k))
    });
    let mut props = BTreeSet::new();
    for contact in below {
        let mut block = Some(contact.block);
        while let Some(number) = block.filter(|block| props.insert(*block)) {
            block = placement::below(scene, number);
        }
    }
    props
}

/// A pair of the equilibrium's model.
struct EquilibriumPair {
    /// The contact of the scene.
    contact: usize,
    /// Its points: corners of the block; empty for a pair of two blocks.
    corners: Vec<usize>,
    /// Whether it is of the sides of a block with a beam.
    is_of_sides: bool,
}

/// What of blocks touches beams in an equilibrium.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Points {
    Corners,
    All,
}

/// A side of a block is inside a beam if it is so by more than this part of the block's radius.
const INSIDE: f64 = 1e-12;

/// The foot of a held block, and its position.
struct HeldFoot {
    block: usize,
    corner: usize,
    /// The corner in the block.
    point: Vector2<f64>,
    x: f64,
    width: f64,
}

impl HeldFoot {
    fn of(scene: &Scene, start: &InitialConfiguration<'_>, block: usize) -> Option<Self> {
        let corner = foot_of(scene, block)?;
        let point = start.blocks[block].corners[corner];
        let x = Pose::new(&start.poses[block]).point(&point).x;
        Some(Self { block, corner, point, x, width: scene.blocks[block].width })
    }

    /// Whether only other corners of the block are loaded.
    fn is_left(&self, scene: &Scene, forces: &[ContactForce]) -> bool {
        let of_block = || {
            forces.iter().filter(|force| {
                let contact = &scene.contacts[force.contact];
                contact.block == self.block && contact.other_block().is_none()
            })
        };
        of_block().next().is_some() && of_block().all(|force| force.point != self.corner as u32)
    }

    /// Moves the block back so that its foot is in its place; returns whether it already was.
    fn put_back(&self, start: &mut InitialConfiguration<'_>) -> bool {
        let pose = &mut start.poses[self.block];
        let off = self.x - Pose::new(pose).point(&self.point).x;
        pose.x += off;
        off.abs() <= FOOT_TOLERANCE * (self.width + self.x.abs())
    }
}

/// The bodies of the equilibrium, by number in the scene.
struct StaticModel {
    blocks: Vec<usize>,
    beams: Vec<usize>,
}

impl StaticModel {
    /// The beams with a static start, what stands on them, and what props them.
    fn of(scene: &Scene) -> Self {
        let beams: Vec<usize> = (0..scene.beams.len()).filter(|&k| scene.beams[k].static_start).collect();
        let props = props(scene, &beams);
        let mut bodies = Self { blocks: Vec::new(), beams };
        let blocks = (0..scene.blocks.len()).filter(|k| bodies.carrier(scene, *k).is_some() || props.contains(k));
        bodies.blocks = blocks.collect();
        bodies
    }

    /// Which of its beams carries a block.
    fn carrier(&self, scene: &Scene, block: usize) -> Option<usize> {
        let placement = |block: usize| Some(&scene.blocks[block].placement);
        carried_by(scene.blocks.len(), block, placement).filter(|beam| self.beams.contains(beam))
    }

    /// The model, with its pairs.
    fn model(
        &self,
        scene: &Scene,
        start: &InitialConfiguration<'_>,
        on_beams: Points,
    ) -> Result<(Model<2>, Vec<EquilibriumPair>), BuildError> {
        let mut parts = ModelBuilder::new();
        let bodies = self.blocks.iter().map(|&k| start.blocks[k].body).collect();
        let mut blocks = Blocks::new(bodies, Vector2::from(scene.gravity));
        for (number, &k) in self.blocks.iter().enumerate() {
            for force in scene.forces.iter().filter(|force| force.block == k) {
                blocks = blocks.with_load(driven::block_load(force, number))?;
            }
            // Prescribed coordinates stay in place, except for the height of what rests on the beam:
            // that follows the beam, but what props it doesn't.
            let [x, y, angle] = scene.blocks[k].motion.0.each_ref().map(Option::is_some);
            for (coordinate, stays) in [
                (BlockCoordinate::X, x),
                (BlockCoordinate::Y, y && self.carrier(scene, k).is_none()),
                (BlockCoordinate::Turn, angle || foot_of(scene, k).is_some()),
            ] {
                if stays {
                    blocks = blocks.with_motion(number, coordinate, Motion::still())?;
                }
            }
        }
        let first = parts.add(blocks).body();
        let mut surfaces: Vec<(SupportingBody, PartPlace)> = Vec::new();
        for &k in &self.beams {
            surfaces.push((SupportingBody::Beam(k), parts.add_boxed(start.beams[k].loaded(scene, k)?.boxed())));
        }
        if let Some(ground) = &scene.ground {
            surfaces.push((SupportingBody::Ground, parts.add(driven::ground(ground))));
        }
        let (mut pairs, mut contacts) = (Pairs::default(), Vec::new());
        let part = |block: usize| self.blocks.iter().position(|&k| k == block);
        let body = |part: usize| BodyId(first.0 + part as u32);
        for (number, contact) in scene.contacts.iter().enumerate() {
            let block = part(contact.block);
            let friction = |held: f64| if is_held(scene, contact) { held } else { contact.law.friction };
            if let Some(other) = contact.other_block() {
                let (Some(block), Some(other_part)) = (block, part(other)) else { continue };
                let law = parts.law(PairLaw::new(friction(HELD_FRICTION), 0.0));
                let (pair, bodies) = (contacts.len() as u32, [block, other_part].map(body));
                pairs.shapes.push(ShapePair { pair, law, bodies });
                contacts.push(EquilibriumPair { contact: number, corners: Vec::new(), is_of_sides: false });
                continue;
            }
            let surface = surfaces.iter().find(|(support, _)| *support == contact.surface);
            let (Some(block), Some((_, place))) = (block, surface) else { continue };
            let (kinematics, surface) = (contact.kinematics, place.nth_body(contact.face.body()));
            if contact.sides && on_beams == Points::All {
                let law = parts.law(PairLaw::new(friction(0.0), 0.0));
                let (pair, surface) = (contacts.len() as u32, place.nth_body(contact.face.fibre()));
                pairs.sides.push(SidePair { pair, law, body: body(block), surface, kinematics });
                contacts.push(EquilibriumPair { contact: number, corners: Vec::new(), is_of_sides: true });
            }
            let (corners, is_round) = (&start.blocks[contact.block].corners, start.blocks[contact.block].is_round);
            if is_round {
                let law = parts.law(PairLaw::new(friction(HELD_FRICTION), 0.0));
                let pair = contacts.len() as u32;
                pairs.surfaces.push(SurfacePair { pair, law, body: body(block), surface, kinematics });
                let corners = (0..corners.len()).collect();
                contacts.push(EquilibriumPair { contact: number, corners, is_of_sides: false });
                continue;
            }
            let groups = match foot_of(scene, contact.block) {
                Some(foot) => {
                    vec![(HELD_FRICTION, vec![foot]), (0.0, (0..corners.len()).filter(|&k| k != foot).collect())]
                }
                None => {
                    let friction = |k: &usize| contact.law_at(&scene.blocks[contact.block], *k).friction;
                    let mut groups: Vec<(f64, Vec<usize>)> = Vec::new();
                    for k in 0..corners.len() {
                        match groups.iter_mut().find(|(of, _)| *of == friction(&k)) {
                            Some((_, numbers)) => numbers.push(k),
                            None => groups.push((friction(&k), vec![k])),
                        }
                    }
                    groups
                }
            };
            for (friction, numbers) in groups {
                pairs.points.push(PointPair {
                    pair: contacts.len() as u32,
                    law: parts.law(PairLaw::new(friction, 0.0)),
                    points: numbers.iter().map(|&k| corners[k]).collect(),
                    body: body(block),
                    surface,
                    kinematics,
                });
                contacts.push(EquilibriumPair { contact: number, corners: numbers, is_of_sides: false });
            }
        }
        let shapes =
            self.blocks.iter().enumerate().map(|(number, &k)| (body(number), start.blocks[k].shapes.as_slice()));
        Ok((parts.build(detector(pairs, None, shapes)?)?, contacts))
    }

    fn coordinates(&self, start: &InitialConfiguration<'_>) -> Vec<f64> {
        let poses = self.blocks.iter().flat_map(|&k| start.poses[k].data.0[0]);
        let beams = self.beams.iter().flat_map(|&k| start.deflections[k].iter().copied());
        poses.chain(beams).chain(start.ground.iter().copied()).collect()
    }

    fn take(&self, start: &mut InitialConfiguration<'_>, q: &[f64]) {
        let (poses, mut q) = q.split_at(3 * self.blocks.len());
        for (&k, pose) in self.blocks.iter().zip(poses.chunks_exact(3)) {
            start.poses[k] = Vector3::from_column_slice(pose);
        }
        for &k in &self.beams {
            let (own, rest) = q.split_at(start.deflections[k].len());
            start.deflections[k].copy_from_slice(own);
            q = rest;
        }
    }
}

impl StaticModel {
    /// The contact forces on each beam.
    fn pressed(
        &self,
        scene: &Scene,
        model: &Model<2>,
        found: &Equilibrium<2>,
    ) -> Result<Vec<(usize, Vec<SpanLoad>)>, Mismatch> {
        let (mut candidates, pressing) = (Vec::new(), found.forces.iter().map(|(id, _)| *id));
        model.detector().locate(&model.placed(&found.q)?, &pressing.collect::<Vec<_>>(), &mut candidates);
        let on = |body: BodyId, span: f64| {
            let loads = candidates.iter().flat_map(|candidate| {
                let force =
                    found.forces.binary_search_by_key(&candidate.id, |(id, _)| *id).ok().map(|at| found.forces[at].1);
                let sides = candidate.sides.iter().zip([1.0, -1.0]).filter(|(side, _)| side.body == body);
                sides.filter_map(move |(side, sign)| {
                    Some(BeamForces::surface_load(side, &candidate.frame, &(force? * sign), span))
                })
            });
            loads.collect()
        };
        // The model's bodies: the blocks, then those of the beams.
        let bodies = (self.blocks.len()..).step_by(BeamFace::BODIES).map(|body| BodyId(body as u32));
        let beams = self.beams.iter().zip(bodies);
        Ok(beams.map(|(&k, body)| (k, on(body, scene.beams[k].spec.span))).collect())
    }
}

/// The error, with the block that doesn't stay in place.
fn refusal(scene: &Scene, beam: &str, pairs: &[EquilibriumPair], error: EquilibriumError) -> PlacementError {
    let beam = beam.to_owned();
    match error {
        EquilibriumError::Leaves { contact, lifted, slid, .. } => {
            let pair = pairs.get(contact.pair() as usize).map(|pair| &scene.contacts[pair.contact]);
            let (block, friction) = pair.map_or((0, 0.0), |pair| (pair.block, pair.friction_of_feet()[1]));
            let of = &scene.blocks[block];
            let forces = scene.forces.iter().filter(|force| force.block == block);
            let pushed: f64 = forces.map(|force| force.force[1] * force.history.signal().value(0.0)).sum();
            let motion = if of.mass() * scene.gravity[1] + pushed >= 0.0 {
                InstabilityMode::LiftsOff
            } else if foot_of(scene, block).is_some() {
                // Its angle is held, and its foot doesn't slide.
                InstabilityMode::ChangesFoot
            } else if !(of.base() > 0.0) && friction > 0.0 {
                let is_round = of.corner_radius(of.feet()[0]) > 0.0;
                if is_round { InstabilityMode::Rolls } else { InstabilityMode::FallsOver }
            } else if lifted > LIFTED * slid {
                InstabilityMode::Tips
            } else {
                InstabilityMode::Slides
            };
            PlacementError::NoEquilibrium { block: of.name.clone(), motion }
        }
        EquilibriumError::Unsettled { rounds, change } => PlacementError::Unsettled { beam, rounds, change },
        source => PlacementError::Search { beam, source },
    }
}

/// A block that lifts a foot by more than this fraction of its slide counts as tipping.
const LIFTED: f64 = 0.3;
