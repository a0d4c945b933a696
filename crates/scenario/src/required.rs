//! Finds what can't affect the motion of a scene, to leave it out of the model: points that never
//! touch, beams that never move (`docs/required.md` has the proofs).
//!
//! The set of removals found is consistent: if one of them were wrong, there would be a first step
//! that shows it, and until that step everything moved as the reasons say. So each reason may
//! depend on all others. The search starts with every pair removed, except those of blocks with
//! what they stand on, and restores the pairs whose removal can't be proved until nothing changes.

mod at_rest;
mod barrier;
mod beam_bounds;
mod reach;

use crate::scene::{ContactScene, Scene, SupportingBody};
use crate::simulation::Layout;
use at_rest::BeamAtRest;
pub(crate) use at_rest::RestingBody;
use barrier::Barrier;
use reach::Reach;
use teeter_integrator::{Energy, Model, State};

/// How much of a scene is modelled.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Extent {
    /// Only what can affect the motion.
    #[default]
    Required,
    /// Everything in the scene.
    Full,
}

impl Extent {
    /// Its word in options and summaries.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Required => "required",
            Self::Full => "full",
        }
    }
}

/// A part of the scene that is left out of the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Removed {
    /// The part.
    pub what: String,
    /// Why it has no effect, with the numbers of the bound.
    pub why: String,
    /// Largest difference of a run from one with this part; `None` if every number is the same.
    pub accuracy: Option<String>,
}

/// The parts of a scene that are modelled.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Required {
    /// The requested extent.
    pub extent: Extent,
    /// The removed parts; empty for the full model.
    pub removed: Vec<Removed>,
    /// Limits that the run must keep for the removals to be valid; `None` if they are valid
    /// unconditionally.
    pub limits: Option<Limits>,
    /// For each contact of the scene, how many corners of its block are checked, the bottom ones
    /// first.
    points: Vec<usize>,
    /// For each beam, its energy at rest; `None` for those that move.
    at_rest: Vec<Option<Energy>>,
}

/// The conditions for removals by energy, besides the scene: the scheme must not generate energy,
/// and contacts must not penetrate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Largest kinetic and potential energy of the model, J, counted as in the ledger.
    pub energy: f64,
    /// Deepest penetration, m.
    pub penetration: f64,
}

/// Number of corners that a block stands on; they are the first.
const FEET: usize = 2;

impl Limits {
    /// Whether the run up to this state has kept them, judging by its last step and its tally.
    #[must_use]
    pub fn hold(&self, state: &State) -> bool {
        state.ledger.current.total() <= self.energy && state.tally.max_penetration <= self.penetration
    }
}

impl Required {
    /// The full model.
    pub(crate) fn all(scene: &Scene) -> Self {
        Self {
            extent: Extent::Full,
            points: scene.contacts.iter().map(|contact| scene.blocks[contact.block].corner_count()).collect(),
            at_rest: vec![None; scene.beams.len()],
            ..Self::default()
        }
    }

    /// Whether a beam, by its number in the scene, is left out because it never moves.
    #[must_use]
    pub fn is_at_rest(&self, beam: usize) -> bool {
        self.rests(beam).is_some()
    }

    /// How many corners of the block of a contact, by its number in the scene, are checked.
    #[must_use]
    pub fn points(&self, contact: usize) -> usize {
        self.points.get(contact).copied().unwrap_or_default()
    }

    /// Whether the beam of a contact, by its number in the scene, is checked against sides of the
    /// block, too.
    #[must_use]
    pub fn sides(&self, scene: &Scene, contact: usize) -> bool {
        scene.contacts[contact].sides && self.points(contact) > 0
    }

    /// The energy of a beam at rest; `None` for one that moves.
    pub(crate) fn rests(&self, beam: usize) -> Option<Energy> {
        self.at_rest.get(beam).copied().flatten()
    }

