//! The Jacobian rows of a stage's contacts.

use crate::compliance::Span;
use crate::small::add_scaled;
use crate::{Mismatch, Model, PartRows, Rows, Vector};
use teeter_detect::Candidate;

/// Rows of contacts, one after the other, side 1 with a minus: u = v_0 − v_1.
#[derive(Clone, Debug, Default)]
pub(crate) struct ContactRows<const D: usize> {
    pub(crate) spans: Vec<[Span; 2]>,
    /// How much of the arena is taken.
    taken: usize,
    /// Columns within their subsystems.
    columns: Vec<usize>,
    values: Vec<Vector<D>>,
    /// The round in which a contact last acted on each subsystem, up to the last that any has acted
    /// on.
    acted_on: Vec<u64>,
    /// Counts up where all contacts are dropped.
    round: u64,
}

impl<const D: usize> ContactRows<D> {
    pub(crate) fn reserve(&mut self, contacts: usize, row: usize, parts: usize) {
        self.acted_on.resize(parts, 0);
        let more = |len: usize, wanted: usize| wanted.saturating_sub(len);
        self.spans.reserve(more(self.spans.len(), contacts));
        let entries = 2 * contacts * row;
        self.columns.reserve(more(self.columns.len(), entries));
        self.values.reserve(more(self.values.len(), entries));
    }

    pub(crate) fn clear(&mut self) {
        self.spans.clear();
        self.round += 1;
        self.taken = 0;
    }

    /// Whether a contact may act on a subsystem: one that was dropped again may have.
    #[inline]
    pub(crate) fn may_act_on(&self, part: usize) -> bool {
        self.acted_on.get(part).is_some_and(|round| *round > self.round)
    }

    /// Where rows are free: past those of all contacts, as rows that were taken anew may lie behind the last contact's.
    fn end(&self) -> usize {
        self.taken
    }

    /// Adds the rows of a candidate at coordinates `q`; leaves nothing behind on an error.
    #[inline(always)]
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
        self.values.copy_within(end..end + len, start);
        self.spans[i] = new.map(|span| Span { start: span.start - end + start, ..span });
        Ok(())
    }

    /// Writes the rows of both sides into the arena from `start` on.
    #[inline(always)]
    fn fill(
        &mut self,
        model: &Model<D>,
        q: &[f64],
        candidate: &Candidate<D>,
        start: usize,
    ) -> Result<[Span; 2], Mismatch> {
        let first = self.fill_side(model, q, candidate, 0, start)?;
        let second = self.fill_side(model, q, candidate, 1, first.range().end)?;
        Ok([first, second])
    }

    #[inline(always)]
    fn fill_side(
        &mut self,
        model: &Model<D>,
        q: &[f64],
        candidate: &Candidate<D>,
        side: usize,
        start: usize,
    ) -> Result<Span, Mismatch> {
        let anchor = &candidate.sides[side];
        let Some((index, part, body)) = model.owner(anchor.body) else {
            return Err(Mismatch::Body { body: anchor.body, bodies: model.size().bodies });
        };
        if part.row == 0 {
            return Ok(Span { start, ..Span::default() });
        }
        let end = start + part.row;
        if self.values.len() < end {
            self.grow(end);
        }
        let mut rows = Rows { columns: &mut self.columns[start..end], values: &mut self.values[start..end] };
        let q = &q[part.q.clone()];
        let len = part.system.rows(body, q, &anchor.point, &candidate.frame, &mut rows).min(part.row);
        if side == 1 {
            for value in &mut rows.values[..len] {
                value.data.0[0].iter_mut().for_each(|x| *x = -*x);
            }
        }
        let velocities = part.v.len();
        if let Some(&column) = rows.columns[..len].iter().find(|column| **column >= velocities) {
            return Err(Mismatch::Column { body: anchor.body, column, velocities });
        }
        if self.acted_on.len() <= index {
            self.acted_on.resize(model.parts().len(), 0);
        }
        self.acted_on[index] = self.round + 1;
        Ok(Span { part: index, first: part.v.start, start, len })
    }

    /// Makes room for entries; never less again, so that a step with known contacts has none to
    /// make.
    #[cold]
    fn grow(&mut self, entries: usize) {
        self.columns.resize(entries, 0);
        self.values.resize(entries, Vector::zeros());
    }

    /// Whether all that could part the sides of the last rows is prescribed: no impulse changes their normal velocity.
    #[inline(always)]
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
            let (columns, values) = self.of_side(side);
            columns.iter().zip(values).all(|(c, value)| value[0] == 0.0 || driven.contains(c))
        })
    }

    pub(crate) fn pop(&mut self) {
        if let Some([first, _]) = self.spans.pop() {
            self.taken = first.start;
        }
    }

    /// The columns of a side of a contact within its part, and its entries.
    #[inline]
    fn of_side(&self, side: &Span) -> (&[usize], &[Vector<D>]) {
        (&self.columns[side.range()], &self.values[side.range()])
    }

    /// The entries of contact `i`, with their columns among the model's velocities.
    pub(crate) fn entries(&self, i: usize) -> impl Iterator<Item = (usize, &Vector<D>)> {
        self.spans[i].iter().flat_map(|side| {
            let (columns, values) = self.of_side(side);
            columns.iter().map(|column| side.first + column).zip(values)
        })
    }

    /// The columns of one side of a contact, among the model's velocities.
    pub(crate) fn columns_of(&self, side: &Span) -> impl Iterator<Item = usize> {
        self.of_side(side).0.iter().map(|column| side.first + column)
    }

    /// Adds a x to the normal row of contact `i`, once where both sides have the same column.
    pub(crate) fn add_to_normal(&mut self, i: usize, a: f64, x: &[f64]) {
        let sides = self.spans[i];
        for side in sides {
            // The sides of a contact lie beside each other.
            let start = if side.part == sides[0].part { sides[0].start } else { side.start };
            for place in side.range() {
                let column = self.columns[place];
                if !self.columns[start..place].contains(&column) {
                    self.values[place][0] += a * x[side.first + column];
                }
            }
        }
    }

    /// J_i v of some velocities.
    #[inline(always)]
    pub(crate) fn velocities<const N: usize>(&self, i: usize, v: [&[f64]; N]) -> [Vector<D>; N] {
        let mut u = [Vector::zeros(); N];
        for side in &self.spans[i] {
            let (columns, values) = self.of_side(side);
            let v = v.map(|v| &v[side.first..]);
            for (&column, value) in columns.iter().zip(values) {
                for k in 0..N {
                    add_scaled(&mut u[k], value, v[k][column]);
                }
            }
        }
        u
    }

    /// J_i v.
    #[inline]
    pub(crate) fn velocity(&self, i: usize, v: &[f64]) -> Vector<D> {
        let [u] = self.velocities(i, [v]);
        u
    }

    /// Σ |J_i v|: what rounding of the velocity of contact `i` is measured by.
    pub(crate) fn speed(&self, i: usize, v: &[f64]) -> f64 {
        let mut sum = 0.0;
        for side in &self.spans[i] {
            let (columns, values) = self.of_side(side);
            let v = &v[side.first..];
            for (&column, value) in columns.iter().zip(values) {
                sum += value.norm() * v[column].abs();
            }
        }
        sum
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
