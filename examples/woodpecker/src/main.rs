//! The toy woodpecker: let go, it pecks its way down the pole, self-sustained by impacts, friction and a spring ([`toy`]). A body with a
//! spring and contacts that the crates know nothing of, run by their schemes.

mod toy;

use nalgebra::Vector2;
use std::error::Error;
use std::ops::ControlFlow;
use teeter_detect::{Kinematics, PointDetector, PointPair};
use teeter_integrator::{
    Ended, Ground, Model, ModelBuilder, Observer, ObserverError, PairLaw, Plan, SolverSettings, State, StepReport,
    Unsolved, Workspace, run, schemes,
};
use teeter_solvers::Auto;
use toy::{BEAK, LOWER_EDGE, Toy, UPPER_EDGE};

type Done<T> = Result<T, Box<dyn Error + Send + Sync>>;

/// The pairs are in the order of the bodies: the beak comes back with half of its speed, the sleeve's edges don't.
fn model() -> Done<Model<2>> {
    let mut parts = ModelBuilder::new();
    let toy = parts.add(Toy);
    let surface = parts.add(Ground::flat(0.0)).body();
    let mut pairs = Vec::new();
    for (pair, restitution) in [(BEAK, 0.5), (LOWER_EDGE, 0.0), (UPPER_EDGE, 0.0)] {
        pairs.push(PointPair {
            pair,
            law: parts.law(PairLaw::new(0.3, restitution)),
            points: vec![Vector2::zeros()],
            body: toy.nth_body(pair),
            surface,
            kinematics: Kinematics::Deformed,
        });
    }
    Ok(parts.build(Box::new(PointDetector::new(pairs)))?)
}

/// The published start, a state of the limit cycle: the sleeve is jammed, the bird swings down.
const START: ([f64; 3], [f64; 3]) = ([0.0, -0.1036, -0.2788], [-0.3411, 0.0, -7.4583]);

/// The motion each time the bird swings down through its angle at the start.
#[derive(Default)]
struct Cycles {
    before: Option<(f64, [f64; 6])>,
    /// Time, s; coordinates and velocities.
    returns: Vec<(f64, [f64; 6])>,
}

impl Observer<2> for Cycles {
    fn observe(
        &mut self,
        _: &Model<2>,
        _: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError> {
        let now = (state.t, [state.q[0], state.q[1], state.q[2], state.v[0], state.v[1], state.v[2]]);
        let bird = START.0[2];
        if let Some((t, x)) = self.before.replace(now)
            && x[2] > bird
            && now.1[2] <= bird
        {
            let part = (bird - x[2]) / (now.1[2] - x[2]);
            let at = |before: f64, after: f64| before + part * (after - before);
            self.returns.push((at(t, now.0), std::array::from_fn(|k| at(x[k], now.1[k]))));
        }
        Ok(ControlFlow::Continue(()))
    }
}

impl Cycles {
    /// Period, s, and way down, m, of the last one.
    fn last(&self) -> Option<[f64; 2]> {
        let [.., (before, high), (now, low)] = self.returns.as_slice() else { return None };
        Some([now - before, high[0] - low[0]])
    }
}

/// Two seconds of pecking, some thirteen cycles.
fn peck(scheme: &str, step: f64) -> Done<(State, Cycles)> {
    let model = model()?;
    let mut scheme = schemes()
        .iter()
        .find(|entry| entry.name == scheme)
        .and_then(|entry| entry.make())
        .ok_or_else(|| format!("there is no scheme {scheme}"))?;
    let mut state = State::new(&model, &START.0, &START.1, step)?;
    let settings = SolverSettings { tolerance: 1e-12, ..SolverSettings::default() };
    let mut work = Workspace::new(&model, Box::new(Auto::<2>::new()), settings);
    let mut cycles = Cycles::default();
    let plan = Plan::time(2.0).when_unsolved(Unsolved::End);
    match run(&model, scheme.as_mut(), &mut state, &mut work, &plan, &mut [&mut cycles])? {
        Ended::Complete => Ok((state, cycles)),
        ended => Err(format!("the run ended at {} s: {ended:?}", state.t).into()),
    }
}

fn main() -> Done<()> {
    println!("{:>22} {:>8} {:>12} {:>14}", "scheme", "step, s", "period, ms", "way down, mm");
    for scheme in ["moreau-jean", "moreau-jean-closed", "moreau-jean-located", "event-driven"] {
        for step in [1e-3, 1e-4, 1e-5] {
            match peck(scheme, step).map(|(_, cycles)| cycles.last()) {
                Ok(Some([period, down])) => {
                    println!("{scheme:>22} {step:>8.0e} {:>12.4} {:>14.4}", 1e3 * period, 1e3 * down);
                }
                Ok(None) => println!("{scheme:>22} {step:>8.0e} it doesn't peck"),
                Err(error) => println!("{scheme:>22} {step:>8.0e} {error}"),
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_returns_to_the_published_state_each_146_ms() {
        for scheme in ["moreau-jean-closed", "moreau-jean-located"] {
            let (state, cycles) = peck(scheme, 1e-5).unwrap();
            assert!(cycles.returns.len() >= 12, "{scheme}: {} cycles", cycles.returns.len());
            let (q, v) = START;
            for (t, now) in &cycles.returns[1..] {
                // Published to four digits, of time steps of its own.
                let known = [(now[1], q[1]), (now[3], v[0]), (now[5], v[2])];
                assert!(known.iter().all(|(now, known)| (now / known - 1.0).abs() < 1e-2), "{scheme}, {t} s: {now:?}");
                assert!(now[4].abs() < 1e-3, "the sleeve turns at {t} s: {now:?}");
            }
            let [period, down] = cycles.last().unwrap();
            assert!((period - 0.146).abs() < 2e-4, "{scheme}: {period} s");
            assert!((down - 0.0195).abs() < 2e-4, "{scheme}: {down} m");
            let ledger = &state.ledger;
            assert!(ledger.relative_residual() < 1e-12, "{scheme}: {:e}", ledger.relative_residual());
            assert!(
                ledger.positive_contact_work.sum <= 1e-12 * ledger.scale,
                "{scheme}: {:?}",
                ledger.positive_contact_work
            );
        }
    }
}
