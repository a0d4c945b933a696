//! A random scene as data: numbers in SI units and a few words, which a property can change and
//! which can be written as a scene file.

use std::f64::consts::PI;

/// How a scene is integrated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Scheme {
    MoreauJean { theta: f64, gamma: f64 },
    Closed,
    Located,
    Projected,
    GeneralizedAlpha,
}

impl Scheme {
    /// Whether its contacts stay closed by a flag, and give no energy.
    pub(crate) fn is_closed(self) -> bool {
        !matches!(self, Self::MoreauJean { .. })
    }
}

/// What a block can stand on or fall on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Surface {
    Ground,
    Beam(usize),
}

/// How ground or supports move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Motion {
    /// An acceleration (m/s²) times the scene's signal.
    Shaken([f64; 2]),
    /// A constant velocity, m/s.
    Travelling([f64; 2]),
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Ground {
    pub(crate) incline: f64,
    pub(crate) motion: Option<Motion>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Support {
    Word(&'static str),
    /// Stiffness (N/m) and damping (N s/m) across the axis, stiffness of the rotation (N m/rad).
    Spring([f64; 3]),
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Damping {
    None,
    Ratio(f64),
    Viscous(f64),
    Rayleigh([f64; 2]),
}

/// A part of a beam with another thickness.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment {
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) thickness: f64,
}

#[derive(Clone, Debug)]
pub(crate) struct Beam {
    pub(crate) name: String,
    pub(crate) position: [f64; 2],
    pub(crate) span: f64,
    pub(crate) width: f64,
    pub(crate) thickness: f64,
    pub(crate) density: f64,
    pub(crate) modulus: f64,
    pub(crate) elements: u32,
    pub(crate) supports: [Support; 2],
    pub(crate) damping: Damping,
    pub(crate) segment: Option<Segment>,
    /// Place and mass.
    pub(crate) lump: Option<[f64; 2]>,
    /// Stiffness and damping per length under the whole span.
    pub(crate) foundation: Option<[f64; 2]>,
    pub(crate) timoshenko: bool,
    pub(crate) top: bool,
    pub(crate) static_start: bool,
    pub(crate) self_weight: bool,
    /// In so many modes instead of all coordinates.
    pub(crate) modes: Option<u32>,
    pub(crate) motion: Option<Motion>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Placement {
    Standing { at: f64, tilt: f64 },
    Flying { position: [f64; 2], angle: f64 },
}

#[derive(Clone, Debug)]
pub(crate) struct Block {
    pub(crate) name: String,
    pub(crate) density: f64,
    /// Width, height, depth.
    pub(crate) size: [f64; 3],
    pub(crate) over: Surface,
    pub(crate) placement: Placement,
    pub(crate) velocity: [f64; 2],
    pub(crate) spin: f64,
    /// Force x, y and couple, times the scene's signal.
    pub(crate) load: Option<[f64; 3]>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Law {
    /// The word, and restitution along the normal and the tangent.
    Instant {
        word: &'static str,
        normal: f64,
        tangential: f64,
    },
    KelvinVoigt {
        stiffness: f64,
        damping: f64,
    },
    /// With D (s/m).
    HuntCrossley {
        stiffness: f64,
        damping: f64,
        exponent: f64,
    },
}

impl Law {
    pub(crate) fn is_poisson(&self) -> bool {
        matches!(self, Self::Instant { word: "poisson", .. })
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Contact {
    pub(crate) name: String,
    pub(crate) block: usize,
    pub(crate) surface: Surface,
    pub(crate) friction: f64,
    pub(crate) law: Law,
    pub(crate) linear: bool,
}

/// sin(2π f (t − start)) from the start on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Signal {
    pub(crate) start: f64,
    pub(crate) frequency: f64,
}

impl Signal {
    /// Its mean from one time to another: of a sine that is 0 before its start.
    pub(crate) fn mean(&self, from: f64, to: f64) -> f64 {
        let [a, b] = [from, to].map(|t| (t - self.start).max(0.0));
        let omega = 2.0 * PI * self.frequency;
        // cos ωa − cos ωb, without the loss of digits of a difference.
        2.0 * (0.5 * omega * (a + b)).sin() * (0.5 * omega * (b - a)).sin() / (omega * (to - from))
    }
}

/// The scene.
#[derive(Clone)]
pub(crate) struct Drawn {
    pub(crate) step: f64,
    pub(crate) steps: u32,
    pub(crate) scheme: Scheme,
    pub(crate) gap_tolerance: f64,
    pub(crate) gravity: [f64; 2],
    pub(crate) ground: Option<Ground>,
    pub(crate) beams: Vec<Beam>,
    pub(crate) blocks: Vec<Block>,
    pub(crate) contacts: Vec<Contact>,
    pub(crate) signal: Signal,
    pub(crate) method: &'static str,
    pub(crate) tolerance: f64,
}

/// A case that fails is shown as the scene that `teeter run` takes.
impl std::fmt::Debug for Drawn {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "\n{}", self.to_toml())
    }
}

/// Powers of length, mass and time in a number's unit.
pub(crate) type Dimension = [f64; 3];

const NONE: Dimension = [0.0, 0.0, 0.0];
const LENGTH: Dimension = [1.0, 0.0, 0.0];
const TIME: Dimension = [0.0, 0.0, 1.0];
const RATE: Dimension = [0.0, 0.0, -1.0];
const VELOCITY: Dimension = [1.0, 0.0, -1.0];
const ACCELERATION: Dimension = [1.0, 0.0, -2.0];
const MASS: Dimension = [0.0, 1.0, 0.0];
const DENSITY: Dimension = [-3.0, 1.0, 0.0];
const FORCE: Dimension = [1.0, 1.0, -2.0];
const COUPLE: Dimension = [2.0, 1.0, -2.0];
const STIFFNESS: Dimension = [0.0, 1.0, -2.0];
const DAMPING: Dimension = [0.0, 1.0, -1.0];
const PRESSURE: Dimension = [-1.0, 1.0, -2.0];
const DAMPING_PER_LENGTH: Dimension = [-1.0, 1.0, -1.0];

/// What a number is for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Use {
    /// The grid of time.
    Steps,
    /// What the motion depends on.
    Physics,
}

impl Drawn {
    /// The largest side of a block, m: what places are measured by.
    pub(crate) fn length(&self) -> f64 {
        self.blocks.iter().map(|block| block.size[0].max(block.size[1])).fold(0.0, f64::max)
    }

    /// Whether anything depends on time.
    pub(crate) fn is_driven(&self) -> bool {
        self.blocks.iter().any(|block| block.load.is_some())
            || self.beams.iter().any(|beam| beam.motion.is_some())
            || self.ground.is_some_and(|ground| ground.motion.is_some())
    }

    /// Shows every number of the scene that has more than one sensible value, with its unit; 0
    /// stays what it is by symmetry.
    pub(crate) fn each_number(&mut self, visit: &mut dyn FnMut(&mut f64, Dimension, Use)) {
        visit(&mut self.step, TIME, Use::Steps);
        visit(&mut self.gap_tolerance, LENGTH, Use::Steps);
        let visit = &mut |number: &mut f64, dimension| visit(number, dimension, Use::Physics);
        let motion = |motion: &mut Option<Motion>, visit: &mut dyn FnMut(&mut f64, Dimension)| match motion {
            Some(Motion::Shaken(a)) => a.iter_mut().for_each(|a| visit(a, ACCELERATION)),
            Some(Motion::Travelling(v)) => v.iter_mut().for_each(|v| visit(v, VELOCITY)),
            None => {}
        };
        self.gravity.iter_mut().for_each(|g| visit(g, ACCELERATION));
        visit(&mut self.signal.start, TIME);
        visit(&mut self.signal.frequency, RATE);
        if let Some(ground) = &mut self.ground {
            visit(&mut ground.incline, NONE);
            motion(&mut ground.motion, visit);
        }
        for beam in &mut self.beams {
            beam.position.iter_mut().for_each(|x| visit(x, LENGTH));
            for (number, dimension) in [
                (&mut beam.span, LENGTH),
                (&mut beam.width, LENGTH),
                (&mut beam.thickness, LENGTH),
                (&mut beam.density, DENSITY),
                (&mut beam.modulus, PRESSURE),
            ] {
                visit(number, dimension);
            }
            for support in &mut beam.supports {
                if let Support::Spring([spring, dashpot, rotational]) = support {
                    visit(spring, STIFFNESS);
                    visit(dashpot, DAMPING);
                    visit(rotational, COUPLE);
                }
            }
            match &mut beam.damping {
                Damping::None => {}
                Damping::Ratio(ratio) => visit(ratio, NONE),
                Damping::Viscous(c) => visit(c, DAMPING_PER_LENGTH),
                Damping::Rayleigh([a0, a1]) => {
                    visit(a0, RATE);
                    visit(a1, TIME);
                }
            }
            if let Some(Segment { from, to, thickness }) = &mut beam.segment {
                [from, to, thickness].into_iter().for_each(|number| visit(number, LENGTH));
            }
            if let Some([at, mass]) = &mut beam.lump {
                visit(at, LENGTH);
                visit(mass, MASS);
            }
            if let Some([stiffness, damping]) = &mut beam.foundation {
                visit(stiffness, PRESSURE);
                visit(damping, DAMPING_PER_LENGTH);
            }
            motion(&mut beam.motion, visit);
        }
        for block in &mut self.blocks {
            visit(&mut block.density, DENSITY);
            block.size.iter_mut().for_each(|side| visit(side, LENGTH));
            match &mut block.placement {
                Placement::Standing { at, tilt } => {
                    visit(at, LENGTH);
                    visit(tilt, NONE);
                }
                Placement::Flying { position, angle } => {
                    position.iter_mut().for_each(|x| visit(x, LENGTH));
                    visit(angle, NONE);
                }
            }
            block.velocity.iter_mut().for_each(|v| visit(v, VELOCITY));
            visit(&mut block.spin, RATE);
            if let Some([x, y, couple]) = &mut block.load {
                visit(x, FORCE);
                visit(y, FORCE);
                visit(couple, COUPLE);
            }
        }
        for contact in &mut self.contacts {
            visit(&mut contact.friction, NONE);
            match &mut contact.law {
                Law::Instant { normal, tangential, .. } => {
                    visit(normal, NONE);
                    visit(tangential, NONE);
                }
                Law::KelvinVoigt { stiffness, damping } => {
                    visit(stiffness, STIFFNESS);
                    visit(damping, DAMPING);
                }
                Law::HuntCrossley { stiffness, damping, exponent } => {
                    visit(stiffness, [1.0 - *exponent, 1.0, -2.0]);
                    visit(damping, [-1.0, 0.0, 1.0]);
                }
            }
        }
    }

    fn surface_name(&self, surface: Surface) -> &str {
        match surface {
            Surface::Ground => "ground",
            Surface::Beam(k) => &self.beams[k].name,
        }
    }

    fn signal_name(motion: Motion) -> String {
        match motion {
            Motion::Shaken(a) => format!("{{ acceleration = {}, signal = \"shake\" }}", pair(a, "m/s^2")),
            Motion::Travelling(v) => format!("{{ velocity = {} }}", pair(v, "m/s")),
        }
    }

    /// The scene file; every number reads back to the same double.
    pub(crate) fn to_toml(&self) -> String {
        let mut out = Lines::default();
        out.table("time");
        out.quantity("end", self.step * f64::from(self.steps), "s");
        out.quantity("step", self.step, "s");
        out.quantity("gap_tolerance", self.gap_tolerance, "m");
        match self.scheme {
            Scheme::Closed => out.word("scheme", "moreau-jean-closed"),
            Scheme::Located => out.word("scheme", "moreau-jean-located"),
            Scheme::Projected => out.word("scheme", "moreau-jean-projected"),
            Scheme::GeneralizedAlpha => out.word("scheme", "generalized-alpha"),
            Scheme::MoreauJean { theta, gamma } => {
                out.word("scheme", "moreau-jean");
                out.number("theta", theta);
                out.number("activation_gamma", gamma);
            }
        }
        out.table("world");
        out.line("gravity", &pair(self.gravity, "m/s^2"));
        out.table("signal.shake");
        out.word("shape", "harmonic");
        out.quantity("start", self.signal.start, "s");
        out.quantity("frequency", self.signal.frequency, "Hz");
        if let Some(ground) = &self.ground {
            out.table("ground");
            out.quantity("incline", ground.incline, "rad");
            if let Some(motion) = ground.motion {
                out.line("motion", &Self::signal_name(motion));
            }
        }
        self.beams.iter().for_each(|beam| beam.write(&mut out));
        for block in &self.blocks {
            self.write_block(block, &mut out);
        }
        for contact in &self.contacts {
            self.write_contact(contact, &mut out);
        }
        out.table("solver");
        out.word("method", self.method);
        out.number("tolerance", self.tolerance);
        out.0
    }

    fn write_block(&self, block: &Block, out: &mut Lines) {
        let name = &block.name;
        out.table(&format!("material.of-{name}"));
        out.quantity("density", block.density, "kg/m^3");
        out.table(&format!("block.{name}"));
        out.word("material", &format!("of-{name}"));
        for (key, side) in ["width", "height", "depth"].into_iter().zip(block.size) {
            out.quantity(key, side, "m");
        }
        match block.placement {
            Placement::Standing { at, tilt } => {
                out.word("on", self.surface_name(block.over));
                out.quantity("at", at, "m");
                out.quantity("tilt", tilt, "rad");
            }
            Placement::Flying { position, angle } => {
                out.line("position", &pair(position, "m"));
                out.quantity("angle", angle, "rad");
            }
        }
        out.line("velocity", &pair(block.velocity, "m/s"));
        out.quantity("spin", block.spin, "rad/s");
        if let Some([x, y, couple]) = block.load {
            out.table(&format!("force.on-{name}"));
            out.word("on", name);
            out.line("force", &pair([x, y], "N"));
            out.quantity("couple", couple, "N m");
            out.word("signal", "shake");
        }
    }

    fn write_contact(&self, contact: &Contact, out: &mut Lines) {
        out.table(&format!("contact.{}", contact.name));
        let [a, b] = [&self.blocks[contact.block].name, self.surface_name(contact.surface)];
        out.line("between", &format!("[\"{a}\", \"{b}\"]"));
        out.number("friction", contact.friction);
        out.word("kinematics", if contact.linear { "linear" } else { "deformed" });
        match contact.law {
            Law::Instant { word, normal, tangential } => {
                out.word("law", word);
                out.number("restitution", normal);
                out.number("tangential_restitution", tangential);
            }
            Law::KelvinVoigt { stiffness, damping } => {
                out.word("law", "kelvin-voigt");
                out.quantity("stiffness", stiffness, "N/m");
                out.quantity("damping", damping, "N s/m");
            }
            Law::HuntCrossley { stiffness, damping, exponent } => {
                out.word("law", "hunt-crossley");
                out.number("exponent", exponent);
                out.quantity("stiffness", stiffness, &format!("N/m^{exponent}"));
                out.quantity("damping", damping, "s/m");
            }
        }
    }
}

impl Beam {
    fn write(&self, out: &mut Lines) {
        let name = &self.name;
        out.table(&format!("material.of-{name}"));
        out.quantity("density", self.density, "kg/m^3");
        out.quantity("youngs_modulus", self.modulus, "Pa");
        out.number("poisson_ratio", 0.3);
        out.table(&format!("beam.{name}"));
        out.word("material", &format!("of-{name}"));
        out.line("position", &pair(self.position, "m"));
        for (key, length) in [("span", self.span), ("width", self.width), ("thickness", self.thickness)] {
            out.quantity(key, length, "m");
        }
        out.line("elements", &self.elements.to_string());
        out.word("theory", if self.timoshenko { "timoshenko" } else { "euler-bernoulli" });
        let [left, right] = self.supports.map(|support| match support {
            Support::Word(word) => format!("\"{word}\""),
            Support::Spring([spring, dashpot, rotational]) => format!(
                "{{ spring = \"{spring:e} N/m\", dashpot = \"{dashpot:e} N s/m\", rotational_spring = \"{rotational:e} N m/rad\" }}"
            ),
        });
        out.line("supports", &format!("[{left}, {right}]"));
        match self.damping {
            Damping::None => {}
            Damping::Ratio(ratio) => out.line("damping_ratio", &format!("{{ mode = 1, ratio = {ratio:e} }}")),
            Damping::Viscous(c) => out.quantity("viscous_damping", c, "N s/m^2"),
            Damping::Rayleigh([a0, a1]) => {
                out.line("rayleigh", &format!("{{ a0 = \"{a0:e} 1/s\", a1 = \"{a1:e} s\" }}"));
            }
        }
        out.word("surface", if self.top { "top" } else { "axis" });
        out.word("start", if self.static_start { "static" } else { "undeformed" });
        out.line("self_weight", &self.self_weight.to_string());
        if let Some(count) = self.modes {
            out.word("model", "modes");
            out.line("modes", &format!("{{ count = {count} }}"));
        }
        if let Some(motion) = self.motion {
            out.line("motion", &Drawn::signal_name(motion));
        }
        if let Some(Segment { from, to, thickness }) = self.segment {
            out.table(&format!("beam.{name}.segment.part"));
            for (key, length) in [("from", from), ("to", to), ("width", self.width), ("thickness", thickness)] {
                out.quantity(key, length, "m");
            }
        }
        if let Some([at, mass]) = self.lump {
            out.table(&format!("beam.{name}.mass.lump"));
            out.quantity("at", at, "m");
            out.quantity("mass", mass, "kg");
        }
        if let Some([stiffness, damping]) = self.foundation {
            out.table(&format!("beam.{name}.foundation.bed"));
            out.quantity("stiffness", stiffness, "N/m^2");
            out.quantity("damping", damping, "N s/m^2");
        }
    }
}

fn pair([x, y]: [f64; 2], unit: &str) -> String {
    format!("[\"{x:e} {unit}\", \"{y:e} {unit}\"]")
}

/// The lines of a scene file.
#[derive(Default)]
struct Lines(String);

impl Lines {
    fn table(&mut self, name: &str) {
        let gap = if self.0.is_empty() { "" } else { "\n" };
        self.0.push_str(&format!("{gap}[{name}]\n"));
    }

    fn line(&mut self, key: &str, value: &str) {
        self.0.push_str(&format!("{key} = {value}\n"));
    }

    fn word(&mut self, key: &str, word: &str) {
        self.line(key, &format!("\"{word}\""));
    }

    /// Debug writes a point or an exponent, which TOML wants of a float.
    fn number(&mut self, key: &str, number: f64) {
        self.line(key, &format!("{number:?}"));
    }

    fn quantity(&mut self, key: &str, number: f64, unit: &str) {
        self.line(key, &format!("\"{number:e} {unit}\""));
    }
}
