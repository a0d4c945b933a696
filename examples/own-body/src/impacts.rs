//! An observer of one's own: the impacts of one pair, for a table of CSV.

use std::fmt::Write;
use std::ops::ControlFlow;
use teeter_integrator::{Model, Observer, ObserverError, State, StepReport};

/// A contact that closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// End of the step, s.
    pub t: f64,
    /// The point's number in its pair.
    pub point: u32,
    /// Normal and tangential impulse on the point, N·s.
    pub p: [f64; 2],
    /// Normal velocity before and after, m/s.
    pub u_n: [f64; 2],
    /// Work of all contacts in the step, J: a loss is negative.
    pub work: f64,
}

/// Collects the impacts of a pair.
#[derive(Debug)]
pub struct Impacts {
    pair: u32,
    pub found: Vec<Impact>,
}

impl Impacts {
    pub fn of(pair: u32) -> Self {
        Self { pair, found: Vec::new() }
    }

    pub fn csv(&self) -> Result<String, std::fmt::Error> {
        let mut text = String::from("t,point,impulse_n,impulse_t,u_n_before,u_n_after,work\n");
        for Impact { t, point, p, u_n, work } in &self.found {
            writeln!(text, "{t},{point},{},{},{},{},{work}", p[0], p[1], u_n[0], u_n[1])?;
        }
        Ok(text)
    }
}

impl Observer<2> for Impacts {
    fn observe(&mut self, _: &Model<2>, step: &StepReport<'_, 2>, _: &State) -> Result<ControlFlow<()>, ObserverError> {
        for contact in step.contacts().filter(|contact| contact.id.pair() == self.pair) {
            if !contact.persisting && contact.p[0] > 0.0 {
                self.found.push(Impact {
                    t: step.t_end,
                    point: contact.id.point(),
                    p: contact.p.into(),
                    u_n: [contact.u_before[0], contact.u_after[0]],
                    work: step.energy().contact + step.energy().friction,
                });
            }
        }
        Ok(ControlFlow::Continue(()))
    }
}
