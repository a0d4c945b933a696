//! Maps of where the model stops making sense: borders found by sweeps and bisection, drawn.

mod frequency_theta;
mod mass_iterations;
mod mesh_digits;
mod resting;

use super::row::{Base, Row, Scheme, Sets};
use crate::case::Result;
use crate::figure::Figure;
use std::ops::ControlFlow;
use teeter_integrator::{Ended, Model, Observer, ObserverError, State, StepReport};
use teeter_scenario::simulation::Simulation;

/// A map: figures, what they say, and the numbers that one wants to read.
pub(crate) struct Map {
    pub(crate) title: &'static str,
    /// What is drawn, and how it was found.
    pub(crate) about: &'static str,
    /// What it says, with the numbers found.
    pub(crate) says: String,
    pub(crate) figures: Vec<Figure>,
}

/// All maps.
pub(crate) fn all() -> Result<Vec<Map>> {
    Ok(vec![frequency_theta::map()?, mesh_digits::map()?, mass_iterations::map()?, resting::map()?])
}

/// A run of a base scene, each step shown; its last state.
fn run(base: Base, sets: Sets, each: impl FnMut(&StepReport<'_, 2>, &State)) -> Result<State> {
    let row = Row { name: "a map's".to_owned(), base, scheme: Scheme::OPEN, sets, long: false };
    let resolved = row.load().map_err(|found| found.0.first().map_or(String::new(), |found| found.rule.clone()))?;
    let mut simulation = Simulation::new(&resolved.scene)?;
    match simulation.run(&mut [&mut Each(each)])? {
        Ended::Complete => Ok(simulation.state),
        other => Err(format!("{}: {other:?}", row.command()).into()),
    }
}

struct Each<F>(F);

impl<F: FnMut(&StepReport<'_, 2>, &State)> Observer<2> for Each<F> {
    fn observe(
        &mut self,
        _: &Model<2>,
        step: &StepReport<'_, 2>,
        state: &State,
    ) -> std::result::Result<ControlFlow<()>, ObserverError> {
        (self.0)(step, state);
        Ok(ControlFlow::Continue(()))
    }
}

fn set(key: &str, value: impl Into<String>) -> (String, String) {
    (key.to_owned(), value.into())
}
