//! Messages to the user, on standard error; ignored if that is closed.

use crate::run::Exit;
use std::io::{ErrorKind, IsTerminal, Write};
use teeter_scenario::diagnostic::is_display_control;

/// Standard error, with a quiet mode.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Console {
    quiet: bool,
    terminal: bool,
}

impl Console {
    pub(crate) fn new(quiet: bool) -> Self {
        Self { quiet, terminal: std::io::stderr().is_terminal() }
    }

    /// Whether standard error is a terminal.
    pub(crate) fn is_watched(self) -> bool {
        !self.quiet && self.terminal
    }

    /// Whether notes are left out.
    pub(crate) fn is_quiet(self) -> bool {
        self.quiet
    }

    /// Prints a note, unless in quiet mode.
    pub(crate) fn note(self, text: &str) {
        if !self.quiet {
            say(text);
        }
    }

    /// Prints an error.
    pub(crate) fn error(self, text: &str) {
        say(text);
    }
}

/// Writes results to standard output. A closed pipe (`teeter … | head -1`) is ignored.
///
/// # Errors
/// A message if the text can't be written, for example because the disk is full.
pub(crate) fn print(text: &str) -> Result<(), String> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(format!("can't write to standard output: {error}")),
        _ => Ok(()),
    }
}

/// As [`print()`], for a command that does nothing else.
pub(crate) fn print_all(text: &str) -> Exit {
    match print(text) {
        Ok(()) => Exit::FinishedRun,
        Err(why) => {
            say(&format!("error: {why}"));
            Exit::Failed
        }
    }
}

/// A text without characters that would control the terminal or change the direction of writing,
/// except those to `keep`.
pub(crate) fn clean(text: &str, keep: &str) -> String {
    text.chars().map(|c| if is_display_control(c) && !keep.contains(c) { '\u{fffd}' } else { c }).collect()
}

/// Ignores a closed pipe (`teeter … 2>&1 | head -1`), as the results are in files.
fn say(text: &str) {
    let _ = writeln!(std::io::stderr(), "{}", text.trim_end());
}
