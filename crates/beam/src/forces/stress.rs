//! The normal stress that bending moment and axial force make.

use super::SectionForces;
use crate::beam::Beam;

/// A normal stress with its place, from [`SectionForces::largest_stress`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct PeakStress {
    /// Where, m.
    pub x: f64,
    /// |M|/(I/c) + |N|/A, Pa.
    pub stress: f64,
}

impl SectionForces {
    /// The largest normal stress over the nodes and the places of point loads, on either side of
    /// each. `None` where no section has a modulus.
    #[must_use]
    pub fn largest_stress(&self, beam: &Beam) -> Option<PeakStress> {
        self.largest_stress_beside(beam, None)
    }

    /// The same where the bending moments of `other`, such as those of a load that is left out of these, come on top. It is looked at
    /// at the same places: the point loads of `other` inside the elements are none of them unless they are loads of these, too, and
    /// a maximum that a distributed load, such as the beam's own weight, has between two of these places is missed.
    #[must_use]
    pub fn largest_stress_beside(&self, beam: &Beam, other: Option<&Self>) -> Option<PeakStress> {
        let mut largest: Option<PeakStress> = None;
        let mut see = |e: usize, x: f64, moment: f64| {
            if let Some(stress) = self.stress_in(beam, e, moment)
                && largest.is_none_or(|largest| stress > largest.stress)
            {
                largest = Some(PeakStress { x, stress });
            }
        };
        for e in 0..beam.elements() {
            let others = other.map_or([0.0; 2], |other| other.ends(e).map(|end| end.moment));
            let [left, right] = self.ends(e);
            see(e, beam.mesh.x[e], left.moment + others[0]);
            see(e, beam.mesh.x[e + 1], right.moment + others[1]);
        }
        for &(e, xi, _, couple) in &self.inside {
            let moment = self.moment_in(beam, e, xi) + other.map_or(0.0, |other| other.moment_in(beam, e, xi));
            let x = beam.mesh.x[e] + xi * beam.elements[e].length;
            // Left of a couple it has not come on yet.
            see(e, x, moment);
            see(e, x, moment + couple);
        }
        largest
    }

    /// Largest normal stress |M|/(I/c) + |N|/A at a place with this bending moment, Pa; `None`
    /// where the section has no modulus.
    #[must_use]
    pub fn stress(&self, beam: &Beam, x: f64, moment: f64) -> Option<f64> {
        let (e, _) = beam.mesh.locate(x.clamp(0.0, beam.spec.span));
        self.stress_in(beam, e, moment)
    }

    fn stress_in(&self, beam: &Beam, e: usize, moment: f64) -> Option<f64> {
        let section = &beam.elements[e].section;
        let axial = self.axial.get(e).copied().unwrap_or(0.0).abs();
        let pulled = section.area.map_or(0.0, |area| axial / area);
        section.section_modulus.map(|modulus| moment.abs() / modulus + pulled)
    }
}
