//! The places of bodies and contacts in model and state.

use crate::driven;
use crate::ground_profile;
use crate::required::Required;
use crate::scene::{ContactScene, Crowd, Scene, SupportingBody};
use crate::tilt_reference::TiltReference;
use std::ops::Range;
use std::sync::Arc;
use teeter_beam::{Beam, Deflection, ModalBasis, ShapeAt, SpanLoad};
use teeter_detect::{BodyId, ContactId, CornerOnSide, MOST_SUMMITS, OnSide};
use teeter_integrator::{BeamForces, Openings};

/// The place of a block in the state.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockPlace {
    /// Its name.
    pub name: String,
    /// Indices of its coordinates X, Y, φ, and of its velocities.
    pub range: Range<usize>,
    /// The shorter of its sides, m.
    pub side: f64,
    /// Largest distance from its mass centre to a corner, m.
    pub reach: f64,
    /// Swings up to this angle, at which no corner is lifted enough to count as open, are ignored,
    /// rad.
    pub still: f64,
    /// The reference from which its tilt is measured.
    pub tilt_reference: TiltReference,
}

/// The place of a beam in the state.
#[derive(Debug, Clone)]
pub struct BeamPlace {
    /// Its name.
    pub name: String,
    /// The beam.
    pub beam: Arc<Beam>,
    /// The modal basis to which its coordinates belong; `None` if its coordinates are its dofs.
    pub basis: Option<Arc<ModalBasis>>,
    /// Indices of its coordinates and velocities.
    pub range: Range<usize>,
    /// Indices of the displacements x and y of its supports, if they move; deflections are relative
    /// to them.
    pub supports: Option<Range<usize>>,
    /// Positions of the probes, m from its left end.
    pub probes: Vec<f64>,
    /// Its number as a body.
    pub body: BodyId,
    /// If it starts in equilibrium, the contact forces on it.
    pub pressed: Option<Vec<SpanLoad>>,
}

impl BeamPlace {
    /// Number of its velocities that no support holds.
    #[must_use]
    pub fn free_dofs(&self) -> usize {
        self.basis.as_ref().map_or_else(|| self.beam.free_dofs(), |basis| basis.len())
    }

    /// Midspan, and the midpoints between supports, as midspan may be a support, m from its left
    /// end.
    #[must_use]
    pub fn middles(&self) -> Vec<f64> {
        let mut places = vec![0.5 * self.beam.spec().span];
        for [from, to] in self.spans() {
            let x = 0.5 * (from + to);
            if !places.contains(&x) {
                places.push(x);
            }
        }
        places
    }

    /// The quarter points between supports, including the midpoints, m from its left end: none of
    /// its lower modes is 0 at all of them.
    #[must_use]
    pub fn quarters(&self) -> Vec<f64> {
        let quarters = |[from, to]: [f64; 2]| [0.25, 0.5, 0.75].map(|part| from + part * (to - from));
        self.spans().into_iter().flat_map(quarters).collect()
    }

    /// The intervals between supports, m from its left end.
    fn spans(&self) -> Vec<[f64; 2]> {
        let spec = self.beam.spec();
        let mut stops: Vec<f64> = spec.inner_supports.iter().map(|inner| inner.x).chain([0.0, spec.span]).collect();
        stops.sort_by(f64::total_cmp);
        stops.windows(2).map(|stops| [stops[0], stops[1]]).collect()
    }

    /// The deflection at a position on the beam for its own coordinates `q` (its rate for
    /// velocities); doesn't allocate.
    #[must_use]
    pub fn deflection(&self, at: &ShapeAt, q: &[f64]) -> Deflection {
        let Some(basis) = &self.basis else { return at.deflection(q) };
        let mut sum = Deflection { w: 0.0, slope: 0.0 };
        for (index, coordinate) in q.iter().enumerate() {
            let shape = at.deflection(basis.shape(index));
            sum.w += coordinate * shape.w;
            sum.slope += coordinate * shape.slope;
        }
        sum
    }

