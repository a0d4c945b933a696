//! Loads, prescribed motion and inclined ground, from the scene file to the motion: against closed
//! forms.

use std::f64::consts::{PI, TAU};
use teeter_integrator::{Ended, Signal};
use teeter_scenario::resolve::Resolved;
use teeter_scenario::simulation::Simulation;
use teeter_scenario::{load, load_with};

fn resolved(text: &str) -> Resolved {
    load(text.as_bytes(), "scene.toml", "scene", &[]).unwrap_or_else(|errors| panic!("{errors}"))
}

fn ran(text: &str) -> Simulation {
    let mut simulation = Simulation::new(&resolved(text).scene).unwrap();
    assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
    let ledger = &simulation.state.ledger;
    assert!(ledger.relative_residual() <= 1e-12, "energy identity: {:e}", ledger.relative_residual());
    simulation
}

/// A block of 1 kg.
const BLOCK: &str = "
[material.m]
density = '1000 kg/m^3'
youngs_modulus = '69 GPa'
[block.b]
material = 'm'
width = '10 cm'
height = '10 cm'
depth = '10 cm'
";

fn free_block(end: &str, more: &str) -> Simulation {
    let head = format!("[time]\nend = '{end}'\nstep = '1 ms'\n[world]\ngravity = '0 m/s^2'\n");
    ran(&format!("{head}{BLOCK}position = ['0 m', '0 m']\n{more}"))
}

#[test]
fn a_constant_force_and_couple_on_a_free_block_give_the_parabola_exactly() {
    let run = free_block("2 s", "[force.f]\non = 'b'\nforce = ['3 N', '-1 N']\ncouple = '0.01 N m'\n");
    let inertia = 1.0 * (0.01 + 0.01) / 12.0;
    for (found, exact) in run.state.q.iter().zip([0.5 * 3.0 * 4.0, -0.5 * 4.0, 0.5 * 0.01 / inertia * 4.0]) {
        assert!((found / exact - 1.0).abs() < 1e-13, "{found} {exact}");
    }
}

#[test]
fn a_pulse_leaves_its_area_and_a_table_of_it_the_same() {
    let on = "[force.f]\non = 'b'\nforce = ['3 N', '0 N']\nsignal = 's'\n[signal.s]\n";
    let formula = free_block("1 s", &format!("{on}shape = 'half-sine'\nstart = '0.1 s'\nduration = '0.3 s'\n"));
    let area = 3.0 * 2.0 * 0.3 / PI;
    assert!((formula.state.v[0] / area - 1.0).abs() < 1e-13);

    let rows: String =
        (0..=300).map(|k| format!("{}, {:?}\n", f64::from(k) / 1e3, (PI * f64::from(k) / 300.0).sin())).collect();
    let text = format!(
        "[time]\nend = '1 s'\nstep = '1 ms'\n[world]\ngravity = '0 m/s^2'\n{BLOCK}position = ['0 m', '0 m']\n\
         {on}shape = 'table'\nfile = 'push.csv'\nstart = '0.1 s'\n"
    );
    let mut asked = Vec::new();
    let read = &mut |file: &str| {
        asked.push(file.to_owned());
        Ok(rows.clone().into_bytes())
    };
    let resolved = load_with(text.as_bytes(), "scene.toml", "scene", &[], read).unwrap();
    assert_eq!(
        (asked, resolved.files),
        (vec!["push.csv".to_owned()], vec![("push.csv".to_owned(), rows.into_bytes())])
    );
    let mut table = Simulation::new(&resolved.scene).unwrap();
    assert_eq!(table.run(&mut []).unwrap(), teeter_integrator::Ended::Complete);
    // Lines between 300 rows of a sine: (π/300)²/12 low.
    let low = 1.0 - (PI / 300.0_f64).powi(2) / 12.0;
    for (a, b) in [(table.state.v[0], formula.state.v[0]), (table.state.q[0], formula.state.q[0])] {
        assert!((a / (low * b) - 1.0).abs() < 1e-9, "{a} {b}");
    }
}

#[test]
fn what_is_prescribed_of_a_block_is_so_and_the_rest_falls_freely() {
    let head = "[time]\nend = '1 s'\nstep = '1 ms'\n[world]\ngravity = '10 m/s^2'\n";
    let motion = "motion = { acceleration = ['2 m/s^2', '9 m/s^2'], only = 'x', angular_velocity = '0.5 rad/s' }";
    let run = ran(&format!("{head}{BLOCK}position = ['0 m', '0 m']\n{motion}\n"));
    for (found, exact) in run.state.q.iter().zip([1.0, -5.0, 0.5]) {
        assert!((found - exact).abs() < 1e-12, "{found} {exact}");
    }
    // The drives gave what the motion has: ½mv² + ½Iω² (the weight has its own account).
    let given = 0.5 * 4.0 + 0.0;
    assert!((run.state.ledger.sum.external - given).abs() < 1e-12, "{}", run.state.ledger.sum.external);
}

