//! `teeter compare`.

use super::running::teeter;
use super::{Noise, done, folder, frames, read, scenario};
use std::fmt::Write;
use std::path::{Path, PathBuf};

#[test]
fn a_run_seen_from_behind_at_another_time_is_recognised() {
    let folder = folder("angle");
    let scene = scenario("free-rocking-on-beam.toml");
    done(&folder, &["run", &scene, "--out", "run", "--quiet", "--horizon", "--set", "output.every=0.1 ms"]);
    let mut noise = Noise(1);
    let mut text = "recorded by us\nTime (ms);\"Angle, left\" (deg);quality\n".to_owned();
    let sampled = frames(&folder.join("run"), "rocker");
    for (k, [t, .., phi]) in sampled.iter().enumerate() {
        let angle = -phi.to_degrees() + 0.4 + 0.03 * noise.next();
        let cell = if k == 50 { String::new() } else { format!("{angle:.4}").replace('.', ",") };
        writeln!(text, "{:.3};{cell};good", 1e3 * (t + 7.3)).unwrap();
    }
    std::fs::write(folder.join("camera.csv"), text).unwrap();
    let layout = "skip = 1\n[columns]\nt = \"Time\"\nphi = \"Angle, left\"\n";
    std::fs::write(folder.join("camera.toml"), layout).unwrap();
    let arguments = ["compare", "run", "camera.csv", "--columns", "camera.toml", "--offset", "0.4 deg", "--out", "all"];
    let told = done(&folder, &arguments);
    assert!(told.contains("impacts: 3 measured, 3 simulated, 3 paired"), "{told}");
    let found = read(&folder.join("all/compare.json"));
    assert_eq!(found["sign"], -1.0);
    assert!((found["time_shift"].as_f64().unwrap() + 7.3).abs() < 5e-4, "{found}");
    let phi = &found["quantities"]["phi"];
    let degrees = |name: &str| phi[name].as_f64().unwrap().to_degrees();
    // From some 20 windows that don't overlap, of two degrees of freedom each, by their median: known to
    // about 16 %; twice and a half that is allowed.
    assert!((degrees("noise") - 0.03).abs() < 0.012, "{phi}");
    // A parabola through five rows keeps 0.7 of the noise; smoothing is the same for both motions.
    assert!(degrees("rms") < 0.03 && degrees("max") < 0.12, "{phi}");
    let omega = &found["quantities"]["omega"];
    assert!(omega["measured"] == false && omega["rms_relative"].as_f64().unwrap() < 0.03, "{omega}");
    for pair in found["half_cycles"].as_array().unwrap() {
        assert!((pair["amplitude_ratio"].as_f64().unwrap() - 1.0).abs() < 0.03, "{pair}");
        assert!(pair["phase_degrees"].as_f64().is_none_or(|phase| phase.abs() < 2.0), "{pair}");
    }
    let rows = std::fs::read_to_string(folder.join("all/compare.csv")).unwrap();
    assert_eq!(rows.lines().count(), 1 + sampled.len());
    assert!(rows.starts_with("t,t_measured,phi_measured,phi_simulated,omega_measured,omega_simulated,compared\n"));
    let page = std::fs::read_to_string(folder.join("all/compare.html")).unwrap();
    // It begins with what was found, and has no marks of the terminal.
    let headline = page.split("<p class=\"headline\">").nth(1).unwrap().split("</p>").next().unwrap();
    assert!(headline.starts_with("Angle φ: root mean square difference 0.0"), "{headline}");
    assert!(headline.ends_with("; 3 impacts measured, 3 simulated"), "{headline}");
    assert!(!page.contains('`'), "{page}");
    // A ratio above 1 is never left without a word.
    let impacts = found["impacts"].as_array().unwrap().iter();
    let ratios = impacts.flat_map(|pair| ["measured", "simulated"].map(|name| pair[name]["omega_ratio"].as_f64()));
    let above = ratios.flatten().any(|ratio| ratio > 1.0);
    assert_eq!(page.contains("A ratio above 1 is no gain of energy"), above, "{found}");
    assert!(page.contains("<svg") && page.contains("Half-cycles") && !page.contains("http://www.w3.org/1999"));
    assert!(folder.join("all/figures/omega.svg").exists());
    let again = teeter(&folder, &arguments);
    assert_eq!(again.status.code(), Some(2), "results are not replaced without --force");
}

