//! The two kinds of element terms that time steps sum over: quadratic forms of the deflection
//! (mass, foundation, viscous damping) and of the natural deformations (stiffness). Both are kept
//! as sums of squares, so that energies are never negative and a rigid motion costs exactly
//! nothing.

use crate::element::{Element, Matrix4};

/// One element's symmetric quadratic form of the deflection, mirrored onto itself by its middle. In
/// the sums and differences S = w₁ + w₂, Q = ψ₁ − ψ₂ (symmetric), D = w₁ − w₂, P = ψ₁ + ψ₂
/// (antisymmetric) it falls apart: qᵀM q = a(S + bQ)² + cQ² + d(D + eP)² + fP².
///
/// Symmetric and antisymmetric part stand side by side in pairs, so that the compiler can take both
/// at once.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Squares {
    /// a and d.
    outer: [f64; 2],
    /// b and e.
    ratio: [f64; 2],
    /// c and f.
    inner: [f64; 2],
}

impl Squares {
    fn new(m: &Matrix4) -> Self {
        let square = |aa: f64, ab: f64, bb: f64| {
            let ratio = if aa > 0.0 { ab / aa } else { 0.0 };
            (aa, ratio, bb - ab * ratio)
        };
        // M in S, Q and D, P: halves of sums and differences of its entries.
        let (a, b, c) = square(0.5 * (m[0][0] + m[0][2]), 0.5 * (m[0][1] - m[0][3]), 0.5 * (m[1][1] - m[1][3]));
        let (d, e, f) = square(0.5 * (m[0][0] - m[0][2]), 0.5 * (m[0][1] + m[0][3]), 0.5 * (m[1][1] + m[1][3]));
        Self { outer: [a, d], ratio: [b, e], inner: [c, f] }
    }

    /// (S + bQ, D + eP) and (Q, P).
    #[inline]
    fn parts(&self, p: [f64; 2], q: [f64; 2]) -> ([f64; 2], [f64; 2]) {
        let (w, turn) = ([p[0] + q[0], p[0] - q[0]], [p[1] - q[1], p[1] + q[1]]);
        ([w[0] + self.ratio[0] * turn[0], w[1] + self.ratio[1] * turn[1]], turn)
    }

    #[inline]
    fn form(&self, p: [f64; 2], q: [f64; 2]) -> [f64; 2] {
        let (w, turn) = self.parts(p, q);
        [0, 1].map(|i| self.outer[i] * (w[i] * w[i]) + self.inner[i] * (turn[i] * turn[i]))
    }

    /// What M q is on the two nodes.
    #[inline]
    fn product(&self, p: [f64; 2], q: [f64; 2]) -> ([f64; 2], [f64; 2]) {
        let (w, turn) = self.parts(p, q);
        let on_w = [0, 1].map(|i| self.outer[i] * w[i]);
        let on_turn = [0, 1].map(|i| self.ratio[i] * on_w[i] + self.inner[i] * turn[i]);
        ([on_w[0] + on_w[1], on_turn[1] + on_turn[0]], [on_w[0] - on_w[1], on_turn[1] - on_turn[0]])
    }
}

/// ∫ ρ NᵀN dx and the like, element by element.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Field(Vec<Squares>);

impl Field {
    pub(crate) fn new<'a>(matrices: impl Iterator<Item = &'a Matrix4>) -> Self {
        Self(matrices.map(Squares::new).collect())
    }

    /// y += a M x.
    pub(crate) fn add_product(&self, a: f64, x: &[[f64; 2]], y: &mut [[f64; 2]]) {
        sweep(&self.0, x, y, |squares, p, q| {
            let (left, right) = squares.product(p, q);
            ([a * left[0], a * left[1]], [a * right[0], a * right[1]])
        });
    }

    /// What one element's M x is on its two nodes.
    pub(crate) fn on_nodes(&self, element: usize, x: &[[f64; 2]]) -> [f64; 4] {
        let (p, q) = self.0[element].product(x[element], x[element + 1]);
        [p[0], p[1], q[0], q[1]]
    }

    /// xᵀM x.
    pub(crate) fn form(&self, x: &[[f64; 2]]) -> f64 {
        sum(&self.0, x, Squares::form)
    }
}

/// One element's stiffness in its natural deformations d₁ = ψ₂ − ψ₁, d₂ = ψ₁ + ψ₂ − s and the rise
/// s = 2(w₂ − w₁)/l: qᵀK q = k₁d₁² + k₂d₂² + k₃s², k₃ of an axial force only.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Springs {
    two_per_length: f64,
    k1: f64,
    k2: f64,
    k3: f64,
}

impl Springs {
    #[inline]
    fn deformations(&self, p: [f64; 2], q: [f64; 2]) -> [f64; 3] {
        let rise = self.two_per_length * (q[0] - p[0]);
        [q[1] - p[1], p[1] + q[1] - rise, rise]
    }

