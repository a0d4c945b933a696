//! The schemes that end a step with nothing in a surface: `moreau-jean-projected` and `generalized-alpha`.

use crate::scenes::{FLAT_BLOCK, PAPER_BLOCK, beam_body, model, workspace};
use nalgebra::Vector2;
use std::ops::ControlFlow;
use std::sync::Arc;
use teeter_beam::{Axial, Beam, BeamSpec, Section};
use teeter_detect::{Kinematics, PointDetector};
use teeter_integrator::*;

fn projected() -> Box<dyn Scheme<2>> {
    Box::new(MoreauJeanProjected::new(MoreauJeanProjectedSettings::default()).unwrap())
}

fn alpha(spectral_radius: f64) -> Box<dyn Scheme<2>> {
    let settings = GeneralizedAlphaSettings { spectral_radius, ..GeneralizedAlphaSettings::default() };
    Box::new(GeneralizedAlpha::new(settings).unwrap())
}

fn both() -> [Box<dyn Scheme<2>>; 3] {
    [projected(), alpha(0.8), alpha(0.0)]
}

fn ground(block: &crate::scenes::BlockSpec, law: PairLaw) -> Model<2> {
    model(block, Vector2::new(0.0, -9.81), law, Kinematics::Deformed, Box::new(Ground::flat(0.0)))
}

/// What a run showed.
#[derive(Debug, Default)]
struct Seen {
    /// Largest work of contacts in a step, and of contacts and projection together, J.
    by_contact: f64,
    by_projection: f64,
    /// Times at which a contact's normal velocity turned about.
    bounces: Vec<f64>,
}

impl Observer<2> for Seen {
    fn observe(&mut self, _: &Model<2>, step: &StepReport<'_, 2>, _: &State) -> Result<ControlFlow<()>, ObserverError> {
        let energy = step.energy();
        self.by_contact = self.by_contact.max(energy.contact + energy.friction);
        self.by_projection = self.by_projection.max(energy.projection);
        if step.contacts().any(|contact| contact.u_before[0] < -1e-3 && contact.p[0] > 0.0) {
            self.bounces.push(step.t_end);
        }
        Ok(ControlFlow::Continue(()))
    }
}

fn take(model: &Model<2>, scheme: &mut dyn Scheme<2>, q: &[f64], v: &[f64], h: f64, end: f64) -> (State, Seen) {
    let mut state = State::new(model, q, v, h).unwrap();
    let (mut work, mut seen) = (workspace(model), Seen::default());
    let plan = Plan::steps((end / h).round() as u64).when_unsolved(Unsolved::End);
    assert_eq!(run(model, scheme, &mut state, &mut work, &plan, &mut [&mut seen]).unwrap(), Ended::Complete);
    (state, seen)
}

fn tilted(x: f64) -> [f64; 3] {
    let (sin, cos) = 5.0_f64.to_radians().sin_cos();
    [x + 0.015 * cos - 0.0675 * sin, 0.015 * sin + 0.0675 * cos, 5.0_f64.to_radians()]
}

fn paper_beam(axial: Axial) -> Arc<Beam> {
    let mut spec = BeamSpec::new(0.36, 20, Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap()).axial(axial);
    spec.damping.viscous = spec.viscous_for_ratio(1, 0.01).unwrap();
    Arc::new(Beam::new(spec).unwrap())
}

fn on_beam(beam: &Arc<Beam>) -> (Model<2>, Vec<f64>) {
    let surface = Box::new(beam_body(beam));
    let gravity = Vector2::new(0.0, -9.81);
    let model = model(&PAPER_BLOCK, gravity, PairLaw::new(0.5, 0.0), Kinematics::Deformed, surface);
    let mut q = tilted(0.165).to_vec();
    q.resize(model.size().q, 0.0);
    (model, q)
}

/// Measured: 3e-16 m on ground, 8e-16 m on the beam, where the closed scheme is 1e-5 m deep; contacts give nothing,
/// and what the projection lifts is in a column of its own.
#[test]
fn no_step_ends_with_anything_in_a_surface() {
    let beam = paper_beam(Axial::Free);
    let rigid = ground(&PAPER_BLOCK, PairLaw::new(0.5, 0.0));
    let (elastic, q_beam) = on_beam(&beam);
    for (model, q, end) in [(&rigid, tilted(0.0).to_vec(), 1.0), (&elastic, q_beam, 0.5)] {
        let v = vec![0.0; q.len()];
        for h in [1e-3, 1e-4] {
            for mut scheme in [projected(), alpha(0.8)] {
                let (state, seen) = take(model, scheme.as_mut(), &q, &v, h, end);
                let name = scheme.name();
                assert!(state.tally.max_penetration < 1e-14, "{name} {h}: {:e}", state.tally.max_penetration);
                assert!(seen.by_contact < 1e-14, "{name} {h}: {:e} J by contacts", seen.by_contact);
                assert!(
                    seen.by_projection > 0.0 && seen.by_projection < 2e-4,
                    "{name} {h}: {:e} J",
                    seen.by_projection
                );
                assert!(state.ledger.relative_residual() < 1e-13, "{name}: {:e}", state.ledger.relative_residual());
            }
        }
    }
}

