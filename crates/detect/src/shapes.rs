//! Bodies with shapes against each other, beside points against surfaces.

use crate::placed::{Member, Places};
use crate::touch::{OF_DISC, Touch, feature_of, polygons, with_disc};
use crate::{
    Anchor, BodyId, Candidate, Candidates, ContactDetector, ContactId, DetectorMemory, Geometry, LawId, PointDetector,
    Shape, Wiring, plane_frame,
};

/// Two bodies whose shapes can touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShapePair {
    /// The pair's number, first part of the identity of its contacts.
    pub pair: u32,
    /// The law of its contacts.
    pub law: LawId,
    /// The bodies: the normal of a contact points from the second to the first, and its impulse acts on the first.
    pub bodies: [BodyId; 2],
}

/// What is wrong with shapes and pairs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum WiringError {
    /// A body with two shapes.
    TwoShapes {
        /// The body.
        body: BodyId,
    },
    /// A pair of a body that has no shape.
    NoShape {
        /// The pair's number.
        pair: u32,
        /// The body.
        body: BodyId,
    },
}

impl std::fmt::Display for WiringError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::TwoShapes { body } => write!(f, "body {} has two shapes: give each body one", body.0),
            Self::NoShape { pair, body } => {
                write!(f, "pair {pair} is of body {}, which has no shape: give it one", body.0)
            }
        }
    }
}

impl std::error::Error for WiringError {}

/// The detector of shapes against each other, and of points against surfaces.
///
/// Two polygons touch where a corner of one is over a side of the other, at two points at most: at the ends of what the side that
/// parts them best shares with the side that faces it. Corner beside corner they don't touch. A disc touches at one point.
///
/// ```
/// use nalgebra::Vector2;
/// use teeter_detect::*;
///
/// /// Bodies that only move up and down.
/// struct Heights(Vec<f64>);
/// impl Geometry<2> for Heights {
///     fn place(&self, body: BodyId, local: &[Vector2<f64>], out: &mut [Vector2<f64>]) {
///         out.iter_mut().zip(local).for_each(|(x, l)| *x = l + Vector2::new(0.0, self.0[body.0 as usize]));
///     }
///     fn surface(&self, _: BodyId, _: Kinematics, _: &Vector2<f64>) -> Option<SurfacePoint<2>> {
///         None
///     }
/// }
///
/// let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(Vector2::from);
/// let square = Shape::from(Polygon::new(square.to_vec())?);
/// let bodies = [BodyId(1), BodyId(0)];
/// let shapes = bodies.map(|body| (body, square.clone())).to_vec();
/// let detector = ShapeDetector::new(shapes, vec![ShapePair { pair: 0, law: LawId(0), bodies }])?;
/// let mut found = Candidates::new();
/// detector.detect(&Heights(vec![0.0, 2.5]), 1.0, &mut DetectorMemory::default(), &mut found);
/// assert_eq!(found.iter().map(|contact| contact.gap).collect::<Vec<_>>(), [0.5, 0.5]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct ShapeDetector {
    points: PointDetector<2>,
    /// In the order of their bodies.
    members: Vec<Member>,
    /// In the order of their numbers, with the places of their bodies among the members.
    pairs: Vec<(ShapePair, [usize; 2])>,
}

impl ShapeDetector {
    /// A detector of these bodies' shapes, of which the pairs can touch.
    ///
    /// # Errors
    /// If a body has two shapes, or one of a pair has none.
    pub fn new(mut shapes: Vec<(BodyId, Shape)>, mut pairs: Vec<ShapePair>) -> Result<Self, WiringError> {
        shapes.sort_by_key(|(body, _)| *body);
        if let Some(twice) = shapes.windows(2).find(|two| two[0].0 == two[1].0) {
            return Err(WiringError::TwoShapes { body: twice[0].0 });
        }
        let mut members: Vec<Member> = Vec::with_capacity(shapes.len());
        for (body, shape) in shapes {
            let start = members.last().map_or(0, |member| member.corners.end);
            let corners = match &shape {
                Shape::Polygon(polygon) => polygon.corners().len(),
                Shape::Disc(_) => 0,
            };
            members.push(Member { body, shape, corners: start..start + corners });
        }
        pairs.sort_by_key(|pair| pair.pair);
        let of = |pair: &ShapePair, body: BodyId| {
            let found = members.binary_search_by_key(&body, |member| member.body);
            found.map_err(|_| WiringError::NoShape { pair: pair.pair, body })
        };
        let pairs = pairs.iter().map(|pair| Ok((*pair, [of(pair, pair.bodies[0])?, of(pair, pair.bodies[1])?])));
        let pairs = pairs.collect::<Result<_, WiringError>>()?;
        Ok(Self { points: PointDetector::default(), members, pairs })
    }

