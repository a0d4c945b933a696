//! Statistics of ensembles: fragility curves, and the comparison of two distributions.

mod chi_squared;
mod fragility;
mod kolmogorov_smirnov;
mod normal;
mod resample;

pub use fragility::{LognormalFit, Misfit, NoFit, Observation};
pub use kolmogorov_smirnov::{KolmogorovSmirnov, share_at_most};
pub use normal::normal_probability;
pub(crate) use resample::{interval, resamples};
