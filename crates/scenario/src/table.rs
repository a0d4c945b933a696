//! The entries of the table of keys. See [`crate::keys`] for what the columns mean.

mod beam_keys;

use std::f64::consts::FRAC_PI_2;

use crate::dimension::Dimension;
use crate::keys::{Bound, Key, Kind, Occurrence, Presence, Range, TableSchema};
use crate::measure::AllowedUnit;
use crate::words;
use beam_keys::*;

const fn key(name: &'static str, kind: Kind, presence: Presence, example: &'static str, doc: &'static str) -> Key {
    Key::new(name, kind, presence, example, doc)
}

const QUARTER_TURN: Range = Range::new(Bound::Closed(-FRAC_PI_2), Bound::Closed(FRAC_PI_2));
/// Steeper ground is a wall.
const INCLINE: Range = Range::new(Bound::Closed(-MAX_INCLINE), Bound::Closed(MAX_INCLINE));
const MAX_INCLINE: f64 = 80.0 * FRAC_PI_2 / 90.0;
const POISSON_RATIO: Range = Range::new(Bound::Open(-1.0), Bound::Closed(0.5));
const GRADING: Range = Range::new(Bound::Closed(1.0), Bound::Closed(1000.0));
/// Below it the flexibilities that are compared have no digits.
const FLEXIBILITY: Range = Range::new(Bound::Closed(1e-8), Bound::Open(1.0));
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

use Presence::{Default, DefaultWith, DefaultWithout, NotYet, Optional, Required, RequiredWithout};

const SIZE: Kind = Kind::Quantity(Dimension::LENGTH, Range::POSITIVE);
const TIME: Kind = Kind::Quantity(Dimension::TIME, DURATION);
const INSTANT: Kind = Kind::Quantity(Dimension::TIME, Range::ANY);
const ANGLE: Kind = Kind::Quantity(Dimension::ANGLE, Range::ANY);
const POINT: Kind = Kind::Pair(Dimension::LENGTH, Range::ANY);

/// The laws of contacts: of an instant, and with duration.
const IMPACTS: &[&str] = &["newton", "poisson", "energetic"];
const COMPLIANT: &[&str] = &["kelvin-voigt", "hunt-crossley"];

/// Stiffness and damping of a contact with duration: their units hold the exponent of the force.
const CONTACT_STIFFNESS: &[AllowedUnit] =
    &[AllowedUnit::new(Dimension::STIFFNESS, "N/m"), AllowedUnit::over_powers_of_metre(Dimension::FORCE, "N/m^n")];
