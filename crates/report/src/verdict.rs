//! What became of the blocks of a run: which overturned, came to rest, slid, left their beam or rock on (`docs/verdict.md`).
//!
//! [`Fates`] watches every step; [`Fates::verdict`] says at the end what became of whom, and [`Fates::stop`] meanwhile whether the run is to end. It
//! follows from positions and velocities of blocks and what carries them, as `trajectory.csv` has them; only how a block moves at the end is told by the
//! contacts that pressed, too.

mod body;
mod carrier;
mod columns;
mod fallen_beams;
mod falling;
mod floor;
mod going;
mod headline;
mod judgement;
mod lying;
mod many;
mod rolling;
mod sliding;
mod stance;
mod standing;
mod terrain;
mod watch;

pub use body::{BodyVerdict, Fate};
use columns::{Column, Lean};
pub(crate) use fallen_beams::{fallen_beams, is_carried};
use falling::Joints;
pub(crate) use going::Going;
use going::Touched;
pub(crate) use headline::{MORE, OfBeams, headline, part, percent};
pub use lying::Side;
use rolling::Rolling;
use serde::{Deserialize, Serialize};
use sliding::Slides;
use stance::{Outline, Stance};
pub use stance::{SharedStances, Way};
use standing::{AtStart, Settling};
use teeter_integrator::{Mismatch, Model, PhaseKind, RockingMonitor, State, StepReport};
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Layout;
use watch::Watched;
pub(crate) use watch::{Tilt, Watch, points_of_no_return};

/// A block is still below this part of √(gR): then no point of it rises by more than half a millionth of R by its speed alone.
pub(crate) const STILL: f64 = 1e-3;

/// A block that was still at both ends of a step moved within it if an impact changed its velocity by more than this part of √(gR), as that of a
/// ball that hands a blow on.
const STRUCK: f64 = 0.1;

/// A block has fallen when it is past the point of no return by this part of the way to lying on the next side: a bent beam or a slope may be in the way
/// of the rest.
pub(crate) const FALLEN: f64 = 0.9;

/// A block that began in flight tumbled if it has turned by this angle, rad.
const TUMBLED: f64 = 0.75 * std::f64::consts::PI;

/// A block that hasn't rocked for this many √(R/g) only slides, if it does: a swing as small as [`ROCKED`] takes less.
const FLAT: f64 = 2.0;

/// A block slid, in a word, if it did by this part of its base.
pub(crate) const SLID: f64 = 0.01;

/// A block that turns farther than ever at the end, and got to this part of its critical angle, tips: less may be the bending of a beam. The same part of
/// it against what carries it tells that it isn't upright there: less is rounding.
const BEGAN_TO_TIP: f64 = 1e-3;

/// While what is below it moves on, a block rests only if it has been still for this many times its longest pause so far.
const PAUSES: f64 = 1.5;

/// A round block rolled, in a word, if it turned by this angle as it did, rad: a hundredth of a turn.
const ROLLED: f64 = 0.01 * std::f64::consts::TAU;

/// A block rocks, in a word, if it got to this part of its critical angle.
pub(crate) const ROCKED: f64 = 0.01;

/// What ended a run before its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum StopReason {
    /// A block has overturned.
    Overturned,
    /// All blocks rest.
    Rest,
    /// A block is below everything that could hold it.
    Sunk,
}

impl StopReason {
    /// Its word in a scene.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Overturned => "overturned",
            Self::Rest => "rest",
            Self::Sunk => "sunk",
        }
    }
}

