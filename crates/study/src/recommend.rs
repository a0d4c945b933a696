//! Recommends settings for accuracies, by counted work, so that every run of the study gives the
//! same result.

use crate::axes::Axes;
use crate::row::as_cheap;
use crate::setting_warning::of_the_scene;
use crate::{Row, Setting, SettingWarning};
use std::collections::BTreeMap;

/// The target accuracies.
pub const TARGETS: [f64; 4] = [1e-1, 1e-2, 1e-3, 1e-4];

/// Advice follows counted work, so that it is the same in every run. A setting measured in less
/// than this fraction of the time is mentioned too. The fastest run counts, as other load on the
/// machine only adds to the time, by up to a factor of two in the median.
const CONTRADICTION: f64 = 0.5;

/// The advice for an accuracy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Advice {
    /// Use the setting of a row.
    Take {
        /// The row.
        row: usize,
        /// Another row with this accuracy that was measured in less than half the time, if there is
        /// one.
        faster: Option<usize>,
        /// Whether a finer step of the same setting was tried; it then has the accuracy too.
        confirmed: bool,
    },
    /// No setting tried is known to be as accurate.
    NotReached,
    /// `check` or `run` warns of every setting known to be as accurate: this is the index of the
    /// cheapest.
    Warned(usize),
    /// The horizon ends before the first impacts of the scene have been compared.
    BeforeImpact,
    /// The reference is not known to this accuracy.
    NotMeasurable,
}

/// The confirmed error of each row: the largest error of the row and of all finer steps of the same
/// setting that were tried. Accuracy that a finer step doesn't confirm was chance.
#[derive(Debug, Clone, PartialEq)]
pub struct ConfirmedErrors {
    worst: Vec<f64>,
    confirmed: Vec<bool>,
}

impl ConfirmedErrors {
    /// Of the rows tried so far.
    #[must_use]
    pub fn of(rows: &[Row], axes: &Axes) -> Self {
        let mut ladders: BTreeMap<Setting, Vec<(usize, usize)>> = BTreeMap::new();
        for (number, row) in rows.iter().enumerate() {
            if let Some(rung) = axes.rung(&row.setting) {
                let rest = row.setting.clone().without(&axes.step.keys);
                ladders.entry(rest).or_default().push((rung, number));
            }
        }
        let error = |number: usize| rows[number].accuracy().unwrap_or(f64::INFINITY);
        let mut held = Self { worst: (0..rows.len()).map(error).collect(), confirmed: vec![false; rows.len()] };
        for ladder in ladders.values_mut() {
            ladder.sort_unstable();
            for at in (1..ladder.len()).rev() {
                let (coarse, fine) = (ladder[at - 1].1, ladder[at].1);
                held.worst[coarse] = held.worst[coarse].max(held.worst[fine]);
                held.confirmed[coarse] = true;
            }
        }
        held
    }

    /// The rows known to be as accurate as `target`, counting their difference from the reference
    /// and its error bar, also for every finer step tried.
    pub fn meeting(&self, target: f64, bar: f64) -> impl Iterator<Item = usize> + '_ {
        (0..self.worst.len()).filter(move |&row| self.worst[row] + bar <= target)
    }
}

/// The rows that meet a target, without warnings except those of the scene.
#[must_use]
pub(crate) fn eligible(
    rows: &[Row],
    held: &ConfirmedErrors,
    target: f64,
    bar: f64,
    reference: &[SettingWarning],
) -> Vec<usize> {
    let scene = of_the_scene(reference, held.meeting(target, bar).map(|k| rows[k].warned()));
    let clean = |&k: &usize| rows[k].warned().iter().all(|warned| scene.contains(&warned.kind));
    held.meeting(target, bar).filter(clean).collect()
}

/// The row with the least work; among those within 5 % of it the one with the fewest changes to the
/// scene, then the most accurate, then the first.
#[must_use]
pub(crate) fn cheapest(rows: &[Row], among: &[usize]) -> Option<usize> {
    let value = |x: Option<f64>| x.unwrap_or(f64::INFINITY);
    let work = |k: usize| value(rows[k].modelled());
    let least = among.iter().map(|&k| work(k)).fold(f64::INFINITY, f64::min);
    among.iter().copied().filter(|&k| as_cheap(work(k), least)).min_by(|&a, &b| {
        let error = |k: usize| value(rows[k].accuracy());
        rows[a].setting.len().cmp(&rows[b].setting.len()).then(error(a).total_cmp(&error(b))).then(a.cmp(&b))
    })
}

