//! The tension of a held beam as an unknown of a step: statics at long steps, energy with contacts, rounds that end.

use crate::scenes::{PAPER_BLOCK, all_schemes, beam_body, model, workspace};
use nalgebra::Vector2;
use std::sync::Arc;
use teeter_beam::{Axial, Beam, BeamSpec, Damping, Section};
use teeter_detect::{Frame, Kinematics, PointDetector, PointPair};
use teeter_integrator::*;
use teeter_rigid::{MassProperties, Rectangle};

fn moreau_jean(theta: f64) -> Box<dyn Scheme<2>> {
    Box::new(MoreauJean::new(MoreauJeanSettings { theta, ..MoreauJeanSettings::default() }).unwrap())
}

/// The source paper's beam between ends that can't approach each other.
fn held(damping: Damping) -> Arc<Beam> {
    let section = Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap();
    Arc::new(Beam::new(BeamSpec::new(0.36, 20, section).axial(Axial::Held).damped(damping)).unwrap())
}

/// A steel strip of 2 m × 5 cm × 1 mm under a force that is put on at once. A step that goes by s − ¼h² ∫ẇ'² dx comes to rest 28 % too
/// deep at 1 ms, and five times as deep at 2 ms.
#[test]
fn a_strip_comes_to_rest_at_the_sag_of_statics_however_long_the_step() {
    let section = Section::rectangle(0.05, 0.001, 210e9, 7850.0).unwrap();
    let spec = BeamSpec::new(2.0, 20, section).axial(Axial::Held);
    let first = Beam::new(spec.clone()).unwrap().circular_frequency(1).unwrap();
    let damping = Damping::none().with_viscous(2.0 * 0.1 * first * section.mass_per_length);
    let beam = Arc::new(Beam::new(spec.damped(damping)).unwrap());
    let mut exact = vec![0.0; beam.dofs()];
    beam.add_point_load(0.7, -10.0, &mut exact).unwrap();
    let load = SignalLoad::new(exact.clone(), Arc::new(Formula::constant(1.0).unwrap()));
    beam.solve_static(&mut exact).unwrap();
    let sag = |q: &[f64]| beam.deflection_at(q, 0.7).unwrap().w;
    let mut parts = ModelBuilder::new();
    parts.add(beam_body(&beam).with_load(Box::new(load)));
    let model = parts.build(Box::new(PointDetector::new(Vec::new()))).unwrap();
    for h in [1e-3, 2e-3] {
        let none = vec![0.0; beam.dofs()];
        let mut state = State::new(&model, &none, &none, h).unwrap();
        let steps = (30.0 / h) as u64;
        let plan = Plan::steps(steps).when_unsolved(Unsolved::End);
        let ended = run(&model, moreau_jean(0.5).as_mut(), &mut state, &mut workspace(&model), &plan, &mut []);
        assert_eq!(ended.unwrap(), Ended::Complete);
        // What still swings after 30 s is some 1e-5 of it.
        let error = sag(&state.q) / sag(&exact) - 1.0;
        assert!(error.abs() < 1e-4, "{h}: {error:e}");
        assert!(state.ledger.relative_residual() < 1e-14, "{h}: {:e}", state.ledger.relative_residual());
    }
}

/// The paper's block rocks on it, in steps that don't resolve the beam.
#[test]
fn contacts_on_a_held_beam_leave_the_identity_of_energy_one() {
    let beam = held(Damping::none().with_viscous(0.4));
    let theta_schemes = [
        MoreauJean::<2>::NAME,
        MoreauJeanClosed::<2>::NAME,
        MoreauJeanLocated::<2>::NAME,
        MoreauJeanProjected::<2>::NAME,
    ];
    for h in [1e-4, 1e-3] {
        for mut scheme in all_schemes(&[]).into_iter().filter(|scheme| theta_schemes.contains(&scheme.name())) {
            let surface = Box::new(beam_body(&beam));
            let law = PairLaw::new(0.5, 0.2);
            let model = model(&PAPER_BLOCK, Vector2::new(0.0, -9.81), law, Kinematics::Deformed, surface);
            let mut q = vec![0.17405990783590924, 0.0685504782624077, 0.08726646259971647];
            q.resize(3 + beam.dofs(), 0.0);
            let mut state = State::new(&model, &q, &vec![0.0; q.len()], h).unwrap();
            let mut work = workspace(&model);
            scheme.start(&model, &mut state, &mut work).unwrap();
            let (mut both, mut numerical) = (false, 0.0_f64);
            while state.t < 0.4 {
                let step = scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap();
                both |= step.phases().any(|phase| phase.contacts.len() == 2);
                numerical = numerical.max(step.energy().numerical.abs());
            }
            let (name, ledger) = (scheme.name(), &state.ledger);
            assert!(both, "{name}: it is meant to have two contacts");
            assert!(ledger.relative_residual() < 1e-14, "{name} {h}: {:e}", ledger.relative_residual());
            assert!(numerical < 1e-12 * ledger.scale, "{name} {h}: {numerical:e} of {}", ledger.scale);
            assert_eq!(work.counts.unsolved, 0, "{name} {h}");
            if name != MoreauJean::<2>::NAME && name != MoreauJeanProjected::<2>::NAME {
                assert!(ledger.sum.contact + ledger.sum.friction < 0.0, "{name} {h}: {:?}", ledger.sum);
                assert_eq!(ledger.positive_contact_work.steps, 0, "{name} {h}: no contact gives energy");
            }
        }
    }
}

