//! The plots over time that the page and the figures have in common: which quantities, of which bodies, in which units, by the
//! rule of [`content`](super::content).

use super::content::{LeftOut, ROUNDING, largest};
use super::curves::{Curves, ForceCurve};
use super::jolts::Jolts;
use super::means::Filter;
use super::notes::Note;
use super::recorder::{NUMBERS, PageRecorder};
use super::redundant::{Redundant, redundant};
use super::scenery::ContactDrawn;
use crate::with_digits;
use std::ops::Range;

mod coincident;
mod cut;
mod energies;
mod forces;
mod motion;
mod portraits;
mod prescribed;
mod sections;
mod units;

pub(crate) use cut::Cut;
use cut::{cut_at, enlarged};
pub(crate) use forces::unseen_slip;
pub(crate) use sections::after_impacts;
pub(crate) use units::{LEAST_FORCE, Measure, Unit, Units, length_unit, prefix, time_unit};
use units::{contact_sizes, impulse_units};

/// Where on the page a panel stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    /// Before the contacts.
    Motion,
    /// After them.
    Forces,
}

/// A plot of quantities over time.
#[derive(Debug, Clone)]
pub(crate) struct TimePanel {
    /// What its file and its place on the page are called.
    pub(crate) id: String,
    /// What is to be known to read it.
    pub(crate) notes: Vec<Note>,
    /// What is plotted.
    pub(crate) title: String,
    /// The contact whose it is, and its name where there are several.
    pub(crate) of_contact: Option<(usize, String)>,
    /// A sentence for those who can't see the figure.
    pub(crate) description: String,
    /// Of what kind its quantities are, by which the page chooses its unit.
    pub(crate) measure: Measure,
    pub(crate) unit: String,
    /// Least height of its axis, in its unit.
    pub(crate) least: f64,
    /// Lines across it, in its unit.
    pub(crate) guides: Vec<f64>,
    /// The times of all of its lines, s, where these are others than those of the curves and their borders.
    pub(crate) t: Option<Vec<f64>>,
    /// Whether the peaks of impacts are cut.
    pub(crate) cut: bool,
    pub(crate) place: Place,
    pub(crate) lines: Vec<Line>,
}

/// A curve.
#[derive(Debug, Clone)]
pub(crate) struct Line {
    /// Empty if it is the only one that there can be.
    pub(crate) label: String,
    /// Number of its colour.
    pub(crate) number: usize,
    pub(crate) y: Vec<f64>,
    /// Whether it stays pale behind a mean, which has its name.
    pub(crate) is_raw: bool,
    /// Of one through the largest values where the quantity rings: where it is the quantity itself. Empty if it is all along, or nowhere.
    pub(crate) itself: Vec<bool>,
    /// Where in the curves it is from; none where its times are the borders of buckets, or the panel's own, not those of the curves.
    pub(crate) of: Option<Source>,
}

/// A column of the curves as it is drawn.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Source {
    pub(crate) column: usize,
    /// What is subtracted from its values: 0, or the value at the start.
    pub(crate) zero: f64,
    /// What these are multiplied by.
    pub(crate) factor: f64,
}

impl Source {
    /// A value as it is drawn.
    pub(crate) fn drawn(self, value: f64) -> f64 {
        self.factor * (value - self.zero)
    }
}

impl TimePanel {
    /// Whether it shows how ground or supports are made to move.
    pub(crate) fn is_prescribed(&self) -> bool {
        self.id.starts_with("ground")
    }
}

impl Line {
    /// A column of the curves, multiplied by `factor`.
    fn of(curves: &Curves, column: usize, factor: f64, label: String, number: usize) -> Self {
        Self::from_zero(curves, Source { column, zero: 0.0, factor }, label, number)
    }

    fn from_zero(curves: &Curves, source: Source, label: String, number: usize) -> Self {
        let y = curves.curve(source.column).into_iter().map(|x| source.drawn(x)).collect();
        Self { label, number, y, is_raw: false, itself: Vec::new(), of: Some(source) }
    }
}

