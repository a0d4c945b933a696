//! Parametric pivots: the solution of a plane problem is followed while q changes.
//!
//! A [`Tracker`] holds a problem of the scaled H, the cell of each contact (`cells.rs`) and values
//! of its coordinates that satisfy the law and H p − u + base + z shift = 0. With a basis of
//! all coordinates, the values are linear in z until one of them reaches its bound; then the one that
//! enters in the neighbouring cell takes its place in the basis (Cottle, Pang and Stone 1992, doi
//! 10.1137/1.9780898719000, §4.5). The bound is chosen with Harris' test (1973, doi
//! 10.1007/BF01580108): among those that are met within a small slack, the one with the largest pivot.
//!
//! # Orientation
//!
//! The surfaces of all contacts together are a piecewise linear manifold, so the way is a curve with a
//! direction that it keeps: z falls where the determinant of the basis has the sign that it has
//! where all contacts are open, and grows where it has the other. If shift_N > μ |shift_T| at all
//! contacts, H is positive semi-definite and a null vector of H does no work on q, such a curve
//! can't go to infinity in this direction. (Along a ray with z growing, pᵀ H p − pᵀ u + z pᵀ
//! shift = 0 has no negative part, so p = 0: the ray on which all contacts are open, where z
//! falls. Along a ray of constant z, H p = 0 and pᵀ u = z pᵀ shift > 0, but a sliding contact's impulse
//! opposes its velocity.) So from any solution it leads to one at z = 0 by a finite number of pivots.
//! Against the direction, or with another shift, it may end on a ray.

use crate::basis::Basis;
use crate::cells::{Cell, Coordinate};
use crate::memory::{refill, reserve};
use crate::ordering::Ordering;
use crate::scaled::Scaled;
use nalgebra::Vector2;
use teeter_contact::{Block, Stop};

/// No position, or no variable at a position.
const NONE: u32 = u32::MAX;
/// Least pivot relative to the largest number of its direction; smaller ones are rounding.
const PIVOT: f64 = 1e-10;
/// A value may pass its bound by this, with the largest |q| scaled to 1.
const SLACK: f64 = 1e-12;
/// The part of a column's largest number up to which it counts as dependent on others in the crossover,
/// and in a basis that pivots have led to.
const DEPENDENT: f64 = 1e-7;
const SINGULAR: f64 = 1e-14;
/// The difference of z, relative to it, up to which a point in the same cells is one that was met before.
const SAME: f64 = 1e-6;
/// Most times that the basis is searched for dependent columns.
const CROSSINGS: u32 = 10;

/// How following a solution ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// z = 0.
    Arrived,
    /// z has reached its limit, which is given.
    Escaped,
    /// The curve is closed, or rounding has led back to it. The cells are those of the start.
    Looped,
    /// z would grow without limit, the basis is singular, or too many pivots.
    Lost,
}

/// The problem, its solution for the current z, and the basis.
#[derive(Debug, Default)]
pub(crate) struct Tracker {
    /// H by columns.
    column_start: Vec<usize>,
    blocks: Vec<(u32, Block<2>)>,
    mu: Vec<f64>,
    ordering: Ordering,
    /// Contacts in elimination order, and the place of each.
    order: Vec<usize>,
    rank: Vec<usize>,
    basis: Basis,
    pub(crate) cells: Vec<Cell>,
    /// The cells where following started, and some on its way.
    home: Vec<Cell>,
    met: Vec<Cell>,
    /// The coordinates of each contact in the order of [`Coordinate`]; zero if they aren't its
    /// cell's.
    pub(crate) values: Vec<[f64; 4]>,
    pub(crate) base: Vec<f64>,
    pub(crate) shift: Vec<f64>,
    /// The variable at each position of the basis, and the position of each: 4 i + coordinate, and at
    /// last z.
    variable: Vec<u32>,
    position: Vec<u32>,
    x: Vec<f64>,
    right: Vec<f64>,
    direction: Vec<f64>,
    /// The positions in the order of elimination.
    positions: Vec<u32>,
    /// Dependent variables and their values.
    spare: Vec<(u32, f64)>,
    /// Pivots and moves of the crossover.
    pub(crate) pivots: u32,
}

