//! Beams: section, mesh, supports, damping, start.

use teeter_beam::{BeamSpec, Damping, MAX_ELEMENTS, Section, Support};

use super::Resolver;
use crate::scene::{BeamScene, SignalScene};

/// Most elements of all beams together: their memory and the time to factorise them stay within what a scene's check may
/// take.
const MOST_ELEMENTS: usize = 2 * MAX_ELEMENTS;

impl Resolver<'_, '_> {
    pub(super) fn beam(&mut self, name: &str, signals: &[Option<SignalScene>]) -> Option<BeamScene> {
        let path = format!("beam.{name}");
        let at = |key: &str| format!("{path}.{key}");
        let material = self.material(&path);
        let density = material.as_ref().and_then(|m| self.quantity(&format!("{m}.density")));
        let modulus = material.as_ref().and_then(|m| {
            let key = format!("{m}.youngs_modulus");
            let modulus = self.doc.quantity(&key);
            if modulus.is_none() && !self.doc.is_refused(&key) {
                self.error(&key, format!("missing key, used by {path}"), "add it, such as youngs_modulus = \"69 GPa\"");
            }
            modulus
        });
        let span = self.quantity(&at("span"));
        let width = self.quantity(&at("width"));
        let thickness = self.quantity(&at("thickness"));
        let elements = self.elements(&at("elements"));
        let supports = self.supports(&at("supports"));
        let position = self.pair(&at("position"));
        let damped = ["damping_ratio", "viscous_damping"].map(|key| {
            let path = at(key);
            (self.doc.has(&path) || self.doc.has_table(&path)).then_some(path)
        });
        if let [Some(_), Some(second)] = &damped {
            self.error(second, "damping_ratio and viscous_damping both set the same coefficient", "keep one of them");
        }
        let probes = self.doc.list(&at("probes")).unwrap_or_default().to_vec();
        let outside = span.and_then(|span| Some((span, probes.iter().find(|x| **x > span)?)));
        if let Some((span, x)) = outside {
            self.error(
                &at("probes"),
                format!("the probe at {x} m lies outside the span [0, {span}] m"),
                "give places along the beam, from its left end",
            );
        }
        if let Some(twice) = (1..probes.len()).find(|&k| probes[..k].contains(&probes[k])) {
            // Two columns of one name could not be told apart.
            let rule = format!("the probe at {} m is there twice", probes[twice]);
            self.error(&at("probes"), rule, "give each place once");
        }
        let static_start = self.word(&at("start")).map(|start| start == "static");
        if let (Some(true), Some(supports)) = (static_start, supports) {
            self.holds_still(&at("start"), supports);
        }
        let top = self.word(&at("surface")).map(|surface| surface == "top");
        let motion = self.motion(&path, signals);
        let (span, thickness, elements, supports) = (span?, thickness?, elements?, supports?);
        let section = match Section::rectangle(width?, thickness, modulus?, density?) {
            Ok(section) => section,
            Err(error) => {
                self.error(&path, error.to_string(), "check width, thickness and material");
                return None;
            }
        };
        let mut spec = BeamSpec::new(span, elements, section).supported(supports);
        spec.damping = self.damping(&path, &spec)?;
        let beam = BeamScene {
            name: name.to_owned(),
            spec,
            thickness,
            top: top?,
            static_start: static_start?,
            position: position?,
            probes,
            motion: motion?,
        };
        self.supported(&beam);
        Some(beam)
    }

    fn elements(&mut self, path: &str) -> Option<usize> {
        let elements = self.doc.integer(path).and_then(|elements| usize::try_from(elements).ok());
        self.need(path, elements)
    }

    /// Bounds what all beams take together; what a single one takes is bounded by the table of keys.
    pub(super) fn mesh_sizes(&mut self, beams: &[Option<BeamScene>]) {
        let mut sum = 0;
        for beam in beams.iter().flatten() {
            sum += beam.spec.elements;
            if sum > MOST_ELEMENTS {
                let rule = format!("with this beam the scene has {sum} elements, over the limit of {MOST_ELEMENTS}");
                let remedy = "20 to 100 elements a beam give more digits than the model has";
                self.error(&format!("beam.{}.elements", beam.name), rule, remedy);
                return;
            }
        }
    }

    fn supports(&mut self, path: &str) -> Option<[Support; 2]> {
        let words = self.doc.text_pair(path).map(|pair| pair.map(str::to_owned));
        let [left, right] = self.need(path, words)?;
        let support = |word: &str| match word {
            "pinned" => Some(Support::Pinned),
            "clamped" => Some(Support::Clamped),
            "free" => Some(Support::Free),
            _ => None,
        };
        Some([support(&left)?, support(&right)?])
    }

    /// Whether supports leave no rigid motion, so that there is a static equilibrium.
    fn holds_still(&mut self, path: &str, supports: [Support; 2]) {
        let (motion, missing) = match supports {
            [Support::Free, Support::Free] => ("both its ends are free", "clamp one end or pin both"),
            [Support::Pinned, Support::Free] => {
                ("it can turn about its pinned left end", "support the right end, or clamp the left one")
            }
            [Support::Free, Support::Pinned] => {
                ("it can turn about its pinned right end", "support the left end, or clamp the right one")
            }
            _ => return,
        };
        let rule = format!("the beam can move as a rigid body, so it has no static equilibrium: {motion}");
        self.error(path, rule, format!("{missing} (supports), or start undeformed"));
    }

    fn damping(&mut self, path: &str, spec: &BeamSpec) -> Option<Damping> {
        let doc = self.doc;
        let mut damping = Damping::default();
        if let Some(c) = doc.quantity(&format!("{path}.viscous_damping")) {
            damping.viscous = c;
        }
        let ratio = format!("{path}.damping_ratio");
        if doc.has_table(&ratio) {
            let mode = doc.integer(&format!("{ratio}.mode")).and_then(|mode| usize::try_from(mode).ok())?;
            let zeta = self.number(&format!("{ratio}.ratio"))?;
            match spec.viscous_for_ratio(mode, zeta) {
                Ok(c) => damping.viscous = c,
                Err(error) => {
                    self.error(&ratio, error.to_string(), "give a mode of the beam and a ratio of at least 0");
                    return None;
                }
            }
        }
        let rayleigh = format!("{path}.rayleigh");
        if doc.has_table(&rayleigh) {
            damping.rayleigh_mass = self.quantity(&format!("{rayleigh}.a0"))?;
            damping.rayleigh_stiffness = self.quantity(&format!("{rayleigh}.a1"))?;
        }
        Some(damping)
    }
}
