//! Impacts with duration: a mass that falls onto a spring with damping, never pulled.
//!
//! δ is the penetration and v the speed at first touch. A block that lands flat on two corners, each with stiffness k and damping c (or d), is
//! one mass on 2k and 2c (or the same d). *Kelvin–Voigt*: m δ̈ = m g − (k δ + c δ̇), in closed form. *Hunt–Crossley* (1975, doi
//! 10.1115/1.3423596): m δ̈ = m g − k δⁿ (1 + d δ̇), integrated in its own scale; without weight it has a first integral,
//!
//! ```text
//! d (v + v⁺) = ln( (1 + d v)/(1 − d v⁺) )          v⁺ the speed after
//! ```

use super::extrapolation::integrate;
use super::root::boundary;

/// How a contact with duration ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Release {
    /// From first touch to the end of the force, s.
    pub(crate) duration: f64,
    /// Upward speed then, −δ̇, m/s.
    pub(crate) speed: f64,
    /// Penetration then, m: damping ends a Kelvin–Voigt force before the surfaces part.
    pub(crate) penetration: f64,
}

/// A mass on a linear spring and damper.
#[derive(Clone, Copy, Debug)]
pub(crate) struct KelvinVoigt {
    /// kg.
    pub(crate) mass: f64,
    /// k of all corners together, N/m.
    pub(crate) stiffness: f64,
    /// c of all corners together, N·s/m; less than 2√(k m).
    pub(crate) damping: f64,
    /// m/s².
    pub(crate) gravity: f64,
}

impl KelvinVoigt {
    /// What a first touch at `speed` > 0 leads to; `None` if the mass stays on the spring.
    ///
    /// With ω² = k/m, sin ε = c/(2√(km)), ω_d = ω cos ε, the force per mass is g − δ̈, and
    /// −δ̈ = r e^{−ω t sin ε} cos(ω_d t − η) with −δ̈(0) = 2ω sin ε v − g and δ⃛(0) = −ω² v − 2ω sin ε δ̈(0). It is extreme where
    /// ω_d t − η = −ε + jπ; the first zero lies between a maximum and the minimum after it.
    pub(crate) fn release(&self, speed: f64) -> Option<Release> {
        let omega = (self.stiffness / self.mass).sqrt();
        let epsilon = (0.5 * self.damping / (self.stiffness * self.mass).sqrt()).asin();
        let (decay, omega_d) = (omega * epsilon.sin(), omega * epsilon.cos());
        // Motion about the rest position g/ω²: (A cos ω_d t + B sin ω_d t) e^{−decay t}.
        let rest = self.gravity / (omega * omega);
        let (a, b) = (-rest, (speed - decay * rest) / omega_d);
        let at = |t: f64| {
            let (sin, cos) = (omega_d * t).sin_cos();
            let (x, slope) = (a * cos + b * sin, omega_d * (b * cos - a * sin));
            let fading = (-decay * t).exp();
            [rest + fading * x, fading * (slope - decay * x)]
        };
        let force = |t: f64| {
            let [d, rate] = at(t);
            omega * omega * d + 2.0 * decay * rate
        };
        // −δ̈ at 0, and the other amplitude from its slope: η is their angle.
        let p = 2.0 * decay * speed - self.gravity;
        let slope = omega * omega * speed - 2.0 * decay * p;
        let eta = ((slope + decay * p) / omega_d).atan2(p);
        let half = std::f64::consts::PI / omega_d;
        let mut lowest = (eta + std::f64::consts::PI - epsilon) / omega_d;
        lowest -= (lowest / (2.0 * half)).floor() * 2.0 * half;
        if force(lowest) > 0.0 {
            return None;
        }
        let duration = boundary((lowest - half).max(0.0), lowest, |t| force(t) < 0.0);
        let [penetration, rate] = at(duration);
        Some(Release { duration, speed: -rate, penetration })
    }
}

/// A mass on a non-linear spring with Hunt and Crossley's damping.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HuntCrossley {
    /// kg.
    pub(crate) mass: f64,
    /// k of all corners together, N/mⁿ.
    pub(crate) stiffness: f64,
    /// d, s/m.
    pub(crate) damping: f64,
    /// n ≥ 1, a multiple of ½.
    pub(crate) exponent: f64,
    /// m/s².
    pub(crate) gravity: f64,
}

