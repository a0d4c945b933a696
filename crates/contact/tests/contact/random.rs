//! Random problems, the same in every run.

use nalgebra::{Matrix2, Vector2};
use teeter_contact::Block;

/// xorshift64.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 33) as usize % n
    }

    /// Between -1 and 1.
    pub(crate) fn number(&mut self) -> f64 {
        self.below(2001) as f64 / 1000.0 - 1.0
    }
}

/// The dense operator of `n` contacts, `coupled` blocks of it off the diagonal, at any places: coupled one way as a rule.
pub(crate) fn operator(n: usize, coupled: usize, random: &mut Random) -> Vec<Block<2>> {
    let mut h = vec![Matrix2::zeros(); n * n];
    for i in 0..n {
        h[i * n + i] = Matrix2::new(2.0, 0.1, 0.1, 1.5);
    }
    for _ in 0..coupled {
        let (i, j) = (random.below(n), random.below(n));
        if i != j {
            h[i * n + j] = Matrix2::from_fn(|_, _| 0.2 * random.number());
        }
    }
    h
}

pub(crate) fn vectors(n: usize, random: &mut Random) -> Vec<Vector2<f64>> {
    (0..n).map(|_| Vector2::new(random.number(), random.number())).collect()
}
