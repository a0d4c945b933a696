//! Static equilibrium, K q = f.

use std::fmt;

use crate::beam::Beam;
use crate::error::{CholeskyError, StaticError};
use crate::factor::{Factor, MatrixWeights};
use crate::membrane::Membrane;

/// Steps of iterative refinement at most.
const MAX_REFINEMENTS: usize = 20;

/// A last correction above this, relative to the largest deflection, is no solution: the refinement
/// has not settled.
const SETTLED: f64 = 1e-10;

/// Rounds at most for the axial force of a beam held along its axis; bisection every third one
/// makes 53 digits of them.
const MAX_ROUNDS: usize = 200;

/// The axial force is found where it changes, or is out of balance, by no more than this part.
const ROUNDED: f64 = 4.0 * f64::EPSILON;

/// What [`Beam::refine`] finds.
pub(crate) struct Refined {
    /// The first solution, before any refinement.
    pub(crate) plain: Vec<f64>,
    pub(crate) solution: Vec<f64>,
    /// The last correction, relative to the solution.
    pub(crate) correction: f64,
}

impl Beam {
    /// Turns a load (N and N m per dof) into the deflection under it: f ← K⁻¹ f.
    ///
    /// One Cholesky solve of K on n elements loses about ε n⁴, its condition number. Iterative
    /// refinement, with the residual by [`Beam::add_stiffness_product`], takes the conditioning out
    /// without extended precision: what that residual gets wrong is a natural deformation of single
    /// elements, which moves the beam by rounding only. Measured against closed forms, worst of all
    /// supports: 3e-12, 5e-9, 1e-7 for 20, 100, 300 elements without it, 1e-14 with it; 2e-14 up to
    /// 3000 elements.
    ///
    /// # Errors
    /// [`StaticError::RigidMotion`] where the supports leave one; [`StaticError::Length`] and
    /// [`StaticError::Load`] for a load of another length or not finite; [`StaticError::Buckled`]
    /// under too much compression; [`StaticError::NotSettled`] for a mesh too fine for double
    /// precision (a cantilever of 10 000 elements), [`StaticError::Soft`] for springs too soft for
    /// it. After an error `load` is as it was.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Section};
    /// # let beam = Beam::new(BeamSpec::new(2.0, 10, Section::new(5.0, 1.0)?))?;
    /// let mut q = vec![0.0; beam.dofs()];
    /// beam.add_point_load(1.0, -3.0, &mut q)?;
    /// beam.solve_static(&mut q)?;
    /// let exact = -3.0 * 2.0_f64.powi(3) / (48.0 * 5.0); // P L³/(48 EI)
    /// assert!(beam.deflection_at(&q, 1.0).is_some_and(|d| (d.w / exact - 1.0).abs() < 1e-13));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn solve_static(&self, load: &mut [f64]) -> Result<(), StaticError> {
        if let Some(motion) = self.rigid_motion() {
            return Err(StaticError::RigidMotion { supports: Box::new(self.spec.supports), motion });
        }
        if load.len() != self.dofs() {
            return Err(StaticError::Length { expected: self.dofs(), found: load.len() });
        }
        if let Some((index, &value)) = load.iter().enumerate().find(|(_, value)| !value.is_finite()) {
            return Err(StaticError::Load { index, value });
        }
        let q = match &self.membrane {
            Some(membrane) => self.solve_stretched(membrane, load)?,
            None => self.solve_refined(load, 0.0)?,
        };
        load.copy_from_slice(&q);
        Ok(())
    }

    /// (K + N G)⁻¹ f, N an axial force beside that of the beam, by refinement to rounding.
    fn solve_refined(&self, load: &[f64], n: f64) -> Result<Vec<f64>, StaticError> {
        let slopes = self.membrane.as_ref();
        let factor = self.factor_under(MatrixWeights::STIFFNESS, n).map_err(|error| match error {
            CholeskyError::NotPositiveDefinite { .. } if self.spec.axial_force < 0.0 => {
                StaticError::Buckled { axial_force: self.spec.axial_force }
            }
            CholeskyError::NotPositiveDefinite { .. } if self.is_held_by_springs() => StaticError::Soft,
            other => StaticError::Factor(other),
        })?;
        let refined = self.refine(&factor, load, |q, residual| {
            self.add_stiffness_product(-1.0, q, residual);
            if let (Some(membrane), true) = (slopes, n != 0.0) {
                membrane.slopes.add_product(-n, self.bend(q), self.split_mut(residual).0);
            }
        });
        // Also false for NaN.
        if refined.correction <= SETTLED {
            Ok(refined.solution)
        } else if self.is_held_by_springs() {
            Err(StaticError::Soft)
        } else {
            Err(StaticError::NotSettled { elements: self.elements(), correction: refined.correction })
        }
    }

    /// Solves A x = f by a factor of A, with iterative refinement until corrections no longer
    /// shrink; `take_off` takes A x off a residual.
    pub(crate) fn refine(&self, factor: &Factor, f: &[f64], take_off: impl Fn(&[f64], &mut [f64])) -> Refined {
        let mut residual = f.to_vec();
        let mut solution = vec![0.0; f.len()];
        let mut plain = Vec::new();
        let mut correction = f64::INFINITY;
        for _ in 0..=MAX_REFINEMENTS {
            factor.solve(&mut residual);
            let size = self.size(&residual);
            for (x, dx) in solution.iter_mut().zip(&residual) {
                *x += dx;
            }
            if plain.is_empty() {
                plain.clone_from(&solution);
            }
            let last = correction;
            correction = if size == 0.0 { 0.0 } else { size / self.size(&solution) };
            // Rounding is reached where a correction no longer shrinks (a NaN counts as that).
            if !(correction < 0.5 * last && correction > 0.0) {
                break;
            }
            residual.copy_from_slice(f);
            take_off(&solution, &mut residual);
        }
        Refined { plain, solution, correction }
    }

    /// The deflection whose stretching makes the axial force that it is in equilibrium with. That
    /// force is the root of r(N) = EA/(2L) s(q(N)) − N, q(N) = (K + N G)⁻¹ f, which falls with N:
    /// one root, between 0 and r(0).
    fn solve_stretched(&self, membrane: &Membrane, load: &[f64]) -> Result<Vec<f64>, StaticError> {
        let mut q = self.solve_refined(load, 0.0)?;
        let (mut low, mut high) = (0.0, membrane.force(self.bend(&q)));
        let (mut at_low, mut at_high) = (high, f64::NEG_INFINITY);
        // By secants between the ends of a bracket.
        let mut n = 0.0;
        let mut correction = f64::INFINITY;
        for round in 0..MAX_ROUNDS {
            let secant = if at_high.is_finite() { low + (high - low) * at_low / (at_low - at_high) } else { high };
            // Every third round halves the bracket, so that a bad secant can't hold on.
            let next = if round % 3 == 2 || !(secant > low && secant < high) { 0.5 * (low + high) } else { secant };
            correction = (next - n).abs() / next;
            n = next;
            q = self.solve_refined(load, n)?;
            let residual = membrane.force(self.bend(&q)) - n;
            if correction <= ROUNDED || residual.abs() <= ROUNDED * n {
                return Ok(q);
            }
            if residual > 0.0 {
                (low, at_low) = (n, residual);
            } else {
                (high, at_high) = (n, residual);
            }
        }
        if correction <= SETTLED {
            Ok(q)
        } else {
            Err(StaticError::NotSettled { elements: self.elements(), correction })
        }
    }

    /// Largest deflection, a rotation counted over the span; axial dofs as they are.
    pub(crate) fn size(&self, q: &[f64]) -> f64 {
        let of = |pair: &[f64; 2]| pair[0].abs().max(self.spec.span * pair[1].abs());
        let bend = self.bend(q).iter().map(of).fold(0.0, f64::max);
        q[2 * self.nodes()..].iter().fold(bend, |size, u| size.max(u.abs()))
    }

    /// Whether springs or foundations take a rigid motion that supports alone would leave.
    fn is_held_by_springs(&self) -> bool {
        let places = self.held.iter().filter(|held| held[0]).count();
        let turned = self.held.iter().any(|held| held[1]);
        !(places >= 2 || places == 1 && turned)
    }

    /// The rigid motion that supports, springs and foundations leave, if they do: then there is no
    /// static equilibrium.
    pub fn rigid_motion(&self) -> Option<RigidMotion> {
        let mut places: Vec<f64> = Vec::new();
        let mut turned = false;
        let supports = self.mesh.x.iter().zip(&self.held);
        for (x, held) in supports {
            places.extend(held[0].then_some(*x));
            turned |= held[1];
        }
        for (dof, _) in &self.springs {
            if dof % 2 == 0 {
                places.push(self.mesh.x[dof / 2]);
            }
            turned |= dof % 2 == 1;
        }
        if self.foundation.is_some() {
            places.extend([0.0, self.spec.span]);
        }
        if self.bar.as_ref().is_some_and(|bar| !bar.held.iter().any(|held| *held)) {
            return Some(RigidMotion::AlongAxis);
        }
        let two = places.iter().any(|x| (x - places[0]).abs() > 0.0);
        match (places.is_empty(), two || turned) {
            (false, true) => None,
            (true, true) => Some(RigidMotion::AcrossAxis),
            (true, false) => Some(RigidMotion::Any),
            (false, false) if places[0] == 0.0 => Some(RigidMotion::AboutLeftEnd),
            (false, false) if places[0] == self.spec.span => Some(RigidMotion::AboutRightEnd),
            (false, false) => Some(RigidMotion::AboutSupport),
        }
    }
}

