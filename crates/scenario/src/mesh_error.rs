//! Discretisation errors: values of a mesh compared with those of the beam itself.
//!
//! With few elements they differ: a single pinned element has a first frequency 11 % too high, and
//! 4/5 of the sag under a uniform load.

use crate::flexibility;
use crate::placement::weight_of;
use crate::scene::{Reduction, Scene, SupportingBody};
use std::f64::consts::TAU;
use teeter_beam::{Beam, BeamSpec, ModalBasis};

/// A value of a model, and its value without the error of the mesh or of a few modes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshComparison {
    /// Value of the model.
    pub model: f64,
    /// Value of the beam, in closed form or from a finer mesh; `None` if unknown.
    pub beam: Option<f64>,
}

/// Relative difference from which on both values are shown.
const DIFFERENT: f64 = 0.01;

impl MeshComparison {
    /// The value of the beam, if the model is off by more than 1 %.
    #[must_use]
    pub fn exact_if_different(&self) -> Option<f64> {
        self.beam.filter(|beam| (self.model - beam).abs() > DIFFERENT * beam.abs())
    }

    /// The larger of the two.
    #[must_use]
    pub fn larger(&self) -> f64 {
        self.beam.map_or(self.model, |beam| beam.max(self.model))
    }
}

/// Refinement of the mesh that represents the beam itself: errors of order n⁻⁴ decrease to 1/4096.
const FINER: usize = 8;

/// Meshes with more elements are not refined: their errors are negligible, and a check should be
/// fast.
const COARSE: usize = 100;

/// A mesh with each element divided into eight; `None` if it is fine already.
fn refined(spec: &BeamSpec) -> Option<BeamSpec> {
    let mut fine = spec.clone();
    if spec.nodes.is_empty() {
        fine.elements *= FINER;
    } else {
        let parts = |ends: &[f64]| -> Vec<f64> {
            (0..FINER).map(|k| ends[0] + (ends[1] - ends[0]) * k as f64 / FINER as f64).collect()
        };
        fine.nodes = spec.nodes.windows(2).flat_map(parts).chain([spec.span]).collect();
    }
    (fine.elements.max(fine.nodes.len()) <= FINER * COARSE).then_some(fine)
}

/// The first elastic circular frequency of a mesh, rad/s.
fn mesh_frequency(beam: &Beam) -> Option<f64> {
    // Up and down, turning, along the axis: at most three rigid motions come before it.
    let modes = beam.modes(beam.free_dofs().min(4)).ok()?;
    modes.circular_frequencies().get(modes.rigid()).copied()
}

/// The first elastic frequency of a beam in the model, Hz; unknown where it has no closed form and more elements than `most`.
pub(crate) fn model_frequency(beam: &Beam, basis: Option<&ModalBasis>, most: usize) -> Option<f64> {
    let circular = match basis {
        Some(basis) => basis.circular_frequencies().get(basis.rigid()).copied(),
        None if beam.elements() > most => beam.spec().circular_frequency(1).ok(),
        None => mesh_frequency(beam),
    };
    circular.map(|omega| omega / TAU)
}

/// The first elastic frequency of a beam, Hz, in the model and exactly, and whether the latter is
/// that of the continuous beam; otherwise it is that of a finer mesh.
pub(crate) fn first_frequency(beam: &Beam, basis: Option<&ModalBasis>) -> Option<(MeshComparison, bool)> {
    let spec = beam.spec();
    let exact = spec.circular_frequency(1).ok();
    let fine = || refined(spec).and_then(|spec| mesh_frequency(&Beam::new(spec).ok()?));
    let model = match basis {
        Some(basis) => basis.circular_frequencies().get(basis.rigid()).copied(),
        // For a fine mesh the formula is as accurate as the finite elements.
        None if exact.is_some() && refined(spec).is_none() => exact,
        None => mesh_frequency(beam),
    };
    Some((MeshComparison { model: model? / TAU, beam: exact.or_else(fine).map(|omega| omega / TAU) }, exact.is_some()))
}

/// What the static deflection of a beam depends on.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Sagging {
    spec: BeamSpec,
    reduction: Option<Reduction>,
    /// Gravity along y (m/s²), if it acts on the beam.
    own_weight: Option<f64>,
    /// Positions (m from the left end) and weights (N) of what stands on it.
    standing: Vec<(f64, f64)>,
}

impl Sagging {
    /// That of a beam of the scene under its own weight, if enabled, and that of the blocks on it; `None` if there is neither.
    pub(crate) fn of(scene: &Scene, number: usize) -> Option<Self> {
        let beam = &scene.beams[number];
        let mut standing = scene
            .blocks
            .iter()
            .filter_map(|block| weight_of(block, SupportingBody::Beam(number), scene.gravity))
            .peekable();
        if !beam.self_weight {
            standing.peek()?;
        }
        let standing = standing.flatten().map(|(x, force)| (x - beam.start_position()[0], force)).collect();
        let own_weight = beam.self_weight.then_some(scene.gravity[1]);
        Some(Self { spec: beam.spec.clone(), reduction: beam.reduction, own_weight, standing })
    }

    /// The largest static deflection (m), anywhere along the beam; `None` if there is no equilibrium.
    pub(crate) fn largest(&self) -> Option<MeshComparison> {
        let model = Beam::new(self.spec.clone()).ok()?;
        let own = self.under_weights(&model, self.reduction)?;
        let finer = || {
            let places: Vec<f64> = self.standing.iter().map(|(x, _)| *x).collect();
            self.under_weights(&Beam::new(flexibility::fine(&model, &places)).ok()?, None)
        };
        let is_coarse = model.elements() <= COARSE;
        Some(MeshComparison { model: own, beam: is_coarse.then(finer).flatten() })
    }

    fn under_weights(&self, model: &Beam, reduction: Option<Reduction>) -> Option<f64> {
        let mut load = vec![0.0; model.dofs()];
        if let Some(gravity) = self.own_weight {
            model.add_self_weight(gravity, &mut load).ok()?;
        }
        for (x, force) in &self.standing {
            model.add_point_load(*x, -force, &mut load).ok()?;
        }
        match reduction {
            None => model.solve_static(&mut load).ok()?,
            Some(reduction) => load = settled(&reduction.basis(model).ok()?, &load)?,
        }
        Some(model.deflection_extremes(&load).largest())
    }
}

/// The largest static deflection of a beam of the scene, under its own weight if enabled and that of the blocks on it; `None` if there
/// is neither, or no equilibrium.
pub(crate) fn sag(scene: &Scene, number: usize) -> Option<MeshComparison> {
    Sagging::of(scene, number)?.largest()
}

/// The equilibrium in a modal basis: mass-orthonormal, so with stiffness ω².
fn settled(basis: &ModalBasis, load: &[f64]) -> Option<Vec<f64>> {
    let coordinate = |(k, omega): (usize, &f64)| {
        let force: f64 = basis.shape(k).iter().zip(load).map(|(shape, force)| shape * force).sum();
        force / (omega * omega)
    };
    let coordinates: Vec<f64> = basis.circular_frequencies().iter().enumerate().map(coordinate).collect();
    (basis.rigid() == 0).then(|| basis.dofs(&coordinates))
}
