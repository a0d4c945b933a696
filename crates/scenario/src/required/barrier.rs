//! Blocks that haven't the energy to tip over: their upper corners never touch.
//!
//! A block tilted by its critical angle α stands on its diagonal: its mass centre is R over the
//! corner below it, however it came there. If the energy of the whole model is too little for that,
//! no block is ever tilted by more than an angle short of α, and its upper corners stay clear of
//! what it stands on.

use super::beam_bounds::BeamBounds;
use super::reach::{By, ROUNDING, Reach};
use super::{Limits, Pairs, Removed, Start};
use crate::scene::{ContactScene, Support};
use teeter_beam::{Axial, Beam, MatrixWeights};
use teeter_integrator::ImpactLaw;

/// The proof that no block tips over, with its numbers.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Barrier {
    pub(super) limits: Limits,
    /// Energy at the start, J.
    energy: f64,
    blocks: Vec<Well>,
    /// Of each beam that is stood on, its largest deflection, m, to where a step looks ahead.
    deflections: Vec<Option<f64>>,
    /// No slope of any of them is above it.
    steepest: f64,
}

/// A block that doesn't tip over.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Well {
    /// Energy with which some motion of the model could bring it to its critical angle, J.
    barrier: f64,
    /// The largest angle that it has the energy for, rad.
    angle: f64,
    critical_angle: f64,
    /// Fastest that its mass centre can be, m/s.
    speed: f64,
    /// How far one of its corners can come within a step and the look ahead, m.
    ahead: f64,
    /// Half its diagonal, m.
    radius: f64,
    /// Least height of its upper corners over its lower ones, m.
    upper: f64,
    /// Its corners never below, m.
    low: f64,
}

/// A beam must be worth the search: it takes some `elements²` operations, and a step hardly notices
/// two points on a long beam.
const MOST_ELEMENTS: usize = 200;

/// Steps for each element from which on the search is worth its time.
const STEPS_AN_ELEMENT: u64 = 100;

/// The scheme of the page can make energy, and contacts sink in by what a step moves: with less
/// room than this part of m g R in all, a run would meet its limits.
const LEAST_ROOM: f64 = 2e-3;

/// The room between start and barrier is shared: half for energy that the scheme makes, a quarter
/// for penetration, a quarter stays. More than this part of m g R in all is not given to a run: it
/// would be fast for nothing.
const MOST_ROOM: f64 = 2e-2;
const FOR_ENERGY: f64 = 0.5;
const FOR_PENETRATION: f64 = 0.25;

/// A surface that blocks stand on.
struct Level {
    /// Height, undeflected, m.
    y: f64,
    /// Weight of the blocks on it, N; 0 of ground, which doesn't sag.
    weight: f64,
    /// `None` for ground.
    bounds: Option<BeamBounds>,
}

impl Level {
    /// The energy that the surface can give by sagging under its blocks: of Σ m g w + w²/2F, the
    /// least is −F (Σ m g)²/2.
    fn sag_energy(&self) -> f64 {
        self.bounds.map_or(0.0, |bounds| 0.5 * bounds.deflection * self.weight * self.weight)
    }
}

