//! Ctrl-C, and the signals with which batch systems and closed terminals end a program: the run
//! ends with its last whole step, with complete rows; a second signal ends the program at once.

use std::sync::atomic::AtomicBool;
use std::sync::{Arc, LazyLock};

/// Exit code of a program ended by its user.
pub(crate) const INTERRUPTED: u8 = 130;

static WANTED: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);

/// Starts to listen; the flag is set by a signal. If listening is impossible a signal ends the
/// program at once.
pub(crate) fn listen() -> &'static Arc<AtomicBool> {
    static ONCE: std::sync::Once = std::sync::Once::new();
    ONCE.call_once(system::listen);
    &WANTED
}

#[cfg(unix)]
mod system {
    use super::{INTERRUPTED, WANTED};
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use std::sync::atomic::Ordering;

    pub(super) fn listen() {
        // A program started with a signal ignored (`nohup`, a shell's `&`) should continue.
        let heeded = [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|&signal| !is_ignored(signal));
        let Ok(mut signals) = Signals::new(heeded) else { return };
        std::thread::spawn(move || {
            for _ in signals.forever() {
                if WANTED.swap(true, Ordering::Relaxed) {
                    std::process::exit(i32::from(INTERRUPTED));
                }
            }
        });
    }

    /// Whether the process was started with this signal ignored; false if unknown.
    fn is_ignored(signal: i32) -> bool {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
        mask >> (signal - 1) & 1 == 1
    }
}

#[cfg(not(unix))]
mod system {
    use super::{INTERRUPTED, WANTED};
    use std::sync::atomic::Ordering;

    pub(super) fn listen() {
        let _ = ctrlc::set_handler(|| {
            if WANTED.swap(true, Ordering::Relaxed) {
                std::process::exit(i32::from(INTERRUPTED));
            }
        });
    }
}
