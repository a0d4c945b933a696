//! Static starts: equilibrium under any placement, and rest after it.

use nalgebra::Vector2;
use teeter_rigid::{Pose, Rectangle};
use teeter_scenario::load;
use teeter_scenario::simulation::{BuildError, Simulation};

const G: f64 = 9.81;

/// A beam and blocks on it; `beam` and `contact` are further keys.
fn scene(beam: &str, blocks: &[(&str, &str)], contact: &str) -> String {
    let mut text = format!(
        "[time]\nend = '1 s'\nstep = '100 us'\n[material.m]\ndensity = '2700 kg/m^3'\nyoungs_modulus = '69 GPa'\n\
         [beam.table]\nmaterial = 'm'\nspan = '36 cm'\nwidth = '3 cm'\nthickness = '1.5 mm'\nelements = 20\n\
         start = 'static'\ndamping_ratio = {{ mode = 1, ratio = 0.01 }}\n{beam}\n"
    );
    for (name, keys) in blocks {
        text += &format!(
            "[block.{name}]\nmaterial = 'm'\nwidth = '3 cm'\nheight = '13.5 cm'\ndepth = '3 cm'\non = 'table'\n{keys}\n\
             [contact.{name}]\nbetween = ['{name}', 'table']\n{contact}\n"
        );
    }
    text
}

fn build(text: &str) -> Result<Simulation, BuildError> {
    let resolved = load(text.as_bytes(), "scene", "scene", &[]).unwrap_or_else(|errors| panic!("{errors}\n{text}"));
    Simulation::new(&resolved.scene)
}

#[test]
fn scratch() {
    for (what, beam, blocks, contact) in [
        ("tilted", "", &[("a", "at = '18 cm'\ntilt = '5 deg'")][..], "friction = 0.5"),
        ("tilted top", "surface = 'top'", &[("a", "at = '18 cm'\ntilt = '5 deg'")], "friction = 0.5"),
        ("tilted frictionless", "", &[("a", "at = '18 cm'\ntilt = '5 deg'")], "friction = 0"),
        ("flat mid", "", &[("a", "at = '18 cm'")], "friction = 0.5"),
        ("flat mid mu 0", "", &[("a", "at = '18 cm'")], "friction = 0"),
        ("flat mid mu 0 top", "surface='top'", &[("a", "at = '18 cm'")], "friction = 0"),
        ("flat off mu 0 linear", "", &[("a", "at = '14 cm'")], "friction = 0\nkinematics='linear'"),
        ("flat off mu 0", "", &[("a", "at = '14 cm'")], "friction = 0"),
        ("flat off mu .5", "", &[("a", "at = '14 cm'")], "friction = 0.5"),
        ("flat far off mu .5", "", &[("a", "at = '6 cm'")], "friction = 0.5"),
        ("flat off mu .5 top", "surface='top'", &[("a", "at = '14 cm'")], "friction = 0.5"),
        ("flat off mu .5 top lin", "surface='top'", &[("a", "at = '14 cm'")], "friction = 0.5\nkinematics='linear'"),
        ("flat off mu .01", "", &[("a", "at = '14 cm'")], "friction = 0.01"),
        ("cantilever", "supports=['clamped','free']", &[("a", "at = '6 cm'")], "friction = 0.5"),
        ("cantilever far", "supports=['clamped','free']", &[("a", "at = '20 cm'")], "friction = 0.5"),
        ("cantilever tip", "supports=['clamped','free']", &[("a", "at = '34 cm'")], "friction = 0.5"),
        ("two", "", &[("a", "at = '12 cm'"), ("b", "at = '24 cm'")], "friction = 0.5"),
        (
            "three",
            "",
            &[("a", "at = '9 cm'"), ("b", "at = '18 cm'"), ("c", "at = '27 cm'\ntilt='3 deg'")],
            "friction = 0.5",
        ),
        (
            "three soft",
            "thickness='1 mm'",
            &[("a", "at = '9 cm'"), ("b", "at = '18 cm'"), ("c", "at = '27 cm'\ntilt='3 deg'")],
            "friction = 0.5",
        ),
        (
            "three stiff",
            "thickness='30 mm'",
            &[("a", "at = '9 cm'"), ("b", "at = '18 cm'"), ("c", "at = '27 cm'\ntilt='3 deg'")],
            "friction = 0.5",
        ),
    ] {
        if let Ok(only) = std::env::var("ONLY") {
            if only != what {
                continue;
            }
        }
        for n in [1, 20, 300, 3000] {
            let text = scene(beam, blocks, contact).replace("elements = 20", &format!("elements = {n}"));
            let text = if beam.contains("thick") { text.replace("thickness = '1.5 mm'\n", "") } else { text };
            let begin = std::time::Instant::now();
            match build(&text) {
                Ok(sim) => {
                    let s = sim.static_start.as_ref().unwrap();
                    eprintln!(
                        "{what} {n}: {:.1} ms, {} rounds, {:.1e}, pose {:?} forces {:?}",
                        begin.elapsed().as_secs_f64() * 1e3,
                        s.rounds,
                        s.change,
                        &sim.state.q[..3],
                        s.forces.iter().map(|f| (f.corner, f.force)).collect::<Vec<_>>()
                    );
                    let mut worst: f64 = 0.0;
                    for scheme in ["moreau-jean", "moreau-jean-closed"] {
                        let mut sim =
                            build(&text.replace("step = '100 us'", &format!("step='100 us'\nscheme='{scheme}'")))
                                .unwrap();
                        let q0 = sim.state.q.clone();
                        struct V(f64, f64);
                        impl teeter_integrator::Observer<2> for V {
                            fn observe(
                                &mut self,
                                _: &teeter_integrator::Model<2>,
                                s: &teeter_integrator::StepReport<'_, 2>,
                                state: &teeter_integrator::State,
                            ) -> Result<std::ops::ControlFlow<()>, teeter_integrator::ObserverError>
                            {
                                let v = state.v.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
                                if s.step == 1 {
                                    self.0 = v;
                                }
                                self.1 = self.1.max(v);
                                Ok(std::ops::ControlFlow::Continue(()))
                            }
                        }
                        if n == 20 {
                            let mut v = V(0.0, 0.0);
                            let _ = sim.run(&mut [&mut v]);
                            worst = sim.state.q.iter().zip(&q0).fold(0.0, |a, (x, y)| a.max((x - y).abs()));
                            eprintln!("     {scheme}: first v {:.1e} largest {:.1e} moved {worst:.1e}", v.0, v.1);
                        }
                    }
                }
                Err(e) => eprintln!("{what} {n}: {:.1} ms, {e}", begin.elapsed().as_secs_f64() * 1e3),
            }
        }
    }
}
