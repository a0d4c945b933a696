//! What became of a scene, in a sentence.

mod rolled;
mod slid;

use super::carrier::{Driven, driven_below};
use super::{BodyVerdict, Fate, Going, Side, many};
use crate::all_digits::{all_digits, with_all_digits};
use crate::deflections::LargestDeflection;
use crate::summary::BorneSummary;
use rolled::{below, ended_at, so_far, went};
pub(super) use rolled::{so_far_in_words, way_so_far};
pub(crate) use slid::MORE;
use slid::beside_slid;
pub(super) use slid::{slid, up_to};
use teeter_integrator::State;
use teeter_scenario::readable::{shortest, with_unit};
use teeter_scenario::scene::{BlockScene, Scene};

/// Blocks up to this many are told one by one.
const FEW: usize = 2;

/// What is known of the beams of a scene.
pub(crate) struct OfBeams<'a> {
    /// What they bore.
    pub(crate) borne: &'a [BorneSummary],
    /// How far they deflected, of a scene without blocks.
    pub(crate) deflections: &'a [LargestDeflection],
    /// Which fell, and by how much, m.
    pub(crate) fallen: &'a [(&'a str, f64)],
    /// Whether there were impacts, which decide stresses then.
    pub(crate) has_impacts: bool,
}

/// What became of the scene; `moved` says how far a block is from its start.
pub(crate) fn headline(
    scene: &Scene,
    state: &State,
    verdict: &[BodyVerdict],
    beams: &OfBeams<'_>,
    moved: impl Fn(usize) -> [f64; 3],
) -> String {
    let mut text = match verdict {
        [] => without_free_blocks(scene, state, beams, moved),
        few if few.len() <= FEW => {
            few.iter().map(|of| format!("`{}` {}", of.body, one(scene, of, state.t))).collect::<Vec<_>>().join("; ")
        }
        many => many::all(scene, many, state.t),
    };
    if !verdict.is_empty() {
        fell(beams.fallen).for_each(|beam| text.push_str(&format!("; {beam}")));
    }
    let judged = beams.borne.iter().filter_map(|beam| Some((beam.decisive_part()?, beam)));
    if let Some((_, beam)) = judged.max_by(|a, b| a.0.total_cmp(&b.0)) {
        let part = beam.part_of_yield_strength.unwrap_or_default();
        let told = |part: f64| percent(part, beams.has_impacts);
        let (part, weight) = (told(part), beam.about_weight(told));
        text.push_str(&format!("; `{}` was stressed to {part} of its yield strength{weight}", beam.beam));
    } else if verdict.is_empty() {
        let known = beams.borne.iter().filter_map(|beam| Some((beam.largest_stress?, beam)));
        if let Some((largest, beam)) = known.max_by(|a, b| a.0.stress.total_cmp(&b.0.stress)) {
            let (stress, x) = (with_unit(largest.stress, "Pa"), with_unit(largest.x, "m"));
            text.push_str(&format!(
                "; the largest stress is {stress} in `{}` at x = {x}, {}{}",
                beam.beam,
                time(largest.t),
                if beam.is_without_weight { ", without its own weight" } else { "" }
            ));
        }
    }
    text
}

/// A part of the yield strength in percent, never one that hides on which side of it the stress is. With impacts it depends on step and elements: `about`.
pub(crate) fn percent(part: f64, has_impacts: bool) -> String {
    let (digits, cap, about) = if has_impacts { (2, 99.0, "about ") } else { (3, 99.9, "") };
    if part < 1.0 {
        return format!("{about}{} %", shortest((100.0 * part).min(cap), digits));
    }
    match shortest(100.0 * part, 3).as_str() {
        "100" if part > 1.0 => "just over 100 %".to_owned(),
        percent => format!("{about}{percent} %"),
    }
}

