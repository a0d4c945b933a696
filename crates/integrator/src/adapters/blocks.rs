//! Rigid blocks as a subsystem: the adapter above `teeter-rigid`.

use crate::small::{add_outer, dot};
use crate::{
    Bodies, Compliance, Coupling, Dynamics, Energy, FactorError, ModelError, Motion, PartRows, Rows, Signal, Size,
    Traits, Vector, Weights,
};
use nalgebra::{Matrix2, Vector2, Vector3};
use std::sync::Arc;
use teeter_detect::Frame;
use teeter_rigid::{MassProperties, Pose, Rectangle};

/// A block as dynamics sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    mass: MassProperties,
    radius: f64,
}

impl Block {
    /// A rectangular block.
    #[must_use]
    pub fn new(mass: MassProperties, shape: &Rectangle) -> Self {
        Self { mass, radius: shape.radius() }
    }

    /// A block of any shape no part of which is further than `radius` (m) from its mass centre.
    #[must_use]
    pub fn within(mass: MassProperties, radius: f64) -> Self {
        Self { mass, radius }
    }
}

/// A coordinate of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BlockCoordinate {
    /// X of its mass centre, m.
    X,
    /// Y of its mass centre, m.
    Y,
    /// φ, counter-clockwise positive, rad.
    Turn,
}

/// A load on a block: a force through its mass centre, in world axes, and a couple. (A force
/// through another point also gives a couple that depends on the block's angle, so it isn't a load
/// P(t).)
#[derive(Clone, Debug)]
pub struct BlockLoad {
    /// Number of the block.
    pub block: usize,
    /// The force, N.
    pub force: Vector2<f64>,
    /// The couple, N·m, counter-clockwise positive.
    pub couple: f64,
    /// The signal by which both are multiplied.
    pub signal: Arc<dyn Signal>,
}

/// All blocks of a scene, with three coordinates each, (X, Y, φ), under weight, loads and
/// prescribed motion.
#[derive(Clone, Debug)]
pub struct Blocks {
    blocks: Vec<Block>,
    gravity: Vector2<f64>,
    loads: Vec<BlockLoad>,
    /// Numbers of the prescribed velocities, ascending, and their motions.
    driven: Vec<usize>,
    motions: Vec<Motion>,
}

impl Blocks {
    /// Blocks under gravity `gravity`, m/s².
    #[must_use]
    pub fn new(blocks: Vec<Block>, gravity: Vector2<f64>) -> Self {
        Self { blocks, gravity, loads: Vec::new(), driven: Vec::new(), motions: Vec::new() }
    }

    /// Adds a load.
    ///
    /// # Errors
    /// If there is no such block, or force or couple are not finite.
    pub fn with_load(mut self, load: BlockLoad) -> Result<Self, ModelError> {
        self.check_block(load.block)?;
        if !(load.force.iter().all(|f| f.is_finite()) && load.couple.is_finite()) {
            return Err(ModelError::Load { block: load.block });
        }
        self.loads.push(load);
        Ok(self)
    }

    fn check_block(&self, block: usize) -> Result<(), ModelError> {
        let blocks = self.blocks.len();
        if block < blocks { Ok(()) } else { Err(ModelError::Block { block, blocks }) }
    }

    /// Prescribes the motion of one coordinate of a block; the others stay free. The motion starts
    /// from the coordinate's value in the state, so only changes of a given displacement count. A
    /// later motion of the same coordinate replaces an earlier one.
    ///
    /// # Errors
    /// If there is no such block.
    pub fn with_motion(
        mut self,
        block: usize,
        coordinate: BlockCoordinate,
        motion: Motion,
    ) -> Result<Self, ModelError> {
        self.check_block(block)?;
        let velocity = 3 * block + coordinate as usize;
        match self.driven.binary_search(&velocity) {
            Ok(at) => self.motions[at] = motion,
            Err(at) => {
                self.driven.insert(at, velocity);
                self.motions.insert(at, motion);
            }
        }
        Ok(self)
    }
}

impl Blocks {
    fn add_loads(&self, factor: impl Fn(&dyn Signal) -> f64, f: &mut [f64]) {
        for load in &self.loads {
            let (factor, first) = (factor(load.signal.as_ref()), 3 * load.block);
            f[first] += factor * load.force.x;
            f[first + 1] += factor * load.force.y;
            f[first + 2] += factor * load.couple;
        }
    }
}

fn triple(x: &[f64], body: usize) -> Vector3<f64> {
    Vector3::new(x[3 * body], x[3 * body + 1], x[3 * body + 2])
}

impl Dynamics<2> for Blocks {
    fn size(&self) -> Size {
        let n = self.blocks.len();
        Size { q: 3 * n, v: 3 * n, bodies: n, row: 3 }
    }

    fn traits(&self) -> Traits {
        let g = self.gravity.norm();
        let scale = self.blocks.iter().map(|block| block.mass.mass * g * block.radius).sum();
        Traits::free().loaded(!self.loads.is_empty()).driven(self.driven.clone()).energy_scale(scale)
    }

