//! A beam in few coordinates: its lowest modes, and static corrections for where it is touched.
//!
//! ```text
//! q ≈ Φ η,   ΦᵀM Φ = 1,   ΦᵀK Φ = diag ω²        Φ from the first modes and, for points x_r, ψ_r = K⁻¹(1 − M Φ Φᵀ) N(x_r)ᵀ
//! ```
//!
//! ψ_r is what the modes leave out of the deflection under a force at x_r (residual flexibility:
//! MacNeal 1971, doi 10.1016/0045-7949(71)90031-9; as basis vectors: Rose 1991, "Using residual
//! vectors in MSC/NASTRAN dynamic analysis to improve accuracy"). The ψ_r are orthonormalised and
//! diagonalised in (M, K) with the modes, so that all coordinates stay uncoupled: the eigenmodes
//! are as they were, and the corrections are pseudo-modes above them.
//!
//! How good such a basis is for a contact region is measured by the point flexibility F(x, x), the
//! static deflection at x under a unit force at x, of which a smaller space never has more:
//!
//! ```text
//! e = max over x in [x0, x1] of (F(x, x) − F_Φ(x, x)) / F(x, x),     F_Φ(x, x) = Σ_{ω_i > 0} φ_i(x)²/ω_i²
//! ```
//!
//! x runs over 65 points of equal distance, the region's ends among them. Of a beam that can move
//! rigidly F is that of its elastic modes. Where F is 0, on a support, nothing is asked.

use crate::beam::Beam;
use crate::eigen::block::{Orthonormal, VectorBlock, add, dot, mass_product, orthonormalised, ritz};
use crate::eigen::inverse::Inverse;
use crate::eigen::{Modes, unknowns};
use crate::error::{ModalError, ModesError};
use crate::factor::MatrixWeights;

/// Points of a contact region at which the flexibility is compared.
const SAMPLES: usize = 65;

/// Modes that are worked out at first; twice as many while they are too few.
const FIRST_POOL: usize = 16;

/// Off-diagonal damping that counts as none, relative to the diagonal: far above rounding, far
/// below what would be felt.
const UNCOUPLED: f64 = 1e-8;

/// Rounds for a static correction: each divides its error by (ω² + σ)/σ of the first mode that is
/// left out.
const MAX_ROUNDS: usize = 60;

/// A correction of which no more than this is new is one that the others contain.
const DEPENDENT: f64 = 1e-7;

/// What a static correction may lack, relative to itself.
const SETTLED: f64 = 1e-9;

/// Mass-orthonormal, stiffness-orthogonal shapes of a beam, the lowest modes first.
///
/// ```
/// # use teeter_beam::{Beam, BeamSpec, ModalBasis, Section};
/// # let beam = Beam::new(BeamSpec::new(0.36, 400, Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?))?;
/// let basis = ModalBasis::for_tolerance(&beam, [0.15, 0.21], 1e-4)?;
/// assert!(basis.truncation_error(&beam, [0.15, 0.21])? <= 1e-4);
/// assert!(basis.len() < 20);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ModalBasis {
    frequencies: Vec<f64>,
    shapes: VectorBlock,
    rigid: usize,
    modes: usize,
}

impl ModalBasis {
    /// The first `modes` modes, rigid motions included, and a static correction for a force at each
    /// of `points` (m).
    ///
    /// A correction that the others already contain (of a point on a support, of a point twice) is
    /// left out.
    ///
    /// # Errors
    /// [`ModalError`]: as [`Beam::modes`]; for a point that is not on the beam.
    pub fn new(beam: &Beam, modes: usize, points: &[f64]) -> Result<Self, ModalError> {
        let all = unknowns(beam);
        if modes == 0 || modes > all {
            return Err(ModesError::Count { count: modes, unknowns: all }.into());
        }
        let pool = Pool::new(beam, modes.max(FIRST_POOL).min(all))?;
        pool.basis(modes, points)
    }

    /// The fewest shapes with [`ModalBasis::truncation_error`] ≤ `tolerance` over the contact
    /// region `[x0, x1]` (m).
    ///
    /// # Errors
    /// [`ModalError`]: as [`Beam::modes`]; for a region that is not on the beam, or a tolerance
    /// outside [1e-8, 1).
    pub fn for_tolerance(beam: &Beam, region: [f64; 2], tolerance: f64) -> Result<Self, ModalError> {
        // The digits of the flexibilities that are compared.
        if !(1e-8..1.0).contains(&tolerance) {
            return Err(ModalError::Tolerance { tolerance });
        }
        let samples = samples(beam, region)?;
        let all = unknowns(beam);
        let mut size = FIRST_POOL.min(all);
        loop {
            let pool = Pool::new(beam, size)?;
            let flexibility = Flexibility::new(&pool, &samples)?;
            let choice = (pool.modes.rigid().max(1)..=size)
                .filter_map(|modes| Some((modes, flexibility.corrections(modes, tolerance)?)))
                .min_by_key(|(modes, points)| (modes + points.len(), points.len()));
            match choice {
                // More modes than the pool has would be more shapes than these.
                Some((modes, points)) if modes + points.len() <= size || size == all => {
                    return pool.basis(modes, &points.iter().map(|point| samples[*point]).collect::<Vec<_>>());
                }
                _ if size == all => return Err(ModalError::Tolerance { tolerance }),
                _ => size = (2 * size).min(all),
            }
        }
    }

