//! What became of the blocks of a run: which overturned, came to rest, slid, left their beam or rock on (`docs/verdict.md`).
//!
//! [`Fates`] watches every step; [`Fates::verdict`] says at the end what became of whom, and [`Fates::stop`] meanwhile whether the run is to end. It
//! follows from positions and velocities of blocks and what carries them, as `trajectory.csv` has them; only how a block moves at the end is told by the
//! contacts that pressed, too.

mod carrier;
mod columns;
mod falling;
mod floor;
mod going;
mod headline;
mod lying;
mod sliding;
mod stance;
mod standing;

use carrier::Carrier;
use columns::{Column, Lean};
use falling::Joints;
use floor::Floor;
pub(crate) use going::Going;
use going::Touched;
pub(crate) use headline::{headline, part, percent};
pub use lying::Side;
use serde::{Deserialize, Serialize};
use sliding::Slides;
use stance::{Edge, Outline, Stance};
pub use stance::{SharedStances, Way};
use standing::{AtStart, Settling};
use teeter_integrator::{Mismatch, Model, PhaseKind, RockingMonitor, State, StepReport};
use teeter_scenario::TiltReference;
use teeter_scenario::scene::{BlockScene, Placement, Scene, StopScene, SupportingBody};
use teeter_scenario::simulation::Layout;

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
const SLID: f64 = 0.01;

/// A block that turns farther than ever at the end, and got to this part of its critical angle, tips: less may be the bending of a beam. The same part of
/// it against what carries it tells that it isn't upright there: less is rounding.
const BEGAN_TO_TIP: f64 = 1e-3;

/// While what is below it moves on, a block rests only if it has been still for this many times its longest pause so far.
const PAUSES: f64 = 1.5;

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

/// What became of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Fate {
    /// It lies on another side, or falls to it.
    Overturned,
    /// Its mass centre went past an end of the beam that carried it.
    Left,
    /// It is below everything that could hold it.
    Sunk,
    /// It fell from its place among other blocks that held it.
    Fell,
    /// It came to rest where it stood.
    Rests,
    /// It slid, and may have come to rest.
    Slid,
    /// It rocks on.
    Rocks,
    /// It moves in another way, such as a bouncing or a rolling block.
    Moves,
}

