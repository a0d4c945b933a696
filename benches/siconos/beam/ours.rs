//! The scenes of `theirs.cpp` in our program's steps, measured and told in the same way.
//!
//! ```text
//! ours rocking|free ELEMENTS STEPS WARM     a line of JSON: µs a step, and where the motion got to
//! ```
#![allow(clippy::print_stdout)] // its output is what it is for

use nalgebra::Vector2;
use std::error::Error;
use std::f64::consts::PI;
use std::sync::Arc;
use std::time::Instant;
use teeter_beam::{Beam, BeamError, BeamSpec, Section};
use teeter_detect::{Kinematics, PointDetector, PointPair};
use teeter_integrator::{
    BeamBody, BeamSurface, Block, Blocks, ModelBuilder, MoreauJean, MoreauJeanSettings, PairLaw, Scheme,
    SolverSettings, State, Workspace,
};
use teeter_rigid::{MassProperties, Rectangle};
use teeter_solvers::Auto;

/// s.
const DT: f64 = 1e-4;
/// m.
const SPAN: f64 = 0.36;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scene, elements, steps, warm] = &arguments[..] else {
        return Err("usage: ours rocking|free ELEMENTS STEPS WARM".into());
    };
    let (elements, steps, warm): (usize, u32, u32) = (elements.parse()?, steps.parse()?, warm.parse()?);
    let rocking = scene == "rocking";
    let beam = Arc::new(beam(elements)?);
    let mut parts = ModelBuilder::new();
    let (mut q, mut pairs) = (Vec::new(), Vec::new());
    let body = BeamBody::new(beam.clone(), Vector2::zeros(), BeamSurface::Axis);
    if rocking {
        let shape = Rectangle::new(0.03, 0.135)?;
        let mass = MassProperties::rectangle(&shape, 0.03, 2700.0)?;
        let block = parts.add(Blocks::new(vec![Block::new(mass, &shape)], Vector2::new(0.0, -9.81))).body();
        let surface = parts.add(body).body();
        let points: Vec<_> = shape.corners().iter().filter(|corner| corner.y < 0.0).copied().collect();
        // Its lower left corner at x = 0.165 on the straight axis, tilted by 5°.
        let tilt = 5.0_f64.to_radians();
        let ((sin, cos), corner) = (tilt.sin_cos(), Vector2::new(-0.015, -0.0675));
        let centre = [0.165 - (cos * corner.x - sin * corner.y), -(sin * corner.x + cos * corner.y)];
        q.extend([centre[0], centre[1], tilt]);
        let law = parts.law(PairLaw::new(0.5, 0.0));
        pairs.push(PointPair { pair: 0, law, points, body: block, surface, kinematics: Kinematics::Deformed });
    } else {
        parts.add(body);
    }
    let model = parts.build(Box::new(PointDetector::new(pairs)))?;
    let at_beam = q.len();
    q.extend(if rocking { vec![0.0; beam.dofs()] } else { first_mode(&beam)? });
    let mut scheme = MoreauJean::new(MoreauJeanSettings::default())?;
    let mut work = Workspace::new(&model, Box::new(Auto::new()), SolverSettings::default());
    let mut state = State::new(&model, &q, &vec![0.0; model.size().v], DT)?;
    Scheme::<2>::start(&mut scheme, &model, &mut state, &mut work)?;
    for _ in 0..warm {
        scheme.advance(&model, &mut state, f64::INFINITY, &mut work)?;
    }
    let start = Instant::now();
    for _ in 0..steps {
        scheme.advance(&model, &mut state, f64::INFINITY, &mut work)?;
    }
    let spent = start.elapsed().as_secs_f64();
    let us = 1e6 * spent / f64::from(steps);
    let time = f64::from(steps + warm) * DT;
    let phi = if rocking { state.q[2].to_degrees() } else { 0.0 };
    let w = beam.deflection_at(&state.q[at_beam..], 0.5 * SPAN).ok_or("midspan is on the beam")?.w;
    println!("{{\"us\": {us:.6}, \"time\": {time:.6}, \"phi\": {phi:.12}, \"w\": {w:.12e}}}");
    Ok(())
}

/// That of the source paper, undamped.
fn beam(elements: usize) -> Result<Beam, Box<dyn Error>> {
    let section = Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?;
    Ok(Beam::new(BeamSpec::new(SPAN, elements, section))?)
}

/// Its first mode, 1 mm at midspan.
fn first_mode(beam: &Beam) -> Result<Vec<f64>, BeamError> {
    let last = (beam.nodes() - 1) as f64;
    let at = |node: usize| (PI * node as f64 / last).sin_cos();
    let nodes: Vec<_> = (0..beam.nodes()).map(at).map(|(sin, cos)| [1e-3 * sin, 1e-3 * PI / SPAN * cos]).collect();
    beam.from_nodes(&nodes)
}
