//! L D Lᵀ of a block tridiagonal matrix, from both ends to the middle.
//!
//! A substitution is a chain: each node waits for its neighbour. Eliminating from both ends at once
//! (a *twisted* factorisation) makes two chains of half the length that don't wait for each other,
//! and takes little more than half the time.

use crate::blocks::{Blocks, Node};

/// What is kept of an eliminated node.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Pivot {
    /// D⁻¹, its own block: (w, w), (w, ψ), (ψ, ψ); zero for what is held.
    inverse: [f64; 3],
    /// By which the node passes its value on to its inner neighbour: (block with it)ᵀ D⁻¹, by rows.
    pass: [[f64; 2]; 2],
}

const UNKNOWN: Pivot = Pivot { inverse: [f64::NAN; 3], pass: [[f64::NAN; 2]; 2] };

/// The factor of A with the rows and columns of held dofs left out.
#[derive(Debug, Clone)]
pub(crate) struct Twisted {
    pivots: Vec<Pivot>,
    /// The node that is eliminated last.
    middle: usize,
}

impl Twisted {
    pub(crate) fn new(nodes: usize) -> Self {
        Self { pivots: vec![UNKNOWN; nodes], middle: nodes / 2 }
    }

    /// Factorises A; `held` says which dofs are left out. The number of the dof, from 0, whose
    /// pivot is not positive is the error: the factor is then NaN throughout.
    pub(crate) fn factorise(&mut self, a: &Blocks, held: &[[bool; 2]]) -> Result<(), usize> {
        let done = self.eliminate(a, held);
        if done.is_err() {
            // Half a factor must not pass for one.
            self.pivots.fill(UNKNOWN);
        }
        done
    }

    fn eliminate(&mut self, a: &Blocks, held: &[[bool; 2]]) -> Result<(), usize> {
        let (nodes, middle) = (self.pivots.len(), self.middle);
        let transposed = |m: [[f64; 2]; 2]| [[m[0][0], m[1][0]], [m[0][1], m[1][1]]];
        let mut from_left = [0.0; 3];
        for k in 0..middle {
            let Node { own, next } = a.0[k];
            from_left = self.take(k, own, from_left, free(transposed(next), held[k], held[k + 1]), held[k])?;
        }
        let mut from_right = [0.0; 3];
        for k in (middle + 1..nodes).rev() {
            let inward = free(a.0[k - 1].next, held[k], held[k - 1]);
            from_right = self.take(k, a.0[k].own, from_right, inward, held[k])?;
        }
        let both = [0, 1, 2].map(|i| from_left[i] + from_right[i]);
        self.take(middle, a.0[middle].own, both, [[0.0; 2]; 2], held[middle])?;
        Ok(())
    }

    /// Eliminates a node; `inward` is its block with its inner neighbour, rows that neighbour's.
    /// Returns what the neighbour's own block loses.
    fn take(
        &mut self,
        k: usize,
        own: [f64; 3],
        less: [f64; 3],
        inward: [[f64; 2]; 2],
        held: [bool; 2],
    ) -> Result<[f64; 3], usize> {
        let [ww, wp, pp] = [0, 1, 2].map(|i| own[i] - less[i]);
        let positive = |pivot: f64, dof| if pivot > 0.0 && pivot.is_finite() { Ok(pivot) } else { Err(2 * k + dof) };
        let inverse = match held {
            [true, true] => [0.0; 3],
            [true, false] => [0.0, 0.0, 1.0 / positive(pp, 1)?],
            [false, true] => [1.0 / positive(ww, 0)?, 0.0, 0.0],
            [false, false] => {
                let ww = positive(ww, 0)?;
                let l = wp / ww;
                let last = 1.0 / positive(pp - wp * l, 1)?;
                [1.0 / ww + l * l * last, -l * last, last]
            }
        };
        let pass = inward.map(|[w, p]| [w * inverse[0] + p * inverse[1], w * inverse[1] + p * inverse[2]]);
        self.pivots[k] = Pivot { inverse, pass };
        let entry = |i: usize, j: usize| pass[i][0] * inward[j][0] + pass[i][1] * inward[j][1];
        Ok([entry(0, 0), entry(0, 1), entry(1, 1)])
    }

