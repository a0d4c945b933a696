//! Products with M, C and K, and the energies, element by element without the assembled matrices.

use crate::beam::Beam;

/// y += a D x for a diagonal D by its entries.
fn add_diagonal(a: f64, entries: &[(usize, f64)], x: &[f64], y: &mut [f64]) {
    for &(dof, value) in entries {
        y[dof] += a * value * x[dof];
    }
}

fn diagonal_form(entries: &[(usize, f64)], x: &[f64]) -> f64 {
    entries.iter().map(|&(dof, value)| value * x[dof] * x[dof]).sum()
}

impl Beam {
    /// y += a M x.
    ///
    /// # Panics
    /// If `x` or `y` has not [`Beam::dofs`] entries.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Section, Support};
    /// # let beam = Beam::new(BeamSpec::new(1.0, 4, Section::new(1.0, 3.0)?).supported([Support::Free; 2]))?;
    /// let translation = beam.from_nodes(&[[1.0, 0.0]; 5])?;
    /// let mut momentum = vec![0.0; beam.dofs()];
    /// beam.add_mass_product(1.0, &translation, &mut momentum);
    /// let total: f64 = momentum.iter().step_by(2).sum();
    /// assert!((total - 3.0).abs() < 1e-14);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn add_mass_product(&self, a: f64, x: &[f64], y: &mut [f64]) {
        self.add_bending_mass_product(a, x, y);
        if let Some(bar) = &self.bar {
            let (_, axial) = self.split_mut(y);
            bar.add_mass_product(a, &x[2 * self.nodes()..], axial);
        }
    }

    fn add_bending_mass_product(&self, a: f64, x: &[f64], y: &mut [f64]) {
        self.mass.add_product(a, self.bend(x), self.split_mut(y).0);
        add_diagonal(a, &self.lumps, x, y);
    }

    /// y += a C x, with C = c ∫NᵀN dx + a₀M + a₁K and the dashpots of supports and foundations.
    ///
    /// # Panics
    /// If `x` or `y` has not [`Beam::dofs`] entries.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Damping, Section, Support};
    /// # let spec = BeamSpec::new(1.0, 4, Section::new(1.0, 3.0)?).supported([Support::Free; 2]);
    /// let beam = Beam::new(spec.damped(Damping::none().with_viscous(2.0)))?;
    /// let falling = beam.from_nodes(&[[-1.0, 0.0]; 5])?;
    /// let mut force = vec![0.0; beam.dofs()];
    /// beam.add_damping_product(-1.0, &falling, &mut force);
    /// let total: f64 = force.iter().step_by(2).sum();
    /// assert!((total - 2.0).abs() < 1e-14);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn add_damping_product(&self, a: f64, x: &[f64], y: &mut [f64]) {
        if self.damping_of_mass != 0.0 {
            self.add_bending_mass_product(a * self.damping_of_mass, x, y);
        }
        self.add_damping_product_beside_mass(a, x, y);
    }

    /// α, 1/s, where C = αM and nothing else; else 0.
    pub fn mass_damping(&self) -> f64 {
        let others = self.spec.damping.rayleigh_stiffness != 0.0 || self.c.is_some() || self.modal.is_some();
        // Viscous damping leaves axial motion alone.
        if others || self.bar.is_some() { 0.0 } else { self.damping_of_mass }
    }

    /// y += a C x, without the multiple of M in bending.
    fn add_damping_product_beside_mass(&self, a: f64, x: &[f64], y: &mut [f64]) {
        if let Some(bar) = &self.bar
            && self.spec.damping.rayleigh_mass != 0.0
        {
            let (_, axial) = self.split_mut(y);
            bar.add_mass_product(a * self.spec.damping.rayleigh_mass, &x[2 * self.nodes()..], axial);
        }
        let a1 = self.spec.damping.rayleigh_stiffness;
        if a1 != 0.0 {
            self.add_stiffness_product(a * a1, x, y);
        }
        if let Some(residual) = &self.residual_damping {
            residual.add_product(a, self.bend(x), self.split_mut(y).0);
        }
        add_diagonal(a, &self.dashpots, x, y);
        if let Some(modal) = &self.modal {
            modal.add_product(a, x, y);
        }
    }

    /// y += a K x, element by element through the two natural deformations ψ₂ − ψ₁ and
    /// ψ₁ + ψ₂ − 2(w₂ − w₁)/l.
    ///
    /// A row of the assembled K cancels the rigid motion of the neighbourhood only after it was
    /// multiplied by EI/l³: the force of a smooth shape on n elements gets a relative error of
    /// about ε n⁴. Here the differences are taken first, which leaves about ε n². (That is the
    /// product's own rounding. Rounding the entries of `x` changes the exact product by up to ε n⁴
    /// too, and no formula can undo that.)
    ///
    /// # Panics
    /// If `x` or `y` has not [`Beam::dofs`] entries.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Section, Support};
    /// # let beam = Beam::new(BeamSpec::new(1.0, 4, Section::new(1.0, 3.0)?).supported([Support::Free; 2]))?;
    /// let turned = beam.from_nodes(&[[0.0, 1.0], [0.25, 1.0], [0.5, 1.0], [0.75, 1.0], [1.0, 1.0]])?;
    /// let mut force = vec![0.0; beam.dofs()];
    /// beam.add_stiffness_product(1.0, &turned, &mut force);
    /// assert!(force.iter().all(|f| *f == 0.0));
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn add_stiffness_product(&self, a: f64, x: &[f64], y: &mut [f64]) {
        let (bend, axial) = self.split_mut(y);
        self.bending.add_product(a, self.bend(x), bend);
        if let Some(foundation) = &self.foundation {
            foundation.add_product(a, self.bend(x), bend);
        }
        if let Some(bar) = &self.bar {
            bar.add_stiffness_product(a, &x[2 * self.nodes()..], axial);
        }
        add_diagonal(a, &self.springs, x, y);
    }

    /// ½ vᵀM v, J: a sum of squares, never negative.
    ///
    /// # Panics
    /// If `v` has not [`Beam::dofs`] entries.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Section, Support};
    /// # let beam = Beam::new(BeamSpec::new(1.0, 4, Section::new(1.0, 3.0)?).supported([Support::Free; 2]))?;
    /// let v = beam.from_nodes(&[[2.0, 0.0]; 5])?;
    /// assert!((beam.kinetic_energy(&v) - 6.0).abs() < 1e-14);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn kinetic_energy(&self, v: &[f64]) -> f64 {
        let axial = self.bar.as_ref().map_or(0.0, |bar| bar.mass_form(&v[2 * self.nodes()..]));
        0.5 * (self.bending_mass_form(v) + axial)
    }

    fn bending_mass_form(&self, v: &[f64]) -> f64 {
        self.mass.form(self.bend(v)) + diagonal_form(&self.lumps, v)
    }

    /// vᵀC v, W: what damping takes at velocity v.
    ///
    /// # Panics
    /// If `v` has not [`Beam::dofs`] entries.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Damping, Section, Support};
    /// # let spec = BeamSpec::new(1.0, 4, Section::new(1.0, 3.0)?).supported([Support::Free; 2]);
    /// let beam = Beam::new(spec.damped(Damping::none().with_viscous(2.0)))?;
    /// let rising = beam.from_nodes(&[[3.0, 0.0]; 5])?;
    /// assert!((beam.damping_power(&rising) - 18.0).abs() < 1e-13);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn damping_power(&self, v: &[f64]) -> f64 {
        let mut power = 0.0;
        if self.damping_of_mass != 0.0 {
            power += self.damping_of_mass * self.bending_mass_form(v);
        }
        if let Some(bar) = &self.bar {
            power += self.spec.damping.rayleigh_mass * bar.mass_form(&v[2 * self.nodes()..]);
        }
        let a1 = self.spec.damping.rayleigh_stiffness;
        if a1 != 0.0 {
            power += a1 * self.stiffness_form(v);
        }
        if let Some(residual) = &self.residual_damping {
            power += residual.form(self.bend(v));
        }
        if let Some(modal) = &self.modal {
            power += modal.form(v);
        }
        power + diagonal_form(&self.dashpots, v)
    }

    pub(crate) fn stiffness_form(&self, q: &[f64]) -> f64 {
        let mut form = self.bending.form(self.bend(q));
        if let Some(foundation) = &self.foundation {
            form += foundation.form(self.bend(q));
        }
        if let Some(bar) = &self.bar {
            form += bar.stiffness_form(&q[2 * self.nodes()..]);
        }
        form + diagonal_form(&self.springs, q)
    }

    /// The elastic energy, J: ½ qᵀK q from the natural deformations, EI/(2l) Σ (d₁² + 3
    /// d₂²/(1 + Φ)) and springs, foundation and axial force; exactly 0 for no deformation (see
    /// [`Beam::add_stiffness_product`]). Of a beam held along its axis also EA/(8L) (∫w'² dx)².
    ///
    /// # Panics
    /// If `q` has not [`Beam::dofs`] entries.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Section, Support};
    /// # let spec = BeamSpec::new(1.0, 4, Section::new(5.0, 3.0)?).supported([Support::Clamped, Support::Free]);
    /// # let beam = Beam::new(spec)?;
    /// // w = x²/2: unit curvature, so half the bending stiffness times the span.
    /// let nodes: Vec<_> = (0..5).map(|i| f64::from(i) / 4.0).map(|x| [0.5 * x * x, x]).collect();
    /// assert_eq!(beam.elastic_energy(&beam.from_nodes(&nodes)?), 2.5);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn elastic_energy(&self, q: &[f64]) -> f64 {
        let stretching = self.membrane.as_ref().map_or(0.0, |membrane| membrane.energy(self.bend(q)));
        0.5 * self.stiffness_form(q) + stretching
    }

    /// Adds the elastic force −K q to `f`, and of a beam held along its axis −N(q) G q, with N what
    /// the deflection adds to the axial force.
    ///
    /// # Panics
    /// If `q` or `f` has not [`Beam::dofs`] entries.
    pub fn add_elastic_force(&self, q: &[f64], f: &mut [f64]) {
        self.add_stiffness_product(-1.0, q, f);
        if let Some(membrane) = &self.membrane {
            let force = membrane.force(self.bend(q));
            membrane.slopes.add_product(-force, self.bend(q), self.split_mut(f).0);
        }
    }

    /// What a θ step of size `h` (θ = ½) with [`Beam::follow`] keeps in place of the stretching
    /// energy EA/(8L) s², less that energy, J: EA/(8L) (σ² − s²) with s = ∫w'² dx = qᵀG q and
    /// σ = s − ¼h² vᵀG v. O(h²); 0 for a beam that isn't held along its axis.
    ///
    /// # Panics
    /// If `q` or `v` has not [`Beam::dofs`] entries.
    pub fn modified_energy(&self, h: f64, q: &[f64], v: &[f64]) -> f64 {
        self.membrane.as_ref().map_or(0.0, |membrane| membrane.modification(h, self.bend(q), self.bend(v)))
    }

    /// EA/(2L), N/m, of a beam held along its axis: its deflection adds this times ∫w'² dx to the
    /// axial force. 0 for other beams.
    #[must_use]
    pub fn stretching_stiffness(&self) -> f64 {
        self.membrane.as_ref().map_or(0.0, |membrane| 0.5 * membrane.stiffness)
    }

    /// xᵀG y = ∫w_x' w_y' dx of two deflections of a beam held along its axis, m; 0 for other beams.
    ///
    /// # Panics
    /// If `x` or `y` has not [`Beam::dofs`] entries.
    #[must_use]
    pub fn slope_form(&self, x: &[f64], y: &[f64]) -> f64 {
        self.membrane.as_ref().map_or(0.0, |membrane| membrane.slopes.between(self.bend(x), self.bend(y)))
    }

    /// y += a G x of a beam held along its axis, with [`slope_form`](Beam::slope_form)'s G: under a
    /// tension of −a (N) the transverse forces on the nodes (N, N m). Nothing for other beams.
    ///
    /// # Panics
    /// If `x` or `y` has not [`Beam::dofs`] entries.
    pub fn add_slope_product(&self, a: f64, x: &[f64], y: &mut [f64]) {
        if let Some(membrane) = &self.membrane {
            membrane.slopes.add_product(a, self.bend(x), self.split_mut(y).0);
        }
    }

    /// The axial force, N, tension positive: N₀, and of a beam held along its axis what its
    /// deflection adds. Axial dofs have a force of their own in every element:
    /// [`Beam::axial_forces`].
    ///
    /// # Panics
    /// If `q` has not [`Beam::dofs`] entries.
    pub fn axial_force(&self, q: &[f64]) -> f64 {
        self.spec.axial_force + self.membrane.as_ref().map_or(0.0, |membrane| membrane.force(self.bend(q)))
    }

    /// The axial force of every element, N, tension positive.
    ///
    /// # Panics
    /// If `q` has not [`Beam::dofs`] entries.
    pub fn axial_forces(&self, q: &[f64]) -> Vec<f64> {
        let common = self.axial_force(q);
        match &self.bar {
            Some(bar) => bar.forces(&q[2 * self.nodes()..]).map(|force| common + force).collect(),
            None => vec![common; self.elements()],
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::beam::tests::{all_supports, beam, damped, furnished, wave};
    use crate::{Beam, BeamSpec, MatrixWeights};

    /// Of the assembled upper triangle, in the free dofs, with all dofs to go by.
    fn form(beam: &Beam, matrix: MatrixWeights, x: &[f64]) -> (Vec<f64>, f64) {
        let free: Vec<usize> = (0..beam.dofs()).filter(|dof| !beam.is_held(*dof)).collect();
        let mut y = vec![0.0; beam.dofs()];
        for entry in beam.matrix_entries(matrix) {
            assert!(entry.row <= entry.column);
            let (i, j) = (free[entry.row], free[entry.column]);
            y[i] += entry.value * x[j];
            if i != j {
                y[j] += entry.value * x[i];
            }
        }
        let twice = y.iter().zip(x).map(|(y, x)| y * x).sum();
        (y, twice)
    }

    /// Element by element in the loop, entry by entry in the matrix: two ways to the same product.
    #[test]
    fn products_and_energies_agree_with_the_assembled_matrices() {
        let plain = all_supports().into_iter().flat_map(|supports| [1, 2, 3, 7].map(|n| (n, supports)));
        let beams = plain
            .filter(|(n, supports)| *n > 1 || *supports != [crate::Support::Clamped; 2])
            .map(|(n, supports)| damped(n, supports))
            .chain([furnished()]);
        for beam in beams {
            let x = wave(&beam);
            let check = |matrix: MatrixWeights, product: &dyn Fn(&mut [f64])| {
                let mut y = vec![1.0; beam.dofs()];
                product(&mut y);
                let (expected, twice) = form(&beam, matrix, &x);
                let size = beam.matrix_entries(matrix).fold(1.0_f64, |m, entry| m.max(entry.value.abs()));
                for (dof, (y, e)) in y.iter().zip(&expected).enumerate() {
                    assert!(
                        beam.is_held(dof) || (y - 1.0 - 2.0 * e).abs() < 1e-14 * size,
                        "{dof} of {:?}",
                        beam.spec()
                    );
                }
                twice
            };
            let twice_kinetic = check(MatrixWeights::MASS, &|y| beam.add_mass_product(2.0, &x, y));
            let power = check(MatrixWeights::DAMPING, &|y| beam.add_damping_product(2.0, &x, y));
            let twice_elastic = check(MatrixWeights::STIFFNESS, &|y| beam.add_stiffness_product(2.0, &x, y));
            assert!((2.0 * beam.kinetic_energy(&x) / twice_kinetic - 1.0).abs() < 1e-13);
            assert!((2.0 * beam.elastic_energy(&x) / twice_elastic - 1.0).abs() < 1e-12);
            assert!((beam.damping_power(&x) / power - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn an_undamped_beam_adds_nothing() {
        let beam = beam(5, [crate::Support::Pinned; 2]);
        let mut y = vec![0.0; beam.dofs()];
        beam.add_damping_product(1.0, &wave(&beam), &mut y);
        assert!(!beam.is_damped() && y.iter().all(|y| *y == 0.0) && beam.damping_power(&wave(&beam)) == 0.0);
    }

    /// A shape whose nodal values have no rounding error, and no inner forces: w = x³ − x on 512
    /// elements. What is left is the product's own error.
    #[test]
    fn the_stiffness_product_loses_less_than_the_assembled_matrix() {
        let n = 512;
        let section = crate::Section::new(0.7, 1.0).unwrap();
        let beam = Beam::new(BeamSpec::new(1.0, n, section)).unwrap();
        let shape = |x: f64| [x * (x - 1.0) * (x + 1.0), 3.0 * x * x - 1.0];
        let nodes: Vec<[f64; 2]> = (0..=n).map(|i| shape(i as f64 / n as f64)).collect();
        let q = beam.from_nodes(&nodes).unwrap();
        let mut natural = vec![0.0; beam.dofs()];
        beam.add_stiffness_product(1.0, &q, &mut natural);
        let (matrix, _) = form(&beam, MatrixWeights::STIFFNESS, &q);
        let worst = |f: &[f64]| f[2..2 * n].iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        let (by_modes, by_matrix) = (worst(&natural), worst(&matrix));
        assert!(by_modes < 1e-12 && by_matrix > 1e-9, "{by_modes:e} {by_matrix:e}");
    }
}
