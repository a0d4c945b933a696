//! Sag of a beam whose ends are held along the axis.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::exact::beams::Uniform;
use crate::exact::beams::duffing::Swing;
use crate::exact::beams::membrane::{HeldBeam, Weight};
use crate::fit::power_law;
use crate::scene::beam_body;
use std::f64::consts::PI;
use std::sync::Arc;
use teeter_beam::{Axial, Beam, BeamSpec, Section};
use teeter_detect::PointDetector;
use teeter_integrator::{ModelBuilder, MoreauJean, MoreauJeanSettings, Scheme, SolverSettings, State, Workspace};
use teeter_solvers::Auto;

pub(crate) struct BeamMembrane;

/// Midspan is a node of all, and the force at 0.165 m of 0.36 m of the last two.
const MESHES: [usize; 5] = [8, 12, 16, 24, 48];

/// Weight of the source paper's block, N.
const FORCE: f64 = -0.32805 * 9.81;

impl Case for BeamMembrane {
    fn name(&self) -> &'static str {
        "beam_membrane"
    }

    fn about(&self) -> &'static str {
        "The source paper's beam with axially held ends, under the weight of its block at midspan and at 0.165 m, and \
         distributed over the span: sag and tension compared with the closed form of a beam in tension with the root \
         of N = (EA/2L)∫w'² dx. With axially free ends it sags by 5.3 mm. The shape under tension isn't a \
         polynomial, so the order is 4 at the nodes, fitted over 8 to 48 elements. Released in its first mode at \
         twice the radius of gyration, it vibrates by Duffing's equation (Woinowsky-Krieger), whose period is an \
         elliptic integral: w at midspan after 2 1/4 periods of the θ scheme, θ = 1/2, order 2."
    }

    fn run(&self, _: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        let section = Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?;
        let span = 0.36;
        let known = HeldBeam { span, bending: section.bending_stiffness, axial: 69e9 * 0.03 * 0.0015 };
        let sag = |weight: Weight, at: f64, elements: usize| -> Result<(f64, f64)> {
            let beam = Beam::new(BeamSpec::new(span, elements, section).axial(Axial::Held))?;
            let mut q = vec![0.0; beam.dofs()];
            match weight {
                Weight::Force(x, p) => beam.add_point_load(x, p, &mut q)?,
                Weight::Uniform(p) => beam.add_uniform_load(p, &mut q)?,
            }
            beam.solve_static(&mut q)?;
            Ok((beam.deflection_at(&q, at).ok_or("a place on the beam")?.w, beam.axial_force(&q)))
        };
        for (name, weight, at, meshes) in [
            ("force at midspan", Weight::Force(0.18, FORCE), 0.18, &MESHES[..]),
            ("uniform load", Weight::Uniform(FORCE / span), 0.18, &MESHES[..]),
            ("force at 0.165 m", Weight::Force(0.165, FORCE), 0.165, &MESHES[3..]),
        ] {
            let (w, n) = (known.deflection(weight, at), known.tension(weight));
            let mut points = Vec::new();
            for &elements in meshes {
                points.push((1.0 / elements as f64, (sag(weight, at, elements)?.0 / w - 1.0).abs()));
            }
            let quantity = format!("{name}: order of the sag in the element length");
            findings.checks.push(Check::between(quantity, 4.0, power_law(&points).order, 3.8, 4.2));
            // (kl)⁴/720 with k² = N/EI, of the order of the error: 2e-7 for kL = 5.2.
            let (found, tension) = sag(weight, at, 48)?;
            let bound = (n / known.bending).powi(2) * (span / 48.0).powi(4) / 720.0;
            findings.checks.push(Check::relative(
                format!("{name}: sag there, 48 elements, m, relative"),
                w,
                found,
                bound,
            ));
            findings.checks.push(Check::relative(
                format!("{name}: tension, 48 elements, N, relative"),
                n,
                tension,
                bound,
            ));
        }
        let beam = Uniform { span, bending: section.bending_stiffness, mass: section.mass_per_length };
        let known = Swing { beam, axial: known.axial, mode: 1, amplitude: AMPLITUDE };
        let errors = swing_errors(&known, 40)?;
        let quantity = "free vibration: order in the step, after 2 1/4 periods, 40 elements";
        findings.checks.push(Check::between(quantity, 2.0, power_law(&errors).order, 1.9, 2.1));
        for (step, error) in errors {
            let quantity =
                format!("free vibration: w at midspan, {} steps per period, relative to the amplitude", 1.0 / step);
            // A linear swing is late by (ωh)²/12 of its phase, 4.5π; three times that for one that the membrane stiffens.
            findings.checks.push(Check::worst(quantity, error, 4.5 * PI * (2.0 * PI * step).powi(2) / 4.0));
        }
        Ok(findings)
    }
}

/// The free swing in the first mode; its amplitude, m: twice the radius of gyration, so that half of the stiffness is the membrane's.
const AMPLITUDE: f64 = 0.000_866;

/// Steps a period of the elliptic solution, and periods run.
const STEPS: [u32; 3] = [100, 200, 400];
const PERIODS: f64 = 2.25;

/// The errors of the shape at midspan after some periods with a mesh, relative to the amplitude, by steps.
fn swing_errors(known: &Swing, elements: usize) -> Result<Vec<(f64, f64)>> {
    let section = Section::new(known.beam.bending, known.beam.mass)?.with_axial_stiffness(known.axial)?;
    let beam = Arc::new(Beam::new(BeamSpec::new(known.beam.span, elements, section).axial(Axial::Held))?);
    let wave = |x: f64| (PI * x / known.beam.span).sin_cos();
    let slope = PI / known.beam.span;
    let nodes: Vec<_> = beam.node_positions().iter().map(|x| wave(*x)).collect();
    let start =
        beam.from_nodes(&nodes.iter().map(|(s, c)| [s * AMPLITUDE, c * slope * AMPLITUDE]).collect::<Vec<_>>())?;
    let mut parts = ModelBuilder::<2>::new();
    parts.add(beam_body(&beam));
    let model = parts.build(Box::new(PointDetector::new(Vec::new())))?;
    let mut errors = Vec::new();
    for steps in STEPS {
        let dt = known.period() / f64::from(steps);
        let mut scheme = MoreauJean::new(MoreauJeanSettings::default())?;
        let mut work = Workspace::new(&model, Box::new(Auto::new()), SolverSettings::default());
        let mut state = State::new(&model, &start, &vec![0.0; model.size().v], dt)?;
        Scheme::<2>::start(&mut scheme, &model, &mut state, &mut work)?;
        for _ in 0..(PERIODS * f64::from(steps)) as u32 {
            scheme.advance(&model, &mut state, f64::INFINITY, &mut work)?;
        }
        let found = beam.deflection_at(&state.q, 0.5 * known.beam.span).ok_or("midspan is on the beam")?.w;
        errors.push((1.0 / f64::from(steps), (found - known.amplitude_at(state.t)).abs() / AMPLITUDE));
    }
    Ok(errors)
}
