//! Contacts whose forces equilibrium alone doesn't decide: rigid bodies then bear one of many sets of forces, the one that the solver comes to.
//!
//! Of bodies that touch each other directly or by others, each has three equations. The unknowns of a pair:
//!
//! - its normal forces: one if one of its points presses, two if more do, or if sides lie flat on each other, so that others could;
//! - one tangential force, if the pair has friction and a point sticks. Where all slide, friction follows from the normal forces.
//!
//! How a pair's tangential force is shared by its points is open wherever two of them stick: their tangential forces have one line of
//! action, so that equilibrium knows only their sum. On a beam, whose top fibre moves by its own amount at each point, its vibrations decide: the shares
//! jump from foot to foot with them, and tell no more of the block.
//!
//! With more unknowns than equations only sums over some of the contacts follow. Of more than two points of one pair only the
//! resultant does, but for those on a beam, which bends as they press. Contacts with duration have springs, whose forces follow from
//! the motion: they leave no such choice.

use super::curves::{Curves, ForceCurve};
use super::outline::Outline;
use super::recorder::{BLOCK_FRAME, PageRecorder};
use super::scenery::ContactDrawn;
use teeter_integrator::ContactState;

/// Times at which the contacts are looked at.
const LOOKS: usize = 50;

/// Contacts are told if they are so in this part of these times: not for a touch in passing.
const LEAST: f64 = 0.1;

/// So many looks in a row are a rest.
const REST: usize = 2;

/// So are looks apart from each other in more than this part of the run.
const OFTEN: f64 = 0.2;

/// What equilibrium leaves open of the forces of a contact.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Redundant {
    /// Whether all of its forces are one of many sets, over a part of the run.
    pub(crate) forces: bool,
    /// The same at the end of the run.
    pub(crate) at_end: bool,
    /// Whether its points share their tangential force in one of many ways, over a part of the run.
    pub(crate) shares: bool,
}

impl Redundant {
    /// What a figure says beside the tangential forces, or the normal ones.
    pub(super) fn note(self, tangential: bool) -> Option<&'static str> {
        match self {
            Self { shares: true, forces: false, .. } if tangential => {
                Some("sum over the points, as equilibrium leaves open how those that stick share it")
            }
            Self { shares: true, .. } if tangential => {
                Some("sum over the points; one of many equilibria of rigid bodies")
            }
            Self { forces: true, .. } => Some(NOTE),
            _ => None,
        }
    }
}

/// What is open of the forces, by contacts.
pub(super) fn redundant(recorder: &PageRecorder, curves: &Curves, forces: &[Option<ForceCurve>]) -> Vec<Redundant> {
    let borders = curves.borders();
    let contacts = &recorder.scenery.contacts;
    let buckets = forces.iter().flatten().map(|forces| forces.state.len()).max().unwrap_or(0);
    let Some(last) = buckets.checked_sub(1) else { return vec![Redundant::default(); contacts.len()] };
    let states = |contact: &ContactDrawn, bucket: usize| {
        let own = forces[contact.first..contact.first + contact.points.len()].iter().flatten();
        own.filter_map(move |forces| forces.usual.get(bucket).copied()).collect::<Vec<_>>()
    };
    let buckets: Vec<usize> = (1..=LOOKS.min(buckets)).map(|look| look * last / LOOKS.min(buckets)).collect();
    let shares = |contact: &ContactDrawn, bucket: usize| {
        let states = states(contact, bucket);
        let sticking = states.iter().filter(|state| **state == ContactState::Stick).count();
        let pressing = states.iter().filter(|state| **state != ContactState::Open).count();
        // The fibre of a beam takes one foot to the limit of friction while the other holds the block, and so does the sway of a block on springs.
        let sharing =
            if (contact.beam.is_some() || contact.has_duration) && sticking > 0 { pressing } else { sticking };
        sharing > 1 && contact.has_friction
    };
    let looks: Vec<Vec<bool>> = buckets
        .iter()
        .map(|&bucket| {
            let states: Vec<Vec<ContactState>> = contacts.iter().map(|contact| states(contact, bucket)).collect();
            let pressing = |of: &Vec<ContactState>| of.iter().filter(|state| **state != ContactState::Open).count();
            let points: Vec<usize> = states.iter().map(pressing).collect();
            let sticks = |(contact, of): (&ContactDrawn, &Vec<ContactState>)| {
                contact.has_friction && of.contains(&ContactState::Stick)
            };
            let stick: Vec<bool> = contacts.iter().zip(&states).map(sticks).collect();
            let flat = flat(recorder, borders.get(bucket + 1).copied().unwrap_or(f64::INFINITY), &points);
            at(recorder, &points, &flat, &stick)
        })
        .collect();
    let at_end = |contact: usize| looks.last().is_some_and(|look| look[contact]);
    // A short rest, as before a column is shaken, is enough for a square wave between its feet.
    let often = |count: usize| count as f64 >= LEAST * looks.len() as f64 && count > 0;
    let of = |contact: usize| {
        let shared: Vec<bool> = buckets.iter().map(|bucket| shares(&contacts[contact], *bucket)).collect();
        Redundant {
            forces: often(looks.iter().filter(|look| look[contact]).count()),
            at_end: at_end(contact),
            shares: is_rest(&shared),
        }
    };
    (0..contacts.len()).map(of).collect()
}

