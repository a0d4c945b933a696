//! What a step did, phase by phase: what observers read, whatever the scheme.

use crate::contact::tangential;
use crate::{Contact, ContactStage, Energy, Model, Size, State, StepEnergy, StepSpan};
use teeter_contact::Outcome;

/// What happens in a phase of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PhaseKind {
    /// Forces and impulses together over a time: a step of a time-stepping scheme.
    Step,
    /// Motion under forces; contacts that press do so with finite forces, and nothing strikes.
    Smooth,
    /// An instant in which velocities jump.
    Impact,
}

/// By which means of its ends a phase satisfies the balance of momentum: with q̄ = (1−w)q⁰ + w q¹, and v̄ alike,
///
/// ```text
/// M (v¹ − v⁰)/τ + C v̄ + f_elastic(q̄) = P̄ + Jᵀp/τ
/// ```
///
/// P̄ the mean of the loads over the phase; an elastic force that isn't linear is linearised at q⁰ ⊕ wτ v⁰.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Balance {
    /// By the weight w of the end, θ of a θ step.
    Weighted(f64),
}

impl Balance {
    /// The weight of the end of the phase.
    #[must_use]
    pub fn weight(self) -> f64 {
        match self {
            Self::Weighted(w) => w,
        }
    }
}

/// A phase as a scheme hands it in: how it ended, and the terms of the energy identity that only the scheme knows.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct PhaseEnd<'a> {
    /// What happened in it.
    pub kind: PhaseKind,
    /// Its end, s; it begins where the one before it ended, the first at the start of the step.
    pub end: f64,
    /// How long it took, s, without the rounding of times; `None`: the time from its start to its end.
    pub duration: Option<f64>,
    /// Coordinates at its end.
    pub q: &'a [f64],
    /// Velocities at its end.
    pub v: &'a [f64],
    /// By which means it satisfies the balance of momentum.
    pub balance: Balance,
    /// Work of loads, dampers, the scheme itself; what contacts did is added, unless it is known.
    pub energy: StepEnergy,
    /// Whether `energy` holds the work of contacts already.
    pub knows_contacts: bool,
    /// q̄, the mean of the coordinates over the phase, where the scheme knows it; else it is that of
    /// the balance.
    pub mean: Option<&'a [f64]>,
    /// v̄, where the scheme knows it; else it is the change of the coordinates over the duration where
    /// q̄ is known, and that of the balance where it isn't.
    pub mean_velocity: Option<&'a [f64]>,
    /// How its contact problems were solved; `None` without contacts.
    pub outcome: Option<Outcome>,
}

impl<'a> PhaseEnd<'a> {
    /// A phase that ended at time `end` (s) with these coordinates and velocities.
    #[must_use]
    pub fn new(kind: PhaseKind, end: f64, q: &'a [f64], v: &'a [f64]) -> Self {
        Self {
            kind,
            end,
            duration: None,
            q,
            v,
            balance: Balance::Weighted(0.5),
            energy: StepEnergy::default(),
            knows_contacts: false,
            mean: None,
            mean_velocity: None,
            outcome: None,
        }
    }

    /// With these terms of the energy identity, the work of contacts among them: in a smooth motion it
    /// isn't that of the mean velocity.
    #[must_use]
    pub fn with_all_energy(mut self, energy: StepEnergy) -> Self {
        (self.energy, self.knows_contacts) = (energy, true);
        self
    }

    /// With the mean of the coordinates over the phase.
    #[must_use]
    pub fn with_mean(mut self, q: &'a [f64]) -> Self {
        self.mean = Some(q);
        self
    }

    /// With the mean of the velocities over the phase.
    #[must_use]
    pub fn with_mean_velocity(mut self, v: &'a [f64]) -> Self {
        self.mean_velocity = Some(v);
        self
    }

    /// With this duration, s.
    #[must_use]
    pub fn lasting(mut self, duration: f64) -> Self {
        self.duration = Some(duration);
        self
    }

    /// With these means in the balance of momentum; halves of both ends without.
    #[must_use]
    pub fn with_balance(mut self, balance: Balance) -> Self {
        self.balance = balance;
        self
    }

    /// With these terms of the energy identity.
    #[must_use]
    pub fn with_energy(mut self, energy: StepEnergy) -> Self {
        self.energy = energy;
        self
    }

