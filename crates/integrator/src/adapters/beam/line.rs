//! The contact kinematics of a straight beam (`docs/theory.md` §3), whatever its coordinates:
//! elements or modes.

use super::{BeamFace, BeamSurface};
use crate::Rows;
use nalgebra::Vector2;
use teeter_beam::{Deflection, DeflectionBounds, Hold, InnerSupport, SAME_PLACE};
use teeter_detect::{Frame, HalfSpace, Kinematics, Summit, SurfacePoint};

/// Deflection and slope along a beam as linear functions of its coordinates.
pub(crate) trait Deflecting {
    /// m.
    fn span(&self) -> f64;

    /// Where its elements meet, from 0 to the span, m: within an element the deflection is a cubic.
    fn nodes(&self) -> &[f64];

    /// What holds it between its ends, each at one of the nodes.
    fn inner_supports(&self) -> &[InnerSupport];

    /// Deflection and slope at x in [0, span] for coordinates `q`; `None` elsewhere.
    fn deflection_at(&self, q: &[f64], x: f64) -> Option<Deflection>;

    /// Calls `each` for every coordinate that moves the point of [0, span] nearest to x, with its
    /// number and the deflection and slope there per unit of it.
    fn shape(&self, x: f64, each: impl FnMut(usize, f64, f64));

    /// Whether its points move along the axis too.
    fn has_axial_dofs(&self) -> bool;

    /// Displacement along the axis of the point of [0, span] nearest to x, m.
    fn axial_displacement(&self, q: &[f64], x: f64) -> f64;

    /// As [`Deflecting::shape`], for the displacement along the axis.
    fn axial_shape(&self, x: f64, each: impl FnMut(usize, f64));
}

/// A straight level beam in the world, displaced with its supports if they move.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    /// Its left end, m.
    position: Vector2<f64>,
    /// How far the surface is above the axis, m.
    offset: f64,
    /// 1 where the surface faces up, −1 where it faces down.
    facing: f64,
}

/// Most iterations for the foot on the top fibre.
const FOOT_ROUNDS: usize = 20;

impl Line {
    /// A beam whose left end is at `position`, and its supports displaced (not, or by x and y).
    pub(crate) fn new(position: Vector2<f64>, displaced: &[f64], surface: BeamSurface) -> Self {
        let moved = match *displaced {
            [x, y] => Vector2::new(x, y),
            _ => Vector2::zeros(),
        };
        Self { position: position + moved, offset: surface.offset(), facing: 1.0 }
    }

    /// The surface that is that of one of its bodies.
    pub(crate) fn of_body(self, body: u32) -> Self {
        match BeamFace::of_body(body) {
            BeamFace::Upper => self,
            BeamFace::Lower => Self { offset: -self.offset, facing: -1.0, ..self },
        }
    }

    /// The coordinate along the beam of a place in the world. The ends belong to the beam, so a
    /// place beyond an end by no more than rounding is moved to it.
    fn along(&self, [first, last]: [f64; 2], x: f64) -> f64 {
        let left = self.position.x;
        let along = x - left;
        let rounding = 4.0 * f64::EPSILON * (left.abs() + first.abs() + (last - first));
        if (first - rounding..=last + rounding).contains(&along) { along.clamp(first, last) } else { along }
    }

    /// The section of a beam that moves along its axis which is at a place in the world now; `None` beyond the ends where they are
    /// now.
    fn before_moving(&self, beam: &impl Deflecting, q: &[f64], x: f64) -> Option<f64> {
        let ends = [0.0, beam.span()].map(|end| end + beam.axial_displacement(q, end));
        let x = self.along(ends, x);
        (ends[0]..=ends[1]).contains(&x).then(|| before_moving(beam, q, x))
    }

