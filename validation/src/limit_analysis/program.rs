//! The linear programme: equilibrium of every block under admissible forces of the joints.

use super::{Assemblage, LimitError, Point, Side};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

/// Asked of Clarabel: residuals and gap, relative to a block's weight.
const TOLERANCE: f64 = 1e-11;

/// What is accepted of it, recomputed, in the same unit. A hundredth of what [`STANDING`] leaves.
const ACCEPTED: f64 = 1e-9;

/// A margin that is less than this below zero still stands: where the exact margin is zero, as of a block that just
/// balances on its edge, the programme's is of the order of [`ACCEPTED`]. In mean weights of a block.
const STANDING: f64 = 1e-7;

/// No margin is larger: wedged blocks could be pressed together without end.
const HIGHEST_MARGIN: f64 = 1.0;

/// A force on a block besides its weight.
#[derive(Clone, Copy, Debug)]
pub struct Load {
    /// Index of the block.
    pub block: usize,
    /// Where it acts.
    pub at: Point,
    /// In the unit of the weights.
    pub force: Point,
}

/// How far a load can be raised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LoadFactor {
    /// Up to this; below zero if the assemblage needs a load of the other sign to stand.
    Largest(f64),
    /// Without end.
    Unbounded,
    /// There is no equilibrium under any multiple of the load.
    NoEquilibrium,
}

/// The largest s, in mean weights of a block, with which an equilibrium exists that has N ≥ s at both ends of every joint
/// and |T| ≤ μ (N₁ + N₂ − s); at most 1, and −∞ if there is none with any s.
///
/// Zero is the limit of standing. Near it the margin is proportional to the distance from it, so that it can be bisected; the
/// sign alone couldn't be told from rounding.
///
/// # Errors
///
/// [`LimitError::Friction`] where μ is negative or not finite, [`LimitError::Solver`] where the programme couldn't be solved.
pub fn margin(assemblage: &Assemblage, friction: f64) -> Result<f64, LimitError> {
    match solve(assemblage, friction, &Direction::Margin)? {
        LoadFactor::Largest(margin) => Ok(margin),
        LoadFactor::NoEquilibrium => Ok(f64::NEG_INFINITY),
        LoadFactor::Unbounded => Err(LimitError::Solver("a bounded margin was unbounded".to_owned())),
    }
}

/// Whether an admissible equilibrium under self-weight exists.
///
/// # Errors
///
/// As [`margin`].
pub fn stands(assemblage: &Assemblage, friction: f64) -> Result<bool, LimitError> {
    Ok(margin(assemblage, friction)? >= -STANDING)
}

/// The largest λ such that an admissible equilibrium exists under self-weight and λ times the loads.
///
/// # Errors
///
/// As [`margin`], and [`LimitError::Load`] where a load is on no block or not finite.
pub fn load_factor(assemblage: &Assemblage, friction: f64, loads: &[Load]) -> Result<LoadFactor, LimitError> {
    let blocks = assemblage.blocks().len();
    let finite = |load: &Load| load.at.iter().chain(load.force.iter()).all(|c| c.is_finite());
    if !loads.iter().all(|load| load.block < blocks && finite(load)) {
        return Err(LimitError::Load);
    }
    solve(assemblage, friction, &Direction::Loads(loads))
}

/// The loads of a static acceleration in units of gravity: every weight along `direction`.
#[must_use]
pub fn accelerated(assemblage: &Assemblage, direction: Point) -> Vec<Load> {
    let load = |(block, of): (usize, &super::Block)| Load { block, at: of.centroid, force: direction * of.weight };
    assemblage.blocks().iter().enumerate().map(load).collect()
}

/// What the last unknown multiplies.
enum Direction<'a> {
    Margin,
    Loads(&'a [Load]),
}

/// Rows `a·x + slack = b`, slack = 0 of the first `equalities` and ≥ 0 of the rest.
#[derive(Default)]
struct Rows {
    entries: (Vec<usize>, Vec<usize>, Vec<f64>),
    right: Vec<f64>,
}

impl Rows {
    fn entry(&mut self, row: usize, column: usize, value: f64) {
        self.entries.0.push(row);
        self.entries.1.push(column);
        self.entries.2.push(value);
    }

    /// A new row Σ value · x_column ≥ −right, or = −right.
    fn push(&mut self, entries: &[(usize, f64)], right: f64) {
        let row = self.right.len();
        for &(column, value) in entries {
            self.entry(row, column, -value);
        }
        self.right.push(right);
    }
}

