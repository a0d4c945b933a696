//! Sag of a pinned–pinned beam whose ends can't approach each other: the axis gets longer, and its tension carries a part of the load.
//!
//! The tension is uniform (Kirchhoff 1877, Woinowsky-Krieger 1950; von Kármán's strain, axial inertia left out),
//!
//! ```text
//! EI w″″ − N w″ = f,     N = (EA/2L) ∫ w′² dx
//! ```
//!
//! For a given N the beam is a tie of the handbook (Timoshenko and Gere, *Theory of Elastic Stability*), with kL = √(N/EI) L; the elongation is
//! (π²/4L) Σ j² w_j² of the amplitudes w_j of w = Σ w_j sin(jπx/L), a sum without cancellation. It falls as N grows, so that N is the one root
//! of a monotone function.

use super::super::root::boundary;
use super::sinh_ratio;
use std::f64::consts::PI;

/// A uniform beam, pinned at both ends, which stay where they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HeldBeam {
    /// L, m.
    pub(crate) span: f64,
    /// EI, N·m².
    pub(crate) bending: f64,
    /// EA, N.
    pub(crate) axial: f64,
}

/// What acts on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Weight {
    /// A force at a point, m and N, upwards.
    Force(f64, f64),
    /// A force per length, N/m, upwards.
    Uniform(f64),
}

/// Modes of the elongation's sum, whose terms fall like j⁻⁶ and j⁻⁸: the rest is below 1e-15.
const MODES: u32 = 1000;

impl HeldBeam {
    /// N, N.
    pub(crate) fn tension(&self, weight: Weight) -> f64 {
        let stretched = |n: f64| self.axial * self.elongation(weight, n) / self.span;
        boundary(0.0, stretched(0.0), |n| n >= stretched(n))
    }

    /// w at `x`, m.
    pub(crate) fn deflection(&self, weight: Weight, x: f64) -> f64 {
        self.under_tension(weight, self.tension(weight), x)
    }

    /// ½ ∫ w′² dx under the tension N, m.
    fn elongation(&self, weight: Weight, tension: f64) -> f64 {
        let term = |j: u32| {
            let k = f64::from(j) * PI / self.span;
            let load = match weight {
                Weight::Force(at, p) => 2.0 * p / self.span * (k * at).sin(),
                Weight::Uniform(q) if j % 2 == 1 => 4.0 * q / (f64::from(j) * PI),
                Weight::Uniform(_) => 0.0,
            };
            (k * load / (self.bending * k.powi(4) + tension * k * k)).powi(2)
        };
        0.25 * self.span * (1..=MODES).rev().map(term).sum::<f64>()
    }

    /// w at `x` under the tension N > 0, m; right to about 1e-16 EI/(N L²), relative.
    pub(crate) fn under_tension(&self, weight: Weight, tension: f64, x: f64) -> f64 {
        let (l, k) = (self.span, (tension / self.bending).sqrt());
        match weight {
            Weight::Force(at, p) if x > at => self.under_tension(Weight::Force(l - at, p), tension, l - x),
            Weight::Force(at, p) => {
                let b = l - at;
                p / tension * (b * x / l - sinh_ratio(k * b, k * x, k * l) / k)
            }
            Weight::Uniform(q) => {
                // 1 − cosh k(x − L/2)/cosh kL/2 = 2 sinh(kx/2) sinh(k(L−x)/2)/cosh(kL/2).
                let half = 0.5 * k * l;
                let ends = 2.0 * sinh_ratio(0.5 * k * x, half - 0.5 * k * x, half) * half.tanh() / (k * k);
                q / tension * (0.5 * x * (l - x) - ends)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::agree;
    use super::*;

    /// The source paper's beam, and the weight of its block.
    const PAPER: HeldBeam = HeldBeam { span: 0.36, bending: 0.582_187_5, axial: 69e9 * 0.03 * 0.0015 };
    const FORCE: f64 = -0.328_05 * 9.81;

    /// By mpmath with 40 digits, the elongation by quadrature of w′² of the closed form.
    #[test]
    fn the_sag_of_the_papers_beam() {
        let force = Weight::Force(0.18, FORCE);
        agree(PAPER.tension(force), 120.850_276_178_798_6, 1e-13);
        agree(PAPER.deflection(force, 0.18), -0.001_482_778_248_587_905_6, 1e-13);
        let force = Weight::Force(0.165, FORCE);
        agree(PAPER.tension(force), 120.208_503_944_275_73, 1e-13);
        agree(PAPER.deflection(force, 0.165), -0.001_472_652_543_386_391_3, 1e-13);
        agree(PAPER.deflection(force, 0.18), -0.001_468_468_768_366_722_8, 1e-13);
        let load = Weight::Uniform(FORCE / 0.36);
        agree(PAPER.tension(load), 82.349_859_947_468_47, 1e-13);
        agree(PAPER.deflection(load, 0.18), -0.001_169_112_024_677_593_7, 1e-13);
        agree(PAPER.deflection(load, 0.09), -0.000_841_546_915_233_339_9, 1e-13);
    }

    /// Timoshenko and Gere: P L³/(48 EI) · 3 (u − tanh u)/u³, 5 q L⁴/(384 EI) · (sech u − 1 + u²/2)/(5u⁴/24), u = kL/2.
    #[test]
    fn a_tie_of_the_handbook() {
        let n = 55.0;
        let (l, ei) = (PAPER.span, PAPER.bending);
        let u = 0.5 * l * (n / ei).sqrt();
        let force = PAPER.under_tension(Weight::Force(0.5 * l, 1.0), n, 0.5 * l);
        agree(force, l.powi(3) / (48.0 * ei) * 3.0 * (u - u.tanh()) / u.powi(3), 1e-13);
        let load = PAPER.under_tension(Weight::Uniform(1.0), n, 0.5 * l);
        let factor = (1.0 / u.cosh() - 1.0 + 0.5 * u * u) * 24.0 / (5.0 * u.powi(4));
        agree(load, 5.0 * l.powi(4) / (384.0 * ei) * factor, 1e-13);
    }

    /// A small load is carried by bending, but for about w² EA/(4EI) of it (all of it in the first mode); a huge one as by a rope.
    #[test]
    fn small_and_huge_loads() {
        let small = PAPER.deflection(Weight::Force(0.18, 1e-3), 0.18);
        let bending_alone = 1e-3 * 0.36_f64.powi(3) / (48.0 * 0.582_187_5);
        agree(1.0 - small / bending_alone, bending_alone.powi(2) * PAPER.axial / (4.0 * PAPER.bending), 0.05);
        let limp = HeldBeam { bending: 1e-9, ..PAPER };
        // Two straight halves: elongation 2 w²/L, N = EA 2 w²/L², P = 4 N w/L.
        let w = limp.deflection(Weight::Force(0.18, 1.0), 0.18);
        agree(w, 0.36 * (1.0 / (8.0 * limp.axial)).cbrt(), 1e-3);
    }
}
