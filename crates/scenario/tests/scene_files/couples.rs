//! Action and reaction have no couple: what presses in a wedge turns nothing, and two bodies by themselves keep their angular momentum.

use super::located::{pose, run, simulation};
use teeter_integrator::Ended;
use teeter_scenario::simulation::Simulation;

/// A disc falls into a body with two arms that stands on the ground, and is stuck between them: their self-stress is of any size.
fn wedge(tilt: &str, disc: &str, friction: &str, more: &str) -> String {
    format!(
        "[time]\nend = '1 s'\n{more}[material.m]\ndensity = '2000 kg/m^3'\n[ground]\n\
         [block.vee]\nmaterial = 'm'\ndepth = '0.1 m'\nposition = ['0 m', '0.16 m']\nangle = '{tilt}'\n\
         parts = [{{ width = '0.3 m', height = '0.03 m' }}, {{ width = '0.03 m', height = '0.3 m', at = ['-0.09 m', '0.13 m'], angle = '30 deg' }}, \
         {{ width = '0.03 m', height = '0.3 m', at = ['0.09 m', '0.13 m'], angle = '-30 deg' }}]\n\
         [block.disc]\nmaterial = 'm'\ndepth = '0.1 m'\nradius = '0.07 m'\n{disc}\n\
         [contact.all]\nbetween = ['*', '*']\nfriction = {friction}\n"
    )
}

#[test]
fn a_body_with_a_disc_in_its_wedge_comes_to_rest_on_both_feet() {
    let disc = "position = ['0.01175 m', '0.45 m']\nvelocity = ['0.3018 m/s', '0 m/s']\nspin = '0.9115 rad/s'";
    // When each of two bodies pushed the other at its own surface, the self-stress grew to 1e6 N s a step, and the body stood askew.
    let (simulation, _) = run(&wedge("-3.7387 deg", disc, "0.7", ""), "200 us");
    let [.., tilt] = pose(&simulation, "vee");
    assert!(tilt.abs() < 1e-6, "{tilt}");

    let disc = "position = ['0.02847 m', '0.45 m']\nvelocity = ['0.3552 m/s', '0 m/s']\nspin = '-2.6062 rad/s'";
    let scene = wedge("-6.3502 deg", disc, "0.8", "step = '200 us'\nscheme = 'moreau-jean-closed'\n");
    let resolved = teeter_scenario::load(scene.as_bytes(), "wedge", "wedge", &[]).unwrap();
    let mut simulation = Simulation::new(&resolved.scene).unwrap();
    assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
    let [.., tilt] = pose(&simulation, "vee");
    // A corner closes up to a step late, 0.2 mm of 0.3 m; it hung at 0.31 rad.
    assert!(tilt.abs() < 1e-3, "{tilt}");
}

/// Two discs that yield by millimetres rub against each other in flight.
#[test]
fn what_yields_keeps_the_angular_momentum() {
    let discs = [(1.0, 0.005), (2.0, 0.0144)];
    for law in [
        "law = 'hunt-crossley'\nstiffness = '1e5 N/m^1.5'\ndamping = '0.05 s/m'",
        "law = 'kelvin-voigt'\nstiffness = '3e4 N/m'\ndamping = '2 N s/m'",
    ] {
        let scene = format!(
            "[time]\nend = '0.5 s'\n[world]\ngravity = '0 m/s^2'\n\
             [block.a]\nradius = '0.1 m'\nmass = '1 kg'\ninertia = '0.005 kg m^2'\nposition = ['0 m', '0 m']\nvelocity = ['2 m/s', '0 m/s']\n\
             spin = '15 rad/s'\n\
             [block.b]\nradius = '0.12 m'\nmass = '2 kg'\ninertia = '0.0144 kg m^2'\nposition = ['0.5 m', '0.08 m']\nspin = '3 rad/s'\n\
             [contact.c]\nbetween = ['a', 'b']\nfriction = 0.8\n{law}\n"
        );
        let mut simulation = simulation(&scene, "20 us");
        let angular = |simulation: &Simulation| -> f64 {
            let blocks = simulation.layout.blocks.iter().zip(discs);
            blocks
                .map(|(block, (mass, inertia))| {
                    let (q, v) = (&simulation.state.q[block.range.clone()], &simulation.state.v[block.range.clone()]);
                    mass * (q[0] * v[1] - q[1] * v[0]) + inertia * v[2]
                })
                .sum()
        };
        let before = angular(&simulation);
        assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
        let v = &simulation.state.v;
        assert!((v[0] - 2.0).abs() > 0.5 && (v[2] - 15.0).abs() > 1.0, "they touched: {v:?}");
        let after = angular(&simulation);
        assert!((after - before).abs() < 1e-7 * before.abs(), "{law}: {before} to {after}");
    }
}
