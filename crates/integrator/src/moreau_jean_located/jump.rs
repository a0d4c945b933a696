//! When a load jumps within a step.

use super::MoreauJeanLocated;
use crate::{Model, StepSpan};

/// A load jumps where it changes by more than this part of its size, also a step before and after: the rest is rounding.
const ROUNDING: f64 = 1e-9;

/// Breaks that are looked at in a step. A table with more rows than that in a step isn't followed by its steps anyway.
const MOST_BREAKS: usize = 64;

/// The first jump after a time, s; it holds until then.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct NextJump {
    after: f64,
    /// Up to here there is none but the one that is here, if it is one.
    until: f64,
    is_jump: bool,
}

impl<const D: usize> MoreauJeanLocated<D> {
    /// The time within the rest of a step at which a load jumps first, s. What sticks with the mean of the load may slide with what it is
    /// after the jump, so the step must be divided there. Prescribed motion isn't looked at: its velocities are means about the ends of
    /// steps, which know of no jump.
    pub(super) fn find_jump(&mut self, model: &Model<D>, rest: &StepSpan, step: f64) -> Option<f64> {
        // A break at the start or the end of a step is between two steps, whatever rounding says.
        let nudge = 8.0 * f64::EPSILON * rest.end.abs().max(rest.start.abs());
        let mut known = self.next_jump;
        if !(known.after <= rest.start && rest.start + nudge < known.until) {
            known = NextJump { after: rest.start, until: rest.start + nudge, is_jump: false };
        }
        for _ in 0..MOST_BREAKS {
            if known.is_jump || known.until >= rest.end - nudge {
                break;
            }
            let loaded = model.parts().iter().filter(|part| part.traits.loaded);
            let breaks = loaded.map(|part| part.system.next_break(known.until));
            let next = breaks.fold(f64::INFINITY, f64::min);
            known.until = next;
            known.is_jump = next < f64::INFINITY && self.jumps_at(model, next, step);
        }
        self.next_jump = known;
        (known.is_jump && known.until < rest.end - nudge).then_some(known.until)
    }

    /// Whether a load isn't the same on both sides of a time `t` (s), in comparison with what it is a `step` (s) before and after.
    fn jumps_at(&mut self, model: &Model<D>, t: f64, step: f64) -> bool {
        let nudge = 8.0 * f64::EPSILON * t.abs();
        let [before, after] = &mut self.beside;
        model.parts().iter().filter(|part| part.traits.loaded).any(|part| {
            let mut size = 0.0_f64;
            for [early, late] in [[t - step, t + step], [t - nudge, t + nudge]] {
                for (at, load) in [(early, &mut *before), (late, &mut *after)] {
                    load.clear();
                    load.resize(part.v.len(), 0.0);
                    part.system.load(at, load);
                }
                size = before.iter().chain(&*after).fold(size, |largest, load| largest.max(load.abs()));
            }
            before.iter().zip(&*after).any(|(before, after)| (after - before).abs() > ROUNDING * size)
        })
    }
}
