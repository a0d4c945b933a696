//! Files that a sweep names by patterns.

use std::path::{Component, Path, PathBuf};
use teeter_scenario::matches_pattern;

/// Lists the files below `folder` that match `pattern`, sorted by name, as paths relative to
/// `scene_folder`. In the last part of the pattern a `*` stands for any characters and a `?` for
/// one; without them the file itself must be there.
///
/// # Errors
/// Why there is no such file.
pub fn matching_files(folder: &Path, scene_folder: &Path, pattern: &str) -> Result<Vec<String>, String> {
    let path = folder.join(pattern);
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let parent = path.parent().unwrap_or(folder).to_owned();
    if parent.to_string_lossy().contains(['*', '?']) {
        return Err("only the last part of a pattern can have a * or ?".to_owned());
    }
    let seen = |found: &Path| seen_from(scene_folder, found);
    if !name.contains(['*', '?']) {
        return if path.is_file() { Ok(vec![seen(&path)]) } else { Err("there is no such file".to_owned()) };
    }
    let entries =
        std::fs::read_dir(here(&parent)).map_err(|error| format!("{} can't be read: {error}", parent.display()))?;
    let mut found: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.is_file())
        .filter(|path| path.file_name().is_some_and(|file| matches_pattern(&name, &file.to_string_lossy())))
        .collect();
    found.sort();
    if found.is_empty() {
        return Err("no file matches".to_owned());
    }
    Ok(found.iter().map(|path| seen(path)).collect())
}

/// A folder; the working directory for an empty path.
fn here(folder: &Path) -> &Path {
    if folder.as_os_str().is_empty() { Path::new(".") } else { folder }
}

/// A path relative to a folder, with `/` between its parts; as it is if there is none.
fn seen_from(folder: &Path, path: &Path) -> String {
    let (Ok(from), Ok(to)) = (here(folder).canonicalize(), path.canonicalize()) else {
        return path.to_string_lossy().into_owned();
    };
    let (from, to): (Vec<Component<'_>>, Vec<Component<'_>>) = (from.components().collect(), to.components().collect());
    let same = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let up = std::iter::repeat_n("..".to_owned(), from.len() - same);
    let down = to[same..].iter().map(|part| part.as_os_str().to_string_lossy().into_owned());
    up.chain(down).collect::<Vec<_>>().join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_seen_from_the_scene() {
        let folder = std::env::temp_dir().join(format!("teeter-listing-{}", std::process::id()));
        std::fs::create_dir_all(folder.join("records")).unwrap();
        std::fs::create_dir_all(folder.join("scenes")).unwrap();
        for name in ["b.csv", "a.csv", "c.txt"] {
            std::fs::write(folder.join("records").join(name), "").unwrap();
        }
        let list = |pattern: &str| matching_files(&folder, &folder.join("scenes"), pattern);
        assert_eq!(list("records/*.csv"), Ok(vec!["../records/a.csv".to_owned(), "../records/b.csv".to_owned()]));
        assert_eq!(list("records/c.txt"), Ok(vec!["../records/c.txt".to_owned()]));
        assert_eq!(list("records/*.AT2"), Err("no file matches".to_owned()));
        assert_eq!(list("records/d.txt"), Err("there is no such file".to_owned()));
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