/// What became of a scene without free blocks: where blocks that are free in part ended, and how far beams deflected, in the order given.
fn without_free_blocks(scene: &Scene, state: &State, beams: &OfBeams<'_>, moved: impl Fn(usize) -> [f64; 3]) -> String {
    let OfBeams { deflections, fallen, .. } = *beams;
    let in_part = |(_, block): &(usize, &BlockScene)| block.motion.is_given() && !block.motion.is_whole();
    let ends = |(number, block)| ended(block, moved(number));
    let mut told: Vec<String> = scene.blocks.iter().enumerate().filter(in_part).map(ends).collect();
    let of_blocks = told.len();
    if of_blocks > FEW {
        told.splice(FEW.., [format!("{} more blocks are free in part", of_blocks - FEW)]);
    }
    told.extend(fell(fallen));
    // How far something fell is no deflection.
    let is_bent = |of: &&LargestDeflection| of.w != 0.0 && fallen.iter().all(|(beam, _)| *beam != of.beam);
    let bent: Vec<_> = deflections.iter().filter(is_bent).collect();
    told.extend(bent.iter().take(FEW).map(|of| {
        let way = if of.w < 0.0 { "down" } else { "up" };
        let (w, x) = (with_unit(of.w.abs(), "m"), with_unit(of.x, "m"));
        format!("`{}` deflected by up to {w} {way} at x = {x}, {}", of.beam, time(of.t))
    }));
    if bent.len() > FEW {
        told.push(format!("the other {} beams by less of their spans", bent.len() - FEW));
    }
    if told.is_empty() {
        let is_driven = scene.motions().any(|(_, motion)| motion.0.iter().flatten().any(|axis| axis.amplitude != 0.0));
        let what = match (deflections.is_empty(), is_driven) {
            (false, _) => "nothing deflects",
            // Beside blocks the deflections of beams aren't known.
            _ if !scene.beams.is_empty() => return "no block is free".to_owned(),
            (true, true) => "nothing moves but as prescribed",
            (true, false) => "nothing moves",
        };
        return format!("{what} up to {}", time(state.t));
    }
    let none = if !scene.blocks.is_empty() { "no block is free; " } else { "" };
    format!("{none}{}", told.join("; "))
}

/// Which beams fell, in words.
fn fell(fallen: &[(&str, f64)]) -> impl Iterator<Item = String> {
    let more = fallen.len().saturating_sub(FEW);
    let others = (more > 0).then(|| format!("{more} more beams fell"));
    let told = fallen.iter().take(FEW);
    told.map(|(beam, fall)| format!("`{beam}` fell, {} lower at the end", with_unit(*fall, "m"))).chain(others)
}

/// Where a block of which a part of the motion is prescribed ended by the rest of it, from its start (m, m, rad).
fn ended(block: &BlockScene, moved: [f64; 3]) -> String {
    let (least, axes) = (super::STILL * block.radius(), &block.motion.0);
    let far = |k: usize| (axes[k].is_none() && moved[k].abs() >= least).then(|| with_unit(moved[k].abs(), "m"));
    let across = far(0).map(|x| format!("{x} {} its start", if moved[0] < 0.0 { "left of" } else { "right of" }));
    let up = far(1).map(|y| format!("{y} {}", if moved[1] < 0.0 { "lower" } else { "higher" }));
    let turned = (axes[2].is_none() && moved[2].abs() >= super::STILL).then(|| {
        format!(
            "turned by {} {}",
            turns(moved[2].abs()),
            if moved[2] < 0.0 { "clockwise" } else { "counter-clockwise" }
        )
    });
    let told: Vec<String> = [across, up, turned].into_iter().flatten().collect();
    let given: Vec<&str> =
        ["x", "y", "φ"].into_iter().zip(axes).filter_map(|(of, axis)| axis.as_ref().map(|_| of)).collect();
    let at = if told.is_empty() { "where it started".to_owned() } else { told.join(", ") };
    format!("`{}`, its {} prescribed, ended {at}", block.name, given.join(" and "))
}

/// A part of a limit: what stays below it isn't rounded up to it.
pub(crate) fn part(x: f64) -> String {
    if x < 1.0 { digits(x.min(0.999)) } else { digits(x) }
}

/// A number with three digits, for prose.
fn digits(x: f64) -> String {
    all_digits(x, 3)
}

