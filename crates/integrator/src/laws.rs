//! Contact laws beyond the standard one, each brought to standard problems, 0 ≤ u_n ⊥ p_n ≥ 0 with Coulomb's friction, so
//! that any contact solver serves (`docs/laws.md`).
//!
//! - **Poisson**: a problem of compression; then one of expansion, in which a contact parts under the normal impulse e p_C,
//!   or stays under a larger one. Friction of an imposed normal impulse N is a standard contact too: its normal part touches
//!   nothing and is made to be N, its tangential part is the real one.
//! - **Energetic**: Newton's law with e scaled, for contacts that feel each other alike, by the largest f ∈ [0, 1] with
//!   which their work Ū·p is not positive: bisection.
//! - **Springs**: Newton's method on the force law p = φ(U¹). Its tangent, U¹ + R p = U_k + R p_k with R = −1/φ', is a standard
//!   contact whose H_nn is larger by R; scaling its normal direction keeps the problem's size what it was. Its friction never
//!   gives energy.

use crate::Vector;
use crate::contacts::{ContactSet, Rule, tangential};
use crate::spring::SpringStep;
use teeter_contact::{Block, ContactProblem, ContactSolver, Delassus, Outcome, ProblemError, Status, Stop};

/// Whether a contact's approach is an impact that e sends back, not the approach that its free acceleration makes within a
/// step: what ends a bounce, so that a resting contact doesn't hop.
pub(crate) fn is_impact<const D: usize>(e: f64, u_before: &Vector<D>, u_free: &Vector<D>) -> bool {
    let by_acceleration = (u_before[0] - u_free[0]).max(0.0);
    -e * u_before[0] > by_acceleration
}

/// A contact of a problem to be solved on the way.
#[derive(Clone, Copy, Debug)]
struct Row<const D: usize> {
    /// The contact of the set.
    contact: usize,
    kind: Kind,
    /// Its velocity without the impulses of the problem, and shifted, m/s.
    u: Vector<D>,
    /// Its impulse, N·s.
    p: Vector<D>,
    /// Scale of its normal direction in the problem.
    scale: f64,
    /// H_nn in the problem.
    normal: f64,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    Standard,
    /// The friction of an imposed normal impulse.
    Friction(f64),
    /// A spring, at the velocity of its tangent.
    Spring(SpringStep, f64),
}

/// Memory for these laws.
#[derive(Debug, Default)]
pub(crate) struct Laws<const D: usize> {
    rows: Vec<Row<D>>,
    blocks: Vec<Block<D>>,
    q: Vec<Vector<D>>,
    mu: Vec<f64>,
    p: Vec<Vector<D>>,
    base: Vec<Vector<D>>,
    /// Impulses of compression.
    compression: Vec<Vector<D>>,
    /// Normal impulses that expansion gives back at the least.
    given: Vec<f64>,
    /// Which contacts part in the expansion tried.
    parts: Vec<bool>,
    /// For each contact the first contact that it feels, through others or directly.
    island: Vec<usize>,
    /// Of each island, by its first contact: a range that holds the largest f.
    range: Vec<[f64; 2]>,
    /// Which springs' friction can't give energy.
    guarded: Vec<bool>,
    /// Work of each island with f = 0, if positive.
    floor: Vec<f64>,
    /// The shifts that the scheme asked for.
    shift: Vec<Vector<D>>,
}

/// Most tangents of the springs in a solve.
const TANGENTS: u32 = 100;

/// Springs whose impulses are this part of the largest off their law count as solved; rounding allows less where they are
/// stiff, so where it no longer falls [`ROUNDED`] is enough.
const ON_LAW: f64 = 1e-13;

/// See [`ON_LAW`].
const ROUNDED: f64 = 1e-9;

/// Units in the last place that a spring's velocity may be off.
const ROUNDING: f64 = 8.0;

/// Halvings of the range of f.
const HALVINGS: u32 = 40;

/// Work below this part of Σ‖U‖‖p‖ is rounding.
const WORKLESS: f64 = 1e-14;

