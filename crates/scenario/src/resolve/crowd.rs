//! Contacts between so many pairs of blocks that they are not listed, but told by the blocks'
//! classes.

use std::collections::BTreeMap;

use super::Resolver;
use super::contacts::Joined;
use super::many::{Apart, Many, Rank};
use crate::placement::carried_by;
use crate::scene::{BeamScene, BlockScene, Crowd, CrowdContact, SupportingBody, pairs_between};

/// Up to so many pairs of blocks that patterns match are listed one by one. Listed or not, the
/// motion is the same but for rounding, as contacts have another order.
const MOST_LISTED: usize = 400;

/// Most blocks of a crowd: pairs are numbered with 32 bits.
const MOST_BLOCKS: usize = 1 << 15;

/// Most classes of blocks: the table of their contacts grows with the square.
const MOST_CLASSES: usize = 1000;

/// The classes of the blocks of a crowd: those of one are matched by the same patterns.
pub(super) struct Classes {
    /// For each block, its class.
    of: Vec<usize>,
    /// The blocks of each class.
    blocks: Vec<Vec<usize>>,
    /// For each class, which sides of contacts of many, and of what is apart, stand for its blocks,
    /// and at last whether they are fixed.
    marks: Vec<Vec<bool>>,
    /// How many of these are of contacts.
    of_contacts: usize,
    /// Blocks that stand on another block, with that one: their contact is listed, so that the
    /// placement can refer to it.
    pub(super) standing: Vec<[usize; 2]>,
}

/// There are too many blocks or classes, which has been reported.
pub(super) struct TooMany;

impl Classes {
    /// Whether the two sides number `side` and the next one stand for two classes, either way round.
    fn between(&self, side: usize, a: usize, b: usize) -> bool {
        let (a, b) = (&self.marks[a], &self.marks[b]);
        (a[side] && b[side + 1]) || (b[side] && a[side + 1])
    }

    /// Whether blocks of two classes don't touch, whatever contacts say.
    fn are_apart(&self, a: usize, b: usize) -> bool {
        let last = self.marks[a].len() - 1;
        let both_fixed = self.marks[a][last] && self.marks[b][last];
        both_fixed || (self.of_contacts..last).step_by(2).any(|side| self.between(side, a, b))
    }

    /// How many pairs two classes, or one with itself, have.
    fn pairs(&self, a: usize, b: usize) -> usize {
        pairs_between(self.blocks[a].len(), self.blocks[b].len(), a == b)
    }

    /// The classes two by two, each with itself, too.
    fn two(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let count = self.blocks.len();
        (0..count).flat_map(move |a| (a..count).map(move |b| (a, b)))
    }
}

impl Resolver<'_, '_> {
    /// The classes of the blocks, if contacts of many stand for more pairs of blocks than are
    /// listed; an error where they are too many for that, too.
    pub(super) fn crowded(&mut self, many: &[Option<Many>], apart: &Apart) -> Result<Option<Classes>, TooMany> {
        let count = self.block_names.len();
        // Of so few blocks there are no more pairs.
        if pairs_between(count, count, true) <= MOST_LISTED {
            return Ok(None);
        }
        let of_contacts = 2 * many.len();
        let width = of_contacts + 2 * apart.sides.len() + 1;
        let mut marks = vec![vec![false; width]; count];
        for (number, of) in many.iter().enumerate().filter_map(|(number, of)| Some((number, of.as_ref()?))) {
            for (side, bodies) in of.sides.iter().enumerate() {
                for (_, body) in &bodies.bodies {
                    if let SupportingBody::Block(block) = *body {
                        marks[block][2 * number + side] = true;
                    }
                }
            }
        }
        for (number, side) in apart.sides.iter().flatten().enumerate() {
            for body in side {
                if let SupportingBody::Block(block) = *body {
                    marks[block][of_contacts + number] = true;
                }
            }
        }
        for (block, marks) in marks.iter_mut().enumerate() {
            marks[width - 1] = self.is_fixed(SupportingBody::Block(block));
        }
        let mut known: BTreeMap<Vec<bool>, usize> = BTreeMap::new();
        let mut classes =
            Classes { of: Vec::new(), blocks: Vec::new(), marks: Vec::new(), of_contacts, standing: Vec::new() };
        for (block, marks) in marks.into_iter().enumerate() {
            let new = known.len();
            let class = *known.entry(marks).or_insert_with_key(|marks| {
                classes.marks.push(marks.clone());
                classes.blocks.push(Vec::new());
                new
            });
            classes.of.push(class);
            classes.blocks[class].push(block);
        }
        let matched = |(a, b): &(usize, usize)| {
            !classes.are_apart(*a, *b) && (0..of_contacts).step_by(2).any(|side| classes.between(side, *a, *b))
        };
        let mut pairs = 0;
        let more = classes.two().filter(matched).any(|(a, b)| {
            pairs += classes.pairs(a, b);
            pairs > MOST_LISTED
        });
        if !more {
            return Ok(None);
        }
        if count > MOST_BLOCKS {
            let rule = format!("{count} blocks of which any two may touch, more than the limit of {MOST_BLOCKS}");
            self.error("block", rule, "use fewer blocks");
            return Err(TooMany);
        }
        if classes.blocks.len() > MOST_CLASSES {
            let rule = format!(
                "patterns tell {} kinds of blocks apart, more than {MOST_CLASSES}, the most of a scene with so many blocks",
                classes.blocks.len()
            );
            self.error("contact", rule, "use fewer patterns, each for more blocks");
            return Err(TooMany);
        }
        classes.standing = self.standing();
        Ok(Some(classes))
    }

