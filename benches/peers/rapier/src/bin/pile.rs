//! A pile of stones, as `benches/pile` writes it, in rapier: time a step, residual, penetration, energy.
//!
//! ```text
//! pile FILE SECONDS [iterations=4] [step=1e-3]
//! ```
//!
//! The residual is teeter's (`docs/theory.md` §6), over all contacts: impulses that rapier applied in a step and velocities
//! of the contact points after it. rapier writes no free velocity, so its scale is ‖p‖, which is the larger one at rest.

use cpu_time::ProcessTime;
use rapier2d_f64::{na, prelude::*};
use std::error::Error;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

const DENSITY: f64 = 200.0; // 2000 kg/m³, 0.1 m deep
const FRICTION: f64 = 0.5;

fn build(text: &str) -> Result<PhysicsWorld> {
    let mut world = PhysicsWorld::default();
    let mut lines = text.lines();
    let half: f64 = lines.next().ok_or("an empty file")?.parse()?;
    for (place, inwards) in [((-half, 0.0), (10.0, 1.0)), ((half, 0.0), (-10.0, 1.0)), ((0.0, 0.0), (0.0, 1.0))] {
        // A wall of the trough rises 10 to 1.
        let (x, y): (f64, f64) = if inwards.0 == 0.0 { (0.0, 1.0) } else { (inwards.0, 1.0) };
        let normal = Vector::new(x, y) / x.hypot(y);
        let shape = ColliderBuilder::halfspace(na::Unit::new_unchecked(normal)).friction(FRICTION).restitution(0.0);
        world.insert(RigidBodyBuilder::fixed().translation(Vector::new(place.0, place.1)), shape);
    }
    for line in lines {
        let numbers: Vec<f64> = line.split_whitespace().map(str::parse).collect::<std::result::Result<_, _>>()?;
        let [x, y, outline @ ..] = &numbers[..] else { return Err("a stone is: x y and its corners".into()) };
        let corners: Vec<Vector> = outline.chunks(2).map(|c| Vector::new(c[0], c[1])).collect();
        let body = RigidBodyBuilder::dynamic().translation(Vector::new(*x, *y)).can_sleep(false);
        let shape = ColliderBuilder::convex_hull(&corners).ok_or("a stone without area")?;
        world.insert(body, shape.density(DENSITY).friction(FRICTION).restitution(0.0));
    }
    Ok(world)
}

/// What a step left: contacts that carry, residual, largest penetration in m.
fn judged(world: &PhysicsWorld) -> (usize, f64, f64) {
    let mut contacts = Vec::new();
    let mut deepest = 0.0_f64;
    for pair in world.narrow_phase.contact_pairs() {
        for manifold in pair.manifolds() {
            let normal = manifold.data.normal;
            let tangent = Vector::new(-normal.y, normal.x);
            let bodies = [manifold.data.rigid_body1, manifold.data.rigid_body2].map(|b| b.and_then(|b| world.bodies.get(b)));
            let Some(first) = world.colliders.get(pair.collider1) else { continue };
            for point in &manifold.points {
                deepest = deepest.max(-point.dist);
                let at = first.position().transform_point(point.local_p1);
                let (mut u, mut h) = ([0.0; 2], 0.0);
                for (body, sign) in bodies.iter().zip([-1.0, 1.0]) {
                    let Some(body) = body.filter(|body| body.is_dynamic()) else { continue };
                    let arm = at - body.center_of_mass();
                    let speed = body.linvel() + Vector::new(-body.angvel() * arm.y, body.angvel() * arm.x);
                    u[0] += sign * speed.dot(normal);
                    u[1] += sign * speed.dot(tangent);
                    // The trace of H_ii.
                    h += 2.0 / body.mass() + arm.length_squared() / body.mass_properties().local_mprops.principal_inertia();
                }
                let p = [point.data.impulse, point.data.tangent_impulse.x];
                contacts.push((p, u, h));
            }
        }
    }
    // The sign with which rapier counts its tangent impulse doesn't matter for a sticking contact; for a sliding one the
    // impulse is against the slip.
    let rho = 2.0 * contacts.len() as f64 / contacts.iter().map(|c| c.2).sum::<f64>();
    let (mut map, mut size, mut carrying) = (0.0, 0.0, 0);
    for (p, u, _) in &contacts {
        if p[0] <= 0.0 && u[0] >= 0.0 {
            continue;
        }
        carrying += usize::from(p[0] > 0.0);
        let residual = |sign: f64| {
            let p = [p[0], sign * p[1]];
            let x = [p[0] - rho * (u[0] + FRICTION * u[1].abs()), p[1] - rho * u[1]];
            let y = project(x);
            (p[0] - y[0]).powi(2) + (p[1] - y[1]).powi(2)
        };
        map += residual(1.0).min(residual(-1.0));
        size += p[0].powi(2) + p[1].powi(2);
    }
    (carrying, (map / size.max(1e-300)).sqrt(), deepest)
}

/// The nearest point of the friction cone.
fn project([n, t]: [f64; 2]) -> [f64; 2] {
    if t.abs() <= FRICTION * n {
        [n, t]
    } else if FRICTION * t.abs() <= -n {
        [0.0, 0.0]
    } else {
        let normal = (n + FRICTION * t.abs()) / (1.0 + FRICTION * FRICTION);
        [normal, FRICTION * normal * t.signum()]
    }
}

fn main() -> Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [file, seconds, settings @ ..] = &words[..] else { return Err("pile FILE SECONDS KEY=VALUE…".into()) };
    let mut world = build(&std::fs::read_to_string(file)?)?;
    world.integration_parameters.dt = 1e-3;
    for setting in settings {
        match setting.split_once('=') {
            Some(("iterations", n)) => world.integration_parameters.num_solver_iterations = n.parse()?,
            Some(("step", h)) => world.integration_parameters.dt = h.parse()?,
            Some(("unit", m)) => world.integration_parameters.length_unit = m.parse()?,
            _ => return Err(format!("no setting «{setting}»").into()),
        }
    }
    let step = world.integration_parameters.dt;
    let part = (seconds.parse::<f64>()? / step / 10.0).round() as usize;
    let mut last: Vec<Vector> = Vec::new();
    for k in 1..=10 {
        let clock = ProcessTime::now();
        for _ in 0..part {
            world.step();
        }
        let us = 1e6 * clock.elapsed().as_secs_f64() / part as f64;
        let (carrying, residual, penetration) = judged(&world);
        let kinetic: f64 = world.bodies.iter().map(|(_, body)| body.kinetic_energy()).sum();
        let places: Vec<Vector> = world.bodies.iter().map(|(_, body)| body.translation()).collect();
        let moved = last.iter().zip(&places).map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max);
        last = places;
        println!(
            "t {:.2} {us:.1} us/step, contacts {carrying}, residual {residual:.1e}, penetration {penetration:.1e}, kinetic {kinetic:.2e}, moved {moved:.1e}",
            (k * part) as f64 * step
        );
    }
    Ok(())
}
