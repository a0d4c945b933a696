//! When a load jumps within a step, or rises as steeply as if it did.

use super::MoreauJeanLocated;
use crate::{Model, Part, StepSpan};

/// A load jumps where it changes by more than this part of its size, also a step before and after: the rest is rounding.
const ROUNDING: f64 = 1e-9;

/// Breaks of a load that are looked at in a step, as counted from t = 0. A table with more rows than that in a step isn't followed by its steps
/// anyway.
const MOST_BREAKS: u32 = 64;

/// A rise that lasts longer than this part of a step is slow: the mean of the step misses little of it.
const LONGEST_RISE: f64 = 0.5;

/// One that is shorter than this part of a step is a jump at its end.
const SHORTEST_RISE: f64 = 1e-3;

/// A rise is steep if the load changes by more than so many times what it changes before and after it, within once, twice and four times
/// as long. The values of a record, which are as far apart everywhere, are hardly ever.
const STEEPNESS: f64 = 4.0;

/// A rise that changes the loads by less than this part of their size isn't looked at, nor the last digit of a table.
const NOTABLE: f64 = 1e-2;

/// Room for so many rises is reserved at the start.
const USUAL_RISES: usize = 32;

/// A time in which a load on a part changes at once, s; of a jump both ends are the same.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rise {
    begin: f64,
    end: f64,
}

/// How far the breaks of one load have been looked at.
#[derive(Clone, Copy, Debug)]
struct Cursor {
    /// The part of the model.
    part: usize,
    /// The number of its load.
    load: usize,
    /// Up to this time, s.
    until: f64,
    /// Whether there is a break there.
    at_break: bool,
    /// Breaks up to there in its step, as counted from t = 0.
    breaks: u32,
}

/// The rises of loads about the time of a step, each found among the breaks of one load, whatever the others do. They depend on the loads and
/// the size of the steps alone, not on where a run has begun.
#[derive(Debug, Default)]
pub(super) struct Rises {
    found: Vec<Rise>,
    /// In steps of this size, s.
    step: f64,
    /// All that end from here on have been found, s.
    from: f64,
    /// Of each load.
    cursors: Vec<Cursor>,
    /// The loads on a part at three times; memory.
    loads: [Vec<f64>; 3],
}

impl Rises {
    /// Forgets all, and takes memory for a model.
    pub(super) fn start<const D: usize>(&mut self, model: &Model<D>) {
        self.found.clear();
        self.cursors.clear();
        self.step = 0.0;
        self.cursors.reserve(loaded(model).map(|(_, part)| part.system.load_count()).sum());
        self.found.reserve(if loaded(model).next().is_some() { USUAL_RISES } else { 0 });
        let largest = loaded(model).map(|(_, part)| part.v.len()).max().unwrap_or(0);
        self.loads.iter_mut().for_each(|loads| loads.reserve(largest));
    }

    /// Looks at the breaks about a step, or the rest of one.
    fn look_at<const D: usize>(&mut self, model: &Model<D>, rest: &StepSpan, step: f64) {
        // A rise that ends in the step has begun later than that.
        let early = rest.start - step;
        if self.step != step || self.from > early {
            // From the end of a whole step on, so that as many breaks are looked at wherever a run begins.
            (self.step, self.from) = (step, (whole_steps(early, step) - 1.0) * step);
            self.found.clear();
            self.cursors.clear();
            for (part, count) in loaded(model).map(|(index, part)| (index, part.system.load_count())) {
                let at = |load| Cursor { part, load, until: self.from, at_break: false, breaks: 0 };
                self.cursors.extend((0..count).map(at));
            }
        }
        if self.found.iter().any(|rise| rise.end < early) {
            self.found.retain(|rise| rise.end >= early);
            self.from = early;
        }
        // A break at the end of a step is between two steps, whatever rounding says.
        let late = rest.end - nudge(rest.end);
        for at in 0..self.cursors.len() {
            while self.cursors[at].until < late {
                self.cursors[at] = self.look_on(&model.parts()[self.cursors[at].part], self.cursors[at]);
            }
        }
    }

    /// Looks at the next break of a load on a part.
    fn look_on<const D: usize>(&mut self, part: &Part<D>, from: Cursor) -> Cursor {
        let (step, begin, end) = (self.step, from.until, part.system.next_load_break(from.load, from.until));
        if end == f64::INFINITY {
            return Cursor { until: end, ..from };
        }
        let steps = whole_steps(begin, step);
        let is_same_step = end <= steps * step;
        if is_same_step && from.breaks == MOST_BREAKS {
            return Cursor { until: steps * step, at_break: false, breaks: 0, ..from };
        }
        let is_short = from.at_break && end - begin <= LONGEST_RISE * step;
        // Loads with one signal have the same breaks.
        let (rise, jump) = (Rise { begin, end }, Rise { begin: end, end });
        if is_short && !self.found.contains(&rise) && self.is_steep(part, [begin, end]) {
            self.found.push(rise);
        }
        if !self.found.contains(&jump) && self.is_jump(part, end) {
            self.found.push(jump);
        }
        Cursor { until: end, at_break: true, breaks: if is_same_step { from.breaks + 1 } else { 1 }, ..from }
    }

