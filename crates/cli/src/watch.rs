//! `teeter run --watch`: runs again whenever an input changes.

use crate::console::Console;
use crate::interrupt;
use crate::run::{self, Exit, Options};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::{Duration, SystemTime};
use teeter_run::ExistingResults;

/// Time between two looks at the files.
const EVERY: Duration = Duration::from_millis(200);

/// Runs a scene, and again after each change of its files, until a signal.
pub(crate) fn watch(mut options: Options) -> Exit {
    let console = Console::new(options.quiet);
    if options.scene == Path::new("-") {
        console.error("error: standard input can't be watched: give the scene as a file");
        return Exit::BadInput;
    }
    let stopped = interrupt::listen();
    loop {
        // What changes during the run counts as a change.
        let mut files = run::inputs(&options);
        let before = Stamps::of(&files);
        let exit = run::run(&options);
        if stopped.load(Ordering::Relaxed) {
            return Exit::Interrupted;
        }
        // Results of somebody else are not replaced: only those of the runs from here on.
        match exit {
            Exit::BadInput if options.existing == ExistingResults::Refuse && run::has_results(&options) => return exit,
            // A run that failed has written to its folder, too: the next one shows what mending the scene has changed.
            Exit::FinishedRun | Exit::Failed => options.existing = ExistingResults::Replace,
            _ => {}
        }
        console.note(&format!("watching {} for changes; Ctrl-C ends", options.scene.display()));
        while Stamps::of(&files) == before {
            if stopped.load(Ordering::Relaxed) {
                return Exit::Interrupted;
            }
            std::thread::sleep(EVERY);
            // Which files a scene names changes with the scene alone, but one that can't be read may lack
            // a file that comes.
            if exit == Exit::BadInput {
                files = run::inputs(&options);
            }
        }
    }
}

/// Sizes and times of the files that a run reads; a file that isn't there has none.
#[derive(PartialEq)]
struct Stamps(Vec<Option<(u64, SystemTime)>>);

impl Stamps {
    fn of(files: &[PathBuf]) -> Self {
        let stamp = |path: &PathBuf| {
            let found = std::fs::metadata(path).ok()?;
            Some((found.len(), found.modified().ok()?))
        };
        Self(files.iter().map(stamp).collect())
    }
}