#[test]
fn markers_on_the_block_give_its_motion_and_a_wrong_model_shows() {
    let folder = folder("markers");
    let scene = scenario("free-rocking-on-beam.toml");
    done(&folder, &["run", &scene, "--out", "run", "--quiet", "--set", "output.every=0.1 ms"]);
    let mut noise = Noise(2);
    let mut text = String::new();
    let body = [[-0.01, 0.05], [0.012, 0.055], [0.0, -0.04]];
    for [_, x, y, phi] in frames(&folder.join("run"), "rocker") {
        let cells = body.map(|[a, b]| {
            let seen = [x + a * phi.cos() - b * phi.sin(), y + a * phi.sin() + b * phi.cos()];
            // Pixels of 0.2 mm from the upper left corner.
            let pixel = |value: f64, noise: &mut Noise| value / 2e-4 + 0.2 * noise.next();
            format!("{:.3} {:.3}", pixel(seen[0], &mut noise), 900.0 + pixel(-seen[1], &mut noise))
        });
        writeln!(text, "{}", cells.join("  ")).unwrap();
    }
    std::fs::write(folder.join("pixels.txt"), text).unwrap();
    let mut layout = "rate = \"165 Hz\"\ny_down = true\n".to_owned();
    for (k, [a, b]) in body.iter().enumerate() {
        writeln!(
            layout,
            "[marker.m{k}]\nx = {}\ny = {}\nunit = \"mm\"\nat = [\"{} mm\", \"{} mm\"]",
            2 * k + 1,
            2 * k + 2,
            5e3 * a,
            5e3 * b
        )
        .unwrap();
    }
    std::fs::write(folder.join("pixels.toml"), layout).unwrap();
    // A pixel counts as a millimetre: the body is five times as large, so positions can't match, but the
    // angle does.
    done(&folder, &["compare", "run", "pixels.txt", "--columns", "pixels.toml", "--out", "all"]);
    let found = read(&folder.join("all/compare.json"));
    assert!((found["time_shift"].as_f64().unwrap() + 0.1).abs() < 1e-3, "{found}");
    assert!(found["quantities"]["phi"]["rms"].as_f64().unwrap().to_degrees() < 0.15);
    let markers = &found["markers"];
    assert_eq!((markers["count"].as_u64(), markers["placed"].as_bool()), (Some(3), Some(true)));
    assert!((markers["rms"].as_f64().unwrap() - 2e-4).abs() < 1e-4, "0.2 pixels of noise: {markers}");
    // Let go from another angle it moves differently, and that shows.
    done(&folder, &["run", &scene, "--out", "other", "--quiet", "--set", "block.rocker.tilt=4 deg"]);
    done(
        &folder,
        &[
            "compare",
            "other",
            "pixels.txt",
            "--columns",
            "pixels.toml",
            "--out",
            "wrong",
            "--shift",
            "-0.1 s",
            "--sign",
            "1",
        ],
    );
    let wrong = read(&folder.join("wrong/compare.json"));
    assert!(wrong["quantities"]["phi"]["rms_relative"].as_f64().unwrap() > 0.1, "{wrong}");
}

