//! The reference of a trade-off: a run far finer than any candidate, its error bar from independent
//! runs, and the horizon.

use crate::axes::{Axes, in_seconds, refined, unreduced};
use crate::errors::{Errors, Quantity, Ruler};
use crate::horizon::{FirstImpact, first_impacts};
use crate::runner;
use crate::simulate::{Ran, expect, simulate};
use crate::{Failure, Motion, Sampling, Setting, Source, Warned};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
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
    /// How well it is known: quantity by quantity, the largest difference from a check before the
    /// horizon.
    pub bar: Errors,
    /// What errors are relative to, up to the horizon.
    pub ruler: Ruler,
    /// Whether the horizon is the end of the run.
    pub whole: bool,
    /// The share of the motion that the horizon is found by: the first of [`SHARES`], or a coarser
    /// one where that ends before the first impacts.
    pub share: f64,
    /// What the horizon must comprise; `None` in a scene without impacts.
    pub first_impact: Option<FirstImpact>,
    /// What `check` and `run` would warn of in it.
    pub warned: Vec<Warned>,
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
    /// Until when the two agree within [`Reference::share`] of the motion, s.
    pub agrees_until: f64,
    /// Whether its differences count for the error bar.
    pub for_bar: bool,
}

/// The horizon is where the reference and the same with another step, or started 1e-12 beside it,
/// have parted by this share of the motion: of the largest angle, of the largest side of a block,
/// and of the largest deflection. Where that is before the first impacts have been compared, the
/// next one is taken; the error bar then tells how well the reference is known.
pub const SHARES: [f64; 3] = [1e-3, 1e-2, 3e-2];
/// By how much of themselves the first body's coordinates are nudged.
pub const NUDGE: f64 = 1e-12;
/// The reference's step as a part of the scene's own, unless that is too much work.
const STEP: f64 = 0.0025;
/// Its elements and those of the check, as multiples of the scene's own. With an error that halves
/// from mesh to mesh, the difference of the two is as large as the error of the finer one.
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

/// A scheme as the reference: its own run, and those beside it that are only done where they are
/// asked for.
struct Candidate {
    /// The run itself, and with twice the step.
    fine: Ran,
    twice: Ran,
    scheme: usize,
    /// Started beside it; until when they agree is the other part of the horizon.
    nudged: Option<Ran>,
}

impl Candidate {
    /// Samples up to the horizon; `None` as long as it has not been started beside itself.
    fn samples(&self, ruler: &Ruler, share: f64) -> Option<usize> {
        let agree = |other: &Ran| ruler.agree(&other.motion, &self.fine.motion, share);
        Some(agree(&self.twice).min(agree(self.nudged.as_ref()?)).max(1))
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
    let mut total = jobs.len() + 2 + usize::from(refined(resolved, MESHES[0]) != refined(resolved, MESHES[1]));
    let count = AtomicUsize::new(0);
    let mut run = |jobs: &[(f64, Setting)], total: usize| {
        let mut tell = |_| done(count.fetch_add(1, Ordering::Relaxed) + 1, total);
        let one = |(nudge, setting): &(f64, Setting)| simulate(source, setting, *nudge, sampling, cancel);
        let ran = runner::in_order(jobs, threads, cancel, one, &mut tell);
        ran.into_iter().map(|ran| ran.unwrap_or(Err(Failure::Interrupted))).collect::<Vec<_>>()
    };
    let plain: Vec<(f64, Setting)> = jobs.iter().map(|setting| (0.0, setting.clone())).collect();
    let mut ran = run(&plain, total);
    if ran.contains(&Err(Failure::Interrupted)) {
        return Err(Failure::Interrupted);
    }
    let why = ran.iter().find_map(|ran| ran.as_ref().err().cloned());
    let mut singles: Vec<(usize, Ran)> = Vec::new();
    let mut candidates: Vec<Candidate> = Vec::new();
    for scheme in (0..schemes.len()).rev() {
        match (ran.pop(), ran.pop()) {
            (Some(Ok(twice)), Some(Ok(fine))) => candidates.push(Candidate { fine, twice, scheme, nudged: None }),
            (Some(twice), Some(fine)) => {
                singles.extend(twice.ok().map(|ran| (2 * scheme + 1, ran)));
                singles.extend(fine.ok().map(|ran| (2 * scheme, ran)));
            }
            _ => {}
        }
    }
    candidates.reverse();
    if candidates.is_empty() {
        return Err(why.unwrap_or_else(|| Failure::Ended("there is no scheme".to_owned())));
    }
    let ruler = Ruler::new(&resolved.scene, sampling);
    let end = sampling.time(sampling.count - 1);
    let impact_of = |of: &Candidate| first_impacts(&ruler, &of.fine.motion, end);
    let is_enough = |of: &Candidate, samples: usize| {
        impact_of(of).is_none_or(|impact| impact.is_within(ruler.clone().up_to(samples).horizon()))
    };
    // The scheme that agrees longest with itself comes first; where its horizon ends before the
    // first impacts have been compared, so does the next one, and then all again with a coarser
    // share.
    let mut chosen: Option<(usize, f64, usize)> = None;
    'search: for share in SHARES {
        for number in in_order_of_agreement(&candidates, &ruler, share) {
            let reach = ruler.agree(&candidates[number].twice.motion, &candidates[number].fine.motion, share).max(1);
            if chosen.is_some() && !is_enough(&candidates[number], reach) {
                continue;
            }
            if candidates[number].nudged.is_none() {
                total += usize::from(chosen.is_some());
                let job = (NUDGE, jobs[2 * candidates[number].scheme].clone());
                candidates[number].nudged = run(&[job], total).into_iter().next().transpose()?;
            }
            let Some(samples) = candidates[number].samples(&ruler, share) else { continue };
            if is_enough(&candidates[number], samples) {
                chosen = Some((number, share, samples));
                break 'search;
            }
            if chosen.is_none_or(|(_, _, most)| samples > most && share == SHARES[0]) {
                chosen = Some((number, share, samples));
            }
        }
    }
    let Some((number, share, samples)) = chosen else {
        return Err(Failure::Ended("no scheme comes to the end of the scene".to_owned()));
    };
    let Candidate { fine, twice, scheme: best, nudged } = candidates.remove(number);
    let scheme = &schemes[best];
    // An impact falls somewhere into a step: of two steps one may hit its time by luck, of three
    // hardly any.
    let mut extra = vec![("four times the step", recipe.setting(scheme, 4.0, MESHES[0]))];
    let other_mesh = recipe.setting(scheme, 1.0, MESHES[1]);
    if other_mesh != jobs[2 * best] {
        extra.push(("half the elements", other_mesh));
    }
    let beside: Vec<(f64, Setting)> = extra.iter().map(|(_, setting)| (0.0, setting.clone())).collect();
    let beside = run(&beside, total);

