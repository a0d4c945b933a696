//! Natural frequencies of the finite elements against those of the continuous beam.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::exact::beam::{SUPPORTS, wave_numbers};
use crate::figure::{Axes, Figure, Series};
use crate::fit::power_law;
use crate::scene::paper_beam;
use teeter_beam::{Beam, BeamSpec, Section};

pub(crate) struct BeamFrequencies;

/// Meshes of the fits: from where mode 3 has some elements a half wave to where the error is still far above rounding.
const MESHES: [usize; 7] = [8, 12, 16, 24, 32, 48, 64];

/// Rounds of inverse iteration. The slowest pair of the cases, modes 3 and 4 of a pinned beam, gains (3/4)⁴ a round in
/// the vector and twice as many digits in the frequency: 1e-15 after some 60.
const ROUNDS: usize = 80;

impl Case for BeamFrequencies {
    fn name(&self) -> &'static str {
        "beam_frequencies"
    }

    fn about(&self) -> &'static str {
        "The first three frequencies of the finite elements (inverse iteration with the static solve, Rayleigh \
         quotient of the two energies), compared with (β_i/L)² √(EI/ρA) with the roots β_i of the frequency \
         equations. The error decreases with the fourth power of the element length; for a pinned beam it is (β_i \
         l/L)⁴/1440 to leading order. The order is fitted over meshes of 8 to 64 elements."
    }

    fn run(&self, _: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        let mut series = Vec::new();
        for (name, supports) in SUPPORTS {
            let betas = wave_numbers(supports).ok_or("supports without a frequency equation")?;
            let (span, stiffness, mass) = (0.37, 0.58_f64, 0.12);
            let mut points = [const { Vec::new() }; 3];
            for elements in MESHES {
                let section = Section::new(stiffness, mass)?;
                let beam = Beam::new(BeamSpec::new(span, elements, section).supported(supports))?;
                let found = lowest_frequencies(&beam)?;
                for (mode, (found, beta)) in found.iter().zip(betas).enumerate() {
                    let exact = (beta / span).powi(2) * (stiffness / mass).sqrt();
                    points[mode].push((1.0 / elements as f64, found / exact - 1.0));
                }
            }
            for (mode, points) in points.into_iter().enumerate() {
                let fit = power_law(&points);
                let quantity = format!("{name}, mode {}: order in the element length", mode + 1);
                findings.checks.push(Check::between(quantity, 4.0, fit.order, 3.9, 4.1));
                if name == "pinned–pinned" || name == "clamped–free" {
                    series.push(Series::marks(format!("{name}, mode {}", mode + 1), points.clone()));
                    let ends = [points[0].0, points[points.len() - 1].0];
                    series.push(Series::line(format!("order {:.3}", fit.order), ends.map(|x| (x, fit.at(x))).to_vec()));
                }
            }
        }
        let paper = paper_beam(20, 0.0)?;
        let exact = 166.700_937_859_116_52;
        let found = lowest_frequencies(&paper)?[0];
        // (π/20)⁴/1440 = 4.23e-7, and its next term.
        findings.checks.push(Check::relative(
            "the paper's beam, 20 elements: ω₁, rad/s, relative",
            exact,
            found,
            4.3e-7,
        ));
        findings.figures.push(Figure {
            file: "beam_frequencies.svg",
            title: "Frequencies of the finite elements",
            x: "Element length / span",
            axes: Axes::Logarithmic,
            y: "Relative error of the frequency",
            caption: "Relative error of the first three frequencies over the element length, with fitted lines.",
            series,
        });
        Ok(findings)
    }
}

/// The three lowest circular frequencies, rad/s.
fn lowest_frequencies(beam: &Beam) -> Result<[f64; 3]> {
    let mut modes: Vec<Vec<f64>> = Vec::new();
    let mut frequencies = [0.0; 3];
    for (mode, frequency) in frequencies.iter_mut().enumerate() {
        // Any start that isn't orthogonal to the mode.
        let mut x: Vec<f64> = (0..beam.dofs()).map(|i| (1.0 + i as f64 * (1.3 + mode as f64)).sin()).collect();
        let mut mass_times = vec![0.0; beam.dofs()];
        for _ in 0..ROUNDS {
            mass_times.fill(0.0);
            beam.add_mass_product(1.0, &x, &mut mass_times);
            x.copy_from_slice(&mass_times);
            beam.solve_static(&mut x)?;
            for found in &modes {
                remove(beam, found, &mut x);
            }
            let norm = (2.0 * beam.kinetic_energy(&x)).sqrt();
            x.iter_mut().for_each(|x| *x /= norm);
        }
        *frequency = (beam.elastic_energy(&x) / beam.kinetic_energy(&x)).sqrt();
        modes.push(x);
    }
    Ok(frequencies)
}

/// Takes out of `x` its part along a mode of unit modal mass.
fn remove(beam: &Beam, mode: &[f64], x: &mut [f64]) {
    let mut mass_times = vec![0.0; beam.dofs()];
    beam.add_mass_product(1.0, mode, &mut mass_times);
    let along: f64 = mass_times.iter().zip(x.iter()).map(|(a, b)| a * b).sum();
    x.iter_mut().zip(mode).for_each(|(x, m)| *x -= along * m);
}
