//! A symmetric matrix in blocks of two: what a chain of elements assembles to.

use crate::element::Matrix4;

/// The blocks of one node.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Node {
    /// Its own block: (w, w), (w, ψ), (ψ, ψ).
    pub(crate) own: [f64; 3],
    /// Its block with the next node, by rows.
    pub(crate) next: [[f64; 2]; 2],
}

/// A block tridiagonal matrix, one block row a node.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Blocks(pub(crate) Vec<Node>);

impl Blocks {
    pub(crate) fn zero(nodes: usize) -> Self {
        Self(vec![Node::default(); nodes])
    }

    pub(crate) fn assemble(nodes: usize, elements: impl Iterator<Item = Matrix4>) -> Self {
        let mut blocks = Self::zero(nodes);
        for (k, m) in elements.enumerate() {
            blocks.add_own(k, [m[0][0], m[0][1], m[1][1]]);
            blocks.add_own(k + 1, [m[2][2], m[2][3], m[3][3]]);
            blocks.0[k].next = [[m[0][2], m[0][3]], [m[1][2], m[1][3]]];
        }
        blocks
    }

    pub(crate) fn add_own(&mut self, node: usize, own: [f64; 3]) {
        for (sum, value) in self.0[node].own.iter_mut().zip(own) {
            *sum += value;
        }
    }

    /// Adds a multiple of another one of the same size.
    pub(crate) fn add_scaled(&mut self, factor: f64, other: &Self) {
        for (sum, node) in self.0.iter_mut().zip(&other.0) {
            sum.own.iter_mut().zip(node.own).for_each(|(sum, value)| *sum += factor * value);
            let entries = node.next.into_iter().flatten();
            sum.next.as_flattened_mut().iter_mut().zip(entries).for_each(|(sum, value)| *sum += factor * value);
        }
    }

    /// Becomes the weighted sum of others of the same size.
    pub(crate) fn combine(&mut self, terms: &[(f64, &Self)]) {
        for (k, node) in self.0.iter_mut().enumerate() {
            let mut sum = Node::default();
            for (weight, other) in terms {
                let other = &other.0[k];
                for i in 0..3 {
                    sum.own[i] += weight * other.own[i];
                }
                for i in 0..2 {
                    for j in 0..2 {
                        sum.next[i][j] += weight * other.next[i][j];
                    }
                }
            }
            *node = sum;
        }
    }
}
