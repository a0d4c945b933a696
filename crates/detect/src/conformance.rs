//! One harness that every detector runs through (feature `conformance`).
//!
//! It holds a [`ContactDetector`] to what the trait's page says, in configurations that the caller
//! gives: a few poses of one motion, some of them in contact, one after the other, so that the
//! detector's memory is used. What doesn't hold comes back as a list, with numbers. [`check`] has
//! an example.

use crate::{BodyId, Candidate, Candidates, ContactDetector, ContactId, DetectorMemory, Frame};
use crate::{Geometry, HalfSpace, Kinematics, SurfacePoint, Vector, Wiring};
use std::cell::RefCell;
use std::fmt::{self, Debug};

/// What has to hold of a detector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Property {
    /// There is a candidate in one of the configurations. Without one, nothing else has been
    /// tested.
    Found,
    /// What was in `out` before is gone, in `detect` and in `locate`.
    Cleared,
    /// A memory of other configurations changes nothing.
    Memory,
    /// A margin lets in the candidates with a gap of at most that, and no others.
    Margin,
    /// Candidates keep their order, whatever the configuration and the margin.
    Order,
    /// No two candidates have one identity, and it stands for the same bodies and law in every
    /// configuration.
    Identities,
    /// Frames are orthonormal; in the plane the tangent is (n_y, −n_x).
    Frame,
    /// The gap is n · (point − foot), where the geometry can place both.
    Gap,
    /// `locate` gives the candidates of `detect` with these identities, and no others than was
    /// asked for, in order of identity.
    Locate,
    /// `deepest` is the largest −gap, or 0.
    Deepest,
    /// There are never more candidates than the capacity.
    Capacity,
    /// Candidates are of pairs that the wiring names, with their law and bodies, no more than it
    /// says, and surfaces are asked for only where it says so. An empty wiring says nothing.
    Wiring,
}

/// A property that doesn't hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// Which.
    pub property: Property,
    /// Where and how, with numbers.
    pub what: String,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}: {}", self.property, self.what)
    }
}

impl std::error::Error for Failure {}

/// Rounding, relative to the largest number that is added up.
const ROUNDING: f64 = 1e-12;

/// Holds a detector to all [properties](Property) in these configurations, and returns those that
/// fail.
///
/// A gap is compared with the places of its two sides. [`Geometry::place`] gets places that are NaN
/// to write to; those that it leaves so can't be placed, and their gaps are not compared.
///
/// ```
/// use nalgebra::Vector2;
/// use teeter_detect::{conformance::check, *};
///
/// /// A body that only moves up and down, above a floor.
/// struct Scene(f64);
/// impl Geometry<2> for Scene {
///     fn place(&self, body: BodyId, local: &[Vector2<f64>], out: &mut [Vector2<f64>]) {
///         let height = if body == BodyId(0) { self.0 } else { 0.0 };
///         out.iter_mut().zip(local).for_each(|(x, local)| *x = local + Vector2::new(0.0, height));
///     }
///     fn surface(&self, _: BodyId, _: Kinematics, at: &Vector2<f64>) -> Option<SurfacePoint<2>> {
///         let foot = Vector2::new(at.x, 0.0);
///         Some(SurfacePoint { place: foot, normal: Vector2::y(), material: foot })
///     }
/// }
///
/// let points = vec![Vector2::new(-1.0, 0.0), Vector2::new(1.0, 0.5)];
/// let (body, surface, law) = (BodyId(0), BodyId(1), LawId(0));
/// let pair = PointPair { pair: 0, law, points, body, surface, kinematics: Kinematics::Deformed };
/// let failures = check(&PointDetector::new(vec![pair]), &[&Scene(0.3), &Scene(0.0), &Scene(-0.1)]);
/// assert_eq!(failures, []);
/// ```
#[must_use]
pub fn check<const D: usize>(detector: &dyn ContactDetector<D>, configurations: &[&dyn Geometry<D>]) -> Vec<Failure> {
    let mut check = Check { detector, failures: Vec::new() };
    let all: Vec<Candidates<D>> = configurations.iter().map(|at| check.found(*at, f64::INFINITY)).collect();
    check.hold(Property::Found, all.iter().any(|found| !found.is_empty()), || {
        format!("no candidate in {} configurations", all.len())
    });
    check.identities(&all);
    check.order(&all);
    for (k, (&at, all)) in configurations.iter().zip(&all).enumerate() {
        check.size(k, all);
        check.frames(k, at, all);
        check.margins(k, at, all);
        check.wiring(k, at, all);
    }
    check.memory(configurations);
    check.locate(configurations, &all);
    check.failures
}

struct Check<'a, const D: usize> {
    detector: &'a dyn ContactDetector<D>,
    failures: Vec<Failure>,
}

