//! The command line: commands, their options and help.

#[cfg(feature = "animation")]
use crate::animate;
use crate::{measured, new, record, run, schema, solve};
use clap::{Parser, Subcommand};
use std::path::PathBuf;
use std::time::Duration;
use teeter_run::{ExportWhen, Extent};

/// Simulates rigid blocks that rock, slide and bounce on elastic beams and on rigid ground.
#[derive(Debug, Parser)]
#[command(name = "teeter", version, arg_required_else_help = true)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Simulate a scene and write its motion, contacts, energy and summary
    #[command(after_help = "Examples:\n  teeter run scenarios/free-rocking-on-beam.toml\n  \
        teeter run scene.toml --out results --set time.step=50us --set contact.feet.friction=0.3\n  \
        teeter run scene.toml --animate motion.gif --animate-speed 0.1\n  \
        teeter run scene.toml --checkpoint-every \"0.1 s\"            # survives a kill:\n  \
        teeter run scene.toml --checkpoint-every \"0.1 s\" --resume   # continues, to the same bytes")]
    Run {
        /// The scene file; `-` reads standard input
        scene: PathBuf,
        /// Folder of the files that the scene names (default: the scene file's own; of a scene from
        /// standard input, the working directory)
        #[arg(long, value_name = "DIR")]
        base: Option<PathBuf>,
        /// Folder for the results (default: `runs/` with the name of the scene file)
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Override a key of the scene, such as beam.table.thickness="2 mm"; may be repeated
        #[arg(long = "set", value_name = "KEY=VALUE", value_parser = key_value)]
        set: Vec<(String, String)>,
        /// Find the longest step that reaches this accuracy; the scene must have `step = "auto"` or
        /// none, as with --set time.step=auto
        #[arg(long, value_name = "X", allow_hyphen_values = true)]
        accuracy: Option<String>,
        /// Find up to when the motion is predictable, by runs with half the step and with an
        /// initial state perturbed by 1e-12
        #[arg(long, conflicts_with = "from")]
        horizon: bool,
        /// Print only errors
        #[arg(long)]
        quiet: bool,
        /// Write the tables and the summary only, no report and no figures
        #[arg(long)]
        no_report: bool,
        /// Replace results of an earlier run
        #[arg(long)]
        force: bool,
        /// Save contact problems of the run to DIR, as FCLIB files (HDF5) named by step;
        /// `teeter solve DIR` solves them
        #[arg(long, value_name = "DIR")]
        export_problems: Option<PathBuf>,
        /// Which problems: `hard` (over ten times the median number of iterations, solved by a
        /// fallback, or not solved) or every:N steps
        #[arg(long, value_name = "hard|every:N", default_value = "hard", value_parser = run::export_when)]
        #[arg(requires = "export_problems")]
        export_when: ExportWhen,
        /// Write a checkpoint at this interval of simulated time, with its unit, and one at Ctrl-C
        #[arg(long, value_name = "T", value_parser = run::interval)]
        checkpoint_every: Option<f64>,
        /// Continue from the checkpoint in the folder for results; without one, start at the
        /// beginning
        #[arg(long, conflicts_with = "force")]
        resume: bool,
        /// `full`: model everything in the scene, including what can't affect the motion and is
        /// otherwise left out; `teeter check` lists that
        #[arg(long, value_name = "required|full", default_value = "required", value_parser = run::extent)]
        model: Extent,
        /// Start from a state or checkpoint of a run with the same bodies; its clock continues, up
        /// to time.end; uses the full model
        #[arg(long, value_name = "FILE")]
        from: Option<PathBuf>,
        /// Write the state before the first step whose contact problem is not solved to FILE, for
        /// --from
        #[arg(long, value_name = "FILE")]
        dump_unconverged: Option<PathBuf>,
        /// Also write pictures for ParaView, in the subfolder `vtk`: blocks, beams, contact forces, at
        /// the interval of the tables
        #[arg(long, conflicts_with = "resume")]
        vtk: bool,
        #[cfg(feature = "animation")]
        #[command(flatten)]
        animate: animate::Animate,
        /// Threads that share the contacts of bodies that stand apart; the results are the same to the
        /// last byte (default: as many as there are cores)
        #[cfg(feature = "parallel")]
        #[arg(long, value_name = "N")]
        threads: Option<std::num::NonZeroUsize>,
        /// Run again whenever the scene or a file that it names changes, until Ctrl-C
        #[arg(long, conflicts_with_all = ["resume", "dump_unconverged"])]
        watch: bool,
    },
    /// Write a commented scene to start from
    #[command(after_help = "Examples:\n  teeter new --list\n  teeter new arch.toml --from masonry-arch\n  \
        teeter new - --from drop | teeter run -")]
    New {
        /// The file to write; `-` writes to standard output
        #[arg(value_name = "FILE.toml", required_unless_present = "list")]
        file: Option<PathBuf>,
        /// Which scene
        #[arg(long, value_name = "SCENARIO", default_value = new::DEFAULT)]
        from: String,
        /// List the scenes
        #[arg(long)]
        list: bool,
        /// Replace the file
        #[arg(long)]
        force: bool,
    },
    /// Show what a run of a scene models, costs and writes, and what looks wrong; run nothing
    #[command(after_help = "Examples:\n  teeter check scenarios/free-rocking-on-beam.toml\n  \
        teeter check scene.toml --set time.step=50us")]
    Check {
        /// The scene file; `-` reads standard input
        scene: PathBuf,
        /// Folder of the files that the scene names (default: the scene file's own; of a scene from
        /// standard input, the working directory)
        #[arg(long, value_name = "DIR")]
        base: Option<PathBuf>,
        /// Override a key of the scene, such as beam.table.thickness="2 mm"; may be repeated
        #[arg(long = "set", value_name = "KEY=VALUE", value_parser = key_value)]
        set: Vec<(String, String)>,
        /// `full`: model everything in the scene, including what can't affect the motion and is
        /// otherwise left out; `teeter check` lists that
        #[arg(long, value_name = "required|full", default_value = "required", value_parser = run::extent)]
        model: Extent,
    },
    /// Measure what accuracy costs in a scene: errors and CPU time over schemes, steps, meshes and
    /// solvers; recommends settings
    #[command(after_help = "Examples:\n  teeter tradeoff scenarios/free-rocking-on-beam.toml\n  \
        teeter tradeoff scene.toml --out trade --set time.end=200ms")]
    Tradeoff {
        /// The scene file; `-` reads standard input
        scene: PathBuf,
        /// Folder of the files that the scene names (default: the scene file's own; of a scene from
        /// standard input, the working directory)
        #[arg(long, value_name = "DIR")]
        base: Option<PathBuf>,
        /// Folder for the results (default: `runs/` with the name of the scene file and
        /// `-tradeoff`)
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Override a key of the scene, such as beam.table.thickness="2 mm"; may be repeated
        #[arg(long = "set", value_name = "KEY=VALUE", value_parser = key_value)]
        set: Vec<(String, String)>,
        #[command(flatten)]
        figure_width: record::FigureWidth,
        /// Print only the advice and errors
        #[arg(long)]
        quiet: bool,
        /// Replace results of an earlier study
        #[arg(long)]
        force: bool,
    },
    /// Run a scene for many values of its keys; a table with a row for each case
    #[command(after_help = SWEEP_HELP, args_conflicts_with_subcommands = true, override_usage = SWEEP_USAGE)]
    Sweep {
        /// The sweep file: a scene, the keys that vary, and the numbers wanted
        #[arg(value_name = "SWEEP.toml", required_unless_present_any = ["merge", "compare"], conflicts_with = "merge")]
        sweep: Option<PathBuf>,
        /// Folder for the results (default: `runs/` with the name of the sweep file)
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Number of cases that run at once (default: one for each core)
        #[arg(long, value_name = "N", value_parser = count, allow_negative_numbers = true)]
        jobs: Option<u16>,
        /// Run only shard I of N, such as 2/8, for one of several machines
        #[arg(long, value_name = "I/N", allow_hyphen_values = true)]
        shard: Option<teeter_study::sweep::Shard>,
        /// Continue the study in the folder: run only the cases that have no row yet
        #[arg(long, conflicts_with = "force")]
        resume: bool,
        /// Put the results of all shards together into the folder given by --out
        #[arg(long, value_name = "DIR", num_args = 1.., requires = "out")]
        #[arg(conflicts_with_all = ["jobs", "shard", "resume"])]
        merge: Vec<PathBuf>,
        /// Put the figures of studies that have ended side by side, and test whether their
        /// distributions differ, into the folder given by --out
        #[arg(long, value_name = "DIR", num_args = 2.., requires = "out")]
        #[arg(conflicts_with_all = ["jobs", "shard", "resume", "merge", "sweep"])]
        compare: Vec<PathBuf>,
        #[command(flatten)]
        figure_width: record::FigureWidth,
        /// Print only errors
        #[arg(long)]
        quiet: bool,
        /// Replace results of an earlier study
        #[arg(long)]
        force: bool,
    },
    /// Show what an accelerogram holds: peaks, Arias intensity, significant duration, response
    /// spectrum
    #[command(after_help = RECORD_HELP)]
    Record {
        /// The record: PEER .AT2, ESM or COSMOS ASCII, or a table
        file: PathBuf,
        /// One of several accelerations of a table or a COSMOS file
        #[arg(long, value_name = "NAME")]
        component: Option<String>,
        /// Unit of the accelerations of a table whose heading has none, such as gal; m/s^2 if left
        /// out
        #[arg(long, value_name = "UNIT")]
        unit: Option<String>,
        /// Time between two values of a table without times, such as "10 ms"
        #[arg(long, value_name = "T", allow_hyphen_values = true)]
        step: Option<String>,
        /// Start of the part that is used
        #[arg(long, value_name = "T", allow_hyphen_values = true)]
        from: Option<String>,
        /// Its end
        #[arg(long, value_name = "T", allow_hyphen_values = true)]
        to: Option<String>,
        /// Polynomial that is subtracted: none, mean, linear, quadratic, cubic, quartic or quintic
        #[arg(long, value_name = "DEGREE")]
        baseline: Option<String>,
        /// Fraction of the duration over which each end is faded
        #[arg(long, value_name = "X", allow_hyphen_values = true)]
        taper: Option<String>,
        /// Factor of the acceleration
        #[arg(long, value_name = "X", allow_hyphen_values = true)]
        scale: Option<String>,
        /// Peak acceleration to which it is scaled, such as "0.4 gn"
        #[arg(long, value_name = "A", allow_hyphen_values = true)]
        peak: Option<String>,
        /// Peak velocity to which it is scaled, such as "0.3 m/s"
        #[arg(long, value_name = "V", allow_hyphen_values = true)]
        peak_velocity: Option<String>,
        /// Arias intensity to which it is scaled, such as "1.2 m/s"
        #[arg(long, value_name = "I", allow_hyphen_values = true)]
        arias: Option<String>,
        /// Spectral acceleration at --period, for 5 % damping, to which it is scaled
        #[arg(long, value_name = "A", allow_hyphen_values = true)]
        spectral_acceleration: Option<String>,
        /// Natural period of that spectral acceleration, such as "0.5 s"
        #[arg(long, value_name = "T", allow_hyphen_values = true)]
        period: Option<String>,
        /// Print a JSON object, with the whole spectrum and all digits
        #[arg(long)]
        json: bool,
        /// Width of the figures: 84 mm and 174 mm are one and two columns of most journals
        #[arg(long, value_name = "WIDTH", default_value = "120 mm", value_parser = record::figure_width, requires = "out")]
        figure_width: f64,
        /// Write a page, its figures, the motion over time and the numbers to DIR
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Replace results of an earlier call
        #[arg(long, requires = "out")]
        force: bool,
    },
    /// Compare a run with measured motion: aligned in time, errors, half-cycles, impacts, figures
    #[command(after_help = COMPARE_HELP)]
    Compare {
        /// The folder of a run
        #[arg(value_name = "RUN_DIR")]
        run: PathBuf,
        #[command(flatten)]
        measured: measured::MeasuredOptions,
        /// What the measured angle shows when the block stands upright, such as "0.2 deg"
        #[arg(long, value_name = "ANGLE", default_value = "0 rad", hide_default_value = true)]
        #[arg(value_parser = measured::offset, allow_hyphen_values = true)]
        offset: f64,
        /// Folder for the results (default: that of the run with `-compare`)
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        #[command(flatten)]
        figure_width: record::FigureWidth,
        /// Print only the results and errors
        #[arg(long)]
        quiet: bool,
        /// Replace results of an earlier comparison
        #[arg(long)]
        force: bool,
    },
    /// Find the values of keys with which a scene fits measured motion best
    // As clap would write it, the keys would swallow the files.
    #[command(after_help = FIT_HELP)]
    #[command(override_usage = "teeter fit [OPTIONS] <SCENE> <MEASURED.csv> --vary <KEY=LOW..HIGH>...")]
    Fit {
        /// The scene file; `-` reads standard input
        scene: PathBuf,
        #[command(flatten)]
        measured: measured::MeasuredOptions,
        /// A key and the range in which its value is sought, such as
        /// contact.feet.restitution=0..0.8; may be repeated
        #[arg(long, value_name = "KEY=LOW..HIGH", required = true, num_args = 1.., value_parser = teeter_study::fit::FitKey::read)]
        vary: Vec<teeter_study::fit::FitKey>,
        /// What the measured angle shows when the block stands upright, such as "0.2 deg" (default:
        /// fitted)
        #[arg(long, value_name = "ANGLE", value_parser = measured::offset, allow_hyphen_values = true)]
        offset: Option<f64>,
        /// Number of values tried all over the ranges first (default: 16 for each key, and 16 more)
        #[arg(long, value_name = "N", value_parser = count, allow_negative_numbers = true)]
        samples: Option<u16>,
        /// Seed of these values
        #[arg(long, value_name = "N", default_value = "1", value_parser = seed, allow_negative_numbers = true)]
        seed: u64,
        /// Number of runs at once (default: one for each core)
        #[arg(long, value_name = "N", value_parser = count, allow_negative_numbers = true)]
        jobs: Option<u16>,
        /// Folder of the files that the scene names (default: the scene file's own)
        #[arg(long, value_name = "DIR")]
        base: Option<PathBuf>,
        /// Override a key of the scene, such as beam.table.thickness="2 mm"; may be repeated
        #[arg(long = "set", value_name = "KEY=VALUE", value_parser = key_value)]
        set: Vec<(String, String)>,
        /// Folder for the results (default: `runs/` with the name of the scene file and `-fit`)
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        #[command(flatten)]
        figure_width: record::FigureWidth,
        /// Print only the results and errors
        #[arg(long)]
        quiet: bool,
        /// Replace results of an earlier fit
        #[arg(long)]
        force: bool,
    },
    /// List the contact solvers: their dimensions, law (exact or convex) and source
    Solvers,
    /// Solve contact problems from FCLIB files; print residual, iterations and time
    #[command(after_help = SOLVE_HELP)]
    Solve {
        /// FCLIB files (HDF5), or folders with such files: all *.hdf5 below
        #[arg(value_name = "FILE.hdf5|DIR")]
        paths: Vec<PathBuf>,
        /// The solvers, by the names of `teeter solvers`; `all`: each one on the problems that it
        /// supports
        #[arg(long = "solver", value_name = "NAME", num_args = 1.., value_delimiter = ',', default_value = "auto")]
        solvers: Vec<String>,
        /// The residual that counts as solved
        #[arg(long, value_name = "T", default_value = "1e-10", value_parser = solve::tolerance)]
        tolerance: f64,
        /// Time limit for a solve, with its unit
        #[arg(long, value_name = "T", default_value = "10 s", value_parser = solve::time)]
        time_limit: Duration,
        /// Print a line with a JSON object for each file and solver
        #[arg(long)]
        json: bool,
        /// Write the impulses to `DIR/<file stem>.<solver>.csv`, one number per line
        #[arg(long, value_name = "DIR", conflicts_with = "profile")]
        solutions: Option<PathBuf>,
        /// Solve to 1e-4, 1e-8 and 1e-12; write table.csv, performance profiles (SVG) and
        /// profile.md to DIR
        #[arg(long, value_name = "DIR", conflicts_with = "tolerance")]
        profile: Option<PathBuf>,
        /// Width of the profiles: 84 mm and 174 mm are one and two columns of most journals
        #[arg(long = "figure-width", value_name = "WIDTH", default_value = "120 mm", value_parser = record::figure_width, requires = "profile")]
        figure_width: f64,
        /// Replace solutions or profiles of an earlier solve
        #[arg(long)]
        force: bool,
    },
    /// Print completions of commands and options for a shell
    #[command(
        after_help = "Examples:\n  teeter completions bash > ~/.local/share/bash-completion/completions/teeter\n  \
        teeter completions fish > ~/.config/fish/completions/teeter.fish"
    )]
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Write man pages of the program and its commands to a folder
    Man {
        /// The folder
        #[arg(value_name = "DIR")]
        folder: PathBuf,
    },
    /// Write figures as PDF, with their font embedded, each beside its SVG
    #[cfg(feature = "pdf")]
    #[command(
        after_help = "Examples:\n  teeter run scene.toml --set output.figure_width=\"84 mm\"   # one column of a journal\n  \
        teeter pdf runs/scene\n  teeter pdf record/figures/spectra.svg --force"
    )]
    Pdf {
        /// Figures (.svg) that this program wrote, folders of such, or folders of results
        #[arg(value_name = "PATH", required = true)]
        paths: Vec<PathBuf>,
        /// Replace PDF files that are there
        #[arg(long)]
        force: bool,
        /// Print only errors
        #[arg(long)]
        quiet: bool,
    },
    /// Print the JSON Schema of scene files, for editors
    #[command(after_help = "Examples:\n  teeter schema > scene.schema.json\n  teeter schema --format markdown")]
    Schema {
        /// `json`: the schema; `markdown`: the reference page
        #[arg(long, default_value = "json")]
        format: schema::Format,
    },
}

