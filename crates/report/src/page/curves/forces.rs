//! The forces of a contact point over time, and what it does.

use teeter_integrator::ContactState;

/// A contact point over time, a value a bucket.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ForceCurve {
    /// Mean normal force, N, without the steps in which there were impacts, unless there are no others.
    pub(crate) normal: Vec<f64>,
    /// Mean tangential force, N, alike.
    pub(crate) tangential: Vec<f64>,
    /// Its normal and its tangential force, N, at the times of [`Curves::curve`](super::Curves::curve): of springs with all their peaks, of
    /// others, where a bucket has more steps than those of a short mean, the least and the largest of these. None where the means say all.
    pub(crate) course: Option<[Vec<f64>; 2]>,
    /// Tangential displacement while it pressed, from the start to the end of the bucket, m.
    pub(crate) slip: Vec<f64>,
    /// The state in most of the steps in which it presses, however few these are.
    pub(crate) state: Vec<ContactState>,
    /// The state in most of the steps, of those in which it is open, too.
    pub(crate) usual: Vec<ContactState>,
    /// The largest normal impulse in a step with an impact, N·s; empty without any.
    pub(crate) impacts: Vec<f64>,
    /// Whether it sticks and slips by turns in more than a few stretches.
    pub(crate) alternates: bool,
    /// Whether it is told to stick somewhere where it slips by no more than rounding.
    pub(crate) hides_slip: bool,
    /// The farthest that it slips in a stretch in which it does so by its state in some of the steps, however few, m.
    pub(crate) slid: f64,
}

/// What slips by no more than rounding at the beginning or the end of a slide is drawn as sticking if it takes more than this part of the run: so long
/// that it is seen.
const TREMBLES: usize = 100;

/// What a contact does in a bucket, as it is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Does {
    Open,
    /// It presses in at most half of the steps: it strikes, or chatters.
    Briefly,
    Stick,
    Slip,
}

impl ForceCurve {
    /// Its normal (0) or tangential (1) force as it is drawn, N: the course, or means where there is none.
    pub(crate) fn drawn(&self, part: usize) -> &[f64] {
        match &self.course {
            Some(course) => &course[part],
            None => [&self.normal, &self.tangential][part],
        }
    }

    /// What it does in a bucket. An impact between two steps in which it is open is no stretch of sticking.
    pub(crate) fn does(&self, bucket: usize) -> Does {
        match (self.usual[bucket], self.state[bucket]) {
            (ContactState::Open, ContactState::Open) => Does::Open,
            (ContactState::Open, _) => Does::Briefly,
            (_, ContactState::Slip) => Does::Slip,
            _ => Does::Stick,
        }
    }

    /// Drops impulses that are no larger than what the force beside them gives in a time of `lasting` (s): they are its own, not
    /// those of impacts. The force is the mean normal force of the nearest stretch without an impulse, before or after. An impulse
    /// that follows a flight is one of an impact, however small.
    pub(crate) fn drop_impacts_of_force(&mut self, lasting: f64) {
        let strikes: Vec<bool> = self.impacts.iter().map(|impulse| *impulse > 0.0).collect();
        let force = |k: usize| (!strikes[k]).then(|| self.normal[k].max(0.0));
        let of_force = |k: &usize| {
            let before = (0..*k).rev().find_map(force);
            let after = (k + 1..strikes.len()).find_map(force).unwrap_or(0.0);
            let largest = if before == Some(0.0) { 0.0 } else { before.unwrap_or(0.0).max(after) };
            self.impacts[*k] <= lasting * largest
        };
        let dropped: Vec<usize> = (0..strikes.len()).filter(|k| strikes[*k]).filter(of_force).collect();
        dropped.iter().for_each(|k| self.impacts[*k] = 0.0);
        if self.impacts.iter().all(|impulse| *impulse == 0.0) {
            self.impacts.clear();
        }
    }

