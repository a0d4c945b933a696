//! A resolved scene: plain SI numbers, checked references, all defaults filled in.

mod beam_output;
mod block_tables;
mod blocks;
mod crowd;
mod display;
mod history;
mod reduction;

pub use beam_output::{BEAM_QUANTITIES, BeamOutput, BeamQuantity};
pub use block_tables::BlockTables;
pub(crate) use blocks::mass_of;
pub use blocks::{BlockPart, BlockScene, Matter, Placement, SupportingBody};
pub(crate) use crowd::pairs_between;
pub use crowd::{Crowd, CrowdContact};
pub(crate) use display::most_used;
pub use display::{AngleUnit, Display, LengthUnit};
pub use history::{
    AxisScene, ForceScene, History, LoadKind, LoadScene, MotionScene, ProductScene, RecordScene, SignalScene,
};
pub use reduction::Reduction;

use std::sync::Arc;

/// A scene that can be run.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Its title.
    pub title: String,
    /// Duration, steps and scheme.
    pub time: Time,
    /// Acceleration of gravity, m/s².
    pub gravity: [f64; 2],
    /// The rigid ground, if there is any.
    pub ground: Option<GroundScene>,
    /// The beams, in the order of the file.
    pub beams: Vec<BeamScene>,
    /// The blocks, in the order of the file.
    pub blocks: Vec<BlockScene>,
    /// The contacts, in the order of the file, but for those of a [crowd](Self::crowd).
    pub contacts: Vec<ContactScene>,
    /// The contacts between blocks that are not listed because there are so many of them.
    pub crowd: Option<Crowd>,
    /// The signals, in the order of the file.
    pub signals: Vec<SignalScene>,
    /// The forces on blocks, in the order of the file.
    pub forces: Vec<ForceScene>,
    /// The loads on beams, in the order of the file.
    pub loads: Vec<LoadScene>,
    /// The contact solver.
    pub solver: SolverScene,
    /// Time between rows, s; `None`: thinned to some 10 000 rows.
    pub every: Option<f64>,
    /// In which tables the motions of blocks are.
    pub block_tables: BlockTables,
    /// How the page and the figures show it.
    pub display: Display,
}

/// Time stepping of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Time {
    /// The given end time, s.
    pub end: f64,
    /// Step size, s. If an accuracy is given, a provisional one until a step is found.
    pub step: f64,
    /// The accuracy for which a step must be found; `None` once there is a step.
    pub accuracy: Option<f64>,
    /// The scheme.
    pub scheme: SchemeName,
    /// θ of the scheme.
    pub theta: f64,
    /// γ of the activation.
    pub activation_gamma: f64,
    /// Largest predicted gap of an active contact, m.
    pub gap_tolerance: f64,
    /// ρ∞ of `generalized-alpha`.
    pub spectral_radius: f64,
    /// What ends the run before its end.
    pub stop: StopScene,
}

/// What ends a run before its end; by default nothing (`docs/verdict.md`).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct StopScene {
    /// A block has overturned.
    pub overturned: bool,
    /// All blocks rest, all prescribed motion is over, and no force or load changes any more.
    pub rest: bool,
    /// A block is below everything that could hold it.
    pub sunk: bool,
}

impl StopScene {
    /// Whether anything does.
    #[must_use]
    pub fn is_given(self) -> bool {
        self.overturned || self.rest || self.sunk
    }
}

impl Scene {
    /// The prescribed motions, possibly empty, of all blocks, beam supports and the ground, with
    /// their tables.
    pub fn motions(&self) -> impl Iterator<Item = (String, &MotionScene)> {
        let blocks = self.blocks.iter().map(|block| (format!("block.{}.motion", block.name), &block.motion));
        let beams = self.beams.iter().map(|beam| (format!("beam.{}.motion", beam.name), &beam.motion));
        let ground = self.ground.iter().map(|ground| ("ground.motion".to_owned(), &ground.motion));
        blocks.chain(beams).chain(ground)
    }

    /// The records that prescribe motions, in the order of [`Scene::motions`].
    pub fn records(&self) -> impl Iterator<Item = &Arc<RecordScene>> {
        self.motions().flat_map(|(_, motion)| motion.0.iter().flatten()).filter_map(|axis| match &axis.history {
            History::Record(record) => Some(record),
            History::Formula(_) | History::Chirp(_) | History::Table(_) | History::Sum(_) | History::Product(_) => None,
        })
    }

