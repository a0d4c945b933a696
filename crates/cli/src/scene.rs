//! The scene named on the command line.

use std::io::Read;
use std::path::Path;
use teeter_run::{LoadError, SceneFileError, SceneSource};
use teeter_scenario::decode::LARGEST_FILE;

/// The scene file with that path, or the scene on standard input for `-`: if it is too large, only
/// enough to detect that. The files that it names are relative to `base`, if that is given.
pub(crate) fn source(path: &Path, base: Option<&Path>) -> Result<SceneSource, LoadError> {
    let source = of(path)?;
    Ok(match base {
        Some(base) => source.beside(base),
        None => source,
    })
}

fn of(path: &Path) -> Result<SceneSource, LoadError> {
    if path != Path::new("-") {
        return Ok(SceneSource::file(path));
    }
    let (name, mut bytes) = ("<stdin>", Vec::new());
    match std::io::stdin().take(LARGEST_FILE as u64 + 1).read_to_end(&mut bytes) {
        Ok(_) => Ok(SceneSource::bytes(bytes, name, "stdin")),
        Err(error) => Err(LoadError::Unreadable { name: name.to_owned(), error: SceneFileError::Io(error) }),
    }
}
