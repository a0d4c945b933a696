//! Warnings of a run: counted, the first of each kind kept, told as they come but not without end.

use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A kind of warning that a run met.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Warning {
    /// Its kind, for programs.
    pub code: Cow<'static, str>,
    /// How often.
    pub count: u64,
    /// When first, s; `null` if it isn't about a time.
    pub first_t: Option<f64>,
    /// The first one's text.
    pub text: String,
}

impl Warning {
    /// What it is about, in a few words for a list of several; its text says the rest.
    #[must_use]
    pub fn subject(&self) -> Cow<'_, str> {
        Cow::Borrowed(match self.code.as_ref() {
            "under-resolved" => "steps too long for impacts",
            "under-resolved-flight" => "theta too far from 0.5 for a flight",
            "under-resolved-swings" => "steps too long for the swings of a beam",
            crate::UNLOCATED => "impacts or ends of slides that were not located",
            crate::bounces::CONTESTED => "a landing that hangs on the step",
            "crest-impact" => "a base struck by a hump of a beam",
            "unconverged" => "steps whose contacts were not solved",
            "far-turn" => "a turn too far for a step",
            "fast-pass" => "a motion too far for a step",
            "model-limits" => "contacts that the model left out",
            "large-deflection" => "a large deflection",
            "deep-penetration" => "a corner deep in a surface",
            "between-corners" | "past-the-end" | "passes-through" => "bodies inside each other",
            "energy-account" => "energy that does not add up",
            crate::made_energy::ENERGY_MADE => "energy made at contacts",
            crate::taken_energy::ENERGY_TAKEN => "energy taken by the scheme",
            YIELD => "stress beyond the yield strength",
            HORIZON => "no prediction up to the end",
            "ended" => "an early end",
            "scene" => return self.finding().and_then(shortened).map_or(Cow::Borrowed("the scene"), without_value),
            other => other,
        })
    }

    /// What was found in a scene, without the file and the place, and without what would help.
    fn finding(&self) -> Option<&str> {
        let (_, from_file) = self.text.lines().next()?.split_once(": ")?;
        Some(from_file.split_once(": ")?.1)
    }
}

/// A finding of a scene of up to so many bytes says itself what it is about.
const SHORT: usize = 110;

/// The longest beginning of a finding that is short and ends where a clause does.
fn shortened(finding: &str) -> Option<&str> {
    let ends = clauses(finding).chain([finding.len()]);
    ends.take_while(|end| *end <= SHORT).last().map(|end| &finding[..end])
}

/// Where clauses of a finding end, but for the last: not within a value, which is quoted or in brackets.
fn clauses(finding: &str) -> impl Iterator<Item = usize> {
    let (mut quoted, mut depth) = (false, 0_usize);
    finding.char_indices().filter_map(move |(at, of)| {
        match of {
            '"' => quoted = !quoted,
            '[' | '{' | '(' if !quoted => depth += 1,
            ']' | '}' | ')' if !quoted => depth = depth.saturating_sub(1),
            _ => {}
        }
        let is_end = matches!(of, ':' | ';' | ',') && finding[at + 1..].starts_with(' ');
        (is_end && !quoted && depth == 0).then_some(at)
    })
}

/// A finding with the name of its key only, not with what the file gives it.
fn without_value(finding: &str) -> Cow<'_, str> {
    let clause = clauses(finding).next().unwrap_or(finding.len());
    match finding[..clause].split_once(" = ") {
        Some((key, _)) => format!("{key}{}", &finding[clause..]).into(),
        None => finding.into(),
    }
}

/// The kind of the warning that a motion can be told up to a time before its end only.
pub const HORIZON: &str = "horizon";

/// The kind of the warning that a beam's stress passes its yield strength: of all steps the largest is told, at the end.
pub const YIELD: &str = "yield";

/// The warnings of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WarningLog {
    warnings: Vec<Warning>,
}

/// Of one kind, this many are told in full; then each time that the count has grown tenfold.
const TOLD: u64 = 3;

impl WarningLog {
    /// Enters a warning, its text made only where it is needed. Returns the text if it is to be told now.
    pub fn enter(&mut self, code: &'static str, t: Option<f64>, text: impl FnOnce() -> String) -> Option<String> {
        let Some(known) = self.warnings.iter_mut().find(|warning| warning.code == code) else {
            let text = text();
            self.warnings.push(Warning { code: code.into(), count: 1, first_t: t, text: text.clone() });
            return Some(text);
        };
        known.count += 1;
        match known.count {
            count if count <= TOLD => Some(text()),
            count if count.ilog10() > (count - 1).ilog10() => Some(format!("{} ({count} times so far)", text())),
            _ => None,
        }
    }

