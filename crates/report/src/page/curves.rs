//! Curves over time in bounded memory: a run is cut into buckets of equally many steps, of which each keeps the extremes
//! of every quantity and the sums of every contact's impulses. When there are too many, neighbours join.
//!
//! A bucket is drawn as two points, lowest and highest in the order in which they came, at its first and last step: up to
//! two steps a bucket that is the curve itself, beyond that its envelope, from which no peak is missing.
//!
//! Forces of contacts are impulses over times: where buckets are longer, their envelope is that of the means over two steps each, as
//! a mean over the bucket would lose what an earthquake's peaks are.

mod extremes;
mod forces;

use extremes::Extremes;
pub(crate) use forces::{Does, ForceCurve};
use serde::{Deserialize, Serialize};
use teeter_integrator::ContactState;

/// What an impulse is of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Of {
    /// A force over the step.
    Force,
    /// An impact, in a step of this length, s: it isn't the longer for a longer step, and no force.
    Impact { lasting: f64 },
    /// That of a contact that closes again after a moment without pressing, which is no impact, but an impulse all the same.
    Reclosure { lasting: f64 },
}

impl Of {
    /// The same of what comes again in a part of a step whose time has been counted.
    pub(crate) fn again(self) -> Self {
        match self {
            Self::Force => Self::Force,
            Self::Impact { .. } => Self::Impact { lasting: 0.0 },
            Self::Reclosure { .. } => Self::Reclosure { lasting: 0.0 },
        }
    }
}

/// What a contact did in a bucket.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct Work {
    /// Of the steps without an impact.
    impulse: [f64; 2],
    /// Of those with one, how long these took, s, and the largest normal one of a step.
    struck: [f64; 2],
    struck_for: f64,
    hardest: f64,
    /// The least and the largest of the short means of the force in the steps without an impact, normal and tangential, N.
    range: [Range; 2],
    /// Tangential displacement while it pressed, m, from the start of the run to the end of the bucket.
    slip: f64,
    /// Steps in which it pressed, by state.
    sticking: u64,
    slipping: u64,
}

impl Work {
    fn join(self, later: Self) -> Self {
        let sum = |a: [f64; 2], b: [f64; 2]| [a[0] + b[0], a[1] + b[1]];
        Self {
            impulse: sum(self.impulse, later.impulse),
            struck: sum(self.struck, later.struck),
            struck_for: self.struck_for + later.struck_for,
            hardest: self.hardest.max(later.hardest),
            range: [0, 1].map(|k| self.range[k].joined(later.range[k])),
            slip: later.slip,
            sticking: self.sticking + later.sticking,
            slipping: self.slipping + later.slipping,
        }
    }

    fn enter(&mut self, impulse: [f64; 2], of: Of, state: ContactState, slip: f64) {
        self.slip += slip;
        let sum = match of {
            Of::Force => &mut self.impulse,
            Of::Impact { lasting } => {
                self.struck_for += lasting;
                self.hardest = self.hardest.max(impulse[0]);
                &mut self.struck
            }
            Of::Reclosure { lasting } => {
                self.struck_for += lasting;
                &mut self.struck
            }
        };
        sum[0] += impulse[0];
        sum[1] += impulse[1];
        self.count(state);
    }

    fn count(&mut self, state: ContactState) {
        match state {
            ContactState::Open => {}
            ContactState::Stick => self.sticking += 1,
            ContactState::Slip => self.slipping += 1,
        }
    }
}

/// The least and the largest of some values; upside down without any.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Range {
    low: f64,
    high: f64,
}

impl Default for Range {
    fn default() -> Self {
        Self { low: f64::INFINITY, high: f64::NEG_INFINITY }
    }
}

impl Range {
    fn joined(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }
}

/// What a contact did in the steps of a short mean: its impulse without those of impacts, and how long the steps with impacts took, s.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct Recent {
    impulse: [f64; 2],
    struck_for: f64,
}

/// Steps of a short mean of a force: those of a bucket of a run in which no two were joined.
const SHORT: u64 = 2;

/// Steps in a row.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Bucket {
    /// End of the step before it.
    begin: f64,
    /// End of its first step.
    first: f64,
    /// End of its last step.
    last: f64,
    steps: u64,
}

/// Less than this part of a bucket is rounding of times: all of its steps had impacts.
const NO_REST: f64 = 1e-6;

/// A stretch is mixed if a contact sticks and slips in at least this part of its steps each.
const MIXED: f64 = 0.2;

