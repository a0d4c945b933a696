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
        let (done, all) = (self.bar.position() - self.before, self.bar.length().unwrap_or(0) - self.before);
        let left = time_left(self.begin.elapsed().as_secs_f64(), done, all);
        self.bar.set_message(format!("{} left", in_two_units(left)));
        appear(self.console, self.begin, &self.bar);
    }
}

/// How long the rest of `all` cases takes, s, where `done` ones took `elapsed`: they come from all over the study.
fn time_left(elapsed: f64, done: u64, all: u64) -> f64 {
    elapsed * all.saturating_sub(done) as f64 / done.max(1) as f64
}

/// A time in its unit and the next smaller one: a single unit would round 95 s to two minutes.
fn in_two_units(seconds: f64) -> String {
    const UNITS: [(u64, &str, u64, &str); 3] = [(86_400, "d", 3600, "h"), (3600, "h", 60, "min"), (60, "min", 1, "s")];
    let seconds = seconds.round() as u64;
    match UNITS.into_iter().find(|(unit, ..)| seconds >= *unit) {
        Some((unit, name, smaller, its_name)) => {
            format!("{} {name} {} {its_name}", seconds / unit, seconds % unit / smaller)
        }
        None => format!("{seconds} s"),
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

#[cfg(test)]
mod tests {
    use super::{in_two_units, time_left};
    use teeter_study::sweep::Shard;

    /// Times at which cases end on `threads` threads, each with what `cost` takes for it.
    fn ends(cases: u64, threads: u64, cost: &dyn Fn(u64) -> f64) -> Vec<f64> {
        let mut free = vec![0.0_f64; threads as usize];
        let mut ends: Vec<f64> = Shard::ALL
            .spread(cases)
            .map(|case| {
                let first = free.iter_mut().min_by(|a, b| a.total_cmp(b)).unwrap();
                *first += cost(case);
                *first
            })
            .collect();
        ends.sort_by(f64::total_cmp);
        ends
    }

    #[test]
    fn the_time_left_is_right_to_a_fifth_from_a_tenth_of_the_work_on() {
        // Costs that are even, that change threefold along the first axis or the last one, of ten values, and that are four times as large
        // in one half.
        let share = |case: u64, of: u64| case as f64 / of as f64;
        for cases in [100, 360, 1000, 5000] {
            let costs: [(&str, &dyn Fn(u64) -> f64); 5] = [
                ("even", &|_| 1.0),
                ("first axis", &|case| 1.0 + 2.0 * share(case, cases)),
                ("first axis, falling", &|case| 3.0 - 2.0 * share(case, cases)),
                ("last axis", &|case| 1.0 + 2.0 * share(case % 10, 10)),
                ("halves", &|case| if 2 * case < cases { 1.0 } else { 4.0 }),
            ];
            for (name, cost) in costs {
                // A case that runs is half done, so that a tenth of the cases must be many more than there are threads.
                for threads in [1, 2, 8].into_iter().filter(|threads| cases >= 50 * threads) {
                    let ends = ends(cases, threads, cost);
                    let all = ends[ends.len() - 1];
                    for (done, end) in (1..).zip(&ends).filter(|(_, end)| (0.1..0.9).contains(&(**end / all))) {
                        let off = time_left(*end, done, cases) / (all - end) - 1.0;
                        assert!(off.abs() < 0.2, "{cases} cases, {name}, {threads} threads, {done} done: {off:.2}");
                    }
                }
            }
        }
    }

    #[test]
    fn times_are_told_to_a_few_per_cent() {
        let told = [0.4, 59.4, 95.0, 3599.0, 7500.0, 100_000.0].map(in_two_units);
        assert_eq!(told, ["0 s", "59 s", "1 min 35 s", "59 min 59 s", "2 h 5 min", "1 d 3 h"]);
    }
}
