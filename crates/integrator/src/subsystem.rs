//! What a subsystem offers to a time scheme.

use crate::compliance::{Compliance, FactorError};
use crate::{Propagator, Stretching, Vector};
use teeter_detect::{Frame, HalfSpace, Kinematics, Summit, SurfacePoint};

/// The sizes of a subsystem.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Size {
    /// Coordinates.
    pub q: usize,
    /// Velocities.
    pub v: usize,
    /// Bodies, numbered from 0 within the subsystem.
    pub bodies: usize,
    /// Most non-zero columns in the Jacobian row of one point.
    pub row: usize,
}

/// The combination `mass·M + damping·C + stiffness·K` that a scheme asks for: the key by which
/// factors are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Weights {
    /// Factor of M; without unit.
    pub mass: f64,
    /// Factor of C, s.
    pub damping: f64,
    /// Factor of K, s².
    pub stiffness: f64,
}

impl Weights {
    /// M alone: that of impacts, and of explicit steps.
    pub const MASS: Self = Self { mass: 1.0, damping: 0.0, stiffness: 0.0 };
}

/// The energies of a subsystem or of a model, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Energy {
    /// ½ vᵀM v.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    pub kinetic: f64,
    /// Energy stored in deformation.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    pub elastic: f64,
    /// Potential energy of weight, from the origin's level.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    pub gravity: f64,
}

impl Energy {
    /// The sum, J.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.kinetic + self.elastic + self.gravity
    }
}

impl std::ops::AddAssign for Energy {
    fn add_assign(&mut self, other: Self) {
        self.kinetic += other.kinetic;
        self.elastic += other.elastic;
        self.gravity += other.gravity;
    }
}

/// The Jacobian rows of one point, for a subsystem to fill: the point's velocity in the contact's
/// frame is `Σ_k values[k] · v[columns[k]]`.
#[derive(Debug)]
#[non_exhaustive]
pub struct Rows<'a, const D: usize> {
    /// Columns, within the subsystem; as long as [`Size::row`].
    pub columns: &'a mut [usize],
    /// Entries, a D-vector (normal first) a column.
    pub values: &'a mut [Vector<D>],
}

impl<'a, const D: usize> Rows<'a, D> {
    /// Rows to fill, as long as [`Size::row`].
    pub fn new(columns: &'a mut [usize], values: &'a mut [Vector<D>]) -> Self {
        Self { columns, values }
    }
}

/// Properties of a subsystem that never change: a model asks for them once, when it is built.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Traits {
    /// Whether [`Dynamics::load`] adds anything.
    pub loaded: bool,
    /// Whether C is not zero.
    pub damped: bool,
    /// Whether M, C or K change with the coordinates, so that a step has to call
    /// [`Compliance::update`].
    pub follows_coordinates: bool,
    /// Numbers of the prescribed velocities, ascending: no force changes their motion.
    /// [`Dynamics::apply`] gives their coupling to the others by mass, damping and stiffness.
    pub driven: Vec<usize>,
    /// Numbers of the velocities that are always 0, ascending, such as those that a support holds.
    /// Rows and columns of W are 0 there, whatever [`Dynamics::apply`] gives.
    pub held: Vec<usize>,
    /// Its share of the smallest energy scale of the scene, J; m g R for a block.
    pub energy_scale: f64,
}

impl Traits {
    /// Neither loaded nor damped, with constant matrices, and all velocities free.
    #[must_use]
    pub fn free() -> Self {
        Self::default()
    }

    /// With loads.
    #[must_use]
    pub fn loaded(mut self, loaded: bool) -> Self {
        self.loaded = loaded;
        self
    }

    /// With damping.
    #[must_use]
    pub fn damped(mut self, damped: bool) -> Self {
        self.damped = damped;
        self
    }

    /// With matrices that change with the coordinates.
    #[must_use]
    pub fn following_coordinates(mut self, follows: bool) -> Self {
        self.follows_coordinates = follows;
        self
    }

    /// With these prescribed velocities.
    #[must_use]
    pub fn driven(mut self, velocities: impl Into<Vec<usize>>) -> Self {
        self.driven = velocities.into();
        self
    }

