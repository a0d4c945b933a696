//! What the checks of a scene compute of its beams, once for scenes that have it in common.

use crate::flexibility::{Flexibility, MissingFlexibility};
use crate::held::Held;
use crate::mesh_error::{MeshComparison, Sagging};
use crate::scene::Scene;
use crate::solve_digits::{FewDigits, SolveDigits};
use std::convert::Infallible;
use std::sync::Mutex;

/// Values of each kind that are held at most: in studies that vary beams, each case has its own.
const MOST: usize = 32;

/// Measures of beams, by what they depend on.
#[derive(Debug, Default)]
pub(crate) struct BeamMeasures {
    sags: Mutex<Held<Sagging, Option<MeshComparison>>>,
    lacking: Mutex<Held<Flexibility, Option<MissingFlexibility>>>,
    digits: Mutex<Held<SolveDigits, Option<FewDigits>>>,
}

impl BeamMeasures {
    /// The largest static deflection of a beam of the scene, m, as [`sag`](crate::mesh_error::sag) finds it.
    pub(crate) fn sag(&self, scene: &Scene, number: usize) -> Option<MeshComparison> {
        once(&self.sags, Sagging::of(scene, number)?, Sagging::largest)
    }

    /// The flexibility that is missing under the loads of a beam, if that is too much.
    pub(crate) fn missing_flexibility(&self, scene: &Scene, number: usize) -> Option<MissingFlexibility> {
        once(&self.lacking, Flexibility::of(scene, number)?, Flexibility::missing)
    }

    /// The digits that solves with a beam leave, if these are few.
    pub(crate) fn few_digits(&self, scene: &Scene, number: usize) -> Option<FewDigits> {
        once(&self.digits, SolveDigits::of(scene, number), SolveDigits::few)
    }
}

/// What `find` makes of `of`: from earlier, or found now.
fn once<K: PartialEq + Clone, V: Clone>(
    held: &Mutex<Held<K, Option<V>>>,
    of: K,
    find: impl FnOnce(&K) -> Option<V>,
) -> Option<V> {
    let key = of.clone();
    let found = Held::try_find_or(held, key, MOST, || Ok::<_, Infallible>(find(&of)), |_| 0);
    match found {
        Ok(value) => Option::clone(&value),
    }
}
