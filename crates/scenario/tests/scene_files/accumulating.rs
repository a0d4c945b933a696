//! Bounces of bodies between several contacts that follow each other ever faster, until all of them are closed.

use teeter_integrator::{Ended, State};
use teeter_scenario::simulation::Simulation;

/// The end of a run.
fn run(scene: &str, scheme: &str, step: &str) -> State {
    let sets =
        [("time.scheme", scheme), ("time.step", step)].map(|(key, value)| (key.to_owned(), format!("\"{value}\"")));
    let resolved = teeter_scenario::load(scene.as_bytes(), "bounces", "bounces", &sets).unwrap();
    let mut simulation = Simulation::new(&resolved.scene).unwrap();
    assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete, "{scheme}");
    simulation.state
}

/// A pentagon strikes two discs that lie on the ground, and these each other: each of the blows parts a contact that
/// was inside its surface for a part of the step only.
#[test]
fn a_touch_that_is_over_by_the_end_of_a_step_is_found() {
    let scene = "[world]\ngravity = '0 m/s^2'\n[time]\nend = '0.16 s'\nstep = '1 ms'\n[ground]\n\
         [contact.c]\nbetween = ['*', '*']\nfriction = 0.0\nrestitution = 0.015\n\
         [block.b1]\ndensity = '764.7 kg/m^3'\ndepth = '0.1 m'\nradius = '0.04534 m'\n\
         position = ['-0.11158 m', '0.28201 m']\nangle = '22.980 deg'\nvelocity = ['0.77106 m/s', '-1.76776 m/s']\n\
         [block.b2]\ndensity = '1040.1 kg/m^3'\ndepth = '0.1 m'\n\
         shape = { kind = 'regular', sides = 5, radius = '0.07699 m' }\n\
         position = ['0.03565 m', '0.36317 m']\nangle = '85.433 deg'\nvelocity = ['0.12420 m/s', '-1.77305 m/s']\n\
         [block.b3]\ndensity = '705.8 kg/m^3'\ndepth = '0.1 m'\nradius = '0.03952 m'\n\
         position = ['0.12635 m', '0.17824 m']\nangle = '-39.495 deg'\nvelocity = ['-1.46191 m/s', '-1.00046 m/s']\n\
         spin = '-2.0290 rad/s'\n";
    let known = run(scene, "event-driven", "1 ms");
    assert_eq!(known.tally.unlocated_steps, 0);
    // The discs are sent to and fro more often than this scheme locates in a step, and nothing pulls them down.
    for step in ["20 us", "0.5 ms", "1 ms"] {
        let state = run(scene, "moreau-jean-located", step);
        for (v, exact) in state.v.iter().zip(&known.v) {
            assert!((v - exact).abs() < 6e-4, "{step}: {:?} and {:?}", state.v, known.v);
        }
    }
}

/// A block is sent to and fro between the ground and another block, some sixty times within 0.1 ms, and comes to lie against both.
#[test]
fn bounces_between_two_contacts_accumulate_as_they_would() {
    let scene = "[time]\nend = '0.296 s'\nstep = '1 ms'\n\
         [ground]\nprofile = { points = [['0.541957202406064 m', '0.122196490089568 m'], ['1.48285837704427 m', '0.105059591946362 m']] }\n\
         [contact.c]\nbetween = ['*', '*']\nfriction = 5\nrestitution = 0.3\n\
         [block.a]\ndensity = '1000 kg/m^3'\ndepth = '10 cm'\nwidth = '0.284158799783967 m'\nheight = '0.259620961399289 m'\n\
         position = ['0.336668341955936 m', '0.6 m']\nangle = '68.49973156305452 deg'\n\
         velocity = ['0.3187546609766483 m/s', '-0.7677899982949833 m/s']\nspin = '1.5959034535058025 rad/s'\n\
         [block.b]\ndensity = '7000 kg/m^3'\ndepth = '10 cm'\nwidth = '0.151649352508597 m'\nheight = '0.311752235854271 m'\n\
         position = ['0.456756634766321 m', '1.6 m']\nangle = '-25.336756785130333 deg'\n\
         velocity = ['0 m/s', '-2 m/s']\nspin = '-2.5126502946435636 rad/s'\n";
    let known = run(scene, "event-driven", "1 ms");
    // A blow of both at once, before the bounces have died out, leaves 0.03 to 0.2 m/s.
    for (step, bound) in [("100 us", 2e-3), ("20 us", 5e-4), ("5 us", 2e-4)] {
        let state = run(scene, "moreau-jean-located", step);
        assert_eq!(state.tally.unlocated_steps, 0, "{step}");
        for (v, exact) in state.v.iter().zip(&known.v) {
            assert!((v - exact).abs() < bound, "{step}: {:?} and {:?}", state.v, known.v);
        }
    }
}
