//! Exact motion of a beam in its modes under constant forces.
//!
//! ```text
//! η̈ + 2δ η̇ + ω² η = F:   η*  = (1 − ω²D) η + B η̇ + D F        B = e^(−δh) sin(ω_d h)/ω_d,   ω_d² = ω² − δ²
//!                         η̇* = −ω² B η + (B' ) η̇ + B F         B' = e^(−δh)(cos ω_d h − δ sin(ω_d h)/ω_d)
//!                                                               D = (1 − e^(−δh)(cos ω_d h + δ sin(ω_d h)/ω_d))/ω²
//! ```
//!
//! and then η¹ = F/ω² + f (η* − F/ω²), η̇¹ = f η̇*, with the filter f = exp(−(ωh/χ)⁸).

use crate::propagator::{Dissipated, Propagator};
use crate::subsystem::dot;
use crate::{Coupling, PartRows, Vector};
use nalgebra::Matrix2;
use teeter_beam::{Beam, ModalBasis};

/// Durations whose coefficients are kept.
const KEPT: usize = 16;

/// Below this ωh and δh the coefficients are summed as a series.
const SHORT: f64 = 0.1;

/// Terms of the series: the first that is left out is below rounding.
const TERMS: usize = 14;

/// How coordinates of the beam and of its modes hang together.
#[derive(Debug)]
pub(crate) enum Shapes {
    /// They are the same.
    Own,
    /// q = Φη: Φ by dofs and by modes, and ΦᵀM by dofs.
    Of { by_dof: Vec<f64>, by_mode: Vec<f64>, momenta: Vec<f64> },
}

/// The modes of a beam in motion.
#[derive(Debug)]
pub(crate) struct ModalMotion {
    shapes: Shapes,
    /// ω², 1/s².
    stiffness: Vec<f64>,
    /// 2δ, 1/s.
    damping: Vec<f64>,
    /// Constant forces on the modes, as weight.
    constant: Vec<f64>,
    kept: Vec<Coefficients>,
    /// The one that is taken.
    now: usize,
    /// Which of those that are kept goes next.
    next: usize,
    start: Vec<[f64; 2]>,
    /// Room for one number a mode.
    modal: Vec<f64>,
    force: Vec<f64>,
    change: Vec<f64>,
    /// As `change`, of the mean.
    change_of_mean: Vec<f64>,
}

/// Coefficients over a time, a list with one entry a mode.
#[derive(Clone, Debug)]
struct Coefficients {
    h: f64,
    cutoff: f64,
    /// B, B', D and f of each mode.
    modes: Vec<[f64; 4]>,
    /// (2/h²) D of each mode, and D of the dofs by rows; with the filter.
    places: Response,
    /// As `places`: V/h.
    rates: Response,
}

/// What constant forces do.
#[derive(Clone, Debug)]
struct Response {
    /// Of each mode on its own.
    gains: Vec<f64>,
    /// Φ gains Φᵀ, by dofs; empty where the coordinates are those of the modes.
    matrix: Vec<f64>,
}

impl Response {
    fn new(shapes: &Shapes, modes: usize) -> Self {
        let entries = match shapes {
            Shapes::Own => 0,
            Shapes::Of { by_dof, .. } => (by_dof.len() / modes.max(1)).pow(2),
        };
        Self { gains: vec![0.0; modes], matrix: vec![0.0; entries] }
    }

    /// Makes the matrix of the gains.
    fn fill(&mut self, shapes: &Shapes) {
        let Shapes::Of { by_mode, .. } = shapes else { return };
        let n = by_mode.len() / self.gains.len().max(1);
        self.matrix.fill(0.0);
        for (shape, gain) in by_mode.chunks_exact(n.max(1)).zip(&self.gains) {
            for (row, a) in self.matrix.chunks_exact_mut(n.max(1)).zip(shape) {
                let a = gain * a;
                row.iter_mut().zip(shape).for_each(|(entry, b)| *entry += a * b);
            }
        }
    }

