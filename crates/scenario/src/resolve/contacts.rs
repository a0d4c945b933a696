//! Resolves contacts: pairs of bodies and their laws.

use std::collections::{BTreeMap, BTreeSet};
use teeter_detect::Kinematics;
use teeter_integrator::{BeamFace, ImpactLaw, PairLaw};

use super::{Resolver, names};
use crate::dimension::Dimension;
use crate::measure::Measure;
use crate::scene::{ContactScene, SupportingBody};
use crate::words::{ContactFrames, Law};

/// The contact between a block and a body; a contact between two blocks is entered for both.
pub(super) type Joined = BTreeMap<(usize, SupportingBody), usize>;

/// Most pairs that patterns may stand for in total.
const MOST_PAIRS: usize = 20_000;

/// The block and what it touches, of two bodies that can touch each other; the first block comes
/// first.
fn touching(a: SupportingBody, b: SupportingBody) -> Option<(usize, SupportingBody)> {
    match (a, b) {
        (SupportingBody::Block(a), SupportingBody::Block(b)) if a == b => None,
        (SupportingBody::Block(a), surface) | (surface, SupportingBody::Block(a)) => Some((a, surface)),
        _ => None,
    }
}

/// A contact of many pairs: which bodies each side stands for.
struct Many {
    /// Its number among the tables of contacts that have no full names.
    table: usize,
    name: String,
    sides: [Side; 2],
    rank: Rank,
}

/// One side of a contact of many pairs.
struct Side {
    bodies: Vec<(String, SupportingBody)>,
}

/// How closely a contact names its bodies; of two that stand for a pair the higher one holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Rank {
    /// All bodies: `["*", "*"]`.
    All,
    /// By materials.
    Materials,
    /// By patterns with this many letters.
    Letters(usize),
}

/// A pair of bodies, whichever comes first.
type PairKey = (usize, SupportingBody);

fn key_of(block: usize, surface: SupportingBody) -> PairKey {
    match surface {
        SupportingBody::Block(other) if other < block => (other, SupportingBody::Block(block)),
        _ => (block, surface),
    }
}

fn is_pattern(name: &str) -> bool {
    name.contains(['*', '?'])
}

impl Resolver<'_, '_> {
    /// All contacts, those with full names first, and the pairs that they join.
    pub(super) fn contacts(&mut self) -> (Vec<Option<ContactScene>>, Joined) {
        let (mut contacts, mut joined) = (Vec::new(), Joined::new());
        let names = self.doc.names("contact");
        let of_many = |name: &&str| {
            let between = self.doc.text_pair(&format!("contact.{name}.between"));
            between.is_some_and(|between| between.iter().any(|side| is_pattern(side)))
                || self.doc.is_given(&format!("contact.{name}.materials"))
        };
        let (many, plain): (Vec<&str>, Vec<&str>) = names.into_iter().partition(of_many);
        for name in plain {
            let contact = self.contact(name);
            if let Some(contact) = &contact {
                self.join(contact, contacts.len(), &contacts, &mut joined);
            }
            contacts.push(contact);
        }
        let apart = self.apart();
        let many: Vec<Option<Many>> =
            many.iter().enumerate().map(|(table, name)| self.contact_of_many(table, name)).collect();
        let Some(holders) = self.holders(&many, &joined, &apart, contacts.len()) else {
            contacts.push(None);
            return (contacts, joined);
        };
        for of in many {
            let Some(of) = of else {
                contacts.push(None);
                continue;
            };
            match self.pairs_of_many(&of, &holders) {
                Some(found) => {
                    for contact in found {
                        self.join(&contact, contacts.len(), &contacts, &mut joined);
                        contacts.push(Some(contact));
                    }
                }
                None => contacts.push(None),
            }
        }
        // Also those with full names, which would otherwise contradict what is said to be apart.
        let together: Vec<(String, [String; 2])> = contacts
            .iter()
            .flatten()
            .filter(|contact| apart.contains(&key_of(contact.block, contact.surface)))
            .map(|contact| (contact.name.clone(), contact.between.clone()))
            .collect();
        for (name, [a, b]) in together {
            let rule = format!("`{a}` and `{b}` don't touch, according to world.apart");
            self.error(&format!("contact.{name}.between"), rule, "leave out this contact, or the pair in apart");
        }
        (contacts, joined)
    }

