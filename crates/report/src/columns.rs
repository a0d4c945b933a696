//! `columns.json`: the unit of every column of the tables, whose headers are names only.

use crate::contacts;
use crate::driven::Driven;
use crate::recorder::{
    BLOCKS_HEADER, ENERGY_HEADER, IMPACTS_HEADER, TABLES, blocks_in_columns, is_written, trajectory_header,
};
use crate::sections::{ENVELOPES_HEADER, Sections};
use serde_json::{Map, Value};
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Layout;

/// Units by what columns are called, without the body before and the place after.
const UNITS: [(&str, &str); 33] = [
    ("t", "s"),
    ("x", "m"),
    ("y", "m"),
    ("phi", "rad"),
    ("vx", "m/s"),
    ("vy", "m/s"),
    ("omega", "rad/s"),
    ("ax", "m/s^2"),
    ("ay", "m/s^2"),
    ("angular_acceleration", "rad/s^2"),
    ("w_mid", "m"),
    ("v_mid", "m/s"),
    ("w", "m"),
    ("moment", "N m"),
    ("shear", "N"),
    ("stress", "Pa"),
    ("axial_force", "N"),
    ("reaction", "N"),
    ("reaction_couple", "N m"),
    ("gap", "m"),
    ("p_n", "N s"),
    ("p_t", "N s"),
    ("u_n", "m/s"),
    ("u_t", "m/s"),
    ("slip", "m"),
    ("impulse_n", "N s"),
    ("impulse_t", "N s"),
    ("u_n_before", "m/s"),
    ("u_n_after", "m/s"),
    ("contact", ""),
    ("a", ""),
    ("b", ""),
    ("point", ""),
];

/// The unit of a column of a table that a run writes, in the notation of scenes; empty for words, `None` for a column
/// that is not known.
#[must_use]
pub fn unit<'n>(table: &str, column: &'n str) -> Option<&'static str> {
    if table == "energy.csv" && column != "t" {
        return Some("J");
    }
    let name = column.split('@').next().unwrap_or(column);
    let name = name.rsplit('.').next().unwrap_or(name);
    let without =
        |name: &'static [&'static str], of: &'n str| name.iter().find_map(|end| of.strip_suffix(end)).unwrap_or(of);
    let name = without(&["_left", "_right"], without(&["_min", "_max"], name));
    match name {
        "state" | "beam" | "block" => Some(""),
        name => UNITS.iter().find(|(known, _)| *known == name).map(|(_, unit)| *unit),
    }
}

/// The text of `columns.json`: for each table that is written its columns in order, each with its unit in the notation of scenes, empty for words.
///
/// # Errors
/// None today; as serialising.
pub fn columns(scene: &Scene, layout: &Layout) -> Result<String, serde_json::Error> {
    let blocks = blocks_in_columns(scene, layout);
    let trajectory = trajectory_header(layout, &blocks, &Sections::new(scene, layout), &Driven::of(scene, layout));
    let mut tables = Map::new();
    let headers = [trajectory.as_str(), contacts::HEADER, IMPACTS_HEADER, ENERGY_HEADER, BLOCKS_HEADER];
    let has_envelopes = scene.beams.iter().any(|beam| beam.output.envelope);
    let more = has_envelopes.then_some(("envelopes.csv", ENVELOPES_HEADER));
    for (table, header) in TABLES.into_iter().zip(headers).filter(|(table, _)| is_written(table, scene)).chain(more) {
        let columns = header.trim_end().split(',').map(|column| {
            let unit = unit(table, column).unwrap_or_default();
            Value::Array(vec![column.into(), unit.into()])
        });
        tables.insert(table.to_owned(), Value::Array(columns.collect()));
    }
    Ok(serde_json::to_string_pretty(&tables)? + "\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_column_has_its_unit() {
        for (table, header) in TABLES[1..]
            .iter()
            .zip([contacts::HEADER, IMPACTS_HEADER, ENERGY_HEADER, BLOCKS_HEADER])
            .chain([(&"envelopes.csv", ENVELOPES_HEADER)])
        {
            for column in header.trim_end().split(',') {
                assert!(unit(table, column).is_some(), "{table}: {column}");
            }
        }
        let of_beams = ["w", "moment", "shear", "stress"].map(|word| format!("a.b.{word}@0.09"));
        assert_eq!(of_beams.map(|name| unit("trajectory.csv", &name)), [Some("m"), Some("N m"), Some("N"), Some("Pa")]);
        assert_eq!(unit("trajectory.csv", "rocker.omega"), Some("rad/s"));
        assert_eq!(unit("trajectory.csv", "rocker.unheard-of"), None);
    }
}
