//! Fixed flat ground: a subsystem without velocities.

use crate::{Compliance, Energy, FactorError, Rows, Size, Subsystem, Weights};
use nalgebra::Vector2;
use teeter_detect::{Frame, Kinematics, SurfacePoint};

/// The half plane below a level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    level: f64,
}

impl Ground {
    /// Flat ground at y = `level`, m.
    #[must_use]
    pub fn flat(level: f64) -> Self {
        Self { level }
    }
}

impl Subsystem<2> for Ground {
    fn size(&self) -> Size {
        Size { q: 0, v: 0, bodies: 1, row: 0 }
    }

    fn internal_force(&self, _q: &[f64], _v: &[f64], _f: &mut [f64]) {}

    fn apply(&self, _w: Weights, _q: &[f64], _x: &[f64], _y: &mut [f64]) {}

    fn energy(&self, _q: &[f64], _v: &[f64]) -> Energy {
        Energy::default()
    }

    fn place(&self, _body: u32, _q: &[f64], local: &[Vector2<f64>], out: &mut [Vector2<f64>]) {
        out.copy_from_slice(local);
    }

    fn surface(&self, _body: u32, _q: &[f64], _: Kinematics, at: &Vector2<f64>) -> Option<SurfacePoint<2>> {
        let foot = Vector2::new(at.x, self.level);
        Some(SurfacePoint { place: foot, normal: Vector2::y(), material: foot })
    }

    fn rows(&self, _: u32, _: &[f64], _: &Vector2<f64>, _: &Frame<2>, _: &mut Rows<'_, 2>) -> usize {
        0
    }

    fn factor(&self, w: Weights, _q: &[f64]) -> Result<Box<dyn Compliance<2>>, FactorError> {
        Ok(Box::new(Immovable(w)))
    }
}

/// The compliance of what has no velocities.
struct Immovable(Weights);

impl Compliance<2> for Immovable {
    fn weights(&self) -> Weights {
        self.0
    }

    fn refactor(&mut self, w: Weights, _q: &[f64]) -> Result<(), FactorError> {
        self.0 = w;
        Ok(())
    }

    fn solve(&mut self, _f: &mut [f64]) {}
}
