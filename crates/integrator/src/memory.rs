//! What decides the next step beside coordinates and velocities.

use crate::Contact;
use teeter_detect::ContactId;

/// What a scheme remembers from step to step. It is part of the [`State`](crate::State), as it
/// decides the next step; what only speeds up the solver is in [`WarmStart`](crate::WarmStart).
///
/// The active contacts decide restitution: a contact that was active before doesn't impact. Springs
/// of contacts with duration keep their gaps. Whatever else a scheme has to remember goes into its
/// own numbers.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Memory {
    /// The contacts that count as active, in order of identity.
    active: Vec<ContactId>,
    /// Gaps of the springs of contacts with duration, m; 0 for others.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored::list"))]
    gaps: Vec<f64>,
    #[cfg_attr(feature = "serde", serde(with = "crate::stored::list"))]
    numbers: Vec<f64>,
}

impl Memory {
    /// Makes room for so many contacts.
    pub fn reserve(&mut self, contacts: usize) {
        self.active.reserve(contacts);
        self.gaps.reserve(contacts);
    }

    /// Forgets all contacts; a scheme's own numbers stay.
    pub fn forget_contacts(&mut self) {
        self.active.clear();
        self.gaps.clear();
    }

    /// Forgets the contacts without a compressed spring; a scheme's own numbers stay.
    pub(crate) fn forget_rigid(&mut self) {
        let Self { active, gaps, .. } = self;
        let mut number = 0;
        active.retain(|_| {
            number += 1;
            gaps[number - 1] < 0.0
        });
        gaps.retain(|gap| *gap < 0.0);
    }

    /// Remembers a contact as active, in its place in the order of identity.
    pub(crate) fn insert<const D: usize>(&mut self, contact: &Contact<D>) {
        if let Err(at) = self.active.binary_search(&contact.id) {
            self.active.insert(at, contact.id);
            self.gaps.insert(at, contact.gap_after.map_or(0.0, |gap| gap.min(0.0)));
        }
    }

    /// Remembers a contact without a spring as active, in its place in the order of identity.
    pub(crate) fn activate(&mut self, id: ContactId) {
        if let Err(at) = self.active.binary_search(&id) {
            self.active.insert(at, id);
            self.gaps.insert(at, 0.0);
        }
    }

    /// Remembers a contact as active. Add contacts in order of identity.
    pub fn remember<const D: usize>(&mut self, contact: &Contact<D>) {
        self.active.push(contact.id);
        self.gaps.push(contact.gap_after.map_or(0.0, |gap| gap.min(0.0)));
    }

    /// The contacts that count as active, in order of identity.
    #[must_use]
    pub fn active(&self) -> &[ContactId] {
        &self.active
    }

    /// Whether a contact counts as active.
    #[must_use]
    pub fn is_active(&self, id: ContactId) -> bool {
        self.active.binary_search(&id).is_ok()
    }

    /// The same for one that likely has this number among them.
    #[inline]
    pub(crate) fn is_active_near(&self, id: ContactId, number: usize) -> bool {
        self.active.get(number) == Some(&id) || self.is_active(id)
    }

    /// Gap of the spring of an active contact with duration, m: negative while it is compressed;
    /// `None` for a contact that is not active.
    #[must_use]
    pub fn spring_gap(&self, id: ContactId) -> Option<f64> {
        let at = self.active.binary_search(&id).ok()?;
        self.gaps.get(at).copied()
    }

    /// That gap of one that is compressed, m: negative.
    pub(crate) fn pressed_gap(&self, id: ContactId) -> Option<f64> {
        self.spring_gap(id).filter(|gap| *gap < 0.0)
    }

    /// The numbers that a scheme stored last; `None` if there are none yet, or not as many.
    ///
    /// ```
    /// let mut memory = teeter_integrator::Memory::default();
    /// assert_eq!(memory.numbers::<2>(), None);
    /// memory.set_numbers(&[1e-4, 0.5]);
    /// assert_eq!(memory.numbers(), Some([1e-4, 0.5]));
    /// ```
    #[must_use]
    pub fn numbers<const N: usize>(&self) -> Option<[f64; N]> {
        self.numbers.as_slice().try_into().ok()
    }

    /// The numbers that a scheme stored last, however many.
    #[must_use]
    pub fn all_numbers(&self) -> &[f64] {
        &self.numbers
    }

    /// Makes room for so many numbers of a scheme.
    pub fn reserve_numbers(&mut self, numbers: usize) {
        self.numbers.reserve(numbers);
    }

    /// Stores a scheme's own numbers in place of earlier ones; allocates only if there are more
    /// than ever before.
    pub fn set_numbers(&mut self, numbers: &[f64]) {
        self.numbers.clear();
        self.numbers.extend_from_slice(numbers);
    }

    /// Becomes equal to `other`; allocates only if `other` holds more than this ever has.
    pub fn copy_from(&mut self, other: &Self) {
        let Self { active, gaps, numbers } = other;
        self.active.clone_from(active);
        self.gaps.clone_from(gaps);
        self.numbers.clone_from(numbers);
    }

    /// Whether contacts ascend, and each has a gap.
    pub(crate) fn is_in_order(&self) -> bool {
        self.active.is_sorted_by(|a, b| a < b) && self.gaps.len() == self.active.len()
    }
}
