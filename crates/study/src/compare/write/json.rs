//! `compare.json`: alignment, norms, markers; half-cycles and impacts as in their tables.

use crate::compare::{Comparison, HalfCycle};
use serde_json::{Map, Value, json};

/// The comparison as JSON text, in SI units.
#[must_use]
pub fn json(comparison: &Comparison, block: &str, run: &str, measured: &str) -> String {
    let Comparison { alignment, settings, .. } = comparison;
    let channels: Map<String, Value> = comparison
        .channels
        .iter()
        .map(|found| {
            let d = found.differences;
            let value = json!({
                "measured": found.is_measured,
                "rms": d.rms,
                "max": d.max,
                "max_at": d.max_at,
                "mean": d.mean,
                "scale": d.scale,
                "rms_relative": d.rms / d.scale,
                "max_relative": d.max / d.scale,
                "noise": found.is_measured.then_some(found.measured.noise),
                "origin": found.channel.has_own_origin().then_some(found.origin),
                "rows": d.rows,
                "held": found.held.map(|held| json!({ "rms": held.rms, "max": held.max, "mean": held.mean, "rows": held.rows })),
            });
            (found.channel.word().to_owned(), value)
        })
        .collect();
    let half = |half: HalfCycle| json!({ "begin": half.begin, "end": half.end, "amplitude": half.amplitude, "amplitude_t": half.amplitude_at });
    let half_cycles: Vec<Value> = comparison
        .half_cycles
        .iter()
        .map(|pair| {
            json!({
                "measured": half(pair.measured),
                "simulated": pair.simulated.map(half),
                "amplitude_ratio": pair.amplitude_ratio(),
                "delay": pair.delay(),
                "phase_degrees": pair.phase(),
            })
        })
        .collect();
    let impacts: Vec<Value> = comparison
        .impacts
        .iter()
        .map(|pair| {
            let one = |crossing: crate::compare::cycles::Crossing| {
                json!({ "t": crossing.t, "omega": crossing.omega, "omega_ratio": crossing.kept() })
            };
            json!({ "measured": pair.measured.map(one), "simulated": pair.simulated.map(one) })
        })
        .collect();
    let t = |row: usize| comparison.measured.t.get(row).copied();
    let value = json!({
        "version": env!("CARGO_PKG_VERSION"),
        "run": run,
        "measured": measured,
        "block": block,
        "time_shift": alignment.shift,
        "time_shift_found": alignment.shift_found,
        "sign": alignment.sign.factor(),
        "sign_found": alignment.sign_found,
        "aligned_by": alignment.by.word(),
        "mismatch": alignment.mismatch,
        "other_alignments": comparison.alternatives.iter().map(|found| json!({
            "time_shift": found.shift, "sign": found.sign.factor(), "rows": found.rows,
        })).collect::<Vec<_>>(),
        "outlier_lines": comparison.outliers.iter().filter_map(|row| comparison.measured.lines.get(*row)).collect::<Vec<_>>(),
        "phi_offset": settings.offset,
        "window_rows": settings.window,
        "interval": comparison.measured.interval(),
        "horizon": settings.horizon,
        "compared": {
            "from": t(comparison.rows.start),
            "to": t(comparison.rows.end.saturating_sub(1)),
            "rows": comparison.compared(),
            "of": comparison.measured.t.len(),
        },
        "quantities": channels,
        "half_cycles": half_cycles,
        "impacts": impacts,
        "markers": comparison.measured.markers.map(|found| json!({
            "count": found.markers, "rms": found.rms, "max": found.max, "max_t_measured": found.t, "placed": found.placed,
        })),
    });
    // A value of strings, finite numbers and nulls always serialises.
    serde_json::to_string_pretty(&value).unwrap_or_default() + "\n"
}
