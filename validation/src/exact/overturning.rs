//! Housner's block under one sine of ground acceleration (`docs/theory.md` §9): whether it overturns, and after how many impacts.
//!
//! The ground accelerates by a(t) = A sin(ω_p t + ψ) to the right, sin ψ = g tan α/A, so that rocking starts at t = 0; the pulse ends
//! at ω_p t + ψ = 2π. Seen from the ground, the block feels −m a at its mass centre. About the corner it stands on, the left one for
//! φ > 0, the mass centre is at R (sin(α − φ), cos(α − φ)), so that
//!
//! ```text
//! (4/3) R φ̈ = −g sin(α − φ) + a cos(α − φ),  φ > 0          (4/3) R φ̈ = g sin(α + φ) + a cos(α + φ),  φ < 0
//! ```
//!
//! and an impact takes φ̇⁺ = r φ̇⁻, r = 1 − (3/2) sin² α. With time in units of 1/p, p² = 3g/(4R), and the amplitude in units of g tan α,
//! no size is left. Below u = |φ| and s is the side, the sign of φ.
//!
//! After the pulse the energy E = ½u̇² − 2 sin² ½(α − u) stays, counted from the saddle at u = α, and an impact takes E + 2 sin² ½α to
//! r² times that.

use super::extrapolation::integrate;
use super::root::boundary;
use std::f64::consts::{FRAC_PI_2, PI};

/// A block that rocks without slip or bounce.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PulsedBlock {
    /// The angle at which it overturns, rad.
    pub(crate) alpha: f64,
    /// ω_p/p.
    pub(crate) frequency: f64,
}

/// What becomes of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fate {
    /// It rocks to rest.
    Stands,
    /// It overturns after so many impacts.
    Overturns { impacts: u32 },
}

/// Longest step, in the time of the pulse and of the block, whichever is shorter: an excursion within it would be missed.
const LONGEST: f64 = 0.02;

/// So many impacts within the pulse are a sequence that ends at rest, and there only just above the amplitude that starts rocking.
const MOST_IMPACTS: u32 = 100;

impl PulsedBlock {
    /// What becomes of it at amplitude A = `amplitude` · g tan α, `amplitude` > 1.
    pub(crate) fn fate(&self, amplitude: f64) -> Fate {
        let Self { alpha, frequency } = *self;
        let psi = amplitude.recip().asin();
        let end = (2.0 * PI - psi) / frequency;
        let r = 1.0 - 1.5 * alpha.sin().powi(2);
        let (mut t, mut y, mut side, mut impacts) = (0.0, [0.0, 0.0], 1.0, 0);
        while t < end {
            let motion = |t: f64, y: &[f64; 2]| {
                let push = side * amplitude * alpha.tan() * (frequency * t + psi).sin();
                [y[1], -(alpha - y[0]).sin() + push * (alpha - y[0]).cos()]
            };
            let longest = LONGEST / frequency.max(1.0);
            let arrival = integrate(motion, (t, y), end, longest, |y| y[0].min(FRAC_PI_2 - y[0]));
            (t, y) = (arrival.t, arrival.y);
            if arrival.event {
                if y[0] > alpha {
                    return Fate::Overturns { impacts };
                }
                (y, side, impacts) = ([0.0, -r * y[1]], -side, impacts + 1);
                if impacts == MOST_IMPACTS {
                    return Fate::Stands;
                }
            }
        }
        let [u, rate] = y;
        let energy = 0.5 * rate * rate - 2.0 * (0.5 * (alpha - u)).sin().powi(2);
        let overturns = Fate::Overturns { impacts };
        if energy <= 0.0 {
            // On which side of the saddle?
            return if u > alpha { overturns } else { Fate::Stands };
        }
        if rate > 0.0 {
            return overturns;
        }
        // Inwards, over the saddle if it is beyond: one more impact, then outwards with what is left.
        let upright = 2.0 * (0.5 * alpha).sin().powi(2);
        if r * r * (energy + upright) > upright { Fate::Overturns { impacts: impacts + 1 } } else { Fate::Stands }
    }

