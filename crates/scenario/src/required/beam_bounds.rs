//! Bounds of deflection, slope and velocity of a beam by its energy.

use super::barrier::STATIC;
use teeter_beam::Beam;

/// Bounds of a beam's motion by its energy: |w| ≤ √(2 `deflection` U), |w'| ≤ √(2 `slope` U) for an
/// elastic energy U, |ẇ| ≤ √(2 `velocity` T) for a kinetic energy T, everywhere on the beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BeamBounds {
    /// Largest N K⁻¹ Nᵀ, m/N.
    pub(super) deflection: f64,
    /// Largest N' K⁻¹ N'ᵀ, 1/(N m).
    pub(super) slope: f64,
    /// Upper bound on N M⁻¹ Nᵀ, 1/kg.
    pub(super) velocity: f64,
}

/// With a larger relative error of the solves there is no bound.
const MOST_LOST: f64 = 1e-3;

/// Safety factor on the estimated error of the solves.
const SAFETY: f64 = 10.0;

/// Points of an element at which the flexibility, a polynomial of degree six there, is evaluated:
/// the zeros of a Chebyshev polynomial.
const PLACES: usize = 16;

impl BeamBounds {
    /// The bounds of a beam without axial dofs; `None` if its supports allow a rigid motion.
    ///
    /// A polynomial of degree six is nowhere larger than 1/cos(6π/32) = 1.203 times its maximum at
    /// the `PLACES` = 16 zeros of a Chebyshev polynomial (Ehlich & Zeller 1964). This is applied to
    /// the part of the flexibility that varies over the element.
    pub(super) fn of(beam: &Beam) -> Option<Self> {
        // With springs that are soft relative to the beam, the solves have few digits, or none.
        let lost = beam.digits(STATIC).ok()?.solve;
        if lost > MOST_LOST {
            return None;
        }
        let (columns, nodes) = (Self::flexibility(beam)?, beam.node_positions());
        let mut bounds = Self { deflection: 0.0, slope: 0.0, velocity: 0.0 };
        for ends in nodes.windows(2) {
            let (from, length) = (ends[0], ends[1] - ends[0]);
            let (mut w, mut slope) = (MinMax::EMPTY, MinMax::EMPTY);
            for k in 0..PLACES {
                let angle = std::f64::consts::PI * (k as f64 + 0.5) / PLACES as f64;
                let shape = beam.shape_clamped(from + 0.5 * length * (1.0 - angle.cos()));
                let used = 0..shape.len;
                let form = |n: &[f64; 4]| -> f64 {
                    let entry = |i: usize, j: usize| n[i] * n[j] * columns[shape.columns[i]][shape.columns[j]];
                    used.clone().flat_map(|i| used.clone().map(move |j| (i, j))).map(|(i, j)| entry(i, j)).sum()
                };
                w.take(form(&shape.n));
                slope.take(form(&shape.dn));
            }
            bounds.deflection = bounds.deflection.max(w.bound());
            bounds.slope = bounds.slope.max(slope.bound());
            // A cubic p over a length l has max p² ≤ 16/l ∫p² dx.
            bounds.velocity = bounds.velocity.max(16.0 / (length * least_mass(beam)));
        }
        // The estimated error may be too small by a factor of two.
        bounds.deflection *= 1.0 + SAFETY * lost;
        bounds.slope *= 1.0 + SAFETY * lost;
        Some(bounds)
    }

    /// K⁻¹ by columns.
    fn flexibility(beam: &Beam) -> Option<Vec<Vec<f64>>> {
        if beam.rigid_motion().is_some() {
            return None;
        }
        let factor = beam.factor(STATIC).ok()?;
        let n = beam.dofs();
        let column = |k: usize| {
            let mut column = vec![0.0; n];
            if !beam.is_held(k) {
                column[k] = 1.0;
                factor.solve(&mut column);
            }
            column
        };
        Some((0..n).map(column).collect())
    }
}

/// Smallest and largest value found.
struct MinMax([f64; 2]);

impl MinMax {
    const EMPTY: Self = Self([f64::INFINITY, f64::NEG_INFINITY]);

    fn take(&mut self, x: f64) {
        self.0 = [self.0[0].min(x), self.0[1].max(x)];
    }

    /// Upper bound on the polynomial in the element: relative to the middle of the range, its
    /// absolute value at the points is half the range, and at most `EXCEEDS` times that between
    /// them.
    fn bound(&self) -> f64 {
        let [low, high] = self.0;
        0.5 * (low + high) + 0.5 * EXCEEDS * (high - low)
    }
}

/// 1/cos(6π/32), rounded up.
const EXCEEDS: f64 = 1.203;

/// Least mass per length anywhere, kg/m.
fn least_mass(beam: &Beam) -> f64 {
    let spec = beam.spec();
    spec.segments.iter().map(|segment| segment.section.mass_per_length).fold(spec.section.mass_per_length, f64::min)
}
