//! LU factorisation of sparse matrices of small blocks, for Newton's method on contact problems.
//!
//! The pattern is that of the Delassus operator, made symmetric; it is ordered by approximate minimum degree (feature
//! `sparse`; in the order given without it) and analysed once. Values change in every Newton step, and so does the set
//! of contacts that take part: an open contact is left out by a flag, with no new analysis. Pivots are chosen inside the D × D
//! diagonal blocks only. That is safe where the matrix is a regularised one of a contact problem; the caller sees from the
//! residual of its step whether it was.
//!
//! A general sparse LU that pivots between rows orders by the pattern of AᵀA and fills in two to ten times as much on
//! these structurally symmetric matrices, and it has no notion of a left-out contact.

use nalgebra::SMatrix;
use teeter_contact::{Block, BlockSparse, Vector};

/// The analysis and the factors `A = L U` in the order of elimination; L has unit diagonal blocks.
#[derive(Clone, Debug, Default)]
pub(crate) struct BlockLu<const D: usize> {
    /// The pattern analysed.
    analysed: Option<BlockSparse<D>>,
    /// `order[k]` is the contact eliminated at step k, `place` its inverse.
    order: Vec<usize>,
    place: Vec<usize>,
    /// Structure of column k of L below the diagonal (and, mirrored, of row k of U): `below[start[k]..start[k + 1]]`.
    start: Vec<usize>,
    below: Vec<usize>,
    /// For each step j, the earlier columns k that reach it: (k, index of j in `below`).
    reach_start: Vec<usize>,
    reach: Vec<(usize, usize)>,
    lower: Vec<Block<D>>,
    upper: Vec<Block<D>>,
    pivot: Vec<Block<D>>,
    pivot_inverse: Vec<Block<D>>,
    active: Vec<bool>,
    /// Where a row lies in the column at hand.
    map: Vec<usize>,
    rhs: Vec<Vector<D>>,
}

impl<const D: usize> BlockLu<D> {
    /// Analyses the pattern of `h`, unless it is the one analysed last. Returns whether it had to.
    pub(crate) fn analyse(&mut self, h: &BlockSparse<D>) -> bool {
        if self.analysed.as_ref().is_some_and(|known| known.same_pattern(h)) {
            return false;
        }
        let n = h.contacts();
        let pattern = symmetric_pattern(h);
        self.order = fill_reducing_order(&pattern);
        self.place = vec![0; n];
        for (k, &i) in self.order.iter().enumerate() {
            self.place[i] = k;
        }
        self.eliminate_symbolically(&pattern);
        let filled = self.below.len();
        self.lower = vec![Block::zeros(); filled];
        self.upper = vec![Block::zeros(); filled];
        self.pivot = vec![Block::zeros(); n];
        self.pivot_inverse = vec![Block::zeros(); n];
        self.active = vec![false; n];
        self.map = vec![0; n];
        self.rhs = vec![Vector::zeros(); n];
        self.analysed = Some(h.clone());
        true
    }

    /// Blocks of L and U together, the diagonal included.
    pub(crate) fn filled_blocks(&self) -> usize {
        2 * self.below.len() + self.order.len()
    }

    /// Block products of one factorisation with all contacts active.
    pub(crate) fn block_products(&self) -> usize {
        self.start.windows(2).map(|w| (w[1] - w[0]) * (w[1] - w[0] + 1)).sum()
    }

