//! One two-node element: cubic Hermite for Euler–Bernoulli, and its extension by shear.
//!
//! With Φ = 12 EI/(GA_s l²) the shape functions of Friedman and Kosmatka (1993, doi
//! 10.1016/0045-7949(93)90243-7) solve the static equations of Timoshenko's beam without load, so
//! the element doesn't lock and is exact at its nodes. Φ = 0 is the cubic Hermite element. The dofs
//! of a node are w and the rotation ψ of the section; ψ = w' for Φ = 0.

use std::array;

use crate::section::Section;

/// An element of one section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Element {
    /// Length l, m.
    pub(crate) length: f64,
    /// Φ.
    pub(crate) shear: f64,
    pub(crate) section: Section,
}

/// A 4 × 4 element matrix in the dofs (w₁, ψ₁, w₂, ψ₂).
pub(crate) type Matrix4 = [[f64; 4]; 4];

/// Four-point Gauss–Legendre on [−1, 1]: exact to degree 7, so for products of two cubics, and for
/// loads up to degree 4 against one.
pub(crate) const GAUSS: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    (-0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
];

impl Element {
    pub(crate) fn new(length: f64, section: Section) -> Self {
        Self { length, shear: section.shear_parameter(length), section }
    }

    /// The stiffness of the two natural deformations d₁ = ψ₂ − ψ₁ and d₂ = ψ₁ + ψ₂ − 2(w₂ − w₁)/l,
    /// N m: EI/l and 3 EI/(l (1 + Φ)).
    pub(crate) fn natural(&self) -> [f64; 2] {
        let bend = self.section.bending_stiffness / self.length;
        [bend, 3.0 * bend / (1.0 + self.shear)]
    }

    /// M_e = ∫ ρA NᵀN + ρI N_ψᵀN_ψ dx.
    pub(crate) fn mass(&self) -> Matrix4 {
        let rho_a = self.section.mass_per_length;
        let mut mass = self.foundation(rho_a);
        if self.section.rotatory_inertia != 0.0 {
            let rho_i = self.section.rotatory_inertia;
            let rotation = self.integral(|xi| self.rotation(xi));
            add_scaled(&mut mass, rho_i, &rotation);
        }
        mass
    }

    /// k ∫ NᵀN dx.
    pub(crate) fn foundation(&self, k: f64) -> Matrix4 {
        if self.shear != 0.0 {
            let mut matrix = [[0.0; 4]; 4];
            add_scaled(&mut matrix, k, &self.integral(|xi| self.shape(xi)));
            return matrix;
        }
        let table = [
            [156.0, 22.0, 54.0, -13.0],
            [22.0, 4.0, 13.0, -3.0],
            [54.0, 13.0, 156.0, -22.0],
            [-13.0, -3.0, -22.0, 4.0],
        ];
        let (factor, l) = (k * self.length / 420.0, self.length);
        // A common factor, and l for each rotational row and column.
        let unit = |i: usize| if i % 2 == 1 { l } else { 1.0 };
        array::from_fn(|i| array::from_fn(|j| factor * table[i][j] * (unit(i) * unit(j))))
    }

    /// ∫ fᵀf dx of four functions of ξ, cubic at most.
    fn integral(&self, f: impl Fn(f64) -> [f64; 4]) -> Matrix4 {
        let mut sum = [[0.0; 4]; 4];
        for (s, weight) in GAUSS {
            let f = f(0.5 * (1.0 + s));
            for i in 0..4 {
                for j in 0..4 {
                    sum[i][j] += 0.5 * weight * self.length * f[i] * f[j];
                }
            }
        }
        sum
    }

    /// N at ξ ∈ [0, 1].
    #[inline]
    pub(crate) fn shape(&self, xi: f64) -> [f64; 4] {
        let (l, eta) = (self.length, 1.0 - xi);
        // 1 − 3ξ² + 2ξ³ = (1−ξ)²(1+2ξ) and so on: products keep small values accurate near the far
        // node.
        let n = [eta * eta * (1.0 + 2.0 * xi), l * xi * eta * eta, xi * xi * (1.0 + 2.0 * eta), -l * xi * xi * eta];
        if self.shear == 0.0 {
            return n;
        }
        // Φ times the straight line and half a parabola.
        let (phi, bow) = (self.shear, 0.5 * l * xi * eta);
        let line = [eta, bow, xi, -bow];
        array::from_fn(|i| (n[i] + phi * line[i]) / (1.0 + phi))
    }

