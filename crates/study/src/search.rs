//! Selects the settings to try: cheapest first, by counted work, until no remaining one could be
//! cheaper than those known to reach the accuracies.

use crate::axes::Axes;
use crate::recommend::{ConfirmedErrors, TARGETS, cheapest, eligible};
use crate::row::differ;
use crate::{Row, Setting, SettingWarning, Work};
use std::collections::BTreeSet;

/// The stages of the search, for users.
pub const SEARCH_STAGES: [&str; 5] = [
    "every scheme with every step, everything else as in the scene",
    "every option of every other axis, one at a time, on the unchanged scene",
    "from the cheapest setting so far for each accuracy, all settings that differ on one axis and should be cheaper, as long as that finds any",
    "all combinations of schemes, steps, θ, meshes and modes, cheapest first by counted work, until no remaining one could be cheaper than what \
     is known to reach each accuracy that can be measured, or the work allowed is used up",
    "with each of these, the two next finer steps of the cheapest setting so far for an accuracy: accuracy that they don't confirm was chance, and the next cheapest is \
     confirmed in its place",
];

/// Number of settings tried before their results are used; fixed, so that it is the same on any
/// number of cores.
const BATCH: usize = 16;

/// Number of finer steps that confirm a setting.
const CONFIRMING: usize = 2;

/// A setting to be tried, with a lower bound on its cost, s.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PlannedSetting {
    pub(crate) setting: Setting,
    pub(crate) least: f64,
}

/// The state of the search.
pub(crate) struct SearchState<'a> {
    axes: &'a Axes,
    rows: &'a [Row],
    tried: BTreeSet<&'a Setting>,
    /// The cheapest row for each measurable accuracy.
    cheapest: Vec<Option<usize>>,
}

impl<'a> SearchState<'a> {
    /// From the rows, the error bar of the accuracy, and the warnings of the reference.
    pub(crate) fn new(axes: &'a Axes, rows: &'a [Row], bar: f64, warned: &[SettingWarning]) -> Self {
        let held = ConfirmedErrors::of(rows, axes);
        let targets = TARGETS.into_iter().filter(|target| bar < *target);
        let of = |target: f64| cheapest(rows, &eligible(rows, &held, target, bar, warned));
        Self { axes, rows, tried: rows.iter().map(|row| &row.setting).collect(), cheapest: targets.map(of).collect() }
    }

    /// Settings above this cost, s, can't be the cheapest for any accuracy; infinite while none is
    /// known for one of them.
    fn bound(&self) -> f64 {
        let cost = |row: &Option<usize>| row.and_then(|row| self.rows[row].modelled()).unwrap_or(f64::INFINITY);
        self.cheapest.iter().map(cost).fold(0.0, f64::max)
    }

    fn chosen(&self) -> impl Iterator<Item = &Setting> {
        self.cheapest.iter().flatten().map(|&row| &self.rows[row].setting)
    }

    /// The settings that would confirm the cheapest ones so far, or refute them.
    pub(crate) fn unconfirmed(&self) -> Vec<Setting> {
        let mut wanted = Vec::new();
        for setting in self.chosen() {
            let finer = std::iter::successors(self.axes.finer(setting), |one| self.axes.finer(one));
            wanted.extend(finer.take(CONFIRMING));
        }
        self.new_ones(wanted)
    }

    /// Every scheme with every step.
    pub(crate) fn plain(&self) -> Vec<Setting> {
        let schemes = self.axes.scheme.options.iter();
        self.new_ones(schemes.flat_map(|scheme| self.axes.ladder(scheme)).collect())
    }

    /// Every option of every other axis, on the unchanged scene.
    pub(crate) fn one_at_a_time(&self) -> Vec<Setting> {
        let axes = self.axes.grid.iter().chain(&self.axes.others);
        self.new_ones(axes.flat_map(|axis| axis.options.iter().cloned()).collect())
    }