#[test]
fn bad_measured_tables_are_refused_with_their_line() {
    let folder = folder("bad");
    let scene = scenario("free-rocking-on-ground.toml");
    done(&folder, &["run", &scene, "--out", "run", "--quiet", "--no-report", "--set", "time.end=0.2 s"]);
    let rows: String = (0..20).map(|k| format!("{},0.0{k}\n", 0.01 * f64::from(k))).collect();
    let twice: String = (0..20).map(|k| format!("{},0.0{k},0.1\n", 0.01 * f64::from(k))).collect();
    let tables: [(&str, Vec<u8>, &str); 14] = [
        ("empty", Vec::new(), "the file is empty"),
        ("comments", b"# a\n# b\n".to_vec(), "the file is empty"),
        ("binary", vec![0x89, b'P', b'N', b'G', 0xff], "not a text file in UTF-8"),
        ("nan", format!("t,phi\n{rows}0.5,nan\n").into_bytes(), "line 22: `nan` in column 2 (phi) is not a number"),
        ("word", format!("t,phi\n{rows}0.5,high\n").into_bytes(), "line 22: `high` in column 2 (phi) is not a number"),
        ("back", format!("t,phi\n{rows}0.1,0.1\n").into_bytes(), "line 22: t = 0.1 s is not after the row before"),
        ("one-row", b"t,phi\n0,0.1\n".to_vec(), "phi has 1 value, but a motion needs 8 or more"),
        ("ragged", format!("t,phi\n{rows}0.5\n").into_bytes(), "line 22: 1 column, but the rows before have 2"),
        ("unit", format!("t,phi [kg]\n{rows}").into_bytes(), "the unit `kg` of phi"),
        ("unnamed", rows.clone().into_bytes(), "the table has 2 columns without headings"),
        ("degrees", format!("t,phi\n{rows}0.5,5.0\n").into_bytes(), "--unit phi=deg"),
        (
            "twice",
            format!("t,phi,phi\n{twice}").into_bytes(),
            "2 columns are headed `phi`, 2 and 3: name one by its number",
        ),
        ("units", format!("t,phi [rad],phi [rad]\n{twice}").into_bytes(), "such as --column phi=2"),
        ("other", format!("t,angel\n{rows}").into_bytes(), "no column of the motion of `rocker` is known"),
    ];
    let refused = |arguments: &[&str], says: &str| {
        let output = teeter(&folder, arguments);
        let told = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {told}");
        assert!(told.contains(says) && !told.contains("panicked"), "{arguments:?}: {told}");
        assert!(!folder.join("run-compare").exists() && !folder.join("out").exists(), "{arguments:?} wrote something");
    };
    for (name, bytes, says) in &tables {
        let file = format!("{name}.csv");
        std::fs::write(folder.join(&file), bytes).unwrap();
        refused(&["compare", "run", &file], says);
        refused(&["fit", &scene, &file, "--out", "out", "--vary", "contact.feet.friction=0.2..0.9"], says);
    }
    std::fs::write(folder.join("good.csv"), format!("t,phi\n{rows}")).unwrap();
    std::fs::write(folder.join("layout.toml"), "sepparator = \";\"\n").unwrap();
    refused(&["compare", "run", "missing.csv"], "there is no such file");
    refused(&["compare", "run", "run"], "is a folder, not a file");
    refused(&["compare", "missing", "good.csv"], "there is no such folder");
    refused(&["compare", "run", "good.csv", "--columns", "layout.toml"], "did you mean `separator`?");
    refused(&["compare", "run", "good.csv", "--column", "fi=phi"], "there is no quantity `fi`");
    std::fs::write(folder.join("camera.csv"), "Frame time (s),phi\n0,0.1\n0.1,0.2\n").unwrap();
    refused(&["compare", "run", "camera.csv"], "if `Frame time` has them, --column t=\"Frame time\"");
    refused(&["compare", "run", "good.csv", "--block", "b"], "no block `b`; the run has `rocker`");
    refused(&["compare", "run", "good.csv", "--window", "4"], "an odd number of rows");
    refused(
        &["compare", "run", "good.csv", "--shift", "100.0000000001 s"],
        "fewer than 8 rows in common, with the time shift 100.00000 s",
    );
    let fit = |vary: &str, says: &str| refused(&["fit", &scene, "good.csv", "--out", "out", "--vary", vary], says);
    let still: String = (0..20).map(|k| format!("{},0.0{k},0\n", 0.01 * f64::from(k))).collect();
    std::fs::write(folder.join("still.csv"), format!("t,phi,x\n{still}")).unwrap();
    refused(
        &["fit", &scene, "still.csv", "--out", "out", "--vary", "contact.feet.friction=0.2..0.9"],
        "Position x is the same in all rows of the table",
    );
    fit("contact.feet.friction=0.9..0.2", "the lower bound of contact.feet.friction must be below the upper one");
    fit("contact.feet.friction=-1..0.2", "must be at least 0");
    fit("contact.feet.friction=-1..0.2", "--vary contact.feet.friction=-1..0.2");
    fit("block.rocker.height=-1 cm..2 cm", "--vary block.rocker.height=-1 cm..2 cm");
    fit("contact.feet.fricton=0.1..0.2", "did you mean `contact.feet.friction`?");
    fit("block.rocker.height=1 mm..2 cm", "have the units `mm` and `cm`");
    fit("contact.feet.friction", "write KEY=LOW..HIGH");
    refused(&["fit", "--vary", "contact.feet.friction=0.2..0.9", &scene, "good.csv"], "files come before --vary");
}

