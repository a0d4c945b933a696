//! Semi-smooth Newton.

use crate::block_lu::BlockLu;
use nalgebra::SMatrix;
use teeter_contact::{
    Block, BlockSparse, ContactProblem, ContactSolver, Law, Outcome, Status, Stop, Vector, de_saxce, judge, project,
};

/// Newton's method.
#[derive(Clone, Debug, Default)]
pub struct Newton<const D: usize> {
    h: BlockSparse<D>,
    q: Vec<Vector<D>>,
    u: Vec<Vector<D>>,
    change: Vec<Vector<D>>,
    change_u: Vec<Vector<D>>,
    trial: Vec<Vector<D>>,
    trial_u: Vec<Vector<D>>,
    rows: Vec<Row<D>>,
    best: Vec<Vector<D>>,
    lu: BlockLu<D>,
    alpha: f64,
    center: Vec<Vector<D>>,
    /// debugging
    pub log: bool,
}

/// One contact's part of the linearised law: `E δp + D (H δp) = right`.
#[derive(Clone, Copy, Debug)]
struct Row<const D: usize> {
    open: bool,
    of_p: Block<D>,
    of_u: Block<D>,
    right: Vector<D>,
}

impl<const D: usize> Newton<D> {
    /// The name by which users choose it.
    pub const NAME: &'static str = "newton";

    /// A solver.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    fn burst(&mut self, p: &mut [Vector<D>], mu: &[f64], q_norm: f64, goal: f64, most: u32) -> (u32, f64) {
        let n = p.len();
        self.velocities(p);
        let mut err = Self::residual(p, &self.u, mu, q_norm);
        let mut its = 0;
        while err > goal && its < most {
            its += 1;
            let smooth = std::env::var("SMOOTH").ok().and_then(|x| x.parse().ok()).unwrap_or(0);
            if smooth > 0 {
                for _ in 0..smooth { self.sweep(p, mu); }
                self.velocities(p);
                err = Self::residual(p, &self.u, mu, q_norm);
                if self.log { println!("        smooth {its}: {err:.3e}"); }
                if err <= goal { break; }
            }
            self.linearise(p, mu);
            if !self.step(p) { break; }
            let (mut best_step, mut best) = (0.0, f64::INFINITY);
            let mut step = 1.0;
            for _ in 0..6 {
                for i in 0..n {
                    self.trial[i] = p[i] + self.change[i] * step;
                    self.trial_u[i] = self.u[i] + self.change_u[i] * step;
                }
                let e = Self::residual(&self.trial, &self.trial_u, mu, q_norm);
                if e < best {
                    (best, best_step) = (e, step);
                }
                if e < 0.9 * err || std::env::var("FULL").is_ok() { break; }
                step *= 0.5;
            }
            if self.log { println!("        newton {its}: {err:.3e} -> {best:.3e} at {best_step}"); }
            for i in 0..n {
                p[i] = project(&(p[i] + self.change[i] * best_step), mu[i]);
            }
            self.velocities(p);
            let before = err;
            err = Self::residual(p, &self.u, mu, q_norm);
            if !(err < 3.0 * before) && std::env::var("FULL").is_err() { break; }
        }
        (its, err)
    }

    fn velocities(&mut self, p: &[Vector<D>]) {
        for i in 0..p.len() {
            self.u[i] = self.h.row_product(i, p) + self.q[i] + (p[i] - self.center[i]) * self.alpha;
        }
    }

    /// Natural map of the scaled problem: (norm of the map, norm of p).
    fn residual(p: &[Vector<D>], u: &[Vector<D>], mu: &[f64], q_norm: f64) -> f64 {
        let (mut map, mut size) = (0.0, 0.0);
        for i in 0..p.len() {
            map += (p[i] - project(&(p[i] - de_saxce(&u[i], mu[i])), mu[i])).norm_squared();
            size += p[i].norm_squared();
        }
        map.sqrt() / size.sqrt().max(q_norm).max(1e-300)
    }

    fn linearise(&mut self, p: &[Vector<D>], mu: &[f64]) -> usize {
        let mut changes = 0;
        for i in 0..p.len() {
            let h = self.h.diagonal(i);
            let row = linearised(&p[i], &self.u[i], mu[i], &h);
            changes += usize::from(row.open != self.rows[i].open);
            self.rows[i] = row;
        }
        changes
    }

    /// Newton step.
    fn step(&mut self, p: &[Vector<D>]) -> bool {
        let n = p.len();
        // Open contacts go to zero at once; the others feel it.
        for i in 0..n {
            self.change[i] = if self.rows[i].open { -p[i] } else { Vector::zeros() };
        }
        for i in 0..n {
            if !self.rows[i].open {
                let mut b = Vector::zeros();
                for (j, h) in self.h.row(i) {
                    if self.rows[j].open {
                        b += h * self.change[j];
                    }
                }
                self.trial[i] = self.rows[i].right - self.rows[i].of_u * b;
            }
        }
        let epsilon = self.alpha;
        let (rows, h) = (&self.rows, &self.h);
        let done = self.lu.factorise(
            h,
            |i| !rows[i].open,
            |i, t| {
                let block = rows[i].of_u * h.blocks()[t];
                if h.columns()[t] == i { block + rows[i].of_u * epsilon + rows[i].of_p } else { block }
            },
        );
        if !done {
            return false;
        }
        for i in 0..n {
            if !self.rows[i].open {
                self.change[i] = self.trial[i];
            } 
        }
        self.lu.solve(&mut self.change);
        for i in 0..n {
            self.change_u[i] = self.h.row_product(i, &self.change) + self.change[i] * self.alpha;
        }
        self.change.iter().all(|c| c.iter().all(|x| x.is_finite()))
    }

    fn sweep(&mut self, p: &mut [Vector<D>], mu: &[f64]) {
        for i in 0..p.len() {
            let h = self.h.diagonal(i) + Block::identity() * self.alpha;
            let u = self.h.row_product(i, p) + self.q[i] + (p[i] - self.center[i]) * self.alpha;
            let mut x = p[i];
            let omega = 1.0 / h.symmetric_part().norm();
            let c = u - h * p[i];
            for _ in 0..20 {
                let y = project(&(x - de_saxce(&(h * x + c), mu[i]) * omega), mu[i]);
                let d = (y - x).norm();
                x = y;
                if d < 1e-3 * x.norm() { break; }
            }
            p[i] = x;
        }
    }
}

