//! The scheme whose contacts stay closed: no drop-outs at rest, no work of contact, the same order as the page's scheme.

use crate::scenes::{FLAT_BLOCK, PAPER_BLOCK, beam_body, model, workspace};
use nalgebra::Vector2;
use std::ops::ControlFlow;
use std::sync::Arc;
use teeter_beam::{Beam, BeamSpec, Section};
use teeter_detect::{Kinematics, PointDetector, PointPair};
use teeter_integrator::*;
use teeter_rigid::{MassProperties, Rectangle};

/// What a run of the scheme showed.
#[derive(Debug, Default)]
struct Seen {
    /// Steps without a contact between steps with one, each at most three long.
    drop_outs: u32,
    /// Largest work U_θ·p of a single contact, relative to ‖p‖ times its speeds.
    largest_work: f64,
    /// Contacts that slid.
    slips: u32,
    without: u32,
    had: bool,
}

impl Observer<2> for Seen {
    fn observe(&mut self, _: &Model<2>, step: &StepReport<'_, 2>, _: &State) -> Result<ControlFlow<()>, ObserverError> {
        for contact in step.contacts() {
            let mean = (contact.u_before + contact.u_after) * 0.5;
            let size = contact.p.norm() * (contact.u_before.norm() + contact.u_after.norm()).max(1e-6);
            if size > 0.0 {
                self.largest_work = self.largest_work.max(mean.dot(&contact.p) / size);
            }
        }
        self.slips += step.contacts().filter(|contact| contact.state() == ContactState::Slip).count() as u32;
        if step.contacts().any(|contact| contact.p[0] > 0.0) {
            if self.had && (1..=3).contains(&self.without) {
                self.drop_outs += 1;
            }
            (self.had, self.without) = (true, 0);
        } else {
            self.without += 1;
        }
        Ok(ControlFlow::Continue(()))
    }
}

fn take(model: &Model<2>, q: &[f64], v: &[f64], h: f64, steps: u64, closed: bool) -> (State, Seen) {
    let mut state = State::new(model, q, v, h).unwrap();
    let mut work = workspace(model);
    let plan = Plan::steps(steps).when_unsolved(Unsolved::End);
    let mut seen = Seen::default();
    let mut scheme: Box<dyn Scheme<2>> = if closed {
        Box::new(MoreauJeanClosed::new(MoreauJeanClosedSettings::default()).unwrap())
    } else {
        Box::new(MoreauJean::new(MoreauJeanSettings::default()).unwrap())
    };
    let ended = run(model, scheme.as_mut(), &mut state, &mut work, &plan, &mut [&mut seen]).unwrap();
    assert_eq!(ended, Ended::Complete);
    (state, seen)
}

fn ground(law: PairLaw) -> Model<2> {
    model(&PAPER_BLOCK, Vector2::new(0.0, -9.81), law, Kinematics::Deformed, Box::new(Ground::flat(0.0)))
}

/// The paper's block tilted by 5° about its bottom left corner, which is at the origin.
fn tilted() -> [f64; 3] {
    let (sin, cos) = 5.0_f64.to_radians().sin_cos();
    [0.015 * cos - 0.0675 * sin, 0.015 * sin + 0.0675 * cos, 5.0_f64.to_radians()]
}

/// The page's scheme loses its one contact now and then as the gap drifts, and lets contact work be positive in nearly every
/// step; here neither happens, and the penetration is smaller.
#[test]
fn a_rocking_block_keeps_its_contact_and_gets_no_energy_from_it() {
    let model = ground(PairLaw::new(0.5, 0.0));
    for h in [1e-3, 1e-4, 1e-5] {
        let steps = (1.0 / h) as u64;
        let (page, of_page) = take(&model, &tilted(), &[0.0; 3], h, steps, false);
        let (closed, seen) = take(&model, &tilted(), &[0.0; 3], h, steps, true);
        assert!(of_page.drop_outs > 0 && page.ledger.positive_contact_work.steps > steps / 2, "{h}: {of_page:?}");
        assert_eq!((seen.drop_outs, closed.ledger.positive_contact_work.steps), (0, 0), "{h}");
        assert!(seen.largest_work <= 1e-11, "{h}: {seen:?}");
        assert_eq!((seen.slips, of_page.slips), (0, 0), "{h}: with this friction it sticks");
        assert!(closed.tally.max_penetration < page.tally.max_penetration, "{h}");
        assert!(closed.ledger.relative_residual() <= 1e-15, "{h}");
        // First order both: they agree as well as the page's does with the exact motion.
        assert!((closed.q[2] - page.q[2]).abs() <= 20.0 * h, "{h}: {} {}", closed.q[2], page.q[2]);
    }
}

