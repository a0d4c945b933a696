//! The largest deflection of each beam of a scene without blocks: what became of it, as no block says anything.

use crate::first;
use serde::{Deserialize, Serialize};
use teeter_beam::ShapeAt;
use teeter_integrator::State;
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Layout;

/// The largest |w| of a beam in a run, over its nodes and the middles of its elements.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LargestDeflection {
    /// The beam.
    pub beam: String,
    /// The deflection, m, upwards; relative to its supports.
    pub w: f64,
    /// Where, m from the left end.
    pub x: f64,
    /// When first, s: the start of the run or the end of a step.
    pub t: f64,
}

/// The places where the beams are looked at, none in a scene with blocks.
#[derive(Debug)]
pub(crate) struct Places {
    beams: Vec<Vec<(f64, ShapeAt)>>,
}

impl Places {
    pub(crate) fn of(scene: &Scene, layout: &Layout) -> Self {
        let watched = if scene.blocks.is_empty() { layout.beams.as_slice() } else { &[] };
        let places = watched.iter().map(|place| {
            let nodes = place.beam.node_positions();
            let middles = nodes.windows(2).map(|ends| 0.5 * (ends[0] + ends[1]));
            nodes.iter().copied().chain(middles).map(|x| (x, place.beam.shape_clamped(x))).collect()
        });
        Self { beams: places.collect() }
    }

    /// Takes a state in; `first` are the deflections at the times told.
    pub(crate) fn look(
        &self,
        layout: &Layout,
        state: &State,
        largest: &mut Vec<LargestDeflection>,
        first: &mut Vec<f64>,
    ) {
        first.resize(self.beams.len(), 0.0);
        for (number, (places, beam)) in self.beams.iter().zip(&layout.beams).enumerate() {
            if largest.len() == number {
                largest.push(LargestDeflection { beam: beam.name.clone(), w: 0.0, x: 0.0, t: state.t });
            }
            for (x, shape) in places {
                let w = beam.deflection(shape, &state.q[beam.range.clone()]).w;
                let of = &mut largest[number];
                let mut most = of.w.abs();
                if first::enter(w.abs(), &mut most, &mut first[number]) {
                    (of.w, of.x, of.t) = (w, *x, state.t);
                }
                of.w = most.copysign(of.w);
            }
        }
    }
}
