//! Resolves contacts: pairs of bodies and their laws.

use std::collections::BTreeMap;
use teeter_detect::Kinematics;
use teeter_integrator::{BeamFace, ImpactLaw, PairLaw};

use super::many::Many;
use super::parts::Contacts;
use super::{Resolver, names};
use crate::dimension::Dimension;
use crate::measure::Measure;
use crate::scene::{BlockScene, ContactScene, GroundScene, SupportingBody};
use crate::words::{ContactFrames, Law};

/// The keys of the friction of the left and the right foot.
const FEET: [&str; 2] = ["friction_left", "friction_right"];

/// The contact between a block and a body; a contact between two blocks is entered for both.
pub(super) type Joined = BTreeMap<(usize, SupportingBody), usize>;

/// The block and what it touches, of two bodies that can touch each other; the first block comes
/// first.
pub(super) fn touching(a: SupportingBody, b: SupportingBody) -> Option<(usize, SupportingBody)> {
    match (a, b) {
        (SupportingBody::Block(a), SupportingBody::Block(b)) if a == b => None,
        (SupportingBody::Block(a), surface) | (surface, SupportingBody::Block(a)) => Some((a, surface)),
        _ => None,
    }
}

/// A pair of bodies, whichever comes first.
pub(super) type PairKey = (usize, SupportingBody);

pub(super) fn key_of(block: usize, surface: SupportingBody) -> PairKey {
    match surface {
        SupportingBody::Block(other) if other < block => (other, SupportingBody::Block(block)),
        _ => (block, surface),
    }
}

pub(super) fn is_pattern(name: &str) -> bool {
    name.contains(['*', '?'])
}

