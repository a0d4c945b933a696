//! The off-diagonal blocks of H, packed for sweeps.
//!
//! Two neighbouring blocks of a row are interleaved, so that each pair of numbers is multiplied and
//! added in one instruction (every x86-64 and ARM64 processor has two lanes). A row with an odd
//! number of blocks ends with a zero block.

use crate::memory::reserve;
use teeter_contact::{Block, ContactProblem, Delassus, Vector};

/// A block and its right neighbour: `[column][row]`, one lane each.
type Pair<const D: usize> = [[[f64; 2]; D]; D];

/// All rows.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rows<const D: usize> {
    /// The start of each row, and the end of the last one.
    start: Vec<usize>,
    pairs: Vec<Pair<D>>,
    columns: Vec<[u32; 2]>,
}

impl<const D: usize> Rows<D> {
    pub(crate) fn reserve(&mut self, contacts: usize, blocks: usize) {
        let pairs = blocks / 2 + contacts;
        reserve(&mut self.start, contacts + 1);
        reserve(&mut self.pairs, pairs);
        reserve(&mut self.columns, pairs);
    }

    /// Packs the blocks of a problem into reused memory. False for a matrix-free operator.
    pub(crate) fn pack(&mut self, problem: &ContactProblem<'_, D>) -> bool {
        let n = problem.contacts();
        self.start.clear();
        self.pairs.clear();
        self.columns.clear();
        self.start.push(0);
        for i in 0..n {
            match problem.delassus() {
                Delassus::Dense(blocks) => self.pack_row(i, blocks[i * n..(i + 1) * n].iter().enumerate()),
                Delassus::Blocks(h) => {
                    let range = h.range(i);
                    self.pack_row(i, h.columns()[range.clone()].iter().copied().zip(&h.blocks()[range]));
                }
                _ => return false,
            }
        }
        true
    }

    #[inline]
    fn pack_row<'a>(&mut self, i: usize, row: impl Iterator<Item = (usize, &'a Block<D>)>) {
        let mut left: Option<(usize, &Block<D>)> = None;
        for (j, block) in row {
            if j == i || block.iter().all(|&x| x == 0.0) {
                continue;
            }
            match left.take() {
                None => left = Some((j, block)),
                Some((k, first)) => self.push([k, j], first, block),
            }
        }
        if let Some((k, last)) = left {
            self.push([k, k], last, &Block::zeros());
        }
        self.start.push(self.pairs.len());
    }

    #[inline]
    fn push(&mut self, columns: [usize; 2], a: &Block<D>, b: &Block<D>) {
        let mut pair = [[[0.0; 2]; D]; D];
        for c in 0..D {
            for r in 0..D {
                pair[c][r] = [a[(r, c)], b[(r, c)]];
            }
        }
        self.pairs.push(pair);
        self.columns.push(columns.map(|j| j as u32));
    }

    /// `Σ_{j≠i} H_ij p_j`.
    #[inline(always)]
    pub(crate) fn product(&self, i: usize, p: &[Vector<D>]) -> Vector<D> {
        let range = self.start[i]..self.start[i + 1];
        // A separate sum for each entry of a block, so that additions are independent.
        let mut sums = [[[0.0; 2]; D]; D];
        for (pair, columns) in self.pairs[range.clone()].iter().zip(&self.columns[range]) {
            let (a, b) = (&p[columns[0] as usize], &p[columns[1] as usize]);
            for c in 0..D {
                let lanes = [a[c], b[c]];
                for r in 0..D {
                    for lane in 0..2 {
                        sums[c][r][lane] += pair[c][r][lane] * lanes[lane];
                    }
                }
            }
        }
        // Without `black_box` the compiler combines this with the following code, pairs rows
        // instead of lanes, and shuffles all blocks, which is half as fast.
        let sums = if D == 3 { std::hint::black_box(sums) } else { sums };
        let mut lanes = sums[0];
        for sum in &sums[1..] {
            for r in 0..D {
                for lane in 0..2 {
                    lanes[r][lane] += sum[r][lane];
                }
            }
        }
        Vector::from_fn(|r, _| lanes[r][0] + lanes[r][1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_contact::conformance::box_on_floor;

    #[test]
    fn packed_products_match_the_problem() {
        let points = [[-0.5, -0.3, -1.0], [0.5, -0.3, -1.0], [0.5, 0.3, -1.0], [-0.5, 0.4, -1.1]];
        for n in 1..=4 {
            let mut case = box_on_floor("box", [0.4, 0.5, 0.1], &points[..n], [0.1, 0.2, -1.0, 0.3, 0.1, 0.2], 0.5);
            if n == 4 {
                case.h[1] = Block::<3>::zeros();
            }
            let problem = case.problem().unwrap();
            let p: Vec<Vector<3>> = (0..n).map(|i| Vector::<3>::new(1.0, -0.5, i as f64)).collect();
            let mut rows = Rows::default();
            for _ in 0..2 {
                assert!(rows.pack(&problem));
                for i in 0..n {
                    let expected = problem.velocity(i, &p) - problem.q()[i] - problem.diagonal(i) * p[i];
                    assert!((rows.product(i, &p) - expected).norm() < 1e-14);
                }
            }
        }
    }
}
