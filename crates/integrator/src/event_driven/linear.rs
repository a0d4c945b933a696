//! Small linear systems that may be singular but are consistent: forces of more contacts than a
//! body needs.

/// A square system A x = b with its memory.
#[derive(Debug, Default)]
pub(super) struct Linear {
    n: usize,
    a: Vec<f64>,
    lu: Vec<f64>,
    b: Vec<f64>,
    x: Vec<f64>,
    rest: Vec<f64>,
    pivots: Vec<usize>,
}

/// What is added to the diagonal, as a part of it: it decides between solutions, and the refinement
/// takes it out again.
const SHIFT: f64 = 1e-8;

/// An unknown without an entry of its own is shifted by this part of the largest.
const LEAST_OWN: f64 = 1e-12;

/// Equations that contradict each other by less than this part of their size don't: contacts whose accelerations are
/// less than 1e-8 of what they consist of stick, and several of them may hold the same motion.
const CONTRADICTION: f64 = 3e-8;

/// Most refinements: each gains some eight digits of what is determined, by weights of up to a million two.
const REFINEMENTS: usize = 8;

impl Linear {
    pub(super) fn reserve(&mut self, n: usize) {
        for (list, len) in [(&mut self.a, n * n), (&mut self.lu, n * n), (&mut self.b, n), (&mut self.x, n)] {
            list.reserve(len.saturating_sub(list.len()));
        }
        self.rest.reserve(n.saturating_sub(self.rest.len()));
        self.pivots.reserve(n.saturating_sub(self.pivots.len()));
    }

    /// Zeros of this size.
    pub(super) fn clear(&mut self, n: usize) {
        self.n = n;
        for (list, len) in [(&mut self.a, n * n), (&mut self.b, n)] {
            list.clear();
            list.resize(len, 0.0);
        }
    }

    pub(super) fn set(&mut self, i: usize, j: usize, value: f64) {
        self.a[i * self.n + j] = value;
    }

    pub(super) fn right(&mut self, i: usize, value: f64) {
        self.b[i] = value;
    }

    pub(super) fn solution(&self) -> &[f64] {
        &self.x
    }

    /// Solves; of several solutions of a symmetric system that with the least Σ w a x², w the `weights`
    /// and a the diagonal. Whether the system has a solution, up to the rounding of the right sides, at least of one of
    /// size `least`.
    pub(super) fn solve(&mut self, least: f64, weights: impl Fn(usize) -> f64) -> bool {
        let n = self.n;
        let own = |a: &[f64], i: usize| a[i * n + i].abs();
        let largest = (0..n).map(|i| own(&self.a, i)).fold(0.0, f64::max);
        self.lu.clear();
        self.lu.extend_from_slice(&self.a);
        for i in 0..n {
            self.lu[i * n + i] += SHIFT * own(&self.a, i).max(LEAST_OWN * largest) * weights(i);
        }
        if !self.factor() {
            return false;
        }
        self.x.clear();
        self.x.resize(n, 0.0);
        for _ in 0..REFINEMENTS {
            self.rest.clear();
            let mut settled = true;
            for i in 0..n {
                let row = &self.a[i * n..(i + 1) * n];
                let (mut rest, mut size) = (self.b[i], self.b[i].abs());
                for (a, x) in row.iter().zip(&self.x) {
                    (rest, size) = (rest - a * x, size + (a * x).abs());
                }
                settled &= rest.abs() <= f64::EPSILON * size;
                self.rest.push(rest);
            }
            if settled {
                break;
            }
            self.substitute();
            self.x.iter_mut().zip(&self.rest).for_each(|(x, dx)| *x += dx);
        }
        let given = self.b.iter().fold(least, |given: f64, b| given.max(b.abs()));
        // A contradiction makes x large.
        let size = |i: usize| -> f64 {
            let row = &self.a[i * n..(i + 1) * n];
            given + 1e-3 * row.iter().zip(&self.x).map(|(a, x)| (a * x).abs()).sum::<f64>()
        };
        (0..n).all(|i| {
            let row = &self.a[i * n..(i + 1) * n];
            let rest = self.b[i] - row.iter().zip(&self.x).map(|(a, x)| a * x).sum::<f64>();
            rest.abs() <= CONTRADICTION * size(i)
        })
    }

