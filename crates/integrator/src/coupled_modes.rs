//! Small vibrations about an equilibrium: coupled modes of blocks and beams that rest on each
//! other.
//!
//! Contacts under pressure are assumed to stay closed and to stick, so each is a joint between a
//! point of one body and a point of the other: C ẋ = 0 with C the contacts' Jacobian. With C's null
//! space N,
//!
//! ```text
//! Nᵀ K' N y = ω² NᵀM N y        K' = K − ∂(J(q)ᵀλ)/∂q        x = N y
//! ```
//!
//! The second term of K' is the effect of the contact forces λ when contact points rotate: a block
//! that stands on its feet is an inverted pendulum, and its weight lowers the stiffness. ω² < 0
//! means an unstable equilibrium. Vibrations so large that a contact would slip or open are beyond
//! these modes.

use crate::contact::tangential;
use crate::mismatch::length;
use crate::{Mismatch, Model, Rows, Vector, Weights};
use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};
use teeter_detect::{Anchor, ContactId, Frame};

/// Most velocities of the model: dense matrices of this size take a second.
pub const MOST_VELOCITIES: usize = 1000;

/// A constraint whose independent part is no larger than this (in units of mass) follows from the
/// others, as when two feet both hold a block in x.
const DEPENDENT: f64 = 1e-9;

/// Step of the central difference of J, relative to the size of the moving body: half of the digits
/// are kept.
const DIFFERENCE: f64 = 1e-5;

/// Modes about an equilibrium, made by [`coupled_modes`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CoupledModes {
    /// ω², 1/s², ascending; negative for an unstable equilibrium.
    pub eigenvalues: Vec<f64>,
    /// The velocities of each mode, as long as the model's; xᵀM x = 1.
    pub shapes: Vec<Vec<f64>>,
}

impl CoupledModes {
    /// Circular frequencies of the modes with ω² > 0, rad/s, ascending.
    pub fn circular_frequencies(&self) -> impl Iterator<Item = f64> {
        self.eigenvalues.iter().filter(|squared| **squared > 0.0).map(|squared| squared.sqrt())
    }
}

/// Why modes can't be found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CoupledModesError {
    /// Too many velocities for dense matrices.
    #[error(
        "{velocities} velocities: more than {MOST_VELOCITIES} are not taken into dense matrices; put beams into modes"
    )]
    TooMany {
        /// How many the model has.
        velocities: usize,
    },
    /// A mass matrix that is not positive definite.
    #[error("the mass matrix of what can move is not positive definite")]
    Mass,
    /// Coordinates or contacts of another model.
    #[error(transparent)]
    Mismatch(#[from] Mismatch),
}

/// The first `count` modes of a model about an equilibrium `q`. Contacts with the given forces (on
/// side 0, N, normal first: those of [`Equilibrium`](crate::Equilibrium)) stay closed and stick;
/// those without friction only stay closed.
///
/// # Errors
/// If the model is too large, or its mass matrix not positive definite; or if there are too few or
/// too many coordinates, or forces of a pair that the model doesn't have.
pub fn coupled_modes(
    model: &Model<2>,
    q: &[f64],
    forces: &[(ContactId, Vector<2>)],
    count: usize,
) -> Result<CoupledModes, CoupledModesError> {
    let n = model.size().v;
    if n > MOST_VELOCITIES {
        return Err(CoupledModesError::TooMany { velocities: n });
    }
    length("the coordinates", q, model.size().q)?;
    let mut mass = matrix(model, q, Weights { mass: 1.0, ..Weights::default() });
    let mut stiffness = matrix(model, q, Weights { stiffness: 1.0, ..Weights::default() });
    let mut constraints = Vec::new();
    for touching in touching(model, q, forces)? {
        touching.add_stiffness(model, q, &mut stiffness);
        let directions = if touching.friction > 0.0 { 2 } else { 1 };
        constraints.extend(touching.rows(model, q).into_iter().take(directions));
    }
    // Finite differences make it symmetric to half of the digits only.
    stiffness = (&stiffness + stiffness.transpose()) * 0.5;
    for part in model.parts() {
        for k in part.traits.driven.iter().chain(&part.traits.held) {
            let mut row = DVector::zeros(n);
            row[part.v.start + k] = 1.0;
            constraints.push(row);
        }
    }
    for k in 0..n {
        if mass[(k, k)] <= 0.0 {
            mass[(k, k)] = 1.0; // Held, or prescribed: out by a constraint.
        }
    }
    let free = null_space(constraints, &mass);
    let lower = Cholesky::new(free.transpose() * &mass * &free).ok_or(CoupledModesError::Mass)?.unpack();
    let half = lower.solve_lower_triangular(&(free.transpose() * &stiffness * &free)).ok_or(CoupledModesError::Mass)?;
    let reduced = lower.solve_lower_triangular(&half.transpose()).ok_or(CoupledModesError::Mass)?;
    let eigen = SymmetricEigen::new((&reduced + reduced.transpose()) * 0.5);
    let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    order.sort_unstable_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
    order.truncate(count);
    let shape = |k: usize| {
        let y = lower
            .transpose()
            .solve_upper_triangular(&eigen.eigenvectors.column(k))
            .unwrap_or_else(|| DVector::zeros(0));
        (&free * y).iter().copied().collect()
    };
    Ok(CoupledModes {
        shapes: order.iter().map(|k| shape(*k)).collect(),
        eigenvalues: order.iter().map(|k| eigen.eigenvalues[*k]).collect(),
    })
}

