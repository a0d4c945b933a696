//! The contact kinematics of a straight beam (`docs/theory.md` §3), whatever its coordinates:
//! elements or modes.

use super::BeamSurface;
use crate::Rows;
use nalgebra::Vector2;
use teeter_beam::{Deflection, DeflectionBounds};
use teeter_detect::{Frame, HalfSpace, Kinematics, SurfacePoint};

/// Deflection and slope along a beam as linear functions of its coordinates.
pub(crate) trait Deflecting {
    /// m.
    fn span(&self) -> f64;

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
    surface: BeamSurface,
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
        Self { position: position + moved, surface }
    }

    /// The coordinate along the beam of a place in the world. The ends belong to the beam, so a
    /// place beyond an end by no more than rounding is moved to it.
    fn along(&self, span: f64, x: f64) -> f64 {
        let left = self.position.x;
        let along = x - left;
        let rounding = 4.0 * f64::EPSILON * (left.abs() + span);
        if (-rounding..=span + rounding).contains(&along) { along.clamp(0.0, span) } else { along }
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
        let x = self.along(beam.span(), at.x);
        let offset = self.surface.offset();
        let d = beam.deflection_at(q, x)?; // None beyond the ends, which belong to the beam
        // The material point that is at x now.
        let moves = beam.has_axial_dofs() && kinematics == Kinematics::Deformed;
        let (x, d) = if moves {
            let x = before_moving(beam, q, x);
            (x, beam.deflection_at(q, x)?)
        } else {
            (x, d)
        };
        if kinematics == Kinematics::Linear {
            let place = Vector2::new(at.x, self.position.y + d.w + offset);
            return Some(SurfacePoint { place, normal: Vector2::y(), material: Vector2::new(x, offset) });
        }
        let normal_of = |slope: f64| {
            let cos = (1.0 + slope * slope).sqrt().recip();
            Vector2::new(-slope * cos, cos)
        };
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
        Some(SurfacePoint { place, normal, material: Vector2::new(foot, offset) })
    }

    /// A half space with all points whose gap is at most `margin`: the foot of a point lies
    /// vertically below it, no higher than w + offset, and the gap is the height above the foot
    /// times cos ψ.
    pub(crate) fn reach(&self, bounds: DeflectionBounds, margin: f64) -> HalfSpace<2> {
        let DeflectionBounds { highest, steepest } = bounds;
        let top = self.position.y + highest + self.surface.offset().max(0.0);
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
/// The frame is taken to be that of the surface point, so its normal (−sin ψ, cos ψ) gives the
/// rotation of the section: v_s = (−offset cos ψ·ψ̇, ẇ − offset sin ψ·ψ̇) with ψ̇ = ẇ' cos² ψ; for
/// linear kinematics ψ = 0.
pub(crate) fn rows(
    beam: &impl Deflecting,
    point: &Vector2<f64>,
    frame: &Frame<2>,
    driven: &[usize],
    out: &mut Rows<'_, 2>,
) -> usize {
    let [up, turn] = lift_and_turn(point, frame);
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

/// The velocities `[up, turn]` of a surface point in a contact's frame per unit of ẇ and of ẇ'
/// there. So an impulse p acts on the beam as the vertical impulse up·p and the couple turn·p about
/// the axis.
pub(crate) fn lift_and_turn(point: &Vector2<f64>, frame: &Frame<2>) -> [Vector2<f64>; 2] {
    let (sin, cos) = (-frame[(0, 0)], frame[(0, 1)]);
    [frame.column(1).into(), frame * Vector2::new(-cos, -sin) * (point.y * cos * cos)]
}
