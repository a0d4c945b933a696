//! The program `teeter`.

#[cfg(feature = "animation")]
mod animate;
mod arguments;
mod check;
mod compare;
mod console;
mod fit;
mod interrupt;
mod measured;
mod new;
#[cfg(feature = "pdf")]
mod pdf;
mod progress;
mod record;
mod render;
mod run;
mod scene;
mod scene_page;
mod schema;
mod shell;
mod solve;
mod sweep;
mod tradeoff;
mod watch;

use arguments::{Arguments, Command};
use clap::Parser;
use console::Console;
use run::Exit;
use std::process::ExitCode;
use teeter_run::ExistingResults;

/// Prints clap's help and version to standard output, errors of usage to standard error.
fn explain(error: &clap::Error) -> ExitCode {
    // Of a command clap would advise `-- --version`, as if it were a file.
    if let Some(clap::error::ContextValue::String(word)) = error.get(clap::error::ContextKind::InvalidArg)
        && error.kind() == clap::error::ErrorKind::UnknownArgument
        && matches!(word.as_str(), "--version" | "-V")
    {
        Console::new(false)
            .error("error: commands have no version of their own: `teeter --version` tells that of the program");
        return Exit::BadInput.into();
    }
    match error.print() {
        Err(why) if !error.use_stderr() && why.kind() != std::io::ErrorKind::BrokenPipe => {
            Console::new(false).error(&format!("error: can't write to standard output: {why}"));
            Exit::Failed.into()
        }
        _ if error.use_stderr() => Exit::BadInput.into(),
        _ => Exit::FinishedRun.into(),
    }
}

/// The words of the command line; `help --help`, which clap takes for a command named `--help`, asks
/// for what `help` prints.
fn words(given: impl Iterator<Item = std::ffi::OsString>) -> Vec<std::ffi::OsString> {
    let mut words: Vec<_> = given.collect();
    if words.len() == 3 && words[1] == "help" && (words[2] == "--help" || words[2] == "-h") {
        words.pop();
    }
    words
}

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse_from(words(std::env::args_os())) {
        Ok(arguments) => arguments,
        Err(error) => return explain(&error),
    };
    match arguments.command {
        Command::Run {
            scene,
            base,
            out,
            mut set,
            accuracy,
            horizon,
            quiet,
            no_report,
            force,
            export_problems,
            export_when,
            checkpoint_every,
            resume,
            model,
            from,
            dump_unconverged,
            vtk,
            #[cfg(feature = "animation")]
            animate,
            #[cfg(feature = "parallel")]
            threads,
            watch,
        } => {
            set.extend(accuracy.map(|accuracy| ("time.accuracy".to_owned(), accuracy)));
            let export = export_problems.map(|folder| (folder, export_when));
            let existing = match (resume, force) {
                (true, _) => ExistingResults::Resume,
                (false, true) => ExistingResults::Replace,
                (false, false) => ExistingResults::Refuse,
            };
            let options = run::Options {
                scene,
                base,
                out,
                set,
                quiet,
                no_report,
                existing,
                export,
                checkpoint_every,
                extent: model,
                from,
                horizon,
                vtk,
                dump_unconverged,
                #[cfg(feature = "animation")]
                animate,
                #[cfg(feature = "parallel")]
                threads,
            };
            if watch { watch::watch(options).into() } else { run::run(&options).into() }
        }
        Command::Check { scene, base, set, model } => {
            check::check(&check::Options { scene, base, set, extent: model }).into()
        }
        Command::Tradeoff { scene, base, out, set, figure_width, quiet, force } => {
            tradeoff::tradeoff(&tradeoff::Options {
                scene,
                base,
                out,
                set,
                figure_width: figure_width.metres,
                quiet,
                force,
            })
            .into()
        }
        Command::Sweep { sweep: Some(sweep), out, jobs, shard, resume, figure_width, quiet, force, .. } => {
            let jobs = jobs.map(usize::from);
            sweep::sweep(&sweep::Options {
                sweep,
                out,
                jobs,
                shard,
                resume,
                figure_width: figure_width.metres,
                force,
                quiet,
            })
            .into()
        }
        Command::Sweep { sweep: None, out, compare, figure_width, quiet, force, .. } if !compare.is_empty() => {
            sweep::compare(&compare, &out.unwrap_or_default(), figure_width.metres, force, quiet).into()
        }
        Command::Sweep { sweep: None, out, merge, figure_width, quiet, force, .. } => {
            sweep::merge_shards(&merge, &out.unwrap_or_default(), figure_width.metres, force, quiet).into()
        }
        Command::Record {
            file,
            component,
            unit,
            step,
            from,
            to,
            baseline,
            taper,
            scale,
            peak,
            peak_velocity,
            arias,
            spectral_acceleration,
            period,
            json,
            figure_width,
            out,
            force,
        } => {
            let keys = [
                ("component", component),
                ("unit", unit),
                ("step", step),
                ("from", from),
                ("to", to),
                ("baseline", baseline),
                ("taper", taper),
                ("scale", scale),
                ("peak", peak),
                ("peak_velocity", peak_velocity),
                ("arias", arias),
                ("spectral_acceleration", spectral_acceleration),
                ("period", period),
            ];
            let keys = keys.into_iter().filter_map(|(key, value)| Some((key.to_owned(), value?))).collect();
            record::record(&record::Options { file, keys, json, figure_width, out, force }).into()
        }
        Command::Compare { run, measured, offset, out, figure_width, quiet, force } => {
            compare::compare(&compare::Options {
                run,
                measured,
                offset,
                out,
                figure_width: figure_width.metres,
                quiet,
                force,
            })
            .into()
        }
        Command::Fit {
            scene,
            measured,
            vary,
            offset,
            samples,
            seed,
            jobs,
            base,
            set,
            out,
            figure_width,
            quiet,
            force,
        } => {
            let (samples, jobs) = (samples.map(usize::from), jobs.map(usize::from));
            let options = fit::Options {
                scene,
                base,
                set,
                measured,
                vary,
                offset,
                samples,
                seed,
                jobs,
                out,
                figure_width: figure_width.metres,
                quiet,
                force,
            };
            fit::fit(&options).into()
        }
        Command::Solvers => solve::list().into(),
        Command::Solve { paths, solvers, tolerance, time_limit, json, solutions, profile, figure_width, force } => {
            solve::solve(&solve::Options {
                paths,
                solvers,
                tolerance,
                time_limit,
                json,
                solutions,
                profile,
                figure_width,
                force,
            })
            .into()
        }
        Command::New { file, from, list, force } => new::new(&new::Options { file, from, list, force }).into(),
        Command::Completions { shell } => shell::completions(shell).into(),
        Command::Man { folder } => shell::man(&folder).into(),
        #[cfg(feature = "pdf")]
        Command::Pdf { paths, force, quiet } => pdf::pdf(&pdf::Options { paths, force, quiet }).into(),
        Command::Schema { format } => schema::print(format).into(),
    }
}
