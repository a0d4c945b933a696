//! Blocks by their points.

use std::f64::consts::PI;
use teeter_integrator::Ended;
use teeter_scenario::load;
use teeter_scenario::simulation::Simulation;

const HEAD: &str = "[ground]\n[material.m]\ndensity = '2000 kg/m^3'\n";

fn simulation(text: &str, sets: &[(&str, &str)]) -> Simulation {
    let resolved = load(text.as_bytes(), "scene", "scene", &super::sets(sets));
    Simulation::new(&resolved.unwrap_or_else(|errors| panic!("{errors}\n{text}")).scene).unwrap()
}

fn run(simulation: &mut Simulation) {
    assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
}

fn points(points: &[[f64; 2]]) -> String {
    let points: Vec<String> = points.iter().map(|[x, y]| format!("['{x:?} m', '{y:?} m']")).collect();
    format!("points = [{}]", points.join(", "))
}

/// A half-circle arch of equal voussoirs about (0, 0), of radius 1 m to its middle line, on the
/// ground.
fn arch(voussoirs: usize, thickness: f64) -> String {
    let corner = |r: f64, k: usize| {
        let angle = PI * (1.0 - k as f64 / voussoirs as f64);
        // Both feet stand on the ground.
        [r * angle.cos(), if k.is_multiple_of(voussoirs) { 0.0 } else { r * angle.sin() }]
    };
    let [inner, outer] = [1.0 - 0.5 * thickness, 1.0 + 0.5 * thickness];
    let mut text = format!("[time]\nend = '2 s'\nstep = '1 ms'\n{HEAD}");
    for k in 0..voussoirs {
        let corners = [corner(inner, k), corner(inner, k + 1), corner(outer, k + 1), corner(outer, k)];
        text += &format!("[block.v{k}]\nmaterial = 'm'\ndepth = '1 m'\n{}\n", points(&corners));
    }
    let joints = (1..voussoirs).map(|k| (format!("v{}", k - 1), format!("v{k}")));
    let feet = [0, voussoirs - 1].map(|k| (format!("v{k}"), "ground".to_owned()));
    for (number, (one, other)) in joints.chain(feet).enumerate() {
        text += &format!("[contact.j{number}]\nbetween = ['{one}', '{other}']\nfriction = 0.5\n");
    }
    text
}

/// The farthest that a mass centre is from where it started.
fn moved(text: &str) -> f64 {
    let mut simulation = simulation(text, &[]);
    let start = simulation.state.q.clone();
    run(&mut simulation);
    let ways = simulation.state.q.chunks_exact(3).zip(start.chunks_exact(3));
    ways.map(|(q, start)| (q[0] - start[0]).hypot(q[1] - start[1])).fold(0.0, f64::max)
}

/// Limit analysis: a half-circle arch of 27 voussoirs stands from t/R = 0.1067 on, where it falls
/// by hinges.
#[test]
fn an_arch_stands_where_limit_analysis_says_so() {
    for (voussoirs, falls, stands) in [(27, 0.1064, 0.107), (15, 0.1058, 0.1064)] {
        let off = moved(&arch(voussoirs, stands));
        assert!(off < 1e-10, "{voussoirs} voussoirs, t/R = {stands}: moved by {off:e} m");
        let off = moved(&arch(voussoirs, falls));
        assert!(off > 0.1, "{voussoirs} voussoirs, t/R = {falls}: moved by {off:e} m only");
    }
    // Of its joints some held by corners that lost each other after slips of 1e-12 m.
    let off = moved(&arch(51, 0.1077));
    assert!(off < 1e-9, "51 voussoirs, t/R = 0.1077: moved by {off:e} m");
}

/// In every scheme, and wherever they are drawn.
#[test]
fn a_rectangle_by_its_points_moves_as_one_by_its_sides() {
    let more = "depth = '10 cm'\nposition = ['0 m', '50 cm']\nangle = '20 deg'\nspin = '-2 rad/s'\n\
                [contact.c]\nbetween = ['b', 'ground']\nfriction = 0.4\nrestitution = 0.3";
    let start = format!("[time]\nend = '0.6 s'\nstep = '1 ms'\n{HEAD}[block.b]\nmaterial = 'm'\n");
    let by_sides = format!("{start}width = '20 cm'\nheight = '40 cm'\n{more}");
    let drawn = [[0.5, 0.25], [0.75, 0.25], [0.75, 0.75], [0.5, 0.75]].map(|[x, y]| [0.8 * x, 0.8 * y]);
    let clockwise = [drawn[0], drawn[3], drawn[2], drawn[1]];
    for scheme in ["moreau-jean", "moreau-jean-closed", "moreau-jean-located", "event-driven", "generalized-alpha"] {
        let end = |text: &str| {
            let scheme = format!("'{scheme}'");
            let mut simulation = simulation(text, &[("time.scheme", &scheme)]);
            run(&mut simulation);
            simulation.state.q
        };
        let expected = end(&by_sides);
        assert!(expected[1] < 0.25, "{scheme}: it doesn't land");
        for drawn in [drawn, clockwise] {
            let q = end(&format!("{start}{}\n{more}", points(&drawn)));
            let off = q.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < 1e-11, "{scheme}: {off:e}");
        }
    }
}

