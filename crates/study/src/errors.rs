//! Errors of a motion against the reference, in the quantities that matter to users, each in its
//! own norm.

use crate::{SampledMotion, Sampling};
use teeter_scenario::scene::Scene;

/// A quantity that is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// The largest of the errors of angle, position and deflection: of everything that moves.
    Accuracy,
    /// Angles of the blocks.
    Angle,
    /// Positions of the blocks' mass centres.
    Position,
    /// Deflections of the beams, at their probes, at midspan and midway between supports.
    Deflection,
    /// Times of impacts.
    ImpactTimes,
    /// Peaks of the angles between impacts.
    Peaks,
    /// Normal forces of the contacts.
    Forces,
    /// Mechanical energy.
    Energy,
    /// Deepest penetration: 0 in the exact motion, so no reference is needed.
    Penetration,
}

impl Quantity {
    /// All of them, in the order of the table.
    pub const ALL: [Self; 9] = [
        Self::Accuracy,
        Self::Angle,
        Self::Position,
        Self::Deflection,
        Self::ImpactTimes,
        Self::Peaks,
        Self::Forces,
        Self::Energy,
        Self::Penetration,
    ];

    /// Its name in files.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Accuracy => "accuracy",
            Self::Angle => "angle",
            Self::Position => "position",
            Self::Deflection => "deflection",
            Self::ImpactTimes => "impact_times",
            Self::Peaks => "peaks",
            Self::Forces => "forces",
            Self::Energy => "energy",
            Self::Penetration => "penetration",
        }
    }

    /// Its name for users.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Accuracy => "Accuracy",
            Self::Angle => "Angle",
            Self::Position => "Position",
            Self::Deflection => "Deflection",
            Self::ImpactTimes => "Impact times",
            Self::Peaks => "Peak angles",
            Self::Forces => "Contact forces",
            Self::Energy => "Energy",
            Self::Penetration => "Penetration",
        }
    }

    /// The norm of its error.
    #[must_use]
    pub fn norm(self) -> &'static str {
        match self {
            Self::Accuracy => {
                "the largest of the errors of angle, position and deflection, of those that the scene has"
            }
            Self::Angle => {
                "largest |φ − φ_ref| of any block at any sample before the horizon, over the largest |φ_ref|"
            }
            Self::Position => {
                "largest |x − x_ref| or |y − y_ref| of any block at any sample before the horizon, over its larger side"
            }
            Self::Deflection => {
                "largest |w − w_ref| of any beam at probes, midspan and midway between supports at any sample before the horizon, over the largest |w_ref|"
            }
            Self::ImpactTimes => {
                "largest |t − t_ref| of the impacts before the horizon, matched in order, over the mean time between them; an impact is a zero crossing of φ \
                 where a block rocks, else a contact that closes with at least 5 % of the largest closing speed; 1 where one is missing"
            }
            Self::Peaks => {
                "largest |φ_peak/φ_peak,ref − 1| of the peaks between two crossings before the horizon, matched in order; 1 if one is missing"
            }
            Self::Forces => {
                "largest |P − P_ref| of the normal impulse P of any contact in any window of 1/50 of the run, over the contact's whole P_ref before the horizon"
            }
            Self::Energy => {
                "largest |E − E_ref| of kinetic and potential energy at any sample before the horizon, over the energy scale of the ledger"
            }
            Self::Penetration => "deepest penetration before the horizon, over the largest side of a block",
        }
    }
}

/// An error for each quantity that the scene has.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Errors([Option<f64>; Quantity::ALL.len()]);

impl Errors {
    /// The error of a quantity; `None` if the scene doesn't have it.
    #[must_use]
    pub fn of(&self, quantity: Quantity) -> Option<f64> {
        self.0[quantity as usize]
    }

    /// The larger error for each quantity.
    #[must_use]
    pub fn larger(&self, other: &Self) -> Self {
        let mut errors = *self;
        for (mine, other) in errors.0.iter_mut().zip(other.0) {
            *mine = match (*mine, other) {
                (Some(a), Some(b)) => Some(a.max(b)),
                (a, b) => a.or(b),
            };
        }
        errors
    }

    /// Only an error of the accuracy.
    #[cfg(test)]
    pub(crate) fn of_accuracy(error: f64) -> Self {
        let mut errors = Self::default();
        errors.set(Quantity::Accuracy, Some(error));
        errors
    }

