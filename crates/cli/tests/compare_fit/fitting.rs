//! `teeter fit`.

use super::{Noise, done, folder, frames, read, scenario};
use std::fmt::Write;

/// A block that bounces on a springy table, in which both the restitution and the damping of the
/// table matter for its motion, and which is predictable to its end.
const BOUNCING: &str = "title = \"A block bounces on a springy table\"\n\
    [time]\nend = \"0.4 s\"\nstep = \"100 us\"\n\
    [material.aluminium]\ndensity = \"2700 kg/m^3\"\nyoungs_modulus = \"69 GPa\"\n\
    [material.wood]\ndensity = \"600 kg/m^3\"\n\
    [beam.table]\nmaterial = \"aluminium\"\nspan = \"36 cm\"\nwidth = \"3 cm\"\nthickness = \"2 mm\"\nelements = 12\n\
    model = \"modes\"\nmodes = { count = 1 }\ndamping_ratio = { mode = 1, ratio = 0.01 }\n\
    [block.cube]\nmaterial = \"wood\"\nwidth = \"3 cm\"\nheight = \"3 cm\"\ndepth = \"3 cm\"\n\
    position = [\"18 cm\", \"3.5 cm\"]\nangle = \"3 deg\"\n\
    [contact.feet]\nbetween = [\"cube\", \"table\"]\nfriction = 0.5\nrestitution = 0.3\n\
    [output]\nevery = \"0.1 ms\"\n";

/// A rocking block hardly shows the damping of its beam: the sum of squares is a wide valley with a rough bottom, of
/// which derivatives see the stones. The interval told must be that of the valley.
#[test]
fn values_that_fit_as_well_are_in_the_interval() {
    let folder = folder("valley");
    done(&folder, &["new", "scene.toml"]);
    let truth = ["--set", "contact.feet.restitution=0.45", "--set", "beam.table.damping_ratio.ratio=0.023"];
    let finely = ["--set", "time.end=\"1 s\"", "--set", "output.every=\"200 us\""];
    done(&folder, &[&["run", "scene.toml", "--out", "truth", "--quiet"], &truth[..], &finely[..]].concat());
    let mut noise = Noise(5);
    let mut text = "t,phi [deg]\n".to_owned();
    for [t, _, _, phi] in frames(&folder.join("truth"), "rocker") {
        writeln!(text, "{:.6},{:.4}", t + 2.0, phi.to_degrees() + 0.05 * noise.next()).unwrap();
    }
    std::fs::write(folder.join("camera.csv"), text).unwrap();
    let vary = ["--vary", "beam.table.damping_ratio.ratio=0.001..0.1", "--set", "contact.feet.restitution=0.45"];
    let given = ["fit", "scene.toml", "camera.csv", "--quiet", "--force", "--out", "fitted"];
    let told = done(&folder, &[&given[..], &vary[..], &finely[..]].concat());
    let found = read(&folder.join("fitted/fit.json"));
    let estimate = &found["estimates"][0];
    let [low, high] = [0, 1].map(|end| estimate["interval_95"][end].as_f64().unwrap());
    assert!(0.0 < low && low < 0.023 && 0.023 < high, "{low} to {high}\n{told}");
    if !estimate["as_good"].is_null() {
        assert!(told.contains("fit about as well as"), "{told}");
    }
    // The step is what ends the rows, at half a second: a step with which more of them count is told, and what half the step
    // would change, where that is more than the interval.
    let of_step = estimate["with_half_step"].as_f64().unwrap().abs();
    assert!(of_step > 0.0, "{estimate}");
    assert_eq!(told.contains("half the step would change"), of_step > 0.5 * (high - low), "{told}");
    let finer = &found["finer_step"];
    let [step, horizon] = ["step", "horizon"].map(|name| finer[name].as_f64().unwrap());
    assert!(step < 0.6e-4 && horizon > 1.2 * found["horizon"].as_f64().unwrap(), "{finer}");
    assert!(told.contains(&format!("fit again with --set time.step=\"{} us\"", 1e6 * step)), "{told}");
}

