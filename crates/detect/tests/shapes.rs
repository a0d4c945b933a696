//! Polygons and discs against each other.
#![allow(clippy::unwrap_used)]

use nalgebra::{Rotation2, Vector2};
use teeter_detect::conformance::check;
use teeter_detect::{
    BodyId, Candidates, ContactDetector, CornerOnSide, DetectorMemory, Disc, Geometry, Groups, Kinematics, LawId,
    Polygon, Rounded, Shape, ShapeDetector, ShapePair, SurfacePoint,
};

/// Bodies at (x, y, φ).
#[derive(Clone)]
struct Poses(Vec<[f64; 3]>);

impl Geometry<2> for Poses {
    fn place(&self, body: BodyId, local: &[Vector2<f64>], out: &mut [Vector2<f64>]) {
        let [x, y, angle] = self.0[body.0 as usize];
        let turn = Rotation2::new(angle);
        out.iter_mut().zip(local).for_each(|(out, local)| *out = turn * local + Vector2::new(x, y));
    }

    fn surface(&self, _: BodyId, _: Kinematics, _: &Vector2<f64>) -> Option<SurfacePoint<2>> {
        None
    }
}

fn rectangle(width: f64, height: f64) -> Shape {
    let (x, y) = (0.5 * width, 0.5 * height);
    polygon(&[[-x, -y], [x, -y], [x, y], [-x, y]])
}

fn polygon(corners: &[[f64; 2]]) -> Shape {
    Polygon::new(corners.iter().map(|x| Vector2::new(x[0], x[1])).collect()).unwrap().into()
}

fn disc(radius: f64) -> Shape {
    Disc::new(Vector2::new(0.1 * radius, -0.2 * radius), radius).unwrap().into()
}

fn rounded(width: f64, height: f64, radius: f64) -> Shape {
    let polygon = Polygon::new(rectangle(width, height).core().to_vec()).unwrap();
    Rounded::inside(&polygon, radius).unwrap().into()
}

fn pair(shapes: [Shape; 2]) -> ShapeDetector {
    let [a, b] = shapes;
    let bodies = [BodyId(0), BodyId(1)];
    ShapeDetector::new(vec![(BodyId(0), a), (BodyId(1), b)], vec![ShapePair { pair: 0, law: LawId(0), bodies }])
        .unwrap()
}

fn found(detector: &ShapeDetector, poses: &[[f64; 3]; 2], margin: f64) -> Candidates<2> {
    let mut out = Candidates::new();
    detector.detect(&Poses(poses.to_vec()), margin, &mut DetectorMemory::default(), &mut out);
    out
}

/// Corners (owner, corner) of what was found, and its gaps.
fn corners(found: &Candidates<2>) -> (Vec<(usize, usize)>, Vec<f64>) {
    let feature = |number| CornerOnSide::from_number(number);
    let owners = found.iter().map(|c| feature(c.id.point())).map(|f| (f.owner, f.corner)).collect();
    (owners, found.iter().map(|c| c.gap).collect())
}

#[test]
fn shapes_of_all_kinds_keep_the_contract() {
    let wedge = polygon(&[[-1.0, -0.4], [1.1, -0.5], [0.2, 0.9]]);
    let poses = [
        Poses(vec![[0.0, 0.0, 0.0], [0.1, 1.4, 0.0]]),
        Poses(vec![[0.0, 0.0, 0.1], [0.1, 1.3, -0.2]]),
        Poses(vec![[0.0, 0.0, 0.3], [0.2, 0.9, 0.5]]),
        Poses(vec![[0.0, 0.0, 0.3], [1.7, 0.4, 2.5]]),
        Poses(vec![[0.0, 0.0, 0.3], [9.0, 0.4, 2.5]]),
    ];
    let poses: Vec<&dyn Geometry<2>> = poses.iter().map(|poses| poses as &dyn Geometry<2>).collect();
    let stadium = Shape::from(Rounded::new(vec![Vector2::new(-0.7, 0.1), Vector2::new(0.6, -0.2)], 0.3).unwrap());
    let shapes = [rectangle(2.0, 1.0), wedge, disc(0.7), rounded(2.0, 1.0, 0.1), stadium];
    for a in &shapes {
        for b in &shapes {
            assert_eq!(check(&pair([a.clone(), b.clone()]), &poses), []);
        }
    }
}

