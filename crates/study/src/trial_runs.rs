//! Runs of one scene with other steps, or with a perturbed initial state.

use crate::sampled_motion::Sampler;
use crate::{Failure, SampledMotion, Sampling, Work};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use teeter_report::Record;
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Simulation;

/// Runs of one scene with other steps.
pub(crate) struct TrialRuns<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) sampling: Sampling,
    pub(crate) cancel: &'a Arc<AtomicBool>,
    /// Runs that would take longer, by counted work, are not done, s.
    pub(crate) most_seconds: f64,
    /// Number of runs so far.
    pub(crate) runs: usize,
}

impl TrialRuns<'_> {
    /// The motion with a step (s), with the first block initially rotated by `perturbation` (rad)
    /// or, without blocks, the first beam's deflection increased by that fraction; `None` if it
    /// would take too long.
    pub(crate) fn run(&mut self, step: f64, perturbation: f64) -> Result<Option<SampledMotion>, Failure> {
        let mut scene = self.scene.clone();
        scene.time.step = step;
        let mut simulation = Simulation::new(&scene).map_err(|error| Failure::Refused(error.to_string()))?;
        if Work::expected(&simulation).seconds() > self.most_seconds {
            return Ok(None);
        }
        simulation.cancelled_by(Arc::clone(self.cancel));
        self.runs += 1;
        let layout = simulation.layout.clone();
        match (layout.blocks.first(), layout.beams.first()) {
            // An absolute angle, as an upright block has none to scale.
            (Some(block), _) => simulation.state.q[block.range.start + 2] += perturbation,
            (None, Some(beam)) => {
                simulation.state.q[beam.range.clone()].iter_mut().for_each(|q| *q *= 1.0 + perturbation)
            }
            (None, None) => {}
        }
        let state = &simulation.state;
        // Crossings and peaks are not compared, so they are left empty.
        let record = Record { rocking: layout.rocking_monitors(state.t, &state.q), ..Record::default() };
        let mut sampler = Sampler::new(self.sampling, &layout, self.cancel);
        let ended = simulation.run(&mut [&mut sampler]).map_err(|error| Failure::Ended(error.to_string()))?;
        Failure::unless_complete(ended, simulation.state.t)?;
        Ok(Some(sampler.finish(&simulation.state, &record)))
    }
}
