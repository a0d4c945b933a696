//! The stored bounds of the rows, `validation/bounds.toml`: a row that gets worse than its own fails the run.

use super::measure::Measured;
use crate::case::Result;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// Where they are, from the workspace's root.
pub(crate) const FILE: &str = "validation/bounds.toml";

/// A row's bounds.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub(crate) struct Bound {
    ended: String,
    gain: f64,
    residual: f64,
    penetration: f64,
    solver: f64,
    unconverged: u64,
    iterations: u64,
    solves: u64,
}

/// By row.
pub(crate) type Bounds = BTreeMap<String, Bound>;

/// Reads them.
pub(crate) fn read(file: &Path) -> Result<Bounds> {
    let text = std::fs::read_to_string(file)
        .map_err(|error| format!("{}: {error}; run from the root of the workspace", file.display()))?;
    Ok(toml::from_str(&text).map_err(|error| format!("{}: {error}", file.display()))?)
}

/// Rounding differs from one kind of processor to another: below this a relative number has no digits.
const ROUNDING: f64 = 1e-14;

/// Twice the number, to the next of 1, 2, 5 upwards.
fn room(value: f64) -> f64 {
    let twice = (2.0 * value).max(ROUNDING);
    if !twice.is_finite() {
        return f64::MAX;
    }
    let decade = 10_f64.powf(twice.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|part| part * decade).find(|bound| *bound >= twice).unwrap_or(twice)
}

/// A gain above this is no rounding but the scheme's, and the largest of a run in which rounding moves the impacts: by chance it is several
/// times larger in another one.
const CHANCE: f64 = 1e-10;

/// A penetration below this part of what is allowed is none: what it is there goes by rounding and by the solver's error.
const SHALLOW: f64 = 1e-3;

/// A step with so many iterations was searched for by iteration; in another run one such step may not be solved at all, and then its
/// solvers have done all that they may.
const SEARCH: u64 = 20;

/// Iterations of a step that is given up.
const GIVEN_UP: u64 = 20_000;

impl Bound {
    /// The bounds that a row is held to from now on.
    pub(crate) fn around(measured: &Measured) -> Self {
        let searched = measured.iterations >= SEARCH;
        Self {
            ended: measured.ending.word().to_owned(),
            gain: if measured.gain > CHANCE { room(5.0 * measured.gain) } else { room(measured.gain.max(0.0)) },
            residual: room(measured.residual),
            penetration: room(measured.penetration).max(SHALLOW),
            solver: 1.0,
            unconverged: 2 * measured.unconverged + u64::from(searched),
            iterations: if searched { (2 * measured.iterations).max(GIVEN_UP) } else { 2 * measured.iterations },
            solves: 2 * measured.solves,
        }
    }

    /// In what a row is worse, in words.
    pub(crate) fn worse(&self, measured: &Measured) -> Vec<String> {
        let mut worse = Vec::new();
        if measured.ending.word() != self.ended {
            worse.push(format!("it was {}, and is {}", self.ended, measured.ending.word()));
        }
        let numbers = [
            ("gain", measured.gain, self.gain),
            ("residual", measured.residual, self.residual),
            ("penetration", measured.penetration, self.penetration),
            ("solver's residual", measured.solver, self.solver),
        ];
        // Written so that NaN is worse.
        let numbers = numbers.into_iter().filter(|(_, value, bound)| !(value <= bound));
        worse.extend(numbers.map(|(what, value, bound)| format!("{what} {value:.1e}, bound {bound:.0e}")));
        let counts = [
            ("unconverged steps", measured.unconverged, self.unconverged),
            ("iterations of a step", measured.iterations, self.iterations),
            ("solves of a step", measured.solves, self.solves),
        ];
        let counts = counts.into_iter().filter(|(_, value, bound)| value > bound);
        worse.extend(counts.map(|(what, value, bound)| format!("{what} {value}, bound {bound}")));
        worse
    }
}

/// The file.
pub(crate) fn write(bounds: &Bounds) -> Result<String> {
    let mut text = String::from(
        "# What the rows of docs/extremes.md are held to: twice what was measured (a gain that isn't rounding: ten times), rounded up to 1, 2 or 5. Written by\n\
         #     cargo run --release -p teeter-validation -- --extremes --write-bounds\n\
         # gain, residual: parts of the scene's energy scale; penetration: part of its own bound; solver: part of the tolerance.\n\n",
    );
    for (name, b) in bounds {
        writeln!(
            text,
            "{name:?} = {{ ended = {:?}, gain = {:e}, residual = {:e}, penetration = {:e}, solver = {:e}, unconverged = {}, iterations = {}, solves = {} }}",
            b.ended, b.gain, b.residual, b.penetration, b.solver, b.unconverged, b.iterations, b.solves
        )?;
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bound_leaves_room_and_no_more_than_five_times() {
        assert_eq!(room(0.0), ROUNDING);
        assert_eq!(room(3e-3), 1e-2);
        for value in [1e-9, 1.1e-9, 2.4e-9, 2.6e-9, 9.9e-9] {
            assert!((2.0..5.001).contains(&(room(value) / value)), "{value}");
        }
    }

    #[test]
    fn what_is_written_is_read_again() {
        let bound = Bound {
            ended: "complete".to_owned(),
            gain: 1e-14,
            residual: 2e-13,
            penetration: 0.5,
            solver: 1.0,
            unconverged: 0,
            iterations: 8,
            solves: 2,
        };
        let bounds = Bounds::from([("a/1e-6/beam/open/e=0".to_owned(), bound)]);
        let read: Option<Bounds> = write(&bounds).ok().and_then(|text| toml::from_str(&text).ok());
        assert_eq!(read, Some(bounds));
    }
}
