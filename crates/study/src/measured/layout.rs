//! Where the quantities stand in a table: which columns, in which units, with which separator.

use crate::sweep::spec::{Node, Reader, entries};
use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use teeter_scenario::diagnostic::Diagnostics;
use teeter_scenario::dimension::Dimension;
use teeter_scenario::quantity;

/// The column of a quantity.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ColumnSpec {
    /// Its heading without the unit, or its number from 1; none: the name of the quantity.
    pub column: Option<String>,
    /// Its unit; none: the one in its heading, or else the SI unit.
    pub unit: Option<String>,
}

/// A marker that is fixed to the block.
#[derive(Clone, Debug, PartialEq)]
pub struct MarkerSpec {
    /// Its name.
    pub name: String,
    /// Columns of its coordinates.
    pub x: ColumnSpec,
    /// As `x`.
    pub y: ColumnSpec,
    /// Its place on the upright block, from the mass centre, m.
    pub at: Option<[f64; 2]>,
}

/// How a table of measured motion is laid out. The default finds `t` and the quantities by their
/// headings.
///
/// ```
/// use teeter_study::measured::ColumnLayout;
/// let layout = ColumnLayout::read("[columns]\nt = \"Time\"\nphi = { column = \"Angle\", unit = \"deg\" }\n", "columns.toml");
/// assert_eq!(layout.unwrap().columns["phi"].unit.as_deref(), Some("deg"));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColumnLayout {
    /// The separator of columns; none: found from the first row.
    pub separator: Option<char>,
    /// Lines before the heading that are not read.
    pub skip: usize,
    /// Lines of the file, from 1, whose values are lost: frames that are known to be wrong.
    pub leave_out: Vec<RangeInclusive<usize>>,
    /// Rows per second, Hz, for tables that have no times or count frames.
    pub rate: Option<f64>,
    /// Whether y is positive downwards, as in coordinates of pixels.
    pub y_down: bool,
    /// The columns of `t` and of the quantities, by name.
    pub columns: BTreeMap<String, ColumnSpec>,
    /// The markers; with any, angle and position come from them.
    pub markers: Vec<MarkerSpec>,
}

/// The names of the quantities that a table may hold.
pub(super) const NAMES: [&str; 7] = ["t", "phi", "omega", "x", "y", "vx", "vy"];
const KEYS: [&str; 7] = ["separator", "skip", "leave_out", "rate", "y_down", "columns", "marker"];
const COLUMN_EXAMPLE: &str =
    "give its heading, such as \"Angle\", or its number, or { column = \"Angle\", unit = \"deg\" }";
const MARKER_UNIT_EXAMPLE: &str = "such as \"mm\", or the length of a pixel, such as \"0.21 mm\"";
const PLACE_EXAMPLE: &str = "give x and y from the mass centre of the upright block, such as [\"1 cm\", \"-3 cm\"]";
const MARKER_KEYS: [&str; 4] = ["x", "y", "unit", "at"];
const MARKER_EXAMPLE: &str = "such as { x = \"top x\", y = \"top y\", unit = \"mm\", at = [\"0 cm\", \"6 cm\"] }, with `at` from the mass centre of the upright block";