    /// From which time on nothing prescribed moves, and no force or load changes, s. Infinite if
    /// something goes on for ever, such as a harmonic, or a velocity without a signal.
    #[must_use]
    pub fn settles_at(&self) -> f64 {
        // To what has nothing but the ground to meet, a constant velocity of that is none, such as the
        // one with which a record ends.
        let alone = self.beams.is_empty() && self.blocks.iter().all(|block| !block.motion.is_given());
        let motions: Vec<f64> = self.motions().map(|(_, motion)| motion.ends_at(alone)).collect();
        let forces = self.forces.iter().map(|force| force.history.settles_at());
        let loads = self.loads.iter().map(|load| match load.kind {
            LoadKind::Moving { at, speed, .. } if speed != 0.0 => {
                let left = if speed > 0.0 { self.beams[load.beam].spec.span - at } else { -at };
                load.history.settles_at().max(left / speed)
            }
            _ => load.history.settles_at(),
        });
        motions.into_iter().chain(forces).chain(loads).fold(0.0, f64::max)
    }

    /// What carries a block that isn't placed on anything, as far as its contacts tell: the ground or beam of its first contact with
    /// one, or else the body of its first contact with another block as the first of the two.
    #[must_use]
    pub fn first_touched(&self, block: usize) -> Option<SupportingBody> {
        let touched = || self.contacts.iter().filter(|contact| contact.block == block).map(|contact| contact.surface);
        // What it can touch beside other blocks stands still where they may go away.
        touched().find(|surface| !matches!(surface, SupportingBody::Block(_))).or_else(|| touched().next())
    }

    /// Whether any bodies can touch, listed or in a crowd.
    #[must_use]
    pub fn has_contacts(&self) -> bool {
        !self.contacts.is_empty() || self.crowd.is_some()
    }

    /// The name of a body that a block can stand on or touch.
    #[must_use]
    pub fn name_of(&self, support: SupportingBody) -> &str {
        match support {
            SupportingBody::Ground => "ground",
            SupportingBody::Beam(beam) => &self.beams[beam].name,
            SupportingBody::Block(block) => &self.blocks[block].name,
        }
    }

    /// Whether anything but weight moves the block of a contact: its initial velocity or prescribed
    /// motion, a force, or the body that carries it.
    pub(crate) fn is_driven(&self, contact: &ContactScene) -> bool {
        let block = &self.blocks[contact.block];
        let carried = match contact.surface {
            SupportingBody::Ground => self.ground.as_ref().is_some_and(|ground| ground.motion.is_given()),
            SupportingBody::Beam(beam) => {
                self.beams[beam].motion.is_given() || self.loads.iter().any(|load| load.beam == beam)
            }
            // Its motion is unknown.
            SupportingBody::Block(_) => true,
        };
        let pushed = self.forces.iter().any(|force| force.block == contact.block);
        carried || pushed || block.motion.is_given() || block.spin != 0.0 || block.velocity != [0.0; 2]
    }
}

impl Time {
    /// Steps of the run: up to the first time at or past `end`.
    ///
    /// They follow from `end` and `step`, also when these are changed:
    ///
    /// ```
    /// # let text = "[time]\nend = '0.5 s'\nstep = '1 ms'\n[ground]\n[material.m]\ndensity = '1 kg/m^3'\n[block.b]\n\
    /// #     material = 'm'\nwidth = '1 m'\nheight = '1 m'\ndepth = '1 m'\nposition = ['0 m', '1 m']\n";
    /// let mut scene = teeter_scenario::load(text.as_bytes(), "block.toml", "block", &[])?.scene;
    /// assert_eq!(scene.time.steps(), 500);
    /// scene.time.step = 0.3e-3;
    /// assert_eq!(scene.time.steps(), 1667);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn steps(&self) -> u64 {
        let steps = self.end / self.step;
        // A whole number of steps up to rounding of the quotient counts as one; for very many steps
        // a thousandth of a step is more than that.
        let whole = steps.round();
        let rounding = (1e-9 * whole).min(1e-3);
        (if (steps - whole).abs() <= rounding { whole } else { steps.ceil() }) as u64
    }

    /// The θ that the scheme uses: ½ for all but `moreau-jean`, whatever is given.
    #[must_use]
    pub fn theta_of_scheme(&self) -> f64 {
        if self.scheme.is_trapezoidal() { 0.5 } else { self.theta }
    }
}

/// A time scheme by name.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum SchemeName {
    /// Moreau–Jean's θ scheme.
    #[default]
    MoreauJean,
    /// The same with contacts that stay closed by a flag.
    MoreauJeanClosed,
    /// The closed one, with steps divided where a contact closes.
    MoreauJeanLocated,
    /// Smooth motion of high order between events.
    EventDriven,
    /// Contact with beams as a force, with steps halved where contacts close.
    Resolved,
    /// The closed one, with positions projected to remove penetrations.
    MoreauJeanProjected,
    /// Generalized-α with impacts.
    GeneralizedAlpha,
}

