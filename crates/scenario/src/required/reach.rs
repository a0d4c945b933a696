//! Where the corners of a block can come in the time of a run.

use super::at_rest::Rest;
use super::barrier::Barrier;
use super::{Pairs, Start};
use crate::scene::{ContactScene, Support};
use teeter_beam::Axial;

/// A region that the corners of a block don't leave: a strip along x, and a level below.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reach {
    /// From where to where, m.
    pub(super) x: [f64; 2],
    /// Never below, m.
    pub(super) y: f64,
    /// What keeps it there.
    pub(super) by: By,
}

/// What keeps a block in its reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum By {
    /// Free flight.
    Flight,
    /// Its energy.
    Energy,
    /// Nothing: it is anywhere.
    Nothing,
}

/// Of the sizes that a bound is made of, so much is added for rounding.
pub(super) const ROUNDING: f64 = 1e-9;

/// Deflection (m) and slope of a beam that may be anywhere.
const UNBOUNDED: (f64, f64) = (f64::INFINITY, f64::INFINITY);

/// Of a run of so many steps, this part of the sizes is added: sums of one step after the other
/// round each time, and may do so in one direction.
fn rounding(steps: u64) -> f64 {
    ROUNDING.max(4.0 * f64::EPSILON * steps as f64)
}

impl Reach {
    pub(super) const ANYWHERE: Self =
        Self { x: [f64::NEG_INFINITY, f64::INFINITY], y: f64::NEG_INFINITY, by: By::Nothing };

    /// That of a block in free flight: the θ step has velocities v⁰ + g t, and places on the
    /// parabola but for (θ − ½) h g t.
    pub(super) fn of_flight(start: &Start<'_>, block: usize, pairs: &Pairs) -> Self {
        if !start.is_left_alone(block) || !pairs.live[block].is_empty() {
            return Self::ANYWHERE;
        }
        let (of, time) = (&start.scene.blocks[block], &start.scene.time);
        let (q, v) = start.block(block);
        let extent = if v[2] == 0.0 && of.polygon.is_none() {
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
            // Where it turns back, if it does so in time.
            let turn = if g == 0.0 { 0.0 } else { (-rate / g).clamp(0.0, end) };
            let margin = start.ahead() * (v[k].abs() + g.abs() * (end + start.ahead()))
                + rounding(time.steps()) * (q[k].abs() + v[k].abs() * end + g.abs() * end * end + extent[k]);
            let places = [q[k], at(turn), at(end)];
            let low = places.into_iter().fold(f64::INFINITY, f64::min);
            let high = places.into_iter().fold(f64::NEG_INFINITY, f64::max);
            [low - extent[k] - margin, high + extent[k] + margin]
        };
        Self { x: bounds(0), y: bounds(1)[0], by: By::Flight }
    }

    /// Whether no corner comes near a surface.
    pub(super) fn misses(
        &self,
        start: &Start<'_>,
        surface: Support,
        rests: &[Option<Rest>],
        pairs: &Pairs,
        barrier: Option<&Barrier>,
    ) -> bool {
        let gap = start.scene.time.gap_tolerance;
        match surface {
            Support::Block(_) => false,
            Support::Ground => start.scene.ground.as_ref().is_some_and(|ground| {
                // Height over the line y = x tan β is least at one end of the strip.
                let height = |x: f64| self.y - x * ground.incline.tan();
                !ground.motion.is_given() && self.x.iter().all(|x| height(*x) * ground.incline.cos() > gap)
            }),
            Support::Beam(k) => {
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
                // The gap is the height over the surface times the cosine of its slope.
                let above = self.y - y - w - beam.thickness > gap * slope.hypot(1.0);
                // An elastic axis carries the surface along.
                let stays = !matches!(beam.spec.axial, Axial::Elastic { .. });
                above || (stays && (self.x[1] < x || self.x[0] > x + beam.spec.span))
            }
        }
    }

    /// Why a contact never acts.
    pub(super) fn told(&self, start: &Start<'_>, contact: &ContactScene) -> String {
        let name = &start.scene.blocks[contact.block].name;
        let by = match self.by {
            By::Flight => "nothing acts on it but its weight",
            By::Energy => "it has no energy for more",
            By::Nothing => "nothing holds it", // and then no contact is removed
        };
        format!(
            "`{name}` stays over y = {:.4} m and in x = {:.4} … {:.4} m up to t = {} s: {by}",
            self.y,
            self.x[0],
            self.x[1],
            start.time()
        )
    }
}
