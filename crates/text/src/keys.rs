//! The table of keys: what a document may contain.
//!
//! One entry per key gives its kind, range, default and meaning. Decoding, written defaults, the
//! lists of allowed keys in messages and `--set` all follow from the tables of a
//! [`Schema`](crate::schema::Schema); a program can also generate its reference page from them.

use crate::dimension::Dimension;

/// Schema of a table of a document, such as `[time]` or `[beam.NAME]`: its keys.
#[derive(Debug)]
pub struct TableSchema {
    /// Dotted path; a `*` stands for a name chosen by the user; empty for the root.
    pub pattern: &'static str,
    /// When the table exists.
    pub occurrence: Occurrence,
    /// Its keys in the order of the output.
    pub keys: &'static [Key],
    /// What it describes.
    pub doc: &'static str,
}

/// When a table exists.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Occurrence {
    /// Always: its defaults and required keys apply even if the file doesn't name it.
    Always,
    /// If the file names it; at most one.
    Optional,
    /// One for each name that the user gives.
    Named,
    /// As a value of its parent, written `key = { … }`; at most one.
    Inline,
}

/// One key of a table.
#[derive(Debug, PartialEq)]
pub struct Key {
    /// Name within its table.
    pub name: &'static str,
    /// Kind of its value.
    pub kind: Kind,
    /// Whether it must be given, and its meaning if it is not.
    pub presence: Presence,
    /// Values that are not implemented yet: the value's text and what to do instead.
    pub reserved: &'static [Reserved],
    /// A word equivalent to leaving the key out.
    pub left_out_as: Option<&'static str>,
    /// A valid value, in TOML.
    pub example: &'static str,
    /// One sentence.
    pub doc: &'static str,
    /// For a count, bytes of memory that each one takes; 0 if none.
    pub bytes_each: u64,
    /// Condition for the key to apply; `None`: always.
    pub only_with: Option<OnlyWith>,
    /// What a user may look for among the words of a choice, and where it is instead; empty if nothing.
    pub elsewhere: &'static str,
}

/// Words of another key of the same table for which a key applies: with others it is refused, and
/// neither required nor filled in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OnlyWith {
    /// The other key.
    pub sibling: &'static str,
    /// Its words.
    pub words: &'static [&'static str],
}

/// A value that is not implemented yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reserved {
    /// The text of the value (`true` for a flag).
    pub value: &'static str,
    /// What to do instead.
    pub instead: &'static str,
}

/// Whether a key must be given, and what it means when it is not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Presence {
    /// Must be given if its table exists.
    Required,
    /// Must be given with these words of the key named in `only_with`; optional with the others.
    RequiredWith(&'static [&'static str]),
    /// Must be given if this key of the same table is not.
    RequiredWithout(&'static str),
    /// Must be given if none of these keys and tables within the same table is.
    RequiredWithoutAny(&'static [&'static str]),
    /// May be left out; there is no default here.
    Optional,
    /// Defaults to this TOML value.
    Default(&'static str),
    /// Defaults to this TOML value if the sibling key is given; otherwise it stays absent.
    DefaultWith {
        /// The other key of the same table.
        sibling: &'static str,
        /// In TOML.
        value: &'static str,
    },
    /// Defaults to this TOML value if the sibling key is not given; otherwise it stays absent.
    DefaultWithout {
        /// The other key of the same table.
        sibling: &'static str,
        /// In TOML.
        value: &'static str,
    },
    /// Not implemented yet: refused.
    NotYet,
}

/// Largest number of characters of a [`Kind::Text`].
pub const LONGEST_TITLE: usize = 200;

