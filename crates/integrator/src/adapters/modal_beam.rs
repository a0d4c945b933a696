//! A beam in modes as a subsystem: few uncoupled coordinates, whatever its mesh.
//!
//! ```text
//! q = Φ η:   η̈_i + d_i η̇_i + ω_i² η_i = φ_iᵀ P + φ_i-rows of the contacts        w(x) = Σ φ_i(x) η_i
//! ```
//!
//! The shapes Φ are those of a [`ModalBasis`], modes and static corrections alike. Contact
//! kinematics, loads and moving supports are those of [`BeamBody`](crate::BeamBody); a step costs
//! some N operations for N coordinates, and 8 N for each contact point.

use super::beam;
use super::beam::line::{self, Deflecting, Line};
use super::beam::motion::MovingSupports;
use super::modal_motion::{self, ModalMotion};
use crate::compliance::couple_by_solving;
use crate::small::{self, add_outer};
use crate::subsystem::dot;
use crate::{
    BeamFace, BeamSurface, Bodies, Compliance, Coupling, Dynamics, Energy, FactorError, Motion, PartRows, Propagator,
    Rows, SignalLoad, Size, Traits, Vector, Weights,
};
use nalgebra::{Matrix2, Vector2};
use std::sync::{Arc, Mutex, PoisonError};
use teeter_beam::{Beam, Deflection, DeflectionBounds, InnerSupport, Load, ModalBasis, ModalError};
use teeter_detect::{Frame, HalfSpace, Kinematics, Summit, SurfacePoint};

/// A straight level beam in the world, in modal coordinates η (m √kg).
///
/// If its supports [move](Self::with_motion), deflections are relative to them, and the
/// displacements x and y of the supports follow as two more, prescribed coordinates.
pub struct ModalBeam {
    shapes: Shapes,
    basis: ModalBasis,
    /// ω², 1/s².
    stiffness: Vec<f64>,
    /// 1/s.
    damping: Vec<f64>,
    damped: bool,
    position: Vector2<f64>,
    surface: BeamSurface,
    loads: Vec<Box<dyn Load>>,
    /// Loads with a fixed pattern, in modal coordinates.
    signals: Vec<SignalLoad>,
    /// A load on the dofs of the beam before it is brought to modes, and as much scratch.
    scratch: Mutex<Vec<f64>>,
    supports: Option<MovingSupports>,
    /// Gravity on each coordinate, those of moving supports at the end; empty without gravity.
    weight: Vec<f64>,
}

impl std::fmt::Debug for ModalBeam {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ModalBeam")
            .field("coordinates", &self.stiffness.len())
            .field("position", &self.position)
            .field("surface", &self.surface)
            .field("loads", &(self.loads.len() + self.signals.len()))
            .finish_non_exhaustive()
    }
}

impl ModalBeam {
    /// The beam in the coordinates of `basis`, which must have been made from it, with its left end
    /// at `position` (m) and its own damping.
    ///
    /// # Errors
    /// [`ModalError::CoupledDamping`] if its damping isn't a combination of mass and stiffness.
    pub fn new(
        beam: Arc<Beam>,
        basis: ModalBasis,
        position: Vector2<f64>,
        surface: BeamSurface,
    ) -> Result<Self, ModalError> {
        let damping = basis.damping(&beam)?;
        Ok(Self::damped(beam, basis, damping, position, surface))
    }

    /// As [`ModalBeam::new`], with given damping ratios ζ in place of the beam's damping, one for
    /// each coordinate: d = 2ζω. Rigid motions are not damped.
    ///
    /// # Errors
    /// [`ModalError::Ratios`] for another number of ratios, or one that is not finite and ≥ 0.
    pub fn with_ratios(
        beam: Arc<Beam>,
        basis: ModalBasis,
        ratios: &[f64],
        position: Vector2<f64>,
        surface: BeamSurface,
    ) -> Result<Self, ModalError> {
        if ratios.len() != basis.len() {
            let reason = format!("{} for {} coordinates; give one for each", ratios.len(), basis.len());
            return Err(ModalError::Ratios { reason });
        }
        if let Some((index, ratio)) = ratios.iter().enumerate().find(|(_, z)| !z.is_finite() || **z < 0.0) {
            let reason = format!("ratios[{index}] = {ratio}: must be finite and >= 0");
            return Err(ModalError::Ratios { reason });
        }
        let damping = ratios.iter().zip(basis.circular_frequencies()).map(|(z, omega)| 2.0 * z * omega).collect();
        Ok(Self::damped(beam, basis, damping, position, surface))
    }