    /// What a K q is on the two nodes.
    #[inline]
    fn product(&self, a: f64, p: [f64; 2], q: [f64; 2]) -> ([f64; 2], [f64; 2]) {
        let [d1, d2, rise] = self.deformations(p, q);
        let (m1, m2) = (a * self.k1 * d1, a * self.k2 * d2);
        let shear = self.two_per_length * (m2 - a * self.k3 * rise);
        ([shear, m2 - m1], [-shear, m2 + m1])
    }

    #[inline]
    fn form(&self, p: [f64; 2], q: [f64; 2]) -> [f64; 2] {
        let [d1, d2, rise] = self.deformations(p, q);
        [self.k1 * (d1 * d1) + self.k3 * (rise * rise), self.k2 * (d2 * d2)]
    }
}

/// The stiffness, element by element.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Natural(Vec<Springs>);

impl Natural {
    /// EI ∫ψ'² dx + GA_s ∫(w' − ψ)² dx.
    pub(crate) fn bending(elements: &[Element]) -> Self {
        let springs = |e: &Element| {
            let [k1, k2] = e.natural();
            Springs { two_per_length: 2.0 / e.length, k1, k2, k3: 0.0 }
        };
        Self(elements.iter().map(springs).collect())
    }

    /// ∫w'² dx = l (s²/4 + d₁²/12 + d₂²/(20(1 + Φ)²)): the slope in Legendre polynomials of the
    /// element.
    pub(crate) fn geometric(elements: &[Element]) -> Self {
        let springs = |e: &Element| {
            let (l, stiff) = (e.length, 1.0 + e.shear);
            Springs { two_per_length: 2.0 / l, k1: l / 12.0, k2: l / (20.0 * stiff * stiff), k3: 0.25 * l }
        };
        Self(elements.iter().map(springs).collect())
    }

    /// Adds `factor` times another one of the same elements.
    pub(crate) fn add_scaled(&mut self, factor: f64, other: &Self) {
        for (k, o) in self.0.iter_mut().zip(&other.0) {
            (k.k1, k.k2, k.k3) = (k.k1 + factor * o.k1, k.k2 + factor * o.k2, k.k3 + factor * o.k3);
        }
    }

    /// y += a K x.
    ///
    /// A row of the assembled K cancels the rigid motion of the neighbourhood only after it was
    /// multiplied by EI/l³: the force of a smooth shape on n elements gets a relative error of
    /// about ε n⁴. Here the differences are taken first, which leaves about ε n².
    pub(crate) fn add_product(&self, a: f64, x: &[[f64; 2]], y: &mut [[f64; 2]]) {
        sweep(&self.0, x, y, |k, p, q| k.product(a, p, q));
    }

    /// What one element's K x is on its two nodes.
    pub(crate) fn on_nodes(&self, element: usize, x: &[[f64; 2]]) -> [f64; 4] {
        let (p, q) = self.0[element].product(1.0, x[element], x[element + 1]);
        [p[0], p[1], q[0], q[1]]
    }

    /// xᵀK x.
    pub(crate) fn form(&self, x: &[[f64; 2]]) -> f64 {
        sum(&self.0, x, Springs::form)
    }

    /// xᵀK y.
    pub(crate) fn between(&self, x: &[[f64; 2]], y: &[[f64; 2]]) -> f64 {
        let mut sum = 0.0;
        for ((k, x), y) in self.0.iter().zip(x.windows(2)).zip(y.windows(2)) {
            let (a, b) = (k.deformations(x[0], x[1]), k.deformations(y[0], y[1]));
            sum += k.k1 * (a[0] * b[0]) + k.k2 * (a[1] * b[1]) + k.k3 * (a[2] * b[2]);
        }
        sum
    }

    /// The assembled element matrices.
    pub(crate) fn matrices(&self) -> impl Iterator<Item = Matrix4> {
        self.0.iter().map(|k| {
            let mut matrix = [[0.0; 4]; 4];
            for (i, row) in matrix.iter_mut().enumerate() {
                let mut e = [0.0; 4];
                e[i] = 1.0;
                let (p, q) = k.product(1.0, [e[0], e[1]], [e[2], e[3]]);
                *row = [p[0], p[1], q[0], q[1]];
            }
            matrix
        })
    }
}

