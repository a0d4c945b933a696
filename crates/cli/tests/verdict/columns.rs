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

/// A stack of five that turns over as one after its joints opened on the way, by more than a fiftieth of what it then turns; with two accelerations of the
/// ground, the upper four were a column by then, or none were.
#[test]
fn a_stack_that_turns_over_in_one_goes_as_one_column() {
    for acceleration in ["3.6 m/s^2", "4 m/s^2"] {
        let text = format!(
            "[time]\nend = '3 s'\nstep = '1 ms'\n[ground]\nmotion = {{ acceleration = ['{acceleration}', '0 m/s^2'], signal = 'shake' }}\n\
             [signal.shake]\nshape = 'one-sine'\nstart = '0.2 s'\nperiod = '1.1 s'\n[material.marble]\ndensity = '2700 kg/m^3'\n[block.d]\n\
             material = 'marble'\nwidth = '50 cm'\nheight = '60 cm'\ndepth = '50 cm'\non = 'ground'\nat = '0 m'\n\
             repeat = {{ count = 5, stacked = true }}\n[contact.floor]\nbetween = ['*', 'ground']\nfriction = 0.7\n[contact.joints]\n\
             between = ['*', '*']\nfriction = 0.7\n"
        );
        let ran = written(&folder(&format!("verdict-five-{}", &acceleration[..1])), &text);
        let (t, alpha) = (ran.column("t"), (0.5_f64 / 3.0).atan());
        let phi: Vec<Vec<f64>> = (1..=5).map(|k| ran.column(&format!("d-{k}.phi"))).collect();
        // Since then they turn by the same, to a tenth of a degree.
        let row = phi[0].iter().rposition(|phi| phi.abs() < 1.2 * alpha).unwrap();
        let near = |k: usize| (0..5).all(|of| (phi[of][k] - phi[0][k]).abs() < 2e-3);
        assert!(near(row) && near(row + 300), "{acceleration}");
        let headline = ran.summary["headline"].as_str().unwrap();
        assert!(
            headline.starts_with("all 5 blocks overturned as one column on the base of `d-1` to the right at t = "),
            "{acceleration}: {headline}"
        );
        let passed = t[phi[0].iter().rposition(|phi| phi.abs() < alpha).unwrap()];
        let told = ran.summary["overturned_at"].as_f64().unwrap();
        assert!((told - passed).abs() < 0.03, "{acceleration}: {told}, {passed}");
    }
}

#[test]
fn parts_of_a_stack_that_turn_over_one_after_the_other_are_told_in_that_order() {
    let block = |name: &str, width: u32, rest: &str| {
        format!(
            "[block.{name}]\nmaterial = 'm'\nwidth = '{width} cm'\nheight = '60 cm'\ndepth = '50 cm'\nat = '0 m'\n{rest}\n"
        )
    };
    let text = format!(
        "[time]\nend = '3 s'\nstep = '1 ms'\n[ground]\nmotion = {{ acceleration = ['6 m/s^2', '0 m/s^2'], signal = 'shake' }}\n\
         [signal.shake]\nshape = 'one-sine'\nstart = '0.2 s'\nperiod = '0.9 s'\n[material.m]\ndensity = '2700 kg/m^3'\n{}{}{}\
         [contact.floor]\nbetween = ['*', 'ground']\nfriction = 0.7\n[contact.joints]\nbetween = ['*', '*']\nfriction = 0.7\n",
        block("d", 50, "on = 'ground'\nrepeat = { count = 3, stacked = true }"),
        block("u", 32, "on = 'd-3'"),
        block("v", 32, "on = 'u'")
    );
    let ran = written(&folder("verdict-two-parts"), &text);
    let (t, u) = (ran.column("t"), ran.column("u.phi"));
    // Two of 60 cm on each other.
    let alpha = (0.32_f64 / 1.2).atan();
    let passed = t[u.iter().rposition(|phi| *phi < alpha).unwrap()];
    let at = ran.verdict("u")["overturned_at"].as_f64().unwrap();
    assert!((at - passed).abs() < 0.03, "{at}, {passed}");
    let headline = ran.summary["headline"].as_str().unwrap();
    let (first, second) = headline.split_once("; ").unwrap();
    assert!(
        first.starts_with("2 of 5 blocks overturned as one column on the base of `u` to the left at t = "),
        "{headline}"
    );
    assert!(second.starts_with("3 overturned as one column on the base of `d-1` to the right at t = "), "{headline}");
}
