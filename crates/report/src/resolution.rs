//! Whether steps were fine enough for the motion that a run showed (`docs/resolution.md`).
//!
//! A contact that closes does so up to a step late: its gap is then wrong by up to h |u_n|, u_n its velocity before. Added up over the impacts and carried on by what
//! the block does after them, relative to how far it swings or flies, that is what an error of the motion grows from. One measure says it, whether steps
//! miss impacts, lose contacts and find them again, or let corners go deep: each of these closes contacts with large h |u_n|.

use serde::{Deserialize, Serialize};
use teeter_integrator::{Active, Contact, State, StepReport};
use teeter_scenario::scene::{Crowd, Scene};
use teeter_scenario::simulation::Layout;

/// Above this part of the motion, a run is likely off by more than 10 %.
const COARSE: f64 = 0.012;

/// And above this part of the motion at a single impact: a block that falls flat rests where it closed, about half of it off.
const COARSE_ONCE: f64 = 0.2;

/// And where both feet press with gaps that differ by this part of the motion: that much the block leans without a cause.
const HELD_OFF: f64 = 0.05;

/// Leaning by less than [`HELD_OFF`] of this, rad, is none.
const LEVEL: f64 = 0.01;

/// A fall that is off by this part of a block's larger side is told of.
const FALL_OFF: f64 = 0.1;

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
    /// Its largest angle from what carries it, rad: with the range above, alike for a scene that is turned as a whole.
    tilted: f64,
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
    /// By how much the gaps of its feet differ while both go on pressing, m: the largest so far.
    held: f64,
    /// The smallest and largest gap of those that go on pressing in this part of a step, m.
    gaps: Option<[f64; 2]>,
    /// How long nothing has pressed on it, and the longest of such times, s.
    aloft: [f64; 2],
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
    /// What that is of.
    pub(crate) of: Of,
    /// A step to take in its place, s.
    pub(crate) step: f64,
}

/// What of a motion is not resolved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Of {
    /// Its impacts, all together.
    Impacts,
    /// A single impact.
    Impact,
    /// Feet that go on pressing where nothing touches, or deep inside.
    Held,
}

impl Of {
    /// The part of the motion from which on it is told.
    pub(crate) fn limit(self) -> f64 {
        match self {
            Self::Impacts => COARSE,
            Self::Impact => COARSE_ONCE,
            Self::Held => HELD_OFF,
        }
    }
}

impl Resolution {
    /// Before the first step.
    pub(crate) fn start(&mut self, layout: &Layout, state: &State) {
        self.blocks.clear();
        self.blocks.extend(layout.blocks.iter().enumerate().map(|(block, place)| {
            let angle = state.q[place.range.start + 2];
            let tilted = layout.tilt(block, &state.q).abs();
            Seen { angles: [angle, angle], tilted, normal: [0.0, 1.0], ..Seen::default() }
        }));
    }

    /// Takes a step in.
    pub(crate) fn observe(&mut self, bodies: &Bodies, layout: &Layout, step: &StepReport<'_, 2>, state: &State) {
        for (number, part) in step.active().enumerate() {
            // What presses in the last part of the step counts.
            if number > 0 && part.end > part.start {
                self.blocks.iter_mut().for_each(|seen| seen.pressed = 0);
            }
            self.take_contacts(bodies, &part);
            if part.contacts.len() > 1 {
                self.take_gaps(bodies, part.contacts);
            }
        }
        self.take_places(bodies, layout, step.t_end - step.t_start, state);
    }

    fn take_contacts(&mut self, bodies: &Bodies, part: &Active<'_, 2>) {
        let h = part.end - part.start;
        for contact in part.contacts {
            let Some(seen) = self.of(bodies, contact) else { continue };
            seen.pressed += u32::from(contact.p[0] > 0.0 && h > 0.0);
            seen.normal = [contact.frame[(0, 0)], contact.frame[(0, 1)]];
            // One that closes fast and gets no impulse, as the surface is gone again by the end of the step, is as late. A contact with duration takes
            // its time, and its force begins at nothing.
            if !contact.persisting && contact.gap_after.is_none() {
                let late = h * (-contact.u_before[0]).max(0.0);
                seen.late += late;
                raise(&mut seen.latest, late);
            }
        }
    }

    /// By how much the gaps of contacts that go on pressing on a block differ.
    #[inline(never)]
    fn take_gaps(&mut self, bodies: &Bodies, contacts: &[Contact<2>]) {
        for contact in contacts.iter().filter(|contact| contact.persisting && contact.p[0] > 0.0) {
            let Some(seen) = self.of(bodies, contact).filter(|_| contact.gap_after.is_none()) else { continue };
            let [least, most] = seen.gaps.unwrap_or([contact.gap; 2]);
            seen.gaps = Some([least.min(contact.gap), most.max(contact.gap)]);
        }
        for seen in &mut self.blocks {
            if let Some([least, most]) = seen.gaps.take() {
                raise(&mut seen.held, most - least);
            }
        }
    }

