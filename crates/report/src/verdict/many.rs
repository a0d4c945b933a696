//! What became of more than a few blocks, in a sentence.

use super::headline::{
    self, PAST_EDGE, moving_base, on_what_moves, part, slid, so_far_in_words, time, up_to, way_so_far,
};
use super::{BodyVerdict, Fate, Going, Way};
use teeter_scenario::readable::with_unit;
use teeter_scenario::scene::Scene;

/// How many of these blocks slid before they came to rest, and how many lie, stand or rock on other sides than their bases, in brackets.
fn how_they_lie(blocks: &[&BodyVerdict]) -> String {
    let slid = blocks.iter().filter(|of| of.what == Fate::Slid && of.rests_from.is_some()).count();
    let over = blocks.iter().filter(|of| of.other_side().is_some()).count();
    let told =
        [(slid, "after sliding"), (over, "on another side than the base")].into_iter().filter(|(count, _)| *count > 0);
    let told: Vec<String> = told.map(|(count, how)| format!("{count} {how}")).collect();
    if told.is_empty() { String::new() } else { format!(" ({})", told.join(", ")) }
}

/// How many of these went to the left and how many to the right, in brackets; nothing where all went to one side.
fn both_ways(blocks: &[&BodyVerdict]) -> String {
    let count = |way: Way| blocks.iter().filter(|of| of.way == Some(way)).count();
    match [count(Way::Left), count(Way::Right)] {
        [0, _] | [_, 0] => String::new(),
        // One that is thrown to the other side of its start turned over to the left, but isn't there.
        [left, right] if blocks.iter().any(|of| of.aside.is_some()) => {
            format!(" ({left} counter-clockwise, {right} clockwise)")
        }
        [left, right] => format!(" ({left} to the left, {right} to the right)"),
    }
}

/// How far these went at most, each by its own way (m), in words with the one that went farthest; nothing of what hardly did.
fn farthest(blocks: &[&BodyVerdict], way: impl Fn(&BodyVerdict) -> Option<f64>) -> String {
    let ways = blocks.iter().filter_map(|of| Some((of, way(of)?)));
    let most = ways.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, most)| *most > 0.0);
    most.map_or_else(String::new, |(of, most)| format!(", by up to {} (`{}`)", with_unit(most, "m"), of.body))
}

/// How far a block is by its slides, m.
fn slid_by(of: &BodyVerdict) -> Option<f64> {
    of.slid.map(f64::abs)
}

/// The farthest from its start that a block slid to and fro, m.
fn reached(of: &BodyVerdict) -> Option<f64> {
    of.to_and_fro.map(|[left, right]| left.abs().max(right.abs()))
}

