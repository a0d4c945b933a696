//! A beam as a subsystem: the adapter above `teeter-beam`, with the contact kinematics of
//! `docs/theory.md` §3.

mod compliance;
pub(crate) mod forces;
pub(crate) mod line;
pub(crate) mod loads;
pub(crate) mod motion;
mod shared;

use super::modal_motion::ModalMotion;
use crate::{
    Bodies, Compliance, Dynamics, Energy, FactorError, Linearised, Motion, Propagator, Rows, Size, Stretching, Traits,
    Vector, Weights,
};
use compliance::BeamCompliance;
pub use compliance::WBackend;
use line::{Deflecting, Line};
pub use loads::{MovingForce, SignalLoad};
use motion::MovingSupports;
use nalgebra::Vector2;
pub use shared::SharedFactors;
use std::sync::Arc;
use teeter_beam::{Beam, Deflection, InnerSupport, Load, MatrixWeights};
use teeter_detect::{Frame, HalfSpace, Kinematics, Summit, SurfacePoint};

/// A beam with more dofs has no motion in closed form: the time that a step takes grows with their
/// square.
const MOST_DOFS: usize = 100;

/// The fibre of a beam that is its contact surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BeamSurface {
    /// The axis: contact forces do no work on the rotation of sections.
    Axis,
    /// The top fibre, half a thickness (m) above the axis.
    Top {
        /// Distance of the fibre from the axis, m.
        offset: f64,
    },
}

impl BeamSurface {
    pub(crate) fn offset(self) -> f64 {
        match self {
            Self::Axis => 0.0,
            Self::Top { offset } => offset,
        }
    }
}

/// A side of a beam that others touch, by its [body](Self::body); or whose points touch others, by
/// its [fibre](Self::fibre).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BeamFace {
    /// What lies on the beam touches it.
    Upper,
    /// What is under it touches it: the axis, or the bottom fibre where the [surface](BeamSurface)
    /// is the top one.
    Lower,
}

impl BeamFace {
    /// How many bodies a beam is: two of each face.
    pub const BODIES: usize = 4;

    /// The number of the body, within the beam's, that has the face as its surface: points of
    /// others touch it.
    #[must_use]
    pub fn body(self) -> u32 {
        match self {
            Self::Upper => 0,
            Self::Lower => 1,
        }
    }

    /// The number of the body that has the points of the face: they touch sides of others.
    #[must_use]
    pub fn fibre(self) -> u32 {
        self.body() + 2
    }

    pub(crate) fn of_body(body: u32) -> Self {
        if body.is_multiple_of(2) { Self::Upper } else { Self::Lower }
    }

    pub(crate) fn is_fibre(body: u32) -> bool {
        body >= 2
    }
}

/// A straight level beam in the world.
///
/// It is four bodies, by [face](BeamFace): the upper one is the first. Its coordinates are those of
/// [`Beam`]. If its supports [move](Self::with_motion), deflections are relative to them, and the
/// displacements x and y of the supports follow as two more, prescribed coordinates.
pub struct BeamBody {
    beam: Arc<Beam>,
    position: Vector2<f64>,
    surface: BeamSurface,
    loads: Vec<Box<dyn Load>>,
    supports: Option<MovingSupports>,
    held: Vec<usize>,
    backend: WBackend,
    factors: Option<Arc<SharedFactors>>,
    weight: Option<SelfWeight>,
}