    fn set(&mut self, quantity: Quantity, error: Option<f64>) {
        // A motion that is not finite has an infinite error.
        self.0[quantity as usize] = error.map(|error| if error.is_nan() { f64::INFINITY } else { error });
    }
}

/// Angles that stay below this are ignored, as their error would be relative to rounding, rad.
const TURNS: f64 = 1e-6;
/// Deflections that stay below this fraction of the span are ignored.
const BENDS: f64 = 1e-12;
/// Impacts with a closing speed below this fraction of the largest one are not compared.
const IMPACT_SHARE: f64 = 0.05;
/// A contact that closes again within this fraction of the run counts as the same impact: a corner
/// on a beam closes many times.
const SAME_IMPACT: f64 = 0.01;
/// Samples of a window of forces, 1/50 of a run.
const WINDOW: usize = 10;

/// Scales of the errors, and the time up to which they are taken.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorNorms {
    /// The larger side of each block, m.
    sides: Vec<f64>,
    /// The block of each contact.
    owners: Vec<usize>,
    sampling: Sampling,
    /// Samples before the horizon.
    pub(crate) samples: usize,
    shortest: f64,
}

/// The block of each contact, by the numbers of [`Layout`](teeter_scenario::simulation::Layout): of
/// many pairs of a crowd that share a name, the first that takes part.
fn owners(scene: &Scene) -> Vec<usize> {
    let of_crowd = scene.crowd.iter().flat_map(|crowd| {
        let first = |contact: usize| (0..scene.blocks.len()).find(|block| crowd.takes_part(*block, Some(contact)));
        (0..crowd.contacts().len()).map(move |contact| first(contact).unwrap_or_default())
    });
    scene.contacts.iter().map(|contact| contact.block).chain(of_crowd).collect()
}

impl ErrorNorms {
    /// For motions of a scene, over all samples.
    #[must_use]
    pub fn new(scene: &Scene, sampling: Sampling) -> Self {
        Self {
            sides: scene.blocks.iter().map(|block| block.width.max(block.height)).collect(),
            owners: owners(scene),
            sampling,
            samples: sampling.count,
            shortest: SAME_IMPACT * scene.time.end,
        }
    }

    /// The same, up to this number of samples.
    #[must_use]
    pub fn up_to(mut self, samples: usize) -> Self {
        self.samples = samples;
        self
    }

    /// The time up to which errors are taken, s.
    #[must_use]
    pub fn horizon(&self) -> f64 {
        self.sampling.time(self.samples.saturating_sub(1))
    }

    /// Number of initial samples in which two motions agree in all quantities of the accuracy,
    /// within a share of the motion.
    #[must_use]
    pub fn agree(&self, a: &SampledMotion, reference: &SampledMotion, share: f64) -> usize {
        let (turn, bend) = (self.turn(reference), self.bend(reference));
        let count = self.samples.min(a.samples).min(reference.samples);
        let apart = |sample: usize| {
            let angle = turn.map_or(0.0, |turn| self.turned(a, reference, sample) / turn);
            let bent = bend.map_or(0.0, |bend| self.deflected(a, reference, sample) / bend);
            worse(worse(angle, bent), self.moved(a, reference, sample))
        };
        // Negated so that NaN fails too.
        (0..count).find(|&sample| !(apart(sample) <= share)).unwrap_or(count)
    }

    /// The errors of a motion.
    #[must_use]
    pub fn errors(&self, motion: &SampledMotion, reference: &SampledMotion) -> Errors {
        let samples = 0..self.samples.min(motion.samples).min(reference.samples);
        let largest = |of: &dyn Fn(usize) -> f64| samples.clone().map(of).fold(0.0, worse);
        let mut errors = Errors::default();
        if !self.sides.is_empty() {
            let angle = self.turn(reference).map(|turn| largest(&|k| self.turned(motion, reference, k)) / turn);
            errors.set(Quantity::Angle, angle);
            errors.set(Quantity::Position, Some(largest(&|k| self.moved(motion, reference, k))));
            let deepest = samples.end.checked_sub(1).and_then(|last| motion.penetration.get(last));
            let side = self.sides.iter().copied().fold(0.0, f64::max);
            errors.set(Quantity::Penetration, deepest.filter(|_| !self.owners.is_empty()).map(|depth| depth / side));
        }
        let bend = self.bend(reference);
        errors.set(Quantity::Deflection, bend.map(|bend| largest(&|k| self.deflected(motion, reference, k)) / bend));
        let moving = [Quantity::Angle, Quantity::Position, Quantity::Deflection].map(|moving| errors.of(moving));
        let accuracy = moving.into_iter().flatten().reduce(worse);
        errors.set(Quantity::Accuracy, accuracy);
        errors.set(Quantity::ImpactTimes, self.impact_times(motion, reference));
        errors.set(Quantity::Peaks, self.peaks(motion, reference));
        errors.set(Quantity::Forces, self.forces(motion, reference));
        let scale = reference.energy_scale;
        let energy = (scale > 0.0).then(|| largest(&|k| (motion.energy[k] - reference.energy[k]).abs()) / scale);
        errors.set(Quantity::Energy, energy);
        errors
    }

