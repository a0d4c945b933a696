//! Discs against a surface: where a disc touches moves around it as it rolls, so that a contact is named by its disc.

use nalgebra::Vector2;
use teeter_detect::{
    Anchor, BodyId, Candidate, Candidates, ContactDetector, ContactId, DetectorMemory, Geometry, Kinematics, LawId,
    Wiring, plane_frame,
};

pub struct Disc {
    pub body: BodyId,
    /// In the body's own coordinates, m.
    pub centre: Vector2<f64>,
    pub radius: f64,
}

/// Each disc and the surface are a pair; all obey one law.
pub struct Discs {
    pub discs: Vec<Disc>,
    pub surface: BodyId,
    pub law: LawId,
}

impl Discs {
    fn candidate(&self, k: usize, at: &dyn Geometry<2>) -> Option<Candidate<2>> {
        let Disc { body, centre, radius } = self.discs[k];
        let mut places = [Vector2::zeros(); 2];
        at.place(body, &[centre, centre + Vector2::x()], &mut places);
        let foot = at.surface(self.surface, Kinematics::Deformed, &places[0])?;
        let gap = foot.normal.dot(&(places[0] - foot.place)) - radius;
        // The lowest point as seen from the surface, turned back into the body's coordinates.
        let (x, down) = (places[1] - places[0], -radius * foot.normal);
        let point = centre + Vector2::new(x.dot(&down), x.perp(&down));
        let sides = [Anchor { body, point }, Anchor { body: self.surface, point: foot.material }];
        Some(Candidate { id: ContactId::new(k as u32, 0), law: self.law, sides, frame: plane_frame(&foot.normal), gap })
    }
}

impl ContactDetector<2> for Discs {
    fn detect(&self, at: &dyn Geometry<2>, margin: f64, _: &mut DetectorMemory, out: &mut Candidates<2>) {
        out.clear();
        let all = (0..self.discs.len()).filter_map(|k| self.candidate(k, at));
        out.extend(all.filter(|candidate| candidate.gap <= margin));
    }

    fn wiring(&self) -> Vec<Wiring> {
        let (law, on_surface, contacts) = (self.law, true, 1);
        let wire = |(pair, disc): (u32, &Disc)| {
            let not_finite = Some(0).filter(|_| !(disc.centre.sum() + disc.radius).is_finite());
            Wiring { pair, law, bodies: [disc.body, self.surface], on_surface, contacts, not_finite }
        };
        (0..).zip(&self.discs).map(wire).collect()
    }

    fn capacity(&self) -> usize {
        self.discs.len()
    }
}
