//! The source of a scene: a file, or bytes in memory; and the files that it names.

use crate::{LoadError, SceneFileError};
use std::borrow::Cow;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};
use teeter_scenario::decode::LARGEST_FILE;
use teeter_scenario::diagnostic::is_display_control;
use teeter_scenario::number_table::LARGEST_RECORD;
use teeter_scenario::resolve::Resolved;

/// A scene file or its bytes, with its name in messages and the stem of the names of its results.
#[derive(Clone, Debug)]
pub struct SceneSource {
    content: SceneContent,
    name: String,
    stem: String,
    /// Folder of the files that the scene names; empty for the working directory.
    folder: PathBuf,
}

#[derive(Clone, Debug)]
enum SceneContent {
    File(PathBuf),
    Bytes(Vec<u8>),
}

impl SceneSource {
    /// The scene file `path`, read when needed. Messages use its path, results its file stem; the
    /// files that it names are relative to its folder.
    #[must_use]
    pub fn file(path: impl Into<PathBuf>) -> Self {
        let path = path.into();
        let stem = path.file_stem().map_or("scene".into(), |stem| stem.to_string_lossy().into_owned());
        // The name is printed, so it must not control a terminal.
        let name =
            path.display().to_string().chars().map(|c| if is_display_control(c) { '\u{fffd}' } else { c }).collect();
        let folder = path.parent().map(Path::to_owned).unwrap_or_default();
        Self { content: SceneContent::File(path), name, stem, folder }
    }

    /// The text of a scene file, in UTF-8. `name` stands for the file in messages; `stem` is the
    /// title of a scene that has none, and names the default folder for results and saved contact
    /// problems, so it should be a valid file name. The files that the scene names are relative to
    /// the working directory unless [`beside`](Self::beside) says otherwise.
    #[must_use]
    pub fn bytes(bytes: impl Into<Vec<u8>>, name: impl Into<String>, stem: impl Into<String>) -> Self {
        Self {
            content: SceneContent::Bytes(bytes.into()),
            name: name.into(),
            stem: stem.into(),
            folder: PathBuf::new(),
        }
    }

    /// The same scene with the files that it names relative to `folder`.
    #[must_use]
    pub fn beside(mut self, folder: impl Into<PathBuf>) -> Self {
        self.folder = folder.into();
        self
    }

    /// The scene's name in messages.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The stem of the names of its results.
    #[must_use]
    pub fn stem(&self) -> &str {
        &self.stem
    }

    /// The scene file, if it is one.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        match &self.content {
            SceneContent::File(path) => Some(path),
            SceneContent::Bytes(_) => None,
        }
    }

    /// The bytes of the scene. Of a file that is too large for a scene, only enough to detect that.
    ///
    /// # Errors
    /// If the file can't be read.
    pub fn read(&self) -> Result<Cow<'_, [u8]>, LoadError> {
        let path = match &self.content {
            SceneContent::Bytes(bytes) => return Ok(Cow::Borrowed(bytes)),
            SceneContent::File(path) => path,
        };
        let read = if path.is_dir() {
            Err(SceneFileError::Folder)
        } else {
            read_at_most(path, LARGEST_FILE).map_err(SceneFileError::from)
        };
        read.map(Cow::Owned).map_err(|error| LoadError::Unreadable { name: self.name.clone(), error })
    }

    /// Reads and resolves the scene with `sets`, overrides of keys by their paths; and the files
    /// that it names.
    ///
    /// # Errors
    /// If the file can't be read, or the scene has errors.
    pub fn load(&self, sets: &[(String, String)]) -> Result<Resolved, LoadError> {
        let bytes = self.read()?;
        teeter_scenario::load_with(&bytes, &self.name, &self.stem, sets, &mut self.companions()).map_err(|found| {
            // Findings about a file that is not text have no position.
            let text = std::str::from_utf8(&bytes).unwrap_or_default().to_owned();
            LoadError::Invalid { text, found }
        })
    }

    /// Reads the files that the scene names, for [`teeter_scenario::load_with`]. Of one that is too
    /// large, only enough bytes to detect that.
    pub fn companions(&self) -> impl FnMut(&str) -> Result<Vec<u8>, String> + use<> {
        let folder = self.folder.clone();
        move |file| read_regular(&folder.join(file), LARGEST_RECORD)
    }

    /// The path of a file that the scene names.
    #[must_use]
    pub fn place(&self, file: &str) -> PathBuf {
        self.folder.join(file)
    }

    /// The files from which the scene is read: its own, if it is a file, and those that it names.
    #[must_use]
    pub fn inputs(&self, resolved: &Resolved) -> Vec<PathBuf> {
        let named = resolved.files.iter().map(|(file, _)| self.place(file));
        self.path().map(Path::to_owned).into_iter().chain(named).collect()
    }

    /// The path of a file that the scene names, relative to `folder` and with `/` between its
    /// parts, for a copy of the scene in that folder. If `folder` doesn't exist, or there is no
    /// relative path, it is that of [`place`](Self::place).
    #[must_use]
    pub fn seen_from(&self, folder: &Path, file: &str) -> String {
        if Path::new(file).is_absolute() {
            return file.to_owned();
        }
        let path = self.place(file);
        let (Ok(from), Ok(to)) = (folder.canonicalize(), path.canonicalize()) else {
            return path.display().to_string();
        };
        let (from, to): (Vec<Component<'_>>, Vec<Component<'_>>) =
            (from.components().collect(), to.components().collect());
        let common = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
        if common == 0 {
            return path.display().to_string();
        }
        let up = std::iter::repeat_n("..".to_owned(), from.len() - common);
        let down = to[common..].iter().map(|part| part.as_os_str().to_string_lossy().into_owned());
        up.chain(down).collect::<Vec<_>>().join("/")
    }
}

