//! A box falls flat on the floor, sliding and turning: what impulses do its four corners get?
//!
//! The box's program poses the contact problem itself, with H = J M⁻¹ Jᵀ and q = J v, and has every solver in space that
//! `teeter-solvers` offers solve it. It needs nothing else of teeter: no scene, no time step.
//!
//! Four corners on one rigid body are hyperstatic: twelve impulse components act on six velocities, so H is singular, and many
//! impulses do the same. Where all corners slide the same way the velocity after the impact is unique none the less, and all solvers
//! of the exact law agree on it. Where the box turns as well, how the corners share the load decides which way
//! friction acts: Coulomb's law alone then allows many velocities, and each solver finds one. All of them obey the law.

use nalgebra::{Matrix3, Matrix3x6, Vector3, Vector6};
use std::error::Error;
use std::fmt::Write;
use teeter_contact::{ContactProblem, Delassus, Law, Outcome, Stop, judge};
use teeter_solvers::{SOLVERS, space_solver};

/// Mass, kg; sides along x, y, z, m; friction.
const MASS: f64 = 2.0;
const SIDES: [f64; 3] = [0.4, 0.3, 0.2];
const FRICTION: f64 = 0.3;

/// A box with its base on the floor z = 0, and its velocity: linear (m/s), then angular (rad/s).
struct Thrown {
    inverse_mass: Vector6<f64>,
    /// Jacobian of each corner of the base: its velocity along the normal z and the tangents x and y, from the box's.
    jacobians: Vec<Matrix3x6<f64>>,
    velocity: Vector6<f64>,
}

/// The contact problem of the box, with the numbers that it borrows.
struct Posed {
    h: Vec<Matrix3<f64>>,
    q: Vec<Vector3<f64>>,
    mu: Vec<f64>,
}

impl Thrown {
    fn new(velocity: Vector6<f64>) -> Self {
        let [a, b, c] = SIDES;
        let inertia = |s: f64, t: f64| MASS * (s * s + t * t) / 12.0;
        let inverse_mass = Vector6::new(MASS, MASS, MASS, inertia(b, c), inertia(a, c), inertia(a, b)).map(f64::recip);
        // The velocity of a point at r along e is e·v + (r × e)·ω.
        let row = |r: &Vector3<f64>, e: Vector3<f64>| {
            let turn = r.cross(&e);
            Vector6::new(e.x, e.y, e.z, turn.x, turn.y, turn.z).transpose()
        };
        let corners = [(-a, -b), (a, -b), (a, b), (-a, b)].map(|(x, y)| Vector3::new(x, y, -c) * 0.5);
        let jacobians = corners
            .iter()
            .map(|r| Matrix3x6::from_rows(&[row(r, Vector3::z()), row(r, Vector3::x()), row(r, Vector3::y())]))
            .collect();
        Self { inverse_mass, jacobians, velocity }
    }

    /// H by rows of blocks, q and μ. Without restitution q is the velocity of the corners without contact.
    fn pose(&self) -> Posed {
        let product = |i: &Matrix3x6<f64>, j: &Matrix3x6<f64>| {
            i * nalgebra::Matrix6::from_diagonal(&self.inverse_mass) * j.transpose()
        };
        let all = &self.jacobians;
        Posed {
            h: all.iter().flat_map(|i| all.iter().map(move |j| product(i, j))).collect(),
            q: all.iter().map(|j| j * self.velocity).collect(),
            mu: vec![FRICTION; all.len()],
        }
    }

    /// v⁺ = v + M⁻¹ Jᵀ p.
    fn after(&self, p: &[Vector3<f64>]) -> Vector6<f64> {
        let impulse: Vector6<f64> = self.jacobians.iter().zip(p).map(|(j, p)| j.transpose() * p).sum();
        self.velocity + self.inverse_mass.component_mul(&impulse)
    }
}

/// What one solver made of the problem.
struct Answer {
    name: &'static str,
    law: Law,
    outcome: Outcome,
    /// The box's velocity after the impact, and the speed at which its slowest corner leaves the floor.
    velocity: Vector6<f64>,
    separation: f64,
}

fn solve_with_all(thrown: &Thrown) -> Result<Vec<Answer>, Box<dyn Error>> {
    let Posed { h, q, mu } = thrown.pose();
    // Sizes, finiteness, μ ≥ 0 and H_NN > 0 are checked here, once.
    let problem = ContactProblem::new(Delassus::Dense(&h), &q, &mu)?;
    let stop = Stop::default().with_tolerance(1e-12);
    let mut answers = Vec::new();
    for info in SOLVERS {
        let Some(mut solver) = space_solver(info.name) else { continue };
        let mut p = vec![Vector3::zeros(); problem.contacts()];
        let outcome = solver.solve(&problem, &stop, &mut p);
        // The outcome carries the judge's residual; anyone can ask the judge again.
        if (judge(&problem, &p).global - outcome.residual.global).abs() > 1e-3 * outcome.residual.global + 1e-16 {
            return Err(format!("{} misreports its residual", info.name).into());
        }
        let separation = (0..p.len()).map(|i| problem.velocity(i, &p)[0]).fold(f64::INFINITY, f64::min);
        answers.push(Answer { name: info.name, law: info.law, outcome, velocity: thrown.after(&p), separation });
    }
    Ok(answers)
}

