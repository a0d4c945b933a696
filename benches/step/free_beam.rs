//! Whole steps of a beam alone, vibrating: what a step costs that has nothing to touch.
#![allow(clippy::expect_used)] // a measurement that can't be set up has nothing to go on with

use crate::scenes::{DT, STEPS, paper_beam};
use criterion::{BatchSize, Criterion, Throughput};
use nalgebra::Vector2;
use std::sync::Arc;
use teeter_detect::PointDetector;
use teeter_integrator::{
    BeamBody, BeamSurface, ModelBuilder, MoreauJean, MoreauJeanSettings, Scheme, SolverSettings, State, Workspace,
};
use teeter_solvers::Auto;

/// Elements of the beams.
pub(crate) const ELEMENTS: [usize; 4] = [10, 40, 400, 2000];

pub(crate) fn bench(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("step/free beam");
    group.throughput(Throughput::Elements(STEPS));
    for elements in ELEMENTS {
        let beam = Arc::new(paper_beam(elements));
        // A parabola's load, removed: several modes, so that no dof is at rest.
        let mut q = vec![0.0; beam.dofs()];
        beam.add_uniform_load(-10.0, &mut q).expect("a load");
        beam.add_point_load(0.1, -1.0, &mut q).expect("a load on the beam");
        beam.solve_static(&mut q).expect("a supported beam");
        let mut parts = ModelBuilder::new();
        parts.add(BeamBody::new(beam, Vector2::zeros(), BeamSurface::Axis));
        let model = parts.build(Box::new(PointDetector::new(Vec::new()))).expect("a model");
        let mut scheme = MoreauJean::new(MoreauJeanSettings::default()).expect("default settings");
        let mut work = Workspace::new(&model, Box::new(Auto::new()), SolverSettings::default());
        let mut start = State::new(&model, &q, &vec![0.0; model.size().v], DT).expect("a state of the model");
        Scheme::<2>::start(&mut scheme, &model, &mut start, &mut work).expect("a factor");
        group.bench_function(elements.to_string(), |bencher| {
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
    }
    group.finish();
}
