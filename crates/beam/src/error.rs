//! What can be wrong with a beam, a factorisation, a static solve.

use crate::beam::Dof;
use crate::factor::{Backend, MatrixWeights};
use crate::statics::RigidMotion;
use crate::support::Support;

/// A value that a beam cannot be built from, or cannot be asked.
///
/// Every variant names the offending field, its value and the rule that it breaks.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BeamError {
    /// A real number out of its range, or not finite.
    #[error("{field} = {value}: must be {rule}")]
    Value {
        /// The field or argument, e.g. `section.bending_stiffness`.
        field: &'static str,
        /// The value found there.
        value: f64,
        /// What it must be, e.g. "finite and > 0".
        rule: &'static str,
    },
    /// A whole number out of its range.
    #[error("{field} = {value}: must be {rule}")]
    Count {
        /// The field or argument.
        field: &'static str,
        /// The value found there.
        value: usize,
        /// What it must be.
        rule: &'static str,
    },
    /// A number that the section doesn't have and the beam needs.
    #[error("{field}: missing, but needed {reason}")]
    Missing {
        /// The field, e.g. `section.axial_stiffness`.
        field: &'static str,
        /// Where it is needed.
        reason: &'static str,
    },
    /// A slice of the wrong length.
    #[error("{field}: has {found} entries, must have {expected}")]
    Length {
        /// The argument.
        field: &'static str,
        /// The length it must have.
        expected: usize,
        /// The length it has.
        found: usize,
    },
    /// A nodal shape that moves where the support holds it.
    #[error("nodal[{node}][{}] = {value}: must be 0, the support there is {support}", dof.component())]
    BrokenSupport {
        /// The node.
        node: usize,
        /// Which of its two values.
        dof: Dof,
        /// The value found there, m or rad.
        value: f64,
        /// The support there.
        support: Support,
    },
    /// A beam whose frequencies no simple equation gives.
    #[error(
        "the frequency equations are for a uniform Euler-Bernoulli beam between free, pinned, clamped or guided ends and nothing else on it; take the modes of the finite elements"
    )]
    NoFrequencyEquation,
    /// A position that is not on the beam.
    #[error("x = {x}: must be on the beam, in [0, {span}]")]
    OutsideSpan {
        /// The position, m.
        x: f64,
        /// The beam's span, m.
        span: f64,
    },
}

/// Why `mass M + damping C + stiffness K` has no Cholesky factor.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CholeskyError {
    /// A weight that is not finite.
    #[error("weights.{field} = {value}: must be finite")]
    Weight {
        /// `mass`, `damping` or `stiffness`.
        field: &'static str,
        /// The value found there.
        value: f64,
    },
    /// The weighted sum is not positive definite, at least not to rounding.
    #[error("{weights} is not positive definite, or not in double precision (found at dof {dof})")]
    NotPositiveDefinite {
        /// The weights asked for.
        weights: MatrixWeights,
        /// The degree of freedom at which the elimination, from both ends to the middle, stopped.
        dof: usize,
    },
    /// A backend that is not in this build.
    #[error("the backend {backend:?} is not in this build: it needs the feature `{feature}` of teeter-beam")]
    MissingFeature {
        /// The backend asked for.
        backend: Backend,
        /// The feature of this crate that brings it.
        feature: &'static str,
    },
    /// Too little memory for the analysis of the pattern.
    #[error("too little memory to analyse the pattern of the matrices")]
    Memory,
    /// The factor to be renewed is one of a beam whose matrices have another pattern.
    #[error(
        "the factor is one of another beam ({found} dofs, this beam has {expected}): make it with this beam's `factor`"
    )]
    OtherBeam {
        /// Degrees of freedom of this beam.
        expected: usize,
        /// Degrees of freedom of the factor.
        found: usize,
    },
}

/// Why a static load has no deflection.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StaticError {
    /// The supports leave a rigid motion, so no static equilibrium is unique.
    #[error("supports = [{}, {}]: {motion}", supports[0], supports[1])]
    RigidMotion {
        /// The supports of the left and the right end.
        supports: Box<[Support; 2]>,
        /// The motion that is left.
        motion: RigidMotion,
    },
    /// A compressive axial force at or beyond the buckling load.
    #[error(
        "axial_force = {axial_force}: the beam buckles under it (the stiffness is not positive definite); a smaller compression or more supports would hold it"
    )]
    Buckled {
        /// The given axial force, N.
        axial_force: f64,
    },
    /// The load vector has the wrong length.
    #[error("load: has {found} entries, must have {expected}")]
    Length {
        /// Degrees of freedom of the beam.
        expected: usize,
        /// The length found.
        found: usize,
    },
    /// A load that is not finite.
    #[error("load[{index}] = {value}: must be finite")]
    Load {
        /// The entry.
        index: usize,
        /// Its value, N or N m.
        value: f64,
    },
    /// The iterative refinement did not settle: the mesh is too fine for double precision.
    #[error(
        "elements = {elements}: the static solve does not settle in double precision (last correction {correction:e} of the deflection); take a coarser mesh"
    )]
    NotSettled {
        /// Elements of the mesh.
        elements: usize,
        /// The last correction, relative to the solution.
        correction: f64,
    },
    /// Held by springs or foundations alone, and these leave the solve no digits: rounding of the
    /// beam's own stiffness hides them.
    #[error(
        "the springs or foundations that hold the beam are too soft beside its own stiffness for double precision; take stiffer ones, a support, or a coarser mesh"
    )]
    Soft,
    /// The stiffness matrix could not be factorised.
    #[error("stiffness matrix: {0}")]
    Factor(#[from] CholeskyError),
}

