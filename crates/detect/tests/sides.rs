//! Sides of shapes against a surface that bends and ends.
#![allow(clippy::unwrap_used)]

use nalgebra::{Rotation2, Vector2};
use teeter_detect::conformance::check;
use teeter_detect::{
    BodyId, Candidate, Candidates, ContactDetector, DetectorMemory, Geometry, Kinematics, LawId, OnSide, Polygon,
    Rounded, Shape, ShapeDetector, SidePair, Summit, SurfacePoint,
};

/// A body at (x, y, φ) over y = a cos(kx) + s x, from 0 to an end.
struct Wave {
    pose: [f64; 3],
    height: f64,
    number: f64,
    slope: f64,
    end: f64,
}

impl Wave {
    fn at(&self, x: f64) -> SurfacePoint<2> {
        let (sin, cos) = (self.number * x).sin_cos();
        let normal = Vector2::new(self.height * self.number * sin - self.slope, 1.0).normalize();
        let place = Vector2::new(x, self.height * cos + self.slope * x);
        SurfacePoint { place, normal, material: Vector2::new(x, 0.0) }
    }
}

impl Geometry<2> for Wave {
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
        (0.0..=self.end).contains(&at.x).then(|| self.at(at.x))
    }

    /// By bisection of the slope, from a fine search.
    fn summits(
        &self,
        _: BodyId,
        _: Kinematics,
        direction: &Vector2<f64>,
        between: &[Vector2<f64>; 2],
        each: &mut dyn FnMut(Summit<2>),
    ) {
        let (low, high) = (between[0].x.min(between[1].x).max(0.0), between[0].x.max(between[1].x).min(self.end));
        let rises = |x: f64| {
            let normal = self.at(x).normal;
            direction.dot(&Vector2::new(normal.y, -normal.x))
        };
        let n = 1000;
        let x = |k: u32| low + (high - low) * f64::from(k) / f64::from(n);
        for k in 0..n {
            let (mut a, mut b) = (x(k), x(k + 1));
            if rises(a) > 0.0 && rises(b) <= 0.0 {
                for _ in 0..60 {
                    let middle = 0.5 * (a + b);
                    if rises(middle) > 0.0 { a = middle } else { b = middle }
                }
                each(Summit { point: self.at(a), support: None });
            }
        }
    }

    fn ends(&self, _: BodyId, _: Kinematics) -> [Option<SurfacePoint<2>>; 2] {
        [Some(self.at(0.0)), Some(self.at(self.end))]
    }
}

fn base(width: f64) -> Polygon {
    let x = 0.5 * width;
    Polygon::new([[-x, 0.0], [x, 0.0], [x, 1.0], [-x, 1.0]].map(Vector2::from).to_vec()).unwrap()
}

fn detector(shape: Shape) -> ShapeDetector {
    let (body, surface, law) = (BodyId(0), BodyId(1), LawId(0));
    let pair = SidePair { pair: 0, law, body, surface, kinematics: Kinematics::Deformed };
    ShapeDetector::new(vec![(body, shape)], Vec::new()).unwrap().with_sides(vec![pair]).unwrap()
}

fn found(detector: &ShapeDetector, at: &Wave, margin: f64) -> Candidates<2> {
    let mut out = Candidates::new();
    detector.detect(at, margin, &mut DetectorMemory::default(), &mut out);
    out
}

