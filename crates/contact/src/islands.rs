//! Contacts that don't feel each other are problems of their own: the islands.

use crate::{Block, BlockSparse, ContactProblem, Delassus, Incidence};

/// The islands of a problem: groups of contacts such that no impulse in one changes a velocity in
/// another.
///
/// Islands are in the order of their first contacts, and the contacts of an island ascend; both
/// depend on the problem only. Time and memory are near-linear in contacts and blocks (union-find),
/// and memory is kept from one problem to the next.
///
/// ```
/// use nalgebra::Matrix2;
/// use teeter_contact::{BlockSparse, Islands};
///
/// let one = Matrix2::<f64>::identity();
/// let h = BlockSparse::from_rows(&[vec![(0, one), (2, one)], vec![(1, one)], vec![(2, one)]])?;
/// let mut islands = Islands::default();
/// islands.find_blocks(&h);
/// assert!(islands.iter().eq([&[0, 2][..], &[1]]));
/// # Ok::<(), teeter_contact::BlockSparseError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Islands {
    /// Of each contact, one before it in the same island, or itself: the union-find.
    parent: Vec<usize>,
    /// Number of islands; it starts at the number of contacts and falls with each join.
    count: usize,
    /// Of each contact, its island.
    island: Vec<usize>,
    /// Of each contact, its position within its island.
    place: Vec<usize>,
    /// The contacts, island by island, and where those of each island start.
    members: Vec<usize>,
    start: Vec<usize>,
    /// Steps from contacts to their roots, counted for a test.
    #[cfg(test)]
    steps: usize,
}

impl Islands {
    /// Finds the islands of a problem: contacts with a non-zero block between them, (i, j) or (j,
    /// i), belong together. All contacts of a matrix-free operator count as one island.
    pub fn find<const D: usize>(&mut self, problem: &ContactProblem<'_, D>) {
        match problem.delassus() {
            Delassus::Dense(blocks) => self.find_dense(blocks, problem.contacts()),
            Delassus::Blocks(h) => self.find_blocks(h),
            Delassus::Operator(_) => {
                self.begin(problem.contacts());
                (1..problem.contacts()).for_each(|i| self.join(0, i));
                self.finish();
            }
        }
    }

    /// Finds the islands of a block-sparse operator. A block that is stored but zero joins nothing.
    pub fn find_blocks<const D: usize>(&mut self, h: &BlockSparse<D>) {
        self.begin(h.contacts());
        let zero = Block::<D>::zeros();
        for i in 0..h.contacts() {
            for (j, block) in h.row(i) {
                if j != i && *block != zero {
                    self.join(i, j);
                }
            }
        }
        self.finish();
    }

    /// Finds the islands of contacts that share keys, before an operator is assembled.
    pub fn find_shared(&mut self, incidence: &Incidence) {
        self.begin(incidence.contacts());
        incidence.joints().for_each(|(i, j)| self.join(i, j));
        self.finish();
    }

    fn find_dense<const D: usize>(&mut self, blocks: &[Block<D>], n: usize) {
        self.begin(n);
        let zero = Block::<D>::zeros();
        for i in 0..n {
            for j in i + 1..n {
                // One island already, as with many contacts of one body: nothing left to join.
                if self.count == 1 {
                    break;
                }
                if blocks[i * n + j] != zero || blocks[j * n + i] != zero {
                    self.join(i, j);
                }
            }
        }
        self.finish();
    }

    /// Each contact an island.
    fn begin(&mut self, contacts: usize) {
        self.parent.clear();
        self.parent.extend(0..contacts);
        self.count = contacts;
    }

    /// The first contact of the island, as far as it is known.
    fn root(&mut self, mut i: usize) -> usize {
        while self.parent[i] != i {
            self.parent[i] = self.parent[self.parent[i]];
            i = self.parent[i];
            #[cfg(test)]
            {
                self.steps += 1;
            }
        }
        i
    }

    fn join(&mut self, i: usize, j: usize) {
        let (a, b) = (self.root(i), self.root(j));
        if a != b {
            self.parent[a.max(b)] = a.min(b);
            self.count -= 1;
        }
    }

    /// Numbers the islands and lists their contacts.
    fn finish(&mut self) {
        let n = self.parent.len();
        for list in [&mut self.island, &mut self.place, &mut self.members, &mut self.start] {
            list.clear();
        }
        // First `start` holds the sizes. A root is the first contact of its island, so it is
        // numbered before the others.
        for i in 0..n {
            let root = self.root(i);
            let island = if root == i { self.start.len() } else { self.island[root] };
            if root == i {
                self.start.push(0);
            }
            self.island.push(island);
            self.place.push(self.start[island]);
            self.start[island] += 1;
        }
        let mut end = 0;
        for start in &mut self.start {
            (*start, end) = (end, end + *start);
        }
        self.start.push(end);
        self.members.resize(n, 0);
        for i in 0..n {
            self.members[self.start[self.island[i]] + self.place[i]] = i;
        }
    }

    /// Number of islands.
    #[must_use]
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are none, as without contacts.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Number of contacts of all islands.
    #[must_use]
    pub fn contacts(&self) -> usize {
        self.members.len()
    }

    /// The contacts of an island, ascending.
    ///
    /// # Panics
    /// If there is no such island: a mistake of the calling code.
    #[must_use]
    pub fn members(&self, island: usize) -> &[usize] {
        &self.members[self.start[island]..self.start[island + 1]]
    }

    /// The members of each island, in the order of their first contacts.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[usize]> {
        (0..self.len()).map(|island| self.members(island))
    }

    /// The island that a contact belongs to.
    ///
    /// # Panics
    /// If there is no such contact: a mistake of the calling code.
    #[must_use]
    pub fn island_of(&self, contact: usize) -> usize {
        self.island[contact]
    }

    /// The position of a contact among the members of its island.
    ///
    /// # Panics
    /// If there is no such contact: a mistake of the calling code.
    #[must_use]
    pub fn place_of(&self, contact: usize) -> usize {
        self.place[contact]
    }

    /// Makes room for `contacts` contacts.
    pub fn reserve(&mut self, contacts: usize) {
        let Self { parent, island, place, members, start, .. } = self;
        for list in [parent, island, place, members] {
            list.reserve(contacts.saturating_sub(list.len()));
        }
        start.reserve((contacts + 1).saturating_sub(start.len()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps of the union-find for contacts with two keys each.
    fn steps(contacts: usize, touched: impl Fn(usize) -> [usize; 2]) -> f64 {
        let (mut incidence, mut islands) = (Incidence::default(), Islands::default());
        incidence.load(contacts, touched);
        islands.find_shared(&incidence);
        islands.steps as f64
    }

    #[test]
    fn work_grows_with_contacts_whatever_their_order() {
        // Odd, so that its multiples reach every contact, in an order without pattern.
        const JUMBLE: usize = 40_503;
        for contacts in [1 << 10, 1 << 16] {
            let of = |touched: &dyn Fn(usize) -> [usize; 2]| steps(contacts, touched) / contacts as f64;
            let pairs = of(&|i| [i / 2, i / 2]);
            let chain = of(&|i| [i, i + 1]);
            let backwards = of(&|i| [contacts - i, contacts - i - 1]);
            let jumbled = of(&|i| [i * JUMBLE % contacts, (i * JUMBLE + 1) % contacts]);
            let tree = of(&|i| [i, i / 2]);
            for steps in [pairs, chain, backwards, jumbled, tree] {
                assert!(steps < 6.0, "{contacts} contacts: {steps} steps each");
            }
        }
    }
}