    /// x ← A⁻¹ x; 0 for held dofs.
    pub(crate) fn solve(&self, x: &mut [[f64; 2]]) {
        let (left, right) = x.split_at_mut(self.middle);
        let (outer, inner) = self.pivots.split_at(self.middle);
        let (Some((middle, right)), Some((last, inner))) = (right.split_first_mut(), inner.split_first()) else {
            return;
        };
        // The left part is at most one node longer than the right one.
        let longer = left.len() - right.len();
        let (mut a, mut b) = ([0.0; 2], [0.0; 2]);
        for (x, pivot) in left[..longer].iter_mut().zip(outer) {
            a = forward(x, pivot, a);
        }
        let pairs = left[longer..].iter_mut().zip(&outer[longer..]).zip(right.iter_mut().zip(inner).rev());
        for ((x, pivot), (y, other)) in pairs {
            a = forward(x, pivot, a);
            b = forward(y, other, b);
        }
        *middle = [middle[0] - a[0] - b[0], middle[1] - a[1] - b[1]];
        *middle = symmetric(&last.inverse, *middle);
        let (mut a, mut b) = (*middle, *middle);
        let pairs = left[longer..].iter_mut().zip(&outer[longer..]).rev().zip(right.iter_mut().zip(inner));
        for ((x, pivot), (y, other)) in pairs {
            a = backward(x, pivot, a);
            b = backward(y, other, b);
        }
        for (x, pivot) in left[..longer].iter_mut().zip(outer).rev() {
            a = backward(x, pivot, a);
        }
    }
}

/// Without what is held, on either side.
fn free(block: [[f64; 2]; 2], columns: [bool; 2], rows: [bool; 2]) -> [[f64; 2]; 2] {
    let keep = |i: usize, j: usize| if rows[i] || columns[j] { 0.0 } else { block[i][j] };
    [[keep(0, 0), keep(0, 1)], [keep(1, 0), keep(1, 1)]]
}

#[inline]
fn symmetric(m: &[f64; 3], x: [f64; 2]) -> [f64; 2] {
    [m[0] * x[0] + m[1] * x[1], m[1] * x[0] + m[2] * x[1]]
}

/// Takes off what the outer neighbour passes on, and returns what goes on to the inner one.
#[inline]
fn forward(x: &mut [f64; 2], pivot: &Pivot, less: [f64; 2]) -> [f64; 2] {
    let y = [x[0] - less[0], x[1] - less[1]];
    *x = y;
    pivot.pass.map(|[w, p]| w * y[0] + p * y[1])
}

#[inline]
fn backward(x: &mut [f64; 2], pivot: &Pivot, inner: [f64; 2]) -> [f64; 2] {
    let [[a, b], [c, d]] = pivot.pass;
    let own = symmetric(&pivot.inverse, *x);
    *x = [own[0] - (a * inner[0] + c * inner[1]), own[1] - (b * inner[0] + d * inner[1])];
    *x
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(nodes: usize) -> Blocks {
        let node = |k: usize| Node {
            own: [4.0 + (k as f64).sin(), 0.3 * (k as f64).cos(), 3.0],
            next: [[-1.0, 0.5], [0.2 * (1.3 * k as f64).sin(), 0.7]],
        };
        Blocks((0..nodes).map(node).collect())
    }

    fn product(a: &Blocks, x: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let n = x.len();
        let mut y: Vec<[f64; 2]> = (0..n).map(|k| symmetric(&a.0[k].own, x[k])).collect();
        for k in 0..n - 1 {
            let m = a.0[k].next;
            for i in 0..2 {
                for j in 0..2 {
                    y[k][i] += m[i][j] * x[k + 1][j];
                    y[k + 1][j] += m[i][j] * x[k][i];
                }
            }
        }
        y
    }

    #[test]
    fn substitution_undoes_the_product_for_any_number_of_nodes_and_any_support() {
        for nodes in 2..9 {
            for pattern in 0..1_usize << (2 * nodes).min(10) {
                let held: Vec<[bool; 2]> =
                    (0..nodes).map(|k| [pattern >> (2 * k) & 1 == 1, pattern >> (2 * k + 1) & 1 == 1]).collect();
                let a = matrix(nodes);
                let x: Vec<[f64; 2]> = (0..nodes)
                    .map(|k| [0, 1].map(|i| if held[k][i] { 0.0 } else { ((2 * k + i) as f64 * 1.7).sin() }))
                    .collect();
                let mut y = product(&a, &x);
                let mut factor = Twisted::new(nodes);
                factor.factorise(&a, &held).unwrap();
                factor.solve(&mut y);
                assert!(y.iter().flatten().zip(x.iter().flatten()).all(|(y, x)| (y - x).abs() < 1e-13), "{held:?}");
            }
        }
    }

    #[test]
    fn a_pivot_that_is_not_positive_is_named_and_leaves_no_factor() {
        let mut a = matrix(5);
        a.0[1].own[0] = -1.0;
        let mut factor = Twisted::new(5);
        assert_eq!(factor.factorise(&a, &[[false; 2]; 5]), Err(2));
        let mut x = [[1.0; 2]; 5];
        factor.solve(&mut x);
        assert!(x.iter().flatten().all(|x| x.is_nan()));
    }
}
