//! The units of the page: one for each kind of quantity, where its values lie so near to each other that one suits all.

use super::TimePanel;
use super::cut::{Cut, cut_at};
use crate::page::content::largest;
use crate::page::curves::ForceCurve;
use crate::page::recorder::PageRecorder;
use crate::page::scenery::ContactDrawn;
use teeter_scenario::scene::LengthUnit;

/// A unit's prefix, or a unit of length, with its number to the SI unit.
pub(crate) type Unit = (&'static str, f64);

/// Kinds of quantities that have one unit each, where that suits them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Measure {
    /// Where bodies and ground are.
    Position,
    /// The rates of these.
    Velocity,
    /// What is small beside bodies: deflections of beams, slip.
    Deflection,
    Force,
    Moment,
    Energy,
    /// Those of a plot that are in their unit already.
    Own,
}

impl Measure {
    fn is_length(self) -> bool {
        matches!(self, Self::Position | Self::Velocity | Self::Deflection)
    }

    /// What follows the prefix or the unit of length.
    fn base(self) -> &'static str {
        match self {
            Self::Velocity => "/s",
            Self::Force => "N",
            Self::Moment => "N m",
            Self::Energy => "J",
            Self::Position | Self::Deflection | Self::Own => "",
        }
    }
}

/// The units that the quantities of a page have come to.
#[derive(Debug, Clone)]
pub(crate) struct Units {
    own: LengthUnit,
    chosen: Vec<(Measure, f64, Unit)>,
}

/// Values that are farther apart than this have units of their own.
const WITHIN: f64 = 1e4;

/// Numbers below this are small for an axis.
const SMALL: f64 = 0.1;

/// Numbers of lengths as large as this are in no smaller unit than would suit them alone: a deflection of 2 mm isn't one of 2000 µm.
const LARGE_LENGTH: f64 = 1e3;

/// Numbers as large as this are in no smaller unit for the sake of others: 4 J isn't 4000 mJ.
const LONG: f64 = 2e3;

/// Numbers of a length as large as this are in a larger unit than the scene's.
const LARGE: f64 = 1e4;

impl Units {
    /// Units for quantities by their sizes, in SI units, in a scene with this unit of length.
    pub(super) fn of(own: LengthUnit, sizes: &[(Measure, f64)]) -> Self {
        let mut units = Self { own, chosen: Vec::new() };
        let mut left: Vec<(Measure, f64)> = sizes.iter().copied().filter(|(_, size)| *size > 0.0).collect();
        left.sort_by(|a, b| b.1.total_cmp(&a.1));
        while let Some(&(measure, most)) = left.first() {
            let (near, far) =
                left.into_iter().partition::<Vec<_>, _>(|(of, size)| *of == measure && size * WITHIN >= most);
            let least = near.last().map_or(most, |(_, size)| *size);
            let unit = units.suiting(measure, most, least);
            units.chosen.extend(near.into_iter().map(|(_, size)| (measure, size, unit)));
            left = far;
        }
        units
    }

    /// The unit that makes handy numbers of both.
    fn suiting(&self, measure: Measure, most: f64, least: f64) -> Unit {
        let alone = self.alone(measure, most);
        if least * alone.1 >= SMALL {
            return alone;
        }
        let for_least = self.alone(measure, least);
        if measure.is_length() {
            // Else small ones have a unit of their own: the large ones are what the scene is about.
            let suits = |unit: &Unit| unit.1 > alone.1 && most * unit.1 < LARGE_LENGTH;
            return [for_least, ("mm", 1e3)].into_iter().find(suits).unwrap_or(alone);
        }
        // What is between both is still one where it makes no long numbers of the large ones.
        let between = self.alone(measure, (most * least).sqrt());
        [for_least, between].into_iter().find(|unit| most * unit.1 < LONG).unwrap_or(alone)
    }

    fn alone(&self, measure: Measure, size: f64) -> Unit {
        if measure.is_length() { length_unit(self.own, size) } else { prefix(size) }
    }

    /// The unit of a quantity of this size, in SI units: that of the nearest of its kind, unless that is too far from it or
    /// makes no readable number.
    pub(crate) fn unit(&self, measure: Measure, size: f64) -> Unit {
        let apart = |other: f64| (other / size).ln().abs();
        let same = self.chosen.iter().filter(|(of, ..)| *of == measure && size > 0.0);
        let nearest = same.min_by(|a, b| apart(a.1).total_cmp(&apart(b.1)));
        let suits = |(_, factor): Unit| (0.1 * SMALL..10.0 * LARGE).contains(&(size * factor));
        let near = nearest.filter(|(_, other, unit)| apart(*other) <= WITHIN.ln() && suits(*unit));
        near.map_or_else(|| self.alone(measure, size), |(.., unit)| *unit)
    }
}

