//! The entries of the table of keys. [`crate::keys`] explains the columns.

mod beam_keys;
mod block_keys;

use std::f64::consts::FRAC_PI_2;

use crate::dimension::Dimension;
use crate::keys::{Bound, Key, Kind, Occurrence, Presence, Range, TableSchema};
use crate::measure::AllowedUnit;
use crate::words;
use beam_keys::*;
use block_keys::*;

const fn key(name: &'static str, kind: Kind, presence: Presence, example: &'static str, doc: &'static str) -> Key {
    Key::new(name, kind, presence, example, doc)
}

const QUARTER_TURN: Range = Range::new(Bound::Closed(-FRAC_PI_2), Bound::Closed(FRAC_PI_2));
/// Steeper ground is a wall.
const INCLINE: Range = Range::new(Bound::Closed(-MAX_INCLINE), Bound::Closed(MAX_INCLINE));
const MAX_INCLINE: f64 = 80.0 * FRAC_PI_2 / 90.0;
const POISSON_RATIO: Range = Range::new(Bound::Open(-1.0), Bound::Closed(0.5));
const GRADING: Range = Range::new(Bound::Closed(1.0), Bound::Closed(1000.0));
/// Below it the compared flexibilities have no digits left.
const FLEXIBILITY: Range = Range::new(Bound::Closed(1e-8), Bound::Open(1.0));
const EXPONENT: Range = Range::new(Bound::Closed(1.0), Bound::Closed(10.0));
const OSCILLATING: &[&str] = &["harmonic", "one-sine", "ricker"];
const DURATION: Range = Range::POSITIVE.sizes(1e-15, 1e12);
const MODULUS: Range = Range::POSITIVE.sizes(1e-12, 1e18);
/// More elements leave no correct digit in double precision.
const MAX_ELEMENTS: i64 = teeter_beam::MAX_ELEMENTS as i64;
/// Memory of an element, measured with 10 000 of them: matrices, factors, state.
const ELEMENT_BYTES: u64 = 1000;
/// Scales with the blocks, down to 1e-11 of the smallest side allowed.
const GAP: Range = Range::NOT_NEGATIVE.sizes(1e-30, 1e12);

use Presence::{Default, DefaultWith, DefaultWithout, Optional, Required, RequiredWithout};

const SIZE: Kind = Kind::Quantity(Dimension::LENGTH, Range::POSITIVE);
const TIME: Kind = Kind::Quantity(Dimension::TIME, DURATION);
const INSTANT: Kind = Kind::Quantity(Dimension::TIME, Range::ANY);
const ANGLE: Kind = Kind::Quantity(Dimension::ANGLE, Range::ANY);
const POINT: Kind = Kind::Pair(Dimension::LENGTH, Range::ANY);

/// Narrower, the labels of axes would meet; wider, no page has room.
const FIGURE_WIDTH: Range = Range::new(Bound::Closed(0.06), Bound::Closed(0.3));

/// Contact laws: instantaneous and compliant.
const IMPACTS: &[&str] = &["newton", "poisson", "energetic"];
const COMPLIANT: &[&str] = &["kelvin-voigt", "hunt-crossley"];

/// Stiffness and damping of a compliant contact: their units contain the exponent of the force.
const CONTACT_STIFFNESS: &[AllowedUnit] =
    &[AllowedUnit::new(Dimension::STIFFNESS, "N/m"), AllowedUnit::over_powers_of_metre(Dimension::FORCE, "N/m^n")];
const CONTACT_DAMPING: &[AllowedUnit] = &[
    AllowedUnit::new(Dimension::DAMPING, "N s/m"),
    AllowedUnit::new(Dimension::INVERSE_VELOCITY, "s/m"),
    AllowedUnit::over_powers_of_metre(Dimension::IMPULSE, "N s/m^(n+1)"),
];

const SIGNAL: Key =
    key("signal", Kind::Name, Optional, "\"shake\"", "Name of the signal that multiplies it; constant if left out.");
