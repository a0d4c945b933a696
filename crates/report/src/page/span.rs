//! Plots over the span of beams: how far section forces went, and the deflected shape at chosen times.

use super::content::{holds, largest};
use super::panels::{Measure, Units, after_impacts};
use super::recorder::{BLOCK_FRAME, PageRecorder};
use super::widths::for_any_width;
use crate::first::first_of_largest;
use crate::with_digits;
use teeter_plot::{Axis, Figure, Legend, Panel, Series};

/// Width of the figures on the page where there is room, mm.
const WIDE: f64 = 140.0;

/// A figure over the span as HTML.
pub(super) fn on_page(figure: Figure) -> String {
    for_any_width(&figure.legend(Legend::Rows), WIDE)
}

/// Moment and transverse force over the span: their least and largest in the run, on either side of each node.
pub(super) fn envelopes(recorder: &PageRecorder, units: &Units, id: &str) -> Option<Figure> {
    let drawn: Vec<_> = recorder
        .beams
        .iter()
        .filter_map(|record| {
            let place = recorder.layout.beams.iter().find(|place| place.name == record.beam)?;
            Some((record, place.beam.node_positions(), record.envelope.as_ref()?))
        })
        .collect();
    let span = drawn.iter().filter_map(|(_, x, _)| x.last().copied()).fold(0.0, f64::max);
    let several = recorder.scenery.beams.len() > 1;
    let unit = recorder.scenery.display.length;
    let of = |shear: bool| {
        let ends =
            drawn.iter().flat_map(|(.., envelope)| if shear { &envelope.shear_ends } else { &envelope.moment_ends });
        largest(ends.flatten().flatten())
    };
    let (moment, force) = (of(false).max(of(true) * span), of(true).max(of(false) / span));
    let mut panels = Vec::new();
    for (shear, what, measure, unit_of, scale) in [
        (false, "Bending moment M", Measure::Moment, "N m", moment),
        (true, "Transverse force V", Measure::Force, "N", force),
    ] {
        if !holds(of(shear), scale) {
            continue;
        }
        let (prefix, factor) = units.unit(measure, of(shear));
        let mut lines = Vec::new();
        for (record, x, envelope) in &drawn {
            let ends = if shear { &envelope.shear_ends } else { &envelope.moment_ends };
            for (side, word) in [(1, "largest"), (0, "least")] {
                let label = if several { format!("{} {word}", record.beam) } else { word.to_owned() };
                // An element's two ends: at a node the line jumps where a support or a load makes it.
                // So it does at a load inside an element.
                let at = |x: f64, range: [f64; 2]| (x * unit.per_metre(), factor * range[side]);
                let within = |ends: &[f64]| {
                    let [from, to] = [ends[0], ends[1]];
                    let inside = envelope.places.iter().filter(move |place| place.x > from && place.x < to);
                    inside.flat_map(move |place| {
                        let sides = if shear { place.shear } else { place.moment };
                        sides.map(|range| (place.x, range))
                    })
                };
                let points = ends.iter().zip(x.windows(2)).flat_map(|(ends, x)| {
                    let between = within(x).map(|(x, range)| at(x, range));
                    std::iter::once(at(x[0], ends[0])).chain(between).chain([at(x[1], ends[1])]).collect::<Vec<_>>()
                });
                lines.push(Series::line(label, points).number(lines.len()));
            }
        }
        let y = lines.iter().flat_map(Series::points).map(|point| point.1).chain([0.0]);
        let axis = Axis::around(format!("{what} ({prefix}{unit_of})"), y, 1e-6 * of(shear) * factor);
        let peaks = after_impacts(recorder).map(str::to_owned);
        let notes: Vec<String> = peaks.into_iter().chain(without_weight(recorder)).collect();
        let note = (!notes.is_empty() && panels.is_empty()).then(|| notes.join("; "));
        panels.push(Panel::new(axis).with(lines).telling_apart().note(note));
    }
    let x = Axis::between(format!("Place along the beam x ({})", unit.word()), 0.0, span * unit.per_metre());
    let title = "Bending moment and transverse force over the span, least and largest of all steps";
    (!panels.is_empty()).then(|| panels.into_iter().fold(Figure::new(id, title, x), Figure::panel))
}

/// What is said of the own weight of the beams that have envelopes.
fn without_weight(recorder: &PageRecorder) -> Option<String> {
    let beams = recorder.scenery.beams.iter().enumerate();
    let shown = beams
        .filter(|(_, beam)| recorder.beams.iter().any(|record| record.beam == beam.name && record.envelope.is_some()));
    recorder.scenery.without_weight(shown.map(|(number, _)| number))
}

