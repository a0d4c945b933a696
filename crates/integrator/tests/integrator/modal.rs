//! A beam in modes: against the beam of elements, against the oscillators that it is made of, and what truncation costs.

use crate::scenes::{PAPER_BLOCK, beam_body, model, workspace};
use nalgebra::Vector2;
use std::sync::Arc;
use teeter_beam::{Beam, BeamSpec, DistributedLoad, ModalBasis, MovingLoad, Section};
use teeter_detect::{Kinematics, PointDetector};
use teeter_integrator::*;

/// Where the block of these tests stands, m along the beam.
const REGION: [f64; 2] = [0.155, 0.205];

/// The paper's beam, 1 % damping of its first mode.
fn beam(elements: usize) -> Arc<Beam> {
    let mut spec = BeamSpec::new(0.36, elements, Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap());
    spec.damping.viscous = spec.viscous_for_ratio(1, 0.01).unwrap();
    Arc::new(Beam::new(spec).unwrap())
}

fn modal(beam: &Arc<Beam>, basis: ModalBasis) -> ModalBeam {
    ModalBeam::new(Arc::clone(beam), basis, Vector2::zeros(), BeamSurface::Axis).unwrap()
}

fn all_modes(beam: &Beam) -> ModalBasis {
    ModalBasis::new(beam, beam.free_dofs(), &[]).unwrap()
}

/// The inclination of the paper's block at every step as it rocks on a beam from rest.
fn rocking(surface: Box<dyn Subsystem<2>>, steps: usize) -> Vec<f64> {
    let model = model(&PAPER_BLOCK, Vector2::new(0.0, -9.81), PairLaw::new(0.5, 0.0), Kinematics::Deformed, surface);
    let mut q = vec![0.17405990783590924, 0.0685504782624077, 0.08726646259971647];
    q.resize(model.size().q, 0.0);
    let mut state = State::new(&model, &q, &vec![0.0; model.size().v], 1e-4).unwrap();
    let mut work = workspace(&model);
    let mut scheme = MoreauJean::new(MoreauJeanSettings::default()).unwrap();
    scheme.start(&model, &mut state, &mut work).unwrap();
    let mut inclinations = Vec::new();
    for _ in 0..steps {
        scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap();
        inclinations.push(state.q[2]);
    }
    let residual = state.ledger.relative_residual();
    assert!(residual <= 1e-12, "energy of the steps: {residual:e}");
    inclinations
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |m, (a, b)| m.max((a - b).abs()))
}

/// The beam alone from rest to t = 0.1 s.
fn alone(body: Box<dyn Subsystem<2>>, start: &[f64]) -> State {
    let mut parts = ModelBuilder::new();
    let size = body.size();
    parts.add_boxed(body);
    let model = parts.build(Box::new(PointDetector::new(Vec::new()))).unwrap();
    let mut q = start.to_vec();
    q.resize(size.q, 0.0);
    let mut state = State::new(&model, &q, &vec![0.0; size.v], 1e-4).unwrap();
    let mut work = workspace(&model);
    let mut scheme = MoreauJean::new(MoreauJeanSettings::default()).unwrap();
    let plan = Plan::steps(1000).when_unsolved(Unsolved::End);
    assert_eq!(run(&model, &mut scheme, &mut state, &mut work, &plan, &mut []).unwrap(), Ended::Complete);
    assert!(state.ledger.relative_residual() <= 1e-12, "{:e}", state.ledger.relative_residual());
    state
}

#[test]
fn in_all_its_modes_the_beam_is_that_of_elements_through_impacts() {
    let beam = beam(20);
    let elements = rocking(Box::new(beam_body(&beam)), 6000);
    let modes = rocking(Box::new(modal(&beam, all_modes(&beam))), 6000);
    assert!(elements.iter().any(|phi| *phi < 0.0), "there is an impact");
    let difference = largest_difference(&elements, &modes);
    assert!(difference < 1e-9, "{difference:e}");
}

