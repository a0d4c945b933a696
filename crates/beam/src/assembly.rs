//! The assembled matrices, on one pattern.
//!
//! The pattern is that of the mesh, not of the values: the coupling of w and w' of an inner node cancels to 0 on a
//! uniform mesh and stays as an entry, so M, C and K (and every weighted sum of them) share one symbolic factorisation,
//! and their values can be combined entry by entry.

use faer::sparse::{SparseColMat, SymbolicSparseColMat};

use crate::layout::Layout;

/// The upper triangle, by columns, of a half bandwidth of three.
pub(crate) fn pattern(layout: &Layout) -> SymbolicSparseColMat<usize> {
    let dofs = layout.dofs();
    let mut column_start = vec![0];
    let mut rows = Vec::with_capacity(4 * dofs);
    for node in 0..=layout.elements {
        for column in layout.first(node)..layout.first(node) + layout.free(node) {
            rows.extend(layout.first(node.saturating_sub(1))..=column);
            column_start.push(rows.len());
        }
    }
    SymbolicSparseColMat::new_checked(dofs, dofs, column_start, None, rows)
}

/// The matrix whose elements all have the same 4 × 4 matrix, on `pattern`.
pub(crate) fn assemble(
    layout: &Layout,
    pattern: &SymbolicSparseColMat<usize>,
    element: &[[f64; 4]; 4],
) -> SparseColMat<usize, f64> {
    let mut values = Vec::with_capacity(pattern.row_idx().len());
    for node in 0..=layout.elements {
        // Of a node with one free dof (pinned) that is the slope: local number 1.
        for b in 2 - layout.free(node)..2 {
            if node > 0 {
                values.extend((2 - layout.free(node - 1)..2).map(|a| element[a][2 + b]));
            }
            for a in 2 - layout.free(node)..=b {
                let left = if node > 0 { element[2 + a][2 + b] } else { 0.0 };
                let right = if node < layout.elements { element[a][b] } else { 0.0 };
                values.push(left + right);
            }
        }
    }
    SparseColMat::new(pattern.clone(), values)
}
