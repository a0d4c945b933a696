//! The simulated motion of a block over time.

use crate::measured::Channel;
use std::ops::{ControlFlow, Range};
use teeter_integrator::{Model, Observer, ObserverError, State, StepReport};

/// Position, angle and their rates at some time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionAt {
    /// x, y in m, φ in rad.
    pub q: [f64; 3],
    /// Their rates.
    pub v: [f64; 3],
}

impl MotionAt {
    /// The value of a quantity.
    #[must_use]
    pub fn of(&self, channel: Channel) -> f64 {
        match channel {
            Channel::Phi => self.q[2],
            Channel::Omega => self.v[2],
            Channel::X => self.q[0],
            Channel::Y => self.q[1],
            Channel::Vx => self.v[0],
            Channel::Vy => self.v[1],
        }
    }
}

/// Why a table of a run can't be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TraceError {
    /// Not a table of numbers as a run writes it.
    #[error("line {line}: {what}")]
    Row {
        /// The line, from 1.
        line: usize,
        /// What is wrong.
        what: String,
    },
    /// The block isn't in it.
    #[error("no block `{block}`; the run has {known}")]
    Block {
        /// The block.
        block: String,
        /// The blocks of the run.
        known: String,
    },
    /// There are several blocks, and none is chosen.
    #[error("the run has several blocks, {known}: say which one was measured, with --block NAME")]
    Several {
        /// The blocks of the run.
        known: String,
    },
    /// There are no blocks.
    #[error("the run has no block")]
    NoBlock,
    /// The run is too short.
    #[error("the run has fewer than two rows")]
    TooShort,
}

/// The block that is meant, of these of a table.
fn chosen<'a>(block: Option<&str>, names: &[&'a str]) -> Result<&'a str, TraceError> {
    /// Most names in a message.
    const LISTED: usize = 20;
    let known = || {
        let listed: Vec<_> = names.iter().take(LISTED).map(|name| format!("`{name}`")).collect();
        let more = names.len().saturating_sub(LISTED);
        listed.join(", ") + &if more > 0 { format!(" and {more} more") } else { String::new() }
    };
    match (block, names) {
        (_, []) => Err(TraceError::NoBlock),
        (Some(block), names) => match names.iter().find(|name| **name == block) {
            Some(found) => Ok(found),
            None => Err(TraceError::Block { block: block.to_owned(), known: known() }),
        },
        (None, [block]) => Ok(block),
        (None, _) => Err(TraceError::Several { known: known() }),
    }
}

/// The motion of a block, between rows by the cubics through positions and velocities.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MotionTrace {
    t: Vec<f64>,
    rows: Vec<([f64; 3], [f64; 3])>,
}

impl MotionTrace {
    /// The names of the blocks in the heading of a `trajectory.csv`.
    pub fn blocks(table: &str) -> impl Iterator<Item = &str> {
        table.lines().next().unwrap_or_default().split(',').filter_map(|name| name.strip_suffix(".phi"))
    }

    /// Reads the motion of a block from the text of a `trajectory.csv`; without a name, of the only
    /// block.
    ///
    /// # Errors
    /// If the table isn't one of a run, or the block isn't in it.
    pub fn read(table: &str, block: Option<&str>) -> Result<(String, Self), TraceError> {
        let names: Vec<&str> = Self::blocks(table).collect();
        let block = chosen(block, &names)?;
        Self::read_columns(table, block, |name| format!("{block}.{name}"), |_| true)
    }

    /// As [`Self::read`], from the text of a `blocks.csv`, which has a row for each block at each time.
    ///
    /// # Errors
    /// If the table isn't one of a run, or the block isn't in it.
    pub fn read_rows(table: &str, block: Option<&str>) -> Result<(String, Self), TraceError> {
        let name_of = |line: &'_ str| line.split(',').nth(1).map(str::to_owned);
        let time_of = |line: &'_ str| line.split(',').next().map(str::to_owned);
        let first = table.lines().nth(1).and_then(time_of);
        let names: Vec<String> =
            table.lines().skip(1).take_while(|line| time_of(line) == first).filter_map(name_of).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let block = chosen(block, &names)?;
        Self::read_columns(table, block, str::to_owned, |line| line.split(',').nth(1) == Some(block))
    }

