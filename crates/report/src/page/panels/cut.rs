//! Axes that end where peaks dwarf all else.

use crate::page::content::largest;
use crate::shortest;

/// An axis that ends before the largest values of its curves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cut {
    /// Where it ends, to both sides of 0.
    pub(crate) limit: f64,
    /// The least and the largest value of the curves, or 0.
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl Cut {
    pub(crate) fn scaled(self, factor: f64) -> Self {
        Self { limit: factor * self.limit, low: factor * self.low, high: factor * self.high }
    }

    /// How far what is cut goes: to one side, or to both.
    pub(crate) fn reach(&self, unit: &str) -> String {
        self.reach_beyond(self.limit, unit)
    }

    /// How far all goes where none of it is drawn.
    pub(crate) fn whole_reach(&self, unit: &str) -> String {
        self.reach_beyond(0.01 * self.limit, unit)
    }

    fn reach_beyond(&self, limit: f64, unit: &str) -> String {
        let [low, high] = [self.low, self.high].map(|end| shortest(end, 3).replace('-', "\u{2212}"));
        match (self.low < -limit, self.high > limit) {
            (true, true) => format!("from {low} to {high} {unit}"),
            (true, false) => format!("down to {low} {unit}"),
            (false, _) => format!("up to {high} {unit}"),
        }
    }
}

/// A force this many times the one that nine of ten samples stay below is a peak of an impact, whose height is that of
/// the sample's length; the axis then ends at half as much, for the rest to be legible.
const PEAK: f64 = 6.0;

/// What rings by this many times the largest mean would make all means one line; the axis then ends at half as much.
const RINGS: f64 = 3.0;

/// Where the axis of these curves ends because peaks dwarf the rest, or what rings its mean: the one rule for page and
/// figures. Each curve is told with whether it stays pale behind a mean; values of no more than `least` count as none.
///
/// However many curves are small, none of the others is cut below what it bears on average over the run, and no strong one before its largest value
/// where others are pale.
pub(crate) fn cut_at<'a>(curves: impl Iterator<Item = (bool, &'a [f64])> + Clone, least: f64) -> Option<Cut> {
    let all = largest(curves.clone().flat_map(|(_, y)| y));
    let strong = || curves.clone().filter(|(is_raw, _)| !is_raw).map(|(_, y)| y);
    let means = largest(strong().flatten());
    let limit = if curves.clone().any(|(is_raw, _)| is_raw) && means > 0.0 && all > RINGS * means {
        0.5 * RINGS * means
    } else {
        let mut sizes: Vec<f64> = curves.clone().flat_map(|(_, y)| y).map(|y| y.abs()).collect();
        sizes.retain(|y| y.is_finite() && *y > least);
        sizes.sort_by(f64::total_cmp);
        let usual = sizes.get(sizes.len() * 9 / 10)?;
        if all > PEAK * usual { 0.5 * PEAK * usual } else { all }
    };
    let limit = strong().map(borne).fold(limit, f64::max);
    // What is said to be cut is what is pale: a curve that seems to be whole would be read as such.
    let limit = if curves.clone().any(|(is_raw, _)| is_raw) { limit.max(means) } else { limit };
    let values = || curves.clone().flat_map(|(_, y)| y).copied().filter(|y| y.is_finite());
    (limit < all).then(|| Cut { limit, low: values().fold(0.0, f64::min), high: values().fold(0.0, f64::max) })
}

/// A plot that ends this many times as far as is asked for by what its curves mostly are leaves nothing of that to read.
const FAR: f64 = 5.0;

/// What curves mostly are has so many times its size as room.
const ROOM: f64 = 3.0;

/// Where the axis of a second, enlarged plot of these strong curves ends, if the first one, up to `limit`, ends so far above what they mostly are, by the
/// median of all that are more than `least`, that this can't be read there. None of them ends below what it bears on average.
pub(crate) fn enlarged<'a>(strong: impl Iterator<Item = &'a [f64]> + Clone, limit: f64, least: f64) -> Option<f64> {
    let mut sizes: Vec<f64> = strong.clone().flatten().map(|y| y.abs()).collect();
    sizes.retain(|y| y.is_finite() && *y > least);
    sizes.sort_by(f64::total_cmp);
    let end = strong.map(borne).fold(ROOM * sizes.get(sizes.len() / 2)?, f64::max);
    (limit > FAR * end).then_some(end)
}