    /// With these velocities held at 0.
    #[must_use]
    pub fn held(mut self, velocities: impl Into<Vec<usize>>) -> Self {
        self.held = velocities.into();
        self
    }

    /// With this energy scale, J.
    #[must_use]
    pub fn energy_scale(mut self, scale: f64) -> Self {
        self.energy_scale = scale;
        self
    }
}

/// A mechanical model that contacts can act on: blocks, a beam, or a body of your own. It has no
/// state: `q` and `v` are its own slices of the [`State`](crate::State).
///
/// It has two roles: [`Dynamics`] says how it moves, [`Bodies`] where its bodies are. Every type
/// that implements both is a subsystem.
pub trait Subsystem<const D: usize>: Dynamics<D> + Bodies<D> {}

impl<const D: usize, S: Dynamics<D> + Bodies<D> + ?Sized> Subsystem<D> for S {}

/// How a subsystem moves: forces, products with M, C and K, energies, a factor. It gives values at
/// the coordinates that a scheme asks for; formulas of time integration belong to the scheme.
/// Methods that add to their last argument say so.
pub trait Dynamics<const D: usize>: Send + Sync {
    /// Its sizes; they never change.
    fn size(&self) -> Size;

    /// Its properties; they never change.
    fn traits(&self) -> Traits {
        Traits::free()
    }

    /// Adds the internal forces at (q, v) to `f`: elastic, viscous and weight, `−∂V/∂q − C v`. N
    /// (N·m for couples).
    fn internal_force(&self, q: &[f64], v: &[f64], f: &mut [f64]);

    /// Adds the external loads P(t) to `f`: all forces but weight that don't depend on the motion.
    /// A static start takes those at its time; steps take [`Dynamics::mean_load`].
    fn load(&self, t: f64, f: &mut [f64]) {
        let _ = (t, f);
    }

    /// Adds the mean of P over the time from `times[0]` to the later `times[1]` (s) to `f`. Steps
    /// use this, so that no impulse between their ends is lost. `scratch` is as long as the
    /// velocities, with arbitrary content.
    ///
    /// The default takes two Gauss points, which is exact for loads that are cubic in time. A load
    /// that jumps, has kinks or is shorter than a step needs a mean of its own, such as
    /// [`Signal::mean`](crate::Signal::mean).
    fn mean_load(&self, times: [f64; 2], scratch: &mut [f64], f: &mut [f64]) {
        let (middle, away) = (0.5 * (times[0] + times[1]), 0.5 * (times[1] - times[0]) / 3.0_f64.sqrt());
        for t in [middle - away, middle + away] {
            scratch.fill(0.0);
            self.load(t, scratch);
            f.iter_mut().zip(scratch.iter()).for_each(|(f, p)| *f += 0.5 * p);
        }
    }

    /// Writes the prescribed velocities at time `t` (s) into their places in `v`, and leaves the
    /// others unchanged.
    fn drive(&self, t: f64, v: &mut [f64]) {
        let _ = (t, v);
    }

    /// Writes the means of the prescribed velocities over the time from `times[0]` to the later
    /// `times[1]` (s) into their places in `v`, and leaves the others unchanged. The default takes
    /// the velocities at the middle of that time.
    fn drive_mean(&self, times: [f64; 2], v: &mut [f64]) {
        self.drive(0.5 * (times[0] + times[1]), v);
    }

    /// Writes the prescribed accelerations at time `t` (s) into their places in `a`, and leaves the
    /// others unchanged; whether it could. The default is `false`: a scheme that needs accelerations
    /// then refuses the subsystem if any of its velocities is prescribed.
    fn drive_rate(&self, t: f64, a: &mut [f64]) -> bool {
        let _ = (t, a);
        false
    }

    /// The first time after `t` (s) at which loads or prescribed velocities aren't smooth, s:
    /// infinity, the default, for none. A scheme of high order ends a step there.
    fn next_break(&self, t: f64) -> f64 {
        let _ = t;
        f64::INFINITY
    }

    /// How many loads there are whose breaks [`Dynamics::next_load_break`] tells apart; it never changes. One, the default, if it doesn't.
    fn load_count(&self) -> usize {
        1
    }

