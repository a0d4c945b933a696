//! Newton on the smoothed natural map.

use crate::block_lu::BlockLu;
use teeter_contact::{
    Block, BlockSparse, ContactProblem, ContactSolver, Law, Outcome, Status, Stop, Vector, de_saxce, judge, project,
};

/// Smoothing Newton.
#[derive(Clone, Debug, Default)]
pub struct Smoothing<const D: usize> {
    h: BlockSparse<D>,
    q: Vec<Vector<D>>,
    u: Vec<Vector<D>>,
    change: Vec<Vector<D>>,
    change_u: Vec<Vector<D>>,
    trial: Vec<Vector<D>>,
    trial_u: Vec<Vector<D>>,
    of_p: Vec<Block<D>>,
    of_u: Vec<Block<D>>,
    best: Vec<Vector<D>>,
    lu: BlockLu<D>,
    /// debugging
    pub log: bool,
}

fn norm_t<const D: usize>(x: &Vector<D>) -> f64 {
    x.norm_squared().max(x[0] * x[0]).sqrt().min((x.norm_squared() - x[0] * x[0]).max(0.0).sqrt())
}

/// F and optionally derivatives.
fn smoothed<const D: usize>(p: &Vector<D>, u: &Vector<D>, mu: f64, tau: f64) -> (Vector<D>, Block<D>, Block<D>) {
    if mu == 0.0 {
        let w = p[0] - u[0];
        let root = (w * w + 4.0 * tau * tau).sqrt();
        let g = 0.5 * (w + root);
        let dg = if root > 0.0 { 0.5 * (1.0 + w / root) } else { 0.5 };
        let mut f = *p;
        f[0] = p[0] - g;
        let mut of_p = Block::<D>::identity();
        of_p[(0, 0)] = 1.0 - dg;
        let mut of_u = Block::<D>::zeros();
        of_u[(0, 0)] = dg;
        return (f, of_p, of_u);
    }
    let s = mu.sqrt();
    let ut = norm_t(u);
    let ut_s = (ut * ut + tau * tau).sqrt();
    // Scaled: x = (s p_N, p_T / s), z = (û_N / s, s u_T).
    let x0 = s * p[0];
    let z0 = (u[0] + mu * (ut_s - tau)) / s;
    let mut w1 = (p / s) - u * s;
    w1[0] = 0.0;
    let w0 = x0 - z0;
    let length = w1.norm();
    let d = if length > 0.0 { w1 / length } else { let mut e = Vector::<D>::zeros(); e[1] = 1.0; e };
    let g = |l: f64| 0.5 * (l + (l * l + 4.0 * tau * tau).sqrt());
    let dg = |l: f64| { let r = (l * l + 4.0 * tau * tau).sqrt(); if r > 0.0 { 0.5 * (1.0 + l / r) } else { 0.5 } };
    let (lp, lm) = (w0 + length, w0 - length);
    let (gp, gm, dp, dm) = (g(lp), g(lm), dg(lp), dg(lm));
    let a = 0.5 * (dp + dm);
    let b = 0.5 * (dp - dm);
    let c = if length > 1e-12 * (w0.abs() + tau) && length > 0.0 { (gp - gm) / (lp - lm) } else { a };
    // dΠ in scaled coordinates
    let mut dpi = Block::<D>::zeros();
    dpi[(0, 0)] = a;
    for i in 1..D {
        dpi[(0, i)] = b * d[i];
        dpi[(i, 0)] = b * d[i];
        for j in 1..D {
            dpi[(i, j)] = (a - c) * d[i] * d[j] + if i == j { c } else { 0.0 };
        }
    }
    let mut f = Vector::<D>::zeros();
    f[0] = x0 - 0.5 * (gp + gm);
    for i in 1..D {
        f[i] = p[i] / s - 0.5 * (gp - gm) * d[i];
    }
    // F as function of p, u: dF = (I - dΠ) Sp dp + dΠ Su du
    let mut of_p = Block::<D>::identity() - dpi;
    let mut sz = Block::<D>::zeros();
    sz[(0, 0)] = 1.0 / s;
    for j in 1..D {
        sz[(j, j)] = s;
        sz[(0, j)] = mu * u[j] / ut_s.max(1e-300) / s;
    }
    let of_u = dpi * sz;
    for i in 0..D {
        of_p[(i, 0)] *= s;
        for j in 1..D {
            of_p[(i, j)] /= s;
        }
    }
    (f, of_p, of_u)
}

impl<const D: usize> Smoothing<D> {
    /// The name by which users choose it.
    pub const NAME: &'static str = "smoothing";

