//! The entries of the table of keys. See [`crate::keys`] for what the columns mean.

use std::f64::consts::FRAC_PI_2;

use crate::dimension::Dimension;
use crate::keys::{Bound, Key, Kind, Occurrence, Presence, Range, Reserved, Table};

const fn key(name: &'static str, kind: Kind, presence: Presence, example: &'static str, doc: &'static str) -> Key {
    Key { name, kind, presence, reserved: &[], example, doc, bytes_each: 0 }
}

impl Key {
    const fn reserving(mut self, reserved: &'static [Reserved]) -> Self {
        self.reserved = reserved;
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
const POINT: Kind = Kind::Pair(Dimension::LENGTH, Range::ANY);

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
            key("scheme", Kind::Choice(&["moreau-jean"]), Default("\"moreau-jean\""), "\"moreau-jean\"", "Time integration scheme.").reserving(&[later("moreau-jean-closed"), later("moreau-jean-located"), later("moreau-jean-projected"), later("generalized-alpha"), later("event-driven")]),
            key("theta", Kind::Number(Range::UNIT), Default("0.5"), "0.5", "Weight of the end of the step in the theta method: 0.5 keeps energy, 1 damps the most."),
            key("gap_tolerance", Kind::Quantity(Dimension::LENGTH, GAP), Optional, "\"1e-12 m\"", "Gap below which a contact counts as closed; when left out, it follows from the largest block side."),
            key("activation_gamma", Kind::Number(Range::UNIT), Default("0.5"), "0.5", "Fraction of the step by which positions are predicted to find the active contacts."),
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
        doc: "Rigid ground, flat at y = 0; its name in contacts is `ground`.",
        keys: &[
            key("incline", Kind::Quantity(Dimension::ANGLE, QUARTER_TURN), NotYet, "\"10 deg\"", "Slope of the ground."),
            key("profile", Kind::Text, NotYet, "\"profile.csv\"", "File with the heights of the ground."),
            key("motion", Kind::Text, NotYet, "\"motion.csv\"", "File with the motion of the ground."),
        ],
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
            key("start", Kind::Choice(&["undeformed", "static"]), Default("\"undeformed\""), "\"static\"", "Shape at the start: undeformed, or in equilibrium under the blocks held as placed."),
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
        pattern: "contact.*",
        occurrence: Occurrence::Named,
        doc: "Contact between two bodies, with impact and friction.",
        keys: &[
            key("between", Kind::NamePair, Required, "[\"rocker\", \"table\"]", "The two bodies."),
            key("friction", Kind::Number(Range::NOT_NEGATIVE), Required, "0.5", "Coefficient of Coulomb friction."),
            key("restitution", Kind::Number(Range::UNIT), Default("0.0"), "0.0", "Coefficient of restitution of the normal velocity."),
            key("kinematics", Kind::Choice(&["deformed", "linear"]), Default("\"deformed\""), "\"deformed\"", "Whether contact frames follow the deformed beam or its undeformed axis."),
            key("law", Kind::Choice(&["newton"]), Default("\"newton\""), "\"newton\"", "Law of impact.").reserving(&[later("poisson"), later("energetic"), later("kelvin-voigt"), later("hunt-crossley")]),
            key("stiffness", Kind::Quantity(Dimension::STIFFNESS, Range::POSITIVE), NotYet, "\"1e6 N/m\"", "Stiffness of a compliant contact law."),
            key("damping", Kind::Quantity(Dimension::DAMPING, Range::NOT_NEGATIVE), NotYet, "\"10 N s/m\"", "Damping of a compliant contact law."),
            key("exponent", Kind::Number(Range::POSITIVE), NotYet, "1.5", "Exponent of the Hunt-Crossley law."),
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
