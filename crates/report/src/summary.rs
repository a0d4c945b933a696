//! `summary.json`: the numbers of a run.

mod model;
mod passages;
mod records;

use model::ModelSummary;
pub(crate) use model::{BeamSummary, RemovedSummary};
use passages::CrossingRow;
pub(crate) use passages::{Passages, PeakRow};
pub use records::RecordSummary;

use crate::told::Told;
use crate::verdict::{BodyVerdict, OfBeams, StopReason, fallen_beams, headline};
use crate::{BeamRecord, ImpactRow, LargestDeflection, LargestStress, ReactionRange, Record, Warning};
use crate::{made_energy, own_weight, taken_energy, unlocated};
use serde::Serialize;
use teeter_integrator::{Ended, RockingMonitor, State};
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Layout;

/// How a run ended, as files say it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum EndedWord {
    /// All steps were taken.
    Complete,
    /// What the scene names in `time.stop` came to pass.
    Stopped,
    /// The motion is no longer finite, or a step could not be posed.
    Diverged,
    /// A step was not solved, and the scene requires it.
    Unconverged,
    /// The user ended it.
    Interrupted,
    /// No room for the results.
    DiskFull,
}

impl EndedWord {
    /// The word that stands for it in `summary.json`.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Complete => "complete",
            Self::Stopped => "stopped",
            Self::Diverged => "diverged",
            Self::Unconverged => "unconverged",
            Self::Interrupted => "interrupted",
            Self::DiskFull => "disk-full",
        }
    }
}

impl std::fmt::Display for EndedWord {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.word())
    }
}

impl From<&Ended> for EndedWord {
    fn from(ended: &Ended) -> Self {
        match ended {
            Ended::Complete => Self::Complete,
            Ended::Unconverged => Self::Unconverged,
            Ended::Interrupted => Self::Interrupted,
            _ => Self::Diverged,
        }
    }
}

/// What `summary.json` holds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// The scene's title.
    pub title: String,
    /// The program's version.
    pub version: &'static str,
    /// The time scheme.
    pub scheme: &'static str,
    /// Step size, s.
    pub dt: f64,
    /// Steps taken.
    pub steps: u64,
    /// Time reached, s.
    pub t: f64,
    /// Time that the steps took, output included, s.
    pub wall_seconds: f64,
    /// The same for one step, µs.
    pub us_per_step: f64,
    /// The contact solver.
    pub contact: ContactSummary,
    /// Deepest penetration of a block's corner in a surface that a contact joins it to, at the end of a step, m; what else is inside what
    /// (`docs/impacts.md`) isn't in it.
    pub max_penetration: f64,
    /// The energy account.
    pub energy: EnergySummary,
    /// The first 1000 impacts.
    pub impacts: Vec<ImpactRow>,
    /// All impacts, counted.
    pub impact_count: u64,
    /// How often a contact was lost for a moment and found again, without having been truly open.
    pub reclosure_count: u64,
    /// Steps in which the scheme didn't locate all impacts and ends of slides, or events: the rest of such a step is taken as by a fixed step.
    pub unlocated_steps: u64,
    /// Zero crossings of the angles against what carries the blocks, on a beam against its undeformed axis.
    pub crossings: Vec<CrossingRow>,
    /// Crossings and peaks from the lines between the feet of blocks on beams, for the page.
    #[serde(skip)]
    pub(crate) passages: Passages,
    /// All crossings, counted; only where the list holds no more than the first of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crossing_count: Option<u64>,
    /// Peaks of the angles between crossings, and after the last one where the angle has turned by the end.
    pub peaks: Vec<PeakRow>,
    /// What beams bore, of those that are asked.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub beams: Vec<BorneSummary>,
    /// The largest deflection of each beam, of a scene without blocks; the largest part of a span first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub deflections: Vec<LargestDeflection>,
    /// The records that prescribe motions, as used.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub records: Vec<RecordSummary>,
    /// What became of the scene, in a sentence.
    pub headline: String,
    /// What became of each block whose motion isn't prescribed.
    pub verdict: Vec<BodyVerdict>,
    /// The largest |φ|/α of all blocks.
    pub max_phi_over_alpha: Option<f64>,
    /// When the first block overturned, s.
    pub overturned_at: Option<f64>,
    /// From when on all blocks rest, s.
    pub rests_from: Option<f64>,
    /// What of `time.stop` ended the run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stopped_by: Option<StopReason>,
    /// Until when the motion can be trusted, s; not measured yet.
    pub horizon: Option<f64>,
    /// How the run ended.
    pub ended: EndedWord,
    /// What was modelled and what was left out.
    pub model: ModelSummary,
    /// Warnings, each kind of those of the run once, and what was found in the scene before it.
    pub warnings: Vec<Warning>,
    /// How some of it is told.
    #[serde(skip)]
    pub(crate) told: Told,
}

