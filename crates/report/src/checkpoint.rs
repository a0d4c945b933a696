//! Checkpoints of a run, and states that another run can start from.
//!
//! A file is whole or not there (it is written under another name first), and says what it is before anything of it is
//! believed:
//!
//! ```text
//! "teeterCP"   what it is
//! u32          version of this format
//! u64          length of the body
//! u32          CRC-32 of the body
//! body         head, and for a checkpoint the rest, in the postcard format (https://postcard.jamesmunns.com/wire-format)
//! ```
//!
//! The head holds who wrote it for what ([`Identity`]) and the motion at that moment ([`Moment`]): enough to start another
//! run from. The rest is all else that decides the files of the run, and is good for the same program and scene only.

mod error;
mod file;
mod find;
mod identity;
mod moment;

pub use error::CheckpointError;
pub use file::{Checkpoint, VERSION};
pub use find::Found;
pub use identity::{Identity, content_hash, program_hash};
pub use moment::Moment;

pub(crate) use file::{Head, Rest, sealed};

/// The checkpoint's name in the folder of a run.
pub const CHECKPOINT: &str = "checkpoint.bin";
