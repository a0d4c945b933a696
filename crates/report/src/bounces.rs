//! Bounces that a run's steps cut short, and landings that hang on them.
//!
//! The schemes that keep contacts closed end the bounces of a contact as they become shorter than two steps. By Newton's e they would go on:
//! each is e times as long as the one before, all together 2h/(1 − e) at most. A body that lands on another contact meanwhile is caught by both
//! where the bounces were cut, and by one, most likely, where they go on: motions that part there by a part of themselves, however small the
//! bounces are. Runs with other steps that cut them too agree with each other, and are all wrong.

use serde::{Deserialize, Serialize};
use teeter_detect::ContactId;
use teeter_integrator::{Contact, Model, StepReport};

/// The kind of the warning.
pub const CONTESTED: &str = "contested-landing";

/// A speed after a closing below this part of that before it is none.
const NONE_LEFT: f64 = 1e-3;

/// The impulse of a contact that takes no part in a landing, as a part of the largest.
const NO_PART: f64 = 1e-3;

/// A contact whose bounces were cut.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Cut {
    id: ContactId,
    /// Until when they may go on, s.
    until: f64,
}

/// A landing that a contact took part in whose bounces were cut.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Contested {
    /// When, s.
    pub t: f64,
    /// The contact that closed.
    pub landed: ContactId,
    /// The contact that was kept closed.
    pub cut: ContactId,
}

/// The bounces that were cut, and the first landing that hangs on one.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Bounces {
    cut: Vec<Cut>,
    contested: Option<Contested>,
}

impl Bounces {
    /// Takes a step in.
    pub fn enter(&mut self, model: &Model<2>, step: &StepReport<'_, 2>) {
        if self.contested.is_some() {
            return;
        }
        let h = step.t_end - step.t_start;
        for phase in step.active() {
            let closes = |contact: &&Contact<2>| !contact.persisting && contact.p[0] > 0.0;
            // What has opened bounces again, and is cut again. An impact shows only who takes part in it.
            let lasts = phase.end > phase.start;
            let still = |cut: &Cut| !lasts || phase.contacts.iter().any(|contact| contact.id == cut.id);
            self.cut.retain(|cut| phase.end <= cut.until && still(cut));
            let hardest = phase.contacts.iter().filter(closes).max_by(|a, b| a.p[0].total_cmp(&b.p[0]));
            if let Some(landed) = hardest {
                let bodies = |contact: &Contact<2>| contact.sides.map(|side| side.body);
                let held = phase.contacts.iter().filter(|contact| {
                    let takes_part = contact.persisting && contact.p[0] > NO_PART * landed.p[0];
                    takes_part && bodies(contact) == bodies(landed)
                });
                let cut = held.filter_map(|contact| self.cut.iter().find(|cut| cut.id == contact.id)).next();
                self.contested = cut.map(|cut| Contested { t: phase.end, landed: landed.id, cut: cut.id });
            }
            for contact in phase.contacts.iter().filter(closes) {
                let Ok(law) = model.law(contact.law) else { continue };
                // It left with less where a bounce within the step is passed over.
                let left = contact.u_after[0] > NONE_LEFT * contact.u_before[0].abs();
                if law.restitution > 0.0 && !left {
                    self.cut.retain(|cut| cut.id != contact.id);
                    let lasts = 2.0 * h / (1.0 - law.restitution);
                    self.cut.push(Cut { id: contact.id, until: phase.end + lasts });
                }
            }
        }
    }

    /// The first landing that hangs on bounces which were cut.
    #[must_use]
    pub fn contested(&self) -> Option<Contested> {
        self.contested
    }
}