fn linearised<const D: usize>(p: &Vector<D>, u: &Vector<D>, mu: f64, h: &Block<D>) -> Row<D> {
    let mut row = Row { open: false, of_p: Block::zeros(), of_u: Block::identity(), right: -u };
    let rho_n = 1.0 / h[(0, 0)];
    let rho_t = (D - 1) as f64 / (h.trace() - h[(0, 0)]).max(1e-300);
    let pressed = p[0] - rho_n * u[0];
    if pressed <= 0.0 {
        row.open = true;
        return row;
    }
    let mut y = p - u * rho_t;
    y[0] = 0.0;
    let length = y.norm();
    let bound = mu * pressed;
    if length <= bound && mu > 0.0 {
        return row;
    }
    // Slides.
    let d = if length > 0.0 { y / length } else { y };
    let kappa = if length > 0.0 { bound / length } else { 0.0 };
    let mut perpendicular = SMatrix::<f64, D, D>::identity() - d * d.transpose();
    perpendicular[(0, 0)] = 0.0;
    row.of_u = perpendicular * (kappa * rho_t);
    row.of_u[(0, 0)] = 1.0;
    row.of_p = -perpendicular * kappa;
    for a in 1..D {
        row.of_p[(a, a)] += 1.0;
        row.of_p[(a, 0)] -= mu * d[a];
        row.right[a] = mu * p[0] * d[a] - p[a];
    }
    row
}

trait SymmetricPart<const D: usize> {
    fn symmetric_part(&self) -> Block<D>;
}
impl<const D: usize> SymmetricPart<D> for Block<D> {
    fn symmetric_part(&self) -> Block<D> {
        (self + self.transpose()) * 0.5
    }
}