/// A triangle falls when the line down from its mass centre passes its toe: one with a right angle,
/// 30 cm wide and 15 cm high, its steep side downhill, at atan(10/5); where its steep side is
/// uphill, at atan(20/5).
#[test]
fn a_triangle_falls_where_its_mass_centre_passes_its_toe() {
    let triangle = [[0.0, 0.0], [0.3, 0.0], [0.0, 0.15]];
    let mirrored = [[0.0, 0.0], [0.3, 0.0], [0.3, 0.15]];
    for (drawn, toe) in [(triangle, 0.1), (mirrored, 0.2)] {
        let critical = (toe / 0.05_f64).atan();
        for (past, falls) in [(-1e-4, false), (1e-4, true)] {
            // Gravity turns in place of the ground: it points downhill, to the left.
            let angle = critical + past;
            let gravity = [-9.81 * angle.sin(), -9.81 * angle.cos()];
            let text = format!(
                "[time]\nend = '2 s'\nstep = '1 ms'\n[world]\ngravity = ['{:?} m/s^2', '{:?} m/s^2']\n{HEAD}\
                 [block.b]\nmaterial = 'm'\ndepth = '10 cm'\n{}\n[contact.c]\nbetween = ['b', 'ground']\nfriction = 9.0\n",
                gravity[0],
                gravity[1],
                points(&drawn)
            );
            let mut simulation = simulation(&text, &[]);
            run(&mut simulation);
            let turned = simulation.state.q[2].abs();
            assert!(if falls { turned > 0.1 } else { turned < 1e-12 }, "{past:e} past {critical}: turned by {turned}");
        }
    }
}

