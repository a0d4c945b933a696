//! The model of a scene, from its bodies to what can touch what.

use super::BuildError;
use crate::driven::{self, BeamModel};
use crate::ground_profile::{self, OnProfile};
use crate::layout::{BeamPlace, BlockPlace, ContactPoint, CrowdPlace, Layout, PairPlace};
use crate::opening::{OPEN_GAP, openings};
use crate::required::{Required, RestingBody};
use crate::resolve::SharedParts;
use crate::scene::{BeamScene, BlockScene, Crowd, Scene, SupportingBody};
use crate::tilt_reference::{TiltReference, tilt_references};
use nalgebra::Vector2;
use std::collections::BTreeSet;
use std::sync::Arc;
use teeter_detect::{
    BodyId, ContactDetector, ContactId, Groups, LawId, PointDetector, PointPair, ProfilePair, Shape, ShapeDetector,
    ShapePair, SidePair, SurfacePair, WiringError,
};
use teeter_integrator::{BeamFace, Block, Model, ModelBuilder, PartPlace, Subsystem};

/// The body of a block.
pub(crate) struct BlockBody {
    pub(crate) body: Block,
    /// Its corners, m: of roundings those of the core.
    pub(crate) corners: Vec<Vector2<f64>>,
    /// The shapes of its parts.
    pub(crate) shapes: Vec<Shape>,
    /// Whether one of them is round.
    pub(crate) is_round: bool,
}

/// The bodies of the blocks.
pub(super) fn block_bodies(scene: &Scene) -> Result<Vec<BlockBody>, BuildError> {
    let body = |block: &BlockScene| {
        let mass = block.mass_properties().map_err(|error| BuildError::Block(block.name.clone(), error))?;
        Ok(BlockBody {
            body: Block::within(mass, block.radius()),
            corners: block.corners(),
            shapes: block.shapes()?,
            is_round: block.is_round(),
        })
    };
    scene.blocks.iter().map(body).collect()
}

/// The beams, with the initial displacements of their supports.
pub(super) fn beam_models(scene: &Scene, shared: Option<&SharedParts>) -> Result<Vec<BeamModel>, BuildError> {
    let model = |(number, of): (usize, &BeamScene)| {
        let model = match shared {
            Some(shared) => BeamModel::of_shared(shared.beam(of)?, of),
            None => BeamModel::new(of)?,
        };
        // What else may be refused of a beam: its loads, in modes, and its motion.
        let has_loads = scene.loads.iter().any(|load| load.beam == number);
        if of.motion.is_given() || of.reduction.is_some() || has_loads {
            model.body(scene, number)?;
        }
        Ok(model)
    };
    scene.beams.iter().enumerate().map(model).collect()
}

/// A model, and the places of its parts.
pub(super) struct Assembled {
    pub(super) model: Model<2>,
    pub(super) blocks: PartPlace,
    pub(super) beams: Vec<PartPlace>,
    pub(super) ground: Option<PartPlace>,
}

/// The layout, from the places returned by the model builder.
pub(super) fn lay_out(scene: &Scene, beams: &[BeamModel], assembled: &Assembled, required: Required) -> Layout {
    let ground = assembled.ground.as_ref().map(|place| place.q.clone()).filter(|q| !q.is_empty());
    let blocks = scene.blocks.iter().zip(assembled.blocks.q.clone().step_by(3)).map(|(block, start)| BlockPlace {
        name: block.name.clone(),
        range: start..start + 3,
        side: block.width.min(block.height),
        reach: block.radius(),
        still: OPEN_GAP * block.width.min(block.height) / block.width,
        tilt_reference: TiltReference::Level,
    });
    let mut blocks: Vec<BlockPlace> = blocks.collect();
    let references = tilt_references(scene, &blocks, ground.as_ref().map(|ground| ground.start + 2));
    for (place, reference) in blocks.iter_mut().zip(references) {
        place.tilt_reference = reference;
    }
    let beams = scene.beams.iter().zip(beams).zip(&assembled.beams).map(|((of, model), place)| {
        // The displacements of moving supports come last.
        let end = place.q.end - model.displaced.len();
        BeamPlace {
            name: of.name.clone(),
            beam: Arc::clone(&model.beam),
            basis: model.basis.clone(),
            range: place.q.start..end,
            supports: (!model.displaced.is_empty()).then_some(end..place.q.end),
            probes: of.probes.clone(),
            body: place.body(),
            pressed: None,
        }
    });
    let pairs = scene.contacts.iter();
    let pairs = pairs.map(|contact| PairPlace {
        name: contact.name.clone(),
        between: contact.between.clone(),
        points: ContactPoint::all(scene, contact),
        of_shapes: contact.other_block().is_some(),
        corners: scene.blocks[contact.block].corner_count(),
        on_profile: contact.surface == SupportingBody::Ground && ground_profile::of(scene).is_some(),
        on_sides: contact.sides,
    });
    let (crowd, openings) = (CrowdPlace::of(scene), openings(scene));
    Layout {
        blocks,
        beams: beams.collect(),
        pairs: pairs.collect(),
        crowd,
        ground,
        openings,
        required,
        possible_contacts: 0,
    }
}

