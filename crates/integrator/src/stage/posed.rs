//! The numbers of a contact problem with its rules: of all contacts of a stage, or of an island of them.

use super::Rule;
use crate::contact::tangential;
use crate::{Coupling, Vector};
use teeter_contact::{Block, BlockSparse, ContactProblem, Delassus, Incidence, ProblemError};

/// What the law of a contact acts on, beside what the solver sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Posed<const D: usize> {
    pub(crate) u_before: Vector<D>,
    pub(crate) u_free: Vector<D>,
    pub(crate) shift: Vector<D>,
    pub(crate) rule: Rule<D>,
    /// μ of the law.
    pub(crate) friction: f64,
    /// Whether a guard has changed what holds for it.
    pub(crate) guarded: bool,
}

/// A contact problem with its rules. Impulses stand where a solver starts, and at last where it ended.
#[derive(Clone, Debug, Default)]
pub(crate) struct Problem<const D: usize> {
    /// H, all blocks by rows, unless it is sparse.
    pub(crate) blocks: Vec<Block<D>>,
    /// H of many contacts that feel few others; then the rules are the standard one.
    sparse: BlockSparse<D>,
    is_sparse: bool,
    pub(crate) posed: Vec<Posed<D>>,
    /// U_free + s.
    pub(crate) q: Vec<Vector<D>>,
    pub(crate) mu: Vec<f64>,
    pub(crate) p: Vec<Vector<D>>,
}

impl<const D: usize> Problem<D> {
    pub(crate) fn reserve(&mut self, contacts: usize) {
        let more = |len: usize| contacts.saturating_sub(len);
        self.posed.reserve(more(self.posed.len()));
        self.q.reserve(more(self.q.len()));
        self.mu.reserve(more(self.mu.len()));
        self.p.reserve(more(self.p.len()));
        self.blocks.reserve((contacts * contacts).saturating_sub(self.blocks.len()));
    }

    pub(crate) fn clear(&mut self) {
        self.posed.clear();
        self.q.clear();
        self.mu.clear();
        self.p.clear();
    }

    /// Drops the contact that was added last.
    pub(crate) fn pop(&mut self) {
        self.posed.pop();
        self.q.pop();
        self.mu.pop();
        self.p.pop();
    }

    pub(crate) fn len(&self) -> usize {
        self.posed.len()
    }

    /// Adds a contact that is not posed yet.
    #[inline]
    pub(crate) fn push(&mut self, mu: f64, p: Vector<D>) {
        let zero = Vector::zeros();
        self.posed.push(Posed {
            u_before: zero,
            u_free: zero,
            shift: zero,
            rule: Rule::Unposed,
            friction: mu,
            guarded: false,
        });
        self.q.push(zero);
        self.mu.push(mu);
        self.p.push(p);
    }

