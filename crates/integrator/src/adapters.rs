//! Beams, blocks and ground as subsystems: the adapters above layers that know nothing of each
//! other. With bodies of your own, leave the features out, and with them the layers.

#[cfg(feature = "beam")]
pub(crate) mod beam;
#[cfg(feature = "bodies")]
pub(crate) mod blocks;
#[cfg(feature = "bodies")]
pub(crate) mod ground;
#[cfg(feature = "beam")]
pub(crate) mod modal_beam;
#[cfg(feature = "beam")]
pub(crate) mod modal_motion;