/// A contact sticks and slips by turns if more than this part of the stretches in which it touches is mixed.
const ALTERNATES: f64 = 0.05;

/// The curves of a run.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Curves {
    capacity: usize,
    /// Steps of a full bucket.
    stride: u64,
    start: (f64, Vec<f64>),
    buckets: Vec<Bucket>,
    /// `start.1.len()` a bucket.
    extremes: Vec<Extremes>,
    contacts: usize,
    /// `contacts` a bucket.
    works: Vec<Work>,
    /// The short mean that isn't over yet: its beginning, s, and what each contact did since.
    short: (f64, Vec<Recent>),
}

impl Curves {
    /// Curves from values at the start on, in at most `capacity` buckets (an even number), with `contacts` contact points.
    pub(crate) fn new(capacity: usize, t: f64, start: Vec<f64>, contacts: usize) -> Self {
        Self {
            capacity,
            stride: SHORT,
            start: (t, start),
            buckets: Vec::new(),
            extremes: Vec::new(),
            contacts,
            works: Vec::new(),
            short: (t, vec![Recent::default(); contacts]),
        }
    }

    /// Enters the values at the end of a step.
    pub(crate) fn enter(&mut self, t: f64, values: &[f64]) {
        // What contacts did in a step is added after it was entered.
        if self.buckets.last().is_some_and(|bucket| bucket.steps % SHORT == 0) {
            self.end_short();
        }
        match self.buckets.last_mut().filter(|bucket| bucket.steps < self.stride) {
            Some(bucket) => {
                let lasting = t - bucket.last;
                (bucket.last, bucket.steps) = (t, bucket.steps + 1);
                let at = self.extremes.len() - values.len();
                for (extremes, &x) in self.extremes[at..].iter_mut().zip(values) {
                    extremes.take(Extremes::of_step((t, x), extremes.end, lasting));
                }
            }
            None => self.begin_bucket(t, values),
        }
    }

    /// Begins a bucket, as all before it are full, with the values at the end of its first step.
    #[inline(never)]
    fn begin_bucket(&mut self, t: f64, values: &[f64]) {
        if self.buckets.len() == self.capacity {
            self.halve();
        }
        let begin = self.buckets.last().map_or(self.start.0, |bucket| bucket.last);
        self.buckets.push(Bucket { begin, first: t, last: t, steps: 1 });
        let at = self.extremes.len().checked_sub(values.len());
        for (column, &x) in values.iter().enumerate() {
            let before = at.map_or(self.start.1[column], |at| self.extremes[at + column].end);
            self.extremes.push(Extremes::of_step((t, x), before, t - begin));
        }
        let before = self.works.len().saturating_sub(self.contacts);
        for k in 0..self.contacts {
            let slip = self.works.get(before + k).map_or(0.0, |work| work.slip);
            self.works.push(Work { slip, ..Work::default() });
        }
    }

    /// Ends the short means at the end of the step entered last.
    fn end_short(&mut self) {
        let Some(end) = self.buckets.last().map(|bucket| bucket.last) else { return };
        let lasting = end - self.short.0;
        let newest = self.works.len().saturating_sub(self.contacts);
        for (work, recent) in self.works[newest..].iter_mut().zip(&mut self.short.1) {
            let recent = std::mem::take(recent);
            let rest = lasting - recent.struck_for;
            if rest > NO_REST * lasting {
                work.range = [0, 1].map(|k| {
                    let mean = recent.impulse[k] / rest;
                    work.range[k].joined(Range { low: mean, high: mean })
                });
            }
        }
        self.short.0 = end;
    }

    /// Adds what a contact did in the step entered last: impulse, state, and by how much it slipped, m.
    #[inline]
    pub(crate) fn add(&mut self, contact: usize, impulse: [f64; 2], of: Of, state: ContactState, slip: f64) {
        let newest = self.works.len().saturating_sub(self.contacts);
        if let Some(work) = self.works[newest..].get_mut(contact) {
            work.enter(impulse, of, state, slip);
        }
        if let Some(recent) = self.short.1.get_mut(contact) {
            match of {
                Of::Force => (0..2).for_each(|k| recent.impulse[k] += impulse[k]),
                Of::Impact { lasting } | Of::Reclosure { lasting } => recent.struck_for += lasting,
            }
        }
    }

    /// Counts what a contact does in most of the step entered last.
    #[inline]
    pub(crate) fn count(&mut self, contact: usize, state: ContactState) {
        let newest = self.works.len().saturating_sub(self.contacts);
        if let Some(work) = self.works[newest..].get_mut(contact) {
            work.count(state);
        }
    }

