//! The rungs of the ladder, one file each.

mod assemblages;
mod bar_impact;
mod beam_buckling;
mod beam_damping;
mod beam_energy;
mod beam_frequencies;
mod beam_ledger;
mod beam_membrane;
mod beam_moving_force;
mod beam_spectrum;
mod beam_statics;
mod beam_supports;
mod beam_winkler;
mod bounce;
mod bouncing;
mod compliant;
mod convex_law;
mod discs;
mod dominoes;
mod energy_identity;
mod housner_order;
mod impact_laws;
mod incline;
mod limit_analysis;
mod moving_ground;
mod overturning;
mod resting;
mod section_forces;
mod sliding;
mod static_start;

use crate::case::Case;

/// All cases, from the simplest up.
pub(crate) fn all() -> Vec<Box<dyn Case>> {
    vec![
        Box::new(beam_statics::BeamStatics),
        Box::new(beam_supports::BeamSupports),
        Box::new(beam_frequencies::BeamFrequencies),
        Box::new(beam_spectrum::BeamSpectrum),
        Box::new(beam_buckling::BeamBuckling),
        Box::new(beam_damping::BeamDamping),
        Box::new(beam_membrane::BeamMembrane),
        Box::new(beam_moving_force::BeamMovingForce),
        Box::new(bar_impact::BarImpact),
        Box::new(beam_winkler::BeamWinkler),
        Box::new(beam_energy::BeamEnergy),
        Box::new(beam_ledger::BeamLedger),
        Box::new(static_start::StaticStart),
        Box::new(section_forces::SectionForcesCase),
        Box::new(sliding::Sliding),
        Box::new(incline::Incline),
        Box::new(bounce::Bounce),
        Box::new(bouncing::Bouncing),
        Box::new(compliant::Compliant),
        Box::new(impact_laws::ImpactLaws),
        Box::new(convex_law::ConvexLaw),
        Box::new(housner_order::HousnerOrder),
        Box::new(energy_identity::EnergyIdentity),
        Box::new(resting::Resting),
        Box::new(moving_ground::MovingGround),
        Box::new(overturning::Overturning),
        Box::new(limit_analysis::LimitAnalysis),
        Box::new(discs::Discs),
        Box::new(dominoes::Dominoes),
        Box::new(assemblages::Assemblages),
    ]
}
