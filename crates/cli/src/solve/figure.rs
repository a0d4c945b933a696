//! Performance profiles as figures.

use teeter_plot::{Axis, AxisError, Figure, Legend, Panel, Series};

/// A solver's curve: its steps.
pub(super) struct Curve {
    pub(super) name: String,
    /// Ratio to the best time, and fraction solved within it, both ascending.
    pub(super) steps: Vec<(f64, f64)>,
}

/// Height of the plot, mm.
const HEIGHT: f64 = 70.0;

/// A performance profile as SVG, of a width in mm.
pub(super) fn profile(title: &str, curves: &[Curve], width: f64) -> Result<String, String> {
    draw(title, curves, width).map_err(|error| format!("error: the figure «{title}» can't be drawn: {error}"))
}

fn draw(title: &str, curves: &[Curve], width: f64) -> Result<String, AxisError> {
    let ratios = curves.iter().flat_map(|curve| &curve.steps).map(|step| step.0);
    // At least from the best time to twice that.
    let x = Axis::logarithmic("Time, as a multiple of the best solver's for the problem", ratios.chain([1.0, 2.0]))?;
    let x = x.starting_at(1.0);
    let end = x.ends().1;
    let series = curves.iter().map(|curve| {
        let steps = curve.steps.iter().map(|&(ratio, part)| (ratio, 100.0 * part));
        Series::staircase(&curve.name, [(1.0, 0.0)].into_iter().chain(steps), end)
    });
    let panel = Panel::new(Axis::between("Problems solved (%)", 0.0, 102.0)).with(series);
    let figure = Figure::new("profile", title, x).headed().legend(Legend::Rows).width_mm(width);
    Ok(figure.panel(panel.height_mm(HEIGHT)).to_svg())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_names_every_solver_also_one_that_solves_nothing() {
        let curve = |k: usize| Curve { name: format!("s{k} (0 of 1)"), steps: vec![(1.0 + k as f64, 1.0); k % 2] };
        let svg = profile("t", &(0..14).map(curve).collect::<Vec<_>>(), 84.0).unwrap();
        assert!((0..14).all(|k| svg.contains(&format!("s{k} (0 of 1)"))));
        assert!(svg.contains(" width=\"84mm\"") && svg.contains("Problems solved (%)"));
        assert!(profile("nobody solves anything", &[], 120.0).is_ok());
        assert!(profile("no time", &[Curve { name: String::new(), steps: vec![(f64::NAN, 1.0)] }], 120.0).is_err());
    }
}
