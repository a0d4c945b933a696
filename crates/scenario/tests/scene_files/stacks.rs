//! Blocks on blocks.

use teeter_scenario::load;
use teeter_scenario::simulation::Simulation;

const WEIGHT: f64 = 2700.0 * 0.1 * 0.1 * 0.1 * 9.81;

/// Boxes of 10 cm on each other; `keys` are those of their table, `more` what comes after.
fn scene(time: &str, keys: &str, more: &str) -> String {
    format!(
        "[time]\n{time}\n[ground]\n[material.m]\ndensity = '2700 kg/m^3'\n[material.heavy]\ndensity = '2.7e6 kg/m^3'\n\
         [block.box]\nmaterial = 'm'\nwidth = '10 cm'\nheight = '10 cm'\ndepth = '10 cm'\n{keys}\n{more}\n\
         [contact.floor]\nbetween = ['*', 'ground']\nfriction = 0.5\n[contact.joints]\nbetween = ['*', '*']\nfriction = 0.5\n"
    )
}

fn simulation(text: &str, sets: &[(&str, &str)]) -> Simulation {
    let resolved = load(text.as_bytes(), "scene", "scene", &super::sets(sets));
    Simulation::new(&resolved.unwrap_or_else(|errors| panic!("{errors}\n{text}")).scene).unwrap()
}

fn run(simulation: &mut Simulation) {
    let ended = simulation.run(&mut []).unwrap();
    assert!(matches!(ended, teeter_integrator::Ended::Complete), "{ended:?}");
}

/// Runs, and says by how much any coordinate has changed.
fn drift(simulation: &mut Simulation) -> f64 {
    let start = simulation.state.q.clone();
    run(simulation);
    simulation.state.q.iter().zip(&start).map(|(q, start)| (q - start).abs()).fold(0.0, f64::max)
}

const STACKED: &str = "on = 'ground'\nat = '0 m'\nrepeat = { count = 19, stacked = true }";

fn load_of(material: &str) -> String {
    format!(
        "[block.load]\nmaterial = '{material}'\nwidth = '10 cm'\nheight = '10 cm'\ndepth = '10 cm'\non = 'box-19'\nat = '0 m'"
    )
}

#[test]
fn twenty_blocks_rest_for_ten_seconds_under_an_equal_and_under_a_heavy_one() {
    for material in ["m", "heavy"] {
        let text = scene("end = '10 s'\nstep = '1 ms'", STACKED, &load_of(material));
        let drift = drift(&mut simulation(&text, &[]));
        assert!(drift < 1e-10, "{material}: {drift:e} m");
    }
}

#[test]
fn every_joint_bears_the_weight_above_it() {
    for (material, top) in [("m", 1.0), ("heavy", 1000.0)] {
        let text = scene("end = '0.1 s'\nstep = '1 ms'", STACKED, &load_of(material));
        let mut simulation = simulation(&text, &[]);
        run(&mut simulation);
        let step = simulation.step().unwrap();
        let mut pressed = [0.0; 20];
        for contact in step.contacts() {
            let upper = contact.sides.iter().map(|side| side.body.0).filter(|body| *body < 20).max().unwrap();
            pressed[upper as usize] += contact.p[0] / 1e-3;
        }
        for (k, pressed) in pressed.iter().enumerate() {
            let above = WEIGHT * (19.0 - k as f64 + top);
            assert!((pressed / above - 1.0).abs() < 1e-8, "{material}, joint {k}: {pressed} N, not {above} N");
        }
    }
}

/// Case S5 of the reference: five blocks of half the height, at rest for a second, by the scheme of
/// the theory page.
#[test]
fn every_scheme_keeps_a_stack_at_rest() {
    let repeat = "on = 'ground'\nat = '0 m'\nrepeat = { count = 5, stacked = true }";
    let text = scene("end = '1 s'\nstep = '1 ms'", repeat, "").replace("height = '10 cm'", "height = '5 cm'");
    for scheme in teeter_integrator::schemes() {
        if scheme.name == "resolved" {
            continue; // there is no beam
        }
        let drift = drift(&mut simulation(&text, &[("time.scheme", scheme.name)]));
        assert!(drift < 1e-12, "{}: {drift:e} m", scheme.name);
    }
}

/// From gaps of 1 mm the blocks fall onto each other; then they lie still.
#[test]
fn a_stack_that_falls_together_comes_to_rest() {
    let keys = "position = ['0 m', '5.1 cm']\nrepeat = { count = 20, shift = ['0 m', '10.1 cm'] }";
    let mut simulation = simulation(&scene("end = '1 s'\nstep = '1 ms'", keys, ""), &[]);
    run(&mut simulation);
    let there = simulation.state.q.clone();
    assert!(there.chunks_exact(3).enumerate().all(|(k, q)| (q[1] - 0.05 - 0.1 * k as f64).abs() < 1e-3));
    let ended = simulation.run_until(2.0, &mut []).unwrap();
    assert!(matches!(ended, teeter_integrator::Ended::Complete), "{ended:?}");
    let moved = simulation.state.q.iter().zip(&there).map(|(q, there)| (q - there).abs()).fold(0.0, f64::max);
    assert!(moved < 1e-9, "{moved:e} m");
}

