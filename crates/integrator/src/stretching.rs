//! Tension that grows with the square of a deflection, as an unknown of a θ step.
//!
//! A subsystem that stretches has V = ¼κ s² beside a quadratic potential, with s = qᵀG q and the
//! tension N = κ s (a beam whose ends are held along its axis, `docs/theory.md` §1). The step takes
//!
//! ```text
//! N̄ = ½κ (s⁰ + s¹),   force −N̄ G q_θ,   q_θ = θq¹ + (1−θ)q⁰
//! ```
//!
//! whose work, because s¹ − s⁰ = (q⁰ + q¹)ᵀG Δq, is −ΔV − (θ−½) N̄ ΔqᵀG Δq: for θ = ½ the energy
//! itself is kept, for θ > ½ what is lost has a sign. (Discrete gradients: Gonzalez 1996, doi
//! 10.1007/BF02440162.)
//!
//! N̄ depends on v¹, and with it on the impulses of contacts. So the step is solved in rounds, each
//! about the Δv_k of the one before, 0 at first:
//!
//! ```text
//! N_k = ½κ (s⁰ + s¹),  g_k = G q_θ  at Δv_k
//! force −N_k G q_θ − d g_k,   d = κhθ g_kᵀ(Δv − Δv_k)
//! A_k = M + hθC + h²θ²(K + N_k G) + κh²θ g_k g_kᵀ
//! A_k Δv = h[f(q*) − N_k G q* + κhθ (g_kᵀΔv_k) g_k] + Jᵀp,   q* = q⁰ + hθv⁰
//! ```
//!
//! f being all other forces. That is linear in v¹ with a symmetric
//! matrix, positive definite wherever K + M/(hθ)² is, as N_k ≥ ½κ s⁰ ≥ 0; so every round has a
//! contact problem like any other. (Newton's matrix has g_k (G q¹)ᵀ in place of g_k g_kᵀ, and isn't
//! symmetric.) At a fixed point, Δv = Δv_k, the force is that above and the contacts' law holds with
//! the velocities that it gives, so the identity of energy is that of the step, contacts included.
//!
//! Near it errors shrink by at most κh²θ/2 |g|·|G Δq| in the norm of A_k⁻¹ a round, which with x =
//! q̄ᵀG q̄ and y = ¼ΔqᵀG Δq, for θ = ½, is below 2√(xy)/√((x + y)(3x + y)) < 0.74 whatever h is, and
//! of order h³ where the step resolves the motion. Impulses without friction don't change that: they
//! project in the norm of A_k. Far from it, where a step is as long as a swing, the rounds may
//! wander; then N_k alone is the unknown, without the matrix of rank one: N − N̄(N) is at most 0 at
//! ½κ s⁰, and positive for large N, so a root lies between and is closed in on.

use crate::factors::Factors;
use crate::subsystem::dot;
use crate::{Compliance, Model, Weights};
use std::ops::Range;
use teeter_contact::{Outcome, Residual, Status};

/// A potential ¼κ (qᵀG q)² beside a quadratic one. Coordinates and velocities are as many, and
/// [`Dynamics::retract`](crate::Dynamics::retract) adds them.
pub trait Stretching: Send + Sync {
    /// κ ≥ 0: what qᵀG q is multiplied with to be the tension, N per unit of the form.
    fn stiffness(&self) -> f64;

    /// xᵀG y, of a symmetric G that is at least semidefinite.
    fn form(&self, x: &[f64], y: &[f64]) -> f64;

    /// y += a G x.
    fn add_product(&self, a: f64, x: &[f64], y: &mut [f64]);

    /// Adds the internal forces at (q, v) to `f` as
    /// [`Dynamics::internal_force`](crate::Dynamics::internal_force) does, N, but that of the tension:
    /// at q* it may be far larger than anything at the ends of a step.
    fn force_beside(&self, q: &[f64], v: &[f64], f: &mut [f64]);
}

/// Rounds end where the force is off by at most this part of the tension: well above what rounding
/// leaves of a sum over a beam's elements, well below any other error of a step.
const FOUND: f64 = 1e-12;

/// Rounds in which an error below [`NEAR`] hasn't halved, after which it is rounding. By the bound
/// above three suffice for a half.
const STALLED: u32 = 4;

/// An error that no step wanders at.
const NEAR: f64 = 1e-6;

/// Rounds after which a root is closed in on.
const WANDERS: u32 = 20;

/// Most rounds of a step: closing in takes some ten, bisection alone would take fifty.
const MOST_ROUNDS: u32 = 100;

