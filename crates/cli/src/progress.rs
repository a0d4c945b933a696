//! Progress bars of long tasks.

use crate::console::{self, Console};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::{Duration, Instant};

/// A run shorter than this shows no bar.
const PATIENCE: Duration = Duration::from_secs(1);

/// Shows a bar on a terminal, once its task has taken that long.
fn appear(console: Console, begin: Instant, bar: &ProgressBar) {
    if console.is_watched() && bar.is_hidden() && begin.elapsed() > PATIENCE {
        bar.set_draw_target(ProgressDrawTarget::stderr_with_hz(10));
    }
}

/// Draws a bar with rate and time left, only on a terminal.
pub(crate) struct StepBar {
    console: Console,
    begin: Instant,
    bar: ProgressBar,
}

impl StepBar {
    /// A bar for steps from `first` to `steps`.
    pub(crate) fn new(console: Console, first: u64, steps: u64) -> Self {
        let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::hidden());
        bar.set_position(first);
        bar.reset_eta();
        let template = "{bar:30} {percent:>3} %  {human_pos} of {human_len} steps  {per_sec}  {eta} left";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        Self { console, begin: Instant::now(), bar }
    }

    /// Sets the current step.
    pub(crate) fn at(&self, step: u64) {
        if self.console.is_watched() {
            appear(self.console, self.begin, &self.bar);
            self.bar.set_position(step);
        }
    }

    /// Prints lines above the bar.
    pub(crate) fn tell(&self) -> impl Fn(&str) + use<> {
        let (console, bar) = (self.console, self.bar.clone());
        move |text| bar.suspend(|| console.note(text))
    }
}

impl Drop for StepBar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// Prints rows to standard output as they are available, above a bar on standard error that counts
/// the solves.
pub(crate) struct SolveBar {
    console: Console,
    begin: Instant,
    bar: ProgressBar,
}

impl SolveBar {
    pub(crate) fn new(console: Console, solves: u64) -> Self {
        let bar = ProgressBar::with_draw_target(Some(solves), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{bar:30} {human_pos} of {human_len} solves  {elapsed}") {
            bar.set_style(style);
        }
        Self { console, begin: Instant::now(), bar }
    }

    /// Writes to standard output.
    ///
    /// # Errors
    /// As [`console::print()`].
    pub(crate) fn print(&self, text: &str) -> Result<(), String> {
        self.bar.suspend(|| console::print(text)).map_err(|why| format!("error: {why}"))
    }

    pub(crate) fn tell(&self, text: &str) {
        self.bar.suspend(|| self.console.note(text));
    }

    pub(crate) fn step(&self) {
        self.bar.inc(1);
        appear(self.console, self.begin, &self.bar);
    }
}

impl Drop for SolveBar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// A bar for the cases of a study, with the time left.
pub(crate) struct CaseBar {
    console: Console,
    begin: Instant,
    bar: ProgressBar,
    /// Cases that were done before.
    before: u64,
}

impl CaseBar {
    pub(crate) fn new(console: Console, before: u64, cases: u64) -> Self {
        let bar = ProgressBar::with_draw_target(Some(cases), ProgressDrawTarget::hidden());
        bar.set_position(before);
        if let Ok(style) =
            ProgressStyle::with_template("{bar:30} {percent:>3} %  {human_pos} of {human_len} cases  {msg}")
        {
            bar.set_style(style);
        }
        Self { console, begin: Instant::now(), bar, before }
    }

    /// Counts a case.
    pub(crate) fn step(&self) {
        self.bar.inc(1);
        if !self.console.is_watched() {
            return;
        }
        let elapsed = self.begin.elapsed();
        let (done, all) = (self.bar.position() - self.before, self.bar.length().unwrap_or(0) - self.before);
        // The mean over all cases so far: neighbouring cases cost alike, so a mean over the last ones
        // would swing with the axes.
        let left = elapsed.as_secs_f64() * (all.saturating_sub(done)) as f64 / done.max(1) as f64;
        self.bar.set_message(format!("{} left", indicatif::HumanDuration(Duration::from_secs_f64(left))));
        appear(self.console, self.begin, &self.bar);
    }
}

impl Drop for CaseBar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// A bar for work in phases, on standard error.
pub(crate) struct PhaseBar {
    console: Console,
    begin: Instant,
    bar: ProgressBar,
}

impl PhaseBar {
    pub(crate) fn new(console: Console) -> Self {
        let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{bar:30} {msg}: {human_pos} of {human_len}  {elapsed}") {
            bar.set_style(style);
        }
        Self { console, begin: Instant::now(), bar }
    }

    /// Sets the progress of a phase.
    pub(crate) fn at(&self, phase: &str, done: usize, of: usize) {
        appear(self.console, self.begin, &self.bar);
        if self.bar.message() != phase {
            self.bar.set_message(phase.to_owned());
        }
        self.bar.set_length(of as u64);
        self.bar.set_position(done as u64);
    }
}

impl Drop for PhaseBar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
