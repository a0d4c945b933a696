//! What a downstream crate brings of its own, by public API only: a subsystem, a scheme, a solver, an observer.

use crate::scenes::PAPER_BLOCK;
use nalgebra::Vector2;
use std::ops::ControlFlow;
use teeter_contact::{ContactProblem, ContactSolver, Law, Outcome, Status, Stop, judge};
use teeter_detect::{Frame, Kinematics, PointDetector, PointPair, SurfacePoint};
use teeter_integrator::*;
use teeter_rigid::{MassProperties, Rectangle};

/// A level plate on a spring k q + c q³ with the tangent k: one coordinate, its height above the spring's rest.
pub(crate) struct Plate {
    pub(crate) mass: f64,
    pub(crate) stiffness: f64,
    pub(crate) cubic: f64,
}

struct PlateCompliance {
    weights: Weights,
    mass: f64,
    stiffness: f64,
}

impl Dynamics<2> for Plate {
    fn size(&self) -> Size {
        Size { q: 1, v: 1, bodies: 1, row: 1 }
    }

    fn internal_force(&self, q: &[f64], _v: &[f64], f: &mut [f64]) {
        f[0] -= self.stiffness * q[0] + self.cubic * q[0].powi(3);
    }

    fn apply(&self, w: Weights, _q: &[f64], x: &[f64], y: &mut [f64]) {
        y[0] += (w.mass * self.mass + w.stiffness * self.stiffness) * x[0];
    }

    fn energy(&self, q: &[f64], v: &[f64]) -> Energy {
        let elastic = 0.5 * self.stiffness * q[0] * q[0] + 0.25 * self.cubic * q[0].powi(4);
        Energy { kinetic: 0.5 * self.mass * v[0] * v[0], elastic, gravity: 0.0 }
    }

    fn factor(&self, w: Weights, q: &[f64]) -> Result<Box<dyn Compliance<2>>, FactorError> {
        let mut compliance = PlateCompliance { weights: w, mass: self.mass, stiffness: self.stiffness };
        compliance.refactor(w, q)?;
        Ok(Box::new(compliance))
    }
}

impl Bodies<2> for Plate {
    fn place(&self, _body: u32, q: &[f64], local: &[Vector2<f64>], out: &mut [Vector2<f64>]) {
        for (x, l) in out.iter_mut().zip(local) {
            *x = l + Vector2::new(0.0, q[0]);
        }
    }

    fn has_surface(&self, _body: u32) -> bool {
        true
    }

    fn surface(&self, _: u32, q: &[f64], _: Kinematics, at: &Vector2<f64>) -> Option<SurfacePoint<2>> {
        let place = Vector2::new(at.x, q[0]);
        Some(SurfacePoint { place, normal: Vector2::y(), material: Vector2::new(at.x, 0.0) })
    }

    fn rows(&self, _: u32, _: &[f64], _: &Vector2<f64>, frame: &Frame<2>, out: &mut Rows<'_, 2>) -> usize {
        out.columns[0] = 0;
        out.values[0] = frame.column(1).into();
        1
    }
}

impl Compliance<2> for PlateCompliance {
    fn weights(&self) -> Weights {
        self.weights
    }

    fn refactor(&mut self, w: Weights, _q: &[f64]) -> Result<(), FactorError> {
        self.weights = w;
        Ok(())
    }

    fn solve(&mut self, f: &mut [f64]) {
        f[0] /= self.weights.mass * self.mass + self.weights.stiffness * self.stiffness;
    }
}

/// The paper's block upright above a surface.
fn model(surface: Box<dyn Subsystem<2>>) -> Model<2> {
    let law = PairLaw::new(0.5, 0.0);
    crate::scenes::model(&PAPER_BLOCK, Vector2::new(0.0, -9.81), law, Kinematics::Deformed, surface)
}

#[test]
fn a_subsystem_of_ones_own_is_hit_and_keeps_the_energy_identity() {
    let model = model(Box::new(Plate { mass: 0.1, stiffness: 1000.0, cubic: 0.0 }));
    for theta in [0.5, 0.75, 1.0] {
        let mut state = State::new(&model, &[0.0, 0.0775, 0.0, 0.0], &[0.1, 0.0, 0.0, 0.0], 1e-4).unwrap();
        let mut work = crate::scenes::workspace(&model);
        let mut scheme = MoreauJean::new(MoreauJeanSettings { theta, ..MoreauJeanSettings::default() }).unwrap();
        let plan = Plan::steps(10_000).when_unsolved(Unsolved::End);
        assert_eq!(run(&model, &mut scheme, &mut state, &mut work, &plan, &mut []).unwrap(), Ended::Complete);
        assert!(state.ledger.relative_residual() <= 1e-12, "{:?}", state.ledger);
        assert!(state.tally.max_contacts == 2 && state.ledger.sum.contact < 0.0, "it was hit");
    }
}

/// Semi-implicit Euler with contact at the velocity level (Stewart and Trinkle's way): q¹ = q⁰ + h v¹.
#[derive(Default)]
struct SemiImplicitEuler {
    q: Vec<f64>,
    v: Vec<f64>,
    stage: ContactStage<2>,
}

