//! Builds the model and initial state of a resolved scene, ready to run in memory.

use crate::driven::{self, BeamModel};
use crate::ground_profile::{self, OnProfile};
use crate::opening::{OPEN_GAP, openings};
use crate::overlap::{Outline, Overlap, PlacedOutline, deepest_overlap};
use crate::placement::PlacementError;
use crate::required::{Extent, Required, RestingBody};
use crate::resolve::SharedParts;
use crate::scene::{BeamScene, BlockScene, Crowd, Scene, SchemeName, SupportingBody, Time};
use crate::static_start::{InitialConfiguration, StaticStart};
use crate::tilt_reference::{TiltReference, tilt_references};
use nalgebra::Vector2;
use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use teeter_beam::{BeamError, ModalError};
use teeter_contact::ContactSolver;
use teeter_detect::{
    BodyId, ContactDetector, ContactId, Groups, LawId, OnSide, PointDetector, PointPair, ProfilePair, Shape,
    ShapeDetector, ShapeError, ShapePair, SidePair, SurfacePair, WiringError,
};
use teeter_integrator::{
    Account, BeamFace, Block, Ended, EventDriven, EventDrivenSettings, GeneralizedAlpha, GeneralizedAlphaSettings,
    Mismatch, Model, ModelBuilder, ModelError, MoreauJean, MoreauJeanClosed, MoreauJeanClosedSettings,
    MoreauJeanLocated, MoreauJeanLocatedSettings, MoreauJeanProjected, MoreauJeanProjectedSettings, MoreauJeanSettings,
    Observer, PartPlace, Plan, Resolved, ResolvedSettings, RunError, Scheme, SettingError, SolverSettings, State,
    StateError, StepError, StepReport, Subsystem, Unsolved, WorkCounts, Workspace, run,
};
use teeter_rigid::RigidError;
use teeter_text::readable::with_digits;

pub use crate::layout::{BeamPlace, BlockPlace, ContactNames, ContactPoint, CrowdPlace, Layout, PairPlace, PointName};

/// Why the model of a scene can't be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BuildError {
    /// Invalid values of a block.
    #[error("block `{0}`: {1}")]
    Block(String, RigidError),
    /// Invalid values of a beam.
    #[error("beam `{0}`: {1}")]
    Beam(String, BeamError),
    /// The modal basis of a beam can't be found.
    #[error("beam `{0}`: {1}")]
    Modes(String, ModalError),
    /// There is no initial state.
    #[error(transparent)]
    Placement(#[from] PlacementError),
    /// An invalid contact law.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// An invalid initial state.
    #[error(transparent)]
    State(#[from] StateError),
    /// Parts that don't match.
    #[error(transparent)]
    Mismatch(#[from] Mismatch),
    /// Invalid settings of the scheme.
    #[error(transparent)]
    Scheme(#[from] SettingError),
    /// An unknown solver.
    #[error("there is no solver `{0}`")]
    Solver(String),
    /// A corner that starts below its surface.
    #[error(
        "block `{block}`: {} starts {} {} `{surface}`; up to {} are allowed for rounding",
        touching(*on_side, corner), with_digits(*depth, "m", 2), beyond(*on_side, *lower), with_digits(*tolerance, "m", 2)
    )]
    Penetration {
        /// The block.
        block: String,
        /// The corner, or what of a beam touches a side.
        corner: String,
        /// Whether it is a side that is penetrated.
        on_side: bool,
        /// Whether it is the lower face of a beam.
        lower: bool,
        /// The body that it penetrates.
        surface: String,
        /// Depth, m.
        depth: f64,
        /// Largest allowed depth, m.
        tolerance: f64,
    },
    /// A crest of the ground that starts inside a block.
    #[error("block `{block}`: the ground's crest-{crest} starts inside it")]
    CrestInside {
        /// The block.
        block: String,
        /// The point of the profile, from 1 on.
        crest: usize,
    },
    /// An invalid shape of a block.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// Shapes and pairs that don't match.
    #[error(transparent)]
    Wiring(#[from] WiringError),
    /// Two blocks that start in the same place.
    #[error("block `{second}`: it overlaps `{first}` by {} at the start", with_digits(*depth, "m", 2))]
    Overlap {
        /// The block that comes first in the file.
        first: String,
        /// The other one.
        second: String,
        /// Displacement needed to separate them, m.
        depth: f64,
    },
}

/// What of a block starts inside something, in words.
pub(crate) fn touching(on_side: bool, corner: &str) -> String {
    if on_side { format!("a side ({corner})") } else { format!("the corner {corner}") }
}

/// Where that starts.
pub(crate) fn beyond(on_side: bool, lower: bool) -> &'static str {
    match (on_side, lower) {
        (true, _) => "inside",
        (false, false) => "below the surface of",
        (false, true) => "above the lower face of",
    }
}

/// A scene ready to run.
pub struct Simulation {
    /// The model.
    pub model: Model<2>,
    /// The state, at t = 0 at first.
    pub state: State,
    /// Who is where.
    pub layout: Layout,
    /// When it ends.
    pub plan: Plan,
    /// The result for beams with a static start; `None` without any.
    pub static_start: Option<StaticStart>,
    scheme: Box<dyn Scheme<2>>,
    work: Workspace<2>,
    /// Whether the scheme has been started.
    started: bool,
}

impl std::fmt::Debug for Simulation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Simulation").field("layout", &self.layout).field("plan", &self.plan).finish_non_exhaustive()
    }
}

