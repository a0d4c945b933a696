//! A beam as a subsystem: the adapter above `teeter-beam`, with the contact kinematics of `docs/theory.md` §3.

mod compliance;
mod motion;

use crate::{Compliance, Energy, FactorError, Motion, Rows, Signal, Size, Subsystem, Weights};
use compliance::BeamCompliance;
pub use compliance::WBackend;
use motion::MovingSupports;
use nalgebra::Vector2;
use std::sync::Arc;
use teeter_beam::{Beam, Load, MatrixWeights};

use teeter_detect::{Frame, Kinematics, SurfacePoint};

/// Which fibre of a beam is its contact surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BeamSurface {
    /// The axis: contact forces do no work on the rotation of the section.
    Axis,
    /// The top fibre, half a thickness (m) above the axis.
    Top {
        /// Distance of the fibre from the axis, m.
        offset: f64,
    },
}

impl BeamSurface {
    fn offset(self) -> f64 {
        match self {
            Self::Axis => 0.0,
            Self::Top { offset } => offset,
        }
    }
}

/// A load on a beam that keeps its shape: a vector of nodal loads times a signal.
#[derive(Clone, Debug)]
pub struct SignalLoad {
    pattern: Vec<f64>,
    signal: Arc<dyn Signal>,
}

impl SignalLoad {
    /// The nodal loads `pattern` of a beam, as its `add_…_load` methods add them, times `signal`.
    #[must_use]
    pub fn new(pattern: Vec<f64>, signal: Arc<dyn Signal>) -> Self {
        Self { pattern, signal }
    }
}

impl Load for SignalLoad {
    fn add(&self, _beam: &Beam, t: f64, f: &mut [f64]) {
        let factor = self.signal.value(t);
        for (f, p) in f.iter_mut().zip(&self.pattern) {
            *f += factor * p;
        }
    }
}

/// A straight level beam in the world.
///
/// Its coordinates are those of [`Beam`]; where its supports [move](Self::with_motion), deflections are relative to
/// them, and the displacements x and y of the supports follow as two more, prescribed ones.
pub struct BeamBody {
    beam: Arc<Beam>,
    position: Vector2<f64>,
    surface: BeamSurface,
    loads: Vec<Box<dyn Load>>,
    supports: Option<MovingSupports>,
    held: Vec<usize>,
    backend: WBackend,
}

impl std::fmt::Debug for BeamBody {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("BeamBody")
            .field("position", &self.position)
            .field("surface", &self.surface)
            .field("loads", &self.loads.len())
            .finish_non_exhaustive()
    }
}

impl BeamBody {
    /// A beam with its left end at `position` (m).
    #[must_use]
    pub fn new(beam: Arc<Beam>, position: Vector2<f64>, surface: BeamSurface) -> Self {
        let held = (0..beam.dofs()).filter(|dof| beam.is_held(*dof)).collect();
        Self { beam, position, surface, loads: Vec::new(), supports: None, held, backend: WBackend::Auto }
    }

    /// The same beam under one more load.
    #[must_use]
    pub fn with_load(mut self, load: Box<dyn Load>) -> Self {
        self.loads.push(load);
        self
    }

    /// The same beam on supports that move together, by these displacements in x and y. Its damping acts on the motion
    /// relative to them, and the force that moves them carries their share of all loads on the beam.
    #[must_use]
    pub fn with_motion(mut self, motion: [Motion; 2]) -> Self {
        self.supports = Some(MovingSupports::new(&self.beam, motion));
        self
    }

    /// The same beam with its W held in another way.
    #[must_use]
    pub fn with_backend(mut self, backend: WBackend) -> Self {
        self.backend = backend;
        self
    }

    /// The displacements of its supports at time `t` (s) in closed form, m; at t = 0 those to start from. None for supports
    /// that stand still.
    #[must_use]
    pub fn displacements(&self, t: f64) -> Vec<f64> {
        self.supports.as_ref().map_or_else(Vec::new, |supports| supports.displacements(t).to_vec())
    }