/// A block that stands on its beam and is let go where this is undeformed swings with it without impacts: how fast that
/// decays is the damping, which rocking hides.
#[test]
fn a_block_that_swings_with_its_beam_tells_the_damping_within_two_percent() {
    let folder = folder("swing");
    done(&folder, &["new", "scene.toml"]);
    let swing = "--set block.rocker.tilt=0deg --set beam.table.start=undeformed --set time.end=2s";
    let swing: Vec<&str> = swing.split(' ').collect();
    let truth = ["--set", "beam.table.damping_ratio.ratio=0.02", "--out", "truth", "--quiet"];
    done(&folder, &[&["run", "scene.toml"], &swing[..], &truth].concat());
    let mut noise = Noise(7);
    let mut text = "t,y [mm]\n".to_owned();
    for [t, _, y, _] in frames(&folder.join("truth"), "rocker") {
        writeln!(text, "{:.6},{:.4}", t + 2.0, 1e3 * y + 0.05 * noise.next()).unwrap();
    }
    std::fs::write(folder.join("camera.csv"), text).unwrap();
    let vary = ["--vary", "beam.table.damping_ratio.ratio=0.001..0.1", "--quiet", "--out", "fitted"];
    done(&folder, &[&["fit", "scene.toml", "camera.csv"], &swing[..], &vary].concat());
    let estimate = &read(&folder.join("fitted/fit.json"))["estimates"][0];
    let [low, high] = [0, 1].map(|end| estimate["interval_95"][end].as_f64().unwrap());
    let value = estimate["value"].as_f64().unwrap();
    assert!((value / 0.02 - 1.0).abs() < 0.02 && low < 0.02 && 0.02 < high && high - low < 0.02 * 0.04, "{estimate}");
}

#[test]
fn restitution_and_damping_come_back_within_two_percent() {
    let folder = folder("fit");
    std::fs::write(folder.join("scene.toml"), BOUNCING).unwrap();
    let truth = ["--set", "contact.feet.restitution=0.6", "--set", "beam.table.damping_ratio.ratio=0.05"];
    done(&folder, &[&["run", "scene.toml", "--out", "truth", "--quiet"], &truth[..]].concat());
    let mut noise = Noise(3);
    let mut text = "t,phi [deg],x [mm],y [mm]\n".to_owned();
    for [t, x, y, phi] in frames(&folder.join("truth"), "cube") {
        let angle = phi.to_degrees() + 0.3 + 0.03 * noise.next();
        let place = [1e3 * x - 40.0, 1e3 * y + 7.0].map(|value| value + 0.05 * noise.next());
        writeln!(text, "{:.6},{angle:.4},{:.4},{:.4}", t + 2.0, place[0], place[1]).unwrap();
    }
    std::fs::write(folder.join("camera.csv"), text).unwrap();
    let told = done(
        &folder,
        &[
            "fit",
            "scene.toml",
            "camera.csv",
            "--out",
            "fitted",
            "--quiet",
            "--vary",
            "contact.feet.restitution=0..0.9",
            "beam.table.damping_ratio.ratio=0.005..0.2",
        ],
    );
    let found = read(&folder.join("fitted/fit.json"));
    let estimates = found["estimates"].as_array().unwrap();
    for (name, exact, within) in [
        ("contact.feet.restitution", 0.6, 0.02 * 0.6),
        ("beam.table.damping_ratio.ratio", 0.05, 0.02 * 0.05),
        ("time shift", -2.0, 5e-4),
        ("zero of the angle", 0.3_f64.to_radians(), 0.05_f64.to_radians()),
    ] {
        let estimate = estimates.iter().find(|estimate| estimate["name"] == name).unwrap();
        let value = estimate["value"].as_f64().unwrap();
        assert!((value - exact).abs() < within, "{name}: {value}\n{told}");
        // Five standard errors: the interval is neither far too narrow nor of no use.
        let error = estimate["standard_error"].as_f64().unwrap();
        assert!((value - exact).abs() < 5.0 * error && error < within, "{name}: {value} ± {error}");
        assert!(estimate["as_good"].is_null(), "{estimate}");
    }
    // The noise of samples is estimated from parabolas, and a bouncing motion is none within seven
    // frames: the estimate is too large, and what is left below one. A misfit would leave far more.
    let left = found["mean_square_over_noise"].as_f64().unwrap();
    assert!((0.3..1.5).contains(&left), "what is left is noise: {left}");
    // On the page each number has its unit, angles that of the figures; what isn't a key isn't set as one.
    let page = std::fs::read_to_string(folder.join("fitted/fit.html")).unwrap();
    let row = |name: &str| {
        let row = page
            .split(&format!("<tr><td data-of=\"Fitted\">{name}</td>"))
            .nth(1)
            .unwrap_or_else(|| panic!("{name}: {page}"));
        row.split("</tr>").next().unwrap().to_owned()
    };
    assert_eq!(row("zero of the angle").matches("°<").count(), 3, "{page}");
    assert_eq!(row("time shift").matches("\u{a0}s<").count(), 3, "{page}");
    row("<code>contact.<wbr>feet.<wbr>restitution</code>");
    // The scene's own motion is dashed, the fitted one isn't, and what was measured is pale.
    let figure = std::fs::read_to_string(folder.join("fitted/figures/phi.svg")).unwrap();
    assert!(figure.contains("stroke=\"#0050b0\" stroke-dasharray=\"5 2.5\""), "{figure}");
    assert!(
        figure.contains("stroke=\"#e05206\" stroke-dasharray=\"none\"") && figure.contains("stroke-opacity=\".5\"")
    );
    // The fitted scene runs, and moves as fitted.
    done(&folder, &["run", "fitted/scene.toml", "--out", "again", "--quiet"]);
    done(&folder, &["compare", "again", "camera.csv", "--out", "compared", "--quiet", "--offset", "0.3 deg"]);
    let compared = read(&folder.join("compared/compare.json"));
    assert!(compared["quantities"]["phi"]["rms_relative"].as_f64().unwrap() < 0.03, "{compared}");
}