/// Gravity on a beam: the force on each of its coordinates, those of moving supports at the end.
struct SelfWeight {
    force: Vec<f64>,
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
        Self {
            beam,
            position,
            surface,
            loads: Vec::new(),
            supports: None,
            held,
            backend: WBackend::Auto,
            factors: None,
            weight: None,
        }
    }

    /// Adds a load.
    #[must_use]
    pub fn with_load(mut self, load: Box<dyn Load>) -> Self {
        self.loads.push(load);
        self
    }

    /// Makes the supports move together, by these motions in x and y. The beam's damping acts on
    /// the motion relative to them, and the force that moves them carries the supports' share of
    /// all loads on the beam.
    #[must_use]
    pub fn with_motion(mut self, motion: [Motion; 2]) -> Self {
        self.supports = Some(MovingSupports::new(&self.beam, motion));
        self
    }

    /// Lets gravity (m/s², x and y) act on the beam and on the masses that it carries; deflections
    /// then count from the straight axis. Weight enters as a potential ([`Energy::gravity`]), not
    /// as a load that does work.
    #[must_use]
    pub fn with_weight(mut self, gravity: Vector2<f64>) -> Self {
        let (mut force, supports) = weight(&self.beam, gravity);
        force.extend(supports);
        self.weight = Some(SelfWeight { force });
        self
    }

    /// Chooses how W is stored.
    #[must_use]
    pub fn with_backend(mut self, backend: WBackend) -> Self {
        self.backend = backend;
        self
    }

    /// Takes its factors from those that other models with the same beam have made, and leaves there
    /// what it makes: the motion is the same to the last bit. Those of another beam are not taken.
    /// By default it makes its own.
    #[must_use]
    pub fn with_factors(mut self, factors: Arc<SharedFactors>) -> Self {
        self.factors = Arc::ptr_eq(factors.beam(), &self.beam).then_some(factors);
        self
    }

    /// The displacements of its supports at time `t` (s) in closed form, m; at t = 0 those to start
    /// from. Empty for supports that stand still.
    #[must_use]
    pub fn displacements(&self, t: f64) -> Vec<f64> {
        self.supports.as_ref().map_or_else(Vec::new, |supports| supports.displacements(t).to_vec())
    }

    /// Its prescribed velocities.
    fn driven(&self) -> &[usize] {
        self.supports.as_ref().map_or(&[], |supports| &supports.driven)
    }

    /// The coordinates of the beam alone, and where its supports have moved it.
    fn split<'q>(&self, q: &'q [f64]) -> (&'q [f64], Line) {
        let (q, displaced) = q.split_at(self.beam.dofs());
        (q, Line::new(self.position, displaced, self.surface))
    }

    /// Adds the elastic force and the weight.
    fn add_conservative_force(&self, q: &[f64], f: &mut [f64]) {
        let n = self.beam.dofs();
        self.beam.add_elastic_force(&q[..n], &mut f[..n]);
        self.add_weight(f);
    }

    fn add_weight(&self, f: &mut [f64]) {
        if let Some(weight) = &self.weight {
            // The supports have coordinates only if they move.
            f.iter_mut().zip(&weight.force).for_each(|(f, weight)| *f += weight);
        }
    }

    /// The beam.
    #[must_use]
    pub fn beam(&self) -> &Arc<Beam> {
        &self.beam
    }
}

/// Gravity on the dofs of a beam, and on coordinates x and y that move all of it.
pub(crate) fn weight(beam: &Beam, gravity: Vector2<f64>) -> (Vec<f64>, [f64; 2]) {
    let n = beam.dofs();
    let mut force = vec![0.0; n];
    // The vector has the right length, so there is no error to pass on; the state's check reports a
    // gravity that isn't finite.
    let _ = beam.add_self_weight(gravity.y, &mut force);
    if beam.has_axial_dofs() {
        let mut along = vec![0.0; n];
        along[2 * beam.nodes()..].fill(1.0);
        beam.add_mass_product(gravity.x, &along, &mut force);
    }
    let mass = beam.total_mass();
    (force, [mass * gravity.x, mass * gravity.y])
}

impl Deflecting for Beam {
    fn span(&self) -> f64 {
        self.spec().span
    }

    fn nodes(&self) -> &[f64] {
        self.node_positions()
    }

    fn inner_supports(&self) -> &[InnerSupport] {
        &self.spec().inner_supports
    }

    fn deflection_at(&self, q: &[f64], x: f64) -> Option<Deflection> {
        Beam::deflection_at(self, q, x)
    }

    fn shape(&self, x: f64, mut each: impl FnMut(usize, f64, f64)) {
        let shape = self.shape_clamped(x);
        for k in 0..shape.len {
            each(shape.columns[k], shape.n[k], shape.dn[k]);
        }
    }

