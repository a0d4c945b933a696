//! Sides that meet flush after one of the blocks has landed, and keeps a tilt of what its corners have sunk in.

use super::located::{pose, run, simulation};
use teeter_integrator::Ended;
use teeter_scenario::simulation::Simulation;

/// Runs a scene at 1 ms, in which blocks must end where they do in an event-driven run, to this accuracy (m).
fn ends(text: &str, blocks: &[(&str, f64)], accuracy: f64) -> Simulation {
    let (simulation, seen) = run(text, "1 ms");
    for (name, end) in blocks {
        let [x, ..] = pose(&simulation, name);
        assert!((x - end).abs() < accuracy, "{name}: {x}, {:?}", seen.impacts);
    }
    simulation
}

/// A block that landed keeps a tilt, as one corner has sunk in deeper than the other. Where its side meets a wall flush it doesn't turn:
/// both corners of the side strike in one impact. The end is that of `event-driven`, which keeps no tilt: after the blow it slides back
/// and stops.
#[test]
fn a_side_meets_a_wall_flush_after_a_landing() {
    const TEXT: &str = "[time]\nend = '0.8 s'\n[ground]\n\
        [block.b]\ndensity = '1500 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.164 m'\nheight = '0.337 m'\non = 'ground'\nat = '0 m'\n\
        tilt = '0.532 deg'\nvelocity = ['1.627 m/s', '0 m/s']\n\
        [block.wall]\ndensity = '2000 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.2 m'\nheight = '0.6 m'\nposition = ['0.5 m', '0.3 m']\n\
        fixed = true\n\
        [contact.c]\nbetween = ['b', 'ground']\nfriction = 0.13\n\
        [contact.w]\nbetween = ['b', 'wall']\nfriction = 0.13\nlaw = 'energetic'\nrestitution = 0.5\n";
    for step in ["1 ms", "250 us"] {
        let (simulation, seen) = run(TEXT, step);
        let [x, _, phi] = pose(&simulation, "b");
        assert!((x - 0.138_406).abs() < 2e-6 && phi.abs() < 1e-5, "{step}: {x} {phi}, {:?}", seen.impacts);
    }
}

/// The same where a sliding block meets another one that has landed, and both move on together.
#[test]
fn two_sides_meet_flush_after_a_landing() {
    const TEXT: &str = "[time]\nend = '0.6 s'\n[ground]\n\
        [block.b0]\ndensity = '1440 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.30 m'\nheight = '0.21 m'\non = 'ground'\nat = '0 m'\n\
        velocity = ['0.98 m/s', '0 m/s']\n\
        [block.b1]\ndensity = '2160 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.165 m'\nheight = '0.20 m'\non = 'ground'\nat = '0.38 m'\n\
        tilt = '1.0 deg'\n\
        [contact.c]\nbetween = ['*', '*']\nfriction = 0.1\nlaw = 'newton'\nrestitution = 0.0\n";
    ends(TEXT, &[("b0", 0.252_774_1), ("b1", 0.486_189_8)], 1e-6);
}

/// A block that landed lies against a wall without pressing: the corner that its tilt leaves open takes part when another one strikes it,
/// so that both stop dead.
#[test]
fn what_lies_against_a_wall_does_not_hop_when_struck() {
    const TEXT: &str = "[time]\nend = '0.6 s'\n[ground]\n\
        [block.b]\ndensity = '2000 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.2 m'\nheight = '0.2 m'\non = 'ground'\nat = '0 m'\n\
        tilt = '0.2 deg'\nvelocity = ['1 m/s', '0 m/s']\n\
        [block.a]\ndensity = '2000 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.2 m'\nheight = '0.2 m'\non = 'ground'\nat = '-0.7 m'\n\
        velocity = ['3 m/s', '0 m/s']\n\
        [block.wall]\ndensity = '2000 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.2 m'\nheight = '0.6 m'\nfixed = true\n\
        position = ['0.25 m', '0.3 m']\n\
        [contact.c]\nbetween = ['?', 'ground']\nfriction = 0.1\n\
        [contact.d]\nbetween = ['a', 'b']\nfriction = 0\n[contact.f]\nbetween = ['b', 'wall']\nfriction = 0\n";
    let simulation = ends(TEXT, &[("b", 0.05), ("a", -0.15)], 1e-6);
    let [_, y, _] = pose(&simulation, "b");
    assert!((y - 0.1).abs() < 1e-6, "{y}");
}

/// Two blocks whose sides press against each other tilt together, and come down in one impact, though they don't stand on each other.
#[test]
fn what_is_pressed_together_lands_together() {
    const TEXT: &str = "[time]\nend = '0.8 s'\n[ground]\n\
        [block.a]\ndensity = '2000 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.2343 m'\nheight = '0.1956 m'\non = 'ground'\nat = '0 m'\n\
        velocity = ['2.474 m/s', '0 m/s']\n\
        [block.b]\ndensity = '2000 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.1765 m'\nheight = '0.2381 m'\non = 'ground'\n\
        at = '0.4357 m'\n\
        [contact.c]\nbetween = ['?', 'ground']\nfriction = 0.1093\n[contact.d]\nbetween = ['a', 'b']\nfriction = 0\n";
    ends(TEXT, &[("a", 0.831_113_5), ("b", 1.047_116_1)], 5e-6);
}