#[test]
fn all_rows_up_to_the_horizon_of_the_fitted_values_count() {
    let folder = folder("horizon");
    std::fs::copy(scenario("free-rocking-on-beam.toml"), folder.join("scene.toml")).unwrap();
    // With the scene's own friction the motion is predictable up to 0.52 s, with the one sought all the
    // time, as the block slides off its edge.
    let end = ["--set", "time.end=0.65 s"];
    let truth = ["--set", "contact.feet.friction=0.1", "--set", "output.every=0.1 ms"];
    done(&folder, &[&["run", "scene.toml", "--out", "truth", "--quiet"], &truth[..], &end[..]].concat());
    let seen = frames(&folder.join("truth"), "rocker");
    let rows: String = seen.iter().map(|[t, .., phi]| format!("{t:.6},{phi:.5}\n")).collect();
    std::fs::write(folder.join("camera.csv"), format!("t,phi\n{rows}")).unwrap();
    let arguments = ["fit", "scene.toml", "camera.csv", "--out", "fitted", "--quiet", "--shift", "0 s", "--sign", "1"];
    let vary = ["--samples", "1", "--vary", "contact.feet.friction=0.05..0.9"];
    done(&folder, &[&arguments[..], &vary[..], &end[..]].concat());
    let found = read(&folder.join("fitted/fit.json"));
    let number = |name: &str| found[name].as_f64().unwrap();
    assert!((found["estimates"][0]["value"].as_f64().unwrap() / 0.1 - 1.0).abs() < 0.01, "{found}");
    let predictable = seen.iter().filter(|row| row[0] <= number("horizon")).count();
    assert!(number("horizon") > 0.64 && number("residuals") >= predictable as f64 - 1.0, "{found}");
}

