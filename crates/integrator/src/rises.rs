//! When loads and prescribed accelerations jump, or rise as steeply as if they did.

use crate::{Model, Part, StepSpan};

/// A load jumps where it changes by more than this part of its size, also a step before and after: the rest is rounding.
const ROUNDING: f64 = 1e-9;

/// Breaks that are looked at in a step, as counted from t = 0. A table with more rows than that in a step isn't followed by its steps
/// anyway.
const MOST_BREAKS: u32 = 64;

/// A rise that lasts longer than this part of a step is slow: the mean of the step misses little of it.
const LONGEST_RISE: f64 = 0.5;

/// One that is shorter than this part of a step is a jump at its end.
const SHORTEST_RISE: f64 = 1e-3;

/// A rise is steep if it is more than so many times what changes before and after it, within once, twice and four times as long. The
/// values of a record, which are as far apart everywhere, are hardly ever.
const STEEPNESS: f64 = 4.0;

/// A prescribed acceleration jumps if it changes by more than so many times what it changes within half a step, and a step, before and
/// after: the derivative of a table of velocities finer than the step jumps at each row.
const JUMP: f64 = 2.0;

/// What changes by less than this part of its size isn't looked at, nor the last digit of a table.
const NOTABLE: f64 = 1e-2;

/// Room for so many rises is reserved at the start.
const USUAL_RISES: usize = 32;

/// What may rise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Load,
    Acceleration,
}

/// A time in which a load or a prescribed acceleration of a part changes at once, s; of a jump both ends are the same.
#[derive(Clone, Copy, Debug)]
struct Rise {
    begin: f64,
    end: f64,
    /// The acceleration, if it is none of loads.
    of: Option<Acceleration>,
}

/// A prescribed acceleration that rises.
#[derive(Clone, Copy, Debug)]
struct Acceleration {
    part: usize,
    /// Among the part's velocities.
    component: usize,
    /// m/s² or rad/s².
    by: f64,
}

impl Rise {
    /// By how much the mean over the `step` (s) about `t` (s) of a velocity that begins to rise here, by 1 m/s², is more than that at `t`, s.
    fn smear(&self, t: f64, step: f64) -> f64 {
        let (lasts, middle) = (self.end - self.begin, 0.5 * (self.begin + self.end));
        let velocity = |t: f64| match t {
            t if t <= self.begin => 0.0,
            t if t >= self.end => t - middle,
            t => (t - self.begin).powi(2) / (2.0 * lasts),
        };
        let way = |t: f64| match t {
            t if t <= self.begin => 0.0,
            t if t >= self.end => 0.5 * (t - middle).powi(2) + lasts * lasts / 24.0,
            t => (t - self.begin).powi(3) / (6.0 * lasts),
        };
        (way(t + 0.5 * step) - way(t - 0.5 * step)) / step - velocity(t)
    }

    /// Times of before and after, between which nothing else happens, s.
    fn sides(&self) -> [f64; 2] {
        let nudge = nudge(self.end);
        if self.begin < self.end {
            [self.begin, self.begin.max(self.end - nudge)]
        } else {
            [self.begin - nudge, self.end + nudge]
        }
    }
}

/// The rises about the time of a step. They depend on loads, motions and the size of the steps alone, not on where a run has begun.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rises {
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
    /// Breaks in the step before that.
    breaks: u32,
    /// What may rise, before, after, and at another time; and its size; memory.
    values: [Vec<f64>; 4],
}

const BEFORE: usize = 0;
const AFTER: usize = 1;
const BESIDE: usize = 2;

impl Rises {
    /// Forgets all, and takes memory for a model.
    pub(crate) fn start<const D: usize>(&mut self, model: &Model<D>) {
        self.found.clear();
        self.found.reserve(USUAL_RISES);
        self.step = 0.0;
        let largest = that_may_rise(model).map(|(_, part)| part.v.len()).max().unwrap_or(0);
        self.values.iter_mut().for_each(|values| values.reserve(largest));
    }

