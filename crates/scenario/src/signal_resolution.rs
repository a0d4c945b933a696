//! Checks for motion too fast for the step: signals that the step doesn't resolve, blocks that turn
//! far in a step.

use crate::diagnostic::Diagnostic;
use crate::document::Document;
use crate::on_ground::is_on_ground;
use crate::record_checks;
use crate::scene::{AxisScene, ContactScene, History, MotionScene, Scene, SignalScene, SupportingBody};
use crate::wording::seconds;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use teeter_integrator::{Given, Signal, Table};
use teeter_text::readable::{shortest, with_digits};

/// Least number of steps per period of a signal.
const STEPS_A_SWING: f64 = 10.0;

/// A row may exceed the values at both ends of its step by this fraction of the table's largest
/// value, as the peak of a sine of [`STEPS_A_SWING`] steps does. (A jump stays between these
/// values, and counts like any other row.)
const BEYOND_THE_ENDS: f64 = 0.05;

/// Least number of steps for a change of displacement, as otherwise no step resolves its velocity,
/// a pulse as long as half a period.
const STEPS_A_RISE: f64 = 0.5 * STEPS_A_SWING;

/// A change of displacement within this fraction of a step is not meant to be resolved.
const A_JUMP: f64 = 0.01;

/// An initial velocity of supports of at least this fraction of their largest one gives a warning.
const STARTS_FAST: f64 = 0.01;

/// Largest rotation of a block in a step that can be followed, rad.
pub const FAR_TURN: f64 = 0.1;

/// A table this many times longer than the run probably has another unit of time.
const FAR_TOO_LONG: f64 = 1000.0;

/// Largest number of signals listed in a message; the rest is counted.
const LISTED: usize = 20;

/// Warnings.
pub(crate) fn warnings(scene: &Scene, document: &Document) -> Vec<Diagnostic> {
    let used = used(scene, document);
    let mut warnings = Vec::new();
    let end = end(scene);
    let mut unused = Vec::new();
    for signal in &scene.signals {
        let Some(used) = used.get(signal.name.as_str()) else {
            unused.push(signal.name.as_str());
            continue;
        };
        // Its terms are checked by themselves.
        if matches!(signal.history, History::Sum(_)) {
            continue;
        }
        let path = format!("signal.{}", signal.name);
        if is_silent(&signal.history, end) {
            let rule = format!("it is 0 during the whole run, which ends at {end} s, and has no effect");
            warnings.push(document.error(&path, rule, "check its times and their unit").as_warning());
            continue;
        }
        warnings.extend(match &signal.history {
            History::Product(_) => of_product(&path, signal.history.swings(), used.in_the_mean(), scene, document),
            History::Formula(_) | History::Chirp(_) => {
                swing(&path, signal.history.swings(), used.in_the_mean(), scene, document)
            }
            // Records are not signals.
            History::Table(_) | History::Record(_) | History::Sum(_) => signal
                .history
                .table()
                .and_then(|table| rows(&format!("{path}.file"), table, used.in_the_mean(), scene, document)),
        });
    }
    warnings.extend(nothing_uses(&unused, document));
    for record in scene.records().take(LISTED) {
        warnings.extend(record_checks::warning(record, end, document));
        if record.record.dt() >= scene.time.step {
            continue;
        }
        let in_the_mean = Used { motion: true, load: false }.in_the_mean();
        warnings.extend(rows(&format!("{}.record", record.path), record.table(), in_the_mean, scene, document));
    }
    warnings.extend(turns(scene, document));
    warnings.extend(rises(scene, document));
    warnings.extend(fast_starts(scene, document));
    warnings
}

/// Notes.
pub(crate) fn notes(scene: &Scene, document: &Document) -> Vec<Diagnostic> {
    let (used, end) = (used(scene, document), end(scene));
    let is_heard = |signal: &&SignalScene| used.contains_key(signal.name.as_str()) && !is_silent(&signal.history, end);
    scene.signals.iter().filter(is_heard).filter_map(|signal| too_long(signal, end, document)).collect()
}

/// The end of the run, s.
fn end(scene: &Scene) -> f64 {
    scene.time.steps() as f64 * scene.time.step
}

/// What a signal multiplies.
#[derive(Clone, Copy, Default)]
struct Used {
    load: bool,
    motion: bool,
}

