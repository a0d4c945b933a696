//! The warning that an event-driven run had steps in which not every event was located.

use crate::Warning;
use teeter_integrator::State;
use teeter_scenario::scene::Scene;

/// The kind of the warning that steps were taken without locating their events: it is known at the end of a run, and in its summary only.
pub const UNLOCATED: &str = "unlocated";

/// The warning of a run whose scheme promises located events, and had steps without.
pub(crate) fn warning(scene: &Scene, state: &State) -> Option<Warning> {
    let (count, scheme) = (state.tally.unlocated_steps, scene.time.scheme);
    (count > 0 && scheme.has_own_steps()).then(|| Warning {
        code: UNLOCATED.into(),
        count,
        first_t: None,
        text: format!(
            "{} gave up in {}, which went on as in moreau-jean-located: more happens there than it locates, or contacts have no accelerations that \
             fit their law; from there on the motion is as accurate as the step; take a shorter one (`time.step`) and compare",
            scheme.word(),
            if count == 1 { "1 step".to_owned() } else { format!("{count} steps") }
        ),
    })
}