/// A coordinate and its velocity, one over the other.
#[derive(Debug, Clone)]
pub(crate) struct Portrait {
    pub(crate) id: &'static str,
    pub(crate) title: String,
    pub(crate) x_label: String,
    pub(crate) y_label: String,
    pub(crate) x_unit: String,
    pub(crate) y_unit: String,
    pub(crate) least: [f64; 2],
    pub(crate) guides: Vec<f64>,
    /// What is to be known to read it.
    pub(crate) note: Option<String>,
    /// By blocks.
    pub(crate) lines: Vec<PortraitLine>,
}

/// A block's curve: times, s, coordinates and velocities in the units of the axes.
#[derive(Debug, Clone)]
pub(crate) struct PortraitLine {
    /// Empty if it is the only one that there can be.
    pub(crate) label: String,
    /// Number of its colour.
    pub(crate) number: usize,
    pub(crate) t: Vec<f64>,
    pub(crate) x: Vec<f64>,
    pub(crate) v: Vec<f64>,
    /// Which of its points are drawn strong; the others are pale.
    pub(crate) strong: Range<usize>,
    /// On how many others it lies.
    pub(crate) over: u8,
    /// Then, by points, where it lies on none of them.
    pub(crate) alone: Vec<bool>,
}

/// All that is drawn over time of a run, but contact forces, and what isn't.
#[derive(Debug)]
pub(crate) struct Panels {
    pub(crate) curves: Curves,
    pub(crate) forces: Vec<Option<ForceCurve>>,
    /// The tangential force of all points of a contact together as it is drawn, N, by contacts: at the times of the curves, or means over the
    /// buckets. None where the points are drawn one by one.
    pub(crate) sums: Vec<Option<Sum>>,
    pub(crate) panels: Vec<TimePanel>,
    pub(crate) portraits: Vec<Portrait>,
    pub(crate) left_out: Vec<LeftOut>,
    /// Energies and works that are too small beside the others for a plot, with how large they become, J.
    pub(crate) negligible: Vec<(String, f64)>,
    /// Blocks whose velocity turns too often for a phase portrait.
    pub(crate) untraced: Vec<String>,
    /// The units that quantities have on this page.
    pub(crate) units: Units,
    /// The prefixes of the units of normal and of tangential forces, with their factors, by contacts.
    pub(crate) force_units: Vec<[Unit; 2]>,
    /// The prefixes of the units of impulses of impacts, with their factors, by contacts.
    pub(crate) impulse_units: Vec<Unit>,
    /// Whether normal forces are more than rounding, by contacts: not of those that only strike.
    pub(crate) normal: Vec<bool>,
    /// Whether tangential forces are more than rounding, by contacts.
    pub(crate) tangential: Vec<bool>,
    /// What equilibrium leaves open of the forces, by contacts.
    pub(crate) redundant: Vec<Redundant>,
    /// Which contact points have a strong mean over what rings: decided from all that was kept, so that the page shows the same as the figures.
    has_mean: Vec<bool>,
}

impl Panels {
    /// Those of the page, which has few enough numbers to stay small.
    pub(crate) fn of(recorder: &PageRecorder) -> Self {
        let all = Self::in_full(recorder);
        let (buckets, numbers) = (all.curves.len(), all.numbers(recorder));
        if numbers <= NUMBERS {
            return all;
        }
        let has_mean = all.has_mean;
        Self { has_mean, ..Self::with(recorder, all.curves.in_at_most(buckets * NUMBERS / numbers)) }
    }

    /// Those of figures, which are as fine as the curves that were kept.
    pub(crate) fn in_full(recorder: &PageRecorder) -> Self {
        let mut panels = Self::with(recorder, recorder.kept.curves.ended());
        panels.has_mean = panels.points_with_means(recorder);
        panels
    }