    /// The first time after `t` (s) at which load number `load` isn't smooth, s. A scheme that looks for jumps of loads compares the breaks of one
    /// load with each other. The default takes [`Dynamics::next_break`].
    fn next_load_break(&self, load: usize, t: f64) -> f64 {
        let _ = load;
        self.next_break(t)
    }

    /// vᵀC v, the power that damping dissipates, W. The default multiplies by C, in `scratch`,
    /// which is as long as the velocities; override it if the sum can be had for less.
    fn damping_power(&self, q: &[f64], v: &[f64], scratch: &mut [f64]) -> f64 {
        scratch.fill(0.0);
        self.apply(Weights { damping: 1.0, ..Weights::default() }, q, v, scratch);
        dot(v, scratch)
    }

    /// Adds `(mass·M + damping·C + stiffness·K) x` to `y`.
    fn apply(&self, w: Weights, q: &[f64], x: &[f64], y: &mut [f64]);

    /// `out = q ⊕ τ v`: the coordinates after moving with velocities `v` for the time `tau` (s). A
    /// velocity that is not finite must give a coordinate that isn't. The default is the sum q + τ
    /// v.
    fn retract(&self, q: &[f64], v: &[f64], tau: f64, out: &mut [f64]) {
        for ((out, q), v) in out.iter_mut().zip(q).zip(v) {
            *out = q + tau * v;
        }
    }

    /// The energies at (q, v).
    fn energy(&self, q: &[f64], v: &[f64]) -> Energy;

    /// Factorises `mass·M + damping·C + stiffness·K`, without the rows and columns of the [driven
    /// and held](Traits) velocities.
    ///
    /// # Errors
    /// If the matrix is not positive definite.
    fn factor(&self, w: Weights, q: &[f64]) -> Result<Box<dyn Compliance<D>>, FactorError>;

    /// Its motion over a time under constant forces in closed form; `None`, the default, where there
    /// is none: a step then takes the trapezoidal rule.
    fn propagator(&self) -> Option<Box<dyn Propagator<D>>> {
        None
    }

    /// The part of its potential that grows with the fourth power of a deflection, for a step that
    /// takes the mean of its tension over the step; `None`, the default, where there is none. The
    /// θ schemes take such a part implicitly, in rounds of [`Compliance::stretch`], and keep the
    /// energy itself; they don't ask for [`Linearised::modified_energy`] then. [`Dynamics::apply`]
    /// gives K without it, [`Dynamics::internal_force`] and [`Dynamics::energy`] with it.
    fn stretching(&self) -> Option<&dyn Stretching> {
        None
    }

    /// Extra information for a linearly implicit step, such as that of the θ schemes. `None`, the
    /// default, is always right for a quadratic potential.
    fn linearised(&self) -> Option<&dyn Linearised> {
        None
    }
}

/// Extra information for steps that use (M + hθC + h²θ²K)⁻¹, with K at q⁰ + hθv⁰.
pub trait Linearised: Send + Sync {
    /// α, 1/s, if C is αM and nothing else, and K doesn't change with the coordinates; else 0. Such
    /// a step has αM in its matrix and needs no product with C: it asks for
    /// [`Linearised::conservative_force`] instead.
    fn mass_damping(&self) -> f64 {
        0.0
    }

    /// α, 1/s, if C is αM among the velocities that aren't prescribed, and 0 towards those that are;
    /// else 0. The default is [`Linearised::mass_damping`]; it is more where that is 0 for the sake of
    /// prescribed velocities only.
    fn free_mass_damping(&self) -> f64 {
        self.mass_damping()
    }

    /// Adds the internal forces without the viscous one to `f`, N; called only if
    /// [`Linearised::mass_damping`] is not 0.
    fn conservative_force(&self, q: &[f64], f: &mut [f64]) {
        let _ = (q, f);
    }

    /// The difference between the energy that such a step of length `h` (s) with θ = ½ conserves,
    /// where only the subsystem's own forces act, and [`Dynamics::energy`], J. It is 0 for a
    /// quadratic potential and of order h² for any other; the energy account enters its change as
    /// numerical.
    fn modified_energy(&self, h: f64, q: &[f64], v: &[f64]) -> f64 {
        let _ = (h, q, v);
        0.0
    }
}

