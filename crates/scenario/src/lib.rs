//! Scene files of teeter: TOML with units, read against one table of keys.
//!
//! [`decode::parse`] takes the text of a scene file and returns a [`document::Document`]: every
//! value by its path, in SI units, with the defaults filled in, or all that is wrong as
//! [`diagnostic::Diagnostics`] that point into the file. What a scene may say stands in one place,
//! [`keys::TABLES`]. [`resolve::resolve`] makes it a [`scene::Scene`], and
//! [`simulation::Simulation`] a model with its start, ready to run in memory.
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

mod carrier;
pub mod decode;
pub mod deflection;
mod doubts;
mod driven;
mod faults;
mod fineness;
mod flexibility;
mod idle;
pub mod keys;
mod layout;
mod left_out;
mod meeting;
pub mod mesh_error;
mod opening;
pub mod outlook;
mod overlap;
mod placement;
pub mod record;
mod required;
pub mod resolve;
mod rocking;
pub mod scene;
mod settling;
pub mod simulation;
mod stability;
pub mod swing;
mod table;
pub mod volume;
pub mod wording;
mod words;

pub use teeter_text::{diagnostic, dimension, document, measure, quantity, source, suggest, units, value};

pub use carrier::Carrier;
pub use fineness::FAR_TURN;
pub use left_out::left_out;
pub use meeting::{Meeting, Shapes};
pub use opening::OPEN_GAP;
pub use placement::{Departure, PlacementError};
pub use required::{Extent, Limits, Removed, Required};
pub use settling::{ContactForce, StaticStart};

/// Reads a scene: text, keys, units, references. `file` is its name in messages, `stem` its title
/// if it has none, `sets` are overrides by path. A scene that names other files is refused: see
/// [`load_with`].
///
/// # Errors
/// All that is wrong with it, at once.
pub fn load(
    bytes: &[u8],
    file: &str,
    stem: &str,
    sets: &[(String, String)],
) -> Result<resolve::Resolved, diagnostic::Diagnostics> {
    load_with(bytes, file, stem, sets, &mut |_| Err("no other file can be read here".to_owned()))
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
    let decode::Decoded { document, mut found, whole } = decode::decode(decode::text(bytes, file)?, file, sets);
    if !found.has_errors() {
        return resolve::resolve(document, stem, read).map_err(|mut found| {
            decode::in_order(&mut found, sets);
            found
        });
    }
    // Not where a part could not be read: it may be what the rest refers to.
    if whole {
        found.0.extend(resolve::mistakes(&document, read));
        decode::in_order(&mut found, sets);
    }
    Err(found)
}
