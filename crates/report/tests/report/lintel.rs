//! The page of a beam that no support holds: it lies on two columns, and a stone falls on it.

use crate::page::{data, numbers, panel, run};
use crate::plots::table;
use crate::unlocated::lintel;

#[test]
fn a_beam_on_columns_bends_from_the_line_through_its_ends_and_nothing_on_it_rocks_as_on_rigid_ground() {
    let run = run("lintel", &lintel("moreau-jean-located"));
    let deflection = panel(&data(&run.html), "w_mid").unwrap().clone();
    assert_eq!(deflection["note"], "measured from the line through the ends of the beam");
    let series = deflection["series"].as_array().unwrap();
    assert!(series.iter().all(|line| !line["label"].as_str().unwrap().contains("free end")), "no places of their own");
    assert!(!run.html.contains("Housner"), "columns carry a beam, and the stone lies on one that columns carry");
    // The columns hardly move beside the stone: their curves lie on zero, which is told with their size.
    let note = panel(&data(&run.html), "x").unwrap()["note"].as_str().unwrap().to_owned();
    assert!(note.starts_with("too small to be seen here: left (up to ") && note.contains(", right (up to "), "{note}");
    // The sentence at the head doesn't stand beside a warning against it as if that were not there.
    assert!(run.html.contains("data-warning=\"under-resolved\""));
    let head = &run.html[run.html.find("id=\"verdict\"").unwrap()..];
    assert!(head[..head.find("</p>").unwrap()].contains("; see the warnings"));
    let warning = run.summary.warnings.iter().find(|warning| warning.code == "under-resolved").unwrap();
    assert!(!warning.text.contains("all together") && !warning.text.contains("  "), "{}", warning.text);
    // A line says what they are about; what they say at length is folded below it.
    let warnings = run.html.split_once("<section id=\"warnings\"").unwrap().1.split_once("</section>").unwrap().0;
    let (line, folded) = warnings.split_once("</summary>").unwrap();
    for warning in &run.summary.warnings {
        assert!(line.contains(warning.subject().as_ref()) && warning.subject() != warning.code, "{}", warning.code);
    }
    assert!(line.len() < 400 && !line.contains("take a step of at most") && folded.contains("take a step of at most"));
}

/// At the pictures, whose values are of one time, as are the rows of the trajectory: with deflections of both ends there.
#[test]
fn a_deflection_from_the_line_through_the_ends_is_that_of_the_trajectory_less_the_line() {
    let text = lintel("moreau-jean").replace("[\"40 cm\", \"80 cm\"]", "[\"0 m\", \"80 cm\", \"1.6 m\"]");
    let run = run("lintel-line", &format!("{text}\n[output]\nevery = '50 us'\n"));
    let page = data(&run.html);
    let deflection = panel(&page, "w_mid").unwrap();
    assert_eq!(deflection["unit"], "mm");
    let series = &deflection["series"][0];
    let (at, others) = (numbers(&series["other_at"]), numbers(&series["others"]));
    let t = numbers(&page["frames"]["t"]);
    let trajectory = table(&run.folder.join("trajectory.csv"));
    let of = |name: &str| &trajectory.iter().find(|(column, _)| column == name).unwrap().1;
    let (times, w) = (of("t"), of("lintel.w_mid"));
    let (left, right) = (of("lintel.w@0"), of("lintel.w@1.6"));
    let mut picture = 0;
    let mut most: f64 = 0.0;
    for (at, other) in at.iter().zip(&others) {
        picture += *at as usize;
        let row = times.iter().position(|time| (time - t[picture]).abs() < 1e-9).unwrap();
        let line = 0.5 * (left[row] + right[row]);
        most = most.max(1e3 * line.abs());
        // Sent in a few digits.
        assert!((other - 1e3 * (w[row] - line)).abs() < 1e-3, "{other} at {}", t[picture]);
    }
    assert!(others.len() > 50 && most > 0.1, "{} values, the line at {most} mm", others.len());
}

/// A foundation carries a beam with free ends: it sinks into it as a whole, which is what is asked for.
#[test]
fn a_beam_on_a_foundation_is_drawn_with_all_of_its_deflection() {
    let text = "[time]\nend = '20 ms'\nstep = '100 us'\n[material.s]\ndensity = '2400 kg/m^3'\nyoungs_modulus = '1 GPa'\n\
        [beam.t]\nmaterial = 's'\nspan = '2 m'\nwidth = '10 cm'\nthickness = '3 cm'\nelements = 20\n\
        supports = ['free', 'free']\n[beam.t.foundation.soil]\nstiffness = '1 MPa'\n\
        [load.l]\non = 't'\nat = '1 m'\nforce = '-1000 N'\n";
    let run = run("founded", text);
    let page = data(&run.html);
    let deflection = panel(&page, "w_mid").unwrap();
    assert!(deflection["note"].is_null(), "{}", deflection["note"]);
    let labels: Vec<&str> =
        deflection["series"].as_array().unwrap().iter().map(|line| line["label"].as_str().unwrap()).collect();
    assert!(labels.iter().any(|label| label.starts_with("free end")), "{labels:?}");
}