/// The kind of a key's value.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Kind {
    /// A line of text for users, of at most [`LONGEST_TITLE`] characters, none of which controls a
    /// terminal.
    Text,
    /// A file, relative to the document's own.
    Path,
    /// A name of an object in the document: letters, digits, `_`, `-`.
    Name,
    /// One of some words.
    Choice(&'static [&'static str]),
    /// `true` or `false`.
    Flag,
    /// A whole number.
    Integer {
        /// Smallest allowed.
        min: i64,
        /// Largest allowed.
        max: i64,
    },
    /// A version of the format, one of these.
    Version(&'static [i64]),
    /// A bare number.
    Number(Range),
    /// A number with a unit.
    Quantity(Dimension, Range),
    /// An array of two quantities: x, y.
    Pair(Dimension, Range),
    /// An array of points, each an array of two quantities: x, y.
    Points(Dimension, Range),
    /// An array of any number of quantities.
    List(Dimension, Range),
    /// An array of any number of bare numbers.
    Numbers(Range),
    /// An array of two words.
    ChoicePair(&'static [&'static str]),
    /// An array of some of these words, each once.
    Words(&'static [&'static str]),
    /// One of some words, or a table of some keys; without words a table.
    WordOrTable(&'static [&'static str], &'static [Key]),
    /// An array of two, each one of some words or a table of some keys.
    WordOrTablePair(&'static [&'static str], &'static [Key]),
    /// An array of tables of some keys.
    Tables(&'static [Key]),
    /// An array of one or more names.
    Names,
    /// An array of two names.
    NamePair,
    /// An array of two names, in which a `*` stands for any characters and a `?` for one.
    PatternPair,
    /// An array of such arrays.
    PatternPairs,
    /// An array of one or more names, in which a `*` stands for any characters and a `?` for one.
    Patterns,
    /// A quantity in one of several units, which determines its meaning.
    Measure(&'static [crate::measure::AllowedUnit], Range),
    /// A vector: an array of two quantities x, y, or one quantity that is not negative, for a
    /// vector that points downwards.
    Downward(Dimension),
}

/// One end of a range.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Bound {
    /// No end.
    None,
    /// The end itself is allowed.
    Closed(f64),
    /// The end itself is not allowed.
    Open(f64),
}

/// The numbers that a key accepts, in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Lower end.
    pub low: Bound,
    /// Upper end.
    pub high: Bound,
    /// Smallest absolute value other than zero that the program can compute with.
    pub smallest: f64,
    /// Largest absolute value that the program can compute with.
    pub largest: f64,
}

impl Range {
    /// Any number up to 1e12 in absolute value.
    pub const ANY: Self = Self::new(Bound::None, Bound::None);
    /// Greater than zero, from 1e-12 to 1e12.
    pub const POSITIVE: Self = Self::new(Bound::Open(0.0), Bound::None).sizes(1e-12, 1e12);
    /// Zero or greater, up to 1e12.
    pub const NOT_NEGATIVE: Self = Self::new(Bound::Closed(0.0), Bound::None);
    /// From 0 to 1, ends included.
    pub const UNIT: Self = Self::new(Bound::Closed(0.0), Bound::Closed(1.0));
    /// From 0 to 1, ends excluded.
    pub const INSIDE_UNIT: Self = Self::new(Bound::Open(0.0), Bound::Open(1.0));

    /// A range between two ends, up to 1e12 in absolute value.
    pub const fn new(low: Bound, high: Bound) -> Self {
        Self { low, high, smallest: f64::MIN_POSITIVE, largest: 1e12 }
    }

    /// The same range with other limits of the absolute value.
    #[must_use]
    pub const fn sizes(mut self, smallest: f64, largest: f64) -> Self {
        self.smallest = smallest;
        self.largest = largest;
        self
    }

    /// What is wrong with `value`, in the unit of `dimension` (angles in degrees); `None` if it is
    /// allowed.
    ///
    /// ```
    /// use teeter_text::{dimension::Dimension, keys::Range};
    /// let rule = Range::POSITIVE.check(-0.0015, Dimension::LENGTH);
    /// assert_eq!(rule.as_deref(), Some("must be greater than 0 m"));
    /// assert_eq!(Range::POSITIVE.check(0.0015, Dimension::LENGTH), None);
    /// ```
    pub fn check(&self, value: f64, dimension: Dimension) -> Option<String> {
        if !value.is_finite() {
            return Some("not a finite number".to_owned());
        }
        let inside_low = match self.low {
            Bound::None => true,
            Bound::Closed(end) => value >= end,
            Bound::Open(end) => value > end,
        };
        let inside_high = match self.high {
            Bound::None => true,
            Bound::Closed(end) => value <= end,
            Bound::Open(end) => value < end,
        };
        let size = value.abs();
        if !(inside_low && inside_high) {
            Some(self.rule(dimension))
        } else if size > self.largest || (size != 0.0 && size < self.smallest) {
            Some(self.sizes_rule(dimension))
        } else {
            None
        }
    }

    /// The limits of the absolute value, in words.
    pub(crate) fn sizes_rule(&self, dimension: Dimension) -> String {
        let (smallest, largest) = (in_unit(self.smallest, dimension), in_unit(self.largest, dimension));
        format!("outside the supported range: {smallest} to {largest} in absolute value")
    }