    /// A solver.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    fn velocities(&mut self, p: &[Vector<D>]) {
        for i in 0..p.len() {
            self.u[i] = self.h.row_product(i, p) + self.q[i];
        }
    }

    fn residual(p: &[Vector<D>], u: &[Vector<D>], mu: &[f64], q_norm: f64) -> f64 {
        let (mut map, mut size) = (0.0, 0.0);
        for i in 0..p.len() {
            map += (p[i] - project(&(p[i] - de_saxce(&u[i], mu[i])), mu[i])).norm_squared();
            size += p[i].norm_squared();
        }
        map.sqrt() / size.sqrt().max(q_norm).max(1e-300)
    }

    fn merit(p: &[Vector<D>], u: &[Vector<D>], mu: &[f64], tau: f64) -> f64 {
        (0..p.len()).map(|i| smoothed(&p[i], &u[i], mu[i], tau).0.norm_squared()).sum::<f64>().sqrt()
    }

    fn sweep(&mut self, p: &mut [Vector<D>], mu: &[f64]) {
        for i in 0..p.len() {
            let h = self.h.diagonal(i);
            let u = self.h.row_product(i, p) + self.q[i];
            let mut x = p[i];
            let omega = 1.0 / h.norm();
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

impl<const D: usize> ContactSolver<D> for Smoothing<D> {
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
        for v in [&mut self.of_p, &mut self.of_u] {
            v.clear();
            v.resize(n, Block::zeros());
        }
        let env = |k: &str, d: f64| std::env::var(k).ok().and_then(|x| x.parse().ok()).unwrap_or(d);
        let t0 = std::time::Instant::now();
        self.lu.analyse(&self.h);
        for _ in 0..env("SWEEPS", 10.0) as usize {
            self.sweep(p, mu);
        }
        self.velocities(p);
        let mut err = Self::residual(p, &self.u, mu, q_norm);
        if self.log { println!("{:?} sweeps: {err:.3e}", t0.elapsed()); }
        let size = p.iter().map(Vector::norm_squared).sum::<f64>().sqrt().max(q_norm) / (n as f64).sqrt();
        let mut tau = env("TAU0", 0.1) * size;
        let epsilon = env("EPS", 1e-11);
        let root_n = (n as f64).sqrt();
        let mut best = err;
        self.best.clear();
        self.best.extend_from_slice(p);
        let mut iterations = 0;
        let mut center: Vec<Vector<D>> = p.to_vec();
        let mut center_tau = tau;
        let mut factor = env("FACTOR", 0.1);
        let mut first = true;
        let mut forced = false;
        let mut folds = 0;
        let reg = env("REG", 0.0);
        'path: while best > stop.tolerance && iterations < stop.max_iterations {
            // Corrector at tau.
            let most = if forced { 20 } else if first { 15 } else { env("MOST", 5.0) as u32 };
            let mut its = 0;
            let lambda = reg * tau / size;
            let mut ok = false;
            self.velocities(p);
            for i in 0..n { self.u[i] += p[i] * lambda; }
            let mut merit = Self::merit(p, &self.u, mu, tau);
            let start_merit = merit;
            let mut shown = f64::NAN;
            while its < most {
                its += 1;
                iterations += 1;
                for i in 0..n {
                    let (f, of_p, of_u) = smoothed(&p[i], &self.u[i], mu[i], tau);
                    self.change[i] = -f;
                    self.of_p[i] = of_p;
                    self.of_u[i] = of_u;
                }
                let (of_p, of_u, h) = (&self.of_p, &self.of_u, &self.h);
                if !self.lu.factorise(h, |_| true, |i, t| {
                    let block = of_u[i] * h.blocks()[t];
                    if h.columns()[t] == i { block + of_u[i] * (epsilon + lambda) + of_p[i] } else { block }
                }) { if self.log { println!("singular"); } break; }
                self.lu.solve(&mut self.change);
                for i in 0..n {
                    self.change_u[i] = self.h.row_product(i, &self.change) + self.change[i] * lambda;
                }
                let mut step = 1.0;
                let mut after;
                loop {
                    for i in 0..n {
                        self.trial[i] = p[i] + self.change[i] * step;
                        self.trial_u[i] = self.u[i] + self.change_u[i] * step;
                    }
                    after = Self::merit(&self.trial, &self.trial_u, mu, tau);
                    if after <= (1.0 - 0.1 * step) * merit || step < if forced { 0.004 } else { 0.1 } { break; }
                    step *= 0.5;
                }
                if !(after < merit) && !forced { break; }
                if step < 0.2 && !first && !forced { break; }
                p.copy_from_slice(&self.trial);
                self.u.copy_from_slice(&self.trial_u);
                merit = after;
                // The point in the cones.
                for i in 0..n { self.trial[i] = project(&p[i], mu[i]); }
                for i in 0..n { self.trial_u[i] = self.h.row_product(i, &self.trial) + self.q[i]; }
                let e = Self::residual(&self.trial, &self.trial_u, mu, q_norm);
                shown = e;
                if e < best { best = e; self.best.copy_from_slice(&self.trial); }
                if best <= stop.tolerance { break 'path; }
                if after < env("KAPPA", 0.1) * tau * root_n { ok = true; break; }
            }
            if self.log { println!("{:?} {iterations} tau {:.1e} its {its} ok {ok} forced {forced} factor {factor:.3} merit {:.2e} -> {:.2e}: {shown:.3e} best {best:.2e}", t0.elapsed(), tau / size, start_merit / size, merit / size); }
            if ok || first {
                center.copy_from_slice(p);
                center_tau = tau;
                if its <= 2 { factor = (factor * factor).max(0.01); } else if its > 3 { factor = factor.sqrt(); }
                first = false;
                if forced { factor = 0.5; }
                forced = false;
            } else {
                p.copy_from_slice(&center);
                if forced {
                    folds += 1;
                    if folds > env("FOLDS", 5.0) as u32 { break; }
                    center.copy_from_slice(p);
                    center_tau = tau;
                    factor = 0.5;
                    forced = false;
                } else {
                    p.copy_from_slice(&center);
                    factor = factor.sqrt().sqrt();
                    if factor > 0.9 { forced = true; factor = env("FORCE", 0.3); }
                }
            }
            tau = (center_tau * factor).max(1e-18 * size);
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
