//! Lemke's pivoting on the linear complementarity problem of plane friction.
//!
//! **What it solves**: exact Signorini–Coulomb in the plane, by a finite number of pivots; H may be
//! asymmetric or singular.
//!
//! **When to use it**: for some tens to some hundred plane contacts where Gauss–Seidel is slow.
//!
//! **How**: with p_T = λ − μ p_N and u_T = u⁺ − u⁻ the law of contact i is three complementary
//! pairs (Klarbring 1986, doi 10.1016/0045-7825(86)90074-8)
//!
//! ```text
//! 0 ≤ u_N ⊥ p_N ≥ 0,   0 ≤ u⁺ = u_T + u⁻ ⊥ λ ≥ 0,   0 ≤ 2 μ p_N − λ ⊥ u⁻ ≥ 0
//! ```
//!
//! (one pair if μ = 0), together w = M z + q. Lemke's method (Cottle, Pang and Stone 1992, doi
//! 10.1137/1.9780898719000, §4.4) adds an artificial variable z₀ to every row and pivots it out
//! again. Ties are broken lexicographically, so it can't cycle in exact arithmetic.
//!
//! **Cost**: a dense tableau of (3n)² numbers, which is kept. A pivot costs at most as many
//! multiplications (zeros are skipped), and there are about 1 to 4 pivots per contact, so O(n³).
//! Because of the memory of 72 n² bytes it refuses more than [`Lemke::MAX_CONTACTS`] contacts.
//! `iterations` counts pivots.
//!
//! **How it fails**: `breakdown` if z₀ can't be pivoted out (a ray: the problem may have no
//! solution, or the method doesn't find it, as with large μ), if there are too many contacts, and
//! if rounding has spoilt the tableau, which the residual shows. With μ above some thousands, λ − μ
//! p_N loses as many digits as μ has.
//!
//! Departures: the initial impulses are returned if they already solve the problem, but aren't used
//! otherwise; two steps of iterative refinement with the final tableau remove the rounding of the
//! pivots; the pairs are scaled by ρ and the largest |q|, so that units don't matter.

use crate::memory::reserve;
use nalgebra::Vector2;
use teeter_contact::{BlockSparse, ContactProblem, ContactSolver, Law, Outcome, Status, Stop, judge};

/// Least pivot relative to the largest number of its column; smaller ones are rounding.
const PIVOT: f64 = 1e-10;

/// Ratios that differ by less (with the largest |q| scaled to 1) are tied.
const TIE: f64 = 1e-13;

/// The pivoting solver; see the [crate's table](crate).
#[derive(Clone, Debug, Default)]
pub struct Lemke {
    h: BlockSparse<2>,
    /// First row of each contact, and at the end the number of rows.
    base: Vec<usize>,
    /// x_B = `constant` + `tableau` x_N; by rows, one column more than rows.
    tableau: Vec<f64>,
    constant: Vec<f64>,
    /// The variables of rows and columns: w_k is k, z_k is m + k, z₀ is 2 m.
    basic: Vec<usize>,
    nonbasic: Vec<usize>,
    /// The place of each variable: row r is r, column c is m + c.
    place: Vec<usize>,
    /// The pivot row, and the indices of its nonzeros.
    pivot_row: Vec<f64>,
    nonzero: Vec<usize>,
    /// Tied rows.
    tied: Vec<usize>,
    values: Vec<f64>,
    missing: Vec<f64>,
    found: Vec<Vector2<f64>>,
}

/// The end of the pivoting.
enum PivotEnd {
    Solved,
    Ray,
    Cap,
    Cancelled,
}

impl Lemke {
    /// The name by which users choose it.
    pub const NAME: &'static str = "lemke";

    /// Largest number of contacts: 72 MB of tableau.
    pub const MAX_CONTACTS: usize = 1000;

