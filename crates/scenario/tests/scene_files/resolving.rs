//! What takes two keys to be wrong: each refused with a message that names the key, the rule and
//! the remedy.

use crate::ROCKING;
use teeter_scenario::load;
use teeter_scenario::simulation::Simulation;

/// The message for the interface's scene with lines replaced.
fn refused(changes: &[(&str, &str)]) -> String {
    let mut text = ROCKING.to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    match load(text.as_bytes(), "scene.toml", "scene", &[]) {
        Err(errors) => errors.to_string(),
        Ok(resolved) => match Simulation::new(&resolved.scene) {
            Err(error) => error.to_string(),
            Ok(_) => panic!("accepted: {changes:?}"),
        },
    }
}

fn set(sets: &[(&str, &str)]) -> Result<(teeter_scenario::resolve::Resolved, Simulation), String> {
    let sets: Vec<_> = sets.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
    let resolved = load(ROCKING.as_bytes(), "scene.toml", "scene", &sets).map_err(|errors| errors.to_string())?;
    let simulation = Simulation::new(&resolved.scene).map_err(|error| error.to_string())?;
    Ok((resolved, simulation))
}

#[track_caller]
fn says(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "«{part}» is missing in:\n{message}");
    }
}

#[test]
fn references_to_nothing() {
    says(
        &refused(&[("[block.rocker]\nmaterial = \"aluminium\"", "[block.rocker]\nmaterial = \"steel\"")]),
        &["scene.toml:", "block.rocker.material", "`steel` is not defined", "aluminium"],
    );
    says(
        &refused(&[("[\"rocker\", \"table\"]", "[\"rocker\", \"tabel\"]")]),
        &["contact.feet.between", "there is no body `tabel`", "rocker, table"],
    );
    says(&refused(&[("[\"rocker\", \"table\"]", "[\"rocker\", \"rocker\"]")]), &["`rocker` can't touch itself"]);
    says(
        &refused(&[("on       = \"table\"", "on = \"ground\"")]),
        &["block.rocker.on", "there is no body `ground`", "add [ground]"],
    );
    says(
        &refused(&[("youngs_modulus = \"69 GPa\"", "")]),
        &["material.aluminium.youngs_modulus", "used by beam.table"],
    );
}

#[test]
fn a_block_needs_a_contact_with_what_it_stands_on() {
    says(
        &refused(&[("[\"rocker\", \"table\"]", "[\"rocker\", \"ground\"]"), ("[world]", "[ground]\n[world]")]),
        &["block.rocker.on", "there is no contact between the two", "between = [\"rocker\", \"table\"]"],
    );
}

#[test]
fn places_given_twice_or_not_at_all() {
    let position = "position = [\"18 cm\", \"6.75 cm\"]\non = \"table\"";
    says(&refused(&[("on       = \"table\"", position)]), &["position already gives the place of the block"]);
    says(
        &refused(&[("on       = \"table\"", ""), ("at       =", "# at ="), ("tilt     =", "# tilt =")]),
        &["block.rocker", "the position of the block is missing"],
    );
}

#[test]
fn damping_given_twice() {
    let Err(message) = set(&[("beam.table.viscous_damping", "0.4 N s/m^2")]) else { panic!("accepted") };
    says(&message, &["viscous_damping", "damping_ratio", "keep one"]);
}