const CONTACT_DAMPING: &[AllowedUnit] = &[
    AllowedUnit::new(Dimension::DAMPING, "N s/m"),
    AllowedUnit::new(Dimension::INVERSE_VELOCITY, "s/m"),
    AllowedUnit::over_powers_of_metre(Dimension::IMPULSE, "N s/m^(n+1)"),
];

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
pub static TABLES: &[TableSchema] = &[
    TableSchema {
        pattern: "",
        occurrence: Occurrence::Always,
        doc: "The scene itself.",
        keys: &[
            key("title", Kind::Text, Optional, "\"Rocking block\"", "Name of the scene; when left out, the stem of the file's name."),
            key("version", Kind::Version(&[1]), Default("1"), "1", "Version of the scene format."),
        ],
    },
    TableSchema {
        pattern: "time",
        occurrence: Occurrence::Always,
        doc: "How long to simulate, in which steps, by which scheme.",
        keys: &[
            key("end", TIME, Required, "\"0.5 s\"", "Simulated time; the run ends with the first step at or past it."),
            key("step", TIME, RequiredWithout("accuracy"), "\"100 us\"", "Size of the time step; with auto, or left out, it is the longest that is found to reach the accuracy.").left_out_as("auto"),
            key("accuracy", Kind::Number(Range::INSIDE_UNIT), Optional, "1e-3", "In place of a step: the largest error of any angle, relative to the largest angle, and of any place, relative to the block's larger side, before the horizon."),
            key("scheme", Kind::Choice(words::SCHEMES), Default("\"auto\""), "\"moreau-jean\"", "Time integration scheme; auto takes moreau-jean-located, but moreau-jean where theta, gap_tolerance or activation_gamma is given, and moreau-jean-closed for more than 8 blocks or a beam held along its axis. In moreau-jean-closed a contact stays closed until it pulls, and no contact gives energy; moreau-jean-located also divides a step where a contact closes. event-driven takes steps of its own between located events, to rounding; the step is then that of the output. moreau-jean-projected is the closed one with places projected, so that nothing ends a step in a surface; generalized-alpha does that, too, and damps vibrations of beams that the step can't resolve. resolved takes contact with beams as a force, without restitution there, in steps that are halved where contacts close."),
            key("theta", Kind::Number(Range::UNIT), Default("0.5"), "0.5", "Weight of the end of the step in the theta method: 0.5 keeps energy, 1 damps the most; moreau-jean-closed, moreau-jean-located, moreau-jean-projected and resolved take 0.5 only, event-driven and generalized-alpha none."),
            key("gap_tolerance", Kind::Quantity(Dimension::LENGTH, GAP), Optional, "\"1e-12 m\"", "Gap below which a contact counts as closed, at most 1e-3 of the shortest block side; when left out, it follows from the largest block side."),
            key("activation_gamma", Kind::Number(Range::UNIT), Default("0.5"), "0.5", "Fraction of the step by which positions are predicted to find the active contacts; of moreau-jean only."),
            key("allow_conditional_stability", Kind::Flag, Default("false"), "false", "Allows theta below 0.5, where the step must be short enough to be stable."),
            key("spectral_radius", Kind::Number(Range::UNIT), Optional, "0.8", "Part of a vibration of infinite frequency that a step of generalized-alpha leaves: 1 damps nothing, 0 the most; when left out, 0.8. Of generalized-alpha only."),
        ],
    },
    TableSchema {
        pattern: "world",
        occurrence: Occurrence::Always,
        doc: "What holds everywhere.",
        keys: &[key("gravity", Kind::Downward(Dimension::ACCELERATION), Default("\"9.81 m/s^2\""), "\"9.81 m/s^2\"", "Acceleration of gravity downwards, or as a vector [x, y].")],
    },
    TableSchema {
        pattern: "material.*",
        occurrence: Occurrence::Named,
        doc: "A material of blocks and beams.",
        keys: &[
            key("density", Kind::Quantity(Dimension::DENSITY, Range::POSITIVE), Required, "\"2700 kg/m^3\"", "Mass per volume."),
            key("youngs_modulus", Kind::Quantity(Dimension::PRESSURE, MODULUS), Optional, "\"69 GPa\"", "Young's modulus; a beam needs it, a rigid block does not."),
            key("poisson_ratio", Kind::Number(POISSON_RATIO), Optional, "0.33", "Poisson's ratio; a beam with theory = timoshenko needs it."),
            key("yield_strength", Kind::Quantity(Dimension::PRESSURE, MODULUS), Optional, "\"240 MPa\"", "Stress at which it yields; `check` tells the bending moment at which a beam of it begins to, and a run warns where it is passed."),
        ],
    },
    TableSchema {
        pattern: "ground",
        occurrence: Occurrence::Optional,
        doc: "Rigid ground, flat at y = 0 or inclined through the origin; its name in contacts is `ground`.",
        keys: &[
            key("incline", Kind::Quantity(Dimension::ANGLE, INCLINE), Default("\"0 deg\""), "\"10 deg\"", "Slope of the ground, which goes through the origin; counter-clockwise positive, so uphill to the right."),
            key("profile", Kind::Text, NotYet, "\"profile.csv\"", "File with the heights of the ground."),
        ],
    },
    TableSchema {
        pattern: "ground.motion",
        occurrence: Occurrence::Inline,
        doc: "Prescribed motion of the ground: a displacement, a velocity or an acceleration, a turn about the point that is the origin when nothing is displaced, or both.",
        keys: &[DISPLACEMENT, VELOCITY, ACCELERATION, TURN, TURN_VELOCITY, TURN_ACCELERATION, SIGNAL, SIGNALS],
    },
    TableSchema {
        pattern: "beam.*",
        occurrence: Occurrence::Named,
        doc: "An elastic beam, straight and level.",
        keys: &[
            SECTION,
            key("material", Kind::Name, Required, "\"aluminium\"", "Name of its material.").only_with("section", PROFILES),
            key("span", SIZE, Required, "\"36 cm\"", "Length between its ends."),
            WIDTH, THICKNESS, DIAMETER, WALL, HEIGHT, WEB, FLANGE,
            BENDING_STIFFNESS, MASS_PER_LENGTH, SHEAR_STIFFNESS, ROTATORY_INERTIA, AXIAL_STIFFNESS,
            key("theory", Kind::Choice(words::Theory::WORDS), Default("\"euler-bernoulli\""), "\"timoshenko\"", "Whether its sections stay normal to the axis, or shear and rotatory inertia count; a thickness over a tenth of the span calls for timoshenko."),
            key("elements", Kind::Integer { min: 1, max: MAX_ELEMENTS }, RequiredWithout("nodes"), "20", "Number of finite elements; supports between the ends, masses, and ends of segments and foundations may add a few.").taking(ELEMENT_BYTES),
            key("nodes", Kind::List(Dimension::LENGTH, Range::NOT_NEGATIVE), Optional, "[\"0 cm\", \"10 cm\", \"36 cm\"]", "Places of its nodes, rising from 0 to the span, in place of elements."),
            key("supports", Kind::WordOrTablePair(SUPPORTS, SUPPORT_KEYS), Default("[\"pinned\", \"pinned\"]"), "[\"pinned\", { spring = \"1 kN/m\" }]", "How its left and right ends are held."),
            key("axial", Kind::Choice(words::Along::WORDS), Default("\"free\""), "\"held\"", "Along the axis: free, no axial motion is modelled; held, both ends are, and a deflection stretches the beam (von Karman; theta = 0.5 only); elastic, axial motion with its inertia, which doesn't feel the deflection."),
            key("axial_supports", Kind::ChoicePair(&["held", "free"]), Default("[\"held\", \"held\"]"), "[\"held\", \"free\"]", "Whether its left and right ends are held along the axis.").only_with("axial", &["elastic"]),
            key("axial_force", Kind::Quantity(Dimension::FORCE, Range::ANY), Default("\"0 N\""), "\"100 N\"", "Axial force that is there whatever the beam does, tension positive; less than the buckling load."),
            key("viscous_damping", Kind::Quantity(Dimension::DAMPING_PER_LENGTH, Range::NOT_NEGATIVE), Optional, "\"0.4 N s/m^2\"", "Coefficient c of the viscous term of the beam equation, which damps high modes ever less; one of the three ways to give damping."),
            key("modal_damping", Kind::Numbers(Range::NOT_NEGATIVE), Optional, "[0.01, 0.02]", "Damping ratios of the first elastic modes of the finite elements, on top of the rest; other modes are left alone."),
            key("start", Kind::WordOrTable(&["undeformed", "static"], START_KEYS), Default("\"undeformed\""), "\"static\"", "Shape at the start: undeformed, in equilibrium under the blocks and the loads of t = 0 (flat blocks follow it, tilted ones are held as placed), that of a mode, or that of a file."),
            key("surface", Kind::Choice(words::Lies::WORDS), Default("\"axis\""), "\"axis\"", "Where contacts lie: on the axis, or half a thickness above it."),
            key("position", POINT, Default("[\"0 m\", \"0 m\"]"), "[\"0 m\", \"0 m\"]", "Where its left end is, x and y."),
            key("self_weight", Kind::Flag, Default("false"), "true", "Whether gravity acts on the beam itself and the masses on it; deflections then count from the straight axis, else from the shape under the weight."),
            key("model", Kind::Choice(&["full", "modes"]), Default("\"full\""), "\"full\"", "In which coordinates it moves: full, those of all its nodes; modes, its lowest modes and static corrections, uncoupled and few: the keys of `modes` say how many, and `docs/beams.md` what is lost."),
            key("backend", Kind::Choice(words::Backend::WORDS), Default("\"auto\""), "\"auto\"", "How its matrices answer forces and contacts: the same motion up to rounding, in other times; auto takes the fastest one by measurement. A beam in modes has a diagonal matrix, and auto only."),
            key("probes", Kind::List(Dimension::LENGTH, Range::NOT_NEGATIVE), Optional, "[\"9 cm\"]", "Places along the beam, from its left end, whose deflection is written out."),
            key("record", Kind::Words(crate::scene::BEAM_QUANTITIES), Default("[\"w\"]"), "[\"w\", \"moment\", \"shear\"]", "What is written at its probes: deflection, bending moment, transverse force, largest normal stress; and its axial force. `docs/section-forces.md` has signs and meaning."),
            key("reactions", Kind::Flag, Default("false"), "true", "Whether force and couple of each support are written."),
            key("envelope", Kind::Flag, Default("false"), "true", "Whether the extremes of deflection, moment, transverse force and stress over all steps are written to envelopes.csv, by nodes."),
        ],
    },
    TableSchema {
        pattern: "beam.*.damping_ratio",
        occurrence: Occurrence::Inline,
        doc: "Viscous damping given by the damping ratio of one mode; one of the three ways to give damping.",
        keys: &[
            key("mode", Kind::Integer { min: 1, max: 100_000 }, Required, "1", "Number of the elastic mode, from 1; up to 20 but for a uniform beam that its end supports alone hold."),
            key("ratio", Kind::Number(Range::NOT_NEGATIVE), Required, "0.01", "Damping over critical damping in that mode."),
        ],
    },
    TableSchema {
        pattern: "beam.*.rayleigh",
        occurrence: Occurrence::Inline,
        doc: "Rayleigh damping, C = a0 M + a1 K: a0 damps low modes most, a1 high ones; given by its factors, or by the damping ratios at two frequencies. One of the three ways to give damping.",
        keys: &[
            key("a0", Kind::Quantity(Dimension::RATE, Range::NOT_NEGATIVE), DefaultWithout { sibling: "frequencies", value: "\"0 1/s\"" }, "\"0.5 1/s\"", "Factor of the mass matrix."),
            key("a1", Kind::Quantity(Dimension::TIME, Range::NOT_NEGATIVE), DefaultWithout { sibling: "frequencies", value: "\"0 s\"" }, "\"10 us\"", "Factor of the stiffness matrix."),
            key("frequencies", Kind::Pair(Dimension::RATE, Range::POSITIVE), Optional, "[\"10 Hz\", \"80 Hz\"]", "Two frequencies, in cycles per second, whose damping ratios are given; in place of a0 and a1."),
            key("ratios", Kind::Numbers(Range::NOT_NEGATIVE), Optional, "[0.01, 0.01]", "The damping ratios at these two frequencies."),
        ],
    },
    TableSchema {
        pattern: "beam.*.modes",
        occurrence: Occurrence::Inline,
        doc: "The shapes of a beam with model = modes: a number of modes, or as few modes and static corrections as the static flexibility of a region needs. When left out, the latter with a tolerance of 1e-4 over the whole span.",
        keys: &[
            key("count", Kind::Integer { min: 1, max: 256 }, Optional, "12", "Number of modes, rigid motions included; in place of tolerance, from and to."),
            key("tolerance", Kind::Number(FLEXIBILITY), DefaultWithout { sibling: "count", value: "1e-4" }, "1e-4", "Largest relative error of the deflection at x under a force at x at rest, for x in [from, to]: where contacts are."),
            Key { presence: DefaultWithout { sibling: "count", value: "\"0 m\"" }, doc: "Where that region begins, from the beam's left end.", ..FROM },
            Key { presence: Optional, doc: "Where it ends; when left out, at the beam's right end.", ..TO },
        ],
    },
    TableSchema {
        pattern: "beam.*.mesh",
        occurrence: Occurrence::Inline,
        doc: "A graded mesh: elements get shorter towards a place, evenly with the distance from it.",
        keys: &[
            key("towards", Kind::Quantity(Dimension::LENGTH, Range::NOT_NEGATIVE), Required, "\"18 cm\"", "Place along the beam where the elements are shortest."),
            key("ratio", Kind::Number(GRADING), Required, "4.0", "Length of the elements farthest from that place over that of the elements at it."),
        ],
    },
    TableSchema {
        pattern: "beam.*.segment.*",
        occurrence: Occurrence::Named,
        doc: "A part of the beam with a section of its own; where two overlap, the later one holds.",
        keys: &[
            FROM, TO, SECTION,
            key("material", Kind::Name, Optional, "\"steel\"", "Name of its material; when left out, that of the beam.").only_with("section", PROFILES),
            WIDTH, THICKNESS, DIAMETER, WALL, HEIGHT, WEB, FLANGE,
            BENDING_STIFFNESS, MASS_PER_LENGTH, SHEAR_STIFFNESS, ROTATORY_INERTIA, AXIAL_STIFFNESS,
        ],
    },
    TableSchema {
        pattern: "beam.*.support.*",
        occurrence: Occurrence::Named,
        doc: "A support between the ends of the beam: of a kind, or by springs and dashpots.",
        keys: &[
            PLACE,
            key("kind", Kind::Choice(&["pinned", "clamped", "guided"]), Optional, "\"pinned\"", "How the beam is held there."),
            SPRING, DASHPOT, DEFLECTION, ROTATIONAL_SPRING, ROTATIONAL_DASHPOT, ROTATION,
        ],
    },
    TableSchema {
        pattern: "beam.*.mass.*",
        occurrence: Occurrence::Named,
        doc: "A mass that is fixed to the beam.",
        keys: &[
            PLACE,
            key("mass", Kind::Quantity(Dimension::MASS, Range::NOT_NEGATIVE), Required, "\"0.2 kg\"", "Its mass."),
            key("inertia", Kind::Quantity(Dimension::INERTIA, Range::NOT_NEGATIVE.sizes(1e-18, 1e12)), Default("\"0 kg m^2\""), "\"1e-4 kg m^2\"", "Its moment of inertia about the axis of the beam's rotation."),
        ],
    },
    TableSchema {
        pattern: "beam.*.foundation.*",
        occurrence: Occurrence::Named,
        doc: "A foundation under the beam (Winkler): a force per length -k w - c dw/dt.",
        keys: &[
            Key { presence: Default("\"0 m\""), ..FROM },
            Key { presence: Optional, doc: "Where it ends; when left out, at the beam's right end.", ..TO },
            key("stiffness", Kind::Quantity(Dimension::PRESSURE, SPRING_STIFFNESS), Required, "\"10 kN/m^2\"", "Stiffness k per length."),
            key("damping", Kind::Quantity(Dimension::DAMPING_PER_LENGTH, Range::NOT_NEGATIVE), Default("\"0 N s/m^2\""), "\"5 N s/m^2\"", "Damping c per length."),
        ],
    },
    TableSchema {
        pattern: "beam.*.motion",
        occurrence: Occurrence::Inline,
        doc: "Prescribed motion of its supports, which move together; damping acts on the motion relative to them.",
        keys: &[DISPLACEMENT, VELOCITY, ACCELERATION, SIGNAL, SIGNALS],
    },
    TableSchema {
        pattern: "block.*",
        occurrence: Occurrence::Named,
        doc: "A rigid block: a rectangle by its sides, or a convex polygon by its corners.",
        keys: &[
            key("material", Kind::Name, Required, "\"aluminium\"", "Name of its material."),
            key("width", SIZE, RequiredWithout("points"), "\"3 cm\"", "Side along its base."),
            key("height", SIZE, RequiredWithout("points"), "\"13.5 cm\"", "Side upwards."),
            key("points", Kind::Points(Dimension::LENGTH, Range::ANY), Optional, "[[\"0 cm\", \"0 cm\"], [\"30 cm\", \"0 cm\"], [\"20 cm\", \"15 cm\"]]", "Corners of a convex polygon, in order round it, in place of width and height. Without a position it starts where they are; with one it is moved there, its mass centre to the position. Tables call them `corner-1`, `corner-2`, …, counter-clockwise from the first."),
            key("depth", SIZE, Required, "\"3 cm\"", "Side out of the plane."),
            key("on", Kind::Name, Optional, "\"table\"", "What it stands on: a beam, \"ground\", or another block, on whose upper side it is put."),
            key("at", Kind::Quantity(Dimension::LENGTH, Range::ANY), Optional, "\"18 cm\"", "Place x, in the world, of the middle of its base before it is tilted."),
            key("tilt", Kind::Quantity(Dimension::ANGLE, QUARTER_TURN), DefaultWith { sibling: "on", value: "\"0 deg\"" }, "\"5 deg\"", "Turn about the corner that it stays on, counter-clockwise positive."),
            key("position", POINT, Optional, "[\"18 cm\", \"6.75 cm\"]", "Place of its mass centre, in place of on and at."),
            key("angle", Kind::Quantity(Dimension::ANGLE, QUARTER_TURN), DefaultWith { sibling: "position", value: "\"0 deg\"" }, "\"5 deg\"", "Turn about its mass centre, counter-clockwise positive; goes with position."),
            key("velocity", Kind::Pair(Dimension::VELOCITY, Range::ANY), Default("[\"0 m/s\", \"0 m/s\"]"), "[\"0.1 m/s\", \"0 m/s\"]", "Velocity of its mass centre at the start."),
            key("spin", Kind::Quantity(Dimension::ANGULAR_VELOCITY, Range::ANY), Default("\"0 rad/s\""), "\"1 rad/s\"", "Angular velocity at the start, counter-clockwise positive."),
        ],
    },
    TableSchema {
        pattern: "block.*.motion",
        occurrence: Occurrence::Inline,
        doc: "Prescribed motion of the block: of its mass centre, of its angle, or both; what is not named stays free. It starts where the block is placed.",
        keys: &[
            DISPLACEMENT, VELOCITY, ACCELERATION,
            key("only", Kind::Choice(&["x", "y"]), Optional, "\"x\"", "The one direction of the mass centre that is prescribed; the other stays free. When left out, both are prescribed."),
            TURN, TURN_VELOCITY, TURN_ACCELERATION, SIGNAL, SIGNALS,
        ],
    },
    TableSchema {
        pattern: "block.*.repeat",
        occurrence: Occurrence::Inline,
        doc: "Several blocks of one kind, named after the table with `-1`, `-2`, … at the end.",
        keys: &[
            key("count", Kind::Integer { min: 1, max: 10_000 }, Required, "20", "How many there are."),
            key("shift", Kind::Pair(Dimension::LENGTH, Range::ANY), Default("[\"0 m\", \"0 m\"]"), "[\"8 cm\", \"0 cm\"]", "From the place of one to the place of the next; where they stand on something, x alone; where they are stacked, along the upper side of the one before, from its middle."),
            key("stacked", Kind::Flag, Default("false"), "true", "Whether each stands on the one before, flat, the first on what `on` says."),
        ],
    },
    TableSchema {
        pattern: "contact.*",
        occurrence: Occurrence::Named,
        doc: "Contact of a block with a beam, with the ground or with another block, with impact and friction. Bodies that no contact joins pass through each other.",
        keys: &[
            key("between", Kind::PatternPair, Required, "[\"rocker\", \"table\"]", "Two blocks, or a block and the beam or `ground` that it touches, in either order. Forces and velocities in the tables are those on the block; between two, on the first. A `*` in a name stands for any letters: [\"brick-*\", \"brick-*\"] joins all blocks of such names with each other, but for those that a contact joins by their full names, or an earlier one by a pattern."),
            key("friction", Kind::Number(Range::NOT_NEGATIVE), Required, "0.5", "Coefficient of Coulomb friction."),
            key("restitution", Kind::Number(Range::UNIT), Default("0.0"), "0.0", "Coefficient of restitution: of the normal velocity, or with poisson of the normal impulse.").only_with("law", IMPACTS),
            key("tangential_restitution", Kind::Number(Range::UNIT), Default("0.0"), "0.0", "Part of the tangential velocity that comes back from an impact that does not slide.").only_with("law", IMPACTS),
            key("kinematics", Kind::Choice(words::Frames::WORDS), Default("\"deformed\""), "\"deformed\"", "Whether contact frames follow the deformed beam or its undeformed axis; the latter is for blocks that don't slide along a deflected beam."),
            key("law", Kind::Choice(words::Law::WORDS), Default("\"newton\""), "\"newton\"", "Law along the normal: an impact in an instant (newton, poisson, energetic), or a contact with duration (kelvin-voigt, hunt-crossley)."),
            key("stiffness", Kind::Measure(CONTACT_STIFFNESS, Range::POSITIVE.sizes(1e-12, 1e18)), Required, "\"1e6 N/m\"", "Stiffness k. In F = k d^n (hunt-crossley) its unit is N/m^n; N/m stands for that too, with the same number.").only_with("law", COMPLIANT),
            key("damping", Kind::Measure(CONTACT_DAMPING, Range::NOT_NEGATIVE), Required, "\"10 N s/m\"", "Damping: with kelvin-voigt c in N s/m; with hunt-crossley, in F = k d^n (1 + D v), D in s/m, or c = k D in N s/m^(n+1), for which N s/m stands too.").only_with("law", COMPLIANT),
            key("exponent", Kind::Number(EXPONENT), Default("1.5"), "1.5", "Exponent n of the force: 1.5 is that of two spheres.").only_with("law", &["hunt-crossley"]),
        ],
    },
    TableSchema {
        pattern: "signal.*",
        occurrence: Occurrence::Named,
        doc: "A time history without unit, with a peak of 1 if by formula: what it is used for gives the amplitude. Formulas and integrals: `docs/signals.md`.",
        keys: &[
            key("shape", Kind::Choice(words::History::WORDS), Required, "\"one-sine\"", "What it looks like."),
            key("start", INSTANT, Default("\"0 s\""), "\"0.1 s\"", "When it starts: it is 0 before; the times of a table count from it.").only_with("shape", &["constant", "ramp", "harmonic", "one-sine", "half-sine", "table"]),
            key("peak", INSTANT, Required, "\"0.5 s\"", "When a Ricker wavelet has its peak.").only_with("shape", &["ricker"]),
            key("duration", TIME, Required, "\"0.2 s\"", "How long a ramp takes to reach 1, or a half sine lasts.").only_with("shape", &["ramp", "half-sine"]),
            key("frequency", Kind::Quantity(Dimension::RATE, Range::POSITIVE), Optional, "\"2 Hz\"", "Cycles per second; of a Ricker wavelet the peak of its spectrum. Or give the period.").only_with("shape", OSCILLATING),
            key("period", TIME, Optional, "\"0.5 s\"", "Time of a cycle, in place of the frequency.").only_with("shape", OSCILLATING),
            key("phase", ANGLE, Default("\"0 deg\""), "\"20 deg\"", "Argument of the sine at the start.").only_with("shape", &["harmonic", "one-sine"]),
            key("file", Kind::Path, Required, "\"quake.csv\"", "File of two columns, time in s and value; relative to the scene's file.").only_with("shape", &["table"]),
        ],
    },
    TableSchema {
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
    TableSchema {
        pattern: "load.*",
        occurrence: Occurrence::Named,
        doc: "A load on a beam: at a point that may move, or distributed evenly over the beam or a part of it.",
        keys: &[
            key("on", Kind::Name, Required, "\"table\"", "The beam."),
            key("at", Kind::Quantity(Dimension::LENGTH, Range::ANY), Optional, "\"9 cm\"", "Place along the beam, from its left end, of force and couple; of a moving force where it is at t = 0, which may be off the beam."),
            key("force", Kind::Quantity(Dimension::FORCE, Range::ANY), Optional, "\"-10 N\"", "Force at that place, upwards positive."),
            key("couple", Kind::Quantity(Dimension::ENERGY, Range::ANY), Optional, "\"0.1 N m\"", "Couple at that place, counter-clockwise positive."),
            key("speed", Kind::Quantity(Dimension::VELOCITY, Range::ANY), Optional, "\"2 m/s\"", "Velocity of the force along the beam; it acts only while it is on the beam."),
            key("distributed", Kind::Quantity(Dimension::STIFFNESS, Range::ANY), Optional, "\"-10 N/m\"", "Force per length, upwards positive; in place of at, force and couple."),
            Key { presence: Optional, doc: "Where a distributed load begins, from the beam's left end; when left out, there.", ..FROM },
            Key { presence: Optional, doc: "Where it ends; when left out, at the beam's right end.", ..TO },
            SIGNAL,
        ],
    },
    TableSchema {
        pattern: "solver",
        occurrence: Occurrence::Always,
        doc: "How the contact problem of a step is solved.",
        keys: &[
            key("method", Kind::Choice(&["auto", "pgs", "enumeration", "newton", "smoothing", "prox", "lemke", "acary-cadoux", "admm", "apgd", "vi-eg", "socp"]), Default("\"auto\""), "\"auto\"", "Name of a contact solver; auto takes the one that fits the step, `docs/solvers.md` has the others. socp solves another law than Coulomb's."),
            key("tolerance", Kind::Number(Range::INSIDE_UNIT), Default("1e-10"), "1e-10", "Relative residual at which a step counts as solved."),
            key("max_iterations", Kind::Integer { min: 1, max: 4_294_967_295 }, Default("10000"), "10000", "Iterations after which a solver gives up on a step."),
            key("require_convergence", Kind::Flag, Default("false"), "false", "Whether a step that is not solved ends the run."),
        ],
    },
    TableSchema {
        pattern: "output",
        occurrence: Occurrence::Always,
        doc: "What is written.",
        keys: &[key("every", TIME, Optional, "\"1 ms\"", "Time between rows; when left out, every step up to 10 000 rows, thinned evenly past that.")],
    },
];
