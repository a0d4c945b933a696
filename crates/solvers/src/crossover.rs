//! Pivots from a near-solution of a large plane problem.
//!
//! **What it solves**: exact Signorini–Coulomb in the plane, for hundreds of contacts, from impulses
//! that nearly solve the problem; H may be asymmetric or singular.
//!
//! **When to use it**: for jammed piles. Tens of their contacts could be closed in groups without a
//! change of the velocities (H is singular there), and some more nearly so (1e-5 to 1e-11). Methods that
//! follow the residual stop at 1e-6 to 1e-10 then, with some contacts in the wrong cell.
//!
//! **How**, in three parts:
//!
//! 1. *Crossover* (as from an interior solution of a linear program to a vertex: Megiddo 1991, doi
//!    10.1287/ijoc.3.1.63). The impulses give each contact its cell (`cells.rs`). While the columns of
//!    the active coordinates depend on each other, the impulses are moved along a null vector until one
//!    of them is zero, and its contact changes its cell. The velocities stay.
//! 2. The impulses and velocities so found satisfy the law exactly, and H p − u + q̃ = 0 with a q̃
//!    that differs from q by about the residual. Values at their bounds are lifted off them first,
//!    each by another small amount, so that no two bounds are met at once.
//! 3. *Parametric pivots* (Cottle, Pang and Stone 1992, doi 10.1137/1.9780898719000, §4.5): the
//!    solution is followed from q̃ to q along q + z (q̃ − q), z from 1 to 0, from cell to cell. In
//!    each the solution is linear in z. The way may turn back to larger z in between.
//!
//! **Cost**: sparse factorisations of the basis (`basis.rs`), one at each start, one after fifty pivots,
//! and a solve with them for each pivot. A jammed pile of 300 stones takes some tens of pivots, as
//! the start is near, where [`Lemke`](crate::Lemke) takes thousands from scratch. `iterations` counts
//! pivots.
//!
//! **How it fails**: far from a solution the way is long, or goes on to infinite z (a ray). It gives
//! up after some pivots per contact; the caller goes on with another method from the best impulses.

use crate::basis::Basis;
use crate::cells::{Cell, Coordinate};
use crate::ending::ended;
use crate::memory::{refill, reserve};
use crate::ordering::Ordering;
use crate::scaled::{Scaled, make_finite};
use nalgebra::Vector2;
use teeter_contact::{Block, ContactProblem, ContactSolver, Law, Outcome, Stop, de_saxce, judge, project};

const NONE: u32 = u32::MAX;

#[derive(Debug, Default)]
pub struct Crossover {
    scaled: Scaled<2>,
    /// H by columns.
    column_start: Vec<usize>,
    column: Vec<(u32, Block<2>)>,
    ordering: Ordering,
    order: Vec<usize>,
    order_place: Vec<usize>,
    basis: Basis,
    cells: Vec<Cell>,
    /// The coordinates of each contact; zero if they aren't its cell's.
    values: Vec<[f64; 4]>,
    /// q̃ − q.
    shift: Vec<f64>,
    base: Vec<f64>,
    at_z: f64,
    /// The variable at each position of the basis, and the position of each.
    variable: Vec<u32>,
    place: Vec<u32>,
    x: Vec<f64>,
    right: Vec<f64>,
    direction: Vec<f64>,
    positions: Vec<u32>,
    found: Vec<Vector2<f64>>,
    u: Vec<Vector2<f64>>,
    best: Vec<Vector2<f64>>,
    pub log: String,
}

#[derive(Debug, PartialEq)]
enum End { Solved, Escaped, Ray, Cap }

impl Crossover {
    pub const NAME: &'static str = "crossover";
    pub fn new() -> Self { Self::default() }

    fn contacts(&self) -> usize { self.cells.len() }