    /// The largest angle of the reference before the horizon, rad; `None` if nothing turns.
    fn turn(&self, reference: &SampledMotion) -> Option<f64> {
        let poses = &reference.poses[..self.sides.len() * self.samples.min(reference.samples)];
        let turn = poses.iter().map(|pose| pose[2].abs()).fold(0.0, f64::max);
        (turn > TURNS).then_some(turn)
    }

    fn bend(&self, reference: &SampledMotion) -> Option<f64> {
        let points = points(reference);
        let all = &reference.deflections[..points * self.samples.min(reference.samples)];
        let bend = all.iter().map(|w| w.abs()).fold(0.0, f64::max);
        (bend > BENDS).then_some(bend)
    }

    fn turned(&self, a: &SampledMotion, b: &SampledMotion, sample: usize) -> f64 {
        pairs(&a.poses, &b.poses, self.sides.len(), sample).map(|(a, b)| (a[2] - b[2]).abs()).fold(0.0, worse)
    }

    fn moved(&self, a: &SampledMotion, b: &SampledMotion, sample: usize) -> f64 {
        let poses = pairs(&a.poses, &b.poses, self.sides.len(), sample).zip(&self.sides);
        poses.map(|((a, b), side)| worse((a[0] - b[0]).abs(), (a[1] - b[1]).abs()) / side).fold(0.0, worse)
    }

    fn deflected(&self, a: &SampledMotion, b: &SampledMotion, sample: usize) -> f64 {
        pairs(&a.deflections, &b.deflections, points(b), sample).map(|(a, b)| (a - b).abs()).fold(0.0, worse)
    }

    fn impact_times(&self, motion: &SampledMotion, reference: &SampledMotion) -> Option<f64> {
        let horizon = self.horizon();
        let mut worst: Option<f64> = None;
        let mut enter = |times: &[f64], wanted: &[f64]| {
            if let Some(error) = matched(times, wanted, horizon) {
                worst = Some(worst.map_or(error, |worst| worse(worst, error)));
            }
        };
        let rocks = |block: usize| reference.crossings[block].first().is_some_and(|t| *t <= horizon);
        for block in (0..self.sides.len()).filter(|&block| rocks(block)) {
            enter(&motion.crossings[block], &reference.crossings[block]);
        }
        for (pair, &owner) in self.owners.iter().enumerate() {
            if !rocks(owner) {
                let fastest = reference.impacts[pair].iter().map(|impact| impact.speed).fold(0.0, f64::max);
                let of = |motion: &SampledMotion| self.impacts(motion, pair, IMPACT_SHARE * fastest);
                enter(&of(motion), &of(reference));
            }
        }
        worst
    }

    /// Times of a block's first impact and of the next one, over the whole run, s, as they are
    /// compared. `None` without impacts.
    #[must_use]
    pub(crate) fn first_impacts(&self, motion: &SampledMotion, block: usize) -> Option<(f64, Option<f64>)> {
        let mut times = motion.crossings.get(block)?.clone();
        if times.is_empty() {
            for pair in (0..self.owners.len()).filter(|&pair| self.owners[pair] == block) {
                let fastest = motion.impacts[pair].iter().map(|impact| impact.speed).fold(0.0, f64::max);
                times.extend(self.impacts(motion, pair, IMPACT_SHARE * fastest));
            }
            times.sort_by(f64::total_cmp);
        }
        Some((*times.first()?, times.iter().copied().find(|t| *t > times[0] + self.shortest)))
    }