    /// The foot point at the beam's own coordinate of `at`: the point of the surface with the same
    /// x.
    pub(crate) fn foot(
        &self,
        beam: &impl Deflecting,
        q: &[f64],
        kinematics: Kinematics,
        at: &Vector2<f64>,
    ) -> Option<SurfacePoint<2>> {
        let (offset, facing) = (self.offset, self.facing);
        let moves = beam.has_axial_dofs() && kinematics == Kinematics::Deformed;
        let x = if moves { self.before_moving(beam, q, at.x)? } else { self.along([0.0, beam.span()], at.x) };
        let d = beam.deflection_at(q, x)?; // None beyond the ends, which belong to the beam
        if kinematics == Kinematics::Linear {
            let place = Vector2::new(at.x, self.position.y + d.w + offset);
            return Some(SurfacePoint { place, normal: Vector2::y() * facing, material: Vector2::new(x, offset) });
        }
        let (mut foot, mut w, mut normal) = (x, d.w, normal_of(d.slope));
        if offset != 0.0 {
            // x_f − offset sin ψ(x_f) = x: each round gains a factor offset·w'' on the last, a
            // curvature radius of many thicknesses for anything that is a beam; 1e-16 of the span
            // is reached in some four rounds.
            for _ in 0..FOOT_ROUNDS {
                let next = (x - offset * normal.x).clamp(0.0, beam.span());
                let moved = (next - foot).abs();
                let d = beam.deflection_at(q, next)?;
                (foot, w, normal) = (next, d.w, normal_of(d.slope));
                if moved <= f64::EPSILON * beam.span() {
                    break;
                }
            }
        }
        let place = Vector2::new(at.x, self.position.y + w + offset * normal.y);
        Some(SurfacePoint { place, normal: normal * facing, material: Vector2::new(foot, offset) })
    }

    /// The point of the surface that belongs to the section at x, m along the beam.
    fn at(&self, beam: &impl Deflecting, q: &[f64], x: f64) -> Option<SurfacePoint<2>> {
        let d = beam.deflection_at(q, x)?;
        let normal = normal_of(d.slope);
        let along = Vector2::new(x + beam.axial_displacement(q, x), d.w);
        let place = self.position + along + normal * self.offset;
        Some(SurfacePoint { place, normal: normal * self.facing, material: Vector2::new(x, self.offset) })
    }

    /// Both ends of the surface.
    pub(crate) fn ends(&self, beam: &impl Deflecting, q: &[f64]) -> [Option<SurfacePoint<2>>; 2] {
        [0.0, beam.span()].map(|x| self.at(beam, q, x))
    }

    /// Hands the points at which the surface comes out furthest along `direction`, between two
    /// places, to `each`, from the left. The surface runs parallel to the axis, so that they belong
    /// to the sections at which the axis is at right angles to the direction; in an element the
    /// slope is a parabola. Supports over which the beam is nearly straight are handed over, too: it doesn't come out there, but bears, and
    /// can't give way as it does beside them. A base that comes down on a beam that is bent more rolls onto its crest instead.
    pub(crate) fn summits(
        &self,
        beam: &impl Deflecting,
        q: &[f64],
        direction: &Vector2<f64>,
        between: &[Vector2<f64>; 2],
        each: &mut dyn FnMut(Summit<2>),
    ) {
        let level = -direction.x / direction.y;
        // There the surface looks along the direction: that of an upper face never looks down.
        if !(level.is_finite() && direction.y * self.facing > 0.0) {
            return;
        }
        let [a, b] = between.map(|place| {
            let along = place.x - self.position.x;
            if beam.has_axial_dofs() { before_moving(beam, q, along) } else { along }
        });
        // A point of the surface is beside its section by no more than the offset.
        let beside = self.offset.abs();
        let (low, high) = ((a.min(b) - beside).max(0.0), (a.max(b) + beside).min(beam.span()));
        let rise = |x: f64| beam.deflection_at(q, x).map_or(0.0, |d| direction.y.signum() * (d.slope - level));
        let nodes = beam.nodes();
        let first = nodes.partition_point(|node| *node <= low).max(1);
        let supports = beam.inner_supports().iter().filter(|inner| inner.support.holds()[0] != Hold::Free);
        let is_supported = |x: f64| supports.clone().any(|inner| (inner.x - x).abs() <= SAME_PLACE * beam.span());
        let mut left = None;
        // Length of the element before, and whether it is nearly straight.
        let (mut length_before, mut was_straight) = (0.0_f64, false);
        for two in nodes[first - 1..].windows(2).take_while(|two| two[0] < high) {
            let (from, to) = (two[0].max(low), two[1].min(high));
            // The slope of a beam that shears jumps at a node under a force or a mass: an element has the slopes within it.
            let begin = from + EDGE * (to - from);
            let length = to - from - 2.0 * (begin - from);
            let [start, middle, end] = [0.0, 0.5, 1.0].map(|t| rise(begin + t * length));
            let kink = (start <= 0.0 && left.is_some_and(|left| left > 0.0)).then_some(from);
            let fall = falls_through_zero([start, middle, end]).map(|t| begin + t * length);
            left = Some(end);
            let node = two[0];
            let element = two[1] - node;
            let is_straight = start.max(middle).max(end) - start.min(middle).min(end) <= STRAIGHT;
            // In an element beside it, a summit is that of the beam bent over the support.
            let held = (was_straight && is_straight && is_supported(node)).then_some(length_before.max(element));
            (length_before, was_straight) = (element, is_straight);
            let support = held.and(kink.is_none().then_some(node));
            for (x, support) in [(support, held), (kink, held), (fall, None)] {
                if let Some(point) = x.and_then(|x| self.at(beam, q, x)) {
                    each(Summit { point, support });
                }
            }
        }
    }

