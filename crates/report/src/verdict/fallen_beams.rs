//! Beams that fell from what they lay on: of blocks the verdict says what became of them, of beams beside them this.

use teeter_beam::{BeamSpec, Support};
use teeter_integrator::State;
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Layout;

/// A beam that nothing holds has fallen if its middle, on the line through its ends, is lower than it was placed by this part of its span: a deck that it
/// lies on sags by less, and columns that rock only lift it.
const FALLEN: f64 = 0.05;

/// Whether a support or a foundation carries a beam: what none carries lies on blocks, or flies.
pub(crate) fn is_carried(beam: &BeamSpec) -> bool {
    beam.supports != [Support::Free; 2] || !beam.inner_supports.is_empty() || !beam.foundations.is_empty()
}

/// The beams that are lower than where they were placed, though nothing that is prescribed has taken them down, with how much lower, m. `moved` says how far
/// a block is from its start.
pub(crate) fn fallen_beams<'s>(
    scene: &'s Scene,
    layout: &Layout,
    state: &State,
    moved: impl Fn(usize) -> [f64; 3],
) -> Vec<(&'s str, f64)> {
    let blocks = scene.blocks.iter().enumerate().filter(|(_, block)| block.motion.is_given());
    let of_blocks = blocks.map(|(number, _)| -moved(number)[1]);
    let of_ground = layout.ground.iter().map(|range| -state.q[range.start + 1]);
    let taken_down = of_blocks.chain(of_ground).fold(0.0, f64::max);
    let beams = scene.beams.iter().zip(&layout.beams).filter(|(beam, _)| !is_carried(&beam.spec));
    let fallen = beams.filter_map(|(beam, place)| {
        let (q, span) = (&state.q[place.range.clone()], beam.spec.span);
        let ends = [0.0, span].map(|x| place.deflection(&place.beam.shape_clamped(x), q).w);
        let fall = -0.5 * (ends[0] + ends[1]) - taken_down;
        (fall > FALLEN * span).then_some((beam.name.as_str(), fall))
    });
    fallen.collect()
}