impl Scheme<2> for SemiImplicitEuler {
    fn name(&self) -> &'static str {
        "semi-implicit-euler"
    }

    fn start(&mut self, model: &Model<2>, state: &mut State, work: &mut Workspace<2>) -> Result<(), StepError> {
        self.q.resize(model.size().q, 0.0);
        work.factors(model, Weights::MASS, &state.q, Keep::Pinned)
    }

    fn advance<'w>(
        &mut self,
        model: &Model<2>,
        state: &mut State,
        until: f64,
        work: &'w mut Workspace<2>,
    ) -> Result<StepReport<'w, 2>, StepError> {
        let span = state.next_step(until);
        work.begin(model, state, span)?;
        work.free_velocity(model, Weights::MASS, &state.q, &state.v, &span, &mut self.v)?;
        let (over, responses) = (Over::Step { h: span.h, weight: 1.0 }, Responses::Of(Weights::MASS));
        self.stage.find(model, state, &Look::new(&state.q, 0.0), work)?;
        let outcome = self.stage.resolve(model, state, &mut self.v, over, &responses, work)?;
        model.retract(&state.q, &self.v, span.h, &mut self.q)?;
        let phase = PhaseEnd::new(PhaseKind::Step, span.end, &self.q, &self.v)
            .with_balance(Balance::Weighted(1.0))
            .with_outcome(outcome);
        work.phase(model, &phase, Some(&mut self.stage))?;
        work.finish(model, state, None, |_, _| true)
    }
}

/// Treats every contact as frictionless and alone: right for a block that falls flat, if swept often enough.
struct Sweeper;

impl ContactSolver<2> for Sweeper {
    fn name(&self) -> &'static str {
        "sweeper"
    }

    fn law(&self) -> Law {
        Law::Exact
    }

    fn reserve(&mut self, _contacts: usize, _blocks: usize) {}

    fn solve(&mut self, problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector2<f64>]) -> Outcome {
        for sweep in 0..stop.max_iterations {
            let residual = judge(problem, p);
            if residual.global <= stop.tolerance {
                return Outcome::new(Status::Converged, "sweeper", sweep, residual);
            }
            for i in 0..p.len() {
                let u = problem.velocity(i, p);
                p[i] = Vector2::new((p[i][0] - u[0] / problem.diagonal(i)[(0, 0)]).max(0.0), 0.0);
            }
        }
        Outcome::new(Status::MaxIterations, "sweeper", stop.max_iterations, judge(problem, p))
    }

    fn fork(&self) -> Box<dyn ContactSolver<2>> {
        Box::new(Self)
    }
}

/// Stops the run at the first contact.
struct FirstContact(Option<f64>);

impl Observer<2> for FirstContact {
    fn observe(&mut self, _: &Model<2>, step: &StepReport<'_, 2>, _: &State) -> Result<ControlFlow<()>, ObserverError> {
        if step.contacts().next().is_none() {
            return Ok(ControlFlow::Continue(()));
        }
        self.0 = Some(step.t_end);
        Ok(ControlFlow::Break(()))
    }
}

#[test]
fn a_scheme_a_solver_and_an_observer_of_ones_own() {
    let model = model(Box::new(Ground::flat(0.0)));
    let start = || State::new(&model, &[0.0, 0.0775, 0.0], &[0.0; 3], 1e-4).unwrap();
    let work = || Workspace::new(&model, Box::new(Sweeper), SolverSettings::default());
    let plan = Plan::steps(2000).when_unsolved(Unsolved::End);

    let (mut state, mut scheme) = (start(), SemiImplicitEuler::default());
    assert_eq!(run(&model, &mut scheme, &mut state, &mut work(), &plan, &mut []).unwrap(), Ended::Complete);
    assert!(state.v.iter().all(|v| v.abs() < 1e-12) && (state.q[1] - 0.0675).abs() < 1e-4, "at rest: {state:?}");

    // Falls 1 cm: sqrt(2·0.01/9.81) = 0.0451524 s.
    let (mut state, mut seen) = (start(), FirstContact(None));
    let mut scheme = SemiImplicitEuler::default();
    let ended = run(&model, &mut scheme, &mut state, &mut work(), &plan, &mut [&mut seen]).unwrap();
    assert_eq!(ended, Ended::Interrupted);
    assert!((seen.0.unwrap() - 0.0451524).abs() < 3e-4, "{:?}", seen.0);
}

#[test]
fn an_observers_error_ends_the_run_and_is_passed_on() {
    struct Full;
    impl Observer<2> for Full {
        fn observe(
            &mut self,
            _: &Model<2>,
            _: &StepReport<'_, 2>,
            _: &State,
        ) -> Result<ControlFlow<()>, ObserverError> {
            Err("no room".into())
        }
    }
    let model = model(Box::new(Ground::flat(0.0)));
    let mut state = State::new(&model, &[0.0, 0.0775, 0.0], &[0.0; 3], 1e-4).unwrap();
    let mut scheme = MoreauJean::new(MoreauJeanSettings::default()).unwrap();
    let plan = Plan::steps(10);
    let mut work = crate::scenes::workspace(&model);
    let error = run(&model, &mut scheme, &mut state, &mut work, &plan, &mut [&mut Full]).unwrap_err();
    assert_eq!((error.to_string().as_str(), state.step), ("no room", 1));
}

