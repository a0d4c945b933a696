//! A scene resolved: plain SI numbers, references checked, nothing left to guess.

mod beam_output;
mod history;
mod reduction;

pub use beam_output::{BEAM_QUANTITIES, BeamOutput, BeamQuantity};
pub use history::{AxisScene, ForceScene, History, LoadKind, LoadScene, MotionScene, SignalScene};
pub use reduction::Reduction;

use nalgebra::Vector2;
use std::sync::Arc;
use teeter_rigid::{MassProperties, Rectangle, RigidError};

/// A scene that can be run.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// What it is called.
    pub title: String,
    /// How long, in which steps, by which scheme.
    pub time: Time,
    /// Acceleration of gravity, m/s².
    pub gravity: [f64; 2],
    /// The rigid ground, if there is any.
    pub ground: Option<GroundScene>,
    /// The beams, in the order of the file.
    pub beams: Vec<BeamScene>,
    /// The blocks, in the order of the file.
    pub blocks: Vec<BlockScene>,
    /// The contacts, in the order of the file.
    pub contacts: Vec<ContactScene>,
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
}

/// How a scene is stepped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Time {
    /// The time asked for, s.
    pub end: f64,
    /// Step size, s. Where an accuracy is asked for, one to go on with until a step is found.
    pub step: f64,
    /// The accuracy that a step is to be found for; `None` once there is a step.
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
}

impl Scene {
    /// The motions of all that can be moved as prescribed, whether it is or not, with their tables:
    /// blocks, beams' supports, ground.
    pub fn motions(&self) -> impl Iterator<Item = (String, &MotionScene)> {
        let blocks = self.blocks.iter().map(|block| (format!("block.{}.motion", block.name), &block.motion));
        let beams = self.beams.iter().map(|beam| (format!("beam.{}.motion", beam.name), &beam.motion));
        let ground = self.ground.iter().map(|ground| ("ground.motion".to_owned(), &ground.motion));
        blocks.chain(beams).chain(ground)
    }

    /// The name of what a block can stand on or touch.
    #[must_use]
    pub fn name_of(&self, support: Support) -> &str {
        match support {
            Support::Ground => "ground",
            Support::Beam(beam) => &self.beams[beam].name,
            Support::Block(block) => &self.blocks[block].name,
        }
    }

    /// Whether anything but weight moves the block of a contact: its own start or motion, a force
    /// on it, or what carries it.
    pub(crate) fn is_driven(&self, contact: &ContactScene) -> bool {
        let block = &self.blocks[contact.block];
        let carried = match contact.surface {
            Support::Ground => self.ground.as_ref().is_some_and(|ground| ground.motion.is_given()),
            Support::Beam(beam) => {
                self.beams[beam].motion.is_given() || self.loads.iter().any(|load| load.beam == beam)
            }
            // It moves as it likes.
            Support::Block(_) => true,
        };
        let pushed = self.forces.iter().any(|force| force.block == contact.block);
        carried || pushed || block.motion.is_given() || block.spin != 0.0 || block.velocity != [0.0; 2]
    }
}

impl Time {
    /// Steps of the run: up to the first time at or past `end`.
    ///
    /// They follow from `end` and `step`, whoever changes those:
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
        // Up to rounding of the quotient a whole number of steps is one; of very many, a thousandth
        // of a step is more than that.
        let whole = steps.round();
        let rounding = (1e-9 * whole).min(1e-3);
        (if (steps - whole).abs() <= rounding { whole } else { steps.ceil() }) as u64
    }

    /// The θ by which the scheme steps: the closed one has ½, whatever is given.
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
    /// The closed one, divided where a contact closes.
    MoreauJeanLocated,
    /// Smooth motion of high order between events.
    EventDriven,
    /// Contact with beams as a force, in steps halved where contacts close.
    Resolved,
    /// The closed one, with places projected onto what contacts allow.
    MoreauJeanProjected,
    /// Generalized-α with impacts.
    GeneralizedAlpha,
}

impl SchemeName {
    /// The word for it in scenes and summaries.
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

    /// Whether it takes no θ but ½, or none.
    #[must_use]
    pub fn is_trapezoidal(self) -> bool {
        match self {
            Self::MoreauJean => false,
            Self::MoreauJeanClosed | Self::MoreauJeanLocated | Self::EventDriven | Self::Resolved => true,
            Self::MoreauJeanProjected | Self::GeneralizedAlpha => true,
        }
    }