    /// Adds J_i times the response times J_jᵀ for all pairs of rows.
    fn couple(&self, rows: &PartRows<'_, 2>, h: &mut Coupling<'_, 2>) {
        let n = self.gains.len();
        let dofs = if self.matrix.is_empty() { n } else { self.matrix.len().isqrt() };
        for (number, (j, columns_j, values_j)) in rows.iter().enumerate() {
            for (other, (i, columns_i, values_i)) in rows.iter().take(number + 1).enumerate() {
                let mut block = Matrix2::zeros();
                for (&c, a) in columns_i.iter().zip(values_i) {
                    for (&d, b) in columns_j.iter().zip(values_j) {
                        let gain = match self.matrix.get(c * dofs + d) {
                            Some(entry) => *entry,
                            None if c == d => self.gains[c],
                            None => continue,
                        };
                        block += a * gain * b.transpose();
                    }
                }
                h.add(i, j, &block);
                if other < number {
                    h.add(j, i, &block.transpose());
                }
            }
        }
    }
}

impl ModalMotion {
    /// Modes with these ω² (1/s²), 2δ (1/s) and constant forces.
    pub(crate) fn new(shapes: Shapes, stiffness: Vec<f64>, damping: Vec<f64>, constant: Vec<f64>) -> Self {
        let n = stiffness.len();
        Self {
            shapes,
            stiffness,
            damping,
            constant,
            kept: Vec::with_capacity(KEPT),
            now: 0,
            next: 0,
            start: vec![[0.0; 2]; n],
            modal: vec![0.0; n],
            force: vec![0.0; n],
            change: vec![0.0; n],
            change_of_mean: vec![0.0; n],
        }
    }

    /// All modes of a beam, on which constant forces act (N, on its dofs); `None` if they can't be
    /// had one by one.
    pub(crate) fn of_beam(beam: &Beam, constant: &[f64]) -> Option<Self> {
        let all = (0..beam.dofs()).filter(|dof| !beam.is_held(*dof)).count();
        let basis = ModalBasis::new(beam, all, &[]).ok()?;
        let mut damping = basis.damping(beam).ok()?;
        let n = basis.len();
        let mut shapes: Vec<Vec<f64>> = (0..n).map(|i| basis.shape(i).to_vec()).collect();
        uncouple(beam, &mut shapes[basis.rigid()..]);
        let by_dof = (0..beam.dofs() * n).map(|k| shapes[k % n][k / n]).collect();
        let by_mode = shapes.concat();
        let mut momenta = vec![0.0; n * beam.dofs()];
        let mut momentum = vec![0.0; beam.dofs()];
        let mut stiffness = vec![0.0; n];
        for i in 0..n {
            momentum.fill(0.0);
            beam.add_mass_product(1.0, &shapes[i], &mut momentum);
            momenta[i..].iter_mut().step_by(n).zip(&momentum).for_each(|(own, value)| *own = *value);
            if i >= basis.rigid() {
                stiffness[i] = 2.0 * beam.elastic_energy(&shapes[i]);
            }
            if damping[i] != 0.0 {
                damping[i] = beam.damping_power(&shapes[i]);
            }
        }
        let constant = shapes.iter().map(|shape| dot(shape, constant)).collect();
        Some(Self::new(Shapes::Of { by_dof, by_mode, momenta }, stiffness, damping, constant))
    }

    fn len(&self) -> usize {
        self.stiffness.len()
    }

    /// η of the coordinates or velocities `x`, into place `k` of the start.
    fn enter(&mut self, k: usize, x: &[f64]) {
        match &self.shapes {
            Shapes::Own => self.start.iter_mut().zip(x).for_each(|(start, x)| start[k] = *x),
            Shapes::Of { momenta, .. } => {
                self.modal.fill(0.0);
                add_columns(momenta, x, &mut self.modal);
                self.start.iter_mut().zip(&self.modal).for_each(|(start, x)| start[k] = *x);
            }
        }
    }

