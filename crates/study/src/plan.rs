//! Which settings are tried: not the full grid, but in stages, each from what the ones before it showed.

use crate::axes::Axes;
use crate::recommend::{TARGETS, cheapest};
use crate::row::{differ, front_of};
use crate::{Row, Setting};

/// How many stages there are at the most.
pub(crate) const STAGES: usize = 6;

/// Rounds of the last stage at the most.
pub(crate) const CONFIRMATIONS: usize = 8;

/// What each stage tries, for people.
pub const TOLD: [&str; 5] = [
    "every scheme with every step, all else as in the scene",
    "every option of every other axis, one at a time, on the scene as it is",
    "those of them that changed accuracy or cost by more than 5 %, one at a time, on the cheapest setting so far for each accuracy asked for and on the most \
     accurate one",
    "what came onto the front so far, alone and all that goes together at once, with the two coarser and the two finer steps and with the other schemes; \
     once more while that brings something new",
    "the next finer step of what is the cheapest so far for each accuracy: accuracy that it does not confirm was luck, and the next cheapest is confirmed in its place",
];

/// The settings of a stage (from 1), in an order that is the same in every run; those tried already are left out. `takes` says whether a
/// setting makes a scene, `bar` is the error bar of the accuracy.
pub(crate) fn stage(
    stage: usize,
    axes: &Axes,
    rows: &[Row],
    bar: f64,
    takes: &dyn Fn(&Setting) -> bool,
) -> Vec<Setting> {
    let wanted = match stage {
        1 => schemes_and_steps(axes),
        2 => one_at_a_time(axes, &[Setting::none()], takes),
        3 => {
            let own = rows.iter().find(|row| row.setting.is_none());
            let matters = |setting: &Setting| {
                let tried = rows.iter().find(|row| row.setting == *setting);
                own.zip(tried).is_none_or(|(own, tried)| differ(own, tried))
            };
            let mut axes = axes.clone();
            axes.others.iter_mut().for_each(|axis| axis.options.retain(|option| option.is_none() || matters(option)));
            one_at_a_time(&axes, &bases(&axes, rows, bar), takes)
        }
        4 | 5 => together(axes, rows, bar, takes),
        _ => {
            let chosen = TARGETS.iter().filter_map(|&target| cheapest(rows, axes, target, bar));
            chosen.filter_map(|row| axes.finer(&rows[row].setting)).collect()
        }
    };
    let mut new: Vec<Setting> = Vec::new();
    for setting in wanted {
        if !new.contains(&setting) && rows.iter().all(|row| row.setting != setting) {
            new.push(setting);
        }
    }
    new
}

fn schemes_and_steps(axes: &Axes) -> Vec<Setting> {
    let schemes = axes.scheme.options.iter();
    schemes.flat_map(|scheme| axes.step.options.iter().map(|step| scheme.clone().with(step))).collect()
}

/// The scene as it is, the cheapest for each target, and the most accurate.
fn bases(axes: &Axes, rows: &[Row], bar: f64) -> Vec<Setting> {
    let most_accurate = front_of(rows).last().copied();
    let chosen = TARGETS.iter().filter_map(|&target| cheapest(rows, axes, target, bar)).chain(most_accurate);
    let mut bases = vec![Setting::none()];
    for setting in chosen.map(|row| rows[row].setting.clone()) {
        if !bases.contains(&setting) {
            bases.push(setting);
        }
    }
    bases
}

fn one_at_a_time(axes: &Axes, bases: &[Setting], takes: &dyn Fn(&Setting) -> bool) -> Vec<Setting> {
    let mut settings = Vec::new();
    for base in bases {
        for axis in &axes.others {
            let options: Vec<Setting> = axis.options.iter().map(|option| axis.apply(option, base)).collect();
            // An axis that a scheme knows in one value only, as θ may be, is none with it.
            if options.iter().any(|setting| setting != base && takes(setting)) {
                settings.extend(options);
            }
        }
    }
    settings
}

fn together(axes: &Axes, rows: &[Row], bar: f64, takes: &dyn Fn(&Setting) -> bool) -> Vec<Setting> {
    let front: Vec<&Setting> = front_of(rows).into_iter().map(|row| &rows[row].setting).collect();
    let mut centres: Vec<Setting> = front.iter().map(|setting| (*setting).clone()).collect();
    // Of each axis, what came onto the front, all of it on each base: the last on the front is the most accurate.
    for base in bases(axes, rows, bar) {
        let cheap = axes.others.iter().fold(base.clone(), |setting, axis| {
            let best = front.iter().map(|front| axis.part_of(front)).find(|part| !part.is_none());
            best.map_or(setting.clone(), |part| axis.apply(&part, &setting))
        });
        let accurate = axes.others.iter().fold(base, |setting, axis| {
            let best = front.iter().rev().map(|front| axis.part_of(front)).find(|part| !part.is_none());
            best.map_or(setting.clone(), |part| axis.apply(&part, &setting))
        });
        centres.extend([cheap, accurate]);
    }
    let mut settings = Vec::new();
    for centre in centres.iter().filter(|centre| takes(centre)) {
        settings.extend(axes.near(centre));
        settings.extend(axes.scheme.options.iter().map(|scheme| axes.scheme.apply(scheme, centre)).filter(takes));
    }
    settings
}

