//! What a run of a scene will be like: the numbers to look at before it is started.

use crate::left_out::left_out;
use crate::mesh_error::{self, OfMesh};
use crate::required::Removed;
use crate::resolve::Resolved;
use crate::scene::{BeamScene, BlockScene, Placement, Scene};
use crate::simulation::{BeamPlace, Simulation};
use crate::volume::{Volume, expected_seconds};
use crate::{stability, wording};
use std::f64::consts::TAU;
use teeter_beam::{Axial, Beam, MatrixWeights};
use teeter_detect::ContactId;
use teeter_integrator::coupled_modes;

/// A block, as far as one wants to check it.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockOutlook {
    /// Its name.
    pub name: String,
    /// Mass, kg.
    pub mass: f64,
    /// Critical angle α = atan(b/H), rad.
    pub critical_angle: Option<f64>,
    /// Angle at the start, rad.
    pub angle: f64,
    /// Name of what it stands on; `None` for a block placed by its mass centre.
    pub on: Option<String>,
}

/// A beam, as far as one wants to check it.
#[derive(Debug, Clone, PartialEq)]
pub struct BeamOutlook {
    /// Its name.
    pub name: String,
    /// Its elements.
    pub elements: usize,
    /// Its degrees of freedom.
    pub dofs: usize,
    /// The shapes in which it moves, where these are not those of all its nodes.
    pub shapes: Option<ShapesOutlook>,
    /// How its matrix is solved.
    pub backend: &'static str,
    /// Its theory, as in a scene.
    pub theory: &'static str,
    /// The words for its supports at the ends.
    pub supports: [&'static str; 2],
    /// Supports between the ends.
    pub inner_supports: usize,
    /// What happens along its axis; `None` where nothing is modelled.
    pub axial: Option<&'static str>,
    /// First elastic frequency, Hz: of the model, and without the error of its mesh.
    pub first_frequency: Option<OfMesh>,
    /// Whether the latter is that of the continuous beam; else it is of a finer mesh.
    pub frequency_is_exact: bool,
    /// Circular frequency of the highest mode of the mesh times the step: over 1, the mode is not
    /// resolved in time (the scheme is stable all the same for θ ≥ ½).
    pub highest_frequency_step: Option<f64>,
    /// Correct decimal digits of a solve with the matrix of a step, estimated.
    pub digits: Option<f64>,
    /// Span, m.
    pub span: f64,
    /// Largest static deflection under the blocks' weight and its own, where that acts, m: of the
    /// model, and without the error of its mesh.
    pub sag: Option<OfMesh>,
    /// Whether its own weight acts.
    pub self_weight: bool,
    /// Bending moment at which its own section (not that of a segment) begins to yield, N m, where
    /// that is known.
    pub yield_moment: Option<f64>,
}

/// The shapes of a beam in modes.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapesOutlook {
    /// Its modes, rigid motions included.
    pub modes: usize,
    /// Its static corrections.
    pub corrections: usize,
    /// Where its flexibility counts, m from the left end.
    pub region: [f64; 2],
    /// Largest relative error of its static flexibility there; `None` where there are no digits to
    /// tell.
    pub error: Option<f64>,
}

/// What a run will be like.
#[derive(Debug, Clone, PartialEq)]
pub struct Outlook {
    /// The blocks, in the order of the file.
    pub blocks: Vec<BlockOutlook>,
    /// The beams, in the order of the file.
    pub beams: Vec<BeamOutlook>,
    /// Corners that can touch a surface.
    pub possible_contacts: usize,
    /// Velocities of blocks and beams together.
    pub dofs: usize,
    /// Time that the run takes, s; a rule of thumb.
    pub seconds: f64,
    /// What its tables hold; an estimate.
    pub volume: Volume,
    /// First frequencies of blocks and beams together about a static start in which all blocks
    /// stand flat, Hz.
    pub coupled_frequencies: Vec<f64>,
    /// What the model leaves out, and why.
    pub left_out: Vec<&'static str>,
    /// What of the scene the model does without, as nothing needs it.
    pub removed: Vec<Removed>,
}

