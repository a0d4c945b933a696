//! Reads the initial shape of a beam from a file: a row for each node.

use teeter_beam::{Beam, BeamError, Dof, Hold};

use super::Resolver;
use crate::dimension::Dimension;
use crate::{number_table, wording};

/// Its columns.
const SHAPE: &[Dimension] = &[Dimension::LENGTH, Dimension::LENGTH, Dimension::ANGLE];

/// A row belongs to the node within this fraction of the span from its x.
const SAME_PLACE: f64 = 1e-6;

impl Resolver<'_, '_> {
    /// The coordinates of a beam for the shape in a file: columns x, w, and w' if it has three.
    pub(super) fn shape(&mut self, path: &str, file: &str, beam: &Beam) -> Option<Vec<f64>> {
        let bytes = match self.file(file) {
            Ok(bytes) => bytes,
            Err(why) => {
                self.error(path, why, "paths are relative to the scene's file");
                return None;
            }
        };
        match read(&bytes, beam) {
            Ok(shape) => Some(shape),
            Err(why) => {
                self.error(
                    path,
                    why,
                    "give columns x, w and, optionally, the slope w', separated by commas, with a row for each node",
                );
                None
            }
        }
    }
}

fn read(bytes: &[u8], beam: &Beam) -> Result<Vec<f64>, String> {
    let table = number_table::columns(bytes, 2..=3, "two or three, x, w and slope", SHAPE)?;
    let nodes = beam.node_positions();
    let [x, w, ..] = table.columns.as_slice() else {
        return Err(format!("expected {} rows, one for each node, got none", nodes.len()));
    };
    if x.len() != nodes.len() {
        return Err(format!("expected {} rows, one for each node, got {}", nodes.len(), x.len()));
    }
    let span = beam.spec().span;
    // NaN is at no node.
    let elsewhere = |(x, node): (&f64, &f64)| !((x - node).abs() <= SAME_PLACE * span);
    if let Some(row) = x.iter().zip(nodes).position(elsewhere) {
        let (line, x, node) = (table.lines[row], x[row], nodes[row]);
        return Err(format!("line {line}: x = {x} m, but the node of this row is at {node} m"));
    }
    let slopes = match table.columns.get(2) {
        Some(slopes) => slopes.clone(),
        None => slopes(beam, w),
    };
    let nodal: Vec<[f64; 2]> = w.iter().zip(slopes).map(|(w, slope)| [*w, slope]).collect();
    beam.from_nodes(&nodal).map_err(|error| match error {
        BeamError::BrokenSupport { node, dof, value, support } => {
            let (what, unit) = if dof == Dof::Deflection { ("w", " m") } else { ("slope", "") };
            let word = wording::support(support);
            format!(
                "it breaks the {word} support at x = {} m: {what} = {value}{unit}, but must be 0 there",
                nodes[node]
            )
        }
        BeamError::Value { value, .. } => format!("{value} is not finite"),
        error => error.to_string(),
    })
}

