//! What loads give over a step is right to rounding, however long the step is beside the signal:
//! every kind of signal, over random steps with jumps and kinks in them; and drives lead where
//! their signals do.

use crate::scenes::all_schemes;
use nalgebra::Vector2;
use std::sync::Arc;
use teeter_beam::{Beam, BeamSpec, Load, ModalBasis, MovingLoad, Section, Support};
use teeter_detect::PointDetector;
use teeter_integrator::*;
use teeter_rigid::{MassProperties, Rectangle};

/// Numbers without a pattern in [0, 1): the same in every run.
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn within(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.next()
    }
}

/// A signal with the times at which it has jumps or kinks, and a time in which it doesn't change
/// much between them.
type Known = (Arc<dyn Signal>, Vec<f64>, f64);

fn drawn(draw: &mut Draw) -> Vec<Known> {
    let start = draw.within(-0.5, 1.0);
    let (duration, frequency) = (10_f64.powf(draw.within(-4.0, 0.0)), 10_f64.powf(draw.within(-1.0, 3.0)));
    let (phase, slow) = (draw.within(0.0, 6.0), 0.05 / frequency);
    let sine_end = (std::f64::consts::TAU - phase) / (std::f64::consts::TAU * frequency);
    let rows = 2 + (20.0 * draw.next()) as usize;
    let mut t = start;
    let times: Vec<f64> = (0..rows)
        .map(|_| {
            t += 10_f64.powf(draw.within(-4.0, -0.5));
            t
        })
        .collect();
    let values = (0..rows).map(|_| draw.within(-3.0, 3.0)).collect();
    let formula = |made: Result<Formula, SignalError>| -> Arc<dyn Signal> { Arc::new(made.unwrap()) };
    vec![
        (formula(Formula::constant(start)), vec![start], 1.0),
        (formula(Formula::ramp(start, duration)), vec![start, start + duration], 1.0),
        (formula(Formula::harmonic(start, frequency, phase)), vec![start], slow),
        (formula(Formula::one_sine(start, frequency, phase)), vec![start, start + sine_end], slow),
        (formula(Formula::half_sine(start, duration)), vec![start, start + duration], 0.1 * duration),
        (formula(Formula::ricker(start, frequency)), vec![start - 3.0 / frequency, start + 3.0 / frequency], slow),
        (Arc::new(Table::new(times.clone(), values).unwrap()), times, 1.0),
    ]
}

/// Gauss' points of a stretch, in pieces no longer than `fine` and without a kink inside, and their
/// shares of its mean.
fn points(from: f64, to: f64, kinks: &[f64], fine: f64) -> Vec<(f64, f64)> {
    let mut ends = vec![from, to];
    ends.extend(kinks.iter().copied().filter(|t| *t > from && *t < to));
    ends.sort_by(f64::total_cmp);
    let (p, q) = (0.906_179_845_938_664, 0.538_469_310_105_683_1);
    let (wp, wq, w0) = (0.236_926_885_056_189_08, 0.478_628_670_499_366_47, 0.568_888_888_888_888_9);
    let mut points = Vec::new();
    for piece in ends.windows(2) {
        let parts = ((piece[1] - piece[0]) / fine).ceil().clamp(4.0, 40_000.0);
        let half = 0.5 * (piece[1] - piece[0]) / parts;
        for k in 0..parts as u32 {
            let middle = piece[0] + f64::from(2 * k + 1) * half;
            let share = half / (to - from);
            points
                .extend([(-p, wp), (-q, wq), (0.0, w0), (q, wq), (p, wp)].map(|(s, w)| (middle + s * half, share * w)));
        }
    }
    points
}

/// The mean of `f` over a stretch, by these points.
fn quadrature(f: impl Fn(f64) -> f64, from: f64, to: f64, kinks: &[f64], fine: f64) -> f64 {
    points(from, to, kinks, fine).into_iter().map(|(t, share)| share * f(t)).sum()
}

/// Steps of every size, at kinks and away from them.
fn steps(draw: &mut Draw, kinks: &[f64]) -> Vec<[f64; 2]> {
    let mut steps = Vec::new();
    for _ in 0..6 {
        let h = 10_f64.powf(draw.within(-5.0, -0.3));
        let about = kinks[(draw.next() * kinks.len() as f64) as usize] + draw.within(-1.5, 1.5) * h;
        let from = about.max(0.0);
        steps.push([from, from + h]);
    }
    // From a kink to a kink, where there are two.
    let late: Vec<f64> = kinks.iter().copied().filter(|t| *t >= 0.0).collect();
    steps.extend(late.windows(2).map(|pair| [pair[0], pair[1]]));
    steps
}