/// What became of a block, with its numbers; those that have no meaning for it are null.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BodyVerdict {
    /// The block.
    pub body: String,
    /// What became of it.
    pub what: Fate,
    /// When, s: overturned, left, sunk or fell, came to rest; of a block that rocks on the last peak; null for others.
    pub t: Option<f64>,
    /// To which side it overturned or left its beam.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub way: Option<Way>,
    /// When it had fallen from its place among other blocks, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fell_at: Option<f64>,
    /// When it passed the point of no return for good, s.
    pub overturned_at: Option<f64>,
    /// From when on it rests, s.
    pub rests_from: Option<f64>,
    /// On which side it rests, of one that does and doesn't lean on something.
    pub lies_on: Option<Side>,
    /// How far it slid along what carries it, from the start to the end, m; to the right positive.
    pub slid: Option<f64>,
    /// The farthest that it was from where it stood, of one that slid back from there, m; to the right positive. Of one that has then
    /// slid farther past its start, where it turned.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub farthest: Option<f64>,
    /// The farthest to the left and to the right of where it stood that it was, m, of one that slid to one side, back, and on again.
    #[serde(skip)]
    pub(crate) to_and_fro: Option<[f64; 2]>,
    /// Whether what is below it moves on as prescribed.
    #[serde(skip)]
    pub(crate) is_driven: bool,
    /// Whether it has slid, and stands by now, though it isn't still.
    #[serde(skip)]
    pub(crate) stopped: bool,
    /// How fast it moves at the end relative to what carries it, m/s; of one that slides on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    /// The largest |φ|/α.
    pub max_phi_over_alpha: Option<f64>,
    /// The last peak of its rocking, rad; of one that did not cross zero yet the largest angle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub last_peak: Option<f64>,
    /// Against what its peaks count, in words; none where that is the horizontal.
    #[serde(skip)]
    pub(crate) against: Option<String>,
    /// Since when it is still, of one that is so at the end, but not for long enough to rest, s.
    #[serde(skip)]
    pub(crate) still_from: Option<f64>,
    /// From when on it stands, s: 0, or when it settled; none of what flies or tumbles on.
    #[serde(skip)]
    pub(crate) stands_from: Option<f64>,
    /// Of a block that rocks and has not been upright yet, nor turned back: its angle at the end, rad.
    #[serde(skip)]
    pub(crate) on_its_way: Option<f64>,
    /// To which side it still turns, of one that does and never was farther than at the end.
    #[serde(skip)]
    pub(crate) tips: Option<Way>,
    /// Of a block that rests, but lies on none of its sides: its angle at the end, rad.
    #[serde(skip)]
    pub(crate) leans_at: Option<f64>,
    /// Of a block that began in flight, turned over and settled: by how much it has turned at the end, rad.
    #[serde(skip)]
    pub(crate) tumbled: Option<f64>,
    /// Of a block that overturned: by how much it has turned at the end, rad, if that is more than to the next side.
    #[serde(skip)]
    pub(crate) turned: Option<f64>,
    /// Of a block that rests: whether what carries it moves at the end.
    #[serde(skip)]
    pub(crate) is_carried: bool,
    /// How it moves at the end, of one that does and has no other fate.
    #[serde(skip)]
    pub(crate) going: Option<Going>,
    /// Of one that is shaken where it stands, or hops there: what it stands on, and in the end on other blocks, in words, if that moves at the end.
    #[serde(skip)]
    pub(crate) on_what_moves: Option<&'static str>,
    /// The beam on which it stood throughout, of one that has only moved with it.
    #[serde(skip)]
    pub(crate) stood_on: Option<String>,
    /// Of a block that left its beam: which.
    #[serde(skip)]
    pub(crate) left_beam: Option<String>,
    /// Of a block that overturned: past which end of the beam that carried it, directly or by others, it has fallen since, and which beam that is.
    #[serde(skip)]
    pub(crate) fell_off: Option<(Way, String)>,
    /// Whether it still touches that.
    #[serde(skip)]
    pub(crate) touches_beam: bool,
    /// To which side its mass centre was past what it stands on from the start, as that of a plank that reaches too far over an edge: nothing of its
    /// own brings it back, however little it has turned.
    #[serde(skip)]
    pub(crate) past_edge: Option<Way>,
    /// Of a block that overturned as one with others, a column: the lowest of them.
    #[serde(skip)]
    pub(crate) overturned_with: Option<String>,
    /// Of a block that turns as one with those below it: the lowest of them, on whose base they rock.
    #[serde(skip)]
    pub(crate) turns_with: Option<String>,
    /// Whether these are a column: one block on the other, none slid.
    #[serde(skip)]
    pub(crate) in_column: bool,
    /// Of the lowest block of a column: its largest φ/α, with the α of all of them together.
    #[serde(rename = "column_phi_over_alpha", skip_serializing_if = "Option::is_none")]
    pub column: Option<f64>,
}

impl BodyVerdict {
    /// Its largest φ/α as it is told: of the lowest block of a column that of all of it; none where nothing of its own brings it back.
    pub(crate) fn share(&self) -> Option<f64> {
        self.column.or(self.max_phi_over_alpha).filter(|_| self.past_edge.is_none())
    }
}

/// What is known of a block so far.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Seen {
    /// The angle that its stance is about, rad; `None` of a block that began in flight and has not settled yet.
    began: Option<f64>,
    /// Of such a block, while nothing but a push could turn it over.
    settling: Option<Settling>,
    /// Its angle at the end of the last step, rad.
    angle: f64,
    /// The same against what carries it ([`Watched::tilt`]), and the slope of the line between its feet on its beam then.
    #[serde(skip)]
    tilt: (f64, Option<f64>),
    /// The largest |φ|/α.
    part: Option<f64>,
    /// How far it has turned at most against what carries it, to the left and to the right, rad.
    turned: [f64; 2],
    /// By how much it was turned against what it is placed on when that was largest, rad.
    joint: f64,
    /// When |φ|/α was last large enough to be called rocking, s.
    rocked: Option<f64>,
    /// Since when it is past a point of no return, s, and to which side.
    beyond: Option<(f64, Way)>,
    /// Whether it has fallen to the next side since.
    fallen: bool,
    /// The column of which it has been a part since the start, or when that passed its point of no return.
    column: Option<Column>,
    /// Of the lowest of a stack.
    lean: Option<Lean>,
    /// Since when it is still, s.
    still: Option<f64>,
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
    /// How it has slid from there.
    slides: Slides,
    /// When, s, and where, m, it last had gone on by more than what is still creeps in the time after which it has stopped.
    went: Option<(f64, f64)>,
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