#[test]
fn more_than_half_of_theta_takes_energy_and_never_gives_any() {
    let beam = held(Damping::default());
    let mut parts = ModelBuilder::new();
    parts.add(beam_body(&beam));
    let model = parts.build(Box::new(PointDetector::new(Vec::new()))).unwrap();
    let v: Vec<f64> =
        (0..beam.dofs()).map(|k| if beam.is_held(k) { 0.0 } else { 3.0 * (1.7 * k as f64).sin() }).collect();
    for theta in [0.55, 0.75, 1.0] {
        let mut scheme = moreau_jean(theta);
        let mut state = State::new(&model, &vec![0.0; beam.dofs()], &v, 1e-4).unwrap();
        let mut work = workspace(&model);
        scheme.start(&model, &mut state, &mut work).unwrap();
        for _ in 0..500 {
            let numerical = scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap().energy().numerical;
            assert!(numerical <= 1e-15 * state.ledger.scale, "{theta}: {numerical:e}");
        }
        assert!(state.ledger.relative_residual() < 1e-14, "{theta}: {:e}", state.ledger.relative_residual());
        assert!(state.ledger.current.total() < 0.9 * state.ledger.scale, "{theta}: {:?}", state.ledger);
    }
}

/// A long block stands with one foot on each of two held beams: what one yields changes the other's load.
#[test]
fn two_held_beams_under_one_block_find_their_tensions_together() {
    let beam = held(Damping::none().with_viscous(40.0));
    let shape = Rectangle::new(0.5, 0.02).unwrap();
    let mass = MassProperties::rectangle(&shape, 0.02, 2700.0).unwrap();
    let mut parts = ModelBuilder::new();
    let block = parts.add(Blocks::new(vec![Block::new(mass, &shape)], Vector2::new(0.0, -9.81))).body();
    let pairs: Vec<PointPair<2>> = [0.0, 0.4]
        .into_iter()
        .zip(0..)
        .map(|(left, pair)| {
            let at = Vector2::new(left, 0.0);
            let surface = parts.add(BeamBody::new(Arc::clone(&beam), at, BeamSurface::Axis)).body();
            let law = parts.law(PairLaw::new(0.5, 0.0));
            let points = shape.corners().to_vec();
            PointPair { pair, law, points, body: block, surface, kinematics: Kinematics::Deformed }
        })
        .collect();
    let model = parts.build(Box::new(PointDetector::new(pairs))).unwrap();
    // Feet at 0.13 m of the first and at 0.23 m of the second: mirrored.
    let mut q = vec![0.38, 0.01, 0.0];
    q.resize(model.size().q, 0.0);
    let mut state = State::new(&model, &q, &vec![0.0; q.len()], 1e-3).unwrap();
    let mut work = workspace(&model);
    let mut scheme = MoreauJeanClosed::new(MoreauJeanClosedSettings::default()).unwrap();
    let plan = Plan::steps(3000).when_unsolved(Unsolved::End);
    assert_eq!(run(&model, &mut scheme, &mut state, &mut work, &plan, &mut []).unwrap(), Ended::Complete);
    assert!(state.ledger.relative_residual() < 1e-14, "{:e}", state.ledger.relative_residual());
    // At rest each bears half of the weight.
    let mut exact = vec![0.0; beam.dofs()];
    beam.add_point_load(0.13, -0.5 * 9.81 * 0.5 * 0.02 * 0.02 * 2700.0, &mut exact).unwrap();
    beam.solve_static(&mut exact).unwrap();
    let sag = beam.deflection_at(&exact, 0.13).unwrap().w;
    let n = beam.dofs();
    for (first, x) in [(3, 0.13), (3 + n, 0.23)] {
        let found = beam.deflection_at(&state.q[first..first + n], x).unwrap().w;
        // The feet don't stand where they did: they are carried along by 0.5 w'² of the slope.
        assert!((found / sag - 1.0).abs() < 1e-3, "{found} {sag}");
    }
}

/// Mass 1 on a spring of force −k q − κ q³, with G = 1.
struct Cubic {
    k: f64,
    kappa: f64,
}

struct CubicInverse {
    weights: Weights,
    k: f64,
    matrix: f64,
}

impl Dynamics<2> for Cubic {
    fn size(&self) -> Size {
        Size { q: 1, v: 1, bodies: 0, row: 0 }
    }

    fn traits(&self) -> Traits {
        Traits::free().following_coordinates(true)
    }

