//! Harnesses for implementations from outside (feature `conformance`): one for every plane
//! [`Subsystem`] with its [`Compliance`], and one for [schemes](check_scheme).
//!
//! A subsystem is checked against the documentation of its traits, by finite differences and by
//! products written out here. Properties that fail are returned as a list, with numbers:
//!
//! ```
//! use nalgebra::Vector2;
//! use teeter_integrator::conformance::{Case, check};
//! use teeter_integrator::{Block, Blocks, Weights};
//! use teeter_rigid::{MassProperties, Rectangle};
//!
//! let shape = Rectangle::new(0.1, 0.2)?;
//! let block = Block::new(MassProperties::rectangle(&shape, 0.1, 2700.0)?, &shape);
//! let failures = check(&Blocks::new(vec![block], Vector2::new(0.0, -9.81)), &Case {
//!     q: vec![0.3, 0.1, 0.2],
//!     weights: Weights { mass: 1.0, damping: 0.0, stiffness: 0.0 },
//!     points: shape.corners().iter().map(|corner| (0, *corner)).collect(),
//!     ..Case::default()
//! });
//! assert_eq!(failures, []);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod scheme;
mod tension;

pub use scheme::{Made, SchemeFailure, SchemeProperty, check_scheme};

use crate::compliance::Span;
use crate::subsystem::dot;
use crate::{Compliance, Coupling, PartRows, Rows, Subsystem, Traits, Vector, Weights};
use teeter_contact::Block;
use teeter_detect::{Frame, Kinematics, plane_frame};

/// Where a subsystem is checked.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Case {
    /// Coordinates; deformed ones for elastic bodies.
    pub q: Vec<f64>,
    /// A time, s, for loads and prescribed velocities.
    pub t: f64,
    /// The combination that a step would ask for.
    pub weights: Weights,
    /// Points of bodies in their own coordinates that can touch in any frame, such as corners.
    pub points: Vec<(u32, Vector<2>)>,
    /// Places in the world whose foot on a body's surface can touch, in the frame of the surface.
    pub places: Vec<(u32, Vector<2>)>,
}

/// What must hold for a subsystem.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Property {
    /// Vectors and rows are as long as [`Dynamics::size`](crate::Dynamics::size) says, numbers of
    /// velocities ascend and are within it.
    Sizes,
    /// `q ⊕ 0` is q, and `⊕ −τ v` undoes `⊕ τ v`.
    Retract,
    /// Only driven velocities are written, and with finite numbers.
    Drive,
    /// Loads only if its [traits](Traits) say so, and added to the previous content.
    Load,
    /// The foot of a place is where [`Bodies::place`](crate::Bodies::place) puts its material
    /// point.
    Foot,
    /// Rows are the derivative of places.
    Rows,
    /// Where [`Bodies::bias`](crate::Bodies::bias) is known, it is the second derivative of places
    /// at constant velocities.
    Bias,
    /// M, C and K are symmetric, and a combination is their weighted sum, added to the previous
    /// content.
    Product,
    /// C is zero unless its [traits](Traits) say that it is damped, and vᵀC v is the damping's
    /// power.
    Damping,
    /// T is ½ vᵀM v.
    KineticEnergy,
    /// The internal force is minus the derivative of V, and minus C v.
    Force,
    /// The matrix can be factorised, and W is its inverse; driven and held velocities get 0.
    Inverse,
    /// A refactored factor equals a new one; an update doesn't depend on earlier updates.
    Refactor,
    /// What [stretches](crate::Dynamics::stretching): G is symmetric, the forces beside the tension
    /// −κ (qᵀG q) G q are all others, and a stretched factor is the inverse of its matrix.
    Stretching,
    /// The coupling of rows is J W Jᵀ, whatever was coupled before.
    Couple,
    /// The response to impulses is W Jᵀ p.
    Respond,
}

/// A property that doesn't hold.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{property:?}: {what}: off by {error:e}, where {allowed:e} is allowed")]
pub struct Failure {
    /// Which.
    pub property: Property,
    /// Where.
    pub what: String,
    /// The error, in the unit of the compared quantity.
    pub error: f64,
    /// The error that rounding or a finite difference may cause.
    pub allowed: f64,
}