    /// How many shapes there are.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "there is always one")]
    pub fn len(&self) -> usize {
        self.frequencies.len()
    }

    /// How many of them are eigenmodes of the beam, rigid motions included; the others are static
    /// corrections.
    #[must_use]
    pub fn modes(&self) -> usize {
        self.modes
    }

    /// How many of them are rigid motions.
    #[must_use]
    pub fn rigid(&self) -> usize {
        self.rigid
    }

    /// Circular frequencies, rad/s, ascending, of modes and corrections; 0 for rigid motions.
    #[must_use]
    pub fn circular_frequencies(&self) -> &[f64] {
        &self.frequencies
    }

    /// Shape number `index`, of [`Beam::dofs`] entries, 1/√kg (1/(m √kg) for slopes).
    ///
    /// # Panics
    /// If there is no such shape.
    #[must_use]
    pub fn shape(&self, index: usize) -> &[f64] {
        self.shapes.column(index)
    }

    /// The modal coordinates ΦᵀM q (m √kg) of the motion in this basis that is nearest to `q` in
    /// kinetic energy.
    ///
    /// # Panics
    /// If `q` has not [`Beam::dofs`] entries.
    #[must_use]
    pub fn coordinates(&self, beam: &Beam, q: &[f64]) -> Vec<f64> {
        let momentum = mass_product(beam, q);
        self.shapes.iter().map(|shape| dot(shape, &momentum)).collect()
    }

    /// The dofs Φ η of the beam for modal coordinates.
    ///
    /// # Panics
    /// If there are more coordinates than shapes.
    #[must_use]
    pub fn dofs(&self, coordinates: &[f64]) -> Vec<f64> {
        let mut q = vec![0.0; self.shape(0).len()];
        self.expand(coordinates, &mut q);
        q
    }

    /// Writes the dofs Φ η of the beam for modal coordinates into `q`; allocates nothing.
    ///
    /// # Panics
    /// If there are more coordinates than shapes, or `q` has not [`Beam::dofs`] entries.
    pub fn expand(&self, coordinates: &[f64], q: &mut [f64]) {
        q.fill(0.0);
        for (index, coordinate) in coordinates.iter().enumerate() {
            add(*coordinate, self.shape(index), q);
        }
    }

    /// The diagonal of ΦᵀC Φ, 1/s: 2ζω of each coordinate.
    ///
    /// # Errors
    /// [`ModalError::CoupledDamping`] where C couples the coordinates: it does not if it is a
    /// combination of M and K.
    pub fn damping(&self, beam: &Beam) -> Result<Vec<f64>, ModalError> {
        let mut diagonal = Vec::with_capacity(self.len());
        let mut upper = Vec::with_capacity(self.len());
        for (i, shape) in self.shapes.iter().enumerate() {
            let mut force = vec![0.0; shape.len()];
            beam.add_damping_product(1.0, shape, &mut force);
            diagonal.push(dot(shape, &force));
            upper.push((i + 1..self.len()).map(|j| dot(self.shape(j), &force)).collect::<Vec<_>>());
        }
        for (i, row) in upper.iter().enumerate() {
            for (j, coupling) in (i + 1..).zip(row) {
                let relative = coupling.abs() / (diagonal[i] * diagonal[j]).sqrt();
                if relative > UNCOUPLED {
                    return Err(ModalError::CoupledDamping { first: i, second: j, relative });
                }
            }
        }
        Ok(diagonal)
    }

    /// The largest relative error e of the static point flexibility over the contact region
    /// `[x0, x1]` (m) of the beam that the basis was made of: (F(x, x) − F_Φ(x, x))/F(x, x) at 65
    /// points of equal distance.
    ///
    /// # Errors
    /// [`ModalError`]: as [`Beam::modes`]; for a region that is not on the beam.
    pub fn truncation_error(&self, beam: &Beam, region: [f64; 2]) -> Result<f64, ModalError> {
        let samples = samples(beam, region)?;
        let pool = Pool::new(beam, self.modes.max(FIRST_POOL).min(unknowns(beam)))?;
        let flexibility = Flexibility::new(&pool, &samples)?;
        let elastic = self.rigid..self.len();
        let contained = samples.iter().map(|x| {
            let shape = beam.shape_clamped(*x);
            elastic.clone().map(|i| (shape.deflection(self.shape(i)).w / self.frequencies[i]).powi(2)).sum::<f64>()
        });
        let missing: Vec<f64> =
            flexibility.full.iter().zip(contained).map(|(full, contained)| full - contained).collect();
        Ok(worst(&flexibility.full, &missing).1)
    }
}

