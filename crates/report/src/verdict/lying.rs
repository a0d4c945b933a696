//! On which side a block that rests lies (`docs/verdict.md`).

use super::stance::Outline;
use serde::{Serialize, Serializer};
use std::f64::consts::{FRAC_PI_2, PI};
use teeter_scenario::scene::BlockScene;

/// A block lies on a side if it is turned from lying flat there by less than this, rad (10°): beams bend, and ground that a block slid along may be
/// steeper than where it began. What rests at a larger angle leans on something.
const FLAT: f64 = 10.0 * PI / 180.0;

/// Directions of sides as drawn that count as the same, rad.
const ALIGNED: f64 = 1e-6;

/// A side of a block, named as it is drawn upright.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Side {
    /// The one between its feet.
    Base,
    /// The right one of a rectangle.
    Right,
    /// The left one of a rectangle.
    Left,
    /// The upper one of a rectangle.
    Top,
    /// Another side of another shape, by the names of its corners.
    Between(String, String),
}

impl Side {
    /// Its word in `summary.json`.
    #[must_use]
    pub fn word(&self) -> String {
        match self {
            Self::Base => "base".to_owned(),
            Self::Right => "right side".to_owned(),
            Self::Left => "left side".to_owned(),
            Self::Top => "top".to_owned(),
            Self::Between(from, to) => format!("side from {from} to {to}"),
        }
    }

    /// The side of a block that is below when the block is turned by this angle (rad) from the level of what carries it; `None` of one that leans, or
    /// has no sides to lie on.
    pub(super) fn below(block: &BlockScene, outline: &Outline, angle: f64) -> Option<Self> {
        let flat = outline.stance(angle)?.flat;
        if (angle - flat).abs() > FLAT {
            return None;
        }
        let down = outline.gamma - flat;
        let [from, to] = outline.lowest_at(down)?;
        let [left, right] = block.feet();
        if [from, to] == [left, right] {
            return Some(Self::Base);
        }
        // The direction that points down, of a rectangle as drawn.
        let is = |direction: f64| (down - direction).sin().abs() < ALIGNED && (down - direction).cos() > 0.0;
        let is_rectangle =
            [left, right] == [0, 1] && block.corner_name(0) == "bottom-left" && block.corner_count() == 4;
        Some(match (is_rectangle, from, to) {
            (true, ..) if is(0.0) => Self::Right,
            (true, ..) if is(PI) => Self::Left,
            (true, ..) if is(FRAC_PI_2) => Self::Top,
            _ => Self::Between(block.corner_name(from), block.corner_name(to)),
        })
    }
}

impl Serialize for Side {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.word())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn below(shape: &str, degrees: f64) -> Option<String> {
        let scene = format!(
            "[time]\nend = '1 s'\nstep = '1 ms'\n[ground]\n[material.a]\ndensity = '1000 kg/m^3'\n[block.r]\nmaterial = 'a'\ndepth = '1 m'\n\
             position = ['0 m', '9 m']\n{shape}\n"
        );
        let scene = teeter_scenario::load(scene.as_bytes(), "f", "f", &[]).unwrap().scene;
        let block = &scene.blocks[0];
        let side = Side::below(block, &Outline::of(block, scene.gravity)?, degrees.to_radians())?;
        Some(side.word())
    }

    #[test]
    fn a_rectangle_lies_on_the_side_that_faces_down_after_any_number_of_turns() {
        for shape in ["width = '1 m'\nheight = '3 m'", "width = '1 m'\nheight = '3 m'\nrounding = '10 cm'"] {
            for (angle, side) in [
                (0.0, "base"),
                (-90.0, "right side"),
                (90.0, "left side"),
                (180.0, "top"),
                (-180.0, "top"),
                (-450.0, "right side"),
                (-630.0, "left side"),
                (720.0, "base"),
                (-84.0, "right side"),
            ] {
                assert_eq!(below(shape, angle).as_deref(), Some(side), "{shape} at {angle}");
            }
            assert_eq!(below(shape, -60.0), None, "it leans on something");
        }
    }

    #[test]
    fn sides_of_other_shapes_go_by_their_corners() {
        let pentagon = "shape = { kind = 'regular', sides = 5, radius = '1 m' }";
        assert_eq!(below(pentagon, 0.0).as_deref(), Some("base"));
        // Turned clockwise by a fifth, it lies on the side after its base, counter-clockwise.
        let turned = below(pentagon, -72.0).unwrap();
        assert!(turned.starts_with("side from corner-"), "{turned}");
        assert_ne!(below(pentagon, 72.0).unwrap(), turned);
        assert_eq!(below("radius = '1 m'", 0.0), None, "a disc has no sides");
    }
}