/// The model of the required parts of a scene.
pub(super) fn assemble(
    scene: &Scene,
    blocks: &[BlockBody],
    beams: &[BeamModel],
    required: &Required,
) -> Result<Assembled, BuildError> {
    let mut parts = ModelBuilder::new();
    let bodies = blocks.iter().map(|block| block.body).collect();
    let all_blocks = parts.add(driven::blocks(scene, bodies)?);
    let mut surfaces = Vec::with_capacity(beams.len());
    for (number, model) in beams.iter().enumerate() {
        let body: Box<dyn Subsystem<2>> = match required.rests(number) {
            Some(energy) => Box::new(RestingBody::new(model.coordinates(&[]).len(), energy)),
            None => model.body(scene, number)?.boxed(),
        };
        surfaces.push(parts.add_boxed(body));
    }
    let ground = scene.ground.as_ref().map(|ground| parts.add(driven::ground(ground)));
    let mut pairs = Pairs::default();
    let mut on_profile = Vec::new();
    let profile = ground_profile::of(scene);
    for (number, contact) in scene.contacts.iter().enumerate() {
        let law = parts.law(contact.law);
        let surface = match contact.surface {
            SupportingBody::Beam(k) => surfaces[k].nth_body(contact.face.body()),
            SupportingBody::Ground => match &ground {
                Some(ground) => ground.body(),
                None => continue, // the resolver refuses contacts with missing ground
            },
            SupportingBody::Block(other) => {
                let bodies = [contact.block, other].map(|block| all_blocks.nth_body(block as u32));
                pairs.shapes.push(ShapePair { pair: number as u32, law, bodies });
                continue;
            }
        };
        let points = required.points(number);
        let block = &blocks[contact.block];
        let (pair, body) = (number as u32, all_blocks.nth_body(contact.block as u32));
        let kinematics = contact.kinematics;
        if points == 0 {
            continue;
        }
        if let (SupportingBody::Beam(k), true) = (contact.surface, required.sides(scene, number)) {
            let surface = surfaces[k].nth_body(contact.face.fibre());
            pairs.sides.push(SidePair { pair, law, body, surface, kinematics });
        }
        if profile.is_some() && contact.surface == SupportingBody::Ground {
            on_profile.push(ProfilePair { pair, law, body, ground: surface });
        } else if block.is_round {
            pairs.surfaces.push(SurfacePair { pair, law, body, surface, kinematics });
        } else {
            let points = block.corners[..points].to_vec();
            for foot in (0..points.len()).filter(|_| contact.feet_friction != [None; 2]) {
                let own = contact.law_at(&scene.blocks[contact.block], foot);
                if own != contact.law {
                    pairs.laws.push((ContactId::new(pair, foot as u32), parts.law(own)));
                }
            }
            pairs.points.push(PointPair { pair, law, points, body, surface, kinematics });
        }
    }
    if let Some(crowd) = &scene.crowd {
        let laws: Vec<LawId> = crowd.contacts().iter().map(|contact| parts.law(contact.law)).collect();
        pairs.groups = Some((groups(crowd, &laws, &all_blocks)?, scene.contacts.len() as u32));
    }
    let shapes = |block: usize| (all_blocks.nth_body(block as u32), blocks[block].shapes.as_slice());
    let on_profile = profile.map(|profile| (profile, on_profile));
    let model = parts.build(detector(pairs, on_profile, (0..blocks.len()).map(shapes))?)?;
    Ok(Assembled { model, blocks: all_blocks, beams: surfaces, ground })
}