    fn internal_force(&self, _q: &[f64], _v: &[f64], f: &mut [f64]) {
        for (f, block) in f.chunks_exact_mut(3).zip(&self.blocks) {
            f[0] += block.mass.mass * self.gravity.x;
            f[1] += block.mass.mass * self.gravity.y;
        }
    }

    fn load(&self, t: f64, f: &mut [f64]) {
        self.add_loads(|signal| signal.value(t), f);
    }

    fn mean_load(&self, [from, to]: [f64; 2], _scratch: &mut [f64], f: &mut [f64]) {
        self.add_loads(|signal| signal.mean(from, to), f);
    }

    fn drive(&self, t: f64, v: &mut [f64]) {
        for (velocity, motion) in self.driven.iter().zip(&self.motions) {
            v[*velocity] = motion.velocity(t);
        }
    }

    fn drive_rate(&self, t: f64, a: &mut [f64]) -> bool {
        for (velocity, motion) in self.driven.iter().zip(&self.motions) {
            a[*velocity] = motion.acceleration(t);
        }
        true
    }

    fn next_break(&self, t: f64) -> f64 {
        let loads = self.loads.iter().map(|load| load.signal.next_break(t));
        loads.chain(self.motions.iter().map(|motion| motion.next_break(t))).fold(f64::INFINITY, f64::min)
    }

    fn load_count(&self) -> usize {
        self.loads.len()
    }

    fn next_load_break(&self, load: usize, t: f64) -> f64 {
        self.loads.get(load).map_or(f64::INFINITY, |load| load.signal.next_break(t))
    }

    fn drive_mean(&self, [from, to]: [f64; 2], v: &mut [f64]) {
        for (velocity, motion) in self.driven.iter().zip(&self.motions) {
            v[*velocity] = motion.mean_velocity(from, to);
        }
    }

    fn apply(&self, w: Weights, _q: &[f64], x: &[f64], y: &mut [f64]) {
        if w.mass != 0.0 {
            for ((y, x), block) in y.chunks_exact_mut(3).zip(x.chunks_exact(3)).zip(&self.blocks) {
                let m = block.mass.diagonal();
                for k in 0..3 {
                    y[k] += w.mass * m[k] * x[k];
                }
            }
        }
    }

    fn energy(&self, q: &[f64], v: &[f64]) -> Energy {
        let mut energy = Energy::default();
        for (k, block) in self.blocks.iter().enumerate() {
            energy.kinetic += block.mass.kinetic_energy(&triple(v, k));
            energy.gravity -= block.mass.mass * (self.gravity.x * q[3 * k] + self.gravity.y * q[3 * k + 1]);
        }
        energy
    }

    fn factor(&self, w: Weights, _q: &[f64]) -> Result<Box<dyn Compliance<2>>, FactorError> {
        let mass = self.blocks.iter().flat_map(|block| block.mass.diagonal().data.0[0]).collect();
        let (inverse, driven) = (vec![0.0; 3 * self.blocks.len()], self.driven.clone());
        let mut compliance = BlockCompliance { touched: Vec::new(), weights: w, mass, inverse, driven };
        compliance.refactor(w, &[])?;
        Ok(Box::new(compliance))
    }
}

impl Bodies<2> for Blocks {
    fn bias(&self, body: u32, q: &[f64], v: &[f64], point: &Vector2<f64>, frame: &Frame<2>) -> Option<Vector<2>> {
        Some(frame * turning_bias(&triple(q, body as usize), v.get(3 * body as usize + 2)?, point))
    }

    fn fastest(&self, v: &[f64]) -> f64 {
        let blocks = v.chunks_exact(3).zip(&self.blocks);
        blocks.map(|(v, block)| v[0].hypot(v[1]) + v[2].abs() * block.radius).fold(0.0, f64::max)
    }

    fn place(&self, body: u32, q: &[f64], local: &[Vector2<f64>], out: &mut [Vector2<f64>]) {
        let pose = Pose::new(&triple(q, body as usize));
        for (x, rho) in out.iter_mut().zip(local) {
            *x = pose.point(rho);
        }
    }

    fn rows(&self, body: u32, q: &[f64], point: &Vector2<f64>, frame: &Frame<2>, out: &mut Rows<'_, 2>) -> usize {
        // The point moves at (ẋ − φ̇ r_y, ẏ + φ̇ r_x).
        let r = Pose::new(&triple(q, body as usize)).rotate(point);
        let [x, y] = frame.data.0;
        let turn = [x[0] * -r.y + y[0] * r.x, x[1] * -r.y + y[1] * r.x];
        for (k, column) in [x, y, turn].into_iter().enumerate() {
            out.columns[k] = 3 * body as usize + k;
            out.values[k] = column.into();
        }
        3
    }
}

/// The acceleration of a point of a body that turns at a constant rate ω about its centre, −ω² r,
/// m/s².
pub(crate) fn turning_bias(pose: &Vector3<f64>, omega: &f64, point: &Vector2<f64>) -> Vector2<f64> {
    Pose::new(pose).rotate(point) * -(omega * omega)
}

/// Up to so many contacts all pairs are looked at.
const FEW: usize = 16;