/// Where a subsystem's bodies are, and how their points move with its velocities. Bodies are
/// numbered within the subsystem.
pub trait Bodies<const D: usize>: Send + Sync {
    /// Places points that are fixed in one of its bodies: `out[k]` is where `local[k]` is in the
    /// world.
    fn place(&self, body: u32, q: &[f64], local: &[Vector<D>], out: &mut [Vector<D>]);

    /// The point of a body's surface that belongs to the world's point `at`, its foot; `None` where
    /// the body has no surface, or it doesn't extend that far. See [`teeter_detect::Geometry`].
    fn surface(&self, body: u32, q: &[f64], kinematics: Kinematics, at: &Vector<D>) -> Option<SurfacePoint<D>> {
        let _ = (body, q, kinematics, at);
        None
    }

    /// Whether a body has a surface, so that [`Bodies::surface`] can find points. The default is
    /// `false`: a model whose detector looks for one is refused then.
    fn has_surface(&self, body: u32) -> bool {
        let _ = body;
        false
    }

    /// A half space that contains all points whose gap to a body's surface is at most `margin` (m);
    /// `None`, the default, if none is known.
    fn reach(&self, body: u32, q: &[f64], margin: f64) -> Option<HalfSpace<D>> {
        let _ = (body, q, margin);
        None
    }

    /// A speed that no point of its bodies exceeds at velocities `v`, m/s, so that schemes that look for
    /// what may touch within a step needn't look further away. The default, infinity, is always right.
    fn fastest(&self, v: &[f64]) -> f64 {
        let _ = v;
        f64::INFINITY
    }

    /// Hands the points of a body's surface to `each`, from the left, at which it comes out furthest in
    /// a direction, more so than beside them, or is supported, and whose feet lie between those of two places; see
    /// [`teeter_detect::Geometry::summits`]. None, the default, for a surface that is flat and has no supports.
    fn summits(
        &self,
        body: u32,
        q: &[f64],
        direction: &Vector<D>,
        between: &[Vector<D>; 2],
        each: &mut dyn FnMut(Summit<D>),
    ) {
        let _ = (body, q, direction, between, each);
    }

    /// The points at which a body's surface ends, left and right; `None`, the default, where it
    /// doesn't.
    fn ends(&self, body: u32, q: &[f64]) -> [Option<SurfacePoint<D>>; 2] {
        let _ = (body, q);
        [None, None]
    }

    /// Fills the Jacobian rows of a body's point (in the body coordinates that detection uses) in
    /// `frame`, and returns the number of columns used. The previous content of `out` is arbitrary.
    /// The point's velocity is rows · v, with prescribed velocities included in v.
    fn rows(&self, body: u32, q: &[f64], point: &Vector<D>, frame: &Frame<D>, out: &mut Rows<'_, D>) -> usize;

    /// J̇ v of a body's point, with `frame` held fixed, m/s²: the part of its acceleration that
    /// comes from the velocities; rows · v̇ is the other. `None`, the default, if it isn't known: a
    /// scheme that needs accelerations then refuses the subsystem.
    fn bias(&self, body: u32, q: &[f64], v: &[f64], point: &Vector<D>, frame: &Frame<D>) -> Option<Vector<D>> {
        let _ = (body, q, v, point, frame);
        None
    }
}

/// Whether all numbers are: 0 · x is 0 for those that are, and NaN for the others.
#[inline(always)]
pub(crate) fn all_finite(x: &[f64]) -> bool {
    let (fours, rest) = x.as_chunks::<4>();
    let mut sums = [0.0; 4];
    for x in fours {
        for k in 0..4 {
            sums[k] += 0.0 * x[k];
        }
    }
    sums.iter().sum::<f64>() + rest.iter().map(|x| 0.0 * x).sum::<f64>() == 0.0
}

/// xᵀy in four independent sums: in a single one each addition would wait for the last.
pub(crate) fn dot(x: &[f64], y: &[f64]) -> f64 {
    let ((x, x_rest), (y, y_rest)) = (x.as_chunks::<4>(), y.as_chunks::<4>());
    let mut sums = [0.0; 4];
    for (x, y) in x.iter().zip(y) {
        for k in 0..4 {
            sums[k] += x[k] * y[k];
        }
    }
    let rest: f64 = x_rest.iter().zip(y_rest).map(|(x, y)| x * y).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}
