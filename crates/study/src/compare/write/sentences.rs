//! What was found by a comparison, in sentences.

use super::page::fixed;
use crate::compare::constant::{UNLIKE, mismatch};
use crate::compare::{ChannelComparison, Comparison};
use crate::measured::{Channel, MeasuredMotion, Sign};
use crate::write::{percent, power, short};
use teeter_report::with_unit;

/// Rows of the run this many times as far apart as those of the table are told: what is between them is interpolated.
const COARSE: f64 = 1.5;

/// A warning where the run has rows farther apart than the table.
fn coarse_run(comparison: &Comparison) -> Option<String> {
    let mut steps: Vec<f64> = comparison.trace.times().windows(2).map(|t| t[1] - t[0]).collect();
    steps.sort_by(f64::total_cmp);
    let (run, table) = (*steps.get(steps.len() / 2)?, comparison.measured.interval());
    (run > COARSE * table).then(|| {
        let [every, own] = [table, run].map(|t| with_unit(t, "s"));
        format!(
            "warning: the rows of the run are {own} apart, those of the table {every}: impacts between rows of the run are smoothed; \
             run the scene with --set output.every=\"{every}\""
        )
    })
}

/// Of so many other alignments each is named.
const NAMED: usize = 3;

/// A warning where other shifts or sides fit as well.
pub(crate) fn other_alignments(comparison: &Comparison) -> Option<String> {
    let others = &comparison.alternatives;
    let named: Vec<String> = others
        .iter()
        .take(NAMED)
        .map(|found| {
            let side = match found.sign {
                Sign::AsIs => "seen as in the scene",
                Sign::Reversed => "seen from behind",
            };
            format!("t = {} s {side} ({} rows)", fixed(found.shift, 5), found.rows)
        })
        .collect();
    (!named.is_empty()).then(|| {
        let more = match others.len() - named.len() {
            0 => String::new(),
            more => format!(", and {more} more"),
        };
        format!(
            "warning: other alignments fit as well, as where a motion repeats itself: {}{more}; give --shift or --sign if they are known",
            named.join(", ")
        )
    })
}