/// Unknowns: N₁, N₂, T of each joint (mean weights of a block), then the margin or the load factor.
///
/// Forces T₁ and T₂ at the ends of a joint act along one line: only their sum matters, and |T| ≤ μ (N₁ + N₂) is all that
/// the two cones say about it.
fn solve(assemblage: &Assemblage, friction: f64, direction: &Direction<'_>) -> Result<LoadFactor, LimitError> {
    if !(friction >= 0.0 && friction.is_finite()) {
        return Err(LimitError::Friction(friction));
    }
    let (joints, last) = (assemblage.joints().len(), 3 * assemblage.joints().len());
    let mut rows = equilibrium(assemblage, direction);
    if friction == 0.0 {
        (0..joints).for_each(|j| rows.push(&[(3 * j + 2, 1.0)], 0.0));
    }
    let equalities = rows.right.len();
    let s = if matches!(direction, Direction::Margin) { 1.0 } else { 0.0 };
    for j in 0..joints {
        let [n_1, n_2, t] = [3 * j, 3 * j + 1, 3 * j + 2];
        rows.push(&[(n_1, 1.0), (last, -s)], 0.0);
        rows.push(&[(n_2, 1.0), (last, -s)], 0.0);
        if friction > 0.0 {
            // No entry larger than one, also where μ stands for no slip.
            let (normal, tangential) = (friction.min(1.0), friction.recip().min(1.0));
            for sign in [1.0, -1.0] {
                rows.push(&[(n_1, normal), (n_2, normal), (t, sign * tangential), (last, -s * normal)], 0.0);
            }
        }
    }
    if s > 0.0 {
        rows.push(&[(last, -1.0)], HIGHEST_MARGIN);
    }
    maximise(rows, equalities, last)
}

/// Three rows a block: forces, and moments about its centroid over the extent.
fn equilibrium(assemblage: &Assemblage, direction: &Direction<'_>) -> Rows {
    let blocks = assemblage.blocks();
    let unit = blocks.iter().map(|block| block.weight).sum::<f64>() / blocks.len() as f64;
    let (extent, last) = (assemblage.extent(), 3 * assemblage.joints().len());
    let mut rows = Rows::default();
    for block in blocks {
        let weight = assemblage.down() * (block.weight / unit);
        rows.right.extend([weight.x, weight.y, 0.0]);
    }
    let mut act = |block: usize, column: usize, at: Point, force: Point| {
        let moment = (at - blocks[block].centroid).perp(&force) / extent;
        for (k, value) in [force.x, force.y, moment].into_iter().enumerate() {
            rows.entry(3 * block + k, column, -value);
        }
    };
    for (j, joint) in assemblage.joints().iter().enumerate() {
        let tangent = Point::new(joint.normal.y, -joint.normal.x);
        let forces = [(joint.ends[0], joint.normal), (joint.ends[1], joint.normal), (joint.ends[0], tangent)];
        for (side, sign) in joint.sides.into_iter().zip([1.0, -1.0]) {
            if let Side::Block(block) = side {
                for (k, (at, force)) in forces.into_iter().enumerate() {
                    act(block, 3 * j + k, at, force * sign);
                }
            }
        }
    }
    if let Direction::Loads(loads) = direction {
        loads.iter().for_each(|load| act(load.block, last, load.at, load.force / unit));
    }
    rows
}

/// The largest value of the unknown `last`.
fn maximise(rows: Rows, equalities: usize, last: usize) -> Result<LoadFactor, LimitError> {
    let (m, n) = (rows.right.len(), last + 1);
    let (of_row, of_column, values) = rows.entries;
    let matrix = CscMatrix::new_from_triplets(m, n, of_row, of_column, values);
    let mut cost = vec![0.0; n];
    cost[last] = -1.0;
    let cones = [SupportedConeT::ZeroConeT(equalities), SupportedConeT::NonnegativeConeT(m - equalities)];
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .max_threads(1)
        .tol_gap_abs(TOLERANCE)
        .tol_gap_rel(TOLERANCE)
        .tol_feas(TOLERANCE)
        .max_iter(200)
        .build()
        .map_err(|error| LimitError::Solver(error.to_string()))?;
    let mut solver = DefaultSolver::new(&CscMatrix::zeros((n, n)), &cost, &matrix, &rows.right, &cones, settings)
        .map_err(|error| LimitError::Solver(error.to_string()))?;
    solver.solve();
    let solution = &solver.solution;
    match solution.status {
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => return Ok(LoadFactor::NoEquilibrium),
        SolverStatus::DualInfeasible | SolverStatus::AlmostDualInfeasible => return Ok(LoadFactor::Unbounded),
        _ => {}
    }
    let wrong = violation(&matrix, &rows.right, equalities, &solution.x);
    let gap = (solution.obj_val - solution.obj_val_dual).abs() / (1.0 + solution.obj_val.abs());
    if wrong <= ACCEPTED && gap <= ACCEPTED {
        Ok(LoadFactor::Largest(solution.x[last]))
    } else {
        Err(LimitError::Solver(format!("{:?}, rows off by {wrong:.1e}, gap {gap:.1e}", solution.status)))
    }
}

/// By how much the worst row is missed, relative to the largest unknown or 1; infinite where a number isn't one.
fn violation(matrix: &CscMatrix<f64>, right: &[f64], equalities: usize, x: &[f64]) -> f64 {
    let mut slack = right.to_vec();
    for (column, value) in x.iter().enumerate() {
        for k in matrix.colptr[column]..matrix.colptr[column + 1] {
            slack[matrix.rowval[k]] -= matrix.nzval[k] * value;
        }
    }
    let missed = |(row, slack): (usize, &f64)| if row < equalities { slack.abs() } else { (-slack).max(0.0) };
    if !slack.iter().all(|s| s.is_finite()) {
        return f64::INFINITY;
    }
    let size = x.iter().fold(1.0_f64, |most, value| most.max(value.abs()));
    slack.iter().enumerate().map(missed).fold(0.0, f64::max) / size
}