/// How the contact problems were solved.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ContactSummary {
    /// The method chosen.
    pub solver: String,
    /// Largest residual of a step, over all its contacts.
    pub max_residual: f64,
    /// Largest residual of a single contact.
    pub max_contact_residual: f64,
    /// Most iterations of a step.
    pub max_iterations: u32,
    /// Most contacts in a step.
    pub max_contacts: usize,
    /// Steps not solved to tolerance.
    pub unconverged_steps: u64,
}

/// The energy account.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EnergySummary {
    /// Largest residual of the identity in a step, relative to `scale`.
    pub largest_residual: f64,
    /// Kinetic and potential energy at the start, J.
    pub initial: f64,
    /// The same at the end, J.
    #[serde(rename = "final")]
    pub last: f64,
    /// What was lost to dissipation and to the scheme, J.
    pub lost: f64,
    /// Of that, what contacts, friction and dampers dissipated, J.
    pub dissipated: f64,
    /// The rest, what the time scheme itself dissipated, J; no physical cause. Negative if it made energy.
    pub lost_by_scheme: f64,
    /// The scene's energy scale: max |T| + |V_elastic| + |ΔV_gravity|, at least m g R; J.
    pub scale: f64,
    /// Steps in which contacts gave energy to the bodies.
    pub positive_contact_work: PositiveWorkSummary,
    /// Largest U¹_t·p_t of a contact, J: at most 0 but for rounding; 0 without contacts.
    pub largest_tangential_work: f64,
}

/// Steps in which contacts gave energy to the bodies.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PositiveWorkSummary {
    /// How many.
    pub steps: u64,
    /// The largest gain, J.
    pub largest: f64,
    /// All gains, J.
    pub sum: f64,
}

/// Verdicts as the headline tells them: the last peak of what rocks on a beam counts from the line between its feet there, as φ/α and the table of half
/// cycles of the page, not from the beam's undeformed axis.
fn as_told(scene: &Scene, verdict: &[BodyVerdict], record: &Record) -> Vec<BodyVerdict> {
    let mut told = verdict.to_vec();
    let lines = record.feet_lines.iter().zip(&record.rocking);
    // What moves as prescribed has no verdict.
    let free = scene.blocks.iter().zip(lines).filter(|(block, _)| !block.motion.is_given());
    for (of, (_, (line, about))) in told.iter_mut().zip(free) {
        let since = of.stands_from.unwrap_or(0.0);
        if of.last_peak.is_some() && of.on_its_way.is_none() && line.is_on_beam() {
            // None from the beam's undeformed axis beside a φ/α from the line.
            let peak = line.told_peak(about, since);
            (of.last_peak, of.t) = (peak.map(|peak| peak.phi), peak.map(|peak| peak.t));
            of.against = Some("the line between its feet".to_owned());
        }
    }
    told
}

