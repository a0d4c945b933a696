//! A beam in few coordinates, as a scene asks for it.

use std::sync::{Mutex, PoisonError};
use teeter_beam::{Beam, BeamSpec, ModalBasis, ModalError};

/// In which shapes a beam moves, where these are not those of all its nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Reduction {
    /// So many of its lowest modes, rigid motions included.
    Modes(usize),
    /// As few modes and static corrections as its static flexibility needs.
    Flexibility {
        /// Largest relative error of the flexibility in the region.
        tolerance: f64,
        /// From where to where, m from the left end.
        region: [f64; 2],
    },
}

impl Reduction {
    /// Its tolerance where a scene gives none, over the whole span.
    pub const TOLERANCE: f64 = 1e-4;

    /// The shapes of this beam.
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
            let known = Known { reduction: *self, spec: beam.spec().clone(), basis: basis.clone() };
            recent(|recent| {
                recent.truncate(MOST_KNOWN - 1);
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

/// A basis that was found before. A study takes the same beam in the same shapes hundreds of times,
/// and finding them is most of its work; they depend on nothing but the beam's numbers.
struct Known {
    reduction: Reduction,
    spec: BeamSpec,
    basis: ModalBasis,
}

impl Known {
    fn is(&self, reduction: &Reduction, beam: &Beam) -> bool {
        self.reduction == *reduction && self.spec == *beam.spec()
    }
}

/// Bases that are kept, of so many numbers each at the most: 40 MB altogether.
const MOST_KNOWN: usize = 50;
const MOST_NUMBERS: usize = 100_000;

/// The bases found last, the newest first.
fn recent<T>(of: impl FnOnce(&mut Vec<Known>) -> T) -> T {
    static RECENT: Mutex<Vec<Known>> = Mutex::new(Vec::new());
    of(&mut RECENT.lock().unwrap_or_else(PoisonError::into_inner))
}
