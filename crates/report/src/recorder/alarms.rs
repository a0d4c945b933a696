//! What a recorder warns of while a run goes on, and at its end.

use super::{Kept, Recorder};
use crate::bounces::{CONTESTED, Contested};
use crate::closed::Closed;
use crate::resolution::{Of, raise};
use crate::{shortest, with_digits, with_unit};
use teeter_detect::OnSide;
use teeter_integrator::{Closing, Model, State, StepReport};
use teeter_scenario::simulation::Layout;
use teeter_scenario::{FAR_TURN, deflection};

/// A penetration over this part of the shortest side of a block is a warning.
const DEEP: f64 = 0.1;

/// What the identity of energy leaves over, as a part of the scene's scale, is rounding up to here: scenes of all kinds have 1e-15 to 1e-10.
const UNACCOUNTED: f64 = 1e-8;

/// Who meets whom is looked at again when a body may have moved by this part of the shortest side of a block.
const LOOK_AFTER: f64 = 0.1;

/// No corner of a block is faster than this past ground and supports, m/s; and how fast whatever
/// turns the fastest turns, rad/s.
fn fastest(layout: &Layout, state: &State) -> [f64; 2] {
    let (mut fastest, mut turning) = (0.0, 0.0);
    for place in &layout.blocks {
        let [x, y, spin] = [0, 1, 2].map(|k| state.v[place.range.start + k].abs());
        raise(&mut fastest, x + y + place.reach * spin);
        raise(&mut turning, spin);
    }
    let mut carried = 0.0;
    for range in layout.beams.iter().filter_map(|place| place.supports.clone()) {
        raise(&mut carried, state.v[range].iter().map(|v| v.abs()).sum());
    }
    if let Some(range) = &layout.ground {
        let far = layout.blocks.iter().map(|place| state.q[place.range.start].hypot(state.q[place.range.start + 1]));
        let [x, y, spin] = [0, 1, 2].map(|k| state.v[range.start + k].abs());
        raise(&mut carried, x + y + spin * far.fold(0.0, f64::max));
        raise(&mut turning, spin);
    }
    [fastest + carried, turning]
}

/// A time in a warning: with so many digits that it tells one step from another.
fn time(t: f64) -> String {
    with_digits(t, "s", 7)
}

