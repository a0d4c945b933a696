//! Rigid ground: a half plane that stands still, without velocities, or moves as prescribed, with
//! three.

use crate::{
    Bodies, Compliance, Coupling, Dynamics, Energy, FactorError, Motion, PartRows, Rows, Size, Traits, Vector, Weights,
};
use nalgebra::{Vector2, Vector3};
use teeter_detect::{Frame, HalfSpace, Kinematics, SurfacePoint};
use teeter_rigid::Pose;

/// The half plane below a straight line.
///
/// Distances from it are perpendicular, and the foot is the orthogonal projection. Moving ground
/// has the coordinates (x, y, β): the place of the point that is at the origin when nothing is
/// displaced, and its slope. Their velocities are prescribed. The ground has no mass, so the forces
/// that move it are those of its contacts alone.
#[derive(Clone, Debug)]
pub struct Ground(Form);

#[derive(Clone, Debug)]
enum Form {
    Level(f64),
    Inclined(Pose),
    Moving { incline: f64, motion: [Motion; 3] },
}

impl Ground {
    /// Flat ground at y = `level`, m.
    #[must_use]
    pub fn flat(level: f64) -> Self {
        Self(Form::Level(level))
    }

    /// Ground through the origin with slope `incline` (rad, counter-clockwise positive): y = x tan
    /// β.
    #[must_use]
    pub fn inclined(incline: f64) -> Self {
        Self(Form::Inclined(Pose::new(&Vector3::new(0.0, 0.0, incline))))
    }

    /// Ground with slope `incline` (rad) through the origin that moves: displacements x and y (m),
    /// and a turn about that point (rad, counter-clockwise positive) on top of the incline.
    #[must_use]
    pub fn moving(incline: f64, motion: [Motion; 3]) -> Self {
        Self(Form::Moving { incline, motion })
    }

    /// Its coordinates at time `t` (s) by the given displacements, in closed form; at t = 0 those
    /// to start from. Empty for ground that stands still.
    #[must_use]
    pub fn coordinates(&self, t: f64) -> Vec<f64> {
        let Form::Moving { incline, motion } = &self.0 else { return Vec::new() };
        let [x, y, turn] = motion.each_ref().map(|motion| motion.displacement(t));
        vec![x, y, incline + turn]
    }

    fn driven(&self) -> &'static [usize] {
        match self.0 {
            Form::Moving { .. } => &[0, 1, 2],
            _ => &[],
        }
    }

    /// The pose of its body frame, whose axes point along the surface and out of it.
    fn pose(&self, q: &[f64]) -> Pose {
        match (&self.0, q) {
            (Form::Inclined(pose), _) => *pose,
            (Form::Moving { .. }, &[x, y, slope]) => Pose::new(&Vector3::new(x, y, slope)),
            (Form::Level(level), _) => Pose::new(&Vector3::new(0.0, *level, 0.0)),
            (Form::Moving { incline, .. }, _) => Pose::new(&Vector3::new(0.0, 0.0, *incline)),
        }
    }
}

impl Dynamics<2> for Ground {
    fn size(&self) -> Size {
        let n = self.driven().len();
        Size { q: n, v: n, bodies: 1, row: n }
    }

    fn traits(&self) -> Traits {
        Traits::free().driven(self.driven())
    }

    fn internal_force(&self, _q: &[f64], _v: &[f64], _f: &mut [f64]) {}

    fn drive(&self, t: f64, v: &mut [f64]) {
        if let Form::Moving { motion, .. } = &self.0 {
            for (v, motion) in v.iter_mut().zip(motion) {
                *v = motion.velocity(t);
            }
        }
    }

    fn drive_rate(&self, t: f64, a: &mut [f64]) -> bool {
        if let Form::Moving { motion, .. } = &self.0 {
            for (a, motion) in a.iter_mut().zip(motion) {
                *a = motion.acceleration(t);
            }
        }
        true
    }

    fn next_break(&self, t: f64) -> f64 {
        let Form::Moving { motion, .. } = &self.0 else { return f64::INFINITY };
        motion.iter().map(|motion| motion.next_break(t)).fold(f64::INFINITY, f64::min)
    }