/// A table that stands tilted, one of a single column, and one that holds no motion.
#[test]
fn what_a_table_shows_beside_the_motion_is_told() {
    let folder = folder("beside");
    let scene = scenario("free-rocking-on-ground.toml");
    done(&folder, &["run", &scene, "--out", "run", "--quiet", "--no-report", "--set", "time.end=0.6 s"]);
    let frames = frames(&folder.join("run"), "rocker");
    let table = |name: &str, heading: &str, row: &dyn Fn(&[f64; 4]) -> String| {
        let rows: String = frames.iter().map(row).collect();
        std::fs::write(folder.join(name), format!("{heading}\n{rows}")).unwrap();
    };
    let compare = |arguments: &[&str]| {
        let output = teeter(&folder, &[&["compare", "run"], arguments, &["--force"]].concat());
        let told = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{arguments:?}: {told}");
        (String::from_utf8(output.stdout).unwrap(), told)
    };
    table("tilted.csv", "t,phi (deg),Force (N)", &|row| format!("{},{},3\n", row[0], row[3].to_degrees() + 0.3));
    let (text, told) = compare(&["tilted.csv"]);
    assert!(text.contains("the angles are apart by a constant, 0.3°"), "{text}");
    assert!(text.contains("with --offset \"0.300 deg\""), "{text}");
    assert!(told.contains("tilted.csv: not read: `Force (N)`; if one is needed, name it"), "{told}");
    let (text, _) = compare(&["tilted.csv", "--offset", "0.3 deg"]);
    assert!(!text.contains("apart by a constant"), "{text}");
    let (text, _) = compare(&["tilted.csv", "--offset", "0.3 deg", "--sign", "-1", "--shift", "0 s"]);
    assert!(!text.contains("apart by a constant"), "{text}");
    table("mirrored.csv", "t,phi", &|row| format!("{},{}\n", row[0], 0.3_f64.to_radians() - row[3]));
    let (text, told) = compare(&["mirrored.csv"]);
    assert!(text.contains("with --offset \"0.300 deg\"") && !told.contains("not read"), "{text}{told}");
    table("alone.csv", "phi [deg]", &|row| format!("{}\n", row[3].to_degrees()));
    let (text, _) = compare(&["alone.csv", "--rate", "165 Hz"]);
    assert!(text.contains("(found)") && !text.contains("hardly match"), "{text}");
    table("still.csv", "t,phi", &|row| format!("{},0.01\n", row[0]));
    let (text, _) = compare(&["still.csv"]);
    assert!(text.contains("the measured phi is the same in all rows") && !text.contains("outlier"), "{text}");
    table("drifting.csv", "t,phi", &|row| format!("{},{}\n", row[0], 1e-9 * row[0]));
    let (text, _) = compare(&["drifting.csv"]);
    assert!(text.contains("Angle φ: root mean square difference") && !text.contains("% of the largest"), "{text}");
    let noise = std::cell::RefCell::new(Noise(3));
    table("noise.csv", "t,phi", &|row| format!("{},{}\n", row[0], 1e-3 * noise.borrow_mut().next()));
    let (text, _) = compare(&["noise.csv"]);
    assert!(text.contains("the measured phi doesn’t rise above its noise"), "{text}");
}

/// The motion of a block on the ground as a camera sees it: 0.1 s at rest, then 0.6 s of rocking.
fn seen_on_ground(name: &str) -> (PathBuf, Vec<[f64; 4]>) {
    let folder = folder(name);
    let scene = scenario("free-rocking-on-ground.toml");
    done(&folder, &["run", &scene, "--out", "run", "--quiet", "--no-report", "--set", "time.end=0.6 s"]);
    let frames = frames(&folder.join("run"), "rocker");
    (folder, frames)
}

