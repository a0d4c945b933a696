//! Discs: one that is thrown without spin, and a row in which each hits the next.

use crate::case::{Case, Check, Depth, Findings, Result};
use teeter_integrator::Ended;
use teeter_scenario::simulation::Simulation;

pub(crate) struct Discs;

const GRAVITY: f64 = 9.81;
const RADIUS: f64 = 0.05;

/// Of the thrown disc: m/s, coefficient of friction, and when it is looked at, s.
const THROWN: (f64, f64, f64) = (1.0, 0.3, 0.5);

/// Of the row: discs, m between them, m/s of the first, and when it is looked at, s.
const ROW: (usize, f64, f64, f64) = (5, 1e-4, 1.0, 0.5);

/// By name; auto is `moreau-jean-located` here.
const SCHEMES: [&str; 2] = ["event-driven", "auto"];

/// m and m/s.
const BOUND: f64 = 1e-11;

impl Case for Discs {
    fn name(&self) -> &'static str {
        "discs"
    }

    fn about(&self) -> &'static str {
        "Discs of radius 5 cm on level ground, as scenes with steps of 1 ms. **Thrown** at 1 m/s without spin, μ = 0.3, \
         a disc slides until t₁ = v₀/(3μg), then rolls at 2/3 v₀: place, velocity and spin at 0.5 s. **In a row** of \
         five, 0.1 mm apart and without friction, the first comes at 1 m/s (Newton's cradle): places and velocities at \
         0.5 s, compared with a program for points on a line that takes the impacts one by one, for e = 1, 0.9, 0.5."
    }

    fn run(&self, _: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        for scheme in SCHEMES {
            let quantity = format!("{scheme}, thrown: x, v, rω, worst error");
            findings.checks.push(Check::worst(quantity, thrown(scheme)?, BOUND));
            for e in [1.0, 0.9, 0.5] {
                let quantity = format!("{scheme}, row, e = {e}: x, v, worst error");
                findings.checks.push(Check::worst(quantity, row(scheme, e)?, BOUND));
            }
        }
        Ok(findings)
    }
}

/// Discs on the ground, given by the places and velocities of their centres, at a later time.
fn later(scheme: &str, discs: &[[f64; 2]], friction: f64, e: f64, t: f64) -> Result<Simulation> {
    let mut text = format!(
        "time = {{ end = \"{t} s\", step = \"1 ms\", scheme = \"{scheme}\" }}\nground = {{}}\n\
         material.steel.density = \"7850 kg/m^3\"\n\
         contact.floor = {{ between = [\"*\", \"ground\"], friction = {friction} }}\n"
    );
    for (k, [x, v]) in discs.iter().enumerate() {
        text += &format!(
            "[block.disc-{k}]\nmaterial = \"steel\"\nradius = \"{RADIUS} m\"\ndepth = \"10 cm\"\non = \"ground\"\n\
             at = \"{x:?} m\"\nvelocity = [\"{v:?} m/s\", \"0 m/s\"]\n"
        );
    }
    if discs.len() > 1 {
        text += &format!("[contact.discs]\nbetween = [\"disc-*\", \"disc-*\"]\nfriction = 0.0\nrestitution = {e}\n");
    }
    let resolved =
        teeter_scenario::load(text.as_bytes(), "discs", "discs", &[]).map_err(|errors| format!("{errors}\n{text}"))?;
    let mut simulation = Simulation::new(&resolved.scene)?;
    match simulation.run(&mut [])? {
        Ended::Complete => Ok(simulation),
        ended => Err(format!("{ended:?}").into()),
    }
}

fn thrown(scheme: &str) -> Result<f64> {
    let (v, friction, t) = THROWN;
    let simulation = later(scheme, &[[0.0, v]], friction, 0.0, t)?;
    let slid = v / (3.0 * friction * GRAVITY);
    let rolling = 2.0 / 3.0 * v;
    let x = v * slid - 0.5 * friction * GRAVITY * slid * slid + rolling * (t - slid);
    let (q, u) = (&simulation.state.q, &simulation.state.v);
    Ok([q[0] - x, u[0] - rolling, RADIUS * u[2] + rolling].into_iter().fold(0.0, |most, error| most.max(error.abs())))
}

fn row(scheme: &str, e: f64) -> Result<f64> {
    let (count, gap, speed, t) = ROW;
    let start: Vec<[f64; 2]> =
        (0..count).map(|k| [(2.0 * RADIUS + gap) * k as f64, if k == 0 { speed } else { 0.0 }]).collect();
    let simulation = later(scheme, &start, 0.0, e, t)?;
    let known = points_later(&start, e, t);
    let (q, u) = (&simulation.state.q, &simulation.state.v);
    let errors = known.iter().enumerate().flat_map(|(k, [x, v])| [q[3 * k] - x, u[3 * k] - v]);
    Ok(errors.fold(0.0, |most, error| most.max(error.abs())))
}

/// Equal points on a line that hit each other at a distance of a disc's diameter, impact by impact.
fn points_later(start: &[[f64; 2]], e: f64, end: f64) -> Vec<[f64; 2]> {
    let mut points = start.to_vec();
    let mut t = 0.0;
    loop {
        let next = points.windows(2).enumerate().filter_map(|(k, pair)| {
            let approach = pair[0][1] - pair[1][1];
            let gap = pair[1][0] - pair[0][0] - 2.0 * RADIUS;
            (approach > 0.0).then(|| ((gap / approach).max(0.0), k))
        });
        let hit = next.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(wait, _)| t + wait < end);
        let wait = hit.map_or(end - t, |(wait, _)| wait);
        points.iter_mut().for_each(|point| point[0] += wait * point[1]);
        let Some((_, k)) = hit else { return points };
        t += wait;
        let (sum, difference) = (points[k][1] + points[k + 1][1], points[k][1] - points[k + 1][1]);
        points[k][1] = 0.5 * (sum - e * difference);
        points[k + 1][1] = 0.5 * (sum + e * difference);
    }
}
