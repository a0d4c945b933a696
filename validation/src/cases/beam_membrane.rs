//! Sag of a beam whose ends are held along the axis.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::exact::beams::membrane::{HeldBeam, Weight};
use crate::fit::power_law;
use teeter_beam::{Axial, Beam, BeamSpec, Section};

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
        "The source paper's beam between ends that can't approach each other, under the weight of its block at midspan and at 0.165 m, and spread over \
         the span: sag and tension against the tie's closed form with the root of N = (EA/2L)∫w'² dx. Between free ends it sags by 5.3 mm. The \
         shape under tension is no polynomial: order 4 at the nodes, fitted over 8 to 48 elements."
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
        Ok(findings)
    }
}