/// How large a curve is on average.
fn borne(y: &[f64]) -> f64 {
    y.iter().filter(|y| y.is_finite()).map(|y| y.abs()).sum::<f64>() / y.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_cut_is_told_as_far_as_it_goes_to_either_side() {
        let cut = |low: f64, high: f64| Cut { limit: 10.0, low, high };
        assert_eq!(cut(-20.0, 88.5).reach("N"), "from \u{2212}20 to 88.5 N");
        assert_eq!(cut(-2.0, 88.5).reach("N"), "up to 88.5 N", "its lower end is seen");
        assert_eq!(cut(-2.0, 88.5).whole_reach("N"), "from \u{2212}2 to 88.5 N", "nothing of it is seen");
        assert_eq!(cut(-88.5, 2.0).scaled(2.0).reach("kN"), "down to \u{2212}177 kN");
        let uneven = [&[-20.0, 88.5][..], &[1.0; 98]].concat();
        let cut = cut_at(std::iter::once((false, &uneven[..])), 1e-6).unwrap();
        assert_eq!((cut.low, cut.high), (-20.0, 88.5));
    }

    #[test]
    fn no_strong_curve_is_cut_where_others_are_pale() {
        // A stress that rings up to 9, with a line through its largest values, of which one of twenty is 6.
        let rings: Vec<f64> = (0..100).map(|k| if k == 50 { 9.0 } else { 1.0 }).collect();
        let strong: Vec<f64> = (0..100).map(|k| if (48..53).contains(&k) { 6.0 } else { 1.0 }).collect();
        let cut = cut_at([(true, &rings[..]), (false, &strong[..])].into_iter(), 1e-6).unwrap();
        assert_eq!((cut.limit, cut.high), (6.0, 9.0));
    }

    #[test]
    fn what_rests_below_peaks_that_are_not_cut_is_shown_once_more() {
        // A weight of 47 N, and a blow of 1200 N that isn't cut, as it is a strong curve.
        let weight: Vec<f64> = (0..100).map(|k| if k == 50 { 1200.0 } else { 47.0 }).collect();
        let enlarged = |limit: f64| enlarged(std::iter::once(&weight[..]), limit, 1e-3);
        assert_eq!([enlarged(1200.0), enlarged(600.0)], [Some(141.0), None]);
        assert_eq!(super::enlarged(std::iter::once(&[0.0; 9][..]), 1200.0, 1e-3), None);
        // Beside it many hardly press: what bears 58.53 N on average isn't left out for these.
        let chatter = [0.01; 500];
        let end = super::enlarged([&weight[..], &chatter[..]].into_iter(), 1200.0, 1e-3).unwrap();
        assert!((end - 58.53).abs() < 1e-9, "{end}");
    }

    #[test]
    fn small_curves_cut_no_loaded_one() {
        let loaded: Vec<f64> = (0..100).map(|k| if k % 2 == 0 { 10.0 } else { 0.0 }).collect();
        let [hump, chatter] = [vec![0.5; 3], vec![0.01; 100]];
        let cut = |curves: &[(bool, &[f64])]| cut_at(curves.iter().copied(), 1e-6);
        // A point that touched a few times, and many that hardly press.
        assert_eq!(cut(&[(false, &loaded), (false, &hump)]), None);
        let many: Vec<(bool, &[f64])> =
            std::iter::once((false, &loaded[..])).chain((0..20).map(|_| (false, &chatter[..]))).collect();
        assert_eq!(cut(&many), Some(Cut { limit: 5.0, low: 0.0, high: 10.0 }), "not at 0.03: the mean is 5");
        // What rings is cut by its mean; without one that is larger than nothing, by nothing.
        assert_eq!(cut(&[(true, &loaded), (false, &hump)]), Some(Cut { limit: 0.75, low: 0.0, high: 10.0 }));
        assert_eq!(cut(&[(true, &loaded), (false, &[0.0])]), None);
    }
}