    /// Takes slip that is nothing but rounding, in all of a stretch in which the contact slips no more than that (m), for sticking.
    pub(crate) fn stick_within(&mut self, rounding: f64) {
        let mut from = 0;
        while from < self.state.len() {
            let slips = |k: &usize| self.state.get(*k) == Some(&ContactState::Slip);
            let to = (from..).find(|k| !slips(k)).unwrap_or(from);
            let before = |k: usize| if k == 0 { 0.0 } else { self.slip[k - 1] };
            let slipped: f64 = (from..to).map(|k| (self.slip[k] - before(k)).abs()).sum();
            if !(slipped > rounding) {
                self.hides_slip |= from < to;
                self.state[from..to].fill(ContactState::Stick);
            } else {
                // It may tremble for long before it goes, or after.
                let long = (self.state.len() / TREMBLES).max(2);
                let mut sum = 0.0;
                let trembles = |k: &usize| {
                    sum += (self.slip[*k] - before(*k)).abs();
                    sum <= rounding
                };
                let first = (from..to).take_while(trembles).count();
                let mut sum = 0.0;
                let trembles = |k: &usize| {
                    sum += (self.slip[*k] - before(*k)).abs();
                    sum <= rounding
                };
                let last = (from..to).rev().take_while(trembles).count();
                for part in [from..from + first, to - last..to].into_iter().filter(|part| part.len() > long) {
                    self.hides_slip = true;
                    self.state[part].fill(ContactState::Stick);
                }
            }
            from = to + 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_step_of_the_force_beside_it_gives_is_no_impact() {
        let kept = |normal: [f64; 6], impacts: [f64; 6]| {
            let mut forces = ForceCurve {
                normal: normal.to_vec(),
                tangential: vec![0.0; 6],
                course: None,
                slip: vec![0.0; 6],
                state: vec![ContactState::Stick; 6],
                usual: Vec::new(),
                impacts: impacts.to_vec(),
                alternates: false,
                hides_slip: false,
                slid: 0.0,
            };
            forces.drop_impacts_of_force(0.1);
            forces.impacts
        };
        // The mean of a stretch with an impulse, where all of its steps have one, is that of these.
        let press = [4.0, 70.0, 5.0, 5.0, 70.0, 5.0];
        assert_eq!(kept(press, [0.0, 0.5, 0.0, 0.0, 0.6, 0.0]), [0.0, 0.0, 0.0, 0.0, 0.6, 0.0]);
        assert_eq!(kept(press, [0.0, 0.4, 0.0, 0.0, 0.5, 0.0]), [0.0; 0]);
        // After a flight it is one, and a large force at another time hides none.
        let after_flights = [0.0, 0.1, 0.0, 0.0, 0.1, 0.0];
        assert_eq!(kept([0.0, 3.0, 0.0, 0.0, 5.0, 5.0], after_flights), after_flights);
        let before_a_large_force = [0.0, 0.0, 0.3, 0.0, 0.0, 0.0];
        assert_eq!(kept([0.0, 1.0, 1.0, 1.0, 1e3, 1e3], before_a_large_force), before_a_large_force);
    }

    #[test]
    fn slip_of_rounding_is_sticking_and_a_short_slide_is_not() {
        use ContactState::{Open, Slip, Stick};
        let of = |slip: [f64; 6]| {
            let mut forces = ForceCurve {
                normal: vec![1.0; 6],
                tangential: vec![0.0; 6],
                course: None,
                slip: slip.to_vec(),
                state: vec![Slip, Slip, Open, Stick, Slip, Slip],
                usual: Vec::new(),
                impacts: Vec::new(),
                alternates: false,
                hides_slip: false,
                slid: 0.0,
            };
            forces.stick_within(1e-9);
            (forces.state, forces.hides_slip)
        };
        assert_eq!(
            of([1e-10, 2e-10, 2e-10, 2e-10, 3e-10, 4e-10]),
            ([Stick, Stick, Open, Stick, Stick, Stick].to_vec(), true)
        );
        assert_eq!(of([0.0, 0.0, 0.0, 0.0, 1e-3, 2e-3]), ([Stick, Stick, Open, Stick, Slip, Slip].to_vec(), true));
        // It trembles by less than that for long before it slides.
        let mut trembles = ForceCurve {
            normal: vec![1.0; 12],
            tangential: vec![0.0; 12],
            course: None,
            slip: (0..12).map(|k| if k < 9 { 1e-10 * f64::from(k % 2) } else { 1e-3 * f64::from(k - 8) }).collect(),
            state: vec![Slip; 12],
            usual: Vec::new(),
            impacts: Vec::new(),
            alternates: false,
            hides_slip: false,
            slid: 0.0,
        };
        trembles.stick_within(1e-9);
        assert_eq!(trembles.state, [vec![Stick; 9], vec![Slip; 3]].concat());
        assert!(trembles.hides_slip);
        // To and fro it comes back to where it was, but has slipped.
        assert_eq!(of([1e-3, 0.0, 0.0, 0.0, 0.0, 0.0]), ([Slip, Slip, Open, Stick, Stick, Stick].to_vec(), true));
    }
}