impl Resolver<'_, '_> {
    /// All contacts, those with full names first, and the pairs that they join; and the contacts
    /// between blocks that are too many to be listed.
    pub(super) fn contacts(&mut self) -> Contacts {
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
        let Ok(crowded) = self.crowded(&many, &apart) else {
            contacts.push(None);
            return (contacts, joined, None);
        };
        let Some(holders) = self.holders(&many, &joined, &apart, crowded.as_ref(), contacts.len()) else {
            contacts.push(None);
            return (contacts, joined, None);
        };
        let crowd = crowded.as_ref().and_then(|classes| self.crowd(classes, &many, &joined, &apart));
        for of in many {
            let Some(of) = of else {
                contacts.push(None);
                continue;
            };
            match self.pairs_of_many(&of, &holders, crowded.as_ref()) {
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
            .filter(|contact| apart.contains(key_of(contact.block, contact.surface)))
            .map(|contact| (contact.name.clone(), contact.between.clone()))
            .collect();
        for (name, [a, b]) in together {
            let rule = format!("`{a}` and `{b}` don't touch, according to world.apart");
            self.error(&format!("contact.{name}.between"), rule, "leave out this contact, or the pair in apart");
        }
        let crowd = crowd.map(|crowd| crowd.beside(contacts.iter().flatten()));
        (contacts, joined, crowd)
    }

    /// The name of a body.
    pub(super) fn body_name(&self, body: SupportingBody) -> String {
        match body {
            SupportingBody::Ground => "ground".to_owned(),
            SupportingBody::Beam(beam) => {
                self.doc.names("beam").get(beam).map_or_else(String::new, |name| (*name).to_owned())
            }
            SupportingBody::Block(block) => self.block_names[block].name.clone(),
        }
    }

    /// Whether a body never moves: two of them have no contact by a pattern.
    pub(super) fn is_fixed(&self, body: SupportingBody) -> bool {
        match body {
            SupportingBody::Ground => true,
            SupportingBody::Beam(_) => false,
            SupportingBody::Block(block) => {
                self.doc.flag(&format!("block.{}.fixed", self.block_names[block].table)) == Some(true)
            }
        }
    }

    /// Reports, at `path`, a block that stands on a body without a contact between the two: by which key they have none, so that no
    /// contact is advised that would be refused.
    pub(super) fn stands_without_contact(&mut self, path: &str, [name, on]: [&str; 2], support: SupportingBody) {
        let block = self.blocks.get(name).copied().map(SupportingBody::Block);
        if block.is_some_and(|block| self.is_fixed(block)) && self.is_fixed(support) {
            let both = if on == "ground" { "a fixed block and the ground" } else { "two fixed blocks" };
            let rule = format!("{both} have no contact, so that `{name}` can't be placed on `{on}`");
            self.error(path, rule, "give position (and angle) instead of on, at and tilt");
            return;
        }
        let is_apart = |[a, b]: &[String; 2]| {
            let of = |a: &str, b: &str| names::matches_pattern(a, name) && names::matches_pattern(b, on);
            of(a, b) || of(b, a)
        };
        if self.doc.text_pairs("world.apart").is_some_and(|pairs| pairs.iter().any(is_apart)) {
            let rule = format!("the block stands on `{on}`, but world.apart says that the two don't touch");
            self.error(
                path,
                rule,
                "leave that pair out of apart, or give position (and angle) instead of on, at and tilt",
            );
            return;
        }
        let rule = format!("the block stands on `{on}`, but there is no contact between the two");
        self.error(path, rule, format!("add [contact.NAME] with between = [\"{name}\", \"{on}\"]"));
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
        let feet_friction = self.feet_friction(&path);
        self.feet_stand_on_surfaces(&path, feet_friction, matches!(surface, SupportingBody::Block(_)));
        let name = name.to_owned();
        Some(ContactScene { name, between, block, surface, law: law?, feet_friction, kinematics, face, sides })
    }

    /// Friction of the left and the right foot.
    pub(super) fn feet_friction(&mut self, path: &str) -> [Option<f64>; 2] {
        FEET.map(|key| self.doc.number(&format!("{path}.{key}")))
    }

    /// Refuses friction of feet in a contact that is also between blocks, whose corners touch each other in either way.
    pub(super) fn feet_stand_on_surfaces(&mut self, path: &str, feet: [Option<f64>; 2], between_blocks: bool) {
        let given = FEET.iter().zip(feet).find(|(_, friction)| friction.is_some());
        if let Some((key, _)) = given.filter(|_| between_blocks) {
            let rule = "it is for blocks on a beam or the ground, but this contact is between blocks";
            self.error(
                &format!("{path}.{key}"),
                rule,
                "leave it out, or name one of the blocks and the beam or `ground`",
            );
        }
    }

    /// Refuses friction of feet of blocks that stand on no two sharp corners, or on ground with a profile.
    pub(super) fn feet_are_sharp(
        &mut self,
        ground: &Option<Option<GroundScene>>,
        contacts: &[Option<ContactScene>],
        blocks: &[Option<BlockScene>],
    ) {
        let bent = matches!(ground, Some(Some(ground)) if ground.profile.is_some());
        let mut refused = Vec::new();
        for contact in contacts.iter().flatten().filter(|contact| contact.feet_friction != [None; 2]) {
            let Some(Some(block)) = blocks.get(contact.block) else { continue };
            let [left, right] = block.feet();
            let why = if (0..block.corners().len()).any(|corner| block.corner_radius(corner) > 0.0) {
                format!("`{}` is round, and touches by points that move along it", block.name)
            } else if left == right {
                format!("`{}` stands on one corner", block.name)
            } else if bent && contact.surface == SupportingBody::Ground {
                "the ground has a profile, whose crests touch the block, too".to_owned()
            } else {
                continue;
            };
            let key = if contact.feet_friction[0].is_some() { FEET[0] } else { FEET[1] };
            refused.push((format!("contact.{}.{key}", contact.name), why));
        }
        refused.dedup_by(|a, b| a.0 == b.0);
        for (key, why) in refused {
            let remedy = "give one `friction`; feet have their own only as sharp corners on a beam or on even ground";
            self.error(&key, why, remedy);
        }
    }

    pub(super) fn kinematics(&mut self, path: &str) -> Option<Kinematics> {
        Some(match self.choice(&format!("{path}.kinematics"))? {
            ContactFrames::Deformed => Kinematics::Deformed,
            ContactFrames::Linear => Kinematics::Linear,
        })
    }

    /// The default is allowed, since a written scene contains all defaults.
    pub(super) fn no_frames_of_blocks(&mut self, path: &str, surface: SupportingBody, kinematics: Option<Kinematics>) {
        let key = format!("{path}.kinematics");
        if matches!(surface, SupportingBody::Block(_)) && kinematics != Some(Kinematics::Deformed) {
            let rule = "it applies to the deflection of beams, but this contact is between two blocks";
            self.error(&key, rule, "leave it out");
        }
    }

    /// The bodies that match a name or a pattern; a pattern matches the ground and beams, too.
    pub(super) fn bodies_matching(&mut self, key: &str, pattern: &str) -> Option<Vec<(String, SupportingBody)>> {
        if !is_pattern(pattern) {
            let support = self.support(pattern);
            if support.is_none() {
                self.no_body(key, pattern);
            }
            return Some(vec![(pattern.to_owned(), support?)]);
        }
        let mut found = self.bodies();
        found.retain(|(name, _)| names::matches_pattern(pattern, name));
        if found.is_empty() {
            let remedy = self.known_bodies();
            self.error(key, format!("no body matches `{pattern}`"), remedy);
            return None;
        }
        Some(found)
    }

    /// All bodies: blocks, beams, the ground.
    pub(super) fn bodies(&self) -> Vec<(String, SupportingBody)> {
        let blocks = self.block_names.iter().enumerate();
        let blocks = blocks.map(|(number, block)| (block.name.clone(), SupportingBody::Block(number)));
        let beams = self.doc.names("beam").into_iter().enumerate();
        let beams = beams.map(|(number, name)| (name.to_owned(), SupportingBody::Beam(number)));
        let ground = self.doc.has_table("ground").then(|| ("ground".to_owned(), SupportingBody::Ground));
        blocks.chain(beams).chain(ground).collect()
    }

    /// The blocks and beams of a material.
    pub(super) fn bodies_of(&mut self, key: &str, material: &str) -> Option<Vec<(String, SupportingBody)>> {
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
            self.error(
                key,
                format!("no block or beam is of `{material}`"),
                "name a material that a body has itself, not only a part of it",
            );
            return None;
        }
        Some(found)
    }

    pub(super) fn pair_law(&mut self, path: &str) -> Option<PairLaw> {
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