impl Tracker {
    pub(crate) fn reserve(&mut self, contacts: usize, blocks: usize) {
        reserve(&mut self.column_start, contacts + 1);
        reserve(&mut self.blocks, blocks);
        reserve(&mut self.mu, contacts);
        self.ordering.reserve(contacts, blocks);
        self.basis.reserve(2 * contacts, 4 * blocks);
        for x in [&mut self.order, &mut self.rank] {
            reserve(x, contacts);
        }
        for x in [&mut self.cells, &mut self.home, &mut self.met] {
            reserve(x, contacts);
        }
        reserve(&mut self.values, contacts);
        for x in [&mut self.base, &mut self.shift, &mut self.x, &mut self.right, &mut self.direction] {
            reserve(x, 2 * contacts);
        }
        for x in [&mut self.variable, &mut self.positions] {
            reserve(x, 2 * contacts);
        }
        reserve(&mut self.position, 4 * contacts + 1);
        reserve(&mut self.spare, 2 * contacts);
    }

    /// Copies H by columns, and orders the contacts.
    pub(crate) fn load(&mut self, scaled: &Scaled<2>) {
        let h = &scaled.h;
        let n = h.contacts();
        self.mu.clear();
        self.mu.extend_from_slice(&scaled.mu);
        refill(&mut self.column_start, n + 1, 0);
        for &j in h.columns() {
            self.column_start[j + 1] += 1;
        }
        for j in 0..n {
            self.column_start[j + 1] += self.column_start[j];
        }
        refill(&mut self.blocks, h.columns().len(), (0, Block::zeros()));
        for i in 0..n {
            for t in h.range(i) {
                let j = h.columns()[t];
                self.blocks[self.column_start[j]] = (i as u32, h.blocks()[t]);
                self.column_start[j] += 1;
            }
        }
        // Each start has moved to the next one.
        for j in (0..n).rev() {
            self.column_start[j + 1] = self.column_start[j];
        }
        self.column_start[0] = 0;
        self.ordering.neighbours_of(h);
        self.ordering.order(&mut self.order, &mut self.rank);
        for x in [&mut self.base, &mut self.shift] {
            refill(x, 2 * n, 0.0);
        }
        self.cells.clear();
        self.values.clear();
        self.pivots = 0;
    }

    fn z(&self) -> u32 {
        4 * self.mu.len() as u32
    }

    fn rubs(&self, contact: usize) -> bool {
        self.mu[contact] > 0.0
    }

    /// The impulse of a contact.
    pub(crate) fn impulse(&self, contact: usize) -> Vector2<f64> {
        let [a, b, ..] = self.values[contact].map(|x| x.max(0.0));
        Vector2::new(a + b, self.mu[contact] * (b - a))
    }

    /// Makes the coordinates of the cells the basis, and factorises it. False if it is singular.
    fn set_basis(&mut self, dependent: f64) -> bool {
        let n = self.mu.len();
        refill(&mut self.variable, 2 * n, 0);
        refill(&mut self.position, 4 * n + 1, NONE);
        for x in [&mut self.x, &mut self.right, &mut self.direction] {
            refill(x, 2 * n, 0.0);
        }
        for i in 0..n {
            for (k, coordinate) in self.cells[i].coordinates().into_iter().enumerate() {
                let (v, at) = (4 * i + coordinate as usize, 2 * i + k);
                self.variable[at] = v as u32;
                self.position[v] = at as u32;
                self.x[at] = self.values[i][coordinate as usize];
            }
        }
        self.factorise(dependent)
    }

