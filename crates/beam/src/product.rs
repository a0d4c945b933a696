//! Products with M, C and K, and the two energies, without the assembled matrices.

use crate::beam::Beam;
use crate::layout::add_to_end;

impl Beam {
    /// y += a M x.
    ///
    /// # Panics
    /// If `x` or `y` has not [`Beam::dofs`] entries.
    ///
    /// ```
    /// # let beam = teeter_beam::Beam::new(teeter_beam::BeamSpec {
    /// #     span: 1.0, elements: 4, section: teeter_beam::Section::new(1.0, 3.0)?,
    /// #     supports: [teeter_beam::Support::Free; 2], damping: Default::default() })?;
    /// let translation = beam.from_nodes(&[[1.0, 0.0]; 5])?;
    /// let mut momentum = vec![0.0; beam.dofs()];
    /// beam.add_mass_product(1.0, &translation, &mut momentum);
    /// let total: f64 = momentum.iter().step_by(2).sum();
    /// assert!((total - 3.0).abs() < 1e-14);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn add_mass_product(&self, a: f64, x: &[f64], y: &mut [f64]) {
        let (x_head, x_inner, x_tail) = self.layout.split(x);
        let (y_head, y_inner, y_tail) = self.layout.split_mut(y);
        let l = self.element.length;
        // Two neighbouring elements joined: the terms 22 l between w and w' of the common node cancel.
        let m = a * self.element.mass;
        let (ml, mll) = (m * l, m * l * l);
        let inner = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
            [
                312.0 * m * q[0] + 54.0 * m * (p[0] + r[0]) + 13.0 * ml * (p[1] - r[1]),
                8.0 * mll * q[1] + 13.0 * ml * (r[0] - p[0]) - 3.0 * mll * (p[1] + r[1]),
            ]
        };
        // One element alone, seen from its node p; `side` is 1 for its left node and −1 for its right one.
        let end = |p: [f64; 2], q: [f64; 2], side: f64| {
            let (sl, ll) = (side * ml, mll);
            [
                156.0 * m * p[0] + 22.0 * sl * p[1] + 54.0 * m * q[0] - 13.0 * sl * q[1],
                22.0 * sl * p[0] + 4.0 * ll * p[1] + 13.0 * sl * q[0] - 3.0 * ll * q[1],
            ]
        };
        let last = x_inner.len();
        add_to_end(y_head, end(x_head, x_inner.first().copied().unwrap_or(x_tail), 1.0));
        add_to_end(y_tail, end(x_tail, x_inner.last().copied().unwrap_or(x_head), -1.0));
        let mut left = x_head;
        for i in 0..last {
            let here = x_inner[i];
            let right = if i + 1 < last { x_inner[i + 1] } else { x_tail };
            let f = inner(left, here, right);
            y_inner[i][0] += f[0];
            y_inner[i][1] += f[1];
            left = here;
        }
    }

    /// y += a C x, with C = c ∫NᵀN dx + a₀M + a₁K.
    ///
    /// # Panics
    /// If `x` or `y` has not [`Beam::dofs`] entries.
    ///
    /// ```
    /// # let beam = teeter_beam::Beam::new(teeter_beam::BeamSpec {
    /// #     span: 1.0, elements: 4, section: teeter_beam::Section::new(1.0, 3.0)?,
    /// #     supports: [teeter_beam::Support::Free; 2],
    /// #     damping: teeter_beam::Damping { viscous: 2.0, ..Default::default() } })?;
    /// let falling = beam.from_nodes(&[[-1.0, 0.0]; 5])?;
    /// let mut force = vec![0.0; beam.dofs()];
    /// beam.add_damping_product(-1.0, &falling, &mut force);
    /// let total: f64 = force.iter().step_by(2).sum();
    /// assert!((total - 2.0).abs() < 1e-14);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn add_damping_product(&self, a: f64, x: &[f64], y: &mut [f64]) {
        if self.damping_of_mass != 0.0 {
            self.add_mass_product(a * self.damping_of_mass, x, y);
        }
        let a1 = self.spec.damping.rayleigh_stiffness;
        if a1 != 0.0 {
            self.add_stiffness_product(a * a1, x, y);
        }
    }

    /// y += a K x, element by element through the two natural deformations θ₂ − θ₁ and θ₁ + θ₂ − 2(w₂ − w₁)/l.
    ///
    /// A row of the assembled K cancels the rigid motion of the neighbourhood only after it was multiplied by EI/l³: the
    /// force of a smooth shape on n elements gets a relative error of about ε n⁴. Here the differences are taken first,
    /// which leaves about ε n². (That is the product's own rounding. Rounding the entries of `x` changes the exact
    /// product by up to ε n⁴ too, and no formula can undo that.)
    ///
    /// # Panics
    /// If `x` or `y` has not [`Beam::dofs`] entries.
    ///
    /// ```
    /// # let beam = teeter_beam::Beam::new(teeter_beam::BeamSpec {
    /// #     span: 1.0, elements: 4, section: teeter_beam::Section::new(1.0, 3.0)?,
    /// #     supports: [teeter_beam::Support::Free; 2], damping: Default::default() })?;
    /// let turned = beam.from_nodes(&[[0.0, 1.0], [0.25, 1.0], [0.5, 1.0], [0.75, 1.0], [1.0, 1.0]])?;
    /// let mut force = vec![0.0; beam.dofs()];
    /// beam.add_stiffness_product(1.0, &turned, &mut force);
    /// assert!(force.iter().all(|f| *f == 0.0));
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn add_stiffness_product(&self, a: f64, x: &[f64], y: &mut [f64]) {
        let (x_head, x_inner, x_tail) = self.layout.split(x);
        let (y_head, y_inner, y_tail) = self.layout.split_mut(y);
        let e = self.element;
        let (k1, k2) = (a * e.bend, 3.0 * a * e.bend);
        let forces = |p: [f64; 2], q: [f64; 2]| {
            let [d1, d2] = e.deformations(p, q);
            e.forces([k1 * d1, k2 * d2])
        };
        let last = x_inner.len();
        let (on_head, mut from_left) = forces(x_head, x_inner.first().copied().unwrap_or(x_tail));
        add_to_end(y_head, on_head);
        for i in 0..last {
            let right = if i + 1 < last { x_inner[i + 1] } else { x_tail };
            let (here, next) = forces(x_inner[i], right);
            y_inner[i][0] += from_left[0] + here[0];
            y_inner[i][1] += from_left[1] + here[1];
            from_left = next;
        }
        add_to_end(y_tail, from_left);
    }

    /// ½ vᵀM v, J: a sum of squares, never negative.
    ///
    /// # Panics
    /// If `v` has not [`Beam::dofs`] entries.
    ///
    /// ```
    /// # let beam = teeter_beam::Beam::new(teeter_beam::BeamSpec {
    /// #     span: 1.0, elements: 4, section: teeter_beam::Section::new(1.0, 3.0)?,
    /// #     supports: [teeter_beam::Support::Free; 2], damping: Default::default() })?;
    /// let v = beam.from_nodes(&[[2.0, 0.0]; 5])?;
    /// assert_eq!(beam.kinetic_energy(&v), 6.0);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn kinetic_energy(&self, v: &[f64]) -> f64 {
        let e = self.element;
        0.5 * self.sum_over_elements(v, |a, b| e.twice_kinetic_energy(a, b))
    }

    /// ½ qᵀK q, J, from the natural deformations: EI/(2l) Σ (d₁² + 3 d₂²), never negative, and exactly 0 for no
    /// deformation (see [`Beam::add_stiffness_product`]).
    ///
    /// # Panics
    /// If `q` has not [`Beam::dofs`] entries.
    ///
    /// ```
    /// # let beam = teeter_beam::Beam::new(teeter_beam::BeamSpec {
    /// #     span: 1.0, elements: 4, section: teeter_beam::Section::new(5.0, 3.0)?,
    /// #     supports: [teeter_beam::Support::Clamped, teeter_beam::Support::Free], damping: Default::default() })?;
    /// // w = x²/2: unit curvature, so half the bending stiffness times the span.
    /// let nodes: Vec<_> = (0..5).map(|i| f64::from(i) / 4.0).map(|x| [0.5 * x * x, x]).collect();
    /// assert_eq!(beam.elastic_energy(&beam.from_nodes(&nodes)?), 2.5);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn elastic_energy(&self, q: &[f64]) -> f64 {
        let e = self.element;
        0.5 * self.sum_over_elements(q, |a, b| e.twice_elastic_energy(a, b))
    }

    #[inline]
    fn sum_over_elements(&self, q: &[f64], f: impl Fn([f64; 2], [f64; 2]) -> f64) -> f64 {
        let (head, inner, tail) = self.layout.split(q);
        let (mut sum, mut left) = (0.0, head);
        for &right in inner {
            sum += f(left, right);
            left = right;
        }
        sum + f(left, tail)
    }
}

