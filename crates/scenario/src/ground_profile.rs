//! Ground with a profile: where blocks are placed on it, and its contacts.

use crate::overlap::{Outline, PlacedOutline};
use crate::placement::centre_above;
use crate::scene::{BlockScene, GroundScene, Placement, Scene, SupportingBody};
use crate::simulation::Layout;
use nalgebra::{Vector2, Vector3};
use teeter_detect::{Profile, ProfilePair};
use teeter_rigid::Pose;

/// A straight line through a point with a slope: x, y (m), rad.
type Line = [f64; 3];

/// Iterations for the slope of a base; each is of a few points.
const ITERATIONS: usize = 200;

/// Slopes that differ by less are the same, rad.
const SAME_SLOPE: f64 = 1e-15;

/// The profile of the ground of a scene, if it has one.
pub(crate) fn of(scene: &Scene) -> Option<&Profile> {
    scene.ground.as_ref()?.profile.as_deref()
}

/// How far down from a crest it is looked whether the ground there is inside a block, relative to
/// the block's larger side.
const BELOW_A_CREST: f64 = 1e-3;

/// What is less inside than this, relative to the block's larger side, is rounding.
const ROUNDING: f64 = 1e-8;

/// The first block, by its number, that starts with a crest of the ground inside it, and the
/// crest's point, from 1 on. Contacts don't tell: they are with the side that is nearest to a
/// crest, which faces away from one that is in deep; and in the seam of two parts the depth is zero.
/// So it is the ground just below the crest that is looked for.
pub(crate) fn crest_inside(scene: &Scene, layout: &Layout, q: &[f64]) -> Option<(usize, usize)> {
    let profile = of(scene)?;
    let slope = scene.ground.as_ref().map_or(0.0, |ground| ground.incline);
    let place = layout
        .ground
        .as_ref()
        .map_or(Vector3::new(0.0, 0.0, slope), |range| Vector3::from_column_slice(&q[range.clone()]));
    let points: Vec<Vector2<f64>> = profile.points().map(|point| Pose::new(&place).point(&point)).collect();
    let on_ground = scene.contacts.iter().filter(|contact| contact.surface == SupportingBody::Ground);
    on_ground.map(|contact| contact.block).find_map(|number| {
        let block = &scene.blocks[number];
        let at = &q[layout.blocks[number].range.clone()];
        let outline = PlacedOutline::new([at[0], at[1]], at[2], &Outline::of(block));
        let side = block.width.max(block.height);
        let is_inside = |three: &[Vector2<f64>]| {
            let down = [three[0] - three[1], three[2] - three[1]];
            let is_crest = down[1].perp(&down[0]) < 0.0;
            let near = BELOW_A_CREST * side;
            // Between the two pieces that lead down from it is ground.
            is_crest
                && [0.1, 0.5, 0.9].into_iter().any(|share| {
                    let step = |way: &Vector2<f64>| way * (near / way.norm()).min(1.0);
                    let below = three[1] + share * step(&down[0]) + (1.0 - share) * step(&down[1]);
                    outline.depth_of([below.x, below.y]) > ROUNDING * side
                })
        };
        points.windows(3).position(is_inside).map(|first| (number, first + 2))
    })
}

/// The line on which the base of a block of this width rests, with the midpoint of the base at x =
/// `at`: of all lines that are nowhere below the ground under the base, the one that is lowest at
/// its midpoint. It touches the ground on both sides of the midpoint, or below it; there the least
/// slope is taken. `None` if no such line is found: on ground too steep to lay a base on.
fn resting_line(profile: &Profile, at: f64, width: f64) -> Option<Line> {
    let mut slope = 0.0_f64;
    for _ in 0..ITERATIONS {
        let reach = 0.5 * width * slope.cos();
        let [height, next] = line_over(profile, at, [at - reach, at + reach]);
        if (next - slope).abs() <= SAME_SLOPE {
            return Some([at, height, next]);
        }
        slope = next;
    }
    // The ends of the base may hop between pieces of the ground by less than can be seen.
    let reach = 0.5 * width * slope.cos();
    let [height, next] = line_over(profile, at, [at - reach, at + reach]);
    ((next - slope).abs() <= 1e3 * SAME_SLOPE).then_some([at, height, next])
}

