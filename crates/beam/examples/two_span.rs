//! A beam over two spans with a load on the left one: deflection, bending moment and reactions, beside the closed form.
//!
//!     cargo run -p teeter-beam --example two_span -- folder

#![allow(clippy::print_stdout, reason = "a program")]

use std::error::Error;
use teeter_beam::{Actions, Beam, BeamSpec, Profile, Section, SpanLoad, Support};
use teeter_plot::{Axis, Figure, Panel, Series};

const SPAN: f64 = 4.0;
const LOAD: f64 = -10e3;

fn main() -> Result<(), Box<dyn Error>> {
    // IPE 200 of steel, without its fillets.
    let profile = Profile::ISection { height: 0.2, width: 0.1, web: 0.0056, flange: 0.0085 };
    let section = Section::of(profile, 210e9, 7850.0)?;
    let beam = Beam::new(BeamSpec::new(2.0 * SPAN, 16, section).support_at(SPAN, Support::Pinned))?;

    let mut q = vec![0.0; beam.dofs()];
    beam.add_partial_load([0.0, SPAN], LOAD, &mut q)?;
    beam.solve_static(&mut q)?;
    let loads = [SpanLoad::Uniform { from: 0.0, to: SPAN, load: LOAD }];
    let forces = beam.section_forces(&Actions::at(&q).with_loads(&loads))?;

    println!("{:28} {:>12} {:>12}", "", "computed", "closed form");
    let row = |name: &str, computed: f64, exact: f64| println!("{name:28} {computed:12.4} {exact:12.4}");
    for (reaction, part) in forces.reactions().iter().zip([7.0, 10.0, -1.0]) {
        row(&format!("reaction at {} m, kN", reaction.x), 1e-3 * reaction.force, -1e-3 * part / 16.0 * LOAD * SPAN);
    }
    row("moment over the pin, kN m", 1e-3 * forces.at(&beam, SPAN)?.moment, 1e-3 * LOAD * SPAN * SPAN / 16.0);
    // 5 q l⁴/(384 EI) of the span alone, less M l²/(16 EI) of the moment over the pin.
    let sag = LOAD * SPAN.powi(4) / section.bending_stiffness * (5.0 / 384.0 - 1.0 / 256.0);
    let middle = beam.deflection_at(&q, 0.5 * SPAN).ok_or("off the beam")?;
    row("deflection at 2 m, mm", 1e3 * middle.w, 1e3 * sag);

    let places: Vec<f64> = (0..=160).map(|k| 2.0 * SPAN * f64::from(k) / 160.0).collect();
    let deflection: Vec<_> = places.iter().filter_map(|x| Some((*x, 1e3 * beam.deflection_at(&q, *x)?.w))).collect();
    let moment: Result<Vec<_>, Box<dyn Error>> =
        places.iter().map(|x| Ok((*x, 1e-3 * forces.at(&beam, *x)?.moment))).collect();

    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    for (name, what, label, line) in [
        ("two_span_deflection", "deflection", "Deflection w (mm)", deflection),
        ("two_span_moment", "bending moment", "Bending moment M (kN m)", moment?),
    ] {
        let x = Axis::between("Place along the beam x (m)", 0.0, 2.0 * SPAN);
        let y = Axis::linear(label, line.iter().map(|point| point.1))?;
        let title = format!("Two spans, the left one loaded: {what}");
        let figure = Figure::new(name, title, x).headed().panel(Panel::new(y).with([Series::line("", line)]));
        std::fs::write(format!("{folder}/{name}.svg"), figure.to_svg())?;
    }
    Ok(())
}
