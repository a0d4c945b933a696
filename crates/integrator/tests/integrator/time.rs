//! Time is right for any sequence of step sizes.

use crate::scenes::{PAPER_BLOCK, all_schemes, workspace};
use nalgebra::Vector2;
use proptest::prelude::*;
use teeter_detect::{Kinematics, PointDetector};
use teeter_integrator::*;
use teeter_rigid::{MassProperties, Rectangle};

fn sine(given: Given, amplitude: f64) -> Motion {
    Motion::still().with(given, amplitude, std::sync::Arc::new(Formula::harmonic(0.0, 7.0, 0.3).unwrap()))
}

/// A block that is driven along x.
fn driven() -> (Model<2>, Motion) {
    let shape = Rectangle::new(0.1, 0.1).unwrap();
    let mass = MassProperties::rectangle(&shape, 0.1, 1000.0).unwrap();
    let motion = sine(Given::Velocity, 0.5);
    let blocks = Blocks::new(vec![Block::new(mass, &shape)], Vector2::new(0.0, -9.81));
    let mut parts = ModelBuilder::new();
    parts.add(blocks.with_motion(0, BlockCoordinate::X, motion.clone()).unwrap());
    (parts.build(Box::new(PointDetector::new(Vec::new()))).unwrap(), motion)
}

#[test]
fn a_changed_step_size_goes_on_from_the_time_that_it_is() {
    for mut scheme in all_schemes(&[]) {
        let law = PairLaw::new(0.5, 0.0);
        let ground = Box::new(Ground::flat(0.0));
        let model = crate::scenes::model(&PAPER_BLOCK, Vector2::new(0.0, -9.81), law, Kinematics::Deformed, ground);
        let mut state = State::new(&model, &[0.0, 0.0775, 0.0], &[0.0; 3], 1e-5).unwrap();
        let mut work = workspace(&model);
        scheme.start(&model, &mut state, &mut work).unwrap();
        for _ in 0..100 {
            scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap();
        }
        assert_eq!(state.t, 100.0 * 1e-5);
        state.dt = 2e-5;
        let step = scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap();
        assert_eq!((step.step, step.t_start, step.t_end), (101, 1e-3, 1e-3 + 2e-5));
        for k in 2..=1000 {
            let step = scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap();
            assert_eq!(step.t_end, 1e-3 + f64::from(k) * 2e-5, "counted, not summed");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn time_and_what_is_prescribed_are_right_for_any_sequence_of_steps(
        sizes in prop::collection::vec((1e-6_f64..1e-2, 1_usize..5), 1..12)
    ) {
        for mut scheme in all_schemes(&[]) {
            let (model, motion) = driven();
            let mut state = State::new(&model, &[0.0; 3], &[0.0; 3], sizes[0].0).unwrap();
            let mut work = workspace(&model);
            scheme.start(&model, &mut state, &mut work).unwrap();
            let (mut elapsed, mut steps) = (0.0, 0);
            for &(dt, count) in &sizes {
                state.dt = dt;
                for _ in 0..count {
                    let before = state.t;
                    let step = scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap();
                    (elapsed, steps) = (elapsed + dt, steps + 1);
                    prop_assert_eq!((step.step, step.t_start, step.t_end), (steps, before, state.t));
                    prop_assert!((state.t - elapsed).abs() <= 1e-14, "{} instead of {elapsed}", state.t);
                    // Driven at the true time, by the mean about it; and what falls freely is as fast as that time makes it.
                    let theta = scheme.drives_about();
                    let expected = theta.map_or(motion.velocity(state.t), |_| motion.mean_velocity(state.t - 0.5 * dt, state.t + 0.5 * dt));
                    prop_assert_eq!(state.v[0], expected);
                    prop_assert!((state.v[1] + 9.81 * elapsed).abs() < 1e-13);
                }
            }
        }
    }

    #[test]
    fn a_fixed_step_from_zero_is_counted(dt in 1e-7_f64..1e-1, steps in 1_u64..200) {
        let (model, _) = driven();
        for mut scheme in all_schemes(&[]) {
            let mut state = State::new(&model, &[0.0; 3], &[0.0; 3], dt).unwrap();
            let mut work = workspace(&model);
            for k in 1..=steps {
                scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap();
                prop_assert_eq!(state.t, k as f64 * dt);
            }
            // And a state taken up at a later step counts as if it had come there.
            let mut later = State::at(&model, steps, &state.q, &state.v, dt).unwrap();
            scheme.advance(&model, &mut later, f64::INFINITY, &mut work).unwrap();
            prop_assert_eq!(later.t, (steps + 1) as f64 * dt);
        }
    }
}
