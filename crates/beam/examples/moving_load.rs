//! A force that crosses a bridge: the envelope of the bending moment, beside that of the same force creeping.
//!
//!     cargo run -p teeter-beam --example moving_load -- folder

#![allow(clippy::print_stdout, reason = "a program")]

use std::error::Error;
use teeter_beam::{
    Actions, Beam, BeamSpec, Envelope, Load, MatrixWeights, MovingLoad, Section, SectionForces, SpanLoad,
};
use teeter_plot::{Axis, Figure, Panel, Series};

const SPAN: f64 = 30.0;
const FORCE: f64 = -100e3;
const SPEED: f64 = 60.0;

fn main() -> Result<(), Box<dyn Error>> {
    let mut spec = BeamSpec::new(SPAN, 40, Section::new(8e9, 6e3)?);
    spec.damping.viscous = spec.viscous_for_ratio(1, 0.02)?;
    let beam = Beam::new(spec)?;
    let load = MovingLoad::new(FORCE, SPEED, 0.0)?;

    // θ = ½: forces are those of the middle of the step, so the moments of a step are too.
    let (h, steps) = (5e-4, 1000);
    let w = beam.factor(MatrixWeights { mass: 1.0, damping: 0.5 * h, stiffness: 0.25 * h * h })?;
    let zero = vec![0.0; beam.dofs()];
    let (mut q, mut v, mut a, mut p) = (zero.clone(), zero.clone(), zero.clone(), zero.clone());
    load.add(&beam, 0.0, &mut p);
    let (mut forces, mut envelope) = (SectionForces::new(&beam), Envelope::new(&beam));
    for step in 0..steps {
        let times = [f64::from(step) * h, f64::from(step + 1) * h];
        a.copy_from_slice(&p);
        p.fill(0.0);
        load.add(&beam, times[1], &mut p);
        a.iter_mut().zip(&p).for_each(|(a, p)| *a = 0.5 * (*a + p));
        beam.add_stiffness_product(-1.0, &q, &mut a);
        beam.add_stiffness_product(-0.5 * h, &v, &mut a);
        beam.add_damping_product(-1.0, &v, &mut a);
        w.solve(&mut a);
        // To the middle of the step, look, and on to its end.
        for i in 0..beam.dofs() {
            v[i] += 0.5 * h * a[i];
            q[i] += 0.5 * h * v[i];
        }
        let on_beam = times.map(|t| load.position(t)).into_iter().filter(|x| *x <= SPAN);
        let halves: Vec<_> = on_beam.map(|x| SpanLoad::Point { x, force: 0.5 * FORCE, couple: 0.0 }).collect();
        forces.update(&beam, &Actions::at(&q).with_velocity(&v).with_acceleration(&a).with_loads(&halves))?;
        envelope.take(&beam, &q, &forces);
        for i in 0..beam.dofs() {
            q[i] += 0.5 * h * v[i];
            v[i] += 0.5 * h * a[i];
        }
    }

    // Creeping over x the force bends the beam there by P x (L − x)/L.
    let creeping = |x: f64| -FORCE * x * (SPAN - x) / SPAN;
    println!("{:>6} {:>14} {:>14} {:>14}   kN m", "x, m", "least", "largest", "creeping");
    let nodes = || beam.node_positions().iter().zip(&envelope.moment);
    for (x, [least, largest]) in nodes().step_by(5) {
        println!("{x:6.2} {:14.2} {:14.2} {:14.2}", 1e-3 * least, 1e-3 * largest, 1e-3 * creeping(*x));
    }

    let line = |name: &str, of: &dyn Fn(f64, [f64; 2]) -> f64| {
        Series::line(name, nodes().map(|(x, range)| (*x, 1e-3 * of(*x, *range))))
    };
    let lines = [
        line("largest", &|_, [_, largest]| largest),
        line("least", &|_, [least, _]| least),
        line("creeping", &|x, _| creeping(x)),
    ];
    let values = lines.iter().flat_map(Series::points).map(|point| point.1);
    let y = Axis::linear("Bending moment M (kN m)", values)?;
    let x = Axis::between("Place along the bridge x (m)", 0.0, SPAN);
    let title = "100 kN at 60 m/s over a bridge: envelope of the bending moment";
    let figure = Figure::new("moving_load", title, x).headed().panel(Panel::new(y).with(lines));
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    std::fs::write(format!("{folder}/moving_load.svg"), figure.to_svg())?;
    Ok(())
}
