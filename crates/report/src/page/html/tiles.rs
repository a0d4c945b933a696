//! The numbers of the summary: those that one wants to know first as tiles, all others as a table.

use super::{scientific, with_code, with_prefix_of};
use crate::all_digits::{with_all_digits, with_zeros};
use crate::page::content;
use crate::verdict::{BodyVerdict, MORE, ROCKED, part};
use crate::{Summary, shortest, with_digits};
use serde_json::Value;
use std::fmt::Write;
use teeter_plot::escaped;

/// The values of `summary.json` by path, such as `energy.largest_residual`.
pub(super) struct Numbers(Value);

/// What the clock measured, which differs from run to run.
const CLOCKED: [&str; 2] = ["wall_seconds", "us_per_step"];

/// What the head of the page says.
const HEADED: [&str; 3] = ["title", "version", "headline"];

impl Numbers {
    pub(super) fn of(summary: &Summary) -> Self {
        // A summary always serialises: its numbers are finite, or null.
        Self(serde_json::to_value(summary).unwrap_or_default())
    }

    /// The text of a value as the file has it, a word without its quotes.
    pub(super) fn text(&self, path: &str) -> String {
        match path
            .split('.')
            .try_fold(&self.0, |value, key| value.get(key).or_else(|| value.get(key.parse::<usize>().ok()?)))
        {
            Some(Value::String(word)) => word.clone(),
            Some(value) => value.to_string(),
            None => String::new(),
        }
    }

    /// The paths of all single values that no tile shows, nor would if they had a meaning for the scene.
    fn others(&self) -> Vec<String> {
        fn walk(value: &Value, path: &str, out: &mut Vec<String>) {
            match value {
                Value::Object(map) => {
                    for (key, value) in map {
                        let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
                        walk(value, &path, out);
                    }
                }
                Value::Array(_) => {}
                _ => out.push(path.to_owned()),
            }
        }
        let mut paths = Vec::new();
        walk(&self.0, "", &mut paths);
        paths.retain(|path| {
            let elsewhere = [&TILES[..], &CLOCKED, &HEADED].iter().any(|paths| paths.contains(&path.as_str()));
            !elsewhere && !path.starts_with("model.")
        });
        paths
    }
}

/// What users want to know first: the numbers of the mechanics, then from [`NUMERIC`] on those of the computation.
const TILES: [&str; 13] = [
    "deflections.0.w",
    "max_phi_over_alpha",
    "overturned_at",
    "rests_from",
    "energy.dissipated",
    "impact_count",
    "horizon",
    "max_penetration",
    "energy.lost_by_scheme",
    "energy.largest_residual",
    "contact.unconverged_steps",
    "contact.max_residual",
    "contact.max_iterations",
];

/// The first tile that is of the computation.
const NUMERIC: usize = 7;

/// A number with as many digits as the headline gives it.
fn as_told(x: f64, unit: &str) -> String {
    with_digits(x, unit, 4).replace('-', "\u{2212}")
}

/// The tiles of the block that slid farthest, of those that didn't overturn or fall, whatever else they do: how far, and how fast it slides on.
fn sliding<'s>(summary: &Summary, slid_on: impl Fn(&str) -> Vec<&'s str>) -> Vec<(String, String, String)> {
    let slid = summary.verdict.iter().enumerate().filter(|(_, of)| of.has_slid);
    let far =
        |of: &BodyVerdict| [of.slid, of.farthest].into_iter().flatten().fold(0.0, |far: f64, way| far.max(way.abs()));
    let Some((number, of)) = slid.max_by(|a, b| far(a.1).total_cmp(&far(b.1))) else { return Vec::new() };
    let tile = |key: &str, label: String, value: Option<f64>, unit| {
        value.map(|value| (format!("verdict.{number}.{key}"), label, as_told(value, unit)))
    };
    let [slid, farthest] = [of.slid, of.farthest].map(|way| way.map(f64::abs));
    let farthest = farthest.filter(|farthest| slid.is_none_or(|slid| *farthest > slid));
    // Where something that goes to and fro is at the end says little.
    let slid = slid.filter(|_| of.to_and_fro.is_none() || farthest.is_none());
    // It ends on one side of its start, and has slid to both.
    let in_all =
        of.slid_in_all.filter(|in_all| of.to_and_fro.is_some() || slid.is_some_and(|slid| *in_all > MORE * slid));
    let whose = if summary.verdict.len() > 1 { format!(" ({})", of.body) } else { String::new() };
    let way = |way: Option<&str>| way.map_or_else(String::new, |way| format!(" {way}"));
    // The sum over all that it slid on.
    let on = slid_on(&of.body);
    let on = if on.len() > 1 { format!(", on {}", on.join(" and ")) } else { String::new() };
    let tiles = [
        tile("slid", format!("Slid{} by{on}{whose}", way(of.slid_to)), slid, "m"),
        tile("farthest", format!("Slid{} at most{whose}", way(of.farthest_to)), farthest, "m"),
        tile("slid_in_all", format!("Slid in all{whose}"), in_all, "m"),
        tile("speed", format!("Speed at the end{whose}"), of.speed, "m/s"),
    ];
    tiles.into_iter().flatten().collect()
}

