//! When a load jumps within a step, or rises as steeply as if it did.

use super::MoreauJeanLocated;
use crate::{Model, Part, StepSpan};

/// A load jumps where it changes by more than this part of its size, also a step before and after: the rest is rounding.
const ROUNDING: f64 = 1e-9;

/// Breaks that are looked at in the length of a step. A table with more rows than that in a step isn't followed by its steps anyway.
const MOST_BREAKS: f64 = 64.0;

/// A rise that lasts longer than this part of a step is slow: the mean of the step misses little of it.
const LONGEST_RISE: f64 = 0.5;

/// One that is shorter than this part of a step is a jump at its end.
const SHORTEST_RISE: f64 = 1e-3;

/// A rise is steep if the load changes by more than so many times what it changes before and after it, within once, twice and four times
/// as long. The values of a record, which are as far apart everywhere, are hardly ever.
const STEEPNESS: f64 = 4.0;

/// A rise that changes the loads by less than this part of their size isn't looked at, nor the last digit of a table.
const NOTABLE: f64 = 1e-2;

/// So many rises are held about a step; further ones are not looked at.
const MOST_RISES: usize = 16;

/// A time in which a load changes at once, s; of a jump both ends are the same.
#[derive(Clone, Copy, Debug)]
struct Rise {
    begin: f64,
    end: f64,
}

/// The rises of loads about the time of a step. They depend on the loads and the size of the steps alone, not on where a run has begun, as
/// long as the loads have no more breaks than are looked at.
#[derive(Debug, Default)]
pub(super) struct Rises {
    /// In the order of their ends.
    found: Vec<Rise>,
    /// In steps of this size, s.
    step: f64,
    /// All breaks from here on have been looked at, s,
    from: f64,
    /// up to here.
    until: f64,
    /// Whether there is a break there.
    at_break: bool,
    /// The loads at three times; memory.
    loads: [Vec<f64>; 3],
}

impl Rises {
    /// Forgets all, and takes memory for a model.
    pub(super) fn start<const D: usize>(&mut self, model: &Model<D>) {
        self.found.clear();
        self.found.reserve(MOST_RISES);
        self.step = 0.0;
        self.loads.iter_mut().for_each(|loads| loads.reserve(model.size().v));
    }

    /// Looks at the breaks about a step, or the rest of one.
    fn look_at<const D: usize>(&mut self, model: &Model<D>, rest: &StepSpan, step: f64) {
        // A rise that ends in the step has begun later than that.
        let early = rest.start - step;
        if !(self.step == step && self.from <= early && self.until > rest.start) {
            self.found.clear();
            (self.step, self.from, self.until, self.at_break) = (step, early, early, false);
        }
        if self.found.first().is_some_and(|rise| rise.end < early) {
            self.found.retain(|rise| rise.end >= early);
            self.from = early;
        }
        // A break at the end of a step is between two steps, whatever rounding says.
        let late = rest.end - nudge(rest.end);
        let mut left = (MOST_BREAKS * ((late - self.until) / step).ceil().max(1.0)) as usize;
        while self.until < late {
            if left == 0 {
                (self.until, self.at_break) = (late, false);
                return;
            }
            left -= 1;
            let loaded = model.parts().iter().filter(|part| part.traits.loaded);
            let (begin, end) =
                (self.until, loaded.map(|part| part.system.next_break(self.until)).fold(f64::INFINITY, f64::min));
            let is_short = self.at_break && end - begin <= LONGEST_RISE * step;
            if is_short && self.found.len() < MOST_RISES && self.is_steep(model, [begin, end], step) {
                self.found.push(Rise { begin, end });
            }
            if end < f64::INFINITY && self.found.len() < MOST_RISES && self.is_jump(model, end, step) {
                self.found.push(Rise { begin: end, end });
            }
            (self.until, self.at_break) = (end, true);
        }
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

    /// Whether a load isn't the same on both sides of a time `t` (s), in comparison with what it is a `step` (s) before and after.
    fn is_jump<const D: usize>(&mut self, model: &Model<D>, t: f64, step: f64) -> bool {
        let nudge = nudge(t);
        model.parts().iter().filter(|part| part.traits.loaded).any(|part| {
            let mut size = 0.0_f64;
            for [early, late] in [[t - step, t + step], [t - nudge, t + nudge]] {
                self.take(0, part, early);
                self.take(1, part, late);
                size = size.max(self.largest([0, 1]));
            }
            let [before, after, _] = &self.loads;
            before.iter().zip(after).any(|(before, after)| (after - before).abs() > ROUNDING * size)
        })
    }

    /// Whether a load rises steeply between two breaks, or falls.
    fn is_steep<const D: usize>(&mut self, model: &Model<D>, [begin, end]: [f64; 2], step: f64) -> bool {
        model.parts().iter().filter(|part| part.traits.loaded).any(|part| {
            self.take(0, part, begin - step);
            self.take(1, part, end + step);
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
        })
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
