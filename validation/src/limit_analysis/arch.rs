//! Circular arches of equal voussoirs with radial joints.

use super::{Assemblage, Block, LimitError, Point, stands};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Of t/R, to which [`minimum_thickness`] brackets the limit.
pub const BRACKET: f64 = 1e-7;

/// The thicknesses at which [`minimum_thickness`] looks for the first that stands: from this t/R, each times the ratio, below 2,
/// where the intrados is a point.
const THINNEST: f64 = 1e-3;
const RATIO: f64 = 1.15;

/// Where the weight of a voussoir acts, and of what shape it is that of. The joints are the same for all: from intrados to
/// extrados along a radius.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VoussoirWeight {
    /// The quadrilateral of the four corners, at its centroid: what a program of convex polygons has.
    Polygon,
    /// The sector of the ring, at its centroid: Milankovitch's.
    Sector,
    /// The sector of the ring, at its middle on the centre line: Heyman's.
    CentreLine,
}

/// The corners of `n` equal voussoirs of an arch that opens by `angle` (rad) symmetrically about the y axis, centre at the
/// origin, from right to left, counter-clockwise each: extrados at the right joint first. The corners lie on the circles of
/// radius `radius` ± `thickness`/2; edges between them are chords.
///
/// # Errors
///
/// [`LimitError::Arch`] without a voussoir, with an angle not in (0, 2π), voussoirs of half a turn, or an intrados of no radius.
pub fn voussoirs(n: usize, angle: f64, radius: f64, thickness: f64) -> Result<Vec<Vec<Point>>, LimitError> {
    let right = -0.5 * angle;
    let step = angle / n as f64;
    let possible = n > 0 && angle > 0.0 && angle < TAU && step < 2.0 * FRAC_PI_2;
    if !(possible && radius.is_finite() && thickness > 0.0 && thickness < 2.0 * radius) {
        return Err(LimitError::Arch);
    }
    Ok((0..n).map(|i| voussoir(right + step * i as f64, step, radius, thickness)).collect())
}

/// The voussoir whose right joint is `from` away from the crown, to the left; it opens by `step`.
fn voussoir(from: f64, step: f64, radius: f64, thickness: f64) -> Vec<Point> {
    let at = |r: f64, beta: f64| Point::new(-r * beta.sin(), r * beta.cos());
    let [inner, outer] = [radius - 0.5 * thickness, radius + 0.5 * thickness];
    vec![at(outer, from), at(outer, from + step), at(inner, from + step), at(inner, from)]
}

/// The arch of [`voussoirs`] between two springers that don't move.
///
/// # Errors
///
/// As [`voussoirs`].
pub fn arch(
    n: usize,
    angle: f64,
    radius: f64,
    thickness: f64,
    weight: VoussoirWeight,
) -> Result<Assemblage, LimitError> {
    let step = angle / n as f64;
    let [inner, outer] = [radius - 0.5 * thickness, radius + 0.5 * thickness];
    let of_sector = 0.5 * step * (outer * outer - inner * inner);
    let sector_radius =
        (outer.powi(3) - inner.powi(3)) / (outer * outer - inner * inner) * (2.0 / 3.0) * (0.5 * step).sin()
            / (0.5 * step);
    let block = |(i, polygon): (usize, Vec<Point>)| {
        let beta = -0.5 * angle + step * (i as f64 + 0.5);
        let out = Point::new(-beta.sin(), beta.cos());
        match weight {
            VoussoirWeight::Polygon => Block::uniform(polygon, 1.0),
            VoussoirWeight::Sector => Block::with_weight(polygon, of_sector, out * sector_radius),
            VoussoirWeight::CentreLine => Block::with_weight(polygon, of_sector, out * radius),
        }
    };
    let polygons = voussoirs(n, angle, radius, thickness)?;
    let blocks = polygons.into_iter().enumerate().map(block).collect::<Result<_, _>>()?;
    let springer = 0.1_f64.min(0.25 * (TAU - angle));
    let springers = [-0.5 * angle - springer, 0.5 * angle].map(|from| voussoir(from, springer, radius, thickness));
    Assemblage::new(blocks, &springers)
}

/// The smallest t/R at which the arch of `n` polygons stands under self-weight, R to the centre line, to [`BRACKET`]; `None` if
/// it does at no thickness below 2 R, as where it slides off its springers whatever its thickness. Thicknesses are tried
/// upwards by a factor of 1.15 until one stands: a narrower range of standing below a range of sliding would be missed.
///
/// # Errors
///
/// As [`arch`] and [`stands`].
pub fn minimum_thickness(n: usize, angle: f64, friction: f64) -> Result<Option<f64>, LimitError> {
    minimum_thickness_with(n, angle, friction, VoussoirWeight::Polygon)
}

/// [`minimum_thickness`] for any convention of weight.
///
/// # Errors
///
/// As [`minimum_thickness`].
pub fn minimum_thickness_with(
    n: usize,
    angle: f64,
    friction: f64,
    weight: VoussoirWeight,
) -> Result<Option<f64>, LimitError> {
    let standing = |thickness: f64| stands(&arch(n, angle, 1.0, thickness, weight)?, friction);
    let (mut low, mut high) = (0.0, THINNEST);
    while !standing(high)? {
        (low, high) = (high, high * RATIO);
        if high >= 2.0 {
            return Ok(None);
        }
    }
    while high - low > BRACKET {
        let middle = 0.5 * (low + high);
        if standing(middle)? { high = middle } else { low = middle }
    }
    Ok(Some(0.5 * (low + high)))
}