    fn damped(
        beam: Arc<Beam>,
        basis: ModalBasis,
        damping: Vec<f64>,
        position: Vector2<f64>,
        surface: BeamSurface,
    ) -> Self {
        let (n, dofs) = (basis.len(), beam.dofs());
        let by_dof = (0..dofs * n).map(|k| basis.shape(k % n)[k / n]).collect();
        let bounds = (0..n).map(|i| bounds(&beam, basis.shape(i))).collect();
        Self {
            stiffness: basis.circular_frequencies().iter().map(|omega| omega * omega).collect(),
            damped: damping.iter().any(|d| *d != 0.0),
            damping,
            basis,
            shapes: Shapes { beam, coordinates: n, by_dof, bounds },
            position,
            surface,
            loads: Vec::new(),
            signals: Vec::new(),
            scratch: Mutex::new(vec![0.0; 2 * dofs]),
            supports: None,
            weight: Vec::new(),
        }
    }

    /// Adds a load, which is transformed from the beam's dofs to modes in every step; for a load
    /// with a fixed pattern [`ModalBeam::with_signal_load`] costs less.
    #[must_use]
    pub fn with_load(mut self, load: Box<dyn Load>) -> Self {
        self.loads.push(load);
        self
    }

    /// Adds a load with a fixed pattern, given for the beam's dofs.
    #[must_use]
    pub fn with_signal_load(mut self, load: SignalLoad) -> Self {
        self.signals.push(load.in_basis(&self.basis));
        self
    }

    /// Makes the supports move together, by these motions in x and y; as
    /// [`BeamBody::with_motion`](crate::BeamBody::with_motion).
    #[must_use]
    pub fn with_motion(mut self, motion: [Motion; 2]) -> Self {
        self.supports = Some(MovingSupports::new(&self.shapes.beam, motion).in_basis(&self.basis));
        self
    }

    /// Lets gravity (m/s², x and y) act on the beam and on the masses that it carries, as
    /// [`BeamBody::with_weight`](crate::BeamBody::with_weight): Φᵀ of its weight.
    #[must_use]
    pub fn with_weight(mut self, gravity: Vector2<f64>) -> Self {
        let (weight, supports) = beam::weight(&self.shapes.beam, gravity);
        self.weight = (0..self.coordinates()).map(|i| dot(self.basis.shape(i), &weight)).collect();
        self.weight.extend(supports);
        self
    }

    /// The displacements of its supports at time `t` (s) in closed form, m; at t = 0 those to start
    /// from. Empty for supports that stand still.
    #[must_use]
    pub fn displacements(&self, t: f64) -> Vec<f64> {
        self.supports.as_ref().map_or_else(Vec::new, |supports| supports.displacements(t).to_vec())
    }

    /// Its coordinates' shapes.
    #[must_use]
    pub fn basis(&self) -> &ModalBasis {
        &self.basis
    }

    /// The beam.
    #[must_use]
    pub fn beam(&self) -> &Arc<Beam> {
        &self.shapes.beam
    }

    /// Deflection and slope at x (m, along the beam) for its own coordinates `q` (their rates for
    /// velocities), relative to its supports; `None` off the beam.
    #[must_use]
    pub fn deflection_at(&self, q: &[f64], x: f64) -> Option<Deflection> {
        self.shapes.deflection_at(&q[..self.coordinates()], x)
    }

    /// Its prescribed velocities.
    fn driven(&self) -> &[usize] {
        self.supports.as_ref().map_or(&[], |supports| &supports.driven)
    }

    fn coordinates(&self) -> usize {
        self.stiffness.len()
    }

    /// Adds the loads that are transformed from the beam's dofs to modes; `add` adds one to its
    /// second argument, with the third as scratch memory.
    fn add_loads(&self, f: &mut [f64], add: impl Fn(&dyn Load, &mut [f64], &mut [f64])) {
        if self.loads.is_empty() {
            return;
        }
        // A thread that panicked can only have left numbers behind, which are overwritten.
        let mut scratch = self.scratch.lock().unwrap_or_else(PoisonError::into_inner);
        let (force, scratch) = scratch.split_at_mut(self.shapes.beam.dofs());
        force.fill(0.0);
        for load in &self.loads {
            add(load.as_ref(), force, scratch);
        }
        for (dof, force) in force.iter().enumerate().filter(|(_, force)| **force != 0.0) {
            for (f, phi) in f.iter_mut().zip(self.shapes.dof(dof)) {
                *f += force * phi;
            }
        }
    }

    fn split<'q>(&self, q: &'q [f64]) -> (&'q [f64], Line) {
        let (q, displaced) = q.split_at(self.coordinates());
        (q, Line::new(self.position, displaced, self.surface))
    }
}

