//! The contact law of a pair of bodies: friction, and what happens along the normal
//! (`docs/laws.md`).

/// The contact law of a pair of bodies.
///
/// ```
/// use teeter_integrator::{ImpactLaw, PairLaw};
///
/// let law = PairLaw::new(0.5, 0.8).with_impact(ImpactLaw::Poisson);
/// assert_eq!((law.friction, law.restitution), (0.5, 0.8));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct PairLaw {
    /// Coulomb's coefficient μ ≥ 0.
    pub friction: f64,
    /// Coefficient of restitution e in [0, 1]; unused by a law with duration.
    pub restitution: f64,
    /// Tangential coefficient of restitution in [0, 1]: the fraction of the tangential velocity
    /// that is reversed in an impact that doesn't slide.
    pub tangential_restitution: f64,
    /// What happens along the normal.
    pub impact: ImpactLaw,
}

/// What happens along the normal of a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum ImpactLaw {
    /// Instantaneous; e is the ratio of the normal velocities after and before.
    #[default]
    Newton,
    /// Instantaneous, in two phases; e is the ratio of the normal impulses of expansion and
    /// compression.
    Poisson,
    /// Newton's law with e reduced as far as is needed for the impact not to create energy, by the
    /// same factor for all contacts that are coupled.
    Energetic,
    /// A contact with duration: force k δ + c δ̇ while the penetration δ > 0, never tensile.
    KelvinVoigt {
        /// k, N/m.
        stiffness: f64,
        /// c, N·s/m.
        damping: f64,
    },
    /// A contact with duration: force k δⁿ (1 + d δ̇) for a penetration δ > 0, never tensile (Hunt
    /// & Crossley 1975, doi 10.1115/1.3423596).
    HuntCrossley {
        /// k, N/mⁿ.
        stiffness: f64,
        /// d, s/m.
        damping: f64,
        /// n ≥ 1.
        exponent: f64,
    },
}

impl PairLaw {
    /// Newton's law with Coulomb's coefficient `friction` and this coefficient of restitution.
    #[must_use]
    pub const fn new(friction: f64, restitution: f64) -> Self {
        Self { friction, restitution, tangential_restitution: 0.0, impact: ImpactLaw::Newton }
    }

    /// The same with another law along the normal.
    #[must_use]
    pub fn with_impact(mut self, impact: ImpactLaw) -> Self {
        self.impact = impact;
        self
    }

    /// The same with a tangential coefficient of restitution.
    #[must_use]
    pub fn with_tangential_restitution(mut self, e: f64) -> Self {
        self.tangential_restitution = e;
        self
    }

    /// The first coefficient out of its range, its value, and the range.
    pub(crate) fn check(&self) -> Result<(), (&'static str, f64, &'static str)> {
        let check = |what, value, good, rule| if good { Ok(()) } else { Err((what, value, rule)) };
        let not_negative = |what, x: f64| check(what, x, x >= 0.0 && x.is_finite(), "at least 0 and finite");
        let positive = |what, x: f64| check(what, x, x > 0.0 && x.is_finite(), "greater than 0 and finite");
        not_negative("the friction coefficient", self.friction)?;
        let unit = |what, e: f64| check(what, e, (0.0..=1.0).contains(&e), "in [0, 1]");
        unit("the coefficient of restitution", self.restitution)?;
        unit("the tangential coefficient of restitution", self.tangential_restitution)?;
        match self.impact {
            ImpactLaw::Newton | ImpactLaw::Poisson | ImpactLaw::Energetic => Ok(()),
            ImpactLaw::KelvinVoigt { stiffness, damping } => {
                positive("the contact stiffness", stiffness)?;
                not_negative("the contact damping", damping)
            }
            ImpactLaw::HuntCrossley { stiffness, damping, exponent } => {
                positive("the contact stiffness", stiffness)?;
                not_negative("the contact damping", damping)?;
                check("the exponent", exponent, (1.0..=10.0).contains(&exponent), "in [1, 10]")
            }
        }
    }
}
