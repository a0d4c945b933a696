//! Static deflection at the nodes against closed forms.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::exact::beam::{SUPPORTS, under_force, under_uniform_load};
use teeter_beam::{Beam, BeamSpec, Section, Support};

pub(crate) struct BeamStatics;

/// Where the force acts, in parts of the span: inside an element of nearly every mesh, at a node of few.
const FORCE_AT: f64 = 0.3;

/// Largest error relative to the largest deflection. Cubic elements are exact at their nodes, so this is rounding: with
/// a plain Cholesky solve it would grow like n⁴ to some 1e-8, which this bound would catch.
const BOUND: f64 = 1e-12;

impl Case for BeamStatics {
    fn name(&self) -> &'static str {
        "beam_statics"
    }

    fn about(&self) -> &'static str {
        "Deflection of a beam at its nodes, meshes of 2, 3, …, 100 elements, under a force at 0.3 of the span and \
         under a uniform load, compared with closed forms. Cubic elements with consistent loads are exact at their \
         nodes; the error, relative to the largest deflection, is the rounding of the solve."
    }

    fn run(&self, _: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        for (name, supports) in SUPPORTS {
            let mut worst = [0.0_f64; 2];
            for elements in 2..=100 {
                let errors = errors(supports, elements)?;
                worst = [worst[0].max(errors[0]), worst[1].max(errors[1])];
            }
            for (load, worst) in ["force at 0.3 L", "uniform load"].iter().zip(worst) {
                let quantity = format!("{name}, {load}: worst node, 2 to 100 elements, relative");
                findings.checks.push(Check::worst(quantity, worst, BOUND));
            }
        }
        Ok(findings)
    }
}

/// The worst node's error under a force and under a uniform load.
fn errors(supports: [Support; 2], elements: usize) -> Result<[f64; 2]> {
    // No round numbers: nothing is exact by luck.
    let (span, stiffness) = (0.37, 0.58);
    let spec = BeamSpec::new(span, elements, Section::new(stiffness, 0.12)?).supported(supports);
    let beam = Beam::new(spec)?;
    let (force, load) = (-3.3, -21.0);
    let mut q = vec![0.0; beam.dofs()];
    beam.add_point_load(FORCE_AT * span, force, &mut q)?;
    beam.solve_static(&mut q)?;
    let unit = force * span.powi(3) / stiffness;
    let by_force = worst_node(&beam, &q, |x| under_force(supports, FORCE_AT, x).map(|w| w * unit))?;
    q.fill(0.0);
    beam.add_uniform_load(load, &mut q)?;
    beam.solve_static(&mut q)?;
    let unit = load * span.powi(4) / stiffness;
    let by_load = worst_node(&beam, &q, |x| under_uniform_load(supports, x).map(|w| w * unit))?;
    Ok([by_force, by_load])
}

fn worst_node(beam: &Beam, q: &[f64], exact: impl Fn(f64) -> Option<f64>) -> Result<f64> {
    let (mut largest, mut error) = (0.0_f64, 0.0_f64);
    let nodes = beam.to_nodes(q);
    for (node, [w, _]) in nodes.iter().enumerate() {
        let x = node as f64 / (nodes.len() - 1) as f64;
        let exact = exact(x).ok_or("supports without a closed form")?;
        largest = largest.max(exact.abs());
        // Written so that NaN is worst of all.
        if !((w - exact).abs() <= error) {
            error = (w - exact).abs();
        }
    }
    Ok(error / largest)
}
