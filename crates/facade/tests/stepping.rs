//! Stepping, going back, choosing, and what is refused.

use std::ops::ControlFlow;
use teeter_sim::contact::Law;
use teeter_sim::integrator::{Blocks, Model, ModelError, ObserverError, StateError};
use teeter_sim::prelude::*;
use teeter_sim::solvers::SOLVERS;

type Tested = Result<(), Box<dyn std::error::Error>>;

/// A block that is thrown along the ground and bounces.
fn world() -> Result<(World, BlockHandle, SurfaceHandle), Box<dyn std::error::Error>> {
    let mut world = World::new(Vector2::new(0.0, -9.81));
    let ground = world.ground(Ground::flat(0.0));
    let shape = Rectangle::new(0.1, 0.05)?;
    let mass = MassProperties::rectangle(&shape, 0.1, 2700.0)?;
    let block = world.block(&shape, mass, At::standing(0.0, 0.01).tilted(0.2).moving(Vector3::new(1.0, 0.0, 0.0)));
    world.contact(block, ground, PairLaw::new(0.5, 0.4));
    Ok((world, block, ground))
}

#[test]
fn steps_one_by_one_several_and_up_to_a_time_are_the_same_motion() -> Tested {
    let mut runs = [world()?.0.simulate(1e-3)?, world()?.0.simulate(1e-3)?, world()?.0.simulate(1e-3)?];
    for step in 1..=300 {
        assert_eq!(runs[0].step()?.step, step);
    }
    runs[1].steps(120)?;
    runs[1].steps(180)?;
    runs[2].until(0.3)?;
    assert_eq!(runs[0].state(), runs[1].state());
    assert_eq!(runs[0].state(), runs[2].state());
    assert!(runs[0].state().tally.contact_steps > 10);
    runs[2].until(0.1)?;
    assert_eq!(runs[2].state().step, 300, "what is over takes no step");
    Ok(())
}

#[test]
fn an_earlier_state_goes_on_as_it_did_and_a_bad_one_is_refused() -> Tested {
    let mut run = world()?.0.simulate(1e-3)?;
    run.steps(100)?;
    let earlier = run.state().clone();
    run.steps(100)?;
    let later = run.state().clone();
    run.set_state(earlier)?;
    for _ in 0..100 {
        run.step()?;
    }
    assert_eq!(run.state(), &later);

    let mut short = later.clone();
    short.q.pop();
    assert!(matches!(run.set_state(short), Err(SimError::Step(_) | SimError::State(StateError::Length { .. }))));
    assert!(matches!(run.set_step_size(0.0), Err(SimError::State(StateError::StepSize(_)))));
    assert_eq!(run.state(), &later);
    run.set_step_size(5e-4)?;
    run.steps(2)?;
    assert!((run.time() - 0.201).abs() < 1e-15);
    Ok(())
}

#[test]
fn every_scheme_and_every_exact_solver_can_be_chosen() -> Tested {
    for scheme in schemes() {
        for solver in SOLVERS.iter().filter(|solver| solver.dimensions.contains(&2) && solver.law == Law::Exact) {
            let (mut world, block, _) = world()?;
            world.use_scheme(scheme.make().ok_or(scheme.name)?);
            world.use_solver(plane_solver(solver.name).ok_or(solver.name)?, SolverSettings::default());
            let mut run = world.simulate(1e-3)?;
            run.until(0.5)?;
            assert_eq!(run.workspace().solver.name(), solver.name);
            assert_eq!(run.state().tally.unconverged_steps, 0);
            assert!(run.ledger().relative_residual() < 1e-12, "{} by {}", scheme.name, solver.name);
            assert!(run.velocity(block)?.norm() < 1e-3, "{} by {}: at rest", scheme.name, solver.name);
        }
    }
    Ok(())
}

#[test]
fn a_contact_problem_that_is_not_solved_is_an_error() -> Tested {
    let (mut world, ..) = world()?;
    world.use_solver(plane_solver("pgs").ok_or("none")?, SolverSettings { tolerance: 0.0, max_iterations: 1 });
    let mut run = world.simulate(1e-3)?;
    let Err(SimError::Unsolved { t }) = run.until(0.5) else { return Err("solved to a tolerance of 0".into()) };
    assert_eq!(t, run.time());
    assert_eq!(run.state().tally.unconverged_steps, 1);
    Ok(())
}

/// Ends the run after some steps, or fails.
struct Watcher {
    left: u64,
    fails: bool,
}

