//! What a scene can't need, found and left out of its model: points that never touch, beams that
//! never move (`docs/required.md` has the proofs).
//!
//! A set of removals is found that holds together: were one of them wrong, there would be a first
//! step in which that shows, and up to that step everything moved as the reasons for it say. So
//! each reason may rest on all the others. The search starts with every pair removed but those of
//! blocks with what they stand on, and takes back what can't be shown until nothing changes.

mod at_rest;
mod barrier;
mod beam_bounds;
mod reach;

use crate::scene::{ContactScene, Scene, Support};
use crate::simulation::Layout;
pub(crate) use at_rest::AtRest;
use at_rest::Rest;
use barrier::Barrier;
use reach::Reach;
use teeter_integrator::{Energy, Model, State};

/// How much of a scene its model has.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Extent {
    /// What the scene can need.
    #[default]
    Required,
    /// All that the scene names.
    Full,
}

impl Extent {
    /// The word for it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Required => "required",
            Self::Full => "full",
        }
    }
}

/// Something that the model does without.
#[derive(Debug, Clone, PartialEq)]
pub struct Removed {
    /// What.
    pub what: String,
    /// Why nothing misses it, with the numbers of the bound.
    pub why: String,
    /// How far a run is from one with it; `None` where every number is the same.
    pub accuracy: Option<String>,
}

/// What a model has of its scene.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Required {
    /// What was asked for.
    pub extent: Extent,
    /// What it does without; empty for the full model.
    pub removed: Vec<Removed>,
    /// What the run has to keep for the removals to hold; `None` where they hold whatever it does.
    pub limits: Option<Limits>,
    /// Of each contact of the scene, how many of its block's corners are looked at, the bottom ones
    /// first.
    points: Vec<usize>,
    /// Of each beam, the energy that it rests with; `None` for those that move.
    at_rest: Vec<Option<Energy>>,
}

/// What a removal by energy rests on, beside the scene: a scheme that doesn't make energy, and
/// contacts that don't sink.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Most kinetic and potential energy of the model, J, counted as in the ledger.
    pub energy: f64,
    /// Deepest penetration, m.
    pub penetration: f64,
}

/// Those that it stands on; they are the first.
const FEET: usize = 2;

impl Limits {
    /// Whether the run that led to this state has kept them so far, as far as its last step and its
    /// tally tell.
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

    /// Whether a beam, by its number in the scene, is left out as one that never moves.
    #[must_use]
    pub fn is_at_rest(&self, beam: usize) -> bool {
        self.rests(beam).is_some()
    }

    /// How many corners of the block of a contact, by its number in the scene, are looked at.
    #[must_use]
    pub fn points(&self, contact: usize) -> usize {
        self.points.get(contact).copied().unwrap_or_default()
    }

    /// The energy with which a beam rests; `None` for one that moves.
    pub(crate) fn rests(&self, beam: usize) -> Option<Energy> {
        self.at_rest.get(beam).copied().flatten()
    }

    /// What the scene can need, from its start (q, v) in its full model.
    pub(crate) fn of(scene: &Scene, layout: &Layout, model: &Model<2>, q: &[f64], v: &[f64]) -> Self {
        let mut required = Self { extent: Extent::Required, ..Self::all(scene) };
        let start = Start { scene, layout, model, q, v };
        let rests: Vec<Option<Rest>> =
            (0..scene.beams.len()).map(|k| Rest::of(&start, k, scene.time.steps())).collect();
        let dead = scene.contacts.iter().map(|contact| !start.is_stood_on(contact)).collect();
        let Some((pairs, barrier, reaches)) = Pairs::search(&start, dead, &rests) else { return required };
        let dead = &pairs.dead;
        for (k, contact) in scene.contacts.iter().enumerate().filter(|(k, _)| dead[*k]) {
            required.points[k] = 0;
            required.removed.push(Removed {
                what: format!("contact `{}`: all of it", contact.name),
                why: reaches[contact.block].told(&start, contact),
                accuracy: None,
            });
        }
        for (k, rest) in rests.iter().enumerate() {
            let Some(rest) = rest.as_ref().filter(|_| !pairs.touched[k]) else { continue };
            required.at_rest[k] = Some(rest.energy);
            required.removed.push(rest.removed(&scene.beams[k].name));
        }
        if let Some(barrier) = barrier {
            for (k, contact) in scene.contacts.iter().enumerate().filter(|(k, _)| !dead[*k]) {
                required.points[k] = FEET;
                required.removed.push(barrier.removed(&start, contact));
            }
            required.limits = Some(barrier.limits);
        }
        required
    }
}

