//! All bodies against all: which of them are near each other, found in a time that grows with their
//! number, not with that of pairs.

use crate::placed::{Bounds, Places};
use crate::{BodyId, LawId, WiringError};

/// Bodies of which any two can touch, by the law of their classes: a material, say.
///
/// ```
/// use teeter_detect::{BodyId, Groups, LawId};
///
/// // Stones touch each other by law 0 and the wall by law 1; walls don't touch each other.
/// let laws = vec![vec![Some(LawId(0)), Some(LawId(1))], vec![Some(LawId(1)), None]];
/// let groups = Groups::new(vec![(BodyId(0), 0), (BodyId(1), 0), (BodyId(2), 1)], laws)?;
/// assert_eq!(groups.law(BodyId(0), BodyId(2)), Some(LawId(1)));
/// # Ok::<(), teeter_detect::WiringError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Groups {
    /// In the order of their bodies.
    members: Vec<(BodyId, usize)>,
    /// The law of each pair of classes, by rows.
    laws: Vec<Option<LawId>>,
    classes: usize,
    /// Pairs of members, by their numbers, that don't touch whatever their classes say; sorted.
    apart: Vec<[usize; 2]>,
}

/// Bodies that one set of groups can have: pairs are numbered by 32 bits.
const MOST_MEMBERS: usize = 1 << 15;

impl Groups {
    /// Bodies with their classes, and the law between each two of these; `None` where they don't
    /// touch. The table is symmetric: for two classes the entry of the lower row is taken.
    ///
    /// # Errors
    /// If there are too many bodies, one is listed twice, or the table has no entry for two
    /// classes.
    pub fn new(mut members: Vec<(BodyId, usize)>, laws: Vec<Vec<Option<LawId>>>) -> Result<Self, WiringError> {
        members.sort_by_key(|(body, _)| *body);
        if members.len() > MOST_MEMBERS {
            return Err(WiringError::Members { members: members.len(), most: MOST_MEMBERS });
        }
        if let Some(twice) = members.windows(2).find(|two| two[0].0 == two[1].0) {
            return Err(WiringError::ListedTwice { body: twice[0].0 });
        }
        let classes = laws.len();
        let of = members.iter().find(|(_, class)| *class >= classes || laws[*class].len() < classes);
        if let Some((body, class)) = of {
            return Err(WiringError::NoClass { body: *body, class: *class });
        }
        let laws = laws.into_iter().flat_map(|row| row.into_iter().take(classes)).collect();
        Ok(Self { members, laws, classes, apart: Vec::new() })
    }

    /// The same, but for single pairs of bodies that don't touch whatever their classes say. Those
    /// of bodies that are no members are ignored.
    #[must_use]
    pub fn without(mut self, pairs: &[[BodyId; 2]]) -> Self {
        let numbers = |[a, b]: &[BodyId; 2]| {
            let (i, j) = (self.number_of(*a)?, self.number_of(*b)?);
            Some([i.min(j), i.max(j)])
        };
        let mut apart: Vec<[usize; 2]> = self.apart.iter().copied().chain(pairs.iter().filter_map(numbers)).collect();
        apart.sort_unstable();
        apart.dedup();
        self.apart = apart;
        self
    }

    /// The law between two bodies; `None` where they don't touch, or one is no member.
    #[must_use]
    pub fn law(&self, a: BodyId, b: BodyId) -> Option<LawId> {
        let (i, j) = (self.number_of(a)?, self.number_of(b)?);
        let apart = i == j || self.apart.binary_search(&[i.min(j), i.max(j)]).is_ok();
        if apart { None } else { self.law_of(i, j) }
    }

    /// The pairs that don't touch whatever their classes say, by the numbers of their bodies among
    /// the members.
    pub(crate) fn apart(&self) -> &[[usize; 2]] {
        &self.apart
    }

    fn number_of(&self, body: BodyId) -> Option<usize> {
        self.members.binary_search_by_key(&body, |(member, _)| *member).ok()
    }

    fn law_of(&self, i: usize, j: usize) -> Option<LawId> {
        let (a, b) = (self.members[i].1, self.members[j].1);
        self.laws[a.min(b) * self.classes + a.max(b)]
    }

