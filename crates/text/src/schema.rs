//! A schema: what documents of one kind may contain, and what messages call them.

use crate::keys::{Occurrence, PathTarget, Presence, TableSchema};

/// What a document may contain: its tables of keys, rules about names, and a few words for
/// messages.
///
/// ```
/// use teeter_text::decode;
/// use teeter_text::dimension::Dimension;
/// use teeter_text::keys::{Key, Kind, Occurrence, Presence, Range, TableSchema};
/// use teeter_text::schema::Schema;
///
/// static TABLES: &[TableSchema] = &[
///     TableSchema { pattern: "", occurrence: Occurrence::Always, doc: "The root.", keys: &[] },
///     TableSchema {
///         pattern: "pump.*",
///         occurrence: Occurrence::Named,
///         doc: "A pump.",
///         keys: &[Key::new(
///             "pressure",
///             Kind::Quantity(Dimension::PRESSURE, Range::POSITIVE),
///             Presence::Required,
///             "\"2 bar\"",
///             "Pressure at its outlet.",
///         )],
///     },
/// ];
/// static PLANT: Schema = Schema::new("plant", TABLES);
///
/// let plant = decode::parse(&PLANT, "[pump.main]\npressure = '2 bar'", "plant.toml", &[]).unwrap();
/// assert_eq!(plant.quantity("pump.main.pressure"), Some(2e5));
///
/// let errors = decode::parse(&PLANT, "[pump.main]\npresure = '2 bar'", "plant.toml", &[]).unwrap_err();
/// assert_eq!(errors.0[0].did_you_mean.as_deref(), Some("pressure"));
/// ```
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Schema {
    /// What a document is called: "scene".
    pub noun: &'static str,
    /// The tables, in the order of the output. The root has an empty pattern.
    pub tables: &'static [TableSchema],
    /// Groups that share their names; none by default.
    pub namespaces: &'static [Namespace],
    /// Keys that refer to a group's tables by name; none by default.
    pub references: &'static [NameReference],
    /// Remedies for files of another kind; none by default.
    pub advice: FileAdvice,
}

/// Groups of named tables whose names are unique over all of them.
#[derive(Debug, Clone, Copy)]
pub struct Namespace {
    /// The groups: `beam`, `block`.
    pub groups: &'static [&'static str],
    /// Reserved names: `ground`.
    pub taken: &'static [&'static str],
}

/// A key with which tables refer to tables of a group: if these lack a key, messages say who uses
/// the table.
#[derive(Debug, Clone, Copy)]
pub struct NameReference {
    /// The group that is referred to.
    pub group: &'static str,
    /// The groups whose tables refer to it.
    pub from: &'static [&'static str],
    /// The key whose value is the name.
    pub key: &'static str,
}

/// Remedies for files that are probably of another kind.
#[derive(Debug, Clone, Copy, Default)]
pub struct FileAdvice {
    /// For an empty file: the minimum that it needs.
    pub empty: Option<&'static str>,
    /// For a file that is not text, or too large: what it should be.
    pub other_file: Option<&'static str>,
    /// For keys with too many parts: how many a key has.
    pub too_deep: Option<&'static str>,
}

impl Schema {
    /// The schema with these tables; `noun` is what a document is called.
    #[must_use]
    pub const fn new(noun: &'static str, tables: &'static [TableSchema]) -> Self {
        let advice = FileAdvice { empty: None, other_file: None, too_deep: None };
        Self { noun, tables, namespaces: &[], references: &[], advice }
    }

    /// The same schema with groups that share their names.
    #[must_use]
    pub const fn with_namespaces(mut self, namespaces: &'static [Namespace]) -> Self {
        self.namespaces = namespaces;
        self
    }

    /// The same schema with keys that refer to tables by name.
    #[must_use]
    pub const fn with_references(mut self, references: &'static [NameReference]) -> Self {
        self.references = references;
        self
    }

    /// The same schema with remedies for files of another kind.
    #[must_use]
    pub const fn with_advice(mut self, advice: FileAdvice) -> Self {
        self.advice = advice;
        self
    }

    /// The root table.
    pub fn root(&self) -> Option<&'static TableSchema> {
        self.tables.iter().find(|table| table.pattern.is_empty())
    }

    /// The tables directly below a table.
    pub fn children(&self, table: &TableSchema) -> impl Iterator<Item = &'static TableSchema> + use<> {
        let parent = table.pattern;
        self.tables.iter().filter(move |table| {
            let own = table.pattern.strip_suffix(".*").unwrap_or(table.pattern);
            let above = own.rsplit_once('.').map_or("", |(above, _)| above);
            !own.is_empty() && above == parent
        })
    }

    /// The names allowed in a table: its implemented keys, then its tables.
    pub fn allowed(&self, table: &TableSchema) -> Vec<&'static str> {
        let keys = table.keys.iter().filter(|key| key.presence != Presence::NotYet);
        keys.map(|key| key.name).chain(self.children(table).map(TableSchema::name)).collect()
    }

    /// What a dotted path such as `pump.main.pressure` refers to.
    pub fn find(&self, path: &str) -> Option<PathTarget> {
        let mut table = self.root()?;
        let mut segments = path.split('.');
        while let Some(segment) = segments.next() {
            if let Some(key) = table.key(segment) {
                return segments.next().is_none().then_some(PathTarget::Key(table, key));
            }
            table = self.children(table).find(|child| child.name() == segment)?;
            if table.occurrence == Occurrence::Named && segments.next().is_none() {
                return Some(PathTarget::Group(table));
            }
        }
        Some(PathTarget::Table(table))
    }

    /// The first table that has a key of this name.
    pub(crate) fn table_with(&self, key: &str) -> Option<&'static TableSchema> {
        self.tables.iter().find(|table| table.key(key).is_some())
    }

    /// The noun with its article: "a scene".
    pub(crate) fn a_document(&self) -> String {
        let article = if self.noun.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
        format!("{article} {}", self.noun)
    }
}
