//! The forces of contacts over time, with their impulses and states.

use super::cut_lines::{cut_lines, range_of};
use super::noted::Noted;
use super::{Plots, values};
use crate::page::curves::{Does, ForceCurve};
use crate::page::notes::{About, Note};
use crate::page::panels::LEAST_FORCE;
use crate::shortest;
use teeter_plot::{Axis, Band, Colour, Figure, Panel, Series};

/// Colours of sticking and slipping; an open contact has none.
const STICK: Colour = Colour::Series(5);
const SLIP: Colour = Colour::Series(1);
const BRIEFLY: Colour = Colour::Guide;

/// What the curve of all points of a contact together is called: its colour is that of none of them.
const SUM: &str = "sum";

impl Plots<'_> {
    pub(super) fn contact_forces(&self) -> Vec<(String, Figure)> {
        let scenery = &self.recorder.scenery;
        let borders = self.panels.curves.borders();
        let (period, means_of_points) = self.panels.means_of_contacts(self.recorder);
        let curves = &self.panels.forces;
        let strongest = self.panels.strongest();
        let mut pairs = Vec::new();
        for (pair, contact) in scenery.contacts.iter().enumerate() {
            let (mut normal, mut means, mut tangential, mut bands) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
            let (mut impacts, mut occurring) = (Vec::new(), Vec::new());
            // Colours are for those that touch: of all there would be too many.
            let touching = contact.points.iter().zip(curves.iter().zip(&means_of_points).skip(contact.first));
            let touching = touching.filter_map(|(drawn, (forces, mean))| Some((drawn, forces.as_ref()?, mean)));
            for (point, (drawn, forces, mean)) in touching.enumerate() {
                let label = &drawn.label;
                let [factor, sideways] = self.panels.force_units[pair].map(|(_, factor)| factor);
                let step = |y: &[f64], factor: f64, label: &str| {
                    let end = borders.last().copied().unwrap_or_default();
                    Series::means(label, borders.iter().copied().zip(y.iter().map(|y| factor * y)), end).number(point)
                };
                let line = |y: &[f64], factor: f64, label: &str| {
                    let points = self.t.iter().copied().zip(y.iter().map(|y| factor * y));
                    Series::line(label, points.collect::<Vec<_>>()).number(point)
                };
                let course = |part: usize, factor: f64, label: &str| {
                    forces.course.as_ref().map(|course| line(&course[part], factor, label))
                };
                // The raw values stay behind their mean, which then has the name.
                normal.push(match mean {
                    Some(_) => course(0, factor, "").unwrap_or_else(|| step(&forces.normal, factor, "")).faint(),
                    None => course(0, factor, label).unwrap_or_else(|| step(&forces.normal, factor, label)),
                });
                let scaled =
                    |mean: &[f64]| borders.iter().copied().zip(mean.iter().map(|y| factor * y)).collect::<Vec<_>>();
                means.push(mean.as_deref().map(|mean| Series::line(label, scaled(mean)).number(point)));
                match &self.panels.sums[pair] {
                    None => tangential
                        .push(course(1, sideways, label).unwrap_or_else(|| step(&forces.tangential, sideways, label))),
                    Some(sum) if point == 0 => {
                        let drawn =
                            if sum.is_course { line(&sum.y, sideways, SUM) } else { step(&sum.y, sideways, SUM) };
                        tangential.push(
                            drawn.number(curves[contact.first..][..contact.points.len()].iter().flatten().count()),
                        );
                    }
                    Some(_) => {}
                }
                if !forces.impacts.is_empty() {
                    let factor = self.panels.impulse_units[pair].1;
                    let stretches = borders.windows(2).zip(&forces.impacts);
                    let bars = stretches.map(|(ends, y)| (ends[0], ends[1], factor * y));
                    impacts.push(Series::bars(label, bars).number(point));
                }
                bands.push(Band::new(label, stretches(&borders, forces)));
                let states = (0..forces.state.len()).map(|bucket| colour_of(forces.does(bucket)));
                states.for_each(|colour| _ = (!occurring.contains(&colour)).then(|| occurring.push(colour)));
            }
            if normal.is_empty() {
                continue;
            }
            let mut panels: Vec<Noted> = Vec::new();
            let name = (scenery.contacts.len() > 1).then(|| Note::of_plot(self.recorder.pair_name(contact)));
            let weight = values(&normal).fold(0.0, f64::max) / self.panels.force_units[pair][0].1;
            let units = self.panels.force_units[pair];
            let cuts = self.panels.cuts_of_contact(self.recorder, pair, &means_of_points);
            let enlarged = self.panels.enlarged_normal(self.recorder, pair, &means_of_points, cuts[0]);
            for ((what, mut lines), ((prefix, factor), cut)) in
                [("Normal", normal), ("Tangential", tangential)].into_iter().zip(units.into_iter().zip(cuts))
            {
                let (unit, least) = (format!("{prefix}N"), LEAST_FORCE * strongest * factor);
                let drawn = if what == "Normal" { &self.panels.normal } else { &self.panels.tangential };
                if !drawn[pair] {
                    continue;
                }
                if what == "Normal" {
                    lines = over_the_raw(lines, std::mem::take(&mut means));
                }
                let cut = cut.map(|cut| cut.scaled(factor));
                let range = cut.map(|cut| range_of(&cut, &lines));
                let label = format!("{what} force ({unit})");
                // From 0, as on the page: what varies by rounding only is then seen as constant.
                let y = match range {
                    Some((low, high)) => Axis::between(label, low, high),
                    None => Axis::around(label, values(&lines).chain([0.0]), least),
                };
                let has_means = lines.iter().any(Series::is_faint);
                let enlarged = enlarged.filter(|_| what == "Normal").map(|end| {
                    let (end, lines) = (end * factor, lines.clone());
                    let y = Axis::between(format!("Enlarged ({unit})"), -0.06 * end, end);
                    let note = Note::of_plot(format!("normal force up to {} {unit}", shortest(end, 2)));
                    (Panel::new(y).with(lines).telling_apart(), vec![note])
                });
                let (lines, about_pale, told) = cut_lines(lines, cut, range, &unit);
                let without = if impacts.is_empty() { "" } else { " without impacts" };
                let meant = if contact.has_duration {
                    self.panels.told_of_springs().map(Note::of_plot)
                } else if has_means {
                    Some(Note::of_pale(format!("pale: {}", self.panels.told_of_rigid(""))))
                } else {
                    Some(Note::of_plot(self.panels.told_of_rigid(without)))
                };
                let meant = meant.filter(|note| about_pale || note.about != About::Pale);
                let strong = (has_means && !contact.has_duration)
                    .then(|| Note::of_plot(format!("strong: without vibrations of periods below {period}")));
                let unsmoothed = (has_means && !contact.has_duration)
                    .then(|| self.panels.unsmoothed(contact, &means_of_points).map(Note::of_plot))
                    .flatten();
                let many = self.panels.redundant[pair].note(what == "Tangential").map(Note::of_plot);
                let turns = self.panels.alternating(contact).filter(|_| what == "Tangential");
                let turns = turns.map(|who| Note::of_plot(format!("{who} by turns")));
                let notes =
                    [name.clone(), meant, strong, unsmoothed, turns, told, many].into_iter().flatten().collect();
                panels.push((self.marked(Panel::new(y).with(lines).telling_apart(), Some(pair)), notes));
                panels.extend(enlarged);
            }
            if !impacts.is_empty() {
                let label = format!("Impulse of impacts ({}N s)", self.panels.impulse_units[pair].0);
                let y = Axis::around(label, values(&impacts).chain([0.0]), 1e-300);
                panels.push((
                    Panel::new(y).with(impacts),
                    [name, Some(Note::of_plot(self.panels.told_of_impacts()))].into_iter().flatten().collect(),
                ));
            }
            let key = [(STICK, "stick"), (SLIP, "slip"), (BRIEFLY, "presses briefly"), (Colour::Paper, "open")];
            let key = key.into_iter().filter(|(colour, _)| occurring.contains(colour));
            panels.push((Panel::bands(bands, key), Vec::new()));
            pairs.push((pair, weight, panels));
        }
        self.by_pairs("contact_forces", "Contact forces on the blocks over time", pairs)
    }
}