impl Used {
    /// The effect of a step that doesn't resolve the signal.
    fn in_the_mean(self) -> &'static str {
        match self {
            Self { motion: true, load: true } => {
                "a step takes the mean of a load and of a velocity: no impulse is lost, but the variation within a step is ignored"
            }
            Self { motion: true, .. } => {
                "a step takes the mean of the velocity: the position stays right, but the variation within a step is ignored"
            }
            _ => "a step takes its mean: no impulse is lost, but the variation within a step is ignored",
        }
    }
}

/// The names of the signals that are used.
fn used<'a>(scene: &Scene, document: &'a Document) -> BTreeMap<&'a str, Used> {
    let mut used = BTreeMap::<&str, Used>::new();
    if scene.signals.is_empty() {
        return used;
    }
    for (path, _) in document.entries() {
        let (owner, key) = path.rsplit_once('.').unwrap_or(("", path));
        let mut by = |name| {
            let used = used.entry(name).or_default();
            match owner.ends_with(".motion") {
                true => used.motion = true,
                false => used.load = true,
            }
        };
        match key {
            "signal" => document.text(path).into_iter().for_each(&mut by),
            "signals" => document.text_pair(path).into_iter().flatten().for_each(&mut by),
            _ => {}
        }
    }
    // What multiplies a sum or product multiplies its parts, which may be such themselves.
    let is_made = |history: &History| matches!(history, History::Sum(_) | History::Product(_));
    let made = scene.signals.iter().filter(|signal| is_made(&signal.history));
    let mut left: Vec<&str> = made.map(|signal| signal.name.as_str()).collect();
    while let Some(name) = left.pop() {
        let of_whole = used.get(name).copied();
        let parts = ["terms", "factors"].map(|key| document.words(&format!("signal.{name}.{key}")));
        for part in parts.into_iter().flatten().flatten() {
            let before = used.get(part.as_str()).copied();
            let of_part = used.entry(part).or_default();
            if let Some(of_whole) = of_whole {
                of_part.motion |= of_whole.motion;
                of_part.load |= of_whole.load;
            }
            if before.map(|used| (used.motion, used.load)) != Some((of_part.motion, of_part.load)) {
                left.push(part);
            }
        }
    }
    used
}

fn nothing_uses(names: &[&str], document: &Document) -> Vec<Diagnostic> {
    let listed = names.iter().take(LISTED).enumerate().map(|(k, name)| {
        let mut rule = "this signal is not used".to_owned();
        if k + 1 == LISTED && names.len() > LISTED {
            let _ = write!(rule, ", nor {} more", names.len() - LISTED);
        }
        let remedy = format!("add signal = \"{name}\" to the table that should use it, or leave the signal out");
        document.error(&format!("signal.{name}"), rule, remedy).as_warning()
    });
    listed.collect()
}

/// Whether a history is 0 during the whole run.
fn is_silent(history: &History, end: f64) -> bool {
    match history {
        History::Formula(formula) => formula.is_silent_until(end),
        History::Chirp(chirp) => {
            let (_, [from, until]) = chirp.swings();
            from >= end || until <= 0.0
        }
        History::Sum(terms) => terms.iter().all(|(_, term)| is_silent(term, end)),
        History::Product(product) => product.factors().iter().any(|factor| is_silent(factor, end)),
        History::Table(_) | History::Record(_) => history.table().is_none_or(|table| {
            table.value(0.0) == 0.0
                && table.value(end) == 0.0
                && table.rows().all(|(t, y)| y == 0.0 || t <= 0.0 || t >= end)
        }),
    }
}