    fn has_axial_dofs(&self) -> bool {
        Beam::has_axial_dofs(self)
    }

    fn axial_displacement(&self, q: &[f64], x: f64) -> f64 {
        self.axial_shape_clamped(x).displacement(q)
    }

    fn axial_shape(&self, x: f64, mut each: impl FnMut(usize, f64)) {
        let axial = self.axial_shape_clamped(x);
        for k in 0..axial.len {
            each(axial.columns[k], axial.n[k]);
        }
    }
}

impl Dynamics<2> for BeamBody {
    fn size(&self) -> Size {
        let driven = self.driven().len();
        let dofs = self.beam.dofs() + driven;
        let axial = if self.beam.has_axial_dofs() { 2 } else { 0 };
        Size { q: dofs, v: dofs, bodies: BeamFace::BODIES, row: 4 + axial + driven }
    }

    fn traits(&self) -> Traits {
        Traits::free()
            .loaded(!self.loads.is_empty())
            .damped(self.beam.is_damped())
            .following_coordinates(self.beam.is_stretched())
            .driven(self.driven())
            .held(self.held.clone())
    }

    fn internal_force(&self, q: &[f64], v: &[f64], f: &mut [f64]) {
        let n = self.beam.dofs();
        self.add_conservative_force(q, f);
        if self.beam.is_damped() {
            self.beam.add_damping_product(-1.0, &v[..n], &mut f[..n]);
        }
    }

    fn load(&self, t: f64, f: &mut [f64]) {
        for load in &self.loads {
            load.add(&self.beam, t, &mut f[..self.beam.dofs()]);
        }
    }

    fn mean_load(&self, times: [f64; 2], scratch: &mut [f64], f: &mut [f64]) {
        let n = self.beam.dofs();
        for load in &self.loads {
            load.add_mean(&self.beam, times, &mut scratch[..n], &mut f[..n]);
        }
    }

    fn drive(&self, t: f64, v: &mut [f64]) {
        if let Some(supports) = &self.supports {
            v[self.beam.dofs()..].copy_from_slice(&supports.velocities(t));
        }
    }

    fn drive_rate(&self, t: f64, a: &mut [f64]) -> bool {
        if let Some(supports) = &self.supports {
            a[self.beam.dofs()..].copy_from_slice(&supports.accelerations(t));
        }
        true
    }

    fn next_break(&self, t: f64) -> f64 {
        let loads = self.loads.iter().map(|load| load.next_break(&self.beam, t));
        let supports = self.supports.iter().map(|supports| supports.next_break(t));
        loads.chain(supports).fold(f64::INFINITY, f64::min)
    }

    fn load_count(&self) -> usize {
        self.loads.len()
    }

    fn next_load_break(&self, load: usize, t: f64) -> f64 {
        self.loads.get(load).map_or(f64::INFINITY, |load| load.next_break(&self.beam, t))
    }

    fn drive_mean(&self, times: [f64; 2], v: &mut [f64]) {
        if let Some(supports) = &self.supports {
            v[self.beam.dofs()..].copy_from_slice(&supports.mean_velocities(times));
        }
    }

    fn damping_power(&self, _q: &[f64], v: &[f64], _scratch: &mut [f64]) -> f64 {
        self.beam.damping_power(&v[..self.beam.dofs()])
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
        let along: f64 =
            self.weight.iter().flat_map(|weight| weight.force.iter().zip(q)).map(|(force, q)| force * q).sum();
        Energy { kinetic, elastic: self.beam.elastic_energy(&q[..n]), gravity: 0.0 - along }
    }

    fn factor(&self, w: Weights, _q: &[f64]) -> Result<Box<dyn Compliance<2>>, FactorError> {
        Ok(Box::new(BeamCompliance::new(&self.beam, w, self.backend, self.factors.as_ref())?))
    }

