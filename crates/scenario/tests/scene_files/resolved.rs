//! `resolved`: contact with a beam as a force that holds the gap closed.

use super::running::workspace;
use teeter_integrator::{Contact, Ended};
use teeter_scenario::simulation::Simulation;

fn source(name: &str) -> String {
    std::fs::read_to_string(workspace().join("scenarios").join(format!("{name}.toml"))).unwrap()
}

const SHAKEN: &str = r#"
[beam.table.motion]
acceleration = ["0 m/s^2", "1 m/s^2"]
signal = "s"
[signal.s]
shape = "harmonic"
frequency = "2 Hz"
"#;

/// The scene with these keys.
fn simulation(text: &str, sets: &[(&str, &str)]) -> Simulation {
    let sets: Vec<(String, String)> = [("time.scheme", "resolved")]
        .iter()
        .chain(sets)
        .map(|(key, value)| ((*key).to_owned(), (*value).to_owned()))
        .collect();
    Simulation::new(&teeter_scenario::load(text.as_bytes(), "scene.toml", "scene", &sets).unwrap().scene).unwrap()
}

fn error(text: &str, sets: &[(&str, &str)]) -> String {
    let sets: Vec<(String, String)> = [("time.scheme", "resolved")]
        .iter()
        .chain(sets)
        .map(|(key, value)| ((*key).to_owned(), (*value).to_owned()))
        .collect();
    teeter_scenario::load(text.as_bytes(), "scene.toml", "scene", &sets).unwrap_err().to_string()
}

/// Against `event-driven`, which locates every closure: 0.069285, 0.010829, −0.071369, 0.011699
/// rad.
#[test]
fn a_block_rocks_on_a_beam_as_it_does_event_by_event() {
    let text = source("free-rocking-on-beam");
    let exact = [(0.05, 0.069285), (0.1, 0.010829), (0.2, -0.071369), (0.3, 0.011699)];
    for (step, error) in [("1 ms", 3e-4), ("250 us", 1e-4), ("100 us", 1e-4)] {
        let mut simulation = simulation(&text, &[("time.step", step)]);
        let angle = simulation.layout.blocks[0].range.start + 2;
        for (t, phi) in exact {
            assert_eq!(simulation.run_until(t, &mut []).unwrap(), Ended::Complete);
            let found = simulation.state.q[angle];
            assert!((found - phi).abs() < error, "{step}, {t} s: {found} {phi}");
        }
    }
}

#[test]
fn neither_contact_nor_the_filter_makes_energy() {
    for (name, step) in [("free-rocking-on-beam", "1 ms"), ("free-rocking-on-beam-undeformed-start", "200 us")] {
        let mut simulation = simulation(&source(name), &[("time.step", step)]);
        let mut before = simulation.state.ledger.current.total();
        let mut lost = 0.0;
        while simulation.state.t < 0.3 {
            let report = simulation.step().unwrap();
            for phase in report.phases() {
                let energy = phase.energy;
                assert!(energy.contact + energy.friction <= 1e-14, "{name}: {energy:?}");
                assert!(energy.viscous <= 1e-15 && energy.numerical <= 0.0, "{name}: {energy:?}");
                assert!(energy.residual.abs() < 5e-15, "{name}: {energy:?}");
                lost -= energy.numerical;
            }
            let now = simulation.state.ledger.current.total();
            assert!(now - before < 1e-14, "{name}, {} s: {} J", simulation.state.t, now - before);
            before = now;
        }
        // It is the chatter's energy that the filter takes, some.
        assert!(lost > 0.0 && lost < 0.05 * simulation.state.ledger.initial.total(), "{name}: {lost} J");
    }
}

#[test]
fn a_block_at_rest_on_a_beam_stays_there() {
    let text = source("free-rocking-on-beam");
    let mut simulation =
        simulation(&text, &[("block.rocker.tilt", "0 deg"), ("time.end", "10 s"), ("time.step", "1 ms")]);
    let start = simulation.state.q.clone();
    let weight = 2700.0 * 0.03 * 0.03 * 0.135 * 9.81;
    while simulation.state.t < 9.9995 {
        let report = simulation.step().unwrap();
        // Of the world: the surface slopes under the feet.
        let up = |contact: &Contact<2>| (contact.frame.transpose() * contact.p).y;
        let (h, sum) = (report.h, report.contacts().map(up).sum::<f64>());
        assert!((sum / h / weight - 1.0).abs() < 1e-8, "{} N", sum / h);
    }
    let moved = simulation.state.q.iter().zip(&start).fold(0.0_f64, |moved, (q, q0)| moved.max((q - q0).abs()));
    assert!(moved < 1e-13, "{moved}");
}

#[test]
fn what_it_has_no_meaning_for_is_refused_with_place_and_remedy() {
    let beam = source("free-rocking-on-beam");
    for (text, sets, what) in [
        (source("free-rocking-on-ground"), vec![], "for contact with beams, but the scene has none"),
        (beam.clone(), vec![("contact.feet.restitution", "0.3")], "doesn't support restitution"),
        (beam.clone(), vec![("beam.table.axial", "held")], "held along its axis"),
        (beam.clone(), vec![("time.theta", "0.6")], "theta = 0.5"),
        (beam + SHAKEN, vec![], "moving supports"),
    ] {
        let said = error(&text, &sets);
        assert!(said.contains(what) && (said.contains("use ") || said.contains("leave theta out")), "{said}");
    }
}

/// The weight of a beam in modes has entries for its supports, too, which only move if they are
/// told to.
#[test]
fn a_heavy_beam_in_modes_carries_itself_and_a_block() {
    let text = source("free-rocking-on-beam");
    let modes = [("beam.table.model", "modes"), ("beam.table.self_weight", "true"), ("time.end", "0.05 s")];
    let mut simulation = simulation(&text, &modes);
    assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
    assert!(simulation.state.ledger.relative_residual() < 1e-13);
}

/// Modes that are fast for the step end it with other velocities than their mean: a foot that was
/// asked for a velocity of 0 sank by 0.8 mm on a beam of a ten-thousandth of the block's mass, a
/// lying block by 8 µm.
#[test]
fn what_stands_on_a_beam_does_not_sink_into_it() {
    let text = source("free-rocking-on-beam-undeformed-start");
    let block = text.find("[material.").unwrap();
    let light = format!(
        "{}[material.light]\ndensity = \"2 kg/m^3\"\nyoungs_modulus = \"69 GPa\"\n\n{}",
        &text[..block],
        &text[block..]
    );
    let light_beam = [("beam.table.material", "light"), ("time.end", "0.1 s"), ("time.step", "100 us")];
    let lying = [("block.rocker.tilt", "1.5707963267948966 rad"), ("time.end", "0.4 s"), ("time.step", "100 us")];
    for (text, sets) in [(&light, light_beam), (&text, lying)] {
        // A hump of a shaking beam comes out under the base between two looks.
        for (points, most) in [("corners", 2e-9), ("all", 2e-6)] {
            let sets: Vec<_> = sets.into_iter().chain([("contact.feet.points", points)]).collect();
            let mut simulation = simulation(text, &sets);
            assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
            let depth = simulation.state.tally.max_penetration;
            assert!(depth < most, "{points}: {depth} m");
        }
    }
}
