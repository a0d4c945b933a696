//! Ctrl-C: the run ends after the step at hand, with its rows complete; a second one ends the program at once.

use std::sync::atomic::{AtomicBool, Ordering};

/// Exit code of a program that a user ended.
pub(crate) const INTERRUPTED: u8 = 130;

static WANTED: AtomicBool = AtomicBool::new(false);

/// Listens for Ctrl-C from now on; the flag says that it came. Where listening is impossible the signal ends the program as it
/// always did.
pub(crate) fn listen() -> &'static AtomicBool {
    let _ = ctrlc::set_handler(|| {
        if WANTED.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(INTERRUPTED));
        }
    });
    &WANTED
}
