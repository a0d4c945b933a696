//! What contacts on a beam cost beside the free motion: H = J W Jᵀ and W Jᵀ p, for both ways to hold W.
#![allow(clippy::expect_used)] // a measurement that can't be set up has nothing to go on with

use crate::free_beam::ELEMENTS;
use crate::scenes::{DT, paper_beam};
use criterion::Criterion;
use nalgebra::Vector2;
use std::sync::Arc;
use teeter_detect::{Kinematics, PointDetector, PointPair};
use teeter_integrator::{
    BeamBody, BeamSurface, Block, Blocks, ContactStage, Keep, Look, ModelBuilder, Over, PairLaw, Responses,
    SolverSettings, State, WBackend, Weights, Workspace,
};
use teeter_rigid::{MassProperties, Rectangle};
use teeter_solvers::Auto;

const CONTACTS: [usize; 6] = [1, 2, 4, 8, 16, 32];

pub(crate) fn bench(criterion: &mut Criterion) {
    for (elements, contacts) in ELEMENTS.into_iter().flat_map(|elements| CONTACTS.map(|contacts| (elements, contacts)))
    {
        let mut group = criterion.benchmark_group(format!("contacts on a beam/{elements}/{contacts}"));
        for backend in [WBackend::Banded, WBackend::CachedColumns] {
            let beam = Arc::new(paper_beam(elements));
            let shape = Rectangle::new(0.36, 0.02).expect("a rectangle");
            let mass = MassProperties::rectangle(&shape, 0.03, 2700.0).expect("a mass");
            let mut parts = ModelBuilder::new();
            let body = parts.add(Blocks::new(vec![Block::new(mass, &shape)], Vector2::new(0.0, -9.81))).body();
            let body_of_beam = BeamBody::new(beam, Vector2::zeros(), BeamSurface::Axis).with_backend(backend);
            let surface = parts.add(body_of_beam).body();
            let law = parts.law(PairLaw::new(0.5, 0.0));
            let place = |k: usize| Vector2::new(0.36 * ((k as f64 + 0.4) / contacts as f64 - 0.5), -0.01);
            let points = (0..contacts).map(place).collect();
            let pairs = vec![PointPair { pair: 0, law, points, body, surface, kinematics: Kinematics::Deformed }];
            let model = parts.build(Box::new(PointDetector::new(pairs))).expect("a model");
            let mut work = Workspace::new(&model, Box::new(Auto::new()), SolverSettings::default());
            let mut q = vec![0.18, 0.01, 0.0];
            q.resize(model.size().q, 0.0);
            let mut v = vec![0.0; model.size().v];
            let w = Weights { mass: 1.0, damping: 0.5 * DT, stiffness: 0.25 * DT * DT };
            work.factors(&model, w, &q, Keep::Pinned).expect("a factor");
            let state = State::new(&model, &q, &v, DT).expect("a state");
            let (over, responses) = (Over::Step { h: DT, weight: 0.5 }, Responses::Of(w));
            let mut stage = ContactStage::new();
            stage.find(&model, &state, &Look::new(&q, 1e-9), &mut work).expect("of the model");
            assert_eq!(stage.len(), contacts, "all of them touch");
            stage.pose(&model, &state, &state.v, &state.v, over).expect("of the model");
            group.bench_function(format!("{backend:?}"), |bencher| {
                bencher.iter(|| {
                    stage.solve(&model, &mut work, &responses, over).expect("of the model");
                    stage.respond(&model, &mut work, &responses, &mut v).expect("of the model");
                });
            });
        }
        group.finish();
    }
}
