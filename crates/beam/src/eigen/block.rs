//! A block of vectors: orthonormalisation in M, and the Rayleigh–Ritz step.

use crate::beam::Beam;

/// Vectors of a beam, one after another.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct VectorBlock {
    dofs: usize,
    entries: Vec<f64>,
}

impl VectorBlock {
    pub(crate) fn new(dofs: usize) -> Self {
        Self { dofs, entries: Vec::new() }
    }

    pub(crate) fn columns(&self) -> usize {
        self.entries.len() / self.dofs
    }

    pub(crate) fn column(&self, j: usize) -> &[f64] {
        &self.entries[j * self.dofs..(j + 1) * self.dofs]
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &[f64]> {
        self.entries.chunks_exact(self.dofs)
    }

    pub(crate) fn push(&mut self, column: &[f64]) {
        self.entries.extend_from_slice(column);
    }

    pub(crate) fn append(&mut self, other: &Self) {
        self.entries.extend_from_slice(&other.entries);
    }

    pub(crate) fn truncate(&mut self, columns: usize) {
        self.entries.truncate(columns * self.dofs);
    }
}

/// M-orthonormal vectors and their momenta M x.
#[derive(Debug, Clone)]
pub(crate) struct Orthonormal {
    pub(crate) vectors: VectorBlock,
    pub(crate) momenta: VectorBlock,
}

impl Orthonormal {
    /// Of vectors that are orthonormal already.
    pub(crate) fn new(beam: &Beam, vectors: VectorBlock) -> Self {
        let mut momenta = VectorBlock::new(beam.dofs());
        vectors.iter().for_each(|x| momenta.push(&mass_product(beam, x)));
        Self { vectors, momenta }
    }

    /// Takes its parts along these vectors out of `x`.
    pub(crate) fn remove_from(&self, x: &mut [f64]) {
        self.remove_first_from(self.vectors.columns(), x);
    }

    /// Takes its parts along the first `count` of them out of `x`.
    pub(crate) fn remove_first_from(&self, count: usize, x: &mut [f64]) {
        for (own, momentum) in self.vectors.iter().zip(self.momenta.iter()).take(count) {
            add(-dot(momentum, x), own, x);
        }
    }

    /// Adds what is new in `x`, normalised, if it is more than `least` of it.
    ///
    /// Gram–Schmidt twice: once leaves what rounding of the removed part was, a second time what
    /// rounding of that was (Giraud et al. 2005, doi 10.1007/s00211-005-0615-4).
    pub(crate) fn add(&mut self, beam: &Beam, x: &[f64], least: f64) {
        let mut new = x.to_vec();
        let size = norm(beam, &new);
        self.remove_from(&mut new);
        if !(norm(beam, &new) > least * size) {
            return;
        }
        normalise(beam, &mut new);
        self.remove_from(&mut new);
        normalise(beam, &mut new);
        self.momenta.push(&mass_product(beam, &new));
        self.vectors.push(&new);
    }

