//! The motion of a block from the coordinates of markers on it.

/// How well the markers move as a rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MarkerResidual {
    /// Number of markers.
    pub markers: usize,
    /// Root mean square distance of a marker from its place on the fitted body, m.
    pub rms: f64,
    /// The largest such distance, m.
    pub max: f64,
    /// Its time, as in the table, s.
    pub t: f64,
    /// Root mean square distance of the markers on the body from their middle, m.
    pub size: f64,
    /// As `rms`, for the mirror image of what was seen.
    pub mirrored: f64,
    /// Whether the places of the markers were given, so that the position of the mass centre is
    /// known.
    pub placed: bool,
}

/// A rigid displacement in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose {
    /// Where the origin of the body is.
    pub(super) origin: [f64; 2],
    /// Its angle.
    pub(super) phi: f64,
}

/// The pose that brings points of the body closest to where they are seen, by least squares: their
/// centroids coincide, and tan φ = Σ a × b / Σ a · b over the arms a on the body and b as seen.
pub(super) fn rigid_fit(body: &[[f64; 2]], seen: &[[f64; 2]]) -> Pose {
    let (from, to) = (middle(body), middle(seen));
    let (mut dot, mut cross) = (0.0, 0.0);
    for (a, b) in body.iter().zip(seen) {
        let (a, b) = ([a[0] - from[0], a[1] - from[1]], [b[0] - to[0], b[1] - to[1]]);
        dot += a[0] * b[0] + a[1] * b[1];
        cross += a[0] * b[1] - a[1] * b[0];
    }
    let phi = cross.atan2(dot);
    let (sin, cos) = phi.sin_cos();
    let origin = [to[0] - cos * from[0] + sin * from[1], to[1] - sin * from[0] - cos * from[1]];
    Pose { origin, phi }
}

fn middle(points: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|k| points.iter().map(|point| point[k]).sum::<f64>() / points.len() as f64)
}

/// Root mean square distance of points, one or more, from their middle.
pub(super) fn size_of(points: &[[f64; 2]]) -> f64 {
    let [x, y] = middle(points);
    (points.iter().map(|point| (point[0] - x).powi(2) + (point[1] - y).powi(2)).sum::<f64>() / points.len() as f64)
        .sqrt()
}

impl Pose {
    /// Where a point of the body is.
    pub(super) fn of(&self, point: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.phi.sin_cos();
        [self.origin[0] + cos * point[0] - sin * point[1], self.origin[1] + sin * point[0] + cos * point[1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rigid_displacement_is_found_exactly() {
        let body = [[0.01, 0.02], [-0.01, 0.03], [0.0, -0.05]];
        let pose = Pose { origin: [0.3, -0.1], phi: -0.4 };
        let found = rigid_fit(&body, &body.map(|point| pose.of(point)));
        assert!((found.phi - pose.phi).abs() < 1e-14);
        assert!((found.origin[0] - 0.3).abs() < 1e-15 && (found.origin[1] + 0.1).abs() < 1e-15);
    }
}