pub(super) fn time(t: f64) -> String {
    format!("t = {}", with_all_digits(t, "s", 4))
}

/// An angle in degrees.
fn angle(phi: f64) -> String {
    format!("{}°", digits(phi.to_degrees()).replace('-', "\u{2212}"))
}

/// An angle by which something turned: in degrees, or in turns from two on.
fn turns(phi: f64) -> String {
    let turns = phi / std::f64::consts::TAU;
    if turns < 2.0 { angle(phi) } else { format!("{} turns", digits(turns)) }
}

/// What became of a block up to the time `end` (s), after its name.
pub(super) fn one(scene: &Scene, of: &BodyVerdict, end: f64) -> String {
    let at = of.t.map_or_else(String::new, |t| format!(" at {}", time(t)));
    let way = of.way.map_or("", |way| way.word());
    let largest = of.share().filter(|part| *part >= super::ROCKED);
    let of_all = if of.column.is_some() { " of the column" } else { "" };
    // It may have flown at a larger angle.
    let since = if of.settled_at().is_some() { " since it could no longer turn over" } else { "" };
    let largest = largest.map_or_else(String::new, |part| format!("largest φ/α{of_all}{since} {}", self::part(part)));
    let slid = slid(scene, of);
    // Angles count from what carries it, in plots from the horizontal.
    let against = of.against.as_ref().map_or_else(String::new, |what| format!(" against {what}"));
    let beside = |text: String| if largest.is_empty() { text } else { format!("{text} ({largest})") };
    // What tumbles slides meanwhile, and after that.
    let then = if of.what == Fate::Slid && of.rests_from.is_some() { "" } else { "then " };
    let tumbled = of.tumbled.map(|turn| format!("tumbled by {}, {then}", turns(turn.abs())));
    let rolled = of.rolled.and_then(|ways| went(scene, of, &ways, of.going)).map(|went| match of.going {
        Some(Going::Rolls | Going::Slides) => format!("{went}, "),
        _ => format!("{went}, {then}"),
    });
    let moving = if of.is_carried { moving_base(scene, &[of]) } else { "" };
    // Where nothing is said, it rests on its base.
    let side = side_below(of).filter(|_| of.lies_on != Some(Side::Base)).unwrap_or_default();
    let lies = of.other_side().map(|side| format!(" on its {}", side.word()));
    let (aside, between) =
        lies.as_ref().map_or_else(Default::default, |lies| (format!(",{lies}"), format!(",{lies},")));
    let then_rested = of.rests_from.filter(|_| of.what != Fate::Rests).map_or_else(String::new, |t| {
        format!(", came to rest{}{moving} at {}", side_below(of).unwrap_or_default(), time(t))
    });
    let turned = of.turned.map_or_else(String::new, |turn| match turns(turn) {
        degrees if degrees.ends_with('°') => format!(", turned by {degrees} in all"),
        turns => format!(", made {turns} in all"),
    });
    let off = of
        .fell_off
        .as_ref()
        .map_or_else(String::new, |(way, beam)| format!(", then fell off the {} end of `{beam}`", way.word()));
    let on = of.on_what_moves.map_or_else(String::new, |what| format!(", on {what} that moves"));
    // What is thrown to one side may turn over to the other: that would mislead without where it is.
    let over = of.way_over();
    let aside_over = of.aside.map_or_else(String::new, |at| format!(", in the end {}", place(scene, of, at)));
    let fate = match of.what {
        Fate::Overturned if of.t == Some(of.start) => {
            format!("began past its critical angle and overturned {over}{aside_over}{off}{turned}{then_rested}")
        }
        Fate::Overturned => {
            let with = of.overturned_with.as_ref().map_or_else(String::new, |lowest| match *lowest == of.body {
                true => " as the lowest of a column".to_owned(),
                false => format!(" as one with `{lowest}`"),
            });
            let fell = of.fell_at.filter(|fell| of.t.is_some_and(|t| *fell < t));
            let fell = fell.map_or_else(String::new, |t| format!("fell from its place at {}, ", time(t)));
            format!("{fell}overturned{with} {over}{at}{aside_over}{off}{turned}{then_rested}")
        }
        Fate::Left => {
            let beam = of.left_beam.as_ref().map_or_else(|| "its beam".to_owned(), |name| format!("`{name}`"));
            if of.touches_beam {
                return format!("tipped over the {way} end of {beam}{at} and still touches it");
            }
            beside(format!("left {beam} at its {way} end{at}{turned}{}{then_rested}", below(scene, of)))
        }
        Fate::Sunk => format!("fell below everything that could hold it{at}"),
        Fate::Fell => format!("fell from its place{at}{}{then_rested}", below(scene, of)),
        Fate::Rests | Fate::Moves if of.stood_on.is_some() => {
            let since = of.unmoved_from.map_or_else(String::new, |t| format!(", at rest from {}", time(t)));
            let is_round = scene.blocks.iter().any(|block| block.name == of.body && block.base() == 0.0);
            let how = if is_round { "lay" } else { "stood" };
            format!("{how} on `{}` throughout{since}", of.stood_on.as_deref().unwrap_or_default())
        }
        Fate::Rests if of.turns_with.is_some() => {
            format!("rocked as one with `{}`, came to rest{at}", of.turns_with.as_deref().unwrap_or_default())
        }
        Fate::Moves if of.turns_with.is_some() => {
            let now = of.going.map_or_else(|| still(scene, of, end), |going| format!(", is {}{on}", going.word()));
            format!("rocked as one with `{}`{now}", of.turns_with.as_deref().unwrap_or_default())
        }
        Fate::Rests if of.rests_throughout() => {
            let how = if side.is_empty() { "stood" } else { "lay" };
            let on = moving_base(scene, &[of]);
            let still = if on.is_empty() { " still" } else { "" };
            beside(format!("{how}{still}{side}{on} throughout"))
        }
        Fate::Rests => beside(format!("came to rest{side}{moving}{at}")),
        Fate::Slid if of.rests_from.is_some() => beside(format!("{slid} and came to rest{side}{moving}{at}")),
        Fate::Slid if of.stopped => {
            let slid = match of.to_and_fro {
                Some(reached) => format!("slid to and fro, {},", up_to(scene, of, reached)),
                None => slid,
            };
            let on = on_what_moves(&[of]);
            beside(lies.map_or_else(|| format!("{slid} and stands{on}"), |lies| format!("{slid} and lies{lies}{on}")))
        }
        Fate::Slid if of.to_and_fro.is_some() => {
            let on = if of.is_driven { moving_base(scene, &[of]) } else { "" };
            let reached = of.to_and_fro.unwrap_or_default();
            let still = if of.is_driven || of.still_from.is_none() { String::new() } else { still(scene, of, end) };
            let how = if still.is_empty() { "slides" } else { "slid" };
            beside(format!("{how} to and fro{on}, {}{}{still}", up_to(scene, of, reached), beside_slid(scene, of)))
        }
        // Whether it slides or sticks in the last instant says nothing.
        Fate::Slid if of.is_driven => beside(format!("{slid}{}", moving_base(scene, &[of]))),
        Fate::Slid if of.still_from.is_some() => beside(format!("{slid}{between}{}", still(scene, of, end))),
        Fate::Slid => beside(format!("slides on, {slid} so far")),
        Fate::Rocks if of.turns_with.is_some() => {
            let how = if of.in_column { "rocks" } else { "turns" };
            format!("{how} as one with `{}`", of.turns_with.as_deref().unwrap_or_default())
        }
        Fate::Rocks | Fate::Moves if of.on_its_way.is_some() => {
            let now = of.on_its_way.map_or_else(String::new, |phi| format!("{}{against}", angle(phi)));
            if let Some(way) = of.tips {
                let past = if of.past_edge == Some(way) { PAST_EDGE } else { "" };
                return format!("is still tipping to the {}{past}: φ {now} at {}", way.word(), time(end));
            }
            let most = of.last_peak.map_or_else(String::new, |peak| format!(", largest {}{at}", angle(peak)));
            format!("has not been upright yet, too short a run to tell how it rocks: φ {now} at {}{most}", time(end))
        }
        Fate::Rocks => {
            let peak =
                of.last_peak.map_or_else(String::new, |peak| format!(", last peak {}{against}{at}", angle(peak)));
            let drift = if of.has_slid { format!(", {slid}") } else { String::new() };
            if of.stopped_swinging {
                return beside(format!("rocked{aside}{peak}{drift}{}", still(scene, of, end)));
            }
            beside(format!("rocks on{aside}{peak}{drift}"))
        }
        Fate::Moves if of.still_from == Some(of.start) && scene.settles_at() < end => {
            beside("has been still, too short a run to tell whether it rests".to_owned())
        }
        Fate::Moves if of.still_from.is_some() && of.going.is_none() => {
            beside(format!("moved{between}{}", still(scene, of, end)))
        }
        Fate::Moves => match of.going {
            // What bounces doesn't slide, but may be elsewhere.
            Some(Going::Bounces) if of.flown.is_some() => {
                let place = place(scene, of, of.flown.unwrap_or_default());
                beside(format!("is {}{on}, {place}", Going::Bounces.word()))
            }
            Some(going) => {
                let so_far = of.rolled.map_or_else(String::new, |ways| so_far(scene, of, &ways, going));
                let rocked = of.stopped_rocking;
                let rocked = rocked.map_or_else(String::new, |t| format!("stopped rocking at {}, ", time(t)));
                beside(format!("{rocked}is {}{aside}{on}{so_far}", going.word()))
            }
            None => beside("still moves".to_owned()),
        },
    };
    let ended = of.rolled.filter(|_| matches!(of.what, Fate::Rests | Fate::Moves));
    let ended = ended.map_or_else(String::new, |ways| ended_at(scene, of, &ways));
    format!("{}{fate}{}{ended}", tumbled.or(rolled).unwrap_or_default(), hopped(scene, of))
}