impl<const D: usize> Check<'_, D> {
    fn hold(&mut self, property: Property, good: bool, what: impl FnOnce() -> String) {
        if !good {
            self.failures.push(Failure { property, what: what() });
        }
    }

    /// Holds two lists of candidates to be equal.
    fn same(&mut self, property: Property, what: &str, found: &[Candidate<D>], expected: &[Candidate<D>]) {
        self.hold(property, found == expected, || match found.iter().zip(expected).find(|(a, b)| a != b) {
            Some((found, expected)) => format!("{what}: {found:?}, but {expected:?} is expected"),
            None => format!("{what}: {} candidates, but {} are expected", found.len(), expected.len()),
        });
    }

    /// The candidates, without memory.
    fn found(&self, at: &dyn Geometry<D>, margin: f64) -> Candidates<D> {
        let mut out = Candidates::new();
        self.detector.detect(at, margin, &mut DetectorMemory::default(), &mut out);
        out
    }

    fn identities(&mut self, all: &[Candidates<D>]) {
        for (k, found) in all.iter().enumerate() {
            for (i, candidate) in found.iter().enumerate() {
                let twice = found[..i].iter().any(|before| before.id == candidate.id);
                self.hold(Property::Identities, !twice, || {
                    format!("configuration {k}: two candidates are {:?}", candidate.id)
                });
                let named = all[..k].iter().flatten().find(|before| before.id == candidate.id);
                let same = named.is_none_or(|before| who(before) == who(candidate));
                self.hold(Property::Identities, same, || {
                    format!("{:?} is {:?} in configuration {k}, but was {named:?}", candidate.id, who(candidate))
                });
            }
        }
    }

    /// Those of the first list that are in the second stand in the same order there.
    fn order(&mut self, all: &[Candidates<D>]) {
        for (k, found) in all.iter().enumerate().skip(1) {
            let places = |id| all[k - 1].iter().position(|before: &Candidate<D>| before.id == id);
            let order: Vec<usize> = found.iter().filter_map(|candidate| places(candidate.id)).collect();
            self.hold(Property::Order, order.is_sorted(), || {
                format!("from configuration {} to {k} candidates are reordered to {order:?}", k - 1)
            });
        }
    }

    fn size(&mut self, k: usize, all: &[Candidate<D>]) {
        let capacity = self.detector.capacity();
        self.hold(Property::Capacity, all.len() <= capacity, || {
            format!("configuration {k}: {} candidates, but the capacity is {capacity}", all.len())
        });
    }

    fn frames(&mut self, k: usize, at: &dyn Geometry<D>, all: &[Candidate<D>]) {
        for Candidate { id, sides, frame, gap, .. } in all {
            let off = (frame * frame.transpose() - Frame::<D>::identity()).amax();
            // Written so that NaN fails too.
            self.hold(Property::Frame, off <= ROUNDING, || {
                format!("configuration {k}, {id:?}: rows are {off:e} from orthonormal")
            });
            if D == 2 {
                let off = (frame[(1, 0)] - frame[(0, 1)]).abs().max((frame[(1, 1)] + frame[(0, 0)]).abs());
                self.hold(Property::Frame, off <= ROUNDING, || {
                    format!("configuration {k}, {id:?}: the tangent is {off:e} from (n_y, −n_x)")
                });
            }
            let [point, foot] = sides.map(|side| {
                let mut place = [Vector::<D>::repeat(f64::NAN)];
                at.place(side.body, &[side.point], &mut place);
                place[0]
            });
            let apart = frame.row(0).transpose().dot(&(point - foot));
            let slack = ROUNDING * (point.amax() + foot.amax());
            self.hold(Property::Gap, apart.is_nan() || (gap - apart).abs() <= slack, || {
                format!("configuration {k}, {id:?}: the gap is {gap:e} m, but its sides are {apart:e} m apart")
            });
        }
    }

    fn margins(&mut self, k: usize, at: &dyn Geometry<D>, all: &[Candidate<D>]) {
        let gaps = || all.iter().map(|candidate| candidate.gap);
        for margin in [0.0, 0.5 * gaps().filter(|gap| gap.is_finite()).fold(0.0, f64::max), f64::INFINITY] {
            let found = self.found(at, margin);
            let mut expected = all.to_vec();
            expected.retain(|candidate| candidate.gap <= margin);
            let what = format!("configuration {k}, margin {margin:e} m");
            let sorted = |found: &[Candidate<D>]| {
                let mut sorted = found.to_vec();
                sorted.sort_by_key(|candidate| candidate.id);
                sorted
            };
            let (mine, theirs) = (sorted(&found), sorted(&expected));
            self.same(Property::Margin, &what, &mine, &theirs);
            if mine == theirs {
                self.same(Property::Order, &what, &found, &expected);
            }
            // What stood there before is gone.
            let mut again = all.iter().chain(all).copied().collect();
            self.detector.detect(at, margin, &mut DetectorMemory::default(), &mut again);
            self.same(Property::Cleared, &what, &again, &found);
        }
        let expected = gaps().map(|gap| -gap).fold(0.0, f64::max);
        let deepest = self.detector.deepest(at, &mut DetectorMemory::default(), &mut Candidates::new());
        self.hold(Property::Deepest, (deepest - expected).abs() <= ROUNDING * expected, || {
            format!("configuration {k}: {deepest:e} m, but the largest −gap is {expected:e} m")
        });
    }

    /// One memory, there and back.
    fn memory(&mut self, configurations: &[&dyn Geometry<D>]) {
        let mut memory = DetectorMemory::default();
        let mut out = Candidates::new();
        for margin in [f64::INFINITY, 0.0] {
            for (k, &at) in configurations.iter().enumerate().chain(configurations.iter().enumerate().rev()) {
                let what = format!("configuration {k}, margin {margin:e} m, after others");
                self.detector.detect(at, margin, &mut memory, &mut out);
                let expected = self.found(at, margin);
                self.same(Property::Memory, &what, &out, &expected);
            }
        }
    }

    /// All contacts that there are in any configuration, and every other of them.
    fn locate(&mut self, configurations: &[&dyn Geometry<D>], all: &[Candidates<D>]) {
        let mut ids: Vec<ContactId> = all.iter().flatten().map(|candidate| candidate.id).collect();
        ids.sort();
        ids.dedup();
        let some: Vec<ContactId> = ids.iter().copied().step_by(2).collect();
        for (k, (&at, all)) in configurations.iter().zip(all).enumerate() {
            for ids in [&ids, &some] {
                let mut expected = all.clone();
                expected.retain(|candidate| ids.contains(&candidate.id));
                expected.sort_by_key(|candidate| candidate.id);
                let (mut out, mut again) = (Candidates::new(), all.clone());
                self.detector.locate(at, ids, &mut out);
                self.detector.locate(at, ids, &mut again);
                let what = format!("configuration {k}, locating {} contacts", ids.len());
                self.same(Property::Cleared, &what, &again, &out);
                let others = out.iter().filter(|candidate| !expected.iter().any(|known| known.id == candidate.id));
                let others: Candidates<D> = others.copied().collect();
                self.frames(k, at, &others);
                self.hold(Property::Locate, others.iter().all(|other| ids.contains(&other.id)), || {
                    format!("{what}: there are contacts that were not asked for")
                });
                self.hold(Property::Locate, out.is_sorted_by_key(|candidate| candidate.id), || {
                    format!("{what}: they don't rise in identity")
                });
                out.retain(|candidate| expected.iter().any(|known| known.id == candidate.id));
                self.same(Property::Locate, &what, &out, &expected);
            }
        }
    }

    fn wiring(&mut self, k: usize, at: &dyn Geometry<D>, all: &[Candidate<D>]) {
        let wiring = self.detector.wiring();
        if wiring.is_empty() {
            return;
        }
        for candidate in all {
            let fits = |wired: &&Wiring| (wired.law, wired.bodies) == (candidate.law, bodies(candidate));
            let known = wiring.iter().filter(|wired| wired.pair == candidate.id.pair()).find(fits);
            self.hold(Property::Wiring, known.is_some(), || {
                format!("configuration {k}: {:?}, {:?} is of no pair in it", candidate.id, who(candidate))
            });
        }
        for wired in &wiring {
            let found = all.iter().filter(|candidate| candidate.id.pair() == wired.pair).count();
            self.hold(Property::Wiring, found <= wired.contacts, || {
                format!("configuration {k}: pair {} has {found} contacts, not {} at most", wired.pair, wired.contacts)
            });
        }
        let watched = Watched { at, asked: RefCell::default() };
        self.found(&watched, f64::INFINITY);
        for body in watched.asked.into_inner() {
            let said = wiring.iter().any(|wired| wired.on_surface && wired.bodies[1] == body);
            self.hold(Property::Wiring, said, || format!("configuration {k}: the surface of {body:?} is asked for"));
        }
    }
}

fn bodies<const D: usize>(candidate: &Candidate<D>) -> [BodyId; 2] {
    [candidate.sides[0].body, candidate.sides[1].body]
}

/// What an identity stands for.
fn who<const D: usize>(candidate: &Candidate<D>) -> impl Debug + PartialEq + use<D> {
    (candidate.law, bodies(candidate))
}

/// Bodies, and whose surfaces a detector asks for.
struct Watched<'a, const D: usize> {
    at: &'a dyn Geometry<D>,
    asked: RefCell<Vec<BodyId>>,
}

impl<const D: usize> Geometry<D> for Watched<'_, D> {
    fn place(&self, body: BodyId, local: &[Vector<D>], out: &mut [Vector<D>]) {
        self.at.place(body, local, out);
    }

    fn surface(&self, body: BodyId, kinematics: Kinematics, at: &Vector<D>) -> Option<SurfacePoint<D>> {
        let mut asked = self.asked.borrow_mut();
        if !asked.contains(&body) {
            asked.push(body);
        }
        self.at.surface(body, kinematics, at)
    }

    fn reach(&self, body: BodyId, margin: f64) -> Option<HalfSpace<D>> {
        self.at.reach(body, margin)
    }
}