    fn load_columns(&mut self) {
        let h = &self.scaled.h;
        let n = h.contacts();
        refill(&mut self.column_start, n + 1, 0);
        for &j in h.columns() {
            self.column_start[j + 1] += 1;
        }
        for j in 0..n {
            self.column_start[j + 1] += self.column_start[j];
        }
        refill(&mut self.column, h.columns().len(), (0, Block::zeros()));
        for i in 0..n {
            for t in h.range(i) {
                let j = h.columns()[t];
                self.column[self.column_start[j]] = (i as u32, h.blocks()[t]);
                self.column_start[j] += 1;
            }
        }
        for j in (0..n).rev() {
            self.column_start[j + 1] = self.column_start[j];
        }
        self.column_start[0] = 0;
        self.ordering.neighbours_of(h);
        self.ordering.order(&mut self.order, &mut self.order_place);
    }

    /// Cells and coordinates from impulses.
    fn enter(&mut self, p: &[Vector2<f64>], unit: f64) {
        let n = p.len();
        refill(&mut self.found, n, Vector2::zeros());
        refill(&mut self.u, n, Vector2::zeros());
        self.scaled.velocities(p, &mut self.u);
        for i in 0..n {
            let mu = self.scaled.mu[i];
            self.found[i] = project(&(p[i] - de_saxce(&self.u[i], mu)), mu);
        }
        self.scaled.velocities(&self.found, &mut self.u);
        self.cells.clear();
        self.values.clear();
        for i in 0..n {
            let (p, u, mu) = (self.found[i] / unit, self.u[i] / unit, self.scaled.mu[i]);
            let slack = 1e-12 * (1.0 + p[0]);
            let (cell, values) = if p[0] <= 1e-14 {
                (Cell::Open, [0.0, 0.0, u[0].max(0.0), u[1]])
            } else if mu == 0.0 {
                (Cell::Forward, [p[0], 0.0, 0.0, u[1]])
            } else if mu * p[0] - p[1].abs() > slack {
                (Cell::Stick, [0.5 * (p[0] - p[1] / mu), 0.5 * (p[0] + p[1] / mu), 0.0, 0.0])
            } else if p[1] < 0.0 {
                (Cell::Forward, [p[0], 0.0, 0.0, u[1].max(0.0)])
            } else {
                (Cell::Backward, [0.0, p[0], 0.0, u[1].min(0.0)])
            };
            self.cells.push(cell);
            self.values.push(values);
        }
    }

    fn factorise(&mut self) {
        let n = self.contacts();
        // velocities first, then impulses in elimination order, z last
        self.positions.clear();
        let mut last = NONE;
        for at in 0..2 * n as u32 {
            let v = self.variable[at as usize];
            if v == 4 * n as u32 { last = at } else { self.positions.push(at) }
        }
        let (variable, order_place) = (&self.variable, &self.order_place);
        self.positions.sort_unstable_by_key(|&at| {
            let v = variable[at as usize] as usize;
            let impulse = Coordinate::ALL[v % 4].is_impulse();
            (impulse, order_place[v / 4], v % 4)
        });
        if last != NONE { self.positions.push(last) }
        let (h_start, h, mu, shift) = (&self.column_start, &self.column, &self.scaled.mu, &self.shift);
        self.basis.factorise(&self.positions, |at| variable[at as usize] / 4, |at, out| {
            column_of(variable[at as usize], n, h_start, h, mu, shift, |r, x| out.push((r, x)));
        });
    }

    /// w = B⁻¹ c
    fn direction_of(&mut self, v: u32) {
        let n = self.contacts();
        self.right.fill(0.0);
        let right = &mut self.right;
        column_of(v, n, &self.column_start, &self.column, &self.scaled.mu, &self.shift, |r, x| right[r as usize] += x);
        self.basis.solve(&mut self.right, &mut self.direction);
    }

    fn set_basis(&mut self) {
        let n = self.contacts();
        refill(&mut self.variable, 2 * n, 0);
        refill(&mut self.place, 4 * n + 1, NONE);
        refill(&mut self.x, 2 * n, 0.0);
        refill(&mut self.right, 2 * n, 0.0);
        refill(&mut self.direction, 2 * n, 0.0);
        for i in 0..n {
            for (k, c) in self.cells[i].coordinates().into_iter().enumerate() {
                let v = 4 * i + c as usize;
                self.variable[2 * i + k] = v as u32;
                self.place[v] = (2 * i + k) as u32;
                self.x[2 * i + k] = self.values[i][c as usize];
            }
        }
    }

