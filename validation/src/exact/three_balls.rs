//! Three equal balls in a row: the first comes with speed 1, the others touch each other and lie still. The velocities after
//! it, by the law of the impact.
//!
//! With gap rates u_1 = v_2 − v_1, u_2 = v_3 − v_2 and impulses p_1, p_2 (in units of m·speed),
//!
//! ```text
//! v_1 = 1 − p_1,   v_2 = p_1 − p_2,   v_3 = p_2,        u = u⁻ + H p,   H = ( 2 −1; −1 2 ),   u⁻ = (−1, 0)
//! ```
//!
//! so that momentum is 1 by construction. Only a law says more:
//!
//! - *At once* (Newton's law as Moreau takes it, and Poisson's): 0 ≤ u⁺ + e u⁻ ⊥ p ≥ 0. Both contacts press: H p = (1 + e, 0),
//!   p = (1 + e) (2/3, 1/3). Poisson's compression ends with p_c = (2/3, 1/3), and expansion adds e p_c: the same. For e = 1 no energy
//!   is lost: 1/9 + 4/9 + 4/9 = 1. So an energetic law leaves e alone.
//! - *One after the other*: 1 hits 2, 2 hits 3. Each exchanges the velocities of two balls for e = 1: Newton's cradle. For e < 1 the
//!   first has (1 − e)/2 left and comes after the second; what follows is a sequence of its own.
//! - *With duration*, force k δⁿ, nothing lost: the contacts press one after the other, but overlap. Neither k nor m matters to the
//!   end. For n = 1 the two closed contacts, δ_1 = x_1 − x_2 and δ_2 = x_2 − x_3, swing in the modes (1, 1) and (1, −1), of circular
//!   frequency 1 and √3 in units of √(k/m), until the first contact opens; from then on balls 2 and 3 swing against each other alone, with
//!   √2. For n = 3/2 (Hertz) there is no closed form; it is integrated.

use super::root::boundary;

/// Both contacts at once with restitution `e` for each.
pub(crate) fn at_once(e: f64) -> [f64; 3] {
    [1.0 - 2.0 * (1.0 + e) / 3.0, (1.0 + e) / 3.0, (1.0 + e) / 3.0]
}

/// One impact after the other, e = 1.
pub(crate) const ONE_AFTER_THE_OTHER: [f64; 3] = [0.0, 0.0, 1.0];

/// With duration, force k δ^{3/2}: by the integration in the tests, right to 1e-12.
pub(crate) const HERTZ: [f64; 3] = [-0.070_952_353_651_5, 0.076_403_039_071_1, 0.994_549_314_580_3];

/// With duration, force k δ.
pub(crate) fn linear_springs() -> [f64; 3] {
    let root = 3.0_f64.sqrt();
    let [slow, fast] = [|t: f64| 0.5 * t.sin(), |t: f64| 0.5 * (3.0_f64.sqrt() * t).sin() / 3.0_f64.sqrt()];
    // The first contact opens after the fast mode's half period and before the slow one's.
    let opens = boundary(std::f64::consts::PI / root, std::f64::consts::PI, |t| slow(t) + fast(t) <= 0.0);
    let v_1 = 1.0 - 0.5 * (1.0 - opens.cos()) - (1.0 - (root * opens).cos()) / 6.0;
    let (d, d_dot) = (slow(opens) - fast(opens), 0.5 * (opens.cos() - (root * opens).cos()));
    // Balls 2 and 3 keep their momentum, and part as fast as their spring's energy makes them.
    let (momentum, parting) = (1.0 - v_1, (d_dot * d_dot + 2.0 * d * d).sqrt());
    [v_1, 0.5 * (momentum - parting), 0.5 * (momentum + parting)]
}

#[cfg(test)]
mod tests {
    use super::super::extrapolation::integrate;
    use super::*;

    /// Force δⁿ, unit masses. Each time a contact opens its force bends, so that the integration stops there and goes on without it.
    fn with_duration(exponent: f64, longest: f64) -> [f64; 3] {
        let mut y = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0];
        let mut t = 0.0;
        let mut closed = [true, true];
        while closed != [false, false] {
            let force = |i: usize, y: &[f64; 6]| {
                let d = y[i] - y[i + 1];
                if closed[i] { d.signum() * d.abs().powf(exponent) } else { 0.0 }
            };
            let motion = |_: f64, y: &[f64; 6]| {
                let [left, right] = [force(0, y), force(1, y)];
                [y[3], y[4], y[5], -left, left - right, right]
            };
            let opened = |i: usize, y: &[f64; 6]| closed[i] && y[i] < y[i + 1] && y[i + 3] < y[i + 4];
            let end =
                integrate(motion, (t, y), 100.0, longest, |y| if opened(0, y) || opened(1, y) { -1.0 } else { 1.0 });
            assert!(end.event, "{end:?}");
            (t, y) = (end.t, end.y);
            closed = [0, 1].map(|i| closed[i] && !opened(i, &y));
        }
        assert!(y[3] < y[4] && y[4] < y[5], "they meet again: {y:?}");
        [y[3], y[4], y[5]]
    }

    fn close(a: [f64; 3], b: [f64; 3], within: f64) {
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < within), "{a:?} {b:?}");
    }

    #[test]
    fn momentum_and_energy() {
        for (v, energy, within) in [
            (at_once(1.0), 1.0, 1e-15),
            (at_once(0.0), 1.0 / 3.0, 1e-15),
            (ONE_AFTER_THE_OTHER, 1.0, 1e-15),
            (linear_springs(), 1.0, 1e-15),
            (HERTZ, 1.0, 1e-12),
        ] {
            assert!((v.iter().sum::<f64>() - 1.0).abs() < within, "{v:?}");
            assert!((v.iter().map(|v| v * v).sum::<f64>() - energy).abs() < within, "{v:?}");
        }
        close(at_once(0.5), [0.0, 0.5, 0.5], 1e-15);
    }

    #[test]
    fn the_integration_agrees() {
        close(with_duration(1.0, 0.1), linear_springs(), 1e-13);
        close(with_duration(1.5, 0.01), HERTZ, 1e-12);
        close(with_duration(1.5, 0.003), HERTZ, 1e-12);
    }
}