    /// With contacts whose problem was solved so.
    #[must_use]
    pub fn with_outcome(mut self, outcome: Option<Outcome>) -> Self {
        self.outcome = outcome;
        self
    }
}

/// A phase of the step, kept.
#[derive(Clone, Debug)]
struct Kept<const D: usize> {
    kind: PhaseKind,
    start: f64,
    end: f64,
    /// Whether none comes after it that takes time.
    is_last_lasting: bool,
    duration: Option<f64>,
    balance: Balance,
    contacts: Vec<Contact<D>>,
    outcome: Option<Outcome>,
    energy: StepEnergy,
    /// Energies at its end, with what springs of contacts hold.
    now: Energy,
    stored: f64,
    largest_slip_work: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    /// q̄ and v̄, where the scheme knows them.
    mean: Vec<f64>,
    mean_velocity: Vec<f64>,
}

impl<const D: usize> Kept<D> {
    /// How long it took in a step of this span, s.
    #[inline]
    fn duration(&self, span: &StepSpan) -> f64 {
        let whole = self.start == span.start && self.end == span.end;
        self.duration.unwrap_or(if whole { span.h } else { self.end - self.start })
    }

    fn new() -> Self {
        Self {
            kind: PhaseKind::Step,
            start: 0.0,
            end: 0.0,
            is_last_lasting: false,
            duration: None,
            balance: Balance::Weighted(0.5),
            contacts: Vec::new(),
            outcome: None,
            energy: StepEnergy::default(),
            now: Energy::default(),
            stored: 0.0,
            largest_slip_work: f64::NEG_INFINITY,
            q: Vec::new(),
            v: Vec::new(),
            mean: Vec::new(),
            mean_velocity: Vec::new(),
        }
    }
}

/// The phases of a step, in memory that is kept over steps.
#[derive(Clone, Debug)]
pub(crate) struct Phases<const D: usize> {
    kept: Vec<Kept<D>>,
    used: usize,
    /// Coordinates and velocities at the start of the step.
    q: Vec<f64>,
    v: Vec<f64>,
    pub(crate) span: StepSpan,
}

impl<const D: usize> Phases<D> {
    pub(crate) fn new() -> Self {
        let span = StepSpan { start: 0.0, end: 0.0, h: 0.0 };
        Self { kept: vec![Kept::new()], used: 0, q: Vec::new(), v: Vec::new(), span }
    }

    /// Makes room for so many contacts in states of this size.
    pub(crate) fn reserve(&mut self, contacts: usize, size: Size) {
        self.q.reserve(size.q);
        self.v.reserve(size.v);
        for kept in &mut self.kept {
            kept.contacts.reserve(contacts);
            kept.q.reserve(size.q);
            kept.v.reserve(size.v);
            kept.mean.reserve(size.q);
        }
    }

    /// Makes room for v̄ of the first phase.
    pub(crate) fn reserve_mean_velocity(&mut self, size: Size) {
        if let Some(kept) = self.kept.first_mut() {
            kept.mean_velocity.reserve(size.v);
        }
    }

    /// Makes room for so many phases.
    pub(crate) fn reserve_more(&mut self, phases: usize, contacts: usize, size: Size) {
        while self.kept.len() < phases {
            self.kept.push(Kept::new());
        }
        self.reserve(contacts, size);
    }

    /// Begins a step.
    #[inline]
    pub(crate) fn begin(&mut self, span: StepSpan) {
        self.used = 0;
        self.span = span;
    }

    pub(crate) fn has_any(&self) -> bool {
        self.used > 0
    }