/// A block that rocks on the ground, everything moving at (vx, vy).
fn rocking(vx: f64, vy: f64, ground: &str) -> Simulation {
    ran(&format!(
        "[time]\nend = '0.6 s'\nstep = '0.5 ms'\n[ground]\n{ground}\n{}on = 'ground'\nat = '0 m'\ntilt = '3 deg'\n\
         velocity = ['{vx} m/s', '{vy} m/s']\n[contact.c]\nbetween = ['b', 'ground']\nfriction = 0.5\n",
        BLOCK.replace("height = '10 cm'", "height = '40 cm'")
    ))
}

#[test]
fn on_ground_that_moves_evenly_the_motion_is_the_same() {
    let still = rocking(0.0, 0.0, "");
    // Powers of two: moved by them places lose digits, but gain no rounding of the velocity.
    let moving = rocking(0.5, 0.25, "motion = { velocity = ['0.5 m/s', '0.25 m/s'] }");
    let (q, t) = (&moving.state.q, 0.6);
    for (k, shift) in [(0, 0.5 * t), (1, 0.25 * t), (2, 0.0)] {
        let error = (q[k] - shift - still.state.q[k]).abs();
        assert!(error < 1e-11, "coordinate {k} is off by {error:e}");
    }
    assert!((q[3] - 0.3).abs() < 1e-14 && (q[4] - 0.15).abs() < 1e-14 && q[5] == 0.0);
    assert!(still.state.q[2].abs() > 1e-3, "it still rocks");
    // In this frame the ground carries the block: its work is no small thing, and accounted for.
    assert!(moving.state.ledger.sum.external.abs() > 0.1);
}

#[test]
fn a_block_that_sticks_follows_shaken_ground() {
    // A cosine: displaced at the start, and at rest, so that the block needs no impact to follow.
    let motion = "motion = { displacement = ['2 cm', '0 m'], angle = '2 deg', signal = 's' }\n\
                  [signal.s]\nshape = 'harmonic'\nfrequency = '1 Hz'\nphase = '90 deg'";
    let run = ran(&format!(
        "[time]\nend = '1.3 s'\nstep = '0.5 ms'\n[ground]\n{motion}\n{BLOCK}on = 'ground'\nat = '2 cm'\n\
         [contact.c]\nbetween = ['b', 'ground']\nfriction = 0.9\n"
    ));
    let (q, exact) = (&run.state.q, (TAU * 1.3).cos());
    // Coordinates are the mean of those half a step before and after, and what that misses at the
    // start: (ωh)²/8 = 1.2e-6 low.
    let half = TAU * 0.25e-3;
    let placed = half.cos() * exact + 1.0 - half.cos();
    assert!((q[3] - 0.02 * placed).abs() < 1e-12 && (q[5] - 2_f64.to_radians() * placed).abs() < 1e-12);
    // Constraints hold for velocities: what is left of their drift.
    assert!((q[2] - q[5]).abs() < 2e-5, "it stands on the ground: {} {}", q[2], q[5]);
    let along = (q[0] - q[3]) * q[5].cos() + (q[1] - q[4]) * q[5].sin();
    assert!(along.abs() < 2e-6, "and sticks: {along:e}");
}

fn on_incline(degrees: f64, friction: f64) -> Simulation {
    ran(&format!(
        "[time]\nend = '1 s'\nstep = '1 ms'\n[ground]\nincline = '{degrees} deg'\n{BLOCK}on = 'ground'\nat = '30 cm'\n\
         [contact.c]\nbetween = ['b', 'ground']\nfriction = {friction}\n"
    ))
}

#[test]
fn on_an_incline_a_block_rests_or_slides_as_coulomb_has_it() {
    let slope = 20_f64.to_radians();
    let start = (0.3 - 0.05 * slope.sin(), 0.3 * slope.tan() + 0.05 * slope.cos());
    let resting = on_incline(20.0, 0.4);
    assert!((resting.state.q[0] - start.0).abs() < 1e-14 && (resting.state.q[1] - start.1).abs() < 1e-14);
    assert_eq!(resting.state.q[2], slope);

    let sliding = on_incline(20.0, 0.3);
    let a = 9.81 * (slope.sin() - 0.3 * slope.cos());
    let down = (sliding.state.q[0] - start.0).hypot(sliding.state.q[1] - start.1);
    assert!((down / (0.5 * a) - 1.0).abs() < 1e-10, "{down} {}", 0.5 * a);
    assert!(sliding.state.q[0] < start.0, "downhill is to the left");
    assert!(sliding.state.tally.max_penetration < 1e-12);
}

