//! What carries a block: how it moves under the block, where along it the block is, whether the block is still over it.

use super::Way;
use super::terrain::Terrain;
use std::ops::Range;
use teeter_integrator::State;
use teeter_scenario::scene::{MotionScene, Placement, Scene, SupportingBody};
use teeter_scenario::simulation::{BeamPlace, Layout};

/// Ground steeper than this is a wall, rad.
const WALL: f64 = std::f64::consts::FRAC_PI_4;

/// Beams whose heights differ by less than this part of a block's size continue each other.
const LEVEL: f64 = 0.01;

/// What carries a block.
#[derive(Debug)]
pub(super) struct Carrier {
    /// What it stands on, or is joined to by its contacts.
    on: On,
    /// What that stands on, and so on down to what no block carries or whose motion is prescribed: what moves under the block.
    root: On,
    /// The slope of fixed ground, or of a profile under the block at the start relative to moving ground, rad.
    incline: f64,
    /// The slope of fixed ground that carries the block, directly or by others, as `incline` is of what carries it directly.
    foot: f64,
    /// Whether it is other blocks that carry it.
    upper: bool,
    /// The ground, if it carries the block, directly or by others, and has a profile.
    terrain: Option<Terrain>,
    /// Other beams that continue the one it stands on, by their numbers, and where their left ends are while their supports don't move, m.
    beside: Vec<(usize, [f64; 2])>,
    /// The slope of the scene's ground while it doesn't move, rad; `None` without ground.
    ground: Option<f64>,
}

#[derive(Clone, Debug, PartialEq)]
enum On {
    /// Nothing, or fixed ground.
    Fixed,
    /// Moving ground, by the indices of its coordinates.
    Ground(Range<usize>),
    /// A beam, by its number, and where its left end is while its supports don't move, m.
    Beam(usize, [f64; 2]),
    /// A block, by the indices of its coordinates.
    Block(Range<usize>),
}

/// What moves as prescribed below a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Driven {
    Ground,
    Supports,
    Block,
}

/// What a block is placed on, or what is below it.
fn support(scene: &Scene, block: usize) -> Option<SupportingBody> {
    match scene.blocks[block].placement {
        Placement::On { support, .. } => Some(support),
        Placement::Free { .. } => under(scene, block),
    }
}

/// That which moves so, if it does: the motion of what is fixed is zero.
fn moving(driven: Driven, motion: &MotionScene) -> Option<(Driven, &MotionScene)> {
    motion.0.iter().flatten().any(|axis| axis.amplitude != 0.0).then_some((driven, motion))
}

/// What moves as prescribed below a block, directly or below other blocks, and how; `None` where nothing does.
pub(super) fn driven_below(scene: &Scene, number: usize) -> Option<(Driven, &MotionScene)> {
    let ground = || scene.ground.as_ref().and_then(|ground| moving(Driven::Ground, &ground.motion));
    let mut block = number;
    // At most as many storeys as there are blocks.
    for _ in 0..scene.blocks.len() {
        match support(scene, block) {
            Some(SupportingBody::Block(below)) => {
                let motion = &scene.blocks[below].motion;
                if motion.is_given() {
                    return moving(Driven::Block, motion);
                }
                block = below;
            }
            Some(SupportingBody::Beam(beam)) => {
                return moving(Driven::Supports, &scene.beams[beam].motion);
            }
            Some(SupportingBody::Ground) => return ground(),
            // In a crowd, or alone.
            None => return if scene.beams.is_empty() { ground() } else { None },
        }
    }
    None
}

/// The block at the foot of a stack, on which a block stands, directly or by others; itself if it stands on no other block.
pub(super) fn lowest_below(scene: &Scene, number: usize) -> usize {
    let mut block = number;
    // Only beams ask for it; at most as many storeys as there are blocks.
    let storeys = if scene.beams.is_empty() { 0 } else { scene.blocks.len() };
    for _ in 0..storeys {
        match support(scene, block) {
            Some(SupportingBody::Block(below)) if !scene.blocks[below].motion.is_given() => block = below,
            _ => break,
        }
    }
    block
}

