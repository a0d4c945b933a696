//! Scene files of teeter: TOML with units, read against one table of keys.
//!
//! [`decode::parse`] takes the text of a scene file and returns a [`document::Document`]: every
//! value by its path, in SI units, with the defaults filled in, or all errors as
//! [`diagnostic::Diagnostics`] that point into the file. [`keys::TABLES`] defines what a scene may
//! contain. [`resolve::resolve`] turns it into a [`scene::Scene`], and [`simulation::Simulation`]
//! into a model with its initial state, ready to run in memory.
//!
//! ```
//! use teeter_scenario::simulation::Simulation;
//!
//! let text = r#"
//!     [time]
//!     end = "0.1 s"
//!     step = "1 ms"
//!     [ground]
//!     [material.wood]
//!     density = "600 kg/m^3"
//!     [block.cube]
//!     material = "wood"
//!     width = "10 cm"
//!     height = "10 cm"
//!     depth = "10 cm"
//!     position = ["0 m", "6 cm"]
//!     [contact.floor]
//!     between = ["cube", "ground"]
//!     friction = 0.4
//! "#;
//! let resolved = teeter_scenario::load(text.as_bytes(), "cube.toml", "cube", &[])?;
//! let mut simulation = Simulation::new(&resolved.scene)?;
//! simulation.run(&mut [])?;
//! assert!((simulation.state.q[1] - 0.05).abs() < 1e-3, "it has fallen on the floor");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod beam_measures;
mod build_diagnostics;
pub mod decode;
pub mod deflection;
mod driven;
mod equilibrium_key;
mod flexibility;
pub mod ground_profile;
mod held;
pub mod keys;
mod layout;
mod left_out;
mod mass_ratio;
mod meeting;
pub mod mesh_error;
pub mod number_table;
mod on_ground;
mod opening;
pub mod output_size;
mod overlap;
pub mod physical;
pub mod pile;
mod placement;
pub mod preview;
mod record_alone;
mod record_checks;
mod required;
pub mod resolve;
mod rocking;
pub mod scene;
mod scene_checks;
mod separators;
mod signal_resolution;
mod signal_table;
pub mod simulation;
mod solve_digits;
mod solver_pool;
mod stable_step;
mod static_start;
pub mod swing;
mod table;
mod tilt_reference;
mod unused_keys;
pub mod wording;
mod words;

pub use teeter_text::{diagnostic, dimension, document, measure, quantity, readable, source, suggest, units, value};

pub use left_out::left_out;
pub use meeting::{Meeting, Shapes};
pub use opening::OPEN_GAP;
pub use placement::{InstabilityMode, PlacementError};
pub use record_alone::record_alone;
pub use required::{Extent, Limits, Removed, Required};
pub use resolve::matches_pattern;
pub use signal_resolution::FAR_TURN;
pub use static_start::{ContactForce, StaticStart};
pub use tilt_reference::TiltReference;

/// Reads a scene: text, keys, units, references. `file` is its name in messages, `stem` its title
/// if it has none, `sets` are overrides by path. A scene that names other files is refused: see
/// [`load_with`].
///
/// # Errors
/// All errors at once.
pub fn load(
    bytes: &[u8],
    file: &str,
    stem: &str,
    sets: &[(String, String)],
) -> Result<resolve::Resolved, diagnostic::Diagnostics> {
    load_with(bytes, file, stem, sets, &mut |_| Err("other files can't be read here".to_owned()))
}

/// As [`load`]; `read` reads the files that the scene names.
///
/// # Errors
/// As [`load`].
pub fn load_with(
    bytes: &[u8],
    file: &str,
    stem: &str,
    sets: &[(String, String)],
    read: &mut resolve::ReadFile<'_>,
) -> Result<resolve::Resolved, diagnostic::Diagnostics> {
    ParsedScene::new(bytes, file)?.load(stem, sets, read)
}

/// The text of a scene, parsed once, to be loaded with many settings.
#[derive(Debug, Clone)]
pub struct ParsedScene(decode::ParsedText);

impl ParsedScene {
    /// Parses a scene; `file` is its name in messages.
    ///
    /// # Errors
    /// If it is not a text; all else that is wrong is found by [`Self::load`].
    pub fn new(bytes: &[u8], file: &str) -> Result<Self, diagnostic::Diagnostics> {
        Ok(Self(decode::parsed(decode::text(bytes, file)?, file)))
    }

