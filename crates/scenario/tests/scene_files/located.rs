//! `moreau-jean-located` against exact motions: impacts at their times, second order through them,
//! bounces that end.

use std::ops::ControlFlow;
use teeter_integrator::{Ended, Model, Observer, ObserverError, PhaseKind, State, StepReport};
use teeter_scenario::simulation::Simulation;

/// The impacts of a run, and how its steps were divided.
#[derive(Default)]
pub(super) struct Seen {
    /// Time, normal velocity before and after of each contact that came in at more than 1 µm/s.
    pub(super) impacts: Vec<(f64, f64, f64)>,
    most_phases: usize,
}

impl Observer<2> for Seen {
    fn observe(&mut self, _: &Model<2>, step: &StepReport<'_, 2>, _: &State) -> Result<ControlFlow<()>, ObserverError> {
        self.most_phases = self.most_phases.max(step.phases().count());
        for phase in step.phases().filter(|phase| phase.kind == PhaseKind::Impact) {
            let came = phase.contacts.iter().filter(|contact| contact.u_before[0] < -1e-6 && contact.p[0] > 0.0);
            self.impacts.extend(came.map(|contact| (phase.end, contact.u_before[0], contact.u_after[0])));
        }
        Ok(ControlFlow::Continue(()))
    }
}

const G: f64 = 9.81;

/// X, Y and φ of a block.
pub(super) fn pose(simulation: &Simulation, name: &str) -> [f64; 3] {
    let block = simulation.layout.blocks.iter().find(|block| block.name == name).unwrap();
    simulation.state.q[block.range.clone()].try_into().unwrap()
}

/// A scene before its run with this step.
pub(super) fn simulation(scene: &str, step: &str) -> Simulation {
    let sets = [("time.scheme", "moreau-jean-located"), ("time.step", step)];
    let sets: Vec<(String, String)> =
        sets.into_iter().map(|(key, value)| (key.to_owned(), format!("\"{value}\""))).collect();
    let resolved = teeter_scenario::load(scene.as_bytes(), "located", "located", &sets).unwrap();
    Simulation::new(&resolved.scene).unwrap()
}

pub(super) fn run(scene: &str, step: &str) -> (Simulation, Seen) {
    let mut simulation = simulation(scene, step);
    let mut seen = Seen::default();
    assert_eq!(simulation.run(&mut [&mut seen]).unwrap(), Ended::Complete);
    let ledger = &simulation.state.ledger;
    assert!(ledger.relative_residual() < 1e-13, "{:e} of the energy unexplained", ledger.relative_residual());
    assert!(ledger.positive_contact_work.largest <= 1e-15 * ledger.scale, "{:?}", ledger.positive_contact_work);
    assert_eq!(simulation.state.tally.unconverged_steps, 0);
    (simulation, seen)
}

fn block(more: &str, end: &str, contact: &str) -> String {
    format!(
        "[time]\nend = '{end}'\nstep = '1 ms'\n[ground]\n[material.m]\ndensity = '2700 kg/m^3'\n\
         [block.b]\nmaterial = 'm'\nwidth = '3 cm'\nheight = '13.5 cm'\ndepth = '3 cm'\n{more}\n\
         [contact.c]\nbetween = ['b', 'ground']\n{contact}\n"
    )
}

fn rocking() -> String {
    block("on = 'ground'\nat = '0 cm'\ntilt = '5 deg'", "0.9 s", "friction = 0.5")
}

/// Housner's block: the impacts in closed form.
#[test]
fn a_rocking_block_strikes_at_its_times_in_steps_of_any_size() {
    let exact = [0.106510, 0.292488, 0.457537, 0.605581, 0.739365, 0.860926];
    // The times are known to 1e-6 s.
    for (step, off) in [("2 ms", 8e-5), ("1 ms", 2e-5), ("100 us", 1e-6)] {
        let (_, seen) = run(&rocking(), step);
        assert_eq!(seen.impacts.len(), exact.len(), "{step}");
        for (impact, exact) in seen.impacts.iter().zip(exact) {
            assert!((impact.0 - exact).abs() < off, "{step}: {} {exact}", impact.0);
            assert!(impact.2.abs() < 1e-12, "{step}: no rebound, but {} m/s", impact.2);
        }
        assert_eq!(seen.most_phases, 3, "up to the impact, the impact, and the rest");
    }
}

#[test]
fn the_motion_is_of_second_order_through_its_impacts() {
    let angle = |step: &str| run(&rocking(), step).0.state.q[2];
    let [coarse, middle, fine] = ["2 ms", "1 ms", "500 us"].map(angle);
    let order = ((coarse - middle) / (middle - fine)).abs().log2();
    assert!((1.8..2.4).contains(&order), "order {order}: {coarse} {middle} {fine}");
    let finest = angle("50 us");
    assert!((coarse - finest).abs() < 2e-4 * 0.0873, "{coarse} {finest}");
}

