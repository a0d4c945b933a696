//! Shapes that bodies have: convex polygons, discs, polygons with rounded corners, fixed in the
//! body.

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
    /// A corner that is the same as the next, or so close to it that the side between them has no
    /// direction.
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
    /// A profile of fewer than two points, or more than a contact's identity can number.
    ProfilePoints {
        /// How many there are.
        points: usize,
    },
    /// A point of a profile that is not to the right of the one before it.
    NotRising {
        /// Its number.
        point: usize,
    },
    /// A radius to which the corners of a polygon can't be rounded.
    Rounding {
        /// The radius, m.
        radius: f64,
        /// It must be less than this, m.
        most: f64,
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
                write!(f, "the radius is {radius} m, but must be positive and finite, and so must the centre be")
            }
            Self::ProfilePoints { points } => {
                write!(f, "a profile has 2 to {} points, but there are {points}", MOST_CORNERS - 2)
            }
            Self::NotRising { point } => {
                write!(f, "point {point} of the profile is not to the right of the one before it: its x must rise")
            }
            Self::Rounding { radius, most } => {
                write!(
                    f,
                    "the corners are rounded to {radius} m, but the polygon has room for radii above 0 and below {most} m"
                )
            }
        }
    }
}

impl std::error::Error for ShapeError {}

/// As many corners of a body as a contact's identity can number.
pub const MOST_CORNERS: usize = (1 << 15) - 1;

/// At a corner that turns by less than this (rad) two sides are one.
const STRAIGHT: f64 = 1e-9;

/// A convex polygon, its corners counter-clockwise in the body's own coordinates. Side k goes from
/// corner k to the next.
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
    /// The polygon of these corners, m; clockwise ones are put in the opposite order, the first one
    /// staying first.
    ///
    /// # Errors
    /// If there are fewer than three, or too many to be numbered, one is not finite, two follow
    /// each other in one place, or the polygon isn't convex: it turns inwards, goes straight on or
    /// crosses itself.
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

/// All that is at most some radius from a convex core: a polygon with rounded corners; of a core of
/// two points a stadium.
///
/// ```
/// use nalgebra::Vector2;
/// use teeter_detect::{Polygon, Rounded};
///
/// let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(Vector2::from);
/// let rounded = Rounded::inside(&Polygon::new(square.to_vec())?, 0.2)?;
/// assert!((rounded.core()[2] - Vector2::new(0.8, 0.8)).norm() < 1e-15);
/// # Ok::<(), teeter_detect::ShapeError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Rounded {
    core: Vec<Vector<2>>,
    radius: f64,
}

impl Rounded {
    /// All that is at most `radius` (m) from the convex polygon of these corners (m), or from the
    /// line between two points.
    ///
    /// # Errors
    /// If the radius is not positive and finite, or the corners are none of a convex polygon, nor
    /// two points apart.
    pub fn new(core: Vec<Vector<2>>, radius: f64) -> Result<Self, ShapeError> {
        // Written so that NaN fails too.
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(ShapeError::Disc { radius });
        }
        let core = match core.len() {
            2 => {
                if let Some(corner) = core.iter().position(|x| !x.iter().all(|x| x.is_finite())) {
                    return Err(ShapeError::NotFinite { corner });
                }
                if core[0] == core[1] {
                    return Err(ShapeError::Twice { corner: 0 });
                }
                core
            }
            _ => Polygon::new(core)?.corners,
        };
        Ok(Self { core, radius })
    }

    /// The polygon with its corners rounded to `radius` (m): each side keeps its line and gets
    /// shorter.
    ///
    /// # Errors
    /// If the radius is not positive, or so large that nothing of a side would be left.
    pub fn inside(polygon: &Polygon, radius: f64) -> Result<Self, ShapeError> {
        let corners = &polygon.corners;
        let n = corners.len();
        // Half the turn at each corner: a circle of radius r that touches both sides there begins r
        // tan(turn/2) from the corner.
        let tangents: Vec<f64> = (0..n)
            .map(|k| {
                let (before, after) = (corners[k] - corners[(k + n - 1) % n], corners[(k + 1) % n] - corners[k]);
                (0.5 * before.perp(&after).atan2(before.dot(&after))).tan()
            })
            .collect();
        let room = |k: usize| (corners[(k + 1) % n] - corners[k]).norm() / (tangents[k] + tangents[(k + 1) % n]);
        let most = (0..n).map(room).fold(f64::INFINITY, f64::min);
        // Written so that NaN fails too. A side of which rounding alone is left has no direction.
        if !(radius > 0.0 && radius < most * (1.0 - STRAIGHT)) {
            return Err(ShapeError::Rounding { radius, most });
        }
        let core = (0..n).map(|k| {
            let along = (corners[(k + 1) % n] - corners[k]).normalize();
            corners[k] + radius * (along * tangents[k] + Vector::<2>::new(-along.y, along.x))
        });
        Ok(Self { core: core.collect(), radius })
    }

    /// The corners of the core, counter-clockwise, m.
    #[must_use]
    pub fn core(&self) -> &[Vector<2>] {
        &self.core
    }

    /// The radius, m.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

