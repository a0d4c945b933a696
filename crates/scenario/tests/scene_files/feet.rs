//! Feet of different friction: when a block slides, and how fast, has a closed form.

use teeter_integrator::Ended;
use teeter_scenario::simulation::Simulation;
use teeter_scenario::{load, scene::Scene};

fn load_scene(text: &str) -> Scene {
    load(text.as_bytes(), "scene", "scene", &[]).unwrap_or_else(|errors| panic!("{errors}\n{text}")).scene
}

fn told(text: &str) -> String {
    load(text.as_bytes(), "scene", "scene", &[]).map(|_| ()).unwrap_err().to_string()
}

const FEET: &str = "friction_left = 0.6\nfriction_right = 0.2";
const TURNED: &str = "friction_left = 0.2\nfriction_right = 0.6";

/// Half the height to the width of the block.
const SLENDER: f64 = 0.4;

/// How far a block of 10 cm × 8 cm has come down the ground, which rises to the right by this angle, after 0.2 s, m.
fn slid(feet: &str, angle: f64, scheme: &str) -> f64 {
    let text = format!(
        "[time]\nend = '0.2 s'\nstep = '1 ms'\nscheme = '{scheme}'\n[ground]\nincline = '{angle:?} rad'\n[block.b]\nwidth = '10 cm'\n\
         height = '8 cm'\ndepth = '10 cm'\ndensity = '2000 kg/m^3'\non = 'ground'\nat = '0 m'\n\
         [contact.c]\nbetween = ['b', 'ground']\nfriction = 0.05\n{feet}\n"
    );
    let mut simulation = Simulation::new(&load_scene(&text)).unwrap();
    let start = simulation.state.q.clone();
    assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
    let [x, y] = [0, 1].map(|k| simulation.state.q[k] - start[k]);
    -(x * angle.cos() + y * angle.sin())
}

#[test]
fn a_block_slides_where_both_feet_reach_their_friction() {
    // N_l + N_r = W cos α, (N_l − N_r) b/2 = T H/2, T = W sin α: T reaches μ_l N_l + μ_r N_r at tan α =
    // ½(μ_l + μ_r)/(1 − (μ_l − μ_r) H/2b), and what is over drives the slide.
    for (feet, difference) in [(FEET, 0.4), (TURNED, -0.4)] {
        let critical: f64 = 0.4 / (1.0 - difference * SLENDER);
        for scheme in ["moreau-jean", "moreau-jean-closed", "moreau-jean-located", "generalized-alpha", "event-driven"]
        {
            let at = |factor: f64| slid(feet, (factor * critical).atan(), scheme);
            assert!(at(0.999).abs() < 1e-9, "{scheme}, {feet}: {} below the critical angle", at(0.999));
            assert!(at(1.001) > 1e-6, "{scheme}, {feet}: held above the critical angle");
            let angle = (1.2 * critical).atan();
            let wanted = 0.5 * 9.81 * (angle.sin() - critical * angle.cos()) * 0.04;
            assert!((at(1.2) / wanted - 1.0).abs() < 0.01, "{scheme}, {feet}: {}, not {wanted}", at(1.2));
        }
    }
}

/// A block of 10 cm × 8 cm on a beam that hardly bends, pushed to the right at its mass centre by this part of its weight; the
/// beam starts undeformed, or in equilibrium under the block.
fn on_beam(push: f64, start: &str) -> String {
    let weight = 2000.0 * 0.1 * 0.08 * 0.1 * 9.81;
    format!(
        "[time]\nend = '0.1 s'\nstep = '1 ms'\n[material.m]\ndensity = '2000 kg/m^3'\nyoungs_modulus = '1e6 GPa'\n[beam.t]\nmaterial = 'm'\n\
         span = '1 m'\nwidth = '10 cm'\nthickness = '10 cm'\nelements = 4\nstart = '{start}'\n[block.b]\nmaterial = 'm'\nwidth = '10 cm'\n\
         height = '8 cm'\ndepth = '10 cm'\non = 't'\nat = '50 cm'\n[contact.c]\nbetween = ['b', 't']\nfriction = 0.05\n{FEET}\n\
         [force.f]\non = 'b'\nforce = ['{:?} N', '0 N']\nsignal = 's'\n[signal.s]\nshape = 'constant'\n",
        push * weight
    )
}

