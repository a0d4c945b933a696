//! The scenes of `compare.py` in rapier: jobs on standard input, an answer each (the protocol: ../README.md).
//!
//! rapier knows rigid bodies and joints. On the ground the block is one body on a half-space; the beam is a chain of rigid links
//! whose hinges are springs, the nearest that its joints come to a beam.
//!
//! | setting | is |
//! |---|---|
//! | `iterations` | solver iterations a step, each a substep |
//! | `sweeps` | PGS sweeps in each |
//! | `stabilisation` | sweeps without the contact's spring in each |
//! | `frequency`, `damping` | of the contact's spring, Hz and ratio |
//! | `unit` | length that counts as 1 |
//! | `recycle` | whether contacts are kept over steps |
//! | `bias` | whether friction acts along with the contact's spring |
//! | `top` | of a stack: how many times heavier its top box is |
//! | `prediction` | distance from which contacts are made, in units |

use cpu_time::ProcessTime;
use rapier2d_f64::{na, prelude::*};
use std::error::Error;
use std::io::{BufRead, Write};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Repetitions end here, however short a run is.
const MOST: usize = 51;

const WIDTH: f64 = 0.03;
const HEIGHT: f64 = 0.135;
const DEPTH: f64 = 0.03;
const DENSITY: f64 = 2700.0;
const FRICTION: f64 = 0.5;

/// Of a stack: the side of its boxes, m, and their density, kg/m³.
const BOX: f64 = 0.1;
const BOX_DENSITY: f64 = 700.0;

const SPAN: f64 = 0.36;
const THICKNESS: f64 = 0.0015;
const YOUNG: f64 = 69e9;
/// Which of a plane joint's three directions is the angle.
const ANGLE: usize = 2;

/// The block on its lower left corner, which is at (`corner`, 0), tilted by 5°.
fn block(world: &mut PhysicsWorld, corner: f64) -> RigidBodyHandle {
    let tilt = 5.0_f64.to_radians();
    let (sin, cos) = tilt.sin_cos();
    let (x, y) = (-0.5 * WIDTH, -0.5 * HEIGHT);
    let place = Vector::new(corner - (cos * x - sin * y), -(sin * x + cos * y));
    let body = RigidBodyBuilder::dynamic().translation(place).rotation(tilt).can_sleep(false);
    let shape = ColliderBuilder::cuboid(0.5 * WIDTH, 0.5 * HEIGHT)
        .density(DENSITY * DEPTH)
        .friction(FRICTION)
        .restitution(0.0)
        .collision_groups(InteractionGroups::new(Group::GROUP_1, Group::GROUP_2, InteractionTestMode::And));
    world.insert(body, shape).0
}

fn ground(world: &mut PhysicsWorld) {
    let shape = ColliderBuilder::halfspace(na::Unit::new_unchecked(Vector::Y)).friction(FRICTION);
    world.insert(RigidBodyBuilder::fixed(), shape);
}

/// Links of equal length, their hinges with the bending stiffness of a piece as long; the first is pinned, the last on a roller. The
/// upper side of a link is the axis.
fn chain(world: &mut PhysicsWorld, links: usize) -> Result<()> {
    let length = SPAN / links as f64;
    let stiffness = YOUNG * DEPTH * THICKNESS.powi(3) / 12.0 / length;
    let support = world.insert_body(RigidBodyBuilder::fixed());
    let mut before = support;
    for link in 0..links {
        let place = Vector::new((link as f64 + 0.5) * length, 0.0);
        let body =
            world.insert_body(RigidBodyBuilder::dynamic().translation(place).gravity_scale(0.0).can_sleep(false));
        let shape = ColliderBuilder::cuboid(0.5 * length, 0.5 * THICKNESS)
            .translation(Vector::new(0.0, -0.5 * THICKNESS))
            .friction(FRICTION)
            .mass_properties(MassProperties::new(
                Vector::ZERO,
                DENSITY * DEPTH * THICKNESS * length,
                DENSITY * DEPTH * THICKNESS * length.powi(3) / 12.0,
            ))
            .collision_groups(InteractionGroups::new(Group::GROUP_2, Group::GROUP_1, InteractionTestMode::And));
        world.insert_collider(shape, Some(body));
        let hinge = RevoluteJointBuilder::new()
            .local_anchor1(Vector::new(if link == 0 { 0.0 } else { 0.5 * length }, 0.0))
            .local_anchor2(Vector::new(-0.5 * length, 0.0))
            .contacts_enabled(false);
        let joint = world.insert_multibody_joint(before, body, hinge);
        let (beam, at) = joint.and_then(|joint| world.multibody_joints.get_mut(joint)).ok_or("the chain is broken")?;
        // rapier damps the joints of a multibody unless told not to.
        beam.damping_mut().fill(0.0);
        if link > 0 {
            beam.link_mut(at).ok_or("the chain is broken")?.joint.set_spring(ANGLE, stiffness, 0.0);
        }
        before = body;
    }
    let roller = PinSlotJointBuilder::new(Vector::X)
        .local_anchor1(Vector::new(SPAN, 0.0))
        .local_anchor2(Vector::new(0.5 * length, 0.0))
        .contacts_enabled(false);
    world.insert_impulse_joint(support, before, roller);
    Ok(())
}

