//! The rigid motions that the supports leave.

use super::block::{Orthonormal, VectorBlock, orthonormalised, ritz};
use crate::Dof;
use crate::beam::Beam;

/// An M-orthonormal basis of the motions a + b x that no support holds and whose ω² is at most
/// `unmoved`.
pub(crate) fn motions(beam: &Beam, unmoved: f64) -> VectorBlock {
    let mut block = VectorBlock::new(beam.dofs());
    let x = beam.node_positions();
    let held = |kind| (0..beam.nodes()).filter(move |node| beam.dof(*node, kind).is_none());
    let pins: Vec<usize> = held(Dof::Deflection).collect();
    if pins.is_empty() {
        block.push(&shape(beam, |_| [1.0, 0.0]));
    }
    if pins.len() <= 1 && held(Dof::Slope).next().is_none() {
        let centre = pins.first().map_or(0.5 * beam.spec().span, |node| x[*node]);
        block.push(&shape(beam, |node| [x[node] - centre, 1.0]));
    }
    if let Some(bar) = beam.bar.as_ref().filter(|bar| !bar.held.contains(&true)) {
        let mut along = vec![0.0; beam.dofs()];
        along[2 * bar.held.len()..].fill(1.0);
        block.push(&along);
    }
    let block = orthonormalised(beam, &Orthonormal::new(beam, VectorBlock::new(beam.dofs())), &block, 0.0);
    // Of both, the combination that an elastic support leaves at rest.
    let (values, mut motions) = ritz(beam, &block);
    motions.truncate(values.iter().filter(|value| **value <= unmoved).count());
    motions
}

/// The vector of a nodal shape (w, w'); what is held is 0.
fn shape(beam: &Beam, nodal: impl Fn(usize) -> [f64; 2]) -> Vec<f64> {
    let mut q = vec![0.0; beam.dofs()];
    for node in 0..beam.nodes() {
        for (kind, value) in [Dof::Deflection, Dof::Slope].into_iter().zip(nodal(node)) {
            if let Some(dof) = beam.dof(node, kind) {
                q[dof] = value;
            }
        }
    }
    q
}