#[test]
fn keys_that_trade_off_are_told() {
    let folder = folder("trade-off");
    let scene = std::fs::read_to_string(scenario("free-rocking-on-beam.toml")).unwrap();
    // A material of its own for the block: only the product of its density and depth matters.
    let scene = scene.replace(
        "[block.rocker]\nmaterial = \"aluminium\"",
        "[material.brass]\ndensity = \"2700 kg/m^3\"\n\n[block.rocker]\nmaterial = \"brass\"",
    );
    std::fs::write(folder.join("scene.toml"), scene).unwrap();
    done(
        &folder,
        &["run", "scene.toml", "--out", "truth", "--quiet", "--set", "output.every=0.1 ms", "--set", "time.end=0.3 s"],
    );
    let mut noise = Noise(4);
    let mut text = "t,phi [deg]\n".to_owned();
    for [t, .., phi] in frames(&folder.join("truth"), "rocker") {
        writeln!(text, "{t:.6},{:.4}", phi.to_degrees() + 0.02 * noise.next()).unwrap();
    }
    std::fs::write(folder.join("camera.csv"), text).unwrap();
    let told = done(
        &folder,
        &[
            "fit",
            "scene.toml",
            "camera.csv",
            "--out",
            "fitted",
            "--quiet",
            "--set",
            "time.end=0.3 s",
            "--sign",
            "1",
            "--samples",
            "12",
            "--vary",
            "block.rocker.depth=2 cm..4 cm",
            "material.brass.density=1800..4000 kg/m^3",
        ],
    );
    assert!(told.contains("block.rocker.depth and material.brass.density trade off (correlation -"), "{told}");
    assert!(told.contains("hardly determines block.rocker.depth"), "{told}");
    // The product is known all the same.
    let found = read(&folder.join("fitted/fit.json"));
    let value = |k: usize| found["estimates"][k]["value"].as_f64().unwrap();
    assert!((value(0) * value(1) / (3.0 * 2700.0) - 1.0).abs() < 0.05, "{found}");
}

/// On rigid ground the depth of a block doesn't matter for its motion.
#[test]
fn a_key_without_effect_leaves_the_others_known_and_a_wrong_held_key_is_told() {
    let folder = folder("no-effect");
    std::fs::copy(scenario("free-rocking-on-ground.toml"), folder.join("scene.toml")).unwrap();
    let end = ["--set", "time.end=0.3 s", "--quiet"];
    done(&folder, &[&["run", "scene.toml", "--out", "truth", "--set", "output.every=5 ms"], &end[..]].concat());
    let given = ["fit", "scene.toml", "truth/trajectory.csv", "--samples", "4", "--offset", "0 deg", "--vary"];
    let vary = ["block.rocker.height=12 cm..15 cm", "block.rocker.depth=2 cm..4 cm", "--out", "fitted"];
    let told = done(&folder, &[&given[..], &vary[..], &end[..]].concat());
    let found = read(&folder.join("fitted/fit.json"));
    let estimates = &found["estimates"];
    assert!(estimates[0]["standard_error"].as_f64().unwrap() < 0.01, "{found}");
    assert!((estimates[0]["value"].as_f64().unwrap() - 13.5).abs() < 0.01, "{found}");
    assert_eq!(estimates[1]["interval_95"], serde_json::json!([2.0, 4.0]), "within the bounds");
    assert!(told.contains("cm (all of its range, 2 to 4, 95 %)"), "{told}");
    assert!(told.contains("the motion doesn’t depend on block.rocker.depth"), "{told}");
    assert!(told.contains("fitted up to t = 0.300 s (the end of the run), 61 of 61 rows"), "{told}");
    assert!(!told.contains("don’t trust the intervals"), "{told}");
    assert_eq!(found["is_misfit"], false);
    let page = std::fs::read_to_string(folder.join("fitted/fit.html")).unwrap();
    assert!(page.contains("(found)") && !page.contains("(given)"), "{page}");
    let wrong = ["block.rocker.height=12 cm..15 cm", "--out", "wrong", "--set", "block.rocker.tilt=4.5 deg"];
    let told = done(&folder, &[&given[..], &wrong[..], &end[..]].concat());
    assert!(told.contains("don’t trust the intervals"), "{told}");
    assert_eq!(read(&folder.join("wrong/fit.json"))["is_misfit"], true);
}