    /// The structure of each column is what the pattern holds below it and what its children in the elimination tree
    /// pass on.
    fn eliminate_symbolically(&mut self, pattern: &[Vec<usize>]) {
        let n = pattern.len();
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); n];
        let mut mark = vec![usize::MAX; n];
        self.start = vec![0];
        self.below.clear();
        for k in 0..n {
            mark[k] = k;
            let first = self.below.len();
            for &j in &pattern[self.order[k]] {
                let j = self.place[j];
                if j > k && mark[j] != k {
                    mark[j] = k;
                    self.below.push(j);
                }
            }
            for &child in &children[k] {
                for at in self.start[child]..self.start[child + 1] {
                    let j = self.below[at];
                    if j > k && mark[j] != k {
                        mark[j] = k;
                        self.below.push(j);
                    }
                }
            }
            self.below[first..].sort_unstable();
            if let Some(&parent) = self.below.get(first) {
                children[parent].push(k);
            }
            self.start.push(self.below.len());
        }
        let mut count = vec![0; n + 1];
        for &j in &self.below {
            count[j + 1] += 1;
        }
        for j in 0..n {
            count[j + 1] += count[j];
        }
        self.reach_start = count.clone();
        self.reach = vec![(0, 0); self.below.len()];
        for k in 0..n {
            for at in self.start[k]..self.start[k + 1] {
                let j = self.below[at];
                self.reach[count[j]] = (k, at);
                count[j] += 1;
            }
        }
    }

    /// Factorises the matrix with blocks `block(i, t)`, t the index in the pattern's blocks, over the contacts with
    /// `active(i)`. The pattern must be the analysed one. `false` where a pivot block is singular or not finite.
    pub(crate) fn factorise(
        &mut self,
        h: &BlockSparse<D>,
        active: impl Fn(usize) -> bool,
        block: impl Fn(usize, usize) -> Block<D>,
    ) -> bool {
        let n = self.order.len();
        for k in 0..n {
            self.active[k] = active(self.order[k]);
        }
        self.lower.fill(Block::zeros());
        self.upper.fill(Block::zeros());
        self.scatter(h, block);
        for j in 0..n {
            if !self.active[j] {
                continue;
            }
            let own = self.start[j]..self.start[j + 1];
            for at in own.clone() {
                self.map[self.below[at]] = at;
            }
            let mut pivot = self.pivot[j];
            for &(k, at) in &self.reach[self.reach_start[j]..self.reach_start[j + 1]] {
                if !self.active[k] {
                    continue;
                }
                let (l, u) = (self.lower[at], self.upper[at]);
                pivot -= l * u;
                for t in at + 1..self.start[k + 1] {
                    let row = self.below[t];
                    if !self.active[row] {
                        continue;
                    }
                    let target = self.map[row];
                    let (l_t, u_t) = (self.lower[t], self.upper[t]);
                    self.lower[target] -= l_t * u;
                    self.upper[target] -= l * u_t;
                }
            }
            let Some(inverse) = invert(&pivot) else { return false };
            self.pivot_inverse[j] = inverse;
            for at in own {
                self.lower[at] *= inverse;
            }
        }
        true
    }

    /// Puts the matrix where its factors will be.
    fn scatter(&mut self, h: &BlockSparse<D>, block: impl Fn(usize, usize) -> Block<D>) {
        for k in 0..self.order.len() {
            if !self.active[k] {
                continue;
            }
            let i = self.order[k];
            for at in self.start[k]..self.start[k + 1] {
                self.map[self.below[at]] = at;
            }
            let range = h.range(i);
            for t in range {
                let j = h.columns()[t];
                let m = self.place[j];
                if !self.active[m] {
                    continue;
                }
                if m == k {
                    self.pivot[k] = block(i, t);
                } else if m > k {
                    self.upper[self.map[m]] = block(i, t);
                } else {
                    // Row k of column m of L: found by bisection in its structure.
                    let column = &self.below[self.start[m]..self.start[m + 1]];
                    if let Ok(at) = column.binary_search(&k) {
                        self.lower[self.start[m] + at] = block(i, t);
                    }
                }
            }
        }
    }

    /// Solves `A x = b` over the active contacts, in place; the others are left alone.
    pub(crate) fn solve(&mut self, x: &mut [Vector<D>]) {
        let n = self.order.len();
        for k in 0..n {
            self.rhs[k] = if self.active[k] { x[self.order[k]] } else { Vector::zeros() };
        }
        for k in 0..n {
            if self.active[k] {
                let b = self.rhs[k];
                for at in self.start[k]..self.start[k + 1] {
                    self.rhs[self.below[at]] -= self.lower[at] * b;
                }
            }
        }
        for k in (0..n).rev() {
            if self.active[k] {
                let mut b = self.rhs[k];
                for at in self.start[k]..self.start[k + 1] {
                    let j = self.below[at];
                    if self.active[j] {
                        b -= self.upper[at] * self.rhs[j];
                    }
                }
                self.rhs[k] = self.pivot_inverse[k] * b;
                x[self.order[k]] = self.rhs[k];
            }
        }
    }
}

/// The inverse by Gauss–Jordan elimination with row pivoting; `None` if it is singular or not finite.
fn invert<const D: usize>(a: &SMatrix<f64, D, D>) -> Option<SMatrix<f64, D, D>> {
    let inverse = if D == 3 { a.fixed_resize::<3, 3>(0.0).try_inverse()?.fixed_resize(0.0) } else { a.try_inverse()? };
    inverse.iter().all(|c| c.is_finite()).then_some(inverse)
}

/// The neighbours of each contact, either way round, ascending, without itself.
fn symmetric_pattern<const D: usize>(h: &BlockSparse<D>) -> Vec<Vec<usize>> {
    let mut pattern: Vec<Vec<usize>> = vec![Vec::new(); h.contacts()];
    for i in 0..h.contacts() {
        for (j, _) in h.row(i).filter(|&(j, _)| j != i) {
            pattern[i].push(j);
            pattern[j].push(i);
        }
    }
    for neighbours in &mut pattern {
        neighbours.sort_unstable();
        neighbours.dedup();
    }
    pattern
}

#[cfg(feature = "sparse")]
fn fill_reducing_order(pattern: &[Vec<usize>]) -> Vec<usize> {
    use faer::dyn_stack::{MemBuffer, MemStack};
    use faer::sparse::{SymbolicSparseColMatRef, linalg::amd};
    let n = pattern.len();
    let natural: Vec<usize> = (0..n).collect();
    let mut start = vec![0];
    let mut rows = Vec::new();
    for (k, neighbours) in pattern.iter().enumerate() {
        rows.extend(neighbours.iter().copied().filter(|&j| j <= k));
        start.push(rows.len());
    }
    let upper = SymbolicSparseColMatRef::new_checked(n, n, &start, None, &rows);
    let mut memory = MemBuffer::new(amd::order_scratch::<usize>(n, rows.len()));
    let (mut order, mut place) = (natural.clone(), natural.clone());
    match amd::order(&mut order, &mut place, upper, amd::Control::default(), MemStack::new(&mut memory)) {
        Ok(_) => order,
        Err(_) => natural,
    }
}

#[cfg(not(feature = "sparse"))]
fn fill_reducing_order(pattern: &[Vec<usize>]) -> Vec<usize> {
    (0..pattern.len()).collect()
}
