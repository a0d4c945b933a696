//! Whole steps: a block that rocks on rigid ground, and on the beam of the source paper.
#![allow(clippy::expect_used)] // a measurement that can't be set up has nothing to go on with

use criterion::{BatchSize, Criterion, Throughput};
use nalgebra::Vector2;
use std::sync::Arc;
use teeter_beam::{Beam, BeamSpec, ModalBasis, Section};
use teeter_detect::{Kinematics, PointDetector, PointPair};
use teeter_integrator::{
    BeamBody, BeamSurface, Block, Blocks, Ground, ModalBeam, Model, ModelBuilder, MoreauJean, MoreauJeanSettings,
    PairLaw, Scheme, SolverSettings, State, Subsystem, Workspace,
};
use teeter_rigid::{MassProperties, Rectangle};
use teeter_solvers::Auto;

/// Steps from a fresh state in one sample: 0.1 s, up to the first impact on rigid ground.
pub(crate) const STEPS: u64 = 1000;

/// Shapes of the beam in modes.
const MODES: usize = 10;

/// s.
pub(crate) const DT: f64 = 1e-4;

/// The block tilted by 5° on its left corner: mass centre (m) and inclination (rad).
pub(crate) const BLOCK_AT: [f64; 3] = [0.17405990783590924, 0.0685504782624077, 0.08726646259971647];

pub(crate) fn bench(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("step");
    group.throughput(Throughput::Elements(STEPS));
    let mut measure = |name: &str, surface: Box<dyn Subsystem<2>>| {
        let model = model(surface);
        let mut scheme = MoreauJean::new(MoreauJeanSettings::default()).expect("default settings");
        let mut work = Workspace::new(&model, Box::new(Auto::new()), SolverSettings::default());
        let mut q = BLOCK_AT.to_vec();
        q.resize(model.size().q, 0.0);
        let mut start = State::new(&model, &q, &vec![0.0; model.size().v], DT).expect("a state of the model");
        Scheme::<2>::start(&mut scheme, &model, &mut start, &mut work).expect("a factor");
        group.bench_function(name, |bencher| {
            bencher.iter_batched_ref(
                || start.clone(),
                |state| {
                    for _ in 0..STEPS {
                        scheme.advance(&model, state, f64::INFINITY, &mut work).expect("a step");
                    }
                },
                BatchSize::LargeInput,
            );
        });
    };
    measure("ground", Box::new(Ground::flat(0.0)));
    for elements in [10, 20, 40] {
        let beam = Arc::new(paper_beam(elements));
        measure(&format!("beam/{elements}"), Box::new(BeamBody::new(beam, Vector2::zeros(), BeamSurface::Axis)));
    }
    let beam = Arc::new(paper_beam(40));
    let basis = ModalBasis::new(&beam, MODES, &[]).expect("shapes");
    let modes = ModalBeam::new(beam, basis, Vector2::zeros(), BeamSurface::Axis).expect("a beam in modes");
    measure(&format!("modes/{MODES}"), Box::new(modes));
    group.finish();
}

/// The block of the source paper over a surface.
pub(crate) fn model(surface: Box<dyn Subsystem<2>>) -> Model<2> {
    let shape = Rectangle::new(0.03, 0.135).expect("a rectangle");
    let mass = MassProperties::rectangle(&shape, 0.03, 2700.0).expect("a mass");
    let mut parts = ModelBuilder::new();
    let body = parts.add(Blocks::new(vec![Block::new(mass, &shape)], Vector2::new(0.0, -9.81))).body();
    let surface = parts.add_boxed(surface).body();
    let law = parts.law(PairLaw::new(0.5, 0.0));
    let (points, kinematics) = (shape.corners().to_vec(), Kinematics::Deformed);
    parts
        .build(Box::new(PointDetector::new(vec![PointPair { pair: 0, law, points, body, surface, kinematics }])))
        .expect("a model")
}

/// The beam of the source paper, 1 % damping of its first mode.
pub(crate) fn paper_beam(elements: usize) -> Beam {
    let mut spec = BeamSpec::new(0.36, elements, Section::rectangle(0.03, 0.0015, 69e9, 2700.0).expect("a section"));
    spec.damping.viscous = spec.viscous_for_ratio(1, 0.01).expect("a first mode");
    Beam::new(spec).expect("a beam")
}
