//! Contacts: who touches whom.

use teeter_detect::Kinematics;

use super::Resolver;
use crate::scene::{ContactScene, Support};

impl Resolver<'_> {
    pub(super) fn contact(&mut self, name: &str) -> Option<ContactScene> {
        let path = format!("contact.{name}");
        let at = |key: &str| format!("{path}.{key}");
        let between = self.doc.text_pair(&at("between")).map(|pair| pair.map(str::to_owned));
        let between = self.need(&at("between"), between);
        let friction = self.number(&at("friction"));
        let restitution = self.number(&at("restitution"));
        let kinematics = self.word(&at("kinematics"));
        let between = between?;
        let (block, surface) = self.sides(&at("between"), &between)?;
        let kinematics = if kinematics? == "linear" { Kinematics::Linear } else { Kinematics::Deformed };
        Some(ContactScene {
            name: name.to_owned(),
            between,
            block,
            surface,
            friction: friction?,
            restitution: restitution?,
            kinematics,
        })
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
        let sides = [(a, b), (b, a)];
        let found = sides
            .iter()
            .find_map(|(block, surface)| Some((self.blocks.get(block.as_str()).copied()?, self.surface(surface)?)));
        if found.is_none() {
            let rule = if self.blocks.contains_key(a.as_str()) {
                "contact between two blocks is not available yet"
            } else {
                "a contact joins a block and a beam, or a block and the ground"
            };
            self.error(path, rule, "name a block, and a beam or the ground");
        }
        found
    }
}
