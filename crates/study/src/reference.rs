//! The reference of a trade-off: a run far finer than any candidate, its error bar from independent
//! runs, and the horizon.

use crate::axes::{Axes, in_seconds, refined, unreduced};
use crate::errors::{ErrorNorms, Errors, Quantity};
use crate::horizon::{FirstImpact, first_impacts};
use crate::runner;
use crate::simulate::{RunResult, expect, simulate};
use crate::{Failure, SampledMotion, Sampling, Setting, SettingWarning, StudyScene};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use teeter_scenario::resolve::Resolved;

/// A verified reference.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// Its setting.
    pub setting: Setting,
    /// Its motion.
    pub motion: SampledMotion,
    /// The runs that verify it.
    pub checks: Vec<VerifyingRun>,
    /// Its error bar: for each quantity the largest difference from a verifying run before the
    /// horizon.
    pub bar: Errors,
    /// The norms of errors, up to the horizon.
    pub norms: ErrorNorms,
    /// Whether the horizon is the end of the run.
    pub whole: bool,
    /// The share of the motion that determines the horizon: the first of [`SHARES`], or a coarser
    /// one if the horizon would end before the first impacts.
    pub share: f64,
    /// The first impact that must be before the horizon; `None` in a scene without impacts.
    pub first_impact: Option<FirstImpact>,
    /// Its warnings by `check` and `run`.
    pub warned: Vec<SettingWarning>,
}

/// A run with which the reference is compared.
#[derive(Debug, Clone, PartialEq)]
pub struct VerifyingRun {
    /// The difference in its settings.
    pub what: &'static str,
    /// Its setting.
    pub setting: Setting,
    /// Its differences from the reference before the horizon.
    pub errors: Errors,
    /// Up to when the two agree within [`Reference::share`] of the motion, s.
    pub agrees_until: f64,
    /// Whether its differences count for the error bar.
    pub for_bar: bool,
}

/// The horizon is where the reference and a run with another step, or with a perturbed initial
/// state, differ by this share of the motion: of the largest angle, of the largest side of a block,
/// and of the largest deflection. If that is before the first impacts have been compared, the next
/// share is used; the error bar still gives the accuracy of the reference.
pub const SHARES: [f64; 3] = [1e-3, 1e-2, 3e-2];
/// Relative perturbation of the first body's coordinates.
pub const PERTURBATION: f64 = 1e-12;
/// The reference's step as a fraction of the scene's own, unless that is too much work.
const STEP: f64 = 0.0025;
/// Elements of the reference and of a verifying run, as multiples of the scene's own. If the error
/// halves from mesh to mesh, the difference of the two equals the error of the finer one.
const MESHES: [f64; 2] = [4.0, 2.0];
/// Modelled work of the reference, s.
const MOST_WORK: f64 = 1.2;
/// Tolerance of its contact solver.
const TOLERANCE: &str = "1e-13";

/// The settings of the reference, for every scheme.
struct ReferenceSettings<'a> {
    resolved: &'a Resolved,
    step: f64,
}

impl ReferenceSettings<'_> {
    fn setting(&self, scheme: &Setting, coarser: f64, mesh: f64) -> Setting {
        let scene = &self.resolved.scene;
        let mut setting = scheme.clone().with(&unreduced(self.resolved)).with(&refined(self.resolved, mesh));
        setting = setting.set("time.step", in_seconds(coarser * self.step));
        if scene.time.theta != 0.5 {
            setting = setting.set("time.theta", "0.5");
        }
        if scene.has_contacts() { setting.set("solver.tolerance", TOLERANCE) } else { setting }
    }
}

/// A scheme that may be the reference: its runs.
struct ReferenceCandidate {
    /// The run itself, and with twice the step.
    fine: RunResult,
    twice: RunResult,
    scheme: usize,
    /// With a perturbed initial state, once it has been run: it also limits the horizon.
    perturbed: Option<RunResult>,
}