/// A flat fall from height H with e: v = −√(2gH), then every eᵏ of it, at times that are known.
#[test]
fn a_block_that_bounces_flat_keeps_its_times_and_ends_at_rest() {
    for law in ["newton", "poisson", "energetic"] {
        for step in ["5 ms", "1 ms", "170 us"] {
            let (e, fall) = (0.6_f64, 0.02);
            let scene = block(
                "position = ['0 m', '8.75 cm']",
                "1 s",
                &format!("friction = 0.3\nrestitution = {e}\nlaw = '{law}'"),
            );
            let (simulation, seen) = run(&scene, step);
            let (speed, mut t) = ((2.0 * G * fall).sqrt(), (2.0 * fall / G).sqrt());
            // Two corners at each impact.
            for (k, pair) in seen.impacts.chunks(2).take(4).enumerate() {
                let arrives = speed * e.powi(k as i32);
                for &(at, before, after) in pair {
                    assert!((at - t).abs() < 1e-9, "{law} {step}: impact {k} at {at} s, {t} s expected");
                    assert!((before + arrives).abs() < 1e-8 * speed, "{law} {step}: {before} {arrives}");
                    assert!((after - e * arrives).abs() < 1e-6 * speed, "{law} {step}: back with {after}");
                }
                t += 2.0 * e * arrives / G;
            }
            let state = &simulation.state;
            assert!(seen.impacts.len() > 8 && seen.impacts.len() < 60, "{law} {step}: {}", seen.impacts.len());
            assert!((state.q[1] - 0.0675).abs() < 1e-8 && state.v[1].abs() < 1e-10, "{law} {step}: {:?}", state.q);
        }
    }
}

/// The two corners of a block that falls with a tilt of 1e-3 rad come down one after the other, in
/// one step.
#[test]
fn two_impacts_in_a_step_are_told_apart() {
    let scene = block("position = ['0 m', '8 cm']\nangle = '1e-3 rad'", "0.1 s", "friction = 0.3");
    let (_, seen) = run(&scene, "2 ms");
    let (first, second) = (seen.impacts[0].0, seen.impacts[1].0);
    let t = (2.0 * (0.08 - (0.0675 * 1e-3_f64.cos() + 0.015 * 1e-3_f64.sin())) / G).sqrt();
    assert!((first - t).abs() < 1e-9, "{first} {t}");
    assert!(second > first && second - first < 1.2e-3, "{first} {second}");
    assert!(seen.most_phases >= 5, "{}", seen.most_phases);
}

/// A block that starts on the ground with a velocity into it strikes at once.
#[test]
fn a_block_that_starts_with_an_impact_has_it_at_the_start() {
    let scene = block(
        "position = ['0 m', '6.75 cm']\nvelocity = ['0 m/s', '-0.1 m/s']",
        "20 ms",
        "friction = 0.3\nrestitution = 0.5",
    );
    let (simulation, seen) = run(&scene, "1 ms");
    assert!(
        seen.impacts.iter().take(2).all(|impact| impact.0 == 0.0 && (impact.2 - 0.05).abs() < 1e-9),
        "{:?}",
        seen.impacts
    );
    let t = simulation.state.t;
    let y = 0.0675 + 0.05 * t - 0.5 * G * t * t;
    assert!((simulation.state.q[1] - y.max(0.0675)).abs() < 1e-9 || t > 0.1 / G, "{}", simulation.state.q[1]);
}

/// Ground that rises and falls under a block that bounces on it: work of the drive and impacts, all
/// accounted for.
#[test]
fn impacts_on_moving_ground_are_in_the_account() {
    let scene = block(
        "on = 'ground'\nat = '0 m'\ntilt = '3 deg'",
        "0.5 s",
        "friction = 0.6\nrestitution = 0.3",
    )
    .replace("[ground]\n", "[ground]\nmotion = { acceleration = ['4 m/s^2', '3 m/s^2'], signal = 's' }\n[signal.s]\nshape = 'harmonic'\nfrequency = '9 Hz'\n");
    let sets = [("time.scheme", "\"moreau-jean-located\"")];
    let sets: Vec<(String, String)> = sets.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
    let resolved = teeter_scenario::load(scene.as_bytes(), "s", "s", &sets).unwrap();
    let mut simulation = Simulation::new(&resolved.scene).unwrap();
    let mut seen = Seen::default();
    let _ = simulation.run(&mut [&mut seen]).unwrap();
    assert!(seen.impacts.len() > 5, "{}", seen.impacts.len());
    assert!(simulation.state.ledger.relative_residual() < 1e-13, "{:e}", simulation.state.ledger.relative_residual());
    let off = |step: &str| {
        let sets: Vec<(String, String)> =
            [("time.scheme", "moreau-jean-located"), ("time.step", step), ("time.end", "0.15 s")]
                .iter()
                .map(|(k, v)| ((*k).to_owned(), format!("\"{v}\"")))
                .collect();
        let scene = scene.replace("restitution = 0.3", "restitution = 0");
        let resolved = teeter_scenario::load(scene.as_bytes(), "s", "s", &sets).unwrap();
        let mut simulation = Simulation::new(&resolved.scene).unwrap();
        let _ = simulation.run(&mut []).unwrap();
        simulation.state.q[2]
    };
    let [coarse, middle, fine] = ["1 ms", "500 us", "250 us"].map(off);
    let order = ((coarse - middle) / (middle - fine)).abs().log2();
    assert!(order > 1.6, "order {order}: {coarse} {middle} {fine}");
}

