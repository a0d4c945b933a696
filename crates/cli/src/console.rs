//! What the program says to its user: on standard error, quietly where that is closed.

use crate::run::Exit;
use std::io::{ErrorKind, IsTerminal, Write};
use teeter_scenario::diagnostic::is_display_control;

/// Standard error, or less of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Console {
    quiet: bool,
    terminal: bool,
}

impl Console {
    pub(crate) fn new(quiet: bool) -> Self {
        Self { quiet, terminal: std::io::stderr().is_terminal() }
    }

    /// Whether a person is looking.
    pub(crate) fn is_watched(self) -> bool {
        !self.quiet && self.terminal
    }

    /// Something that a user wants to know, unless they asked for quiet.
    pub(crate) fn note(self, text: &str) {
        if !self.quiet {
            say(text);
        }
    }

    /// Something that a user has to know.
    pub(crate) fn error(self, text: &str) {
        say(text);
    }
}

/// Writes results to standard output. A closed pipe (`teeter … | head -1`) is no failure: its
/// reader has seen enough.
///
/// # Errors
/// What is to be told the user where the text can't be written, such as to a full disk.
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
        Ok(()) => Exit::Done,
        Err(why) => {
            say(&format!("error: {why}"));
            Exit::Failed
        }
    }
}

/// A text without characters that would steer the terminal or turn the direction of writing, but
/// for those to `keep`.
pub(crate) fn clean(text: &str, keep: &str) -> String {
    text.chars().map(|c| if is_display_control(c) && !keep.contains(c) { '\u{fffd}' } else { c }).collect()
}

/// A reader that went away (`teeter … 2>&1 | head -1`) is no reason to fail: the results are in
/// files.
fn say(text: &str) {
    let _ = writeln!(std::io::stderr(), "{}", text.trim_end());
}