/// Shapes in one panel: the start, the end, the largest deflection, and so many more peaks.
const PEAKS: usize = 2;

/// A peak is this far from others, in parts of the run, and this large, in parts of the largest.
const APART: f64 = 0.05;
const TELLING: f64 = 0.3;

/// The largest deflection to the other side is seen beside the largest one from this part of it on.
const SEEN: f64 = 0.1;

/// Most beams with a panel of their own.
const BEAMS: usize = 4;

/// The deflected shapes of the beams at chosen times.
pub(super) fn shapes(recorder: &PageRecorder, units: &Units, id: &str) -> Option<Figure> {
    let scenery = &recorder.scenery;
    let rows: Vec<(f64, &[f64])> = recorder.kept.frames.rows().collect();
    // Between pictures several steps apart a beam may have deflected farther: of the largest deflection only the nearest picture is known.
    let apart = rows.windows(2).map(|two| two[1].0 - two[0].0).fold(0.0, f64::max) > 1.5 * recorder.kept.curves.step();
    let run = rows.last()?.0 - rows.first()?.0;
    let unit = scenery.display.length;
    let mut first = BLOCK_FRAME * scenery.blocks.len();
    let mut panels = Vec::new();
    for beam in &scenery.beams {
        let own = first..first + beam.points;
        first = own.end;
        // A beam that nothing holds moves as a whole, too, which is no shape.
        let bent = |row: &[f64]| -> Vec<f64> {
            let w = &row[own.clone()];
            let (Some(left), Some(right)) = (w.first(), w.last()) else { return Vec::new() };
            let part = |k: usize| k as f64 / (w.len() - 1).max(1) as f64;
            w.iter().enumerate().map(|(k, w)| beam.off_line(part(k), *w, [*left, *right])).collect()
        };
        // By its largest deflection, with the sign of that.
        let farthest = |w: &[f64]| w.iter().copied().max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0);
        let peaks: Vec<f64> = rows.iter().map(|(_, row)| farthest(&bent(row))).collect();
        let most = largest(&peaks);
        if !holds(most, 1e-3 * beam.span) || panels.len() == BEAMS {
            continue;
        }
        let (name, factor) = units.unit(Measure::Deflection, most);
        let lines =
            chosen(&rows.iter().map(|row| row.0).collect::<Vec<_>>(), &peaks, run).into_iter().map(|(k, word)| {
                let (t, row) = rows[k];
                let word = if apart { word.replace("largest", "near the largest") } else { word.to_owned() };
                let word = if word.is_empty() { String::new() } else { format!("{word}, ") };
                let length = beam.span * unit.per_metre();
                let points = smooth(&bent(row)).into_iter().map(|(part, w)| (length * part, factor * w));
                Series::line(format!("{word}t = {}", with_digits(t, "s", 4)), points)
            });
        let lines: Vec<Series> = lines.collect();
        let y = lines.iter().flat_map(Series::points).map(|point| point.1).chain([0.0]);
        let axis = Axis::around(format!("Deflection w ({name})"), y, 1e-6 * most * factor);
        let note = (scenery.beams.len() > 1).then(|| beam.name.clone());
        panels.push(Panel::new(axis).with(lines).note(note).telling_apart());
    }
    let span = scenery.beams.iter().fold(0.0, |longest: f64, beam| beam.span.max(longest));
    let x = Axis::between(format!("Place along the beam x ({})", unit.word()), 0.0, span * unit.per_metre());
    let title = "Deflected shape of the beams at chosen times";
    (!panels.is_empty()).then(|| panels.into_iter().fold(Figure::new(id, title, x), Figure::panel))
}

/// Points between two that are known.
const BETWEEN: usize = 4;

/// A curve through values at evenly spread places, with those in parts of the length: cubic between them, with the slope of a
/// parabola through three, so that a beam looks as smooth as it is.
fn smooth(w: &[f64]) -> Vec<(f64, f64)> {
    let last = w.len() - 1;
    let slope = |k: usize| match k {
        _ if last < 2 => w[last] - w[0],
        0 => -1.5 * w[0] + 2.0 * w[1] - 0.5 * w[2],
        k if k == last => 1.5 * w[k] - 2.0 * w[k - 1] + 0.5 * w[k - 2],
        k => 0.5 * (w[k + 1] - w[k - 1]),
    };
    let mut points = vec![(0.0, w[0])];
    for k in 0..last {
        let ([a, b], [s, t]) = ([w[k], w[k + 1]], [slope(k), slope(k + 1)]);
        for i in 1..=BETWEEN {
            let x = i as f64 / BETWEEN as f64;
            let bent = x * (1.0 - x) * ((s - (b - a)) * (1.0 - x) - (t - (b - a)) * x);
            points.push(((k as f64 + x) / last as f64, a + (b - a) * x + bent));
        }
    }
    points
}

