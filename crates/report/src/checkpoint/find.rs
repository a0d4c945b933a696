//! What there is to resume in the folder of a run.

use super::identity::difference;
use super::{CHECKPOINT, Checkpoint, CheckpointError, Identity};
use crate::recorder::TABLES;
use crate::{EndedWord, FILES};
use std::fs;
use std::io;
use std::path::Path;

/// What there is to resume in a folder. Looking changes nothing.
#[derive(Debug)]
pub enum Found {
    /// No results.
    Nothing,
    /// Results of this scene, but no checkpoint: the run was ended before its first, or wrote none.
    Unfinished,
    /// A checkpoint of this program, scene and options, with its tables.
    Checkpoint(Box<Checkpoint>),
    /// The run came to its end, as its `summary.json` says.
    Ended(EndedWord),
}

/// Ends after which there is nothing to go on with: the run is complete, or would end the same way again.
const FINAL: [EndedWord; 4] = [EndedWord::Complete, EndedWord::Stopped, EndedWord::Diverged, EndedWord::Unconverged];

impl Found {
    /// Looks into the folder of a run; `scene_as_run` is what its `scene.toml` holds.
    ///
    /// # Errors
    /// If it holds a checkpoint that can't be used, or results of another scene.
    pub fn look(folder: &Path, identity: &Identity, scene_as_run: &str) -> Result<Self, CheckpointError> {
        let checkpoint = folder.join(CHECKPOINT);
        let has_results = FILES.iter().any(|file| folder.join(file).exists());
        if !has_results {
            return Ok(Self::Nothing);
        }
        if let Some(ended) = ended(folder) {
            same_scene(folder, scene_as_run)?;
            return Ok(Self::Ended(ended));
        }
        if !checkpoint.exists() {
            same_scene(folder, scene_as_run)?;
            return Ok(Self::Unfinished);
        }
        let checkpoint = Checkpoint::read(&checkpoint, identity)?;
        for (name, &wanted) in TABLES.iter().zip(&checkpoint.rest.tables) {
            let path = folder.join(name);
            match fs::metadata(&path) {
                Ok(data) if data.len() < wanted => {
                    return Err(CheckpointError::Table { path, found: data.len(), wanted });
                }
                Ok(_) => {}
                // A table that this run doesn't write; others have a header.
                Err(error) if error.kind() == std::io::ErrorKind::NotFound && wanted == 0 => {}
                Err(source) => return Err(CheckpointError::Read { path, source }),
            }
        }
        Ok(Self::Checkpoint(Box::new(checkpoint)))
    }
}

/// How the run of a folder ended, if that was for good.
fn ended(folder: &Path) -> Option<EndedWord> {
    let summary: serde_json::Value = serde_json::from_slice(&fs::read(folder.join("summary.json")).ok()?).ok()?;
    let word = summary.get("ended")?.as_str()?;
    FINAL.into_iter().find(|ended| ended.word() == word)
}

fn same_scene(folder: &Path, scene_as_run: &str) -> Result<(), CheckpointError> {
    let path = folder.join("scene.toml");
    match fs::read_to_string(&path) {
        Ok(text) if text == scene_as_run => Ok(()),
        Ok(text) => {
            let difference = difference(&text, scene_as_run);
            Err(CheckpointError::Scene { path, difference })
        }
        Err(source) if source.kind() == io::ErrorKind::NotFound => Err(CheckpointError::Unknown(folder.to_owned())),
        Err(source) => Err(CheckpointError::Read { path, source }),
    }
}
