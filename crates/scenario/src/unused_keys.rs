//! Warnings about keys that are given but have no effect.

use crate::diagnostic::Diagnostic;
use crate::document::Document;
use crate::scene::{Crowd, LoadKind, Scene};
use crate::source::Origin;
use crate::wording;
use std::collections::BTreeSet;

/// Most findings of one kind that are listed.
const LISTED: usize = 20;

pub(crate) fn of(scene: &Scene, document: &Document) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    let mut idle = |path: &str, rule: String, remedy: &str| {
        found.push(document.error(path, rule, remedy).as_warning());
    };
    let (time, end) = (&scene.time, scene.time.steps() as f64 * scene.time.step);
    // With a scheme from `--set`, keys of the scene's own scheme may stay.
    let by_set = |path: &str| matches!(document.origin(path), Origin::Set { .. });
    let tried = by_set("time.scheme") && !by_set("time.activation_gamma");
    if !time.scheme.predicts() && document.is_given("time.activation_gamma") && !tried {
        let rule = format!("no effect: {} doesn't predict positions", time.scheme.word());
        idle("time.activation_gamma", rule, "leave it out, or use scheme = \"moreau-jean\"");
    }
    if time.scheme.has_own_steps() && document.is_given("time.gap_tolerance") && !tried {
        let rule = format!("no effect: {} locates contacts to rounding", time.scheme.word());
        idle("time.gap_tolerance", rule, "leave it out");
    }
    if time.theta >= 0.5 && document.flag("time.allow_conditional_stability") == Some(true) {
        let rule = format!("no effect: with theta = {} every step is stable", time.theta);
        idle("time.allow_conditional_stability", rule, "leave it out; it goes with theta below 0.5");
    }
    if time.stop.is_given() && scene.blocks.iter().all(|block| block.motion.is_given()) {
        idle("time.stop", "no effect: there are no free blocks".to_owned(), "leave it out");
    } else if time.stop.rest && scene.settles_at() >= end {
        let rule =
            "`rest` has no effect: a motion goes on, or a force or load changes, up to the end of the run".to_owned();
        idle("time.stop", rule, "leave `rest` out, or let the run go on past the end of what drives it");
    }
    if let Some(every) = scene.every {
        if every < time.step * (1.0 - 1e-9) {
            let rule =
                format!("shorter than the step of {}: every step gives only one row", wording::seconds(time.step, 4));
            idle("output.every", rule, "use a shorter step, or leave it out for a row every step");
        } else if every > end * (1.0 + 1e-9) {
            let rule = format!("longer than the run of {end} s: only its start and end are written");
            idle("output.every", rule, "use a shorter interval, or leave it out for some 10 000 rows");
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
            "no effect: it moves from {first} m to {last} m in the run of {end} s, and never reaches its beam, [0, {span}] m"
        );
        idle(&format!("load.{}.at", load.name), rule, "check where it starts, and the sign of its speed");
    }
    for table in document.names("block") {
        let path = format!("block.{table}.repeat.row_shift");
        let has_rows = document.integer(&format!("block.{table}.repeat.rows")).is_some_and(|rows| rows > 1);
        if document.is_given(&path) && !has_rows {
            idle(&path, "no effect: there is only one row".to_owned(), "give rows = 2 or more, or leave it out");
        }
        let at = |key: &str| format!("block.{table}.repeat.{key}");
        let jitters = document.pair(&at("jitter")).is_some_and(|most| most != [0.0; 2])
            || document.quantity(&at("jitter_angle")).is_some_and(|most| most != 0.0);
        if document.is_given(&at("seed")) && !jitters {
            idle(
                &at("seed"),
                "no effect: nothing is random".to_owned(),
                "give jitter or jitter_angle, or leave it out",
            );
        }
    }
    let of_crowd = scene.crowd.iter().flat_map(Crowd::contacts).map(|contact| (&contact.name, &contact.law));
    let smooth = scene.contacts.iter().filter(|contact| contact.feet_friction.iter().flatten().all(|own| *own == 0.0));
    let contacts = smooth.map(|contact| (&contact.name, &contact.law)).chain(of_crowd);
    for (name, law) in contacts.filter(|(_, law)| law.friction == 0.0).take(LISTED) {
        let path = format!("contact.{name}.tangential_restitution");
        if law.tangential_restitution > 0.0 {
            let rule = "no effect: without friction the tangential velocity can't be reversed".to_owned();
            idle(&path, rule, "add friction, or leave it out");
        }
    }
    let of_bodies =
        document.entries().filter(|(path, _)| path.ends_with(".material")).filter_map(|(path, _)| document.text(path));
    let parts = document.names("block").into_iter().filter_map(|name| document.items(&format!("block.{name}.parts")));
    let made_of: BTreeSet<&str> = of_bodies.chain(parts.flatten().filter_map(|part| part.text("material"))).collect();
    for name in document.names("material").into_iter().filter(|name| !made_of.contains(name)).take(LISTED) {
        idle(&format!("material.{name}"), "this material is not used".to_owned(), "use it in a body, or leave it out");
    }
    found
}