/// Tangential restitution acts though nothing bounces: a spinning block slides onto one corner and
/// its tangential velocity turns about.
#[test]
fn tangential_restitution_needs_no_bounce() {
    let scene = block(
        "position = ['0 m', '9 cm']\nangle = '20 deg'\nvelocity = ['0.9 m/s', '-0.5 m/s']",
        "60 ms",
        "friction = 5\nrestitution = 0\ntangential_restitution = 0.9\nlaw = 'energetic'",
    );
    let (_, seen) = run(&scene, "1 ms");
    assert!(!seen.impacts.is_empty());
    let sets = [("time.scheme", "\"moreau-jean-located\"")].map(|(k, v)| (k.to_owned(), v.to_owned()));
    let resolved = teeter_scenario::load(scene.as_bytes(), "t", "t", &sets).unwrap();
    let mut simulation = Simulation::new(&resolved.scene).unwrap();
    let mut turned = Turned(None);
    let _ = simulation.run(&mut [&mut turned]).unwrap();
    let (before, after) = turned.0.unwrap();
    assert!((after / before + 0.9).abs() < 1e-9, "{before} {after}");
}

/// The tangential velocity before and after the first impact.
struct Turned(Option<(f64, f64)>);

impl Observer<2> for Turned {
    fn observe(&mut self, _: &Model<2>, step: &StepReport<'_, 2>, _: &State) -> Result<ControlFlow<()>, ObserverError> {
        for phase in step.phases().filter(|phase| phase.kind == PhaseKind::Impact) {
            let struck = phase.contacts.iter().find(|contact| contact.u_before[0] < -1e-6);
            self.0 = self.0.or(struck.map(|contact| (contact.u_before[1], contact.u_after[1])));
        }
        Ok(ControlFlow::Continue(()))
    }
}

/// Supports that move feel nothing of how a step is divided by blocks that bounce elsewhere.
#[test]
fn what_is_driven_moves_on_through_divided_steps() {
    let beam = "[time]\nend = '0.201 s'\nstep = '1 ms'\n[signal.s]\nshape = 'harmonic'\nfrequency = '40 Hz'\n[material.m]\n\
        density = '2700 kg/m^3'\nyoungs_modulus = '69 GPa'\n[ground]\n\
        [block.b]\nmaterial = 'm'\nwidth = '3 cm'\nheight = '3 cm'\ndepth = '3 cm'\nposition = ['5 m', '4 cm']\n\
        [contact.c]\nbetween = ['b', 'ground']\nfriction = 0.3\nrestitution = 0.9\n\
        [beam.t]\nmaterial = 'm'\nspan = '36 cm'\nwidth = '3 cm'\nthickness = '0.3 cm'\nelements = 8\nposition = ['0 m', '1 m']\n\
        motion = { acceleration = ['0 m/s^2', '5 m/s^2'], signal = 's' }\n";
    let (divided, seen) = run(beam, "1 ms");
    assert!(seen.most_phases >= 3);
    let sets = [("time.scheme", "\"moreau-jean-closed\"")].map(|(k, v)| (k.to_owned(), v.to_owned()));
    let resolved = teeter_scenario::load(beam.as_bytes(), "t", "t", &sets).unwrap();
    let mut whole = Simulation::new(&resolved.scene).unwrap();
    let _ = whole.run(&mut []).unwrap();
    let place = &divided.layout.beams[0];
    let middle = |simulation: &Simulation, x: &[f64]| {
        let place = &simulation.layout.beams[0];
        place.beam.deflection_at(&x[place.range.clone()], 0.18).unwrap().w
    };
    let scale = middle(&whole, &whole.state.v).abs().max(1e-3);
    assert!((middle(&divided, &divided.state.v) - middle(&whole, &whole.state.v)).abs() < 0.02 * scale);
    let supports = place.supports.clone().unwrap();
    for k in supports {
        assert_eq!(divided.state.v[k], whole.state.v[k], "prescribed velocities are those of whole steps");
    }
}

