//! Digits that rounding leaves of solves with a beam.

use crate::scene::{BeamScene, Scene};
use teeter_beam::{Beam, BeamSpec, Digits, MatrixWeights};

/// What the digits of a beam's solves depend on.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SolveDigits {
    spec: BeamSpec,
    /// θ and the step (s); `None` for a beam in modes, which solves for each separately.
    step: Option<(f64, f64)>,
    static_start: bool,
}

/// Solves of which few digits are correct.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FewDigits {
    /// The number of correct decimal digits.
    pub(crate) correct: f64,
    /// What is solved.
    pub(crate) what: &'static str,
    /// The elements of the beam.
    pub(crate) elements: usize,
}

impl SolveDigits {
    /// Those of a beam of the scene.
    pub(crate) fn of(scene: &Scene, number: usize) -> Self {
        let BeamScene { spec, reduction, static_start, .. } = &scene.beams[number];
        let step = reduction.is_none().then_some((scene.time.theta, scene.time.step));
        Self { spec: spec.clone(), step, static_start: *static_start }
    }

    /// The solve with the fewest correct digits, if these are few. The solve of a static start is refined, and loses digits later.
    pub(crate) fn few(&self) -> Option<FewDigits> {
        let model = Beam::new(self.spec.clone()).ok()?;
        let step = self.step.and_then(|(theta, step)| of_step(&model, theta, step));
        let statics = || {
            // What only blocks hold up is solved for with them, not with the beam's stiffness alone: that is singular, and what its
            // factor is by rounding tells nothing.
            if model.rigid_motion().is_some() {
                return None;
            }
            model.digits(MatrixWeights::STIFFNESS).ok().map(|digits| digits.of_refined())
        };
        let statics = self.static_start.then(statics).flatten();
        let both = step.map(|digits| (digits, "a step's solve")).into_iter();
        let both = both.chain(statics.map(|digits| (digits, "the static start")));
        let (correct, what) = both.min_by(|(a, _), (b, _)| a.total_cmp(b))?;
        (correct < Digits::FEW).then_some(FewDigits { correct, what, elements: model.elements() })
    }
}

/// Correct digits of a step's solve.
pub(crate) fn of_step(model: &Beam, theta: f64, step: f64) -> Option<f64> {
    let ht = theta * step;
    let weights = MatrixWeights { mass: 1.0, damping: ht, stiffness: ht * ht };
    model.digits(weights).ok().map(|digits| digits.of_solve())
}