    /// The vectors from number `from` on.
    pub(crate) fn into_vectors_from(mut self, from: usize) -> VectorBlock {
        self.vectors.entries.drain(..from * self.vectors.dofs);
        self.vectors
    }
}

/// The columns of `x` made orthonormal in M, in their order, and M-orthogonal to `others`, which
/// are orthonormal; without those of which no more than `least` is new.
pub(crate) fn orthonormalised(beam: &Beam, others: &Orthonormal, x: &VectorBlock, least: f64) -> VectorBlock {
    let mut all = others.clone();
    x.iter().for_each(|x| all.add(beam, x, least));
    all.into_vectors_from(others.vectors.columns())
}

/// The Ritz values and vectors of the space of `y`, M-orthonormal and roughly in rising order;
/// ascending.
pub(crate) fn ritz(beam: &Beam, y: &VectorBlock) -> (Vec<f64>, VectorBlock) {
    let p = y.columns();
    let mut s = vec![0.0; p * p];
    for i in 0..p {
        s[i * p + i] = beam.stiffness_form(y.column(i));
        // The product of the lower column: it is the smoother, and has less rounding.
        let mut force = vec![0.0; y.dofs];
        beam.add_stiffness_product(1.0, y.column(i), &mut force);
        for j in i + 1..p {
            s[i * p + j] = dot(&force, y.column(j));
            s[j * p + i] = s[i * p + j];
        }
    }
    let u = jacobi(&mut s, p);
    let mut order: Vec<usize> = (0..p).collect();
    order.sort_by(|a, b| s[a * p + a].total_cmp(&s[b * p + b]));
    let mut x = VectorBlock::new(y.dofs);
    let mut values = Vec::with_capacity(p);
    for column in order {
        let mut shape = vec![0.0; y.dofs];
        for (i, y) in y.iter().enumerate() {
            add(u[i * p + column], y, &mut shape);
        }
        normalise(beam, &mut shape);
        values.push(beam.stiffness_form(&shape));
        x.push(&shape);
    }
    (values, x)
}

/// Sweeps of Jacobi's method at the most; some six do.
const MAX_SWEEPS: usize = 40;

/// Cyclic Jacobi on the symmetric p × p matrix `s`, which becomes diagonal: the columns of what is
/// returned are its eigenvectors, all by rows. An entry counts as 0 relative to the two diagonal
/// ones of its row and column, which is what keeps the digits of the small eigenvalues beside large
/// ones.
fn jacobi(s: &mut [f64], p: usize) -> Vec<f64> {
    let mut u = vec![0.0; p * p];
    for i in 0..p {
        u[i * p + i] = 1.0;
    }
    for _ in 0..MAX_SWEEPS {
        let mut rotated = false;
        for i in 0..p {
            for j in i + 1..p {
                let (a, b, c) = (s[i * p + i], s[i * p + j], s[j * p + j]);
                if b.abs() <= f64::EPSILON * (a.abs() * c.abs()).sqrt() {
                    continue;
                }
                rotated = true;
                // The smaller of the two angles that make the entry 0.
                let cot = 0.5 * (c - a) / b;
                let tan = cot.signum() / (cot.abs() + cot.hypot(1.0));
                let cos = tan.hypot(1.0).recip();
                let sin = cos * tan;
                for k in 0..p {
                    let (si, sj) = (s[k * p + i], s[k * p + j]);
                    s[k * p + i] = cos * si - sin * sj;
                    s[k * p + j] = sin * si + cos * sj;
                    let (ui, uj) = (u[k * p + i], u[k * p + j]);
                    u[k * p + i] = cos * ui - sin * uj;
                    u[k * p + j] = sin * ui + cos * uj;
                }
                for k in 0..p {
                    let (si, sj) = (s[i * p + k], s[j * p + k]);
                    s[i * p + k] = cos * si - sin * sj;
                    s[j * p + k] = sin * si + cos * sj;
                }
                // In closed form what the two passes have left there by cancellation.
                s[i * p + i] = a - tan * b;
                s[j * p + j] = c + tan * b;
                s[i * p + j] = 0.0;
                s[j * p + i] = 0.0;
            }
        }
        if !rotated {
            break;
        }
    }
    u
}

pub(crate) fn mass_product(beam: &Beam, x: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; x.len()];
    beam.add_mass_product(1.0, x, &mut y);
    y
}

/// √(xᵀM x).
pub(crate) fn norm(beam: &Beam, x: &[f64]) -> f64 {
    (2.0 * beam.kinetic_energy(x)).sqrt()
}

pub(crate) fn normalise(beam: &Beam, x: &mut [f64]) {
    let scale = norm(beam, x).recip();
    x.iter_mut().for_each(|x| *x *= scale);
}

pub(crate) fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// y += a x.
pub(crate) fn add(a: f64, x: &[f64], y: &mut [f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += a * x;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jacobi_keeps_the_digits_of_a_small_eigenvalue_beside_a_large_one() {
        // [[1, t], [t, t²(1 + d)]] has the determinant t² d: eigenvalues near t² and d.
        for (t, d) in [(1e6, 3.0), (1e9, 0.25)] {
            let mut s = vec![1.0, t, t, t * t * (1.0 + d)];
            jacobi(&mut s, 2);
            let small = s[0].min(s[3]);
            // λ = t² d/(trace − λ), d/(1 + d) but for terms of t⁻².
            let exact = t * t * d / (1.0 + t * t * (1.0 + d) - d / (1.0 + d));
            assert!((small / exact - 1.0).abs() < 1e-14, "{small} {exact}");
        }
    }

    #[test]
    fn jacobi_diagonalises() {
        let p = 7;
        let entry = |i: usize, j: usize| 1.0 / (1.0 + (i + j) as f64); // Hilbert's
        let mut s: Vec<f64> = (0..p * p).map(|k| entry(k / p, k % p)).collect();
        let u = jacobi(&mut s, p);
        for i in 0..p {
            for j in 0..p {
                let sum: f64 = (0..p).map(|k| u[i * p + k] * s[k * p + k] * u[j * p + k]).sum();
                assert!((sum - entry(i, j)).abs() < 1e-14, "{i} {j}"); // a norm of 1.7, some ten roundings
                let unit: f64 = (0..p).map(|k| u[k * p + i] * u[k * p + j]).sum();
                assert!((unit - f64::from(u8::from(i == j))).abs() < 1e-14, "{i} {j}");
            }
        }
    }
}
