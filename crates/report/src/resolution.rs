//! Whether steps were fine enough for the motion that a run showed (`docs/resolution.md`).
//!
//! A contact that closes does so up to a step late: its gap is then wrong by up to h |u_n|, u_n its velocity before. Added up over the impacts and carried on by what
//! the block does after them, relative to how far it swings or flies, that is what an error of the motion grows from. One measure says it, whether steps
//! miss impacts, lose contacts and find them again, or let corners go deep: each of these closes contacts with large h |u_n|.

use serde::{Deserialize, Serialize};
use teeter_integrator::{State, StepReport};
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Layout;

/// Above this part of the motion, a run is likely off by more than 10 %.
pub(crate) const COARSE: f64 = 0.012;

/// And above this part of the motion at a single impact: a block that falls flat rests where it closed, about half of it off.
pub(crate) const COARSE_ONCE: f64 = 0.2;

/// A step that leaves this share of the limit is advised.
const FINE: f64 = 0.25;

/// Steps shorter than the run's own by more than this are not advised from its motion: it was another one.
const SHORTEST: f64 = 1.0 / 50.0;

/// A motion smaller than this part of the block's width is none: rounding, and the hops of a block at rest.
const STILL: f64 = 1e-3;

/// What is known of a block so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Seen {
    /// Least and largest angle, rad.
    angles: [f64; 2],
    /// The way of its mass centre while nothing touched it, along `normal`, m: how fast it goes along a surface says nothing of how
    /// finely its impacts are resolved.
    flown: f64,
    /// Normal of its last contact; upwards before the first.
    normal: [f64; 2],
    /// Σ h |u_n| of the contacts that closed, m.
    late: f64,
    /// The largest one of them, m.
    latest: f64,
    /// How far it has moved, m: the way of its feet about each other, and of its mass centre in flight.
    way: f64,
    /// ∫ late ds over that way, m².
    carried: f64,
    /// How many contacts pressed on it in this step.
    pressed: u32,
}

/// What a run has shown so far of how well its steps resolve it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Resolution {
    blocks: Vec<Seen>,
}

/// A block whose motion the steps don't resolve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Coarse {
    /// Its number.
    pub(crate) block: usize,
    /// How late its contacts closed, as a part of its motion.
    pub(crate) part: f64,
    /// Whether one impact alone is that late.
    pub(crate) once: bool,
    /// A step to take in its place, s.
    pub(crate) step: f64,
}

impl Resolution {
    /// Before the first step.
    pub(crate) fn start(&mut self, layout: &Layout, state: &State) {
        self.blocks.clear();
        self.blocks.extend(layout.blocks.iter().map(|place| {
            let angle = state.q[place.range.start + 2];
            Seen { angles: [angle, angle], normal: [0.0, 1.0], ..Seen::default() }
        }));
    }

    /// Takes a step in.
    pub(crate) fn observe(&mut self, bodies: &Bodies, layout: &Layout, step: &StepReport<'_, 2>, state: &State) {
        let h = step.t_end - step.t_start;
        for contact in step.contacts {
            let owner = bodies.owners.get(contact.id.pair() as usize);
            let Some(seen) = owner.and_then(|block| self.blocks.get_mut(*block)) else { continue };
            seen.pressed += u32::from(contact.p[0] > 0.0);
            seen.normal = [contact.frame[(0, 0)], contact.frame[(0, 1)]];
            // One that closes fast and gets no impulse, as the surface is gone again by the end of the step, is as late. A contact with duration takes
            // its time, and its force begins at nothing.
            if !contact.persisting && contact.gap_after.is_none() {
                let late = h * (-contact.u_before[0]).max(0.0);
                seen.late += late;
                seen.latest = seen.latest.max(late);
            }
        }
        for ((seen, place), width) in self.blocks.iter_mut().zip(&layout.blocks).zip(&bodies.widths) {
            let at = place.range.start;
            let angle = state.q[at + 2];
            seen.angles = [seen.angles[0].min(angle), seen.angles[1].max(angle)];
            // On both feet it goes with what carries it.
            let mut way = if seen.pressed < 2 { h * width * state.v[at + 2].abs() } else { 0.0 };
            if seen.pressed == 0 {
                let flown = h * (seen.normal[0] * state.v[at] + seen.normal[1] * state.v[at + 1]).abs();
                seen.flown += flown;
                way += flown;
            }
            seen.way += way;
            seen.carried += seen.late * way;
            seen.pressed = 0;
        }
    }

    /// The block that steps of length `step` (s) resolve worst, if that is badly.
    pub(crate) fn coarse(&self, bodies: &Bodies, step: f64) -> Option<Coarse> {
        let parts = self.blocks.iter().zip(&bodies.widths).enumerate().map(|(block, (seen, width))| {
            let [all, single] = seen.parts(*width);
            // Of both, the one that is farther above its limit.
            let once = single / COARSE_ONCE > all / COARSE;
            let (part, limit) = if once { (single, COARSE_ONCE) } else { (all, COARSE) };
            let step = step * (FINE * limit / part).max(SHORTEST);
            (part / limit, Coarse { block, part, once, step })
        });
        let worst = parts.filter(|(times, _)| *times > 1.0).max_by(|(a, _), (b, _)| a.total_cmp(b));
        worst.map(|(_, coarse)| coarse)
    }
}

impl Seen {
    /// How late the contacts of this block of so much `width` (m) closed, as parts of its motion: all of them together, and the latest one.
    ///
    /// All together is the geometric mean of their sum and of what of it was carried on through the motion: an impact after which little moves
    /// does little harm.
    fn parts(&self, width: f64) -> [f64; 2] {
        let [least, most] = self.angles;
        let swing = (most - least).max(most.abs()).max(least.abs()).min(std::f64::consts::PI);
        let carried = if self.way > 0.0 { 2.0 * self.carried / self.way } else { 0.0 };
        let motion = (width * swing).max(self.flown).max(STILL * width);
        [(carried * self.late).sqrt() / motion, self.latest / motion]
    }
}

/// What of the scene it goes by.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bodies {
    /// The block of each pair.
    owners: Vec<usize>,
    /// How far the feet of each block are apart, m.
    widths: Vec<f64>,
}

impl Bodies {
    pub(crate) fn of(scene: &Scene) -> Self {
        Self {
            owners: scene.contacts.iter().map(|contact| contact.block).collect(),
            widths: scene.blocks.iter().map(|block| block.width).collect(),
        }
    }
}