/// 10 s on level ground, and on an incline that friction holds it on.
#[test]
fn a_block_at_rest_stays_where_it_is() {
    for mut scheme in both() {
        for slope in [0.0_f64, 0.2] {
            for e in [0.0, 0.8] {
                let gravity = Vector2::new(-9.81 * slope.sin(), -9.81 * slope.cos());
                let law = PairLaw::new(0.5, e);
                let model = model(&FLAT_BLOCK, gravity, law, Kinematics::Deformed, Box::new(Ground::flat(0.0)));
                let start = [0.0, 0.025, 0.0];
                let (state, _) = take(&model, scheme.as_mut(), &start, &[0.0; 3], 1e-3, 10.0);
                let moved = state.q.iter().zip(&start).map(|(q, q0)| (q - q0).abs()).fold(0.0, f64::max);
                assert!(moved < 1e-13, "{} slope {slope}, e {e}: {moved:e}", scheme.name());
            }
        }
    }
}

/// v² / 2μg; the step in which it stops is off by up to ½μgh².
#[test]
fn a_slide_stops_where_friction_says() {
    let model = ground(&FLAT_BLOCK, PairLaw::new(0.3, 0.0));
    let exact = 0.5 / (0.3 * 9.81);
    for mut scheme in both() {
        for h in [1e-3, 1e-4] {
            let (state, _) = take(&model, scheme.as_mut(), &[0.0, 0.025, 0.0], &[1.0, 0.0, 0.0], h, 0.5);
            assert!((state.q[0] - exact).abs() < 0.3 * 9.81 * h * h, "{} {h}: {}", scheme.name(), state.q[0] - exact);
            assert!(state.v[0].abs() < 1e-12, "{}", scheme.name());
        }
    }
}

/// Each bounce is caught up to a step late; after t∞ = t₁(1+e)/(1−e) the block is at rest.
#[test]
fn bounces_come_at_their_times_and_end() {
    let (h, height, e) = (1e-4, 0.05, 0.5);
    let model = ground(&FLAT_BLOCK, PairLaw::new(0.3, e));
    for mut scheme in both() {
        let (state, seen) = take(&model, scheme.as_mut(), &[0.0, 0.025 + height, 0.0], &[0.0; 3], h, 0.5);
        let first = (2.0 * height / 9.81_f64).sqrt();
        for (k, t) in seen.bounces.iter().take(4).enumerate() {
            let exact = first * (1.0 + 2.0 * (1..=k).map(|k| e.powi(k as i32)).sum::<f64>());
            assert!((t - exact).abs() < 4.0 * h, "{} {k}: {t} {exact}", scheme.name());
        }
        assert!(seen.bounces.len() >= 6 && seen.bounces.len() < 20, "{:?}", seen.bounces);
        assert!((state.q[1] - 0.025).abs() < 1e-13 && state.v[1].abs() < 1e-12, "{}: {:?}", scheme.name(), state.q);
    }
}

/// The values of the event-driven scheme.
#[test]
fn the_beam_of_the_paper_moves_as_it_should() {
    let beam = paper_beam(Axial::Free);
    let (model, q) = on_beam(&beam);
    // From the undeformed start; at 0.05 s, 0.1 s and 0.15 s.
    for mut scheme in [projected(), alpha(0.8), alpha(0.5)] {
        for (end, expected) in [(0.05, 0.080903), (0.1, 0.023372), (0.15, -0.074836)] {
            let (state, _) = take(&model, scheme.as_mut(), &q, &vec![0.0; q.len()], 1e-4, end);
            assert!((state.q[2] - expected).abs() < 2e-4, "{} at {end}: {}", scheme.name(), state.q[2]);
        }
    }
}

/// With ρ = 1 generalized-α is the trapezoidal rule.
#[test]
fn a_spectral_radius_of_one_gives_the_projected_scheme() {
    let beam = paper_beam(Axial::Free);
    let (model, q) = on_beam(&beam);
    let v = vec![0.0; q.len()];
    let ends = [projected(), alpha(1.0)].map(|mut scheme| take(&model, scheme.as_mut(), &q, &v, 1e-3, 0.3).0);
    for (a, b) in ends[0].q.iter().zip(&ends[1].q) {
        assert!((a - b).abs() < 1e-11, "{a} {b}");
    }
    assert!(ends[1].ledger.sum.numerical.abs() < 1e-14, "{:e}", ends[1].ledger.sum.numerical);
}

