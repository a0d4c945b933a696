//! The convex problem `min ½ pᵀSp + (q + s)ᵀp`, ‖p_T‖ ≤ μ p_N, in Clarabel's form.

use crate::upper::Upper;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, SupportedConeT};
use teeter_contact::{BlockSparse, ContactProblem, Vector};

/// The tolerance passed to Clarabel; the result is checked by the residual.
const TOLERANCE: f64 = 1e-12;

/// The cone programs of one problem: fixed H and μ, any linear term.
pub(crate) struct ConeProgram<const D: usize> {
    solver: DefaultSolver<f64>,
    /// The linear term in Clarabel's units.
    linear: Vec<f64>,
    /// The factor that velocities are divided and impulses multiplied by.
    speed: f64,
    impulse: f64,
}

impl<const D: usize> ConeProgram<D> {
    /// `None` if Clarabel refuses the data.
    pub(crate) fn new(problem: &ContactProblem<'_, D>, h: &BlockSparse<D>, upper: &mut Upper<D>) -> Option<Self> {
        let (n, rho) = (problem.contacts(), problem.scale());
        upper.load(h);
        let speed = problem.q().iter().flatten().fold(0.0_f64, |most, c| most.max(c.abs()));
        let speed = if speed > 0.0 { speed } else { 1.0 };
        let quadratic = CscMatrix::new(
            n * D,
            n * D,
            upper.starts.clone(),
            upper.rows.clone(),
            upper.values.iter().map(|value| value * rho).collect(),
        );
        // Rows by contact; s = b − A p lies in the cone with b = 0, so the signs of A are reversed.
        let (mut of_row, mut of_column, mut values) = (Vec::new(), Vec::new(), Vec::new());
        let (mut cones, mut rows) = (Vec::new(), 0);
        let mut entry = |row: usize, column: usize, value: f64| {
            of_row.push(row);
            of_column.push(column);
            values.push(-value);
        };
        for i in 0..n {
            let mu = problem.mu()[i];
            // ‖p_T‖ ≤ μ p_N divided by the larger of 1 and μ, so that no row is large.
            let (normal, tangential) = if mu > 1.0 { (1.0, mu.recip()) } else { (mu, 1.0) };
            if mu == 0.0 {
                // A cone with μ = 0 would lose p_N ≥ 0.
                entry(rows, i * D, 1.0);
                cones.push(SupportedConeT::NonnegativeConeT(1));
                (1..D).for_each(|k| entry(rows + k, i * D + k, 1.0));
                cones.push(SupportedConeT::ZeroConeT(D - 1));
                rows += D;
            } else if D == 2 {
                for (k, sign) in [1.0, -1.0].into_iter().enumerate() {
                    entry(rows + k, i * D, normal);
                    entry(rows + k, i * D + 1, sign * tangential);
                }
                cones.push(SupportedConeT::NonnegativeConeT(2));
                rows += 2;
            } else {
                entry(rows, i * D, normal);
                (1..D).for_each(|k| entry(rows + k, i * D + k, tangential));
                cones.push(SupportedConeT::SecondOrderConeT(D));
                rows += D;
            }
        }
        let constraints = CscMatrix::new_from_triplets(rows, n * D, of_row, of_column, values);
        let settings = DefaultSettingsBuilder::default()
            .verbose(false)
            .presolve_enable(false)
            .input_sparse_dropzeros(false)
            .max_threads(1)
            .tol_gap_abs(TOLERANCE)
            .tol_gap_rel(TOLERANCE)
            .tol_feas(TOLERANCE)
            .max_iter(100)
            .build()
            .ok()?;
        let linear = vec![0.0; n * D];
        let bounds = vec![0.0; rows];
        let solver = DefaultSolver::new(&quadratic, &linear, &constraints, &bounds, &cones, settings).ok()?;
        Some(Self { solver, linear, speed, impulse: rho * speed })
    }

    /// Solves with the linear term `term(i)` of each contact into `p`; false if the result isn't
    /// finite. Clarabel's status is ignored: "almost solved" is often as good, and the residual is
    /// checked.
    pub(crate) fn solve(&mut self, term: impl Fn(usize) -> Vector<D>, p: &mut [Vector<D>]) -> bool {
        for i in 0..p.len() {
            for (to, from) in self.linear[i * D..(i + 1) * D].iter_mut().zip(term(i).iter()) {
                *to = from / self.speed;
            }
        }
        if self.solver.update_q(&self.linear).is_err() {
            return false;
        }
        self.solver.solve();
        let x = &self.solver.solution.x;
        if x.len() != p.len() * D || !x.iter().all(|c| c.is_finite()) {
            return false;
        }
        for (to, from) in p.iter_mut().flatten().zip(x) {
            *to = from * self.impulse;
        }
        true
    }
}