/// The parts of a model that stretch, within one step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tensions {
    /// Memory; the first `count` are of this step.
    parts: Vec<Tension>,
    count: usize,
    /// Velocities without impulses of contacts, of all parts.
    v_free: Vec<f64>,
    rounds: u32,
    /// The least error so far, and the rounds since it halved.
    least: f64,
    stalled: u32,
    /// That of the last round, as a part of the tension.
    error: f64,
}

/// One of them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tension {
    part: usize,
    /// What the other forces give over the step, N s.
    impulse: Vec<f64>,
    /// The velocities that it is added to.
    base: Vec<f64>,
    /// G q*.
    g_start: Vec<f64>,
    /// s⁰.
    form_start: f64,
    /// N_k.
    tension: f64,
    /// N̄ of the end that was tried last.
    mean: f64,
    /// Too small and too large an N, each with its N − N̄(N).
    between: [(f64, f64); 2],
    /// Δv_k, q_θ and g there.
    dv: Vec<f64>,
    at: Vec<f64>,
    g: Vec<f64>,
    /// Of the end that was tried last: Δv, q¹, q_θ.
    next: [Vec<f64>; 3],
    change: Vec<f64>,
    /// What the rounds leave of the identity of energy, with θ's own dissipation, J.
    numerical: f64,
}

/// The step, as a part of a model has it.
#[derive(Clone, Copy)]
pub(crate) struct Taken<'a> {
    pub(crate) stretching: &'a dyn Stretching,
    pub(crate) h: f64,
    pub(crate) theta: f64,
    pub(crate) q: &'a [f64],
    pub(crate) v: &'a [f64],
}

impl Tensions {
    /// Makes room for the parts of a model that stretch.
    pub(crate) fn reserve<const D: usize>(&mut self, model: &Model<D>) {
        self.clear();
        let stretching = model.parts().iter().filter(|part| part.stretching().is_some());
        for (place, part) in stretching.enumerate() {
            if place == self.parts.len() {
                self.parts.push(Tension::default());
            }
            self.parts[place].resize(part.v.len());
            self.v_free.resize(model.size().v, 0.0);
        }
    }

    /// Begins a step.
    pub(crate) fn clear(&mut self) {
        self.count = 0;
        self.begin_rounds();
    }

    fn begin_rounds(&mut self) {
        (self.rounds, self.stalled, self.least) = (0, 0, f64::INFINITY);
    }

    /// Whether any part stretches.
    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// How many do.
    pub(crate) fn len(&self) -> u64 {
        self.count as u64
    }

    /// Enters a part with its other forces over the step (N s), and q* before them; leaves its
    /// velocities of the first round in `v_end`, which hold those that the forces are to change.
    pub(crate) fn enter<const D: usize>(
        &mut self,
        part: usize,
        step: &Taken<'_>,
        [q_forces, impulse]: [&[f64]; 2],
        factor: &mut dyn Compliance<D>,
        v_end: &mut [f64],
    ) {
        if self.count == self.parts.len() {
            self.parts.push(Tension::default());
        }
        let own = &mut self.parts[self.count];
        self.count += 1;
        own.part = part;
        own.begin(step, q_forces, impulse, v_end);
        own.solve(step, factor, v_end);
    }

    /// Remembers the velocities without impulses that all parts have now.
    pub(crate) fn keep(&mut self, v_free: &[f64]) {
        self.v_free.clear();
        self.v_free.extend_from_slice(v_free);
    }

    /// Looks at the end of the step that was tried, with velocities `v_end`; whether another round
    /// is to be taken.
    pub(crate) fn look<'a>(
        &mut self,
        v_end: &[f64],
        step: impl Fn(usize) -> Option<(Taken<'a>, Range<usize>)>,
    ) -> bool {
        self.error = 0.0;
        for own in &mut self.parts[..self.count] {
            if let Some((step, range)) = step(own.part) {
                self.error = self.error.max(own.look(&step, &v_end[range]));
            }
        }
        self.rounds += 1;
        if self.error < 0.5 * self.least {
            (self.least, self.stalled) = (self.error, 0);
        } else {
            self.stalled += 1;
        }
        let is_rounding = self.error <= NEAR && self.stalled >= STALLED;
        let ends = self.error <= FOUND || is_rounding || self.rounds == MOST_ROUNDS;
        if ends {
            self.begin_rounds();
        }
        !ends
    }

