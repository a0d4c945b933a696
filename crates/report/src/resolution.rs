//! Whether steps were fine enough for the motion that a run showed (`docs/resolution.md`).
//!
//! A contact that closes does so up to a step late: its gap is then wrong by up to h |u_n|, u_n its velocity before. Relative to how far the
//! corners of the block swing, and added up over its impacts, that is what an error of the motion grows from: on all scenes measured, runs
//! below 0.8 % are off by less than 1 % of the largest angle, and those above 1.3 % by more than 10 %. One sum says it, whether steps miss impacts, lose contacts and find
//! them again, or let corners go deep: each of these closes contacts with large h |u_n|.

use serde::{Deserialize, Serialize};
use teeter_integrator::{State, StepReport};
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Layout;

/// Above this part of the motion, a run is likely off by more than 10 %.
pub(crate) const COARSE: f64 = 0.01;

/// A step that leaves this part is advised.
const FINE: f64 = 0.003;

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
    /// Whether anything pressed on it in this step.
    pressed: bool,
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
    /// Σ h |u_n| over the contacts that closed, as a part of its motion.
    pub(crate) part: f64,
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
            seen.pressed |= contact.p[0] > 0.0;
            seen.normal = [contact.frame[(0, 0)], contact.frame[(0, 1)]];
            // One that closes fast and gets no impulse, as the surface is gone again by the end of the step, is as late. A contact with duration takes
            // its time, and its force begins at nothing.
            if !contact.persisting && contact.gap_after.is_none() {
                seen.late += h * (-contact.u_before[0]).max(0.0);
            }
        }
        for (seen, place) in self.blocks.iter_mut().zip(&layout.blocks) {
            let at = place.range.start;
            let angle = state.q[at + 2];
            seen.angles = [seen.angles[0].min(angle), seen.angles[1].max(angle)];
            if !seen.pressed {
                seen.flown += h * (seen.normal[0] * state.v[at] + seen.normal[1] * state.v[at + 1]).abs();
            }
            seen.pressed = false;
        }
    }

    /// The block that steps of length `step` (s) resolve worst, if that is badly.
    pub(crate) fn coarse(&self, bodies: &Bodies, step: f64) -> Option<Coarse> {
        let mut worst: Option<Coarse> = None;
        for (block, (seen, width)) in self.blocks.iter().zip(&bodies.widths).enumerate() {
            let swing = width * (seen.angles[1] - seen.angles[0]);
            let part = seen.late / swing.max(seen.flown).max(STILL * width);
            if part > COARSE && worst.as_ref().is_none_or(|worst| part > worst.part) {
                worst = Some(Coarse { block, part, step: step * (FINE / part).max(SHORTEST) });
            }
        }
        worst
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
