//! Warnings of `check` and `run` about a setting, and which of them belong to the scene.

use teeter_report::Warning;
use teeter_scenario::diagnostic::Diagnostic;

/// A warning of a setting.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SettingWarning {
    /// Its kind, equal for settings with the same warning: key and rule without numbers for
    /// warnings before the run, the code for those of the run.
    pub kind: String,
    /// Its text for users.
    pub text: String,
}

impl SettingWarning {
    /// The warnings of a scene before its run (without notes), and those of its run; each kind
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

/// The kinds that belong to the scene, not to a setting: the reference and all `rows` have them. A
/// warning that can't be avoided doesn't exclude a setting.
pub(crate) fn of_the_scene<'a>(
    reference: &[SettingWarning],
    mut rows: impl Iterator<Item = &'a [SettingWarning]>,
) -> Vec<String> {
    let has = |warned: &[SettingWarning], kind: &str| warned.iter().any(|one| one.kind == kind);
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

    fn warned(kinds: &[&str]) -> Vec<SettingWarning> {
        kinds.iter().map(|kind| SettingWarning { kind: (*kind).to_owned(), text: String::new() }).collect()
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
        let kind = |rule: &str| SettingWarning::of(found(rule).iter(), &[])[0].kind.clone();
        assert_eq!(kind("sags by 1.20e-3 m, 1/48 of the span"), kind("sags by 9.9e-4 m, 1/49 of the span"));
        assert_ne!(kind("sags by 1.20e-3 m"), kind("shortens by 1.20e-3 m"));
        assert_eq!(SettingWarning::of([found("a 1").remove(0), found("a 2").remove(0)].iter(), &[]).len(), 1);
    }
}
