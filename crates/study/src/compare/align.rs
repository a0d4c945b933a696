//! Finds the time shift and the side from which a motion was seen.

use super::MotionTrace;
use super::correlate::candidates;
use super::outliers::{confirmed, suspects, without};
use crate::measured::{Channel, Measured, MeasuredMotion, Sign};

/// What is known of the alignment; the rest is found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AlignmentSettings {
    /// Time of the run at t = 0 of the measured motion, s.
    pub shift: Option<f64>,
    /// The side from which the motion was seen.
    pub sign: Option<Sign>,
}

/// How a measured motion is aligned with a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alignment {
    /// Time of the run at t = 0 of the measured motion, s.
    pub shift: f64,
    /// Whether it was found rather than given.
    pub shift_found: bool,
    /// The side.
    pub sign: Sign,
    /// Whether it was found, rather than given or, where no quantity tells the side, assumed.
    pub sign_found: bool,
    /// The quantity by which they were found.
    pub by: Channel,
    /// Rows in which both motions have that quantity.
    pub rows: usize,
    /// Mean square difference by which they were found, as a share of the mean squares of both
    /// motions: 0 for equal ones, 1 for unrelated ones.
    pub mismatch: f64,
}

/// Of the shifts that fit best on the grid, so many are judged by all rows. Where a motion hardly
/// changes from period to period, the rounding of times to the grid may change their order.
const CANDIDATES: usize = 5;
/// To what share of the grid's distance each of them is refined, to be compared.
const ROUGH: f64 = 0.01;
/// And the best: 50 sections.
pub(crate) const FINE: f64 = 3.6e-11;
/// Mean square differences of two shifts are as good as equal where they are within so many standard deviations of their quotient, as if
/// differences were normal noise, ...
const DEVIATIONS: f64 = 3.0;
/// ... or below this share of the mean squares of both motions, which interpolation between rows may leave.
const NEGLIGIBLE: f64 = 1e-8;
/// Of shifts that are as good, one is better that explains so many times the rows.
const MORE_ROWS: f64 = 1.1;
/// Refined to the end are those that fit this much worse than the best by the rough search.
const WORTH_REFINING: f64 = 4.0;
/// Fewest rows that can be aligned.
const FEWEST_ROWS: usize = 4;
/// At least this share of the shorter motion has to be compared.
const OVERLAP: f64 = 0.5;

/// A measured motion that is aligned with a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Aligned {
    /// How.
    pub alignment: Alignment,
    /// The motion as seen from the side of the scene, in its own times.
    pub motion: MeasuredMotion,
    /// The rows in which a quantity is off on its own: they don't count for the alignment.
    pub outliers: Vec<usize>,
    /// Other shifts and sides that fit as well, those with the most rows first.
    pub alternatives: Vec<Alternative>,
}

/// A shift and a side that fit about as well as the best.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alternative {
    /// Time of the run at t = 0 of the measured motion, s.
    pub shift: f64,
    /// The side.
    pub sign: Sign,
    /// Rows that are compared with it.
    pub rows: usize,
}

/// Aligns a measured motion with a run up to time `end` (s): of the shifts and sides that are not
/// given, those with the smallest mean square difference of the [leading](MeasuredMotion::leading)
/// quantity.
#[must_use]
pub fn align(measured: &Measured, trace: &MotionTrace, end: f64, offset: f64, settings: AlignmentSettings) -> Aligned {
    let suspected = suspects(&measured.motion(Sign::AsIs));
    let first = align_without(measured, trace, end, offset, settings, &suspected);
    if suspected.is_empty() {
        return first;
    }
    let off = confirmed_by(trace, &first, &suspected);
    let mut aligned = match off.len() == suspected.len() {
        true => first,
        false => align_without(measured, trace, end, offset, settings, &off),
    };
    aligned.outliers = off.into_iter().map(|(row, _)| row).collect();
    aligned.outliers.sort_unstable();
    aligned.outliers.dedup();
    aligned
}