impl<const D: usize> ContactSolver<D> for Newton<D> {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn law(&self) -> Law {
        Law::Exact
    }

    fn reserve(&mut self, _contacts: usize, _blocks: usize) {}

    fn solve(&mut self, problem: &ContactProblem<'_, D>, stop: &Stop<'_>, p: &mut [Vector<D>]) -> Outcome {
        let n = p.len();
        let mu = problem.mu();
        let rho = problem.scale();
        self.h.gather(problem);
        self.h.scale(rho);
        self.q.clear();
        self.q.extend(problem.q().iter().map(|q| q * rho));
        let q_norm = self.q.iter().map(Vector::norm_squared).sum::<f64>().sqrt();
        for v in [&mut self.u, &mut self.change, &mut self.change_u, &mut self.trial, &mut self.trial_u] {
            v.clear();
            v.resize(n, Vector::zeros());
        }
        self.rows.clear();
        self.rows.resize(n, Row { open: false, of_p: Block::zeros(), of_u: Block::zeros(), right: Vector::zeros() });
        let t0 = std::time::Instant::now();
        self.lu.analyse(&self.h);
        if self.log { println!("analyse {:?} filled {} of {} products {}", t0.elapsed(), self.lu.filled_blocks(), self.h.blocks().len(), self.lu.block_products()); }
        self.alpha = 0.0;
        self.center.clear();
        self.center.resize(n, Vector::zeros());
        let env = |k: &str, d: f64| std::env::var(k).ok().and_then(|x| x.parse().ok()).unwrap_or(d);
        let sweeps = env("SWEEPS", 10.0) as usize;
        let mut alpha = env("ALPHA", 1e-3);
        let shrink = env("SHRINK", 0.1);
        self.velocities(p);
        let mut err = Self::residual(p, &self.u, mu, q_norm);
        let mut iterations = 0;
        for _ in 0..sweeps {
            if err <= stop.tolerance { break; }
            self.sweep(p, mu);
            self.velocities(p);
            err = Self::residual(p, &self.u, mu, q_norm);
        }
        if self.log { println!("{:?} sweeps {sweeps}: {err:.3e}", t0.elapsed()); }
        self.best.clear();
        self.best.extend_from_slice(p);
        let mut best_err = err;
        while best_err > stop.tolerance && iterations < stop.max_iterations {
            self.alpha = alpha;
            self.center.copy_from_slice(&self.best);
            p.copy_from_slice(&self.best);
            let goal = (env("GOAL", 0.01) * best_err).min(0.3 * best_err.max(stop.tolerance)).max(stop.tolerance * 0.1);
            let (its, inner) = self.burst(p, mu, q_norm, goal, 12);
            iterations += its;
            self.alpha = 0.0;
            self.velocities(p);
            err = Self::residual(p, &self.u, mu, q_norm);
            if self.log { println!("{:?} prox {alpha:.0e} its {its} inner {inner:.2e} goal {goal:.1e}: {best_err:.3e} -> {err:.3e}", t0.elapsed()); }
            if inner <= goal || err < 0.5 * best_err {
                alpha = (alpha * shrink).max(1e-13);
                best_err = err;
                self.best.copy_from_slice(p);
            } else {
                alpha = (alpha * env("GROW", 10.0)).min(10.0);
                if err < best_err { best_err = err; self.best.copy_from_slice(p); }
                p.copy_from_slice(&self.best);
                for _ in 0..sweeps { self.sweep(p, mu); }
                self.best.copy_from_slice(p);
                self.velocities(p);
                best_err = Self::residual(p, &self.u, mu, q_norm);
                if self.log { println!("{:?} sweeps {sweeps}: {best_err:.3e}", t0.elapsed()); }
            }
        }
        p.copy_from_slice(&self.best);
        let residual = judge(problem, p);
        let status = if residual.global <= stop.tolerance { Status::Converged } else { Status::Stalled };
        Outcome::new(status, Self::NAME, iterations, residual)
    }

    fn fork(&self) -> Box<dyn ContactSolver<D>> {
        Box::new(Self::new())
    }
}