/// What a beam bore, over all steps.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BorneSummary {
    /// The beam.
    pub beam: String,
    /// The largest normal stress, over nodes and loads; none where the section doesn't know its modulus.
    pub largest_stress: Option<LargestStress>,
    /// The same as a part of the yield strength, where that is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part_of_yield_strength: Option<f64>,
    /// Both with the beam's own weight, where the scene leaves that out (`self_weight = false`) and its supports hold it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_stress_with_own_weight: Option<LargestStress>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part_with_own_weight: Option<f64>,
    /// Whether the scene leaves it out.
    #[serde(skip)]
    pub(crate) is_without_weight: bool,
    /// What its supports bore, where the scene asks for it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub reactions: Vec<ReactionRange>,
}

impl BorneSummary {
    fn new(scene: &Scene, borne: &BeamRecord) -> Self {
        let of = scene.beams.iter().find(|beam| beam.name == borne.beam);
        let strength = of.and_then(|beam| beam.yield_strength);
        let part = |of: Option<LargestStress>| of.zip(strength).map(|(largest, strength)| largest.stress / strength);
        Self {
            beam: borne.beam.clone(),
            largest_stress: borne.largest,
            part_of_yield_strength: part(borne.largest),
            largest_stress_with_own_weight: borne.largest_with_weight,
            part_with_own_weight: part(borne.largest_with_weight),
            is_without_weight: of.is_some_and(|beam| own_weight::is_left_out(scene, beam)),
            reactions: borne.reactions.clone(),
        }
    }

    /// The part of the yield strength by which the beam is judged: with its own weight where that is known.
    pub(crate) fn decisive_part(&self) -> Option<f64> {
        self.part_with_own_weight.or(self.part_of_yield_strength)
    }

    /// What is said of the beam's own weight after the part of its yield strength: nothing unless the scene leaves it out; and the part with it, where
    /// that is known.
    pub(crate) fn about_weight(&self, percent: impl Fn(f64) -> String) -> String {
        if !self.is_without_weight {
            return String::new();
        }
        let with = self.part_with_own_weight.map_or_else(String::new, |with| format!(", {} with it", percent(with)));
        format!(" without its own weight{with}")
    }
}

impl Summary {
    /// The summary of a run that took `wall_seconds`.
    #[must_use]
    pub fn new(
        scene: &Scene,
        layout: &Layout,
        state: &State,
        record: &Record,
        ended: EndedWord,
        wall_seconds: f64,
    ) -> Self {
        Self::of_keys(&["records", "headline"], scene, layout, state, record, ended, wall_seconds)
    }