#[test]
fn on_a_beam_no_step_gets_energy_from_contact() {
    let beam = paper_beam();
    for (e, h) in [(0.0, 1e-4), (0.3, 1e-4), (0.3, 1e-5)] {
        let surface = Box::new(beam_body(&beam));
        let gravity = Vector2::new(0.0, -9.81);
        let model = model(&PAPER_BLOCK, gravity, PairLaw::new(0.5, e), Kinematics::Deformed, surface);
        let mut q = tilted().to_vec();
        q[0] += 0.165;
        q.resize(3 + beam.dofs(), 0.0);
        let v = vec![0.0; q.len()];
        let steps = (0.3 / h) as u64;
        let (page, _) = take(&model, &q, &v, h, steps, false);
        let (closed, seen) = take(&model, &q, &v, h, steps, true);
        assert!(page.ledger.positive_contact_work.steps > 0, "{e} {h}");
        assert_eq!(closed.ledger.positive_contact_work.steps, 0, "{e} {h}");
        assert!(seen.largest_work <= 1e-9 && closed.ledger.relative_residual() <= 1e-15, "{e} {h}: {seen:?}");
        assert!((closed.q[2] - page.q[2]).abs() <= 10.0 * h, "{e} {h}: {} {}", closed.q[2], page.q[2]);
    }
}

fn paper_beam() -> Arc<Beam> {
    let mut spec = BeamSpec::new(0.36, 20, Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap());
    spec.damping.viscous = spec.viscous_for_ratio(1, 0.01).unwrap();
    Arc::new(Beam::new(spec).unwrap())
}

/// "Rests" has to mean it: over 100 s a block on an incline moves by less than a thousandth of a nanometre.
#[test]
fn a_block_on_an_incline_doesn_t_creep() {
    let (sin, cos) = 10.0_f64.to_radians().sin_cos();
    for e in [0.0, 0.8] {
        for closed in [false, true] {
            let law = PairLaw::new(0.5, e);
            let gravity = Vector2::new(-9.81 * sin, -9.81 * cos);
            let model = model(&FLAT_BLOCK, gravity, law, Kinematics::Deformed, Box::new(Ground::flat(0.0)));
            let start = [0.0, 0.5 * FLAT_BLOCK.height, 0.0];
            let (state, _) = take(&model, &start, &[0.0; 3], 1e-3, 100_000, closed);
            let moved = state.q.iter().zip(&start).map(|(q, q0)| (q - q0).abs()).fold(0.0, f64::max);
            assert!(moved < 1e-12, "e = {e}, closed {closed}: {:?} {:?}", state.q, state.v);
        }
    }
}

/// Thrown up an incline, a block stops after v²/(2g(sin β + μ cos β)). In the step in which it stops, sticking would take an
/// impulse along the slide that was: it sticks one step later, and no step gets energy from contact.
#[test]
fn a_slide_that_turns_within_a_step_ends_where_it_must() {
    let (sin, cos) = 10.0_f64.to_radians().sin_cos();
    let gravity = Vector2::new(-9.81 * sin, -9.81 * cos);
    let law = PairLaw::new(0.5, 0.0);
    let model = model(&FLAT_BLOCK, gravity, law, Kinematics::Deformed, Box::new(Ground::flat(0.0)));
    let way = 1.0 / (2.0 * 9.81 * (sin + 0.5 * cos));
    let mut guarded = 0;
    for h in [1e-3, 0.93e-3, 0.87e-3, 1e-4] {
        let start = [0.0, 0.5 * FLAT_BLOCK.height, 0.0];
        let (state, seen) = take(&model, &start, &[1.0, 0.0, 0.0], h, (1.0 / h) as u64, true);
        let (off, speed) = ((state.q[0] - way).abs(), state.v.iter().fold(0.0_f64, |most, v| most.max(v.abs())));
        // Off by the velocity that is left of the last step of the slide, times the step.
        assert!(off <= 9.81 * h * h, "{h}: {off:e}");
        assert!(speed <= 1e-15, "{h}: {speed:e}");
        assert_eq!(state.ledger.positive_contact_work.steps, 0, "{h}");
        assert!(seen.largest_work <= 1e-11, "{h}");
        guarded += u32::from(off > 1e-12);
    }
    assert!(guarded > 0, "some stop falls within a step");
}