/// Which pairs are taken for such that never touch, and what that leaves.
struct Pairs {
    /// Of each contact, whether it is one of them.
    dead: Vec<bool>,
    /// Of each block, the contacts that may act.
    live: Vec<Vec<usize>>,
    /// Of each beam, whether one of these acts on it.
    touched: Vec<bool>,
}

/// Times that pairs are taken back; a search that needs more is given up.
const ROUNDS: usize = 20;

impl Pairs {
    fn of(scene: &Scene, dead: Vec<bool>) -> Self {
        let mut pairs =
            Self { dead, live: vec![Vec::new(); scene.blocks.len()], touched: vec![false; scene.beams.len()] };
        for (k, contact) in scene.contacts.iter().enumerate().filter(|(k, _)| !pairs.dead[*k]) {
            for block in std::iter::once(contact.block).chain(contact.other_block()) {
                pairs.live[block].push(k);
            }
            if let Support::Beam(beam) = contact.surface {
                pairs.touched[beam] = true;
            }
        }
        pairs
    }

    /// Takes pairs back until all that are left hold together; with what keeps the blocks off them.
    fn search(
        start: &Start<'_>,
        dead: Vec<bool>,
        rests: &[Option<Rest>],
    ) -> Option<(Self, Option<Barrier>, Vec<Reach>)> {
        let scene = start.scene;
        let mut pairs = Self::of(scene, dead);
        for _ in 0..ROUNDS {
            let barrier = Barrier::of(start, &pairs);
            let reach = |block| match &barrier {
                Some(barrier) => barrier.reach(start, block),
                None => Reach::of_flight(start, block, &pairs),
            };
            let reaches: Vec<Reach> = (0..scene.blocks.len()).map(reach).collect();
            let stays_dead = |(contact, dead): (&ContactScene, &bool)| {
                *dead && reaches[contact.block].misses(start, contact.surface, rests, &pairs, barrier.as_ref())
            };
            let dead: Vec<bool> = scene.contacts.iter().zip(&pairs.dead).map(stays_dead).collect();
            if dead == pairs.dead {
                return Some((pairs, barrier, reaches));
            }
            pairs = Self::of(scene, dead);
        }
        None
    }
}

/// What a search starts from.
struct Start<'a> {
    scene: &'a Scene,
    layout: &'a Layout,
    /// The full model.
    model: &'a Model<2>,
    q: &'a [f64],
    v: &'a [f64],
}

impl Start<'_> {
    /// How long the run is, s.
    fn time(&self) -> f64 {
        self.scene.time.steps() as f64 * self.scene.time.step
    }

    /// Time that a step may look past its start, s: to its end, or as far as the activation looks.
    fn ahead(&self) -> f64 {
        self.scene.time.step * (1.0 + self.scene.time.activation_gamma)
    }

    fn is_stood_on(&self, contact: &ContactScene) -> bool {
        use crate::scene::Placement::On;
        matches!(self.scene.blocks[contact.block].placement, On { support, .. } if support == contact.surface)
    }

    /// Whether a block moves under its weight and its contacts alone.
    fn is_left_alone(&self, block: usize) -> bool {
        let scene = self.scene;
        !scene.blocks[block].motion.is_given() && scene.forces.iter().all(|force| force.block != block)
    }

    /// X, Y, φ and their rates at the start.
    fn block(&self, block: usize) -> ([f64; 3], [f64; 3]) {
        let first = self.layout.blocks[block].range.start;
        let triple = |x: &[f64]| [x[first], x[first + 1], x[first + 2]];
        (triple(self.q), triple(self.v))
    }
}