    /// The block that a contact is of.
    #[inline]
    fn of(&mut self, bodies: &Bodies, contact: &Contact<2>) -> Option<&mut Seen> {
        let pair = contact.id.pair();
        let of_crowd = || bodies.crowd.as_ref()?.blocks_of(bodies.owners.len(), pair).map(|[first, _]| first);
        self.blocks.get_mut(bodies.owners.get(pair as usize).copied().or_else(of_crowd)?)
    }

    fn take_places(&mut self, bodies: &Bodies, layout: &Layout, h: f64, state: &State) {
        for (block, ((seen, place), width)) in
            self.blocks.iter_mut().zip(&layout.blocks).zip(&bodies.widths).enumerate()
        {
            let [q, v] = [&state.q, &state.v].map(|x| &x[place.range.clone()]);
            raise(&mut seen.tilted, layout.tilt(block, &state.q).abs());
            if q[2] < seen.angles[0] {
                seen.angles[0] = q[2];
            }
            raise(&mut seen.angles[1], q[2]);
            // On both feet it goes with what carries it.
            let mut way = if seen.pressed < 2 { h * width * v[2].abs() } else { 0.0 };
            seen.aloft[0] = if seen.pressed == 0 { seen.aloft[0] + h } else { 0.0 };
            if seen.pressed == 0 {
                let [now, longest] = &mut seen.aloft;
                raise(longest, *now);
                let flown = h * (seen.normal[0] * v[0] + seen.normal[1] * v[1]).abs();
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
        let parts = self.blocks.iter().zip(&bodies.widths).enumerate().flat_map(|(block, (seen, width))| {
            seen.parts(*width).map(|(of, part)| {
                let limit = of.limit();
                let step = step * (FINE * limit / part).max(SHORTEST);
                (part / limit, Coarse { block, part, of, step })
            })
        });
        let worst = parts.filter(|(times, _)| *times > 1.0).max_by(|(a, _), (b, _)| a.total_cmp(b));
        worst.map(|(_, coarse)| coarse)
    }

    /// The block whose flight steps of length `step` (s) with this θ make slower or faster the most, and by how much, m: (θ − ½) g h t. `None` where that
    /// is little beside the block.
    pub(crate) fn fall(&self, bodies: &Bodies, step: f64) -> Option<(usize, f64)> {
        let off = |seen: &Seen| (bodies.theta - 0.5).abs() * bodies.gravity * step * seen.aloft[1];
        let all = self.blocks.iter().map(off).zip(&bodies.sides).enumerate();
        let far = all.filter(|(_, (off, side))| *off > FALL_OFF * **side);
        far.map(|(block, (off, _))| (block, off)).max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// Becomes `x` where that is more.
#[inline]
pub(crate) fn raise(most: &mut f64, x: f64) {
    if x > *most {
        *most = x;
    }
}

impl Seen {
    /// What of the motion of this block of so much `width` (m) is not resolved, as parts of it.
    ///
    /// Lateness all together is the geometric mean of the sum and of what of it was carried on through the motion: an impact after which little moves
    /// does little harm.
    fn parts(&self, width: f64) -> [(Of, f64); 3] {
        let [least, most] = self.angles;
        let swing = (most - least).max(self.tilted).min(std::f64::consts::PI);
        let carried = if self.way > 0.0 { 2.0 * self.carried / self.way } else { 0.0 };
        let motion = (width * swing).max(self.flown).max(STILL * width);
        [
            (Of::Impacts, (carried * self.late).sqrt() / motion),
            (Of::Impact, self.latest / motion),
            (Of::Held, self.held / motion.max(LEVEL * width)),
        ]
    }
}

/// What of the scene it goes by.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bodies {
    /// The block of each listed pair.
    owners: Vec<usize>,
    /// The pairs that are not listed.
    crowd: Option<Crowd>,
    /// How far the feet of each block are apart, m.
    widths: Vec<f64>,
    /// The larger side of each block, m.
    sides: Vec<f64>,
    /// θ of the scheme.
    theta: f64,
    /// m/s².
    gravity: f64,
}

impl Bodies {
    pub(crate) fn of(scene: &Scene) -> Self {
        Self {
            owners: scene.contacts.iter().map(|contact| contact.block).collect(),
            crowd: scene.crowd.clone(),
            widths: scene.blocks.iter().map(|block| block.width).collect(),
            sides: scene.blocks.iter().map(|block| block.width.max(block.height)).collect(),
            theta: scene.time.theta_of_scheme(),
            gravity: scene.gravity[0].hypot(scene.gravity[1]),
        }
    }
}