/// Φ row by row: the entries of one dof of the beam are contiguous, as a point is moved by few
/// dofs.
struct Shapes {
    beam: Arc<Beam>,
    coordinates: usize,
    by_dof: Vec<f64>,
    /// Bounds of the deflections of each coordinate, of either sign.
    bounds: Vec<DeflectionBounds>,
}

fn bounds(beam: &Beam, shape: &[f64]) -> DeflectionBounds {
    let turned: Vec<f64> = shape.iter().map(|phi| -phi).collect();
    let [up, down] = [shape, &turned].map(|shape| beam.deflection_bounds(shape));
    DeflectionBounds { highest: up.highest.max(down.highest), steepest: up.steepest }
}

impl Shapes {
    fn deflection_bounds(&self, q: &[f64]) -> DeflectionBounds {
        let mut sum = DeflectionBounds { highest: 0.0, steepest: 0.0 };
        for (bounds, q) in self.bounds.iter().zip(q) {
            sum.highest += bounds.highest * q.abs();
            sum.steepest += bounds.steepest * q.abs();
        }
        sum
    }

    fn dof(&self, dof: usize) -> &[f64] {
        &self.by_dof[dof * self.coordinates..(dof + 1) * self.coordinates]
    }

    fn dof_value(&self, dof: usize, q: &[f64]) -> f64 {
        dot(self.dof(dof), &q[..self.coordinates])
    }
}

impl Deflecting for Shapes {
    fn span(&self) -> f64 {
        self.beam.spec().span
    }

    fn nodes(&self) -> &[f64] {
        self.beam.node_positions()
    }

    fn inner_supports(&self) -> &[InnerSupport] {
        &self.beam.spec().inner_supports
    }

    fn deflection_at(&self, q: &[f64], x: f64) -> Option<Deflection> {
        let shape = self.beam.shape_at(x)?;
        let mut d = Deflection { w: 0.0, slope: 0.0 };
        // Unused places don't count.
        for k in 0..4 {
            let value = self.dof_value(shape.columns[k], q);
            d.w += shape.n[k] * value;
            d.slope += shape.dn[k] * value;
        }
        Some(d)
    }

    fn shape(&self, x: f64, mut each: impl FnMut(usize, f64, f64)) {
        let shape = self.beam.shape_clamped(x);
        // Unused places don't count.
        let [a, b, c, d] = shape.columns.map(|dof| self.dof(dof));
        for (i, (((a, b), c), d)) in a.iter().zip(b).zip(c).zip(d).enumerate() {
            let [n, dn] = [shape.n, shape.dn].map(|n| (n[0] * a + n[1] * b) + (n[2] * c + n[3] * d));
            each(i, n, dn);
        }
    }

    fn has_axial_dofs(&self) -> bool {
        self.beam.has_axial_dofs()
    }

    fn axial_displacement(&self, q: &[f64], x: f64) -> f64 {
        let axial = self.beam.axial_shape_clamped(x);
        (0..axial.len).map(|k| axial.n[k] * self.dof_value(axial.columns[k], q)).sum()
    }

    fn axial_shape(&self, x: f64, mut each: impl FnMut(usize, f64)) {
        let axial = self.beam.axial_shape_clamped(x);
        if axial.len > 0 {
            for i in 0..self.coordinates {
                each(i, (0..axial.len).map(|k| axial.n[k] * self.dof(axial.columns[k])[i]).sum());
            }
        }
    }
}

impl Dynamics<2> for ModalBeam {
    fn size(&self) -> Size {
        let all = self.coordinates() + self.driven().len();
        let axial = if self.shapes.has_axial_dofs() { self.coordinates() } else { 0 };
        Size { q: all, v: all, bodies: BeamFace::BODIES, row: all + axial }
    }

    fn traits(&self) -> Traits {
        let loaded = !(self.loads.is_empty() && self.signals.is_empty());
        Traits::free().loaded(loaded).damped(self.damped).driven(self.driven())
    }

    fn internal_force(&self, q: &[f64], v: &[f64], f: &mut [f64]) {
        for (((f, q), v), (k, d)) in f.iter_mut().zip(q).zip(v).zip(self.stiffness.iter().zip(&self.damping)) {
            *f -= k * q + d * v;
        }
        // The supports have coordinates only if they move.
        f.iter_mut().zip(&self.weight).for_each(|(f, weight)| *f += weight);
    }

    fn load(&self, t: f64, f: &mut [f64]) {
        for load in &self.signals {
            load.add(self.beam(), t, f);
        }
        self.add_loads(f, |load, force, _| load.add(self.beam(), t, force));
    }