    let mut others = Vec::new();
    others.extend(nudged.map(|ran| ("started 1e-12 beside it", jobs[2 * best].clone(), ran, false)));
    others.push(("twice the step", jobs[2 * best + 1].clone(), twice, true));
    for ((what, setting), ran) in extra.into_iter().zip(beside) {
        others.push((what, setting, ran?, true));
    }
    singles.extend(
        candidates.into_iter().flat_map(|other| [(2 * other.scheme, other.fine), (2 * other.scheme + 1, other.twice)]),
    );
    singles.sort_by_key(|(at, _)| *at);
    for (at, ran) in singles {
        let what = if at % 2 == 0 { "another scheme" } else { "another scheme and twice the step" };
        if at / 2 != best {
            others.push((what, jobs[at].clone(), ran, true));
        }
    }
    let motion = fine.motion;
    let first_impact = first_impacts(&ruler, &motion, end);
    // The horizon goes by the two of the first kind; the error bar by all the others.
    let ruler = ruler.up_to(samples);
    let mut checks = Vec::new();
    let mut bar = Errors::default();
    for (what, setting, ran, for_bar) in others {
        let errors = ruler.errors(&ran.motion, &motion);
        if for_bar {
            bar = bar.larger(&errors);
        }
        let agree = Ruler::new(&resolved.scene, sampling).agree(&ran.motion, &motion, share);
        let agrees_until = sampling.time(agree.max(1) - 1);
        checks.push(Check { what, setting, errors, agrees_until, for_bar });
    }
    let whole = samples == sampling.count;
    let setting = jobs[2 * best].clone();
    Ok(Reference { setting, motion, checks, bar, whole, share, first_impact, warned: fine.warned, ruler })
}

impl Reference {
    /// Whether the first impacts of the scene, where it has any, are before the horizon with what
    /// they did.
    #[must_use]
    pub fn has_first_impacts(&self) -> bool {
        self.first_impact.is_none_or(|impact| impact.is_within(self.ruler.horizon()))
    }

    /// How well the reference is known in a quantity; 0 where the exact value is known, as that of
    /// the penetration.
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

/// The numbers of the candidates, first whose two runs agree the longest, and where several do, the
/// best.
fn in_order_of_agreement(candidates: &[Candidate], ruler: &Ruler, share: f64) -> Vec<usize> {
    let of = |candidate: &Candidate| {
        let (fine, twice) = (&candidate.fine.motion, &candidate.twice.motion);
        let agree = ruler.agree(twice, fine, share);
        let error = ruler.clone().up_to(agree).errors(twice, fine).of(Quantity::Accuracy);
        (agree, error.unwrap_or(f64::INFINITY))
    };
    let found: Vec<(usize, f64)> = candidates.iter().map(of).collect();
    let mut order: Vec<usize> = (0..found.len()).collect();
    order.sort_by(|&a, &b| found[b].0.cmp(&found[a].0).then(found[a].1.total_cmp(&found[b].1)).then(a.cmp(&b)));
    order
}
