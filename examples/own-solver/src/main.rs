//! A solver of one's own in the integrator: Housner's rocking block on rigid ground, once with [`jacobi::Jacobi`] and once
//! with `teeter-solvers`' `Auto`, side by side.

mod jacobi;

use jacobi::Jacobi;
use nalgebra::Vector2;
use std::error::Error;
use std::fmt::Write;
use std::ops::ControlFlow;
use teeter_contact::ContactSolver;
use teeter_detect::{Kinematics, PointDetector, PointPair};
use teeter_integrator::{
    Block, Blocks, Ended, Ground, Model, ModelBuilder, MoreauJean, MoreauJeanSettings, Observer, ObserverError,
    PairLaw, Plan, SolverSettings, State, StepReport, Tally, Unsolved, Workspace, run,
};
use teeter_rigid::{MassProperties, Rectangle};
use teeter_solvers::Auto;

/// Width and height, m; tilt at the release, rad; step, s, and their number: half a second, three impacts.
const SIDES: [f64; 2] = [0.03, 0.135];
const TILT: f64 = 5.0 * std::f64::consts::PI / 180.0;
const STEP: f64 = 1e-4;
const STEPS: u64 = 5000;

/// How the block moved: its coordinates after each step, the steps in which its angle changed sign, and the run's counts.
struct Motion {
    path: Vec<[f64; 3]>,
    impacts: Vec<f64>,
    tally: Tally,
}

impl Observer<2> for Motion {
    fn observe(
        &mut self,
        _: &Model<2>,
        step: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError> {
        let q = [state.q[0], state.q[1], state.q[2]];
        if self.path.last().is_some_and(|before| before[2] * q[2] < 0.0) {
            self.impacts.push(step.t_end);
        }
        self.path.push(q);
        Ok(ControlFlow::Continue(()))
    }
}

fn rock(solver: Box<dyn ContactSolver<2>>) -> Result<Motion, Box<dyn Error + Send + Sync>> {
    let shape = Rectangle::new(SIDES[0], SIDES[1])?;
    let mass = MassProperties::rectangle(&shape, 0.03, 2700.0)?;
    let mut parts = ModelBuilder::new();
    let body = parts.add(Blocks::new(vec![Block::new(mass, &shape)], Vector2::new(0.0, -9.81))).body();
    let surface = parts.add(Ground::flat(0.0)).body();
    let law = parts.law(PairLaw::new(0.5, 0.0));
    let points = shape.corners().to_vec();
    let touching = PointPair { pair: 0, law, points, body, surface, kinematics: Kinematics::Deformed };
    let model = parts.build(Box::new(PointDetector::new(vec![touching])))?;

    // Held on its left bottom corner, let go at rest.
    let (sin, cos) = TILT.sin_cos();
    let centre = [0.5 * (SIDES[0] * cos - SIDES[1] * sin), 0.5 * (SIDES[0] * sin + SIDES[1] * cos)];
    let mut state = State::new(&model, &[centre[0], centre[1], TILT], &[0.0; 3], STEP)?;

    let settings = SolverSettings { tolerance: 1e-12, ..SolverSettings::default() };
    let mut work = Workspace::new(&model, solver, settings);
    let mut scheme = MoreauJean::new(MoreauJeanSettings::default())?;
    let mut motion = Motion { path: Vec::new(), impacts: Vec::new(), tally: Tally::default() };
    let plan = Plan::steps(STEPS).when_unsolved(Unsolved::End);
    let ended = run(&model, &mut scheme, &mut state, &mut work, &plan, &mut [&mut motion])?;
    if ended != Ended::Complete {
        return Err(format!("the run ended after {} steps: {ended:?}", state.step).into());
    }
    motion.tally = state.tally;
    Ok(motion)
}

/// The largest difference of two motions over all steps: of positions (m), and of angles (rad).
fn difference(a: &Motion, b: &Motion) -> [f64; 2] {
    a.path.iter().zip(&b.path).fold([0.0, 0.0], |[place, angle], (a, b)| {
        let apart = (a[0] - b[0]).hypot(a[1] - b[1]);
        [place.max(apart), angle.max((a[2] - b[2]).abs())]
    })
}

fn report(own: &Motion, auto: &Motion) -> Result<String, std::fmt::Error> {
    let mut text =
        format!("{:<8} {:>8} {:>16} {:>15}   impacts, s\n", "solver", "solves", "most iterations", "worst residual");
    for (name, motion) in [("jacobi", own), ("auto", auto)] {
        let Tally { contact_steps, max_iterations, max_residual, .. } = motion.tally;
        write!(text, "{name:<8} {contact_steps:>8} {max_iterations:>16} {max_residual:>15.1e}  ")?;
        for time in &motion.impacts {
            write!(text, " {time:.4}")?;
        }
        text.push('\n');
    }
    let [place, angle] = difference(own, auto);
    writeln!(text, "\nlargest difference over {STEPS} steps: {place:.1e} m, {angle:.1e} rad")?;
    Ok(text)
}

fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    let own = rock(Box::new(Jacobi::default()))?;
    let auto = rock(Box::new(Auto::<2>::new()))?;
    print!("{}", report(&own, &auto)?);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_contact::conformance::{plane_cases, run as conform};
    use teeter_contact::{Status, Stop, Vector};

    #[test]
    fn conforms() {
        conform(&mut Jacobi::default(), &plane_cases(), 1e-10).unwrap();
    }

    #[test]
    fn says_when_it_ran_out_of_iterations() {
        for case in plane_cases().iter().filter(|case| case.name.starts_with("two feet, slide")) {
            let mut p = vec![Vector::<2>::zeros(); case.q.len()];
            let stop = Stop::default().with_max_iterations(1);
            let outcome = Jacobi::default().solve(&case.problem().unwrap(), &stop, &mut p);
            assert_eq!((outcome.status, outcome.iterations), (Status::MaxIterations, 1));
        }
    }

    #[test]
    fn a_solver_from_outside_gives_the_motion_that_auto_gives() {
        let own = rock(Box::new(Jacobi::default())).unwrap();
        let auto = rock(Box::new(Auto::<2>::new())).unwrap();
        assert_eq!(own.path.len() as u64, STEPS);
        assert!(own.tally.contact_steps > 1000 && own.tally.unconverged_steps == 0);
        // Each solve is right to 1e-12 of the impulse of a step, m g h: 1e-15 m/s. All 5000 of one sign would add up to 5e-12 m/s,
        // and in half a second to 2.5e-12 m, on a block of 0.07 m about its corner.
        let [place, angle] = difference(&own, &auto);
        assert!(place < 1e-11 && angle < 1e-10, "{place:e} m, {angle:e} rad");
        // Not the same bytes: it was another solver that ran.
        assert!(angle > 0.0 && own.tally.max_iterations > auto.tally.max_iterations);

        // Housner's exact impact times; Moreau-Jean is of first order, with errors of a few steps.
        for (found, exact) in own.impacts.iter().zip([0.106510, 0.292488, 0.457537]) {
            assert!((found - exact).abs() < 10.0 * STEP, "{found}, not {exact}");
        }
        assert_eq!(own.impacts, auto.impacts);

        let text = report(&own, &auto).unwrap();
        assert!(text.contains(&format!("{place:.1e} m, {angle:.1e} rad")), "{text}");
        assert!(text.lines().any(|line| line.starts_with("jacobi") && line.contains("0.1066")), "{text}");
    }
}
