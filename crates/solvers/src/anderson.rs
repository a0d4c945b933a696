//! Anderson acceleration of a fixed-point iteration (type II, limited memory).
//!
//! From the last images T(v) with their residuals g = T(v) − v, it forms the combination of images
//! whose residual would be smallest if T were affine (Walker and Ni 2011, doi 10.1137/10078356X).
//! The least-squares problem is solved by normal equations with a small multiple of their trace
//! added. A poor combination costs one iteration, as the caller checks it.

use crate::memory::reserve;
use nalgebra::{SMatrix, SVector};
use teeter_contact::Vector;

/// Number of differences kept.
const DEPTH: usize = 8;

/// Added to the normal equations, relative to their trace.
const REGULARISATION: f64 = 1e-12;

/// The history of the acceleration.
#[derive(Clone, Debug, Default)]
pub(crate) struct Anderson<const D: usize> {
    image: Vec<Vector<D>>,
    residual: Vec<Vector<D>>,
    image_steps: Vec<Vector<D>>,
    residual_steps: Vec<Vector<D>>,
    gram: SMatrix<f64, DEPTH, DEPTH>,
    known: usize,
    next: usize,
}

impl<const D: usize> Anderson<D> {
    pub(crate) fn reserve(&mut self, contacts: usize) {
        reserve(&mut self.image, contacts);
        reserve(&mut self.residual, contacts);
        reserve(&mut self.image_steps, contacts * DEPTH);
        reserve(&mut self.residual_steps, contacts * DEPTH);
    }

    /// Clears the history, for a new problem or after the map has changed.
    pub(crate) fn clear(&mut self) {
        self.image.clear();
        self.known = 0;
        self.next = 0;
    }

    /// Adds a point's image and residual, and replaces the image by the accelerated next point;
    /// `weight` is the metric per contact. Without history the image is unchanged.
    pub(crate) fn accelerate(&mut self, image: &mut [Vector<D>], residual: &[Vector<D>], weight: &[f64]) {
        let n = image.len();
        if self.image.len() != n {
            self.clear();
            self.image.extend_from_slice(image);
            self.residual.clear();
            self.residual.extend_from_slice(residual);
            self.image_steps.resize(n * DEPTH, Vector::zeros());
            self.residual_steps.resize(n * DEPTH, Vector::zeros());
            return;
        }
        let new = self.next;
        self.next = (self.next + 1) % DEPTH;
        self.known = (self.known + 1).min(DEPTH);
        for i in 0..n {
            self.image_steps[new * n + i] = image[i] - self.image[i];
            self.residual_steps[new * n + i] = residual[i] - self.residual[i];
            self.image[i] = image[i];
            self.residual[i] = residual[i];
        }
        let mut against = SVector::<f64, DEPTH>::zeros();
        for k in 0..self.known {
            let (own, newest) = (&self.residual_steps[k * n..][..n], &self.residual_steps[new * n..][..n]);
            let (mut product, mut with_residual) = (0.0, 0.0);
            for i in 0..n {
                product += weight[i] * own[i].dot(&newest[i]);
                with_residual += weight[i] * own[i].dot(&residual[i]);
            }
            self.gram[(k, new)] = product;
            self.gram[(new, k)] = product;
            against[k] = with_residual;
        }
        let mut system = self.gram;
        let trace: f64 = (0..self.known).map(|k| system[(k, k)]).sum();
        for k in 0..DEPTH {
            if k < self.known {
                system[(k, k)] += REGULARISATION * trace;
            } else {
                system.fill_row(k, 0.0);
                system.fill_column(k, 0.0);
                system[(k, k)] = 1.0;
            }
        }
        let Some(factor) = system.cholesky() else {
            self.clear();
            return;
        };
        let shares = factor.solve(&against);
        if !shares.iter().all(|share| share.is_finite()) {
            self.clear();
            return;
        }
        for k in 0..self.known {
            for (to, step) in image.iter_mut().zip(&self.image_steps[k * n..][..n]) {
                *to -= step * shares[k];
            }
        }
    }
}