const SOLVE_HELP: &str = "Examples:
  teeter solve problem.hdf5
  teeter solve problems/ --solver all --tolerance 1e-8 --time-limit \"2 s\"
  teeter solve problem.hdf5 --solver pgs auto --json --solutions impulses
  teeter solve problems/ --solver all --profile profile --time-limit \"2 s\"

Each solve starts from p = 0. Its residual is that of the one judge, whatever the solver minimised inside; a solver that
fails is a row. The time is the solver's alone: problem read, memory ready. A solve of less than 0.1 s is repeated from the
same start, and the median taken.";

const RECORD_HELP: &str = "Examples:
  teeter record quake.at2
  teeter record quake.at2 --baseline linear --taper 0.05 --peak \"0.4 gn\" --out quake
  teeter record table.csv --step \"10 ms\" --unit gal --json

The corrections are those of a record in a scene, in the same order: cut, baseline, taper, scale (docs/signals.md).";

const SWEEP_HELP: &str = "Examples:
  teeter sweep friction.toml
  teeter sweep friction.toml --out results --resume          # only what is missing, after a kill, too
  teeter sweep friction.toml --shard 2/8 --out part-2        # on one of eight machines
  teeter sweep --merge part-1 part-2 part-3 --out results
  teeter sweep --compare on-ground on-beam --out both        # fragility curves, distributions

