//! Which setting to take for which accuracy: by counted work, so that every run of the study says the same.

use crate::Row;
use crate::axes::Axes;

/// The accuracies that are asked for.
pub const TARGETS: [f64; 4] = [1e-1, 1e-2, 1e-3, 1e-4];

/// The measured time overrules the counted work where it says that another setting takes less than this part of the time.
const CONTRADICTION: f64 = 0.5;

/// What to take for an accuracy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Advice {
    /// A row, by its number.
    Take {
        /// The row.
        row: usize,
        /// Whether the measured time overruled the counted work.
        overruled: bool,
    },
    /// No setting that was tried is known to be as accurate.
    NotReached,
    /// The reference itself is not known as well as that.
    NotMeasurable,
}

/// Whether a row is known to be as accurate as `target`: its difference from the reference and the reference's error bar together. One that the next
/// finer step of the same setting doesn't confirm was luck.
#[must_use]
pub fn meets(rows: &[Row], axes: &Axes, row: usize, target: f64, bar: f64) -> bool {
    let within = |row: &Row| row.accuracy().is_some_and(|accuracy| accuracy + bar <= target);
    let Some(this) = rows.get(row) else { return false };
    let finer = axes.finer(&this.setting);
    let confirmed = rows.iter().find(|row| Some(&row.setting) == finer.as_ref()).is_none_or(within);
    within(this) && confirmed
}

/// The least work among the rows that meet a target; of equals the one that changes least, then the first.
#[must_use]
pub(crate) fn cheapest(rows: &[Row], axes: &Axes, target: f64, bar: f64) -> Option<usize> {
    let work = |k: usize| rows[k].modelled().unwrap_or(f64::INFINITY);
    (0..rows.len()).filter(|&k| meets(rows, axes, k, target, bar)).min_by(|&a, &b| {
        work(a).total_cmp(&work(b)).then(rows[a].setting.len().cmp(&rows[b].setting.len())).then(a.cmp(&b))
    })
}

/// The advice for a target.
#[must_use]
pub fn advise(rows: &[Row], axes: &Axes, target: f64, bar: f64) -> Advice {
    if bar >= target {
        return Advice::NotMeasurable;
    }
    let Some(chosen) = cheapest(rows, axes, target, bar) else { return Advice::NotReached };
    let time = |k: usize| rows[k].measured();
    let fastest = (0..rows.len())
        .filter(|&k| time(k).is_some() && meets(rows, axes, k, target, bar))
        .min_by(|&a, &b| time(a).unwrap_or(f64::INFINITY).total_cmp(&time(b).unwrap_or(f64::INFINITY)));
    match (fastest, time(chosen)) {
        (Some(fastest), Some(own)) if time(fastest).is_some_and(|time| time < CONTRADICTION * own) => {
            Advice::Take { row: fastest, overruled: true }
        }
        _ => Advice::Take { row: chosen, overruled: false },
    }
}
