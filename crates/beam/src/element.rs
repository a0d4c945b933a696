//! One cubic Hermite element (`docs/theory.md` §1).

use std::array;

/// The constants of the elements of a uniform mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Element {
    /// Length l, m.
    pub(crate) length: f64,
    /// 2/l.
    pub(crate) two_per_length: f64,
    /// EI/l: moment per unit of the symmetric bending mode.
    pub(crate) bend: f64,
    /// ρA l/420, the common factor of the mass matrix.
    pub(crate) mass: f64,
}

impl Element {
    pub(crate) fn new(length: f64, bending_stiffness: f64, mass_per_length: f64) -> Self {
        Self {
            length,
            two_per_length: 2.0 / length,
            bend: bending_stiffness / length,
            mass: mass_per_length * length / 420.0,
        }
    }

    /// K_e = EI ∫ N''ᵀN'' dx.
    pub(crate) fn stiffness(&self) -> [[f64; 4]; 4] {
        let l = self.length;
        let table = [[12.0, 6.0, -12.0, 6.0], [6.0, 4.0, -6.0, 2.0], [-12.0, -6.0, 12.0, -6.0], [6.0, 2.0, -6.0, 4.0]];
        scaled(table, self.bend / (l * l), l)
    }

    /// M_e = ρA ∫ NᵀN dx.
    pub(crate) fn mass_matrix(&self) -> [[f64; 4]; 4] {
        let table = [
            [156.0, 22.0, 54.0, -13.0],
            [22.0, 4.0, 13.0, -3.0],
            [54.0, 13.0, 156.0, -22.0],
            [-13.0, -3.0, -22.0, 4.0],
        ];
        scaled(table, self.mass, self.length)
    }

    /// N at ξ ∈ [0, 1].
    #[inline]
    pub(crate) fn shape(&self, xi: f64) -> [f64; 4] {
        let (l, eta) = (self.length, 1.0 - xi);
        // 1 − 3ξ² + 2ξ³ = (1−ξ)²(1+2ξ) and so on: products keep small values accurate near the far node.
        [eta * eta * (1.0 + 2.0 * xi), l * xi * eta * eta, xi * xi * (1.0 + 2.0 * eta), -l * xi * xi * eta]
    }

    /// dN/dx at ξ ∈ [0, 1].
    #[inline]
    pub(crate) fn shape_slope(&self, xi: f64) -> [f64; 4] {
        let eta = 1.0 - xi;
        let rise = 3.0 * self.two_per_length * xi * eta;
        [-rise, eta * (eta - 2.0 * xi), rise, xi * (xi - 2.0 * eta)]
    }

    /// The two natural deformations: bending symmetric about the middle, d₁ = θ₂ − θ₁, and antisymmetric,
    /// d₂ = θ₁ + θ₂ − 2(w₂ − w₁)/l. The rigid motions drop out here, before they are multiplied by a stiffness.
    #[inline]
    pub(crate) fn deformations(&self, a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
        [b[1] - a[1], a[1] + b[1] - self.two_per_length * (b[0] - a[0])]
    }

    /// Forces of the element on its two nodes for the generalised moments of the two deformations: their transpose.
    #[inline]
    pub(crate) fn forces(&self, m: [f64; 2]) -> ([f64; 2], [f64; 2]) {
        let shear = self.two_per_length * m[1];
        ([shear, m[1] - m[0]], [-shear, m[1] + m[0]])
    }

    /// EI ∫ w''² dx = (EI/l)(d₁² + 3 d₂²).
    #[inline]
    pub(crate) fn twice_elastic_energy(&self, a: [f64; 2], b: [f64; 2]) -> f64 {
        let [d1, d2] = self.deformations(a, b);
        self.bend * (d1 * d1 + 3.0 * d2 * d2)
    }