    /// The coordinates (or velocities) of the beam alone, and the place of its left end.
    fn split<'q>(&self, q: &'q [f64]) -> (&'q [f64], Vector2<f64>) {
        let (q, displaced) = q.split_at(self.beam.dofs());
        match *displaced {
            [x, y] => (q, self.position + Vector2::new(x, y)),
            _ => (q, self.position),
        }
    }

    /// The beam.
    #[must_use]
    pub fn beam(&self) -> &Arc<Beam> {
        &self.beam
    }

    /// The beam's own coordinate of a place in the world, with its left end at x = `left`. The ends belong to the beam, so a place beyond one by the rounding
    /// of a difference is at it.
    fn along(&self, x: f64, left: f64) -> f64 {
        let span = self.beam.spec().span;
        let along = x - left;
        let rounding = 4.0 * f64::EPSILON * (left.abs() + span);
        if (-rounding..=span + rounding).contains(&along) { along.clamp(0.0, span) } else { along }
    }

    /// The material point that axial motion has brought to x: x_m + u(x_m) = x. Strains are far below 1, so that a few rounds do.
    fn before_moving(&self, q: &[f64], x: f64) -> f64 {
        let mut material = x;
        for _ in 0..FOOT_ROUNDS {
            let next = (x - self.beam.axial_shape_clamped(material).displacement(q)).clamp(0.0, self.beam.spec().span);
            let moved = (next - material).abs();
            material = next;
            if moved <= f64::EPSILON * self.beam.spec().span {
                break;
            }
        }
        material
    }

    /// The foot point at the beam's own coordinate of `at`: the point of the surface with the same x.
    fn foot(&self, q: &[f64], kinematics: Kinematics, at: &Vector2<f64>) -> Option<SurfacePoint<2>> {
        let (q, position) = self.split(q);
        let x = self.along(at.x, position.x);
        let offset = self.surface.offset();
        self.beam.shape_at(x)?; // None beyond the ends, which belong to the beam
        // The material point that is at x now.
        let moves = self.beam.has_axial_dofs() && kinematics == Kinematics::Deformed;
        let x = if moves { self.before_moving(q, x) } else { x };
        let d = self.beam.deflection_at(q, x)?;
        if kinematics == Kinematics::Linear {
            let place = Vector2::new(at.x, position.y + d.w + offset);
            return Some(SurfacePoint { place, normal: Vector2::y(), material: Vector2::new(x, offset) });
        }
        let normal_of = |slope: f64| {
            let cos = (1.0 + slope * slope).sqrt().recip();
            Vector2::new(-slope * cos, cos)
        };
        let (mut foot, mut w, mut normal) = (x, d.w, normal_of(d.slope));
        if offset != 0.0 {
            // x_f − offset sin ψ(x_f) = x: each round gains a factor offset·w'' on the last, a curvature radius of many
            // thicknesses for anything that is a beam; 1e-16 of the span is reached in some four rounds.
            for _ in 0..FOOT_ROUNDS {
                let next = (x - offset * normal.x).clamp(0.0, self.beam.spec().span);
                let moved = (next - foot).abs();
                let d = self.beam.deflection_at(q, next)?;
                (foot, w, normal) = (next, d.w, normal_of(d.slope));
                if moved <= f64::EPSILON * self.beam.spec().span {
                    break;
                }
            }
        }
        let place = Vector2::new(at.x, position.y + w + offset * normal.y);
        Some(SurfacePoint { place, normal, material: Vector2::new(foot, offset) })
    }
}

/// Most rounds of the fixed point for the foot on the top fibre.
const FOOT_ROUNDS: usize = 20;

impl Subsystem<2> for BeamBody {
    fn size(&self) -> Size {
        let driven = self.driven().len();
        let dofs = self.beam.dofs() + driven;
        let axial = if self.beam.has_axial_dofs() { 2 } else { 0 };
        Size { q: dofs, v: dofs, bodies: 1, row: 4 + axial + driven }
    }

    fn internal_force(&self, q: &[f64], v: &[f64], f: &mut [f64]) {
        let n = self.beam.dofs();
        self.beam.add_elastic_force(&q[..n], &mut f[..n]);
        if self.beam.is_damped() {
            self.beam.add_damping_product(-1.0, &v[..n], &mut f[..n]);
        }
    }

    fn is_loaded(&self) -> bool {
        !self.loads.is_empty()
    }

    fn load(&self, t: f64, f: &mut [f64]) {
        for load in &self.loads {
            load.add(&self.beam, t, &mut f[..self.beam.dofs()]);
        }
    }

    fn driven(&self) -> &[usize] {
        self.supports.as_ref().map_or(&[], |supports| &supports.driven)
    }

    fn held(&self) -> &[usize] {
        &self.held
    }

    fn drive(&self, t: f64, v: &mut [f64]) {
        if let Some(supports) = &self.supports {
            v[self.beam.dofs()..].copy_from_slice(&supports.velocities(t));
        }
    }

    fn is_damped(&self) -> bool {
        self.beam.is_damped()
    }

    fn damping_power(&self, _q: &[f64], v: &[f64], _scratch: &mut [f64]) -> f64 {
        self.beam.damping_power(&v[..self.beam.dofs()])
    }

    fn follows_coordinates(&self) -> bool {
        self.beam.is_stretched()
    }

    fn modified_energy(&self, h: f64, q: &[f64], v: &[f64]) -> f64 {
        let n = self.beam.dofs();
        if self.beam.is_stretched() { self.beam.modified_energy(h, &q[..n], &v[..n]) } else { 0.0 }
    }

