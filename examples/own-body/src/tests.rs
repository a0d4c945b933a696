//! Exact answers for the example.

use super::*;
use std::f64::consts::PI;
use std::ops::ControlFlow;
use teeter_detect::Kinematics;
use teeter_integrator::conformance::{Case, check};
use teeter_integrator::{Bodies, Contact, ObserverError, StepReport, Weights};

/// Ends a run with the step of the first hit, and keeps its contacts.
#[derive(Default)]
struct UntilHit(Vec<Contact<2>>);

impl Observer<2> for UntilHit {
    fn observe(&mut self, _: &Model<2>, step: &StepReport<'_, 2>, _: &State) -> Result<ControlFlow<()>, ObserverError> {
        if !step.contacts().any(|contact| contact.id.pair() == HIT) {
            return Ok(ControlFlow::Continue(()));
        }
        self.0 = step.contacts().copied().collect();
        Ok(ControlFlow::Break(()))
    }
}

/// Without weight and friction, the block's upper right corner meets the hanging rod at depth a
/// below its pivot, with impulse P, and is turned; its lower left corner stays on the floor, with
/// impulse N; the lower right one lifts:
///
/// ```text
/// m (v⁺ − v) = −P,   J θ̇⁺ = P a,   (I + m b²/4) ω⁺ = P H/2,   N = m b ω⁺/2,
/// v⁺ − ω⁺ H/2 − a θ̇⁺ = −e v
/// ```
#[test]
fn an_impact_has_the_velocities_of_the_closed_form() {
    let rod = Pendulum { gravity: 0.0, ..ROD };
    let ([b, height], speed) = (SIDES, 1.5);
    for e in [0.0, 0.6] {
        let mut scene = scene(&rod, [PairLaw::new(0.0, 0.0), PairLaw::new(0.0, e)], speed, 1e-3).unwrap();
        let mut hit = UntilHit::default();
        simulate(&mut scene, 1000, &mut hit).unwrap();

        let MassProperties { mass, inertia } = block().unwrap().1;
        let depth = rod.pivot.y - height;
        let about_foot = inertia + mass * b * b / 4.0;
        let compliance = 1.0 / mass + height * height / 4.0 / about_foot + depth * depth / rod.inertia();
        let push = (1.0 + e) * speed / compliance;
        let spin = push * height / 2.0 / about_foot;
        let exact = [speed - push / mass, 0.5 * b * spin, spin, push * depth / rod.inertia()];
        for (found, exact) in scene.state.v.iter().zip(exact) {
            // The solver stops at 1e-12 of the impulses, some 0.1 N·s. The contacts' condition
            // number, some 10, and what an impulse does most, 63 rad/s of spin for 1 N·s, make
            // 6e-11 of it.
            assert!((found - exact).abs() < 6e-11, "{:?}, not {exact:?}", scene.state.v);
        }
        let found: Vec<_> = hit.0.iter().map(|contact| (contact.id.pair(), contact.id.point(), contact.p)).collect();
        assert_eq!(found.iter().map(|c| (c.0, c.1)).collect::<Vec<_>>(), [(0, 0), (0, 1), (HIT, 2)]);
        assert!((found[2].2 - Vector2::new(push, 0.0)).norm() < 1e-12);
        assert!((found[0].2 - Vector2::new(0.5 * mass * b * spin, 0.0)).norm() < 1e-12 && found[1].2.norm() < 1e-12);

        // The angular momentum about the pivot changes by the floor's impulse only, wherever that
        // acts.
        let centre = Vector2::new(scene.state.q[0] - 0.5e-3 * scene.state.v[0], 0.5 * height);
        let about_pivot = |v: &[f64]| {
            let r = centre - rod.pivot;
            mass * (r.x * v[1] - r.y * v[0]) + inertia * v[2] + rod.inertia() * v[3]
        };
        let arm = centre.x - 0.5 * b - rod.pivot.x;
        let change = about_pivot(&scene.state.v) - about_pivot(&[speed, 0.0, 0.0, 0.0]);
        assert!((change - arm * found[0].2[0]).abs() < 1e-13, "{change:e}");

        // Work of the hit, −(1−e²)/2 · speed²/compliance; the identity holds to rounding.
        let work = -0.5 * (1.0 - e * e) * speed * speed / compliance;
        assert!((scene.state.ledger.sum.contact - work).abs() < 1e-12);
        assert!(scene.state.ledger.relative_residual() < 1e-15, "{:e}", scene.state.ledger.relative_residual());
    }
}

