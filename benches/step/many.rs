//! A step of many blocks beside each other on the ground, each sliding flat on two corners: time per contact, from a hundred contacts on.
#![allow(clippy::expect_used)] // a measurement that can't be set up has nothing to go on with

use criterion::{Criterion, Throughput};
use nalgebra::Vector2;
use teeter_detect::{Kinematics, PointDetector, PointPair};
use teeter_integrator::{
    Block, Blocks, Ground, ModelBuilder, MoreauJean, MoreauJeanSettings, PairLaw, Scheme, SolverSettings, State,
    Workspace,
};
use teeter_rigid::{MassProperties, Rectangle};
use teeter_solvers::Auto;

pub(crate) fn bench(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("contacts in islands of two");
    for blocks in [50_u32, 500, 5000] {
        let shape = Rectangle::new(0.1, 0.05).expect("a rectangle");
        let mass = MassProperties::rectangle(&shape, 0.1, 2700.0).expect("a mass");
        let mut parts = ModelBuilder::new();
        let bodies = vec![Block::new(mass, &shape); blocks as usize];
        let all = parts.add(Blocks::new(bodies, Vector2::new(0.0, -9.81)));
        let surface = parts.add(Ground::flat(0.0)).body();
        let law = parts.law(PairLaw::new(0.3, 0.0));
        let pair = |k| PointPair {
            pair: k,
            law,
            points: shape.corners().to_vec(),
            body: all.nth_body(k),
            surface,
            kinematics: Kinematics::Deformed,
        };
        let model = parts.build(Box::new(PointDetector::new((0..blocks).map(pair).collect()))).expect("a model");
        let q: Vec<f64> = (0..blocks).flat_map(|k| [0.2 * f64::from(k), 0.025, 0.0]).collect();
        // Fast enough to slide for as long as anybody measures.
        let v: Vec<f64> = (0..blocks).flat_map(|_| [1e4, 0.0, 0.0]).collect();
        let mut state = State::new(&model, &q, &v, 1e-4).expect("a state");
        let mut work = Workspace::new(&model, Box::new(Auto::new()), SolverSettings::default());
        let mut scheme = MoreauJean::new(MoreauJeanSettings::default()).expect("settings in range");
        scheme.start(&model, &mut state, &mut work).expect("of the model");
        group.throughput(Throughput::Elements(2 * u64::from(blocks)));
        group.bench_function((2 * blocks).to_string(), |bencher| {
            bencher.iter(|| {
                let step = scheme.advance(&model, &mut state, f64::INFINITY, &mut work).expect("a step");
                assert_eq!(step.contacts().count(), 2 * blocks as usize, "all of them touch");
            });
        });
    }
    group.finish();
}
