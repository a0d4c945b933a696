//! The contact problem: a Delassus operator, a constant vector, friction coefficients; checked
//! once.

use crate::{Block, Delassus, Vector};

/// A frictional contact problem of `n` contacts in D dimensions; see the crate's page for the law.
///
/// [`ContactProblem::new`] checks sizes, finiteness, `μ ≥ 0`, and that each contact has a positive
/// normal and no negative tangential compliance, so a solver can rely on them. Symmetry and
/// definiteness of `H` are not required.
#[derive(Clone, Copy, Debug)]
pub struct ContactProblem<'a, const D: usize> {
    h: Delassus<'a, D>,
    q: &'a [Vector<D>],
    mu: &'a [f64],
}

/// What is wrong with the data of a contact problem.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProblemError {
    /// Sizes that don't belong together.
    #[error("{what} has {found} entries, but a problem of {contacts} contacts needs {expected}")]
    Size {
        /// Which of the data.
        what: &'static str,
        /// Entries found.
        found: usize,
        /// Entries needed.
        expected: usize,
        /// Number of contacts, from `q`.
        contacts: usize,
    },
    /// A number that is not finite.
    #[error("{what} of contact {contact} is {value}, but must be finite")]
    NotFinite {
        /// Which of the data.
        what: &'static str,
        /// The contact (the row, for the Delassus operator).
        contact: usize,
        /// The offending number.
        value: f64,
    },
    /// A negative friction coefficient.
    #[error("the friction coefficient of contact {contact} is {value}, but must be at least 0")]
    NegativeFriction {
        /// The contact.
        contact: usize,
        /// Its coefficient.
        value: f64,
    },
    /// A negative tangential compliance: the contact would move against a tangential impulse.
    #[error("the tangential compliance H_TT of contact {contact} is {value} 1/kg, but must not be negative")]
    TangentPushesBack {
        /// The contact.
        contact: usize,
        /// Its tangential compliance.
        value: f64,
    },
    /// A Jacobian's column beyond the given velocities.
    #[error("the Jacobian of contact {contact} has column {column}, but there are {velocities} velocities")]
    NoSuchVelocity {
        /// The contact.
        contact: usize,
        /// The column.
        column: usize,
        /// Number of velocities.
        velocities: usize,
    },
    /// A diagonal inverse mass of another length than the velocities.
    #[error("the inverse mass has {found} entries, but there are {velocities} velocities")]
    InverseMassSize {
        /// Entries found.
        found: usize,
        /// Number of velocities.
        velocities: usize,
    },
    /// Blocks that don't form a matrix.
    #[error(transparent)]
    Blocks(#[from] crate::BlockSparseError),
    /// A normal compliance that is not positive: nothing can move along the contact's normal, or it
    /// would move against the impulse.
    #[error("the normal compliance H_NN of contact {contact} is {value} 1/kg, but must be greater than 0")]
    NotCompliant {
        /// The contact.
        contact: usize,
        /// Its normal compliance.
        value: f64,
    },
}

impl<'a, const D: usize> ContactProblem<'a, D> {
    /// Poses the problem of `q.len()` contacts: `h` in 1/kg, `q` in m/s, `mu` without unit.
    ///
    /// # Errors
    /// If sizes differ, a number is not finite, a friction coefficient is negative, `H_NN ≤ 0` for
    /// a contact, or `H_TT < 0`.
    #[inline]
    pub fn new(h: Delassus<'a, D>, q: &'a [Vector<D>], mu: &'a [f64]) -> Result<Self, ProblemError> {
        if is_problem(h, q, mu) { Ok(Self { h, q, mu }) } else { Err(what_is_wrong(h, q, mu)) }
    }

    /// A problem whose data [`Self::new`] has checked before.
    pub(crate) fn checked_before(h: Delassus<'a, D>, q: &'a [Vector<D>], mu: &'a [f64]) -> Self {
        Self { h, q, mu }
    }

    /// Number of contacts.
    #[inline]
    #[must_use]
    pub fn contacts(&self) -> usize {
        self.q.len()
    }

