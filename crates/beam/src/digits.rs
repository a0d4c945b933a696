//! How many digits of a solve are right.

use crate::beam::Beam;
use crate::error::CholeskyError;
use crate::factor::MatrixWeights;

/// Where the loads act that are solved for, in parts of the span: no node of a coarse mesh, no
/// symmetry.
const PLACES: [f64; 2] = [0.37, 0.82];

/// What rounding takes of solves with `mass M + damping C + stiffness K`, made by [`Beam::digits`]:
/// estimated errors, relative to the largest deflection, 1 where no digit is left.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Digits {
    /// Of [`Factor::solve`](crate::Factor::solve).
    pub solve: f64,
    /// Of the same with iterative refinement, as in [`Beam::solve_static`].
    pub refined: f64,
}

impl Digits {
    /// With fewer digits a result is no longer good for what people do with it, and one should be
    /// told.
    pub const FEW: f64 = 6.0;

    /// Correct decimal digits of [`Factor::solve`](crate::Factor::solve).
    #[must_use]
    pub fn of_solve(&self) -> f64 {
        -self.solve.log10()
    }

    /// Correct decimal digits with iterative refinement.
    #[must_use]
    pub fn of_refined(&self) -> f64 {
        -self.refined.log10()
    }
}

impl Beam {
    /// Estimates the digits of solves with these weights, by solving for two smooth loads, a force
    /// and a couple.
    ///
    /// The error of the plain solve is its distance from the refined one; that of the refined one
    /// is its last correction, or what rounds the moments at the nodes; the largest of the loads
    /// each. Against solves in double-double arithmetic (2 to 2000 elements) the first is at least
    /// half the error wherever more than two digits are lost and at most ten times it, the second
    /// never less than the error. It is an estimate for
    /// [`Backend::Banded`](crate::Backend::Banded); the sparse factor has errors of the same order.
    ///
    /// The stretching of a beam held along its axis is not in it.
    ///
    /// # Errors
    /// As [`Beam::factor`].
    ///
    /// ```
    /// use teeter_beam::{Beam, BeamSpec, Digits, MatrixWeights, Section};
    /// let beam = Beam::new(BeamSpec::new(0.36, 400, Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?))?;
    /// let statics = beam.digits(MatrixWeights::STIFFNESS)?;
    /// assert!(statics.of_solve() < 11.0 && statics.of_refined() > 13.0);
    /// let h = 1e-4; // a step with θ = ½
    /// let step = beam.digits(MatrixWeights { mass: 1.0, damping: 0.5 * h, stiffness: 0.25 * h * h })?;
    /// assert!(step.of_solve() > Digits::FEW);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn digits(&self, weights: MatrixWeights) -> Result<Digits, CholeskyError> {
        let factor = self.factor(weights)?;
        // Moments at the nodes are rounded one by one, as many as there are nodes: a random walk.
        // And the solution itself is.
        let rounding = f64::EPSILON * (4.0 + 2.0 * (self.nodes() as f64).sqrt());
        let mut digits = Digits { solve: rounding, refined: rounding };
        for load in self.probes() {
            let refined = self.refine(&factor, &load, |x, residual| {
                self.add_mass_product(-weights.mass, x, residual);
                self.add_damping_product(-weights.damping, x, residual);
                self.add_stiffness_product(-weights.stiffness, x, residual);
            });
            let difference: Vec<f64> = refined.plain.iter().zip(&refined.solution).map(|(a, b)| a - b).collect();
            let size = self.size(&refined.solution);
            if size == 0.0 {
                continue;
            }
            let error = known(refined.correction);
            digits.refined = digits.refined.max(error);
            digits.solve = digits.solve.max(error).max(known(self.size(&difference) / size));
        }
        Ok(digits)
    }

    /// The loads that are solved for.
    fn probes(&self) -> Vec<Vec<f64>> {
        let zero = vec![0.0; self.dofs()];
        let [mut even, mut smooth, mut force, mut couple] = std::array::from_fn(|_| zero.clone());
        for (node, element) in self.elements.iter().enumerate() {
            even[2 * node..].iter_mut().zip(element.uniform_load()).for_each(|(f, share)| *f += share);
        }
        // A bump that no end feels: near a support that holds back what an even load moves, slopes
        // are steep in a short step, and beside them the error looks small.
        for (f, x) in smooth.iter_mut().step_by(2).zip(self.node_positions()) {
            let s = x / self.spec.span;
            *f = (s * (1.0 - s)).powi(2);
        }
        let [force_at, couple_at] = PLACES.map(|part| part * self.spec.span);
        self.shape_clamped(force_at).add_load(1.0, 0.0, &mut force);
        self.shape_clamped(couple_at).add_load(0.0, 1.0, &mut couple);
        let mut probes = vec![even, smooth, force, couple];
        if self.has_axial_dofs() {
            let mut axial = zero;
            axial[2 * self.nodes()..].fill(1.0);
            probes.push(axial);
        }
        probes
    }
}

/// An error, 1 where it is more or not known at all.
fn known(error: f64) -> f64 {
    if error < 1.0 { error } else { 1.0 }
}