/// Why a beam's modes were not found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ModesError {
    /// Fewer than one mode, or more than there are.
    #[error("count = {count}: must be 1 to {unknowns}, the beam's degrees of freedom")]
    Count {
        /// The number asked for.
        count: usize,
        /// The beam's modes.
        unknowns: usize,
    },
    /// The iteration did not settle.
    #[error(
        "count = {count}: the subspace iteration does not settle (relative residual {residual:e}); ask for fewer modes or take a coarser mesh, and under compression see whether the beam bears it"
    )]
    NotSettled {
        /// The elastic modes sought.
        count: usize,
        /// The least residual reached, of the worst of them.
        residual: f64,
    },
    /// The axial force is beyond the buckling load.
    #[error("axial_force: the straight beam is not stable under it (ω² = {eigenvalue:e} 1/s²), so it does not vibrate")]
    Unstable {
        /// The lowest ω², 1/s².
        eigenvalue: f64,
    },
    /// The count of eigenvalues says that more lie below than the iteration finds.
    #[error("count = {count}: a mode below these is missing and can't be found; take a coarser mesh")]
    Missed {
        /// The elastic modes sought.
        count: usize,
    },
    /// A solve with K + σM lost all digits: the mesh is too fine for double precision.
    #[error(
        "the shifted stiffness can't be solved for in double precision (last correction {correction:e}); take a coarser mesh"
    )]
    Solve {
        /// The last correction, relative to the solution.
        correction: f64,
    },
    /// A matrix could not be factorised.
    #[error("K + σM: {0}")]
    Factor(#[from] CholeskyError),
}

/// Why a beam has no such modal basis.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ModalError {
    /// Its modes were not found.
    #[error(transparent)]
    Modes(#[from] ModesError),
    /// Weights whose sum has no inverse.
    #[error(transparent)]
    Factor(#[from] CholeskyError),
    /// A contact region that is not on the beam.
    #[error("contact region [{from}, {to}] m: must be from left to right on the beam, in [0, {span}]")]
    Region {
        /// Its left end, m.
        from: f64,
        /// Its right end, m.
        to: f64,
        /// The beam's span, m.
        span: f64,
    },
    /// A point that is not on the beam.
    #[error("point of a static correction x = {x}: must be on the beam, in [0, {span}]")]
    Point {
        /// The position, m.
        x: f64,
        /// The beam's span, m.
        span: f64,
    },
    /// A tolerance that the flexibilities have no digits for.
    #[error("tolerance = {tolerance}: must be at least 1e-8 and less than 1")]
    Tolerance {
        /// The value found.
        tolerance: f64,
    },
    /// A static correction did not settle: the mesh is too fine for double precision.
    #[error(
        "the static correction for x = {x} does not settle in double precision (last change {last:e}); take a coarser mesh"
    )]
    Correction {
        /// The point, m.
        x: f64,
        /// The last change, relative to the correction.
        last: f64,
    },
    /// A beam held along its axis, whose elastic force is not linear.
    #[error(
        "a beam held along its axis stretches as it deflects, which no mode does: use its elements, or axial = free"
    )]
    Stretched,
    /// The damping couples the modes.
    #[error(
        "damping: C couples the modal coordinates {first} and {second} ({relative:e} of their own damping); give damping ratios of the modes, or use viscous damping in proportion to the mass, or Rayleigh damping"
    )]
    CoupledDamping {
        /// One coordinate.
        first: usize,
        /// The other.
        second: usize,
        /// The entry of ΦᵀC Φ, relative to the geometric mean of the two on the diagonal.
        relative: f64,
    },
    /// Damping ratios for another number of coordinates, or one that is none.
    #[error("damping ratios: {reason}")]
    Ratios {
        /// What is wrong, and what would be right.
        reason: String,
    },
}

/// `Ok` for a finite number that satisfies `rule`, else the error that names it.
pub(crate) fn check(field: &'static str, value: f64, holds: bool, rule: &'static str) -> Result<(), BeamError> {
    if value.is_finite() && holds { Ok(()) } else { Err(BeamError::Value { field, value, rule }) }
}

/// `Ok` where a slice has one entry per degree of freedom.
pub(crate) fn check_len(field: &'static str, expected: usize, found: usize) -> Result<(), BeamError> {
    if found == expected { Ok(()) } else { Err(BeamError::Length { field, expected, found }) }
}
