//! What figures on paper leave out, and how they draw what lasts for a moment.

use crate::page::scenario;
use teeter_report::figures;

/// A block that bounces on both feet, and then stands.
#[test]
fn impulses_are_bars_and_what_is_said_once_or_never_occurs_is_in_no_further_legend() {
    let drop = scenario("drop");
    let (_, svg) = figures(&drop.page).into_iter().find(|(file, _)| file == "contact_forces.svg").unwrap();
    let (_, impulses) = svg.split_once("Normal force").unwrap();
    assert!(impulses.contains("stroke=\"none\""), "bars have no outlines");
    // In the legend of the first panel, and beside the bands of the states.
    for foot in ["bottom left", "bottom right"] {
        assert_eq!(svg.matches(&format!(">{foot}</text>")).count(), 2, "{foot}");
    }
    for (state, count) in [("stick", 1), ("slip", 0), ("presses briefly", 1), ("open", 1)] {
        assert_eq!(svg.matches(&format!(">{state}</text>")).count(), count, "{state}");
    }
    // What slides never sticks there.
    let slides = scenario("sliding");
    let (_, svg) = figures(&slides.page).into_iter().find(|(file, _)| file == "contact_forces.svg").unwrap();
    assert!(svg.contains(">slip</text>") && !svg.contains(">open</text>"));
}