    /// dN/dx at ξ ∈ [0, 1].
    #[inline]
    pub(crate) fn shape_slope(&self, xi: f64) -> [f64; 4] {
        let (l, eta) = (self.length, 1.0 - xi);
        let rise = 6.0 / l * xi * eta;
        let dn = [-rise, eta * (eta - 2.0 * xi), rise, xi * (xi - 2.0 * eta)];
        if self.shear == 0.0 {
            return dn;
        }
        let (phi, tilt) = (self.shear, 0.5 * (eta - xi));
        let line = [-1.0 / l, tilt, 1.0 / l, -tilt];
        array::from_fn(|i| (dn[i] + phi * line[i]) / (1.0 + phi))
    }

    /// The rotation of the section, N_ψ at ξ ∈ [0, 1]; dN/dx for Φ = 0.
    pub(crate) fn rotation(&self, xi: f64) -> [f64; 4] {
        let (l, eta, phi) = (self.length, 1.0 - xi, self.shear);
        let rise = 6.0 / l * xi * eta;
        let whole = [-rise, eta * (eta - 2.0 * xi) + phi * eta, rise, xi * (xi - 2.0 * eta) + phi * xi];
        whole.map(|value| value / (1.0 + phi))
    }

    /// The curvature dN_ψ/dx at ξ: bending moment over EI.
    #[cfg(test)]
    fn curvature(&self, xi: f64) -> [f64; 4] {
        let (l, phi) = (self.length, self.shear);
        let bow = 6.0 * (1.0 - 2.0 * xi) / l;
        let whole = [-bow, 6.0 * xi - 4.0 - phi, bow, 6.0 * xi - 2.0 + phi];
        whole.map(|value| value / (l * (1.0 + phi)))
    }

    /// ∫ Nᵀ dx over a part of the element, ξ from and to: by quadrature, exact.
    pub(crate) fn partial_load(&self, [from, to]: [f64; 2]) -> [f64; 4] {
        if from <= 0.0 && to >= 1.0 {
            return self.uniform_load();
        }
        let mut sum = [0.0; 4];
        for (s, weight) in GAUSS {
            let n = self.shape(from + 0.5 * (1.0 + s) * (to - from));
            sum.iter_mut().zip(n).for_each(|(sum, n)| *sum += 0.5 * weight * (to - from) * self.length * n);
        }
        sum
    }

    /// ∫ Nᵀ dx: what a uniform load of 1 N/m gives to the nodes, in N and N m. The same with shear.
    pub(crate) fn uniform_load(&self) -> [f64; 4] {
        let (force, couple) = (0.5 * self.length, self.length * self.length / 12.0);
        [force, couple, force, -couple]
    }
}

