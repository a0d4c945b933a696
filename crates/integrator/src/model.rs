//! An immutable scene: subsystems, contact laws, and the detector that says which bodies can touch.

use crate::mismatch::{Identity, length};
use crate::stage::ContactRows;
use crate::stage::RESERVED_CONTACTS;
use crate::{Energy, ImpactLaw, Linearised, Mismatch, PairLaw, Size, Stretching, Subsystem, Traits, Vector};
use std::collections::HashMap;
use std::ops::Range;
use teeter_detect::{
    BodyId, Candidate, Candidates, ContactDetector, DetectorMemory, Geometry, HalfSpace, Kinematics, LawId, Summit,
    SurfacePoint, Wiring,
};

/// What is wrong with a model.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ModelError {
    /// A coefficient outside its range.
    #[error("{what} of law {} is {value}, but must be {rule}", law.0)]
    Law {
        /// Which coefficient.
        what: &'static str,
        /// The law.
        law: LawId,
        /// Its value.
        value: f64,
        /// The range.
        rule: &'static str,
    },
    /// A pair whose law wasn't added.
    #[error("pair {pair} has law {}, but the model has {laws}: use what ModelBuilder::law returned", law.0)]
    NoLaw {
        /// The pair.
        pair: u32,
        /// The law.
        law: LawId,
        /// How many laws there are.
        laws: usize,
    },
    /// Two pairs with the same number: their contacts could not be told apart.
    #[error("the detector has pair {pair} twice: number each in its own way")]
    PairTwice {
        /// The number.
        pair: u32,
    },
    /// A pair without a point.
    #[error("pair {pair} has no points, so nothing of it can ever touch")]
    NoPoints {
        /// The number.
        pair: u32,
    },
    /// A point that is not finite.
    #[error("point {point} of pair {pair} is not finite")]
    Point {
        /// The number.
        pair: u32,
        /// Which point.
        point: usize,
    },
    /// A pair with a body that wasn't added.
    #[error("pair {pair} is of body {}, but the model has {bodies}: use the body that ModelBuilder::add returned", body.0)]
    Body {
        /// The pair.
        pair: u32,
        /// The body.
        body: BodyId,
        /// How many bodies there are.
        bodies: usize,
    },
    /// A pair on the surface of a body that has none.
    #[error("pair {pair} is on the surface of body {}, which has none", body.0)]
    NoSurface {
        /// The pair.
        pair: u32,
        /// The body.
        body: BodyId,
    },
    /// A pair of a body with itself.
    #[error("pair {pair} is of body {} against itself", body.0)]
    Itself {
        /// The pair.
        pair: u32,
        /// The body.
        body: BodyId,
    },
    /// A load on, or a motion of, a block that doesn't exist.
    #[error("there is no block {block}: there are {blocks}, numbered from 0")]
    Block {
        /// Its number.
        block: usize,
        /// How many there are.
        blocks: usize,
    },
    /// A load that is not finite.
    #[error("a load of block {block} is not finite")]
    Load {
        /// Number of the block.
        block: usize,
    },
    /// A subsystem whose prescribed or held velocities aren't ascending numbers of its velocities.
    #[error("the {what} velocities of subsystem {part} must be rising numbers below {velocities}")]
    Velocities {
        /// Prescribed or held ones.
        what: &'static str,
        /// Number of the subsystem, in the order of adding.
        part: usize,
        /// How many velocities it has.
        velocities: usize,
    },
}

/// A subsystem with its places in the state.
#[non_exhaustive]
pub struct Part<const D: usize> {
    /// The subsystem.
    pub system: Box<dyn Subsystem<D>>,
    /// Its coordinates.
    pub q: Range<usize>,
    /// Its velocities.
    pub v: Range<usize>,
    pub(crate) traits: Traits,
    /// α of C = αM, 1/s; else 0.
    pub(crate) mass_damping: f64,
    /// The same among the velocities that are not prescribed.
    pub(crate) free_mass_damping: f64,
    /// Whether it has a part of its potential that [stretches](crate::Dynamics::stretching).
    stretches: bool,
    /// Most columns of a row.
    pub(crate) row: usize,
}

/// Where a subsystem is in the model and in its states.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct PartPlace {
    /// Its number, in the order of adding.
    pub part: usize,
    /// The numbers of its bodies.
    pub bodies: Range<u32>,
    /// Its coordinates.
    pub q: Range<usize>,
    /// Its velocities.
    pub v: Range<usize>,
}

impl PartPlace {
    /// Its first body: the only one of a beam or of the ground. If the subsystem has no bodies, the
    /// model refuses pairs with it.
    #[must_use]
    pub fn body(&self) -> BodyId {
        BodyId(self.bodies.start)
    }