#[test]
fn means_of_signals_rates_integrals_and_moments_are_exact_over_any_step() {
    means_are_exact(Draw(7), drawn);
}

/// Chirps and sums. They start at 0 or later, as the digits of a time since the start are counted by
/// the time.
fn drawn_composed(draw: &mut Draw) -> Vec<Known> {
    let (start, duration) = (draw.within(0.0, 1.0), draw.within(0.01, 1.0));
    let (frequency, phase) = (10_f64.powf(draw.within(-1.0, 3.0)), draw.within(0.0, 6.0));
    // The points that check must be close for the growth of the frequency, too.
    let (kinks, slow) = (vec![start, start + duration], (0.05 / frequency).min(0.02 * duration));
    let chirp = |frequencies, growth| -> Arc<dyn Signal> {
        Arc::new(Chirp::new(start, duration, frequencies, phase, growth).unwrap())
    };
    let falling = chirp([frequency, 0.1 * frequency], Growth::Linear);
    let rising = chirp([0.3 * frequency, frequency], Growth::Logarithmic);
    let sine: Arc<dyn Signal> = Arc::new(Formula::harmonic(start, frequency, phase).unwrap());
    let sum = Sum::new(vec![(0.7, sine), (-0.3, Arc::clone(&rising))]);
    vec![(falling, kinks.clone(), slow), (rising, kinks.clone(), slow), (Arc::new(sum), kinks, slow)]
}

#[test]
fn means_of_chirps_and_sums_are_exact_over_any_step() {
    means_are_exact(Draw(11), drawn_composed);
}

fn means_are_exact(mut draw: Draw, drawn: impl Fn(&mut Draw) -> Vec<Known>) {
    for _ in 0..40 {
        for (signal, kinks, fine) in drawn(&mut draw) {
            for [from, to] in steps(&mut draw, &kinks) {
                let by = |f: &dyn Fn(f64) -> f64| quadrature(f, from, to, &kinks, fine);
                let value = |t: f64| signal.value(t);
                let what = format!("{signal:?} over [{from}, {to}]");
                // Times of some seconds have their digits in 1e-16 s, which is a part of a short
                // step, or of a jump.
                let digits = 3e-13 + 1e-15 * (1.0 + to) / (to - from) + 1e-15 / fine;
                let mean = by(&value);
                assert!((signal.mean(from, to) - mean).abs() < digits, "{what}: {} {mean}", signal.mean(from, to));
                let s = |t: f64| (2.0 * t - from - to) / (to - from);
                let moments = signal.moments(from, to);
                for (k, moment) in moments.into_iter().enumerate() {
                    let legendre = |s: f64| [1.0, s, 1.5 * s * s - 0.5, (2.5 * s * s - 1.5) * s][k];
                    let exact = by(&|t| value(t) * legendre(s(t)));
                    assert!((moment - exact).abs() < 2.0 * digits, "{what}, moment {k}: {moment} {exact}");
                }
                let integral = by(&|t| signal.integral(t));
                assert!((signal.mean_integral(from, to) - integral).abs() < digits * (1.0 + to), "{what}: {integral}");
                let rise = (value(to.next_down()) - value(from)) / (to - from);
                if kinks.iter().all(|t| *t <= from || *t >= to) && *kinks.first().unwrap() < from {
                    let rate = signal.mean_rate(from, to);
                    // Times have their digits in 1e-16 of themselves.
                    let part = 1e-12 + 1e-15 * to / (to - from);
                    let size = part * (1.0 + rise.abs()) + 1e-15 * (1.0 + to / fine) / (to - from);
                    assert!((rate - rise).abs() < size, "{what}: {rate} {rise}");
                }
            }
        }
    }
}

/// A block of 1 kg in the air, without weight.
fn block() -> (MassProperties, Blocks) {
    let shape = Rectangle::new(0.1, 0.1).unwrap();
    let mass = MassProperties::rectangle(&shape, 0.1, 1000.0).unwrap();
    (mass, Blocks::new(vec![Block::new(mass, &shape)], Vector2::zeros()))
}

/// Schemes that take the means of loads are exact to rounding, `exact`; the one that integrates them by
/// a method of its own has the error that it allows itself, measured by the least velocity that it sees.
fn own_error(scheme: &dyn Scheme<2>, exact: f64) -> f64 {
    if scheme.name() == EventDriven::NAME { 1e5 * exact } else { exact }
}

