//! The table of keys of scenes.
//!
//! The columns are those of [`teeter_text::keys`]. Decoding, written defaults, the lists of allowed
//! keys in messages and `--set` all follow from [`TABLES`]; so do the program's JSON schema and
//! reference page.

pub use crate::table::TABLES;
pub use teeter_text::keys::{
    Bound, Key, Kind, LONGEST_TITLE, Occurrence, OnlyWith, PathTarget, Presence, Range, Reserved, TableSchema,
};

use teeter_text::schema::{FileAdvice, NameReference, Namespace, Schema};

/// The schema of scenes.
pub static SCENE: Schema = Schema::new("scene", TABLES)
    .with_namespaces(&[Namespace { groups: &["beam", "block"], taken: &["ground"] }])
    .with_references(&[NameReference { group: "material", from: &["beam", "block"], key: "material" }])
    .with_advice(ADVICE);

const ADVICE: FileAdvice = FileAdvice {
    empty: Some("a scene needs at least a table [time] with end and step"),
    other_file: Some("a scene is a TOML file; see the scenarios that come with the program"),
    too_deep: Some("keys of a scene have at most five parts, as in beam.table.support.middle.at"),
};

/// The tables directly below a table.
pub fn children(table: &TableSchema) -> impl Iterator<Item = &'static TableSchema> + use<> {
    SCENE.children(table)
}

/// What a dotted path such as `beam.table.thickness` refers to.
///
/// ```
/// use teeter_scenario::keys::{self, PathTarget};
/// assert!(matches!(keys::find("beam.table.thickness"), Some(PathTarget::Key(..))));
/// assert!(matches!(keys::find("beam.table"), Some(PathTarget::Table(_))));
/// assert!(matches!(keys::find("beam"), Some(PathTarget::Group(_))));
/// assert!(keys::find("beam.table.colour").is_none());
/// ```
pub fn find(path: &str) -> Option<PathTarget> {
    SCENE.find(path)
}

#[cfg(test)]
mod tests {
    use super::{PathTarget, TABLES, children, find};

    #[test]
    fn each_key_is_found_by_its_path_and_no_name_is_used_twice() {
        for table in TABLES {
            for key in table.keys {
                let path = format!("{}.{}", table.pattern.replace('*', "x"), key.name);
                let path = path.trim_start_matches('.');
                let found = find(path);
                assert!(
                    matches!(found, Some(PathTarget::Key(t, k)) if k == key && t.pattern == table.pattern),
                    "{path}: {found:?}"
                );
                assert_eq!(table.keys.iter().filter(|other| other.name == key.name).count(), 1, "{path}");
                assert!(key.doc.ends_with('.') && !key.example.is_empty(), "{path}");
                assert!(children(table).all(|child| child.name() != key.name), "{path}");
            }
        }
        assert!(find("").is_none());
        assert!(find("time.end.x").is_none());
        assert!(find("beam.").is_some_and(|found| matches!(found, PathTarget::Table(_))));
    }
}
