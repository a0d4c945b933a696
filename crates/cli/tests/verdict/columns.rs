//! Blocks that stand on each other and turn as one.

use super::{folder, written};
use std::process::Command;

/// Three stones on each other, shaken by a pulse: their common point of no return is at atan(14/60), a single stone's at atan(14/20).
const STONES: &str = "[time]\nend = '2 s'\nstep = '500 us'\n[signal.pulse]\nshape = 'one-sine'\nfrequency = '1.6 Hz'\nstart = '0.2 s'\n\
    [ground]\nmotion = { acceleration = ['3.4 m/s^2', '0 m/s^2'], signal = 'pulse' }\n[material.stone]\ndensity = '2400 kg/m^3'\n\
    [block.stone]\nmaterial = 'stone'\nwidth = '14 cm'\nheight = '20 cm'\ndepth = '14 cm'\non = 'ground'\nat = '75 cm'\n\
    repeat = { count = 3, stacked = true }\n[contact.base]\nbetween = ['stone-*', 'ground']\nfriction = 0.7\n\
    [contact.joints]\nbetween = ['stone-*', 'stone-*']\nfriction = 0.7\n";

#[test]
fn a_column_overturns_as_its_rows_pass_its_own_critical_angle_which_the_plots_show() {
    let folder = folder("verdict-column");
    let ran = written(&folder, STONES);
    let alpha = (14.0_f64 / 60.0).atan();
    let (t, phi) = (ran.column("t"), ran.column("stone-1.phi"));
    let row = phi.iter().position(|phi| phi.abs() > alpha).unwrap();
    for name in ["stone-1", "stone-2", "stone-3"] {
        let at = ran.verdict(name)["overturned_at"].as_f64().unwrap();
        assert!(t[row - 1] - 1e-9 <= at && at <= t[row] + 1e-4, "{name}: {at}, {} to {}", t[row - 1], t[row]);
    }
    let file = folder.join("column.toml");
    std::fs::write(&file, STONES).unwrap();
    let out = folder.join("with-page");
    let output =
        Command::new(env!("CARGO_BIN_EXE_teeter")).args(["run", "--out"]).arg(&out).arg(&file).output().unwrap();
    assert!(output.status.success());
    let html = std::fs::read_to_string(out.join("report.html")).unwrap();
    let lines: Vec<f64> = html
        .split("\"guides\":[")
        .skip(1)
        .filter_map(|rest| rest.split_once(']'))
        .flat_map(|(lines, _)| lines.split(',').filter_map(|line| line.parse().ok()).collect::<Vec<f64>>())
        .collect();
    assert!(!lines.is_empty() && lines.iter().all(|line| (line.abs() - alpha.to_degrees()).abs() < 0.1), "{lines:?}");
}

/// Joints open on the way, so that the column counts as one again only when it has turned twice as far: it was past the common point of no return long
/// before.
#[test]
fn a_column_whose_joints_opened_overturns_where_all_of_it_passed_its_point_of_no_return() {
    let drums = "[time]\nend = '3 s'\nstep = '1 ms'\n[ground]\nmotion = { acceleration = ['3.6 m/s^2', '0 m/s^2'], signal = 'shake' }\n\
        [signal.shake]\nshape = 'one-sine'\nstart = '0.2 s'\nperiod = '1.3 s'\n[material.marble]\ndensity = '2700 kg/m^3'\n[block.drum]\n\
        material = 'marble'\nwidth = '1 m'\nheight = '1 m'\ndepth = '1 m'\non = 'ground'\nat = '0 m'\n\
        repeat = { count = 5, stacked = true }\n[contact.floor]\nbetween = ['*', 'ground']\nfriction = 0.7\n[contact.joints]\n\
        between = ['*', '*']\nfriction = 0.7\n[solver]\ntolerance = 1e-9\n";
    let ran = written(&folder("verdict-drums"), drums);
    let (t, phi) = (ran.column("t"), ran.column("drum-1.phi"));
    let alpha = 0.2_f64.atan();
    // The last time that it passes it; the drums above are turned by less than half a degree more.
    let row = phi.iter().rposition(|phi| phi.abs() < alpha).unwrap();
    let at = ran.summary["overturned_at"].as_f64().unwrap();
    assert!((at - t[row]).abs() < 0.03, "{at} s, past it at {} s", t[row]);
}