/// What is known of a block so far.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Seen {
    /// The angle that its stance is about, rad; `None` of a block that began in flight and has not settled yet.
    began: Option<f64>,
    /// Of such a block, while nothing but a push could turn it over.
    settling: Option<Settling>,
    /// Where it was at the start of the run, m, m, and its angle, from which its turns count, rad.
    start: [f64; 3],
    /// Its angle at the end of the last step, rad.
    angle: f64,
    /// The same against what carries it.
    #[serde(skip)]
    tilt: Tilt,
    /// The largest |φ|/α.
    part: Option<f64>,
    /// How far it has turned at most against what carries it, to the left and to the right, rad.
    turned: [f64; 2],
    /// By how much it was turned against what it is placed on when that was largest, rad.
    joint: f64,
    /// When, s, and at which angle from where |φ|/α counts, rad, it last had turned by as much as is called rocking.
    swung: Option<(f64, f64)>,
    /// Since when it is past a point of no return, s, and to which side.
    beyond: Option<(f64, Way)>,
    /// Whether it has fallen to the next side since.
    fallen: bool,
    /// The column of which it has been a part since the start, or when that passed its point of no return.
    column: Option<Column>,
    /// Of a block on others, one on each: of the part of the stack up to it.
    lean: Option<Lean>,
    /// Since when it is still, s.
    still: Option<f64>,
    /// Since when it is also still relative to the supports of the beam that carries it, or to what else does, s.
    unmoved: Option<f64>,
    /// When what carries it last moved, or was to, s.
    carried: Option<f64>,
    /// How long it was still at most between two motions, s; `None` before the first.
    paused: Option<f64>,
    /// Whether its mass centre has been over its beam, and since when it is past an end, s, and which.
    over: bool,
    out: Option<(f64, Way)>,
    /// The end of the last step in which a beam pressed on it since then, s.
    pressed: Option<f64>,
    /// To which side its mass centre was past the contacts that held it flat at the start.
    past_edge: Option<Way>,
    /// Since when it is below everything, s.
    sunk: Option<f64>,
    /// From when on it stands, s: the start, or when it settled.
    stands_from: Option<f64>,
    /// Where it began to stand along what carries it, m.
    stood: Option<f64>,
    /// Where its mass centre was along what carries it at the start of the run, m.
    released: f64,
    /// The farthest to the left and to the right of there that it has been, by slides and hops, m.
    been: [f64; 2],
    /// How it has slid, from the start of the run.
    slides: Slides,
    /// How far it had slid, and in all, m, when it passed the point of no return that it is past, or its column did.
    slid_before: Option<[f64; 2]>,
    /// How it has rolled and skidded on what holds it; of a round one.
    rolling: Rolling,
    /// The same when it was past the end of its beam, or had fallen from its place, while it is.
    rolled_before: Option<Rolling>,
    /// By how much it turned in the last step, rad; memory.
    #[serde(skip)]
    turn: f64,
    /// What holds it from below in a step so far, N·s, and its slip by that; memory.
    #[serde(skip)]
    sliding: [f64; 2],
    /// How far it has slid in a step, m, if something held it from below in that; memory.
    #[serde(skip)]
    slipped: Option<f64>,
    /// The end of the last step in which not both of its feet pressed, s; of a block on springs.
    lifted: Option<f64>,
    /// How high it was at the start, m; of a block that other blocks hold.
    height: Option<f64>,
    /// Since when it is lower than that by more than its thickness, s.
    dropped: Option<f64>,
    /// When it touched something.
    touched: Touched,
    /// How it stands, or would if it settled at its angle, once known.
    #[serde(skip)]
    stance: KnownStance,
}

/// A stance that follows from the rest of a record, kept as it takes long to find: longer than all
/// else that is done for a short run. `Some(None)` for a block that can't overturn.
#[derive(Clone, Copy, Debug, Default)]
struct KnownStance(Option<Option<Stance>>);

/// A record is the same whether it is kept or not.
impl PartialEq for KnownStance {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Seen {
    /// Whether it is past its point of no return, or with its column past that of all of it.
    fn is_past(&self) -> bool {
        self.beyond.is_some() || self.column.is_some_and(|column| column.beyond.is_some())
    }
}

/// What is known of the blocks so far.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Fates {
    blocks: Vec<Seen>,
    /// When the run began, s: 0, but for one from the state of another.
    began_at: f64,
    /// What held them at the start.
    joints: Joints,
    /// The time and stop that ended the run.
    stopped: Option<(f64, StopReason)>,
}

