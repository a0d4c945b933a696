//! Resolves steps, their number and stability, and rows of output.

use super::Resolver;
use super::blocks::BlockShape;
use crate::output_size::OutputSize;
use crate::scene::{BeamScene, ContactScene, Crowd, Scene, SchemeName, StopScene, SupportingBody, Time};
use crate::wording;
use crate::words::{SchemeChoice, StopWord, Word};
use teeter_integrator::{GeneralizedAlphaSettings, PairLaw};
use teeter_text::readable;

/// Most steps of a run.
pub const MAX_STEPS: f64 = 1e12;

/// A gap tolerance over the first fraction of the shortest side of a block is refused; one over the
/// second gives a warning.
const MOST_GAP: f64 = 1e-3;
const DOUBTFUL_GAP: f64 = 1e-6;

/// Number of steps of a run whose step has not been found yet.
const STEPS_TO_GO_ON: f64 = 10_000.0;

/// Smallest error that can be requested.
const LEAST_ACCURACY: f64 = 1e-9;

/// With up to this many blocks that aren't fixed their impacts are located one by one.
const FEW_BLOCKS: usize = 8;

/// Most bytes of the tables of a run.
const MAX_BYTES: f64 = 10e9;

impl Resolver<'_, '_> {
    pub(super) fn time(&mut self, blocks: &[Option<BlockShape>], beams: &[Option<BeamScene>]) -> Option<Time> {
        let end = self.quantity("time.end");
        let errors = self.errors.len();
        let accuracy = self.accuracy();
        let step = match (accuracy, end) {
            (Some(_), Some(end)) => Some(end / STEPS_TO_GO_ON),
            // Without an accuracy that can be used there is no step either, which has been said.
            _ if self.errors.len() > errors && !self.doc.has("time.step") => None,
            _ => self.quantity("time.step"),
        };
        let theta = self.number("time.theta");
        if let Some(theta) = theta {
            self.check_stability(theta, beams);
        }
        let scheme = self.scheme(blocks.len(), beams, theta);
        let spectral_radius = self.spectral_radius(scheme);
        let activation_gamma = self.number("time.activation_gamma");
        let gap_tolerance = self.gap_tolerance(blocks);
        let (end, step) = (end?, step?);
        if step > end {
            self.error(
                "time.step",
                format!("longer than the whole run of {end} s"),
                "use a step much shorter than time.end",
            );
            return None;
        }
        let steps = end / step;
        if steps > MAX_STEPS {
            let rule = format!(
                "{steps:.1e} steps to {end} s, over the limit of {MAX_STEPS:.0e}; at 1 µs each they would take {}",
                wording::duration(steps * 1e-6)
            );
            self.error("time.step", rule, "use a longer step or an earlier end");
            return None;
        }
        let time = Time {
            end,
            step,
            accuracy,
            scheme: scheme?,
            theta: theta?,
            activation_gamma: activation_gamma?,
            gap_tolerance,
            spectral_radius,
            stop: self.stop(),
        };
        let steps = time.steps() as f64;
        if (steps * step - end).abs() > (1e-9 * end).min(1e-3 * step) {
            let rule = format!("not a whole number of steps of {step} s: the run continues to {} s", steps * step);
            self.warnings
                .push(self.doc.error("time.end", rule, "choose an end that is a multiple of the step").as_warning());
        }
        Some(time)
    }

    /// What ends the run before its end.
    fn stop(&self) -> StopScene {
        let mut stop = StopScene::default();
        for word in self.doc.words("time.stop").unwrap_or_default() {
            match StopWord::of(word) {
                Some(StopWord::Overturned) => stop.overturned = true,
                Some(StopWord::Rest) => stop.rest = true,
                Some(StopWord::Sunk) => stop.sunk = true,
                None => {}
            }
        }
        stop
    }

    /// The scheme, checked against θ and the beams.
    fn scheme(&mut self, blocks: usize, beams: &[Option<BeamScene>], theta: Option<f64>) -> Option<SchemeName> {
        let scheme = self.choice::<SchemeChoice>("time.scheme").map(|choice| match choice {
            SchemeChoice::Named(scheme) => scheme,
            SchemeChoice::Auto => self.automatic_scheme(blocks, beams),
        });
        let held = beams.iter().flatten().find(|beam| beam.spec.axial == teeter_beam::Axial::Held);
        if let (Some(beam), Some(scheme)) = (held, scheme.filter(|scheme| !scheme.takes_held_beams())) {
            let rule = format!(
                "the beam `{}` is held along its axis, so its stiffness changes with its motion, but {} {}",
                beam.name,
                scheme.word(),
                if scheme == SchemeName::GeneralizedAlpha { "needs linear forces" } else { "needs constant modes" }
            );
            self.error("time.scheme", rule, "use scheme = \"moreau-jean-closed\", or axial = free");
        }
        if let (Some(scheme), Some(theta)) = (scheme, theta)
            && scheme.is_trapezoidal()
            && theta != 0.5
        {
            let rule = format!("{} requires theta = 0.5", scheme.word());
            self.error("time.theta", rule, "leave theta out, or use scheme = \"moreau-jean\"");
        }
        if let (Some(beam), Some(theta)) = (held, theta)
            && theta != 0.5
        {
            let rule =
                format!("the beam `{}` is held along its axis, and only theta = 0.5 conserves its energy", beam.name);
            self.error("time.theta", rule, "leave theta out, or use axial = free");
        }
        scheme
    }

