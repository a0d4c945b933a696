//! dt × restitution at rest: whether a block that was thrown up comes to rest, or goes on buzzing.

use super::super::row::{Base, Scheme, Sets};
use super::{Map, run, set};
use crate::case::Result;
use crate::figure::{Axes, Figure, Series};

/// Upwards at the start, m/s.
const THROWN: f64 = 0.05;

/// m/s².
const GRAVITY: f64 = 9.81;

/// A block slower than this part of g·dt, what gravity gives it in a step, is at rest.
const STILL: f64 = 1e-6;

/// Steps at the end over which it is watched.
const WATCHED: u64 = 500;

const STEPS: [f64; 9] = [1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1];

const RESTITUTIONS: [f64; 12] = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98];

/// The fastest over the last steps, over g·dt, long after the bounces of a point have ended, at 2v/(g(1 − e)): on the ground of the block, on a beam,
/// which goes on swinging, of the approach in which a contact closes anew.
fn left(base: Base, scheme: Scheme, dt: f64, e: f64) -> Result<f64> {
    let ends = 2.0 * THROWN / (GRAVITY * (1.0 - e));
    let steps = ((1.0 + 4.0 * ends) / dt).ceil().max(1000.0);
    let sets: Sets = vec![
        set("time.step", format!("{dt:e} s")),
        set("time.end", format!("{:e} s", steps * dt)),
        set("time.scheme", scheme.word()),
        set("block.rocker.height", "3 cm"),
        set("block.rocker.tilt", "2 deg"),
        set("block.rocker.velocity", format!("[\"0 m/s\", \"{THROWN} m/s\"]")),
        set("contact.feet.restitution", e.to_string()),
    ];
    let last = steps as u64;
    let mut fastest = 0.0_f64;
    run(base, sets, |step, state| {
        if step.step + WATCHED <= last {
            return;
        }
        if base == Base::Ground {
            // With half the block's width for its spin.
            fastest = fastest.max(state.v[0].abs()).max(state.v[1].abs()).max(0.015 * state.v[2].abs());
        }
        for contact in step.contacts().filter(|contact| !contact.persisting && contact.p[0] > 0.0) {
            fastest = fastest.max(-contact.u_before[0]);
        }
    })?;
    Ok(fastest / (GRAVITY * dt))
}

pub(super) fn map() -> Result<Map> {
    let (mut figures, mut says) = (Vec::new(), Vec::new());
    for (base, scheme) in [Base::Ground, Base::Beam]
        .into_iter()
        .flat_map(|base| [Scheme::OPEN, Scheme::CLOSED].map(|scheme| (base, scheme)))
    {
        let (mut rests, mut buzzes, mut worst) = (Vec::new(), Vec::new(), 0.0_f64);
        for dt in STEPS {
            for e in RESTITUTIONS {
                let speed = left(base, scheme, dt, e)?;
                if speed <= STILL {
                    rests.push((dt, e));
                } else {
                    buzzes.push((dt, e));
                    worst = worst.max(speed);
                }
            }
        }
        let on = if base == Base::Ground { "ground" } else { "the beam" };
        let least = buzzes.iter().map(|point| point.1).fold(f64::INFINITY, f64::min);
        says.push(if buzzes.is_empty() {
            format!("On {on} with {} the block rests at every step and restitution.", scheme.word())
        } else {
            format!(
                "On {on} with {} it keeps buzzing in {} of {} cases, from e = {least} up, at up to {worst:.0e} g·dt.",
                scheme.word(),
                buzzes.len(),
                buzzes.len() + rests.len()
            )
        });
        if base == Base::Ground && buzzes.is_empty() {
            continue;
        }
        let (file, title) = match (base, scheme) {
            (Base::Ground, Scheme::OPEN) => ("extremes-resting-open.svg", "At rest or buzzing on ground: moreau-jean"),
            (Base::Ground, Scheme::CLOSED) => {
                ("extremes-resting-closed.svg", "At rest or buzzing on ground: moreau-jean-closed")
            }
            (_, Scheme::OPEN) => ("extremes-resting-beam-open.svg", "At rest or buzzing on a beam: moreau-jean"),
            _ => ("extremes-resting-beam-closed.svg", "At rest or buzzing on a beam: moreau-jean-closed"),
        };
        let series = [("rests", rests), ("buzzes", buzzes)].into_iter().filter(|(_, points)| !points.is_empty());
        figures.push(Figure {
            file,
            title,
            x: "dt (s)",
            y: "Restitution",
            axes: Axes::LogarithmicX,
            caption: "",
            series: series.map(|(name, points)| Series::marks(name, points)).collect(),
        });
    }
    Ok(Map {
        title: "dt × restitution at rest",
        about: "A cube of 3 cm, tilted by 2°, is thrown up at 0.05 m/s from rigid ground, and from the paper's beam. \
             The bounces of a point end at 2v/(g(1 − e)); the run is four times as long plus a second, at least 1000 \
             steps, and its last 500 steps are examined. The block buzzes if it is faster than 1e-6 g·dt; on the \
             beam, which vibrates for longer, if a contact still closes faster than that.",
        says: says.join(" "),
        figures,
    })
}
