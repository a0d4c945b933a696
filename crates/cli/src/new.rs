//! `teeter new`: commented scenes to start from.

use crate::console::{Console, print_all};
use crate::run::Exit;
use std::fs::File;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use teeter_report::{ResultsError, write_whole};
use teeter_scenario::suggest::nearest;

/// The scenes by name.
const SCENES: [(&str, &str); 23] = [
    ("column-of-drums", include_str!("../scenes/column-of-drums.toml")),
    ("compliant-drop", include_str!("../scenes/compliant-drop.toml")),
    ("domino", include_str!("../scenes/domino.toml")),
    ("drop", include_str!("../scenes/drop.toml")),
    ("dry-stone-wall", include_str!("../scenes/dry-stone-wall.toml")),
    ("free-rocking-on-beam", include_str!("../scenes/free-rocking-on-beam.toml")),
    ("free-rocking-on-beam-undeformed-start", include_str!("../scenes/free-rocking-on-beam-undeformed-start.toml")),
    ("free-rocking-on-ground", include_str!("../scenes/free-rocking-on-ground.toml")),
    ("held-beam", include_str!("../scenes/held-beam.toml")),
    ("incline", include_str!("../scenes/incline.toml")),
    ("lintel", include_str!("../scenes/lintel.toml")),
    ("masonry-arch", include_str!("../scenes/masonry-arch.toml")),
    ("newtons-cradle", include_str!("../scenes/newtons-cradle.toml")),
    ("overhang", include_str!("../scenes/overhang.toml")),
    ("pile-of-polygons", include_str!("../scenes/pile-of-polygons.toml")),
    ("pile-of-stones", include_str!("../scenes/pile-of-stones.toml")),
    ("pushed-block", include_str!("../scenes/pushed-block.toml")),
    ("rocking-under-earthquake", include_str!("../scenes/rocking-under-earthquake.toml")),
    ("shaken-ground", include_str!("../scenes/shaken-ground.toml")),
    ("sliding", include_str!("../scenes/sliding.toml")),
    ("stack-of-blocks", include_str!("../scenes/stack-of-blocks.toml")),
    ("two-blocks-on-beam", include_str!("../scenes/two-blocks-on-beam.toml")),
    ("two-span-beam", include_str!("../scenes/two-span-beam.toml")),
];

/// The tables that a scene names: the scene, the file, what it holds. It is written beside the scene.
const TABLES: [(&str, &str, &str); 1] = [(
    "rocking-under-earthquake",
    "rocking-under-earthquake.csv",
    include_str!("../scenes/rocking-under-earthquake.csv"),
)];

/// The scene written if none is chosen.
pub(crate) const DEFAULT: &str = "free-rocking-on-beam";

#[derive(Debug)]
pub(crate) struct Options {
    /// The file to write; `-`: standard output.
    pub(crate) file: Option<PathBuf>,
    pub(crate) from: String,
    pub(crate) list: bool,
    pub(crate) force: bool,
}

pub(crate) fn new(options: &Options) -> Exit {
    let console = Console::new(false);
    if options.list {
        return print_all(&list());
    }
    let bad_input = |text: String| {
        console.error(&text);
        Exit::BadInput
    };
    let Some((name, scene)) = SCENES.iter().find(|(name, _)| *name == options.from) else {
        let near = nearest(&options.from, SCENES.iter().map(|(name, _)| *name));
        let near = near.map(|near| format!("; did you mean `{near}`?")).unwrap_or_default();
        return bad_input(format!("error: no scene `{}`{near}\n  help: `teeter new --list` lists them", options.from));
    };
    let Some(file) = &options.file else {
        return bad_input("error: which file? Write teeter new FILE.toml, or - for standard output".to_owned());
    };
    let table = TABLES.iter().find(|(of, _, _)| of == name).map(|(_, file, text)| (*file, *text));
    if file == Path::new("-") {
        return match table {
            Some((table, _)) => bad_input(format!(
                "error: `{name}` needs its table, {table}, beside it\n  help: write both to a folder: teeter new {name}.toml --from {name}"
            )),
            None => print_all(scene),
        };
    }
    // The table first: what a scene names is there as soon as the scene is.
    let table = table.map(|(table, text)| (file.with_file_name(table), text));
    let files = table.iter().map(|(path, text)| (path.as_path(), *text)).chain([(file.as_path(), *scene)]);
    for (path, text) in files {
        match write(path, text, options.force) {
            Ok(()) => {}
            // As it would be written: perhaps by this command, for another copy of the scene.
            Err(error) if error.kind() == ErrorKind::AlreadyExists && path != file && holds(path, text) => {}
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {
                return bad_input(format!("error: {} exists already; --force replaces it", path.display()));
            }
            Err(error) => return bad_input(format!("error: can't write {}: {error}", path.display())),
        }
    }
    let beside = table.map(|(path, _)| format!(", with its table {}", path.display())).unwrap_or_default();
    let file = file.display();
    console.note(&format!("{file}: a copy of {name}{beside}; next: teeter check {file}, teeter run {file}"));
    Exit::FinishedRun
}

/// Whether a file holds a text.
fn holds(path: &Path, text: &str) -> bool {
    std::fs::read(path).is_ok_and(|bytes| bytes == text.as_bytes())
}

/// Writes a file; one that exists stays unless it may be replaced.
fn write(path: &Path, text: &str, force: bool) -> std::io::Result<()> {
    // A link is there, too, wherever it leads.
    if force && std::fs::symlink_metadata(path).is_ok() {
        // Whole or not at all: a full disk must not take the scene that was there.
        return write_whole(path, text.as_bytes()).map_err(|error| match error {
            ResultsError::Io { source, .. } => source,
            error => std::io::Error::other(error),
        });
    }
    let mut file = File::create_new(path)?;
    file.write_all(text.as_bytes())?;
    file.sync_all()
}

/// Names and titles.
fn list() -> String {
    let widest = SCENES.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let line = |(name, scene): &(&str, &str)| format!("{name:widest$}  {}\n", title(scene));
    SCENES.iter().map(line).collect()
}

fn title(scene: &str) -> &str {
    let line = scene.lines().find(|line| line.starts_with("title")).unwrap_or_default();
    line.split('"').nth(1).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn every_scene_has_a_title_and_needs_no_other_file_than_its_table() {
        for (name, scene) in SCENES {
            assert!(!title(scene).is_empty(), "{name}");
            if TABLES.iter().any(|(of, table, _)| *of == name && scene.contains(table)) {
                continue;
            }
            let loaded = teeter_scenario::load(scene.as_bytes(), name, name, &[]);
            assert!(loaded.is_ok(), "{name}: {}", loaded.unwrap_err());
        }
        assert!(SCENES.iter().any(|(name, _)| *name == DEFAULT));
    }
}
