//! What the program says to its user: on standard error, quietly where that is closed.

use std::io::{IsTerminal, Write};

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

/// A reader that went away (`teeter … 2>&1 | head -1`) is no reason to fail: the results are in files.
fn say(text: &str) {
    let _ = writeln!(std::io::stderr(), "{}", text.trim_end());
}
