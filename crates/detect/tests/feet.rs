//! Corners, roundings and discs on surfaces.
#![allow(clippy::unwrap_used)]

use nalgebra::{Rotation2, Vector2};
use teeter_detect::conformance::check;
use teeter_detect::{
    BodyId, Candidates, ContactDetector, DetectorMemory, Disc, Geometry, Kinematics, LawId, OnSide, Polygon, Rounded,
    Shape, ShapeDetector, SidePair, SurfacePair, SurfacePoint,
};

/// A body at (x, y, φ) over the parabola y = ½ κ x², for |x| ≤ 1.
struct Bowl {
    pose: [f64; 3],
    curvature: f64,
}

impl Bowl {
    fn at(&self, x: f64) -> SurfacePoint<2> {
        let normal = Vector2::new(-self.curvature * x, 1.0).normalize();
        SurfacePoint { place: Vector2::new(x, 0.5 * self.curvature * x * x), normal, material: Vector2::new(x, 0.0) }
    }
}

impl Geometry<2> for Bowl {
    fn place(&self, body: BodyId, local: &[Vector2<f64>], out: &mut [Vector2<f64>]) {
        if body == BodyId(1) {
            out.iter_mut().zip(local).for_each(|(out, local)| *out = self.at(local.x).place);
            return;
        }
        let [x, y, angle] = self.pose;
        let turn = Rotation2::new(angle);
        out.iter_mut().zip(local).for_each(|(out, local)| *out = turn * local + Vector2::new(x, y));
    }

    fn surface(&self, _: BodyId, _: Kinematics, at: &Vector2<f64>) -> Option<SurfacePoint<2>> {
        (at.x.abs() <= 1.0).then(|| self.at(at.x))
    }

    fn ends(&self, _: BodyId, _: Kinematics) -> [Option<SurfacePoint<2>>; 2] {
        [Some(self.at(-1.0)), Some(self.at(1.0))]
    }
}

fn detector(shape: Shape) -> ShapeDetector {
    let (body, surface, law, kinematics) = (BodyId(0), BodyId(1), LawId(0), Kinematics::Deformed);
    let on = SurfacePair { pair: 0, law, body, surface, kinematics };
    let sides = SidePair { pair: 1, law, body, surface, kinematics };
    let shapes = ShapeDetector::new(vec![(body, shape)], Vec::new()).unwrap();
    shapes.with_surfaces(vec![on]).unwrap().with_sides(vec![sides]).unwrap()
}

fn found(shape: Shape, at: &Bowl, margin: f64) -> Candidates<2> {
    let mut out = Candidates::new();
    detector(shape).detect(at, margin, &mut DetectorMemory::default(), &mut out);
    out
}

#[test]
fn a_disc_touches_a_bowl_where_both_have_one_normal() {
    let (radius, curvature) = (0.1, 2.0);
    let disc = || Disc::new(Vector2::new(0.02, 0.0), radius).unwrap().into();
    for x in [-0.4, 0.0, 0.3] {
        let bowl = Bowl { pose: [0.0; 3], curvature };
        let foot = bowl.at(x);
        let centre = foot.place + foot.normal * radius;
        let angle = 0.7;
        let origin = centre - Rotation2::new(angle) * Vector2::new(0.02, 0.0);
        let out = found(disc(), &Bowl { pose: [origin.x, origin.y, angle], curvature }, 1e-9);
        assert_eq!(out.len(), 1, "{x}");
        assert!(out[0].gap.abs() < 1e-15 && (out[0].sides[1].point.x - x).abs() < 1e-14, "{x}: {:?}", out[0]);
        assert!((out[0].frame.row(0).transpose() - foot.normal).norm() < 1e-14);
        let local = Vector2::new(0.02, 0.0) - Rotation2::new(-angle) * foot.normal * radius;
        assert!((out[0].sides[0].point - local).norm() < 1e-14);
    }
}

#[test]
fn a_disc_rolls_off_the_end_of_a_surface_about_its_end() {
    let bowl = |pose| Bowl { pose, curvature: 0.0 };
    let disc = || Disc::new(Vector2::zeros(), 0.5).unwrap().into();
    let (gap, normal): (f64, _) = (0.1, Vector2::new(0.6, 0.8));
    let out = found(disc(), &bowl([1.0 + 0.36, 0.48, 0.0]), 1.0);
    assert_eq!(out.len(), 1);
    assert_eq!(OnSide::from_number(out[0].id.point()), Some((OnSide::EndAtRounding(1), 0)));
    assert!((out[0].gap - gap).abs() < 1e-15 && (out[0].frame.row(0).transpose() - normal).norm() < 1e-15);
    assert!((out[0].sides[0].point + 0.5 * normal).norm() < 1e-15);
    // Over the surface its end is none of the disc's business, but where it is just past it.
    let over = |x: f64| found(disc(), &bowl([x, 0.5, 0.0]), 1.0).iter().map(|c| c.id.pair()).collect::<Vec<_>>();
    assert_eq!((over(0.9), over(1.0 + 1e-9)), (vec![0], vec![1]));
}

#[test]
fn rounded_blocks_stand_as_high_as_sharp_ones() {
    let square =
        Polygon::new([[-0.2, -0.2], [0.2, -0.2], [0.2, 0.2], [-0.2, 0.2]].map(Vector2::from).to_vec()).unwrap();
    let rounded = Rounded::inside(&square, 0.05).unwrap();
    let at = Bowl { pose: [0.1, 0.2, 0.0], curvature: 0.0 };
    let out = found(rounded.clone().into(), &at, 1e-9);
    assert_eq!(out.iter().map(|c| c.id.point()).collect::<Vec<_>>(), [0, 1]);
    assert!(out.iter().zip([-0.15, 0.15]).all(|(c, x)| (c.sides[0].point - Vector2::new(x, -0.2)).norm() < 1e-15));
    let sharp = found(square.into(), &at, 1e-9);
    assert!(sharp.iter().chain(&out).all(|c| c.gap.abs() < 1e-15));
    let configurations =
        [at, Bowl { pose: [0.3, 0.4, 0.6], curvature: 1.0 }, Bowl { pose: [1.1, 0.7, 0.4], curvature: 1.0 }];
    let configurations: Vec<&dyn Geometry<2>> = configurations.iter().map(|bowl| bowl as &dyn Geometry<2>).collect();
    for shape in [Shape::from(rounded), Disc::new(Vector2::new(0.01, 0.0), 0.2).unwrap().into()] {
        assert_eq!(check(&detector(shape), &configurations), []);
    }
}
