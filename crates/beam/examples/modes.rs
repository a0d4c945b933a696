//! The first five modes of a cantilever: frequencies beside those of the continuous beam, and their shapes.
//!
//!     cargo run -p teeter-beam --example modes -- folder

#![allow(clippy::print_stdout, reason = "a program")]

use std::error::Error;
use std::f64::consts::TAU;
use teeter_beam::{Beam, BeamSpec, Section, Support};
use teeter_plot::{Axis, Figure, Legend, Panel, Series};

const COUNT: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    // A steel ruler.
    let section = Section::rectangle(0.03, 0.001, 210e9, 7850.0)?;
    let beam = Beam::new(BeamSpec::new(0.3, 20, section).supported([Support::Clamped, Support::Free]))?;
    let modes = beam.modes(COUNT)?;

    println!("{:>4} {:>14} {:>14} {:>10}", "mode", "20 elements", "exact, Hz", "error");
    let (mut lines, mut values) = (Vec::new(), Vec::new());
    for (i, omega) in modes.circular_frequencies().iter().enumerate() {
        let exact = beam.circular_frequency(i + 1)?;
        println!("{:4} {:14.6} {:14.6} {:10.1e}", i + 1, omega / TAU, exact / TAU, omega / exact - 1.0);
        // Scaled to 1 at the tip.
        let shape = modes.shape(i);
        let tip = beam.deflection_at(shape, 0.3).ok_or("off the beam")?.w;
        let places = (0..=120).map(|k| 0.3 * f64::from(k) / 120.0);
        let points: Vec<(f64, f64)> =
            places.filter_map(|x| Some((1e3 * x, beam.deflection_at(shape, x)?.w / tip))).collect();
        values.extend(points.iter().map(|point| point.1));
        lines.push(Series::line(format!("{:.1} Hz", omega / TAU), points));
    }

    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    let x = Axis::between("Place along the ruler x (mm)", 0.0, 300.0);
    let panel = Panel::new(Axis::linear("Deflection / that of the tip", values)?).with(lines);
    let figure = Figure::new("modes", "Modes of a steel ruler, clamped at the left", x).headed().legend(Legend::Rows);
    std::fs::write(format!("{folder}/modes.svg"), figure.panel(panel).to_svg())?;
    Ok(())
}
