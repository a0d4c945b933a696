//! Bodies with shapes against each other, beside points against surfaces.

use crate::broad::{Groups, Near, NearPair};
use crate::feet::{self, SurfacePair};
use crate::placed::{BodyFrame, Places, Shapes, outward};
use crate::profile::{self, Profile, ProfilePair};
use crate::round::{near_outline, piece, round};
use crate::sides::{self, OnSide, SidePair};
use crate::touch::{CornerOnSide, Side, Touch, Touches, corner_on_side, polygons};
use crate::{
    Anchor, BodyId, Candidate, Candidates, ContactDetector, ContactId, DetectorMemory, Geometry, LawId, MOST_CORNERS,
    PointDetector, Shape, Vector, Wiring, WiringError, plane_frame,
};

/// Two bodies whose shapes can touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShapePair {
    /// The pair's number, first part of the identity of its contacts.
    pub pair: u32,
    /// The law of its contacts.
    pub law: LawId,
    /// The bodies: the normal of a contact points from the second to the first, and its impulse
    /// acts on the first.
    pub bodies: [BodyId; 2],
}

/// The detector of shapes against each other, and of points against surfaces.
///
/// Two polygons touch where a corner of one is over a side of the other, at two points at most: at
/// the ends of what the side that parts them best shares with the side that faces it. Corner beside
/// corner they don't touch, unless one of them is round. A body may have several shapes, which are
/// its parts.
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
    shapes: Shapes,
    /// In the order of their numbers, with the places of their bodies among the members.
    pairs: Vec<(ShapePair, [usize; 2])>,
    groups: Option<InGroups>,
    /// In the order of their numbers, with the place of their body among the members.
    sides: Vec<(SidePair, usize)>,
    surfaces: Vec<(SurfacePair, usize)>,
    /// The profile of the ground, and those against it: in the order of their numbers, with the
    /// place of their body.
    profile: Option<Profile>,
    on_profile: Vec<(ProfilePair, usize)>,
}

/// Bodies of which any two can touch, and where their shapes are.
#[derive(Clone, Debug)]
struct InGroups {
    groups: Groups,
    /// The number of their first pair.
    first: u32,
    /// Their places among all members.
    members: Vec<usize>,
    /// Pairs of members that are listed one by one, or apart, sorted.
    listed: Vec<[usize; 2]>,
}

/// What detection keeps in memory.
#[derive(Debug, Default)]
struct Kept {
    places: Places,
    near: Near,
    /// The contacts of a pair of which a body has several parts.
    touches: Vec<Touch>,
}

impl ShapeDetector {
    /// A detector of these bodies' shapes, of which the pairs can touch. Several shapes of one body
    /// are its parts.
    ///
    /// # Errors
    /// If a body of a pair has no shape, or one has too many corners.
    pub fn new(shapes: Vec<(BodyId, Shape)>, mut pairs: Vec<ShapePair>) -> Result<Self, WiringError> {
        let shapes = Shapes::new(shapes);
        if let Some((body, corners)) = shapes.largest().filter(|(_, corners)| *corners > MOST_CORNERS) {
            return Err(WiringError::Corners { body, corners });
        }
        pairs.sort_by_key(|pair| pair.pair);
        let of = |pair: &ShapePair, body: BodyId| {
            shapes.member_of(body).ok_or(WiringError::NoShape { pair: pair.pair, body })
        };
        let pairs = pairs.iter().map(|pair| Ok((*pair, [of(pair, pair.bodies[0])?, of(pair, pair.bodies[1])?])));
        let pairs = pairs.collect::<Result<_, WiringError>>()?;
        Ok(Self { shapes, pairs, ..Self::default() })
    }

    /// With shapes on surfaces; pairs have numbers of their own.
    ///
    /// # Errors
    /// If a body has no shape.
    pub fn with_surfaces(mut self, mut surfaces: Vec<SurfacePair>) -> Result<Self, WiringError> {
        surfaces.sort_by_key(|pair| pair.pair);
        self.surfaces =
            surfaces.into_iter().map(|pair| Ok((pair, self.shaped(pair.body)?))).collect::<Result<_, _>>()?;
        Ok(self)
    }