    fn with(recorder: &PageRecorder, curves: Curves) -> Self {
        let forces = |curves: &Curves| {
            let of = |point: usize| {
                let from_first_step = |column: usize| {
                    let mut course = curves.curve(column);
                    // What a contact's force is before the first step is known from that alone.
                    course[0] = course.get(1).copied().unwrap_or(0.0);
                    course
                };
                let course = recorder.spring_column(point).map(|column| [column, column + 1].map(from_first_step));
                let forces = curves.forces(point)?;
                Some(ForceCurve { course: course.or(forces.course), ..forces })
            };
            (0..recorder.scenery.points).map(of).collect::<Vec<_>>()
        };
        let forces = forces(&curves);
        let mut panels = Self {
            normal: vec![true; recorder.scenery.contacts.len()],
            tangential: vec![true; recorder.scenery.contacts.len()],
            units: Units::of(recorder.scenery.display.length, &[]),
            force_units: Vec::new(),
            impulse_units: impulse_units(recorder, &forces),
            redundant: redundant(recorder, &curves, &forces),
            sums: Vec::new(),
            curves,
            forces,
            panels: Vec::new(),
            portraits: Vec::new(),
            left_out: Vec::new(),
            negligible: Vec::new(),
            untraced: Vec::new(),
            has_mean: Vec::new(),
        };
        let sums = (0..recorder.scenery.contacts.len()).map(|pair| panels.sum(recorder, pair));
        panels.sums = sums.collect();
        panels.fill(recorder);
        panels
    }

    fn fill(&mut self, recorder: &PageRecorder) {
        if !recorder.scenery.is_crowded() {
            self.motions(recorder);
        }
        self.deflections(recorder);
        self.prescribed(recorder);
        self.contacts(recorder);
        self.sections(recorder);
        self.energies(recorder);
        self.choose_units(recorder);
        if !recorder.scenery.is_crowded() {
            self.portraits(recorder);
        }
    }

    /// Gives quantities of a kind one unit, and the panels over time, so far in SI units, theirs.
    fn choose_units(&mut self, recorder: &PageRecorder) {
        let contacts = contact_sizes(recorder, &self.forces);
        let of_panels = self.panels.iter().map(|panel| (panel.measure, panel.size()));
        let of_contacts = contacts.iter().flatten().map(|size| (Measure::Force, *size));
        let sizes: Vec<_> = of_panels.chain(of_contacts).filter(|(measure, _)| *measure != Measure::Own).collect();
        self.units = Units::of(recorder.scenery.display.length, &sizes);
        self.force_units = contacts.iter().map(|pair| pair.map(|size| self.units.unit(Measure::Force, size))).collect();
        for panel in self.panels.iter_mut().filter(|panel| panel.measure != Measure::Own) {
            panel.show_in(self.units.unit(panel.measure, panel.size()));
        }
    }

    /// Whether forces of contacts are one of many sets at the end of the run.
    pub(crate) fn many_at_end(&self) -> bool {
        self.redundant.iter().any(|redundant| redundant.at_end)
    }

    /// Whether the plot of a contact's tangential force shows only its sum over the points: that of a contact whose points share it in one
    /// of many ways, which would be drawn as jumps between its feet.
    pub(crate) fn sums_tangential(&self, pair: usize) -> bool {
        self.redundant[pair].shares
    }

    /// The normal forces of contact points without their fast vibrations, N, at the borders of the buckets; none of pairs where they hardly differ. With
    /// what is to be told of the vibrations taken away.
    pub(crate) fn means_of_contacts(&self, recorder: &PageRecorder) -> (String, Vec<Option<Vec<f64>>>) {
        let filter = self.filter(recorder);
        let mean = |(forces, has_mean): (&Option<ForceCurve>, &bool)| {
            let (mean, _) = filter.normal(&self.curves, forces.as_ref().filter(|_| *has_mean)?)?;
            Some(mean)
        };
        (filter.told(), self.forces.iter().zip(&self.has_mean).map(mean).collect())
    }