    /// The Delassus operator, 1/kg.
    #[inline]
    #[must_use]
    pub fn delassus(&self) -> Delassus<'a, D> {
        self.h
    }

    /// The constant vector, m/s: the free velocity plus what the impact law adds.
    #[inline]
    #[must_use]
    pub fn q(&self) -> &'a [Vector<D>] {
        self.q
    }

    /// The friction coefficients.
    #[inline]
    #[must_use]
    pub fn mu(&self) -> &'a [f64] {
        self.mu
    }

    /// `ρ = 1/mean(diag H)`, the mass that turns a velocity into an impulse of the problem's size;
    /// kg. 1 without contacts.
    #[must_use]
    pub fn scale(&self) -> f64 {
        let trace: f64 = (0..self.contacts()).map(|i| self.diagonal(i).trace()).sum();
        if trace > 0.0 { (self.contacts() * D) as f64 / trace } else { 1.0 }
    }

    /// `‖H − Hᵀ‖ / ‖H‖` in Frobenius' norm. Asymmetry is reported, never refused: two fifths of the
    /// published problems have some.
    #[must_use]
    pub fn asymmetry(&self) -> f64 {
        if let Delassus::Blocks(h) = self.h {
            return h.asymmetry();
        }
        let mut h = crate::BlockSparse::default();
        h.gather(self);
        h.asymmetry()
    }

    /// The stored blocks of row `i`: (column, block), ascending; for a dense operator all of them,
    /// zeros included. `None` for a [matrix-free](crate::DelassusOperator) operator.
    ///
    /// # Panics
    /// If there is no contact `i`: a mistake of the calling code.
    #[inline]
    #[must_use]
    pub fn row(&self, i: usize) -> Option<impl ExactSizeIterator<Item = (usize, &'a Block<D>)> + use<'a, D>> {
        let (columns, blocks) = match self.h {
            Delassus::Dense(blocks) => (None, &blocks[i * self.q.len()..(i + 1) * self.q.len()]),
            Delassus::Blocks(h) => (Some(&h.columns()[h.range(i)]), &h.blocks()[h.range(i)]),
            Delassus::Operator(_) => return None,
        };
        let column = move |k: usize| columns.map_or(k, |columns| columns[k]);
        Some(blocks.iter().enumerate().map(move |(k, block)| (column(k), block)))
    }

    /// The block (i, j), zero where it isn't stored. `None` for a
    /// [matrix-free](crate::DelassusOperator) operator.
    ///
    /// # Panics
    /// If there is no contact `i` or, for a dense operator, no contact `j`: a mistake of the
    /// calling code.
    #[inline]
    #[must_use]
    pub fn block(&self, i: usize, j: usize) -> Option<Block<D>> {
        match self.h {
            Delassus::Dense(blocks) => Some(blocks[i * self.q.len()..(i + 1) * self.q.len()][j]),
            Delassus::Blocks(h) => Some(h.block(i, j).copied().unwrap_or_else(Block::zeros)),
            Delassus::Operator(_) => None,
        }
    }

    /// Number of non-zero blocks of H: the cost of a sweep over the problem. `None` for a
    /// [matrix-free](crate::DelassusOperator) operator.
    #[must_use]
    pub fn nonzero_blocks(&self) -> Option<usize> {
        let blocks = match self.h {
            Delassus::Dense(blocks) => blocks,
            Delassus::Blocks(h) => h.blocks(),
            Delassus::Operator(_) => return None,
        };
        Some(blocks.iter().filter(|block| block.iter().any(|&c| c != 0.0)).count())
    }

    /// `‖q‖`, Euclidean, over all contacts; m/s.
    #[must_use]
    pub fn q_norm(&self) -> f64 {
        self.q.iter().map(Vector::norm_squared).sum::<f64>().sqrt()
    }

    /// `‖H‖` in Frobenius' norm, 1/kg. `None` for a [matrix-free](crate::DelassusOperator)
    /// operator.
    #[must_use]
    pub fn h_norm(&self) -> Option<f64> {
        let blocks = match self.h {
            Delassus::Dense(blocks) => blocks,
            Delassus::Blocks(h) => h.blocks(),
            Delassus::Operator(_) => return None,
        };
        Some(blocks.iter().map(Block::norm_squared).sum::<f64>().sqrt())
    }

    /// The diagonal block of contact `i`.
    #[inline]
    #[must_use]
    pub fn diagonal(&self, i: usize) -> Block<D> {
        self.h.diagonal(i, self.q.len())
    }

    /// The velocity `u_i = Σ_j H_ij p_j + q_i` at contact `i`; `p` holds all impulses.
    ///
    /// # Panics
    /// If `p` doesn't hold one impulse a contact, or there is no contact `i`: a mistake of the
    /// calling code.
    #[inline(always)] // A call takes longer than the product of two or three blocks.
    #[must_use]
    pub fn velocity(&self, i: usize, p: &[Vector<D>]) -> Vector<D> {
        assert_eq!(p.len(), self.q.len(), "one impulse a contact");
        self.h.row_product(i, p) + self.q[i]
    }

    /// All velocities: `u = H p + q`.
    ///
    /// # Panics
    /// If `p` or `u` doesn't hold one vector a contact: a mistake of the calling code.
    pub fn velocities(&self, p: &[Vector<D>], u: &mut [Vector<D>]) {
        assert_eq!(u.len(), self.q.len(), "one velocity a contact");
        for (i, u) in u.iter_mut().enumerate() {
            *u = self.velocity(i, p);
        }
    }
}