#[test]
fn ground_that_tilts_slowly_lets_a_block_go_at_the_angle_of_friction() {
    // 20 degrees in 4 s; tan⁻¹ 0.2 = 11.3 degrees, after 2.26 s.
    let run = |end: &str| {
        ran(&format!(
            "[time]\nend = '{end}'\nstep = '1 ms'\n[ground]\nmotion = {{ angle = '20 deg', signal = 's' }}\n\
             [signal.s]\nshape = 'ramp'\nduration = '4 s'\n{BLOCK}on = 'ground'\nat = '0 m'\n\
             [contact.c]\nbetween = ['b', 'ground']\nfriction = 0.2\n"
        ))
    };
    let along = |s: &Simulation| {
        let (q, angle) = (&s.state.q, s.state.q[5]);
        q[0] * angle.cos() + q[1] * angle.sin()
    };
    let (before, after) = (run("2.2 s"), run("2.6 s"));
    assert!(along(&before).abs() < 1e-4, "{}", along(&before));
    assert!(along(&after) < -5e-3, "{}", along(&after));
}

/// The paper's beam, heavily damped.
fn beam(end: &str, more: &str) -> Simulation {
    ran(&format!(
        "[time]\nend = '{end}'\nstep = '50 us'\n[material.m]\ndensity = '2700 kg/m^3'\nyoungs_modulus = '69 GPa'\n\
         [beam.t]\nmaterial = 'm'\nspan = '36 cm'\nwidth = '3 cm'\nthickness = '1.5 mm'\nelements = 20\n\
         damping_ratio = {{ mode = 1, ratio = 0.3 }}\n{more}\n"
    ))
}

fn middle(simulation: &Simulation, of: &[f64]) -> f64 {
    let place = &simulation.layout.beams[0];
    place.beam.deflection_at(&of[place.range.clone()], 0.18).unwrap().w
}

#[test]
fn a_beam_on_shaken_supports_swings_as_its_modes_say() {
    // Relative to the supports: ẅ_k + (c/ρA) ẇ_k + ω_k² w_k = −Γ_k ÿ, Γ_k = 4/(kπ) for odd k, mode
    // shape sin(kπx/L).
    let (omega, amplitude, t) = (TAU * 20.0, 3.0, 0.5125);
    let run = beam(
        "0.5125 s",
        "motion = { acceleration = ['0 m/s^2', '3 m/s^2'], signal = 's' }\n[signal.s]\nshape = 'harmonic'\n\
         frequency = '20 Hz'\nphase = '30 deg'",
    );
    let (ei, rho_a, span): (f64, f64, f64) = (69e9 * 0.03 * 0.0015_f64.powi(3) / 12.0, 0.1215, 0.36);
    let mode = |k: f64| (k * PI / span).powi(2) * (ei / rho_a).sqrt();
    let decay = 2.0 * 0.3 * mode(1.0);
    let (mut w, mut w_rate) = (0.0, 0.0);
    for k in [1.0, 3.0, 5.0, 7.0_f64] {
        let (stiff, drag) = (mode(k).powi(2) - omega * omega, decay * omega);
        let (size, lag) = (-4.0 / (k * PI) * amplitude / stiff.hypot(drag), drag.atan2(stiff));
        let argument = omega * t + 30_f64.to_radians() - lag;
        let shape = (k * PI / 2.0).sin();
        w += shape * size * argument.sin();
        w_rate += shape * size * omega * argument.cos();
    }
    let (found, rate) = (middle(&run, &run.state.q), middle(&run, &run.state.v));
    // The scheme's phase, (ωh)²/12 and (ω₁h)²/12 of a quarter; what is left of the start, exp(−0.3
    // ω₁ t) = 1e-11.
    let scale = 4.0 / PI * amplitude / mode(1.0).powi(2);
    assert!((found - w).abs() < 2e-5 * scale, "{found} {w}");
    assert!((rate - w_rate).abs() < 2e-5 * scale * mode(1.0), "{rate} {w_rate}");
    // The supports are where the signal has them.
    let place = run.layout.beams[0].supports.clone().unwrap();
    let signal = resolved_signal(omega);
    let y = amplitude * signal.double_integral(t);
    assert!((run.state.q[place.start + 1] / y - 1.0).abs() < 1e-5 && run.state.q[place.start] == 0.0);
}

fn resolved_signal(omega: f64) -> impl Signal {
    teeter_integrator::Formula::harmonic(0.0, omega / TAU, 30_f64.to_radians()).unwrap()
}

#[test]
fn loads_on_a_beam_bend_it_as_the_books_have_it() {
    let ei = 69e9 * 0.03 * 0.0015_f64.powi(3) / 12.0;
    let sag = |load: &str| {
        // Put on slowly: what a sudden load gives the highest modes, θ = ½ hardly damps.
        let slowly = "signal = 's'\n[signal.s]\nshape = 'ramp'\nduration = '0.2 s'";
        let run = beam("1 s", &format!("[load.f]\non = 't'\n{load}\n{slowly}\n"));
        middle(&run, &run.state.q)
    };
    let l = 0.36_f64;
    let cases = [
        ("at = '18 cm'\nforce = '-1 N'", -l.powi(3) / (48.0 * ei)),
        ("distributed = '-2 N/m'", -5.0 * 2.0 * l.powi(4) / (384.0 * ei)),
        // A couple at the left end: M L²/16.
        ("at = '0 cm'\ncouple = '-0.1 N m'", -0.1 * l * l / 16.0 / ei),
    ];
    for (load, exact) in cases {
        let found = sag(load);
        assert!((found / exact - 1.0).abs() < 1e-9, "{load}: {found} {exact}");
    }
}

