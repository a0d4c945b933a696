//! Where the nodes are.

use crate::error::BeamError;
use crate::spec::{BeamSpec, MAX_ELEMENTS};

/// Places along a beam that are no further apart than this part of its span are the same, such as
/// that of a support and of a node: nine digits, so that 0.1 + 0.2 is 0.3.
pub const SAME_PLACE: f64 = 1e-9;

/// The shortest element, as a part of the span.
pub(crate) const SHORTEST: f64 = 1e-6;

/// The nodes of a beam.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Mesh {
    /// Their places, rising, m.
    pub(crate) x: Vec<f64>,
    /// n/L: on a uniform mesh x times this is the number of the element.
    elements_per_length: f64,
    uniform: bool,
    /// Lengths of the shortest and the longest element, m.
    pub(crate) lengths: [f64; 2],
}

impl Mesh {
    pub(crate) fn new(spec: &BeamSpec) -> Result<Self, BeamError> {
        let (span, n) = (spec.span, spec.elements);
        let uniform = |n: usize| (0..=n).map(move |i| span * (i as f64 / n as f64));
        let mut x: Vec<f64> = if spec.nodes.is_empty() { uniform(n).collect() } else { spec.nodes.clone() };
        let missing: Vec<f64> = breaks(spec).into_iter().filter(|&place| node_at(&x, span, place).is_none()).collect();
        let uniform = missing.is_empty() && spec.nodes.is_empty();
        if !missing.is_empty() && spec.nodes.is_empty() {
            x = divided(spec);
        } else {
            for place in missing {
                // Two breaks may be nearer to each other than a place can tell.
                if node_at(&x, span, place).is_none() {
                    x.insert(x.partition_point(|node| *node < place), place);
                }
            }
        }
        // A quotient of a million between span and element leaves the matrices no digits.
        if let Some(pair) = x.windows(2).find(|pair| pair[1] - pair[0] < SHORTEST * span) {
            let rule = "at least a millionth of the span from the next node, of supports, lumps and ends of parts";
            return Err(BeamError::Value { field: "place", value: pair[1], rule });
        }
        let elements = x.len() - 1;
        if elements > MAX_ELEMENTS {
            let rule = "few enough to stay at 10000 with the nodes that supports, lumps and segments need";
            return Err(BeamError::Count { field: "elements", value: elements, rule });
        }
        let mut mesh = Self { x, elements_per_length: elements as f64 / span, uniform, lengths: [0.0; 2] };
        let lengths = (0..elements).map(|element| mesh.length(element));
        mesh.lengths = lengths.fold([f64::INFINITY, 0.0], |[least, most], l| [l.min(least), l.max(most)]);
        Ok(mesh)
    }

    pub(crate) fn elements(&self) -> usize {
        self.x.len() - 1
    }

    pub(crate) fn span(&self) -> f64 {
        self.x[self.x.len() - 1]
    }

    /// The middle of an element, m.
    pub(crate) fn middle(&self, element: usize) -> f64 {
        0.5 * (self.x[element] + self.x[element + 1])
    }

    /// Length of an element, m.
    pub(crate) fn length(&self, element: usize) -> f64 {
        // Of a uniform mesh all the same, not differences of rounded places.
        if self.uniform { self.span() / self.elements() as f64 } else { self.x[element + 1] - self.x[element] }
    }

    /// The node at a place that was taken for one.
    pub(crate) fn node(&self, place: f64) -> Option<usize> {
        node_at(&self.x, self.span(), place)
    }

    /// The element that holds x, which is in [0, span], and where in it: ξ in [0, 1].
    #[inline]
    pub(crate) fn locate(&self, x: f64) -> (usize, f64) {
        let last = self.elements() - 1;
        if self.uniform {
            let position = x * self.elements_per_length;
            let element = (position as usize).min(last);
            // x/l of the far end may round to a little above the last node.
            return (element, (position - element as f64).min(1.0));
        }
        let element = self.x.partition_point(|node| *node <= x).saturating_sub(1).min(last);
        (element, ((x - self.x[element]) / self.length(element)).min(1.0))
    }
}

/// Where something changes or acts at a point: nodes must be there.
fn breaks(spec: &BeamSpec) -> Vec<f64> {
    let mut places: Vec<f64> = spec.inner_supports.iter().map(|inner| inner.x).collect();
    places.extend(spec.lumps.iter().map(|lump| lump.x));
    places.extend(spec.segments.iter().flat_map(|segment| [segment.from, segment.to]));
    places.extend(spec.foundations.iter().flat_map(|foundation| [foundation.from, foundation.to]));
    places.sort_unstable_by(f64::total_cmp);
    places
}

/// The parts between breaks each divided evenly, into their share of the elements and at least one.
fn divided(spec: &BeamSpec) -> Vec<f64> {
    let span = spec.span;
    let mut ends = vec![0.0];
    for place in breaks(spec).into_iter().chain([span]) {
        if place - ends[ends.len() - 1] > SAME_PLACE * span {
            // The last end is the span itself.
            ends.push(if span - place <= SAME_PLACE * span { span } else { place });
        }
    }
    let mut x = vec![0.0];
    for pair in ends.windows(2) {
        let share = spec.elements as f64 * (pair[1] - pair[0]) / span;
        // A share of 10 that rounding made 10.000000001 is ten.
        let parts = ((share - SAME_PLACE * spec.elements as f64).ceil() as usize).max(1);
        x.extend((1..parts).map(|k| pair[0] + (pair[1] - pair[0]) * (k as f64 / parts as f64)));
        x.push(pair[1]);
    }
    x
}

fn node_at(x: &[f64], span: f64, place: f64) -> Option<usize> {
    let above = x.partition_point(|node| *node < place);
    let near = |node: &usize| x.get(*node).is_some_and(|at| (at - place).abs() <= SAME_PLACE * span);
    [above, above.wrapping_sub(1)].into_iter().find(near)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Section, Support};

    fn spec(elements: usize) -> BeamSpec {
        BeamSpec::new(1.0, elements, Section::new(1.0, 1.0).unwrap())
    }

    #[test]
    fn a_support_at_a_node_leaves_the_mesh_uniform_and_one_between_gets_its_own() {
        let plain = Mesh::new(&spec(10)).unwrap();
        // 0.1 + 0.2 is not 0.3.
        let at_node = Mesh::new(&spec(10).support_at(0.1 + 0.2, Support::Pinned)).unwrap();
        assert_eq!(plain, at_node);
        let between = Mesh::new(&spec(10).support_at(0.25, Support::Pinned)).unwrap();
        assert_eq!(between.elements(), 11);
        assert_eq!(between.node(0.25).map(|node| between.x[node]), Some(0.25));
        assert!(between.x.windows(2).all(|pair| pair[1] - pair[0] > 0.08 && pair[1] - pair[0] < 0.11));
    }

    #[test]
    fn a_mesh_of_ones_own_takes_in_the_places_that_need_a_node() {
        let mesh = Mesh::new(&spec(1).meshed(vec![0.0, 0.1, 0.5, 1.0]).lump(0.75, 1.0, 0.0)).unwrap();
        assert_eq!(mesh.x, [0.0, 0.1, 0.5, 0.75, 1.0]);
        assert_eq!(mesh.locate(0.1), (1, 0.0));
        assert_eq!(mesh.locate(1.0), (3, 1.0));
        let (element, xi) = mesh.locate(0.3);
        assert!(element == 1 && (xi - 0.5).abs() < 1e-15);
    }
}