    /// With points against surfaces, too; their pairs have numbers of their own.
    #[must_use]
    pub fn with_points(mut self, points: PointDetector<2>) -> Self {
        self.points = points;
        self
    }

    /// Hands all contacts of shapes that are at most `margin` apart to `each`, pair by pair.
    fn each(
        &self,
        at: &dyn Geometry<2>,
        margin: f64,
        memory: &mut DetectorMemory,
        mut each: impl FnMut(&ShapePair, &Touch),
    ) {
        if self.pairs.is_empty() {
            return;
        }
        let places = memory.of(Places::default);
        places.place(&self.members, at);
        for (pair, [a, b]) in &self.pairs {
            if !places.boxes[*a].near(&places.boxes[*b], margin) {
                continue;
            }
            let (first, second) = (&self.members[*a], &self.members[*b]);
            if let (Shape::Polygon(mine), Shape::Polygon(other)) = (&first.shape, &second.shape) {
                let near = polygons(&places.polygon(first, mine), &places.polygon(second, other), margin);
                near.into_iter().filter(|touch| touch.gap <= margin).for_each(|touch| each(pair, &touch));
            } else if let Some(touch) = with_disc(at, [first, second])
                && touch.gap <= margin
            {
                each(pair, &touch);
            }
        }
    }

    /// Those of the contacts `ids` that there can be, with how far it is to the end of their side, m.
    fn located<'a>(
        &'a self,
        at: &'a dyn Geometry<2>,
        ids: &'a [ContactId],
    ) -> impl Iterator<Item = (Candidate<2>, f64)> + 'a {
        ids.iter().filter_map(move |id| {
            let Ok(found) = self.pairs.binary_search_by_key(&id.pair(), |(pair, _)| pair.pair) else {
                return self.points.located(at, *id).map(|candidate| (candidate, f64::INFINITY));
            };
            let (pair, members) = &self.pairs[found];
            let [first, second] = members.map(|member| &self.members[member]);
            let touch = match (&first.shape, &second.shape) {
                (Shape::Polygon(mine), Shape::Polygon(other)) => {
                    feature_of(at, [(first.body, mine), (second.body, other)], id.point())
                }
                _ if id.point() == OF_DISC => with_disc(at, [first, second]),
                _ => None,
            }?;
            Some((candidate(pair, &touch), touch.room))
        })
    }

    fn capacity_of(&self, [a, b]: [usize; 2]) -> usize {
        let is_disc = |member: usize| matches!(self.members[member].shape, Shape::Disc(_));
        if is_disc(a) || is_disc(b) { 1 } else { 2 }
    }
}

fn candidate(pair: &ShapePair, touch: &Touch) -> Candidate<2> {
    let [a, b] = [0, 1].map(|side| Anchor { body: pair.bodies[side], point: touch.points[side] });
    Candidate {
        id: ContactId::new(pair.pair, touch.feature),
        law: pair.law,
        sides: [a, b],
        frame: plane_frame(&touch.normal),
        gap: touch.gap,
    }
}

impl ContactDetector<2> for ShapeDetector {
    fn detect(&self, at: &dyn Geometry<2>, margin: f64, memory: &mut DetectorMemory, out: &mut Candidates<2>) {
        self.points.detect(at, margin, memory, out);
        self.each(at, margin, memory, |pair, touch| out.push(candidate(pair, touch)));
    }

    fn deepest(&self, at: &dyn Geometry<2>, memory: &mut DetectorMemory, scratch: &mut Candidates<2>) -> f64 {
        let mut deepest = self.points.deepest(at, memory, scratch);
        self.each(at, 0.0, memory, |_, touch| deepest = deepest.max(-touch.gap));
        deepest
    }

    fn locate(&self, at: &dyn Geometry<2>, ids: &[ContactId], out: &mut Candidates<2>) {
        out.clear();
        out.reserve(ids.len());
        out.extend(self.located(at, ids).filter(|(_, room)| *room >= 0.0).map(|(candidate, _)| candidate));
    }

    fn locate_past_ends(&self, at: &dyn Geometry<2>, ids: &[ContactId], out: &mut Candidates<2>, rooms: &mut Vec<f64>) {
        out.clear();
        rooms.clear();
        out.reserve(ids.len());
        rooms.reserve(ids.len());
        for (candidate, room) in self.located(at, ids) {
            out.push(candidate);
            rooms.push(room);
        }
    }

    fn wiring(&self) -> Vec<Wiring> {
        let mut wiring = self.points.wiring();
        wiring.extend(self.pairs.iter().map(|(pair, members)| Wiring {
            pair: pair.pair,
            law: pair.law,
            bodies: pair.bodies,
            on_surface: false,
            contacts: self.capacity_of(*members),
            not_finite: None,
        }));
        wiring
    }

    fn capacity(&self) -> usize {
        self.points.capacity() + self.pairs.iter().map(|(_, members)| self.capacity_of(*members)).sum::<usize>()
    }
}
