//! Measured and simulated motion over time, with their difference: the source paper's figures 2 and
//! 3.

use crate::compare::{ChannelComparison, Comparison};
use crate::measured::Channel;
use teeter_plot::{Axis, AxisError, Figure, Legend, Mark, Panel, Series};
use teeter_report::{SIDE_BY_SIDE, for_any_width};

/// Most marks in a figure: beyond, they hide each other, and the lines.
const MOST_MARKS: usize = 150;
/// Points of a line.
const LINE_POINTS: usize = 4000;
/// The number of a dashed blue line: the motion before a fit is told from the fitted one without colours, too.
const DASHED: usize = 7;
/// A round number no farther from the first or last row than this part of the time is the end of its axis.
const ROUND: f64 = 0.05;
/// Heights of the panels of the motion and of the difference, mm.
const HEIGHTS: [f64; 2] = [52.0, 22.0];

/// The figures for files, of a width in mm from 60 to 300, with their names.
///
/// # Errors
/// [`AxisError`] if a value can't be shown.
pub fn svg_figures(comparison: &Comparison, width: f64) -> Result<Vec<(String, String)>, AxisError> {
    motion_figures(comparison, None, Some(width))
}

/// The figures for files of a width, mm, or without one as HTML for pages; with `before`, also the motion before a fit.
pub(crate) fn motion_figures(
    comparison: &Comparison,
    before: Option<&Comparison>,
    width: Option<f64>,
) -> Result<Vec<(String, String)>, AxisError> {
    let all = comparison.channels.iter().map(|found| {
        let figure = figure(comparison, before, found.channel)?;
        let svg = match width {
            Some(width) => figure.width_mm(width).to_svg(),
            None => for_any_width(&figure, SIDE_BY_SIDE),
        };
        Ok((format!("{}.svg", found.channel.word()), svg))
    });
    all.collect()
}

/// The points of a line of simulated values, over the time of the measured ones.
fn line(comparison: &Comparison, channel: Channel, factor: f64, span: (f64, f64)) -> Vec<(f64, f64)> {
    let Some(found) = comparison.channel(channel) else { return Vec::new() };
    let t = &comparison.measured.t;
    if found.is_measured {
        // The run itself; a smoothed rate is compared only as sampled.
        let step = (span.1 - span.0) / LINE_POINTS as f64;
        let at = |k: usize| {
            let t = span.0 + step * k as f64;
            Some((t, factor * comparison.trace.at(t)?.of(channel)))
        };
        return (0..=LINE_POINTS).filter_map(at).collect();
    }
    t.iter().copied().zip(found.simulated.value.iter().map(|value| factor * value)).collect()
}

fn figure(comparison: &Comparison, before: Option<&Comparison>, channel: Channel) -> Result<Figure, AxisError> {
    let (unit, factor) = channel.shown();
    let t = &comparison.measured.t;
    let Some(found) = comparison.channel(channel) else {
        return Ok(Figure::new("", "", Axis::between("", 0.0, 1.0)));
    };
    let points = |values: &[f64]| -> Vec<(f64, f64)> {
        t.iter().copied().zip(values.iter().map(|value| factor * value)).filter(|point| point.1.is_finite()).collect()
    };
    let measured = points(&found.measured.value);
    let span = (t.first().copied().unwrap_or(0.0), t.last().copied().unwrap_or(1.0));
    let x = Axis::between("Time t (s)", span.0, span.1).out_to_round(ROUND);
    let simulated = line(comparison, channel, factor, span);
    let earlier = before.map(|before| line(before, channel, factor, span)).unwrap_or_default();
    let apart = |found: &ChannelComparison| {
        let off = found.simulated.value.iter().zip(&found.measured.value).map(|(a, b)| a - b);
        points(&off.collect::<Vec<f64>>())
    };
    let off = apart(found);
    // What the fit has mended is hardly seen in the motions themselves.
    let off_before = before.and_then(|before| before.channel(channel)).map(apart);
    let values = measured.iter().chain(&simulated).chain(&earlier).map(|point| point.1).filter(|y| y.is_finite());
    let y = Axis::linear(format!("{} ({unit})", channel.title()), values)?;
    let every = measured.len().div_ceil(MOST_MARKS).max(1);
    let name = if found.is_measured { "measured" } else { "measured, as the rate of the samples" };
    let thinned = (every > 1).then(|| format!("marks: one row of {every}"));
    let marks = Series::marks(name, measured.into_iter().step_by(every), Mark::Circle).number(6).hollow().faint();
    let mut series = vec![marks];
    if before.is_some() {
        series.push(Series::line("before the fit", earlier).number(DASHED));
    }
    let name = match (before.is_some(), found.is_measured) {
        (true, _) => "fitted",
        (false, true) => "simulated",
        (false, false) => "simulated, sampled alike",
    };
    series.push(Series::line(name, simulated).number(1));
    let horizon: Vec<f64> = comparison.settings.horizon.into_iter().collect();
    let motion = Panel::new(y).with(series).height_mm(HEIGHTS[0]).guides(horizon.clone()).note(thinned);
    let both = off.iter().chain(off_before.iter().flatten()).map(|point| point.1);
    let low = Axis::linear(format!("Difference ({unit})"), both)?;
    let off_before = off_before.map(|off| Series::line("", off).number(DASHED));
    let difference =
        Panel::new(low).with(off_before).with([Series::line("", off).number(1)]).height_mm(HEIGHTS[1]).guides(horizon);
    let title = format!("{}: measured and simulated", channel.title());
    Ok(Figure::new(channel.word(), title, x).legend(Legend::Rows).panel(motion).panel(difference))
}
