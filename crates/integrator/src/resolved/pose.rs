//! What each contact of a part of a step is asked for: a closed gap at a beam, a velocity elsewhere.

use super::{Posed, Resolved};
use crate::closed_step::{THETA, find, restitute};
use crate::contact::tangential;
use crate::{Model, Responses, Rule, SpringStep, State, StepError, StepSpan, Vector, Workspace};
use teeter_detect::Candidate;

/// A gap is held where hV/(2D) is at most this: 1 between bodies, ¾ on a long beam, 0 on one without mass.
const BODIES: f64 = 0.82;

/// A contact with a beam that gives something back: in the continuum that has no meaning.
const RESTITUTION: &str =
    "restitution or a law with duration at a beam: resolved takes a beam's own elasticity for all that it gives back";

/// A gap is known to this part of the largest coordinate: beside what is less, J Δq is Δg.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

impl<const D: usize> Resolved<D> {
    /// Poses the contacts with their rows in the middle of the motion to `q_at`.
    pub(super) fn pose(
        &mut self,
        model: &Model<D>,
        from: &State,
        part: &StepSpan,
        work: &mut Workspace<D>,
        pass: usize,
    ) -> Result<(), StepError> {
        self.stage.clear();
        self.posed.clear();
        for (mean, (v1, v0)) in self.mean.iter_mut().zip(self.step.v_end.iter().zip(&from.v)) {
            *mean = 0.5 * (v0 + v1);
        }
        model.move_along(&from.q, &self.mean, 0.5 * part.h, &mut self.q_mid);
        work.locate(model, &self.q_mid, &self.ids, &mut self.middle)?;
        work.locate(model, &self.step.q_at, &self.ids, &mut self.ahead)?;
        self.find_momentum(model, from);
        self.stage.springs.hand_over(model, from, self.middle.iter(), false, work)?;
        for k in 0..self.middle.len() {
            let candidate = self.middle[k];
            if self.stage.springs.leaves_out(candidate.id) {
                continue;
            }
            self.pose_one(model, from, part, work, &candidate, pass)?;
        }
        Ok(())
    }

