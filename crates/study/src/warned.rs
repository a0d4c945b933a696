//! What `check` and `run` warn of in a setting, and which of it is of the scene and not of the
//! setting.

use teeter_report::Warning;
use teeter_scenario::diagnostic::Diagnostic;

/// A warning of a setting.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warned {
    /// What it is about, the same for two settings that are warned of the same: the key and the
    /// rule without its numbers for what is known before the run, the code for what the run meets.
    pub kind: String,
    /// What the user would read.
    pub text: String,
}

impl Warned {
    /// The warnings of a scene before its run (notes are none), and those of its run; each kind
    /// once.
    pub(crate) fn of<'a>(before: impl Iterator<Item = &'a Diagnostic>, run: &[Warning]) -> Vec<Self> {
        let rule = |found: &Diagnostic| {
            let words: String = found.rule.chars().filter(|c| c.is_alphabetic() || *c == ' ').collect();
            Self { kind: format!("{}: {words}", found.path), text: format!("{}: {}", found.path, found.rule) }
        };
        let met = |warning: &Warning| Self { kind: warning.code.to_string(), text: warning.text.clone() };
        let mut all: Vec<Self> = Vec::new();
        for warned in before.map(rule).chain(run.iter().map(met)) {
            if all.iter().all(|known| known.kind != warned.kind) {
                all.push(warned);
            }
        }
        all
    }
}

/// The kinds that are of the scene and not of a setting: the reference has them, and so has every
/// one of `rows`. Who can't avoid a warning by what is chosen is not to be kept from choosing.
pub(crate) fn of_the_scene<'a>(reference: &[Warned], mut rows: impl Iterator<Item = &'a [Warned]>) -> Vec<String> {
    let has = |warned: &[Warned], kind: &str| warned.iter().any(|one| one.kind == kind);
    let mut kinds: Vec<String> = reference.iter().map(|one| one.kind.clone()).collect();
    rows.all(|row| {
        kinds.retain(|kind| has(row, kind));
        !kinds.is_empty()
    });
    kinds
}

#[cfg(test)]
mod tests {
    use super::*;

    fn warned(kinds: &[&str]) -> Vec<Warned> {
        kinds.iter().map(|kind| Warned { kind: (*kind).to_owned(), text: String::new() }).collect()
    }

    #[test]
    fn what_the_reference_and_every_row_are_warned_of_is_of_the_scene() {
        let rows = [warned(&["sag", "step", "tilt"]), warned(&["tilt", "sag"]), warned(&["sag", "unsolved"])];
        let all = || rows.iter().map(Vec::as_slice);
        assert_eq!(of_the_scene(&warned(&["tilt", "sag"]), all()), ["sag"]);
        assert!(of_the_scene(&warned(&["tilt"]), all()).is_empty(), "one row is without");
        assert!(of_the_scene(&[], all()).is_empty(), "a step that is too long everywhere is no matter of the scene");
    }

    #[test]
    fn a_rule_with_other_numbers_is_the_same_warning() {
        let found = |rule: &str| vec![Diagnostic::error("s.toml", rule)];
        let kind = |rule: &str| Warned::of(found(rule).iter(), &[])[0].kind.clone();
        assert_eq!(kind("sags by 1.20e-3 m, 1/48 of the span"), kind("sags by 9.9e-4 m, 1/49 of the span"));
        assert_ne!(kind("sags by 1.20e-3 m"), kind("shortens by 1.20e-3 m"));
        assert_eq!(Warned::of([found("a 1").remove(0), found("a 2").remove(0)].iter(), &[]).len(), 1);
    }
}
