//! The largest stable step of a beam for θ < ½ (`docs/theory.md` §5).

use teeter_beam::{Beam, BeamSpec, MatrixWeights};

/// Largest step (s) at which no mode of the beam grows, for θ < ½; 0 without damping.
///
/// Mode k is stable for `h ≤ 2ζ_k/((1−2θ)ω_k) = (d/ω_k² + a₁)/(1−2θ)` with d = c/ρA + a₀: least for the highest mode of the
/// mesh.
#[must_use]
pub(crate) fn largest_stable_step(spec: &BeamSpec, theta: f64) -> f64 {
    let damping = spec.damping;
    let d = damping.viscous / spec.section.mass_per_length + damping.rayleigh_mass;
    if d == 0.0 && damping.rayleigh_stiffness == 0.0 {
        return 0.0;
    }
    highest_eigenvalue(spec).map_or(0.0, |squared| (d / squared + damping.rayleigh_stiffness) / (1.0 - 2.0 * theta))
}

/// Rounds of the power iteration; the estimate rises towards ω² from below.
const ROUNDS: usize = 400;

/// ω² of the highest mode of the mesh, by power iteration with M⁻¹K, to some 1 %: the bound that it serves is a guide.
fn highest_eigenvalue(spec: &BeamSpec) -> Option<f64> {
    let beam = Beam::new(*spec).ok()?;
    let inverse_mass = beam.factor(MatrixWeights { mass: 1.0, damping: 0.0, stiffness: 0.0 }).ok()?;
    // Fixed, with a part along every mode: signs alternate like the highest mode's, sizes don't repeat.
    let mut x: Vec<f64> =
        (0..beam.dofs()).map(|k| (if k % 4 < 2 { 1.0 } else { -1.0 }) + 0.3 * (k as f64).sin()).collect();
    let mut y = vec![0.0; x.len()];
    let mut quotient = 0.0;
    for _ in 0..ROUNDS {
        y.fill(0.0);
        beam.add_stiffness_product(1.0, &x, &mut y);
        let potential: f64 = x.iter().zip(&y).map(|(x, y)| x * y).sum();
        quotient = potential / (2.0 * beam.kinetic_energy(&x));
        inverse_mass.solve(&mut y);
        let norm = y.iter().map(|y| y * y).sum::<f64>().sqrt();
        if !(norm > 0.0 && norm.is_finite()) {
            return None;
        }
        x.iter_mut().zip(&y).for_each(|(x, y)| *x = y / norm);
    }
    Some(quotient)
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_beam::{Damping, Section, Support};

    fn spec(elements: usize) -> BeamSpec {
        BeamSpec {
            span: 0.36,
            elements,
            section: Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap(),
            supports: [Support::Pinned, Support::Pinned],
            damping: Damping { viscous: 0.4, ..Damping::default() },
        }
    }

    #[test]
    fn the_highest_frequency_grows_with_the_square_of_the_mesh() {
        let frequency = |n| highest_eigenvalue(&spec(n)).unwrap().sqrt();
        let ratio = frequency(40) / frequency(20);
        assert!((ratio - 4.0).abs() < 0.1, "{ratio}");
    }

    #[test]
    fn a_step_at_the_limit_is_where_the_highest_mode_begins_to_grow() {
        // Steps the beam freely from its highest mode, below and above the limit.
        let (spec, theta) = (spec(4), 0.4);
        let limit = largest_stable_step(&spec, theta);
        let grows = |h: f64| {
            let beam = Beam::new(spec).unwrap();
            let w =
                beam.factor(MatrixWeights { mass: 1.0, damping: h * theta, stiffness: h * h * theta * theta }).unwrap();
            let n = beam.dofs();
            let (mut q, mut v) = (vec![1e-6; n], vec![0.0; n]);
            let size = |q: &[f64]| q.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            for _ in 0..200_000 {
                let at: Vec<f64> = q.iter().zip(&v).map(|(q, v)| q + h * theta * v).collect();
                let mut f = vec![0.0; n];
                beam.add_stiffness_product(-h, &at, &mut f);
                beam.add_damping_product(-h, &v, &mut f);
                w.solve(&mut f);
                for k in 0..n {
                    let v1 = v[k] + f[k];
                    q[k] += h * (theta * v1 + (1.0 - theta) * v[k]);
                    v[k] = v1;
                }
                if size(&q) > 1.0 {
                    return true;
                }
            }
            false
        };
        assert!(!grows(0.9 * limit) && grows(1.2 * limit));
    }

    #[test]
    fn without_damping_no_step_is_stable() {
        let mut spec = spec(4);
        spec.damping = Damping::default();
        assert_eq!(largest_stable_step(&spec, 0.3), 0.0);
    }
}