impl Carrier {
    pub(super) fn of(scene: &Scene, layout: &Layout, number: usize) -> Self {
        let support = |block: usize| support(scene, block);
        let of = |support: Option<SupportingBody>| match support {
            Some(SupportingBody::Beam(beam)) => On::Beam(beam, scene.beams[beam].position),
            Some(SupportingBody::Block(block)) => On::Block(layout.blocks[block].range.clone()),
            Some(SupportingBody::Ground) => layout.ground.clone().map_or(On::Fixed, On::Ground),
            // In a crowd, or alone: moving ground moves all.
            None => layout.ground.clone().map_or(On::Fixed, On::Ground),
        };
        let (mut root, mut lowest) = (support(number), number);
        let free = |of: Option<SupportingBody>| match of {
            Some(SupportingBody::Block(below)) if !scene.blocks[below].motion.is_given() => Some(below),
            _ => None,
        };
        // At most as many storeys as there are blocks.
        for _ in 0..scene.blocks.len() {
            let Some(below) = free(root) else { break };
            (root, lowest) = (support(below), below);
        }
        if free(root).is_some() {
            root = None;
        }
        // The tilt is measured from what carries the block: the rest of the angle is its slope.
        let on_ground = matches!(root, Some(SupportingBody::Ground));
        let foot = if on_ground {
            let own = layout.blocks[lowest].range.end;
            let q = vec![0.0; layout.ground.as_ref().map_or(own, |ground| own.max(ground.end))];
            -layout.tilt(lowest, &q)
        } else {
            0.0
        };
        let incline = if lowest == number { foot } else { 0.0 };
        let beside = match support(number) {
            Some(SupportingBody::Beam(beam)) => continued(scene, number, beam),
            _ => Vec::new(),
        };
        let ground = scene.ground.as_ref().map(|ground| ground.incline);
        let terrain = if on_ground { Terrain::of(scene, layout, lowest) } else { None };
        Self {
            on: of(support(number)),
            root: of(root),
            incline,
            foot,
            upper: lowest != number,
            terrain,
            beside,
            ground,
        }
    }

    /// The slope of the ground that carries the block, directly or by others, where it or the lowest of these is, rad; 0 of other carriers.
    pub(super) fn slope(&self, q: &[f64]) -> f64 {
        let root = match &self.root {
            On::Ground(range) => q[range.start + 2] + self.foot,
            On::Fixed => self.foot,
            On::Beam(..) | On::Block(_) => 0.0,
        };
        let there = self.terrain.as_ref().and_then(|terrain| terrain.slope(q));
        let slope = there.unwrap_or(root);
        // A block may lean against a wall, but what is in a pile beside it stands on others.
        if (self.upper || there.is_some()) && slope.abs() > WALL { 0.0 } else { slope }
    }

    /// The slope of what carries the block, where the block is, rad.
    pub(super) fn turn(&self, at: [f64; 2], layout: &Layout, q: &[f64]) -> f64 {
        match &self.on {
            On::Beam(beam, position) => {
                let place = &layout.beams[*beam];
                let [x, _] = beam_origin(*beam, *position, layout, q);
                place.deflection(&place.beam.shape_clamped(at[0] - x), &q[place.range.clone()]).slope
            }
            On::Block(range) => q[range.start + 2],
            On::Ground(_) | On::Fixed => self.slope(q),
        }
    }

    /// The slope of the line between two places on the beam that carries the block, at `x` ∓ `half` (m, along it), rad; past an end the beam goes on
    /// straight. `None` on other carriers.
    pub(super) fn chord(&self, x: f64, half: f64, layout: &Layout, q: &[f64]) -> Option<f64> {
        let On::Beam(beam, _) = &self.on else { return None };
        let place = &layout.beams[*beam];
        let height = |x: f64| bent(place, x, q);
        Some((height(x + half) - height(x - half)).atan2(2.0 * half))
    }

    /// The beam that carries the block, by its number.
    pub(super) fn beam(&self) -> Option<usize> {
        if let On::Beam(beam, _) = self.on { Some(beam) } else { None }
    }

