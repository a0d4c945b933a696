//! Beams, blocks and ground as subsystems: the room above the layers that know nothing of each other. Who brings bodies of his own
//! leaves its features out, and with them the layers.

#[cfg(feature = "beam")]
pub(crate) mod beam;
#[cfg(feature = "bodies")]
pub(crate) mod blocks;
#[cfg(feature = "bodies")]
pub(crate) mod ground;
#[cfg(feature = "beam")]
pub(crate) mod modal_beam;
