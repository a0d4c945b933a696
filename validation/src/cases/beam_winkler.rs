//! Statics on Winkler's foundation: a beam on pins, and one so long that its ends don't count.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::exact::beams::Uniform;
use crate::exact::beams::winkler::{
    decay, endless_moment, endless_under_force, pinned_midspan_moment, pinned_under_uniform_load,
};
use crate::fit::power_law;
use teeter_beam::{Actions, Beam, BeamSpec, Foundation, Section, SpanLoad, Support};

pub(crate) struct BeamWinkler;

const BEAM: Uniform = Uniform { span: 2.0, bending: 0.58, mass: 0.12 };
const STIFFNESS: f64 = 40.0;
const MESHES: [usize; 4] = [4, 8, 16, 32];

impl Case for BeamWinkler {
    fn name(&self) -> &'static str {
        "beam_winkler"
    }

    fn about(&self) -> &'static str {
        "Static deflection and bending moment at midspan of a pinned–pinned beam on Winkler's foundation under a \
         uniform load, and under a force in the middle of a practically infinite beam (12 decay lengths on either \
         side); errors over 4 to 32 elements (8 times as many for the long beam) and their order: 4 for the \
         deflection of the finite elements, 2 or better for moments."
    }

    fn run(&self, _: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        let load = -3.0;
        let pinned = |n: usize| -> Result<[f64; 2]> {
            let middle = 0.5 * BEAM.span;
            let [w, m] = bent(BEAM.span, n, Support::Pinned, SpanLoad::Uniform { from: 0.0, to: BEAM.span, load })?;
            let exact = pinned_under_uniform_load(BEAM, STIFFNESS, load, middle);
            Ok([w / exact - 1.0, m / pinned_midspan_moment(BEAM, STIFFNESS, load) - 1.0])
        };
        let decay = decay(BEAM.bending, STIFFNESS);
        let endless = |n: usize| -> Result<[f64; 2]> {
            let span = 24.0 / decay;
            let [w, m] = bent(span, 8 * n, Support::Free, SpanLoad::Point { x: 0.5 * span, force: load, couple: 0.0 })?;
            let exact = endless_under_force(BEAM.bending, STIFFNESS, load, 0.0);
            Ok([w / exact - 1.0, m / endless_moment(BEAM.bending, STIFFNESS, load, 0.0) - 1.0])
        };
        type Errors<'a> = &'a dyn Fn(usize) -> Result<[f64; 2]>;
        let cases: [(&str, Errors<'_>); 2] = [("pinned, uniform load", &pinned), ("infinite beam, force", &endless)];
        for (what, errors) in cases {
            let found = MESHES.iter().map(|n| Ok((*n, errors(*n)?))).collect::<Result<Vec<_>>>()?;
            for (k, quantity, order, last) in [(0, "deflection", 4.0, 1e-5), (1, "moment", 2.0, 1e-3)] {
                let points: Vec<(f64, f64)> = found.iter().map(|(n, e)| (1.0 / *n as f64, e[k].abs())).collect();
                let fitted = power_law(&points).order;
                let name = format!("{what}: {quantity} at midspan, order");
                // A higher order than asked for is no fault.
                findings.checks.push(Check::worst(name, (order - fitted).max(0.0), 0.2));
                let name = format!("{what}: {quantity} at midspan, finest mesh, relative error");
                findings.checks.push(Check::worst(name, points[MESHES.len() - 1].1, last));
            }
        }
        Ok(findings)
    }
}

/// Deflection and moment in the middle.
fn bent(span: f64, elements: usize, support: Support, load: SpanLoad) -> Result<[f64; 2]> {
    let section = Section::new(BEAM.bending, BEAM.mass)?;
    let foundation = Foundation::new(0.0, span, STIFFNESS);
    let beam = Beam::new(BeamSpec::new(span, elements, section).supported([support; 2]).foundation(foundation))?;
    let mut q = vec![0.0; beam.dofs()];
    match load {
        SpanLoad::Uniform { load, .. } => beam.add_uniform_load(load, &mut q)?,
        SpanLoad::Point { x, force, .. } => beam.add_point_load(x, force, &mut q)?,
        _ => {}
    }
    beam.solve_static(&mut q)?;
    let forces = beam.section_forces(&Actions::at(&q).with_loads(&[load]))?;
    let middle = 0.5 * span;
    Ok([beam.deflection_at(&q, middle).ok_or("no middle")?.w, forces.at(&beam, middle)?.moment])
}
