//! The results of a study in sentences.

use super::{duration, percent, short};
use crate::setting::as_arguments;
use crate::{Advice, PERTURBATION, Quantity, Row, SEARCH_STAGES, TARGETS, Tradeoff};

/// A sentence for each accuracy: the advised setting, as arguments to copy, or why there is none.
#[must_use]
pub fn advice(study: &Tradeoff) -> Vec<String> {
    let until = until(study);
    let one = |(target, advice): (&f64, &Advice)| {
        let target = format!("{} of accuracy {until}", percent(*target));
        match advice {
            Advice::NotMeasurable => {
                format!("{target}: not measurable: the reference has an error bar of {}", percent(study.bar()))
            }
            Advice::NotReached => format!(
                "{target}: none of the settings tried is known to reach it: the best is off by at most {}",
                off_by(study, study.best().unwrap_or(f64::INFINITY))
            ),
            Advice::BeforeImpact => format!("{target}: nothing is advised: {}", before_impact(study)),
            Advice::Warned(row) => {
                let row = &study.rows[*row];
                format!(
                    "{target}: nothing is advised: `check` or `run` warns of every setting tried that is known to reach it; of the cheapest, {}, \
                     that {}",
                    taken(study, row),
                    row.warned().iter().map(|warned| warned.text.as_str()).collect::<Vec<_>>().join("; and that ")
                )
            }
            Advice::Take { row, faster, confirmed } => {
                let row = &study.rows[*row];
                let unconfirmed = if *confirmed { "" } else { "; not confirmed by a finer step" };
                let faster = faster.map(|row| &study.rows[row]).map_or_else(String::new, |row| {
                    format!(
                        "; it is the cheapest by counted work, but {} was measured in less than half the time, {}",
                        taken(study, row),
                        row.measured().map_or_else(String::new, duration)
                    )
                });
                let warned = match row.warned() {
                    [] => String::new(),
                    warned => format!(
                        "; with any setting `check` or `run` warns of the scene: {}",
                        warned.iter().map(|warned| warned.text.as_str()).collect::<Vec<_>>().join("; ")
                    ),
                };
                format!("for {target} use {}: {}{faster}{unconfirmed}{warned}", taken(study, row), cost(study, row))
            }
        }
    };
    if study.best().is_none() {
        return vec!["nothing moves before the horizon, so there is nothing to choose".to_owned()];
    }
    TARGETS.iter().zip(&study.advice).map(one).collect()
}

/// The validity of the advice.
fn until(study: &Tradeoff) -> String {
    if study.reference.whole {
        format!("over the whole {} s", study.end)
    } else {
        format!("up to t = {} s of {} s", study.reference.norms.horizon(), study.end)
    }
}

/// Why the horizon is too short.
fn before_impact(study: &Tradeoff) -> String {
    let horizon = study.reference.norms.horizon();
    match (study.reference.first_impact, study.axes.scheme.options.len()) {
        (Some(impact), schemes) => format!(
            "motions can be compared only up to {horizon} s, but the first impact of block {} is at {} s, and up to {} s should be compared to see \
             its effect; none of {schemes} schemes has a longer horizon",
            impact.block + 1,
            short(impact.t),
            short(impact.until)
        ),
        (None, _) => format!("motions can be compared only up to {horizon} s"),
    }
}

/// The largest error of a setting, with its parts.
fn off_by(study: &Tradeoff, accuracy: f64) -> String {
    format!(
        "{}: a difference of {} plus the error bar of {}",
        percent(accuracy + study.bar()),
        percent(accuracy),
        percent(study.bar())
    )
}

/// The setting of a row as arguments to copy, the user's own first.
pub(crate) fn taken(study: &Tradeoff, row: &Row) -> String {
    let own: Vec<_> = study.sets.iter().filter(|(key, _)| row.setting.get(key).is_none()).cloned().collect();
    let texts = [as_arguments(&own), row.setting.to_string()];
    let texts: Vec<&str> = texts.iter().map(String::as_str).filter(|text| !text.is_empty()).collect();
    if texts.is_empty() { "the unchanged scene".to_owned() } else { format!("`{}`", texts.join(" ")) }
}

