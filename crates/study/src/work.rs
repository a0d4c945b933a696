//! Counted work: what a run costs, by what it did and not by the clock, so that a choice made by it
//! is the same in every run.

use teeter_scenario::simulation::Simulation;

/// What a run did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Work {
    /// The time scheme.
    pub scheme: &'static str,
    /// Steps taken.
    pub steps: u64,
    /// Blocks.
    pub blocks: u64,
    /// Dofs of the beams that move in those of all their nodes.
    pub nodal_dofs: u64,
    /// Shapes of the beams that move in modes.
    pub shapes: u64,
    /// Beams.
    pub beams: u64,
    /// Contact problems solved.
    pub solves: u64,
    /// Contacts in them, added up.
    pub contacts: u64,
    /// Iterations, added up.
    pub iterations: u64,
}

/// The model of the cost: ns for each of what is counted, fitted once to the scenarios on the
/// machine of `benches/results`. Only ratios count in a choice; `tradeoff.csv` has the time that
/// was measured beside them.
mod cost {
    pub(super) const STEP: f64 = 60.0;
    pub(super) const BLOCK: f64 = 160.0;
    pub(super) const BEAM: f64 = 150.0;
    pub(super) const NODAL_DOF: f64 = 4.0;
    pub(super) const SHAPE: f64 = 4.0;
    pub(super) const SOLVE: f64 = 160.0;
    pub(super) const CONTACT: f64 = 140.0;
    pub(super) const CONTACT_BEAM: f64 = 100.0;
    pub(super) const CONTACT_NODAL_DOF: f64 = 0.5;
    pub(super) const CONTACT_SHAPE: f64 = 9.0;
    pub(super) const ITERATION: f64 = 10.0;

    /// Schemes that detect and try more often in a step than `moreau-jean`: their factor, 1 where
    /// nobody has measured it.
    pub(super) const SCHEMES: [(&str, f64); 6] = [
        ("moreau-jean-closed", 1.35),
        ("moreau-jean-located", 1.45),
        ("event-driven", 30.0),
        ("resolved", 5.0),
        ("moreau-jean-projected", 1.6),
        ("generalized-alpha", 2.3),
    ];
}

impl Work {
    /// What a simulation will do at least: its steps, without the contacts that nobody knows yet.
    #[must_use]
    pub fn expected(simulation: &Simulation) -> Self {
        let layout = &simulation.layout;
        let dofs = |in_modes: bool| {
            let beams = layout.beams.iter().filter(|beam| beam.basis.is_some() == in_modes);
            beams.map(|beam| beam.free_dofs() as u64).sum()
        };
        Self {
            scheme: simulation.scheme(),
            steps: simulation.plan.steps_from(&simulation.state),
            blocks: layout.blocks.len() as u64,
            nodal_dofs: dofs(false),
            shapes: dofs(true),
            beams: layout.beams.len() as u64,
            ..Self::default()
        }
    }

    /// What a simulation has done since it was made.
    pub(crate) fn of(simulation: &Simulation) -> Self {
        let counts = simulation.work_counts();
        Self {
            steps: simulation.state.step,
            solves: counts.problems,
            contacts: counts.contacts,
            iterations: counts.iterations,
            ..Self::expected(simulation)
        }
    }

    /// Iterations that cost twenty times as much as all else of this work, and a million for short
    /// runs.
    pub(crate) fn most_iterations(&self) -> u64 {
        const DEAR: f64 = 20.0;
        const ALWAYS: f64 = 1e6;
        (DEAR * self.seconds() * 1e9 / cost::ITERATION + ALWAYS) as u64
    }

    /// What it should cost, s: an estimate that is good for ratios.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        let [steps, blocks, dofs, shapes, beams] =
            [self.steps, self.blocks, self.nodal_dofs, self.shapes, self.beams].map(|n| n as f64);
        let [solves, contacts, iterations] = [self.solves, self.contacts, self.iterations].map(|n| n as f64);
        let step =
            cost::STEP + cost::BLOCK * blocks + cost::BEAM * beams + cost::NODAL_DOF * dofs + cost::SHAPE * shapes;
        let contact =
            cost::CONTACT + cost::CONTACT_BEAM * beams + cost::CONTACT_NODAL_DOF * dofs + cost::CONTACT_SHAPE * shapes;
        let scheme = cost::SCHEMES.iter().find(|(name, _)| *name == self.scheme).map_or(1.0, |(_, factor)| *factor);
        1e-9 * scheme * (steps * step + solves * cost::SOLVE + contacts * contact + iterations * cost::ITERATION)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twice_the_steps_is_twice_the_work_and_more_of_anything_is_more() {
        let work =
            Work { steps: 1000, blocks: 1, nodal_dofs: 40, beams: 1, solves: 900, contacts: 1000, ..Work::default() };
        let twice = Work { steps: 2000, solves: 1800, contacts: 2000, ..work };
        assert!((twice.seconds() / work.seconds() - 2.0).abs() < 1e-12);
        assert!(Work { iterations: 1, ..work }.seconds() > work.seconds());
        assert!(Work { nodal_dofs: 80, ..work }.seconds() > work.seconds());
    }
}