#[test]
fn an_offset_of_more_than_half_a_turn_is_refused() {
    for (command, offset, is_fine) in [
        ("compare", "400 deg", false),
        ("compare", "-181 deg", false),
        ("fit", "4 rad", false),
        ("compare", "-180 deg", true),
    ] {
        let output = teeter(Path::new("."), &[command, "none", "none.csv", "--offset", offset]);
        let told = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert_eq!(!told.contains("an angle from -180 deg to 180 deg is expected"), is_fine, "{offset}: {told}");
    }
}

#[test]
fn the_offset_that_is_told_is_that_of_the_rows_for_which_it_promises() {
    let (folder, frames) = seen_on_ground("promise");
    // The held block stood 0.6° off, and moved 0.2° off.
    let rows: String = frames
        .iter()
        .map(|row| format!("{},{}\n", row[0], row[3].to_degrees() + if row[0] < 0.0 { 0.6 } else { 0.2 }))
        .collect();
    std::fs::write(folder.join("off.csv"), format!("t,phi (deg)\n{rows}")).unwrap();
    let compare = |more: &[&str]| {
        let arguments = [&["compare", "run", "off.csv", "--force"], more].concat();
        let text = done(&folder, &arguments);
        let found = read(&folder.join("run-compare/compare.json"));
        (text, found["quantities"]["phi"]["rms"].as_f64().unwrap().to_degrees())
    };
    let (text, _) = compare(&[]);
    // Two rows about t = 0 are smoothed over both.
    assert!(text.contains("apart by a constant, −0.2°, but before the release by −0.6°"), "{text}");
    let after = |words: &str, end: char| text.split(words).nth(1).unwrap().split(end).next().unwrap().to_owned();
    let (offset, promised) = (after("with --offset \"", '"'), after("root mean square difference would be ", '°'));
    let (_, rms) = compare(&["--offset", &offset]);
    // Told to two digits.
    assert!((rms / promised.parse::<f64>().unwrap() - 1.0).abs() < 0.06, "{rms}°, not {promised}°: {text}");
    let (held, seen): (Vec<_>, Vec<_>) = rows.lines().partition(|row| row.starts_with('-'));
    std::fs::write(folder.join("off.csv"), format!("t,phi (deg)\n{}\n{}\n", held[held.len() - 1], seen.join("\n")))
        .unwrap();
    let (text, _) = compare(&["--shift", "0 s"]);
    assert!(text.contains("1 more row counts for the alignment"), "{text}");
    assert!(!text.contains(" °"), "{text}");
}

#[test]
fn lost_angles_are_not_compared() {
    let (folder, frames) = seen_on_ground("lost");
    let phi = |k: usize, phi: f64| if k.is_multiple_of(3) { String::new() } else { format!("{phi}") };
    let rows: String =
        frames.iter().enumerate().map(|(k, row)| format!("{},{},{}\n", row[0], row[1], phi(k, row[3]))).collect();
    std::fs::write(folder.join("x.csv"), format!("t,x,phi\n{rows}")).unwrap();
    let text = done(&folder, &["compare", "run", "x.csv"]);
    let found = read(&folder.join("run-compare/compare.json"));
    let [x, phi] = ["x", "phi"].map(|name| found["quantities"][name]["rows"].as_u64().unwrap());
    assert!(found["compared"]["rows"] == x && x * 6 / 10 < phi && phi < x * 7 / 10, "{x} {phi}");
    assert!(text.contains(&format!("measured rows are compared (phi in {phi} of them)")), "{text}");
    // Without x these rows have nothing to compare.
    let rows: String = frames
        .iter()
        .enumerate()
        .map(|(k, row)| {
            format!("{},{}\n", row[0], if k.is_multiple_of(3) { String::new() } else { format!("{}", row[3]) })
        })
        .collect();
    std::fs::write(folder.join("phi.csv"), format!("t,phi\n{rows}")).unwrap();
    let text = done(&folder, &["compare", "run", "phi.csv", "--force"]);
    assert_eq!(read(&folder.join("run-compare/compare.json"))["compared"]["rows"], phi, "{text}");
    let rows = std::fs::read_to_string(folder.join("run-compare/compare.csv")).unwrap();
    assert_eq!(rows.matches(",yes\n").count() as u64, phi);
}

