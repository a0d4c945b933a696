//! The warning that contacts, or a scheme, made energy, and what to take instead.

use crate::Warning;
use crate::with_digits;
use teeter_integrator::{Ledger, State};
use teeter_scenario::scene::{Scene, SchemeName};

/// The kind of the warning that contacts made energy: it is known at the end of a run, and in its summary only.
pub const ENERGY_MADE: &str = "energy-made";

/// From this part of the energy scale or of the energy lost on, energy made at contacts is a warning.
const PART: f64 = 0.01;

/// Energy made below this part of the energy scale is none to speak of, however little is lost, as before the first impact.
const NOTHING: f64 = 1e-5;

/// The warning of a run that made energy at its contacts: at least 1 % of the energy scale, or of the energy lost.
pub(crate) fn warning(scene: &Scene, state: &State) -> Option<Warning> {
    let ledger = &state.ledger;
    let (made, lost) = (ledger.positive_contact_work, lost(ledger));
    // Also false for NaN.
    let much = |made: f64| made >= PART * ledger.scale.min(lost) && made > NOTHING * ledger.scale;
    let text = if much(made.sum) {
        text(scene, ledger, lost)
    } else if much(by_scheme(ledger)) {
        text_of_scheme(scene, ledger)
    } else {
        return None;
    };
    Some(Warning { code: ENERGY_MADE.into(), count: 1, first_t: None, text })
}

/// What the scheme itself gave the bodies, by projecting places or by its rule, J.
fn by_scheme(ledger: &Ledger) -> f64 {
    ledger.sum.projection.max(0.0) + ledger.sum.numerical.max(0.0)
}

fn text_of_scheme(scene: &Scene, ledger: &Ledger) -> String {
    let made = by_scheme(ledger);
    format!(
        "{} made {} of energy, {} of the scene's energy scale of {}: {} by projecting places and {} by its own rule; \
         the energy of the motion is off by as much; take a shorter step (`time.step`), or `time.scheme = \"{}\"`, which makes none",
        scene.time.scheme.word(),
        joules(made),
        percent(made / ledger.scale),
        joules(ledger.scale),
        joules(ledger.sum.projection.max(0.0)),
        joules(ledger.sum.numerical.max(0.0)),
        SchemeName::MoreauJeanClosed.word()
    )
}

fn joules(energy: f64) -> String {
    with_digits(energy, "J", 3)
}

/// What contacts, friction, damping and the scheme took from the bodies, J.
fn lost(ledger: &Ledger) -> f64 {
    let sum = &ledger.sum;
    let contacts = ledger.positive_contact_work.sum - (sum.contact + sum.friction);
    contacts.max(0.0) + (-sum.viscous).max(0.0) + (-sum.numerical).max(0.0)
}

fn text(scene: &Scene, ledger: &Ledger, lost: f64) -> String {
    let made = ledger.positive_contact_work;
    let steps = if made.steps == 1 { "1 step".to_owned() } else { format!("{} steps", made.steps) };
    let of_lost = if lost > 0.0 {
        format!("{} of the {} that were lost", percent(made.sum / lost), joules(lost))
    } else {
        "nothing was lost".to_owned()
    };
    format!(
        "contacts made {} of energy in {steps}, {} in the one that made most: {of_lost}, {} of the scene's energy \
         scale of {}; no contact does that: the energy of the motion is off by as much; {}",
        joules(made.sum),
        joules(made.largest),
        percent(made.sum / ledger.scale),
        joules(ledger.scale),
        remedy(scene)
    )
}

pub(crate) fn percent(part: f64) -> String {
    let percent = 100.0 * part;
    if percent < 0.1 {
        "less than 0.1 %".to_owned()
    } else if percent < 10.0 {
        format!("{percent:.1} %")
    } else {
        format!("{percent:.0} %")
    }
}

/// What to take instead. The closed scheme's contacts make none; that a shorter step or the energetic law helps in the other one could not be
/// found (`docs/schemes.md`, "Energy made").
fn remedy(scene: &Scene) -> String {
    match scene.time.scheme {
        scheme if scheme.keeps_energy() => "take a shorter step (`time.step`)".to_owned(),
        // Contacts with a body that is moved as prescribed may give energy in the closed scheme, too.
        _ if scene.motions().any(|(_, motion)| motion.is_given()) => format!(
            "take a shorter step (`time.step`), or `time.scheme = \"{}\"` with one: where bodies are moved as prescribed neither scheme's contacts \
             are free of it",
            SchemeName::MoreauJeanClosed.word()
        ),
        _ => {
            let theta = if scene.time.theta == 0.5 { "" } else { " and `theta = 0.5`" };
            format!(
                "take `time.scheme = \"{}\"`{theta}, whose contacts make none; a shorter step of this scheme can make more",
                SchemeName::MoreauJeanClosed.word()
            )
        }
    }
}