    /// The pairs that don't touch, whatever contacts say.
    fn apart(&mut self) -> BTreeSet<PairKey> {
        let pairs: Vec<[String; 2]> = self.doc.text_pairs("world.apart").map(<[_]>::to_vec).unwrap_or_default();
        let mut apart = BTreeSet::new();
        for pair in pairs {
            let sides = pair.each_ref().map(|side| self.bodies_matching("world.apart", side));
            let [Some(first), Some(second)] = sides else { continue };
            for (block, surface) in first.iter().flat_map(|a| second.iter().filter_map(|b| touching(a.1, b.1))) {
                apart.insert(key_of(block, surface));
            }
        }
        apart
    }

    /// A contact by patterns or materials.
    fn contact_of_many(&mut self, table: usize, name: &str) -> Option<Many> {
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

    /// The contact of many, by its table, that holds for each pair that can touch; two of one rank
    /// are an error, and so are more than [`MOST_PAIRS`] together with the `known` contacts.
    fn holders(
        &mut self,
        many: &[Option<Many>],
        joined: &Joined,
        apart: &BTreeSet<PairKey>,
        known: usize,
    ) -> Option<BTreeMap<PairKey, (usize, Rank)>> {
        let still: Vec<bool> =
            (0..self.block_names.len()).map(|block| self.is_fixed(SupportingBody::Block(block))).collect();
        let is_still = |body: SupportingBody| match body {
            SupportingBody::Block(block) => still[block],
            SupportingBody::Ground => true,
            SupportingBody::Beam(_) => false,
        };
        let mut holders: BTreeMap<PairKey, (usize, Rank)> = BTreeMap::new();
        let mut contested: BTreeSet<[usize; 2]> = BTreeSet::new();
        for of in many.iter().flatten() {
            let [first, second] = &of.sides;
            let pairs = first.bodies.iter().flat_map(|a| second.bodies.iter().filter_map(|b| touching(a.1, b.1)));
            for (block, surface) in pairs.filter(|pair| !joined.contains_key(pair)) {
                let key = key_of(block, surface);
                if apart.contains(&key) || (still[block] && is_still(surface)) {
                    continue;
                }
                match holders.get(&key).copied() {
                    Some((table, rank)) if rank == of.rank && table != of.table => {
                        if contested.insert([table, of.table]) {
                            let other = many.iter().flatten().find(|other| other.table == table);
                            let name = other.map_or("", |other| other.name.as_str());
                            let [a, b] = [SupportingBody::Block(block), surface].map(|body| self.body_name(body));
                            let rule = format!(
                                "it says no more of the bodies than `{name}`, and both hold for `{a}` and `{b}`"
                            );
                            let remedy = "name the bodies of one of them more closely, or this pair by full names";
                            self.error(&format!("contact.{}", of.name), rule, remedy);
                        }
                    }
                    Some((_, rank)) if rank >= of.rank => {}
                    _ => {
                        holders.insert(key, (of.table, of.rank));
                    }
                }
                if known + holders.len() > MOST_PAIRS {
                    let rule = format!("the patterns match more than {MOST_PAIRS} pairs of bodies");
                    let remedy = "name only bodies that can touch, such as each course of a wall and the next";
                    let key = if of.rank == Rank::Materials { "materials" } else { "between" };
                    self.error(&format!("contact.{}.{key}", of.name), rule, remedy);
                    return None;
                }
            }
        }
        Some(holders)
    }

    /// The name of a body.
    fn body_name(&self, body: SupportingBody) -> String {
        match body {
            SupportingBody::Ground => "ground".to_owned(),
            SupportingBody::Beam(beam) => {
                self.doc.names("beam").get(beam).map_or_else(String::new, |name| (*name).to_owned())
            }
            SupportingBody::Block(block) => self.block_names[block].name.clone(),
        }
    }

    /// Whether a body never moves: two of them have no contact by a pattern.
    fn is_fixed(&self, body: SupportingBody) -> bool {
        match body {
            SupportingBody::Ground => true,
            SupportingBody::Beam(_) => false,
            SupportingBody::Block(block) => {
                self.doc.flag(&format!("block.{}.fixed", self.block_names[block].table)) == Some(true)
            }
        }
    }

    /// Enters a contact; two contacts of one pair are an error.
    fn join(&mut self, contact: &ContactScene, number: usize, others: &[Option<ContactScene>], joined: &mut Joined) {
        let first = *joined.entry((contact.block, contact.surface)).or_insert(number);
        if let Some(other) = contact.other_block() {
            joined.entry((other, SupportingBody::Block(contact.block))).or_insert(number);
        }
        if first != number
            && let Some(Some(first)) = others.get(first)
        {
            let rule = format!("the contact `{}` is between the same two bodies", first.name);
            self.error(&format!("contact.{}", contact.name), rule, "keep one of them");
        }
    }

    fn contact(&mut self, name: &str) -> Option<ContactScene> {
        let path = format!("contact.{name}");
        let at = |key: &str| format!("{path}.{key}");
        let between = self.doc.text_pair(&at("between")).map(|pair| pair.map(str::to_owned));
        let between = self.required(&at("between"), between);
        let law = self.pair_law(&path);
        let kinematics = self.kinematics(&path);
        let between = between?;
        let (block, surface) = self.sides(&at("between"), &between)?;
        self.no_frames_of_blocks(&path, surface, kinematics);
        self.only_at_beams(&path, [surface]);
        let kinematics = kinematics?;
        let (face, sides) = (BeamFace::Upper, self.has_sides(&path, surface, kinematics));
        Some(ContactScene { name: name.to_owned(), between, block, surface, law: law?, kinematics, face, sides })
    }

    fn kinematics(&mut self, path: &str) -> Option<Kinematics> {
        Some(match self.choice(&format!("{path}.kinematics"))? {
            ContactFrames::Deformed => Kinematics::Deformed,
            ContactFrames::Linear => Kinematics::Linear,
        })
    }

    /// The default is allowed, since a written scene contains all defaults.
    fn no_frames_of_blocks(&mut self, path: &str, surface: SupportingBody, kinematics: Option<Kinematics>) {
        let key = format!("{path}.kinematics");
        if matches!(surface, SupportingBody::Block(_)) && kinematics != Some(Kinematics::Deformed) {
            let rule = "it applies to the deflection of beams, but this contact is between two blocks";
            self.error(&key, rule, "leave it out");
        }
    }

    /// The contacts of all pairs for which a contact of many holds.
    fn pairs_of_many(&mut self, of: &Many, holders: &BTreeMap<PairKey, (usize, Rank)>) -> Option<Vec<ContactScene>> {
        let path = format!("contact.{}", of.name);
        let (law, kinematics) = (self.pair_law(&path)?, self.kinematics(&path)?);
        let mut found: Vec<ContactScene> = Vec::new();
        let mut entered: BTreeSet<PairKey> = BTreeSet::new();
        let [first, second] = &of.sides;
        for (a, b) in first.bodies.iter().flat_map(|a| second.bodies.iter().map(move |b| (a, b))) {
            let Some((block, surface)) = touching(a.1, b.1) else { continue };
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
            found.push(ContactScene { name: of.name.clone(), between, block, surface, law, kinematics, face, sides });
        }
        self.only_at_beams(&path, found.iter().map(|contact| contact.surface));
        let between_blocks = found.iter().all(|contact| contact.other_block().is_some());
        if let Some(contact) = found.first().filter(|_| between_blocks) {
            self.no_frames_of_blocks(&path, contact.surface, Some(kinematics));
        }
        Some(found)
    }

    /// The bodies that match a name or a pattern; a pattern matches the ground and beams, too.
    fn bodies_matching(&mut self, key: &str, pattern: &str) -> Option<Vec<(String, SupportingBody)>> {
        if !is_pattern(pattern) {
            let support = self.support(pattern);
            if support.is_none() {
                self.no_body(key, pattern);
            }
            return Some(vec![(pattern.to_owned(), support?)]);
        }
        let mut found = self.bodies();
        found.retain(|(name, _)| names::matches(pattern, name));
        if found.is_empty() {
            let remedy = self.known_bodies();
            self.error(key, format!("no body matches `{pattern}`"), remedy);
            return None;
        }
        Some(found)
    }

    /// All bodies: blocks, beams, the ground.
    fn bodies(&self) -> Vec<(String, SupportingBody)> {
        let blocks = self.block_names.iter().enumerate();
        let blocks = blocks.map(|(number, block)| (block.name.clone(), SupportingBody::Block(number)));
        let beams = self.doc.names("beam").into_iter().enumerate();
        let beams = beams.map(|(number, name)| (name.to_owned(), SupportingBody::Beam(number)));
        let ground = self.doc.has_table("ground").then(|| ("ground".to_owned(), SupportingBody::Ground));
        blocks.chain(beams).chain(ground).collect()
    }

    /// The blocks and beams of a material.
    fn bodies_of(&mut self, key: &str, material: &str) -> Option<Vec<(String, SupportingBody)>> {
        self.material_named(key, material)?;
        let made_of = |table: String| self.doc.text(&format!("{table}.material")) == Some(material);
        let found: Vec<_> = self
            .bodies()
            .into_iter()
            .filter(|(name, body)| match body {
                SupportingBody::Block(block) => made_of(format!("block.{}", self.block_names[*block].table)),
                SupportingBody::Beam(_) => made_of(format!("beam.{name}")),
                SupportingBody::Ground => false,
            })
            .collect();
        if found.is_empty() {
            self.error(key, format!("no block or beam is of `{material}`"), "name a material that is used");
            return None;
        }
        Some(found)
    }

    fn pair_law(&mut self, path: &str) -> Option<PairLaw> {
        let at = |key: &str| format!("{path}.{key}");
        let friction = self.number(&at("friction"));
        let instant = |resolver: &mut Self, impact: ImpactLaw| {
            let e = resolver.number(&at("restitution"));
            let tangential = resolver.number(&at("tangential_restitution"));
            Some(PairLaw::new(friction?, e?).with_impact(impact).with_tangential_restitution(tangential?))
        };
        let impact = match self.choice(&at("law"))? {
            Law::Newton => return instant(self, ImpactLaw::Newton),
            Law::Poisson => return instant(self, ImpactLaw::Poisson),
            Law::Energetic => return instant(self, ImpactLaw::Energetic),
            Law::KelvinVoigt => self.kelvin_voigt(path)?,
            Law::HuntCrossley => self.hunt_crossley(path)?,
        };
        Some(PairLaw::new(friction?, 0.0).with_impact(impact))
    }

    fn kelvin_voigt(&mut self, path: &str) -> Option<ImpactLaw> {
        let (stiffness, damping) = (self.measure(path, "stiffness"), self.measure(path, "damping"));
        let (stiffness, damping) = (stiffness?, damping?);
        if stiffness.power.is_some_and(|power| power != 1.0) {
            self.error(
                &format!("{path}.stiffness"),
                "the force of kelvin-voigt is linear: k is in N/m",
                "such as \"1e6 N/m\"",
            );
            return None;
        }
        if damping.dimension == Dimension::INVERSE_VELOCITY || damping.power.is_some_and(|power| power != 1.0) {
            self.error(
                &format!("{path}.damping"),
                "the damping c of kelvin-voigt is in N s/m",
                "write it as in \"10 N s/m\"",
            );
            return None;
        }
        Some(ImpactLaw::KelvinVoigt { stiffness: stiffness.value, damping: damping.value })
    }

    /// F = k dⁿ (1 + D v): the unit of the damping determines whether it is D or c = k D.
    fn hunt_crossley(&mut self, path: &str) -> Option<ImpactLaw> {
        let (stiffness, damping) = (self.measure(path, "stiffness"), self.measure(path, "damping"));
        let exponent = self.number(&format!("{path}.exponent"));
        let (stiffness, damping, exponent) = (stiffness?, damping?, exponent?);
        let wrong = |measure: &Measure, power: f64| measure.power.is_some_and(|given| (given - power).abs() > 1e-12);
        if wrong(&stiffness, exponent) {
            let rule = format!("with the exponent {exponent} the stiffness is in N/m^{exponent}");
            self.error(&format!("{path}.stiffness"), rule, "the power in its unit must be the exponent of the force");
            return None;
        }
        if wrong(&damping, exponent + 1.0) {
            let rule = format!("with the exponent {exponent} the damping c is in N s/m^{}", exponent + 1.0);
            self.error(&format!("{path}.damping"), rule, "correct the unit, or give D = c/k in s/m");
            return None;
        }
        let k = stiffness.value;
        let damping = if damping.dimension == Dimension::INVERSE_VELOCITY { damping.value } else { damping.value / k };
        Some(ImpactLaw::HuntCrossley { stiffness: k, damping, exponent })
    }

    fn measure(&mut self, path: &str, key: &str) -> Option<Measure> {
        let path = format!("{path}.{key}");
        let value = self.doc.measure(&path);
        self.required(&path, value)
    }

    fn sides(&mut self, path: &str, between: &[String; 2]) -> Option<(usize, SupportingBody)> {
        let [a, b] = between;
        if a == b {
            self.error(path, format!("`{a}` can't touch itself"), self.known_bodies());
            return None;
        }
        let is_body =
            |resolver: &Self, name: &str| resolver.blocks.contains_key(name) || resolver.surface(name).is_some();
        let mut missing = false;
        for name in between {
            if !is_body(self, name) {
                self.no_body(path, name);
                missing = true;
            }
        }
        if missing {
            return None;
        }
        if let (Some(first), Some(second)) = (self.blocks.get(a.as_str()), self.blocks.get(b.as_str())) {
            return Some((*first, SupportingBody::Block(*second)));
        }
        let sides = [(a, b), (b, a)];
        let found = sides
            .iter()
            .find_map(|(block, surface)| Some((self.blocks.get(block.as_str()).copied()?, self.surface(surface)?)));
        if found.is_none() {
            let rule = "a contact is between two blocks, a block and a beam, or a block and the ground";
            self.error(path, rule, "name a block and another block, a beam or the ground");
        }
        found
    }
}