    /// Takes a phase in; the contacts of `stage` go over to it. `now` are the energies at its end, without those of contacts; `None` where
    /// no account is kept.
    #[inline(always)]
    pub(crate) fn enter(
        &mut self,
        model: &Model<D>,
        phase: &PhaseEnd<'_>,
        stage: Option<&mut ContactStage<D>>,
        now: Option<Energy>,
    ) {
        if self.kept.len() == self.used {
            self.kept.push(Kept::new());
        }
        let (before, rest) = self.kept.split_at_mut(self.used);
        let kept = &mut rest[0];
        self.used += 1;
        kept.start = before.last().map_or(self.span.start, |before| before.end);
        kept.is_last_lasting = phase.kind != PhaseKind::Impact;
        if kept.is_last_lasting {
            before.iter_mut().for_each(|before| before.is_last_lasting = false);
        }
        (kept.kind, kept.end, kept.balance, kept.outcome) = (phase.kind, phase.end, phase.balance, phase.outcome);
        kept.duration = phase.duration;
        (kept.energy, kept.stored, kept.largest_slip_work) = (phase.energy, 0.0, f64::NEG_INFINITY);
        kept.now = now.unwrap_or_default();
        copy(phase.q, &mut kept.q);
        copy(phase.v, &mut kept.v);
        copy(phase.mean.unwrap_or_default(), &mut kept.mean);
        copy(phase.mean_velocity.unwrap_or_default(), &mut kept.mean_velocity);
        kept.contacts.clear();
        if let Some(stage) = stage {
            stage.hand_over(&mut kept.contacts);
        }
        if now.is_some() {
            kept.account_for_contacts(model, phase.knows_contacts);
        }
    }
}

#[inline(always)]
fn copy(from: &[f64], to: &mut Vec<f64>) {
    if from.len() == to.len() {
        to.copy_from_slice(from);
    } else {
        to.clear();
        to.extend_from_slice(from);
    }
}

impl<const D: usize> Kept<D> {
    /// The work of contacts, Σ Ū·p with Ū the mean velocity of the phase, and what their springs hold.
    #[inline]
    fn account_for_contacts(&mut self, model: &Model<D>, work_is_known: bool) {
        let weight = self.balance.weight();
        for contact in &self.contacts {
            if !work_is_known {
                let mean = contact.u_after * weight + contact.u_before * (1.0 - weight);
                self.energy.contact += mean[0] * contact.p[0];
                self.energy.friction += tangential(&mean).dot(&contact.p);
            }
            let slip = tangential(&contact.u_law).dot(&contact.p);
            self.largest_slip_work = self.largest_slip_work.max(slip);
            if let Some(gap) = contact.gap_after
                && let Some(spring) = model.spring(contact.law)
            {
                self.stored += spring.potential(gap);
            }
        }
    }
}

impl<const D: usize> Phases<D> {
    /// Enters the phases into the state's account, and moves places and velocities to the end of the last.
    #[inline(always)]
    pub(crate) fn settle(&mut self, state: &mut State, account: bool) {
        for kept in &mut self.kept[..self.used] {
            if account {
                if kept.kind == PhaseKind::Impact {
                    // Contacts with duration take no part in it, and hold what they held.
                    kept.stored = state.ledger.stored;
                }
                kept.energy.contact += kept.stored - state.ledger.stored;
                state.ledger.stored = kept.stored;
                let largest = &mut state.ledger.largest_tangential_work;
                *largest = largest.max(kept.largest_slip_work);
                kept.now.elastic += kept.stored;
                state.ledger.enter(kept.now, &mut kept.energy);
            }
        }
        if let Some(last) = self.kept[..self.used].last() {
            // What the step started from is kept for the report.
            for (start, now, end) in [(&mut self.q, &mut state.q, &last.q), (&mut self.v, &mut state.v, &last.v)] {
                std::mem::swap(start, now);
                copy(end, now);
            }
        }
    }

    /// The contacts of all phases.
    pub(crate) fn contacts(&self) -> impl Iterator<Item = &Contact<D>> {
        self.kept[..self.used].iter().flat_map(|kept| &kept.contacts)
    }

    /// The contacts of the last phase.
    #[inline(always)]
    pub(crate) fn last_contacts(&self) -> &[Contact<D>] {
        self.kept[..self.used].last().map_or(&[], |kept| &kept.contacts)
    }

    /// The contacts with duration whose springs an impact at the end of the step has left as they were.
    pub(crate) fn springs_before_impact(&self) -> impl Iterator<Item = &Contact<D>> {
        let phases = &self.kept[..self.used];
        let ends_with_impact = phases.last().is_some_and(|kept| kept.kind == PhaseKind::Impact);
        let before = phases.iter().rev().find(|kept| kept.kind != PhaseKind::Impact).filter(|_| ends_with_impact);
        let contacts = before.map_or([].as_slice(), |kept| kept.contacts.as_slice());
        contacts.iter().filter(|contact| contact.gap_after.is_some_and(|gap| gap < 0.0))
    }

