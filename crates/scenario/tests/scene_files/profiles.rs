//! Ground with a profile, from the scene file to the motion: against statics and closed forms.

use std::ops::ControlFlow;
use teeter_detect::ContactId;
use teeter_integrator::{Ended, Model, Observer, ObserverError, State, StepReport};
use teeter_scenario::resolve::Resolved;
use teeter_scenario::simulation::Simulation;
use teeter_scenario::{load, load_with};

fn resolved(text: &str) -> Resolved {
    load(text.as_bytes(), "scene.toml", "scene", &[]).unwrap_or_else(|errors| panic!("{errors}"))
}

/// A block of 1 m × 2 m and 2000 kg on this ground; `block` places it.
fn scene(end: &str, step: &str, points: &str, block: &str, friction: f64) -> String {
    format!(
        "[time]\nend = '{end}'\nstep = '{step}'\n[world]\ngravity = '10 m/s^2'\n[ground]\nprofile = {{ points = {points} }}\n\
         [material.m]\ndensity = '1000 kg/m^3'\n[block.b]\nmaterial = 'm'\nwidth = '1 m'\nheight = '2 m'\ndepth = '1 m'\n\
         {block}\n[contact.c]\nbetween = ['b', 'ground']\nfriction = {friction}\n"
    )
}

/// The contacts of the last step: their point's name, and their mean forces on the block, N.
#[derive(Default)]
struct Forces(Vec<(ContactId, [f64; 2])>);

impl Observer<2> for Forces {
    fn observe(&mut self, _: &Model<2>, step: &StepReport<'_, 2>, _: &State) -> Result<ControlFlow<()>, ObserverError> {
        let force = |p: f64| p / step.h;
        self.0 = step.contacts().map(|contact| (contact.id, [force(contact.p[0]), force(contact.p[1])])).collect();
        Ok(ControlFlow::Continue(()))
    }
}

#[test]
fn a_block_across_ridges_of_two_heights_rests_on_both() {
    // Ridges at x = -0.3 and 0.3, at heights 0 and 0.1: the base slopes by atan(1/6).
    let trench = "[['-0.4 m', '-1 m'], ['-0.3 m', '0 m'], ['-0.2 m', '-1 m'], ['0.2 m', '-1 m'], ['0.3 m', '0.1 m']]";
    let text = scene("50 ms", "1 ms", trench, "on = 'ground'\nat = '0 m'", 0.8);
    let resolved = resolved(&text);
    let mut run = Simulation::new(&resolved.scene).unwrap();
    let slope = (1.0_f64 / 6.0).atan();
    let (start, pose) = (run.state.q.clone(), [-slope.sin(), 0.05 + slope.cos(), slope]);
    for (found, exact) in start.iter().zip(pose) {
        assert!((found - exact).abs() < 1e-15, "{found} {exact}");
    }
    let mut forces = Forces::default();
    assert_eq!(run.run(&mut [&mut forces]).unwrap(), Ended::Complete);
    for (found, placed) in run.state.q.iter().zip(&start) {
        assert!((found - placed).abs() < 1e-13, "it rests: {found} {placed}");
    }
    // Two crests on the base, half their distance a = 0.3/cos β from its middle; the mass centre is
    // 1 m above the base. Normal forces balance the couple of the tangential ones.
    let (weight, a) = (2000.0 * 10.0, 0.3 / slope.cos());
    let (normal, tangential) = (weight * slope.cos(), weight * slope.sin());
    let lower = 0.5 * normal + tangential / (2.0 * a);
    let names: Vec<&str> = forces
        .0
        .iter()
        .map(|(id, _)| {
            let pair = &run.layout.pairs[0];
            pair.points[pair.point(*id).unwrap()].name.as_str()
        })
        .collect();
    assert_eq!(names, ["crest-2", "crest-5"]);
    let near = |found: f64, exact: f64| (found - exact).abs() < 1e-6 * weight;
    assert!(near(forces.0[0].1[0], lower) && near(forces.0[1].1[0], normal - lower), "{:?} {lower}", forces.0);
    let sum: f64 = forces.0.iter().map(|(_, p)| p[1]).sum();
    assert!(near(sum.abs(), tangential), "friction holds it: {sum} {tangential}");
}