    fn factorise(&mut self, dependent: f64) -> bool {
        let (z, variable, rank) = (self.z(), &self.variable, &self.rank);
        self.positions.clear();
        self.positions.extend((0..variable.len() as u32).filter(|&at| variable[at as usize] != z));
        // Velocities have one number in their columns. z has many, so it is the last.
        self.positions.sort_unstable_by_key(|&at| {
            let v = variable[at as usize] as usize;
            (Coordinate::ALL[v % 4].is_impulse(), rank[v / 4], v % 4)
        });
        if let Some(at) = Some(self.position[z as usize]).filter(|&at| at != NONE) {
            self.positions.push(at);
        }
        let columns = Columns { start: &self.column_start, blocks: &self.blocks, mu: &self.mu, shift: &self.shift };
        let owner = |at: u32| variable[at as usize] / 4;
        self.basis.factorise(&self.positions, dependent, owner, |at, column| {
            columns.of(variable[at as usize], |row, x| column.push((row, x)));
        });
        self.basis.dependent().is_empty()
    }

    /// The change of the basis' variables with a variable, negative, in `direction`.
    fn set_direction(&mut self, variable: u32) {
        let columns = Columns { start: &self.column_start, blocks: &self.blocks, mu: &self.mu, shift: &self.shift };
        self.right.fill(0.0);
        let right = &mut self.right;
        columns.of(variable, |row, x| right[row as usize] += x);
        self.basis.solve(&mut self.right, &mut self.direction);
    }

    /// The values of the basis' variables for the current base, and z unless it is one of them.
    fn evaluate(&mut self, z: f64) {
        for r in 0..self.right.len() {
            self.right[r] = -self.base[r] - z * self.shift[r];
        }
        self.basis.solve(&mut self.right, &mut self.x);
    }

    /// Exchanges the variable at a position for another with a value.
    fn exchange(&mut self, at: usize, entering: u32, value: f64) {
        let leaving = std::mem::replace(&mut self.variable[at], entering);
        self.position[leaving as usize] = NONE;
        self.position[entering as usize] = at as u32;
        self.x[at] = value;
        self.pivots += 1;
    }

    /// Copies the basis' variables to the contacts.
    fn keep(&mut self) {
        for (v, &at) in self.position[..self.mu.len() * 4].iter().enumerate() {
            self.values[v / 4][v % 4] = if at == NONE { 0.0 } else { self.x[at as usize] };
        }
    }

    /// Moves the impulses until the basis is regular. The velocities stay, so the problem is then
    /// solved for another base. False if this fails.
    pub(crate) fn cross(&mut self) -> bool {
        for _ in 0..CROSSINGS {
            if self.set_basis(DEPENDENT) {
                return true;
            }
            self.spare.clear();
            for &at in self.basis.dependent() {
                let v = std::mem::replace(&mut self.variable[at as usize], NONE);
                self.position[v as usize] = NONE;
                self.spare.push((v, self.x[at as usize]));
            }
            for k in 0..self.spare.len() {
                let (v, value) = self.spare[k];
                self.set_direction(v);
                self.reduce(v, value);
            }
            for i in 0..self.mu.len() {
                let value = |c: Coordinate| match self.position[4 * i + c as usize] {
                    NONE => None,
                    at => Some(self.x[at as usize].max(0.0)),
                };
                let [.., normal, tangential] = self.values[i];
                (self.cells[i], self.values[i]) = match (value(Coordinate::A), value(Coordinate::B)) {
                    (Some(a), Some(b)) => (Cell::Stick, [a, b, 0.0, 0.0]),
                    (Some(a), None) => (Cell::Forward, [a, 0.0, 0.0, tangential]),
                    (None, Some(b)) => (Cell::Backward, [0.0, b, 0.0, tangential]),
                    (None, None) => (Cell::Open, [0.0, 0.0, normal, tangential]),
                };
            }
        }
        false
    }