/// Velocities and impulses of expansion that are wrong by this part of the largest velocity before and of the impulse
/// itself decide nothing.
const UNDECIDED: f64 = 1e-11;

impl<const D: usize> Laws<D> {
    /// Makes room for so many contacts.
    pub(crate) fn reserve(&mut self, contacts: usize) {
        // An expansion can hold two of each.
        self.rows.reserve(2 * contacts);
        self.blocks.reserve(4 * contacts * contacts);
        self.q.reserve(2 * contacts);
        self.mu.reserve(2 * contacts);
        self.p.reserve(2 * contacts);
        self.base.reserve(contacts);
        self.compression.reserve(contacts);
        self.given.reserve(contacts);
        self.parts.reserve(contacts);
        self.island.reserve(contacts);
        self.range.reserve(contacts);
        self.floor.reserve(contacts);
        self.guarded.reserve(contacts);
        self.shift.reserve(contacts);
    }

    /// Solves the problem of the set's contacts by their rules, θ that of the step's mean velocity. The impulses stay in the
    /// set.
    pub(crate) fn solve(
        &mut self,
        set: &mut ContactSet<D>,
        theta: f64,
        solver: &mut dyn ContactSolver<D>,
        stop: &Stop<'_>,
    ) -> Result<Outcome, ProblemError> {
        // Springs alone have no use for them.
        if set.rules.iter().any(|rule| matches!(rule, Rule::Poisson { .. } | Rule::Energetic)) {
            self.find_islands(set);
        }
        let outcome = self.guarded_pass(set, theta, solver, stop)?;
        let n = set.rules.len();
        self.range.clear();
        self.range.resize(n, [1.0, 1.0]);
        for i in (0..n).filter(|&i| matches!(set.rules[i], Rule::Energetic) && set.shift[i][0] != 0.0) {
            let first = self.island[i];
            let (work, rounding) = self.work(set, first);
            if work > rounding {
                self.range[first] = [0.0, 1.0];
            }
        }
        if self.range.iter().all(|range| range[0] == 1.0) {
            return Ok(outcome);
        }
        self.shift.clear();
        self.shift.extend_from_slice(&set.shift);
        Ok(join(outcome, self.scale_restitution(set, theta, solver, stop)?))
    }

    /// Finds the largest part f of restitution that makes no energy, for each island whose range says that f = 1 does.
    ///
    /// Beside an impact there can be contacts that give energy by themselves, as one that has sunk in and is on its way out; that
    /// is not restitution's to pay for, so what there is with f = 0 is allowed.
    fn scale_restitution(
        &mut self,
        set: &mut ContactSet<D>,
        theta: f64,
        solver: &mut dyn ContactSolver<D>,
        stop: &Stop<'_>,
    ) -> Result<Outcome, ProblemError> {
        let n = set.rules.len();
        self.scale_shifts(set, |_| 0.0);
        let mut outcome = self.guarded_pass(set, theta, solver, stop)?;
        self.floor.clear();
        for first in 0..n {
            let own = if self.island[first] == first { self.work(set, first).0 } else { 0.0 };
            self.floor.push(own.max(0.0));
        }
        for halving in 0..=HALVINGS {
            // At last the largest f that is known to make none.
            let at = move |[low, high]: [f64; 2]| if halving < HALVINGS { 0.5 * (low + high) } else { low };
            self.scale_shifts(set, at);
            outcome = join(outcome, self.guarded_pass(set, theta, solver, stop)?);
            for first in (0..n).filter(|&i| self.island[i] == i) {
                let [low, high] = self.range[first];
                if low < 1.0 {
                    let f = at(self.range[first]);
                    let (work, rounding) = self.work(set, first);
                    self.range[first] = if work > self.floor[first] + rounding { [low, f] } else { [f, high] };
                }
            }
        }
        Ok(outcome)
    }

