//! Contact problems alone, each solved from zero impulses.
#![allow(clippy::expect_used)] // a measurement that can't be set up has nothing to go on with

use criterion::Criterion;
use nalgebra::Vector2;
use std::hint::black_box;
use teeter_contact::conformance::{Case, body_on_floor, plane_cases};
use teeter_contact::{ContactSolver, Stop, judge};
use teeter_solvers::{Enumeration, Pgs};

/// Of the conformance cases: one, two and three contacts, and a slide beside a stick.
const CASES: [&str; 5] = [
    "one contact, sticks",
    "one contact, slides right",
    "two feet, fall flat",
    "two feet, slide",
    "three feet in a row, stick",
];

pub(crate) fn bench(criterion: &mut Criterion) {
    let chosen: Vec<Case<2>> = plane_cases().into_iter().filter(|case| CASES.contains(&case.name)).collect();
    assert_eq!(chosen.len(), CASES.len(), "the conformance cases were renamed");
    measure(criterion, "enumeration", &mut Enumeration::new(), &chosen);

    let feet: Vec<(f64, f64)> = (0..10).map(|i| (0.1 * f64::from(i) - 0.45, -1.0)).collect();
    let many = body_on_floor("ten feet, slide", 0.3, &feet, [3.0, -1.0, 0.0], 0.2);
    measure(criterion, "pgs", &mut Pgs::new(), &chosen.iter().cloned().chain([many]).collect::<Vec<_>>());

    let mut group = criterion.benchmark_group("judge");
    for case in &chosen {
        let problem = case.problem().expect("a problem");
        let p = vec![Vector2::zeros(); problem.contacts()];
        group.bench_function(case.name, |bencher| bencher.iter(|| judge(black_box(&problem), black_box(&p))));
    }
    group.finish();
}

fn measure(criterion: &mut Criterion, name: &str, solver: &mut dyn ContactSolver<2>, cases: &[Case<2>]) {
    let mut group = criterion.benchmark_group(name);
    for case in cases {
        let problem = case.problem().expect("a problem");
        let mut p = vec![Vector2::zeros(); problem.contacts()];
        group.bench_function(case.name, |bencher| {
            bencher.iter(|| {
                p.fill(Vector2::zeros());
                let outcome = solver.solve(black_box(&problem), &Stop::default(), &mut p);
                assert!(outcome.converged());
                outcome.iterations
            });
        });
    }
    group.finish();
}
