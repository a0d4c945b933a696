//! Resolves a decoded document to a scene: references, mutually exclusive keys, consistency of
//! values.

mod beam_output;
mod beams;
mod blocks;
mod contacts;
mod crowd;
mod faces;
mod ground;
mod jitter;
mod made_of_signals;
mod many;
mod motions;
pub(crate) mod names;
pub use names::matches_pattern;
mod outlines;
mod parts;
mod records;
mod sections;
mod shape;
mod shared;
mod signals;
mod supports;
mod timing;

use names::BlockName;
use std::collections::{BTreeMap, BTreeSet};

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::dimension::Dimension;
use crate::document::{Document, SettingsRead};
use crate::scene::{
    AngleUnit, BlockTables, ContactScene, Display, LengthUnit, Scene, SolverScene, SupportingBody, Time, most_used,
};
use crate::scene_checks;
use crate::value::Value;
use crate::words::Word;
use crate::{output_size, quantity, wording};
use teeter_contact::Law;
use teeter_solvers::SOLVERS;

use parts::SceneParts;
pub(crate) use shared::LastScene;
pub use shared::{SharedCounts, SharedParts};
pub use timing::MAX_STEPS;

/// A resolved scene with its findings.
#[derive(Debug, Clone)]
pub struct Resolved {
    /// The scene.
    pub scene: Scene,
    /// The document with every default filled in.
    pub document: Document,
    /// Warnings: what looks wrong but can be run.
    pub warnings: Vec<Diagnostic>,
    /// Predicted warnings that a run measures and gives itself; for use without a run.
    pub foreseen: Vec<Diagnostic>,
    /// Notes: information; nothing is wrong.
    pub notes: Vec<Diagnostic>,
    /// The files named by the scene, by the path in the scene, with their bytes as read.
    pub files: Vec<(String, Vec<u8>)>,
}

/// Reads a file named by a scene, by the path in the scene; an error is the end of a message that
/// says why it can't be read.
pub type ReadFile<'a> = dyn FnMut(&str) -> Result<Vec<u8>, String> + 'a;

/// Resolves a document; `stem` is the title of a scene that has none.
///
/// # Errors
/// All errors at once.
pub fn resolve(mut document: Document, stem: &str, read: &mut ReadFile<'_>) -> Result<Resolved, Diagnostics> {
    let mut resolver = Resolver::new(&document, false, read);
    let scene = resolver.scene(stem);
    resolver.report_unheld(scene.as_ref());
    let (mut errors, mut warnings, files) = (resolver.errors, resolver.warnings, resolver.files);
    match scene {
        Some(scene) if errors.is_empty() => {
            let derived = [
                ("title", Value::Text(scene.title.clone())),
                ("time.gap_tolerance", Value::Number(scene.time.gap_tolerance)),
                // The written scene is in SI units, which would tell it nothing of the user's.
                ("output.length_unit", Value::Text(scene.display.length.word().to_owned())),
                ("output.angle_unit", Value::Text(scene.display.angle.word().to_owned())),
            ];
            for (path, value) in derived {
                if !document.has(path)
                    && let Err(error) = document.set(path, value)
                {
                    errors.push(document.error(path, error.to_string(), "give the key in the scene"));
                }
            }
            if let Some(every) = scene.every.filter(|_| !document.is_given("output.every"))
                && let Err(error) = document.set("output.every", Value::Number(every))
            {
                errors.push(document.error("output.every", error.to_string(), "give the key in the scene"));
            }
            // The written scene names the chosen scheme, so that running it gives the same result.
            if document.text("time.scheme") != Some(scene.time.scheme.word())
                && let Err(error) = document.set("time.scheme", Value::Text(scene.time.scheme.word().to_owned()))
            {
                errors.push(document.error("time.scheme", error.to_string(), "name a scheme in the scene"));
            }
            // A default without effect is not written, as it would look intended.
            if !scene.time.scheme.predicts() {
                document.forget_default("time.activation_gamma");
            }
            if errors.is_empty() {
                let findings = scene_checks::check(&scene, &document);
                warnings.extend(findings.warnings);
                let (foreseen, mut notes) = (findings.foreseen, findings.notes);
                notes.extend(fewer_rows(&scene, &document));
                notes.extend(blocks_in_rows(&scene, &document));
                return Ok(Resolved { scene, document, warnings, foreseen, notes, files });
            }
        }
        _ => {}
    }
    let mut diagnostics = Diagnostics(errors);
    diagnostics.sort();
    Err(diagnostics)
}

