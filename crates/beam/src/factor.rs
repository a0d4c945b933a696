//! Factors of weighted sums of the three matrices: the effective inverse mass of a time step.

use std::fmt;

use crate::band::Twisted;
use crate::bar::BarFactor;
use crate::beam::Beam;
use crate::blocks::Blocks;
use crate::error::CholeskyError;
use crate::modal_damping::{LowRank, ModalDamping};
#[cfg(feature = "faer")]
use crate::sparse::SparseFactor;

/// The weights of `mass M + damping C + stiffness K`.
///
/// A θ step of length h wants `{ mass: 1, damping: hθ, stiffness: h²θ² }`, a static solve
/// [`MatrixWeights::STIFFNESS`], an impact [`MatrixWeights::MASS`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MatrixWeights {
    /// Weight of M.
    pub mass: f64,
    /// Weight of C.
    pub damping: f64,
    /// Weight of K.
    pub stiffness: f64,
}

/// The sum as in a formula, such as "M + 5e-5 C + 2.5e-9 K".
impl fmt::Display for MatrixWeights {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let terms = [(self.mass, "M"), (self.damping, "C"), (self.stiffness, "K")];
        let mut first = true;
        for (weight, matrix) in terms.into_iter().filter(|(weight, _)| *weight != 0.0) {
            if !first {
                f.write_str(" + ")?;
            }
            first = false;
            if weight == 1.0 { f.write_str(matrix)? } else { write!(f, "{weight:?} {matrix}")? }
        }
        if first { f.write_str("0") } else { Ok(()) }
    }
}

impl MatrixWeights {
    /// M alone.
    pub const MASS: Self = Self { mass: 1.0, damping: 0.0, stiffness: 0.0 };
    /// C alone.
    pub const DAMPING: Self = Self { mass: 0.0, damping: 1.0, stiffness: 0.0 };
    /// K alone.
    pub const STIFFNESS: Self = Self { mass: 0.0, damping: 0.0, stiffness: 1.0 };

    fn validate(&self) -> Result<(), CholeskyError> {
        for (field, value) in [("mass", self.mass), ("damping", self.damping), ("stiffness", self.stiffness)] {
            if !value.is_finite() {
                return Err(CholeskyError::Weight { field, value });
            }
        }
        Ok(())
    }
}

/// How a matrix is factorised. Both need memory linear in the number of elements and give the same
/// solutions up to rounding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Backend {
    /// In blocks of a node, from both ends to the middle: what suits a chain of elements best, two
    /// to four times faster than the general way at every size.
    #[default]
    Banded,
    /// A general sparse Cholesky factorisation, symbolic once: an independent way to the same
    /// numbers. By faer, so with the feature `faer` (default) only; without it
    /// [`Beam::factor_with`] says so ([`CholeskyError::MissingFeature`]).
    Sparse,
}

impl Backend {
    /// The backends of this build: without the feature `faer` there is no [`Backend::Sparse`] among
    /// them.
    ///
    /// ```
    /// use teeter_beam::Backend;
    /// assert!(Backend::available().contains(&Backend::default()));
    /// ```
    #[must_use]
    pub fn available() -> &'static [Self] {
        if cfg!(feature = "faer") { &[Self::Banded, Self::Sparse] } else { &[Self::Banded] }
    }
}

#[derive(Debug)]
enum Kind {
    Banded {
        bend: Twisted,
        bar: Option<BarFactor>,
        sum: Blocks,
    },
    #[cfg(feature = "faer")]
    Sparse(Box<SparseFactor>),
}

/// What the stretching of a beam held along its axis adds to the matrix: `weight` g gᵀ.
#[derive(Debug, Clone)]
struct RankOne {
    /// g = G q.
    g: Vec<f64>,
    /// A⁻¹g.
    u: Vec<f64>,
    /// weight/(1 + weight gᵀA⁻¹g); 0 until [`Beam::follow`] was called.
    scale: f64,
}

impl RankOne {
    /// Becomes `weight` g gᵀ of its g beside what `factor` is of without it.
    fn take(&mut self, weight: f64, factor: &Factor) {
        self.u.copy_from_slice(&self.g);
        factor.solve_linear(&mut self.u);
        let along: f64 = self.g.iter().zip(&self.u).map(|(g, u)| g * u).sum();
        self.scale = weight / (1.0 + weight * along);
    }
}

