//! How blocks slid, in words.

use super::{TO_AND_FRO, direction, is_told, place};
use crate::verdict::BodyVerdict;
use teeter_scenario::readable::{like, with_unit};
use teeter_scenario::scene::Scene;

/// How far a block slid, and where it is by that, in words.
pub(in crate::verdict) fn slid(scene: &Scene, of: &BodyVerdict) -> String {
    // Both in the unit of the larger.
    let far = of.slid.into_iter().chain(of.farthest).fold(0.0, |far: f64, way| far.max(way.abs()));
    let by = |way: f64| format!("{} {}", like(way.abs(), far, "m"), direction(scene, way).way);
    let both_sides = of.to_and_fro.filter(|reached| reached.iter().all(|way| is_told(scene, of, *way)));
    let slid = of.slid.map_or_else(String::new, |slid| match of.farthest {
        _ if both_sides.is_some() => to_both_sides(scene, of, both_sides.unwrap_or_default(), slid),
        None => format!("slid by {}", by(slid)),
        Some(farthest) if of.elsewhere.is_some() => format!("slid {}, then {}", by(farthest), by(slid - farthest)),
        Some(farthest) if is_back(scene, of, slid, farthest) => {
            format!("slid {}, then back to its start", by(farthest))
        }
        Some(farthest) => {
            let side = direction(scene, slid).side;
            // What ends on the other side, farther from its start than it was before, isn't back there.
            let back = if farthest * slid < 0.0 && farthest.abs() <= slid.abs() { "" } else { "back " };
            format!("slid {}, then {back}to {} {side} its start", by(farthest), like(slid.abs(), far, "m"))
        }
    });
    slid + &beside_slid(scene, of)
}

/// How a block slid to both sides of its start (m) and where it is by that, in words.
fn to_both_sides(scene: &Scene, of: &BodyVerdict, reached: [f64; 2], slid: f64) -> String {
    // Where it is, as how far it was, has its hops in it.
    let ends = of.displaced.filter(|_| !of.began_in_flight).unwrap_or(slid);
    let far = reached.iter().fold(0.0, |far: f64, way| far.max(way.abs()));
    let in_the_end = if of.elsewhere.is_some() {
        // Hops and flights took it there.
        String::new()
    } else if is_back(scene, of, ends, far) {
        ", in the end back at its start".to_owned()
    } else {
        format!(", in the end {} {} it", like(ends.abs(), far, "m"), direction(scene, ends).side)
    };
    format!("slid{TO_AND_FRO}, {}{in_the_end}", up_to(scene, of, reached))
}

/// Whether what was so `far` (m) from its start and ends at `at` (m) is back there: neither told to be elsewhere nor by a part of its way that matters.
fn is_back(scene: &Scene, of: &BodyVerdict, at: f64, far: f64) -> bool {
    !is_told(scene, of, at) && at.abs() < BACK * far.abs()
}

/// What is this near to its start, in parts of how far it was, is back there.
const BACK: f64 = 0.02;

/// How far to the left and to the right of its start a block has been (m), in words, as far as that is told.
pub(in crate::verdict) fn up_to(scene: &Scene, of: &BodyVerdict, reached: [f64; 2]) -> String {
    let far = reached.iter().fold(0.0, |far: f64, way| far.max(way.abs()));
    let by = |way: f64| like(way.abs(), far, "m");
    if of.elsewhere.is_some() {
        // Hops and flights took it elsewhere: these ways are not from its start.
        let told = |way: f64| format!("{} {}", by(way), direction(scene, way).way);
        let ways: Vec<String> = reached.into_iter().filter(|way| is_told(scene, of, *way)).map(told).collect();
        return if ways.is_empty() { "where it stands".to_owned() } else { format!("by up to {}", ways.join(" and ")) };
    }
    let told = |way: f64| format!("{} {}", by(way), direction(scene, way).side);
    match reached.map(|way| is_told(scene, of, way).then(|| told(way))) {
        [Some(left), Some(right)] => format!("up to {left} and {right} its start"),
        [Some(way), None] | [None, Some(way)] => format!("up to {way} its start"),
        [None, None] => "near its start".to_owned(),
    }
}

/// What is told beside a slide, in words: how far it was to and fro in all, where that is more, and where the block is, if hops and flights took it
/// there.
pub(super) fn beside_slid(scene: &Scene, of: &BodyVerdict) -> String {
    let slid = of.slid.unwrap_or_default();
    let told = of.farthest.map_or(slid.abs(), |farthest| farthest.abs() + (slid - farthest).abs());
    let in_all = of.slid_in_all.filter(|in_all| *in_all > MORE * told && is_told(scene, of, in_all - told));
    let in_all = in_all.map(|in_all| format!("{} in all", with_unit(in_all, "m")));
    let how = if of.began_in_flight { "" } else { "with hops and flights " };
    let place = of.elsewhere.map(|at| format!("{how}{}", place(scene, of, at)));
    let told: Vec<String> = in_all.into_iter().chain(place).collect();
    if told.is_empty() { String::new() } else { format!(" ({})", told.join(", ")) }
}

/// What slid in all by this many times as far as the rest of the sentence says has that told.
pub(crate) const MORE: f64 = 1.1;
