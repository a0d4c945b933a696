//! What became of a block, and its numbers, as `summary.json` has them (`docs/verdict.md`).

use super::rolling::Rolled;
use super::{Going, Side, Way};
use serde::Serialize;

/// What became of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Fate {
    /// It lies on another side, or falls to it.
    Overturned,
    /// Its mass centre went past an end of the beam that carried it.
    Left,
    /// It is below everything that could hold it.
    Sunk,
    /// It fell from its place among other blocks that held it.
    Fell,
    /// It came to rest where it stood.
    Rests,
    /// It slid, and may have come to rest.
    Slid,
    /// It rocks on.
    Rocks,
    /// It moves in another way, such as a bouncing or a rolling block.
    Moves,
}

/// What became of a block, with its numbers; those that have no meaning for it are null.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BodyVerdict {
    /// The block.
    pub body: String,
    /// What became of it.
    pub what: Fate,
    /// When, s: overturned, left, sunk or fell, came to rest; of a block that rocks on the last peak; null for others.
    pub t: Option<f64>,
    /// To which side it overturned or left its beam.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub way: Option<Way>,
    /// When it had fallen from its place among other blocks, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fell_at: Option<f64>,
    /// When it passed the point of no return for good, s.
    pub overturned_at: Option<f64>,
    /// From when on it rests, s.
    pub rests_from: Option<f64>,
    /// On which side it rests, of one that does and doesn't lean on something.
    pub lies_on: Option<Side>,
    /// On which side it stands or rocks, of one that doesn't rest, but stays where it is.
    #[serde(skip)]
    pub(crate) stands_on: Option<Side>,
    /// How far it slid from the start to the end, or to when it overturned, m, to the right positive: its points, while they press on what holds it from
    /// below.
    pub slid: Option<f64>,
    /// The same, to and fro, in all.
    pub slid_in_all: Option<f64>,
    /// How far it is along what carries it from where it stood, m, to the right positive, by slides, flights, and hops.
    pub displaced: Option<f64>,
    /// Whether it slid by as much as is told.
    #[serde(skip)]
    pub(crate) has_slid: bool,
    /// How far it is from its start along what carries it, m, of one that got there by hops and flights, too: the middle of its base, or the mass
    /// centre of one that began in flight.
    #[serde(skip)]
    pub(crate) elsewhere: Option<f64>,
    /// How far its mass centre is from where it was at the start of the run, along what carries it, m, where that is told of what bounces.
    #[serde(skip)]
    pub(crate) flown: Option<f64>,
    /// Whether it was in the air at the start of the run.
    #[serde(skip)]
    pub(crate) began_in_flight: bool,
    /// How far it has rolled and skidded on what holds it; of a round one.
    #[serde(skip)]
    pub(crate) rolled: Option<Rolled>,
    /// How far it has since it fell from its place or left its beam; `rolled` ends there.
    #[serde(skip)]
    pub(crate) rolled_since: Option<Rolled>,
    /// Whether it still rolls or slides below at the end.
    #[serde(skip)]
    pub(crate) goes_below: Option<Going>,
    /// The farthest that it slid, of one that slid back from there, m; to the right positive. Of one that has then
    /// slid farther past its start, where it turned.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub farthest: Option<f64>,
    /// To which side that is, and the farthest, in words.
    #[serde(skip)]
    pub(crate) slid_to: Option<&'static str>,
    #[serde(skip)]
    pub(crate) farthest_to: Option<&'static str>,
    /// The farthest to the left and to the right of its start that it was, m, of one that slid to one side, back, and on again: by its slides alone
    /// where hops and flights took it elsewhere.
    #[serde(skip)]
    pub(crate) to_and_fro: Option<[f64; 2]>,
    /// Whether what is below it moves on as prescribed.
    #[serde(skip)]
    pub(crate) is_driven: bool,
    /// Whether it has slid, and stands by now, though it isn't still.
    #[serde(skip)]
    pub(crate) stopped: bool,
    /// How fast it moves at the end relative to what carries it, m/s; of one that slides on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    /// The largest |φ|/α.
    pub max_phi_over_alpha: Option<f64>,
    /// The last peak of its rocking, rad; of one that did not cross zero yet the largest angle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub last_peak: Option<f64>,
    /// Against what its peaks count, in words; none where that is the horizontal.
    #[serde(skip)]
    pub(crate) against: Option<String>,
    /// Since when it is still, of one that is so at the end, but not for long enough to rest, s.
    #[serde(skip)]
    pub(crate) still_from: Option<f64>,
    /// Of one that rocked lately: whether it stands on its side by then, and is still.
    #[serde(skip)]
    pub(crate) stopped_swinging: bool,
    /// Whether it ever came down from a flight.
    #[serde(skip)]
    pub(crate) has_landed: bool,
    /// When the run began, s: 0, but for one from the state of another.
    #[serde(skip)]
    pub(crate) start: f64,
    /// From when on it stands, s: the start, or when it settled; none of what flies or tumbles on.
    #[serde(skip)]
    pub(crate) stands_from: Option<f64>,
    /// Of a block that rocks and has not been upright yet, nor turned back: its angle at the end, rad.
    #[serde(skip)]
    pub(crate) on_its_way: Option<f64>,
    /// To which side it still turns, of one that does and never was farther than at the end.
    #[serde(skip)]
    pub(crate) tips: Option<Way>,
    /// Of a block that rests, but lies on none of its sides: its angle at the end, rad.
    #[serde(skip)]
    pub(crate) leans_at: Option<f64>,
    /// Of a block that began in flight, turned over and settled: by how much it has turned at the end, rad.
    #[serde(skip)]
    pub(crate) tumbled: Option<f64>,
    /// Of a block that overturned or left its beam: by how much it has turned at the end, rad, if that is more than to the next side.
    #[serde(skip)]
    pub(crate) turned: Option<f64>,
    /// Of a block that rests: whether what carries it moves at the end.
    #[serde(skip)]
    pub(crate) is_carried: bool,
    /// How it moves at the end, of one that does and has no other fate.
    #[serde(skip)]
    pub(crate) going: Option<Going>,
    /// Of one that trembles or chatters where it stands: when it last swung, s, if it rocked.
    #[serde(skip)]
    pub(crate) stopped_rocking: Option<f64>,
    /// Of one that is shaken where it stands, or hops or bounces there: what it stands on, and in the end on other blocks, in words, if that moves at the end.
    #[serde(skip)]
    pub(crate) on_what_moves: Option<&'static str>,
    /// Since when it, and so what carries it, is at rest over what that stands on, s.
    #[serde(skip)]
    pub(crate) unmoved_from: Option<f64>,
    /// The beam on which it stood throughout, of one that has only moved with it.
    #[serde(skip)]
    pub(crate) stood_on: Option<String>,
    /// Of a block that left its beam: which.
    #[serde(skip)]
    pub(crate) left_beam: Option<String>,
    /// Of a block that overturned: past which end of the beam that carried it, directly or by others, it has fallen since, and which beam that is.
    #[serde(skip)]
    pub(crate) fell_off: Option<(Way, String)>,
    /// Of a block that overturned to one side, but whose mass centre is on the other side of its start at the end: how far along what carries it, m.
    #[serde(skip)]
    pub(crate) aside: Option<f64>,
    /// Whether it still touches the beam that it left.
    #[serde(skip)]
    pub(crate) touches_beam: bool,
    /// To which side its mass centre was past what it stands on from the start, as that of a plank that reaches too far over an edge: nothing of its
    /// own brings it back, however little it has turned.
    #[serde(skip)]
    pub(crate) past_edge: Option<Way>,
    /// Of a block that overturned as one with others, a column: the lowest of them.
    #[serde(skip)]
    pub(crate) overturned_with: Option<String>,
    /// Of a block that turns as one with those below it: the lowest of them, on whose base they rock.
    #[serde(skip)]
    pub(crate) turns_with: Option<String>,
    /// Whether these are a column: one block on the other, none slid.
    #[serde(skip)]
    pub(crate) in_column: bool,
    /// Of the lowest block of a column: its largest φ/α, with the α of all of them together.
    #[serde(rename = "column_phi_over_alpha", skip_serializing_if = "Option::is_none")]
    pub column: Option<f64>,
}