    /// ρA ∫ w² dx as a sum of squares: w in Legendre polynomials of the element, ρA l Σ a_k²/(2k+1).
    #[inline]
    pub(crate) fn twice_kinetic_energy(&self, a: [f64; 2], b: [f64; 2]) -> f64 {
        // Products with constants throughout: a division costs more than all the rest.
        let rise = b[0] - a[0];
        let bend = (self.length * (1.0 / 12.0)) * (b[1] - a[1]);
        let turn = (self.length * 0.05) * (a[1] + b[1]);
        let c0 = 0.5 * (a[0] + b[0]) - bend;
        let c1 = 0.6 * rise - turn;
        let c3 = turn - 0.1 * rise;
        let squares = c0 * c0 + (1.0 / 3.0) * c1 * c1 + 0.2 * bend * bend + (1.0 / 7.0) * c3 * c3;
        420.0 * self.mass * squares
    }
}

/// An element matrix from its table of whole numbers: a common factor, and l for each rotational row and column.
fn scaled(table: [[f64; 4]; 4], factor: f64, l: f64) -> [[f64; 4]; 4] {
    let unit = |i: usize| if i % 2 == 1 { l } else { 1.0 };
    array::from_fn(|i| array::from_fn(|j| factor * table[i][j] * (unit(i) * unit(j))))
}

#[cfg(test)]
mod tests {
    use super::*;

    const L: f64 = 0.7;
    const EI: f64 = 3.0;
    const RHO_A: f64 = 5.0;

    fn element() -> Element {
        Element::new(L, EI, RHO_A)
    }

    /// Five-point Gauss–Legendre on [0, 1], exact to degree 9.
    fn integrate(f: impl Fn(f64) -> f64) -> f64 {
        let (a, b) = (0.906_179_845_938_664, 0.538_469_310_105_683_1);
        let (wa, wb, wc) = (0.236_926_885_056_189_08, 0.478_628_670_499_366_47, 0.568_888_888_888_888_9);
        [(-a, wa), (-b, wb), (0.0, wc), (b, wb), (a, wa)].iter().map(|(s, w)| 0.5 * w * f(0.5 * (1.0 + s))).sum()
    }

    fn curvature(xi: f64) -> [f64; 4] {
        [(12.0 * xi - 6.0) / (L * L), (6.0 * xi - 4.0) / L, (6.0 - 12.0 * xi) / (L * L), (6.0 * xi - 2.0) / L]
    }

    #[test]
    fn matrices_are_the_integrals_of_their_shape_functions() {
        let e = element();
        for i in 0..4 {
            for j in 0..4 {
                let mass = integrate(|xi| RHO_A * L * e.shape(xi)[i] * e.shape(xi)[j]);
                let stiffness = integrate(|xi| EI * L * curvature(xi)[i] * curvature(xi)[j]);
                assert!((e.mass_matrix()[i][j] - mass).abs() < 1e-14, "M {i} {j}");
                assert!((e.stiffness()[i][j] - stiffness).abs() < 1e-12, "K {i} {j}");
            }
        }
    }

    #[test]
    fn matrices_are_symmetric_and_in_closed_form() {
        let (k, m) = (element().stiffness(), element().mass_matrix());
        for i in 0..4 {
            for j in 0..4 {
                assert_eq!(k[i][j], k[j][i]);
                assert_eq!(m[i][j], m[j][i]);
            }
        }
        let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-15;
        assert!(close(k[0][0], 12.0 * EI / (L * L * L)) && close(k[1][3], 2.0 * EI / L));
        assert!(close(m[0][0], 156.0 * RHO_A * L / 420.0) && close(m[1][3], -3.0 * RHO_A * L * L * L / 420.0));
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
            }
        }
    }

    #[test]
    fn energies_are_the_quadratic_forms_of_the_matrices() {
        let e = element();
        let q = [0.3, -1.1, 0.8, 0.45];
        let form =
            |m: [[f64; 4]; 4]| -> f64 { (0..4).map(|i| (0..4).map(|j| q[i] * m[i][j] * q[j]).sum::<f64>()).sum() };
        let (a, b) = ([q[0], q[1]], [q[2], q[3]]);
        assert!((e.twice_elastic_energy(a, b) / form(e.stiffness()) - 1.0).abs() < 1e-14);
        assert!((e.twice_kinetic_energy(a, b) / form(e.mass_matrix()) - 1.0).abs() < 1e-14);
    }
}
