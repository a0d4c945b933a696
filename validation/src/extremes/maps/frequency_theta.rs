//! f·dt × θ: up to which step a run is good for ten per cent, and where contacts begin to give energy that counts.

use super::super::row::{Base, Scheme, Sets};
use super::{Map, run, set};
use crate::case::Result;
use crate::figure::{Axes, Figure, Series};
use teeter_integrator::State;

/// First frequency of the base scene's beam, Hz.
const FREQUENCY: f64 = 26.531_268;

/// Between the times at which a run is compared, s.
const APART: f64 = 5e-3;

/// Times at which it is compared: before and after the first impact.
const TIMES: usize = 30;

/// What is good enough.
const ERROR: f64 = 0.1;

/// Gain of all steps together, over the energy scale, from which it counts.
const GAIN: f64 = 0.01;

/// Steps between two of these times, coarsest first.
const STEPS: [u32; 20] = [1, 2, 3, 4, 5, 6, 8, 10, 13, 16, 20, 25, 32, 40, 50, 63, 80, 100, 160, 250];

const THETAS: [f64; 11] = [0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 1.0];

/// Angles at the times, and the sum of gains over the energy scale.
struct Found {
    angles: Vec<f64>,
    gain: f64,
}

fn rock(scheme: Scheme, theta: f64, steps: u32) -> Result<Found> {
    let dt = APART / f64::from(steps);
    let sets: Sets = vec![
        set("time.step", format!("{dt:e} s")),
        set("time.end", format!("{:e} s", APART * TIMES as f64)),
        set("time.theta", theta.to_string()),
        set("time.scheme", scheme.word()),
        set("beam.table.start", "static"),
    ];
    let mut angles = Vec::with_capacity(TIMES);
    let state = run(Base::Beam, sets, |step, state: &State| {
        if step.step % u64::from(steps) == 0 {
            angles.push(state.q[2]);
        }
    })?;
    Ok(Found { angles, gain: state.ledger.positive_contact_work.sum / state.ledger.scale })
}

fn error(found: &Found, reference: &Found) -> f64 {
    let largest = reference.angles.iter().fold(0.0_f64, |most, angle| most.max(angle.abs()));
    let pairs = found.angles.iter().zip(&reference.angles);
    pairs.fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs())) / largest
}

/// f·dt of the finest step that fails, and of the next finer one: the border lies between.
fn border(fails: &[bool]) -> Option<f64> {
    let last = fails.iter().rposition(|fails| *fails);
    let at = |k: usize| FREQUENCY * APART / f64::from(STEPS[k]);
    match last {
        None => Some(at(0)),
        Some(k) if k + 1 < STEPS.len() => Some((at(k) * at(k + 1)).sqrt()),
        Some(_) => None,
    }
}

pub(super) fn map() -> Result<Map> {
    let reference = rock(Scheme::CLOSED, 0.5, 5000)?;
    let (mut accurate, mut gaining) = (Vec::new(), Vec::new());
    for theta in THETAS {
        let (mut wrong, mut gains) = (Vec::new(), Vec::new());
        for steps in STEPS {
            let found = rock(Scheme::OPEN, theta, steps)?;
            wrong.push(!(error(&found, &reference) <= ERROR));
            gains.push(!(found.gain <= GAIN));
        }
        accurate.extend(border(&wrong).map(|f_dt| (f_dt, theta)));
        gaining.extend(border(&gains).map(|f_dt| (f_dt, theta)));
    }
    let mut wrong = Vec::new();
    for steps in STEPS {
        wrong.push(!(error(&rock(Scheme::CLOSED, 0.5, steps)?, &reference) <= ERROR));
    }
    let closed = border(&wrong);
    let limit = |points: &[(f64, f64)], theta: f64| {
        let at = points.iter().find(|point| point.1 == theta);
        at.map_or("none of the steps tried".to_owned(), |point| format!("{:.2e}", point.0))
    };
    let says = format!(
        "Within 10 % of the angle up to f·dt = {} at θ = ½, {} at θ = ¾, {} at θ = 1 with moreau-jean, and up to {} with \
         moreau-jean-closed; θ above ½ allows no longer steps. Contacts generate less than 1 % of the energy up to {} at θ = ½ \
         and {} at θ = 1.",
        limit(&accurate, 0.5),
        limit(&accurate, 0.75),
        limit(&accurate, 1.0),
        closed.map_or("none of the steps tried".to_owned(), |f_dt| format!("{f_dt:.2e}")),
        limit(&gaining, 0.5),
        limit(&gaining, 1.0),
    );
    let mut series = vec![
        Series::marks("10 % of the angle, moreau-jean", accurate.clone()),
        Series::line("", accurate),
        Series::marks("1 % of the energy from contacts, moreau-jean", gaining.clone()),
        Series::line("", gaining),
    ];
    if let Some(f_dt) = closed {
        series.push(Series::marks("10 % of the angle, moreau-jean-closed", vec![(f_dt, 0.5)]));
    }
    Ok(Map {
        title: "f·dt × θ",
        about: "The paper's scene from its static start (e = 0) up to 0.15 s, which includes its first impacts, \
             compared with moreau-jean-closed at 1 µs: the largest steps with errors of the angle within 10 % of its \
             largest value, compared every 5 ms, and those with a total energy gain by contact below 1 % of the \
             energy scale. f is the beam's first frequency, 26.5 Hz. Right of a limit at least one step fails; the \
             steps are 5 ms divided by 1 to 250, and limits lie between two of them.",
        says,
        figures: vec![Figure {
            file: "extremes-frequency-theta.svg",
            title: "Where a run of the paper's scene is still good",
            x: "f dt",
            y: "θ",
            axes: Axes::LogarithmicX,
            caption: "",
            series,
        }],
    })
}