fn cost(study: &Tradeoff, row: &Row) -> String {
    let accuracy =
        row.accuracy().map_or_else(String::new, |accuracy| format!(" (off by at most {})", off_by(study, accuracy)));
    match row.measured() {
        Some(time) => format!("{} of CPU time, {:.2e} × real time{accuracy}", duration(time), time / study.end),
        None => format!("no time measured{accuracy}"),
    }
}

/// How the advice was obtained: horizon, error bars, the unchanged scene.
#[must_use]
pub fn findings(study: &Tradeoff) -> Vec<String> {
    let reference = &study.reference;
    let norms = &reference.norms;
    let mut texts = vec![format!("reference: {}", reference.setting)];
    texts.push(if reference.whole {
        format!(
            "horizon: the whole run of {} s; perturbed by {PERTURBATION:e} or with twice the step, the reference stays within {} of the motion",
            study.end,
            percent(reference.share)
        )
    } else {
        format!(
            "horizon: {} s of {} s; beyond it the reference, perturbed by {PERTURBATION:e} or with twice the step, differs by more than {} of the motion, and nothing is compared",
            norms.horizon(),
            study.end,
            percent(reference.share)
        )
    });
    if let Some(impact) = reference.first_impact {
        texts.push(format!(
            "first impacts: compared up to at least {} s; the last block to have an impact has its first at {} s",
            short(impact.until),
            short(impact.t)
        ));
    }
    let warned = study.rows.iter().filter(|row| !row.warned().is_empty()).count();
    if warned > 0 {
        texts.push(format!(
            "warnings: `check` or `run` warns of {warned} of the {} settings tried; such a setting is advised only if the reference and all settings of that accuracy \
             have the same warnings",
            study.rows.len()
        ));
    }
    let bars = Quantity::ALL.into_iter().filter_map(|quantity| {
        let bar = reference.bar.of(quantity).filter(|_| quantity != Quantity::Penetration)?;
        Some(format!("{} {}", quantity.title().to_lowercase(), percent(bar)))
    });
    let bars: Vec<_> = bars.collect();
    if !bars.is_empty() {
        texts.push(format!("error bars of the reference: {}", bars.join(", ")));
    }
    let absent = Quantity::ALL.into_iter().filter(|quantity| match study.own().map(|row| &row.result) {
        Some(Ok(done)) => done.errors.of(*quantity).is_none(),
        _ => false,
    });
    let absent: Vec<_> = absent.map(|quantity| quantity.title().to_lowercase()).collect();
    if !absent.is_empty() {
        texts.push(format!("not present before the horizon: {}", absent.join(", ")));
    }
    if let Some(row) = study.own() {
        texts.push(match &row.result {
            Ok(_) => format!("the unchanged scene: {}", cost(study, row)),
            Err(failure) => format!("the unchanged scene: {failure}"),
        });
    }
    texts
}

/// How the grid was pruned.
#[must_use]
pub fn pruning(study: &Tradeoff) -> Vec<String> {
    let stages = (1..).zip(SEARCH_STAGES).map(|(number, description)| format!("stage {number}: {description}"));
    let axes = study.axes.iter().map(|axis| format!("{} {}", axis.options.len(), axis.name));
    let mut texts: Vec<String> = stages.collect();
    texts.push(format!(
        "{} of the {} settings of the full grid ({}) were tried",
        study.rows.len(),
        study.grid(),
        axes.collect::<Vec<_>>().join(" × ")
    ));
    if !study.too_expensive.is_empty() {
        texts.push(format!("{} more were left out as too expensive by counted work", study.too_expensive.len()));
    }
    texts
}