/// The factor of a weighted sum of M, C and K, made by [`Beam::factor`].
///
/// Solving needs no scratch and no `mut`: one factor may serve several threads.
pub struct Factor {
    weights: MatrixWeights,
    kind: Kind,
    stretch: Option<RankOne>,
    modal: Option<LowRank>,
    held: Vec<[bool; 2]>,
    dofs: usize,
}

impl fmt::Debug for Factor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Factor").field("dofs", &self.dofs).field("weights", &self.weights).finish_non_exhaustive()
    }
}

impl Factor {
    /// The weights that were factorised.
    pub fn weights(&self) -> MatrixWeights {
        self.weights
    }

    /// How it was factorised.
    pub fn backend(&self) -> Backend {
        match self.kind {
            Kind::Banded { .. } => Backend::Banded,
            #[cfg(feature = "faer")]
            Kind::Sparse(_) => Backend::Sparse,
        }
    }

    /// Length of the vectors that it solves for.
    pub fn dofs(&self) -> usize {
        self.dofs
    }

    /// f ← (mass M + damping C + stiffness K)⁻¹ f, in place, without allocation; 0 for what
    /// supports hold.
    ///
    /// # Panics
    /// If `f` has not [`Factor::dofs`] entries.
    pub fn solve(&self, f: &mut [f64]) {
        assert_eq!(f.len(), self.dofs, "a right-hand side must have one entry per degree of freedom");
        self.solve_linear(f);
        if let Some(RankOne { g, u, scale }) = &self.stretch
            && *scale != 0.0
        {
            // Sherman–Morrison.
            let along = scale * g.iter().zip(f.iter()).map(|(g, f)| g * f).sum::<f64>();
            f.iter_mut().zip(u).for_each(|(f, u)| *f -= along * u);
        }
    }

    fn solve_linear(&self, f: &mut [f64]) {
        self.solve_sum(f);
        if let Some(modal) = &self.modal {
            modal.correct(f);
        }
    }

    /// Without damping ratios of modes.
    fn solve_sum(&self, f: &mut [f64]) {
        match &self.kind {
            Kind::Banded { bend, bar, .. } => {
                let (f_bend, f_bar) = f.split_at_mut(2 * self.held.len());
                bend.solve(f_bend.as_chunks_mut().0);
                if let Some(bar) = bar {
                    bar.solve(f_bar);
                }
            }
            #[cfg(feature = "faer")]
            Kind::Sparse(sparse) => sparse.solve(f),
        }
    }

    /// Fills in the numbers of a factor whose memory is there, with N G in K of an axial force
    /// beside that of the beam.
    fn update(&mut self, beam: &Beam, weights: MatrixWeights, tension: f64) -> Result<(), CholeskyError> {
        weights.validate()?;
        self.weights = weights;
        if let Some(stretch) = &mut self.stretch {
            stretch.scale = 0.0;
        }
        let not_definite = |dof| CholeskyError::NotPositiveDefinite { weights, dof };
        match &mut self.kind {
            Kind::Banded { bend, bar, sum } => {
                beam.combine(weights, tension, sum);
                bend.factorise(sum, &beam.held).map_err(not_definite)?;
                if let (Some(factor), Some(bar)) = (bar, &beam.bar) {
                    let (mass, stiffness) = beam.axial_weights(weights);
                    let nodes = beam.nodes();
                    factor.factorise(bar, mass, stiffness).map_err(|node| not_definite(2 * nodes + node))?;
                }
            }
            #[cfg(feature = "faer")]
            Kind::Sparse(sparse) => sparse.update(beam, weights, tension).map_err(not_definite)?,
        }
        if let (Some(mut modal), Some(damping)) = (self.modal.take(), &beam.modal) {
            modal.update(damping, weights.damping, |f| self.solve_sum(f));
            self.modal = Some(modal);
        }
        Ok(())
    }
}

impl Beam {
    /// Weights of M, K and the rest of C in bending.
    fn bending_weights(&self, w: MatrixWeights) -> [f64; 3] {
        let a1 = self.spec.damping.rayleigh_stiffness;
        [w.mass + w.damping * self.damping_of_mass, w.stiffness + w.damping * a1, w.damping]
    }

    pub(crate) fn axial_weights(&self, w: MatrixWeights) -> (f64, f64) {
        let damping = &self.spec.damping;
        (w.mass + w.damping * damping.rayleigh_mass, w.stiffness + w.damping * damping.rayleigh_stiffness)
    }