    /// How the contact problems of the phases were solved.
    #[inline]
    pub(crate) fn outcomes(&self) -> impl Iterator<Item = &Outcome> {
        self.kept[..self.used].iter().filter_map(|kept| kept.outcome.as_ref())
    }

    /// As [`StepReport::outcome`].
    #[inline]
    pub(crate) fn outcome(&self) -> Option<Outcome> {
        match &self.kept[..self.used] {
            [only] => only.outcome,
            several => {
                let outcomes = || several.iter().filter_map(|kept| kept.outcome);
                outcomes().find(|outcome| !outcome.converged()).or_else(|| outcomes().next_back())
            }
        }
    }

    /// The contacts of the phase that has most.
    #[inline(always)]
    pub(crate) fn most_contacts(&self) -> usize {
        self.kept[..self.used].iter().map(|kept| kept.contacts.len()).max().unwrap_or(0)
    }

    /// Phase `k` of those that were ended.
    #[inline]
    fn phase(&self, k: usize) -> Phase<'_, D> {
        let Self { kept, q, v, span, .. } = self;
        let (q, v) = match k.checked_sub(1).map(|before| &kept[before]) {
            Some(before) => (before.q.as_slice(), before.v.as_slice()),
            None => (q.as_slice(), v.as_slice()),
        };
        let own = &kept[k];
        Phase {
            kind: own.kind,
            start: own.start,
            end: own.end,
            duration: own.duration(span),
            balance: own.balance,
            contacts: &own.contacts,
            outcome: own.outcome,
            energy: own.energy,
            q: [q, own.q.as_slice()],
            v: [v, own.v.as_slice()],
            mean: (!own.mean.is_empty()).then_some(own.mean.as_slice()),
            mean_velocity: (!own.mean_velocity.is_empty()).then_some(own.mean_velocity.as_slice()),
        }
    }

    #[inline]
    pub(crate) fn report(&self, step: u64, penetration: f64) -> StepReport<'_, D> {
        StepReport { step, t_start: self.span.start, t_end: self.span.end, h: self.span.h, penetration, phases: self }
    }
}

/// A phase of a step, as observers see it.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Phase<'w, const D: usize> {
    /// What happened in it.
    pub kind: PhaseKind,
    /// Its start, s.
    pub start: f64,
    /// Its end, s; that is its start for an impact.
    pub end: f64,
    /// How long it took, s: of a step's only phase the size of the step, without the rounding of times.
    pub duration: f64,
    /// By which means it satisfies the balance of momentum.
    pub balance: Balance,
    /// The contacts that were active in it, in order of identity.
    pub contacts: &'w [Contact<D>],
    /// How their problem was solved; `None` without contacts.
    pub outcome: Option<Outcome>,
    /// Its energy account.
    pub energy: StepEnergy,
    /// Coordinates at its start and at its end.
    pub q: [&'w [f64]; 2],
    /// Velocities at its start and at its end.
    pub v: [&'w [f64]; 2],
    /// q̄, the mean of the coordinates over it, where the scheme knows it.
    pub mean: Option<&'w [f64]>,
    /// v̄, the mean of the velocities over it, where the scheme knows it.
    pub mean_velocity: Option<&'w [f64]>,
}

/// The contacts that were active in a phase.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Active<'w, const D: usize> {
    /// What happened in it.
    pub kind: PhaseKind,
    /// Its start, s.
    pub start: f64,
    /// Its end, s.
    pub end: f64,
    /// How long it took, s: of a step's only phase the size of the step, without the rounding of times.
    pub duration: f64,
    /// By which means it satisfies the balance of momentum.
    pub balance: Balance,
    /// Whether it is the [last that takes time](StepReport::last_lasting).
    pub is_last_lasting: bool,
    /// The contacts, in order of identity.
    pub contacts: &'w [Contact<D>],
}

/// What happened in a step.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct StepReport<'w, const D: usize> {
    /// Number of the step, from 1.
    pub step: u64,
    /// Its start, s.
    pub t_start: f64,
    /// Its end, s.
    pub t_end: f64,
    /// Its size, s.
    pub h: f64,
    /// Deepest penetration of a contact's point at its end, m; 0 if there is none, or nobody [asked](crate::Account).
    pub penetration: f64,
    phases: &'w Phases<D>,
}