impl ColumnLayout {
    /// Reads a layout from TOML; `file` is its name in messages.
    ///
    /// # Errors
    /// Everything that is wrong in it.
    pub fn read(text: &str, file: &str) -> Result<Self, Diagnostics> {
        let mut reader = Reader::new(file, text);
        let root = reader.root()?;
        let mut layout = Self::default();
        for (name, node) in entries(root.get_ref()) {
            match (name, node.table()) {
                ("separator", _) => match node.text().and_then(separator) {
                    Some(found) => layout.separator = Some(found),
                    None => reader.wrong(
                        name,
                        Some(&node),
                        "not a separator",
                        "one of \",\", \";\", \"tab\" and \"blanks\"",
                    ),
                },
                ("skip", _) => match node.whole().and_then(|lines| usize::try_from(lines).ok()) {
                    Some(lines) => layout.skip = lines,
                    None => reader.wrong(name, Some(&node), "a number of lines is expected", "such as 3"),
                },
                ("leave_out", _) => match node.text().map(line_ranges) {
                    Some(Ok(lines)) => layout.leave_out = lines,
                    _ => reader.wrong(name, Some(&node), "lines are expected", LINES_EXAMPLE),
                },
                ("rate", _) => match node.text().map(rate) {
                    Some(Ok(rate)) => layout.rate = Some(rate),
                    Some(Err(why)) => reader.wrong(name, Some(&node), &why, "such as \"165 Hz\""),
                    None => {
                        reader.wrong(name, Some(&node), "a rate with its unit is expected", "such as \"165 Hz\"");
                    }
                },
                ("y_down", _) => match reader.written(&node) {
                    "true" => layout.y_down = true,
                    "false" => layout.y_down = false,
                    _ => reader.wrong(name, Some(&node), "true or false is expected", "true for pixel coordinates"),
                },
                ("columns", Some(table)) => {
                    for (name, node) in entries(table) {
                        let path = format!("columns.{name}");
                        if !NAMES.contains(&name) {
                            reader.unknown(&path, &node, name, &NAMES);
                        } else if let Some(column) = column(&mut reader, &path, &node) {
                            layout.columns.insert(name.to_owned(), column);
                        }
                    }
                }
                ("marker", Some(table)) => {
                    for (name, node) in entries(table) {
                        layout.markers.extend(marker(&mut reader, name, &node));
                    }
                }
                ("columns" | "marker", None) => {
                    reader.wrong(
                        name,
                        Some(&node),
                        "a table is expected",
                        &format!("write [{name}], and its keys below"),
                    );
                }
                (other, _) => reader.unknown(other, &node, other, &KEYS),
            }
        }
        if layout.markers.len() == 1 {
            reader.wrong("marker", None, "one marker shows no angle", "give two or more");
        }
        let placed = layout.markers.iter().filter(|marker| marker.at.is_some()).count();
        if placed > 0 && placed < layout.markers.len() {
            reader.wrong(
                "marker",
                None,
                "only some markers have a place on the block",
                "give `at` for all, or for none",
            );
        }
        for (place, marker) in layout.markers.iter().enumerate() {
            let same = |other: &&MarkerSpec| marker.at.is_some() && other.at == marker.at;
            if let Some(other) = layout.markers[..place].iter().find(same) {
                let path = format!("marker.{}.at", marker.name);
                let rule = format!("the place of the marker `{}`, too", other.name);
                reader.wrong(&path, None, &rule, "give each marker its own place on the block");
            }
        }
        if reader.found.has_errors() { Err(reader.into_findings()) } else { Ok(layout) }
    }

    /// Sets the column of a quantity.
    ///
    /// # Errors
    /// If there is no such quantity.
    pub fn set_column(&mut self, name: &str, column: &str) -> Result<(), String> {
        self.known(name)?.column = Some(column.trim().to_owned());
        Ok(())
    }

    /// Sets the unit of a quantity.
    ///
    /// # Errors
    /// If there is no such quantity.
    pub fn set_unit(&mut self, name: &str, unit: &str) -> Result<(), String> {
        self.known(name)?.unit = Some(unit.trim().to_owned());
        Ok(())
    }

    fn known(&mut self, name: &str) -> Result<&mut ColumnSpec, String> {
        if NAMES.contains(&name) {
            return Ok(self.columns.entry(name.to_owned()).or_default());
        }
        Err(format!("there is no quantity `{name}`: a table may hold {}", NAMES.join(", ")))
    }
}

const LINES_EXAMPLE: &str = "such as \"62, 90-95\": numbers of lines of the file from 1, and ranges of them";

/// Lines of a file, from 1, as in `62, 90-95`.
///
/// # Errors
/// If they are written otherwise.
pub fn line_ranges(text: &str) -> Result<Vec<RangeInclusive<usize>>, String> {
    let number = |text: &str| text.trim().parse::<usize>().ok().filter(|line| *line > 0);
    let range = |text: &str| {
        let (from, to) = text.split_once('-').unwrap_or((text, text));
        let (from, to) = (number(from)?, number(to)?);
        (from <= to).then_some(from..=to)
    };
    let all: Option<Vec<RangeInclusive<usize>>> = text.split(',').map(range).collect();
    all.ok_or_else(|| format!("lines are expected, {LINES_EXAMPLE}"))
}

