//! Products with H for iterative methods that take many of them, with the blocks of a row
//! contiguous in memory.

use teeter_contact::{BlockSparse, ContactProblem, Delassus, Vector, de_saxce, project};

/// A friction coefficient above this means that a contact doesn't slide.
pub(crate) const VERY_LARGE_FRICTION: f64 = 100.0;

/// The source of a problem's products.
#[derive(Clone, Copy)]
pub(crate) enum Operator<'a, const D: usize> {
    /// Nonzero blocks: the problem's own, or gathered from a dense matrix.
    Blocks(&'a BlockSparse<D>),
    /// A matrix-free operator, which isn't formed here either.
    Product(&'a ContactProblem<'a, D>),
}

impl<'a, const D: usize> Operator<'a, D> {
    /// The fastest form of `problem`'s operator; a dense one is gathered into `memory`.
    pub(crate) fn new(problem: &'a ContactProblem<'a, D>, memory: &'a mut BlockSparse<D>) -> Self {
        match problem.delassus() {
            Delassus::Blocks(h) => Self::Blocks(h),
            Delassus::Dense(_) => {
                memory.gather(problem);
                Self::Blocks(memory)
            }
            _ => Self::Product(problem),
        }
    }

    /// The velocity `Σ_j H_ij p_j + q_i` at contact `i`.
    #[inline]
    pub(crate) fn velocity(&self, i: usize, q: &[Vector<D>], p: &[Vector<D>]) -> Vector<D> {
        match self {
            Self::Blocks(h) => row_product(h, i, &q[i], p),
            Self::Product(problem) => problem.velocity(i, p),
        }
    }

    /// The velocities at all contacts.
    pub(crate) fn velocities(&self, q: &[Vector<D>], p: &[Vector<D>], u: &mut [Vector<D>]) {
        match self {
            Self::Blocks(h) => row_products(h, q, p, u),
            Self::Product(problem) => {
                for (i, u) in u.iter_mut().enumerate() {
                    *u = problem.velocity(i, p);
                }
            }
        }
    }
}

/// `start + Σ_j H_ij p_j`, with separate sums for the columns of the blocks, which are independent.
#[inline]
pub(crate) fn row_product<const D: usize>(
    h: &BlockSparse<D>,
    i: usize,
    start: &Vector<D>,
    p: &[Vector<D>],
) -> Vector<D> {
    let range = h.range(i);
    let mut sums = [[0.0; D]; D];
    for (block, &j) in h.blocks()[range.clone()].iter().zip(&h.columns()[range]) {
        let (columns, x) = (&block.data.0, &p[j].data.0[0]);
        for c in 0..D {
            for r in 0..D {
                sums[c][r] += columns[c][r] * x[c];
            }
        }
    }
    Vector::from_fn(|r, _| (0..D).fold(start[r], |total, c| total + sums[c][r]))
}

/// `u_i = start_i + Σ_j H_ij p_j` for all rows, with the sums of [`row_product`]. Contacts of the same two bodies are mostly
/// neighbours and their rows have the same columns: two such rows at once read p and the columns once, and have
/// twice as many independent sums.
fn row_products<const D: usize>(h: &BlockSparse<D>, start: &[Vector<D>], p: &[Vector<D>], u: &mut [Vector<D>]) {
    let mut i = 0;
    while i < u.len() {
        let (first, second) = (h.range(i), if i + 1 < u.len() { h.range(i + 1) } else { 0..0 });
        let columns = &h.columns()[first.clone()];
        if *columns != h.columns()[second.clone()] {
            u[i] = row_product(h, i, &start[i], p);
            i += 1;
            continue;
        }
        let mut sums = [[[0.0; D]; D]; 2];
        let blocks = h.blocks()[first].iter().zip(&h.blocks()[second]);
        for ((one, two), &j) in blocks.zip(columns) {
            let x = &p[j].data.0[0];
            for c in 0..D {
                for r in 0..D {
                    sums[0][c][r] += one.data.0[c][r] * x[c];
                    sums[1][c][r] += two.data.0[c][r] * x[c];
                }
            }
        }
        for (sums, i) in sums.iter().zip([i, i + 1]) {
            u[i] = Vector::from_fn(|r, _| (0..D).fold(start[i][r], |total, c| total + sums[c][r]));
        }
        i += 2;
    }
}

/// The step of contact `i` in isolation: the inverse of the mean of its block's diagonal, 1/m.
#[inline]
pub(crate) fn own_step<const D: usize>(problem: &ContactProblem<'_, D>, i: usize) -> f64 {
    let block = problem.diagonal(i);
    let (normal, trace) = (block[(0, 0)], block.trace());
    // The problem guarantees only a positive normal compliance.
    if trace > normal { D as f64 / trace } else { normal.recip() }
}

