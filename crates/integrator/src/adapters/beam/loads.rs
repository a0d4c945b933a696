//! Loads on a beam that follow a signal, at fixed places or moving along it.

use crate::Signal;
use crate::signal::window;
use std::sync::Arc;
use teeter_beam::{Beam, Load, ModalBasis, SpanLoad};

/// A load on a beam that keeps its shape: a vector of nodal loads times a signal.
#[derive(Clone, Debug)]
pub struct SignalLoad {
    pattern: Vec<f64>,
    signal: Arc<dyn Signal>,
}

impl SignalLoad {
    /// The nodal loads `pattern` of a beam, as its `add_…_load` methods add them, times `signal`.
    #[must_use]
    pub fn new(pattern: Vec<f64>, signal: Arc<dyn Signal>) -> Self {
        Self { pattern, signal }
    }

    /// The same for coordinates η with q = Φ η: the pattern becomes Φᵀ pattern.
    pub(crate) fn in_basis(self, basis: &ModalBasis) -> Self {
        let work = |i| basis.shape(i).iter().zip(&self.pattern).map(|(phi, p)| phi * p).sum();
        Self { pattern: (0..basis.len()).map(work).collect(), signal: self.signal }
    }

    fn add_times(&self, factor: f64, f: &mut [f64]) {
        for (f, p) in f.iter_mut().zip(&self.pattern) {
            *f += factor * p;
        }
    }
}

impl Load for SignalLoad {
    fn add(&self, _beam: &Beam, t: f64, f: &mut [f64]) {
        self.add_times(self.signal.value(t), f);
    }

    fn add_mean(&self, _beam: &Beam, [from, to]: [f64; 2], _scratch: &mut [f64], f: &mut [f64]) {
        self.add_times(self.signal.mean(from, to), f);
    }

    fn next_break(&self, _beam: &Beam, t: f64) -> f64 {
        self.signal.next_break(t)
    }
}

/// A force that moves along a beam at a constant speed, times a signal; none while it is off the
/// beam.
///
/// Its mean over a step is that of P(t) N(x(t)), with x from its place at the step's start to that
/// at its end: by Gauss' points of each stretch within an element, with the moments of the signal
/// in their weights, so that it is exact for every signal.
#[derive(Clone, Debug)]
pub struct MovingForce {
    /// N, upwards.
    pub force: f64,
    /// Where it is at t = 0, m from the beam's left end.
    pub start: f64,
    /// m/s.
    pub speed: f64,
    /// What the force is multiplied by.
    pub signal: Arc<dyn Signal>,
}

impl MovingForce {
    /// Where it is at time `t` (s), m from the beam's left end; `None` off the beam.
    fn place(&self, beam: &Beam, t: f64) -> Option<f64> {
        let x = self.start + self.speed * t;
        (0.0..=beam.spec().span).contains(&x).then_some(x)
    }

    /// It at time `t` (s) as a load at its place; `None` while it is off the beam.
    #[must_use]
    pub fn at(&self, beam: &Beam, t: f64) -> Option<SpanLoad> {
        let x = self.place(beam, t)?;
        Some(SpanLoad::Point { x, force: self.force * self.signal.value(t), couple: 0.0 })
    }

    /// Its mean over the time from `times[0]` to `times[1]` (s), as the forces (N) at places (m)
    /// that do to every dof what it does. Allocates nothing.
    pub fn mean(&self, beam: &Beam, times: [f64; 2]) -> impl Iterator<Item = (f64, f64)> {
        let (all, span) = (times[1] - times[0], beam.spec().span);
        beam.passages(self.start, self.speed, times).flat_map(move |[from, to]| {
            let part = self.force * ((to - from) / all);
            window::weights(from, to, &self.signal.moments(from, to))
                .map(|(t, weight)| ((self.start + self.speed * t).clamp(0.0, span), part * weight))
        })
    }
}

impl Load for MovingForce {
    fn add(&self, beam: &Beam, t: f64, f: &mut [f64]) {
        if let Some(shape) = self.place(beam, t).and_then(|x| beam.shape_at(x)) {
            shape.add_load(self.force * self.signal.value(t), 0.0, f);
        }
    }

    fn add_mean(&self, beam: &Beam, times: [f64; 2], _scratch: &mut [f64], f: &mut [f64]) {
        for (x, force) in self.mean(beam, times) {
            beam.shape_clamped(x).add_load(force, 0.0, f);
        }
    }

    fn next_break(&self, beam: &Beam, t: f64) -> f64 {
        let mut next = self.signal.next_break(t);
        if self.speed != 0.0 {
            let nodes = beam.node_positions().iter();
            let passes = nodes.map(|x| (x - self.start) / self.speed).filter(|passes| *passes > t);
            next = passes.fold(next, f64::min);
        }
        next
    }
}