impl ModalBasis {
    /// As [`ModalBasis::truncation_error`], for what decides an impact: the largest relative error
    /// over the region of N W Nᵀ, the velocity at x after a unit impulse at x in a step with
    /// W = (mass M + damping C + stiffness K)⁻¹.
    ///
    /// It falls off only past the modes with ω above the reciprocal of the step, so a basis for
    /// impacts is larger than one for contact that lasts.
    ///
    /// # Errors
    /// [`ModalError`]: for a region that is not on the beam, weights without an inverse, coupled
    /// damping.
    pub fn impact_error(&self, beam: &Beam, region: [f64; 2], weights: MatrixWeights) -> Result<f64, ModalError> {
        let factor = beam.factor(weights)?;
        let damping = self.damping(beam)?;
        let diagonal: Vec<f64> = self
            .frequencies
            .iter()
            .zip(&damping)
            .map(|(omega, d)| weights.mass + weights.damping * d + weights.stiffness * omega * omega)
            .collect();
        let (mut full, mut missing) = (Vec::new(), Vec::new());
        for x in samples(beam, region)? {
            let shape = beam.shape_clamped(x);
            let mut jump = vec![0.0; beam.dofs()];
            shape.add_load(1.0, 0.0, &mut jump);
            factor.solve(&mut jump);
            let contained = self.shapes.iter().zip(&diagonal).map(|(phi, d)| shape.deflection(phi).w.powi(2) / d);
            full.push(shape.deflection(&jump).w);
            missing.push(full[full.len() - 1] - contained.sum::<f64>());
        }
        Ok(worst(&full, &missing).1)
    }
}

/// The point at which the most of `full` is missing, and how much of it.
fn worst(full: &[f64], missing: &[f64]) -> (usize, f64) {
    // On a support nothing moves, or by some rounding of what moves elsewhere.
    let held = 1e-12 * full.iter().copied().fold(0.0, f64::max);
    let mut worst = (0, 0.0);
    for (s, (missing, full)) in missing.iter().zip(full).enumerate() {
        if *full > held && missing / full > worst.1 {
            worst = (s, missing / full);
        }
    }
    worst
}

/// The points of a region at which flexibilities are compared.
fn samples(beam: &Beam, region: [f64; 2]) -> Result<Vec<f64>, ModalError> {
    let [from, to] = region;
    if beam.shape_at(from).is_none() || beam.shape_at(to).is_none() || from > to {
        return Err(ModalError::Region { from, to, span: beam.spec().span });
    }
    if from == to {
        return Ok(vec![from]);
    }
    let step = (to - from) / (SAMPLES - 1) as f64;
    Ok((0..SAMPLES).map(|s| (from + s as f64 * step).min(to)).collect())
}

/// The first modes of a beam, and what solves for what they leave out.
struct Pool<'a> {
    beam: &'a Beam,
    inverse: Inverse<'a>,
    modes: Modes,
    shapes: Orthonormal,
}

impl<'a> Pool<'a> {
    fn new(beam: &'a Beam, size: usize) -> Result<Self, ModalError> {
        if beam.is_stretched() {
            return Err(ModalError::Stretched);
        }
        let modes = beam.modes(size)?;
        let inverse = Inverse::new(beam).map_err(ModesError::from)?;
        let shapes = Orthonormal::new(beam, modes.shapes.clone());
        Ok(Self { beam, inverse, modes, shapes })
    }

    /// K⁻¹(1 − M Φ Φᵀ) N(x)ᵀ, Φ all modes of the pool: ψ ← ψ + P(K + σM)⁻¹(f − K ψ), P = 1 − Φ ΦᵀM.
    fn rest(&self, x: f64) -> Result<Vec<f64>, ModalError> {
        let beam = self.beam;
        let shape = beam.shape_at(x).ok_or(ModalError::Point { x, span: beam.spec().span })?;
        let mut psi = vec![0.0; beam.dofs()];
        if self.modes.count() == unknowns(beam) {
            return Ok(psi);
        }
        let mut force = vec![0.0; beam.dofs()];
        shape.add_load(1.0, 0.0, &mut force);
        for (phi, momentum) in self.shapes.vectors.iter().zip(self.shapes.momenta.iter()) {
            add(-shape.deflection(phi).w, momentum, &mut force);
        }
        let mut last = f64::INFINITY;
        for _ in 0..MAX_ROUNDS {
            let mut change = force.clone();
            beam.add_stiffness_product(-1.0, &psi, &mut change);
            self.inverse.solve_once(&mut change);
            self.shapes.remove_from(&mut change);
            add(1.0, &change, &mut psi);
            let energy = beam.stiffness_form(&psi);
            let size = if energy == 0.0 { 0.0 } else { (beam.stiffness_form(&change) / energy).sqrt() };
            let shrinks = size < 0.9 * last;
            last = size;
            if !shrinks || size <= f64::EPSILON {
                break;
            }
        }
        // Also false for NaN.
        if last <= SETTLED { Ok(psi) } else { Err(ModalError::Correction { x, last }) }
    }