/// Where a block on ground that moves by A sin ωt is after time `end`: parabolas while it slides,
/// the ground's sine while it sticks.
fn slides_on_shaken_ground(amplitude: f64, omega: f64, mu: f64, end: f64) -> f64 {
    let ground = |t: f64| [amplitude * (omega * t).sin(), amplitude * omega * (omega * t).cos()];
    let pull = |t: f64| amplitude * omega * omega * -(omega * t).sin();
    let root = |mut low: f64, mut high: f64, f: &dyn Fn(f64) -> bool| {
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            *(if f(middle) { &mut low } else { &mut high }) = middle;
        }
        high
    };
    let (limit, tick) = (mu * G, 1e-4);
    let (mut t, mut x, mut v) = (0.0, 0.0, 0.0);
    while t < end {
        // Dragged towards the ground's velocity; at rest on it, towards its acceleration.
        let ahead = if (ground(t)[1] - v).abs() > 1e-12 { ground(t)[1] - v } else { pull(t + 1e-9) };
        let rate = limit * ahead.signum();
        if (ground(t)[1] - v).abs() <= 1e-12 && pull(t + 1e-9).abs() <= limit {
            let holds = |t: f64| pull(t).abs() <= limit;
            let mut until = t + tick;
            while until < end && holds(until) {
                until += tick;
            }
            let until = if until < end { root(until - tick, until, &holds) } else { end };
            (x, v, t) = (x + ground(until)[0] - ground(t)[0], ground(until)[1], until);
            continue;
        }
        let slides = |s: f64| (ground(s)[1] - (v + rate * (s - t))) * rate > 0.0;
        let mut until = t + tick;
        while until < end && slides(until) {
            until += tick;
        }
        let until = if until < end { root((until - tick).max(t + 1e-9), until, &slides) } else { end };
        let tau = until - t;
        (x, v, t) = (x + v * tau + 0.5 * rate * tau * tau, v + rate * tau, until);
        v = if until < end { ground(until)[1] } else { v };
    }
    x
}

/// Some hundred slides that stop or turn: without their times it was off by 6e-4 m at 1 ms, and
/// friction made energy.
#[test]
fn slides_stop_at_their_times() {
    let slab = |place: &str| {
        format!(
            "[time]\nend = '2 s'\nstep = '1 ms'\n[ground]\nmotion = {{ displacement = ['20 mm', '0 mm'], signal = 's' }}\n\
             [signal.s]\nshape = 'harmonic'\nfrequency = '3 Hz'\n[material.m]\ndensity = '2500 kg/m^3'\n\
             [block.b]\nmaterial = 'm'\nwidth = '20 cm'\nheight = '10 cm'\ndepth = '10 cm'\n{place}\n\
             [contact.c]\nbetween = ['b', 'ground']\nfriction = 0.3\n"
        )
    };
    let exact = slides_on_shaken_ground(0.02, 6.0 * std::f64::consts::PI, 0.3, 2.0);
    for (step, off) in [("2 ms", 5e-6), ("1 ms", 1e-6), ("100 us", 2e-8)] {
        let (simulation, seen) = run(&slab("position = ['0 m', '5 cm']"), step);
        let x = simulation.state.q[0];
        assert!((x - exact).abs() <= off, "{step}: x {x}, exact {exact}, off by {:e}", x - exact);
        assert!(seen.most_phases > 1, "no step was divided");
    }
}

/// A block that is thrown up a slope, stops and slides back at once, wherever in the step that is.
#[test]
fn slides_turn_about_at_their_times() {
    let (slope, h) = (20.0_f64.to_radians(), 1e-3);
    for part in [0.5, 0.2] {
        let mu = part * slope.tan();
        let [up, down] = [1.0, -1.0].map(|sign| G * (slope.sin() + sign * mu * slope.cos()));
        for at in 1..10 {
            let turns = (10.0 + 0.1 * f64::from(at)) * h;
            let speed = up * turns;
            let scene = block(
                &format!(
                    "on = 'ground'\nat = '0 m'\nvelocity = ['{:e} m/s', '{:e} m/s']",
                    speed * slope.cos(),
                    speed * slope.sin()
                ),
                "0.1 s",
                &format!("friction = {mu:e}"),
            )
            .replace("[ground]\n", "[ground]\nincline = '20 deg'\n")
            .replace("13.5 cm", "1 cm");
            let (simulation, _) = run(&scene, "1 ms");
            let v = &simulation.state.v;
            let along = v[0] * slope.cos() + v[1] * slope.sin();
            let off = along + down * (0.1 - turns);
            assert!(off.abs() < 1e-6 * G * h, "{part} at {at}: {along}, off by {:e} gh", off / (G * h));
        }
    }
}

