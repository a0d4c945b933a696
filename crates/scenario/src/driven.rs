//! The bodies of a scene with their loads and prescribed motion.

use crate::scene::{BeamScene, ForceScene, GroundScene, LoadKind, Scene};
use crate::simulation::BuildError;
use nalgebra::Vector2;
use std::sync::{Arc, OnceLock};
use teeter_beam::{Beam, BeamError, Load, ModalBasis, SpanLoad, StaticError};
use teeter_integrator::{
    BeamBody, BeamSurface, Block, BlockCoordinate, BlockLoad, Blocks, Ground, ModalBeam, ModelError, MovingForce,
    SharedFactors, Signal, SignalLoad, SpanLoads, Subsystem,
};

/// The blocks under their weight and forces, with their prescribed motion.
pub(crate) fn blocks(scene: &Scene, blocks: Vec<Block>) -> Result<Blocks, ModelError> {
    let mut system = Blocks::new(blocks, Vector2::from(scene.gravity));
    for force in &scene.forces {
        system = system.with_load(block_load(force, force.block))?;
    }
    for (number, block) in scene.blocks.iter().enumerate() {
        let coordinates = [BlockCoordinate::X, BlockCoordinate::Y, BlockCoordinate::Turn];
        for (coordinate, axis) in coordinates.into_iter().zip(&block.motion.0) {
            if let Some(axis) = axis {
                system = system.with_motion(number, coordinate, axis.motion())?;
            }
        }
    }
    Ok(system)
}

/// A force of the scene, on the block with this number.
pub(crate) fn block_load(force: &ForceScene, block: usize) -> BlockLoad {
    BlockLoad { block, force: Vector2::from(force.force), couple: force.couple, signal: force.history.signal() }
}

/// A beam of the scene, from which subsystems are made.
pub(crate) struct BeamModel {
    pub(crate) beam: Arc<Beam>,
    /// The modal basis in which it moves, if it doesn't move in the coordinates of all nodes.
    pub(crate) basis: Option<Arc<ModalBasis>>,
    /// Initial displacements x and y of its supports; empty if they don't move.
    pub(crate) displaced: Vec<f64>,
    /// The same beam as other scenes have it, with what was found for them.
    shared: Option<Arc<SharedBeam>>,
}

/// What depends on nothing of a beam but its specification and its reduction.
#[derive(Debug)]
pub(crate) struct SharedBeam {
    basis: Option<Arc<ModalBasis>>,
    /// Of the beam, with it.
    pub(crate) factors: Arc<SharedFactors>,
    /// Whether its supports hold it, once that was asked for.
    held: OnceLock<Result<(), StaticError>>,
}

impl SharedBeam {
    pub(crate) fn new(of: &BeamScene) -> Result<Self, BuildError> {
        let BeamModel { beam, basis, .. } = BeamModel::new(of)?;
        Ok(Self { basis, factors: Arc::new(SharedFactors::new(beam)), held: OnceLock::new() })
    }

    /// How many numbers it holds, about.
    pub(crate) fn size(&self) -> usize {
        let dofs = self.factors.beam().dofs();
        // Matrices and factors of some diagonals each, and the shapes.
        dofs * (200 + self.basis.as_ref().map_or(0, |basis| basis.len()))
    }
}

impl BeamModel {
    pub(crate) fn new(of: &BeamScene) -> Result<Self, BuildError> {
        let beam = Beam::new(of.spec.clone()).map_err(|error| BuildError::Beam(of.name.clone(), error))?;
        let basis = of.reduction.map(|reduction| reduction.basis(&beam)).transpose();
        let basis = basis.map_err(|error| BuildError::Modes(of.name.clone(), error))?.map(Arc::new);
        Ok(Self { beam: Arc::new(beam), basis, displaced: displaced(of), shared: None })
    }

    pub(crate) fn of_shared(shared: Arc<SharedBeam>, of: &BeamScene) -> Self {
        let (beam, basis) = (Arc::clone(shared.factors.beam()), shared.basis.clone());
        Self { beam, basis, displaced: displaced(of), shared: Some(shared) }
    }

    /// Whether its supports hold it: the error of a static solve without loads.
    pub(crate) fn check_held(&self) -> Result<(), StaticError> {
        let solve = || self.beam.solve_static(&mut vec![0.0; self.beam.dofs()]);
        match &self.shared {
            Some(shared) => shared.held.get_or_init(solve).clone(),
            None => solve(),
        }
    }

