//! A constant force that crosses a beam: Frýba's series.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::exact::beams::Uniform;
use crate::exact::beams::moving_force::Crossing;
use crate::fit::power_law;
use std::f64::consts::PI;
use teeter_beam::{Beam, BeamSpec, Damping, Load, MatrixWeights, MovingLoad, Section};

pub(crate) struct BeamMovingForce;

const BEAM: Uniform = Uniform { span: 0.37, bending: 0.58, mass: 0.12 };
const ELEMENTS: usize = 20;
const FORCE: f64 = -3.3;

/// Steps per passage. The coarsest resolves the second mode; with the finest the error of the mesh is still far below that of the step.
const STEPS: [u32; 4] = [400, 800, 1600, 3200];

impl Case for BeamMovingForce {
    fn name(&self) -> &'static str {
        "beam_moving_force"
    }

    fn about(&self) -> &'static str {
        "A force crosses a pinned–pinned beam of 20 elements at 0.3 and 0.8 of the critical speed (π/L)√(EI/ρA), with 5 % of damping in the first mode and \
         without: midspan when the force is there, at 0.7 of the passage, and free, at 1.3 of it, against Frýba's series. Trapezoidal rule (θ = 1/2), 400 to \
         3200 steps a passage: order 2. Errors are relative to the largest deflection under the force at rest, P L³/(48 EI)."
    }

    fn run(&self, _: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        let scale = FORCE.abs() * BEAM.span.powi(3) / (48.0 * BEAM.bending);
        let omega = BEAM.frequency(PI);
        for (speed, ratio) in [(0.3, 0.0), (0.3, 0.05), (0.8, 0.05)] {
            let known =
                Crossing { beam: BEAM, force: FORCE, speed: speed * omega * BEAM.span / PI, decay: ratio * omega };
            let mut errors = [const { Vec::new() }; 3];
            let mut last = [0.0; 3];
            for steps in STEPS {
                last = midspan(&known, steps)?;
                for ((errors, found), part) in errors.iter_mut().zip(last).zip(PARTS) {
                    let exact = known.deflection(0.5 * BEAM.span, part * known.passage());
                    errors.push((1.0 / f64::from(steps), (found - exact).abs() / scale));
                }
            }
            for ((errors, found), part) in errors.iter().zip(last).zip(PARTS) {
                let name = format!("speed {speed}, damping {ratio}, at {part} of the passage");
                let exact = known.deflection(0.5 * BEAM.span, part * known.passage());
                let order = power_law(errors).order;
                findings.checks.push(Check::between(format!("{name}: order in the step"), 2.0, order, 1.8, 2.2));
                // The first mode's phase is late by (ω h)²/12 of it: of some four radians, (π/0.3/3200)² 4/12.
                let error = (found - exact).abs() / scale;
                let check = Check { error: Some(error), ..Check::absolute("", exact, found, 2e-6) };
                findings.checks.push(Check { quantity: format!("{name}: w at midspan, m, 3200 steps"), ..check });
            }
        }
        Ok(findings)
    }
}

/// Times told, in parts of the passage; with the steps above all are ends of steps.
const PARTS: [f64; 3] = [0.5, 0.7, 1.3];

/// w at midspan at the three times.
fn midspan(crossing: &Crossing, steps: u32) -> Result<[f64; 3]> {
    let damping = Damping { viscous: 2.0 * BEAM.mass * crossing.decay, ..Damping::default() };
    let section = Section::new(BEAM.bending, BEAM.mass)?;
    let beam = Beam::new(BeamSpec::new(BEAM.span, ELEMENTS, section).damped(damping))?;
    let load = MovingLoad::new(crossing.force, crossing.speed, 0.0)?;
    let h = crossing.passage() / f64::from(steps);
    let factor = beam.factor(MatrixWeights { mass: 1.0, damping: 0.5 * h, stiffness: 0.25 * h * h })?;
    let zero = vec![0.0; beam.dofs()];
    let (mut q, mut v) = (zero.clone(), zero.clone());
    let mut told = [f64::NAN; 3];
    let last = (1.3 * f64::from(steps)).round() as u32;
    for k in 0..last {
        // (M + hC/2 + h²K/4) Δv = h [(P⁰ + P¹)/2 − K(q + hv/2) − Cv]
        let mut right = zero.clone();
        for t in [f64::from(k) * h, f64::from(k + 1) * h] {
            load.add(&beam, t, &mut right);
        }
        right.iter_mut().for_each(|p| *p *= 0.5);
        let predicted: Vec<f64> = q.iter().zip(&v).map(|(q, v)| q + 0.5 * h * v).collect();
        beam.add_stiffness_product(-1.0, &predicted, &mut right);
        beam.add_damping_product(-1.0, &v, &mut right);
        right.iter_mut().for_each(|p| *p *= h);
        factor.solve(&mut right);
        for ((q, v), change) in q.iter_mut().zip(&mut v).zip(&right) {
            *q += h * (*v + 0.5 * change);
            *v += change;
        }
        for (told, part) in told.iter_mut().zip(PARTS) {
            if k + 1 == (part * f64::from(steps)).round() as u32 {
                *told = beam.deflection_at(&q, 0.5 * BEAM.span).ok_or("midspan is on the beam")?.w;
            }
        }
    }
    Ok(told)
}
