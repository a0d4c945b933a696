//! The command line.

use crate::case::Depth;
use std::path::PathBuf;

/// What `--help` says.
pub(crate) const HELP: &str = "\
teeter-validation: runs the cases with known answers

  --short      a short run for continuous integration; writes no files unless --out is given
  --out DIR    folder for validation.md and figures/ (default: docs)
  --only CASE  runs only this case (with --extremes: this family); writes no files unless --out is given
  --extremes   runs the extreme scenes instead and writes extremes.md
  --write-bounds  with --extremes: stores the results as new bounds
  --scene ROW  prints the scene of a row of extremes.md
  --help       prints this help

Exit code: 0 if every bound holds, 1 if one is missed, 2 for a wrong command line.
";

/// How to run.
#[derive(Debug, PartialEq)]
pub(crate) struct Options {
    /// How much.
    pub(crate) depth: Depth,
    /// The name of the only case to run; `None` runs all.
    pub(crate) only: Option<String>,
    /// Where files go; `None` writes none.
    pub(crate) out: Option<PathBuf>,
    /// Whether to run the extremes, not the cases.
    pub(crate) extremes: bool,
    /// Whether to store the bounds of the extremes' rows anew.
    pub(crate) write_bounds: bool,
}

/// What the command line asks for.
#[derive(Debug, PartialEq)]
pub(crate) enum Asked {
    /// A run.
    Run(Options),
    /// Help.
    Help,
    /// The scene of a row of the extremes.
    Scene(String),
}

/// Reads the arguments after the program's name.
pub(crate) fn parse(mut arguments: impl Iterator<Item = String>) -> Result<Asked, String> {
    let mut depth = Depth::Full;
    let (mut out, mut only) = (None, None);
    let (mut extremes, mut write_bounds) = (false, false);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--help" | "-h" => return Ok(Asked::Help),
            "--short" => depth = Depth::Short,
            "--only" => only = Some(arguments.next().ok_or("--only needs the name of a case")?),
            "--extremes" => extremes = true,
            "--write-bounds" => write_bounds = true,
            "--scene" => return Ok(Asked::Scene(arguments.next().ok_or("--scene needs the name of a row")?)),
            "--out" => out = Some(PathBuf::from(arguments.next().ok_or("--out needs a folder")?)),
            other => return Err(format!("unknown argument {other:?}")),
        }
    }
    if write_bounds && !(extremes && depth == Depth::Full && only.is_none()) {
        return Err("--write-bounds goes with --extremes, all of them".to_owned());
    }
    // The kept page is that of a full run: a part of one must not replace it unasked.
    if out.is_none() && only.is_none() && depth == Depth::Full {
        out = Some(PathBuf::from("docs"));
    }
    Ok(Asked::Run(Options { depth, only, out, extremes, write_bounds }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(line: &str) -> Result<Asked, String> {
        parse(line.split_whitespace().map(str::to_owned))
    }

    #[test]
    fn a_short_run_does_not_replace_the_kept_page() {
        let run = |depth, only: Option<&str>, out: Option<&str>| {
            let (only, out) = (only.map(str::to_owned), out.map(PathBuf::from));
            Ok(Asked::Run(Options { depth, only, out, extremes: false, write_bounds: false }))
        };
        assert_eq!(asked(""), run(Depth::Full, None, Some("docs")));
        assert_eq!(asked("--short"), run(Depth::Short, None, None));
        assert_eq!(asked("--out a --short"), run(Depth::Short, None, Some("a")));
        assert_eq!(asked("--only b"), run(Depth::Full, Some("b"), None));
    }

    #[test]
    fn wrong_arguments_are_named() {
        assert!(asked("--sort").is_err_and(|error| error.contains("--sort")));
        assert!(asked("--out").is_err() && asked("--only").is_err() && asked("--scene").is_err());
        assert!(asked("--write-bounds").is_err() && asked("--extremes --short --write-bounds").is_err());
    }
}