impl Outlook {
    /// The outlook on a run of a scene; `simulation` is made of it.
    #[must_use]
    pub fn new(resolved: &Resolved, simulation: &Simulation) -> Self {
        let scene = &resolved.scene;
        let beams: Vec<BeamOutlook> = scene
            .beams
            .iter()
            .zip(&simulation.layout.beams)
            .enumerate()
            .map(|(number, (beam, place))| BeamOutlook {
                sag: mesh_error::sag(scene, number),
                ..BeamOutlook::of(beam, place, scene.time.theta, scene.time.step)
            })
            .collect();
        let block = |block: &BlockScene| {
            let (angle, on) = match block.placement {
                Placement::Free { angle, .. } => (angle, None),
                Placement::On { tilt, support, .. } => (tilt, Some(scene.name_of(support).to_owned())),
            };
            let (mass, critical_angle) = (block.mass(), block.critical_angle());
            BlockOutlook { name: block.name.clone(), mass, critical_angle, angle, on }
        };
        Self {
            blocks: scene.blocks.iter().map(block).collect(),
            possible_contacts: simulation.model.detector().capacity(),
            dofs: simulation.dofs(),
            seconds: expected_seconds(scene, beams.iter().map(|beam| beam.dofs).sum()),
            volume: Volume::of(scene),
            coupled_frequencies: coupled_frequencies(scene, simulation),
            left_out: left_out(scene),
            removed: simulation.layout.required.removed.clone(),
            beams,
        }
    }
}

impl BeamOutlook {
    fn of(beam: &BeamScene, place: &BeamPlace, theta: f64, step: f64) -> Self {
        let (spec, model) = (&beam.spec, place.beam.as_ref());
        let full = place.basis.is_none();
        let shapes = beam.reduction.zip(place.basis.as_ref()).map(|(reduction, basis)| {
            let region = reduction.region(spec.span);
            let corrections = basis.len() - basis.modes();
            ShapesOutlook {
                modes: basis.modes(),
                corrections,
                region,
                error: basis.truncation_error(model, region).ok(),
            }
        });
        let highest = match &place.basis {
            Some(basis) => basis.circular_frequencies().last().copied(),
            None => stability::highest_eigenvalue(spec).map(f64::sqrt),
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
            inner_supports: spec.inner_supports.len(),
            axial: match spec.axial {
                Axial::Held => Some("held along its axis, a deflection stretches it"),
                Axial::Elastic { .. } => Some("elastic along its axis"),
                _ => None,
            },
            first_frequency: first.map(|(frequency, _)| frequency),
            frequency_is_exact: first.is_some_and(|(_, exact)| exact),
            highest_frequency_step: highest.map(|omega| omega * step),
            // A diagonal matrix keeps all.
            digits: if full { step_digits(model, theta, step) } else { None },
            span: spec.span,
            sag: None,
            self_weight: beam.self_weight,
            yield_moment: yield_moment(beam),
        }
    }
}

/// With fewer correct digits of a step's solve a run deserves a warning.
pub const FEW_DIGITS: f64 = teeter_beam::Digits::FEW;

/// How many frequencies of the whole are told.
const COUPLED: usize = 3;

/// The frequencies of small vibrations about a static start, Hz; none where a block is held tilted,
/// and so doesn't rest.
fn coupled_frequencies(scene: &Scene, simulation: &Simulation) -> Vec<f64> {
    let tilted = |block: &BlockScene| !matches!(block.placement, Placement::On { tilt, .. } if tilt == 0.0);
    let Some(start) =
        simulation.static_start.as_ref().filter(|_| !scene.blocks.is_empty() && !scene.blocks.iter().any(tilted))
    else {
        return Vec::new();
    };
    let force = |f: &crate::settling::ContactForce| {
        (ContactId::new(f.contact as u32, f.point), nalgebra::Vector2::from(f.force))
    };
    let forces: Vec<_> = start.forces.iter().map(force).collect();
    let modes = coupled_modes(&simulation.model, &simulation.state.q, &forces, COUPLED);
    modes.map_or_else(|_| Vec::new(), |modes| modes.circular_frequencies().map(|omega| omega / TAU).collect())
}

/// Digits of a step's solve.
pub(crate) fn step_digits(model: &Beam, theta: f64, step: f64) -> Option<f64> {
    let ht = theta * step;
    let weights = MatrixWeights { mass: 1.0, damping: ht, stiffness: ht * ht };
    model.digits(weights).ok().map(|digits| digits.of_solve())
}

/// σ_y I/c; none of a section given directly.
fn yield_moment(beam: &BeamScene) -> Option<f64> {
    beam.yield_strength.zip(beam.spec.section.section_modulus).map(|(strength, modulus)| strength * modulus)
}
