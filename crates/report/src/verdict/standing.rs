//! Which blocks stand at the start, and when one that began in flight has settled on a side (`docs/verdict.md`).

use super::stance::Stance;
use super::{KnownStance, ROCKED, Seen, Watched, Way};
use serde::{Deserialize, Serialize};
use teeter_detect::{BodyId, Candidate};
use teeter_integrator::{Mismatch, Model, State};
use teeter_scenario::scene::SupportingBody;
use teeter_scenario::simulation::Layout;

/// A block that began in flight has settled when it was unable to turn over by itself for this many √(R/g). In free fall as long as that its speed
/// is at some time 2 √(gR) or more, and then its energy 2 m g R, which no point of no return asks for: so it has landed.
pub(super) const SETTLED: f64 = 4.0;

/// What is known of a block that began in flight, while nothing but a push could turn it over.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Settling {
    /// Since when, s.
    pub since: f64,
    /// Its angle then, rad.
    pub angle: f64,
    /// The largest |φ|/α since, of the swing in which it settles.
    pub part: f64,
    /// When that was last large enough to be called rocking, s.
    pub rocked: Option<f64>,
}

/// How blocks stand at the start.
pub(super) struct AtStart {
    /// Which do.
    pub standing: Vec<bool>,
    /// Which touch, by their numbers.
    pub touching: Vec<[usize; 2]>,
    /// To which side the mass centre is past all that holds the block from below, of one that lies flat there.
    pub past_edge: Vec<Option<Way>>,
}

/// Contacts closer together than this part of R hold a block as one corner does, on which it is tilted.
const APART: f64 = 1e-3;

/// A mass centre is past the outermost contact by more than this part of R.
const PAST: f64 = 1e-6;

/// Which blocks stand at the start: those that were placed on ground, a beam or a block whose motion is prescribed, or are joined to one of them by
/// closed contacts, a chain of them; and those so little above what stands that by their fall and their speed they can't turn over. With them, which
/// blocks touch, by their numbers: a number beyond the blocks is ground or a beam.
pub(super) fn at_start(
    blocks: &[Watched],
    layout: &Layout,
    model: &Model<2>,
    state: &State,
) -> Result<AtStart, Mismatch> {
    // All that is no free block has one number, after the blocks.
    let fixed = blocks.len();
    let node = |block: usize| if blocks.get(block).is_some_and(|of| !of.driven) { block } else { fixed };
    // Blocks are the model's first bodies.
    let of_body = |body: BodyId| node(body.0 as usize);
    let mut carried = vec![Vec::new(); fixed + 1];
    let placed_on = |block: &Watched| {
        block.on.map(|on| match on {
            SupportingBody::Block(below) => node(below),
            SupportingBody::Beam(_) | SupportingBody::Ground => fixed,
        })
    };
    for (number, block) in blocks.iter().enumerate() {
        if let Some(below) = placed_on(block) {
            carried[below].push(number);
        }
    }
    // More than a contact counts as closed at, and than the fall that as little energy takes as turns a block over.
    let farthest = blocks.iter().map(|block| 2.0 * block.reach).fold(0.0, f64::max);
    let (mut candidates, mut touching) = (Vec::new(), Vec::new());
    let mut held = vec![[f64::INFINITY, f64::NEG_INFINITY]; fixed];
    model.candidates(&state.q, farthest, &mut candidates)?;
    for candidate in &candidates {
        let [a, b] = [0, 1].map(|side| of_body(candidate.sides[side].body));
        let closed = candidate.gap <= layout.openings.of_pair(candidate.id.pair()).gap;
        if closed {
            let driven = |number: usize| blocks.get(number).is_some_and(|of| of.driven);
            let bodies = [0, 1].map(|side| candidate.sides[side].body.0 as usize);
            // A driven block is held itself: what it touches is told by the blocks.
            if !bodies.into_iter().all(driven) && touching.last() != Some(&bodies) {
                touching.push(bodies);
            }
        }
        for (side, [upper, lower]) in [[a, b], [b, a]].into_iter().enumerate() {
            let block = blocks.get(upper).filter(|_| upper != fixed);
            if let Some(at) =
                block.filter(|_| closed).and_then(|block| block.held_at(candidate, side, layout, upper, state))
            {
                let [left, right] = &mut held[upper];
                (*left, *right) = (left.min(at), right.max(at));
            }
            // Known without a search for its stance, which takes long.
            if block.and_then(placed_on) == Some(lower) {
                continue;
            }
            if closed || block.is_some_and(|block| block.as_good_as_stands(candidate, side, layout, upper, state)) {
                carried[lower].push(upper);
            }
        }
    }
    let mut stands = vec![false; fixed + 1];
    let mut next = vec![fixed];
    while let Some(at) = next.pop() {
        if !std::mem::replace(&mut stands[at], true) {
            next.extend(&carried[at]);
        }
    }
    stands.truncate(fixed);
    let past = |([left, right], block): (&[f64; 2], &Watched)| match block.reach {
        reach if right - left <= APART * reach => None,
        reach if *right < -PAST * reach => Some(Way::Right),
        reach if *left > PAST * reach => Some(Way::Left),
        _ => None,
    };
    let past_edge = held.iter().zip(blocks).map(past).collect();
    Ok(AtStart { standing: stands, touching, past_edge })
}