    fn drive_mean(&self, [from, to]: [f64; 2], v: &mut [f64]) {
        if let Form::Moving { motion, .. } = &self.0 {
            for (v, motion) in v.iter_mut().zip(motion) {
                *v = motion.mean_velocity(from, to);
            }
        }
    }

    fn apply(&self, _w: Weights, _q: &[f64], _x: &[f64], _y: &mut [f64]) {}

    fn energy(&self, _q: &[f64], _v: &[f64]) -> Energy {
        Energy::default()
    }

    fn factor(&self, w: Weights, _q: &[f64]) -> Result<Box<dyn Compliance<2>>, FactorError> {
        Ok(Box::new(Immovable(w)))
    }
}

impl Bodies<2> for Ground {
    fn bias(&self, _: u32, q: &[f64], v: &[f64], point: &Vector2<f64>, frame: &Frame<2>) -> Option<Vector<2>> {
        Some(match v {
            &[_, _, omega] => frame * (self.pose(q).rotate(point) * -(omega * omega)),
            _ => Vector::zeros(),
        })
    }

    fn fastest(&self, v: &[f64]) -> f64 {
        match *v {
            // It goes on without end: where it turns, some point of it is faster.
            [_, _, omega] if omega != 0.0 => f64::INFINITY,
            [x, y, _] => x.hypot(y),
            _ => 0.0,
        }
    }

    fn place(&self, _body: u32, q: &[f64], local: &[Vector2<f64>], out: &mut [Vector2<f64>]) {
        if let Form::Level(_) = self.0 {
            out.copy_from_slice(local);
            return;
        }
        let pose = self.pose(q);
        for (place, local) in out.iter_mut().zip(local) {
            *place = pose.point(local);
        }
    }

    fn has_surface(&self, _body: u32) -> bool {
        true
    }

    fn surface(&self, _body: u32, q: &[f64], _: Kinematics, at: &Vector2<f64>) -> Option<SurfacePoint<2>> {
        if let Form::Level(level) = self.0 {
            let foot = Vector2::new(at.x, level);
            return Some(SurfacePoint { place: foot, normal: Vector2::y(), material: foot });
        }
        let pose = self.pose(q);
        let (along, normal) = (pose.rotate(&Vector2::x()), pose.rotate(&Vector2::y()));
        let material = Vector2::new(along.dot(&(at - pose.point(&Vector2::zeros()))), 0.0);
        Some(SurfacePoint { place: pose.point(&material), normal, material })
    }

    fn reach(&self, _body: u32, q: &[f64], margin: f64) -> Option<HalfSpace<2>> {
        if let Form::Level(level) = self.0 {
            return Some(HalfSpace { normal: Vector2::y(), offset: level + margin });
        }
        let pose = self.pose(q);
        let normal = pose.rotate(&Vector2::y());
        Some(HalfSpace { normal, offset: normal.dot(&pose.point(&Vector2::zeros())) + margin })
    }

    fn rows(&self, _: u32, q: &[f64], point: &Vector2<f64>, frame: &Frame<2>, out: &mut Rows<'_, 2>) -> usize {
        if self.driven().is_empty() {
            return 0;
        }
        let jacobian = frame * self.pose(q).jacobian(point);
        for k in 0..3 {
            out.columns[k] = k;
            out.values[k] = jacobian.column(k).into();
        }
        3
    }
}

/// The compliance of a body that no force moves: zero.
struct Immovable(Weights);

impl<const D: usize> Compliance<D> for Immovable {
    fn weights(&self) -> Weights {
        self.0
    }

    fn refactor(&mut self, w: Weights, _q: &[f64]) -> Result<(), FactorError> {
        self.0 = w;
        Ok(())
    }

    fn solve(&mut self, f: &mut [f64]) {
        f.fill(0.0);
    }

    fn couple(&mut self, _: &PartRows<'_, D>, _: &mut [f64], _: &mut Coupling<'_, D>) {}
}
