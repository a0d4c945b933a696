//! Output of section forces and reactions of beams.

/// A quantity of a beam for output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum BeamQuantity {
    /// Deflection w at the probes, m.
    Deflection,
    /// Bending moment at the probes, N·m.
    Moment,
    /// Transverse force at the probes, N.
    Shear,
    /// Largest normal stress of the section at the probes, Pa.
    Stress,
    /// Axial force, N.
    AxialForce,
}

/// Their words in scenes and in names of columns.
pub const BEAM_QUANTITIES: &[&str] = &["w", "moment", "shear", "stress", "axial_force"];

impl BeamQuantity {
    /// All of them, in the order of [`BEAM_QUANTITIES`].
    pub const ALL: [Self; 5] = [Self::Deflection, Self::Moment, Self::Shear, Self::Stress, Self::AxialForce];

    /// Its word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Deflection => "w",
            Self::Moment => "moment",
            Self::Shear => "shear",
            Self::Stress => "stress",
            Self::AxialForce => "axial_force",
        }
    }

    /// The quantity with this word.
    #[must_use]
    pub fn of(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|quantity| quantity.word() == word)
    }
}

/// The output of a beam.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BeamOutput {
    /// The quantities, in the order of their columns.
    pub quantities: Vec<BeamQuantity>,
    /// Whether the reactions of supports are written.
    pub reactions: bool,
    /// Whether the extremes over all steps are written.
    pub envelope: bool,
}

impl Default for BeamOutput {
    fn default() -> Self {
        Self { quantities: vec![BeamQuantity::Deflection], reactions: false, envelope: false }
    }
}

impl BeamOutput {
    /// Whether any of it needs the section forces of every step.
    #[must_use]
    pub fn needs_forces(&self) -> bool {
        self.reactions || self.envelope || self.quantities.iter().any(|quantity| *quantity != BeamQuantity::Deflection)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_has_its_quantity() {
        assert_eq!(BEAM_QUANTITIES, BeamQuantity::ALL.map(BeamQuantity::word));
        assert!(BeamQuantity::ALL.into_iter().all(|quantity| BeamQuantity::of(quantity.word()) == Some(quantity)));
    }
}
