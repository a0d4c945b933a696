//! The extremes of what a beam bore, over its nodes.

use crate::beam::Beam;
use crate::forces::{SectionForce, SectionForces};

/// The least and the largest of what a beam bore and how far it went, over its nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Envelope {
    /// By nodes: least and largest deflection, m.
    pub deflection: Vec<[f64; 2]>,
    /// By nodes: least and largest bending moment on either side, N m.
    pub moment: Vec<[f64; 2]>,
    /// By nodes: least and largest transverse force on either side, N.
    pub shear: Vec<[f64; 2]>,
    /// By nodes: largest normal stress, Pa; NaN where the section doesn't know its modulus.
    pub stress: Vec<f64>,
}

impl Envelope {
    /// Of nothing yet.
    #[must_use]
    pub fn new(beam: &Beam) -> Self {
        let none = vec![[f64::INFINITY, f64::NEG_INFINITY]; beam.nodes()];
        Self { deflection: none.clone(), moment: none.clone(), shear: none, stress: vec![f64::NAN; beam.nodes()] }
    }

    /// Takes a state in.
    ///
    /// # Panics
    /// If `q` has not [`Beam::dofs`] entries, or `forces` are those of a beam with fewer elements.
    pub fn take(&mut self, beam: &Beam, q: &[f64], forces: &SectionForces) {
        let widen = |range: &mut [f64; 2], value: f64| *range = [range[0].min(value), range[1].max(value)];
        for (range, [w, _]) in self.deflection.iter_mut().zip(beam.bend(q)) {
            widen(range, *w);
        }
        for e in 0..beam.elements() {
            let middle = beam.mesh.middle(e);
            for (side, SectionForce { moment, shear }) in forces.ends(e).into_iter().enumerate() {
                widen(&mut self.moment[e + side], moment);
                widen(&mut self.shear[e + side], shear);
                if let Some(stress) = forces.stress(beam, middle, moment) {
                    self.stress[e + side] = self.stress[e + side].max(stress);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Support::Pinned;
    use crate::beam::tests::spec;
    use crate::{Actions, SpanLoad};

    #[test]
    fn an_envelope_holds_the_extremes_on_either_side() {
        let spec =
            crate::BeamSpec { section: crate::Section::rectangle(0.1, 0.1, 1e9, 1e3).unwrap(), ..spec(4, [Pinned; 2]) };
        let beam = Beam::new(spec).unwrap();
        let mut envelope = Envelope::new(&beam);
        for x in [0.25, 0.5, 0.75] {
            let mut q = vec![0.0; beam.dofs()];
            beam.add_point_load(x, -8.0, &mut q).unwrap();
            beam.solve_static(&mut q).unwrap();
            let loads = [SpanLoad::Point { x, force: -8.0, couple: 0.0 }];
            envelope.take(&beam, &q, &beam.section_forces(&Actions::at(&q).with_loads(&loads)).unwrap());
        }
        let close = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(close(envelope.moment[2][1], 2.0) && close(envelope.moment[1][1], 1.5));
        assert!(
            close(envelope.shear[0][1], 6.0) && close(envelope.shear[2][0], -4.0) && close(envelope.shear[2][1], 4.0)
        );
        assert!((envelope.stress[2] / (6.0 * 2.0 / 1e-3) - 1.0).abs() < 1e-12);
    }
}