    fn internal_force(&self, q: &[f64], _v: &[f64], f: &mut [f64]) {
        f[0] -= self.k * q[0] + self.kappa * q[0].powi(3);
    }

    fn apply(&self, w: Weights, _q: &[f64], x: &[f64], y: &mut [f64]) {
        y[0] += (w.mass + w.stiffness * self.k) * x[0];
    }

    fn energy(&self, q: &[f64], v: &[f64]) -> Energy {
        let elastic = 0.5 * self.k * q[0].powi(2) + 0.25 * self.kappa * q[0].powi(4);
        Energy { kinetic: 0.5 * v[0] * v[0], elastic, gravity: 0.0 }
    }

    fn factor(&self, weights: Weights, _q: &[f64]) -> Result<Box<dyn Compliance<2>>, FactorError> {
        let matrix = weights.mass + weights.stiffness * self.k;
        Ok(Box::new(CubicInverse { weights, k: self.k, matrix }))
    }

    fn stretching(&self) -> Option<&dyn Stretching> {
        Some(self)
    }
}

impl Bodies<2> for Cubic {
    fn place(&self, _: u32, _: &[f64], _: &[Vector2<f64>], _: &mut [Vector2<f64>]) {}

    fn rows(&self, _: u32, _: &[f64], _: &Vector2<f64>, _: &Frame<2>, _: &mut Rows<'_, 2>) -> usize {
        0
    }
}

impl Stretching for Cubic {
    fn stiffness(&self) -> f64 {
        self.kappa
    }

    fn form(&self, x: &[f64], y: &[f64]) -> f64 {
        x[0] * y[0]
    }

    fn add_product(&self, a: f64, x: &[f64], y: &mut [f64]) {
        y[0] += a * x[0];
    }

    fn force_beside(&self, q: &[f64], _v: &[f64], f: &mut [f64]) {
        f[0] -= self.k * q[0];
    }
}

impl Compliance<2> for CubicInverse {
    fn weights(&self) -> Weights {
        self.weights
    }

    fn refactor(&mut self, w: Weights, _q: &[f64]) -> Result<(), FactorError> {
        (self.weights, self.matrix) = (w, w.mass + w.stiffness * self.k);
        Ok(())
    }

    fn stretch(&mut self, tension: f64, weight: f64, g: &[f64]) {
        self.matrix = self.weights.mass + self.weights.stiffness * (self.k + tension) + weight * g[0] * g[0];
    }

    fn solve(&mut self, f: &mut [f64]) {
        f[0] /= self.matrix;
    }
}

/// Duffing's oscillator over steps from a thousandth of its period to many of them: the step solves
/// v¹ − v⁰ = −½h (q⁰ + q¹)(k + ½κ(q⁰² + q¹²)) to rounding, and keeps the energy.
#[test]
fn the_rounds_end_at_the_equation_of_the_step_however_long_it_is() {
    for (k, kappa) in [(1.0, 1.0), (0.0, 1.0), (1.0, 1e4)] {
        for h in [1e-3, 0.1, 1.0, 10.0, 100.0] {
            let mut parts = ModelBuilder::new();
            parts.add(Cubic { k, kappa });
            let model = parts.build(Box::new(PointDetector::new(vec![]))).unwrap();
            for start in [[1.0, 0.0], [0.0, 1.0], [0.7, -2.0], [1e-3, 5.0]] {
                let mut state = State::new(&model, &start[..1], &start[1..], h).unwrap();
                let mut work = workspace(&model);
                let mut scheme = moreau_jean(0.5);
                scheme.start(&model, &mut state, &mut work).unwrap();
                let mut stiffest = 0.0_f64;
                for _ in 0..50 {
                    let [q0, v0] = [state.q[0], state.v[0]];
                    scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap();
                    let [q1, v1] = [state.q[0], state.v[0]];
                    let stiffness = k + 0.5 * kappa * (q0 * q0 + q1 * q1);
                    stiffest = stiffest.max(stiffness);
                    let left = v1 - v0 + 0.5 * h * stiffness * (q0 + q1);
                    let size = v0.abs() + v1.abs() + 0.5 * h * stiffness * (q0.abs() + q1.abs());
                    // Where the rounds end; and h v in q is rounded, by which forces multiply.
                    let allowed = 1e-11 + f64::EPSILON * h * h * stiffness;
                    assert!(left.abs() < allowed * size, "{k} {kappa} {h} {start:?}: {left:e} of {size:e}");
                }
                let ledger = &state.ledger;
                assert_eq!(state.tally.unconverged_steps, 0, "{k} {kappa} {h} {start:?}");
                let rounding = 1e-14 + f64::EPSILON * h * h * stiffest;
                assert!(ledger.relative_residual() < rounding, "{h}: {:e}", ledger.relative_residual());
                let numerical = ledger.sum.numerical.abs() / ledger.scale;
                assert!(numerical < 1e-10, "{k} {kappa} {h} {start:?}: {numerical:e}");
            }
        }
    }
}
