//! What is thrown at the free end of a beam from below.

use super::sides::simulation;

/// A block that is thrown up at the lower face of a cantilever, partly past its end.
fn thrown(at: f64, angle: f64, restitution: f64) -> String {
    format!(
        "[time]\nend = '0.15 s'\nstep = '1 ms'\n[material.oak]\ndensity = '700 kg/m^3'\nyoungs_modulus = '11 GPa'\n\
         [material.stone]\ndensity = '2200 kg/m^3'\n\
         [beam.b]\nmaterial = 'oak'\nspan = '1 m'\nwidth = '10 cm'\nthickness = '4 cm'\nelements = 16\nposition = ['0 m', '1 m']\n\
         supports = ['clamped', 'free']\nsurface = 'top'\n\
         [block.k]\nmaterial = 'stone'\nwidth = '10 cm'\nheight = '10 cm'\ndepth = '10 cm'\nposition = ['{at} m', '0.8 m']\n\
         angle = '{angle} deg'\nvelocity = ['0 m/s', '3 m/s']\n\
         [contact.c]\nbetween = ['k', 'b']\nfriction = 0.3\nrestitution = {restitution}\npoints = 'all'\n"
    )
}

/// When a block of 10 cm touches the lower face, at 0.98 m, from its highest corner; s.
fn touches(angle: f64) -> f64 {
    let reach = 0.05 * (angle.to_radians().sin().abs() + angle.to_radians().cos());
    let way = 0.98 - 0.8 - reach;
    (3.0 - (9.0 - 2.0 * 9.81 * way).sqrt()) / 9.81
}

/// With its corner under the face, flat under the end, and with a side that the end strikes.
#[test]
fn a_block_that_comes_up_at_an_end_is_stopped_in_time_and_gains_no_energy() {
    for scheme in ["moreau-jean-closed", "moreau-jean-located"] {
        for restitution in [0.0, 1.0] {
            for (at, angle) in [(0.97, 20.0), (0.97, 0.0), (0.97, -20.0), (1.0, -20.0)] {
                let case = format!("{scheme}, e = {restitution}, {at} m, {angle} deg");
                let mut simulation = simulation(&thrown(at, angle, restitution), &[("time.scheme", scheme)]);
                let (mut energy, mut first) = (f64::INFINITY, None);
                for _ in 0..150 {
                    let step = simulation.step().unwrap();
                    let touched = step.contacts().any(|contact| contact.p[0] > 0.0).then_some(step.t_end);
                    first = first.or(touched);
                    let now = simulation.state.ledger.current.total();
                    assert!(now < energy + 1e-12 * now.abs(), "{case}: {energy} J to {now} J");
                    energy = now;
                }
                let (first, expected) = (first.unwrap(), touches(angle));
                assert!(first >= expected && first < expected + 2e-3, "{case}: {first} s, not {expected} s");
                let deep = simulation.state.tally.max_penetration;
                assert!(deep < 3e-3, "{case}: {deep} m");
            }
        }
    }
}