    fn propagator(&self) -> Option<Box<dyn Propagator<2>>> {
        // What moves the supports acts on all modes, and its share isn't constant over a step.
        let is_linear = self.supports.is_none() && !self.beam.is_stretched();
        if !is_linear || self.beam.dofs() > MOST_DOFS {
            return None;
        }
        let none = vec![0.0; self.beam.dofs()];
        let mut constant = none.clone();
        self.internal_force(&none, &none, &mut constant);
        Some(Box::new(ModalMotion::of_beam(&self.beam, &constant)?))
    }

    fn stretching(&self) -> Option<&dyn Stretching> {
        if self.beam.is_stretched() { Some(self) } else { None }
    }

    fn linearised(&self) -> Option<&dyn Linearised> {
        Some(self)
    }
}

impl Bodies<2> for BeamBody {
    fn place(&self, _body: u32, q: &[f64], local: &[Vector2<f64>], out: &mut [Vector2<f64>]) {
        let (q, line) = self.split(q);
        line.place(&*self.beam, q, local, out);
    }

    fn has_surface(&self, _body: u32) -> bool {
        true
    }

    fn surface(&self, body: u32, q: &[f64], kinematics: Kinematics, at: &Vector2<f64>) -> Option<SurfacePoint<2>> {
        let (q, line) = self.split(q);
        line.of_body(body).foot(&*self.beam, q, kinematics, at)
    }

    fn reach(&self, body: u32, q: &[f64], margin: f64) -> Option<HalfSpace<2>> {
        let (q, line) = self.split(q);
        // Nobody has asked how far down a beam hangs.
        match BeamFace::of_body(body) {
            BeamFace::Upper => Some(line.reach(self.beam.deflection_bounds(q), margin)),
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
        line.of_body(body).summits(&*self.beam, q, direction, between, each);
    }

    fn ends(&self, body: u32, q: &[f64]) -> [Option<SurfacePoint<2>>; 2] {
        let (q, line) = self.split(q);
        line.of_body(body).ends(&*self.beam, q)
    }

    fn bias(&self, _: u32, q: &[f64], v: &[f64], point: &Vector2<f64>, frame: &Frame<2>) -> Option<Vector<2>> {
        let n = self.split(q).0.len();
        line::bias(&*self.beam, [&q[..n], &v[..n]], point, frame)
    }

    fn rows(&self, body: u32, q: &[f64], point: &Vector2<f64>, frame: &Frame<2>, out: &mut Rows<'_, 2>) -> usize {
        line::rows(&*self.beam, (body, self.split(q).0), point, frame, self.driven(), out)
    }
}

impl Linearised for BeamBody {
    fn mass_damping(&self) -> f64 {
        if self.supports.is_some() || self.beam.is_stretched() { 0.0 } else { self.beam.mass_damping() }
    }

    fn free_mass_damping(&self) -> f64 {
        if self.beam.is_stretched() { 0.0 } else { self.beam.mass_damping() }
    }

    fn conservative_force(&self, q: &[f64], f: &mut [f64]) {
        self.add_conservative_force(q, f);
    }

    fn modified_energy(&self, h: f64, q: &[f64], v: &[f64]) -> f64 {
        let n = self.beam.dofs();
        if self.beam.is_stretched() { self.beam.modified_energy(h, &q[..n], &v[..n]) } else { 0.0 }
    }
}

impl Stretching for BeamBody {
    fn stiffness(&self) -> f64 {
        self.beam.stretching_stiffness()
    }

    fn form(&self, x: &[f64], y: &[f64]) -> f64 {
        let n = self.beam.dofs();
        self.beam.slope_form(&x[..n], &y[..n])
    }

    fn add_product(&self, a: f64, x: &[f64], y: &mut [f64]) {
        let n = self.beam.dofs();
        self.beam.add_slope_product(a, &x[..n], &mut y[..n]);
    }

    fn force_beside(&self, q: &[f64], v: &[f64], f: &mut [f64]) {
        let n = self.beam.dofs();
        self.beam.add_stiffness_product(-1.0, &q[..n], &mut f[..n]);
        self.add_weight(f);
        if self.beam.is_damped() {
            self.beam.add_damping_product(-1.0, &v[..n], &mut f[..n]);
        }
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