/// Else friction and its reaction had a couple of their own.
#[test]
fn shapes_act_on_each_other_in_one_place() {
    let wedge = polygon(&[[-1.0, -0.4], [1.1, -0.5], [0.2, 0.9]]);
    let shapes = [rectangle(2.0, 1.0), wedge, disc(0.7), rounded(2.0, 1.0, 0.1)];
    let mut looked = 0;
    for (a, b) in shapes.iter().flat_map(|a| shapes.iter().map(move |b| (a, b))) {
        let detector = pair([a.clone(), b.clone()]);
        // Apart, and in each other.
        for pose in [[[0.0, 0.0, 0.3], [1.7, 1.4, 2.5]], [[0.0, 0.0, 0.1], [0.1, 1.1, -0.2]]] {
            let at = Poses(pose.to_vec());
            for mut contact in found(&detector, &pose, 10.0) {
                detector.bring_together(&at, &mut contact);
                let [one, other] = contact.sides.map(|side| {
                    let mut place = [Vector2::zeros()];
                    at.place(side.body, &[side.point], &mut place);
                    place[0]
                });
                assert!((one - other).norm() < 1e-14, "{contact:?}");
                looked += usize::from(contact.gap.abs() > 0.01);
            }
        }
    }
    assert!(looked > 20, "{looked}");
}

#[test]
fn a_block_on_a_wider_one_stands_on_its_own_corners_and_the_other_way_round() {
    let narrow_on_wide = pair([rectangle(1.0, 1.0), rectangle(4.0, 1.0)]);
    let at = [[0.3, 1.0, 0.0], [0.0, 0.0, 0.0]];
    let found_there = found(&narrow_on_wide, &at, 1e-6);
    assert_eq!(corners(&found_there), (vec![(0, 0), (0, 1)], vec![0.0, 0.0]));
    assert!(found_there.iter().all(|c| c.frame.row(0).transpose() == Vector2::y()), "up, to the first");
    let wide_on_narrow = pair([rectangle(4.0, 1.0), rectangle(1.0, 1.0)]);
    let found_there = found(&wide_on_narrow, &at, 1e-6);
    assert_eq!(corners(&found_there), (vec![(1, 2), (1, 3)], vec![0.0, 0.0]));
    assert!(found_there.iter().all(|c| c.frame.row(0).transpose() == Vector2::y()), "up, to the first");
}

#[test]
fn an_overhang_stands_on_a_corner_of_each() {
    let bricks = pair([rectangle(2.0, 1.0), rectangle(2.0, 1.0)]);
    let found_there = found(&bricks, &[[0.7, 1.0, 0.0], [0.0, 0.0, 0.0]], 1e-6);
    assert_eq!(corners(&found_there).0, [(0, 0), (1, 2)]);
    let x = |k: usize| found_there[k].sides[1].point.x;
    assert!((x(0) + 0.3).abs() < 1e-15 && (x(1) - 1.0).abs() < 1e-15, "{} {}", x(0), x(1));
}

#[test]
fn blocks_in_line_keep_their_features_through_rounding() {
    let bricks = pair([rectangle(2.0, 1.0), rectangle(2.0, 1.0)]);
    for off in [-1e-13, -1e-16, 0.0, 1e-16, 1e-13] {
        for angle in [-1e-14, 0.0, 1e-14] {
            let found = found(&bricks, &[[off, 1.0 + off, angle], [0.0, 0.0, 0.0]], 1e-6);
            assert_eq!(corners(&found).0, [(0, 0), (0, 1)], "{off} {angle}");
        }
    }
}

#[test]
fn a_block_that_tips_stays_on_the_corner_that_it_tips_about() {
    // Its bottom lies on the other's corner, which is its place of turning, from 1e-12 to 40
    // degrees.
    let plank = pair([rectangle(4.0, 0.2), rectangle(1.0, 1.0)]);
    for angle in [1e-12_f64, 1e-6, 0.01, 0.3, 0.7] {
        let (sin, cos) = angle.sin_cos();
        // The point of the plank that stays on (½, ½), 0.7 left of its middle: the plank turns
        // clockwise about it.
        let (x, y) = (0.5 + 0.7 * cos + 0.1 * sin, 0.5 - 0.7 * sin + 0.1 * cos);
        let found = found(&plank, &[[x, y, -angle], [0.0, 0.0, 0.0]], 1e-9);
        let at_corner =
            found.iter().filter(|c| CornerOnSide::from_number(c.id.point()).corner == 2).collect::<Vec<_>>();
        assert_eq!(at_corner.len(), 1, "{angle}: {found:?}");
        assert!(at_corner[0].gap.abs() < 1e-15);
        let normal = at_corner[0].frame.row(0).transpose();
        assert!((normal - Vector2::new(-(-angle).sin(), cos)).norm() < 1e-14, "along the plank's own normal");
    }
}

