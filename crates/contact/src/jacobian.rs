//! Contact problems from Jacobian, masses and velocities: `H = J M⁻¹ Jᵀ`, `q = J v`.

use crate::{Block, BlockSparse, Incidence, OwnedProblem, ProblemError, Vector};

/// The Jacobian J of contacts, which gives their relative velocities from the velocities of bodies:
/// `u_i = Σ_c J_ic v_c`.
///
/// A contact's rows are stored by columns: for each velocity c that moves it, a vector in `R^D`,
/// normal component first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Jacobian<const D: usize> {
    /// Where the entries of each contact end.
    end: Vec<usize>,
    entries: Vec<(usize, Vector<D>)>,
}

impl<const D: usize> Jacobian<D> {
    /// A Jacobian of no contacts.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a contact by its non-zero columns, in any order: (number of the velocity, the contact's
    /// relative velocity per unit of it). Entries of a column that is given twice are added.
    pub fn push(&mut self, columns: impl IntoIterator<Item = (usize, Vector<D>)>) {
        self.entries.extend(columns);
        self.end.push(self.entries.len());
    }

    /// Number of contacts.
    #[must_use]
    pub fn contacts(&self) -> usize {
        self.end.len()
    }

    /// The columns of a contact, in the order given.
    ///
    /// # Panics
    /// If there is no such contact: a mistake of the calling code.
    #[must_use]
    pub fn row(&self, contact: usize) -> &[(usize, Vector<D>)] {
        let start = if contact == 0 { 0 } else { self.end[contact - 1] };
        &self.entries[start..self.end[contact]]
    }

    /// The velocity `J v` of a contact.
    ///
    /// # Panics
    /// If there is no such contact, or `v` is shorter than a column's number: a mistake of the
    /// calling code.
    #[must_use]
    pub fn velocity(&self, contact: usize, v: &[f64]) -> Vector<D> {
        self.row(contact).iter().fold(Vector::zeros(), |sum, (column, entry)| sum + entry * v[*column])
    }

    fn check(&self, velocities: usize) -> Result<(), ProblemError> {
        for contact in 0..self.contacts() {
            for (column, entry) in self.row(contact) {
                if *column >= velocities {
                    return Err(ProblemError::NoSuchVelocity { contact, column: *column, velocities });
                }
                if let Some(&value) = entry.iter().find(|x| !x.is_finite()) {
                    return Err(ProblemError::NotFinite { what: "the Jacobian", contact, value });
                }
            }
        }
        Ok(())
    }

    /// `H = J M⁻¹ Jᵀ` for a diagonal mass matrix: the sum of what each velocity contributes.
    fn with_diagonal(&self, inverse: &[f64]) -> Result<BlockSparse<D>, ProblemError> {
        let mut incidence = Incidence::default();
        incidence.load(self.contacts(), |i| self.row(i).iter().map(|(column, _)| *column));
        let mut h = BlockSparse::default();
        h.set_pattern(&incidence);
        let mut by_column: Vec<(usize, usize, Vector<D>)> = Vec::with_capacity(self.entries.len());
        for i in 0..self.contacts() {
            by_column.extend(self.row(i).iter().map(|(column, entry)| (*column, i, *entry)));
        }
        by_column.sort_by_key(|(column, contact, _)| (*column, *contact));
        for group in by_column.chunk_by(|a, b| a.0 == b.0) {
            for (column, i, a) in group {
                for (_, j, b) in group {
                    h.add(*i, *j, &(a * b.transpose() * inverse[*column]))?;
                }
            }
        }
        Ok(h)
    }

