//! Touches that begin and end within a step of the method.

use super::EventDriven;
use super::events::Open;
use super::instant::{Known, Watch};
use crate::gap_cubic::GapCubic;
use crate::moreau_jean_located::rate_at;
use crate::{Model, StepError, Workspace};
use teeter_detect::{Candidate, ContactId};

/// A low of a gap this close to an end of the step, as a part of it, belongs to that end.
const AT_END: f64 = 0.01;

/// A contact that goes beside its surface in a step is looked at this part of the rest after its touch.
const SOON_AFTER: f64 = 0.05;

impl EventDriven {
    /// A shorter step where an open contact goes into its surface and out again within this one of `h` (s).
    pub(super) fn dip(&mut self, model: &Model<2>, h: f64, work: &mut Workspace<2>) -> Result<Option<f64>, StepError> {
        let (nq, nv) = (model.size().q, model.size().v);
        let (q, v) = (&self.rk.end[..nq], &self.rk.end[nq..nq + nv]);
        // What was that near may have gone as far.
        work.detect(model, q, 2.0 * self.near)?;
        for k in 0..work.candidates.len() {
            let candidate = work.candidates[k];
            let Ok(at) = self.open.binary_search_by_key(&candidate.id, |open| open.id) else { continue };
            let Open { gap, rate, is_prescribed, .. } = self.open[at];
            if is_prescribed || rate >= 0.0 || candidate.gap < 0.0 || gap < 0.0 {
                continue;
            }
            let end_rate = rate_at(&mut self.smooth.stage, model, q, &candidate, v)?;
            if end_rate <= 0.0 {
                continue;
            }
            let tolerance = self.located.tolerance(q);
            let [cubic, meet] = GapCubic::new([gap, candidate.gap], [rate, end_rate], h).lows();
            if is_low(cubic, tolerance) {
                return Ok(Some(cubic.0 * h));
            }
            if !is_low(meet, tolerance) {
                continue;
            }
            // On the straight way from start to end: near enough to tell whether two bodies pass through each other.
            self.way.clear();
            self.way.extend(self.y[..nq].iter().zip(q).map(|(start, end)| start + meet.0 * (end - start)));
            work.locate(model, &self.way, &[candidate.id], &mut self.found)?;
            if self.found.first().is_some_and(|found| found.gap < -tolerance) {
                return Ok(Some(meet.0 * h));
            }
        }
        let beside = self.dip_beside(model, h, work)?;
        if beside.is_some() { Ok(beside) } else { self.dip_by_another(model, h, work) }
    }

    /// A shorter step where two bodies touch within this one of `h` (s) by a contact that is open at neither end, or
    /// there at one of them only: as one contact of theirs approaches at the start, and another one leaves at the end.
    fn dip_by_another(&mut self, model: &Model<2>, h: f64, work: &mut Workspace<2>) -> Result<Option<f64>, StepError> {
        let (nq, nv) = (model.size().q, model.size().v);
        let (q, v) = (&self.rk.end[..nq], &self.rk.end[nq..nq + nv]);
        let arrives = |open: &Open| open.may_touch_within(h);
        if !self.open.iter().any(arrives) {
            return Ok(None);
        }
        self.leaving.clear();
        // Those of the step's end still.
        for candidate in &work.candidates {
            let another_arrives = |open: &Open| open.id != candidate.id && arrives(open);
            if candidate.gap < 0.0 || !of_pair(&self.open, candidate.id).iter().any(another_arrives) {
                continue;
            }
            let rate = rate_at(&mut self.smooth.stage, model, q, candidate, v)?;
            if rate > 0.0 {
                self.leaving.push(Open { id: candidate.id, gap: candidate.gap, rate, is_prescribed: false });
            }
        }
        let tolerance = self.located.tolerance(q);
        for end in &self.leaving {
            for start in of_pair(&self.open, end.id).iter().filter(|open| open.id != end.id && arrives(open)) {
                let [_, meet] = GapCubic::new([start.gap, end.gap], [start.rate, end.rate], h).lows();
                if !is_low(meet, tolerance) {
                    continue;
                }
                place_on_way([&self.y, &self.rk.end], nq, nv, meet.0, h, &mut self.way);
                work.detect(model, &self.way, 0.0)?;
                let closes =
                    |touch: &Candidate<2>| touch.id.pair() == end.id.pair() && self.closes(touch, tolerance).is_some();
                if work.candidates.iter().any(closes) {
                    return Ok(Some(meet.0 * h));
                }
            }
        }
        Ok(None)
    }

    /// A shorter step where an open contact goes into its surface and then beside it, so that it isn't among those that
    /// were found last, at the end of this step of `h` (s).
    fn dip_beside(&mut self, model: &Model<2>, h: f64, work: &mut Workspace<2>) -> Result<Option<f64>, StepError> {
        let (nq, nv) = (model.size().q, model.size().v);
        let is_gone = |open: &&Open| work.candidates.binary_search_by_key(&open.id, |candidate| candidate.id).is_err();
        self.ids.clear();
        self.ids.extend(self.open.iter().filter(|open| open.may_touch_within(h)).filter(is_gone).map(|open| open.id));
        if self.ids.is_empty() {
            return Ok(None);
        }
        let (q, v) = (&self.rk.end[..nq], &self.rk.end[nq..nq + nv]);
        work.locate_past_ends(model, q, &self.ids, &mut self.found, &mut self.smooth.rooms)?;
        let tolerance = self.located.tolerance(q);
        let mut shortest = None::<f64>;
        for candidate in self.found.iter().filter(|candidate| candidate.gap < -tolerance) {
            let Ok(at) = self.open.binary_search_by_key(&candidate.id, |open| open.id) else { continue };
            let start = Known { tau: 0.0, value: self.open[at].gap, rate: self.open[at].rate };
            let rate = rate_at(&mut self.smooth.stage, model, q, candidate, v)?;
            let end = Known { tau: h, value: candidate.gap, rate };
            let touches = Watch::closing(candidate.id, 0.0, [start, end], tolerance).cubic_zero();
            // If it is beside its surface there too, steps end ever closer to where it would have touched.
            let shorter = touches + SOON_AFTER * (h - touches);
            shortest = Some(shortest.map_or(shorter, |shortest| shortest.min(shorter)));
        }
        Ok(shortest)
    }
}

/// Whether a gap is below 0 where it is lowest, at a part of the step, and that is within the step.
fn is_low((s, low): (f64, f64), tolerance: f64) -> bool {
    s > AT_END && s < 1.0 - AT_END && low < -tolerance
}

/// Of contacts in order of identity those of the pair of this one.
fn of_pair(open: &[Open], id: ContactId) -> &[Open] {
    let from = open.partition_point(|open| open.id.pair() < id.pair());
    let count = open[from..].partition_point(|open| open.id.pair() == id.pair());
    &open[from..from + count]
}

/// The coordinates at the part `s` of a step of `h` (s) with this state at its ends: by the cubics through coordinates and velocities
/// where these belong to each other, else on the straight way.
fn place_on_way([start, end]: [&[f64]; 2], nq: usize, nv: usize, s: f64, h: f64, way: &mut Vec<f64>) {
    way.clear();
    way.extend((0..nq).map(|k| {
        let mean = end[k] - start[k];
        let bend = match nq == nv {
            true => (1.0 - s) * (h * start[nq + k] - mean) - s * (h * end[nq + k] - mean),
            false => 0.0,
        };
        start[k] + s * mean + s * (1.0 - s) * bend
    }));
}