/// The table: residual, iterations, and how far the box's velocity is from the first solver's.
fn table(title: &str, answers: &[Answer]) -> Result<String, Box<dyn Error>> {
    let Some(first) = answers.first() else { return Err("no solver".into()) };
    let mut text = format!(
        "{title}\n{:<13} {:<7} {:<13} {:<10} {:>8} {:>6} {:>11} {:>8}\n",
        "solver", "law", "used", "outcome", "residual", "iter.", "separation", "off by"
    );
    for answer in answers {
        let law = if answer.law == Law::Exact { "exact" } else { "convex" };
        let Outcome { status, used, iterations, residual, .. } = answer.outcome;
        writeln!(
            text,
            "{:<13} {law:<7} {used:<13} {:<10} {:>8.1e} {iterations:>6} {:>11.1e} {:>8.1e}",
            answer.name,
            status.as_str(),
            residual.global,
            answer.separation,
            relative(&answer.velocity, &first.velocity)
        )?;
    }
    // Rounding is not worth a minus sign.
    let v = first.velocity.map(|x| (1e6 * x).round() / 1e6 + 0.0);
    writeln!(
        text,
        "after, by {}: ({}, {}, {}) m/s, ({}, {}, {}) rad/s",
        first.name, v[0], v[1], v[2], v[3], v[4], v[5]
    )?;
    Ok(text)
}

fn relative(velocity: &Vector6<f64>, to: &Vector6<f64>) -> f64 {
    (velocity - to).norm() / to.norm()
}

/// Falls flat at 1 m/s and slides; without turning, and turning.
fn slides() -> Thrown {
    Thrown::new(Vector6::new(2.0, 0.0, -1.0, 0.0, 0.0, 0.0))
}

fn turns() -> Thrown {
    Thrown::new(Vector6::new(2.0, 0.5, -1.0, 0.0, 0.0, 3.0))
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("{}", table("A box falls flat and slides: one velocity obeys the law", &solve_with_all(&slides())?)?);
    print!("{}", table("It slides and turns: many velocities do", &solve_with_all(&turns())?)?);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exact(thrown: &Thrown) -> Vec<Answer> {
        let mut answers = solve_with_all(thrown).unwrap();
        answers.retain(|answer| answer.law == Law::Exact);
        assert!(answers.len() >= 8, "{} solvers", answers.len());
        answers
    }

    #[test]
    fn all_exact_solvers_obey_the_law_and_keep_the_box_on_the_floor() {
        for answer in exact(&slides()).iter().chain(&exact(&turns())) {
            assert!(answer.outcome.converged() && answer.outcome.residual.global <= 1e-12, "{}", answer.name);
            // A residual of 1e-12 in impulses of the problem's size; well within 1e-9 in velocities of order 1.
            assert!(answer.separation.abs() < 1e-9, "{}", answer.name);
        }
    }

    #[test]
    fn a_slide_without_turning_loses_friction_times_the_speed_of_the_fall() {
        // By hand: the floor takes 1 m/s of the fall, so friction takes μ · 1 m/s of the slide; the box is too low to tip.
        let expected = Vector6::new(2.0 - FRICTION, 0.0, 0.0, 0.0, 0.0, 0.0);
        for answer in exact(&slides()) {
            assert!((answer.velocity - expected).norm() < 1e-9, "{}: {}", answer.name, answer.velocity);
        }
    }

    #[test]
    fn a_slide_with_turning_has_many_answers() {
        let answers = exact(&turns());
        let apart = answers.iter().map(|a| relative(&a.velocity, &answers[0].velocity)).fold(0.0, f64::max);
        assert!(apart > 1e-3, "{apart:e}, though no residual is above 1e-12");
    }

    #[test]
    fn the_convex_law_makes_the_sliding_box_lift_off() {
        let answers = solve_with_all(&slides()).unwrap();
        let socp = answers.iter().find(|answer| answer.law == Law::Convex).unwrap();
        assert!(socp.outcome.solved_its_own_law(), "it solves its own law");
        assert!(socp.separation > 0.1, "separates at {}", socp.separation);
        assert!(socp.outcome.residual.global > 1e-3, "the judge, who asks for Coulomb's, says so");
    }

    #[test]
    fn the_printed_table_has_a_row_for_each_solver_with_its_residual() {
        let answers = solve_with_all(&slides()).unwrap();
        let text = table("title", &answers).unwrap();
        for answer in &answers {
            let row = text.lines().find(|line| line.split_whitespace().next() == Some(answer.name)).unwrap();
            let ended = answer.outcome.status.as_str();
            assert!(row.contains(ended) && row.contains(&format!("{:.1e}", answer.outcome.residual.global)), "{row}");
        }
        assert!(text.ends_with("after, by auto: (1.7, 0, 0) m/s, (0, 0, 0) rad/s\n"), "{text}");
    }
}
