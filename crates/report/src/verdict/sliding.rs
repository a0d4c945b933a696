//! How a block has slid: its points while they press on what holds it from below (`docs/verdict.md`).

use super::watch::Watch;
use super::{FLAT, Fates, SLID};
use crate::contacts;
use serde::{Deserialize, Serialize};
use teeter_integrator::StepReport;

/// What has slid on for this many times its longest way to or fro goes its own way.
const USUAL: f64 = 2.0;

/// The way that a block has slid, or a round one rolled or skidded, from the start of the run, to the right positive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Slides {
    /// How far it is by all of its slides, m.
    at: f64,
    /// How far it has slid in all, to and fro, m.
    in_all: f64,
    /// When, s, and where, m, it last had slid on by more than what is still creeps in the time after which it has stopped.
    went: Option<(f64, f64)>,
    /// The farthest from its start that it has been to the left and to the right, m.
    reached: [f64; 2],
    /// The farthest to the left and to the right since it last turned round, m.
    since_turn: [f64; 2],
    /// The direction in which it last slid by more than is told: −1, 1; 0 before.
    sense: i8,
    /// How often it has turned round, by more than is told.
    turns: u32,
    /// Where it last did, or its start, m.
    turned_at: f64,
    /// The longest way from one such place to the next, m.
    longest: f64,
}

impl Slides {
    /// It slides by so much, m, up to the time `t` (s); `least` (m) is how far it has to go to be told, `creeps` (m) what doesn't count as sliding on.
    pub(super) fn go(&mut self, by: f64, t: f64, least: f64, creeps: f64) {
        self.at += by;
        self.in_all += by.abs();
        let at = self.at;
        self.went = self.went.filter(|(_, went)| (at - went).abs() < creeps).or(Some((t, at)));
        for [left, right] in [&mut self.reached, &mut self.since_turn] {
            (*left, *right) = (left.min(at), right.max(at));
        }
        let [left, right] = self.since_turn;
        let sense = match (at - left >= least, right - at >= least) {
            (true, _) if self.sense != 1 => 1,
            (_, true) if self.sense != -1 => -1,
            _ => return,
        };
        if self.sense != 0 {
            let turned_at = if sense > 0 { left } else { right };
            self.longest = self.longest.max((turned_at - self.turned_at).abs());
            (self.turned_at, self.turns) = (turned_at, self.turns + 1);
        }
        (self.sense, self.since_turn) = (sense, [at; 2]);
    }

    /// How far it is by all of its slides, m.
    pub(super) fn at(&self) -> f64 {
        self.at
    }

    /// How far it has slid in all, to and fro, m.
    pub(super) fn in_all(&self) -> f64 {
        self.in_all
    }

    /// When it last slid on, s; `None` before it touched anything.
    pub(super) fn went(&self) -> Option<f64> {
        self.went.map(|(t, _)| t)
    }

    /// Whether it slides to and fro: it slid to one side, back, and on again, and since then not farther than is usual for it.
    pub(super) fn is_to_and_fro(&self) -> bool {
        self.turns >= 2 && (self.at - self.turned_at).abs() <= USUAL * self.longest
    }

    /// The farthest to the left and to the right of its start that it has been, m.
    pub(super) fn reached(&self) -> [f64; 2] {
        self.reached
    }

    /// The farthest from its start that it has been, m.
    pub(super) fn most(&self) -> f64 {
        self.reached[1].max(-self.reached[0])
    }

    /// Where it turned, the farther of two, if it has slid back by more than `least` (m) from there.
    pub(super) fn farthest(&self, least: f64) -> Option<f64> {
        let back = |reached: &f64| (reached - self.at).abs();
        let farther = self.reached.into_iter().filter(|reached| reached.abs() > least && back(reached) > least);
        farther.max_by(|a, b| a.abs().total_cmp(&b.abs()))
    }
}

impl Fates {
    /// Takes in how blocks slide in a step: of the contacts that press, as `contacts.csv` has their slip, those that hold a block from below count,
    /// each by its part of what they hold.
    pub(super) fn slide(&mut self, watch: &Watch, step: &StepReport<'_, 2>) {
        for part in step.active().filter(|part| part.duration > 0.0) {
            for contact in part.contacts.iter().filter(|contact| contact.p[0] > 0.0) {
                let slip = contacts::slip(contact, part.duration, part.balance);
                let [normal, along] = [0, 1].map(|row| contact.frame.row(row));
                for (side, sign) in contact.sides.iter().zip([1.0, -1.0]) {
                    let number = side.body.0 as usize;
                    let (Some(seen), Some(watched)) = (self.blocks.get_mut(number), watch.blocks.get(number)) else {
                        continue;
                    };
                    let [x, y] = watched.up;
                    let holds = contact.p[0] * sign * (normal[0] * x + normal[1] * y);
                    if holds > 0.0 {
                        let to_the_right = if along[0] * y - along[1] * x < 0.0 { -sign } else { sign };
                        let [held, slid] = &mut seen.sliding;
                        (*held, *slid) = (*held + holds, *slid + holds * to_the_right * slip);
                    }
                }
            }
            for (seen, watched) in self.blocks.iter_mut().zip(&watch.blocks).filter(|(seen, _)| seen.sliding[0] > 0.0) {
                let [held, slid] = std::mem::take(&mut seen.sliding);
                let creeps = FLAT * watched.still_time * watched.still_speed;
                seen.slides.go(slid / held, part.end, SLID * watched.base(), creeps);
                *seen.slipped.get_or_insert(0.0) += slid / held;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn along(places: &[f64]) -> Slides {
        let mut slides = Slides::default();
        places.iter().for_each(|at| slides.go(at - slides.at, 0.0, 1.0, 0.0));
        slides
    }

    #[test]
    fn it_turns_round_where_it_slides_back_by_what_is_told() {
        for (places, turns, reached) in [
            (vec![0.0, 3.0, 7.0, 6.125, 9.0], 0, [0.0, 9.0]),
            (vec![0.0, -3.0, -0.5, -1.375], 1, [-3.0, 0.0]),
            (vec![0.0, -3.0, -0.5, -1.625, -3.125, -0.375], 3, [-3.125, 0.0]),
            (vec![0.0, 0.875, -0.0625, 0.875, -0.0625], 0, [-0.0625, 0.875]),
        ] {
            let slides = along(&places);
            assert_eq!((slides.turns, slides.reached), (turns, reached), "{places:?}");
        }
        assert!(along(&[2.0, 0.5, 2.0]).is_to_and_fro() && !along(&[2.0, -9.0]).is_to_and_fro());
        assert!(!along(&[2.0, 0.5, 2.0, 9.0]).is_to_and_fro(), "it goes on to the right");
    }

    #[test]
    fn the_farther_of_two_turns_is_told_if_it_came_back_from_there() {
        assert_eq!(along(&[-3.0, 4.0, 1.0]).farthest(1.0), Some(4.0));
        assert_eq!(along(&[-3.0, 4.0]).farthest(1.0), Some(-3.0));
        assert_eq!(along(&[4.0, 3.5]).farthest(1.0), None);
    }
}
