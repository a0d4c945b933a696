//! Which entry of a vector belongs to which node.
//!
//! Free dofs in node-major order, the fixed ones left out. Only the two end nodes can miss any, so a vector is: what is
//! left of the first node, whole pairs (w, w') of the inner nodes, what is left of the last node.

use crate::spec::Support;

/// One of the two degrees of freedom of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Dof {
    /// w, m.
    Deflection,
    /// w', rad.
    Slope,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Layout {
    pub(crate) elements: usize,
    /// Free dofs of the first and of the last node, 0 to 2.
    head: usize,
    tail: usize,
}

impl Layout {
    pub(crate) fn new(elements: usize, supports: [Support; 2]) -> Self {
        Self { elements, head: supports[0].free_dofs(), tail: supports[1].free_dofs() }
    }

    pub(crate) fn dofs(&self) -> usize {
        self.head + 2 * (self.elements - 1) + self.tail
    }

    /// Free dofs of `node`.
    pub(crate) fn free(&self, node: usize) -> usize {
        if node == 0 {
            self.head
        } else if node == self.elements {
            self.tail
        } else {
            2
        }
    }

    /// Index of the first free dof of `node` (for a clamped last node: one past the end).
    pub(crate) fn first(&self, node: usize) -> usize {
        if node == 0 { 0 } else { self.head + 2 * (node - 1) }
    }

    pub(crate) fn dof(&self, node: usize, kind: Dof) -> Option<usize> {
        if node > self.elements {
            return None;
        }
        let (first, free) = (self.first(node), self.free(node));
        match kind {
            Dof::Deflection => (free == 2).then_some(first),
            Dof::Slope => (free > 0).then(|| first + free - 1),
        }
    }

    /// A vector as (first node, inner nodes, last node), fixed dofs as 0.
    #[inline]
    pub(crate) fn split<'a>(&self, q: &'a [f64]) -> ([f64; 2], &'a [[f64; 2]], [f64; 2]) {
        assert_eq!(q.len(), self.dofs(), "a vector must have one entry per degree of freedom");
        let (head, rest) = q.split_at(self.head);
        let (inner, tail) = rest.split_at(rest.len() - self.tail);
        (pad(head), inner.as_chunks().0, pad(tail))
    }

    /// As [`Layout::split`], the end nodes as the slices of what is free of them.
    #[inline]
    pub(crate) fn split_mut<'a>(&self, f: &'a mut [f64]) -> (&'a mut [f64], &'a mut [[f64; 2]], &'a mut [f64]) {
        assert_eq!(f.len(), self.dofs(), "a vector must have one entry per degree of freedom");
        let (head, rest) = f.split_at_mut(self.head);
        let (inner, tail) = rest.split_at_mut(rest.len() - self.tail);
        (head, inner.as_chunks_mut().0, tail)
    }
}

fn pad(end: &[f64]) -> [f64; 2] {
    match *end {
        [w, slope] => [w, slope],
        [slope] => [0.0, slope],
        _ => [0.0, 0.0],
    }
}

/// Adds the pair of a node to what is free of it.
#[inline]
pub(crate) fn add_to_end(end: &mut [f64], pair: [f64; 2]) {
    match end {
        [w, slope] => {
            *w += pair[0];
            *slope += pair[1];
        }
        [slope] => *slope += pair[1],
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::Support::{Clamped, Free, Pinned};

    #[test]
    fn dofs_are_numbered_in_node_major_order_without_gaps() {
        for supports in [[Free, Free], [Pinned, Free], [Clamped, Pinned], [Free, Pinned], [Pinned, Pinned]] {
            for elements in [1, 2, 5] {
                let layout = Layout::new(elements, supports);
                let numbers: Vec<usize> = (0..=elements)
                    .flat_map(|node| [Dof::Deflection, Dof::Slope].map(|kind| layout.dof(node, kind)))
                    .flatten()
                    .collect();
                assert_eq!(numbers, (0..layout.dofs()).collect::<Vec<_>>(), "{supports:?} {elements}");
                assert_eq!(layout.dof(elements + 1, Dof::Slope), None);
            }
        }
    }

    #[test]
    fn a_pinned_end_keeps_its_slope() {
        let layout = Layout::new(2, [Pinned, Pinned]);
        let (first, inner, last) = layout.split(&[1.0, 2.0, 3.0, 4.0]);
        assert_eq!((first, inner, last), ([0.0, 1.0], &[[2.0, 3.0]][..], [0.0, 4.0]));
    }
}