    /// Reduces a dependent impulse to zero, with the change of the others in `direction`; or until one of
    /// these is zero, whose place it takes.
    fn reduce(&mut self, v: u32, value: f64) {
        let is_impulse = |v: u32| v != NONE && Coordinate::ALL[v as usize % 4].is_impulse();
        let all = self.x.iter().zip(&self.direction).zip(&self.variable).enumerate();
        let all = all.filter(|(_, (_, v))| is_impulse(**v)).map(|(at, ((x, w), _))| (at, x.max(0.0), -w));
        let largest = all.clone().fold(1.0_f64, |most, (_, _, w)| most.max(w.abs()));
        let falling = all.filter(|(_, _, w)| *w > DEPENDENT * largest);
        let bound = falling.clone().fold(value, |bound, (_, x, w)| bound.min((x + SLACK) / w));
        let tied = falling.filter(|(_, x, w)| x / w <= bound && x / w < value);
        let chosen = tied.fold(None, |best: Option<(usize, f64, f64)>, (at, x, w)| match best {
            Some((_, _, most)) if most >= w => best,
            _ => Some((at, x / w, w)),
        });
        let step = chosen.map_or(value, |(_, step, _)| step);
        for (at, x) in self.x.iter_mut().enumerate() {
            if is_impulse(self.variable[at]) {
                *x += step * self.direction[at];
            }
        }
        if let Some((at, step, _)) = chosen {
            self.exchange(at, v, value - step);
            self.basis.exchange(at, &self.direction);
        }
    }

    /// 1 if the variable at a position has to be ≥ 0, −1 if ≤ 0, and 0 if it is free.
    fn sign(&self, at: usize) -> f64 {
        let v = self.variable[at] as usize;
        match self.cells.get(v / 4) {
            Some(cell) => cell.sign(Coordinate::ALL[v % 4], self.rubs(v / 4)),
            // z
            None => 1.0,
        }
    }

    /// Follows the solution from z = `start` in its direction to z = 0, or to `most_z`, with up to
    /// `most` pivots in all. Where z would fall from 0, it stays there.
    pub(crate) fn follow(&mut self, start: f64, most_z: f64, most: u32, stop: &Stop<'_>) -> End {
        if !self.set_basis(SINGULAR) {
            return End::Lost;
        }
        self.evaluate(start);
        // The determinant of a single contact's basis is negative where it slides, else positive.
        let slides = self.cells.iter().filter(|cell| matches!(cell, Cell::Forward | Cell::Backward)).count();
        let falls = self.basis.determinant_is_positive() == (slides % 2 == 0);
        if falls && start == 0.0 {
            return End::Arrived;
        }
        self.home.clone_from(&self.cells);
        // Cells met before, after 1, 2, 4, … pivots (Brent's search for a cycle), and z there.
        self.met.clone_from(&self.cells);
        let (mut met_z, mut next, mut count) = (f64::NAN, 1, 0);
        let (mut entering, mut sense, mut from) = (self.z(), if falls { -1.0 } else { 1.0 }, start);
        while self.pivots < most && !stop.cancelled() {
            self.set_direction(entering);
            let own = match entering == self.z() {
                true if falls => start,
                true => most_z - start,
                false => f64::INFINITY,
            };
            let Some((step, leaving, end)) = self.first_bound(sense, own, most_z) else { return End::Lost };
            for (x, w) in self.x.iter_mut().zip(&self.direction) {
                *x -= sense * step * w;
            }
            let Some(at) = leaving else {
                self.keep();
                return if falls { End::Arrived } else { End::Escaped };
            };
            let left = self.variable[at] as usize;
            self.exchange(at, entering, from + sense * step);
            if let Some(end) = end {
                self.keep();
                return end;
            }
            let z = self.x[self.position[self.z() as usize] as usize];
            count += 1;
            if (z - met_z).abs() <= SAME * z && self.cells == self.met {
                self.cells.clone_from(&self.home);
                return End::Looped;
            }
            if count == next {
                (met_z, next) = (z, 2 * next);
                self.met.clone_from(&self.cells);
            }
            self.basis.exchange(at, &self.direction);
            if self.basis.is_worn() {
                if !self.factorise(SINGULAR) {
                    return End::Lost;
                }
                self.evaluate(0.0);
            }
            let contact = left / 4;
            let slip = match self.position[4 * contact + Coordinate::Tangential as usize] {
                NONE => 0.0,
                at => self.x[at as usize],
            };
            let rubs = self.rubs(contact);
            let (cell, next) = self.cells[contact].beyond(Coordinate::ALL[left % 4], slip, rubs);
            self.cells[contact] = cell;
            (entering, from) = ((4 * contact + next as usize) as u32, 0.0);
            sense = if cell.sign(next, rubs) < 0.0 { -1.0 } else { 1.0 };
        }
        End::Lost
    }