    /// Which contact points have a mean: all those of a pair of which one rings, as curves of two feet that bear the same are to look the same.
    fn points_with_means(&self, recorder: &PageRecorder) -> Vec<bool> {
        let filter = self.filter(recorder);
        let mut has_mean = vec![false; self.forces.len()];
        for points in Self::ringing(recorder) {
            let own = self.forces[points.clone()].iter();
            let own: Vec<Option<bool>> =
                own.map(|forces| Some(filter.normal(&self.curves, forces.as_ref()?)?.1)).collect();
            if own.contains(&Some(true)) {
                has_mean[points].iter_mut().zip(own).for_each(|(has_mean, own)| *has_mean = own.is_some());
            }
        }
        has_mean
    }

    /// What takes the fast vibrations of contact forces away.
    fn filter(&self, recorder: &PageRecorder) -> Filter {
        let forces = Self::ringing(recorder).flat_map(|points| &self.forces[points]).flatten();
        let normal: Vec<Vec<f64>> = forces.map(|forces| forces.normal.clone()).collect();
        Filter::of(&self.curves, &Jolts::of(recorder), &normal)
    }

    /// The points of each pair that may ring: springs make a force smooth, and without a beam nothing rings.
    fn ringing(recorder: &PageRecorder) -> impl Iterator<Item = Range<usize>> {
        let ringing = recorder.scenery.contacts.iter().filter(|contact| contact.rings && !contact.has_duration);
        ringing.map(|contact| contact.first..contact.first + contact.points.len())
    }

    /// What is to be told of the forces of springs: nothing where they are drawn step by step.
    pub(crate) fn told_of_springs(&self) -> Option<String> {
        let over = || with_digits(self.curves.longest_bucket(), "s", 2);
        self.curves.is_thinned().then(|| format!("the least and the largest of every {}", over()))
    }

    /// What is to be told of the forces of rigid contacts, without those in steps `without` which they are.
    pub(crate) fn told_of_rigid(&self, without: &str) -> String {
        let told = |lasting: f64| with_digits(lasting, "s", 2);
        match self.told_of_springs() {
            Some(extremes) => format!("{extremes}, of means over {}{without}", told(self.curves.longest_short())),
            None => format!("means over {}{without}", told(self.curves.longest_bucket())),
        }
    }

    /// What is to be told of the impulses of impacts.
    pub(crate) fn told_of_impacts(&self) -> String {
        let stretch = with_digits(self.curves.longest_bucket(), "s", 2);
        format!("the largest of every {stretch}, also at points that stay closed")
    }

    /// Which points of a contact stick and slip by turns, as the subject of a sentence; nothing if none does.
    pub(crate) fn alternating(&self, contact: &ContactDrawn) -> Option<String> {
        let points = contact.points.iter().zip(&self.forces[contact.first..]);
        let touching = points.filter_map(|(point, forces)| Some((point.label.as_str(), forces.as_ref()?.alternates)));
        who_alternates(&touching.collect::<Vec<_>>())
    }

    /// Which points of a contact are drawn as they are though others are smoothed, in a clause; nothing where all are alike.
    pub(crate) fn unsmoothed(&self, contact: &ContactDrawn, means: &[Option<Vec<f64>>]) -> Option<String> {
        let means = &means[contact.first..][..contact.points.len()];
        if means.iter().all(Option::is_none) {
            return None;
        }
        let points = contact.points.iter().zip(&self.forces[contact.first..]).zip(means);
        let presses =
            |forces: &Option<ForceCurve>| forces.as_ref().is_some_and(|of| of.normal.iter().any(|f| *f > 0.0));
        let raw = points.filter(|((_, forces), mean)| mean.is_none() && presses(forces));
        let names: Vec<&str> = raw.map(|((point, _), _)| point.label.as_str()).collect();
        let (last, others) = names.split_last()?;
        Some(match others {
            [] => format!("{last} is not smoothed: it presses only now and then"),
            _ => format!("{} and {last} are not smoothed: they press only now and then", others.join(", ")),
        })
    }