/// Rounding, relative to the largest term.
const ROUNDING: f64 = 1e-12;
/// The same after a solve, which multiplies it by the matrix's condition: up to 1e7 for that of a
/// step.
const SOLVED: f64 = 1e-8;
/// Error of finite differences over four points, relative to the largest slope; of fourth order, as
/// slopes change fast in a short element.
const DIFFERENCE: f64 = 1e-7;
/// Spacing of those points: the time for which a unit velocity acts, s.
const STEP: f64 = 1e-5;
/// As [`STEP`], of second derivatives.
const BEND: f64 = 1e-3;

/// Checks all [properties](Property) of a subsystem, and returns those that fail.
#[must_use]
pub fn check(system: &dyn Subsystem<2>, case: &Case) -> Vec<Failure> {
    let mut check = Check { system, case, failures: Vec::new() };
    if check.sizes() {
        check.retract();
        check.drive();
        check.load();
        check.matrices();
    }
    check.failures
}

/// Numbers of size 1 without a symmetry that could hide errors.
fn wave(length: usize, phase: f64) -> Vec<f64> {
    (0..length).map(|k| (1.3 * k as f64 + phase).sin()).collect()
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |largest, x| x.abs().max(largest))
}

/// The largest difference; NaN where one is.
fn distance(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).fold(0.0, |largest, (x, y)| if (x - y).abs() <= largest { largest } else { (x - y).abs() })
}

/// The derivative at 0.
fn derivative<T>(f: impl Fn(f64) -> T) -> T
where
    T: std::ops::Sub<Output = T> + std::ops::Mul<f64, Output = T>,
{
    let difference = |step: f64| (f(step) - f(-step)) * (0.5 / step);
    difference(STEP) * (4.0 / 3.0) - difference(2.0 * STEP) * (1.0 / 3.0)
}

struct Check<'a> {
    system: &'a dyn Subsystem<2>,
    case: &'a Case,
    failures: Vec<Failure>,
}

/// Rows of a point in a frame, with the point's place in the body.
struct Touch {
    body: u32,
    point: Vector<2>,
    frame: Frame<2>,
    columns: Vec<usize>,
    values: Vec<Vector<2>>,
}

