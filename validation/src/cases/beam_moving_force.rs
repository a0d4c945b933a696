//! A constant force that crosses a beam: Frýba's series.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::exact::beams::Uniform;
use crate::exact::beams::moving_force::Crossing;
use std::f64::consts::PI;
use teeter_beam::{Beam, BeamSpec, Damping, Load, MatrixWeights, MovingLoad, Section};

pub(crate) struct BeamMovingForce;

const BEAM: Uniform = Uniform { span: 0.37, bending: 0.58, mass: 0.12 };
const FORCE: f64 = -3.3;

/// Elements, and steps per passage: four times as many for twice the elements, so that both errors fall alike.
const REFINEMENTS: [(usize, u32); 3] = [(10, 800), (20, 3200), (40, 12_800)];

impl Case for BeamMovingForce {
    fn name(&self) -> &'static str {
        "beam_moving_force"
    }

    fn about(&self) -> &'static str {
        "A force crosses a pinned–pinned beam at 0.3 and 0.8 of the critical speed (π/L)√(EI/ρA), with 5 % damping in \
         the first mode and without: the deflection at midspan when the force is there, at 0.7 of the passage, and \
         in free vibration at 1.3 of it, compared with Frýba's series. Trapezoidal rule (θ = 1/2), 10, 20, 40 \
         elements, 800, 3200, 12800 steps per passage. When the force enters the beam, it excites mode j with an \
         amplitude that decreases only like j⁻⁵; the phase of the discrete mode lags by the fractions (ω_j h)²/12 \
         and (jπ/n)⁴/1440. The bound is the sum over all modes of amplitude times lag, at most twice the amplitude: \
         of order 4/3 in the step, 8/3 in the element length. Errors and bounds are relative to P L³/(48 EI)."
    }

    fn run(&self, _: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        let scale = FORCE.abs() * BEAM.span.powi(3) / (48.0 * BEAM.bending);
        let omega = BEAM.frequency(PI);
        for (speed, ratio) in [(0.3, 0.0), (0.3, 0.05), (0.8, 0.05)] {
            let known =
                Crossing { beam: BEAM, force: FORCE, speed: speed * omega * BEAM.span / PI, decay: ratio * omega };
            for (elements, steps) in REFINEMENTS {
                let found = midspan(&known, elements, steps)?;
                for (found, part) in found.into_iter().zip(PARTS) {
                    let exact = known.deflection(0.5 * BEAM.span, part * known.passage());
                    let bound = discretisation_error(&known, elements, steps, part) / scale;
                    findings.checks.push(Check {
                        error: Some((found - exact).abs() / scale),
                        ..Check::absolute(
                            format!("speed {speed}, damping {ratio}, {elements} elements, at {part}: w, m"),
                            exact,
                            found,
                            bound,
                        )
                    });
                }
            }
        }
        Ok(findings)
    }
}

/// The sum over the modes that move midspan of their free amplitude times their lag, m, at a part of the passage.
fn discretisation_error(crossing: &Crossing, elements: usize, steps: u32, part: f64) -> f64 {
    let (t, h) = (part * crossing.passage(), crossing.passage() / f64::from(steps));
    // Leaving the beam excites the modes a second time.
    let times = if part > 1.0 { 2.0 } else { 1.0 };
    let unit = 2.0 * FORCE.abs() / (BEAM.mass * BEAM.span);
    let terms = (1..2000_u32).step_by(2).map(|j| {
        let order = f64::from(j);
        let (omega, forcing) = (BEAM.frequency(order * PI), order * PI * crossing.speed / BEAM.span);
        let amplitude = unit * forcing / (omega * (omega * omega - forcing * forcing));
        let lag = omega * t * ((omega * h).powi(2) / 12.0 + (order * PI / elements as f64).powi(4) / 1440.0);
        amplitude * lag.min(2.0)
    });
    times * terms.sum::<f64>()
}

/// Times told, in parts of the passage; with the steps above all are ends of steps.
const PARTS: [f64; 3] = [0.5, 0.7, 1.3];

/// w at midspan at the three times.
fn midspan(crossing: &Crossing, elements: usize, steps: u32) -> Result<[f64; 3]> {
    let damping = Damping::none().with_viscous(2.0 * BEAM.mass * crossing.decay);
    let section = Section::new(BEAM.bending, BEAM.mass)?;
    let beam = Beam::new(BeamSpec::new(BEAM.span, elements, section).damped(damping))?;
    let load = MovingLoad::new(crossing.force, crossing.speed, 0.0)?;
    let h = crossing.passage() / f64::from(steps);
    let factor = beam.factor(MatrixWeights { mass: 1.0, damping: 0.5 * h, stiffness: 0.25 * h * h })?;
    let zero = vec![0.0; beam.dofs()];
    let (mut q, mut v) = (zero.clone(), zero.clone());
    let mut told = [f64::NAN; 3];
    let last = (1.3 * f64::from(steps)).round() as u32;
    for k in 0..last {
        // (M + hC/2 + h²K/4) Δv = h [P̄ − K(q + hv/2) − Cv]
        let mut right = zero.clone();
        load.add_mean(&beam, [f64::from(k) * h, f64::from(k + 1) * h], &mut zero.clone(), &mut right);
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