impl ReferenceCandidate {
    /// Samples up to the horizon; `None` before the perturbed run.
    fn samples(&self, norms: &ErrorNorms, share: f64) -> Option<usize> {
        let agree = |other: &RunResult| norms.agree(&other.motion, &self.fine.motion, share);
        Some(agree(&self.twice).min(agree(self.perturbed.as_ref()?)).max(1))
    }
}

/// The reference that was chosen among the candidates.
#[derive(Clone, Copy)]
struct Choice {
    candidate: usize,
    /// The share of the motion that determines the horizon.
    share: f64,
    /// Samples up to the horizon.
    samples: usize,
}

/// A run for comparison with the reference: what is different, the run, and whether it counts for
/// the error bar.
type Comparison = (&'static str, Setting, RunResult, bool);

/// Finds the reference of a scene.
///
/// # Errors
/// If no scheme comes to the end of the scene, or the user interrupts.
pub(crate) fn find(
    source: &StudyScene,
    resolved: &Resolved,
    axes: &Axes,
    sampling: Sampling,
    threads: usize,
    cancel: &Arc<AtomicBool>,
    done: &mut (dyn FnMut(usize, usize) + Send),
) -> Result<Reference, Failure> {
    let settings = ReferenceSettings { resolved, step: affordable_step(source, resolved, axes)? };
    let schemes = &axes.scheme.options;
    // Each scheme with two steps: the one with the best agreement between them is the reference.
    let jobs: Vec<Setting> =
        schemes.iter().flat_map(|scheme| [1.0, 2.0].map(|h| settings.setting(scheme, h, MESHES[0]))).collect();
    let total = jobs.len() + 2 + usize::from(refined(resolved, MESHES[0]) != refined(resolved, MESHES[1]));
    let norms = ErrorNorms::new(&resolved.scene, sampling);
    let mut search = ReferenceSearch { source, sampling, threads, cancel, jobs, norms, total, count: 0, done };
    let (mut candidates, singles) = search.candidates()?;
    let choice = search.choose(&mut candidates)?;
    let chosen = candidates.remove(choice.candidate);

    let scheme = &schemes[chosen.scheme];
    // The position of an impact within its step is random: one of two steps may have its time
    // right by chance, but hardly all of three.
    let mut extra = vec![("four times the step", settings.setting(scheme, 4.0, MESHES[0]))];
    let other_mesh = settings.setting(scheme, 1.0, MESHES[1]);
    if other_mesh != search.jobs[2 * chosen.scheme] {
        extra.push(("half the elements", other_mesh));
    }
    let plain: Vec<(f64, Setting)> = extra.iter().map(|(_, setting)| (0.0, setting.clone())).collect();
    let runs = search.run(&plain);
    let mut comparisons: Vec<Comparison> = Vec::new();
    for ((what, setting), run) in extra.into_iter().zip(runs) {
        comparisons.push((what, setting, run?, true));
    }
    Ok(search.reference(choice, chosen, comparisons, candidates, singles))
}

/// The search for the reference of a scene.
struct ReferenceSearch<'a> {
    source: &'a StudyScene,
    sampling: Sampling,
    threads: usize,
    cancel: &'a Arc<AtomicBool>,
    /// Each scheme with the step of the reference, and with twice that.
    jobs: Vec<Setting>,
    /// Over the whole run.
    norms: ErrorNorms,
    /// Runs in total, and so far.
    total: usize,
    count: usize,
    done: &'a mut (dyn FnMut(usize, usize) + Send),
}

/// A run with the number of its job.
type SingleRun = (usize, RunResult);

