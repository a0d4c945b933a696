//! Samples of a run, at the same times for all runs of a study.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use teeter_beam::ShapeAt;
use teeter_integrator::{Model, Observer, ObserverError, State, StepReport};
use teeter_report::{Bounces, Record};
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::{BeamPlace, Layout};

/// Sampling times: `count` samples, `every` seconds apart, from t = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sampling {
    /// Interval, s.
    pub every: f64,
    /// Number of samples.
    pub count: usize,
}

/// Approximate number of samples of a run.
const SAMPLES: f64 = 500.0;

impl Sampling {
    /// For a scene: some 500 samples, a whole number of the scene's own steps apart. Steps that
    /// divide this interval end at the samples; for others the motion is interpolated.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let (end, step) = (scene.time.end, scene.time.step);
        let every = step * (end / (SAMPLES * step)).round().max(1.0);
        Self { every, count: (end / every * (1.0 + 1e-9)).floor() as usize + 1 }
    }

    /// The time of a sample, s.
    #[must_use]
    pub fn time(&self, sample: usize) -> f64 {
        self.every * sample as f64
    }
}

/// A contact that closes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    /// End of the step, s.
    pub t: f64,
    /// Speed at which it closes, m/s.
    pub speed: f64,
}

/// The sampled motion of a run. The numbers of a sample are contiguous, one sample after the other.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SampledMotion {
    /// X, Y, φ of the blocks.
    pub poses: Vec<[f64; 3]>,
    /// Deflections of the beams at their probes, at midspan and midway between supports, m.
    pub deflections: Vec<f64>,
    /// Mechanical energy, J.
    pub energy: Vec<f64>,
    /// Normal impulse of each contact since the start, N·s.
    pub impulses: Vec<f64>,
    /// Deepest penetration so far, m.
    pub penetration: Vec<f64>,
    /// Times at which the angle of each block crosses zero, s.
    pub crossings: Vec<Vec<f64>>,
    /// Peaks of each block's angle between crossings, without the release, rad.
    pub peaks: Vec<Vec<(f64, f64)>>,
    /// The impacts of each contact, among the first 1000 of the run.
    pub impacts: Vec<Vec<Impact>>,
    /// The energy scale of the ledger, J.
    pub energy_scale: f64,
    /// Number of samples: fewer than requested if the run ended early.
    pub samples: usize,
    /// Time of a landing that depended on bounces cut short by the steps, s.
    pub contested: Option<f64>,
}

/// The observer that fills a [`SampledMotion`].
#[derive(Debug)]
pub(crate) struct Sampler<'a> {
    layout: &'a Layout,
    sampling: Sampling,
    cancel: &'a AtomicBool,
    blocks: usize,
    watched: Vec<(&'a BeamPlace, Vec<ShapeAt>)>,
    /// Names of the contacts.
    contacts: Vec<&'a str>,
    before: LastStep,
    bounces: Bounces,
    pub(crate) motion: SampledMotion,
}

/// The sampled values at the end of the last step.
#[derive(Debug, Default)]
struct LastStep {
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    energy: f64,
    impulses: Vec<f64>,
    now: Vec<f64>,
}

impl<'a> Sampler<'a> {
    pub(crate) fn new(sampling: Sampling, layout: &'a Layout, cancel: &'a AtomicBool) -> Self {
        let watched = |place: &'a BeamPlace| {
            (place, watched_places(place).into_iter().map(|x| place.beam.shape_clamped(x)).collect())
        };
        let pairs = layout.contact_names().count();
        Self {
            sampling,
            layout,
            cancel,
            blocks: layout.blocks.len(),
            watched: layout.beams.iter().map(watched).collect(),
            contacts: layout.contact_names().collect(),
            before: LastStep { impulses: vec![0.0; pairs], now: vec![0.0; pairs], ..LastStep::default() },
            bounces: Bounces::default(),
            motion: SampledMotion { impacts: vec![Vec::new(); pairs], ..SampledMotion::default() },
        }
    }

    /// The motion at the end of the run.
    pub(crate) fn finish(mut self, state: &State, record: &Record) -> SampledMotion {
        self.motion.energy_scale = state.ledger.scale;
        self.motion.contested = self.bounces.contested().map(|contested| contested.t);
        // Impacts, crossings and peaks are those of the summary.
        for impact in &record.impacts {
            if let Some(pair) = self.contacts.iter().position(|contact| *contact == impact.contact) {
                self.motion.impacts[pair].push(Impact { t: impact.t, speed: -impact.u_n_before });
            }
        }
        for monitor in &record.rocking {
            self.motion.crossings.push(monitor.crossings().iter().map(|crossing| crossing.t).collect());
            self.motion.peaks.push(monitor.peaks().iter().skip(1).map(|peak| (peak.t, peak.phi)).collect());
        }
        self.motion
    }

    /// Takes the sample at the fraction `s` of the step that ended with `state`; `piece` is the
    /// part without impacts that contains it.
    fn take(&mut self, s: f64, piece: &SmoothPart<'_>, state: &State) {
        let SmoothPart { s: within, h, q: [q0, q1], v: [v0, v1] } = *piece;
        let (before, motion) = (&self.before, &mut self.motion);
        let between = |k: usize| hermite(within, h, [q0[k], q1[k]], [v0[k], v1[k]]);
        for block in 0..self.blocks {
            motion.poses.push([0, 1, 2].map(|k| between(3 * block + k)));
        }
        for (place, shapes) in &self.watched {
            let range = place.range.clone();
            // Deflections are linear in the coordinates, so they are evaluated from q and v at both
            // ends.
            let of = |shape: &ShapeAt, x: &[f64]| place.deflection(shape, &x[range.clone()]).w;
            for shape in shapes {
                let (q, v) = ([of(shape, q0), of(shape, q1)], [of(shape, v0), of(shape, v1)]);
                motion.deflections.push(hermite(within, h, q, v));
            }
        }
        let linear = |a: f64, b: f64| a + s * (b - a);
        motion.energy.push(linear(before.energy, state.ledger.current.total()));
        motion.impulses.extend(before.impulses.iter().zip(&before.now).map(|(&a, &b)| linear(a, b)));
        motion.penetration.push(state.tally.max_penetration);
        motion.samples += 1;
    }

    fn keep(&mut self, state: &State) {
        let LastStep { t, q, v, energy, impulses, now } = &mut self.before;
        (*t, *energy) = (state.t, state.ledger.current.total());
        q.clone_from(&state.q);
        v.clone_from(&state.v);
        impulses.clone_from(now);
    }
}