impl Fates {
    /// Between which angles each block stood, rad, with its column if it turned as one with that; none for one that can't overturn, or began in
    /// flight and didn't settle.
    pub(crate) fn points_of_no_return(&self, watch: &Watch) -> Vec<Option<[f64; 2]>> {
        let of = |(seen, watched): (&Seen, &Watched)| match seen.column {
            Some(column) => Some(column.tops),
            None => seen.stance(watched).map(|stance| stance.tops()),
        };
        self.blocks.iter().zip(&watch.blocks).map(of).collect()
    }

    /// Before the first step.
    pub(crate) fn start(
        &mut self,
        watch: &Watch,
        layout: &Layout,
        model: &Model<2>,
        state: &State,
    ) -> Result<(), Mismatch> {
        self.blocks.clear();
        self.began_at = state.t;
        let AtStart { standing, touching, past_edge } = standing::at_start(&watch.blocks, layout, model, state)?;
        self.joints = Joints::new(&touching, &watch.blocks, layout, state);
        for (number, ((watched, stands), past_edge)) in watch.blocks.iter().zip(standing).zip(past_edge).enumerate() {
            let q = &state.q[layout.blocks[number].range.clone()];
            let (start, angle) = ([q[0], q[1], q[2]], q[2]);
            // What was placed on something stands there on its base, however far that slopes or it is tilted: on a slope beyond α it is past the
            // point of no return from the start. Its base is the side below where it is level for gravity, which may lean.
            let level = watched.outline.as_ref().map_or(0.0, Outline::level);
            let about = if watched.on.is_some() { level } else { angle };
            let stood = if stands { watched.place(layout, number, state) } else { None };
            let (began, stands_from) = (stands.then_some(about), stands.then_some(state.t));
            let height = (stands && self.joints.only_by_blocks(number)).then(|| watched.height(layout, number, state));
            self.blocks.push(Seen {
                began,
                released: watched.centre(layout, number, state),
                start,
                angle,
                stands_from,
                stood,
                height,
                past_edge,
                ..Seen::default()
            });
        }
        self.look(watch, layout, state.t, state);
        Ok(())
    }

    /// The angle of each block against what carries it at the end of the last step.
    pub(crate) fn tilts(&self) -> impl Iterator<Item = Tilt> {
        self.blocks.iter().map(|seen| seen.tilt)
    }

    /// Takes a step in.
    pub(crate) fn observe(&mut self, watch: &Watch, layout: &Layout, step: &StepReport<'_, 2>, state: &State) {
        self.look(watch, layout, step.t_start, state);
        for seen in &mut self.blocks {
            let slid = [seen.slides.at(), seen.slides.in_all()];
            seen.slid_before = if seen.is_past() { seen.slid_before.or(Some(slid)) } else { None };
            let is_away = seen.out.is_some() || seen.dropped.is_some();
            seen.rolled_before = if is_away { seen.rolled_before.or(Some(seen.rolling)) } else { None };
        }
        self.find_struck(watch, layout, step);
        self.slide(watch, step);
        self.touch(watch, layout, step, state.t);
        self.roll(watch, layout, step.t_start, state);
        if self.stopped.is_none() {
            self.stopped = self.stop(watch, state.t).map(|reason| (state.t, reason));
        }
    }

    /// What is still at the end of the step is so from the last blow in it on.
    fn find_struck(&mut self, watch: &Watch, layout: &Layout, step: &StepReport<'_, 2>) {
        for phase in step.phases().filter(|phase| phase.kind == PhaseKind::Impact) {
            for (number, (seen, watched)) in self.blocks.iter_mut().zip(&watch.blocks).enumerate() {
                let range = layout.blocks[number].range.clone();
                let [before, after] = phase.v.map(|v| &v[range.clone()]);
                let [x, y, spin] = [0, 1, 2].map(|i| after[i] - before[i]);
                let change = x.hypot(y) + watched.reach * spin.abs();
                if change > STRUCK / STILL * watched.still_speed {
                    seen.still = seen.still.map(|_| phase.end);
                }
            }
        }
    }

