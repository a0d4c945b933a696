//! One harness that every solver runs through (feature `conformance`), shared by tests and benches.
//!
//! Its problems are small enough to check contact by contact: a solver's result is held against
//! Coulomb's law, written out case by case and independently of [`judge()`](crate::judge()).

use crate::{Block, ContactProblem, ContactSolver, Delassus, Status, Stop, Vector, judge};

/// A contact problem that owns its data; the Delassus operator dense by rows.
#[derive(Clone, Debug)]
pub struct Case<const D: usize> {
    /// What the problem shows.
    pub name: &'static str,
    /// The n × n blocks by rows.
    pub h: Vec<Block<D>>,
    /// The constant vector.
    pub q: Vec<Vector<D>>,
    /// The friction coefficients.
    pub mu: Vec<f64>,
}

impl<const D: usize> Case<D> {
    /// The problem that borrows this data.
    ///
    /// # Errors
    /// As [`ContactProblem::new`].
    pub fn problem(&self) -> Result<ContactProblem<'_, D>, crate::ProblemError> {
        ContactProblem::new(Delassus::Dense(&self.h), &self.q, &self.mu)
    }
}

/// A plane rigid body of mass 1 and moment of inertia `inertia` touched at `points` (x, y) from its
/// mass centre by a floor below: `H = Σ J M⁻¹ Jᵀ` of hyperstatic contacts, singular from two
/// contacts on.
#[must_use]
pub fn body_on_floor(name: &'static str, inertia: f64, points: &[(f64, f64)], velocity: [f64; 3], mu: f64) -> Case<2> {
    let inverse = [1.0, 1.0, inertia.recip()];
    // Rows of J for a point at ρ: normal (0, 1, ρ_x), tangent (1, 0, −ρ_y).
    let rows = |&(x, y): &(f64, f64)| [[0.0, 1.0, x], [1.0, 0.0, -y]];
    let mut case = Case { name, h: Vec::new(), q: Vec::new(), mu: vec![mu; points.len()] };
    for a in points {
        let j_a = rows(a);
        case.q.push(Vector::<2>::from_fn(|r, _| (0..3).map(|k| j_a[r][k] * velocity[k]).sum()));
        for b in points {
            let j_b = rows(b);
            case.h.push(Block::<2>::from_fn(|r, c| (0..3).map(|k| j_a[r][k] * inverse[k] * j_b[c][k]).sum()));
        }
    }
    case
}

/// The plane problems that every exact 2D solver must solve.
#[must_use]
pub fn plane_cases() -> Vec<Case<2>> {
    let one = |name, h: [f64; 4], q: [f64; 2], mu| Case {
        name,
        h: vec![Block::<2>::new(h[0], h[1], h[2], h[3])],
        q: vec![Vector::<2>::new(q[0], q[1])],
        mu: vec![mu],
    };
    let feet = [(-0.5, -1.0), (0.5, -1.0)];
    let spread = [(-0.5, -1.0), (0.1, -1.0), (0.5, -1.0)];
    vec![
        one("one contact, open", [1.0, 0.2, 0.2, 2.0], [0.3, -1.0], 0.5),
        one("one contact, sticks", [1.0, 0.2, 0.2, 2.0], [-1.0, 0.1], 0.5),
        one("one contact, slides right", [1.0, 0.2, 0.2, 2.0], [-1.0, 3.0], 0.5),
        one("one contact, slides left", [1.0, 0.2, 0.2, 2.0], [-1.0, -3.0], 0.5),
        one("one contact, no friction", [1.0, 0.2, 0.2, 2.0], [-1.0, -3.0], 0.0),
        one("one contact, huge friction", [1.0, 0.2, 0.2, 2.0], [-1.0, -3.0], 1e6),
        one("one contact, grazes", [1.0, 0.2, 0.2, 2.0], [0.0, 1.0], 0.5),
        body_on_floor("two feet, fall flat", 0.3, &feet, [0.0, -1.0, 0.0], 0.5),
        body_on_floor("two feet, slide", 0.3, &feet, [3.0, -1.0, 0.0], 0.2),
        body_on_floor("two feet, stop from a slide", 0.3, &feet, [0.1, -1.0, 0.0], 0.2),
        body_on_floor("two feet, one lifts", 0.3, &feet, [0.0, -0.2, -1.5], 0.5),
        body_on_floor("two feet, no friction", 0.3, &feet, [1.0, -1.0, 0.3], 0.0),
        body_on_floor("three feet in a row, stick", 0.3, &spread, [0.05, -1.0, 0.0], 0.5),
        body_on_floor("three feet in a row, slide", 0.3, &spread, [2.0, -1.0, 0.1], 0.1),
    ]
}

