//! Contacts: who touches whom.

use std::collections::{BTreeMap, BTreeSet};
use teeter_detect::Kinematics;
use teeter_integrator::{ImpactLaw, PairLaw};

use super::{Resolver, names};
use crate::dimension::Dimension;
use crate::measure::Measure;
use crate::scene::{ContactScene, Support};
use crate::words::{Frames, Law};

/// The contact that joins a block and a surface; one between two blocks joins each to the other.
pub(super) type Joined = BTreeMap<(usize, Support), usize>;

/// Pairs that patterns may stand for, in all.
const MOST_PAIRS: usize = 20_000;

impl Resolver<'_, '_> {
    /// All contacts, those by full names first, and which of them joins which two.
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

    /// Enters a contact; a pair joined twice is an error.
    fn join(&mut self, contact: &ContactScene, number: usize, others: &[Option<ContactScene>], joined: &mut Joined) {
        let first = *joined.entry((contact.block, contact.surface)).or_insert(number);
        if let Some(other) = contact.other_block() {
            joined.entry((other, Support::Block(contact.block))).or_insert(number);
        }
        if first != number
            && let Some(Some(first)) = others.get(first)
        {
            let rule = format!("the contact `{}` joins the same two bodies", first.name);
            self.error(&format!("contact.{}", contact.name), rule, "keep one of them");
        }
    }

    fn contact(&mut self, name: &str) -> Option<ContactScene> {
        let path = format!("contact.{name}");
        let at = |key: &str| format!("{path}.{key}");
        let between = self.doc.text_pair(&at("between")).map(|pair| pair.map(str::to_owned));
        let between = self.need(&at("between"), between);
        let law = self.pair_law(&path);
        let kinematics = self.kinematics(&path);
        let between = between?;
        let (block, surface) = self.sides(&at("between"), &between)?;
        self.no_frames_of_blocks(&path, surface, kinematics);
        Some(ContactScene { name: name.to_owned(), between, block, surface, law: law?, kinematics: kinematics? })
    }

    fn kinematics(&mut self, path: &str) -> Option<Kinematics> {
        Some(match self.choice(&format!("{path}.kinematics"))? {
            Frames::Deformed => Kinematics::Deformed,
            Frames::Linear => Kinematics::Linear,
        })
    }

    /// The default may stand there, since a scene that is written out names all that it stands for.
    fn no_frames_of_blocks(&mut self, path: &str, surface: Support, kinematics: Option<Kinematics>) {
        let key = format!("{path}.kinematics");
        if matches!(surface, Support::Block(_)) && kinematics != Some(Kinematics::Deformed) {
            let rule = "it says how a beam's deflection enters, but this contact is between two blocks";
            self.error(&key, rule, "leave it out");
        }
    }

    /// The contacts of all pairs that a pattern stands for, but those that are joined already.
    fn contacts_by_pattern(&mut self, name: &str, joined: &Joined, known: usize) -> Option<Vec<ContactScene>> {
        let path = format!("contact.{name}");
        let key = format!("{path}.between");
        let patterns = self.doc.text_pair(&key).map(|pair| pair.map(str::to_owned))?;
        let (law, kinematics) = (self.pair_law(&path), self.kinematics(&path));
        let sides = patterns.each_ref().map(|pattern| self.meant(&key, pattern));
        let [Some(first), Some(second)] = sides else { return None };
        let (law, kinematics) = (law?, kinematics?);
        let mut found: Vec<ContactScene> = Vec::new();
        let mut pairs: BTreeSet<(usize, Support)> = BTreeSet::new();
        for (a, b) in first.iter().flat_map(|a| second.iter().map(move |b| (a, b))) {
            let (block, surface) = match (a.1, b.1) {
                (Support::Block(a), surface) | (surface, Support::Block(a)) => (a, surface),
                _ => {
                    self.error(
                        &key,
                        "a contact joins two blocks, a block and a beam, or a block and the ground",
                        "name blocks",
                    );
                    return None;
                }
            };
            let again = matches!(surface, Support::Block(other) if other == block || pairs.contains(&(other, Support::Block(block))));
            if again || joined.contains_key(&(block, surface)) || !pairs.insert((block, surface)) {
                continue;
            }
            let between = [a.0.clone(), b.0.clone()];
            found.push(ContactScene { name: name.to_owned(), between, block, surface, law, kinematics });
            if known + found.len() > MOST_PAIRS {
                let rule = format!("the patterns stand for more than {MOST_PAIRS} pairs of bodies");
                self.error(&key, rule, "name only what can meet, such as each course of a wall and the next");
                return None;
            }
        }
        if let Some(contact) = found.first() {
            self.no_frames_of_blocks(&path, contact.surface, Some(kinematics));
        }
        Some(found)
    }