    /// Adds Φ times the modal `x` to `out`.
    fn add(shapes: &Shapes, x: &[f64], out: &mut [f64]) {
        match shapes {
            Shapes::Own => out.iter_mut().zip(x).for_each(|(out, x)| *out += x),
            Shapes::Of { by_mode, .. } => add_columns(by_mode, x, out),
        }
    }

    /// Adds Φᵀ f to the modal `out`.
    fn add_force(shapes: &Shapes, f: &[f64], out: &mut [f64]) {
        match shapes {
            Shapes::Own => out.iter_mut().zip(f).for_each(|(out, f)| *out += f),
            Shapes::Of { by_dof, .. } => {
                for (f, row) in f.iter().zip(by_dof.chunks_exact(out.len())).filter(|(f, _)| **f != 0.0) {
                    out.iter_mut().zip(row).for_each(|(out, phi)| *out += f * phi);
                }
            }
        }
    }

    /// Adds Φᵀ Jᵀ p to the modal `out`.
    fn add_impulses(shapes: &Shapes, rows: &PartRows<'_, 2>, p: &[Vector<2>], out: &mut [f64]) {
        for (contact, columns, values) in rows.iter() {
            for (&c, value) in columns.iter().zip(values) {
                let f = value.dot(&p[contact]);
                match shapes {
                    Shapes::Own => out[c] += f,
                    Shapes::Of { by_dof, .. } => {
                        let row = &by_dof[c * out.len()..(c + 1) * out.len()];
                        out.iter_mut().zip(row).for_each(|(out, phi)| *out += f * phi);
                    }
                }
            }
        }
    }
}

/// Turns shapes in pairs until no stiffness couples them: the search for modes leaves some 1e-10 of
/// it, which would be a force that comes from nowhere.
fn uncouple(beam: &Beam, shapes: &mut [Vec<f64>]) {
    let force = |shape: &Vec<f64>| {
        let mut force = vec![0.0; shape.len()];
        beam.add_stiffness_product(1.0, shape, &mut force);
        force
    };
    let mut forces: Vec<Vec<f64>> = shapes.iter().map(force).collect();
    let mut own: Vec<f64> = shapes.iter().zip(&forces).map(|(shape, force)| dot(shape, force)).collect();
    for i in 0..shapes.len() {
        for j in 0..i {
            let coupling = dot(&shapes[j], &forces[i]);
            let rounding: f64 = shapes[j].iter().zip(&forces[i]).map(|(x, f)| (x * f).abs()).sum();
            if coupling.abs() <= f64::EPSILON * rounding {
                continue;
            }
            // The angle of a Jacobi rotation.
            let (sin, cos) = (0.5 * (2.0 * coupling).atan2(own[i] - own[j])).sin_cos();
            for lists in [&mut *shapes, &mut forces] {
                let (first, second) = lists.split_at_mut(i);
                for (x, y) in first[j].iter_mut().zip(&mut second[0]) {
                    (*x, *y) = (cos * *x - sin * *y, sin * *x + cos * *y);
                }
            }
            own[i] = dot(&shapes[i], &forces[i]);
            own[j] = dot(&shapes[j], &forces[j]);
        }
    }
}

