//! `teeter record`: the numbers of accelerograms, and what is refused.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // a test

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("record-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn record(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_teeter")).current_dir(folder).arg("record").args(arguments).output().unwrap()
}

fn json(folder: &Path, arguments: &[&str]) -> Value {
    let output = record(folder, &[arguments, &["--json"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

const TABLE: &str = "0,0.5\n0.5,-2\n1,3\n1.5,1\n2,0.25\n";

#[test]
fn peaks_and_arias_intensities_of_recorded_earthquakes_are_those_of_their_table() {
    let records = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/records");
    let Ok(table) = std::fs::read_to_string(records.join("records.csv")) else {
        println!("skipped: there is no {}", records.display());
        return;
    };
    let mut count = 0;
    for line in table.lines().skip(1) {
        let file = line.split(',').next().unwrap();
        let numbers: Vec<f64> = line.rsplit(',').take(4).map(|cell| cell.parse().unwrap()).collect();
        let [arias, peak, step, values] = numbers[..] else { unreachable!() };
        let held = json(&records, &[file]);
        let number = |key: &str| held[key].as_f64().unwrap();
        assert_eq!((number("values"), number("step")), (values, step), "{file}");
        // The table has seven digits of the peak and ten of the intensity.
        assert!((number("peak_acceleration_gn") - peak).abs() <= 0.500001e-7, "{file}");
        assert!((number("arias_sum") - arias).abs() <= 1e-9, "{file}: {} {arias}", number("arias_sum"));
        count += 1;
    }
    assert_eq!(count, 40);
}

#[test]
fn corrections_are_those_of_a_scene() {
    let folder = folder("corrections");
    std::fs::write(folder.join("a.csv"), TABLE).unwrap();
    let keys = ["--unit", "gal", "--from", "0.5 s", "--baseline", "mean", "--peak", "0.3 gn"];
    let held = json(&folder, &[&["a.csv"][..], &keys].concat());
    let scene = "[time]\nend = '1 s'\nstep = '1 ms'\n[material.m]\ndensity = '1000 kg/m^3'\n[ground]\n\
        motion.x = { record = 'a.csv', unit = 'gal', from = '0.5 s', baseline = 'mean', peak = '0.3 gn' }\n\
        [block.b]\nmaterial = 'm'\nwidth = '20 cm'\nheight = '5 cm'\ndepth = '5 cm'\non = 'ground'\nat = '0 m'\n\
        [contact.f]\nbetween = ['b', 'ground']\nfriction = 0.9\n";
    std::fs::write(folder.join("scene.toml"), scene).unwrap();
    let run = Command::new(env!("CARGO_BIN_EXE_teeter"))
        .current_dir(&folder)
        .args(["run", "scene.toml", "--out", "out", "--quiet", "--no-report"])
        .output()
        .unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let summary: Value = serde_json::from_slice(&std::fs::read(folder.join("out/summary.json")).unwrap()).unwrap();
    let used = summary["records"][0].as_object().unwrap();
    // Of the record alone nothing is run.
    let of_run = ["motion", "file", "peak_acceleration_in_run"];
    for (key, value) in used.iter().filter(|(key, _)| !of_run.contains(&key.as_str())) {
        assert_eq!(&held[key], value, "{key}");
    }
    assert_eq!(held["corrections"]["baseline"], "mean");
    assert!((held["peak_acceleration_gn"].as_f64().unwrap() - 0.3).abs() < 1e-15);
}

#[test]
fn a_page_and_figures_are_written_where_asked_and_not_overwritten() {
    let folder = folder("page");
    std::fs::write(folder.join("a.csv"), TABLE).unwrap();
    let printed = record(&folder, &["a.csv", "--out", "held"]);
    assert!(printed.status.success(), "{}", String::from_utf8_lossy(&printed.stderr));
    let text = String::from_utf8(printed.stdout).unwrap();
    assert!(text.contains("peak acceleration     3 m/s^2"), "{text}");
    assert!(text.contains("m/s^2, as the file names none; --unit gives another"), "{text}");
    let part = |arguments: &[&str]| String::from_utf8(record(&folder, arguments).stdout).unwrap();
    let past = part(&["a.csv", "--from", "0.5 s", "--to", "9 s", "--unit", "gal"]);
    assert!(
        past.contains("part used             500 ms to 2 s, where the record ends") && !past.contains("--unit"),
        "{past}"
    );
    let between = part(&["a.csv", "--from", "0.7 s"]);
    assert!(between.contains("1 s to 2 s: the values between these times, as none is interpolated"), "{between}");
    for file in ["record.json", "record.csv", "record.html", "figures/records.svg", "figures/spectra.svg"] {
        assert!(folder.join("held").join(file).is_file(), "{file}");
    }
    let page = std::fs::read_to_string(folder.join("held/record.html")).unwrap();
    for told in ["<h1>a.csv</h1>", "Time of the peak acceleration", "Displacement at the end", "The record drifts"] {
        assert!(page.contains(told), "{told}: {page}");
    }
    let motion = std::fs::read_to_string(folder.join("held/record.csv")).unwrap();
    let second: Vec<f64> = motion.lines().nth(2).unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
    // a falls from 0.5 to -2 in half a second: v = ½h(a₀ + a₁), d = h²(2a₀ + a₁)/6.
    assert_eq!(second[..3], [0.5, -2.0, -0.375]);
    assert!((second[3] + 1.0 / 24.0).abs() < 1e-16, "{second:?}");
    assert_eq!(record(&folder, &["a.csv", "--out", "held"]).status.code(), Some(2));
    assert!(record(&folder, &["a.csv", "--out", "held", "--force"]).status.success());
}

#[test]
fn what_is_refused_is_told_with_the_key_and_a_remedy() {
    let folder = folder("refused");
    std::fs::write(folder.join("a.csv"), TABLE).unwrap();
    std::fs::write(folder.join("values.csv"), "1\n2\n").unwrap();
    std::fs::write(folder.join("three.csv"), "t [s],NS [gal],EW [gal]\n0,1,2\n0.1,2,3\n").unwrap();
    std::fs::write(folder.join("plain.csv"), "time_s,acc_g\n0,1\n0.1,2\n").unwrap();
    std::fs::write(folder.join("picture.png"), b"\x89PNG\0\r\n\x1a\n\0\0\0\rIHDR").unwrap();
    std::fs::write(folder.join("down.csv"), "1,1\n0.5,2\n0,1\n").unwrap();
    for (arguments, says) in [
        (&["none.at2"][..], &["none.at2", "can't be read"][..]),
        (&["."], &["is a folder"]),
        (&["values.csv"], &["values.csv", "the step must be given", "add --step \"10 ms\""]),
        (&["values.csv", "--step", "10"], &["step = 10: a time needs its unit"]),
        (&["values.csv", "--step", "10 m"], &["step = \"10 m\"", "a time (s) is expected, got a length (m)"]),
        (&["picture.png"], &["picture.png", "not a text file: byte 4 is 0x00"]),
        (&["a.csv", "--taper", "0.7"], &["taper = 0.7", "[0, 0.5]"]),
        (&["a.csv", "--baseline", "straight"], &["baseline = \"straight\"", "quintic"]),
        (&["a.csv", "--peak", "0.4"], &["peak = 0.4", "m/s^2"]),
        (&["a.csv", "--peak", "0.4 gn", "--scale", "2"], &["scale and peak both scale the record"]),
        (&["a.csv", "--arias", "-1 m/s"], &["arias"]),
        (&["a.csv", "--spectral-acceleration", "1 gn"], &["of which natural period?", "add --period \"0.5 s\""]),
        (&["a.csv", "--period", "1 s"], &["no spectral_acceleration is given"]),
        (&["three.csv"], &["ns (column 2), ew (column 3)", "such as --component \"NAME\""]),
        (&["plain.csv"], &["is `g` in the heading `acc_g` a unit?", "--unit \"m/s^2\""]),
        (&["down.csv"], &["the times descend, from 1 s to 0.5 s"]),
        (&["a.csv", "--from", "9 s"], &["fewer than two values", "0 s to 2 s"]),
    ] {
        let output = record(&folder, arguments);
        let told = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {told}");
        says.iter().for_each(|part| assert!(told.contains(part), "{arguments:?}: «{part}» is missing in\n{told}"));
        assert!(!told.contains("ground.motion"), "{told}");
        assert_eq!(told.matches("error:").count(), 1, "one mistake is told once: {told}");
        assert!(output.stdout.is_empty());
    }
}