impl Observer<2> for Watcher {
    fn observe(&mut self, _: &Model<2>, _: &StepReport<'_, 2>, _: &State) -> Result<ControlFlow<()>, ObserverError> {
        self.left -= 1;
        match (self.left, self.fails) {
            (0, true) => Err("the disk is full".into()),
            (0, false) => Ok(ControlFlow::Break(())),
            _ => Ok(ControlFlow::Continue(())),
        }
    }
}

#[test]
fn observers_see_every_step_and_may_end_the_run() -> Tested {
    let mut run = world()?.0.simulate(1e-3)?;
    let ended = run.watch(&Plan::steps(100), &mut [&mut Watcher { left: 7, fails: false }])?;
    assert_eq!((ended, run.state().step), (Ended::Interrupted, 7));
    let failed = run.watch(&Plan::steps(100), &mut [&mut Watcher { left: 3, fails: true }]);
    assert_eq!(failed.err().ok_or("no error")?.to_string(), "the disk is full");
    Ok(())
}

#[test]
fn handles_of_another_world_are_refused_wherever_they_are_used() -> Tested {
    let shape = Rectangle::new(0.1, 0.05)?;
    let mass = MassProperties::rectangle(&shape, 0.1, 2700.0)?;
    let mut other = World::new(Vector2::zeros());
    let foreign_block = other.block(&shape, mass, At::centre(0.0, 0.0));
    let foreign_beam = other.beam(Beam::new(BeamSpec::new(1.0, 4, Section::new(1.0, 1.0)?))?, Vector2::zeros());
    let foreign = |error: Option<SimError>| matches!(error, Some(SimError::OtherWorld { .. }));

    let (mut mine, _, ground) = world()?;
    mine.contact(foreign_block, ground, PairLaw::new(0.0, 0.0));
    assert!(foreign(mine.simulate(1e-3).err()));
    let (mut mine, block, _) = world()?;
    mine.contact(block, foreign_beam, PairLaw::new(0.0, 0.0));
    assert!(foreign(mine.simulate(1e-3).err()));
    let (mut mine, ..) = world()?;
    mine.drive(foreign_block, BlockCoordinate::X, Motion::still());
    assert!(foreign(mine.simulate(1e-3).err()));
    let (mut mine, ..) = world()?;
    mine.load(foreign_block, Vector2::zeros(), 0.0, std::sync::Arc::new(Formula::constant(1.0)?));
    assert!(foreign(mine.simulate(1e-3).err()));

    let run = world()?.0.simulate(1e-3)?;
    assert!(foreign(run.position(foreign_block).err()));
    assert!(foreign(run.velocity(foreign_block).err()));
    assert!(foreign(run.deflection(foreign_beam, 0.5).err()));
    assert!(foreign(run.place(foreign_beam).err()));
    Ok(())
}

#[test]
fn what_cannot_work_is_refused_before_the_first_step() -> Tested {
    let (mut world_, block, ground) = world()?;
    world_.contact(block, ground, PairLaw::new(-0.5, 0.0));
    assert!(matches!(world_.simulate(1e-3).err(), Some(SimError::Model(ModelError::Law { value: -0.5, .. }))));

    let (mut world_, block, _) = world()?;
    let no_surface = world_.subsystem(Blocks::new(Vec::new(), Vector2::zeros()), &[], &[]);
    world_.contact(block, no_surface, PairLaw::new(0.5, 0.0));
    assert!(matches!(world_.simulate(1e-3).err(), Some(SimError::Model(ModelError::Body { .. }))));

    // One number too many here, one too few there: as many as the model needs in all.
    let (mut world_, ..) = world()?;
    world_.subsystem(Ground::flat(0.0), &[1.0], &[]);
    let shape = Rectangle::new(0.1, 0.05)?;
    let mass = MassProperties::rectangle(&shape, 0.1, 2700.0)?;
    let one = vec![teeter_sim::integrator::Block::new(mass, &shape)];
    world_.subsystem(Blocks::new(one, Vector2::zeros()), &[0.0; 2], &[0.0; 3]);
    let refused = world_.simulate(1e-3).err();
    assert!(matches!(refused, Some(SimError::State(StateError::Length { found: 1, expected: 0, .. }))));

    assert!(matches!(world()?.0.simulate(f64::NAN).err(), Some(SimError::State(StateError::StepSize(_)))));
    Ok(())
}