#[test]
fn feet_on_a_beam_have_their_friction_too_and_in_its_equilibrium() {
    // Pushed to the right the right foot, of less friction, has more of the weight.
    let critical = 0.4 / (1.0 + 0.4 * SLENDER);
    for start in ["undeformed", "static"] {
        let moved = |push: f64| {
            let mut simulation = Simulation::new(&load_scene(&on_beam(push, start))).unwrap();
            let begin = simulation.state.q[0];
            assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
            simulation.state.q[0] - begin
        };
        assert!(moved(0.99 * critical).abs() < 1e-7, "{start}: {}", moved(0.99 * critical));
    }
    let mut simulation = Simulation::new(&load_scene(&on_beam(1.2 * critical, "undeformed"))).unwrap();
    assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
    let wanted = 0.5 * 9.81 * 0.2 * critical * 0.01;
    let moved = simulation.state.q[0] - 0.5;
    assert!((moved / wanted - 1.0).abs() < 0.03, "{moved}, not {wanted}");
    // With more than the feet can hold there is no equilibrium.
    let error = Simulation::new(&load_scene(&on_beam(1.01 * critical, "static"))).map(|_| ()).unwrap_err();
    assert!(error.to_string().contains("slides"), "{error}");
}

#[test]
fn feet_have_a_friction_of_their_own_only_as_sharp_corners_on_an_even_surface() {
    let text = |ground: &str, block: &str, more: &str| {
        format!(
            "[time]\nend = '0.1 s'\nstep = '1 ms'\n[ground]\n{ground}\n[block.b]\ndepth = '10 cm'\ndensity = '2000 kg/m^3'\n\
             position = ['0 m', '1 m']\n{block}\n[contact.c]\nfriction = 0.5\n{more}\n"
        )
    };
    let (square, on_ground) = ("width = '10 cm'\nheight = '8 cm'", "between = ['b', 'ground']\nfriction_right = 0.1");
    for (text, wanted) in [
        (text("", "radius = '5 cm'", on_ground), "`b` is round"),
        (text("", &format!("{square}\nrounding = '1 cm'"), on_ground), "`b` is round"),
        (
            text("", "points = [['0 cm', '0 cm'], ['5 cm', '9 cm'], ['-5 cm', '9 cm']]", on_ground),
            "`b` stands on one corner",
        ),
        (
            text("profile = { points = [['-1 m', '0 m'], ['0 m', '0.1 m'], ['1 m', '0 m']] }", square, on_ground),
            "the ground has a profile",
        ),
        (
            text(
                "",
                square,
                "between = ['b', 'd']\nfriction_right = 0.1\n[block.d]\nradius = '5 cm'\ndepth = '10 cm'\n\
                  density = '2000 kg/m^3'\nposition = ['1 m', '1 m']",
            ),
            "this contact is between blocks",
        ),
        (text("", square, "between = ['b', 'ground']\nfriction_right = -0.1"), "at least 0"),
    ] {
        let told = told(&text);
        assert!(told.contains("contact.c.friction_right") && told.contains(wanted), "{told}");
    }
    let scene = load_scene(&text("", square, on_ground));
    assert_eq!(scene.contacts[0].friction_of_feet(), [0.1, 0.5]);
    // The upper corners have that of the contact.
    let law = |corner: usize| scene.contacts[0].law_at(&scene.blocks[0], corner).friction;
    assert_eq!([0, 1, 2, 3].map(law), [0.5, 0.1, 0.5, 0.5]);
}
