//! What a subsystem offers to a time scheme.

use crate::{Propagator, Stretching, Vector, small};
use std::ops::Range;
use teeter_contact::{Block, BlockSparse};
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

/// Why a matrix can't be factorised.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{mass} M + {damping} C + {stiffness} K can't be factorised: {reason}", mass = weights.mass, damping = weights.damping, stiffness = weights.stiffness)]
pub struct FactorError {
    /// The combination asked for.
    pub weights: Weights,
    /// Why not.
    pub reason: String,
}

/// `W = (mass·M + damping·C + stiffness·K)⁻¹` of one subsystem: W_be of the source paper for a
/// beam, diag(1/m, 1/m, 1/I) for a block.
pub trait Compliance<const D: usize>: Send + Sync {
    /// The combination whose inverse this is.
    fn weights(&self) -> Weights;

    /// Becomes the inverse of another combination; allocates nothing.
    ///
    /// # Errors
    /// If the matrix is not positive definite.
    fn refactor(&mut self, w: Weights, q: &[f64]) -> Result<(), FactorError>;

    /// Becomes the inverse of the same combination at coordinates `q`, whatever earlier updates
    /// there were; allocates nothing. A scheme calls it before it solves, with the coordinates at
    /// which it takes the internal forces, if the subsystem's matrices [follow its
    /// coordinates](Traits). If the matrix is not positive definite there, solutions must be NaN:
    /// the step then ends as diverged.
    fn update(&mut self, q: &[f64]) {
        let _ = q;
    }

    /// Becomes the inverse of `mass·M + damping·C + stiffness·(K + tension·G) + weight·g gᵀ`, with its
    /// own weights, of a subsystem that [stretches](Dynamics::stretching), whatever updates there were
    /// before; `tension` (N) and `weight` are at least 0. Allocates nothing. If the matrix is not
    /// positive definite, solutions must be NaN. The default leaves it as it is: right where nothing
    /// stretches.
    fn stretch(&mut self, tension: f64, weight: f64, g: &[f64]) {
        let _ = (tension, weight, g);
    }

    /// Becomes the inverse with K the tangent at `q`, the derivative of the internal force. The
    /// search for an equilibrium needs this, while [`Compliance::update`] may take another K for
    /// the sake of a step's energy. The default calls that.
    ///
    /// # Errors
    /// If the matrix is not positive definite.
    fn take_tangent(&mut self, q: &[f64]) -> Result<(), FactorError> {
        self.update(q);
        Ok(())
    }

    /// Whether W is diagonal, and [`Compliance::respond`] works without a [`Compliance::couple`] of
    /// the same rows before it. Contacts that share no velocity are then uncoupled, and many of
    /// them are solved island by island. `false`, the default, is always right.
    fn is_diagonal(&self) -> bool {
        false
    }

    /// `f ← W f`; zero for [driven and held](Traits) velocities, as their rows and columns of W are
    /// zero.
    fn solve(&mut self, f: &mut [f64]);

    /// Adds `J_i W J_jᵀ` for all pairs of rows to the Delassus operator. `scratch` is as long as
    /// the subsystem's velocities. The default solves once for each direction in which a contact
    /// can push; override it if W is known in closed form.
    fn couple(&mut self, rows: &PartRows<'_, D>, scratch: &mut [f64], h: &mut Coupling<'_, D>) {
        couple_by_solving(rows, scratch, h, |f| self.solve(f), |_, _, _| {});
    }

    /// Adds `W Jᵀ p` to the subsystem's velocities `v`, where p are the impulses of all contacts of
    /// the model (N·s), and the rows those that were [coupled](Compliance::couple) last. `scratch`
    /// is as long as `v`. The default solves once; override it if `couple` keeps its solutions.
    fn respond(&mut self, rows: &PartRows<'_, D>, p: &[Vector<D>], scratch: &mut [f64], v: &mut [f64]) {
        respond_by_solving(rows, p, scratch, v, |f| self.solve(f));
    }
}

