//! Keys that were given and do nothing in their scene.

use crate::diagnostic::Diagnostic;
use crate::document::Document;
use crate::scene::{LoadKind, Scene};
use crate::source::Origin;
use std::collections::BTreeSet;

/// Findings of one kind that are listed.
const LISTED: usize = 20;

pub(crate) fn of(scene: &Scene, document: &Document) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    let mut idle = |path: &str, rule: String, remedy: &str| {
        found.push(document.error(path, rule, remedy).as_warning());
    };
    let (time, end) = (&scene.time, scene.time.steps() as f64 * scene.time.step);
    // Who tries another scheme with `--set` needn't take the key of the scene's own one out.
    let by_set = |path: &str| matches!(document.origin(path), Origin::Set { .. });
    let tried = by_set("time.scheme") && !by_set("time.activation_gamma");
    if !time.scheme.predicts() && document.is_given("time.activation_gamma") && !tried {
        let rule = format!("{} has no prediction for it to act on: it does nothing", time.scheme.word());
        idle("time.activation_gamma", rule, "leave it out, or take scheme = \"moreau-jean\"");
    }
    if time.scheme.has_own_steps() && document.is_given("time.gap_tolerance") && !tried {
        let rule = format!("{} locates contacts to rounding: it does nothing", time.scheme.word());
        idle("time.gap_tolerance", rule, "leave it out");
    }
    if time.theta >= 0.5 && document.flag("time.allow_conditional_stability") == Some(true) {
        let rule = format!("with theta = {} every step is stable: it does nothing", time.theta);
        idle("time.allow_conditional_stability", rule, "leave it out; it goes with theta below 0.5");
    }
    if let Some(every) = scene.every {
        if every < time.step * (1.0 - 1e-9) {
            let rule = format!("finer than the step of {:e} s: every step is a row, and no more", time.step);
            idle("output.every", rule, "take a shorter step, or leave it out for a row every step");
        } else if every > end * (1.0 + 1e-9) {
            let rule = format!("longer than the run of {end} s: only its start and its end are rows");
            idle("output.every", rule, "take a shorter interval, or leave it out for some 10 000 rows");
        }
    }
    let never = scene.loads.iter().filter_map(|load| match load.kind {
        LoadKind::Moving { at, speed, .. } => {
            let span = scene.beams[load.beam].spec.span;
            let (first, last) = (at.min(at + speed * end), at.max(at + speed * end));
            (last < 0.0 || first > span).then_some((load, first, last, span))
        }
        _ => None,
    });
    for (load, first, last, span) in never.take(LISTED) {
        let rule = format!(
            "it moves from {first} m to {last} m in the run of {end} s, and never meets its beam, [0, {span}] m: it does nothing"
        );
        idle(&format!("load.{}.at", load.name), rule, "check where it starts, and the sign of its speed");
    }
    for contact in scene.contacts.iter().filter(|contact| contact.law.friction == 0.0).take(LISTED) {
        let path = format!("contact.{}.tangential_restitution", contact.name);
        if contact.law.tangential_restitution > 0.0 {
            let rule = "without friction nothing brings the tangential velocity back: it does nothing".to_owned();
            idle(&path, rule, "give a friction, or leave it out");
        }
    }
    let made_of: BTreeSet<&str> = document
        .entries()
        .filter(|(path, _)| path.ends_with(".material"))
        .filter_map(|(path, _)| document.text(path))
        .collect();
    for name in document.names("material").into_iter().filter(|name| !made_of.contains(name)).take(LISTED) {
        idle(
            &format!("material.{name}"),
            "nothing is of this material".to_owned(),
            "name it in a body, or leave it out",
        );
    }
    found
}