    /// Settings that differ on one axis from the cheapest so far: steps, and options that changed
    /// something on the unchanged scene, or may do so.
    pub(crate) fn beside_the_cheapest(&self) -> Vec<Setting> {
        let own = self.rows.iter().find(|row| row.setting.is_none());
        let side: Vec<Setting> = self.axes.others.iter().flat_map(|axis| axis.options.clone()).collect();
        let idle = |row: &Row| side.contains(&row.setting) && own.is_some_and(|own| !differ(own, row));
        let idle: Vec<&Setting> = self.rows.iter().filter(|row| idle(row)).map(|row| &row.setting).collect();
        let changes_nothing = |one: &Setting| {
            self.axes.others.iter().any(|axis| {
                let part = axis.part_of(one);
                !part.is_none() && idle.contains(&&part)
            })
        };
        let mut wanted = Vec::new();
        for setting in self.chosen() {
            wanted.extend(self.axes.neighbours(setting));
        }
        wanted.retain(|one| !changes_nothing(one));
        self.new_ones(wanted)
    }

    /// Whether a setting with this least cost could be advised for some accuracy.
    pub(crate) fn could_be_cheapest(&self, least: f64) -> bool {
        least < self.bound()
    }

    /// The next settings of the grid, cheapest first, without those that could not be advised.
    pub(crate) fn next_of_grid(&self, grid: &[PlannedSetting], too_expensive: &BTreeSet<Setting>) -> Vec<Setting> {
        let bound = self.bound();
        let open = grid.iter().take_while(|one| one.least < bound);
        let open = open.filter(|one| !self.tried.contains(&one.setting) && !too_expensive.contains(&one.setting));
        open.take(BATCH).map(|one| one.setting.clone()).collect()
    }

    fn new_ones(&self, wanted: Vec<Setting>) -> Vec<Setting> {
        let mut new: Vec<Setting> = Vec::new();
        for setting in wanted {
            if !new.contains(&setting) && !self.tried.contains(&setting) {
                new.push(setting);
            }
        }
        new
    }
}