    /// The tangential force of all points of a contact together, if it is what is drawn.
    fn sum(&self, recorder: &PageRecorder, pair: usize) -> Option<Sum> {
        self.sums_tangential(pair).then_some(())?;
        let contact = &recorder.scenery.contacts[pair];
        let own = || self.forces[contact.first..contact.first + contact.points.len()].iter().flatten();
        let course = if self.curves.is_thinned() {
            recorder
                .sum_entry(pair)
                .and_then(|entry| self.curves.forces(entry)?.course)
                .map(|[_, tangential]| tangential)
        } else {
            // Of springs each step is known.
            let each: Option<Vec<&[f64]>> = own().map(|of| of.course.as_ref().map(|[_, y]| y.as_slice())).collect();
            each.map(|each| sum(each.into_iter()))
        };
        Some(match course {
            Some(y) if !y.is_empty() => Sum { y, is_course: true },
            _ => Sum { y: sum(own().map(|forces| forces.tangential.as_slice())), is_course: false },
        })
    }

    /// Where the axes of a contact's normal and tangential forces end because peaks dwarf the rest, N.
    pub(crate) fn cuts_of_contact(
        &self,
        recorder: &PageRecorder,
        pair: usize,
        means: &[Option<Vec<f64>>],
    ) -> [Option<Cut>; 2] {
        let contact = &recorder.scenery.contacts[pair];
        if contact.has_duration {
            return [None; 2];
        }
        let points = contact.first..contact.first + contact.points.len();
        let least = LEAST_FORCE * self.strongest();
        let own = self.forces[points.clone()].iter().zip(&means[points]);
        let own = own.filter_map(|(forces, mean)| Some((forces.as_ref()?, mean)));
        let raw = own.clone().map(|(forces, mean)| (mean.is_some(), forces.drawn(0)));
        let normal = raw.chain(own.clone().filter_map(|(_, mean)| Some((false, mean.as_deref()?))));
        let tangential = match &self.sums[pair] {
            Some(sum) => cut_at(std::iter::once((false, sum.y.as_slice())), least),
            None => cut_at(own.map(|(forces, _)| (false, forces.drawn(1))), least),
        };
        [cut_at(normal, least), tangential]
    }

    /// Where the axis of a second plot of a contact's normal forces ends, N, if the first one, with this cut, ends so far above what they mostly are that
    /// a resting weight can't be read there.
    pub(crate) fn enlarged_normal(
        &self,
        recorder: &PageRecorder,
        pair: usize,
        means: &[Option<Vec<f64>>],
        cut: Option<Cut>,
    ) -> Option<f64> {
        let contact = &recorder.scenery.contacts[pair];
        let points = contact.first..contact.first + contact.points.len();
        let own = self.forces[points.clone()].iter().zip(&means[points]);
        let strong = own.filter_map(|(forces, mean)| Some((forces.as_ref()?, mean)));
        let strong = strong.map(|(forces, mean)| mean.as_deref().unwrap_or_else(|| forces.drawn(0)));
        let limit = cut.map_or_else(|| largest(strong.clone().flatten()), |cut| cut.limit);
        enlarged(strong, limit, LEAST_FORCE * self.strongest())
    }

    /// The largest normal force of all contacts, N.
    pub(crate) fn strongest(&self) -> f64 {
        self.forces.iter().flatten().flat_map(|forces| &forces.normal).fold(0.0, |most: f64, f| f.max(most))
    }