/// A body of mass 1 in space with moments of inertia `inertia`, touched at `points` from its mass
/// centre by a floor below (normal z, tangents x and y): hyperstatic from two contacts on.
/// `velocity` is linear, then angular.
#[must_use]
pub fn box_on_floor(
    name: &'static str,
    inertia: [f64; 3],
    points: &[[f64; 3]],
    velocity: [f64; 6],
    mu: f64,
) -> Case<3> {
    let inverse = |k: usize| if k < 3 { 1.0 } else { inertia[k - 3].recip() };
    // Row along e: (e, r × e).
    let row = |r: &[f64; 3], axis: usize| {
        let mut row = [0.0; 6];
        row[axis] = 1.0;
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        row[3 + next] = r[last];
        row[3 + last] = -r[next];
        row
    };
    const AXES: [usize; 3] = [2, 0, 1];
    let mut case = Case { name, h: Vec::new(), q: Vec::new(), mu: vec![mu; points.len()] };
    for a in points {
        case.q.push(Vector::<3>::from_fn(|r, _| (0..6).map(|k| row(a, AXES[r])[k] * velocity[k]).sum()));
        for b in points {
            case.h.push(Block::<3>::from_fn(|r, c| {
                (0..6).map(|k| row(a, AXES[r])[k] * inverse(k) * row(b, AXES[c])[k]).sum()
            }));
        }
    }
    case
}

/// The problems in space that every exact 3D solver must solve.
#[must_use]
pub fn space_cases() -> Vec<Case<3>> {
    let one = |name, h: [f64; 6], q: [f64; 3], mu| Case {
        name,
        h: vec![Block::<3>::new(h[0], h[1], h[2], h[1], h[3], h[4], h[2], h[4], h[5])],
        q: vec![Vector::<3>::new(q[0], q[1], q[2])],
        mu: vec![mu],
    };
    let skew = [1.0, 0.2, -0.1, 2.0, 0.3, 1.5];
    let identity = [4.0, 0.0, 0.0, 4.0, 0.0, 4.0];
    let uneven = [1.0, 1e-6, 1e2, 1e-8, 1e-3, 1e5];
    let corners = [[-0.5, -0.3, -1.0], [0.5, -0.3, -1.0], [0.5, 0.3, -1.0], [-0.5, 0.3, -1.0]];
    let inertia = [0.4, 0.5, 0.1];
    let boxed = |name, velocity, mu| box_on_floor(name, inertia, &corners, velocity, mu);
    let mut cases = vec![
        one("one contact in space, open", skew, [0.3, -1.0, 2.0], 0.5),
        one("one contact in space, grazes", skew, [0.0, 1.0, -1.0], 0.5),
        one("one contact in space, sticks", skew, [-1.0, 0.1, -0.2], 0.5),
        one("one contact in space, no friction", skew, [-1.0, -3.0, 1.0], 0.0),
        one("one contact in space, huge friction", skew, [-1.0, -3.0, 1.0], 1e6),
        one("one contact in space, multiple of the identity, sticks", identity, [-1.0, 0.1, 0.1], 0.5),
        one("one contact in space, multiple of the identity, slides", identity, [-1.0, 3.0, -2.0], 0.5),
        one("one contact in space, multiple of the identity, no friction", identity, [-1.0, 3.0, -2.0], 0.0),
        one("one contact in space, uneven scales, sticks", uneven, [-1.0, 1e-9, 30.0], 0.5),
        one("one contact in space, uneven scales, slides", uneven, [-1.0, 1.0, 1e3], 0.5),
        boxed("four corners, fall flat", [0.0, 0.0, -1.0, 0.0, 0.0, 0.0], 0.5),
        boxed("four corners, stick", [0.1, -0.05, -1.0, 0.0, 0.0, 0.1], 0.5),
        boxed("four corners, slide", [2.0, 1.0, -1.0, 0.0, 0.0, 0.0], 0.2),
        boxed("four corners, slide and turn", [1.0, 0.3, -1.0, 0.0, 0.0, 2.0], 0.2),
        boxed("four corners, turn on the spot", [0.0, 0.0, -1.0, 0.0, 0.0, 3.0], 0.3),
        boxed("four corners, two lift", [0.0, 0.0, -0.2, 0.0, 1.5, 0.0], 0.4),
        boxed("four corners, three lift", [0.1, 0.1, -0.2, 1.0, 1.3, 0.2], 0.4),
        boxed("four corners, no friction", [1.0, 0.3, -1.0, 0.1, -0.2, 0.5], 0.0),
        boxed("four corners, leave", [1.0, 0.3, 1.0, 0.1, -0.2, 0.5], 0.5),
    ];
    // At odd angles.
    for (name, angle) in [
        ("one contact in space, slides along 0.3", 0.3_f64),
        ("one contact in space, slides along 1.9", 1.9),
        ("one contact in space, slides along 3.3", 3.3),
        ("one contact in space, slides along 5.2", 5.2),
    ] {
        cases.push(one(name, skew, [-1.0, 3.0 * angle.cos(), 3.0 * angle.sin()], 0.5));
    }
    cases
}