    fn mean_load(&self, times: [f64; 2], scratch: &mut [f64], f: &mut [f64]) {
        for load in &self.signals {
            load.add_mean(self.beam(), times, scratch, f);
        }
        self.add_loads(f, |load, force, scratch| load.add_mean(self.beam(), times, scratch, force));
    }

    fn drive(&self, t: f64, v: &mut [f64]) {
        if let Some(supports) = &self.supports {
            v[self.coordinates()..].copy_from_slice(&supports.velocities(t));
        }
    }

    fn drive_rate(&self, t: f64, a: &mut [f64]) -> bool {
        if let Some(supports) = &self.supports {
            a[self.coordinates()..].copy_from_slice(&supports.accelerations(t));
        }
        true
    }

    fn next_break(&self, t: f64) -> f64 {
        let loads = self.loads.iter().map(|load| load.next_break(self.beam(), t));
        let signals = self.signals.iter().map(|load| load.next_break(self.beam(), t));
        let supports = self.supports.iter().map(|supports| supports.next_break(t));
        loads.chain(signals).chain(supports).fold(f64::INFINITY, f64::min)
    }

    fn load_count(&self) -> usize {
        self.loads.len() + self.signals.len()
    }

    fn next_load_break(&self, load: usize, t: f64) -> f64 {
        match self.loads.get(load) {
            Some(load) => load.next_break(self.beam(), t),
            None => {
                self.signals.get(load - self.loads.len()).map_or(f64::INFINITY, |load| load.next_break(self.beam(), t))
            }
        }
    }

    fn drive_mean(&self, times: [f64; 2], v: &mut [f64]) {
        if let Some(supports) = &self.supports {
            v[self.coordinates()..].copy_from_slice(&supports.mean_velocities(times));
        }
    }

    fn damping_power(&self, _q: &[f64], v: &[f64], _scratch: &mut [f64]) -> f64 {
        weighted_squares(&self.damping, v)
    }

    fn apply(&self, w: Weights, _q: &[f64], x: &[f64], y: &mut [f64]) {
        if let Some(supports) = &self.supports
            && w.mass != 0.0
        {
            supports.add_mass_product(w.mass, x, y);
        }
        for ((y, x), (k, d)) in y.iter_mut().zip(x).zip(self.stiffness.iter().zip(&self.damping)) {
            *y += (w.mass + w.damping * d + w.stiffness * k) * x;
        }
    }

    fn propagator(&self) -> Option<Box<dyn Propagator<2>>> {
        if self.supports.is_some() {
            return None;
        }
        // Without the supports' share, which is at the end.
        let mut constant = self.weight.clone();
        constant.resize(self.coordinates(), 0.0);
        Some(Box::new(ModalMotion::new(
            modal_motion::Shapes::Own,
            self.stiffness.clone(),
            self.damping.clone(),
            constant,
        )))
    }

    fn energy(&self, q: &[f64], v: &[f64]) -> Energy {
        let n = self.coordinates();
        let relative = 0.5 * dot(&v[..n], &v[..n]);
        let kinetic = self.supports.as_ref().map_or(relative, |supports| relative + supports.kinetic_energy(v));
        let elastic = 0.5 * weighted_squares(&self.stiffness, q);
        let along: f64 = self.weight.iter().zip(q).map(|(force, q)| force * q).sum();
        Energy { kinetic, elastic, gravity: 0.0 - along }
    }

    fn factor(&self, w: Weights, _q: &[f64]) -> Result<Box<dyn Compliance<2>>, FactorError> {
        let mut compliance = Box::new(ModalCompliance {
            stiffness: self.stiffness.clone(),
            damping: self.damping.clone(),
            weights: w,
            inverse: vec![0.0; self.coordinates()],
        });
        compliance.refactor(w, &[])?;
        Ok(compliance)
    }
}

impl Bodies<2> for ModalBeam {
    fn place(&self, _body: u32, q: &[f64], local: &[Vector2<f64>], out: &mut [Vector2<f64>]) {
        let (q, line) = self.split(q);
        line.place(&self.shapes, q, local, out);
    }

    fn has_surface(&self, _body: u32) -> bool {
        true
    }

    fn surface(&self, body: u32, q: &[f64], kinematics: Kinematics, at: &Vector2<f64>) -> Option<SurfacePoint<2>> {
        let (q, line) = self.split(q);
        line.of_body(body).foot(&self.shapes, q, kinematics, at)
    }

