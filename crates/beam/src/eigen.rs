//! Frequencies and mode shapes of the finite-element beam.
//!
//! The lowest pairs of K φ = ω² M φ, undamped, by subspace iteration on the shifted inverse (Bathe
//! & Wilson, "Solution methods for eigenvalue problems in structural mechanics", 1973, doi
//! 10.1002/nme.1620060207):
//!
//! ```text
//! y_j = A x_j,  A = (K + σM)⁻¹M        orthonormalise Y in M        Rayleigh–Ritz: YᵀK Y = U Λ Uᵀ,  X ← Y U
//! ```
//!
//! What double precision would take, and where it is taken back:
//!
//! - **The solves.** σ = 100 ε ω²_max, so that K + σM has a condition number of 1/(100 ε) at the
//!   most, whatever the mesh and whether or not the beam can move rigidly; iterative refinement
//!   with [`Beam::add_stiffness_product`] takes that out again. Up to some hundred elements σ is
//!   far below the first ω².
//! - **The small eigenproblem** spans many decades. Jacobi's method finds all of them to the digits
//!   that they have (Demmel & Veselić 1992, doi 10.1137/0613074); a QR method would leave ε ω²_max
//!   on the lowest.
//! - **The frequencies** are Rayleigh quotients of two sums of squares, [`Beam::elastic_energy`]
//!   and [`Beam::kinetic_energy`]. Their error is the square of the shape's.
//!
//! Rigid motions are known in closed form: they are set apart at the start, and the iteration stays
//! M-orthogonal to them.
//!
//! No mode is missed: below a bound μ between two Ritz values as many eigenvalues are counted as
//! Ritz values lie there, by the negative pivots of LDLᵀ = K − μM (Sylvester's law of inertia).

pub(crate) mod block;
mod inertia;
pub(crate) mod inverse;
mod rigid;

use crate::beam::Beam;
use crate::error::ModesError;
use block::{Orthonormal, VectorBlock, orthonormalised, ritz};
pub(crate) use inertia::unknowns;
use inverse::Inverse;

/// The residual at which a mode is done: shapes to ten digits, frequencies to all that the energies
/// give.
const DONE: f64 = 1e-10;

/// The residual that a mode must have where rounding ends the descent; its square is the
/// frequency's error.
const SETTLED: f64 = 1e-7;

/// Rounds at the most. Each divides the residual of mode i by (ω²_{p+1} + σ)/(ω²_i + σ), p the size
/// of the block: by 2 and more.
const MAX_ROUNDS: usize = 100;

/// Rounds without a new least residual after which rounding is taken to rule.
const PATIENCE: usize = 4;

/// How far apart two Ritz values must be, relative to the upper, for a bound between them.
const CLEAR_GAP: f64 = 1e-3;

/// How often the block may grow: where no bound fits into it, as in a cluster of equal spans, or
/// where a mode is missing.
const MAX_GROWTHS: usize = 3;

/// The lowest modes of a beam, made by [`Beam::modes`]: circular frequencies, ascending, and
/// mass-orthonormal shapes.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    frequencies: Vec<f64>,
    pub(crate) shapes: VectorBlock,
    residuals: Vec<f64>,
    rigid: usize,
    rounds: usize,
}

impl Modes {
    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.frequencies.len()
    }

    /// How many of them are rigid motions; they come first.
    #[must_use]
    pub fn rigid(&self) -> usize {
        self.rigid
    }

    /// Circular frequencies ω, rad/s, ascending; exactly 0 for rigid motions.
    #[must_use]
    pub fn circular_frequencies(&self) -> &[f64] {
        &self.frequencies
    }

    /// Shape number `mode` from 0, of [`Beam::dofs`] entries, 1/√kg (1/(m √kg) for slopes): φᵢᵀM
    /// φⱼ = δᵢⱼ, φᵢᵀK φⱼ = ωᵢ² δᵢⱼ.
    ///
    /// # Panics
    /// If there is no such mode.
    #[must_use]
    pub fn shape(&self, mode: usize) -> &[f64] {
        self.shapes.column(mode)
    }

    /// The relative residual of each mode, ‖(ω² + σ)(K + σM)⁻¹M φ − φ‖ in the norm of M. It bounds
    /// the relative distance of ω² + σ from an eigenvalue; the error of ω² itself is of the order
    /// of its square. 0 for rigid motions.
    #[must_use]
    pub fn residuals(&self) -> &[f64] {
        &self.residuals
    }

    /// Rounds of the subspace iteration that it took.
    #[must_use]
    pub fn rounds(&self) -> usize {
        self.rounds
    }
}