    /// With sides of shapes against surfaces that bend or end. A pair may have the number of that
    /// of the same body's corners with the same surface, a [`PointPair`](crate::PointPair) or
    /// [`SurfacePair`]: what touches sides has [numbers](OnSide) that no corner has.
    ///
    /// # Errors
    /// If a body has no shape.
    pub fn with_sides(mut self, mut sides: Vec<SidePair>) -> Result<Self, WiringError> {
        sides.sort_by_key(|pair| pair.pair);
        self.sides = sides.into_iter().map(|pair| Ok((pair, self.shaped(pair.body)?))).collect::<Result<_, _>>()?;
        Ok(self)
    }

    /// With shapes against ground of this profile, given in the coordinates of the ground's body;
    /// pairs have numbers of their own.
    ///
    /// # Errors
    /// If a body has no shape.
    pub fn with_profile(mut self, profile: Profile, mut pairs: Vec<ProfilePair>) -> Result<Self, WiringError> {
        pairs.sort_by_key(|pair| pair.pair);
        self.on_profile =
            pairs.into_iter().map(|pair| Ok((pair, self.shaped(pair.body)?))).collect::<Result<_, _>>()?;
        self.profile = Some(profile);
        Ok(self)
    }

    /// With bodies of which any two can touch, but for those that are listed as pairs or
    /// [apart](Groups::without). The number
    /// of the pair of the i-th and the j-th of n bodies, i < j, is `first` + i n + j, and must be
    /// above those of all other pairs.
    ///
    /// # Errors
    /// If one of them has no shape.
    pub fn with_groups(mut self, groups: Groups, first: u32) -> Result<Self, WiringError> {
        let members: Vec<usize> = groups.bodies().map(|body| self.shaped(body)).collect::<Result<_, _>>()?;
        let ordered = |[a, b]: [usize; 2]| [a.min(b), a.max(b)];
        let mut listed: Vec<[usize; 2]> = self.pairs.iter().map(|(_, members)| ordered(*members)).collect();
        listed.extend(groups.apart().iter().map(|[i, j]| ordered([members[*i], members[*j]])));
        listed.sort_unstable();
        self.groups = Some(InGroups { groups, first, members, listed });
        Ok(self)
    }

    /// The number of a body among the shapes.
    fn shaped(&self, body: BodyId) -> Result<usize, WiringError> {
        self.shapes.member_of(body).ok_or(WiringError::Shapeless { body })
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
        if self.pairs.is_empty() && self.groups.is_none() {
            return;
        }
        let Kept { places, touches, near } = memory.of(Kept::default);
        places.place(&self.shapes, at);
        let mut of_pair = |pair: &ShapePair, members: [usize; 2]| {
            let [a, b] = members;
            if places.boxes[a].near(&places.boxes[b], margin) {
                self.of_pair(places, members, margin, touches, |touch| each(pair, touch));
            }
        };
        self.pairs.iter().for_each(|(pair, members)| of_pair(pair, *members));
        let Some(InGroups { groups, first, members, listed }) = &self.groups else { return };
        // Without a bound on how far apart they are, nobody is out of reach.
        if margin < f64::INFINITY {
            near.update(groups, *first, members, listed, places, margin);
            near.pairs.iter().for_each(|near| of_pair(&self.in_groups(near), near.members));
            return;
        }
        for i in 0..members.len() {
            for j in i + 1..members.len() {
                let number = groups.pair(*first, i, j);
                if let Some(near) = self.near_pair(number) {
                    of_pair(&self.in_groups(&near), near.members);
                }
            }
        }
    }

    /// The pair of two bodies of groups, by its number; `None` where they don't touch, or are
    /// listed.
    fn near_pair(&self, number: u32) -> Option<NearPair> {
        let InGroups { groups, first, members, listed } = self.groups.as_ref()?;
        let ([i, j], law) = groups.of_pair(*first, number)?;
        let [a, b] = [members[i], members[j]];
        listed.binary_search(&[a.min(b), a.max(b)]).is_err().then_some(NearPair { pair: number, law, members: [a, b] })
    }