/// B, B' and D of a mode over h.
fn response(omega2: f64, damping: f64, h: f64) -> [f64; 3] {
    let (delta, omega) = (0.5 * damping, omega2.sqrt());
    if omega * h < SHORT && delta * h < SHORT {
        // η = Σ a_n tⁿ from rest under a unit force: (n+2)(n+1) a_{n+2} = −2δ(n+1) a_{n+1} − ω² a_n.
        let (mut before, mut last, mut power) = (0.0, 0.5, h);
        let mut sums = [h, 1.0, 0.5 * h * h];
        for n in 1..TERMS {
            let m = n as f64;
            let next = (-damping * (m + 1.0) * last - omega2 * before) / ((m + 2.0) * (m + 1.0));
            (before, last) = (last, next);
            sums[1] += (m + 2.0) * (m + 1.0) * next * power;
            power *= h;
            sums[0] += (m + 2.0) * next * power;
            sums[2] += next * power * h;
        }
        return sums;
    }
    let decay = (-delta * h).exp();
    let square = omega2 - delta * delta;
    // sin(ω_d h)/ω_d and cos ω_d h, of whatever sign ω_d² is.
    let (s, c) = if square > 0.0 {
        let omega_d = square.sqrt();
        ((omega_d * h).sin() / omega_d * decay, (omega_d * h).cos() * decay)
    } else {
        let rate = (-square).sqrt();
        // e^(−δh) sinh(rate h) without the overflow of sinh.
        let (fast, slow) = ((-(delta + rate) * h).exp(), (-(delta - rate) * h).exp());
        let s = if rate * h > 1e-8 { 0.5 * (slow - fast) / rate } else { h * decay };
        (s, 0.5 * (slow + fast))
    };
    let place = if omega2 * h * h > 1e-12 * damping * h {
        (1.0 - (c + delta * s)) / omega2
    } else {
        // A rigid motion with damping.
        (h + (-damping * h).exp_m1() / damping) / damping
    };
    [s, c - delta * s, place]
}

impl Propagator<2> for ModalMotion {
    fn take(&mut self, h: f64, cutoff: f64) {
        if let Some(at) = self.kept.iter().position(|kept| kept.h == h && kept.cutoff == cutoff) {
            self.now = at;
            return;
        }
        if self.kept.len() < KEPT {
            let n = self.len();
            let response = || Response::new(&self.shapes, n);
            let (places, rates) = (response(), response());
            self.kept.push(Coefficients { h, cutoff, modes: vec![[0.0; 4]; n], places, rates });
            self.now = self.kept.len() - 1;
        } else {
            (self.now, self.next) = (self.next, (self.next + 1) % KEPT);
        }
        let Self { kept, now, shapes, stiffness, damping, .. } = self;
        let Coefficients { h: own, cutoff: own_cutoff, modes, places, rates } = &mut kept[*now];
        (*own, *own_cutoff) = (h, cutoff);
        for (k, coefficients) in modes.iter_mut().enumerate() {
            let [b, b_rate, d] = response(stiffness[k], damping[k], h);
            let f = (-(stiffness[k].sqrt() * h / cutoff).powi(8)).exp();
            *coefficients = [b, b_rate, d, f];
            places.gains[k] = 2.0 / (h * h) * yielding(stiffness[k], coefficients);
            rates.gains[k] = f * b / h;
        }
        places.fill(shapes);
        rates.fill(shapes);
    }

    fn begin(&mut self, q: &[f64], v: &[f64], load: &[f64], v_free: &mut [f64]) {
        self.enter(0, q);
        self.enter(1, v);
        self.force.copy_from_slice(&self.constant);
        Self::add_force(&self.shapes, load, &mut self.force);
        let Coefficients { h, modes, .. } = &self.kept[self.now];
        for (k, change) in self.change.iter_mut().enumerate() {
            let [place, rate] = self.start[k];
            let (end, _) = moved(self.stiffness[k], &modes[k], self.start[k], self.force[k]);
            // ṽ¹ − v⁰ of the mode.
            *change = 2.0 * (end[0] - place) / h - 2.0 * rate;
        }
        v_free.copy_from_slice(v);
        Self::add(&self.shapes, &self.change, v_free);
    }

    fn couple(&mut self, rows: &PartRows<'_, 2>, h: &mut Coupling<'_, 2>) {
        self.kept[self.now].places.couple(rows, h);
    }

    fn couple_rates(&mut self, rows: &PartRows<'_, 2>, h: &mut Coupling<'_, 2>) {
        self.kept[self.now].rates.couple(rows, h);
    }

