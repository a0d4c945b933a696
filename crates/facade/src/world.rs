//! What is there, who touches whom, and how it is to be stepped.

use crate::handles::WorldId;
use crate::simulation::{Simulation, SurfacePlace};
use crate::{At, BeamHandle, BlockHandle, SimError, SurfaceHandle};
use nalgebra::{Vector2, Vector3};
use std::sync::Arc;
use teeter_beam::Beam;
use teeter_contact::ContactSolver;
use teeter_detect::{Kinematics, PointDetector, PointPair};
use teeter_integrator::{
    BeamBody, BeamSurface, Block, BlockCoordinate, BlockLoad, Blocks, Ground, ModelBuilder, MoreauJean,
    MoreauJeanSettings, Motion, PairLaw, Scheme, Signal, SolverSettings, State, StateError, Subsystem, Workspace,
};
use teeter_rigid::{MassProperties, Rectangle};
use teeter_solvers::Auto;

struct BlockEntry {
    block: Block,
    corners: [Vector2<f64>; 4],
    q: Vector3<f64>,
    v: Vector3<f64>,
}

struct SurfaceEntry {
    system: Box<dyn Subsystem<2>>,
    q: Vec<f64>,
    v: Vec<f64>,
    beam: Option<Arc<Beam>>,
}

/// What is to move: blocks, beams, the ground, and who touches whom by which law.
///
/// [`simulate`](Self::simulate) checks it all and makes a [`Simulation`] of it. In the model, the blocks come first, in the order of adding, as one
/// subsystem; then the surfaces, in the order of adding.
///
/// ```
/// use teeter_sim::prelude::*;
///
/// let mut world = World::new(Vector2::new(0.0, -9.81));
/// let ground = world.ground(Ground::flat(0.0));
/// let shape = Rectangle::new(0.1, 0.05)?;
/// let mass = MassProperties::rectangle(&shape, 0.1, 2700.0)?;
/// let block = world.block(&shape, mass, At::standing(0.0, 0.005));
/// world.contact(block, ground, PairLaw::new(0.5, 0.0));
/// let mut run = world.simulate(1e-3)?;
/// run.steps(100)?;
/// assert!(run.velocity(block)?.norm() < 1e-12, "at rest");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct World {
    id: WorldId,
    gravity: Vector2<f64>,
    blocks: Vec<BlockEntry>,
    surfaces: Vec<SurfaceEntry>,
    pairs: Vec<(BlockHandle, SurfaceHandle, PairLaw, Kinematics)>,
    loads: Vec<(BlockHandle, BlockLoad)>,
    motions: Vec<(BlockHandle, BlockCoordinate, Motion)>,
    scheme: Option<Box<dyn Scheme<2>>>,
    solver: Box<dyn ContactSolver<2>>,
    settings: SolverSettings,
}

impl std::fmt::Debug for World {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("World")
            .field("gravity", &self.gravity)
            .field("blocks", &self.blocks.len())
            .field("surfaces", &self.surfaces.len())
            .field("pairs", &self.pairs.len())
            .finish_non_exhaustive()
    }
}

impl World {
    /// An empty world under gravity, m/s². It is stepped by [`MoreauJean`] with its default settings, its contacts are solved by [`Auto`].
    #[must_use]
    pub fn new(gravity: Vector2<f64>) -> Self {
        Self {
            id: WorldId::new(),
            gravity,
            blocks: Vec::new(),
            surfaces: Vec::new(),
            pairs: Vec::new(),
            loads: Vec::new(),
            motions: Vec::new(),
            scheme: None,
            solver: Box::new(Auto::new()),
            settings: SolverSettings::default(),
        }
    }

    /// Adds a rectangular block.
    pub fn block(&mut self, shape: &Rectangle, mass: MassProperties, at: At) -> BlockHandle {
        self.blocks.push(BlockEntry {
            block: Block::new(mass, shape),
            corners: shape.corners(),
            q: at.coordinates(shape),
            v: at.velocity(),
        });
        BlockHandle { world: self.id, number: self.blocks.len() - 1 }
    }

    /// Adds a beam with its left end at `position` (m), straight and at rest, touched on its axis. Gravity doesn't act on it, so its deflections
    /// count from the shape under its own weight. For weight, loads, moving supports or the top fibre: [`World::beam_body`].
    pub fn beam(&mut self, beam: impl Into<Arc<Beam>>, position: Vector2<f64>) -> BeamHandle {
        self.beam_body(BeamBody::new(beam.into(), position, BeamSurface::Axis))
    }

    /// Adds a beam as the integrator has it, straight and at rest.
    pub fn beam_body(&mut self, body: BeamBody) -> BeamHandle {
        let beam = Arc::clone(body.beam());
        let mut q = vec![0.0; beam.dofs()];
        q.extend(body.displacements(0.0));
        let v = vec![0.0; q.len()];
        BeamHandle(self.surface(SurfaceEntry { system: Box::new(body), q, v, beam: Some(beam) }))
    }

    /// Adds ground.
    pub fn ground(&mut self, ground: Ground) -> SurfaceHandle {
        let q = ground.coordinates(0.0);
        let v = vec![0.0; q.len()];
        self.surface(SurfaceEntry { system: Box::new(ground), q, v, beam: None })
    }

