//! An elastic bar against a rigid wall.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::exact::beams::bar_impact::Bar;
use crate::fit::power_law;
use teeter_beam::{Axial, Beam, BeamSpec, MatrixWeights, Section, Support};

pub(crate) struct BarImpact;

const BAR: Bar = Bar { young: 210e9, density: 7800.0, area: 3.14e-4, length: 1.0, speed: 0.1, gap: 5e-5 };

/// Elements; a step is the time in which the wave passes one.
const MESHES: [usize; 3] = [100, 400, 1600];

impl Case for BarImpact {
    fn name(&self) -> &'static str {
        "bar_impact"
    }

    fn about(&self) -> &'static str {
        "St-Venant's bar (E 210e9, ρ 7800, A 3.14e-4, L 1, v 0.1, gap 5e-5) as a beam with axial dofs whose left end \
         hits a rigid wall: Moreau–Jean θ = 1/2, e = 0, one step per element and wave passage, the contact solved in \
         the case itself. Compared with d'Alembert's solution: the mean force over the exact time of contact, the \
         last time of a contact force, and in the middle of the contact the mean error of u, relative to the gap. \
         Linear elements are least accurate at a velocity front: their dispersion smears it over a fraction \
         (l/L)^{2/3} of the bar, and force and release converge with this order."
    }

    fn run(&self, depth: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        let meshes = if depth == Depth::Full { &MESHES[..] } else { &MESHES[..2] };
        let mut errors = Vec::new();
        let [_, end] = BAR.contact();
        for &elements in meshes {
            let (found, part) = (fly(elements)?, 1.0 / elements as f64);
            let smeared = 0.25 * part.powf(2.0 / 3.0);
            let name = |what: &str| format!("{elements} elements: {what}");
            findings.checks.push(Check::relative(name("mean force, N, relative"), BAR.force(), found.force, smeared));
            let bound = smeared * BAR.duration();
            findings.checks.push(Check::absolute(name("release, s"), end, found.release, bound));
            // The wall is met at the end of a step: by the way of one at most.
            let way = BAR.speed * part * BAR.length / BAR.wave_speed() / BAR.gap;
            findings.checks.push(Check::worst(
                name("u at half of the contact, mean, relative to the gap"),
                found.shape,
                way,
            ));
            errors.push((part, (found.force / BAR.force() - 1.0).abs()));
        }
        let order = power_law(&errors).order;
        findings.checks.push(Check::between(
            "order of the mean force in the element length",
            2.0 / 3.0,
            order,
            0.6,
            0.75,
        ));
        Ok(findings)
    }
}

/// What a bar of finite elements does.
struct Flight {
    /// All impulse over the exact time of contact, N.
    force: f64,
    /// End of the last step in which the wall pushes, s.
    release: f64,
    /// Mean error of u at half of the contact, relative to the gap.
    shape: f64,
}

fn fly(elements: usize) -> Result<Flight> {
    // How it bends doesn't matter; it flies straight.
    let section = Section::new(1.0, BAR.density * BAR.area)?.with_axial_stiffness(BAR.young * BAR.area)?;
    let spec = BeamSpec::new(BAR.length, elements, section).supported([Support::Free; 2]);
    let beam = Beam::new(spec.axial(Axial::elastic([false, false])))?;
    let h = BAR.length / elements as f64 / BAR.wave_speed();
    let factor = beam.factor(MatrixWeights { mass: 1.0, damping: 0.0, stiffness: 0.25 * h * h })?;
    let axial = 2 * beam.nodes();
    // W e of the left end, along which the wall pushes.
    let mut response = vec![0.0; beam.dofs()];
    response[axial] = 1.0;
    factor.solve(&mut response);
    let (mut q, mut v) = (vec![0.0; beam.dofs()], vec![0.0; beam.dofs()]);
    v[axial..].fill(-BAR.speed);
    let [begin, end] = BAR.contact();
    let steps = ((end + 0.3 * BAR.duration()) / h) as u32;
    let (mut impulse, mut release, mut shape) = (0.0, 0.0, f64::NAN);
    for k in 0..steps {
        let predicted: Vec<f64> = q.iter().zip(&v).map(|(q, v)| q + 0.5 * h * v).collect();
        let mut change = vec![0.0; beam.dofs()];
        beam.add_stiffness_product(-h, &predicted, &mut change);
        factor.solve(&mut change);
        if BAR.gap + predicted[axial] <= 0.0 {
            let p = (-(v[axial] + change[axial]) / response[axial]).max(0.0);
            change.iter_mut().zip(&response).for_each(|(change, response)| *change += p * response);
            impulse += p;
            if p > 0.0 {
                release = f64::from(k + 1) * h;
            }
        }
        for ((q, v), change) in q.iter_mut().zip(&mut v).zip(&change) {
            *q += h * (*v + 0.5 * change);
            *v += change;
        }
        let t = f64::from(k + 1) * h;
        if shape.is_nan() && t >= 0.5 * (begin + end) {
            let error = |(u, x): (&f64, &f64)| (u + BAR.displacement(*x, t)).abs();
            let sum: f64 = q[axial..].iter().zip(beam.node_positions()).map(error).sum();
            shape = sum / beam.nodes() as f64 / BAR.gap;
        }
    }
    Ok(Flight { force: impulse / BAR.duration(), release, shape })
}