#[cfg(test)]
mod tests {
    use crate::beam::tests::{all_supports, beam, damped, dense, wave};

    /// Element by element in the loop, entry by entry in the matrix: two ways to the same product.
    #[test]
    fn products_and_energies_agree_with_the_assembled_matrices() {
        for supports in all_supports() {
            for elements in [1, 2, 3, 7] {
                if elements == 1 && supports == [crate::Support::Clamped; 2] {
                    continue;
                }
                let beam = damped(elements, supports);
                let x = wave(beam.dofs());
                let check = |matrix: Vec<Vec<f64>>, product: &dyn Fn(&mut [f64])| {
                    let mut y = vec![1.0; beam.dofs()];
                    product(&mut y);
                    let size = matrix.iter().flatten().fold(0.0_f64, |m, a| m.max(a.abs()));
                    for (row, y) in matrix.iter().zip(&y) {
                        let expected: f64 = row.iter().zip(&x).map(|(a, x)| 2.0 * a * x).sum();
                        assert!((y - 1.0 - expected).abs() < 1e-14 * size.max(1.0), "{supports:?} {elements}");
                    }
                    matrix.iter().zip(&x).map(|(r, xi)| xi * r.iter().zip(&x).map(|(a, x)| a * x).sum::<f64>()).sum()
                };
                let twice_kinetic: f64 = check(dense(beam.mass()), &|y| beam.add_mass_product(2.0, &x, y));
                check(dense(beam.damping()), &|y| beam.add_damping_product(2.0, &x, y));
                let twice_elastic: f64 = check(dense(beam.stiffness()), &|y| beam.add_stiffness_product(2.0, &x, y));
                assert!((2.0 * beam.kinetic_energy(&x) / twice_kinetic - 1.0).abs() < 1e-13);
                assert!((2.0 * beam.elastic_energy(&x) / twice_elastic - 1.0).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn an_undamped_beam_adds_nothing() {
        let beam = beam(5, [crate::Support::Pinned; 2]);
        let mut y = vec![0.0; beam.dofs()];
        beam.add_damping_product(1.0, &wave(beam.dofs()), &mut y);
        assert!(!beam.is_damped() && y.iter().all(|y| *y == 0.0));
    }

    /// A shape whose nodal values have no rounding error, and no inner forces: w = x³ − x on 512 elements. What is left is
    /// the product's own error.
    #[test]
    fn the_stiffness_product_loses_less_than_the_assembled_matrix() {
        let n = 512;
        let section = crate::Section::new(0.7, 1.0).unwrap();
        let spec = crate::BeamSpec { section, ..*beam(n, [crate::Support::Pinned; 2]).spec() };
        let beam = crate::Beam::new(spec).unwrap();
        let shape = |x: f64| [x * (x - 1.0) * (x + 1.0), 3.0 * x * x - 1.0];
        let nodes: Vec<[f64; 2]> = (0..=n).map(|i| shape(i as f64 / n as f64)).collect();
        let q = beam.from_nodes(&nodes).unwrap();
        let mut natural = vec![0.0; beam.dofs()];
        beam.add_stiffness_product(1.0, &q, &mut natural);
        let matrix = dense(beam.stiffness());
        let worst = |f: &dyn Fn(usize) -> f64| (1..2 * n - 1).map(|i| f(i).abs()).fold(0.0, f64::max);
        let by_modes = worst(&|i| natural[i]);
        let by_matrix = worst(&|i| matrix[i].iter().zip(&q).map(|(a, x)| a * x).sum());
        assert!(by_modes < 1e-12 && by_matrix > 1e-9, "{by_modes:e} {by_matrix:e}");
    }
}
