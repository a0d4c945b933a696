//! Resolves contacts: pairs of bodies and their laws.

use std::collections::{BTreeMap, BTreeSet};
use teeter_detect::Kinematics;
use teeter_integrator::{ImpactLaw, PairLaw};

use super::{Resolver, names};
use crate::dimension::Dimension;
use crate::measure::Measure;
use crate::scene::{ContactScene, SupportingBody};
use crate::words::{ContactFrames, Law};

/// The contact between a block and a body; a contact between two blocks is entered for both.
pub(super) type Joined = BTreeMap<(usize, SupportingBody), usize>;

/// Most pairs that patterns may stand for in total.
const MOST_PAIRS: usize = 20_000;

impl Resolver<'_, '_> {
    /// All contacts, those with full names first, and the pairs that they join.
    pub(super) fn contacts(&mut self) -> (Vec<Option<ContactScene>>, Joined) {
        let (mut contacts, mut joined) = (Vec::new(), Joined::new());
        let names = self.doc.names("contact");
        let by_pattern = |name: &&str| {
            let between = self.doc.text_pair(&format!("contact.{name}.between"));
            between.is_some_and(|between| between.iter().any(|side| side.contains('*')))
        };
        let (patterns, plain): (Vec<&str>, Vec<&str>) = names.into_iter().partition(by_pattern);
        for name in plain {
            let contact = self.contact(name);
            if let Some(contact) = &contact {
                self.join(contact, contacts.len(), &contacts, &mut joined);
            }
            contacts.push(contact);
        }
        for name in patterns {
            match self.contacts_by_pattern(name, &joined, contacts.len()) {
                Some(found) => {
                    for contact in found {
                        self.join(&contact, contacts.len(), &contacts, &mut joined);
                        contacts.push(Some(contact));
                    }
                }
                None => contacts.push(None),
            }
        }
        (contacts, joined)
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
        Some(ContactScene { name: name.to_owned(), between, block, surface, law: law?, kinematics: kinematics? })
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

    /// The contacts of all pairs that match a pattern, except those that already have one.
    fn contacts_by_pattern(&mut self, name: &str, joined: &Joined, known: usize) -> Option<Vec<ContactScene>> {
        let path = format!("contact.{name}");
        let key = format!("{path}.between");
        let patterns = self.doc.text_pair(&key).map(|pair| pair.map(str::to_owned))?;
        let (law, kinematics) = (self.pair_law(&path), self.kinematics(&path));
        let sides = patterns.each_ref().map(|pattern| self.bodies_matching(&key, pattern));
        let [Some(first), Some(second)] = sides else { return None };
        let (law, kinematics) = (law?, kinematics?);
        let mut found: Vec<ContactScene> = Vec::new();
        let mut pairs: BTreeSet<(usize, SupportingBody)> = BTreeSet::new();
        for (a, b) in first.iter().flat_map(|a| second.iter().map(move |b| (a, b))) {
            let (block, surface) = match (a.1, b.1) {
                (SupportingBody::Block(a), surface) | (surface, SupportingBody::Block(a)) => (a, surface),
                _ => {
                    self.error(
                        &key,
                        "a contact is between two blocks, a block and a beam, or a block and the ground",
                        "name blocks",
                    );
                    return None;
                }
            };
            let again = matches!(surface, SupportingBody::Block(other) if other == block || pairs.contains(&(other, SupportingBody::Block(block))));
            if again || joined.contains_key(&(block, surface)) || !pairs.insert((block, surface)) {
                continue;
            }
            let between = [a.0.clone(), b.0.clone()];
            found.push(ContactScene { name: name.to_owned(), between, block, surface, law, kinematics });
            if known + found.len() > MOST_PAIRS {
                let rule = format!("the patterns match more than {MOST_PAIRS} pairs of bodies");
                self.error(&key, rule, "name only bodies that can touch, such as each course of a wall and the next");
                return None;
            }
        }
        if let Some(contact) = found.first() {
            self.no_frames_of_blocks(&path, contact.surface, Some(kinematics));
        }
        Some(found)
    }

    /// The bodies that match a name or a pattern.
    fn bodies_matching(&mut self, key: &str, pattern: &str) -> Option<Vec<(String, SupportingBody)>> {
        if !pattern.contains('*') {
            let support = self.support(pattern);
            if support.is_none() {
                self.no_body(key, pattern);
            }
            return Some(vec![(pattern.to_owned(), support?)]);
        }
        let blocks = self.block_names.iter().enumerate();
        let bodies_matching = blocks.filter(|(_, block)| names::matches(pattern, &block.name));
        let bodies_matching: Vec<_> =
            bodies_matching.map(|(number, block)| (block.name.clone(), SupportingBody::Block(number))).collect();
        if bodies_matching.is_empty() {
            let remedy = self.known_bodies();
            self.error(key, format!("no block matches `{pattern}`"), remedy);
            return None;
        }
        Some(bodies_matching)
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