impl ReferenceSearch<'_> {
    /// Runs settings, given with the perturbation of the initial state.
    fn run(&mut self, jobs: &[(f64, Setting)]) -> Vec<Result<RunResult, Failure>> {
        let Self { source, sampling, cancel, total, count, done, .. } = self;
        let mut tell = |_| {
            *count += 1;
            done(*count, *total);
        };
        let one =
            |(perturbation, setting): &(f64, Setting)| simulate(source, setting, *perturbation, *sampling, cancel);
        let runs = runner::in_order(jobs, self.threads, cancel, one, &mut tell);
        runs.into_iter().map(|run| run.unwrap_or(Err(Failure::Interrupted))).collect()
    }

    /// The schemes that come to the end with both steps, and the runs of the others that do, by the
    /// number of their job.
    fn candidates(&mut self) -> Result<(Vec<ReferenceCandidate>, Vec<SingleRun>), Failure> {
        let plain: Vec<(f64, Setting)> = self.jobs.iter().map(|setting| (0.0, setting.clone())).collect();
        let mut runs = self.run(&plain);
        if runs.contains(&Err(Failure::Interrupted)) {
            return Err(Failure::Interrupted);
        }
        let why = runs.iter().find_map(|run| run.as_ref().err().cloned());
        let (mut candidates, mut singles) = (Vec::new(), Vec::new());
        for scheme in (0..self.jobs.len() / 2).rev() {
            match (runs.pop(), runs.pop()) {
                (Some(Ok(twice)), Some(Ok(fine))) => {
                    candidates.push(ReferenceCandidate { fine, twice, scheme, perturbed: None });
                }
                (Some(twice), Some(fine)) => {
                    singles.extend(twice.ok().map(|run| (2 * scheme + 1, run)));
                    singles.extend(fine.ok().map(|run| (2 * scheme, run)));
                }
                _ => {}
            }
        }
        candidates.reverse();
        if candidates.is_empty() {
            return Err(why.unwrap_or_else(|| Failure::Ended("there is no scheme".to_owned())));
        }
        Ok((candidates, singles))
    }

    fn first_impact(&self, motion: &SampledMotion) -> Option<FirstImpact> {
        first_impacts(&self.norms, motion, self.sampling.time(self.sampling.count - 1))
    }

    /// Whether the first impacts are within this number of samples.
    fn is_enough(&self, of: &ReferenceCandidate, samples: usize) -> bool {
        let horizon = self.norms.clone().up_to(samples).horizon();
        self.first_impact(&of.fine.motion).is_none_or(|impact| impact.is_within(horizon))
    }

    /// Chooses the reference: the scheme with the longest agreement between its steps; if its
    /// horizon ends before the first impacts have been compared, the next one, and then all again
    /// with a coarser share.
    fn choose(&mut self, candidates: &mut [ReferenceCandidate]) -> Result<Choice, Failure> {
        let mut chosen: Option<Choice> = None;
        for share in SHARES {
            for candidate in in_order_of_agreement(candidates, &self.norms, share) {
                let of = &candidates[candidate];
                let reach = self.norms.agree(&of.twice.motion, &of.fine.motion, share).max(1);
                if chosen.is_some() && !self.is_enough(of, reach) {
                    continue;
                }
                if of.perturbed.is_none() {
                    self.total += usize::from(chosen.is_some());
                    let job = (PERTURBATION, self.jobs[2 * of.scheme].clone());
                    candidates[candidate].perturbed = self.run(&[job]).into_iter().next().transpose()?;
                }
                let Some(samples) = candidates[candidate].samples(&self.norms, share) else { continue };
                if self.is_enough(&candidates[candidate], samples) {
                    return Ok(Choice { candidate, share, samples });
                }
                if chosen.is_none_or(|best| samples > best.samples && share == SHARES[0]) {
                    chosen = Some(Choice { candidate, share, samples });
                }
            }
        }
        chosen.ok_or_else(|| Failure::Ended("no scheme comes to the end of the scene".to_owned()))
    }

    /// The reference with its horizon and error bar, from the chosen scheme, its further runs,
    /// and the runs of other schemes.
    fn reference(
        &self,
        choice: Choice,
        chosen: ReferenceCandidate,
        further: Vec<Comparison>,
        others: Vec<ReferenceCandidate>,
        mut singles: Vec<(usize, RunResult)>,
    ) -> Reference {
        let ReferenceCandidate { fine, twice, scheme: best, perturbed } = chosen;
        let mut comparisons: Vec<Comparison> = Vec::new();
        // The perturbed run limits the horizon; all others count for the error bar.
        comparisons.extend(perturbed.map(|run| ("perturbed by 1e-12", self.jobs[2 * best].clone(), run, false)));
        comparisons.push(("twice the step", self.jobs[2 * best + 1].clone(), twice, true));
        comparisons.extend(further);
        singles.extend(
            others.into_iter().flat_map(|other| [(2 * other.scheme, other.fine), (2 * other.scheme + 1, other.twice)]),
        );
        singles.sort_by_key(|(at, _)| *at);
        for (at, run) in singles {
            let what = if at % 2 == 0 { "another scheme" } else { "another scheme and twice the step" };
            if at / 2 != best {
                comparisons.push((what, self.jobs[at].clone(), run, true));
            }
        }
        let Choice { share, samples, .. } = choice;
        let motion = fine.motion;
        let norms = self.norms.clone().up_to(samples);
        let (mut checks, mut bar) = (Vec::new(), Errors::default());
        for (what, setting, run, for_bar) in comparisons {
            let errors = norms.errors(&run.motion, &motion);
            if for_bar {
                bar = bar.larger(&errors);
            }
            let agree = self.norms.agree(&run.motion, &motion, share);
            let agrees_until = self.sampling.time(agree.max(1) - 1);
            checks.push(VerifyingRun { what, setting, errors, agrees_until, for_bar });
        }
        Reference {
            setting: self.jobs[2 * best].clone(),
            first_impact: self.first_impact(&motion),
            motion,
            checks,
            bar,
            whole: samples == self.sampling.count,
            share,
            warned: fine.warned,
            norms,
        }
    }
}