    /// LU with row pivots; whether no pivot is 0.
    fn factor(&mut self) -> bool {
        let (n, lu) = (self.n, &mut self.lu);
        self.pivots.clear();
        for k in 0..n {
            let largest = (k..n).max_by(|i, j| lu[i * n + k].abs().total_cmp(&lu[j * n + k].abs())).unwrap_or(k);
            self.pivots.push(largest);
            if largest != k {
                (0..n).for_each(|j| lu.swap(k * n + j, largest * n + j));
            }
            let pivot = lu[k * n + k];
            // Also true for NaN.
            if !(pivot.abs() > 0.0 && pivot.is_finite()) {
                return false;
            }
            for i in k + 1..n {
                let factor = lu[i * n + k] / pivot;
                lu[i * n + k] = factor;
                for j in k + 1..n {
                    lu[i * n + j] -= factor * lu[k * n + j];
                }
            }
        }
        true
    }

    /// Turns `rest` into the solution for it.
    fn substitute(&mut self) {
        let (n, lu, x) = (self.n, &self.lu, &mut self.rest);
        for k in 0..n {
            x.swap(k, self.pivots[k]);
        }
        for i in 1..n {
            x[i] -= (0..i).map(|j| lu[i * n + j] * x[j]).sum::<f64>();
        }
        for i in (0..n).rev() {
            let sum = x[i] - (i + 1..n).map(|j| lu[i * n + j] * x[j]).sum::<f64>();
            x[i] = sum / lu[i * n + i];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn system(a: [[f64; 3]; 3], b: [f64; 3]) -> Linear {
        let mut linear = Linear::default();
        linear.clear(3);
        for i in 0..3 {
            (0..3).for_each(|j| linear.set(i, j, a[i][j]));
            linear.right(i, b[i]);
        }
        linear
    }

    #[test]
    fn a_regular_system_is_solved_to_rounding() {
        let mut linear = system([[0.0, 2.0, 1.0], [3.0, 1.0, 0.5], [1.0, 1.0, 4.0]], [7.0, 6.5, 15.0]);
        assert!(linear.solve(0.0, |_| 1.0));
        assert!(linear.solution().iter().zip([1.0, 2.0, 3.0]).all(|(x, y)| (x - y).abs() < 1e-14), "{linear:?}");
    }

    #[test]
    fn of_several_solutions_the_least_is_found_and_a_contradiction_is_none() {
        let singular = [[1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 2.0]];
        let mut linear = system(singular, [3.0, 3.0, 4.0]);
        assert!(linear.solve(0.0, |_| 1.0));
        assert!(linear.solution().iter().zip([1.5, 1.5, 2.0]).all(|(x, y)| (x - y).abs() < 1e-7), "{linear:?}");
        // What is not determined has the digits that the shift leaves.
        assert!(linear.solve(0.0, |i| [1.0, 0.5, 1.0][i]));
        assert!(linear.solution().iter().zip([1.0, 2.0, 2.0]).all(|(x, y)| (x - y).abs() < 1e-7), "{linear:?}");
        assert!(!system(singular, [3.0, 3.1, 4.0]).solve(0.0, |_| 1.0));
        // What is left where forces cancel is rounding.
        assert!(!system(singular, [3e-36, 2e-36, 4e-36]).solve(0.0, |_| 1.0));
        assert!(system(singular, [3e-36, 2e-36, 4e-36]).solve(1e-3, |_| 1.0));
        // Accelerations that stick to 1e-8 don't contradict each other.
        assert!(system(singular, [3.0, 3.0 + 3e-8, 4.0]).solve(0.0, |_| 1.0));
    }
}
