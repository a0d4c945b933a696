//! Modal reduction of a beam.

use std::sync::{Mutex, PoisonError};
use teeter_beam::{Beam, BeamSpec, ModalBasis, ModalError};

/// The modal basis of a beam.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Reduction {
    /// This number of its lowest modes, including rigid motions.
    Modes(usize),
    /// As few modes and static corrections as its static flexibility requires.
    Flexibility {
        /// Largest relative error of the flexibility in the region.
        tolerance: f64,
        /// The region, m from the left end.
        region: [f64; 2],
    },
}

impl Reduction {
    /// Default tolerance, over the whole span.
    pub const TOLERANCE: f64 = 1e-4;

    /// The modal basis of this beam.
    ///
    /// # Errors
    /// As [`ModalBasis::new`] and [`ModalBasis::for_tolerance`].
    pub fn basis(&self, beam: &Beam) -> Result<ModalBasis, ModalError> {
        if let Some(known) =
            recent(|recent| recent.iter().find(|known| known.is(self, beam)).map(|known| known.basis.clone()))
        {
            return Ok(known);
        }
        let basis = match *self {
            Self::Modes(count) => ModalBasis::new(beam, count, &[])?,
            Self::Flexibility { tolerance, region } => ModalBasis::for_tolerance(beam, region, tolerance)?,
        };
        if beam.dofs() * basis.len() <= MOST_NUMBERS {
            let known = CachedBasis { reduction: *self, spec: beam.spec().clone(), basis: basis.clone() };
            recent(|recent| {
                recent.truncate(MOST_CACHED - 1);
                recent.insert(0, known);
            });
        }
        Ok(basis)
    }

    /// The part of a beam of this span (m) whose flexibility counts.
    #[must_use]
    pub fn region(&self, span: f64) -> [f64; 2] {
        match *self {
            Self::Modes(_) => [0.0, span],
            Self::Flexibility { region, .. } => region,
        }
    }
}

/// A cached basis. A study uses the same beam in the same modes hundreds of times, and finding them
/// is most of its work; they depend only on the beam's numbers.
struct CachedBasis {
    reduction: Reduction,
    spec: BeamSpec,
    basis: ModalBasis,
}

impl CachedBasis {
    fn is(&self, reduction: &Reduction, beam: &Beam) -> bool {
        self.reduction == *reduction && self.spec == *beam.spec()
    }
}

/// Largest number of cached bases, and of numbers in each: 40 MB altogether.
const MOST_CACHED: usize = 50;
const MOST_NUMBERS: usize = 100_000;

/// The bases found most recently, the newest first.
fn recent<T>(of: impl FnOnce(&mut Vec<CachedBasis>) -> T) -> T {
    static RECENT: Mutex<Vec<CachedBasis>> = Mutex::new(Vec::new());
    of(&mut RECENT.lock().unwrap_or_else(PoisonError::into_inner))
}
