//! The pictures of the animation: a bounded number of states, evenly spread over a run of any length.

use serde::{Deserialize, Serialize};

/// States at every `stride`-th step; when full, every second goes and the stride doubles.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Frames {
    capacity: usize,
    stride: u64,
    seen: u64,
    width: usize,
    t: Vec<f64>,
    values: Vec<f64>,
    /// The state at the end of the run.
    last: Option<(f64, Vec<f64>)>,
}

/// What became of a state.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Entered {
    /// Every second picture has gone.
    pub(crate) halved: bool,
    /// This one is kept.
    pub(crate) kept: bool,
}

impl Frames {
    /// Room for `capacity` states of `width` numbers each.
    pub(crate) fn new(capacity: usize, width: usize) -> Self {
        Self { capacity, stride: 1, seen: 0, width, t: Vec::new(), values: Vec::new(), last: None }
    }

    /// Enters a state; `fill` writes its numbers, if it is to be kept.
    #[inline]
    pub(crate) fn enter(&mut self, t: f64, fill: impl FnOnce(&mut [f64])) -> Entered {
        let due = self.seen.is_multiple_of(self.stride);
        let entered = if due { self.keep(t, fill) } else { Entered::default() };
        self.seen += 1;
        entered
    }

    #[inline(never)]
    fn keep(&mut self, t: f64, fill: impl FnOnce(&mut [f64])) -> Entered {
        let halved = self.t.len() == self.capacity;
        if halved {
            self.halve();
            // The stride need no longer meet this step.
            if !self.seen.is_multiple_of(self.stride) {
                return Entered { halved, kept: false };
            }
        }
        let start = self.values.len();
        self.t.push(t);
        self.values.resize(start + self.width, 0.0);
        fill(&mut self.values[start..]);
        Entered { halved, kept: true }
    }

    /// Enters the last state again, to be kept in any case, so that the picture ends where the run does.
    pub(crate) fn end(&mut self, t: f64, fill: impl FnOnce(&mut [f64])) {
        let mut row = vec![0.0; self.width];
        fill(&mut row);
        self.last = Some((t, row));
    }

    /// Removes every second picture.
    pub(crate) fn halve(&mut self) {
        let kept = self.t.len().div_ceil(2);
        for i in 1..kept {
            self.t[i] = self.t[2 * i];
            self.values.copy_within(2 * i * self.width..(2 * i + 1) * self.width, i * self.width);
        }
        self.t.truncate(kept);
        self.values.truncate(kept * self.width);
        self.stride *= 2;
    }

    /// The kept states in order of time, with the last of all.
    pub(crate) fn rows(&self) -> impl Iterator<Item = (f64, &[f64])> {
        let kept = self.t.iter().enumerate().map(|(i, &t)| (t, &self.values[i * self.width..(i + 1) * self.width]));
        let end = self.t.last().copied();
        let last = self.last.iter().filter(move |(t, _)| end.is_none_or(|end| *t > end));
        kept.chain(last.map(|(t, row)| (*t, row.as_slice())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times(capacity: usize, steps: u64) -> Vec<f64> {
        let mut frames = Frames::new(capacity, 1);
        for k in 0..=steps {
            frames.enter(k as f64, |row| row[0] = -(k as f64));
        }
        frames.end(steps as f64, |row| row[0] = -(steps as f64));
        assert!(frames.rows().all(|(t, row)| row == [-t]));
        frames.rows().map(|(t, _)| t).collect()
    }

    #[test]
    fn short_runs_are_kept_whole() {
        assert_eq!(times(4, 3), [0.0, 1.0, 2.0, 3.0]);
    }

    #[test]
    fn long_runs_are_kept_evenly_with_their_end() {
        assert_eq!(times(4, 4), [0.0, 2.0, 4.0]);
        assert_eq!(times(4, 9), [0.0, 4.0, 8.0, 9.0]);
        assert_eq!(times(3, 7), [0.0, 4.0, 7.0]);
        let long = times(2000, 1_000_003);
        assert!(long.len() <= 2001 && long.len() > 900, "{}", long.len());
        assert_eq!((long[0], *long.last().unwrap()), (0.0, 1_000_003.0));
    }
}
