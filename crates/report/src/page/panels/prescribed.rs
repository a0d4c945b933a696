//! Plots of how beams deflect, and how ground and supports are made to move.

use super::motion::{COORDINATES, PHI};
use super::{Curves, Line, Measure, Panels, Place, TimePanel};
use crate::driven::Driven;
use crate::page::content::{ROUNDING, holds, largest};
use crate::page::notes::Note;
use crate::page::recorder::PageRecorder;
use crate::page::scenery::{BeamDrawn, FREE};
use std::collections::BTreeSet;

impl Panels {
    /// The deflections of the beams at midspan and at their probes.
    pub(super) fn deflections(&mut self, recorder: &PageRecorder) {
        let scenery = &recorder.scenery;
        let several = scenery.beams.len() > 1;
        // Places without a probe have the colours after those of the probes.
        let (mut drawn, mut elsewhere) = (Vec::new(), 0);
        for (number, beam) in scenery.beams.iter().enumerate() {
            let first = scenery.beam_column(number);
            let middle = format!("{}, {}", middle_word(beam), recorder.place(0.5 * beam.span));
            let place = |x: f64| {
                let end = [0.0, beam.span].iter().zip(beam.supports).any(|(end, support)| *end == x && support == FREE);
                format!("{}{}", if end { "free end, " } else { "" }, recorder.place(x))
            };
            let places =
                std::iter::once((0.5 * beam.span, middle)).chain(beam.probes.iter().map(|(x, _)| (*x, place(*x))));
            for (k, (x, place)) in places.enumerate() {
                let values = self.curves.curve(first + k);
                let label = if several { format!("{} {place}", beam.name) } else { place.clone() };
                let what = if k > 0 || beam.probed_middle { "w at the probe" } else { "w at" };
                let colour = recorder.number_of_probe(number, x).unwrap_or_else(|| {
                    elsewhere += 1;
                    recorder.probe_count() + elsewhere - 1
                });
                if holds(largest(&values), 1e-3 * beam.span) {
                    drawn.push((label, first + k, colour));
                } else {
                    self.leave_out(what, Some((label, "places")), [largest(&values), 1e-3 * beam.span], "m");
                }
            }
        }
        if drawn.is_empty() {
            return;
        }
        let span = scenery.beams.iter().fold(0.0, |longest: f64, beam| beam.span.max(longest));
        let free: Vec<&str> =
            scenery.beams.iter().filter(|beam| beam.is_free()).map(|beam| beam.name.as_str()).collect();
        let note = (!free.is_empty()).then(|| {
            let holds =
                if several { format!("of {}, which no support holds, ", free.join(", ")) } else { String::new() };
            Note::of_plot(format!("{holds}measured from the line through the ends of the beam"))
        });
        let only_middle = drawn.len() == 1 && !several && drawn[0].0.starts_with(MIDSPAN);
        let lines = drawn.into_iter().map(|(label, column, number)| {
            let label = if only_middle { String::new() } else { label };
            Line::of(&self.curves, column, 1.0, label, number)
        });
        let lines = lines.collect();
        self.panels.push(TimePanel {
            id: "w_mid".to_owned(),
            notes: note.into_iter().collect(),
            of_contact: None,
            title: if only_middle { "Deflection at midspan w" } else { "Deflection w" }.to_owned(),
            description: "Deflection of the beams over time".to_owned(),
            measure: Measure::Deflection,
            unit: String::new(),
            least: ROUNDING * 1e-2 * span,
            guides: Vec::new(),
            t: None,
            cut: false,
            place: Place::Motion,
            lines,
        });
    }

    /// Displacement, velocity and acceleration of ground and supports.
    pub(super) fn prescribed(&mut self, recorder: &PageRecorder) {
        let scenery = &recorder.scenery;
        let display = scenery.display;
        for turns in [false, true] {
            let of_kind = || scenery.driven.iter().enumerate().filter(|(_, driven)| (driven.component == PHI) == turns);
            let several = of_kind().map(|(_, driven)| &driven.name).collect::<BTreeSet<_>>().len() > 1
                || scenery.driven.iter().any(|driven| driven.name != "ground");
            for (k, (id, title)) in [("ground", "displacement"), ("ground_v", "velocity"), ("ground_a", "acceleration")]
                .into_iter()
                .enumerate()
            {
                let moving: Vec<_> = of_kind()
                    .enumerate()
                    .map(|(number, (which, driven))| (number, driven, scenery.driven_column(which) + k))
                    .map(|(number, driven, column)| (number, driven, column, largest(&self.curves.curve(column))))
                    .filter(|(.., largest)| *largest > 0.0)
                    .collect();
                if moving.is_empty() {
                    continue;
                }
                let most = moving.iter().fold(0.0, |most: f64, (.., largest)| most.max(*largest));
                let (measure, unit, factor) = match (turns, k) {
                    (true, 0) => (Measure::Own, display.angle.symbol(), display.angle.per_radian()),
                    (true, _) => (Measure::Own, "rad", 1.0),
                    (false, 0) => (Measure::Position, "", 1.0),
                    (false, 1) => (Measure::Velocity, "", 1.0),
                    (false, _) => (Measure::Own, "m", 1.0),
                };
                let label = |driven: &Driven| {
                    let axis = COORDINATES[driven.component].symbol;
                    let name = driven.name.replace('.', " ");
                    if several { format!("{name} {axis}") } else { axis.to_owned() }
                };
                // Where curves have the extremes of many steps, what is smooth is drawn as that.
                let t = if self.curves.is_thinned() { smooth_times(&self.curves) } else { Vec::new() };
                let smooth: Option<Vec<Vec<f64>>> = moving
                    .iter()
                    .map(|(_, driven, column, _)| smooth(&t, |t| driven.prescribed(t)[k], &self.curves.curve(*column)))
                    .collect();
                let lines = moving.into_iter().enumerate().map(|(place, (number, driven, column, _))| {
                    let label = label(driven);
                    match &smooth {
                        Some(smooth) => {
                            let y = smooth[place].iter().map(|y| factor * y).collect();
                            Line { label, number, y, is_raw: false, itself: Vec::new(), of: None }
                        }
                        None => Line::of(&self.curves, column, factor, label, number),
                    }
                });
                let lines = lines.collect();
                let what = if several { "Prescribed" } else { "Ground" };
                let title = format!("{what} {}{title}", if turns { "angular " } else { "" });
                let title = title.replace("angular displacement", "angle");
                self.panels.push(TimePanel {
                    id: if turns { format!("{id}_phi") } else { id.to_owned() },
                    description: format!("{title} over time"),
                    notes: Vec::new(),
                    of_contact: None,
                    title,
                    measure,
                    unit: format!("{unit}{}", ["", "/s", "/s²"][k]),
                    least: ROUNDING * most * factor,
                    guides: Vec::new(),
                    t: smooth.is_some().then_some(t),
                    cut: false,
                    place: Place::Motion,
                    lines,
                });
            }
        }
    }
}