    /// Becomes equal to a problem that is dense.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        let Self { blocks, posed, q, mu, p, .. } = other;
        self.is_sparse = false;
        self.blocks.clone_from(blocks);
        self.posed.clone_from(posed);
        self.q.clone_from(q);
        self.mu.clone_from(mu);
        self.p.clone_from(p);
    }

    /// Becomes the part of `whole` that its contacts `members` are, without H.
    pub(crate) fn take_part(&mut self, whole: &Self, members: &[usize]) {
        self.clear();
        for &i in members {
            self.posed.push(whole.posed[i]);
            self.q.push(whole.q[i]);
            self.mu.push(whole.mu[i]);
            self.p.push(whole.p[i]);
        }
    }

    /// Puts what was found for the part `members` of it back.
    pub(crate) fn put_part(&mut self, part: &Self, members: &[usize]) {
        for (k, &i) in members.iter().enumerate() {
            (self.p[i], self.q[i], self.mu[i], self.posed[i]) = (part.p[k], part.q[k], part.mu[k], part.posed[k]);
        }
    }

    /// H as zeros, to be added to.
    pub(crate) fn coupling(&mut self) -> Coupling<'_, D> {
        let n = self.len();
        self.is_sparse = false;
        self.blocks.clear();
        self.blocks.resize(n * n, Block::zeros());
        Coupling::dense(n, &mut self.blocks)
    }

    /// The same for contacts that feel those with which they share a key; `None` where that are so many that H is dense.
    pub(crate) fn sparse_coupling(&mut self, incidence: &Incidence) -> Option<Coupling<'_, D>> {
        self.sparse.set_pattern(incidence);
        self.is_sparse = 2 * self.sparse.blocks().len() < self.len() * self.len();
        self.is_sparse.then(|| Coupling::sparse(&mut self.sparse))
    }

    /// Adds to the block of a contact itself.
    pub(crate) fn add_own(&mut self, i: usize, block: &Block<D>) {
        let n = self.len();
        let own = if self.is_sparse { self.sparse.block_mut(i, i) } else { self.blocks.get_mut(i * n + i) };
        if let Some(own) = own {
            *own += block;
        }
    }

    fn own(&self, i: usize) -> Block<D> {
        if self.is_sparse { self.sparse.diagonal(i) } else { self.blocks[i * self.len() + i] }
    }

    /// The problem, and the impulses to start from and to leave the solution in.
    pub(crate) fn pose(&mut self) -> Result<(ContactProblem<'_, D>, &mut [Vector<D>]), ProblemError> {
        let h = if self.is_sparse { Delassus::Blocks(&self.sparse) } else { Delassus::Dense(&self.blocks) };
        let problem = ContactProblem::new(h, &self.q, &self.mu)?;
        Ok((problem, &mut self.p))
    }

    pub(crate) fn u_before(&self, i: usize) -> Vector<D> {
        self.posed[i].u_before
    }

    pub(crate) fn u_free(&self, i: usize) -> Vector<D> {
        self.posed[i].u_free
    }

    pub(crate) fn shift(&self, i: usize) -> Vector<D> {
        self.posed[i].shift
    }

    pub(crate) fn rule(&self, i: usize) -> Rule<D> {
        self.posed[i].rule
    }

    pub(crate) fn rules(&self) -> impl Iterator<Item = &Rule<D>> {
        self.posed.iter().map(|posed| &posed.rule)
    }

    /// Whether all contacts follow the standard law on their shifted velocities.
    #[inline]
    pub(crate) fn is_standard(&self) -> bool {
        self.rules().all(|rule| matches!(rule, Rule::Shifted | Rule::Frictionless))
    }

    /// Whether a contact slides in a given direction.
    pub(crate) fn has_directions(&self) -> bool {
        self.rules().any(|rule| matches!(rule, Rule::SlidesAlong(_)))
    }

    /// Gives contact `i` another shift.
    #[inline]
    pub(crate) fn reshift(&mut self, i: usize, shift: Vector<D>) {
        self.posed[i].shift = shift;
        self.q[i] = self.posed[i].u_free + shift;
    }

    /// U¹ of contact `i` by the impulses, m/s.
    pub(crate) fn velocity_by_impulses(&self, i: usize) -> Vector<D> {
        if self.is_sparse {
            return self.sparse.row(i).fold(self.posed[i].u_free, |u, (j, block)| u + block * self.p[j]);
        }
        let n = self.len();
        let row = &self.blocks[i * n..(i + 1) * n];
        row.iter().zip(&self.p).fold(self.posed[i].u_free, |u, (block, p)| u + block * p)
    }

    /// The work Ū·p of contact `i` by the impulses, Ū the mean of U⁰ and U¹, J.
    pub(crate) fn work(&self, i: usize) -> f64 {
        ((self.velocity_by_impulses(i) + self.posed[i].u_before) * 0.5).dot(&self.p[i])
    }

    /// The kinetic energy that the velocity of contact `i` carries, U⁰ or U_free, by the inertia that it feels on its own, J.
    pub(crate) fn carried(&self, i: usize) -> f64 {
        let Posed { u_before, u_free, .. } = &self.posed[i];
        0.5 * D as f64 * u_before.norm_squared().max(u_free.norm_squared()) / self.own(i).trace()
    }

    /// Marks the contacts that feel contact `i`, directly or through others, and itself. A sparse problem is one island.
    pub(crate) fn mark_island(&self, i: usize, marks: &mut Vec<bool>, reached: &mut Vec<u32>) {
        let n = self.len();
        marks.clear();
        marks.resize(n, self.is_sparse);
        reached.clear();
        if !self.is_sparse {
            marks[i] = true;
            reached.push(i as u32);
        }
        while let Some(k) = reached.pop() {
            let k = k as usize;
            for j in 0..n {
                if !marks[j] && self.blocks[k * n + j] != Block::<D>::zeros() {
                    marks[j] = true;
                    reached.push(j as u32);
                }
            }
        }
    }

    /// U_t¹ of contact `i` had it no friction of its own, m/s; the others' impulses as they are.
    pub(crate) fn without_own_friction(&self, i: usize) -> Vector<D> {
        let own = self.own(i);
        tangential(&(self.velocity_by_impulses(i) - own * tangential(&self.p[i])))
    }
}