/// What is known of the blocks so far.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Fates {
    blocks: Vec<Seen>,
    /// What held them at the start.
    joints: Joints,
    /// The time and stop that ended the run.
    stopped: Option<(f64, StopReason)>,
}

/// What of the scene it goes by.
#[derive(Debug)]
pub(crate) struct Watch {
    blocks: Vec<Watched>,
    /// The block that stands on each, if it is the only one.
    above: Vec<Option<usize>>,
    floor: Floor,
    stop: StopScene,
    /// Before it nothing ends the run by rest, s.
    settles_at: f64,
}

/// What of a block it goes by.
#[derive(Debug)]
struct Watched {
    carrier: Carrier,
    outline: Option<Outline>,
    /// Largest distance of a point of it from the mass centre, m.
    reach: f64,
    /// Whether a contact of it has springs.
    on_springs: bool,
    /// Whether it rolls on a round outline.
    is_round: bool,
    /// Its least width, m.
    thickness: f64,
    /// m/s.
    still_speed: f64,
    /// How long it has to be still to rest, s.
    still_time: f64,
    mass: f64,
    inertia: f64,
    gravity: f64,
    /// What it was placed on.
    on: Option<SupportingBody>,
    /// Whether its motion is prescribed: nothing becomes of it.
    driven: bool,
    /// Whether a hump of a beam can touch it between its feet.
    has_face: bool,
    /// The block at the foot of the stack that it is in.
    lowest: usize,
    /// Until when what moves as prescribed below it does so, s; 0 where nothing does.
    driven_until: f64,
    /// Its feet, left and right, in its own frame, m; none without a base.
    feet: Option<[[f64; 2]; 2]>,
}

impl Watch {
    pub(crate) fn of(scene: &Scene, layout: &Layout) -> Self {
        let gravity = scene.gravity[0].hypot(scene.gravity[1]);
        let watched = |(number, block): (usize, &BlockScene)| {
            let of = block.mass_properties().ok();
            let reach = block.radius();
            let (corners, feet) = (block.corners(), block.feet());
            Watched {
                carrier: Carrier::of(scene, layout, number),
                outline: Outline::of(block, scene.gravity),
                reach,
                is_round: corners.len() < 3,
                on_springs: scene.contacts.iter().any(|contact| {
                    let is_of = contact.block == number || contact.other_block() == Some(number);
                    is_of && contact.law.impact.has_duration()
                }),
                thickness: falling::thickness(block),
                still_speed: STILL * (gravity * reach).sqrt(),
                still_time: (reach / gravity).sqrt(),
                mass: of.map_or(0.0, |of| of.mass),
                inertia: of.map_or(0.0, |of| of.inertia),
                gravity,
                on: match block.placement {
                    Placement::On { support, .. } => Some(support),
                    Placement::Free { .. } => None,
                },
                driven: block.motion.is_given(),
                lowest: carrier::lowest_below(scene, number),
                has_face: scene.contacts.iter().any(|contact| contact.block == number && contact.sides),
                driven_until: carrier::driven_below(scene, number).map_or(0.0, |(_, motion)| motion.settles_at()),
                feet: (block.base() > 0.0).then(|| feet.map(|foot| [corners[foot].x, corners[foot].y])),
            }
        };
        let blocks: Vec<Watched> = scene.blocks.iter().enumerate().map(watched).collect();
        Self {
            above: columns::above(blocks.iter().map(|block| block.on)),
            blocks,
            floor: Floor::of(scene, layout),
            stop: scene.time.stop,
            settles_at: scene.settles_at(),
        }
    }

    /// The slope from which φ/α of a block counts, against the level of gravity, rad: that of what carries it; on a beam that of the line between the
    /// feet, also of blocks on others that stand there, as a beam that bends turns what stands on it.
    fn slope(&self, number: usize, layout: &Layout, state: &State) -> f64 {
        let lowest = self.blocks[number].lowest;
        let level = self.blocks[number].outline.as_ref().map_or(0.0, Outline::level);
        let chord = self.blocks[lowest].chord(layout, lowest, state);
        chord.map_or_else(|| self.blocks[number].slope(&state.q), |chord| chord - level)
    }