    /// The body with this number within the subsystem. A number beyond its bodies gives a body of
    /// another subsystem, or none: see [`PartPlace::bodies`](Self#structfield.bodies).
    #[must_use]
    pub fn nth_body(&self, number: u32) -> BodyId {
        BodyId(self.bodies.start.saturating_add(number))
    }
}

impl<const D: usize> Part<D> {
    /// The subsystem's properties, as they were when the model was built.
    #[must_use]
    pub fn traits(&self) -> &Traits {
        &self.traits
    }

    /// The part of its potential that stretches; that there is none is known without asking it.
    #[inline]
    pub(crate) fn stretching(&self) -> Option<&dyn Stretching> {
        if self.stretches { self.system.stretching() } else { None }
    }

    /// Whether all of its velocities are prescribed: no impulse changes any.
    pub(crate) fn is_prescribed(&self) -> bool {
        self.traits.driven.len() == self.v.len()
    }

    /// Whether any of its velocities is prescribed.
    pub(crate) fn is_driven(&self) -> bool {
        !self.traits.driven.is_empty()
    }
}

impl<const D: usize> std::fmt::Debug for Part<D> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Part").field("q", &self.q).field("v", &self.v).finish_non_exhaustive()
    }
}

/// The subsystems, bodies, laws and the detector of a scene.
pub struct Model<const D: usize> {
    parts: Vec<Part<D>>,
    /// Part and number within it of each body.
    bodies: Vec<(usize, u32)>,
    laws: Vec<PairLaw>,
    springs: bool,
    contacts: bool,
    driven: bool,
    /// Whether the detector listed its pairs, so that its candidates needn't be checked.
    wired: bool,
    detector: Box<dyn ContactDetector<D>>,
    size: Size,
    identity: Identity,
}

impl<const D: usize> std::fmt::Debug for Model<D> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Model").field("size", &self.size).field("laws", &self.laws).finish_non_exhaustive()
    }
}

/// Collects the parts of a [`Model`].
pub struct ModelBuilder<const D: usize> {
    parts: Vec<Part<D>>,
    bodies: Vec<(usize, u32)>,
    laws: Vec<PairLaw>,
    size: Size,
}

impl<const D: usize> std::fmt::Debug for ModelBuilder<D> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ModelBuilder").field("size", &self.size).field("laws", &self.laws).finish_non_exhaustive()
    }
}

impl<const D: usize> Default for ModelBuilder<D> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const D: usize> ModelBuilder<D> {
    /// Nothing yet.
    #[must_use]
    pub fn new() -> Self {
        Self { parts: Vec::new(), bodies: Vec::new(), laws: Vec::new(), size: Size::default() }
    }

    /// Adds a subsystem, and returns where its bodies, coordinates and velocities are.
    pub fn add(&mut self, system: impl Subsystem<D> + 'static) -> PartPlace {
        self.add_boxed(Box::new(system))
    }

    /// As [`ModelBuilder::add`], for a boxed subsystem.
    pub fn add_boxed(&mut self, system: Box<dyn Subsystem<D>>) -> PartPlace {
        let (size, part) = (system.size(), self.parts.len());
        let first = self.bodies.len() as u32;
        self.bodies.extend((0..size.bodies as u32).map(|local| (part, local)));
        let (q, v) = (self.size.q..self.size.q + size.q, self.size.v..self.size.v + size.v);
        let (place_q, place_v) = (q.clone(), v.clone());
        let traits = system.traits();
        let mass_damping = system.linearised().map_or(0.0, Linearised::mass_damping);
        let free_mass_damping = system.linearised().map_or(0.0, Linearised::free_mass_damping);
        let stretches = system.stretching().is_some();
        self.parts.push(Part { system, q, v, traits, mass_damping, free_mass_damping, stretches, row: size.row });
        self.size = Size {
            q: self.size.q + size.q,
            v: self.size.v + size.v,
            bodies: self.size.bodies + size.bodies,
            row: self.size.row.max(size.row),
        };
        PartPlace { part, bodies: first..self.bodies.len() as u32, q: place_q, v: place_v }
    }

    /// Adds a contact law, and returns the handle by which the detector refers to it.
    pub fn law(&mut self, law: PairLaw) -> LawId {
        self.laws.push(law);
        LawId((self.laws.len() - 1) as u32)
    }