    /// `H = J M⁻¹ Jᵀ` by a solve with M for each column of Jᵀ; blocks that come out zero are not
    /// stored.
    fn with_solver(
        &self,
        solve: &mut dyn FnMut(&mut [f64]),
        velocities: usize,
    ) -> Result<BlockSparse<D>, ProblemError> {
        let n = self.contacts();
        let mut x = vec![0.0; velocities];
        let mut blocks: Vec<(usize, usize, Block<D>)> = Vec::new();
        let mut column = vec![Block::<D>::zeros(); n];
        for j in 0..n {
            for c in 0..D {
                x.fill(0.0);
                for (velocity, entry) in self.row(j) {
                    x[*velocity] += entry[c];
                }
                solve(&mut x);
                for (i, block) in column.iter_mut().enumerate() {
                    block.set_column(c, &self.velocity(i, &x));
                }
            }
            let stored = |i: &usize| *i == j || column[*i].iter().any(|&x| x != 0.0);
            blocks.extend((0..n).filter(stored).map(|i| (i, j, column[i])));
        }
        blocks.sort_by_key(|(i, j, _)| (*i, *j));
        let mut rows = blocks.chunk_by(|a, b| a.0 == b.0);
        let mut h = BlockSparse::default();
        h.set_rows(n, |_| rows.next().unwrap_or_default().iter().map(|(_, j, block)| (*j, *block)))?;
        Ok(h)
    }
}

/// The inverse of the mass matrix M, or of what takes its place in a time scheme, such as M + hθC +
/// h²θ²K.
#[non_exhaustive]
pub enum InverseMass<'a> {
    /// The inverse of a diagonal M, as of rigid bodies in the plane: one number a velocity, 1/kg or
    /// 1/(kg m²). Time and memory grow with the pairs of contacts that share a velocity.
    Diagonal(&'a [f64]),
    /// A function that overwrites x by M⁻¹ x; x has one number a velocity. It is called D times a
    /// contact. Time grows with the square of the number of contacts, memory with the number of
    /// non-zero blocks.
    Solver(&'a mut dyn FnMut(&mut [f64])),
}

impl std::fmt::Debug for InverseMass<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Diagonal(inverse) => f.debug_tuple("Diagonal").field(inverse).finish(),
            Self::Solver(_) => f.write_str("Solver"),
        }
    }
}

impl<const D: usize> OwnedProblem<D> {
    /// The problem of contacts with Jacobian J between bodies of mass matrix M, where `v` are the
    /// velocities without contact: `H = J M⁻¹ Jᵀ`, block-sparse, and `q = J v`. [`Self::shifted`]
    /// adds the shift of an impact law.
    ///
    /// # Errors
    /// If J has a column beyond the length of `v`, sizes differ or a number is not finite; and as
    /// [`ContactProblem::new`](crate::ContactProblem::new).
    ///
    /// ```
    /// use nalgebra::Vector2;
    /// use teeter_contact::{InverseMass, Jacobian, OwnedProblem};
    ///
    /// // A block of 2 kg and 0.5 kg m² falls at 1 m/s on two corners, 0.4 m beside and 1 m below its mass centre. Velocities: x, y, turn.
    /// let mut jacobian = Jacobian::new();
    /// for x in [-0.4, 0.4] {
    ///     jacobian.push([(0, Vector2::new(0.0, 1.0)), (1, Vector2::new(1.0, 0.0)), (2, Vector2::new(x, 1.0))]);
    /// }
    /// let inverse = InverseMass::Diagonal(&[0.5, 0.5, 2.0]);
    /// let owned = OwnedProblem::from_jacobian(&jacobian, inverse, &[0.0, -1.0, 0.0], vec![0.3; 2])?;
    /// assert_eq!(owned.problem().q()[0], Vector2::new(-1.0, 0.0));
    /// assert!((owned.problem().diagonal(0)[(0, 0)] - (0.5 + 2.0 * 0.4 * 0.4)).abs() < 1e-15);
    /// # Ok::<(), teeter_contact::ProblemError>(())
    /// ```
    pub fn from_jacobian(
        jacobian: &Jacobian<D>,
        inverse_mass: InverseMass<'_>,
        v: &[f64],
        mu: Vec<f64>,
    ) -> Result<Self, ProblemError> {
        jacobian.check(v.len())?;
        let h = match inverse_mass {
            InverseMass::Diagonal(inverse) if inverse.len() != v.len() => {
                return Err(ProblemError::InverseMassSize { found: inverse.len(), velocities: v.len() });
            }
            InverseMass::Diagonal(inverse) => jacobian.with_diagonal(inverse)?,
            InverseMass::Solver(solve) => jacobian.with_solver(solve, v.len())?,
        };
        let q = (0..jacobian.contacts()).map(|i| jacobian.velocity(i, v)).collect();
        Self::sparse(h, q, mu)
    }
}
