//! Resolves cross-sections of beams and segments: profiles of a material, or given stiffnesses.

use teeter_beam::{BeamError, Profile, Section, Segment};

use super::Resolver;
use crate::words::{Shape, Theory, Word};

/// A section and its thickness.
pub(super) struct SectionProfile {
    pub(super) section: Section,
    /// Its height in the plane, m, if known.
    pub(super) thickness: Option<f64>,
}

impl Resolver<'_, '_> {
    /// The section of the table at `path`, with a material and the theory of the beam at `beam`.
    pub(super) fn section(&mut self, path: &str, material: Option<&str>, beam: &str) -> Option<SectionProfile> {
        let at = |key: &str| format!("{path}.{key}");
        let shear = match self.doc.text(&format!("{beam}.theory")).and_then(Theory::of) {
            Some(Theory::Timoshenko) => true,
            Some(Theory::EulerBernoulli) | None => false,
        };
        let shape = self.choice(&at("section"))?;
        if shape == Shape::Direct {
            return self.direct(path, shear, self.doc.text(&format!("{beam}.axial")) != Some("free"));
        }
        let values = material.map(|material| self.of_material(material, path, shear));
        let profile = self.profile(path, shape);
        let (Some([modulus, density, poisson]), profile) = (values??, profile?) else { return None };
        let section = if shear {
            Section::timoshenko(profile, modulus, density, poisson)
        } else {
            Section::of(profile, modulus, density)
        };
        match section {
            Ok(section) => Some(SectionProfile { section, thickness: Some(2.0 * profile.fibre()) }),
            Err(BeamError::Value { field, rule, .. }) if self.doc.has(&at(field)) => {
                self.error(&at(field), format!("must be {rule}"), "check the dimensions of the section");
                None
            }
            Err(error) => {
                self.error(path, error.to_string(), "check width, thickness and material");
                None
            }
        }
    }

    fn profile(&mut self, path: &str, shape: Shape) -> Option<Profile> {
        let mut side = |key: &str| self.quantity(&format!("{path}.{key}"));
        Some(match shape {
            // Given directly, without a profile.
            Shape::Direct => return None,
            Shape::Circle => Profile::Circle { diameter: side("diameter")? },
            Shape::Tube => {
                let (diameter, wall) = (side("diameter"), side("wall"));
                Profile::Tube { diameter: diameter?, wall: wall? }
            }
            Shape::ISection => {
                let sides = ["height", "width", "web", "flange"].map(side);
                let [height, width, web, flange] = sides;
                Profile::ISection { height: height?, width: width?, web: web?, flange: flange? }
            }
            Shape::Rectangle => {
                let (width, thickness) = (side("width"), side("thickness"));
                Profile::Rectangle { width: width?, thickness: thickness? }
            }
        })
    }

    /// Young's modulus, density, and Poisson's ratio if shear needs it; an inner `None` if one is
    /// missing.
    fn of_material(&mut self, material: &str, path: &str, shear: bool) -> Option<Option<[f64; 3]>> {
        let density = self.quantity(&format!("{material}.density"));
        let modulus = self.needed(&format!("{material}.youngs_modulus"), path, "youngs_modulus = \"69 GPa\"");
        let poisson = if shear {
            let path = format!("{path} with theory = timoshenko");
            self.needed(&format!("{material}.poisson_ratio"), &path, "poisson_ratio = 0.33")
        } else {
            Some(0.0)
        };
        Some(Some([modulus?, density?, poisson?]))
    }

    /// A value of a material that is required only by some bodies.
    fn needed(&mut self, key: &str, user: &str, example: &str) -> Option<f64> {
        let value = self.doc.quantity(key).or_else(|| self.doc.number(key));
        let told = self.doc.is_refused(key) || self.errors.iter().any(|error| error.path == key);
        if value.is_none() && !told {
            self.error(key, format!("missing key, used by {user}"), format!("add it, such as {example}"));
        }
        value
    }

    /// A section given by its stiffnesses.
    fn direct(&mut self, path: &str, shear: bool, axial: bool) -> Option<SectionProfile> {
        let at = |key: &str| format!("{path}.{key}");
        let doc = self.doc;
        let (bending, mass) = (self.quantity(&at("bending_stiffness")), self.quantity(&at("mass_per_length")));
        let missing = |key: &str| !doc.has(&at(key)) && !doc.is_refused(&at(key));
        if shear && missing("shear_stiffness") {
            let rule = "missing, where theory = timoshenko";
            self.error(&at("shear_stiffness"), rule, "add it, such as shear_stiffness = \"1 MN\"");
        }
        if axial && missing("axial_stiffness") {
            let rule = "required with axial = held or elastic";
            self.error(&at("axial_stiffness"), rule, "add it, such as axial_stiffness = \"3 MN\"");
        }
        let unused = ["shear_stiffness", "rotatory_inertia"].into_iter().find(|key| !shear && doc.has(&at(key)));
        if let Some(key) = unused {
            let rule = format!("{key} has no meaning with theory = euler-bernoulli");
            self.error(&at(key), rule, "leave it out, or use theory = \"timoshenko\"");
        }
        let value = |key: &str| doc.quantity(&at(key));
        let made = Section::new(bending?, mass?).and_then(|section| {
            let section = match (shear, value("shear_stiffness")) {
                (true, Some(stiffness)) => section.with_shear(stiffness, value("rotatory_inertia").unwrap_or(0.0))?,
                _ => section,
            };
            value("axial_stiffness").map_or(Ok(section), |stiffness| section.with_axial_stiffness(stiffness))
        });
        match made {
            Ok(section) => Some(SectionProfile { section, thickness: value("thickness") }),
            Err(error) => {
                self.error(path, error.to_string(), "check the values of the section");
                None
            }
        }
    }

    /// The segments of the beam with their own sections; with the beam's material unless they name
    /// one.
    pub(super) fn segments(&mut self, beam: &str, material: Option<&str>) -> Option<Vec<Segment>> {
        let group = format!("{beam}.segment");
        let span = self.doc.quantity(&format!("{beam}.span"));
        let all: Vec<_> = self
            .doc
            .names(&group)
            .into_iter()
            .map(|name| self.segment(&format!("{group}.{name}"), beam, material, span))
            .collect();
        all.into_iter().collect()
    }

    fn segment(&mut self, path: &str, beam: &str, material: Option<&str>, span: Option<f64>) -> Option<Segment> {
        let part = self.part(path, span);
        let own = self.doc.has(&format!("{path}.material")).then(|| self.material(path));
        let is_direct = self.doc.text(&format!("{path}.section")) == Some("direct");
        if own.is_none()
            && material.is_none()
            && !is_direct
            && self.doc.text(&format!("{beam}.section")) == Some("direct")
        {
            let remedy = "add it: the beam itself, with section = direct, has none";
            self.error(&format!("{path}.material"), "missing", remedy);
        }
        let material = own.unwrap_or_else(|| material.map(str::to_owned));
        let profiled = self.section(path, material.as_deref(), beam);
        let [from, to] = part?;
        Some(Segment::new(from, to, profiled?.section))
    }
}