fn alone(part: Box<dyn Subsystem<2>>) -> Model<2> {
    let mut parts = ModelBuilder::new();
    parts.add_boxed(part);
    parts.build(Box::new(PointDetector::new(Vec::new()))).unwrap()
}

fn state_after(model: &Model<2>, scheme: &mut dyn Scheme<2>, h: f64, steps: u64) -> State {
    let zero = vec![0.0; model.size().v];
    let mut state = State::new(model, &zero, &zero, h).unwrap();
    let plan = Plan::steps(steps).when_unsolved(Unsolved::End);
    let ended = run(model, scheme, &mut state, &mut crate::scenes::workspace(model), &plan, &mut []).unwrap();
    assert_eq!(ended, Ended::Complete);
    state
}

#[test]
fn a_block_gets_the_impulse_of_any_signal_whatever_the_step() {
    let mut draw = Draw(3);
    for _ in 0..10 {
        for (signal, kinks, fine) in drawn(&mut draw) {
            let h = 10_f64.powf(draw.within(-3.5, -0.7));
            let steps = (2.0 / h).ceil().min(300.0);
            let end = steps * h;
            let impulse = end * quadrature(|t| signal.value(t), 0.0, end, &kinks, fine);
            let (mass, blocks) = block();
            let load = BlockLoad { block: 0, force: Vector2::new(2.0, -1.0), couple: 0.3, signal: Arc::clone(&signal) };
            let model = alone(Box::new(blocks.with_load(load).unwrap()));
            for mut scheme in all_schemes(&[0.6, 1.0]) {
                let state = state_after(&model, scheme.as_mut(), h, steps as u64);
                for (k, part) in [2.0, -1.0, 0.3].into_iter().enumerate() {
                    let found = mass.diagonal()[k] * state.v[k];
                    let digits = 1e-12 * (1.0 + end) + 1e-13 * end / fine;
                    assert!((found - part * impulse).abs() < digits, "{signal:?}, h = {h}: {found} {}", part * impulse);
                }
                let residual = state.ledger.relative_residual();
                // Of a pulse that ended before the start there are 1e-148 J.
                let none = state.ledger.scale < 1e-30;
                assert!(none || residual < own_error(scheme.as_ref(), 1e-13), "{}: {residual:e}", scheme.name());
            }
        }
    }
}

/// The examples of a hostile trial, which gave nothing: a pulse between two ends of steps, a table
/// with rows finer than the step.
#[test]
fn pulses_and_rows_within_a_step_move_what_they_act_on() {
    let pulse: Arc<dyn Signal> = Arc::new(Formula::half_sine(0.1002, 6e-4).unwrap());
    // 0, 1, 0, 1, … in rows of 1 ms: 0 at the ends of all steps of 2 ms.
    let times: Vec<f64> = (0..=200).map(|k| f64::from(k) * 1e-3).collect();
    let values = (0..=200).map(|k| f64::from(k % 2)).collect();
    let table: Arc<dyn Signal> = Arc::new(Table::new(times, values).unwrap());
    for (signal, force, h, impulse) in
        [(pulse, 500.0, 1e-3, 500.0 * 6e-4 * 2.0 / std::f64::consts::PI), (table, 3.0, 2e-3, 3.0 * 0.5 * 0.2)]
    {
        let (mass, blocks) = block();
        let force = Vector2::new(force, 0.0);
        let load = BlockLoad { block: 0, force, couple: 0.0, signal };
        let model = alone(Box::new(blocks.with_load(load).unwrap()));
        for mut scheme in all_schemes(&[0.6, 1.0]) {
            let state = state_after(&model, scheme.as_mut(), h, (0.5 / h).round() as u64);
            let off = (state.v[0] * mass.diagonal()[0] / impulse - 1.0).abs();
            assert!(off < own_error(scheme.as_ref(), 1e-13), "{}: {}", scheme.name(), state.v[0]);
        }
    }
}

fn beam(elements: usize, supports: [Support; 2]) -> Arc<Beam> {
    let section = Section::new(2.0, 3.0).unwrap();
    Arc::new(Beam::new(BeamSpec::new(1.0, elements, section).supported(supports)).unwrap())
}

