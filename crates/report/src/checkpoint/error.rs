//! Why a checkpoint or state can't be used.

use super::VERSION;
use std::io;
use std::path::PathBuf;

/// Why a checkpoint or state can't be used. Nothing has been changed then.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CheckpointError {
    /// A file that can't be read.
    #[error("can't read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// Another kind of file.
    #[error("{} is not a {wanted} of teeter", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// What it should be.
        wanted: &'static str,
    },
    /// A file of another version of the format.
    #[error(
        "{} is of version {found} of the format, but this program reads version {VERSION}; use the program that wrote it",
        path.display()
    )]
    Version {
        /// The file.
        path: PathBuf,
        /// Its version.
        found: u32,
    },
    /// A file that isn't as it was written.
    #[error("{} is damaged: {what}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
    /// A checkpoint of another program.
    #[error(
        "{} was written by another program file ({then}…, this is {now}…): its steps could differ in the last digit; \
         resume with that program",
        path.display()
    )]
    Program {
        /// The checkpoint.
        path: PathBuf,
        /// First digits of the hash of the program that wrote it.
        then: String,
        /// The same of the one that runs.
        now: String,
    },
    /// A checkpoint or results of another scene.
    #[error("{} is of another scene: {difference}; resume with the scene and the --set of that run", path.display())]
    Scene {
        /// The checkpoint, or the scene of the results.
        path: PathBuf,
        /// The first difference.
        difference: String,
    },
    /// A checkpoint of a run with other options.
    #[error(
        "{} is of a run with other options ({}, now {}); resume with those of that run",
        path.display(), none_if_empty(then), none_if_empty(now)
    )]
    Options {
        /// The checkpoint.
        path: PathBuf,
        /// Those of its run.
        then: String,
        /// Those given.
        now: String,
    },
    /// A table that isn't that of the checkpoint.
    #[error(
        "{} holds {found} bytes, but {wanted} when the checkpoint was written: it was changed or lost since",
        path.display()
    )]
    Table {
        /// The table.
        path: PathBuf,
        /// Its length.
        found: u64,
        /// Its length at the checkpoint.
        wanted: u64,
    },
    /// Results that nobody knows the scene of.
    #[error("{} holds results, but neither {} nor scene.toml: of which run, can't be known", .0.display(), super::CHECKPOINT)]
    Unknown(PathBuf),
    /// A state of other bodies.
    #[error("{} is a state of {found}, but the scene has {wanted}", path.display())]
    Bodies {
        /// The file.
        path: PathBuf,
        /// Its bodies.
        found: String,
        /// Those of the scene.
        wanted: String,
    },
    /// A step that doesn't reach the state's time.
    #[error(
        "{} is a state at t = {t} s, which is no whole number of steps of {dt} s; take a time.step that divides it, such as {} s",
        path.display(), .good
    )]
    Step {
        /// The file.
        path: PathBuf,
        /// Its time, s.
        t: f64,
        /// The scene's step, s.
        dt: f64,
        /// A step near the scene's that would do, s.
        good: f64,
    },
    /// A run that ends before it starts.
    #[error("{} is a state at t = {t} s, and the run is to end at time.end = {end} s; the clock goes on, so give a later end", path.display())]
    End {
        /// The file.
        path: PathBuf,
        /// Its time, s.
        t: f64,
        /// The scene's end, s.
        end: f64,
    },
    /// A state that the model doesn't take.
    #[error("{}: {source}", path.display())]
    State {
        /// The file.
        path: PathBuf,
        /// Why.
        source: teeter_integrator::StateError,
    },
}

fn none_if_empty(options: &str) -> &str {
    if options.is_empty() { "none" } else { options }
}