/// The estimate is of the flexibility; the inclination feels a few hundredths of it while the contact lasts.
#[test]
fn a_tolerance_bounds_the_error_of_a_run_up_to_its_first_impact() {
    for elements in [20, 60] {
        let beam = beam(elements);
        let full = rocking(Box::new(beam_body(&beam)), 1200);
        let first_impact = full.iter().position(|phi| *phi < 0.0).unwrap() - 1;
        let mut last = f64::INFINITY;
        for tolerance in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5] {
            let basis = ModalBasis::for_tolerance(&beam, REGION, tolerance).unwrap();
            assert!(basis.len() <= 20, "{} shapes", basis.len());
            let error = largest_difference(
                &full[..first_impact],
                &rocking(Box::new(modal(&beam, basis)), 1200)[..first_impact],
            );
            assert!(error <= 0.1 * tolerance && error < last, "{elements} {tolerance:e}: {error:e}");
            last = error;
        }
    }
}

/// Every coordinate is the damped oscillator of its mode, to the scheme's second order.
#[test]
fn modes_decay_as_they_must() {
    let beam = beam(40);
    let basis = ModalBasis::new(&beam, 2, &[]).unwrap();
    let damping = basis.damping(&beam).unwrap();
    let omega = basis.circular_frequencies().to_vec();
    let state = alone(Box::new(modal(&beam, basis)), &[1.0, 0.5]);
    for (i, start) in [1.0, 0.5].into_iter().enumerate() {
        // Crank–Nicolson turns by 2 atan(ωh/2) a step where undamped and multiplies the amplitude by
        // √((1 − dh/2 + (ωh/2)²)/(1 + dh/2 + (ωh/2)²)): here the two-step recursion of η̈ + d η̇ + ω²η = 0 in closed form.
        let (h, d, w) = (1e-4, damping[i], omega[i]);
        let a = 0.25 * w * w * h * h;
        let (plus, minus) = (1.0 + 0.5 * d * h + a, 1.0 - 0.5 * d * h + a);
        let modulus = (minus / plus).sqrt();
        let angle = ((1.0 - a) / (plus * minus).sqrt()).acos();
        // η_n = r^n (A cos nα + B sin nα) with η_0 = start and v_0 = 0, so that η_1 = start (1 − 2a/plus).
        let sine = (start * (1.0 - 2.0 * a / plus) / modulus - start * angle.cos()) / angle.sin();
        let exact = modulus.powi(1000) * (start * (1000.0 * angle).cos() + sine * (1000.0 * angle).sin());
        assert!((state.q[i] - exact).abs() < 1e-11, "{i}: {} {exact}", state.q[i]);
        let continuous = start * (-0.5 * d * 0.1).exp();
        let amplitude = start.hypot(sine) * modulus.powi(1000);
        assert!((amplitude / continuous - 1.0).abs() < 1e-3, "{i}: {amplitude} {continuous}");
    }
}

#[test]
fn given_ratios_replace_the_beams_damping() {
    let beam = beam(20);
    let basis = ModalBasis::new(&beam, 3, &[0.18]).unwrap();
    let own: Vec<f64> = basis
        .damping(&beam)
        .unwrap()
        .iter()
        .zip(basis.circular_frequencies())
        .map(|(damping, omega)| damping / (2.0 * omega))
        .collect();
    let with = |ratios: &[f64]| {
        let (position, surface) = (Vector2::zeros(), BeamSurface::Axis);
        ModalBeam::with_ratios(Arc::clone(&beam), basis.clone(), ratios, position, surface)
    };
    let start = [1.0, -0.3, 0.2, 0.1];
    let (a, b) = (alone(Box::new(modal(&beam, basis.clone())), &start), alone(Box::new(with(&own).unwrap()), &start));
    assert!(largest_difference(&a.q, &b.q) < 1e-12);
    let undamped = alone(Box::new(with(&[0.0; 4]).unwrap()), &start);
    assert_eq!(undamped.ledger.sum.viscous, 0.0);
    assert!(a.ledger.sum.viscous < 0.0);
    for (ratios, words) in
        [(&[0.1; 3][..], "3 for 4"), (&[0.1, -0.1, 0.1, 0.1], "ratios[1] = -0.1"), (&[f64::NAN; 4], "ratios[0]")]
    {
        assert!(with(ratios).unwrap_err().to_string().contains(words), "{words}");
    }
}

