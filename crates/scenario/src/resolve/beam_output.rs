//! Resolves the output of section forces and reactions of beams.

use super::Resolver;
use crate::scene::{BeamOutput, BeamQuantity};
use teeter_beam::Section;

impl Resolver<'_, '_> {
    /// The output of the beam at `path`, which has these sections.
    pub(super) fn beam_output<'s>(
        &mut self,
        path: &str,
        mut sections: impl Iterator<Item = &'s Section>,
    ) -> Option<BeamOutput> {
        let at = |key: &str| format!("{path}.{key}");
        let words = self.doc.words(&at("record")).map(<[String]>::to_vec);
        let words = self.required(&at("record"), words)?;
        let output = BeamOutput {
            quantities: words.iter().filter_map(|word| BeamQuantity::of(word)).collect(),
            reactions: self.doc.flag(&at("reactions")).unwrap_or(false),
            envelope: self.doc.flag(&at("envelope")).unwrap_or(false),
        };
        let probed = output
            .quantities
            .iter()
            .find(|quantity| !matches!(quantity, BeamQuantity::Deflection | BeamQuantity::AxialForce));
        if let Some(quantity) = probed
            && self.doc.list(&at("probes")).is_none_or(<[f64]>::is_empty)
            && !self.doc.is_refused(&at("probes"))
        {
            let rule = format!("{} is written at probes, but the beam has none", quantity.word());
            self.error(&at("record"), rule, "add probes = [\"9 cm\"], positions along the beam");
        }
        if output.quantities.contains(&BeamQuantity::Stress)
            && sections.any(|section| section.section_modulus.is_none())
        {
            let rule = "a section given directly has no section modulus, and therefore no stress";
            self.error(&at("record"), rule, "use a profile, or leave stress out");
        }
        Some(output)
    }
}