    /// The first `count` modes with the corrections for `points`.
    fn basis(&self, count: usize, points: &[f64]) -> Result<ModalBasis, ModalError> {
        let omega = self.modes.circular_frequencies();
        let mut shapes = self.modes.shapes.clone();
        shapes.truncate(count);
        let mut corrections = VectorBlock::new(self.beam.dofs());
        for x in points {
            let mut psi = self.rest(*x)?;
            let shape = self.beam.shape_clamped(*x);
            // Of rigid motions that are left out there is no static deflection.
            for i in count.max(self.modes.rigid())..omega.len() {
                let phi = self.modes.shape(i);
                add(shape.deflection(phi).w / (omega[i] * omega[i]), phi, &mut psi);
            }
            corrections.push(&psi);
        }
        let known = Orthonormal::new(self.beam, shapes.clone());
        let (values, corrections) = ritz(self.beam, &orthonormalised(self.beam, &known, &corrections, DEPENDENT));
        let mut frequencies = omega[..count].to_vec();
        frequencies.extend(values.iter().map(|value| value.sqrt()));
        shapes.append(&corrections);
        Ok(ModalBasis { frequencies, shapes, rigid: self.modes.rigid().min(count), modes: count })
    }
}

/// The static flexibilities between sample points.
struct Flexibility {
    /// F(x_s, x_s).
    full: Vec<f64>,
    /// Of what the pool leaves out, by rows.
    rest: Vec<f64>,
    /// φ_i(x_s)/ω_i, mode by mode of the pool; 0 for rigid motions.
    waves: Vec<Vec<f64>>,
}

impl Flexibility {
    fn new(pool: &Pool<'_>, samples: &[f64]) -> Result<Self, ModalError> {
        let shapes: Vec<_> = samples.iter().map(|x| pool.beam.shape_clamped(*x)).collect();
        let mut rest = Vec::with_capacity(samples.len() * samples.len());
        for x in samples {
            let psi = pool.rest(*x)?;
            rest.extend(shapes.iter().map(|shape| shape.deflection(&psi).w));
        }
        let omega = pool.modes.circular_frequencies().iter().enumerate();
        let waves: Vec<Vec<f64>> = omega
            .map(|(i, omega)| {
                let over = if *omega == 0.0 { 0.0 } else { omega.recip() };
                shapes.iter().map(|shape| shape.deflection(pool.modes.shape(i)).w * over).collect()
            })
            .collect();
        let mut flexibility = Self { full: vec![0.0; samples.len()], rest, waves };
        flexibility.full = (0..samples.len()).map(|s| flexibility.left_out(0, s, s)).collect();
        Ok(flexibility)
    }

    /// The flexibility between two samples that the first `modes` modes leave out.
    fn left_out(&self, modes: usize, s: usize, t: usize) -> f64 {
        self.rest[s * self.full.len() + t] + self.waves[modes..].iter().map(|wave| wave[s] * wave[t]).sum::<f64>()
    }

    /// The samples, at most as many as there are modes, whose corrections bring the first `modes`
    /// modes to the tolerance.
    ///
    /// What corrections for the samples R leave of the flexibility G that the modes left out is the
    /// Schur complement G − G_·R G_RR⁻¹ G_R·, for ψ_rᵀK ψ_s = G_rs; so this is a pivoted Cholesky
    /// factorisation of G.
    fn corrections(&self, modes: usize, tolerance: f64) -> Option<Vec<usize>> {
        let count = self.full.len();
        let mut missing: Vec<f64> = (0..count).map(|s| self.left_out(modes, s, s)).collect();
        let (mut chosen, mut columns) = (Vec::new(), Vec::<Vec<f64>>::new());
        loop {
            let (r, error) = worst(&self.full, &missing);
            if error <= tolerance {
                return Some(chosen);
            }
            if chosen.len() == modes {
                return None;
            }
            let scale = missing[r].sqrt().recip();
            let column: Vec<f64> = (0..count)
                .map(|s| scale * (self.left_out(modes, s, r) - columns.iter().map(|c| c[s] * c[r]).sum::<f64>()))
                .collect();
            missing.iter_mut().zip(&column).for_each(|(missing, c)| *missing -= c * c);
            chosen.push(r);
            columns.push(column);
        }
    }
}
