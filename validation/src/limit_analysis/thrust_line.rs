//! The minimum thickness of an arch by its thrust line: no linear programme, and friction that never slips.

use super::{Block, LimitError, Point, voussoirs};
use nalgebra::Matrix2;

/// t/R is bracketed to this.
const BRACKET: f64 = 1e-12;

/// A moment this small, relative to the arch's weight times R, is none: that of the joints through which the line is laid.
const MOMENT: f64 = 1e-13;

/// The smallest t/R below 1 at which a thrust line runs through all joints of the arch of
/// [`minimum_thickness`](super::minimum_thickness), if nothing slides; `None` if that takes more.
///
/// An arch that stands does so symmetrically too, as equilibria can be averaged. Half of it is then held by the horizontal
/// thrust H at height y of the crown: the moment of all that acts above a joint about a point p of it is
/// M(p) = −H y + H p_y − Σ w x + p_x Σ w, which must be ≤ 0 about the intrados and ≥ 0 about the extrados. These are half planes
/// of (H y, H); they have a point in common only if a corner of two of them is one, so all pairs are tried.
///
/// # Errors
///
/// As [`voussoirs`].
pub fn thrust_line_thickness(n: usize, angle: f64) -> Result<Option<f64>, LimitError> {
    let (mut low, mut high) = (1e-6, 1.0);
    if !holds_thrust_line(n, angle, high)? {
        return Ok(None);
    }
    while high - low > BRACKET {
        let middle = 0.5 * (low + high);
        if holds_thrust_line(n, angle, middle)? { high = middle } else { low = middle }
    }
    Ok(Some(0.5 * (low + high)))
}

/// The half plane `normal` · (H y, H) ≤ `bound`.
struct HalfPlane {
    normal: Point,
    bound: f64,
}

fn holds_thrust_line(n: usize, angle: f64, thickness: f64) -> Result<bool, LimitError> {
    let planes = half_planes(n, angle, thickness)?;
    let inside = |at: &Point| at.y > 0.0 && planes.iter().all(|plane| plane.normal.dot(at) <= plane.bound + MOMENT);
    let corner = |a: &HalfPlane, b: &HalfPlane| {
        let rows = Matrix2::new(a.normal.x, a.normal.y, b.normal.x, b.normal.y);
        rows.try_inverse().map(|inverse| inverse * Point::new(a.bound, b.bound))
    };
    let mut pairs = planes.iter().enumerate().flat_map(|(i, a)| planes[..i].iter().map(move |b| (a, b)));
    Ok(pairs.any(|(a, b)| corner(a, b).is_some_and(|at| inside(&at))))
}

/// Two of each joint of the right half, per weight of the arch, R = 1.
fn half_planes(n: usize, angle: f64, thickness: f64) -> Result<Vec<HalfPlane>, LimitError> {
    let blocks = voussoirs(n, angle, 1.0, thickness)?
        .into_iter()
        .map(|polygon| Block::uniform(polygon, 1.0))
        .collect::<Result<Vec<_>, _>>()?;
    let total = blocks.iter().map(|block| block.weight).sum::<f64>();
    let mut planes = Vec::new();
    // Of an odd number half the keystone. Where it acts is no matter: its moment about the y axis adds a constant to H y.
    let middle = &blocks[n / 2];
    let mut weight = if n.is_multiple_of(2) { 0.0 } else { 0.5 * middle.weight / total };
    let mut moment = 0.0;
    joint(middle, weight, moment, &mut planes);
    for block in blocks[..n / 2].iter().rev() {
        weight += block.weight / total;
        moment += block.weight / total * block.centroid.x;
        joint(block, weight, moment, &mut planes);
    }
    Ok(planes)
}

/// What the right joint of a block asks for, with Σ w and Σ w x of all above it.
fn joint(block: &Block, weight: f64, moment: f64, planes: &mut Vec<HalfPlane>) {
    let [extrados, intrados] = [block.polygon[0], block.polygon[3]];
    let acting = |p: Point| p.x * weight - moment;
    planes.push(HalfPlane { normal: Point::new(-1.0, intrados.y), bound: -acting(intrados) });
    planes.push(HalfPlane { normal: Point::new(1.0, -extrados.y), bound: acting(extrados) });
}