    /// What the velocity is of, in words; `None` of what doesn't move.
    pub(super) fn word(&self) -> Option<&'static str> {
        match self.root {
            On::Ground(_) => Some("ground"),
            On::Beam(..) => Some("a beam"),
            On::Block(_) => Some("a block"),
            On::Fixed => None,
        }
    }

    /// Whether that is a block.
    pub(super) fn is_by_block(&self) -> bool {
        matches!(self.root, On::Block(_))
    }

    /// Velocity and angular velocity of what carries a block, where the block is. A beam has those of the line between the `feet` (x, m) on which
    /// the block stands, as of a rigid body that reaches there: what stands still on it has these; without feet, those of the beam itself.
    pub(super) fn velocity(&self, at: [f64; 2], feet: Option<[f64; 2]>, layout: &Layout, state: &State) -> [f64; 3] {
        match &self.root {
            On::Ground(range) | On::Block(range) => {
                let (q, v) = (&state.q[range.clone()], &state.v[range.clone()]);
                [v[0] - v[2] * (at[1] - q[1]), v[1] + v[2] * (at[0] - q[0]), v[2]]
            }
            On::Beam(beam, position) => {
                let place = &layout.beams[*beam];
                let [x, y] = beam_origin(*beam, *position, layout, &state.q);
                let [vx, vy] = beam_moved(place, &state.v);
                let Some([left, right]) = feet else {
                    let rate = place.deflection(&place.beam.shape_clamped(at[0] - x), &state.v[place.range.clone()]);
                    return [vx, vy + bent(place, at[0] - x, &state.v), rate.slope];
                };
                let [from, to] = [left, right].map(|foot| bent(place, foot - x, &state.v));
                let spin = (to - from) / (right - left);
                let height = at[1] - y - bent(place, at[0] - x, &state.q);
                [vx - spin * height, vy + from + spin * (at[0] - left), spin]
            }
            On::Fixed => [0.0; 3],
        }
    }

    /// Velocity of what carries that: of a beam's supports, which move while it rings.
    pub(super) fn base_velocity(&self, at: [f64; 2], layout: &Layout, state: &State) -> [f64; 3] {
        match &self.root {
            On::Beam(beam, _) => layout.beams[*beam]
                .supports
                .clone()
                .map_or([0.0; 3], |range| [state.v[range.start], state.v[range.start + 1], 0.0]),
            On::Ground(_) | On::Fixed | On::Block(_) => self.velocity(at, None, layout, state),
        }
    }

    /// The ground, if it has a profile and the block stands on it.
    fn own_terrain(&self) -> Option<&Terrain> {
        self.terrain.as_ref().filter(|_| !matches!(self.on, On::Block(_)))
    }

    /// Whether the block stands on ground with a profile.
    pub(super) fn is_terrain(&self) -> bool {
        self.own_terrain().is_some()
    }

    /// Where a point is along what carries the block, m; on a profile along its surface.
    pub(super) fn along(&self, at: [f64; 2], layout: &Layout, q: &[f64]) -> f64 {
        if let Some(terrain) = self.own_terrain() {
            return terrain.along(at, q);
        }
        let (origin, slope) = match &self.on {
            On::Ground(range) | On::Block(range) => ([q[range.start], q[range.start + 1]], q[range.start + 2]),
            On::Beam(beam, position) => (beam_origin(*beam, *position, layout, q), 0.0),
            On::Fixed => ([0.0; 2], 0.0),
        };
        let (sin, cos) = (slope + self.incline).sin_cos();
        cos * (at[0] - origin[0]) + sin * (at[1] - origin[1])
    }

    /// Past which end of its beam, and off those that continue it, a point is; `None` for a block that no beam carries.
    pub(super) fn past_end(&self, at: [f64; 2], layout: &Layout, q: &[f64]) -> Option<Option<Way>> {
        let On::Beam(beam, position) = self.on else { return None };
        let past = |beam: usize, position: [f64; 2]| {
            let x = at[0] - beam_origin(beam, position, layout, q)[0];
            match x {
                x if x < 0.0 => Some(Way::Left),
                x if x > layout.beams[beam].beam.spec().span => Some(Way::Right),
                _ => None,
            }
        };
        let is_on_another = || self.beside.iter().any(|(beam, position)| past(*beam, *position).is_none());
        Some(past(beam, position).filter(|_| !is_on_another()))
    }

    /// Past which end of the beam that carries the block, directly or by others, a point is that is lower than all of the beam by more than `reach` (m),
    /// and the number of that beam.
    pub(super) fn below_an_end(&self, at: [f64; 2], reach: f64, layout: &Layout, q: &[f64]) -> Option<(Way, usize)> {
        let On::Beam(beam, position) = self.root else { return None };
        let place = &layout.beams[beam];
        let span = place.beam.spec().span;
        let [x, y] = beam_origin(beam, position, layout, q);
        let end = |x: f64| place.deflection(&place.beam.shape_clamped(x), &q[place.range.clone()]).w;
        let is_below = at[1] < y + end(0.0).min(end(span)) - reach;
        let way = match at[0] - x {
            x if x < 0.0 => Way::Left,
            x if x > span => Way::Right,
            _ => return None,
        };
        is_below.then_some((way, beam))
    }

    /// How high a point is: over the supports of the beam, or over the driven block, that carries the block, or over the ground, or by its y, m.
    pub(super) fn height(&self, at: [f64; 2], layout: &Layout, q: &[f64]) -> f64 {
        match (&self.root, self.ground) {
            (On::Beam(beam, position), _) => at[1] - beam_origin(*beam, *position, layout, q)[1],
            (On::Block(range), _) => at[1] - q[range.start + 1],
            (_, Some(slope)) => over_ground(at, slope, layout, q),
            _ => at[1],
        }
    }

    /// How high a point of a block is over what carries it, by what height is over where that bends: under its `feet` (x, m) or, if a
    /// hump can touch it, in the middle, whichever is higher; m.
    pub(super) fn clearance(
        &self,
        at: [f64; 2],
        feet: Option<[f64; 2]>,
        has_face: bool,
        layout: &Layout,
        q: &[f64],
    ) -> f64 {
        let height = self.height(at, layout, q);
        let On::Beam(beam, position) = &self.root else { return height };
        let place = &layout.beams[*beam];
        let origin = beam_origin(*beam, *position, layout, q)[0];
        let bent = |x: f64| bent(place, x - origin, q);
        height
            - match feet.map(|[left, right]| 0.5 * (bent(left) + bent(right))) {
                Some(feet) if has_face => feet.max(bent(at[0])),
                Some(feet) => feet,
                None => bent(at[0]),
            }
    }
}