impl Recorder<'_> {
    /// Enters a warning, and tells it if it is to be told now.
    fn warn(&mut self, code: &'static str, t: Option<f64>, text: impl FnOnce() -> String) {
        if let Some(text) = self.kept.record.warnings.enter(code, t, text) {
            (self.tell)(&text);
        }
    }

    /// Enters a warning, and tells it the first time.
    fn warn_once(&mut self, code: &'static str, t: f64, text: impl FnOnce() -> String) {
        let warnings = &mut self.kept.record.warnings;
        let known = warnings.warnings().iter().any(|warning| warning.code == code);
        if let (Some(text), false) = (warnings.enter(code, Some(t), text), known) {
            (self.tell)(&text);
        }
    }

    /// Warns, once, of a block that turns far in a step.
    #[inline(never)]
    fn warn_of_turns(&mut self, state: &State) {
        let fastest = FAR_TURN / state.dt;
        let blocks = self.layout.blocks.iter().map(|place| (place.name.as_str(), state.v[place.range.start + 2]));
        let ground = self.layout.ground.iter().map(|range| ("ground", state.v[range.start + 2]));
        let Some((name, spin)) = ground.chain(blocks).find(|(_, spin)| spin.abs() >= fastest) else { return };
        self.warn_once("far-turn", state.t, || {
            format!(
                "`{name}` turns by {:.2} rad in the step to t = {}, and is no longer followed from {FAR_TURN} on; take a step of at most {}",
                spin.abs() * state.dt,
                time(state.t),
                with_digits(FAR_TURN / spin.abs(), "s", 1)
            )
        });
    }

    /// Warns of a landing that hangs on bounces which the steps have cut short.
    pub(super) fn warn_of_bounces(&mut self, model: &Model<2>, step: &StepReport<'_, 2>) {
        if !self.locates || self.kept.bounces.contested().is_some() {
            return;
        }
        self.kept.bounces.enter(model, step);
        let Some(Contested { t, landed, cut }) = self.kept.bounces.contested() else { return };
        let layout = self.layout;
        let (Some(landed), Some(cut)) = (layout.names_of(landed), layout.names_of(cut)) else { return };
        self.warn(CONTESTED, Some(t), || {
            format!(
                "contact `{}`: {} landed at t = {} while {} was kept closed, whose bounces, shorter than two steps, may still have gone on: which \
                 of them catches the block hangs on the step; take a shorter one (`time.step`), or `event-driven`, and compare",
                landed.contact,
                landed.point,
                time(t),
                cut.point
            )
        });
    }

    /// Warns, once, of a crest of a beam that strikes a base between its corners.
    pub(super) fn warn_of_crests(&mut self) {
        let layout = self.layout;
        let impacts = self.closed.iter().filter(|closed| closed.closing == Closing::Impact);
        let on_crest = |closed: &Closed| {
            let pair = layout.pairs.get(closed.contact.id.pair() as usize)?;
            let point = &pair.points[pair.point(closed.contact.id)?];
            let is_crest = matches!(point.on_side, Some(OnSide::Summit(_)));
            is_crest.then_some((closed.t, &pair.name, &layout.blocks[point.block].name))
        };
        let Some((t, contact, name)) = impacts.filter_map(on_crest).next() else { return };
        self.warn_once("crest-impact", t, || {
            format!(
                "contact `{contact}`: a hump of the beam struck the base of `{name}` between its corners at t = {}; a base that comes down \
                 rolls over a hump without impacts, but only where steps are short enough for that: compare peaks with shorter steps, or \
                 take `points = \"corners\"`, which leaves humps out",
                time(t)
            )
        });
    }

    /// Warns where the model lacks what the run may need after all.
    pub(super) fn warn_of_limits(&mut self, state: &State) {
        let Some(limits) = self.layout.required.limits.filter(|limits| !limits.hold(state)) else { return };
        self.warn("model-limits", Some(state.t), || {
            format!(
                "at t = {} the energy is {:.6} J and the deepest penetration so far {}, over the {:.6} J or the {} up to which \
                 the upper corners of blocks can't touch, and they are not looked at; --model full has them",
                time(state.t),
                state.ledger.current.total(),
                with_digits(state.tally.max_penetration, "m", 2),
                limits.energy,
                with_digits(limits.penetration, "m", 2)
            )
        });
    }

    /// Warns of what turns far in a step; looks who meets whom between rows, too, as soon as
    /// something may have come far enough to matter.
    ///
    /// `swing` is the largest rate of deflection of beams, m/s: what a beam does where it is watched stands for what it does elsewhere.
    pub(super) fn warn_of_motion(&mut self, step: &StepReport<'_, 2>, state: &State, swing: f64) {
        let [fastest, turning] = fastest(self.layout, state);
        if turning >= FAR_TURN / state.dt {
            self.warn_of_turns(state);
        }
        // Two that meet come twice as far, and have two sides.
        if state.dt * fastest > 0.5 * self.shortest_side {
            self.warn_of_passing(state);
        }
        self.kept.travelled += (step.t_end - step.t_start) * (fastest + swing);
        if self.kept.travelled > LOOK_AFTER * self.shortest_side {
            self.look_who_meets(state);
        }
    }

    /// Warns, once, of a block that went through the ground, and of two blocks that are so fast that a step may miss their contact.
    #[inline(never)]
    fn warn_of_passing(&mut self, state: &State) {
        if let Some((block, far)) = self.shapes.passing_ground(self.layout, &state.q, &state.v, state.dt) {
            let block = &self.layout.blocks[block];
            self.warn_once("fast-pass", state.t, || {
                format!(
                    "`{}` went through a crest of the ground in the step to t = {}: it moved by {}, more than half its shorter side, and the step \
                     saw no contact; take a step of at most {}",
                    block.name,
                    time(state.t),
                    with_digits(far, "m", 2),
                    with_digits(0.4 * block.side * state.dt / far, "s", 1)
                )
            });
        }
        let Some((first, second, far)) = self.shapes.passing(self.layout, &state.q, &state.v, state.dt) else { return };
        let [first, second] = [first, second].map(|block| &self.layout.blocks[block]);
        self.warn_once("fast-pass", state.t, || {
            format!(
                "`{}` and `{}` come {} past each other in the step to t = {}, more than half of their shorter sides, so that a contact \
                 between them may not be seen; take a step of at most {}",
                first.name,
                second.name,
                with_digits(far, "m", 2),
                time(state.t),
                with_digits(0.4 * (first.side + second.side) * state.dt / far, "s", 1)
            )
        });
    }

    fn look_who_meets(&mut self, state: &State) {
        let Self { layout, shapes, kept: Kept { met, record, travelled, .. }, tell, .. } = self;
        *travelled = 0.0;
        met.look(shapes, layout, state, &mut record.warnings, tell);
    }

    /// Warns of what a row shows to be outside the model; told once each.
    pub(super) fn warn_of_row(&mut self, state: &State) {
        self.look_who_meets(state);
        let (ledger, layout) = (&state.ledger, self.layout);
        for place in &layout.beams {
            let q = &state.q[place.range.clone()];
            let nodal = place.basis.as_ref().map(|basis| basis.dofs(q));
            if let Some(large) = deflection::large(&place.beam, nodal.as_deref().unwrap_or(q)) {
                let text = || format!("`{}` deflects far at t = {}: {large}", place.name, time(state.t));
                self.warn_once("large-deflection", state.t, text);
            }
        }
        let depth = state.tally.max_penetration;
        if depth > DEEP * self.shortest_side {
            self.warn_once("deep-penetration", state.t, || {
                format!(
                    "up to t = {} a corner was {} deep in a surface, more than {:.0} % of a block's shorter side: that is no contact any \
                     more; the step is too long for what moves, or a corner came in from the side, past the end of a beam",
                    time(state.t),
                    with_digits(depth, "m", 3),
                    100.0 * DEEP
                )
            });
        }
        let left = ledger.relative_residual();
        if left > UNACCOUNTED {
            self.warn_once("energy-account", state.t, || {
                format!(
                    "up to t = {} the energy of a step is off by {left:.1e} of the scene's scale, far more than rounding: numbers of very \
                     different size act together, and the motion is not to be trusted; check loads, signals and masses, and their units",
                    time(state.t)
                )
            });
        }
    }

    /// Warns where the steps were too long for the motion that the whole run showed.
    pub(super) fn warn_of_resolution(&mut self, state: &State) {
        let layout = self.layout;
        if let Some(coarse) = self.kept.resolution.coarse(&self.bodies, state.dt) {
            let name = layout.blocks.get(coarse.block).map_or("a block", |place| &place.name);
            let (limit, step) = (100.0 * coarse.of.limit(), with_digits(coarse.step, "s", 1));
            let part = match coarse.part {
                part if part < 1.0 => format!("{:.1} % of its motion", 100.0 * part),
                part => format!("{} times its whole motion", shortest(part, 2)),
            };
            let what = match coarse.of {
                Of::Impacts => "its contacts close up to a step late, and over the run their gaps are off by",
                Of::Impact => "its contacts close up to a step late, and at one impact the gap is off by",
                Of::Held => "a foot that closed above the surface, or below it, goes on pressing there, off by",
            };
            self.warn("under-resolved", None, || {
                format!(
                    "steps of {} are too long for the impacts of `{name}`: {what} {part}; from {limit:.1} % on motions are likely \
                     off by more than 10 %; take a step of at most {step}, and let `teeter tradeoff` measure what accuracy it gives",
                    with_unit(state.dt, "s"),
                )
            });
        }
        if let Some((block, off)) = self.kept.resolution.fall(&self.bodies, state.dt) {
            let name = layout.blocks.get(block).map_or("a block", |place| &place.name);
            self.warn("under-resolved-flight", None, || {
                format!(
                    "with this theta `{name}` is off by {} after its longest flight: it falls by (theta - 1/2) g h t too much or too little; take \
                     theta = 0.5, or a shorter step",
                    with_digits(off, "m", 2)
                )
            });
        }
        if let Some(lost) = self.kept.swings.lost(&self.watch, state.dt) {
            let name = layout.beams.get(lost.beam).map_or("a beam", |place| &place.name);
            let rest = if self.watch.damps() { ", or theta = 0.5, which damps nothing" } else { "" };
            self.warn("under-resolved-swings", None, || {
                format!(
                    "steps of {} are too long for the swings of `{name}`: at {:.4} Hz they come late or die out by as much as {:.0} % of its largest \
                     deflection; take a step of at most {}{rest}",
                    with_unit(state.dt, "s"),
                    lost.frequency,
                    100.0 * lost.part,
                    with_digits(lost.step, "s", 1)
                )
            });
        }
    }

    /// Warns of a step whose contact problem was not solved.
    pub(super) fn warn_of_unsolved(&mut self, step: &StepReport<'_, 2>) {
        if step.is_solved() {
            return;
        }
        let unsolved = step.phases().find_map(|phase| {
            let outcome = phase.outcome.filter(|outcome| !outcome.converged())?;
            Some((outcome, phase.contacts.len()))
        });
        let Some((outcome, contacts)) = unsolved else { return };
        self.warn("unconverged", Some(step.t_end), || {
            format!(
                "the contact problem of the step to t = {} ({contacts} contacts) was not solved: {} after {} iterations of {}, residual {:.1e}",
                time(step.t_end),
                outcome.status,
                outcome.iterations,
                outcome.used,
                outcome.residual.global
            )
        });
    }
}
