//! The parts of a scene that stay the same from one case of a study to the next.
//!
//! A case changes few keys, often one. A part of the scene is held with the settings that were read
//! while it was made, and is taken again as long as these have the same values: which keys reach
//! which part is observed, and need not be listed.

use super::blocks::BlockShape;
use super::contacts::Joined;
use super::{Resolver, Unheld};
use crate::diagnostic::Diagnostic;
use crate::document::SettingsRead;
use crate::scene::{
    BeamScene, BlockScene, ContactScene, Crowd, ForceScene, GroundScene, LoadScene, Placement, SignalScene, Time,
};

/// The parts of the last scene of a document, as far as they are right.
#[derive(Debug, Default)]
pub(super) struct SceneParts {
    pub(super) signals: Option<Part<Vec<Option<SignalScene>>>>,
    pub(super) ground: Option<Part<Option<Option<GroundScene>>>>,
    pub(super) beams: Option<Part<Vec<Option<BeamScene>>>>,
    pub(super) contacts: Option<Part<Contacts>>,
    pub(super) shapes: Option<Part<Vec<Option<BlockShape>>>>,
    pub(super) placements: Option<Part<Vec<Option<Placement>>>>,
    pub(super) blocks: Option<Part<Vec<Option<BlockScene>>>>,
    pub(super) forces: Option<Part<Vec<Option<ForceScene>>>>,
    pub(super) loads: Option<Part<Vec<Option<LoadScene>>>>,
    pub(super) time: Option<Part<Option<Time>>>,
}

/// The contacts, the pairs that they join, and those of a crowd.
pub(super) type Contacts = (Vec<Option<ContactScene>>, Joined, Option<Crowd>);

/// A part with what came up while it was made.
#[derive(Debug)]
pub(super) struct Part<T> {
    made: T,
    read: SettingsRead,
    warnings: Vec<Diagnostic>,
    unheld: Vec<Unheld>,
}

impl Resolver<'_, '_> {
    /// A part of the scene, with all the settings that it depends on. It is made of the document and
    /// of other parts, for which the settings `of` were read. The last scene's is taken if these all
    /// have the same values; otherwise it is made.
    pub(super) fn scene_part<T: Clone>(
        &mut self,
        place: fn(&mut SceneParts) -> &mut Option<Part<T>>,
        of: &[&SettingsRead],
        make: impl FnOnce(&mut Self) -> T,
    ) -> (T, SettingsRead) {
        let doc = self.doc;
        let Some(parts) = self.parts.as_deref_mut() else { return (make(self), SettingsRead::default()) };
        if let Some(part) = place(parts).as_ref().filter(|part| doc.has_settings(&part.read)) {
            self.warnings.extend_from_slice(&part.warnings);
            self.unheld.extend_from_slice(&part.unheld);
            return (part.made.clone(), part.read.clone());
        }
        let (warnings, unheld) = (self.warnings.len(), self.unheld.len());
        let (made, own) = doc.settings_read(|| make(self));
        let read = of.iter().fold(own.and(&self.of_names), |read, other| read.and(other));
        // What is wrong is told by every scene that has it.
        let part = self.errors.is_empty().then(|| Part {
            made: made.clone(),
            read: read.clone(),
            warnings: self.warnings[warnings..].to_vec(),
            unheld: self.unheld[unheld..].to_vec(),
        });
        if let Some(parts) = self.parts.as_deref_mut() {
            *place(parts) = part;
        }
        (made, read)
    }
}
