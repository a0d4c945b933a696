//! Points of one body (the corners of a block) against the surface of another (a beam, the ground).

use crate::plane_frame;
use crate::{
    Anchor, BodyId, Candidate, Candidates, ContactDetector, ContactId, DetectorMemory, Geometry, Kinematics, LawId,
    SurfacePoint, Vector, Wiring,
};

/// Points of a body that can touch a surface of another.
#[derive(Clone, Debug, PartialEq)]
pub struct PointPair<const D: usize> {
    /// The pair's number, first part of the identity of its contacts.
    pub pair: u32,
    /// The law of its contacts.
    pub law: LawId,
    /// The points, in the body's own coordinates; a point's position in this list is the second
    /// part of the identity.
    pub points: Vec<Vector<D>>,
    /// The body that has the points.
    pub body: BodyId,
    /// The body that has the surface.
    pub surface: BodyId,
    /// How the surface's deformation enters gap and frame.
    pub kinematics: Kinematics,
}

/// The detector of points against surfaces: every point of every pair is looked at.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointDetector<const D: usize> {
    pairs: Vec<PointPair<D>>,
    /// The points with a law of their own, in the order of their identities.
    laws: Vec<(ContactId, LawId)>,
}

/// Points placed at once: a block's four corners share the sine and cosine of its angle.
const BATCH: usize = 8;

impl<const D: usize> PointDetector<D> {
    /// A detector of these pairs.
    #[must_use]
    pub fn new(pairs: Vec<PointPair<D>>) -> Self {
        Self { pairs, laws: Vec::new() }
    }

    /// Gives points laws of their own instead of that of their pair, such as another friction to each foot of a block: each by
    /// the identity of its contact. Default: all points of a pair have its law.
    #[must_use]
    pub fn with_laws(mut self, laws: impl IntoIterator<Item = (ContactId, LawId)>) -> Self {
        self.laws.extend(laws);
        self.laws.sort_unstable_by_key(|(id, _)| *id);
        self
    }

    /// The law of a point of a pair.
    #[inline]
    fn law(&self, pair: &PointPair<D>, k: usize) -> LawId {
        if self.laws.is_empty() {
            return pair.law;
        }
        let own = self.laws.binary_search_by_key(&ContactId::new(pair.pair, k as u32), |(id, _)| *id);
        own.map_or(pair.law, |place| self.laws[place].1)
    }

    /// The pairs, in the order in which they are looked at.
    #[must_use]
    pub fn pairs(&self) -> &[PointPair<D>] {
        &self.pairs
    }
}

impl PointDetector<2> {
    /// A contact where it is now; `None` if it is of no pair here, or has no foot.
    pub(crate) fn located(&self, at: &dyn Geometry<2>, id: ContactId) -> Option<Candidate<2>> {
        // Usually the pairs are in the order of their numbers.
        let here = self.pairs.get(id.pair() as usize).filter(|pair| pair.pair == id.pair());
        let k = id.point() as usize;
        let pair = here.or_else(|| self.pairs.iter().find(|pair| pair.pair == id.pair()))?;
        let point = pair.points.get(k)?;
        let mut place = [Vector::<2>::zeros()];
        at.place(pair.body, std::slice::from_ref(point), &mut place);
        let (foot, gap) = pair.foot(at, &place[0])?;
        (gap <= f64::INFINITY).then(|| pair.candidate(k, self.law(pair, k), &foot, gap))
    }
}

impl PointPair<2> {
    /// The foot and the gap of a point of the pair that is at `place`; `None` where the surface
    /// doesn't extend that far.
    #[inline]
    fn foot(&self, at: &dyn Geometry<2>, place: &Vector<2>) -> Option<(SurfacePoint<2>, f64)> {
        let foot = at.surface(self.surface, self.kinematics, place)?;
        let gap = foot.normal.dot(&(place - foot.place));
        Some((foot, gap))
    }

    #[inline]
    fn candidate(&self, k: usize, law: LawId, foot: &SurfacePoint<2>, gap: f64) -> Candidate<2> {
        Candidate {
            id: ContactId::new(self.pair, k as u32),
            law,
            sides: [
                Anchor { body: self.body, point: self.points[k] },
                Anchor { body: self.surface, point: foot.material },
            ],
            frame: plane_frame(&foot.normal),
            gap,
        }
    }

    /// Hands the points that may have a gap of at most `margin` to `each`, with their places.
    #[inline]
    fn near(&self, at: &dyn Geometry<2>, margin: f64, mut each: impl FnMut(usize, &Vector<2>)) {
        // Most corners are far above the surface, and finding their foot is expensive.
        let reach = if margin < f64::INFINITY { at.reach(self.surface, margin) } else { None };
        let mut places = [Vector::<2>::zeros(); BATCH];
        for (batch, local) in self.points.chunks(BATCH).enumerate() {
            let places = &mut places[..local.len()];
            at.place(self.body, local, places);
            for (k, place) in places.iter().enumerate() {
                if !reach.is_some_and(|reach| reach.excludes(place)) {
                    each(batch * BATCH + k, place);
                }
            }
        }
    }
}

impl ContactDetector<2> for PointDetector<2> {
    fn detect(&self, at: &dyn Geometry<2>, margin: f64, _memory: &mut DetectorMemory, out: &mut Candidates<2>) {
        out.clear();
        for pair in &self.pairs {
            pair.near(at, margin, |k, place| {
                if let Some((foot, gap)) = pair.foot(at, place)
                    && gap <= margin
                {
                    out.push(pair.candidate(k, self.law(pair, k), &foot, gap));
                }
            });
        }
    }

    fn deepest(&self, at: &dyn Geometry<2>, _memory: &mut DetectorMemory, _scratch: &mut Candidates<2>) -> f64 {
        let mut deepest = 0.0_f64;
        for pair in &self.pairs {
            pair.near(at, 0.0, |_, place| {
                if let Some((_, gap)) = pair.foot(at, place) {
                    deepest = deepest.max(-gap);
                }
            });
        }
        deepest
    }

    fn locate(&self, at: &dyn Geometry<2>, ids: &[ContactId], out: &mut Candidates<2>) {
        out.clear();
        out.reserve(ids.len());
        out.extend(ids.iter().filter_map(|id| self.located(at, *id)));
    }

    fn fixed_side(&self, _id: ContactId) -> Option<usize> {
        Some(0)
    }

    fn wiring(&self) -> Vec<Wiring> {
        let of = |pair: &PointPair<2>, law: LawId| Wiring {
            pair: pair.pair,
            law,
            bodies: [pair.body, pair.surface],
            on_surface: true,
            contacts: pair.points.len(),
            not_finite: pair.points.iter().position(|point| !point.iter().all(|x| x.is_finite())),
        };
        let wired = |pair: &PointPair<2>| {
            let mut laws: Vec<LawId> = (0..pair.points.len().max(1)).map(|k| self.law(pair, k)).collect();
            laws.sort_unstable_by_key(|law| law.0);
            laws.dedup();
            laws.into_iter().map(|law| of(pair, law)).collect::<Vec<_>>()
        };
        self.pairs.iter().flat_map(wired).collect()
    }

    fn capacity(&self) -> usize {
        self.pairs.iter().map(|pair| pair.points.len()).sum()
    }
}