/// M or K of the whole model.
fn matrix(model: &Model<2>, q: &[f64], weights: Weights) -> DMatrix<f64> {
    let n = model.size().v;
    let mut matrix = DMatrix::zeros(n, n);
    for part in model.parts() {
        let (start, len) = (part.v.start, part.v.len());
        let q = &q[part.q.clone()];
        // If matrices follow the coordinates, `apply` doesn't give the tangent: take differences of
        // the force.
        let differences = weights.stiffness != 0.0 && part.traits.follows_coordinates;
        let step = DIFFERENCE * q.iter().fold(1e-6_f64, |size, q| size.max(q.abs()));
        let (mut x, mut y) = (vec![0.0; len], vec![0.0; len]);
        let (rest, mut at) = (vec![0.0; len], q.to_vec());
        for column in 0..len {
            x[column] = 1.0;
            y.fill(0.0);
            if differences {
                for sign in [1.0, -1.0] {
                    part.system.retract(q, &x, sign * step, &mut at);
                    y.iter_mut().for_each(|y| *y = -*y);
                    part.system.internal_force(&at, &rest, &mut y);
                }
                y.iter_mut().for_each(|y| *y *= weights.stiffness / (2.0 * step));
            } else {
                part.system.apply(weights, q, &x, &mut y);
            }
            x[column] = 0.0;
            for (row, y) in y.iter().enumerate() {
                matrix[(start + row, start + column)] = *y;
            }
        }
    }
    matrix
}

/// A contact under pressure.
struct Touching {
    sides: [Anchor<2>; 2],
    frame: Frame<2>,
    force: Vector<2>,
    friction: f64,
}

fn touching(model: &Model<2>, q: &[f64], forces: &[(ContactId, Vector<2>)]) -> Result<Vec<Touching>, Mismatch> {
    let pressing = || forces.iter().filter(|(_, force)| force[0] > 0.0);
    let mut ids: Vec<ContactId> = pressing().map(|(id, _)| *id).collect();
    ids.sort_unstable();
    let mut candidates = Vec::new();
    model.detector().locate(&model.placed_at(q), &ids, &mut candidates);
    pressing()
        .map(|(id, force)| {
            let found = candidates.binary_search_by_key(id, |candidate| candidate.id).ok().map(|at| &candidates[at]);
            let candidate = found.ok_or(Mismatch::NotThere { id: *id })?;
            let friction = model.law(candidate.law)?.friction;
            let force = if friction > 0.0 { *force } else { *force - tangential(force) };
            Ok(Touching { sides: candidate.sides, frame: candidate.frame, force, friction })
        })
        .collect()
}