#[test]
fn a_block_on_a_beam_whose_supports_move_evenly_moves_with_them() {
    let rocking = |velocity: &str, motion: &str| {
        ran(&format!(
            "[time]\nend = '0.1 s'\nstep = '100 us'\n{}on = 't'\nat = '18 cm'\ntilt = '5 deg'\nvelocity = {velocity}\n\
             [beam.t]\nmaterial = 'm'\nspan = '36 cm'\nwidth = '3 cm'\nthickness = '3 mm'\nelements = 10\n\
             start = 'static'\nsurface = 'top'\nviscous_damping = '0.4 N s/m^2'\n{motion}\n\
             [contact.c]\nbetween = ['b', 't']\nfriction = 0.5\n",
            BLOCK.replace("width = '10 cm'", "width = '3 cm'").replace("depth = '10 cm'", "depth = '3 cm'")
        ))
    };
    let still = rocking("['0 m/s', '0 m/s']", "");
    let moving = rocking("['0.5 m/s', '-0.25 m/s']", "motion = { velocity = ['0.5 m/s', '-0.25 m/s'] }");
    let n = still.state.q.len();
    for (k, (moved, still)) in moving.state.q.iter().zip(&still.state.q).enumerate() {
        let shift = [0.05, -0.025].get(k).copied().unwrap_or(0.0);
        assert!((moved - shift - still).abs() < 1e-10, "coordinate {k}: {moved} {still}");
    }
    assert!((moving.state.q[n] - 0.05).abs() < 1e-14 && (moving.state.q[n + 1] + 0.025).abs() < 1e-14);
    assert!(still.state.q[2] < 4.9_f64.to_radians(), "it has moved");
}

/// Where a block can stand on a beam is where that is at t = 0.
#[test]
fn a_displaced_beam_carries_where_it_is() {
    let scene = |at: &str| {
        let block = BLOCK.replace("width = '10 cm'", "width = '3 cm'").replace("depth = '10 cm'", "depth = '3 cm'");
        let text = format!(
            "[time]\nend = '2 ms'\nstep = '200 us'\n{block}on = 't'\nat = '{at}'\n\
             [beam.t]\nmaterial = 'm'\nspan = '36 cm'\nwidth = '3 cm'\nthickness = '3 mm'\nelements = 10\n\
             motion = {{ displacement = ['20 cm', '0 mm'] }}\n[contact.c]\nbetween = ['b', 't']\nfriction = 0.5\n"
        );
        load(text.as_bytes(), "scene.toml", "scene", &[])
    };
    let mut simulation = Simulation::new(&scene("45 cm").unwrap().scene).unwrap();
    assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
    assert!((simulation.state.q[0] - 0.45).abs() < 1e-6, "{}", simulation.state.q[0]);
    let refused = scene("5 cm").unwrap_err().to_string();
    assert!(refused.contains("extends from 0.2 m to 0.56 m"), "{refused}");
}

/// Blocks are placed on a beam as it is at t = 0: with supports that start displaced all is as far from where it is without, and stays as
/// near to each other.
#[test]
fn blocks_start_on_a_beam_whose_supports_start_displaced() {
    let scene = |more: &str, motion: &str| {
        let text = format!(
            "[time]\nend = '20 ms'\nstep = '200 us'\n{}on = 't'\nat = '12 cm'\n\
             [block.c]\nmaterial = 'm'\nwidth = '3 cm'\nheight = '2 cm'\ndepth = '3 cm'\non = 'b'\nat = '12 cm'\n\
             [block.d]\nmaterial = 'm'\nwidth = '3 cm'\nheight = '5 cm'\ndepth = '3 cm'\non = 't'\nat = '25 cm'\ntilt = '3 deg'\n\
             [beam.t]\nmaterial = 'm'\nspan = '36 cm'\nwidth = '3 cm'\nthickness = '3 mm'\nelements = 10\n{more}\n{motion}\n\
             [contact.c]\nbetween = ['*', 't']\nfriction = 0.5\n[contact.e]\nbetween = ['b', 'c']\nfriction = 0.5\n",
            BLOCK.replace("width = '10 cm'", "width = '3 cm'").replace("depth = '10 cm'", "depth = '3 cm'")
        );
        Simulation::new(&resolved(&text).scene).unwrap()
    };
    for more in ["", "start = 'static'", "start = 'static'\nsurface = 'top'", "start = 'static'\nmodel = 'modes'"] {
        let still = scene(more, "");
        for up in [1.0, -1.0, 30.0] {
            let motion = format!(
                "motion = {{ displacement = ['0 mm', '{up} mm'], signal = 's' }}\n[signal.s]\nshape = 'harmonic'\nfrequency = '2 Hz'\nphase = '90 deg'"
            );
            let mut moved = scene(more, &motion);
            let n = still.state.q.len();
            for (k, (moved, still)) in moved.state.q.iter().zip(&still.state.q).enumerate() {
                let shift = if k < 9 && k % 3 == 1 { 1e-3 * up } else { 0.0 };
                assert!((moved - shift - still).abs() < 1e-11, "{more}, {up} mm: coordinate {k}: {moved} {still}");
            }
            assert!((moved.state.q[n + 1] - 1e-3 * up).abs() < 1e-17 && moved.state.q[n] == 0.0);
            let touching = |simulation: &Simulation| {
                let mut found = Vec::new();
                simulation.model.candidates(&simulation.state.q, 1e-10, &mut found).unwrap();
                found.len()
            };
            assert_eq!(touching(&moved), touching(&still), "{more}, {up} mm");
            assert_eq!(moved.run(&mut []).unwrap(), Ended::Complete);
        }
        // To the side the middle of the base is still where it was said to be, on a straight beam at the same height.
        let aside = scene("", "motion = { displacement = ['20 mm', '0 mm'] }");
        let straight = scene("", "");
        for k in 0..9 {
            assert!((aside.state.q[k] - straight.state.q[k]).abs() < 1e-15, "coordinate {k}");
        }
    }
}

