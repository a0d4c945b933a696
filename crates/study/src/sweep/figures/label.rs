//! How columns are named on axes and in tables of figures: a key as one would say it, with its unit.

use crate::sweep::Sweep;
use crate::sweep::output::Output;
use crate::write::capitalised;
use teeter_scenario::keys::{Kind, PathTarget, find};

/// Keys of a motion whose names don't say of what they are.
const OF_MOTIONS: [(&str, &str); 5] = [
    ("peak", "Peak acceleration"),
    ("peak_velocity", "Peak velocity"),
    ("arias", "Arias intensity"),
    ("spectral_acceleration", "Spectral acceleration"),
    ("record", "Record"),
];

/// Keys that are called otherwise in text.
const CALLED: [(&str, &str); 5] = [
    ("youngs_modulus", "Young’s modulus"),
    ("poisson_ratio", "Poisson’s ratio"),
    ("at", "Position"),
    ("step", "Time step"),
    ("end", "End of the run"),
];

/// Values of the summary, with their units.
const OF_SUMMARY: [(&str, &str); 3] = [
    ("max_phi_over_alpha", "Largest |φ|/α"),
    ("overturned_at", "Time of overturning (s)"),
    ("impact_count", "Number of impacts"),
];

/// Values of a record in the summary, after its number.
const OF_RECORDS: [(&str, &str); 3] = [
    ("peak_acceleration", "Peak acceleration of the record (m/s²)"),
    ("peak_velocity", "Peak velocity of the record (m/s)"),
    ("arias_intensity", "Arias intensity of the record (m/s)"),
];

/// Columns of `trajectory.csv` of a block, as symbols.
const SYMBOLS: [(&str, &str); 6] = [("phi", "φ"), ("omega", "ω"), ("x", "x"), ("y", "y"), ("vx", "ẋ"), ("vy", "ẏ")];