/// A part of a step without impacts, and a time in it.
#[derive(Clone, Copy)]
struct SmoothPart<'a> {
    /// The elapsed fraction of the part.
    s: f64,
    /// Its duration, s.
    h: f64,
    /// Coordinates and velocities at both of its ends.
    q: [&'a [f64]; 2],
    v: [&'a [f64]; 2],
}

impl<'a> SmoothPart<'a> {
    /// The end of a step.
    fn end(state: &'a State) -> Self {
        Self { s: 1.0, h: 0.0, q: [&state.q; 2], v: [&state.v; 2] }
    }

    /// The part of a step that contains time `t` (s), at the fraction `s` of the step.
    fn of(step: &StepReport<'a, 2>, t: f64, s: f64) -> Option<Self> {
        let mut lasting = step.phases().filter(|phase| phase.end > phase.start);
        let phase = lasting.find(|phase| phase.end > t)?;
        let h = phase.end - phase.start;
        let whole = h == step.t_end - step.t_start;
        let within = if whole { s } else { (t - phase.start) / h };
        Some(Self { s: within, h, q: phase.q, v: phase.v })
    }
}

/// Where the deflection of a beam is sampled, m from its left end: at midpoints and probes.
fn watched_places(place: &BeamPlace) -> Vec<f64> {
    let mut places = place.middles();
    for x in &place.probes {
        if !places.contains(x) {
            places.push(*x);
        }
    }
    places
}

/// The cubic with these values and derivatives at both ends of a step of length `h`, at its
/// fraction `s`.
fn hermite(s: f64, h: f64, q: [f64; 2], v: [f64; 2]) -> f64 {
    if s >= 1.0 {
        return q[1];
    }
    let (a, b) = ((1.0 + 2.0 * s) * (1.0 - s) * (1.0 - s), s * s * (3.0 - 2.0 * s));
    let (c, d) = (s * (1.0 - s) * (1.0 - s), s * s * (s - 1.0));
    a * q[0] + b * q[1] + h * (c * v[0] + d * v[1])
}

/// A step that ends within this fraction of itself before a sample's time counts as ending at it.
const ROUNDING: f64 = 1e-6;

impl Observer<2> for Sampler<'_> {
    fn start(&mut self, _: &Model<2>, state: &State) -> Result<(), ObserverError> {
        self.keep(state);
        self.take(1.0, &SmoothPart::end(state), state);
        Ok(())
    }

    fn observe(
        &mut self,
        model: &Model<2>,
        step: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError> {
        self.bounces.enter(model, step);
        for contact in step.contacts() {
            if let Some(number) = self.layout.contact_number(contact.id) {
                self.before.now[number] += contact.p[0];
            }
        }
        let (start, h) = (self.before.t, state.t - self.before.t);
        while self.motion.samples < self.sampling.count {
            let s = (self.sampling.time(self.motion.samples) - self.before.t) / h;
            if s > 1.0 + ROUNDING {
                break;
            }
            if s > 1.0 - ROUNDING {
                self.take(1.0, &SmoothPart::end(state), state);
            } else {
                self.take(s, &SmoothPart::of(step, start + s * h, s).unwrap_or(SmoothPart::end(state)), state);
            }
        }
        self.keep(state);
        let cancelled = state.step.is_multiple_of(256) && self.cancel.load(Ordering::Relaxed);
        Ok(if cancelled { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_taken_exactly_between_steps() {
        let (q, v) = (|t: f64| 2.0 * t * t * t - t + 3.0, |t: f64| 6.0 * t * t - 1.0);
        for s in [0.0, 0.25, 0.7, 1.0] {
            let got = hermite(s, 0.5, [q(1.0), q(1.5)], [v(1.0), v(1.5)]);
            assert!((got - q(1.0 + 0.5 * s)).abs() < 1e-14, "{s}");
        }
    }
}