    fn pose_one(
        &mut self,
        model: &Model<D>,
        from: &State,
        part: &StepSpan,
        work: &mut Workspace<D>,
        candidate: &Candidate<D>,
        pass: usize,
    ) -> Result<(), StepError> {
        let law = model.law(candidate.law)?;
        let i = self.stage.len();
        if !self.stage.add(model, &self.q_mid, candidate, &from.warm, &from.memory)? {
            return Ok(());
        }
        let held = match self.holds.iter().find(|(id, _)| *id == candidate.id) {
            Some((_, held)) => *held,
            None => {
                let held = self.is_held(i, model, part, work);
                self.holds.push((candidate.id, held));
                held
            }
        };
        let gives_back = law.restitution > 0.0 || law.tangential_restitution > 0.0 || law.impact.spring().is_some();
        if held && gives_back {
            return Err(StepError::Unsupported { what: RESTITUTION });
        }
        let way = self.way_of_forces(i, from) * part.h / (self.of_step * self.of_step);
        let persisting = self.stage.contacts()[i].persisting;
        // Off the end of its surface by then, it has no frame there.
        let ahead = find(&self.ahead, candidate.id).copied();
        let gap_before = find(&self.start, candidate.id).map_or(0.0, |start| start.gap);
        if held
            && let Some(ahead) = &ahead
            && pass > 0
        {
            self.take_discrete_gradient(i, ahead.gap - gap_before, part.h)?;
        }
        let approach = if persisting { 0.0 } else { gap_before };
        let u_before = self.stage.velocity(i, &from.v)?;
        let u_free = self.stage.velocity(i, &self.v_free)?;
        let b = match &ahead {
            Some(ahead) => {
                self.one.clear();
                match self.one.add(model, &self.step.q_at, ahead, &from.warm, &from.memory)? {
                    true => self.one.velocity(0, &from.v)? - u_before,
                    false => Vector::zeros(),
                }
            }
            None => Vector::zeros(),
        };
        let (before_t, b_t) = (tangential(&u_before), tangential(&b));
        let mut shift = if (before_t - b_t).norm() <= b_t.norm() { before_t } else { b_t };
        let rule;
        if held {
            // 2g(q¹)/h, linear about the motion that is known.
            // What is in the surface already is not pushed out: that would be a blow.
            let level = gap_before.min(0.0);
            let gap = ahead.map_or(gap_before, |ahead| ahead.gap) - level;
            shift[0] = 2.0 * gap / part.h - self.stage.velocity(i, &self.step.v_end)?[0];
            self.posed.push(Posed { held, resting_shift: shift[0], approach, way });
            rule = Rule::Shifted;
        } else if law.impact.spring().is_some() {
            let kept = self.stage.springs.kept_gap(candidate.id, &from.memory);
            let gap = kept.unwrap_or_else(|| gap_before.max(0.0));
            shift[0] = 0.0;
            self.posed.push(Posed { held, resting_shift: 0.0, approach, way });
            rule = SpringStep::new(&law.impact, gap, u_before[0], part.h, THETA).map_or(Rule::Shifted, Rule::Spring);
        } else {
            // Modes that move exactly don't end with the velocity that makes their mean the way: contacts that ask for a velocity of 0 at
            // the end would sink from step to step. Those keep their gap, J Δq = 0.
            let keeps = persisting && self.stage.parts_of(i).any(|index| work.factors.propagator(index).is_some());
            shift[0] =
                if keeps || (u_before[0] - b[0]).abs() <= b[0].abs() { u_before[0] } else { b[0].max(u_before[0]) };
            if !persisting && u_before[0] < 0.0 {
                shift[0] = 0.0;
            }
            self.posed.push(Posed { held, resting_shift: shift[0], approach, way });
            let whole = u_before + (u_free - u_before) / self.of_step;
            rule = restitute(persisting, &law, &u_before, &whole, &mut shift);
        }
        Ok(self.stage.set(i, u_before, u_free, shift, rule)?)
    }

    /// Makes the normal rows of contact `i` a discrete gradient of its gap, J Δq = Δg: J += α (MΔq)ᵀ, so that its force does the work that
    /// the gap says.
    fn take_discrete_gradient(&mut self, i: usize, change: f64, h: f64) -> Result<(), StepError> {
        let known = self.stage.velocity(i, &self.mean)?[0] * h;
        let largest = self.q_end.iter().fold(0.0_f64, |largest, q| largest.max(q.abs()));
        if (change - known).abs() <= ROUNDING * largest {
            return Ok(());
        }
        let mut square = 0.0;
        let mut last = usize::MAX;
        for (column, _) in self.stage.rows.entries(i) {
            if column != last {
                square += self.momentum[column] * self.mean[column] * h;
            }
            last = column;
        }
        let a = (change - known) / square;
        if square > 0.0 && a.is_finite() {
            self.stage.update_row(i, a, &self.momentum)?;
        }
        Ok(())
    }

    /// Whether the gap of contact `i` is held. A constant force that holds it changes a relative velocity
    /// U to (1 − hV/D) U: to −U between bodies, which would part at once, to −½U on a long beam.
    fn is_held(&mut self, i: usize, model: &Model<D>, part: &StepSpan, work: &mut Workspace<D>) -> bool {
        let (mut place, mut rate) = (0.0, 0.0);
        for index in self.stage.parts_of(i) {
            let [own_place, own_rate] = self.stage.own_response(i, index, model, &Responses::Over(part.h), work);
            (place, rate) = (place + own_place, rate + own_rate);
        }
        rate <= BODIES * place
    }

    /// The change of the normal velocity of contact `i` by forces on what isn't elastic, in the part of the step that is taken, m/s.
    fn way_of_forces(&self, i: usize, from: &State) -> f64 {
        let mut sum = 0.0;
        for (column, value) in self.stage.rows.entries(i) {
            if !self.elastic[column] {
                sum += value[0] * (self.v_free[column] - from.v[column]);
            }
        }
        sum.abs()
    }
}
