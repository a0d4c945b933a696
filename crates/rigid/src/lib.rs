//! Plane rigid bodies: mass properties, pose, velocity, and the motion and Jacobian of a point
//! fixed in the body.
//!
//! Configuration `q = (X, Y, φ)`: mass centre in the world (m) and angle (rad, counter-clockwise);
//! velocity `v = (Ẋ, Ẏ, φ̇)`. The mass matrix `diag(m, m, I)` is constant (`docs/theory.md` §2).
//!
//! ```
//! use nalgebra::{Vector2, Vector3};
//! use teeter_rigid::{MassProperties, Pose, Rectangle};
//!
//! let block = Rectangle::new(0.03, 0.135)?;
//! let mass = MassProperties::rectangle(&block, 0.03, 2700.0)?;
//! assert!((mass.mass - 0.32805).abs() < 1e-15);
//!
//! // Upright at the origin, turning at 1 rad/s: the bottom left corner moves to the right and down.
//! let pose = Pose::new(&Vector3::zeros());
//! let v = pose.point_velocity(&block.corners()[0], &Vector3::new(0.0, 0.0, 1.0));
//! assert_eq!(v, Vector2::new(0.0675, -0.015));
//! # Ok::<(), teeter_rigid::RigidError>(())
//! ```

mod mass;

pub use mass::MassProperties;

use nalgebra::{SMatrix, Vector2, Vector3};

/// What is wrong with the data of a body.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RigidError {
    /// A quantity that must be positive and finite isn't.
    #[error("{what} is {value}, but must be positive and finite")]
    NotPositive {
        /// Which quantity.
        what: &'static str,
        /// Its value, SI.
        value: f64,
    },
}

pub(crate) fn positive(what: &'static str, value: f64) -> Result<f64, RigidError> {
    // Written so that NaN fails too.
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err(RigidError::NotPositive { what, value }) }
}

/// A rectangle by its sides, its centre at the origin of the body frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    width: f64,
    height: f64,
}

impl Rectangle {
    /// Names of the corners of the upright body, in the order of [`Rectangle::corners`].
    pub const CORNER_NAMES: [&'static str; 4] = ["bottom-left", "bottom-right", "top-right", "top-left"];

    /// A rectangle of width b and height H, m.
    ///
    /// # Errors
    /// If a side is not positive and finite.
    pub fn new(width: f64, height: f64) -> Result<Self, RigidError> {
        Ok(Self { width: positive("the width", width)?, height: positive("the height", height)? })
    }

    /// Width b, m.
    #[must_use]
    pub fn width(&self) -> f64 {
        self.width
    }

    /// Height H, m.
    #[must_use]
    pub fn height(&self) -> f64 {
        self.height
    }

    /// The corners in the body frame, counter-clockwise from the bottom left.
    #[must_use]
    pub fn corners(&self) -> [Vector2<f64>; 4] {
        let (x, y) = (0.5 * self.width, 0.5 * self.height);
        [Vector2::new(-x, -y), Vector2::new(x, -y), Vector2::new(x, y), Vector2::new(-x, y)]
    }

    /// Half the diagonal, R = ½√(b² + H²), m.
    #[must_use]
    pub fn radius(&self) -> f64 {
        0.5 * self.width.hypot(self.height)
    }

    /// The critical angle α = atan(b/H), rad: beyond it the rectangle overturns.
    #[must_use]
    pub fn critical_angle(&self) -> f64 {
        self.width.atan2(self.height)
    }
}

/// The pose of a body: its mass centre and its rotation, with sine and cosine computed once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    centre: Vector2<f64>,
    sin: f64,
    cos: f64,
}

impl Pose {
    /// The pose of a configuration (X, Y, φ).
    #[inline]
    #[must_use]
    pub fn new(q: &Vector3<f64>) -> Self {
        let (sin, cos) = q.z.sin_cos();
        Self { centre: Vector2::new(q.x, q.y), sin, cos }
    }

    /// A vector of the body frame in the world frame: R(φ)ρ.
    #[inline]
    #[must_use]
    pub fn rotate(&self, rho: &Vector2<f64>) -> Vector2<f64> {
        Vector2::new(self.cos * rho.x - self.sin * rho.y, self.sin * rho.x + self.cos * rho.y)
    }

    /// The place of a body point: x = X + R(φ)ρ.
    #[inline]
    #[must_use]
    pub fn point(&self, rho: &Vector2<f64>) -> Vector2<f64> {
        self.centre + self.rotate(rho)
    }

    /// The velocity of a body point: ẋ = Ẋ + φ̇ k × R(φ)ρ.
    #[inline]
    #[must_use]
    pub fn point_velocity(&self, rho: &Vector2<f64>, v: &Vector3<f64>) -> Vector2<f64> {
        let r = self.rotate(rho);
        Vector2::new(v.x - v.z * r.y, v.y + v.z * r.x)
    }

    /// The Jacobian of a body point, 2 × 3: ẋ = J v.
    #[inline]
    #[must_use]
    pub fn jacobian(&self, rho: &Vector2<f64>) -> SMatrix<f64, 2, 3> {
        let r = self.rotate(rho);
        SMatrix::<f64, 2, 3>::new(1.0, 0.0, -r.y, 0.0, 1.0, r.x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tilting_to_the_left_stands_the_block_on_its_bottom_left_corner() {
        let block = Rectangle::new(0.03, 0.135).unwrap();
        let pose = Pose::new(&Vector3::new(0.0, 0.0, 0.1));
        let lowest = block.corners().map(|c| pose.point(&c).y);
        assert!(lowest[0] < lowest[1] && lowest[0] < lowest[2] && lowest[0] < lowest[3]);
    }

    #[test]
    fn the_jacobian_is_the_derivative_of_the_place_of_a_point() {
        let (q, rho) = (Vector3::new(0.2, -0.1, 0.7), Vector2::new(0.3, -0.4));
        let pose = Pose::new(&q);
        let h = 1e-6;
        for k in 0..3 {
            let mut dq = Vector3::zeros();
            dq[k] = h;
            let difference = (Pose::new(&(q + dq)).point(&rho) - Pose::new(&(q - dq)).point(&rho)) / (2.0 * h);
            assert!((difference - pose.jacobian(&rho).column(k)).norm() < 1e-9);
            dq[k] = 1.0;
            assert!((pose.point_velocity(&rho, &dq) - pose.jacobian(&rho).column(k)).norm() < 1e-15);
        }
    }

    #[test]
    fn bad_data_is_refused_by_name_and_value() {
        assert_eq!(
            Rectangle::new(-0.03, 0.1).unwrap_err().to_string(),
            "the width is -0.03, but must be positive and finite"
        );
        assert!(Rectangle::new(0.03, f64::NAN).is_err());
        let block = Rectangle::new(0.03, 0.135).unwrap();
        assert!(MassProperties::rectangle(&block, 0.0, 2700.0).is_err());
        assert!(MassProperties::rectangle(&block, 1e-320, 1e-10).is_err(), "underflow");
    }
}
