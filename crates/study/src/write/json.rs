//! `tradeoff.json`: reference, error bars, horizon, advice, pruning; the rows are in
//! `tradeoff.csv`.

use super::{advice, pruning};
use crate::{Advice, Errors, PERTURBATION, Quantity, Setting, SettingWarning, TARGETS, Tradeoff};
use serde_json::{Map, Value, json};

/// The study as JSON text. Numbers that are not finite are null.
#[must_use]
pub fn json(study: &Tradeoff) -> String {
    let reference = &study.reference;
    let checks: Vec<Value> = reference
        .checks
        .iter()
        .map(|check| {
            json!({
                "what": check.what,
                "setting": setting(&check.setting),
                "agrees_until": check.agrees_until,
                "in_error_bar": check.for_bar,
                "differences": errors(&check.errors),
            })
        })
        .collect();
    let norms: Map<String, Value> =
        Quantity::ALL.into_iter().map(|quantity| (quantity.word().to_owned(), quantity.norm().into())).collect();
    let recommendations: Vec<Value> = TARGETS
        .iter()
        .zip(&study.advice)
        .zip(advice(study))
        .map(|((target, advice), text)| {
            let mut value = json!({ "accuracy": target, "text": text });
            match advice {
                Advice::NotMeasurable => value["outcome"] = "not-measurable".into(),
                Advice::NotReached => value["outcome"] = "not-reached".into(),
                Advice::BeforeImpact => value["outcome"] = "horizon-before-impact".into(),
                Advice::Warned(row) => {
                    value["outcome"] = "warned".into();
                    value["row"] = (row + 1).into();
                    value["warnings"] = warnings(study.rows[*row].warned());
                }
                Advice::Take { row, faster, confirmed } => {
                    value["outcome"] = "take".into();
                    value["row"] = (row + 1).into();
                    value["set"] = setting(&study.rows[*row].setting);
                    value["measured_faster"] = faster.map(|row| row + 1).into();
                    value["confirmed_by_finer_step"] = (*confirmed).into();
                    value["reached"] = study.rows[*row].accuracy().into();
                    value["off_by_at_most"] = study.rows[*row].accuracy().map(|accuracy| accuracy + study.bar()).into();
                    value["warnings"] = warnings(study.rows[*row].warned());
                    value["cpu_seconds"] = study.rows[*row].measured().into();
                    value["modelled_seconds"] = study.rows[*row].modelled().into();
                }
            }
            value
        })
        .collect();
    let value = json!({
        "title": study.title,
        "version": env!("CARGO_PKG_VERSION"),
        "end": study.end,
        "step": study.step,
        "set": study.sets.iter().map(|(key, value)| (key.clone(), value.clone().into())).collect::<Map<String, Value>>(),
        "horizon": reference.norms.horizon(),
        "whole": reference.whole,
        "horizon_share": reference.share,
        "first_impact": reference.first_impact.map(|impact| json!({ "block": impact.block, "t": impact.t, "until": impact.until })),
        "first_impacts_compared": reference.has_first_impacts(),
        "perturbation": PERTURBATION,
        "sample_every": study.sampling.every,
        "reference": {
            "setting": setting(&reference.setting), "checks": checks, "warnings": warnings(&reference.warned)
        },
        "error_bar": errors(&reference.bar),
        "norms": norms,
        "recommendations": recommendations,
        "candidates": study.rows.len(),
        "grid": study.grid(),
        "too_expensive": study.too_expensive.len(),
        "pruning": pruning(study),
    });
    // A value of strings, finite numbers and nulls always serialises.
    serde_json::to_string_pretty(&value).unwrap_or_default() + "\n"
}

fn warnings(warned: &[SettingWarning]) -> Value {
    warned.iter().map(|warned| Value::from(warned.text.as_str())).collect()
}

fn setting(setting: &Setting) -> Value {
    Value::Object(setting.pairs().into_iter().map(|(key, value)| (key, value.into())).collect())
}

fn errors(errors: &Errors) -> Value {
    let all = Quantity::ALL.into_iter();
    Value::Object(all.map(|quantity| (quantity.word().to_owned(), errors.of(quantity).into())).collect())
}
