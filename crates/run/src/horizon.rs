//! Until when the motion of a run can be told, and what is said of it.

use std::sync::atomic::AtomicBool;
use teeter_report::{HORIZON, Record};
use teeter_scenario::scene::Scene;
use teeter_study::{DIVERGED, Divergence, Failure, PERTURBATION};

/// Enters the horizon into the record, and a warning where it is before the end of the run. Whether
/// it was not interrupted.
pub(crate) fn find(scene: &Scene, cancel: Option<&AtomicBool>, record: &mut Record) -> bool {
    let never = AtomicBool::new(false);
    match teeter_study::divergence(scene, cancel.unwrap_or(&never)) {
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
        true => format!("{what} it is {percent:.0} % off from t = {t:.4} s on"),
        false => format!("{what} it is the same to the end"),
    };
    let sensitive = by_start < end;
    let chatter = match reclosures {
        _ if !sensitive => String::new(),
        0 => "; so small a change decides it there, as where a block just overturns or not".to_owned(),
        count => format!(
            "; {count} contacts were lost and closed again within three steps (chatter): small changes decide the order in which corners strike"
        ),
    };
    let remedy = if by_step < by_start {
        "; a shorter step (`time.step`) carries further"
    } else {
        "; no step carries further than a start is known"
    };
    format!(
        "the motion can be told up to t = {:.4} s: {}, {}{chatter}{remedy}",
        divergence.horizon(),
        until("with half the step", by_step),
        until(&format!("started {PERTURBATION:.0e} beside itself"), by_start),
    )
}