/// A rigid motion that nothing takes, from [`Beam::rigid_motion`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum RigidMotion {
    /// Along the axis: the beam has axial dofs, and neither end is held.
    AlongAxis,
    /// Up and down as a whole.
    AcrossAxis,
    /// Up and down, and turning.
    Any,
    /// Turning about the left end.
    AboutLeftEnd,
    /// Turning about the right end.
    AboutRightEnd,
    /// Turning about the one support between the ends.
    AboutSupport,
}

impl RigidMotion {
    /// What can move, as a clause.
    #[must_use]
    pub fn description(self) -> &'static str {
        match self {
            Self::AlongAxis => "neither end is held along the axis, along which the beam can move as a whole",
            Self::AcrossAxis => "nothing holds the beam across its axis, it can move up and down as a whole",
            Self::Any => "both ends are free, the beam can move and turn as a whole",
            Self::AboutLeftEnd => "the beam can turn about its pinned left end",
            Self::AboutRightEnd => "the beam can turn about its pinned right end",
            Self::AboutSupport => "the beam can turn about its one support",
        }
    }

    /// What would hold it, as an imperative.
    #[must_use]
    pub fn remedy(self) -> &'static str {
        match self {
            Self::AlongAxis => "hold one",
            Self::AcrossAxis => "pin it somewhere",
            Self::Any => "clamp one end or pin both",
            Self::AboutLeftEnd => "support the right end or clamp the left",
            Self::AboutRightEnd => "support the left end or clamp the right",
            Self::AboutSupport => "support it elsewhere or clamp it",
        }
    }
}

