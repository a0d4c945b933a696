//! The scene at its end as drawings to scale: the network of contact forces, and lines of thrust.

use super::chain::{FEWEST, LastPicture, Thrust, ThrustLine, thrust_lines};
use super::content;
use super::network::passes_on;
use super::placed;
use super::recorder::PageRecorder;
use super::redundant;
use crate::with_digits;
use teeter_plot::{Axis, Colour, Drawing, Figure, Panel, Series};
use teeter_scenario::scene::SupportingBody;

/// Widths of the lines of a network, in parts of the widest; forces below half of the first are left out.
const CLASSES: usize = 12;

/// Width of the line of the largest force, mm: as the bodies are large, up to this.
const WIDEST: f64 = 2.4;

/// Width of a drawing within its margins, mm.
const DRAWING: f64 = 113.0;

/// What is this part of the size of what a drawing is about away from it isn't drawn: a ball that rolled off would make all else small.
const FAR_OFF: f64 = 0.25;

/// Which blocks a drawing shows that is about some of them: these, and those near them.
fn near(recorder: &PageRecorder, last: &LastPicture<'_>, is_about: impl Fn(usize) -> bool) -> Vec<bool> {
    let outlines = placed::blocks(recorder, last.row);
    let about: Vec<(f64, f64)> =
        (0..outlines.len()).filter(|k| is_about(*k)).flat_map(|k| outlines[k].concat()).collect();
    let ends = |of: &dyn Fn(&(f64, f64)) -> f64| {
        about.iter().map(of).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    };
    let (across, up) = (ends(&|at| at.0), ends(&|at| at.1));
    let room = FAR_OFF * (across.1 - across.0).max(up.1 - up.0);
    let within = |x: f64, (low, high): (f64, f64)| (low - room..=high + room).contains(&x);
    let is_near = |points: &placed::Points| points.iter().all(|(x, y)| within(*x, across) && within(*y, up));
    outlines.iter().map(|lines| about.is_empty() || lines.iter().all(is_near)).collect()
}

/// The shown blocks of the scene where it is in the last picture, with what is said of the others.
fn scene(recorder: &PageRecorder, last: &LastPicture<'_>, title: &str, shown: &[bool]) -> (Drawing, Option<String>) {
    let mut drawing = Drawing::new(title);
    let blocks = placed::blocks(recorder, last.row).into_iter().zip(shown);
    let outlines: Vec<_> = blocks.filter(|(_, shown)| **shown).flat_map(|(lines, _)| lines).collect();
    let away: Vec<&str> = recorder
        .scenery
        .blocks
        .iter()
        .zip(shown)
        .filter(|(_, shown)| !**shown)
        .map(|(block, _)| &*block.name)
        .collect();
    let told = match away[..] {
        [] => None,
        [one] => Some(format!("{one} is farther off")),
        _ => Some(format!("{} blocks are farther off", away.len())),
    };
    // As far as the blocks are.
    let ends =
        outlines.iter().flatten().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), at| (a.min(at.0), b.max(at.0)));
    let room = 0.03 * (ends.1 - ends.0);
    if let Some(surface) = placed::ground(recorder, last.row, ends.0 - room, ends.1 + room) {
        drawing = drawing.ground(surface);
    }
    drawing = drawing.outlines(placed::beams(recorder, last.row), Colour::Grid).outlines(outlines, Colour::Shade);
    (drawing, told)
}

/// When, and over how long the forces are means.
fn time_note([from, to]: [f64; 2]) -> String {
    format!("At t = {}; forces are means over the {} before", with_digits(to, "s", 6), with_digits(to - from, "s", 3))
}

/// The network of contact forces at the end: between two blocks a line from one centre to the other through the centre of
/// pressure, between a block and anything else, as a block whose motion is prescribed, from its centre to that; through a block that
/// [passes a force on](passes_on) straight.
pub(super) fn force_chains(recorder: &PageRecorder) -> Option<Drawing> {
    let scenery = &recorder.scenery;
    let is_free = |block: usize| !scenery.blocks[block].driven;
    let mut last = LastPicture::of(recorder).filter(|_| scenery.has_network())?;
    let linked = last.linked(is_free);
    linked.iter().find(|count| **count >= FEWEST)?;
    let near = near(recorder, &last, |block| linked[block] >= FEWEST);
    last.thrusts.retain(|thrust| near[thrust.block]);
    let largest = last.thrusts.iter().map(Thrust::size).fold(0.0, f64::max);
    let (mut drawing, away) = scene(recorder, &last, "Contact forces as a network at the end of the run", &near);
    let mut reaches: Vec<f64> = scenery.blocks.iter().map(|block| block.reach).collect();
    reaches.sort_by(f64::total_cmp);
    let poses = || last.poses.iter().zip(&near).filter(|(_, shown)| **shown).map(|(pose, _)| pose);
    let ends = |k: usize| poses().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p[k]), b.max(p[k])));
    let size = (ends(0).1 - ends(0).0).max(0.8 * (ends(1).1 - ends(1).0)) + 2.0 * reaches[reaches.len() - 1];
    let widest = WIDEST.min(0.9 * reaches[reaches.len() / 2] / size * DRAWING);
    // Where the line of a force changes its width: in a block by which it goes straight halfway between the joints, else at the centre.
    let other_of = |thrust: &Thrust| if let SupportingBody::Block(other) = thrust.other { Some(other) } else { None };
    let least = 0.5 / CLASSES as f64 * largest;
    let shown = || last.thrusts.iter().filter(|thrust| thrust.size() >= least);
    let links: Vec<_> = shown().map(|thrust| (thrust.block, other_of(thrust), thrust.force)).collect();
    let passes_on = passes_on(scenery.blocks.len(), &links);
    let node = |block: usize| {
        let own = shown().filter(|thrust| thrust.block == block || other_of(thrust) == Some(block));
        match own.map(|thrust| thrust.at).collect::<Vec<_>>()[..] {
            [a, b] if passes_on[block] => (0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])),
            _ => (last.poses[block][0], last.poses[block][1]),
        }
    };
    let mut classes: Vec<Vec<Vec<(f64, f64)>>> = vec![Vec::new(); CLASSES + 1];
    for thrust in &last.thrusts {
        let class = (thrust.size() / largest * CLASSES as f64).round() as usize;
        let node = |block: usize| is_free(block).then(|| node(block));
        let at = Some((thrust.at[0], thrust.at[1]));
        let line = [node(thrust.block), at, other_of(thrust).and_then(node)].into_iter().flatten().collect();
        classes[class.min(CLASSES)].push(line);
    }
    for (class, lines) in classes.into_iter().enumerate().skip(1).filter(|(_, lines)| !lines.is_empty()) {
        drawing = drawing.lines(lines, widest * class as f64 / CLASSES as f64, Colour::Series(1));
    }
    let least = with_digits(least, "N", 2);
    drawing = drawing
        .key(Colour::Series(1), widest, format!("{}, the largest force", with_digits(largest, "N", 3)))
        .note(format!("{}; those below {least} are left out", time_note(last.interval)));
    Some(away.into_iter().fold(drawing, Drawing::note))
}

