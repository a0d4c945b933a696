//! From a decoded document to a resolved scene: references, choices that exclude each other, numbers that must fit.

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::Document;
use crate::scene::{BeamScene, BlockScene, ContactScene, Placement, Scene, SolverScene, Support, Time};
use crate::value::Value;
use teeter_beam::{BeamSpec, Damping, Section};
use teeter_detect::Kinematics;

/// A scene with what was found on the way.
#[derive(Debug, Clone)]
pub struct Resolved {
    /// The scene.
    pub scene: Scene,
    /// The document with every default filled in.
    pub document: Document,
    /// What looks wrong but can be run.
    pub warnings: Vec<Diagnostic>,
}

/// Most steps of a run.
pub const MAX_STEPS: f64 = 1e12;

/// Most elements of a beam.
const MAX_ELEMENTS: usize = teeter_beam::MAX_ELEMENTS;

/// Resolves a document; `stem` is the title of a scene that has none.
///
/// # Errors
/// All that is wrong, at once.
pub fn resolve(mut document: Document, stem: &str) -> Result<Resolved, Diagnostics> {
    let mut resolver = Resolver { doc: &document, errors: Vec::new(), warnings: Vec::new() };
    let scene = resolver.scene(stem);
    let (mut errors, warnings) = (resolver.errors, resolver.warnings);
    match scene {
        Some(scene) if errors.is_empty() => {
            let derived = [
                ("title", Value::Text(scene.title.clone())),
                ("time.gap_tolerance", Value::Number(scene.time.gap_tolerance)),
            ];
            for (path, value) in derived {
                if !document.has(path)
                    && let Err(error) = document.set(path, value)
                {
                    errors.push(document.error(path, error.to_string(), "give the key in the scene"));
                }
            }
            if errors.is_empty() {
                return Ok(Resolved { scene, document, warnings });
            }
        }
        _ => {}
    }
    let mut diagnostics = Diagnostics(errors);
    diagnostics.sort();
    Err(diagnostics)
}

struct Resolver<'a> {
    doc: &'a Document,
    errors: Vec<Diagnostic>,
    warnings: Vec<Diagnostic>,
}

