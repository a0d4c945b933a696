//! On which part of a run plots over time open: where all that moves does so within a small part of it, the whole would be flat lines.

use super::panels::{Panels, Place};
use super::recorder::PageRecorder;
use serde::Serialize;

/// What moves for longer than this part of the run is seen in a plot of all of it: what moves for less, with the room about it, leaves half of the
/// axis and more to rest.
const SMALL: f64 = 0.4;

/// Before and after what moves there is room for this part of it.
const ROOM: f64 = 0.25;

/// A curve that stays within this part of its range of where it begins, or ends, is flat.
const FLAT: f64 = 0.01;

/// Curves that keep only the extremes of many steps need this many of these in a part of the run, not to be seen as polygons there.
const SMOOTH: usize = 60;

/// The part of a run on which its plots open, s.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct Opening {
    /// When anything moves for the first and for the last time: from the start of the run on where that is shown.
    pub(crate) moves: [f64; 2],
    /// The same with some room about it.
    pub(crate) shown: [f64; 2],
    /// Of what moves on ground or supports, which may go on moving: beside what.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) beside: Option<&'static str>,
}

/// Where the plots open; none where something moves for more than two fifths of the run, and none of many bodies: the only motions that have plots of their own
/// then are those of ground and supports. How ground or supports move counts only where nothing moves on them. None, too, where the curves of a long run, or of many blocks, are
/// too coarse to be seen from near.
pub(crate) fn opening(recorder: &PageRecorder, panels: &Panels) -> Option<Opening> {
    if recorder.scenery.is_crowded() {
        return None;
    }
    let (times, borders) = (panels.curves.times(), panels.curves.borders());
    let run = times.last()? - times.first()?;
    let motions = || panels.panels.iter().filter(|panel| panel.place == Place::Motion);
    let is_beside = recorder.scenery.bases != [None; 2] && motions().any(|panel| !panel.is_prescribed());
    let motions = motions().filter(|panel| !(is_beside && panel.is_prescribed())).flat_map(|panel| &panel.lines);
    let spans = motions.filter_map(|line| span(&line.y, if line.of.is_none() { &borders } else { &times }));
    let both = |[a, b]: [f64; 2], [from, to]: [f64; 2]| [a.min(from), b.max(to)];
    let all = spans.reduce(both);
    let moves = all.filter(|[from, to]| to > from && to - from <= SMALL * run)?;
    // What pushes before something moves is seen to, unless contacts tremble on and on.
    let forces = panels.forces.iter().flatten().flat_map(|forces| [&forces.normal, &forces.tangential]);
    let pushed = forces.filter_map(|force| span(force, &borders)).fold(moves, both);
    let seen = if pushed[1] - pushed[0] <= SMALL * run { pushed } else { moves };
    let room = ROOM * (moves[1] - moves[0]);
    let shown = [(seen[0] - room).max(*times.first()?), (seen[1] + room).min(*times.last()?)];
    // What moves from the start on takes a while to be seen to.
    let moves = if shown[0] <= *times.first()? { [*times.first()?, moves[1]] } else { moves };
    let parts = borders.windows(2).filter(|ends| ends[1] > shown[0] && ends[0] < shown[1]).count();
    if panels.curves.is_thinned() && parts < SMOOTH {
        return None;
    }
    Some(Opening { moves, shown, beside: is_beside.then(|| recorder.scenery.base()) })
}

/// When a curve leaves its first value and comes to its last one.
fn span(y: &[f64], t: &[f64]) -> Option<[f64; 2]> {
    let finite = || y.iter().copied().filter(|y| y.is_finite());
    let (low, high) = finite().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), y| (a.min(y), b.max(y)));
    let (first, last) = (finite().next()?, y.last().filter(|y| y.is_finite())?);
    let moved = |y: f64, from: f64| (y - from).abs() > FLAT * (high - low);
    let leaves = y.iter().position(|y| moved(*y, first)).filter(|_| high > low)?;
    let comes = y.iter().rposition(|y| moved(*y, *last)).unwrap_or(0);
    Some([*t.get(leaves.saturating_sub(1))?, *t.get((comes + 1).min(t.len() - 1))?])
}