    /// As [`load_with`].
    ///
    /// # Errors
    /// As [`load_with`].
    pub fn load(
        &self,
        stem: &str,
        sets: &[(String, String)],
        read: &mut resolve::ReadFile<'_>,
    ) -> Result<resolve::Resolved, diagnostic::Diagnostics> {
        let document = self.document(sets, read)?;
        resolve::resolve(document, stem, read).map_err(|found| in_order(found, sets))
    }

    /// What is wrong with the texts of the scene and of `sets`, each value by itself: its syntax, its unit, its range.
    #[must_use]
    pub fn errors_of_text(&self, sets: &[(String, String)]) -> diagnostic::Diagnostics {
        let decode::Decoded { mut found, .. } = self.0.decode(sets);
        found.0.retain(|finding| finding.severity == diagnostic::Severity::Error);
        found
    }

    /// The scene alone, as [`Self::load`] finds it, for a study of many of them: warnings and notes are left out, and what earlier
    /// scenes of this text and the same files have in common with it is taken from `shared`.
    ///
    /// # Errors
    /// As [`load_with`].
    pub fn scene(
        &self,
        stem: &str,
        sets: &[(String, String)],
        shared: &resolve::SharedParts,
        read: &mut resolve::ReadFile<'_>,
    ) -> Result<scene::Scene, diagnostic::Diagnostics> {
        let read = std::cell::RefCell::new(read);
        let make = || self.document(sets, &mut |path| (*read.borrow_mut())(path));
        let scene = |last: &mut _| resolve::scene(last, stem, shared, &mut |path| (*read.borrow_mut())(path));
        shared.with_document(sets, make, scene)?.map_err(|found| in_order(found, sets))
    }

    /// As [`Self::scene`], with the warnings that [`Self::load`] finds.
    ///
    /// # Errors
    /// As [`load_with`].
    pub fn scene_with_warnings(
        &self,
        stem: &str,
        sets: &[(String, String)],
        shared: &resolve::SharedParts,
        read: &mut resolve::ReadFile<'_>,
    ) -> Result<(scene::Scene, Vec<diagnostic::Diagnostic>), diagnostic::Diagnostics> {
        let read = std::cell::RefCell::new(read);
        let make = || self.document(sets, &mut |path| (*read.borrow_mut())(path));
        let scene =
            |last: &mut _| resolve::scene_with_warnings(last, stem, shared, &mut |path| (*read.borrow_mut())(path));
        shared.with_document(sets, make, scene)?.map_err(|found| in_order(found, sets))
    }

    /// The document with these settings; otherwise everything that is wrong with the scene.
    fn document(
        &self,
        sets: &[(String, String)],
        read: &mut resolve::ReadFile<'_>,
    ) -> Result<document::Document, diagnostic::Diagnostics> {
        let decode::Decoded { document, mut found, whole } = self.0.decode(sets);
        if !found.has_errors() {
            return Ok(document);
        }
        // Not if a part could not be read, as the rest may refer to it.
        if whole {
            found.0.extend(resolve::mistakes(&document, read));
            decode::in_order(&mut found, sets);
        }
        if let Some(sweep) = is_a_sweep(&found) {
            return Err(sweep.into());
        }
        Err(found)
    }
}

fn in_order(mut found: diagnostic::Diagnostics, sets: &[(String, String)]) -> diagnostic::Diagnostics {
    decode::in_order(&mut found, sets);
    found
}

/// One message instead of all that is wrong with a sweep file, read as a scene.
fn is_a_sweep(found: &diagnostic::Diagnostics) -> Option<diagnostic::Diagnostic> {
    let at = |name: &str| found.iter().find(|finding| finding.path.split('.').next() == Some(name));
    let scene = at("scene").filter(|finding| finding.set.is_none())?;
    ["grid", "zip", "random", "find", "outputs"].into_iter().find_map(at)?;
    let mut finding = scene.clone();
    finding.did_you_mean = None;
    finding.rule = "this is a sweep, not a scene: it names the scene whose keys vary".to_owned();
    finding.remedy = Some("run it with `teeter sweep`, or give the scene that it names".to_owned());
    Some(finding)
}