fn add_scaled(sum: &mut Matrix4, factor: f64, matrix: &Matrix4) {
    for (sum, row) in sum.iter_mut().zip(matrix) {
        for (sum, value) in sum.iter_mut().zip(row) {
            *sum += factor * value;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const L: f64 = 0.7;
    const EI: f64 = 3.0;
    const RHO_A: f64 = 5.0;

    fn element() -> Element {
        Element::new(L, Section::new(EI, RHO_A).unwrap())
    }

    fn with_shear() -> Element {
        Element::new(L, Section::new(EI, RHO_A).unwrap().with_shear(20.0, 0.4).unwrap())
    }

    #[test]
    fn shape_functions_are_the_polynomials_of_the_theory_and_their_derivatives() {
        let e = element();
        for k in 0..=20 {
            let x: f64 = f64::from(k) / 20.0;
            let (x2, x3) = (x * x, x * x * x);
            let n = [1.0 - 3.0 * x2 + 2.0 * x3, L * (x - 2.0 * x2 + x3), 3.0 * x2 - 2.0 * x3, L * (x3 - x2)];
            let dn = [(6.0 * x2 - 6.0 * x) / L, 1.0 - 4.0 * x + 3.0 * x2, (6.0 * x - 6.0 * x2) / L, 3.0 * x2 - 2.0 * x];
            for i in 0..4 {
                assert!((e.shape(x)[i] - n[i]).abs() < 4e-16, "N{i} at {x}");
                assert!((e.shape_slope(x)[i] - dn[i]).abs() < 4e-15, "N'{i} at {x}");
                assert_eq!(e.rotation(x)[i], e.shape_slope(x)[i]);
            }
        }
    }

    /// The static equations without load, by central differences: EI ψ'' + GA_s(w' − ψ) = 0 and
    /// GA_s(w' − ψ) constant.
    #[test]
    fn with_shear_the_shape_functions_are_static_solutions() {
        let e = with_shear();
        let (d, ga) = (1e-4, e.section.shear_stiffness);
        for i in 0..4 {
            let slip = |xi: f64| ga * (e.shape_slope(xi)[i] - e.rotation(xi)[i]);
            for xi in [0.2, 0.5, 0.9] {
                let slope = (e.shape(xi + d)[i] - e.shape(xi - d)[i]) / (2.0 * d * L);
                assert!((slope - e.shape_slope(xi)[i]).abs() < 1e-7, "N'{i}");
                let bent = (e.rotation(xi + d)[i] - e.rotation(xi - d)[i]) / (2.0 * d * L);
                assert!((bent - e.curvature(xi)[i]).abs() < 1e-7, "curvature {i}");
                let change = (e.curvature(xi + d)[i] - e.curvature(xi - d)[i]) / (2.0 * d * L);
                assert!((EI * change + slip(xi)).abs() < 1e-6, "moment {i} at {xi}");
                assert!((slip(xi) - slip(0.5)).abs() < 1e-12, "shear {i} at {xi}");
            }
            let unit = |k: usize| if i == k { 1.0 } else { 0.0 };
            let (left, right) = (e.shape(0.0), e.shape(1.0));
            assert_eq!([left[i], right[i]], [unit(0), unit(2)]);
            assert!((e.rotation(0.0)[i] - unit(1)).abs() < 1e-15 && (e.rotation(1.0)[i] - unit(3)).abs() < 1e-15);
        }
    }

    /// The stiffness by its definition, ∫ EI κ² + GA_s γ² dx, against that of the natural
    /// deformations.
    #[test]
    fn the_natural_stiffness_is_the_integral_of_the_strain_energy() {
        for e in [element(), with_shear()] {
            let q = [0.3, -1.1, 0.8, 0.45];
            let at = |f: [f64; 4]| f.iter().zip(&q).map(|(f, q)| f * q).sum::<f64>();
            let mut twice = 0.0;
            for (s, weight) in GAUSS {
                let xi = 0.5 * (1.0 + s);
                let slip = at(e.shape_slope(xi)) - at(e.rotation(xi));
                let shear = if slip == 0.0 { 0.0 } else { e.section.shear_stiffness * slip * slip };
                twice += 0.5 * weight * L * (EI * at(e.curvature(xi)).powi(2) + shear);
            }
            let [k1, k2] = e.natural();
            let (d1, d2) = (q[3] - q[1], q[1] + q[3] - 2.0 / L * (q[2] - q[0]));
            assert!((twice / (k1 * d1 * d1 + k2 * d2 * d2) - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn mass_matrices_are_symmetric_and_carry_the_mass() {
        let m = element().mass();
        let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-15;
        assert!(close(m[0][0], 156.0 * RHO_A * L / 420.0) && close(m[1][3], -3.0 * RHO_A * L * L * L / 420.0));
        for e in [element(), with_shear()] {
            let m = e.mass();
            let translation = m[0][0] + 2.0 * m[0][2] + m[2][2];
            assert!((translation / (RHO_A * L) - 1.0).abs() < 1e-14);
            // Turning about the left node: ρA l³/3, and ρI l for the sections.
            let turn = [0.0, 1.0, L, 1.0];
            let about: f64 = (0..4).map(|i| (0..4).map(|j| turn[i] * m[i][j] * turn[j]).sum::<f64>()).sum();
            assert!((about / (RHO_A * L.powi(3) / 3.0 + e.section.rotatory_inertia * L) - 1.0).abs() < 1e-14);
            for i in 0..4 {
                for j in 0..4 {
                    assert!((m[i][j] - m[j][i]).abs() < 1e-16);
                }
            }
        }
        // By quadrature the same as in closed form.
        let e = element();
        let (table, sum) = (e.foundation(1.0), e.integral(|xi| e.shape(xi)));
        assert!(table.iter().flatten().zip(sum.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-15));
    }
}