    /// Scales the normal shifts of energetic contacts by f of their island's range; f = 1 where the range is one point.
    fn scale_shifts(&self, set: &mut ContactSet<D>, f: impl Fn([f64; 2]) -> f64) {
        for i in 0..set.rules.len() {
            let range = self.range[self.island[i]];
            if matches!(set.rules[i], Rule::Energetic) && range[0] < 1.0 {
                let mut shift = self.shift[i];
                shift[0] *= f(range);
                set.reshift(i, shift);
            }
        }
    }

    /// Contacts that feel each other through H, directly or by others.
    fn find_islands(&mut self, set: &ContactSet<D>) {
        let n = set.rules.len();
        self.island.clear();
        self.island.extend(0..n);
        let mut changed = true;
        while changed {
            changed = false;
            for i in 0..n {
                for j in 0..n {
                    let first = self.island[i].min(self.island[j]);
                    let couples = set.blocks[i * n + j] != Block::<D>::zeros();
                    if couples && (self.island[i] != first || self.island[j] != first) {
                        (self.island[i], self.island[j]) = (first, first);
                        changed = true;
                    }
                }
            }
        }
    }

    /// The work Ū·p of an island's contacts, Ū the mean of U⁰ and U¹ whatever θ is: that is what an impact changes of the kinetic
    /// energy. And how much of it is rounding. Both in J.
    fn work(&self, set: &ContactSet<D>, first: usize) -> (f64, f64) {
        let (mut work, mut size) = (0.0, 0.0);
        for i in (0..set.rules.len()).filter(|&i| self.island[i] == first) {
            let (before, after) = (set.contacts()[i].u_before, set.velocity_by_impulses(i));
            work += ((after + before) * 0.5).dot(&set.p[i]);
            size += (after.norm() + before.norm()) * set.p[i].norm();
            if let Rule::Spring(spring) = set.rules[i] {
                work += spring.spring.potential(spring.gap_after(after[0])) - spring.spring.potential(spring.gap);
            }
        }
        (work, WORKLESS * size)
    }

    /// A pass in which friction of springs doesn't give energy: where U_θ,t·p_t > 0, Coulomb's law is made to hold for U_θ,t.
    fn guarded_pass(
        &mut self,
        set: &mut ContactSet<D>,
        theta: f64,
        solver: &mut dyn ContactSolver<D>,
        stop: &Stop<'_>,
    ) -> Result<Outcome, ProblemError> {
        let mut outcome = self.pass(set, solver, stop)?;
        let n = set.rules.len();
        self.guarded.clear();
        self.guarded.resize(n, false);
        // Each round guards one contact more at least.
        loop {
            let mut found = false;
            for i in 0..n {
                let Rule::Spring(step) = set.rules[i] else { continue };
                let (before, after) =
                    (tangential(&set.contacts()[i].u_before), tangential(&set.velocity_by_impulses(i)));
                let p = tangential(&set.p[i]);
                let gain = (after * theta + before * (1.0 - theta)).dot(&p);
                if !self.guarded[i] && gain > WORKLESS * (after.norm() + before.norm()) * p.norm() {
                    set.reshift(i, before * ((1.0 - step.theta) / step.theta));
                    self.guarded[i] = true;
                    found = true;
                }
            }
            if !found {
                return Ok(outcome);
            }
            outcome = join(outcome, self.pass(set, solver, stop)?);
        }
    }

    /// Compression, and expansion where an impact asks for it.
    fn pass(
        &mut self,
        set: &mut ContactSet<D>,
        solver: &mut dyn ContactSolver<D>,
        stop: &Stop<'_>,
    ) -> Result<Outcome, ProblemError> {
        let n = set.rules.len();
        self.base.clear();
        self.base.resize(n, Vector::zeros());
        self.rows.clear();
        for i in 0..n {
            self.rows.push(self.row(set, i, false));
        }
        let outcome = self.settle(set, solver, stop)?;
        self.take(set);
        self.given.clear();
        for i in 0..n {
            let given = self.expands(set, i).map_or(0.0, |e| e * set.p[i][0]);
            self.given.push(given);
        }
        if self.given.iter().all(|given| *given == 0.0) {
            return Ok(outcome);
        }
        self.compression.clear();
        self.compression.extend_from_slice(&set.p);
        // What comes back is of the blow alone, not of the weight that acts in the step: with it a bounce with e = 1 would rise.
        self.base.fill(Vector::zeros());
        self.rows.clear();
        for i in 0..n {
            let mut row = self.row(set, i, false);
            row.u += set.contacts()[i].u_before - set.u_free[i];
            self.rows.push(row);
        }
        let blow = self.settle(set, solver, stop)?;
        let outcome = join(outcome, blow);
        for i in 0..n {
            if let (Rule::Poisson { e, .. }, true) = (set.rules[i], self.given[i] > 0.0) {
                self.given[i] = e * self.rows[i].p[0];
            }
        }
        Ok(join(outcome, self.expand(set, solver, stop)?))
    }

