//! Values that one scene after another needs, held by what they depend on.

use std::sync::{Arc, Mutex, PoisonError};

/// Numbers that are held at most, some 30 MB: of a study in which every case cuts its record differently, all but a few would be
/// held in vain.
const MOST_VALUES: usize = 4_000_000;

/// Values by their keys.
#[derive(Debug)]
pub(crate) struct Held<K, V> {
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
    /// The values that are held.
    pub(crate) fn values(&self) -> impl Iterator<Item = &V> {
        self.entries.iter().map(|(_, value)| &**value)
    }

    /// Not locked while it is made: two threads may make the same value.
    pub(crate) fn find_or(
        held: &Mutex<Self>,
        key: &K,
        most: usize,
        make: impl FnOnce() -> Option<V>,
        size: impl Fn(&V) -> usize,
    ) -> Option<Arc<V>> {
        Self::try_find_or(held, key.clone(), most, || make().ok_or(()), size).ok()
    }

    /// The same for what may fail, and with the most entries given.
    pub(crate) fn try_find_or<E>(
        held: &Mutex<Self>,
        key: K,
        most: usize,
        make: impl FnOnce() -> Result<V, E>,
        size: impl Fn(&V) -> usize,
    ) -> Result<Arc<V>, E> {
        let lock = || held.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, value)) = lock().entries.iter().find(|(known, _)| *known == key) {
            return Ok(Arc::clone(value));
        }
        let value = Arc::new(make()?);
        let size = size(&value);
        let mut held = lock();
        if held.size + size > MOST_VALUES || held.entries.len() == most {
            *held = Self::default();
        }
        held.size += size;
        held.entries.push((key, Arc::clone(&value)));
        Ok(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOST: usize = 256;

    #[test]
    fn a_value_is_made_once_and_few_are_held() {
        let held = Mutex::new(Held::default());
        let mut made = 0;
        for key in [1, 2, 1, 2, 1] {
            let value = Held::find_or(&held, &key, MOST, || Some(10 * key).inspect(|_| made += 1), |_| 1);
            assert_eq!(value.as_deref(), Some(&(10 * key)));
        }
        assert_eq!(made, 2);
        assert_eq!(Held::find_or(&held, &3, MOST, || None, |_| 1), None, "what can't be made isn't held");
        for key in 0..10 * MOST {
            Held::find_or(&held, &key, MOST, || Some(key), |_| 1);
            assert!(held.lock().unwrap().entries.len() <= MOST);
        }
        for key in 0..10 {
            Held::find_or(&held, &key, MOST, || Some(key), |_| MOST_VALUES / 3);
            assert!(held.lock().unwrap().size <= MOST_VALUES);
        }
    }
}
