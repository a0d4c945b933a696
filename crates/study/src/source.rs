//! A scene that is run many times with other settings: its text and the files that it names, read
//! once.

use crate::Setting;
use std::collections::BTreeMap;
use teeter_scenario::diagnostic::Diagnostics;
use teeter_scenario::resolve::{ReadFile, Resolved};

/// A scene in memory.
#[derive(Debug, Clone)]
pub struct Source {
    bytes: Vec<u8>,
    name: String,
    stem: String,
    sets: Vec<(String, String)>,
    files: BTreeMap<String, Vec<u8>>,
}

impl Source {
    /// Reads a scene as [`teeter_scenario::load_with`] does, and keeps what it read. `sets` are the
    /// user's own, which every run has before the setting that is tried.
    ///
    /// # Errors
    /// All that is wrong with the scene.
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
    /// All that is wrong with it then.
    pub fn load(&self, setting: &Setting) -> Result<Resolved, Diagnostics> {
        let sets: Vec<_> = self.sets.iter().cloned().chain(setting.pairs()).collect();
        let mut read = |path: &str| match self.files.get(path) {
            Some(bytes) => Ok(bytes.clone()),
            None => Err("was not read with the scene".to_owned()),
        };
        teeter_scenario::load_with(&self.bytes, &self.name, &self.stem, &sets, &mut read)
    }

    /// What the user set.
    #[must_use]
    pub fn sets(&self) -> &[(String, String)] {
        &self.sets
    }
}
