//! Tables as written, read back.

/// The columns of a table of numbers, by name.
pub(crate) fn columns_of(text: &str) -> Vec<(String, Vec<f64>)> {
    let mut lines = text.lines();
    let mut columns: Vec<(String, Vec<f64>)> =
        lines.next().unwrap().split(',').map(|name| (name.to_owned(), Vec::new())).collect();
    for line in lines {
        for (cell, (_, values)) in line.split(',').zip(&mut columns) {
            values.push(cell.parse().unwrap_or(f64::NAN));
        }
    }
    columns
}

pub(crate) fn column<'c>(columns: &'c [(String, Vec<f64>)], name: &str) -> &'c [f64] {
    &columns.iter().find(|(known, _)| known == name).unwrap_or_else(|| panic!("no column {name}")).1
}