    fn respond(&mut self, rows: &PartRows<'_, 2>, p: &[Vector<2>], v: &mut [f64]) {
        let Response { gains, matrix } = &self.kept[self.now].places;
        for (contact, columns, values) in rows.iter() {
            for (&c, value) in columns.iter().zip(values) {
                let f = value.dot(&p[contact]);
                if matrix.is_empty() {
                    v[c] += gains[c] * f;
                } else {
                    let row = &matrix[c * v.len()..(c + 1) * v.len()];
                    v.iter_mut().zip(row).for_each(|(v, entry)| *v += f * entry);
                }
            }
        }
    }

    fn end(&mut self, rows: &PartRows<'_, 2>, p: &[Vector<2>], v: &mut [f64], mean: &mut [f64]) -> Dissipated {
        let Coefficients { h, modes, .. } = &self.kept[self.now];
        self.change.fill(0.0);
        Self::add_impulses(&self.shapes, rows, p, &mut self.change);
        let mut lost = Dissipated::default();
        for (k, change) in self.change.iter_mut().enumerate() {
            let (omega2, damping, start) = (self.stiffness[k], self.damping[k], self.start[k]);
            let force = self.force[k] + *change / h;
            let (end, exact) = moved(omega2, &modes[k], start, force);
            // Less the potential of the constant force.
            let energy = |[place, rate]: [f64; 2]| 0.5 * (rate * rate + omega2 * place * place) - force * place;
            if damping != 0.0 {
                lost.viscous += energy(start) - energy(exact);
            }
            if end != exact {
                lost.filtered += energy(exact) - energy(end);
            }
            let [moved, sped] = [end[0] - start[0], end[1] - start[1]];
            self.change_of_mean[k] =
                if omega2 > 0.0 { (force - (sped + damping * moved) / h) / omega2 - start[0] } else { 0.5 * moved };
            *change = sped;
        }
        Self::add(&self.shapes, &self.change, v);
        Self::add(&self.shapes, &self.change_of_mean, mean);
        lost
    }
}

/// Adds the columns of a matrix times the numbers of `x` to `out`. Four columns at once: `out` is read and written less often.
fn add_columns(columns: &[f64], x: &[f64], out: &mut [f64]) {
    let n = out.len();
    if n == 0 {
        return;
    }
    let (four, rest) = x.as_chunks::<4>();
    let (blocks, last) = columns.split_at(four.len() * 4 * n);
    for (block, x) in blocks.chunks_exact(4 * n).zip(four) {
        let (first, second) = block.split_at(2 * n);
        let ((a, b), (c, d)) = (first.split_at(n), second.split_at(n));
        for (out, (((a, b), c), d)) in out.iter_mut().zip(a.iter().zip(b).zip(c).zip(d)) {
            *out += (x[0] * a + x[1] * b) + (x[2] * c + x[3] * d);
        }
    }
    for (column, x) in last.chunks_exact(n).zip(rest) {
        out.iter_mut().zip(column).for_each(|(out, a)| *out += x * a);
    }
}

/// The deviation under a unit force at the end, filtered.
fn yielding(omega2: f64, &[_, _, d, f]: &[f64; 4]) -> f64 {
    if f < 1.0 { f * d + (1.0 - f) / omega2 } else { d }
}

