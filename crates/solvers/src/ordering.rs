//! The elimination order of contacts.

use crate::memory::{refill, reserve};
#[cfg(feature = "sparse")]
use faer::dyn_stack::MemBuffer;
use teeter_contact::BlockSparse;

/// Up to this number of contacts the given order is kept: a full factor is small, and ordering
/// costs more than it saves.
pub(crate) const UNORDERED: usize = 24;

/// The symmetric pattern of an operator, with memory for ordering it.
#[derive(Default)]
pub(crate) struct Ordering {
    /// The neighbours of each contact by H or its transpose, ascending, without itself.
    start: Vec<usize>,
    neighbours: Vec<usize>,
    fill: Vec<usize>,
    /// Input of approximate minimum degree: for each column the rows above the diagonal.
    #[cfg(feature = "sparse")]
    upper_start: Vec<usize>,
    #[cfg(feature = "sparse")]
    upper: Vec<usize>,
    #[cfg(feature = "sparse")]
    memory: Option<MemBuffer>,
}

impl std::fmt::Debug for Ordering {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Ordering")
            .field("start", &self.start)
            .field("neighbours", &self.neighbours)
            .finish_non_exhaustive()
    }
}

impl Ordering {
    pub(crate) fn reserve(&mut self, contacts: usize, blocks: usize) {
        reserve(&mut self.start, contacts + 1);
        reserve(&mut self.fill, contacts + 1);
        reserve(&mut self.neighbours, 2 * blocks);
    }

    /// Sets the pattern to that of `h`, made symmetric.
    pub(crate) fn neighbours_of<const D: usize>(&mut self, h: &BlockSparse<D>) {
        let n = h.contacts();
        refill(&mut self.fill, n + 1, 0);
        for i in 0..n {
            for &j in &h.columns()[h.range(i)] {
                if j != i {
                    self.fill[i + 1] += 1;
                    self.fill[j + 1] += 1;
                }
            }
        }
        for i in 0..n {
            self.fill[i + 1] += self.fill[i];
        }
        self.start.clear();
        self.start.extend_from_slice(&self.fill);
        refill(&mut self.neighbours, self.fill[n], 0);
        for i in 0..n {
            for &j in &h.columns()[h.range(i)] {
                if j != i {
                    for (a, b) in [(i, j), (j, i)] {
                        self.neighbours[self.fill[a]] = b;
                        self.fill[a] += 1;
                    }
                }
            }
        }
        // Most appear twice, from H and from its transpose.
        let mut kept = 0;
        for i in 0..n {
            let (first, last) = (self.start[i], self.start[i + 1]);
            self.neighbours[first..last].sort_unstable();
            self.start[i] = kept;
            for at in first..last {
                let j = self.neighbours[at];
                if kept == self.start[i] || self.neighbours[kept - 1] != j {
                    self.neighbours[kept] = j;
                    kept += 1;
                }
            }
        }
        self.start[n] = kept;
        self.neighbours.truncate(kept);
    }

    pub(crate) fn neighbours(&self, i: usize) -> &[usize] {
        &self.neighbours[self.start[i]..self.start[i + 1]]
    }

    /// `order[k]` is the contact eliminated at step k, `place` its inverse. For few contacts the
    /// given order is kept.
    pub(crate) fn order(&mut self, order: &mut Vec<usize>, place: &mut Vec<usize>) {
        let n = self.start.len() - 1;
        order.clear();
        order.extend(0..n);
        place.clear();
        place.extend(0..n);
        if n > UNORDERED {
            self.minimum_degree(order, place);
        }
    }

    #[cfg(not(feature = "sparse"))]
    fn minimum_degree(&mut self, _order: &mut [usize], _place: &mut [usize]) {}

    /// Orders by approximate minimum degree (Amestoy, Davis, Duff 1996, doi
    /// 10.1137/S0895479894278952).
    #[cfg(feature = "sparse")]
    pub(crate) fn minimum_degree(&mut self, order: &mut [usize], place: &mut [usize]) {
        use faer::dyn_stack::MemStack;
        use faer::sparse::{SymbolicSparseColMatRef, linalg::amd};
        let n = order.len();
        self.upper_start.clear();
        self.upper_start.push(0);
        self.upper.clear();
        for k in 0..n {
            let row = &self.neighbours[self.start[k]..self.start[k + 1]];
            self.upper.extend(row.iter().copied().take_while(|&j| j < k));
            self.upper_start.push(self.upper.len());
        }
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &self.upper_start, None, &self.upper);
        let needed = amd::order_scratch::<usize>(n, self.upper.len());
        if self.memory.as_ref().is_none_or(|memory| memory.len() < needed.unaligned_bytes_required()) {
            self.memory = Some(MemBuffer::new(needed));
        }
        let Some(memory) = &mut self.memory else { return };
        if amd::order(order, place, pattern, amd::Control::default(), MemStack::new(memory)).is_err() {
            order.iter_mut().enumerate().for_each(|(k, i)| *i = k);
            place.iter_mut().enumerate().for_each(|(i, k)| *k = i);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_contact::Block;

    #[test]
    fn neighbours_are_symmetric() {
        let one = Block::<2>::identity();
        let h = BlockSparse::from_rows(&[vec![(0, one), (2, one)], vec![(1, one)], vec![(1, one), (2, one)]]).unwrap();
        let mut ordering = Ordering::default();
        ordering.neighbours_of(&h);
        assert_eq!([0, 1, 2].map(|i| ordering.neighbours(i).to_vec()), [vec![2], vec![2], vec![0, 1]]);
    }
}