/// Whether looks, of which some are so, are no touch in passing: several in a row, or many in all.
fn is_rest(looks: &[bool]) -> bool {
    let count = looks.iter().filter(|is_so| **is_so).count();
    longest(looks.iter().copied()) >= REST || count as f64 >= OFTEN * looks.len().max(1) as f64
}

/// How many looks in a row are so at most.
fn longest(looks: impl Iterator<Item = bool>) -> usize {
    let count = |row: &mut usize, is_so: bool| {
        *row = if is_so { *row + 1 } else { 0 };
        Some(*row)
    };
    looks.scan(0, count).max().unwrap_or(0)
}

/// Of contacts between two blocks that press: whether they lie flat on each other, in the picture at or before `t` (s).
fn flat(recorder: &PageRecorder, t: f64, pressing: &[usize]) -> Vec<bool> {
    let (blocks, contacts) = (&recorder.scenery.blocks, &recorder.scenery.contacts);
    let before = recorder.kept.frames.rows().take_while(|(at, _)| *at <= t).last();
    let Some((_, row)) = before.or_else(|| recorder.kept.frames.rows().next()) else {
        return vec![false; contacts.len()];
    };
    let poses: Vec<[f64; 3]> =
        row.chunks_exact(BLOCK_FRAME).take(blocks.len()).map(|pose| [pose[0], pose[1], pose[2]]).collect();
    let of = |(contact, points): (&ContactDrawn, &usize)| {
        let Some(other) = contact.other.filter(|_| *points > 0) else { return false };
        let outline = |block: usize| Outline::of(&blocks[block], poses[block]);
        let (one, other) = (outline(contact.block), outline(other));
        contact.points.iter().any(|point| {
            let ([x, y, phi], corner) = (poses[point.block], blocks[point.block].corners.get(point.corner));
            let (sin, cos) = phi.sin_cos();
            corner.is_some_and(|[a, b]| one.lies_flat_on(&other, [x + cos * a - sin * b, y + sin * a + cos * b]))
        })
    };
    contacts.iter().zip(pressing).map(of).collect()
}

/// The same at one time, with how many points of each contact press, whether its sides lie flat on each other, and whether one sticks.
fn at(recorder: &PageRecorder, pressing: &[usize], flat: &[bool], stick: &[bool]) -> Vec<bool> {
    let (blocks, contacts) = (&recorder.scenery.blocks, &recorder.scenery.contacts);
    // The bodies of each group of touching ones have one number.
    let mut group: Vec<usize> = (0..blocks.len()).collect();
    let free = |block: usize| Some(block).filter(|block| !blocks[*block].driven);
    let rigid = |contact: &ContactDrawn| [free(contact.block), contact.other.and_then(free)];
    let all = || contacts.iter().zip(pressing).zip(flat.iter().zip(stick));
    let touching = || all().filter(|((contact, points), _)| **points > 0 && !contact.has_duration);
    for ((contact, _), _) in touching() {
        if let [Some(a), Some(b)] = rigid(contact) {
            let (from, to) = (group[a].max(group[b]), group[a].min(group[b]));
            group.iter_mut().filter(|number| **number == from).for_each(|number| *number = to);
        }
    }
    let mut surplus: Vec<isize> = vec![0; blocks.len()];
    (0..blocks.len()).filter_map(free).for_each(|block| surplus[group[block]] -= 3);
    let of = |contact: &ContactDrawn| rigid(contact).into_iter().flatten().next().map(|block| group[block]);
    for ((contact, points), (flat, stick)) in touching() {
        if let Some(group) = of(contact) {
            surplus[group] += if *points > 1 || *flat { 2 } else { 1 } + isize::from(*stick);
        }
    }
    let one = |(contact, points): (&ContactDrawn, &usize)| {
        let pressed = *points > 0 && !contact.has_duration;
        pressed && of(contact).is_some_and(|group| (*points > 2 && contact.beam.is_none()) || surplus[group] > 0)
    };
    contacts.iter().zip(pressing).map(one).collect()
}

/// What is said of them.
pub(super) const NOTE: &str = "one of many equilibria of rigid bodies";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_looks_apart_are_no_rest() {
        let is_rest = |looks: [u8; 12]| is_rest(&looks.map(|look| look == 1));
        assert!(!is_rest([1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0]));
        assert!(is_rest([0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0]));
        assert!(is_rest([1, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1]), "every third");
        assert!(!is_rest([0; 12]));
    }
}
