//! The largest stable step of a beam for θ < ½ (`docs/theory.md` §5).

use teeter_beam::{Beam, BeamError, BeamSpec, MatrixWeights};

/// Largest step (s) at which no mode of the beam grows, for θ < ½; 0 without damping.
///
/// The scheme multiplies a mode of eigenvalue λ by (1 + (1−θ)hλ)/(1 − θhλ) a step, so it is stable
/// for `h ≤ −2 Re λ / ((1−2θ)|λ|²)`. That is 2ζ/((1−2θ)ω) for an underdamped mode, least for the
/// highest mode of the mesh, and 2/((1−2θ)|λ|) for an overdamped one, where |λ| approaches 2ζω;
/// with d = c/ρA + a₀ that is d for the low modes.
#[must_use]
pub(crate) fn largest_stable_step(spec: &BeamSpec, theta: f64) -> f64 {
    let damping = &spec.damping;
    let d = damping.viscous / spec.section.mass_per_length + damping.rayleigh_mass;
    if d == 0.0 && damping.rayleigh_stiffness == 0.0 {
        return 0.0;
    }
    let Some(squared) = highest_eigenvalue(spec) else { return 0.0 };
    let (omega, rate) = (squared.sqrt(), d + damping.rayleigh_stiffness * squared);
    let zeta = 0.5 * rate / omega;
    let highest = if zeta <= 1.0 { 2.0 * zeta / omega } else { 2.0 / (omega * (zeta + (zeta * zeta - 1.0).sqrt())) };
    let lowest = if d > 0.0 { 2.0 / d } else { f64::INFINITY };
    highest.min(lowest) / (1.0 - 2.0 * theta)
}

/// The first elastic circular frequency, rad/s: that of the continuous beam if there is a frequency
/// equation (then `true`), otherwise that of the finite elements.
pub(crate) fn first_frequency(spec: &BeamSpec) -> Option<(f64, bool)> {
    match spec.circular_frequency(1) {
        Err(BeamError::NoFrequencyEquation) => {
            let beam = Beam::new(spec.clone()).ok()?;
            // Up and down, turning, along the axis: at most three rigid motions come before it.
            let modes = beam.modes(beam.free_dofs().min(4)).ok()?;
            modes.circular_frequencies().get(modes.rigid()).map(|omega| (*omega, false))
        }
        exact => exact.ok().map(|omega| (omega, true)),
    }
}

/// Iterations of the power method; the estimate converges to ω² from below.
const ROUNDS: usize = 400;

/// ω² of the highest mode of the mesh, by power iteration with M⁻¹K, to some 1 %, which is enough
/// for a guideline.
pub(crate) fn highest_eigenvalue(spec: &BeamSpec) -> Option<f64> {
    let beam = Beam::new(spec.clone()).ok()?;
    let inverse_mass = beam.factor(MatrixWeights { mass: 1.0, damping: 0.0, stiffness: 0.0 }).ok()?;
    // A fixed start vector with a component of every mode: signs alternate as in the highest mode,
    // magnitudes don't repeat.
    let mut x: Vec<f64> =
        (0..beam.dofs()).map(|k| (if k % 4 < 2 { 1.0 } else { -1.0 }) + 0.3 * (k as f64).sin()).collect();
    x.iter_mut().enumerate().filter(|(k, _)| beam.is_held(*k)).for_each(|(_, x)| *x = 0.0);
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
    use teeter_beam::{Damping, Section};

    fn spec(elements: usize) -> BeamSpec {
        BeamSpec::new(0.36, elements, Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap())
            .damped(Damping::none().with_viscous(0.4))
    }

    #[test]
    fn the_highest_frequency_grows_with_the_square_of_the_mesh() {
        let frequency = |n| highest_eigenvalue(&spec(n)).unwrap().sqrt();
        let ratio = frequency(40) / frequency(20);
        assert!((ratio - 4.0).abs() < 0.1, "{ratio}");
    }

    /// Whether the beam, stepped freely, grows beyond all bounds.
    fn grows(spec: BeamSpec, theta: f64, h: f64) -> bool {
        let beam = Beam::new(spec).unwrap();
        let weights = MatrixWeights { mass: 1.0, damping: h * theta, stiffness: h * h * theta * theta };
        let w = beam.factor(weights).unwrap();
        let n = beam.dofs();
        // All modes, the highest too, start with some velocity.
        let (mut q, mut v) = (vec![0.0; n], (0..n).map(|k| (1.0 + k as f64).sin()).collect::<Vec<_>>());
        v.iter_mut().enumerate().filter(|(k, _)| beam.is_held(*k)).for_each(|(_, v)| *v = 0.0);
        let start = beam.kinetic_energy(&v);
        for _ in 0..4000 {
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
        }
        beam.kinetic_energy(&v) + beam.elastic_energy(&q) > start
    }

    #[test]
    fn at_the_limit_some_mode_begins_to_grow() {
        // The highest mode underdamped; overdamped by Rayleigh's a₁; the low modes overdamped by c.
        for (viscous, rayleigh_stiffness) in [(300.0, 0.0), (0.0, 1e-3), (1e4, 0.0)] {
            let mut spec = spec(4);
            spec.damping = Damping::none().with_viscous(viscous).with_rayleigh_stiffness(rayleigh_stiffness);
            let limit = largest_stable_step(&spec, 0.4);
            assert!(!grows(spec.clone(), 0.4, 0.9 * limit), "{viscous} {rayleigh_stiffness}: {limit:e} is too large");
            assert!(grows(spec, 0.4, 1.2 * limit), "{viscous} {rayleigh_stiffness}: {limit:e} is too small");
        }
    }

    #[test]
    fn without_damping_no_step_is_stable() {
        let mut spec = spec(4);
        spec.damping = Damping::default();
        assert_eq!(largest_stable_step(&spec, 0.3), 0.0);
    }
}