/// The scene of a document alone, as [`resolve`] finds it: without what only a written document needs, and without warnings,
/// which take longer than the scene itself. `shared` has records of the same files.
pub(crate) fn scene(
    last: &mut LastScene,
    stem: &str,
    shared: &SharedParts,
    read: &mut ReadFile<'_>,
) -> Result<Scene, Diagnostics> {
    scene_of(last, stem, shared, read).map(|(scene, _)| scene)
}

/// As [`scene`], with its warnings.
pub(crate) fn scene_with_warnings(
    last: &mut LastScene,
    stem: &str,
    shared: &SharedParts,
    read: &mut ReadFile<'_>,
) -> Result<(Scene, Vec<Diagnostic>), Diagnostics> {
    scene_of(last, stem, shared, read).map(|(scene, mut warnings)| {
        warnings.extend(scene_checks::warnings(&scene, &last.document, &shared.measures));
        (scene, warnings)
    })
}

/// The scene, and the warnings that come with its making.
fn scene_of(
    last: &mut LastScene,
    stem: &str,
    shared: &SharedParts,
    read: &mut ReadFile<'_>,
) -> Result<(Scene, Vec<Diagnostic>), Diagnostics> {
    let LastScene { document, parts } = last;
    let mut resolver = Resolver::new(document, false, read);
    (resolver.shared, resolver.parts) = (Some(shared), Some(parts));
    let scene = resolver.scene(stem);
    resolver.report_unheld(scene.as_ref());
    match scene {
        Some(scene) if resolver.errors.is_empty() => Ok((scene, resolver.warnings)),
        _ => {
            let mut diagnostics = Diagnostics(resolver.errors);
            diagnostics.sort();
            Err(diagnostics)
        }
    }
}

/// Errors about several keys in a document of which some values were already refused; these are not
/// reported again.
pub(crate) fn mistakes(document: &Document, read: &mut ReadFile<'_>) -> Vec<Diagnostic> {
    let mut resolver = Resolver::new(document, true, read);
    let scene = resolver.scene("");
    resolver.report_unheld(scene.as_ref());
    resolver.errors
}

impl Resolved {
    /// The scene with a step (s) instead of the accuracy for which it was found.
    ///
    /// # Errors
    /// All errors of the scene with that step.
    pub fn with_step(self, step: f64) -> Result<Self, Diagnostics> {
        let Self { mut document, files, scene, .. } = self;
        document.leave_out("time.accuracy");
        if let Err(error) = document.set("time.step", Value::Number(step)) {
            let remedy = "give a step instead of the accuracy";
            return Err(document.error("time.accuracy", error.to_string(), remedy).into());
        }
        // Defaults without effect were left out, but are still read.
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
    /// The files read so far.
    files: Vec<(String, Vec<u8>)>,
    /// Records of earlier scenes.
    shared: Option<&'a SharedParts>,
    /// Those of the last scene of this document, whose place is taken by those of this one.
    parts: Option<&'a mut SceneParts>,
    doc: &'a Document,
    /// Whether values are missing for which there is already a message.
    partial: bool,
    beams: BTreeMap<&'a str, usize>,
    block_names: Vec<BlockName>,
    /// The numbers of blocks by their names.
    blocks: BTreeMap<String, usize>,
    /// The settings on which names depend, by numbers of copies.
    of_names: SettingsRead,
    signals: BTreeMap<&'a str, usize>,
    errors: Vec<Diagnostic>,
    warnings: Vec<Diagnostic>,
    /// Beams with a static start that their supports don't hold.
    unheld: Vec<Unheld>,
}

/// A beam with a static start that only blocks under it may hold, and what is wrong if there are
/// none.
#[derive(Debug, Clone)]
struct Unheld {
    beam: String,
    rule: String,
    remedy: String,
}

impl<'a, 'f> Resolver<'a, 'f> {
    fn new(doc: &'a Document, partial: bool, read: &'f mut ReadFile<'f>) -> Self {
        let numbered = |group| doc.names(group).into_iter().zip(0..).collect();
        let (block_names, of_names) = doc.settings_read(|| BlockName::all(doc));
        let mut errors = Vec::new();
        let copies = |key: &str| doc.integer(key).and_then(|count| u64::try_from(count).ok()).unwrap_or(1);
        for table in doc.names("block") {
            let [count, rows] = ["count", "rows"].map(|key| copies(&format!("block.{table}.repeat.{key}")));
            if count * rows > names::MOST_COPIES as u64 {
                let rule = format!("{rows} rows of {count} blocks are more than {}, the limit", names::MOST_COPIES);
                errors.push(doc.error(&format!("block.{table}.repeat.rows"), rule, "use fewer rows or shorter ones"));
            }
        }
        let blocks = names::numbered(&block_names, |block| {
            let rule = format!("there are two blocks `{}`: one from its own table, one from repeat", block.name);
            errors.push(doc.error(&format!("block.{}", block.table), rule, "give one of them another name"));
        });
        Self {
            read,
            files: Vec::new(),
            shared: None,
            parts: None,
            doc,
            partial,
            beams: numbered("beam"),
            block_names,
            blocks,
            of_names,
            signals: numbered("signal"),
            errors,
            warnings: Vec::new(),
            unheld: Vec::new(),
        }
    }

