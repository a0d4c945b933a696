//! Motion of a subsystem over a time under constant forces, in closed form.

use crate::{Coupling, PartRows, Vector};

/// What a step of a [`Propagator`] took from the energy, J; both are at least 0 but for rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Dissipated {
    /// By damping.
    pub viscous: f64,
    /// By what filters motions that the step is too long for.
    pub filtered: f64,
}

impl Dissipated {
    /// These two, J.
    #[must_use]
    pub fn new(viscous: f64, filtered: f64) -> Self {
        Self { viscous, filtered }
    }
}

/// Motion of a subsystem over a time h under its own forces and others that are constant over it,
/// without the error of a quadrature: that of a linear structure in its modes.
///
/// What constant forces F add to the place at the end is D F, D symmetric. It is given as if by a
/// velocity: the motion ends at q¹ = q⁰ + h(v⁰ + ṽ¹)/2, and impulses p = hF of contacts add
/// (2/h²) D Jᵀp to ṽ¹. For a body whose velocity changes evenly ṽ¹ is v¹; elsewhere the true
/// velocity is known at the [`end`](Self::end).
///
/// Oscillations that go far round within h can't be followed by who acts once in that time. Their
/// deviation from equilibrium is multiplied by exp(−(ωh/χ)⁸), χ the `cutoff`: so the fastest follow
/// the forces as if they had no mass.
///
/// A scheme calls `take` and `begin`, then `couple` and `respond` as often as it likes, and `end`
/// with the impulses that it found.
pub trait Propagator<const D: usize>: Send + Sync {
    /// From now on the time is `h` (s), with this cutoff χ. Allocates nothing if few different ones
    /// alternate.
    fn take(&mut self, h: f64, cutoff: f64);

    /// Starts from (q, v) with a constant load (N), and writes ṽ¹ without contacts.
    fn begin(&mut self, q: &[f64], v: &[f64], load: &[f64], v_free: &mut [f64]);

    /// Adds (2/h²) J_i D J_jᵀ for all pairs of rows.
    fn couple(&mut self, rows: &PartRows<'_, D>, h: &mut Coupling<'_, D>);

    /// Adds (1/h) J_i V J_jᵀ for all pairs of rows, V what constant forces do to the true velocity at
    /// the end.
    fn couple_rates(&mut self, rows: &PartRows<'_, D>, h: &mut Coupling<'_, D>);

    /// Adds (2/h²) D Jᵀp to `v`, p the impulses of all contacts of the model, N·s.
    fn respond(&mut self, rows: &PartRows<'_, D>, p: &[Vector<D>], v: &mut [f64]);

    /// Writes the velocities at the end of a motion with these impulses over it, and its mean
    /// coordinates q̄: those by which M(v¹ − v⁰)/h + C(q¹ − q⁰)/h + f(q̄) = F.
    fn end(&mut self, rows: &PartRows<'_, D>, p: &[Vector<D>], v: &mut [f64], mean: &mut [f64]) -> Dissipated;
}