    /// Its coordinates for a shape given by its dofs, or for the straight shape.
    pub(crate) fn coordinates(&self, shape: &[f64]) -> Vec<f64> {
        let given = shape.len() == self.beam.dofs();
        match &self.basis {
            Some(basis) if given => basis.coordinates(&self.beam, shape),
            Some(basis) => vec![0.0; basis.len()],
            None if given => shape.to_vec(),
            None => vec![0.0; self.beam.dofs()],
        }
    }

    /// Without loads, its supports at rest at their initial displacement.
    pub(crate) fn still(&self, of: &BeamScene) -> Result<BeamSystem, BuildError> {
        let mut position = Vector2::from(of.position);
        if let [x, y] = *self.displaced {
            position += Vector2::new(x, y);
        }
        self.at(of, position)
    }

    /// Without loads, its supports at rest with the left end here.
    fn at(&self, of: &BeamScene, position: Vector2<f64>) -> Result<BeamSystem, BuildError> {
        let surface = if of.top { BeamSurface::Top { offset: 0.5 * of.thickness } } else { BeamSurface::Axis };
        let beam = Arc::clone(&self.beam);
        Ok(match &self.basis {
            None => {
                let body = BeamBody::new(beam, position, surface);
                BeamSystem::Full(match &self.shared {
                    Some(shared) => body.with_factors(Arc::clone(&shared.factors)),
                    None => body,
                })
            }
            Some(basis) => {
                let body = ModalBeam::new(beam, ModalBasis::clone(basis), position, surface);
                BeamSystem::Modes(body.map_err(|error| BuildError::Modes(of.name.clone(), error))?)
            }
        })
    }

    /// The same under the loads of the scene, including its own weight if enabled.
    pub(crate) fn loaded(&self, scene: &Scene, number: usize) -> Result<BeamSystem, BuildError> {
        self.under_loads(scene, number, self.still(&scene.beams[number])?)
    }

    fn under_loads(&self, scene: &Scene, number: usize, body: BeamSystem) -> Result<BeamSystem, BuildError> {
        let name = &scene.beams[number].name;
        loaded(scene, number, &self.beam, body).map_err(|error| BuildError::Beam(name.clone(), error))
    }

    /// Under its loads, with supports that may move.
    pub(crate) fn body(&self, scene: &Scene, number: usize) -> Result<BeamSystem, BuildError> {
        let of = &scene.beams[number];
        // Supports that move have their displacement as coordinates.
        let undisplaced = self.at(of, Vector2::from(of.position))?;
        let body = match self.under_loads(scene, number, undisplaced)? {
            BeamSystem::Full(body) => BeamSystem::Full(body.with_backend(of.backend)),
            modes => modes,
        };
        if !of.motion.is_given() {
            return Ok(body);
        }
        let [x, y, _] = of.motion.motions();
        Ok(match body {
            BeamSystem::Full(body) => BeamSystem::Full(body.with_motion([x, y])),
            BeamSystem::Modes(body) => BeamSystem::Modes(body.with_motion([x, y])),
        })
    }
}

/// A beam as a subsystem: in the coordinates of all its nodes, or in modes.
#[allow(clippy::large_enum_variant)] // one a beam, boxed as soon as it is made
pub(crate) enum BeamSystem {
    Full(BeamBody),
    Modes(ModalBeam),
}

impl BeamSystem {
    pub(crate) fn boxed(self) -> Box<dyn Subsystem<2>> {
        match self {
            Self::Full(body) => Box::new(body),
            Self::Modes(body) => Box::new(body),
        }
    }

    fn with_weight(self, gravity: Vector2<f64>) -> Self {
        match self {
            Self::Full(body) => Self::Full(body.with_weight(gravity)),
            Self::Modes(body) => Self::Modes(body.with_weight(gravity)),
        }
    }

    fn with_load(self, load: Box<dyn Load>) -> Self {
        match self {
            Self::Full(body) => Self::Full(body.with_load(load)),
            Self::Modes(body) => Self::Modes(body.with_load(load)),
        }
    }

    fn with_signal_load(self, load: SignalLoad) -> Self {
        match self {
            Self::Full(body) => Self::Full(body.with_load(Box::new(load))),
            Self::Modes(body) => Self::Modes(body.with_signal_load(load)),
        }
    }
}

