//! The entries of the table of keys. See [`crate::keys`] for what the columns mean.

use std::f64::consts::FRAC_PI_2;

use crate::dimension::Dimension;
use crate::keys::{Bound, Key, Kind, Occurrence, OnlyWith, Presence, Range, Reserved, Table};
use crate::measure::{CONTACT_DAMPING, CONTACT_STIFFNESS};

const fn key(name: &'static str, kind: Kind, presence: Presence, example: &'static str, doc: &'static str) -> Key {
    Key { name, kind, presence, reserved: &[], example, doc, bytes_each: 0, only_with: None }
}

impl Key {
    const fn reserving(mut self, reserved: &'static [Reserved]) -> Self {
        self.reserved = reserved;
        self
    }

    const fn only_with(mut self, sibling: &'static str, words: &'static [&'static str]) -> Self {
        self.only_with = Some(OnlyWith { sibling, words });
        self
    }

    const fn taking(mut self, bytes_each: u64) -> Self {
        self.bytes_each = bytes_each;
        self
    }
}

/// A word whose place will be taken by the words that are built in.
const fn later(value: &'static str) -> Reserved {
    Reserved { value, instead: "" }
}

const QUARTER_TURN: Range = Range::new(Bound::Closed(-FRAC_PI_2), Bound::Closed(FRAC_PI_2));
/// Steeper ground is a wall.
const INCLINE: Range = Range::new(Bound::Closed(-MAX_INCLINE), Bound::Closed(MAX_INCLINE));
const MAX_INCLINE: f64 = 80.0 * FRAC_PI_2 / 90.0;
const EXPONENT: Range = Range::new(Bound::Closed(1.0), Bound::Closed(10.0));
const OSCILLATING: &[&str] = &["harmonic", "one-sine", "ricker"];
const DURATION: Range = Range::POSITIVE.sizes(1e-15, 1e12);
const MODULUS: Range = Range::POSITIVE.sizes(1e-12, 1e18);
/// More leave no correct digit in double precision.
const MAX_ELEMENTS: i64 = teeter_beam::MAX_ELEMENTS as i64;
/// Memory of an element, measured with 10 000 of them: matrices, factors, state.
const ELEMENT_BYTES: u64 = 1000;
/// Scales with the blocks, down to 1e-11 of the smallest side allowed.
const GAP: Range = Range::NOT_NEGATIVE.sizes(1e-30, 1e12);

use Presence::{Default, DefaultWith, NotYet, Optional, Required};

const SIZE: Kind = Kind::Quantity(Dimension::LENGTH, Range::POSITIVE);
const TIME: Kind = Kind::Quantity(Dimension::TIME, DURATION);
const INSTANT: Kind = Kind::Quantity(Dimension::TIME, Range::ANY);
const ANGLE: Kind = Kind::Quantity(Dimension::ANGLE, Range::ANY);
const POINT: Kind = Kind::Pair(Dimension::LENGTH, Range::ANY);

/// The laws of contacts: of an instant, and with duration.
const IMPACTS: &[&str] = &["newton", "poisson", "energetic"];
const COMPLIANT: &[&str] = &["kelvin-voigt", "hunt-crossley"];

const SIGNAL: Key = key(
    "signal",
    Kind::Name,
    Optional,
    "\"shake\"",
    "Name of the signal that it is multiplied by; when left out, it is constant.",
);
const SIGNALS: Key = key(
    "signals",
    Kind::NamePair,
    Optional,
    "[\"east\", \"up\"]",
    "Names of two signals, for x and for y, in place of one for both.",
);
const DISPLACEMENT: Key = key("displacement", POINT, Optional, "[\"5 mm\", \"0 m\"]", "Amplitude of the displacement.");
const VELOCITY: Key = key(
    "velocity",
    Kind::Pair(Dimension::VELOCITY, Range::ANY),
    Optional,
    "[\"0.1 m/s\", \"0 m/s\"]",
    "Amplitude of the velocity; the displacement starts at 0.",
);
const ACCELERATION: Key = key(
    "acceleration",
    Kind::Pair(Dimension::ACCELERATION, Range::ANY),
    Optional,
    "[\"3 m/s^2\", \"0 m/s^2\"]",
    "Amplitude of the acceleration; velocity and displacement start at 0.",
);
const TURN: Key = key("angle", ANGLE, Optional, "\"2 deg\"", "Amplitude of the turn, counter-clockwise positive.");
const TURN_VELOCITY: Key = key(
    "angular_velocity",
    Kind::Quantity(Dimension::ANGULAR_VELOCITY, Range::ANY),
    Optional,
    "\"1 rad/s\"",
    "Amplitude of the angular velocity; the turn starts at 0.",
);
const TURN_ACCELERATION: Key = key(
    "angular_acceleration",
    Kind::Quantity(Dimension::ANGULAR_ACCELERATION, Range::ANY),
    Optional,
    "\"5 rad/s^2\"",
    "Amplitude of the angular acceleration; angular velocity and turn start at 0.",
);

/// All tables of a scene in the order in which they are written out.
#[rustfmt::skip] // a row per key
pub static TABLES: &[Table] = &[
    Table {
        pattern: "",
        occurrence: Occurrence::Always,
        doc: "The scene itself.",
        keys: &[
            key("title", Kind::Text, Optional, "\"Rocking block\"", "Name of the scene; when left out, the stem of the file's name."),
            key("version", Kind::Version(&[1]), Default("1"), "1", "Version of the scene format."),
        ],
    },
    Table {
        pattern: "time",
        occurrence: Occurrence::Always,
        doc: "How long to simulate, in which steps, by which scheme.",
        keys: &[
            key("end", TIME, Required, "\"0.5 s\"", "Simulated time; the run ends with the first step at or past it."),
            key("step", TIME, Required, "\"100 us\"", "Size of the time step.").reserving(&[Reserved { value: "auto", instead: "give a step, such as \"100 us\"" }]),
            key("accuracy", Kind::Number(Range::INSIDE_UNIT), NotYet, "1e-3", "Largest relative error allowed, in place of a step."),
            key("scheme", Kind::Choice(&["moreau-jean", "moreau-jean-closed"]), Default("\"moreau-jean\""), "\"moreau-jean\"", "Time integration scheme; in moreau-jean-closed a contact stays closed until it pulls, and no contact gives energy.").reserving(&[later("moreau-jean-located"), later("moreau-jean-projected"), later("generalized-alpha"), later("event-driven")]),
            key("theta", Kind::Number(Range::UNIT), Default("0.5"), "0.5", "Weight of the end of the step in the theta method: 0.5 keeps energy, 1 damps the most; moreau-jean-closed takes 0.5 only."),
            key("gap_tolerance", Kind::Quantity(Dimension::LENGTH, GAP), Optional, "\"1e-12 m\"", "Gap below which a contact counts as closed; when left out, it follows from the largest block side."),
            key("activation_gamma", Kind::Number(Range::UNIT), Default("0.5"), "0.5", "Fraction of the step by which positions are predicted to find the active contacts; of moreau-jean only."),
            key("allow_conditional_stability", Kind::Flag, Default("false"), "false", "Allows theta below 0.5, where the step must be short enough to be stable."),
            key("spectral_radius", Kind::Number(Range::UNIT), NotYet, "0.8", "Damping of the highest frequencies in the generalized-alpha scheme."),
        ],
    },
    Table {
        pattern: "world",
        occurrence: Occurrence::Always,
        doc: "What holds everywhere.",
        keys: &[key("gravity", Kind::Gravity, Default("\"9.81 m/s^2\""), "\"9.81 m/s^2\"", "Acceleration of gravity downwards, or as a vector [x, y].")],
    },
    Table {
        pattern: "material.*",
        occurrence: Occurrence::Named,
        doc: "A material of blocks and beams.",
        keys: &[
            key("density", Kind::Quantity(Dimension::DENSITY, Range::POSITIVE), Required, "\"2700 kg/m^3\"", "Mass per volume."),
            key("youngs_modulus", Kind::Quantity(Dimension::PRESSURE, MODULUS), Optional, "\"69 GPa\"", "Young's modulus; a beam needs it, a rigid block does not."),
        ],
    },
    Table {
        pattern: "ground",
        occurrence: Occurrence::Optional,
        doc: "Rigid ground, flat at y = 0 or inclined through the origin; its name in contacts is `ground`.",
        keys: &[
            key("incline", Kind::Quantity(Dimension::ANGLE, INCLINE), Default("\"0 deg\""), "\"10 deg\"", "Slope of the ground, which goes through the origin; counter-clockwise positive, so uphill to the right."),
            key("profile", Kind::Text, NotYet, "\"profile.csv\"", "File with the heights of the ground."),
        ],
    },
    Table {
        pattern: "ground.motion",
        occurrence: Occurrence::Inline,
        doc: "Prescribed motion of the ground: a displacement, a velocity or an acceleration, a turn about the point that is the origin when nothing is displaced, or both.",
        keys: &[DISPLACEMENT, VELOCITY, ACCELERATION, TURN, TURN_VELOCITY, TURN_ACCELERATION, SIGNAL, SIGNALS],
    },
    Table {
        pattern: "beam.*",
        occurrence: Occurrence::Named,
        doc: "An elastic beam of rectangular section.",
        keys: &[
            key("material", Kind::Name, Required, "\"aluminium\"", "Name of its material."),
            key("span", SIZE, Required, "\"36 cm\"", "Length between its ends."),
            key("width", SIZE, Required, "\"3 cm\"", "Side of its section out of the plane."),
            key("thickness", SIZE, Required, "\"1.5 mm\"", "Side of its section in the plane."),
            key("elements", Kind::Integer { min: 1, max: MAX_ELEMENTS }, Required, "20", "Number of finite elements.").taking(ELEMENT_BYTES),
            key("supports", Kind::ChoicePair(&["pinned", "clamped", "free"]), Default("[\"pinned\", \"pinned\"]"), "[\"pinned\", \"pinned\"]", "How its left and right ends are held.").reserving(&[later("guided"), later("spring"), later("rotational_spring")]),
            key("viscous_damping", Kind::Quantity(Dimension::DAMPING_PER_LENGTH, Range::NOT_NEGATIVE), Optional, "\"0.4 N s/m^2\"", "Coefficient c of the viscous term of the beam equation; one of the three ways to give damping."),
            key("start", Kind::Choice(&["undeformed", "static"]), Default("\"undeformed\""), "\"static\"", "Shape at the start: undeformed, or in equilibrium under the blocks and the loads of t = 0; flat blocks follow it, tilted ones are held as placed."),
            key("surface", Kind::Choice(&["axis", "top"]), Default("\"axis\""), "\"axis\"", "Where contacts lie: on the axis, or half a thickness above it."),
            key("position", POINT, Default("[\"0 m\", \"0 m\"]"), "[\"0 m\", \"0 m\"]", "Where its left end is, x and y."),
            key("self_weight", Kind::Flag, Default("false"), "false", "Whether gravity acts on the beam itself.").reserving(&[Reserved { value: "true", instead: "leave it out or write false: gravity does not act on beams" }]),
            key("probes", Kind::List(Dimension::LENGTH, Range::NOT_NEGATIVE), Optional, "[\"9 cm\"]", "Places along the beam, from its left end, whose deflection is written out."),
        ],
    },
    Table {
        pattern: "beam.*.damping_ratio",
        occurrence: Occurrence::Inline,
        doc: "Viscous damping given by the damping ratio of one mode; one of the three ways to give damping.",
        keys: &[
            key("mode", Kind::Integer { min: 1, max: 100_000 }, Required, "1", "Number of the mode, from 1."),
            key("ratio", Kind::Number(Range::NOT_NEGATIVE), Required, "0.01", "Damping over critical damping in that mode."),
        ],
    },
    Table {
        pattern: "beam.*.rayleigh",
        occurrence: Occurrence::Inline,
        doc: "Rayleigh damping, C = a0 M + a1 K; one of the three ways to give damping.",
        keys: &[
            key("a0", Kind::Quantity(Dimension::RATE, Range::NOT_NEGATIVE), Default("\"0 1/s\""), "\"0.5 1/s\"", "Factor of the mass matrix."),
            key("a1", Kind::Quantity(Dimension::TIME, Range::NOT_NEGATIVE), Default("\"0 s\""), "\"10 us\"", "Factor of the stiffness matrix."),
        ],
    },
    Table {
        pattern: "beam.*.motion",
        occurrence: Occurrence::Inline,
        doc: "Prescribed motion of its supports, which move together; damping acts on the motion relative to them.",
        keys: &[DISPLACEMENT, VELOCITY, ACCELERATION, SIGNAL, SIGNALS],
    },
    Table {
        pattern: "block.*",
        occurrence: Occurrence::Named,
        doc: "A rigid rectangular block.",
        keys: &[
            key("material", Kind::Name, Required, "\"aluminium\"", "Name of its material."),
            key("width", SIZE, Required, "\"3 cm\"", "Side along its base."),
            key("height", SIZE, Required, "\"13.5 cm\"", "Side upwards."),
            key("depth", SIZE, Required, "\"3 cm\"", "Side out of the plane."),
            key("on", Kind::Name, Optional, "\"table\"", "What it stands on: a beam, another block, or \"ground\"."),
            key("at", Kind::Quantity(Dimension::LENGTH, Range::ANY), Optional, "\"18 cm\"", "Place x, in the world, of the middle of its base before it is tilted."),
            key("tilt", Kind::Quantity(Dimension::ANGLE, QUARTER_TURN), DefaultWith { sibling: "on", value: "\"0 deg\"" }, "\"5 deg\"", "Turn about the corner that it stays on, counter-clockwise positive."),
            key("position", POINT, Optional, "[\"18 cm\", \"6.75 cm\"]", "Place of its mass centre, in place of on and at."),
            key("angle", Kind::Quantity(Dimension::ANGLE, QUARTER_TURN), DefaultWith { sibling: "position", value: "\"0 deg\"" }, "\"5 deg\"", "Turn about its mass centre, counter-clockwise positive; goes with position."),
            key("velocity", Kind::Pair(Dimension::VELOCITY, Range::ANY), Default("[\"0 m/s\", \"0 m/s\"]"), "[\"0.1 m/s\", \"0 m/s\"]", "Velocity of its mass centre at the start."),
            key("spin", Kind::Quantity(Dimension::ANGULAR_VELOCITY, Range::ANY), Default("\"0 rad/s\""), "\"1 rad/s\"", "Angular velocity at the start, counter-clockwise positive."),
        ],
    },
    Table {
        pattern: "block.*.motion",
        occurrence: Occurrence::Inline,
        doc: "Prescribed motion of the block: of its mass centre, of its angle, or both; what is not named stays free. It starts where the block is placed.",
        keys: &[
            DISPLACEMENT, VELOCITY, ACCELERATION,
            key("only", Kind::Choice(&["x", "y"]), Optional, "\"x\"", "The one direction of the mass centre that is prescribed; the other stays free. When left out, both are prescribed."),
            TURN, TURN_VELOCITY, TURN_ACCELERATION, SIGNAL, SIGNALS,
        ],
    },
    Table {
        pattern: "contact.*",
        occurrence: Occurrence::Named,
        doc: "Contact between two bodies, with impact and friction.",
        keys: &[
            key("between", Kind::NamePair, Required, "[\"rocker\", \"table\"]", "The two bodies."),
            key("friction", Kind::Number(Range::NOT_NEGATIVE), Required, "0.5", "Coefficient of Coulomb friction."),
            key("restitution", Kind::Number(Range::UNIT), Default("0.0"), "0.0", "Coefficient of restitution: of the normal velocity, or with poisson of the normal impulse.").only_with("law", IMPACTS),
            key("tangential_restitution", Kind::Number(Range::UNIT), Default("0.0"), "0.0", "Part of the tangential velocity that comes back from an impact that does not slide.").only_with("law", IMPACTS),
            key("kinematics", Kind::Choice(&["deformed", "linear"]), Default("\"deformed\""), "\"deformed\"", "Whether contact frames follow the deformed beam or its undeformed axis."),
            key("law", Kind::Choice(&["newton", "poisson", "energetic", "kelvin-voigt", "hunt-crossley"]), Default("\"newton\""), "\"newton\"", "Law along the normal: an impact in an instant (newton, poisson, energetic), or a contact with duration (kelvin-voigt, hunt-crossley)."),
            key("stiffness", Kind::Measure(CONTACT_STIFFNESS, Range::POSITIVE.sizes(1e-12, 1e18)), Required, "\"1e6 N/m\"", "Stiffness k. In F = k d^n (hunt-crossley) its unit is N/m^n; N/m stands for that too, with the same number.").only_with("law", COMPLIANT),
            key("damping", Kind::Measure(CONTACT_DAMPING, Range::NOT_NEGATIVE), Required, "\"10 N s/m\"", "Damping: with kelvin-voigt c in N s/m; with hunt-crossley, in F = k d^n (1 + D v), D in s/m, or c = k D in N s/m^(n+1), for which N s/m stands too.").only_with("law", COMPLIANT),
            key("exponent", Kind::Number(EXPONENT), Default("1.5"), "1.5", "Exponent n of the force: 1.5 is that of two spheres.").only_with("law", &["hunt-crossley"]),
        ],
    },
    Table {
        pattern: "signal.*",
        occurrence: Occurrence::Named,
        doc: "A time history without unit, with a peak of 1 if by formula: what it is used for gives the amplitude. Formulas and integrals: `docs/signals.md`.",
        keys: &[
            key("shape", Kind::Choice(&["constant", "ramp", "harmonic", "one-sine", "half-sine", "ricker", "table"]), Required, "\"one-sine\"", "What it looks like."),
            key("start", INSTANT, Default("\"0 s\""), "\"0.1 s\"", "When it starts: it is 0 before; the times of a table count from it.").only_with("shape", &["constant", "ramp", "harmonic", "one-sine", "half-sine", "table"]),
            key("peak", INSTANT, Required, "\"0.5 s\"", "When a Ricker wavelet has its peak.").only_with("shape", &["ricker"]),
            key("duration", TIME, Required, "\"0.2 s\"", "How long a ramp takes to reach 1, or a half sine lasts.").only_with("shape", &["ramp", "half-sine"]),
            key("frequency", Kind::Quantity(Dimension::RATE, Range::POSITIVE), Optional, "\"2 Hz\"", "Cycles per second; of a Ricker wavelet the peak of its spectrum. Or give the period.").only_with("shape", OSCILLATING),
            key("period", TIME, Optional, "\"0.5 s\"", "Time of a cycle, in place of the frequency.").only_with("shape", OSCILLATING),
            key("phase", ANGLE, Default("\"0 deg\""), "\"20 deg\"", "Argument of the sine at the start.").only_with("shape", &["harmonic", "one-sine"]),
            key("file", Kind::Path, Required, "\"quake.csv\"", "File of two columns, time in s and value; relative to the scene's file.").only_with("shape", &["table"]),
        ],
    },
    Table {
        pattern: "force.*",
        occurrence: Occurrence::Named,
        doc: "A force or couple on a block.",
        keys: &[
            key("on", Kind::Name, Required, "\"rocker\"", "The block."),
            key("force", Kind::Pair(Dimension::FORCE, Range::ANY), Optional, "[\"5 N\", \"0 N\"]", "Force through its mass centre, x and y of the world."),
            key("couple", Kind::Quantity(Dimension::ENERGY, Range::ANY), Optional, "\"1 N m\"", "Couple, counter-clockwise positive; a force beside the mass centre is the force through it and a couple."),
            SIGNAL,
        ],
    },
    Table {
        pattern: "load.*",
        occurrence: Occurrence::Named,
        doc: "A load on a beam: at a point, or the same all along it.",
        keys: &[
            key("on", Kind::Name, Required, "\"table\"", "The beam."),
            key("at", Kind::Quantity(Dimension::LENGTH, Range::NOT_NEGATIVE), Optional, "\"9 cm\"", "Place along the beam, from its left end, of force and couple."),
            key("force", Kind::Quantity(Dimension::FORCE, Range::ANY), Optional, "\"-10 N\"", "Force at that place, upwards positive."),
            key("couple", Kind::Quantity(Dimension::ENERGY, Range::ANY), Optional, "\"0.1 N m\"", "Couple at that place, counter-clockwise positive."),
            key("distributed", Kind::Quantity(Dimension::STIFFNESS, Range::ANY), Optional, "\"-10 N/m\"", "Force per length all along the beam, upwards positive; in place of at, force and couple."),
            SIGNAL,
        ],
    },
    Table {
        pattern: "solver",
        occurrence: Occurrence::Always,
        doc: "How the contact problem of a step is solved.",
        keys: &[
            key("method", Kind::Choice(&["auto", "pgs", "enumeration"]), Default("\"auto\""), "\"auto\"", "Name of a contact solver; auto takes the one that fits the step.").reserving(&[later("newton"), later("socp")]),
            key("tolerance", Kind::Number(Range::INSIDE_UNIT), Default("1e-10"), "1e-10", "Relative residual at which a step counts as solved."),
            key("max_iterations", Kind::Integer { min: 1, max: 4_294_967_295 }, Default("10000"), "10000", "Iterations after which a solver gives up on a step."),
            key("require_convergence", Kind::Flag, Default("false"), "false", "Whether a step that is not solved ends the run."),
        ],
    },
    Table {
        pattern: "output",
        occurrence: Occurrence::Always,
        doc: "What is written.",
        keys: &[key("every", TIME, Optional, "\"1 ms\"", "Time between rows; when left out, every step up to 10 000 rows, thinned evenly past that.")],
    },
];