impl Touching {
    /// J, one row a direction, over all velocities.
    fn rows(&self, model: &Model<2>, q: &[f64]) -> [DVector<f64>; 2] {
        let mut rows = [DVector::zeros(model.size().v), DVector::zeros(model.size().v)];
        for (side, anchor) in self.sides.iter().enumerate() {
            let Some((_, part, body)) = model.owner(anchor.body) else { continue };
            let len = part.system.size().row;
            let (mut columns, mut values) = (vec![0; len], vec![Vector::<2>::zeros(); len]);
            let mut out = Rows::new(&mut columns, &mut values);
            let taken = part.system.rows(body, &q[part.q.clone()], &anchor.point, &self.frame, &mut out);
            let sign = if side == 0 { 1.0 } else { -1.0 };
            for (column, value) in columns.iter().zip(&values).take(taken) {
                for (row, value) in rows.iter_mut().zip(value.iter()) {
                    row[part.v.start + column] += sign * value;
                }
            }
        }
        rows
    }

    /// Subtracts ∂(Jᵀλ)/∂q by central differences along the velocities that the contact moves.
    fn add_stiffness(&self, model: &Model<2>, q: &[f64], stiffness: &mut DMatrix<f64>) {
        let n = model.size().v;
        let rows = self.rows(model, q);
        let moved: Vec<usize> = (0..n).filter(|k| rows.iter().any(|row| row[*k] != 0.0)).collect();
        let (mut v, mut at) = (vec![0.0; n], q.to_vec());
        for &column in &moved {
            // How far the velocity moves the point per unit; the step is a small fraction of the
            // body's size divided by this.
            let size = rows.iter().map(|row| row[column].abs()).fold(0.0, f64::max);
            let step = DIFFERENCE * self.reach() / size;
            v[column] = 1.0;
            let mut side = |tau: f64| {
                model.move_along(q, &v, tau, &mut at);
                let [normal, tangent] = self.rows(model, &at);
                normal * self.force[0] + tangent * self.force[1]
            };
            let change = (side(step) - side(-step)) / (2.0 * step);
            v[column] = 0.0;
            for row in 0..n {
                stiffness[(row, column)] -= change[row];
            }
        }
    }

    /// Distance of the contact's point from the middle of its body, m.
    fn reach(&self) -> f64 {
        self.sides[0].point.norm().max(f64::MIN_POSITIVE)
    }
}

/// A basis of all x with C x = 0: each pivot column is expressed by the others; pivots are the
/// largest entries in units of mass.
fn null_space(mut rows: Vec<DVector<f64>>, mass: &DMatrix<f64>) -> DMatrix<f64> {
    let n = mass.ncols();
    let scale: Vec<f64> = (0..n).map(|k| mass[(k, k)].sqrt().recip()).collect();
    let largest = rows.iter().flat_map(|row| row.iter().zip(&scale).map(|(r, s)| (r * s).abs())).fold(0.0, f64::max);
    let mut pivots: Vec<usize> = Vec::new();
    for done in 0..rows.len() {
        let entries = (done..rows.len()).flat_map(|i| (0..n).map(move |j| (i, j)));
        let size = |(i, j): &(usize, usize)| (rows[*i][*j] * scale[*j]).abs();
        let Some((i, j)) = entries.max_by(|a, b| size(a).total_cmp(&size(b))) else { break };
        if size(&(i, j)) <= DEPENDENT * largest {
            break;
        }
        rows.swap(done, i);
        let pivot = &rows[done] / rows[done][j];
        for (k, row) in rows.iter_mut().enumerate() {
            if k == done {
                row.copy_from(&pivot);
            } else {
                let factor = row[j];
                row.axpy(-factor, &pivot, 1.0);
                row[j] = 0.0;
            }
        }
        pivots.push(j);
    }
    let free: Vec<usize> = (0..n).filter(|k| !pivots.contains(k)).collect();
    let mut basis = DMatrix::zeros(n, free.len());
    for (column, k) in free.iter().enumerate() {
        basis[(*k, column)] = 1.0;
        for (row, pivot) in rows.iter().zip(&pivots) {
            basis[(*pivot, column)] = -row[*k];
        }
    }
    basis
}