    /// ρ∞, which only one scheme has.
    fn spectral_radius(&mut self, scheme: Option<SchemeName>) -> f64 {
        let given = self.doc.number("time.spectral_radius");
        if let (Some(scheme), true) = (scheme, self.doc.is_given("time.spectral_radius"))
            && scheme != SchemeName::GeneralizedAlpha
        {
            let rule = format!("it is a setting of generalized-alpha, not of {}", scheme.word());
            self.error("time.spectral_radius", rule, "leave it out, or use scheme = \"generalized-alpha\"");
        }
        given.unwrap_or(GeneralizedAlphaSettings::default().spectral_radius)
    }

    /// The accuracy given instead of a step.
    fn accuracy(&mut self) -> Option<f64> {
        let accuracy = self.doc.number("time.accuracy");
        match accuracy {
            Some(_) if self.doc.has("time.step") => {
                let rule = "a step is given too, but the step follows from the accuracy";
                self.error("time.accuracy", rule, "leave one of them out, or write step = \"auto\"");
                None
            }
            Some(given) if given < LEAST_ACCURACY => {
                let rule = format!(
                    "{given:e} is below {LEAST_ACCURACY:e}, which no step reaches because of rounding and the tolerance of contacts"
                );
                self.error("time.accuracy", rule, "use 1e-3 or 1e-6, or give a step");
                None
            }
            None if !self.doc.has("time.step")
                && !self.doc.is_refused("time.step")
                && !self.doc.is_refused("time.accuracy")
                && self.doc.has("time.end") =>
            {
                let rule = "auto needs an accuracy";
                self.error("time.step", rule, "add accuracy = 1e-3, or give a step, such as \"100 us\"");
                None
            }
            accuracy => accuracy,
        }
    }

    /// Refuses contacts that the scheme doesn't support: compliant ones, or with restitution at a
    /// beam.
    pub(super) fn check_contact_laws(
        &mut self,
        scheme: SchemeName,
        contacts: &[Option<ContactScene>],
        crowd: Option<&Crowd>,
        beams: &[Option<BeamScene>],
    ) {
        let listed = contacts.iter().flatten().map(|contact| (&contact.name, &contact.law));
        let of_crowd = crowd.into_iter().flat_map(Crowd::contacts).map(|contact| (&contact.name, &contact.law));
        let has_duration = |(_, law): &(&String, &PairLaw)| law.impact.has_duration();
        let compliant = listed.chain(of_crowd).find(has_duration);
        if let Some((name, _)) = compliant.filter(|_| !scheme.takes_springs()) {
            let rule = format!("{} doesn't support compliant contacts, such as `{name}`", scheme.word());
            self.error("time.scheme", rule, "use scheme = \"moreau-jean-located\", or law = \"newton\"");
        }
        if !scheme.holds_beams() || contacts.iter().any(Option::is_none) {
            return;
        }
        let at_beam = |contact: &&ContactScene| matches!(contact.surface, SupportingBody::Beam(_));
        if !contacts.iter().flatten().any(|contact| at_beam(&contact)) {
            let rule = format!("{} is for contact with beams, but the scene has none", scheme.word());
            self.error("time.scheme", rule, "use scheme = \"moreau-jean-located\", or leave it out");
        }
        if let Some(beam) = beams.iter().flatten().find(|beam| beam.motion.is_given()) {
            let rule = format!("{} doesn't support beams on moving supports, such as `{}`", scheme.word(), beam.name);
            self.error("time.scheme", rule, "use scheme = \"moreau-jean-located\", or leave it out");
        }
        if let Some(contact) = contacts.iter().flatten().filter(at_beam).find(|contact| contact.gives_back()) {
            let rule = format!(
                "{} doesn't support restitution or compliant laws at a beam, as in `{}`: contact there is a force, and the rebound comes from the beam's own elasticity",
                scheme.word(),
                contact.name
            );
            self.error("time.scheme", rule, "use scheme = \"moreau-jean-located\", or law = \"newton\" with restitution and tangential_restitution 0");
        }
    }