/// The rod alone, let go at rest: its angle after each step, and the energy that is unexplained by
/// then, J.
struct Swing {
    angles: Vec<f64>,
    unexplained: Vec<f64>,
}

impl Observer<2> for Swing {
    fn observe(
        &mut self,
        _: &Model<2>,
        _: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError> {
        self.angles.push(state.q[3]);
        self.unexplained.push(state.ledger.sum.residual);
        Ok(ControlFlow::Continue(()))
    }
}

/// The block lies still far away, so that all energy is the rod's.
fn swing(from: f64, step: f64, steps: u64) -> (Swing, State) {
    let mut scene = scene(&ROD, [PairLaw::new(0.3, 0.0); 2], 0.0, step).unwrap();
    scene.state = State::new(&scene.model, &[-1.0, 0.5 * SIDES[1], 0.0, from], &[0.0; 4], step).unwrap();
    let mut swing = Swing { angles: vec![from], unexplained: vec![0.0] };
    simulate(&mut scene, steps, &mut swing).unwrap();
    (swing, scene.state)
}

/// Time between the first and the last fall through zero, each linear between steps, over their
/// number.
fn period(angles: &[f64], step: f64) -> f64 {
    let falls: Vec<f64> = (1..angles.len())
        .filter(|&k| angles[k - 1] > 0.0 && angles[k] <= 0.0)
        .map(|k| step * (k as f64 - angles[k] / (angles[k] - angles[k - 1])))
        .collect();
    (falls[falls.len() - 1] - falls[0]) / (falls.len() - 1) as f64
}

#[test]
fn small_swings_take_two_pi_root_i_over_mgl() {
    let omega = (ROD.stiffness() / ROD.inertia()).sqrt();
    let exact = 2.0 * PI / omega;
    let mut errors = Vec::new();
    for step in [4e-3, 2e-3, 1e-3] {
        let found = period(&swing(1e-5, step, (20.0 / step) as u64).0.angles, step);
        // The trapezoidal rule turns a linear oscillator by 2 atan(ωh/2) a step, exactly. What is
        // left is the straight line between steps, √3/108 (ωh)³/ω at most at each end of the 22
        // periods, and θ²/16 of the swing's own.
        let of_the_scheme = PI * step / (0.5 * omega * step).atan();
        let straight = 3.0_f64.sqrt() / 108.0 * (omega * step).powi(3) / omega;
        let bound = 2.0 * straight / 22.0 + 1e-11;
        assert!((found - of_the_scheme).abs() < bound, "{found}, not {of_the_scheme}, at {step}");
        errors.push(found - exact);
    }
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.02, "order {order}");
    }
}

/// What the module page of the pendulum says of its energy account.
#[test]
fn the_energy_account_of_a_wide_swing_is_open_by_the_square_of_the_step() {
    let largest = |swing: &Swing| swing.unexplained.iter().fold(0.0_f64, |most, e| most.max(e.abs()));
    let of = |from: f64, step: f64, time: f64| {
        let (swing, state) = swing(from, step, (time / step) as u64);
        (state.ledger.largest_residual, largest(&swing))
    };
    let [coarse, fine] = [1e-3, 5e-4].map(|step| of(1.2, step, 1.0));
    let orders = [(coarse.0 / fine.0).log2(), (coarse.1 / fine.1).log2()];
    assert!((orders[0] - 3.0).abs() < 0.02 && (orders[1] - 2.0).abs() < 0.02, "{orders:?}");
    // It comes back: after thirty swings as after one.
    let long = of(1.2, 1e-3, 30.0).1;
    assert!((long / coarse.1 - 1.0).abs() < 1e-3, "{long:e} {coarse:?}");
    // A hundredth of the swing leaves a hundredth to the fourth power, but for rounding.
    let small = of(0.012, 1e-3, 1.0).1;
    assert!(small < 1e-7 * coarse.1, "{small:e} {coarse:?}");
}