    /// The θ with which prescribed velocities at the end of a step are means about it; `None` where
    /// they are those of that time.
    #[must_use]
    pub fn drives_about(self, theta: f64) -> Option<f64> {
        match self {
            Self::MoreauJean => Some(theta),
            Self::MoreauJeanClosed | Self::MoreauJeanLocated | Self::Resolved => Some(0.5),
            Self::MoreauJeanProjected | Self::GeneralizedAlpha => Some(0.5),
            Self::EventDriven => None,
        }
    }

    /// Whether it takes contacts with duration.
    #[must_use]
    pub fn takes_springs(self) -> bool {
        match self {
            Self::MoreauJean | Self::MoreauJeanClosed | Self::MoreauJeanLocated | Self::Resolved => true,
            Self::MoreauJeanProjected | Self::GeneralizedAlpha => true,
            Self::EventDriven => false,
        }
    }

    /// Whether contact with a beam is a force that holds the gap closed, so that there is nothing
    /// that could be given back.
    #[must_use]
    pub fn holds_beams(self) -> bool {
        self == Self::Resolved
    }

    /// Whether it takes steps of its own within those of the scene, so that these only say when it
    /// reports.
    #[must_use]
    pub fn has_own_steps(self) -> bool {
        match self {
            Self::MoreauJean | Self::MoreauJeanClosed | Self::MoreauJeanLocated | Self::Resolved => false,
            Self::MoreauJeanProjected | Self::GeneralizedAlpha => false,
            Self::EventDriven => true,
        }
    }

    /// Whether it takes beams held along their axis.
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

    /// Whether impacts have times of their own, rather than those of the steps in which they fall.
    #[must_use]
    pub fn locates(self) -> bool {
        match self {
            Self::MoreauJean | Self::MoreauJeanClosed => false,
            Self::MoreauJeanLocated | Self::EventDriven | Self::Resolved => true,
            Self::MoreauJeanProjected | Self::GeneralizedAlpha => false,
        }
    }

    /// Whether no contact gives energy, but for contacts with what is moved as prescribed. A
    /// projection may: it lifts what has sunk in.
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
    /// Its slope at the start, before a given turn, rad.
    pub incline: f64,
    /// Its prescribed motion.
    pub motion: MotionScene,
}

/// A beam of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct BeamScene {
    /// Its name.
    pub name: String,
    /// Its numbers.
    pub spec: teeter_beam::BeamSpec,
    /// Thickness, m; 0 where a section that is given directly has none.
    pub thickness: f64,
    /// Stress at which its material yields, Pa.
    pub yield_strength: Option<f64>,
    /// Whether contacts lie on the top fibre, not on the axis.
    pub top: bool,
    /// Whether it starts in equilibrium under the blocks that stand on it.
    pub static_start: bool,
    /// The coordinates of the shape that it starts in; empty for none of its own.
    pub shape: Vec<f64>,
    /// Whether gravity acts on it.
    pub self_weight: bool,
    /// In which shapes it moves; `None` for those of all its nodes.
    pub reduction: Option<Reduction>,
    /// How its matrices answer forces and contacts.
    pub backend: teeter_integrator::WBackend,
    /// Place of its left end, m.
    pub position: [f64; 2],
    /// Places along the span whose deflection is written, m.
    pub probes: Vec<f64>,
    /// What is written of what it bears.
    pub output: BeamOutput,
    /// The prescribed motion of its supports; the third axis has none.
    pub motion: MotionScene,
}

/// A block of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockScene {
    /// Its name.
    pub name: String,
    /// Width b, m; of a polygon the largest of its extents across its sides.
    pub width: f64,
    /// Height H, m; of a polygon the smallest of its extents across its sides.
    pub height: f64,
    /// Corners about its mass centre, counter-clockwise, m, of a block that is no rectangle of
    /// these sides.
    pub polygon: Option<Arc<[Vector2<f64>]>>,
    /// Depth out of the plane, m.
    pub depth: f64,
    /// Density, kg/m³.
    pub density: f64,
    /// Where it starts.
    pub placement: Placement,
    /// Velocity of the mass centre, m/s.
    pub velocity: [f64; 2],
    /// Angular velocity, rad/s.
    pub spin: f64,
    /// What is prescribed of its motion; the rest is free.
    pub motion: MotionScene,
}