/// Couples the rows by one solve for each direction in which a contact can push, and passes each
/// solution to `keep`, with contact and direction.
pub(crate) fn couple_by_solving<const D: usize>(
    rows: &PartRows<'_, D>,
    scratch: &mut [f64],
    h: &mut Coupling<'_, D>,
    mut solve: impl FnMut(&mut [f64]),
    mut keep: impl FnMut(usize, &Vector<D>, &[f64]),
) {
    for (j, columns_j, values_j) in rows.iter() {
        let mut column = |direction: &Vector<D>| {
            scratch.fill(0.0);
            for (&c, value) in columns_j.iter().zip(values_j) {
                scratch[c] += value.dot(direction);
            }
            solve(scratch);
            keep(j, direction, scratch);
            for (i, columns_i, values_i) in rows.iter() {
                let mut u = Vector::<D>::zeros();
                for (&c, value) in columns_i.iter().zip(values_i) {
                    u += value * scratch[c];
                }
                h.add(i, j, &(u * direction.transpose()));
            }
        };
        match common_direction(values_j) {
            Some(direction) => column(&direction),
            None => (0..D).for_each(|d| column(&Vector::<D>::from_fn(|r, _| f64::from(u8::from(r == d))))),
        }
    }
}

/// Adds W Jᵀ p to `v` by one solve.
pub(crate) fn respond_by_solving<const D: usize>(
    rows: &PartRows<'_, D>,
    p: &[Vector<D>],
    scratch: &mut [f64],
    v: &mut [f64],
    solve: impl FnOnce(&mut [f64]),
) {
    scratch.fill(0.0);
    rows.add_generalised_impulse(p, scratch);
    solve(scratch);
    v.iter_mut().zip(scratch.iter()).for_each(|(v, dv)| *v += dv);
}

/// The only direction in which a point can be pushed, if all its entries are parallel. So it is for
/// a beam touched on its axis, which moves up and down only, whatever the contact's frame.
fn common_direction<const D: usize>(values: &[Vector<D>]) -> Option<Vector<D>> {
    let longest = values.iter().max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))?;
    let direction = longest.try_normalize(0.0)?;
    let rounding = 4.0 * f64::EPSILON * longest.norm();
    values.iter().all(|value| (value - direction * value.dot(&direction)).norm() <= rounding).then_some(direction)
}

/// Where the rows of one side of a contact are stored; empty for a side that no impulse moves.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Span {
    pub(crate) part: usize,
    /// The first velocity of the part among those of the model.
    pub(crate) first: usize,
    pub(crate) start: usize,
    pub(crate) len: usize,
}

impl Span {
    /// Its places in the arena of rows.
    #[inline]
    pub(crate) fn range(&self) -> Range<usize> {
        self.start..self.start + self.len
    }
}

/// The rows of all active contacts that act on one subsystem.
#[derive(Clone, Copy, Debug)]
pub struct PartRows<'a, const D: usize> {
    pub(crate) part: usize,
    pub(crate) spans: &'a [[Span; 2]],
    pub(crate) columns: &'a [usize],
    pub(crate) values: &'a [Vector<D>],
}

impl<'a, const D: usize> PartRows<'a, D> {
    /// The rows: (contact, columns within the subsystem, entries). A contact between two bodies of
    /// the subsystem comes twice. Entries have the sign of their side.
    #[inline]
    pub fn iter(&self) -> impl Iterator<Item = (usize, &'a [usize], &'a [Vector<D>])> + use<'a, D> {
        let PartRows { part, spans, columns, values } = *self;
        // All sides in a row, as `flat_map` over contacts and sides took a tenth of a step's time.
        let sides = spans.as_flattened().iter().enumerate();
        sides
            .filter(move |(_, side)| side.part == part && side.len > 0)
            .map(move |(number, side)| (number / 2, &columns[side.range()], &values[side.range()]))
    }
}