    /// Expansion after the compression kept in `compression`. Either a contact gets the impulse given back and parts, or it
    /// stays at rest under a larger one: which, is found by trial, from all parting.
    fn expand(
        &mut self,
        set: &mut ContactSet<D>,
        solver: &mut dyn ContactSolver<D>,
        stop: &Stop<'_>,
    ) -> Result<Outcome, ProblemError> {
        let n = set.rules.len();
        let fastest = set.contacts().iter().map(|contact| contact.u_before.norm()).fold(0.0, f64::max);
        self.parts.clear();
        self.parts.extend(self.given.iter().map(|given| *given > 0.0));
        let mut sum: Option<Outcome> = None;
        // A row of contacts takes as many rounds as it is long; with friction none may fit.
        for _ in 0..2 * n + 10 {
            let outcome = self.try_expansion(set, solver, stop, false)?;
            let outcome = sum.map_or(outcome, |sum| join(sum, outcome));
            sum = Some(outcome);
            let mut changed = false;
            for i in (0..n).filter(|&i| self.given[i] > 0.0) {
                let wrong = if self.parts[i] {
                    self.normal_velocity(set, i) < -UNDECIDED * fastest
                } else {
                    self.rows[i].p[0] < self.given[i] * (1.0 - UNDECIDED)
                };
                self.parts[i] ^= wrong;
                changed |= wrong;
            }
            if !changed {
                self.take(set);
                return Ok(outcome);
            }
        }
        // The impulse given back, and what it takes beyond it, as two contacts at one point: solvable always, but two that
        // stick there share their friction in no one way.
        self.parts.fill(false);
        let outcome = self.try_expansion(set, solver, stop, true)?;
        self.take(set);
        Ok(sum.map_or(outcome, |sum| with_iterations(outcome, sum.iterations + outcome.iterations)))
    }

    /// Solves an expansion in which the contacts of `parts` get what is given back and no more. `both`: the others get it too,
    /// beside what they take themselves.
    fn try_expansion(
        &mut self,
        set: &mut ContactSet<D>,
        solver: &mut dyn ContactSolver<D>,
        stop: &Stop<'_>,
        both: bool,
    ) -> Result<Outcome, ProblemError> {
        let n = set.rules.len();
        for i in 0..n {
            self.base[i] = match set.rules[i] {
                Rule::Spring(_) => Vector::zeros(),
                _ => self.compression[i],
            };
            if self.parts[i] || both {
                self.base[i][0] += self.given[i];
            }
        }
        self.rows.clear();
        for i in 0..n {
            let mut row = self.row(set, i, true);
            if !matches!(set.rules[i], Rule::Spring(_)) {
                row.p = Vector::zeros();
            }
            if self.parts[i] {
                row.kind = Kind::Friction(self.given[i]);
            }
            self.rows.push(row);
        }
        for i in (0..n).filter(|&i| both && self.given[i] > 0.0) {
            let row = Row { kind: Kind::Friction(self.given[i]), ..self.rows[i] };
            self.rows.push(row);
        }
        self.settle(set, solver, stop)
    }