/// A separator by its sign or word.
fn separator(text: &str) -> Option<char> {
    match text {
        "," => Some(','),
        ";" => Some(';'),
        "\t" | "tab" => Some('\t'),
        " " | "blanks" => Some(' '),
        _ => None,
    }
}

/// A rate in Hz, from its text.
///
/// # Errors
/// What is wrong with it.
pub(super) fn rate(text: &str) -> Result<f64, String> {
    match quantity::parse(text, Dimension::RATE) {
        Ok(rate) if rate > 0.0 => Ok(rate),
        Ok(_) => Err("must be positive".to_owned()),
        Err(error) => Err(error.with_remedy()),
    }
}

/// A heading, or the number of a column.
fn heading(reader: &Reader<'_>, node: &Node<'_, '_>) -> Option<String> {
    node.text().map(str::to_owned).or_else(|| node.whole().map(|_| reader.written(node).to_owned()))
}

fn column(reader: &mut Reader<'_>, path: &str, node: &Node<'_, '_>) -> Option<ColumnSpec> {
    if let Some(column) = heading(reader, node) {
        return Some(ColumnSpec { column: Some(column), unit: None });
    }
    let mut spec = ColumnSpec::default();
    let Some(table) = node.table() else {
        reader.wrong(path, Some(node), "not a column", COLUMN_EXAMPLE);
        return None;
    };
    for (name, inner) in entries(table) {
        let inner_path = format!("{path}.{name}");
        match (name, heading(reader, &inner)) {
            ("column", Some(text)) => spec.column = Some(text),
            ("unit", _) => spec.unit = unit(reader, &inner_path, &inner, "such as \"deg\""),
            ("column", None) => reader.wrong(&inner_path, Some(&inner), "not a column", COLUMN_EXAMPLE),
            (other, _) => reader.unknown(&inner_path, &inner, other, &["column", "unit"]),
        }
    }
    Some(spec)
}

/// A unit. A bare number is refused: it would be the size of a pixel in nobody knows what.
fn unit(reader: &mut Reader<'_>, path: &str, node: &Node<'_, '_>, example: &str) -> Option<String> {
    let unit = node.text().map(str::trim).filter(|unit| !unit.is_empty());
    if unit.is_none() {
        reader.wrong(path, Some(node), "a unit in quotes is expected", example);
    }
    unit.map(str::to_owned)
}

/// The place of a marker on the block, m.
fn place(reader: &mut Reader<'_>, path: &str, node: &Node<'_, '_>) -> Option<[f64; 2]> {
    let Some(lengths) = node.array() else {
        reader.wrong(path, Some(node), "a list of two lengths is expected", PLACE_EXAMPLE);
        return None;
    };
    let [x, y] = lengths.as_slice() else {
        let are = if lengths.len() == 1 { "1 item is" } else { &format!("{} items are", lengths.len()) };
        reader.wrong(path, Some(node), &format!("two lengths are expected, but {are} given"), PLACE_EXAMPLE);
        return None;
    };
    let mut length = |axis: &str, node: &Node<'_, '_>| {
        let read = match node.text() {
            Some(text) => quantity::parse(text, Dimension::LENGTH).map_err(|error| error.with_remedy()),
            None => Err("a length in quotes is expected".to_owned()),
        };
        read.map_err(|why| reader.wrong(path, Some(node), &format!("{axis}: {why}"), PLACE_EXAMPLE)).ok()
    };
    let (x, y) = (length("x", x), length("y", y));
    Some([x?, y?])
}