    /// A half space with all points whose gap is at most `margin`: the foot of a point lies
    /// vertically below it, no higher than w + offset, and the gap is the height above the foot
    /// times cos ψ.
    pub(crate) fn reach(&self, bounds: DeflectionBounds, margin: f64) -> HalfSpace<2> {
        let DeflectionBounds { highest, steepest } = bounds;
        let top = self.position.y + highest + self.offset.max(0.0);
        HalfSpace { normal: Vector2::y(), offset: top + margin * (1.0 + steepest) }
    }

    /// The places of points (x along the beam, y above its axis) of the beam's sections.
    pub(crate) fn place(&self, beam: &impl Deflecting, q: &[f64], local: &[Vector2<f64>], out: &mut [Vector2<f64>]) {
        for (place, point) in out.iter_mut().zip(local) {
            let (w, slope) =
                beam.deflection_at(q, point.x.clamp(0.0, beam.span())).map_or((0.0, 0.0), |d| (d.w, d.slope));
            let cos = (1.0 + slope * slope).sqrt().recip();
            let u = beam.axial_displacement(q, point.x);
            *place = self.position + Vector2::new(point.x + u - point.y * slope * cos, w + point.y * cos);
        }
    }
}

/// The normal of a line of this slope, upwards.
fn normal_of(slope: f64) -> Vector2<f64> {
    let cos = (1.0 + slope * slope).sqrt().recip();
    Vector2::new(-slope * cos, cos)
}

/// Slopes at a node are taken this part of an element beside it.
const EDGE: f64 = 1e-9;

/// An element is nearly straight if its slope changes by no more than this, rad: as much as a base turns in a step or less, so that it may
/// come down flat on what is bent by less, without ever rolling onto it.
const STRAIGHT: f64 = 1e-4;

/// Where in (0, 1] a parabola with these values at 0, ½ and 1 goes from above zero to below.
fn falls_through_zero([start, middle, end]: [f64; 3]) -> Option<f64> {
    let [square, linear] = [2.0 * (start + end) - 4.0 * middle, 4.0 * middle - 3.0 * start - end];
    // The root at which the derivative is negative, −√(linear² − 4 square start), written without
    // cancellation.
    let root = linear * linear - 4.0 * square * start;
    // Written so that NaN fails too.
    if !(root > 0.0) {
        return None;
    }
    let fall = root.sqrt();
    let t = if linear > 0.0 { -(linear + fall) / (2.0 * square) } else { 2.0 * start / (fall - linear) };
    (t > 0.0 && t <= 1.0).then_some(t)
}

/// The material point that axial motion has brought to x: x_m + u(x_m) = x. Strains are far below
/// 1, so a few iterations suffice.
fn before_moving(beam: &impl Deflecting, q: &[f64], x: f64) -> f64 {
    let mut material = x;
    for _ in 0..FOOT_ROUNDS {
        let next = (x - beam.axial_displacement(q, material)).clamp(0.0, beam.span());
        let moved = (next - material).abs();
        material = next;
        if moved <= f64::EPSILON * beam.span() {
            break;
        }
    }
    material
}

/// Fills the Jacobian rows of a surface point in a contact's frame, followed by one column for each
/// of the prescribed velocities `driven`, which move all points along x and y; returns the number
/// of columns.
///
/// v_s = (−offset cos ψ·ψ̇, ẇ − offset sin ψ·ψ̇) with ψ̇ = ẇ' cos² ψ, ψ the slope of the
/// [section](section_of).
pub(crate) fn rows(
    beam: &impl Deflecting,
    (body, q): (u32, &[f64]),
    point: &Vector2<f64>,
    frame: &Frame<2>,
    driven: &[usize],
    out: &mut Rows<'_, 2>,
) -> usize {
    let [up, turn] = lift_and_turn(point, frame, &section_of(beam, (body, q), point, frame));
    let mut taken = 0;
    let mut put = |column: usize, value: Vector2<f64>| {
        out.columns[taken] = column;
        out.values[taken] = value;
        taken += 1;
    };
    if point.y == 0.0 {
        beam.shape(point.x, |column, n, _| put(column, up * n));
    } else {
        beam.shape(point.x, |column, n, dn| put(column, up * n + turn * dn));
    }
    let along: Vector2<f64> = frame.column(0).into();
    beam.axial_shape(point.x, |column, n| put(column, along * n));
    for (direction, column) in driven.iter().enumerate() {
        put(*column, frame.column(direction).into());
    }
    taken
}

