//! The program `teeter`.

mod check;
mod console;
mod interrupt;
mod progress;
mod render;
mod run;
mod scene_page;
mod schema;

use clap::{Parser, Subcommand};
use std::path::PathBuf;
use std::process::ExitCode;

/// Simulates rigid blocks that rock, slide and bounce on elastic beams and on rigid ground.
#[derive(Debug, Parser)]
#[command(name = "teeter", version, arg_required_else_help = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Simulate a scene and write its motion, contacts, energy and summary
    #[command(after_help = "Examples:\n  teeter run scenarios/free-rocking-on-beam.toml\n  \
        teeter run scene.toml --out results --set time.step=50us --set contact.feet.friction=0.3")]
    Run {
        /// The scene file; `-` reads standard input
        scene: PathBuf,
        /// Folder for the results (default: `runs/` and the name of the scene file)
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Override a key of the scene, such as beam.table.thickness="2 mm"; may be repeated
        #[arg(long = "set", value_name = "KEY=VALUE", value_parser = key_value)]
        set: Vec<(String, String)>,
        /// Print errors only
        #[arg(long)]
        quiet: bool,
        /// Replace results of an earlier run
        #[arg(long)]
        force: bool,
    },
    /// Say what a scene models, costs and writes, and what looks wrong in it; run nothing
    #[command(after_help = "Examples:\n  teeter check scenarios/free-rocking-on-beam.toml\n  \
        teeter check scene.toml --set time.step=50us")]
    Check {
        /// The scene file; `-` reads standard input
        scene: PathBuf,
        /// Override a key of the scene, such as beam.table.thickness="2 mm"; may be repeated
        #[arg(long = "set", value_name = "KEY=VALUE", value_parser = key_value)]
        set: Vec<(String, String)>,
    },
    /// Print the JSON Schema of scene files, for editors
    #[command(after_help = "Examples:\n  teeter schema > scene.schema.json\n  teeter schema --format markdown")]
    Schema {
        /// `json`: the schema; `markdown`: the same as a page for people
        #[arg(long, default_value = "json")]
        format: schema::Format,
    },
}

fn key_value(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((key, value)) if !key.trim().is_empty() => Ok((key.trim().to_owned(), value.trim().to_owned())),
        _ => Err("write KEY=VALUE, such as time.step=50us".to_owned()),
    }
}

fn main() -> ExitCode {
    match Arguments::parse().command {
        Command::Run { scene, out, set, quiet, force } => {
            run::run(&run::Options { scene, out, set, quiet, force }).into()
        }
        Command::Check { scene, set } => check::check(&check::Options { scene, set }).into(),
        Command::Schema { format } => schema::print(format).into(),
    }
}
