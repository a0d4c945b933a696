//! Whether steps were fine enough for the free swings of beams (`docs/resolution.md`).
//!
//! A step of the θ rule multiplies a free swing of circular frequency ω by λ,
//!
//! ```text
//! λ² − (2 − 2θh²ω²/D) λ + 1 + (1 − 2θ)h²ω²/D = 0,        D = 1 + θ²h²ω²
//! ```
//!
//! instead of by exp(iωh): with θ = ½ it comes late, with more it dies out besides. With ρ = exp(iωh)/λ, the swing that is there after n steps, of amplitude |ẇ|/ω,
//! is off by |ρⁿ − 1| of itself. ω is that of the first mode. What follows a load slowly has a small ẇ, and takes no harm.

use serde::{Deserialize, Serialize};
use teeter_beam::ShapeAt;
use teeter_integrator::State;
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::{BeamPlace, Layout};

/// A part of the largest deflection that is off, from which on a run is told of.
pub(crate) const OFF: f64 = 0.1;

/// What a step leaves that is advised.
const FINE: f64 = 0.02;

/// What is known of a beam's swings so far.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Swing {
    /// ρⁿ, its real and imaginary part.
    off: [f64; 2],
    /// The largest deflection, m.
    most: f64,
    /// The largest |ẇ| |ρⁿ − 1|, m/s.
    worst: f64,
}

impl Default for Swing {
    fn default() -> Self {
        Self { off: [1.0, 0.0], most: 0.0, worst: 0.0 }
    }
}

/// What a run has shown so far of how well its steps resolve the swings of its beams.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Swings(Vec<Swing>);

/// A beam whose swings the steps don't resolve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lost {
    /// Its number.
    pub(crate) beam: usize,
    /// How much is off, as a part of the largest deflection.
    pub(crate) part: f64,
    /// Its first frequency, Hz.
    pub(crate) frequency: f64,
    /// A step to take in its place, s.
    pub(crate) step: f64,
}

/// Where to look at the beams of a scene, and how fast they swing.
#[derive(Debug, Default)]
pub(crate) struct Watch {
    beams: Vec<Watched>,
    theta: f64,
}

/// Where to look at a beam, and ρ for its first circular frequency.
#[derive(Debug)]
struct Watched {
    places: Vec<ShapeAt>,
    omega: f64,
    /// The step size that `factor` is for, s.
    step: f64,
    factor: [f64; 2],
}

impl Watch {
    pub(crate) fn of(scene: &Scene, layout: &Layout) -> Self {
        let theta = scene.time.theta_of_scheme();
        let watched = |place: &BeamPlace| {
            // A beam that no frequency is known of is not watched.
            let omega = place.first_frequency().unwrap_or(0.0);
            let places = place.middles().into_iter().map(|x| place.beam.shape_clamped(x)).collect();
            Watched { places, omega, step: 0.0, factor: [1.0, 0.0] }
        };
        Self { beams: layout.beams.iter().map(watched).collect(), theta }
    }

    /// Whether the steps take nothing out of a swing.
    pub(crate) fn conserves(&self) -> bool {
        self.theta == 0.5
    }
}

impl Swings {
    /// Before the first step.
    pub(crate) fn start(&mut self, layout: &Layout) {
        self.0.clear();
        self.0.resize(layout.beams.len(), Swing::default());
    }

    /// Takes a step of length `h` (s) in that ended in `state`.
    pub(crate) fn observe(&mut self, watch: &mut Watch, layout: &Layout, h: f64, state: &State) {
        for ((swing, watched), place) in self.0.iter_mut().zip(&mut watch.beams).zip(&layout.beams) {
            if watched.omega == 0.0 {
                continue;
            }
            if watched.step != h {
                (watched.step, watched.factor) = (h, factor(watch.theta, watched.omega * h));
            }
            let ([a, b], [c, d]) = (swing.off, watched.factor);
            swing.off = [a * c - b * d, a * d + b * c];
            let lost = (swing.off[0] - 1.0).hypot(swing.off[1]).min(MOST);
            for at in &watched.places {
                let [w, rate] = [&state.q, &state.v].map(|x| place.deflection(at, &x[place.range.clone()]).w.abs());
                swing.most = swing.most.max(w);
                swing.worst = swing.worst.max(lost * rate);
            }
        }
    }

    /// The beam whose swings steps of length `step` (s) resolve worst, if that is badly.
    pub(crate) fn lost(&self, watch: &Watch, step: f64) -> Option<Lost> {
        let all = self.0.iter().zip(&watch.beams).enumerate();
        let parts = all.filter(|(_, (swing, watched))| swing.most > 0.0 && watched.omega > 0.0).map(
            |(beam, (swing, watched))| {
                let part = swing.worst / (watched.omega * swing.most);
                // Of second order with θ = ½, else of first.
                let order = if watch.conserves() { 2.0 } else { 1.0 };
                let step = step * (FINE / part).powf(1.0 / order);
                Lost { beam, part, frequency: watched.omega / std::f64::consts::TAU, step }
            },
        );
        parts.filter(|lost| lost.part > OFF).max_by(|a, b| a.part.total_cmp(&b.part))
    }
}

/// A swing in the opposite phase is off by twice itself, and one that has died out can't be by more than it was.
const MOST: f64 = 1e3;

/// ρ for a step of ωh.
fn factor(theta: f64, x: f64) -> [f64; 2] {
    let d = 1.0 + (theta * x).powi(2);
    let (half, product) = (1.0 - theta * x * x / d, 1.0 + (1.0 - 2.0 * theta) * x * x / d);
    let beneath = product - half * half;
    if beneath <= 0.0 {
        // No swing is left: the slower one of the two decays.
        let decay = half + (-beneath).sqrt();
        return [x.cos() / decay, x.sin() / decay];
    }
    let (re, im) = (half, beneath.sqrt());
    // exp(ix) times the conjugate of λ, over |λ|² = product.
    [(x.cos() * re + x.sin() * im) / product, (x.sin() * re - x.cos() * im) / product]
}

#[cfg(test)]
mod tests {
    use super::factor;

    #[test]
    fn a_step_of_a_free_swing_is_off_by_the_known_phase_and_decay() {
        // θ = ½: no decay, and a phase of x − 2 atan(x/2), which is x³/12.
        let x = 0.1_f64;
        let [re, im] = factor(0.5, x);
        assert!((re.hypot(im) - 1.0).abs() < 1e-14);
        assert!((im.atan2(re) - (x - 2.0 * (0.5 * x).atan())).abs() < 1e-14);
        // θ = 1: backward Euler, λ = 1/(1 − ix).
        let [re, im] = factor(1.0, x);
        assert!(
            (re - (x.cos() + x * x.sin())).abs() < 1e-14 && (im - (x.sin() - x * x.cos())).abs() < 1e-14,
            "{re} {im}"
        );
    }
}
