//! Counted work: the cost of a run by operations, not by the clock, so that choices based on it are
//! the same in every run.

use teeter_scenario::simulation::Simulation;

/// The work of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Work {
    /// The time scheme.
    pub scheme: &'static str,
    /// Steps taken.
    pub steps: u64,
    /// Blocks.
    pub blocks: u64,
    /// Dofs of full beams.
    pub nodal_dofs: u64,
    /// Shapes of beams in modes.
    pub shapes: u64,
    /// Beams.
    pub beams: u64,
    /// Contact problems solved.
    pub solves: u64,
    /// Contacts in them, summed.
    pub contacts: u64,
    /// Iterations, summed.
    pub iterations: u64,
}

/// The cost model: ns for each counted operation, fitted once to the scenarios on the machine of
/// `benches/results`. Only ratios affect choices; `tradeoff.csv` also has the measured time.
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

    /// Cost of a scheme relative to `moreau-jean`; 1 if not measured.
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
    /// Lower bound on the work of a simulation: its steps, without contacts, which aren't known
    /// yet.
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

    /// The work of a simulation so far.
    #[must_use]
    pub fn of(simulation: &Simulation) -> Self {
        let counts = simulation.work_counts();
        Self {
            steps: simulation.state.step,
            solves: counts.problems,
            contacts: counts.contacts,
            iterations: counts.iterations,
            ..Self::expected(simulation)
        }
    }

    /// The number of iterations that cost twenty times as much as all other work, but at least a
    /// million for short runs.
    pub(crate) fn most_iterations(&self) -> u64 {
        const DEAR: f64 = 20.0;
        const ALWAYS: f64 = 1e6;
        (DEAR * self.seconds() * 1e9 / cost::ITERATION + ALWAYS) as u64
    }

    /// Estimated cost, s; only ratios are meaningful.
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