#[test]
fn compliant_contact_carries_the_weight_at_its_static_depth() {
    for (law, depth) in [
        ("law = 'kelvin-voigt'\nstiffness = '1e5 N/m'\ndamping = '300 N s/m'", 9.81 / 2e5),
        (
            "law = 'hunt-crossley'\nstiffness = '1e7 N/m^1.5'\ndamping = '3e7 N s/m^2.5'",
            (9.81 / 2e7_f64).powf(2.0 / 3.0),
        ),
        ("law = 'hunt-crossley'\nstiffness = '1e7 N/m'\ndamping = '3 s/m'", (9.81 / 2e7_f64).powf(2.0 / 3.0)),
    ] {
        let run = ran(&format!(
            "[time]\nend = '1.5 s'\nstep = '50 us'\n[ground]\n{BLOCK}on = 'ground'\nat = '0 m'\n\
             [contact.c]\nbetween = ['b', 'ground']\nfriction = 0.5\n{law}\n"
        ));
        let found = 0.05 - run.state.q[1];
        // What still swings of the start is damped by a D that acts in proportion to the depth.
        assert!((found / depth - 1.0).abs() < 0.02, "{law}: {found:e} {depth:e}");
    }
}

#[test]
fn the_closed_scheme_runs_by_its_word_and_a_scene_as_run_reads_back() {
    let text = format!(
        "[time]\nend = '0.1 s'\nstep = '1 ms'\nscheme = 'moreau-jean-closed'\n[ground]\nincline = '5 deg'\n\
         motion = {{ acceleration = ['1 m/s^2', '0 m/s^2'], signals = ['a', 'b'] }}\n\
         [signal.a]\nshape = 'ricker'\npeak = '50 ms'\nfrequency = '20 Hz'\n[signal.b]\nshape = 'constant'\n\
         {BLOCK}on = 'ground'\nat = '0 m'\nmotion = {{ angle = '0 deg' }}\n[force.f]\non = 'b'\ncouple = '1 N m'\n\
         [contact.c]\nbetween = ['b', 'ground']\nfriction = 0.5\nlaw = 'poisson'\n"
    );
    let written = resolved(&text).document.to_toml();
    let again = resolved(&written);
    assert_eq!(again.document.to_toml(), written);
    assert_eq!(again.scene, resolved(&text).scene);
    assert!(written.contains("signals = [\"a\", \"b\"]") && written.contains("restitution = 0.0"));
    ran(&written);
}

#[test]
fn paths_are_rewritten_where_they_are_paths() {
    let text = format!(
        "title = 'push.csv'\n[time]\nend = '0.1 s'\nstep = '1 ms'\n{BLOCK}position = ['0 m', '0 m']\n\
         [signal.s]\nshape = 'table'\nfile = 'push.csv'\n"
    );
    let read = &mut |_: &str| Ok(b"0,0\n1,0\n".to_vec());
    let resolved = load_with(text.as_bytes(), "scene.toml", "scene", &[], read).unwrap();
    let written = resolved.document.to_toml_elsewhere(|file| format!("../up/{file}"));
    assert!(written.contains("file = \"../up/push.csv\"") && written.contains("title = \"push.csv\""), "{written}");
    let refused = load(text.as_bytes(), "scene.toml", "scene", &[]).unwrap_err().to_string();
    assert!(refused.contains("signal.s.file") && refused.contains("other files can't be read here"), "{refused}");
}

