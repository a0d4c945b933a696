//! How a block moves that does so at the end of a run and has no other fate: it bounces, rolls, slides or falls (`docs/verdict.md`).

use super::standing::SETTLED;
use super::{BEGAN_TO_TIP, FLAT, Fates, Seen, Watch, Watched};
use serde::{Deserialize, Serialize};
use teeter_integrator::{State, StepReport};
use teeter_scenario::scene::SupportingBody;
use teeter_scenario::simulation::Layout;

/// How a block moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Going {
    /// It falls: it never touched anything, or is lower than where it last did.
    Falls,
    /// It flies: without gravity, or upwards from the start.
    Flies,
    /// It is in the air after a landing, or was so a short time ago.
    Bounces,
    /// It is on its contacts, and hops on them by less than can be seen.
    Hops,
    /// It stays on contacts with springs, and moves little and slowly.
    Vibrates,
    /// It stays where it stands, and is shaken there.
    Trembles,
    /// It stays about where it stands, but for slips, and its contacts open and close all the time.
    Chatters,
    /// It stays where it stands on another block, which moves.
    Rides,
    /// A round one turns about as fast as it goes, in the sense of its way.
    Rolls,
    /// A round one goes without turning so.
    Slides,
}

impl Going {
    /// All of them, in the order in which many blocks are told.
    pub(super) const ALL: [Self; 10] = [
        Self::Falls,
        Self::Flies,
        Self::Bounces,
        Self::Hops,
        Self::Vibrates,
        Self::Trembles,
        Self::Chatters,
        Self::Rides,
        Self::Rolls,
        Self::Slides,
    ];

    /// What it does, after "is".
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Falls => "still falling",
            Self::Flies => "still in flight",
            Self::Bounces => "still bouncing",
            Self::Hops => "at rest but for hops of less than a ten-thousandth of its size",
            Self::Vibrates => "still vibrating on its contacts",
            Self::Trembles => "still trembling where it stands",
            Self::Chatters => "still chattering where it stands",
            Self::Rides => "standing still on the block below it",
            Self::Rolls => "still rolling",
            Self::Slides => "still sliding",
        }
    }

    /// Whether it stays where it is on what carries it.
    pub(super) fn stays(self) -> bool {
        matches!(self, Self::Hops | Self::Vibrates | Self::Trembles | Self::Chatters | Self::Rides)
    }

    /// The same of several, after "are".
    pub(super) fn word_of_many(self) -> &'static str {
        match self {
            Self::Hops => "at rest but for hops of less than a ten-thousandth of their sizes",
            Self::Vibrates => "still vibrating on their contacts",
            Self::Trembles => "still trembling where they stand",
            Self::Chatters => "still chattering where they stand",
            Self::Rides => "standing still on the blocks below them",
            other => other.word(),
        }
    }
}

/// When a block touched something.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Touched {
    /// The end of the last step in which a contact pressed on it, s.
    last: Option<f64>,
    /// Whether none did in a step before.
    was_free: bool,
    /// When it last came down after a flight, not a moment without a contact, s.
    landed: Option<f64>,
    /// When it came down after the flight before that, s.
    landed_before: Option<f64>,
    /// How long that flight took, from the start of the run if it had not touched anything before, s.
    flown: f64,
    /// How high its mass centre was over what carries it at the end of the last step, where it last touched something, and at the highest since, m.
    now: f64,
    left: f64,
    highest: f64,
    /// How far that flight rose above where it left, or ended below, m.
    rose: f64,
    /// The ends of the last steps in which a contact of it closed, the latest first, s.
    closed: [Option<f64>; CHATTERS],
}

/// What closes a contact in so many steps, in the time after which what doesn't swing has stopped rocking, chatters.
const CHATTERS: usize = 4;

/// What neither rises nor falls by this part of R over what carries it doesn't bounce, however long it touches nothing: it rides on a beam that moves up and
/// down, micrometres above it. In free flight that takes as long as [`FLIGHT`].
const RISES: f64 = 1e-3;

/// Hops that rise by less than this part of R can't be seen: what does no more, with all of its corners as near to what carries it, is at rest.
const HOPS: f64 = 1e-4;

/// What touches nothing for less than this part of √(R/g) doesn't fly, but chatters: a bounce as long rises by little more than a thousandth of R.
pub(super) const FLIGHT: f64 = 0.1;

/// What rises by this part of R in its last flight bounces, whatever it turns by: a block that rocks hops by less as a corner lands.
const BOUNCES: f64 = 0.02;

/// What has been on its springs for this many times as long as its last flight took doesn't bounce any more.
const STAYS: f64 = 2.0;

/// What has stayed on what carries it for this many times as long as its last flight took has not been thrown up again: bounces become shorter.
const AGAIN: f64 = 4.0;

/// Up to this many times the speed of what is still, √(gR)/10, a motion on springs is a vibration.
const VIBRATES: f64 = 100.0;