    /// The deflection at x (m, along the beam) for its own coordinates `q`; `None` outside the
    /// beam.
    #[must_use]
    pub fn deflection_at(&self, q: &[f64], x: f64) -> Option<Deflection> {
        Some(self.deflection(&self.beam.shape_at(x)?, q))
    }

    /// How far its supports have moved along x and y, for the coordinates `q` of the model (their rates for velocities), m; 0 where they don't move.
    #[must_use]
    pub fn support_displacement(&self, q: &[f64]) -> [f64; 2] {
        self.supports.as_ref().map_or([0.0; 2], |range| [q[range.start], q[range.start + 1]])
    }

    /// The displacement along its axis of the section at x (m, along the beam) for its own coordinates `q` (its rate for velocities), m; 0 of a beam
    /// without axial dofs. Doesn't allocate.
    #[must_use]
    pub fn axial_displacement_at(&self, q: &[f64], x: f64) -> f64 {
        let at = self.beam.axial_shape_clamped(x);
        match &self.basis {
            _ if !self.beam.has_axial_dofs() => 0.0,
            None => at.displacement(q),
            Some(basis) => q.iter().enumerate().map(|(index, own)| own * at.displacement(basis.shape(index))).sum(),
        }
    }

    /// The dofs of the beam for its own coordinates `q`.
    #[must_use]
    pub fn dofs(&self, q: &[f64]) -> Vec<f64> {
        self.basis.as_ref().map_or_else(|| q.to_vec(), |basis| basis.dofs(q))
    }
}

/// A contact pair: names, and the points that can touch.
#[derive(Debug, Clone, PartialEq)]
pub struct PairPlace {
    /// The contact's name.
    pub name: String,
    /// The bodies, in the order of the file.
    pub between: [String; 2],
    /// The points that can touch.
    pub points: Vec<ContactPoint>,
    /// Whether both are blocks: each has corners that can touch the other's sides.
    pub of_shapes: bool,
    /// Number of corners of its (first) block.
    pub corners: usize,
    /// Whether it is one of a block with ground that has a profile: its crests can touch the sides
    /// of the block.
    pub on_profile: bool,
    /// Whether it is one of a block with a beam that can touch the block's sides, too: its ends and
    /// humps come after the corners.
    pub on_sides: bool,
}

/// A point of a pair that can touch: a corner of a block.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactPoint {
    /// Its name in tables: the corner, preceded by its block if both have corners.
    pub name: String,
    /// The block, by its number in the scene.
    pub block: usize,
    /// The corner, counter-clockwise; for a rectangle from the bottom left. 0 for a crest.
    pub corner: usize,
    /// The point of the ground's profile, by its number, if it is that that touches the block, and
    /// no corner.
    pub crest: Option<usize>,
    /// What of a beam touches a side of the block, if it is that, and no corner.
    pub on_side: Option<OnSide>,
}

/// What of a beam can touch a side of a block, in the order of a pair's points.
fn on_sides() -> impl Iterator<Item = (OnSide, String)> {
    let ends = ["end-left", "end-right"].into_iter().enumerate();
    let humps = (0..MOST_SUMMITS).map(|which| (OnSide::Summit(which), format!("hump-{}", which + 1)));
    ends.map(|(which, name)| (OnSide::End(which), name.to_owned())).chain(humps)
}