/// All combinations that can be run, sorted by a lower bound on their cost; `expect` returns the
/// cost of a setting, `None` if it can't be run. The cost of a step doesn't depend on their number,
/// so one of each ladder is evaluated.
pub(crate) fn grid(axes: &Axes, steps: &[f64], expect: &dyn Fn(&Setting) -> Option<Work>) -> Vec<PlannedSetting> {
    let mut all = Vec::new();
    for combination in axes.combinations() {
        let Some(work) = expect(&combination) else { continue };
        for (setting, &count) in axes.ladder(&combination).into_iter().zip(steps) {
            let least = Work { steps: count as u64, ..work }.seconds();
            all.push(PlannedSetting { setting, least });
        }
    }
    // A stable sort, so that equally cheap settings stay in the order of the axes.
    all.sort_by(|a, b| a.least.total_cmp(&b.least));
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axes::SettingAxis;
    use crate::{CompletedRun, Errors};

    fn axis(name: &'static str, key: &str, words: &[&str]) -> SettingAxis {
        let options = words.iter().map(|word| Setting::none().set(key, *word));
        SettingAxis {
            name,
            keys: vec![key.to_owned()],
            options: std::iter::once(Setting::none()).chain(options).collect(),
        }
    }

    /// Steps of 4 (2 own) 1 and ½ ms; the coarser the mesh, the cheaper.
    fn axes() -> Axes {
        let mut step = axis("step", "time.step", &["4", "1", "0.5"]);
        step.options.swap(0, 1);
        Axes {
            scheme: axis("scheme", "time.scheme", &["b"]),
            step,
            grid: vec![axis("mesh", "elements", &["10", "40"]), axis("modes", "modes", &["4", "8"])],
            others: vec![axis("solver", "solver", &["x", "y"])],
        }
    }

    const STEPS: [f64; 4] = [250.0, 500.0, 1000.0, 2000.0];

    fn steps(setting: &Setting) -> u64 {
        let step = setting.get("time.step").map_or(2.0, |step| step.parse::<f64>().unwrap());
        (1000.0 / step) as u64
    }

    fn dofs(setting: &Setting) -> u64 {
        let elements = setting.get("elements").map_or(20, |n| n.parse().unwrap());
        setting.get("modes").map_or(2 * elements, |n| n.parse().unwrap())
    }

    fn work(setting: &Setting) -> Work {
        Work { steps: steps(setting), nodal_dofs: dofs(setting), beams: 1, ..Work::default() }
    }

    /// The error of a made-up scene in which everything hangs together: with scheme b and few modes
    /// long steps do.
    fn error(setting: &Setting) -> f64 {
        let step = 1.0 / steps(setting) as f64;
        let in_time = if setting.get("time.scheme").is_some() { 2.0 * step } else { 20.0 * step };
        let stiff = 0.3 * step * dofs(setting) as f64;
        let in_space = if setting.get("modes") == Some("4") { 0.01 } else { 0.0005 };
        in_time + stiff + in_space
    }

    fn row(setting: &Setting, error: f64) -> Row {
        let errors = Errors::of_accuracy(error);
        let result = Ok(CompletedRun { errors, work: work(setting), unconverged: 0, warned: Vec::new() });
        Row { setting: setting.clone(), stage: 1, result, cpu: None }
    }

    fn known<'a>(axes: &'a Axes, rows: &'a [Row]) -> SearchState<'a> {
        SearchState::new(axes, rows, 0.0, &[])
    }

    #[test]
    fn the_cheapest_of_the_whole_grid_is_found_without_trying_all_of_it() {
        let axes = axes();
        let grid = grid(&axes, &STEPS, &|setting| Some(work(setting)));
        assert_eq!(grid.len(), 2 * 4 * 3 * 3);
        assert!(grid.windows(2).all(|two| two[0].least <= two[1].least));
        let mut rows: Vec<Row> = Vec::new();
        loop {
            let mut next = known(&axes, &rows).unconfirmed();
            if next.is_empty() {
                next = known(&axes, &rows).next_of_grid(&grid, &BTreeSet::new());
            }
            if next.is_empty() {
                break;
            }
            rows.extend(next.iter().map(|setting| row(setting, error(setting))));
        }
        let all: Vec<Row> = grid.iter().map(|one| row(&one.setting, error(&one.setting))).collect();
        let costs = |rows: &[Row]| {
            let known = known(&axes, rows);
            known.cheapest.iter().map(|row| row.map(|row| rows[row].modelled().unwrap())).collect::<Vec<_>>()
        };
        assert_eq!(costs(&rows), costs(&all));
        assert_eq!(costs(&rows).iter().flatten().count(), 2, "10 % and 1 % can be had");
        // The finest accuracies can't: all is tried for them. With the bar above them, the search
        // ends early.
        assert_eq!(rows.len(), all.len());
        let coarse = SearchState::new(&axes, &rows[..2 * BATCH], 0.015, &[]);
        assert!(coarse.bound().is_finite() && !coarse.could_be_cheapest(coarse.bound()));
        let open = coarse.next_of_grid(&grid, &BTreeSet::new());
        assert!(open.iter().all(|one| work(one).seconds() < coarse.bound()));
    }

    #[test]
    fn luck_is_found_out_by_the_finer_steps() {
        let axes = axes();
        let lucky = Setting::none().set("time.step", "4");
        let mut rows = vec![row(&lucky, 0.05)];
        let wanted = known(&axes, &rows).unconfirmed();
        assert_eq!(wanted, [Setting::none(), Setting::none().set("time.step", "1")]);
        rows.push(row(&wanted[0], 0.3));
        rows.push(row(&wanted[1], 0.02));
        let steps = known(&axes, &rows).unconfirmed();
        assert_eq!(steps, [Setting::none().set("time.step", "0.5")], "the next cheapest is confirmed in its place");
    }

    #[test]
    fn an_option_that_changes_nothing_is_not_tried_again() {
        let axes = axes();
        let solver = |word: &str| Setting::none().set("solver", word);
        let mut better = row(&solver("y"), 0.05);
        better.result.as_mut().unwrap().work.steps = 100;
        let rows = [row(&Setting::none(), 0.2), row(&solver("x"), 0.2), better];
        let near = known(&axes, &rows).beside_the_cheapest();
        assert!(near.contains(&solver("y").set("time.scheme", "b")));
        assert!(near.iter().all(|one| one.get("solver") != Some("x")));
        assert!(near.iter().all(|one| rows.iter().all(|row| row.setting != *one)), "nothing is tried twice");
    }
}
