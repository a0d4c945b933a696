//! Detectors run through the harness, and what is wrong with a detector is found by it.

use nalgebra::Vector2;
use teeter_detect::conformance::{Property, check};
use teeter_detect::{
    BodyId, Candidates, ContactDetector, ContactId, DetectorMemory, Geometry, HalfSpace, Kinematics, LawId,
    PointDetector, PointPair, SurfacePoint, Wiring,
};

/// Two bodies, 0 and 1, at heights and tilts, above a slope, body 2.
struct Scene([(f64, f64); 2]);

fn turned(angle: f64, x: &Vector2<f64>) -> Vector2<f64> {
    let (sin, cos) = angle.sin_cos();
    Vector2::new(cos * x.x - sin * x.y, sin * x.x + cos * x.y)
}

/// The normal of the slope.
fn upwards() -> Vector2<f64> {
    turned(0.2, &Vector2::y())
}

impl Geometry<2> for Scene {
    fn place(&self, body: BodyId, local: &[Vector2<f64>], out: &mut [Vector2<f64>]) {
        let pose = self.0.get(body.0 as usize);
        for (x, local) in out.iter_mut().zip(local) {
            *x = pose.map_or(*local, |(height, tilt)| Vector2::new(f64::from(body.0), *height) + turned(*tilt, local));
        }
    }

    fn surface(&self, _: BodyId, _: Kinematics, at: &Vector2<f64>) -> Option<SurfacePoint<2>> {
        let normal = upwards();
        let foot = at - normal * normal.dot(at);
        Some(SurfacePoint { place: foot, normal, material: foot })
    }

    fn reach(&self, _: BodyId, margin: f64) -> Option<HalfSpace<2>> {
        Some(HalfSpace { normal: upwards(), offset: margin })
    }
}

const SCENES: [Scene; 4] = [
    Scene([(1.0, 0.1), (1.5, 0.0)]),
    Scene([(0.2, 0.3), (0.6, -0.4)]),
    Scene([(0.05, 0.5), (0.3, 0.2)]),
    Scene([(0.1, -0.4), (0.9, 1.0)]),
];

fn points() -> PointDetector<2> {
    let corners = vec![Vector2::new(-0.2, -0.1), Vector2::new(0.2, -0.1), Vector2::new(0.2, 0.1)];
    let pair = |pair, body, points| PointPair {
        pair,
        law: LawId(pair),
        points,
        body: BodyId(body),
        surface: BodyId(2),
        kinematics: Kinematics::Deformed,
    };
    PointDetector::new(vec![pair(0, 0, corners.clone()), pair(1, 1, corners)])
}

fn failing(detector: &dyn ContactDetector<2>) -> Vec<Property> {
    let scenes = SCENES.each_ref().map(|scene| scene as &dyn Geometry<2>);
    check(detector, &scenes).iter().map(|failure| failure.property).collect()
}

#[test]
fn points_against_surfaces_conform() {
    let (detector, scenes) = (points(), SCENES.each_ref().map(|scene| scene as &dyn Geometry<2>));
    assert_eq!(check(&detector, &scenes), []);
    // Some touch and some don't.
    let found = |scene: &Scene, margin: f64| {
        let mut out = Candidates::new();
        detector.detect(scene, margin, &mut DetectorMemory::default(), &mut out);
        out.len()
    };
    assert_eq!(SCENES.each_ref().map(|scene| found(scene, 0.0)), [0, 0, 3, 1]);
    assert_eq!(SCENES.each_ref().map(|scene| found(scene, f64::INFINITY)), [6; 4]);
}

/// The same with one thing wrong.
struct Wrong(Property, PointDetector<2>);

impl ContactDetector<2> for Wrong {
    fn detect(&self, at: &dyn Geometry<2>, margin: f64, memory: &mut DetectorMemory, out: &mut Candidates<2>) {
        let mut found = Candidates::new();
        let wider = if self.0 == Property::Margin { 1.1 * margin } else { margin };
        self.1.detect(at, wider, &mut DetectorMemory::default(), &mut found);
        let calls = memory.of(|| 0);
        *calls += 1;
        match self.0 {
            Property::Found => found.clear(),
            Property::Memory if *calls > 3 => drop(found.pop()),
            Property::Order if margin == 0.0 => found.reverse(),
            Property::Identities => found.iter_mut().for_each(|candidate| candidate.id = ContactId::new(0, 0)),
            Property::Frame => found.iter_mut().for_each(|candidate| candidate.frame.row_mut(1).neg_mut()),
            Property::Gap => found.iter_mut().for_each(|candidate| candidate.sides[1].point += 1e-9 * upwards()),
            _ => {}
        }
        if self.0 != Property::Cleared {
            out.clear();
        }
        out.append(&mut found);
    }

    fn deepest(&self, at: &dyn Geometry<2>, memory: &mut DetectorMemory, scratch: &mut Candidates<2>) -> f64 {
        let deepest = self.1.deepest(at, memory, scratch);
        match self.0 {
            Property::Deepest => 0.5 * deepest,
            Property::Found => 0.0,
            _ => deepest,
        }
    }

    fn locate(&self, at: &dyn Geometry<2>, ids: &[ContactId], out: &mut Candidates<2>) {
        self.detect(at, f64::INFINITY, &mut DetectorMemory::default(), out);
        out.retain(|candidate| ids.contains(&candidate.id));
        if self.0 == Property::Locate {
            out.reverse();
        }
    }

    fn wiring(&self) -> Vec<Wiring> {
        let mut wiring = self.1.wiring();
        if self.0 == Property::Wiring {
            wiring[1].on_surface = false;
            wiring[0].bodies[0] = BodyId(1);
        }
        if self.0 == Property::Identities { Vec::new() } else { wiring }
    }

    fn capacity(&self) -> usize {
        self.1.capacity() - usize::from(self.0 == Property::Capacity)
    }
}

#[test]
fn the_harness_names_what_is_wrong() {
    use Property::*;
    for wrong in [Found, Cleared, Memory, Margin, Order, Identities, Frame, Gap, Locate, Deepest, Capacity, Wiring] {
        let mut found = failing(&Wrong(wrong, points()));
        found.dedup();
        assert!(found.contains(&wrong), "{wrong:?}: {found:?}");
        // Nothing else follows from one fault, but that detecting into the same list again shows
        // what was left in it.
        let others: Vec<&Property> = found.iter().filter(|other| **other != wrong).collect();
        assert_eq!(others, if wrong == Cleared { vec![&Memory] } else { vec![] }, "{wrong:?}");
    }
}

#[test]
fn gaps_of_what_cannot_be_placed_are_not_compared() {
    struct Unplaced(Scene);
    impl Geometry<2> for Unplaced {
        fn place(&self, body: BodyId, local: &[Vector2<f64>], out: &mut [Vector2<f64>]) {
            if body != BodyId(2) {
                self.0.place(body, local, out);
            }
        }

        fn surface(&self, body: BodyId, kinematics: Kinematics, at: &Vector2<f64>) -> Option<SurfacePoint<2>> {
            let mut foot = self.0.surface(body, kinematics, at)?;
            foot.material += Vector2::x();
            Some(foot)
        }
    }
    let scene = Unplaced(Scene([(0.05, 0.5), (0.3, 0.2)]));
    assert_eq!(check(&points(), &[&scene]), []);
}