    fn cross(&mut self) -> bool {
        let n = self.contacts();
        refill(&mut self.shift, 2 * n, 0.0);
        for round in 0..10 {
            self.set_basis();
            self.factorise();
            let dependent = self.basis.dependent().len();
            self.log += &format!(" [{round}: dependent {dependent}");
            if dependent == 0 {
                self.log += "]";
                return true;
            }
            let list: Vec<u32> = self.basis.dependent().to_vec();
            let supers: Vec<(u32, f64)> = list.iter().map(|&at| (self.variable[at as usize], self.x[at as usize])).collect();
            for &at in &list {
                self.place[self.variable[at as usize] as usize] = NONE;
                self.variable[at as usize] = NONE;
            }
            let mut swaps = 0;
            for (v, value) in supers {
                self.direction_of(v);
                let largest = (0..2 * n).filter(|&s| self.variable[s] != NONE && self.variable[s] % 4 < 2).map(|s| self.direction[s].abs()).fold(1.0, f64::max);
                let (mut bound, mut least) = (value, 1e-9 * largest);
                let mut leaving = None;
                for pass in 0..2 {
                    let slack = if pass == 0 { 1e-12 } else { 0.0 };
                    let mut first = bound;
                    for s in 0..2 * n {
                        let var = self.variable[s];
                        if var == NONE || var % 4 >= 2 { continue }
                        let w = -self.direction[s];
                        if pass == 0 {
                            if w > least { first = first.min((self.x[s].max(0.0) + slack) / w) }
                        } else if w > least && self.x[s].max(0.0) / w <= bound {
                            least = w;
                            leaving = Some(s);
                        }
                    }
                    if pass == 0 { bound = first; }
                }
                // the superbasic reaches zero
                let t = match leaving { Some(s) => (self.x[s].max(0.0) / least).min(value), None => value };
                let leaving = if t >= value * (1.0 - 1e-12) { None } else { leaving };
                let t = if leaving.is_none() { value } else { t };
                for s in 0..2 * n {
                    let var = self.variable[s];
                    if var != NONE && var % 4 < 2 { self.x[s] += t * self.direction[s]; }
                }
                if let Some(s) = leaving {
                    let old = self.variable[s] as usize;
                    self.place[old] = NONE;
                    self.variable[s] = v;
                    self.place[v as usize] = s as u32;
                    self.x[s] = value - t;
                    self.basis.exchange(s, &self.direction);
                    swaps += 1;
                    if self.basis.is_worn() { /* continue on etas */ }
                }
            }
            self.log += &format!(" swaps {swaps}]");
            for i in 0..n {
                let value = |c: Coordinate| match self.place[4 * i + c as usize] { NONE => None, s => Some(self.x[s as usize].max(0.0)) };
                let (a, b) = (value(Coordinate::A), value(Coordinate::B));
                let old = self.values[i];
                let tangential = old[3];
                let (cell, values) = match (a, b) {
                    (Some(a), Some(b)) => (Cell::Stick, [a, b, 0.0, 0.0]),
                    (Some(a), None) => (Cell::Forward, [a, 0.0, 0.0, tangential]),
                    (None, Some(b)) => (Cell::Backward, [0.0, b, 0.0, tangential]),
                    (None, None) => (Cell::Open, [0.0, 0.0, old[2], tangential]),
                };
                self.cells[i] = cell;
                self.values[i] = values;
            }
        }
        false
    }