impl Beam {
    /// The first `count` modes of the undamped finite-element beam, rigid motions (ω = 0) included.
    ///
    /// The work is linear in the number of elements and about quadratic in `count`.
    ///
    /// # Errors
    /// [`ModesError`]: for a count that is 0 or more than the beam has, or an iteration that does
    /// not settle.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Section};
    /// # let beam = Beam::new(BeamSpec::new(0.36, 20, Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?))?;
    /// let modes = beam.modes(3)?;
    /// let exact = beam.circular_frequency(1)?; // of the continuous beam
    /// assert!((modes.circular_frequencies()[0] / exact - 1.0).abs() < 1e-6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn modes(&self, count: usize) -> Result<Modes, ModesError> {
        let unknowns = unknowns(self);
        if count == 0 || count > unknowns {
            return Err(ModesError::Count { count, unknowns });
        }
        let inverse = Inverse::new(self)?;
        let unmoved = f64::EPSILON * inverse.shift();
        let mut shapes = rigid::motions(self, unmoved);
        let mut modes = Modes {
            frequencies: vec![0.0; shapes.columns()],
            residuals: vec![0.0; shapes.columns()],
            rigid: shapes.columns(),
            shapes: VectorBlock::new(self.dofs()),
            rounds: 0,
        };
        if count > shapes.columns() {
            let wanted = count - shapes.columns();
            let rigid = Orthonormal::new(self, shapes.clone());
            let search = Search { beam: self, inverse: &inverse, rigid: &rigid, others: unknowns - shapes.columns() };
            let found = search.lowest(wanted)?;
            modes.rounds = found.rounds;
            for (j, eigenvalue) in found.eigenvalues.iter().enumerate().take(wanted) {
                if *eigenvalue < -unmoved {
                    return Err(ModesError::Unstable { eigenvalue: *eigenvalue });
                }
                // A motion without energy that is none of the closed forms: rigid nevertheless.
                let still = *eigenvalue <= unmoved;
                modes.rigid += usize::from(still);
                modes.frequencies.push(if still { 0.0 } else { eigenvalue.sqrt() });
                modes.residuals.push(found.residuals[j]);
                shapes.push(found.vectors.column(j));
            }
        }
        shapes.truncate(count);
        modes.shapes = shapes;
        modes.frequencies.truncate(count);
        modes.residuals.truncate(count);
        modes.rigid = modes.rigid.min(count);
        Ok(modes)
    }
}

/// The search for elastic modes, M-orthogonal to the rigid ones.
struct Search<'a> {
    beam: &'a Beam,
    inverse: &'a Inverse<'a>,
    rigid: &'a Orthonormal,
    /// How many elastic modes the beam has.
    others: usize,
}

/// Ritz pairs, ascending, and the residuals of `vectors`.
struct Found {
    eigenvalues: Vec<f64>,
    vectors: VectorBlock,
    residuals: Vec<f64>,
    rounds: usize,
}

/// What the count of eigenvalues below a bound says of the Ritz values.
enum Verdict {
    Complete,
    /// No two neighbours far enough apart, or not yet.
    NoBound,
    Missing,
}

impl Search<'_> {
    fn lowest(&self, wanted: usize) -> Result<Found, ModesError> {
        let mut size = (wanted + (wanted / 2).max(8)).min(self.others);
        let mut growths = 0;
        let mut x = self.inverse.start(0..size);
        let (mut best, mut stalled) = (f64::INFINITY, 0);
        for rounds in 0..MAX_ROUNDS {
            let (eigenvalues, vectors) = ritz(self.beam, &orthonormalised(self.beam, self.rigid, &x, 0.0));
            let (next, residuals) = self.inverse.apply(self.rigid, &vectors, &eigenvalues)?;
            let worst = residuals[..wanted].iter().copied().fold(0.0, f64::max);
            stalled = if worst < best { 0 } else { stalled + 1 };
            best = best.min(worst);
            let ended = worst <= DONE || (stalled >= PATIENCE && worst <= SETTLED);
            if ended {
                let found = Found { eigenvalues, vectors, residuals, rounds };
                let verdict = self.verdict(&found, wanted);
                if matches!(verdict, Verdict::Complete) {
                    return Ok(found);
                }
                let useless = found.residuals.iter().all(|residual| *residual <= SETTLED);
                if matches!(verdict, Verdict::Missing) || useless {
                    if growths == MAX_GROWTHS {
                        return Err(ModesError::Missed { count: wanted });
                    }
                    growths += 1;
                    let grown = (2 * size).min(self.others);
                    x = next;
                    x.append(&self.inverse.start(size..grown));
                    size = grown;
                    continue;
                }
            }
            x = next;
        }
        Err(ModesError::NotSettled { count: wanted, residual: best })
    }

    /// Counts the eigenvalues below a bound in the widest gap between two Ritz values from number
    /// `wanted` on.
    fn verdict(&self, found: &Found, wanted: usize) -> Verdict {
        let (values, size) = (&found.eigenvalues, found.eigenvalues.len());
        if size == self.others {
            return Verdict::Complete;
        }
        // An eigenvalue lies within the residual of the upper one; so the bound has to keep that
        // far from it.
        let gap = |k: usize| (values[k] - values[k - 1]) / values[k];
        let clear = |k: &usize| gap(*k) >= CLEAR_GAP.max(4.0 * found.residuals[*k]);
        let Some(k) = (wanted..size).filter(clear).max_by(|a, b| gap(*a).total_cmp(&gap(*b))) else {
            return Verdict::NoBound;
        };
        let bound = 0.5 * (values[k - 1] + values[k]);
        // k vectors whose quotients are below the bound prove that there are k such eigenvalues
        // (Courant and Fischer), so a count of fewer is the rounding of the count.
        if inertia::eigenvalues_below(self.beam, bound) <= k + self.rigid.vectors.columns() {
            Verdict::Complete
        } else {
            Verdict::Missing
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beam::tests::{all_supports, beam};

    #[test]
    fn the_count_tells_a_missing_mode() {
        for supports in all_supports() {
            let beam = beam(40, supports);
            let inverse = Inverse::new(&beam).unwrap();
            let rigid = Orthonormal::new(&beam, rigid::motions(&beam, f64::EPSILON * inverse.shift()));
            let others = unknowns(&beam) - rigid.vectors.columns();
            let search = Search { beam: &beam, inverse: &inverse, rigid: &rigid, others };
            let mut found = search.lowest(5).unwrap();
            assert!(matches!(search.verdict(&found, 5), Verdict::Complete));
            found.eigenvalues.remove(2);
            found.residuals.remove(2);
            assert!(matches!(search.verdict(&found, 4), Verdict::Missing), "{supports:?}");
        }
    }
}