#[test]
fn a_block_on_a_step_stands_on_a_crest_and_a_corner() {
    // A step up of 20 cm at x = 0.2: the left corner is on the lower ground, the crest under the base.
    let step = "[['0.19 m', '0 m'], ['0.2 m', '0.2 m']]";
    let resolved = resolved(&scene("20 ms", "1 ms", step, "on = 'ground'\nat = '0 m'", 0.9));
    let run = Simulation::new(&resolved.scene).unwrap();
    let [x, y, angle] = [run.state.q[0], run.state.q[1], run.state.q[2]];
    let place = |u: f64, v: f64| [x + u * angle.cos() - v * angle.sin(), y + u * angle.sin() + v * angle.cos()];
    let corner = place(-0.5, -1.0);
    assert!(corner[1].abs() < 1e-15, "the corner is on the lower ground: {corner:?}");
    // Distance of the crest from the line of the base.
    let from = [0.2 - corner[0], 0.2 - corner[1]];
    assert!((from[1] * angle.cos() - from[0] * angle.sin()).abs() < 1e-15);
    assert!((place(0.0, -1.0)[0]).abs() < 1e-15, "the midpoint of its base is at x = 0");
}

#[test]
fn a_block_slides_down_a_piece_with_g_sin_minus_mu_cos() {
    let (slope, mu) = (0.75_f64.atan(), 0.3);
    let ramp = "[['-8 m', '-6 m'], ['8 m', '6 m']]";
    let resolved = resolved(&scene("0.8 s", "1 ms", ramp, "on = 'ground'\nat = '4 m'", mu));
    let mut run = Simulation::new(&resolved.scene).unwrap();
    let start = run.state.q.clone();
    assert_eq!(run.run(&mut []).unwrap(), Ended::Complete);
    let a = 10.0 * (slope.sin() - mu * slope.cos());
    let down = 0.5 * a * 0.8 * 0.8;
    let speed = run.state.v[0].hypot(run.state.v[1]);
    assert!((speed - a * 0.8).abs() < 1e-9, "{speed} {}", a * 0.8);
    for (k, part) in [-slope.cos() * down, -slope.sin() * down, 0.0].into_iter().enumerate() {
        let moved = run.state.q[k] - start[k];
        assert!((moved - part).abs() < 1e-9, "{k}: {moved} {part}");
    }
    assert!(run.state.ledger.relative_residual() < 1e-12);
}

#[test]
fn a_block_that_slides_over_a_crest_tips_there_and_never_enters_the_ground() {
    // Without friction, from 2 m before an edge at 1 m/s: the base passes over the edge, and as soon
    // as the mass centre is beyond, at t = 2 s, it turns about the crest.
    let edge = "[['-1 m', '0 m'], ['0 m', '0 m'], ['0.5 m', '-4 m']]";
    let block = "on = 'ground'\nat = '-2 m'\nvelocity = ['1 m/s', '0 m/s']";
    let before = |end: &str| {
        let resolved = resolved(&scene(end, "1 ms", edge, block, 0.0));
        let mut run = Simulation::new(&resolved.scene).unwrap();
        assert_eq!(run.run(&mut []).unwrap(), Ended::Complete);
        run
    };
    let run = before("1.9 s");
    assert!((run.state.q[0] + 0.1).abs() < 1e-12 && run.state.q[2].abs() < 1e-12, "{:?}", run.state.q);
    let run = before("2.4 s");
    assert!(run.state.q[2] < -0.1, "it tips over the edge: {}", run.state.q[2]);
    // Without friction the force is along the normal of the base, as long as the crest carries it.
    assert!(run.state.tally.max_penetration < 1e-3, "{:e}", run.state.tally.max_penetration);
    assert!(run.state.ledger.relative_residual() < 1e-12);
}

#[test]
fn a_profile_moves_with_the_ground() {
    let trench = "[['-0.3 m', '0 m'], ['-0.2 m', '-1 m'], ['0.2 m', '-1 m'], ['0.3 m', '0 m']]";
    let still = scene("0.4 s", "1 ms", trench, "on = 'ground'\nat = '0 m'\nvelocity = ['0.5 m/s', '0 m/s']", 0.9);
    let moving = still.replace("[ground]\n", "[ground]\nmotion = { velocity = ['0.5 m/s', '0 m/s'] }\n");
    let mut run = Simulation::new(&resolved(&moving).scene).unwrap();
    assert_eq!(run.run(&mut []).unwrap(), Ended::Complete);
    assert!((run.state.q[0] - 0.2).abs() < 1e-12 && run.state.q[2].abs() < 1e-12, "it is carried: {:?}", run.state.q);
    let displaced =
        still.replace("[ground]\n", "[ground]\nmotion = { displacement = ['0.1 m', '0.2 m'], angle = '5 deg' }\n");
    let run = Simulation::new(&resolved(&displaced.replace("at = '0 m'", "at = '0.1 m'")).scene).unwrap();
    let turn = 5_f64.to_radians();
    for (found, exact) in run.state.q.iter().zip([0.1 - turn.sin(), 0.2 + turn.cos(), turn]) {
        assert!((found - exact).abs() < 1e-14, "{found} {exact}");
    }
}