impl<'w, const D: usize> StepReport<'w, D> {
    /// Its phases, in order of time.
    #[inline]
    pub fn phases(&self) -> impl DoubleEndedIterator<Item = Phase<'w, D>> + use<'w, D> {
        let phases = self.phases;
        (0..phases.used).map(move |k| phases.phase(k))
    }

    /// Its last phase that takes time; `None` for a step that is impacts only.
    #[inline]
    #[must_use]
    pub fn last_lasting(&self) -> Option<Phase<'w, D>> {
        let Phases { kept, used, .. } = self.phases;
        Some(self.phases.phase(kept[..*used].iter().position(|kept| kept.is_last_lasting)?))
    }

    /// When its contacts were active, phase by phase, without the rest of these.
    #[inline]
    pub fn active(&self) -> impl Iterator<Item = Active<'w, D>> + use<'w, D> {
        let Phases { kept, used, span, .. } = self.phases;
        kept[..*used].iter().map(move |kept| {
            let Kept { kind, start, end, is_last_lasting, balance, ref contacts, .. } = *kept;
            Active { kind, start, end, duration: kept.duration(span), balance, is_last_lasting, contacts }
        })
    }

    /// Whether all of its contact problems were solved.
    #[inline]
    #[must_use]
    pub fn is_solved(&self) -> bool {
        self.phases.outcomes().all(Outcome::converged)
    }

    /// The contacts of all phases: a contact that was active in several comes several times.
    pub fn contacts(&self) -> impl Iterator<Item = &'w Contact<D>> + use<'w, D> {
        let Phases { kept, used, .. } = self.phases;
        kept[..*used].iter().flat_map(|kept| &kept.contacts)
    }

    /// How its contact problems were solved: that of the last phase which has one, or the first that was not solved; `None` without
    /// contacts.
    #[must_use]
    pub fn outcome(&self) -> Option<Outcome> {
        self.phases.outcome()
    }

    /// Its energy account: that of its phases, added up.
    #[must_use]
    pub fn energy(&self) -> StepEnergy {
        let Phases { kept, used, .. } = self.phases;
        let mut sum = StepEnergy::default();
        match &kept[..*used] {
            [only] => return only.energy,
            several => several.iter().for_each(|kept| sum.add(&kept.energy)),
        }
        sum
    }

    /// Writes places and velocities at a time within the step (s) into `q` and `v`; whether it could: not outside the step, nor for
    /// slices of another length. Within a [`PhaseKind::Step`] coordinates move with the mean velocity and velocities change evenly, as the scheme has them;
    /// within a smooth phase coordinates are the cubic with the places and velocities of its ends. At an impact it is the state after it.
    #[must_use]
    pub fn sample(&self, t: f64, q: &mut [f64], v: &mut [f64]) -> bool {
        let lengths = q.len() == self.phases.q.len() && v.len() == self.phases.v.len();
        if !(lengths && (self.t_start..=self.t_end).contains(&t)) {
            return false;
        }
        let at_end = |phase: &Phase<'_, D>| phase.end <= t;
        let Some(phase) = self.phases().find(|phase| !at_end(phase)).or_else(|| self.phases().last()) else {
            return false;
        };
        let tau = phase.end - phase.start;
        let s = if tau > 0.0 { ((t - phase.start) / tau).clamp(0.0, 1.0) } else { 1.0 };
        let between = |[a, b]: [f64; 2]| if s < 1.0 { a + s * (b - a) } else { b };
        let pairs = |x: [&'w [f64]; 2]| x[0].iter().zip(x[1]).map(|(a, b)| [*a, *b]);
        v.iter_mut().zip(pairs(phase.v)).for_each(|(v, ends)| *v = between(ends));
        // Without as many velocities as coordinates there are no slopes.
        if phase.kind != PhaseKind::Smooth || q.len() != v.len() || s == 1.0 {
            q.iter_mut().zip(pairs(phase.q)).for_each(|(q, ends)| *q = between(ends));
            return true;
        }
        let (r, s2) = (1.0 - s, s * s);
        for ((q, [q0, q1]), [v0, v1]) in q.iter_mut().zip(pairs(phase.q)).zip(pairs(phase.v)) {
            let ends = (1.0 + 2.0 * s) * r * r * q0 + s2 * (3.0 - 2.0 * s) * q1;
            *q = ends + tau * (s * r * r * v0 - s2 * r * v1);
        }
        true
    }
}
