//! What the equilibrium of a static start depends on: cases of a study with the same one share it.

use crate::scene::{BeamScene, BlockPart, BlockScene, ContactScene, LoadKind, Matter, Placement, Reduction, Scene};
use crate::static_start::{InitialConfiguration, is_held};
use std::sync::Arc;
use teeter_beam::BeamSpec;
use teeter_integrator::PairLaw;

/// All that an equilibrium depends on. Of motions and histories only the start counts; what of the scene the search doesn't look
/// at, such as time, isn't in it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct EquilibriumKey {
    /// The bits of the coordinates from which it is sought, of friction and of what pushes at the start: a zero keeps its sign there.
    numbers: Vec<u64>,
    contacts: Vec<ContactScene>,
    /// Its incline, rad, and whether it moves.
    ground: Option<(f64, bool)>,
    beams: Vec<(BeamSpec, f64, [bool; 3], Option<Reduction>)>,
    blocks: Vec<BlockKey>,
    /// The blocks that are pushed.
    forces: Vec<usize>,
    loads: Vec<(usize, LoadKind)>,
}

/// Width and height, parts, matter, placement of a block, and which of its coordinates are prescribed.
type BlockKey = ([f64; 2], Option<Arc<[BlockPart]>>, Matter, Placement, [bool; 3]);

impl EquilibriumKey {
    /// That of the equilibrium sought from `start`.
    pub(crate) fn of(scene: &Scene, start: &InitialConfiguration<'_>) -> Self {
        let mut numbers = scene.gravity.to_vec();
        numbers.extend(start.ground);
        numbers.extend(start.poses.iter().flatten());
        numbers.extend(start.deflections.iter().flatten());
        // Nothing strikes, and what holds a tilted block at its foot isn't the friction of its contact.
        let at_rest = |of: &ContactScene| {
            let (friction, feet_friction) =
                if is_held(scene, of) { (0.0, [None; 2]) } else { (of.law.friction, of.feet_friction) };
            ContactScene { law: PairLaw::new(friction, 0.0), feet_friction, ..of.clone() }
        };
        let contacts: Vec<ContactScene> = scene.contacts.iter().map(at_rest).collect();
        numbers.extend(contacts.iter().flat_map(|of| of.feet_friction.into_iter().flatten().chain([of.law.friction])));
        numbers.extend(scene.forces.iter().flat_map(|of| [of.force[0], of.force[1], of.couple]));
        let histories = scene.forces.iter().map(|of| &of.history).chain(scene.loads.iter().map(|of| &of.history));
        numbers.extend(histories.map(|history| history.signal().value(0.0)));
        for (of, model) in scene.beams.iter().zip(start.beams) {
            numbers.extend(of.shape.iter().chain(&of.position).chain(&model.displaced));
        }
        let of_beam = |of: &BeamScene| {
            let BeamScene { spec, thickness, top, static_start, self_weight, reduction, .. } = of;
            (spec.clone(), *thickness, [*top, *static_start, *self_weight], *reduction)
        };
        let of_block = |of: &BlockScene| {
            let BlockScene { width, height, parts, matter, placement, motion, .. } = of;
            ([*width, *height], parts.clone(), *matter, *placement, motion.0.each_ref().map(Option::is_some))
        };
        Self {
            numbers: numbers.into_iter().map(f64::to_bits).collect(),
            contacts,
            ground: scene.ground.as_ref().map(|ground| (ground.incline, ground.motion.is_given())),
            beams: scene.beams.iter().map(of_beam).collect(),
            blocks: scene.blocks.iter().map(of_block).collect(),
            forces: scene.forces.iter().map(|of| of.block).collect(),
            loads: scene.loads.iter().map(|of| (of.beam, of.kind)).collect(),
        }
    }

    /// How many numbers it holds.
    pub(crate) fn size(&self) -> usize {
        self.numbers.len() + self.beams.iter().map(|(spec, ..)| spec.nodes.len()).sum::<usize>()
    }
}