    /// A solver.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    fn rows(&self) -> usize {
        self.constant.len()
    }

    /// Sets up the complementarity problem, with velocities in units of `speed` and impulses in
    /// units of ρ `speed`.
    fn set_up(&mut self, problem: &ContactProblem<'_, 2>, rho: f64, speed: f64) {
        let (n, mu) = (problem.contacts(), problem.mu());
        self.h.gather(problem);
        self.base.clear();
        let mut m = 0;
        for i in 0..n {
            self.base.push(m);
            m += if mu[i] == 0.0 { 1 } else { 3 };
        }
        self.base.push(m);
        let width = m + 1;
        self.tableau.clear();
        self.tableau.resize(m * width, 0.0);
        self.constant.clear();
        self.constant.resize(m, 0.0);
        for i in 0..n {
            let row = self.base[i];
            let rubs = mu[i] > 0.0;
            self.constant[row] = problem.q()[i][0] / speed;
            for (j, h) in self.h.row(i) {
                let column = self.base[j];
                let h = h * rho;
                for a in 0..if rubs { 2 } else { 1 } {
                    let at = (row + a) * width + column;
                    self.tableau[at] = h[(a, 0)];
                    if mu[j] > 0.0 {
                        self.tableau[at] -= mu[j] * h[(a, 1)];
                        self.tableau[at + 1] = h[(a, 1)];
                    }
                }
            }
            if rubs {
                self.constant[row + 1] = problem.q()[i][1] / speed;
                self.tableau[(row + 1) * width + row + 2] = 1.0;
                self.tableau[(row + 2) * width + row] = 2.0 * mu[i];
                self.tableau[(row + 2) * width + row + 1] = -1.0;
            }
        }
        for row in 0..m {
            self.tableau[row * width + m] = 1.0;
        }
        self.basic.clear();
        self.basic.extend(0..m);
        self.nonbasic.clear();
        self.nonbasic.extend(m..=2 * m);
        self.place.clear();
        self.place.extend(0..=2 * m);
    }

    /// Exchanges the variables of a row and a column.
    fn pivot(&mut self, row: usize, column: usize) {
        let (m, width) = (self.rows(), self.rows() + 1);
        let inverse = self.tableau[row * width + column].recip();
        self.pivot_row.clear();
        self.pivot_row.extend(self.tableau[row * width..(row + 1) * width].iter().map(|x| -x * inverse));
        self.pivot_row[column] = inverse;
        let constant = -self.constant[row] * inverse;
        self.nonzero.clear();
        self.nonzero.extend((0..width).filter(|&c| c != column && self.pivot_row[c] != 0.0));
        let sparse = self.nonzero.len() * 4 < width;
        for r in 0..m {
            let other = &mut self.tableau[r * width..(r + 1) * width];
            let factor = other[column];
            if r == row || factor == 0.0 {
                continue;
            }
            // The column enters the dense loop with its final values.
            other[column] = 0.0;
            if sparse {
                for &c in &self.nonzero {
                    other[c] += factor * self.pivot_row[c];
                }
                other[column] = factor * inverse;
            } else {
                for (x, y) in other.iter_mut().zip(&self.pivot_row) {
                    *x += factor * y;
                }
            }
            self.constant[r] += factor * constant;
        }
        self.tableau[row * width..(row + 1) * width].copy_from_slice(&self.pivot_row);
        self.constant[row] = constant;
        std::mem::swap(&mut self.basic[row], &mut self.nonbasic[column]);
        self.place[self.basic[row]] = row;
        self.place[self.nonbasic[column]] = m + column;
    }

    /// The derivative of x_B in row `r` with respect to q_j, an entry of the basis inverse.
    fn sensitivity(&self, r: usize, j: usize) -> f64 {
        let m = self.rows();
        match self.place[j] {
            row if row < m => f64::from(u8::from(row == r)),
            column => -self.tableau[r * (m + 1) + column - m],
        }
    }

    /// The lexicographically first of the tied rows, with ratios over −`column`; z₀ takes
    /// precedence.
    fn first_of_ties(&mut self, column: usize) -> Option<usize> {
        let (m, width) = (self.rows(), self.rows() + 1);
        let mut tied = std::mem::take(&mut self.tied);
        if let Some(&row) = tied.iter().find(|&&row| self.basic[row] == 2 * m) {
            tied.clear();
            tied.push(row);
        }
        let mut j = 0;
        while tied.len() > 1 && j < m {
            let ratio = |row: usize| self.sensitivity(row, j) / self.tableau[row * width + column].abs();
            let least = tied.iter().map(|&row| ratio(row)).fold(f64::INFINITY, f64::min);
            let limit = least + TIE * (1.0 + least.abs());
            tied.retain(|&row| ratio(row) <= limit);
            j += 1;
        }
        let row = tied.first().copied();
        self.tied = tied;
        row
    }

    fn run(&mut self, stop: &Stop<'_>, pivots: &mut u32) -> PivotEnd {
        let (m, width) = (self.rows(), self.rows() + 1);
        let least = self.constant.iter().copied().fold(0.0, f64::min);
        if least >= 0.0 {
            return PivotEnd::Solved;
        }
        // z₀ enters, large enough for the most negative row.
        let mut column = m;
        self.tied.clear();
        self.tied.extend((0..m).filter(|&row| self.constant[row] <= least + TIE));
        let Some(mut row) = self.first_of_ties(column) else { return PivotEnd::Ray };
        loop {
            if *pivots >= stop.max_iterations {
                return PivotEnd::Cap;
            }
            if stop.cancelled() {
                return PivotEnd::Cancelled;
            }
            let leaving = self.basic[row];
            self.pivot(row, column);
            *pivots += 1;
            if leaving == 2 * m {
                return PivotEnd::Solved;
            }
            // The complement of the leaving variable enters.
            let partner = if leaving < m { leaving + m } else { leaving - m };
            column = self.place[partner] - m;
            let largest = (0..m).fold(0.0, |size: f64, r| size.max(self.tableau[r * width + column].abs()));
            let mut least = f64::INFINITY;
            for r in 0..m {
                let x = self.tableau[r * width + column];
                if x < -PIVOT * largest {
                    least = least.min(self.constant[r].max(0.0) / -x);
                }
            }
            if !least.is_finite() {
                return PivotEnd::Ray;
            }
            self.tied.clear();
            for r in 0..m {
                let x = self.tableau[r * width + column];
                if x < -PIVOT * largest && self.constant[r].max(0.0) / -x <= least + TIE * (1.0 + least) {
                    self.tied.push(r);
                }
            }
            match self.first_of_ties(column) {
                Some(next) => row = next,
                None => return PivotEnd::Ray,
            }
        }
    }

    /// The values of all variables, in `values`.
    fn evaluate(&mut self) {
        self.values.clear();
        self.values.resize(2 * self.rows() + 1, 0.0);
        for (&variable, &value) in self.basic.iter().zip(&self.constant) {
            self.values[variable] = value;
        }
    }

    /// The impulses of the final basis, in `found`.
    fn impulses(&mut self, problem: &ContactProblem<'_, 2>, unit: f64) {
        self.evaluate();
        let m = self.rows();
        self.found.clear();
        for (i, &mu) in problem.mu().iter().enumerate() {
            let z = m + self.base[i];
            let normal = self.values[z];
            let tangential = if mu > 0.0 { self.values[z + 1] - mu * normal } else { 0.0 };
            self.found.push(Vector2::new(normal, tangential) * unit);
        }
        self.confine(problem);
    }

    /// Moves impulses that the basis puts on the boundary of their cone onto it, and keeps the
    /// others inside despite rounding.
    fn confine(&mut self, problem: &ContactProblem<'_, 2>) {
        let m = self.rows();
        for (i, (p, &mu)) in self.found.iter_mut().zip(problem.mu()).enumerate() {
            let row = self.base[i];
            p[0] = p[0].max(0.0);
            let limit = mu * p[0];
            let at_limit = |variable: usize| self.place[variable] >= m;
            p[1] = if mu > 0.0 && at_limit(m + row + 1) {
                -limit
            } else if mu > 0.0 && at_limit(row + 2) {
                limit
            } else {
                p[1].clamp(-limit, limit)
            };
        }
    }

    /// Iterative refinement: the residual of w = M z + q, computed from H and the impulses, is
    /// corrected with the basis inverse. It acts on p_T, not on λ, which has lost as many digits as
    /// μ has.
    fn refine(&mut self, problem: &ContactProblem<'_, 2>, rho: f64, speed: f64) {
        let (m, unit) = (self.rows(), rho * speed);
        self.evaluate();
        self.missing.clear();
        self.missing.resize(m, 0.0);
        let (w, z) = self.values.split_at(m);
        for i in 0..problem.contacts() {
            let (row, mu, p) = (self.base[i], problem.mu()[i], self.found[i]);
            let u = problem.velocity(i, &self.found) / speed;
            self.missing[row] = w[row] - u[0];
            if mu > 0.0 {
                self.missing[row + 1] = w[row + 1] - u[1] - z[row + 2];
                self.missing[row + 2] = w[row + 2] - (mu * p[0] - p[1]) / unit;
            }
        }
        self.values.fill(0.0);
        for r in 0..m {
            let correction: f64 = (0..m).map(|j| self.sensitivity(r, j) * self.missing[j]).sum();
            self.constant[r] -= correction;
            self.values[self.basic[r]] = -correction;
        }
        for (i, (p, &mu)) in self.found.iter_mut().zip(problem.mu()).enumerate() {
            let z = m + self.base[i];
            p[0] += self.values[z] * unit;
            if mu > 0.0 {
                p[1] += (self.values[z + 1] - mu * self.values[z]) * unit;
            }
        }
        self.confine(problem);
    }
}

