//! Beams that nothing holds along their axis: what stands on them, and what they stand on, meets them where they are now.

use super::sides::simulation;
use teeter_integrator::Ended;

/// A beam on two columns that start to move along it together: its friction on them takes it along.
const BEAM: &str = "[time]\nend = '0.75 s'\nstep = '200 us'\nscheme = 'moreau-jean-closed'\n[signal.start]\nshape = 'ramp'\nduration = '0.2 s'\n\
     [beam.b]\nsection = 'direct'\nbending_stiffness = '200 N m^2'\nmass_per_length = '1 kg/m'\naxial_stiffness = '1e5 N'\nspan = '1 m'\nelements = 10\n\
     supports = ['free', 'free']\naxial = 'elastic'\naxial_supports = ['free', 'free']\nself_weight = true\ndamping_ratio = { mode = 3, ratio = 0.2 }\n\
     [contact.left]\nbetween = ['l', 'b']\nfriction = 0.8\n[contact.right]\nbetween = ['r', 'b']\nfriction = 0.8\n";

fn on_columns(acceleration: f64, more: &str) -> String {
    let column = |name: &str, x: &str| {
        format!(
            "[block.{name}]\nwidth = '10 cm'\nheight = '20 cm'\nmass = '5 kg'\ninertia = '0.01 kg m^2'\nposition = ['{x}', '-0.1 m']\n\
             motion = {{ acceleration = ['{acceleration} m/s^2', '0 m/s^2'], angle = '0 deg', signal = 'start' }}\n"
        )
    };
    format!("{BEAM}{}{}{more}", column("l", "0.2 m"), column("r", "0.7 m"))
}

/// The columns come past the places where the ends of the beam were, which has come with them.
#[test]
fn a_beam_stays_on_columns_that_take_it_along() {
    for acceleration in [2.0, -2.0] {
        let mut simulation = simulation(&on_columns(acceleration, ""), &[]);
        assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
        let (layout, q) = (&simulation.layout, &simulation.state.q);
        let column = q[layout.blocks[0].range.start] - 0.2;
        assert!(column.abs() > 0.4, "{column}");
        let beam = &layout.beams[0];
        for x in [0.0, 0.5, 1.0] {
            let w = beam.deflection_at(&q[beam.range.clone()], x).unwrap().w;
            assert!(w.abs() < 1e-4, "{acceleration} m/s²: {w:e} m at {x} m");
        }
    }
}

/// Without friction it stays where it was, until the beam's end has gone from under its centre.
#[test]
fn a_block_falls_off_the_end_of_a_beam_that_is_pulled_from_under_it() {
    let block = "[block.q]\nwidth = '4 cm'\nheight = '4 cm'\nmass = '0.1 kg'\ninertia = '3e-5 kg m^2'\nposition = ['0.9 m', '0.02 m']\n\
         [contact.q]\nbetween = ['q', 'b']\nfriction = 0\n";
    let mut simulation = simulation(&on_columns(-2.0, block), &[("time.end", "0.55 s")]);
    assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
    let range = &simulation.layout.blocks[2].range;
    let [x, y, phi] = [0, 1, 2].map(|k| simulation.state.q[range.start + k]);
    // The end passes its centre at 0.43 s, when the beam has come 10 cm.
    assert!((x - 0.9).abs() < 0.05 && y < 0.01 && phi < -0.2, "{x} {y} {phi}");
}
