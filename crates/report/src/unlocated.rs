//! The warning that a run had steps in which not every impact or event was located.

use crate::Warning;
use teeter_integrator::State;
use teeter_scenario::scene::Scene;

/// The kind of the warning that steps were taken without locating all of their impacts or events: it is known at the end of a run, and in its
/// summary only.
pub const UNLOCATED: &str = "unlocated";

/// The warning of a run that had such steps. A scheme that locates nothing counts none.
pub(crate) fn warning(scene: &Scene, state: &State) -> Option<Warning> {
    let (count, scheme) = (state.tally.unlocated_steps, scene.time.scheme);
    let steps = if count == 1 { "1 step".to_owned() } else { format!("{count} steps") };
    let what = if scheme.has_own_steps() {
        format!(
            "{} gave up in {steps}, which went on as in moreau-jean-located: more happens there than it locates, or contacts have no \
             accelerations that fit their law",
            scheme.word()
        )
    } else {
        format!(
            "in {steps} not all impacts and ends of slides were located by {}, so that the rest of such a step was taken with its fixed length",
            scheme.word()
        )
    };
    (count > 0).then(|| Warning {
        code: UNLOCATED.into(),
        count,
        first_t: None,
        text: format!(
            "{what}; from there on the motion is as accurate as the step; take a shorter one (`time.step`) and compare"
        ),
    })
}
