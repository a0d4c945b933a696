//! A beam in modes: whole steps of it alone and under the block of the source paper, and what its modes take to find.
#![allow(clippy::expect_used)] // a measurement that can't be set up has nothing to go on with

use crate::scenes::{DT, STEPS, paper_beam};
use criterion::{BatchSize, Criterion, Throughput};
use nalgebra::Vector2;
use std::hint::black_box;
use std::sync::Arc;
use teeter_beam::ModalBasis;
use teeter_detect::PointDetector;
use teeter_integrator::{
    BeamSurface, ModalBeam, Model, ModelBuilder, MoreauJean, MoreauJeanSettings, Scheme, SolverSettings, State,
    Workspace,
};
use teeter_solvers::Auto;

/// Elements of the beams that are brought to modes.
const ELEMENTS: usize = 400;

pub(crate) fn bench(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("step/beam in modes");
    group.throughput(Throughput::Elements(STEPS));
    let mut measure = |name: String, model: &Model<2>, q: &[f64]| {
        let mut scheme = MoreauJean::new(MoreauJeanSettings::default()).expect("default settings");
        let mut work = Workspace::new(model, Box::new(Auto::new()), SolverSettings::default());
        let mut start = State::new(model, q, &vec![0.0; model.size().v], DT).expect("a state of the model");
        Scheme::<2>::start(&mut scheme, model, &mut start, &mut work).expect("a factor");
        group.bench_function(name, |bencher| {
            bencher.iter_batched_ref(
                || start.clone(),
                |state| {
                    for _ in 0..STEPS {
                        scheme.advance(model, state, f64::INFINITY, &mut work).expect("a step");
                    }
                },
                BatchSize::LargeInput,
            );
        });
    };
    let beam = Arc::new(paper_beam(ELEMENTS));
    let body = |basis| {
        let (position, surface) = (Vector2::zeros(), BeamSurface::Axis);
        Box::new(ModalBeam::new(Arc::clone(&beam), basis, position, surface).expect("viscous damping"))
    };
    for modes in [5, 10, 20] {
        let mut parts = ModelBuilder::new();
        parts.add_boxed(body(ModalBasis::new(&beam, modes, &[]).expect("modes")));
        let model = parts.build(Box::new(PointDetector::new(Vec::new()))).expect("a model");
        let q: Vec<f64> = (0..modes).map(|i| 1e-3 / (1 + i * i) as f64).collect();
        measure(format!("alone, {modes} modes"), &model, &q);
    }
    for tolerance in [1e-2, 1e-4] {
        let basis = ModalBasis::for_tolerance(&beam, [0.155, 0.205], tolerance).expect("a basis");
        let name = format!("under a block, {} shapes for {tolerance:e}", basis.len());
        let model = crate::scenes::model(body(basis));
        let mut q = crate::scenes::BLOCK_AT.to_vec();
        q.resize(model.size().q, 0.0);
        measure(name, &model, &q);
    }
    group.finish();

    let mut group = criterion.benchmark_group("modes");
    group.sample_size(10);
    for (elements, modes) in [(20, 5), (400, 20), (1000, 5), (1000, 20)] {
        let beam = paper_beam(elements);
        group.bench_function(format!("{modes} of {elements} elements"), |bencher| {
            bencher.iter(|| black_box(&beam).modes(modes).expect("modes"));
        });
    }
    group.finish();
}
