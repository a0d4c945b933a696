//! Mass ratio × iterations of each solver: a tower whose top is heavier, or lighter, than the rest.

use super::Map;
use crate::case::Result;
use crate::figure::{Axes, Figure, Series};
use teeter_contact::{Block, ContactProblem, Delassus, Law, Stop, Vector, judge};
use teeter_solvers::{SOLVERS, plane_solver};

/// Points on top of each other: as many contacts, the first with the floor.
const POINTS: usize = 8;

const FRICTION: f64 = 0.5;

/// Such a residual counts as solved.
const TOLERANCE: f64 = 1e-8;

/// Powers of ten of the mass of the topmost point over that of the others.
const POWERS: std::ops::RangeInclusive<i32> = -6..=6;

/// H = J M⁻¹ Jᵀ and q of a tower of points that gravity pulls down for a step, while each second is pushed aside.
fn tower(ratio: f64, n: usize) -> (Vec<Block<2>>, Vec<Vector<2>>) {
    let mobility = |point: usize| if point + 1 == n { ratio.recip() } else { 1.0 };
    let mut h = vec![Block::<2>::zeros(); n * n];
    let mut q = vec![Vector::<2>::zeros(); n];
    for upper in 0..n {
        h[upper * n + upper] += Block::<2>::identity() * mobility(upper);
        if upper > 0 {
            let lower = upper - 1;
            h[upper * n + upper] += Block::<2>::identity() * mobility(lower);
            h[upper * n + lower] -= Block::<2>::identity() * mobility(lower);
            h[lower * n + upper] -= Block::<2>::identity() * mobility(lower);
        }
        // All fall alike, so it is the floor that is approached; each second is pushed, so contacts slide to and fro.
        q[upper][1] = if upper % 2 == 0 { 0.4 } else { -0.4 };
    }
    q[0][0] = -1.0;
    (h, q)
}

pub(super) fn map() -> Result<Map> {
    let (mut solved, mut told) = (Vec::new(), Vec::new());
    for info in SOLVERS.iter().filter(|info| info.law == Law::Exact) {
        let Some(mut solver) = plane_solver(info.name) else { continue };
        let n = if info.name == "enumeration" { 3 } else { POINTS };
        let mu = vec![FRICTION; n];
        let (mut points, mut failed) = (Vec::new(), Vec::new());
        for power in POWERS {
            let ratio = 10_f64.powi(power);
            let (h, q) = tower(ratio, n);
            let problem = ContactProblem::new(Delassus::Dense(&h), &q, &mu)?;
            let mut p = vec![Vector::<2>::zeros(); n];
            let stop = Stop::new(TOLERANCE, 100_000);
            let outcome = solver.solve(&problem, &stop, &mut p);
            if outcome.converged() && judge(&problem, &p).global > 2.0 * TOLERANCE {
                return Err(format!("{} says it solved the ratio {ratio:e}, and did not", info.name).into());
            }
            if outcome.converged() {
                points.push((ratio, f64::from(outcome.iterations.max(1))));
            } else {
                failed.push(format!("1e{power} ({})", outcome.status));
            }
        }
        if !failed.is_empty() {
            told.push(format!("`{}` does not solve {}", info.name, failed.join(", ")));
        }
        solved.push((info.name, points));
    }
    let most = |points: &[(f64, f64)]| points.iter().fold(1.0_f64, |most, point| most.max(point.1));
    solved.sort_by(|a, b| most(&a.1).total_cmp(&most(&b.1)));
    let counts = solved.iter().map(|(name, points)| format!("`{name}` {}", most(points)));
    let says = format!(
        "Most iterations at any ratio solved: {}. {}",
        counts.collect::<Vec<_>>().join(", "),
        if told.is_empty() {
            "Every ratio is solved by every one.".to_owned()
        } else {
            format!("{}.", told.join("; "))
        }
    );
    // Six colours can be told apart.
    let half = solved.len().div_ceil(2);
    let figure = |file, title, part: &[(&str, Vec<(f64, f64)>)]| Figure {
        file,
        title,
        x: "Mass of the topmost over that of the others",
        y: "Iterations",
        axes: Axes::Logarithmic,
        caption: "",
        series: part
            .iter()
            .filter(|(_, points)| !points.is_empty())
            .flat_map(|(name, points)| [Series::marks(*name, points.clone()), Series::line("", points.clone())])
            .collect(),
    };
    Ok(Map {
        title: "Mass ratio × iterations of each solver",
        about: "A tower of eight points (three for `enumeration`, its limit), the topmost heavier or lighter than the \
             others by the ratio, falling on the floor while every second point is pushed sideways: H and q are \
             given to every solver of the exact law, from zero impulses, tolerance 1e-8, at most 100 000 iterations. \
             The meaning of an iteration differs between solvers ([solvers.md](solvers.md)); all are judged by the \
             same residual.",
        says,
        figures: vec![
            figure("extremes-mass-few.svg", "Solvers that need few iterations", &solved[..half]),
            figure("extremes-mass-many.svg", "Solvers that need many", &solved[half..]),
        ],
    })
}
