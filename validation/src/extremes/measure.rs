//! A row's run, and what is measured of it.

use super::row::{Row, Scheme};
use super::watched::{Watch, Watched};
use crate::case::Result;
use std::ops::ControlFlow;
use teeter_integrator::{Ended, Model, Observer, ObserverError, State, StepReport};
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Simulation;

/// How a row ended.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Ending {
    /// All steps were taken.
    Complete,
    /// The scene was refused before the first step, with this message.
    Refused(String),
    /// A step could not be taken, with this message.
    Failed(String),
}

impl Ending {
    /// The word for it in tables and bounds.
    pub(crate) fn word(&self) -> &'static str {
        match self {
            Self::Complete => "complete",
            Self::Refused(_) => "refused",
            Self::Failed(_) => "failed",
        }
    }
}

/// What a run showed.
#[derive(Clone, Debug)]
pub(crate) struct Measured {
    pub(crate) ending: Ending,
    /// What `check` warns of.
    pub(crate) warnings: Vec<String>,
    /// Steps taken.
    pub(crate) steps: u64,
    /// Whether all numbers stayed finite.
    pub(crate) finite: bool,
    /// Largest gain of a step, Δ(T+V) without the work of loads, over the energy scale.
    pub(crate) gain: f64,
    /// Largest residual of a step's energy account over the energy scale.
    pub(crate) residual: f64,
    /// Deepest penetration, m.
    pub(crate) depth: f64,
    /// The same over its bound.
    pub(crate) penetration: f64,
    /// The contact solver's tolerance.
    pub(crate) tolerance: f64,
    /// Largest residual of a solve that converged over the tolerance.
    pub(crate) solver: f64,
    /// Solves whose residual is not what the judge says.
    pub(crate) dishonest: u64,
    pub(crate) unconverged: u64,
    /// Most iterations of a step.
    pub(crate) iterations: u64,
    /// Most contact problems solved in a step.
    pub(crate) solves: u64,
    /// Contacts that closed.
    pub(crate) impacts: u64,
}

impl Measured {
    fn refused(message: String) -> Self {
        Self {
            ending: Ending::Refused(message),
            warnings: Vec::new(),
            steps: 0,
            finite: true,
            gain: 0.0,
            residual: 0.0,
            depth: 0.0,
            penetration: 0.0,
            tolerance: 0.0,
            solver: 0.0,
            dishonest: 0,
            unconverged: 0,
            iterations: 0,
            solves: 0,
            impacts: 0,
        }
    }
}

/// Runs a row the way `teeter run` does, in memory.
pub(crate) fn measure(row: &Row) -> Result<Measured> {
    let resolved = match row.load() {
        Ok(resolved) => resolved,
        Err(found) => {
            let first = found.0.first().map(|found| format!("{}: {}", found.path, found.rule));
            return Ok(Measured::refused(first.ok_or("a scene refused without a reason")?));
        }
    };
    let watch = Watch::default();
    let mut simulation = match Simulation::with_solver(&resolved.scene, |solver| Watched::around(solver, &watch)) {
        Ok(simulation) => simulation,
        Err(error) => {
            let told = error.diagnostic(&resolved.document);
            return Ok(Measured::refused(format!("{}: {}", told.path, told.rule)));
        }
    };
    let mut seen = Seen::new(watch.clone(), row.scheme, &resolved.scene, &simulation.state);
    let ended = simulation.run(&mut [&mut seen])?;
    let state = &simulation.state;
    // Without an energy scale nothing moves.
    let scale = state.ledger.scale.max(f64::MIN_POSITIVE);
    let solved = watch.total();
    Ok(Measured {
        ending: match ended {
            Ended::Complete => Ending::Complete,
            Ended::Failed(error) => Ending::Failed(error.to_string()),
            other => Ending::Failed(format!("{other:?}")),
        },
        warnings: resolved.warnings.iter().map(|found| found.rule.clone()).collect(),
        steps: state.step,
        finite: seen.finite && is_finite(state),
        gain: seen.gain / scale,
        residual: state.ledger.relative_residual(),
        depth: seen.depth,
        penetration: seen.depth / seen.bound(),
        tolerance: resolved.scene.solver.tolerance,
        solver: solved.largest / resolved.scene.solver.tolerance,
        dishonest: solved.dishonest,
        unconverged: state.tally.unconverged_steps,
        iterations: seen.iterations,
        solves: seen.solves,
        impacts: seen.impacts,
    })
}