impl Barrier {
    /// The proof, if there is one, with these pairs `dead`.
    pub(super) fn of(start: &Start<'_>, pairs: &Pairs) -> Option<Self> {
        let scene = start.scene;
        if scene.blocks.is_empty() || scene.blocks.iter().any(|block| block.polygon.is_some()) || !conserves(start) {
            return None;
        }
        let stands_on = |live: &Vec<usize>| match live[..] {
            [contact] => Some(&scene.contacts[contact]).filter(|contact| loses(contact)).map(|contact| contact.surface),
            _ => None,
        };
        let stands: Vec<Support> = pairs.live.iter().map(stands_on).collect::<Option<_>>()?;
        let g = -scene.gravity[1];
        let weight = |block: usize| scene.blocks[block].mass() * g;
        let mut weights = vec![0.0; scene.beams.len()];
        for (block, surface) in stands.iter().enumerate() {
            if let Support::Beam(beam) = surface {
                weights[*beam] += weight(block);
            }
        }
        let ground = match &scene.ground {
            Some(ground) if !ground.motion.is_given() && ground.incline == 0.0 => {
                Some(Level { y: 0.0, weight: 0.0, bounds: None })
            }
            _ => None,
        };
        let beams: Vec<Option<Level>> = (0..scene.beams.len())
            .map(|k| {
                let (beam, weight) = (&scene.beams[k], weights[k]);
                let level = |bounds| Level { y: beam.position[1], weight, bounds: Some(bounds) };
                (weight > 0.0).then(|| bounds(start, k).map(level)).flatten()
            })
            .collect();
        let level = |surface: Support| match surface {
            Support::Ground => ground.as_ref(),
            Support::Beam(k) => beams[k].as_ref(),
            // It may be anywhere.
            Support::Block(_) => None,
        };
        let on: Vec<&Level> = stands.iter().map(|surface| level(*surface)).collect::<Option<_>>()?;
        let all = |of: &dyn Fn(usize) -> f64| (0..on.len()).map(of).sum::<f64>();
        let (half_height, radius) = (
            |k: usize| 0.5 * scene.blocks[k].height,
            |k: usize| 0.5 * scene.blocks[k].width.hypot(scene.blocks[k].height),
        );
        let sag: f64 = beams.iter().flatten().map(Level::sag_energy).sum();
        let total = all(&weight);

        // Upright on what sags as it may; and with the lower corners on top, for what is not known
        // to be upright.
        let least = all(&|k| weight(k) * (on[k].y + half_height(k))) - sag;
        let worst = all(&|k| weight(k) * (on[k].y - radius(k))) - sag;
        let energy = start.model.energy(start.q, start.v).ok()?.total();
        let barrier = |k: usize| least + weight(k) * (radius(k) - half_height(k));
        let room = (0..on.len()).map(barrier).fold(f64::INFINITY, f64::min) - energy;
        let scale = all(&|k| weight(k) * radius(k));
        let needed = if scene.time.scheme.keeps_energy() { ROUNDING } else { LEAST_ROOM };
        // Heights count from the world's origin: where that is far off, so much of the energy is
        // rounding.
        let lost = ROUNDING * 1e-3 * all(&|k| weight(k) * on[k].y.abs());
        if !(room > needed * scale + lost) {
            return None;
        }
        let room = room.min(MOST_ROOM * scale);
        let limit = energy + FOR_ENERGY * room;
        let depth = FOR_PENETRATION * room / total;
        let (least, worst) = (least - total * depth, worst - total * depth);

        let fall = 2.0 * g * start.ahead();
        let mut proof = Self {
            limits: Limits { energy: limit, penetration: depth },
            energy,
            blocks: Vec::new(),
            deflections: Vec::new(),
            steepest: 0.0,
        };
        for level in &beams {
            let swing = level.as_ref().and_then(|level| Some((level, level.bounds?))).map(|(level, bounds)| {
                // W²/2F − (Σ m g) W ≤ all that is left when the blocks are as low as the others let
                // them.
                let left = limit - least - level.sag_energy();
                let sagged = bounds.deflection * level.weight;
                let largest = sagged + (sagged * sagged + 2.0 * bounds.deflection * left).max(0.0).sqrt();
                let stored = (left + level.weight * largest).max(0.0);
                proof.steepest = proof.steepest.max((2.0 * bounds.slope * stored).sqrt());
                // And to where a step looks ahead.
                largest + 2.0 * start.ahead() * (2.0 * bounds.velocity * (limit - least)).sqrt()
            });
            proof.deflections.push(swing);
        }
        // Penetration and gaps are measured along the normal.
        let normal = proof.steepest.hypot(1.0);
        proof.limits.penetration = depth / normal;
        let gap = scene.time.gap_tolerance * normal;
        for (k, of) in scene.blocks.iter().enumerate() {
            let (mass, radius, alpha) = (of.mass(), radius(k), of.width.atan2(of.height));
            let inertia = mass * (of.width * of.width + of.height * of.height) / 12.0;
            // How high its centre can be over its lowest corner.
            let height = half_height(k) + (limit - least) / weight(k);
            let angle = alpha - (height / radius).clamp(-1.0, 1.0).acos();
            let fastest = (2.0 * (limit - worst) * (1.0 / mass + radius * radius / inertia)).sqrt() + fall;
            // A corner that comes as fast as can be sinks in by half a step's way, or the run would
            // meet its limits for nothing.
            let impact = (2.0 * (limit - least) * (1.0 / mass + radius * radius / inertia)).sqrt();
            let shallow = 0.5 * start.scene.time.step * impact <= proof.limits.penetration;
            let spin = (2.0 * (limit - worst) / inertia).sqrt();
            let ahead = start.ahead() * fastest;
            let swing = match stands[k] {
                Support::Ground => 0.0,
                Support::Beam(beam) => proof.deflections[beam]?,
                Support::Block(_) => return None,
            };
            let well = Well {
                barrier: barrier(k),
                angle,
                critical_angle: alpha,
                speed: (2.0 * (limit - least) / mass).sqrt(),
                ahead,
                radius,
                upper: of.height * angle.max(0.0).cos(),
                low: on[k].y - swing - depth - ahead,
            };
            let ([_, _, phi], _) = start.block(k);
            let starts_in = phi.abs() <= angle;
            // Not even a single step, as fast as can be, leads across the band of angles that it
            // hasn't the energy for.
            let stays_in = start.scene.time.step * spin < 2.0 * (alpha - angle);
            let clear = well.upper - 2.0 * swing - depth - 2.0 * ahead > gap;
            if !(starts_in && stays_in && clear && shallow) {
                return None;
            }
            proof.blocks.push(well);
            let on_it = match stands[k] {
                Support::Ground => true,
                Support::Beam(beam) => {
                    let [from, to] = proof.reach(start, k).x;
                    let beam = &scene.beams[beam];
                    from >= beam.position[0] && to <= beam.position[0] + beam.spec.span
                }
                Support::Block(_) => false,
            };
            if !on_it {
                return None;
            }
        }
        Some(proof)
    }

