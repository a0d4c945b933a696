//! The blocks of a scene: their shapes, what they are made of, and where they start.

use super::MotionScene;
use nalgebra::Vector2;
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;
use teeter_detect::{Polygon, Shape, ShapeError};
use teeter_rigid::{MassProperties, Rectangle, RigidError};

/// A block of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockScene {
    /// Its name.
    pub name: String,
    /// Width b, m; for another shape than a rectangle the largest of its extents across its sides.
    pub width: f64,
    /// Height H, m; for another shape than a rectangle the smallest of its extents across its
    /// sides.
    pub height: f64,
    /// Its parts, about its mass centre; `None` for a rectangle with these sides and sharp corners.
    pub parts: Option<Arc<[BlockPart]>>,
    /// What it is made of.
    pub matter: Matter,
    /// Where it starts.
    pub placement: Placement,
    /// Velocity of the mass centre, m/s.
    pub velocity: [f64; 2],
    /// Angular velocity, rad/s.
    pub spin: f64,
    /// Its prescribed motion; the rest is free.
    pub motion: MotionScene,
}

/// A part of a block.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockPart {
    /// Its shape, about the block's mass centre.
    pub shape: Shape,
    /// Whether it is a rectangle, perhaps with rounded corners, of which the first is the bottom
    /// left one.
    pub is_rectangle: bool,
}

/// What a block is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Matter {
    /// Everywhere the same.
    Homogeneous {
        /// Density, kg/m³.
        density: f64,
        /// Depth out of the plane, m.
        depth: f64,
    },
    /// By its mass and moment of inertia about the mass centre.
    Given(MassProperties),
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
        support: SupportingBody,
        /// x of the midpoint of its base before it is tilted, m; for a stacked block relative to
        /// the midpoint of the side below, along it.
        at: f64,
        /// Whether it is placed on the block below by `stacked`.
        stacked: bool,
        /// Turn about the corner that it stays on, rad.
        tilt: f64,
        /// The contact between the two.
        contact: usize,
    },
}

/// A body that a block can stand on or touch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum SupportingBody {
    /// The ground.
    Ground,
    /// A beam, by its number in the scene.
    Beam(usize),
    /// Another block, by its number in the scene.
    Block(usize),
}

impl BlockScene {
    /// Mass, kg.
    #[must_use]
    pub fn mass(&self) -> f64 {
        match (&self.parts, self.matter) {
            (None, Matter::Homogeneous { density, depth }) => density * self.width * self.height * depth,
            _ => self.mass_properties().map_or(f64::NAN, |of| of.mass),
        }
    }

    /// Mass and moment of inertia.
    ///
    /// # Errors
    /// If they are not positive and finite.
    pub fn mass_properties(&self) -> Result<MassProperties, RigidError> {
        match (self.matter, self.parts.as_deref()) {
            (Matter::Given(mass), _) => Ok(mass),
            (Matter::Homogeneous { density, depth }, None) => {
                MassProperties::rectangle(&Rectangle::new(self.width, self.height)?, depth, density)
            }
            (Matter::Homogeneous { density, depth }, Some(parts)) => {
                let of =
                    parts.iter().map(|part| mass_of(&part.shape, depth, density)).collect::<Result<Vec<_>, _>>()?;
                Ok(if let [(mass, _)] = *of { mass } else { MassProperties::together(&of)?.0 })
            }
        }
    }

    /// The corners relative to its mass centre, counter-clockwise, m; for a rectangle from the
    /// bottom left. Where a shape is round they are those of its core: the centre of a disc, those
    /// of the circles of roundings. Of several parts those of the first come first.
    #[must_use]
    pub fn corners(&self) -> Vec<Vector2<f64>> {
        let (x, y) = (0.5 * self.width, 0.5 * self.height);
        self.parts.as_ref().map_or_else(
            || [[-x, -y], [x, -y], [x, y], [-x, y]].map(Vector2::from).to_vec(),
            |parts| parts.iter().flat_map(|part| part.shape.core().iter().copied()).collect(),
        )
    }

    /// The shapes of its parts about its mass centre.
    ///
    /// # Errors
    /// If the sides of a rectangle are none.
    pub fn shapes(&self) -> Result<Vec<Shape>, ShapeError> {
        match &self.parts {
            None => Ok(vec![Polygon::new(self.corners())?.into()]),
            Some(parts) => Ok(parts.iter().map(|part| part.shape.clone()).collect()),
        }
    }

    /// Number of corners.
    #[must_use]
    pub fn corner_count(&self) -> usize {
        let of = |parts: &Arc<[BlockPart]>| parts.iter().map(|part| part.shape.core().len()).sum();
        self.parts.as_ref().map_or(Rectangle::CORNER_NAMES.len(), of)
    }