/// A block rides on a cart that has landed, and is tilted by the cart's tilt, too, when it meets a wall.
#[test]
fn a_rider_meets_a_wall_flush() {
    const TEXT: &str = "[time]\nend = '0.6 s'\n[ground]\n\
        [block.a]\ndensity = '2000 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.6 m'\nheight = '0.1 m'\non = 'ground'\nat = '0 m'\n\
        tilt = '0.3 deg'\nvelocity = ['2 m/s', '0 m/s']\n\
        [block.b]\ndensity = '2000 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.3 m'\nheight = '0.5 m'\non = 'a'\nat = '0.16 m'\n\
        velocity = ['2 m/s', '0 m/s']\n\
        [block.wall]\ndensity = '2000 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.2 m'\nheight = '1 m'\nposition = ['0.85 m', '0.65 m']\n\
        fixed = true\n\
        [contact.ag]\nbetween = ['a', 'ground']\nfriction = 0.05\n[contact.ab]\nbetween = ['a', 'b']\nfriction = 0.6\n\
        [contact.bw]\nbetween = ['b', 'wall']\nfriction = 0\nrestitution = 0.5\n";
    ends(TEXT, &[("a", 0.516_331_2), ("b", 0.496_731_1)], 2e-5);
}

/// A block that rocked until it rested is thrown up by its ground at 0.78 s, lands at 1 s, and bounces from then on.
fn thrown(restitution: f64) -> String {
    format!(
        "[time]\nend = '1.2 s'\n[ground]\nmotion = {{ acceleration = ['0 m/s^2', '18.737 m/s^2'], signal = 'jolt' }}\n\
         [signal.jolt]\nshape = 'one-sine'\nfrequency = '3.32 Hz'\nstart = '0.7 s'\n\
         [block.a]\ndensity = '2000 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.2202 m'\nheight = '0.2894 m'\non = 'ground'\nat = '0 m'\n\
         tilt = '0.591 deg'\n[contact.c]\nbetween = ['*', '*']\nfriction = 0.5988\nrestitution = {restitution}\n"
    )
}

/// What a block that rests is tilted by, it is still tilted by when it lands after a flight: flush, and flush again after a bounce.
#[test]
fn a_block_that_is_thrown_up_from_rest_lands_flush() {
    // Where it rests it is tilted by what corners sink in, which grows as the step squared.
    for (restitution, step, tilt) in
        [(0.0, "1 ms", 2e-5), (0.3, "1 ms", 2e-5), (0.3, "250 us", 2e-6), (0.3, "3 ms", 2e-4)]
    {
        let (simulation, seen) = run(&thrown(restitution), step);
        let [.., phi] = pose(&simulation, "a");
        assert!(phi.abs() < tilt, "{restitution} {step}: {phi}, {:?}", seen.impacts);
        let together = |pair: &[(f64, f64, f64)]| pair[0].0 == pair[1].0 && pair[0].0 > 0.9;
        assert!(seen.impacts.windows(2).any(together), "{restitution} {step}: {:?}", seen.impacts);
    }
}

/// A state in the middle of the flight holds all that the landing needs.
#[test]
fn a_flight_goes_on_from_its_state() {
    let mut whole = simulation(&thrown(0.3), "1 ms");
    let mut again = simulation(&thrown(0.3), "1 ms");
    assert_eq!(whole.run_until(0.9, &mut []).unwrap(), Ended::Complete);
    again.state = whole.state.clone();
    for run in [&mut whole, &mut again] {
        assert_eq!(run.run(&mut []).unwrap(), Ended::Complete);
    }
    assert_eq!((&whole.state.q, &whole.state.v), (&again.state.q, &again.state.v));
    assert!(whole.state.q[2].abs() < 2e-5, "{:?}", whole.state.q);
}

/// So do two blocks that fly together, one on the other: the lower one has lost the ground, though a contact with the upper one may stay.
#[test]
fn a_stack_that_is_thrown_up_from_rest_lands_flush() {
    let upper = "[block.b]\ndensity = '2000 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.1 m'\nheight = '0.1 m'\non = 'a'\nat = '0 m'\n";
    for (jolt, restitution) in [("18.737", 0.0), ("18.737", 0.3), ("20", 0.0)] {
        for step in ["1 ms", "250 us"] {
            let text = thrown(restitution).replace("18.737", jolt) + upper;
            let (simulation, seen) = run(&text, step);
            for name in ["a", "b"] {
                let [.., phi] = pose(&simulation, name);
                assert!(phi.abs() < 5e-5, "{jolt} {restitution} {step} {name}: {phi}, {:?}", seen.impacts);
            }
        }
    }
}

/// A block that a small couple turns by 1e-6 rad in flight lands on one corner first, though it was tilted by as much where it rested:
/// what it turns is real. The spin is that of `event-driven`.
#[test]
fn a_block_that_turns_in_flight_lands_on_one_corner() {
    const TEXT: &str = "[time]\nend = '0.81 s'\n[ground]\n\
        [block.b]\ndensity = '2000 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.156 m'\nheight = '0.2354 m'\non = 'ground'\nat = '0 m'\n\
        tilt = '1.556 deg'\n[contact.c]\nbetween = ['b', 'ground']\nfriction = 0.4\nrestitution = 0.4\n\
        [signal.s]\nshape = 'half-sine'\nstart = '0.5 s'\nduration = '20 ms'\n\
        [force.f]\non = 'b'\nforce = ['0 N', '864.7581 N']\ncouple = '0.000014225 N m'\nsignal = 's'\n";
    for (step, accuracy) in [("2 ms", 2e-2), ("1 ms", 1e-2), ("500 us", 1e-2)] {
        let (simulation, seen) = run(TEXT, step);
        let spin = simulation.state.v[2];
        assert!((spin + 3.7648).abs() < accuracy, "{step}: {spin}, {:?}", seen.impacts);
    }
}
