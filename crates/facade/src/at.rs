//! How a block starts.

use nalgebra::{Vector2, Vector3};
use teeter_rigid::{Pose, Rectangle};

/// Where a block starts, and how fast: at rest and upright unless said otherwise.
///
/// ```
/// use teeter_sim::prelude::*;
///
/// let shape = Rectangle::new(0.03, 0.135)?;
/// assert_eq!(At::standing(0.18, 0.0).coordinates(&shape), Vector3::new(0.18, 0.0675, 0.0));
/// # Ok::<(), teeter_sim::rigid::RigidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct At {
    place: Vector2<f64>,
    stands: bool,
    tilt: f64,
    velocity: Vector3<f64>,
}

impl At {
    /// With the mass centre at (x, y), m.
    #[must_use]
    pub fn centre(x: f64, y: f64) -> Self {
        Self { place: Vector2::new(x, y), stands: false, tilt: 0.0, velocity: Vector3::zeros() }
    }

    /// With the middle of the base at (x, y), m, before any tilt.
    #[must_use]
    pub fn standing(x: f64, y: f64) -> Self {
        Self { stands: true, ..Self::centre(x, y) }
    }

    /// The same, turned by `angle` (rad, counter-clockwise positive): a block that stands about the corner that it tilts onto, which stays where
    /// it is; others about the mass centre.
    #[must_use]
    pub fn tilted(mut self, angle: f64) -> Self {
        self.tilt = angle;
        self
    }

    /// The same with velocities of the mass centre, x and y (m/s), and a rate of turning (rad/s, counter-clockwise positive).
    #[must_use]
    pub fn moving(mut self, velocity: Vector3<f64>) -> Self {
        self.velocity = velocity;
        self
    }

    /// The coordinates (X, Y, φ) of a block of this shape: mass centre in m, angle in rad.
    #[must_use]
    pub fn coordinates(&self, shape: &Rectangle) -> Vector3<f64> {
        let mut centre = self.place;
        if self.stands {
            let [left, right, ..] = shape.corners();
            let corner = if self.tilt < 0.0 { right } else { left };
            let foot = Vector2::new(self.place.x + corner.x, self.place.y);
            centre = foot - Pose::new(&Vector3::new(0.0, 0.0, self.tilt)).rotate(&corner);
        }
        Vector3::new(centre.x, centre.y, self.tilt)
    }

    /// The velocities (Ẋ, Ẏ, φ̇), m/s and rad/s.
    #[must_use]
    pub fn velocity(&self) -> Vector3<f64> {
        self.velocity
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tilted_block_stands_on_the_corner_that_it_tilts_onto() {
        let shape = Rectangle::new(0.03, 0.135).unwrap();
        for (angle, corner) in [(0.1, 0), (-0.1, 1)] {
            let pose = Pose::new(&At::standing(0.18, 0.02).tilted(angle).coordinates(&shape));
            let corners = shape.corners().map(|c| pose.point(&c));
            let expected = Vector2::new(0.18 + shape.corners()[corner].x, 0.02);
            assert!((corners[corner] - expected).norm() < 1e-15);
            assert!(corners.iter().all(|c| c.y >= corners[corner].y));
        }
    }

    #[test]
    fn a_block_put_by_its_centre_turns_about_it() {
        let shape = Rectangle::new(0.03, 0.135).unwrap();
        assert_eq!(At::centre(1.0, 2.0).tilted(0.3).coordinates(&shape), Vector3::new(1.0, 2.0, 0.3));
    }
}