/// A stack of five on an incline tips about its toe where tan β = 1/5.
#[test]
fn a_tilted_stack_falls_when_its_centre_passes_the_toe() {
    let repeat = "on = 'ground'\nat = '0 m'\nrepeat = { count = 5, stacked = true }";
    let text = scene("end = '1.5 s'\nstep = '1 ms'", repeat, "");
    let critical = 0.2_f64.atan().to_degrees();
    for scheme in ["moreau-jean-closed", "moreau-jean-located", "event-driven"] {
        for (off, falls) in [(-0.005, false), (0.005, true)] {
            let incline = format!("{} deg", critical + off);
            let drift = drift(&mut simulation(&text, &[("time.scheme", scheme), ("ground.incline", &incline)]));
            assert!(if falls { drift > 1e-3 } else { drift < 1e-10 }, "{scheme}, {incline}: {drift:e} m");
        }
    }
}

/// A plank falls off the block that it lies on when its middle is past the edge, to a micrometre.
#[test]
fn a_plank_tips_when_its_centre_passes_the_edge() {
    for scheme in ["moreau-jean", "moreau-jean-closed", "moreau-jean-located", "event-driven"] {
        for (off, falls) in [(-1e-6, false), (1e-6, true)] {
            let plank = format!(
                "[block.plank]\nmaterial = 'm'\nwidth = '30 cm'\nheight = '2 cm'\ndepth = '10 cm'\non = 'box'\nat = '{} m'",
                0.05 + off
            );
            let text = scene("end = '2 s'\nstep = '1 ms'", "on = 'ground'\nat = '0 m'", &plank);
            let drift = drift(&mut simulation(&text, &[("time.scheme", scheme)]));
            assert!(if falls { drift > 1e-2 } else { drift < 1e-12 }, "{scheme}, {off}: {drift:e} m");
        }
    }
}

/// The block below is as the ground to the one above, if it can't move: the same motion.
#[test]
fn a_block_rocks_on_a_block_as_on_the_ground() {
    let rocker = |on: &str| {
        format!(
            "[block.rocker]\nmaterial = 'm'\nwidth = '3 cm'\nheight = '13.5 cm'\ndepth = '3 cm'\non = '{on}'\nat = '0 m'\ntilt = '5 deg'"
        )
    };
    let held = "on = 'ground'\nat = '0 m'\nmotion = { velocity = ['0 m/s', '0 m/s'], only = 'x', angular_velocity = '0 rad/s' }";
    for scheme in ["moreau-jean", "moreau-jean-closed", "moreau-jean-located", "event-driven"] {
        let of = |on: &str, keys: &str| {
            let text = scene("end = '0.5 s'\nstep = '0.5 ms'", keys, &rocker(on)).replace("2700 kg/m^3", "700 kg/m^3");
            let mut simulation = simulation(&text, &[("time.scheme", scheme)]);
            run(&mut simulation);
            simulation.state.q[3..6].to_vec()
        };
        let below = "on = 'ground'\nat = '1 m'\n";
        let (on_ground, on_block) = (of("ground", below), of("box", held));
        let off = (on_ground[2] - on_block[2]).abs().max((on_ground[1] + 0.1 - on_block[1]).abs());
        assert!(off < 1e-9, "{scheme}: {on_ground:?} {on_block:?}");
    }
}

#[test]
fn patterns_join_what_is_not_joined_by_name() {
    let text =
        scene("end = '1 s'\nstep = '1 ms'", "on = 'ground'\nat = '0 m'\nrepeat = { count = 3, stacked = true }", "");
    let named = text + "[contact.own]\nbetween = ['box-3', 'box-2']\nfriction = 0.1\n";
    let scene = load(named.as_bytes(), "scene", "scene", &[]).unwrap().scene;
    let joined: Vec<_> = scene.contacts.iter().map(|c| (c.name.as_str(), c.between.join(" "))).collect();
    let expected = [
        ("own", "box-3 box-2"),
        ("floor", "box-1 ground"),
        ("floor", "box-2 ground"),
        ("floor", "box-3 ground"),
        ("joints", "box-1 box-2"),
        ("joints", "box-1 box-3"),
    ];
    assert_eq!(joined, expected.map(|(name, between)| (name, between.to_owned())));
}