/// What was found, in sentences.
#[must_use]
pub fn sentences_of(comparison: &Comparison) -> Vec<String> {
    let Comparison { alignment, settings, measured, .. } = comparison;
    let side = match alignment.sign {
        Sign::AsIs => "seen as in the scene",
        Sign::Reversed => "seen from behind: its sign is turned",
    };
    let mut texts = vec![format!(
        "the measured motion at its t = 0 is that of the run at t = {} s ({}), {side} ({})",
        fixed(alignment.shift, 5),
        if alignment.shift_found { "found" } else { "given" },
        origin_of_side(alignment.sign_found, settings.alignment.sign.is_some())
    )];
    if alignment.by != Channel::Phi && alignment.shift_found && measured.values(Channel::Phi).is_some() {
        texts.push(format!(
            "they are aligned by {}, as the measured phi hardly rises above its noise",
            alignment.by.word()
        ));
    }
    // Where a wrong column was read, all that follows is about nothing.
    let of_table = comparison.channels.iter().filter(|found| found.is_measured);
    texts.extend(of_table.filter_map(|found| without_motion(measured, found)));
    texts.extend(other_alignments(comparison));
    texts.extend(outliers(comparison));
    texts.extend(coarse_run(comparison));
    let rows = &comparison.rows;
    let last = measured.t.get(rows.end.saturating_sub(1)).copied().unwrap_or(0.0);
    let to = format!(
        "{} of {} measured rows are compared{}, from {} up to t = {} s",
        comparison.compared(),
        measured.t.len(),
        lost(comparison),
        if comparison.trace.is_held() { "the release of the block, t = 0," } else { "t = 0" },
        short(last)
    );
    texts.push(match settings.horizon {
        Some(horizon) if horizon < comparison.trace.end() => {
            format!("{to}: beyond t = {} s the simulated motion isn’t predictable (its horizon)", short(horizon))
        }
        Some(_) => to,
        None => format!("{to}; the horizon of the run is not known: `teeter run --horizon` finds it"),
    });
    if !comparison.held.is_empty() {
        let apart = comparison.channels.iter().filter(|found| found.is_measured).filter_map(|found| {
            let ((_, factor), unit) = (found.channel.shown(), found.channel.shown_after(" "));
            Some(format!("{} by {}{unit}", found.channel.word(), power(factor * found.held?.rms)))
        });
        texts.push(format!(
            "before t = 0 both blocks are held: {} for the alignment, but not into the differences; the motions are apart there (root \
             mean square) {}",
            match comparison.held.len() {
                1 => "1 more row counts".to_owned(),
                rows => format!("{rows} more rows count"),
            },
            apart.collect::<Vec<_>>().join(", ")
        ));
    }
    texts.push(format!(
        "both motions are sampled at the measured times ({} s apart) and smoothed by parabolas through {} rows; rates are \
         those of the parabolas, and are compared where the window is complete on both sides",
        short(measured.interval()),
        settings.window
    ));
    let unseen = comparison.channels.iter().filter(|found| !found.is_measured && found.differences.rows == 0);
    let unseen: Vec<&str> = unseen.map(|found| found.channel.word()).collect();
    if !unseen.is_empty() {
        texts.push(format!(
            "warning: {} {} not compared: no row that counts has a complete window in both motions; a smaller --window has more",
            unseen.join(" and "),
            if unseen.len() == 1 { "is" } else { "are" }
        ));
    }
    if let Some(found) = measured.markers {
        texts.push(format!(
            "{} markers fit a rigid body within {} mm (root mean square), at most {} mm at t = {} s of the table",
            found.markers,
            short(1e3 * found.rms),
            short(1e3 * found.max),
            short(found.t)
        ));
    }
    texts.extend(not_rigid(measured));
    let origins = comparison.channels.iter().filter(|found| found.channel.has_own_origin() && found.is_measured);
    for found in origins {
        let word = found.channel.word();
        texts.push(format!(
            "the origin of {word} is arbitrary: {} mm were added to what was measured",
            fixed(1e3 * found.origin, 2)
        ));
    }
    let mismatch = mismatch(comparison);
    if mismatch > UNLIKE {
        texts.push(format!(
            "warning: the motions hardly match: their mean square difference is {} of what unrelated motions have{}",
            percent(mismatch),
            perhaps_degrees(comparison)
        ));
    }
    texts.extend(constant(comparison));
    texts
}

/// How the side is known from which a motion was seen.
pub(crate) fn origin_of_side(found: bool, given: bool) -> &'static str {
    match (found, given) {
        (true, _) => "found",
        (false, true) => "given",
        (false, false) => "assumed: no quantity that would tell the side rises above its noise",
    }
}

/// Most lines of outliers that are named.
const MOST_NAMED: usize = 12;

/// Names the rows in which a quantity is off on its own.
pub(crate) fn outliers(comparison: &Comparison) -> Option<String> {
    let lines: Vec<String> = comparison
        .outliers
        .iter()
        .filter_map(|row| comparison.measured.lines.get(*row))
        .map(usize::to_string)
        .collect();
    let more = lines.len().saturating_sub(MOST_NAMED);
    let named = lines.iter().take(MOST_NAMED).map(String::as_str).collect::<Vec<_>>();
    let and_more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let line = match lines.len() {
        0 => return None,
        1 => "line",
        _ => "lines",
    };
    // A given alignment isn't made by any rows.
    let given = comparison.settings.alignment;
    let counted = match (given.shift, given.sign) {
        (Some(_), Some(_)) => "not left out",
        _ => "left out of the alignment, not of the differences",
    };
    Some(format!(
        "warning: outliers in {line} {}{and_more} of the table, far from the rows before and after, are {counted}; if they are errors of \
         the measurement, leave them out, with --leave-out {}{} or empty cells",
        named.join(", "),
        named.join(","),
        if more > 0 { ",…" } else { "" }
    ))
}