    fn look(&mut self, watch: &Watch, layout: &Layout, before: f64, state: &State) {
        let floor = watch.floor.depth(layout, &state.q);
        for (number, (seen, watched)) in self.blocks.iter_mut().zip(&watch.blocks).enumerate() {
            seen.tilt = watched.tilt(layout, number, state);
            let place = &layout.blocks[number];
            let q = &state.q[place.range.clone()];
            let t = state.t;
            if watched.driven {
                let is_still = watched.speed_over_base(layout, number, state) <= watched.still_speed;
                seen.still = if is_still { seen.still.or(Some(t)) } else { None };
                continue;
            }
            if seen.began.is_none() {
                seen.settle((watched, number), watch.slope(number, layout, state), layout, before, state);
            }
            let stance = seen.stance(watched);
            if seen.began.is_some() {
                seen.stance = KnownStance(Some(stance));
            }
            // Past the end of its beam nothing carries it that it could overturn on.
            let carried = seen.out.is_none() || seen.beyond.is_some();
            if let Some(mut stance) = stance.filter(|_| carried) {
                let line = watch.slope(number, layout, state);
                let (tilt, least) = (q[2] - line, 0.5 * ROCKED * (stance.left.top - stance.right.top));
                seen.swung = seen.swung.filter(|(_, at)| (tilt - at).abs() < least).or(Some((t, tilt)));
                let largest = stance.part(q[2], line).filter(|part| seen.part.is_none_or(|most| *part > most));
                // In the air it turns about its mass centre, not about a foot.
                let largest = largest.filter(|_| !seen.touched.flies(before, watched));
                if largest.is_some() {
                    (seen.part, seen.joint) = (largest, seen.tilt.carrier.abs());
                }
                let way = Way::of(q[2] - stance.flat);
                let edge = stance.edge(way);
                let past = |angle: f64| way.sign() * (angle - edge.top);
                if past(q[2]) <= 0.0 {
                    (seen.beyond, seen.fallen) = (None, false);
                } else {
                    if seen.beyond.is_none_or(|(_, earlier)| earlier != way) {
                        let (from, to) = (past(seen.angle), past(q[2]));
                        let share = if from < 0.0 { from / (from - to) } else { 1.0 };
                        seen.beyond = Some((before + share * (t - before), way));
                    }
                    let lies = edge.lies.or_else(|| watched.outline.as_ref()?.lies(edge, way));
                    stance.edge_mut(way).lies = lies;
                    seen.stance = KnownStance(Some(Some(stance)));
                    let slope = || watched.slope(&state.q);
                    let way_down = lies.map(|lies| way.sign() * (lies + slope() - edge.top));
                    seen.fallen |= way_down.is_some_and(|way_down| past(q[2]) >= FALLEN * way_down);
                }
            }
            (seen.turn, seen.angle) = (q[2] - seen.angle, q[2]);
            if let Some(stood) = seen.stood.filter(|_| seen.beyond.is_none()) {
                let at = watched.place(layout, number, state).map_or(0.0, |at| at - stood);
                seen.been = [seen.been[0].min(at), seen.been[1].max(at)];
            }
            let [left, right] = &mut seen.turned;
            (*left, *right) = (left.max(seen.tilt.rocking()), right.max(-seen.tilt.rocking()));
            if let Some(height) = seen.height {
                let drop = height - watched.height(layout, number, state);
                seen.dropped = if drop > watched.thickness { seen.dropped.or(Some(t)) } else { None };
            }
            seen.touched.rise(watched.clearance(layout, number, state));
            let [vx, vy, _] = watched.carrier.velocity([q[0], q[1]], None, layout, state);
            if t < watched.driven_until || vx.hypot(vy) > watched.still_speed {
                seen.carried = Some(t);
            }
            let is_unmoved = watched.speed_over_base(layout, number, state) <= watched.still_speed;
            seen.unmoved = if is_unmoved { seen.unmoved.or(Some(t)) } else { None };
            let speed = watched.speed(layout, number, state);
            seen.still = if speed <= watched.still_speed {
                seen.still.or(Some(t))
            } else {
                // Before it moved for the first time it did not pause.
                let pause = seen.paused.and(seen.still).map_or(0.0, |since| before - since);
                seen.paused = Some(seen.paused.map_or(0.0, |longest| longest.max(pause)));
                None
            };
            if let Some(past) = watched.carrier.past_end([q[0], q[1]], layout, &state.q) {
                seen.out = match past {
                    None => {
                        seen.over = true;
                        None
                    }
                    Some(way) if seen.over => seen.out.filter(|(_, earlier)| *earlier == way).or(Some((t, way))),
                    Some(_) => None,
                };
            }
            let sunk = floor.is_above([q[0], q[1]], watched.reach, layout, &state.q);
            seen.sunk = if sunk { seen.sunk.or(Some(t)) } else { None };
        }
        self.look_at_columns(watch, layout, before, state);
    }

