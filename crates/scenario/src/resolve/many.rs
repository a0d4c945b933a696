//! Contacts of many pairs: by patterns or materials, and what is said to be apart.

use std::collections::{BTreeMap, BTreeSet};
use teeter_integrator::BeamFace;

use super::Resolver;
use super::contacts::{Joined, PairKey, is_pattern, key_of, touching};
use super::crowd::Classes;
use crate::scene::{ContactScene, SupportingBody};

/// Most pairs that may be listed in total.
const MOST_PAIRS: usize = 20_000;

/// A contact of many pairs: which bodies each side stands for.
pub(super) struct Many {
    /// Its number among the tables of contacts that have no full names.
    pub(super) table: usize,
    pub(super) name: String,
    pub(super) sides: [Side; 2],
    pub(super) rank: Rank,
}

/// One side of a contact of many pairs.
pub(super) struct Side {
    pub(super) bodies: Vec<(String, SupportingBody)>,
}

/// How closely a contact names its bodies; of two that stand for a pair the higher one holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Rank {
    /// All bodies: `["*", "*"]`.
    All,
    /// By materials.
    Materials,
    /// By patterns with this many letters.
    Letters(usize),
}

impl Many {
    /// The pairs of bodies that are to be listed, by their places in both sides: all of them, or in
    /// a crowd those with surfaces, and blocks that stand on each other.
    fn pairs(&self, crowded: Option<&Classes>) -> Box<dyn Iterator<Item = [usize; 2]> + '_> {
        let [first, second] = self.sides.each_ref().map(|side| &side.bodies);
        let all = |i: usize| (0..second.len()).map(move |j| [i, j]);
        let Some(classes) = crowded else { return Box::new((0..first.len()).flat_map(all)) };
        let is_block = |body: &(String, SupportingBody)| matches!(body.1, SupportingBody::Block(_));
        let surfaces: Vec<usize> = (0..second.len()).filter(|j| !is_block(&second[*j])).collect();
        let with_surfaces = move |i: usize| match is_block(&first[i]) {
            true => surfaces.iter().map(|j| [i, *j]).collect(),
            false => all(i).collect::<Vec<_>>(),
        };
        let places = |bodies: &[(String, SupportingBody)]| -> BTreeMap<SupportingBody, usize> {
            bodies.iter().enumerate().map(|(place, (_, body))| (*body, place)).collect()
        };
        let (among_first, among_second) = (places(first), places(second));
        // The one that comes first in the file is the first of the two, as in pairs that are listed.
        let between = |a, b| {
            let [a, b] = [a, b].map(SupportingBody::Block);
            Some([*among_first.get(&a)?, *among_second.get(&b)?])
        };
        let standing = classes.standing.iter().filter_map(|&[upper, lower]| {
            let (first, second) = (upper.min(lower), upper.max(lower));
            between(first, second).or_else(|| between(second, first))
        });
        let standing: Vec<[usize; 2]> = standing.collect();
        Box::new((0..first.len()).flat_map(with_surfaces).chain(standing))
    }

    /// The pairs that are to be listed and can touch, the block first.
    fn touching<'a>(
        &'a self,
        crowded: Option<&Classes>,
    ) -> impl Iterator<Item = ((usize, SupportingBody), [&'a (String, SupportingBody); 2])> + use<'a> {
        let [first, second] = self.sides.each_ref().map(|side| &side.bodies);
        self.pairs(crowded).filter_map(move |[i, j]| {
            let (a, b) = (&first[i], &second[j]);
            Some((touching(a.1, b.1)?, [a, b]))
        })
    }
}

/// The pairs that don't touch, whatever contacts say.
#[derive(Default)]
pub(super) struct Apart {
    /// Those by full names.
    pub(super) pairs: BTreeSet<PairKey>,
    /// Those of which a side is a pattern: the bodies that each side stands for.
    pub(super) sides: Vec<[BTreeSet<SupportingBody>; 2]>,
}

impl Apart {
    pub(super) fn contains(&self, key: PairKey) -> bool {
        let (a, b) = (SupportingBody::Block(key.0), key.1);
        let between = |[first, second]: &[BTreeSet<SupportingBody>; 2]| {
            (first.contains(&a) && second.contains(&b)) || (first.contains(&b) && second.contains(&a))
        };
        self.pairs.contains(&key) || self.sides.iter().any(between)
    }
}

impl Resolver<'_, '_> {
    /// The pairs that don't touch, whatever contacts say.
    pub(super) fn apart(&mut self) -> Apart {
        let pairs: Vec<[String; 2]> = self.doc.text_pairs("world.apart").map(<[_]>::to_vec).unwrap_or_default();
        let mut apart = Apart::default();
        for pair in pairs {
            let sides = pair.each_ref().map(|side| self.bodies_matching("world.apart", side));
            let [Some(first), Some(second)] = sides else { continue };
            if let ([one], [other]) = (first.as_slice(), second.as_slice()) {
                apart.pairs.extend(touching(one.1, other.1).map(|(block, surface)| key_of(block, surface)));
                continue;
            }
            let bodies = |side: Vec<(String, SupportingBody)>| side.into_iter().map(|(_, body)| body).collect();
            apart.sides.push([bodies(first), bodies(second)]);
        }
        apart
    }

    /// A contact by patterns or materials.
    pub(super) fn contact_of_many(&mut self, table: usize, name: &str) -> Option<Many> {
        let path = format!("contact.{name}");
        let key = format!("{path}.between");
        let of_materials = format!("{path}.materials");
        if let Some(materials) = self.doc.text_pair(&of_materials).map(|pair| pair.map(str::to_owned)) {
            if self.doc.is_given(&key) {
                self.error(&of_materials, "between already names the bodies", "keep one of them");
                return None;
            }
            let sides = materials.each_ref().map(|material| self.bodies_of(&of_materials, material));
            let [Some(first), Some(second)] = sides else { return None };
            let sides = [first, second].map(|bodies| Side { bodies });
            return Some(Many { table, name: name.to_owned(), sides, rank: Rank::Materials });
        }
        let patterns = self.doc.text_pair(&key).map(|pair| pair.map(str::to_owned))?;
        let sides = patterns.each_ref().map(|pattern| self.bodies_matching(&key, pattern));
        let [Some(first), Some(second)] = sides else { return None };
        let any = first.iter().any(|a| second.iter().any(|b| touching(a.1, b.1).is_some()));
        let blocks = |side: &[(String, SupportingBody)]| side.iter().any(|of| matches!(of.1, SupportingBody::Block(_)));
        if !(any || blocks(&first) || blocks(&second)) {
            self.error(
                &key,
                "a contact is between two blocks, a block and a beam, or a block and the ground",
                "name blocks",
            );
            return None;
        }
        let letters: usize =
            patterns.iter().map(|pattern| pattern.chars().filter(|c| !is_pattern(&c.to_string())).count()).sum();
        let rank = if letters == 0 { Rank::All } else { Rank::Letters(letters) };
        let sides = [first, second].map(|bodies| Side { bodies });
        Some(Many { table, name: name.to_owned(), sides, rank })
    }

    /// The contact of many, by its table, that holds for each pair that is to be listed; two of one
    /// rank are an error, and so are more than [`MOST_PAIRS`] together with the `known` contacts.
    pub(super) fn holders(
        &mut self,
        many: &[Option<Many>],
        joined: &Joined,
        apart: &Apart,
        crowded: Option<&Classes>,
        known: usize,
    ) -> Option<BTreeMap<PairKey, (usize, Rank)>> {
        let still: Vec<bool> =
            (0..self.block_names.len()).map(|block| self.is_fixed(SupportingBody::Block(block))).collect();
        let is_still = |body: SupportingBody| match body {
            SupportingBody::Block(block) => still[block],
            SupportingBody::Ground => true,
            SupportingBody::Beam(_) => false,
        };
        // In a crowd those are listed that grow with the blocks only.
        let most = if crowded.is_some() { MOST_PAIRS.max(2 * self.block_names.len()) } else { MOST_PAIRS };
        let mut holders: BTreeMap<PairKey, (usize, Rank)> = BTreeMap::new();
        let mut ties: BTreeMap<PairKey, usize> = BTreeMap::new();
        for of in many.iter().flatten() {
            let pairs = of.touching(crowded).map(|(pair, _)| pair);
            for (block, surface) in pairs.filter(|pair| !joined.contains_key(pair)) {
                let key = key_of(block, surface);
                if apart.contains(key) || (still[block] && is_still(surface)) {
                    continue;
                }
                match holders.get(&key).copied() {
                    Some((table, rank)) if rank == of.rank && table != of.table => {
                        ties.entry(key).or_insert(of.table);
                    }
                    Some((_, rank)) if rank >= of.rank => {}
                    _ => {
                        holders.insert(key, (of.table, of.rank));
                        ties.remove(&key);
                    }
                }
                if known + holders.len() > most {
                    let rule = format!("the patterns match more than {most} pairs of bodies");
                    let remedy = "name only bodies that can touch, such as each course of a wall and the next";
                    let key = if of.rank == Rank::Materials { "materials" } else { "between" };
                    self.error(&format!("contact.{}.{key}", of.name), rule, remedy);
                    return None;
                }
            }
        }
        let mut told: BTreeSet<[usize; 2]> = BTreeSet::new();
        for ((block, surface), second) in ties {
            let Some((first, _)) = holders.get(&(block, surface)) else { continue };
            if told.insert([*first, second]) {
                self.contested(many, [*first, second], [SupportingBody::Block(block), surface]);
            }
        }
        Some(holders)
    }

    /// Reports two contacts of many, by their tables, of which none is closer for these two bodies.
    pub(super) fn contested(&mut self, many: &[Option<Many>], tables: [usize; 2], bodies: [SupportingBody; 2]) {
        let name = |table: usize| {
            let of = many.iter().flatten().find(|of| of.table == table);
            of.map_or("", |of| of.name.as_str())
        };
        let [a, b] = bodies.map(|body| self.body_name(body));
        let rule =
            format!("it says no more of the bodies than `{}`, and both hold for `{a}` and `{b}`", name(tables[0]));
        let remedy = "name the bodies of one of them more closely, or this pair by full names";
        self.error(&format!("contact.{}", name(tables[1])), rule, remedy);
    }

    /// The contacts of all pairs for which a contact of many holds, as far as they are to be
    /// listed.
    pub(super) fn pairs_of_many(
        &mut self,
        of: &Many,
        holders: &BTreeMap<PairKey, (usize, Rank)>,
        crowded: Option<&Classes>,
    ) -> Option<Vec<ContactScene>> {
        let path = format!("contact.{}", of.name);
        let (law, kinematics) = (self.pair_law(&path)?, self.kinematics(&path)?);
        let feet_friction = self.feet_friction(&path);
        let mut found: Vec<ContactScene> = Vec::new();
        let mut entered: BTreeSet<PairKey> = BTreeSet::new();
        for ((block, surface), [a, b]) in of.touching(crowded) {
            let key = key_of(block, surface);
            let holds = holders.get(&key).is_some_and(|(table, _)| *table == of.table);
            if !holds || !entered.insert(key) {
                continue;
            }
            let (block, surface, between) = match surface {
                // The block is the one that moves.
                SupportingBody::Block(other) if self.is_fixed(a.1) => {
                    (other, SupportingBody::Block(block), [b.0.clone(), a.0.clone()])
                }
                _ => (block, surface, [a.0.clone(), b.0.clone()]),
            };
            let (face, sides) = (BeamFace::Upper, self.has_sides(&path, surface, kinematics));
            let name = of.name.clone();
            found.push(ContactScene { name, between, block, surface, law, feet_friction, kinematics, face, sides });
        }
        self.only_at_beams(&path, found.iter().map(|contact| contact.surface));
        let other = found.iter().any(|contact| contact.other_block().is_some()) || crowded.is_some();
        self.feet_stand_on_surfaces(&path, feet_friction, other);
        let between_blocks = found.iter().all(|contact| contact.other_block().is_some());
        let first = found.first().map(|contact| contact.surface);
        // Without any that are listed it is one of a crowd, or of nothing.
        let first = first.or(crowded.map(|_| SupportingBody::Block(0)));
        if let Some(surface) = first.filter(|_| between_blocks) {
            self.no_frames_of_blocks(&path, surface, Some(kinematics));
        }
        Some(found)
    }
}
