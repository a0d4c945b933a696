//! Phase portraits of blocks: a coordinate and its velocity, one over the other.

use super::motion::{COORDINATES, PHI, block_label, from_base, guides, is_from_start, nears, zero};
use super::{Measure, Panels, Portrait, PortraitLine, coincident};
use crate::page::content::{holds, largest, travel};
use crate::page::orbit::Point;
use crate::page::recorder::{BLOCK_COLUMNS, BLOCK_COORDINATES, PageRecorder};
use std::f64::consts::PI;
use std::ops::Range;

/// Most points of all phase portraits together.
const PORTRAIT_POINTS: usize = 16_000;

/// A block that turns by this part of what it moves otherwise has φ in its phase portrait.
const TURNS: f64 = 0.01;

impl Panels {
    /// How far a block goes along an axis beside what may carry it: of the world, or what it is plotted from, and the other prescribed motions
    /// along that axis, the one from which it goes least far.
    fn carried_travel(&self, recorder: &PageRecorder, block: usize, axis: usize) -> f64 {
        let own = self.curves.curve(BLOCK_COLUMNS * block + axis);
        let base = recorder.scenery.bases[axis];
        let along = recorder.scenery.driven.iter().enumerate();
        let along = along.filter(|(which, driven)| driven.component == axis && base != Some(*which));
        let beside = along.map(|(which, _)| {
            let carrier = self.curves.curve(recorder.scenery.driven_column(which));
            travel(&own.iter().zip(&carrier).map(|(own, carrier)| own - carrier).collect::<Vec<_>>())
        });
        beside.fold(travel(&own), f64::min)
    }

