//! The results of a study in sentences.

use super::{duration, percent, power, short};
use crate::setting::{as_arguments, as_word};
use crate::{Advice, PERTURBATION, Quantity, Row, SEARCH_STAGES, Setting, TARGETS, Tradeoff};

/// The advice for an accuracy, for users.
pub(super) struct Advised<'a> {
    /// Such as "within 10 % over the whole 1 s".
    pub(super) target: String,
    /// The accuracy.
    pub(super) accuracy: f64,
    /// The setting to take, if there is one.
    pub(super) row: Option<&'a Row>,
    /// What it costs and reaches, or why there is none.
    pub(super) text: String,
}

/// A sentence for each accuracy: the advised setting, as arguments to copy, or why there is none.
#[must_use]
pub fn advice(study: &Tradeoff) -> Vec<String> {
    let sentence = |Advised { target, row, text, .. }: Advised<'_>| match row {
        Some(row) => format!("to be {target} use {}: {text}", taken(study, row)),
        None => format!("{target}: {text}"),
    };
    if study.best().is_none() {
        return vec![NOTHING_MOVES.to_owned()];
    }
    advised(study).into_iter().map(sentence).collect()
}

/// What is said instead of advice where nothing moves.
pub(super) const NOTHING_MOVES: &str = "nothing moves before the horizon, so there is nothing to choose";

/// The advice in parts, one for each accuracy.
pub(super) fn advised(study: &Tradeoff) -> Vec<Advised<'_>> {
    let until = until(study);
    let warnings = |row: &Row| row.warned().iter().map(|warned| warned.text.clone()).collect::<Vec<_>>();
    let one = |(target, advice): (&f64, &Advice)| {
        let accuracy = *target;
        let target = format!("within {} {until}", percent(accuracy));
        let (row, text) = match advice {
            Advice::NotMeasurable => {
                (None, format!("not measurable: the reference has an error bar of {}", percent(study.bar())))
            }
            Advice::NotReached => (
                None,
                format!(
                    "none of the settings tried is known to reach it: the best is off by at most {}",
                    off_by(study, study.best().unwrap_or(f64::INFINITY))
                ),
            ),
            Advice::BeforeImpact => (None, format!("nothing is advised: {}", before_impact(study))),
            Advice::Warned(row) => {
                let row = &study.rows[*row];
                let text = format!(
                    "nothing is advised: `check` or `run` warns of every setting tried that is known to reach it; of the cheapest, {}, that {}",
                    taken(study, row),
                    warnings(row).join("; and that ")
                );
                (None, text)
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
                    _ => {
                        format!("; with any setting `check` or `run` warns of the scene: {}", warnings(row).join("; "))
                    }
                };
                (Some(row), format!("{}{faster}{unconfirmed}{warned}", cost(study, row)))
            }
        };
        Advised { target, accuracy, row, text }
    };
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
        Some(time) => format!("{} of CPU time, {}{accuracy}", duration(time), of_real_time(time / study.end)),
        None => format!("no time measured{accuracy}"),
    }
}

/// A time as a part or multiple of the time simulated.
fn of_real_time(ratio: f64) -> String {
    if ratio < 1.0 && ratio > 0.0 {
        format!("1/{} of real time", short(1.0 / ratio))
    } else {
        format!("{} × real time", short(ratio))
    }
}

/// The command that runs the scene with a setting: the words that name the scene, the user's own
/// settings, and those of the setting.
pub(super) fn command(study: &Tradeoff, scene: &[&str], setting: &Setting) -> String {
    let own: Vec<_> = study.sets.iter().filter(|(key, _)| setting.get(key).is_none()).cloned().collect();
    let words = scene.iter().copied().map(as_word);
    let settings = [as_arguments(&own), setting.to_string()].into_iter().filter(|text| !text.is_empty());
    ["teeter".to_owned(), "run".to_owned()].into_iter().chain(words).chain(settings).collect::<Vec<_>>().join(" ")
}

/// How the advice was obtained: horizon, error bars, the unchanged scene.
#[must_use]
pub fn findings(study: &Tradeoff) -> Vec<String> {
    let reference = &study.reference;
    let norms = &reference.norms;
    let mut texts = vec![match reference.setting.is_none() {
        true => "reference: the unchanged scene".to_owned(),
        false => format!("reference: `{}`", reference.setting),
    }];
    texts.push(if reference.whole {
        format!(
            "horizon: the whole run of {} s; perturbed by {} or with twice the step, the reference stays within {} of the motion",
            study.end,
            power(PERTURBATION),
            percent(reference.share)
        )
    } else {
        format!(
            "horizon: {} s of {} s; beyond it the reference, perturbed by {} or with twice the step, differs by more than {} of the motion, and nothing is compared",
            norms.horizon(),
            study.end,
            power(PERTURBATION),
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
    let axes = study.axes.iter().map(|axis| format!("{} values of {}", axis.options.len(), axis.name));
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