    /// Where the corners of a block can come.
    pub(super) fn reach(&self, start: &Start<'_>, block: usize) -> Reach {
        let ([x, _, _], _) = start.block(block);
        let well = &self.blocks[block];
        let away = well.speed * start.time() + well.radius + well.ahead;
        Reach { x: [x - away, x + away], y: well.low, by: By::Energy }
    }

    /// The largest deflection of a beam that is stood on, m, and its largest slope; without bound
    /// for others.
    pub(super) fn swing(&self, beam: usize) -> (f64, f64) {
        self.deflections[beam].map_or((f64::INFINITY, f64::INFINITY), |w| (w, self.steepest))
    }

    /// The upper corners of a contact's block.
    pub(super) fn removed(&self, start: &Start<'_>, contact: &ContactScene) -> Removed {
        let (name, well) = (&start.scene.blocks[contact.block].name, &self.blocks[contact.block]);
        Removed {
            what: format!("contact `{}`: the upper corners of `{name}`", contact.name),
            why: format!(
                "all energy is {:.6} J, and {:.6} J would be needed to tilt `{name}` by its critical angle, {:.2} deg; up to {:.6} J it stays \
                 within {:.2} deg. The run watches that, and that penetration stays under {:.1e} m",
                self.energy,
                well.barrier,
                well.critical_angle.to_degrees(),
                self.limits.energy,
                well.angle.to_degrees(),
                self.limits.penetration
            ),
            accuracy: None,
        }
    }
}

/// Whether nothing gives energy to what moves: gravity straight down, nothing loaded or driven, a
/// scheme that doesn't grow.
fn conserves(start: &Start<'_>) -> bool {
    let scene = start.scene;
    let down = scene.gravity[0] == 0.0 && scene.gravity[1] < 0.0;
    let driven = scene.blocks.iter().any(|block| block.motion.is_given())
        || scene.beams.iter().any(|beam| beam.motion.is_given())
        || scene.ground.as_ref().is_some_and(|ground| ground.motion.is_given());
    let weighty = scene.beams.iter().any(|beam| beam.self_weight);
    // A beam beyond its buckling load, or one under compression that may turn as a whole, has
    // energy below that of its straight shape to give.
    let stable = scene
        .beams
        .iter()
        .zip(&start.layout.beams)
        .all(|(of, place)| of.spec.axial_force >= 0.0 || place.beam.factor(STATIC).is_ok());
    down && stable
        && !driven
        && !weighty
        && scene.forces.is_empty()
        && scene.loads.is_empty()
        && scene.time.theta >= 0.5
}

/// Whether a contact's law can't give energy: an impact at once, and without restitution.
fn loses(contact: &ContactScene) -> bool {
    let law = &contact.law;
    let at_once = matches!(law.impact, ImpactLaw::Newton | ImpactLaw::Poisson | ImpactLaw::Energetic);
    at_once && law.restitution == 0.0 && law.tangential_restitution == 0.0
}

/// The weights of a static solve.
pub(super) const STATIC: MatrixWeights = MatrixWeights { mass: 0.0, damping: 0.0, stiffness: 1.0 };

/// What is known of a beam's motion by its energy; `None` for one that this is not for, or not
/// worth its time.
fn bounds(start: &Start<'_>, beam: usize) -> Option<BeamBounds> {
    let (of, place) = (&start.scene.beams[beam], &start.layout.beams[beam]);
    let elements = place.beam.elements();
    let worth = elements <= MOST_ELEMENTS && start.scene.time.steps() >= STEPS_AN_ELEMENT * elements as u64;
    if !worth || of.top || matches!(of.spec.axial, Axial::Elastic { .. }) {
        return None;
    }
    // Held ends only stiffen it.
    let linear = Beam::new(of.spec.clone().axial(Axial::Free)).ok()?;
    BeamBounds::of(&linear)
}