#[test]
fn blocks_that_do_not_fit_on_the_beam() {
    let of = |sets: &[(&str, &str)]| set(sets).map(|_| ()).expect_err("accepted");
    says(&of(&[("block.rocker.width", "50 cm")]), &["0.5 m wide", "0.36 m"]);
    let flat = [("block.rocker.at", "35 cm"), ("block.rocker.tilt", "0 deg"), ("contact.feet.points", "corners")];
    says(&of(&flat), &["bottom-right", "0.365 m", "0.36 m"]);
    says(&of(&flat[..2]), &["bottom-right", "0.365 m", "to overhang the end, write contact.feet.points = \"all\""]);
    let asked = [flat[0], flat[1], ("contact.feet.points", "all")];
    assert!(set(&asked).is_ok(), "where it is asked for, its base may overhang the end");
    says(&of(&[("block.rocker.at", "40 cm"), ("block.rocker.tilt", "0 deg")]), &["bottom-left", "0.385 m"]);
    says(&of(&[("block.rocker.at", "1 cm")]), &["bottom-left"]);
    assert!(set(&[("block.rocker.at", "35 cm")]).is_ok(), "the lifted corner may hang over the end");
}

#[test]
fn a_corner_that_starts_inside_a_surface() {
    let message = refused(&[
        ("on       = \"table\"", "position = [\"18 cm\", \"6.65 cm\"]"),
        ("at       =", "# at ="),
        ("tilt     =", "# tilt ="),
        ("start     = \"static\"", "start = \"undeformed\""),
    ]);
    says(&message, &["block `rocker`", "bottom-left", "1 mm below", "table"]);
}

#[test]
fn beams_that_can_move_have_no_static_start() {
    for (supports, missing) in [
        ("['free', 'free']", "clamp one end or pin both"),
        ("['pinned', 'free']", "support the right end"),
        ("['free', 'pinned']", "support the left end"),
    ] {
        let message = set(&[("beam.table.supports", supports), ("beam.table.damping_ratio.ratio", "0")]).err();
        says(&message.expect("accepted"), &["beam.table.start", "rigid body", missing]);
    }
    set(&[("beam.table.supports", "['free', 'clamped']"), ("beam.table.thickness", "5 mm")]).unwrap();
    assert!(set(&[("beam.table.supports", "['free', 'free']"), ("beam.table.start", "undeformed")]).is_ok());
}

#[test]
fn times_that_do_not_fit_together() {
    let of = |sets: &[(&str, &str)]| set(sets).map(|_| ()).expect_err("accepted");
    says(&of(&[("time.step", "2 s")]), &["time.step", "longer than the whole run of 0.5 s"]);
    says(&of(&[("time.end", "1e6 s"), ("time.step", "1e-9 s")]), &["1.0e15 steps", "limit", "years"]);
    let (resolved, _) = set(&[("time.end", "0.50005 s")]).unwrap();
    assert_eq!(resolved.scene.time.steps(), 5001);
    says(&resolved.warnings[0].to_string(), &["warning", "time.end", "continues to 0.5001 s"]);
    let (resolved, _) = set(&[("time.end", "0.3 s"), ("time.step", "0.1 s")]).unwrap();
    assert_eq!(resolved.scene.time.steps(), 3, "0.3/0.1 is 2.9999999999999996");
    assert!(resolved.warnings.iter().all(|warning| warning.path != "time.end"));
}

#[test]
fn theta_below_a_half_needs_leave_and_names_the_largest_step() {
    let message = set(&[("time.theta", "0.3")]).map(|_| ()).expect_err("accepted");
    says(&message, &["time.theta", "stable only for steps up to", "allow_conditional_stability = true"]);
    let leave = ("time.allow_conditional_stability", "true");
    let (resolved, _) = set(&[("time.theta", "0.3"), leave]).unwrap();
    says(&resolved.warnings[0].to_string(), &["stable only for steps up to"]);
    let undamped =
        set(&[("time.theta", "0.3"), ("beam.table.damping_ratio.ratio", "0")]).map(|_| ()).expect_err("accepted");
    says(&undamped, &["grow at every step size"]);
}

#[test]
fn probes_and_rows_within_reason() {
    let of = |sets: &[(&str, &str)]| set(sets).map(|_| ()).expect_err("accepted");
    says(&of(&[("beam.table.probes", "['40 cm']")]), &["probes", "0.4 m", "0.36"]);
    says(&of(&[("time.end", "1e5 s"), ("output.every", "1e-4 s")]), &["output.every", "GB"]);
}

