//! Every state reads back, from a format for people (JSON) and from one for machines (postcard).

use crate::scenes::{PAPER_BLOCK, beam_body, workspace};
use nalgebra::Vector2;
use proptest::prelude::*;
use std::sync::Arc;
use teeter_beam::{Beam, BeamSpec, Section};
use teeter_detect::{ContactId, Kinematics};
use teeter_integrator::*;

/// The state as both formats give it back; by their text, as NaN is not equal to itself.
fn read_back(state: &State) {
    let json = serde_json::to_string(state).unwrap();
    assert!(!json.contains("null"), "a number was lost: {json}");
    let from_json: State = serde_json::from_str(&json).unwrap_or_else(|error| panic!("{error}: {json}"));
    assert_eq!(format!("{from_json:?}"), format!("{state:?}"));
    let bytes = postcard::to_allocvec(state).unwrap();
    let from_bytes: State = postcard::from_bytes(&bytes).unwrap();
    assert_eq!(postcard::to_allocvec(&from_bytes).unwrap(), bytes);
    assert_eq!(format!("{from_bytes:?}"), format!("{state:?}"));
}

fn laws() -> Vec<PairLaw> {
    let law = PairLaw::new(0.5, 0.4);
    vec![
        PairLaw::new(0.5, 0.0),
        law,
        law.with_impact(ImpactLaw::Poisson).with_tangential_restitution(0.3),
        law.with_impact(ImpactLaw::Energetic),
        law.with_impact(ImpactLaw::KelvinVoigt { stiffness: 1e5, damping: 10.0 }),
        law.with_impact(ImpactLaw::HuntCrossley { stiffness: 1e6, damping: 0.5, exponent: 1.5 }),
    ]
}

#[test]
fn a_state_reads_back_at_the_start_and_after_steps_of_every_scheme_and_law() {
    let beam =
        Arc::new(Beam::new(BeamSpec::new(0.36, 20, Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap())).unwrap());
    for law in laws() {
        for on_beam in [false, true] {
            let surface: Box<dyn Subsystem<2>> =
                if on_beam { Box::new(beam_body(&beam)) } else { Box::new(Ground::flat(0.0)) };
            let model =
                crate::scenes::model(&PAPER_BLOCK, Vector2::new(0.0, -9.81), law, Kinematics::Deformed, surface);
            let mut q = vec![0.1, 0.0676, 0.05];
            q.resize(model.size().q, 0.0);
            let schemes: [Box<dyn Scheme<2>>; 2] = [
                Box::new(MoreauJean::new(MoreauJeanSettings::default()).unwrap()),
                Box::new(MoreauJeanClosed::new(MoreauJeanClosedSettings::default()).unwrap()),
            ];
            for mut scheme in schemes {
                let mut state = State::new(&model, &q, &vec![0.0; model.size().v], 1e-4).unwrap();
                read_back(&state);
                let mut work = workspace(&model);
                for step in 0..600 {
                    scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap();
                    if step % 97 == 0 {
                        read_back(&state);
                    }
                }
                assert!(state.tally.contact_steps > 0, "it touched");
                read_back(&state);
                // What was read goes on to the same bytes.
                let mut read: State = serde_json::from_str(&serde_json::to_string(&state).unwrap()).unwrap();
                scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap();
                scheme.advance(&model, &mut read, f64::INFINITY, &mut work).unwrap();
                assert_eq!(read, state);
            }
        }
    }
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => any::<f64>(),
        1 => Just(f64::INFINITY),
        1 => Just(f64::NEG_INFINITY),
        1 => Just(f64::NAN),
        1 => Just(-0.0),
        1 => Just(5e-324),
        1 => Just(f64::MAX),
        1 => (-5_i32..5).prop_map(f64::from),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn a_state_of_any_numbers_reads_back(
        x in prop::collection::vec(any_number(), 26),
        lists in prop::collection::vec(prop::collection::vec(any_number(), 0..6), 3),
        contacts in prop::collection::vec((any::<u32>(), any_number(), any_number()), 0..5),
        counts in prop::collection::vec(any::<u32>(), 6),
    ) {
        let ground = Box::new(Ground::flat(0.0));
        let law = PairLaw::new(0.5, 0.0);
        let model = crate::scenes::model(&PAPER_BLOCK, Vector2::zeros(), law, Kinematics::Deformed, ground);
        let mut state = State::new(&model, &[0.0; 3], &[0.0; 3], 1e-4).unwrap();
        let mut next = x.into_iter();
        let mut number = || next.next().unwrap();
        let mut energy = || Energy { kinetic: number(), elastic: number(), gravity: number() };
        let (initial, current) = (energy(), energy());
        state.ledger = Ledger {
            initial,
            current,
            sum: StepEnergy {
                external: number(),
                contact: number(),
                friction: number(),
                viscous: number(),
                numerical: number(),
                projection: number(),
                residual: number(),
            },
            largest_residual: number(),
            scale: number(),
            stored: number(),
            positive_contact_work: PositiveWork { steps: u64::from(counts[0]), largest: number(), sum: number() },
            largest_tangential_work: number(),
        };
        state.tally = Tally {
            max_penetration: number(),
            max_residual: number(),
            max_contact_residual: number(),
            max_iterations: counts[1],
            max_contacts: counts[2] as usize,
            contact_steps: u64::from(counts[3]),
            unconverged_steps: u64::from(counts[4]),
            unlocated_steps: u64::from(counts[4]),
        };
        (state.t, state.dt, state.step) = (number(), number(), u64::from(counts[5]));
        let memory: Vec<f64>;
        [state.q, state.v, memory] = lists.try_into().unwrap();
        state.memory.set_numbers(&memory);
        for (id, p, t) in contacts {
            state.warm.push(ContactId::new(id, id), &Vector2::new(p, t));
        }
        read_back(&state);
    }
}