impl TimePanel {
    /// Where its axis ends because peaks dwarf the rest, or what rings its mean.
    pub(crate) fn cut_at(&self) -> Option<Cut> {
        cut_at(self.lines.iter().map(|line| (line.is_raw, line.y.as_slice())), self.least).filter(|_| self.cut)
    }

    /// How large its values are that are seen.
    pub(super) fn size(&self) -> f64 {
        self.cut_at().map_or_else(|| largest(self.lines.iter().flat_map(|line| &line.y)), |cut| cut.limit)
    }

    /// Turns its values from SI units into this one.
    pub(super) fn show_in(&mut self, (name, factor): Unit) {
        self.unit = format!("{name}{}", self.measure.base());
        self.least *= factor;
        for line in &mut self.lines {
            line.y.iter_mut().for_each(|y| *y *= factor);
            if let Some(source) = &mut line.of {
                source.factor *= factor;
            }
        }
    }
}

/// The unit of lengths on an axis, with its number to a metre: the scene's, unless it makes numbers too small or too large.
pub(crate) fn length_unit(of: LengthUnit, largest: f64) -> Unit {
    let own = (of.word(), of.per_metre());
    if largest * own.1 >= LARGE {
        return if largest >= LARGE { ("km", 1e-3) } else { ("m", 1.0) };
    }
    let units = [own, ("mm", 1e3), ("µm", 1e6), ("nm", 1e9)];
    let fits = |(_, factor): &&Unit| largest == 0.0 || largest * factor >= 0.5;
    units.iter().find(fits).copied().unwrap_or(("nm", 1e9))
}

/// The prefix of a unit, with its factor, in which the largest of some values is at least 1 and below 1000; G also where it is larger, none where it is 0 or
/// too small for all of them.
pub(crate) fn prefix(largest: f64) -> Unit {
    let large = [("G", 1e-9), ("M", 1e-6), ("k", 1e-3), ("", 1.0)];
    let small = [("m", 1e3), ("µ", 1e6), ("n", 1e9), ("p", 1e12), ("f", 1e15), ("a", 1e18), ("z", 1e21)];
    large.into_iter().chain(small).find(|(_, factor)| largest * factor >= 1.0).unwrap_or(("", 1.0))
}

/// The unit of a time axis as long as `duration`, with its number to a second.
pub(crate) fn time_unit(duration: f64) -> Unit {
    let units = [("s", 1.0), ("ms", 1e3), ("µs", 1e6)];
    // 0.1 s is still read well in seconds.
    units.into_iter().find(|(_, factor)| duration * factor >= 0.099).unwrap_or(("ns", 1e9))
}

/// The largest of forces as they are seen: where the peaks of impacts dwarf all else and are cut, the size at which they are.
fn seen<'a>(curves: impl Iterator<Item = &'a [f64]> + Clone) -> f64 {
    let most = largest(curves.clone().flatten());
    cut_at(curves.map(|curve| (false, curve)), LEAST_FORCE * most).map_or(most, |cut| cut.limit)
}

/// How large normal and tangential forces of each contact are, as they are seen, N.
pub(super) fn contact_sizes(recorder: &PageRecorder, forces: &[Option<ForceCurve>]) -> Vec<[f64; 2]> {
    // Peaks of springs are forces that act, and are shown whole.
    let has_springs = recorder.scenery.contacts.iter().any(|contact| contact.has_duration);
    let of = |contact: &ContactDrawn| {
        let own = forces[contact.first..contact.first + contact.points.len()].iter().flatten();
        let parts: [fn(&ForceCurve) -> &[f64]; 2] = [|forces| forces.drawn(0), |forces| forces.drawn(1)];
        parts.map(|part| if has_springs { largest(own.clone().flat_map(part)) } else { seen(own.clone().map(part)) })
    };
    recorder.scenery.contacts.iter().map(of).collect()
}

/// The units of the impulses of impacts of each contact: that of the largest of all, in which no number is small, else its own.
pub(super) fn impulse_units(recorder: &PageRecorder, forces: &[Option<ForceCurve>]) -> Vec<Unit> {
    let of = |contact: &ContactDrawn| {
        let own = &forces[contact.first..contact.first + contact.points.len()];
        largest(own.iter().flatten().flat_map(|forces| &forces.impacts))
    };
    let sizes: Vec<f64> = recorder.scenery.contacts.iter().map(of).collect();
    beside_the_largest(&sizes)
}

