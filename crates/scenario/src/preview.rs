//! Preview of a run: the numbers to check before it is started.

use crate::left_out::left_out;
use crate::mesh_error::{self, MeshComparison};
use crate::output_size::{OutputSize, expected_memory, expected_seconds};
use crate::required::Removed;
use crate::resolve::Resolved;
use crate::scene::{BeamScene, BlockScene, Placement, Scene};
use crate::simulation::{BeamPlace, Simulation};
use crate::{solve_digits, stable_step, wording};
use std::f64::consts::TAU;
use teeter_beam::Axial;
use teeter_detect::ContactId;
use teeter_integrator::coupled_modes;

/// Properties of a block to check.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockPreview {
    /// Its name.
    pub name: String,
    /// Mass, kg.
    pub mass: f64,
    /// The angle at which it lies flat on the side on which it starts, rad: 0 upright.
    pub flat: f64,
    /// The critical angle about that side, rad: upright α = atan(b/H).
    pub critical_angle: Option<f64>,
    /// Angle at the start, rad.
    pub angle: f64,
    /// Name of the body that it stands on; `None` for a block placed by its mass centre.
    pub on: Option<String>,
}

/// Properties of a beam to check.
#[derive(Debug, Clone, PartialEq)]
pub struct BeamPreview {
    /// Its name.
    pub name: String,
    /// Its elements.
    pub elements: usize,
    /// Its degrees of freedom.
    pub dofs: usize,
    /// Its modal basis, if it moves in modes.
    pub shapes: Option<ShapesPreview>,
    /// How its matrix is factorised.
    pub backend: &'static str,
    /// Its theory, as in a scene.
    pub theory: &'static str,
    /// The words for its supports at the ends.
    pub supports: [&'static str; 2],
    /// What it rests on between its ends and what it carries, in words.
    pub furniture: Vec<String>,
    /// Its axial model; `None` without one.
    pub axial: Option<&'static str>,
    /// First elastic frequency, Hz: in the model, and without the error of its mesh.
    pub first_frequency: Option<MeshComparison>,
    /// Whether the latter is that of the continuous beam; otherwise it is that of a finer mesh.
    pub frequency_is_exact: bool,
    /// Circular frequency of the highest mode of the mesh times the step: above 1, the mode is not
    /// resolved in time (for θ ≥ ½ the scheme is still stable).
    pub highest_frequency_step: Option<f64>,
    /// Correct decimal digits of a solve with the matrix of a step, estimated.
    pub digits: Option<f64>,
    /// Span, m.
    pub span: f64,
    /// Largest static deflection under the blocks' weight and its own if enabled, m: in the model,
    /// and without the error of its mesh.
    pub sag: Option<MeshComparison>,
    /// Whether its own weight acts.
    pub self_weight: bool,
    /// Bending moment at which its main section (not that of a segment) begins to yield, N m, if
    /// known.
    pub yield_moment: Option<f64>,
}

/// The shapes of a beam in modes.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapesPreview {
    /// Its modes, rigid motions included.
    pub modes: usize,
    /// Its static corrections.
    pub corrections: usize,
    /// The region where its flexibility counts, m from the left end.
    pub region: [f64; 2],
    /// Largest relative error of its static flexibility there; `None` if there are too few digits
    /// to tell.
    pub error: Option<f64>,
}

/// Preview of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Preview {
    /// The blocks, in the order of the file.
    pub blocks: Vec<BlockPreview>,
    /// The beams, in the order of the file.
    pub beams: Vec<BeamPreview>,
    /// The most contacts that there can be at once
    /// ([`Layout::possible_contacts`](crate::simulation::Layout::possible_contacts)).
    pub possible_contacts: usize,
    /// The contacts, by number in the scene, of beams that can also touch sides of their blocks, with
    /// ends and humps; these are not counted above.
    pub on_sides: Vec<usize>,
    /// Velocities of blocks and beams together.
    pub dofs: usize,
    /// Estimated time of the run, s.
    pub seconds: f64,
    /// Estimated memory of the run, bytes, if it has very many contacts.
    pub memory: Option<f64>,
    /// Estimated size of its tables.
    pub volume: OutputSize,
    /// First frequencies of blocks and beams coupled, about a static start in which all blocks
    /// stand flat, Hz.
    pub coupled_frequencies: Vec<f64>,
    /// What the model leaves out, with reasons.
    pub left_out: Vec<&'static str>,
    /// What the model doesn't require of the scene.
    pub removed: Vec<Removed>,
}