/// The contents of a regular file, or `most` + 1 bytes of a larger one.
///
/// # Errors
/// Why it can't be read, in words for the user. Pipes and devices are refused: a pipe could block, and
/// a device has no end.
pub fn read_regular(path: &Path, most: usize) -> Result<Vec<u8>, String> {
    match std::fs::metadata(path) {
        Ok(found) if found.is_dir() => return Err("is a folder, not a file".to_owned()),
        Ok(found) if !found.is_file() => return Err("is a pipe or a device: give a regular file".to_owned()),
        _ => {}
    }
    read_at_most(path, most).map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => "there is no such file".to_owned(),
        io::ErrorKind::PermissionDenied => "no permission to read it".to_owned(),
        _ => format!("can't be read: {error}"),
    })
}

/// The contents of a file, or `most` + 1 bytes of a larger one.
fn read_at_most(path: &Path, most: usize) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(most as u64 + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_named_by_its_path_and_its_results_by_its_stem() {
        let source = SceneSource::file("scenes/a\u{1b}b.toml");
        assert_eq!((source.name(), source.stem()), ("scenes/a\u{fffd}b.toml", "a\u{1b}b"));
        assert_eq!(source.place("records/quake.csv"), Path::new("scenes/records/quake.csv"));
        assert_eq!(SceneSource::file("..").stem(), "scene");
        let text = SceneSource::bytes("", "text", "text");
        assert_eq!((text.place("quake.csv"), text.path()), (PathBuf::from("quake.csv"), None));
        assert_eq!(text.beside("records").place("quake.csv"), Path::new("records/quake.csv"));
    }

    #[test]
    fn what_cant_be_read_is_an_error_of_its_kind() {
        let error = |path: &Path| match SceneSource::file(path).read() {
            Err(LoadError::Unreadable { error, .. }) => error,
            other => panic!("{other:?}"),
        };
        assert!(matches!(error(Path::new("/nowhere/at/all.toml")), SceneFileError::Missing));
        assert!(matches!(error(&std::env::temp_dir()), SceneFileError::Folder));
        let mut companions = SceneSource::bytes("", "text", "text").beside("/nowhere").companions();
        assert_eq!(companions("quake.csv").unwrap_err(), "there is no such file");
    }

    #[test]
    fn a_file_is_seen_from_another_folder() {
        let at = std::env::temp_dir().join(format!("teeter-seen-from-{}", std::process::id()));
        for folder in ["scenes/records", "deep/out"] {
            std::fs::create_dir_all(at.join(folder)).unwrap();
        }
        std::fs::write(at.join("scenes/records/quake.csv"), "t,a\n").unwrap();
        let source = SceneSource::file(at.join("scenes/scene.toml"));
        let seen = source.seen_from(&at.join("deep/out"), "records/quake.csv");
        assert_eq!(seen, "../../scenes/records/quake.csv");
        let place = source.place("records/quake.csv").display().to_string();
        assert_eq!(source.seen_from(&at.join("nowhere"), "records/quake.csv"), place);
        assert_eq!(source.seen_from(&at, &place), place, "an absolute path stays");
        std::fs::remove_dir_all(at).unwrap();
    }
}