impl<'a, const D: usize> PartRows<'a, D> {
    /// The row of the only contact, if there is one contact, and one of its sides acts on the
    /// subsystem: columns and entries.
    #[inline]
    pub fn only(&self) -> Option<(&'a [usize], &'a [Vector<D>])> {
        let [sides] = self.spans else { return None };
        let side = match sides.each_ref().map(|side| side.part == self.part && side.len > 0) {
            [true, false] => &sides[0],
            [false, true] => &sides[1],
            _ => return None,
        };
        Some((&self.columns[side.range()], &self.values[side.range()]))
    }
}

impl<const D: usize> PartRows<'_, D> {
    /// The row of a side of a contact, if it acts on the subsystem: columns and entries.
    #[must_use]
    pub fn get(&self, contact: usize, side: usize) -> Option<(&[usize], &[Vector<D>])> {
        let span = self.spans.get(contact)?.get(side)?;
        (span.part == self.part && span.len > 0).then(|| (&self.columns[span.range()], &self.values[span.range()]))
    }

    /// How many contacts there are, those that don't act on the subsystem among them: numbers of
    /// contacts are below it.
    #[must_use]
    pub fn contacts(&self) -> usize {
        self.spans.len()
    }

    /// Whether no contact acts on the subsystem.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.iter().next().is_none()
    }

    /// Adds W Jᵀ p to `v` for a diagonal W with entries `inverse`, and 0 beyond them:
    /// [`Compliance::respond`] of such a W.
    pub fn add_diagonal_response(&self, inverse: &[f64], p: &[Vector<D>], v: &mut [f64]) {
        for (contact, columns, values) in self.iter() {
            let p = &p[contact];
            for (&c, value) in columns.iter().zip(values) {
                if let Some(inverse) = inverse.get(c) {
                    v[c] += inverse * small::dot(value, p);
                }
            }
        }
    }

    /// Adds Jᵀ p to `f`, as long as the subsystem's velocities, with p the impulses of all contacts
    /// of the model, N·s.
    pub fn add_generalised_impulse(&self, p: &[Vector<D>], f: &mut [f64]) {
        for (contact, columns, values) in self.iter() {
            let p = &p[contact];
            for (&c, value) in columns.iter().zip(values) {
                f[c] += small::dot(value, p);
            }
        }
    }
}

/// The Delassus operator while subsystems add to it.
#[derive(Debug)]
pub struct Coupling<'a, const D: usize> {
    blocks: Blocks<'a, D>,
    /// Factor of what is added.
    scale: f64,
}

#[derive(Debug)]
enum Blocks<'a, const D: usize> {
    Dense { contacts: usize, blocks: &'a mut [Block<D>] },
    Sparse(&'a mut BlockSparse<D>),
}

impl<'a, const D: usize> Coupling<'a, D> {
    /// All blocks of so many contacts, by rows.
    pub(crate) fn dense(contacts: usize, blocks: &'a mut [Block<D>]) -> Self {
        Self { blocks: Blocks::Dense { contacts, blocks }, scale: 1.0 }
    }

    /// The blocks of contacts that share a body.
    pub(crate) fn sparse(blocks: &'a mut BlockSparse<D>) -> Self {
        Self { blocks: Blocks::Sparse(blocks), scale: 1.0 }
    }
}

impl<const D: usize> Coupling<'_, D> {
    /// Lets someone add with this factor.
    pub(crate) fn scaled(&mut self, factor: f64, add: impl FnOnce(&mut Self)) {
        let scale = self.scale;
        self.scale *= factor;
        add(self);
        self.scale = scale;
    }

    /// Adds to the block of contacts (i, j).
    #[inline(always)] // It is a few additions.
    pub fn add(&mut self, i: usize, j: usize, block: &Block<D>) {
        let block = block * self.scale;
        match &mut self.blocks {
            Blocks::Dense { contacts, blocks } => blocks[i * *contacts + j] += block,
            // Contacts that share nothing have no place in the pattern, and what they feel of each
            // other is 0.
            Blocks::Sparse(sparse) => {
                if let Some(sum) = sparse.block_mut(i, j) {
                    *sum += block;
                }
            }
        }
    }
}