/// Pictures that are worth a shape, in order of time, with what they are: the start, the largest deflection, the largest one to the other side, further
/// peaks, the end.
fn chosen(times: &[f64], peaks: &[f64], run: f64) -> Vec<(usize, &'static str)> {
    let sizes: Vec<f64> = peaks.iter().map(|w| w.abs()).collect();
    let last = sizes.len() - 1;
    let most = first_of_largest(&sizes).unwrap_or(0);
    let mut chosen: Vec<(usize, &'static str)> = vec![(0, "start")];
    if last > 0 {
        chosen.push((last, "end"));
    }
    if let Some(known) = chosen.iter_mut().find(|(k, _)| *k == most) {
        known.1 = if most == 0 { "start and largest" } else { "end and largest" };
    } else {
        chosen.push((most, "largest"));
    }
    let mut more = 0;
    // A beam that swings up as far as down has a shape of each.
    let other_side = |k: &usize| peaks[*k] * peaks[most] < 0.0 && sizes[*k] > SEEN * sizes[most];
    let others: Vec<usize> = (0..=last).filter(other_side).collect();
    let other_sizes: Vec<f64> = others.iter().map(|k| sizes[*k]).collect();
    if let Some(k) = first_of_largest(&other_sizes).map(|first| others[first])
        && chosen.iter().all(|(other, _)| *other != k)
    {
        chosen.push((k, if peaks[k] > 0.0 { "largest upwards" } else { "largest downwards" }));
        more += 1;
    }
    let mut further: Vec<usize> = (1..last).filter(|&k| sizes[k] > sizes[k - 1] && sizes[k] >= sizes[k + 1]).collect();
    further.retain(|k| sizes[*k] > TELLING * sizes[most]);
    further.sort_by(|a, b| sizes[*b].total_cmp(&sizes[*a]));
    for k in further {
        if more < PEAKS && chosen.iter().all(|(other, _)| (times[*other] - times[k]).abs() > APART * run) {
            chosen.push((k, ""));
            more += 1;
        }
    }
    chosen.sort_by_key(|(k, _)| *k);
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shape_is_exact_at_its_points_and_smooth_between() {
        let of = |x: f64| 3.0 - 2.0 * x + 5.0 * x * x;
        let values: Vec<f64> = (0..=8).map(|k| of(f64::from(k) / 8.0)).collect();
        let points = smooth(&values);
        assert_eq!(points.len(), 8 * BETWEEN + 1);
        assert!(points.iter().all(|(x, w)| (w - of(*x)).abs() < 1e-12), "{points:?}");
        assert_eq!(smooth(&[1.0, 2.0])[BETWEEN / 2], (0.5, 1.5));
    }

    #[test]
    fn shapes_are_those_of_start_peaks_and_end() {
        let times: Vec<f64> = (0..=100).map(f64::from).collect();
        let sizes: Vec<f64> = times.iter().map(|t| (1.0 - t / 200.0) * (0.3 * t).sin().abs()).collect();
        let chosen = chosen(&times, &sizes, 100.0);
        let words: Vec<&str> = chosen.iter().map(|(_, word)| *word).collect();
        assert_eq!(words, ["start", "largest", "", "", "end"]);
        assert_eq!(chosen[1].0, 5, "the first maximum of a decaying swing, at t = π/0.6");
        assert_eq!(super::chosen(&[0.0], &[1.0], 0.0), [(0, "start and largest")]);
        // Down at first, and up close to that.
        let swing: Vec<f64> = times.iter().map(|t| -(-t / 6.0).exp() * t.sin()).collect();
        let chosen = super::chosen(&times, &swing, 100.0);
        assert!(chosen.contains(&(1, "largest")) && chosen.contains(&(5, "largest upwards")), "{chosen:?}");
        // A sagging cantilever is thrown up by an eighth of how far it goes down.
        let sags: Vec<f64> = swing.iter().zip(&times).map(|(w, t)| if *t > 3.0 { 0.2 * w } else { *w }).collect();
        let chosen = super::chosen(&times, &sags, 100.0);
        let up = chosen.iter().find(|(_, word)| *word == "largest upwards").unwrap().0;
        assert!(up == 5 && (0.1..0.15).contains(&(sags[up] / -sags[1])), "{chosen:?} {sags:?}");
    }
}