    /// The step to the first bound, and the position of the variable that meets it, none if it is the
    /// entering one after `own`; and how z ends if it is z. None if there is no bound.
    fn first_bound(&self, sense: f64, own: f64, most_z: f64) -> Option<(f64, Option<usize>, Option<End>)> {
        let largest = self.direction.iter().fold(0.0_f64, |most, w| most.max(w.abs()));
        let falling = (0..self.x.len()).filter_map(|at| {
            let sign = self.sign(at);
            let rate = sign * sense * self.direction[at];
            (rate > PIVOT * largest).then(|| (at, (sign * self.x[at]).max(0.0), rate))
        });
        let bound = falling.clone().fold(own, |bound, (_, x, rate)| bound.min((x + SLACK) / rate));
        let z = self.position[self.z() as usize];
        if let Some(&value) = self.x.get(z as usize) {
            let rate = -sense * self.direction[z as usize];
            let room = (most_z - value).max(0.0) / rate;
            if rate > 0.0 && room <= bound {
                return room.is_finite().then_some((room, Some(z as usize), Some(End::Escaped)));
            }
        }
        if bound == f64::INFINITY {
            return None;
        }
        if bound >= own {
            return Some((own, None, None));
        }
        let mut chosen = None;
        let mut largest = 0.0;
        for (at, x, rate) in falling {
            if x / rate > bound {
                continue;
            }
            if at == z as usize {
                return Some((x / rate, Some(at), Some(End::Arrived)));
            }
            if rate > largest {
                (chosen, largest) = (Some((at, x / rate)), rate);
            }
        }
        chosen.map(|(at, step)| (step, Some(at), None))
    }

    /// Computes the values anew from the base, which z = 0 belongs to. False if the basis is
    /// singular.
    pub(crate) fn polish(&mut self) -> bool {
        if !self.set_basis(SINGULAR) {
            return false;
        }
        self.evaluate(0.0);
        self.keep();
        true
    }
}

/// The columns of the basis.
struct Columns<'a> {
    start: &'a [usize],
    blocks: &'a [(u32, Block<2>)],
    mu: &'a [f64],
    shift: &'a [f64],
}

impl Columns<'_> {
    /// Gives the numbers of a variable's column with their rows.
    fn of(&self, variable: u32, mut out: impl FnMut(u32, f64)) {
        let i = variable as usize / 4;
        let Some(&mu) = self.mu.get(i) else {
            for (row, &x) in self.shift.iter().enumerate().filter(|(_, x)| **x != 0.0) {
                out(row as u32, x);
            }
            return;
        };
        let across = match Coordinate::ALL[variable as usize % 4] {
            Coordinate::A => -mu,
            Coordinate::B => mu,
            Coordinate::Normal => return out(2 * i as u32, -1.0),
            Coordinate::Tangential => return out(2 * i as u32 + 1, -1.0),
        };
        for (j, h) in &self.blocks[self.start[i]..self.start[i + 1]] {
            for k in 0..2 {
                out(2 * j + k as u32, h[(k, 0)] + across * h[(k, 1)]);
            }
        }
    }
}
