//! Plots of what beams bear.

use super::{Line, Measure, Panels, Place, TimePanel};
use crate::page::content::{holds, largest};
use crate::page::jolts::Jolts;
use crate::page::means::Filter;
use crate::page::notes::Note;
use crate::page::recorder::PageRecorder;
use crate::page::scenery::ContactDrawn;
use crate::sections::{Column, Kind};

/// What is to be said of forces in beams that blocks strike.
pub(crate) fn after_impacts(recorder: &PageRecorder) -> Option<&'static str> {
    let strikes = |contact: &ContactDrawn| contact.beam.is_some() && !contact.has_duration;
    let mut on_beams = (0..).zip(&recorder.scenery.contacts).filter(|(_, contact)| strikes(contact));
    // Of each pair all are counted, however many are kept.
    let struck = on_beams.any(|(pair, _)| recorder.kept.density.contains_key(&pair));
    struck.then_some("peaks after impacts depend on step and elements")
}

impl Panels {
    /// What beams bear at their probes and supports.
    pub(super) fn sections(&mut self, recorder: &PageRecorder) {
        let columns: Vec<_> = recorder.sections.iter().zip(recorder.first_section()..).collect();
        let values: Vec<Vec<f64>> = columns.iter().map(|(_, k)| self.curves.curve(*k)).collect();
        // Of a recorder on its own, which has seen no section forces, there is nothing to draw or to tell.
        if !values.iter().flatten().any(|value| value.is_finite()) {
            return;
        }
        let most = |kinds: &[Kind]| {
            let of_kind = columns.iter().zip(&values).filter(|((column, _), _)| kinds.contains(&column.kind));
            largest(of_kind.flat_map(|(_, values)| values))
        };
        let span = recorder.scenery.beams.iter().fold(0.0, |longest: f64, beam| beam.span.max(longest));
        let moment = most(&[Kind::Moment, Kind::ReactionCouple]);
        let force = most(&[Kind::Shear, Kind::AxialForce, Kind::Reaction]).max(moment / span);
        let moment = moment.max(force * span);
        let jolts = Jolts::of(recorder);
        // The moments that are plotted: the number of the beam, where, and whether it rings.
        let mut moments: Vec<(usize, Option<f64>, bool)> = Vec::new();
        for (kind, title, of, unit, scale) in [
            (Kind::Moment, "Bending moment M", "bending moment at", "N m", moment),
            (Kind::Shear, "Transverse force V", "transverse force at", "N", force),
            (Kind::Stress, "Largest normal stress", "stress at", "Pa", most(&[Kind::Stress])),
            (Kind::AxialForce, "Axial force N", "axial force", "N", force),
            (Kind::Reaction, "Reactions of the supports", "reaction at", "N", force),
            (Kind::ReactionCouple, "Couples of the supports", "couple of the support at", "N m", moment),
        ] {
            let mut drawn = Vec::new();
            let mut beams = Vec::new();
            let of_kind = columns.iter().zip(&values).filter(|((column, _), _)| column.kind == kind);
            for (number, ((column, k), values)) in of_kind.enumerate() {
                let label = recorder.section_label(column);
                let at_probe = matches!(kind, Kind::Moment | Kind::Shear | Kind::Stress).then_some(column.x).flatten();
                let number = at_probe.and_then(|x| recorder.number_of_probe(column.beam, x)).unwrap_or(number);
                if holds(largest(values), scale) {
                    drawn.push((*k, label, number, values, *column));
                    beams.push(column.beam);
                } else {
                    self.leave_out(
                        of,
                        (!label.is_empty()).then_some((label, "places")),
                        [largest(values), scale],
                        unit,
                    );
                }
            }
            if drawn.is_empty() {
                continue;
            }
            let most = largest(drawn.iter().flat_map(|(.., values, _)| *values));
            // Stress is known in megapascals.
            let (measure, unit, factor) = match kind {
                Kind::Stress => (Measure::Own, "MPa", 1e-6),
                Kind::Moment | Kind::ReactionCouple => (Measure::Moment, "", 1.0),
                _ => (Measure::Force, "", 1.0),
            };
            // A stress is a size, without a sign: the mean of what alternates would be no force that carries.
            let means: Vec<Vec<f64>> = if kind == Kind::Stress {
                Vec::new()
            } else {
                drawn.iter().map(|(column, ..)| self.curves.means(*column)).collect()
            };
            let filter = match kind {
                Kind::Shear => {
                    let places = drawn.iter().filter_map(|(.., column)| Some((column.beam, column.x?)));
                    Filter::of(&self.curves, &jolts.with_passages(recorder, places), &means)
                }
                _ => Filter::of(&self.curves, &jolts, &means),
            };
            let (mut lines, mut over) = (Vec::new(), Vec::new());
            for (column, label, number, _, Column { beam, x, .. }) in drawn {
                let mean = match kind {
                    Kind::Stress => {
                        let moment = moments.iter().find(|(of, at, _)| of == beam && at == x);
                        filter.through_the_largest(&self.curves, column, moment.map(|(.., rings)| *rings)).map(|most| {
                            (
                                most.values.into_iter().map(|stress| factor * stress).collect(),
                                if most.itself.contains(&true) { most.itself } else { Vec::new() },
                            )
                        })
                    }
                    _ => filter.ringing(&self.curves, column).map(|mean| (mean, Vec::new())),
                };
                if kind == Kind::Moment {
                    moments.push((*beam, *x, mean.is_some()));
                }
                let is_raw = mean.is_some();
                let name = if is_raw { String::new() } else { label.clone() };
                lines.push(Line { is_raw, ..Line::of(&self.curves, column, factor, name, number) });
                over.extend(mean.map(|(y, itself)| Line { label, number, y, is_raw: false, itself, of: None }));
            }
            let strong = match kind {
                // Two quantities in one curve are told apart.
                Kind::Stress if over.iter().any(|line| !line.itself.is_empty()) => {
                    "the stress itself, where it rings dashed, through the largest of every"
                }
                Kind::Stress => "through the largest of every",
                _ => "without vibrations of periods below",
            };
            let mut notes = Vec::new();
            if !over.is_empty() {
                notes.push(Note::of_pale("pale: all steps"));
                notes.push(Note::of_plot(format!("strong: {strong} {}", filter.told())));
            }
            let peaks = (kind != Kind::AxialForce).then(|| after_impacts(recorder)).flatten();
            notes.extend(peaks.map(Note::of_plot));
            let weight =
                (kind != Kind::AxialForce).then(|| recorder.scenery.without_weight(beams.into_iter())).flatten();
            notes.extend(weight.map(Note::of_plot));
            lines.extend(over);
            // What is pale stays behind all else.
            lines.sort_by_key(|line| if line.is_raw { (0, 0) } else { (1, line.number) });
            let id =
                serde_json::to_value(kind).ok().and_then(|word| word.as_str().map(str::to_owned)).unwrap_or_default();
            self.panels.push(TimePanel {
                id: format!("section-{id}"),
                notes,
                of_contact: None,
                title: title.to_owned(),
                description: format!("{title} over time"),
                measure,
                unit: unit.to_owned(),
                least: 1e-6 * most * factor,
                guides: Vec::new(),
                t: None,
                cut: true,
                place: Place::Forces,
                lines,
            });
        }
    }
}
