//! The files that a scene names: relative to the scene's own, or to the working directory for a scene from standard input.

use std::io::Read;
use std::path::{Component, Path, PathBuf};
use teeter_scenario::record::LARGEST_RECORD;

/// Reads such files for a scene; of one that is too large no more than shows that.
pub(crate) fn reader(scene: &Path) -> impl FnMut(&str) -> Result<Vec<u8>, String> + use<> {
    let folder = folder_of(scene);
    move |file| {
        let path = folder.join(file);
        // A pipe would be waited for without end, and a device is read without end.
        match std::fs::metadata(&path) {
            Ok(found) if found.is_dir() => return Err("is a folder, not a file".to_owned()),
            Ok(found) if !found.is_file() => {
                return Err("is no regular file, but a pipe or a device: give a file that stays on disk".to_owned());
            }
            _ => {}
        }
        let mut bytes = Vec::new();
        let most = LARGEST_RECORD as u64 + 1;
        let read = std::fs::File::open(path).and_then(|file| file.take(most).read_to_end(&mut bytes));
        read.map(|_| bytes).map_err(|error| match error.kind() {
            std::io::ErrorKind::NotFound => "there is no such file".to_owned(),
            std::io::ErrorKind::PermissionDenied => "no permission to read it".to_owned(),
            _ => format!("can't be read: {error}"),
        })
    }
}

/// Where a file that a scene names is.
pub(crate) fn place(scene: &Path, file: &str) -> PathBuf {
    folder_of(scene).join(file)
}

fn folder_of(scene: &Path) -> PathBuf {
    match scene.parent() {
        Some(parent) if scene != Path::new("-") => parent.to_owned(),
        _ => PathBuf::new(),
    }
}

/// The path of a file that a scene names, as seen from `folder`, which is there; with `/` between its parts.
pub(crate) fn seen_from(folder: &Path, scene: &Path, file: &str) -> String {
    let path = folder_of(scene).join(file);
    if Path::new(file).is_absolute() {
        return file.to_owned();
    }
    // Both are there: the file was read, the folder made.
    let (Ok(from), Ok(to)) = (folder.canonicalize(), path.canonicalize()) else { return path.display().to_string() };
    let (from, to): (Vec<Component<'_>>, Vec<Component<'_>>) = (from.components().collect(), to.components().collect());
    let common = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    if common == 0 {
        return path.display().to_string();
    }
    let up = std::iter::repeat_n("..".to_owned(), from.len() - common);
    let down = to[common..].iter().map(|part| part.as_os_str().to_string_lossy().into_owned());
    up.chain(down).collect::<Vec<_>>().join("/")
}
