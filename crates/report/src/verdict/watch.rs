//! What of the scene and its blocks the verdict goes by: their shapes, what carries them, and how they stand and move on it (`docs/verdict.md`).

use super::carrier::{self, Carrier};
use super::floor::Floor;
use super::stance::{Edge, Outline, SharedStances, Way};
use super::{ROCKED, STILL, columns, falling};
use teeter_integrator::State;
use teeter_scenario::TiltReference;
use teeter_scenario::scene::{BlockScene, Placement, Scene, StopScene, SupportingBody};
use teeter_scenario::simulation::Layout;

/// What of the scene it goes by.
#[derive(Debug)]
pub(crate) struct Watch {
    pub(super) blocks: Vec<Watched>,
    /// The block that stands on each, if it is the only one.
    pub(super) above: Vec<Option<usize>>,
    pub(super) floor: Floor,
    pub(super) stop: StopScene,
    /// Before it nothing ends the run by rest, s: prescribed motion goes on, or forces or loads change.
    pub(super) settles_at: f64,
}

/// What of a block it goes by.
#[derive(Debug)]
pub(super) struct Watched {
    pub(super) carrier: Carrier,
    pub(super) outline: Option<Outline>,
    /// Largest distance of a point of it from the mass centre, m.
    pub(super) reach: f64,
    /// Whether a contact of it has springs.
    pub(super) on_springs: bool,
    /// Whether it rolls on a round outline.
    pub(super) is_round: bool,
    /// Its least width, m.
    pub(super) thickness: f64,
    /// m/s.
    pub(super) still_speed: f64,
    /// How long it has to be still to rest, s.
    pub(super) still_time: f64,
    pub(super) mass: f64,
    pub(super) inertia: f64,
    pub(super) gravity: f64,
    /// Against gravity; the y axis without.
    pub(super) up: [f64; 2],
    /// What it was placed on.
    pub(super) on: Option<SupportingBody>,
    /// Whether its motion is prescribed, in part at least: nothing becomes of it.
    pub(super) driven: bool,
    /// Whether all of its motion is.
    pub(super) held: bool,
    /// Whether a hump of a beam can touch it between its feet.
    pub(super) has_face: bool,
    /// The block at the foot of the stack that it is in.
    pub(super) lowest: usize,
    /// Until when what moves as prescribed below it does so, s; 0 where nothing does.
    pub(super) driven_until: f64,
    /// Its feet, left and right, in its own frame, m; none without a base.
    pub(super) feet: Option<[[f64; 2]; 2]>,
}

/// The angle of a block against what carries it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Tilt {
    /// That from which its crossings and peaks count, rad.
    pub(crate) carrier: f64,
    /// The slope of the line between its feet on its beam, rad, if it stands on one.
    pub(crate) line: Option<f64>,
}