    fn error(&mut self, path: &str, rule: impl Into<String>, remedy: impl Into<String>) {
        self.errors.push(self.doc.error(path, rule, remedy));
    }

    /// A value that the decoder guarantees unless it has refused it; otherwise its absence is a bug
    /// in the table of keys, and reported as such.
    fn required<T>(&mut self, path: &str, value: Option<T>) -> Option<T> {
        if value.is_none() && !self.partial {
            self.error(path, "missing key", "add it");
        }
        value
    }

    fn quantity(&mut self, path: &str) -> Option<f64> {
        let value = self.doc.quantity(path);
        self.required(path, value)
    }

    fn number(&mut self, path: &str) -> Option<f64> {
        let value = self.doc.number(path);
        self.required(path, value)
    }

    fn pair(&mut self, path: &str) -> Option<[f64; 2]> {
        let value = self.doc.pair(path);
        self.required(path, value)
    }

    fn word(&mut self, path: &str) -> Option<String> {
        let value = self.doc.text(path).map(str::to_owned);
        self.required(path, value)
    }

    /// The choice made by the word of a key.
    fn choice<W: Word>(&mut self, path: &str) -> Option<W> {
        let word = self.word(path)?;
        let bodies_matching = W::of(&word);
        if bodies_matching.is_none() {
            let words: Vec<&str> = W::ALL.iter().map(|(word, _)| *word).collect();
            self.error(path, format!("`{word}` is not a valid word"), format!("choose one of {}", words.join(", ")));
        }
        bodies_matching
    }

    fn scene(&mut self, stem: &str) -> Option<Scene> {
        let doc = self.doc;
        let title = doc.text("title").unwrap_or(stem).to_owned();
        let gravity = self.pair("world.gravity");
        // Each part is resolved even if others have failed, so that all errors are found.
        let (signals, of_signals) = self.scene_part(|held| &mut held.signals, &[], Self::all_signals);
        let (ground, _) = self.scene_part(|held| &mut held.ground, &[&of_signals], |this| this.ground(&signals));
        let (beams, of_beams) =
            self.scene_part(|held| &mut held.beams, &[&of_signals], |this| this.all_beams(&signals));
        let ((contacts, joined, crowd), of_contacts) = self.scene_part(|held| &mut held.contacts, &[], Self::contacts);
        self.contacts_fit_memory(&contacts);
        let (shapes, of_shapes) = self.scene_part(|held| &mut held.shapes, &[], Self::block_shapes);
        let (placements, of_placements) = self.scene_part(
            |held| &mut held.placements,
            &[&of_shapes, &of_contacts],
            |this| this.placements(&shapes, &contacts, &joined),
        );
        let (blocks, _) = self.scene_part(
            |held| &mut held.blocks,
            &[&of_placements, &of_beams, &of_contacts, &of_signals],
            |this| this.all_blocks(&shapes, placements, &beams, &contacts, &signals),
        );
        self.check_support_cycles(&blocks);
        self.feet_are_sharp(&ground, &contacts, &blocks);
        self.check_contacts_can_move(&blocks, &contacts);
        self.check_crowd(crowd.as_ref(), &blocks, &beams);
        self.check_static_starts_beside_profile(&ground, &beams, &blocks, &contacts);
        let (forces, _) = self.scene_part(
            |held| &mut held.forces,
            &[&of_signals],
            |this| doc.names("force").into_iter().map(|name| this.force(name, &signals)).collect(),
        );
        let (loads, _) = self.scene_part(
            |held| &mut held.loads,
            &[&of_beams, &of_signals],
            |this| doc.names("load").into_iter().map(|name| this.load(name, &beams, &signals)).collect(),
        );
        if self.blocks.is_empty() && self.beams.is_empty() && !self.partial {
            self.error("block", "the scene has no bodies", "add a [block.NAME] or a [beam.NAME]");
        }
        let (time, _) =
            self.scene_part(|held| &mut held.time, &[&of_shapes, &of_beams], |this| this.time(&shapes, &beams));
        if let Some(time) = &time {
            self.check_contact_laws(time.scheme, &contacts, crowd.as_ref(), &beams);
            self.check_table_covers_run(&signals, time.steps() as f64 * time.step);
        }
        let solver = self.solver();
        let thinned = |time: &Time| output_size::thinned(self.block_names.len(), time.steps(), time.step);
        let every = doc.quantity("output.every").or_else(|| time.as_ref().and_then(thinned));
        let block_tables = self.block_tables();
        let mut scene = Scene {
            title,
            time: time?,
            gravity: gravity?,
            ground: ground?,
            beams: beams.into_iter().collect::<Option<_>>()?,
            blocks: blocks.into_iter().collect::<Option<_>>()?,
            contacts: contacts.into_iter().collect::<Option<_>>()?,
            crowd,
            signals: signals.into_iter().collect::<Option<_>>()?,
            forces: forces.into_iter().collect::<Option<_>>()?,
            loads: loads.into_iter().collect::<Option<_>>()?,
            solver: solver?,
            every,
            block_tables,
            display: self.display(),
        };
        self.faces(&mut scene);
        self.output(&scene);
        Some(scene)
    }

