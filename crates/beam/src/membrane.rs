//! Stretching of a beam whose ends are held along its axis (von Kármán's membrane term,
//! Woinowsky-Krieger 1950).
//!
//! With the axial inertia left out the axial force is the same all along, N = N₀ + EA/(2L) s with
//! s = ∫w'² dx = qᵀG q. N₀ is in K; what is left has the potential and force
//!
//! ```text
//! V = EA/(8L) s²        −∂V/∂q = −EA/(2L) s G q
//! ```
//!
//! A step takes the mean of the tension at its ends, with the slopes of q̄ = ½(q⁰ + q¹):
//!
//! ```text
//! N̄ = EA/(4L) (s⁰ + s¹)        s¹ − s⁰ = 2 q̄ᵀG Δq        work of −N̄ G q̄: −Δ(EA/(8L) s²) = −ΔV
//! ```
//!
//! So V itself is kept, whatever the step's length (the discrete gradient of Gonzalez 1996, doi
//! 10.1007/BF02440162, here exact because V is a function of one form). N̄ is an unknown of the
//! step: [`Beam::refactor_stretched`](crate::Beam::refactor_stretched) is what it is found by.
//!
//! A step that is to be linear in v¹ takes the force at q* = q⁰ + ½h v⁰ and adds EA/L (Gq*)(Gq*)ᵀ,
//! a matrix of rank one, to K ([`Beam::follow`](crate::Beam::follow)). It keeps another energy
//! exactly: with σ = s − ¼h² vᵀG v,
//!
//! ```text
//! σ¹ − σ⁰ = 2 (Gq*)ᵀΔq        force on the step: −EA/(4L) (σ⁰ + σ¹) Gq*        its work: −Δ(EA/(8L) σ²)
//! ```
//!
//! because q̄ − q* = ¼h Δv and Δq = ½h(v⁰ + v¹). So EA/(8L) σ², never negative, takes the place of
//! V, from which it differs by O(h²); no iteration, and bounded for every h. Not accurate for every
//! h: modes with ωh ≫ 1 that ring, v changing its sign in every step, take (ωh/2)² times from σ, and
//! so from N, what they add to s.
//! (Auxiliary variables of this kind: Yang 2016, doi 10.1016/j.jcp.2016.09.029; that this one is a
//! function of q and v, and so can't drift, is peculiar to the quartic potential.)

use crate::blocks::Blocks;
use crate::field::Natural;

/// The membrane term of a beam.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Membrane {
    /// G.
    pub(crate) slopes: Natural,
    /// G assembled, for factors.
    pub(crate) matrix: Blocks,
    /// EA/L, N/m.
    pub(crate) stiffness: f64,
}

impl Membrane {
    /// What the deflection adds to the axial force, N.
    pub(crate) fn force(&self, q: &[[f64; 2]]) -> f64 {
        0.5 * self.stiffness * self.slopes.form(q)
    }

    /// V, J.
    pub(crate) fn energy(&self, q: &[[f64; 2]]) -> f64 {
        let s = self.slopes.form(q);
        0.125 * self.stiffness * s * s
    }

    /// EA/(8L) σ² − V, J: what the step of size h keeps in place of V, less V.
    pub(crate) fn modification(&self, h: f64, q: &[[f64; 2]], v: &[[f64; 2]]) -> f64 {
        let (s, less) = (self.slopes.form(q), 0.25 * h * h * self.slopes.form(v));
        // (s − r)² − s², with the difference taken first.
        0.125 * self.stiffness * less * (less - 2.0 * s)
    }
}