#[test]
fn a_corner_that_slides_off_its_side_is_not_found_there_again() {
    let bricks = pair([rectangle(2.0, 1.0), rectangle(2.0, 1.0)]);
    let on = found(&bricks, &[[0.7, 1.0, 0.0], [0.0, 0.0, 0.0]], 1e-6);
    let ids = [on[1].id];
    let mut out = Candidates::new();
    for (x, there) in [(0.7, 1), (1.5, 1), (2.0, 1), (2.1, 0), (-0.1, 0)] {
        bricks.locate(&Poses(vec![[x, 1.2, 0.0], [0.0, 0.0, 0.0]]), &ids, &mut out);
        assert_eq!(out.len(), there, "{x}");
        assert!(out.iter().all(|c| (c.gap - 0.2).abs() < 1e-15));
    }
}

#[test]
fn past_the_end_of_its_side_a_corner_is_followed_along_the_sides_line() {
    let bricks = pair([rectangle(2.0, 1.0), rectangle(2.0, 1.0)]);
    let on = found(&bricks, &[[0.7, 1.0, 0.0], [0.0, 0.0, 0.0]], 1e-6);
    let ids: Vec<_> = on.iter().map(|c| c.id).collect();
    let (mut out, mut rooms) = (Candidates::new(), Vec::new());
    for x in [0.7, 1.5, 1.9, 2.1, -0.1, -30.0] {
        bricks.locate_past_ends(&Poses(vec![[x, 1.2, 0.0], [0.0, 0.0, 0.0]]), &ids, &mut out, &mut rooms);
        assert_eq!((out.len(), rooms.len()), (2, 2), "{x}");
        // The upper brick's left corner is at x − 1 on a side from −1 to 1; the lower one's right
        // corner at 1 − x on the upper one's. What is known counts as over its side for 1e-9 of its
        // length more.
        for room in &rooms {
            assert!((room - f64::min(x, 2.0 - x) - 2e-9).abs() < 1e-13, "{x}: {room}");
        }
        assert!(out.iter().all(|c| (c.gap - 0.2).abs() < 1e-15 && c.frame.row(0).transpose() == Vector2::y()), "{x}");
    }
}

#[test]
fn a_disc_that_rolls_over_a_corner_is_on_three_pieces_one_after_another() {
    // The disc's centre is at (0.05, -0.1) of its body.
    let on_block = pair([disc(0.5), rectangle(2.0, 1.0)]);
    let at = |x: f64, y: f64| Poses(vec![[x - 0.05, y + 0.1, 0.0], [0.0, 0.0, 0.0]]);
    let on = found(&on_block, &[[0.4, 1.1, 0.0], [0.0, 0.0, 0.0]], 1e-6);
    let ids = [on[0].id];
    let mut pieces = Vec::new();
    let mut piece = |x: f64, y: f64| {
        on_block.pieces(&at(x, y), &ids, &mut pieces);
        assert_eq!(pieces.len(), 1);
        pieces[0]
    };
    let top = piece(0.5, 1.0);
    assert_eq!(piece(-0.9, 1.1), top, "a piece is a side, wherever on it the disc is, and however far from it");
    let (corner, flank) = (piece(1.0 + 0.3, 0.5 + 0.4), piece(1.5, 0.2));
    assert!(top != corner && corner != flank && flank != top, "{top} {corner} {flank}");

    let bricks = pair([rectangle(2.0, 1.0), rectangle(2.0, 1.0)]);
    let on = found(&bricks, &[[0.7, 1.0, 0.0], [0.0, 0.0, 0.0]], 1e-6);
    bricks.pieces(&at(0.7, 1.0), &[on[0].id], &mut pieces);
    assert!(pieces.is_empty(), "a sharp corner leaves its side");
}

