//! Discretisation errors: values of a mesh compared with those of the beam itself.
//!
//! With few elements they differ: a single pinned element has a first frequency 11 % too high, and
//! 4/5 of the sag under a uniform load.

use crate::placement::weight_of;
use crate::scene::{Reduction, Scene, SupportingBody};
use std::f64::consts::TAU;
use teeter_beam::{Beam, BeamSpec, ModalBasis};

/// A value of a model, and its value without the error of the mesh or of a few modes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshComparison {
    /// Value of the model.
    pub model: f64,
    /// Value of the beam, in closed form or from a mesh eight times as fine; `None` if unknown.
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

/// The largest static deflection (m), anywhere along a beam of the scene, under its own weight if
/// enabled and that of the blocks on it; `None` if there is neither, or no equilibrium.
pub(crate) fn sag(scene: &Scene, number: usize) -> Option<MeshComparison> {
    let beam = &scene.beams[number];
    let mut standing = scene
        .blocks
        .iter()
        .filter_map(|block| weight_of(block, SupportingBody::Beam(number), scene.gravity))
        .peekable();
    if !beam.self_weight {
        standing.peek()?;
    }
    let forces: Vec<(f64, f64)> = standing.flatten().collect();
    let load = |model: &Beam| {
        let mut load = vec![0.0; model.dofs()];
        if beam.self_weight {
            model.add_self_weight(scene.gravity[1], &mut load).ok()?;
        }
        for (x, force) in &forces {
            model.add_point_load(x - beam.position[0], -force, &mut load).ok()?;
        }
        Some(load)
    };
    let of_mesh = |spec: BeamSpec, reduction: Option<Reduction>| {
        let model = Beam::new(spec).ok()?;
        let mut load = load(&model)?;
        match reduction {
            None => model.solve_static(&mut load).ok()?,
            Some(reduction) => load = settled(&reduction.basis(&model).ok()?, &load)?,
        }
        Some(model.deflection_extremes(&load).largest())
    };
    let own = of_mesh(beam.spec.clone(), beam.reduction)?;
    let fine = refined(&beam.spec).and_then(|fine| of_mesh(fine, None));
    Some(MeshComparison { model: own, beam: fine })
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