    /// Looks at the breaks about a time from `rest.start` to `rest.end`, in steps of this size (s).
    pub(crate) fn look_at<const D: usize>(&mut self, model: &Model<D>, rest: &StepSpan, step: f64) {
        // Means reach half a step back, and a rise that ends there may have begun half a step before.
        let early = rest.start - 1.5 * step;
        if !(self.step == step && self.from <= early && self.until > rest.start) {
            self.found.clear();
            // From a whole step on, so that as many breaks are looked at wherever a run begins.
            let from = (early / step).floor() * step;
            (self.step, self.from, self.until, self.at_break, self.breaks) = (step, from, from, false, 0);
        }
        if self.found.first().is_some_and(|rise| rise.end < early) {
            self.found.retain(|rise| rise.end >= early);
            self.from = early;
        }
        let late = rest.end + 0.5 * step;
        while self.until <= late {
            let in_step = (self.until / step).floor();
            if self.breaks == MOST_BREAKS {
                (self.until, self.at_break, self.breaks) = ((in_step + 1.0) * step, false, 0);
                continue;
            }
            let breaks = that_may_rise(model).map(|(_, part)| part.system.next_break(self.until));
            let (begin, end) = (self.until, breaks.fold(f64::INFINITY, f64::min));
            self.breaks = if (end / step).floor() == in_step { self.breaks + 1 } else { 0 };
            let is_short = self.at_break && end - begin <= LONGEST_RISE * step;
            for (index, part) in that_may_rise(model) {
                if is_short {
                    self.enter_rises(index, part, [begin, end], step);
                }
                if end < f64::INFINITY {
                    self.enter_rises(index, part, [end, end], step);
                }
            }
            (self.until, self.at_break) = (end, true);
        }
    }

    /// Enters what of a part jumps, or rises steeply, there.
    fn enter_rises<const D: usize>(&mut self, index: usize, part: &Part<D>, [begin, end]: [f64; 2], step: f64) {
        let rise = Rise { begin, end, of: None };
        if part.traits.loaded {
            let rises = match begin == end {
                true => self.load_jumps(part, end, step),
                false => self.is_steep(part, Kind::Load, &rise, step),
            };
            if rises {
                self.found.push(rise);
            }
        }
        if part.is_driven() && self.is_steep(part, Kind::Acceleration, &rise, step) {
            let [before, after, ..] = &self.values;
            let rising = part.traits.driven.iter().filter(|k| after[**k] != before[**k]);
            self.found.extend(rising.map(|&component| {
                let by = after[component] - before[component];
                Rise { of: Some(Acceleration { part: index, component, by }), ..rise }
            }));
        }
    }

    /// Leaves loads or accelerations of a part at a time (s) in one of the vectors; whether they are known.
    fn take<const D: usize>(&mut self, at: usize, part: &Part<D>, kind: Kind, t: f64) -> bool {
        let values = &mut self.values[at];
        values.clear();
        values.resize(part.v.len(), 0.0);
        match kind {
            Kind::Load => part.system.load(t, values),
            Kind::Acceleration => return part.system.drive_rate(t, values),
        }
        true
    }

    /// Whether a load isn't the same on both sides of a time `t` (s), in comparison with what the largest is there and a `step` (s) before and
    /// after.
    fn load_jumps<const D: usize>(&mut self, part: &Part<D>, t: f64, step: f64) -> bool {
        let nudge = nudge(t);
        let mut size = 0.0_f64;
        for [early, late] in [[t - step, t + step], [t - nudge, t + nudge]] {
            self.take(BEFORE, part, Kind::Load, early);
            self.take(AFTER, part, Kind::Load, late);
            size = self.values[..BESIDE].iter().flatten().fold(size, |largest, load| largest.max(load.abs()));
        }
        let [before, after, ..] = &self.values;
        before.iter().zip(after).any(|(before, after)| (after - before).abs() > ROUNDING * size)
    }

