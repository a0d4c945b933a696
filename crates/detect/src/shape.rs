//! Shapes that bodies have: convex polygons and discs, fixed in the body.

use crate::Vector;

/// What is wrong with the data of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ShapeError {
    /// Fewer than three corners, or more than a contact's identity can number.
    Corners {
        /// How many there are.
        corners: usize,
    },
    /// A corner that is not finite.
    NotFinite {
        /// Its number.
        corner: usize,
    },
    /// A corner that is the same as the next, or so close to it that the side between them has no direction.
    Twice {
        /// Its number.
        corner: usize,
    },
    /// A corner at which the polygon goes straight on or turns inwards, or sides that cross.
    NotConvex {
        /// Its number.
        corner: usize,
    },
    /// A radius that is not positive and finite, or a centre that is not finite.
    Disc {
        /// The radius, m.
        radius: f64,
    },
}

impl std::fmt::Display for ShapeError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Corners { corners } => {
                write!(f, "a polygon has 3 to {MOST_CORNERS} corners, but there are {corners}")
            }
            Self::NotFinite { corner } => write!(f, "corner {corner} is not finite"),
            Self::Twice { corner } => write!(f, "corner {corner} is in the same place as the next one"),
            Self::NotConvex { corner } => write!(
                f,
                "at corner {corner} the polygon goes straight on or turns inwards: corners must be those of a convex polygon, in order"
            ),
            Self::Disc { radius } => {
                write!(
                    f,
                    "the radius of the disc is {radius} m, but must be positive and finite, and so must its centre be"
                )
            }
        }
    }
}

impl std::error::Error for ShapeError {}

/// As many corners as a contact's identity can number.
pub const MOST_CORNERS: usize = 1 << 15;

/// At a corner that turns by less than this (rad) two sides are one.
const STRAIGHT: f64 = 1e-9;

/// A convex polygon, its corners counter-clockwise in the body's own coordinates. Side k goes from corner k to the next.
///
/// ```
/// use nalgebra::Vector2;
/// use teeter_detect::Polygon;
///
/// let clockwise = [Vector2::new(0.0, 0.0), Vector2::new(0.0, 1.0), Vector2::new(2.0, 0.0)];
/// let wedge = Polygon::new(clockwise.to_vec())?;
/// assert_eq!(wedge.corners()[1], Vector2::new(2.0, 0.0)); // turned
/// assert!(Polygon::new(vec![Vector2::new(0.0, 0.0), Vector2::new(1.0, 0.0), Vector2::new(2.0, 0.0)]).is_err());
/// # Ok::<(), teeter_detect::ShapeError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    corners: Vec<Vector<2>>,
}

impl Polygon {
    /// The polygon of these corners, m; clockwise ones are put in the opposite order, the first one staying first.
    ///
    /// # Errors
    /// If there are fewer than three, or too many to be numbered, one is not finite, two follow each other in one place, or the
    /// polygon isn't convex: it turns inwards, goes straight on or crosses itself.
    pub fn new(mut corners: Vec<Vector<2>>) -> Result<Self, ShapeError> {
        let n = corners.len();
        if !(3..=MOST_CORNERS).contains(&n) {
            return Err(ShapeError::Corners { corners: n });
        }
        if let Some(corner) = corners.iter().position(|x| !x.iter().all(|x| x.is_finite())) {
            return Err(ShapeError::NotFinite { corner });
        }
        let side = |k: usize| corners[(k + 1) % n] - corners[k];
        let size = (0..n).map(|k| side(k).norm()).fold(0.0, f64::max);
        if let Some(corner) = (0..n).find(|&k| side(k).norm() <= STRAIGHT * size) {
            return Err(ShapeError::Twice { corner });
        }
        // The turn from one side to the next, at the corner between them.
        let turn = |k: usize| {
            let (a, b) = (side((k + n - 1) % n), side(k));
            a.perp(&b).atan2(a.dot(&b))
        };
        let around: f64 = (0..n).map(turn).sum();
        let sign = around.signum();
        if let Some(corner) = (0..n).find(|&k| sign * turn(k) <= STRAIGHT) {
            return Err(ShapeError::NotConvex { corner });
        }
        // A star turns one way at every corner, too, but more than once around.
        if around.abs() > 1.5 * std::f64::consts::TAU {
            return Err(ShapeError::NotConvex { corner: 0 });
        }
        if sign < 0.0 {
            corners[1..].reverse();
        }
        Ok(Self { corners })
    }

    /// The corners, counter-clockwise, m.
    #[must_use]
    pub fn corners(&self) -> &[Vector<2>] {
        &self.corners
    }
}

/// A disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    centre: Vector<2>,
    radius: f64,
}

impl Disc {
    /// The disc about `centre` (m, in the body's own coordinates).
    ///
    /// # Errors
    /// If the radius (m) is not positive and finite, or the centre is not finite.
    pub fn new(centre: Vector<2>, radius: f64) -> Result<Self, ShapeError> {
        // Written so that NaN fails too.
        let good = radius > 0.0 && radius.is_finite() && centre.iter().all(|x| x.is_finite());
        if good { Ok(Self { centre, radius }) } else { Err(ShapeError::Disc { radius }) }
    }

    /// The centre in the body's own coordinates, m.
    #[must_use]
    pub fn centre(&self) -> &Vector<2> {
        &self.centre
    }

    /// The radius, m.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

/// The shape of a body.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Shape {
    /// A convex polygon.
    Polygon(Polygon),
    /// A disc.
    Disc(Disc),
}

impl From<Polygon> for Shape {
    fn from(polygon: Polygon) -> Self {
        Self::Polygon(polygon)
    }
}

impl From<Disc> for Shape {
    fn from(disc: Disc) -> Self {
        Self::Disc(disc)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(corners: &[[f64; 2]]) -> Result<Polygon, ShapeError> {
        Polygon::new(corners.iter().map(|x| Vector::<2>::new(x[0], x[1])).collect())
    }

    #[test]
    fn what_is_no_convex_polygon_is_refused_with_the_corner() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        assert!(polygon(&square).is_ok());
        assert_eq!(polygon(&square[..2]), Err(ShapeError::Corners { corners: 2 }));
        let dent = [[0.0, 0.0], [1.0, 0.0], [0.2, 0.2], [0.0, 1.0]];
        assert_eq!(polygon(&dent), Err(ShapeError::NotConvex { corner: 2 }));
        let straight = [[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [0.0, 1.0]];
        assert_eq!(polygon(&straight), Err(ShapeError::NotConvex { corner: 1 }));
        let crossing = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        assert!(matches!(polygon(&crossing), Err(ShapeError::NotConvex { .. })));
        let twice = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        assert_eq!(polygon(&twice), Err(ShapeError::Twice { corner: 1 }));
        let star: Vec<[f64; 2]> =
            (0..5).map(|k| f64::from(2 * k) * 0.4 * std::f64::consts::PI).map(|a| [a.cos(), a.sin()]).collect();
        assert!(matches!(polygon(&star), Err(ShapeError::NotConvex { .. })), "a star turns twice around");
        assert_eq!(polygon(&[[0.0, 0.0], [f64::NAN, 0.0], [0.0, 1.0]]), Err(ShapeError::NotFinite { corner: 1 }));
    }

    #[test]
    fn a_disc_has_a_radius() {
        assert!(Disc::new(Vector::<2>::zeros(), 0.1).is_ok());
        for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(Disc::new(Vector::<2>::zeros(), radius).is_err());
        }
    }
}