/// Initial displacements x and y of the supports of a beam; empty if they don't move.
fn displaced(of: &BeamScene) -> Vec<f64> {
    if of.motion.is_given() { of.start_displacement().to_vec() } else { Vec::new() }
}

/// A beam with the loads of the scene, including its own weight if enabled.
fn loaded(scene: &Scene, number: usize, beam: &Beam, mut body: BeamSystem) -> Result<BeamSystem, BeamError> {
    if scene.beams[number].self_weight {
        body = body.with_weight(Vector2::from(scene.gravity));
    }
    for load in scene.loads.iter().filter(|load| load.beam == number) {
        let mut pattern = vec![0.0; beam.dofs()];
        match load.kind {
            LoadKind::Point { at, force, couple } => {
                beam.add_point_load(at, force, &mut pattern)?;
                beam.add_point_couple(at, couple, &mut pattern)?;
            }
            LoadKind::Distributed { load, from, to } => beam.add_partial_load([from, to], load, &mut pattern)?,
            LoadKind::Moving { force, at, speed } => {
                let moving = MovingForce { force, start: at, speed, signal: load.history.signal() };
                body = body.with_load(Box::new(moving));
                continue;
            }
        }
        body = body.with_signal_load(SignalLoad::new(pattern, load.history.signal()));
    }
    Ok(body)
}

/// The loads of the scene on a beam with their positions: those of [`loaded`].
#[derive(Debug)]
pub(crate) struct PlacedLoads {
    /// Acceleration of gravity along y, if the beam has weight.
    weight: Option<f64>,
    standing: Vec<(SpanLoad, Arc<dyn Signal>)>,
    moving: Vec<MovingForce>,
    beam: Arc<Beam>,
}

/// The loads of the scene on a beam with their positions; `None` if there are none.
pub(crate) fn placed_loads(scene: &Scene, number: usize, beam: &Arc<Beam>) -> Option<PlacedLoads> {
    let weight = scene.beams[number].self_weight.then(|| scene.gravity[1]);
    let mut placed = PlacedLoads { weight, standing: Vec::new(), moving: Vec::new(), beam: Arc::clone(beam) };
    for load in scene.loads.iter().filter(|load| load.beam == number) {
        let signal = load.history.signal();
        match load.kind {
            LoadKind::Point { at: x, force, couple } => {
                placed.standing.push((SpanLoad::Point { x, force, couple }, signal));
            }
            LoadKind::Distributed { load, from, to } => {
                placed.standing.push((SpanLoad::Uniform { from, to, load }, signal));
            }
            LoadKind::Moving { force, at: start, speed } => {
                placed.moving.push(MovingForce { force, start, speed, signal });
            }
        }
    }
    (weight.is_some() || !placed.standing.is_empty() || !placed.moving.is_empty()).then_some(placed)
}

impl PlacedLoads {
    /// Adds weight, and loads that don't move.
    fn add_standing(&self, factor: impl Fn(&dyn Signal) -> f64, loads: &mut Vec<SpanLoad>) {
        loads.extend(self.weight.map(|gravity| SpanLoad::Weight { gravity }));
        loads.extend(self.standing.iter().map(|(load, signal)| {
            let factor = factor(signal.as_ref());
            match *load {
                SpanLoad::Point { x, force, couple } => {
                    SpanLoad::Point { x, force: factor * force, couple: factor * couple }
                }
                SpanLoad::Uniform { from, to, load } => SpanLoad::Uniform { from, to, load: factor * load },
                other => other,
            }
        }));
    }
}

impl SpanLoads for PlacedLoads {
    fn add(&self, t: f64, loads: &mut Vec<SpanLoad>) {
        self.add_standing(|signal| signal.value(t), loads);
        loads.extend(self.moving.iter().filter_map(|load| load.at(&self.beam, t)));
    }

    fn add_mean(&self, [from, to]: [f64; 2], loads: &mut Vec<SpanLoad>) {
        self.add_standing(|signal| signal.mean(from, to), loads);
        for load in &self.moving {
            let places = load.mean(&self.beam, [from, to]);
            loads.extend(places.map(|(x, force)| SpanLoad::Point { x, force, couple: 0.0 }));
        }
    }
}

/// The ground: flat and fixed, inclined, or moving.
pub(crate) fn ground(of: &GroundScene) -> Ground {
    if of.motion.is_given() {
        Ground::moving(of.incline, of.motion.motions())
    } else if of.incline != 0.0 {
        Ground::inclined(of.incline)
    } else {
        Ground::flat(0.0)
    }
}
