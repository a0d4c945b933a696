//! The plots over time that the page and the figures have in common: which quantities, of which bodies, in which units, by the
//! rule of [`content`](super::content).

use super::content::{LeftOut, largest};
use super::curves::{Curves, ForceCurve};
use super::recorder::{NUMBERS, PageRecorder};
use super::redundant::{Redundant, redundant};
use super::scenery::ContactDrawn;
use teeter_scenario::scene::LengthUnit;

mod forces;
mod motion;

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
    pub(crate) note: Option<&'static str>,
    /// What is plotted.
    pub(crate) title: String,
    /// The contact whose it is, and its name where there are several.
    pub(crate) of_contact: Option<(usize, String)>,
    /// A sentence for those who can't see the figure.
    pub(crate) description: String,
    pub(crate) unit: String,
    /// Least height of its axis, in its unit.
    pub(crate) least: f64,
    /// Lines across it, in its unit.
    pub(crate) guides: Vec<f64>,
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
    /// Where in the curves it is from; none where its times are the borders of buckets, not those of the curves.
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

impl Line {
    /// A column of the curves, multiplied by `factor`.
    fn of(curves: &Curves, column: usize, factor: f64, label: String, number: usize) -> Self {
        Self::from_zero(curves, Source { column, zero: 0.0, factor }, label, number)
    }