#[test]
fn points_may_stand_in_a_file() {
    let text = |keys: &str| {
        scene("10 ms", "1 ms", "[]", "position = ['0 m', '9 m']", 0.5)
            .replace("{ points = [] }", &format!("{{ file = 'ground.csv', {keys} }}"))
    };
    let read = |keys: &str, file: &str| {
        let resolved = load_with(text(keys).as_bytes(), "s", "s", &[], &mut |_| Ok(file.into()));
        resolved.map_err(|errors| errors.to_string()).map(|resolved| {
            let profile = resolved.scene.ground.unwrap().profile.unwrap();
            profile.points().map(|point| [point.x, point.y]).collect::<Vec<_>>()
        })
    };
    let points = Ok(vec![[0.0, 0.5], [2.0, 1.5]]);
    assert_eq!(read("", "0,0.5\n2,1.5\n"), points);
    assert_eq!(read("", "# ours\nx [cm],y [mm]\n0,500\n200,1500\n"), points);
    assert_eq!(read("unit = 'cm'", "x,y\n0,50\n200,150\n"), points);
    assert_eq!(read("columns = ['x', 'height']", "height [m],what,x [m]\n0.5,7,0\n1.5,8,2\n"), points);
    assert_eq!(read("columns = ['3', '1'], unit = 'mm'", "500,7,0\n1500,8,2000\n"), points);
    for (keys, file, says) in [
        ("", "0,1\n2,1\n1,1\n", "line 3: point 3 is not to the right of the one before it"),
        ("", "0,1\n2,high\n", "line 2: `high` is not a number"),
        ("", "0,1,2\n1,2,3\n", "line 1: 3 columns"),
        ("", "0,1\n", "2 to"),
        ("columns = ['x', 'z']", "x,y\n0,1\n1,1\n", "there is no column `z`: the heading has x, y"),
        ("columns = ['1', '3']", "0,1\n1,1\n", "line 1: 2 columns, but column 3 is asked for"),
        ("unit = 'cm'", "x [m],y [m]\n0,1\n1,1\n", "the heading has the unit `m`, so `cm` must be left out"),
        ("unit = 'ft'", "0,1\n1,1\n", "ground.profile.unit"),
    ] {
        let message = read(keys, file).unwrap_err();
        assert!(message.contains(says), "«{says}» in {message}");
    }
}

#[test]
fn a_profile_excludes_an_incline_and_needs_its_points_in_order() {
    let refused = |change: (&str, &str), says: &[&str]| {
        let text = scene("10 ms", "1 ms", "[['0 m', '0 m'], ['1 m', '1 m']]", "position = ['0 m', '9 m']", 0.5);
        assert!(text.contains(change.0));
        let text = text.replace(change.0, change.1);
        let message = load(text.as_bytes(), "s", "s", &[]).expect_err(change.1).to_string();
        says.iter().for_each(|says| assert!(message.contains(says), "«{says}» in {message}"));
    };
    refused(("profile =", "incline = '5 deg'\nprofile ="), &["ground.incline", "already gives the slope"]);
    refused(("['1 m', '1 m']", "['0 m', '1 m']"), &["ground.profile.points", "point 2 is not to the right"]);
    refused((", ['1 m', '1 m']", ""), &["ground.profile.points", "2 to"]);
    refused(("points = [['0 m', '0 m'], ['1 m', '1 m']]", ""), &["ground.profile", "the profile is missing"]);
    refused(("points =", "unit = 'mm', points ="), &["ground.profile.unit", "only with file"]);
    refused(("points =", "file = 'a', points ="), &["ground.profile.file", "keep points or file"]);
    // Placed in the ground.
    let text = scene("10 ms", "1 ms", "[['0 m', '0 m'], ['1 m', '1 m']]", "position = ['3 m', '1.5 m']", 0.5);
    let message = Simulation::new(&resolved(&text).scene).unwrap_err().to_string();
    assert!(message.contains("the corner bottom-left starts 500 mm below the surface of `ground`"), "{message}");
}