    /// Reads columns of these names from the lines that are the block's.
    fn read_columns(
        table: &str,
        block: &str,
        column: impl Fn(&str) -> String,
        is_of_block: impl Fn(&str) -> bool,
    ) -> Result<(String, Self), TraceError> {
        let heading: Vec<&str> = table.lines().next().unwrap_or_default().split(',').collect();
        let place = |name: &str| heading.iter().position(|cell| *cell == column(name));
        let wanted: Option<Vec<usize>> = ["x", "y", "phi", "vx", "vy", "omega"].into_iter().map(place).collect();
        let row_error = |line: usize, what: String| TraceError::Row { line, what };
        let wanted = wanted.ok_or_else(|| row_error(1, format!("columns of `{block}` are missing")))?;
        let mut trace = Self::default();
        for (number, line) in table.lines().enumerate().skip(1).filter(|(_, line)| is_of_block(line)) {
            let cells: Vec<&str> = line.split(',').collect();
            let number_in = |place: usize| {
                let cell = cells.get(place).copied().unwrap_or_default();
                cell.parse::<f64>().map_err(|_| row_error(number + 1, format!("`{cell}` is not a number")))
            };
            let values: Result<Vec<f64>, TraceError> = wanted.iter().map(|&place| number_in(place)).collect();
            let values = values?;
            trace.push(number_in(0)?, [values[0], values[1], values[2]], [values[3], values[4], values[5]]);
        }
        if trace.t.len() < 2 { Err(TraceError::TooShort) } else { Ok((block.to_owned(), trace)) }
    }

    /// Adds a row, after all others.
    pub(crate) fn push(&mut self, t: f64, q: [f64; 3], v: [f64; 3]) {
        self.t.push(t);
        self.rows.push((q, v));
    }

    /// Times of the rows, s.
    #[must_use]
    pub fn times(&self) -> &[f64] {
        &self.t
    }

    /// The time of the last row, s.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.t.last().copied().unwrap_or(0.0)
    }

    /// Whether the block is let go from rest at t = 0, so that it was in the same place before.
    #[must_use]
    pub fn is_held(&self) -> bool {
        self.rows.first().is_some_and(|(_, v)| *v == [0.0; 3])
    }

    /// The motion at time `t` (s): before the start that of a block at rest if it
    /// [is](Self::is_held), `None` after the end.
    #[must_use]
    pub fn at(&self, t: f64) -> Option<MotionAt> {
        self.at_near(t, &mut 0)
    }

    /// As [`at`](Self::at); `hint` makes it faster for times that increase. It is 0 at first.
    pub(crate) fn at_near(&self, t: f64, hint: &mut usize) -> Option<MotionAt> {
        let (first, last) = (self.rows.first()?, self.rows.last()?);
        if t <= self.t[0] {
            let held = (t == self.t[0] || self.is_held()).then_some(first);
            return held.map(|(q, v)| MotionAt { q: *q, v: *v });
        }
        if t >= self.end() {
            let rounding = 1e-9 * self.end();
            return (t <= self.end() + rounding).then_some(MotionAt { q: last.0, v: last.1 });
        }
        let is_after = |row: usize| row > 0 && self.t[row - 1] <= t && self.t.get(row).is_some_and(|next| *next > t);
        let after =
            (*hint..*hint + 4).find(|row| is_after(*row)).unwrap_or_else(|| self.t.partition_point(|row| *row <= t));
        *hint = after;
        let (t0, t1) = (self.t[after - 1], self.t[after]);
        let ((q0, v0), (q1, v1)) = (self.rows[after - 1], self.rows[after]);
        let h = t1 - t0;
        let s = (t - t0) / h;
        let cubic = |k: usize| {
            let (a, b) = ((1.0 + 2.0 * s) * (1.0 - s) * (1.0 - s), s * s * (3.0 - 2.0 * s));
            let (c, d) = (s * (1.0 - s) * (1.0 - s), s * s * (s - 1.0));
            a * q0[k] + b * q1[k] + h * (c * v0[k] + d * v1[k])
        };
        // Velocities may jump at an impact within the row, so no cubic runs through them.
        let linear = |k: usize| v0[k] + s * (v1[k] - v0[k]);
        Some(MotionAt { q: [0, 1, 2].map(cubic), v: [0, 1, 2].map(linear) })
    }
}