/// The unit of the largest of these for each of them in which it is no small number; else its own.
fn beside_the_largest(sizes: &[f64]) -> Vec<Unit> {
    let shared = prefix(sizes.iter().copied().fold(0.0, f64::max));
    sizes.iter().map(|size| if size * shared.1 < SMALL { prefix(*size) } else { shared }).collect()
}

/// A force below this part of the largest is none.
pub(crate) const LEAST_FORCE: f64 = 1e-6;

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
    fn quantities_of_a_kind_have_one_unit_unless_they_are_far_apart() {
        use Measure::{Deflection, Energy, Force, Moment, Position};
        let of = |sizes: &[(Measure, f64)]| {
            let units = Units::of(LengthUnit::Centimetre, sizes);
            sizes.iter().map(|(measure, size)| units.unit(*measure, *size).0).collect::<Vec<_>>()
        };
        // A block's weight, and the reactions of the beam that it stands on, with their impacts.
        assert_eq!(of(&[(Force, 350.0), (Force, 1.05e3), (Moment, 60.0)]), ["k", "k", ""]);
        assert_eq!(of(&[(Force, 57.0), (Force, 1.05e3)]), ["", ""], "0.057 kN would be small");
        assert_eq!(of(&[(Energy, 0.188), (Energy, 2.2)]), ["", ""]);
        assert_eq!(of(&[(Force, 14.0), (Force, 2e-4)]), ["", "µ"], "more than 10⁴ apart");
        assert_eq!(of(&[(Deflection, 3e-3), (Deflection, 0.13)]), ["cm", "cm"]);
        assert_eq!(of(&[(Deflection, 9e-4), (Deflection, 0.13)]), ["mm", "mm"]);
        assert_eq!(of(&[(Deflection, 6e-7), (Deflection, 2.4e-3)]), ["µm", "mm"], "not 2400 µm");
        assert_eq!(of(&[(Deflection, 3e-5), (Deflection, 2.4e-3)]), ["mm", "mm"]);
        assert_eq!(of(&[(Deflection, 1e-4), (Deflection, 0.1)]), ["mm", "mm"], "not 0.01 cm");
        assert_eq!(of(&[(Deflection, 4e-4), (Deflection, 0.31)]), ["mm", "mm"], "not 0.04 cm");
        assert_eq!(of(&[(Energy, 4.0), (Energy, 1e-3)]), ["", "m"], "not 4000 mJ");
        assert_eq!(of(&[(Position, 2e-3), (Position, 0.45), (Deflection, 2e-3)]), ["cm", "cm", "mm"]);
        assert_eq!(of(&[(Energy, 13.6), (Energy, 5e-3)]), ["", "m"], "not 13600 mJ");
        assert_eq!(of(&[(Energy, 13.6), (Energy, 0.05)]), ["", ""]);
        // What was not among those that chose.
        let units = Units::of(LengthUnit::Metre, &[(Force, 5e3), (Force, 300.0)]);
        assert_eq!([2e3, 200.0, 0.1].map(|size| units.unit(Force, size).0), ["k", "k", "m"]);
    }

    #[test]
    fn a_small_impulse_is_in_a_unit_of_its_own() {
        let names = |sizes: &[f64]| beside_the_largest(sizes).into_iter().map(|unit| unit.0).collect::<Vec<_>>();
        assert_eq!(names(&[2.9, 2e-4, 0.3, 0.0]), ["", "µ", "", ""], "not 0.0002 N s");
    }

    #[test]
    fn peaks_that_are_cut_dont_set_the_unit() {
        let seen = |forces: &[f64]| super::seen(std::iter::once(forces));
        let mut forces = vec![14.0; 99];
        forces.push(1820.0);
        assert_eq!((seen(&forces), prefix(seen(&forces)).0), (42.0, ""));
        assert_eq!(seen(&[14.0, 20.0, 0.0]), 20.0);
        assert_eq!(seen(&[]), 0.0);
    }

    #[test]
    fn any_size_has_a_unit_that_suits() {
        assert_eq!([4e9, 6.8e8, 2e4, 400.0, 0.2, 4e-21].map(|x| prefix(x).0), ["G", "M", "k", "", "m", "z"]);
        assert_eq!([3600.0, 0.1, 1e-3, 3e-6, 1e-9].map(|t| time_unit(t).0), ["s", "s", "ms", "µs", "ns"]);
    }
}