    /// The part e of its impulse of compression that a contact gives back: it obeys Poisson's law, was compressed, and feels
    /// an impact, its own or another's.
    fn expands(&self, set: &ContactSet<D>, i: usize) -> Option<f64> {
        let Rule::Poisson { e, .. } = set.rules[i] else { return None };
        let impact = |j: usize| is_impact(1.0, &set.contacts()[j].u_before, &set.u_free[j]);
        let felt = || (0..set.rules.len()).any(|j| self.island[j] == self.island[i] && impact(j));
        (e > 0.0 && set.p[i][0] > 0.0 && felt()).then_some(e)
    }

    /// The contact of the problem for contact `i` on top of the base impulses.
    fn row(&self, set: &ContactSet<D>, i: usize, expansion: bool) -> Row<D> {
        let n = set.rules.len();
        let blocks = &set.blocks[i * n..(i + 1) * n];
        let mut u = blocks.iter().zip(&self.base).fold(set.u_free[i], |u, (block, p)| u + block * p);
        u += set.shift[i];
        if let (Rule::Poisson { tangential: e, .. }, true) = (set.rules[i], expansion) {
            u += tangential(&set.contacts()[i].u_before) * e;
        }
        let kind = match set.rules[i] {
            Rule::Spring(step) => Kind::Spring(step, u[0].min(set.u_free[i][0])),
            _ => Kind::Standard,
        };
        Row { contact: i, kind, u, p: set.p[i], scale: 1.0, normal: blocks[i][(0, 0)] }
    }

    /// Solves the problem of the rows, springs on their law.
    fn settle(
        &mut self,
        set: &ContactSet<D>,
        solver: &mut dyn ContactSolver<D>,
        stop: &Stop<'_>,
    ) -> Result<Outcome, ProblemError> {
        let mut sum: Option<Outcome> = None;
        let mut last = f64::INFINITY;
        for tangent in 1..=TANGENTS {
            let outcome = self.solve_rows(set, solver, stop)?;
            let outcome = sum.map_or(outcome, |sum| with_iterations(outcome, sum.iterations + outcome.iterations));
            sum = Some(outcome);
            let (off, noise) = self.retouch(set);
            let settled = off <= ON_LAW || (tangent > 3 && off >= last && off <= noise.max(ROUNDED));
            if settled || !outcome.converged() {
                return Ok(outcome);
            }
            last = off;
        }
        // Every problem was solved, but the springs didn't come to rest.
        match sum {
            Some(outcome) => Ok(unsolved(outcome)),
            None => self.solve_rows(set, solver, stop).map(unsolved),
        }
    }

    /// Moves the springs' tangents to where the last problem ended. Returns how far their impulses are off the law, and how
    /// far rounding can put them, both relative to the largest impulse.
    fn retouch(&mut self, set: &ContactSet<D>) -> (f64, f64) {
        let (mut off, mut noise, mut largest) = (0.0_f64, 0.0_f64, f64::MIN_POSITIVE);
        for r in 0..self.rows.len() {
            largest = largest.max(self.rows[r].p[0]);
            let Kind::Spring(step, _) = self.rows[r].kind else { continue };
            let u = self.normal_velocity(set, r);
            let (impulse, slope) = step.impulse(u);
            // A stiff spring makes much of the last digits of its velocity.
            let rounding = ROUNDING * f64::EPSILON * slope.abs() * self.size_of_velocity(set, r);
            off = off.max((self.rows[r].p[0] - impulse).abs());
            noise = noise.max(rounding);
            self.rows[r].kind = Kind::Spring(step, u);
        }
        (off / largest, noise / largest)
    }

    /// The true normal velocity of a row's contact after the problem.
    fn normal_velocity(&self, set: &ContactSet<D>, r: usize) -> f64 {
        let n = set.rules.len();
        let row = &self.rows[r];
        let others = self.rows.iter().map(|other| {
            let mut p = other.p;
            if matches!(other.kind, Kind::Friction(_)) {
                p[0] = 0.0; // it is in the base
            }
            (set.blocks[row.contact * n + other.contact] * p)[0]
        });
        row.u[0] + others.sum::<f64>()
    }