/// How far the normal of a contact on this `side` points up where gravity pulls in the direction `gamma` (rad): 1 for level ground.
fn up(gamma: f64, candidate: &Candidate<2>, side: usize) -> f64 {
    let normal = candidate.frame.row(0);
    (normal[0] * -gamma.cos() + normal[1] * -gamma.sin()) * if side == 0 { 1.0 } else { -1.0 }
}

impl Watched {
    /// Where a contact holds a block, one side of it, from below: to the right of the mass centre, m.
    fn held_at(
        &self,
        candidate: &Candidate<2>,
        side: usize,
        layout: &Layout,
        number: usize,
        state: &State,
    ) -> Option<f64> {
        let gamma = self.outline.as_ref()?.gamma;
        let [x, y] = [0, 1].map(|k| candidate.sides[side].point[k]);
        let (sin, cos) = state.q[layout.blocks[number].range.start + 2].sin_cos();
        let at = -gamma.sin() * (cos * x - sin * y) + gamma.cos() * (sin * x + cos * y);
        (up(gamma, candidate, side) > 0.0).then_some(at)
    }

    /// Whether a block, one side of an open contact, is above the other one and falls on it with too little energy to turn over.
    fn as_good_as_stands(
        &self,
        candidate: &Candidate<2>,
        side: usize,
        layout: &Layout,
        number: usize,
        state: &State,
    ) -> bool {
        let Some(outline) = &self.outline else { return false };
        let up = up(outline.gamma, candidate, side);
        if up <= 0.0 {
            return false;
        }
        let angle = state.q[layout.blocks[number].range.start + 2];
        let fall = self.mass * self.gravity * candidate.gap / up;
        let energy = fall + self.kinetic(layout, number, state);
        outline.stance(angle).is_some_and(|stance| self.stays(&stance, angle, energy))
    }

    /// Its kinetic energy relative to what carries it, J.
    fn kinetic(&self, layout: &Layout, number: usize, state: &State) -> f64 {
        let [vx, vy, spin] = self.velocity(layout, number, state);
        0.5 * (self.mass * (vx * vx + vy * vy) + self.inertia * spin * spin)
    }

    /// Whether with this energy (J) it can't get past either of its points of no return.
    fn stays(&self, stance: &Stance, angle: f64, energy: f64) -> bool {
        [Way::Left, Way::Right].into_iter().all(|way| energy < self.lift(stance.edge(way), angle))
    }
}

impl Seen {
    /// How it stands; `None` of a block that can't overturn, or is in flight.
    pub(super) fn stance(&self, watched: &Watched) -> Option<Stance> {
        let began = self.began?;
        let found = || watched.outline.as_ref().and_then(|outline| outline.stance(began));
        self.stance.0.unwrap_or_else(found)
    }

    /// Of a block that began in flight: whether it has settled with this state, on what has this `slope` (rad), and how it stands then.
    pub(super) fn settle(
        &mut self,
        (watched, number): (&Watched, usize),
        slope: f64,
        layout: &Layout,
        before: f64,
        state: &State,
    ) {
        let Some(outline) = &watched.outline else { return };
        let (angle, energy) = (state.q[layout.blocks[number].range.start + 2], watched.kinetic(layout, number, state));
        // No lift is more; most steps of a flight end here.
        if energy >= 2.0 * watched.mass * watched.gravity * watched.reach {
            self.settling = None;
            return;
        }
        let within = |stance: &Stance| stance.right.top < angle && angle < stance.left.top;
        // After a pause only the angle is known, from which it was found.
        let known = self.stance.0.or_else(|| self.settling.map(|settling| outline.stance(settling.angle)));
        let stance = match known {
            Some(None) => return,
            Some(Some(stance)) if within(&stance) => stance,
            _ => {
                self.settling = None;
                let found = outline.stance(angle);
                self.stance = KnownStance(Some(found));
                let Some(found) = found else { return };
                found
            }
        };
        if !watched.stays(&stance, angle, energy) {
            self.settling = None;
            return;
        }
        let settling = self.settling.get_or_insert_with(|| {
            self.stance = KnownStance(Some(outline.stance(angle)));
            Settling { since: state.t, angle, part: 0.0, rocked: None }
        });
        let stance = self.stance.0.flatten().unwrap_or(stance);
        if let Some(part) = stance.part(angle, slope).filter(|_| !self.touched.flies(before, watched)) {
            settling.part = settling.part.max(part);
            settling.rocked = if part >= ROCKED { Some(state.t) } else { settling.rocked };
        }
        let settled = *settling;
        if state.t - settled.since >= SETTLED * watched.still_time {
            // Found anew from this angle, as it will be after a pause.
            (self.began, self.settling, self.stance) = (Some(settled.angle), None, KnownStance(None));
            self.part = Some(settled.part);
            self.swung = settled.rocked.map(|t| (t, angle - slope));
            self.stands_from = Some(settled.since);
            self.stood = watched.place(layout, number, state);
        }
    }
}