/// Where a block starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Placement {
    /// Its mass centre (m) and angle (rad).
    Free {
        /// Mass centre, m.
        position: [f64; 2],
        /// Angle, rad.
        angle: f64,
    },
    /// Standing on a surface.
    On {
        /// What it stands on.
        support: Support,
        /// x of the middle of its base before it is tilted, m; of a stacked one from the middle of
        /// the side below, along it.
        at: f64,
        /// Whether it was put on the block below by `stacked`.
        stacked: bool,
        /// Turn about the corner that it stays on, rad.
        tilt: f64,
        /// The contact that joins the two.
        contact: usize,
    },
}

/// What a block can stand on or touch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Support {
    /// The ground.
    Ground,
    /// A beam, by its number in the scene.
    Beam(usize),
    /// Another block, by its number in the scene.
    Block(usize),
}

/// A contact between a block and a surface, or between two blocks.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactScene {
    /// Its name.
    pub name: String,
    /// The bodies by name, as in the file.
    pub between: [String; 2],
    /// The block, by its number in the scene; of two, the one that is named first.
    pub block: usize,
    /// What it touches.
    pub surface: Support,
    /// Friction, and what happens along the normal.
    pub law: teeter_integrator::PairLaw,
    /// How the surface's deflection enters.
    pub kinematics: teeter_detect::Kinematics,
}

impl ContactScene {
    /// The other block of a contact between two.
    #[must_use]
    pub fn other_block(&self) -> Option<usize> {
        match self.surface {
            Support::Block(other) => Some(other),
            Support::Ground | Support::Beam(_) => None,
        }
    }

    /// Whether it gives back what struck it, beyond what its bodies' own elasticity does: by
    /// restitution, or by a law with duration.
    #[must_use]
    pub fn gives_back(&self) -> bool {
        use teeter_integrator::ImpactLaw;
        let law = &self.law;
        let has_duration = matches!(law.impact, ImpactLaw::KelvinVoigt { .. } | ImpactLaw::HuntCrossley { .. });
        has_duration || law.restitution > 0.0 || law.tangential_restitution > 0.0
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
    /// Whether its theory is Timoshenko's.
    #[must_use]
    pub fn is_sheared(&self) -> bool {
        self.spec.section.shear_stiffness.is_finite()
    }
}

impl BlockScene {
    /// Mass, kg.
    #[must_use]
    pub fn mass(&self) -> f64 {
        match &self.polygon {
            None => self.density * self.width * self.height * self.depth,
            Some(_) => self.mass_properties().map_or(f64::NAN, |of| of.mass),
        }
    }

    /// Mass and moment of inertia.
    ///
    /// # Errors
    /// If they are not positive and finite.
    pub fn mass_properties(&self) -> Result<MassProperties, RigidError> {
        match &self.polygon {
            None => MassProperties::rectangle(&Rectangle::new(self.width, self.height)?, self.depth, self.density),
            Some(corners) => Ok(MassProperties::polygon(corners, self.depth, self.density)?.0),
        }
    }

    /// The corners about its mass centre, counter-clockwise, m; those of a rectangle from the
    /// bottom left.
    #[must_use]
    pub fn corners(&self) -> Vec<Vector2<f64>> {
        let (x, y) = (0.5 * self.width, 0.5 * self.height);
        self.polygon.as_ref().map_or_else(
            || [[-x, -y], [x, -y], [x, y], [-x, y]].map(Vector2::from).to_vec(),
            |corners| corners.to_vec(),
        )
    }

    /// How many corners it has.
    #[must_use]
    pub fn corner_count(&self) -> usize {
        self.polygon.as_ref().map_or(Rectangle::CORNER_NAMES.len(), |corners| corners.len())
    }

    /// What a corner is called in tables: bottom-left and so on, or corner-1 and so on of a
    /// polygon.
    #[must_use]
    pub fn corner_name(&self, corner: usize) -> String {
        match &self.polygon {
            None => Rectangle::CORNER_NAMES.get(corner).map_or_else(|| corner.to_string(), |name| (*name).to_owned()),
            Some(_) => format!("corner-{}", corner + 1),
        }
    }

    /// The largest distance of a corner from the mass centre, m.
    #[must_use]
    pub fn radius(&self) -> f64 {
        match &self.polygon {
            None => 0.5 * self.width.hypot(self.height),
            Some(corners) => corners.iter().map(Vector2::norm).fold(0.0, f64::max),
        }
    }

    /// The critical angle α = atan(b/H), rad; `None` for a polygon, which has no base of its own.
    #[must_use]
    pub fn critical_angle(&self) -> Option<f64> {
        self.polygon.is_none().then(|| self.width.atan2(self.height))
    }
}
