//! Shapes against ground that is not flat.
#![allow(clippy::unwrap_used)]

use nalgebra::{Rotation2, Vector2};
use teeter_detect::conformance::check;
use teeter_detect::{
    BodyId, Candidates, ContactDetector, DetectorMemory, Disc, Geometry, Kinematics, LawId, Polygon, Profile,
    ProfilePair, Rounded, Shape, ShapeDetector, SurfacePoint,
};

/// A body and the ground at (x, y, φ).
#[derive(Clone, Copy)]
struct Poses([[f64; 3]; 2]);

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

/// A valley of right angles at (1, 0), a crest at (2, 1), and level ground at both ends.
fn valley_and_crest() -> Profile {
    Profile::new([[0.0, 1.0], [1.0, 0.0], [2.0, 1.0], [4.0, -1.0]].map(Vector2::from).to_vec()).unwrap()
}

fn detector(shape: Shape) -> ShapeDetector {
    let (body, ground) = (BodyId(0), BodyId(1));
    let pair = ProfilePair { pair: 0, law: LawId(0), body, ground };
    let shapes = ShapeDetector::new(vec![(body, shape)], Vec::new()).unwrap();
    shapes.with_profile(valley_and_crest(), vec![pair]).unwrap()
}

fn square(side: f64) -> Polygon {
    let x = 0.5 * side;
    Polygon::new([[-x, -x], [x, -x], [x, x], [-x, x]].map(Vector2::from).to_vec()).unwrap()
}

fn disc(radius: f64) -> Shape {
    Disc::new(Vector2::zeros(), radius).unwrap().into()
}

/// Gaps and normals at a pose over ground at the origin, and again over ground that is moved and
/// turned.
fn found(shape: &Shape, pose: [f64; 3], margin: f64) -> Vec<(f64, Vector2<f64>)> {
    let detector = detector(shape.clone());
    let contacts = |poses: Poses| {
        let mut out = Candidates::new();
        detector.detect(&poses, margin, &mut DetectorMemory::default(), &mut out);
        out
    };
    let here = contacts(Poses([pose, [0.0; 3]]));
    let turn = Rotation2::new(0.7);
    let place = turn * Vector2::new(pose[0], pose[1]) + Vector2::new(3.0, -2.0);
    let there = contacts(Poses([[place.x, place.y, pose[2] + 0.7], [3.0, -2.0, 0.7]]));
    assert_eq!(here.len(), there.len());
    for (here, there) in here.iter().zip(&there) {
        assert!(here.id == there.id && (here.gap - there.gap).abs() < 1e-14, "{here:?} {there:?}");
        assert!((turn * here.frame.row(0).transpose() - there.frame.row(0).transpose()).norm() < 1e-14);
        assert!((0..2).all(|side| (here.sides[side].point - there.sides[side].point).norm() < 1e-14));
    }
    here.iter().map(|contact| (contact.gap, contact.frame.row(0).transpose())).collect()
}

fn assert_found(shape: &Shape, pose: [f64; 3], wanted: &[(f64, [f64; 2])]) {
    let found = found(shape, pose, 0.5);
    let close =
        |k: usize| (found[k].0 - wanted[k].0).abs() < 1e-14 && (found[k].1 - Vector2::from(wanted[k].1)).norm() < 1e-14;
    let all = found.len() == wanted.len() && (0..found.len()).all(close);
    assert!(all, "{pose:?}: {found:?}, not {wanted:?}");
}

const UP: f64 = std::f64::consts::FRAC_1_SQRT_2;

#[test]
fn a_disc_lies_on_both_sides_of_a_valley_and_rolls_over_a_crest() {
    let (ball, root) = (disc(0.2), 2.0_f64.sqrt());
    assert_found(&ball, [1.0, 0.2 * root, 0.3], &[(0.0, [UP, UP]), (0.0, [-UP, UP])]);
    assert_found(&ball, [2.0, 1.2, 0.3], &[(0.0, [0.0, 1.0])]);
    assert_found(&ball, [2.0 + 0.18, 1.0 + 0.24, 0.0], &[(0.1, [0.6, 0.8])]);
    assert_found(&ball, [3.0, 0.2 * root, 0.0], &[(0.0, [UP, UP])]);
    assert_found(&ball, [-2.0, 1.1, 0.0], &[(-0.1, [0.0, 1.0])]);
}

#[test]
fn a_block_stands_by_its_corners_and_on_a_crest() {
    let block = Shape::from(square(0.4));
    // In the valley on its corner, which both sides hold.
    let height = 0.2 * 2.0_f64.sqrt();
    let turned = [1.0, height, std::f64::consts::FRAC_PI_4];
    let corners = found(&block, turned, 1e-9);
    assert!(
        corners.len() == 4 && corners.iter().all(|(gap, _)| gap.abs() < 1e-15),
        "it lies on both sides: {corners:?}"
    );
    // Level on the crest.
    assert_found(&block, [2.05, 1.2, 0.0], &[(0.15 * UP, [-UP, UP]), (0.25 * UP, [UP, UP]), (0.0, [0.0, 1.0])]);
    // Along the slope, over the crest's end: a corner and the crest hold it.
    let along = Vector2::new(UP, -UP);
    let centre = Vector2::new(2.0, 1.0) + along * 0.1 + Vector2::new(UP, UP) * 0.2;
    let lying = found(&block, [centre.x, centre.y, -std::f64::consts::FRAC_PI_4], 1e-9);
    assert!(
        lying.len() == 2 && lying.iter().all(|(gap, n)| gap.abs() < 1e-15 && (n - Vector2::new(UP, UP)).norm() < 1e-8)
    );
}

#[test]
fn what_is_under_the_ground_is_pushed_out_the_shortest_way() {
    // A corner 0.1 under the right slope, which is 0.9 deep seen from the left one.
    let block = Shape::from(square(0.4));
    let contacts = found(&block, [2.9, 0.2, std::f64::consts::FRAC_PI_4 * 0.1], 0.0);
    assert!(!contacts.is_empty());
    for (gap, normal) in &contacts {
        assert!(*gap > -0.3 && normal.x > 0.0, "{gap} {normal}");
    }
}

#[test]
fn shapes_of_all_kinds_keep_the_contract_on_profiles() {
    let ground = [0.1, -0.2, 0.05];
    let poses =
        [[1.0, 0.3, 0.1], [2.0, 1.1, 0.4], [2.1, 1.25, -0.8], [3.5, -0.2, 2.0], [-1.0, 1.1, 0.0], [0.9, 0.1, 0.2]];
    let poses = poses.map(|pose| Poses([pose, ground]));
    let poses: Vec<&dyn Geometry<2>> = poses.iter().map(|poses| poses as &dyn Geometry<2>).collect();
    let rounded = Rounded::inside(&square(0.5), 0.1).unwrap();
    for shape in [Shape::from(square(0.4)), disc(0.3), rounded.into()] {
        assert_eq!(check(&detector(shape), &poses), []);
    }
}
