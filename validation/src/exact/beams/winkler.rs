//! A uniform Euler–Bernoulli beam on Winkler's foundation, EI w″″ + k w + ρA ẅ = f, k in N/m² (Hetényi, *Beams on Elastic Foundation*,
//! 1946; λ⁴ = k/(4 EI)).

use super::Uniform;

/// ω, rad/s, of the mode whose wave number without foundation is `beta`: ω² = (β/L)⁴ EI/ρA + k/ρA, for the foundation presses alike
/// everywhere, so that the modes stay, whatever the ends.
pub(crate) fn frequency(beam: Uniform, foundation: f64, beta: f64) -> f64 {
    beam.frequency(beta).hypot((foundation / beam.mass).sqrt())
}

/// λ, 1/m.
pub(crate) fn decay(bending: f64, foundation: f64) -> f64 {
    (foundation / (4.0 * bending)).powf(0.25)
}

/// w at `x` of a pinned–pinned beam under a load q per length: with u = λL/2 and ξ = x − L/2,
/// w = (q/k) [1 − 2 (cos u cosh u cos λξ cosh λξ + sin u sinh u sin λξ sinh λξ)/(cos 2u + cosh 2u)].
pub(crate) fn pinned_under_uniform_load(beam: Uniform, foundation: f64, load: f64, x: f64) -> f64 {
    let lambda = decay(beam.bending, foundation);
    let (u, xi) = (0.5 * lambda * beam.span, lambda * (x - 0.5 * beam.span));
    let even = u.cos() * u.cosh() * xi.cos() * xi.cosh();
    let odd = u.sin() * u.sinh() * xi.sin() * xi.sinh();
    load / foundation * (1.0 - 2.0 * (even + odd) / ((2.0 * u).cos() + (2.0 * u).cosh()))
}

/// M at midspan of the same, N·m: −(q/λ²) sin u sinh u/(cos 2u + cosh 2u) (hogging for a load upwards).
pub(crate) fn pinned_midspan_moment(beam: Uniform, foundation: f64, load: f64) -> f64 {
    let lambda = decay(beam.bending, foundation);
    let u = 0.5 * lambda * beam.span;
    -load / (lambda * lambda) * u.sin() * u.sinh() / ((2.0 * u).cos() + (2.0 * u).cosh())
}

/// w at the distance `x` from a force P on an endless beam: Pλ/(2k) e^{−λ|x|} (cos λ|x| + sin λ|x|).
pub(crate) fn endless_under_force(bending: f64, foundation: f64, force: f64, x: f64) -> f64 {
    let lambda = decay(bending, foundation);
    let s = lambda * x.abs();
    force * lambda / (2.0 * foundation) * (-s).exp() * (s.cos() + s.sin())
}

/// M at the distance `x` from a force P on an endless beam: −P/(4λ) e^{−λ|x|} (cos λ|x| − sin λ|x|).
pub(crate) fn endless_moment(bending: f64, foundation: f64, force: f64, x: f64) -> f64 {
    let lambda = decay(bending, foundation);
    let s = lambda * x.abs();
    -force / (4.0 * lambda) * (-s).exp() * (s.cos() - s.sin())
}

#[cfg(test)]
mod tests {
    use super::super::tests::agree;
    use super::*;
    use std::f64::consts::PI;

    const BEAM: Uniform = Uniform { span: 1.3, bending: 2.1, mass: 0.4 };

    /// Navier: w = Σ 4q/(πj) sin(jπx/L)/(EI (jπ/L)⁴ + k) over odd j.
    #[test]
    fn the_closed_form_is_the_sum_of_waves() {
        for foundation in [0.5, 300.0, 4e5] {
            for x in [0.2, 0.65, 1.0] {
                let (mut w, mut m) = (0.0, 0.0);
                for j in (1..20_000).step_by(2).map(f64::from) {
                    let k = j * PI / BEAM.span;
                    let term = 4.0 / (PI * j) * (k * x).sin() / (BEAM.bending * k.powi(4) + foundation);
                    w += term;
                    m -= BEAM.bending * k * k * term;
                }
                agree(pinned_under_uniform_load(BEAM, foundation, 3.0, x), 3.0 * w, 1e-11);
                if x == 0.65 {
                    // Terms of alternating sign, the first left out 1e-13.
                    assert!((pinned_midspan_moment(BEAM, foundation, 3.0) - 3.0 * m).abs() < 1e-11);
                }
            }
        }
    }

    /// A soft foundation is none: 5 q L⁴/(384 EI).
    #[test]
    fn a_soft_foundation_is_none() {
        let w = pinned_under_uniform_load(BEAM, 1e-3, 1.0, 0.65);
        agree(w, 5.0 * BEAM.span.powi(4) / (384.0 * BEAM.bending), 1e-4);
        agree(pinned_midspan_moment(BEAM, 1e-3, 1.0), -BEAM.span.powi(2) / 8.0, 1e-4);
    }

    /// Equilibrium of the endless beam: the foundation carries the force; the moment is EI w″.
    #[test]
    fn the_foundation_carries_the_force() {
        let (ei, k, p) = (2.1, 300.0, -7.0);
        let h = 1e-3;
        let sum: f64 = (-10_000..10_000).map(|i| endless_under_force(ei, k, p, (f64::from(i) + 0.5) * h)).sum();
        agree(k * h * sum, p, 1e-5);
        let w = |x| endless_under_force(ei, k, p, x);
        let curvature = (w(0.3 + h) - 2.0 * w(0.3) + w(0.3 - h)) / (h * h);
        agree(endless_moment(ei, k, p, 0.3), ei * curvature, 1e-4);
        agree(endless_moment(ei, k, p, 0.0), 7.0 / (4.0 * decay(ei, k)), 1e-15);
    }

    #[test]
    fn all_modes_gain_the_same() {
        let with = frequency(BEAM, 50.0, 2.0 * PI);
        agree(with * with - BEAM.frequency(2.0 * PI).powi(2), 50.0 / BEAM.mass, 1e-12);
    }
}
