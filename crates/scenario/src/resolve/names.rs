//! Names of blocks: those of the file, of the copies of a repeated block, and patterns for several.

use std::collections::BTreeMap;

use crate::document::Document;

/// Most copies of a table: of more, only so many are made, and the rest is an error.
pub(super) const MOST_COPIES: usize = 50_000;

/// A block of the scene, and its origin.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct BlockName {
    /// Its name: that of its table, with `-1`, `-2`, … if it is repeated.
    pub(super) name: String,
    /// The name of its table in the file.
    pub(super) table: String,
    /// Number of copies of the table before it.
    pub(super) copy: usize,
    /// Number of copies before it in its row, and of rows before that.
    pub(super) place: [usize; 2],
    /// The previous copy, if it stands on that.
    pub(super) stands_on: Option<String>,
}

impl BlockName {
    /// All blocks of a file, in order.
    pub(super) fn all(doc: &Document) -> Vec<Self> {
        doc.names("block").into_iter().flat_map(|table| Self::of_table(doc, table)).collect()
    }

    fn of_table(doc: &Document, table: &str) -> Vec<Self> {
        let count = doc.integer(&format!("block.{table}.repeat.count")).and_then(|count| usize::try_from(count).ok());
        let Some(count) = count else {
            let (name, table) = (table.to_owned(), table.to_owned());
            return vec![Self { name, table, copy: 0, place: [0; 2], stands_on: None }];
        };
        let rows = doc.integer(&format!("block.{table}.repeat.rows")).and_then(|rows| usize::try_from(rows).ok());
        let rows = rows.unwrap_or(1).min(MOST_COPIES.div_ceil(count.max(1)));
        let stacked = doc.flag(&format!("block.{table}.repeat.stacked")) == Some(true);
        let name = |copy: usize| format!("{table}-{}", copy + 1);
        let copy = |copy: usize| Self {
            name: name(copy),
            table: table.to_owned(),
            copy,
            place: [copy % count, copy / count],
            stands_on: (stacked && copy > 0).then(|| name(copy - 1)),
        };
        (0..count * rows).map(copy).collect()
    }
}

/// The table of the file that a block of the scene comes from.
pub(crate) fn table_of<'a>(doc: &Document, block: &'a str) -> &'a str {
    let repeated = |table: &&str| doc.has_table(&format!("block.{table}.repeat"));
    match block.rsplit_once('-').map(|(table, _)| table).filter(repeated) {
        Some(table) if !doc.has_table(&format!("block.{block}")) => table,
        _ => block,
    }
}

/// Whether a name matches a pattern, in which `*` stands for any characters and `?` for one.
#[must_use]
pub fn matches_pattern(pattern: &str, name: &str) -> bool {
    let (pattern, name): (Vec<char>, Vec<char>) = (pattern.chars().collect(), name.chars().collect());
    let (mut at, mut place) = (0, 0);
    // Where to go on if the rest doesn't match: behind the last star, which then stands for one
    // character more.
    let mut back: Option<(usize, usize)> = None;
    while place < name.len() {
        match pattern.get(at) {
            Some('*') => {
                at += 1;
                back = Some((at, place));
            }
            Some(letter) if *letter == '?' || *letter == name[place] => {
                at += 1;
                place += 1;
            }
            _ => match back {
                Some((star, from)) => {
                    at = star;
                    place = from + 1;
                    back = Some((star, place));
                }
                None => return false,
            },
        }
    }
    pattern[at..].iter().all(|letter| *letter == '*')
}

/// Blocks by their names; a duplicate is passed to `twice`.
pub(super) fn numbered(names: &[BlockName], mut twice: impl FnMut(&BlockName)) -> BTreeMap<String, usize> {
    let mut numbers = BTreeMap::new();
    for (number, block) in names.iter().enumerate() {
        if numbers.insert(block.name.clone(), number).is_some() {
            twice(block);
        }
    }
    numbers
}

#[cfg(test)]
mod tests {
    use super::matches_pattern;

    #[test]
    fn a_star_stands_for_any_letters() {
        for (pattern, name, does) in [
            ("wall", "wall", true),
            ("wall", "wall-1", false),
            ("*", "anything", true),
            ("wall-*", "wall-12", true),
            ("wall-*", "wall", false),
            ("*-1", "wall-1", true),
            ("*-1", "wall-11", false),
            ("a*b*c", "a-b-b-c", true),
            ("a*b*c", "acb", false),
            ("a*a", "a", false),
            ("wall-?", "wall-1", true),
            ("wall-?", "wall-12", false),
            ("?a*?", "bab", true),
            ("?a*?", "ba", false),
        ] {
            assert_eq!(matches_pattern(pattern, name), does, "{pattern} {name}");
        }
    }
}
