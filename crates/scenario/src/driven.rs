//! The bodies of a scene with what drives them: loads, and prescribed motion.

use crate::scene::{BeamScene, ForceScene, GroundScene, LoadKind, Scene};
use nalgebra::Vector2;
use std::sync::Arc;
use teeter_beam::{Beam, BeamError, Load, SpanLoad};
use teeter_integrator::{BeamBody, BeamSurface, Block, BlockLoad, Blocks, Ground, Signal, SignalLoad, SpanLoads};

/// The blocks under their weight and forces, with what is prescribed of their motion.
pub(crate) fn blocks(scene: &Scene, blocks: Vec<Block>) -> Blocks {
    let mut system = Blocks::new(blocks, Vector2::from(scene.gravity));
    for force in &scene.forces {
        system = system.with_load(block_load(force, force.block));
    }
    for (number, block) in scene.blocks.iter().enumerate() {
        for (coordinate, axis) in block.motion.0.iter().enumerate() {
            if let Some(axis) = axis {
                system = system.with_motion(number, coordinate, axis.motion());
            }
        }
    }
    system
}

/// A force of the scene, on the block that has this number.
pub(crate) fn block_load(force: &ForceScene, block: usize) -> BlockLoad {
    BlockLoad { block, force: Vector2::from(force.force), couple: force.couple, signal: force.history.signal() }
}

/// A beam under its loads, on supports that may move.
pub(crate) fn beam(scene: &Scene, number: usize, beam: &Arc<Beam>) -> Result<BeamBody, BeamError> {
    let of = &scene.beams[number];
    let mut body = loaded(scene, number, still_beam(of, beam, &[]))?.with_backend(of.backend);
    if of.motion.is_given() {
        let [x, y, _] = of.motion.motions();
        body = body.with_motion([x, y]);
    }
    Ok(body)
}

/// A beam with the loads of the scene on it, its own weight among them where it has any.
pub(crate) fn loaded(scene: &Scene, number: usize, mut body: BeamBody) -> Result<BeamBody, BeamError> {
    if scene.beams[number].self_weight {
        body = body.with_weight(Vector2::from(scene.gravity));
    }
    for load in scene.loads.iter().filter(|load| load.beam == number) {
        let beam = body.beam();
        let mut pattern = vec![0.0; beam.dofs()];
        match load.kind {
            LoadKind::Point { at, force, couple } => {
                beam.add_point_load(at, force, &mut pattern)?;
                beam.add_point_couple(at, couple, &mut pattern)?;
            }
            LoadKind::Distributed { load, from, to } => beam.add_partial_load([from, to], load, &mut pattern)?,
            LoadKind::Moving { force, at, speed } => {
                let moving = Moving { force, at, speed, signal: load.history.signal() };
                body = body.with_load(Box::new(moving));
                continue;
            }
        }
        body = body.with_load(Box::new(SignalLoad::new(pattern, load.history.signal())));
    }
    Ok(body)
}

/// A force that moves along a beam, times a signal; none while it is off the beam.
struct Moving {
    force: f64,
    at: f64,
    speed: f64,
    signal: Arc<dyn Signal>,
}

impl Load for Moving {
    fn add(&self, beam: &Beam, t: f64, f: &mut [f64]) {
        if let Some(shape) = beam.shape_at(self.at + self.speed * t) {
            shape.add_load(self.force * self.signal.value(t), 0.0, f);
        }
    }
}

/// The loads of the scene on a beam, by their places: those of [`loaded`].
#[derive(Debug)]
pub(crate) struct PlacedLoads {
    /// Acceleration of gravity along y, where the beam has weight.
    weight: Option<f64>,
    loads: Vec<(LoadKind, Arc<dyn Signal>)>,
    span: f64,
}

/// The loads of the scene on a beam by their places; `None` where there are none.
pub(crate) fn placed_loads(scene: &Scene, number: usize) -> Option<PlacedLoads> {
    let of = &scene.beams[number];
    let loads = scene.loads.iter().filter(|load| load.beam == number);
    let loads: Vec<_> = loads.map(|load| (load.kind, load.history.signal())).collect();
    let weight = of.self_weight.then(|| scene.gravity[1]);
    (weight.is_some() || !loads.is_empty()).then_some(PlacedLoads { weight, loads, span: of.spec.span })
}

impl SpanLoads for PlacedLoads {
    fn add(&self, t: f64, factor: f64, loads: &mut Vec<SpanLoad>) {
        loads.extend(self.weight.map(|gravity| SpanLoad::Weight { gravity: factor * gravity }));
        loads.extend(self.loads.iter().filter_map(|(kind, signal)| {
            let factor = factor * signal.value(t);
            match *kind {
                LoadKind::Point { at, force, couple } => {
                    Some(SpanLoad::Point { x: at, force: factor * force, couple: factor * couple })
                }
                LoadKind::Distributed { load, from, to } => Some(SpanLoad::Uniform { from, to, load: factor * load }),
                LoadKind::Moving { force, at, speed } => {
                    let x = at + speed * t;
                    (0.0..=self.span).contains(&x).then_some(SpanLoad::Point { x, force: factor * force, couple: 0.0 })
                }
            }
        }));
    }
}

/// A beam without loads, its supports at rest in the place `displaced` (x, y; or nothing) from where the scene has them.
pub(crate) fn still_beam(of: &BeamScene, beam: &Arc<Beam>, displaced: &[f64]) -> BeamBody {
    let surface = if of.top { BeamSurface::Top { offset: 0.5 * of.thickness } } else { BeamSurface::Axis };
    let mut position = Vector2::from(of.position);
    if let [x, y] = *displaced {
        position += Vector2::new(x, y);
    }
    BeamBody::new(Arc::clone(beam), position, surface)
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