    /// How many numbers the curves take on the page. The extremes of forces that rigid contacts have beside their means don't count: packed as they are,
    /// they make it no larger than is allowed, and with them all curves of a long run would be half as fine.
    fn numbers(&self, recorder: &PageRecorder) -> usize {
        let lines = self.panels.iter().flat_map(|panel| &panel.lines).map(|line| line.y.len()).sum::<usize>();
        let portraits = self.portraits.iter().flat_map(|portrait| &portrait.lines).map(|line| 3 * line.t.len());
        let of_course = |forces: &ForceCurve| forces.course.iter().flatten().map(Vec::len).sum::<usize>();
        let of_springs = recorder.springs.iter().filter_map(|point| self.forces[*point].as_ref()).map(of_course);
        let forces = self.forces.iter().flatten();
        let forces = forces.map(|forces| 3 * forces.normal.len() + forces.impacts.len());
        lines + portraits.sum::<usize>() + forces.sum::<usize>() + of_springs.sum::<usize>() + 3 * self.curves.len()
    }

    /// Notes that `what` isn't drawn: of whom, if it isn't of the whole scene, and what these are called together; its largest value and its scale.
    fn leave_out(
        &mut self,
        what: &'static str,
        of: Option<(String, &'static str)>,
        [largest, scale]: [f64; 2],
        unit: &'static str,
    ) {
        let bound = ROUNDING * scale;
        let (of, together) = of.map_or((None, ""), |(of, together)| (Some(of), together));
        match self.left_out.iter_mut().find(|known| known.what == what) {
            Some(known) => {
                known.of.extend(of);
                known.largest = known.largest.max(largest);
                known.bound = known.bound.max(bound);
            }
            None => self.left_out.push(LeftOut { what, of: of.into_iter().collect(), together, largest, bound, unit }),
        }
    }
}

/// Which points stick and slip by turns, of all with whether they do.
fn who_alternates(points: &[(&str, bool)]) -> Option<String> {
    let named: Vec<&str> = points.iter().filter(|(_, alternates)| *alternates).map(|(name, _)| *name).collect();
    match (named.len(), points.len()) {
        (0, _) => None,
        (1, 1) => Some("the point sticks and slips".to_owned()),
        (1, _) => Some(format!("{} sticks and slips", named[0])),
        (2, 2) => Some("both points stick and slip".to_owned()),
        (some, all) if some == all => Some(format!("all {all} points stick and slip")),
        (some, all) if some > MOST_NAMED => Some(format!("{some} of {all} points stick and slip")),
        _ => Some(format!("{} stick and slip", named.join(", "))),
    }
}

/// Most points of a contact that are told by their names.
const MOST_NAMED: usize = 3;

/// The tangential force of all points of a contact together, N.
#[derive(Debug)]
pub(crate) struct Sum {
    pub(crate) y: Vec<f64>,
    /// Whether its times are those of the curves, not the buckets.
    pub(crate) is_course: bool,
}

/// Curves at the same times together.
fn sum<'a>(curves: impl Iterator<Item = &'a [f64]>) -> Vec<f64> {
    let add = |mut total: Vec<f64>, curve: &[f64]| {
        total.resize(curve.len(), 0.0);
        total.iter_mut().zip(curve).for_each(|(total, force)| *total += force);
        total
    };
    curves.fold(Vec::new(), add)
}

#[cfg(test)]
mod tests {
    use super::who_alternates;

    #[test]
    fn who_sticks_and_slips_by_turns_is_named() {
        let of = |points: &[(&str, bool)]| who_alternates(points);
        assert_eq!(of(&[("left", false), ("right", false)]), None);
        assert_eq!(of(&[("left", true), ("right", false)]).unwrap(), "left sticks and slips");
        assert_eq!(of(&[("left", true), ("right", true)]).unwrap(), "both points stick and slip");
        assert_eq!(of(&[("left", true), ("right", true), ("hump 1", false)]).unwrap(), "left, right stick and slip");
        let humps: Vec<(&str, bool)> = (0..9).map(|k| ("hump", k > 3)).collect();
        assert_eq!(of(&humps).unwrap(), "5 of 9 points stick and slip");
    }
}
