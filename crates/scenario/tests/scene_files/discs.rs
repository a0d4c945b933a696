//! Discs on blocks: the time at which one comes to the corner at the end of a side.

use super::located::{pose, run};
use std::ops::ControlFlow;
use teeter_integrator::{Ended, Model, Observer, ObserverError, State, StepReport};
use teeter_scenario::simulation::Simulation;

/// A disc slides off the end of a block that slides under it the other way. At the corner the curvature of what it slides on jumps; it is
/// so fast that it flies on from there. The motion has a closed form, of constant accelerations up to the corner.
#[test]
fn a_disc_lets_go_at_the_corner_in_time() {
    const TEXT: &str = "[time]\nend = '0.06 s'\n[world]\ngravity = '9.81 m/s^2'\n[ground]\n\
        [block.b]\nmass = '8 kg'\ninertia = '0.038667 kg m^2'\nwidth = '0.18 m'\nheight = '0.16 m'\non = 'ground'\nat = '0 m'\n\
        velocity = ['-1.1 m/s', '0 m/s']\n\
        [block.disc]\nmass = '2 kg'\ninertia = '0.0064 kg m^2'\nradius = '0.08 m'\non = 'b'\nat = '0.01 m'\nvelocity = ['1 m/s', '0 m/s']\n\
        [contact.c]\nbetween = ['*', '*']\nfriction = 0.75\n";
    let (g, friction, masses, half_width) = (9.81, 0.75, [8.0, 2.0], 0.09);
    let accelerations = [friction * g * (2.0 * masses[1] + masses[0]) / masses[0], -friction * g];
    // The relative motion of the disc up to the corner.
    let (a, v, x) = (0.5 * (accelerations[1] - accelerations[0]), 1.0 + 1.1, 0.01 - half_width);
    let corner = (-v + f64::sqrt(v * v - 4.0 * a * x)) / (2.0 * a);
    let place = |v: f64, a: f64, after: f64| {
        let (flown, v_corner) = (0.06 - corner, v + a * corner);
        v * corner + 0.5 * a * corner * corner + v_corner * flown + 0.5 * after * flown * flown
    };
    let right = [place(-1.1, accelerations[0], friction * g), 0.01 + place(1.0, accelerations[1], 0.0)];
    assert!(v + 2.0 * a * corner > f64::sqrt(0.08 * g), "it flies");
    for step in ["500 us", "250 us"] {
        let (simulation, _) = run(TEXT, step);
        for (name, right) in ["b", "disc"].into_iter().zip(right) {
            let [x, ..] = pose(&simulation, name);
            assert!((x - right).abs() < 5e-8, "{step}: {name} at {x} instead of {right}");
        }
    }
}

/// Wherever in a step the end of the side comes, the disc falls from there on, and not from the start of the step.
#[test]
fn a_disc_falls_from_the_edge_and_not_before() {
    let (g, v, end) = (9.81, 3.0, 0.03);
    for k in 0..20 {
        // Over one step in 20 parts.
        let x = -0.03 - 1.5e-4 * f64::from(k);
        let scene = format!(
            "[time]\nend = '{end} s'\n[world]\ngravity = '{g} m/s^2'\n\
             [block.table]\nfixed = true\ndensity = '2000 kg/m^3'\nwidth = '1 m'\nheight = '0.5 m'\ndepth = '0.1 m'\nposition = ['-0.5 m', '0.25 m']\n\
             [block.disc]\ndensity = '2000 kg/m^3'\nradius = '0.05 m'\ndepth = '0.1 m'\nposition = ['{x} m', '0.55 m']\nvelocity = ['{v} m/s', '0 m/s']\n\
             [contact.c]\nbetween = ['disc', 'table']\nfriction = 0.0\n"
        );
        let (simulation, _) = run(&scene, "1 ms");
        let block = simulation.layout.blocks.iter().find(|block| block.name == "disc").unwrap();
        let fallen = -g * (end + x / v);
        let falls = simulation.state.v[block.range.start + 1];
        assert!((falls - fallen).abs() < 1e-7, "from {x}: {falls} m/s instead of {fallen}");
    }
}

/// The largest height of the only block that moves, m.
struct Highest(f64);

impl Observer<2> for Highest {
    fn observe(
        &mut self,
        _: &Model<2>,
        _: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError> {
        self.0 = self.0.max(state.q[1]);
        Ok(ControlFlow::Continue(()))
    }
}

/// A disc rolls over forty blocks that lie flush, each of which it first meets at its corner: no impact throws it up, whatever the scheme.
#[test]
fn a_disc_rolls_over_the_joints_of_a_floor() {
    let scene = |scheme: &str| {
        format!(
            "[time]\nend = '1.2 s'\nstep = '1 ms'\nscheme = '{scheme}'\n\
             [block.k]\ndensity = '2000 kg/m^3'\nwidth = '0.25 m'\nheight = '0.1 m'\ndepth = '1 m'\nposition = ['0 m', '-0.05 m']\n\
             fixed = true\nrepeat = {{ count = 40, shift = ['0.25 m', '0 m'] }}\n\
             [block.s]\ndensity = '1000 kg/m^3'\nradius = '0.1 m'\ndepth = '0.1 m'\nposition = ['0.1 m', '0.1 m']\n\
             velocity = ['4 m/s', '0 m/s']\nspin = '-40 rad/s'\n\
             [contact.c]\nbetween = ['*', '*']\nfriction = 0.3\nrestitution = 0\n"
        )
    };
    for (scheme, accuracy) in [("auto", 2e-6), ("moreau-jean-closed", 5e-4), ("moreau-jean-projected", 5e-4)] {
        let resolved = teeter_scenario::load(scene(scheme).as_bytes(), "floor", "floor", &[]).unwrap();
        let mut simulation = Simulation::new(&resolved.scene).unwrap();
        // Fixed blocks don't count where the scheme is chosen.
        assert_eq!(scheme == "auto", simulation.scheme() == "moreau-jean-located");
        let mut highest = Highest(0.0);
        assert_eq!(simulation.run(&mut [&mut highest]).unwrap(), Ended::Complete);
        let [x, ..] = pose(&simulation, "s");
        assert!((x - 4.9).abs() < accuracy, "{scheme}: {x}");
        assert!(highest.0 < 0.1 + 1e-6, "{scheme}: {}", highest.0);
    }
}