    /// The amplitude between `low` and `high` where the fate changes from that at `low`.
    pub(crate) fn limit(&self, low: f64, high: f64) -> f64 {
        let fate = self.fate(low);
        boundary(low, high, |amplitude| self.fate(amplitude) != fate)
    }
}

/// For α = 0.25: ω_p/p; from which amplitude to which it overturns, and after how many impacts. Up to ω_p/p = 3 as in `docs/theory.md` §9; beyond,
/// confirmed by a Runge–Kutta integration elsewhere that falls on the right side 2e-6 from each limit.
pub(crate) const RANGES: [(f64, f64, f64, u32); 17] = [
    (1.0, 1.1066, 1.1130, 3),
    (1.0, 1.1310, 1.4159, 1),
    (1.0, 1.4175, f64::INFINITY, 0),
    (2.0, 1.2237, 2.3277, 1),
    (2.0, 2.3577, f64::INFINITY, 0),
    (3.0, 1.4019, 3.5428, 1),
    (3.0, 3.6645, f64::INFINITY, 0),
    (4.0, 1.7886, 5.0093, 1),
    (4.0, 5.3230, f64::INFINITY, 0),
    (5.0, 2.8832, 6.6836, 1),
    (5.0, 7.3362, f64::INFINITY, 0),
    (6.0, 4.6379, 8.5039, 1),
    (6.0, 9.7105, f64::INFINITY, 0),
    (7.0, 7.0320, 10.3429, 1),
    (7.0, 12.4532, f64::INFINITY, 0),
    (8.0, 10.8592, 11.4102, 1),
    (8.0, 15.5722, f64::INFINITY, 0),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limits_are_those_found_elsewhere() {
        for (frequency, from, to, impacts) in RANGES {
            let block = PulsedBlock { alpha: 0.25, frequency };
            let overturns = Fate::Overturns { impacts };
            for (limit, stands) in [(from, -5e-4), (to, 5e-4)].into_iter().filter(|(limit, _)| limit.is_finite()) {
                assert_eq!((block.fate(limit + stands), block.fate(limit - stands)), (Fate::Stands, overturns));
                let found = block.limit(limit + stands, limit - stands);
                assert!((found - limit).abs() <= 0.5e-4, "{found}, not {limit}");
            }
            if to.is_infinite() {
                assert_eq!(block.fate(5.0 * from), overturns);
            }
        }
    }

    /// For small α the equation is linear: with a = A/(g tan α), Ω = ω_p/p, on the side where it starts
    /// u/α = 1 + c e^t + d e^{−t} − a sin(Ωt + ψ)/(1 + Ω²), with c + d = −Ω²/(1 + Ω²), c − d = aΩ cos ψ/(1 + Ω²). It overturns without
    /// impact if after the pulse, at T, what grows is positive: 2c e^T > aΩ/(1 + Ω²).
    #[test]
    fn small_angles_overturn_without_impact_as_the_linear_equation_says() {
        for frequency in [1.5_f64, 3.0, 6.0] {
            let grows = |a: f64| {
                let (psi, square) = (a.recip().asin(), frequency * frequency);
                let c = 0.5 * (a * frequency * psi.cos() - square) / (1.0 + square);
                2.0 * c * ((2.0 * PI - psi) / frequency).exp() > a * frequency / (1.0 + square)
            };
            let linear = boundary(1.01, 100.0, grows);
            let block = PulsedBlock { alpha: 1e-3, frequency };
            assert_eq!(block.fate(linear * 1.001), Fate::Overturns { impacts: 0 });
            // The next term is of relative order α².
            let found = boundary(linear * 0.999, linear * 1.001, |a| block.fate(a) == Fate::Overturns { impacts: 0 });
            assert!((found / linear - 1.0).abs() < 1e-5, "{found}, not {linear}");
        }
    }

    #[test]
    fn a_pulse_that_hardly_lifts_it_leaves_it_standing() {
        for frequency in [1.0, 4.0, 8.0] {
            assert_eq!(PulsedBlock { alpha: 0.25, frequency }.fate(1.0 + 1e-6), Fate::Stands);
        }
    }
}
