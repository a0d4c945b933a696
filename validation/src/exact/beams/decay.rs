//! How modes of a damped beam decay: q̈ + 2δ q̇ + ω² q = 0, q = e^{−δt} (…), with δ half of φᵀCφ for φᵀMφ = 1.

/// δ, 1/s, by a viscous damping c per length (N·s/m²): c/(2ρA), the same for all modes.
pub(crate) fn viscous(damping: f64, mass: f64) -> f64 {
    damping / (2.0 * mass)
}

/// δ, 1/s, of the mode of circular frequency ω by C = a₀M + a₁K (Rayleigh): (a₀ + a₁ω²)/2.
pub(crate) fn rayleigh(mass_factor: f64, stiffness_factor: f64, omega: f64) -> f64 {
    0.5 * (mass_factor + stiffness_factor * omega * omega)
}

/// ω_d = √(ω² − δ²), rad/s; NaN where the mode creeps back.
pub(crate) fn damped_frequency(omega: f64, decay: f64) -> f64 {
    ((omega - decay) * (omega + decay)).sqrt()
}

/// a₀ and a₁ that give the damping ratios ζ = δ/ω at two frequencies (Clough and Penzien, *Dynamics of Structures*).
pub(crate) fn rayleigh_through([(omega_1, zeta_1), (omega_2, zeta_2)]: [(f64, f64); 2]) -> [f64; 2] {
    let factor = 2.0 * omega_1 * omega_2 / (omega_2 * omega_2 - omega_1 * omega_1);
    [factor * (zeta_1 * omega_2 - zeta_2 * omega_1), factor * (zeta_2 / omega_1 - zeta_1 / omega_2)]
}

/// q(t) of a mode let go at 1, at rest.
#[cfg_attr(not(test), expect(dead_code, reason = "no case compares with it yet"))]
pub(crate) fn let_go(omega: f64, decay: f64, t: f64) -> f64 {
    let damped = damped_frequency(omega, decay);
    (-decay * t).exp() * ((damped * t).cos() + decay / damped * (damped * t).sin())
}

#[cfg(test)]
mod tests {
    use super::super::super::extrapolation::integrate;
    use super::super::tests::agree;
    use super::*;

    /// The source paper's beam: c = 0.405083279 makes a ratio of 0.01 in the first mode.
    #[test]
    fn viscous_of_the_paper() {
        agree(viscous(0.405_083_279_0, 0.1215) / 166.700_937_859_116_52, 0.01, 1e-9);
    }

    #[test]
    fn rayleigh_passes_through_both_ratios() {
        let [a0, a1] = rayleigh_through([(20.0, 0.02), (150.0, 0.05)]);
        agree(rayleigh(a0, a1, 20.0) / 20.0, 0.02, 1e-14);
        agree(rayleigh(a0, a1, 150.0) / 150.0, 0.05, 1e-14);
        // Equal ratios: 2ζω₁ω₂/(ω₁ + ω₂) and 2ζ/(ω₁ + ω₂).
        let [a0, a1] = rayleigh_through([(20.0, 0.03), (150.0, 0.03)]);
        agree(a0, 0.06 * 3000.0 / 170.0, 1e-14);
        agree(a1, 0.06 / 170.0, 1e-14);
    }

    #[test]
    fn the_decay_is_that_of_the_equation() {
        let (omega, decay) = (3.0, 0.4);
        let motion = |_: f64, y: &[f64; 2]| [y[1], -2.0 * decay * y[1] - omega * omega * y[0]];
        let end = integrate(motion, (0.0, [1.0, 0.0]), 2.5, 0.1, |_| 1.0);
        assert!((let_go(omega, decay, 2.5) - end.y[0]).abs() < 1e-13, "{end:?}");
        assert!(damped_frequency(1.0, 1.1).is_nan());
    }
}