    /// The model.
    ///
    /// # Errors
    /// If a coefficient of a law is out of its range, or the detector has pairs that can't work:
    /// with laws or bodies that weren't added, on a surface that a body doesn't have, of a body
    /// with itself. Pairs that a detector doesn't [list](ContactDetector::wiring) are checked in
    /// the steps.
    pub fn build(self, detector: Box<dyn ContactDetector<D>>) -> Result<Model<D>, ModelError> {
        for (number, law) in self.laws.iter().enumerate() {
            let law_id = LawId(number as u32);
            law.check().map_err(|(what, value, rule)| ModelError::Law { what, law: law_id, value, rule })?;
        }
        self.check_parts()?;
        let wiring = detector.wiring();
        self.check_wiring(&wiring)?;
        let springs = self.laws.iter().any(|law| law.impact.spring().is_some());
        let contacts = detector.capacity() > 0;
        let driven = self.parts.iter().any(Part::is_driven);
        Ok(Model {
            parts: self.parts,
            bodies: self.bodies,
            laws: self.laws,
            springs,
            driven,
            contacts,
            wired: !wiring.is_empty(),
            detector,
            size: self.size,
            identity: Identity::new(),
        })
    }
}

impl<const D: usize> ModelBuilder<D> {
    fn check_parts(&self) -> Result<(), ModelError> {
        for (number, part) in self.parts.iter().enumerate() {
            let velocities = part.v.len();
            for (what, given) in [("prescribed", &part.traits.driven), ("held", &part.traits.held)] {
                if !given.is_sorted_by(|a, b| a < b) || given.last().is_some_and(|last| *last >= velocities) {
                    return Err(ModelError::Velocities { what, part: number, velocities });
                }
            }
        }
        Ok(())
    }

    fn check_wiring(&self, wiring: &[Wiring]) -> Result<(), ModelError> {
        let mut seen: HashMap<u32, ([BodyId; 2], LawId)> = HashMap::with_capacity(wiring.len());
        for &Wiring { pair, law, bodies: [first, second], on_surface, contacts, not_finite } in wiring {
            if law.0 as usize >= self.laws.len() {
                return Err(ModelError::NoLaw { pair, law, laws: self.laws.len() });
            }
            for body in [first, second] {
                if body.0 as usize >= self.bodies.len() {
                    return Err(ModelError::Body { pair, body, bodies: self.bodies.len() });
                }
            }
            if first == second {
                return Err(ModelError::Itself { pair, body: first });
            }
            let (part, number) = self.bodies[second.0 as usize];
            // Corners on a body's surface and sides against its fibre are one pair, and so are points with different laws.
            if let Some(([body, other], other_law)) = seen.insert(pair, ([first, second], law)) {
                let another = if other == second { other_law != law } else { self.bodies[other.0 as usize].0 == part };
                if body != first || !another {
                    return Err(ModelError::PairTwice { pair });
                }
            }
            if on_surface && !self.parts[part].system.has_surface(number) {
                return Err(ModelError::NoSurface { pair, body: second });
            }
            if contacts == 0 {
                return Err(ModelError::NoPoints { pair });
            }
            if let Some(point) = not_finite {
                return Err(ModelError::Point { pair, point });
            }
        }
        Ok(())
    }
}

/// Contacts to expect for each velocity: twelve of a block in the plane, where half as many touch it in a dense packing.
const CONTACTS_PER_VELOCITY: usize = 4;

impl<const D: usize> Model<D> {
    /// Coordinates, velocities, bodies, and the longest row.
    #[must_use]
    pub fn size(&self) -> Size {
        self.size
    }

    /// A law.
    ///
    /// # Errors
    /// For one that the model doesn't have.
    #[inline]
    pub fn law(&self, law: LawId) -> Result<PairLaw, Mismatch> {
        self.law_of(law).copied()
    }

    /// The same without a copy.
    #[inline]
    pub(crate) fn law_of(&self, law: LawId) -> Result<&PairLaw, Mismatch> {
        match self.laws.get(law.0 as usize) {
            Some(law) => Ok(law),
            None => Err(Mismatch::Law { law, laws: self.laws.len() }),
        }
    }

    /// Puts the candidates with a gap of at most `margin` (m) at coordinates `q` into `out`, in the
    /// detector's order, without a detector's memory: for a single look. Steps use
    /// [`Workspace::detect`](crate::Workspace::detect).
    ///
    /// # Errors
    /// If there are too few or too many coordinates.
    pub fn candidates(&self, q: &[f64], margin: f64, out: &mut Candidates<D>) -> Result<(), Mismatch> {
        self.detector.detect(&self.placed(q)?, margin, &mut DetectorMemory::default(), out);
        Ok(())
    }

