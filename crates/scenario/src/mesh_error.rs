//! What a mesh makes of its beam: numbers of the model, beside those of the beam that it stands
//! for.
//!
//! With few elements the two part: one element between pins has 11 % more than the first frequency,
//! and sags by 4/5 of what it should under an even load.

use crate::placement::weight_of;
use crate::scene::{Reduction, Scene, Support};
use std::f64::consts::TAU;
use teeter_beam::{Beam, BeamSpec, ModalBasis};

/// A number of a model, and what it would be without the error of its mesh, or of its few shapes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OfMesh {
    /// That of the model.
    pub model: f64,
    /// That of the beam, in closed form or of a mesh eight times as fine; `None` where it is not
    /// known.
    pub beam: Option<f64>,
}

/// The two are told apart from this part of the beam's on.
const PARTED: f64 = 0.01;

impl OfMesh {
    /// That of the beam, where the model is off by more than 1 %.
    #[must_use]
    pub fn parted(&self) -> Option<f64> {
        self.beam.filter(|beam| (self.model - beam).abs() > PARTED * beam.abs())
    }

    /// The larger of the two.
    #[must_use]
    pub fn larger(&self) -> f64 {
        self.beam.map_or(self.model, |beam| beam.max(self.model))
    }
}

/// How much finer the mesh is that stands for the beam itself: errors of order n⁻⁴ fall to 1/4096.
const FINER: usize = 8;

/// Meshes with more elements are not refined: their errors don't show, and a check should not take
/// longer than it must.
const COARSE: usize = 100;

/// A mesh with each element divided into eight; `None` where it is fine already.
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

/// The first elastic frequency of a beam as modelled, Hz, and its own, and whether that is of the
/// continuous beam: else it is one of a finer mesh.
pub(crate) fn first_frequency(beam: &Beam, basis: Option<&ModalBasis>) -> Option<(OfMesh, bool)> {
    let spec = beam.spec();
    let exact = spec.circular_frequency(1).ok();
    let fine = || refined(spec).and_then(|spec| mesh_frequency(&Beam::new(spec).ok()?));
    let model = match basis {
        Some(basis) => basis.circular_frequencies().get(basis.rigid()).copied(),
        // Of a fine mesh the formula is as good as the finite elements.
        None if exact.is_some() && refined(spec).is_none() => exact,
        None => mesh_frequency(beam),
    };
    Some((OfMesh { model: model? / TAU, beam: exact.or_else(fine).map(|omega| omega / TAU) }, exact.is_some()))
}

/// The largest static deflection (m) of a beam of the scene under its own weight, where it has any,
/// and that of the blocks that stand on it, anywhere along it; `None` where neither is there, or
/// where it has no equilibrium.
pub(crate) fn sag(scene: &Scene, number: usize) -> Option<OfMesh> {
    let beam = &scene.beams[number];
    let mut standing =
        scene.blocks.iter().filter_map(|block| weight_of(block, Support::Beam(number), scene.gravity)).peekable();
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
    Some(OfMesh { model: own, beam: fine })
}

/// The equilibrium in the shapes of a basis: mass-orthonormal, so of stiffness ω².
fn settled(basis: &ModalBasis, load: &[f64]) -> Option<Vec<f64>> {
    let coordinate = |(k, omega): (usize, &f64)| {
        let force: f64 = basis.shape(k).iter().zip(load).map(|(shape, force)| shape * force).sum();
        force / (omega * omega)
    };
    let coordinates: Vec<f64> = basis.circular_frequencies().iter().enumerate().map(coordinate).collect();
    (basis.rigid() == 0).then(|| basis.dofs(&coordinates))
}
