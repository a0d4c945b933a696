//! A document with other numbers, for a study of many: how it takes them, and what made from it stays the same.

use super::{Document, Entry};
use crate::judge::Judge;
use crate::sets::setting;
use crate::source::Origin;
use crate::tree::lenient_value;
use crate::value::Value;
use std::sync::atomic::{AtomicU64, Ordering};

impl Document {
    /// Takes other numbers, as if the file had been read with `sets` in place of its own settings: quicker than that, for a study of many
    /// documents. Returns whether it could; otherwise it is unchanged, and reading has to tell: settings of other keys, a changed value
    /// that is not a number in the place of a number (a word may decide about other keys), or that its key doesn't accept.
    #[must_use]
    pub fn take_numbers(&mut self, sets: &[(String, String)]) -> bool {
        let Some(numbers) = self.numbers(sets) else { return false };
        sets.clone_into(&mut self.sets);
        self.entries.extend(numbers);
        true
    }

    /// The entries that these settings change.
    fn numbers(&self, sets: &[(String, String)]) -> Option<Vec<(String, Entry)>> {
        let same_key = |(own, other): (&(String, String), &(String, String))| own.0 == other.0;
        if self.sets.len() != sets.len() || !self.sets.iter().zip(sets).all(same_key) {
            return None;
        }
        let mut judged = Vec::new();
        for (index, ((path, old), (_, value))) in self.sets.iter().zip(sets).enumerate() {
            if old == value {
                continue;
            }
            let path = path.trim();
            let entry = self.entries.get(path)?;
            // It isn't where a later setting replaced it.
            if !matches!(&entry.origin, Origin::Set { index: from, .. } if *from == index) {
                return None;
            }
            let node = lenient_value(value.trim(), Origin::Set { index, text: setting(path, value) });
            let mut judge = Judge { schema: self.schema, source: &self.source, findings: Vec::new() };
            let value = judge.value(entry.key, path, &node).filter(|_| judge.findings.is_empty())?;
            let is_number = |value: &Value| matches!(value, Value::Number(_) | Value::Integer(_));
            if !is_number(&value) || !is_number(&entry.value) {
                return None;
            }
            let entry = Entry { key: entry.key, value, origin: node.origin, written: node.written };
            judged.push((path.to_owned(), entry));
        }
        Some(judged)
    }

    /// What `make` makes, with the settings whose values are read meanwhile: after [`Document::take_numbers`] it would make the same
    /// again if [these are as they were](Document::has_settings).
    pub fn settings_read<T>(&self, make: impl FnOnce() -> T) -> (T, SettingsRead) {
        self.reads.while_made(&self.sets, make)
    }

    /// Whether these settings, read in this document, have the values that they had then.
    #[must_use]
    pub fn has_settings(&self, read: &SettingsRead) -> bool {
        read.are_among(&self.sets)
    }
}

/// Settings by their numbers, with their values.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SettingsRead(Vec<(usize, String)>);

impl SettingsRead {
    /// Those of both.
    #[must_use]
    pub fn and(&self, other: &Self) -> Self {
        let others = other.0.iter().filter(|setting| !self.0.contains(setting));
        Self(self.0.iter().chain(others).cloned().collect())
    }

    /// Whether they have the same values among `sets`.
    pub(crate) fn are_among(&self, sets: &[(String, String)]) -> bool {
        self.0.iter().all(|(number, value)| sets.get(*number).is_some_and(|(_, now)| now == value))
    }
}

/// How often the value of each setting was read. It only grows: what another thread reads meanwhile can make it look as if more
/// was read, never less.
#[derive(Debug, Default)]
pub(crate) struct ReadCounts(Box<[AtomicU64]>);

impl ReadCounts {
    pub(crate) fn new(settings: usize) -> Self {
        Self((0..settings).map(|_| AtomicU64::new(0)).collect())
    }

    pub(crate) fn count(&self, setting: usize) {
        if let Some(count) = self.0.get(setting) {
            count.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// What `make` makes, and which of `sets` are read meanwhile.
    pub(crate) fn while_made<T>(&self, sets: &[(String, String)], make: impl FnOnce() -> T) -> (T, SettingsRead) {
        let now = || self.0.iter().map(|count| count.load(Ordering::Relaxed)).collect::<Vec<u64>>();
        let before = now();
        let made = make();
        let grown = before.into_iter().zip(now()).map(|(before, after)| after != before);
        let read = sets.iter().enumerate().zip(grown).filter(|(_, grown)| *grown);
        (made, SettingsRead(read.map(|((number, (_, value)), _)| (number, value.clone())).collect()))
    }
}

/// A copy has been read by nobody.
impl Clone for ReadCounts {
    fn clone(&self) -> Self {
        Self::new(self.0.len())
    }
}
