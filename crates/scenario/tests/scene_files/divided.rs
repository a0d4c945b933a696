//! What is prescribed, where `moreau-jean-located` divides its steps.

use std::ops::{ControlFlow, Range};
use teeter_integrator::{Ended, Model, Observer, ObserverError, State, StepReport};
use teeter_scenario::simulation::Simulation;

/// Some coordinates at the end of each step.
struct Places {
    of: Range<usize>,
    places: Vec<Vec<f64>>,
    /// Which steps were divided.
    divided: Vec<bool>,
}

impl Observer<2> for Places {
    fn observe(
        &mut self,
        _: &Model<2>,
        step: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError> {
        self.divided.push(step.phases().count() > 1);
        self.places.push(state.q[self.of.clone()].to_vec());
        Ok(ControlFlow::Continue(()))
    }
}

/// Where what is prescribed is after each step: the ground, or the supports of the first beam.
fn places(scene: &str, scheme: &str, step: &str) -> Places {
    let sets =
        [("time.scheme", scheme), ("time.step", step)].map(|(key, value)| (key.to_owned(), format!("\"{value}\"")));
    let resolved = teeter_scenario::load(scene.as_bytes(), "divided", "divided", &sets).unwrap();
    let mut simulation = Simulation::new(&resolved.scene).unwrap();
    let layout = &simulation.layout;
    let of = layout.ground.clone().filter(|ground| !ground.is_empty()).or_else(|| layout.beams[0].supports.clone());
    let mut places = Places { of: of.unwrap(), places: Vec::new(), divided: Vec::new() };
    assert_eq!(simulation.run(&mut [&mut places]).unwrap(), Ended::Complete);
    assert!(simulation.state.ledger.relative_residual() < 1e-13, "{scheme}, {step}");
    places
}

/// Compares them with those of a scheme that takes its steps whole, in which they are those of the signal: at the ends of whole steps, as what a
/// divided step owes is there at the end of the next one.
fn moves_as_in_whole_steps(scene: &str, step: &str) {
    let [divided, whole] = ["moreau-jean-located", "moreau-jean-closed"].map(|scheme| places(scene, scheme, step));
    assert!(divided.divided.contains(&true) && !whole.divided.contains(&true), "{step}: no step is divided");
    let ends = divided.places.iter().zip(&whole.places).zip(&divided.divided).filter(|(_, divided)| !**divided);
    let off = ends
        .flat_map(|((divided, whole), _)| divided.iter().zip(whole))
        .map(|(divided, whole)| (divided - whole).abs());
    let off = off.fold(0.0, f64::max);
    assert!(off < 1e-14, "{step}: {off} m");
}

/// A block on ground that moves, with these keys.
fn on_ground(motion: &str, block: &str, contact: &str) -> String {
    format!(
        "[time]\nend = '0.2 s'\n[ground]\nmotion = {{ {motion}, signal = 's' }}\n[block.b]\nmass = '1 kg'\ninertia = '0.002 kg m^2'\n\
         width = '10 cm'\nheight = '2 cm'\n{block}\n[contact.c]\nbetween = ['b', 'ground']\n{contact}\n"
    )
}

/// The velocity of a pulse of displacement jumps at its start and its end. (The ground ended 0.2 mm off at 1 ms.)
#[test]
fn ground_that_jumps_in_velocity_is_where_its_signal_is() {
    let pulse = "[signal.s]\nshape = 'half-sine'\nstart = '20.3 ms'\nduration = '60 ms'\n";
    let velocities = "[signal.s]\nshape = 'sum'\nterms = ['on', 'off', 'ramp']\n[signal.on]\nshape = 'constant'\nstart = '20.3 ms'\n\
                      [signal.off]\nshape = 'constant'\nstart = '61.7 ms'\nscale = -2\n[signal.ramp]\nshape = 'ramp'\n\
                      start = '80.1 ms'\nduration = '0.4 ms'\n";
    let (lies, bounces) = ("on = 'ground'\nat = '0 m'", "position = ['0 m', '3 cm']\nangle = '3 deg'");
    for (motion, signal) in [
        ("displacement = ['50 mm', '5 mm']", pulse),
        ("displacement = ['50 mm', '0 mm']", pulse),
        ("velocity = ['0.5 m/s', '0.1 m/s']", velocities),
    ] {
        for (block, contact) in [(lies, "friction = 0.3"), (bounces, "friction = 0.3\nrestitution = 0.8")] {
            let scene = on_ground(motion, block, contact) + signal;
            for step in ["5 ms", "1 ms", "800 us", "170 us"] {
                moves_as_in_whole_steps(&scene, step);
            }
        }
    }
    let scene = on_ground("displacement = ['50 mm', '0 mm']", lies, "friction = 0.3") + pulse;
    for step in ["5 ms", "1 ms", "800 us"] {
        let places = places(&scene, "moreau-jean-located", step).places;
        let x = places[places.len() - 1][0];
        assert!(x.abs() < 1e-15, "{step}: back where it began, but for {x} m");
    }
}

/// The same of the supports of a beam on which a block strikes.
#[test]
fn supports_that_jump_in_velocity_are_where_their_signal_is() {
    let scene = "[time]\nend = '30 ms'\n[material.m]\ndensity = '2700 kg/m^3'\nyoungs_modulus = '69 GPa'\n\
                 [beam.t]\nmaterial = 'm'\nspan = '36 cm'\nwidth = '3 cm'\nthickness = '0.3 cm'\nelements = 8\n\
                 motion = { displacement = ['0 mm', '2 mm'], signal = 's' }\n\
                 [block.b]\nmaterial = 'm'\nwidth = '3 cm'\nheight = '3 cm'\ndepth = '3 cm'\nposition = ['18 cm', '2 cm']\nangle = '3 deg'\n\
                 [contact.c]\nbetween = ['b', 't']\nfriction = 0.3\n\
                 [signal.s]\nshape = 'half-sine'\nstart = '2.3 ms'\nduration = '20 ms'\n";
    for step in ["1 ms", "400 us"] {
        moves_as_in_whole_steps(scene, step);
    }
}