fn named(list: &[(&str, &'static str)], name: &str) -> Option<&'static str> {
    list.iter().find(|(key, _)| *key == name).map(|(_, text)| *text)
}

/// The label of a column of a study: of a key its name with its owner and unit, of an output what it is where that is known,
/// else the name that the study gives it.
pub(super) fn label(sweep: &Sweep, column: &str) -> String {
    if find(column).is_some() {
        return of_key(column);
    }
    let output = sweep.outputs().iter().find(|output| output.name() == column);
    output.and_then(of_output).unwrap_or_else(|| column.to_owned())
}

/// The label of a column of `trajectory.csv`.
pub(super) fn quantity(column: &str) -> String {
    let known = || {
        let (owner, last) = column.rsplit_once('.')?;
        Some(format!("{} of {owner}", named(&SYMBOLS, last)?))
    };
    let name = known().unwrap_or_else(|| column.to_owned());
    match teeter_report::column_unit("trajectory.csv", column) {
        Some(unit) => format!("{name} ({})", typeset(unit)),
        None => name,
    }
}

/// The label that studies have in common: where they differ only in what it belongs to, as the ground and the supports of a
/// beam that are shaken, without that; else the first.
pub(super) fn common(labels: &[String]) -> String {
    let Some(first) = labels.first() else { return String::new() };
    let apart = |label: &String| {
        let (name, unit) = label.rsplit_once(" (").map_or((label.as_str(), ""), |(name, unit)| (name, unit));
        let name = name.split_once(" of ").map_or(name, |(name, _)| name);
        (name.to_owned(), unit.to_owned())
    };
    if labels.iter().all(|label| label == first) || labels.iter().any(|label| apart(label) != apart(first)) {
        return first.clone();
    }
    let (name, unit) = apart(first);
    if unit.is_empty() { name } else { format!("{name} ({unit}") }
}

fn of_key(key: &str) -> String {
    let unit = match find(key) {
        Some(PathTarget::Key(_, found)) => match found.kind {
            Kind::Quantity(dimension, _) => typeset(&dimension.unit()),
            _ => String::new(),
        },
        _ => String::new(),
    };
    let parts: Vec<&str> = key.split('.').collect();
    let (mut owner, last) = match parts.split_last() {
        Some((last, owner)) => (owner.to_vec(), *last),
        None => return key.to_owned(),
    };
    // A motion along an axis, or of both; what it belongs to comes before.
    let motion = owner.iter().position(|part| *part == "motion");
    let name = match motion {
        Some(at) => {
            owner.remove(at);
            named(&OF_MOTIONS, last)
        }
        None => None,
    };
    // The share of critical damping stands in a table of its own.
    let is_damping = last == "ratio" && owner.last() == Some(&"damping_ratio");
    if is_damping {
        owner.pop();
    }
    let name = match name.or_else(|| named(&CALLED, last)) {
        Some(name) => name.to_owned(),
        None if is_damping => "Damping ratio".to_owned(),
        None => capitalised(&last.replace('_', " ")),
    };
    // Of tables that have names the name says enough; time and solver are the whole scene's.
    let owner = match owner.as_slice() {
        ["time" | "output"] | [] => String::new(),
        ["block" | "beam" | "contact" | "signal" | "material" | "load", own, rest @ ..] => {
            std::iter::once(own).chain(rest).copied().collect::<Vec<_>>().join(" ")
        }
        all => all.join(" "),
    };
    let of = if owner.is_empty() { owner } else { format!(" of {owner}") };
    let unit = if last == "frequency" && unit == "1/s" { "Hz".to_owned() } else { unit };
    let unit = if unit.is_empty() { unit } else { format!(" ({unit})") };
    format!("{name}{of}{unit}")
}

fn of_output(output: &Output) -> Option<String> {
    if let Some(path) = output.summary_path() {
        let known = match path.split('.').collect::<Vec<_>>().as_slice() {
            ["records", _, last] => named(&OF_RECORDS, last),
            [only] => named(&OF_SUMMARY, only),
            _ => None,
        };
        return known.map(str::to_owned);
    }
    if let Some(period) = output.period() {
        return Some(format!("Spectral acceleration at T = {period} s (m/s²)"));
    }
    let column = output.column()?;
    let (owner, last) = column.rsplit_once('.')?;
    let symbol = named(&SYMBOLS, last)?;
    let unit = typeset(teeter_report::column_unit("trajectory.csv", column)?);
    Some(format!("{} ({unit})", output.reduced(symbol, owner)?))
}

/// A unit as one writes it: with raised numbers.
fn typeset(unit: &str) -> String {
    unit.replace("^2", "²").replace("^3", "³").replace("^4", "⁴")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_named_as_one_would_say_them() {
        for (key, text) in [
            ("ground.motion.x.peak", "Peak acceleration of ground x (m/s²)"),
            ("beam.table.motion.x.peak", "Peak acceleration of table x (m/s²)"),
            ("signal.shake.frequency", "Frequency of shake (Hz)"),
            ("signal.shake.scale", "Scale of shake"),
            ("contact.feet.friction", "Friction of feet"),
            ("block.rocker.width", "Width of rocker (m)"),
            ("beam.table.damping_ratio.ratio", "Damping ratio of table"),
            ("material.steel.density", "Density of steel (kg/m³)"),
            ("time.step", "Time step (s)"),
        ] {
            assert_eq!(of_key(key), text);
        }
    }

    #[test]
    fn studies_that_shake_different_things_have_a_label_in_common() {
        let of = |keys: &[&str]| common(&keys.iter().map(|key| of_key(key)).collect::<Vec<_>>());
        assert_eq!(of(&["ground.motion.x.peak", "beam.table.motion.x.peak"]), "Peak acceleration (m/s²)");
        assert_eq!(of(&["contact.feet.friction", "contact.floor.friction"]), "Friction");
        assert_eq!(of(&["contact.feet.friction", "contact.feet.friction"]), "Friction of feet");
        assert_eq!(of(&["ground.motion.x.peak", "contact.feet.friction"]), "Peak acceleration of ground x (m/s²)");
        assert_eq!(of(&[]), "");
    }

    #[test]
    fn outputs_are_named_by_what_they_are_where_that_is_known() {
        let text = "scene = \"s.toml\"\n[grid]\ntime.step = [\"1 ms\", \"2 ms\"]\n[outputs]\nlargest = { max_abs = \"b.phi\" }\n\
                    half = { at = \"0.5 s\", of = \"b.vx\" }\npgv = \"records.0.peak_velocity\"\nsa = { spectral_acceleration = \"0.5 s\" }\n\
                    worst = \"energy.largest_residual\"\n";
        let sweep = Sweep::read(text, "f", &|_, _| Err("none".to_owned())).unwrap();
        for (column, text) in [
            ("largest", "Largest |φ| of b (rad)"),
            ("half", "ẋ of b at t = 0.5 s (m/s)"),
            ("pgv", "Peak velocity of the record (m/s)"),
            ("sa", "Spectral acceleration at T = 0.5 s (m/s²)"),
            ("worst", "worst"),
            ("time.step", "Time step (s)"),
        ] {
            assert_eq!(label(&sweep, column), text);
        }
    }
}
