//! Performance profiles as SVG: the only file of the program that knows the plotting crate.

use plotters::prelude::*;
use std::error::Error;

/// A solver's curve: where it steps, and to which part of the problems.
pub(super) struct Curve {
    pub(super) name: String,
    /// Ratio to the best time and part solved within it, both ascending.
    pub(super) steps: Vec<(f64, f64)>,
}

/// Colours that differ in print and for the colour-blind (Okabe and Ito).
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
];

/// Pixels. The legend has a column of its own, so that it covers no curve.
const PLOT: (u32, u32) = (760, 480);
const LEGEND: u32 = 230;
/// Height of a line of the legend.
const LINE: i32 = 22;

/// The profile of a contest; the axis of the ratios is logarithmic, to base 2.
pub(super) fn profile(title: &str, curves: &[Curve]) -> Result<String, String> {
    draw(title, curves).map_err(|error| format!("error: the figure «{title}» can't be drawn: {error}"))
}

fn draw(title: &str, curves: &[Curve]) -> Result<String, Box<dyn Error>> {
    let widest = curves.iter().flat_map(|curve| &curve.steps).map(|step| step.0.log2()).fold(1.0, f64::max).ceil();
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, (PLOT.0 + LEGEND, PLOT.1)).into_drawing_area();
        root.fill(&WHITE)?;
        let (plot, legend) = root.split_horizontally(PLOT.0);
        let mut chart = ChartBuilder::on(&plot)
            .caption(title, ("sans-serif", 20))
            .margin(12)
            .x_label_area_size(52)
            .y_label_area_size(72)
            .build_cartesian_2d(0.0..widest, 0.0..1.02)?;
        chart
            .configure_mesh()
            .x_desc("time, as a multiple of the best solver's for the problem")
            .y_desc("part of the problems solved")
            .x_labels(1 + widest.min(12.0) as usize)
            .y_labels(11)
            .x_label_formatter(&|power| multiple(*power))
            .y_label_formatter(&|part| format!("{:.0} %", 100.0 * part))
            .axis_desc_style(("sans-serif", 16))
            .label_style(("sans-serif", 14))
            .bold_line_style(BLACK.mix(0.18))
            .light_line_style(TRANSPARENT)
            .draw()?;
        for (k, curve) in curves.iter().enumerate() {
            let style = COLOURS[k % COLOURS.len()].stroke_width(2);
            let points = staircase(&curve.steps, widest);
            match dash(k) {
                None => chart.draw_series(LineSeries::new(points, style))?,
                Some((on, off)) => chart.draw_series(DashedLineSeries::new(points, on, off, style))?,
            };
        }
        for (k, curve) in curves.iter().enumerate() {
            let y = 56 + LINE * k as i32;
            let style = COLOURS[k % COLOURS.len()].stroke_width(2);
            // As dashed as the curve: pieces of a line 36 pixels long.
            let (on, off) = dash(k).unwrap_or((36, 0));
            let mut x = 0;
            while x < 36 {
                legend.draw(&PathElement::new([(x, y), ((x + on as i32).min(36), y)], style))?;
                x += (on + off) as i32;
            }
            legend.draw(&Text::new(curve.name.clone(), (44, y - 6), ("sans-serif", 14)))?;
        }
        root.present()?;
    }
    Ok(text)
}

/// The first six curves are whole, the next six dashed, all others dotted.
fn dash(curve: usize) -> Option<(u32, u32)> {
    match curve / COLOURS.len() {
        0 => None,
        1 => Some((9, 5)),
        _ => Some((3, 4)),
    }
}

/// From (0, what is solved at the best time) by steps to the right end.
fn staircase(steps: &[(f64, f64)], widest: f64) -> Vec<(f64, f64)> {
    let (mut points, mut part) = (vec![(0.0, 0.0)], 0.0);
    for &(ratio, solved) in steps {
        let x = ratio.log2().clamp(0.0, widest);
        points.extend([(x, part), (x, solved)]);
        part = solved;
    }
    points.push((widest, part));
    points
}

/// 1, 2, 4 … for whole powers of two, nothing for what lies between.
fn multiple(power: f64) -> String {
    if (power - power.round()).abs() > 1e-6 {
        return String::new();
    }
    format!("{}", power.exp2().round())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_steps_up_where_a_problem_is_solved_and_stays() {
        let points = staircase(&[(1.0, 0.25), (4.0, 0.5)], 3.0);
        assert_eq!(points, [(0.0, 0.0), (0.0, 0.0), (0.0, 0.25), (2.0, 0.25), (2.0, 0.5), (3.0, 0.5)]);
    }

    #[test]
    fn a_figure_names_every_solver_also_one_that_solves_nothing() {
        let curve = |k: usize| Curve { name: format!("s{k} (0 of 1)"), steps: vec![(1.0 + k as f64, 1.0); k % 2] };
        let svg = profile("t", &(0..14).map(curve).collect::<Vec<_>>()).unwrap();
        assert!((0..14).all(|k| svg.contains(&format!("s{k} (0 of 1)"))));
        assert!(svg.starts_with("<svg") && svg.contains("part of the problems solved"));
        assert!(profile("nobody solves anything", &[]).is_ok());
    }
}
