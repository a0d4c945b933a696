//! Keys that a block and its parts share: shapes, and what they are made of.

use super::Presence::{Default, Optional, Required, RequiredWithoutAny};
use super::{ANGLE, POINT, SIZE, key};
use crate::dimension::Dimension;
use crate::keys::{Key, Kind, Range};
use crate::words::ShapeKind;

pub(super) const MATERIAL: Key = key(
    "material",
    Kind::Name,
    RequiredWithoutAny(&["mass", "density", "parts"]),
    "\"aluminium\"",
    "Name of its material; of a block with parts, that of those that have none of their own.",
);
pub(super) const BLOCK_DENSITY: Key = key(
    "density",
    Kind::Quantity(Dimension::DENSITY, Range::POSITIVE),
    Optional,
    "\"2700 kg/m^3\"",
    "Mass per volume, instead of a material.",
);
/// The other ways to give a shape.
const SHAPES: &[&str] = &["points", "radius", "shape", "parts"];
pub(super) const BLOCK_WIDTH: Key =
    key("width", SIZE, RequiredWithoutAny(SHAPES), "\"3 cm\"", "Width of a rectangle's base.");
pub(super) const BLOCK_HEIGHT: Key =
    key("height", SIZE, RequiredWithoutAny(SHAPES), "\"13.5 cm\"", "Height of a rectangle.");
pub(super) const POINTS: Key = key(
    "points",
    Kind::Points(Dimension::LENGTH, Range::ANY),
    Optional,
    "[[\"0 cm\", \"0 cm\"], [\"30 cm\", \"0 cm\"], [\"20 cm\", \"15 cm\"]]",
    "Corners of a convex polygon, in order around it. A block without a position starts where they are; with one its mass \
     centre is moved there. Tables call them `corner-1`, `corner-2`, …, counter-clockwise from the first.",
);
pub(super) const RADIUS: Key =
    key("radius", SIZE, Optional, "\"5 cm\"", "Radius of a disc; tables call its point of contact `rim`.");
pub(super) const ROUNDING: Key = key(
    "rounding",
    SIZE,
    Optional,
    "\"2 mm\"",
    "Radius to which the corners of a polygon are rounded; mass and inertia are those of the rounded shape.",
);
pub(super) const CHAMFER: Key = key(
    "chamfer",
    SIZE,
    Optional,
    "\"2 mm\"",
    "Length that is cut off from both sides at each corner of a polygon, which gets two corners for each.",
);

/// The shapes that have no kind.
const ELSEWHERE: &str =
    "without `shape`, a rectangle has `width` and `height`, a disc its `radius`, another polygon its `points`";

pub(super) const SHAPE_KEYS: &[Key] = &[
    key(
        "kind",
        Kind::Choice(ShapeKind::WORDS),
        Required,
        "\"regular\"",
        "regular: a regular polygon, its first side level at the bottom; trapezoid: with level bottom and top; voussoir: a \
         stone of an arch; stadium: a rectangle with half circles at its ends.",
    )
    .elsewhere(ELSEWHERE),
    key("sides", Kind::Integer { min: 3, max: 1000 }, Required, "6", "Number of sides.").only_with("kind", REGULAR),
    key("radius", SIZE, Required, "\"5 cm\"", "Distance of the corners from the centre, or radius of the ends.")
        .only_with("kind", &["regular", "stadium"]),
    key("bottom", SIZE, Required, "\"8 cm\"", "Length of the lower side.").only_with("kind", TRAPEZOID),
    key("top", SIZE, Required, "\"5 cm\"", "Length of the upper side.").only_with("kind", TRAPEZOID),
    key("height", SIZE, Required, "\"4 cm\"", "Distance between the two.").only_with("kind", TRAPEZOID),
    key(
        "shift",
        Kind::Quantity(Dimension::LENGTH, Range::ANY),
        Default("\"0 m\""),
        "\"1 cm\"",
        "Shift of the middle of the upper side to the right of that of the lower one.",
    )
    .only_with("kind", TRAPEZOID),
    key("inner", SIZE, Required, "\"95 cm\"", "Distance of its inner corners from the arch's centre.")
        .only_with("kind", VOUSSOIR),
    key("outer", SIZE, Required, "\"105 cm\"", "Distance of its outer corners from the arch's centre.")
        .only_with("kind", VOUSSOIR),
    key("from", ANGLE, Required, "\"80 deg\"", "Angle at which it begins, counter-clockwise from the horizontal.")
        .only_with("kind", VOUSSOIR),
    key("to", ANGLE, Required, "\"90 deg\"", "Angle at which it ends.").only_with("kind", VOUSSOIR),
    key("length", SIZE, Required, "\"6 cm\"", "Distance between the centres of its ends.").only_with("kind", STADIUM),
];
const REGULAR: &[&str] = &["regular"];
const TRAPEZOID: &[&str] = &["trapezoid"];
const VOUSSOIR: &[&str] = &["voussoir"];
const STADIUM: &[&str] = &["stadium"];

/// A key that a part may leave out.
const fn of_part(key: Key) -> Key {
    Key { presence: Optional, ..key }
}

pub(super) const PART_KEYS: &[Key] = &[
    of_part(BLOCK_WIDTH),
    of_part(BLOCK_HEIGHT),
    POINTS,
    RADIUS,
    key(
        "shape",
        Kind::WordOrTable(&[], SHAPE_KEYS),
        Optional,
        "{ kind = \"regular\", sides = 6, radius = \"5 cm\" }",
        "Shape by its kind.",
    ),
    ROUNDING,
    CHAMFER,
    key(
        "at",
        POINT,
        Optional,
        "[\"0 cm\", \"2 cm\"]",
        "Where the origin of its shape is: of a rectangle, a disc, a regular polygon, a stadium its centre, of a trapezoid the \
         middle of its lower side, of a voussoir the arch's centre.",
    ),
    key("angle", ANGLE, Optional, "\"45 deg\"", "Rotation about that origin, counter-clockwise positive."),
    of_part(MATERIAL),
];
