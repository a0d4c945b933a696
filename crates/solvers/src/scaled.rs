//! A scaled copy of a contact problem, for solvers that need a copy of H.
//!
//! With ρ = 1/mean(diag H) the problem (ρH, ρq, μ) has the same impulses, and its velocities have
//! the unit of impulses. Dimensionless parameters (a regularisation, a step) are then independent
//! of the system of units, and the natural map of the residual is `p − Π(p − û)`.

use crate::memory::reserve;
use teeter_contact::{BlockSparse, ContactProblem, Vector, de_saxce, project};

/// The scaled problem; its memory is reused.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scaled<const D: usize> {
    pub(crate) h: BlockSparse<D>,
    pub(crate) q: Vec<Vector<D>>,
    pub(crate) mu: Vec<f64>,
    q_norm: f64,
}

impl<const D: usize> Scaled<D> {
    pub(crate) fn reserve(&mut self, contacts: usize, blocks: usize) {
        self.h.reserve(contacts, blocks);
        reserve(&mut self.q, contacts);
        reserve(&mut self.mu, contacts);
    }

    /// Copies the problem, scaled.
    pub(crate) fn load(&mut self, problem: &ContactProblem<'_, D>) {
        let rho = problem.scale();
        self.h.gather(problem);
        self.h.scale(rho);
        self.q.clear();
        self.q.extend(problem.q().iter().map(|q| q * rho));
        self.mu.clear();
        self.mu.extend_from_slice(problem.mu());
        self.q_norm = norm(&self.q);
    }

    pub(crate) fn contacts(&self) -> usize {
        self.q.len()
    }

    /// The typical magnitude of one contact's impulse: `max(‖p‖, ‖q‖)/√n`.
    pub(crate) fn size(&self, p: &[Vector<D>]) -> f64 {
        norm(p).max(self.q_norm).max(1e-300) / (p.len().max(1) as f64).sqrt()
    }

    /// `u = H p + q`.
    pub(crate) fn velocities(&self, p: &[Vector<D>], u: &mut [Vector<D>]) {
        for i in 0..p.len() {
            u[i] = self.h.row_product(i, p) + self.q[i];
        }
    }

    /// `H p`.
    pub(crate) fn product(&self, p: &[Vector<D>], out: &mut [Vector<D>]) {
        for i in 0..p.len() {
            out[i] = self.h.row_product(i, p);
        }
    }

    /// The global residual for known velocities.
    pub(crate) fn residual(&self, p: &[Vector<D>], u: &[Vector<D>]) -> f64 {
        self.residual_of(p.iter().copied().zip(u.iter().copied()))
    }

    /// The residual of `p + s δp` with velocities `u + s δu`.
    pub(crate) fn residual_after(
        &self,
        p: &[Vector<D>],
        u: &[Vector<D>],
        step: f64,
        change: &[Vector<D>],
        change_u: &[Vector<D>],
    ) -> f64 {
        self.residual_of((0..p.len()).map(|i| (p[i] + change[i] * step, u[i] + change_u[i] * step)))
    }

    #[inline]
    fn residual_of(&self, points: impl Iterator<Item = (Vector<D>, Vector<D>)>) -> f64 {
        let (mut map, mut size) = (0.0, 0.0);
        for ((p, u), &mu) in points.zip(&self.mu) {
            map += (p - project(&(p - de_saxce(&u, mu)), mu)).norm_squared();
            size += p.norm_squared();
        }
        map.sqrt() / size.sqrt().max(self.q_norm).max(1e-300)
    }
}

/// The Euclidean norm over all contacts.
pub(crate) fn norm<const D: usize>(x: &[Vector<D>]) -> f64 {
    x.iter().map(Vector::norm_squared).sum::<f64>().sqrt()
}

/// Replaces initial impulses that are NaN or too large to be squared by zero.
pub(crate) fn make_finite<const D: usize>(p: &mut [Vector<D>]) {
    for x in p {
        if !(x.norm_squared() < 1e300) {
            *x = Vector::zeros();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_contact::conformance::plane_cases;
    use teeter_contact::judge;

    #[test]
    fn the_scaled_residual_matches_the_judge() {
        for case in plane_cases() {
            let problem = case.problem().unwrap();
            let p: Vec<_> = (0..case.q.len()).map(|i| Vector::<2>::new(1.0 + i as f64, 0.3)).collect();
            let mut scaled = Scaled::default();
            scaled.load(&problem);
            let mut u = p.clone();
            scaled.velocities(&p, &mut u);
            let (own, judged) = (scaled.residual(&p, &u), judge(&problem, &p).global);
            assert!((own - judged).abs() <= 1e-13 * judged, "{}: {own:e} {judged:e}", case.name);
        }
    }
}