    fn halve(&mut self) {
        let (columns, pairs) = (self.start.1.len(), self.buckets.len() / 2);
        for i in 0..pairs {
            let (a, b) = (self.buckets[2 * i], self.buckets[2 * i + 1]);
            self.buckets[i] = Bucket { begin: a.begin, first: a.first, last: b.last, steps: a.steps + b.steps };
            for k in 0..columns {
                let (mut joined, later) =
                    (self.extremes[2 * i * columns + k], self.extremes[(2 * i + 1) * columns + k]);
                joined.take(later);
                self.extremes[i * columns + k] = joined;
            }
            for k in 0..self.contacts {
                let (a, b) = (self.works[2 * i * self.contacts + k], self.works[(2 * i + 1) * self.contacts + k]);
                self.works[i * self.contacts + k] = a.join(b);
            }
        }
        // A last one without a partner stays alone: only where the curves are drawn, as a full run has an even number.
        let odd = self.buckets.len() % 2;
        if odd == 1 {
            self.buckets[pairs] = self.buckets[2 * pairs];
            self.extremes.copy_within(2 * pairs * columns.., pairs * columns);
            self.works.copy_within(2 * pairs * self.contacts.., pairs * self.contacts);
        }
        let pairs = pairs + odd;
        self.buckets.truncate(pairs);
        self.extremes.truncate(pairs * columns);
        self.works.truncate(pairs * self.contacts);
        self.stride *= 2;
    }

    /// How many buckets there are.
    pub(crate) fn len(&self) -> usize {
        self.buckets.len()
    }

    /// The curves of a run that has come to its end.
    pub(crate) fn ended(&self) -> Self {
        let mut ended = self.clone();
        ended.end_short();
        ended
    }

    /// The curves in at most so many buckets, or two.
    pub(crate) fn in_at_most(&self, buckets: usize) -> Self {
        let mut fewer = self.clone();
        while fewer.len() > buckets.max(2) {
            fewer.halve();
        }
        fewer
    }

    /// Times of the points of [`Curves::curve`], s.
    pub(crate) fn times(&self) -> Vec<f64> {
        std::iter::once(self.start.0).chain(self.buckets.iter().flat_map(|b| [b.first, b.last])).collect()
    }

    /// A quantity over time.
    pub(crate) fn curve(&self, column: usize) -> Vec<f64> {
        let columns = self.start.1.len();
        let points = self.extremes.iter().skip(column).step_by(columns.max(1)).flat_map(|e| e.in_order());
        std::iter::once(self.start.1[column]).chain(points).collect()
    }

    /// The means of a quantity over the buckets, exact to the trapezoid rule however many steps these have.
    pub(crate) fn means(&self, column: usize) -> Vec<f64> {
        let own = self.extremes.iter().skip(column).step_by(self.start.1.len().max(1));
        own.zip(&self.buckets).map(|(own, bucket)| own.integral / (bucket.last - bucket.begin)).collect()
    }

    /// Whether a curve shows extremes in place of values: where a bucket has more steps than two points can show.
    pub(crate) fn is_thinned(&self) -> bool {
        self.stride > 2
    }

    /// The values of a quantity at some times in ascending order; none at a time within a bucket, of which only the extremes are known,
    /// unless these differ by no more than `within`.
    pub(crate) fn values(&self, column: usize, times: impl IntoIterator<Item = f64>, within: f64) -> Vec<Option<f64>> {
        let columns = self.start.1.len();
        let mut from = 0;
        let value = |t: f64| {
            if t <= self.start.0 {
                return Some(self.start.1[column]);
            }
            while self.buckets.get(from)?.last < t {
                from += 1;
            }
            let (bucket, extremes) = (self.buckets[from], self.extremes[from * columns + column]);
            match t {
                t if t == bucket.last => Some(extremes.end),
                // Of up to two steps both values are known.
                t if t == bucket.first && bucket.steps <= 2 => Some(extremes.in_order()[0]),
                _ if extremes.high.1 - extremes.low.1 <= within => Some(0.5 * (extremes.low.1 + extremes.high.1)),
                _ => None,
            }
        };
        times.into_iter().map(value).collect()
    }

    /// Borders of the buckets, s: one more than there are buckets.
    pub(crate) fn borders(&self) -> Vec<f64> {
        std::iter::once(self.start.0).chain(self.buckets.iter().map(|bucket| bucket.last)).collect()
    }