#[test]
fn frames_that_are_wrong_are_named_and_move_no_alignment() {
    let (folder, frames) = seen_on_ground("outliers");
    let mut noise = Noise(4);
    let rows: String = frames
        .iter()
        .enumerate()
        .map(|(k, row)| {
            let wrong = if [40, 41, 60, 90].contains(&k) { 150.0 } else { 0.0 };
            format!("{},{:.3}\n", row[0] + 3.0, row[3].to_degrees() + 0.01 * noise.next() + wrong)
        })
        .collect();
    std::fs::write(folder.join("wrong.csv"), format!("made by us\nt,phi (deg)\n{rows}")).unwrap();
    let compare = |more: &[&str]| {
        let text = done(&folder, &[&["compare", "run", "wrong.csv", "--skip", "1", "--force"], more].concat());
        (text, read(&folder.join("run-compare/compare.json")))
    };
    let (text, found) = compare(&[]);
    assert!(text.contains("warning: outliers in lines 43, 44, 63, 93 of the table"), "{text}");
    assert!(text.contains("--leave-out 43,44,63,93"), "{text}");
    assert!((found["time_shift"].as_f64().unwrap() + 3.0).abs() < 5e-4, "{text}");
    assert_eq!(found["outlier_lines"], serde_json::json!([43, 44, 63, 93]));
    assert!(!text.contains("hardly match"), "the other rows match: {text}");
    let (text, found) = compare(&["--leave-out", "43-44, 63,93"]);
    assert!(!text.contains("outliers") && found["outlier_lines"] == serde_json::json!([]), "{text}");
    let rms = found["quantities"]["phi"]["rms"].as_f64().unwrap().to_degrees();
    assert!(rms < 0.02, "{rms}");
    let missing = teeter(&folder, &["compare", "run", "wrong.csv", "--skip", "1", "--force", "--leave-out", "1"]);
    let told = String::from_utf8(missing.stderr).unwrap();
    assert!(told.contains("line 1: to be left out, but there is no row of numbers"), "{told}");
}

#[test]
fn a_flat_fall_is_aligned_by_its_height_and_wrong_units_are_guessed() {
    let folder = folder("fall");
    let scene = scenario("drop.toml");
    done(&folder, &["run", &scene, "--out", "run", "--quiet", "--no-report"]);
    let frames = frames(&folder.join("run"), "cube");
    let mut noise = Noise(9);
    let rows: String = frames
        .iter()
        .map(|[t, _, y, phi]| {
            format!("{},{:.3},{:.3}\n", t + 2.0, phi.to_degrees() + 0.03 * noise.next(), 1e3 * y + 0.1 * noise.next())
        })
        .collect();
    std::fs::write(folder.join("fall.csv"), format!("t,phi (deg),y (mm)\n{rows}")).unwrap();
    let text = done(&folder, &["compare", "run", "fall.csv"]);
    let found = read(&folder.join("run-compare/compare.json"));
    assert_eq!((found["aligned_by"].as_str(), found["sign_found"].as_bool()), (Some("y"), Some(false)));
    assert!((found["time_shift"].as_f64().unwrap() + 2.0).abs() < 1e-3, "{text}");
    assert!(text.contains("they are aligned by y, as the measured phi hardly rises above its noise"), "{text}");
    assert!(
        text.contains("(assumed: no quantity that would tell the side") && !text.contains("hardly match"),
        "{text}"
    );
    // A fit chooses the side as a comparison does, and says how.
    let varied = ["--vary", "contact.base.restitution=0.7..0.9", "--samples", "4", "--out", "fitted", "--force"];
    for (sign, origin) in [(&[][..], "(assumed: no quantity that would tell the side"), (&["--sign", "1"], "(given)")] {
        let text = done(&folder, &[&["fit", &scene, "fall.csv"], &varied[..], sign].concat());
        assert!(text.contains("seen as in the scene") && text.contains(origin), "{text}");
    }
    // A run that turns, matched by its height: the angles are apart, and by no constant.
    done(&folder, &["run", &scene, "--out", "turned", "--quiet", "--no-report", "--set", "block.cube.angle=2 deg"]);
    let text = done(&folder, &["compare", "turned", "fall.csv"]);
    assert!(text.contains("aligned by y") && !text.contains("apart by a constant"), "{text}");
    let rows: String = frames.iter().map(|row| format!("{},{}\n", 1e3 * row[0], row[2])).collect();
    std::fs::write(folder.join("ms.csv"), format!("t,y\n{rows}")).unwrap();
    let told = String::from_utf8(teeter(&folder, &["compare", "run", "ms.csv", "--force"]).stderr).unwrap();
    let text = done(&folder, &["compare", "run", "ms.csv", "--unit", "t=ms", "--force"]);
    assert!(text.contains("impacts: not looked for, as the table has no angle (phi)"), "{text}");
    // The middle row, the only one with a complete window, is of the time before the release.
    let rows = rows.lines().count();
    let wide = format!("--window={}", if rows % 2 == 1 { rows } else { rows - 1 });
    let early = ["--unit", "t=ms", "--shift", "-0.8 s", "--sign", "1", "--force", &wide];
    let text = done(&folder, &[&["compare", "run", "ms.csv"], &early[..]].concat());
    assert!(
        text.contains("warning: vy is not compared: no row that counts has a complete window in both motions"),
        "{text}"
    );
    assert!(told.contains("if the times are in milliseconds, say so: --unit t=ms"), "{told}");
}