impl Fates {
    /// Takes the contacts of a step in that ended at `t` (s).
    pub(super) fn touch(&mut self, watch: &Watch, layout: &Layout, step: &StepReport<'_, 2>, t: f64) {
        let pressing = || step.active().flat_map(|part| part.contacts).filter(|contact| contact.p[0] > 0.0);
        // Of few steps: a block that tips over the end of a beam falls soon.
        if self.blocks.iter().any(|seen| seen.out.is_some()) {
            let by_beam = |name: &String| layout.beams.iter().any(|beam| beam.name == *name);
            for contact in pressing() {
                let Some(pair) = layout.pairs.get(contact.id.pair() as usize) else { continue };
                let block = pair.points.first().and_then(|point| self.blocks.get_mut(point.block));
                if let Some(seen) = block.filter(|seen| seen.out.is_some() && pair.between.iter().any(by_beam)) {
                    seen.pressed = Some(t);
                }
            }
        }
        for (body, closes) in
            pressing().flat_map(|contact| [0, 1].map(|side| (contact.sides[side].body.0 as usize, !contact.persisting)))
        {
            let (Some(Seen { touched, .. }), Some(watched)) = (self.blocks.get_mut(body), watch.blocks.get(body))
            else {
                continue;
            };
            if touched.flies(step.t_start, watched) && touched.last != Some(t) {
                touched.landed_before = touched.landed.replace(t);
                touched.flown = step.t_start - touched.last.unwrap_or(0.0);
                touched.rose = if touched.last.is_some() { touched.strayed() } else { f64::INFINITY };
            }
            (touched.last, touched.left, touched.highest) = (Some(t), touched.now, touched.now);
            if closes && touched.closed[0] != Some(t) {
                touched.closed.rotate_right(1);
                touched.closed[0] = Some(t);
            }
        }
        self.find_lifted(watch, step, t);
        for Seen { touched, .. } in &mut self.blocks {
            touched.was_free |= touched.last != Some(t);
        }
    }
}

/// A contact is that of a foot if it is no further from it than this part of R.
const AT_FOOT: f64 = 1e-3;

impl Fates {
    /// Notes of blocks on springs which don't press with both feet in a step that ended at `t` (s).
    fn find_lifted(&mut self, watch: &Watch, step: &StepReport<'_, 2>, t: f64) {
        for (number, (seen, watched)) in self.blocks.iter_mut().zip(&watch.blocks).enumerate() {
            let Some(feet) = watched.feet.filter(|_| watched.on_springs) else { continue };
            let pressing = step.active().flat_map(|part| part.contacts).filter(|contact| contact.p[0] > 0.0);
            let mut presses = [false; 2];
            pressing.flat_map(|contact| &contact.sides).filter(|side| side.body.0 as usize == number).for_each(
                |side| {
                    for (presses, [x, y]) in presses.iter_mut().zip(feet) {
                        *presses |= (side.point[0] - x).hypot(side.point[1] - y) <= AT_FOOT * watched.reach;
                    }
                },
            );
            if presses != [true; 2] {
                seen.lifted = Some(t);
            }
        }
    }
}

impl Touched {
    /// Whether it ever touched something.
    pub(super) fn any(&self) -> bool {
        self.last.is_some()
    }

    /// Whether it ever came down from a flight.
    pub(super) fn has_landed(&self) -> bool {
        self.landed.is_some()
    }

    /// Whether nothing has touched a block in the time before `t`, s, for longer than what rocks hops. Not at the start, before the first step.
    pub(super) fn flies(&self, t: f64, watched: &Watched) -> bool {
        self.last.map_or(self.was_free, |last| t - last >= FLIGHT * watched.still_time)
    }

    /// Whether it has closed contacts again and again since the time `since`, s.
    pub(super) fn chatters(&self, since: f64) -> bool {
        self.closed.iter().all(|closed| closed.is_some_and(|closed| closed >= since))
    }

    /// Takes in how high over what carries it a block is at the end of a step, m.
    pub(super) fn rise(&mut self, height: f64) {
        self.now = height;
        self.highest = self.highest.max(height);
    }

    /// How far it has risen since it last touched something, or fallen below that place, m.
    fn strayed(&self) -> f64 {
        (self.highest - self.left).max(self.left - self.now)
    }
}