/// The pieces of the hull of the ground under a base between two places, x in m, from left to right: between which x each is (m), and its
/// slope (rad). None where the second place isn't to the right of the first.
#[must_use]
pub fn pieces_under(profile: &Profile, [left, right]: [f64; 2]) -> Vec<([f64; 2], f64)> {
    let hull = if left < right { hull_over(profile, [left, right]) } else { Vec::new() };
    hull.windows(2).map(|two| ([two[0].x, two[1].x], slope_between(two))).collect()
}

/// How far the ground at x is along its surface, to the right of the first point of the profile, m.
#[must_use]
pub fn along(profile: &Profile, x: f64) -> f64 {
    let mut points = profile.points();
    let Some(mut from) = points.next() else { return x };
    let mut passed = 0.0;
    if x > from.x {
        for to in points {
            let piece = to - from;
            if x < to.x {
                return passed + piece.norm() * (x - from.x) / piece.x;
            }
            passed += piece.norm();
            from = to;
        }
    }
    passed + x - from.x
}

fn slope_between(two: &[Vector2<f64>]) -> f64 {
    (two[1].y - two[0].y).atan2(two[1].x - two[0].x)
}

/// The upper side of the convex hull of the ground between two places, from left to right.
fn hull_over(profile: &Profile, [left, right]: [f64; 2]) -> Vec<Vector2<f64>> {
    let end = |x: f64| Vector2::new(x, profile.height(x));
    let within = profile.points().filter(|point| point.x > left && point.x < right);
    let mut hull: Vec<Vector2<f64>> = Vec::new();
    for point in std::iter::once(end(left)).chain(within).chain(std::iter::once(end(right))) {
        while let [.., a, b] = hull.as_slice()
            && (b - a).perp(&(point - a)) >= 0.0
        {
            hull.pop();
        }
        hull.push(point);
    }
    hull
}

/// Height (m) at `at` and slope (rad) of the line over the ground between two places.
fn line_over(profile: &Profile, at: f64, ends: [f64; 2]) -> [f64; 2] {
    let hull = hull_over(profile, ends);
    let over = |two: &&[Vector2<f64>]| two[0].x <= at && at <= two[1].x;
    // Two edges meet at `at` where the ground has a crest there.
    let edges: Vec<&[Vector2<f64>]> = hull.windows(2).filter(over).collect();
    match edges.as_slice() {
        [first, .., last] => {
            let (steepest, least) = (slope_between(first), slope_between(last));
            [first[1].y, 0.0_f64.clamp(least.min(steepest), steepest.max(least))]
        }
        [edge] => {
            let slope = slope_between(edge);
            [edge[0].y + (at - edge[0].x) * slope.tan(), slope]
        }
        [] => [profile.height(at), 0.0],
    }
}

/// The initial configuration (X, Y, φ) of a block that stands on ground with this profile, which
/// is displaced by `ground`: x and y (m), and its turn (rad). Tilted, it turns about an end of its
/// base, and its lowest point is on the ground. `None` if no place is found.
pub(crate) fn pose(profile: &Profile, block: &BlockScene, ground: Line) -> Option<Vector3<f64>> {
    let Placement::On { at, tilt, .. } = block.placement else { return None };
    let moved = Pose::new(&Vector3::from(ground));
    // The midpoint of the base is at x = `at` in the world.
    let mut local = at - ground[0];
    let base_width = block.base();
    let mut line = resting_line(profile, local, base_width)?;
    for _ in 0..ITERATIONS {
        let off = at - moved.point(&Vector2::new(line[0], line[1])).x;
        if off.abs() <= f64::EPSILON * (at.abs() + block.width) {
            break;
        }
        local += off / ground[2].cos();
        line = resting_line(profile, local, base_width)?;
    }
    let [x, y, slope] = line;
    let angle = slope + tilt;
    let base = Pose::new(&Vector3::new(x, y, slope));
    let centre = if tilt == 0.0 && block.parts.is_none() {
        base.point(&Vector2::new(0.0, 0.5 * block.height))
    } else {
        let above = base.point(&centre_above(block, tilt));
        above + Vector2::new(0.0, lift(profile, block, [above.x, above.y, angle]))
    };
    let centre = moved.point(&centre);
    Some(Vector3::new(centre.x, centre.y, ground[2] + angle))
}