    /// From which angle on each block rocks, in a word, rad; 0 of one that can't overturn.
    pub(crate) fn least_swings(&self) -> impl Iterator<Item = f64> {
        let stance = |block: &Watched| block.outline.as_ref().and_then(|outline| outline.stance(outline.level()));
        self.blocks
            .iter()
            .map(move |block| stance(block).map_or(0.0, |stance| 0.5 * ROCKED * (stance.left.top - stance.right.top)))
    }

    /// From now on stances are taken from there, and entered.
    pub(crate) fn share(&mut self, stances: &std::sync::Arc<SharedStances>) {
        self.blocks.iter_mut().filter_map(|block| block.outline.as_mut()).for_each(|outline| outline.share(stances));
    }
}

impl Watched {
    /// Between its feet, m; infinite without a base.
    fn base(&self) -> f64 {
        self.feet.map_or(f64::INFINITY, |[left, right]| right[0] - left[0])
    }

    /// The slope of what carries it against the level of gravity, rad.
    fn slope(&self, q: &[f64]) -> f64 {
        self.carrier.slope(q) - self.outline.as_ref().map_or(0.0, Outline::level)
    }

    /// The slope of the beam that carries it between its feet, put flat about the foot on which it is tilted, rad; `None` on anything else.
    fn chord(&self, layout: &Layout, number: usize, state: &State) -> Option<f64> {
        self.carrier.beam()?;
        self.carrier.chord(self.place(layout, number, state)?, 0.5 * self.base(), layout, &state.q)
    }

    /// Its angle against what carries it, from which its rocking counts, rad: on a beam against the line between its feet there, about which it
    /// rocks, however far the beam slopes.
    ///
    /// With it comes the slope of that line, rad, if there is one.
    fn tilt(&self, layout: &Layout, number: usize, state: &State) -> (f64, Option<f64>) {
        let line = self.chord(layout, number, state);
        (layout.tilt(number, &state.q) - line.unwrap_or(0.0), line)
    }

    /// Against what that is, in words; none where it is the horizontal.
    fn against(&self, layout: &Layout, number: usize, q: &[f64]) -> Option<String> {
        let moving = match layout.blocks[number].tilt_reference {
            TiltReference::Moving(slope) | TiltReference::MovingIncline(slope, _) => Some(slope),
            _ => None,
        };
        let below = layout.blocks.iter().find(|block| moving == Some(block.range.start + 2));
        let slopes = || layout.tilt(number, q) != q[layout.blocks[number].range.start + 2];
        below.map(|block| format!("`{}`", block.name)).or_else(|| slopes().then(|| "the ground".to_owned()))
    }

    /// How high its mass centre is over what the scene stands on, m.
    fn height(&self, layout: &Layout, number: usize, state: &State) -> f64 {
        let q = &state.q[layout.blocks[number].range.clone()];
        self.carrier.height([q[0], q[1]], layout, &state.q)
    }

    /// How high its mass centre is over what carries it, m: of what stands on a beam over where its feet, or its middle on a hump, would be.
    fn clearance(&self, layout: &Layout, number: usize, state: &State) -> f64 {
        let q = &state.q[layout.blocks[number].range.clone()];
        let (sin, cos) = q[2].sin_cos();
        let feet = self.feet.map(|feet| feet.map(|[x, y]| q[0] + cos * x - sin * y));
        self.carrier.clearance([q[0], q[1]], feet, self.has_face, layout, &state.q)
    }

    /// Where its base stands along what carries it, m: put flat about the foot on which it is tilted.
    fn place(&self, layout: &Layout, number: usize, state: &State) -> Option<f64> {
        let [left, right] = self.feet?;
        let q = &state.q[layout.blocks[number].range.clone()];
        let ahead = layout.tilt(number, &state.q) >= 0.0;
        let [x, y] = if ahead { left } else { right };
        let (sin, cos) = q[2].sin_cos();
        let half = 0.5 * (right[0] - left[0]);
        let foot = self.carrier.along([q[0] + cos * x - sin * y, q[1] + sin * x + cos * y], layout, &state.q);
        Some(foot + if ahead { half } else { -half })
    }