    fn in_groups(&self, NearPair { pair, law, members }: &NearPair) -> ShapePair {
        ShapePair { pair: *pair, law: *law, bodies: members.map(|member| self.shapes.members[member].body) }
    }

    /// Hands the contacts of two bodies to `each`, in the order of their features.
    fn of_pair(
        &self,
        places: &Places,
        [a, b]: [usize; 2],
        margin: f64,
        touches: &mut Vec<Touch>,
        mut each: impl FnMut(&Touch),
    ) {
        let [mine, others] = [a, b].map(|member| self.shapes.members[member].parts.clone());
        let near = |i: usize, j: usize| -> Touches {
            let (first, second) = (places.part(&self.shapes, i), places.part(&self.shapes, j));
            if self.are_sharp(i, j) {
                return polygons(&first, &second, margin);
            }
            let outlines = [places.outline(&self.shapes, a, i), places.outline(&self.shapes, b, j)];
            round([&first, &second], [&outlines[0], &outlines[1]], margin)
        };
        if mine.len() * others.len() == 1 {
            near(mine.start, others.start)
                .into_iter()
                .filter(|touch| touch.gap <= margin)
                .for_each(|touch| each(&touch));
            return;
        }
        touches.clear();
        for i in mine {
            for j in others.clone() {
                touches.extend(near(i, j).into_iter().filter(|touch| touch.gap <= margin));
            }
        }
        touches.sort_unstable_by_key(|touch| touch.feature);
        touches.iter().for_each(each);
    }

    /// The pair of a contact of two shapes, and which members they are of; `None` of another contact.
    fn shapes_of(&self, id: ContactId) -> Option<(ShapePair, [usize; 2])> {
        match self.pairs.binary_search_by_key(&id.pair(), |(pair, _)| pair.pair) {
            Ok(found) => Some(self.pairs[found]),
            Err(_) => self.near_pair(id.pair()).map(|near| (self.in_groups(&near), near.members)),
        }
    }

