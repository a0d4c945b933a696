//! Errors of steps in a free vibration (`docs/resolution.md`).
//!
//! A step of the θ rule multiplies a free vibration of circular frequency ω by λ,
//!
//! ```text
//! λ² − (2 − 2θh²ω²/D) λ + 1 + (1 − 2θ)h²ω²/D = 0,        D = 1 + θ²h²ω²
//! ```
//!
//! instead of by exp(iωh): with θ = ½ it lags, with a larger θ it also decays. ρ = exp(iωh)/λ gives
//! the error per step.

use crate::diagnostic::Diagnostic;
use crate::document::Document;
use crate::scene::Scene;
use crate::wording;
use teeter_beam::{Beam, MatrixWeights};

/// An error above this fraction of the largest deflection gives a warning.
pub const SWING_OFF: f64 = 0.1;

/// Free vibration of a beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Swing {
    /// Circular frequency ω, rad/s.
    pub omega: f64,
    /// ζω: a vibration decays as exp(−ζωt), 1/s.
    pub decay: f64,
}

impl Swing {
    /// From Rayleigh's quotient of a shape, given by the beam's dofs, or of the sag under a uniform
    /// load if the shape is zero. `None` for a beam that can move rigidly.
    #[must_use]
    pub fn of(beam: &Beam, shape: &[f64]) -> Option<Self> {
        let statics = MatrixWeights { mass: 0.0, damping: 0.0, stiffness: 1.0 };
        let factor = beam.factor(statics).ok()?;
        let mut q = shape.to_vec();
        if q.len() != beam.dofs() || q.iter().all(|x| *x == 0.0) {
            q = vec![0.0; beam.dofs()];
            beam.add_partial_load([0.0, beam.spec().span], 1.0, &mut q).ok()?;
            factor.solve(&mut q);
        }
        let mut damping = vec![0.0; q.len()];
        beam.add_damping_product(1.0, &q, &mut damping);
        let (elastic, kinetic) = (beam.elastic_energy(&q), beam.kinetic_energy(&q));
        let omega = (elastic / kinetic).sqrt();
        let decay = q.iter().zip(&damping).map(|(x, f)| x * f).sum::<f64>() / (4.0 * kinetic);
        (omega.is_finite() && omega > 0.0).then_some(Self { omega, decay })
    }

    /// ρ − 1, its real and imaginary part, for steps of `h` (s).
    #[must_use]
    pub fn off_a_step(&self, theta: f64, h: f64) -> [f64; 2] {
        let x = self.omega * h;
        let d = 1.0 + (theta * x).powi(2);
        let (half, product) = (1.0 - theta * x * x / d, 1.0 + (1.0 - 2.0 * theta) * x * x / d);
        let beneath = product - half * half;
        if beneath <= 0.0 {
            // Overdamped: the slower one of two decays.
            let decay = half + (-beneath).sqrt();
            return [x.cos() / decay - 1.0, x.sin() / decay];
        }
        let (re, im) = (half, beneath.sqrt());
        // exp(ix) times the conjugate of λ, over |λ|² = product.
        [(x.cos() * re + x.sin() * im) / product - 1.0, (x.sin() * re - x.cos() * im) / product]
    }

    /// Largest error, within a run, of a vibration that starts with it, relative to the vibration.
    fn off(&self, theta: f64, h: f64, end: f64) -> f64 {
        /// Number of times that are evaluated.
        const LOOKS: u32 = 500;
        let [re, im] = self.off_a_step(theta, h);
        let (ln, angle) = ((1.0 + re).hypot(im).ln(), im.atan2(1.0 + re));
        let off = |k: u32| {
            let t = end * f64::from(k) / f64::from(LOOKS);
            // 1/ρⁿ: the ratio of the computed to the exact vibration.
            let (left, late) = ((-ln * t / h).exp(), angle * t / h);
            (-self.decay * t).exp() * (left * late.cos() - 1.0).hypot(left * late.sin())
        };
        (0..=LOOKS).map(off).fold(0.0, f64::max)
    }
}

/// Warns of beams released from a deformed shape that vibrate too fast for the steps.
pub(crate) fn coarse(scene: &Scene, document: &Document) -> Vec<Diagnostic> {
    let theta = scene.time.theta_of_scheme();
    let end = scene.time.steps() as f64 * scene.time.step;
    let of = |beam: &crate::scene::BeamScene| {
        if beam.shape.iter().all(|x| *x == 0.0) {
            return None;
        }
        let swing = Swing::of(&Beam::new(beam.spec.clone()).ok()?, &beam.shape)?;
        let part = swing.off(theta, scene.time.step, end);
        (part > SWING_OFF).then(|| {
            let rule = format!(
                "under-resolved: with steps of {} the initial vibration of `{}`, at {:.4} Hz, lags or decays by up to {} its amplitude",
                wording::seconds(scene.time.step, 4),
                beam.name,
                swing.omega / std::f64::consts::TAU,
                wording::share_of(part)
            );
            let step = finer(scene.time.step, part, theta);
            document.error("time.step", rule, format!("use a step of at most {}", wording::seconds(step, 1))).as_warning()
        })
    };
    scene.beams.iter().filter_map(of).collect()
}

/// A step with an error of 2 %, if `step` has the error `part`: of second order with θ = ½,
/// otherwise of first.
#[must_use]
pub fn finer(step: f64, part: f64, theta: f64) -> f64 {
    const LEFT: f64 = 0.02;
    // A very large error only shows that the step is far too long: recommending less than a
    // hundredth of it would be a guess.
    step * (LEFT / part.min(2.0)).powf(if theta == 0.5 { 0.5 } else { 1.0 })
}

#[cfg(test)]
mod tests {
    use super::Swing;

    #[test]
    fn a_step_of_a_free_swing_is_off_by_the_known_phase_and_decay() {
        let (x, swing) = (0.1_f64, Swing { omega: 100.0, decay: 0.0 });
        // θ = ½: no decay, and a phase of x − 2 atan(x/2), which is x³/12.
        let [re, im] = swing.off_a_step(0.5, 1e-3);
        assert!(((1.0 + re).hypot(im) - 1.0).abs() < 1e-14);
        assert!((im.atan2(1.0 + re) - (x - 2.0 * (0.5 * x).atan())).abs() < 1e-14);
        // θ = 1: backward Euler, λ = 1/(1 − ix).
        let [re, im] = swing.off_a_step(1.0, 1e-3);
        assert!((1.0 + re - (x.cos() + x * x.sin())).abs() < 1e-14 && (im - (x.sin() - x * x.cos())).abs() < 1e-14);
    }
}
