//! Factors of one beam that several models share.

use super::matrix_weights;
use crate::Weights;
use std::sync::{Arc, Mutex, PoisonError};
use teeter_beam::{Backend, Beam, CholeskyError, Factor};

/// Most factors that are held: those of an equilibrium, whose weights grow from round to round, and of some step sizes.
const MOST_FACTORS: usize = 32;

/// Factors of a beam by their weights, each made once for all models that have the beam: for
/// [`BeamBody::with_factors`](super::BeamBody::with_factors). It may serve several threads. The first 32 are held; what is asked for beyond
/// them, such as parts of steps, is made by whoever asks.
#[derive(Debug)]
pub struct SharedFactors {
    beam: Arc<Beam>,
    held: Mutex<Held>,
}

#[derive(Debug, Default)]
struct Held {
    entries: Vec<(Key, Arc<Factor>)>,
    made: u64,
}

/// The bits of the weights, and how the matrix is factorised.
type Key = ([u64; 3], Backend);

impl SharedFactors {
    /// None yet.
    #[must_use]
    pub fn new(beam: Arc<Beam>) -> Self {
        Self { beam, held: Mutex::default() }
    }

    /// The beam.
    #[must_use]
    pub fn beam(&self) -> &Arc<Beam> {
        &self.beam
    }

    /// How many factors were made for it.
    #[must_use]
    pub fn made(&self) -> u64 {
        self.lock().made
    }

    /// The factor of these weights; `None` where no more are held.
    pub(super) fn of(&self, w: Weights, backend: Backend) -> Result<Option<Arc<Factor>>, CholeskyError> {
        let key = ([w.mass, w.damping, w.stiffness].map(f64::to_bits), backend);
        let find =
            |held: &Held| held.entries.iter().find(|(known, _)| *known == key).map(|(_, factor)| Arc::clone(factor));
        {
            let held = self.lock();
            let found = find(&held);
            if found.is_some() || held.entries.len() == MOST_FACTORS {
                return Ok(found);
            }
        }
        // Not locked while it is made: two threads may make the same one.
        let factor = Arc::new(self.beam.factor_with(matrix_weights(w), backend)?);
        let mut held = self.lock();
        held.made += 1;
        if held.entries.len() < MOST_FACTORS && find(&held).is_none() {
            held.entries.push((key, Arc::clone(&factor)));
        }
        Ok(Some(factor))
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Held> {
        self.held.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