/// What fits as well as a shift and a side that were found otherwise, the best of all included, with the settings of [`align`].
pub(crate) fn alternatives_to(
    chosen: (f64, Sign),
    measured: &Measured,
    trace: &MotionTrace,
    end: f64,
    offset: f64,
    settings: AlignmentSettings,
) -> Vec<Alternative> {
    let Aligned { alignment, alternatives, motion, .. } = align(measured, trace, end, offset, settings);
    let Alignment { shift, sign, rows, .. } = alignment;
    let is_chosen = |one: &Alternative| one.sign == chosen.1 && (one.shift - chosen.0).abs() <= motion.interval();
    std::iter::once(Alternative { shift, sign, rows }).chain(alternatives).filter(|one| !is_chosen(one)).collect()
}

/// Those of the suspected values that the run doesn't have either.
fn confirmed_by(trace: &MotionTrace, aligned: &Aligned, suspected: &[(usize, usize)]) -> Vec<(usize, usize)> {
    let Aligned { alignment, motion, .. } = aligned;
    let of_channel = |(place, (channel, values)): (usize, &(Channel, Vec<f64>))| {
        let rows: Vec<usize> = suspected.iter().filter(|found| found.1 == place).map(|found| found.0).collect();
        let mut hint = 0;
        let apart: Vec<f64> = motion
            .t
            .iter()
            .zip(values)
            .map(|(t, value)| {
                let simulated = trace.at_near(t + alignment.shift, &mut hint);
                simulated.map_or(f64::NAN, |simulated| simulated.of(*channel) - value)
            })
            .collect();
        confirmed(&apart, &rows).into_iter().map(move |row| (row, place)).collect::<Vec<_>>()
    };
    motion.channels.iter().enumerate().flat_map(of_channel).collect()
}

/// As [`align`], without the values of these rows and quantities.
fn align_without(
    measured: &Measured,
    trace: &MotionTrace,
    end: f64,
    offset: f64,
    settings: AlignmentSettings,
    off: &[(usize, usize)],
) -> Aligned {
    let start = trace.at(0.0).map_or(0.0, |motion| motion.of(Channel::Phi));
    let seen_from = |sign: Sign| {
        let mut motion = measured.motion(sign);
        set_zero(&mut motion, sign.factor() * offset, start);
        let fit = SideFit::of(&without(&motion, off), trace, end, settings.shift);
        (sign, motion, fit)
    };
    let (chosen, other) = match settings.sign {
        Some(sign) => (seen_from(sign), None),
        None => {
            let [as_is, reversed] = [Sign::AsIs, Sign::Reversed].map(seen_from);
            // Of an exact tie, the side as it is.
            let turned = reversed.2.whole().is_better_than(&as_is.2.whole());
            if turned { (reversed, Some(as_is)) } else { (as_is, Some(reversed)) }
        }
    };
    let (sign, motion, fit) = chosen;
    let seen_as = |sign: Sign| move |found: &ShiftFit| Alternative { shift: found.shift, sign, rows: found.rows };
    let mut alternatives: Vec<Alternative> = fit.as_good.iter().map(seen_as(sign)).collect();
    let is_as_good = |other: &SideFit| other.tells_side && other.whole().is_as_good_as(&fit.whole());
    if let Some((sign, _, other)) = other.filter(|(.., other)| is_as_good(other)) {
        // That these fit as well as the best of their side is known; here they are held against the better side.
        let as_good = other.as_good.iter().filter(|found| found.is_as_good_as(&fit.fit));
        alternatives.extend(std::iter::once(&other.fit).chain(as_good).map(seen_as(sign)));
    }
    alternatives.sort_by_key(|found| std::cmp::Reverse(found.rows));
    let alignment = Alignment {
        shift: fit.fit.shift,
        shift_found: settings.shift.is_none(),
        sign,
        sign_found: settings.sign.is_none() && fit.tells_side,
        by: fit.by,
        rows: fit.fit.rows,
        mismatch: fit.fit.mismatch,
    };
    Aligned { alignment, motion, outliers: Vec::new(), alternatives }
}

