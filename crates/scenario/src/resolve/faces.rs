//! Contacts of blocks with beams: from which side, and with what of the block.

use super::Resolver;
use crate::driven::{self, BeamModel};
use crate::placement::{carried_by, starting_poses};
use crate::scene::{ContactScene, Placement, Scene, SupportingBody};
use crate::words::{Face, TouchingPoints, Word};
use nalgebra::Vector3;
use teeter_detect::Kinematics;
use teeter_integrator::BeamFace;

impl Resolver<'_, '_> {
    /// Whether sides of the block of a contact can touch its surface.
    pub(super) fn has_sides(&self, path: &str, surface: SupportingBody, kinematics: Kinematics) -> bool {
        let points = self.doc.text(&format!("{path}.points")).and_then(TouchingPoints::of);
        let on_sides = match points {
            Some(TouchingPoints::All) | None => true,
            Some(TouchingPoints::Corners) => false,
        };
        on_sides && matches!(surface, SupportingBody::Beam(_)) && kinematics == Kinematics::Deformed
    }

    /// Refuses keys that are for beams in a contact that none takes part in. The default is
    /// allowed, since a written scene contains all defaults.
    pub(super) fn only_at_beams(&mut self, path: &str, surfaces: impl IntoIterator<Item = SupportingBody>) {
        if surfaces.into_iter().any(|surface| matches!(surface, SupportingBody::Beam(_))) {
            return;
        }
        let corners = self.doc.text(&format!("{path}.points")).and_then(TouchingPoints::of);
        let keys =
            [("face", self.doc.has(&format!("{path}.face"))), ("points", corners == Some(TouchingPoints::Corners))];
        for (key, _) in keys.into_iter().filter(|(_, given)| *given) {
            let rule = "it is for contacts with beams, and no beam takes part in this one";
            self.error(&format!("{path}.{key}"), rule, "leave it out");
        }
    }

    /// Reports beams with a static start that neither supports nor blocks under them hold. In a
    /// scene that couldn't be resolved nothing is known of these.
    pub(super) fn report_unheld(&mut self, scene: Option<&Scene>) {
        let unheld = std::mem::take(&mut self.unheld);
        let Some(scene) = scene else { return };
        for unheld in unheld {
            let is_it = |surface: SupportingBody| matches!(surface, SupportingBody::Beam(k) if scene.beams[k].name == unheld.beam);
            if !scene.contacts.iter().any(|contact| contact.face == BeamFace::Lower && is_it(contact.surface)) {
                self.error(&format!("beam.{}.start", unheld.beam), unheld.rule, unheld.remedy);
            }
        }
    }

    /// Sets the faces of contacts with beams: as given, else by where their blocks start.
    pub(super) fn faces(&mut self, scene: &mut Scene) {
        let mut poses: Option<Option<Vec<Vector3<f64>>>> = None;
        for number in 0..scene.contacts.len() {
            let contact = &scene.contacts[number];
            let SupportingBody::Beam(beam) = contact.surface else { continue };
            let key = format!("contact.{}.face", contact.name);
            let given = self.doc.text(&key).and_then(Face::of);
            if given == Some(Face::Upper) || (given.is_none() && lies_on(scene, contact, beam)) {
                continue;
            }
            let centre = match scene.blocks[contact.block].placement {
                Placement::Free { position, .. } => Some(position),
                // Without a start there is an error elsewhere.
                Placement::On { .. } => {
                    let poses = poses.get_or_insert_with(|| start(scene)).as_ref();
                    poses.and_then(|poses| poses.get(contact.block)).map(|pose| [pose.x, pose.y])
                }
            };
            let Some([x, y]) = centre else { continue };
            let (of, block) = (&scene.beams[beam], &scene.blocks[contact.block]);
            let [left, axis] = of.start_position();
            let is_below = y < axis;
            let over = (left..=left + of.spec.span).contains(&x);
            // One that is not convex can hang on it.
            let is_convex = block.parts.as_ref().is_none_or(|parts| parts.len() == 1);
            if given == Some(Face::Lower) && !is_below && over && is_convex {
                let rule = format!("the block `{}` starts above `{}`, not below it", block.name, of.name);
                self.error(&key, rule, "leave it out, or place the block below the beam");
            }
            if given == Some(Face::Lower) || is_below {
                scene.contacts[number].face = BeamFace::Lower;
            }
        }
    }
}

/// Whether the block of a contact starts on the beam, directly or on other blocks.
fn lies_on(scene: &Scene, contact: &ContactScene, beam: usize) -> bool {
    let placement = |block: usize| scene.blocks.get(block).map(|block| &block.placement);
    carried_by(scene.blocks.len(), contact.block, placement) == Some(beam)
}

/// Where all blocks start; `None` if that can't be found.
fn start(scene: &Scene) -> Option<Vec<Vector3<f64>>> {
    let models = scene.beams.iter().map(BeamModel::new).collect::<Result<Vec<_>, _>>().ok()?;
    let deflections: Vec<Vec<f64>> =
        scene.beams.iter().zip(&models).map(|(of, model)| model.coordinates(&of.shape)).collect();
    let ground = scene.ground.as_ref().map(|of| driven::ground(of).coordinates(0.0)).unwrap_or_default();
    let incline = scene.ground.as_ref().map_or(0.0, |ground| ground.incline);
    let line = if let [x, y, slope] = *ground { [x, y, slope] } else { [0.0, 0.0, incline] };
    starting_poses(scene, &models, &deflections, line).ok()
}
