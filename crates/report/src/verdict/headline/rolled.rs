//! How far round blocks rolled and skidded, in words.

use super::super::BodyVerdict;
use super::super::going::Going;
use super::super::rolling::Rolled;
use super::slid::MORE;
use super::{TO_AND_FRO, direction, is_told, place, turns};
use teeter_scenario::readable::with_unit;
use teeter_scenario::scene::Scene;

/// How far a round block rolled, in words after "rolled", and in all (m), where that is more.
fn rolled(scene: &Scene, of: &BodyVerdict, [at, in_all]: [f64; 2], turned: f64) -> String {
    let by = format!("{} ({})", by(scene, at), turns(turned.abs()));
    if in_all <= MORE * at.abs() {
        return format!(" {by}");
    }
    let by = if is_told(scene, of, at) { by } else { "and back to its start".to_owned() };
    format!("{TO_AND_FRO}, {} in all, {by}", with_unit(in_all, "m"))
}

/// How far something went, and to which side.
fn by(scene: &Scene, at: f64) -> String {
    format!("by {} {}", with_unit(at.abs(), "m"), direction(scene, at).way)
}

/// How far a round block skidded and rolled, in words, but for what it still does.
pub(super) fn went(scene: &Scene, of: &BodyVerdict, ways: &Rolled, going: Option<Going>) -> Option<String> {
    let skidded = ways.skidded.filter(|_| going != Some(Going::Slides)).map(|at| skidded(scene, of, at));
    let rolled = ways.rolled.filter(|_| going != Some(Going::Rolls));
    let rolled = rolled.map(|rolled| format!("rolled{}", self::rolled(scene, of, rolled, ways.turned)));
    let went: Vec<String> = skidded.into_iter().chain(rolled).collect();
    (!went.is_empty()).then(|| went.join(", "))
}

/// How far a round block skidded and rolled after it had fallen from its place, or left its beam, in words after that.
pub(super) fn below(scene: &Scene, of: &BodyVerdict) -> String {
    let Some(ways) = of.rolled_since else { return String::new() };
    let went = went(scene, of, &ways, of.goes_below).map(|went| format!(", then {went}"));
    let on = of.goes_below.map(|going| format!(", and is {}{}", going.word(), so_far(scene, of, &ways, going)));
    went.into_iter().chain(on).collect()
}

fn skidded(scene: &Scene, of: &BodyVerdict, at: f64) -> String {
    format!("skidded{}", if is_told(scene, of, at) { format!(" {}", by(scene, at)) } else { TO_AND_FRO.to_owned() })
}

/// How far a round block that rolls or slides on has done so, in words after that it does.
pub(super) fn so_far(scene: &Scene, of: &BodyVerdict, ways: &Rolled, going: Going) -> String {
    let rolled = ways.rolled.map(|rolled| self::rolled(scene, of, rolled, ways.turned));
    let on = match going {
        Going::Rolls => rolled,
        Going::Slides => ways.skidded.filter(|at| is_told(scene, of, *at)).map(|at| format!(" {}", by(scene, at))),
        _ => None,
    };
    // How goes before how far.
    let comma = if on.as_ref().is_some_and(|on| on.starts_with(TO_AND_FRO)) { "" } else { "," };
    on.map_or_else(String::new, |on| format!("{comma}{on} so far"))
}

/// How far one of many that rolls or slides on has done so, in words; nothing of others.
pub(in crate::verdict) fn so_far_in_words(scene: &Scene, of: &BodyVerdict) -> String {
    let told = of.rolled.zip(of.going).map(|(ways, going)| so_far(scene, of, &ways, going));
    told.unwrap_or_default()
}

/// How far a round block that rolls or slides on has done so, m.
pub(in crate::verdict) fn way_so_far(of: &BodyVerdict) -> Option<f64> {
    let ways = of.rolled?;
    match of.going? {
        Going::Rolls => ways.rolled.map(|[at, _]| at.abs()),
        Going::Slides => ways.skidded.map(f64::abs),
        _ => None,
    }
}

/// Where a round block is, and by how much it has turned, in words, where that doesn't follow from how far it rolled or skidded.
pub(super) fn ended_at(scene: &Scene, of: &BodyVerdict, ways: &Rolled) -> String {
    let place = ways.moved.map(|at| place(scene, of, at));
    let turned = ways.turned_in_all.map(|turn| {
        let way = if turn < 0.0 { "clockwise" } else { "counter-clockwise" };
        format!("turned by {} {way}", turns(turn.abs()))
    });
    let told: Vec<String> = place.into_iter().chain(turned).collect();
    if told.is_empty() { String::new() } else { format!("; in all {}", told.join(", ")) }
}
