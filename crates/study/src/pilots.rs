//! Runs of one scene with other steps, or from beside its start.

use crate::motion::Sampler;
use crate::{Failure, Motion, Sampling, Work};
use std::sync::atomic::AtomicBool;
use teeter_report::Record;
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Simulation;

/// Runs of one scene with other steps.
pub(crate) struct Pilots<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) sampling: Sampling,
    pub(crate) cancel: &'a AtomicBool,
    /// A run that would take longer by counted work, s, isn't done.
    pub(crate) most_seconds: f64,
    /// Runs so far.
    pub(crate) runs: usize,
}

impl Pilots<'_> {
    /// The motion with a step (s), the first block turned by `nudge` (rad) at the start, or a beam
    /// without one bent more by that share; `None` if it would take too long.
    pub(crate) fn run(&mut self, step: f64, nudge: f64) -> Result<Option<Motion>, Failure> {
        let mut scene = self.scene.clone();
        scene.time.step = step;
        let mut simulation = Simulation::new(&scene).map_err(|error| Failure::Refused(error.to_string()))?;
        if Work::expected(&simulation).seconds() > self.most_seconds {
            return Ok(None);
        }
        self.runs += 1;
        let layout = simulation.layout.clone();
        match (layout.blocks.first(), layout.beams.first()) {
            // An angle of its own: an upright block has none that could be greater by a share.
            (Some(block), _) => simulation.state.q[block.range.start + 2] += nudge,
            (None, Some(beam)) => simulation.state.q[beam.range.clone()].iter_mut().for_each(|q| *q *= 1.0 + nudge),
            (None, None) => {}
        }
        let state = &simulation.state;
        // Crossings and peaks are not what it is judged by: each block has none.
        let record = Record { rocking: layout.rocking_monitors(state.t, &state.q), ..Record::default() };
        let mut sampler = Sampler::new(self.sampling, &layout, self.cancel);
        let ended = simulation.run(&mut [&mut sampler]).map_err(|error| Failure::Ended(error.to_string()))?;
        Failure::unless_complete(ended, simulation.state.t)?;
        Ok(Some(sampler.finish(&simulation.state, &record)))
    }
}
