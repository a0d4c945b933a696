//! The reference of a trade-off: a run far finer than any candidate, its error bar from independent runs, and the horizon.

use crate::axes::{Axes, in_seconds, refined, unreduced};
use crate::errors::{Errors, Quantity, Ruler};
use crate::runner;
use crate::simulate::{Ran, expect, simulate};
use crate::{Failure, Motion, Sampling, Setting, Source};
use std::sync::atomic::AtomicBool;
use teeter_scenario::resolve::Resolved;

/// A verified reference.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// Its setting.
    pub setting: Setting,
    /// What it showed.
    pub motion: Motion,
    /// The runs that it is verified by.
    pub checks: Vec<Check>,
    /// How well it is known: quantity by quantity, the largest difference from a check before the horizon.
    pub bar: Errors,
    /// What errors are relative to, up to the horizon.
    pub ruler: Ruler,
    /// Whether the horizon is the end of the run.
    pub whole: bool,
}

/// A run that the reference is compared with.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    /// What is different in it.
    pub what: &'static str,
    /// Its setting.
    pub setting: Setting,
    /// Its differences from the reference before the horizon.
    pub errors: Errors,
    /// Until when the two agree within [`SHARE`] of the motion, s.
    pub agrees_until: f64,
    /// Whether its differences count for the error bar.
    pub for_bar: bool,
}

/// The horizon is where the reference and the same with another step, or started 1e-12 beside it, have parted by this share of the
/// motion: of the largest angle and of the largest side of a block, or of the largest deflection.
pub const SHARE: f64 = 1e-3;
/// By how much of themselves the first body's coordinates are nudged.
pub const NUDGE: f64 = 1e-12;
/// The reference's step as a part of the scene's own, unless that is too much work.
const STEP: f64 = 0.0025;
/// Its elements and those of the check, as multiples of the scene's own. With an error that halves from mesh to mesh, the difference of
/// the two is as large as the error of the finer one.
const MESHES: [f64; 2] = [4.0, 2.0];
/// Modelled work of the reference, s.
const MOST_WORK: f64 = 1.2;
/// Tolerance of its contact solver.
const TOLERANCE: &str = "1e-13";

/// What the reference is made of, for every scheme.
struct Recipe<'a> {
    resolved: &'a Resolved,
    step: f64,
}

impl Recipe<'_> {
    fn setting(&self, scheme: &Setting, coarser: f64, mesh: f64) -> Setting {
        let scene = &self.resolved.scene;
        let mut setting = scheme.clone().with(&unreduced(self.resolved)).with(&refined(self.resolved, mesh));
        setting = setting.set("time.step", in_seconds(coarser * self.step));
        if scene.time.theta != 0.5 {
            setting = setting.set("time.theta", "0.5");
        }
        if scene.contacts.is_empty() { setting } else { setting.set("solver.tolerance", TOLERANCE) }
    }
}

