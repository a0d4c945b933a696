//! Warnings and notes about records that prescribe motions.

use crate::diagnostic::Diagnostic;
use crate::document::Document;
use crate::scene::RecordScene;

/// A velocity at the end of a record of at least this fraction of its largest one gives a warning.
const LEFT_OVER: f64 = 0.01;

/// Warnings, and notes.
pub(crate) fn of(record: &RecordScene, end: f64, document: &Document) -> (Option<Diagnostic>, Option<Diagnostic>) {
    let path = |key: &str| format!("{}.{key}", record.path);
    let of = &record.record;
    if of.peak_acceleration() == 0.0 {
        let rule = "the record is 0 throughout, and has no effect";
        return (Some(document.error(&path("record"), rule, "check the file, from, to and scale").as_warning()), None);
    }
    let (velocities, _) = of.motion();
    let (last, largest) = (velocities.last().copied().unwrap_or(0.0), of.velocity_peak());
    if end > of.duration() && last.abs() > LEFT_OVER * largest.size {
        let rule = format!(
            "the record ends at {:.4} s with a velocity of {last:.3e} m/s, {:.0} % of its largest one, which goes on until the end of the \
             run at {end} s",
            of.duration(),
            100.0 * last.abs() / largest.size
        );
        let remedy = "correct its baseline, such as baseline = \"linear\", or end the run with the record";
        return (Some(document.error(&path("record"), rule, remedy).as_warning()), None);
    }
    let strong = of.husid_times([0.05, 0.95]).map_or(0.0, |[_, last]| last);
    let note = (end < strong).then(|| {
        let rule = format!("the run ends at {end} s, before 95 % of the record's Arias intensity, at {strong:.2} s");
        document.error(&path("record"), rule, "extend the run (time.end), or choose a part by from and to").as_note()
    });
    (None, note)
}