/// Records the motion of a block over a run.
pub(crate) struct Tracer {
    /// Its coordinates in the state.
    range: Range<usize>,
    /// Least time between rows, s.
    every: f64,
    next: f64,
    pub(crate) trace: MotionTrace,
}

impl Tracer {
    pub(crate) fn new(range: Range<usize>, every: f64) -> Self {
        Self { range, every, next: 0.0, trace: MotionTrace::default() }
    }

    fn take(&mut self, state: &State) {
        let three = |x: &[f64]| [x[self.range.start], x[self.range.start + 1], x[self.range.start + 2]];
        self.trace.push(state.t, three(&state.q), three(&state.v));
        self.next = state.t + self.every * (1.0 - 1e-9);
    }
}

impl Observer<2> for Tracer {
    fn start(&mut self, _: &Model<2>, state: &State) -> Result<(), ObserverError> {
        self.take(state);
        Ok(())
    }

    fn observe(
        &mut self,
        _: &Model<2>,
        step: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError> {
        if step.t_end > step.t_start && state.t >= self.next {
            self.take(state);
        }
        Ok(ControlFlow::Continue(()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_read_and_interpolated() {
        let mut table = "t,b.x,b.y,b.phi,b.vx,b.vy,b.omega\n".to_owned();
        for k in 0..=10 {
            let t = 0.1 * f64::from(k);
            table += &format!("{t:?},0.0,0.0,{:?},0.0,0.0,{:?}\n", t * t * t, 3.0 * t * t);
        }
        let (block, trace) = MotionTrace::read(&table, None).unwrap();
        assert_eq!((block.as_str(), trace.end(), trace.is_held()), ("b", 1.0, true));
        assert!((trace.at(0.537).unwrap().q[2] - 0.537_f64.powi(3)).abs() < 1e-15);
        assert_eq!(trace.at(-1.0).unwrap().q[2], 0.0);
        assert!(trace.at(1.01).is_none());
        assert!(MotionTrace::read(&table, Some("c")).unwrap_err().to_string().contains("`b`"));
        assert!(matches!(MotionTrace::read("t,w\n0,1\n", None), Err(TraceError::NoBlock)));
    }

    #[test]
    fn rows_of_a_block_are_read_as_its_columns() {
        let (mut columns, mut rows) = ("t,a.x,a.y,a.phi,a.vx,a.vy,a.omega\n".to_owned(), String::new());
        rows += "t,block,x,y,phi,vx,vy,omega\n";
        for k in 0..5 {
            let (t, phi) = (0.1 * f64::from(k), f64::from(k * k));
            columns += &format!("{t:?},1.0,2.0,{phi:?},3.0,4.0,5.0\n");
            rows += &format!("{t:?},ab,0.0,0.0,0.0,0.0,0.0,0.0\n{t:?},a,1.0,2.0,{phi:?},3.0,4.0,5.0\n");
        }
        assert_eq!(MotionTrace::read_rows(&rows, Some("a")), MotionTrace::read(&columns, Some("a")));
        let known = |block| MotionTrace::read_rows(&rows, block).unwrap_err().to_string();
        assert!(known(Some("b")).contains("`ab`, `a`") && known(None).contains("several blocks"), "{}", known(None));
        let many: String = (0..30).map(|k| format!("0.0,b-{k},0.0,0.0,0.0,0.0,0.0,0.0\n")).collect();
        let told = MotionTrace::read_rows(&format!("t,block,x,y,phi,vx,vy,omega\n{many}"), None).unwrap_err();
        assert!(told.to_string().contains("`b-19` and 10 more"), "{told}");
    }
}
