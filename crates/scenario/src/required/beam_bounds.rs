//! How far a beam gives way to an energy: bounds of deflection, slope and velocity.

use super::barrier::STATIC;
use teeter_beam::Beam;

/// Bounds of a beam's motion by its energy: |w| ≤ √(2 `deflection` U), |w'| ≤ √(2 `slope` U) for an
/// elastic energy U, |ẇ| ≤ √(2 `velocity` T) for a kinetic energy T, all along the beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BeamBounds {
    /// Largest N K⁻¹ Nᵀ, m/N.
    pub(super) deflection: f64,
    /// Largest N' K⁻¹ N'ᵀ, 1/(N m).
    pub(super) slope: f64,
    /// Not less than the largest N M⁻¹ Nᵀ, 1/kg.
    pub(super) velocity: f64,
}

/// Solves that lose more than this part of their result bound nothing.
const MOST_LOST: f64 = 1e-3;

/// What is lost is taken so many times.
const SAFETY: f64 = 10.0;

/// Places in an element at which the flexibility, a polynomial of degree six there, is taken: the
/// zeros of a Chebyshev polynomial.
const PLACES: usize = 16;

impl BeamBounds {
    /// Those of a beam without axial dofs; `None` where supports leave it a rigid motion.
    ///
    /// A polynomial of degree six is nowhere more than 1/cos(6π/32) = 1.203 times as large as it is
    /// at the `PLACES` = 16 zeros of a Chebyshev polynomial (Ehlich & Zeller 1964). Of the
    /// flexibility that is taken of the part that varies over the element.
    pub(super) fn of(beam: &Beam) -> Option<Self> {
        // Springs that are soft beside the beam leave the solves few digits, or none.
        let lost = beam.digits(STATIC).ok()?.solve;
        if lost > MOST_LOST {
            return None;
        }
        let (columns, nodes) = (Self::flexibility(beam)?, beam.node_positions());
        let mut bounds = Self { deflection: 0.0, slope: 0.0, velocity: 0.0 };
        for ends in nodes.windows(2) {
            let (from, length) = (ends[0], ends[1] - ends[0]);
            let (mut w, mut slope) = (Range::EMPTY, Range::EMPTY);
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
        // The estimate of what is lost may be short of it by a factor of two.
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

/// Least and largest value found.
struct Range([f64; 2]);

impl Range {
    const EMPTY: Self = Self([f64::INFINITY, f64::NEG_INFINITY]);

    fn take(&mut self, x: f64) {
        self.0 = [self.0[0].min(x), self.0[1].max(x)];
    }

    /// Not less than the polynomial anywhere in the element: its part about the middle of the range
    /// is as large as half the range at the places, and at most `EXCEEDS` times that between them.
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