/// Adds what each element gives to its two nodes.
#[inline]
fn sweep<E>(
    elements: &[E],
    x: &[[f64; 2]],
    y: &mut [[f64; 2]],
    forces: impl Fn(&E, [f64; 2], [f64; 2]) -> ([f64; 2], [f64; 2]),
) {
    let (Some((&first, x)), Some((y_first, y))) = (x.split_first(), y.split_first_mut()) else { return };
    let (mut left, mut on_left) = (first, *y_first);
    // What a node gets from its left element is carried along: each is written once.
    let mut store = y_first;
    for ((element, &right), y) in elements.iter().zip(x).zip(y) {
        let (here, next) = forces(element, left, right);
        *store = [on_left[0] + here[0], on_left[1] + here[1]];
        on_left = [y[0] + next[0], y[1] + next[1]];
        left = right;
        store = y;
    }
    *store = on_left;
}

/// Sums over elements, in pairs and every other one apart, so that a sum needn't wait for the one
/// before.
#[inline]
fn sum<E>(elements: &[E], x: &[[f64; 2]], form: impl Fn(&E, [f64; 2], [f64; 2]) -> [f64; 2]) -> f64 {
    let (mut even, mut odd) = ([0.0; 2], [0.0; 2]);
    let mut pairs = elements.chunks_exact(2);
    let mut nodes = x;
    for pair in &mut pairs {
        if let ([a, b], [p, q, r, ..]) = (pair, nodes) {
            let (first, second) = (form(a, *p, *q), form(b, *q, *r));
            (0..2).for_each(|i| even[i] += first[i]);
            (0..2).for_each(|i| odd[i] += second[i]);
        }
        nodes = &nodes[2..];
    }
    if let ([last], [p, q, ..]) = (pairs.remainder(), nodes) {
        let last = form(last, *p, *q);
        (0..2).for_each(|i| even[i] += last[i]);
    }
    (even[0] + odd[0]) + (even[1] + odd[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Section;

    fn elements() -> Vec<Element> {
        let plain = Section::new(3.0, 5.0).unwrap();
        let shear = plain.with_shear(20.0, 0.4).unwrap();
        vec![Element::new(0.7, plain), Element::new(0.2, shear), Element::new(0.4, plain)]
    }

    const Q: [[f64; 2]; 4] = [[0.3, -1.1], [0.8, 0.45], [-0.2, 0.9], [0.1, -0.6]];

    fn by_matrices(matrices: &[Matrix4]) -> ([[f64; 2]; 4], f64) {
        let (mut product, mut form) = ([[0.0; 2]; 4], 0.0);
        for (k, m) in matrices.iter().enumerate() {
            for i in 0..4 {
                for j in 0..4 {
                    let value = m[i][j] * Q[k + j / 2][j % 2];
                    product[k + i / 2][i % 2] += value;
                    form += Q[k + i / 2][i % 2] * value;
                }
            }
        }
        (product, form)
    }

    #[test]
    fn sums_of_squares_are_the_quadratic_forms_of_the_matrices() {
        let matrices: Vec<Matrix4> = elements().iter().map(Element::mass).collect();
        let field = Field::new(matrices.iter());
        let (product, form) = by_matrices(&matrices);
        let mut y = [[1.0; 2]; 4];
        field.add_product(2.0, &Q, &mut y);
        assert!(y.iter().flatten().zip(product.iter().flatten()).all(|(y, p)| (y - 1.0 - 2.0 * p).abs() < 1e-14));
        assert!((field.form(&Q) / form - 1.0).abs() < 1e-14);
    }

    #[test]
    fn natural_deformations_give_the_forces_and_energies_of_their_matrices() {
        let mut natural = Natural::bending(&elements());
        natural.add_scaled(7.0, &Natural::geometric(&elements()));
        let matrices: Vec<Matrix4> = natural.matrices().collect();
        let (product, form) = by_matrices(&matrices);
        let mut y = [[1.0; 2]; 4];
        natural.add_product(2.0, &Q, &mut y);
        assert!(y.iter().flatten().zip(product.iter().flatten()).all(|(y, p)| (y - 1.0 - 2.0 * p).abs() < 1e-12));
        assert!((natural.form(&Q) / form - 1.0).abs() < 1e-14);
        for m in matrices {
            for i in 0..4 {
                for j in 0..4 {
                    assert!((m[i][j] - m[j][i]).abs() < 1e-13 * m[i][i].abs());
                }
            }
        }
    }

    /// By its definition: four Gauss points are exact for the square of a parabola.
    #[test]
    fn the_geometric_form_is_the_integral_of_the_squared_slope() {
        let mut expected = 0.0;
        for (k, e) in elements().iter().enumerate() {
            let q = [Q[k][0], Q[k][1], Q[k + 1][0], Q[k + 1][1]];
            for (s, weight) in crate::element::GAUSS {
                let slope: f64 = e.shape_slope(0.5 * (1.0 + s)).iter().zip(&q).map(|(n, q)| n * q).sum();
                expected += 0.5 * weight * e.length * slope * slope;
            }
        }
        assert!((Natural::geometric(&elements()).form(&Q) / expected - 1.0).abs() < 1e-14);
    }
}