const SIGNALS: Key = key(
    "signals",
    Kind::NamePair,
    Optional,
    "[\"east\", \"up\"]",
    "Names of two signals, for x and for y, instead of one for both.",
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
const TURN: Key = key("angle", ANGLE, Optional, "\"2 deg\"", "Amplitude of the rotation, counter-clockwise positive.");
const TURN_VELOCITY: Key = key(
    "angular_velocity",
    Kind::Quantity(Dimension::ANGULAR_VELOCITY, Range::ANY),
    Optional,
    "\"1 rad/s\"",
    "Amplitude of the angular velocity; the rotation starts at 0.",
);
const TURN_ACCELERATION: Key = key(
    "angular_acceleration",
    Kind::Quantity(Dimension::ANGULAR_ACCELERATION, Range::ANY),
    Optional,
    "\"5 rad/s^2\"",
    "Amplitude of the angular acceleration; angular velocity and rotation start at 0.",
);

/// A recorded component of a motion.
#[rustfmt::skip] // a row per key
const RECORD: &[Key] = &[
    key("record", Kind::Path, Required, "\"quake.at2\"", "File of the record: PEER .AT2, ESM or COSMOS ASCII, or a table of time and acceleration, or of accelerations alone; told apart by its content. Relative to the scene's file."),
    key("component", Kind::Text, Optional, "\"EW\"", "One of several accelerations: of a table by the heading of its column or by the number of the column from 1, that of the times included; of a COSMOS file by its number."),
    key("unit", Kind::Choice(words::RecordUnit::WORDS), Optional, "\"gn\"", "Unit of the accelerations of a table whose heading has none; m/s^2 if left out."),
    key("step", TIME, Optional, "\"10 ms\"", "Time between two values of a table of accelerations without times; with component no column is then a time, unless the heading of the first says so."),
    key("from", Kind::Quantity(Dimension::TIME, Range::NOT_NEGATIVE), Optional, "\"5 s\"", "Start of the part that is used, in the time of the record: its first row then or later, with which the run starts. The record's start if left out."),
    key("to", Kind::Quantity(Dimension::TIME, Range::NOT_NEGATIVE), Optional, "\"25 s\"", "Its end: its last row then or earlier. The record's end if left out."),
    key("baseline", Kind::Choice(words::Baseline::WORDS), Default("\"none\""), "\"linear\"", "Least-squares polynomial that is subtracted from the acceleration, after the cut by from and to."),
    key("taper", Kind::Number(TAPER), Default("0.0"), "0.05", "Fraction of the duration over which each end is then faded by half a cosine."),
    key("scale", Kind::Number(Range::ANY), Optional, "0.5", "Factor of the acceleration, applied last."),
    key("peak", Kind::Quantity(Dimension::ACCELERATION, Range::POSITIVE), Optional, "\"0.4 gn\"", "Instead of scale: the peak acceleration to which the record is scaled; its signs are kept."),
    key("peak_velocity", Kind::Quantity(Dimension::VELOCITY, Range::POSITIVE), Optional, "\"0.3 m/s\"", "Instead of scale: the peak velocity, from rest, to which it is scaled."),
    key("arias", Kind::Quantity(Dimension::VELOCITY, Range::POSITIVE), Optional, "\"1.2 m/s\"", "Instead of scale: the Arias intensity to which it is scaled."),
    key("spectral_acceleration", Kind::Quantity(Dimension::ACCELERATION, Range::POSITIVE), Optional, "\"0.5 gn\"", "Instead of scale: the pseudo-acceleration of its response spectrum at `period`, for 5 % damping, to which it is scaled."),
    key("period", TIME, Optional, "\"0.5 s\"", "Natural period of that spectral acceleration."),
];
const TAPER: Range = Range::new(Bound::Closed(0.0), Bound::Closed(0.5));

/// A horizontal or vertical component given by a record.
const fn recorded(pattern: &'static str, doc: &'static str) -> TableSchema {
    TableSchema { pattern, occurrence: Occurrence::Inline, doc, keys: RECORD }
}
const RECORDED_X: &str = "The motion along x by a recorded acceleration, linear between its values; velocity and displacement start at 0. Instead of displacement, velocity and acceleration.";
const RECORDED_Y: &str = "The same along y.";

/// All tables of a scene, in the order of the output.
#[rustfmt::skip] // a row per key
pub static TABLES: &[TableSchema] = &[
    TableSchema {
        pattern: "",
        occurrence: Occurrence::Always,
        doc: "Keys of the scene as a whole.",
        keys: &[
            key("title", Kind::Text, Optional, "\"Rocking block\"", "Title of the scene; if left out, the file's name without extension."),
            key("version", Kind::Version(&[1]), Default("1"), "1", "Version of the scene format."),
        ],
    },
    TableSchema {
        pattern: "time",
        occurrence: Occurrence::Always,
        doc: "Simulated time, time steps and time scheme.",
        keys: &[
            key("end", TIME, Required, "\"0.5 s\"", "Simulated time; the run ends with the first step at or past it."),
            key("step", TIME, RequiredWithout("accuracy"), "\"100 us\"", "Size of the time step; with auto, or if left out, the longest step found to reach the accuracy.").left_out_as("auto"),
            key("accuracy", Kind::Number(Range::INSIDE_UNIT), Optional, "1e-3", "Instead of a step: the largest error of any angle, relative to the largest angle, and of any position, relative to the block's larger side, before the horizon."),
            key("stop", Kind::Words(words::StopWord::WORDS), Optional, "[\"overturned\", \"rest\"]", "What ends the run before its end: overturned, a block lies on another side or stays past its point of no return; rest, all blocks have come to rest, all prescribed motion is over, and no force or load changes any more; sunk, a block is below everything that could hold it. `docs/verdict.md` defines them."),
            key("scheme", Kind::Choice(words::SCHEMES), Default("\"auto\""), "\"moreau-jean\"", "Time scheme. auto: moreau-jean-located, but moreau-jean if theta, gap_tolerance or activation_gamma is given, and moreau-jean-closed for more than 8 blocks that aren't fixed or a beam held along its axis. moreau-jean-closed: a contact stays closed until it pulls, and contacts generate no energy. moreau-jean-located: also divides a step where a contact closes. event-driven: takes its own steps between located events, to rounding; the step is then that of the output. moreau-jean-projected: as closed, with positions projected so that no step ends with a penetration. generalized-alpha: the same, and damps vibrations of beams that the step can't resolve. resolved: contact with beams as a force, without restitution there, with steps halved where contacts close."),
            key("theta", Kind::Number(Range::UNIT), Default("0.5"), "0.5", "Weight of the end of the step in the theta method: 0.5 conserves energy, 1 damps most; moreau-jean-closed, moreau-jean-located, moreau-jean-projected and resolved allow only 0.5, event-driven and generalized-alpha have no theta."),
            key("gap_tolerance", Kind::Quantity(Dimension::LENGTH, GAP), Optional, "\"1e-12 m\"", "Gap below which a contact counts as closed, at most 1e-3 of the shortest block side; if left out, derived from the largest block side."),
            key("activation_gamma", Kind::Number(Range::UNIT), Default("0.5"), "0.5", "Fraction of the step by which positions are predicted to find the active contacts; moreau-jean only."),
            key("allow_conditional_stability", Kind::Flag, Default("false"), "false", "Allows theta below 0.5, for which the step must be short enough to be stable."),
            key("spectral_radius", Kind::Number(Range::UNIT), Optional, "0.8", "Factor by which a step of generalized-alpha multiplies a vibration of infinite frequency: 1 doesn't damp, 0 damps most; 0.8 if left out. generalized-alpha only."),
        ],
    },
    TableSchema {
        pattern: "world",
        occurrence: Occurrence::Always,
        doc: "Global settings.",
        keys: &[
            key("gravity", Kind::Downward(Dimension::ACCELERATION), Default("\"9.81 m/s^2\""), "\"9.81 m/s^2\"", "Acceleration of gravity, downwards or as a vector [x, y]."),
            key("apart", Kind::PatternPairs, Optional, "[[\"wall-*\", \"wall-*\"]]", "Pairs of bodies, by names or patterns, that don't touch, whatever the contacts say."),
        ],
    },
    TableSchema {
        pattern: "material.*",
        occurrence: Occurrence::Named,
        doc: "A material of blocks and beams.",
        keys: &[
            key("density", Kind::Quantity(Dimension::DENSITY, Range::POSITIVE), Required, "\"2700 kg/m^3\"", "Mass per volume."),
            key("youngs_modulus", Kind::Quantity(Dimension::PRESSURE, MODULUS), Optional, "\"69 GPa\"", "Young's modulus; a beam needs it, a rigid block does not."),
            key("poisson_ratio", Kind::Number(POISSON_RATIO), Optional, "0.33", "Poisson's ratio; a beam with theory = timoshenko needs it."),
            key("yield_strength", Kind::Quantity(Dimension::PRESSURE, MODULUS), Optional, "\"240 MPa\"", "Yield strength; `check` shows the bending moment at which a beam begins to yield, and a run warns if it is exceeded."),
        ],
    },
    TableSchema {
        pattern: "ground",
        occurrence: Occurrence::Optional,
        doc: "Rigid ground, flat at y = 0, inclined through the origin, or with a profile; its name in contacts is `ground`.",
        keys: &[
            key("incline", Kind::Quantity(Dimension::ANGLE, INCLINE), Default("\"0 deg\""), "\"10 deg\"", "Slope of the ground, which goes through the origin; counter-clockwise positive, so uphill to the right."),
        ],
    },
    TableSchema {
        pattern: "ground.profile",
        occurrence: Occurrence::Inline,
        doc: "A profile instead of an incline: straight pieces between points, level beyond the first and the last. It moves and turns with the ground. A block placed on it lies on what is under its base: on a piece, or across a valley or a crest.",
        keys: &[
            key("points", Kind::Points(Dimension::LENGTH, Range::ANY), Optional, "[[\"0 m\", \"0 m\"], [\"1 m\", \"0.2 m\"], [\"3 m\", \"0.2 m\"]]", "Points from left to right; each must be to the right of the one before it."),
            key("file", Kind::Path, Optional, "\"ground.csv\"", "Instead of points: a file with a point in each row, x and y in m, or in the unit in brackets in the heading; relative to the scene's file."),
            key("columns", Kind::NamePair, Optional, "[\"x\", \"height\"]", "The columns of the file with x and y, by their headings or by their numbers from 1; if left out, it must have two."),
            key("unit", Kind::Choice(words::LengthUnit::WORDS), Optional, "\"mm\"", "Unit of the file's columns if its heading has none; m if left out."),
        ],
    },
    TableSchema {
        pattern: "ground.motion",
        occurrence: Occurrence::Inline,
        doc: "Prescribed motion of the ground: a displacement, velocity or acceleration, a rotation about the point that is the origin when nothing is displaced, or both.",
        keys: &[DISPLACEMENT, VELOCITY, ACCELERATION, TURN, TURN_VELOCITY, TURN_ACCELERATION, SIGNAL, SIGNALS],
    },
    recorded("ground.motion.x", RECORDED_X),
    recorded("ground.motion.y", RECORDED_Y),
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
            key("theory", Kind::Choice(words::Theory::WORDS), Default("\"euler-bernoulli\""), "\"timoshenko\"", "euler-bernoulli: sections stay normal to the axis; timoshenko: with shear and rotatory inertia, needed if the thickness exceeds a tenth of the span."),
            key("elements", Kind::Integer { min: 1, max: MAX_ELEMENTS }, RequiredWithout("nodes"), "20", "Number of finite elements; supports between the ends, masses, and ends of segments and foundations may add some.").taking(ELEMENT_BYTES),
            key("nodes", Kind::List(Dimension::LENGTH, Range::NOT_NEGATIVE), Optional, "[\"0 cm\", \"10 cm\", \"36 cm\"]", "Positions of its nodes, in ascending order from 0 to the span, instead of elements."),
            key("supports", Kind::WordOrTablePair(SUPPORTS, SUPPORT_KEYS), Default("[\"pinned\", \"pinned\"]"), "[\"pinned\", { spring = \"1 kN/m\" }]", "Supports of its left and right ends."),
            key("axial", Kind::Choice(words::AxialModel::WORDS), Default("\"free\""), "\"held\"", "Axial model: free, no axial motion; held, both ends are held, and deflection stretches the beam (von Karman; theta = 0.5 only); elastic, axial motion with inertia, not coupled to the deflection."),
            key("axial_supports", Kind::ChoicePair(&["held", "free"]), Default("[\"held\", \"held\"]"), "[\"held\", \"free\"]", "Whether its left and right ends are held along the axis.").only_with("axial", &["elastic"]),
            key("axial_force", Kind::Quantity(Dimension::FORCE, Range::ANY), Default("\"0 N\""), "\"100 N\"", "Constant axial force, tension positive; compression must be less than the buckling load."),
            key("viscous_damping", Kind::Quantity(Dimension::DAMPING_PER_LENGTH, Range::NOT_NEGATIVE), Optional, "\"0.4 N s/m^2\"", "Coefficient c of the viscous term of the beam equation, which damps high modes less and less; one of three ways to give damping."),
            key("modal_damping", Kind::Numbers(Range::NOT_NEGATIVE), Optional, "[0.01, 0.02]", "Damping ratios of the first elastic modes of the finite elements, added to other damping; further modes are not affected."),
            key("start", Kind::WordOrTable(&["undeformed", "static"], START_KEYS), Default("\"undeformed\""), "\"static\"", "Initial shape: undeformed; static, in equilibrium under the blocks and the loads at t = 0 (flat blocks follow it, tilted ones are held as placed); that of a mode, or from a file."),
            key("surface", Kind::Choice(words::ContactSurface::WORDS), Default("\"axis\""), "\"axis\"", "Where contacts are: on the axis, or half a thickness above it (below it, of those with its lower face)."),
            key("position", POINT, Default("[\"0 m\", \"0 m\"]"), "[\"0 m\", \"0 m\"]", "Position of its left end, x and y."),
            key("self_weight", Kind::Flag, Default("false"), "true", "Whether gravity acts on the beam and its masses; deflections are then relative to the straight axis, otherwise to the shape under the weight."),
            key("model", Kind::Choice(&["full", "modes"]), Default("\"full\""), "\"full\"", "Coordinates of its motion: full, those of all its nodes; modes, a few of its lowest modes with static corrections, uncoupled: `modes` gives their number, and `docs/beams.md` the limitations."),
            key("backend", Kind::Choice(words::Backend::WORDS), Default("\"auto\""), "\"auto\"", "How its matrices are applied: affects speed, and the motion only by rounding; auto selects the fastest as measured. A beam in modes has a diagonal matrix, and allows only auto."),
            key("probes", Kind::List(Dimension::LENGTH, Range::NOT_NEGATIVE), Optional, "[\"9 cm\"]", "Positions along the beam, from its left end, at which the quantities of `record` are written."),
            key("record", Kind::Words(crate::scene::BEAM_QUANTITIES), Default("[\"w\"]"), "[\"w\", \"moment\", \"shear\"]", "Quantities written at its probes: deflection, bending moment, transverse force, largest normal stress; and its axial force. `docs/section-forces.md` has signs and meaning."),
            key("reactions", Kind::Flag, Default("false"), "true", "Whether to write force and couple of each support."),
            key("envelope", Kind::Flag, Default("false"), "true", "Whether to write the extremes of deflection, moment, transverse force and stress over all steps to envelopes.csv, by nodes."),
        ],
    },
    TableSchema {
        pattern: "beam.*.damping_ratio",
        occurrence: Occurrence::Inline,
        doc: "Viscous damping given by the damping ratio of one mode; one of three ways to give damping.",
        keys: &[
            key("mode", Kind::Integer { min: 1, max: 100_000 }, Required, "1", "Number of the elastic mode, from 1; at most 20 except for a uniform beam with supports only at its ends."),
            key("ratio", Kind::Number(Range::NOT_NEGATIVE), Required, "0.01", "Damping relative to critical damping in that mode."),
        ],
    },
    TableSchema {
        pattern: "beam.*.rayleigh",
        occurrence: Occurrence::Inline,
        doc: "Rayleigh damping, C = a0 M + a1 K: a0 damps low modes most, a1 high ones; given by its factors, or by the damping ratios at two frequencies. One of three ways to give damping.",
        keys: &[
            key("a0", Kind::Quantity(Dimension::RATE, Range::NOT_NEGATIVE), DefaultWithout { sibling: "frequencies", value: "\"0 1/s\"" }, "\"0.5 1/s\"", "Factor of the mass matrix."),
            key("a1", Kind::Quantity(Dimension::TIME, Range::NOT_NEGATIVE), DefaultWithout { sibling: "frequencies", value: "\"0 s\"" }, "\"10 us\"", "Factor of the stiffness matrix."),
            key("frequencies", Kind::Pair(Dimension::RATE, Range::POSITIVE), Optional, "[\"10 Hz\", \"80 Hz\"]", "Two frequencies, in cycles per second, whose damping ratios are given; instead of a0 and a1."),
            key("ratios", Kind::Numbers(Range::NOT_NEGATIVE), Optional, "[0.01, 0.01]", "The damping ratios at these two frequencies."),
        ],
    },
    TableSchema {
        pattern: "beam.*.modes",
        occurrence: Occurrence::Inline,
        doc: "The shapes of a beam with model = modes: a number of modes, or as few modes and static corrections as the static flexibility of a region needs. The default is the latter with a tolerance of 1e-4 over the whole span.",
        keys: &[
            key("count", Kind::Integer { min: 1, max: 256 }, Optional, "12", "Number of modes, including rigid motions; instead of tolerance, from and to."),
            key("tolerance", Kind::Number(FLEXIBILITY), DefaultWithout { sibling: "count", value: "1e-4" }, "1e-4", "Largest relative error of the static deflection at x under a force at x, for x in [from, to], the region of contacts."),
            Key { presence: DefaultWithout { sibling: "count", value: "\"0 m\"" }, doc: "Start of that region, from the beam's left end.", ..FROM },
            Key { presence: Optional, doc: "Its end; if left out, the beam's right end.", ..TO },
        ],
    },
    TableSchema {
        pattern: "beam.*.mesh",
        occurrence: Occurrence::Inline,
        doc: "A graded mesh: elements get shorter towards a position, linearly with the distance from it.",
        keys: &[
            key("towards", Kind::Quantity(Dimension::LENGTH, Range::NOT_NEGATIVE), Required, "\"18 cm\"", "Position along the beam where the elements are shortest."),
            key("ratio", Kind::Number(GRADING), Required, "4.0", "Length of the elements farthest from that position divided by that of the elements at it."),
        ],
    },
    TableSchema {
        pattern: "beam.*.segment.*",
        occurrence: Occurrence::Named,
        doc: "A part of the beam with its own section; where two overlap, the later one applies.",
        keys: &[
            FROM, TO, SECTION,
            key("material", Kind::Name, Optional, "\"steel\"", "Name of its material; if left out, that of the beam.").only_with("section", PROFILES),
            WIDTH, THICKNESS, DIAMETER, WALL, HEIGHT, WEB, FLANGE,
            BENDING_STIFFNESS, MASS_PER_LENGTH, SHEAR_STIFFNESS, ROTATORY_INERTIA, AXIAL_STIFFNESS,
        ],
    },
    TableSchema {
        pattern: "beam.*.support.*",
        occurrence: Occurrence::Named,
        doc: "A support between the ends of the beam: of a given kind, or by springs and dashpots.",
        keys: &[
            PLACE,
            key("kind", Kind::Choice(&["pinned", "clamped", "guided"]), Optional, "\"pinned\"", "How the beam is held there."),
            SPRING, DASHPOT, DEFLECTION, ROTATIONAL_SPRING, ROTATIONAL_DASHPOT, ROTATION,
        ],
    },
    TableSchema {
        pattern: "beam.*.mass.*",
        occurrence: Occurrence::Named,
        doc: "A mass attached to the beam.",
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
            Key { presence: Optional, doc: "Its end; if left out, the beam's right end.", ..TO },
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
    recorded("beam.*.motion.x", RECORDED_X),
    recorded("beam.*.motion.y", RECORDED_Y),
    TableSchema {
        pattern: "block.*",
        occurrence: Occurrence::Named,
        doc: "A rigid block. Its shape: width and height, points, radius, shape, or parts.",
        keys: &[
            MATERIAL, BLOCK_DENSITY, BLOCK_WIDTH, BLOCK_HEIGHT, POINTS, RADIUS,
            key("parts", Kind::Tables(PART_KEYS), Optional, "[{ width = \"4 cm\", height = \"2 cm\" }, { radius = \"1 cm\", at = [\"0 cm\", \"2 cm\"] }]", "Parts of a block that is not convex, each with the keys of a shape; where they overlap, mass counts for each of them. Without a position it starts where they are. Tables call their points `part-2.corner-1` and so on."),
            ROUNDING, CHAMFER,
            key("depth", SIZE, RequiredWithout("mass"), "\"3 cm\"", "Depth out of the plane."),
            key("mass", Kind::Quantity(Dimension::MASS, Range::POSITIVE), Optional, "\"2 kg\"", "Mass, instead of material and depth; together with inertia."),
            key("inertia", Kind::Quantity(Dimension::INERTIA, Range::POSITIVE.sizes(1e-18, 1e12)), Optional, "\"3e-4 kg m^2\"", "Moment of inertia about the mass centre, which is that of the shape; together with mass. It is refused if it is more than that of all the mass at the furthest point of the shape."),
            key("on", Kind::Name, Optional, "\"table\"", "The body that it stands on: a beam, \"ground\", or another block, on whose upper side it is placed."),
            key("at", Kind::Quantity(Dimension::LENGTH, Range::ANY), Optional, "\"18 cm\"", "Position x, in the world, of the midpoint of its base before it is tilted; the base is its lowest side, or lowest point."),
            key("tilt", Kind::Quantity(Dimension::ANGLE, QUARTER_TURN), DefaultWith { sibling: "on", value: "\"0 deg\"" }, "\"5 deg\"", "Rotation about the end of its base on which it then stands, counter-clockwise positive; it is placed such that its lowest point touches."),
            key("position", POINT, Optional, "[\"18 cm\", \"6.75 cm\"]", "Position of its mass centre, instead of on and at."),
            key("centre", POINT, Optional, "[\"0 m\", \"0 m\"]", "Position of the arch's centre, for a voussoir, instead of position."),
            key("angle", Kind::Quantity(Dimension::ANGLE, QUARTER_TURN), DefaultWith { sibling: "position", value: "\"0 deg\"" }, "\"5 deg\"", "Rotation about its mass centre, counter-clockwise positive; only with position."),
            key("velocity", Kind::Pair(Dimension::VELOCITY, Range::ANY), Default("[\"0 m/s\", \"0 m/s\"]"), "[\"0.1 m/s\", \"0 m/s\"]", "Initial velocity of its mass centre."),
            key("spin", Kind::Quantity(Dimension::ANGULAR_VELOCITY, Range::ANY), Default("\"0 rad/s\""), "\"1 rad/s\"", "Initial angular velocity, counter-clockwise positive."),
            key("fixed", Kind::Flag, Optional, "true", "Whether it never moves."),
        ],
    },
    TableSchema {
        pattern: "block.*.shape",
        occurrence: Occurrence::Inline,
        doc: "Shape of a block by its kind.",
        keys: SHAPE_KEYS,
    },
    TableSchema {
        pattern: "block.*.motion",
        occurrence: Occurrence::Inline,
        doc: "Prescribed motion of the block: of its mass centre, of its angle, or both; components not given stay free. It starts where the block is placed.",
        keys: &[
            DISPLACEMENT, VELOCITY, ACCELERATION,
            key("only", Kind::Choice(&["x", "y"]), Optional, "\"x\"", "The only direction in which the mass centre is prescribed; the other stays free. If left out, both are prescribed."),
            TURN, TURN_VELOCITY, TURN_ACCELERATION, SIGNAL, SIGNALS,
        ],
    },
    recorded("block.*.motion.x", RECORDED_X),
    recorded("block.*.motion.y", RECORDED_Y),
    TableSchema {
        pattern: "block.*.repeat",
        occurrence: Occurrence::Inline,
        doc: "Several blocks of the same kind, named after the table with the suffixes `-1`, `-2`, ….",
        keys: &[
            key("count", Kind::Integer { min: 1, max: 10_000 }, Required, "20", "Number of blocks."),
            key("shift", Kind::Pair(Dimension::LENGTH, Range::ANY), Default("[\"0 m\", \"0 m\"]"), "[\"8 cm\", \"0 cm\"]", "Distance from one to the next; only along x if they stand on something; if stacked, along the upper side of the one before, from its midpoint."),
            key("rows", Kind::Integer { min: 1, max: 10_000 }, Default("1"), "12", "Number of rows, each of `count` blocks; they are numbered row after row. All rows are shifted alike: a wall in running bond is two such tables, one for every other course."),
            key("row_shift", Kind::Pair(Dimension::LENGTH, Range::ANY), Default("[\"0 m\", \"0 m\"]"), "[\"0 cm\", \"10 cm\"]", "Distance from one row to the next."),
            key("jitter", Kind::Pair(Dimension::LENGTH, Range::NOT_NEGATIVE), Default("[\"0 m\", \"0 m\"]"), "[\"5 mm\", \"5 mm\"]", "Most by which each block, the first too, is displaced at random along x and along y, either way; if they stand on something, only along x, and if stacked along the upper side of the one before. All displacements are as likely. Blocks that then start inside each other are refused."),
            key("jitter_angle", Kind::Quantity(Dimension::ANGLE, Range::NOT_NEGATIVE), Default("\"0 deg\""), "\"180 deg\"", "Most by which each is turned at random, either way; only with `position`."),
            key("seed", Kind::Integer { min: 0, max: 1_000_000_000 }, Default("0"), "7", "Which of the random arrangements: the same one always gives the same. A block's displacement depends on this, on the name of its table and on its number in it, and on nothing else."),
            key("turn", ANGLE, Optional, "\"6.6667 deg\"", "Angle from one voussoir to the next, about the centre of their arch, counter-clockwise positive."),
            key("stacked", Kind::Flag, Default("false"), "true", "Whether each stands flat on the one before, and the first on the body given by `on`."),
        ],
    },
    TableSchema {
        pattern: "contact.*",
        occurrence: Occurrence::Named,
        doc: "Contact of a block with a beam, with the ground or with another block, with impact and friction. Bodies without a contact pass through each other.",
        keys: &[
            key("between", Kind::PatternPair, RequiredWithout("materials"), "[\"rocker\", \"table\"]", "Two blocks, or a block and the beam or `ground` that it touches, in either order. Forces and velocities in the tables are those on the block; between two, on the first. A `*` in a name stands for any characters, a `?` for one: [\"brick-*\", \"brick-*\"] is for all pairs of bodies with such names, [\"*\", \"*\"] for all that can touch. Patterns may match any number of pairs of up to 32 768 blocks; from 400 pairs of blocks on, contacts.csv has only contacts with an impulse, and blocks on a beam can't start in equilibrium. Of several contacts that are for a pair the one with full names holds, else that with the most letters in its patterns, else that by materials, else [\"*\", \"*\"]."),
            key("materials", Kind::NamePair, Optional, "[\"granite\", \"steel\"]", "Two materials instead of two bodies: for all pairs of blocks and beams of these materials; of a block with parts its own counts."),
            key("friction", Kind::Number(Range::NOT_NEGATIVE), Required, "0.5", "Coefficient of Coulomb friction."),
            key("friction_left", Kind::Number(Range::NOT_NEGATIVE), Optional, "0.3", "Coefficient at the left foot of the block, the left end of its base as it is drawn upright, instead of `friction`, which then is that of its other corners; of blocks with sharp corners on a beam or on even ground."),
            key("friction_right", Kind::Number(Range::NOT_NEGATIVE), Optional, "0.6", "The same at the right foot."),
            key("restitution", Kind::Number(Range::UNIT), Default("0.0"), "0.0", "Coefficient of restitution: of the normal velocity, or with poisson of the normal impulse.").only_with("law", IMPACTS),
            key("tangential_restitution", Kind::Number(Range::UNIT), Default("0.0"), "0.0", "Fraction of the tangential velocity that is reversed in an impact that sticks.").only_with("law", IMPACTS),
            key("kinematics", Kind::Choice(words::ContactFrames::WORDS), Default("\"deformed\""), "\"deformed\"", "Whether contact frames follow the deformed beam or its undeformed axis; the latter is for blocks that don't slide along a deflected beam."),
            key("face", Kind::Choice(words::Face::WORDS), Optional, "\"lower\"", "The side of the beam that the block touches, of a contact with a beam: upper for what lies on it, lower for what is under it, as a column under a lintel. If left out, lower for a block whose mass centre starts below the beam's axis, else upper. What comes past the end of the beam to the other side of it is not followed there: it counts as deep in the beam, and `deep-penetration` warns."),
            key("points", Kind::Choice(words::TouchingPoints::WORDS), Default("\"all\""), "\"corners\"", "What of the block can touch a beam: all, its corners, and its sides where the beam comes up between them, is supported or ends under them; corners, only those, as in the source paper. A block placed `on` a beam may overhang its end only where `all` is written. With kinematics = linear only corners can."),
            key("law", Kind::Choice(words::Law::WORDS), Default("\"newton\""), "\"newton\"", "Law along the normal: an instantaneous impact (newton, poisson, energetic), or a compliant contact (kelvin-voigt, hunt-crossley)."),
            key("stiffness", Kind::Measure(CONTACT_STIFFNESS, Range::POSITIVE.sizes(1e-12, 1e18)), Required, "\"1e6 N/m\"", "Stiffness k. In F = k d^n (hunt-crossley) its unit is N/m^n; N/m is accepted too, with the same number.").only_with("law", COMPLIANT),
            key("damping", Kind::Measure(CONTACT_DAMPING, Range::NOT_NEGATIVE), Required, "\"10 N s/m\"", "Damping: with kelvin-voigt c in N s/m; with hunt-crossley, in F = k d^n (1 + D v), D in s/m, or c = k D in N s/m^(n+1), for which N s/m is accepted too.").only_with("law", COMPLIANT),
            key("exponent", Kind::Number(EXPONENT), Default("1.5"), "1.5", "Exponent n of the force: 1.5 is that of two spheres.").only_with("law", &["hunt-crossley"]),
        ],
    },
    TableSchema {
        pattern: "signal.*",
        occurrence: Occurrence::Named,
        doc: "A dimensionless time history, with a peak of 1 if given by a formula, or a sum or product of others; the amplitude is given where it is used. Formulas and integrals: `docs/signals.md`.",
        keys: &[
            key("shape", Kind::Choice(words::History::WORDS), Required, "\"one-sine\"", "Shape of the signal."),
            key("start", INSTANT, Default("\"0 s\""), "\"0.1 s\"", "Start time: the signal is 0 before; times of a table are relative to it.").only_with("shape", &["constant", "ramp", "harmonic", "one-sine", "half-sine", "chirp", "table"]),
            key("peak", INSTANT, Required, "\"0.5 s\"", "Time of the peak of a Ricker wavelet.").only_with("shape", &["ricker"]),
            key("duration", TIME, Required, "\"0.2 s\"", "Time in which a ramp reaches 1, or duration of a half sine or of a chirp.").only_with("shape", &["ramp", "half-sine", "chirp"]),
            key("frequency", Kind::Quantity(Dimension::RATE, Range::POSITIVE), Optional, "\"2 Hz\"", "Cycles per second; for a Ricker wavelet the peak of its spectrum. Alternatively give the period.").only_with("shape", OSCILLATING),
            key("period", TIME, Optional, "\"0.5 s\"", "Duration of a cycle, instead of the frequency.").only_with("shape", OSCILLATING),
            key("phase", ANGLE, Default("\"0 deg\""), "\"20 deg\"", "Argument of the sine at the start.").only_with("shape", &["harmonic", "one-sine", "chirp"]),
            key("from", Kind::Quantity(Dimension::RATE, Range::POSITIVE), Required, "\"1 Hz\"", "Frequency at the start of a chirp.").only_with("shape", &["chirp"]),
            key("to", Kind::Quantity(Dimension::RATE, Range::POSITIVE), Required, "\"20 Hz\"", "Frequency at its end, higher or lower.").only_with("shape", &["chirp"]),
            key("growth", Kind::Choice(words::Growth::WORDS), Default("\"linear\""), "\"logarithmic\"", "How the frequency goes from one to the other: linear, by equal differences in equal times; logarithmic, by equal ratios, as many octaves per second at all times.").only_with("shape", &["chirp"]),
            key("terms", Kind::Names, Required, "[\"slow\", \"fast\"]", "Names of the signals that a sum adds, each with its own `scale`; they may be sums or products themselves.").only_with("shape", &["sum"]),
            key("factors", Kind::Names, Required, "[\"envelope\", \"fast\"]", "Names of the signals that a product multiplies, each with its own `scale`; they may be sums or products themselves.").only_with("shape", &["product"]),
            key("file", Kind::Path, Required, "\"quake.csv\"", "File of two columns, time in s and value, or of values alone with `step`; relative to the scene's file.").only_with("shape", &["table"]),
            key("columns", Kind::NamePair, Optional, "[\"time\", \"a_x\"]", "The columns of the file with time and value, by their headings or by their numbers from 1; if left out, it must have two.").only_with("shape", &["table"]),
            key("time_unit", Kind::Choice(words::TimeUnit::WORDS), Optional, "\"ms\"", "Unit of the file's times if its heading has none; s if left out.").only_with("shape", &["table"]),
            key("step", TIME, Optional, "\"10 ms\"", "Time between two values of a file without times, of one column; the first is that at `start`.").only_with("shape", &["table"]),
            key("outside", Kind::Choice(words::Outside::WORDS), Default("\"hold\""), "\"zero\"", "What the signal is before the first row and after the last: hold, the value of that row; zero.").only_with("shape", &["table"]),
            key("scale", Kind::Number(Range::ANY), Optional, "1.2", "Factor of the signal, 1 if left out: it multiplies all amplitudes that the signal does."),
        ],
    },
    TableSchema {
        pattern: "force.*",
        occurrence: Occurrence::Named,
        doc: "A force or couple on a block.",
        keys: &[
            key("on", Kind::Name, Required, "\"rocker\"", "The block."),
            key("force", Kind::Pair(Dimension::FORCE, Range::ANY), Optional, "[\"5 N\", \"0 N\"]", "Force through its mass centre, x and y of the world."),
            key("couple", Kind::Quantity(Dimension::ENERGY, Range::ANY), Optional, "\"1 N m\"", "Couple, counter-clockwise positive; a force through another point is the force through the mass centre and a couple."),
            SIGNAL,
        ],
    },
    TableSchema {
        pattern: "load.*",
        occurrence: Occurrence::Named,
        doc: "A load on a beam: at a point, which may move, or uniformly distributed over the beam or a part of it.",
        keys: &[
            key("on", Kind::Name, Required, "\"table\"", "The beam."),
            key("at", Kind::Quantity(Dimension::LENGTH, Range::ANY), Optional, "\"9 cm\"", "Position of force and couple along the beam, from its left end; for a moving force its position at t = 0, which may be outside the beam."),
            key("force", Kind::Quantity(Dimension::FORCE, Range::ANY), Optional, "\"-10 N\"", "Force at that position, upwards positive."),
            key("couple", Kind::Quantity(Dimension::ENERGY, Range::ANY), Optional, "\"0.1 N m\"", "Couple at that position, counter-clockwise positive."),
            key("speed", Kind::Quantity(Dimension::VELOCITY, Range::ANY), Optional, "\"2 m/s\"", "Velocity of the force along the beam; it acts only while it is on the beam."),
            key("distributed", Kind::Quantity(Dimension::STIFFNESS, Range::ANY), Optional, "\"-10 N/m\"", "Force per length, upwards positive; instead of at, force and couple."),
            Key { presence: Optional, doc: "Start of a distributed load, from the beam's left end, which is the default.", ..FROM },
            Key { presence: Optional, doc: "Its end; if left out, the beam's right end.", ..TO },
            SIGNAL,
        ],
    },
    TableSchema {
        pattern: "solver",
        occurrence: Occurrence::Always,
        doc: "Solution of the contact problem of a step.",
        keys: &[
            key("method", Kind::Choice(&["auto", "pgs", "enumeration", "newton", "smoothing", "prox", "lemke", "acary-cadoux", "admm", "apgd", "vi-eg", "socp"]), Default("\"auto\""), "\"auto\"", "Name of a contact solver; auto selects one for each problem, `docs/solvers.md` describes the others. socp solves a different law, not Coulomb's."),
            key("tolerance", Kind::Number(Range::INSIDE_UNIT), Default("1e-10"), "1e-10", "Relative residual at which a step counts as solved."),
            key("max_iterations", Kind::Integer { min: 1, max: 4_294_967_295 }, Default("10000"), "10000", "Largest number of iterations of a solver in a step."),
            key("require_convergence", Kind::Flag, Default("false"), "false", "Whether an unsolved step ends the run."),
        ],
    },
    TableSchema {
        pattern: "output",
        occurrence: Occurrence::Always,
        doc: "Output of results.",
        keys: &[
            key("every", TIME, Optional, "\"1 ms\"", "Time between rows; if left out, every step up to 10 000 rows, evenly thinned beyond; with more than 300 blocks up to 200 000 rows divided by their number, but at least 100."),
            key("blocks", Kind::Patterns, Optional, "[\"stone-1*\", \"capstone\"]", "The blocks that have columns in trajectory.csv, by names or patterns; the page shows all of them. If left out, all of up to 2000 blocks have columns; of more blocks none has, and blocks.csv has a row for each of them at each time."),
            key("figure_width", Kind::Quantity(Dimension::LENGTH, FIGURE_WIDTH), Default("\"120 mm\""), "\"84 mm\"", "Width of the figures: 84 mm and 174 mm are one and two columns of most journals. Their type is 7 to 8 pt at any width."),
            key("length_unit", Kind::Choice(&["mm", "cm", "m"]), Optional, "\"mm\"", "Unit of lengths on the axes of page and figures; if left out, the one that the scene uses most. What is too small to be read in it has a smaller one. Tables are in SI units."),
            key("angle_unit", Kind::Choice(&["deg", "mrad", "rad"]), Optional, "\"rad\"", "Unit of angles on the axes of page and figures; if left out, the one that the scene uses most, deg if none."),
        ],
    },
];
