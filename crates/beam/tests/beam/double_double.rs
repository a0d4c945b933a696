//! Numbers of twice the digits (Dekker 1971, doi 10.1007/BF01397083), and solves with them: what rounding is measured against.

use std::ops::{Add, Mul, Neg, Sub};

use teeter_beam::{Beam, Factor, MatrixWeights};

/// high + low, |low| at most half a unit of the last place of high.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dd {
    pub(crate) high: f64,
    low: f64,
}

pub(crate) const ZERO: Dd = Dd { high: 0.0, low: 0.0 };

impl From<f64> for Dd {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

/// a + b without error.
fn sum(a: f64, b: f64) -> Dd {
    let high = a + b;
    let part = high - a;
    Dd { high, low: (a - (high - part)) + (b - part) }
}

impl Add for Dd {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (high, low) = (sum(self.high, other.high), sum(self.low, other.low));
        let first = sum(high.high, high.low + low.high);
        sum(first.high, first.low + low.low)
    }
}

impl Neg for Dd {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for Dd {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Dd {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let high = self.high * other.high;
        let low = self.high.mul_add(other.high, -high);
        sum(high, low + (self.high * other.low + self.low * other.high))
    }
}

impl Dd {
    /// self/divisor.
    pub(crate) fn over(self, divisor: Self) -> Self {
        let mut quotient = Self::from(self.high / divisor.high);
        for _ in 0..2 {
            quotient = quotient + Self::from((self - quotient * divisor).high / divisor.high);
        }
        quotient
    }
}

/// `mass M + stiffness K` of a uniform Euler–Bernoulli beam, undamped, under an axial force and on a foundation all along, in
/// Hermite's closed forms; what is held is left out.
pub(crate) struct Exact<'a> {
    beam: &'a Beam,
    /// One element's matrix.
    matrix: [[Dd; 4]; 4],
}

impl<'a> Exact<'a> {
    pub(crate) fn new(beam: &'a Beam, weights: MatrixWeights) -> Self {
        let spec = beam.spec();
        let dd = Dd::from;
        let l = dd(spec.span).over(dd(beam.elements() as f64));
        let of = |table: [[f64; 4]; 4], factor: Dd| {
            // A common factor, and l for each rotational row and column.
            let unit = |i: usize| if i % 2 == 1 { l } else { dd(1.0) };
            std::array::from_fn::<_, 4, _>(|i| {
                std::array::from_fn::<_, 4, _>(|j| dd(table[i][j]) * factor * unit(i) * unit(j))
            })
        };
        let mass = [
            [156.0, 22.0, 54.0, -13.0],
            [22.0, 4.0, 13.0, -3.0],
            [54.0, 13.0, 156.0, -22.0],
            [-13.0, -3.0, -22.0, 4.0],
        ];
        let bending =
            [[12.0, 6.0, -12.0, 6.0], [6.0, 4.0, -6.0, 2.0], [-12.0, -6.0, 12.0, -6.0], [6.0, 2.0, -6.0, 4.0]];
        let slopes =
            [[36.0, 3.0, -36.0, 3.0], [3.0, 4.0, -3.0, -1.0], [-36.0, -3.0, 36.0, -3.0], [3.0, -1.0, -3.0, 4.0]];
        let bed: f64 = spec.foundations.iter().map(|foundation| foundation.stiffness).sum();
        let density = dd(weights.mass) * dd(spec.section.mass_per_length) + dd(weights.stiffness) * dd(bed);
        let terms = [
            of(mass, density * l.over(dd(420.0))),
            of(bending, (dd(weights.stiffness) * dd(spec.section.bending_stiffness)).over(l * l * l)),
            of(slopes, (dd(weights.stiffness) * dd(spec.axial_force)).over(dd(30.0) * l)),
        ];
        let matrix =
            std::array::from_fn(|i| std::array::from_fn(|j| terms.iter().fold(ZERO, |total, term| total + term[i][j])));
        Self { beam, matrix }
    }

    /// r = f − A x.
    pub(crate) fn residual(&self, f: &[f64], x: &[Dd]) -> Vec<Dd> {
        let mut r: Vec<Dd> = f.iter().copied().map(Dd::from).collect();
        for e in 0..self.beam.elements() {
            for i in 0..4 {
                let row = (0..4).fold(ZERO, |total, j| total + self.matrix[i][j] * x[2 * e + j]);
                r[2 * e + i] = r[2 * e + i] - row;
            }
        }
        r
    }

    /// x to seventeen digits (of the thirty-two n⁴ are lost in the sums above), by refinement with the factor of the rounded matrix.
    pub(crate) fn solve(&self, factor: &Factor, f: &[f64]) -> Vec<Dd> {
        let mut x = vec![ZERO; f.len()];
        for round in 0.. {
            let mut correction: Vec<f64> = self.residual(f, &x).iter().map(|r| r.high).collect();
            factor.solve(&mut correction);
            x.iter_mut().zip(&correction).for_each(|(x, dx)| *x = *x + Dd::from(*dx));
            if largest(self.beam, &correction) <= 1e-17 * largest(self.beam, &rounded(&x)) {
                break;
            }
            assert!(round < 200, "the factor has no digit to refine by");
        }
        x
    }
}

pub(crate) fn rounded(x: &[Dd]) -> Vec<f64> {
    x.iter().map(|x| x.high).collect()
}

/// Largest deflection, rotations counted over the span.
pub(crate) fn largest(beam: &Beam, x: &[f64]) -> f64 {
    let unit = |i: usize| if i % 2 == 1 { beam.spec().span } else { 1.0 };
    x.iter().enumerate().fold(0.0, |m: f64, (i, x)| m.max(x.abs() * unit(i)))
}

/// The error of `x`, relative to the exact solution's largest deflection.
pub(crate) fn error(beam: &Beam, x: &[f64], exact: &[Dd]) -> f64 {
    let difference: Vec<f64> = x.iter().zip(exact).map(|(x, exact)| (Dd::from(*x) - *exact).high).collect();
    largest(beam, &difference) / largest(beam, &rounded(exact))
}
