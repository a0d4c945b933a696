//! Warnings of bodies that are inside each other where the model has no contact.

use crate::WarningLog;
use crate::with_digits;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use teeter_integrator::State;
use teeter_scenario::simulation::Layout;
use teeter_scenario::{Meeting, Shapes};

/// The meetings told so far: kind and the numbers of both bodies. Each is told once.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Met(BTreeSet<(u8, usize, usize)>);

/// Meetings that are remembered; past it there are no new ones to tell.
const MOST: usize = 10_000;

impl Met {
    /// Looks who meets whom at the state; hands the text of what is to be told now to `tell`.
    pub(crate) fn look(
        &mut self,
        shapes: &mut Shapes,
        layout: &Layout,
        state: &State,
        warnings: &mut WarningLog,
        mut tell: impl FnMut(&str),
    ) {
        shapes.meetings(layout, &state.q, |meeting, depth| {
            let Some(key) = key(meeting) else { return };
            if self.0.len() >= MOST || !self.0.insert(key) {
                return;
            }
            let text = || text(meeting, layout, state.t, depth);
            if let Some(text) = warnings.enter(code(meeting), Some(state.t), text) {
                tell(&text);
            }
        });
    }
}

fn key(meeting: Meeting) -> Option<(u8, usize, usize)> {
    Some(match meeting {
        Meeting::Blocks(a, b) => (0, a, b),
        Meeting::Ground(block) => (1, block, 0),
        Meeting::Beam(block, beam) => (2, block, beam),
        Meeting::BetweenCorners(block, beam) => (3, block, beam),
        Meeting::PastEnd(block, beam) => (4, block, beam),
        _ => return None,
    })
}

fn code(meeting: Meeting) -> &'static str {
    match meeting {
        Meeting::BetweenCorners(..) => "between-corners",
        Meeting::PastEnd(..) => "past-the-end",
        _ => "passes-through",
    }
}

fn text(meeting: Meeting, layout: &Layout, t: f64, depth: f64) -> String {
    let (depth, t) = (with_digits(depth, "m", 2), with_digits(t, "s", 7));
    let block = |k: usize| &layout.blocks[k].name;
    let beam = |k: usize| &layout.beams[k].name;
    match meeting {
        Meeting::Blocks(a, b) => format!(
            "`{}` and `{}` overlap by {depth} at t = {t}: no contact joins the two, so they pass through each other",
            block(a),
            block(b)
        ),
        Meeting::Ground(k) => format!(
            "`{}` is {depth} below the ground at t = {t}: no contact joins the two, so it passes through",
            block(k)
        ),
        Meeting::Beam(k, of) => format!(
            "`{}` is inside `{}` by {depth} at t = {t}: no contact joins the two, so they pass through each other",
            beam(of),
            block(k)
        ),
        Meeting::BetweenCorners(k, of) => format!(
            "`{}` is {depth} inside `{}` between its corners at t = {t}: by their contact only corners of the block touch the beam, so nothing \
             holds it there, and max_penetration doesn't count it",
            beam(of),
            block(k)
        ),
        Meeting::PastEnd(k, of) => format!(
            "the end of `{}` is {depth} inside `{}` at t = {t}: a corner past the end has no contact with the beam, and one that \
             comes back below its surface is thrown up through it",
            beam(of),
            block(k)
        ),
        _ => String::new(),
    }
}