    /// Enters a warning of something of which the largest counts, to be told at the end: its text is made if it is `largest` so far, and
    /// takes the place of the one before.
    pub fn enter_largest(&mut self, code: &'static str, t: f64, largest: bool, text: impl FnOnce() -> String) {
        match self.warnings.iter_mut().find(|warning| warning.code == code) {
            Some(known) => {
                known.count += 1;
                if largest {
                    known.text = text();
                }
            }
            None => self.warnings.push(Warning { code: code.into(), count: 1, first_t: Some(t), text: text() }),
        }
    }

    /// Enters what was found in a scene before its run: each finding by itself, unless it is known, as of a run that goes on.
    pub fn enter_finding(&mut self, code: &'static str, text: String) {
        if !self.warnings.iter().any(|known| known.code == code && known.text == text) {
            self.warnings.push(Warning { code: code.into(), count: 1, first_t: None, text });
        }
    }

    /// The warnings, in the order of their first.
    #[must_use]
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn findings_of_a_scene_keep_their_texts() {
        let mut log = WarningLog::default();
        for text in ["al is not used", "stone is not used", "al is not used"] {
            log.enter_finding("scene", text.to_owned());
        }
        let told: Vec<_> = log.warnings().iter().map(|warning| (warning.text.as_str(), warning.count)).collect();
        assert_eq!(told, [("al is not used", 1), ("stone is not used", 1)]);
    }

    #[test]
    fn a_short_finding_of_a_scene_is_its_own_subject() {
        let mut log = WarningLog::default();
        log.enter_finding(
            "scene",
            "warning: a.toml:5:1: material.steel: this material is not used\n  help: use it".to_owned(),
        );
        log.enter_finding("scene", format!("warning: a.toml:5:1: contact.a: {}", "long ".repeat(40)));
        let subjects: Vec<_> = log.warnings().iter().map(Warning::subject).collect();
        assert_eq!(subjects, ["material.steel: this material is not used", "contact.a"]);
    }

    #[test]
    fn of_a_long_finding_of_a_scene_the_first_clauses_are_its_subject() {
        let of = |text: &str| {
            Warning { code: "scene".into(), count: 1, first_t: None, text: text.to_owned() }.subject().into_owned()
        };
        let tilted = "warning: a.toml:15:8: block.post.tilt = \"12 deg\": at or beyond the critical angle atan(width/height) = 8.53 deg of this block";
        assert_eq!(
            of(&format!("{tilted}: released at rest it overturns\n  help: check the angle and its unit")),
            // Not as the file has it.
            tilted[22..].replace(" = \"12 deg\"", "")
        );
        assert_eq!(of(&format!("warning: a.toml:5:1: {}", "long ".repeat(40))), "the scene");
    }

    #[test]
    fn the_subject_of_a_finding_does_not_end_within_a_value() {
        let of = |text: String| Warning { code: "scene".into(), count: 1, first_t: None, text }.subject().into_owned();
        let long = "long ".repeat(30);
        let velocity = r#"block.b.velocity = ["3 m/s", "4 m/s"]"#;
        assert_eq!(of(format!("warning: a.toml:5:1: {velocity}: {long}")), "block.b.velocity");
        let nowhere = format!(r#"warning: a.toml:5:1: points = {{ at = "1 cm", on = "b, c: {long}" }}"#);
        assert_eq!(of(nowhere), "the scene");
    }

    #[test]
    fn of_a_warning_of_the_largest_one_text_is_left() {
        let mut log = WarningLog::default();
        for (k, (value, largest)) in [(3, true), (5, true), (4, false)].into_iter().enumerate() {
            log.enter_largest("yield", k as f64, largest, || value.to_string());
        }
        let told: Vec<_> = log.warnings().iter().map(|of| (of.text.as_str(), of.count, of.first_t)).collect();
        assert_eq!(told, [("5", 3, Some(0.0))]);
    }

    #[test]
    fn a_flood_is_counted_but_told_rarely() {
        let mut log = WarningLog::default();
        let told = (0..1000).filter(|k| log.enter("flood", Some(f64::from(*k)), || "wet".into()).is_some()).count();
        assert_eq!(told, 3 + 3, "the first three, then at 10, 100, 1000");
        assert_eq!(
            log.warnings(),
            [Warning { code: "flood".into(), count: 1000, first_t: Some(0.0), text: "wet".into() }]
        );
    }
}
