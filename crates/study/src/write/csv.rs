//! `tradeoff.csv`: one row per candidate.

use crate::{Quantity, Tradeoff};
use std::fmt::Write;

/// The table, with its header: `number, stage, setting` (as arguments; empty for the unchanged
/// scene), a column for each error (empty if the scene doesn't have it),
/// `steps, solves, contacts, iterations, unconverged_steps, modelled_ms` (counted work),
/// `cpu_ms, cpu_ms_least, cpu_runs`, `front` (of accuracy over counted work: yes or no), `failure`
/// (empty if it came to its end), `warnings` (of `check` and `run`, separated by semicolons).
#[must_use]
pub fn csv(study: &Tradeoff) -> String {
    let mut text = "number,stage,setting".to_owned();
    for quantity in Quantity::ALL {
        let _ = write!(text, ",{}", quantity.word());
    }
    text.push_str(
        ",steps,solves,contacts,iterations,unconverged_steps,modelled_ms,cpu_ms,cpu_ms_least,cpu_runs,front,failure,warnings\n",
    );
    for (number, row) in study.rows.iter().enumerate() {
        let _ = write!(text, "{},{},{}", number + 1, row.stage, quoted(&row.setting.to_string()));
        match &row.result {
            Ok(done) => {
                for quantity in Quantity::ALL {
                    text.push(',');
                    if let Some(error) = done.errors.of(quantity) {
                        let _ = write!(text, "{error:?}");
                    }
                }
                let work = done.work;
                let _ = write!(
                    text,
                    ",{},{},{},{},{},{:?}",
                    work.steps,
                    work.solves,
                    work.contacts,
                    work.iterations,
                    done.unconverged,
                    1e3 * work.seconds()
                );
            }
            Err(_) => text.push_str(&",".repeat(Quantity::ALL.len() + 6)),
        }
        match row.cpu {
            Some(cpu) => _ = write!(text, ",{:?},{:?},{}", 1e3 * cpu.median, 1e3 * cpu.least, cpu.runs),
            None => text.push_str(",,,"),
        }
        let front = if study.front.contains(&number) { "yes" } else { "no" };
        let failure = row.result.as_ref().err().map(ToString::to_string).unwrap_or_default();
        let warned: Vec<&str> = row.warned().iter().map(|warned| warned.text.as_str()).collect();
        let _ = writeln!(text, ",{front},{},{}", quoted(&failure), quoted(&warned.join("; ")));
    }
    text
}

/// Quotes a field for any text.
pub(crate) fn quoted(field: &str) -> String {
    if field.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}
