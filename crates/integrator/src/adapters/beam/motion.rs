//! Moving supports of a beam: two prescribed coordinates, and the inertia of the common motion.
//!
//! With v_y the supports' velocity and v the rates of the deflection relative to them, every point
//! moves at v_y + N v:
//!
//! ```text
//! M_aug = ⎡ M   0   s ⎤     s = ρA ∫ Nᵀ dx,  m = ρA L         T = ½ vᵀM v + v_y sᵀv + ½ m (v_x² + v_y²)
//!         ⎢ 0   m   0 ⎥
//!         ⎣ sᵀ  0   m ⎦
//! ```
//!
//! Stiffness and damping act on the relative motion only.

use crate::Motion;
use teeter_beam::{Beam, ModalBasis};

#[derive(Clone, Debug)]
pub(crate) struct MovingSupports {
    motion: [Motion; 2],
    /// Numbers of the two prescribed velocities.
    pub(crate) driven: [usize; 2],
    /// s, one entry per dof of the beam.
    coupling: Vec<f64>,
    /// m, kg.
    mass: f64,
}

impl MovingSupports {
    pub(crate) fn new(beam: &Beam, motion: [Motion; 2]) -> Self {
        let n = beam.dofs();
        let mut coupling = vec![0.0; n];
        // The acceleration is finite and the vector has the right length, so there is no error to
        // pass on.
        let _ = beam.add_self_weight(1.0, &mut coupling);
        Self { motion, driven: [n, n + 1], coupling, mass: beam.total_mass() }
    }

    /// The same for coordinates η with q = Φ η: s becomes Φᵀs.
    pub(crate) fn in_basis(mut self, basis: &ModalBasis) -> Self {
        let n = basis.len();
        self.coupling =
            (0..n).map(|i| basis.shape(i).iter().zip(&self.coupling).map(|(phi, s)| phi * s).sum()).collect();
        self.driven = [n, n + 1];
        self
    }

    pub(crate) fn displacements(&self, t: f64) -> [f64; 2] {
        self.motion.each_ref().map(|motion| motion.displacement(t))
    }

    pub(crate) fn velocities(&self, t: f64) -> [f64; 2] {
        self.motion.each_ref().map(|motion| motion.velocity(t))
    }

    pub(crate) fn accelerations(&self, t: f64) -> [f64; 2] {
        self.motion.each_ref().map(|motion| motion.acceleration(t))
    }

    pub(crate) fn next_break(&self, t: f64) -> f64 {
        self.motion.iter().map(|motion| motion.next_break(t)).fold(f64::INFINITY, f64::min)
    }

    pub(crate) fn mean_velocities(&self, [from, to]: [f64; 2]) -> [f64; 2] {
        self.motion.each_ref().map(|motion| motion.mean_velocity(from, to))
    }

    /// y += a (M_aug − M) x.
    pub(crate) fn add_mass_product(&self, a: f64, x: &[f64], y: &mut [f64]) {
        let [across, up] = self.driven;
        y[across] += a * self.mass * x[across];
        y[up] += a * (self.mass * x[up] + self.momentum(x));
        for (y, s) in y.iter_mut().zip(&self.coupling) {
            *y += a * x[up] * s;
        }
    }

    /// T − ½ vᵀM v, J.
    pub(crate) fn kinetic_energy(&self, v: &[f64]) -> f64 {
        let [across, up] = self.driven.map(|k| v[k]);
        0.5 * self.mass * (across * across + up * up) + up * self.momentum(v)
    }

    /// sᵀv.
    fn momentum(&self, v: &[f64]) -> f64 {
        self.coupling.iter().zip(v).map(|(s, v)| s * v).sum()
    }
}
