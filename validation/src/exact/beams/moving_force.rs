//! A constant force that crosses a pinned–pinned Euler–Bernoulli beam (Frýba, *Vibration of Solids and Structures under Moving Loads*,
//! 3rd edition 1999, chapter 1).
//!
//! The beam is at rest until the force P comes upon it at t = 0, x = 0, with the speed c; it leaves at t = L/c. In w = Σ q_j sin(jπx/L) every
//! mode has its own equation, with viscous damping of the decay rate δ,
//!
//! ```text
//! q̈_j + 2δ q̇_j + ω_j² q_j = (2P/ρAL) sin Ω_j t,      Ω_j = jπc/L, ω_j = (jπ/L)² √(EI/ρA)
//! ```
//!
//! then, from L/c on, zero on the right. Its solution is written out here from the equation; Frýba writes the same in other symbols.
//! The terms fall like j⁻⁴ only, as those of a force at rest do: the sum is taken of the difference to that, which falls like j⁻⁵, and the
//! rest added in closed form. It has no value where a mode is in resonance without damping, Ω_j = ω_j.

use super::Uniform;
use super::ends::PINNED;
use super::statics::{Load, Problem};
use std::f64::consts::PI;

/// A force on its way over a beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crossing {
    pub(crate) beam: Uniform,
    /// P, N, upwards.
    pub(crate) force: f64,
    /// c, m/s.
    pub(crate) speed: f64,
    /// δ, 1/s: viscous damping per length over 2ρA; less than ω₁.
    pub(crate) decay: f64,
}

/// Modes in the sums. What is left out is smaller than the first term by some 1e-13 for w, 1e-9 for M.
const MODES: u32 = 3000;

impl Crossing {
    /// L/c, s.
    pub(crate) fn passage(&self) -> f64 {
        self.beam.span / self.speed
    }

    /// w, m, at `x` and time `t` ≥ 0.
    pub(crate) fn deflection(&self, x: f64, t: f64) -> f64 {
        let (at_rest, _) = self.at_rest(x, t);
        at_rest + self.sum(x, t, |_| 1.0)
    }

    /// M, N·m, at `x` and time `t` ≥ 0.
    #[cfg_attr(not(test), expect(dead_code, reason = "no case compares with it yet"))]
    pub(crate) fn moment(&self, x: f64, t: f64) -> f64 {
        let (_, at_rest) = self.at_rest(x, t);
        at_rest + self.sum(x, t, |k| -self.beam.bending * k * k)
    }

    /// w and M of the force at rest where it is at time `t`; zero once it has left.
    fn at_rest(&self, x: f64, t: f64) -> (f64, f64) {
        if t >= self.passage() {
            return (0.0, 0.0);
        }
        let Uniform { span, bending, .. } = self.beam;
        let loads = vec![Load::Force(self.speed * t, self.force)];
        let problem = Problem { span, bending, shear: f64::INFINITY, ends: [PINNED, PINNED], loads };
        problem.solve().map_or((f64::NAN, f64::NAN), |bent| (bent.at(x).deflection, bent.at(x).moment))
    }

    /// Σ (q_j less its value for a force at rest) sin(jπx/L), each times `weight` of jπ/L; smallest terms first.
    fn sum(&self, x: f64, t: f64, weight: impl Fn(f64) -> f64) -> f64 {
        let terms = (1..=MODES).rev().map(|j| {
            let k = f64::from(j) * PI / self.beam.span;
            weight(k) * self.mode(j, t) * (k * x).sin()
        });
        terms.sum()
    }

    /// q_j less its value for a force at rest where it is.
    fn mode(&self, j: u32, t: f64) -> f64 {
        let passage = self.passage();
        let [_, _, surplus] = self.under_force(j, t.min(passage));
        if t <= passage {
            return surplus;
        }
        // At the end of the passage the force at rest would bend nothing; from there on the mode is free.
        let [q, velocity, _] = self.under_force(j, passage);
        let omega = self.beam.frequency(f64::from(j) * PI);
        let damped = super::decay::damped_frequency(omega, self.decay);
        let s = t - passage;
        (-self.decay * s).exp() * (q * (damped * s).cos() + (velocity + self.decay * q) / damped * (damped * s).sin())
    }