/// An energy that was lost, J.
fn lost(lost: f64, summary: &Summary) -> String {
    if !content::holds(lost.abs(), summary.energy.scale) {
        return "0 J".to_owned();
    }
    with_zeros(lost, "J", 3).replace('-', "\u{2212}")
}

/// The largest φ/α of a scene, as the sentence at its head counts it.
struct Largest {
    path: String,
    label: String,
    share: f64,
}

impl Largest {
    fn of(summary: &Summary) -> Option<Self> {
        let all = &summary.verdict;
        let is_told_below = |of: &BodyVerdict| {
            of.turns_with
                .as_ref()
                .is_some_and(|base| all.iter().any(|below| below.body == *base && below.column.is_some()))
        };
        let shares = all.iter().enumerate().filter(|(_, of)| !is_told_below(of));
        let shares = shares.filter_map(|(number, of)| Some((number, of, of.share()?)));
        let (number, of, share) = shares.max_by(|a, b| a.2.total_cmp(&b.2))?;
        let whose = match () {
            () if of.column.is_some() => " of the column",
            () if all.len() > 1 => " of a block",
            () => "",
        };
        let since = of
            .settled_at()
            .map_or_else(String::new, |t| format!(" since it could no longer turn over, from t = {}", as_told(t, "s")));
        let path = match () {
            () if of.column.is_some() => format!("verdict.{number}.column_phi_over_alpha"),
            () if summary.max_phi_over_alpha == Some(share) => "max_phi_over_alpha".to_owned(),
            () => format!("verdict.{number}.max_phi_over_alpha"),
        };
        Some(Self { path, label: format!("Largest φ/α{whose}{since}"), share })
    }
}

pub(super) fn tiles<'s>(values: &Numbers, summary: &Summary, slid_on: impl Fn(&str) -> Vec<&'s str>) -> String {
    let mut html = String::new();
    let seconds = |t: Option<f64>| t.map(|t| with_all_digits(t, "s", 4).replace('-', "\u{2212}"));
    for (path, label, shown) in sliding(summary, slid_on) {
        let _ = writeln!(
            html,
            "<div class=\"tile\"><dt>{}</dt><dd data-summary=\"{path}\" data-value=\"{}\">{}</dd></div>",
            escaped(&label),
            escaped(&values.text(&path)),
            in_one_line(&shown)
        );
    }
    let impacts = format!("Impacts{}", summary.strikers());
    // What overturned or slides has gone past its critical angle, or not come near it.
    let rocks = summary.overturned_at.is_none();
    let largest = Largest::of(summary);
    let all = &summary.verdict;
    let overturned: Vec<_> = summary.verdict.iter().filter(|of| of.overturned_at.is_some()).collect();
    let overturned = match overturned[..] {
        [of] if summary.verdict.len() > 1 => format!("Overturned at ({})", of.body),
        [_] => "Overturned at".to_owned(),
        _ => "First overturned at".to_owned(),
    };
    let depth = |x: f64| with_prefix_of(x, 2, "m");
    let at_end = summary.penetration_at_end(depth).map_or_else(String::new, |at_end| format!(", {at_end}"));
    let penetration = format!("Deepest penetration{at_end}");
    // Without contacts their numbers would all be 0.
    let touches = !summary.model.contacts.is_empty() || summary.contact.max_contacts > 0;
    let of_contacts = ["impact_count", "max_penetration"];
    for (number, path) in TILES.into_iter().enumerate() {
        if !touches && (of_contacts.contains(&path) || path.starts_with("contact.")) {
            continue;
        }
        let (label, shown) = match path {
            "deflections.0.w" => ("Largest deflection", summary.deflections.first().map(|of| as_told(of.w, "m"))),
            "max_phi_over_alpha" => match &largest {
                Some(largest) => (largest.label.as_str(), share_of_critical_angle(largest.share).filter(|_| rocks)),
                None => continue,
            },
            "overturned_at" => (overturned.as_str(), seconds(summary.overturned_at)),
            // What stood on a beam throughout moves as long as that does, also where it is still against it.
            "rests_from" if all.iter().any(BodyVerdict::moves_with_beam) => continue,
            "rests_from" if !all.is_empty() && all.iter().all(BodyVerdict::rests_throughout) => {
                ("All at rest", Some("throughout".to_owned()))
            }
            "rests_from" => ("All at rest from", seconds(summary.rests_from)),
            "energy.dissipated" => ("Energy dissipated", Some(lost(summary.energy.dissipated, summary))),
            "energy.lost_by_scheme" => {
                let energy = summary.energy.lost_by_scheme;
                let any = content::holds(energy.abs(), summary.energy.scale);
                ("Energy lost by the scheme", any.then(|| lost(energy, summary)))
            }
            "impact_count" => (impacts.as_str(), Some(summary.impact_count.to_string())),
            "horizon" => ("Predictable up to", seconds(summary.horizon)),
            // As the terminal has it.
            "max_penetration" => (penetration.as_str(), Some(depth(summary.told_penetration()))),
            "energy.largest_residual" => ("Energy residual", Some(scientific(summary.energy.largest_residual))),
            "contact.unconverged_steps" => ("Steps not solved", Some(summary.contact.unconverged_steps.to_string())),
            "contact.max_residual" => ("Contact residual", Some(scientific(summary.contact.max_residual))),
            _ => ("Most iterations", Some(summary.contact.max_iterations.to_string())),
        };
        // What has no meaning for this scene, or wasn't measured.
        let Some(shown) = shown else { continue };
        let path =
            if path == "max_phi_over_alpha" { largest.as_ref().map_or(path, |of| of.path.as_str()) } else { path };
        let bad = path == "contact.unconverged_steps" && summary.contact.unconverged_steps > 0;
        // It may hold a power of ten, but no name.
        let label = if path == "max_penetration" { label.to_owned() } else { escaped(label) };
        let _ = writeln!(
            html,
            "<div class=\"tile{}{}\"><dt>{label}</dt><dd data-summary=\"{path}\" data-value=\"{}\">{}</dd></div>",
            if number >= NUMERIC { " numeric" } else { "" },
            if bad { " bad" } else { "" },
            escaped(&values.text(path)),
            in_one_line(&shown)
        );
    }
    html
}