/// Warns of a formula with less than ten steps per period.
fn swing(
    path: &str,
    swings: Option<(f64, [f64; 2])>,
    in_the_mean: &str,
    scene: &Scene,
    document: &Document,
) -> Option<Diagnostic> {
    let step = scene.time.step;
    let (period, [from, until]) = swings?;
    if period >= STEPS_A_SWING * step * (1.0 - 1e-9) {
        return None;
    }
    let at = |key: &str| format!("{path}.{key}");
    let (key, rule) = if let [Some(first), Some(last)] = ["from", "to"].map(|key| document.quantity(&at(key))) {
        let key = if last > first { at("to") } else { at("from") };
        (
            key,
            format!(
                "its shortest period of {} is {:.2} steps of {}: {in_the_mean}",
                seconds(period, 4),
                period / step,
                seconds(step, 4)
            ),
        )
    } else if document.has(&at("duration")) {
        let lasts = until - from;
        (
            at("duration"),
            format!("it lasts {}, {:.2} steps of {}: {in_the_mean}", seconds(lasts, 4), lasts / step, seconds(step, 4)),
        )
    } else {
        let key = if document.has(&at("period")) { at("period") } else { at("frequency") };
        (
            key,
            format!(
                "its period of {} is {:.2} steps of {}: {in_the_mean}",
                seconds(period, 4),
                period / step,
                seconds(step, 4)
            ),
        )
    };
    let remedy = format!("use a step of at most {}", seconds(period / STEPS_A_SWING, 2));
    Some(document.error(&key, rule, remedy).as_warning())
}

/// Warns of a product with less than ten steps per period: the frequencies of its factors add.
fn of_product(
    path: &str,
    swings: Option<(f64, [f64; 2])>,
    in_the_mean: &str,
    scene: &Scene,
    document: &Document,
) -> Option<Diagnostic> {
    let step = scene.time.step;
    let (period, _) = swings.filter(|(period, _)| *period < STEPS_A_SWING * step * (1.0 - 1e-9))?;
    let rule = format!(
        "the frequencies of its factors add: its shortest period of {} is {:.2} steps of {}: {in_the_mean}",
        seconds(period, 4),
        period / step,
        seconds(step, 4)
    );
    let remedy = format!("use a step of at most {}", seconds(period / STEPS_A_SWING, 2));
    Some(document.error(&format!("{path}.factors"), rule, remedy).as_warning())
}

/// Warns of a table with peaks between the ends of steps.
fn rows(key: &str, table: &Table, in_the_mean: &str, scene: &Scene, document: &Document) -> Option<Diagnostic> {
    let step = scene.time.step;
    let last = scene.time.steps() as f64;
    let largest = table.rows().map(|(_, y)| y.abs()).fold(0.0, f64::max);
    let (mut worst, mut closest, mut before) = (0.0_f64, f64::INFINITY, None::<f64>);
    for (t, y) in table.rows() {
        let k = (t / step).floor();
        if (0.0..last).contains(&k) {
            let [a, b] = [k, k + 1.0].map(|k| k * step);
            let [a, b] = [a, b].map(|t| table.value(t));
            worst = worst.max((y - a.max(b)).max(a.min(b) - y) / largest);
            closest = closest.min(before.map_or(f64::INFINITY, |before| t - before));
        }
        before = Some(t);
    }
    if worst <= BEYOND_THE_ENDS || closest >= step * (1.0 - 1e-9) {
        return None;
    }
    let rule = format!(
        "its rows are as close as {}, closer than the step of {}, with peaks between the ends of steps of up to \
         {:.0} % of its largest value: {in_the_mean}",
        seconds(closest, 4),
        seconds(step, 4),
        100.0 * worst
    );
    let remedy = format!("use a shorter step: {} resolves every row", seconds(closest, 2));
    Some(document.error(key, rule, remedy).as_warning())
}

/// Warns of a table whose times probably have another unit.
fn too_long(signal: &SignalScene, end: f64, document: &Document) -> Option<Diagnostic> {
    let History::Table(table) = &signal.history else { return None };
    let [_, (last, _)] = table.ends();
    if last <= FAR_TOO_LONG * end {
        return None;
    }
    let rule = format!("the table extends to {last} s, {} times the run of {end} s", shortest(last / end, 2));
    let remedy = "check the unit of its times: s, or the unit in the heading, such as t [ms]";
    Some(document.error(&format!("signal.{}.file", signal.name), rule, remedy).as_note())
}

