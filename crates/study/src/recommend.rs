//! Which setting to take for which accuracy: by counted work, so that every run of the study says the same.

use crate::Row;
use crate::axes::Axes;
use crate::row::as_cheap;

/// The accuracies that are asked for.
pub const TARGETS: [f64; 4] = [1e-1, 1e-2, 1e-3, 1e-4];

/// The measured time overrules the counted work where it says that another setting takes less than this part of the time. The least of the runs
/// decides: other work on the machine only adds to a time, by up to a factor of two in the median.
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
        /// Whether a finer step of the same setting was tried: it holds the accuracy too, then.
        confirmed: bool,
    },
    /// No setting that was tried is known to be as accurate.
    NotReached,
    /// The reference itself is not known as well as that.
    NotMeasurable,
}

/// Whether a row is known to be as accurate as `target`: its difference from the reference and the reference's error bar together. One that a
/// finer step of the same setting, of all that were tried, doesn't confirm was luck.
#[must_use]
pub fn meets(rows: &[Row], axes: &Axes, row: usize, target: f64, bar: f64) -> bool {
    let within = |row: &Row| row.accuracy().is_some_and(|accuracy| accuracy + bar <= target);
    rows.get(row).is_some_and(within) && finer(rows, axes, row).all(within)
}

/// The rows of the same setting with finer steps.
fn finer<'a>(rows: &'a [Row], axes: &'a Axes, row: usize) -> impl Iterator<Item = &'a Row> {
    let first = rows.get(row).and_then(|row| axes.finer(&row.setting));
    let settings = std::iter::successors(first, |setting| axes.finer(setting));
    settings.filter_map(|setting| rows.iter().find(|row| row.setting == setting))
}

/// The least work among the rows that meet a target; of those within 5 % of it the one that changes least of the scene, then the most accurate,
/// then the first.
#[must_use]
pub(crate) fn cheapest(rows: &[Row], axes: &Axes, target: f64, bar: f64) -> Option<usize> {
    let value = |x: Option<f64>| x.unwrap_or(f64::INFINITY);
    let work = |k: usize| value(rows[k].modelled());
    let meeting: Vec<usize> = (0..rows.len()).filter(|&k| meets(rows, axes, k, target, bar)).collect();
    let least = meeting.iter().map(|&k| work(k)).fold(f64::INFINITY, f64::min);
    meeting.into_iter().filter(|&k| as_cheap(work(k), least)).min_by(|&a, &b| {
        let error = |k: usize| value(rows[k].accuracy());
        rows[a].setting.len().cmp(&rows[b].setting.len()).then(error(a).total_cmp(&error(b))).then(a.cmp(&b))
    })
}

/// The advice for a target.
#[must_use]
pub fn advise(rows: &[Row], axes: &Axes, target: f64, bar: f64) -> Advice {
    if bar >= target {
        return Advice::NotMeasurable;
    }
    let Some(chosen) = cheapest(rows, axes, target, bar) else { return Advice::NotReached };
    let time = |k: usize| rows[k].cpu.map(|cpu| cpu.least);
    let fastest = (0..rows.len())
        .filter(|&k| time(k).is_some() && meets(rows, axes, k, target, bar))
        .min_by(|&a, &b| time(a).unwrap_or(f64::INFINITY).total_cmp(&time(b).unwrap_or(f64::INFINITY)));
    let take =
        |row: usize, overruled| Advice::Take { row, overruled, confirmed: finer(rows, axes, row).next().is_some() };
    match (fastest, time(chosen)) {
        (Some(fastest), Some(own)) if time(fastest).is_some_and(|time| time < CONTRADICTION * own) => {
            take(fastest, true)
        }
        _ => take(chosen, false),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axes::Axis;
    use crate::{Cpu, Done, Errors, Setting, Work};

    fn axes() -> Axes {
        let options = ["4", "", "1"].map(|step| match step {
            "" => Setting::none(),
            step => Setting::none().set("time.step", step),
        });
        let nothing = |name| Axis { name, keys: Vec::new(), options: vec![Setting::none()] };
        let step = Axis { name: "step", keys: vec!["time.step".to_owned()], options: options.to_vec() };
        Axes { scheme: nothing("scheme"), step, others: Vec::new() }
    }

    fn row(setting: Setting, steps: u64, accuracy: f64, time: f64) -> Row {
        let work = Work { steps, ..Work::default() };
        let result = Ok(Done { errors: Errors::of_accuracy(accuracy), work, unconverged: 0 });
        Row { setting, stage: 1, result, cpu: Cpu::of(vec![time]) }
    }

    fn rows() -> Vec<Row> {
        let set = |key: &str, value: &str| Setting::none().set(key, value);
        vec![
            row(set("time.step", "4"), 1000, 0.005, 1.0),
            row(Setting::none(), 4000, 0.02, 4.0),
            row(set("time.step", "1"), 16_000, 0.004, 16.0),
            row(set("mesh", "10"), 3000, 0.009, 3.0),
            row(set("mesh", "5"), 2980, 0.001, 2.9).clone(),
            row(set("mesh", "40").set("theta", "1"), 2950, 0.0001, 2.8),
        ]
    }

    #[test]
    fn luck_is_no_accuracy() {
        let (rows, axes) = (rows(), axes());
        assert!(!meets(&rows, &axes, 0, 0.01, 0.0), "its finer step is off by 2 %");
        assert!(meets(&rows, &axes, 0, 0.05, 0.0));
        assert!(meets(&rows, &axes, 2, 0.01, 0.0));
    }

    #[test]
    fn nothing_is_advised_below_what_the_reference_is_known_to() {
        let (rows, axes) = (rows(), axes());
        assert_eq!(advise(&rows, &axes, 0.01, 0.01), Advice::NotMeasurable);
        assert_eq!(advise(&rows, &axes, 0.01, 0.00995), Advice::NotReached, "difference and error bar together");
        assert_eq!(advise(&rows, &axes, 1e-5, 1e-6), Advice::NotReached);
    }

    #[test]
    fn of_equally_cheap_settings_the_one_that_changes_least_and_is_best_is_taken() {
        let advice = advise(&rows(), &axes(), 0.01, 0.0);
        assert_eq!(advice, Advice::Take { row: 4, overruled: false, confirmed: false });
    }

    #[test]
    fn the_advice_does_not_follow_noise_but_a_contradiction() {
        let mut rows = rows();
        // Every time a different one is measured as the fastest, by less than a factor of two.
        for fastest in 0..rows.len() {
            for (k, row) in rows.iter_mut().enumerate() {
                row.cpu = Cpu::of(vec![if k == fastest { 1.0 } else { 1.9 }]);
            }
            assert_eq!(advise(&rows, &axes(), 0.01, 0.0), Advice::Take { row: 4, overruled: false, confirmed: false });
        }
        rows[2].cpu = Cpu::of(vec![0.9]);
        assert_eq!(advise(&rows, &axes(), 0.01, 0.0), Advice::Take { row: 2, overruled: true, confirmed: false });
    }
}