/// Another block's impact doesn't lift the foot of one that rests.
#[test]
fn what_rests_isnt_touched_by_another_blocks_impact() {
    let fallen = "[block.c]\nmaterial = 'm'\nwidth = '3 cm'\nheight = '13.5 cm'\ndepth = '3 cm'\non = 'ground'\nat = '1 m'\ntilt = '0.2 deg'\n\
                  [contact.d]\nbetween = ['c', 'ground']\nfriction = 0.15\nrestitution = 0.9\n";
    for step in ["1 us", "0.7 us"] {
        let (simulation, seen) =
            run(&(block("on = 'ground'\nat = '0 m'", "40 ms", "friction = 0.15\nrestitution = 0.9") + fallen), step);
        assert!(!seen.impacts.is_empty(), "the other one never struck");
        let resting = simulation.layout.blocks[0].range.clone();
        let (q, v) = (&simulation.state.q[resting.clone()], &simulation.state.v[resting]);
        assert!((q[1] - 0.0675).abs() < 1e-15 && q[0].abs() < 1e-18 && q[2].abs() < 1e-15, "{step}: {q:?}");
        assert!(v.iter().all(|v| v.abs() < 1e-14), "{step}: {v:?}");
    }
}

/// Less than a tolerance in each step is no approach, or so it was: steps of 10 ns let a foot fall
/// freely to 5e-10 m.
#[test]
fn no_step_is_so_short_that_a_foot_sinks_unseen() {
    let (simulation, _) = run(&block("on = 'ground'\nat = '0 m'\ntilt = '1 deg'", "20 us", "friction = 0.5"), "10 ns");
    assert!(simulation.state.tally.max_penetration < 2e-12, "{} m", simulation.state.tally.max_penetration);
}

/// By the end of the step the corner is beside the table, and nothing is inside of anything.
#[test]
fn a_corner_that_strikes_just_before_the_edge_of_a_table_is_not_missed() {
    let scene = "[world]\ngravity = '0 m/s^2'\n[time]\nend = '4 ms'\nstep = '1 ms'\n\
         [contact.c]\nbetween = ['*', '*']\nfriction = 0.2\nrestitution = 0.8\n\
         [block.table]\nfixed = true\ndensity = '1000 kg/m^3'\ndepth = '10 cm'\nwidth = '40 cm'\nheight = '10 cm'\n\
         position = ['-20 cm', '-5 cm']\n\
         [block.b]\ndensity = '1000 kg/m^3'\ndepth = '10 cm'\nwidth = '10 cm'\nheight = '20 cm'\n\
         position = ['1.238261671 cm', '11.107056924 cm']\nangle = '20 deg'\nvelocity = ['1 m/s', '-1 mm/s']\n";
    let short = run(scene, "20 us").0.state;
    assert!(short.v[4] > 0.0, "it comes back: {:?}", short.v);
    for step in ["0.5 ms", "1 ms", "2 ms", "4 ms"] {
        let (simulation, _) = run(scene, step);
        assert_eq!(simulation.state.tally.unlocated_steps, 0, "{step}");
        for (v, other) in simulation.state.v.iter().zip(&short.v) {
            assert!((v - other).abs() < 1e-9, "{step}: {:?} and {:?}", simulation.state.v, short.v);
        }
    }
}

/// A rocking block of this shape.
fn rocking_shape(shape: &str) -> String {
    format!(
        "[time]\nend = '0.96 s'\nstep = '1 ms'\n[ground]\n[contact.c]\nbetween = ['*', '*']\nfriction = 0.6\n\
         [contact.floor]\nbetween = ['*', 'ground']\nfriction = 0.6\n\
         [block.b]\ndensity = '2700 kg/m^3'\ndepth = '3 cm'\ntilt = '5 deg'\n{shape}"
    )
}

const WHOLE: &str = "width = '3 cm'\nheight = '13.5 cm'\non = 'ground'\nat = '0 cm'\n";

/// The same of so many flush parts.
fn parts(count: u32) -> String {
    let width = 3.0 / f64::from(count);
    let part = |k| {
        format!(
            "{{ width = '{width} cm', height = '13.5 cm', at = ['{} cm', '6.75 cm'] }}",
            (f64::from(k) + 0.5) * width
        )
    };
    let parts: Vec<String> = (0..count).map(part).collect();
    format!("on = 'ground'\nat = '0 cm'\nparts = [{}]\n", parts.join(", "))
}

/// The same on two bricks, above their joint.
const ON_BRICKS: &str = "width = '3 cm'\nheight = '13.5 cm'\non = 'brick-1'\nat = '0 cm'\n\
                         [block.brick]\nfixed = true\ndensity = '2700 kg/m^3'\ndepth = '3 cm'\nwidth = '10 cm'\nheight = '5 cm'\n\
                         position = ['-5 cm', '-2.5 cm']\nrepeat = { count = 2, shift = ['10 cm', '0 m'] }\n";