/// The slope of the ground under the base of a block that stands on fixed ground with a profile,
/// rad.
pub(crate) fn slope_under(ground: &GroundScene, block: &BlockScene) -> Option<f64> {
    let profile = ground.profile.as_deref()?;
    let Placement::On { support: SupportingBody::Ground, at, .. } = block.placement else { return None };
    Some(resting_line(profile, at, block.base())?[2])
}

/// How far a block of any shape at x, y (m), turned (rad), has to be lifted along y until it touches
/// the ground and is nowhere below it, m; negative where it has to come down.
fn lift(profile: &Profile, block: &BlockScene, at: Line) -> f64 {
    let placed = Pose::new(&Vector3::from(at));
    let mut most = f64::NEG_INFINITY;
    let points: Vec<Vector2<f64>> = profile.points().collect();
    let cores: Vec<(Vec<Vector2<f64>>, f64)> = match &block.parts {
        None => vec![(block.corners(), 0.0)],
        Some(parts) => parts.iter().map(|part| (part.shape.core().to_vec(), part.shape.radius())).collect(),
    };
    for (core, radius) in cores {
        let core: Vec<Vector2<f64>> = core.iter().map(|corner| placed.point(corner)).collect();
        let count = core.len();
        // A disc or a corner over every piece of the ground, and over the level ground beyond.
        for centre in &core {
            for [from, to] in pieces(&points, centre.x - radius, centre.x + radius) {
                most = most.max(clearance(from, to, centre, radius) - centre.y);
            }
        }
        // The lower sides over every point of the ground.
        if count > 1 {
            for k in 0..count {
                let (from, to) = (core[k], core[(k + 1) % count]);
                let side = (to - from).normalize();
                let out = Vector2::new(side.y, -side.x) * radius;
                let (from, to) = (from + out, to + out);
                if from.x >= to.x {
                    continue;
                }
                for point in points.iter().filter(|point| point.x > from.x && point.x < to.x) {
                    let height = from.y + (to.y - from.y) * (point.x - from.x) / (to.x - from.x);
                    most = most.max(point.y - height);
                }
            }
        }
    }
    most
}

/// The pieces of the ground that reach into a range of x, with the level ground beyond its ends.
fn pieces(points: &[Vector2<f64>], low: f64, high: f64) -> Vec<[Vector2<f64>; 2]> {
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return Vec::new() };
    let ends = [
        [Vector2::new(low.min(first.x) - 1.0, first.y), *first],
        [*last, Vector2::new(high.max(last.x) + 1.0, last.y)],
    ];
    let inner = points.windows(2).map(|two| [two[0], two[1]]);
    ends.into_iter().chain(inner).filter(|[from, to]| from.x <= high && to.x >= low).collect()
}

/// The height of the centre of a disc that rests on a piece of ground, at the disc's x; −∞ where
/// it passes beside the piece.
fn clearance(from: Vector2<f64>, to: Vector2<f64>, centre: &Vector2<f64>, radius: f64) -> f64 {
    let along = (to - from).normalize();
    // Where the disc would touch the line of the piece: its lowest point across the line.
    let touch = centre.x + radius * along.y;
    if (from.x..=to.x).contains(&touch) {
        let slope = along.y / along.x;
        return from.y + (touch - from.x) * slope + radius * along.x;
    }
    let over = |end: Vector2<f64>| {
        let off = centre.x - end.x;
        if off.abs() <= radius { end.y + (radius * radius - off * off).sqrt() } else { f64::NEG_INFINITY }
    };
    over(from).max(over(to))
}