    /// The range in words: "must lie in [0, 1]".
    pub fn rule(&self, dimension: Dimension) -> String {
        let show = |end| in_unit(end, dimension);
        match (self.low, self.high) {
            (Bound::None, Bound::None) => "may be any number".to_owned(),
            (Bound::Closed(low), Bound::None) => format!("must be at least {}", show(low)),
            (Bound::Open(low), Bound::None) => format!("must be greater than {}", show(low)),
            (Bound::None, Bound::Closed(high)) => format!("must be at most {}", show(high)),
            (Bound::None, Bound::Open(high)) => format!("must be less than {}", show(high)),
            (Bound::Closed(low), Bound::Closed(high)) => {
                format!("must lie in [{}, {}]", show(low), show(high))
            }
            (Bound::Open(low), Bound::Open(high)) => {
                format!("must lie between {} and {}, both excluded", show(low), show(high))
            }
            (Bound::Closed(low), Bound::Open(high)) => {
                format!("must be at least {} and less than {}", show(low), show(high))
            }
            (Bound::Open(low), Bound::Closed(high)) => {
                format!("must be greater than {} and at most {}", show(low), show(high))
            }
        }
    }
}

/// A bound for a message: short digits; angles in degrees.
fn in_unit(value: f64, dimension: Dimension) -> String {
    let (value, unit) =
        if dimension == Dimension::ANGLE { (value.to_degrees(), "deg".to_owned()) } else { (value, dimension.unit()) };
    let number =
        if value == 0.0 || (1e-4..1e6).contains(&value.abs()) { format!("{value}") } else { format!("{value:e}") };
    format!("{number} {unit}").trim_end().to_owned()
}

/// What a path refers to.
#[derive(Debug, Clone, Copy)]
pub enum PathTarget {
    /// A key of a table.
    Key(&'static TableSchema, &'static Key),
    /// A table.
    Table(&'static TableSchema),
    /// The group of named tables, such as `beam` of `beam.*`.
    Group(&'static TableSchema),
}

impl Key {
    /// A key that always applies; see [`Key::only_with`], [`Key::reserving`] and [`Key::taking`].
    #[must_use]
    pub const fn new(
        name: &'static str,
        kind: Kind,
        presence: Presence,
        example: &'static str,
        doc: &'static str,
    ) -> Self {
        Self {
            name,
            kind,
            presence,
            reserved: &[],
            left_out_as: None,
            example,
            doc,
            bytes_each: 0,
            only_with: None,
            elsewhere: "",
        }
    }

    /// The same key with values that are not implemented yet.
    #[must_use]
    pub const fn reserving(mut self, reserved: &'static [Reserved]) -> Self {
        self.reserved = reserved;
        self
    }

    /// The same key with a word equivalent to leaving it out.
    #[must_use]
    pub const fn left_out_as(mut self, word: &'static str) -> Self {
        self.left_out_as = Some(word);
        self
    }

    /// The same choice, with what a user may look for in vain, told with what is allowed.
    #[must_use]
    pub const fn elsewhere(mut self, elsewhere: &'static str) -> Self {
        self.elsewhere = elsewhere;
        self
    }

    /// The same key, which applies only if `sibling` is one of `words`.
    #[must_use]
    pub const fn only_with(mut self, sibling: &'static str, words: &'static [&'static str]) -> Self {
        self.only_with = Some(OnlyWith { sibling, words });
        self
    }

    /// The same key, a count of objects that take this many bytes of memory each.
    #[must_use]
    pub const fn taking(mut self, bytes_each: u64) -> Self {
        self.bytes_each = bytes_each;
        self
    }
}

impl TableSchema {
    /// The key with this name.
    pub fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name)
    }

    /// Last part of the pattern, without the star of a named table: `time`, `beam`,
    /// `damping_ratio`.
    pub fn name(&self) -> &'static str {
        let pattern = self.pattern.strip_suffix(".*").unwrap_or(self.pattern);
        pattern.rsplit('.').next().unwrap_or(pattern)
    }
}

#[cfg(test)]
mod tests {
    use super::Range;
    use crate::dimension::Dimension;

    #[test]
    fn ranges_name_their_ends_and_refuse_nan() {
        let number = Dimension::NONE;
        assert_eq!(Range::UNIT.check(1.2, number).as_deref(), Some("must lie in [0, 1]"));
        assert_eq!(Range::UNIT.check(1.0, number), None);
        assert_eq!(Range::INSIDE_UNIT.check(1.0, number).as_deref(), Some("must lie between 0 and 1, both excluded"));
        assert_eq!(Range::ANY.check(f64::NAN, number).as_deref(), Some("not a finite number"));
        assert_eq!(
            Range::POSITIVE.check(1e200, Dimension::LENGTH).as_deref(),
            Some("outside the supported range: 1e-12 m to 1e12 m in absolute value")
        );
        assert!(Range::POSITIVE.check(1e-13, Dimension::LENGTH).is_some());
    }
}
