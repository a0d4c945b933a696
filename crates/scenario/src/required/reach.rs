//! Where the corners of a block can get to during a run.

use super::at_rest::BeamAtRest;
use super::barrier::Barrier;
use super::{InactivePairs, InitialMotion};
use crate::ground_profile;
use crate::scene::{ContactScene, SupportingBody};
use teeter_beam::Axial;
use teeter_integrator::BeamFace;

/// A region that the corners of a block don't leave: an interval of x, and a lower bound on y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reach {
    /// Interval of x, m.
    pub(super) x: [f64; 2],
    /// Lower bound on y, m.
    pub(super) y: f64,
    /// The reason.
    pub(super) by: ReachReason,
}

/// Why a block stays in its region.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ReachReason {
    /// Free flight.
    Flight,
    /// Its energy.
    Energy,
    /// None: it may be anywhere.
    Nothing,
}

/// Relative allowance for rounding, added to bounds.
pub(super) const ROUNDING: f64 = 1e-9;

/// Deflection (m) and slope of a beam without bounds.
const UNBOUNDED: (f64, f64) = (f64::INFINITY, f64::INFINITY);

/// Relative allowance for rounding in a run of `steps` steps: sums over steps round each time,
/// possibly always in the same direction.
fn rounding(steps: u64) -> f64 {
    ROUNDING.max(4.0 * f64::EPSILON * steps as f64)
}

impl Reach {
    pub(super) const ANYWHERE: Self =
        Self { x: [f64::NEG_INFINITY, f64::INFINITY], y: f64::NEG_INFINITY, by: ReachReason::Nothing };

    /// The region of a block in free flight: the θ step gives velocities v⁰ + g t, and positions on
    /// the parabola except for (θ − ½) h g t.
    pub(super) fn of_flight(start: &InitialMotion<'_>, block: usize, pairs: &InactivePairs) -> Self {
        if !start.is_left_alone(block) || !pairs.live[block].is_empty() {
            return Self::ANYWHERE;
        }
        let (of, time) = (&start.scene.blocks[block], &start.scene.time);
        let (q, v) = start.block(block);
        let extent = if v[2] == 0.0 && of.parts.is_none() {
            let (sin, cos) = q[2].sin_cos();
            let half = [0.5 * of.width, 0.5 * of.height];
            [half[0] * cos.abs() + half[1] * sin.abs(), half[0] * sin.abs() + half[1] * cos.abs()]
        } else {
            [of.radius(); 2]
        };
        let bounds = |k: usize| {
            let (g, end) = (start.scene.gravity[k], start.time());
            let rate = v[k] + (time.theta - 0.5) * time.step * g;
            let at = |t: f64| q[k] + rate * t + 0.5 * g * t * t;
            // The turning point, if it is within the run.
            let turn = if g == 0.0 { 0.0 } else { (-rate / g).clamp(0.0, end) };
            let margin = start.ahead() * (v[k].abs() + g.abs() * (end + start.ahead()))
                + rounding(time.steps()) * (q[k].abs() + v[k].abs() * end + g.abs() * end * end + extent[k]);
            let places = [q[k], at(turn), at(end)];
            let low = places.into_iter().fold(f64::INFINITY, f64::min);
            let high = places.into_iter().fold(f64::NEG_INFINITY, f64::max);
            [low - extent[k] - margin, high + extent[k] + margin]
        };
        Self { x: bounds(0), y: bounds(1)[0], by: ReachReason::Flight }
    }

    /// Whether no corner gets near a surface, and with that no side of the block.
    pub(super) fn misses(
        &self,
        start: &InitialMotion<'_>,
        (surface, face): (SupportingBody, BeamFace),
        rests: &[Option<BeamAtRest>],
        pairs: &InactivePairs,
        barrier: Option<&Barrier>,
    ) -> bool {
        let gap = start.scene.time.gap_tolerance;
        match surface {
            SupportingBody::Block(_) => false,
            SupportingBody::Ground => start.scene.ground.as_ref().is_some_and(|ground| {
                // The height above the line y = x tan β is smallest at an end of the interval.
                let height = |x: f64| self.y - x * ground.incline.tan();
                if let Some(profile) = &ground.profile {
                    return !ground.motion.is_given() && self.y - ground_profile::top(profile) > gap;
                }
                !ground.motion.is_given() && self.x.iter().all(|x| height(*x) * ground.incline.cos() > gap)
            }),
            SupportingBody::Beam(k) => {
                let beam = &start.scene.beams[k];
                if beam.motion.is_given() {
                    return false;
                }
                let [x, y] = beam.position;
                let (w, slope) = match (&rests[k], barrier) {
                    (Some(rest), _) if !pairs.touched[k] => {
                        let margin = rest.trembles + ROUNDING * rest.shape.largest();
                        (rest.shape.highest + margin, (1.0 + ROUNDING) * rest.shape.steepest)
                    }
                    (_, Some(barrier)) => barrier.swing(k),
                    _ => UNBOUNDED,
                };
                // The gap is the height above the surface times the cosine of its slope.
                let above = face == BeamFace::Upper && self.y - y - w - beam.thickness > gap * slope.hypot(1.0);
                // With an elastic axis the surface also moves along x.
                let stays = !matches!(beam.spec.axial, Axial::Elastic { .. });
                above || (stays && (self.x[1] < x || self.x[0] > x + beam.spec.span))
            }
        }
    }

    /// The reason why a contact never acts, in words.
    pub(super) fn reason(&self, start: &InitialMotion<'_>, contact: &ContactScene) -> String {
        let name = &start.scene.blocks[contact.block].name;
        let by = match self.by {
            ReachReason::Flight => "only its weight acts on it",
            ReachReason::Energy => "its energy allows no more",
            ReachReason::Nothing => "nothing restricts it", // in which case no contact is removed
        };
        format!(
            "`{name}` stays above y = {:.4} m and within x = {:.4} … {:.4} m up to t = {} s: {by}",
            self.y,
            self.x[0],
            self.x[1],
            start.time()
        )
    }
}