/// How deep the corners of a block, with their radii (m), are below the ground, along y, m; the
/// ground and the block are at x, y (m) and turned (rad).
pub(crate) fn depth(profile: &Profile, ground: Line, corners: &[(Vector2<f64>, f64)], block: Line) -> f64 {
    let [moved, placed] = [ground, block].map(|line| Pose::new(&Vector3::from(line)));
    let below = |(corner, radius): &(Vector2<f64>, f64)| {
        let from = placed.point(corner) - moved.point(&Vector2::zeros());
        let local = Pose::new(&Vector3::new(0.0, 0.0, -ground[2])).rotate(&from);
        profile.height(local.x) - (local.y - radius)
    };
    corners.iter().map(below).fold(0.0, f64::max)
}

/// Height of its highest point, m.
pub(crate) fn top(profile: &Profile) -> f64 {
    profile.points().map(|point| point.y).fold(f64::NEG_INFINITY, f64::max)
}

/// The pairs of blocks with ground that has a profile, and that profile.
pub(crate) type OnProfile<'a> = Option<(&'a Profile, Vec<ProfilePair>)>;

#[cfg(test)]
mod tests {
    use super::*;

    fn profile(points: &[[f64; 2]]) -> Profile {
        Profile::new(points.iter().map(|x| Vector2::new(x[0], x[1])).collect()).unwrap()
    }

    #[test]
    fn a_base_lies_on_pieces_over_valleys_and_across_crests() {
        let hill = profile(&[[0.0, 0.0], [4.0, 3.0], [8.0, 0.0]]);
        let line = |at: f64, width: f64| resting_line(&hill, at, width).unwrap();
        let slope = 0.75_f64.atan();
        for (found, exact) in line(2.0, 1.0).iter().zip([2.0, 1.5, slope]) {
            assert!((found - exact).abs() < 1e-15, "on the piece: {found} {exact}");
        }
        assert_eq!(line(-3.0, 1.0), [-3.0, 0.0, 0.0]);
        // On the crest it may have any slope between those beside it: the least is 0.
        assert_eq!(line(4.0, 1.0), [4.0, 3.0, 0.0]);
        // Beside it, it lies on a piece, and sticks out over the crest.
        let beside = line(3.9, 1.0);
        assert!((beside[2] - slope).abs() < 1e-15 && (beside[1] - 2.925).abs() < 1e-15);
        // Across the valley at the foot its ends are on both pieces.
        let [x, y, angle] = line(0.0, 1.0);
        let ends = [-0.5, 0.5].map(|s| Vector2::new(x + s * angle.cos(), y + s * angle.sin()));
        assert!(ends.iter().all(|end| (end.y - hill.height(end.x)).abs() < 1e-14) && angle > 0.1 && angle < slope);
        // Between two ridges it lies on both.
        let trench = profile(&[[-0.1, 0.0], [0.0, 1.0], [0.1, 0.0], [0.9, 0.0], [1.0, 1.5], [1.1, 0.0]]);
        let [_, y, angle] = resting_line(&trench, 0.5, 2.0).unwrap();
        assert!((angle - 0.5_f64.atan()).abs() < 1e-15 && (y - 1.25).abs() < 1e-15);
    }

    #[test]
    fn a_base_is_over_the_pieces_of_a_crest_and_across_a_valley() {
        let hill = profile(&[[-4.0, 0.0], [-2.0, 0.0], [0.0, 0.0], [4.0, -3.0]]);
        let slope = -0.75_f64.atan();
        assert_eq!(pieces_under(&hill, [-1.0, 2.0]), [([-1.0, 0.0], 0.0), ([0.0, 2.0], slope)]);
        assert_eq!(pieces_under(&hill, [2.0, 6.0]), [([2.0, 6.0], -0.375_f64.atan())]);
        assert!(pieces_under(&hill, [1.0, 1.0]).is_empty());
        assert_eq!([-5.0, -4.0, 0.0, 2.0, 4.0, 5.0].map(|x| along(&hill, x)), [-1.0, 0.0, 4.0, 6.5, 9.0, 10.0]);
    }
}