    /// As [`Self::new`], but what takes long, the measures of accelerograms (`records`) and the `headline`, is left empty unless it is among
    /// these [`KEYS`](Self::KEYS).
    #[must_use]
    pub fn of_keys(
        keys: &[&str],
        scene: &Scene,
        layout: &Layout,
        state: &State,
        record: &Record,
        ended: EndedWord,
        wall_seconds: f64,
    ) -> Self {
        let wanted = |key: &str| keys.contains(&key);
        let (ledger, tally) = (&state.ledger, &state.tally);
        let counted = record.rocking.iter().map(RockingMonitor::count).sum::<u64>();
        let Passages { crossings, peaks } =
            Passages::of(layout, record.rocking.iter().map(|monitor| (monitor, monitor.turned(), Vec::new())));
        let lines = record.feet_lines.iter().zip(&record.rocking);
        let lines = lines.map(|(line, about)| (line.monitor(), line.turned(about), line.slopes().collect()));
        // What has no headline has no page.
        let passages = if wanted("headline") { Passages::of(layout, lines) } else { Passages::default() };
        let gains = &ledger.positive_contact_work;
        let verdict = record.fates.verdict(scene, layout, state, &record.rocking);
        let mut deflections = record.deflections.clone();
        let part = |of: &LargestDeflection| {
            let span = scene.beams.iter().find(|beam| beam.name == of.beam).map_or(1.0, |beam| beam.spec.span);
            of.w.abs() / span
        };
        deflections.sort_by(|a, b| part(b).total_cmp(&part(a)));
        let beams: Vec<BorneSummary> = record.beams.iter().map(|borne| BorneSummary::new(scene, borne)).collect();
        let first =
            |of: fn(&BodyVerdict) -> Option<f64>, pick: fn(f64, f64) -> f64| verdict.iter().filter_map(of).reduce(pick);
        Self {
            headline: match wanted("headline") {
                true => {
                    let moved = |number| record.fates.moved(number, layout, state);
                    let told = as_told(scene, &verdict, record);
                    let fallen = fallen_beams(scene, layout, state, moved);
                    let has_impacts = record.impact_count > 0;
                    let of_beams = OfBeams { borne: &beams, deflections: &deflections, fallen: &fallen, has_impacts };
                    headline(scene, state, &told, &of_beams, moved)
                }
                false => String::new(),
            },
            max_phi_over_alpha: first(|of| of.max_phi_over_alpha, f64::max),
            overturned_at: first(|of| of.overturned_at, f64::min),
            rests_from: verdict
                .iter()
                .map(|of| of.rests_from)
                .collect::<Option<Vec<_>>>()
                .and_then(|of| of.into_iter().reduce(f64::max)),
            stopped_by: record.fates.stopped().map(|(_, reason)| reason),
            title: scene.title.clone(),
            version: env!("CARGO_PKG_VERSION"),
            scheme: scene.time.scheme.word(),
            dt: state.dt,
            steps: state.step,
            t: state.t,
            wall_seconds,
            us_per_step: wall_seconds * 1e6 / state.step.saturating_sub(record.first_step).max(1) as f64,
            contact: ContactSummary {
                solver: scene.solver.method.clone(),
                max_residual: tally.max_residual,
                max_contact_residual: tally.max_contact_residual,
                max_iterations: tally.max_iterations,
                max_contacts: tally.max_contacts,
                unconverged_steps: tally.unconverged_steps,
            },
            max_penetration: tally.max_penetration,
            energy: EnergySummary {
                largest_residual: ledger.relative_residual(),
                initial: ledger.initial.total(),
                last: ledger.current.total(),
                lost: 0.0 - (ledger.sum.contact + ledger.sum.friction + ledger.sum.viscous + ledger.sum.numerical),
                dissipated: 0.0 - (ledger.sum.contact + ledger.sum.friction + ledger.sum.viscous),
                lost_by_scheme: 0.0 - ledger.sum.numerical,
                scale: ledger.scale,
                positive_contact_work: PositiveWorkSummary {
                    steps: gains.steps,
                    largest: gains.largest,
                    sum: gains.sum,
                },
                // −∞ while there was no contact, which JSON can't hold.
                largest_tangential_work: if ledger.largest_tangential_work.is_finite() {
                    ledger.largest_tangential_work
                } else {
                    0.0
                },
            },
            impacts: record.impacts.clone(),
            impact_count: record.impact_count,
            reclosure_count: record.reclosure_count,
            unlocated_steps: state.tally.unlocated_steps,
            crossing_count: (counted > crossings.len() as u64).then_some(counted),
            crossings,
            passages,
            peaks,
            beams,
            deflections,
            verdict,
            records: match wanted("records") {
                true => scene.records().map(|of| RecordSummary::up_to(state.t, of)).collect(),
                false => Vec::new(),
            },
            horizon: record.horizon,
            ended,
            model: ModelSummary::new(scene, layout),
            warnings: Self::warnings(scene, state, record).collect(),
            told: Told::of(scene, record.last_penetration),
        }
    }

