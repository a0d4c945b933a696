//! Plots of slip, and which contacts' forces are worth one.

use super::{ForceCurve, Line, Measure, Panels, Place, TimePanel};
use crate::page::content::{ROUNDING, holds, largest};
use crate::page::notes::Note;
use crate::page::recorder::PageRecorder;
use crate::page::scenery::{ContactDrawn, PointDrawn};
use teeter_integrator::ContactState;

/// Scale of slip, in sizes of a block: the rounding of each step adds up over a run, and that of what sticks under impacts all the more.
const SLIP_SCALE: f64 = 100.0;

/// This many times as much where a point never slips by its state.
const STUCK_SCALE: f64 = 100.0;

/// Scale of the sum of shares that face each other, in largest forces: how exact they are is a part of all that the contacts bear, and each
/// of them adds its own.
const SUM_SCALE: f64 = 10.0;

/// Slip of no more than this (m) in a stretch is drawn as sticking.
pub(crate) fn unseen_slip(recorder: &PageRecorder, contact: &ContactDrawn) -> f64 {
    ROUNDING * SLIP_SCALE * recorder.scenery.blocks[contact.block].reach
}

/// An impulse of up to this many times what a step of the force beside it gives is none of an impact: forces are means, which those of single steps
/// exceed.
const OF_STEP: f64 = 2.0;

/// Feet of a block that slip by amounts that differ by more than this part of the largest don't slide together.
const APART: f64 = 0.05;

/// What is to be known of slip then.
const WHILE_IT_PRESSES: &str = "a foot's slip counts only while it presses, not what the block moves meanwhile";

/// Whether the points of a contact slip by different amounts in all.
fn differ(points: &[(usize, &PointDrawn, &ForceCurve)]) -> bool {
    let slips = || points.iter().filter_map(|(_, _, forces)| forces.slip.last().copied());
    let (low, high) = (slips().fold(f64::INFINITY, f64::min), slips().fold(f64::NEG_INFINITY, f64::max));
    high - low > APART * high.abs().max(low.abs())
}

impl Panels {
    /// Slip of the contacts; and whether their forces are worth a plot. Those that aren't are dropped.
    pub(super) fn contacts(&mut self, recorder: &PageRecorder) {
        let scenery = &recorder.scenery;
        let strongest = largest(self.forces.iter().flatten().flat_map(|forces| &forces.normal));
        let several = scenery.contacts.len() > 1;
        let mut panels = Vec::new();
        let mut left_out = Vec::new();
        for contact in &scenery.contacts {
            let rounding = unseen_slip(recorder, contact);
            let own = &mut self.forces[contact.first..contact.first + contact.points.len()];
            own.iter_mut().flatten().for_each(|forces| forces.stick_within(rounding));
            // What a step of the force gives anyway is no impact worth a plot.
            let lasting = OF_STEP * self.curves.step();
            own.iter_mut().flatten().for_each(|forces| forces.drop_impacts_of_force(lasting));
        }
        for (pair, contact) in scenery.contacts.iter().enumerate() {
            let points = contact.points.iter().zip(&self.forces[contact.first..]);
            let points = points.filter_map(|(point, forces)| Some((point, forces.as_ref()?)));
            // By the numbers of those that touch, as in the plots of their forces.
            let points: Vec<_> = points.enumerate().map(|(k, (point, forces))| (k, point, forces)).collect();
            if points.is_empty() {
                continue;
            }
            let name = recorder.pair_name(contact);
            let of = || several.then(|| (name.clone(), "contacts"));
            let normal = largest(points.iter().flat_map(|(_, _, forces)| &forces.normal));
            self.normal[pair] = holds(normal, strongest);
            // Of some only impacts are known, as of balls that strike each other.
            if !self.normal[pair] && points.iter().all(|(_, _, forces)| forces.impacts.is_empty()) {
                left_out.push(("force of", of(), [normal, strongest], "N"));
                self.forces[contact.first..contact.first + contact.points.len()].fill(None);
                continue;
            }
            let (force, scale) = match &self.sums[pair] {
                Some(sum) => (largest(&sum.y), SUM_SCALE * strongest),
                None => (largest(points.iter().flat_map(|(_, _, forces)| &forces.tangential)), strongest),
            };
            self.tangential[pair] = holds(force, scale);
            if !self.tangential[pair] {
                left_out.push(("tangential force of", of(), [force, scale], "N"));
            }
            let reach = scenery.blocks[contact.block].reach;
            let scale = SLIP_SCALE * reach;
            // Where no point slips by its state, or by no more than rounding, the rounding of what sticks has added up.
            let rounding = unseen_slip(recorder, contact);
            let scale_of = |forces: &ForceCurve| {
                let slips = forces.state.contains(&ContactState::Slip) || forces.slid > rounding;
                if slips { scale } else { STUCK_SCALE * scale }
            };
            let slips = |forces: &ForceCurve| holds(largest(&forces.slip), scale_of(forces));
            let slipping: Vec<_> = points.iter().filter(|(_, _, forces)| slips(forces)).collect();
            if slipping.is_empty() {
                let most = largest(points.iter().flat_map(|(_, _, forces)| &forces.slip));
                let scale = points.iter().map(|(_, _, forces)| scale_of(forces)).fold(0.0, f64::max);
                left_out.push(("slip of", of(), [most, scale], "m"));
                continue;
            }
            let lines = slipping.iter().map(|(number, point, forces)| Line {
                label: point.label.clone(),
                number: *number,
                y: std::iter::once(0.0).chain(forces.slip.iter().copied()).collect(),
                is_raw: false,
                itself: Vec::new(),
                of: None,
            });
            panels.push(TimePanel {
                id: format!("slip-{pair}"),
                notes: differ(&points).then(|| Note::of_plot(WHILE_IT_PRESSES)).into_iter().collect(),
                title: "Slip".to_owned(),
                of_contact: Some((pair, if several { name } else { String::new() })),
                description: "Slip of the contacts over time".to_owned(),
                measure: Measure::Deflection,
                unit: String::new(),
                least: ROUNDING * scale,
                guides: Vec::new(),
                t: None,
                cut: false,
                place: Place::Forces,
                lines: lines.collect(),
            });
        }
        self.panels.extend(panels);
        left_out.into_iter().for_each(|(what, of, sizes, unit)| self.leave_out(what, of, sizes, unit));
    }
}
