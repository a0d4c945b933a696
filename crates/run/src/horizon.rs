//! The horizon of a run, up to which its motion is predictable, and its warning.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use teeter_report::{HORIZON, Record};
use teeter_scenario::scene::Scene;
use teeter_study::{DIVERGED, Divergence, Failure, PERTURBATION};

/// Enters the horizon into the record, with a warning if it is before the end of the run. Returns
/// false if interrupted.
pub(crate) fn find(scene: &Scene, cancel: &Arc<AtomicBool>, record: &mut Record) -> bool {
    match teeter_study::divergence(scene, cancel) {
        Ok(divergence) => {
            record.horizon = Some(divergence.horizon());
            if !divergence.is_whole() {
                let text = text(&divergence, record.reclosure_count);
                record.warnings.enter(HORIZON, Some(divergence.horizon()), || text);
            }
        }
        Err(Failure::Interrupted) => return false,
        Err(failure) => {
            record.warnings.enter(HORIZON, None, || format!("the horizon could not be found: {failure}"));
        }
    }
    true
}

fn text(divergence: &Divergence, reclosures: u64) -> String {
    let Divergence { by_start, by_step, end, .. } = *divergence;
    let percent = 100.0 * DIVERGED;
    let until = |what: &str, t: f64| match t < end {
        true => format!("{what} it differs by {percent:.0} % from t = {t:.4} s on"),
        false => format!("{what} it agrees to the end"),
    };
    let sensitive = by_start < end;
    let chatter = match reclosures {
        _ if !sensitive => String::new(),
        0 => "; the motion is that sensitive there, for example because a block almost overturns".to_owned(),
        count => format!(
            "; {count} contacts were lost and closed again within three steps (chatter): the order of impacts of corners depends on small changes"
        ),
    };
    let remedy = if by_step < by_start {
        "; a shorter step (`time.step`) extends this"
    } else {
        "; a shorter step doesn't extend this"
    };
    format!(
        "the motion is predictable up to t = {:.4} s: {}, {}{chatter}{remedy}",
        divergence.horizon(),
        until("with half the step", by_step),
        until(&format!("with the initial state perturbed by {PERTURBATION:.0e}"), by_start),
    )
}
