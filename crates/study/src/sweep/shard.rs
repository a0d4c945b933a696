//! A part of a study that one of several machines runs.

use std::str::FromStr;

/// Shard `number` of `of`: the cases whose number, counted from 0, leaves the remainder
/// `number − 1` when divided by `of`. Neighbouring cases, which tend to cost the same, go to
/// different shards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    number: u64,
    of: u64,
}

/// Why a text is not a shard.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ShardError {
    /// Not two numbers with a slash between them.
    #[error("write I/N, such as 2/8 for the second of eight shards")]
    NotAShard,
    /// A number outside 1 to N.
    #[error("there is no shard {number} of {of}: the first is 1/{of}, the last {of}/{of}")]
    OutOfRange {
        /// The number as given.
        number: u64,
        /// Of how many.
        of: u64,
    },
    /// No shards at all.
    #[error("a study has at least one shard")]
    None,
}

impl Shard {
    /// All cases.
    pub const ALL: Self = Self { number: 1, of: 1 };

    /// Shard `number` (from 1) of `of`.
    ///
    /// # Errors
    /// If there is no such shard.
    pub fn new(number: u64, of: u64) -> Result<Self, ShardError> {
        match of {
            0 => Err(ShardError::None),
            _ if (1..=of).contains(&number) => Ok(Self { number, of }),
            _ => Err(ShardError::OutOfRange { number, of }),
        }
    }

    /// Its number, from 1.
    #[must_use]
    pub fn number(self) -> u64 {
        self.number
    }

    /// Of how many shards.
    #[must_use]
    pub fn of(self) -> u64 {
        self.of
    }

    /// How many cases of a study of so many are in it.
    #[must_use]
    pub fn count(self, total: u64) -> u64 {
        total.saturating_sub(self.number - 1).div_ceil(self.of)
    }

    /// How many of its cases come before this one; `None` for a case of another shard.
    #[must_use]
    pub fn place(self, case: u64) -> Option<u64> {
        let after = case.checked_sub(self.number - 1)?;
        after.is_multiple_of(self.of).then(|| after / self.of)
    }

    /// The cases of a study of so many, in ascending order.
    pub fn cases(self, total: u64) -> impl Iterator<Item = u64> {
        let step = usize::try_from(self.of).unwrap_or(usize::MAX);
        (self.number - 1..total).step_by(step)
    }

    /// The same cases in the order in which they are best run: a few neighbours at a time, and these spread over the study. What a case takes changes
    /// along the axes, so that only cases from everywhere tell what all will take; neighbours share beams and equilibria.
    pub fn spread(self, total: u64) -> impl Iterator<Item = u64> {
        let Self { number, of } = self;
        let count = self.count(total);
        let size = count.div_ceil(PARTS).max(1);
        let parts = count.div_ceil(size);
        let stride = stride_over(parts);
        let places = move |turn: u64| {
            let first = turn * stride % parts * size;
            first..(first + size).min(count)
        };
        (0..parts).flat_map(places).map(move |place| number - 1 + place * of)
    }
}

/// Groups of neighbouring cases that are run one after the other: a tenth of them are spread finely enough.
const PARTS: u64 = 128;

/// The number nearest above the golden section of `count` that has no divisor in common with it: its multiples visit all
/// remainders, the first ones evenly.
fn stride_over(count: u64) -> u64 {
    let divisor = |mut a: u64, mut b: u64| {
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    let golden = (0.618_034 * count as f64) as u64;
    (golden.max(1)..).find(|stride| divisor(*stride, count) == 1).unwrap_or(1)
}

impl FromStr for Shard {
    type Err = ShardError;

    fn from_str(text: &str) -> Result<Self, ShardError> {
        let (number, of) = text.split_once('/').ok_or(ShardError::NotAShard)?;
        let whole = |part: &str| part.trim().parse::<u64>().map_err(|_| ShardError::NotAShard);
        Self::new(whole(number)?, whole(of)?)
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_case_is_in_one_shard() {
        for of in 1..=5 {
            let mut all: Vec<u64> = (1..=of).flat_map(|k| Shard::new(k, of).unwrap().cases(17)).collect();
            all.sort_unstable();
            assert_eq!(all, (0..17).collect::<Vec<_>>());
            let shards = (1..=of).map(|k| Shard::new(k, of).unwrap());
            assert!(shards.clone().all(|shard| shard.count(17) == shard.cases(17).count() as u64));
            for shard in shards {
                let places: Vec<u64> = (0..17).filter_map(|case| shard.place(case)).collect();
                assert_eq!(places, (0..shard.count(17)).collect::<Vec<_>>());
            }
            assert_eq!(Shard::new(of, of).unwrap().count(0), 0);
        }
    }

    #[test]
    fn cases_are_run_from_everywhere_and_each_once() {
        for total in [0, 1, 2, 3, 17, 128, 129, 1000, 10_007] {
            for shard in [Shard::ALL, Shard::new(2, 3).unwrap()] {
                let order: Vec<u64> = shard.spread(total).collect();
                let mut all = order.clone();
                all.sort_unstable();
                assert_eq!(all, shard.cases(total).collect::<Vec<_>>());
                // The mean of the first tenth of a ramp is near that of all; in ascending order it would be a tenth of it.
                let tenth = order.len() / 10;
                let mean = order.iter().take(tenth).sum::<u64>() as f64 / tenth as f64;
                assert!(tenth < 10 || (mean / total as f64 - 0.5).abs() < 0.1, "{total}: {mean}");
                // Most follow their neighbour in large studies.
                let next = order.windows(2).filter(|pair| pair[1] == pair[0] + shard.of()).count();
                assert!(total < 10_000 || next as f64 > 0.95 * order.len() as f64, "{total}: {next}");
            }
        }
    }

    #[test]
    fn what_is_no_shard_is_refused_with_what_would_be_one() {
        assert_eq!("2/8".parse(), Shard::new(2, 8));
        for (text, error) in [
            ("2", "write I/N, such as 2/8 for the second of eight shards"),
            ("a/b", "write I/N, such as 2/8 for the second of eight shards"),
            ("0/4", "there is no shard 0 of 4: the first is 1/4, the last 4/4"),
            ("5/4", "there is no shard 5 of 4: the first is 1/4, the last 4/4"),
            ("1/0", "a study has at least one shard"),
        ] {
            assert_eq!(text.parse::<Shard>().unwrap_err().to_string(), error);
        }
    }
}