/// Description and remedy.
impl fmt::Display for RigidMotion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; {}", self.description(), self.remedy())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Support::{Clamped, Free, Pinned};
    use crate::beam::tests::beam;

    #[test]
    fn a_rigid_motion_is_refused_with_the_missing_support() {
        let on_one = Beam::new(crate::beam::tests::spec(4, [Free, Free]).support_at(0.5, Pinned)).unwrap();
        assert_eq!(on_one.rigid_motion(), Some(RigidMotion::AboutSupport));
        for (supports, words) in [([Free, Free], "both"), ([Pinned, Free], "right end"), ([Free, Pinned], "left end")] {
            let beam = beam(4, supports);
            let text = beam.solve_static(&mut vec![1.0; beam.dofs()]).unwrap_err().to_string();
            assert!(text.contains(words) && text.contains("supports = ["), "{text}");
        }
    }

    #[test]
    fn a_bad_load_is_named() {
        let beam = beam(4, [Clamped, Free]);
        assert!(matches!(beam.solve_static(&mut [1.0]), Err(StaticError::Length { expected: 10, found: 1 })));
        let mut load = vec![0.0; 10];
        load[3] = f64::NAN;
        assert!(matches!(beam.solve_static(&mut load), Err(StaticError::Load { index: 3, .. })));
    }

    #[test]
    fn no_load_no_deflection() {
        let beam = beam(4, [Clamped, Free]);
        let mut load = vec![0.0; 10];
        beam.solve_static(&mut load).unwrap();
        assert_eq!(load, [0.0; 10]);
    }
}