/// A block of any shape, given by `keys`, on this ground.
fn shaped(points: &str, keys: &str) -> Simulation {
    let sides = "width = '1 m'\nheight = '2 m'\n";
    let text = scene("10 ms", "1 ms", points, keys, 0.9);
    assert!(text.contains(sides));
    Simulation::new(&resolved(&text.replacen(sides, "", 1)).scene).unwrap()
}

#[test]
fn every_shape_is_placed_on_a_profile_as_on_straight_ground() {
    let level = "[['-9 m', '0 m'], ['1 m', '0 m'], ['9 m', '0 m']]";
    for shape in [
        "radius = '1 m'",
        "shape = { kind = 'regular', sides = 3, radius = '1 m' }",
        "shape = { kind = 'trapezoid', bottom = '2 m', top = '1 m', height = '1 m', shift = '0.2 m' }",
        "shape = { kind = 'stadium', length = '2 m', radius = '0.5 m' }",
        "width = '1 m'\nheight = '2 m'\nrounding = '0.1 m'",
        "parts = [{ width = '1 m', height = '1 m' }, { width = '1 m', height = '3 m', at = ['1 m', '1 m'] }]",
    ] {
        for tilt in ["0 deg", "8 deg", "-8 deg"] {
            let keys = format!("{shape}\non = 'ground'\nat = '0.3 m'\ntilt = '{tilt}'");
            let found = shaped(level, &keys);
            let straight = scene("10 ms", "1 ms", "[]", &keys, 0.9)
                .replace("profile = { points = [] }\n", "")
                .replacen("width = '1 m'\nheight = '2 m'\n", "", 1);
            let known = Simulation::new(&resolved(&straight).scene).unwrap();
            for (found, known) in found.state.q.iter().zip(&known.state.q) {
                assert!((found - known).abs() < 1e-14, "{keys}: {found}, on straight ground {known}");
            }
        }
    }
}

#[test]
fn a_disc_lies_in_a_valley_and_against_a_crest() {
    let disc =
        |points: &str, at: &str| shaped(points, &format!("radius = '0.2 m'\non = 'ground'\nat = '{at}'")).state.q;
    let valley = disc("[['-1 m', '1 m'], ['0 m', '0 m'], ['1 m', '1 m']]", "0 m");
    assert!(valley[0].abs() < 1e-15 && (valley[1] - 0.2 * 2.0_f64.sqrt()).abs() < 1e-15, "{valley:?}");
    // Beside a ridge of no width, which it touches before the ground.
    let ridge = disc("[['-1 m', '0 m'], ['0 m', '0 m'], ['1e-6 m', '0.2 m'], ['2e-6 m', '0 m']]", "0.1 m");
    let known = 0.2 + (0.2_f64.powi(2) - (0.1 - 1e-6_f64).powi(2)).sqrt();
    assert!((ridge[1] - known).abs() < 1e-15, "{ridge:?} {known}");
}

#[test]
fn a_block_tilted_beside_a_crest_touches_it() {
    let text = scene(
        "10 ms",
        "1 ms",
        "[['-9 m', '0 m'], ['0 m', '1 m'], ['9 m', '0 m']]",
        "on = 'ground'\nat = '0.2 m'\ntilt = '10 deg'",
        0.9,
    );
    let run = Simulation::new(&resolved(&text).scene).unwrap();
    let mut candidates = Vec::new();
    run.model.candidates(&run.state.q, 1e-9, &mut candidates).unwrap();
    assert!(!candidates.is_empty() && candidates.iter().all(|candidate| candidate.gap.abs() < 1e-14), "{candidates:?}");
}

#[test]
fn tilts_on_a_moving_profile_are_those_against_its_piece() {
    let slope = "[['-9 m', '-0.9 m'], ['9 m', '0.9 m']]";
    let still = scene("10 ms", "1 ms", slope, "on = 'ground'\nat = '0 m'\ntilt = '5 deg'", 0.9);
    let moving = still.replace("[ground]\n", "[ground]\nmotion = { velocity = ['1 mm/s', '0 m/s'] }\n");
    for text in [still, moving] {
        let run = Simulation::new(&resolved(&text).scene).unwrap();
        assert!((run.layout.tilt(0, &run.state.q) - 5_f64.to_radians()).abs() < 1e-15);
    }
}