const PUSHED: &str = "[force.f]\non = 'b'\nforce = ['3 N', '0 N']\nsignal = 's'\n";

const TERMS: &str = "
[signal.s]
shape = 'sum'
terms = ['slow', 'both', 'slow']
scale = 2
[signal.both]
shape = 'sum'
terms = ['ramp', 'swept']
scale = -0.5
[signal.slow]
shape = 'harmonic'
frequency = '0.7 Hz'
phase = '90 deg'
[signal.ramp]
shape = 'ramp'
duration = '0.4 s'
scale = 3
[signal.swept]
shape = 'chirp'
from = '1 Hz'
to = '12 Hz'
duration = '0.8 s'
growth = 'logarithmic'
";

#[test]
fn a_sum_pushes_as_its_terms_do() {
    let sum = free_block("1 s", &format!("{PUSHED}{TERMS}"));
    // 2 (2 slow − ½ (3 ramp + swept))
    let apart = |name: &str, signal: &str, force: f64| {
        format!("[force.{name}]\non = 'b'\nforce = ['{force} N', '0 N']\nsignal = '{signal}'\n")
    };
    let forces = [apart("f", "slow", 12.0), apart("g", "ramp", -3.0), apart("h", "swept", -3.0)].concat();
    let terms = TERMS.split_once("[signal.slow]").unwrap().1;
    let parts = free_block("1 s", &format!("{forces}[signal.slow]{terms}"));
    assert!(sum.state.v[0].abs() > 0.1);
    for (sum, parts) in [(&sum.state.v, &parts.state.v), (&sum.state.q, &parts.state.q)] {
        assert!((sum[0] - parts[0]).abs() < 1e-14, "{} {}", sum[0], parts[0]);
    }
}

#[test]
fn a_chirp_leaves_its_impulse_whatever_the_step() {
    let push = "[signal.s]\nshape = 'chirp'\nfrom = '2 Hz'\nto = '10 Hz'\nduration = '0.5 s'\nstart = '0.1 s'\n";
    let run = free_block("1 s", &format!("{PUSHED}{push}"));
    // ∫ sin(2π(2τ + 8τ²)) by Simpson's rule.
    let value = |t: f64| (TAU * (2.0 * t + 8.0 * t * t)).sin();
    let (n, h) = (100_000_u32, 0.5 / 2e5);
    let area: f64 = (0..n)
        .map(|k| {
            let t = 2.0 * h * f64::from(k);
            h / 3.0 * (value(t) + 4.0 * value(t + h) + value(t + 2.0 * h))
        })
        .sum();
    assert!((run.state.v[0] - 3.0 * area).abs() < 1e-12, "{} {}", run.state.v[0], 3.0 * area);
}

#[test]
fn sums_that_cannot_be_are_refused_with_place_and_remedy() {
    let message = |signals: &str| {
        let text = format!("[time]\nend = '1 s'\nstep = '1 ms'\n{BLOCK}position = ['0 m', '0 m']\n{PUSHED}{signals}");
        load(text.as_bytes(), "scene.toml", "scene", &[]).unwrap_err().to_string()
    };
    let sum = |name: &str, terms: &str| format!("[signal.{name}]\nshape = 'sum'\nterms = {terms}\n");
    let around = message(&[sum("s", "['a']"), sum("a", "['b']"), sum("b", "['a']")].concat());
    assert!(
        around.contains("signal.b.terms") && around.contains("the sums add each other: `a` → `b` → `a`"),
        "{around}"
    );
    assert_eq!(around.matches("error:").count(), 1, "{around}");
    let own = message(&sum("s", "['s']"));
    assert!(own.contains("the sums add each other: `s` → `s`"), "{own}");
    let unknown = message(&[sum("s", "['fats']"), "[signal.fast]\nshape = 'constant'\n".to_owned()].concat());
    assert!(
        unknown.contains("the signal `fats` is not defined") && unknown.contains("did you mean `fast`?"),
        "{unknown}"
    );
    assert!(message(&sum("s", "[]")).contains("must have one name or more"));
    assert!(message(&sum("s", "'a'")).contains("signal.s.terms"));
    let deep: String = (0..40).map(|k| sum(&format!("d{k}"), &format!("['d{}']", k + 1))).collect();
    let deep = message(&[sum("s", "['d0']"), deep, "[signal.d40]\nshape = 'constant'\n".to_owned()].concat());
    assert!(deep.contains("sums of sums, 33 deep, but 32 is the limit"), "{deep}");
    // A wrong term has one message: its own.
    let wrong = message(&[sum("s", "['a']"), "[signal.a]\nshape = 'harmonic'\n".to_owned()].concat());
    assert!(wrong.matches("error:").count() == 1 && wrong.contains("neither frequency nor period is given"), "{wrong}");
    let large = "[signal.c]\nshape = 'constant'\nscale = 1e10\n".to_owned();
    let large = message(&[sum("s", "['a']"), sum("a", "['c']\nscale = 1e10"), large].concat());
    assert!(large.contains("its factor of `c` is 1e20, over 1e12"), "{large}");
    let many = message("[signal.s]\nshape = 'chirp'\nfrom = '1 Hz'\nto = '1e9 Hz'\nduration = '1 s'\n");
    assert!(many.contains("signal.s.duration") && many.contains("at most 1000000 periods"), "{many}");
}

