//! Finds the time shift and the side from which a motion was seen.

use super::MotionTrace;
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
    /// Whether it was found rather than given.
    pub sign_found: bool,
    /// Mean square difference by which they were found, as a share of the mean squares of both
    /// motions: 0 for equal ones, 1 for unrelated ones.
    pub mismatch: f64,
}

/// Rows used in the search for a shift.
const SEARCH_ROWS: usize = 1500;
/// Most shifts tried before the best is refined.
const MOST_SHIFTS: usize = 3000;
/// At least this share of the shorter motion has to be compared.
const OVERLAP: f64 = 0.5;

/// Aligns a measured motion with a run up to time `end` (s): of the shifts and sides that are not
/// given, those with the smallest mean square difference of the angle, or of the first quantity that
/// the table has.
#[must_use]
pub fn align(
    measured: &Measured,
    trace: &MotionTrace,
    end: f64,
    offset: f64,
    settings: AlignmentSettings,
) -> (Alignment, MeasuredMotion) {
    let signs = settings.sign.map_or(vec![Sign::AsIs, Sign::Reversed], |sign| vec![sign]);
    let start = trace.at(0.0).map_or(0.0, |motion| motion.of(Channel::Phi));
    let mut best: Option<(Alignment, MeasuredMotion)> = None;
    for sign in signs {
        let mut motion = measured.motion(sign);
        set_zero(&mut motion, sign.factor() * offset, start);
        let search = Search::new(&motion, trace, end, SEARCH_ROWS);
        let (shift, mismatch) = match settings.shift {
            Some(shift) => (shift, search.mismatch(shift).unwrap_or(f64::INFINITY)),
            None => search.best(MOST_SHIFTS),
        };
        // Of an exact tie, the side as it is.
        if best.as_ref().is_none_or(|(found, _)| mismatch < found.mismatch) {
            let (shift_found, sign_found) = (settings.shift.is_none(), settings.sign.is_none());
            best = Some((Alignment { shift, shift_found, sign, sign_found, mismatch }, motion));
        }
    }
    let none = Alignment { shift: 0.0, shift_found: true, sign: Sign::AsIs, sign_found: true, mismatch: f64::INFINITY };
    best.unwrap_or_else(|| (none, measured.motion(Sign::AsIs)))
}

/// Takes the zero of the angle out of a measured motion.
pub(crate) fn set_zero(motion: &mut MeasuredMotion, offset: f64, start: f64) {
    let from = if motion.phi_from_first_row { start } else { 0.0 };
    for (_, values) in motion.channels.iter_mut().filter(|(channel, _)| *channel == Channel::Phi) {
        values.iter_mut().for_each(|phi| *phi += from - offset);
    }
}

/// The search for a shift.
struct Search<'a> {
    trace: &'a MotionTrace,
    channel: Channel,
    /// Times and values of the rows that are looked at.
    rows: Vec<(f64, f64)>,
    end: f64,
}

impl<'a> Search<'a> {
    fn new(motion: &MeasuredMotion, trace: &'a MotionTrace, end: f64, most_rows: usize) -> Self {
        let channel = motion.leading();
        let values = motion.values(channel).unwrap_or_default();
        let present: Vec<(f64, f64)> =
            motion.t.iter().copied().zip(values.iter().copied()).filter(|(_, value)| value.is_finite()).collect();
        let every = present.len().div_ceil(most_rows).max(1);
        Self { trace, channel, rows: present.into_iter().step_by(every).collect(), end }
    }

    /// Mean square difference with a shift, relative to the mean squares of both; `None` if too
    /// little of them is at the same time.
    fn mismatch(&self, shift: f64) -> Option<f64> {
        let begin = if self.trace.is_held() { f64::NEG_INFINITY } else { 0.0 };
        let inside = |t: f64| t + shift >= begin && t + shift <= self.end;
        let pairs: Vec<(f64, f64)> = self
            .rows
            .iter()
            .filter(|(t, _)| inside(*t))
            .filter_map(|(t, value)| Some((*value, self.trace.at(t + shift)?.of(self.channel))))
            .collect();
        let moving = self.rows.iter().filter(|(t, _)| t + shift >= 0.0 && t + shift <= self.end).count();
        let spacing = (self.rows.last()?.0 - self.rows.first()?.0) / (self.rows.len() as f64 - 1.0).max(1.0);
        let shorter = (self.rows.last()?.0 - self.rows.first()?.0).min(self.end);
        if (moving as f64 - 1.0) * spacing < OVERLAP * shorter || moving < 4 {
            return None;
        }
        let mean = |pick: fn(&(f64, f64)) -> f64| pairs.iter().map(pick).sum::<f64>() / pairs.len() as f64;
        let centred = self.channel.has_own_origin();
        let (a, b) = if centred { (mean(|p| p.0), mean(|p| p.1)) } else { (0.0, 0.0) };
        let (mut off, mut all) = (0.0, 0.0);
        for (x, y) in &pairs {
            let (x, y) = (x - a, y - b);
            off += (x - y) * (x - y);
            all += x * x + y * y;
        }
        (all > 0.0).then_some(off / all)
    }

    /// The best shift and its mismatch, of at most so many shifts that are tried first.
    fn best(&self, most: usize) -> (f64, f64) {
        let (Some(first), Some(last)) = (self.rows.first(), self.rows.last()) else { return (0.0, f64::INFINITY) };
        let (low, high) = (-last.0, self.end - first.0);
        let spacing = (last.0 - first.0) / (self.rows.len() as f64 - 1.0).max(1.0);
        let count = (((high - low) / spacing.max(1e-12)) as usize).clamp(2, most);
        let step = (high - low) / count as f64;
        let tried = (0..=count).filter_map(|k| {
            let shift = low + step * k as f64;
            Some((shift, self.mismatch(shift)?))
        });
        let Some((coarse, _)) = tried.min_by(|a, b| a.1.total_cmp(&b.1)) else { return (0.0, f64::INFINITY) };
        let shift = golden(coarse - step, coarse + step, |shift| self.mismatch(shift).unwrap_or(f64::INFINITY));
        (shift, self.mismatch(shift).unwrap_or(f64::INFINITY))
    }
}

/// The time shift (s) that aligns a motion with a run, and the mismatch that is left, by a search with
/// fewer rows and shifts than [`align`]: for many runs.
pub(crate) fn mismatch_and_shift(motion: &MeasuredMotion, trace: &MotionTrace, end: f64) -> (f64, f64) {
    Search::new(motion, trace, end, 300).best(400)
}

/// The minimum of a function between two points by golden sections.
pub(crate) fn golden(mut low: f64, mut high: f64, mut of: impl FnMut(f64) -> f64) -> f64 {
    let share = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut a, mut b) = (high - share * (high - low), low + share * (high - low));
    let (mut at_a, mut at_b) = (of(a), of(b));
    // 0.618^50 is 3e-11 of the interval.
    for _ in 0..50 {
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
        let (found, _) = align(&measured, &trace, 2.0, 0.0, AlignmentSettings::default());
        assert_eq!(found.sign, Sign::Reversed);
        assert!((found.shift + 3.4).abs() < 1e-5, "{found:?}");
        let given = AlignmentSettings { shift: Some(-3.3), sign: Some(Sign::AsIs) };
        let (found, _) = align(&measured, &trace, 2.0, 0.0, given);
        assert!(found.shift == -3.3 && found.sign == Sign::AsIs && found.mismatch > 0.5);
    }
}