    /// lifts, and computes the shift
    fn lift(&mut self) -> f64 {
        let n = self.contacts();
        let mut size = 0.0_f64;
        for pass in 0..2 {
            for i in 0..n {
                let [a, b, un, ut] = self.values[i];
                let mu = self.scaled.mu[i];
                self.found[i] = Vector2::new(a + b, mu * (b - a));
                self.u[i] = Vector2::new(un, ut);
            }
            for i in 0..n {
                let r = self.scaled.h.row_product(i, &self.found);
                for k in 0..2 {
                    self.shift[2 * i + k] = self.u[i][k] - r[k] - self.scaled.q[i][k] / self.unit();
                    size = size.max(self.shift[2 * i + k].abs());
                }
            }
            if pass == 1 { break }
            let lift = std::env::var("LIFT").ok().and_then(|s| s.parse::<f64>().ok()).unwrap_or(0.1) * size.max(1e-13);
            for i in 0..n {
                let cell = self.cells[i];
                for c in cell.coordinates() {
                    let sign = cell.sign(c, self.scaled.mu[i] > 0.0);
                    let value = &mut self.values[i][c as usize];
                    let random = ((4 * i + c as usize + 1) as f64 * 0.618_033_988_749_894_9).fract() + 0.5;
                    if sign != 0.0 && *value * sign < lift * random { *value = sign * lift * random; }
                }
            }
        }
        size
    }

    fn unit(&self) -> f64 {
        self.scaled.q.iter().map(Vector2::amax).fold(f64::MIN_POSITIVE, f64::max)
    }

    /// Follows the solution of `base + z shift` from z = `start` with z growing or not.
    fn follow(&mut self, start: f64, most_z: f64, most: u32, pivots: &mut u32) -> End {
        let n = self.contacts();
        let z = 4 * n as u32;
        self.set_basis();
        self.factorise();
        if !self.basis.dependent().is_empty() { self.log += " start dependent"; return End::Cap }
        for r in 0..2 * n { self.right[r] = -self.base[r] - start * self.shift[r]; }
        self.basis.solve(&mut self.right, &mut self.x);
        let slides = self.cells.iter().filter(|&&c| c == Cell::Forward || c == Cell::Backward).count();
        let positive = self.basis.determinant_is_positive() == (slides % 2 == 0);
        let mut entering = (z, if positive { -1.0 } else { 1.0 }, start);
        if start == 0.0 && positive { return End::Solved }
        loop {
            let (v, sense, from) = entering;
            self.direction_of(v);
            // x changes by −sense w θ
            let largest = self.direction.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            let mut bound = if v != z { f64::INFINITY } else if sense < 0.0 { start } else { most_z - start };
            let own_bound = bound;
            let mut least = 1e-10 * largest;
            let mut z_escapes = false;
            for s in 0..2 * n {
                let sign = self.sign(s);
                let w = sign * sense * self.direction[s];
                if sign != 0.0 && w > least {
                    bound = bound.min(((sign * self.x[s]).max(0.0) + 1e-13) / w);
                }
            }
            let zs = self.place[z as usize];
            if zs != NONE {
                let rate = -sense * self.direction[zs as usize];
                if rate > 0.0 && (most_z - self.x[zs as usize]) / rate <= bound { bound = (most_z - self.x[zs as usize]).max(0.0) / rate; z_escapes = true; }
            }
            if bound == f64::INFINITY { return End::Ray }
            if v == z && bound >= own_bound {
                for s in 0..2 * n { self.x[s] -= sense * own_bound * self.direction[s]; }
                self.at_z = start + sense * own_bound;
                return if sense < 0.0 { End::Solved } else { End::Escaped };
            }
            let mut leaving = None;
            if z_escapes { leaving = Some(zs as usize); } else {
                for s in 0..2 * n {
                    let sign = self.sign(s);
                    let w = sign * sense * self.direction[s];
                    if sign != 0.0 && w > least && (sign * self.x[s]).max(0.0) / w <= bound {
                        leaving = Some(s);
                        if self.variable[s] == z { break }
                        least = w;
                    }
                }
            }
            let Some(s) = leaving else { return End::Ray };
            let sign = self.sign(s);
            let theta = if z_escapes { bound } else { (sign * self.x[s]).max(0.0) / (sign * sense * self.direction[s]) };
            let left = self.variable[s];
            for r in 0..2 * n { self.x[r] -= sense * theta * self.direction[r]; }
            self.x[s] = from + sense * theta;
            self.place[left as usize] = NONE;
            self.variable[s] = v;
            self.place[v as usize] = s as u32;
            *pivots += 1;
            if left == z { self.at_z = if z_escapes { most_z } else { 0.0 }; return if z_escapes { End::Escaped } else { End::Solved } }
            self.basis.exchange(s, &self.direction);
            if *pivots >= most { return End::Cap }
            if std::env::var("VERBOSE").is_ok() {
                let zz = self.place[z as usize]; eprintln!("{pivots} z {:.12e} pivot {:.2e} of {largest:.2e} theta {theta:.2e} var {left} {:?}", self.x[zz as usize], self.direction[s], self.cells[left as usize / 4]);
            }
            if self.basis.is_worn() {
                self.factorise();
                if !self.basis.dependent().is_empty() { self.log += &format!(" worn: dependent {}", self.basis.dependent().len()); return End::Cap }
                for r in 0..2 * n { self.right[r] = -self.base[r]; }
                self.basis.solve(&mut self.right, &mut self.x);
            }
            let i = left as usize / 4;
            let c = Coordinate::ALL[left as usize % 4];
            let slip = match self.place[4 * i + 3] { NONE => 0.0, s => self.x[s as usize] };
            let rubs = self.scaled.mu[i] > 0.0;
            let (cell, next) = self.cells[i].beyond(c, slip, rubs);
            self.cells[i] = cell;
            let sense = if cell.sign(next, rubs) < 0.0 { -1.0 } else { 1.0 };
            entering = (4 * i as u32 + next as u32, sense, 0.0);
        }
    }

