//! The deflection of a beam at a place, cheap enough for every step.

use teeter_beam::ShapeAt;
use teeter_scenario::simulation::BeamPlace;

/// How the own coordinates of a beam move one of its places: what [`BeamPlace::deflection`] finds
/// there, to the same bytes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Probe {
    /// By the dofs of its element.
    Nodes(ShapeAt),
    /// By all of its modes: the deflection per unit of each.
    Modes(Vec<f64>),
}

impl Probe {
    /// At a place of a beam.
    pub(crate) fn new(place: &BeamPlace, at: ShapeAt) -> Self {
        match &place.basis {
            None => Self::Nodes(at),
            Some(basis) => Self::Modes((0..basis.len()).map(|index| at.deflection(basis.shape(index)).w).collect()),
        }
    }

    /// The deflection for the beam's own coordinates, m; its rate for their velocities, m/s.
    #[inline]
    pub(crate) fn deflection(&self, q: &[f64]) -> f64 {
        let mut sum = 0.0;
        match self {
            Self::Nodes(at) => {
                for (&column, n) in at.columns.iter().zip(&at.n).take(at.len) {
                    sum += n * q[column];
                }
            }
            Self::Modes(shape) => {
                for (q, shape) in q.iter().zip(shape) {
                    sum += q * shape;
                }
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_scenario::simulation::Simulation;

    const SCENE: &str = r#"
        time = { end = "0.01 s", step = "1 ms" }
        material.steel = { density = "7850 kg/m^3", youngs_modulus = "210 GPa" }
        beam.table = { material = "steel", span = "1 m", width = "5 cm", thickness = "5 mm", elements = 12, supports = ["clamped", "pinned"] }
    "#;

    #[test]
    fn a_place_has_the_deflection_that_the_layout_finds_there() {
        for modes in [vec![], vec![("beam.table.model", "modes"), ("beam.table.modes.count", "7")]] {
            let sets: Vec<_> = modes.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
            let resolved = teeter_scenario::load(SCENE.as_bytes(), "beam.toml", "beam", &sets).unwrap();
            let simulation = Simulation::new(&resolved.scene).unwrap();
            let place = &simulation.layout.beams[0];
            let q: Vec<f64> = place.range.clone().map(|k| (1.0 + k as f64).sin() / 7.0).collect();
            for x in [0.0, 0.3, 0.5, 0.77, 1.0] {
                let at = place.beam.shape_clamped(x);
                let w = Probe::new(place, at).deflection(&q);
                assert_eq!(w.to_bits(), place.deflection(&at, &q).w.to_bits(), "{x} {modes:?}");
            }
        }
    }
}