/// The deflection of a beam at x (m, along it) for coordinates of the model, or its rate for velocities: past an end the beam goes on straight.
fn bent(place: &BeamPlace, x: f64, values: &[f64]) -> f64 {
    let on = x.clamp(0.0, place.beam.spec().span);
    let bent = place.deflection(&place.beam.shape_clamped(on), &values[place.range.clone()]);
    bent.w + bent.slope * (x - on)
}

/// How high a point is over the origin of the ground, across its slope (rad, while it doesn't move), m.
pub(super) fn over_ground(at: [f64; 2], slope: f64, layout: &Layout, q: &[f64]) -> f64 {
    let still = ([0.0; 2], slope);
    let ground = layout.ground.as_ref();
    let (origin, slope) = ground.map_or(still, |range| ([q[range.start], q[range.start + 1]], q[range.start + 2]));
    let (sin, cos) = slope.sin_cos();
    cos * (at[1] - origin[1]) - sin * (at[0] - origin[0])
}

/// What a block that isn't placed on anything can touch: the block below it that it is most nearly above, or else the ground or beam of its first
/// contact with one.
fn under(scene: &Scene, block: usize) -> Option<SupportingBody> {
    let ([x, y], lowest) = (centre(scene, block)?, lowest(scene, block)?);
    let reach = scene.blocks[block].radius();
    let touched = scene.contacts.iter().filter_map(|contact| match contact.surface {
        SupportingBody::Block(other) if contact.block == block => Some(other),
        SupportingBody::Block(other) if other == block => Some(contact.block),
        _ => None,
    });
    // Beside each other two blocks have their centres at much the same height, or stand on the same.
    let below = touched.filter_map(|other| {
        let ([a, b], bottom) = (centre(scene, other)?, self::lowest(scene, other)?);
        let (across, down) = ((a - x).abs(), y - b);
        let is_under = down > 0.25 * reach && bottom < lowest - LEVEL * reach;
        (is_under && across < reach + scene.blocks[other].radius()).then_some((across.hypot(down), other))
    });
    let nearest = below.min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.map(|(_, other)| SupportingBody::Block(other)).or_else(|| scene.first_touched(block))
}

/// About where a block begins: one on level ground at half its height; `None` on anything else.
fn centre(scene: &Scene, block: usize) -> Option<[f64; 2]> {
    match scene.blocks[block].placement {
        Placement::Free { position, .. } => Some(position),
        Placement::On { support: SupportingBody::Ground, at, .. } => Some([at, 0.5 * scene.blocks[block].height]),
        Placement::On { .. } => None,
    }
}

