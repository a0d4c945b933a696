//! What a world gives out for what was added to it: a handle says what it is of, so that only what can touch is joined.

use crate::SimError;
use std::sync::atomic::{AtomicU64, Ordering};

/// Who a world is: no two of one process are the same. Compared for equality and nothing else.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct WorldId(u64);

impl WorldId {
    pub(crate) fn new() -> Self {
        static MADE: AtomicU64 = AtomicU64::new(0);
        Self(MADE.fetch_add(1, Ordering::Relaxed))
    }
}

/// A block of a [`World`](crate::World).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlockHandle {
    pub(crate) world: WorldId,
    pub(crate) number: usize,
}

/// A beam of a [`World`](crate::World); it has a surface, so it serves wherever a [`SurfaceHandle`] does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BeamHandle(pub(crate) SurfaceHandle);

/// What a block can touch: a beam, the ground, or a body of your own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfaceHandle {
    pub(crate) world: WorldId,
    pub(crate) number: usize,
}

impl From<BeamHandle> for SurfaceHandle {
    fn from(beam: BeamHandle) -> Self {
        beam.0
    }
}

impl BlockHandle {
    /// Its number, if it is of this world.
    pub(crate) fn of(self, world: WorldId) -> Result<usize, SimError> {
        if self.world == world { Ok(self.number) } else { Err(SimError::OtherWorld { what: "a block" }) }
    }
}

impl SurfaceHandle {
    /// Its number, if it is of this world.
    pub(crate) fn of(self, world: WorldId) -> Result<usize, SimError> {
        if self.world == world { Ok(self.number) } else { Err(SimError::OtherWorld { what: "a surface" }) }
    }
}