    /// Number of blocks.
    pub(crate) fn blocks(&self) -> usize {
        self.sides.len()
    }

    /// Times of the impacts of a contact with at least the closing speed `least`.
    fn impacts(&self, motion: &SampledMotion, pair: usize, least: f64) -> Vec<f64> {
        let mut times: Vec<f64> = Vec::new();
        for impact in motion.impacts[pair].iter().filter(|impact| impact.speed >= least && least > 0.0) {
            if times.last().is_none_or(|last| impact.t - last > self.shortest) {
                times.push(impact.t);
            }
        }
        times
    }

    fn peaks(&self, motion: &SampledMotion, reference: &SampledMotion) -> Option<f64> {
        let horizon = self.horizon();
        let mut worst: Option<f64> = None;
        for (peaks, wanted) in motion.peaks.iter().zip(&reference.peaks) {
            for (number, (_, phi)) in wanted.iter().take_while(|(t, _)| *t <= horizon).enumerate() {
                let error = peaks.get(number).map_or(1.0, |peak| (peak.1 / phi - 1.0).abs());
                worst = Some(worst.map_or(error, |worst| worse(worst, error)));
            }
        }
        worst
    }

    fn forces(&self, motion: &SampledMotion, reference: &SampledMotion) -> Option<f64> {
        let contacts = self.owners.len();
        let last = self.samples.min(motion.samples).min(reference.samples).checked_sub(1)?;
        let mut worst: Option<f64> = None;
        for contact in 0..contacts {
            let at = |motion: &SampledMotion, sample: usize| motion.impulses[sample * contacts + contact];
            let whole = at(reference, last);
            if !(whole > 0.0) {
                continue;
            }
            let off = |from: usize| {
                let to = (from + WINDOW).min(last);
                let window = |motion: &SampledMotion| at(motion, to) - at(motion, from);
                (window(motion) - window(reference)).abs() / whole
            };
            let error = (0..last).step_by(WINDOW).map(off).fold(0.0, worse);
            worst = Some(worst.map_or(error, |worst| worse(worst, error)));
        }
        worst
    }
}

/// The larger of two errors; NaN counts as infinite.
fn worse(a: f64, b: f64) -> f64 {
    let finite = |x: f64| if x.is_nan() { f64::INFINITY } else { x };
    finite(a).max(finite(b))
}

/// Number of deflections in a sample.
fn points(motion: &SampledMotion) -> usize {
    motion.deflections.len() / motion.samples.max(1)
}

/// The values of two motions at a sample, `each` numbers long.
fn pairs<'a, T>(a: &'a [T], b: &'a [T], each: usize, sample: usize) -> impl Iterator<Item = (&'a T, &'a T)> {
    let range = sample * each..(sample + 1) * each;
    a[range.clone()].iter().zip(&b[range])
}

