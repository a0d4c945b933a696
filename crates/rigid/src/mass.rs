//! Mass and moment of inertia of plane bodies.

use crate::{Rectangle, RigidError, positive};
use nalgebra::{Vector2, Vector3};
use std::f64::consts::PI;

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
        let (b, height) = (shape.width(), shape.height());
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

    /// Mass and moment of inertia of all that is at most `radius` (m) from a convex polygon, about its
    /// mass centre, and where that is, m: a polygon with rounded corners. The polygon may be two points,
    /// or one: then it is a disc. Corners are counter-clockwise, m, the depth is in m, the density in
    /// kg/m³.
    ///
    /// ```
    /// use nalgebra::Vector2;
    /// use teeter_rigid::MassProperties;
    ///
    /// let (disc, centre) = MassProperties::rounded(&[Vector2::new(0.2, 0.1)], 0.05, 0.02, 2000.0)?;
    /// let mass = 2000.0 * 0.02 * std::f64::consts::PI * 0.05 * 0.05;
    /// assert!((disc.mass - mass).abs() < 1e-14 && (disc.inertia - 0.5 * mass * 0.05 * 0.05).abs() < 1e-16);
    /// assert_eq!(centre, Vector2::new(0.2, 0.1));
    /// # Ok::<(), teeter_rigid::RigidError>(())
    /// ```
    ///
    /// # Errors
    /// If there is no corner, or radius, depth or density (or the area of three corners or more, or a
    /// result that over- or underflows) is not positive and finite.
    pub fn rounded(
        corners: &[Vector2<f64>],
        radius: f64,
        depth: f64,
        density: f64,
    ) -> Result<(Self, Vector2<f64>), RigidError> {
        let radius = positive("the radius", radius)?;
        let per_area = positive("the density", density)? * positive("the depth", depth)?;
        let disc = per_area * PI * radius * radius;
        if let [centre] = corners {
            return Ok((Self::new(disc, 0.5 * disc * radius * radius)?, *centre));
        }
        let mut pieces = Vec::with_capacity(2 * corners.len() + 1);
        if corners.len() > 2 {
            pieces.push(Self::polygon(corners, depth, density)?);
        }
        let side = |k: usize| corners[(k + 1) % corners.len()] - corners[k];
        for k in 0..corners.len() {
            // A strip along each side, and a sector at each corner, which opens by the turn there.
            let (along, before) = (side(k), side((k + corners.len() - 1) % corners.len()));
            let length = positive("the length of a side", along.norm())?;
            let outward = Vector2::new(along.y, -along.x) / length;
            let strip = per_area * length * radius;
            let middle = corners[k] + 0.5 * along + 0.5 * radius * outward;
            pieces.push((Self::new(strip, strip * (length * length + radius * radius) / 12.0)?, middle));
            let turn = before.perp(&along).atan2(before.dot(&along)).abs();
            let sector = 0.5 * per_area * turn * radius * radius;
            // About the corner m r²/2; the mass centre is 4 r sin(θ/2)/(3θ) from there, along the bisector.
            let out = 4.0 * radius * (0.5 * turn).sin() / (3.0 * turn);
            let bisector = (Vector2::new(before.y, -before.x) / before.norm() + outward).try_normalize(0.0);
            // Of two points the turn is half a circle, and the bisector leads on.
            let bisector = bisector.unwrap_or(before / before.norm());
            let inertia = sector * (0.5 * radius * radius - out * out);
            pieces.push((Self::new(sector, inertia)?, corners[k] + out * bisector));
        }
        Self::together(&pieces)
    }

    /// Mass and moment of inertia of several bodies that are one, about their common mass centre, and
    /// where that is, m. Each is given with the place of its own mass centre; mass that lies in several
    /// of them counts as often.
    ///
    /// ```
    /// use nalgebra::Vector2;
    /// use teeter_rigid::MassProperties;
    ///
    /// let ball = MassProperties::new(2.0, 0.01)?;
    /// let (dumbbell, centre) = MassProperties::together(&[(ball, Vector2::new(0.0, 0.0)), (ball, Vector2::new(1.0, 0.0))])?;
    /// assert_eq!((dumbbell.mass, centre), (4.0, Vector2::new(0.5, 0.0)));
    /// assert!((dumbbell.inertia - (0.02 + 4.0 * 0.25)).abs() < 1e-15);
    /// # Ok::<(), teeter_rigid::RigidError>(())
    /// ```
    ///
    /// # Errors
    /// If there is none, or a result is not positive and finite.
    pub fn together(bodies: &[(Self, Vector2<f64>)]) -> Result<(Self, Vector2<f64>), RigidError> {
        let mass = positive("the mass", bodies.iter().map(|(body, _)| body.mass).sum())?;
        let first = bodies.first().map(|(_, centre)| *centre).unwrap_or_default();
        let moment: Vector2<f64> = bodies.iter().map(|(body, centre)| (centre - first) * body.mass).sum();
        let centre = first + moment / mass;
        let inertia = bodies.iter().map(|(body, at)| body.inertia + body.mass * (at - centre).norm_squared()).sum();
        Ok((Self::new(mass, inertia)?, centre))
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
    fn rounded_corners_are_those_of_a_fine_polygon() {
        let at = |x: f64, y: f64| Vector2::new(x, y);
        for corners in [
            vec![at(0.0, 0.0), at(3.0, 0.2), at(2.0, 1.5)],
            vec![at(1.0, 1.0), at(2.0, 1.0), at(2.0, 2.0), at(1.0, 2.0)],
            vec![at(0.0, 0.0), at(1.0, 0.5)],
            vec![at(-1.0, 2.0)],
        ] {
            let radius = 0.3;
            // The convex hull of fine discs about the corners, by their points in the order of their directions.
            let n = 20_000;
            let outline: Vec<Vector2<f64>> = (0..n)
                .map(|k| {
                    let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / f64::from(n)).sin_cos();
                    let out = Vector2::new(cos, sin);
                    let furthest = corners.iter().max_by(|a, b| a.dot(&out).total_cmp(&b.dot(&out))).unwrap();
                    furthest + radius * out
                })
                .collect();
            let (wanted, centre) = MassProperties::polygon(&outline, 2.0, 5.0).unwrap();
            let (found, place) = MassProperties::rounded(&corners, radius, 2.0, 5.0).unwrap();
            assert!((found.mass / wanted.mass - 1.0).abs() < 1e-7, "{corners:?}: {found:?}, not {wanted:?}");
            assert!((found.inertia / wanted.inertia - 1.0).abs() < 1e-7, "{corners:?}: {found:?}, not {wanted:?}");
            assert!((place - centre).norm() < 1e-7, "{corners:?}: {place}, not {centre}");
        }
        assert!(MassProperties::rounded(&[at(0.0, 0.0)], 0.0, 1.0, 1.0).is_err());
        assert!(MassProperties::rounded(&[], 1.0, 1.0, 1.0).is_err());
        assert!(MassProperties::together(&[]).is_err());
    }
}