/// Points on one line under a base land together, though the pivot has sunk in by some nanometres: a base of flush parts, or one on
/// flush bricks, loses as much as one in one piece.
#[test]
fn a_base_of_flush_parts_rocks_as_one_in_one_piece() {
    let angle = |shape: &str, step: &str| {
        let (simulation, seen) = run(&rocking_shape(shape), step);
        (simulation.state.q[2], seen.impacts.iter().map(|(t, ..)| *t).fold(0.0, f64::max))
    };
    for (step, milliseconds) in [("100 us", 0.1_f64), ("250 us", 0.25), ("1 ms", 1.0), ("2 ms", 2.0), ("4 ms", 4.0)] {
        let whole = angle(WHOLE, step);
        // The first point that touches, by what the pivot has drifted, says when the base lands. A blow in two parts is off by 1e-2.
        let enough = 1.5e-6 * milliseconds.powi(3);
        for (what, shape) in
            [("two", parts(2)), ("three", parts(3)), ("seven", parts(7)), ("bricks", ON_BRICKS.to_owned())]
        {
            let divided = angle(&shape, step);
            assert!((divided.0 - whole.0).abs() < enough, "{what}, {step}: {divided:?} rad, s and {whole:?}");
            assert!((divided.1 - whole.1).abs() < enough, "{what}, {step}: {divided:?} rad, s and {whole:?}");
        }
    }
}

/// The same in the closed scheme, whose pivots sink in by micrometres.
#[test]
fn flush_parts_land_as_one_in_the_closed_scheme() {
    let energy = |shape: &str, step: &str| {
        let sets = [("time.scheme", "moreau-jean-closed"), ("time.step", step), ("time.end", "0.7 s")];
        let sets = sets.map(|(key, value)| (key.to_owned(), format!("\"{value}\"")));
        let resolved = teeter_scenario::load(rocking_shape(shape).as_bytes(), "f", "f", &sets).unwrap();
        let mut simulation = Simulation::new(&resolved.scene).unwrap();
        assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
        let ledger = &simulation.state.ledger;
        assert!(ledger.positive_contact_work.largest <= 1e-15 * ledger.scale, "{:?}", ledger.positive_contact_work);
        ledger.sum.contact
    };
    for step in ["50 us", "100 us", "250 us"] {
        let whole = energy(WHOLE, step);
        for (what, shape) in
            [("two", parts(2)), ("three", parts(3)), ("seven", parts(7)), ("bricks", ON_BRICKS.to_owned())]
        {
            let divided = energy(&shape, step);
            assert!((divided / whole - 1.0).abs() < 0.03, "{what}, {step}: contacts took {divided} J and {whole} J");
        }
    }
}

/// Rounding of speeds, below which a contact sticks by its state, grows with the fastest body: the end of a slide must be found while
/// another block slides faster, far away.
#[test]
fn a_slide_ends_in_time_while_another_block_slides() {
    let slab = |name: &str, at: f64, friction: f64| {
        format!(
            "[block.{name}]\ndensity = '1000 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.3 m'\nheight = '0.05 m'\non = 'ground'\nat = '{at} m'\n\
             [contact.c-{name}]\nbetween = ['{name}', 'ground']\nfriction = {friction}\n"
        )
    };
    let slid = |more: &str| {
        let text = format!(
            "[time]\nend = '1 s'\n[world]\ngravity = '9.81 m/s^2'\n[ground]\n\
             motion = {{ displacement = ['20 mm', '0 mm'], signal = 's' }}\n\
             [signal.s]\nshape = 'harmonic'\nfrequency = '3 Hz'\n{}{more}",
            slab("a", 0.0, 0.3)
        );
        run(&text, "50 us").0.state.q[0]
    };
    let (alone, beside) = (slid(""), slid(&slab("b", 2.0, 0.2)));
    assert!((alone - beside).abs() < 1e-8, "{alone} {beside}");
}

