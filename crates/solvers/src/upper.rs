//! The upper triangle of H's symmetric part in compressed columns, for factorisations and cone
//! programs.

use teeter_contact::BlockSparse;
#[cfg(feature = "clarabel")]
use teeter_contact::Vector;

/// The upper triangle of S = (H + Hᵀ)/2. The pattern is built once; setting values doesn't
/// allocate.
#[derive(Clone, Debug, Default)]
pub(crate) struct Upper<const D: usize> {
    /// The matrix with the current pattern.
    pattern: BlockSparse<D>,
    /// For each block of H, the offset of its first row in the stored columns.
    down: Vec<usize>,
    /// The position of each scalar diagonal entry.
    pub(crate) diagonal: Vec<usize>,
    /// The start of each scalar column, and the rows of the entries.
    pub(crate) starts: Vec<usize>,
    pub(crate) rows: Vec<usize>,
    pub(crate) values: Vec<f64>,
}

impl<const D: usize> Upper<D> {
    /// Sets the values of `h`; true if its pattern has changed.
    pub(crate) fn load(&mut self, h: &BlockSparse<D>) -> bool {
        let new = self.starts.is_empty() || !self.pattern.same_pattern(h);
        if new {
            self.analyse(h);
            self.pattern.clone_from(h);
        }
        self.values.clear();
        self.values.resize(self.rows.len(), 0.0);
        for i in 0..h.contacts() {
            for (k, (j, block)) in h.range(i).zip(h.row(i)) {
                let column = i.max(j);
                for c in 0..D {
                    let at = self.starts[column * D + c] + self.down[k];
                    if i == j {
                        for r in 0..=c {
                            self.values[at + r] = 0.5 * (block[(r, c)] + block[(c, r)]);
                        }
                    } else {
                        // A block right of the diagonal is in the upper triangle; one left of it is
                        // added transposed.
                        for r in 0..D {
                            self.values[at + r] += 0.5 * if i < j { block[(r, c)] } else { block[(c, r)] };
                        }
                    }
                }
            }
        }
        new
    }

    fn analyse(&mut self, h: &BlockSparse<D>) {
        let n = h.contacts();
        // The blocks of the upper triangle by columns; a block may be stored on only one side of
        // the diagonal.
        let mut upper: Vec<_> = (0..n).flat_map(|i| h.row(i).map(move |(j, _)| (i.max(j), i.min(j)))).collect();
        upper.sort_unstable();
        upper.dedup();
        let mut first = Vec::with_capacity(n + 1);
        first.push(0);
        for vectors in [&mut self.starts, &mut self.rows, &mut self.diagonal, &mut self.down] {
            vectors.clear();
        }
        self.starts.push(0);
        let mut blocks = 0;
        for column in upper.chunk_by(|a, b| a.0 == b.0) {
            for c in 0..D {
                for &(j, i) in column {
                    self.rows.extend((0..if i == j { c + 1 } else { D }).map(|r| i * D + r));
                }
                self.diagonal.push(self.rows.len() - 1);
                self.starts.push(self.rows.len());
            }
            blocks += column.len();
            first.push(blocks);
        }
        for i in 0..n {
            for (j, _) in h.row(i) {
                let pair = (i.max(j), i.min(j));
                let column = &upper[first[pair.0]..first[pair.0 + 1]];
                self.down.push(D * column.partition_point(|other| *other < pair));
            }
        }
    }

    /// `S p`.
    #[cfg(feature = "clarabel")]
    pub(crate) fn product(&self, p: &[Vector<D>], product: &mut [Vector<D>]) {
        product.fill(Vector::zeros());
        for column in 0..p.len() * D {
            let (j, c) = (column / D, column % D);
            for k in self.starts[column]..self.starts[column + 1] {
                let (i, r) = (self.rows[k] / D, self.rows[k] % D);
                product[i][r] += self.values[k] * p[j][c];
                if self.rows[k] != column {
                    product[j][c] += self.values[k] * p[i][r];
                }
            }
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use nalgebra::Matrix2;

    /// (0, 2) is stored only above the diagonal, (1, 0) only below, (1, 2) on both sides and not
    /// symmetric.
    pub(crate) fn one_sided() -> BlockSparse<2> {
        let block = |a: f64| Matrix2::new(a, 0.3, -0.1, a + 1.0);
        BlockSparse::from_rows(&[
            vec![(0, block(9.0)), (2, block(0.5))],
            vec![(0, block(-0.7)), (1, block(8.0)), (2, block(1.0))],
            vec![(1, block(0.2)), (2, block(7.0))],
        ])
        .unwrap()
    }

    #[test]
    fn represents_the_symmetric_part_of_one_sided_blocks() {
        let h = one_sided();
        let entry = |i: usize, j: usize| h.block(i, j).copied().unwrap_or_default();
        let mut upper = Upper::default();
        assert!(upper.load(&h) && !upper.load(&h), "the pattern is kept");
        for column in 0..6 {
            for k in upper.starts[column]..upper.starts[column + 1] {
                let row = upper.rows[k];
                let symmetric = (entry(row / 2, column / 2) + entry(column / 2, row / 2).transpose()) * 0.5;
                assert!((upper.values[k] - symmetric[(row % 2, column % 2)]).abs() < 1e-15);
            }
            assert_eq!(upper.rows[upper.diagonal[column]], column);
        }
        assert_eq!(upper.rows.len(), 3 * 3 + 3 * 4);
    }
}
