//! The rows: number, input, and what the message must name. Numbers are those of the table that the
//! project was given.

/// How a row's scene is made.
pub(crate) enum Input {
    /// The base scene with `--set`.
    Set(&'static [&'static str]),
    /// The base scene with pieces replaced.
    Edit(&'static [(&'static str, &'static str)]),
    /// A scene of its own.
    Text(&'static str),
    /// A scene of two blocks on each other with pieces replaced.
    Stack(&'static [(&'static str, &'static str)]),
    /// A scene of 36 stones in rows, with pieces replaced.
    Pile(&'static [(&'static str, &'static str)]),
    /// The base scene on ground that is shaken by this record; what is absent is a file that isn't
    /// there.
    Record(Option<&'static str>),
    /// The base scene with two elements, that start in the shape of this file.
    Shape(&'static str),
    /// The base scene, to be fitted to this table of measured motion.
    Measured(&'static [u8]),
}

pub(crate) struct Row {
    pub(crate) number: u32,
    pub(crate) what: &'static str,
    pub(crate) input: Input,
    /// Parts that the message must hold.
    pub(crate) says: &'static [&'static str],
    /// Whether it is accepted with a warning.
    pub(crate) warns: bool,
}

use Input::{Edit, Measured, Pile, Record, Set, Shape, Stack, Text};

const fn refused(number: u32, what: &'static str, input: Input, says: &'static [&'static str]) -> Row {
    Row { number, what, input, says, warns: false }
}

const fn warned(number: u32, what: &'static str, input: Input, says: &'static [&'static str]) -> Row {
    Row { number, what, input, says, warns: true }
}

const THICKNESS: &str = "thickness     = \"0.15 cm\"";
const SPAN: &str = "span          = \"36 cm\"";
const MATERIAL: &str = "[block.rocker]\nmaterial = \"aluminium\"";
const TILT: &str = "tilt     = \"5 deg\"    # about its bottom left corner, counter-clockwise";
const PLACE: &str = "on       = \"table\"\n\
     at       = \"18 cm\"    # the middle of its base before it is tilted: midspan\n\
     tilt     = \"5 deg\"    # about its bottom left corner, counter-clockwise";

/// A key that TOML could have, and a table after it.
const DEEP: &str = concat!(
    "[a]\n",
    "b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.",
    "b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.",
    "b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.",
    "b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.",
    "b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b.b = 1\n[output]"
);

/// Two blocks on the ground that share some space.
const OVERLAPPING: &str = "\
[time]
end = \"1 s\"
step = \"1 ms\"
[ground]
[material.oak]
density = \"700 kg/m^3\"
[block.left]
material = \"oak\"
width = \"20 cm\"
height = \"50 cm\"
depth = \"20 cm\"
on = \"ground\"
at = \"0 cm\"
[block.right]
material = \"oak\"
width = \"20 cm\"
height = \"50 cm\"
depth = \"20 cm\"
on = \"ground\"
at = \"19 cm\"
[contact.a]
between = [\"left\", \"ground\"]
friction = 0.5
[contact.b]
between = [\"right\", \"ground\"]
friction = 0.5
";

const RAIL_0: &str = "at = \"0 cm\"\nmotion = { velocity = [\"1 m/s\", \"0 m/s\"], angular_velocity = \"0 rad/s\" }";
const RAIL_1: &str = "at = \"1 cm\"\nmotion = { velocity = [\"1 m/s\", \"0 m/s\"], angular_velocity = \"0 rad/s\" }";

/// The lower block of the stack, held or led, and a push to the right on it.
const LOWER: &str = "on = \"ground\"\nat = \"0 cm\"";
const HELD: &str = "position = [\"0 cm\", \"5 cm\"]\nfixed = true";
const LED: &str =
    "position = [\"0 cm\", \"5 cm\"]\nmotion = { velocity = [\"1 m/s\", \"0 m/s\"], angular_velocity = \"0 rad/s\" }";
const SPIKE: &str =
    "[ground]\nprofile = { points = [[\"-1 cm\", \"0 cm\"], [\"0 cm\", \"9 cm\"], [\"1 cm\", \"0 cm\"]] }";
const PUSH: &str = "[force.push]\non = \"lower\"\nforce = [\"5 N\", \"0 N\"]\n[contact.joint]";

/// Stones in rows, of which any two can touch.
pub(crate) const PILE: &str = "\
[time]
end = \"1 s\"
step = \"1 ms\"
[ground]
[material.oak]
density = \"700 kg/m^3\"
[block.stone]
material = \"oak\"
width = \"10 cm\"
height = \"10 cm\"
depth = \"10 cm\"
position = [\"0 m\", \"6 cm\"]
repeat = { count = 6, shift = [\"12 cm\", \"0 cm\"], rows = 6, row_shift = [\"0 cm\", \"12 cm\"] }
[contact.all]
between = [\"*\", \"*\"]
friction = 0.5
";

/// A block on a block on the ground.
pub(crate) const STACKED: &str = "\
[time]
end = \"1 s\"
step = \"1 ms\"
[ground]
[material.oak]
density = \"700 kg/m^3\"
[block.lower]
material = \"oak\"
width = \"20 cm\"
height = \"10 cm\"
depth = \"20 cm\"
on = \"ground\"
at = \"0 cm\"
[block.upper]
material = \"oak\"
width = \"20 cm\"
height = \"10 cm\"
depth = \"20 cm\"
on = \"lower\"
at = \"1 cm\"
[contact.floor]
between = [\"lower\", \"ground\"]
friction = 0.5
[contact.joint]
between = [\"upper\", \"lower\"]
friction = 0.4
";

#[rustfmt::skip] // a row a line
pub(crate) fn rows() -> Vec<Row> {
    let mut rows = values();
    rows.extend(geometry());
    rows.extend(names());
    rows.extend(limits());
    rows.extend(histories());
    rows.extend(laws());
    rows.extend(beams());
    rows.extend(crowds());
    rows.extend(measured());
    rows
}

#[rustfmt::skip] // a row a line
fn values() -> Vec<Row> {
    vec![
        refused(1, "negative thickness", Edit(&[(THICKNESS, "thickness = \"-0.0015 m\"")]), &["scene.toml:22:13", "beam.table.thickness", "\"-0.0015 m\"", "greater than 0 m"]),
        refused(2, "no thickness", Edit(&[(THICKNESS, "thickness = \"0 m\"")]), &["beam.table.thickness = \"0 m\"", "greater than 0 m"]),
        refused(3, "no span", Edit(&[(SPAN, "span = \"0 m\"")]), &["beam.table.span = \"0 m\"", "greater than 0 m"]),
        refused(4, "modulus not a number", Edit(&[("\"69 GPa\"", "nan")]), &["material.aluminium.youngs_modulus = nan", "not a finite number"]),
        refused(4, "modulus not a number, quoted", Edit(&[("\"69 GPa\"", "\"nan Pa\"")]), &["material.aluminium.youngs_modulus", "not a finite number"]),
        refused(5, "infinite density", Edit(&[("\"2700 kg/m^3\"", "\"inf kg/m^3\"")]), &["material.aluminium.density", "not a finite number"]),
        refused(6, "denormal height", Set(&["block.rocker.height=1e-320 m"]), &["block.rocker.height", "1e-12 m to 1e12 m"]),
        refused(6, "tiny height", Set(&["block.rocker.height=1e-300 m"]), &["block.rocker.height", "1e-12 m to 1e12 m"]),
        refused(6, "huge height", Set(&["block.rocker.height=1e200 m"]), &["block.rocker.height", "1e-12 m to 1e12 m"]),
        refused(7, "negative friction", Edit(&[("friction = 0.5", "friction = -0.1")]), &["contact.feet.friction = -0.1", "at least 0"]),
        refused(7, "negative friction of a foot", Set(&["contact.feet.friction_left=-0.1"]), &["contact.feet.friction_left = -0.1", "at least 0"]),
        refused(7, "friction of feet of a disc", Edit(&[("width    = \"3 cm\"\nheight   = \"13.5 cm\"", "radius = \"5 cm\""), (TILT, ""), ("friction = 0.5", "friction = 0.5\nfriction_right = 0.1")]), &["contact.feet.friction_right = 0.1", "`rocker` is round", "give one `friction`"]),
        refused(7, "friction of feet between blocks", Stack(&[("friction = 0.4", "friction = 0.4\nfriction_left = 0.1")]), &["contact.joint.friction_left = 0.1", "this contact is between blocks"]),
        refused(8, "restitution over one", Set(&["contact.feet.restitution=1.2"]), &["contact.feet.restitution = 1.2", "[0, 1]"]),
        refused(8, "negative restitution", Set(&["contact.feet.restitution=-0.01"]), &["contact.feet.restitution = -0.01", "[0, 1]"]),
        refused(9, "theta over one", Set(&["time.theta=1.5"]), &["time.theta = 1.5", "[0, 1]"]),
        refused(9, "negative theta", Set(&["time.theta=-0.2"]), &["time.theta = -0.2", "[0, 1]"]),
        refused(10, "theta below a half", Set(&["time.theta=0.3"]), &["time.theta = 0.3", "only for steps up to", "on this mesh", "allow_conditional_stability = true"]),
        refused(10, "theta below a half, undamped", Set(&["time.theta=0.3", "beam.table.damping_ratio.ratio=0"]), &["time.theta = 0.3", "at every step size"]),
        refused(11, "no step", Edit(&[("step = \"100 us\"", "step = \"0 s\"")]), &["scene.toml:12:8", "time.step = \"0 s\"", "greater than 0 s"]),
        refused(11, "negative step", Edit(&[("step = \"100 us\"", "step = \"-1e-4 s\"")]), &["time.step = \"-1e-4 s\"", "greater than 0 s"]),
        refused(12, "step longer than the run", Edit(&[("step = \"100 us\"", "step = \"2 s\"")]), &["time.step = \"2 s\"", "longer than the whole run of 0.5 s"]),
        refused(13, "negative end", Set(&["time.end=-1 s"]), &["time.end", "greater than 0 s"]),
        refused(13, "no end", Set(&["time.end=0 s"]), &["time.end", "greater than 0 s"]),
        refused(14, "too many steps", Set(&["time.end=1e6 s", "time.step=1e-9 s"]), &["1.0e15 steps", "limit of 1e12", "32 years"]),
        warned(15, "end between two steps", Edit(&[("end  = \"0.5 s\"", "end  = \"0.50005 s\"")]), &["warning: time.end = \"0.50005 s\"", "continues to 0.5001 s"]),
        refused(16, "no elements", Edit(&[("elements      = 20", "elements = 0")]), &["beam.table.elements = 0", "at least 1"]),
        refused(16, "negative elements", Edit(&[("elements      = 20", "elements = -3")]), &["beam.table.elements = -3", "at least 1"]),
        refused(16, "half an element", Edit(&[("elements      = 20", "elements = 2.5")]), &["beam.table.elements = 2.5", "whole number"]),
        refused(17, "two billion elements", Edit(&[("elements      = 20", "elements = 2_000_000_000")]), &["beam.table.elements = 2_000_000_000", "[1, 10000]", "2.0 TB of memory"]),
        refused(17, "elements beyond 64 bits", Edit(&[("elements      = 20", "elements = 99999999999999999999")]), &["beam.table.elements", "[1, 10000]"]),
        refused(18, "negative damping", Edit(&[("damping_ratio = { mode = 1, ratio = 0.01 }", "viscous_damping = \"-0.1 N s/m^2\"")]), &["beam.table.viscous_damping", "at least 0"]),
        refused(18, "negative Rayleigh damping", Set(&["beam.table.rayleigh={ a1 = '-1 us' }"]), &["beam.table.rayleigh.a1", "at least 0"]),
        refused(19, "tilt over a quarter turn", Edit(&[(TILT, "tilt = \"95 deg\"")]), &["block.rocker.tilt = \"95 deg\"", "[-90 deg, 90 deg]"]),
        refused(19, "tilt without unit", Edit(&[(TILT, "tilt = 5")]), &["block.rocker.tilt = 5", "an angle needs its unit", "5 deg"]),
        warned(19, "tilt beyond the critical angle", Edit(&[(TILT, "tilt = \"20 deg\"")]), &["warning: block.rocker.tilt = \"20 deg\"", "12.53 deg", "overturns"]),
        warned(19, "tilt near the critical angle", Edit(&[(TILT, "tilt = \"-12 deg\"")]), &["warning: block.rocker.tilt = \"-12 deg\"", "within 10 %", "12.53 deg"]),
        refused(20, "gravity as a word", Edit(&[("[material.aluminium]", "[world]\ngravity = \"down\"\n[material.aluminium]")]), &["world.gravity = \"down\"", "an acceleration", "9.81 m/s^2"]),
    ]
}

#[rustfmt::skip] // a row a line
fn geometry() -> Vec<Row> {
    vec![
        refused(21, "block wider than the beam", Set(&["block.rocker.width=50 cm"]), &["block.rocker.width", "0.5 m wide", "0.36 m"]),
        refused(22, "corner off the beam", Edit(&[("at       = \"18 cm\"", "at = \"35 cm\""), (TILT, "")]), &["block.rocker.at = \"35 cm\"", "bottom-right", "x = 0.365 m", "0.36 m", "contact.feet.points = \"all\""]),
        refused(23, "corner below the surface", Edit(&[(PLACE, "position = [\"18 cm\", \"6.65 cm\"]"), ("start         = \"static\"", "")]), &["block.rocker.position", "[\"18 cm\", \"6.65 cm\"]", "1 mm below", "bottom-left", "`table`", "140 pm"]),
        refused(24, "two blocks in one place", Text(OVERLAPPING), &["block.right.at = \"19 cm\"", "`left`", "`right`", "10 mm"]),
        refused(24, "block on a block without a contact", Stack(&[("\"upper\", \"lower\"", "\"upper\", \"ground\"")]), &["block.upper.on = \"lower\"", "there is no contact between the two", "[contact.NAME]"]),
        refused(24, "block on itself", Stack(&[("on = \"lower\"", "on = \"upper\"")]), &["block.upper.on = \"upper\"", "can't stand on itself"]),
        refused(24, "blocks on each other", Stack(&[("on = \"ground\"", "on = \"upper\"")]), &["block.lower.on = \"upper\"", "in a cycle"]),
        refused(24, "block beside the block that it stands on", Stack(&[("at = \"1 cm\"", "at = \"30 cm\"")]), &["block.upper.at = \"30 cm\"", "not above the surface that the block stands on"]),
        refused(24, "blocks joined twice", Stack(&[("friction = 0.4", "friction = 0.4\n[contact.again]\nbetween = [\"lower\", \"upper\"]\nfriction = 0.3")]), &["contact.again", "between the same two bodies"]),
        refused(24, "kinematics between blocks", Stack(&[("friction = 0.4", "friction = 0.4\nkinematics = \"linear\"")]), &["contact.joint.kinematics", "between two blocks"]),
        refused(24, "two blocks that are prescribed", Stack(&[("at = \"0 cm\"", RAIL_0), ("at = \"1 cm\"", RAIL_1)]), &["contact.joint.between", "`lower` can't yield"]),
        refused(25, "static start of a free beam", Edit(&[("\"pinned\", \"pinned\"", "\"free\", \"free\"")]), &["beam.table.start = \"static\"", "rigid body", "both ends are free", "clamp one end or pin both"]),
        refused(25, "static start of a beam on one pin", Edit(&[("\"pinned\", \"pinned\"", "\"pinned\", \"free\"")]), &["beam.table.start = \"static\"", "pinned left end", "support the right end"]),
        refused(25, "static start on a slope without friction", Edit(&[("at       = \"18 cm\"", "at = \"10 cm\""), (TILT, ""), ("friction = 0.5", "friction = 0")]), &["block.rocker.at = \"10 cm\"", "no static equilibrium", "slides", "increase the friction"]),
        refused(25, "static start that tips", Edit(&[("at       = \"18 cm\"", "at = \"34 cm\""), (TILT, ""), ("\"pinned\", \"pinned\"", "\"clamped\", \"free\"")]), &["block.rocker.at = \"34 cm\"", "no static equilibrium", "tips", "stiffer beam"]),
        refused(25, "static start on the other foot", Edit(&[("at       = \"18 cm\"", "at = \"7 cm\""), (TILT, "tilt = \"-0.5 deg\"")]), &["block.rocker.at = \"7 cm\"", "no static equilibrium", "other foot", "tilt it more"]),
        refused(27, "probe off the beam", Edit(&[(SPAN, "probes = [\"9 cm\", \"40 cm\"]\nspan = \"36 cm\"")]), &["beam.table.probes", "0.4 m", "[0, 0.36]"]),
        refused(27, "one element clamped at both ends", Set(&["beam.table.elements=1", "beam.table.supports=['clamped', 'clamped']"]), &["beam.table.elements", "at least 2"]),
    ]
}

#[rustfmt::skip] // a row a line
fn names() -> Vec<Row> {
    vec![
        refused(28, "unknown key", Edit(&[(THICKNESS, "thicknes = \"0.15 cm\"")]), &["scene.toml:22:1", "beam.table.thicknes: unknown key", "did you mean `thickness`?", "material, span, width"]),
        refused(28, "unknown table", Edit(&[("[contact.feet]", "[contacts.feet]")]), &["contacts", "did you mean `contact`?"]),
        refused(29, "mass in place of a length", Edit(&[(SPAN, "span = \"36 kg\"")]), &["scene.toml:20:8", "beam.table.span = \"36 kg\"", "a length (m) is expected, got a mass (kg)"]),
        refused(30, "number in quotes", Edit(&[(SPAN, "span = \"36\"")]), &["beam.table.span = \"36\"", "the unit is missing", "cm"]),
        refused(30, "unknown unit", Edit(&[(SPAN, "span = \"36 furlong\"")]), &["beam.table.span = \"36 furlong\"", "unknown unit `furlong`", "cm, mm"]),
        refused(30, "bare number", Edit(&[(SPAN, "span = 0.36")]), &["beam.table.span = 0.36", "needs its unit", "0.36 m"]),
        refused(31, "decimal comma", Edit(&[(THICKNESS, "thickness = \"1,5 mm\"")]), &["beam.table.thickness = \"1,5 mm\"", "`1,5`", "decimal point: \"1.5 mm\""]),
        refused(32, "two bodies of one name", Edit(&[("[block.rocker]", "[block.table]")]), &["`table`", "beam.table on line 18"]),
        refused(32, "two tables of one name", Edit(&[("[contact.feet]", "[block.rocker]\n[contact.feet]")]), &["block.rocker", "given twice", "line 28"]),
        refused(33, "unknown material", Edit(&[(MATERIAL, "[block.rocker]\nmaterial = \"steel\"")]), &["block.rocker.material = \"steel\"", "`steel` is not defined", "aluminium"]),
        refused(34, "material without density", Edit(&[("density        = \"2700 kg/m^3\"", "")]), &["material.aluminium.density", "missing", "used by beam.table, block.rocker"]),
        refused(34, "beam of a material without modulus", Edit(&[("youngs_modulus = \"69 GPa\"", "")]), &["material.aluminium.youngs_modulus", "used by beam.table"]),
        refused(35, "contact with nobody", Edit(&[("[\"rocker\", \"table\"]", "[\"rocker\", \"tabel\"]")]), &["contact.feet.between", "there is no body `tabel`", "did you mean `table`?", "rocker, table"]),
        refused(35, "contact with itself", Edit(&[("[\"rocker\", \"table\"]", "[\"rocker\", \"rocker\"]")]), &["contact.feet.between", "`rocker` can't touch itself"]),
        refused(36, "a key twice", Edit(&[(SPAN, "span = \"36 cm\"\nspan = \"40 cm\"")]), &["scene.toml:21:1", "beam.table.span", "given twice, first on line 20"]),
        refused(36, "a table by a dotted key too", Edit(&[("[block.rocker]", "[beam]\ntable.elements = 5\n[block.rocker]")]), &["scene.toml:29:1", "beam.table: given twice, first on line 18"]),
        refused(37, "unknown solver", Set(&["solver.method=foo"]), &["solver.method", "unknown method", "auto, pgs, enumeration"]),
        refused(38, "version of the future", Edit(&[("version = 1", "version = 99")]), &["scene.toml:8:11", "version = 99", "version 1", "got 99"]),
        refused(38, "profile of the ground", Edit(&[("[contact.feet]", "[ground]\nprofile = \"hills.csv\"\n[contact.feet]")]), &["ground.profile", "a table is expected", "points", "file"]),
    ]
}

#[rustfmt::skip] // a row a line
fn limits() -> Vec<Row> {
    vec![
        refused(39, "empty file", Text(""), &["contains no scene", "[time]"]),
        refused(39, "comments only", Text("# nothing\n\n   # here\n"), &["contains no scene", "[time]"]),
        refused(42, "cut off file", Text("[time]\nend = \"1 s\"\nstep = \"1 m"), &["scene.toml:3:"]),
        refused(49, "no time between rows", Set(&["output.every=0 s"]), &["output.every", "greater than 0 s"]),
        refused(49, "too much output", Set(&["time.end=1e6 s", "time.step=1 ms", "output.every=1 ms"]), &["output.every", "1.0e9 rows", "GB", "10 GB"]),
        refused(50, "a key of a hundred parts", Edit(&[("[output]", DEEP)]), &["nested too deeply", "at most five parts"]),
        refused(51, "name with a path", Edit(&[("[block.rocker]", "[block.\"../../x\"]")]), &["../../x", "letters (a-z, A-Z), digits, `_` and `-`"]),
    ]
}

#[rustfmt::skip] // a row a line
fn histories() -> Vec<Row> {
    vec![
        refused(43, "accelerogram that is not there", Set(&["ground.motion.x.record=none.at2"]), &["ground.motion.x.record = \"none.at2\"", "there is no such file"]),
        refused(43, "record that is not there", Record(None), &["signal.quake.file = \"quake.csv\"", "there is no such file", "relative to the scene's file"]),
        refused(44, "samples declared, but not there", Record(Some("samples 1300000000\n0,0\n")), &["signal.quake.file", "1 row of numbers", "two or more"]),
        refused(45, "record with NaN", Record(Some("t,a\n0,0\n0.1,1\n0.2,1\n0.3,1\n0.4,1\n0.5,nan\n")), &["signal.quake.file", "line 7", "the value is NaN", "finite"]),
        refused(45, "record whose times go back", Record(Some("t,a\n0,0\n0.2,1\n0.1,1\n0.5,0\n")), &["signal.quake.file", "line 4", "0.1 s is not later than 0.2 s"]),
        refused(45, "record with one row", Record(Some("0,1\n")), &["signal.quake.file", "1 row of numbers", "two or more"]),
        refused(45, "record with a word", Record(Some("0,1\n1,high\n")), &["line 2", "`high` is not a number"]),
        refused(45, "record by commas and semicolons", Record(Some("t,a\n0,1\n1;2\n")), &["line 3", "1 column", "separated by a semicolon"]),
        refused(45, "product of a signal that is not there", Edit(&[("[contact.feet]", "[signal.s]\nshape = \"product\"\nfactors = [\"envelope\"]\n[contact.feet]")]), &["signal.s.factors", "the signal `envelope` is not defined"]),
        refused(45, "terms of a product", Edit(&[("[contact.feet]", "[signal.s]\nshape = \"product\"\nterms = [\"s\"]\n[contact.feet]")]), &["signal.s.terms", "has no meaning with shape = product"]),
        refused(45, "outside of a table that is no word", Edit(&[("[contact.feet]", "[signal.s]\nshape = \"table\"\nfile = \"quake.csv\"\noutside = \"repeat\"\n[contact.feet]")]), &["signal.s.outside = \"repeat\"", "hold", "zero"]),
        warned(46, "record shorter than the run", Record(Some("0,0\n0.1,2\n")), &["warning: signal.quake.file", "ends at 0.1 s", "the run at 0.5 s", "last value, 2, is kept"]),
        refused(38, "signal that is not defined", Edit(&[("[contact.feet]", "[ground]\nmotion = { velocity = [\"1 m/s\", \"0 m/s\"], signal = \"quake\" }\n[contact.feet]")]), &["ground.motion.signal = \"quake\"", "not defined", "[signal.quake]"]),
        refused(38, "two motions in one", Edit(&[("[contact.feet]", "[ground]\nmotion = { velocity = [\"1 m/s\", \"0 m/s\"], displacement = [\"1 m\", \"0 m\"] }\n[contact.feet]")]), &["ground.motion", "prescribe the same motion"]),
        refused(38, "a displacement that jumps", Edit(&[("[contact.feet]", "[signal.late]\nshape = \"constant\"\nstart = \"0.1 s\"\n[ground]\nmotion = { displacement = [\"1 m\", \"0 m\"], signal = \"late\" }\n[contact.feet]")]), &["ground.motion.displacement", "jumps at 0.1 s"]),
        refused(38, "motion without amount", Edit(&[("[contact.feet]", "[ground]\nmotion = {}\n[contact.feet]")]), &["ground.motion", "the motion is missing"]),
        refused(38, "supports of a free beam that move", Edit(&[("[\"pinned\", \"pinned\"]", "[\"free\", \"free\"]\nmotion = { velocity = [\"1 m/s\", \"0 m/s\"] }"), ("start         = \"static\"", "")]), &["beam.table.motion", "the beam has none"]),
        refused(38, "phase of a ramp", Edit(&[("[contact.feet]", "[signal.s]\nshape = \"ramp\"\nduration = \"1 s\"\nphase = \"5 deg\"\n[contact.feet]")]), &["signal.s.phase", "has no meaning with shape = ramp", "harmonic, one-sine"]),
        refused(38, "sine without frequency", Edit(&[("[contact.feet]", "[signal.s]\nshape = \"harmonic\"\n[contact.feet]")]), &["signal.s", "neither frequency nor period"]),
        refused(38, "ramp without duration", Edit(&[("[contact.feet]", "[signal.s]\nshape = \"ramp\"\n[contact.feet]")]), &["signal.s.duration", "missing"]),
        refused(38, "force on a beam", Edit(&[("[contact.feet]", "[force.f]\non = \"table\"\nforce = [\"1 N\", \"0 N\"]\n[contact.feet]")]), &["force.f.on = \"table\"", "is not a block", "[load.NAME]"]),
        refused(38, "load off the beam", Edit(&[("[contact.feet]", "[load.f]\non = \"table\"\nat = \"40 cm\"\nforce = \"1 N\"\n[contact.feet]")]), &["load.f.at = \"40 cm\"", "[0, 0.36] m"]),
        refused(38, "load at a point and all along", Edit(&[("[contact.feet]", "[load.f]\non = \"table\"\nat = \"4 cm\"\ndistributed = \"1 N/m\"\n[contact.feet]")]), &["load.f.at", "doesn't apply to a distributed load"]),
        refused(38, "a velocity given twice", Edit(&[("[contact.feet]", "velocity = [\"1 m/s\", \"0 m/s\"]\nmotion = { velocity = [\"1 m/s\", \"0 m/s\"], only = \"x\" }\n[contact.feet]")]), &["block.rocker.velocity", "the motion of the block prescribes"]),
        refused(38, "a wall for ground", Edit(&[("[contact.feet]", "[ground]\nincline = \"85 deg\"\n[contact.feet]")]), &["ground.incline = \"85 deg\"", "[-80 deg, 80 deg]"]),
        refused(38, "profile and incline", Set(&["ground.incline=5 deg", "ground.profile.points=[['0 m', '0 m'], ['1 m', '1 m']]"]), &["ground.incline", "already gives the slope"]),
    ]
}

#[rustfmt::skip] // a row a line
fn laws() -> Vec<Row> {
    vec![
        refused(8, "restitution of a contact with duration", Edit(&[("friction = 0.5", "friction = 0.5\nrestitution = 0.3\nlaw = \"hunt-crossley\"\nstiffness = \"1e8 N/m^1.5\"\ndamping = \"0.2 s/m\"")]), &["contact.feet.restitution", "has no meaning with law = hunt-crossley", "newton, poisson, energetic"]),
        refused(8, "contact with duration without stiffness", Edit(&[("friction = 0.5", "friction = 0.5\nlaw = \"kelvin-voigt\"")]), &["contact.feet.stiffness", "contact.feet.damping", "missing"]),
        refused(8, "stiffness of an impact", Edit(&[("friction = 0.5", "friction = 0.5\nstiffness = \"1e6 N/m\"")]), &["contact.feet.stiffness", "has no meaning with law = newton", "kelvin-voigt, hunt-crossley"]),
        refused(8, "stiffness in another unit", Edit(&[("friction = 0.5", "friction = 0.5\nlaw = \"kelvin-voigt\"\nstiffness = \"1e6 Pa\"\ndamping = \"1 N s/m\"")]), &["contact.feet.stiffness = \"1e6 Pa\"", "N/m"]),
        refused(8, "stiffness of another exponent", Edit(&[("friction = 0.5", "friction = 0.5\nlaw = \"hunt-crossley\"\nstiffness = \"1e6 N/m^2\"\ndamping = \"1 s/m\"")]), &["contact.feet.stiffness", "exponent 1.5", "N/m^1.5"]),
        refused(8, "linear damping by the exponent", Edit(&[("friction = 0.5", "friction = 0.5\nlaw = \"kelvin-voigt\"\nstiffness = \"1e6 N/m\"\ndamping = \"1 s/m\"")]), &["contact.feet.damping", "N s/m"]),
        refused(9, "theta of moreau-jean-closed", Set(&["time.scheme=moreau-jean-closed", "time.theta=0.6"]), &["time.theta = 0.6", "moreau-jean-closed", "0.5"]),
    ]
}

#[rustfmt::skip] // a row a line
fn beams() -> Vec<Row> {
    vec![
        refused(26, "shape that breaks a support", Shape("x,w\n0,0.002\n0.18,0.001\n0.36,0\n"), &["beam.table.start", "breaks the pinned support at x = 0 m", "w = 0.002 m"]),
        refused(26, "shape with a row too few", Shape("x,w\n0,0\n0.36,0\n"), &["beam.table.start", "expected 3 rows, one for each node, got 2"]),
        refused(26, "shape of another mesh", Shape("0,0\n0.2,0\n0.36,0\n"), &["line 2: x = 0.2 m, but the node of this row is at 0.18 m"]),
        refused(26, "shape beyond all numbers", Shape("0,0\n0.18,1e300\n0.36,0\n"), &["beam.table.start", "line 2, column 2: 1e300 is over 1e12"]),
        refused(26, "shape that is not there", Edit(&[("\"static\"", "{ file = \"shape.csv\" }")]), &["beam.table.start", "there is no such file"]),
        refused(17, "nodes that go back", Edit(&[("elements      = 20", "nodes = [\"0 cm\", \"20 cm\", \"10 cm\", \"36 cm\"]")]), &["beam.table.nodes", "must rise: 0.1 m follows 0.2 m"]),
        refused(16, "neither elements nor nodes", Edit(&[("elements      = 20", "")]), &["beam.table.elements: missing"]),
        refused(3, "wall of a tube beyond its radius", Edit(&[("width         = \"3 cm\"\n", ""), (THICKNESS, "section = \"tube\"\ndiameter = \"2 cm\"\nwall = \"11 mm\"")]), &["beam.table.wall = \"11 mm\"", "at most half the diameter"]),
        refused(3, "a disc as a shape", Edit(&[("width    = \"3 cm\"\nheight   = \"13.5 cm\"\n", "shape = \"disc\"\nradius = \"3 cm\"\n")]), &["a table is expected", "a disc its `radius`"]),
        refused(3, "a disc as a kind of shape", Edit(&[("width    = \"3 cm\"\nheight   = \"13.5 cm\"\n", "shape = { kind = \"disc\", radius = \"3 cm\" }\n")]), &["unknown kind", "a disc its `radius`"]),
        refused(3, "a block without a shape", Edit(&[("width    = \"3 cm\"\nheight   = \"13.5 cm\"\n", "")]), &["block.rocker.width: missing", "or, instead, points, radius"]),
        refused(3, "section without its sides", Edit(&[("width         = \"3 cm\"\n", ""), (THICKNESS, "section = \"i-section\"")]), &["beam.table.height: missing", "beam.table.flange: missing"]),
        refused(28, "key of a support", Set(&["beam.table.supports=[{ sprin = '1 kN/m' }, 'pinned']"]), &["beam.table.supports.sprin: unknown key", "did you mean `spring`?"]),
        refused(28, "word for a support", Set(&["beam.table.supports=['pinned', 'clampt']"]), &["did you mean `clamped`?", "tables of spring"]),
        refused(27, "support at the end", Edit(&[("[block.rocker]", "[beam.table.support.pier]\nat = \"36 cm\"\nkind = \"pinned\"\n[block.rocker]")]), &["beam.table.support.pier.at = \"36 cm\"", "between the ends"]),
        refused(27, "segment beyond the beam", Edit(&[("[block.rocker]", "[beam.table.segment.s]\nfrom = \"20 cm\"\nto = \"40 cm\"\nwidth = \"1 cm\"\nthickness = \"1 cm\"\n[block.rocker]")]), &["beam.table.segment.s.to = \"40 cm\"", "[0, 0.36] m"]),
        refused(34, "shear without Poisson's ratio", Set(&["beam.table.theory=timoshenko"]), &["material.aluminium.poisson_ratio", "used by beam.table with theory = timoshenko"]),
        refused(9, "theta of a beam held along its axis", Set(&["beam.table.axial=held", "time.theta=0.6"]), &["time.theta = 0.6", "`table` is held along its axis", "0.5"]),
        refused(25, "compression beyond buckling", Set(&["beam.table.axial_force=-50 N"]), &["beam.table.axial_force", "buckles under it"]),
        refused(25, "compression beyond buckling, in modes and a shape", Set(&["beam.table.axial_force=-50 N", "beam.table.model=modes", "beam.table.start={ mode = 1, amplitude = '1 mm' }"]), &["error: beam.table.axial_force", "buckles under it"]),
        refused(25, "free beam under compression, in a mode", Set(&["beam.table.axial_force=-50 N", "beam.table.supports=['free', 'free']", "beam.table.start={ mode = 1, amplitude = '1 mm' }"]), &["error: beam.table.axial_force", "not stable under it"]),
        refused(25, "springs that hold nothing", Edit(&[("[\"pinned\", \"pinned\"]", "[{ spring = \"1e-12 N/m\" }, { spring = \"1e-12 N/m\" }]")]), &["beam.table.s", "soft"]),
        refused(18, "one ratio for two frequencies", Edit(&[("damping_ratio = { mode = 1, ratio = 0.01 }", "rayleigh = { frequencies = [\"10 Hz\", \"80 Hz\"], ratios = [0.01] }")]), &["beam.table.rayleigh.ratios", "two ratios are expected, one for each frequency, got 1"]),
        refused(38, "beam in modes held along its axis", Set(&["beam.table.model=modes", "beam.table.axial=held"]), &["beam.table.model", "stretches as it deflects"]),
        refused(38, "modes of a full beam", Set(&["beam.table.modes={ count = 12 }"]), &["beam.table.modes", "applies only with model = modes"]),
        refused(38, "count and tolerance of modes", Set(&["beam.table.model=modes", "beam.table.modes={ count = 12, tolerance = 1e-4 }"]), &["beam.table.modes.tolerance", "count already gives"]),
        refused(38, "more modes than there are", Set(&["beam.table.model=modes", "beam.table.modes={ count = 200 }"]), &["beam.table.modes.count", "200 modes are more than the 40 dofs"]),
        refused(38, "tolerance of modes without digits", Set(&["beam.table.model=modes", "beam.table.modes={ tolerance = 1e-9 }"]), &["beam.table.modes.tolerance", "at least 1e-8 and less than 1"]),
        refused(38, "region of modes beyond the beam", Set(&["beam.table.model=modes", "beam.table.modes={ to = '40 cm' }"]), &["beam.table.modes.to", "[0, 0.36] m"]),
        refused(38, "backend of a beam in modes", Set(&["beam.table.model=modes", "beam.table.backend=sparse"]), &["beam.table.backend", "a beam in modes has a diagonal matrix"]),
        refused(38, "dashpot under a beam in modes", Edit(&[("[block.rocker]", "[beam.table.support.pier]\nat = \"9 cm\"\ndashpot = \"2 N s/m\"\n[block.rocker]"), ("start         = \"static\"", "model = \"modes\"")]), &["beam.table.model", "couples its modes"]),
        refused(18, "Rayleigh damping of nothing", Edit(&[("damping_ratio = { mode = 1, ratio = 0.01 }", "rayleigh = {}")]), &["beam.table.rayleigh", "give a0 and a1, or frequencies and ratios"]),
        refused(25, "beam held along its axis with a free end", Edit(&[("[\"pinned\", \"pinned\"]", "[\"clamped\", \"free\"]\naxial = \"held\"")]), &["beam.table.axial", "the right end is free"]),
        warned(38, "mesh too fine for its digits", Set(&["beam.table.elements=9000"]), &["warning: beam.table.elements", "digits of"]),
        refused(21, "block by its points and by its sides", Set(&["block.rocker.points=[['0 m', '0 m'], ['1 cm', '0 m'], ['0 m', '1 cm']]"]), &["block.rocker.width", "points already give"]),
        refused(21, "points on one line", Edit(&[("width    = \"3 cm\"", "points = [[\"0 cm\", \"0 cm\"], [\"3 cm\", \"0 cm\"], [\"9 cm\", \"0 cm\"]]"), ("height   = \"13.5 cm\"", "")]), &["block.rocker.points", "all points are on one line"]),
        refused(21, "block by its radius and by its sides", Set(&["block.rocker.radius=2 cm"]), &["block.rocker.width", "radius already gives the shape"]),
        refused(21, "point without y", Set(&["block.rocker.points=[['0 m'], ['1 cm', '0 m'], ['0 m', '1 cm']]"]), &["block.rocker.points", "an array of two is expected, got 1"]),
        refused(8, "lower face of a block above", Set(&["contact.feet.face=lower"]), &["contact.feet.face", "`rocker` starts above `table`", "leave it out"]),
        refused(8, "face misspelt", Set(&["contact.feet.face=below"]), &["contact.feet.face", "upper", "lower"]),
        refused(8, "unknown points", Set(&["contact.feet.points=sides"]), &["contact.feet.points", "all", "corners"]),
        refused(8, "face of the ground", Edit(&[("[contact.feet]", "[ground]\n[contact.floor]\nbetween = [\"rocker\", \"ground\"]\nfriction = 0.5\nface = \"upper\"\n[contact.feet]")]), &["contact.floor.face", "for contacts with beams"]),
        refused(8, "stop misspelt", Set(&["time.stop=['overturn']"]), &["time.stop", "overturned", "rest", "sunk"]),
        refused(8, "stop without brackets", Set(&["time.stop=overturned"]), &["time.stop", "array"]),
        refused(8, "stop twice", Set(&["time.stop=['rest', 'rest']"]), &["time.stop"]),
        warned(54, "force on a fixed block", Stack(&[(LOWER, HELD), ("\"lower\", \"ground\"", "\"upper\", \"ground\""), ("[contact.joint]", PUSH)]), &["warning: force.push.on = \"lower\"", "no effect", "fixed"]),
        warned(54, "force along a prescribed axis", Stack(&[(LOWER, LED), ("\"lower\", \"ground\"", "\"upper\", \"ground\""), ("[contact.joint]", PUSH)]), &["warning: force.push.on = \"lower\"", "no effect", "prescribed"]),
        refused(54, "crest deep inside a block", Stack(&[("[ground]", SPIKE), (LOWER, "position = [\"0 cm\", \"5 cm\"]")]), &["block.lower.position", "crest-2", "inside the block"]),
        refused(54, "disc on a sloping beam in equilibrium", Edit(&[("width    = \"3 cm\"\nheight   = \"13.5 cm\"", "radius = \"3 cm\""), (PLACE, "on = \"table\"\nat = \"9 cm\"")]), &["block.rocker.at", "the block rolls", "level"]),
        warned(38, "thick beam without shear", Set(&["beam.table.thickness=4 cm"]), &["warning: beam.table.theory", "0.11 of the span", "timoshenko"]),
    ]
}

/// Many blocks whose pairs are not listed one by one, and copies at random places.
#[rustfmt::skip] // a row a line
fn crowds() -> Vec<Row> {
    const REPEAT: &str = "[\"0 cm\", \"12 cm\"] }";
    const PLACE: &str = "position = [\"0 m\", \"6 cm\"]";
    const ROWS: &str = "repeat = { count = 6, shift = [\"12 cm\", \"0 cm\"], rows = 6, row_shift = [\"0 cm\", \"12 cm\"] }";
    vec![
        refused(52, "two patterns that say as much", Pile(&[("[contact.all]", "[contact.one]\nbetween = [\"stone-*\", \"*\"]\nfriction = 0.3\n[contact.other]\nbetween = [\"*\", \"stone-*\"]\nfriction = 0.4\n[contact.all]")]), &["contact.other", "says no more of the bodies than `one`"]),
        refused(52, "stones that are all prescribed", Pile(&[("[contact.all]", "[block.stone.motion]\nvelocity = [\"1 m/s\", \"0 m/s\"]\nangular_velocity = \"0 rad/s\"\n[contact.all]")]), &["contact.all.between", "can't yield to it", "world.apart"]),
        refused(52, "contact of a pair that is kept apart", Pile(&[("[contact.all]", "[world]\napart = [[\"stone-*\", \"stone-*\"]]\n[contact.one]\nbetween = [\"stone-1\", \"stone-2\"]\nfriction = 0.9\n[contact.all]")]), &["contact.one.between", "world.apart"]),
        refused(52, "more stones than pairs can be numbered of", Pile(&[("count = 6", "count = 200"), ("rows = 6", "rows = 165")]), &["block", "33000 blocks of which any two may touch", "32768", "use fewer blocks"]),
        refused(52, "negative friction of a crowd", Pile(&[("friction = 0.5", "friction = -0.5")]), &["contact.all.friction = -0.5"]),
        refused(52, "stones that start inside each other", Pile(&[("[\"12 cm\", \"0 cm\"]", "[\"9 cm\", \"0 cm\"]")]), &["block.stone.position", "overlaps", "`stone-"]),
        refused(52, "a crowd on a beam in equilibrium", Pile(&[(ROWS, "repeat = { count = 40, stacked = true }"), (PLACE, "on = \"floor\"\nat = \"3 m\""), ("[ground]\n", ""), ("density = \"700 kg/m^3\"", "density = \"700 kg/m^3\"\nyoungs_modulus = \"11 GPa\"\n[beam.floor]\nmaterial = \"oak\"\nspan = \"6 m\"\nwidth = \"20 cm\"\nthickness = \"30 cm\"\nelements = 20\nsupports = [\"pinned\", \"pinned\"]\nstart = \"static\"")]), &["beam.floor.start", "only with up to 400", "start undeformed"]),
        refused(53, "negative jitter", Pile(&[(REPEAT, "[\"0 cm\", \"12 cm\"], jitter = [\"-1 mm\", \"1 mm\"] }")]), &["block.stone.repeat.jitter", "0 m"]),
        refused(53, "jitter without y", Pile(&[(REPEAT, "[\"0 cm\", \"12 cm\"], jitter = [\"1 mm\"] }")]), &["block.stone.repeat.jitter", "array of two"]),
        refused(53, "jitter into each other", Pile(&[(REPEAT, "[\"0 cm\", \"12 cm\"], jitter = [\"6 cm\", \"0 mm\"] }")]), &["block.stone", "overlaps"]),
        refused(53, "jitter that lifts off the ground", Pile(&[(ROWS, "repeat = { count = 6, shift = [\"12 cm\", \"0 cm\"], jitter = [\"1 mm\", \"1 mm\"] }"), (PLACE, "on = \"ground\"\nat = \"0 m\"")]), &["block.stone.repeat.jitter", "shifted only along x", "set y to 0"]),
        refused(53, "random angles on the ground", Pile(&[(ROWS, "repeat = { count = 6, shift = [\"12 cm\", \"0 cm\"], jitter_angle = \"5 deg\" }"), (PLACE, "on = \"ground\"\nat = \"0 m\"")]), &["block.stone.repeat.jitter_angle", "only about a position", "leave it out"]),
        refused(53, "seed that is no whole number", Pile(&[(REPEAT, "[\"0 cm\", \"12 cm\"], jitter = [\"1 mm\", \"1 mm\"], seed = 1.5 }")]), &["block.stone.repeat.seed = 1.5"]),
        refused(53, "negative seed", Pile(&[(REPEAT, "[\"0 cm\", \"12 cm\"], jitter = [\"1 mm\", \"1 mm\"], seed = -1 }")]), &["block.stone.repeat.seed = -1"]),
        warned(53, "seed of nothing random", Pile(&[(REPEAT, "[\"0 cm\", \"12 cm\"], seed = 1 }")]), &["warning: block.stone.repeat.seed", "nothing is random"]),
    ]
}

/// Tables of measured motion.
#[rustfmt::skip] // a row a line
fn measured() -> Vec<Row> {
    vec![
        refused(39, "empty measured table", Measured(b""), &["the file is empty"]),
        refused(39, "measured table of comments", Measured(b"# t,phi\n\n"), &["the file is empty"]),
        refused(39, "measured table without rows", Measured(b"t,phi\n"), &["there is a heading, but no row of numbers"]),
        refused(40, "measured table that is a picture", Measured(b"\x89PNG\r\n\x1a\n"), &["not a text file in UTF-8"]),
        refused(45, "measured angle that is no number", Measured(b"t,phi\n0,0.1\n1,nan\n"), &["line 3", "`nan`", "lost frame"]),
        refused(45, "measured word", Measured(b"t,phi\n0,0.1\n1,high\n"), &["line 3", "`high`"]),
        refused(45, "measured times that go back", Measured(b"t,phi\n0,0.1\n1,0.1\n0.5,0.1\n"), &["line 4", "t = 0.5 s"]),
        refused(45, "one measured row", Measured(b"t,phi\n0,0.1\n"), &["phi has 1 value"]),
        refused(45, "ragged measured table", Measured(b"t,phi\n0,0.1\n1\n"), &["line 3", "1 column"]),
        refused(29, "measured angle in kg", Measured(b"t,phi [kg]\n0,0.1\n"), &["the unit `kg` of phi"]),
        refused(30, "measured angle in furlongs", Measured(b"t,phi [furlong]\n0,0.1\n"), &["the unit `furlong` of phi"]),
        refused(28, "measured column of another name", Measured(b"t,angle\n0,0.1\n"), &["`angle`", "--column phi"]),
        refused(28, "measured columns without names", Measured(b"0,0.1\n1,0.1\n"), &["2 columns without headings"]),
        refused(19, "measured angles in degrees", Measured(b"t,phi\n0,5\n1,5\n2,5\n3,4\n4,3\n5,1\n6,-1\n7,-3\n8,-4\n"), &["line 2", "--unit phi=deg"]),
    ]
}