    /// How fast it moves, its spin as the speed of its farthest point, m/s: relative to what carries it or, if that is less, to what carries that. A
    /// block may be still on a beam that bends slowly, and over one that rings under it by micrometres.
    fn speed(&self, layout: &Layout, number: usize, state: &State) -> f64 {
        let range = layout.blocks[number].range.clone();
        let (q, v) = (&state.q[range.clone()], &state.v[range]);
        let base = self.carrier.base_velocity([q[0], q[1]], layout, state);
        let total = |[vx, vy, spin]: [f64; 3]| vx.hypot(vy) + self.reach * spin.abs();
        let over_base = total([v[0] - base[0], v[1] - base[1], v[2] - base[2]]);
        total(self.velocity(layout, number, state)).min(over_base)
    }

    /// By how much it is turned from lying flat on what carries it, where the block is, rad; 0 of one that has no sides to lie on.
    fn turned(&self, layout: &Layout, number: usize, state: &State) -> f64 {
        let q = &state.q[layout.blocks[number].range.clone()];
        let level = self.carrier.turn([q[0], q[1]], layout, &state.q);
        let level = level - self.outline.as_ref().map_or(0.0, Outline::level);
        let stance = self.outline.as_ref().and_then(|outline| outline.stance(q[2] - level));
        stance.map_or(0.0, |stance| q[2] - level - stance.flat)
    }

    /// Velocity and angular velocity relative to what carries it.
    fn velocity(&self, layout: &Layout, number: usize, state: &State) -> [f64; 3] {
        let range = layout.blocks[number].range.clone();
        let (q, v) = (&state.q[range.clone()], &state.v[range]);
        let carrier = self.carrier.velocity([q[0], q[1]], layout, state);
        [v[0] - carrier[0], v[1] - carrier[1], v[2] - carrier[2]]
    }

    /// The work that takes it from an angle to an edge by a turn about its corner, J.
    fn lift(&self, edge: Edge, angle: f64) -> f64 {
        self.mass * self.gravity * edge.arm * (1.0 - (angle - edge.top).cos())
    }

    /// Whether a block that is past an edge has the energy to come back over it, as it moves now.
    fn comes_back(&self, edge: Edge, way: Way, angle: f64, spin: f64) -> bool {
        let inwards = -way.sign() * spin;
        let energy = 0.5 * (self.inertia + self.mass * edge.arm * edge.arm) * inwards * inwards;
        inwards > 0.0 && energy > self.lift(edge, angle)
    }
}

