//! From a decoded document to a resolved scene: references, choices that exclude each other,
//! numbers that must fit.

mod beam_output;
mod beams;
mod blocks;
mod contacts;
mod motions;
pub(crate) mod names;
mod sections;
mod shape;
mod signals;
mod supports;
mod timing;

use names::BlockName;
use std::collections::BTreeMap;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::Document;
use crate::doubts;
use crate::scene::{ContactScene, GroundScene, Scene, SignalScene, SolverScene, Support};
use crate::value::Value;
use crate::words::Word;
use crate::{volume, wording};
use teeter_contact::Law;
use teeter_solvers::SOLVERS;

pub use timing::MAX_STEPS;

/// A scene with what was found on the way.
#[derive(Debug, Clone)]
pub struct Resolved {
    /// The scene.
    pub scene: Scene,
    /// The document with every default filled in.
    pub document: Document,
    /// What looks wrong but can be run.
    pub warnings: Vec<Diagnostic>,
    /// What looks wrong beforehand of what a run measures and says by itself: for who doesn't run
    /// it.
    pub foreseen: Vec<Diagnostic>,
    /// What is worth knowing, with nothing wrong.
    pub notes: Vec<Diagnostic>,
    /// The files that the scene names, by the path in the scene, with their bytes as they were
    /// read.
    pub files: Vec<(String, Vec<u8>)>,
}

/// Reads a file that a scene names, by the path in the scene; or says why it can't be read, in
/// words that end an error message.
pub type ReadFile<'a> = dyn FnMut(&str) -> Result<Vec<u8>, String> + 'a;

/// Resolves a document; `stem` is the title of a scene that has none.
///
/// # Errors
/// All that is wrong, at once.
pub fn resolve(mut document: Document, stem: &str, read: &mut ReadFile<'_>) -> Result<Resolved, Diagnostics> {
    let mut resolver = Resolver::new(&document, false, read);
    let scene = resolver.scene(stem);
    let (mut errors, mut warnings, files) = (resolver.errors, resolver.warnings, resolver.files);
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
            // Whoever runs it again has the scheme that was chosen, whatever is written out beside
            // it.
            if document.text("time.scheme") != Some(scene.time.scheme.word())
                && let Err(error) = document.set("time.scheme", Value::Text(scene.time.scheme.word().to_owned()))
            {
                errors.push(document.error("time.scheme", error.to_string(), "name a scheme in the scene"));
            }
            // A default that does nothing is not written out as if it were meant.
            if !scene.time.scheme.predicts() {
                document.forget_default("time.activation_gamma");
            }
            if errors.is_empty() {
                let doubts = doubts::of(&scene, &document);
                warnings.extend(doubts.warnings);
                let (foreseen, notes) = (doubts.foreseen, doubts.notes);
                return Ok(Resolved { scene, document, warnings, foreseen, notes, files });
            }
        }
        _ => {}
    }
    let mut diagnostics = Diagnostics(errors);
    diagnostics.sort();
    Err(diagnostics)
}

/// What is wrong over several keys in a document some of whose values were refused already: of
/// those nothing is said again.
pub(crate) fn mistakes(document: &Document, read: &mut ReadFile<'_>) -> Vec<Diagnostic> {
    let mut resolver = Resolver::new(document, true, read);
    let _ = resolver.scene("");
    resolver.errors
}

impl Resolved {
    /// The scene with a step (s) in place of the accuracy that it was to be found for.
    ///
    /// # Errors
    /// All that is wrong with it then.
    pub fn with_step(self, step: f64) -> Result<Self, Diagnostics> {
        let Self { mut document, files, scene, .. } = self;
        document.leave_out("time.accuracy");
        if let Err(error) = document.set("time.step", Value::Number(step)) {
            let remedy = "give a step in place of the accuracy";
            return Err(document.error("time.accuracy", error.to_string(), remedy).into());
        }
        // A default that does nothing was left out, but is read all the same.
        if !document.has("time.activation_gamma") {
            let _ = document.set("time.activation_gamma", Value::Number(scene.time.activation_gamma));
        }
        let mut read = |path: &str| {
            let file = files.iter().find(|(name, _)| name == path);
            file.map(|(_, bytes)| bytes.clone()).ok_or_else(|| "was not read with the scene".to_owned())
        };
        resolve(document, &scene.title, &mut read)
    }
}

struct Resolver<'a, 'f> {
    read: &'f mut ReadFile<'f>,
    /// What was read.
    files: Vec<(String, Vec<u8>)>,
    doc: &'a Document,
    /// Whether values are missing that have their message already.
    partial: bool,
    beams: BTreeMap<&'a str, usize>,
    block_names: Vec<BlockName>,
    /// The numbers of blocks by their names.
    blocks: BTreeMap<String, usize>,
    signals: BTreeMap<&'a str, usize>,
    errors: Vec<Diagnostic>,
    warnings: Vec<Diagnostic>,
}