    /// The bodies that a name or a pattern stands for.
    fn meant(&mut self, key: &str, pattern: &str) -> Option<Vec<(String, Support)>> {
        if !pattern.contains('*') {
            let support = self.support(pattern);
            if support.is_none() {
                self.no_body(key, pattern);
            }
            return Some(vec![(pattern.to_owned(), support?)]);
        }
        let blocks = self.block_names.iter().enumerate();
        let meant = blocks.filter(|(_, block)| names::matches(pattern, &block.name));
        let meant: Vec<_> = meant.map(|(number, block)| (block.name.clone(), Support::Block(number))).collect();
        if meant.is_empty() {
            let remedy = self.known_bodies();
            self.error(key, format!("no block's name is like `{pattern}`"), remedy);
            return None;
        }
        Some(meant)
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
            self.error(&format!("{path}.damping"), "the damping c of kelvin-voigt is in N s/m", "such as \"10 N s/m\"");
            return None;
        }
        Some(ImpactLaw::KelvinVoigt { stiffness: stiffness.value, damping: damping.value })
    }

    /// F = k dⁿ (1 + D v): the unit of the damping tells whether it is D or c = k D.
    fn hunt_crossley(&mut self, path: &str) -> Option<ImpactLaw> {
        let (stiffness, damping) = (self.measure(path, "stiffness"), self.measure(path, "damping"));
        let exponent = self.number(&format!("{path}.exponent"));
        let (stiffness, damping, exponent) = (stiffness?, damping?, exponent?);
        let wrong = |measure: &Measure, power: f64| measure.power.is_some_and(|given| (given - power).abs() > 1e-12);
        if wrong(&stiffness, exponent) {
            let rule = format!("with the exponent {exponent} the stiffness is in N/m^{exponent}");
            self.error(&format!("{path}.stiffness"), rule, "the power in its unit is the exponent of the force");
            return None;
        }
        if wrong(&damping, exponent + 1.0) {
            let rule = format!("with the exponent {exponent} the damping c is in N s/m^{}", exponent + 1.0);
            self.error(&format!("{path}.damping"), rule, "or give D = c/k in s/m");
            return None;
        }
        let k = stiffness.value;
        let damping = if damping.dimension == Dimension::INVERSE_VELOCITY { damping.value } else { damping.value / k };
        Some(ImpactLaw::HuntCrossley { stiffness: k, damping, exponent })
    }

    fn measure(&mut self, path: &str, key: &str) -> Option<Measure> {
        let path = format!("{path}.{key}");
        let value = self.doc.measure(&path);
        self.need(&path, value)
    }

    fn sides(&mut self, path: &str, between: &[String; 2]) -> Option<(usize, Support)> {
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
            return Some((*first, Support::Block(*second)));
        }
        let sides = [(a, b), (b, a)];
        let found = sides
            .iter()
            .find_map(|(block, surface)| Some((self.blocks.get(block.as_str()).copied()?, self.surface(surface)?)));
        if found.is_none() {
            let rule = "a contact joins two blocks, a block and a beam, or a block and the ground";
            self.error(path, rule, "name a block, and another one, a beam or the ground");
        }
        found
    }
}