impl Reference {
    /// Whether the first impacts of the scene, if any, and their effect are before the horizon.
    #[must_use]
    pub fn has_first_impacts(&self) -> bool {
        self.first_impact.is_none_or(|impact| impact.is_within(self.norms.horizon()))
    }

    /// The error bar of the reference in a quantity; 0 if the exact value is known, as for the
    /// penetration.
    #[must_use]
    pub fn bar_of(&self, quantity: Quantity) -> f64 {
        if quantity == Quantity::Penetration { 0.0 } else { self.bar.of(quantity).unwrap_or(0.0) }
    }
}

/// The reference's step: as fine as the work allows, s.
fn affordable_step(source: &StudyScene, resolved: &Resolved, axes: &Axes) -> Result<f64, Failure> {
    let own = resolved.scene.time.step;
    let mut step = STEP * own;
    let work = |step: f64| {
        let recipe = ReferenceSettings { resolved, step };
        let works = axes.scheme.options.iter().map(|scheme| expect(source, &recipe.setting(scheme, 1.0, MESHES[0])));
        works.reduce(Result::or).unwrap_or(Err(Failure::Ended("there is no scheme".to_owned())))
    };
    // Doubles of decimal steps have few digits.
    while step < own && work(step)?.seconds() > MOST_WORK {
        step *= 2.0;
    }
    Ok(step)
}

/// The indices of the candidates, by how long their two runs agree, and among equals by how well.
fn in_order_of_agreement(candidates: &[ReferenceCandidate], norms: &ErrorNorms, share: f64) -> Vec<usize> {
    let of = |candidate: &ReferenceCandidate| {
        let (fine, twice) = (&candidate.fine.motion, &candidate.twice.motion);
        let agree = norms.agree(twice, fine, share);
        let error = norms.clone().up_to(agree).errors(twice, fine).of(Quantity::Accuracy);
        (agree, error.unwrap_or(f64::INFINITY))
    };
    let found: Vec<(usize, f64)> = candidates.iter().map(of).collect();
    let mut order: Vec<usize> = (0..found.len()).collect();
    order.sort_by(|&a, &b| found[b].0.cmp(&found[a].0).then(found[a].1.total_cmp(&found[b].1)).then(a.cmp(&b)));
    order
}