#[test]
fn a_static_start_beside_a_profile_is_refused_also_through_blocks() {
    let text = scene("10 ms", "1 ms", "[['-9 m', '-5 m'], ['9 m', '-5 m']]", "on = 'a'\nat = '0.5 m'", 0.9)
        + "[material.s]\ndensity = '8000 kg/m^3'\nyoungs_modulus = '210 GPa'\n\
           [beam.t]\nmaterial = 's'\nspan = '1 m'\nwidth = '1 m'\nthickness = '5 cm'\nelements = 4\nstart = 'static'\n\
           [block.a]\nmaterial = 'm'\nwidth = '10 cm'\nheight = '10 cm'\ndepth = '1 m'\non = 't'\nat = '0.5 m'\n\
           [contact.d]\nbetween = ['a', 't']\nfriction = 0.5\n[contact.e]\nbetween = ['b', 'a']\nfriction = 0.5\n";
    let message = load(text.as_bytes(), "s", "s", &[]).expect_err("b also touches the ground").to_string();
    assert!(message.contains("beam.t.start") && message.contains("also touches the profile"), "{message}");
}

#[test]
fn a_crest_that_starts_inside_a_block_is_refused_however_deep() {
    // A spike under the middle of a block of 20 cm × 10 cm on level ground, in one piece or in two, one on the other.
    let build = |height: &str, shape: &str| {
        let text = format!(
            "[time]\nend = '1 s'\nstep = '1 ms'\n\
             [ground]\nprofile = {{ points = [['-1 m', '0 m'], ['-2 cm', '0 m'], ['0 m', '{height}'], ['2 cm', '0 m'], ['1 m', '0 m']] }}\n\
             [material.a]\ndensity = '2000 kg/m^3'\n[block.b]\nmaterial = 'a'\ndepth = '10 cm'\nposition = ['0 m', '5 cm']\n{shape}\n\
             [contact.f]\nbetween = ['b', 'ground']\nfriction = 0.5\n"
        );
        let scene =
            teeter_scenario::load(text.as_bytes(), "f", "f", &[]).unwrap_or_else(|errors| panic!("{errors}")).scene;
        teeter_scenario::simulation::Simulation::new(&scene).map(|_| ())
    };
    let whole = "width = '20 cm'\nheight = '10 cm'";
    let layers = "parts = [{ points = [['-10 cm', '0 cm'], ['10 cm', '0 cm'], ['10 cm', '4 cm'], ['-10 cm', '4 cm']] }, \
                  { points = [['-10 cm', '4 cm'], ['10 cm', '4 cm'], ['10 cm', '10 cm'], ['-10 cm', '10 cm']] }]";
    for shape in [whole, layers] {
        for height in ["1 um", "1 cm", "3 cm", "4 cm", "5.1 cm", "9.9 cm", "10 cm"] {
            let refused = build(height, shape).expect_err(height).to_string();
            assert!(refused.contains("crest-3"), "{refused}");
        }
        for height in ["0.1 nm", "-1 um", "-3 cm"] {
            build(height, shape).unwrap_or_else(|error| panic!("{height}: {error}"));
        }
    }
}

/// Where a corner touches a slope, rounding may have it above the ground and inside the slope's line: its blow was lost, and it
/// rested as deep as the step was long.
#[test]
fn blows_in_a_valley_are_located_whatever_rounding_says() {
    for x in ["-0.6469", "-0.2449", "-0.6259"] {
        let text = format!(
            "[time]\nend = '0.6 s'\nstep = '4 ms'\nscheme = 'moreau-jean-located'\n\
             [ground]\nprofile = {{ points = [['-1 m', '0.2 m'], ['0 m', '0 m'], ['1 m', '0 m']] }}\n\
             [block.b]\ndensity = '500 kg/m^3'\nwidth = '7 cm'\nheight = '10 cm'\ndepth = '10 cm'\nposition = ['{x} m', '0.5 m']\n\
             angle = '-20 deg'\nvelocity = ['2 m/s', '0 m/s']\n[contact.c]\nbetween = ['b', 'ground']\nfriction = 0.5\n"
        );
        let mut simulation = Simulation::new(&resolved(&text).scene).unwrap();
        assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
        let tally = &simulation.state.tally;
        assert_eq!(tally.unlocated_steps, 0, "{x}");
        assert!(tally.max_penetration < 2e-5, "{x}: {:e} m deep", tally.max_penetration);
    }
}

