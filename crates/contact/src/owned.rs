//! A contact problem that owns its data.

use crate::{Block, BlockSparse, ContactProblem, Delassus, Islands, ProblemError, Vector};

/// Islands of block-sparse problems of up to this many contacts are stored dense, which takes less
/// memory than index lists.
const DENSE_UP_TO: usize = 16;

/// A frictional contact problem with its data, dense or block-sparse; [`OwnedProblem::problem`] is
/// what solvers take.
///
/// Its data are checked when it is made, as by [`ContactProblem::new`], so borrowing it can't fail.
/// The default has no contacts.
///
/// ```
/// use nalgebra::{Matrix2, Vector2};
/// use teeter_contact::{OwnedProblem, judge};
///
/// let owned = OwnedProblem::dense(vec![Matrix2::identity()], vec![Vector2::new(-1.0, 2.0)], vec![0.5])?;
/// assert!(judge(&owned.problem(), &[Vector2::new(1.0, -0.5)]).global < 1e-15);
/// # Ok::<(), teeter_contact::ProblemError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct OwnedProblem<const D: usize> {
    storage: Storage,
    /// Both storages are kept, so that switching between them allocates nothing.
    dense: Vec<Block<D>>,
    sparse: BlockSparse<D>,
    q: Vec<Vector<D>>,
    mu: Vec<f64>,
}

/// Which of the two holds H.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Storage {
    #[default]
    Dense,
    Sparse,
}

impl<const D: usize> OwnedProblem<D> {
    /// A problem of all n × n blocks, by rows: 1/kg; `q` in m/s, `mu` without unit.
    ///
    /// # Errors
    /// As [`ContactProblem::new`].
    pub fn dense(h: Vec<Block<D>>, q: Vec<Vector<D>>, mu: Vec<f64>) -> Result<Self, ProblemError> {
        ContactProblem::new(Delassus::Dense(&h), &q, &mu)?;
        Ok(Self { storage: Storage::Dense, dense: h, sparse: BlockSparse::default(), q, mu })
    }

    /// A problem of a block-sparse operator: 1/kg; `q` in m/s, `mu` without unit.
    ///
    /// # Errors
    /// As [`ContactProblem::new`].
    pub fn sparse(h: BlockSparse<D>, q: Vec<Vector<D>>, mu: Vec<f64>) -> Result<Self, ProblemError> {
        ContactProblem::new(Delassus::Blocks(&h), &q, &mu)?;
        Ok(Self { storage: Storage::Sparse, dense: Vec::new(), sparse: h, q, mu })
    }

    /// The same problem with `shift` added to q, contact by contact; m/s. Newton's impact law with
    /// restitution e adds e times the normal velocity before the impact where that is an approach.
    ///
    /// # Errors
    /// If there isn't one vector a contact, or a sum is not finite.
    pub fn shifted(mut self, shift: &[Vector<D>]) -> Result<Self, ProblemError> {
        let contacts = self.contacts();
        if shift.len() != contacts {
            let (what, found, expected) = ("the shift", shift.len(), contacts);
            return Err(ProblemError::Size { what, found, expected, contacts });
        }
        for (contact, (q, shift)) in self.q.iter_mut().zip(shift).enumerate() {
            *q += shift;
            if let Some(&value) = q.iter().find(|x| !x.is_finite()) {
                return Err(ProblemError::NotFinite { what: "q", contact, value });
            }
        }
        Ok(self)
    }

    /// The problem, borrowing this data.
    #[must_use]
    pub fn problem(&self) -> ContactProblem<'_, D> {
        let h = match self.storage {
            Storage::Dense => Delassus::Dense(&self.dense),
            Storage::Sparse => Delassus::Blocks(&self.sparse),
        };
        ContactProblem::checked_before(h, &self.q, &self.mu)
    }

    /// Number of contacts.
    #[must_use]
    pub fn contacts(&self) -> usize {
        self.q.len()
    }

    /// Copies one island of a problem, in memory that is kept: its contacts in the order of
    /// [`Islands::members`], its H dense if the problem's is or if it is small, else block-sparse.
    /// `islands` must be those of `problem`.
    ///
    /// A matrix-free operator can't be taken apart: returns `false`, and leaves this as it was.
    ///
    /// # Panics
    /// If there is no such island, or `islands` are those of another number of contacts: a mistake
    /// of the calling code.
    pub fn take_island(&mut self, problem: &ContactProblem<'_, D>, islands: &Islands, island: usize) -> bool {
        assert_eq!(islands.contacts(), problem.contacts(), "the islands of this problem");
        let members = islands.members(island);
        let n = members.len();
        let place = |j: usize| (islands.island_of(j) == island).then(|| islands.place_of(j));
        match problem.delassus() {
            Delassus::Dense(blocks) => {
                self.storage = Storage::Dense;
                self.dense.clear();
                for &i in members {
                    self.dense.extend(members.iter().map(|&j| blocks[i * problem.contacts() + j]));
                }
            }
            Delassus::Blocks(h) if n <= DENSE_UP_TO => {
                self.storage = Storage::Dense;
                self.dense.clear();
                self.dense.resize(n * n, Block::zeros());
                for (row, &i) in members.iter().enumerate() {
                    for (j, block) in h.row(i) {
                        if let Some(column) = place(j) {
                            self.dense[row * n + column] = *block;
                        }
                    }
                }
            }
            Delassus::Blocks(h) => {
                self.storage = Storage::Sparse;
                self.sparse.take_island(h, members, place);
            }
            Delassus::Operator(_) => return false,
        }
        self.q.clear();
        self.q.extend(members.iter().map(|&i| problem.q()[i]));
        self.mu.clear();
        self.mu.extend(members.iter().map(|&i| problem.mu()[i]));
        true
    }

    /// Makes room for problems of up to `contacts` contacts and `blocks` blocks, however they are
    /// stored.
    pub fn reserve(&mut self, contacts: usize, blocks: usize) {
        let small = contacts.min(DENSE_UP_TO).pow(2);
        let dense = contacts.saturating_mul(contacts).min(blocks).max(small);
        self.dense.reserve(dense.saturating_sub(self.dense.len()));
        self.sparse.reserve(contacts, blocks);
        self.q.reserve(contacts.saturating_sub(self.q.len()));
        self.mu.reserve(contacts.saturating_sub(self.mu.len()));
    }
}