#[test]
fn loads_and_moving_supports_act_as_on_elements() {
    let beam = beam(12);
    let harmonic = |size, frequency| {
        let signal: Arc<dyn Signal> = Arc::new(Formula::harmonic(0.0, frequency, 0.0).unwrap());
        Motion::still().with(Given::Velocity, size, signal)
    };
    let motion = || [harmonic(0.01, 7.0), harmonic(0.02, 11.0)];
    let signal: Arc<dyn Signal> = Arc::new(Table::new(vec![0.0, 0.05, 0.2], vec![0.0, 1.0, 0.0]).unwrap());
    let pattern: Vec<f64> = (0..beam.dofs()).map(|i| (0.7 * i as f64).cos()).collect();
    let loads = || -> [Box<dyn teeter_beam::Load>; 2] {
        [
            Box::new(MovingLoad::new(-10.0, 2.0, 0.0).unwrap()),
            Box::new(DistributedLoad::new(|t: f64| 5.0 * (300.0 * t).sin())),
        ]
    };
    let load = SignalLoad::new(pattern, signal);
    let mut elements = beam_body(&beam).with_motion(motion()).with_load(Box::new(load.clone()));
    let mut modes = modal(&beam, all_modes(&beam)).with_motion(motion()).with_signal_load(load);
    for (a, b) in loads().into_iter().zip(loads()) {
        elements = elements.with_load(a);
        modes = modes.with_load(b);
    }
    assert_eq!(elements.displacements(0.3), modes.displacements(0.3));
    let basis = modes.basis().clone();
    let (a, b) = (alone(Box::new(elements), &[]), alone(Box::new(modes), &[]));
    let (n, m) = (beam.dofs(), basis.len());
    let q = basis.dofs(&b.q[..m]);
    let size = a.q[..n].iter().fold(0.0_f64, |m, q| m.max(q.abs()));
    assert!(size > 1e-3 && largest_difference(&a.q[..n], &q) < 1e-9 * size);
    assert!(largest_difference(&a.q[n..], &b.q[m..]) < 1e-15, "the supports");
    let (a, b) = (&a.ledger, &b.ledger);
    assert!((a.current.total() - b.current.total()).abs() < 1e-9 * a.scale);
    assert!((a.sum.external - b.sum.external).abs() < 1e-9 * a.scale);
}

#[test]
fn weights_without_an_inverse_are_refused() {
    let beam = beam(4);
    let body = modal(&beam, all_modes(&beam));
    for mass in [-1.0, f64::NAN, f64::INFINITY] {
        let error = body.factor(Weights { mass, damping: 0.0, stiffness: 0.0 }, &[]).err().unwrap();
        assert!(error.to_string().contains("coordinate 0"), "{error}");
    }
}

#[test]
fn points_of_the_section_are_placed_as_on_elements() {
    let beam = beam(9);
    let top = BeamSurface::Top { offset: 0.00075 };
    let elements = BeamBody::new(Arc::clone(&beam), Vector2::new(0.1, 0.2), top);
    let modes = ModalBeam::new(Arc::clone(&beam), all_modes(&beam), Vector2::new(0.1, 0.2), top).unwrap();
    let mut q: Vec<f64> = (0..beam.dofs()).map(|i| 0.01 * (0.9 * i as f64).sin()).collect();
    elements.traits().held.iter().for_each(|dof| q[*dof] = 0.0);
    let eta = modes.basis().coordinates(&beam, &q);
    let local = [0.0, 0.11, 0.25, 0.36].map(|x| Vector2::new(x, 0.00075));
    let (mut a, mut b) = ([Vector2::zeros(); 4], [Vector2::zeros(); 4]);
    elements.place(0, &q, &local, &mut a);
    modes.place(0, &eta, &local, &mut b);
    assert!(a.iter().zip(&b).all(|(a, b)| (a - b).norm() < 1e-13));
    for x in [0.1, 0.23, 0.3, 0.46, 0.47] {
        let at = Vector2::new(x, 0.0);
        for kinematics in [Kinematics::Deformed, Kinematics::Linear] {
            let (a, b) = (elements.surface(0, &q, kinematics, &at), modes.surface(0, &eta, kinematics, &at));
            assert_eq!(a.is_some(), b.is_some(), "{x}");
            if let (Some(a), Some(b)) = (a, b) {
                assert!((a.place - b.place).norm() < 1e-13 && (a.normal - b.normal).norm() < 1e-11, "{x}");
            }
        }
    }
    let (w, d) = (modes.deflection_at(&eta, 0.1).unwrap(), beam.deflection_at(&q, 0.1).unwrap());
    assert!((w.w - d.w).abs() < 1e-13 && (w.slope - d.slope).abs() < 1e-11);
    assert_eq!(modes.deflection_at(&eta, 0.37), None);
}
