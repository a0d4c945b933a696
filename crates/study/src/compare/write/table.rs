//! The tables of a comparison.

use crate::compare::Comparison;
use std::fmt::Write;

/// A number, or nothing where there is none.
fn cell(text: &mut String, value: Option<f64>) {
    text.push(',');
    if let Some(value) = value.filter(|value| value.is_finite()) {
        let _ = write!(text, "{value:?}");
    }
}

/// `compare.csv`: a row for each row of the measured table: `t` (of the run), `t_measured` (as in the
/// table), for each quantity its smoothed measured and simulated values (SI), and whether the row is
/// compared: `yes`, `no`, or `held` before the release. A row without any value isn't compared.
#[must_use]
pub fn rows_csv(comparison: &Comparison) -> String {
    let mut text = "t,t_measured".to_owned();
    for channel in &comparison.channels {
        let word = channel.channel.word();
        let _ = write!(text, ",{word}_measured,{word}_simulated");
    }
    text.push_str(",compared\n");
    for (row, t) in comparison.measured.t.iter().enumerate() {
        let _ = write!(text, "{t:?},{:?}", t - comparison.alignment.shift);
        for channel in &comparison.channels {
            cell(&mut text, Some(channel.measured.value[row]));
            cell(&mut text, Some(channel.simulated.value[row]));
        }
        text.push_str(match row {
            row if comparison.is_compared(row) => ",yes\n",
            row if comparison.held.contains(&row) => ",held\n",
            _ => ",no\n",
        });
    }
    text
}

/// `half-cycles.csv`: `number`, begin, end, amplitude and its time, measured and simulated, the ratio of
/// the amplitudes, the delay (s) and phase (°) of the simulated one at its end.
#[must_use]
pub fn half_cycle_csv(comparison: &Comparison) -> String {
    let mut text = "number".to_owned();
    for which in ["measured", "simulated"] {
        let _ = write!(text, ",begin_{which},end_{which},amplitude_{which},amplitude_t_{which}");
    }
    text.push_str(",amplitude_ratio,delay,phase_degrees\n");
    for (number, pair) in comparison.half_cycles.iter().enumerate() {
        let _ = write!(text, "{}", number + 1);
        for half in [Some(pair.measured), pair.simulated] {
            cell(&mut text, half.map(|half| half.begin));
            cell(&mut text, half.and_then(|half| half.end));
            cell(&mut text, half.map(|half| half.amplitude));
            cell(&mut text, half.map(|half| half.amplitude_at));
        }
        cell(&mut text, pair.amplitude_ratio());
        cell(&mut text, pair.delay());
        cell(&mut text, pair.phase());
        text.push('\n');
    }
    text
}

/// `impact-pairs.csv`: time, ω before and after, and their ratio, of each impact, measured and simulated,
/// and the delay of the simulated one (s).
#[must_use]
pub fn impact_csv(comparison: &Comparison) -> String {
    let mut text = "number".to_owned();
    for which in ["measured", "simulated"] {
        let _ = write!(text, ",t_{which},omega_before_{which},omega_after_{which},omega_ratio_{which}");
    }
    text.push_str(",delay\n");
    for (number, pair) in comparison.impacts.iter().enumerate() {
        let _ = write!(text, "{}", number + 1);
        for crossing in [pair.measured, pair.simulated] {
            cell(&mut text, crossing.map(|crossing| crossing.t));
            cell(&mut text, crossing.and_then(|crossing| crossing.omega).map(|omega| omega[0]));
            cell(&mut text, crossing.and_then(|crossing| crossing.omega).map(|omega| omega[1]));
            cell(&mut text, crossing.and_then(|crossing| crossing.kept()));
        }
        cell(&mut text, pair.measured.zip(pair.simulated).map(|(measured, simulated)| simulated.t - measured.t));
        text.push('\n');
    }
    text
}