    /// The coordinate in which each block moves most over its velocity.
    pub(super) fn portraits(&mut self, recorder: &PageRecorder) {
        let display = recorder.scenery.display;
        let moves = |k: usize, c: usize| travel(&self.curves.curve(BLOCK_COLUMNS * k + c));
        let rocks = |k: usize| holds(moves(k, PHI), 1.0) && moves(k, PHI) <= PI;
        let others_rock = (0..recorder.scenery.blocks.len()).any(rocks);
        let reach_of = |k: usize| recorder.scenery.blocks[k].reach;
        let choice = |k: usize| {
            let reach = reach_of(k);
            // What is prescribed would have the portrait of its signal.
            let free = recorder.scenery.blocks[k].prescribed.map(|prescribed| if prescribed { 0.0 } else { 1.0 });
            let [x, y, turn] = [0, 1, PHI].map(|c| free[c] * moves(k, c));
            let [across, up] = [0, 1].map(|c| free[c] * self.carried_travel(recorder, k, c));
            // Beside what rocks, a ball has its way in its portrait, as its turns would stretch the axis.
            let rolls = turn > PI && others_rock;
            if !rolls && holds(turn, 1.0) && turn * reach >= TURNS * across.max(up) {
                Some(PHI)
            } else {
                [(0, x), (1, y)]
                    .into_iter()
                    .filter(|(_, far)| holds(*far, reach))
                    .max_by(|a, b| a.1.total_cmp(&b.1))
                    .map(|(c, _)| c)
            }
        };
        let chosen: Vec<(usize, usize)> =
            (0..recorder.scenery.blocks.len()).filter_map(|k| Some((k, choice(k)?))).collect();
        for c in [PHI, 0, 1] {
            let blocks = || chosen.iter().filter(|(_, own)| *own == c).map(|(k, _)| *k);
            if blocks().next().is_none() {
                continue;
            }
            let points =
                |k: usize| recorder.kept.orbits[BLOCK_COORDINATES * k + c].points(PORTRAIT_POINTS / chosen.len());
            let mut orbits: Vec<(usize, Vec<Point>)> = blocks().filter_map(|k| Some((k, points(k)?))).collect();
            let untraced = blocks().filter(|k| orbits.iter().all(|(drawn, _)| drawn != k));
            self.untraced.extend(untraced.map(|k| recorder.scenery.blocks[k].name.clone()));
            if orbits.is_empty() {
                continue;
            }
            // As the plot of the coordinate, so that what stands far apart isn't a row of upright lines.
            let moving = (0..recorder.scenery.blocks.len()).filter(|k| holds(moves(*k, c), reach_of(*k)));
            let moving: Vec<_> = moving.map(|k| (k, self.curves.curve(BLOCK_COLUMNS * k + c))).collect();
            let from_start = orbits.len() > 1 && is_from_start(c, &moving);
            for (k, points) in orbits.iter_mut().filter(|_| from_start) {
                let zero = zero(recorder, *k, c);
                points.iter_mut().for_each(|point| point[1] -= zero);
            }
            let (units, factors) = if c == PHI {
                ([display.angle.symbol(), "rad"], [display.angle.per_radian(), 1.0])
            } else {
                let most = |of: usize| largest(orbits.iter().flat_map(|(_, points)| points).map(|point| &point[of]));
                let [(x, a), (v, b)] = [(Measure::Position, 1), (Measure::Velocity, 2)]
                    .map(|(measure, of)| self.units.unit(measure, most(of)));
                ([x, v], [a, b])
            };
            let line = |(k, points): (usize, Vec<Point>)| {
                let strong = strong(&points);
                let values = |of: usize, factor: f64| points.iter().map(|point| point[of] * factor).collect();
                PortraitLine {
                    label: block_label(recorder, k),
                    number: k,
                    t: values(0, 1.0),
                    x: values(1, factors[0]),
                    v: values(2, factors[1]),
                    strong,
                    over: 0,
                    alone: Vec::new(),
                }
            };
            let coordinate = &COORDINATES[c];
            let reach = blocks().map(reach_of).fold(0.0, f64::max);
            // Of several, only of those that come near: nobody could tell whose the others are.
            let alone = orbits.len() == 1;
            let near = |(k, points): &(usize, Vec<Point>)| {
                let tops = nears(recorder, *k, points.iter().map(|point| point[1]));
                if alone { recorder.points_of_no_return[*k] } else { tops }
            };
            let tops = orbits.iter().filter(|_| c == PHI).filter_map(near);
            let guides = guides(tops, factors[0]);
            let on = from_base(recorder, &self.curves, c);
            let strong = what_is_strong(orbits.iter().map(|(_, points)| (strong(points), points.len())));
            let mut lines: Vec<PortraitLine> = orbits.into_iter().map(line).collect();
            let coincide = match coincident::tell_apart(&mut lines) {
                0 => None,
                count => Some(format!("{count} curves coincide, wholly or in part")),
            };
            let notes: Vec<String> = strong.into_iter().chain(coincide).collect();
            let (symbol, name) = match from_start {
                true => (coordinate.symbol_from_start, coordinate.from_start),
                false => (coordinate.symbol, coordinate.name),
            };
            // A single curve has no legend, and another portrait may be another block's.
            let whose = match &lines[..] {
                [line] if recorder.scenery.blocks.len() > 1 => format!(" of {}", line.label),
                _ => String::new(),
            };
            let portrait = Portrait {
                id: ["phase_x", "phase_y", "phase"][c],
                title: format!("Phase portrait{whose}: {} over {}", coordinate.velocity_symbol, symbol),
                x_label: format!("{name}{on}"),
                y_label: format!("{}{on}", coordinate.velocity_name),
                x_unit: units[0].to_owned(),
                y_unit: format!("{}/s", units[1]),
                least: if c == PHI { [4e-5 * factors[0], 2e-3] } else { factors.map(|factor| 1e-4 * reach * factor) },
                guides,
                note: (!notes.is_empty()).then(|| notes.join("; ")),
                lines,
            };
            self.portraits.push(portrait);
        }
    }
}

/// Which parts of the blocks' curves are strong, of those that have pale ones: of some it may be the beginning, of others not.
fn what_is_strong(parts: impl Iterator<Item = (Range<usize>, usize)>) -> Option<String> {
    let starts: Vec<usize> =
        parts.filter(|(strong, all)| strong.len() < *all).map(|(strong, _)| strong.start).collect();
    let which = match (starts.contains(&0), starts.iter().any(|start| *start > 0)) {
        (false, false) => return None,
        (true, false) => {
            return Some(format!("strong: the first {STRONG} changes of sign of the velocity; pale: all later ones"));
        }
        (false, true) => "about the largest swing",
        (true, true) => "about the largest swing of each block, or the first ones",
    };
    Some(format!("strong: the {STRONG} changes of sign of the velocity {which}; pale: all others"))
}

#[cfg(test)]
mod strong_parts {
    use super::what_is_strong;