/// Between which angles each block stands as it is placed, rad; none for one that can't overturn.
pub(crate) fn points_of_no_return(scene: &Scene) -> Vec<Option<[f64; 2]>> {
    let of = |block: &BlockScene| {
        let outline = Outline::of(block, scene.gravity)?;
        let began = match block.placement {
            Placement::On { .. } => outline.level(),
            Placement::Free { angle, .. } => angle,
        };
        Some(outline.stance(began)?.tops())
    };
    scene.blocks.iter().map(of).collect()
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
        let AtStart { standing, touching, past_edge } = standing::at_start(&watch.blocks, layout, model, state)?;
        self.joints = Joints::new(&touching, &watch.blocks, layout, state);
        for (number, ((watched, stands), past_edge)) in watch.blocks.iter().zip(standing).zip(past_edge).enumerate() {
            let angle = state.q[layout.blocks[number].range.start + 2];
            // What was placed on something stands there on its base, however far that slopes or it is tilted: on a slope beyond α it is past the
            // point of no return from the start. Its base is the side below where it is level for gravity, which may lean.
            let level = watched.outline.as_ref().map_or(0.0, Outline::level);
            let about = if watched.on.is_some() { level } else { angle };
            let stood = if stands { watched.place(layout, number, state) } else { None };
            let (began, stands_from) = (stands.then_some(about), stands.then_some(state.t));
            let height = (stands && self.joints.only_by_blocks(number)).then(|| watched.height(layout, number, state));
            self.blocks.push(Seen { began, angle, stands_from, stood, height, past_edge, ..Seen::default() });
        }
        self.look(watch, layout, state.t, state);
        Ok(())
    }

    /// The angle of each block against what carries it at the end of the last step, rad, from which its crossings and peaks count; of one on a beam
    /// with the slope of the line between its feet there.
    pub(crate) fn tilts(&self) -> impl Iterator<Item = (f64, Option<f64>)> {
        self.blocks.iter().map(|seen| seen.tilt)
    }

    /// Takes a step in.
    pub(crate) fn observe(&mut self, watch: &Watch, layout: &Layout, step: &StepReport<'_, 2>, state: &State) {
        self.look(watch, layout, step.t_start, state);
        self.find_struck(watch, layout, step);
        self.touch(watch, layout, step, state.t);
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
            if watched.driven {
                continue;
            }
            let place = &layout.blocks[number];
            let q = &state.q[place.range.clone()];
            let t = state.t;
            if seen.began.is_none() {
                seen.settle(watched, watch.slope(number, layout, state), layout, number, state);
            }
            let stance = seen.stance(watched);
            if seen.began.is_some() {
                seen.stance = KnownStance(Some(stance));
            }
            // Past the end of its beam nothing carries it that it could overturn on.
            let carried = seen.out.is_none() || seen.beyond.is_some();
            if let Some(mut stance) = stance.filter(|_| carried) {
                let slope = watched.slope(&state.q);
                if let Some(part) = stance.part(q[2], watch.slope(number, layout, state)) {
                    if part >= ROCKED {
                        seen.rocked = Some(t);
                    }
                    if seen.part.is_none_or(|most| part > most) {
                        (seen.part, seen.joint) = (Some(part), layout.tilt(number, &state.q).abs());
                    }
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
                    let way_down = lies.map(|lies| way.sign() * (lies + slope - edge.top));
                    seen.fallen |= way_down.is_some_and(|way_down| past(q[2]) >= FALLEN * way_down);
                }
            }
            seen.angle = q[2];
            let [left, right] = &mut seen.turned;
            (*left, *right) = (left.max(seen.tilt.0), right.max(-seen.tilt.0));
            if let Some((from, to)) = seen.stood.zip(watched.place(layout, number, state)) {
                seen.slides.go_to(to - from, SLID * watched.base());
                let creeps = FLAT * watched.still_time * watched.still_speed;
                seen.went = seen.went.filter(|(_, at)| (to - at).abs() < creeps).or(Some((t, to)));
            }
            if let Some(height) = seen.height {
                let drop = height - watched.height(layout, number, state);
                seen.dropped = if drop > watched.thickness { seen.dropped.or(Some(t)) } else { None };
            }
            seen.touched.rise(watched.clearance(layout, number, state));
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
        let is_past = |seen: &Seen| seen.beyond.is_some() || seen.column.is_some_and(|column| column.beyond.is_some());
        let down = |of: (&Seen, &Watched)| is_past(of.0) && (of.0.fallen || rests(of));
        if watch.stop.overturned && free().any(down) {
            return Some(StopReason::Overturned);
        }
        if watch.stop.sunk && free().any(|(seen, _)| seen.sunk.is_some()) {
            return Some(StopReason::Sunk);
        }
        (watch.stop.rest && t > watch.settles_at && free().all(rests)).then_some(StopReason::Rest)
    }

    /// What ended the run before its end, and when, s.
    #[must_use]
    pub fn stopped(&self) -> Option<(f64, StopReason)> {
        self.stopped
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
                seen.verdict(watched, (number, block), layout, state, (rocking.get(number), fell))
            })
        };
        let mut verdict: Vec<BodyVerdict> = self.blocks.iter().zip(&watch.blocks).enumerate().filter_map(of).collect();
        columns::find(&watch.blocks, &self.blocks, scene, layout, state, &mut verdict);
        verdict
    }
}