/// A bent beam.
fn ragged(model: &Model<2>) -> Vec<f64> {
    (0..model.size().q).map(|k| if k % 4 == 2 { 1e-4 } else { 0.0 }).collect()
}

/// Of a motion that is far too fast for the step ρ per step is left.
#[test]
fn the_spectral_radius_is_what_is_left_of_a_fast_motion() {
    let beam =
        Arc::new(Beam::new(BeamSpec::new(0.36, 2, Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap())).unwrap());
    let mut parts = ModelBuilder::new();
    parts.add(beam_body(&beam));
    let model = parts.build(Box::new(PointDetector::new(Vec::new()))).unwrap();
    let q = ragged(&model);
    let energy = |rho: f64, steps: f64| {
        // The slowest mode has ωh = 170, where roots are within 1/ωh of ρ; the fastest 2000: (ωh)² ε of a position is rounding.
        let (state, _) = take(&model, alpha(rho).as_mut(), &q, &vec![0.0; q.len()], 1.0, steps);
        assert!(state.ledger.relative_residual() < 1e-8, "{rho}: {:e}", state.ledger.relative_residual());
        state.ledger.current.total() / state.ledger.initial.total()
    };
    assert!((energy(1.0, 40.0) - 1.0).abs() < 1e-7, "{}", energy(1.0, 40.0));
    for rho in [0.5_f64, 0.8] {
        // Double or triple roots: a power of the number of steps stands before ρ^n.
        let rate = (energy(rho, 160.0) / energy(rho, 80.0)).powf(1.0 / 160.0);
        assert!((rate / rho - 1.0).abs() < 0.05, "{rho}: {rate}");
    }
    assert!(energy(0.0, 4.0) < 1e-6, "{}", energy(0.0, 4.0));
}

/// The accelerations are in the state: a run that goes on from the middle by another scheme of the same settings
/// ends in the same bytes, and steps of other sizes keep the account.
#[test]
fn a_run_on_a_beam_goes_on_from_its_state() {
    let beam = paper_beam(Axial::Free);
    let (model, q) = on_beam(&beam);
    for make in [|| projected(), || alpha(0.8)] {
        let (mut scheme, mut work) = (make(), workspace(&model));
        let mut state = State::new(&model, &q, &vec![0.0; q.len()], 1e-4).unwrap();
        scheme.start(&model, &mut state, &mut work).unwrap();
        let mut middle = state.clone();
        for step in 0..3000 {
            if step == 1600 {
                middle = state.clone();
            }
            // Parts of a step on the way.
            let until = if step % 7 == 3 { state.t + 3.3e-5 } else { f64::INFINITY };
            scheme.advance(&model, &mut state, until, &mut work).unwrap();
        }
        let (mut scheme, mut work) = (make(), workspace(&model));
        scheme.start(&model, &mut middle, &mut work).unwrap();
        for step in 1600..3000 {
            let until = if step % 7 == 3 { middle.t + 3.3e-5 } else { f64::INFINITY };
            scheme.advance(&model, &mut middle, until, &mut work).unwrap();
        }
        assert_eq!(state, middle, "{}", scheme.name());
        assert!(state.ledger.relative_residual() < 1e-13, "{}", scheme.name());
    }
}

#[test]
fn settings_out_of_range_and_beams_held_along_their_axis_are_refused() {
    for spectral_radius in [-0.1, 1.5, f64::NAN] {
        let settings = GeneralizedAlphaSettings { spectral_radius, ..GeneralizedAlphaSettings::default() };
        let error = GeneralizedAlpha::<2>::new(settings).unwrap_err();
        assert_eq!((error.what, error.rule), ("spectral_radius", "in [0, 1]"));
    }
    for gap_tolerance in [-1e-12, f64::NAN, f64::INFINITY] {
        let settings = GeneralizedAlphaSettings { gap_tolerance, ..GeneralizedAlphaSettings::default() };
        assert!(GeneralizedAlpha::<2>::new(settings).is_err());
        assert!(MoreauJeanProjected::<2>::new(MoreauJeanProjectedSettings { gap_tolerance }).is_err());
    }
    let beam = paper_beam(Axial::Held);
    let (model, q) = on_beam(&beam);
    let mut state = State::new(&model, &q, &vec![0.0; q.len()], 1e-4).unwrap();
    let refused = alpha(0.8).start(&model, &mut state, &mut workspace(&model)).unwrap_err();
    assert!(matches!(refused, StepError::Unsupported { .. }), "{refused}");
    // The projection keeps the account of such a beam, too.
    let (state, _) = take(&model, projected().as_mut(), &q, &vec![0.0; q.len()], 1e-4, 0.3);
    assert!(state.ledger.relative_residual() < 1e-13 && state.tally.max_penetration < 1e-14);
}