    fn keep_values(&mut self) {
        for i in 0..self.contacts() { for c in 0..4 { self.values[i][c] = match self.place[4 * i + c] { NONE => 0.0, s => self.x[s as usize] } } }
    }

    /// From the solution of q + d to that of q.
    fn track(&mut self, size: f64, most: u32, pivots: &mut u32) -> End {
        let n = self.contacts();
        let unit = self.unit();
        let env = |name: &str, or: f64| std::env::var(name).ok().and_then(|s| s.parse::<f64>().ok()).unwrap_or(or);
        let zmax = env("ZMAX", 2.0);
        let mut straight = self.shift.clone();
        let mut scale = 1.0;
        let random = |i: usize| ((i + 1) as f64 * 0.618_033_988_749_894_9).fract() + 0.5;
        for leg in 0..20 {
            let before = *pivots;
            // excursion
            for i in 0..n { for k in 0..2 { self.base[2 * i + k] = self.scaled.q[i][k] / unit + scale * straight[2 * i + k]; } }
            for i in 0..n { self.shift[2 * i] = size * random(i); self.shift[2 * i + 1] = 0.0; }
            let end = self.follow(0.0, f64::INFINITY, most, pivots);
            self.log += &format!(" e{}", *pivots - before);
            if end != End::Solved { return end }
            self.keep_values();
            let before = *pivots;
            for i in 0..n { for k in 0..2 { self.base[2 * i + k] = self.scaled.q[i][k] / unit; } }
            self.shift.copy_from_slice(&straight);
            let end = self.follow(scale, zmax * scale, most, pivots);
            self.log += &format!(" s{}", *pivots - before);
            if end != End::Escaped { return end }
            self.keep_values();
            scale = self.at_z;
        }
        End::Cap
    }

    fn sign(&self, s: usize) -> f64 {
        let v = self.variable[s] as usize;
        let i = v / 4;
        match self.cells.get(i) {
            None => 1.0,
            Some(cell) => cell.sign(Coordinate::ALL[v % 4], self.scaled.mu[i] > 0.0),
        }
    }

