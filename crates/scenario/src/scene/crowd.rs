//! Blocks of which any two can touch: so many pairs that they are not listed one by one.

use super::ContactScene;
use std::collections::BTreeSet;
use teeter_integrator::PairLaw;

/// Contacts between blocks that are not listed pair by pair.
///
/// Each block has a class; which contact holds for two blocks depends on their classes only. The
/// exceptions, pairs with a contact of their own or without any, are few. Of two blocks that touch,
/// the first is the one with the lower number.
///
/// In the model, the pair of the blocks i and j, i < j, of n has the number c + i n + j, c the
/// number of [listed contacts](super::Scene::contacts).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Crowd {
    /// For each block, its class.
    classes: Vec<usize>,
    /// For each pair of classes, by rows, the number of the contact that holds; symmetric.
    holders: Vec<Option<usize>>,
    /// Number of classes.
    count: usize,
    contacts: Vec<CrowdContact>,
    /// Pairs that don't touch although a contact holds for their classes, the lower number first.
    apart: BTreeSet<[usize; 2]>,
    /// Pairs that are listed among the scene's contacts.
    listed: BTreeSet<[usize; 2]>,
}

/// A contact of many pairs of blocks.
#[derive(Debug, Clone, PartialEq)]
pub struct CrowdContact {
    /// Its name.
    pub name: String,
    /// Friction and the law along the normal.
    pub law: PairLaw,
}

/// How many pairs there are of a block of one class and a block of another, by their sizes; or of
/// two blocks of the `same` class.
pub(crate) fn pairs_between(first: usize, second: usize, same: bool) -> usize {
    if same { first * first.saturating_sub(1) / 2 } else { first * second }
}

/// Two numbers, the lower one first.
fn ordered(a: usize, b: usize) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

impl Crowd {
    /// From the class of each block and, for each two classes, the number of the contact that
    /// holds, by rows of a symmetric table.
    pub(crate) fn new(classes: Vec<usize>, holders: Vec<Option<usize>>, contacts: Vec<CrowdContact>) -> Self {
        let count = classes.iter().map(|class| class + 1).max().unwrap_or_default();
        Self { classes, holders, count, contacts, ..Self::default() }
    }

    /// With pairs of blocks that don't touch.
    pub(crate) fn without(mut self, pairs: impl Iterator<Item = (usize, usize)>) -> Self {
        self.apart = pairs.map(|(a, b)| ordered(a, b)).collect();
        self
    }

    /// With the pairs that are among the listed contacts of the scene.
    pub(crate) fn beside<'a>(mut self, listed: impl Iterator<Item = &'a ContactScene>) -> Self {
        self.listed = listed.filter_map(|contact| Some(ordered(contact.block, contact.other_block()?))).collect();
        self
    }

    /// Its contacts.
    #[must_use]
    pub fn contacts(&self) -> &[CrowdContact] {
        &self.contacts
    }

    /// The number of the contact that holds for two blocks; `None` if they don't touch or their
    /// contact is listed.
    #[must_use]
    pub fn contact_of(&self, a: usize, b: usize) -> Option<usize> {
        let pair = ordered(a, b);
        if a == b || self.apart.contains(&pair) || self.listed.contains(&pair) {
            return None;
        }
        self.holder(*self.classes.get(a)?, *self.classes.get(b)?)
    }

    /// Whether two blocks have a contact, listed or not.
    #[must_use]
    pub fn joins(&self, a: usize, b: usize) -> bool {
        self.listed.contains(&ordered(a, b)) || self.contact_of(a, b).is_some()
    }

    /// The number of the contact that holds for two classes.
    pub(crate) fn holder(&self, a: usize, b: usize) -> Option<usize> {
        self.holders.get(a * self.count + b).copied().flatten()
    }

    /// Number of classes.
    pub(crate) fn class_count(&self) -> usize {
        self.count
    }

    /// For each block, its class.
    pub(crate) fn classes(&self) -> &[usize] {
        &self.classes
    }

    /// The pairs that don't touch although a contact holds for their classes.
    pub(crate) fn apart(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        self.apart.iter().copied()
    }

    /// Whether a block can touch another one by a contact of the crowd, or by the given one of
    /// them.
    #[must_use]
    pub fn takes_part(&self, block: usize, contact: Option<usize>) -> bool {
        let Some(class) = self.classes.get(block) else { return false };
        (0..self.count).filter_map(|other| self.holder(*class, other)).any(|of| contact.is_none_or(|asked| asked == of))
    }

    /// How many pairs of blocks it has.
    #[must_use]
    pub fn pair_count(&self) -> usize {
        let mut sizes = vec![0_usize; self.count];
        self.classes.iter().for_each(|class| sizes[*class] += 1);
        let mut pairs = 0;
        for a in 0..self.count {
            for b in (a..self.count).filter(|b| self.holder(a, *b).is_some()) {
                pairs += pairs_between(sizes[a], sizes[b], a == b);
            }
        }
        let held = |[a, b]: &&[usize; 2]| self.holder(self.classes[*a], self.classes[*b]).is_some();
        pairs - self.apart.union(&self.listed).filter(held).count()
    }

    /// The blocks of a pair, by its number in a model that lists `listed` pairs; `None` for one of
    /// those.
    #[must_use]
    pub fn blocks_of(&self, listed: usize, pair: u32) -> Option<[usize; 2]> {
        let number = (pair as usize).checked_sub(listed)?;
        let n = self.classes.len();
        let pair = [number.checked_div(n)?, number.checked_rem(n)?];
        (pair[0] < pair[1]).then_some(pair)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crowd() -> Crowd {
        let contact = |name: &str| CrowdContact { name: name.to_owned(), law: PairLaw::new(0.5, 0.0) };
        // Blocks 0, 1, 4 are stones, 2 and 3 pegs; pegs don't touch each other.
        let holders = vec![Some(0), Some(1), Some(1), None];
        Crowd::new(vec![0, 0, 1, 1, 0], holders, vec![contact("stones"), contact("pegs")])
            .without([(4, 0), (3, 2)].into_iter())
    }

    #[test]
    fn the_contact_of_two_blocks_is_that_of_their_classes() {
        let crowd = crowd();
        assert_eq!([(0, 1), (1, 4), (4, 1)].map(|(a, b)| crowd.contact_of(a, b)), [Some(0); 3]);
        assert_eq!([(0, 2), (3, 4)].map(|(a, b)| crowd.contact_of(a, b)), [Some(1); 2]);
        assert_eq!([(2, 3), (0, 4), (1, 1), (0, 9)].map(|(a, b)| crowd.contact_of(a, b)), [None; 4]);
        let all = (0..5).flat_map(|a| (a + 1..5).map(move |b| (a, b)));
        assert_eq!(crowd.pair_count(), all.filter(|(a, b)| crowd.contact_of(*a, *b).is_some()).count());
        assert!(crowd.takes_part(2, None) && crowd.takes_part(2, Some(1)) && !crowd.takes_part(2, Some(0)));
    }

    #[test]
    fn numbers_of_pairs_follow_the_listed_ones() {
        let crowd = crowd();
        assert_eq!(crowd.blocks_of(7, 7 + 5 + 3), Some([1, 3]));
        assert_eq!([6, 7, 7 + 5 * 3 + 1].map(|pair| crowd.blocks_of(7, pair)), [None; 3]);
    }
}