impl SchemeName {
    /// Its word in scenes and summaries.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::MoreauJean => teeter_integrator::MoreauJean::<2>::NAME,
            Self::MoreauJeanClosed => teeter_integrator::MoreauJeanClosed::<2>::NAME,
            Self::MoreauJeanLocated => teeter_integrator::MoreauJeanLocated::<2>::NAME,
            Self::EventDriven => teeter_integrator::EventDriven::NAME,
            Self::Resolved => teeter_integrator::Resolved::<2>::NAME,
            Self::MoreauJeanProjected => teeter_integrator::MoreauJeanProjected::<2>::NAME,
            Self::GeneralizedAlpha => teeter_integrator::GeneralizedAlpha::<2>::NAME,
        }
    }

    /// Whether it allows only θ = ½, or has no θ.
    #[must_use]
    pub fn is_trapezoidal(self) -> bool {
        match self {
            Self::MoreauJean => false,
            Self::MoreauJeanClosed | Self::MoreauJeanLocated | Self::EventDriven | Self::Resolved => true,
            Self::MoreauJeanProjected | Self::GeneralizedAlpha => true,
        }
    }

    /// The θ of the mean that gives prescribed velocities at the end of a step; `None` if they are
    /// those at that time.
    #[must_use]
    pub fn drives_about(self, theta: f64) -> Option<f64> {
        match self {
            Self::MoreauJean => Some(theta),
            Self::MoreauJeanClosed | Self::MoreauJeanLocated | Self::Resolved => Some(0.5),
            Self::MoreauJeanProjected | Self::GeneralizedAlpha => Some(0.5),
            Self::EventDriven => None,
        }
    }

    /// Whether it supports compliant contacts.
    #[must_use]
    pub fn takes_springs(self) -> bool {
        match self {
            Self::MoreauJean | Self::MoreauJeanClosed | Self::MoreauJeanLocated | Self::Resolved => true,
            Self::MoreauJeanProjected | Self::GeneralizedAlpha => true,
            Self::EventDriven => false,
        }
    }

    /// Whether contact with a beam is a force that keeps the gap closed, so that there is no
    /// restitution.
    #[must_use]
    pub fn holds_beams(self) -> bool {
        self == Self::Resolved
    }

    /// Whether it takes its own steps within those of the scene, which only determine the output.
    #[must_use]
    pub fn has_own_steps(self) -> bool {
        match self {
            Self::MoreauJean | Self::MoreauJeanClosed | Self::MoreauJeanLocated | Self::Resolved => false,
            Self::MoreauJeanProjected | Self::GeneralizedAlpha => false,
            Self::EventDriven => true,
        }
    }

    /// Whether it supports beams held along their axis.
    #[must_use]
    pub fn takes_held_beams(self) -> bool {
        match self {
            Self::MoreauJean | Self::MoreauJeanClosed | Self::MoreauJeanLocated | Self::MoreauJeanProjected => true,
            Self::EventDriven | Self::Resolved | Self::GeneralizedAlpha => false,
        }
    }

    /// Whether contacts are active by a predicted gap, `activation_gamma` of a step ahead.
    #[must_use]
    pub fn predicts(self) -> bool {
        match self {
            Self::MoreauJean => true,
            Self::MoreauJeanClosed | Self::MoreauJeanLocated | Self::EventDriven | Self::Resolved => false,
            Self::MoreauJeanProjected | Self::GeneralizedAlpha => false,
        }
    }

    /// Whether impacts have their own times, rather than those of steps.
    #[must_use]
    pub fn locates(self) -> bool {
        match self {
            Self::MoreauJean | Self::MoreauJeanClosed => false,
            Self::MoreauJeanLocated | Self::EventDriven | Self::Resolved => true,
            Self::MoreauJeanProjected | Self::GeneralizedAlpha => false,
        }
    }

    /// Whether contacts generate no energy, except those with bodies of prescribed motion. A
    /// projection may, as it lifts blocks that have penetrated.
    #[must_use]
    pub fn keeps_energy(self) -> bool {
        match self {
            Self::MoreauJeanClosed | Self::MoreauJeanLocated | Self::EventDriven | Self::Resolved => true,
            Self::MoreauJean | Self::MoreauJeanProjected | Self::GeneralizedAlpha => false,
        }
    }
}