A sweep file:
  scene = \"rocking.toml\"

  [grid]                                  # all combinations
  contact.feet.friction = [0.3, 0.5]
  block.rocker.tilt = { from = \"1 deg\", to = \"5 deg\", count = 9 }

  [outputs]                               # columns of results.csv
  largest = { max_abs = \"rocker.phi\" }   # of trajectory.csv
  impacts = \"impact_count\"               # of summary.json

docs/sweep.md describes it.";

const COMPARE_HELP: &str = "Examples:
  teeter compare runs/rocking camera.csv
  teeter compare runs/rocking camera.csv --column t=Time --column phi=\"Angle\" --unit phi=deg
  teeter compare runs/rocking frames.csv --rate \"165 Hz\" --column phi=2 --shift \"-0.31 s\" --sign 1
  teeter compare runs/rocking markers.csv --columns markers.toml

Both motions go through the same sampling and smoothing before rates are compared. docs/compare.md describes tables,
markers and results.";

const FIT_HELP: &str = "Examples:
  teeter fit rocking.toml camera.csv --vary beam.table.damping_ratio.ratio=0.001..0.1
  teeter fit rocking.toml camera.csv --vary contact.feet.friction=0.1..1 --vary beam.table.thickness=\"1 mm..3 mm\"

The time shift and the zero of the measured angle are fitted too, unless given. Rows count up to where the motion is
predictable; a warning says which shorter time.step extends that. A rocking block hardly shows the damping of its beam: let it
stand on the beam, released where the beam is undeformed. docs/fit.md has the commands, the method and the results.";

/// clap would put a sweep file into the line of `--merge`.
const SWEEP_USAGE: &str = "teeter sweep [OPTIONS] <SWEEP.toml>
       teeter sweep --merge <DIR>... --out <DIR>
       teeter sweep --compare <DIR> <DIR>... --out <DIR>";

pub(crate) fn key_value(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((key, value)) if !key.trim().is_empty() => Ok((key.trim().to_owned(), value.trim().to_owned())),
        _ => Err("write KEY=VALUE, such as time.step=50us".to_owned()),
    }
}

/// A number of things to do, 1 or more.
fn count(text: &str) -> Result<u16, String> {
    let count = text.parse::<u16>().ok().filter(|count| *count > 0);
    count.ok_or_else(|| format!("a whole number from 1 to {} is expected", u16::MAX))
}

/// A seed of random numbers.
fn seed(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| format!("a whole number from 0 to {} is expected", u64::MAX))
}
