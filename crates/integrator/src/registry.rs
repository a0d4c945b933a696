//! The list of schemes by name.

use crate::{
    EventDriven, EventDrivenSettings, GeneralizedAlpha, GeneralizedAlphaSettings, MoreauJean, MoreauJeanClosed,
    MoreauJeanClosedSettings, MoreauJeanLocated, MoreauJeanLocatedSettings, MoreauJeanProjected,
    MoreauJeanProjectedSettings, MoreauJeanSettings, Resolved, ResolvedSettings, Scheme,
};

/// A scheme in the list.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct SchemeEntry {
    /// The name by which users choose it.
    pub name: &'static str,
    /// What it is, in a sentence.
    pub about: &'static str,
    make: fn() -> Option<Box<dyn Scheme<2>>>,
}

impl SchemeEntry {
    /// The scheme with its default settings; `None` only if they are out of range, which is a fault
    /// of this crate.
    #[must_use]
    pub fn make(&self) -> Option<Box<dyn Scheme<2>>> {
        (self.make)()
    }
}

/// All schemes, for plane models.
///
/// ```
/// let names: Vec<_> = teeter_integrator::schemes().iter().map(|scheme| scheme.name).collect();
/// assert!(names.starts_with(&["moreau-jean", "moreau-jean-closed", "moreau-jean-located", "event-driven", "resolved"]));
/// assert!(names.ends_with(&["moreau-jean-projected", "generalized-alpha"]));
/// ```
#[must_use]
pub fn schemes() -> &'static [SchemeEntry] {
    &[
        SchemeEntry {
            name: MoreauJean::<2>::NAME,
            about: "Moreau and Jean's θ scheme: contacts by the gap at a predicted position, impacts at velocity level",
            make: || Some(Box::new(MoreauJean::new(MoreauJeanSettings::default()).ok()?)),
        },
        SchemeEntry {
            name: MoreauJeanClosed::<2>::NAME,
            about: "the same step with contacts that stay closed: no contact gives energy, and gaps don't drift apart",
            make: || Some(Box::new(MoreauJeanClosed::new(MoreauJeanClosedSettings::default()).ok()?)),
        },
        SchemeEntry {
            name: MoreauJeanLocated::<2>::NAME,
            about: "the closed step, divided where a contact closes: of second order through impacts on rigid ground",
            make: || Some(Box::new(MoreauJeanLocated::new(MoreauJeanLocatedSettings::default()).ok()?)),
        },
        SchemeEntry {
            name: EventDriven::NAME,
            about: "smooth motion by a method of order 8 between events, all of them located to rounding",
            make: || Some(Box::new(EventDriven::new(EventDrivenSettings::default()).ok()?)),
        },
        SchemeEntry {
            name: Resolved::<2>::NAME,
            about: "contact with a beam as a force that keeps the gap closed, in steps halved where contacts close",
            make: || Some(Box::new(Resolved::new(ResolvedSettings::default()).ok()?)),
        },
        SchemeEntry {
            name: MoreauJeanProjected::<2>::NAME,
            about: "the closed step, with places projected onto what contacts allow: no penetration but rounding",
            make: || Some(Box::new(MoreauJeanProjected::new(MoreauJeanProjectedSettings::default()).ok()?)),
        },
        SchemeEntry {
            name: GeneralizedAlpha::<2>::NAME,
            about: "smooth motion by generalized-α, which damps what the step can't resolve; impacts, and projected places",
            make: || Some(Box::new(GeneralizedAlpha::new(GeneralizedAlphaSettings::default()).ok()?)),
        },
    ]
}
