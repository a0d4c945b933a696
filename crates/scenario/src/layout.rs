//! Who is where in model and state.

use crate::carrier::Carrier;
use crate::driven;
use crate::required::Required;
use crate::scene::{ContactScene, Scene};
use std::ops::Range;
use std::sync::Arc;
use teeter_beam::{Beam, Deflection, ModalBasis, ShapeAt, SpanLoad};
use teeter_detect::{BodyId, ContactId, CornerOnSide};
use teeter_integrator::{BeamForces, Opening};

/// Where a block is in the state.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockPlace {
    /// Its name.
    pub name: String,
    /// Its coordinates X, Y, φ; its velocities have the same places.
    pub range: Range<usize>,
    /// The shorter of its sides, m.
    pub side: f64,
    /// From its mass centre to a corner, m.
    pub reach: f64,
    /// A swing up to this angle, at which no corner is off its surface by more than counts as open,
    /// is none, rad.
    pub still: f64,
    /// What carries it: its rocking is measured from there.
    pub carrier: Carrier,
}

/// Where a beam is in the state.
#[derive(Debug, Clone)]
pub struct BeamPlace {
    /// Its name.
    pub name: String,
    /// The beam.
    pub beam: Arc<Beam>,
    /// The shapes in which it moves: its coordinates are theirs. `None`: its coordinates are its
    /// dofs.
    pub basis: Option<Arc<ModalBasis>>,
    /// Its coordinates; its velocities have the same places.
    pub range: Range<usize>,
    /// The displacements x and y of its supports, where they move; deflections are relative to
    /// them.
    pub supports: Option<Range<usize>>,
    /// Places whose deflection is written, m from its left end.
    pub probes: Vec<f64>,
    /// Its number as a body.
    pub body: BodyId,
    /// Where it starts in equilibrium: the forces of contacts that press on it there.
    pub pressed: Option<Vec<SpanLoad>>,
}

impl BeamPlace {
    /// How many velocities it has that no support holds.
    #[must_use]
    pub fn free_dofs(&self) -> usize {
        self.basis.as_ref().map_or_else(|| self.beam.free_dofs(), |basis| basis.len())
    }

    /// Midspan, and the middle between two supports, as midspan may be one, m from its left end.
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

    /// The quarters between two supports, their middles among them, m from its left end: none of
    /// its lower modes is 0 at all of them.
    #[must_use]
    pub fn quarters(&self) -> Vec<f64> {
        let quarters = |[from, to]: [f64; 2]| [0.25, 0.5, 0.75].map(|part| from + part * (to - from));
        self.spans().into_iter().flat_map(quarters).collect()
    }

    /// From where to where there is no support, m from its left end.
    fn spans(&self) -> Vec<[f64; 2]> {
        let spec = self.beam.spec();
        let mut stops: Vec<f64> = spec.inner_supports.iter().map(|inner| inner.x).chain([0.0, spec.span]).collect();
        stops.sort_by(f64::total_cmp);
        stops.windows(2).map(|stops| [stops[0], stops[1]]).collect()
    }

    /// The deflection at a place of the beam for its own coordinates `q` (its rate for velocities);
    /// allocates nothing.
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

    /// The deflection at x (m, along the beam) for its own coordinates `q`; `None` off the beam.
    #[must_use]
    pub fn deflection_at(&self, q: &[f64], x: f64) -> Option<Deflection> {
        Some(self.deflection(&self.beam.shape_at(x)?, q))
    }

    /// The dofs of the beam for its own coordinates `q`.
    #[must_use]
    pub fn dofs(&self, q: &[f64]) -> Vec<f64> {
        self.basis.as_ref().map_or_else(|| q.to_vec(), |basis| basis.dofs(q))
    }
}

/// A contact pair: its names, and the points at which it can touch.
#[derive(Debug, Clone, PartialEq)]
pub struct PairPlace {
    /// The contact's name.
    pub name: String,
    /// The bodies, in the order of the file.
    pub between: [String; 2],
    /// The points at which it can touch.
    pub points: Vec<ContactPoint>,
    /// Whether the two are blocks: each has corners that the other's sides can touch.
    pub of_shapes: bool,
    /// How many corners its (first) block has.
    pub corners: usize,
}

/// A point at which a pair can touch: a corner of a block.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactPoint {
    /// What it is called in tables: the corner, with its block before it where both have corners.
    pub name: String,
    /// The block, by its number in the scene.
    pub block: usize,
    /// The corner, counter-clockwise; of a rectangle from the bottom left.
    pub corner: usize,
}

impl ContactPoint {
    /// The points of a scene's contact.
    pub(crate) fn all(scene: &Scene, contact: &ContactScene) -> Vec<Self> {
        let corners = |block: usize| {
            let of = &scene.blocks[block];
            (0..of.corner_count()).map(move |corner| (corner, of.corner_name(corner)))
        };
        let Some(other) = contact.other_block() else {
            let point = |(corner, name)| Self { name, block: contact.block, corner };
            return corners(contact.block).map(point).collect();
        };
        let of = |block: usize| {
            let named = move |name: String| format!("{}.{name}", scene.blocks[block].name);
            corners(block).map(move |(corner, name)| Self { name: named(name), block, corner })
        };
        of(contact.block).chain(of(other)).collect()
    }
}

impl PairPlace {
    /// The number of a contact's point among the pair's [points](Self::points); `None` for an
    /// identity that is not one of them.
    #[must_use]
    pub fn point(&self, id: ContactId) -> Option<usize> {
        let number = if self.of_shapes {
            let CornerOnSide { owner, corner, .. } = CornerOnSide::from_number(id.point())?;
            owner * self.corners + corner
        } else {
            id.point() as usize
        };
        (number < self.points.len()).then_some(number)
    }
}

/// Who is where in model and state.
#[derive(Debug, Clone, Default)]
pub struct Layout {
    /// The blocks, in the order of the file.
    pub blocks: Vec<BlockPlace>,
    /// The beams, in the order of the file.
    pub beams: Vec<BeamPlace>,
    /// The pairs, by their number in the model.
    pub pairs: Vec<PairPlace>,
    /// The coordinates of ground that moves: the place of its origin, x and y, and its slope.
    pub ground: Option<Range<usize>>,
    /// When the contacts of a pair count as truly open, by its number in the model.
    pub openings: Vec<Opening>,
    /// What the model does without.
    pub required: Required,
}

impl Layout {
    /// What watches the section forces of a beam, by its number, in a run of `scene`.
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
