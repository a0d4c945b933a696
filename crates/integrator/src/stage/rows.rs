//! The Jacobian rows of a stage's contacts.

use crate::small::add_scaled;
use crate::subsystem::Span;
use crate::{Mismatch, Model, PartRows, Rows, Vector};
use teeter_detect::Candidate;

/// Rows of contacts, one after the other, side 1 with a minus: u = v_0 − v_1.
#[derive(Clone, Debug, Default)]
pub(crate) struct ContactRows<const D: usize> {
    pub(crate) spans: Vec<[Span; 2]>,
    /// How much of the arena is taken.
    taken: usize,
    /// Columns within their subsystems, and among the model's velocities.
    columns: Vec<usize>,
    global: Vec<usize>,
    values: Vec<Vector<D>>,
    /// Whether a contact may act on a subsystem, up to the last that any has acted on.
    acts_on: Vec<bool>,
}

impl<const D: usize> ContactRows<D> {
    pub(crate) fn reserve(&mut self, contacts: usize, row: usize, parts: usize) {
        self.acts_on.resize(parts, false);
        let more = |len: usize, wanted: usize| wanted.saturating_sub(len);
        self.spans.reserve(more(self.spans.len(), contacts));
        let entries = 2 * contacts * row;
        self.columns.reserve(more(self.columns.len(), entries));
        self.global.reserve(more(self.global.len(), entries));
        self.values.reserve(more(self.values.len(), entries));
    }

    pub(crate) fn clear(&mut self) {
        self.spans.clear();
        self.acts_on.fill(false);
        self.taken = 0;
    }

    /// Whether a contact may act on a subsystem: one that was dropped again may have.
    #[inline]
    pub(crate) fn may_act_on(&self, part: usize) -> bool {
        self.acts_on.get(part).is_some_and(|acts| *acts)
    }

    /// Where rows are free: past those of all contacts, as rows that were taken anew may lie behind the last contact's.
    fn end(&self) -> usize {
        self.taken
    }

    /// Adds the rows of a candidate at coordinates `q`; leaves nothing behind on an error.
    pub(crate) fn push(&mut self, model: &Model<D>, q: &[f64], candidate: &Candidate<D>) -> Result<(), Mismatch> {
        let spans = self.fill(model, q, candidate, self.end())?;
        self.taken = spans[1].start + spans[1].len;
        self.spans.push(spans);
        Ok(())
    }

    /// Takes the rows of contact `i` anew, of the same bodies, at other coordinates.
    pub(crate) fn renew(
        &mut self,
        model: &Model<D>,
        q: &[f64],
        candidate: &Candidate<D>,
        i: usize,
    ) -> Result<(), Mismatch> {
        let [a, b] = self.spans[i];
        let (start, room) = (a.start.min(b.start), a.len + b.len);
        // Into a place of their own first: who moves has as many columns in any frame, but that is the subsystem's word only.
        let end = self.end();
        let new = self.fill(model, q, candidate, end)?;
        let len = new[0].len + new[1].len;
        if len > room {
            self.taken = new[1].start + new[1].len;
            self.spans[i] = new;
            return Ok(());
        }
        self.columns.copy_within(end..end + len, start);
        self.global.copy_within(end..end + len, start);
        self.values.copy_within(end..end + len, start);
        self.spans[i] = new.map(|span| Span { start: span.start - end + start, ..span });
        Ok(())
    }

    #[inline]
    fn fill(
        &mut self,
        model: &Model<D>,
        q: &[f64],
        candidate: &Candidate<D>,
        mut start: usize,
    ) -> Result<[Span; 2], Mismatch> {
        let mut spans = [Span { part: 0, start, len: 0 }; 2];
        for (side, anchor) in candidate.sides.iter().enumerate() {
            let Some((index, part, body)) = model.owner(anchor.body) else {
                return Err(Mismatch::Body { body: anchor.body, bodies: model.size().bodies });
            };
            spans[side].start = start;
            if part.row == 0 {
                continue;
            }
            // Never shorter again, so that a step with known contacts has no entries to make.
            if self.values.len() < start + part.row {
                self.columns.resize(start + part.row, 0);
                self.global.resize(start + part.row, 0);
                self.values.resize(start + part.row, Vector::zeros());
            }
            let room = start..start + part.row;
            let mut rows = Rows { columns: &mut self.columns[room.clone()], values: &mut self.values[room] };
            let q = &q[part.q.clone()];
            let len = part.system.rows(body, q, &anchor.point, &candidate.frame, &mut rows).min(part.row);
            let taken = start..start + len;
            let (mut last, sign) = (0, if side == 0 { 1.0 } else { -1.0 });
            let entries = self.global[taken.clone()].iter_mut().zip(&self.columns[taken.clone()]);
            for ((global, &column), value) in entries.zip(&mut self.values[taken]) {
                last = last.max(column);
                *global = part.v.start + column;
                value.data.0[0].iter_mut().for_each(|x| *x *= sign);
            }
            if last >= part.v.len() && len > 0 {
                return Err(Mismatch::Column { body: anchor.body, column: last, velocities: part.v.len() });
            }
            spans[side] = Span { part: index, start, len };
            start += len;
            if self.acts_on.len() <= index {
                self.acts_on.resize(model.parts().len(), false);
            }
            self.acts_on[index] = true;
        }
        Ok(spans)
    }