/// The lines of thrust at the end; `many`: whether the contact forces are one of many sets then.
pub(super) fn thrust(recorder: &PageRecorder, lines: &[ThrustLine], many: bool) -> Option<Drawing> {
    let last = LastPicture::of(recorder).filter(|_| !lines.is_empty())?;
    let is_in_line = |block: usize| lines.iter().any(|line| line.blocks.contains(&recorder.scenery.blocks[block].name));
    let near = near(recorder, &last, is_in_line);
    let (mut drawing, away) = scene(recorder, &last, "Line of thrust at the end of the run", &near);
    for line in lines {
        let points: Vec<(f64, f64)> = line.joints.iter().map(|joint| (joint.at[0], joint.at[1])).collect();
        drawing = drawing.lines([points.clone()], 0.45, Colour::Series(1));
        // Of many joints the dots would hide the line.
        if points.len() <= 40 {
            drawing = points.into_iter().fold(drawing, |drawing, at| drawing.dot(at, Colour::Series(1)));
        }
    }
    let part = |joint: &super::Joint| Some((joint.eccentricity? / joint.depth?, joint.between.clone()));
    let most =
        lines.iter().flat_map(|line| &line.joints).filter_map(part).max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
    drawing = drawing.key(Colour::Series(1), 0.45, "line of thrust, through the centre of pressure of each joint");
    if let Some((most, [one, other])) = most {
        drawing = drawing.note(format!(
            "Largest eccentricity {} of the joint's depth, between {one} and {other}",
            three_digits(most)
        ));
    }
    if many {
        drawing = drawing.note(format!("The line is that of {}", redundant::NOTE));
    }
    Some(away.into_iter().fold(drawing.note(time_note(last.interval)), Drawing::note))
}

/// An eccentricity, m, of a joint of this depth, m: none where it is nothing but rounding.
pub(super) fn above_rounding(eccentricity: f64, depth: f64) -> f64 {
    if content::holds(eccentricity.abs(), depth) { eccentricity } else { 0.0 }
}

/// A part with three decimals, of which none is a zero below zero.
fn three_digits(part: f64) -> String {
    let part = if part.abs() < 5e-4 { 0.0 } else { part };
    format!("{part:.3}").replace('-', "\u{2212}")
}

/// The eccentricities of the joints, in parts of their depth.
pub(super) fn eccentricities(lines: &[ThrustLine]) -> Option<Figure> {
    let most = lines.iter().map(|line| line.joints.len()).max()?;
    let several = lines.len() > 1;
    let series = lines.iter().enumerate().map(|(k, line)| {
        let label = if several {
            format!("{} to {}", line.blocks[0], line.blocks[line.blocks.len() - 1])
        } else {
            "line of thrust".to_owned()
        };
        let points = line.joints.iter().enumerate();
        let value = |joint: &super::Joint| {
            joint.eccentricity.zip(joint.depth).map_or(f64::NAN, |(e, depth)| above_rounding(e, depth) / depth)
        };
        Series::line(label, points.map(|(number, joint)| ((number + 1) as f64, value(joint)))).number(k)
    });
    let series: Vec<Series> = series.collect();
    let limits = [("edge of the joint", 0.5, 6), ("middle third", 1.0 / 6.0, 4)];
    let limits = limits.into_iter().flat_map(|(label, at, number)| {
        let line = move |label: &str, y: f64| Series::line(label, [(1.0, y), (most as f64, y)]).number(number);
        [line(label, at), line("", -at)]
    });
    let x = Axis::between("Joint, from the first support on", 1.0, (most as f64).max(2.0));
    let y = Axis::between("Eccentricity e / depth of the joint", -0.55, 0.55);
    let panel = Panel::new(y).with(limits.collect::<Vec<_>>()).with(series);
    Some(Figure::new("eccentricity", "Eccentricity of the line of thrust in each joint", x).panel(panel))
}

/// The lines of thrust, for figures and page.
pub(super) fn lines_of(recorder: &PageRecorder) -> Vec<ThrustLine> {
    if recorder.scenery.has_network() { thrust_lines(recorder) } else { Vec::new() }
}