/// How a shift fits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShiftFit {
    /// The time shift, s.
    pub(crate) shift: f64,
    /// The mismatch of the quantity by which motions are aligned; infinite if too little of them is at the same time.
    pub(crate) mismatch: f64,
    /// Rows that are compared.
    rows: usize,
}

impl ShiftFit {
    const NONE: Self = Self { shift: 0.0, mismatch: f64::INFINITY, rows: 0 };

    /// Whether it can't be told from this one, which fits better, with as many rows as they have.
    fn is_as_good_as(&self, best: &Self) -> bool {
        let spread = (2.0 / self.rows as f64 + 2.0 / best.rows as f64).sqrt();
        self.mismatch.is_finite() && self.mismatch <= (1.0 + DEVIATIONS * spread) * best.mismatch.max(NEGLIGIBLE)
    }

    fn explains_more_than(&self, other: &Self) -> bool {
        self.rows as f64 > MORE_ROWS * other.rows as f64
    }

    /// Whether this is the better one: by its mismatch, or by its rows where that can't tell.
    pub(crate) fn is_better_than(&self, other: &Self) -> bool {
        match self.mismatch < other.mismatch {
            true => !(other.is_as_good_as(self) && other.explains_more_than(self)),
            false => self.is_as_good_as(other) && self.explains_more_than(other),
        }
    }
}

/// How a motion as seen from one side fits a run.
pub(crate) struct SideFit {
    /// The best shift, or that which was given.
    pub(crate) fit: ShiftFit,
    /// Its mismatch, and with it that of the quantity that tells the side, where the leading one looks the same from both, as a fall
    /// does. Of the two sides that with the smaller one is right.
    pub(crate) from_here: f64,
    /// Whether any quantity above its noise tells the side.
    pub(crate) tells_side: bool,
    /// Other shifts that fit as well.
    as_good: Vec<ShiftFit>,
    by: Channel,
}

impl SideFit {
    /// That of a motion and a run up to time `end` (s), with a given shift (s) or the best.
    pub(crate) fn of(motion: &MeasuredMotion, trace: &MotionTrace, end: f64, shift: Option<f64>) -> Self {
        let search_of = |channel: Channel| {
            let mut search = Search::of(channel, motion, trace, end);
            // How much of the motions a given shift leaves to compare is not for the search to say.
            if shift.is_some() {
                search.window.fewest = FEWEST_ROWS;
            }
            search
        };
        let by = motion.leading();
        let leading = search_of(by);
        let (fit, as_good) = match shift {
            Some(shift) => (leading.fit(shift), Vec::new()),
            None => leading.best(),
        };
        if by.is_mirrored() {
            return Self { fit, from_here: fit.mismatch, tells_side: true, as_good, by };
        }
        let telling = motion.telling_side().map(|channel| search_of(channel).fit(fit.shift).mismatch);
        let telling = telling.filter(|mismatch| mismatch.is_finite());
        let from_here = fit.mismatch + telling.unwrap_or(0.0);
        Self { fit, from_here, tells_side: telling.is_some(), as_good, by }
    }

    /// Its fit with what tells the side.
    pub(crate) fn whole(&self) -> ShiftFit {
        ShiftFit { mismatch: self.from_here, ..self.fit }
    }
}

/// Takes the zero of the angle out of a measured motion.
pub(crate) fn set_zero(motion: &mut MeasuredMotion, offset: f64, start: f64) {
    let from = if motion.phi_from_first_row { start } else { 0.0 };
    for (_, values) in motion.channels.iter_mut().filter(|(channel, _)| *channel == Channel::Phi) {
        values.iter_mut().for_each(|phi| *phi += from - offset);
    }
}

/// What part of a run counts for an alignment, and how much of it there has to be.
pub(super) struct Window {
    /// From when on the run has a motion, s: minus infinity if the block was held before.
    pub(super) begin: f64,
    /// Until when, s.
    pub(super) end: f64,
    /// Whether the mean difference doesn't count.
    pub(super) centred: bool,
    /// Fewest rows between the start of the run and its end.
    fewest: usize,
}

