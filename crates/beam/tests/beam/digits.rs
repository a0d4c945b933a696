//! What rounding takes, and what [`Beam::digits`] says of it, against solves in double-double arithmetic.

use crate::double_double::{Dd, Exact, error, rounded};
use teeter_beam::{Beam, BeamSpec, Digits, Foundation, MatrixWeights, Support};

const STATICS: MatrixWeights = MatrixWeights::STIFFNESS;

/// A θ step with θ = ½.
fn step(h: f64) -> MatrixWeights {
    MatrixWeights { mass: 1.0, damping: 0.5 * h, stiffness: 0.25 * h * h }
}

const SUPPORTS: [[Support; 2]; 4] = [
    [Support::Pinned, Support::Pinned],
    [Support::Clamped, Support::Clamped],
    [Support::Clamped, Support::Free],
    [Support::Pinned, Support::Clamped],
];

fn loads(beam: &Beam) -> Vec<Vec<f64>> {
    let mut loads = vec![vec![0.0; beam.dofs()]; 3];
    beam.add_uniform_load(-3.0, &mut loads[0]).unwrap();
    beam.add_point_load(0.13 * beam.spec().span, -2.0, &mut loads[1]).unwrap();
    beam.add_distributed_load(&|x| (9.0 * x).sin(), &mut loads[2]).unwrap();
    loads
}

/// The worst errors of the plain and the refined solve.
fn errors(beam: &Beam, weights: MatrixWeights) -> [f64; 3] {
    let factor = beam.factor(weights).unwrap();
    let exact = Exact::new(beam, weights);
    let mut worst = [0.0_f64; 3];
    for load in loads(beam) {
        let solution = exact.solve(&factor, &load);
        let mut plain = load.clone();
        factor.solve(&mut plain);
        worst[0] = worst[0].max(error(beam, &plain, &solution));
        if weights == STATICS {
            let mut refined = load.clone();
            beam.solve_static(&mut refined).unwrap();
            worst[1] = worst[1].max(error(beam, &refined, &solution));
            // Refinement of the rounded solution with the residual in double-double.
            let mut x = plain;
            for _ in 0..30 {
                let wide: Vec<Dd> = x.iter().copied().map(Dd::from).collect();
                let mut correction = rounded(&exact.residual(&load, &wide));
                factor.solve(&mut correction);
                x.iter_mut().zip(&correction).for_each(|(x, dx)| *x += dx);
            }
            worst[2] = worst[2].max(error(beam, &x, &solution));
        }
    }
    worst
}

#[test]
#[ignore = "prints the table of docs/beams.md"]
fn table() {
    for n in [2, 5, 10, 20, 50, 100, 200, 300, 500, 1000, 2000, 3000] {
        let mut row = [0.0_f64; 5];
        for supports in SUPPORTS {
            let beam = super::beam(n, supports);
            let worst = errors(&beam, STATICS);
            let estimate = beam.digits(STATICS).unwrap();
            for (r, w) in row.iter_mut().zip(worst.into_iter().chain([estimate.solve, estimate.refined])) {
                *r = r.max(w);
            }
        }
        let mut line = format!("{n:5} statics {}", row.map(|e| format!("{e:.1e}")).join(" "));
        for h in [1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
            let beam = super::beam(n, [Support::Pinned; 2]);
            line += &format!("  {h:e}: {:.1e} {:.1e}", errors(&beam, step(h))[0], beam.digits(step(h)).unwrap().solve);
        }
        let beam = super::beam(n, [Support::Pinned; 2]);
        let omega = beam.modes(1).unwrap().circular_frequencies()[0];
        line += &format!("  f1 {:.1e}", omega / beam.circular_frequency(1).unwrap() - 1.0);
        eprintln!("{line}");
    }
}

/// The estimate of the plain solve is never less than half the error, and where digits are lost at all never more than ten times
/// it; that of the refined solve is never less than the error.
fn check(beam: &Beam, weights: MatrixWeights) {
    let [plain, refined, _] = errors(beam, weights);
    let digits = beam.digits(weights).unwrap();
    let tell = || format!("{weights:?} {plain:e} {refined:e} {digits:?} {:?}", beam.spec());
    assert!(digits.solve > 0.5 * plain || plain < 1e-14, "{}", tell());
    assert!(digits.solve < 10.0 * plain.max(1e-12), "{}", tell());
    assert!(digits.refined >= refined && digits.refined < 1e-13, "{}", tell());
}

#[test]
fn the_estimate_is_true_for_every_mesh_support_and_step() {
    for n in [2, 3, 7, 20, 60, 200, 700, 2000] {
        for supports in SUPPORTS {
            for weights in [STATICS, step(1e-2), step(1e-3), step(1e-4), step(1e-5), step(1e-6)] {
                check(&super::beam(n, supports), weights);
            }
        }
    }
}

#[test]
fn the_estimate_is_true_on_a_foundation_and_under_an_axial_force() {
    let euler = 0.5821875 * (std::f64::consts::PI / 0.36).powi(2);
    for n in [20, 200, 1000] {
        let spec: BeamSpec = super::spec(n, [Support::Pinned; 2]);
        let bed = |stiffness| Foundation::new(0.0, 0.36, stiffness);
        for spec in [
            spec.clone().axial_force(1e3 * euler),
            spec.clone().axial_force(-0.9 * euler),
            spec.clone().foundation(bed(1e2)),
            spec.clone().foundation(bed(1e6)).supported([Support::Free; 2]),
        ] {
            check(&Beam::new(spec).unwrap(), STATICS);
        }
    }
}

/// What [`Beam::solve_static`] refuses has no digit that is told.
#[test]
fn where_the_refinement_does_not_settle_few_digits_are_told() {
    let beam = super::beam(10_000, [Support::Clamped, Support::Free]);
    let digits = beam.digits(STATICS).unwrap();
    let mut load = vec![0.0; beam.dofs()];
    beam.add_uniform_load(1.0, &mut load).unwrap();
    let settled = beam.solve_static(&mut load).is_ok();
    assert!(digits.of_solve() < Digits::FEW, "{digits:?}");
    assert_eq!(settled, digits.refined <= 1e-10, "{digits:?}");
}
