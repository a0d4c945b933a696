//! The beam's part of a step: factors, solves, products, energies.
#![allow(clippy::expect_used)] // a measurement that can't be set up has nothing to go on with

use crate::scenes::paper_beam;
use criterion::Criterion;
use std::hint::black_box;
use teeter_beam::MatrixWeights;

/// A θ = 1/2 step of 1e-4 s.
const WEIGHTS: MatrixWeights = MatrixWeights { mass: 1.0, damping: 0.5e-4, stiffness: 0.25e-8 };

pub(crate) fn bench(criterion: &mut Criterion) {
    for elements in [10, 20, 40, 400] {
        let beam = paper_beam(elements);
        let mut group = criterion.benchmark_group(format!("beam/{elements}"));
        let mut factor = beam.factor(WEIGHTS).expect("a factor");
        let x: Vec<f64> = (0..beam.dofs()).map(|i| (1.3 * i as f64).sin()).collect();
        let mut y = vec![0.0; beam.dofs()];
        group.bench_function("factor", |bencher| bencher.iter(|| beam.factor(black_box(WEIGHTS))));
        group.bench_function("refactor", |bencher| {
            bencher.iter(|| beam.refactor(black_box(WEIGHTS), &mut factor).expect("the same factor"));
        });
        group.bench_function("solve", |bencher| {
            bencher.iter(|| {
                y.copy_from_slice(black_box(&x));
                factor.solve(&mut y);
            });
        });
        // Into a fresh zero each time: a sum that grows over millions of rounds would overflow.
        group.bench_function("mass product", |bencher| {
            bencher.iter(|| {
                y.fill(0.0);
                beam.add_mass_product(1.0, black_box(&x), &mut y);
            });
        });
        group.bench_function("damping product", |bencher| {
            bencher.iter(|| {
                y.fill(0.0);
                beam.add_damping_product(1.0, black_box(&x), &mut y);
            });
        });
        group.bench_function("stiffness product", |bencher| {
            bencher.iter(|| {
                y.fill(0.0);
                beam.add_stiffness_product(1.0, black_box(&x), &mut y);
            });
        });
        group.bench_function("both energies", |bencher| {
            bencher.iter(|| beam.kinetic_energy(black_box(&x)) + beam.elastic_energy(black_box(&x)));
        });
        group.bench_function("deflection at a point", |bencher| {
            bencher.iter(|| beam.deflection_at(black_box(&x), black_box(0.1651)));
        });
        group.finish();
    }
}