/// What became of many blocks up to the time `end` (s).
pub(super) fn all(scene: &Scene, verdict: &[BodyVerdict], end: f64) -> String {
    // What stood on a beam, or rocked as a column before it stood, is told as that.
    let bases: Vec<&BodyVerdict> =
        verdict.iter().filter(|base| verdict.iter().any(|of| of.turns_with.as_ref() == Some(&base.body))).collect();
    let is_on =
        |of: &BodyVerdict, base: &BodyVerdict| of.body == base.body || of.turns_with.as_ref() == Some(&base.body);
    let in_group = |of: &BodyVerdict| bases.iter().any(|base| is_on(of, base));
    let usual = || verdict.iter().filter(|of| of.stood_on.is_none() && !(of.what != Fate::Rocks && in_group(of)));
    let of = |fates: &[Fate]| usual().filter(|of| fates.contains(&of.what)).collect::<Vec<_>>();
    let by_time =
        |a: &&&BodyVerdict, b: &&&BodyVerdict| a.t.unwrap_or(f64::INFINITY).total_cmp(&b.t.unwrap_or(f64::INFINITY));
    let mut parts = Vec::new();
    let total = verdict.len();
    let mut tell = |found: &[&BodyVerdict], what: &str, first: &str| {
        let Some(earliest) = found.iter().min_by(by_time) else { return };
        let count = if found.len() == total { format!("all {total}") } else { found.len().to_string() };
        let of_all = if parts.is_empty() && found.len() < total { format!(" of {total}") } else { String::new() };
        let blocks = if parts.is_empty() { " blocks" } else { "" };
        // "First" is of several.
        if let ([one], "first") = (found, first) {
            parts.push(format!("`{}` {}", one.body, headline::one(scene, one, end)));
            return;
        }
        let way = earliest.way.map_or_else(String::new, |_| format!(" {}", earliest.way_over()));
        let when = match earliest.t {
            Some(t) if t == earliest.start && earliest.what == Fate::Overturned => " from the start".to_owned(),
            t => t.map_or_else(String::new, |t| format!(" at {}", time(t))),
        };
        // One that is different from the rest is named.
        if let ([one], "", false) = (found, first, parts.is_empty()) {
            parts.push(format!("`{}` {what}", one.body));
            return;
        }
        let which = if first.is_empty() { String::new() } else { format!(", {first} `{}`{way}{when}", earliest.body) };
        let ways = if first.is_empty() { String::new() } else { both_ways(found) };
        parts.push(format!("{count}{of_all}{blocks} {what}{ways}{which}"));
    };
    let fell = of(&[Fate::Fell]);
    let collapsed = !fell.is_empty() && of(&[Fate::Fell, Fate::Overturned]).len() > 1;
    if collapsed {
        tell(&of(&[Fate::Fell, Fate::Overturned]), "fell or overturned", "first");
    } else {
        let (columns, alone): (Vec<_>, Vec<_>) =
            of(&[Fate::Overturned]).into_iter().partition(|of| of.overturned_with.is_some());
        let mut falls = vec![(alone, "overturned".to_owned(), "first")];
        for base in columns.iter().filter(|of| of.overturned_with.as_ref() == Some(&of.body)) {
            let column: Vec<_> =
                columns.iter().copied().filter(|of| of.overturned_with.as_ref() == Some(&base.body)).collect();
            let way = base.way_over();
            let when = base.t.map_or_else(String::new, |t| format!(" at {}", time(t)));
            let what = format!("overturned as one column on the base of `{}` {way}{when}", base.body);
            falls.push((column, what, ""));
        }
        // In the order in which they did.
        let first = |of: &[&BodyVerdict]| of.iter().filter_map(|of| of.t).fold(f64::INFINITY, f64::min);
        falls.sort_by(|a, b| first(&a.0).total_cmp(&first(&b.0)));
        falls.iter().for_each(|(these, what, which)| tell(these, what, which));
        tell(&fell, "fell from its place", "first");
    }
    // A single one that overturned has this in its own words.
    let overturned = of(&[Fate::Overturned]);
    let told_alone = |block: &&BodyVerdict| {
        !collapsed
            && block.overturned_with.is_none()
            && overturned.iter().filter(|of| of.overturned_with.is_none()).count() == 1
    };
    let mut off: Vec<&BodyVerdict> =
        overturned.iter().copied().filter(|of| of.fell_off.is_some() && !told_alone(of)).collect();
    while let Some((way, beam)) = off.first().and_then(|of| of.fell_off.clone()) {
        let (same, others) = off.into_iter().partition::<Vec<_>, _>(|of| of.fell_off == Some((way, beam.clone())));
        tell(&same, &format!("then fell off the {} end of `{beam}`", way.word()), "");
        off = others;
    }
    let (tipped, left): (Vec<_>, Vec<_>) = of(&[Fate::Left]).into_iter().partition(|of| of.touches_beam);
    tell(&left, "left their beam", "first");
    tell(&tipped, "tipped over the end of their beam", "first");
    tell(&of(&[Fate::Sunk]), "fell below everything", "first");
    for base in bases.iter().filter(|base| base.what != Fate::Rocks) {
        let column: Vec<_> = verdict.iter().filter(|of| is_on(of, base)).collect();
        let last = column.iter().filter_map(|of| of.rests_from).fold(0.0, f64::max);
        let trembles =
            |of: &&BodyVerdict| matches!(of.going, Some(Going::Trembles | Going::Chatters | Going::Vibrates));
        let then = match () {
            () if column.iter().all(|of| of.rests_from.is_some()) => format!(", came to rest, last at {}", time(last)),
            () if column.iter().any(trembles) => " and still tremble".to_owned(),
            () => " and stand still at the end".to_owned(),
        };
        tell(&column, &format!("rocked as one column on the base of `{}`{then}", base.body), "");
    }
    let stood: Vec<_> = verdict.iter().filter(|of| of.stood_on.is_some()).collect();
    tell(&stood, if stood.len() == 1 { "stood on its beam throughout" } else { "stood on their beams throughout" }, "");
    let resting = || usual().filter(|of| matches!(of.what, Fate::Rests | Fate::Slid) && of.rests_from.is_some());
    let (stood, moved): (Vec<_>, Vec<_>) = resting().partition(|of| of.rests_throughout());
    // What never moved didn't come to rest.
    for resting in [moved, stood] {
        if let Some(last) = resting.iter().filter_map(|of| of.rests_from).reduce(f64::max) {
            let how = how_they_lie(&resting);
            let what = if resting.iter().all(|of| of.rests_throughout()) {
                match moving_base(scene, &resting) {
                    "" => "stood still throughout".to_owned(),
                    on => format!("stood{on} throughout"),
                }
            } else {
                let when = if resting.len() == 1 { " at" } else { ", last at" };
                format!("came to rest{how}{when} {}", time(last))
            };
            tell(&resting, &what, "");
        }
    }
    let (tipping, rocking): (Vec<_>, Vec<_>) = of(&[Fate::Rocks, Fate::Moves])
        .into_iter()
        .filter(|of| of.what == Fate::Rocks || of.tips.is_some())
        .partition(|of| of.tips.is_some());
    // Blocks that turn as one rock together, on the base of the lowest.
    let rocking = rocking.into_iter().filter(|of| !in_group(of));
    let (sat_down, rocking): (Vec<_>, Vec<_>) = rocking.partition(|of| of.stopped_swinging);
    let (unheld, tipping): (Vec<_>, Vec<_>) = tipping.into_iter().partition(|of| of.past_edge.is_some());
    if let [one] = unheld[..] {
        tell(&[one], &format!("is still tipping{PAST_EDGE}"), "");
    } else {
        tell(&unheld, "are still tipping, their mass centres past the edges that they stood on from the start", "");
    }
    tell(&tipping, if tipping.len() == 1 { "is still tipping" } else { "are still tipping" }, "");
    for base in bases.iter().filter(|base| base.what == Fate::Rocks) {
        let column: Vec<_> = verdict.iter().filter(|of| is_on(of, base)).collect();
        let how = if base.column.is_some() { "rock on as one column" } else { "turn as one" };
        tell(&column, &format!("{how} on the base of `{}`", base.body), "");
    }
    let lie = how_they_lie(&rocking);
    tell(&rocking, &format!("{}{lie}", if rocking.len() == 1 { "rocks on" } else { "rock on" }), "");
    for going in Going::ALL {
        let these: Vec<_> = usual().filter(|of| of.going == Some(going)).collect();
        let lie = how_they_lie(&these);
        let what = match these[..] {
            [one] => format!("is {}{lie}{}", going.word(), so_far_in_words(scene, one)),
            // Between flights it may have rolled far to one side and back: the sum of that says nothing beside others.
            _ if these.iter().any(|of| of.has_landed) => format!("are {}{lie}", going.word_of_many()),
            _ => format!("are {}{lie}{}", going.word_of_many(), farthest(&these, way_so_far)),
        };
        tell(&these, &what, "");
    }
    let sliding: Vec<_> = of(&[Fate::Slid]).into_iter().filter(|of| of.rests_from.is_none()).collect();
    let (stopped, sliding): (Vec<_>, Vec<_>) = sliding.into_iter().partition(|of| of.stopped);
    let stand = if stopped.len() == 1 { "stands" } else { "stand" };
    let how = match stopped[..] {
        [one] if one.to_and_fro.is_none() => format!("{} and", slid(scene, one)),
        _ => format!("slid{}, and", farthest(&stopped, slid_by)),
    };
    tell(&stopped, &format!("{how} {stand}{}{}", on_what_moves(&stopped), how_they_lie(&stopped)), "");
    let shaken = |of: &&BodyVerdict| of.to_and_fro.is_some() && (of.is_driven || of.still_from.is_none());
    let (to_and_fro, sliding): (Vec<_>, Vec<_>) = sliding.into_iter().partition(shaken);
    let how = match to_and_fro[..] {
        [one] => format!("slides to and fro, {}", up_to(scene, one, one.to_and_fro.unwrap_or_default())),
        _ => format!("slide to and fro{}", farthest(&to_and_fro, reached)),
    };
    tell(&to_and_fro, &how, "");
    let (driven, sliding): (Vec<_>, Vec<_>) = sliding.into_iter().partition(|of| of.is_driven);
    let how = match driven[..] {
        [one] => slid(scene, one),
        _ => format!("slid{}", farthest(&driven, slid_by)),
    };
    tell(&driven, &format!("{how}{}", moving_base(scene, &driven)), "");
    let (still, sliding): (Vec<_>, Vec<_>) = sliding.into_iter().partition(|of| of.still_from.is_some());
    let how = match sliding[..] {
        [one] => format!("slides on, {} so far", slid(scene, one)),
        _ => format!("slide on{}", farthest(&sliding, slid_by)),
    };
    tell(&sliding, &how, "");
    let of_moves: Vec<_> =
        of(&[Fate::Moves]).into_iter().filter(|of| of.going.is_none() && of.tips.is_none()).collect();
    let (at_end, moving): (Vec<_>, Vec<_>) = of_moves.into_iter().partition(|of| of.still_from.is_some());
    let still: Vec<_> = still.into_iter().chain(at_end).chain(sat_down).collect();
    let stand = if still.len() == 1 { "stands" } else { "stand" };
    tell(&still, &format!("{stand} still at the end{}", how_they_lie(&still)), "");
    tell(&moving, if moving.len() == 1 { "still moves" } else { "still move" }, "");
    let others = || {
        let stayed = verdict.iter().filter(|of| !matches!(of.what, Fate::Fell | Fate::Overturned));
        let stayed = stayed.filter(|of| of.past_edge.is_none());
        stayed.map(|of| {
            let base = bases.iter().find(|base| is_on(of, base)).filter(|base| base.column.is_some());
            base.map_or((of, of.max_phi_over_alpha), |base| (base, base.column))
        })
    };
    let known = others().filter_map(|(of, part)| Some((of, part?)));
    let largest = known.max_by(|a, b| a.1.total_cmp(&b.1));
    let of_all = parts.len() == 1 && others().all(|(_, part)| part.is_some());
    let mut text = parts.join("; ");
    if let Some((of, largest)) = largest.filter(|(_, largest)| *largest >= super::ROCKED) {
        let whose = match of_all {
            true if rocking.is_empty() && matches!(bases[..], [base] if base.column.is_some()) => "the column",
            true => "all",
            false if !fell.is_empty() => "those that neither fell nor overturned",
            false if verdict.iter().any(|of| of.what == Fate::Overturned) => "those that didn't overturn",
            // Those of which it is unknown have none.
            false => "all",
        };
        // What fell there may have flown at a larger angle, as the sentence on a single block says.
        let since = if of.settled_at().is_some() { ", since it could no longer turn over" } else { "" };
        let of = if whose == "the column" { String::new() } else { format!(" (`{}`{since})", of.body) };
        text.push_str(&format!("; largest φ/α of {whose} {}{of}", part(largest)));
    }
    if collapsed { format!("collapsed: {text}") } else { text }
}