    /// Adds a subsystem of any kind, such as a [`ModalBeam`](teeter_integrator::ModalBeam) or one of your own, with the coordinates and velocities that
    /// it starts from. The handle is of the surface of its first body; where that has none, [`simulate`](Self::simulate) refuses contacts with it.
    pub fn subsystem(&mut self, system: impl Subsystem<2> + 'static, q: &[f64], v: &[f64]) -> SurfaceHandle {
        self.surface(SurfaceEntry { system: Box::new(system), q: q.to_vec(), v: v.to_vec(), beam: None })
    }

    fn surface(&mut self, entry: SurfaceEntry) -> SurfaceHandle {
        self.surfaces.push(entry);
        SurfaceHandle { world: self.id, number: self.surfaces.len() - 1 }
    }

    /// Lets the corners of a block touch a surface, whose deformed shape counts. Returns the pair's number: that of
    /// [`ContactId::pair`](teeter_detect::ContactId::pair) in reports.
    pub fn contact(&mut self, block: BlockHandle, surface: impl Into<SurfaceHandle>, law: PairLaw) -> u32 {
        self.contact_by(block, surface, law, Kinematics::Deformed)
    }

    /// As [`World::contact`], with the surface's deformation entering as said.
    pub fn contact_by(
        &mut self,
        block: BlockHandle,
        surface: impl Into<SurfaceHandle>,
        law: PairLaw,
        kinematics: Kinematics,
    ) -> u32 {
        self.pairs.push((block, surface.into(), law, kinematics));
        (self.pairs.len() - 1) as u32
    }

    /// Loads a block with a force (N) through its mass centre, in world axes, and a couple (N·m, counter-clockwise positive), both times a signal.
    pub fn load(&mut self, block: BlockHandle, force: Vector2<f64>, couple: f64, signal: Arc<dyn Signal>) {
        self.loads.push((block, BlockLoad { block: block.number, force, couple, signal }));
    }

    /// Prescribes the motion of one coordinate of a block; its others stay free.
    pub fn drive(&mut self, block: BlockHandle, coordinate: BlockCoordinate, motion: Motion) {
        self.motions.push((block, coordinate, motion));
    }

    /// Has another scheme take the steps.
    pub fn use_scheme(&mut self, scheme: Box<dyn Scheme<2>>) {
        self.scheme = Some(scheme);
    }

    /// Has another solver solve the contact problems, up to these tolerances.
    pub fn use_solver(&mut self, solver: Box<dyn ContactSolver<2>>, settings: SolverSettings) {
        self.solver = solver;
        self.settings = settings;
    }

    /// Checks the world and makes it ready for steps of size `dt` (s) from t = 0.
    ///
    /// # Errors
    /// For a handle of another world, a law or load out of its range, contact with what has no surface, a start that is not finite or not as long as
    /// the subsystem needs, a step size that is not positive, and matrices that can't be factorised.
    pub fn simulate(self, dt: f64) -> Result<Simulation, SimError> {
        let mut parts = ModelBuilder::new();
        let blocks = parts.add(self.all_blocks()?);
        let (mut q, mut v) = (Vec::new(), Vec::new());
        for block in &self.blocks {
            q.extend_from_slice(block.q.as_slice());
            v.extend_from_slice(block.v.as_slice());
        }
        let mut surfaces = Vec::with_capacity(self.surfaces.len());
        for entry in self.surfaces {
            let place = parts.add_boxed(entry.system);
            check_length("the coordinates of a subsystem", entry.q.len(), place.q.len())?;
            check_length("the velocities of a subsystem", entry.v.len(), place.v.len())?;
            q.extend(entry.q);
            v.extend(entry.v);
            surfaces.push(SurfacePlace { place, beam: entry.beam });
        }
        let mut pairs = Vec::with_capacity(self.pairs.len());
        for (pair, (block, surface, law, kinematics)) in self.pairs.into_iter().enumerate() {
            let number = block.of(self.id)?;
            pairs.push(PointPair {
                pair: pair as u32,
                law: parts.law(law),
                points: self.blocks[number].corners.to_vec(),
                body: blocks.nth_body(number as u32),
                surface: surfaces[surface.of(self.id)?].place.body(),
                kinematics,
            });
        }
        let model = parts.build(Box::new(PointDetector::new(pairs)))?;
        let state = State::new(&model, &q, &v, dt)?;
        let work = Workspace::new(&model, self.solver, self.settings);
        let scheme = match self.scheme {
            Some(scheme) => scheme,
            None => Box::new(MoreauJean::new(MoreauJeanSettings::default())?),
        };
        Simulation::start(self.id, model, state, work, scheme, blocks, surfaces)
    }

    fn all_blocks(&self) -> Result<Blocks, SimError> {
        let mut all = Blocks::new(self.blocks.iter().map(|entry| entry.block).collect(), self.gravity);
        for (block, load) in &self.loads {
            block.of(self.id)?;
            all = all.with_load(load.clone())?;
        }
        for (block, coordinate, motion) in &self.motions {
            all = all.with_motion(block.of(self.id)?, *coordinate, motion.clone())?;
        }
        Ok(all)
    }
}

fn check_length(what: &'static str, found: usize, expected: usize) -> Result<(), StateError> {
    if found == expected { Ok(()) } else { Err(StateError::Length { what, found, expected }) }
}