/// See [`Layout::possible_contacts`].
pub(super) fn possible_contacts(model: &Model<2>, layout: &Layout) -> usize {
    let beams = layout.beams.iter();
    let fibres: Vec<u32> =
        beams.flat_map(|place| [BeamFace::Upper, BeamFace::Lower].map(|face| place.body.0 + face.fibre())).collect();
    let detector = model.detector();
    let wiring = detector.wiring();
    let sides = wiring.iter().filter(|pair| fibres.contains(&pair.bodies[1].0));
    detector.capacity() - sides.map(|pair| pair.contacts).sum::<usize>()
}

/// The blocks of a crowd, with the laws of its contacts.
pub(super) fn groups(crowd: &Crowd, laws: &[LawId], blocks: &PartPlace) -> Result<Groups, WiringError> {
    let body = |block: usize| blocks.nth_body(block as u32);
    let members = crowd.classes().iter().enumerate().map(|(block, class)| (body(block), *class)).collect();
    let law = |a: usize, b: usize| crowd.holder(a, b).map(|contact| laws[contact]);
    let count = crowd.class_count();
    let table = (0..count).map(|a| (0..count).map(|b| law(a, b)).collect()).collect();
    let apart: Vec<[BodyId; 2]> = crowd.apart().map(|pair| pair.map(body)).collect();
    Ok(Groups::new(members, table)?.without(&apart))
}

/// The pairs that a detector looks at.
#[derive(Default)]
pub(crate) struct Pairs {
    /// Sharp blocks on surfaces.
    pub(crate) points: Vec<PointPair<2>>,
    /// Corners of these with laws of their own.
    pub(crate) laws: Vec<(ContactId, LawId)>,
    /// Round ones.
    pub(crate) surfaces: Vec<SurfacePair>,
    /// Blocks and blocks.
    pub(crate) shapes: Vec<ShapePair>,
    /// Sides of blocks against beams; their corners have a pair of the same number.
    pub(crate) sides: Vec<SidePair>,
    /// Blocks of which any two can touch, and the number of their first pair.
    pub(crate) groups: Option<(Groups, u32)>,
}

/// The detector for contacts of blocks with surfaces, by corners and sides, with ground that has a profile, and with each
/// other.
pub(crate) fn detector<'a>(
    pairs: Pairs,
    on_profile: OnProfile<'_>,
    shapes: impl Iterator<Item = (BodyId, &'a [Shape])>,
) -> Result<Box<dyn ContactDetector<2>>, BuildError> {
    let points = PointDetector::new(pairs.points).with_laws(pairs.laws);
    let on_profile = on_profile.filter(|(_, pairs)| !pairs.is_empty());
    let none_listed = pairs.shapes.is_empty() && pairs.surfaces.is_empty() && pairs.sides.is_empty();
    if none_listed && on_profile.is_none() && pairs.groups.is_none() {
        return Ok(Box::new(points));
    }
    let of_pairs = pairs.shapes.iter().flat_map(|pair| pair.bodies);
    let grounded = on_profile.iter().flat_map(|(_, pairs)| pairs).map(|pair| pair.body);
    let beside = pairs.sides.iter().map(|pair| pair.body);
    let paired: BTreeSet<BodyId> =
        of_pairs.chain(pairs.surfaces.iter().map(|pair| pair.body)).chain(beside).chain(grounded).collect();
    let all = pairs.groups.is_some();
    let shapes = shapes.filter(|(body, _)| all || paired.contains(body));
    let shapes = shapes.flat_map(|(body, shapes)| shapes.iter().map(move |shape| (body, shape.clone())));
    let detector = ShapeDetector::new(shapes.collect(), pairs.shapes)?;
    let detector = detector.with_points(points).with_surfaces(pairs.surfaces)?.with_sides(pairs.sides)?;
    let detector = match on_profile {
        Some((profile, pairs)) => detector.with_profile(profile.clone(), pairs)?,
        None => detector,
    };
    Ok(Box::new(match pairs.groups {
        Some((groups, first)) => detector.with_groups(groups, first)?,
        None => detector,
    }))
}