fn is_finite(state: &State) -> bool {
    let ledger = &state.ledger;
    let sums = [ledger.scale, ledger.largest_residual, ledger.sum.contact, ledger.sum.friction, ledger.sum.viscous];
    state.q.iter().chain(&state.v).chain(&sums).all(|x| x.is_finite())
        && [state.tally.max_penetration, state.tally.max_residual].iter().all(|x| x.is_finite())
}

/// Largest values over the steps.
struct Seen {
    watch: Watch,
    finite: bool,
    gain: f64,
    solves: u64,
    iterations: u64,
    impacts: u64,
    /// Deepest penetration at the end of a step, m; without that of the last step where its impact comes after the run.
    depth: f64,
    /// That of the last step, m, where no contact was active.
    waiting: f64,
    /// Fastest approach of an active contact, m/s.
    approach: f64,
    /// Fastest slide of an active contact, m/s.
    slide: f64,
    /// Steepest slope of a surface under an active contact: the sine of its angle to the ground it rests on.
    slope: f64,
    /// Fastest spin, rad/s.
    spin: f64,
    blocks: usize,
    /// Part of h·|U_n| by which an impact is caught late.
    late: f64,
    /// From a mass centre to its corners, m; the longest.
    radius: f64,
    dt: f64,
    tolerance: f64,
    /// How far the surface comes in a step before its contact with a side is seen, m.
    unseen: f64,
}

/// Acceleration that is allowed for of a beam's surface between the corners of a base, m/s².
const SUMMIT_ACCELERATION: f64 = 100.0;

impl Seen {
    fn new(watch: Watch, scheme: Scheme, scene: &Scene, state: &State) -> Self {
        let blocks = scene.blocks.len();
        let sides = scene.contacts.iter().any(|contact| contact.sides);
        let mut seen = Self {
            watch,
            finite: true,
            gain: 0.0,
            solves: 0,
            iterations: 0,
            impacts: 0,
            depth: 0.0,
            waiting: 0.0,
            approach: 0.0,
            slide: 0.0,
            slope: 0.0,
            spin: 0.0,
            blocks,
            late: if scheme == Scheme::CLOSED && !sides { 0.5 } else { 1.0 },
            radius: scene.blocks.iter().map(|block| 0.5 * block.width.hypot(block.height)).fold(0.0, f64::max),
            dt: scene.time.step,
            tolerance: scene.time.gap_tolerance,
            unseen: if sides { SUMMIT_ACCELERATION * scene.time.step.powi(2) } else { 0.0 },
        };
        seen.see_spin(state);
        seen
    }

    fn see_spin(&mut self, state: &State) {
        // Blocks come first in the state: X, Y, φ each.
        let spins = state.v.iter().skip(2).step_by(3).take(self.blocks);
        self.spin = spins.fold(self.spin, |most, spin| most.max(spin.abs()));
    }

    /// How deep a corner can get, m; see `page.rs`.
    fn bound(&self) -> f64 {
        let turn = self.dt * self.spin;
        let (approach, slide) = (self.late * self.approach, 2.0 * self.slope * (self.slide + self.approach));
        self.dt * (approach + slide) + 2.0 * self.radius * turn * turn + 2.0 * self.tolerance + self.unseen
    }
}

impl Observer<2> for Seen {
    fn observe(
        &mut self,
        _: &Model<2>,
        step: &StepReport<'_, 2>,
        state: &State,
    ) -> std::result::Result<ControlFlow<()>, ObserverError> {
        let e = &step.energy();
        let gain = e.contact + e.friction + e.viscous + e.numerical + e.residual;
        self.finite &= gain.is_finite() && step.penetration.is_finite();
        self.gain = self.gain.max(gain);
        let (solves, iterations) = self.watch.take_step();
        self.solves = self.solves.max(solves);
        self.iterations = self.iterations.max(iterations);
        self.see_spin(state);
        for contact in step.contacts() {
            self.approach = self.approach.max(-contact.u_before[0]);
            self.slide = self.slide.max(contact.u_before[1].abs()).max(contact.u_after[1].abs());
            self.slope = self.slope.max(contact.frame[(0, 0)].abs());
            self.impacts += u64::from(!contact.persisting && contact.u_before[0] < 0.0 && contact.p[0] > 0.0);
        }
        self.depth = self.depth.max(self.waiting);
        if step.contacts().next().is_none() {
            self.waiting = step.penetration;
        } else {
            self.waiting = 0.0;
            self.depth = self.depth.max(step.penetration);
        }
        Ok(ControlFlow::Continue(()))
    }
}