#[test]
fn a_tilt_beyond_the_critical_angle_is_a_warning_that_names_it() {
    let (resolved, _) = set(&[("block.rocker.tilt", "13 deg")]).unwrap();
    says(&resolved.warnings[0].to_string(), &["block.rocker.tilt", "12.53 deg"]);
}

#[test]
fn the_critical_angle_is_that_of_the_side_on_which_a_block_lies() {
    // Its lowest corner is on the ground at this height of its centre, which stays so with the angles that warn.
    let height = |angle: f64| {
        let (sin, cos) = angle.to_radians().sin_cos();
        1e2 * (0.5 * 0.03 * sin.abs() + 0.5 * 0.13 * cos.abs())
    };
    let warnings_at = |angle: &str, above: f64| {
        let place = height(angle.split(' ').next().unwrap().parse().unwrap()) + above;
        let text = format!(
            "[time]\nend = '1 s'\nstep = '1 ms'\n[ground]\n[material.a]\ndensity = '2700 kg/m^3'\n[block.b]\nmaterial = 'a'\n\
             width = '3 cm'\nheight = '13 cm'\ndepth = '3 cm'\nposition = ['0 m', '{place:.4} cm']\nangle = '{angle}'\n\
             [contact.floor]\nbetween = ['b', 'ground']\nfriction = 0.5\n"
        );
        let found = teeter_scenario::load(text.as_bytes(), "f", "f", &[]).unwrap().warnings;
        found.iter().map(ToString::to_string).filter(|text| text.contains("critical angle")).collect::<Vec<_>>()
    };
    let warnings = |angle: &str| warnings_at(angle, 0.0);
    for angle in ["0 deg", "12 deg", "90 deg", "-90 deg", "60 deg", "-50 deg"] {
        assert!(warnings(angle).is_empty(), "{angle}: {:?}", warnings(angle));
    }
    for (angle, named) in [("14 deg", "atan(width/height) = 12.99 deg"), ("-30 deg", "12.99")] {
        let [found] = &warnings(angle)[..] else { panic!("{angle}") };
        says(found, &["block.b.angle", named, "overturns"]);
    }
    // In flight it has no foot about which to overturn, however far it falls.
    for above in [0.2, 12.0] {
        assert!(warnings_at("14 deg", above).is_empty(), "{above} cm: {:?}", warnings_at("14 deg", above));
    }
    // What is thrown isn't released at rest.
    for key in ["spin = '4 rad/s'", "velocity = ['0.8 m/s', '0 m/s']"] {
        let thrown = format!("14 deg'\n{key} # '");
        assert!(warnings(&thrown).is_empty(), "{key}: {:?}", warnings(&thrown));
    }
    // A wide one on its narrow side.
    let text = "[time]\nend = '1 s'\nstep = '1 ms'\n[ground]\n[material.a]\ndensity = '2700 kg/m^3'\n[block.b]\nmaterial = 'a'\n\
         width = '13 cm'\nheight = '3 cm'\ndepth = '3 cm'\nposition = ['0 m', '6.621 cm']\nangle = '70 deg'\n\
         [contact.floor]\nbetween = ['b', 'ground']\nfriction = 0.5\n";
    let found = teeter_scenario::load(text.as_bytes(), "f", "f", &[]).unwrap().warnings;
    says(&found[0].to_string(), &["atan(height/width) = 12.99 deg of this block, which lies on its side", "overturns"]);
}

#[test]
fn the_gap_tolerance_follows_the_largest_block() {
    let of = |size: &str| {
        let (resolved, _) = set(&[("block.rocker.height", size), ("beam.table.start", "undeformed")]).unwrap();
        resolved.scene.time.gap_tolerance
    };
    assert_eq!(of("13.5 cm"), 1e-12);
    assert_eq!(of("1 m"), 1e-12);
    assert_eq!(of("2 m"), 2e-11);
}