    /// The bodies, in their order.
    pub(crate) fn bodies(&self) -> impl Iterator<Item = BodyId> + '_ {
        self.members.iter().map(|(body, _)| *body)
    }

    /// How many pairs there can be.
    pub(crate) fn pairs(&self) -> usize {
        self.members.len() * self.members.len().saturating_sub(1) / 2
    }

    /// The number of the pair of two members, above those of the pairs that are listed.
    pub(crate) fn pair(&self, first: u32, i: usize, j: usize) -> u32 {
        first + (i * self.members.len() + j) as u32
    }

    /// The members of a pair, and their law; `None` for a number that is none of theirs.
    pub(crate) fn of_pair(&self, first: u32, pair: u32) -> Option<([usize; 2], LawId)> {
        let number = pair.checked_sub(first)? as usize;
        let (i, j) = (number.checked_div(self.members.len())?, number.checked_rem(self.members.len())?);
        let there = i < j && i < self.members.len();
        there.then(|| self.law_of(i, j)).flatten().map(|law| ([i, j], law))
    }
}

/// Two members that are near each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NearPair {
    pub(crate) pair: u32,
    pub(crate) law: LawId,
    /// Their numbers among all shapes.
    pub(crate) members: [usize; 2],
}

/// The pairs that are near each other, kept while no body has moved far. It decides nothing: what
/// is nearer than a margin is among them as long as they are kept.
#[derive(Debug, Default)]
pub(crate) struct Near {
    /// Of each member: where its box may be.
    allowed: Vec<Bounds>,
    /// The largest margin (m) for which the list is good.
    margin: f64,
    /// In the order of their numbers.
    pub(crate) pairs: Vec<NearPair>,
    /// The members along the axis of the sweep.
    order: Vec<u32>,
    /// Those that the sweep is over.
    open: Vec<u32>,
}

/// A list is good until a box has moved by this part of the mean extent of all of them.
const SKIN: f64 = 0.1;

/// The margin for which a list is made, in the same measure, where less is asked for: schemes look
/// further ahead now and then.
const USUAL: f64 = 0.05;

impl Near {
    /// Sees to it that all pairs that are at most `margin` (m) apart are listed. `of` are the
    /// numbers of the groups' members among all shapes; `listed` are pairs of these that are left
    /// out.
    pub(crate) fn update(
        &mut self,
        groups: &Groups,
        first: u32,
        of: &[usize],
        listed: &[[usize; 2]],
        places: &Places,
        margin: f64,
    ) {
        let boxes = || of.iter().map(|member| &places.boxes[*member]);
        let good = self.allowed.len() == of.len()
            && margin <= self.margin
            && self.allowed.iter().zip(boxes()).all(|(allowed, now)| allowed.holds(now));
        if good {
            return;
        }
        let extents: f64 = boxes().map(|b| (b.high - b.low).sum()).sum();
        let mean = 0.5 * extents / of.len().max(1) as f64;
        let skin = SKIN * mean;
        self.margin = margin.max(USUAL * mean);
        self.allowed.clear();
        self.allowed.extend(boxes().map(|b| b.grown(skin)));
        // A pair whose boxes come to be within the margin has boxes now that are two skins further
        // from each other.
        self.sweep(groups, first, of, listed, places, self.margin + 2.0 * skin);
    }

    /// Lists the pairs whose boxes are at most `reach` (m) apart: along the axis along which the
    /// boxes lie further apart, each is compared with those that have begun before it and not
    /// ended.
    fn sweep(&mut self, groups: &Groups, first: u32, of: &[usize], listed: &[[usize; 2]], places: &Places, reach: f64) {
        let boxed = |k: u32| &places.boxes[of[k as usize]];
        let spread = |axis: usize| {
            let centres = || of.iter().map(|member| places.boxes[*member].low[axis] + places.boxes[*member].high[axis]);
            let mean = centres().sum::<f64>() / of.len().max(1) as f64;
            centres().map(|x| (x - mean).powi(2)).sum::<f64>()
        };
        let axis = usize::from(spread(1) > spread(0));
        let Self { pairs, order, open, .. } = self;
        order.clear();
        order.extend(0..of.len() as u32);
        order.sort_unstable_by(|a, b| boxed(*a).low[axis].total_cmp(&boxed(*b).low[axis]).then(a.cmp(b)));
        pairs.clear();
        open.clear();
        for &k in order.iter() {
            let begin = boxed(k).low[axis];
            open.retain(|other| boxed(*other).high[axis] + reach >= begin);
            for &other in open.iter() {
                if !boxed(k).near(boxed(other), reach) {
                    continue;
                }
                let (i, j) = (k.min(other) as usize, k.max(other) as usize);
                let Some(law) = groups.law_of(i, j) else { continue };
                let members = [of[i], of[j]];
                if listed.binary_search(&[members[0].min(members[1]), members[0].max(members[1])]).is_err() {
                    pairs.push(NearPair { pair: groups.pair(first, i, j), law, members });
                }
            }
            open.push(k);
        }
        pairs.sort_unstable_by_key(|near| near.pair);
    }
}