/// Over elements, over ends, standing still, back and forth: ∫ P(t) N(x(t)) dt for every dof, in
/// elements and in modes.
#[test]
fn a_moving_force_gives_its_exact_mean_to_every_dof() {
    let (mut draw, mut checked) = (Draw(11), 0);
    for round in 0..8 {
        let supports = [[Support::Free; 2], [Support::Pinned; 2]][round % 2];
        let beam = beam(1 + round, supports);
        let basis = ModalBasis::new(&beam, 3, &[]).unwrap();
        for (signal, mut kinks, fine) in drawn(&mut draw) {
            for [from, to] in steps(&mut draw, &kinks.clone()) {
                let sign = if draw.next() < 0.5 { -1.0 } else { 1.0 };
                let speed = if draw.next() < 0.1 { 0.0 } else { sign * draw.within(0.01, 3.0) / (to - from) };
                let start = draw.within(-0.5, 1.5) - speed * 0.5 * (from + to);
                let nodes = beam.node_positions().iter().map(|x| (x - start) / speed);
                let before = kinks.len();
                kinks.extend(nodes.filter(|t| t.is_finite()));
                let points = points(from, to, &kinks, fine);
                kinks.truncate(before);
                // The check takes its time where the signal swings hundreds of times in a step.
                if points.len() > 3000 {
                    continue;
                }
                checked += 1;
                let load = MovingForce { force: -2.0, start, speed, signal: Arc::clone(&signal) };
                let body = BeamBody::new(Arc::clone(&beam), Vector2::zeros(), BeamSurface::Axis)
                    .with_load(Box::new(load.clone()));
                let [mut mean, mut exact, mut scratch] = [0.0, 0.0, f64::NAN].map(|x| vec![x; beam.dofs()]);
                body.mean_load([from, to], &mut scratch, &mut mean);
                for (t, share) in points {
                    scratch.fill(0.0);
                    load.add(&beam, t, &mut scratch);
                    exact.iter_mut().zip(&scratch).for_each(|(exact, p)| *exact += share * p);
                }
                let digits = 1e-12 + 1e-14 * (1.0 + to) / (to - from) + 1e-14 / fine;
                for dof in (0..beam.dofs()).filter(|dof| !beam.is_held(*dof)) {
                    let (found, exact) = (mean[dof], exact[dof]);
                    assert!((found - exact).abs() < digits, "{signal:?} [{from}, {to}] {dof}: {found} {exact}");
                }
                let modes = ModalBeam::new(Arc::clone(&beam), basis.clone(), Vector2::zeros(), BeamSurface::Axis);
                let modes = modes.unwrap().with_load(Box::new(load));
                let mut modal = vec![0.0; 3];
                modes.mean_load([from, to], &mut [f64::NAN; 3], &mut modal);
                for (i, found) in modal.iter().enumerate() {
                    let exact: f64 = basis.shape(i).iter().zip(&mean).map(|(phi, p)| phi * p).sum();
                    assert!((found - exact).abs() < 1e-13 * (1.0 + exact.abs()), "mode {i}: {found} {exact}");
                }
            }
        }
    }
    assert!(checked > 300, "{checked}");
    // The beam's own load has the same mean.
    let beam = beam(5, [Support::Free; 2]);
    let constant: Arc<dyn Signal> = Arc::new(Formula::constant(-1.0).unwrap());
    let (own, other) = (
        MovingLoad::new(-3.0, 4.0, -0.1).unwrap(),
        MovingForce { force: -3.0, start: -0.1, speed: 4.0, signal: constant },
    );
    for times in [[0.0, 0.01], [0.0, 0.1], [0.2, 0.35], [0.0, 1.0], [0.3, 0.4]] {
        let [mut a, mut b, mut scratch] = [(); 3].map(|()| vec![0.0; beam.dofs()]);
        own.add_mean(&beam, times, &mut scratch, &mut a);
        other.add_mean(&beam, times, &mut scratch, &mut b);
        assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-14), "{times:?}: {a:?} {b:?}");
    }
}

#[test]
fn the_scheme_is_of_second_order_under_loads() {
    let swing: Arc<dyn Signal> = Arc::new(Formula::harmonic(0.0, 2.0, 0.4).unwrap());
    let beam = beam(4, [Support::Pinned; 2]);
    let mut pattern = vec![0.0; beam.dofs()];
    beam.add_point_load(0.3, -2.0, &mut pattern).unwrap();
    let at_end = |h: f64| {
        let body = BeamBody::new(Arc::clone(&beam), Vector2::zeros(), BeamSurface::Axis)
            .with_load(Box::new(SignalLoad::new(pattern.clone(), Arc::clone(&swing))));
        let mut scheme = MoreauJean::new(MoreauJeanSettings::default()).unwrap();
        let state = state_after(&alone(Box::new(body)), &mut scheme, h, (0.4 / h).round() as u64);
        beam.deflection_at(&state.q, 0.5).unwrap().w
    };
    let found = [1e-4, 5e-5, 2.5e-5].map(at_end);
    let order = ((found[0] - found[1]) / (found[1] - found[2])).abs().log2();
    assert!((order - 2.0).abs() < 0.1, "{order}");
}