impl Check<'_> {
    /// Records a failure if `error` is more than `allowed`, or NaN.
    fn hold(&mut self, property: Property, what: impl Into<String>, error: f64, allowed: f64) {
        if !(error <= allowed) {
            self.failures.push(Failure { property, what: what.into(), error, allowed });
        }
    }

    fn sizes(&mut self) -> bool {
        let (size, Traits { driven, held, .. }) = (self.system.size(), self.system.traits());
        let count = |is: bool| f64::from(u8::from(!is));
        self.hold(Property::Sizes, "coordinates of the case", self.case.q.len().abs_diff(size.q) as f64, 0.0);
        for (which, numbers) in [("driven", &driven), ("held", &held)] {
            let good = numbers.is_sorted_by(|a, b| a < b) && numbers.iter().all(|k| *k < size.v);
            self.hold(Property::Sizes, format!("{which} velocities ascend and are there"), count(good), 0.0);
        }
        let bodies = self.case.points.iter().chain(&self.case.places).all(|(body, _)| (*body as usize) < size.bodies);
        self.hold(Property::Sizes, "bodies of the case", count(bodies), 0.0);
        self.failures.is_empty()
    }

    fn moved(&self, v: &[f64], tau: f64) -> Vec<f64> {
        let mut q = vec![f64::NAN; self.case.q.len()];
        self.system.retract(&self.case.q, v, tau, &mut q);
        q
    }

    fn retract(&mut self) {
        let q = &self.case.q;
        let v = wave(self.system.size().v, 0.4);
        self.hold(Property::Retract, "by no time", distance(&self.moved(&v, 0.0), q), ROUNDING * largest(q));
        let (there, mut back) = (self.moved(&v, 0.1), vec![f64::NAN; q.len()]);
        self.system.retract(&there, &v, -0.1, &mut back);
        self.hold(Property::Retract, "there and back", distance(&back, q), ROUNDING * (largest(q) + 1.0));
    }

    fn drive(&mut self) {
        let Traits { driven, .. } = self.system.traits();
        let mut v = wave(self.system.size().v, 0.9);
        let before = v.clone();
        self.system.drive(self.case.t, &mut v);
        let mut mean = before.clone();
        self.system.drive_mean([self.case.t, self.case.t + 0.25], &mut mean);
        for v in [v, mean] {
            for k in 0..v.len() {
                if driven.contains(&k) {
                    self.hold(Property::Drive, format!("velocity {k} is finite"), 0.0 * v[k], 0.0);
                } else {
                    self.hold(Property::Drive, format!("velocity {k} is free"), (v[k] - before[k]).abs(), 0.0);
                }
            }
        }
    }

    fn load(&mut self) {
        let n = self.system.size().v;
        let (mut load, mut added) = (vec![0.0; n], wave(n, 0.2));
        self.system.load(self.case.t, &mut load);
        self.system.load(self.case.t, &mut added);
        let size = largest(&load);
        added.iter_mut().zip(wave(n, 0.2)).for_each(|(f, before)| *f -= before);
        self.hold(Property::Load, "adds", distance(&added, &load), ROUNDING * (size + 1.0));
        let times = [self.case.t, self.case.t + 0.25];
        let (mut mean, mut twice, mut scratch) = (vec![0.0; n], vec![0.0; n], vec![f64::NAN; n]);
        self.system.mean_load(times, &mut scratch, &mut mean);
        for _ in 0..2 {
            self.system.mean_load(times, &mut scratch, &mut twice);
        }
        let size = size.max(largest(&mean));
        mean.iter_mut().for_each(|f| *f *= 2.0);
        self.hold(Property::Load, "the mean adds", distance(&twice, &mean), ROUNDING * (size + 1.0));
        if !self.system.traits().loaded {
            self.hold(Property::Load, "no load", size, 0.0);
        }
    }

    fn product(&self, w: Weights, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        self.system.apply(w, &self.case.q, x, &mut y);
        y
    }

    /// Checks M, C, K and W against each other.
    fn matrices(&mut self) {
        let (w, n) = (self.case.weights, self.system.size().v);
        let mut factor = match self.system.factor(w, &self.case.q) {
            Ok(factor) => factor,
            Err(error) => {
                return self.hold(Property::Inverse, error.to_string(), f64::INFINITY, 0.0);
            }
        };
        let Traits { driven, held, .. } = self.system.traits();
        let moves = |k: usize| !held.contains(&k);
        let free = |k: usize| moves(k) && !driven.contains(&k);
        let masked = |phase: f64, keep: &dyn Fn(usize) -> bool| -> Vec<f64> {
            wave(n, phase).iter().enumerate().map(|(k, x)| if keep(k) { *x } else { 0.0 }).collect()
        };
        let moving: Vec<usize> = (0..n).filter(|&k| moves(k)).collect();
        let (x, y, inner) = (masked(0.4, &moves), masked(1.1, &moves), masked(0.7, &free));
        let mut response = wave(n, 0.3);
        factor.solve(&mut response);
        let still = (0..n).filter(|&k| !free(k)).fold(0.0, |still: f64, k| still.max(response[k].abs()));
        self.hold(Property::Inverse, "driven and held velocities get nothing", still, 0.0);
        self.products(&x, &y);
        self.energies(&x, &moving);
        self.inverse(factor.as_mut(), &inner);
        self.refactor(&inner);
        self.tension(&x, &y, &inner);
        if let Some(touches) = self.touches() {
            touches.iter().for_each(|touch| self.rows(touch, &moving));
            touches.iter().for_each(|touch| self.bias(touch));
            self.contacts(factor.as_mut(), &touches);
        }
    }

    fn products(&mut self, x: &[f64], y: &[f64]) {
        let parts = [("M", 1.0, 0.0, 0.0), ("C", 0.0, 1.0, 0.0), ("K", 0.0, 0.0, 1.0)];
        let given = self.case.weights;
        let mut sum = vec![0.0; x.len()];
        let mut size = 0.0_f64;
        for (name, mass, damping, stiffness) in parts {
            let w = Weights { mass, damping, stiffness };
            let (a, b) = (self.product(w, x), self.product(w, y));
            let allowed = ROUNDING * (1.0 + x.len() as f64) * largest(&a).max(largest(&b));
            self.hold(Property::Product, format!("{name} is symmetric"), (dot(&a, y) - dot(&b, x)).abs(), allowed);
            let factor = mass * given.mass + damping * given.damping + stiffness * given.stiffness;
            sum.iter_mut().zip(&a).for_each(|(sum, a)| *sum += factor * a);
            size = size.max(factor.abs() * largest(&a));
            if damping != 0.0 {
                let power = self.system.damping_power(&self.case.q, x, &mut vec![0.0; x.len()]);
                self.hold(Property::Damping, "power", (power - dot(&a, x)).abs(), allowed);
                if !self.system.traits().damped {
                    self.hold(Property::Damping, "none is said to be there", largest(&a), 0.0);
                }
            }
        }
        let mut added = y.to_vec();
        self.system.apply(given, &self.case.q, x, &mut added);
        added.iter_mut().zip(y).for_each(|(f, before)| *f -= before);
        self.hold(Property::Product, "the sum, added", distance(&added, &sum), ROUNDING * (size + 1.0));
    }

    fn energies(&mut self, x: &[f64], moving: &[usize]) {
        let (system, q) = (self.system, &self.case.q);
        let mass = Weights { mass: 1.0, ..Weights::default() };
        let momentum = self.product(mass, x);
        let kinetic = system.energy(q, x).kinetic;
        let allowed = ROUNDING * (1.0 + x.len() as f64) * largest(&momentum);
        self.hold(Property::KineticEnergy, "½ vᵀM v", (kinetic - 0.5 * dot(&momentum, x)).abs(), allowed);

        let rest = vec![0.0; x.len()];
        let force = |v: &[f64]| {
            let mut f = vec![0.0; v.len()];
            system.internal_force(q, v, &mut f);
            f
        };
        let (elastic, with_damping) = (force(&rest), force(x));
        let viscous: Vec<f64> = with_damping.iter().zip(&elastic).map(|(a, b)| b - a).collect();
        let expected = self.product(Weights { damping: 1.0, ..Weights::default() }, x);
        let size = largest(&elastic).max(largest(&expected));
        self.hold(Property::Force, "viscous", distance(&viscous, &expected), ROUNDING * (size + 1.0));
        for &k in moving {
            let mut direction = rest.clone();
            direction[k] = 1.0;
            let potential = |tau: f64| {
                let energy = system.energy(&self.moved(&direction, tau), &rest);
                energy.elastic + energy.gravity
            };
            let slope = derivative(potential);
            let rounding = f64::EPSILON * (potential(-STEP).abs() + potential(STEP).abs()) / STEP;
            let allowed = DIFFERENCE * (largest(&elastic) + slope.abs()) + 4.0 * rounding;
            self.hold(Property::Force, format!("along velocity {k}"), (elastic[k] + slope).abs(), allowed);
        }
    }

    fn inverse(&mut self, factor: &mut dyn Compliance<2>, x: &[f64]) {
        let mut f = self.product(self.case.weights, x);
        factor.solve(&mut f);
        self.hold(Property::Inverse, "W (mM + cC + kK) x = x", distance(&f, x), SOLVED);
    }

    fn refactor(&mut self, x: &[f64]) {
        let (w, q) = (self.case.weights, &self.case.q);
        let other = Weights { mass: 2.0 * w.mass, damping: 3.0 * w.damping, stiffness: 0.5 * w.stiffness };
        let elsewhere = self.moved(x, 1e-3);
        let (Ok(mut fresh), Ok(mut renewed), Ok(mut updated)) =
            (self.system.factor(w, q), self.system.factor(other, &elsewhere), self.system.factor(w, &elsewhere))
        else {
            return self.hold(Property::Refactor, "with other weights", f64::INFINITY, 0.0);
        };
        let outcome = renewed.refactor(w, q);
        self.hold(Property::Refactor, "can be renewed", f64::from(u8::from(outcome.is_err())), 0.0);
        self.hold(Property::Refactor, "knows its weights", f64::from(u8::from(renewed.weights() != w)), 0.0);
        let solved = |factor: &mut dyn Compliance<2>| {
            let mut f = x.to_vec();
            factor.solve(&mut f);
            f
        };
        let wanted = solved(fresh.as_mut());
        let allowed = ROUNDING * largest(&wanted);
        self.hold(Property::Refactor, "renewed", distance(&solved(renewed.as_mut()), &wanted), allowed);
        if self.system.traits().follows_coordinates {
            fresh.update(q);
            let wanted = solved(fresh.as_mut());
            updated.update(&elsewhere);
            updated.update(q);
            self.hold(
                Property::Refactor,
                "updated",
                distance(&solved(updated.as_mut()), &wanted),
                SOLVED * largest(&wanted),
            );
        }
    }

    /// The rows of all points and feet of the case; `None` if one has a wrong size.
    fn touches(&mut self) -> Option<Vec<Touch>> {
        let tilted = plane_frame(&Vector::<2>::new(-0.28, 0.96));
        let mut at: Vec<_> = self.case.points.iter().map(|(body, point)| (*body, *point, tilted)).collect();
        for (body, place) in &self.case.places {
            let Some(foot) = self.system.surface(*body, &self.case.q, Kinematics::Deformed, place) else {
                self.hold(Property::Foot, format!("the foot of {place:?}"), f64::INFINITY, 0.0);
                continue;
            };
            let mut found = [Vector::<2>::zeros()];
            self.system.place(*body, &self.case.q, &[foot.material], &mut found);
            let allowed = ROUNDING * (foot.place.norm() + 1.0);
            self.hold(Property::Foot, format!("the foot of {place:?}"), (found[0] - foot.place).norm(), allowed);
            self.hold(Property::Foot, "unit normal", (foot.normal.norm() - 1.0).abs(), ROUNDING);
            at.push((*body, foot.material, plane_frame(&foot.normal)));
        }
        let size = self.system.size();
        let mut touches = Vec::new();
        for (body, point, frame) in at {
            let (mut columns, mut values) = (vec![usize::MAX; size.row], vec![Vector::<2>::zeros(); size.row]);
            let taken = self.system.rows(body, &self.case.q, &point, &frame, &mut Rows::new(&mut columns, &mut values));
            columns.truncate(taken);
            values.truncate(taken);
            let fits = taken <= size.row && columns.iter().all(|column| *column < size.v);
            self.hold(Property::Sizes, format!("rows of {point:?}"), f64::from(u8::from(!fits)), 0.0);
            touches.push(Touch { body, point, frame, columns, values });
            if !fits {
                return None;
            }
        }
        Some(touches)
    }

    fn rows(&mut self, touch: &Touch, moving: &[usize]) {
        let n = self.system.size().v;
        let size = touch.values.iter().map(Vector::norm).fold(0.0, f64::max);
        for &k in moving {
            let mut direction = vec![0.0; n];
            direction[k] = 1.0;
            let place = |tau: f64| {
                let mut at = [Vector::<2>::zeros()];
                self.system.place(touch.body, &self.moved(&direction, tau), &[touch.point], &mut at);
                at[0]
            };
            let slope = touch.frame * derivative(place);
            let entries = touch.columns.iter().zip(&touch.values).filter(|(column, _)| **column == k);
            let row = entries.fold(Vector::<2>::zeros(), |sum, (_, value)| sum + value);
            let rounding = f64::EPSILON * (place(-STEP).norm() + place(STEP).norm()) / STEP;
            let what = format!("velocity {k} at {:?}", touch.point);
            self.hold(Property::Rows, what, (slope - row).norm(), DIFFERENCE * size + 4.0 * rounding);
        }
    }

    fn bias(&mut self, touch: &Touch) {
        // Slow, so that the second difference is the second derivative to the tolerance.
        let v: Vec<f64> = wave(self.system.size().v, 0.2).iter().map(|v| 0.02 * v).collect();
        let Some(bias) = self.system.bias(touch.body, &self.case.q, &v, &touch.point, &touch.frame) else { return };
        let place = |tau: f64| {
            let mut at = [Vector::<2>::zeros()];
            self.system.place(touch.body, &self.moved(&v, tau), &[touch.point], &mut at);
            at[0]
        };
        let second = |step: f64| (place(step) - place(0.0) * 2.0 + place(-step)) / (step * step);
        let found = second(BEND) * (4.0 / 3.0) - second(2.0 * BEND) * (1.0 / 3.0);
        let rounding = 16.0 * f64::EPSILON * (place(0.0).norm() + 1.0) / (BEND * BEND);
        let what = format!("at {:?}", touch.point);
        let allowed = DIFFERENCE * (bias.norm() + touch.point.norm()) + rounding;
        self.hold(Property::Bias, what, (touch.frame * found - bias).norm(), allowed);
    }

    fn contacts(&mut self, factor: &mut dyn Compliance<2>, touches: &[Touch]) {
        let n = self.system.size().v;
        let (wanted, response) = by_products(factor, touches, n);
        let size = wanted.iter().map(Block::norm).fold(0.0, f64::max);
        let p = impulses(touches.len());
        let mut first: Option<(Vec<Block<2>>, Vec<f64>)> = None;
        // All, then one by one from the last, then all again: what a factor keeps must not change
        // results.
        let singles = (0..touches.len()).rev().map(|k| &touches[k..=k]);
        for some in std::iter::once(touches).chain(singles).chain(std::iter::once(touches)) {
            let arena = Arena::new(some);
            let mut blocks = vec![Block::<2>::zeros(); some.len() * some.len()];
            let (mut scratch, mut v) = (vec![f64::NAN; n], vec![0.0; n]);
            factor.couple(&arena.rows(), &mut scratch, &mut Coupling::dense(some.len(), &mut blocks));
            scratch.fill(f64::NAN);
            factor.respond(&arena.rows(), &p[..some.len()], &mut scratch, &mut v);
            if some.len() != touches.len() {
                continue;
            }
            let off = blocks.iter().zip(&wanted).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
            self.hold(Property::Couple, "J W Jᵀ", off, SOLVED * size);
            self.hold(Property::Respond, "W Jᵀ p", distance(&v, &response), SOLVED * largest(&response));
            match &first {
                None => first = Some((blocks, v)),
                Some((before, before_v)) => {
                    let same = *before == blocks && *before_v == v;
                    self.hold(Property::Couple, "whatever came before", f64::from(u8::from(!same)), 0.0);
                }
            }
        }
    }
}

