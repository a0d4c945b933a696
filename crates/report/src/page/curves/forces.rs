//! The forces of a contact point over time, and what it does.

use teeter_integrator::ContactState;

/// A contact point over time, a value a bucket.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ForceCurve {
    /// Mean normal force, N, without the steps in which there were impacts, unless there are no others.
    pub(crate) normal: Vec<f64>,
    /// Mean tangential force, N, alike.
    pub(crate) tangential: Vec<f64>,
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
}

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
    /// What it does in a bucket. An impact between two steps in which it is open is no stretch of sticking.
    pub(crate) fn does(&self, bucket: usize) -> Does {
        match (self.usual[bucket], self.state[bucket]) {
            (ContactState::Open, ContactState::Open) => Does::Open,
            (ContactState::Open, _) => Does::Briefly,
            (_, ContactState::Slip) => Does::Slip,
            _ => Does::Stick,
        }
    }

    /// The largest mean normal force of the stretches of steps without impacts, N.
    pub(crate) fn largest_between_impacts(&self) -> f64 {
        let strikes = |k: usize| self.impacts.get(k).is_some_and(|impulse| *impulse > 0.0);
        let between = self.normal.iter().enumerate().filter(|(k, force)| !strikes(*k) && force.is_finite());
        between.fold(0.0, |most: f64, (_, force)| most.max(*force))
    }

    /// Takes impulses of up to `least` (N·s) for those of forces, not of impacts.
    pub(crate) fn drop_impacts_up_to(&mut self, least: f64) {
        self.impacts.iter_mut().filter(|impulse| **impulse <= least).for_each(|impulse| *impulse = 0.0);
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
            }
            from = to + 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_step_of_the_force_gives_is_no_impact() {
        let of = |impacts: [f64; 4]| ForceCurve {
            normal: vec![4.0, 5.0, 70.0, 0.0],
            tangential: vec![0.0; 4],
            slip: vec![0.0; 4],
            state: vec![ContactState::Stick; 4],
            usual: Vec::new(),
            impacts: impacts.to_vec(),
            alternates: false,
            hides_slip: false,
        };
        // Where all steps had impacts the mean is that of these.
        assert_eq!(of([0.0, 0.0, 7.0, 0.0]).largest_between_impacts(), 5.0);
        let kept = |mut forces: ForceCurve| {
            forces.drop_impacts_up_to(1.0);
            forces.impacts
        };
        assert_eq!(kept(of([0.5, 0.0, 7.0, 1.0])), [0.0, 0.0, 7.0, 0.0]);
        assert!(kept(of([0.5, 0.0, 0.7, 1.0])).is_empty());
    }

    #[test]
    fn slip_of_rounding_is_sticking_and_a_short_slide_is_not() {
        use ContactState::{Open, Slip, Stick};
        let of = |slip: [f64; 6]| {
            let mut forces = ForceCurve {
                normal: vec![1.0; 6],
                tangential: vec![0.0; 6],
                slip: slip.to_vec(),
                state: vec![Slip, Slip, Open, Stick, Slip, Slip],
                usual: Vec::new(),
                impacts: Vec::new(),
                alternates: false,
                hides_slip: false,
            };
            forces.stick_within(1e-9);
            (forces.state, forces.hides_slip)
        };
        assert_eq!(
            of([1e-10, 2e-10, 2e-10, 2e-10, 3e-10, 4e-10]),
            ([Stick, Stick, Open, Stick, Stick, Stick].to_vec(), true)
        );
        assert_eq!(of([0.0, 0.0, 0.0, 0.0, 1e-3, 2e-3]), ([Stick, Stick, Open, Stick, Slip, Slip].to_vec(), true));
        // To and fro it comes back to where it was, but has slipped.
        assert_eq!(of([1e-3, 0.0, 0.0, 0.0, 0.0, 0.0]), ([Slip, Slip, Open, Stick, Stick, Stick].to_vec(), true));
    }
}