/// Warns of blocks and ground that turn far in a step.
fn turns(scene: &Scene, document: &Document) -> Vec<Diagnostic> {
    let step = scene.time.step;
    let far = |path: String, rate: f64| {
        let turn = rate.abs() * step;
        (turn >= FAR_TURN).then(|| {
            let rule = format!(
                "it turns by {turn:.2} rad in a step of {}, more than {FAR_TURN} rad, which a step can't follow",
                seconds(step, 4)
            );
            let remedy = format!("use a step of at most {}", seconds(FAR_TURN / rate.abs(), 2));
            document.error(&path, rule, remedy).as_warning()
        })
    };
    let spins = scene.blocks.iter().map(|block| far(format!("block.{}.spin", block.name), block.spin));
    let driven = |(path, motion): (String, &MotionScene)| {
        let axis = motion.0[2].as_ref()?;
        let sum = |of: &dyn Fn(&History) -> f64| -> f64 {
            axis.history.terms().map(|(factor, term)| factor.abs() * of(term)).sum()
        };
        let (key, rate) = match axis.given {
            Given::Velocity => ("angular_velocity", sum(&most)),
            Given::Displacement => ("angle", sum(&fastest)),
            Given::Acceleration => return None,
        };
        far(format!("{path}.{key}"), axis.amplitude * rate)
    };
    spins.chain(scene.motions().map(driven)).flatten().take(LISTED).collect()
}

/// A bound of the absolute values of a history.
fn most(history: &History) -> f64 {
    let bound = |history: &History| -> f64 { history.terms().map(|(factor, term)| factor.abs() * most(term)).sum() };
    match history {
        History::Table(table) => table.rows().map(|(_, y)| y.abs()).fold(0.0, f64::max),
        // Records prescribe no rotation.
        History::Record(_) => 0.0,
        History::Product(product) => product.factors().iter().map(bound).fold(product.scale().abs(), |a, b| a * b),
        History::Formula(_) | History::Chirp(_) => 1.0,
        History::Sum(_) => bound(history),
    }
}

/// A bound of the rates of a history by its oscillations, 1/s: of a product, that of each factor times the values of the others.
fn fastest(history: &History) -> f64 {
    let sum = |history: &History, of: fn(&History) -> f64| -> f64 {
        history.terms().map(|(factor, term)| factor.abs() * of(term)).sum()
    };
    match history {
        History::Product(product) => {
            let factors = || product.factors().iter().enumerate();
            let of = |(k, factor): (usize, &History)| {
                let others = factors().filter(|(other, _)| *other != k).map(|(_, other)| sum(other, most));
                sum(factor, fastest) * others.product::<f64>()
            };
            product.scale().abs() * factors().map(of).sum::<f64>()
        }
        History::Sum(_) => sum(history, fastest),
        _ => history.swings().map_or(0.0, |(period, _)| std::f64::consts::TAU / period),
    }
}

/// Warns of displacements that change faster than steps can resolve, as contacts depend on their
/// velocity.
fn rises(scene: &Scene, document: &Document) -> Vec<Diagnostic> {
    let step = scene.time.step;
    let of = |(path, motion): (String, &MotionScene)| {
        let axes = ["displacement", "displacement", "angle"].into_iter().zip(&motion.0);
        let worst = axes.filter_map(|(key, axis)| {
            let axis = axis.as_ref().filter(|axis| axis.given == Given::Displacement)?;
            let lasts = axis.history.terms().filter_map(|(_, term)| match term {
                History::Formula(formula) => {
                    formula.rises_in().filter(|lasts| *lasts < STEPS_A_RISE * step * (1.0 - 1e-9))
                }
                History::Table(table) => fastest_rise(table, scene),
                // Records are accelerations; chirps have their own warning.
                History::Record(_) | History::Chirp(_) | History::Sum(_) | History::Product(_) => None,
            });
            Some((key, lasts.min_by(f64::total_cmp)?))
        });
        let (key, lasts) = worst.min_by(|(_, a), (_, b)| a.total_cmp(b))?;
        let rule = format!(
            "it changes within {}, {:.2} steps of {}: the position stays right, but not the velocity with which it \
             pushes what touches it",
            seconds(lasts, 4),
            lasts / step,
            seconds(step, 4)
        );
        let remedy = if lasts < A_JUMP * step {
            "this is a jump: give the change its real duration, of at least some steps".to_owned()
        } else {
            format!("use a step of at most {}", seconds(lasts / STEPS_A_RISE, 2))
        };
        Some(document.error(&format!("{path}.{key}"), rule, remedy).as_warning())
    };
    scene.motions().filter_map(of).take(LISTED).collect()
}

