//! Products of vectors of a contact, written out: the loops of the general matrix type take several
//! times as many instructions for two or three numbers.

use crate::Vector;

/// u += a x.
#[inline]
pub(crate) fn add_scaled<const D: usize>(u: &mut Vector<D>, a: &Vector<D>, x: f64) {
    let ([u], [a]) = (&mut u.data.0, &a.data.0);
    for k in 0..D {
        u[k] += a[k] * x;
    }
}

/// block += a (s b)ᵀ.
#[inline]
#[cfg(any(feature = "bodies", feature = "beam"))]
pub(crate) fn add_outer<const D: usize>(block: &mut teeter_contact::Block<D>, a: &Vector<D>, b: &Vector<D>, s: f64) {
    let ([a], [b]) = (&a.data.0, &b.data.0);
    for (column, b) in block.data.0.iter_mut().zip(b) {
        let b = b * s;
        for k in 0..D {
            column[k] += a[k] * b;
        }
    }
}

/// a·p.
#[inline]
pub(crate) fn dot<const D: usize>(a: &Vector<D>, p: &Vector<D>) -> f64 {
    let ([a], [p]) = (&a.data.0, &p.data.0);
    let mut sum = a[0] * p[0];
    for k in 1..D {
        sum += a[k] * p[k];
    }
    sum
}