fn marker(reader: &mut Reader<'_>, name: &str, node: &Node<'_, '_>) -> Option<MarkerSpec> {
    let path = format!("marker.{name}");
    let Some(table) = node.table() else {
        reader.wrong(&path, Some(node), "not a marker", MARKER_EXAMPLE);
        return None;
    };
    let (mut x, mut y, mut unit_of_both, mut at) = (None, None, None, None);
    for (key, inner) in entries(table) {
        let inner_path = format!("{path}.{key}");
        match key {
            "x" | "y" => {
                let column = heading(reader, &inner);
                if column.is_none() {
                    reader.wrong(&inner_path, Some(&inner), "not a column", MARKER_EXAMPLE);
                    return None;
                }
                *(if key == "x" { &mut x } else { &mut y }) = column;
            }
            "unit" => unit_of_both = unit(reader, &inner_path, &inner, MARKER_UNIT_EXAMPLE),
            "at" => at = place(reader, &inner_path, &inner),
            other => reader.unknown(&inner_path, &inner, other, &MARKER_KEYS),
        }
    }
    match (x, y) {
        (Some(x), Some(y)) => {
            let spec = |column: String| ColumnSpec { column: Some(column), unit: unit_of_both.clone() };
            Some(MarkerSpec { name: name.to_owned(), x: spec(x), y: spec(y), at })
        }
        _ => {
            reader.wrong(&path, Some(node), "a marker needs the columns of x and y", MARKER_EXAMPLE);
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markers_are_read_with_their_places() {
        let text = "rate = \"165 Hz\"\nseparator = \"tab\"\ny_down = true\n[marker.a]\nx = \"ax\"\ny = 3\nunit = \"mm\"\nat = [\"1 cm\", \"-2 cm\"]\n\
            [marker.b]\nx = \"bx\"\ny = \"by\"\nat = [\"0 cm\", \"4 cm\"]\n";
        let layout = ColumnLayout::read(text, "f").unwrap();
        assert_eq!((layout.rate, layout.separator, layout.y_down), (Some(165.0), Some('\t'), true));
        assert_eq!((layout.markers[0].at, layout.markers[0].y.column.as_deref()), (Some([0.01, -0.02]), Some("3")));
    }

    #[test]
    fn two_markers_at_one_place_are_refused() {
        let marker = |name: &str, at: &str| format!("[marker.{name}]\nx = \"{name}x\"\ny = \"{name}y\"\nat = {at}\n");
        let (place, same) = ("[\"1 cm\", \"2 cm\"]", "[\"10 mm\", \"20 mm\"]");
        let found = ColumnLayout::read(&(marker("a", place) + &marker("b", same)), "f").unwrap_err().to_string();
        assert!(found.contains("marker.b.at") && found.contains("the place of the marker `a`, too"), "{found}");
    }

    #[test]
    fn a_unit_or_a_place_that_cannot_be_read_says_what_is_wrong_with_it() {
        let other = "[marker.b]\nx = \"bx\"\ny = \"by\"\nat = [\"0 cm\", \"4 cm\"]\n";
        let found = |line: &str| {
            let text = format!("{other}[marker.a]\nx = \"ax\"\ny = \"ay\"\n{line}\n");
            let found = ColumnLayout::read(&text, "f").unwrap_err();
            let told = found.iter().filter(|finding| finding.path.starts_with("marker.a."));
            told.map(|finding| finding.rule.clone()).collect::<Vec<_>>().join("; ")
        };
        let at = "at = [\"1 cm\", \"2 cm\"]";
        for unit in ["0.21", "21", "[\"mm\"]", "\"\"", "true"] {
            assert_eq!(found(&format!("{at}\nunit = {unit}")), "a unit in quotes is expected", "{unit}");
        }
        for unit in ["5", "0.5", "[\"deg\"]"] {
            let text = format!("[columns]\nphi = {{ column = 2, unit = {unit} }}\n");
            let found = ColumnLayout::read(&text, "f").unwrap_err().to_string();
            assert!(found.contains("columns.phi.unit") && found.contains("a unit in quotes is expected"), "{found}");
        }
        assert_eq!(found("at = [\"-1\", \"6 cm\"]"), "x: the unit is missing");
        assert_eq!(found("at = [\"1 cm\", 6]"), "y: a length in quotes is expected");
        assert_eq!(found("at = [\"-1 cm\"]"), "two lengths are expected, but 1 item is given");
        assert_eq!(found("at = \"-1 cm\""), "a list of two lengths is expected");
    }

    #[test]
    fn all_mistakes_are_reported() {
        let text = "separator = \"x\"\nrate = \"165 m\"\nspeed = 1\n[columns]\nphy = \"a\"\n[marker.a]\nx = \"1\"\n";
        let found = ColumnLayout::read(text, "f").unwrap_err();
        assert_eq!(found.iter().filter(|finding| !finding.path.is_empty()).count(), 5, "{found}");
        assert!(found.iter().any(|finding| finding.did_you_mean.as_deref() == Some("phi")));
    }
}
