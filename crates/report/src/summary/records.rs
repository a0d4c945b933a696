//! The recorded accelerations of a scene, as `summary.json` has them.

use serde::Serialize;
use teeter_integrator::Signal as _;
use teeter_scenario::scene::RecordScene;

/// A run that is shorter than a record by no more than rounding has all of it.
const ROUNDED: f64 = 1.0 - 1e-9;

/// A recorded acceleration that prescribes a component of a motion, as used: cut, corrected, scaled.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RecordSummary {
    /// The table of the scene that names it, such as `ground.motion.x`.
    pub motion: String,
    /// The file, as named in the scene.
    pub file: String,
    /// The station as named in the file; may be empty.
    pub station: String,
    /// The event and other text of the file; may be empty.
    pub description: String,
    /// Time between two values, s.
    pub step: f64,
    /// Time from the first value to the last, s.
    pub duration: f64,
    /// Peak ground acceleration, m/s².
    pub peak_acceleration: f64,
    /// The same of the part that was run, where the run is shorter.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub peak_acceleration_in_run: Option<f64>,
    /// Peak ground velocity, m/s, from rest.
    pub peak_velocity: f64,
    /// Peak ground displacement, m, from rest.
    pub peak_displacement: f64,
    /// Arias intensity π/(2g) ∫ a² dt, m/s.
    pub arias_intensity: f64,
    /// Time from 5 % to 95 % of it, s.
    pub significant_duration: f64,
}

impl RecordSummary {
    /// The numbers of a record in a run up to the time `t` (s).
    pub(super) fn up_to(t: f64, of: &RecordScene) -> Self {
        let record = &of.record;
        let run = (0..record.accelerations().len()).take_while(|k| record.time(*k) <= t);
        // Between two values it is linear: at the end of the run, too.
        let peak = || run.map(|k| record.accelerations()[k].abs()).fold(of.table().value(t).abs(), f64::max);
        Self { peak_acceleration_in_run: (t < ROUNDED * record.duration()).then(peak), ..Self::new(of) }
    }

    /// The numbers of a record as it is used.
    #[must_use]
    pub fn new(of: &RecordScene) -> Self {
        let record = &of.record;
        Self {
            motion: of.path.clone(),
            file: of.file.clone(),
            station: record.station().to_owned(),
            description: record.description().to_owned(),
            step: record.dt(),
            duration: record.duration(),
            peak_acceleration: record.peak_acceleration(),
            peak_acceleration_in_run: None,
            peak_velocity: record.velocity_peak().size,
            peak_displacement: record.displacement_peak().size,
            arias_intensity: record.arias_intensity(),
            significant_duration: record.significant_duration(),
        }
    }
}
