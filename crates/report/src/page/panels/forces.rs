//! Plots of what bodies bear, of slip, and of energies.

use super::{Curves, ForceCurve};
use super::{Line, Panels, Place, TimePanel, length_unit, prefix};
use crate::page::content::{ROUNDING, holds, largest};
use crate::page::recorder::{ENERGIES, PageRecorder};
use crate::sections::Kind;
use teeter_integrator::ContactState;

/// Scale of slip, in sizes of a block: the rounding of each step adds up over a run, and that of what sticks under impacts all the more.
const SLIP_SCALE: f64 = 100.0;

/// This many times as much where a point never slips by its state.
const STUCK_SCALE: f64 = 100.0;

/// What is said of it then.
const SHARED: &str = "in impacts, only contact + friction is dissipated: either may rise";

/// Friction that rises by this part of the largest work is told: in impacts it shares the work with the contact.
const RISES: f64 = 1e-3;

impl Panels {
    /// Slip of the contacts; and whether their forces are worth a plot. Those that aren't are dropped.
    pub(super) fn contacts(&mut self, recorder: &PageRecorder) {
        let scenery = &recorder.scenery;
        let strongest = largest(self.forces.iter().flatten().flat_map(|forces| &forces.normal));
        let several = scenery.contacts.len() > 1;
        let mut panels = Vec::new();
        let mut left_out = Vec::new();
        for contact in &scenery.contacts {
            let rounding = ROUNDING * SLIP_SCALE * scenery.blocks[contact.block].reach;
            let own = &mut self.forces[contact.first..contact.first + contact.points.len()];
            own.iter_mut().flatten().for_each(|forces| forces.stick_within(rounding));
            // What a step of the force gives anyway is no impact worth a plot.
            let of_step = self.curves.step() * largest(own.iter().flatten().flat_map(|forces| &forces.normal));
            if largest(own.iter().flatten().flat_map(|forces| &forces.impacts)) <= of_step {
                own.iter_mut().flatten().for_each(|forces| forces.impacts.clear());
            }
        }
        for (pair, contact) in scenery.contacts.iter().enumerate() {
            let points = contact.points.iter().zip(&self.forces[contact.first..]);
            let points = points.filter_map(|(point, forces)| Some((point, forces.as_ref()?)));
            // By the numbers of those that touch, as in the plots of their forces.
            let points: Vec<_> = points.enumerate().map(|(k, (point, forces))| (k, point, forces)).collect();
            if points.is_empty() {
                continue;
            }
            let name = format!("{} on {}", scenery.blocks[contact.block].name, contact.surface);
            let of = || several.then(|| (name.clone(), "contacts"));
            let normal = largest(points.iter().flat_map(|(_, _, forces)| &forces.normal));
            self.normal[pair] = holds(normal, strongest);
            // Of some only impacts are known, as of balls that strike each other.
            if !self.normal[pair] && points.iter().all(|(_, _, forces)| forces.impacts.is_empty()) {
                left_out.push(("force of", of(), normal, "N"));
                self.forces[contact.first..contact.first + contact.points.len()].fill(None);
                continue;
            }
            let force = largest(points.iter().flat_map(|(_, _, forces)| &forces.tangential));
            self.tangential[pair] = holds(force, strongest);
            if !self.tangential[pair] {
                left_out.push(("tangential force of", of(), force, "N"));
            }
            let reach = scenery.blocks[contact.block].reach;
            let scale = SLIP_SCALE * reach;
            // Where no point slips by its state, the rounding of what sticks has added up.
            let slips = |forces: &ForceCurve| {
                let sticks = !forces.state.contains(&ContactState::Slip);
                holds(largest(&forces.slip), if sticks { STUCK_SCALE * scale } else { scale })
            };
            let slipping: Vec<_> = points.iter().filter(|(_, _, forces)| slips(forces)).collect();
            if slipping.is_empty() {
                let most = largest(points.iter().flat_map(|(_, _, forces)| &forces.slip));
                left_out.push(("slip of", of(), most, "m"));
                continue;
            }
            let most = largest(slipping.iter().flat_map(|(_, _, forces)| &forces.slip));
            let (unit, factor) = length_unit(scenery.display.length, most);
            let lines = slipping.iter().map(|(number, point, forces)| Line {
                label: point.label.clone(),
                number: *number,
                y: std::iter::once(0.0).chain(forces.slip.iter().map(|slip| factor * slip)).collect(),
                of: None,
            });
            panels.push(TimePanel {
                id: format!("slip-{pair}"),
                note: None,
                title: "Slip".to_owned(),
                of_contact: Some((pair, if several { name } else { String::new() })),
                description: "Slip of the contacts over time".to_owned(),
                unit: unit.to_owned(),
                least: ROUNDING * scale * factor,
                guides: Vec::new(),
                cut: false,
                place: Place::Forces,
                lines: lines.collect(),
            });
        }
        self.panels.extend(panels);
        left_out.into_iter().for_each(|(what, of, most, unit)| self.leave_out(what, of, most, unit));
    }

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
        for (kind, title, of, unit, scale) in [
            (Kind::Moment, "Bending moment M", "bending moment at", "N m", moment),
            (Kind::Shear, "Transverse force V", "transverse force at", "N", force),
            (Kind::Stress, "Largest normal stress", "stress at", "Pa", most(&[Kind::Stress])),
            (Kind::AxialForce, "Axial force N", "axial force", "N", force),
            (Kind::Reaction, "Reactions of the supports", "reaction at", "N", force),
            (Kind::ReactionCouple, "Couples of the supports", "couple of the support at", "N m", moment),
        ] {
            let mut drawn = Vec::new();
            let of_kind = columns.iter().zip(&values).filter(|((column, _), _)| column.kind == kind);
            for (number, ((column, k), values)) in of_kind.enumerate() {
                let label = recorder.section_label(column);
                if holds(largest(values), scale) {
                    drawn.push((*k, label, number, values));
                } else {
                    self.leave_out(of, (!label.is_empty()).then_some((label, "places")), largest(values), unit);
                }
            }
            if drawn.is_empty() {
                continue;
            }
            let most = largest(drawn.iter().flat_map(|(.., values)| *values));
            let (prefix, factor) = if kind == Kind::Stress { ("M", 1e-6) } else { prefix(most) };
            let line = |(column, label, number, _)| Line::of(&self.curves, column, factor, label, number);
            let lines = drawn.into_iter().map(line).collect();
            let id =
                serde_json::to_value(kind).ok().and_then(|word| word.as_str().map(str::to_owned)).unwrap_or_default();
            self.panels.push(TimePanel {
                id: format!("section-{id}"),
                note: None,
                of_contact: None,
                title: title.to_owned(),
                description: format!("{title} over time"),
                unit: format!("{prefix}{unit}"),
                least: 1e-6 * most * factor,
                guides: Vec::new(),
                cut: true,
                place: Place::Forces,
                lines,
            });
        }
    }

    pub(super) fn energies(&mut self, recorder: &PageRecorder) {
        let first = recorder.scenery.energy_column();
        let of = |curves: &Curves, name: &str| {
            let column = first + ENERGIES.iter().position(|known| *known == name).unwrap_or(0);
            (column, curves.curve(column))
        };
        let energies = [("kinetic", 0), ("elastic", 1), ("gravity", 2), ("total", 6)];
        let energies =
            energies.into_iter().filter(|(name, _)| *name != "elastic" || !recorder.scenery.beams.is_empty());
        let energies: Vec<_> = energies.map(|(name, number)| (name, number, of(&self.curves, name))).collect();
        let scale = largest(energies.iter().flat_map(|(.., (_, values))| values)).max(recorder.scenery.weight_energy);
        let works = ["contact", "friction", "viscous", "numerical", "external", "projection"];
        let works: Vec<_> = works.into_iter().enumerate().map(|(k, name)| (name, k, of(&self.curves, name))).collect();
        for (id, title, all) in [("energy", "Energy", energies), ("works", "Work since t = 0", works)] {
            let mut drawn = Vec::new();
            for (name, number, (column, values)) in all {
                if holds(largest(&values), scale) {
                    let label = if name == "gravity" { "gravity, change" } else { name }.to_owned();
                    drawn.push((column, label, number, values));
                } else {
                    let what = if id == "energy" { "energy:" } else { "work:" };
                    self.leave_out(what, Some((name.to_owned(), "")), largest(&values), "J");
                }
            }
            if drawn.is_empty() {
                continue;
            }
            let most = largest(drawn.iter().flat_map(|(.., values)| values));
            let (prefix, factor) = prefix(most);
            let line = |(column, label, number, _)| Line::of(&self.curves, column, factor, label, number);
            let rises = |values: &[f64]| {
                let mut least = f64::INFINITY;
                let rise = |x: &f64| {
                    least = least.min(*x);
                    x - least
                };
                values.iter().map(rise).fold(0.0, f64::max)
            };
            let shared = drawn.iter().any(|(_, label, _, values)| label == "friction" && rises(values) > RISES * most);
            let lines = drawn.into_iter().map(line).collect();
            self.panels.push(TimePanel {
                id: id.to_owned(),
                note: shared.then_some(SHARED),
                of_contact: None,
                title: title.to_owned(),
                description: format!("{title} of the scene over time"),
                unit: format!("{prefix}J"),
                least: (1e-6 * most).max(ROUNDING * scale) * factor,
                guides: Vec::new(),
                cut: false,
                place: Place::Forces,
                lines,
            });
        }
    }
}
