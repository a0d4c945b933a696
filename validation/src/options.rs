//! The command line.

use crate::case::Depth;
use std::path::PathBuf;

/// What `--help` says.
pub(crate) const HELP: &str = "\
teeter-validation: runs the cases with known answers

  --short      what fits into a continuous build; writes no files unless --out is given
  --out DIR    where validation.md and figures/ go (default: docs)
  --only CASE  this case alone; writes no files unless --out is given
  --help       this

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
}

/// What the command line asks for.
#[derive(Debug, PartialEq)]
pub(crate) enum Asked {
    /// To run.
    Run(Options),
    /// To be told how.
    Help,
}

/// Reads the arguments after the program's name.
pub(crate) fn parse(mut arguments: impl Iterator<Item = String>) -> Result<Asked, String> {
    let mut depth = Depth::Full;
    let (mut out, mut only) = (None, None);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--help" | "-h" => return Ok(Asked::Help),
            "--short" => depth = Depth::Short,
            "--only" => only = Some(arguments.next().ok_or("--only needs the name of a case")?),
            "--out" => out = Some(PathBuf::from(arguments.next().ok_or("--out needs a folder")?)),
            other => return Err(format!("unknown argument {other:?}")),
        }
    }
    // The kept page is that of a full run: a part of one must not replace it unasked.
    if out.is_none() && only.is_none() && depth == Depth::Full {
        out = Some(PathBuf::from("docs"));
    }
    Ok(Asked::Run(Options { depth, only, out }))
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
            Ok(Asked::Run(Options { depth, only: only.map(str::to_owned), out: out.map(PathBuf::from) }))
        };
        assert_eq!(asked(""), run(Depth::Full, None, Some("docs")));
        assert_eq!(asked("--short"), run(Depth::Short, None, None));
        assert_eq!(asked("--out a --short"), run(Depth::Short, None, Some("a")));
        assert_eq!(asked("--only b"), run(Depth::Full, Some("b"), None));
    }

    #[test]
    fn wrong_arguments_are_named() {
        assert!(asked("--sort").is_err_and(|error| error.contains("--sort")));
        assert!(asked("--out").is_err() && asked("--only").is_err());
    }
}