    fn apply(&self, w: Weights, _q: &[f64], x: &[f64], y: &mut [f64]) {
        let n = self.beam.dofs();
        if w.mass != 0.0 {
            if let Some(supports) = &self.supports {
                supports.add_mass_product(w.mass, x, y);
            }
            self.beam.add_mass_product(w.mass, &x[..n], &mut y[..n]);
        }
        if w.damping != 0.0 {
            self.beam.add_damping_product(w.damping, &x[..n], &mut y[..n]);
        }
        if w.stiffness != 0.0 {
            self.beam.add_stiffness_product(w.stiffness, &x[..n], &mut y[..n]);
        }
    }

    fn energy(&self, q: &[f64], v: &[f64]) -> Energy {
        let n = self.beam.dofs();
        let relative = self.beam.kinetic_energy(&v[..n]);
        let kinetic = self.supports.as_ref().map_or(relative, |supports| relative + supports.kinetic_energy(v));
        Energy { kinetic, elastic: self.beam.elastic_energy(&q[..n]), gravity: 0.0 }
    }

    fn place(&self, _body: u32, q: &[f64], local: &[Vector2<f64>], out: &mut [Vector2<f64>]) {
        let (q, position) = self.split(q);
        for (place, point) in out.iter_mut().zip(local) {
            let (w, slope) = self
                .beam
                .deflection_at(q, point.x.clamp(0.0, self.beam.spec().span))
                .map_or((0.0, 0.0), |d| (d.w, d.slope));
            let cos = (1.0 + slope * slope).sqrt().recip();
            let u = self.beam.axial_shape_clamped(point.x).displacement(q);
            *place = position + Vector2::new(point.x + u - point.y * slope * cos, w + point.y * cos);
        }
    }

    fn surface(&self, _: u32, q: &[f64], kinematics: Kinematics, at: &Vector2<f64>) -> Option<SurfacePoint<2>> {
        self.foot(q, kinematics, at)
    }

    /// The frame is taken to be that of the surface point: its normal (−sin ψ, cos ψ) says how the section stands, so that
    /// v_s = (−offset cos ψ·ψ̇, ẇ − offset sin ψ·ψ̇) with ψ̇ = ẇ' cos² ψ; for linear kinematics ψ = 0.
    fn rows(&self, _: u32, _q: &[f64], point: &Vector2<f64>, frame: &Frame<2>, out: &mut Rows<'_, 2>) -> usize {
        let shape = self.beam.shape_clamped(point.x);
        let (sin, cos) = (-frame[(0, 0)], frame[(0, 1)]);
        let up: Vector2<f64> = frame.column(1).into();
        if point.y == 0.0 {
            for k in 0..shape.len {
                out.columns[k] = shape.columns[k];
                out.values[k] = up * shape.n[k];
            }
        } else {
            let turn = frame * Vector2::new(-cos, -sin) * (point.y * cos * cos);
            for k in 0..shape.len {
                out.columns[k] = shape.columns[k];
                out.values[k] = up * shape.n[k] + turn * shape.dn[k];
            }
        }
        let axial = self.beam.axial_shape_clamped(point.x);
        let others = axial.columns[..axial.len].iter().zip(axial.n).map(|(column, n)| (*column, 0, n));
        let driven = self.driven().iter().enumerate().map(|(direction, column)| (*column, direction, 1.0));
        let mut len = shape.len;
        for (column, direction, n) in others.chain(driven) {
            out.columns[len] = column;
            out.values[len] = frame.column(direction) * n;
            len += 1;
        }
        len
    }

    fn factor(&self, w: Weights, _q: &[f64]) -> Result<Box<dyn Compliance<2>>, FactorError> {
        Ok(Box::new(BeamCompliance::new(&self.beam, w, self.backend)?))
    }
}

fn matrix_weights(w: Weights) -> MatrixWeights {
    MatrixWeights { mass: w.mass, damping: w.damping, stiffness: w.stiffness }
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_beam::{BeamSpec, Section, Support};

    #[test]
    fn the_ends_belong_to_the_beam_in_spite_of_rounding() {
        let beam = Beam::new(
            BeamSpec::new(0.2, 4, Section::new(1.0, 1.0).unwrap()).supported([Support::Pinned, Support::Free]),
        );
        let beam = Arc::new(beam.unwrap());
        let q = vec![0.0; beam.dofs()];
        for left in [0.0, 0.5, 0.6, -0.7, 1e3] {
            let body = BeamBody::new(Arc::clone(&beam), Vector2::new(left, 0.0), BeamSurface::Axis);
            let over = |x| body.surface(0, &q, Kinematics::Deformed, &Vector2::new(x, 0.0)).is_some();
            // 0.6 + 0.2 is 0.8, but 0.785 + 0.015 is one digit more.
            for end in [left, left + 0.2, left + 0.185 + 0.015] {
                assert!(over(end) && over(end.next_up()) && over(end.next_down()), "{left} {end}");
            }
            assert!(!over(left - 1e-9) && !over(left + 0.2 + 1e-9), "{left}");
        }
    }
}
