//! What the scenes of a study have in common: the document but for some numbers, and records, read and corrected once.

use super::records::Scaling;
use crate::diagnostic::Diagnostics;
use crate::document::Document;
use crate::scene::RecordScene;
use std::sync::{Arc, Mutex, PoisonError};
use teeter_record::Record;

/// Accelerations that are held at most, some 30 MB: of a study in which every case cuts its record differently, all but a few
/// would be held in vain.
const MOST_VALUES: usize = 4_000_000;

/// Records held at most, as they are searched one by one.
const MOST_RECORDS: usize = 256;

/// What one scene after another is made of, held for the next one. Their text and files must be the same.
#[derive(Debug, Default)]
pub struct SharedParts {
    /// That of an earlier scene.
    document: Mutex<Option<Arc<Document>>>,
    corrected: Mutex<Held<RecordKeys, Record>>,
    used: Mutex<Held<(RecordKeys, Placed), RecordScene>>,
}

/// What decides what a record is before it is scaled.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RecordKeys {
    pub(super) file: String,
    /// s.
    pub(super) step: Option<f64>,
    /// m/s².
    pub(super) unit: Option<f64>,
    pub(super) component: Option<String>,
    /// s.
    pub(super) from: Option<f64>,
    /// s.
    pub(super) to: Option<f64>,
    /// The degree.
    pub(super) baseline: Option<usize>,
    pub(super) taper: f64,
}

/// The table that names a record, and how it scales it.
type Placed = (String, Option<(&'static str, Scaling)>);

impl SharedParts {
    /// The document with these settings: an earlier one with other numbers if that is all they change, or made now.
    pub(crate) fn document(
        &self,
        sets: &[(String, String)],
        make: impl FnOnce() -> Result<Document, Diagnostics>,
    ) -> Result<Arc<Document>, Diagnostics> {
        let lock = || self.document.lock().unwrap_or_else(PoisonError::into_inner);
        let earlier = lock().clone();
        if let Some(document) = earlier.and_then(|document| document.with_numbers(sets)) {
            return Ok(Arc::new(document));
        }
        let document = Arc::new(make()?);
        *lock() = Some(Arc::clone(&document));
        Ok(document)
    }

    /// The record as corrected, from earlier or made now.
    pub(super) fn corrected(&self, keys: &RecordKeys, make: impl FnOnce() -> Option<Record>) -> Option<Arc<Record>> {
        Held::find_or(&self.corrected, keys, make, Record::len)
    }

    /// The record as used, from earlier or made now.
    pub(super) fn used(
        &self,
        keys: &(RecordKeys, Placed),
        make: impl FnOnce() -> Option<RecordScene>,
    ) -> Option<Arc<RecordScene>> {
        Held::find_or(&self.used, keys, make, |of| 4 * of.record.len())
    }
}

/// Values by their keys.
#[derive(Debug)]
struct Held<K, V> {
    entries: Vec<(K, Arc<V>)>,
    /// The sum of their sizes.
    size: usize,
}

impl<K, V> Default for Held<K, V> {
    fn default() -> Self {
        Self { entries: Vec::new(), size: 0 }
    }
}

impl<K: PartialEq + Clone, V> Held<K, V> {
    /// Not locked while it is made: two threads may make the same value.
    fn find_or(
        held: &Mutex<Self>,
        key: &K,
        make: impl FnOnce() -> Option<V>,
        size: impl Fn(&V) -> usize,
    ) -> Option<Arc<V>> {
        let lock = || held.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, value)) = lock().entries.iter().find(|(known, _)| known == key) {
            return Some(Arc::clone(value));
        }
        let value = Arc::new(make()?);
        let size = size(&value);
        let mut held = lock();
        if held.size + size > MOST_VALUES || held.entries.len() == MOST_RECORDS {
            *held = Self::default();
        }
        held.size += size;
        held.entries.push((key.clone(), Arc::clone(&value)));
        Some(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_made_once_and_few_are_held() {
        let held = Mutex::new(Held::default());
        let mut made = 0;
        for key in [1, 2, 1, 2, 1] {
            let value = Held::find_or(&held, &key, || Some(10 * key).inspect(|_| made += 1), |_| 1);
            assert_eq!(value.as_deref(), Some(&(10 * key)));
        }
        assert_eq!(made, 2);
        assert_eq!(Held::find_or(&held, &3, || None, |_| 1), None, "what can't be made isn't held");
        for key in 0..10 * MOST_RECORDS {
            Held::find_or(&held, &key, || Some(key), |_| 1);
            assert!(held.lock().unwrap().entries.len() <= MOST_RECORDS);
        }
        for key in 0..10 {
            Held::find_or(&held, &key, || Some(key), |_| MOST_VALUES / 3);
            assert!(held.lock().unwrap().size <= MOST_VALUES);
        }
    }
}