impl Simulation {
    /// Builds the model of a scene and its initial state. What can't affect the motion from there
    /// on is left out of the model (`docs/required.md`); to start from another state, use
    /// [`Simulation::with_extent`] and the full model.
    ///
    /// # Errors
    /// If a value is invalid, a beam has no equilibrium, or a corner starts inside a surface or a
    /// block inside another.
    pub fn new(scene: &Scene) -> Result<Self, BuildError> {
        Self::with_solver(scene, |solver| solver)
    }

    /// As [`Simulation::new`]; what of beams earlier scenes with the same `shared` had in common with this one is taken from there:
    /// matrices, modes, factors, equilibria. The motion is the same to the last bit.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn with_shared(scene: &Scene, shared: &SharedParts) -> Result<Self, BuildError> {
        Self::build(scene, Extent::Required, |solver| solver, Some(shared))
    }

    /// As [`Simulation::new`]; `wrap` may wrap the scene's contact solver, for example to observe
    /// it.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn with_solver(
        scene: &Scene,
        wrap: impl FnOnce(Box<dyn ContactSolver<2>>) -> Box<dyn ContactSolver<2>>,
    ) -> Result<Self, BuildError> {
        Self::with_extent(scene, Extent::Required, wrap)
    }

    /// As [`Simulation::with_solver`], with the given extent of the model.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn with_extent(
        scene: &Scene,
        extent: Extent,
        wrap: impl FnOnce(Box<dyn ContactSolver<2>>) -> Box<dyn ContactSolver<2>>,
    ) -> Result<Self, BuildError> {
        Self::build(scene, extent, wrap, None)
    }

    fn build(
        scene: &Scene,
        extent: Extent,
        wrap: impl FnOnce(Box<dyn ContactSolver<2>>) -> Box<dyn ContactSolver<2>>,
        shared: Option<&SharedParts>,
    ) -> Result<Self, BuildError> {
        let blocks = block_bodies(scene)?;
        let beams = beam_models(scene, shared)?;
        let ground_start = scene.ground.as_ref().map(|of| driven::ground(of).coordinates(0.0)).unwrap_or_default();
        let required = Required::all(scene);
        let assembled = assemble(scene, &blocks, &beams, &required)?;
        let mut layout = lay_out(scene, &beams, &assembled, required);

        let mut start = InitialConfiguration::placed(scene, &blocks, &beams, &ground_start)?;
        let static_start = start.settle(scene, shared)?;
        let (q, v) = start.coordinates(scene, assembled.model.size().q);
        for (k, pressed) in start.pressed {
            layout.beams[k].pressed = Some(pressed);
        }
        check_start(scene, &assembled.model, &layout, &q)?;
        check_apart(scene, &q)?;

        let mut model = assembled.model;
        if extent == Extent::Required {
            layout.required = Required::of(scene, &layout, &model, &q, &v);
            if !layout.required.removed.is_empty() {
                // The layout of the state stays the same.
                model = assemble(scene, &blocks, &beams, &layout.required)?.model;
            }
        }

        layout.possible_contacts = possible_contacts(&model, &layout);
        let state = State::new(&model, &q, &v, scene.time.step)?;
        let method = &scene.solver.method;
        let solver = match shared {
            Some(shared) => shared.solver(method),
            None => teeter_solvers::plane_solver(method),
        };
        let solver = solver.ok_or_else(|| BuildError::Solver(method.clone()))?;
        let settings =
            SolverSettings { tolerance: scene.solver.tolerance, max_iterations: scene.solver.max_iterations };
        let work = Workspace::new(&model, wrap(solver), settings);
        let scheme = scheme(&scene.time)?;
        let plan = Plan::steps(scene.time.steps()).when_unsolved(if scene.solver.require_convergence {
            Unsolved::End
        } else {
            Unsolved::GoOn
        });
        Ok(Self { model, state, layout, plan, static_start, scheme, work, started: false })
    }

    /// The name of the time scheme.
    #[must_use]
    pub fn scheme(&self) -> &'static str {
        self.scheme.name()
    }

    /// Work counts of its steps so far.
    #[must_use]
    pub fn work_counts(&self) -> WorkCounts {
        self.work.counts
    }

    /// Lets steps solve contacts of bodies that stand apart on so many threads, at least one, which is the default. The motion is
    /// the same to the last bit.
    #[cfg(feature = "parallel")]
    pub fn set_threads(&mut self, threads: usize) {
        self.work.set_threads(threads);
    }

    /// Number of free velocities of the model, without those of held dofs and of beams at rest,
    /// which are only stored in the state.
    #[must_use]
    pub fn dofs(&self) -> usize {
        let held = |k: usize, place: &BeamPlace| match self.layout.required.rests(k) {
            Some(_) => place.range.len(),
            None => place.range.len() - place.free_dofs(),
        };
        self.model.size().v - self.layout.beams.iter().enumerate().map(|(k, place)| held(k, place)).sum::<usize>()
    }

    /// Runs to the plan's end, passing every step to the observers. The state is that after the
    /// last step taken.
    ///
    /// # Errors
    /// If an observer fails.
    pub fn run(&mut self, observers: &mut [&mut dyn Observer<2>]) -> Result<Ended, RunError> {
        let plan = self.plan;
        self.run_by(&plan, observers)
    }

    /// As [`Simulation::run`], but to time `t` (s) instead of the plan's end: the last step is
    /// shortened if necessary.
    ///
    /// # Errors
    /// If an observer fails.
    pub fn run_until(&mut self, t: f64, observers: &mut [&mut dyn Observer<2>]) -> Result<Ended, RunError> {
        self.run_by(&Plan::time(t).when_unsolved(self.plan.unsolved), observers)
    }

    fn run_by(&mut self, plan: &Plan, observers: &mut [&mut dyn Observer<2>]) -> Result<Ended, RunError> {
        self.started = true;
        run(&self.model, self.scheme.as_mut(), &mut self.state, &mut self.work, plan, observers)
    }

    /// Takes one step, independent of the plan, and returns its report.
    ///
    /// ```
    /// # use teeter_scenario::simulation::Simulation;
    /// # let text = r#"
    /// #     [time]
    /// #     end = "0.1 s"
    /// #     step = "1 ms"
    /// #     [ground]
    /// #     [material.wood]
    /// #     density = "600 kg/m^3"
    /// #     [block.cube]
    /// #     material = "wood"
    /// #     width = "10 cm"
    /// #     height = "10 cm"
    /// #     depth = "10 cm"
    /// #     position = ["0 m", "6 cm"]
    /// #     [contact.floor]
    /// #     between = ["cube", "ground"]
    /// #     friction = 0.4
    /// # "#;
    /// # let resolved = teeter_scenario::load(text.as_bytes(), "cube.toml", "cube", &[])?;
    /// let mut simulation = Simulation::new(&resolved.scene)?;
    /// while simulation.step()?.contacts().next().is_none() {}
    /// let fall = (2.0_f64 * 0.01 / 9.81).sqrt();
    /// assert!((simulation.state.t - fall).abs() < 2e-3, "it touches after {fall} s");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the step can't be taken; the state is then unchanged.
    pub fn step(&mut self) -> Result<StepReport<'_, 2>, StepError> {
        let Self { model, state, scheme, work, started, .. } = self;
        if !*started {
            scheme.start(model, state, work)?;
            *started = true;
        }
        scheme.advance(model, state, f64::INFINITY, work)
    }

    /// Abandons the step being taken when `flag` is set, even within the iterations of the contact
    /// solver: a run then ends as [`Ended::Interrupted`] with the state of the last whole step, and
    /// [`Simulation::step`] fails. Cleared, the flag lets it go on to the same bytes.
    pub fn cancelled_by(&mut self, flag: Arc<AtomicBool>) {
        self.work.cancel = Some(flag);
    }

    /// Sets whether steps keep the energy account (default: yes). Without it they are faster, and
    /// `state.ledger` and the penetration in `state.tally` are not updated.
    pub fn keep_account(&mut self, account: Account) {
        self.work.account = account;
    }
}

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
fn block_bodies(scene: &Scene) -> Result<Vec<BlockBody>, BuildError> {
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
fn beam_models(scene: &Scene, shared: Option<&SharedParts>) -> Result<Vec<BeamModel>, BuildError> {
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
struct Assembled {
    model: Model<2>,
    blocks: PartPlace,
    beams: Vec<PartPlace>,
    ground: Option<PartPlace>,
}

/// The layout, from the places returned by the model builder.
fn lay_out(scene: &Scene, beams: &[BeamModel], assembled: &Assembled, required: Required) -> Layout {
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
fn assemble(
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
fn possible_contacts(model: &Model<2>, layout: &Layout) -> usize {
    let beams = layout.beams.iter();
    let fibres: Vec<u32> =
        beams.flat_map(|place| [BeamFace::Upper, BeamFace::Lower].map(|face| place.body.0 + face.fibre())).collect();
    let detector = model.detector();
    let wiring = detector.wiring();
    let sides = wiring.iter().filter(|pair| fibres.contains(&pair.bodies[1].0));
    detector.capacity() - sides.map(|pair| pair.contacts).sum::<usize>()
}

/// The blocks of a crowd, with the laws of its contacts.
fn groups(crowd: &Crowd, laws: &[LawId], blocks: &PartPlace) -> Result<Groups, WiringError> {
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

fn scheme(time: &Time) -> Result<Box<dyn Scheme<2>>, SettingError> {
    let Time { theta, activation_gamma, gap_tolerance, spectral_radius, .. } = *time;
    Ok(match time.scheme {
        SchemeName::MoreauJean => {
            Box::new(MoreauJean::new(MoreauJeanSettings { theta, activation_gamma, gap_tolerance })?)
        }
        SchemeName::MoreauJeanClosed => Box::new(MoreauJeanClosed::new(MoreauJeanClosedSettings { gap_tolerance })?),
        SchemeName::Resolved => {
            Box::new(Resolved::new(ResolvedSettings { gap_tolerance, ..ResolvedSettings::default() })?)
        }
        SchemeName::MoreauJeanProjected => {
            Box::new(MoreauJeanProjected::new(MoreauJeanProjectedSettings { gap_tolerance })?)
        }
        SchemeName::GeneralizedAlpha => {
            Box::new(GeneralizedAlpha::new(GeneralizedAlphaSettings { spectral_radius, gap_tolerance })?)
        }
        SchemeName::EventDriven => Box::new(EventDriven::new(EventDrivenSettings::default())?),
        SchemeName::MoreauJeanLocated => Box::new(MoreauJeanLocated::new(MoreauJeanLocatedSettings { gap_tolerance })?),
    })
}

/// Refuses a start with blocks inside each other.
fn check_apart(scene: &Scene, q: &[f64]) -> Result<(), BuildError> {
    let boxes: Vec<PlacedOutline> = scene
        .blocks
        .iter()
        .zip(q.chunks_exact(3))
        .map(|(block, q)| PlacedOutline::new([q[0], q[1]], q[2], &Outline::of(block)))
        .collect();
    match deepest_overlap(&boxes, START_TOLERANCE) {
        None => Ok(()),
        Some(Overlap { first, second, depth }) => Err(BuildError::Overlap {
            first: scene.blocks[first].name.clone(),
            second: scene.blocks[second].name.clone(),
            depth,
        }),
    }
}

/// A corner may start below its surface by this fraction of its block's larger side, because of the
/// rounding of decimal positions.
const START_TOLERANCE: f64 = 1e-9;

/// Refuses a start with a corner inside a surface.
fn check_start(scene: &Scene, model: &Model<2>, layout: &Layout, q: &[f64]) -> Result<(), BuildError> {
    let mut candidates = Vec::new();
    model.candidates(q, 0.0, &mut candidates)?;
    for candidate in &candidates {
        let pair = candidate.id.pair() as usize;
        // Blocks are compared as a whole, and so are those of a crowd.
        let Some(contact) = scene.contacts.get(pair).filter(|contact| contact.other_block().is_none()) else {
            continue;
        };
        let block = &scene.blocks[contact.block];
        let tolerance = START_TOLERANCE * block.width.max(block.height);
        if -candidate.gap > tolerance {
            let between = &layout.pairs[pair].between;
            let surface = if between[0] == block.name { &between[1] } else { &between[0] };
            return Err(BuildError::Penetration {
                block: block.name.clone(),
                corner: match layout.pairs[pair].point(candidate.id) {
                    Some(point) => layout.pairs[pair].points[point].name.clone(),
                    None => candidate.id.point().to_string(),
                },
                on_side: contact.sides && OnSide::from_number(candidate.id.point()).is_some(),
                lower: contact.face == BeamFace::Lower,
                surface: surface.clone(),
                depth: -candidate.gap,
                tolerance,
            });
        }
    }
    match ground_profile::crest_inside(scene, layout, q) {
        Some((block, crest)) => Err(BuildError::CrestInside { block: scene.blocks[block].name.clone(), crest }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sweeps share models among threads, and front ends simulations.
    #[test]
    fn a_simulation_can_be_sent_and_shared() {
        fn shared<T: Send + Sync>() {}
        shared::<Simulation>();
        shared::<Model<2>>();
        shared::<State>();
    }
}
