//! A schema: what the documents of one kind may say, and what they are called in messages.

use crate::keys::{Found, Occurrence, Presence, Table};

/// What a document may say: its tables of keys, the rules about names, and a few words for
/// messages.
///
/// ```
/// use teeter_text::decode;
/// use teeter_text::dimension::Dimension;
/// use teeter_text::keys::{Key, Kind, Occurrence, Presence, Range, Table};
/// use teeter_text::schema::Schema;
///
/// static TABLES: &[Table] = &[
///     Table { pattern: "", occurrence: Occurrence::Always, doc: "The root.", keys: &[] },
///     Table {
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
    /// What a document is, in a word: "scene".
    pub noun: &'static str,
    /// The tables, in the order in which they are written out. The root is the one with an empty
    /// pattern.
    pub tables: &'static [Table],
    /// Groups that share their names; none by default.
    pub namespaces: &'static [Namespace],
    /// Keys that refer to a group's tables by name; none by default.
    pub references: &'static [Reference],
    /// What is said of files that are nothing of the kind; nothing by default.
    pub advice: Advice,
}

/// Groups of named tables whose names are unique over all of them.
#[derive(Debug, Clone, Copy)]
pub struct Namespace {
    /// The groups: `beam`, `block`.
    pub groups: &'static [&'static str],
    /// Names that are taken by something else: `ground`.
    pub taken: &'static [&'static str],
}

/// A key by which tables refer to a group's: of a key that is missing there, messages say who uses
/// the table.
#[derive(Debug, Clone, Copy)]
pub struct Reference {
    /// The group that is referred to.
    pub group: &'static str,
    /// The groups whose tables refer to it.
    pub from: &'static [&'static str],
    /// The key that holds the name.
    pub key: &'static str,
}

/// Remedies for files that are probably something else.
#[derive(Debug, Clone, Copy, Default)]
pub struct Advice {
    /// For an empty file: what it must have at least.
    pub empty: Option<&'static str>,
    /// For a file that is no text, or too large: what it should be.
    pub other_file: Option<&'static str>,
    /// For keys of too many parts: how many a key has.
    pub too_deep: Option<&'static str>,
}

impl Schema {
    /// The schema of these tables; `noun` is what a document is called.
    #[must_use]
    pub const fn new(noun: &'static str, tables: &'static [Table]) -> Self {
        let advice = Advice { empty: None, other_file: None, too_deep: None };
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
    pub const fn with_references(mut self, references: &'static [Reference]) -> Self {
        self.references = references;
        self
    }

    /// The same schema with remedies for files that are something else.
    #[must_use]
    pub const fn with_advice(mut self, advice: Advice) -> Self {
        self.advice = advice;
        self
    }

    /// The root table.
    pub fn root(&self) -> Option<&'static Table> {
        self.tables.iter().find(|table| table.pattern.is_empty())
    }

    /// The tables right below a table.
    pub fn children(&self, table: &Table) -> impl Iterator<Item = &'static Table> + use<> {
        let parent = table.pattern;
        self.tables.iter().filter(move |table| {
            let own = table.pattern.strip_suffix(".*").unwrap_or(table.pattern);
            let above = own.rsplit_once('.').map_or("", |(above, _)| above);
            !own.is_empty() && above == parent
        })
    }

    /// The names that may stand in a table: its keys that are built in, then its tables.
    pub fn allowed(&self, table: &Table) -> Vec<&'static str> {
        let keys = table.keys.iter().filter(|key| key.presence != Presence::NotYet);
        keys.map(|key| key.name).chain(self.children(table).map(Table::name)).collect()
    }

    /// What a dotted path such as `pump.main.pressure` addresses.
    pub fn find(&self, path: &str) -> Option<Found> {
        let mut table = self.root()?;
        let mut segments = path.split('.');
        while let Some(segment) = segments.next() {
            if let Some(key) = table.key(segment) {
                return segments.next().is_none().then_some(Found::Key(table, key));
            }
            table = self.children(table).find(|child| child.name() == segment)?;
            if table.occurrence == Occurrence::Named && segments.next().is_none() {
                return Some(Found::Group(table));
            }
        }
        Some(Found::Table(table))
    }

    /// The first table that has a key of this name.
    pub(crate) fn table_with(&self, key: &str) -> Option<&'static Table> {
        self.tables.iter().find(|table| table.key(key).is_some())
    }

    /// The noun with its article: "a scene".
    pub(crate) fn a_document(&self) -> String {
        let article = if self.noun.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
        format!("{article} {}", self.noun)
    }
}
