//! The own weight of beams that a scene leaves out (`self_weight = false`): what is said of that beside forces and stresses, and the
//! section forces of it alone, which come on top of those of a linear beam.

use teeter_beam::{Actions, Axial, Beam, SectionForces, SpanLoad};
use teeter_scenario::scene::{BeamScene, Scene};

/// Whether gravity acts in a scene, but not on this beam.
pub(crate) fn is_left_out(scene: &Scene, beam: &BeamScene) -> bool {
    !beam.self_weight && scene.gravity[1] != 0.0
}

/// What is said of forces in so many beams, of which these are without their own weight; nothing where there are none.
pub(crate) fn told(without: &[&str], beams: usize) -> Option<String> {
    match without {
        [] => None,
        [_] if beams == 1 => Some("without the beam\u{2019}s own weight".to_owned()),
        all if all.len() == beams => Some("without the beams\u{2019} own weight".to_owned()),
        some => Some(format!("without the own weight of {}", some.join(", "))),
    }
}

/// The section forces of a beam under nothing but its own weight, where the scene leaves that out and the beam's supports hold it.
pub(crate) fn left_out(scene: &Scene, of: &BeamScene, beam: &Beam) -> Option<SectionForces> {
    // What stretches a held beam doesn't add up.
    if !is_left_out(scene, of) || of.spec.axial == Axial::Held {
        return None;
    }
    let gravity = scene.gravity[1];
    let mut q = vec![0.0; beam.dofs()];
    beam.add_self_weight(gravity, &mut q).ok()?;
    beam.solve_static(&mut q).ok()?;
    beam.section_forces(&Actions::at(&q).with_loads(&[SpanLoad::Weight { gravity }])).ok()
}
