//! How fast modes decay.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::exact::beams::Uniform;
use crate::exact::beams::decay::{rayleigh, rayleigh_through, viscous};
use crate::modes::lowest_modes;
use std::f64::consts::PI;
use teeter_beam::{Beam, BeamSpec, Damping, DampingRatio, Section};

pub(crate) struct BeamDamping;

const BEAM: Uniform = Uniform { span: 0.37, bending: 0.58, mass: 0.12 };
const ELEMENTS: usize = 40;

impl Case for BeamDamping {
    fn name(&self) -> &'static str {
        "beam_damping"
    }

    fn about(&self) -> &'static str {
        "Decay rates φᵀCφ/(2 φᵀMφ) of the first five modes of a pinned–pinned beam of 40 elements: with viscous \
         damping c/(2ρA) in all modes, to rounding; with Rayleigh damping (a₀ + a₁ω²)/2, fitted to 2 % in mode 1 and \
         5 % in mode 4, where a₁ω² has the relative error of ω², (β l/L)⁴/720."
    }

    fn run(&self, _: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        let omegas = [1, 2, 3, 4, 5].map(|i| BEAM.frequency(f64::from(i) * PI));
        let c = 0.7;
        let found = rates(Damping::none().with_viscous(c), omegas[0])?;
        for (mode, found) in (1..).zip(found) {
            let quantity = format!("viscous, mode {mode}: decay rate, 1/s, relative");
            findings.checks.push(Check::relative(quantity, viscous(c, BEAM.mass), found, 1e-12));
        }
        let ratios = [(omegas[0], 0.02), (omegas[3], 0.05)];
        let [a0, a1] = rayleigh_through(ratios);
        let found = rates(Damping::rayleigh(ratios.map(|(omega, zeta)| DampingRatio::new(omega, zeta)))?, omegas[0])?;
        for ((mode, found), omega) in (1..).zip(found).zip(omegas) {
            let quantity = format!("Rayleigh, mode {mode}: decay rate, 1/s, relative");
            let bound = (f64::from(mode) * PI / ELEMENTS as f64).powi(4) / 720.0;
            findings.checks.push(Check::relative(quantity, rayleigh(a0, a1, omega), found, bound));
        }
        Ok(findings)
    }
}

fn rates(damping: Damping, scale: f64) -> Result<Vec<f64>> {
    let section = Section::new(BEAM.bending, BEAM.mass)?;
    let beam = Beam::new(BeamSpec::new(BEAM.span, ELEMENTS, section).damped(damping))?;
    let rate = |shape: &[f64]| {
        let mut force = vec![0.0; beam.dofs()];
        beam.add_damping_product(1.0, shape, &mut force);
        let power: f64 = force.iter().zip(shape).map(|(f, v)| f * v).sum();
        power / (4.0 * beam.kinetic_energy(shape))
    };
    Ok(lowest_modes(&beam, scale, 5)?.iter().map(|(_, shape)| rate(shape)).collect())
}