/// An approach by less than the gap tolerance a step is an approach all the same.
#[test]
fn no_approach_is_too_slow_to_be_seen() {
    for e in [0.0, 1.0] {
        let surface = Box::new(Ground::flat(0.0));
        let model = model(&FLAT_BLOCK, Vector2::zeros(), PairLaw::new(0.5, e), Kinematics::Deformed, surface);
        let start = [0.0, 0.5 * FLAT_BLOCK.height, 0.0];
        let (state, _) = take(&model, &start, &[0.0, -1e-7, 0.0], 1e-6, 1000, true);
        assert!((state.v[1] - e * 1e-7).abs() < 1e-18 && state.tally.max_penetration < 2e-12, "{e}: {state:?}");
    }
}

/// A foot that was stopped stays closed, however rounding has its velocity end: else the block stands on the other one alone, above the
/// ground by where the impact fell in its step, and rocks.
#[test]
fn a_block_that_lands_flat_stays_on_both_feet() {
    let model = ground(PairLaw::new(0.5, 0.0));
    for h in [3e-5, 1e-4, 3e-4, 1e-3] {
        let (state, _) = take(&model, &[0.18, 0.0675, 0.0], &[0.0, 0.05, 0.0], h, 2000, true);
        assert_eq!(state.warm.ids().len(), 2, "{h}");
        assert!(state.v.iter().all(|v| v.abs() < 1e-14) && state.q[2].abs() < 1e-14, "{h}: {:?}", (state.q, state.v));
    }
}

/// Forty blocks lie on the ground, and one falls onto it with a corner ahead: the step in which the corner closes is attempted
/// anew, but only the corner's island is solved in the second attempt, and only the corner is looked at.
#[test]
fn an_attempt_solves_only_the_islands_that_changed() {
    let shape = Rectangle::new(0.1, 0.05).unwrap();
    let mass = MassProperties::rectangle(&shape, 0.1, 2700.0).unwrap();
    let mut parts = ModelBuilder::new();
    let blocks = parts.add(Blocks::new(vec![Block::new(mass, &shape); 41], Vector2::new(0.0, -9.81)));
    let surface = parts.add(Ground::flat(0.0)).body();
    let law = parts.law(PairLaw::new(0.5, 0.0));
    let pair = |pair: u32| PointPair {
        pair,
        law,
        points: shape.corners().to_vec(),
        body: blocks.nth_body(pair),
        surface,
        kinematics: Kinematics::Deformed,
    };
    let model = parts.build(Box::new(PointDetector::new((0..41).map(pair).collect()))).unwrap();
    let mut q: Vec<f64> = (0..41).flat_map(|k| [0.2 * f64::from(k), 0.025, 0.0]).collect();
    let tilt = 0.2_f64;
    q[120 + 1] = 0.05 * tilt.sin() + 0.025 * tilt.cos() + 0.0025;
    q[120 + 2] = tilt;
    let mut state = State::new(&model, &q, &[0.0; 123], 1e-3).unwrap();
    let mut work = workspace(&model);
    let mut scheme = MoreauJeanClosed::new(MoreauJeanClosedSettings::default()).unwrap();
    let mut step = |steps: u64, state: &mut State| {
        let before = work.counts;
        let ended = run(&model, &mut scheme, state, &mut work, &Plan::steps(steps), &mut []).unwrap();
        assert_eq!(ended, Ended::Complete);
        let now = work.counts;
        let attempts = now.refused_attempts - before.refused_attempts;
        (attempts, now.problems - before.problems, now.detections - before.detections)
    };
    // All blocks close at once. Between the attempts all are located at their start, then twice ahead.
    assert_eq!(step(1, &mut state), (1, 40, 5));
    // At rest: the closed contacts are located twice ahead, and all bodies are looked at once.
    assert_eq!(step(2, &mut state), (0, 40, 3));
    let mut struck = false;
    for n in 3..60 {
        let (attempts, problems, detections) = step(n, &mut state);
        if attempts == 1 {
            // Not 81 problems.
            assert_eq!((problems, detections), (41, 7), "step {n}");
            struck = true;
            break;
        }
    }
    assert!(struck);
    assert!(state.q[..120].iter().zip(&q).all(|(now, start)| (now - start).abs() <= 1e-12));
}
