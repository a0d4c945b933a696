//! n_el × digits lost: what a solve loses on ever finer meshes, measured and as the program estimates it.

use super::Map;
use crate::case::Result;
use crate::exact::beam::under_force;
use crate::figure::{Axes, Figure, Series};
use teeter_beam::{Beam, BeamSpec, Digits, MatrixWeights, Section, Support};

const MESHES: [usize; 12] = [2, 3, 5, 10, 20, 50, 100, 200, 500, 1000, 1500, 2000];

const STATICS: MatrixWeights = MatrixWeights { mass: 0.0, damping: 0.0, stiffness: 1.0 };

/// Where the force acts, in parts of the span.
const FORCE_AT: f64 = 0.3;

const SUPPORTS: [Support; 2] = [Support::Clamped, Support::Free];

/// A cantilever of the paper's beam: of all supports it loses most.
fn cantilever(elements: usize) -> Result<Beam> {
    let section = Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?;
    Ok(Beam::new(BeamSpec::new(0.36, elements, section).supported(SUPPORTS))?)
}

fn step(h: f64) -> MatrixWeights {
    MatrixWeights { mass: 1.0, damping: 0.5 * h, stiffness: 0.25 * h * h }
}

/// Errors of the deflection at the nodes, relative to the largest: of one solve, and of the refined one.
fn errors(beam: &Beam) -> Result<[f64; 2]> {
    let spec = beam.spec();
    let mut load = vec![0.0; beam.dofs()];
    beam.add_point_load(FORCE_AT * spec.span, -1.0, &mut load)?;
    let mut plain = load.clone();
    beam.factor(STATICS)?.solve(&mut plain);
    beam.solve_static(&mut load)?;
    let unit = -spec.span.powi(3) / spec.section.bending_stiffness;
    let worst = |q: &[f64]| -> Result<f64> {
        let (mut error, mut largest) = (0.0_f64, 0.0_f64);
        let nodes = beam.to_nodes(q);
        for (node, [w, _]) in nodes.iter().enumerate() {
            let x = node as f64 / (nodes.len() - 1) as f64;
            let exact = unit * under_force(SUPPORTS, FORCE_AT, x).ok_or("supports without a closed form")?;
            (error, largest) = (error.max((w - exact).abs()), largest.max(exact.abs()));
        }
        // An axis of a logarithm has no place for zero.
        Ok((error / largest).max(f64::EPSILON))
    };
    Ok([worst(&plain)?, worst(&load)?])
}

/// The most elements with which a solve keeps the digits that a result needs, by bisection; at most the finest mesh.
fn keeps(weights: MatrixWeights) -> Result<usize> {
    let good =
        |elements: usize| -> Result<bool> { Ok(cantilever(elements)?.digits(weights)?.of_solve() >= Digits::FEW) };
    let (mut low, mut high) = (MESHES[0], MESHES[MESHES.len() - 1]);
    if good(high)? {
        return Ok(high);
    }
    while high - low > 1 {
        let middle = usize::midpoint(low, high);
        if good(middle)? {
            low = middle;
        } else {
            high = middle;
        }
    }
    Ok(low)
}

pub(super) fn map() -> Result<Map> {
    let names = ["one solve, measured", "refined, measured"];
    let [mut plain, mut refined, mut estimated, mut settled] = std::array::from_fn(|_| Vec::new());
    let steps = [1e-4, 1e-2, 1.0];
    let mut of_steps = steps.map(|_| Vec::new());
    for elements in MESHES {
        let (beam, n) = (cantilever(elements)?, elements as f64);
        let [one, more] = errors(&beam)?;
        let digits = beam.digits(STATICS)?;
        plain.push((n, one));
        refined.push((n, more));
        estimated.push((n, digits.solve));
        settled.push((n, digits.refined));
        for (points, h) in of_steps.iter_mut().zip(steps) {
            points.push((n, beam.digits(step(h))?.solve));
        }
    }
    let kept = [keeps(STATICS)?, keeps(step(1e-2))?, keeps(step(1e-4))?];
    let told = |n: usize| if n == MESHES[MESHES.len() - 1] { format!("{n} and more") } else { n.to_string() };
    let finest = |points: &[(f64, f64)]| points.last().map_or(f64::NAN, |point| point.1);
    let says = format!(
        "One solve keeps six digits up to {} elements in statics, {} in a step of 10 ms and {} in one of 100 µs; with refinement, as for a \
         static start, {:.0e} is lost at 2000 elements (one solve: {:.0e}).",
        told(kept[0]),
        told(kept[1]),
        told(kept[2]),
        finest(&refined),
        finest(&plain)
    );
    let mut series = vec![
        Series::marks(names[0], plain),
        Series::line("the same, as Beam::digits estimates it", estimated),
        Series::marks(names[1], refined),
        Series::line("the same, as Beam::digits estimates it", settled),
    ];
    let names = ["a step of 100 us, estimated", "a step of 10 ms, estimated", "a step of 1 s, estimated"];
    series.extend(names.into_iter().zip(of_steps).map(|(name, points)| Series::curve(name, points)));
    Ok(Map {
        title: "n_el × digits lost",
        about: "A cantilever with the section of the paper's beam, the supports that lose most digits, under a force \
             at 0.3 of the span: the largest nodal error relative to the closed form, which is all rounding, as \
             cubic elements are exact there; and the program's own estimate, of which `check` warns below six \
             digits. For a step the matrix includes the mass.",
        says,
        figures: vec![Figure {
            file: "extremes-mesh-digits.svg",
            title: "Digits lost to rounding in a solve",
            x: "Elements",
            y: "Error / largest deflection",
            axes: Axes::Logarithmic,
            caption: "",
            series,
        }],
    })
}