#[test]
fn the_programs_rod_is_hit_comes_back_and_ends_leaning_on_the_block() {
    let (scene, impacts) = hit().unwrap();
    assert_eq!(impacts.csv().unwrap().lines().count(), impacts.found.len() + 1);
    // The first hit: after sliding 0.1 m at −μg from 1 m/s, to a step of 1e-4 s; and back with a
    // fifth of the speed.
    let (pull, first) = (0.3 * 9.81, impacts.found[0]);
    let speed = (1.0 - 2.0 * pull * DISTANCE).sqrt();
    assert!((first.t - (1.0 - speed) / pull).abs() < 1.5e-4, "{first:?}");
    assert!(
        (first.u_n[0] + speed).abs() < 2e-4 * pull && (first.u_n[1] + 0.2 * first.u_n[0]).abs() < 1e-10,
        "{first:?}"
    );
    assert!(impacts.found.len() > 2 && impacts.found.iter().all(|impact| impact.work < 0.0 && impact.point == 2));
    assert!(scene.state.v.iter().all(|v| v.abs() < 1e-10), "at rest: {:?}", scene.state.v);
    assert!(scene.state.q[3] > 0.05 && scene.state.tally.unconverged_steps == 0);
}

/// Block and platform swing as one mass about their place of rest. The trapezoidal rule turns a
/// linear oscillator by 2 atan(ωh/2) a step, exactly: what is left is the solver's tolerance.
#[test]
fn a_block_on_a_platform_swings_with_it() {
    let (stiffness, step) = (800.0, 1e-3);
    let mut scene = put_down(stiffness, step).unwrap();
    let mass = PLATFORM + block().unwrap().1.mass;
    let omega = (stiffness / mass).sqrt();
    let amplitude = mass * 9.81 / stiffness;
    let turn = 2.0 * (0.5 * omega * step).atan();
    for steps in [100_u64, 150, 400] {
        simulate(&mut scene, steps, &mut Impacts::of(HIT)).unwrap();
        let q = -amplitude * (1.0 - (turn * steps as f64).cos());
        assert!((scene.state.q[3] - q).abs() < 1e-11, "after {steps} steps {:e}, not {q:e}", scene.state.q[3]);
        assert!((scene.state.q[1] - 0.5 * SIDES[1] - q).abs() < 1e-11);
    }
    assert!(scene.state.ledger.relative_residual() < 1e-14, "{:e}", scene.state.ledger.relative_residual());
}

#[test]
fn the_platform_is_what_the_integrator_asks_of_a_subsystem() {
    let platform = Platform { matrices: ConstantMatrices::mass([[2.0]]).with_stiffness([[500.0]]), weight: 20.0 };
    let case = Case {
        q: vec![0.07],
        weights: Weights { mass: 1.0, damping: 0.05, stiffness: 2.5e-3 },
        points: vec![(0, Vector2::new(0.3, 0.0))],
        places: vec![(0, Vector2::new(0.3, 0.3)), (0, Vector2::new(0.1, 0.01))],
        ..Case::default()
    };
    assert_eq!(check(&platform, &case), []);
}

/// Not at the origin, and with all numbers different.
const ANY: Pendulum =
    Pendulum { pivot: Vector2::new(0.1, 0.4), length: 0.3, half_thickness: 0.002, mass: 0.2, gravity: 9.81 };

#[test]
fn it_is_what_the_integrator_asks_of_a_subsystem() {
    let case = Case {
        q: vec![0.7],
        weights: Weights { mass: 1.0, damping: 0.0, stiffness: 2.5e-3 },
        points: vec![(0, Vector2::new(0.002, -0.2)), (0, Vector2::new(-0.002, -0.3))],
        places: vec![(0, Vector2::new(0.3, 0.3)), (0, Vector2::new(0.1, 0.2))],
        ..Case::default()
    };
    assert_eq!(check(&ANY, &case), []);
}

#[test]
fn the_foot_is_on_the_nearer_face_and_within_the_rod() {
    let q = [0.5];
    for (side, along) in [(1.0, 0.2), (-1.0, 0.29)] {
        let mut at = [Vector2::zeros()];
        ANY.place(0, &q, &[Vector2::new(side * 0.01, -along)], &mut at);
        let foot = ANY.surface(0, &q, Kinematics::Deformed, &at[0]).unwrap();
        assert!((foot.normal.dot(&(at[0] - foot.place)) - 0.008).abs() < 1e-15);
        assert!((foot.material - Vector2::new(side * 0.002, -along)).norm() < 1e-15);
    }
    for beyond in [0.001, -0.301] {
        let mut at = [Vector2::zeros()];
        ANY.place(0, &q, &[Vector2::new(0.01, beyond)], &mut at);
        assert_eq!(ANY.surface(0, &q, Kinematics::Deformed, &at[0]), None);
    }
}
