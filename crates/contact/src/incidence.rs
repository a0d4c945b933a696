//! Which contacts act on the same body or velocity.

/// No entry.
const NONE: usize = usize::MAX;

/// Which bodies or velocities contacts act on, each a number (a key), and for each key the contacts
/// that act on it.
///
/// The code that assembles `H = J W Jᵀ` names the keys of each contact: the columns of J where W is
/// diagonal, or the bodies where W couples all velocities of a body. Contacts that share a key are
/// neighbours: they have a block in [`BlockSparse::set_pattern`](crate::BlockSparse::set_pattern),
/// and belong to one island of [`Islands::find_shared`](crate::Islands::find_shared).
///
/// ```
/// use teeter_contact::Incidence;
///
/// // Contact 0 lies between bodies 7 and 3, contact 1 between 3 and the ground, which isn't named: it can't be pushed.
/// let bodies: [&[usize]; 2] = [&[7, 3], &[3]];
/// let mut incidence = Incidence::default();
/// incidence.load(2, |contact| bodies[contact].iter().copied());
/// assert!(incidence.sharing(3).eq([0, 1]));
/// assert!(incidence.sharing(7).eq([0]));
/// ```
#[derive(Clone, Debug, Default)]
pub struct Incidence {
    /// Of each key, its first and its last entry.
    lists: Vec<[usize; 2]>,
    /// By contacts, and for each contact in the order in which its keys were named.
    entries: Vec<Entry>,
    /// Where the entries of each contact start, and the end of the last ones.
    start: Vec<usize>,
}

/// A contact touches a key.
#[derive(Clone, Copy, Debug)]
struct Entry {
    contact: usize,
    key: usize,
    /// The key's next entry, of a later contact.
    next: usize,
}

impl Incidence {
    /// Takes the keys of each of `contacts` contacts, in memory that is kept; time is linear in the
    /// number of keys. A key that a contact names twice counts once. Memory grows with the largest
    /// key, so number keys without large gaps.
    pub fn load<I: IntoIterator<Item = usize>>(&mut self, contacts: usize, mut touched: impl FnMut(usize) -> I) {
        // Only lists that were in use are cleared, so that few contacts among many bodies cost
        // little.
        for entry in self.entries.drain(..) {
            self.lists[entry.key] = [NONE; 2];
        }
        self.start.clear();
        self.start.push(0);
        for contact in 0..contacts {
            for key in touched(contact) {
                self.push(contact, key);
            }
            self.start.push(self.entries.len());
        }
    }

    fn push(&mut self, contact: usize, key: usize) {
        if key >= self.lists.len() {
            self.lists.resize(key + 1, [NONE; 2]);
        }
        let entry = self.entries.len();
        let [first, last] = &mut self.lists[key];
        if *last == NONE {
            *first = entry;
        } else if self.entries[*last].contact == contact {
            return;
        } else {
            self.entries[*last].next = entry;
        }
        *last = entry;
        self.entries.push(Entry { contact, key, next: NONE });
    }

    /// Number of contacts.
    #[must_use]
    pub fn contacts(&self) -> usize {
        self.start.len().saturating_sub(1)
    }

    /// The keys that a contact touches, each once, in the order in which they were named.
    ///
    /// # Panics
    /// If there is no such contact: a mistake of the calling code.
    pub fn keys_of(&self, contact: usize) -> impl Iterator<Item = usize> {
        self.entries[self.start[contact]..self.start[contact + 1]].iter().map(|entry| entry.key)
    }

    /// The contacts that touch a key, ascending; none for a key that was not named.
    pub fn sharing(&self, key: usize) -> impl Iterator<Item = usize> {
        let mut at = self.lists.get(key).map_or(NONE, |[first, _]| *first);
        std::iter::from_fn(move || {
            let entry = self.entries.get(at)?;
            at = entry.next;
            Some(entry.contact)
        })
    }

    /// Each contact with the first one that touches the same key: these pairs connect every island.
    pub(crate) fn joints(&self) -> impl Iterator<Item = (usize, usize)> {
        self.entries.iter().map(|entry| (self.entries[self.lists[entry.key][0]].contact, entry.contact))
    }

    /// Makes room for `contacts` contacts that name keys below `keys`, `touches` of them in all.
    pub fn reserve(&mut self, contacts: usize, keys: usize, touches: usize) {
        self.lists.reserve(keys.saturating_sub(self.lists.len()));
        self.entries.reserve(touches.saturating_sub(self.entries.len()));
        self.start.reserve((contacts + 1).saturating_sub(self.start.len()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contacts_ascend_and_count_once() {
        let touched: [&[usize]; 4] = [&[5, 2, 5], &[], &[2], &[2, 0, 5]];
        let mut incidence = Incidence::default();
        for _ in 0..2 {
            incidence.load(4, |i| touched[i].iter().copied());
            assert_eq!(incidence.contacts(), 4);
            assert!(incidence.keys_of(0).eq([5, 2]));
            assert!(incidence.keys_of(1).eq([]));
            assert!(incidence.sharing(2).eq([0, 2, 3]));
            assert!(incidence.sharing(5).eq([0, 3]));
            assert!(incidence.sharing(1).eq([]) && incidence.sharing(99).eq([]));
        }
    }

    #[test]
    fn what_was_loaded_before_is_forgotten() {
        let mut incidence = Incidence::default();
        incidence.load(3, |i| [i, i + 1]);
        incidence.load(1, |_| [2]);
        assert_eq!(incidence.contacts(), 1);
        assert!(incidence.sharing(1).eq([]) && incidence.sharing(2).eq([0]));
    }
}