    fn from_zero(curves: &Curves, source: Source, label: String, number: usize) -> Self {
        let y = curves.curve(source.column).into_iter().map(|x| source.drawn(x)).collect();
        Self { label, number, y, of: Some(source) }
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
}

/// All that is drawn over time of a run, but contact forces, and what isn't.
#[derive(Debug)]
pub(crate) struct Panels {
    pub(crate) curves: Curves,
    pub(crate) forces: Vec<Option<ForceCurve>>,
    pub(crate) panels: Vec<TimePanel>,
    pub(crate) portraits: Vec<Portrait>,
    pub(crate) left_out: Vec<LeftOut>,
    /// The prefixes of the units of normal and of tangential forces, with their factors, by contacts.
    pub(crate) force_units: Vec<[(&'static str, f64); 2]>,
    /// The prefix of the unit of impulses of impacts, with its factor: that of the largest of all.
    pub(crate) impulse_unit: (&'static str, f64),
    /// Whether normal forces are more than rounding, by contacts: not of those that only strike.
    pub(crate) normal: Vec<bool>,
    /// Whether tangential forces are more than rounding, by contacts.
    pub(crate) tangential: Vec<bool>,
    /// What equilibrium leaves open of the forces, by contacts.
    pub(crate) redundant: Vec<Redundant>,
}

/// Numbers of a length as large as this are in a larger unit than the scene's.
const LARGE: f64 = 1e4;

/// The unit of lengths on an axis, with its number to a metre: the scene's, unless it makes numbers too small or too large.
pub(crate) fn length_unit(of: LengthUnit, largest: f64) -> (&'static str, f64) {
    let own = (of.word(), of.per_metre());
    if largest * own.1 >= LARGE {
        return if largest >= LARGE { ("km", 1e-3) } else { ("m", 1.0) };
    }
    let units = [own, ("mm", 1e3), ("µm", 1e6), ("nm", 1e9)];
    let fits = |(_, factor): &&(&'static str, f64)| largest == 0.0 || largest * factor >= 0.5;
    units.iter().find(fits).copied().unwrap_or(("nm", 1e9))
}

/// The prefix of a unit, with its factor, that makes the largest of some values a handy number.
pub(crate) fn prefix(largest: f64) -> (&'static str, f64) {
    let large = [("G", 1e-9), ("M", 1e-6), ("k", 1e-3), ("", 1.0)];
    let small = [("m", 1e3), ("µ", 1e6), ("n", 1e9), ("p", 1e12), ("f", 1e15), ("a", 1e18), ("z", 1e21)];
    large.into_iter().chain(small).find(|(_, factor)| largest * factor >= 0.5).unwrap_or(("", 1.0))
}

/// The largest of forces as they are seen: where the peaks of impacts dwarf all else and are cut, the size at which they are.
fn seen<'a>(forces: impl Iterator<Item = &'a f64>) -> f64 {
    let mut sizes: Vec<f64> = forces.map(|f| f.abs()).filter(|f| f.is_finite()).collect();
    let most = largest(&sizes);
    sizes.retain(|f| *f > LEAST_FORCE * most);
    cut_at(sizes).map_or(most, |(limit, _)| limit)
}

/// The prefixes of the units of normal and tangential forces, with their factors, by contacts: those of the largest normal forces of all, so that forces can
/// be compared, but for what would be [`SMALL`] there, as friction that hardly acts beside a weight.
fn force_units(recorder: &PageRecorder, forces: &[Option<ForceCurve>]) -> Vec<[(&'static str, f64); 2]> {
    // Peaks of springs are forces that act, and are shown whole.
    let has_springs = recorder.scenery.contacts.iter().any(|contact| contact.has_duration);
    let seen = |forces: &mut dyn Iterator<Item = &f64>| if has_springs { largest(forces) } else { seen(forces) };
    let common = prefix(seen(&mut forces.iter().flatten().flat_map(|forces| &forces.normal)));
    let unit = |size: f64| if size > 0.0 && size * common.1 < SMALL { prefix(size) } else { common };
    let of = |contact: &ContactDrawn| {
        let own = || forces[contact.first..contact.first + contact.points.len()].iter().flatten();
        let sizes = [
            seen(&mut own().flat_map(|forces| &forces.normal)),
            seen(&mut own().flat_map(|forces| &forces.tangential)),
        ];
        sizes.map(unit)
    };
    recorder.scenery.contacts.iter().map(of).collect()
}

/// Numbers below this are small for an axis: their unit is another one.
const SMALL: f64 = 0.1;

/// A force this many times the one that nine of ten samples stay below is a peak of an impact, whose height is that of
/// the sample's length; the axis then ends at half as much, for the rest to be legible.
const PEAK: f64 = 6.0;

/// Where an axis of forces of these sizes ends because peaks dwarf the rest, and the largest of them.
pub(crate) fn cut_at(mut sizes: Vec<f64>) -> Option<(f64, f64)> {
    sizes.sort_by(f64::total_cmp);
    let (&usual, &largest) = (sizes.get(sizes.len() * 9 / 10)?, sizes.last()?);
    (largest > PEAK * usual).then_some((0.5 * PEAK * usual, largest))
}

/// A force below this part of the largest is none.
const LEAST_FORCE: f64 = 1e-6;

/// The unit of a time axis as long as `duration`, with its number to a second.
pub(crate) fn time_unit(duration: f64) -> (&'static str, f64) {
    let units = [("s", 1.0), ("ms", 1e3), ("µs", 1e6)];
    // 0.1 s is still read well in seconds.
    units.into_iter().find(|(_, factor)| duration * factor >= 0.099).unwrap_or(("ns", 1e9))
}

impl Panels {
    pub(crate) fn of(recorder: &PageRecorder) -> Self {
        let forces = |curves: &Curves| (0..recorder.scenery.points).map(|k| curves.forces(k)).collect::<Vec<_>>();
        let drawn = |curves: Curves| {
            let forces = forces(&curves);
            let mut panels = Self {
                normal: vec![true; recorder.scenery.contacts.len()],
                tangential: vec![true; recorder.scenery.contacts.len()],
                redundant: redundant(recorder, &curves, &forces),
                force_units: force_units(recorder, &forces),
                impulse_unit: prefix(largest(forces.iter().flatten().flat_map(|forces| &forces.impacts))),
                curves,
                forces,
                panels: Vec::new(),
                portraits: Vec::new(),
                left_out: Vec::new(),
            };
            panels.fill(recorder);
            panels
        };
        let all = drawn(recorder.kept.curves.clone());
        let (buckets, numbers) = (all.curves.len(), all.numbers());
        if numbers <= NUMBERS {
            return all;
        }
        drawn(all.curves.in_at_most(buckets * NUMBERS / numbers))
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
        if !recorder.scenery.is_crowded() {
            self.portraits(recorder);
        }
    }

    /// Whether forces of contacts are one of many sets at the end of the run.
    pub(crate) fn many_at_end(&self) -> bool {
        self.redundant.iter().any(|redundant| redundant.at_end)
    }

    /// How many numbers the curves take on the page.
    fn numbers(&self) -> usize {
        let lines = self.panels.iter().flat_map(|panel| &panel.lines).map(|line| line.y.len()).sum::<usize>();
        let portraits = self.portraits.iter().flat_map(|portrait| &portrait.lines).map(|line| 3 * line.t.len());
        let forces = self.forces.iter().flatten().map(|forces| 3 * forces.normal.len() + forces.impacts.len());
        lines + portraits.sum::<usize>() + forces.sum::<usize>() + 3 * self.curves.len()
    }

    /// Notes that `what` isn't drawn: of whom, if it isn't of the whole scene, and what these are called together.
    fn leave_out(&mut self, what: &'static str, of: Option<(String, &'static str)>, largest: f64, unit: &'static str) {
        let (of, together) = of.map_or((None, ""), |(of, together)| (Some(of), together));
        match self.left_out.iter_mut().find(|known| known.what == what) {
            Some(known) => {
                known.of.extend(of);
                known.largest = known.largest.max(largest);
            }
            None => self.left_out.push(LeftOut { what, of: of.into_iter().collect(), together, largest, unit }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_in_the_unit_of_the_scene_unless_too_small_for_it() {
        assert_eq!(length_unit(LengthUnit::Centimetre, 0.18), ("cm", 100.0));
        assert_eq!(length_unit(LengthUnit::Centimetre, 1.2e-3), ("mm", 1e3));
        assert_eq!(length_unit(LengthUnit::Metre, 3e-7), ("nm", 1e9));
        assert_eq!(length_unit(LengthUnit::Millimetre, 0.0), ("mm", 1e3));
        // A block that flies off, in a scene of centimetres.
        assert_eq!(length_unit(LengthUnit::Centimetre, 99.0), ("cm", 100.0));
        assert_eq!(length_unit(LengthUnit::Centimetre, 6e3), ("m", 1.0));
        assert_eq!(length_unit(LengthUnit::Metre, 6e4), ("km", 1e-3));
    }

    #[test]
    fn peaks_that_are_cut_dont_set_the_unit() {
        let mut forces = vec![14.0; 99];
        forces.push(1820.0);
        assert_eq!((seen(forces.iter()), prefix(seen(forces.iter())).0), (42.0, ""));
        assert_eq!(seen([14.0, 20.0, 0.0].iter()), 20.0);
        assert_eq!(seen([].iter()), 0.0);
    }

    #[test]
    fn any_size_has_a_unit_that_suits() {
        assert_eq!([4e9, 6.8e8, 2e4, 400.0, 0.2, 4e-21].map(|x| prefix(x).0), ["G", "G", "k", "", "m", "z"]);
        assert_eq!([3600.0, 0.1, 1e-3, 3e-6, 1e-9].map(|t| time_unit(t).0), ["s", "s", "ms", "µs", "ns"]);
    }
}