    /// Whether all that could part the sides of the last rows is prescribed: no impulse changes their normal velocity.
    #[inline]
    pub(crate) fn last_is_prescribed(&self, model: &Model<D>) -> bool {
        let fixed = self.spans.last().is_some_and(|sides| sides.iter().all(|side| side.len == 0));
        fixed || (model.is_driven() && self.last_has_prescribed_sides(model))
    }

    fn last_has_prescribed_sides(&self, model: &Model<D>) -> bool {
        let Some(sides) = self.spans.last() else { return false };
        sides.iter().filter(|side| side.len > 0).all(|side| {
            let part = &model.parts()[side.part];
            let driven = &part.traits.driven;
            if driven.is_empty() {
                return false;
            }
            let range = side.start..side.start + side.len;
            self.columns[range.clone()]
                .iter()
                .zip(&self.values[range])
                .all(|(c, value)| value[0] == 0.0 || driven.contains(c))
        })
    }

    pub(crate) fn pop(&mut self) {
        if let Some([first, _]) = self.spans.pop() {
            self.taken = first.start;
        }
    }

    /// The entries of contact `i`, with their columns among the model's velocities.
    #[inline]
    pub(crate) fn entries(&self, i: usize) -> impl Iterator<Item = (usize, &Vector<D>)> {
        // The sides of a contact lie beside each other.
        let [a, b] = self.spans[i];
        let range = a.start..a.start + a.len + b.len;
        self.global[range.clone()].iter().copied().zip(&self.values[range])
    }

    /// The columns of one side of a contact, among the model's velocities.
    pub(crate) fn columns_of(&self, side: &Span) -> impl Iterator<Item = usize> {
        self.global[side.start..side.start + side.len].iter().copied()
    }

    /// Adds a x to the normal row of contact `i`, once where both sides have the same column.
    pub(crate) fn add_to_normal(&mut self, i: usize, a: f64, x: &[f64]) {
        let [first, second] = self.spans[i];
        let range = first.start..first.start + first.len + second.len;
        let columns = &self.global[range.clone()];
        for (k, value) in self.values[range].iter_mut().enumerate() {
            if !columns[..k].contains(&columns[k]) {
                value[0] += a * x[columns[k]];
            }
        }
    }

    /// J_i v.
    #[inline]
    pub(crate) fn velocity(&self, i: usize, v: &[f64]) -> Vector<D> {
        let mut u = Vector::zeros();
        for (column, value) in self.entries(i) {
            add_scaled(&mut u, value, v[column]);
        }
        u
    }

    /// J_i v of two velocities.
    #[inline]
    pub(crate) fn velocities(&self, i: usize, v: [&[f64]; 2]) -> [Vector<D>; 2] {
        let mut u = [Vector::zeros(); 2];
        for (column, value) in self.entries(i) {
            for k in 0..2 {
                add_scaled(&mut u[k], value, v[k][column]);
            }
        }
        u
    }

    /// The rows that act on one part.
    pub(crate) fn of_part(&self, part: usize) -> PartRows<'_, D> {
        self.of_island(part, &self.spans)
    }

    /// The rows of some of the contacts, given by their spans, that act on one part.
    pub(crate) fn of_island<'a>(&'a self, part: usize, spans: &'a [[Span; 2]]) -> PartRows<'a, D> {
        PartRows { part, spans, columns: &self.columns, values: &self.values }
    }
}