impl<'a, 'f> Resolver<'a, 'f> {
    fn new(doc: &'a Document, partial: bool, read: &'f mut ReadFile<'f>) -> Self {
        let numbered = |group| doc.names(group).into_iter().zip(0..).collect();
        let block_names = BlockName::all(doc);
        let mut errors = Vec::new();
        let blocks = names::numbered(&block_names, |block| {
            let rule = format!("there are two blocks `{}`: one of its own table, one by repeat", block.name);
            errors.push(doc.error(&format!("block.{}", block.table), rule, "give one of them another name"));
        });
        Self {
            read,
            files: Vec::new(),
            doc,
            partial,
            beams: numbered("beam"),
            block_names,
            blocks,
            signals: numbered("signal"),
            errors,
            warnings: Vec::new(),
        }
    }

    fn error(&mut self, path: &str, rule: impl Into<String>, remedy: impl Into<String>) {
        self.errors.push(self.doc.error(path, rule, remedy));
    }

    /// A value that the decoder guarantees unless it has refused it; its absence elsewhere would be
    /// a mistake of the table of keys, and is said as such.
    fn need<T>(&mut self, path: &str, value: Option<T>) -> Option<T> {
        if value.is_none() && !self.partial {
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

    /// What the word of a key means.
    fn choice<W: Word>(&mut self, path: &str) -> Option<W> {
        let word = self.word(path)?;
        let meant = W::of(&word);
        if meant.is_none() {
            let words: Vec<&str> = W::ALL.iter().map(|(word, _)| *word).collect();
            self.error(path, format!("`{word}` is none of its words"), format!("one of {}", words.join(", ")));
        }
        meant
    }

    fn scene(&mut self, stem: &str) -> Option<Scene> {
        let doc = self.doc;
        let title = doc.text("title").unwrap_or(stem).to_owned();
        let gravity = self.pair("world.gravity");
        // Each part is resolved whatever became of the others, so that all errors are found.
        let signals: Vec<_> = doc.names("signal").into_iter().map(|name| self.signal(name)).collect();
        let ground = self.ground(&signals);
        let mut beams: Vec<_> = doc.names("beam").into_iter().map(|name| self.beam(name, &signals)).collect();
        if self.mesh_sizes(&beams) {
            beams.iter_mut().flatten().for_each(|beam| self.assembled(beam));
        }
        let (contacts, joined) = self.contacts();
        self.contacts_fit_memory(&contacts);
        let names = self.block_names.clone();
        let blocks: Vec<_> = names.iter().map(|name| self.block(name, &beams, &contacts, &joined, &signals)).collect();
        self.stand_on_something(&blocks);
        self.gives_way(&blocks, &contacts);
        let forces: Vec<_> = doc.names("force").into_iter().map(|name| self.force(name, &signals)).collect();
        let loads: Vec<_> = doc.names("load").into_iter().map(|name| self.load(name, &beams, &signals)).collect();
        if self.blocks.is_empty() && self.beams.is_empty() && !self.partial {
            self.error("block", "the scene holds no body", "add a [block.NAME] or a [beam.NAME]");
        }
        let time = self.time(&blocks, &beams);
        if let Some(time) = &time {
            self.refuse_springs(time.scheme, &contacts, &beams);
            self.covered(&signals, time.steps() as f64 * time.step);
        }
        let solver = self.solver();
        let every = doc.quantity("output.every");
        let scene = Scene {
            title,
            time: time?,
            gravity: gravity?,
            ground: ground?,
            beams: beams.into_iter().collect::<Option<_>>()?,
            blocks: blocks.into_iter().collect::<Option<_>>()?,
            contacts: contacts.into_iter().collect::<Option<_>>()?,
            signals: signals.into_iter().collect::<Option<_>>()?,
            forces: forces.into_iter().collect::<Option<_>>()?,
            loads: loads.into_iter().collect::<Option<_>>()?,
            solver: solver?,
            every,
        };
        self.output(&scene);
        Some(scene)
    }

    /// The ground, if there is any; `None` where something is wrong with it.
    fn ground(&mut self, signals: &[Option<SignalScene>]) -> Option<Option<GroundScene>> {
        if !self.doc.has_table("ground") {
            return Some(None);
        }
        let (incline, motion) = (self.quantity("ground.incline"), self.motion("ground", signals));
        Some(Some(GroundScene { incline: incline?, motion: motion? }))
    }

    /// The bytes of a file that the scene names; each is read once.
    fn file(&mut self, path: &str) -> Result<Vec<u8>, String> {
        if let Some((_, bytes)) = self.files.iter().find(|(read, _)| read == path) {
            return Ok(bytes.clone());
        }
        let bytes = (self.read)(path)?;
        self.files.push((path.to_owned(), bytes.clone()));
        Ok(bytes)
    }

    /// The table of a body's material.
    fn material(&mut self, owner: &str) -> Option<String> {
        let path = format!("{owner}.material");
        let name = self.word(&path)?;
        let table = format!("material.{name}");
        if self.doc.has_table(&table) {
            return Some(table);
        }
        if self.doc.is_refused("material") {
            return None;
        }
        let known = self.doc.names("material");
        let remedy = if known.is_empty() {
            format!("define it: [material.{name}]")
        } else {
            format!("materials defined: {}", listed(&known))
        };
        let near = crate::suggest::nearest(&name, known).map(str::to_owned);
        self.error(&path, format!("the material `{name}` is not defined"), remedy);
        self.suggest(near);
        None
    }

    /// Adds a suggestion to the last error.
    fn suggest(&mut self, near: Option<String>) {
        if let Some(last) = self.errors.last_mut() {
            last.did_you_mean = near;
        }
    }

    /// What a name stands for, as something to touch.
    fn surface(&self, name: &str) -> Option<Support> {
        if name == "ground" {
            return self.doc.has_table("ground").then_some(Support::Ground);
        }
        self.beams.get(name).copied().map(Support::Beam)
    }

    /// What a block can stand on.
    fn support(&self, name: &str) -> Option<Support> {
        self.surface(name).or_else(|| self.blocks.get(name).copied().map(Support::Block))
    }

    /// A name that is no body of the scene; nothing is said where bodies may have been lost.
    fn no_body(&mut self, path: &str, name: &str) {
        if ["beam", "block", "ground"].iter().any(|group| self.doc.is_refused(group)) {
            return;
        }
        let names: Vec<&str> = self.doc.names("block").into_iter().chain(self.doc.names("beam")).collect();
        let near = crate::suggest::nearest(name, names.iter().copied()).map(str::to_owned);
        let remedy = if name == "ground" { "add [ground]".to_owned() } else { self.known_bodies() };
        self.error(path, format!("there is no body `{name}`"), remedy);
        self.suggest(near);
    }

    fn known_bodies(&self) -> String {
        let mut names: Vec<&str> = self.block_names.iter().map(|block| block.name.as_str()).collect();
        names.extend(self.doc.names("beam"));
        if self.doc.has_table("ground") {
            names.push("ground");
        }
        if names.is_empty() {
            "the scene has none".to_owned()
        } else {
            format!("bodies of the scene: {}", listed(&names))
        }
    }

    /// Refuses more contacts than whose dense operator memory can be asked for: a run would end in
    /// the middle, without a word.
    fn contacts_fit_memory(&mut self, contacts: &[Option<ContactScene>]) {
        // Of blocks in a plane few touch each other at a time.
        let between = contacts.iter().flatten().filter(|contact| contact.other_block().is_some()).count();
        let pairs = contacts.len() - between + between.min(3 * self.block_names.len());
        let most = volume::operator_bytes(2 * pairs);
        if most > volume::MOST_OPERATOR_BYTES {
            let rule = format!(
                "{pairs} contacts of blocks, each on two corners, take {} of memory for their operator, over the limit of {}",
                wording::bytes(most),
                wording::bytes(volume::MOST_OPERATOR_BYTES)
            );
            self.error(
                "contact",
                rule,
                "take fewer blocks, or run those that don't feel each other in scenes of their own",
            );
        }
    }

    fn solver(&mut self) -> Option<SolverScene> {
        let doc = self.doc;
        let known = doc.text("solver.method").and_then(|name| SOLVERS.iter().find(|info| info.name == name));
        // A block rests on two corners, so three pairs can have six contacts at once.
        let pairs = doc.names("contact").len();
        if let Some(most) = known.and_then(|info| info.most_contacts).filter(|most| 2 * pairs > *most) {
            let rule = format!("takes up to {most} contacts at once, but {pairs} pairs can have {}", 2 * pairs);
            let remedy = "take auto or pgs: a step with more contacts is not solved, and bodies fall through";
            self.warnings.push(doc.error("solver.method", rule, remedy).as_warning());
        }
        if known.is_some_and(|info| info.law == Law::Convex) && pairs > 0 {
            let rule = "solves the associated (convex) law, not Coulomb's: a contact that slides lifts off, by its friction coefficient times \
                        its sliding speed";
            let remedy = "take auto for Coulomb's law; the residuals of this run are told by Coulomb's law too";
            self.warnings.push(doc.error("solver.method", rule.to_owned(), remedy).as_warning());
        }
        let max_iterations = doc.integer("solver.max_iterations").and_then(|n| u32::try_from(n).ok());
        Some(SolverScene {
            method: self.word("solver.method")?,
            tolerance: self.number("solver.tolerance")?,
            max_iterations: self.need("solver.max_iterations", max_iterations)?,
            require_convergence: doc.flag("solver.require_convergence").unwrap_or(false),
        })
    }
}

/// Names in a message, the first of them where there are many.
fn listed(names: &[&str]) -> String {
    const MOST: usize = 20;
    match names.get(..MOST) {
        Some(first) if names.len() > MOST => format!("{} and {} more", first.join(", "), names.len() - MOST),
        _ => names.join(", "),
    }
}