    /// Leaves the loads on a part at a time (s) in one of the three.
    fn take<const D: usize>(&mut self, at: usize, part: &Part<D>, t: f64) {
        let loads = &mut self.loads[at];
        loads.clear();
        loads.resize(part.v.len(), 0.0);
        part.system.load(t, loads);
    }

    /// The largest of the loads at two of the times.
    fn largest(&self, [one, other]: [usize; 2]) -> f64 {
        self.loads[one].iter().chain(&self.loads[other]).fold(0.0, |largest, load| largest.max(load.abs()))
    }

    /// Whether a load on a part isn't the same on both sides of a time `t` (s), in comparison with what it is a step before and after.
    fn is_jump<const D: usize>(&mut self, part: &Part<D>, t: f64) -> bool {
        let (step, nudge) = (self.step, nudge(t));
        let mut size = 0.0_f64;
        for [early, late] in [[t - step, t + step], [t - nudge, t + nudge]] {
            self.take(0, part, early);
            self.take(1, part, late);
            size = size.max(self.largest([0, 1]));
        }
        let [before, after, _] = &self.loads;
        before.iter().zip(after).any(|(before, after)| (after - before).abs() > ROUNDING * size)
    }

    /// Whether a load on a part rises steeply between two breaks, or falls.
    fn is_steep<const D: usize>(&mut self, part: &Part<D>, [begin, end]: [f64; 2]) -> bool {
        self.take(0, part, begin - self.step);
        self.take(1, part, end + self.step);
        let size = self.largest([0, 1]);
        self.take(0, part, begin);
        self.take(1, part, end);
        let size = size.max(self.largest([0, 1]));
        let [before, _, beside] = &mut self.loads;
        beside.clone_from(before);
        let mut any = self.keep_those_that_rise(|[before, after, _]| (after - before).abs() > NOTABLE * size);
        for away in [1.0, 2.0, 4.0].map(|times| times * (end - begin)) {
            if any {
                self.take(2, part, begin - away);
                any = self.keep_those_that_rise(|[before, after, early]| {
                    (after - before).abs() > STEEPNESS * (before - early).abs()
                });
            }
            if any {
                self.take(2, part, end + away);
                any = self.keep_those_that_rise(|[before, after, late]| {
                    (after - before).abs() > STEEPNESS * (late - after).abs()
                });
            }
        }
        any
    }

    /// Lets the others of the loads end as they began; whether any is left. They are given at the beginning, at the end, and at the third
    /// time.
    fn keep_those_that_rise(&mut self, rises: impl Fn([f64; 3]) -> bool) -> bool {
        let [before, after, beside] = &mut self.loads;
        let mut any = false;
        for ((before, after), beside) in before.iter().zip(after).zip(beside) {
            if rises([*before, *after, *beside]) {
                any = true;
            } else {
                *after = *before;
            }
        }
        any
    }
}

/// The parts of a model that have loads.
fn loaded<const D: usize>(model: &Model<D>) -> impl Iterator<Item = (usize, &Part<D>)> {
    model.parts().iter().enumerate().filter(|(_, part)| part.traits.loaded)
}

/// The number of whole steps that end at a time (s) or are the first to end after it: of all times in (n − 1, n] `step` it is n, as these products
/// are rounded.
fn whole_steps(t: f64, step: f64) -> f64 {
    let steps = (t / step).ceil();
    match () {
        () if (steps - 1.0) * step >= t => steps - 1.0,
        () if steps * step < t => steps + 1.0,
        () => steps,
    }
}

/// What rounding makes of a time, s.
fn nudge(t: f64) -> f64 {
    8.0 * f64::EPSILON * t.abs()
}

impl<const D: usize> MoreauJeanLocated<D> {
    /// The time within the rest of a step, further from its ends than `margin` (s), at which it is divided first because a load jumps there,
    /// or rises steeply up to there or from there on, s. What sticks with the mean of the load may slide with what it is after the rise.
    /// Prescribed motion isn't looked at: its velocities are means about the ends of steps, which know of no jump.
    pub(super) fn find_jump(&mut self, model: &Model<D>, rest: &StepSpan, step: f64, margin: f64) -> Option<f64> {
        self.rises.look_at(model, rest, step);
        let margin = margin.max(nudge(rest.end.abs().max(rest.start.abs())));
        let ends = |rise: &Rise| {
            let lasts = rise.end - rise.begin > SHORTEST_RISE * step;
            [Some(rise.begin).filter(|_| lasts), Some(rise.end)].into_iter().flatten()
        };
        let times = self.rises.found.iter().flat_map(ends);
        times.filter(|t| (t - rest.start).min(rest.end - t) > margin).min_by(f64::total_cmp)
    }
}
