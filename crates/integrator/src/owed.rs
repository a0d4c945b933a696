//! By how much prescribed motion lags where a step is divided.

use crate::{Model, Part, STEP_ROUNDING, State, StepSpan};

/// The ways by which prescribed velocities are behind in a step that is divided, and how they catch up.
///
/// Over a whole step the trapezoid of the velocities at its ends, which are means about them, is the way that the motion has: so they are
/// made. The velocities at inner times are means about these, and the trapezoids of the parts add up to something else: by h³/16 times the
/// second derivative of the velocity, by h/8 of it where it jumps. Velocities at inner times that make up for it would be further from the
/// motion. So the velocity at the end of the step does, partly in what is left of the step, for the rest in the next one, which starts with it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Owed {
    /// Of each velocity, what is missing at the end of the rest of the step if that is taken whole, m or rad.
    ways: Vec<f64>,
    /// The rest of the step. `None`: steps are taken whole.
    rest: Option<StepSpan>,
    /// Means about the end of the step; memory.
    means: Vec<f64>,
}

impl Owed {
    /// By which its numbers are told from others in a state's memory, which begin with whole ones.
    pub(crate) const MARK: f64 = -0.5;

    /// Begins a step of a model.
    pub(crate) fn begin<const D: usize>(&mut self, model: &Model<D>) {
        self.ways.clear();
        self.ways.resize(if model.is_driven() { model.size().v } else { 0 }, 0.0);
        self.means.resize(self.ways.len(), 0.0);
    }

    /// Goes on with the rest of a step.
    pub(crate) fn go_on(&mut self, rest: StepSpan) {
        self.rest = Some(rest);
    }

    /// By how much a velocity is more than the mean at the end of the step, to catch up.
    fn more(&self, k: usize, dt: f64) -> f64 {
        self.rest.map_or(0.0, |rest| 2.0 * self.ways[k] / (rest.h + dt))
    }

    /// Adds to the prescribed velocities at the end of a part of `h` (s) what they catch up with.
    pub(crate) fn catch_up<const D: usize>(&self, part: &Part<D>, dt: f64, h: f64, v_end: &mut [f64]) {
        let Some(rest) = &self.rest else { return };
        for &k in &part.traits.driven {
            v_end[k] += h / rest.h * self.more(part.v.start + k, dt);
        }
    }

    /// What a state has to remember of the step that ends there, three numbers for each velocity that catches up.
    pub(crate) fn numbers(&self, dt: f64) -> impl Iterator<Item = f64> {
        let more = (0..self.ways.len()).map(move |k| (k, self.more(k, dt)));
        more.filter(|(_, more)| *more != 0.0).flat_map(|(k, more)| [Self::MARK, k as f64, more])
    }

    /// How many numbers that may be.
    pub(crate) fn most_numbers<const D: usize>(model: &Model<D>) -> usize {
        3 * model.parts().iter().map(|part| part.traits.driven.len()).sum::<usize>()
    }

    /// Lets the velocities of a state catch up that has been given the means about its time, but remembers that they were more.
    pub(crate) fn restore<const D: usize>(&mut self, model: &Model<D>, state: &mut State) {
        self.begin(model);
        let half = 0.5 * state.dt;
        model.drive_mean_at([state.t - half, state.t + half], &mut self.means);
        for held in state.memory.all_numbers().chunks_exact(3).filter(|held| held[0] == Self::MARK) {
            let k = held[1] as usize;
            let (Some(v), Some(mean)) = (state.v.get_mut(k), self.means.get(k)) else { continue };
            if *v == *mean {
                *v += held[2];
            }
        }
    }

    /// Takes a part of the rest, of `h` (s), from a state, with these velocities at its end.
    pub(crate) fn take_part<const D: usize>(&mut self, model: &Model<D>, from: &State, h: f64, v_end: &[f64]) {
        // What rounding leaves of a step is no part of it.
        let is_divided = |rest: &StepSpan| rest.h - h > STEP_ROUNDING * from.dt;
        let Some(rest) = self.rest.filter(|rest| is_divided(rest) && model.is_driven()) else { return };
        let half = 0.5 * from.dt;
        model.drive_mean_at([rest.end - half, rest.end + half], &mut self.means);
        for part in model.parts().iter().filter(|part| part.is_driven()) {
            for k in part.traits.driven.iter().map(|k| part.v.start + k) {
                let whole = rest.h * (from.v[k] + self.means[k]);
                let divided = h * (from.v[k] + v_end[k]) + (rest.h - h) * (v_end[k] + self.means[k]);
                self.ways[k] += 0.5 * (whole - divided);
            }
        }
    }
}