/// The shape of a body, or of a part of it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Shape {
    /// A convex polygon.
    Polygon(Polygon),
    /// A disc.
    Disc(Disc),
    /// A convex polygon with rounded corners, or a stadium.
    Rounded(Rounded),
}

impl Shape {
    /// The corners of what the shape is within a [radius](Self::radius) of: its own of a polygon,
    /// the centre of a disc; m, in the body's own coordinates.
    #[must_use]
    pub fn core(&self) -> &[Vector<2>] {
        match self {
            Self::Polygon(polygon) => polygon.corners(),
            Self::Disc(disc) => std::slice::from_ref(disc.centre()),
            Self::Rounded(rounded) => rounded.core(),
        }
    }

    /// How far it reaches beyond its [core](Self::core), m; 0 for a polygon.
    #[must_use]
    pub fn radius(&self) -> f64 {
        match self {
            Self::Polygon(_) => 0.0,
            Self::Disc(disc) => disc.radius(),
            Self::Rounded(rounded) => rounded.radius(),
        }
    }
}

impl From<Rounded> for Shape {
    fn from(rounded: Rounded) -> Self {
        Self::Rounded(rounded)
    }
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
    fn corners_are_rounded_as_far_as_sides_last() {
        let triangle = polygon(&[[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]]).unwrap();
        // The circle that touches all three sides has radius 1.
        for (radius, fits) in [(0.5, true), (0.999, true), (1.0, false), (2.0, false), (0.0, false), (f64::NAN, false)]
        {
            let rounded = Rounded::inside(&triangle, radius);
            assert_eq!(rounded.is_ok(), fits, "{radius}: {rounded:?}");
            let Ok(rounded) = rounded else { continue };
            assert!((rounded.core()[0] - Vector::<2>::new(radius, radius)).norm() < 1e-15);
            // Every core corner is the radius away from both lines.
            assert!((rounded.core()[1].y - radius).abs() < 1e-15);
            assert!((rounded.core()[2].x - radius).abs() < 1e-15);
        }
        assert_eq!(Rounded::inside(&triangle, 2.0), Err(ShapeError::Rounding { radius: 2.0, most: 1.0 }));
        let line = vec![Vector::<2>::zeros(), Vector::<2>::x()];
        assert!(Rounded::new(line.clone(), 0.1).is_ok() && Rounded::new(line, 0.0).is_err());
        assert!(Rounded::new(vec![Vector::<2>::zeros(); 2], 0.1).is_err());
        assert!(Rounded::new(vec![Vector::<2>::zeros()], 0.1).is_err());
    }

    #[test]
    fn a_disc_has_a_radius() {
        assert!(Disc::new(Vector::<2>::zeros(), 0.1).is_ok());
        for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(Disc::new(Vector::<2>::zeros(), radius).is_err());
        }
    }
}