/// About how high its lowest point is then, m.
fn lowest(scene: &Scene, number: usize) -> Option<f64> {
    let block = &scene.blocks[number];
    let Placement::Free { position, angle, .. } = block.placement else {
        return Some(centre(scene, number)?[1] - 0.5 * block.height);
    };
    let (sin, cos) = angle.sin_cos();
    let corners = block.corners();
    let down = |number: usize| block.corner_radius(number) - sin * corners[number].x - cos * corners[number].y;
    Some(position[1] - (0..corners.len()).map(down).fold(f64::NEG_INFINITY, f64::max))
}

/// The beams that a block can touch and that lie level with the one it stands on at the start: it may slide on to them.
fn continued(scene: &Scene, block: usize, beam: usize) -> Vec<(usize, [f64; 2])> {
    let level = LEVEL * scene.blocks[block].radius();
    let height = |beam: usize| scene.beams[beam].start_position()[1];
    let others = scene.contacts.iter().filter(|contact| contact.block == block);
    let others = others.filter_map(|contact| match contact.surface {
        SupportingBody::Beam(other) if other != beam => Some((other, scene.beams[other].position)),
        _ => None,
    });
    others.filter(|(other, _)| (height(*other) - height(beam)).abs() <= level).collect()
}

/// How far a beam's left end is displaced, with its supports and along its axis, m; for velocities how fast.
fn beam_moved(place: &BeamPlace, q: &[f64]) -> [f64; 2] {
    let [x, y] = place.support_displacement(q);
    [x + place.axial_displacement_at(&q[place.range.clone()], 0.0), y]
}

/// The left end of a beam's axis where it is now, m.
pub(super) fn beam_origin(beam: usize, [x, y]: [f64; 2], layout: &Layout, q: &[f64]) -> [f64; 2] {
    let [across, up] = beam_moved(&layout.beams[beam], q);
    [x + across, y + up]
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_scenario::simulation::Simulation;

    /// A block over the right end of a cantilever, whose right foot is past it.
    #[test]
    fn past_an_end_of_a_beam_velocity_is_the_rate_of_place() {
        let text = "[time]\nend = '1 s'\nstep = '1 ms'\n[material.a]\ndensity = '2700 kg/m^3'\nyoungs_modulus = '69 GPa'\n[beam.t]\n\
            material = 'a'\nspan = '50 cm'\nwidth = '3 cm'\nthickness = '5 mm'\nelements = 4\nsupports = ['clamped', 'free']\n[block.b]\n\
            material = 'a'\nwidth = '6 cm'\nheight = '9 cm'\ndepth = '3 cm'\non = 't'\nat = '49 cm'\n[contact.c]\nbetween = ['b', 't']\n\
            friction = 0.5\npoints = 'all'\n";
        let scene = teeter_scenario::load(text.as_bytes(), "f", "f", &[]).unwrap().scene;
        let Simulation { layout, mut state, .. } = Simulation::new(&scene).unwrap();
        let carrier = Carrier::of(&scene, &layout, 0);
        for (k, v) in state.v[layout.beams[0].range.clone()].iter_mut().enumerate() {
            *v = 1e-3 * (1.0 + k as f64).sin();
        }
        let (h, feet) = (1e-3, [0.46, 0.52]);
        let moved = |by: f64| -> Vec<f64> { state.q.iter().zip(&state.v).map(|(q, v)| q + by * v).collect() };
        let rate = |of: &dyn Fn(&[f64]) -> f64| (of(&moved(h)) - of(&moved(-h))) / (2.0 * h);
        let [_, _, spin] = carrier.velocity([0.49, 0.045], Some(feet), &layout, &state);
        let chord = rate(&|q| carrier.chord(0.49, 0.03, &layout, q).unwrap());
        assert!((spin / chord - 1.0).abs() < 1e-6 && spin.abs() > 1e-3, "{spin} {chord}");
        // A disc past the end, over the straight line that goes on from there.
        let [_, vy, _] = carrier.velocity([0.52, 0.045], None, &layout, &state);
        let height = rate(&|q| -carrier.clearance([0.52, 0.045], None, false, &layout, q));
        assert!((vy / height - 1.0).abs() < 1e-6, "{vy} {height}");
    }
}
