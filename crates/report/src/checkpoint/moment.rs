//! The motion at a moment: what another run can start from.

use super::CheckpointError;
use serde::{Deserialize, Serialize};
use std::path::Path;
use teeter_integrator::{Memory, Model, State, WarmStart};
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Layout;

/// The motion at the end of a step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Moment {
    pub(crate) scheme: String,
    pub(crate) step: u64,
    pub(crate) t: f64,
    pub(crate) dt: f64,
    /// Names of blocks and beams with the number of their coordinates, in the order of the state.
    pub(crate) bodies: Vec<(String, usize)>,
    /// Names of the contact pairs, by number.
    pub(crate) contacts: Vec<String>,
    pub(crate) q: Vec<f64>,
    pub(crate) v: Vec<f64>,
    pub(crate) memory: Memory,
    pub(crate) warm: WarmStart,
}

/// A time this part of a step from a whole number of steps is at it: both are rounded.
const ROUNDING: f64 = 1e-6;

impl Moment {
    /// The moment of a state.
    #[must_use]
    pub fn of(state: &State, layout: &Layout, scheme: &str) -> Self {
        Self {
            scheme: scheme.to_owned(),
            step: state.step,
            t: state.t,
            dt: state.dt,
            bodies: bodies(layout),
            contacts: contacts(layout),
            q: state.q.clone(),
            v: state.v.clone(),
            memory: state.memory.clone(),
            warm: state.warm.clone(),
        }
    }

    /// Its time, s.
    #[must_use]
    pub fn t(&self) -> f64 {
        self.t
    }

    /// The state in which a run of `scene` by `scheme` starts from this moment, which was read from `path`.
    ///
    /// The clock goes on: t is that of the moment, steps are counted as if all from t = 0 had been of the scene's size,
    /// and the run ends at the scene's end on that clock. The energy account and the counts begin anew. With scheme and step of
    /// the moment, the motion is the one that went on from it.
    ///
    /// # Errors
    /// If the scene has other bodies, its steps don't meet the moment's time, or it ends before.
    pub fn start(
        &self,
        path: &Path,
        scene: &Scene,
        layout: &Layout,
        model: &Model<2>,
        scheme: &str,
    ) -> Result<State, CheckpointError> {
        let path = || path.to_owned();
        let bodies = bodies(layout);
        if bodies != self.bodies {
            return Err(CheckpointError::Bodies { path: path(), found: told(&self.bodies), wanted: told(&bodies) });
        }
        let (t, dt) = (self.t, scene.time.step);
        let same_steps = scheme == self.scheme && dt.to_bits() == self.dt.to_bits();
        let steps = (t / dt).round();
        if !same_steps && !((steps * dt - t).abs() <= ROUNDING * dt) {
            return Err(CheckpointError::Step { path: path(), t, dt, good: t / (t / dt).ceil() });
        }
        let step = if same_steps { self.step } else { steps as u64 };
        if step >= scene.time.steps() {
            return Err(CheckpointError::End { path: path(), t, end: scene.time.end });
        }
        let mut state = State::at(model, step, &self.q, &self.v, dt)
            .map_err(|source| CheckpointError::State { path: path(), source })?;
        if contacts(layout) == self.contacts {
            state.take_contacts(model, &self.memory, &self.warm);
        }
        if same_steps {
            state.t = t;
            // Where the step before ended with the mean about this time, the next one goes on from that.
            if let Some(theta) = scene.time.scheme.drives_about(scene.time.theta) {
                state.drive_about(model, theta).map_err(|source| CheckpointError::State { path: path(), source })?;
            }
        } else {
            // They mean nothing to another scheme, or in steps of another size.
            state.memory.set_numbers(&[]);
        }
        Ok(state)
    }
}

fn bodies(layout: &Layout) -> Vec<(String, usize)> {
    let blocks = layout.blocks.iter().map(|block| (block.name.clone(), block.range.len()));
    let beams = layout.beams.iter().map(|beam| {
        let supports = beam.supports.as_ref().map_or(0, ExactSizeIterator::len);
        let name = if beam.basis.is_some() { format!("{} in modes", beam.name) } else { beam.name.clone() };
        (name, beam.range.len() + supports)
    });
    let ground = layout.ground.iter().map(|ground| ("ground".to_owned(), ground.len()));
    blocks.chain(beams).chain(ground).collect()
}

fn contacts(layout: &Layout) -> Vec<String> {
    layout.contact_names().map(str::to_owned).collect()
}

fn told(bodies: &[(String, usize)]) -> String {
    let one = |(name, coordinates): &(String, usize)| format!("`{name}` ({coordinates} coordinates)");
    if bodies.is_empty() { "no bodies".to_owned() } else { bodies.iter().map(one).collect::<Vec<_>>().join(", ") }
}
