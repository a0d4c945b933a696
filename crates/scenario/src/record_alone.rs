//! A record by itself, with the corrections that a scene would make.

use crate::diagnostic::Diagnostics;
use crate::resolve::ReadFile;
use crate::scene::RecordScene;
use std::sync::Arc;

/// The table whose keys are meant.
const MOTION: &str = "ground.motion.x";

/// A scene with nothing in it but a block far from its ground, so that what decodes scenes also
/// decodes the keys of a record.
const SCENE: &str = "[time]\nend = '1 s'\nstep = '1 ms'\n[world]\ngravity = '0 m/s^2'\n[ground]\n\
    [material.m]\ndensity = '1 kg/m^3'\n\
    [block.b]\nmaterial = 'm'\nwidth = '1 m'\nheight = '1 m'\ndepth = '1 m'\nposition = ['0 m', '9 m']\n";

/// Reads a record as `ground.motion.x` of a scene does: `keys` are those of a recorded motion
/// (`unit`, `from`, `baseline` and so on), with values as for `--set`, applied in the order of
/// `docs/signals.md`. `file` is its name in messages, `bytes` its content.
///
/// ```
/// let keys = [("scale".to_owned(), "2".to_owned())];
/// let read = teeter_scenario::record_alone("quake.csv", b"t,a\n0,0.5\n0.1,-1\n", &keys).unwrap();
/// assert_eq!(read.record.peak_acceleration(), 2.0);
///
/// let keys = [("taper".to_owned(), "0.7".to_owned())];
/// let wrong = teeter_scenario::record_alone("quake.csv", b"0,0.5\n0.1,-1\n", &keys).unwrap_err();
/// assert!(wrong.to_string().contains("taper"));
/// ```
///
/// # Errors
/// What is wrong with the file or the keys; the path of a finding is that of its key alone.
pub fn record_alone(file: &str, bytes: &[u8], keys: &[(String, String)]) -> Result<Arc<RecordScene>, Diagnostics> {
    let own = [(format!("{MOTION}.record"), "'record'".to_owned())];
    let sets: Vec<_> =
        own.into_iter().chain(keys.iter().map(|(key, value)| (format!("{MOTION}.{key}"), value.clone()))).collect();
    let mut read: Box<ReadFile<'_>> = Box::new(|_| Ok(bytes.to_vec()));
    let about_record = |mut found: Diagnostics| {
        for finding in &mut found.0 {
            if let Some(key) = finding.path.strip_prefix(MOTION) {
                finding.path = key.trim_start_matches('.').to_owned();
            }
            // The name of the file stands beside every finding.
            if finding.path == "record" {
                (finding.path, finding.written) = (String::new(), None);
            }
            finding.file = file.to_owned();
            (finding.set, finding.position, finding.span) = (None, None, None);
        }
        found
    };
    let resolved = crate::load_with(SCENE.as_bytes(), file, "record", &sets, read.as_mut()).map_err(about_record)?;
    let record = resolved.scene.records().next().cloned();
    record.ok_or_else(|| crate::diagnostic::Diagnostic::error(file, "holds no record").into())
}
