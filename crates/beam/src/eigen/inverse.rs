//! The shifted inverse A = (K + σM)⁻¹M of the subspace iteration, solved to rounding, and its start
//! vectors.

use super::block::{Orthonormal, VectorBlock, norm, normalise};
use crate::beam::Beam;
use crate::error::{CholeskyError, ModesError};
use crate::factor::{Factor, MatrixWeights};
use std::ops::Range;

/// σ in units of ε ω²_max: enough that every round of refinement gains two digits and more.
const SHIFT: f64 = 100.0;

/// Steps of the power method for ω²_max, of which only the order of magnitude matters.
const POWER_STEPS: usize = 10;

/// Rounds of iterative refinement at the most.
const MAX_REFINEMENTS: usize = 12;

/// A last correction above this, relative to the solution, is no solution. Not less, for rounding
/// leaves ε λ_j/λ_1 of the lowest modes on the solution for mode j.
const SOLVED: f64 = 1e-3;

pub(crate) struct Inverse<'a> {
    beam: &'a Beam,
    shift: f64,
    /// Of K + σM.
    factor: Factor,
    /// Of M.
    mass: Factor,
}

impl<'a> Inverse<'a> {
    pub(crate) fn new(beam: &'a Beam) -> Result<Self, CholeskyError> {
        let mass = beam.factor(MatrixWeights::MASS)?;
        let mut x = noise(beam, &mass, 0);
        let mut highest = 0.0_f64;
        for _ in 0..POWER_STEPS {
            normalise(beam, &mut x);
            let mut force = vec![0.0; x.len()];
            // Of the elements alone: a spring is one entry on the diagonal, which no elimination
            // loses digits by however stiff it is, and the frequency of a stiff one would hide
            // those of the beam behind the shift.
            let (bend, axial) = beam.split_mut(&mut force);
            beam.bending.add_product(1.0, beam.bend(&x), bend);
            if let Some(bar) = &beam.bar {
                bar.add_stiffness_product(1.0, &x[2 * beam.nodes()..], axial);
            }
            mass.solve(&mut force);
            // ‖M⁻¹K x‖, never above ω²_max (of the elements) and above xᵀK x.
            highest = highest.max(norm(beam, &force));
            x = force;
        }
        let shift = SHIFT * f64::EPSILON * highest;
        let factor = beam.factor(MatrixWeights { mass: shift, damping: 0.0, stiffness: 1.0 })?;
        Ok(Self { beam, shift, factor, mass })
    }

    /// σ, 1/s².
    pub(crate) fn shift(&self) -> f64 {
        self.shift
    }

    /// Start vectors of these numbers: noise with every mode in it, the same for every call.
    pub(crate) fn start(&self, numbers: Range<usize>) -> VectorBlock {
        let mut block = VectorBlock::new(self.beam.dofs());
        for number in numbers {
            block.push(&noise(self.beam, &self.mass, number));
        }
        block
    }

    /// (λ_j + σ) A x_j for every Ritz pair, M-orthogonal to the rigid motions; and how far that is
    /// from x_j in M's norm, less the part along the columns below j: 0 for an eigenpair.
    ///
    /// That part is left out because it carries no news: the Rayleigh–Ritz step has made it vanish
    /// (to second order in the residuals), and what a solve leaves there is ε (λ_j + σ)/(λ_i + σ),
    /// its rounding.
    pub(crate) fn apply(
        &self,
        rigid: &Orthonormal,
        x: &VectorBlock,
        eigenvalues: &[f64],
    ) -> Result<(VectorBlock, Vec<f64>), ModesError> {
        let mut next = VectorBlock::new(self.beam.dofs());
        let mut residuals = Vec::with_capacity(x.columns());
        let x = Orthonormal::new(self.beam, x.clone());
        for (j, (eigenvalue, own)) in eigenvalues.iter().zip(x.vectors.iter()).enumerate() {
            let force: Vec<f64> = x.momenta.column(j).iter().map(|f| f * (eigenvalue + self.shift)).collect();
            let y = self.solve(&force, rigid)?;
            let mut difference: Vec<f64> = y.iter().zip(own).map(|(y, x)| y - x).collect();
            x.remove_first_from(j, &mut difference);
            residuals.push(norm(self.beam, &difference));
            next.push(&y);
        }
        Ok((next, residuals))
    }

    /// f ← (K + σM)⁻¹ f, to the digits of one solve.
    pub(crate) fn solve_once(&self, f: &mut [f64]) {
        self.factor.solve(f);
    }

    /// (K + σM)⁻¹ f, M-orthogonal to `fixed`, with iterative refinement.
    fn solve(&self, f: &[f64], fixed: &Orthonormal) -> Result<Vec<f64>, ModesError> {
        let (mut y, mut residual) = (vec![0.0; f.len()], f.to_vec());
        let mut last = f64::INFINITY;
        for _ in 0..=MAX_REFINEMENTS {
            self.factor.solve(&mut residual);
            fixed.remove_from(&mut residual);
            y.iter_mut().zip(&residual).for_each(|(y, dy)| *y += dy);
            let correction = norm(self.beam, &residual) / norm(self.beam, &y);
            let shrinks = correction < 0.5 * last;
            last = correction;
            if !shrinks || correction <= f64::EPSILON {
                break;
            }
            residual.copy_from_slice(f);
            self.beam.add_stiffness_product(-1.0, &y, &mut residual);
            self.beam.add_mass_product(-self.shift, &y, &mut residual);
        }
        // Also false for NaN.
        if last <= SOLVED { Ok(y) } else { Err(ModesError::Solve { correction: last }) }
    }
}

/// M⁻¹ of a random force of M's diagonal size, by number: the velocities of a beam hit at all dofs
/// at once. What a support holds stays at 0.
fn noise(beam: &Beam, mass: &Factor, number: usize) -> Vec<f64> {
    let mut force: Vec<f64> = (0..beam.dofs())
        .map(|i| {
            let size = beam.mass_of(i).sqrt();
            size * uniform((number * beam.dofs() + i) as u64)
        })
        .collect();
    mass.solve(&mut force);
    force
}

/// Number `index` of a fixed sequence without a pattern, in [−1, 1): SplitMix64 (Steele et al.
/// 2014, doi 10.1145/2714064.2660195).
fn uniform(index: u64) -> f64 {
    let mut z = index.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^= z >> 31;
    (z >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}