/// So many points of a smooth motion, which are enough for its zoomed parts, too.
const SMOOTH: usize = 2000;

/// What is smooth lies between two of its points on their line, but for this part of its largest value.
const STRAIGHT: f64 = 5e-3;

/// Times for points of a smooth motion over a run, s.
fn smooth_times(curves: &Curves) -> Vec<f64> {
    let borders = curves.borders();
    let (start, end) = (borders[0], borders[borders.len() - 1]);
    (0..=SMOOTH).map(|k| start + (end - start) * k as f64 / SMOOTH as f64).collect()
}

/// A prescribed quantity at these times, beginning with the value of its `curve`, which may have an incline; `None` where these are too few for its course,
/// as of a record, or of a step: it isn't straight between them, or reaches farther in a step than at any of them.
fn smooth(t: &[f64], value: impl Fn(f64) -> f64, curve: &[f64]) -> Option<Vec<f64>> {
    let most = largest(curve);
    let from = curve.first()? - value(*t.first()?);
    let values: Vec<f64> = t.iter().map(|t| from + value(*t)).collect();
    let is_straight = |k: usize| {
        let middle = from + value(0.5 * (t[k] + t[k + 1]));
        (middle - 0.5 * (values[k] + values[k + 1])).abs() <= STRAIGHT * most
    };
    let ends = |values: &[f64]| values.iter().fold((0.0_f64, 0.0_f64), |(a, b), x| (a.min(*x), b.max(*x)));
    let ((low, high), (least, greatest)) = (ends(&values), ends(curve));
    let reaches = (low - least).abs().max((high - greatest).abs()) <= STRAIGHT * most;
    (reaches && (0..t.len() - 1).all(is_straight)).then_some(values)
}

/// What the middle of a beam is called where it is that of a span.
const MIDSPAN: &str = "midspan";

/// What the middle of a beam is called: it may be that of no span, or a support.
fn middle_word(beam: &BeamDrawn) -> &'static str {
    let (middle, rounding) = (0.5 * beam.span, 1e-9 * beam.span);
    // How far the nearest supports, or ends, are on either side.
    let nearest = |side: f64| {
        let far = beam.inner.iter().map(|(x, _)| side * (x - middle)).filter(|far| *far >= -rounding);
        far.fold(middle, f64::min)
    };
    match [-1.0, 1.0].map(nearest) {
        [left, right] if left.max(right) <= rounding => "support",
        [left, right] if (left - right).abs() <= rounding => MIDSPAN,
        _ => "middle",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn a_sine_is_smooth_and_steps_and_noise_are_not() {
        let t: Vec<f64> = (0..=SMOOTH).map(|k| k as f64 / SMOOTH as f64).collect();
        let curve = |f: &dyn Fn(f64) -> f64| (0..=40_000).map(|k| f(k as f64 / 4e4)).collect::<Vec<_>>();
        let sine = |t: f64| (2.0 * PI * 10.0 * t).sin();
        let found = smooth(&t, sine, &curve(&sine)).unwrap();
        assert!(found.iter().zip(&t).all(|(x, t)| *x == sine(*t)));
        // With an incline.
        assert_eq!(smooth(&t, sine, &curve(&|t| 3.0 + sine(t))).unwrap()[0], 3.0);
        let step = |t: f64| if t < 0.3 { 0.0 } else { 1.0 };
        assert_eq!(smooth(&t, step, &curve(&step)), None);
        let fast = |t: f64| (2.0 * PI * 999.0 * t).sin();
        assert_eq!(smooth(&t, fast, &curve(&fast)), None);
        // Shorter than the time between two points.
        let blip = |t: f64| if (t - 0.50013).abs() < 1e-4 { 1.0 } else { 0.0 };
        assert_eq!(smooth(&t, blip, &curve(&blip)), None);
    }
}