impl ContactSolver<2> for Lemke {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn law(&self) -> Law {
        Law::Exact
    }

    fn reserve(&mut self, contacts: usize, blocks: usize) {
        let n = contacts.min(Self::MAX_CONTACTS);
        let (m, all) = (3 * n, 6 * n + 1);
        self.h.reserve(n, blocks);
        for (vector, wanted) in [
            (&mut self.tableau, m * (m + 1)),
            (&mut self.constant, m),
            (&mut self.pivot_row, m + 1),
            (&mut self.values, all),
            (&mut self.missing, m),
        ] {
            reserve(vector, wanted);
        }
        for (vector, wanted) in [
            (&mut self.base, n + 1),
            (&mut self.basic, m),
            (&mut self.nonbasic, m + 1),
            (&mut self.place, all),
            (&mut self.nonzero, m + 1),
            (&mut self.tied, m),
        ] {
            reserve(vector, wanted);
        }
        reserve(&mut self.found, n);
    }

    fn solve(&mut self, problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector2<f64>]) -> Outcome {
        for x in p.iter_mut() {
            if !x.iter().all(|c| c.is_finite()) {
                *x = Vector2::zeros();
            }
        }
        let start = judge(problem, p);
        if start.global <= stop.tolerance {
            return Outcome::new(Status::Converged, Self::NAME, 0, start);
        }
        if p.len() > Self::MAX_CONTACTS {
            return Outcome::new(Status::Breakdown, Self::NAME, 0, start);
        }
        let rho = problem.scale();
        let speed = problem.q().iter().map(Vector2::amax).fold(f64::MIN_POSITIVE, f64::max);
        self.set_up(problem, rho, speed);
        let mut pivots = 0;
        let end = self.run(stop, &mut pivots);
        self.impulses(problem, rho * speed);
        for _ in 0..2 {
            if matches!(end, PivotEnd::Solved) {
                self.refine(problem, rho, speed);
            }
        }
        let mut residual = judge(problem, &self.found);
        // The result of pivoting may be worse than the initial impulses, or NaN.
        if residual.global < start.global || !start.global.is_finite() {
            p.copy_from_slice(&self.found);
        } else {
            residual = start;
        }
        let status = match end {
            _ if residual.global <= stop.tolerance => Status::Converged,
            PivotEnd::Solved | PivotEnd::Ray => Status::Breakdown,
            PivotEnd::Cap => Status::MaxIterations,
            PivotEnd::Cancelled => Status::Cancelled,
        };
        Outcome::new(status, Self::NAME, pivots, residual)
    }

    fn fork(&self) -> Box<dyn ContactSolver<2>> {
        Box::new(Self::new())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_contact::conformance::{body_on_floor, plane_cases, run};

    #[test]
    fn conforms() {
        run(&mut Lemke::new(), &plane_cases(), 1e-11).unwrap();
    }

    #[test]
    fn a_row_of_many_feet_is_solved_to_rounding() {
        let feet: Vec<(f64, f64)> = (0..40).map(|i| (0.1 * f64::from(i) - 1.95, -1.0)).collect();
        for velocity in [[3.0, -1.0, 0.0], [0.1, -1.0, 0.3], [0.0, -1.0, 0.0]] {
            let case = body_on_floor("forty", 0.3, &feet, velocity, 0.2);
            let mut p = vec![Vector2::zeros(); 40];
            let stop = Stop::default().with_tolerance(1e-12);
            let outcome = Lemke::new().solve(&case.problem().unwrap(), &stop, &mut p);
            assert!(outcome.converged(), "{outcome:?}");
        }
    }

    #[test]
    fn a_problem_without_solution_is_a_breakdown() {
        // H is indefinite: a normal impulse increases the approach velocity.
        let h = [nalgebra::Matrix2::new(1.0, 0.0, 0.0, 1.0), nalgebra::Matrix2::new(-2.0, 0.0, 0.0, 0.0)];
        let h = [h[0], h[1], h[1], h[0]];
        let (q, mu) = ([Vector2::new(-1.0, 5.0); 2], [0.5; 2]);
        let problem = ContactProblem::new(teeter_contact::Delassus::Dense(&h), &q, &mu).unwrap();
        let mut p = [Vector2::zeros(); 2];
        let outcome = Lemke::new().solve(&problem, &Stop::default(), &mut p);
        assert_eq!(outcome.status, Status::Breakdown, "{outcome:?}");
        assert!(outcome.residual.global > 0.1);
    }

    #[test]
    fn pivots_are_counted_and_limited() {
        let feet = [(-0.5, -1.0), (-0.1, -1.0), (0.2, -1.0), (0.5, -1.0)];
        let case = body_on_floor("four", 0.3, &feet, [0.3, -1.0, 0.2], 0.5);
        let mut p = vec![Vector2::zeros(); 4];
        let stop = Stop::default().with_max_iterations(2);
        let outcome = Lemke::new().solve(&case.problem().unwrap(), &stop, &mut p);
        assert_eq!((outcome.status, outcome.iterations), (Status::MaxIterations, 2));
    }
}