/// A value that isn't parted from its unit at the end of a line.
fn in_one_line(shown: &str) -> String {
    shown.replace(' ', "\u{a0}")
}

/// What the values of the table are, in words. One that has none here goes by its path.
const NAMES: [(&str, &str); 20] = [
    ("reclosure_count", "Re-closures: contacts that opened for a moment, and closed again without an impact"),
    ("scheme", "Time scheme"),
    ("dt", "Step"),
    ("steps", "Steps"),
    ("t", "Time reached"),
    ("ended", "The run is"),
    ("contact.solver", "Contact solver"),
    (
        "contact.max_contact_residual",
        "Largest residual of a single contact, relative to its own impulse, which of one that hardly presses is rounding (near 1)",
    ),
    ("contact.max_contacts", "Most contacts in a step"),
    ("energy.initial", "Energy at the start"),
    ("energy.final", "Energy at the end"),
    ("energy.lost", "Energy lost, to dissipation and to the scheme"),
    ("energy.scale", "Energy to which residuals are relative"),
    ("energy.positive_contact_work.steps", "Steps in which contacts gave energy"),
    ("energy.positive_contact_work.largest", "Largest gain of energy in a step"),
    ("energy.positive_contact_work.sum", "All gains of energy"),
    ("energy.largest_tangential_work", "Largest gain of energy by friction"),
    ("unlocated_steps", "Steps in which not all impacts and ends of slides were located"),
    ("crossing_count", "Changes of sign of the angles"),
    ("stopped_by", "Stopped as"),
];

pub(super) fn numbers(values: &Numbers, summary: &Summary) -> String {
    let mut html = String::new();
    for path in values.others() {
        let text = values.text(&path);
        // For people; the file, and `data-value`, have all digits.
        let shown = match (text.parse::<f64>(), unit_of(&path)) {
            // Rounding beside the scene's energy isn't shown as energy; gains are beyond the rounding of their steps.
            (Ok(x), Some("J"))
                if !path.contains("positive_contact_work") && !content::holds(x.abs(), summary.energy.scale) =>
            {
                "0 J".to_owned()
            }
            // An energy that is a round number has the digits of those beside it.
            (Ok(x), Some("J")) => with_zeros(x, "J", 6).replace('-', "\u{2212}"),
            (Ok(x), Some(unit)) => with_digits(x, unit, 6).replace('-', "\u{2212}"),
            (Ok(x), None) if text.contains('e') => scientific(x),
            (Ok(x), None) if text.contains('.') => shortest(x, 3).replace('-', "\u{2212}"),
            _ => with_code(&text),
        };
        let text = escaped(&text);
        let name = NAMES.iter().find(|(of, _)| *of == path).map_or(path.as_str(), |(_, name)| *name);
        let _ = writeln!(
            html,
            "<tr><th scope=\"row\">{name}</th><td data-summary=\"{path}\" data-value=\"{text}\">{shown}</td></tr>"
        );
    }
    html
}

/// The unit of a number of the summary, of those that have one.
fn unit_of(path: &str) -> Option<&'static str> {
    match path {
        "dt" | "t" => Some("s"),
        "energy.largest_residual" | "energy.positive_contact_work.steps" => None,
        _ => path.starts_with("energy.").then_some("J"),
    }
}

/// φ/α for people; nothing of less than a hundredth: such a block doesn't rock, in a word.
fn share_of_critical_angle(share: f64) -> Option<String> {
    (share >= ROCKED).then(|| part(share))
}