    /// The required parts of the scene, from its initial state (q, v) in the full model.
    pub(crate) fn of(scene: &Scene, layout: &Layout, model: &Model<2>, q: &[f64], v: &[f64]) -> Self {
        let mut required = Self { extent: Extent::Required, ..Self::all(scene) };
        // Blocks of a crowd may be anywhere, as any of them may be pushed by others.
        if scene.crowd.is_some() {
            return required;
        }
        let start = InitialMotion { scene, layout, model, q, v };
        let rests: Vec<Option<BeamAtRest>> =
            (0..scene.beams.len()).map(|k| BeamAtRest::of(&start, k, scene.time.steps())).collect();
        let inactive = scene.contacts.iter().map(|contact| !start.is_stood_on(contact)).collect();
        let Some((pairs, barrier, reaches)) = InactivePairs::search(&start, inactive, &rests) else { return required };
        let inactive = &pairs.inactive;
        for (k, contact) in scene.contacts.iter().enumerate().filter(|(k, _)| inactive[*k]) {
            required.points[k] = 0;
            required.removed.push(Removed {
                what: format!("contact `{}`: all of it", contact.name),
                why: reaches[contact.block].reason(&start, contact),
                accuracy: None,
            });
        }
        for (k, rest) in rests.iter().enumerate() {
            let Some(rest) = rest.as_ref().filter(|_| !pairs.touched[k]) else { continue };
            required.at_rest[k] = Some(rest.energy);
            required.removed.push(rest.removed(&scene.beams[k].name));
        }
        if let Some(barrier) = barrier {
            for (k, contact) in scene.contacts.iter().enumerate().filter(|(k, _)| !inactive[*k]) {
                required.points[k] = FEET;
                required.removed.push(barrier.removed(&start, contact));
            }
            required.limits = Some(barrier.limits);
        }
        required
    }
}

/// The pairs assumed never to touch, and what remains.
struct InactivePairs {
    /// For each contact, whether it is one of them.
    inactive: Vec<bool>,
    /// For each block, the contacts that may act.
    live: Vec<Vec<usize>>,
    /// For each beam, whether one of these acts on it.
    touched: Vec<bool>,
}

/// Most rounds in which pairs are restored; a search that needs more is abandoned.
const ROUNDS: usize = 20;

impl InactivePairs {
    fn of(scene: &Scene, inactive: Vec<bool>) -> Self {
        let mut pairs =
            Self { inactive, live: vec![Vec::new(); scene.blocks.len()], touched: vec![false; scene.beams.len()] };
        for (k, contact) in scene.contacts.iter().enumerate().filter(|(k, _)| !pairs.inactive[*k]) {
            for block in std::iter::once(contact.block).chain(contact.other_block()) {
                pairs.live[block].push(k);
            }
            if let SupportingBody::Beam(beam) = contact.surface {
                pairs.touched[beam] = true;
            }
        }
        pairs
    }

    /// Restores pairs until the rest is consistent; returns them with the regions of the blocks.
    fn search(
        start: &InitialMotion<'_>,
        inactive: Vec<bool>,
        rests: &[Option<BeamAtRest>],
    ) -> Option<(Self, Option<Barrier>, Vec<Reach>)> {
        let scene = start.scene;
        let mut pairs = Self::of(scene, inactive);
        for _ in 0..ROUNDS {
            let barrier = Barrier::of(start, &pairs);
            let reach = |block| match &barrier {
                Some(barrier) => barrier.reach(start, block),
                None => Reach::of_flight(start, block, &pairs),
            };
            let reaches: Vec<Reach> = (0..scene.blocks.len()).map(reach).collect();
            let stays_dead = |(contact, inactive): (&ContactScene, &bool)| {
                *inactive
                    && reaches[contact.block].misses(
                        start,
                        (contact.surface, contact.face),
                        rests,
                        &pairs,
                        barrier.as_ref(),
                    )
            };
            let inactive: Vec<bool> = scene.contacts.iter().zip(&pairs.inactive).map(stays_dead).collect();
            if inactive == pairs.inactive {
                return Some((pairs, barrier, reaches));
            }
            pairs = Self::of(scene, inactive);
        }
        None
    }
}

/// The initial state from which a search starts.
struct InitialMotion<'a> {
    scene: &'a Scene,
    layout: &'a Layout,
    /// The full model.
    model: &'a Model<2>,
    q: &'a [f64],
    v: &'a [f64],
}

impl InitialMotion<'_> {
    /// Duration of the run, s.
    fn time(&self) -> f64 {
        self.scene.time.steps() as f64 * self.scene.time.step
    }

    /// How far a step may look past its start, s: to its end, or as far as the activation predicts.
    fn ahead(&self) -> f64 {
        self.scene.time.step * (1.0 + self.scene.time.activation_gamma)
    }

    fn is_stood_on(&self, contact: &ContactScene) -> bool {
        use crate::scene::Placement::On;
        matches!(self.scene.blocks[contact.block].placement, On { support, .. } if support == contact.surface)
    }

    /// Whether a block moves only under its weight and its contacts.
    fn is_left_alone(&self, block: usize) -> bool {
        let scene = self.scene;
        !scene.blocks[block].motion.is_given() && scene.forces.iter().all(|force| force.block != block)
    }

    /// Initial X, Y, φ and their rates.
    fn block(&self, block: usize) -> ([f64; 3], [f64; 3]) {
        let first = self.layout.blocks[block].range.start;
        let triple = |x: &[f64]| [x[first], x[first + 1], x[first + 2]];
        (triple(self.q), triple(self.v))
    }
}