/// Boxes of 0.1 m on each other, the top one so many times heavier: that one.
fn stack(world: &mut PhysicsWorld, boxes: usize, heavier: f64) -> RigidBodyHandle {
    ground(world);
    let mut top = RigidBodyHandle::invalid();
    for k in 0..boxes {
        let body = RigidBodyBuilder::dynamic().translation(Vector::new(0.0, (k as f64 + 0.5) * BOX)).can_sleep(false);
        let density = BOX_DENSITY * BOX * if k + 1 == boxes { heavier } else { 1.0 };
        let shape = ColliderBuilder::cuboid(0.5 * BOX, 0.5 * BOX).density(density).friction(FRICTION).restitution(0.0);
        top = world.insert(body, shape).0;
    }
    top
}

fn build(scene: &str, elements: usize, step: f64, settings: &[&str]) -> Result<(PhysicsWorld, RigidBodyHandle)> {
    let mut world = PhysicsWorld::default();
    let mut top = 1.0;
    let parameters = &mut world.integration_parameters;
    parameters.dt = step;
    for setting in settings {
        let (key, value) = setting.split_once('=').ok_or_else(|| format!("«{setting}» is no KEY=VALUE"))?;
        let number: f64 = value.parse()?;
        match key {
            "iterations" => parameters.num_solver_iterations = number as usize,
            "sweeps" => parameters.num_internal_pgs_iterations = number as usize,
            "stabilisation" => parameters.num_internal_stabilization_iterations = number as usize,
            "frequency" => {
                parameters.contact_softness.natural_frequency = number;
                parameters.static_contact_softness.natural_frequency = number;
            }
            "damping" => {
                parameters.contact_softness.damping_ratio = number;
                parameters.static_contact_softness.damping_ratio = number;
            }
            "unit" => parameters.length_unit = number,
            "recycle" => parameters.contact_recycling = number != 0.0,
            "bias" => parameters.friction_in_bias_pass = number != 0.0,
            "top" => top = number,
            "prediction" => parameters.normalized_prediction_distance = number,
            other => return Err(format!("no setting «{other}»").into()),
        }
    }
    let body = match scene {
        "ground" => {
            ground(&mut world);
            block(&mut world, -0.5 * WIDTH)
        }
        "beam" => {
            chain(&mut world, elements)?;
            block(&mut world, 0.165)
        }
        "stack" => stack(&mut world, elements, top),
        other => return Err(format!("no scene «{other}»; there are ground, beam and stack").into()),
    };
    Ok((world, body))
}

fn job(line: &str) -> Result<Vec<f64>> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let [scene, elements, step, steps, budget, file, settings @ ..] = &words[..] else {
        return Err("a job is: SCENE ELEMENTS STEP STEPS BUDGET FILE KEY=VALUE…".into());
    };
    let (elements, step, steps, budget): (usize, f64, usize, f64) =
        (elements.parse()?, step.parse()?, steps.parse()?, budget.parse()?);
    let mut track: Vec<f64> = Vec::with_capacity(3 * (steps + 1));
    let (mut times, mut spent) = (Vec::new(), 0.0);
    while times.is_empty() || (spent < budget && times.len() < MOST) {
        let (mut world, body) = build(scene, elements, step, settings)?;
        let mut note = |world: &PhysicsWorld| {
            let body = &world.bodies[body];
            let (place, angle) = (body.translation(), body.rotation().angle());
            track.extend([place.x, place.y, angle]);
        };
        note(&world);
        let clock = ProcessTime::now();
        for _ in 0..steps {
            world.step();
            note(&world);
        }
        let time = clock.elapsed().as_secs_f64();
        spent += time;
        times.push(time);
        track.drain(..track.len() - 3 * (steps + 1));
    }
    let bytes: Vec<u8> = track.iter().flat_map(|x| x.to_le_bytes()).collect();
    std::fs::write(file, bytes)?;
    Ok(times)
}

fn main() -> Result<()> {
    for line in std::io::stdin().lock().lines() {
        match job(&line?) {
            Ok(times) => println!("{{\"cpu_s\": {times:?}}}"),
            Err(error) => println!("{{\"error\": {:?}}}", error.to_string()),
        }
        std::io::stdout().flush()?;
    }
    Ok(())
}