    /// Takes the next round, about the end that was tried: leaves the velocities without impulses of
    /// all parts in `v_end`.
    pub(crate) fn take_next<'a, const D: usize>(
        &mut self,
        v_end: &mut [f64],
        step: impl Fn(usize) -> Option<(Taken<'a>, Range<usize>)>,
        factors: &mut Factors<D>,
        w: Weights,
    ) {
        v_end.copy_from_slice(&self.v_free);
        for own in &mut self.parts[..self.count] {
            if let (Some((step, range)), Some(factor)) = (step(own.part), factors.of(own.part, w)) {
                match self.rounds {
                    0..WANDERS => own.take_next(&step),
                    WANDERS => own.begin_closing_in(&step),
                    round => own.close_in(round),
                }
                own.solve(&step, factor, &mut v_end[range]);
            }
        }
    }

    /// The outcome of a step, which is unsolved where the tension was not found to `tolerance`.
    pub(crate) fn judge(&self, outcome: Option<Outcome>, tolerance: f64) -> Option<Outcome> {
        if self.is_empty() || self.error <= tolerance.max(FOUND) || outcome.is_some_and(|outcome| !outcome.converged())
        {
            return outcome;
        }
        let iterations = outcome.map_or(0, |outcome| outcome.iterations);
        Some(Outcome::new(Status::Stalled, "tension", iterations, Residual::new(self.error, self.error, 0)))
    }

    /// What a part adds to the dissipation of the scheme, J; `None` for one that doesn't stretch.
    pub(crate) fn numerical(&self, part: usize) -> Option<f64> {
        self.parts[..self.count].iter().find(|own| own.part == part).map(|own| own.numerical)
    }
}

impl Tension {
    fn resize(&mut self, n: usize) {
        let Self { impulse, base, g_start, dv, at, g, next: [dv_next, end, at_next], change, .. } = self;
        for x in [impulse, base, g_start, dv, at, g, dv_next, end, at_next, change] {
            x.resize(n, 0.0);
        }
    }

    fn begin(&mut self, step: &Taken<'_>, q_forces: &[f64], impulse: &[f64], base: &[f64]) {
        let s = step.stretching;
        self.resize(base.len());
        self.g_start.fill(0.0);
        s.add_product(1.0, q_forces, &mut self.g_start);
        self.impulse.copy_from_slice(impulse);
        self.base.copy_from_slice(base);
        self.form_start = s.form(step.q, step.q);
        // Δv = 0: where what is at rest ends.
        self.next[0].fill(0.0);
        self.place(step);
        self.take_next(step);
    }

    /// Leaves q¹ and q_θ of the Δv tried last.
    fn place(&mut self, step: &Taken<'_>) {
        let [dv, end, at] = &mut self.next;
        for (k, (end, at)) in end.iter_mut().zip(at.iter_mut()).enumerate() {
            let dq = step.h * (step.v[k] + step.theta * dv[k]);
            (*end, *at) = (step.q[k] + dq, step.q[k] + step.theta * dq);
        }
    }

    /// N̄ with the end tried last.
    fn mean_with_end(&self, step: &Taken<'_>) -> f64 {
        let end = &self.next[1];
        0.5 * step.stretching.stiffness() * (self.form_start + step.stretching.form(end, end))
    }

    /// The next round is about the end tried last.
    fn take_next(&mut self, step: &Taken<'_>) {
        self.tension = self.mean_with_end(step);
        self.dv.copy_from_slice(&self.next[0]);
        self.at.copy_from_slice(&self.next[2]);
        self.g.fill(0.0);
        step.stretching.add_product(1.0, &self.at, &mut self.g);
    }

    /// From here on N_k alone is the unknown: the N̄ found last first.
    fn begin_closing_in(&mut self, step: &Taken<'_>) {
        self.tension = self.mean;
        self.g.fill(0.0);
        self.between = [(0.5 * step.stretching.stiffness() * self.form_start, f64::NAN), (f64::INFINITY, f64::NAN)];
    }

    /// The next N_k between one that is too small and one that is too large: by their secant and by
    /// halves in turn.
    fn close_in(&mut self, round: u32) {
        let off = self.tension - self.mean;
        self.between[usize::from(off > 0.0)] = (self.tension, off);
        let [(low, below), (high, above)] = self.between;
        let secant = low - below * (high - low) / (above - below);
        self.tension = if high == f64::INFINITY {
            4.0 * self.mean
        } else if round.is_multiple_of(2) && secant > low && secant < high {
            secant
        } else {
            0.5 * (low + high)
        };
    }