#[test]
fn terms_of_a_sum_are_checked_for_what_the_sum_drives() {
    let head = "[time]\nend = '1 s'\nstep = '20 ms'\n";
    let text = format!("{head}{BLOCK}position = ['0 m', '0 m']\n{PUSHED}{TERMS}");
    let warnings: Vec<String> = resolved(&text).warnings.iter().map(ToString::to_string).collect();
    let fast = warnings.iter().find(|warning| warning.contains("signal.swept.to")).unwrap();
    assert!(fast.contains("its shortest period of 83.33 ms is 4.17 steps of 20 ms: a step takes its mean"), "{fast}");
    assert!(!warnings.iter().any(|warning| warning.contains("not used")), "{warnings:?}");
}

const BURST: &str = "
[signal.s]
shape = 'product'
factors = ['envelope', 'both']
scale = 2
[signal.envelope]
shape = 'half-sine'
duration = '0.8 s'
scale = 3
[signal.both]
shape = 'sum'
terms = ['steady', 'beat']
[signal.steady]
shape = 'constant'
scale = 0.5
[signal.beat]
shape = 'product'
factors = ['slow', 'fast']
scale = -1.5
[signal.slow]
shape = 'harmonic'
frequency = '1 Hz'
[signal.fast]
shape = 'harmonic'
frequency = '7 Hz'
phase = '30 deg'
";

/// ∫ f by Simpson's rule.
fn simpson(f: impl Fn(f64) -> f64, end: f64) -> f64 {
    let (n, h) = (100_000_u32, end / 2e5);
    let piece = |k: u32| 2.0 * h * f64::from(k);
    (0..n).map(|k| h / 3.0 * (f(piece(k)) + 4.0 * f(piece(k) + h) + f(piece(k) + 2.0 * h))).sum()
}

#[test]
fn a_product_leaves_its_impulse_whatever_the_step() {
    let run = free_block("1 s", &format!("{PUSHED}{BURST}"));
    let value = |t: f64| {
        let beat = (TAU * t).sin() * (TAU * 7.0 * t + PI / 6.0).sin();
        2.0 * 3.0 * (PI * t / 0.8).sin() * (0.5 - 1.5 * beat)
    };
    let area = simpson(value, 0.8);
    assert!(area.abs() > 0.1 && (run.state.v[0] - 3.0 * area).abs() < 1e-12, "{} {}", run.state.v[0], 3.0 * area);
    let resolved =
        resolved(&format!("[time]\nend = '1 s'\nstep = '20 ms'\n{BLOCK}position = ['0 m', '0 m']\n{PUSHED}{BURST}"));
    let warnings: Vec<String> = resolved.warnings.iter().map(ToString::to_string).collect();
    assert!(!warnings.iter().any(|warning| warning.contains("not used")), "{warnings:?}");
    // 7 Hz and 1 Hz make 8 Hz, 6.25 steps of 20 ms.
    let fast = warnings.iter().find(|warning| warning.contains("signal.beat.factors")).unwrap();
    assert!(fast.contains("the frequencies of its factors add") && fast.contains("125 ms is 6.25 steps"), "{fast}");
    let written = resolved.document.to_toml();
    assert_eq!(load(written.as_bytes(), "scene.toml", "scene", &[]).unwrap().scene, resolved.scene);
}

#[test]
fn products_that_cannot_be_are_refused_with_place_and_remedy() {
    let message = |signals: &str| {
        let text = format!("[time]\nend = '1 s'\nstep = '1 ms'\n{BLOCK}position = ['0 m', '0 m']\n{PUSHED}{signals}");
        load(text.as_bytes(), "scene.toml", "scene", &[]).unwrap_err().to_string()
    };
    let product = |name: &str, of: &str| format!("[signal.{name}]\nshape = 'product'\nfactors = {of}\n");
    let around = message(&format!("{}[signal.a]\nshape = 'sum'\nterms = ['s']\n", product("s", "['a']")));
    assert!(around.contains("the signals are made of each other: `s` → `a` → `s`"), "{around}");
    assert_eq!(around.matches("error:").count(), 1, "{around}");
    assert!(message(&product("s", "['x']")).contains("the signal `x` is not defined"));
    assert!(message("[signal.s]\nshape = 'product'\nterms = ['a']\n").contains("has no meaning with shape = product"));
    let deep: String = (0..40).map(|k| product(&format!("d{k}"), &format!("['d{}']", k + 1))).collect();
    let deep = message(&[product("s", "['d0']"), deep, "[signal.d40]\nshape = 'constant'\n".to_owned()].concat());
    assert!(deep.contains("sums and products of each other, 33 deep, but 32 is the limit"), "{deep}");
    let fast = "[signal.f]\nshape = 'harmonic'\nfrequency = '1000 kHz'\n";
    let many = message(&[product("s", "['f', 'f']"), fast.to_owned()].concat());
    assert!(many.contains("signal.s.factors") && many.contains("at most 4000000 in a run"), "{many}");
    let one = "[signal.c]\nshape = 'constant'\n";
    let many = message(&[product("s", &format!("[{}]", vec!["'c'"; 16].join(","))), one.to_owned()].concat());
    assert!(many.contains("the number of factors is 16, but must be at most 15"), "{many}");
    let wrong = message(&[product("s", "['a']"), "[signal.a]\nshape = 'harmonic'\n".to_owned()].concat());
    assert!(wrong.matches("error:").count() == 1 && wrong.contains("neither frequency nor period is given"), "{wrong}");
    let large = "[signal.c]\nshape = 'constant'\nscale = 1e10\n".to_owned();
    let large = message(&[product("s", "['c', 'c']"), large].concat());
    assert!(large.contains("the scales of its factors multiply to 1e20, over 1e12"), "{large}");
}