    /// The longest time over which forces are means, s: a step or several.
    pub(crate) fn longest_bucket(&self) -> f64 {
        self.buckets.iter().map(|bucket| bucket.last - bucket.begin).fold(0.0, f64::max)
    }

    /// How long a step is, s.
    pub(crate) fn step(&self) -> f64 {
        self.buckets.iter().map(|bucket| (bucket.last - bucket.begin) / bucket.steps as f64).fold(0.0, f64::max)
    }

    /// How long the longest of the short means is of which [`ForceCurve::course`] has the least and the largest, s.
    pub(crate) fn longest_short(&self) -> f64 {
        SHORT as f64 * self.step()
    }

    /// The least and the largest of the short means of a contact's normal (0) or tangential (1) force, N, at the times of [`Curves::curve`];
    /// `means` are those over the buckets. Of each bucket the one first that goes with how these rise or fall.
    fn course(&self, contact: usize, part: usize, means: &[f64]) -> Vec<f64> {
        let works = self.works.iter().skip(contact).step_by(self.contacts.max(1));
        let ends = works.enumerate().flat_map(|(bucket, work)| {
            let Range { low, high } = work.range[part];
            let (low, high) = if low <= high { (low, high) } else { (means[bucket], means[bucket]) };
            let before = means[bucket.saturating_sub(1)];
            let after = means[(bucket + 1).min(means.len() - 1)];
            if before <= after { [low, high] } else { [high, low] }
        });
        let mut course = vec![0.0];
        course.extend(ends);
        // What a contact's force is before the first step is known from that alone.
        course[0] = course.get(1).copied().unwrap_or(0.0);
        course
    }