#[test]
fn discs_touch_at_the_nearest_points() {
    let discs = pair([disc(1.0), disc(0.5)]);
    // Centres at (0.1, −0.2) and (0.05, −0.1) of their bodies, not turned.
    let found_there = found(&discs, &[[3.0, 4.0, 0.0], [0.05, -0.1, 0.0]], 10.0);
    assert_eq!(found_there.len(), 1);
    let contact = found_there[0];
    assert!((contact.gap - (3.0_f64.hypot(4.0) - 1.5)).abs() < 1e-14);
    assert!((contact.frame.row(0).transpose() - Vector2::new(0.6, 0.8)).norm() < 1e-15, "from the second to the first");
    let on_block = pair([disc(0.5), rectangle(2.0, 1.0)]);
    // Over the side, past its end over the corner, and beside the other side.
    for (x, y, gap, normal) in [(0.0, 1.5, 0.5, [0.0, 1.0]), (1.3, 0.9, 0.0, [0.6, 0.8]), (1.4, 0.1, -0.1, [1.0, 0.0])]
    {
        let found_there = found(&on_block, &[[x - 0.05, y + 0.1, 0.0], [0.0, 0.0, 0.0]], 10.0);
        assert!((found_there[0].gap - gap).abs() < 1e-14, "{x} {y}: {}", found_there[0].gap);
        assert!((found_there[0].frame.row(0).transpose() - Vector2::from(normal)).norm() < 1e-14);
    }
}

#[test]
fn a_rounded_block_stands_where_its_roundings_begin_and_rolls_about_them() {
    let block = pair([rounded(1.0, 2.0, 0.1), rectangle(4.0, 1.0)]);
    let flat = found(&block, &[[0.3, 1.5, 0.0], [0.0, 0.0, 0.0]], 1e-6);
    assert_eq!(corners(&flat).0, [(0, 0), (0, 1)]);
    for (contact, x) in flat.iter().zip([-0.4, 0.4]) {
        assert!(contact.gap.abs() < 1e-15 && (contact.sides[0].point - Vector2::new(x, -1.0)).norm() < 1e-15);
        assert!((contact.sides[1].point - Vector2::new(x + 0.3, 0.5)).norm() < 1e-15);
    }
    // Turned by any angle about the middle of its rounding it touches below that, with the same
    // identity.
    for angle in [1e-12, 0.01, 0.3, 1.0, 1.5] {
        let turn = Rotation2::new(angle);
        let centre = Vector2::new(-0.1, 0.6) - turn * Vector2::new(-0.4, -0.9);
        let rolled = found(&block, &[[centre.x, centre.y, angle], [0.0, 0.0, 0.0]], 1e-6);
        let touching = rolled.iter().find(|contact| contact.id == flat[0].id).unwrap();
        assert!(touching.gap.abs() < 1e-15, "{angle}: {}", touching.gap);
        let below = Vector2::new(-0.4, -0.9) + turn.inverse() * Vector2::new(0.0, -0.1);
        assert!((touching.sides[0].point - below).norm() < 1e-15, "{angle}");
    }
}

#[test]
fn rounded_corners_touch_beside_each_other() {
    let blocks = pair([rounded(1.0, 1.0, 0.1), rounded(1.0, 1.0, 0.2)]);
    // The middle of the first one's left bottom rounding is at (−0.4, −0.4) from its centre, of the
    // other's right top at (0.3, 0.3).
    let there = found(&blocks, &[[1.0, 1.1, 0.0], [0.0, 0.0, 0.0]], 1.0);
    assert_eq!(there.len(), 1);
    let apart = Vector2::new(0.3_f64, 0.4);
    assert!((there[0].gap - (apart.norm() - 0.3)).abs() < 1e-15);
    assert!((there[0].frame.row(0).transpose() - apart.normalize()).norm() < 1e-15);
}

#[test]
fn a_body_of_parts_touches_by_each_of_them() {
    // A table: a board on two legs, of which one ends in a disc; over a long block, and turned over
    // it.
    let board = polygon(&[[-1.0, 0.4], [1.0, 0.4], [1.0, 0.5], [-1.0, 0.5]]);
    let leg = polygon(&[[-0.9, 0.0], [-0.8, 0.0], [-0.8, 0.4], [-0.9, 0.4]]);
    let foot = Shape::from(Disc::new(Vector2::new(0.85, 0.1), 0.1).unwrap());
    let bodies = [BodyId(0), BodyId(1)];
    let shapes = vec![(BodyId(0), board), (BodyId(0), leg), (BodyId(1), rectangle(4.0, 1.0)), (BodyId(0), foot)];
    let table = ShapeDetector::new(shapes, vec![ShapePair { pair: 0, law: LawId(0), bodies }]).unwrap();
    let on = found(&table, &[[0.0, 0.5, 0.0], [0.0, 0.0, 0.0]], 1e-6);
    // Corners are numbered over all parts: four of the board, four of the leg, the middle of the
    // disc.
    assert_eq!(corners(&on).0, [(0, 4), (0, 5), (0, 8)]);
    assert!(on.iter().all(|contact| contact.gap.abs() < 1e-15));
    let poses = [[0.0, 0.5, 0.0], [0.0, 0.52, 0.3], [0.2, 1.0, 2.9], [1.7, 0.8, 1.2]];
    let poses: Vec<_> = poses.map(|pose| Poses(vec![pose, [0.0, 0.0, 0.1]])).into();
    let poses: Vec<&dyn Geometry<2>> = poses.iter().map(|poses| poses as &dyn Geometry<2>).collect();
    assert_eq!(check(&table, &poses), []);
}