    /// In which tables the motions of blocks are.
    fn block_tables(&mut self) -> BlockTables {
        const KEY: &str = "output.blocks";
        let doc = self.doc;
        let Some(patterns) = doc.words(KEY) else { return BlockTables::of(self.block_names.len()) };
        let mut chosen = BTreeSet::new();
        for pattern in patterns {
            let Some(found) = self.bodies_matching(KEY, pattern) else { continue };
            let blocks = found.iter().filter_map(|(_, body)| match body {
                SupportingBody::Block(block) => Some(*block),
                SupportingBody::Beam(_) | SupportingBody::Ground => None,
            });
            let blocks: Vec<usize> = blocks.collect();
            if blocks.is_empty() {
                let rule = format!("`{pattern}` is no block");
                self.error(KEY, rule, "name blocks: what beams have in tables is told by their own keys");
            }
            chosen.extend(blocks);
        }
        BlockTables::Chosen(chosen.into_iter().collect())
    }

    /// How the run is shown: in the units that the scene itself uses most, unless it names others.
    fn display(&self) -> Display {
        let doc = self.doc;
        let named = |path: &str| doc.text(path);
        let default = Display::default();
        let find = || (most_used(doc.source(), &LengthUnit::ALL), most_used(doc.source(), &AngleUnit::ALL));
        let most_used_units = || self.shared.map_or_else(find, |shared| shared.units(find));
        let length = match named("output.length_unit") {
            Some(word) => LengthUnit::ALL.iter().find(|(known, _)| *known == word).map(|(_, unit)| *unit),
            None => most_used_units().0,
        };
        let angle = match named("output.angle_unit") {
            Some(word) => AngleUnit::ALL.iter().find(|(known, _)| *known == word).map(|(_, unit)| *unit),
            None => most_used_units().1,
        };
        Display {
            figure_width: doc.quantity("output.figure_width").unwrap_or(default.figure_width),
            length: length.unwrap_or(default.length),
            angle: angle.unwrap_or(default.angle),
        }
    }

    /// The bytes of a file named by the scene; each file is read once.
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
        self.material_named(&path, &name)
    }

    /// The table of the material with this name, which is given at `path`.
    fn material_named(&mut self, path: &str, name: &str) -> Option<String> {
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
        let near = crate::suggest::nearest(name, known).map(str::to_owned);
        self.error(path, format!("the material `{name}` is not defined"), remedy);
        self.suggest(near);
        None
    }

    /// Adds a suggestion to the last error.
    fn suggest(&mut self, near: Option<String>) {
        if let Some(last) = self.errors.last_mut() {
            last.did_you_mean = near;
        }
    }

    /// The body with this name that a block can touch, except blocks.
    fn surface(&self, name: &str) -> Option<SupportingBody> {
        if name == "ground" {
            return self.doc.has_table("ground").then_some(SupportingBody::Ground);
        }
        self.beams.get(name).copied().map(SupportingBody::Beam)
    }