/// Raw curves that have a mean first, as pale background; then for each point the curve that has its name, in the order of the points.
fn over_the_raw(raw: Vec<Series>, means: Vec<Option<Series>>) -> Vec<Series> {
    let (mut pale, mut named) = (Vec::new(), Vec::new());
    for (raw, mean) in raw.into_iter().zip(means) {
        match mean {
            Some(mean) => {
                pale.push(raw);
                named.push(mean);
            }
            None => named.push(raw),
        }
    }
    pale.append(&mut named);
    pale
}

/// The colour of a state in the bands.
fn colour_of(does: Does) -> Colour {
    match does {
        Does::Open => Colour::Paper,
        Does::Briefly => BRIEFLY,
        Does::Stick => STICK,
        Does::Slip => SLIP,
    }
}

/// Neighbours in one state as one stretch; the open ones left out.
fn stretches(borders: &[f64], forces: &ForceCurve) -> Vec<(f64, f64, Colour)> {
    let mut stretches: Vec<(f64, f64, Colour)> = Vec::new();
    for (bucket, ends) in borders.windows(2).enumerate() {
        let colour = colour_of(forces.does(bucket));
        if colour == Colour::Paper {
            continue;
        }
        match stretches.last_mut() {
            Some(last) if last.1 == ends[0] && last.2 == colour => last.1 = ends[1],
            _ => stretches.push((ends[0], ends[1], colour)),
        }
    }
    stretches
}