#[test]
fn humps_are_found_between_the_corners_with_the_sides_normal() {
    // Crests of height 0.1 at 0, 2, 4 and 6; the base from 1 to 5, tilted by 2 degrees about (3,
    // 0.2).
    let wave = |pose| Wave { pose, height: 0.1, number: std::f64::consts::PI, slope: 0.0, end: 7.0 };
    let angle = 0.02_f64;
    let at = wave([3.0, 0.2, angle]);
    let out = found(&detector(base(4.0).into()), &at, 1.0);
    let features: Vec<_> = out.iter().map(|contact| OnSide::from_number(contact.id.point()).unwrap()).collect();
    assert_eq!(features, [(OnSide::Summit(0), 0), (OnSide::Summit(1), 0)]);
    for (contact, x) in out.iter().zip([2.0, 4.0]) {
        // The crest along the side's normal is where the surface has its slope.
        let crest = x - (angle.tan() / (0.1 * std::f64::consts::PI)).asin() / std::f64::consts::PI;
        let place = at.at(crest).place;
        let normal = Vector2::new(-angle.sin(), angle.cos());
        let gap = normal.dot(&(Vector2::new(3.0, 0.2) - place));
        assert!((contact.gap - gap).abs() < 1e-12, "{} {gap}", contact.gap);
        assert!((contact.frame.row(0).transpose() - normal).norm() < 1e-15, "from the surface to the body");
        assert!((contact.sides[1].point.x - crest).abs() < 1e-9);
        let foot = Rotation2::new(-angle) * (place + normal * gap - Vector2::new(3.0, 0.2));
        assert!((contact.sides[0].point - foot).norm() < 1e-12 && foot.y.abs() < 1e-12);
    }
}

#[test]
fn what_sags_under_a_base_or_is_straight_has_no_hump() {
    let at = |x: f64, height: f64| Wave { pose: [x, 0.2, 0.0], height, number: 1.0, slope: 0.1, end: 7.0 };
    assert_eq!(found(&detector(base(1.0).into()), &at(3.1, 0.1), 1.0).len(), 0, "a trough is at π");
    assert_eq!(found(&detector(base(1.0).into()), &at(3.1, 0.0), 1.0).len(), 0, "straight");
    assert_eq!(found(&detector(base(1.0).into()), &at(6.3, 1e-10), 1.0), [], "flat to rounding");
    let margin = found(&detector(base(4.0).into()), &Wave { slope: 0.0, ..at(6.3, 0.1) }, 0.05);
    assert_eq!(margin.len(), 0, "a hump that is too far away");
}

#[test]
fn a_surface_that_ends_under_a_base_touches_it_by_its_end() {
    let at = |x: f64| Wave { pose: [x, 0.5, -0.1], height: 0.0, number: 1.0, slope: 0.0, end: 7.0 };
    let block = detector(base(2.0).into());
    let out = found(&block, &at(7.3), 10.0);
    assert_eq!(
        out.iter().map(|c| OnSide::from_number(c.id.point()).unwrap()).collect::<Vec<_>>(),
        [(OnSide::End(1), 0)]
    );
    let (sin, cos) = (-0.1_f64).sin_cos();
    let gap = Vector2::new(-sin, cos).dot(&Vector2::new(0.3, 0.5));
    assert!((out[0].gap - gap).abs() < 1e-15);
    assert!(found(&block, &at(8.2), 10.0).is_empty() && found(&block, &at(5.5), 10.0).is_empty(), "past it, on it");
    // Rounded, the side is as much lower.
    let rounded = detector(Rounded::inside(&base(2.0), 0.2).unwrap().into());
    let out = found(&rounded, &at(7.3), 10.0);
    let at_side =
        |contact: &&Candidate<2>| matches!(OnSide::from_number(contact.id.point()), Some((OnSide::End(1), 0)));
    let contact = out.iter().find(at_side).unwrap();
    assert!((contact.gap - gap).abs() < 1e-15, "{}", contact.gap - gap);
    assert!((contact.sides[0].point.y).abs() < 1e-15);
}

#[test]
fn sides_keep_the_contract() {
    let wave = |pose| Wave { pose, height: 0.1, number: 3.0, slope: 0.05, end: 7.0 };
    let poses = [wave([3.0, 0.2, 0.02]), wave([6.5, 0.6, -0.1]), wave([3.0, 0.25, 0.3]), wave([0.1, 0.1, 0.05])];
    let poses: Vec<&dyn Geometry<2>> = poses.iter().map(|pose| pose as &dyn Geometry<2>).collect();
    for shape in [Shape::from(base(4.0)), Rounded::inside(&base(3.0), 0.2).unwrap().into()] {
        assert_eq!(check(&detector(shape), &poses), []);
    }
}