/// A block that has landed on the right flank of a ridge slides down behind it, sunk in by some micrometres: its upper corner passes the
/// ridge in the ground, nearer to the left flank than to the one that the block lies on.
#[test]
fn a_block_that_has_sunk_in_slides_past_a_ridge() {
    let (slope, speed, fall) = (0.5_f64.atan(), 0.3, 0.02);
    let (tangent, normal) = ([slope.cos(), -slope.sin()], [slope.sin(), slope.cos()]);
    let place = [0, 1].map(|k| 0.1 * tangent[k] + (0.15 + fall) * normal[k]);
    let scene = |left: &str| {
        format!(
            "[world]\ngravity = '9.81 m/s^2'\n[time]\nend = '0.8 s'\nstep = '100 us'\nscheme = 'moreau-jean-closed'\n\
             [ground]\nprofile = {{ points = [['{left}', '-1 m'], ['0 m', '0 m'], ['6 m', '-3 m']] }}\n\
             [block.b]\ndensity = '1000 kg/m^3'\nwidth = '0.5 m'\nheight = '0.3 m'\ndepth = '1 m'\n\
             position = ['{} m', '{} m']\nangle = '{} rad'\nvelocity = ['{} m/s', '{} m/s']\n\
             [contact.c]\nbetween = ['b', 'ground']\nfriction = 0\n",
            place[0],
            place[1],
            -slope,
            speed * tangent[0],
            speed * tangent[1]
        )
    };
    // A roof, and a wall that is nearly upright.
    for left in ["-2 m", "-1 mm"] {
        let mut simulation = Simulation::new(&resolved(&scene(left)).scene).unwrap();
        assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
        let state = &simulation.state;
        let along = state.v[0] * tangent[0] + state.v[1] * tangent[1];
        let exact = speed + 9.81 * slope.sin() * 0.8;
        assert!((along - exact).abs() < 1e-6, "{left}: {along} m/s, not {exact}");
        assert!((state.q[2] + slope).abs() < 1e-4, "{left}: {}", state.q[2]);
        assert!(state.tally.max_penetration < 1e-4, "{left}: {:e} m", state.tally.max_penetration);
    }
}

/// A disc that rolls on compliant ground keeps the depth at which it carries its weight, whatever points the ground's profile has, where
/// a step ends on one, and while it still bounces on its spring.
#[test]
fn a_compliant_contact_goes_over_points_at_its_depth() {
    for (scheme, step, damping) in [
        ("moreau-jean", "1 ms", 100),
        ("moreau-jean", "130 us", 25),
        ("moreau-jean-closed", "100 us", 100),
        ("moreau-jean-closed", "100 us", 25),
        ("moreau-jean-closed", "130 us", 100),
        ("moreau-jean-located", "100 us", 100),
        ("moreau-jean-located", "100 us", 25),
        ("moreau-jean-located", "130 us", 25),
    ] {
        let text = format!(
            "[time]\nend = '2.5 s'\nstep = '{step}'\nscheme = '{scheme}'\n\
             [ground]\nprofile = {{ points = [['-1 m', '0 m'], ['5 cm', '0 m'], ['10 cm', '0 m'], ['15 cm', '0 m'], ['1 m', '0 m']] }}\n\
             [block.d]\ndensity = '7800 kg/m^3'\nradius = '2 cm'\ndepth = '10 cm'\n\
             position = ['0 m', '2 cm']\nvelocity = ['0.2 m/s', '0 m/s']\nspin = '-10 rad/s'\n\
             [contact.c]\nbetween = ['d', 'ground']\nfriction = 0.5\nlaw = 'kelvin-voigt'\nstiffness = '1e5 N/m'\ndamping = '{damping} N s/m'\n"
        );
        let mut run = Simulation::new(&resolved(&text).scene).unwrap();
        assert_eq!(run.run(&mut []).unwrap(), Ended::Complete);
        let weight = 7800.0 * std::f64::consts::PI * 0.02_f64.powi(2) * 0.1 * 9.81;
        let depth = 0.02 - run.state.q[1];
        assert!((depth / (weight / 1e5) - 1.0).abs() < 1e-6, "{scheme}, {step}: {depth:e} m");
        let ledger = &run.state.ledger;
        assert!(ledger.positive_contact_work.sum <= 1e-12 * ledger.scale, "{scheme}, {step}: {ledger:?}");
    }
}
