//! Who wrote a checkpoint, for which scene: what must be the same for a run to go on to the same bytes.

use super::CheckpointError;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::io;
use std::path::Path;

/// A program, a scene and the options that decide which files a run writes and what stands in them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    program: [u8; 32],
    scene: [u8; 32],
    /// The scene: with it a mismatch can be named.
    text: String,
    options: String,
}

impl Identity {
    /// The identity of a run by the program of hash `program` ([`program_hash`]) of the scene `text`; `files` are the
    /// contents of the files that it refers to, in an order that depends on the scene alone; `options` are those that decide results, as text.
    #[must_use]
    pub fn new(program: [u8; 32], text: &str, files: &[&[u8]], options: &str) -> Self {
        let scene = content_hash(std::iter::once(text.as_bytes()).chain(files.iter().copied()));
        Self { program, scene, text: text.to_owned(), options: options.to_owned() }
    }

    /// Refuses a checkpoint of identity `then`, from the file `path`, that isn't this run's.
    pub(super) fn admit(&self, then: &Self, path: &Path) -> Result<(), CheckpointError> {
        let path = || path.to_owned();
        if then.scene != self.scene {
            return Err(CheckpointError::Scene { path: path(), difference: difference(&then.text, &self.text) });
        }
        if then.options != self.options {
            return Err(CheckpointError::Options {
                path: path(),
                then: then.options.clone(),
                now: self.options.clone(),
            });
        }
        if then.program != self.program {
            let digits = |hash: [u8; 32]| hash[..4].iter().map(|byte| format!("{byte:02x}")).collect();
            return Err(CheckpointError::Program {
                path: path(),
                then: digits(then.program),
                now: digits(self.program),
            });
        }
        Ok(())
    }
}

/// SHA-256 of the contents of a list of files.
#[must_use]
pub fn content_hash<'a>(files: impl IntoIterator<Item = &'a [u8]>) -> [u8; 32] {
    let mut hash = Sha256::new();
    for file in files {
        // With its length, so that no two lists of files have the same bytes.
        hash.update((file.len() as u64).to_le_bytes());
        hash.update(file);
    }
    hash.finalize().into()
}

/// SHA-256 of the file of the running program.
///
/// # Errors
/// If the file can't be found or read.
pub fn program_hash() -> io::Result<[u8; 32]> {
    // On Linux this is the file that runs, even if another one has taken its name since.
    let running = Path::new("/proc/self/exe");
    let path = if running.exists() { running.to_owned() } else { std::env::current_exe()? };
    let mut hash = Sha256::new();
    let mut file = std::fs::File::open(path)?;
    let mut buffer = vec![0; 1 << 16];
    loop {
        match io::Read::read(&mut file, &mut buffer) {
            Ok(0) => return Ok(hash.finalize().into()),
            Ok(n) => hash.update(&buffer[..n]),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}

/// The first line in which two scenes as run differ, with its table.
pub(super) fn difference<'a>(then: &'a str, now: &'a str) -> String {
    // A blank line says nothing; one stands before each table.
    let written = |text: &'a str| text.lines().filter(|line| !line.is_empty());
    let (mut then, mut now) = (written(then), written(now));
    let mut table = "";
    loop {
        let (old, new) = match (then.next(), now.next()) {
            (None, None) => return "a file that it refers to has changed".to_owned(),
            (old, new) if old == new => {
                table = new.filter(|line| line.starts_with('[')).unwrap_or(table);
                continue;
            }
            pair => pair,
        };
        let shown = |line: Option<&str>| match line {
            None => "nothing more".to_owned(),
            Some(line) => format!("`{line}`"),
        };
        // A table that is there or here only, or has another name, is in none.
        let is_header = |line: Option<&str>| line.is_some_and(|line| line.starts_with('['));
        let outside = table.is_empty() || is_header(old) || is_header(new);
        let place = if outside { String::new() } else { format!(" in {table}") };
        return format!("{} there, {} here{place}", shown(old), shown(new));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mismatch_is_named() {
        let run = |program: u8, scene: &str, file: &[u8], options: &str| {
            Identity::new([program; 32], scene, &[file], options)
        };
        let here = run(1, "title = \"a\"\n\n[time]\nstep = 2\n", b"1,2", "x");
        let refused = |other: &Identity| here.admit(other, Path::new("c")).unwrap_err().to_string();
        assert!(here.admit(&here.clone(), Path::new("c")).is_ok());
        let step = refused(&run(1, "title = \"a\"\n\n[time]\nstep = 1\n", b"1,2", "x"));
        assert!(step.contains("`step = 1` there, `step = 2` here in [time]"), "{step}");
        // A block of another name is not in the table before it.
        let named = |name: &str| format!("[beam.table]\nspan = 1\n\n[block.{name}]\nat = 2\n");
        let renamed = difference(&named("a"), &named("b"));
        assert_eq!(renamed, "`[block.a]` there, `[block.b]` here");
        let more = difference("[beam.table]\nspan = 1\n", &named("b"));
        assert_eq!(more, "nothing more there, `[block.b]` here");
        assert!(difference("[time]\n\n[world]\n", "[time]\nstep = 2\n").ends_with("`[world]` there, `step = 2` here"));
        let text = here.text.as_str();
        assert!(refused(&run(1, text, b"1,3", "x")).contains("a file that it refers to"));
        assert!(refused(&run(1, text, b"1,2", "")).contains("(none, now x)"));
        assert!(refused(&run(2, text, b"1,2", "x")).contains("another program"));
    }

    #[test]
    fn pieces_are_told_apart() {
        let of = |files: &[&[u8]]| Identity::new([0; 32], "", files, "");
        assert_ne!(of(&[b"ab", b"c"]), of(&[b"a", b"bc"]));
    }
}