    /// Those of the contacts `ids` that there can be, with how far it is to the end of their side,
    /// m.
    fn located<'a>(
        &'a self,
        at: &'a dyn Geometry<2>,
        ids: &'a [ContactId],
    ) -> impl Iterator<Item = (Candidate<2>, f64)> + 'a {
        ids.iter().filter_map(move |id| {
            let Some((pair, members)) = self.shapes_of(*id) else { return self.located_elsewhere(at, *id) };
            let touch = self.touch(at, members, CornerOnSide::from_number(id.point()))?;
            Some((candidate(&pair, &touch), touch.room))
        })
    }

    /// Hands the contacts with sides and with the profile of the ground to `each`.
    fn each_on_ground(&self, at: &dyn Geometry<2>, margin: f64, mut each: impl FnMut(u32, LawId, [BodyId; 2], &Touch)) {
        for (pair, member) in &self.surfaces {
            let bodies = [pair.body, pair.surface];
            feet::each(&self.shapes, *member, pair, at, margin, |touch| each(pair.pair, pair.law, bodies, touch));
        }
        for (pair, member) in &self.sides {
            let bodies = [pair.body, pair.surface];
            sides::each(&self.shapes, *member, pair, at, margin, |touch| each(pair.pair, pair.law, bodies, touch));
        }
        let Some(profile) = &self.profile else { return };
        for (pair, member) in &self.on_profile {
            let [body, ground] = [pair.body, pair.ground].map(|body| BodyFrame::of(body, at));
            for part in self.shapes.members[*member].parts.clone() {
                profile::each(profile, &self.shapes.outline(part, body), &ground, margin, |touch| {
                    each(pair.pair, pair.law, [pair.body, pair.ground], touch);
                });
            }
        }
    }

    /// The pair of a contact with a side, its body among the members, and what touches which side.
    fn on_side(&self, id: ContactId) -> Option<(&SidePair, usize, (OnSide, usize))> {
        let found = self.sides.binary_search_by_key(&id.pair(), |(pair, _)| pair.pair).ok()?;
        let (pair, member) = &self.sides[found];
        Some((pair, *member, OnSide::from_number(id.point())?))
    }

    /// A contact that is none of two shapes.
    fn located_elsewhere(&self, at: &dyn Geometry<2>, id: ContactId) -> Option<(Candidate<2>, f64)> {
        if let Some((pair, member, feature)) = self.on_side(id) {
            let touch = sides::located(&self.shapes, member, pair, at, feature)?;
            return Some((candidate_of(pair.pair, pair.law, [pair.body, pair.surface], &touch), touch.room));
        }
        if let Ok(found) = self.surfaces.binary_search_by_key(&id.pair(), |(pair, _)| pair.pair) {
            let (pair, member) = &self.surfaces[found];
            let touch = feet::located(&self.shapes, *member, pair, at, id.point() as usize)?;
            return Some((candidate_of(pair.pair, pair.law, [pair.body, pair.surface], &touch), touch.room));
        }
        if let (Some(profile), Ok(found)) =
            (&self.profile, self.on_profile.binary_search_by_key(&id.pair(), |(pair, _)| pair.pair))
        {
            let (pair, member) = &self.on_profile[found];
            let feature = CornerOnSide::from_number(id.point());
            let corner = if feature.owner == 0 { feature.corner } else { feature.side };
            let [body, ground] = [pair.body, pair.ground].map(|body| BodyFrame::of(body, at));
            let outline = self.shapes.outline(self.shapes.part_of(*member, corner)?, body);
            let touch = profile::located(profile, &outline, &ground, feature)?;
            return Some((candidate_of(pair.pair, pair.law, [pair.body, pair.ground], &touch), touch.room));
        }
        self.points.located(at, id).map(|candidate| (candidate, f64::INFINITY))
    }

    /// The contact of two members by its feature.
    fn touch(&self, at: &dyn Geometry<2>, members: [usize; 2], feature: CornerOnSide) -> Option<Touch> {
        let [part, beside] = self.parts_of(members, feature)?;
        if feature.round == self.are_sharp(part.0, beside.0) {
            return None;
        }
        if feature.round {
            let [part, beside] = [part, beside].map(|(part, body)| self.shapes.outline(part, BodyFrame::of(body, at)));
            return near_outline(feature, &part, &beside);
        }
        let first = |part: usize| self.shapes.parts[part].first;
        let corner = self.shapes.local(part.0)[feature.corner - first(part.0)];
        let sides = self.shapes.local(beside.0);
        let side = feature.side - first(beside.0);
        let local = [sides[side], sides[(side + 1) % sides.len()]];
        let (mut place, mut ends) = ([Vector::zeros()], [Vector::zeros(); 2]);
        at.place(part.1, &[corner], &mut place);
        at.place(beside.1, &local, &mut ends);
        corner_on_side(feature, (corner, place[0]), &Side { local, ends, normal: outward(&ends[0], &ends[1]) })
    }

    /// The number of the piece on which a corner of a round shape is; `None` of another contact.
    fn piece(&self, at: &dyn Geometry<2>, id: ContactId) -> Option<u32> {
        let (_, members) = self.shapes_of(id)?;
        let feature = CornerOnSide::from_number(id.point());
        if !feature.round {
            return None;
        }
        let parts = self.parts_of(members, feature)?;
        let [owner, other] = parts.map(|(part, body)| self.shapes.outline(part, BodyFrame::of(body, at)));
        piece(feature, &owner, &other)
    }

    /// The part with the corner of a feature and the part beside it, each with its body.
    fn parts_of(&self, members: [usize; 2], feature: CornerOnSide) -> Option<[(usize, BodyId); 2]> {
        let [owner, other] = if feature.owner == 0 { members } else { [members[1], members[0]] };
        let parts = [self.shapes.part_of(owner, feature.corner)?, self.shapes.part_of(other, feature.side)?];
        let [body, beside] = [owner, other].map(|member| self.shapes.members[member].body);
        Some([(parts[0], body), (parts[1], beside)])
    }

    /// Whether neither of two parts is round.
    fn are_sharp(&self, i: usize, j: usize) -> bool {
        self.shapes.parts[i].radius + self.shapes.parts[j].radius == 0.0
    }

    /// As many contacts as a body can have with the ground: each corner with each piece, and each
    /// crest.
    fn profile_capacity(&self, member: usize) -> usize {
        let points = self.profile.as_ref().map_or(0, |profile| profile.points().count());
        let parts = self.shapes.members[member].parts.clone();
        parts.map(|part| (points + 1) * self.shapes.local(part).len() + points).sum()
    }

    fn side_capacity(&self, member: usize) -> usize {
        let parts = self.shapes.members[member].parts.clone();
        // Of a rounding both ends of the surface, too.
        parts.map(|part| (4 + sides::MOST_SUMMITS) * self.shapes.local(part).len()).sum()
    }

    fn capacity_of(&self, [a, b]: [usize; 2]) -> usize {
        let parts = |member: usize| self.shapes.members[member].parts.clone();
        let of =
            |i: usize, j: usize| if self.shapes.local(i).len().min(self.shapes.local(j).len()) == 1 { 1 } else { 2 };
        parts(a).map(|i| parts(b).map(|j| of(i, j)).sum::<usize>()).sum()
    }
}

