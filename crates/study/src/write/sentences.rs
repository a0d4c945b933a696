//! What a study says to people.

use super::{duration, percent};
use crate::setting::as_arguments;
use crate::{Advice, NUDGE, Quantity, Row, SHARE, STAGES_TOLD, TARGETS, Tradeoff};

/// A sentence for each accuracy: what to take, as arguments to copy, or why nothing can be said.
#[must_use]
pub fn advice(study: &Tradeoff) -> Vec<String> {
    let one = |(target, advice): (&f64, &Advice)| {
        let target = percent(*target);
        match advice {
            Advice::NotMeasurable => {
                format!("{target} of accuracy: not measurable here: the reference is known to {}", percent(study.bar()))
            }
            Advice::NotReached => format!(
                "{target} of accuracy: none of the settings tried is known to reach it: the best is off by {}, and the reference known to {}",
                percent(study.best().unwrap_or(f64::INFINITY)),
                percent(study.bar())
            ),
            Advice::Take { row, overruled, confirmed } => {
                let row = &study.rows[*row];
                let unconfirmed = if *confirmed { "" } else { "; no finer step of it was tried that would confirm it" };
                let overruled = if *overruled { "; by measured time, which the counted work is far from" } else { "" };
                format!(
                    "for {target} of accuracy take {}: {}{overruled}{unconfirmed}",
                    taken(study, row),
                    cost(study, row)
                )
            }
        }
    };
    if study.best().is_none() {
        return vec!["nothing that is compared moves before the horizon, so there is nothing to choose".to_owned()];
    }
    TARGETS.iter().zip(&study.advice).map(one).collect()
}

/// The setting of a row as arguments to copy, the user's own first.
pub(crate) fn taken(study: &Tradeoff, row: &Row) -> String {
    let own: Vec<_> = study.sets.iter().filter(|(key, _)| row.setting.get(key).is_none()).cloned().collect();
    let texts = [as_arguments(&own), row.setting.to_string()];
    let texts: Vec<&str> = texts.iter().map(String::as_str).filter(|text| !text.is_empty()).collect();
    if texts.is_empty() { "the scene as it is".to_owned() } else { format!("`{}`", texts.join(" ")) }
}

fn cost(study: &Tradeoff, row: &Row) -> String {
    let accuracy = row.accuracy().map_or_else(String::new, |accuracy| format!(" (off by {})", percent(accuracy)));
    match row.measured() {
        Some(time) => format!("{} of CPU time, {:.2e} × real time{accuracy}", duration(time), time / study.end),
        None => format!("no time measured{accuracy}"),
    }
}

/// What the advice rests on: horizon, error bars, the scene as it is.
#[must_use]
pub fn findings(study: &Tradeoff) -> Vec<String> {
    let reference = &study.reference;
    let ruler = &reference.ruler;
    let mut texts = vec![format!("reference: {}", reference.setting)];
    texts.push(if reference.whole {
        format!(
            "horizon: the whole run of {} s; started {NUDGE:e} beside it or with twice the step, it stays within {} of the motion",
            study.end,
            percent(SHARE)
        )
    } else {
        format!(
            "horizon: {} s of {} s; beyond it the reference, started {NUDGE:e} beside it or with twice the step, is more than {} of the motion off, and nothing is compared",
            ruler.horizon(),
            study.end,
            percent(SHARE)
        )
    });
    let bars = Quantity::ALL.into_iter().filter_map(|quantity| {
        let bar = reference.bar.of(quantity).filter(|_| quantity != Quantity::Penetration)?;
        Some(format!("{} {}", quantity.title().to_lowercase(), percent(bar)))
    });
    let bars: Vec<_> = bars.collect();
    if !bars.is_empty() {
        texts.push(format!("the reference is known to: {}", bars.join(", ")));
    }
    let absent = Quantity::ALL.into_iter().filter(|quantity| match study.own().map(|row| &row.result) {
        Some(Ok(done)) => done.errors.of(*quantity).is_none(),
        _ => false,
    });
    let absent: Vec<_> = absent.map(|quantity| quantity.title().to_lowercase()).collect();
    if !absent.is_empty() {
        texts.push(format!("left out, as the scene has none before the horizon: {}", absent.join(", ")));
    }
    if let Some(row) = study.own() {
        texts.push(match &row.result {
            Ok(_) => format!("the scene as it is: {}", cost(study, row)),
            Err(failure) => format!("the scene as it is: {failure}"),
        });
    }
    texts
}

/// How the grid was pruned.
#[must_use]
pub fn pruning(study: &Tradeoff) -> Vec<String> {
    // The fourth is two stages.
    let numbers = ["1", "2", "3", "4 and 5", "6"];
    let stages = numbers.iter().zip(STAGES_TOLD).map(|(number, told)| format!("stage {number}: {told}"));
    let axes = study.axes.iter().map(|axis| format!("{} {}", axis.options.len(), axis.name));
    let mut texts: Vec<String> = stages.collect();
    texts.push(format!(
        "{} of the {} settings of the full grid ({}) were tried",
        study.rows.len(),
        study.grid(),
        axes.collect::<Vec<_>>().join(" × ")
    ));
    if study.too_dear > 0 {
        texts.push(format!("{} more were left out as too much work, by counted work", study.too_dear));
    }
    texts
}