impl ContactPoint {
    /// The points of a scene's contact.
    pub(crate) fn all(scene: &Scene, contact: &ContactScene) -> Vec<Self> {
        let corners = |block: usize| {
            let of = &scene.blocks[block];
            (0..of.corner_count()).map(move |corner| (corner, of.corner_name(corner)))
        };
        let Some(other) = contact.other_block() else {
            let block = contact.block;
            let point = |(corner, name)| Self { name, block, corner, crest: None, on_side: None };
            if contact.sides {
                let on_side = |(side, name)| Self { name, block, corner: 0, crest: None, on_side: Some(side) };
                return corners(block).map(point).chain(on_sides().map(on_side)).collect();
            }
            let profile = ground_profile::of(scene).filter(|_| contact.surface == SupportingBody::Ground);
            let crests = 0..profile.map_or(0, |profile| profile.points().count());
            let crest =
                |k: usize| Self { name: format!("crest-{}", k + 1), block, corner: 0, crest: Some(k), on_side: None };
            return corners(block).map(point).chain(crests.map(crest)).collect();
        };
        let of = |block: usize| {
            let named = move |name: String| format!("{}.{name}", scene.blocks[block].name);
            corners(block).map(move |(corner, name)| Self {
                name: named(name),
                block,
                corner,
                crest: None,
                on_side: None,
            })
        };
        of(contact.block).chain(of(other)).collect()
    }
}

impl PairPlace {
    /// The index of a contact's point among the pair's [points](Self::points); `None` if it is not
    /// one of them.
    #[must_use]
    pub fn point(&self, id: ContactId) -> Option<usize> {
        let number = if self.of_shapes {
            let CornerOnSide { owner, corner, .. } = CornerOnSide::from_number(id.point());
            owner * self.corners + corner
        } else if self.on_profile {
            let CornerOnSide { owner, corner, side, round } = CornerOnSide::from_number(id.point());
            match (owner, round) {
                (0, false) => corner,
                // A rounding that touches a crest.
                (0, true) => self.corners + side,
                _ => self.corners + corner,
            }
        } else if let Some((feature, _)) = OnSide::from_number(id.point()).filter(|_| self.on_sides) {
            // Alike whichever side of the block it is that touches, and a rounding beside it.
            self.corners
                + match feature {
                    OnSide::End(which) | OnSide::EndAtRounding(which) => which,
                    OnSide::Summit(which) => 2 + which,
                }
        } else {
            id.point() as usize
        };
        (number < self.points.len()).then_some(number)
    }
}

/// The pairs of blocks that are not listed: their names are found when they are asked for.
#[derive(Debug, Clone)]
pub struct CrowdPlace {
    /// Which contact holds for which blocks.
    pub crowd: Arc<Crowd>,
    /// The names of the corners of each block.
    corners: Vec<Arc<[String]>>,
}

impl CrowdPlace {
    pub(crate) fn of(scene: &Scene) -> Option<Self> {
        let crowd = Arc::new(scene.crowd.clone()?);
        let mut corners: Vec<Arc<[String]>> = Vec::with_capacity(scene.blocks.len());
        for block in &scene.blocks {
            let names: Vec<String> = (0..block.corner_count()).map(|corner| block.corner_name(corner)).collect();
            // Copies of a block have the names of the one before.
            match corners.last().filter(|last| last[..] == names[..]) {
                Some(last) => corners.push(Arc::clone(last)),
                None => corners.push(names.into()),
            }
        }
        Some(Self { crowd, corners })
    }
}

/// A contact by its names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ContactNames<'a> {
    /// The contact's name.
    pub contact: &'a str,
    /// The bodies: forces in tables are those on the first.
    pub between: [&'a str; 2],
    /// The point that touches.
    pub point: PointName<'a>,
}

/// The name of a point that touches: of two blocks, that of the block comes first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PointName<'a> {
    block: Option<&'a str>,
    point: &'a str,
}

impl std::fmt::Display for PointName<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if let Some(block) = self.block {
            f.write_str(block)?;
            f.write_str(".")?;
        }
        f.write_str(self.point)
    }
}