    /// Since when it rests at the time `t` (s). While what is below it moves on it may only pause, as it did before.
    fn rests(seen: &Seen, watched: &Watched, t: f64) -> Option<f64> {
        let pause = seen.paused.filter(|_| t < watched.driven_until).map_or(0.0, |longest| PAUSES * longest);
        seen.still.filter(|since| t - since >= watched.still_time.max(pause))
    }

    /// What ends the run at the time `t` (s).
    fn stop(&self, watch: &Watch, t: f64) -> Option<StopReason> {
        if !watch.stop.is_given() {
            return None;
        }
        let free = || self.blocks.iter().zip(&watch.blocks).filter(|(_, watched)| !watched.driven);
        free().next()?;
        let rests = |(seen, watched): (&Seen, &Watched)| Self::rests(seen, watched, t).is_some();
        let down = |of: (&Seen, &Watched)| of.0.is_past() && (of.0.fallen || rests(of));
        if watch.stop.overturned && free().any(down) {
            return Some(StopReason::Overturned);
        }
        if watch.stop.sunk && free().any(|(seen, _)| seen.sunk.is_some()) {
            return Some(StopReason::Sunk);
        }
        // What is free in part has no verdict, but may still move the others.
        let mut movable = self.blocks.iter().zip(&watch.blocks).filter(|(_, watched)| !watched.held);
        (watch.stop.rest && t > watch.settles_at && movable.all(rests)).then_some(StopReason::Rest)
    }

    /// What ended the run before its end, and when, s.
    #[must_use]
    pub fn stopped(&self) -> Option<(f64, StopReason)> {
        self.stopped
    }

    /// How far a block is from where it was at the start of the run, m, m, and by how much it has turned since, rad.
    pub(crate) fn moved(&self, number: usize, layout: &Layout, state: &State) -> [f64; 3] {
        let (q, seen) = (&state.q[layout.blocks[number].range.clone()], &self.blocks[number]);
        [0, 1, 2].map(|k| q[k] - seen.start[k])
    }

    /// What became of each block whose motion isn't prescribed.
    pub(crate) fn verdict(
        &self,
        scene: &Scene,
        layout: &Layout,
        state: &State,
        rocking: &[RockingMonitor],
    ) -> Vec<BodyVerdict> {
        let watch = Watch::of(scene, layout);
        let any_dropped = self.blocks.iter().any(|seen| seen.dropped.is_some());
        let loose = if any_dropped { self.loose(&watch, layout, state) } else { vec![false; self.blocks.len()] };
        let of = |(number, (seen, watched)): (usize, (&Seen, &Watched))| {
            (!watched.driven).then(|| {
                let block = &scene.blocks[number];
                let fell = seen.dropped.filter(|_| loose[number]);
                seen.verdict(watched, (number, block), layout, (self.began_at, state), (rocking.get(number), fell))
            })
        };
        let mut verdict: Vec<BodyVerdict> = self.blocks.iter().zip(&watch.blocks).enumerate().filter_map(of).collect();
        columns::find(&watch.blocks, &self.blocks, scene, layout, state, &mut verdict);
        for of in &mut verdict {
            let way = |at: Option<f64>| headline::way(scene, of, at?);
            (of.slid_to, of.farthest_to) = (way(of.slid), way(of.farthest));
        }
        verdict
    }
}
