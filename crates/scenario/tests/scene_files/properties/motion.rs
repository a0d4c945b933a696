//! A scene run in memory, and two motions compared up to the horizon.

use super::drawn::{Drawn, Law, Use};
use std::fmt::Display;
use std::ops::ControlFlow;
use teeter_beam::ShapeAt;
use teeter_contact::ContactSolver;
use teeter_integrator::{Ended, Model, Observer, ObserverError, State, StepReport};
use teeter_scenario::load;
use teeter_scenario::resolve::Resolved;
use teeter_scenario::simulation::{BeamPlace, Simulation};

/// Relative change of every number of a scene, for the runs that show how far rounding may grow.
pub(crate) const NUDGE: f64 = 1e-12;

/// Nudged runs that have come apart by this part of the largest block are past the horizon: a
/// growth of 10⁴.
const HORIZON: f64 = 1e4 * NUDGE;

/// The same where more than rounding parts them.
const FAR_HORIZON: f64 = 1e-4;

/// Beams are looked at here, as parts of their span: where their mirror images are looked at too.
pub(crate) const PROBES: [f64; 4] = [0.0, 0.3, 0.7, 1.0];

/// Where everything is after each step.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Motion {
    /// X, Y, φ of each block, then w of each beam at its probes.
    pub(crate) rows: Vec<Vec<f64>>,
    /// Most active contacts of a step.
    pub(crate) contacts: usize,
    /// Rows up to here were found with every step solved.
    pub(crate) solved: usize,
}

/// Why a scene gives no motion.
#[derive(Debug)]
pub(crate) enum NoMotion {
    /// The program refuses it: no case.
    Refused(String),
    /// It ran and failed.
    Failed(String),
}

/// Reads a scene and makes it ready to run, with something around its solver.
pub(crate) fn ready(
    drawn: &Drawn,
    wrap: impl FnOnce(Box<dyn ContactSolver<2>>) -> Box<dyn ContactSolver<2>>,
) -> Result<(Resolved, Simulation), NoMotion> {
    let refused = |why: &dyn Display| NoMotion::Refused(why.to_string());
    let text = drawn.to_toml();
    let resolved = load(text.as_bytes(), "drawn.toml", "drawn", &[]).map_err(|why| refused(&why))?;
    let simulation = Simulation::with_solver(&resolved.scene, wrap).map_err(|why| refused(&why))?;
    Ok((resolved, simulation))
}

/// Reads a scene and makes it ready to run.
pub(crate) fn simulation(drawn: &Drawn) -> Result<Simulation, NoMotion> {
    Ok(ready(drawn, |solver| solver)?.1)
}

/// Writes down where everything is.
pub(crate) struct Recorder {
    beams: Vec<(BeamPlace, Vec<ShapeAt>)>,
    blocks: usize,
    motion: Motion,
}

impl Recorder {
    pub(crate) fn new(simulation: &Simulation) -> Self {
        let shapes = |beam: &BeamPlace| {
            let span = beam.beam.spec().span;
            PROBES.iter().map(|part| beam.beam.shape_at(part * span).unwrap()).collect()
        };
        let layout = &simulation.layout;
        let beams = layout.beams.iter().map(|beam| (beam.clone(), shapes(beam))).collect();
        Self { beams, blocks: layout.blocks.len(), motion: Motion::default() }
    }

    fn row(&self, state: &State) -> Vec<f64> {
        let mut row = state.q[..3 * self.blocks].to_vec();
        for (place, shapes) in &self.beams {
            row.extend(shapes.iter().map(|at| place.deflection(at, &state.q[place.range.clone()]).w));
        }
        row
    }
}

impl Observer<2> for Recorder {
    fn start(&mut self, _: &Model<2>, state: &State) -> Result<(), ObserverError> {
        let row = self.row(state);
        self.motion.rows.push(row);
        self.motion.solved = 1;
        Ok(())
    }