/// Whether these are the data of a problem.
#[inline(always)]
fn is_problem<const D: usize>(h: Delassus<'_, D>, q: &[Vector<D>], mu: &[f64]) -> bool {
    let contacts = q.len();
    let (sizes, h_nothing) = match h {
        Delassus::Dense(blocks) => (blocks.len() == contacts * contacts, nothing_of(blocks)),
        Delassus::Blocks(sparse) => (sparse.contacts() == contacts, nothing_of(sparse.blocks())),
        Delassus::Operator(operator) => (operator.contacts() == contacts, 0.0),
    };
    let mut good = sizes && mu.len() == contacts && h_nothing == 0.0;
    if good {
        for i in 0..contacts {
            good &= is_contact(&h.diagonal(i, contacts), &q[i], mu[i]);
        }
    }
    good
}

/// Σ 0 · x over all numbers: 0 if they are finite, else NaN.
#[inline]
fn nothing_of<const D: usize>(blocks: &[Block<D>]) -> f64 {
    let mut nothing = 0.0;
    for block in blocks {
        for column in &block.data.0 {
            for x in column {
                nothing += 0.0 * x;
            }
        }
    }
    nothing
}

/// Whether the numbers of a contact are those of one. Written so that NaN fails, and without a branch.
#[inline]
fn is_contact<const D: usize>(own: &Block<D>, q: &Vector<D>, mu: f64) -> bool {
    // Σ 0 · x, which is 0 if all are finite.
    let mut nothing = 0.0 * mu;
    let mut good = (mu >= 0.0) & (own.data.0[0][0] > 0.0);
    for k in 0..D {
        nothing += 0.0 * q.data.0[0][k] + 0.0 * own.data.0[k][k];
        good &= own.data.0[k][k] >= 0.0;
    }
    good & (nothing == 0.0)
}