    /// The warnings of a run, as its summary has them: those that were given along the way, and those that only its end shows.
    pub fn warnings<'a>(scene: &Scene, state: &State, record: &'a Record) -> impl Iterator<Item = Warning> + use<'a> {
        let at_end = [
            made_energy::warning(scene, state),
            taken_energy::warning(scene, &state.ledger),
            unlocated::warning(scene, state),
        ];
        record.warnings.warnings().iter().cloned().chain(at_end.into_iter().flatten())
    }

    /// The keys at the top of `summary.json`; those of what a run doesn't have are left out there.
    pub const KEYS: [&'static str; 31] = [
        "title",
        "version",
        "scheme",
        "dt",
        "steps",
        "t",
        "wall_seconds",
        "us_per_step",
        "contact",
        "max_penetration",
        "energy",
        "impacts",
        "impact_count",
        "reclosure_count",
        "unlocated_steps",
        "crossings",
        "crossing_count",
        "peaks",
        "beams",
        "deflections",
        "records",
        "headline",
        "verdict",
        "max_phi_over_alpha",
        "overturned_at",
        "rests_from",
        "stopped_by",
        "horizon",
        "ended",
        "model",
        "warnings",
    ];

    /// The value that `summary.json` has under a key at its top, alone: a study wants few of them of each run, and the lists
    /// may be long. `None` where it has no such key.
    #[must_use]
    pub fn value(&self, key: &str) -> Option<serde_json::Value> {
        fn of(value: &impl Serialize) -> Option<serde_json::Value> {
            serde_json::to_value(value).ok()
        }
        fn unless_empty<T: Serialize>(list: &Vec<T>) -> Option<serde_json::Value> {
            if list.is_empty() { None } else { of(list) }
        }
        match key {
            "title" => of(&self.title),
            "version" => of(&self.version),
            "scheme" => of(&self.scheme),
            "dt" => of(&self.dt),
            "steps" => of(&self.steps),
            "t" => of(&self.t),
            "wall_seconds" => of(&self.wall_seconds),
            "us_per_step" => of(&self.us_per_step),
            "contact" => of(&self.contact),
            "max_penetration" => of(&self.max_penetration),
            "energy" => of(&self.energy),
            "impacts" => of(&self.impacts),
            "impact_count" => of(&self.impact_count),
            "reclosure_count" => of(&self.reclosure_count),
            "unlocated_steps" => of(&self.unlocated_steps),
            "crossings" => of(&self.crossings),
            "crossing_count" => self.crossing_count.as_ref().and_then(of),
            "peaks" => of(&self.peaks),
            "beams" => unless_empty(&self.beams),
            "deflections" => unless_empty(&self.deflections),
            "records" => unless_empty(&self.records),
            "headline" => of(&self.headline),
            "verdict" => of(&self.verdict),
            "max_phi_over_alpha" => of(&self.max_phi_over_alpha),
            "overturned_at" => of(&self.overturned_at),
            "rests_from" => of(&self.rests_from),
            "stopped_by" => self.stopped_by.as_ref().and_then(of),
            "horizon" => of(&self.horizon),
            "ended" => of(&self.ended),
            "model" => of(&self.model),
            "warnings" => of(&self.warnings),
            _ => None,
        }
    }

    /// As JSON text.
    ///
    /// # Errors
    /// If a number is not finite.
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }
}

#[cfg(test)]
mod tests {
    use super::EndedWord::{self, Complete, DiskFull, Diverged, Interrupted, Unconverged};

    #[test]
    fn a_stress_without_the_own_weight_is_told_with_it_however_little_that_adds() {
        let told = |with: Option<f64>, is_without_weight: bool| {
            let beam = super::BorneSummary {
                beam: "shelf".to_owned(),
                largest_stress: None,
                part_of_yield_strength: Some(0.0093),
                largest_stress_with_own_weight: None,
                part_with_own_weight: with,
                is_without_weight,
                reactions: Vec::new(),
            };
            beam.about_weight(|part| format!("{} %", 100.0 * part))
        };
        assert_eq!(told(Some(0.0181), true), " without its own weight, 1.81 % with it");
        assert_eq!(told(None, true), " without its own weight");
        assert_eq!(told(None, false), "");
    }

    #[test]
    fn how_a_run_ended_is_written_by_its_word() {
        for ended in [Complete, Diverged, Unconverged, Interrupted, DiskFull] {
            assert_eq!(serde_json::to_string(&ended).unwrap(), format!("\"{}\"", EndedWord::word(ended)));
        }
    }
}