    pub(crate) fn combine(&self, weights: MatrixWeights, tension: f64, sum: &mut Blocks) {
        let [m, k, c] = self.bending_weights(weights);
        match &self.c {
            Some(rest) => sum.combine(&[(m, &self.m), (k, &self.k), (c, rest)]),
            None => sum.combine(&[(m, &self.m), (k, &self.k)]),
        }
        if let (Some(membrane), true) = (&self.membrane, tension != 0.0) {
            // Not in C = a₁K, which is that of the beam without it.
            sum.add_scaled(weights.stiffness * tension, &membrane.matrix);
        }
    }

    /// The factor of `mass M + damping C + stiffness K`, in blocks from both ends
    /// ([`Backend::Banded`]).
    ///
    /// # Errors
    /// [`CholeskyError`] for weights that are not finite, or whose sum is not positive definite.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, MatrixWeights, Section};
    /// # let beam = Beam::new(BeamSpec::new(0.36, 20, Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?))?;
    /// let h = 1e-4;
    /// let w = beam.factor(MatrixWeights { mass: 1.0, damping: 0.5 * h, stiffness: 0.25 * h * h })?;
    /// let mut jump = vec![0.0; beam.dofs()];
    /// beam.add_point_load(0.18, -1e-3, &mut jump)?; // here an impulse, N s
    /// w.solve(&mut jump); // and the velocity that it gives
    /// assert!(beam.deflection_at(&jump, 0.18).is_some_and(|d| d.w < 0.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn factor(&self, weights: MatrixWeights) -> Result<Factor, CholeskyError> {
        self.factor_with(weights, Backend::default())
    }

    /// As [`Beam::factor`], factorised as one chooses.
    ///
    /// # Errors
    /// As there; [`CholeskyError::MissingFeature`] for a backend that is not in this build
    /// ([`Backend::available`]).
    pub fn factor_with(&self, weights: MatrixWeights, backend: Backend) -> Result<Factor, CholeskyError> {
        let nodes = self.nodes();
        let kind = match backend {
            Backend::Banded => Kind::Banded {
                bend: Twisted::new(nodes),
                bar: self.bar.as_ref().map(|_| BarFactor::new(nodes)),
                sum: Blocks::zero(nodes),
            },
            #[cfg(feature = "faer")]
            Backend::Sparse => Kind::Sparse(Box::new(SparseFactor::new(self)?)),
            #[cfg(not(feature = "faer"))]
            Backend::Sparse => return Err(CholeskyError::MissingFeature { backend, feature: "faer" }),
        };
        let zero = vec![0.0; self.dofs()];
        let stretch = self.membrane.is_some().then(|| RankOne { g: zero.clone(), u: zero, scale: 0.0 });
        let modal = self.modal.as_ref().map(LowRank::new);
        let mut factor = Factor { weights, kind, stretch, modal, held: self.held.clone(), dofs: self.dofs() };
        factor.update(self, weights, 0.0)?;
        Ok(factor)
    }

    /// The factor with N G in K of an axial force beside that of the beam.
    pub(crate) fn factor_under(&self, weights: MatrixWeights, tension: f64) -> Result<Factor, CholeskyError> {
        let mut factor = self.factor(weights)?;
        if tension != 0.0 {
            factor.update(self, weights, tension)?;
        }
        Ok(factor)
    }

    /// Makes `factor` that of other weights, in its own memory: no symbolic work, no allocation.
    ///
    /// # Errors
    /// As [`Beam::factor`], and [`CholeskyError::OtherBeam`] for the factor of a beam with other
    /// dofs. After [`CholeskyError::NotPositiveDefinite`] the factor's solutions are NaN until it is
    /// renewed with success.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, MatrixWeights, Section};
    /// # let beam = Beam::new(BeamSpec::new(0.36, 20, Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?))?;
    /// let mut w = beam.factor(MatrixWeights::MASS)?;
    /// beam.refactor(MatrixWeights { mass: 1.0, damping: 0.0, stiffness: 2.5e-9 }, &mut w)?;
    /// assert_eq!(w.weights().stiffness, 2.5e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn refactor(&self, weights: MatrixWeights, factor: &mut Factor) -> Result<(), CholeskyError> {
        // By what is held, not by identity: a beam of another section or span may take over the
        // memory.
        let same = self.dofs() == factor.dofs
            && self.held == factor.held
            && self.membrane.is_some() == factor.stretch.is_some()
            && self.modal.as_ref().map_or(0, ModalDamping::modes) == factor.modal.as_ref().map_or(0, LowRank::modes);
        if !same {
            return Err(CholeskyError::OtherBeam { expected: self.dofs(), found: factor.dofs });
        }
        factor.update(self, weights, 0.0)
    }

    /// Makes `factor` that of the tangent at `q`, with its own weights: of a beam held along its
    /// axis K + N(q) G + EA/L (Gq)(Gq)ᵀ in place of K, the derivative of its elastic force; of
    /// other beams what it is already. For equilibria; a time step wants [`Beam::follow`].
    ///
    /// # Errors
    /// As [`Beam::refactor`].
    ///
    /// # Panics
    /// If `q` has not [`Beam::dofs`] entries.
    pub fn refactor_tangent(&self, q: &[f64], factor: &mut Factor) -> Result<(), CholeskyError> {
        let Some(membrane) = &self.membrane else { return Ok(()) };
        factor.update(self, factor.weights, membrane.force(self.bend(q)))?;
        self.follow(q, factor);
        Ok(())
    }

    /// Makes `factor`, with its own weights m, c, k, that of
    ///
    /// ```text
    /// m M + c C + k (K + N G) + r g gᵀ
    /// ```
    ///
    /// of a beam held along its axis: N the `tension` (N) beside the beam's own axial force, G that of
    /// [`Beam::slope_form`], r the `weight` of the matrix of rank one. It is what a step is solved by
    /// whose axial force is unknown. Other beams: N and g count for nothing. Factorises, and solves
    /// once; no allocation.
    ///
    /// # Errors
    /// As [`Beam::refactor`].
    ///
    /// # Panics
    /// If `g` has not [`Beam::dofs`] entries.
    pub fn refactor_stretched(
        &self,
        tension: f64,
        weight: f64,
        g: &[f64],
        factor: &mut Factor,
    ) -> Result<(), CholeskyError> {
        factor.update(self, factor.weights, tension)?;
        if let Some(mut stretch) = factor.stretch.take() {
            stretch.g.copy_from_slice(g);
            stretch.take(weight, factor);
            factor.stretch = Some(stretch);
        }
        Ok(())
    }

    /// Takes the stretching at `q` into the factor of a beam that is held along its axis: K + EA/L
    /// (Gq)(Gq)ᵀ in place of K, with G the matrix of ∫w'² dx = qᵀG q. Nothing for other beams. One
    /// solve, no allocation.
    ///
    /// A θ step with θ = ½ that follows at q⁰ + ½h v⁰, and takes the elastic force there, keeps an
    /// energy: that of the beam with what [`Beam::modified_energy`] adds. It stays linear in the
    /// new velocity, and needs no iteration. After Yang (2016, doi 10.1016/j.jcp.2016.09.029).
    ///
    /// # Panics
    /// If `q` has not [`Beam::dofs`] entries.
    pub fn follow(&self, q: &[f64], factor: &mut Factor) {
        let (Some(membrane), Some(mut stretch)) = (&self.membrane, factor.stretch.take()) else { return };
        stretch.g.fill(0.0);
        membrane.slopes.add_product(1.0, self.bend(q), self.split_mut(&mut stretch.g).0);
        stretch.take(factor.weights.stiffness * membrane.stiffness, factor);
        factor.stretch = Some(stretch);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Support::{Clamped, Free, Pinned};
    use crate::beam::tests::{all_supports, beam, damped, furnished, spec, wave};
    use crate::{Axial, Section};

    const STEP: MatrixWeights = MatrixWeights { mass: 1.0, damping: 5e-3, stiffness: 2.5e-5 };

    #[test]
    fn solving_undoes_the_products_in_both_ways() {
        let plain = all_supports().into_iter().flat_map(|supports| [2, 3, 20].map(|n| damped(n, supports)));
        for beam in plain.chain([furnished()]) {
            let x = wave(&beam);
            let mut f = vec![0.0; beam.dofs()];
            beam.add_mass_product(STEP.mass, &x, &mut f);
            beam.add_damping_product(STEP.damping, &x, &mut f);
            beam.add_stiffness_product(STEP.stiffness, &x, &mut f);
            for &backend in Backend::available() {
                let mut f = f.clone();
                let factor = beam.factor_with(STEP, backend).unwrap();
                assert_eq!(factor.backend(), backend);
                factor.solve(&mut f);
                for (f, x) in f.iter().zip(&x) {
                    assert!((f - x).abs() < 1e-9, "{backend:?} {:?}: {f} {x}", beam.spec());
                }
            }
        }
    }

    #[test]
    fn a_renewed_factor_is_bitwise_a_new_one() {
        for &backend in Backend::available() {
            let beam = furnished();
            let mut renewed = beam.factor_with(MatrixWeights::MASS, backend).unwrap();
            beam.refactor(STEP, &mut renewed).unwrap();
            let fresh = beam.factor_with(STEP, backend).unwrap();
            let (mut a, mut b) = (wave(&beam), wave(&beam));
            renewed.solve(&mut a);
            fresh.solve(&mut b);
            assert_eq!(a, b);
            assert_eq!(renewed.weights(), STEP);
        }
    }

    #[test]
    fn bad_weights_are_refused_and_leave_no_half_factor() {
        for &backend in Backend::available() {
            let beam = beam(6, [Clamped, Free]);
            let mut factor = beam.factor_with(STEP, backend).unwrap();
            let negative = MatrixWeights { mass: -1.0, ..STEP };
            let error = beam.refactor(negative, &mut factor);
            assert!(matches!(error, Err(CholeskyError::NotPositiveDefinite { dof: 2, .. })), "{error:?}");
            let mut x = vec![1.0; beam.dofs()];
            factor.solve(&mut x);
            assert!(x[2..].iter().all(|x| x.is_nan()));
            beam.refactor(STEP, &mut factor).unwrap();
            let mut x = vec![1.0; beam.dofs()];
            factor.solve(&mut x);
            assert!(x.iter().all(|x| x.is_finite()));
            for (field, weights) in [
                ("mass", MatrixWeights { mass: f64::NAN, ..STEP }),
                ("damping", MatrixWeights { damping: f64::INFINITY, ..STEP }),
                ("stiffness", MatrixWeights { stiffness: f64::NEG_INFINITY, ..STEP }),
            ] {
                let text = beam.factor_with(weights, backend).unwrap_err().to_string();
                assert!(text.contains(field), "{text}");
            }
        }
    }

    #[test]
    fn every_backend_is_there_or_says_which_feature_it_needs() {
        let beam = beam(6, [Clamped, Free]);
        for backend in [Backend::Banded, Backend::Sparse] {
            match beam.factor_with(STEP, backend) {
                Ok(factor) => assert!(factor.backend() == backend && Backend::available().contains(&backend)),
                Err(error) => {
                    assert!(!cfg!(feature = "faer") && !Backend::available().contains(&backend));
                    assert_eq!(error, CholeskyError::MissingFeature { backend: Backend::Sparse, feature: "faer" });
                    let text = "the backend Sparse is not in this build: it needs the feature `faer` of teeter-beam";
                    assert_eq!(error.to_string(), text);
                }
            }
        }
    }

    #[test]
    fn the_factor_of_another_beam_is_refused() {
        let mut factor = beam(6, [Clamped, Free]).factor(STEP).unwrap();
        for other in [beam(7, [Clamped, Free]), beam(6, [Pinned, Pinned]), beam(6, [Free, Free])] {
            assert!(matches!(other.refactor(STEP, &mut factor), Err(CholeskyError::OtherBeam { .. })));
        }
    }

    #[test]
    fn a_factor_that_follows_has_the_stretching_in_it() {
        let section = Section::new(2.0, 3.0).unwrap().with_axial_stiffness(500.0).unwrap();
        let spec = crate::BeamSpec { section, ..spec(6, [Pinned, Clamped]) };
        let beam = Beam::new(spec.axial(Axial::Held)).unwrap();
        let q: Vec<f64> = wave(&beam).iter().map(|q| 0.1 * q).collect();
        for &backend in Backend::available() {
            let mut factor = beam.factor_with(STEP, backend).unwrap();
            beam.follow(&q, &mut factor);
            let x = wave(&beam);
            let mut f = vec![0.0; beam.dofs()];
            beam.add_mass_product(STEP.mass, &x, &mut f);
            beam.add_stiffness_product(STEP.stiffness, &x, &mut f);
            // EA/L (Gq)(Gq)ᵀ, with G q by the derivative of s = ∫w'² dx: force − linear force = −½
            // EA/L s G q.
            let (mut force, mut linear) = (vec![0.0; beam.dofs()], vec![0.0; beam.dofs()]);
            beam.add_elastic_force(&q, &mut force);
            beam.add_stiffness_product(-1.0, &q, &mut linear);
            let n = beam.axial_force(&q);
            let g: Vec<f64> = force.iter().zip(&linear).map(|(f, l)| (l - f) / n).collect();
            let along: f64 = g.iter().zip(&x).map(|(g, x)| g * x).sum();
            f.iter_mut().zip(&g).for_each(|(f, g)| *f += STEP.stiffness * 500.0 * along * g);
            factor.solve(&mut f);
            assert!(f.iter().zip(&x).all(|(f, x)| (f - x).abs() < 1e-11), "{backend:?}");
        }
    }
}