impl BodyVerdict {
    /// Whether it has only moved with the beam on which it stood, which isn't at rest itself since the block is.
    pub(crate) fn moves_with_beam(&self) -> bool {
        self.stood_on.is_some() && self.unmoved_from != self.rests_from
    }

    /// Whether it has rested from the start of the run on.
    pub(crate) fn rests_throughout(&self) -> bool {
        self.rests_from == Some(self.start)
    }

    /// The side on which it rests, stands, or rocks, if that isn't its base.
    pub(crate) fn other_side(&self) -> Option<&Side> {
        self.lies_on.as_ref().or(self.stands_on.as_ref()).filter(|side| **side != Side::Base)
    }

    /// Whether it stands where it is after it moved: it rests, or trembles, or has been still for a while.
    pub(crate) fn stays(&self) -> bool {
        match self.what {
            Fate::Rests => !self.rests_throughout(),
            Fate::Moves => self.tips.is_none() && self.going.map_or(self.still_from > Some(self.start), Going::stays),
            _ => false,
        }
    }

    /// From when on it couldn't turn over any more, s, of one that began in flight and settled: it may bounce on for a while.
    pub(crate) fn settled_at(&self) -> Option<f64> {
        self.stands_from.filter(|t| *t > self.start)
    }

    /// To which side it overturned or left its beam, in words; in which sense it turned where it went to the other side meanwhile.
    pub(crate) fn way_over(&self) -> String {
        let side = |way: Way| match self.aside {
            Some(_) if way == Way::Left => "counter-clockwise".to_owned(),
            Some(_) => "clockwise".to_owned(),
            None => format!("to the {}", way.word()),
        };
        self.way.map_or_else(String::new, side)
    }

    /// Its largest φ/α as it is told: of the lowest block of a column that of all of it; none where nothing of its own brings it back.
    pub(crate) fn share(&self) -> Option<f64> {
        self.column.or(self.max_phi_over_alpha).filter(|_| self.past_edge.is_none())
    }
}