/// The rigid ground of a scene.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct GroundScene {
    /// Its initial slope, before any prescribed rotation, rad.
    pub incline: f64,
    /// Its profile, level beyond its ends; `None` for a straight line. It moves and turns with the
    /// ground.
    pub profile: Option<Arc<teeter_detect::Profile>>,
    /// Its prescribed motion.
    pub motion: MotionScene,
}

/// A beam of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct BeamScene {
    /// Its name.
    pub name: String,
    /// Its specification.
    pub spec: teeter_beam::BeamSpec,
    /// Thickness, m; 0 for a section given directly without one.
    pub thickness: f64,
    /// Yield strength of its material, Pa.
    pub yield_strength: Option<f64>,
    /// Whether contacts are on the top fibre, not on the axis.
    pub top: bool,
    /// Whether it starts in equilibrium under the blocks that stand on it.
    pub static_start: bool,
    /// The coordinates of its given initial shape; empty without one.
    pub shape: Vec<f64>,
    /// Whether gravity acts on it.
    pub self_weight: bool,
    /// Its modal basis; `None` if it moves in the coordinates of all its nodes.
    pub reduction: Option<Reduction>,
    /// How W is applied to forces and contacts.
    pub backend: teeter_integrator::WBackend,
    /// Position of its left end, m.
    pub position: [f64; 2],
    /// Positions of the probes along the span, m.
    pub probes: Vec<f64>,
    /// Its output of section forces and reactions.
    pub output: BeamOutput,
    /// The prescribed motion of its supports; the third axis has none.
    pub motion: MotionScene,
}

/// A contact between a block and a surface, or between two blocks.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactScene {
    /// Its name.
    pub name: String,
    /// The bodies by name, as in the file.
    pub between: [String; 2],
    /// The block, by its number in the scene; the first of two.
    pub block: usize,
    /// The body that it touches.
    pub surface: SupportingBody,
    /// Friction and the law along the normal.
    pub law: teeter_integrator::PairLaw,
    /// Friction at the left and at the right [foot](BlockScene::feet), where it is not that of the law.
    pub feet_friction: [Option<f64>; 2],
    /// Whether contact frames follow the deflection of the surface.
    pub kinematics: teeter_detect::Kinematics,
    /// The side of a beam that the block touches; upper for other surfaces.
    pub face: teeter_integrator::BeamFace,
    /// Whether the block's sides can touch a beam, too, not only its corners; false for other
    /// surfaces.
    pub sides: bool,
}

impl ContactScene {
    /// The law of a corner of the block, which is that of the contact but for a foot with a friction of its own.
    #[must_use]
    pub fn law_at(&self, block: &BlockScene, corner: usize) -> teeter_integrator::PairLaw {
        let foot = block.feet().iter().position(|foot| *foot == corner);
        let mut law = self.law;
        law.friction = foot.and_then(|foot| self.feet_friction[foot]).unwrap_or(law.friction);
        law
    }

    /// The least and the largest friction of the feet.
    #[must_use]
    pub fn friction_of_feet(&self) -> [f64; 2] {
        let [left, right] = self.feet_friction.map(|own| own.unwrap_or(self.law.friction));
        [left.min(right), left.max(right)]
    }

    /// The other block of a contact between two.
    #[must_use]
    pub fn other_block(&self) -> Option<usize> {
        match self.surface {
            SupportingBody::Block(other) => Some(other),
            SupportingBody::Ground | SupportingBody::Beam(_) => None,
        }
    }

    /// Whether its law causes a rebound, beyond the elasticity of the bodies: by restitution, or by
    /// a compliant law.
    #[must_use]
    pub fn gives_back(&self) -> bool {
        let law = &self.law;
        law.impact.has_duration() || law.restitution > 0.0 || law.tangential_restitution > 0.0
    }
}

/// The contact solver of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct SolverScene {
    /// Its name.
    pub method: String,
    /// Largest residual that counts as solved.
    pub tolerance: f64,
    /// Most iterations.
    pub max_iterations: u32,
    /// Whether an unsolved step ends the run.
    pub require_convergence: bool,
}

impl BeamScene {
    /// Whether it uses Timoshenko's theory.
    #[must_use]
    pub fn is_sheared(&self) -> bool {
        self.spec.section.shear_stiffness.is_finite()
    }

    /// The displacement of its supports at the start, x and y, m.
    #[must_use]
    pub fn start_displacement(&self) -> [f64; 2] {
        let [x, y, _] = self.motion.motions();
        [x.displacement(0.0), y.displacement(0.0)]
    }

    /// Position of its left end at the start, its supports displaced, m.
    #[must_use]
    pub fn start_position(&self) -> [f64; 2] {
        let ([x, y], [right, up]) = (self.position, self.start_displacement());
        [x + right, y + up]
    }
}
