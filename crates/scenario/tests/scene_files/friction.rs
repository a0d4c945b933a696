//! Impulses of contacts lie within the cone of friction, whatever they are sums of.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use teeter_integrator::{Ended, Model, Observer, ObserverError, State, StepReport, Vector};
use teeter_scenario::simulation::Simulation;

/// The largest part by which a step's impulse of a contact is over its friction, and how many impulses there were.
struct OverFriction(f64, usize);

impl Observer<2> for OverFriction {
    fn observe(&mut self, _: &Model<2>, step: &StepReport<'_, 2>, _: &State) -> Result<ControlFlow<()>, ObserverError> {
        const FRICTION: f64 = 0.1;
        let mut sums = BTreeMap::new();
        for contact in step.phases().flat_map(|phase| phase.contacts) {
            *sums.entry(contact.id).or_insert(Vector::<2>::zeros()) += contact.p;
        }
        for p in sums.into_values() {
            let limit = FRICTION * p[0];
            self.0 = self.0.max((p[1].abs() - limit) / (limit + 1e-9));
            self.1 += 1;
        }
        Ok(ControlFlow::Continue(()))
    }
}

/// A chamfered block bounces and slides down a slope. What is left of its bounces when they are too low to count stops with friction, too.
#[test]
fn no_impulse_is_over_its_friction() {
    const TEXT: &str = "[time]\nend = '0.986 s'\nstep = '1 ms'\nscheme = 'event-driven'\n[ground]\n\
        profile = { points = [['-0.5 m', '0 m'], ['0.2 m', '0.14 m'], ['0.88 m', '-0.09 m']] }\n\
        [block.b]\ndensity = '7000 kg/m^3'\ndepth = '10 cm'\nwidth = '0.193 m'\nheight = '0.303 m'\nchamfer = '0.038 m'\n\
        position = ['-0.224 m', '0.6 m']\nangle = '-89.8 deg'\nvelocity = ['1.45 m/s', '-0.1 m/s']\nspin = '-2.92 rad/s'\n\
        [contact.c]\nbetween = ['*', '*']\nfriction = 0.1\nlaw = 'poisson'\nrestitution = 0.3\n";
    let resolved = teeter_scenario::load(TEXT.as_bytes(), "t", "t", &[]).unwrap();
    let mut simulation = Simulation::new(&resolved.scene).unwrap();
    let mut over = OverFriction(0.0, 0);
    assert_eq!(simulation.run(&mut [&mut over]).unwrap(), Ended::Complete);
    assert_eq!(simulation.state.tally.unlocated_steps, 0);
    assert!(over.1 > 300 && over.0 < 1e-12, "{:e} of {} impulses", over.0, over.1);
    assert!(simulation.state.ledger.relative_residual() < 1e-13);
}