fn candidate(pair: &ShapePair, touch: &Touch) -> Candidate<2> {
    candidate_of(pair.pair, pair.law, pair.bodies, touch)
}

fn candidate_of(pair: u32, law: LawId, bodies: [BodyId; 2], touch: &Touch) -> Candidate<2> {
    let [a, b] = [0, 1].map(|side| Anchor { body: bodies[side], point: touch.points[side] });
    Candidate {
        id: ContactId::new(pair, touch.feature),
        law,
        sides: [a, b],
        frame: plane_frame(&touch.normal),
        gap: touch.gap,
    }
}

impl ContactDetector<2> for ShapeDetector {
    fn detect(&self, at: &dyn Geometry<2>, margin: f64, memory: &mut DetectorMemory, out: &mut Candidates<2>) {
        self.points.detect(at, margin, memory, out);
        self.each_on_ground(at, margin, |pair, law, bodies, touch| out.push(candidate_of(pair, law, bodies, touch)));
        self.each(at, margin, memory, |pair, touch| out.push(candidate(pair, touch)));
    }

    fn deepest(&self, at: &dyn Geometry<2>, memory: &mut DetectorMemory, scratch: &mut Candidates<2>) -> f64 {
        let mut deepest = self.points.deepest(at, memory, scratch);
        self.each_on_ground(at, 0.0, |_, _, _, touch| deepest = deepest.max(-touch.gap));
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

    fn pieces(&self, at: &dyn Geometry<2>, ids: &[ContactId], pieces: &mut Vec<u32>) {
        pieces.clear();
        if self.shapes.parts.iter().all(|part| part.radius == 0.0) {
            return;
        }
        pieces.extend(ids.iter().map(|id| self.piece(at, *id).unwrap_or(0)));
    }

    /// The place is that of the corner, or the rim of the corner's owner, so that a disc rolls by its radius; of two discs the middle of
    /// their gap or overlap.
    fn bring_together(&self, at: &dyn Geometry<2>, contact: &mut Candidate<2>) {
        if contact.gap == 0.0 {
            return;
        }
        let Some((_, members)) = self.shapes_of(contact.id) else { return };
        let feature = CornerOnSide::from_number(contact.id.point());
        let Some([_, (beside, _)]) = self.parts_of(members, feature) else { return };
        let is_disc = feature.round && self.shapes.local(beside).len() == 1;
        let share = if is_disc { 0.5 } else { 0.0 };
        // The normal points from the second body to the first.
        let towards = if feature.owner == 0 { contact.gap } else { -contact.gap };
        let across: Vector<2> = contact.frame.row(0).transpose() * towards;
        let mut shift = |side: usize, by: f64| {
            if by != 0.0 {
                let side = &mut contact.sides[side];
                side.point += BodyFrame::of(side.body, at).unturned(&across) * by;
            }
        };
        shift(feature.owner, -share);
        shift(1 - feature.owner, 1.0 - share);
    }

    fn beyond(&self, at: &dyn Geometry<2>, id: ContactId, direction: &Vector<2>) -> Option<f64> {
        let (_, members) = self.shapes_of(id)?;
        let CornerOnSide { owner, corner, side, .. } = CornerOnSide::from_number(id.point());
        let numbers = if owner == 0 { [corner, side] } else { [side, corner] };
        let [first, second] = [0, 1].map(|k| {
            let (member, part) = (members[k], self.shapes.part_of(members[k], numbers[k])?);
            Some(self.shapes.outline(part, BodyFrame::of(self.shapes.members[member].body, at)))
        });
        let (first, second) = (first?, second?);
        let apart = |along: &Vector<2>| -first.extent(&-along) - second.extent(along);
        let back = -direction;
        let of_sides = first.facing(&back).map(|normal| -normal).chain(second.facing(direction));
        Some(of_sides.map(|normal| apart(&normal)).fold(apart(direction), f64::max))
    }

    fn is_summit(&self, id: ContactId) -> bool {
        matches!(self.on_side(id), Some((_, _, (OnSide::Summit(_), _))))
    }

    fn fixed_side(&self, id: ContactId) -> Option<usize> {
        if self.on_side(id).is_some() {
            return None;
        }
        let corner = id.point() as usize;
        if let Ok(found) = self.surfaces.binary_search_by_key(&id.pair(), |(pair, _)| pair.pair) {
            return self.shapes.is_sharp_at(self.surfaces[found].1, corner).then_some(0);
        }
        let CornerOnSide { owner, corner, round, .. } = CornerOnSide::from_number(id.point());
        if let Ok(found) = self.on_profile.binary_search_by_key(&id.pair(), |(pair, _)| pair.pair) {
            return (owner == 0 && self.shapes.is_sharp_at(self.on_profile[found].1, corner)).then_some(0);
        }
        let between_shapes = self.pairs.binary_search_by_key(&id.pair(), |(pair, _)| pair.pair).is_ok()
            || self.near_pair(id.pair()).is_some();
        // Points have numbers that neither pairs nor groups have.
        if between_shapes { (!round).then_some(owner) } else { Some(0) }
    }

    fn wiring(&self) -> Vec<Wiring> {
        // Of groups there are too many pairs to be listed: what is found is checked as it comes.
        if self.groups.is_some() {
            return Vec::new();
        }
        let mut wiring = self.points.wiring();
        wiring.extend(self.pairs.iter().map(|(pair, members)| Wiring {
            pair: pair.pair,
            law: pair.law,
            bodies: pair.bodies,
            on_surface: false,
            contacts: self.capacity_of(*members),
            not_finite: None,
        }));
        wiring.extend(self.sides.iter().map(|(pair, member)| Wiring {
            pair: pair.pair,
            law: pair.law,
            bodies: [pair.body, pair.surface],
            on_surface: true,
            contacts: self.side_capacity(*member),
            not_finite: None,
        }));
        wiring.extend(self.surfaces.iter().map(|(pair, member)| Wiring {
            pair: pair.pair,
            law: pair.law,
            bodies: [pair.body, pair.surface],
            on_surface: true,
            contacts: self.shapes.corners_of(*member),
            not_finite: None,
        }));
        wiring.extend(self.on_profile.iter().map(|(pair, member)| Wiring {
            pair: pair.pair,
            law: pair.law,
            bodies: [pair.body, pair.ground],
            on_surface: false,
            contacts: self.profile_capacity(*member),
            not_finite: None,
        }));
        wiring
    }

    fn capacity(&self) -> usize {
        let listed = self.pairs.iter().map(|(_, members)| self.capacity_of(*members)).sum::<usize>();
        let parts = self.shapes.members.iter().map(|member| member.parts.len()).max().unwrap_or(0);
        let of_groups = self.groups.as_ref().map_or(0, |of| 2 * parts * parts * of.groups.pairs());
        let sides: usize = self.sides.iter().map(|(_, member)| self.side_capacity(*member)).sum();
        let on_profile: usize = self.on_profile.iter().map(|(_, member)| self.profile_capacity(*member)).sum();
        let surfaces: usize = self.surfaces.iter().map(|(_, member)| self.shapes.corners_of(*member)).sum();
        self.points.capacity() + listed + of_groups + surfaces + sides + on_profile
    }
}