/// The advice for a target, with a reference that has the error bar `bar` and the warnings
/// `reference`.
#[must_use]
pub fn advise(rows: &[Row], axes: &Axes, target: f64, bar: f64, reference: &[SettingWarning]) -> Advice {
    if bar >= target {
        return Advice::NotMeasurable;
    }
    let held = ConfirmedErrors::of(rows, axes);
    let among = eligible(rows, &held, target, bar, reference);
    let Some(chosen) = cheapest(rows, &among) else {
        let meeting: Vec<usize> = held.meeting(target, bar).collect();
        return cheapest(rows, &meeting).map_or(Advice::NotReached, Advice::Warned);
    };
    let time = |k: usize| rows[k].cpu.map(|cpu| cpu.least);
    let fastest = among
        .into_iter()
        .filter(|&k| time(k).is_some())
        .min_by(|&a, &b| time(a).unwrap_or(f64::INFINITY).total_cmp(&time(b).unwrap_or(f64::INFINITY)));
    let contradicts = |&row: &usize| time(row).zip(time(chosen)).is_some_and(|(time, own)| time < CONTRADICTION * own);
    Advice::Take { row: chosen, faster: fastest.filter(contradicts), confirmed: held.confirmed[chosen] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axes::SettingAxis;
    use crate::{CompletedRun, CpuTime, Errors, Setting, Work};

    fn axes() -> Axes {
        let options = ["4", "", "1"].map(|step| match step {
            "" => Setting::none(),
            step => Setting::none().set("time.step", step),
        });
        let nothing = |name| SettingAxis { name, keys: Vec::new(), options: vec![Setting::none()] };
        let step = SettingAxis { name: "step", keys: vec!["time.step".to_owned()], options: options.to_vec() };
        Axes { scheme: nothing("scheme"), step, grid: Vec::new(), others: Vec::new() }
    }

    fn row(setting: Setting, steps: u64, accuracy: f64, time: f64) -> Row {
        let work = Work { steps, ..Work::default() };
        let result =
            Ok(CompletedRun { errors: Errors::of_accuracy(accuracy), work, unconverged: 0, warned: Vec::new() });
        Row { setting, stage: 1, result, cpu: CpuTime::of(vec![time]) }
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
        let held = ConfirmedErrors::of(&rows, &axes);
        let meets = |row: usize, target: f64| held.meeting(target, 0.0).any(|one| one == row);
        assert!(!meets(0, 0.01), "its finer step is off by 2 %");
        assert!(meets(0, 0.05));
        assert!(meets(2, 0.01));
    }

    #[test]
    fn what_is_warned_of_is_not_advised_unless_it_is_of_the_scene() {
        let (mut rows, axes) = (rows(), axes());
        let warn = |row: &mut Row, kind: &str| {
            let warned = SettingWarning { kind: kind.to_owned(), text: String::new() };
            row.result.as_mut().unwrap().warned.push(warned);
        };
        let advice = |rows: &[Row], reference: &[SettingWarning]| match advise(rows, &axes, 0.01, 0.0, reference) {
            Advice::Take { row, .. } => Ok(row),
            other => Err(other),
        };
        let tilted = [SettingWarning { kind: "tilt".to_owned(), text: String::new() }];
        warn(&mut rows[4], "time.step: too coarse");
        assert_eq!(advice(&rows, &[]), Ok(3), "the cheapest is warned of, and so the other mesh is taken");
        rows.iter_mut().for_each(|row| warn(row, "tilt"));
        assert_eq!(advice(&rows, &[]), Err(Advice::Warned(4)), "the reference has no such warning: the settings have");
        assert_eq!(advice(&rows, &tilted), Ok(3), "the reference has it too: it is of the scene");
    }

    #[test]
    fn nothing_is_advised_below_what_the_reference_is_known_to() {
        let (rows, axes) = (rows(), axes());
        assert_eq!(advise(&rows, &axes, 0.01, 0.01, &[]), Advice::NotMeasurable);
        assert_eq!(advise(&rows, &axes, 0.01, 0.00995, &[]), Advice::NotReached, "difference and error bar together");
        assert_eq!(advise(&rows, &axes, 1e-5, 1e-6, &[]), Advice::NotReached);
    }

    #[test]
    fn of_equally_cheap_settings_the_one_that_changes_least_and_is_best_is_taken() {
        let advice = advise(&rows(), &axes(), 0.01, 0.0, &[]);
        assert_eq!(advice, Advice::Take { row: 4, faster: None, confirmed: false });
    }

    #[test]
    fn the_advice_does_not_follow_the_clock_but_tells_a_contradiction() {
        let mut rows = rows();
        // Every time a different one is measured as the fastest, by less than a factor of two.
        for fastest in 0..rows.len() {
            for (k, row) in rows.iter_mut().enumerate() {
                row.cpu = CpuTime::of(vec![if k == fastest { 1.0 } else { 1.9 }]);
            }
            assert_eq!(advise(&rows, &axes(), 0.01, 0.0, &[]), Advice::Take { row: 4, faster: None, confirmed: false });
        }
        rows[2].cpu = CpuTime::of(vec![0.9]);
        assert_eq!(advise(&rows, &axes(), 0.01, 0.0, &[]), Advice::Take { row: 4, faster: Some(2), confirmed: false });
    }
}
