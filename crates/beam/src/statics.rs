//! Static equilibrium, K q = f.

use crate::beam::Beam;
use crate::error::StaticError;
use crate::factor::MatrixWeights;
use crate::spec::Support::{self, Free, Pinned};

/// Steps of iterative refinement at most.
const MAX_REFINEMENTS: usize = 20;

/// A last correction above this, relative to the largest deflection, is no solution: the refinement has not settled.
const SETTLED: f64 = 1e-10;

impl Beam {
    /// Turns a load (N and N m per dof) into the deflection under it: f ← K⁻¹ f.
    ///
    /// One Cholesky solve of K loses about ε n⁴ (`docs/theory.md` §1, *Conditioning*). Iterative refinement, with the
    /// residual by [`Beam::add_stiffness_product`], takes the conditioning out without extended precision: what that
    /// residual gets wrong is a natural deformation of single elements, which moves the beam by rounding only. Measured
    /// against closed forms, worst of all supports: 3e-12, 5e-9, 1e-7 for 20, 100, 300 elements without it, 1e-14 with it;
    /// 2e-14 up to 3000 elements.
    ///
    /// # Errors
    /// [`StaticError::RigidMotion`] where the supports leave one; [`StaticError::Length`] and [`StaticError::Load`] for a
    /// load of another length or not finite; [`StaticError::NotSettled`] for a mesh too fine for double precision (a
    /// cantilever of 10 000 elements). After an error `load` is as it was.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Damping, Section, Support};
    /// # let beam = Beam::new(BeamSpec { span: 2.0, elements: 10, section: Section::new(5.0, 1.0)?,
    /// #     supports: [Support::Pinned; 2], damping: Damping::default() })?;
    /// let mut q = vec![0.0; beam.dofs()];
    /// beam.add_point_load(1.0, -3.0, &mut q)?;
    /// beam.solve_static(&mut q)?;
    /// let exact = -3.0 * 2.0_f64.powi(3) / (48.0 * 5.0); // P L³/(48 EI)
    /// assert!(beam.deflection_at(&q, 1.0).is_some_and(|d| (d.w / exact - 1.0).abs() < 1e-13));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn solve_static(&self, load: &mut [f64]) -> Result<(), StaticError> {
        if let Some(missing) = rigid_motion(self.spec.supports) {
            return Err(StaticError::RigidMotion { supports: self.spec.supports, missing });
        }
        if load.len() != self.dofs() {
            return Err(StaticError::Length { expected: self.dofs(), found: load.len() });
        }
        if let Some((index, &value)) = load.iter().enumerate().find(|(_, value)| !value.is_finite()) {
            return Err(StaticError::Load { index, value });
        }
        let factor = self.factor(MatrixWeights { mass: 0.0, damping: 0.0, stiffness: 1.0 })?;
        let mut residual = load.to_vec();
        let mut q = vec![0.0; load.len()];
        let mut last = f64::INFINITY;
        for _ in 0..=MAX_REFINEMENTS {
            factor.solve(&mut residual);
            let size = self.size(&residual);
            for (q, dq) in q.iter_mut().zip(&residual) {
                *q += dq;
            }
            let correction = if size == 0.0 { 0.0 } else { size / self.size(&q) };
            // Rounding is reached where a correction no longer shrinks (a NaN counts as that).
            if !(correction < 0.5 * last && correction > 0.0) {
                last = correction;
                break;
            }
            last = correction;
            residual.copy_from_slice(load);
            self.add_stiffness_product(-1.0, &q, &mut residual);
        }
        // Also false for NaN.
        if last <= SETTLED {
            load.copy_from_slice(&q);
            Ok(())
        } else {
            Err(StaticError::NotSettled { elements: self.layout.elements, correction: last })
        }
    }

    /// Largest deflection, a slope counted over the span.
    fn size(&self, q: &[f64]) -> f64 {
        let (head, inner, tail) = self.layout.split(q);
        let of = |pair: &[f64; 2]| pair[0].abs().max(self.spec.span * pair[1].abs());
        inner.iter().map(of).fold(of(&head).max(of(&tail)), f64::max)
    }
}

fn rigid_motion(supports: [Support; 2]) -> Option<&'static str> {
    match supports {
        [Free, Free] => Some("both ends are free, the beam can move and turn as a whole; clamp one end or pin both"),
        [Pinned, Free] => Some("the beam can turn about its pinned left end; support the right end or clamp the left"),
        [Free, Pinned] => Some("the beam can turn about its pinned right end; support the left end or clamp the right"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Support::Clamped;
    use crate::beam::tests::beam;

    #[test]
    fn a_rigid_motion_is_refused_with_the_missing_support() {
        for (supports, words) in [([Free, Free], "both"), ([Pinned, Free], "right end"), ([Free, Pinned], "left end")] {
            let beam = beam(4, supports);
            let text = beam.solve_static(&mut vec![1.0; beam.dofs()]).unwrap_err().to_string();
            assert!(text.contains(words) && text.contains("supports = ["), "{text}");
        }
    }

    #[test]
    fn a_bad_load_is_named() {
        let beam = beam(4, [Clamped, Free]);
        assert!(matches!(beam.solve_static(&mut [1.0]), Err(StaticError::Length { expected: 8, found: 1 })));
        let mut load = vec![0.0; 8];
        load[3] = f64::NAN;
        assert!(matches!(beam.solve_static(&mut load), Err(StaticError::Load { index: 3, .. })));
    }

    #[test]
    fn no_load_no_deflection() {
        let beam = beam(4, [Clamped, Free]);
        let mut load = vec![0.0; 8];
        beam.solve_static(&mut load).unwrap();
        assert_eq!(load, [0.0; 8]);
    }
}