#[test]
fn points_that_are_no_convex_polygon_are_refused_with_the_corner() {
    let told = |keys: &str| {
        let text = format!(
            "[time]\nend = '1 s'\nstep = '1 ms'\n{HEAD}[block.b]\nmaterial = 'm'\ndepth = '1 m'\n{keys}\n\
             [contact.c]\nbetween = ['b', 'ground']\nfriction = 0.5\n"
        );
        load(text.as_bytes(), "scene", "scene", &[]).map(|_| ()).unwrap_err().to_string()
    };
    let of = |corners: &[[f64; 2]]| told(&points(corners));
    assert!(of(&[[0.0, 0.0], [1.0, 0.0]]).contains("a polygon has 3 to"));
    assert!(of(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]).contains("all points are on one line"));
    let crossing = of(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]);
    assert!(crossing.contains("the sides from point 1 and from point 3 cross"), "{crossing}");
    assert!(crossing.contains("in order around the polygon"), "{crossing}");
    let dent = of(&[[0.0, 0.0], [1.0, 0.0], [0.2, 0.2], [0.0, 1.0]]);
    assert!(dent.contains("at point 3 the polygon turns inwards") && dent.contains("convex parts"), "{dent}");
    let straight = of(&[[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    assert!(straight.contains("point 2 is on the line between its neighbours"), "{straight}");
    let twice = of(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    assert!(twice.contains("points 2 and 3 are in the same place"), "{twice}");
    let triangle = points(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    assert!(told(&format!("{triangle}\nwidth = '1 m'")).contains("points already give"));
    assert!(told("points = [['0 m'], ['1 m', '0 m'], ['0 m', '1 m']]").contains("an array of two is expected, got 1"));
}

/// A block that slides over flush bricks goes as far as on one surface: its corner must not strike the end of the next brick by the last
/// digits of its height.
#[test]
fn a_block_slides_over_flush_bricks_as_over_one() {
    for of in [
        [0.108, 0.0, -0.119, 1.3375, 0.1408],
        [0.0734, 0.0, -0.0918, 1.3365, 0.2167],
        [0.1091, 0.0, -0.0732, 1.3236, 0.1443],
        [0.0536, 0.0, -0.107, 1.4655, 0.2027],
        [0.0738, 0.01, -0.1122, 1.4159, 0.2159],
        [0.1081, 0.01, -0.1192, 1.3375, 0.1408],
        [0.0651, 0.005, -0.0944, 0.9152, 0.0916],
        [0.1422, 0.005, -0.0897, 1.4985, 0.1584],
    ] {
        for scheme in ["event-driven", "moreau-jean-located", "moreau-jean-closed"] {
            let off = slid_too_far(scheme, 0.0, of);
            assert!(off.abs() < 1e-6, "{scheme}, {of:?}: {off:e} m further than on one surface");
        }
    }
}

/// Nor by the depth to which it has sunk in, as it fell onto them; the last one tilts there, so that its side and its base are not along
/// those of the bricks.
#[test]
fn a_block_that_has_sunk_into_a_brick_slides_over_the_next() {
    for (height, of) in [
        (0.0003, [0.1426312858507014, 0.01, -0.11100905256773419, 1.348862361550893, 0.15541037360688598]),
        (0.003, [0.08563982067627221, 0.01, -0.07844198612754036, 1.0466650530153536, 0.08822147381360583]),
        (0.003, [0.09841187560791423, 0.0, -0.11006158906005141, 1.4887156314406873, 0.2075458793414331]),
        (0.0003, [0.13704757225324893, 0.0, -0.07969627595589876, 1.438190484539276, 0.08023541869066919]),
    ] {
        let off = slid_too_far("moreau-jean-closed", height, of);
        assert!(off.abs() < 3e-4, "{of:?}: {off:e} m further than on one surface");
    }
}

/// A block on springs keeps its depth m g/(2 k), its speed and its angle where it slides over flush bricks: it neither strikes the end of
/// the next one by what it has sunk in, nor starts at zero depth on that, whichever way it goes and whichever body comes first.
#[test]
fn a_block_on_springs_slides_over_flush_bricks_at_its_depth() {
    let bricks = "[block.brick]\nfixed = true\ndensity = '1000 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.2 m'\nheight = '0.05 m'\n\
                  position = ['-0.4 m', '-0.025 m']\nrepeat = { count = 5, shift = ['0.2 m', '0 m'] }\n";
    for (scheme, v, step, is_first) in [
        ("moreau-jean-located", 0.4, "100 us", true),
        ("moreau-jean-located", 0.3, "100 us", false),
        ("moreau-jean-located", -0.4, "100 us", true),
        ("moreau-jean-located", -2.0, "500 us", false),
        ("moreau-jean-closed", 0.4, "100 us", true),
        ("moreau-jean-closed", -0.3, "100 us", false),
        ("moreau-jean-closed", 2.0, "500 us", true),
    ] {
        let block = format!(
            "[block.b]\ndensity = '2000 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.1 m'\nheight = '0.05 m'\n\
             position = ['{} m', '0.025 m']\nvelocity = ['{v} m/s', '0 m/s']\n",
            -0.38 * f64::signum(v)
        );
        let bodies = if is_first { format!("{block}{bricks}") } else { format!("{bricks}{block}") };
        let text = format!(
            "[time]\nend = '{} s'\nstep = '{step}'\nscheme = '{scheme}'\n[world]\ngravity = '9.81 m/s^2'\n{bodies}\
             [contact.c]\nbetween = ['b', 'brick-*']\nfriction = 0\nlaw = 'hunt-crossley'\nstiffness = '1e5 N/m'\ndamping = '200 s/m'\nexponent = 1\n",
            0.7 / v.abs()
        );
        let mut simulation = simulation(&text, &[]);
        run(&mut simulation);
        let state = &simulation.state;
        let block = simulation.layout.blocks.iter().find(|block| block.name == "b").unwrap().range.clone();
        let (q, vx) = (&state.q[block.clone()], state.v[block.start]);
        let (depth, expected) = (0.025 - q[1], 9.81 / 2e5);
        let case = format!("{scheme}, {v} m/s, {step}, first: {is_first}");
        assert!((depth / expected - 1.0).abs() < 1e-3, "{case}: {depth:e} m deep, not {expected:e}");
        assert!(q[2].abs() < 1e-6, "{case}: φ = {:e}", q[2]);
        assert!((vx / v - 1.0).abs() < 1e-3, "{case}: {vx} m/s");
    }
}

/// How much further a block slides over flush bricks, onto which it falls from a height, than on one surface, m.
fn slid_too_far(scheme: &str, height: f64, [width, chamfer, x, v, mu]: [f64; 5]) -> f64 {
    let chamfer = if chamfer > 0.0 { format!("chamfer = '{chamfer} m'\n") } else { String::new() };
    let text = format!(
        "[time]\nend = '0.6 s'\nstep = '1 ms'\nscheme = '{scheme}'\n[world]\ngravity = '9.81 m/s^2'\n[ground]\n\
             [block.b]\ndensity = '1000 kg/m^3'\ndepth = '0.1 m'\nwidth = '{width} m'\nheight = '0.04 m'\n{chamfer}\
             position = ['{x} m', '{} m']\nvelocity = ['{v} m/s', '0 m/s']\n\
             [block.brick]\nfixed = true\ndensity = '1000 kg/m^3'\ndepth = '0.1 m'\nwidth = '0.1 m'\nheight = '0.05 m'\n\
             position = ['-0.25 m', '-0.025 m']\nrepeat = {{ count = 12, shift = ['0.1 m', '0 m'] }}\n\
             [contact.c]\nbetween = ['b', 'brick-*']\nfriction = {mu}\n",
        0.02 + height
    );
    let mut simulation = simulation(&text, &[]);
    run(&mut simulation);
    let (falls, impact) = ((2.0 * height / 9.81).sqrt(), (2.0 * 9.81 * height).sqrt());
    let slides = v - mu * impact;
    let t = (slides / (mu * 9.81)).min(0.6 - falls);
    simulation.state.q[0] - x - (v * falls + slides * t - 0.5 * mu * 9.81 * t * t)
}
