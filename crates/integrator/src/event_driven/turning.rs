//! How a contact's rows turn along the motion: J̇v.

use super::smooth::Smooth;
use crate::{Memory, Model, StepError, Vector, WarmStart, Workspace};
use teeter_detect::{Candidate, ContactId};

/// J v is taken at times between which nothing moves or turns by more than this, m or rad: the error of
/// its derivative falls with the fourth power.
const ALONG: f64 = 1e-3;

/// Differences of order 2 and 4 that part by more than this, in parts of what J̇v consists of, are not
/// those of a smooth motion: a surface bends there from a side into a rounded corner, or is smaller than
/// the differences are.
const SMOOTH: f64 = 1e-6;

/// A velocity is known to this part of what it consists of.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The samples' steps, and their shares in a derivative of order 4 and in one of order 2.
type Stencil = [(f64, f64, f64)];
const CENTRAL: [(f64, f64, f64); 4] =
    [(1.0, 8.0 / 12.0, 0.5), (-1.0, -8.0 / 12.0, -0.5), (2.0, -1.0 / 12.0, 0.0), (-2.0, 1.0 / 12.0, 0.0)];
const ONE_SIDED: [(f64, f64, f64); 5] = [
    (0.0, -25.0 / 12.0, -1.5),
    (1.0, 48.0 / 12.0, 2.0),
    (2.0, -36.0 / 12.0, -0.5),
    (3.0, 16.0 / 12.0, 0.0),
    (4.0, -3.0 / 12.0, 0.0),
];

/// In this order differences are tried, by samples so far apart: shorter ones are rounded more, so those of one side are
/// preferred to very short ones of both.
const TRIALS: [(&Stencil, f64); 12] = [
    (&CENTRAL, 1.0),
    (&CENTRAL, 0.1),
    (&ONE_SIDED, 1.0),
    (&ONE_SIDED, -1.0),
    (&ONE_SIDED, 0.1),
    (&ONE_SIDED, -0.1),
    (&CENTRAL, 1e-2),
    (&ONE_SIDED, 1e-2),
    (&ONE_SIDED, -1e-2),
    (&CENTRAL, 1e-3),
    (&ONE_SIDED, 1e-3),
    (&ONE_SIDED, -1e-3),
];

impl Smooth {
    /// J̇v of a candidate, whose row in the stage is `row`. Of a corner on ground that stands still the frame
    /// stands still, too, and bodies know it; else it is the difference of J v along the motion, on the side where
    /// that is smooth.
    pub(super) fn turning(
        &mut self,
        model: &Model<2>,
        q: &[f64],
        work: &mut Workspace<2>,
        row: usize,
        candidate: &Candidate<2>,
    ) -> Result<Vector<2>, StepError> {
        let t = self.between[0];
        let is_still = model.owner(candidate.sides[1].body).is_some_and(|(_, part, _)| part.row == 0);
        if is_still && model.detector().fixed_side(candidate.id) == Some(0) {
            return self.stage.bias_at(row, model, q, &self.v).map_err(|source| StepError::Problem { t, source });
        }
        let mut fastest = 0.0_f64;
        for side in &candidate.sides {
            if let Some((_, part, _)) = model.owner(side.body) {
                fastest = self.v[part.v.clone()].iter().fold(fastest, |fastest, v| fastest.max(v.abs()));
            }
        }
        if fastest == 0.0 {
            return Ok(Vector::zeros());
        }
        let h = (ALONG / fastest).min(1e6);
        let enough = self.stage.speed(row, &self.v) * (SMOOTH * fastest).max(ROUNDING / h);
        let (mut best, mut least) = (Vector::zeros(), f64::INFINITY);
        for (stencil, part) in TRIALS {
            if let Some((derivative, error)) = self.difference(model, q, work, candidate.id, stencil, part * h)?
                && error < least
            {
                (best, least) = (derivative, error);
            }
            if least <= enough {
                break;
            }
        }
        Ok(best)
    }

    /// The derivative of J v along the motion by samples `h` (s) apart, and by how much one of lower order
    /// differs; `None` where a sample is off the end of the surface.
    fn difference(
        &mut self,
        model: &Model<2>,
        q: &[f64],
        work: &mut Workspace<2>,
        id: ContactId,
        stencil: &Stencil,
        h: f64,
    ) -> Result<Option<(Vector<2>, f64)>, StepError> {
        let (mut high, mut low) = (Vector::<2>::zeros(), Vector::<2>::zeros());
        for (steps, share, share_of_low) in stencil {
            let Some(u) = self.velocity_along(model, q, work, id, steps * h)? else { return Ok(None) };
            high += u * *share;
            low += u * *share_of_low;
        }
        Ok(Some((high / h, (high - low).norm() / h.abs())))
    }

    /// The velocity of a contact where the motion has gone on for a time `shift` (s) with the velocities of now;
    /// `None` off the end of its surface.
    fn velocity_along(
        &mut self,
        model: &Model<2>,
        q: &[f64],
        work: &mut Workspace<2>,
        id: ContactId,
        shift: f64,
    ) -> Result<Option<Vector<2>>, StepError> {
        model.move_along(q, &self.v, shift, &mut self.q_probe);
        work.locate_past_ends(model, &self.q_probe, &[id], &mut self.probes, &mut self.rooms)?;
        let Some(probe) = self.probes.first() else { return Ok(None) };
        self.one.clear();
        let moves = self.one.add(model, &self.q_probe, probe, &WarmStart::default(), &Memory::default())?;
        Ok(Some(if moves { self.one.velocity(0, &self.v)? } else { Vector::zeros() }))
    }
}