#[test]
fn bad_settings_and_states_are_refused_by_name() {
    let refused = |settings| MoreauJean::<2>::new(settings).unwrap_err().to_string();
    let settings = MoreauJeanSettings::default();
    assert_eq!(refused(MoreauJeanSettings { theta: 1.5, ..settings }), "theta is 1.5, but must be in [0, 1]");
    assert!(refused(MoreauJeanSettings { gap_tolerance: f64::NAN, ..settings }).contains("gap_tolerance is NaN"));
    let model = model(Box::new(Ground::flat(0.0)));
    let state = |q: &[f64], dt| State::new(&model, q, &[0.0; 3], dt).unwrap_err().to_string();
    assert!(state(&[0.0; 2], 1e-4).contains("2 numbers given for the coordinates, but the model needs 3"));
    assert!(state(&[0.0, f64::NAN, 0.0], 1e-4).contains("number 1 is NaN"));
    assert!(state(&[0.0; 3], 0.0).contains("step size is 0 s"));

    let shape = Rectangle::new(0.1, 0.1).unwrap();
    let mass = MassProperties::rectangle(&shape, 0.1, 1000.0).unwrap();
    let mut parts = ModelBuilder::new();
    let body = parts.add(Blocks::new(vec![Block::new(mass, &shape)], Vector2::zeros())).body();
    let law = parts.law(PairLaw::new(-0.1, 0.0));
    let points = PointPair { pair: 0, law, points: vec![], body, surface: body, kinematics: Kinematics::Linear };
    let error = parts.build(Box::new(PointDetector::new(vec![points]))).unwrap_err();
    assert_eq!(error.to_string(), "the friction coefficient of law 0 is -0.1, but must be at least 0 and finite");
}

#[test]
fn a_motion_that_leaves_the_numbers_ends_as_diverged_with_the_state_before_it() {
    let model = model(Box::new(Ground::flat(-1.0)));
    let mut state = State::new(&model, &[0.0; 3], &[0.0, 1e308, 0.0], 1e10).unwrap();
    let mut scheme = MoreauJean::new(MoreauJeanSettings::default()).unwrap();
    let plan = Plan::steps(10);
    let mut work = crate::scenes::workspace(&model);
    let ended = run(&model, &mut scheme, &mut state, &mut work, &plan, &mut []).unwrap();
    assert_eq!(ended, Ended::Failed(StepError::Diverged { t: 0.0 }));
    assert_eq!((state.step, state.v[1]), (0, 1e308));
}

#[test]
fn every_law_reaches_a_scheme_of_ones_own() {
    let standard = PairLaw::new(0.0, 0.0);
    let fall = |law: PairLaw| {
        let ground = Box::new(Ground::flat(0.0));
        let model = crate::scenes::model(&PAPER_BLOCK, Vector2::new(0.0, -9.81), law, Kinematics::Deformed, ground);
        let mut state = State::new(&model, &[0.0, 0.0685, 0.0], &[0.3, 0.0, 0.0], 1e-5).unwrap();
        let mut work = crate::scenes::workspace(&model);
        let plan = Plan::steps(1600).when_unsolved(Unsolved::End);
        let mut scheme = SemiImplicitEuler::default();
        assert_eq!(run(&model, &mut scheme, &mut state, &mut work, &plan, &mut []).unwrap(), Ended::Complete);
        state
    };
    // It falls 1 mm: at 0.0143 s it arrives with 0.14 m/s, and 1.7 ms later it is where its law has sent it.
    let arrival = (2.0_f64 * 9.81 * 1e-3).sqrt();
    let expected = |e: f64| e * arrival - 9.81 * (0.016 - arrival / 9.81);
    assert!(fall(standard).v[1].abs() < 1e-9, "without restitution it stays");
    for law in [
        PairLaw::new(0.0, 0.6),
        PairLaw::new(0.0, 0.6).with_impact(ImpactLaw::Poisson),
        PairLaw::new(0.0, 0.6).with_impact(ImpactLaw::Energetic),
    ] {
        let v = fall(law).v[1];
        assert!((v - expected(0.6)).abs() < 5e-3, "{law:?}: {v} {}", expected(0.6));
    }
    for impact in [
        ImpactLaw::KelvinVoigt { stiffness: 1e7, damping: 0.0 },
        ImpactLaw::HuntCrossley { stiffness: 1e9, damping: 0.0, exponent: 1.5 },
    ] {
        let v = fall(standard.with_impact(impact)).v[1];
        assert!(v > 0.5 * expected(1.0), "{impact:?} gives back: {v} {}", expected(1.0));
    }
    let rough = PairLaw::new(5.0, 0.0);
    let slid = |law: PairLaw| fall(law).v[0];
    assert!(slid(rough.with_tangential_restitution(0.3)) < slid(rough) - 1e-3, "it comes back tangentially");
}
