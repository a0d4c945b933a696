//! Compression and expansion: Poisson's law; for other laws there is one problem only.

use super::rows::{Kind, Row};
use super::{Laws, is_impact, join, with_iterations};
use crate::Vector;
use crate::stage::{Problem, Rule};
use teeter_contact::{ContactSolver, Outcome, ProblemError, Stop};

/// Violations in expansion below this fraction, of the largest velocity before or of the impulse
/// itself, are ignored.
const UNDECIDED: f64 = 1e-11;

impl<const D: usize> Laws<D> {
    /// Compression, and expansion if there is an impact.
    pub(super) fn pass(
        &mut self,
        set: &mut Problem<D>,
        solver: &mut dyn ContactSolver<D>,
        stop: &Stop<'_>,
    ) -> Result<Outcome, ProblemError> {
        let n = set.len();
        self.start_blow_from_nothing(set);
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
            let given = self.expands(set, i).map_or(0.0, |e| self.part[i] * e * set.p[i][0]);
            self.given.push(given);
        }
        if self.given.iter().all(|given| *given == 0.0) {
            return Ok(outcome);
        }
        self.compression.clear();
        self.compression.extend_from_slice(&set.p);
        // Restitution applies to the impact alone, not to the weight that acts within the step:
        // with that, a bounce with e = 1 would gain height.
        self.base.fill(Vector::zeros());
        self.rows.clear();
        for i in 0..n {
            let mut row = self.row(set, i, false);
            row.u += set.u_before(i) - set.u_free(i);
            self.rows.push(row);
        }
        let blow = self.settle(set, solver, stop)?;
        let outcome = join(outcome, blow);
        for i in 0..n {
            if let (Rule::Poisson { e, .. }, true) = (set.rule(i), self.given[i] > 0.0) {
                self.given[i] = self.part[i] * e * self.rows[i].p[0];
            }
        }
        Ok(join(outcome, self.expand(set, solver, stop)?))
    }

    /// Sets the impulses from which the solver starts to 0 where some of what it finds is given back.
    ///
    /// In a jam, as of a stone between the floor and a wall at μ > 1, impulses along a direction of the contacts do
    /// nothing, and stay as large as they were at the start. Started from those of the last blow, they would
    /// be 1 + e times as large after each, until their rounding throws the stone away.
    fn start_blow_from_nothing(&self, set: &mut Problem<D>) {
        let gives_back = |rule: &Rule<D>| matches!(rule, Rule::Poisson { e, .. } if *e > 0.0);
        let strikes = |i: usize| is_impact(1.0, &set.u_before(i), &set.u_free(i));
        if set.rules().any(gives_back) && (0..set.len()).any(strikes) {
            set.p.fill(Vector::zeros());
        }
    }

    /// Expansion after the compression kept in `compression`. A contact either gets the impulse of
    /// restitution and separates, or stays closed under a larger one. Which of them separate is
    /// found by trial, starting with all.
    fn expand(
        &mut self,
        set: &mut Problem<D>,
        solver: &mut dyn ContactSolver<D>,
        stop: &Stop<'_>,
    ) -> Result<Outcome, ProblemError> {
        let n = set.len();
        let fastest = set.posed.iter().map(|posed| posed.u_before.norm()).fold(0.0, f64::max);
        self.parts.clear();
        self.parts.extend(self.given.iter().map(|given| *given > 0.0));
        let mut sum: Option<Outcome> = None;
        // A chain of contacts takes as many rounds as it is long; with friction there may be no
        // solution.
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
        // The impulse of restitution and what is needed beyond it, as two contacts at one point.
        // This always has a solution, but if both stick, how they share friction isn't unique.
        self.parts.fill(false);
        let outcome = self.try_expansion(set, solver, stop, true)?;
        self.take(set);
        Ok(sum.map_or(outcome, |sum| with_iterations(outcome, sum.iterations + outcome.iterations)))
    }

    /// Solves an expansion in which the contacts of `parts` get the impulse of restitution and no
    /// more. With `both`, the others get it as well, beside their own impulse.
    fn try_expansion(
        &mut self,
        set: &mut Problem<D>,
        solver: &mut dyn ContactSolver<D>,
        stop: &Stop<'_>,
        both: bool,
    ) -> Result<Outcome, ProblemError> {
        let n = set.len();
        for i in 0..n {
            self.base[i] = match set.rule(i) {
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
            if !matches!(set.rule(i), Rule::Spring(_)) {
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

    /// The fraction e of its impulse of compression that a contact returns; `None` unless it obeys
    /// Poisson's law, was compressed, and is coupled with an impact, its own or another's.
    fn expands(&self, set: &Problem<D>, i: usize) -> Option<f64> {
        let Rule::Poisson { e, .. } = set.rule(i) else { return None };
        let impact = |j: usize| is_impact(1.0, &set.u_before(j), &set.u_free(j));
        let felt = || (0..set.len()).any(|j| self.island[j] == self.island[i] && impact(j));
        (e > 0.0 && set.p[i][0] > 0.0 && felt()).then_some(e)
    }
}
