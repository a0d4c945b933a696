//! Free vibration of a pinned–pinned beam with axially held ends in one mode: an exact motion of ρA ẅ + EI w″″ − N w″ = 0,
//! N = (EA/2L) ∫ w′² dx (Woinowsky-Krieger 1950, doi 10.1115/1.4010053).
//!
//! w = q(t) sin(jπx/L) leaves Duffing's equation, which the amplitude a and Jacobi's functions solve:
//!
//! ```text
//! q̈ + ω² q (1 + q² EA/(4EI)) = 0,   κ = a² EA/(4EI)
//! q = a cn(√(1+κ) ωt | m),  m = κ/(2(1 + κ)),   period 4 K(m)/(ω √(1+κ))
//! ```

use super::Uniform;
use std::f64::consts::{FRAC_PI_2, PI};

/// A motion in one mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Swing {
    pub(crate) beam: Uniform,
    /// EA, N.
    pub(crate) axial: f64,
    /// j, half waves.
    pub(crate) mode: u32,
    /// a, m; the motion starts there, at rest.
    pub(crate) amplitude: f64,
}

impl Swing {
    /// Circular frequency of the whole period, rad/s.
    #[cfg_attr(not(test), expect(dead_code, reason = "no case compares with it yet"))]
    pub(crate) fn frequency(&self) -> f64 {
        2.0 * PI / self.period()
    }

    /// s.
    pub(crate) fn period(&self) -> f64 {
        4.0 * quarter_period(self.parameter()) / self.rate()
    }

    /// q(t), m.
    pub(crate) fn amplitude_at(&self, t: f64) -> f64 {
        self.amplitude * cosine_amplitude(self.rate() * t, self.parameter())
    }

    /// Its energy, J: ρAL q̇²/4 + EI (jπ)⁴ q²/(4L³) (1 + κ q²/(2a²)).
    #[cfg_attr(not(test), expect(dead_code, reason = "no case compares with it yet"))]
    pub(crate) fn energy(&self) -> f64 {
        let omega = self.beam.frequency(f64::from(self.mode) * PI);
        0.25 * self.beam.mass * self.beam.span * (omega * self.amplitude).powi(2) * (1.0 + 0.5 * self.hardening())
    }

    /// κ.
    fn hardening(&self) -> f64 {
        self.amplitude * self.amplitude * self.axial / (4.0 * self.beam.bending)
    }

    fn rate(&self) -> f64 {
        self.beam.frequency(f64::from(self.mode) * PI) * (1.0 + self.hardening()).sqrt()
    }

    fn parameter(&self) -> f64 {
        0.5 * self.hardening() / (1.0 + self.hardening())
    }
}

/// Rounds of the arithmetic-geometric mean; for m ≤ 1/2 the two means agree to rounding after four.
const ROUNDS: usize = 6;

/// K(m) = π/(2 agm(1, √(1−m))), 0 ≤ m ≤ 1/2 (Abramowitz and Stegun 17.6).
fn quarter_period(m: f64) -> f64 {
    FRAC_PI_2 / means(m)[ROUNDS].0
}

/// cn(u | m) by descending Landen steps (Abramowitz and Stegun 16.4): φ = 2ⁿ a_n u, then 2φ_{k−1} = φ_k + asin(c_k sin φ_k/a_k).
fn cosine_amplitude(u: f64, m: f64) -> f64 {
    let means = means(m);
    // Within one period, so that 2ⁿ takes no digits of it.
    let period = 4.0 * quarter_period(m);
    let u = u - (u / period).round() * period;
    let mut phi = means[ROUNDS].0 * u * f64::from(1_u32 << ROUNDS);
    for (a, c) in means[1..].iter().rev() {
        phi = 0.5 * (phi + (c / a * phi.sin()).asin());
    }
    phi.cos()
}

/// (a_k, c_k) of the arithmetic-geometric mean of 1 and √(1−m).
fn means(m: f64) -> [(f64, f64); ROUNDS + 1] {
    let mut all = [(1.0, m.sqrt()); ROUNDS + 1];
    let mut b = (1.0 - m).sqrt();
    for k in 1..=ROUNDS {
        let a = all[k - 1].0;
        all[k] = (0.5 * (a + b), 0.5 * (a - b));
        b = (a * b).sqrt();
    }
    all
}

#[cfg(test)]
mod tests {
    use super::super::super::extrapolation::integrate;
    use super::super::tests::agree;
    use super::*;

    /// By mpmath with 40 digits.
    #[test]
    fn elliptic_functions() {
        agree(quarter_period(0.3), 1.713_889_448_178_791, 1e-15);
        agree(quarter_period(0.49), 1.845_693_998_374_723_6, 1e-15);
        agree(quarter_period(0.0), FRAC_PI_2, 1e-15);
        for (u, cn) in
            [(0.5, 0.880_408_736_426_462_4), (2.5, -0.626_031_978_480_854_7), (9.1, -0.434_892_926_722_358_24)]
        {
            agree(cosine_amplitude(u, 0.3), cn, 1e-14);
        }
    }

    fn swing(amplitude: f64) -> Swing {
        let beam = Uniform { span: 0.36, bending: 0.582_187_5, mass: 0.1215 };
        Swing { beam, axial: 69e9 * 0.03 * 0.0015, mode: 1, amplitude }
    }

    #[test]
    fn the_motion_is_that_of_duffings_equation() {
        let swing = swing(0.002);
        let omega = swing.beam.frequency(PI);
        let factor = swing.axial / (4.0 * swing.beam.bending) * 0.002 * 0.002;
        let motion = |_: f64, y: &[f64; 2]| [y[1], -y[0] * (1.0 + factor * y[0] * y[0])];
        let end = integrate(motion, (0.0, [1.0, 0.0]), 3.7, 0.05, |_| 1.0);
        assert!((swing.amplitude_at(3.7 / omega) / 0.002 - end.y[0]).abs() < 1e-12, "{end:?}");
        agree(swing.amplitude_at(7.0 * swing.period()), 0.002, 1e-13);
        // Its energy at q = 0 is all kinetic: by the speed there.
        let quarter = 0.25 * swing.period() * omega;
        let middle = integrate(motion, (0.0, [1.0, 0.0]), quarter, 0.05, |_| 1.0);
        assert!(middle.y[0].abs() < 1e-12);
        let speed = middle.y[1] * omega * 0.002;
        agree(swing.energy(), 0.25 * 0.1215 * 0.36 * speed * speed, 1e-11);
    }

    /// Woinowsky-Krieger's expansion ω'/ω = 1 + 3κ/8 + …; κ = (a/r)²/4 with the radius of gyration r.
    #[test]
    fn small_swings_are_linear() {
        let small = swing(1e-5);
        let kappa = small.hardening();
        agree(kappa, 1e-10 / (0.0015 * 0.0015 / 12.0) / 4.0, 1e-12);
        agree(small.frequency() / small.beam.frequency(PI) - 1.0, 3.0 / 8.0 * kappa, 1e-3);
    }
}