    /// The scheme for `auto`: the most accurate one (`docs/schemes.md`), unless keys of another are
    /// given. With many blocks that move there are too many impacts in a step to locate, and on held beams
    /// locating them has been measured in one scene only; without blocks all are equivalent.
    fn automatic_scheme(&self, blocks: usize, beams: &[Option<BeamScene>]) -> SchemeName {
        let held = beams.iter().flatten().any(|beam| beam.spec.axial == teeter_beam::Axial::Held);
        let own = ["time.theta", "time.gap_tolerance", "time.activation_gamma"];
        let moving = (0..blocks).filter(|&block| !self.is_fixed(SupportingBody::Block(block))).count();
        if blocks == 0 || own.iter().any(|key| self.doc.is_given(key)) {
            SchemeName::MoreauJean
        } else if held || moving > FEW_BLOCKS {
            SchemeName::MoreauJeanClosed
        } else {
            SchemeName::MoreauJeanLocated
        }
    }

    /// The gap below which a contact counts as closed, m: the given one, if it is small relative to
    /// the blocks.
    fn gap_tolerance(&mut self, blocks: &[Option<BlockShape>]) -> f64 {
        let Some(given) = self.doc.quantity("time.gap_tolerance") else { return gap_tolerance(blocks) };
        let shortest = sides(blocks).map(|[width, height]| width.min(height)).fold(f64::INFINITY, f64::min);
        let part = given / shortest;
        // Compared as products, so that the default for a thin block passes.
        if given > DOUBTFUL_GAP * shortest {
            let rule = format!(
                "{} of the shortest side of a block, {shortest} m: blocks may float that far above their support",
                readable::shortest(part, 2)
            );
            let most = |part: f64| format!("use at most {:.0e} m, or leave it out", part * shortest);
            if given > MOST_GAP * shortest {
                self.error("time.gap_tolerance", rule, most(MOST_GAP));
            } else {
                self.warnings.push(self.doc.error("time.gap_tolerance", rule, most(DOUBTFUL_GAP)).as_warning());
            }
        }
        given
    }

    /// θ < ½ is allowed only on request; the largest stable step is given in both cases.
    fn check_stability(&mut self, theta: f64, beams: &[Option<BeamScene>]) {
        if theta >= 0.5 {
            return;
        }
        let limit = beams
            .iter()
            .flatten()
            .map(|beam| crate::stable_step::largest_stable_step(&beam.spec, theta))
            .fold(f64::INFINITY, f64::min);
        let rule = if limit == f64::INFINITY {
            "below 0.5 the scheme is not unconditionally stable".to_owned()
        } else if limit > 0.0 {
            format!("below 0.5 the scheme is stable only for steps up to {} on this mesh", wording::seconds(limit, 4))
        } else {
            "below 0.5 the undamped modes of the beam grow at every step size".to_owned()
        };
        if self.doc.flag("time.allow_conditional_stability") == Some(true) {
            self.warnings.push(
                self.doc.error("time.theta", rule, "use 0.5, which conserves energy and is always stable").as_warning(),
            );
        } else {
            self.error("time.theta", rule, "use theta of at least 0.5, or set allow_conditional_stability = true");
        }
    }

    /// Refuses excessively large tables.
    pub(super) fn output(&mut self, scene: &Scene) {
        let OutputSize { rows, bytes } = OutputSize::of(scene);
        if bytes > MAX_BYTES {
            let rule = format!(
                "{rows:.1e} rows would take about {}, over the limit of {}",
                wording::bytes(bytes),
                wording::bytes(MAX_BYTES)
            );
            self.error("output.every", rule, "write fewer rows, or leave the key out for some 10 000");
        }
    }
}

/// The default gap tolerance: 1e-12 m, scaled for blocks outside [0.01, 1] m; less for a block so
/// thin that this would give a warning.
fn gap_tolerance(blocks: &[Option<BlockShape>]) -> f64 {
    let largest = sides(blocks).map(|[width, height]| width.max(height)).fold(0.0, f64::max);
    let shortest = sides(blocks).map(|[width, height]| width.min(height)).fold(f64::INFINITY, f64::min);
    let usual = if largest == 0.0 || (0.01..=1.0).contains(&largest) { 1e-12 } else { 1e-11 * largest };
    usual.min(DOUBTFUL_GAP * shortest)
}

/// Width and height of the blocks, m.
fn sides(blocks: &[Option<BlockShape>]) -> impl Iterator<Item = [f64; 2]> {
    blocks.iter().flatten().map(|block| block.extents)
}