    /// The blocks that stand on another block, with that one.
    fn standing(&self) -> Vec<[usize; 2]> {
        let on = |(number, block): (usize, &super::names::BlockName)| {
            let on = block.stands_on.as_deref().or_else(|| self.doc.text(&format!("block.{}.on", block.table)))?;
            Some([number, *self.blocks.get(on)?]).filter(|[upper, lower]| upper != lower)
        };
        self.block_names.iter().enumerate().filter_map(on).collect()
    }

    /// The contacts of a crowd, but for the pairs that are listed.
    pub(super) fn crowd(
        &mut self,
        classes: &Classes,
        many: &[Option<Many>],
        joined: &Joined,
        apart: &Apart,
    ) -> Option<Crowd> {
        let count = classes.blocks.len();
        let mut holders: Vec<Option<usize>> = vec![None; count * count];
        let mut told: Vec<[usize; 2]> = Vec::new();
        for (a, b) in classes.two().filter(|(a, b)| !classes.are_apart(*a, *b) && classes.pairs(*a, *b) > 0) {
            let mut holds: Option<(usize, Rank)> = None;
            let mut tie = None;
            for of in many.iter().flatten().filter(|of| classes.between(2 * of.table, a, b)) {
                match holds {
                    Some((table, rank)) if rank == of.rank => tie = tie.or(Some([table, of.table])),
                    Some((_, rank)) if rank > of.rank => {}
                    _ => (holds, tie) = (Some((of.table, of.rank)), None),
                }
            }
            if let Some(tables) = tie.filter(|tables| !told.contains(tables))
                && let Some(blocks) = self.without_own_contact(classes, joined, apart, a, b)
            {
                told.push(tables);
                self.contested(many, tables, blocks.map(SupportingBody::Block));
            }
            holders[a * count + b] = holds.map(|(table, _)| table);
            holders[b * count + a] = holders[a * count + b];
        }
        let mut numbers: BTreeMap<usize, usize> = BTreeMap::new();
        let mut contacts = Vec::new();
        for of in many.iter().flatten().filter(|of| holders.contains(&Some(of.table))) {
            // An error in the law is reported with the listed pairs.
            let before = self.errors.len();
            let law = self.pair_law(&format!("contact.{}", of.name));
            self.errors.truncate(before);
            numbers.insert(of.table, contacts.len());
            contacts.push(CrowdContact { name: of.name.clone(), law: law? });
        }
        for holder in &mut holders {
            *holder = holder.and_then(|table| numbers.get(&table).copied());
        }
        let blocks = |key: &(usize, SupportingBody)| match key.1 {
            SupportingBody::Block(other) => Some((key.0, other)),
            SupportingBody::Ground | SupportingBody::Beam(_) => None,
        };
        Some(Crowd::new(classes.of.clone(), holders, contacts).without(apart.pairs.iter().filter_map(blocks)))
    }

    /// Two blocks of these classes that have no contact by full names and are not apart.
    fn without_own_contact(
        &self,
        classes: &Classes,
        joined: &Joined,
        apart: &Apart,
        a: usize,
        b: usize,
    ) -> Option<[usize; 2]> {
        let pairs = classes.blocks[a].iter().flat_map(|i| classes.blocks[b].iter().map(move |j| [*i, *j]));
        let mut pairs = pairs.filter(|[i, j]| i != j);
        pairs.find(|[i, j]| {
            let key = (*i.min(j), SupportingBody::Block(*i.max(j)));
            !joined.contains_key(&key) && !apart.pairs.contains(&key)
        })
    }

    /// Refuses a crowd with two blocks that can't yield to each other, and one on a beam with a
    /// static start, as the equilibrium is found with listed contacts.
    pub(super) fn check_crowd(
        &mut self,
        crowd: Option<&Crowd>,
        blocks: &[Option<BlockScene>],
        beams: &[Option<BeamScene>],
    ) {
        let Some(crowd) = crowd else { return };
        let is_prescribed = |block: &&(usize, &BlockScene)| block.1.motion.is_whole();
        let known: Vec<(usize, &BlockScene)> =
            blocks.iter().enumerate().filter_map(|(number, block)| Some((number, block.as_ref()?))).collect();
        let prescribed: Vec<&(usize, &BlockScene)> = known.iter().filter(is_prescribed).collect();
        let two = prescribed.iter().enumerate().flat_map(|(k, a)| prescribed[k + 1..].iter().map(move |b| (a, b)));
        let stuck = two.filter_map(|(a, b)| Some((a.1, b.1, crowd.contact_of(a.0, b.0)?))).next();
        if let Some((a, b, contact)) = stuck {
            let rule = format!("`{}` is fully prescribed, and `{}` can't yield to it", a.name, b.name);
            let remedy = "leave a direction or the angle free, or keep the two apart (world.apart)";
            self.error(&format!("contact.{}.between", crowd.contacts()[contact].name), rule, remedy);
        }
        let placement = |block: usize| Some(&blocks.get(block)?.as_ref()?.placement);
        for (number, beam) in beams.iter().enumerate() {
            let Some(beam) = beam.as_ref().filter(|beam| beam.static_start) else { continue };
            let carried = |block: &(usize, &BlockScene)| carried_by(blocks.len(), block.0, placement) == Some(number);
            if known.iter().any(|block| crowd.takes_part(block.0, None) && carried(block)) {
                let rule = format!(
                    "blocks on this beam have contacts of {} pairs of blocks by patterns; an equilibrium is found only with up to {MOST_LISTED}",
                    crowd.pair_count()
                );
                self.error(
                    &format!("beam.{}.start", beam.name),
                    rule,
                    "start undeformed, or name only blocks that can touch, such as each course of a wall and the next",
                );
            }
        }
    }
}