/// Ground that shakes once a step drifts as its mean velocity says, and no velocity rings.
#[test]
fn drives_lead_where_their_signals_do() {
    let omega = std::f64::consts::TAU * 1000.0;
    let shake: Arc<dyn Signal> = Arc::new(Formula::harmonic(0.0, 1000.0, 0.0).unwrap());
    let motion = || Motion::still().with(Given::Acceleration, 50.0, Arc::clone(&shake));
    let ground = alone(Box::new(Ground::moving(0.0, [motion(), Motion::still(), Motion::still()])));
    for mut scheme in all_schemes(&[0.6, 1.0]) {
        let (mut state, zero) = (state_after(&ground, scheme.as_mut(), 1e-3, 499), vec![0.0; 3]);
        let drift = 50.0 / omega * 0.5;
        let before = state.v[0];
        let plan = Plan::steps(500).when_unsolved(Unsolved::End);
        let mut work = crate::scenes::workspace(&ground);
        let ended = run(&ground, scheme.as_mut(), &mut state, &mut work, &plan, &mut []).unwrap();
        assert_eq!(ended, Ended::Complete);
        assert!((state.q[0] / drift - 1.0).abs() < 2e-3, "{}: {} not {drift}", scheme.name(), state.q[0]);
        assert!((state.v[0] - before).abs() < 1e-12, "no ringing");
        assert_eq!(state.v[1..], zero[1..]);
    }
    // Of any motion the place stays within what a step can hide, for ever, whatever happens in the first step: the mean about the end.
    let mut draw = Draw(5);
    for _ in 0..20 {
        for (signal, ..) in drawn(&mut draw) {
            for (given, theta) in
                [(Given::Velocity, 0.5), (Given::Acceleration, 0.5), (Given::Velocity, 0.75), (Given::Velocity, 1.0)]
            {
                let motion = Motion::still().with(given, 1.0, Arc::clone(&signal));
                let model = alone(Box::new(Ground::moving(0.0, [motion.clone(), Motion::still(), Motion::still()])));
                let h = 10_f64.powf(draw.within(-3.0, -1.0));
                let settings = MoreauJeanSettings { theta, ..MoreauJeanSettings::default() };
                let mut scheme = MoreauJean::new(settings).unwrap();
                let state = state_after(&model, &mut scheme, h, 200);
                let (end, d) = (state.t, |t: f64| motion.displacement(t));
                let about = theta * d(end + (1.0 - theta) * h) + (1.0 - theta) * d(end - theta * h);
                // The offset of the start, never more than the drive itself moves in the first half step.
                let (v, mean) = (motion.velocity(0.0), motion.mean_velocity(0.0, 0.5 * h));
                let v = if v.abs() > 1.25 * mean.abs() { mean } else { v };
                let first = (1.0 - theta) * h * v - d((1.0 - theta) * h);
                let error = (state.q[0] - (about + first)).abs();
                assert!(error < 1e-11 * (1.0 + about.abs()), "{signal:?} {given:?} θ = {theta} h = {h}: {error:e}");
            }
        }
    }
}

/// A trial found 1.667 mm, 0.833 mm and 0 in place of 1 mm: what lies in the first half step was judged by the velocity at t = 0.
#[test]
fn a_motion_within_the_first_half_step_leads_where_it_says() {
    for duration in [1e-5, 3e-4, 5e-4, 9e-4] {
        for theta in [0.5, 1.0] {
            let ramp: Arc<dyn Signal> = Arc::new(Formula::ramp(0.0, duration).unwrap());
            let motion = Motion::still().with(Given::Displacement, 1e-3, ramp);
            let model = alone(Box::new(Ground::moving(0.0, [motion, Motion::still(), Motion::still()])));
            let settings = MoreauJeanSettings { theta, ..MoreauJeanSettings::default() };
            let state = state_after(&model, &mut MoreauJean::new(settings).unwrap(), 1e-3, 20);
            assert!((state.q[0] - 1e-3).abs() < 1e-15, "{duration} s, θ = {theta}: {}", state.q[0]);
        }
    }
}
