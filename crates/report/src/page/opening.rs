//! On which part of a run plots over time open: where all that moves does so within a small part of it, the whole would be flat lines.

use super::panels::{Line, Panels, Place};
use super::recorder::PageRecorder;

/// What moves for longer than this part of the run is seen in a plot of all of it.
const SMALL: f64 = 0.2;

/// A curve that stays within this part of its range of where it begins, or ends, is flat.
const FLAT: f64 = 0.01;

/// When anything moves for the first and for the last time, s; none where that is more than a fifth of the run, and none of many bodies: the only motions
/// that have plots of their own then are those of ground and supports.
pub(crate) fn moving(recorder: &PageRecorder, panels: &Panels) -> Option<[f64; 2]> {
    if recorder.scenery.is_crowded() {
        return None;
    }
    let (times, borders) = (panels.curves.times(), panels.curves.borders());
    let run = times.last()? - times.first()?;
    let motions = panels.panels.iter().filter(|panel| panel.place == Place::Motion).flat_map(|panel| &panel.lines);
    let spans = motions.filter_map(|line| span(line, if line.of.is_none() { &borders } else { &times }));
    let all = spans.reduce(|[a, b], [from, to]| [a.min(from), b.max(to)]);
    all.filter(|[from, to]| to > from && to - from <= SMALL * run)
}

/// The part of the run that figures of motions show, with some room about what moves, s.
pub(crate) fn shown(recorder: &PageRecorder, panels: &Panels) -> Option<[f64; 2]> {
    let times = panels.curves.times();
    let [from, to] = moving(recorder, panels)?;
    let room = 0.25 * (to - from);
    Some([(from - room).max(*times.first()?), (to + room).min(*times.last()?)])
}

/// When a curve leaves its first value and comes to its last one.
fn span(line: &Line, t: &[f64]) -> Option<[f64; 2]> {
    let finite = || line.y.iter().copied().filter(|y| y.is_finite());
    let (low, high) = finite().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), y| (a.min(y), b.max(y)));
    let (first, last) = (finite().next()?, line.y.last().filter(|y| y.is_finite())?);
    let moved = |y: f64, from: f64| (y - from).abs() > FLAT * (high - low);
    let leaves = line.y.iter().position(|y| moved(*y, first)).filter(|_| high > low)?;
    let comes = line.y.iter().rposition(|y| moved(*y, *last)).unwrap_or(0);
    Some([*t.get(leaves.saturating_sub(1))?, *t.get((comes + 1).min(t.len() - 1))?])
}