    #[test]
    fn the_note_on_strong_parts_holds_for_all_blocks() {
        let note = |parts: &[(std::ops::Range<usize>, usize)]| what_is_strong(parts.iter().cloned());
        assert_eq!(note(&[(0..9, 9)]), None);
        let both = note(&[(0..9, 90), (40..50, 90)]).unwrap();
        assert!(both.contains("about the largest swing of each block, or the first ones"), "{both}");
        assert!(note(&[(0..9, 90), (0..9, 9)]).unwrap().contains("all later ones"));
        assert!(!note(&[(40..50, 90)]).unwrap().contains("first"));
    }
}

/// A portrait in which the velocity turns more often than this is a solid area: then as many turns as [`STRONG`] are drawn strong, the rest pale.
const MANY_TURNS: usize = 120;
const STRONG: usize = 20;

/// Which points of an orbit are drawn strong: of many turns those that cover most of its extent. Of a motion that decays these are the first; of one that
/// is shaken those about its largest swing, as the first ones would be hidden behind it; of one that overturns those that end in the fall.
fn strong(points: &[Point]) -> Range<usize> {
    let turns = points.windows(2).enumerate().filter(|(_, two)| two[0][2] * two[1][2] < 0.0).map(|(k, _)| k + 1);
    let turns: Vec<usize> = turns.collect();
    if turns.len() <= MANY_TURNS {
        return 0..points.len();
    }
    let window = |k: usize| {
        let begin = if k == 0 { 0 } else { turns[k] };
        begin..turns.get(k + STRONG).copied().unwrap_or(points.len())
    };
    let covers = |points: &[Point]| {
        [1, 2].map(|of| {
            let values = points.iter().map(|point| point[of]);
            let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
            high - low
        })
    };
    let all = covers(points).map(|range| if range > 0.0 { range } else { 1.0 });
    let part = |k: usize| covers(&points[window(k)]).into_iter().zip(all).map(|(own, all)| own / all).sum::<f64>();
    let parts: Vec<f64> = (0..=turns.len() - STRONG).map(part).collect();
    let most = parts.iter().copied().fold(0.0, f64::max);
    // The middle of those that are as good, unless the first is.
    let good = |k: &usize| parts[*k] >= AS_GOOD * most;
    let first = (0..parts.len()).find(good).unwrap_or(0);
    let count = (first..parts.len()).take_while(good).count();
    window(if first == 0 { 0 } else { first + count / 2 })
}

/// Parts of an orbit that cover this part of what another covers are as good.
const AS_GOOD: f64 = 0.99;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_hundreds_of_bounces_the_first_are_strong_and_of_a_few_all() {
        let bounces = |count: usize| -> Vec<Point> {
            (0..4 * count).map(|k| [k as f64, 1.0, [1.0, 0.3, -0.3, -1.0][k % 4]]).collect()
        };
        // Each bounce turns twice: at its top, and at the ground.
        assert_eq!(strong(&bounces(291)), 0..42);
        assert_eq!(strong(&bounces(12)), 0..48);
        assert_eq!(strong(&[]), 0..0);
    }

    #[test]
    fn of_what_trembles_and_then_falls_the_fall_is_strong() {
        let points: Vec<Point> = (0..700)
            .map(|k| match k {
                0..600 => [f64::from(k), 1e-3, [0.1, 0.03, -0.03, -0.1][k as usize % 4]],
                k => [f64::from(k), -0.01 * f64::from(k - 600).powi(2), -0.02 * f64::from(k - 600)],
            })
            .collect();
        let strong = strong(&points);
        assert!(strong.contains(&600) && strong.end == 700 && strong.len() < 200, "{strong:?}");
    }

    #[test]
    fn of_many_swings_those_about_the_largest_are_strong() {
        let swing = |k: usize| (1.0 - (k as f64 / 500.0 - 0.6).abs()) * (0.5 * std::f64::consts::PI * k as f64).cos();
        let points: Vec<Point> = (0..1000).map(|k| [k as f64, swing(k), swing(k + 1)]).collect();
        let strong = strong(&points);
        assert!(strong.contains(&300) && strong.len() < 100, "{strong:?}");
        let turns = points[strong].windows(2).filter(|two| two[0][2] * two[1][2] < 0.0).count();
        assert!(turns <= STRONG, "{turns}");
    }
}