/// Checks Signorini's and Coulomb's laws contact by contact, with `slack` relative to the problem's
/// own scales of speed and impulse.
///
/// # Errors
/// A sentence that says which part of the law fails, at which contact, by how much.
pub fn check_law<const D: usize>(problem: &ContactProblem<'_, D>, p: &[Vector<D>], slack: f64) -> Result<(), String> {
    let speed = problem.q().iter().map(Vector::norm).fold(1e-300, f64::max);
    let impulse = (0..p.len()).map(|i| speed / problem.diagonal(i)[(0, 0)]).fold(1e-300, f64::max);
    for i in 0..p.len() {
        let u = problem.velocity(i, p);
        let (mu, p_n, u_n) = (problem.mu()[i], p[i][0], u[0]);
        let p_t = p[i].iter().skip(1).fold(0.0, |s: f64, c| s.hypot(*c));
        let u_t = u.iter().skip(1).fold(0.0, |s: f64, c| s.hypot(*c));
        let fail = |what: &str, by: f64| Err(format!("contact {i}: {what} by {by:e} (p {:?}, u {:?})", p[i], u));
        if p_n < -slack * impulse {
            return fail("pulls", p_n);
        }
        if u_n < -slack * speed {
            return fail("penetrates", u_n);
        }
        if p_n > slack * impulse && u_n > slack * speed {
            return fail("presses while it separates", u_n);
        }
        if p_t > mu * p_n + slack * impulse * (1.0 + mu) {
            return fail("friction beyond the cone", p_t - mu * p_n);
        }
        if u_t > slack * speed {
            // Sliding: friction at its limit and opposite to the velocity.
            let along: f64 = (1..D).map(|k| p[i][k] * u[k] / u_t).sum();
            if (along + mu * p_n).abs() > slack * impulse * (1.0 + mu) {
                return fail("slides without full opposed friction", along + mu * p_n);
            }
        }
    }
    Ok(())
}

/// Runs a solver over cases: it must converge to `tolerance`, report the judge's residual, and obey
/// the law.
///
/// # Errors
/// A sentence that names the case and what failed.
pub fn run<const D: usize>(solver: &mut dyn ContactSolver<D>, cases: &[Case<D>], tolerance: f64) -> Result<(), String> {
    for case in cases {
        let problem = case.problem().map_err(|e| format!("{}: {e}", case.name))?;
        let mut p = vec![Vector::<D>::zeros(); case.q.len()];
        let stop = Stop { tolerance, ..Stop::default() };
        let outcome = solver.solve(&problem, &stop, &mut p);
        let residual = judge(&problem, &p).global;
        if outcome.status != Status::Converged || residual > tolerance {
            return Err(format!("{}: {:?}, judged {residual:e}", case.name, outcome));
        }
        if (outcome.residual.global - residual).abs() > 1e-3 * residual + 1e-16 {
            return Err(format!("{}: reports {:e}, the judge finds {residual:e}", case.name, outcome.residual.global));
        }
        check_law(&problem, &p, 100.0 * tolerance).map_err(|e| format!("{}: {e}", case.name))?;
        // The same problem once more from the solution: it must stay solved.
        let again = solver.solve(&problem, &stop, &mut p);
        if again.status != Status::Converged {
            return Err(format!("{}: from its own solution {:?}", case.name, again));
        }
    }
    Ok(())
}
