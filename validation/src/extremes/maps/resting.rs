//! dt × restitution at rest: whether a block that was thrown up comes to rest, or goes on buzzing.

use super::super::row::{Base, Scheme, Sets};
use super::{Map, run, set};
use crate::case::Result;
use crate::figure::{Axes, Corner, Figure, Series};

/// Upwards at the start, m/s.
const THROWN: f64 = 0.05;

/// m/s².
const GRAVITY: f64 = 9.81;

/// A block slower than this part of g·dt, what gravity gives it in a step, is at rest.
const STILL: f64 = 1e-6;

/// Steps at the end over which it is watched.
const WATCHED: u64 = 50;

const STEPS: [f64; 9] = [1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1];

const RESTITUTIONS: [f64; 12] = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98];

/// The fastest over the last steps, over g·dt: long after the bounces of a point have ended, at 2v/(g(1 − e)).
fn left(scheme: Scheme, dt: f64, e: f64) -> Result<f64> {
    let ends = 2.0 * THROWN / (GRAVITY * (1.0 - e));
    let steps = (3.0 * ends / dt).ceil().max(200.0);
    let sets: Sets = vec![
        set("time.step", format!("{dt:e} s")),
        set("time.end", format!("{:e} s", steps * dt)),
        set("time.scheme", scheme.word()),
        set("block.rocker.tilt", "0 deg"),
        set("block.rocker.velocity", format!("[\"0 m/s\", \"{THROWN} m/s\"]")),
        set("contact.feet.restitution", e.to_string()),
    ];
    let last = steps as u64;
    let mut fastest = 0.0_f64;
    run(Base::Ground, sets, |step, state| {
        if step.step + WATCHED > last {
            // The corners' speed, with half the block's width for its spin.
            fastest = fastest.max(state.v[0].abs()).max(state.v[1].abs()).max(0.015 * state.v[2].abs());
        }
    })?;
    Ok(fastest / (GRAVITY * dt))
}

pub(super) fn map() -> Result<Map> {
    let (mut figures, mut says) = (Vec::new(), Vec::new());
    for scheme in Scheme::ALL {
        let (mut rests, mut buzzes, mut worst) = (Vec::new(), Vec::new(), 0.0_f64);
        for dt in STEPS {
            for e in RESTITUTIONS {
                let speed = left(scheme, dt, e)?;
                if speed <= STILL {
                    rests.push((dt, e));
                } else {
                    buzzes.push((dt, e));
                    worst = worst.max(speed);
                }
            }
        }
        let word = scheme.word();
        let least = buzzes.iter().map(|point| point.1).fold(f64::INFINITY, f64::min);
        says.push(if buzzes.is_empty() {
            format!("With {word} the block rests at every step and restitution.")
        } else {
            format!(
                "With {word} it buzzes in {} of {} cases, from e = {least} up, at up to {worst:.1} g·dt: smaller steps make it \
                 quieter, not still.",
                buzzes.len(),
                buzzes.len() + rests.len()
            )
        });
        let (file, title) = match scheme {
            Scheme::Open => ("extremes-resting-open.svg", "At rest or buzzing: moreau-jean"),
            Scheme::Closed => ("extremes-resting-closed.svg", "At rest or buzzing: moreau-jean-closed"),
        };
        let series = [("rests", rests), ("buzzes", buzzes)].into_iter().filter(|(_, points)| !points.is_empty());
        figures.push(Figure {
            file,
            title,
            x: "dt / s",
            y: "restitution",
            axes: Axes::LogarithmicX,
            legend: Corner::LowerLeft,
            caption: "",
            series: series.map(|(name, points)| Series::marks(name, points)).collect(),
        });
    }
    Ok(Map {
        title: "dt × restitution at rest",
        about: "The block, flat on rigid ground, is thrown up at 0.05 m/s. The bounces of a point end at 2v/(g(1 − e)); three times as long, and 200 steps at \
                least, it is let be, and watched for the last 50 steps. At rest is slower than 1e-6 g·dt.",
        says: says.join(" "),
        figures,
    })
}