/// A run of very many blocks has a row for each instead of columns, and one whose scene chooses blocks tells of the others by which key they
/// have no columns.
#[test]
fn blocks_without_columns_are_read_from_rows_or_told() {
    let folder = folder("rows");
    let number = |k: u32| 0.01 * f64::from(k);
    let angle = |k: u32| 1e-3 * f64::from(k * k);
    let measured: String = (0..20).map(|k| format!("{:?},{:?}\n", number(k), angle(k))).collect();
    std::fs::write(folder.join("measured.csv"), format!("t,phi\n{measured}")).unwrap();
    let verdict = r#"{"title": "Two", "verdict": [{"body": "a"}, {"body": "b"}]}"#;
    let of = |k: u32, name: &str| format!("{name}0.0,0.0,{:?},0.0,0.0,{:?}", angle(k), 0.2 * f64::from(k));
    let (mut rows, mut columns) = (String::new(), String::new());
    for k in 0..40 {
        let t = number(k);
        rows += &format!("{t:?},{}\n{t:?},{}\n", of(0, "a,"), of(k, "b,"));
        columns += &format!("{t:?},{}\n", of(k, ""));
    }
    for (run, table, text) in [
        ("many", "blocks.csv", format!("t,block,x,y,phi,vx,vy,omega\n{rows}")),
        ("chosen", "trajectory.csv", format!("t,a.x,a.y,a.phi,a.vx,a.vy,a.omega\n{columns}")),
    ] {
        std::fs::create_dir_all(folder.join(run)).unwrap();
        std::fs::write(folder.join(run).join("trajectory.csv"), "t\n0.0\n0.01\n").unwrap();
        std::fs::write(folder.join(run).join(table), text).unwrap();
        std::fs::write(folder.join(run).join("summary.json"), verdict).unwrap();
    }
    done(&folder, &["compare", "many", "measured.csv", "--block", "b"]);
    let found = read(&folder.join("many-compare/compare.json"));
    assert_eq!(found["block"], "b");
    let told = |arguments: &[&str]| {
        let output = teeter(&folder, arguments);
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8(output.stderr).unwrap()
    };
    let hint = "its scene chooses the blocks that have columns, with `blocks` in [output]";
    let missing = told(&["compare", "chosen", "measured.csv", "--block", "b"]);
    assert!(missing.contains("no block `b`; the run has `a`") && missing.contains(hint), "{missing}");
    let unknown = told(&["compare", "chosen", "measured.csv", "--block", "c"]);
    assert!(unknown.contains("no block `c`") && !unknown.contains(hint), "{unknown}");
}