    /// Refuses candidates of pairs and bodies that the model doesn't have.
    pub(crate) fn check_candidates(&self, candidates: &[Candidate<D>]) -> Result<(), Mismatch> {
        if self.wired {
            return Ok(());
        }
        for candidate in candidates {
            self.law(candidate.law)?;
            for side in &candidate.sides {
                if side.body.0 as usize >= self.bodies.len() {
                    return Err(Mismatch::Body { body: side.body, bodies: self.bodies.len() });
                }
            }
        }
        Ok(())
    }

    pub(crate) fn identity(&self) -> Identity {
        self.identity
    }

    /// Whether the slices are as long as the coordinates and velocities.
    pub(crate) fn fits(&self, q: &[f64], v: &[f64]) -> Result<(), Mismatch> {
        length("the coordinates", q, self.size.q)?;
        length("the velocities", v, self.size.v)
    }

    /// Whether there is a law with duration.
    pub(crate) fn has_springs(&self) -> bool {
        self.springs
    }

    /// Whether a law can take more than one problem a step.
    pub(crate) fn has_laws(&self) -> bool {
        self.laws.iter().any(|law| law.impact != ImpactLaw::Newton || law.restitution > 0.0)
    }

    /// Whether any velocity is prescribed.
    pub(crate) fn is_driven(&self) -> bool {
        self.driven
    }

    /// Whether anything can ever touch: if not, steps don't look.
    pub(crate) fn has_contacts(&self) -> bool {
        self.contacts
    }

    /// As many contacts as memory is made for at the start. A detector of groups of bodies counts the contacts of all pairs, whose
    /// number goes with the square of the bodies'; rigid bodies can't all touch each other at once. A step with more contacts than this
    /// and than ever before allocates.
    pub(crate) fn contacts_to_expect(&self) -> usize {
        self.detector.capacity().min(RESERVED_CONTACTS.max(CONTACTS_PER_VELOCITY * self.size().v))
    }

    /// The detector.
    #[must_use]
    pub fn detector(&self) -> &dyn ContactDetector<D> {
        self.detector.as_ref()
    }

    /// The bodies placed at coordinates `q`, for a detector to look at.
    ///
    /// # Errors
    /// If there are too few or too many coordinates.
    pub fn placed<'a>(&'a self, q: &'a [f64]) -> Result<Placed<'a, D>, Mismatch> {
        length("the coordinates", q, self.size.q)?;
        Ok(self.placed_at(q))
    }

    /// The same without checks of lengths.
    pub(crate) fn placed_at<'a>(&'a self, q: &'a [f64]) -> Placed<'a, D> {
        Placed { model: self, q }
    }

    /// A contact that was found at coordinates `q`, with both sides in one place ([`ContactDetector::bring_together`]).
    pub(crate) fn in_one_place(&self, q: &[f64], candidate: &Candidate<D>) -> Candidate<D> {
        let mut together = *candidate;
        self.detector.bring_together(&self.placed_at(q), &mut together);
        together
    }

    /// Writes the prescribed velocities at time `t` into their places in `v`.
    ///
    /// # Errors
    /// If there are too few or too many velocities.
    pub fn drive(&self, t: f64, v: &mut [f64]) -> Result<(), Mismatch> {
        length("the velocities", v, self.size.v)?;
        self.drive_at(t, v);
        Ok(())
    }

    /// The same without checks of lengths.
    pub(crate) fn drive_at(&self, t: f64, v: &mut [f64]) {
        for part in self.parts.iter().filter(|part| part.is_driven()) {
            part.system.drive(t, &mut v[part.v.clone()]);
        }
    }

    /// The means of the prescribed velocities over the time from `times[0]` to `times[1]` (s),
    /// without checks of lengths.
    pub(crate) fn drive_mean_at(&self, times: [f64; 2], v: &mut [f64]) {
        for part in self.parts.iter().filter(|part| part.is_driven()) {
            part.system.drive_mean(times, &mut v[part.v.clone()]);
        }
    }

    /// The energies at (q, v).
    ///
    /// # Errors
    /// If there are too few or too many coordinates or velocities.
    pub fn energy(&self, q: &[f64], v: &[f64]) -> Result<Energy, Mismatch> {
        self.fits(q, v)?;
        Ok(self.energy_at(q, v))
    }

    /// The same without checks of lengths.
    pub(crate) fn energy_at(&self, q: &[f64], v: &[f64]) -> Energy {
        let mut energy = Energy::default();
        for part in &self.parts {
            energy += part.system.energy(&q[part.q.clone()], &v[part.v.clone()]);
        }
        energy
    }

    /// The least energy scale of the scene, J: the sum of m g R over its blocks.
    #[must_use]
    pub fn energy_scale(&self) -> f64 {
        self.parts.iter().map(|part| part.traits.energy_scale).sum()
    }