#[test]
fn a_table_is_read_by_its_columns_its_unit_or_its_step_alone() {
    let pushed = |file: &'static str, keys: &str| {
        let text = format!(
            "[time]\nend = '1 s'\nstep = '1 ms'\n[world]\ngravity = '0 m/s^2'\n{BLOCK}position = ['0 m', '0 m']\n\
             {PUSHED}[signal.s]\nshape = 'table'\nfile = 'push.csv'\n{keys}"
        );
        let read = &mut |_: &str| Ok(file.as_bytes().to_vec());
        load_with(text.as_bytes(), "scene.toml", "scene", &[], read).map_err(|errors| errors.to_string())
    };
    let impulse = |file, keys: &str| {
        let resolved = pushed(file, keys).unwrap_or_else(|errors| panic!("{errors}"));
        assert_eq!(resolved.warnings.len(), 0, "{:?}", resolved.warnings.first().map(ToString::to_string));
        let mut simulation = Simulation::new(&resolved.scene).unwrap();
        assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
        simulation.state.v[0]
    };
    // 1 kg, 3 N: three times the area under 0, 2, 2, 0 at 0.1 s each, 0.4 s.
    for (file, keys) in [
        ("t,a\n0.1,0\n0.2,2\n0.3,2\n0.4,0\n", ""),
        ("n;b;t;a\n1;9;0,1;0\n2;9;0,2;2\n3;9;0,3;2\n4;9;0,4;0\n", "columns = ['t', 'a']"),
        ("0 100 9\n2 200 9\n2 300 9\n0 400 9\n", "columns = ['2', '1']\ntime_unit = 'ms'"),
        ("0\n2\n2\n0\n", "step = '0.1 s'\nstart = '0.1 s'"),
        ("a\n0\n2\n2\n0\n", "step = '100 ms'"),
        // One column with decimal commas.
        ("0,0\n2,0\n2,0\n0,0\n", "step = '0.1 s'"),
        ("a\n0\n2,00\n2,00\n0\n", "step = '0.1 s'"),
    ] {
        let found = impulse(file, keys);
        assert!((found - 3.0 * 0.4).abs() < 1e-14, "{keys}: {found}");
    }
    // Outside its rows the first and last value, with a warning, or 0.
    let (file, area) = ("0.1,1\n0.3,2\n", 0.3);
    assert_eq!(pushed(file, "").unwrap().warnings.len(), 2);
    assert!((impulse(file, "outside = 'zero'") - 3.0 * area).abs() < 1e-14);
    assert!((impulse("0.1,2\n0.3,0\n", "outside = 'zero'") - 3.0 * 0.2).abs() < 1e-14);
    for (file, keys, says) in [
        ("0\n1\n", "step = '1 s'\ncolumns = ['1', '2']", "with step the file has one column"),
        ("0\n1\n", "step = '1 s'\ntime_unit = 'ms'", "with step the file has one column"),
        ("0,1\n1,2\n", "step = '1 s'", "line 1: 2 columns, but a table has one, values, with step"),
        ("0\n", "step = '1 s'", "it has 1 row of numbers, but a table needs two or more"),
        ("0\nx\n", "step = '1 s'", "line 2: `x` is not a number"),
        ("t,a,b\n0,1,2\n", "columns = ['t', 'c']", "there is no column `c`: the heading has t, a, b"),
        ("t [ms],a\n0,1\n1,2\n", "time_unit = 'ms'", "the heading has the unit `ms`, so `ms` must be left out"),
        ("0,1\n1,2\n", "outside = 'repeat'", "hold, zero"),
    ] {
        let told = pushed(file, keys).map(|_| ()).unwrap_err();
        assert!(told.contains(says), "{keys}: {told}");
    }
}
