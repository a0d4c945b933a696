//! What the convex (associated) law does to a sliding contact, and that the fixed point over it is exact.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::figure::{Axes, Figure, Series};
use nalgebra::{Matrix2, Vector2};
use teeter_contact::{ContactProblem, ContactSolver, Delassus, Stop};
use teeter_solvers::{AcaryCadoux, Enumeration, Socp};

pub(crate) struct ConvexLaw;

const FRICTION: f64 = 0.5;

/// A velocity below this is drawn at it: a logarithmic axis has no place for 0.
const FLOOR: f64 = 1e-17;

impl Case for ConvexLaw {
    fn name(&self) -> &'static str {
        "convex-law"
    }

    fn about(&self) -> &'static str {
        "One contact, μ = 1/2, pressed at 1 m/s and pushed sideways at 1 to 100 m/s, so that it slides. Coulomb's law \
         keeps it closed: u_N = 0. The convex law, which `socp` solves and several programs use in place of \
         Coulomb's, requires the velocity to lie in the dual cone, so the contact separates at u_N = μ‖u_T‖, an \
         identity of that law. `acary-cadoux` solves a sequence of the same cone programs with this separation \
         removed by a shift, and must have none. The bounds are the solvers' tolerance, 1e-10, times the ratio of \
         the largest speed to the smallest."
    }

    fn run(&self, _: Depth) -> Result<Findings> {
        let h = [Matrix2::new(1.0, 0.2, 0.2, 2.0)];
        let mut series = [Vec::new(), Vec::new(), Vec::new()];
        let mut worst = [0.0_f64; 3];
        for k in 0..=20 {
            let q = [Vector2::new(-1.0, 10_f64.powf(0.1 * f64::from(k)))];
            let problem = ContactProblem::new(Delassus::Dense(&h), &q, &[FRICTION])?;
            let solvers: [&mut dyn ContactSolver<2>; 3] =
                [&mut Socp::new(), &mut AcaryCadoux::new(), &mut Enumeration::new()];
            for (s, solver) in solvers.into_iter().enumerate() {
                let mut p = [Vector2::zeros()];
                let outcome = solver.solve(&problem, &Stop::default(), &mut p);
                if !outcome.solved_its_own_law() {
                    return Err(format!("{}: {}", solver.name(), outcome.status).into());
                }
                let u = problem.velocity(0, &p);
                let gap = FRICTION * u[1].abs();
                let error = if s == 0 { u[0] / gap - 1.0 } else { u[0] };
                worst[s] = worst[s].max(error.abs());
                series[s].push((gap, u[0].max(FLOOR)));
            }
        }
        let gap = series[0].iter().map(|(gap, _)| (*gap, *gap)).collect();
        let [convex, fixed_point, exact] = series;
        let figure = Figure {
            file: "convex-law.svg",
            title: "A sliding contact: separation over friction times slip",
            x: "μ‖u_T‖ (m/s)",
            axes: Axes::Logarithmic,
            y: "u_N (m/s)",
            caption: "`socp` lies on the line u_N = μ‖u_T‖; the other two have no separation except rounding \
                 (velocities below 1e-17 m/s are drawn there).",
            series: vec![
                Series::marks("socp", convex),
                Series::line("u_N = μ‖u_T‖", gap),
                Series::marks("acary-cadoux", fixed_point),
                Series::marks("enumeration", exact),
            ],
        };
        let checks = vec![
            Check::worst("socp: u_N against μ‖u_T‖, relative", worst[0], 1e-8),
            Check::worst("acary-cadoux: u_N, m/s", worst[1], 1e-8),
            Check::worst("enumeration: u_N, m/s", worst[2], 1e-13),
        ];
        Ok(Findings { checks, figures: vec![figure], failure: None })
    }
}
