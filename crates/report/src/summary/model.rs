//! What was modelled and what was left out, as `summary.json` has it.

use serde::Serialize;
use std::collections::BTreeSet;
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Layout;
use teeter_scenario::wording;

/// What was modelled and what was left out.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModelSummary {
    /// Names of the blocks.
    pub blocks: Vec<String>,
    /// The beams.
    pub beams: Vec<BeamSummary>,
    /// Whether there is rigid ground.
    pub ground: bool,
    /// Names of the contacts; one by patterns comes once.
    pub contacts: Vec<String>,
    /// The most contacts that there can be at once, but for those of beams with sides of blocks:
    /// the same number as in `teeter check`.
    pub possible_contacts: usize,
    /// Whether ends and humps of beams may touch sides of blocks, too.
    #[serde(skip)]
    pub(crate) has_sides: bool,
    /// The forces on blocks and the loads on beams, with their size, which their signals multiply.
    pub loads: Vec<String>,
    /// Velocities of blocks and beams together.
    pub dofs: usize,
    /// What the model leaves out, and why.
    pub left_out: Vec<&'static str>,
    /// How much of the scene was asked for: `required` or `full`.
    pub extent: &'static str,
    /// What of the scene it does without, as nothing needs it.
    pub removed: Vec<RemovedSummary>,
}

/// Something that the model does without.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct RemovedSummary {
    /// What.
    pub what: String,
    /// Why nothing misses it.
    pub why: String,
    /// Whether every number is the same with it.
    pub exact: bool,
    /// If not, how far they are apart.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<String>,
}

/// A beam as modelled.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BeamSummary {
    /// Its name.
    pub name: String,
    /// Its elements.
    pub elements: usize,
    /// Its degrees of freedom.
    pub dofs: usize,
    /// The shapes in which it moves, where these are not those of all its nodes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shapes: Option<ShapesSummary>,
    /// Its theory, as in a scene.
    pub theory: &'static str,
    /// How its matrix is solved.
    pub backend: &'static str,
}

/// The shapes of a beam in modes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct ShapesSummary {
    /// Its modes, rigid motions included.
    pub modes: usize,
    /// Its static corrections.
    pub corrections: usize,
}

impl ModelSummary {
    pub(super) fn new(scene: &Scene, layout: &Layout) -> Self {
        let beams: Vec<BeamSummary> = layout
            .beams
            .iter()
            .zip(&scene.beams)
            .map(|(place, beam)| BeamSummary {
                name: place.name.clone(),
                elements: place.beam.elements(),
                dofs: place.free_dofs(),
                shapes: place
                    .basis
                    .as_ref()
                    .map(|basis| ShapesSummary { modes: basis.modes(), corrections: basis.len() - basis.modes() }),
                theory: wording::theory(beam),
                backend: wording::backend(beam),
            })
            .collect();
        let required = &layout.required;
        let moving = beams.iter().enumerate().filter(|(k, _)| !required.is_at_rest(*k));
        Self {
            blocks: layout.blocks.iter().map(|place| place.name.clone()).collect(),
            dofs: 3 * layout.blocks.len() + moving.map(|(_, beam)| beam.dofs).sum::<usize>(),
            beams,
            ground: scene.ground.is_some(),
            contacts: names_once(layout.contact_names()),
            possible_contacts: layout.possible_contacts,
            has_sides: scene.contacts.iter().any(|contact| contact.sides),
            loads: wording::loads(scene),
            left_out: teeter_scenario::left_out(scene),
            extent: required.extent.word(),
            removed: required
                .removed
                .iter()
                .map(|removed| RemovedSummary {
                    what: removed.what.clone(),
                    why: removed.why.clone(),
                    exact: removed.accuracy.is_none(),
                    accuracy: removed.accuracy.clone(),
                })
                .collect(),
        }
    }
}

/// Names without those that came before.
fn names_once<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut seen = BTreeSet::new();
    names.filter(|name| seen.insert(*name)).map(str::to_owned).collect()
}
