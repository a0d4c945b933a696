//! The energy account: an identity of the scheme, computed every step (`docs/theory.md` §7).
//!
//! For every θ, up to rounding,
//!
//! ```text
//! Δ(T+V) = −h v_θᵀC v_θ + h v_θᵀP̄ + Σ U_θ·p − (θ−½)(ΔvᵀM Δv + ΔqᵀK Δq)
//! ```
//!
//! viscous loss, work of loads, contact and friction, numerical dissipation. What is left over is
//! rounding, or a mistake. If V is not quadratic, a step conserves T + V plus the parts' [modified
//! energy](crate::Linearised::modified_energy), whose change, with a minus, counts as numerical
//! too.

use crate::Energy;

/// The terms of one step, J, signed as in the identity: a loss is negative.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StepEnergy {
    /// Work of external loads.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    pub external: f64,
    /// Normal contact: Σ U_θ,n p_n; for a contact with duration the loss alone, as its spring's
    /// energy counts as stored.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    pub contact: f64,
    /// Friction: Σ U_θ,t·p_t.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    pub friction: f64,
    /// Viscous loss.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    pub viscous: f64,
    /// Numerical dissipation, less the change of the modified energy.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    pub numerical: f64,
    /// Work of a projection of the positions.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    pub projection: f64,
    /// Δ(T+V) minus all of the above.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    pub residual: f64,
}

impl StepEnergy {
    pub(crate) fn add(&mut self, step: &Self) {
        self.external += step.external;
        self.contact += step.contact;
        self.friction += step.friction;
        self.viscous += step.viscous;
        self.numerical += step.numerical;
        self.projection += step.projection;
        self.residual += step.residual;
    }

    fn explained(&self) -> f64 {
        self.external + self.contact + self.friction + self.viscous + self.numerical + self.projection
    }
}

/// Steps in which contact and friction together added energy to the bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PositiveWork {
    /// How many.
    pub steps: u64,
    /// The largest gain in one step, J.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    pub largest: f64,
    /// All gains together, J.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    pub sum: f64,
}

/// The energy account of a run.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Ledger {
    /// At the start.
    pub initial: Energy,
    /// Now.
    pub current: Energy,
    /// The terms added up since the start; `residual` is the sum of the signed residuals.
    pub sum: StepEnergy,
    /// Largest |residual| of a step, J.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    pub largest_residual: f64,
    /// The scene's energy scale so far, J: max |T| + |V_elastic| + |ΔV_gravity|, at least Σ m g R.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    pub scale: f64,
    /// Elastic energy of contacts with duration, J; included in `current`.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    pub stored: f64,
    /// Energy gained by contact.
    pub positive_contact_work: PositiveWork,
    /// Largest (U¹ + s)_t·p_t of a contact in a step, J, with s the shift of its law; by the law it
    /// is ≤ 0 up to rounding.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    pub largest_tangential_work: f64,
}

/// Contact work of a step above this fraction of the energy scale counts as a gain; below, it is
/// rounding.
const ROUNDING: f64 = 1e-15;

impl Ledger {
    pub(crate) fn new(initial: Energy, floor: f64) -> Self {
        let mut ledger = Self {
            initial,
            current: initial,
            sum: StepEnergy::default(),
            largest_residual: 0.0,
            scale: floor,
            stored: 0.0,
            positive_contact_work: PositiveWork::default(),
            largest_tangential_work: f64::NEG_INFINITY,
        };
        ledger.rescale();
        ledger
    }

    /// Begins with energy that springs of contacts hold already, J.
    pub(crate) fn take_stored(&mut self, stored: f64) {
        self.initial.elastic += stored - self.stored;
        self.current.elastic += stored - self.stored;
        self.stored = stored;
        self.rescale();
    }

    fn rescale(&mut self) {
        let Energy { kinetic, elastic, gravity } = self.current;
        self.scale = self.scale.max(kinetic.abs() + elastic.abs() + (gravity - self.initial.gravity).abs());
    }

    /// Enters a step or a phase of one that ends with energies `now`, and fills in the residual of
    /// `step`.
    pub fn enter(&mut self, now: Energy, step: &mut StepEnergy) {
        let before = self.current;
        // Term by term, as the difference of sums of large and small energies would lose digits.
        let change = (now.kinetic - before.kinetic) + (now.elastic - before.elastic) + (now.gravity - before.gravity);
        step.residual = change - step.explained();
        self.current = now;
        self.rescale();
        self.sum.add(step);
        self.largest_residual = self.largest_residual.max(step.residual.abs());
        let work = step.contact + step.friction;
        if work > ROUNDING * self.scale {
            self.positive_contact_work.steps += 1;
            self.positive_contact_work.largest = self.positive_contact_work.largest.max(work);
            self.positive_contact_work.sum += work;
        }
    }

    /// The largest residual relative to the energy scale; 0 for a scene without energy.
    #[must_use]
    pub fn relative_residual(&self) -> f64 {
        if self.scale > 0.0 { self.largest_residual / self.scale } else { self.largest_residual }
    }
}
