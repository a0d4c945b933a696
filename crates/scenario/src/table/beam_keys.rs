//! Keys that several tables of a beam share: sections, supports, positions.

use super::Presence::{Default, Optional, Required, RequiredWith};
use super::{SIZE, key};
use crate::dimension::Dimension;
use crate::keys::{Key, Kind, Range};

/// Kinds of sections: a profile of a material, or given directly.
pub(super) const PROFILES: &[&str] = &["rectangle", "circle", "tube", "i-section"];
pub(super) const DIRECT: &[&str] = &["direct"];
pub(super) const STIFFNESS: Range = Range::POSITIVE.sizes(1e-18, 1e18);
pub(super) const SPRING_STIFFNESS: Range = Range::NOT_NEGATIVE.sizes(1e-18, 1e18);

pub(super) const SECTION: Key = key(
    "section",
    Kind::Choice(crate::words::Shape::WORDS),
    Default("\"rectangle\""),
    "\"tube\"",
    "Shape of the section; direct: given by its stiffness and mass per length, without a material.",
);
pub(super) const THICKNESS: Key = key(
    "thickness",
    SIZE,
    RequiredWith(&["rectangle"]),
    "\"1.5 mm\"",
    "Height of its section in the plane; with direct only for drawing and for a surface at the top.",
)
.only_with("section", &["rectangle", "direct"]);
pub(super) const WIDTH: Key = key(
    "width",
    SIZE,
    Required,
    "\"3 cm\"",
    "Width of its section out of the plane; for an I-section that of its flanges.",
)
.only_with("section", &["rectangle", "i-section"]);
pub(super) const DIAMETER: Key = key("diameter", SIZE, Required, "\"5 cm\"", "Outer diameter of its section.")
    .only_with("section", &["circle", "tube"]);
pub(super) const WALL: Key =
    key("wall", SIZE, Required, "\"3 mm\"", "Thickness of the tube's wall, at most half the diameter.")
        .only_with("section", &["tube"]);
pub(super) const HEIGHT: Key =
    key("height", SIZE, Required, "\"20 cm\"", "Overall height of an I-section.").only_with("section", &["i-section"]);
pub(super) const WEB: Key =
    key("web", SIZE, Required, "\"5.6 mm\"", "Thickness of its web.").only_with("section", &["i-section"]);
pub(super) const FLANGE: Key = key("flange", SIZE, Required, "\"8.5 mm\"", "Thickness of each of its flanges.")
    .only_with("section", &["i-section"]);
pub(super) const BENDING_STIFFNESS: Key = key(
    "bending_stiffness",
    Kind::Quantity(Dimension::BENDING_STIFFNESS, STIFFNESS),
    Required,
    "\"0.58 N m^2\"",
    "EI.",
)
.only_with("section", DIRECT);
pub(super) const MASS_PER_LENGTH: Key = key(
    "mass_per_length",
    Kind::Quantity(Dimension::MASS_PER_LENGTH, Range::POSITIVE),
    Required,
    "\"0.12 kg/m\"",
    "Mass per length of the beam.",
)
.only_with("section", DIRECT);
pub(super) const SHEAR_STIFFNESS: Key = key(
    "shear_stiffness",
    Kind::Quantity(Dimension::FORCE, STIFFNESS),
    Optional,
    "\"1e6 N\"",
    "G A_s; required with theory = timoshenko.",
)
.only_with("section", DIRECT);
pub(super) const ROTATORY_INERTIA: Key = key(
    "rotatory_inertia",
    Kind::Quantity(Dimension::INERTIA_PER_LENGTH, Range::NOT_NEGATIVE),
    Optional,
    "\"1e-6 kg m\"",
    "Rotatory inertia per length, for theory = timoshenko; 0 if left out.",
)
.only_with("section", DIRECT);
pub(super) const AXIAL_STIFFNESS: Key = key(
    "axial_stiffness",
    Kind::Quantity(Dimension::FORCE, STIFFNESS),
    Optional,
    "\"3 MN\"",
    "EA; required with axial = held or elastic.",
)
.only_with("section", DIRECT);

pub(super) const SPRING: Key = key(
    "spring",
    Kind::Quantity(Dimension::STIFFNESS, SPRING_STIFFNESS),
    Optional,
    "\"1 kN/m\"",
    "Stiffness across the axis.",
);
pub(super) const DASHPOT: Key = key(
    "dashpot",
    Kind::Quantity(Dimension::DAMPING, Range::NOT_NEGATIVE),
    Optional,
    "\"2 N s/m\"",
    "Viscous damping across the axis.",
);
pub(super) const DEFLECTION: Key = key(
    "deflection",
    Kind::Choice(&["fixed", "free"]),
    Optional,
    "\"fixed\"",
    "Instead of spring and dashpot; free if none of them is given.",
);
pub(super) const ROTATIONAL_SPRING: Key = key(
    "rotational_spring",
    Kind::Quantity(Dimension::ENERGY, SPRING_STIFFNESS),
    Optional,
    "\"5 N m/rad\"",
    "Stiffness against rotation.",
);
pub(super) const ROTATIONAL_DASHPOT: Key = key(
    "rotational_dashpot",
    Kind::Quantity(Dimension::ROTATIONAL_DAMPING, Range::NOT_NEGATIVE),
    Optional,
    "\"0.1 N m s\"",
    "Viscous damping of the rotation.",
);
pub(super) const ROTATION: Key = key(
    "rotation",
    Kind::Choice(&["fixed", "free"]),
    Optional,
    "\"fixed\"",
    "Instead of rotational_spring and rotational_dashpot; free if none of them is given.",
);
pub(super) const SUPPORTS: &[&str] = &["pinned", "clamped", "free", "guided"];
pub(super) const SUPPORT_KEYS: &[Key] = &[SPRING, DASHPOT, DEFLECTION, ROTATIONAL_SPRING, ROTATIONAL_DASHPOT, ROTATION];
pub(super) const START_KEYS: &[Key] = &[
    key(
        "mode",
        Kind::Integer { min: 1, max: 20 },
        Optional,
        "1",
        "Number of an elastic mode of the finite elements, from 1; only with amplitude.",
    ),
    key(
        "amplitude",
        Kind::Quantity(Dimension::LENGTH, Range::ANY),
        Optional,
        "\"1 mm\"",
        "Largest deflection of that mode, upwards positive.",
    ),
    key(
        "file",
        Kind::Path,
        Optional,
        "\"shape.csv\"",
        "File of two or three columns, a row for each node: x and w in m, and the slope w'.",
    ),
];

pub(super) const FROM: Key = key(
    "from",
    Kind::Quantity(Dimension::LENGTH, Range::NOT_NEGATIVE),
    Required,
    "\"10 cm\"",
    "Its start, from the beam's left end.",
);
pub(super) const TO: Key =
    key("to", Kind::Quantity(Dimension::LENGTH, Range::NOT_NEGATIVE), Required, "\"26 cm\"", "Where it ends.");
pub(super) const PLACE: Key = key(
    "at",
    Kind::Quantity(Dimension::LENGTH, Range::NOT_NEGATIVE),
    Required,
    "\"18 cm\"",
    "Position along the beam, from its left end.",
);
