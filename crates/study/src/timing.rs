//! Measures CPU times: one thread at a time, warm, without output, with the candidates alternating
//! so that load on the machine affects all of them; the median counts.

use crate::simulate::time;
use crate::{Failure, Setting, StudyScene};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// The CPU time of the steps of a run, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CpuTime {
    /// Median.
    pub median: f64,
    /// Minimum.
    pub least: f64,
    /// Number of measurements.
    pub runs: usize,
}

impl CpuTime {
    /// From measured times; `None` without any.
    #[must_use]
    pub fn of(mut times: Vec<f64>) -> Option<Self> {
        times.sort_by(f64::total_cmp);
        let least = *times.first()?;
        let middle = times.len() / 2;
        let median = if times.len() % 2 == 1 { times[middle] } else { 0.5 * (times[middle - 1] + times[middle]) };
        Some(Self { median, least, runs: times.len() })
    }
}

/// Number of measurements of a short run.
const SHORT: usize = 7;

/// Number of measurements of a run, by its modelled cost (s), not by the clock: short ones vary
/// most and cost least.
fn runs(modelled: f64) -> usize {
    match modelled {
        short if short < 0.03 => SHORT,
        long if long < 1.0 => 3,
        _ => 1,
    }
}

/// Measures settings, given with their modelled cost (s), alternately. Each setting has been run
/// before, which warms the caches for long runs; short ones get one more run that doesn't count.
/// `done` is called after each turn.
pub(crate) fn in_turns(
    source: &StudyScene,
    settings: &[(&Setting, f64)],
    cancel: &Arc<AtomicBool>,
    done: &mut dyn FnMut(usize, usize),
) -> Result<Vec<Option<CpuTime>>, Failure> {
    let most = settings.iter().map(|(_, modelled)| runs(*modelled)).max().unwrap_or(0);
    let mut times: Vec<Vec<f64>> = settings.iter().map(|_| Vec::new()).collect();
    for turn in 0..most {
        for ((setting, modelled), times) in settings.iter().zip(&mut times) {
            let runs = runs(*modelled);
            // The first turns include only settings with more measurements, the last ones all.
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
    Ok(times.into_iter().map(CpuTime::of).collect())
}

#[cfg(test)]
mod tests {
    use super::CpuTime;

    #[test]
    fn one_bad_moment_does_not_move_the_median() {
        let cpu = CpuTime::of(vec![2.0, 1.0, 900.0]).unwrap();
        assert_eq!((cpu.median, cpu.least, cpu.runs), (2.0, 1.0, 3));
        assert_eq!(CpuTime::of(vec![2.0, 1.0]).map(|cpu| cpu.median), Some(1.5));
        assert_eq!(CpuTime::of(Vec::new()), None);
    }
}