    /// q_j, q̇_j, and q_j less its value for a force at rest, while the force is on the beam.
    fn under_force(&self, j: u32, t: f64) -> [f64; 3] {
        let order = f64::from(j);
        let (omega, d) = (self.beam.frequency(order * PI), self.decay);
        let forcing = order * PI * self.speed / self.beam.span;
        let damped = super::decay::damped_frequency(omega, d);
        let unit = 2.0 * self.force / (self.beam.mass * self.beam.span);
        // Forced: a sin Ωt + b cos Ωt; free: e^{−δt} (−b cos ω_d t + f sin ω_d t), so that it starts at rest.
        let detuning = (omega - forcing) * (omega + forcing);
        let scale = detuning * detuning + 4.0 * d * d * forcing * forcing;
        let (a, b) = (detuning / scale, -2.0 * d * forcing / scale);
        let f = -(forcing * a + d * b) / damped;
        let (sin, cos) = if t == self.passage() {
            (0.0, if j.is_multiple_of(2) { 1.0 } else { -1.0 })
        } else {
            (forcing * t).sin_cos()
        };
        let (free_sin, free_cos) = (damped * t).sin_cos();
        let free = (-d * t).exp() * (-b * free_cos + f * free_sin);
        let free_rate = -d * free + (-d * t).exp() * damped * (b * free_sin + f * free_cos);
        // a − 1/ω² without the difference of near numbers.
        let surplus = (forcing * forcing * detuning - 4.0 * d * d * forcing * forcing) / (scale * omega * omega);
        [
            unit * (a * sin + b * cos + free),
            unit * (forcing * (a * cos - b * sin) + free_rate),
            unit * (surplus * sin + b * cos + free),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::extrapolation::integrate;
    use super::super::tests::agree;
    use super::*;

    const BEAM: Uniform = Uniform { span: 1.3, bending: 2.1, mass: 0.4 };

    fn crossing(speed: f64, decay: f64) -> Crossing {
        Crossing { beam: BEAM, force: -1.7, speed, decay }
    }

    /// The modes' equations, integrated.
    #[test]
    fn each_mode_follows_its_equation() {
        for (speed, decay) in [(1.1, 0.0), (2.9, 0.8)] {
            let crossing = crossing(speed, decay);
            let passage = crossing.passage();
            for j in [1, 2, 3, 7] {
                // In units of 1/ω and of the deflection at rest, so that the integration's tolerance is a relative one.
                let order = f64::from(j);
                let omega = BEAM.frequency(order * PI);
                let unit = 2.0 * crossing.force / (BEAM.mass * BEAM.span);
                let size = unit / (omega * omega);
                let forcing = order * PI * speed / BEAM.span / omega;
                let motion = |on: f64| {
                    move |t: f64, y: &[f64; 2]| [y[1], on * (forcing * t).sin() - 2.0 * decay / omega * y[1] - y[0]]
                };
                let run = |on, start, end: f64| integrate(motion(on), start, end * omega, 0.5, |_| 1.0);
                let middle = run(1.0, (0.0, [0.0; 2]), 0.4 * passage);
                let [q, rate, surplus] = crossing.under_force(j, 0.4 * passage);
                assert!((q / size - middle.y[0]).abs() < 1e-12, "{j} {q} {middle:?}");
                assert!((rate / (size * omega) - middle.y[1]).abs() < 1e-12, "{j} {rate} {middle:?}");
                assert!((q / size - (order * PI * 0.4).sin() - surplus / size).abs() < 1e-12);
                let end = run(1.0, (0.0, [0.0; 2]), passage);
                let after = run(0.0, (end.t, end.y), 1.3 * passage);
                assert!((crossing.mode(j, 1.3 * passage) / size - after.y[0]).abs() < 1e-12, "{j} {after:?}");
            }
        }
    }

    /// A slow force bends the beam as one at rest; a fast one hardly at all.
    #[test]
    fn slow_and_fast() {
        let slow = crossing(1e-4, 0.5);
        let t = 0.5 * slow.passage();
        agree(slow.deflection(0.65, t), -1.7 * 1.3_f64.powi(3) / (48.0 * 2.1), 1e-4);
        agree(slow.moment(0.65, t), 1.7 * 1.3 / 4.0, 1e-4);
        let fast = crossing(1e4, 0.5);
        assert!(fast.deflection(0.65, fast.passage()).abs() < 1e-3 * 1.7 * 1.3_f64.powi(3) / (48.0 * 2.1));
    }

    /// Nothing jumps where the force leaves, nor at the start; the supports stay.
    #[test]
    fn the_motion_is_continuous() {
        let crossing = crossing(2.9, 0.8);
        let end = crossing.passage();
        let [before, after] = [end * (1.0 - 1e-9), end * (1.0 + 1e-9)].map(|t| crossing.deflection(0.5, t));
        agree(before, after, 1e-7);
        assert!(crossing.deflection(0.65, 0.0).abs() < 1e-15 && crossing.deflection(1.3, 0.2).abs() < 1e-15);
        assert!(crossing.deflection(0.65, 0.2).abs() > 1e-3);
    }

    /// Far fewer modes give the same: the sum has converged.
    #[test]
    fn the_sum_has_converged() {
        let crossing = crossing(1.1, 0.3);
        let (t, x) = (0.47 * crossing.passage(), 0.6);
        let partial = |modes: u32, weight: fn(f64) -> f64| -> f64 {
            let term = |j: u32| {
                let k = f64::from(j) * PI / BEAM.span;
                weight(k) * crossing.mode(j, t) * (k * x).sin()
            };
            (1..=modes).rev().map(term).sum()
        };
        let at_rest = crossing.at_rest(x, t);
        assert!((at_rest.0 + partial(300, |_| 1.0) - crossing.deflection(x, t)).abs() < 1e-10 * at_rest.0.abs());
        let moment = at_rest.1 + partial(300, |k| -BEAM.bending * k * k);
        assert!((moment - crossing.moment(x, t)).abs() < 1e-5 * at_rest.1.abs());
    }
}