/// Place and velocity of a mode at the end, filtered and exact.
fn moved(omega2: f64, &[b, b_rate, d, f]: &[f64; 4], [place, rate]: [f64; 2], force: f64) -> ([f64; 2], [f64; 2]) {
    let pull = force - omega2 * place;
    let exact = [place + b * rate + d * pull, b_rate * rate + b * pull];
    if f == 1.0 {
        return (exact, exact);
    }
    let rest = force / omega2;
    ([rest + f * (exact[0] - rest), f * exact[1]], exact)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODES: [(f64, f64); 9] = [
        (0.0, 0.0),
        (0.0, 3.0),
        (1e-3, 0.0),
        (170.0, 3.4),
        (170.0, 339.9999),
        (170.0, 340.0),
        (170.0, 2e4),
        (3e5, 6e3),
        (3e5, 1e7),
    ];

    /// η and η̇ after h by a power series of so many short steps.
    fn by_series(omega2: f64, damping: f64, start: [f64; 2], force: f64, h: f64) -> [f64; 2] {
        let parts = (h * (omega2.sqrt() + damping) * 4.0).ceil().max(1.0) as usize;
        let tau = h / parts as f64;
        (0..parts).fold(start, |[place, rate], _| {
            let (mut a, mut b) = (place, rate);
            let (mut end, mut speed, mut power) = (place + rate * tau, rate, tau);
            for n in 0..30 {
                let m = f64::from(n);
                let forced = if n == 0 { force } else { 0.0 };
                let next = (forced - damping * (m + 1.0) * b - omega2 * a) / ((m + 1.0) * (m + 2.0));
                (a, b) = (b, next);
                speed += (m + 2.0) * next * power;
                power *= tau;
                end += next * power;
            }
            [end, speed]
        })
    }

    #[test]
    fn modes_move_as_their_equation_says_whatever_their_damping() {
        for (omega, damping) in MODES {
            for h in [1e-7, 1e-5, 1e-4, 1e-3] {
                let [b, b_rate, d] = response(omega * omega, damping, h);
                let (start, force) = ([0.3, -20.0], 1e3);
                let expected = by_series(omega * omega, damping, start, force, h);
                let (_, found) = moved(omega * omega, &[b, b_rate, d, 1.0], start, force);
                let size = [0.3 + 20.0 * h + force * d, 20.0 + omega * 0.3 + force * b.abs()];
                for k in 0..2 {
                    let error = (found[k] - expected[k]).abs() / size[k];
                    assert!(error < 1e-11, "ω {omega}, 2δ {damping}, h {h}: {found:?} {expected:?}");
                }
            }
        }
    }

    /// What the filter takes is energy, and without damping nothing else is taken.
    #[test]
    fn a_step_loses_what_it_says() {
        for (omega, damping) in MODES {
            for h in [1e-5, 1e-3] {
                let mut motion = ModalMotion::new(Shapes::Own, vec![omega * omega], vec![damping], vec![2.0]);
                motion.take(h, 4.0);
                let (q, v) = ([0.3], [-20.0]);
                let mut free = [0.0];
                motion.begin(&q, &v, &[5.0], &mut free);
                let rows = PartRows { part: 0, spans: &[], columns: &[], values: &[] };
                let (mut end, mut mean) = (v, q);
                let lost = motion.end(&rows, &[], &mut end, &mut mean);
                let moved = 0.5 * h * (v[0] + free[0]);
                let energy = |q: f64, v: f64| 0.5 * (v * v + omega * omega * q * q);
                let gained = energy(q[0] + moved, end[0]) - energy(q[0], v[0]) - 7.0 * moved;
                let scale = energy(q[0], v[0]);
                assert!((gained + lost.viscous + lost.filtered).abs() < 1e-12 * scale, "{omega} {damping} {h}");
                assert!(lost.viscous >= -1e-14 * scale && lost.filtered >= 0.0, "{lost:?}");
                assert!(damping != 0.0 || lost.viscous == 0.0);
                assert!(omega * h > 1.0 || lost.filtered < 1e-4 * scale, "{omega} {h}: {lost:?}");
                // M Δv/h + C Δq/h + K q̄ = F.
                let balance = (end[0] - v[0]) / h + damping * moved / h + omega * omega * mean[0] - 7.0;
                let largest = ((end[0] - v[0]) / h).abs() + 7.0 + omega * omega * 0.3;
                assert!(omega == 0.0 || balance.abs() < 1e-11 * largest, "{balance}");
            }
        }
    }
}
