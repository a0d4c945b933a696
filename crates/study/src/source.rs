//! A scene that is run many times with different settings: its text and the files that it names,
//! read once.

use crate::Setting;
use std::collections::BTreeMap;
use teeter_scenario::diagnostic::Diagnostics;
use teeter_scenario::resolve::{ReadFile, Resolved};

/// A scene in memory.
#[derive(Debug, Clone)]
pub struct StudyScene {
    bytes: Vec<u8>,
    name: String,
    stem: String,
    sets: Vec<(String, String)>,
    files: BTreeMap<String, Vec<u8>>,
}

impl StudyScene {
    /// Reads a scene as [`teeter_scenario::load_with`] does, and keeps the data. `sets` are the
    /// user's own settings, applied in every run before the setting that is tried.
    ///
    /// # Errors
    /// All errors of the scene.
    pub fn new(
        bytes: Vec<u8>,
        name: &str,
        stem: &str,
        sets: &[(String, String)],
        read: &mut ReadFile<'_>,
    ) -> Result<(Self, Resolved), Diagnostics> {
        let resolved = teeter_scenario::load_with(&bytes, name, stem, sets, read)?;
        let files = resolved.files.iter().cloned().collect();
        Ok((Self { bytes, name: name.to_owned(), stem: stem.to_owned(), sets: sets.to_vec(), files }, resolved))
    }

    /// The scene with a setting.
    ///
    /// # Errors
    /// All errors of the scene with it.
    pub fn load(&self, setting: &Setting) -> Result<Resolved, Diagnostics> {
        let sets: Vec<_> = self.sets.iter().cloned().chain(setting.pairs()).collect();
        let mut read = |path: &str| match self.files.get(path) {
            Some(bytes) => Ok(bytes.clone()),
            None => Err("was not read with the scene".to_owned()),
        };
        teeter_scenario::load_with(&self.bytes, &self.name, &self.stem, &sets, &mut read)
    }

    /// The user's own settings.
    #[must_use]
    pub fn sets(&self) -> &[(String, String)] {
        &self.sets
    }
}