/// The time between two rows, shorter than a step, whose slope differs most from the mean slopes of
/// the surrounding steps, if it differs much.
fn fastest_rise(table: &Table, scene: &Scene) -> Option<f64> {
    let (step, last) = (scene.time.step, scene.time.steps() as f64);
    let rows = || table.rows().zip(table.rows().skip(1));
    let slope = |((a, from), (b, to)): ((f64, f64), (f64, f64))| (to - from) / (b - a);
    let largest = rows().map(|rows| slope(rows).abs()).fold(0.0, f64::max);
    let mean = |k: f64| (table.value((k + 1.0) * step) - table.value(k * step)) / step;
    let (mut worst, mut lasts) = (BEYOND_THE_ENDS * largest, None);
    for rows in rows() {
        let ((a, _), (b, _)) = rows;
        let k = (0.5 * (a + b) / step).floor();
        if b - a < step * (1.0 - 1e-9) && (0.0..last).contains(&k) {
            let means = [k - 1.0, k, k + 1.0].map(mean);
            let (least, most) =
                means.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), m| (a.min(*m), b.max(*m)));
            let beyond = (slope(rows) - most).max(least - slope(rows));
            if beyond > worst {
                (worst, lasts) = (beyond, Some(b - a));
            }
        }
    }
    lasts
}

/// The initial velocity of a nonuniform motion, if it is a considerable part of its largest
/// velocity.
fn fast_start(axis: &AxisScene, end: f64) -> Option<f64> {
    /// Number of times in the run at which velocities are evaluated.
    const LOOKS: u32 = 1000;
    if is_uniform(axis) {
        return None;
    }
    let motion = axis.motion();
    let velocity = |k: u32| motion.velocity(end * f64::from(k) / f64::from(LOOKS));
    let start = velocity(0);
    if start == 0.0 {
        return None;
    }
    let fastest = (0..=LOOKS).map(|k| velocity(k).abs()).fold(0.0, f64::max);
    Some(start).filter(|start| start.abs() > STARTS_FAST * fastest)
}

/// Warns of beams whose supports don't start from rest, and of blocks at rest on ground that
/// doesn't.
fn fast_starts(scene: &Scene, document: &Document) -> Vec<Diagnostic> {
    let end = end(scene);
    let beams = scene.beams.iter().filter_map(|beam| {
        let start = fast_start(beam.motion.0[1].as_ref()?, end)?;
        let rule = format!(
            "the supports start with {}, and the beam with them: it is at rest relative to its supports, not in the world",
            with_digits(start, "m/s", 3)
        );
        let remedy = "if the beam should start from rest, let the motion start with a velocity of 0, as shape = \"ricker\" or a \
             harmonic displacement of phase = \"90 deg\" does";
        Some(document.error(&format!("beam.{}.motion", beam.name), rule, remedy).as_warning())
    });
    let at_rest = |contact: &ContactScene| {
        let block = &scene.blocks[contact.block];
        (contact.surface == SupportingBody::Ground && block.velocity == [0.0; 2] && is_on_ground(scene, block))
            .then_some(block)
    };
    let left_behind = scene.contacts.iter().find_map(at_rest);
    let ground = scene.ground.as_ref().zip(left_behind).and_then(|(ground, block)| {
        let starts = ground.motion.0.iter().take(2).flatten().filter_map(|axis| fast_start(axis, end));
        let start = starts.max_by(|a, b| a.abs().total_cmp(&b.abs()))?;
        let rule = format!(
            "the ground starts with {}, but `{}` on it starts at rest: the motion starts with a jolt",
            with_digits(start, "m/s", 3),
            block.name
        );
        let remedy = "let the motion start with a velocity of 0, as shape = \"ricker\" or a harmonic displacement of phase = \"90 deg\" does, or \
             give the block the velocity of the ground";
        Some(document.error("ground.motion", rule, remedy).as_warning())
    });
    beams.chain(ground).take(LISTED).collect()
}

/// Whether its velocity is constant.
fn is_uniform(axis: &AxisScene) -> bool {
    let is_constant = |history: &History| matches!(history, History::Formula(formula) if formula.swings().is_none() && formula.rises_in().is_none());
    axis.given == Given::Velocity && axis.history.terms().all(|(_, term)| is_constant(term))
}
