//! The file of a checkpoint or of a state.

use super::{CheckpointError, Identity, Moment};
use crate::{export, page, recorder};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::io::Read;
use std::path::Path;
use teeter_integrator::State;

/// Version of the format. Whatever changes the bytes of a [`Moment`] is a new one; the test below knows.
pub const VERSION: u32 = 18;

const MAGIC: [u8; 8] = *b"teeterCP";

/// Bytes before the body.
const PREFIX: usize = 24;

/// What every file has.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Head<'a> {
    pub(crate) identity: Cow<'a, Identity>,
    pub(crate) moment: Moment,
    /// Whether the rest follows.
    pub(crate) whole: bool,
}

/// What decides the rest of a run's files, beside program, scene and options.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Rest<'a> {
    pub(crate) state: Cow<'a, State>,
    /// Time that the steps took so far, s.
    pub(crate) seconds: f64,
    /// Bytes of the tables, in the order of [`recorder::TABLES`].
    pub(crate) tables: [u64; recorder::TABLES.len()],
    pub(crate) recorder: Cow<'a, recorder::Kept>,
    pub(crate) page: Cow<'a, page::Kept>,
    pub(crate) export: Option<Cow<'a, export::Kept>>,
}

/// A checkpoint, read.
#[derive(Debug)]
pub struct Checkpoint {
    pub(crate) rest: Rest<'static>,
}

impl Checkpoint {
    /// The state to go on from.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.rest.state
    }

    pub(super) fn read(path: &Path, identity: &Identity) -> Result<Self, CheckpointError> {
        let bytes = read(path, "checkpoint")?;
        let body = opened(&bytes, path, "checkpoint")?;
        let (head, rest) = head(body, path)?;
        identity.admit(&head.identity, path)?;
        if !head.whole {
            return Err(CheckpointError::Foreign { path: path.to_owned(), wanted: "checkpoint" });
        }
        match postcard::take_from_bytes::<Rest<'static>>(rest) {
            Ok((rest, [])) => Ok(Self { rest }),
            _ => Err(unreadable(path)),
        }
    }
}

impl Moment {
    /// The moment of a checkpoint or of a state that was written by any program of the same version of the format.
    ///
    /// # Errors
    /// If the file can't be read, is of another kind or version, or is damaged.
    pub fn read(path: &Path) -> Result<Self, CheckpointError> {
        let bytes = read(path, "state or checkpoint")?;
        let body = opened(&bytes, path, "state or checkpoint")?;
        Ok(head(body, path)?.0.moment)
    }
}

fn head<'a>(body: &'a [u8], path: &Path) -> Result<(Head<'static>, &'a [u8]), CheckpointError> {
    postcard::take_from_bytes(body).map_err(|_| unreadable(path))
}

/// The sum is right, so it was written like this.
fn unreadable(path: &Path) -> CheckpointError {
    let what = "it is laid out in another way than this program expects, though of the same version".to_owned();
    CheckpointError::Damaged { path: path.to_owned(), what }
}

/// A file of ours; of one that isn't, no more than shows that.
fn read(path: &Path, wanted: &'static str) -> Result<Vec<u8>, CheckpointError> {
    let failed = |source| CheckpointError::Read { path: path.to_owned(), source };
    let data = std::fs::metadata(path).map_err(failed)?;
    if data.is_dir() {
        return Err(failed(std::io::ErrorKind::IsADirectory.into()));
    }
    // A pipe would be waited for.
    if !data.is_file() {
        return Err(CheckpointError::Foreign { path: path.to_owned(), wanted });
    }
    let mut file = std::fs::File::open(path).map_err(failed)?;
    let mut bytes = Vec::new();
    file.by_ref().take(PREFIX as u64).read_to_end(&mut bytes).map_err(failed)?;
    if let Ok(prefix) = <&[u8; PREFIX]>::try_from(bytes.as_slice()) {
        let (length, found) = (body_length(prefix, path, wanted)?, data.len().saturating_sub(PREFIX as u64));
        if length != found {
            return Err(wrong_length(path, found, length));
        }
        file.take(length).read_to_end(&mut bytes).map_err(failed)?;
    }
    Ok(bytes)
}

fn wrong_length(path: &Path, found: u64, wanted: u64) -> CheckpointError {
    let what = format!("its body holds {found} bytes, and should hold {wanted}");
    CheckpointError::Damaged { path: path.to_owned(), what }
}

/// The bytes of a file into `file`, which is cleared first.
pub(crate) fn sealed(file: Vec<u8>, head: &Head<'_>, rest: Option<&Rest<'_>>) -> Result<Vec<u8>, postcard::Error> {
    let mut file = file;
    file.clear();
    file.extend(MAGIC);
    file.extend(VERSION.to_le_bytes());
    file.resize(PREFIX, 0);
    let mut file = postcard::to_extend(head, file)?;
    if let Some(rest) = rest {
        file = postcard::to_extend(rest, file)?;
    }
    let (length, sum) = ((file.len() - PREFIX) as u64, crc32fast::hash(&file[PREFIX..]));
    file[12..20].copy_from_slice(&length.to_le_bytes());
    file[20..24].copy_from_slice(&sum.to_le_bytes());
    Ok(file)
}