/// diag(1/m, 1/m, 1/I) of every block, 0 where the velocity is prescribed.
struct BlockCompliance {
    /// Block, contact and side of each row, where there are many.
    touched: Vec<(usize, usize, usize)>,
    weights: Weights,
    mass: Vec<f64>,
    inverse: Vec<f64>,
    driven: Vec<usize>,
}

impl BlockCompliance {
    #[inline]
    fn inverse_of(&self, columns: &[usize]) -> &[f64; 3] {
        inverse_of(&self.inverse, columns)
    }

    /// What contacts feel of each other, pair by pair.
    #[inline(never)]
    fn couple_few(&self, rows: &PartRows<'_, 2>, h: &mut Coupling<'_, 2>) {
        for (i, columns_i, values_i) in rows.iter() {
            for (j, columns_j, values_j) in rows.iter() {
                // Contacts of different blocks aren't coupled: W is diagonal.
                if columns_i[0] == columns_j[0] {
                    h.add(i, j, &felt(self.inverse_of(columns_i), values_i, values_j));
                }
            }
        }
    }

    /// What the contacts of each block feel of each other, block by block.
    #[inline(never)]
    fn couple_neighbours(&mut self, rows: &PartRows<'_, 2>, h: &mut Coupling<'_, 2>) {
        let Self { touched, inverse, .. } = self;
        touched.clear();
        for contact in 0..rows.contacts() {
            for side in 0..2 {
                if let Some((columns, _)) = rows.get(contact, side) {
                    touched.push((columns[0], contact, side));
                }
            }
        }
        touched.sort_unstable();
        for of_block in touched.chunk_by(|a, b| a.0 == b.0) {
            for &(_, i, side_i) in of_block {
                for &(_, j, side_j) in of_block {
                    let (Some((columns, a)), Some((_, b))) = (rows.get(i, side_i), rows.get(j, side_j)) else {
                        continue;
                    };
                    h.add(i, j, &felt(inverse_of(inverse, columns), a, b));
                }
            }
        }
    }
}

impl Compliance<2> for BlockCompliance {
    fn weights(&self) -> Weights {
        self.weights
    }

    fn refactor(&mut self, w: Weights, _q: &[f64]) -> Result<(), FactorError> {
        // Written so that NaN fails too.
        if !(w.mass > 0.0) {
            return Err(FactorError { weights: w, reason: "a rigid block has mass only".into() });
        }
        for (inverse, mass) in self.inverse.iter_mut().zip(&self.mass) {
            *inverse = (w.mass * mass).recip();
        }
        for velocity in &self.driven {
            self.inverse[*velocity] = 0.0;
        }
        self.weights = w;
        Ok(())
    }

    fn is_diagonal(&self) -> bool {
        true
    }

    fn solve(&mut self, f: &mut [f64]) {
        for (f, inverse) in f.iter_mut().zip(&self.inverse) {
            *f *= inverse;
        }
    }

    fn couple(&mut self, rows: &PartRows<'_, 2>, _scratch: &mut [f64], h: &mut Coupling<'_, 2>) {
        if let Some((columns, values)) = rows.only() {
            h.add(0, 0, &felt(self.inverse_of(columns), values, values));
        } else if rows.contacts() > FEW {
            self.couple_neighbours(rows, h);
        } else {
            self.couple_few(rows, h);
        }
    }

    fn respond(&mut self, rows: &PartRows<'_, 2>, p: &[Vector<2>], _scratch: &mut [f64], v: &mut [f64]) {
        if let Some((columns, values)) = rows.only() {
            push(self.inverse_of(columns), values, &p[0], &mut v[columns[0]..]);
        } else {
            for (contact, columns, values) in rows.iter() {
                push(self.inverse_of(columns), values, &p[contact], &mut v[columns[0]..]);
            }
        }
    }
}

/// The entries of W of the block that a row acts on: its columns are three that follow each other.
#[inline]
fn inverse_of<'a>(inverse: &'a [f64], columns: &[usize]) -> &'a [f64; 3] {
    const NONE: [f64; 3] = [0.0; 3];
    inverse.get(columns[0]..).and_then(<[f64]>::first_chunk).unwrap_or(&NONE)
}

/// What one contact of a block feels of another, J_i W J_jᵀ.
#[inline]
fn felt(inverse: &[f64; 3], a: &[Vector<2>], b: &[Vector<2>]) -> Matrix2<f64> {
    let mut block = Matrix2::zeros();
    if let (Some(a), Some(b)) = (a.first_chunk::<3>(), b.first_chunk::<3>()) {
        for k in 0..3 {
            add_outer(&mut block, &a[k], &b[k], inverse[k]);
        }
    }
    block
}

/// What an impulse on a block does to its velocities, v += W J_iᵀ p.
#[inline]
fn push(inverse: &[f64; 3], a: &[Vector<2>], p: &Vector<2>, v: &mut [f64]) {
    if let (Some(a), Some(v)) = (a.first_chunk::<3>(), v.first_chunk_mut::<3>()) {
        for k in 0..3 {
            v[k] += inverse[k] * dot(&a[k], p);
        }
    }
}