/// What goes before how far something went that turned round.
const TO_AND_FRO: &str = " to and fro";

/// Where a block is that is so far from its start along what carries it (m), in words: what began in flight stood nowhere before.
fn place(scene: &Scene, of: &BodyVerdict, at: f64) -> String {
    let [start, back] = match of.began_in_flight {
        true => ["where it was released", "back where it was released"],
        false => ["its start", "back at its start"],
    };
    if is_told(scene, of, at) {
        format!("{} {} {start}", with_unit(at.abs(), "m"), direction(scene, at).side)
    } else {
        back.to_owned()
    }
}

/// Where a block is that doesn't slide, in words, if that is further from its start than its base is long: hops and flights took it there.
fn hopped(scene: &Scene, of: &BodyVerdict) -> String {
    let block = scene.blocks.iter().find(|block| block.name == of.body);
    let told =
        matches!(of.what, Fate::Rests | Fate::Rocks | Fate::Moves) && !of.has_slid && of.going != Some(Going::Bounces);
    let at = of.elsewhere.filter(|at| told && block.is_some_and(|block| at.abs() > block.base()));
    // What began in flight is told to have been released.
    let how = if of.began_in_flight { "" } else { " by hops and flights" };
    at.map_or_else(String::new, |at| format!(", {}{how}", place(scene, of, at)))
}