    /// A_k, and the velocities without impulses.
    fn solve<const D: usize>(&mut self, step: &Taken<'_>, factor: &mut dyn Compliance<D>, v_end: &mut [f64]) {
        let kappa = step.stretching.stiffness() * step.h * step.theta;
        factor.stretch(self.tension, step.h * kappa, &self.g);
        let along = step.h * kappa * dot(&self.g, &self.dv);
        let pull = step.h * self.tension;
        for (k, v) in v_end.iter_mut().enumerate() {
            *v = self.impulse[k] - pull * self.g_start[k] + along * self.g[k];
        }
        factor.solve(v_end);
        v_end.iter_mut().zip(&self.base).for_each(|(v, base)| *v += base);
    }

    /// Looks at an end; by how much the force on it is off, as a part of the tension.
    fn look(&mut self, step: &Taken<'_>, v_end: &[f64]) -> f64 {
        let (s, theta) = (step.stretching, step.theta);
        for (dv, (v1, v0)) in self.next[0].iter_mut().zip(v_end.iter().zip(step.v)) {
            *dv = v1 - v0;
        }
        self.place(step);
        let mean = self.mean_with_end(step);
        self.mean = mean;
        let Self { next: [dv, end, at], dv: dv_taken, at: taken, g, change, tension, form_start, .. } = self;
        take_difference(change, dv, dv_taken);
        let d = s.stiffness() * step.h * theta * dot(g, change);
        take_difference(change, at, taken);
        let (turned, form) = (s.form(change, change), s.form(at, at));
        let off = (mean - *tension - d).abs() + if form > 0.0 { d.abs() * (turned / form).sqrt() } else { 0.0 };
        // ΔV = N̄ q̄ᵀG Δq, less the work N_k q_θᵀG Δq + d gᵀΔq.
        take_difference(change, end, step.q);
        let halfway = 0.5 * (s.form(end, end) - *form_start);
        let beside = (theta - 0.5) * s.form(change, change);
        self.numerical = (mean - *tension) * halfway - d * dot(g, change) - *tension * beside;
        // What doesn't stretch needs no tension; what is not finite is found at the end of the step.
        if mean > 0.0 { off / mean } else { 0.0 }
    }
}

/// out = x − y.
fn take_difference(out: &mut Vec<f64>, x: &[f64], y: &[f64]) {
    out.clear();
    out.extend(x.iter().zip(y).map(|(x, y)| x - y));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a step whose mean tension falls steeply with that which the step takes, so that N ← N̄(N) goes back and forth for ever.
    #[test]
    fn a_root_is_closed_in_on_wherever_the_rounds_wandered_to() {
        for (most, power) in [(1.0, 1), (1e4, 2), (1e9, 4), (1e-6, 8)] {
            let mean = |tension: f64| 0.5 + most / (1.0 + tension).powi(power);
            for wandered in [0.6, 1.0, 1e3, 1e9] {
                let mut own = Tension { tension: wandered, mean: mean(wandered), ..Tension::default() };
                own.between = [(0.5, f64::NAN), (f64::INFINITY, f64::NAN)];
                for round in WANDERS + 1..MOST_ROUNDS {
                    own.close_in(round);
                    own.mean = mean(own.tension);
                }
                let off = own.mean / own.tension - 1.0;
                assert!(off.abs() < FOUND, "{most} {power} {wandered}: {off:e}");
            }
        }
    }

    #[test]
    fn a_step_is_unsolved_where_a_tension_was_not_found() {
        let solved = Outcome::new(Status::Converged, "pgs", 7, Residual::new(1e-14, 1e-14, 0));
        let unsolved = Outcome::new(Status::MaxIterations, "pgs", 7, Residual::new(1e-3, 1e-3, 0));
        let with = |error, count| Tensions { error, count, ..Tensions::default() };
        assert_eq!(with(1e-11, 1).judge(Some(solved), 1e-10), Some(solved));
        assert_eq!(with(1e-13, 1).judge(None, 0.0), None);
        assert_eq!(with(1.0, 0).judge(None, 1e-10), None);
        assert_eq!(with(1e-3, 1).judge(Some(unsolved), 1e-10), Some(unsolved));
        for outcome in [Some(solved), None] {
            let judged = with(1e-3, 1).judge(outcome, 1e-10).unwrap();
            let found = (judged.status, judged.used, judged.residual.global, judged.iterations);
            assert_eq!(found, (Status::Stalled, "tension", 1e-3, outcome.map_or(0, |outcome| outcome.iterations)));
        }
    }
}