impl Seen {
    fn verdict(
        &self,
        watched: &Watched,
        (number, block): (usize, &BlockScene),
        layout: &Layout,
        state: &State,
        (rocking, fell): (Option<&RockingMonitor>, Option<f64>),
    ) -> BodyVerdict {
        let rests = Fates::rests(self, watched, state.t);
        let spin = state.v[layout.blocks[number].range.start + 2];
        let overturned = self.beyond.filter(|(_, way)| {
            let comes_back = || {
                let edge = self.stance(watched).map(|stance| stance.edge(*way));
                edge.is_some_and(|edge| watched.comes_back(edge, *way, self.angle, spin))
            };
            self.fallen || rests.is_some() || !comes_back()
        });
        // With its column it overturned before it was past its own point of no return.
        let with_column = self.column.and_then(|column| column.overturned(spin, rests.is_some()));
        let overturned = match (overturned, with_column) {
            (Some((t, way)), Some((with_column, same))) if way == same => Some((t.min(with_column), way)),
            (alone, with_column) => alone.or(with_column),
        };
        let place = watched.place(layout, number, state);
        let slid = self.stood.zip(place).map(|(from, to)| to - from).filter(|_| overturned.is_none() && fell.is_none());
        let least = SLID * watched.base();
        let has_slid = slid.is_some_and(|slid| slid.abs() >= least);
        let to_and_fro = slid.is_some_and(|slid| self.slides.is_to_and_fro(slid));
        // One that has come down on a corner and can't turn over any more rocks, though it hasn't settled yet.
        let settling = self.settling.filter(|settling| state.t - settling.since >= FLAT * watched.still_time);
        let part = self.part.or(settling.map(|settling| settling.part));
        let lately = |last: f64| state.t - last < FLAT * watched.still_time;
        let rocked = match settling {
            Some(settling) if self.part.is_none() => settling.rocked.is_some_and(lately),
            _ => part.is_some_and(|part| part >= ROCKED),
        };
        // What came down and slid off since doesn't rock any more.
        let only_slides = has_slid && self.rocked.is_some_and(|last| !lately(last));
        let peak = rocking.and_then(|monitor| {
            let of_crossings = || monitor.peaks().last().copied();
            let largest = || Some(monitor.extreme()).filter(|peak| peak.phi != 0.0);
            monitor.turned().or_else(of_crossings).or_else(largest)
        });
        // In flight it did not rock.
        let since = self.stands_from.or(settling.map(|settling| settling.since));
        let peak = peak.filter(|peak| since.is_none_or(|since| peak.t >= since));
        let bounces = rests.is_none() && {
            let crossed = rocking.and_then(|monitor| monitor.crossings().last()).map(|crossing| crossing.t);
            self.bounces(watched, layout, number, state, crossed)
        };
        // It has left its beam when that doesn't press on it any more.
        let a_few_steps = 3.5 * state.t / state.step.max(1) as f64;
        let touches_beam = self.pressed.is_some_and(|last| state.t - last < a_few_steps);
        let left =
            self.out.map(|(t, way)| (if touches_beam { t } else { self.pressed.map_or(t, |last| last.max(t)) }, way));
        // On springs a block leans to and fro without rocking.
        let stands_on_both = watched.on_springs
            && watched.feet.is_some()
            && self.lifted.or(self.stands_from).is_some_and(|last| !lately(last));
        let (what, t, way) = match (overturned, left, self.sunk, rests) {
            (Some((t, way)), ..) => (Fate::Overturned, Some(t), Some(way)),
            (None, Some((t, way)), ..) => (Fate::Left, Some(t), Some(way)),
            (None, None, Some(t), _) => (Fate::Sunk, Some(t), None),
            _ if fell.is_some() => (Fate::Fell, fell, None),
            (None, None, None, Some(t)) if has_slid => (Fate::Slid, Some(t), None),
            (None, None, None, Some(t)) => (Fate::Rests, Some(t), None),
            _ if bounces => (Fate::Moves, None, None),
            _ if rocked && !only_slides && !stands_on_both => (Fate::Rocks, peak.map(|peak| peak.t), None),
            _ if has_slid || to_and_fro => (Fate::Slid, None, None),
            _ => (Fate::Moves, None, None),
        };
        let lies_on = rests
            .and(watched.outline.as_ref())
            .and_then(|outline| Side::below(block, outline, self.angle - watched.slope(&state.q)));
        let leans = rests.is_some() && lies_on.is_none() && watched.outline.is_some();
        let tumbled = match block.placement {
            Placement::Free { angle, .. } => self.began.map(|_| self.angle - angle),
            Placement::On { .. } => None,
        };
        let tilt = layout.tilt(number, &state.q);
        let turns_on = |monitor: &&RockingMonitor| {
            let way = Way::of(tilt);
            way.sign() * watched.velocity(layout, number, state)[2] > 0.0 && monitor.extreme().phi.abs() <= tilt.abs()
        };
        // A block that rides on another one that rocks is tilted against it by rounding.
        let began_to_tip = |monitor: &&RockingMonitor| {
            let alpha = self.stance(watched).map_or(0.0, |stance| 0.5 * (stance.left.top - stance.right.top));
            monitor.extreme().phi.abs() >= BEGAN_TO_TIP * alpha
        };
        let not_upright = rocking.filter(|monitor| [Fate::Rocks, Fate::Moves].contains(&what) && monitor.count() == 0);
        let moves = what == Fate::Moves && self.still.is_none();
        let rides = what == Fate::Moves && self.rides(watched, least);
        let going = moves.then(|| self.going(watched, layout, number, state)).flatten();
        let going = going.or(rides.then_some(Going::Rides));
        let going = going.or((moves && stands_on_both && rocked).then_some(Going::Vibrates));
        // By its way along what carries it, as that may move under it. Where that is shaken, it may slide on.
        let stopped = what == Fate::Slid
            && rests.is_none()
            && self.still.is_none()
            && state.t >= watched.driven_until
            && self.went.is_some_and(|(last, _)| !lately(last));
        let turning = not_upright.filter(|_| what == Fate::Rocks || (moves && going.is_none())).filter(turns_on);
        // What stands on a beam that bends slowly turns with it.
        let turns = |_: &&RockingMonitor| what == Fate::Rocks || part.is_some_and(|part| part >= BEGAN_TO_TIP);
        let tips = turning.filter(turns).filter(began_to_tip).map(|_| Way::of(tilt));
        let on_its_way = not_upright.filter(|_| what == Fate::Rocks || tips.is_some()).filter(began_to_tip);
        let trembles = || self.trembles(slid, least).filter(|_| moves && turning.is_none());
        let going = going.or_else(trembles);
        let is_here = matches!(what, Fate::Rests | Fate::Moves) && rests != Some(0.0) && self.stands_from == Some(0.0);
        let beam = |when: bool| watched.carrier.beam().filter(|_| when).map(|beam| layout.beams[beam].name.clone());
        BodyVerdict {
            body: layout.blocks[number].name.clone(),
            what,
            t,
            way,
            fell_at: fell,
            overturned_at: overturned.map(|(t, _)| t),
            rests_from: rests,
            leans_at: leans.then_some(tilt),
            lies_on,
            farthest: slid.and_then(|slid| self.slides.farthest(slid, least)),
            to_and_fro: to_and_fro.then(|| self.slides.reached()),
            is_driven: state.t < watched.driven_until,
            slid,
            stopped,
            speed: (what == Fate::Slid && rests.is_none() && self.still.is_none() && !stopped).then(|| {
                let [vx, vy, _] = watched.velocity(layout, number, state);
                vx.hypot(vy)
            }),
            max_phi_over_alpha: part,
            last_peak: peak.filter(|_| what == Fate::Rocks).map(|peak| peak.phi),
            against: watched.against(layout, number, &state.q),
            still_from: self.still.filter(|_| rests.is_none()),
            stands_from: since,
            turned: self
                .began
                .filter(|_| what == Fate::Overturned)
                .map(|began| (self.angle - if watched.on.is_some() { 0.0 } else { began }).abs())
                .filter(|turn| *turn >= TUMBLED),
            is_carried: rests.is_some() && {
                let q = &state.q[layout.blocks[number].range.clone()];
                let [vx, vy, spin] = watched.carrier.base_velocity([q[0], q[1]], layout, state);
                state.t < watched.driven_until || vx.hypot(vy) + watched.reach * spin.abs() > watched.still_speed
            },
            tumbled: tumbled.filter(|turn| turn.abs() >= TUMBLED && what != Fate::Overturned),
            on_its_way: on_its_way.map(|_| tilt),
            on_what_moves: watched.carrier.word().filter(|_| {
                let q = &state.q[layout.blocks[number].range.clone()];
                let [vx, vy, _] = watched.carrier.velocity([q[0], q[1]], layout, state);
                let moves = state.t < watched.driven_until || vx.hypot(vy) > watched.still_speed;
                // What rides on a driven block is told to stand on it.
                let is_told = going == Some(Going::Rides) && watched.carrier.is_by_block();
                (stopped || going.is_some_and(Going::stays)) && moves && !is_told
            }),
            going,
            tips,
            stood_on: beam(is_here && self.never_moved(watched, least)),
            left_beam: beam(what == Fate::Left),
            fell_off: (what == Fate::Overturned)
                .then(|| {
                    let q = &state.q[layout.blocks[number].range.clone()];
                    watched.carrier.below_an_end([q[0], q[1]], watched.reach, layout, &state.q)
                })
                .flatten()
                .map(|(way, beam)| (way, layout.beams[beam].name.clone())),
            touches_beam: what == Fate::Left && touches_beam,
            past_edge: self.past_edge,
            overturned_with: None,
            turns_with: None,
            in_column: false,
            column: None,
        }
    }
}