    /// A contact over time; `None` if it never carried anything.
    pub(crate) fn forces(&self, contact: usize) -> Option<ForceCurve> {
        let works = || self.works.iter().skip(contact).step_by(self.contacts.max(1));
        if works().all(|work| work.impulse == [0.0; 2] && work.struck == [0.0; 2]) {
            return None;
        }
        let mean = |k: usize| {
            let of_bucket = |(work, bucket): (&Work, &Bucket)| {
                let duration = bucket.last - bucket.begin;
                let rest = duration - work.struck_for;
                if rest > NO_REST * duration {
                    work.impulse[k] / rest
                } else {
                    (work.impulse[k] + work.struck[k]) / duration
                }
            };
            works().zip(&self.buckets).map(of_bucket).collect()
        };
        let state = works().map(|work| match (work.sticking, work.slipping) {
            // Where it presses at instants only, or for less than half of each step, what it does there isn't known.
            (0, 0) if work.impulse == [0.0; 2] && work.struck == [0.0; 2] => ContactState::Open,
            (sticking, slipping) if sticking >= slipping => ContactState::Stick,
            _ => ContactState::Slip,
        });
        let state: Vec<ContactState> = state.collect();
        let usual = works().zip(&self.buckets).zip(&state).map(|((work, bucket), state)| {
            if 2 * (work.sticking + work.slipping) > bucket.steps { *state } else { ContactState::Open }
        });
        let usual = usual.collect();
        let slip: Vec<f64> = works().map(|work| work.slip).collect();
        let before = std::iter::once(0.0).chain(slip.iter().copied());
        let slid =
            works().zip(before).filter(|(work, _)| work.slipping > 0).map(|(work, before)| (work.slip - before).abs());
        let slid = slid.fold(0.0, f64::max);
        let touching = works().filter(|work| work.sticking + work.slipping > 0).count();
        let mixed = works()
            .filter(|work| work.sticking.min(work.slipping) as f64 >= MIXED * (work.sticking + work.slipping) as f64);
        let mixed = mixed.filter(|work| work.sticking + work.slipping > 0).count();
        let alternates = mixed as f64 > ALTERNATES * touching as f64;
        let strikes = works().any(|work| work.hardest > 0.0);
        let impacts = if strikes { works().map(|work| work.hardest).collect() } else { Vec::new() };
        let (normal, tangential): (Vec<f64>, Vec<f64>) = (mean(0), mean(1));
        let course =
            self.is_thinned().then(|| [self.course(contact, 0, &normal), self.course(contact, 1, &tangential)]);
        Some(ForceCurve {
            normal,
            tangential,
            course,
            slip,
            state,
            usual,
            impacts,
            alternates,
            hides_slip: false,
            slid,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(capacity: usize, steps: u32, x: impl Fn(f64) -> f64) -> Curves {
        let mut curves = Curves::new(capacity, 0.0, vec![x(0.0)], 1);
        for k in 1..=steps {
            let t = f64::from(k);
            curves.enter(t, &[x(t)]);
            curves.add(
                0,
                [2.0, -1.0],
                Of::Force,
                if k % 5 == 0 { ContactState::Slip } else { ContactState::Stick },
                0.5,
            );
        }
        curves
    }

    #[test]
    fn a_slide_in_a_stretch_that_mostly_sticks_is_known() {
        let slides = |of: u32| {
            let mut curves = Curves::new(2, 0.0, vec![], 1);
            for k in 1..=16 {
                curves.enter(f64::from(k), &[]);
                let (state, slip) = if k == of { (ContactState::Slip, 1e-5) } else { (ContactState::Stick, 0.0) };
                curves.add(0, [2.0, -1.0], Of::Force, state, slip);
            }
            let forces = curves.forces(0).unwrap();
            assert!(!forces.state.contains(&ContactState::Slip));
            forces.slid
        };
        assert_eq!([slides(5), slides(99)], [1e-5, 0.0]);
    }

    #[test]
    fn a_short_run_is_kept_exactly() {
        let curves = run(4, 8, |t| t * t);
        assert_eq!(curves.times(), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
        assert_eq!(curves.curve(0), curves.times().iter().map(|t| t * t).collect::<Vec<_>>());
        let falling = run(4, 8, |t| -t).curve(0);
        assert!(falling.windows(2).all(|w| w[1] < w[0]), "in the order in which they came");
    }

    #[test]
    fn no_peak_of_a_long_run_is_lost() {
        let curves = run(10, 1_000_000, |t| if t == 123_457.0 { 7.0 } else { 0.0 });
        assert!(curves.times().len() <= 21);
        assert!(curves.curve(0).contains(&7.0));
    }

    #[test]
    fn the_value_at_the_end_of_a_bucket_is_no_extreme_of_it() {
        // A period of four steps, in buckets of eight.
        let ringing = |t: f64| [0.5, 7.0, 0.25, -7.0][t as usize % 4];
        let curves = run(4, 32, ringing);
        assert!(curves.is_thinned() && curves.curve(0)[1..].iter().all(|x| x.abs() == 7.0));
        let times = [0.0, 5.0, 8.0, 16.0, 24.0, 32.0, 33.0];
        let known = Some(0.5);
        assert_eq!(curves.values(0, times, 0.0), [known, None, known, known, known, known, None]);
        // Known to 14 all the same: the mean of the extremes.
        assert_eq!(curves.values(0, [5.0], 14.0), [Some(0.0)]);
        let short = run(4, 7, ringing);
        let all = (0..=7).map(f64::from);
        assert_eq!(short.values(0, all.clone(), 0.0), all.map(|t| Some(ringing(t))).collect::<Vec<_>>());
    }

    #[test]
    fn means_are_those_of_all_steps_however_few_buckets_are_left() {
        // A peak in every tenth step: the middle between the extremes would be 5.
        let curves = run(10, 10_000, |t| if t as u64 % 10 == 5 { 10.0 } else { 0.0 });
        assert!(curves.is_thinned());
        assert!(curves.means(0).iter().all(|mean| (mean - 1.0).abs() < 0.02), "{:?}", curves.means(0));
        let line = run(4, 7, |t| 3.0 * t);
        assert_eq!(line.means(0), [3.0, 9.0, 15.0, 19.5]);
    }

    #[test]
    fn fewer_buckets_hold_the_same_run() {
        let curves = run(10, 9, |t| (t * t - 3.0).cos());
        assert_eq!(curves.len(), 5);
        let fewer = curves.in_at_most(3);
        assert_eq!((fewer.len(), fewer.borders().last()), (3, Some(&9.0)));
        assert_eq!(fewer.forces(0).unwrap().slip, [2.0, 4.0, 4.5]);
        let extremes = |curves: &Curves| {
            let values = curves.curve(0);
            let fold = |f: fn(f64, f64) -> f64| values.iter().copied().reduce(f).unwrap();
            [fold(f64::min), fold(f64::max)]
        };
        assert_eq!(extremes(&fewer), extremes(&curves));
    }

    #[test]
    fn a_touch_shorter_than_a_bucket_is_seen() {
        let mut curves = Curves::new(4, 0.0, vec![], 1);
        for k in 1..=64 {
            curves.enter(f64::from(k), &[]);
            if k == 37 {
                curves.add(0, [1.0, 0.0], Of::Force, ContactState::Stick, 0.0);
            }
        }
        let state = curves.forces(0).unwrap().state;
        assert_eq!(state, [ContactState::Open, ContactState::Open, ContactState::Stick, ContactState::Open]);
    }

    #[test]
    fn an_instant_is_a_brief_touch_and_what_presses_in_most_steps_is_none() {
        let mut curves = Curves::new(4, 0.0, vec![], 1);
        for k in 1..=32 {
            curves.enter(f64::from(k), &[]);
            match k {
                // An impact between two steps, in which it is open.
                12 => curves.add(0, [1.0, 0.0], Of::Impact { lasting: 0.0 }, ContactState::Open, 0.0),
                17.. => curves.add(0, [1.0, 0.0], Of::Force, ContactState::Slip, 1.0),
                _ => {}
            }
        }
        let forces = curves.forces(0).unwrap();
        let does: Vec<Does> = (0..4).map(|bucket| forces.does(bucket)).collect();
        assert_eq!(does, [Does::Open, Does::Briefly, Does::Slip, Does::Slip]);
    }

    #[test]
    fn an_impact_is_an_impulse_and_no_force() {
        // 3 N, but for an impact of 50 N·s in every 100th step of 1 s; with buckets of 8 to 512 steps.
        for steps in [100, 1000, 4000] {
            let mut curves = Curves::new(16, 0.0, vec![], 1);
            for k in 1..=steps {
                curves.enter(f64::from(k), &[]);
                let (impulse, of) = if k % 100 == 0 { (50.0, Of::Impact { lasting: 1.0 }) } else { (3.0, Of::Force) };
                curves.add(0, [impulse, 0.0], of, ContactState::Stick, 0.0);
            }
            let forces = curves.forces(0).unwrap();
            assert!(forces.normal.iter().all(|force| (force - 3.0).abs() < 1e-12), "{:?}", forces.normal);
            assert_eq!(forces.impacts.iter().copied().fold(0.0, f64::max), 50.0);
        }
        // Where every step has one, the mean is that of all.
        let mut curves = Curves::new(4, 0.0, vec![], 1);
        for k in 1..=8 {
            curves.enter(f64::from(k), &[]);
            curves.add(0, [2.0, 1.0], Of::Impact { lasting: 1.0 }, ContactState::Slip, 0.0);
        }
        assert_eq!(curves.forces(0).unwrap().tangential, [1.0; 4]);
    }

    #[test]
    fn what_sticks_and_slips_by_turns_says_so() {
        let of = |every: u32| {
            let mut curves = Curves::new(4, 0.0, vec![], 1);
            for k in 1..=64 {
                curves.enter(f64::from(k), &[]);
                let state = if k % every == 0 { ContactState::Slip } else { ContactState::Stick };
                curves.add(0, [1.0, 0.0], Of::Force, state, 0.0);
            }
            let forces = curves.forces(0).unwrap();
            (forces.alternates, forces.does(1))
        };
        assert_eq!((of(3), of(64)), ((true, Does::Stick), (false, Does::Stick)));
    }

    #[test]
    fn what_chatters_touches() {
        let mut curves = Curves::new(4, 0.0, vec![], 1);
        for k in 1..=64 {
            curves.enter(f64::from(k), &[]);
            let presses = k % 3 == 0;
            let state = if presses { ContactState::Stick } else { ContactState::Open };
            curves.add(0, [f64::from(presses), 0.0], Of::Force, state, 0.0);
        }
        let forces = curves.forces(0).unwrap();
        assert!(forces.state.iter().all(|state| *state == ContactState::Stick));
        assert!((0..forces.state.len()).all(|bucket| forces.does(bucket) == Does::Briefly));
    }

    #[test]
    fn forces_are_means_and_states_majorities() {
        for steps in [1, 8, 9, 1000] {
            let forces = run(4, steps, |t| t).forces(0).unwrap();
            assert!(forces.normal.iter().all(|f| (f - 2.0).abs() < 1e-12));
            assert!(forces.tangential.iter().all(|f| (f + 1.0).abs() < 1e-12));
            assert_eq!(forces.state[0], ContactState::Stick);
            assert_eq!(forces.slip.last(), Some(&(0.5 * f64::from(steps))), "what was slipped adds up");
        }
        assert_eq!(Curves::new(4, 0.0, vec![], 2).forces(1), None);
    }
}