    /// The sum of the sizes of what [`Laws::normal_velocity`] adds up, m/s.
    fn size_of_velocity(&self, set: &ContactSet<D>, r: usize) -> f64 {
        let n = set.rules.len();
        let row = &self.rows[r];
        let others = self.rows.iter().map(|other| {
            let h = &set.blocks[row.contact * n + other.contact];
            (0..D).map(|d| (h[(0, d)] * other.p[d]).abs()).sum::<f64>()
        });
        row.u[0].abs() + others.sum::<f64>()
    }

    /// Poses and solves the standard problem of the rows.
    fn solve_rows(
        &mut self,
        set: &ContactSet<D>,
        solver: &mut dyn ContactSolver<D>,
        stop: &Stop<'_>,
    ) -> Result<Outcome, ProblemError> {
        let n = set.rules.len();
        self.q.clear();
        self.mu.clear();
        self.p.clear();
        for row in &mut self.rows {
            let own = &set.blocks[row.contact * n + row.contact];
            let (mut q, mut mu) = (row.u, set.mu[row.contact]);
            match row.kind {
                Kind::Standard => {}
                Kind::Friction(normal) => {
                    // Any positive number does; one of the size of the others keeps the problem's scale.
                    (row.scale, row.normal) = (0.0, own.trace());
                    q[0] = -row.normal * normal;
                }
                Kind::Spring(step, at) => {
                    let (impulse, slope) = step.impulse(at);
                    // Where it doesn't touch, hardly anything: as soft as it takes to be found if others push it in.
                    let (softness, impulse, at) = if slope < 0.0 {
                        (-slope.recip(), impulse, at)
                    } else {
                        (UNTOUCHED * own[(0, 0)], 0.0, at.min(step.touching()))
                    };
                    row.scale = (own[(0, 0)] / (own[(0, 0)] + softness)).sqrt();
                    row.normal = own[(0, 0)];
                    q[0] = row.scale * (row.u[0] - at - softness * impulse);
                    mu *= row.scale;
                }
            }
            let mut p = row.p;
            if row.scale > 0.0 {
                p[0] /= row.scale;
            }
            self.q.push(q);
            self.mu.push(mu);
            self.p.push(p);
        }
        self.blocks.clear();
        for (r, row) in self.rows.iter().enumerate() {
            for (c, column) in self.rows.iter().enumerate() {
                let mut block = set.blocks[row.contact * n + column.contact];
                block.row_mut(0).scale_mut(row.scale);
                block.column_mut(0).scale_mut(column.scale);
                if r == c {
                    block[(0, 0)] = row.normal;
                }
                self.blocks.push(block);
            }
        }
        let problem = ContactProblem::new(Delassus::Dense(&self.blocks), &self.q, &self.mu)?;
        let outcome = solver.solve(&problem, stop, &mut self.p);
        for (row, p) in self.rows.iter_mut().zip(&self.p) {
            row.p = *p;
            if row.scale > 0.0 {
                row.p[0] *= row.scale;
            }
        }
        Ok(outcome)
    }

    /// Brings base and rows together as the impulses of the set.
    fn take(&mut self, set: &mut ContactSet<D>) {
        set.p.copy_from_slice(&self.base);
        for row in &self.rows {
            let mut p = row.p;
            if matches!(row.kind, Kind::Friction(_)) {
                p[0] = 0.0;
            }
            set.p[row.contact] += p;
        }
    }
}

/// A spring that isn't touched is softer than its contact by this factor.
const UNTOUCHED: f64 = 1e8;

/// The later of two outcomes with the iterations of both; an unsolved one is not forgotten.
pub(crate) fn join(first: Outcome, second: Outcome) -> Outcome {
    let iterations = first.iterations + second.iterations;
    let kept = if first.converged() { second } else { first };
    with_iterations(kept, iterations)
}

fn unsolved(mut outcome: Outcome) -> Outcome {
    outcome.status = Status::MaxIterations;
    outcome
}

fn with_iterations(mut outcome: Outcome, iterations: u32) -> Outcome {
    outcome.iterations = iterations;
    outcome
}
