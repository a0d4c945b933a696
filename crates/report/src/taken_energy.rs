//! The warning that a scheme's own rule took energy out of the motion.

use crate::Warning;
use crate::made_energy::percent;
use crate::with_digits;
use teeter_integrator::Ledger;
use teeter_scenario::scene::{Scene, SchemeName};

/// The kind of the warning.
pub const ENERGY_TAKEN: &str = "energy-taken";

/// From this part of the energy scale on.
const PART: f64 = 0.01;

/// The warning of a run whose scheme took 1 % of the energy scale or more by its own rule (column `numerical`).
pub(crate) fn warning(scene: &Scene, ledger: &Ledger) -> Option<Warning> {
    let taken = -ledger.sum.numerical;
    // Also false for NaN.
    let much = taken >= PART * ledger.scale && ledger.scale > 0.0;
    if !much {
        return None;
    }
    let (how, remedy) = match scene.time.scheme {
        SchemeName::Resolved => (
            "from oscillations of beams that are too fast for its steps",
            "a shorter step (`time.step`) follows more of them",
        ),
        SchemeName::GeneralizedAlpha => {
            ("by damping what is fast", "take a shorter step (`time.step`), or a larger `time.spectral_radius`")
        }
        _ => ("by its rule with `time.theta` over 1/2", "`time.theta = 0.5` takes none"),
    };
    let text = format!(
        "{} took {} of energy, {} of the scene's energy scale of {}, {how}; {remedy}",
        scene.time.scheme.word(),
        with_digits(taken, "J", 3),
        percent(taken / ledger.scale),
        with_digits(ledger.scale, "J", 3),
    );
    Some(Warning { code: ENERGY_TAKEN.into(), count: 1, first_t: None, text })
}
