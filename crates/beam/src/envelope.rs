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
    /// By elements: least and largest bending moment just right of the left node and just left of the
    /// right one, N m. Where a couple acts at a node, the two sides of it differ.
    pub moment_ends: Vec<[[f64; 2]; 2]>,
    /// By elements, alike: least and largest transverse force, N. At a support or a load the two sides
    /// of a node differ by what it brings in, which [`shear`](Self::shear) has no room for.
    pub shear_ends: Vec<[[f64; 2]; 2]>,
    /// By nodes: largest normal stress, Pa; NaN where the section doesn't know its modulus.
    pub stress: Vec<f64>,
    /// Between the nodes, where something acts whose place is known, from left to right.
    pub places: Vec<EnvelopePlace>,
}

/// The extremes at a place between the nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnvelopePlace {
    /// Where, m from the left end.
    pub x: f64,
    /// Least and largest deflection, m.
    pub deflection: [f64; 2],
    /// Least and largest bending moment just left of it and just right of it, N m.
    pub moment: [[f64; 2]; 2],
    /// Alike: least and largest transverse force, N.
    pub shear: [[f64; 2]; 2],
    /// Largest normal stress, Pa; NaN where the section doesn't know its modulus.
    pub stress: f64,
}

const NONE: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

fn widen(range: &mut [f64; 2], value: f64) {
    *range = [range[0].min(value), range[1].max(value)];
}

impl Envelope {
    /// Of nothing yet.
    #[must_use]
    pub fn new(beam: &Beam) -> Self {
        let by_nodes = vec![NONE; beam.nodes()];
        let by_ends = vec![[NONE; 2]; beam.elements()];
        Self {
            deflection: by_nodes.clone(),
            moment: by_nodes.clone(),
            shear: by_nodes,
            moment_ends: by_ends.clone(),
            shear_ends: by_ends,
            stress: vec![f64::NAN; beam.nodes()],
            places: Vec::new(),
        }
    }

    /// With these places (m from the left end) between the nodes, such as those of loads that stay where they are: there the
    /// forces jump, which straight lines from node to node would blur. What is at a node, or beyond the ends, is left out.
    #[must_use]
    pub fn with_places(mut self, beam: &Beam, places: impl IntoIterator<Item = f64>) -> Self {
        let span = beam.spec().span;
        let mut places: Vec<f64> = places.into_iter().filter(|x| (0.0..=span).contains(x)).collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        places.retain(|x| beam.mesh.node(*x).is_none());
        let none = |x| EnvelopePlace { x, deflection: NONE, moment: [NONE; 2], shear: [NONE; 2], stress: f64::NAN };
        self.places = places.into_iter().map(none).collect();
        self
    }

    /// Takes a state in.
    ///
    /// # Panics
    /// If `q` has not [`Beam::dofs`] entries, or `forces` are those of a beam with fewer elements.
    pub fn take(&mut self, beam: &Beam, q: &[f64], forces: &SectionForces) {
        for (range, [w, _]) in self.deflection.iter_mut().zip(beam.bend(q)) {
            widen(range, *w);
        }
        for e in 0..beam.elements() {
            let middle = beam.mesh.middle(e);
            for (side, SectionForce { moment, shear }) in forces.ends(e).into_iter().enumerate() {
                widen(&mut self.moment[e + side], moment);
                widen(&mut self.shear[e + side], shear);
                widen(&mut self.moment_ends[e][side], moment);
                widen(&mut self.shear_ends[e][side], shear);
                if let Some(stress) = forces.stress(beam, middle, moment) {
                    self.stress[e + side] = self.stress[e + side].max(stress);
                }
            }
        }
        for place in &mut self.places {
            // Places lie within the span.
            let Ok(sides) = forces.sides(beam, place.x) else { continue };
            widen(&mut place.deflection, beam.shape_clamped(place.x).deflection(q).w);
            for (side, SectionForce { moment, shear }) in sides.into_iter().enumerate() {
                widen(&mut place.moment[side], moment);
                widen(&mut place.shear[side], shear);
                if let Some(stress) = forces.stress(beam, place.x, moment) {
                    place.stress = place.stress.max(stress);
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
        // Each end of an element on its own: the load beside the first element leaves its shear at 6 or less.
        assert!(close(envelope.shear_ends[0][1][1], 6.0) && close(envelope.shear_ends[1][0][0], -2.0));
        assert!(close(envelope.moment_ends[1][1][1], envelope.moment_ends[2][0][1]));
        assert!((envelope.stress[2] / (6.0 * 2.0 / 1e-3) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn at_a_load_between_nodes_the_shear_jumps_by_it() {
        let beam = Beam::new(spec(4, [Pinned; 2])).unwrap();
        let span = beam.spec().span;
        let x = 0.3 * span;
        let load = SpanLoad::Point { x, force: -10.0, couple: 0.5 };
        let mut q = vec![0.0; beam.dofs()];
        beam.add_point_load(x, -10.0, &mut q).unwrap();
        beam.add_point_couple(x, 0.5, &mut q).unwrap();
        beam.solve_static(&mut q).unwrap();
        let forces = beam.section_forces(&Actions::at(&q).with_loads(&[load])).unwrap();
        // One of the places is a node, another off the beam.
        let mut envelope = Envelope::new(&beam).with_places(&beam, [0.5 * span, x, -1.0]);
        envelope.take(&beam, &q, &forces);
        assert_eq!(envelope.places.len(), 1);
        let place = envelope.places[0];
        // Moments about the right end: −R L + 10 · 0.7 L + 0.5 = 0.
        let left = 0.7 * 10.0 + 0.5 / span;
        let close = |found: [f64; 2], wanted: f64| found.iter().all(|x| (x - wanted).abs() < 1e-9);
        assert!(close(place.shear[0], left) && close(place.shear[1], left - 10.0), "{place:?}");
        assert!(close(place.moment[0], left * x) && close(place.moment[1], left * x - 0.5), "{place:?}");
        assert_eq!(place.shear[1][0], forces.at(&beam, x).unwrap().shear);
    }

    #[test]
    fn at_a_pier_the_shear_jumps_by_its_reaction() {
        let mut spec =
            crate::BeamSpec { section: crate::Section::rectangle(0.1, 0.1, 1e9, 1e3).unwrap(), ..spec(4, [Pinned; 2]) };
        spec.inner_supports = vec![crate::InnerSupport { x: 0.5 * spec.span, support: Pinned }];
        let beam = Beam::new(spec).unwrap();
        let load = SpanLoad::Uniform { from: 0.0, to: beam.spec().span, load: -8.0 };
        let mut q = vec![0.0; beam.dofs()];
        beam.add_uniform_load(-8.0, &mut q).unwrap();
        beam.solve_static(&mut q).unwrap();
        let forces = beam.section_forces(&Actions::at(&q).with_loads(&[load])).unwrap();
        let mut envelope = Envelope::new(&beam);
        envelope.take(&beam, &q, &forces);
        // Two spans under a uniform load f: the pier bears 5/8 of all of it, half from each side.
        let (left, right) = (envelope.shear_ends[1][1][1], envelope.shear_ends[2][0][0]);
        let part = 8.0 * beam.spec().span * 5.0 / 16.0;
        assert!((left + part).abs() < 1e-9 && (right - part).abs() < 1e-9, "{left} {right} {part}");
        assert!((forces.reactions()[1].force - (right - left)).abs() < 1e-9);
    }
}
