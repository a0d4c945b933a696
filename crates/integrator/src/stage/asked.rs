//! What is asked of contacts: over what time, by which rule, and where they are looked for.

use crate::contact::{Contact, tangential};
use crate::laws::is_impact;
use crate::{ImpactLaw, PairLaw, SpringStep, Vector};

/// What velocities and impulses of a stage are of.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Over {
    /// A step of size h (s), its mean velocity with the weight w of the end: by it laws know the work of their impulses.
    Step {
        /// h, s.
        h: f64,
        /// w, θ of a θ step.
        weight: f64,
    },
    /// An instant: velocities jump. Restitution is that of an impact; laws with duration have no meaning.
    Instant,
    /// Forces and accelerations in place of impulses and velocities: 0 ≤ a_n ⊥ f_n ≥ 0, and Coulomb's law on accelerations. There is no
    /// restitution; laws with duration have no meaning.
    Acceleration,
}

/// How a contact answers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Rule<const D: usize> {
    /// Nobody has said yet; a stage with such a contact is not solved.
    Unposed,
    /// Signorini's and Coulomb's law on U¹ + s.
    Shifted,
    /// Signorini's law on U¹ + s alone, as in a projection.
    Frictionless,
    /// Signorini's law on U¹ + s, with friction −μ p_n d: of a contact that slides in the direction d (a unit vector without normal part),
    /// whatever its velocity becomes.
    SlidesAlong(Vector<D>),
    /// In two phases by Poisson's law; the coefficients of restitution act in the second.
    Poisson {
        /// The part of the impulse of compression that is given back.
        e: f64,
        /// The tangential coefficient of restitution.
        tangential: f64,
    },
    /// As shifted, with the normal shift made smaller where the impact would make energy.
    Energetic,
    /// By a force law over the step.
    Spring(SpringStep),
}

/// Where contacts are looked for.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Look<'a> {
    /// Coordinates at which gaps and rows are taken.
    pub at: &'a [f64],
    /// Largest gap there of a contact that takes part, m.
    pub within: f64,
    /// Where the motion without contacts ends: contacts with duration take part if that is inside their surface. Without it, `at` stands
    /// for it.
    pub free: Option<&'a [f64]>,
}

impl<'a> Look<'a> {
    /// At these coordinates, for contacts with a gap of at most `within` (m).
    #[must_use]
    pub fn new(at: &'a [f64], within: f64) -> Self {
        Self { at, within, free: None }
    }

    /// With the end of the motion without contacts, for those with duration.
    #[must_use]
    pub fn with_free_end(mut self, q: &'a [f64]) -> Self {
        self.free = Some(q);
        self
    }
}

/// The part of the tangential velocity that comes back: of a contact that approaches.
#[inline]
fn tangential_restitution<const D: usize>(law: &PairLaw, contact: &Contact<D>, u_before: &Vector<D>) -> f64 {
    if !contact.persisting && u_before[0] < 0.0 { law.tangential_restitution } else { 0.0 }
}

/// The shift of a contact by Newton's law.
#[inline]
pub(super) fn newton_shift<const D: usize>(law: &PairLaw, contact: &Contact<D>, u_before: &Vector<D>) -> Vector<D> {
    let mut shift = tangential(u_before) * tangential_restitution(law, contact, u_before);
    shift[0] = law.restitution * u_before[0].min(0.0);
    shift
}

/// Shift and rule of a contact by an impact law.
pub(super) fn by_law<const D: usize>(
    law: &PairLaw,
    contact: &Contact<D>,
    u_before: &Vector<D>,
    u_free: &Vector<D>,
) -> (Vector<D>, Rule<D>) {
    let (e, tangential_e) = (law.restitution, tangential_restitution(law, contact, u_before));
    match law.impact {
        ImpactLaw::Newton => (newton_shift(law, contact, u_before), Rule::Shifted),
        ImpactLaw::Poisson => (Vector::zeros(), Rule::Poisson { e, tangential: tangential_e }),
        ImpactLaw::Energetic => {
            let mut shift = tangential(u_before) * tangential_e;
            shift[0] = if is_impact(e, u_before, u_free) { e * u_before[0] } else { 0.0 };
            (shift, Rule::Energetic)
        }
        ImpactLaw::KelvinVoigt { .. } | ImpactLaw::HuntCrossley { .. } => (Vector::zeros(), Rule::Shifted),
    }
}