/// The largest difference of times matched in order, divided by the mean interval of the expected
/// ones up to the horizon; 1 if one is missing; `None` if none is expected.
fn matched(times: &[f64], wanted: &[f64], horizon: f64) -> Option<f64> {
    let wanted: Vec<f64> = wanted.iter().copied().take_while(|t| *t <= horizon).collect();
    let mean = wanted.last()? / wanted.len() as f64;
    if times.len() < wanted.len() {
        return Some(1.0);
    }
    Some(times.iter().zip(&wanted).map(|(t, wanted)| (t - wanted).abs()).fold(0.0, worse) / mean)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampled_motion::Impact;

    fn norms() -> ErrorNorms {
        ErrorNorms {
            sides: vec![0.5],
            owners: vec![0],
            sampling: Sampling { every: 0.1, count: 11 },
            samples: 11,
            shortest: 0.01,
        }
    }

    fn motion(phi: impl Fn(f64) -> f64, crossings: &[f64], peaks: &[(f64, f64)]) -> SampledMotion {
        let t = |k: usize| 0.1 * k as f64;
        SampledMotion {
            poses: (0..11).map(|k| [0.0, 1.0, phi(t(k))]).collect(),
            energy: vec![2.0; 11],
            impulses: (0..11).map(t).collect(),
            penetration: (0..11).map(|k| 1e-3 * t(k)).collect(),
            crossings: vec![crossings.to_vec()],
            peaks: vec![peaks.to_vec()],
            impacts: vec![vec![]],
            energy_scale: 4.0,
            samples: 11,
            ..SampledMotion::default()
        }
    }

    #[test]
    fn errors_are_relative_as_stated() {
        let reference = motion(|t| 0.2 - 0.4 * t, &[0.5], &[(0.9, -0.2)]);
        let mut other = motion(|t| 0.2 - 0.4 * t + if t > 0.75 { 0.01 } else { 0.0 }, &[0.51], &[(0.9, -0.19)]);
        other.poses[3][0] = 0.001;
        other.energy[4] = 2.2;
        for k in 5..11 {
            other.impulses[k] += 0.1;
        }
        let errors = norms().errors(&other, &reference);
        let expect = [
            (Quantity::Angle, 0.05),
            (Quantity::Position, 0.002),
            (Quantity::Accuracy, 0.05),
            (Quantity::ImpactTimes, 0.02),
            (Quantity::Peaks, 0.05),
            (Quantity::Forces, 0.1),
            (Quantity::Energy, 0.05),
            (Quantity::Penetration, 2e-3),
        ];
        for (quantity, wanted) in expect {
            assert!((errors.of(quantity).unwrap() - wanted).abs() < 1e-12, "{quantity:?}: {:?}", errors.of(quantity));
        }
        assert_eq!(errors.of(Quantity::Deflection), None);
        let early = norms().up_to(3).errors(&other, &reference);
        assert!(early.of(Quantity::Accuracy).unwrap() < 1e-15, "before anything differs");
        assert_eq!(early.of(Quantity::ImpactTimes), None, "no impact is due by then");
    }

    #[test]
    fn a_beam_that_is_off_counts_where_there_is_a_block_too() {
        let bent = |by: f64| SampledMotion {
            deflections: (0..11).map(|k| by * f64::from(k)).collect(),
            ..motion(|t| t, &[], &[])
        };
        let errors = norms().errors(&bent(1.45e-3), &bent(1e-3));
        assert!((errors.of(Quantity::Accuracy).unwrap() - 0.45).abs() < 1e-12, "{errors:?}");
        assert_eq!(errors.of(Quantity::Angle), Some(0.0));
        // At sample 1, by 0.045 of the largest deflection; at sample 0 there is none.
        assert_eq!(norms().agree(&bent(1.45e-3), &bent(1e-3), 0.01), 1);
    }

    #[test]
    fn motions_agree_up_to_where_they_part() {
        let reference = motion(|t| 0.2 - 0.4 * t, &[], &[]);
        let divergence = motion(|t| 0.2 - 0.4 * t + if t > 0.55 { 1e-3 } else { 1e-6 }, &[], &[]);
        assert_eq!(norms().agree(&divergence, &reference, 1e-4), 6);
        assert_eq!(norms().agree(&divergence, &reference, 1e-2), 11);
        let lost = motion(|t| if t > 0.25 { f64::NAN } else { 0.2 - 0.4 * t }, &[], &[]);
        assert_eq!(norms().agree(&lost, &reference, 1e-2), 3);
        assert_eq!(norms().errors(&lost, &reference).of(Quantity::Accuracy), Some(f64::INFINITY));
    }

    #[test]
    fn impacts_are_matched_in_order_and_a_missing_one_counts_whole() {
        assert_eq!(matched(&[1.0, 2.1, 3.0], &[1.0, 2.0], 10.0), Some((2.1_f64 - 2.0) / 1.0));
        assert_eq!(matched(&[1.0], &[1.0, 2.0], 10.0), Some(1.0));
        assert_eq!(matched(&[1.0], &[1.0, 2.0], 1.5), Some(0.0), "the second is beyond the horizon");
        assert_eq!(matched(&[1.0], &[], 1.5), None);
    }

    #[test]
    fn a_contact_that_closes_many_times_at_once_is_one_impact() {
        let mut bouncing = motion(|_| 0.0, &[], &[]);
        let impact = |t, speed| Impact { t, speed };
        bouncing.impacts[0] = vec![impact(0.2, 1.0), impact(0.201, 0.5), impact(0.5, 0.04), impact(0.6, 0.8)];
        assert_eq!(norms().impacts(&bouncing, 0, 0.05), [0.2, 0.6]);
        assert_eq!(norms().errors(&bouncing, &bouncing).of(Quantity::ImpactTimes), Some(0.0));
        assert_eq!(norms().errors(&bouncing, &bouncing).of(Quantity::Angle), None, "nothing turns");
    }
}
