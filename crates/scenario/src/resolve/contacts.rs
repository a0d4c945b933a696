//! Contacts: who touches whom.

use teeter_detect::Kinematics;
use teeter_integrator::{ImpactLaw, PairLaw};

use super::Resolver;
use crate::dimension::Dimension;
use crate::measure::Measure;
use crate::scene::{ContactScene, Support};
use crate::words::{Frames, Law};

impl Resolver<'_, '_> {
    pub(super) fn contact(&mut self, name: &str) -> Option<ContactScene> {
        let path = format!("contact.{name}");
        let at = |key: &str| format!("{path}.{key}");
        let between = self.doc.text_pair(&at("between")).map(|pair| pair.map(str::to_owned));
        let between = self.need(&at("between"), between);
        let law = self.pair_law(&path);
        let kinematics = self.choice(&at("kinematics"));
        let between = between?;
        let (block, surface) = self.sides(&at("between"), &between)?;
        if matches!(surface, Support::Block(_)) && self.doc.is_given(&at("kinematics")) {
            let rule = "it says how a beam's deflection enters, but this contact is between two blocks";
            self.error(&at("kinematics"), rule, "leave it out");
        }
        let kinematics = match kinematics? {
            Frames::Deformed => Kinematics::Deformed,
            Frames::Linear => Kinematics::Linear,
        };
        Some(ContactScene { name: name.to_owned(), between, block, surface, law: law?, kinematics })
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