/// The first fault of a problem's data that [`ContactProblem::new`] has refused.
#[cold]
fn what_is_wrong<const D: usize>(h: Delassus<'_, D>, q: &[Vector<D>], mu: &[f64]) -> ProblemError {
    let contacts = q.len();
    let h_size = match h {
        Delassus::Dense(blocks) => ("the dense Delassus operator", blocks.len(), contacts * contacts),
        Delassus::Blocks(sparse) => ("the block-sparse Delassus operator (rows)", sparse.contacts(), contacts),
        Delassus::Operator(operator) => ("the Delassus operator", operator.contacts(), contacts),
    };
    for (what, found, expected) in [("mu", mu.len(), contacts), h_size] {
        if found != expected {
            return ProblemError::Size { what, found, expected, contacts };
        }
    }
    let not_finite = |values: &[f64]| values.iter().copied().find(|x| !x.is_finite());
    let (blocks, row): (&[Block<D>], &dyn Fn(usize) -> usize) = match &h {
        Delassus::Dense(blocks) => (blocks, &|k| k / contacts),
        Delassus::Blocks(sparse) => (sparse.blocks(), &|k| sparse.row_of(k)),
        Delassus::Operator(_) => (&[], &|k| k),
    };
    for (k, block) in blocks.iter().enumerate() {
        if let Some(value) = not_finite(block.as_slice()) {
            return ProblemError::NotFinite { what: "the Delassus operator", contact: row(k), value };
        }
    }
    for contact in 0..contacts {
        if let Some(value) = not_finite(q[contact].as_slice()) {
            return ProblemError::NotFinite { what: "q", contact, value };
        }
        let value = mu[contact];
        if !value.is_finite() {
            return ProblemError::NotFinite { what: "mu", contact, value };
        }
        if value < 0.0 {
            return ProblemError::NegativeFriction { contact, value };
        }
        let diagonal = h.diagonal(contact, contacts);
        let value = diagonal[(0, 0)];
        if !(value > 0.0 && value < f64::INFINITY) {
            return ProblemError::NotCompliant { contact, value };
        }
        for k in 1..D {
            let value = diagonal[(k, k)];
            if !(0.0..f64::INFINITY).contains(&value) {
                return ProblemError::TangentPushesBack { contact, value };
            }
        }
    }
    // An operator that gives other numbers the second time.
    ProblemError::NotFinite { what: "the Delassus operator", contact: 0, value: f64::NAN }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix2, Vector2};

    #[test]
    fn wrong_data_is_refused_with_the_contact_and_the_number() {
        let one = Matrix2::identity();
        let q = [Vector2::zeros(), Vector2::zeros()];
        let good = [one, Matrix2::zeros(), Matrix2::zeros(), one];
        assert!(ContactProblem::new(Delassus::Dense(&good), &q, &[0.1, 0.2]).is_ok());
        let error = |h: &[Matrix2<f64>], q: &[Vector2<f64>], mu: &[f64]| {
            ContactProblem::new(Delassus::Dense(h), q, mu).unwrap_err().to_string()
        };
        assert_eq!(
            error(&good[..3], &q, &[0.1, 0.2]),
            "the dense Delassus operator has 3 entries, but a problem of 2 contacts needs 4"
        );
        assert_eq!(error(&good, &q, &[0.1]), "mu has 1 entries, but a problem of 2 contacts needs 2");
        assert!(error(&good, &q, &[0.1, -0.2]).contains("contact 1 is -0.2"));
        assert!(error(&good, &q, &[f64::NAN, 0.2]).contains("mu of contact 0 is NaN"));
        let bad_q = [Vector2::zeros(), Vector2::new(0.0, f64::INFINITY)];
        assert!(error(&good, &bad_q, &[0.1, 0.2]).contains("q of contact 1 is inf"));
        let mut rigid = good;
        rigid[3][(0, 0)] = 0.0;
        assert!(error(&rigid, &q, &[0.1, 0.2]).contains("H_NN of contact 1 is 0"));
        let mut back = good;
        back[3][(1, 1)] = -2.0;
        assert!(error(&back, &q, &[0.1, 0.2]).contains("H_TT of contact 1 is -2"));
        rigid[2][(1, 0)] = f64::NAN;
        assert!(error(&rigid, &q, &[0.1, 0.2]).contains("the Delassus operator of contact 1 is NaN"));
    }

    #[test]
    fn all_shapes_of_the_operator_give_the_same_velocity() {
        struct Product(Vec<Matrix2<f64>>);
        impl crate::DelassusOperator<2> for Product {
            fn contacts(&self) -> usize {
                2
            }
            fn diagonal(&self, i: usize) -> Matrix2<f64> {
                self.0[3 * i]
            }
            fn row_product(&self, i: usize, p: &[Vector2<f64>]) -> Vector2<f64> {
                self.0[2 * i] * p[0] + self.0[2 * i + 1] * p[1]
            }
        }
        let blocks: Vec<_> = (0..4).map(|k| Matrix2::identity() * 2.0 + Matrix2::repeat(0.1 * f64::from(k))).collect();
        let rows: Vec<_> = (0..2).map(|i| (0..2).map(|j| (j, blocks[2 * i + j])).collect()).collect();
        let sparse = crate::BlockSparse::from_rows(&rows).unwrap();
        let operator = Product(blocks.clone());
        let q = [Vector2::new(0.1, 0.2), Vector2::new(-0.3, 0.4)];
        let p = [Vector2::new(1.0, 2.0), Vector2::new(3.0, -4.0)];
        let of = |h| ContactProblem::new(h, &q, &[0.1, 0.1]).map(|c| (c.velocity(0, &p), c.velocity(1, &p))).unwrap();
        let dense = of(Delassus::Dense(&blocks));
        assert_eq!(dense, of(Delassus::Blocks(&sparse)));
        assert_eq!(dense, of(Delassus::Operator(&operator)));
    }
}