    /// How far the shape reaches beyond a [corner](Self::corners), m: 0 for sharp ones.
    #[must_use]
    pub fn corner_radius(&self, corner: usize) -> f64 {
        self.part_of(corner).map_or(0.0, |(_, part, _)| part.shape.radius())
    }

    /// Whether a part of it is round.
    #[must_use]
    pub fn is_round(&self) -> bool {
        self.parts.iter().flat_map(|parts| parts.iter()).any(|part| part.shape.radius() > 0.0)
    }

    /// The part that has a corner, and the corner's number there.
    fn part_of(&self, corner: usize) -> Option<(usize, &BlockPart, usize)> {
        let mut first = 0;
        for (number, part) in self.parts.as_ref()?.iter().enumerate() {
            let count = part.shape.core().len();
            if corner < first + count {
                return Some((number, part, corner - first));
            }
            first += count;
        }
        None
    }

    /// The name of a corner in tables: bottom-left and so on for a rectangle, rim for a disc,
    /// corner-1 and so on for others; of several parts with the part, as in part-2.rim.
    #[must_use]
    pub fn corner_name(&self, corner: usize) -> String {
        let of_rectangle = |corner: usize| {
            Rectangle::CORNER_NAMES.get(corner).map_or_else(|| corner.to_string(), |name| (*name).to_owned())
        };
        let Some((number, part, own)) = self.part_of(corner) else { return of_rectangle(corner) };
        let name = match &part.shape {
            Shape::Disc(_) => "rim".to_owned(),
            _ if part.is_rectangle => of_rectangle(own),
            _ => format!("corner-{}", own + 1),
        };
        let several = self.parts.as_ref().is_some_and(|parts| parts.len() > 1);
        if several { format!("part-{}.{name}", number + 1) } else { name }
    }

    /// The largest distance of a point of it from the mass centre, m.
    #[must_use]
    pub fn radius(&self) -> f64 {
        match &self.parts {
            None => 0.5 * self.width.hypot(self.height),
            Some(parts) => parts
                .iter()
                .flat_map(|part| part.shape.core().iter().map(|corner| corner.norm() + part.shape.radius()))
                .fold(0.0, f64::max),
        }
    }

    /// The critical angle α = atan(b/H), rad; `None` for other shapes than rectangles.
    #[must_use]
    pub fn critical_angle(&self) -> Option<f64> {
        self.parts.is_none().then(|| self.width.atan2(self.height))
    }

    /// The angle nearest to this one at which a rectangle lies flat, on whichever side, and the
    /// critical angle about that side, rad: upright α, on its side atan(H/b); `None` for other shapes.
    #[must_use]
    pub fn flat_near(&self, angle: f64) -> Option<[f64; 2]> {
        let upright = self.critical_angle()?;
        let quarters = (angle / FRAC_PI_2).round();
        let on_side = quarters.rem_euclid(2.0) == 1.0;
        Some([quarters * FRAC_PI_2, if on_side { FRAC_PI_2 - upright } else { upright }])
    }

    /// The corners at the left and the right end of its base: the lowest ones, as it is drawn; both
    /// are the same where it stands on one.
    #[must_use]
    pub fn feet(&self) -> [usize; 2] {
        if self.parts.is_none() {
            return [0, 1];
        }
        let corners = self.corners();
        let height = |k: &usize| corners[*k].y - self.corner_radius(*k);
        let lowest = (0..corners.len()).map(|k| height(&k)).fold(f64::INFINITY, f64::min);
        let is_low = |k: &usize| height(k) - lowest <= LEVEL * self.width;
        let by_x = |a: &usize, b: &usize| corners[*a].x.total_cmp(&corners[*b].x);
        let left = (0..corners.len()).filter(is_low).min_by(by_x).unwrap_or(0);
        let right = (0..corners.len()).filter(is_low).max_by(by_x).unwrap_or(0);
        [left, right]
    }

    /// The width of its [base](Self::feet), m.
    #[must_use]
    pub fn base(&self) -> f64 {
        if self.parts.is_none() {
            return self.width;
        }
        let (corners, [left, right]) = (self.corners(), self.feet());
        corners[right].x - corners[left].x
    }
}

/// Corners that differ in height by this fraction of a block's size are level.
const LEVEL: f64 = 1e-9;

/// Mass and moment of inertia of a shape, and its mass centre.
///
/// # Errors
/// If they are not positive and finite.
pub(crate) fn mass_of(shape: &Shape, depth: f64, density: f64) -> Result<(MassProperties, Vector2<f64>), RigidError> {
    match shape {
        Shape::Polygon(polygon) => MassProperties::polygon(polygon.corners(), depth, density),
        _ => MassProperties::rounded(shape.core(), shape.radius(), depth, density),
    }
}