#[test]
fn a_gap_tolerance_at_which_blocks_hover_is_refused_or_warned_of() {
    // The shortest side is 3 cm.
    let of = |given: &str| set(&[("time.gap_tolerance", given), ("time.step", "10 us")]);
    let refused = of("0.2 m").map(|_| ()).expect_err("accepted");
    says(
        &refused,
        &["time.gap_tolerance", "6.7 of the shortest side of a block, 0.03 m", "float that far above", "3e-5 m"],
    );
    assert!(of("31 um").is_err());
    let warns = |given: &str| {
        let (resolved, _) = of(given).unwrap();
        resolved.warnings.iter().filter(|found| found.path == "time.gap_tolerance").count()
    };
    assert_eq!((warns("29 um"), warns("31 nm"), warns("29 nm")), (1, 1, 0));
}

#[test]
fn a_solver_tolerance_that_leaves_contacts_unsolved_is_warned_of() {
    let warns = |given: &str| {
        let (resolved, _) = set(&[("solver.tolerance", given)]).unwrap();
        resolved.warnings.iter().filter(|found| found.path == "solver.tolerance").count()
    };
    assert_eq!((warns("0.5"), warns("2e-4"), warns("1e-4")), (1, 1, 0));
}

#[test]
fn the_scene_as_run_runs_again_to_the_same_bytes() {
    let (resolved, _) = set(&[("time.step", "50us")]).unwrap();
    let written = resolved.document.to_toml();
    let again = load(written.as_bytes(), "scene.toml", "other", &[]).unwrap();
    assert_eq!(again.scene, resolved.scene);
    assert_eq!(again.document.to_toml(), written);
}

#[test]
fn a_probe_given_twice_and_a_solver_for_fewer_contacts() {
    let of = |sets: &[(&str, &str)]| set(sets).map(|_| ()).expect_err("accepted");
    says(&of(&[("beam.table.probes", "['9 cm', '90 mm']")]), &["beam.table.probes", "0.09 m is given twice"]);
    let second = [
        ("solver.method", "enumeration"),
        ("contact.more", "{ between = ['rocker', 'ground'], friction = 0.1 }"),
        (
            "block.other",
            "{ material = 'aluminium', width = '1 cm', height = '1 cm', depth = '1 cm', position = ['3 m', '2 m'] }",
        ),
        ("contact.third", "{ between = ['other', 'ground'], friction = 0.1 }"),
        ("ground", "{}"),
        // above the ground
        ("beam.table.position", "['0 m', '1 m']"),
    ];
    let (resolved, _) = set(&second).unwrap();
    says(&resolved.warnings[0].to_string(), &["solver.method", "up to 5 contacts", "auto or pgs"]);
}

#[test]
fn every_plane_solver_of_the_catalogue_is_a_method_and_the_convex_one_warns() {
    for info in teeter_solvers::SOLVERS.iter().filter(|info| info.dimensions.contains(&2)) {
        let (resolved, _) =
            set(&[("solver.method", info.name)]).unwrap_or_else(|error| panic!("{}: {error}", info.name));
        let warned = resolved.warnings.iter().any(|warning| warning.to_string().contains("not Coulomb's"));
        assert_eq!(warned, info.law == teeter_contact::Law::Convex, "{}", info.name);
    }
}

#[test]
fn a_block_flush_with_an_end_fits_whatever_the_rounding() {
    for (left, at) in [("0 m", "34.5 cm"), ("0.5 m", "84.5 cm"), ("0.6 m", "94.5 cm"), ("0.3 m", "64.5 cm")] {
        set(&[
            ("beam.table.position", &format!("['{left}', '0 m']")),
            ("block.rocker.at", at),
            ("block.rocker.tilt", "-5 deg"),
        ])
        .unwrap();
    }
}
