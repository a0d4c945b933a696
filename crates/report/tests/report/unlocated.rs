//! Steps in which not all impacts and ends of slides are located are told wherever a run is told of.

use crate::page::{run, shown};
use teeter_report::UNLOCATED;

/// A stone falls on a lintel: where bounces on three bodies end together, a step has more impacts than are located.
pub(crate) fn lintel(scheme: &str) -> String {
    let text = include_str!("../../../../scenarios/lintel.toml");
    let [head, rest] = text.split_once("[time]").map(|(head, rest)| [head, rest]).unwrap();
    let own = |line: &&str| !line.starts_with("end") && !line.starts_with("scheme");
    let rest = rest.lines().filter(own).collect::<Vec<_>>().join("\n");
    format!("{head}[time]\nend = '0.3 s'\nscheme = '{scheme}'{rest}")
}

#[test]
fn steps_in_which_not_all_is_located_are_a_warning_in_the_summary_and_on_the_page() {
    let located = run("unlocated", &lintel("moreau-jean-located"));
    let steps = located.summary.unlocated_steps;
    assert!(steps > 0, "the scene doesn't test it any more");
    let warning = located.summary.warnings.iter().find(|warning| warning.code == UNLOCATED).unwrap();
    assert_eq!(warning.count, steps);
    assert!(warning.text.contains("not all impacts and ends of slides were located"), "{}", warning.text);
    assert!(!warning.text.contains("  "), "{}", warning.text);
    let told = located
        .html
        .split("<li data-warning=\"unlocated\">")
        .nth(1)
        .and_then(|rest| rest.split("</li>").next())
        .unwrap();
    assert!(!told.contains("times)"), "the text tells how many: {told}");
    assert_eq!(shown(&located.html, "unlocated_steps"), steps.to_string());
    // What promises none has none to tell.
    let plain = run("unlocated-plain", &lintel("moreau-jean"));
    assert!(plain.summary.warnings.iter().all(|warning| warning.code != UNLOCATED));
}