impl Window {
    pub(super) fn enough(&self, moving: usize) -> bool {
        moving >= self.fewest
    }
}

/// The search for a shift.
struct Search<'a> {
    trace: &'a MotionTrace,
    channel: Channel,
    /// Times and values of the rows.
    rows: Vec<(f64, f64)>,
    /// The median time between them, s.
    interval: f64,
    window: Window,
}

impl<'a> Search<'a> {
    fn new(motion: &MeasuredMotion, trace: &'a MotionTrace, end: f64) -> Self {
        Self::of(motion.leading(), motion, trace, end)
    }

    fn of(channel: Channel, motion: &MeasuredMotion, trace: &'a MotionTrace, end: f64) -> Self {
        let values = motion.values(channel).unwrap_or_default();
        let rows: Vec<(f64, f64)> =
            motion.t.iter().copied().zip(values.iter().copied()).filter(|(_, value)| value.is_finite()).collect();
        let length = rows.last().map_or(0.0, |last| last.0) - rows.first().map_or(0.0, |first| first.0);
        let spacing = length / (rows.len() as f64 - 1.0).max(1.0);
        let least = (OVERLAP * length.min(end) / spacing).ceil() + 1.0;
        let window = Window {
            begin: if trace.is_held() { f64::NEG_INFINITY } else { 0.0 },
            end,
            centred: channel.has_own_origin(),
            fewest: if least.is_finite() { (least as usize).max(FEWEST_ROWS) } else { usize::MAX },
        };
        Self { trace, channel, rows, interval: motion.interval(), window }
    }

    /// Mean square difference with a shift, relative to the mean squares of both; infinite if too
    /// little of them is at the same time.
    fn fit(&self, shift: f64) -> ShiftFit {
        let Window { begin, end, centred, .. } = self.window;
        let from = |time: f64| self.rows.partition_point(|(t, _)| t + shift < time);
        let (first, moving, after) = (from(begin), from(0.0), self.rows.partition_point(|(t, _)| t + shift <= end));
        if !self.window.enough(after.saturating_sub(moving)) {
            return ShiftFit { shift, ..ShiftFit::NONE };
        }
        let mut hint = 0;
        let pairs: Vec<(f64, f64)> = self.rows[first..after]
            .iter()
            .filter_map(|(t, value)| Some((*value, self.trace.at_near(t + shift, &mut hint)?.of(self.channel))))
            .collect();
        ShiftFit { shift, mismatch: mismatch_of(&pairs, centred).unwrap_or(f64::INFINITY), rows: pairs.len() }
    }

    /// The best shift, and others that fit as well: of the best of all shifts on a grid each is refined. Of those that fit as well, one is
    /// best that has more rows: a motion that repeats itself fits a period off, too, where its recording reaches beyond the run.
    fn best(&self) -> (ShiftFit, Vec<ShiftFit>) {
        let simulated =
            |t: f64, hint: &mut usize| self.trace.at_near(t, hint).map_or(0.0, |motion| motion.of(self.channel));
        let (found, reach) = candidates(&self.rows, self.interval, &self.window, simulated);
        let refined = |near: f64, reach: f64, share: f64| {
            self.fit(golden(near - reach, near + reach, share, |shift| self.fit(shift).mismatch))
        };
        let most = WORTH_REFINING * found.first().map_or(0.0, |best| best.mismatch.max(NEGLIGIBLE));
        let mut nearly: Vec<_> = found.iter().skip(CANDIDATES).take_while(|found| found.mismatch <= most).collect();
        nearly.sort_by_key(|found| std::cmp::Reverse(found.rows));
        let chosen = found.iter().take(CANDIDATES).chain(nearly.into_iter().take(CANDIDATES));
        let rough: Vec<ShiftFit> = chosen.map(|found| refined(found.shift, reach, ROUGH)).collect();
        let least = |fits: &[ShiftFit]| fits.iter().copied().min_by(|a, b| a.mismatch.total_cmp(&b.mismatch));
        let Some(best) = least(&rough) else { return (ShiftFit::NONE, Vec::new()) };
        let most = WORTH_REFINING * best.mismatch.max(NEGLIGIBLE);
        let worth = rough.iter().filter(|fit| fit.mismatch <= most);
        let mut fine: Vec<ShiftFit> = worth.map(|fit| refined(fit.shift, 4.0 * ROUGH * reach, FINE)).collect();
        let Some(best) = least(&fine) else { return (ShiftFit::NONE, Vec::new()) };
        fine.retain(|fit| fit.is_as_good_as(&best));
        // The best of those that have about the most rows.
        let whole: Vec<ShiftFit> =
            fine.iter().filter(|fit| !fine.iter().any(|other| other.explains_more_than(fit))).copied().collect();
        let best = least(&whole).unwrap_or(best);
        // One that was found from two sides is the same.
        let mut different: Vec<ShiftFit> = vec![best];
        for fit in fine {
            if different.iter().all(|known| (known.shift - fit.shift).abs() > self.interval) {
                different.push(fit);
            }
        }
        (best, different.split_off(1))
    }
}

