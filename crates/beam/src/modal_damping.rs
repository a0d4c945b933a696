//! Damping ratios of single modes on the elements: C = Σ 2ζ_i ω_i (Mφ_i)(Mφ_i)ᵀ, a matrix of low
//! rank.
//!
//! It damps the modes that it names and no other one. In a factor it is carried by Woodbury's
//! identity: with A = B + U D Uᵀ, U = (Mφ_i), D = diag(c·2ζ_i ω_i) and Y = B⁻¹U,
//!
//! ```text
//! A⁻¹f = x − Y (D⁻¹ + UᵀY)⁻¹ Uᵀx,        x = B⁻¹f
//! ```

use crate::beam::Beam;
use crate::eigen::block::{dot, mass_product};
use crate::error::BeamError;

/// Damping ratios of modes, as a part of C.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ModalDamping {
    /// 2ζω of each damped mode, 1/s.
    rates: Vec<f64>,
    /// φ, one after another.
    shapes: Vec<f64>,
    /// Mφ, one after another.
    momenta: Vec<f64>,
    dofs: usize,
}

impl ModalDamping {
    /// The ratios of the first elastic modes of a beam.
    pub(crate) fn new(beam: &Beam, ratios: &[f64]) -> Result<Self, BeamError> {
        let rigid = beam.modes(1).map(|modes| if modes.rigid() > 0 { 2 } else { 0 });
        let count = rigid.as_ref().map_or(0, |most| ratios.len() + most).min(beam.free_dofs());
        let too_many = BeamError::Count {
            field: "damping.modal",
            value: ratios.len(),
            rule: "as many ratios as the mesh has modes that can be found, or fewer",
        };
        let modes = beam.modes(count).map_err(|_| too_many.clone())?;
        if ratios.len() > modes.count() - modes.rigid() {
            return Err(too_many);
        }
        let (mut rates, mut shapes, mut momenta) = (Vec::new(), Vec::new(), Vec::new());
        for (k, zeta) in ratios.iter().enumerate().filter(|(_, zeta)| **zeta > 0.0) {
            let mode = modes.rigid() + k;
            rates.push(2.0 * zeta * modes.circular_frequencies()[mode]);
            shapes.extend_from_slice(modes.shape(mode));
            momenta.extend(mass_product(beam, modes.shape(mode)));
        }
        Ok(Self { rates, shapes, momenta, dofs: beam.dofs() })
    }

    /// How many modes it damps.
    pub(crate) fn modes(&self) -> usize {
        self.rates.len()
    }

    fn momenta(&self) -> impl Iterator<Item = (f64, &[f64])> {
        self.rates.iter().copied().zip(self.momenta.chunks_exact(self.dofs))
    }

    /// y += a C x.
    pub(crate) fn add_product(&self, a: f64, x: &[f64], y: &mut [f64]) {
        for (rate, momentum) in self.momenta() {
            let along = a * rate * dot(momentum, x);
            y.iter_mut().zip(momentum).for_each(|(y, m)| *y += along * m);
        }
    }

    /// vᵀC v.
    pub(crate) fn form(&self, v: &[f64]) -> f64 {
        self.momenta().map(|(rate, momentum)| rate * dot(momentum, v) * dot(momentum, v)).sum()
    }

    /// Adds M⁻¹C v to `a`: the deceleration that it makes.
    pub(crate) fn add_deceleration(&self, v: &[f64], a: &mut [f64]) {
        let shapes = self.shapes.chunks_exact(self.dofs);
        for ((rate, momentum), shape) in self.momenta().zip(shapes) {
            let along = rate * dot(momentum, v);
            a.iter_mut().zip(shape).for_each(|(a, shape)| *a += along * shape);
        }
    }
}

/// What Woodbury's identity needs of one factor.
#[derive(Debug)]
pub(crate) struct LowRank {
    /// Mφ of the damped modes.
    momenta: Vec<f64>,
    /// B⁻¹Mφ.
    responses: Vec<f64>,
    /// (D⁻¹ + UᵀY)⁻¹ by rows; 0 where the weight of C is.
    core: Vec<f64>,
    work: Vec<f64>,
    dofs: usize,
}

impl LowRank {
    pub(crate) fn new(damping: &ModalDamping) -> Self {
        let k = damping.rates.len();
        let responses = vec![0.0; damping.momenta.len()];
        let momenta = damping.momenta.clone();
        Self { momenta, responses, core: vec![0.0; k * k], work: vec![0.0; 2 * k * k], dofs: damping.dofs }
    }

    pub(crate) fn modes(&self) -> usize {
        self.momenta.len() / self.dofs
    }