    fn observe(
        &mut self,
        _: &Model<2>,
        step: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError> {
        let row = self.row(state);
        let motion = &mut self.motion;
        if motion.solved == motion.rows.len() && step.outcome().is_none_or(|outcome| outcome.converged()) {
            motion.solved += 1;
        }
        motion.rows.push(row);
        motion.contacts = motion.contacts.max(step.contacts().count());
        Ok(ControlFlow::Continue(()))
    }
}

/// Runs what is ready to run.
pub(crate) fn run(simulation: &mut Simulation) -> Result<Motion, NoMotion> {
    let mut recorder = Recorder::new(simulation);
    match simulation.run(&mut [&mut recorder]) {
        Ok(Ended::Complete) => Ok(recorder.motion),
        Ok(ended) => Err(NoMotion::Failed(format!("the run ended as {ended:?}"))),
        Err(error) => Err(NoMotion::Failed(error.to_string())),
    }
}

/// Reads and runs a scene.
pub(crate) fn motion(drawn: &Drawn) -> Result<Motion, NoMotion> {
    run(&mut simulation(drawn)?)
}

/// How far a motion may be from one that differs from it by rounding, step by step, up to its
/// horizon.
///
/// Four runs whose numbers are all nudged by a part of 1e-12, two by two in opposite directions,
/// show what the scene makes of a small difference; what they are apart by at most so far, D(t), is
/// what 1e-12 grows to. A step rounds by some 1e-16, so 100 steps put in less than a tenth of
/// 1e-12: rounding alone may not part two motions by more than D(t). Where a solver stops at a
/// tolerance τ, it is 100 times what the tolerance makes of the motion: τ/1e-12 D(t), or what a
/// hundredth of τ changes, if that is more (in an ill-conditioned problem the impulses are off by
/// far more than the residual). Scaled restitution puts in 1e-7.
pub(crate) struct Horizon {
    /// By row; as many as there are before the horizon.
    pub(crate) allowed: Vec<f64>,
}

impl Horizon {
    /// The horizon of the motion `base` of a scene; `extent` (m) is how far from the origin either
    /// motion gets, which is what places are rounded by.
    pub(crate) fn of(drawn: &Drawn, base: &Motion, extent: f64) -> Result<Self, NoMotion> {
        let length = drawn.length();
        let mut apart = vec![NUDGE * (extent / length).max(1.0); base.solved];
        for seed in 1..=2 {
            for sign in [1.0, -1.0] {
                let other = motion(&nudged(drawn, seed, sign))?;
                apart.truncate(other.solved);
                for (k, apart) in apart.iter_mut().enumerate() {
                    *apart = apart.max(distance(drawn, &base.rows[k], &other.rows[k]));
                }
            }
        }
        let put_in = put_in(drawn, base);
        if put_in > NUDGE {
            let finer = motion(&Drawn { tolerance: 0.01 * drawn.tolerance, ..drawn.clone() })?;
            apart.truncate(finer.solved);
            for (k, apart) in apart.iter_mut().enumerate() {
                let solver = distance(drawn, &base.rows[k], &finer.rows[k]);
                *apart = (100.0 * solver).max(*apart * put_in / NUDGE);
            }
        }
        let (mut so_far, limit) = (0.0_f64, if put_in > NUDGE { FAR_HORIZON } else { HORIZON });
        for apart in &mut apart {
            so_far = so_far.max(*apart);
            *apart = so_far;
        }
        let before = apart.iter().take_while(|apart| **apart <= limit).count();
        apart.truncate(before);
        Ok(Self { allowed: apart })
    }

    /// Whether two motions of the scene agree up to the horizon; how many rows could be compared.
    pub(crate) fn agree(&self, drawn: &Drawn, one: &Motion, other: &Motion) -> Result<usize, String> {
        for (k, allowed) in self.allowed.iter().enumerate().take(one.solved.min(other.solved)) {
            let apart = distance(drawn, &one.rows[k], &other.rows[k]);
            if !(apart <= *allowed) {
                return Err(format!(
                    "after {k} steps {apart:e} of the largest block apart, but {allowed:e} allowed:\n{:?}\n{:?}",
                    one.rows[k], other.rows[k]
                ));
            }
        }
        Ok(self.allowed.len().min(one.solved).min(other.solved))
    }
}

/// The largest coordinate of a place, m, of the motion's blocks.
pub(crate) fn extent(drawn: &Drawn, motion: &Motion) -> f64 {
    let blocks = 3 * drawn.blocks.len();
    let places = motion.rows.iter().flat_map(|row| row[..blocks].chunks_exact(3)).flat_map(|q| [q[0], q[1]]);
    places.fold(0.0, |largest, x| largest.max(x.abs()))
}

/// What a step may put in beside a nudge's 1e-12, relative: no more where every contact problem is
/// enumerated, and is one problem.
fn put_in(drawn: &Drawn, motion: &Motion) -> f64 {
    let newton = |law: &Law| matches!(law, Law::Instant { word: "newton", .. });
    let exact =
        drawn.method != "pgs" && motion.contacts <= 3 && drawn.contacts.iter().all(|contact| newton(&contact.law));
    let solved = if exact { NUDGE } else { 100.0 * drawn.tolerance };
    // Restitution is scaled until its work is none up to rounding, 1e-14 of the impact's: the
    // velocity that comes back is then known to the root of that.
    let scaled = |law: &Law| match law {
        Law::Instant { word: "energetic", normal, .. } => *normal > 0.0,
        Law::Instant { word: "newton", normal, .. } => *normal > 0.0 && drawn.scheme.is_closed(),
        _ => false,
    };
    if drawn.contacts.iter().any(|contact| scaled(&contact.law)) { solved.max(1e-7) } else { solved }
}

/// The largest difference of two rows: of lengths in parts of the largest block, of angles in rad.
fn distance(drawn: &Drawn, one: &[f64], other: &[f64]) -> f64 {
    let (blocks, length) = (3 * drawn.blocks.len(), drawn.length());
    let parts = one.iter().zip(other).enumerate().map(|(k, (x, y))| {
        let angle = k < blocks && k % 3 == 2;
        (x - y).abs() / if angle { 1.0 } else { length }
    });
    // Written so that NaN is far.
    parts.fold(0.0, |largest, apart| if apart <= largest { largest } else { apart })
}

/// The scene with every number larger or smaller by a part of 1e-12, at random.
fn nudged(drawn: &Drawn, seed: u64, sign: f64) -> Drawn {
    let mut nudged = drawn.clone();
    let mut random = 0x9e37_79b9_7f4a_7c15_u64.wrapping_mul(seed);
    nudged.each_number(&mut |number, _, used| {
        // Marsaglia's xorshift.
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        if used == Use::Physics {
            *number *= 1.0 + sign * NUDGE * if random >> 63 == 0 { 1.0 } else { -1.0 };
        }
    });
    nudged
}