/// Mean square difference of pairs of values, relative to the mean squares of both; `centred`: of both their means are taken first. `None` where
/// all are 0.
pub(crate) fn mismatch_of(pairs: &[(f64, f64)], centred: bool) -> Option<f64> {
    let mean = |pick: fn(&(f64, f64)) -> f64| pairs.iter().map(pick).sum::<f64>() / pairs.len() as f64;
    let (a, b) = if centred { (mean(|p| p.0), mean(|p| p.1)) } else { (0.0, 0.0) };
    let (mut off, mut all) = (0.0, 0.0);
    for (x, y) in pairs {
        let (x, y) = (x - a, y - b);
        off += (x - y) * (x - y);
        all += x * x + y * y;
    }
    (all > 0.0).then_some(off / all)
}

/// The time shift (s) that aligns a motion with a run, and the mismatch that is left.
pub(crate) fn mismatch_and_shift(motion: &MeasuredMotion, trace: &MotionTrace, end: f64) -> (f64, f64) {
    let (ShiftFit { shift, mismatch, .. }, _) = Search::new(motion, trace, end).best();
    (shift, mismatch)
}

/// The minimum of a function between two points by golden sections, to this share of their distance.
pub(crate) fn golden(mut low: f64, mut high: f64, to: f64, mut of: impl FnMut(f64) -> f64) -> f64 {
    let share = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut a, mut b) = (high - share * (high - low), low + share * (high - low));
    let (mut at_a, mut at_b) = (of(a), of(b));
    let sections = (to.ln() / share.ln()).ceil() as usize;
    for _ in 0..sections {
        if at_a < at_b {
            (high, b, at_b) = (b, a, at_a);
            a = high - share * (high - low);
            at_a = of(a);
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = low + share * (high - low);
            at_b = of(b);
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured::ColumnLayout;

    #[test]
    fn shift_and_side_are_found() {
        let phi = |t: f64| 0.1 * (-2.0 * t).exp() * (17.0 * t).cos();
        let rate = |t: f64| (phi(t + 1e-6) - phi(t - 1e-6)) / 2e-6;
        let mut trace = MotionTrace::default();
        for k in 0..=2000 {
            let t = 1e-3 * f64::from(k);
            let v = if k == 0 { 0.0 } else { rate(t) };
            trace.push(t, [0.0, 0.0, phi(t)], [0.0, 0.0, v]);
        }
        // Frames from 0.4 s before the release on, seen from behind.
        let frames = (0..300).map(|k| {
            let t = f64::from(k) / 165.0 - 0.4;
            format!("{:?},{:?}\n", 3.0 + f64::from(k) / 165.0, -phi(t.max(0.0)))
        });
        let text = format!("t,phi\n{}", frames.collect::<String>());
        let measured = Measured::read(text.as_bytes(), &ColumnLayout::default(), "b").unwrap();
        let found = align(&measured, &trace, 2.0, 0.0, AlignmentSettings::default()).alignment;
        assert_eq!(found.sign, Sign::Reversed);
        assert!((found.shift + 3.4).abs() < 1e-5, "{found:?}");
        let given = AlignmentSettings { shift: Some(-3.3), sign: Some(Sign::AsIs) };
        let found = align(&measured, &trace, 2.0, 0.0, given).alignment;
        assert!(found.shift == -3.3 && found.sign == Sign::AsIs && found.mismatch > 0.5);
    }

    /// A block that falls flat, of which the camera sees a rising picture with few wrong frames.
    #[test]
    fn noise_and_wrong_frames_do_not_align_a_motion() {
        let mut trace = MotionTrace::default();
        for k in 0..=1000 {
            let t = 1e-3 * f64::from(k);
            // Thrown up and aside, so that both coordinates move, and never turned.
            let (x, y) = (0.8 * t, t * (2.0 - 0.5 * 9.81 * t));
            trace.push(t, [x, y, 0.0], [0.8, 2.0 - 9.81 * t, 0.0]);
        }
        let noise = |k: u32| 1e-4 * f64::from((k * 7919) % 13) / 6.0;
        let table = |sign: f64, wrong: &[u32]| {
            let rows = (0..130_u32).map(|k| {
                let t = f64::from(k) / 165.0;
                let off = if wrong.contains(&k) { 9.0 } else { 0.0 };
                let (s, x) = (t + 0.1, sign * 0.8 * (t + 0.1));
                format!("{t:?},{},{},{}\n", 30.0 * noise(k + 3), x + noise(k), s * (2.0 - 0.5 * 9.81 * s) + off)
            });
            let text = format!("t,phi,x,y\n{}", rows.collect::<String>());
            Measured::read(text.as_bytes(), &ColumnLayout::default(), "b").unwrap()
        };
        for (factor, sign) in [(1.0, Sign::AsIs), (-1.0, Sign::Reversed)] {
            for wrong in [&[] as &[u32], &[20, 21, 70, 100]] {
                let aligned = align(&table(factor, wrong), &trace, 1.0, 0.0, AlignmentSettings::default());
                let found = aligned.alignment;
                assert_eq!((found.by, found.sign, found.sign_found), (Channel::Y, sign, true), "{found:?}");
                assert!((found.shift - 0.1).abs() < 1e-3, "{found:?}");
                assert_eq!(aligned.outliers.iter().map(|row| *row as u32).collect::<Vec<_>>(), wrong);
            }
        }
    }

    /// A block that rocks 100 times in a minute and hardly loses energy: one period off, nearly
    /// everything fits.
    fn long_motion() -> (MotionTrace, impl Fn(f64) -> f64) {
        // Half-sines between impacts, of which each keeps 0.995 of the speed.
        let half = 0.3;
        let place = move |t: f64| ((t / half).floor(), std::f64::consts::PI * (t / half).fract());
        let size = |n: f64| 0.1 * 0.995_f64.powf(n) * if n % 2.0 == 0.0 { 1.0 } else { -1.0 };
        let phi = move |t: f64| {
            let (n, s) = place(t);
            size(n) * s.sin()
        };
        let mut trace = MotionTrace::default();
        for k in 0..=60_000 {
            let t = 1e-3 * f64::from(k);
            let (n, s) = place(t);
            trace.push(t, [0.0, 0.0, phi(t)], [0.0, 0.0, size(n) * s.cos() * std::f64::consts::PI / half]);
        }
        (trace, phi)
    }

    /// A block that is shaken for a while moves on and on in the same way: a recording from the middle fits at many times, and from behind at
    /// as many. The best is what explains all of it.
    #[test]
    fn of_alignments_that_fit_as_well_one_explains_more() {
        let phi = |t: f64| 0.1 * (4.0 * std::f64::consts::PI * t).sin();
        let rate = |t: f64| 0.4 * std::f64::consts::PI * (4.0 * std::f64::consts::PI * t).cos();
        let mut trace = MotionTrace::default();
        for k in 0..=4000 {
            let t = 1e-3 * f64::from(k);
            trace.push(t, [0.0, 0.0, phi(t)], [0.0, 0.0, rate(t)]);
        }
        // 2.5 s: from within the run, the whole of it fits up to 1.5 s after the start.
        let frames = (0..412_u32).map(|k| {
            let t = f64::from(k) / 165.0;
            let noise = 1e-3 * (f64::from((k * 7919) % 13) / 6.0 - 1.0);
            format!("{t:?},{:?}\n", phi(t + 1.3) + noise)
        });
        let text = format!("t,phi\n{}", frames.collect::<String>());
        let measured = Measured::read(text.as_bytes(), &ColumnLayout::default(), "b").unwrap();
        let aligned = align(&measured, &trace, 4.0, 0.0, AlignmentSettings::default());
        let whole = |shift: f64| (0.0..=1.505).contains(&shift);
        let rows =
            |shift: f64| (0..412_u32).filter(|k| (0.0..=4.0).contains(&(f64::from(*k) / 165.0 + shift))).count() as f64;
        let nearly_whole = |shift: f64| MORE_ROWS * rows(shift) >= 412.0;
        assert!(nearly_whole(aligned.alignment.shift), "{:?}", aligned.alignment);
        // Of those that have about as many rows it is the best.
        let same_side = aligned.alternatives.iter().filter(|found| found.sign == aligned.alignment.sign);
        for found in same_side.filter(|found| nearly_whole(found.shift)) {
            let given = AlignmentSettings { shift: Some(found.shift), sign: Some(found.sign) };
            let mismatch = align(&measured, &trace, 4.0, 0.0, given).alignment.mismatch;
            assert!(mismatch >= aligned.alignment.mismatch, "{found:?}: {mismatch}");
        }
        // A period is 0.5 s, and half of one seen from behind.
        let steps = |shift: f64, sign: Sign| (shift - 1.3 + if sign == Sign::AsIs { 0.0 } else { 0.25 }) / 0.5;
        for found in &aligned.alternatives {
            let off = steps(found.shift, found.sign);
            assert!((off - off.round()).abs() < 2e-3, "{found:?}");
            assert_eq!(found.rows == 412, whole(found.shift), "{found:?}");
        }
        let of_side = |sign| aligned.alternatives.iter().filter(|found| found.sign == sign).count();
        assert!(of_side(Sign::AsIs) >= 2 && of_side(Sign::Reversed) >= 2, "{:?}", aligned.alternatives);
        // What is known leaves nothing to choose.
        let known = AlignmentSettings { shift: Some(1.3), sign: Some(Sign::AsIs) };
        assert!(align(&measured, &trace, 4.0, 0.0, known).alternatives.is_empty());
    }

    #[test]
    fn a_long_recording_is_not_aligned_a_period_off() {
        let (trace, phi) = long_motion();
        for (begin, rows) in [(0.0, 9900_u32), (0.25, 9800), (7.371, 8600), (29.99, 4900)] {
            let frames = (0..rows).map(|k| {
                let t = f64::from(k) / 165.0;
                let noise = 1e-4 * f64::from((k * 7919) % 13) / 6.0;
                format!("{t:?},{:?}\n", phi(begin + t) + noise)
            });
            let text = format!("t,phi\n{}", frames.collect::<String>());
            let measured = Measured::read(text.as_bytes(), &ColumnLayout::default(), "b").unwrap();
            let motion = measured.motion(Sign::AsIs);
            let (shift, mismatch) = mismatch_and_shift(&motion, &trace, 60.0);
            assert!((shift - begin).abs() < 2e-4 && mismatch < 1e-4, "from {begin} s: {shift} s, {mismatch}");
            let aligned = align(&measured, &trace, 60.0, 0.0, AlignmentSettings::default());
            assert!(aligned.alternatives.is_empty(), "from {begin} s: {:?}", aligned.alternatives);
            let found = aligned.alignment;
            assert!(found.sign == Sign::AsIs && (found.shift - begin).abs() < 2e-4, "from {begin} s: {found:?}");
        }
    }
}
