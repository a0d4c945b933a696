//! Warnings about records that prescribe motions.

use crate::diagnostic::Diagnostic;
use crate::document::Document;
use crate::scene::RecordScene;
use teeter_text::readable::with_digits;

/// A velocity at the end of a record of at least this fraction of its largest one gives a warning.
const LEFT_OVER: f64 = 0.01;

/// Warns of a record without effect, or with a velocity that is left over at its end, or of which most comes after the run.
pub(crate) fn warning(record: &RecordScene, end: f64, document: &Document) -> Option<Diagnostic> {
    let path = format!("{}.record", record.path);
    let (last, largest) = (record.last_velocity, record.largest_velocity);
    if largest == 0.0 {
        let rule = "the record is 0 throughout, and has no effect";
        return Some(document.error(&path, rule, "check the file, from, to and scale").as_warning());
    }
    if let Some(strong) = record.strong_until.filter(|strong| end < *strong) {
        let rule = format!("the run ends at {end} s, before 95 % of the record's Arias intensity, at {strong:.2} s");
        let remedy = "extend the run (time.end), or choose a part by from and to";
        return Some(document.error(&path, rule, remedy).as_warning());
    }
    let lasts = record.record.duration();
    if end <= lasts || last.abs() <= LEFT_OVER * largest {
        return None;
    }
    let rule = format!(
        "the record ends at {lasts:.4} s with a velocity of {}, {:.0} % of its largest one, which goes on until the end of the \
         run at {end} s",
        with_digits(last, "m/s", 3),
        100.0 * last.abs() / largest
    );
    let remedy = "correct its baseline, such as baseline = \"linear\", or end the run with the record";
    Some(document.error(&path, rule, remedy).as_warning())
}