/// A corner that rests on a side has sunk in by nanometres; where it slides off the end of that, the end doesn't strike the edge that it
/// carries. The angle is that of an integration without contact from there on, to rounding.
#[test]
fn a_corner_slides_off_a_side_without_a_blow() {
    const TEXT: &str = "[time]\nend = '0.1 s'\n[world]\ngravity = '9.81 m/s^2'\n\
        [block.table]\ndensity = '2000 kg/m^3'\ndepth = '0.1 m'\nwidth = '1 m'\nheight = '0.5 m'\nposition = ['-0.5 m', '-0.25 m']\n\
        fixed = true\n\
        [block.b]\ndensity = '1000 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.212 m'\nheight = '0.13 m'\n\
        position = ['0.08567437914076545 m', '0.08233793215604149 m']\nangle = '9.95 deg'\n\
        velocity = ['0.8716544132435398 m/s', '0.045655445778975075 m/s']\nspin = '0.49 rad/s'\n\
        [contact.c]\nbetween = ['b', 'table']\nfriction = 0\n";
    for step in ["2 ms", "1 ms", "250 us"] {
        let (simulation, seen) = run(TEXT, step);
        assert!(seen.impacts.is_empty(), "{step}: {:?}", seen.impacts);
        let [_, _, phi] = pose(&simulation, "b");
        assert!((phi - 0.169_296_9).abs() < 2e-6, "{step}: {phi}");
    }
}

/// What strikes at the start of a step, or a rounding after it, leaves no time in which a slide could be seen to stop. The place is that
/// of `event-driven`.
#[test]
fn a_slide_that_stops_where_something_strikes_at_once_is_no_part_of_a_step() {
    const TEXT: &str = "[time]\nend = '0.4 s'\n[ground]\nincline = '10.6624 deg'\n\
        [block.b0]\ndensity = '1386.2549 kg/m^3'\ndepth = '0.1 m'\nradius = '0.0954 m'\non = 'ground'\nat = '0 m'\n\
        velocity = ['0.1792 m/s', '0 m/s']\n\
        [force.f0]\non = 'b0'\nforce = ['-7.6689 N', '-4.0258 N']\ncouple = '0.6129 N m'\n\
        [block.b1]\ndensity = '2837.6261 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.3663 m'\nheight = '0.2851 m'\n\
        on = 'b0'\nat = '-0.0038 m'\nvelocity = ['1.3512 m/s', '0 m/s']\n\
        [block.b2]\ndensity = '709.3015 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.2357 m'\nheight = '0.2085 m'\nchamfer = '0.028 m'\n\
        on = 'b1'\nat = '-0.0088 m'\n\
        [contact.c]\nbetween = ['*', '*']\nfriction = 0.2619\nlaw = 'newton'\nrestitution = 0.6\n";
    for (step, off) in [("1 ms", 5e-5), ("500 us", 1e-5), ("200 us", 2e-6)] {
        let (simulation, _) = run(TEXT, step);
        let [x, ..] = pose(&simulation, "b1");
        assert!((x - 0.343_224_8).abs() < off, "{step}: {x}");
    }
}

/// A load that jumps within the step lifts the lower disc off the ground, and the upper one meets it: in flight, so that the ground has none of
/// that blow, but one of its own when the disc is back.
#[test]
fn what_has_left_the_ground_within_a_step_is_struck_in_flight() {
    const TEXT: &str = "[world]\ngravity = '0 m/s^2'\n[time]\nend = '1.1 ms'\n[ground]\n\
        [block.low]\nmass = '1 kg'\ninertia = '1.25e-3 kg m^2'\nradius = '0.05 m'\non = 'ground'\nat = '0 m'\n\
        [force.press]\non = 'low'\nforce = ['0 N', '-100 N']\n\
        [force.lift]\non = 'low'\nforce = ['0 N', '1100 N']\nsignal = 's'\n[signal.s]\nshape = 'constant'\nstart = '0.2 ms'\n\
        [block.high]\nmass = '1 kg'\ninertia = '1.25e-3 kg m^2'\nradius = '0.05 m'\nposition = ['0 m', '0.15178 m']\nvelocity = ['0 m/s', '-2 m/s']\n\
        [contact.c]\nbetween = ['*', '*']\nfriction = 0\nlaw = 'newton'\nrestitution = 0.5\n";
    // They meet 0.6 ms after the jump, 0.18 mm up, at 0.6 m/s and −2 m/s.
    let (met, height, mean, apart) = (0.8e-3, 0.18e-3, -0.7, 1.3);
    let (fall, rise) = (mean - 0.5 * apart, mean + 0.5 * apart);
    let back = f64::sqrt(fall * fall - 2e3 * height);
    let down = met + (-fall - back) / 1e3;
    let left = 1.1e-3 - down;
    let low = 0.05 + 0.5 * back * left + 500.0 * left * left;
    let high = 0.15 + height + rise * (1.1e-3 - met);
    for step in ["1.1 ms", "0.1 ms", "10 us"] {
        let (simulation, seen) = run(TEXT, step);
        assert_eq!(seen.impacts.len(), 2, "{step}: {:?}", seen.impacts);
        for (name, exact) in [("low", low), ("high", high)] {
            let [_, y, _] = pose(&simulation, name);
            assert!((y - exact).abs() < 1e-11, "{step}: {name} at {y}, {exact}");
        }
    }
}