    /// impulses from the final basis
    fn impulses(&mut self, solved: bool) {
        let n = self.contacts();
        let unit = self.unit();
        let read = |this: &mut Self| {
            for i in 0..n {
                let value = |c: usize| match this.place[4 * i + c] { NONE => 0.0, s => this.x[s as usize].max(0.0) };
                let (a, b) = (value(0), value(1));
                this.found[i] = Vector2::new(a + b, this.scaled.mu[i] * (b - a)) * unit;
            }
        };
        read(self);
        if !solved { return }
        self.scaled.velocities(&self.found, &mut self.u);
        let before = self.scaled.residual(&self.found, &self.u);
        let kept = self.found.clone();
        self.set_basis();
        self.factorise();
        let dep = self.basis.dependent().len();
        let mut after = f64::NAN;
        if dep == 0 {
            for i in 0..n { for k in 0..2 { self.right[2 * i + k] = -self.scaled.q[i][k] / unit; } }
            self.basis.solve(&mut self.right, &mut self.x);
            read(self);
            self.scaled.velocities(&self.found, &mut self.u);
            after = self.scaled.residual(&self.found, &self.u);
            if !(after < before) { self.found = kept }
        }
        self.log += &format!(" final dep {dep} before {before:.1e} after {after:.1e}");
    }
}

fn column_of(v: u32, n: usize, start: &[usize], h: &[(u32, Block<2>)], mu: &[f64], shift: &[f64], mut out: impl FnMut(u32, f64)) {
    let i = v as usize / 4;
    if i >= n {
        for (r, &x) in shift.iter().enumerate() { if x != 0.0 { out(r as u32, x) } }
        return;
    }
    let across = match Coordinate::ALL[v as usize % 4] {
        Coordinate::A => -mu[i],
        Coordinate::B => mu[i],
        Coordinate::Normal => return out(2 * i as u32, -1.0),
        Coordinate::Tangential => return out(2 * i as u32 + 1, -1.0),
    };
    for (j, h) in &h[start[i]..start[i + 1]] {
        for k in 0..2 {
            out(2 * j + k as u32, h[(k, 0)] + across * h[(k, 1)]);
        }
    }
}

impl ContactSolver<2> for Crossover {
    fn name(&self) -> &'static str { Self::NAME }
    fn law(&self) -> Law { Law::Exact }
    fn reserve(&mut self, _contacts: usize, _blocks: usize) {}
    fn solve(&mut self, problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector2<f64>]) -> Outcome {
        make_finite(p);
        self.log.clear();
        self.scaled.load(problem);
        self.load_columns();
        let unit = self.unit();
        let start = judge(problem, p);
        let mut best = start.global;
        self.best.clear();
        self.best.extend_from_slice(p);
        let mut pivots = 0;
        let tries = std::env::var("TRIES").ok().and_then(|s| s.parse().ok()).unwrap_or(2);
        let cap = std::env::var("CAP").ok().and_then(|s| s.parse().ok()).unwrap_or(400);
        for _ in 0..tries {
            if best <= stop.tolerance { break }
            let mut found = std::mem::take(&mut self.best);
            self.enter(&found, unit);
            let crossed = self.cross();
            let size = self.lift();
            self.log += &format!(" crossed {crossed} dq {size:.1e}");
            if crossed {
                let before = pivots;
                refill(&mut self.base, 2 * p.len(), 0.0);
                let end = self.track(size, pivots + cap, &mut pivots);
                self.impulses(end == End::Solved);
                self.scaled.velocities(&self.found, &mut self.u);
                let after = self.scaled.residual(&self.found, &self.u);
                self.log += &format!(" {end:?} {} res {after:.1e}", pivots - before);
                if after < best { best = after; found.copy_from_slice(&self.found); }
            }
            self.best = found;
        }
        p.copy_from_slice(&self.best);
        let residual = judge(problem, p);
        Outcome::new(ended(stop, pivots, &residual), Self::NAME, pivots, residual)
    }
    fn fork(&self) -> Box<dyn ContactSolver<2>> { Box::new(Self::new()) }
}
