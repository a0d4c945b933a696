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

fn positive(what: &'static str, value: f64) -> Result<f64, RigidError> {
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

/// Mass m (kg) and moment of inertia I about the mass centre (kg·m²).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// Mass, kg.
    pub mass: f64,
    /// Moment of inertia about the mass centre, kg·m².
    pub inertia: f64,
}

impl MassProperties {
    /// The given mass (kg) and moment of inertia (kg·m²).
    ///
    /// # Errors
    /// If one is not positive and finite.
    pub fn new(mass: f64, inertia: f64) -> Result<Self, RigidError> {
        Ok(Self { mass: positive("the mass", mass)?, inertia: positive("the moment of inertia", inertia)? })
    }

    /// Mass and moment of inertia of a homogeneous cuboid: m = ρbHd, I = m(b² + H²)/12; depth d in
    /// m, density ρ in kg/m³.
    ///
    /// # Errors
    /// If depth or density (or a result that over- or underflows) is not positive and finite.
    pub fn rectangle(shape: &Rectangle, depth: f64, density: f64) -> Result<Self, RigidError> {
        let (b, height) = (shape.width, shape.height);
        let mass = positive("the density", density)? * b * height * positive("the depth", depth)?;
        Self::new(mass, mass * (b * b + height * height) / 12.0)
    }

    /// Mass and moment of inertia of a homogeneous convex polygon about its mass centre, and where that is, m; corners counter-clockwise
    /// (m), depth d in m, density ρ in kg/m³: m = ρdA, I = ρd Σ aₖ (|xₖ|² + xₖ·xₖ₊₁ + |xₖ₊₁|²)/12, aₖ = xₖ × xₖ₊₁, with places xₖ seen from the mass
    /// centre.
    ///
    /// # Errors
    /// If depth or density (or the area, or a result that over- or underflows) is not positive and finite.
    pub fn polygon(corners: &[Vector2<f64>], depth: f64, density: f64) -> Result<(Self, Vector2<f64>), RigidError> {
        let first = corners.first().copied().unwrap_or_default();
        let sum = |from: Vector2<f64>, of: &dyn Fn(&Vector2<f64>, &Vector2<f64>) -> f64| -> f64 {
            let next = corners.iter().cycle().skip(1);
            corners.iter().zip(next).map(|(a, b)| (a - from, b - from)).map(|(a, b)| a.perp(&b) * of(&a, &b)).sum()
        };
        let area = positive("the area", 0.5 * sum(first, &|_, _| 1.0))?;
        let centre = Vector2::new(sum(first, &|a, b| a.x + b.x), sum(first, &|a, b| a.y + b.y)) / (6.0 * area);
        let centre = first + centre;
        let turning = sum(centre, &|a, b| a.norm_squared() + a.dot(b) + b.norm_squared()) / 12.0;
        let thick = positive("the density", density)? * positive("the depth", depth)?;
        Ok((Self::new(thick * area, thick * turning)?, centre))
    }

    /// Kinetic energy ½m(Ẋ² + Ẏ²) + ½Iφ̇², J.
    #[inline]
    #[must_use]
    pub fn kinetic_energy(&self, v: &Vector3<f64>) -> f64 {
        0.5 * (self.mass * (v.x * v.x + v.y * v.y) + self.inertia * v.z * v.z)
    }

    /// The diagonal of the mass matrix.
    #[inline]
    #[must_use]
    pub fn diagonal(&self) -> Vector3<f64> {
        Vector3::new(self.mass, self.mass, self.inertia)
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
    fn the_papers_block_has_the_papers_mass_and_inertia() {
        let mass = MassProperties::rectangle(&Rectangle::new(0.03, 0.135).unwrap(), 0.03, 2700.0).unwrap();
        assert!((mass.mass - 0.32805).abs() < 1e-16);
        assert!((mass.inertia - 5.228296875e-4).abs() < 1e-18);
    }

    #[test]
    fn a_polygon_has_the_mass_of_its_triangles() {
        let at = |x: f64, y: f64| Vector2::new(x, y);
        // A rectangle, far from the origin: as one by its sides.
        let moved = [at(10.0, 20.0), at(10.03, 20.0), at(10.03, 20.135), at(10.0, 20.135)];
        let (mass, centre) = MassProperties::polygon(&moved, 0.03, 2700.0).unwrap();
        let sides = MassProperties::rectangle(&Rectangle::new(0.03, 0.135).unwrap(), 0.03, 2700.0).unwrap();
        assert!((mass.mass / sides.mass - 1.0).abs() < 1e-12 && (mass.inertia / sides.inertia - 1.0).abs() < 1e-11);
        assert!((centre - at(10.015, 20.0675)).norm() < 1e-13);
        // A triangle of base b and height h with a right angle: I = m(b² + h²)/18.
        let (mass, centre) = MassProperties::polygon(&[at(0.0, 0.0), at(3.0, 0.0), at(0.0, 1.5)], 2.0, 5.0).unwrap();
        assert!((mass.mass - 22.5).abs() < 1e-13 && (centre - at(1.0, 0.5)).norm() < 1e-15);
        assert!((mass.inertia - 22.5 * (9.0 + 2.25) / 18.0).abs() < 1e-13);
        assert!(MassProperties::polygon(&[at(0.0, 0.0), at(0.0, 1.0), at(1.0, 0.0)], 1.0, 1.0).is_err(), "clockwise");
    }

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