impl Preview {
    /// The preview of a run of a scene; `simulation` must be built from it.
    #[must_use]
    pub fn new(resolved: &Resolved, simulation: &Simulation) -> Self {
        let scene = &resolved.scene;
        let beams: Vec<BeamPreview> = scene
            .beams
            .iter()
            .zip(&simulation.layout.beams)
            .enumerate()
            .map(|(number, (beam, place))| BeamPreview {
                sag: mesh_error::sag(scene, number),
                ..BeamPreview::of(beam, place, scene.time.theta, scene.time.step)
            })
            .collect();
        let block = |block: &BlockScene| {
            let (angle, on) = match block.placement {
                Placement::Free { angle, .. } => (angle, None),
                Placement::On { tilt, support, .. } => (tilt, Some(scene.name_of(support).to_owned())),
            };
            // What is placed on something stands on its base, however far it is tilted.
            let near = if on.is_some() { 0.0 } else { angle };
            let (flat, critical_angle) = block.flat_near(near).map_or((0.0, None), |[flat, alpha]| (flat, Some(alpha)));
            BlockPreview { name: block.name.clone(), mass: block.mass(), flat, critical_angle, angle, on }
        };
        Self {
            blocks: scene.blocks.iter().map(block).collect(),
            possible_contacts: simulation.layout.possible_contacts,
            on_sides: (0..scene.contacts.len()).filter(|k| simulation.layout.required.sides(scene, *k)).collect(),
            dofs: simulation.dofs(),
            seconds: expected_seconds(scene, beams.iter().map(|beam| beam.dofs).sum()),
            memory: expected_memory(scene),
            volume: OutputSize::of(scene),
            coupled_frequencies: coupled_frequencies(scene, simulation),
            left_out: left_out(scene),
            removed: simulation.layout.required.removed.clone(),
            beams,
        }
    }
}

impl BeamPreview {
    fn of(beam: &BeamScene, place: &BeamPlace, theta: f64, step: f64) -> Self {
        let (spec, model) = (&beam.spec, place.beam.as_ref());
        let full = place.basis.is_none();
        let shapes = beam.reduction.zip(place.basis.as_ref()).map(|(reduction, basis)| {
            let region = reduction.region(spec.span);
            let corrections = basis.len() - basis.modes();
            ShapesPreview {
                modes: basis.modes(),
                corrections,
                region,
                error: basis.truncation_error(model, region).ok(),
            }
        });
        let highest = match &place.basis {
            Some(basis) => basis.circular_frequencies().last().copied(),
            None => stable_step::highest_eigenvalue(spec).map(f64::sqrt),
        };
        let first = mesh_error::first_frequency(model, place.basis.as_deref());
        Self {
            name: beam.name.clone(),
            elements: model.elements(),
            dofs: place.free_dofs(),
            shapes,
            backend: wording::backend(beam),
            theory: wording::theory(beam),
            supports: spec.supports.map(wording::support),
            furniture: wording::furniture(spec),
            axial: match spec.axial {
                Axial::Held => Some("held along its axis, stretched by deflection"),
                Axial::Elastic { .. } => Some("elastic along its axis"),
                _ => None,
            },
            first_frequency: first.map(|(frequency, _)| frequency),
            frequency_is_exact: first.is_some_and(|(_, exact)| exact),
            highest_frequency_step: highest.map(|omega| omega * step),
            // A diagonal matrix loses no digits.
            digits: if full { solve_digits::of_step(model, theta, step) } else { None },
            span: spec.span,
            sag: None,
            self_weight: beam.self_weight,
            yield_moment: yield_moment(beam),
        }
    }
}

/// Fewer correct digits of a step's solve give a warning.
pub const FEW_DIGITS: f64 = teeter_beam::Digits::FEW;

/// Number of coupled frequencies shown.
const COUPLED: usize = 3;

/// The frequencies of small vibrations about a static start, Hz; none if a block is held tilted,
/// and so isn't at rest.
fn coupled_frequencies(scene: &Scene, simulation: &Simulation) -> Vec<f64> {
    let tilted = |block: &BlockScene| !matches!(block.placement, Placement::On { tilt, .. } if tilt == 0.0);
    let Some(start) =
        simulation.static_start.as_ref().filter(|_| !scene.blocks.is_empty() && !scene.blocks.iter().any(tilted))
    else {
        return Vec::new();
    };
    let force = |f: &crate::static_start::ContactForce| {
        (ContactId::new(f.contact as u32, f.point), nalgebra::Vector2::from(f.force))
    };
    let forces: Vec<_> = start.forces.iter().map(force).collect();
    let modes = coupled_modes(&simulation.model, &simulation.state.q, &forces, COUPLED);
    modes.map_or_else(|_| Vec::new(), |modes| modes.circular_frequencies().map(|omega| omega / TAU).collect())
}

/// σ_y I/c; `None` for a section given directly.
fn yield_moment(beam: &BeamScene) -> Option<f64> {
    beam.yield_strength.zip(beam.spec.section.section_modulus).map(|(strength, modulus)| strength * modulus)
}