/// How many bytes follow the prefix, as it says.
fn body_length(prefix: &[u8; PREFIX], path: &Path, wanted: &'static str) -> Result<u64, CheckpointError> {
    if !prefix.starts_with(&MAGIC) {
        return Err(CheckpointError::Foreign { path: path.to_owned(), wanted });
    }
    let mut version = [0; 4];
    version.copy_from_slice(&prefix[8..12]);
    let found = u32::from_le_bytes(version);
    if found != VERSION {
        return Err(CheckpointError::Version { path: path.to_owned(), found });
    }
    let mut length = [0; 8];
    length.copy_from_slice(&prefix[12..20]);
    Ok(u64::from_le_bytes(length))
}

/// The body of a file that is whole.
fn opened<'a>(bytes: &'a [u8], path: &Path, wanted: &'static str) -> Result<&'a [u8], CheckpointError> {
    let damaged = |what: String| CheckpointError::Damaged { path: path.to_owned(), what };
    // A prefix of the word is a file cut off early, anything else is not ours.
    if !bytes.starts_with(&MAGIC[..bytes.len().min(MAGIC.len())]) {
        return Err(CheckpointError::Foreign { path: path.to_owned(), wanted });
    }
    let Some((prefix, body)) = bytes.split_first_chunk::<PREFIX>() else {
        return Err(damaged(format!("it ends after {} bytes", bytes.len())));
    };
    let length = body_length(prefix, path, wanted)?;
    if length != body.len() as u64 {
        return Err(wrong_length(path, body.len() as u64, length));
    }
    if crc32fast::hash(body).to_le_bytes() != prefix[20..24] {
        return Err(damaged("its check sum is wrong".to_owned()));
    }
    Ok(body)
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_detect::ContactId;
    use teeter_integrator::{Memory, Vector, WarmStart};

    fn file() -> Vec<u8> {
        let mut warm = WarmStart::default();
        warm.push(ContactId::new(0, 1), &Vector::<2>::new(0.5, -0.25));
        let mut memory = Memory::default();
        memory.set_numbers(&[7.0]);
        let moment = Moment {
            scheme: "moreau-jean".to_owned(),
            step: 300,
            t: 0.03,
            dt: 1e-4,
            bodies: vec![("rocker".to_owned(), 3)],
            contacts: vec!["feet".to_owned()],
            q: vec![1.0, -0.0, f64::MIN_POSITIVE],
            v: vec![f64::NEG_INFINITY, f64::from_bits(0x7ff8_0000_0000_0001), 5e-324],
            memory,
            warm,
        };
        let identity = Identity::new([7; 32], "title = \"t\"\n", &[], "");
        sealed(Vec::new(), &Head { identity: Cow::Owned(identity), moment, whole: false }, None).unwrap()
    }

    fn path() -> &'static Path {
        Path::new("c.bin")
    }

    #[test]
    fn every_bit_of_a_number_comes_back() {
        let file = file();
        let (read, rest) = head(opened(&file, path(), "state").unwrap(), path()).unwrap();
        assert!(rest.is_empty());
        let bits = |x: &[f64]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&read.moment.q), bits(&[1.0, -0.0, f64::MIN_POSITIVE]));
        assert_eq!(bits(&read.moment.v), [f64::NEG_INFINITY.to_bits(), 0x7ff8_0000_0000_0001, 1]);
        assert_eq!(read.moment.warm.impulse(ContactId::new(0, 1)), Some(Vector::<2>::new(0.5, -0.25)));
        assert_eq!(read.moment.memory.numbers(), Some([7.0]));
    }

    #[test]
    fn a_file_cut_off_anywhere_or_with_a_bit_flipped_is_refused() {
        let file = file();
        for length in 0..file.len() {
            assert!(opened(&file[..length], path(), "state").is_err(), "{length} bytes");
        }
        for k in 0..8 * file.len() {
            let mut flipped = file.clone();
            flipped[k / 8] ^= 1 << (k % 8);
            assert!(opened(&flipped, path(), "state").is_err(), "bit {k}");
        }
        let mut longer = file.clone();
        longer.push(0);
        assert!(opened(&longer, path(), "state").is_err());
    }

    #[test]
    fn a_large_file_of_another_kind_is_not_read_to_its_end() {
        let path = std::env::temp_dir().join(format!("teeter-large-{}.bin", std::process::id()));
        let large = std::fs::File::create(&path).unwrap();
        // Sparse: it takes no room on disk, but would take 100 GB of memory.
        large.set_len(100_000_000_000).unwrap();
        assert!(matches!(read(&path, "state"), Err(CheckpointError::Foreign { .. })));
        let mut prefix = file()[..PREFIX].to_vec();
        std::fs::write(&path, &prefix).unwrap();
        std::fs::File::options().write(true).open(&path).unwrap().set_len(100_000_000_000).unwrap();
        assert!(matches!(read(&path, "state"), Err(CheckpointError::Damaged { .. })));
        prefix[12..20].copy_from_slice(&u64::MAX.to_le_bytes());
        std::fs::write(&path, &prefix).unwrap();
        assert!(matches!(read(&path, "state"), Err(CheckpointError::Damaged { .. })));
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn the_page_on_long_runs_names_the_version() {
        let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/long-runs.md");
        let text = std::fs::read_to_string(page).unwrap();
        assert!(text.contains(&format!("reads and writes version {VERSION}.")));
    }

    /// If this fails, files written before can no longer be read: make [`VERSION`] one larger, then put the new numbers here.
    #[test]
    fn the_format_is_that_of_its_version() {
        let file = file();
        assert_eq!((VERSION, file.len(), crc32fast::hash(&file)), (18, 228, 1_179_070_470));
    }
}
