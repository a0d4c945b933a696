//! CPU time, measured fairly: one thread at a time, warm, without output, the candidates in turns
//! so that a busy moment of the machine falls on all of them; the median.

use crate::simulate::time;
use crate::{Failure, Setting, Source};
use std::sync::atomic::AtomicBool;

/// The CPU time of the steps of a run, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cpu {
    /// Median.
    pub median: f64,
    /// The least.
    pub least: f64,
    /// How many were measured.
    pub runs: usize,
}

impl Cpu {
    /// Of some measured times; `None` without any.
    #[must_use]
    pub fn of(mut times: Vec<f64>) -> Option<Self> {
        times.sort_by(f64::total_cmp);
        let least = *times.first()?;
        let middle = times.len() / 2;
        let median = if times.len() % 2 == 1 { times[middle] } else { 0.5 * (times[middle - 1] + times[middle]) };
        Some(Self { median, least, runs: times.len() })
    }
}

/// How often a short run is measured.
const SHORT: usize = 7;

/// How often a run is measured, by its modelled cost (s) and not by the clock: short ones vary the
/// most and cost the least.
fn runs(modelled: f64) -> usize {
    match modelled {
        short if short < 0.03 => SHORT,
        long if long < 1.0 => 3,
        _ => 1,
    }
}

/// Measures settings, given with their modelled cost (s), in turns. A run of the same setting has
/// been done before, which warms caches of the long ones; the short ones get one more that doesn't
/// count. `done` hears of each turn.
pub(crate) fn in_turns(
    source: &Source,
    settings: &[(&Setting, f64)],
    cancel: &AtomicBool,
    done: &mut dyn FnMut(usize, usize),
) -> Result<Vec<Option<Cpu>>, Failure> {
    let most = settings.iter().map(|(_, modelled)| runs(*modelled)).max().unwrap_or(0);
    let mut times: Vec<Vec<f64>> = settings.iter().map(|_| Vec::new()).collect();
    for turn in 0..most {
        for ((setting, modelled), times) in settings.iter().zip(&mut times) {
            let runs = runs(*modelled);
            // The last turns are of all, the first ones of those alone that have more.
            if turn + runs < most {
                continue;
            }
            if times.is_empty() && runs == SHORT {
                time(source, setting, cancel)?;
            }
            times.push(time(source, setting, cancel)?);
        }
        done(turn + 1, most);
    }
    Ok(times.into_iter().map(Cpu::of).collect())
}

#[cfg(test)]
mod tests {
    use super::Cpu;

    #[test]
    fn one_bad_moment_does_not_move_the_median() {
        let cpu = Cpu::of(vec![2.0, 1.0, 900.0]).unwrap();
        assert_eq!((cpu.median, cpu.least, cpu.runs), (2.0, 1.0, 3));
        assert_eq!(Cpu::of(vec![2.0, 1.0]).map(|cpu| cpu.median), Some(1.5));
        assert_eq!(Cpu::of(Vec::new()), None);
    }
}
