//! How far the axis of a deflected beam reaches, between its nodes too.

use crate::beam::Beam;

/// What deflection and slope of a beam reach, made by [`Beam::deflection_extremes`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct DeflectionExtremes {
    /// Least w, m.
    pub lowest: f64,
    /// Largest w, m.
    pub highest: f64,
    /// Largest |w'|, rad.
    pub steepest: f64,
}

impl DeflectionExtremes {
    /// The largest |w|, m.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.highest.max(-self.lowest)
    }
}

impl Beam {
    /// The extremes of w and w' along the whole beam for the dofs `q`. In an element w is a cubic,
    /// which may rise above both of its nodes: its extremes are at the nodes and where the
    /// quadratic w' is 0, and those of w' at the nodes and where w'' is 0. Exact but for rounding;
    /// [`Beam::deflection_bounds`] is a cheaper bound.
    ///
    /// # Panics
    /// If `q` has not [`Beam::dofs`] entries.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Section};
    /// // One element between pins, which has slopes alone.
    /// let beam = Beam::new(BeamSpec::new(1.0, 1, Section::new(1.0, 1.0)?))?;
    /// let extremes = beam.deflection_extremes(&beam.from_nodes(&[[0.0, 0.4], [0.0, -0.4]])?);
    /// assert_eq!((extremes.lowest, extremes.highest, extremes.steepest), (0.0, 0.1, 0.4));
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    #[must_use]
    pub fn deflection_extremes(&self, q: &[f64]) -> DeflectionExtremes {
        assert_eq!(q.len(), self.dofs(), "a vector must have one entry per degree of freedom");
        let mut extremes = DeflectionExtremes { lowest: f64::INFINITY, highest: f64::NEG_INFINITY, steepest: 0.0 };
        let nodes = self.bend(q);
        for (element, ends) in self.elements.iter().zip(nodes.windows(2)) {
            let of = [ends[0][0], ends[0][1], ends[1][0], ends[1][1]];
            let sum = |n: [f64; 4]| -> f64 { n.iter().zip(&of).map(|(n, q)| n * q).sum() };
            let slope = |xi: f64| sum(element.shape_slope(xi));
            // w' = a + b ξ + c ξ².
            let [a, middle, end] = [0.0, 0.5, 1.0].map(slope);
            let c = 2.0 * (a - 2.0 * middle + end);
            let b = end - a - c;
            let mut take = |xi: f64| {
                let w = sum(element.shape(xi));
                extremes.lowest = extremes.lowest.min(w);
                extremes.highest = extremes.highest.max(w);
                extremes.steepest = extremes.steepest.max(slope(xi).abs());
            };
            // The roots by the formula that doesn't cancel; what is not a number is no place in the
            // element.
            let half = -0.5 * (b + (b * b - 4.0 * a * c).sqrt().copysign(b));
            let places = [0.0, 1.0, half / c, a / half, -0.5 * b / c];
            places.into_iter().filter(|xi| (0.0..=1.0).contains(xi)).for_each(&mut take);
        }
        extremes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BeamSpec, Section};

    /// Against many places, of meshes with elements of several lengths, with and without shear.
    #[test]
    fn no_place_is_beyond_the_extremes_and_some_place_is_at_each() {
        let section = Section::new(3.0, 5.0).unwrap();
        for section in [section, section.with_shear(20.0, 0.4).unwrap()] {
            for nodes in [vec![0.0, 2.0], vec![0.0, 0.3, 2.0], vec![0.0, 0.5, 0.6, 1.7, 2.0]] {
                let free = [crate::Support::Free; 2];
                let beam = Beam::new(BeamSpec::new(2.0, 1, section).supported(free).meshed(nodes.clone())).unwrap();
                for draw in 0..200 {
                    let value =
                        |i: usize| (12.9 * f64::from(draw) + 78.2 * i as f64).sin() * (1.0 - (draw % 3) as f64 * 0.5);
                    let q: Vec<f64> = (0..beam.dofs()).map(value).collect();
                    let found = beam.deflection_extremes(&q);
                    let at = |k: usize| beam.deflection_at(&q, 2.0 * k as f64 / 4000.0).unwrap();
                    let (mut low, mut high, mut steep) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64);
                    for d in (0..=4000).map(at) {
                        (low, high, steep) = (low.min(d.w), high.max(d.w), steep.max(d.slope.abs()));
                    }
                    assert!(found.lowest <= low + 1e-14 && found.highest >= high - 1e-14, "{nodes:?} {draw}");
                    assert!(found.steepest >= steep - 1e-13, "{nodes:?} {draw}");
                    // A place is within 0.25 mm of each; w'' is at most some 1e3 in the shortest
                    // element.
                    assert!(found.lowest > low - 1e-4 && found.highest < high + 1e-4, "{nodes:?} {draw}");
                    assert!(found.steepest < steep + 1e-2, "{nodes:?} {draw}");
                    assert!(beam.deflection_bounds(&q).highest >= found.highest);
                    assert_eq!(found.largest(), found.highest.max(-found.lowest));
                }
            }
        }
    }

    #[test]
    fn straight_shapes_have_their_ends_as_extremes() {
        let free = [crate::Support::Free; 2];
        let beam = Beam::new(BeamSpec::new(1.0, 4, Section::new(1.0, 1.0).unwrap()).supported(free)).unwrap();
        let at = |w: f64, slope: f64| {
            let nodes: Vec<[f64; 2]> = beam.node_positions().iter().map(|x| [w + slope * x, slope]).collect();
            beam.deflection_extremes(&beam.from_nodes(&nodes).unwrap())
        };
        assert_eq!(at(0.0, 0.0), DeflectionExtremes::default());
        assert_eq!(at(-0.5, 0.0), DeflectionExtremes { lowest: -0.5, highest: -0.5, steepest: 0.0 });
        let tilted = at(0.25, 0.5);
        assert!(
            (tilted.highest - 0.75).abs() < 1e-15 && tilted.lowest == 0.25 && (tilted.steepest - 0.5).abs() < 1e-15
        );
    }
}
