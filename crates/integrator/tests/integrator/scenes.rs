//! Models for tests: a block on rigid ground or on a beam.

use nalgebra::Vector2;
use std::sync::Arc;
use teeter_beam::Beam;
use teeter_detect::{Kinematics, PointDetector, PointPair};
use teeter_integrator::*;
use teeter_rigid::{MassProperties, Rectangle};

/// What a block of the tests is.
pub(crate) struct BlockSpec {
    pub(crate) width: f64,
    pub(crate) height: f64,
    pub(crate) depth: f64,
    pub(crate) density: f64,
}

/// The block of the source paper.
pub(crate) const PAPER_BLOCK: BlockSpec = BlockSpec { width: 0.03, height: 0.135, depth: 0.03, density: 2700.0 };

/// A block that slides rather than tips.
pub(crate) const FLAT_BLOCK: BlockSpec = BlockSpec { width: 0.1, height: 0.05, depth: 0.1, density: 2700.0 };

/// A block above a surface.
pub(crate) fn model(
    spec: &BlockSpec,
    gravity: Vector2<f64>,
    law: PairLaw,
    kinematics: Kinematics,
    surface: Box<dyn Subsystem<2>>,
) -> Model<2> {
    let shape = Rectangle::new(spec.width, spec.height).unwrap();
    let mass = MassProperties::rectangle(&shape, spec.depth, spec.density).unwrap();
    let mut parts = ModelBuilder::new();
    let body = parts.add(Blocks::new(vec![Block::new(mass, &shape)], gravity)).body();
    let surface = parts.add_boxed(surface).body();
    let law = parts.law(law);
    let points = shape.corners().to_vec();
    parts
        .build(Box::new(PointDetector::new(vec![PointPair { pair: 0, law, points, body, surface, kinematics }])))
        .unwrap()
}

/// A beam at the origin, contact on its axis.
pub(crate) fn beam_body(beam: &Arc<Beam>) -> BeamBody {
    BeamBody::new(Arc::clone(beam), Vector2::zeros(), BeamSurface::Axis)
}

/// A workspace with the default solver.
pub(crate) fn workspace(model: &Model<2>) -> Workspace<2> {
    Workspace::new(model, Box::new(teeter_solvers::Auto::new()), SolverSettings::default())
}

/// All schemes with their default settings, and the θ scheme with others.
pub(crate) fn all_schemes(thetas: &[f64]) -> Vec<Box<dyn Scheme<2>>> {
    let by_theta = thetas.iter().map(|&theta| -> Box<dyn Scheme<2>> {
        let settings = MoreauJeanSettings { theta, ..MoreauJeanSettings::default() };
        Box::new(MoreauJean::new(settings).unwrap())
    });
    schemes().iter().map(|entry| entry.make().unwrap()).chain(by_theta).collect()
}
