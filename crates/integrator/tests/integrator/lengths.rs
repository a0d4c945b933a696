//! No public function panics at slices of a wrong length, or at states that were tampered with: it gives an error.

use crate::scenes::{PAPER_BLOCK, beam_body, workspace};
use nalgebra::Vector2;
use proptest::prelude::*;
use std::sync::Arc;
use teeter_beam::{Beam, BeamSpec, Section};
use teeter_detect::{Anchor, BodyId, Candidate, ContactId, Kinematics, LawId, plane_frame};
use teeter_integrator::*;

fn beam() -> Arc<Beam> {
    Arc::new(Beam::new(BeamSpec::new(0.36, 3, Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap())).unwrap())
}

fn model(law: PairLaw) -> Model<2> {
    let surface = Box::new(beam_body(&beam()));
    crate::scenes::model(&PAPER_BLOCK, Vector2::new(0.0, -9.81), law, Kinematics::Deformed, surface)
}

/// A length, right in half of the cases.
fn length(right: usize) -> impl Strategy<Value = usize> {
    prop_oneof![Just(right), 0..2 * right + 2]
}

/// Numbers of this length: small, so that a right one is a state to step from.
fn numbers(len: usize) -> Vec<f64> {
    (0..len).map(|k| if k == 1 { 0.0675 } else { 0.0 }).collect()
}

/// A block, and the four of a beam.
const BODIES: u32 = 5;

fn candidate(pair: u32, bodies: [u32; 2]) -> Candidate<2> {
    let sides = bodies.map(|body| Anchor { body: BodyId(body), point: Vector2::new(0.01, 0.0) });
    Candidate { id: ContactId::new(pair, 0), law: LawId(pair), sides, frame: plane_frame(&Vector2::y()), gap: 0.0 }
}

