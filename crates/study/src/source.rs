//! A scene that is run many times with different settings: its text and the files that it names,
//! read once.

use crate::Setting;
use std::collections::BTreeMap;
use std::sync::Arc;
use teeter_report::SharedStances;
use teeter_scenario::ParsedScene;
use teeter_scenario::diagnostic::{Diagnostic, Diagnostics};
use teeter_scenario::resolve::{ReadFile, Resolved, SharedCounts, SharedParts};
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::{BuildError, Simulation};

/// A scene in memory.
#[derive(Debug, Clone)]
pub struct StudyScene {
    bytes: Vec<u8>,
    /// Parsed once; or why it can't be.
    parsed: Result<ParsedScene, Diagnostics>,
    stem: String,
    sets: Vec<(String, String)>,
    files: BTreeMap<String, Vec<u8>>,
    shared: Arc<SharedParts>,
    stances: Arc<SharedStances>,
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
        let parsed = ParsedScene::new(&bytes, name)?;
        let resolved = parsed.load(stem, sets, read)?;
        let files = resolved.files.iter().cloned().collect();
        Ok((
            Self {
                bytes,
                parsed: Ok(parsed),
                stem: stem.to_owned(),
                sets: sets.to_vec(),
                files,
                shared: Arc::default(),
                stances: Arc::default(),
            },
            resolved,
        ))
    }

    /// A scene that is run with many settings, some of which name files: all files that the scene
    /// reads with one of `settings` are read once. Settings that are refused count as well.
    pub fn with_files_of(
        bytes: Vec<u8>,
        name: &str,
        stem: &str,
        settings: impl Iterator<Item = Setting>,
        read: &mut ReadFile<'_>,
    ) -> Self {
        let mut files: BTreeMap<String, Vec<u8>> = BTreeMap::new();
        let parsed = ParsedScene::new(&bytes, name);
        for setting in settings {
            let mut kept = |path: &str| match files.get(path) {
                Some(bytes) => Ok(bytes.clone()),
                None => {
                    let bytes = read(path)?;
                    files.insert(path.to_owned(), bytes.clone());
                    Ok(bytes)
                }
            };
            // What is wrong with a case is told where the case is run.
            let _ = parsed.as_ref().map(|parsed| parsed.load(stem, &setting.pairs(), &mut kept));
        }
        let (shared, stances) = (Arc::default(), Arc::default());
        Self { bytes, parsed, stem: stem.to_owned(), sets: Vec::new(), files, shared, stances }
    }

    /// The bytes of the scene and of the files that it reads, in an order that depends on their
    /// names alone.
    pub fn contents(&self) -> impl Iterator<Item = &[u8]> {
        std::iter::once(self.bytes.as_slice()).chain(self.files.values().map(Vec::as_slice))
    }

    /// The names of the files that the scene reads.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        self.files.keys().map(String::as_str)
    }

    /// These with their bytes.
    pub fn named_contents(&self) -> impl Iterator<Item = (&str, &[u8])> {
        self.files.iter().map(|(name, bytes)| (name.as_str(), bytes.as_slice()))
    }

    /// The scene with a setting.
    ///
    /// # Errors
    /// All errors of the scene with it.
    pub fn load(&self, setting: &Setting) -> Result<Resolved, Diagnostics> {
        self.parsed()?.load(&self.stem, &self.sets_of(setting), &mut |path| self.file(path))
    }

    /// What is wrong with the texts of the scene and of a setting, each value by itself.
    pub fn errors_of_text(&self, setting: &Setting) -> Diagnostics {
        self.parsed().map_or_else(|found| found, |parsed| parsed.errors_of_text(&self.sets_of(setting)))
    }

    /// The scene with a setting without warnings and notes: what of it scenes share is made once.
    ///
    /// # Errors
    /// All errors of the scene with it.
    pub fn scene(&self, setting: &Setting) -> Result<Scene, Diagnostics> {
        self.parsed()?.scene(&self.stem, &self.sets_of(setting), &self.shared, &mut |path| self.file(path))
    }

    /// As [`Self::scene`], with the warnings about the scene before its run.
    ///
    /// # Errors
    /// All errors of the scene with it.
    pub fn scene_with_warnings(&self, setting: &Setting) -> Result<(Scene, Vec<Diagnostic>), Diagnostics> {
        let (sets, read) = (self.sets_of(setting), &mut |path: &str| self.file(path));
        self.parsed()?.scene_with_warnings(&self.stem, &sets, &self.shared, read)
    }

    /// The simulation of a scene with some setting, with what of it such scenes share.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn simulation(&self, scene: &Scene) -> Result<Simulation, BuildError> {
        Simulation::with_shared(scene, &self.shared)
    }

    /// What was made for all scenes so far.
    #[must_use]
    pub fn counts(&self) -> SharedCounts {
        self.shared.counts()
    }

    /// How blocks stand, for the recorders of its runs.
    #[must_use]
    pub fn stances(&self) -> &Arc<SharedStances> {
        &self.stances
    }

    fn parsed(&self) -> Result<&ParsedScene, Diagnostics> {
        self.parsed.as_ref().map_err(Clone::clone)
    }

    fn sets_of(&self, setting: &Setting) -> Vec<(String, String)> {
        self.sets.iter().cloned().chain(setting.pairs()).collect()
    }

    fn file(&self, path: &str) -> Result<Vec<u8>, String> {
        self.files.get(path).cloned().ok_or_else(|| "was not read with the scene".to_owned())
    }

    /// The user's own settings.
    #[must_use]
    pub fn sets(&self) -> &[(String, String)] {
        &self.sets
    }
}