impl Axes {
    /// The number of a setting's step on the ladder.
    fn rung(&self, setting: &Setting) -> Option<usize> {
        let step = self.step.part_of(setting);
        self.step.options.iter().position(|option| *option == step)
    }

    fn at_rung(&self, setting: &Setting, rung: usize) -> Option<Setting> {
        Some(self.step.apply(self.step.options.get(rung)?, setting))
    }

    /// The same setting with the next finer step; `None` at the end of the ladder.
    #[must_use]
    pub fn finer(&self, setting: &Setting) -> Option<Setting> {
        self.at_rung(setting, self.rung(setting)? + 1)
    }

    /// The same setting, and that with the two coarser and the two finer steps.
    fn near(&self, setting: &Setting) -> Vec<Setting> {
        let Some(rung) = self.rung(setting) else { return vec![setting.clone()] };
        (rung.saturating_sub(2)..=rung + 2).filter_map(|rung| self.at_rung(setting, rung)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axes::Axis;
    use crate::{Done, Errors, Work};

    fn axis(name: &'static str, key: &str, words: &[&str]) -> Axis {
        let options = words.iter().map(|word| Setting::none().set(key, *word));
        Axis { name, keys: vec![key.to_owned()], options: std::iter::once(Setting::none()).chain(options).collect() }
    }

    fn axes() -> Axes {
        let mut step = axis("step", "time.step", &["4", "1"]);
        step.options.swap(0, 1);
        Axes {
            scheme: axis("scheme", "time.scheme", &["b"]),
            step,
            others: vec![axis("mesh", "elements", &["10", "40"]), axis("theta", "theta", &["1"])],
        }
    }

    /// A row whose work is `steps`.
    fn row(setting: Setting, steps: u64, accuracy: f64) -> Row {
        let work = Work { steps, ..Work::default() };
        let result = Ok(Done { errors: Errors::of_accuracy(accuracy), work, unconverged: 0 });
        Row { setting, stage: 1, result, cpu: None }
    }

    #[test]
    fn the_first_stage_is_every_scheme_with_every_step() {
        let settings = stage(1, &axes(), &[], 0.0, &|_| true);
        assert_eq!(settings.len(), 6);
        assert_eq!(settings[1], Setting::none());
        let known = row(Setting::none(), 1, 0.1);
        assert_eq!(stage(1, &axes(), &[known], 0.0, &|_| true).len(), 5, "nothing is tried twice");
    }

    #[test]
    fn other_axes_are_tried_on_the_scene_first_and_what_matters_on_what_is_worth_it() {
        let step = |word: &str| Setting::none().set("time.step", word);
        let mut rows = vec![row(step("4"), 10, 0.05), row(Setting::none(), 20, 0.2), row(step("1"), 40, 0.04)];
        // θ is refused with the fine step: there it is no axis.
        let takes = |setting: &Setting| setting.get("theta").is_none() || setting.get("time.step") != Some("1");
        let texts = |settings: Vec<Setting>| settings.iter().map(ToString::to_string).collect::<Vec<_>>();
        let second = stage(2, &axes(), &rows, 0.0, &takes);
        assert_eq!(texts(second), ["--set elements=10", "--set elements=40", "--set theta=1"]);
        rows.push(row(Setting::none().set("elements", "10"), 10, 0.2));
        rows.push(row(Setting::none().set("elements", "40"), 20, 0.2));
        rows.push(row(Setting::none().set("theta", "1"), 20, 0.1));
        assert_eq!(
            texts(stage(3, &axes(), &rows, 0.0, &takes)),
            ["--set elements=10 --set theta=1", "--set elements=10 --set time.step=1"],
            "40 elements changed nothing, and the coarse step was luck, as its finer one is worse"
        );
    }

    #[test]
    fn the_last_stage_confirms_what_would_be_advised() {
        let own = Setting::none();
        let rows = [row(own.clone(), 20, 0.2), row(own.clone().set("elements", "10"), 10, 0.05)];
        assert_eq!(
            stage(6, &axes(), &rows, 0.0, &|_| true),
            [own.set("elements", "10").set("time.step", "1")],
            "the cheapest for 10 %; for the others there is none"
        );
    }

    #[test]
    fn the_fourth_stage_brings_together_what_helped_with_the_steps_near_it() {
        let own = Setting::none();
        let rows = [
            row(own.clone(), 20, 0.04),
            row(own.clone().set("elements", "10"), 10, 0.05),
            row(own.clone().set("theta", "1"), 30, 0.01),
            row(own.clone().set("elements", "40"), 90, 0.02),
        ];
        let settings = stage(4, &axes(), &rows, 0.0, &|_| true);
        let both = own.clone().set("elements", "10").set("theta", "1");
        assert!(settings.contains(&both));
        assert!(settings.contains(&both.clone().set("time.step", "4")));
        assert!(settings.contains(&both.set("time.scheme", "b")));
        assert!(!settings.iter().any(|setting| setting.get("elements") == Some("40")), "was not on the front");
        assert_eq!(settings, stage(4, &axes(), &rows, 0.0, &|_| true), "the same in every run");
    }
}