    /// `out = q ⊕ τ v`: the coordinates after moving with velocities `v` for the time `tau` (s).
    ///
    /// # Errors
    /// If there are too few or too many coordinates or velocities.
    pub fn retract(&self, q: &[f64], v: &[f64], tau: f64, out: &mut [f64]) -> Result<(), Mismatch> {
        self.fits(q, v)?;
        length("the coordinates to be", out, self.size.q)?;
        self.move_along(q, v, tau, out);
        Ok(())
    }

    /// The same without checks of lengths.
    pub(crate) fn move_along(&self, q: &[f64], v: &[f64], tau: f64, out: &mut [f64]) {
        for part in self.parts.iter().filter(|part| !part.q.is_empty()) {
            part.system.retract(&q[part.q.clone()], &v[part.v.clone()], tau, &mut out[part.q.clone()]);
        }
    }

    /// A speed that no point of any body exceeds at velocities `v`, m/s; infinity where none is known.
    pub(crate) fn fastest(&self, v: &[f64]) -> f64 {
        self.speeds(v).fold(0.0, f64::max)
    }

    /// Of each part a speed that no point of it exceeds at velocities `v`, m/s; infinity where none is known.
    pub(crate) fn speeds(&self, v: &[f64]) -> impl Iterator<Item = f64> {
        self.parts.iter().map(|part| part.system.fastest(&v[part.v.clone()]))
    }

    /// How many bodies there are; their numbers are below it.
    pub(crate) fn body_count(&self) -> usize {
        self.bodies.len()
    }

    /// Whether a body can move, and not only as prescribed.
    pub(crate) fn moves(&self, body: BodyId) -> bool {
        self.owner(body).is_some_and(|(_, part, _)| part.row > 0 && !part.is_prescribed())
    }

    /// The relative velocity u = v_0 − v_1 of a candidate in its frame, by its Jacobian rows at
    /// `q`, m/s.
    ///
    /// # Errors
    /// If there are too few or too many coordinates or velocities, or the candidate is of a pair or
    /// a body that the model doesn't have.
    pub fn relative_velocity(&self, candidate: &Candidate<D>, q: &[f64], v: &[f64]) -> Result<Vector<D>, Mismatch> {
        self.fits(q, v)?;
        self.law(candidate.law)?;
        let mut rows = ContactRows::default();
        rows.push(self, q, candidate)?;
        Ok(rows.velocity(0, v))
    }

    /// The subsystems with their places in the state.
    #[must_use]
    pub fn parts(&self) -> &[Part<D>] {
        &self.parts
    }

    /// The number of a body's part, the part, and the body's number within it; `None` for a body
    /// that the model doesn't have.
    #[must_use]
    pub fn owner(&self, body: BodyId) -> Option<(usize, &Part<D>, u32)> {
        let &(part, local) = self.bodies.get(body.0 as usize)?;
        Some((part, &self.parts[part], local))
    }
}

/// The bodies of a model at given coordinates.
#[derive(Debug)]
pub struct Placed<'a, const D: usize> {
    model: &'a Model<D>,
    q: &'a [f64],
}

impl<const D: usize> Geometry<D> for Placed<'_, D> {
    fn place(&self, body: BodyId, local: &[Vector<D>], out: &mut [Vector<D>]) {
        if let Some((_, part, number)) = self.model.owner(body) {
            part.system.place(number, &self.q[part.q.clone()], local, out);
        }
    }

    fn surface(&self, body: BodyId, kinematics: Kinematics, at: &Vector<D>) -> Option<SurfacePoint<D>> {
        let (_, part, number) = self.model.owner(body)?;
        part.system.surface(number, &self.q[part.q.clone()], kinematics, at)
    }
    fn reach(&self, body: BodyId, margin: f64) -> Option<HalfSpace<D>> {
        let (_, part, number) = self.model.owner(body)?;
        part.system.reach(number, &self.q[part.q.clone()], margin)
    }

    fn summits(
        &self,
        body: BodyId,
        _: Kinematics,
        direction: &Vector<D>,
        between: &[Vector<D>; 2],
        each: &mut dyn FnMut(Summit<D>),
    ) {
        if let Some((_, part, number)) = self.model.owner(body) {
            part.system.summits(number, &self.q[part.q.clone()], direction, between, each);
        }
    }

    fn ends(&self, body: BodyId, _: Kinematics) -> [Option<SurfacePoint<D>>; 2] {
        let owner = self.model.owner(body);
        owner.map_or([None, None], |(_, part, number)| part.system.ends(number, &self.q[part.q.clone()]))
    }
}