fn impulses(contacts: usize) -> Vec<Vector<2>> {
    (0..contacts).map(|k| Vector::<2>::new(1.0 + 0.3 * k as f64, 0.4 - 0.2 * k as f64)).collect()
}

/// J W Jᵀ and W Jᵀ p, by one solve for each direction of each contact.
fn by_products(factor: &mut dyn Compliance<2>, touches: &[Touch], n: usize) -> (Vec<Block<2>>, Vec<f64>) {
    let (count, p) = (touches.len(), impulses(touches.len()));
    let mut blocks = vec![Block::<2>::zeros(); count * count];
    let mut response = vec![0.0; n];
    for (j, touch) in touches.iter().enumerate() {
        for d in 0..2 {
            let mut f = vec![0.0; n];
            touch.columns.iter().zip(&touch.values).for_each(|(c, value)| f[*c] += value[d]);
            factor.solve(&mut f);
            response.iter_mut().zip(&f).for_each(|(v, f)| *v += p[j][d] * f);
            for (i, other) in touches.iter().enumerate() {
                let u = other
                    .columns
                    .iter()
                    .zip(&other.values)
                    .fold(Vector::<2>::zeros(), |u, (c, value)| u + value * f[*c]);
                blocks[i * count + j].set_column(d, &u);
            }
        }
    }
    (blocks, response)
}

/// Rows stored one after the other, as for the contacts of a step.
struct Arena {
    spans: Vec<[Span; 2]>,
    columns: Vec<usize>,
    values: Vec<Vector<2>>,
}

impl Arena {
    fn new(touches: &[Touch]) -> Self {
        let mut arena = Self { spans: Vec::new(), columns: Vec::new(), values: Vec::new() };
        for touch in touches {
            let span = Span { start: arena.columns.len(), len: touch.columns.len(), ..Span::default() };
            arena.spans.push([span, Span { part: 1, ..Span::default() }]);
            arena.columns.extend_from_slice(&touch.columns);
            arena.values.extend_from_slice(&touch.values);
        }
        arena
    }

    fn rows(&self) -> PartRows<'_, 2> {
        PartRows { part: 0, spans: &self.spans, columns: &self.columns, values: &self.values }
    }
}