/// Bodies that drift and turn, all against all but for one pair of classes, of which nothing
/// touches: the same contacts as of pairs that are listed one by one, whatever was kept in memory.
#[test]
fn groups_find_what_listed_pairs_find() {
    let n = 40_u32;
    let shapes = |k: u32| match k % 3 {
        0 => rectangle(1.0, 0.6),
        1 => disc(0.4),
        _ => polygon(&[[-0.4, -0.4], [0.5, -0.3], [0.1, 0.6]]),
    };
    let shapes: Vec<_> = (0..n).map(|k| (BodyId(k), shapes(k))).collect();
    let class = |k: u32| usize::from(k.is_multiple_of(5));
    let laws = vec![vec![Some(LawId(2)), Some(LawId(3))], vec![None, None]];
    let groups = Groups::new((0..n).map(|k| (BodyId(k), class(k))).collect(), laws).unwrap();
    let groups = groups.without(&[[BodyId(4), BodyId(3)], [BodyId(8), BodyId(9)], [BodyId(9), BodyId(n)]]);
    assert_eq!([(3, 4), (9, 8)].map(|(a, b)| groups.law(BodyId(a), BodyId(b))), [None; 2]);
    let first = 7;
    let mut pairs = vec![ShapePair { pair: 3, law: LawId(1), bodies: [BodyId(1), BodyId(2)] }];
    let listed = ShapeDetector::new(shapes.clone(), pairs.clone()).unwrap();
    for i in 0..n {
        for j in i + 1..n {
            if (i, j) != (1, 2)
                && let Some(law) = groups.law(BodyId(i), BodyId(j))
            {
                pairs.push(ShapePair { pair: first + i * n + j, law, bodies: [BodyId(i), BodyId(j)] });
            }
        }
    }
    let pairwise = ShapeDetector::new(shapes, pairs).unwrap();
    let grouped = listed.with_groups(groups, first).unwrap();
    let mut memory = DetectorMemory::default();
    let place = |k: u32, t: f64| {
        let (a, b) = (f64::from(k % 7), f64::from(k / 7));
        [0.9 * a + 0.3 * (b + t).sin(), 0.8 * b + 0.2 * (a + 2.0 * t).cos(), a * b + t]
    };
    let (mut out, mut fresh, mut all, mut found) = (Candidates::new(), Candidates::new(), Candidates::new(), 0);
    let mut configurations = Vec::new();
    for k in 0..300 {
        let poses = Poses((0..n).map(|body| place(body, 0.01 * f64::from(k))).collect());
        let margin = [0.0, 0.01, 0.3][k as usize % 3];
        grouped.detect(&poses, margin, &mut memory, &mut out);
        grouped.detect(&poses, margin, &mut DetectorMemory::default(), &mut fresh);
        pairwise.detect(&poses, margin, &mut DetectorMemory::default(), &mut all);
        assert_eq!(out, fresh, "{k}");
        assert_eq!(out, all, "{k}");
        found += out.len();
        if k % 100 == 0 {
            configurations.push(poses);
        }
    }
    assert!(found > 3000, "{found}");
    let configurations: Vec<&dyn Geometry<2>> = configurations.iter().map(|poses| poses as &dyn Geometry<2>).collect();
    assert_eq!(check(&grouped, &configurations), []);
}

#[test]
fn groups_that_cannot_work_are_refused() {
    let laws = vec![vec![Some(LawId(0))]];
    assert!(Groups::new(vec![(BodyId(0), 0), (BodyId(0), 0)], laws.clone()).is_err());
    assert!(Groups::new(vec![(BodyId(0), 1)], laws.clone()).is_err());
    let groups = Groups::new(vec![(BodyId(0), 0), (BodyId(9), 0)], laws).unwrap();
    let error = pair([disc(1.0), disc(1.0)]).with_groups(groups, 1).unwrap_err();
    assert_eq!(error.to_string(), "body 9 has no shape: give it one");
}