/// Slopes of the cubic spline through the nodes: no bending moment at ends that are free to rotate,
/// no slope where a support fixes it.
fn slopes(beam: &Beam, w: &[f64]) -> Vec<f64> {
    let x = beam.node_positions();
    let last = x.len() - 1;
    let spec = beam.spec();
    let inner = |at: f64| spec.inner_supports.iter().find(|inner| (inner.x - at).abs() <= SAME_PLACE * spec.span);
    let turns = |node: usize| {
        let support = match node {
            0 => Some(spec.supports[0]),
            node if node == last => Some(spec.supports[1]),
            node => inner(x[node]).map(|inner| inner.support),
        };
        support.is_none_or(|support| support.holds()[1] != Hold::Fixed)
    };
    let side = |k: usize| (x[k + 1] - x[k]).recip();
    let rise = |k: usize| 3.0 * (w[k + 1] - w[k]) * side(k) * side(k);
    // Thomas' algorithm: s_k = right_k − upper_k s_{k+1}.
    let mut swept: Vec<[f64; 2]> = Vec::with_capacity(x.len());
    for node in 0..x.len() {
        let (mut below, mut own, mut above, mut right) = (0.0, 0.0, 0.0, 0.0);
        if node > 0 {
            (below, own, right) = (side(node - 1), 2.0 * side(node - 1), rise(node - 1));
        }
        if node < last {
            above = side(node);
            own += 2.0 * side(node);
            right += rise(node);
        }
        if !turns(node) {
            (below, own, above, right) = (0.0, 1.0, 0.0, 0.0);
        }
        let [upper, before] = swept.last().copied().unwrap_or_default();
        let pivot = own - below * upper;
        swept.push([above / pivot, (right - below * before) / pivot]);
    }
    let mut slopes = vec![0.0; x.len()];
    let mut next = 0.0;
    for (slope, [upper, right]) in slopes.iter_mut().zip(&swept).rev() {
        next = right - upper * next;
        *slope = next;
    }
    slopes
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_beam::{BeamSpec, Section, Support};

    fn beam(supports: [Support; 2]) -> Beam {
        Beam::new(BeamSpec::new(1.0, 8, Section::new(1.0, 1.0).unwrap()).supported(supports)).unwrap()
    }

    fn file(w: impl Fn(f64) -> f64) -> String {
        (0..=8).map(|k| f64::from(k) / 8.0).map(|x| format!("{x},{}\n", w(x))).collect()
    }

    #[test]
    fn without_slopes_the_shape_is_the_spline_of_the_supports() {
        // Cubics that fulfil the end conditions are their own spline: a cantilever under an end
        // load, w ~ x²(3 − x), free of moment at x = 1.
        let q = read(file(|x| x * x * (3.0 - x)).as_bytes(), &beam([Support::Clamped, Support::Free])).unwrap();
        for (k, pair) in q.chunks_exact(2).enumerate() {
            let x = k as f64 / 8.0;
            assert!((pair[1] - (6.0 * x - 3.0 * x * x)).abs() < 1e-13, "{x}: {}", pair[1]);
        }
        let q = read(file(|x| (std::f64::consts::PI * x).sin()).as_bytes(), &beam([Support::Pinned; 2])).unwrap();
        assert!((q[1] / std::f64::consts::PI - 1.0).abs() < 1e-3 && q[9].abs() < 1e-14);
    }

    #[test]
    fn units_of_a_heading_are_honoured() {
        let rows: String = (0..=8).map(|k| format!("{},{},0\n", f64::from(k) * 12.5, f64::from(k * (8 - k)))).collect();
        let q = read(format!("x [cm],w [mm],slope [deg]\n{rows}").as_bytes(), &beam([Support::Pinned; 2])).unwrap();
        assert_eq!(q[8], 0.016, "w at midspan, 16 mm: {q:?}");
        assert!(read(format!("x [s],w\n{rows}").as_bytes(), &beam([Support::Pinned; 2])).is_err());
    }

    #[test]
    fn what_is_wrong_with_a_shape_is_told() {
        let told = |text: &str, supports| read(text.as_bytes(), &beam(supports)).unwrap_err();
        let pinned = [Support::Pinned; 2];
        assert_eq!(
            told(&file(|_| 0.5), pinned),
            "it breaks the pinned support at x = 0 m: w = 0.5 m, but must be 0 there"
        );
        assert_eq!(told("0,0\n1,0\n", pinned), "expected 9 rows, one for each node, got 2");
        assert_eq!(told("x,w\n", pinned), "expected 9 rows, one for each node, got none");
        let moved = file(|_| 0.0).replace("0.25,", "0.26,");
        assert_eq!(told(&moved, pinned), "line 3: x = 0.26 m, but the node of this row is at 0.25 m");
        let sloped: String = (0..=8).map(|k| format!("{},0,0.1\n", f64::from(k) / 8.0)).collect();
        let clamped = [Support::Free, Support::Clamped];
        assert_eq!(
            told(&sloped, clamped),
            "it breaks the clamped support at x = 1 m: slope = 0.1, but must be 0 there"
        );
        assert!(told("1\n", pinned).starts_with("line 1: 1 column, but a table has two or three"));
        assert!(told(&file(|_| f64::NAN), pinned).contains("not finite"));
        let large = file(|x| if x == 0.25 { -1e300 } else { 0.0 });
        assert_eq!(
            told(&large, pinned),
            "line 3, column 2: -1e300 is over 1e12 in absolute value, the limit of numbers"
        );
    }
}