    fn reach(&self, body: u32, q: &[f64], margin: f64) -> Option<HalfSpace<2>> {
        let (q, line) = self.split(q);
        match BeamFace::of_body(body) {
            BeamFace::Upper => Some(line.reach(self.shapes.deflection_bounds(q), margin)),
            BeamFace::Lower => None,
        }
    }

    fn summits(
        &self,
        body: u32,
        q: &[f64],
        direction: &Vector2<f64>,
        between: &[Vector2<f64>; 2],
        each: &mut dyn FnMut(Summit<2>),
    ) {
        let (q, line) = self.split(q);
        line.of_body(body).summits(&self.shapes, q, direction, between, each);
    }

    fn ends(&self, body: u32, q: &[f64]) -> [Option<SurfacePoint<2>>; 2] {
        let (q, line) = self.split(q);
        line.of_body(body).ends(&self.shapes, q)
    }

    fn bias(&self, _: u32, q: &[f64], v: &[f64], point: &Vector2<f64>, frame: &Frame<2>) -> Option<Vector<2>> {
        let n = self.split(q).0.len();
        line::bias(&self.shapes, [&q[..n], &v[..n]], point, frame)
    }

    fn rows(&self, body: u32, q: &[f64], point: &Vector2<f64>, frame: &Frame<2>, out: &mut Rows<'_, 2>) -> usize {
        line::rows(&self.shapes, (body, self.split(q).0), point, frame, self.driven(), out)
    }
}

/// Σ w x², over the weights, in four sums at once as [`dot`].
fn weighted_squares(w: &[f64], x: &[f64]) -> f64 {
    let ((w, w_rest), (x, x_rest)) = (w.as_chunks::<4>(), x[..w.len()].as_chunks::<4>());
    let mut sums = [0.0; 4];
    for (w, x) in w.iter().zip(x) {
        for k in 0..4 {
            sums[k] += w[k] * x[k] * x[k];
        }
    }
    let rest: f64 = w_rest.iter().zip(x_rest).map(|(w, x)| w * x * x).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// W of uncoupled coordinates: the reciprocals of `mass + damping d_i + stiffness ω_i²`.
struct ModalCompliance {
    stiffness: Vec<f64>,
    damping: Vec<f64>,
    weights: Weights,
    inverse: Vec<f64>,
}

impl Compliance<2> for ModalCompliance {
    fn weights(&self) -> Weights {
        self.weights
    }

    fn refactor(&mut self, w: Weights, _q: &[f64]) -> Result<(), FactorError> {
        for (i, inverse) in self.inverse.iter_mut().enumerate() {
            let sum = w.mass + w.damping * self.damping[i] + w.stiffness * self.stiffness[i];
            // Also false for NaN.
            if !(sum > 0.0 && sum.is_finite()) {
                let reason =
                    format!("its modal coordinate {i} has {sum} on the diagonal, which must be finite and > 0");
                return Err(FactorError { weights: w, reason });
            }
            *inverse = sum.recip();
        }
        self.weights = w;
        Ok(())
    }

    fn solve(&mut self, f: &mut [f64]) {
        let (free, driven) = f.split_at_mut(self.inverse.len());
        free.iter_mut().zip(&self.inverse).for_each(|(f, w)| *f *= w);
        driven.fill(0.0);
    }
    fn couple(&mut self, rows: &PartRows<'_, 2>, scratch: &mut [f64], h: &mut Coupling<'_, 2>) {
        // Each coordinate has one place in a row, its own, unless points move along the axis too.
        if !rows.iter().all(|(_, columns, _)| columns.len() == scratch.len()) {
            return couple_by_solving(rows, scratch, h, |f| self.solve(f), |_, _, _| {});
        }
        for (number, (j, _, values_j)) in rows.iter().enumerate() {
            for (other, (i, _, values_i)) in rows.iter().take(number + 1).enumerate() {
                let mut block = Matrix2::zeros();
                for ((a, b), w) in values_i.iter().zip(values_j).zip(&self.inverse) {
                    add_outer(&mut block, b, a, *w);
                }
                let block = block.transpose();
                h.add(i, j, &block);
                if other < number {
                    h.add(j, i, &block.transpose());
                }
            }
        }
    }

    fn respond(&mut self, rows: &PartRows<'_, 2>, p: &[Vector<2>], _scratch: &mut [f64], v: &mut [f64]) {
        // As in coupling, a row has all coordinates in their order.
        for (contact, columns, values) in rows.iter() {
            if columns.len() != v.len() {
                return rows.add_diagonal_response(&self.inverse, p, v);
            }
            for ((v, inverse), a) in v.iter_mut().zip(&self.inverse).zip(values) {
                *v += inverse * small::dot(a, &p[contact]);
            }
        }
    }
}