/// Two blocks in free flight that meet and glide off each other: where a corner passes the end of a
/// side is an event.
#[test]
fn a_corner_that_glides_off_a_side_is_located() {
    let text = "[time]\nend = '0.3 s'\nstep = '1 ms'\n[world]\ngravity = '0 m/s^2'\n[ground]\n[material.a]\ndensity = '1000 kg/m^3'\n\
        [block.a]\nmaterial = 'a'\nwidth = '0.7488 m'\nheight = '0.4369 m'\ndepth = '0.1 m'\nposition = ['-1.4975 m', '10 m']\nangle = '-0.9048 rad'\n\
        velocity = ['3.0709 m/s', '0 m/s']\nspin = '1.9524 rad/s'\n\
        [block.b]\nmaterial = 'a'\nwidth = '0.6118 m'\nheight = '1.0281 m'\ndepth = '0.1 m'\nposition = ['1.4975 m', '9.6705 m']\nangle = '0.4119 rad'\n\
        velocity = ['-7.2132 m/s', '0 m/s']\nspin = '2.3373 rad/s'\n[contact.c]\nbetween = ['a', 'b']\n";
    let contact = "friction = 0.0\nrestitution = 0.0\n";
    let end = |scheme: &str, step: &str, order: bool| {
        let between = if order { "['a', 'b']" } else { "['b', 'a']" };
        let text = format!("{text}{contact}").replace("['a', 'b']", between);
        let mut simulation = simulation(&text, &[("time.scheme", scheme), ("time.step", step)]);
        run(&mut simulation);
        simulation.state.q.clone()
    };
    let off = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let reference = end("event-driven", "10 us", true);
    // They did touch, and what touched has parted: the spins have changed, and the motion is not
    // that of a free flight.
    assert!(off(&reference[..1], &[-1.4975 + 3.0709 * 0.3]) > 0.1, "{reference:?}");
    for (step, order) in [("1 ms", true), ("100 us", true), ("1 ms", false)] {
        let off = off(&end("event-driven", step, order), &reference);
        assert!(off < 1e-8, "{step}: {off:e}");
    }
    for (step, order, bound) in
        [("1 ms", true, 2e-5), ("100 us", true, 3e-7), ("10 us", true, 3e-9), ("100 us", false, 3e-7)]
    {
        let off = off(&end("moreau-jean-located", step, order), &reference);
        assert!(off < bound, "{step}: {off:e}");
    }
}

/// How far a stack of boxes drifts in half a second under a load so many times as heavy, and what is warned of before.
fn under_load(boxes: u32, ratio: &str, friction: f64) -> (f64, Vec<String>) {
    let stacked = format!("on = 'ground'\nat = '0 m'\nrepeat = {{ count = {boxes}, stacked = true }}");
    let load = load_of("heavy").replace("box-19", &format!("box-{boxes}"));
    let text = scene("end = '0.5 s'\nstep = '1 ms'", &stacked, &load)
        .replace("2.7e6 kg/m^3", &format!("{} kg/m^3", 2700.0 * ratio.parse::<f64>().unwrap()))
        .replace("friction = 0.5", &format!("friction = {friction}"));
    let found = teeter_scenario::load(text.as_bytes(), "scene", "scene", &[]).unwrap();
    let warnings = found.warnings.iter().map(|found| found.rule.clone()).collect();
    (drift(&mut Simulation::new(&found.scene).unwrap()), warnings)
}

/// What a load squeezes out by as little as rounding leaves of its weight is warned of before the run; what holds is not.
#[test]
fn loads_that_stacks_bear_are_not_warned_of_and_others_are() {
    for (ratio, friction, most) in
        [("1e3", 0.0, 1e-8), ("0.9e5", 0.0, 1e-5), ("1e3", 0.5, 1e-10), ("0.9e6", 0.3, 1e-6), ("0.9e6", 0.5, 1e-6)]
    {
        for boxes in [4, 11, 19] {
            let (drift, warnings) = under_load(boxes, ratio, friction);
            assert!(drift < most, "{boxes} boxes, {ratio}, {friction}: {drift:e} m");
            assert!(warnings.is_empty(), "{boxes} boxes, {ratio}, {friction}: {warnings:?}");
        }
    }
    for (ratio, friction) in [("3e5", 0.0), ("1e7", 0.0), ("1e7", 0.5), ("1e-7", 0.5)] {
        let (_, warnings) = under_load(4, ratio, friction);
        assert!(warnings.len() == 1 && warnings[0].contains("times as heavy as"), "{ratio}, {friction}: {warnings:?}");
    }
}

/// A light block on a heavy one isn't squeezed; one that moves as prescribed, such as a fixed one, has no weight to do it.
#[test]
fn only_what_presses_on_a_light_block_is_warned_of() {
    let of = |below: &str, keys: &str| {
        let text = scene("end = '1 s'\nstep = '1 ms'", "on = 'load'\nat = '0 m'", "")
            .replace("friction = 0.5", "friction = 0");
        let load = format!(
            "[block.load]\nmaterial = 'heavy'\nwidth = '10 cm'\nheight = '10 cm'\ndepth = '10 cm'\n{below}\n{keys}\n[contact.floor]"
        );
        let text = text.replace("[contact.floor]", &load).replace("2.7e6", "1.35e9");
        teeter_scenario::load(text.as_bytes(), "scene", "scene", &[])
            .unwrap_or_else(|e| panic!("{e}\n{text}"))
            .warnings
            .len()
    };
    assert_eq!(of("on = 'ground'\nat = '0 m'", ""), 0, "5e5 times as heavy, below");
    let flies = "position = ['0 m', '5 cm']";
    assert_eq!(of(flies, "motion = { velocity = ['0 m/s', '0 m/s'], only = 'x', angular_velocity = '0 rad/s' }"), 0);
}