    /// Whether something rises, or falls, by a notable part of its size, and more than beside that time. Leaves before and after of those
    /// components; the others are equal there.
    fn is_steep<const D: usize>(&mut self, part: &Part<D>, kind: Kind, rise: &Rise, step: f64) -> bool {
        let Rise { begin, end, .. } = *rise;
        let [before, after] = rise.sides();
        if !self.take(BEFORE, part, kind, before) || !self.take(AFTER, part, kind, after) {
            return false;
        }
        let is_notable = |[before, after, _, beside]: [f64; 4]| {
            (after - before).abs() > NOTABLE * before.abs().max(after.abs()).max(beside)
        };
        let [before, _, beside, size] = &mut self.values;
        beside.clone_from(before);
        size.clear();
        size.resize(before.len(), 0.0);
        if !self.keep_those_that_rise(is_notable) {
            return false;
        }
        for beside in [begin - step, end + step] {
            self.take(BESIDE, part, kind, beside);
            let [_, _, beside, size] = &mut self.values;
            size.iter_mut().zip(beside).for_each(|(size, beside)| *size = size.max(beside.abs()));
        }
        let mut any = self.keep_those_that_rise(is_notable);
        let (steepness, away): (_, &[f64]) = match end - begin {
            0.0 => (JUMP, &[0.5 * step, step]),
            lasts => (STEEPNESS, &[lasts, 2.0 * lasts, 4.0 * lasts]),
        };
        for away in away {
            if any {
                self.take(BESIDE, part, kind, begin - away);
                any = self.keep_those_that_rise(|[before, after, early, _]| {
                    (after - before).abs() > steepness * (before - early).abs()
                });
            }
            if any {
                self.take(BESIDE, part, kind, end + away);
                any = self.keep_those_that_rise(|[before, after, late, _]| {
                    (after - before).abs() > steepness * (late - after).abs()
                });
            }
        }
        any
    }

    /// Lets all others end as they began; whether any is left.
    fn keep_those_that_rise(&mut self, rises: impl Fn([f64; 4]) -> bool) -> bool {
        let [before, after, beside, size] = &mut self.values;
        let mut any = false;
        for (((before, after), beside), size) in before.iter().zip(after).zip(beside).zip(size) {
            if rises([*before, *after, *beside, *size]) {
                any = true;
            } else {
                *after = *before;
            }
        }
        any
    }

    /// The first time within the rest of a step, further from its ends than `margin` (s), at which something jumps, or rises steeply up to
    /// there or from there on, s.
    pub(crate) fn first_within(&self, rest: &StepSpan, margin: f64) -> Option<f64> {
        let margin = margin.max(nudge(rest.end.abs().max(rest.start.abs())));
        let ends = |rise: &Rise| {
            let lasts = rise.end - rise.begin > SHORTEST_RISE * self.step;
            [Some(rise.begin).filter(|_| lasts), Some(rise.end)].into_iter().flatten()
        };
        let times = self.found.iter().flat_map(ends);
        times.filter(|t| (t - rest.start).min(rest.end - t) > margin).min_by(f64::total_cmp)
    }

    /// Takes from the mean prescribed velocities of a part over the step about `t` (s) what they know of rises that are not yet, or no
    /// longer, at `t`: as far as accelerations jump, the velocities are those of `t`.
    pub(crate) fn sharpen(&self, index: usize, t: f64, v: &mut [f64]) {
        let step = self.step;
        let is_near = |rise: &&Rise| t - 0.5 * step < rise.end && rise.begin < t + 0.5 * step;
        for rise in self.found.iter().filter(is_near) {
            if let Some(of) = rise.of.filter(|of| of.part == index) {
                v[of.component] -= of.by * rise.smear(t, step);
            }
        }
    }
}

/// The parts of which something may rise.
fn that_may_rise<const D: usize>(model: &Model<D>) -> impl Iterator<Item = (usize, &Part<D>)> {
    model.parts().iter().enumerate().filter(|(_, part)| part.traits.loaded || part.is_driven())
}

/// What rounding makes of a time, s; nothing at t = 0, where a run begins with what is there.
fn nudge(t: f64) -> f64 {
    8.0 * f64::EPSILON * t.abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smear_of_a_rise_is_that_of_the_mean_of_its_velocity() {
        for (begin, end) in [(0.3, 0.3), (0.3, 0.37), (0.3, 0.3 + 1e-6)] {
            let rise = Rise { begin, end, of: None };
            let velocity = |t: f64| match t {
                t if t < begin => 0.0,
                t if t < end => 0.5 * (t - begin).powi(2) / (end - begin),
                t => t - 0.5 * (begin + end),
            };
            for t in [0.24, 0.27, 0.3, 0.33, 0.36, 0.4] {
                let n = 20_000;
                let points = (0..n).map(|i| velocity(t - 0.05 + 0.1 * (f64::from(i) + 0.5) / f64::from(n)));
                let mean = points.sum::<f64>() / f64::from(n);
                assert!((rise.smear(t, 0.1) - (mean - velocity(t))).abs() < 1e-9, "{begin} {end} {t}");
            }
            assert!(rise.smear(0.2, 0.1) == 0.0 && rise.smear(0.5, 0.1).abs() < 1e-15);
        }
    }
}