/// Where a load jumps within a step, the block slides from then on, evenly accelerated, whatever the step.
#[test]
fn a_slide_that_a_jump_of_a_load_starts_begins_in_time() {
    let scene = "[time]\nend = '0.3 s'\n[ground]\n[block.b]\ndensity = '700 kg/m^3'\nwidth = '20 cm'\nheight = '10 cm'\ndepth = '10 cm'\n\
                 on = 'ground'\nat = '0 cm'\n[contact.c]\nbetween = ['b', 'ground']\nfriction = 0.3\n\
                 [signal.s]\nshape = 'constant'\nstart = '100.35 ms'\n[force.f]\non = 'b'\nforce = ['6 N', '0 N']\nsignal = 's'";
    let after = 0.3 - 0.100_35;
    let exact = (6.0 / 1.4 - 0.3 * G) * after * after / 2.0;
    for step in ["10 ms", "1 ms", "300 us"] {
        let (simulation, seen) = run(scene, step);
        let [x, ..] = pose(&simulation, "b");
        assert!((x - exact).abs() < 1e-12, "{step}: {x} {exact}");
        assert_eq!(seen.most_phases, 2, "{step}: one step is divided");
    }
}

/// A block that a force holds still, and that slides evenly accelerated after the force has risen to 4 N from `before` (N) in `lasting` (s),
/// from 20.5 ms on; and where it is at 100 ms by the closed form.
fn pushed_by_a_rise(before: f64, lasting: f64) -> (String, f64) {
    const AT: f64 = 0.0205;
    let limit = 0.3 * G;
    let scene = format!(
        "[time]\nend = '0.1 s'\n[ground]\n[block.b]\nmass = '1 kg'\ninertia = '0.04 kg m^2'\nwidth = '0.4 m'\nheight = '0.02 m'\n\
         on = 'ground'\nat = '0 m'\n[contact.c]\nbetween = ['b', 'ground']\nfriction = 0.3\n\
         [signal.s]\nshape = 'ramp'\nstart = '{AT} s'\nduration = '{lasting} s'\n\
         [force.f]\non = 'b'\nforce = ['{} N', '0 N']\nsignal = 's'\n[force.g]\non = 'b'\nforce = ['{before} N', '0 N']\n",
        4.0 - before
    );
    // The load passes the limit of friction on its way.
    let (rate, late) = ((4.0 - before) / lasting, (4.0 - limit) / (4.0 - before) * lasting);
    let left = 0.1 - AT - lasting;
    let (speed, way) = (0.5 * rate * late * late, rate * late * late * late / 6.0);
    (scene, way + speed * left + 0.5 * (4.0 - limit) * left * left)
}

/// A rise that is steeper than the steps is as good as a jump: what it lets slide does so in time. (What is left is that it may begin at the
/// start of the rise, or at its end.)
#[test]
fn a_slide_that_a_steep_rise_of_a_load_starts_begins_in_time() {
    for before in [0.4, -2.0] {
        for lasting in [1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 4e-4] {
            let (scene, exact) = pushed_by_a_rise(before, lasting);
            for step in ["5 ms", "1 ms", "800 us"] {
                let [x, ..] = pose(&run(&scene, step).0, "b");
                let in_time = 0.5 * lasting / 0.08 + 1e-9;
                assert!((x / exact - 1.0).abs() < in_time, "{before} N, {lasting} s, {step}: {x} {exact}");
            }
        }
    }
}

/// A force along the ground that jumps between bounces changes none of them: how much of an approach is the work of forces in a step is
/// told by the whole step, not by its part after the jump.
#[test]
fn bounces_are_those_without_a_jump() {
    let scene = |more: &str| {
        format!(
            "[time]\nend = '600 ms'\n[ground]\n[block.b]\ndensity = '700 kg/m^3'\nwidth = '20 cm'\nheight = '10 cm'\ndepth = '10 cm'\n\
             position = ['0 cm', '5.5 cm']\n[contact.c]\nbetween = ['b', 'ground']\nfriction = 0.0\nrestitution = 0.9\n{more}"
        )
    };
    let (free, without) = run(&scene(""), "10 ms");
    for start in ["419.9 ms", "422 ms", "426 ms", "426.2 ms", "426.28 ms"] {
        let force = format!(
            "[signal.s]\nshape = 'constant'\nstart = '{start}'\n[force.f]\non = 'b'\nforce = ['0.001 N', '0 N']\nsignal = 's'\n"
        );
        let (pushed, with) = run(&scene(&force), "10 ms");
        assert_eq!(with.impacts.len(), without.impacts.len(), "{start}");
        let off = (pose(&pushed, "b")[1] - pose(&free, "b")[1]).abs();
        assert!(off < 1e-9, "{start}: {off}");
    }
}
