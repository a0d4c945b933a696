//! How a round block has gone along what holds it from below: rolling, or skidding while the point that touches slides (`docs/verdict.md`).

use super::sliding::Slides;
use super::{FLAT, Fates, ROLLED, Seen, Watch, Watched};
use serde::{Deserialize, Serialize};
use teeter_integrator::State;
use teeter_scenario::simulation::Layout;

/// A round block rolls while the point that touches slips by no more than this part of the centre's way: then what it turns says how far it went.
const SLIPS: f64 = 0.05;

/// The way of a round block along what holds it from below, from the start of the run, to the right positive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Rolling {
    /// Its centre's way while it rolled.
    rolled: Slides,
    /// Its centre's way while it skidded.
    skidded: Slides,
    /// By how much it turned while it rolled, to the left positive, rad.
    turned: f64,
    /// Whether it rolled when something last held it.
    pub(super) rolls: bool,
}

/// How far a round block went.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rolled {
    /// How far it rolled, and to and fro in all, m; none of one that rolled by less than is told.
    pub(crate) rolled: Option<[f64; 2]>,
    /// By how much it turned as it did, rad.
    pub(crate) turned: f64,
    /// How far it skidded, m; none of one that did by less than is told.
    pub(crate) skidded: Option<f64>,
    /// How far it is from its start along what carries it, m, where that doesn't follow from the rest.
    pub(crate) moved: Option<f64>,
    /// By how much it has turned since, counter-clockwise, rad, where that doesn't follow from the rest.
    pub(crate) turned_in_all: Option<f64>,
}

impl Fates {
    /// Takes in how far round blocks rolled and skidded in a step that began at `before` (s), after how the points that touch slipped in it.
    pub(super) fn roll(&mut self, watch: &Watch, layout: &Layout, before: f64, state: &State) {
        for (number, (seen, watched)) in self.blocks.iter_mut().zip(&watch.blocks).enumerate() {
            let Some(slip) = seen.slipped.take().filter(|_| watched.is_round) else { continue };
            let lasts = state.t - before;
            let spin = state.v[layout.blocks[number].range.start + 2] - watched.velocity(layout, number, state)[2];
            let turn = seen.turn - spin * lasts;
            // It turns counter-clockwise as it goes to the left.
            let way = slip - watched.reach * turn;
            let (least, creeps) = (ROLLED * watched.reach, FLAT * watched.still_time * watched.still_speed);
            // No faster than what is still it doesn't slip.
            let rolling = &mut seen.rolling;
            rolling.rolls = slip.abs() <= (SLIPS * way.abs()).max(watched.still_speed * lasts);
            if rolling.rolls {
                rolling.turned += turn;
                rolling.rolled.go(way, state.t, least, creeps);
            } else {
                rolling.skidded.go(way, state.t, least, creeps);
            }
        }
    }
}

impl Rolling {
    /// How far a round block went since it had gone `before`; `None` by less than is told.
    pub(super) fn since(&self, before: &Self, watched: &Watched) -> Option<Rolled> {
        let least = ROLLED * watched.reach;
        let since = |now: &Slides, before: &Slides| [now.at() - before.at(), now.in_all() - before.in_all()];
        let rolled = Some(since(&self.rolled, &before.rolled)).filter(|[_, in_all]| *in_all >= least);
        let skidded = Some(since(&self.skidded, &before.skidded)).filter(|[_, in_all]| *in_all >= least);
        (rolled.is_some() || skidded.is_some()).then(|| Rolled {
            rolled,
            turned: self.turned - before.turned,
            skidded: skidded.map(|[at, _]| at),
            moved: None,
            turned_in_all: None,
        })
    }

    /// Whether it has never gone by as much as is told.
    pub(super) fn is_there(&self, watched: &Watched) -> bool {
        self.rolled.most().max(self.skidded.most()) < ROLLED * watched.reach
    }

    /// How far a round block went that is `moved` (m) from its start, and has turned by so much since, rad; `None` by less than is told.
    pub(super) fn told(&self, watched: &Watched, moved: f64, turned_in_all: f64) -> Option<Rolled> {
        let least = ROLLED * watched.reach;
        let is_told = |ways: &&Slides| ways.most() >= least;
        let rolled = Some(&self.rolled).filter(is_told).map(|ways| [ways.at(), ways.in_all()]);
        let skidded = Some(&self.skidded).filter(is_told).map(Slides::at);
        // Its centre cuts the corners of a profile.
        let near = if watched.carrier.is_terrain() { watched.reach } else { least };
        let (way, turned) = (rolled.map_or(0.0, |[at, _]| at), if rolled.is_some() { self.turned } else { 0.0 });
        let follows = skidded.unwrap_or_default() == 0.0 || rolled.is_none();
        let follows = follows && (moved - way - skidded.unwrap_or_default()).abs() < near;
        (rolled.is_some() || skidded.is_some()).then(|| Rolled {
            rolled,
            turned,
            skidded,
            moved: (!follows).then_some(moved),
            turned_in_all: Some(turned_in_all).filter(|all| (all - turned).abs() >= ROLLED),
        })
    }
}

impl Seen {
    /// Whether a round one has lately gone along what carries it, or slipped on it, by more than creeps at the time `t`, s.
    pub(super) fn goes_along(&self, watched: &Watched, t: f64) -> bool {
        let lately = |ways: &Slides| ways.went().is_some_and(|last| t - last < FLAT * watched.still_time);
        lately(&self.rolling.rolled) || lately(&self.slides)
    }
}
