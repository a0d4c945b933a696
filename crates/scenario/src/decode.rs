//! Decodes the text of a scene file to a [`Document`], by the rules of [`teeter_text::decode`].

use crate::diagnostic::Diagnostics;
use crate::document::Document;
use crate::keys::SCENE;

pub use teeter_text::decode::LARGEST_FILE;
pub(crate) use teeter_text::decode::{Decoded, ParsedText, in_order};

/// Reads a scene. `file` is its name in messages; each of `sets` is a key's path and a value that
/// takes precedence over the file.
///
/// The text may start with a byte order mark and may have Windows line ends. The value of a setting
/// is parsed as TOML if possible, otherwise taken as text: `("time.step", "50 us")` needs no inner
/// quotes.
///
/// ```
/// use teeter_scenario::decode;
/// let text = "
/// [time]
/// end = '0.5 s'
/// step = '100 us'
/// ";
/// let sets = [("time.step".to_owned(), "50 us".to_owned())];
/// let scene = decode::parse(text, "scene.toml", &sets).unwrap();
/// assert_eq!(scene.quantity("time.step"), Some(5e-5));
/// assert_eq!(scene.number("time.theta"), Some(0.5)); // the default
///
/// let errors = decode::parse("[time]\nend = '0.5 kg'", "scene.toml", &[]).unwrap_err();
/// assert_eq!(errors.0.len(), 2); // a wrong unit and a missing step
/// ```
///
/// # Errors
/// Everything wrong in the file and the settings, in the order of the file (limited to some
/// hundreds of findings).
pub fn parse(source: &str, file: &str, sets: &[(String, String)]) -> Result<Document, Diagnostics> {
    teeter_text::decode::parse(&SCENE, source, file, sets)
}

/// Parses the text of a scene.
pub(crate) fn parsed(source: &str, file: &str) -> ParsedText {
    ParsedText::new(&SCENE, source, file)
}

/// The text of a file's bytes.
///
/// # Errors
/// There are too many bytes, or they are not UTF-8; the message names the first wrong one.
pub fn text<'a>(bytes: &'a [u8], file: &str) -> Result<&'a str, Diagnostics> {
    teeter_text::decode::text(&SCENE, bytes, file)
}
