//! The source paper's scene as a WebAssembly module without imports: no clock, no randomness, nothing of a browser's. `check.mjs` beside this
//! crate instantiates it and compares its motion with that of the same crate as a native program.
#![allow(unsafe_code)] // for the names of what a module exports

use std::cell::RefCell;
use std::ops::ControlFlow;
use teeter_integrator::{Ended, Model, Observer, ObserverError, State, StepReport};
use teeter_scenario::simulation::Simulation;

/// The scene.
const SCENE: &str = include_str!("../../../scenarios/free-rocking-on-beam.toml");

/// Times of the rows, s: those of the reference cases.
const TIMES: [f64; 8] = [0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5];

/// Numbers of a row: t, and X, Y, φ of the block with their velocities.
pub const COLUMNS: usize = 7;

struct Rows(Vec<f64>);

impl Observer<2> for Rows {
    fn observe(
        &mut self,
        _: &Model<2>,
        _: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError> {
        if TIMES.iter().any(|t| (t - state.t).abs() < 0.5 * state.dt) {
            self.0.push(state.t);
            self.0.extend(&state.q[..3]);
            self.0.extend(&state.v[..3]);
        }
        Ok(ControlFlow::Continue(()))
    }
}

/// The rows of the run, or why there are none.
///
/// # Errors
/// If the scene can't be read, built or run to its end.
pub fn rows() -> Result<Vec<f64>, String> {
    let resolved = teeter_scenario::load(SCENE.as_bytes(), "scene.toml", "scene", &[]).map_err(|e| e.to_string())?;
    let mut simulation = Simulation::new(&resolved.scene).map_err(|e| e.to_string())?;
    let mut rows = Rows(Vec::new());
    match simulation.run(&mut [&mut rows]).map_err(|e| e.to_string())? {
        Ended::Complete => Ok(rows.0),
        ended => Err(format!("{ended:?}")),
    }
}

thread_local! {
    static ROWS: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
}

/// Runs the scene; returns how many numbers there are at [`numbers`], 0 if it failed.
#[unsafe(no_mangle)]
pub extern "C" fn run() -> usize {
    ROWS.with_borrow_mut(|kept| {
        *kept = rows().unwrap_or_default();
        kept.len()
    })
}

/// Where the numbers of the last [`run`] are.
#[unsafe(no_mangle)]
pub extern "C" fn numbers() -> *const f64 {
    ROWS.with_borrow(|kept| kept.as_ptr())
}

/// How many numbers a row has.
#[unsafe(no_mangle)]
pub extern "C" fn columns() -> usize {
    COLUMNS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scene_runs_to_its_end() {
        let rows = rows().unwrap();
        assert_eq!(rows.len(), TIMES.len() * COLUMNS);
        assert_eq!(run(), rows.len());
        assert!((rows[rows.len() - COLUMNS] - 0.5).abs() < 1e-12);
    }
}