impl Resolver<'_> {
    fn error(&mut self, path: &str, rule: impl Into<String>, remedy: impl Into<String>) {
        self.errors.push(self.doc.error(path, rule, remedy));
    }

    /// A value that the decoder guarantees; its absence would be a mistake of the table of keys, and is said as such.
    fn need<T>(&mut self, path: &str, value: Option<T>) -> Option<T> {
        if value.is_none() {
            self.error(path, "missing key", "add it");
        }
        value
    }

    fn quantity(&mut self, path: &str) -> Option<f64> {
        let value = self.doc.quantity(path);
        self.need(path, value)
    }

    fn number(&mut self, path: &str) -> Option<f64> {
        let value = self.doc.number(path);
        self.need(path, value)
    }

    fn pair(&mut self, path: &str) -> Option<[f64; 2]> {
        let value = self.doc.pair(path);
        self.need(path, value)
    }

    fn word(&mut self, path: &str) -> Option<String> {
        let value = self.doc.text(path).map(str::to_owned);
        self.need(path, value)
    }

    fn scene(&mut self, stem: &str) -> Option<Scene> {
        let doc = self.doc;
        let title = doc.text("title").unwrap_or(stem).to_owned();
        let gravity = self.pair("world.gravity");
        // Each part is resolved whatever became of the others, so that all errors are found.
        let beams: Vec<_> = doc.names("beam").into_iter().map(|name| self.beam(name)).collect();
        let contacts: Vec<_> = doc.names("contact").into_iter().map(|name| self.contact(name)).collect();
        self.repeated_pairs(&contacts);
        let blocks: Vec<_> = doc.names("block").into_iter().map(|name| self.block(name, &beams, &contacts)).collect();
        if doc.names("block").is_empty() && doc.names("beam").is_empty() {
            self.error("block", "the scene holds no body", "add a [block.NAME] or a [beam.NAME]");
        }
        let time = self.time(&blocks, &beams);
        let solver = self.solver();
        let every = self.every(time.as_ref());
        Some(Scene {
            title,
            time: time?,
            gravity: gravity?,
            ground: doc.has_table("ground"),
            beams: beams.into_iter().collect::<Option<_>>()?,
            blocks: blocks.into_iter().collect::<Option<_>>()?,
            contacts: contacts.into_iter().collect::<Option<_>>()?,
            solver: solver?,
            every,
        })
    }

    /// The table of a body's material.
    fn material(&mut self, owner: &str) -> Option<String> {
        let path = format!("{owner}.material");
        let name = self.word(&path)?;
        let known = self.doc.names("material");
        if known.contains(&name.as_str()) {
            return Some(format!("material.{name}"));
        }
        let remedy = if known.is_empty() {
            format!("define it: [material.{name}]")
        } else {
            format!("materials defined: {}", known.join(", "))
        };
        self.error(&path, format!("the material `{name}` is not defined"), remedy);
        None
    }

    fn beam(&mut self, name: &str) -> Option<BeamScene> {
        let path = format!("beam.{name}");
        let at = |key: &str| format!("{path}.{key}");
        let material = self.material(&path);
        let density = material.as_ref().and_then(|m| self.quantity(&format!("{m}.density")));
        let modulus = material.as_ref().and_then(|m| {
            let key = format!("{m}.youngs_modulus");
            let modulus = self.doc.quantity(&key);
            if modulus.is_none() {
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
        if let Some(span) = span {
            for &x in &probes {
                if x > span {
                    self.error(
                        &at("probes"),
                        format!("the probe at {x} m lies outside the span [0, {span}] m"),
                        "give places along the beam, from its left end",
                    );
                }
            }
        }
        let static_start = self.word(&at("start"))? == "static";
        let top = self.word(&at("surface"))? == "top";
        let (Some(span), Some(thickness), Some(elements), Some(supports), Some(width), Some(modulus), Some(density)) =
            (span, thickness, elements, supports, width, modulus, density)
        else {
            return None;
        };
        let section = match Section::rectangle(width, thickness, modulus, density) {
            Ok(section) => section,
            Err(error) => {
                self.error(&path, error.to_string(), "check width, thickness and material");
                return None;
            }
        };
        let mut spec = BeamSpec { span, elements, section, supports, damping: Damping::default() };
        spec.damping = self.damping(&path, &spec)?;
        if static_start && !holds_still(supports) {
            self.error(
                &at("start"),
                "the beam can move as a rigid body, so it has no static equilibrium",
                "clamp one end or pin both (supports), or start undeformed",
            );
        }
        Some(BeamScene { name: name.to_owned(), spec, thickness, top, static_start, position: position?, probes })
    }

    fn elements(&mut self, path: &str) -> Option<usize> {
        let elements = self.doc.integer(path);
        let elements = self.need(path, elements)?;
        match usize::try_from(elements) {
            Ok(elements) if elements <= MAX_ELEMENTS => Some(elements),
            _ => {
                self.error(
                    path,
                    format!("must be at most {MAX_ELEMENTS}"),
                    "20 to 100 elements give more digits than the model has",
                );
                None
            }
        }
    }

    fn supports(&mut self, path: &str) -> Option<[teeter_beam::Support; 2]> {
        let words = self.doc.text_pair(path).map(|pair| pair.map(str::to_owned));
        let [left, right] = self.need(path, words)?;
        let support = |word: &str| match word {
            "pinned" => Some(teeter_beam::Support::Pinned),
            "clamped" => Some(teeter_beam::Support::Clamped),
            "free" => Some(teeter_beam::Support::Free),
            _ => None,
        };
        Some([support(&left)?, support(&right)?])
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

    /// What a name stands for, as something to touch.
    fn surface(&self, name: &str) -> Option<Support> {
        if name == "ground" {
            return self.doc.has_table("ground").then_some(Support::Ground);
        }
        self.doc.names("beam").iter().position(|beam| *beam == name).map(Support::Beam)
    }

    fn block_number(&self, name: &str) -> Option<usize> {
        self.doc.names("block").iter().position(|block| *block == name)
    }

    fn known_bodies(&self) -> String {
        let mut names = self.doc.names("block");
        names.extend(self.doc.names("beam"));
        if self.doc.has_table("ground") {
            names.push("ground");
        }
        format!("bodies of the scene: {}", names.join(", "))
    }

    fn contact(&mut self, name: &str) -> Option<ContactScene> {
        let path = format!("contact.{name}");
        let at = |key: &str| format!("{path}.{key}");
        let between = self.doc.text_pair(&at("between")).map(|pair| pair.map(str::to_owned));
        let between = self.need(&at("between"), between);
        let friction = self.number(&at("friction"));
        let restitution = self.number(&at("restitution"));
        let kinematics =
            if self.word(&at("kinematics"))? == "linear" { Kinematics::Linear } else { Kinematics::Deformed };
        let between = between?;
        let (block, surface) = self.contact_sides(&at("between"), &between)?;
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

    fn contact_sides(&mut self, path: &str, between: &[String; 2]) -> Option<(usize, Support)> {
        let [a, b] = between;
        if a == b {
            self.error(path, format!("`{a}` can't touch itself"), self.known_bodies());
            return None;
        }
        let mut missing = false;
        for name in between {
            if self.block_number(name).is_none() && self.surface(name).is_none() {
                let remedy = if name == "ground" { "add [ground]".to_owned() } else { self.known_bodies() };
                self.error(path, format!("there is no body `{name}`"), remedy);
                missing = true;
            }
        }
        if missing {
            return None;
        }
        let sides = [(a, b), (b, a)];
        let found = sides.iter().find_map(|(block, surface)| Some((self.block_number(block)?, self.surface(surface)?)));
        if found.is_none() {
            let rule = if self.block_number(a).is_some() {
                "contact between two blocks is not available yet"
            } else {
                "a contact joins a block and a beam, or a block and the ground"
            };
            self.error(path, rule, "name a block, and a beam or the ground");
        }
        found
    }

    fn repeated_pairs(&mut self, contacts: &[Option<ContactScene>]) {
        for (k, contact) in contacts.iter().enumerate() {
            let Some(contact) = contact else { continue };
            let same = |other: &&ContactScene| other.block == contact.block && other.surface == contact.surface;
            if let Some(first) = contacts[..k].iter().flatten().find(same) {
                let rule = format!("the contact `{}` joins the same two bodies", first.name);
                self.error(&format!("contact.{}", contact.name), rule, "keep one of them");
            }
        }
    }

    fn block(
        &mut self,
        name: &str,
        beams: &[Option<BeamScene>],
        contacts: &[Option<ContactScene>],
    ) -> Option<BlockScene> {
        let path = format!("block.{name}");
        let at = |key: &str| format!("{path}.{key}");
        let density = self.material(&path).and_then(|m| self.quantity(&format!("{m}.density")));
        let width = self.quantity(&at("width"));
        let height = self.quantity(&at("height"));
        let depth = self.quantity(&at("depth"));
        let velocity = self.pair(&at("velocity"));
        let spin = self.quantity(&at("spin"));
        let placement = self.placement(name, contacts);
        let block = BlockScene {
            name: name.to_owned(),
            width: width?,
            height: height?,
            depth: depth?,
            density: density?,
            placement: placement?,
            velocity: velocity?,
            spin: spin?,
        };
        self.stands(&block, beams);
        Some(block)
    }

    fn placement(&mut self, name: &str, contacts: &[Option<ContactScene>]) -> Option<Placement> {
        let doc = self.doc;
        let path = format!("block.{name}");
        let at = |key: &str| format!("{path}.{key}");
        if doc.has(&at("position")) {
            for key in ["on", "at", "tilt"] {
                if doc.is_given(&at(key)) {
                    self.error(
                        &at(key),
                        "position already says where the block is",
                        "keep position and angle, or on, at and tilt",
                    );
                    return None;
                }
            }
            return Some(Placement::Free {
                position: self.pair(&at("position"))?,
                angle: self.quantity(&at("angle"))?,
            });
        }
        if doc.is_given(&at("angle")) {
            self.error(&at("angle"), "angle goes with position", "write tilt, or give position");
            return None;
        }
        let Some(on) = doc.text(&at("on")) else {
            self.error(&path, "the block has no place", "give on and at (and tilt), or position (and angle)");
            return None;
        };
        let x = self.quantity(&at("at"));
        let tilt = doc.quantity(&at("tilt")).unwrap_or(0.0);
        let Some(support) = self.surface(on) else {
            if self.block_number(on).is_some() {
                self.error(&at("on"), "a block on a block is not available yet", "put it on a beam or on the ground");
            } else {
                let remedy = if on == "ground" { "add [ground]".to_owned() } else { self.known_bodies() };
                self.error(&at("on"), format!("there is no body `{on}`"), remedy);
            }
            return None;
        };
        let block = self.block_number(name)?;
        let joins = |contact: &ContactScene| contact.block == block && contact.surface == support;
        let contact = contacts.iter().position(|contact| contact.as_ref().is_some_and(joins));
        if contact.is_none() && contacts.iter().all(Option::is_some) {
            let rule = format!("the block stands on `{on}`, but no contact joins the two");
            let remedy = format!("add [contact.NAME] with between = [\"{name}\", \"{on}\"]");
            self.error(&at("on"), rule, remedy);
        }
        Some(Placement::On { support, at: x?, tilt, contact: contact? })
    }

    /// Whether a block fits on what it stands on; warnings about its tilt.
    fn stands(&mut self, block: &BlockScene, beams: &[Option<BeamScene>]) {
        let Placement::On { support, at, tilt, .. } = block.placement else { return };
        let path = |key: &str| format!("block.{}.{key}", block.name);
        let alpha = block.critical_angle();
        if tilt.abs() >= alpha {
            let rule = format!(
                "at or beyond the critical angle {:.2} deg of this block: it will overturn",
                alpha.to_degrees()
            );
            let warning = self.doc.error(&path("tilt"), rule, "check the angle and its unit").as_warning();
            self.warnings.push(warning);
        }
        let Support::Beam(number) = support else { return };
        let Some(Some(beam)) = beams.get(number) else { return };
        let (left, span) = (beam.position[0], beam.spec.span);
        if block.width > span {
            let rule = format!("the block is {} m wide, but the span of `{}` is {span} m", block.width, beam.name);
            self.error(&path("width"), rule, "a block on a beam must be narrower than its span");
            return;
        }
        let feet = [("bottom-left", at - 0.5 * block.width), ("bottom-right", at + 0.5 * block.width)];
        for (corner, x) in feet {
            // The corner that a tilt lifts may hang over the end.
            let lifted = if tilt > 0.0 { "bottom-right" } else { "bottom-left" };
            if (tilt == 0.0 || corner != lifted) && !(left..=left + span).contains(&x) {
                let rule = format!(
                    "the corner {corner} at x = {x} m lies outside `{}`, which reaches from {left} m to {} m",
                    beam.name,
                    left + span
                );
                self.error(&path("at"), rule, "move the block onto the beam");
            }
        }
    }

    fn time(&mut self, blocks: &[Option<BlockScene>], beams: &[Option<BeamScene>]) -> Option<Time> {
        let (end, step) = (self.quantity("time.end"), self.quantity("time.step"));
        let theta = self.number("time.theta")?;
        self.stable(theta, beams);
        let activation_gamma = self.number("time.activation_gamma")?;
        let gap_tolerance = self.doc.quantity("time.gap_tolerance").unwrap_or_else(|| gap_tolerance(blocks));
        let (end, step) = (end?, step?);
        if step > end {
            self.error(
                "time.step",
                format!("longer than the whole run of {end} s"),
                "give a step far shorter than time.end",
            );
            return None;
        }
        let steps = end / step;
        if steps > MAX_STEPS {
            let rule = format!(
                "{steps:.1e} steps to {end} s, over the limit of {MAX_STEPS:.0e}; at 1 µs each they would take {}",
                duration(steps * 1e-6)
            );
            self.error("time.step", rule, "take a longer step or an earlier end");
            return None;
        }
        // Up to rounding of the quotient a whole number of steps is one.
        let whole = steps.round();
        let steps = if (steps - whole).abs() <= 1e-9 * whole { whole } else { steps.ceil() };
        if steps != whole || (steps * step - end).abs() > 1e-9 * end {
            let rule = format!("not a whole number of steps of {step} s: the run goes on to {} s", steps * step);
            self.warnings
                .push(self.doc.error("time.end", rule, "choose an end that is a multiple of the step").as_warning());
        }
        Some(Time { end, step, steps: steps as u64, theta, activation_gamma, gap_tolerance })
    }

    /// θ < ½ is allowed only on request; the largest stable step is named either way.
    fn stable(&mut self, theta: f64, beams: &[Option<BeamScene>]) {
        if theta >= 0.5 {
            return;
        }
        let limit = beams
            .iter()
            .flatten()
            .map(|beam| crate::stability::largest_stable_step(&beam.spec, theta))
            .fold(f64::INFINITY, f64::min);
        let rule = if limit == f64::INFINITY {
            "below 0.5 the scheme is not unconditionally stable".to_owned()
        } else if limit > 0.0 {
            format!("below 0.5 the scheme is stable only for steps up to {limit:.3e} s on this mesh")
        } else {
            "below 0.5 the undamped modes of the beam grow at every step size".to_owned()
        };
        if self.doc.flag("time.allow_conditional_stability") == Some(true) {
            self.warnings
                .push(self.doc.error("time.theta", rule, "0.5 keeps energy and is always stable").as_warning());
        } else {
            self.error("time.theta", rule, "take theta of at least 0.5, or set allow_conditional_stability = true");
        }
    }

    fn solver(&mut self) -> Option<SolverScene> {
        let doc = self.doc;
        let max_iterations = doc.integer("solver.max_iterations").and_then(|n| u32::try_from(n).ok());
        Some(SolverScene {
            method: self.word("solver.method")?,
            tolerance: self.number("solver.tolerance")?,
            max_iterations: self.need("solver.max_iterations", max_iterations)?,
            require_convergence: doc.flag("solver.require_convergence").unwrap_or(false),
        })
    }

    fn every(&mut self, time: Option<&Time>) -> Option<f64> {
        let every = self.doc.quantity("output.every")?;
        if let Some(time) = time {
            // A row takes some 20 bytes a column; the trajectory of one block on a beam has 9.
            let columns = 1 + 6 * self.doc.names("block").len() + 2 * self.doc.names("beam").len();
            let rows = (time.end / every.max(time.step)).min(time.steps as f64);
            let bytes = rows * columns as f64 * 20.0;
            if bytes > MAX_BYTES {
                let rule = format!(
                    "{rows:.1e} rows would take some {:.0} GB in trajectory.csv alone, over the limit of 10 GB",
                    bytes / 1e9
                );
                self.error("output.every", rule, "write fewer rows");
            }
        }
        Some(every)
    }
}

/// Most bytes of a trajectory.
const MAX_BYTES: f64 = 10e9;

/// The gap tolerance that a scene without one gets: 1e-12 m, scaled for blocks outside [0.01, 1] m.
fn gap_tolerance(blocks: &[Option<BlockScene>]) -> f64 {
    let largest = blocks.iter().flatten().map(|block| block.width.max(block.height)).fold(0.0, f64::max);
    if largest == 0.0 || (0.01..=1.0).contains(&largest) { 1e-12 } else { 1e-11 * largest }
}

/// Whether supports leave no rigid motion.
fn holds_still(supports: [teeter_beam::Support; 2]) -> bool {
    use teeter_beam::Support::{Clamped, Pinned};
    supports.contains(&Clamped) || supports == [Pinned, Pinned]
}

fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} minutes", s / 60.0),
        s if s < 172_800.0 => format!("{:.0} hours", s / 3600.0),
        s if s < 6.3e7 => format!("{:.0} days", s / 86_400.0),
        s => format!("{:.0} years", s / 3.156e7),
    }
}