/// The distance of two polygons apart from each other: the least of any corner from any side.
fn distance(poses: &[[f64; 3]; 2], shapes: [&[Vector2<f64>]; 2]) -> f64 {
    let place = |k: usize| {
        let mut out = vec![Vector2::zeros(); shapes[k].len()];
        Poses(poses.to_vec()).place(BodyId(k as u32), shapes[k], &mut out);
        out
    };
    let placed = [place(0), place(1)];
    let mut least = f64::INFINITY;
    for k in 0..2 {
        let others = &placed[1 - k];
        for corner in &placed[k] {
            for (i, from) in others.iter().enumerate() {
                let side = others[(i + 1) % others.len()] - from;
                let along = ((corner - from).dot(&side) / side.norm_squared()).clamp(0.0, 1.0);
                least = least.min((corner - from - side * along).norm());
            }
        }
    }
    least
}

/// Random polygons in random places: the smallest gap is the distance, but where corner is beside
/// corner; the two see each other alike, in whatever order, and turned or moved as a whole.
#[test]
fn random_polygons_are_as_far_apart_as_their_nearest_points() {
    let mut seed = 12_345_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut apart = 0;
    for _ in 0..3000 {
        let mut shape = || {
            let corners = 3 + (random() * 6.0) as usize;
            let size = 0.2 + random();
            let angles = |k: usize| (k as f64 + 0.8 * random()) / corners as f64 * std::f64::consts::TAU;
            (0..corners).map(angles).map(|a| Vector2::new(size * a.cos(), 0.7 * size * a.sin())).collect::<Vec<_>>()
        };
        let (a, b) = (shape(), shape());
        let poses = [[0.0, 0.0, 6.0 * random()], [3.0 * random(), 3.0 * random(), 6.0 * random()]];
        let shapes = [a.clone(), b.clone()].map(|corners| Shape::from(Polygon::new(corners).unwrap()));
        let mine = found(&pair(shapes.clone()), &poses, f64::INFINITY);
        let [first, second] = shapes;
        let swapped = found(&pair([second, first]), &[poses[1], poses[0]], f64::INFINITY);
        assert_eq!(mine.len(), swapped.len());
        for contact in &mine {
            let same = swapped.iter().any(|other| {
                (other.gap - contact.gap).abs() < 1e-12 && (other.frame.row(0) + contact.frame.row(0)).norm() < 1e-12
            });
            assert!(same, "{contact:?} {swapped:?}");
        }
        let least = mine.iter().map(|contact| contact.gap).fold(f64::INFINITY, f64::min);
        let expected = distance(&poses, [&a, &b]);
        if least < f64::INFINITY && least > 0.0 {
            // Not nearer than they are; and that near where the nearest points are a corner's and a
            // side's.
            assert!(least >= expected - 1e-12, "{least} {expected}");
            apart += usize::from((least - expected).abs() < 1e-12);
        }
    }
    assert!(apart > 1000, "{apart}");
}

/// Random rounded polygons: apart they are as far as their cores less both radii, corner beside
/// corner too.
#[test]
fn random_rounded_polygons_are_as_far_apart_as_their_cores_less_the_radii() {
    let mut seed = 54_321_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut apart = 0;
    for _ in 0..3000 {
        let mut shape = || {
            let corners = 3 + (random() * 6.0) as usize;
            let angles = |k: usize| (k as f64 + 0.8 * random()) / corners as f64 * std::f64::consts::TAU;
            (0..corners).map(angles).map(|a| Vector2::new(a.cos(), 0.7 * a.sin())).collect::<Vec<_>>()
        };
        let (a, b) = (shape(), shape());
        let poses = [[0.0, 0.0, 6.0 * random()], [3.0 * random(), 3.0 * random(), 6.0 * random()]];
        let shapes = [(a.clone(), 0.1), (b.clone(), 0.05)].map(|(core, radius)| Rounded::new(core, radius).unwrap());
        let mine = found(&pair(shapes.map(Shape::from)), &poses, f64::INFINITY);
        let least = mine.iter().map(|contact| contact.gap).fold(f64::INFINITY, f64::min);
        let expected = distance(&poses, [&a, &b]) - 0.15;
        if least > -0.15 {
            assert!((least - expected).abs() < 1e-12, "{least} {expected}");
            apart += 1;
        }
    }
    assert!(apart > 1500, "{apart}");
}
