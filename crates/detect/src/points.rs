//! Points of one body (the corners of a block) against the surface of another (a beam, the ground).

use crate::plane_frame;
use crate::{Anchor, BodyId, Candidate, Candidates, ContactDetector, ContactId, Geometry, Kinematics, Vector};

/// Points of a body that can touch a surface of another.
#[derive(Clone, Debug, PartialEq)]
pub struct PointPair<const D: usize> {
    /// The pair's number, first part of the identity of its contacts.
    pub pair: u32,
    /// The points, in the body's own coordinates; their order is the second part.
    pub points: Vec<Vector<D>>,
    /// The body that has the points.
    pub body: BodyId,
    /// The body that has the surface.
    pub surface: BodyId,
    /// How the surface's deformation enters.
    pub kinematics: Kinematics,
}

/// The detector of points against surfaces: every point of every pair is looked at.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointDetector<const D: usize> {
    pairs: Vec<PointPair<D>>,
}

/// Points placed at once: a block's four corners share the sine and cosine of its angle.
const BATCH: usize = 8;

impl<const D: usize> PointDetector<D> {
    /// A detector of these pairs.
    #[must_use]
    pub fn new(pairs: Vec<PointPair<D>>) -> Self {
        Self { pairs }
    }

    /// The pairs, in the order in which they are looked at.
    #[must_use]
    pub fn pairs(&self) -> &[PointPair<D>] {
        &self.pairs
    }
}

impl ContactDetector<2> for PointDetector<2> {
    fn detect(&self, at: &dyn Geometry<2>, margin: f64, out: &mut Candidates<2>) {
        out.clear();
        let mut places = [Vector::<2>::zeros(); BATCH];
        for pair in &self.pairs {
            for (batch, local) in pair.points.chunks(BATCH).enumerate() {
                let places = &mut places[..local.len()];
                at.place(pair.body, local, places);
                for (k, place) in places.iter().enumerate() {
                    let Some(foot) = at.surface(pair.surface, pair.kinematics, place) else { continue };
                    let gap = foot.normal.dot(&(place - foot.place));
                    if gap <= margin {
                        out.push(Candidate {
                            id: ContactId::new(pair.pair, (batch * BATCH + k) as u32),
                            sides: [
                                Anchor { body: pair.body, point: local[k] },
                                Anchor { body: pair.surface, point: foot.material },
                            ],
                            frame: plane_frame(&foot.normal),
                            gap,
                        });
                    }
                }
            }
        }
    }

    fn capacity(&self) -> usize {
        self.pairs.iter().map(|pair| pair.points.len()).sum()
    }
}