impl Seen {
    /// How it moves; `None` of one that does so in no way that has a word, such as a block that just began to slide.
    pub(super) fn going(&self, watched: &Watched, layout: &Layout, number: usize, state: &State) -> Option<Going> {
        let [_, vy, _] = watched.velocity(layout, number, state);
        let (t, Touched { last, flown, .. }) = (state.t, self.touched);
        let least = RISES * watched.reach;
        let landed = self.touched.landed.filter(|_| self.touched.rose >= least);
        let rides = last.is_some() && watched.gravity > 0.0 && self.touched.strayed() < least;
        if !rides && last.is_none_or(|last| t - last >= FLIGHT * watched.still_time) {
            // What has just landed before, and is no lower than its size yet, comes down on its next corner.
            let near = self.touched.left - self.touched.now < watched.reach;
            let hops = |last: f64| near && landed.is_some_and(|landed| last - landed <= SETTLED * watched.still_time);
            // In free flight it is where it last touched something again when its speed has turned round.
            let is_above = |last: f64| vy > -0.5 * watched.gravity * (t - last);
            return Some(match last {
                _ if watched.gravity == 0.0 => Going::Flies,
                None if vy > 0.0 => Going::Flies,
                Some(last) if hops(last) || (landed.is_some() && is_above(last)) => Going::Bounces,
                Some(last) if is_above(last) => Going::Flies,
                _ => Going::Falls,
            });
        }
        if last.is_some() && !watched.on_springs && self.hops(watched, layout, number, state) {
            return Some(Going::Hops);
        }
        // Bounces become shorter: had it bounced again, it would have left its springs by now.
        let stays = landed.is_none_or(|landed| t - landed > STAYS * flown);
        if watched.on_springs && stays && watched.speed(layout, number, state) <= VIBRATES * watched.still_speed {
            return Some(Going::Vibrates);
        }
        // One that can't turn over any more stays on the corner on which it landed, sooner than that.
        let least = if self.settling.is_some() { FLAT } else { SETTLED };
        if landed.is_some_and(|landed| t - landed <= (least * watched.still_time).min(AGAIN * flown)) {
            return Some(Going::Bounces);
        }
        watched.is_round.then(|| match () {
            // What carries it takes it along.
            () if !self.goes_along(watched, t) => Going::Trembles,
            () if self.rolling.rolls => Going::Rolls,
            () => Going::Slides,
        })
    }

    /// Whether it is in the air after a landing, or was so a short time ago, higher than what rocks hops. After a single hop it rocks as soon as it
    /// has `crossed` the upright (s) since it landed.
    pub(super) fn bounces(
        &self,
        watched: &Watched,
        layout: &Layout,
        number: usize,
        state: &State,
        crossed: Option<f64>,
    ) -> bool {
        let Touched { rose, landed, landed_before, last, .. } = self.touched;
        let flies = last.is_none_or(|last| state.t - last >= FLIGHT * watched.still_time);
        let again = landed.zip(landed_before).is_some_and(|(now, before)| now - before <= SETTLED * watched.still_time);
        let rocks = landed.zip(crossed).is_some_and(|(landed, crossed)| crossed > landed);
        if rocks && !flies && !again {
            return false;
        }
        let high = BOUNCES * watched.reach;
        let is_high = (rose.is_finite() && rose >= high) || (landed.is_some() && self.touched.strayed() >= high);
        is_high && self.going(watched, layout, number, state) == Some(Going::Bounces)
    }

    /// Whether a block that touches something, and came down from a flight a short time ago, rises by no more than [`HOPS`], now or with all of its
    /// speed, lies as flat, and doesn't go along what carries it. What tips up rises no more at first, but about a corner.
    fn hops(&self, watched: &Watched, layout: &Layout, number: usize, state: &State) -> bool {
        let [vx, vy, _] = watched.velocity(layout, number, state);
        let (sin, cos) = watched.carrier.slope(&state.q).sin_cos();
        let goes = (cos * vx + sin * vy).abs();
        let rises = watched.speed(layout, number, state).powi(2) / (2.0 * watched.gravity);
        let has_landed = self.touched.landed.is_some_and(|landed| state.t - landed <= SETTLED * watched.still_time);
        // Of a width of up to 2R the far corner is as high as that.
        let is_flat = || watched.turned(layout, number, state).abs() * 2.0 * watched.reach < HOPS * watched.reach;
        // Also false without gravity.
        has_landed && is_flat() && goes <= watched.still_speed && self.touched.strayed() + rises < HOPS * watched.reach
    }

    /// Whether it has only moved with what carries it: neither slid by a tenth of `least` (m), nor turned against it, nor flown.
    pub(super) fn never_moved(&self, watched: &Watched, least: f64) -> bool {
        let is_placed = watched.on.is_some() && self.touched.last.is_some() && self.touched.landed.is_none();
        let is_upright = |part| part < BEGAN_TO_TIP;
        let is_there = || watched.is_round && self.rolling.is_there(watched);
        is_placed && self.slides.most() < 0.1 * least && self.part.map_or_else(is_there, is_upright)
    }

    /// Whether it has never moved on the block that it stands on: neither slid by a tenth of `least` (m), nor turned against it by what can be seen.
    pub(super) fn rides(&self, watched: &Watched, least: f64) -> bool {
        let is_on_block = matches!(watched.on, Some(SupportingBody::Block(_)));
        let [left, right] = self.turned;
        is_on_block && self.began.is_some() && self.slides.most() < 0.1 * least && left.max(right) < HOPS
    }
}