/// Finds the reference of a scene.
///
/// # Errors
/// If no scheme comes to the end of the scene, or the user interrupts.
pub(crate) fn find(
    source: &Source,
    resolved: &Resolved,
    axes: &Axes,
    sampling: Sampling,
    threads: usize,
    cancel: &AtomicBool,
    done: &mut (dyn FnMut(usize, usize) + Send),
) -> Result<Reference, Failure> {
    let recipe = Recipe { resolved, step: affordable_step(source, resolved, axes)? };
    let schemes = &axes.scheme.options;
    // Two steps of each scheme: who of them agrees best with itself is the reference.
    let jobs: Vec<Setting> =
        schemes.iter().flat_map(|scheme| [1.0, 2.0].map(|h| recipe.setting(scheme, h, MESHES[0]))).collect();
    let total = jobs.len() + 2 + usize::from(refined(resolved, MESHES[0]) != refined(resolved, MESHES[1]));
    let mut count = 0;
    let mut tell = |_| {
        count += 1;
        done(count, total);
    };
    let ran =
        runner::in_order(&jobs, threads, cancel, |setting| simulate(source, setting, 0.0, sampling, cancel), &mut tell);
    let ran: Vec<Result<Ran, Failure>> = ran.into_iter().map(|ran| ran.unwrap_or(Err(Failure::Interrupted))).collect();
    if ran.contains(&Err(Failure::Interrupted)) {
        return Err(Failure::Interrupted);
    }
    let ruler = Ruler::new(&resolved.scene, sampling);
    let best = best_scheme(&ran, &ruler)?;
    let scheme = &schemes[best];
    let four_times = recipe.setting(scheme, 4.0, MESHES[0]);
    let mut extra = vec![(NUDGE, jobs[2 * best].clone()), (0.0, four_times.clone())];
    let other_mesh = recipe.setting(scheme, 1.0, MESHES[1]);
    if other_mesh != jobs[2 * best] {
        extra.push((0.0, other_mesh.clone()));
    }
    let beside = runner::in_order(
        &extra,
        threads,
        cancel,
        |(nudge, setting)| simulate(source, setting, *nudge, sampling, cancel),
        &mut tell,
    );
    let mut beside = beside.into_iter().map(|ran| ran.unwrap_or(Err(Failure::Interrupted)));
    let mut next = || beside.next().unwrap_or(Err(Failure::Interrupted));
    let (nudged, coarse) = (next()?, next()?);
    let mut ran: Vec<Option<Ran>> = ran.into_iter().map(Result::ok).collect();
    let Some(motion) = ran[2 * best].take().map(|ran| ran.motion) else {
        return Err(Failure::Ended("no scheme comes to the end of the scene".to_owned()));
    };

    let mut others = vec![
        ("started 1e-12 beside it", jobs[2 * best].clone(), Some(nudged), false),
        ("twice the step", jobs[2 * best + 1].clone(), ran[2 * best + 1].take(), true),
        // An impact falls somewhere into a step: of two steps one may hit its time by luck, of three hardly any.
        ("four times the step", four_times, Some(coarse), true),
    ];
    if let Some(ran) = beside.next() {
        others.push(("half the elements", other_mesh, Some(ran?), true));
    }
    for number in (0..schemes.len()).filter(|&number| number != best) {
        for (at, what) in [(2 * number, "another scheme"), (2 * number + 1, "another scheme and twice the step")] {
            others.push((what, jobs[at].clone(), ran[at].take(), true));
        }
    }
    // The horizon goes by the two of the first kind; the error bar by all the others.
    let parted = |ran: &Option<Ran>| ran.as_ref().map_or(0, |ran| ruler.agree(&ran.motion, &motion, SHARE));
    let samples = parted(&others[0].2).min(parted(&others[1].2)).max(1);
    let ruler = ruler.up_to(samples);
    let mut checks = Vec::new();
    let mut bar = Errors::default();
    for (what, setting, ran, for_bar) in others {
        let Some(ran) = ran else { continue };
        let errors = ruler.errors(&ran.motion, &motion);
        if for_bar {
            bar = bar.larger(&errors);
        }
        let agree = Ruler::new(&resolved.scene, sampling).agree(&ran.motion, &motion, SHARE);
        let agrees_until = sampling.time(agree.max(1) - 1);
        checks.push(Check { what, setting, errors, agrees_until, for_bar });
    }
    Ok(Reference { setting: jobs[2 * best].clone(), motion, checks, bar, whole: samples == sampling.count, ruler })
}

impl Reference {
    /// How well the reference is known in a quantity; 0 where the exact value is known, as that of the penetration.
    #[must_use]
    pub fn bar_of(&self, quantity: Quantity) -> f64 {
        if quantity == Quantity::Penetration { 0.0 } else { self.bar.of(quantity).unwrap_or(0.0) }
    }
}

/// The reference's step: as fine as the work allows, s.
fn affordable_step(source: &Source, resolved: &Resolved, axes: &Axes) -> Result<f64, Failure> {
    let own = resolved.scene.time.step;
    let mut step = STEP * own;
    let work = |step: f64| {
        let recipe = Recipe { resolved, step };
        let works = axes.scheme.options.iter().map(|scheme| expect(source, &recipe.setting(scheme, 1.0, MESHES[0])));
        works.reduce(Result::or).unwrap_or(Err(Failure::Ended("there is no scheme".to_owned())))
    };
    // Halves and doubles of decimal steps have few digits.
    while step < own && work(step)?.seconds() > MOST_WORK {
        step *= 2.0;
    }
    Ok(step)
}

/// The scheme whose two runs agree the longest, and where several do to the end, the best.
fn best_scheme(ran: &[Result<Ran, Failure>], ruler: &Ruler) -> Result<usize, Failure> {
    let mut best: Option<(usize, usize, f64)> = None;
    for (number, pair) in ran.chunks(2).enumerate() {
        let [Ok(fine), Ok(coarse)] = pair else { continue };
        let agree = ruler.agree(&coarse.motion, &fine.motion, SHARE);
        let error = ruler.clone().up_to(agree).errors(&coarse.motion, &fine.motion).of(Quantity::Accuracy);
        let error = error.unwrap_or(f64::INFINITY);
        if best.is_none_or(|(_, most, least)| agree > most || (agree == most && error < least)) {
            best = Some((number, agree, error));
        }
    }
    let why = ran.iter().find_map(|ran| ran.as_ref().err().cloned());
    best.map(|(number, ..)| number)
        .ok_or_else(|| why.unwrap_or_else(|| Failure::Ended("there is no scheme".to_owned())))
}