/// J̇ v of a point fixed in the beam, `state` its own coordinates and velocities: with ψ̇ = ẇ'
/// cos²ψ the point at height y above the axis moves at (−y cos ψ·ψ̇, ẇ − y sin ψ·ψ̇); J̇ v is the
/// part of its derivative without ẅ and ẅ'. `None` off the beam.
pub(crate) fn bias(
    beam: &impl Deflecting,
    state: [&[f64]; 2],
    point: &Vector2<f64>,
    frame: &Frame<2>,
) -> Option<Vector2<f64>> {
    if point.y == 0.0 {
        return Some(Vector2::zeros());
    }
    let x = point.x.clamp(0.0, beam.span());
    let [slope, rate] = [beam.deflection_at(state[0], x)?.slope, beam.deflection_at(state[1], x)?.slope];
    let cos = (1.0 + slope * slope).sqrt().recip();
    let sin = slope * cos;
    let turn = rate * cos * cos;
    let turn_bias = -2.0 * turn * turn * slope;
    let along = sin * turn * turn - cos * turn_bias;
    let up = -cos * turn * turn - sin * turn_bias;
    Some(frame * (Vector2::new(along, up) * point.y))
}

/// The normal (−sin ψ, cos ψ) of the section at a point of the beam. Of a surface that others touch
/// it is that of the contact's frame, up or down; for linear kinematics that has ψ = 0. Of a fibre
/// that touches others it is the section's own.
pub(crate) fn section_of(
    beam: &impl Deflecting,
    (body, q): (u32, &[f64]),
    point: &Vector2<f64>,
    frame: &Frame<2>,
) -> Vector2<f64> {
    let normal: Vector2<f64> = frame.row(0).transpose();
    if point.y == 0.0 {
        // On the axis it doesn't matter.
        normal
    } else if BeamFace::is_fibre(body) {
        let x = point.x.clamp(0.0, beam.span());
        beam.deflection_at(q, x).map_or(normal, |d| normal_of(d.slope))
    } else {
        match BeamFace::of_body(body) {
            BeamFace::Upper => normal,
            BeamFace::Lower => -normal,
        }
    }
}

/// The velocities `[up, turn]` of a surface point in a contact's frame per unit of ẇ and of ẇ'
/// there, with the normal of the section. So an impulse p acts on the beam as the vertical impulse
/// up·p and the couple turn·p about the axis.
pub(crate) fn lift_and_turn(point: &Vector2<f64>, frame: &Frame<2>, section: &Vector2<f64>) -> [Vector2<f64>; 2] {
    let (sin, cos) = (-section.x, section.y);
    [frame.column(1).into(), frame * Vector2::new(-cos, -sin) * (point.y * cos * cos)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_followed_to_where_it_falls_through_zero() {
        let of = |a: f64, b: f64, c: f64| [0.0, 0.5, 1.0].map(|t| (a * t + b) * t + c);
        let close = |found: Option<f64>, wanted: f64| found.is_some_and(|t| (t - wanted).abs() < 1e-14);
        assert!(close(falls_through_zero(of(0.0, -2.0, 1.0)), 0.5), "a line");
        assert!(close(falls_through_zero(of(0.0, -2.0, 2.0)), 1.0), "at the end");
        assert_eq!(falls_through_zero(of(0.0, -2.0, 0.0)), None, "at the start: the piece before has it");
        assert_eq!(falls_through_zero(of(0.0, 2.0, -1.0)), None, "it rises");
        // −(t − 0.2)(t − 0.7) is above zero in between; (t − 0.2)(t − 0.7) falls at 0.2.
        assert!(close(falls_through_zero(of(-1.0, 0.9, -0.14)), 0.7));
        assert!(close(falls_through_zero(of(1.0, -0.9, 0.14)), 0.2));
        assert!(close(falls_through_zero(of(1e-18, -2.0, 1.0)), 0.5), "as good as a line");
        assert_eq!(falls_through_zero([0.0; 3]), None);
        assert_eq!(falls_through_zero([f64::NAN, 1.0, -1.0]), None);
    }
}
