//! Plots of energies and works.

use super::{Curves, Line, Measure, Panels, Place, TimePanel};
use crate::page::content::{ROUNDING, holds, largest};
use crate::page::notes::Note;
use crate::page::recorder::{ENERGIES, PageRecorder};

/// What is said of it then.
const SHARED: &str = "in impacts, only contact + friction is dissipated: either may rise";

/// Friction that rises by this part of the largest work is told: in impacts it shares the work with the contact.
const RISES: f64 = 1e-3;

impl Panels {
    pub(super) fn energies(&mut self, recorder: &PageRecorder) {
        let first = recorder.scenery.energy_column();
        let of = |curves: &Curves, name: &str| {
            let column = first + ENERGIES.iter().position(|known| *known == name).unwrap_or(0);
            (column, curves.curve(column))
        };
        let energies = [("kinetic", 0), ("elastic", 1), ("gravity", 2), ("total", 6)];
        let energies =
            energies.into_iter().filter(|(name, _)| *name != "elastic" || !recorder.scenery.beams.is_empty());
        let energies: Vec<_> = energies.map(|(name, number)| (name, number, of(&self.curves, name))).collect();
        let greatest = largest(energies.iter().flat_map(|(.., (_, values))| values));
        let scale = greatest.max(recorder.scenery.weight_energy);
        let works = ["contact", "friction", "viscous", "numerical", "external", "projection"];
        let works: Vec<_> = works.into_iter().enumerate().map(|(k, name)| (name, k, of(&self.curves, name))).collect();
        for (id, title, all) in [("energy", "Energy", energies), ("works", "Work since t = 0", works)] {
            let mut drawn: Vec<Drawn> = Vec::new();
            for (name, number, (column, values)) in all {
                if holds(largest(&values), scale) {
                    let label = if name == "gravity" { "gravity, change" } else { name }.to_owned();
                    drawn.push((column, label, number, values));
                } else {
                    let what = if id == "energy" { "energy:" } else { "work:" };
                    self.leave_out(what, Some((name.to_owned(), "")), [largest(&values), scale], "J");
                }
            }
            // What is small beside another would be a line at zero. Energies turn into each other, and belong together as long as they are seen.
            let groups = by_size(drawn, if id == "works" { SMALL } else { SMALL_ENERGY });
            // What nobody would miss is told instead.
            let is_seen =
                |group: &Vec<Drawn>| largest(group.iter().flat_map(|(.., values)| values)) >= NEGLIGIBLE * greatest;
            let (seen, negligible): (Vec<_>, Vec<_>) =
                groups.into_iter().filter(|group| !group.is_empty()).partition(is_seen);
            let kind = if id == "works" { "work" } else { "energy" };
            let told = negligible.into_iter().flatten();
            let told = told.map(|(_, name, _, values)| (format!("the {kind} “{name}”"), largest(&values)));
            self.negligible.extend(told);
            for (number, drawn) in seen.into_iter().enumerate() {
                let id = if number > 0 { format!("{id}-{}", number + 1) } else { id.to_owned() };
                let title = if number > 0 { format!("{title}, smaller parts") } else { title.to_owned() };
                self.panels.push(self.energy_panel(id, title, drawn, scale));
            }
        }
    }

    fn energy_panel(&self, id: String, title: String, drawn: Vec<Drawn>, scale: f64) -> TimePanel {
        let most = largest(drawn.iter().flat_map(|(.., values)| values));
        let shared = drawn.iter().any(|(_, label, _, values)| label == "friction" && rise(values) > RISES * most);
        let line = |(column, label, number, _)| Line::of(&self.curves, column, 1.0, label, number);
        TimePanel {
            id,
            notes: shared.then(|| Note::of_plot(SHARED)).into_iter().collect(),
            of_contact: None,
            description: format!("{title} of the scene over time"),
            title,
            measure: Measure::Energy,
            unit: String::new(),
            least: (1e-6 * most).max(ROUNDING * scale),
            guides: Vec::new(),
            t: None,
            cut: false,
            place: Place::Forces,
            lines: drawn.into_iter().map(line).collect(),
        }
    }
}

/// An energy or a work: its column, name, the number of its colour, and its values, J.
type Drawn = (usize, String, usize, Vec<f64>);

/// A work smaller than this part of another has a plot of its own.
const SMALL: f64 = 0.03;

/// And an energy smaller than this part.
const SMALL_ENERGY: f64 = 0.005;

/// Energies and works smaller than this part of the largest energy have none.
const NEGLIGIBLE: f64 = 1e-4;

/// In groups, largest first, in each of which the smallest is at least the part `small` of the largest.
fn by_size(mut left: Vec<Drawn>, small: f64) -> Vec<Vec<Drawn>> {
    let size = |drawn: &Drawn| largest(&drawn.3);
    let mut groups = Vec::new();
    while !left.is_empty() {
        let most = left.iter().map(size).fold(0.0, f64::max);
        let (seen, unseen) = left.into_iter().partition(|drawn| size(drawn) >= small * most);
        groups.push(seen);
        left = unseen;
    }
    groups
}

/// By how much a quantity rises above its least value before.
fn rise(values: &[f64]) -> f64 {
    let mut least = f64::INFINITY;
    let above = |x: &f64| {
        least = least.min(*x);
        x - least
    };
    values.iter().map(above).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_work_that_would_look_like_zero_has_a_plot_of_its_own() {
        let works = [("contact", -0.4), ("friction", -2.0), ("viscous", -3e-3), ("external", 150.0)];
        let drawn = works.iter().enumerate().map(|(k, (name, y))| (k, (*name).to_owned(), k, vec![0.0, *y])).collect();
        let names: Vec<Vec<String>> =
            by_size(drawn, SMALL).into_iter().map(|group| group.into_iter().map(|drawn| drawn.1).collect()).collect();
        assert_eq!(names, [vec!["external"], vec!["contact", "friction"], vec!["viscous"]]);
    }
}