    /// Takes the numbers of a factor B, given by its solve, for a weight of C.
    pub(crate) fn update(&mut self, damping: &ModalDamping, weight: f64, solve: impl Fn(&mut [f64])) {
        let (k, n) = (damping.rates.len(), self.dofs);
        self.core.fill(0.0);
        if weight == 0.0 {
            return;
        }
        self.momenta.copy_from_slice(&damping.momenta);
        self.responses.copy_from_slice(&damping.momenta);
        self.responses.chunks_exact_mut(n).for_each(&solve);
        // Scaled by √D on both sides: 1 + √D UᵀY √D is as well conditioned as can be, whatever the
        // ratios.
        let root = |i: usize| (weight * damping.rates[i]).sqrt();
        let matrix = &mut self.work;
        for i in 0..k {
            for j in 0..k {
                let y = &self.responses[j * n..(j + 1) * n];
                let coupled = root(i) * root(j) * dot(&self.momenta[i * n..(i + 1) * n], y);
                matrix[2 * k * i + j] = coupled + if i == j { 1.0 } else { 0.0 };
                matrix[2 * k * i + k + j] = if i == j { 1.0 } else { 0.0 };
            }
        }
        // Gauss–Jordan; a symmetric positive definite matrix needs no pivoting.
        for p in 0..k {
            let pivot = 1.0 / matrix[2 * k * p + p];
            (0..2 * k).for_each(|j| matrix[2 * k * p + j] *= pivot);
            for i in (0..k).filter(|i| *i != p) {
                let factor = matrix[2 * k * i + p];
                (0..2 * k).for_each(|j| matrix[2 * k * i + j] -= factor * matrix[2 * k * p + j]);
            }
        }
        for i in 0..k {
            for j in 0..k {
                self.core[k * i + j] = root(i) * matrix[2 * k * i + k + j] * root(j);
            }
        }
    }

    /// x ← x − Y (D⁻¹ + UᵀY)⁻¹ Uᵀx.
    pub(crate) fn correct(&self, x: &mut [f64]) {
        let n = self.dofs;
        if self.core.first().is_none_or(|first| *first == 0.0) {
            return;
        }
        // Y C (Uᵀx) by symmetry as U's products first, one response at a time; nothing is allocated
        // for at most MOST modes.
        let mut along = [0.0; MOST];
        let k = self.modes();
        for (along, momentum) in along.iter_mut().zip(self.momenta.chunks_exact(n)) {
            *along = dot(momentum, x);
        }
        for (i, response) in self.responses.chunks_exact(n).enumerate() {
            let part: f64 = self.core[k * i..k * (i + 1)].iter().zip(&along).map(|(c, a)| c * a).sum();
            x.iter_mut().zip(response).for_each(|(x, y)| *x -= part * y);
        }
    }
}

/// Most modes with ratios of their own.
pub(crate) const MOST: usize = 64;

#[cfg(test)]
mod tests {
    use crate::beam::tests::{spec, wave};
    use crate::{Backend, Beam, Damping, MatrixWeights, Support};

    fn beam(supports: [Support; 2], damping: Damping) -> Beam {
        Beam::new(spec(12, supports).damped(damping)).unwrap()
    }

    #[test]
    fn it_damps_the_modes_that_it_names_by_their_ratios_and_no_other() {
        let ratios = [0.02, 0.0, 0.3];
        for supports in [[Support::Pinned; 2], [Support::Free; 2], [Support::Clamped, Support::Free]] {
            let beam = beam(supports, Damping { modal: ratios.to_vec(), ..Damping::default() });
            let modes = beam.modes(8).unwrap();
            for k in 0..6 {
                let mode = modes.rigid() + k;
                let phi = modes.shape(mode);
                let expected = 2.0 * ratios.get(k).copied().unwrap_or(0.0) * modes.circular_frequencies()[mode];
                assert!((beam.damping_power(phi) - expected).abs() < 1e-8 * modes.circular_frequencies()[mode]);
            }
        }
    }

    #[test]
    fn a_factor_undoes_the_products_with_it() {
        let all =
            Damping { viscous: 0.7, rayleigh_stiffness: 0.01, modal: vec![0.05, 0.6, 0.01], ..Damping::default() };
        let beam = beam([Support::Pinned, Support::Clamped], all);
        for damping in [0.0, 5e-3, 0.5] {
            let w = MatrixWeights { mass: 1.0, damping, stiffness: 2.5e-5 };
            let x = wave(&beam);
            let mut f = vec![0.0; beam.dofs()];
            beam.add_mass_product(w.mass, &x, &mut f);
            beam.add_damping_product(w.damping, &x, &mut f);
            beam.add_stiffness_product(w.stiffness, &x, &mut f);
            for &backend in Backend::available() {
                let mut f = f.clone();
                beam.factor_with(w, backend).unwrap().solve(&mut f);
                assert!(f.iter().zip(&x).all(|(f, x)| (f - x).abs() < 1e-9), "{backend:?} {damping}");
            }
        }
    }

    #[test]
    fn more_ratios_than_modes_are_refused() {
        let damping = Damping { modal: vec![0.01; 40], ..Damping::default() };
        let text = Beam::new(spec(12, [Support::Pinned; 2]).damped(damping)).unwrap_err().to_string();
        assert!(text.starts_with("damping.modal = 40"), "{text}");
    }
}