/// Coordinates and velocities of the block and the beam of three elements.
const SIZE: usize = 3 + 2 * 4;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(192))]

    #[test]
    fn models(q in length(SIZE), v in length(SIZE), out in length(SIZE), pair in 0_u32..3, bodies in [0_u32..7, 0_u32..7]) {
        let model = model(PairLaw::new(0.5, 0.0));
        assert_eq!((model.size().q, model.size().v), (SIZE, SIZE));
        let (right_q, right_v) = (q == SIZE, v == SIZE);
        let (q, mut v, mut out) = (numbers(q), numbers(v), numbers(out));
        prop_assert_eq!(model.placed(&q).is_ok(), right_q);
        prop_assert_eq!(model.energy(&q, &v).is_ok(), right_q && right_v);
        prop_assert_eq!(model.drive(0.1, &mut v).is_ok(), right_v);
        prop_assert_eq!(model.retract(&q, &v, 0.1, &mut out).is_ok(), right_q && right_v && out.len() == SIZE);
        let known = pair == 0 && bodies.iter().all(|body| *body < BODIES);
        let velocity = model.relative_velocity(&candidate(pair, bodies), &q, &v);
        prop_assert_eq!(velocity.is_ok(), right_q && right_v && known);
        prop_assert_eq!(model.law(LawId(pair)).is_ok(), pair == 0);
        prop_assert_eq!(model.owner(BodyId(bodies[0])).is_some(), bodies[0] < BODIES);
        prop_assert_eq!(State::new(&model, &q, &v, 1e-4).is_ok(), right_q && right_v);
        prop_assert_eq!(State::at(&model, u64::MAX, &q, &v, 1e-4).is_ok(), right_q && right_v);
        let limits = SettlingLimits { reach: &[], margin: 0.01, tau: SettlingLimits::FIRST_TAU };
        let settled = settle(&model, 0.0, &q, &limits, &mut workspace(&model));
        prop_assert_eq!(matches!(settled, Err(EquilibriumError::Mismatch(_))), !right_q);
        let forces = [(ContactId::new(pair, 0), Vector2::new(1.0, 0.0))];
        let modes = coupled_modes(&model, &q, &forces, 3);
        let mut found = Vec::new();
        let looked = model.candidates(&q, f64::INFINITY, &mut found).is_ok();
        let there = looked && found.iter().any(|candidate| candidate.id == forces[0].0);
        prop_assert_eq!(matches!(modes, Err(CoupledModesError::Mismatch(_))), !there);
    }

    #[test]
    fn steps(
        q in length(SIZE),
        v in length(SIZE),
        contacts in prop::collection::vec((0_u32..3, 0_u32..6), 0..4),
        space in any::<bool>(),
        step in prop_oneof![Just(0), Just(u64::MAX), any::<u64>()],
        t in prop_oneof![Just(0.0), Just(f64::NAN), Just(f64::INFINITY), -1e3_f64..1e3],
        dt in prop_oneof![Just(1e-4), Just(0.0), Just(-1.0), Just(f64::NAN), Just(f64::INFINITY)],
        law in prop_oneof![
            Just(PairLaw::new(0.5, 0.3)),
            Just(PairLaw::new(0.5, 0.3).with_impact(ImpactLaw::Poisson)),
            Just(PairLaw::new(0.5, 0.3).with_impact(ImpactLaw::KelvinVoigt { stiffness: 1e5, damping: 1.0 })),
        ],
    ) {
        let model = model(law);
        let schemes: [Box<dyn Scheme<2>>; 2] = [
            Box::new(MoreauJean::new(MoreauJeanSettings::default()).unwrap()),
            Box::new(MoreauJeanClosed::new(MoreauJeanClosedSettings::default()).unwrap()),
        ];
        for mut scheme in schemes {
            let fresh = State::new(&model, &numbers(SIZE), &[0.0; SIZE], 1e-4).unwrap();
            let mut state = fresh.clone();
            (state.q, state.v) = (numbers(q), numbers(v));
            (state.step, state.t, state.dt) = (step, t, dt);
            for (pair, point) in &contacts {
                let id = ContactId::new(*pair, *point);
                if space {
                    state.warm.push(id, &nalgebra::Vector3::zeros());
                } else {
                    state.warm.push(id, &Vector2::zeros());
                }
            }
            let sorted = contacts.is_sorted_by(|a, b| a < b);
            let fits = (q, v) == (SIZE, SIZE)
                && step < u64::MAX
                && t.is_finite()
                && dt == 1e-4
                && sorted
                && (contacts.is_empty() || !space);
            prop_assert_eq!(state.check(&model).is_ok(), fits);
            let before = format!("{state:?}");
            let mut work = workspace(&model);
            let result = scheme.advance(&model, &mut state, f64::INFINITY, &mut work);
            if !fits {
                prop_assert!(matches!(result, Err(StepError::State(_))), "{result:?}");
                prop_assert_eq!(format!("{state:?}"), before, "the state is as before");
                prop_assert!(matches!(scheme.start(&model, &mut state, &mut work), Err(StepError::State(_))));
                let plan = Plan::steps(3);
                state.step = state.step.min(1);
                if state.check(&model).is_err() {
                    let ended = run(&model, scheme.as_mut(), &mut state, &mut work, &plan, &mut []).unwrap();
                    prop_assert!(matches!(ended, Ended::Failed(StepError::State(_))), "{ended:?}");
                }
            }
            // And it goes on with a state that fits.
            let mut state = fresh;
            prop_assert!(scheme.advance(&model, &mut state, f64::INFINITY, &mut work).is_ok());
        }
    }

    #[test]
    fn workspaces_and_contact_sets(
        q in length(SIZE),
        v in length(SIZE),
        scratch in length(SIZE),
        contact in 0_usize..4,
        pair in 0_u32..2,
        bodies in [0_u32..6, 0_u32..6],
    ) {
        let model = model(PairLaw::new(0.5, 0.0));
        let mut work = workspace(&model);
        let right = q == SIZE;
        let (q, mut v) = (numbers(q), numbers(v));
        let w = Weights { mass: 1.0, damping: 1e-4, stiffness: 1e-8 };
        let mut out = Vec::new();
        prop_assert_eq!(work.factors(&model, w, &q, Keep::Pinned).is_ok(), right);
        prop_assert_eq!(work.detect(&model, &q, 0.1).is_ok(), right);
        prop_assert_eq!(work.locate(&model, &q, &[ContactId::new(pair, 9)], &mut out).is_ok(), right);
        prop_assert_eq!(work.penetration(&model, &q).is_ok(), right);
        let (warm, memory, mut stage) = (WarmStart::default(), Memory::default(), ContactStage::new());
        let known = pair == 0 && bodies.iter().all(|body| *body < BODIES);
        let added = stage.add(&model, &q, &candidate(pair, bodies), &warm, &memory).is_ok();
        prop_assert_eq!(added, right && known);
        let there = added && contact == 0;
        prop_assert_eq!(stage.velocity(contact, &v).is_ok(), there && v.len() == SIZE);
        let zero = Vector2::zeros();
        let state = State::new(&model, &numbers(SIZE), &numbers(SIZE), 1e-4).unwrap();
        let over = Over::Step { h: 1e-4, weight: 0.5 };
        prop_assert_eq!(stage.pose(&model, &state, &v, &v, over).is_ok(), !added || v.len() == SIZE);
        let set = stage.set(contact, zero, Vector2::new(-1.0, 0.0), zero, Rule::Shifted).is_ok();
        prop_assert_eq!(set, there);
        prop_assert_eq!(stage.update_row(contact, 0.0, &v).is_ok(), there && v.len() == SIZE);
        prop_assert_eq!(stage.rows_at(contact, &model, &q, &candidate(pair, bodies)).is_ok(), there);
        prop_assert_eq!(stage.add_compliance(contact, Default::default()).is_ok(), there);
        prop_assert_eq!(stage.complete(&v).is_ok(), !added || v.len() == SIZE);

        // Its memory was meddled with.
        work.factors(&model, w, &numbers(SIZE), Keep::Pinned).unwrap();
        work.scratch.resize(scratch, 0.0);
        let responses = Responses::Of(w);
        let solved = stage.solve(&model, &mut work, &responses, over);
        // Between a body and itself there is nothing to solve.
        let posed = set || v.len() == SIZE;
        let solvable = scratch == SIZE && posed && (bodies[0] == 0) != (bodies[1] == 0);
        if added {
            prop_assert_eq!(solved.is_ok(), solvable, "{:?}", solved);
            if solvable {
                prop_assert_eq!(stage.respond(&model, &mut work, &responses, &mut v).is_ok(), v.len() == SIZE);
            }
        }
    }

    #[test]
    fn section_forces(start in 0_usize..15, len in length(8), q in 0_usize..20, v in 0_usize..20, y in 0_usize..20) {
        let model = model(PairLaw::new(0.5, 0.0));
        let mut state = State::new(&model, &numbers(SIZE), &[0.0; SIZE], 1e-4).unwrap();
        (state.q, state.v) = (numbers(q), numbers(v));
        for lifted in [None, Some(y)] {
            let mut forces = BeamForces::new(&beam(), BodyId(1), start..start + len);
            if let Some(y) = lifted {
                forces = forces.with_supports(y);
            }
            let needed = (start + len).max(lifted.map_or(0, |y| y + 1));
            let fits = len == 8 && needed <= q && needed <= v;
            prop_assert_eq!(forces.start(&state, None).is_ok(), fits);
        }
    }
}