/// On what blocks stand that have stopped sliding, in words, if the same moves under all of them.
pub(super) fn on_what_moves(bodies: &[&BodyVerdict]) -> String {
    let first = bodies.first().and_then(|of| of.on_what_moves);
    let same = first.filter(|_| bodies.iter().all(|of| of.on_what_moves == first));
    same.map_or_else(|| " now, trembling".to_owned(), |what| format!(" on {what} that moves"))
}

/// Of what tips because nothing held it from the start.
pub(super) const PAST_EDGE: &str = ", its mass centre past the edge that it stood on from the start";

/// The slope of what carries blocks, rad, from which on sliding is told as up or down it.
const STEEP: f64 = 0.01;

/// A direction along what carries a block, in words.
struct Direction {
    /// Which way it went.
    way: &'static str,
    /// On which side of its start it is.
    side: &'static str,
}

/// In which direction something slid along what carries it.
fn direction(scene: &Scene, slid: f64) -> Direction {
    let ground = scene.ground.as_ref().filter(|ground| ground.profile.is_none() && scene.beams.is_empty());
    // Without gravity nothing slopes: not −0, whose angle is π.
    let [across, down] = [scene.gravity[0], 0.0 - scene.gravity[1]];
    let slope = ground.map_or(0.0, |ground| ground.incline - across.atan2(down));
    let (way, side) = match (slope.abs() >= STEEP, slid < 0.0) {
        (true, _) if slope * slid > 0.0 => ("up the slope", "up the slope from"),
        (true, _) => ("down the slope", "down the slope from"),
        (false, true) => ("to the left", "left of"),
        (false, false) => ("to the right", "right of"),
    };
    Direction { way, side }
}