impl Tilt {
    /// The angle from which its rocking counts, rad: on a beam against the line between its feet there, about which it rocks, however far the beam
    /// slopes.
    pub(crate) fn rocking(self) -> f64 {
        self.carrier - self.line.unwrap_or(0.0)
    }
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
                up: if gravity > 0.0 { scene.gravity.map(|along| -along / gravity) } else { [0.0, 1.0] },
                on: match block.placement {
                    Placement::On { support, .. } => Some(support),
                    Placement::Free { .. } => None,
                },
                driven: block.motion.is_given(),
                held: block.motion.is_whole(),
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
    pub(super) fn slope(&self, number: usize, layout: &Layout, state: &State) -> f64 {
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
    pub(super) fn base(&self) -> f64 {
        self.feet.map_or(f64::INFINITY, |[left, right]| right[0] - left[0])
    }

    /// The slope of the ground that carries it, directly or by others, where it is, against the level of gravity, rad.
    pub(super) fn slope(&self, q: &[f64]) -> f64 {
        self.carrier.slope(q) - self.outline.as_ref().map_or(0.0, Outline::level)
    }

    /// Its angle against what carries it, from which its crossings and peaks count, rad: on ground with a profile against its slope where the block
    /// is, on a beam against its undeformed axis.
    pub(super) fn against_carrier(&self, layout: &Layout, number: usize, q: &[f64]) -> f64 {
        let phi = q[layout.blocks[number].range.start + 2];
        if self.carrier.is_terrain() { phi - self.carrier.slope(q) } else { layout.tilt(number, q) }
    }

    /// The slope of the beam that carries it between its feet, put flat about the foot on which it is tilted, rad; `None` on anything else.
    pub(super) fn chord(&self, layout: &Layout, number: usize, state: &State) -> Option<f64> {
        self.carrier.beam()?;
        self.carrier.chord(self.place(layout, number, state)?, 0.5 * self.base(), layout, &state.q)
    }

    /// Its angle against what carries it.
    pub(super) fn tilt(&self, layout: &Layout, number: usize, state: &State) -> Tilt {
        Tilt { carrier: self.against_carrier(layout, number, &state.q), line: self.chord(layout, number, state) }
    }

    /// Against what that is, in words; none where it is the horizontal.
    pub(super) fn against(&self, layout: &Layout, number: usize, q: &[f64]) -> Option<String> {
        let moving = match layout.blocks[number].tilt_reference {
            TiltReference::Moving(slope) | TiltReference::MovingIncline(slope, _) => Some(slope),
            _ => None,
        };
        let below = layout.blocks.iter().find(|block| moving == Some(block.range.start + 2));
        let slopes = || self.against_carrier(layout, number, q) != q[layout.blocks[number].range.start + 2];
        below.map(|block| format!("`{}`", block.name)).or_else(|| slopes().then(|| "the ground".to_owned()))
    }

    /// How high its mass centre is over what the scene stands on, m.
    pub(super) fn height(&self, layout: &Layout, number: usize, state: &State) -> f64 {
        let q = &state.q[layout.blocks[number].range.clone()];
        self.carrier.height([q[0], q[1]], layout, &state.q)
    }

    /// Where its feet are, x, m, at its own coordinates.
    fn feet_at(&self, q: &[f64]) -> Option<[f64; 2]> {
        let (sin, cos) = q[2].sin_cos();
        self.feet.map(|feet| feet.map(|[x, y]| q[0] + cos * x - sin * y))
    }

    /// How high its mass centre is over what carries it, m: of what stands on a beam over where its feet, or its middle on a hump, would be.
    pub(super) fn clearance(&self, layout: &Layout, number: usize, state: &State) -> f64 {
        let q = &state.q[layout.blocks[number].range.clone()];
        self.carrier.clearance([q[0], q[1]], self.feet_at(q), self.has_face, layout, &state.q)
    }

    /// Where its mass centre is along what carries it, m.
    pub(super) fn centre(&self, layout: &Layout, number: usize, state: &State) -> f64 {
        let q = &state.q[layout.blocks[number].range.clone()];
        self.carrier.along([q[0], q[1]], layout, &state.q)
    }

    /// Where the middle of its base stands along what carries it, m: put flat about the foot on which it is tilted.
    pub(super) fn place(&self, layout: &Layout, number: usize, state: &State) -> Option<f64> {
        let [left, right] = self.feet?;
        let q = &state.q[layout.blocks[number].range.clone()];
        // However often it has turned round.
        let ahead = self.against_carrier(layout, number, &state.q).sin() >= 0.0;
        let [x, y] = if ahead { left } else { right };
        let (sin, cos) = q[2].sin_cos();
        let half = 0.5 * (right[0] - left[0]);
        let half = if ahead { half } else { -half };
        let foot = [q[0] + cos * x - sin * y, q[1] + sin * x + cos * y];
        if self.carrier.is_terrain() {
            // Of a base over a crest or a valley, one foot isn't as far from the middle along the surface as the other one.
            let (sin, cos) = self.carrier.slope(&state.q).sin_cos();
            return Some(self.carrier.along([foot[0] + half * cos, foot[1] + half * sin], layout, &state.q));
        }
        Some(self.carrier.along(foot, layout, &state.q) + half)
    }

    /// How fast it moves: relative to what carries it or, if that is less, to what carries that. A block may be still on a beam that bends, and over
    /// one that rings under it by micrometres.
    pub(super) fn speed(&self, layout: &Layout, number: usize, state: &State) -> f64 {
        self.total(self.velocity(layout, number, state)).min(self.speed_over_base(layout, number, state))
    }

    /// A velocity with a spin, which counts as the speed of its farthest point, m/s.
    fn total(&self, [vx, vy, spin]: [f64; 3]) -> f64 {
        vx.hypot(vy) + self.reach * spin.abs()
    }

    /// How fast it moves relative to the supports of the beam that carries it, or to what else does, m/s.
    pub(super) fn speed_over_base(&self, layout: &Layout, number: usize, state: &State) -> f64 {
        let range = layout.blocks[number].range.clone();
        let (q, v) = (&state.q[range.clone()], &state.v[range]);
        let base = self.carrier.base_velocity([q[0], q[1]], layout, state);
        self.total([v[0] - base[0], v[1] - base[1], v[2] - base[2]])
    }

    /// The slope of what carries it directly, where it is, against the level of gravity, rad.
    pub(super) fn turn(&self, layout: &Layout, number: usize, state: &State) -> f64 {
        let q = &state.q[layout.blocks[number].range.clone()];
        self.carrier.turn([q[0], q[1]], layout, &state.q) - self.outline.as_ref().map_or(0.0, Outline::level)
    }

    /// By how much it is turned from lying flat on what carries it, where the block is, rad; 0 of one that has no sides to lie on.
    pub(super) fn turned(&self, layout: &Layout, number: usize, state: &State) -> f64 {
        let q = &state.q[layout.blocks[number].range.clone()];
        let level = self.turn(layout, number, state);
        let stance = self.outline.as_ref().and_then(|outline| outline.stance(q[2] - level));
        stance.map_or(0.0, |stance| q[2] - level - stance.flat)
    }

    /// Velocity and angular velocity relative to what carries it.
    pub(super) fn velocity(&self, layout: &Layout, number: usize, state: &State) -> [f64; 3] {
        let range = layout.blocks[number].range.clone();
        let (q, v) = (&state.q[range.clone()], &state.v[range]);
        // On another side than its base it doesn't stand on its feet, and on another block not on the beam.
        let on_its_feet = |[left, right]: &[f64; 2]| self.carrier.beam().is_some() && right - left > 0.5 * self.base();
        let feet = self.feet_at(q).filter(on_its_feet);
        let carrier = self.carrier.velocity([q[0], q[1]], feet, layout, state);
        [v[0] - carrier[0], v[1] - carrier[1], v[2] - carrier[2]]
    }

    /// The work that takes it from an angle to an edge by a turn about its corner, J.
    pub(super) fn lift(&self, edge: Edge, angle: f64) -> f64 {
        self.mass * self.gravity * edge.arm * (1.0 - (angle - edge.top).cos())
    }

    /// Whether a block that is past an edge has the energy to come back over it, as it moves now.
    pub(super) fn comes_back(&self, edge: Edge, way: Way, angle: f64, spin: f64) -> bool {
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