/// Far more than any impact takes, in units of D/v.
const LONG: f64 = 1e4;

impl HuntCrossley {
    /// What a first touch at `speed` > 0 leads to; `None` if the mass stays on the spring.
    ///
    /// In units of D, k Dⁿ⁺¹ = m v², and D/v there are left β = d v and γ = g D/v²: x'' = γ − xⁿ (1 + β x'). With x = s² and
    /// time dt = 2s dσ the equations have no root or bend at the surface, for any n that is a multiple of ½:
    ///
    /// ```text
    /// ds/dσ = w,    dw/dσ = 2s (γ − s²ⁿ (1 + β w)),    dt/dσ = 2s
    /// ```
    pub(crate) fn release(&self, speed: f64) -> Option<Release> {
        let depth = (self.mass * speed * speed / self.stiffness).powf((self.exponent + 1.0).recip());
        let (beta, gamma) = (self.damping * speed, self.gravity * depth / (speed * speed));
        let power = (2.0 * self.exponent).round() as i32;
        let motion = |_: f64, y: &[f64; 3]| {
            let [s, w, _] = *y;
            [w, 2.0 * s * (gamma - s.powi(power) * (1.0 + beta * w)), 2.0 * s]
        };
        let deepest = integrate(motion, (0.0, [0.0, 1.0, 0.0]), LONG, 0.5, |y| y[1]);
        // Up again: to the surface, or to where it turns below it.
        let end = integrate(motion, (deepest.t, [deepest.y[0], 0.0, deepest.y[2]]), LONG, 0.5, |y| y[0].min(-y[1]));
        let [s, w, t] = end.y;
        (end.event && s < -w).then_some(Release { duration: t * depth / speed, speed: -w * speed, penetration: 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// m = k = 1 and a first touch at 1 m/s: the own scale is 1.
    fn own_scale(exponent: f64, damping: f64, gravity: f64) -> Release {
        HuntCrossley { mass: 1.0, stiffness: 1.0, damping, exponent, gravity }.release(1.0).unwrap()
    }

    #[test]
    fn hunt_crossley_agrees_with_thirty_digits() {
        // Exponent, d, g; duration, speed: by Taylor series with 30 digits.
        for (n, d, g, duration, speed) in [
            (1.0, 0.0, 0.0, std::f64::consts::PI, 1.0),
            (1.5, 0.0, 0.0, 3.218_065_459_719_043, 1.0),
            (2.0, 0.0, 0.0, 3.210_195_653_238_927, 1.0),
            (1.0, 0.3, 0.0, 3.151_453_316_738_738, 0.832_869_792_265_601_7),
            (1.5, 0.3, 0.02, 3.321_582_144_900_773_5, 0.824_258_693_993_127_6),
            (2.0, 1.5, 0.1, 4.279_625_612_352_298, 0.325_288_473_384_782_4),
            (1.5, 0.1, 1.0, 4.343_400_140_374_015, 0.301_986_552_556_682_3),
        ] {
            let found = own_scale(n, d, g);
            assert!(
                (found.duration - duration).abs() < 1e-13 && (found.speed - speed).abs() < 1e-13,
                "{n} {d} {found:?}"
            );
        }
    }

    #[test]
    fn hunt_crossley_without_weight_obeys_its_first_integral_in_all_scales() {
        for exponent in [1.0, 1.5, 2.0] {
            for stiffness in [1e4, 1e8, 1e12] {
                for (damping, speed) in [(0.0, 1.0), (0.05, 2.0), (0.8, 0.7), (3.0, 1.4)] {
                    let law = HuntCrossley { mass: 0.3, stiffness, damping, exponent, gravity: 0.0 };
                    let found = law.release(speed).unwrap();
                    let lhs = damping * (speed + found.speed);
                    let rhs = ((1.0 + damping * speed) / (1.0 - damping * found.speed)).ln();
                    assert!((lhs - rhs).abs() < 1e-12 * lhs.max(1.0), "{law:?} {found:?}");
                    if damping == 0.0 {
                        assert!((found.speed - speed).abs() < 1e-13 * speed, "{law:?} {found:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn both_laws_agree_without_damping() {
        for gravity in [0.0, 9.81] {
            let spring = KelvinVoigt { mass: 0.3, stiffness: 2e4, damping: 0.0, gravity }.release(0.9).unwrap();
            let law = HuntCrossley { mass: 0.3, stiffness: 2e4, damping: 0.0, exponent: 1.0, gravity };
            let integrated = law.release(0.9).unwrap();
            assert!((spring.duration / integrated.duration - 1.0).abs() < 1e-13, "{spring:?} {integrated:?}");
            assert!((integrated.speed - 0.9).abs() < 1e-13 && (spring.speed - 0.9).abs() < 1e-13, "{spring:?}");
        }
    }

    #[test]
    fn kelvin_voigt_without_weight_is_as_in_the_books() {
        // ω_d t = π − 2ε, and the speed falls by exp(−(π − 2ε) tan ε), sin ε = ζ.
        let (mass, stiffness, speed) = (0.3, 2e4_f64, 0.9);
        for zeta in [1e-3_f64, 0.1, 0.5, 0.9] {
            let damping = 2.0 * zeta * (stiffness * mass).sqrt();
            let found = KelvinVoigt { mass, stiffness, damping, gravity: 0.0 }.release(speed).unwrap();
            let (epsilon, omega) = (zeta.asin(), (stiffness / mass).sqrt());
            let angle = std::f64::consts::PI - 2.0 * epsilon;
            assert!((found.duration * omega * epsilon.cos() / angle - 1.0).abs() < 1e-13, "{found:?}");
            assert!((found.speed / speed - (-angle * epsilon.tan()).exp()).abs() < 1e-13, "{found:?}");
            assert!((stiffness * found.penetration / (damping * found.speed) - 1.0).abs() < 1e-11, "{found:?}");
        }
    }

    #[test]
    fn kelvin_voigt_under_weight_agrees_with_an_integration() {
        // In its own scale, with light and heavy damping: it decides whether the force grows from first touch on.
        for (damping, gravity) in [(0.4, 0.2), (1.0, 0.1), (1.6, 0.01), (0.0, 0.5)] {
            let force = |y: &[f64; 2]| y[0] + damping * y[1];
            let motion = |_: f64, y: &[f64; 2]| [y[1], gravity - force(y)];
            let end = integrate(motion, (0.0, [0.0, 1.0]), 10.0, 0.1, force);
            let found = KelvinVoigt { mass: 1.0, stiffness: 1.0, damping, gravity }.release(1.0).unwrap();
            assert!((found.duration - end.t).abs() < 1e-13, "{found:?} {end:?}");
            assert!(
                (found.speed + end.y[1]).abs() < 1e-13 && (found.penetration - end.y[0]).abs() < 1e-13,
                "{found:?}"
            );
        }
    }

    /// The slowest mass that comes off does so where the force only touches zero: k δ̇ + c δ̈ = 0 with δ̈ = g.
    #[test]
    fn a_mass_just_comes_off_at_the_speed_that_the_equation_says() {
        for (damping, gravity) in [(0.1, 0.3), (0.8, 0.2), (1.6, 0.1)] {
            let law = KelvinVoigt { mass: 1.0, stiffness: 1.0, damping, gravity };
            let limit = boundary(1e-3, 1e3, |speed| law.release(speed).is_some());
            let found = law.release(limit).unwrap();
            // A double root: found to the square root of rounding.
            assert!((found.speed - damping * gravity).abs() < 1e-7, "{limit} {found:?}");
        }
    }

    #[test]
    fn a_slow_mass_stays_on_its_spring() {
        let law = KelvinVoigt { mass: 1.0, stiffness: 1.0, damping: 0.4, gravity: 1.0 };
        assert_eq!(law.release(0.1), None);
        let law = HuntCrossley { mass: 1.0, stiffness: 1.0, damping: 2.0, exponent: 1.5, gravity: 1.0 };
        assert_eq!(law.release(0.3), None);
    }
}