/// The places of bodies and contacts in model and state.
#[derive(Debug, Clone, Default)]
pub struct Layout {
    /// The blocks, in the order of the file.
    pub blocks: Vec<BlockPlace>,
    /// The beams, in the order of the file.
    pub beams: Vec<BeamPlace>,
    /// The listed pairs, by their number in the model.
    pub pairs: Vec<PairPlace>,
    /// The pairs of blocks that are not listed, whose numbers follow.
    pub crowd: Option<CrowdPlace>,
    /// Indices of the coordinates of moving ground: its origin, x and y, and its slope.
    pub ground: Option<Range<usize>>,
    /// When the contacts of a pair count as open.
    pub openings: Openings,
    /// What is left out of the model.
    pub required: Required,
    /// The most contacts that the model's detector can find at once, but for those of ends and
    /// humps of beams with sides of blocks, for which it makes room for more than there can be.
    pub possible_contacts: usize,
}

impl Layout {
    /// The names of a contact; `None` if there is none with this identity. Doesn't allocate.
    #[must_use]
    pub fn names_of(&self, id: ContactId) -> Option<ContactNames<'_>> {
        if let Some(pair) = self.pairs.get(id.pair() as usize) {
            let point = PointName { block: None, point: &pair.points[pair.point(id)?].name };
            return Some(ContactNames {
                contact: &pair.name,
                between: pair.between.each_ref().map(String::as_str),
                point,
            });
        }
        let of = self.crowd.as_ref()?;
        let blocks = of.crowd.blocks_of(self.pairs.len(), id.pair())?;
        let contact = of.crowd.contacts().get(of.crowd.contact_of(blocks[0], blocks[1])?)?;
        let CornerOnSide { owner, corner, .. } = CornerOnSide::from_number(id.point());
        let between = blocks.map(|block| self.blocks.get(block).map_or("", |place| place.name.as_str()));
        let point = of.corners.get(*blocks.get(owner)?)?.get(corner)?;
        Some(ContactNames { contact: &contact.name, between, point: PointName { block: Some(between[owner]), point } })
    }

    /// Whether two contacts are of one point by their names, as where a corner goes on from one piece of a profile, or one side of a block, to the next.
    #[must_use]
    pub fn is_one_point(&self, a: ContactId, b: ContactId) -> bool {
        if a == b || a.pair() != b.pair() {
            return a == b;
        }
        if let Some(pair) = self.pairs.get(a.pair() as usize) {
            return pair.point(a).is_some_and(|point| pair.point(b) == Some(point));
        }
        let [a, b] = [a, b].map(|id| CornerOnSide::from_number(id.point()));
        (a.owner, a.corner) == (b.owner, b.corner)
    }

    /// The numbers of all contacts that share a name: listed pairs one by one, then the contacts of
    /// the crowd; `None` if there is none with this pair.
    #[must_use]
    pub fn contact_number(&self, id: ContactId) -> Option<usize> {
        let pair = id.pair() as usize;
        if pair < self.pairs.len() {
            return Some(pair);
        }
        let of = self.crowd.as_ref()?;
        let [a, b] = of.crowd.blocks_of(self.pairs.len(), id.pair())?;
        Some(self.pairs.len() + of.crowd.contact_of(a, b)?)
    }

    /// The names of the contacts, by [`Layout::contact_number`].
    pub fn contact_names(&self) -> impl Iterator<Item = &str> + '_ {
        let of_crowd = self.crowd.iter().flat_map(|of| of.crowd.contacts().iter().map(|contact| contact.name.as_str()));
        self.pairs.iter().map(|pair| pair.name.as_str()).chain(of_crowd)
    }

    /// Computes the section forces of a beam, by its number, in a run of `scene`.
    #[must_use]
    pub fn beam_forces(&self, scene: &Scene, number: usize) -> BeamForces {
        let place = &self.beams[number];
        let mut forces = BeamForces::new(&place.beam, place.body, place.range.clone());
        if let Some(supports) = &place.supports {
            forces = forces.with_supports(supports.start + 1);
        }
        if let Some(basis) = &place.basis {
            forces = forces.in_modes(Arc::clone(basis));
        }
        match driven::placed_loads(scene, number, &place.beam) {
            Some(loads) => forces.with_loads(Box::new(loads)),
            None => forces,
        }
    }
}
