//! How a block has slid along what carries it since it began to stand (`docs/verdict.md`).

use serde::{Deserialize, Serialize};

/// What has slid on for this many times its longest way to or fro goes its own way.
const USUAL: f64 = 2.0;

/// The way that a block has slid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Slides {
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
    /// It is now at a place, m, to the right of its start; `least` (m) is how far it has to go to be told.
    pub(super) fn go_to(&mut self, at: f64, least: f64) {
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

    /// Whether it slides to and fro: it slid to one side, back, and on again, and since then not farther than is usual for it, to where it is (m).
    pub(super) fn is_to_and_fro(&self, at: f64) -> bool {
        self.turns >= 2 && (at - self.turned_at).abs() <= USUAL * self.longest
    }

    /// The farthest to the left and to the right of its start that it has been, m.
    pub(super) fn reached(&self) -> [f64; 2] {
        self.reached
    }

    /// The farthest from its start that it has been, m.
    pub(super) fn most(&self) -> f64 {
        self.reached[1].max(-self.reached[0])
    }

    /// Where it turned, the farther of two, if it has slid back by more than `least` (m) from there to where it is, `slid` (m).
    pub(super) fn farthest(&self, slid: f64, least: f64) -> Option<f64> {
        let back = |reached: &f64| (reached - slid).abs();
        let farther = self.reached.into_iter().filter(|reached| reached.abs() > least && back(reached) > least);
        farther.max_by(|a, b| a.abs().total_cmp(&b.abs()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn along(places: &[f64]) -> Slides {
        let mut slides = Slides::default();
        places.iter().for_each(|at| slides.go_to(*at, 1.0));
        slides
    }

    #[test]
    fn it_turns_round_where_it_slides_back_by_what_is_told() {
        for (places, turns, reached) in [
            (vec![0.0, 3.0, 7.0, 6.1, 9.0], 0, [0.0, 9.0]),
            (vec![0.0, -3.0, -0.5, -1.4], 1, [-3.0, 0.0]),
            (vec![0.0, -3.0, -0.5, -1.6, -3.1, -0.4], 3, [-3.1, 0.0]),
            (vec![0.0, 0.9, -0.05, 0.9, -0.05], 0, [-0.05, 0.9]),
        ] {
            let slides = along(&places);
            assert_eq!((slides.turns, slides.reached), (turns, reached), "{places:?}");
        }
        assert!(along(&[2.0, 0.5, 2.0]).is_to_and_fro(2.0) && !along(&[2.0, -9.0]).is_to_and_fro(-9.0));
        assert!(!along(&[2.0, 0.5, 2.0, 9.0]).is_to_and_fro(9.0), "it goes on to the right");
    }

    #[test]
    fn the_farther_of_two_turns_is_told_if_it_came_back_from_there() {
        assert_eq!(along(&[-3.0, 4.0, 1.0]).farthest(1.0, 1.0), Some(4.0));
        assert_eq!(along(&[-3.0, 4.0]).farthest(4.0, 1.0), Some(-3.0));
        assert_eq!(along(&[4.0, 3.5]).farthest(3.5, 1.0), None);
    }
}