/// One step of the natural map with separate normal and tangential laws (Alart and Curnier 1991):
/// the normal impulse is projected onto the half line, then the tangential one onto the disk of
/// radius μ times the normal one. The fixed points are those of the map with De Saxcé's shift, but
/// the slope doesn't grow with μ.
#[inline]
pub(crate) fn onto_disk<const D: usize>(x: &Vector<D>, mu: f64) -> Vector<D> {
    // Keeps a NaN.
    if x[0] <= 0.0 {
        return Vector::zeros();
    }
    let mut p = *x;
    let limit = mu * p[0];
    if D == 2 {
        p[1] = if x[1].abs() > limit { limit.copysign(x[1]) } else { x[1] };
        return p;
    }
    let squares = (1..D).fold(0.0, |sum, k| sum + x[k] * x[k]);
    if squares > limit * limit {
        let scale = limit / squares.sqrt();
        for k in 1..D {
            p[k] *= scale;
        }
    }
    p
}

/// The numerator of the residual, for known velocities.
pub(crate) fn natural_map<const D: usize>(p: &[Vector<D>], u: &[Vector<D>], mu: &[f64], rho: f64) -> f64 {
    let map = |i: usize| p[i] - project(&(p[i] - de_saxce(&u[i], mu[i]) * rho), mu[i]);
    (0..p.len()).map(|i| map(i).norm_squared()).sum::<f64>().sqrt()
}

/// As [`natural_map`], with separate normal and tangential laws: without a shift, so that a large μ
/// doesn't amplify the rounding of `u_T`.
pub(crate) fn disk_map<const D: usize>(p: &[Vector<D>], u: &[Vector<D>], mu: &[f64], rho: f64) -> f64 {
    let map = |i: usize| p[i] - onto_disk(&(p[i] - u[i] * rho), mu[i]);
    (0..p.len()).map(|i| map(i).norm_squared()).sum::<f64>().sqrt()
}

/// Whether some μ is so large that the residual, which contains μ‖u_T‖, can be at rounding. Then a
/// method computes the judge's residual as soon as [`disk_map`] is small.
pub(crate) fn has_very_large_friction(mu: &[f64]) -> bool {
    mu.iter().any(|mu| *mu > VERY_LARGE_FRICTION)
}

/// De Saxcé's shift μ‖u_T‖, but 0 for a sticking contact with a very large μ: it vanishes at the
/// solution, and until then μ would amplify a small slip. (For an ordinary μ this jump would let
/// the fixed point cycle.)
pub(crate) fn slip_shift<const D: usize>(p: &Vector<D>, u: &Vector<D>, mu: f64) -> f64 {
    let tangential = |x: &Vector<D>| x.iter().skip(1).fold(0.0, |s: f64, c| s.hypot(*c));
    if mu > VERY_LARGE_FRICTION && tangential(p) < (1.0 - 1e-9) * mu * p[0] { 0.0 } else { mu * tangential(u) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Vector2, Vector3};

    #[test]
    fn row_products_match_the_problem() {
        let blocks: Vec<_> =
            (0..4).map(|k| Matrix3::from_fn(|r, c| f64::from(k) + r as f64 - 2.0 * c as f64)).collect();
        let h: Vec<_> = blocks.iter().map(|b| b + Matrix3::identity() * 9.0).collect();
        let q = [Vector3::new(0.1, 0.2, 0.3), Vector3::new(-0.3, 0.4, 0.5)];
        let p = [Vector3::new(1.0, 2.0, 3.0), Vector3::new(3.0, -4.0, 0.5)];
        let problem = ContactProblem::new(Delassus::Dense(&h), &q, &[0.1, 0.1]).unwrap();
        let mut memory = BlockSparse::default();
        let operator = Operator::new(&problem, &mut memory);
        for i in 0..2 {
            assert!((operator.velocity(i, &q, &p) - problem.velocity(i, &p)).norm() < 1e-13);
        }
    }

    #[test]
    fn the_disk_scales_with_the_normal_impulse() {
        assert_eq!(onto_disk(&Vector2::new(2.0, -3.0), 0.5), Vector2::new(2.0, -1.0));
        assert_eq!(onto_disk(&Vector2::new(-2.0, -3.0), 0.5).norm(), 0.0);
        assert_eq!(onto_disk(&Vector3::new(2.0, 0.6, 0.8), 0.5), Vector3::new(2.0, 0.6, 0.8));
        assert!((onto_disk(&Vector3::new(1.0, 6.0, 8.0), 0.5) - Vector3::new(1.0, 0.3, 0.4)).norm() < 1e-15);
        assert!(onto_disk(&Vector3::new(f64::NAN, 6.0, 8.0), 0.5)[0].is_nan());
    }
}
