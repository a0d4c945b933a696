//! The page of a beam that no support holds: it lies on two columns, and a stone falls on it.

use crate::page::{data, numbers, panel, run};
use crate::unlocated::lintel;

#[test]
fn a_beam_on_columns_bends_from_the_line_through_its_ends_and_nothing_on_it_rocks_as_on_rigid_ground() {
    let run = run("lintel", &lintel("moreau-jean-located"));
    let deflection = panel(&data(&run.html), "w_mid").unwrap().clone();
    assert_eq!(deflection["note"], "measured from the line through the ends of the beam");
    // It hops on the columns by more than it bends at rest, and comes back to what statics gives.
    let series = deflection["series"].as_array().unwrap();
    assert!(series.iter().all(|line| !line["label"].as_str().unwrap().contains("free end")), "no places of their own");
    assert!(numbers(&series[0]["y"]).iter().all(|w| w.is_finite()));
    assert!(!run.html.contains("Housner"), "columns carry a beam, and the stone lies on one that columns carry");
    // The columns hardly move beside the stone: their curves lie on zero, which is told with their size.
    let note = panel(&data(&run.html), "x").unwrap()["note"].as_str().unwrap().to_owned();
    assert!(note.starts_with("too small to be seen here: left (up to ") && note.contains(", right (up to "), "{note}");
    // The sentence at the head doesn't stand beside a warning against it as if that were not there.
    assert!(run.html.contains("data-warning=\"under-resolved\""));
    let head = &run.html[run.html.find("id=\"verdict\"").unwrap()..];
    assert!(head[..head.find("</p>").unwrap()].contains("as far as such long steps can tell"));
    let warning = run.summary.warnings.iter().find(|warning| warning.code == "under-resolved").unwrap();
    assert!(!warning.text.contains("all together") && !warning.text.contains("  "), "{}", warning.text);
}