    /// The body with this name that a block can stand on.
    fn support(&self, name: &str) -> Option<SupportingBody> {
        self.surface(name).or_else(|| self.blocks.get(name).copied().map(SupportingBody::Block))
    }

    /// Reports a name that is not a body of the scene, unless bodies may have been lost to other
    /// errors.
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
            "the scene has no bodies".to_owned()
        } else {
            format!("bodies of the scene: {}", listed(&names))
        }
    }

    /// Refuses scenes whose dense operator would take too much memory, as the run would be killed
    /// without a message. Only contacts on beams all feel each other: those of blocks on the ground
    /// and with each other are solved by islands and by neighbours.
    fn contacts_fit_memory(&mut self, contacts: &[Option<ContactScene>]) {
        let at_beam = |contact: &&ContactScene| matches!(contact.surface, SupportingBody::Beam(_));
        let pairs = contacts.iter().flatten().filter(at_beam).count();
        let most = output_size::operator_bytes(2 * pairs);
        if most > output_size::MOST_OPERATOR_BYTES {
            let rule = format!(
                "{pairs} contacts of blocks with beams, with two corners each, need {} of memory for their operator, over the limit of {}",
                wording::bytes(most),
                wording::bytes(output_size::MOST_OPERATOR_BYTES)
            );
            self.error("contact", rule, "use fewer blocks, or separate scenes for blocks that don't interact");
        }
    }

    fn solver(&mut self) -> Option<SolverScene> {
        let doc = self.doc;
        let known = doc.text("solver.method").and_then(|name| SOLVERS.iter().find(|info| info.name == name));
        // A block rests on two corners, so three pairs can have six contacts at once.
        let pairs = doc.names("contact").len();
        if let Some(most) = known.and_then(|info| info.most_contacts).filter(|most| 2 * pairs > *most) {
            let rule = format!("solves up to {most} contacts at once, but {pairs} pairs can have {}", 2 * pairs);
            let remedy = "use auto or pgs: a step with more contacts is not solved, and bodies fall through each other";
            self.warnings.push(doc.error("solver.method", rule, remedy).as_warning());
        }
        if known.is_some_and(|info| info.law == Law::Convex) && pairs > 0 {
            let rule = "solves the associated (convex) law, not Coulomb's: a sliding contact separates, at its friction coefficient times \
                        its sliding speed";
            let remedy = "use auto for Coulomb's law; the residuals of this run are also computed for Coulomb's law";
            self.warnings.push(doc.error("solver.method", rule.to_owned(), remedy).as_warning());
        }
        let max_iterations = doc.integer("solver.max_iterations").and_then(|n| u32::try_from(n).ok());
        Some(SolverScene {
            method: self.word("solver.method")?,
            tolerance: self.number("solver.tolerance")?,
            max_iterations: self.required("solver.max_iterations", max_iterations)?,
            require_convergence: doc.flag("solver.require_convergence").unwrap_or(false),
        })
    }
}

/// Tells that rows are thinned because of the many blocks.
fn fewer_rows(scene: &Scene, document: &Document) -> Option<Diagnostic> {
    let every = scene.every.filter(|_| !document.is_given("output.every"))?;
    let contacts = if scene.crowd.is_some() { ", and contacts.csv has only contacts with an impulse" } else { "" };
    let rule = format!(
        "{} blocks, so that the tables have a row only every {}{contacts}",
        scene.blocks.len(),
        wording::seconds(every, 4)
    );
    let remedy = format!(
        "give every = \"{}\" in [output] for a row every step",
        quantity::format(scene.time.step, Dimension::TIME)
    );
    Some(document.error("output.every", rule, remedy).as_note())
}

/// Tells that the motions of so many blocks are in rows.
fn blocks_in_rows(scene: &Scene, document: &Document) -> Option<Diagnostic> {
    if !scene.block_tables.has_rows() {
        return None;
    }
    let rule = format!(
        "{} blocks, so that blocks.csv has a row for each of them at each time, and trajectory.csv has no columns of them",
        scene.blocks.len()
    );
    let name = &scene.blocks.first()?.name;
    let remedy =
        format!("give blocks = [\"{name}\"] in [output], such names or patterns, for columns of these and no rows");
    Some(document.error("output.blocks", rule, remedy).as_note())
}

/// Names in a message, only the first ones if there are many.
fn listed(names: &[&str]) -> String {
    const MOST: usize = 20;
    match names.get(..MOST) {
        Some(first) if names.len() > MOST => format!("{} and {} more", first.join(", "), names.len() - MOST),
        _ => names.join(", "),
    }
}