/// The measured quantities that are lost in some of the rows compared.
fn lost(comparison: &Comparison) -> String {
    let all = comparison.compared();
    let fewer = comparison.channels.iter().filter(|found| found.is_measured && found.differences.rows < all);
    let told: Vec<String> =
        fewer.map(|found| format!("{} in {} of them", found.channel.word(), found.differences.rows)).collect();
    if told.is_empty() { String::new() } else { format!(" ({})", told.join(", ")) }
}

/// Angles without a unit that are so many times those of the run are taken for angles in degrees.
const TOO_LARGE: f64 = 10.0;

/// What to do if the angles are in degrees, where they are far too large for the run.
fn perhaps_degrees(comparison: &Comparison) -> &'static str {
    let largest = |values: &[f64]| values.iter().filter(|x| x.is_finite()).fold(0.0, |most: f64, x| most.max(x.abs()));
    let too_large =
        |found: &ChannelComparison| largest(&found.measured.value) > TOO_LARGE * largest(&found.simulated.value);
    match comparison.phi_without_unit && comparison.channel(Channel::Phi).is_some_and(too_large) {
        true => {
            "; the measured angles are far larger than those of the run: if they are in degrees, say so, --unit phi=deg"
        }
        false => "",
    }
}

/// Markers that miss their places on the block by more than this share of their distance from their middle aren't on one rigid body.
const NOT_RIGID: f64 = 0.03;

/// Says that the markers don't fit a rigid body, and what may be wrong.
fn not_rigid(measured: &MeasuredMotion) -> Option<String> {
    let found = measured.markers.filter(|found| found.rms > NOT_RIGID * found.size)?;
    let why = if found.mirrored < 0.25 * found.rms {
        "turned upside down they fit: is `y_down` right?"
    } else {
        "are two of them swapped, or is one given the wrong place?"
    };
    Some(format!(
        "the markers don’t fit a rigid body: they miss it by {} of their distance from their middle; {why}",
        percent(found.rms / found.size)
    ))
}

/// Says of a measured quantity that it shows no motion.
fn without_motion(motion: &MeasuredMotion, found: &ChannelComparison) -> Option<String> {
    let finite = |values: &[f64]| values.iter().copied().filter(|value| value.is_finite()).collect::<Vec<f64>>();
    let rows = finite(motion.values(found.channel)?);
    let values = finite(&found.measured.value);
    let n = (values.len() as f64).max(1.0);
    let mean = values.iter().sum::<f64>() / n;
    let spread = (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / n).sqrt();
    let word = found.channel.word();
    if rows.iter().all(|value| *value == rows[0]) {
        return Some(format!("warning: the measured {word} is the same in all rows: is it the right column?"));
    }
    // Smoothing leaves less than the noise of the rows.
    let ((_, factor), unit) = (found.channel.shown(), found.channel.shown_after(" "));
    (spread <= found.measured.noise).then(|| {
        format!(
            "warning: the measured {word} doesn’t rise above its noise, whose standard deviation is {}{unit}: is it the right column?",
            power(factor * found.measured.noise)
        )
    })
}

/// Says that the angles are apart by a constant, if that is much of their difference.
fn constant(comparison: &Comparison) -> Option<String> {
    let found = comparison.constant?;
    let shown = |angle: f64| power(angle.to_degrees()).replace('-', "\u{2212}");
    // A tilted camera shows the held block tilted by as much; a block that starts elsewhere doesn't.
    let (by, cause) = match found.held {
        None => (shown(found.angle.abs()), ", as if the camera or the block had stood tilted".to_owned()),
        Some(held) => {
            let held = shown(held);
            (
                shown(found.angle),
                format!(", but before the release by {held}°, so that a tilted camera isn’t all of it"),
            )
        }
    };
    Some(format!(
        "the angles are apart by a constant, {by}°{cause}: with --offset \"{:.3} deg\" the root mean square difference would be {}°",
        found.offset.to_degrees(),
        shown(found.rms)
    ))
}