/// To which side a way along what carries a block (m) is, in words, if it is so long that it is told.
pub(super) fn way(scene: &Scene, of: &BodyVerdict, at: f64) -> Option<&'static str> {
    is_told(scene, of, at).then(|| direction(scene, at).way)
}

/// That a block is still at the end, in words, of one that is not known to rest: while something shakes it, it may move again.
fn still(scene: &Scene, of: &BodyVerdict, end: f64) -> String {
    if scene.settles_at() >= end {
        return " and is still at the end".to_owned();
    }
    let since = of.still_from.map_or_else(String::new, time);
    format!(" and has been still since {since}, too short a time to tell whether it rests")
}

/// On what blocks rest, in words, where that moves by itself: to an onlooker they move with it.
pub(super) fn moving_base(scene: &Scene, bodies: &[&BodyVerdict]) -> &'static str {
    let below = |of: &&BodyVerdict| {
        let number = scene.blocks.iter().position(|block| block.name == of.body)?;
        driven_below(scene, number).map(|(driven, _)| driven)
    };
    let driven: Vec<Option<Driven>> = bodies.iter().map(below).collect();
    match driven.as_slice() {
        all if all.iter().all(Option::is_none) => "",
        all if all.iter().all(|below| *below == Some(Driven::Ground)) => " on the moving ground",
        all if all.iter().all(|below| *below == Some(Driven::Supports)) => " on moving supports",
        all if all.iter().all(|below| *below == Some(Driven::Block)) => " on a moving block",
        _ => " on what moves under them",
    }
}

/// How a block that rests does so, in words after "came to rest"; `None` of what has no sides.
fn side_below(of: &BodyVerdict) -> Option<String> {
    let leans = of.leans_at.map(|phi| format!(" at φ = {}", angle(phi)));
    of.lies_on.as_ref().map(|side| format!(" on its {}", side.word())).or(leans)
}

/// Whether a way along what carries a block, m, is so long that it is told.
fn is_told(scene: &Scene, of: &BodyVerdict, way: f64) -> bool {
    let block = scene.blocks.iter().find(|block| block.name == of.body);
    block.is_some_and(|block| match block.base() {
        base if base > 0.0 => way.abs() >= super::SLID * base,
        _ => way.abs() >= super::ROLLED * block.radius(),
    })
}

#[cfg(test)]
mod tests {
    use super::percent;

    #[test]
    fn a_part_of_a_strength_is_on_its_side_of_it() {
        assert_eq!([0.1234, 0.997, 0.9999].map(|part| percent(part, false)), ["12.3 %", "99.7 %", "99.9 %"]);
        let over = [1.0, 1.0004, 1.0481, 2.5].map(|part| percent(part, false));
        assert_eq!(over, ["100 %", "just over 100 %", "105 %", "250 %"]);
        // With impacts it is about that.
        let of_impacts = [0.1234, 0.9999, 1.0, 1.0004, 1.0481].map(|part| percent(part, true));
        assert_eq!(of_impacts, ["about 12 %", "about 99 %", "about 100 %", "just over 100 %", "about 105 %"]);
    }
}
