//! The scheme whose contacts stay closed: no drop-outs at rest, no work of contact, the same order as the page's scheme.

use crate::scenes::{BlockSpec, PAPER_BLOCK, beam_body, model, workspace};
use nalgebra::Vector2;
use std::ops::ControlFlow;
use std::sync::Arc;
use teeter_beam::{Beam, BeamSpec, Damping, Section, Support};
use teeter_detect::Kinematics;
use teeter_integrator::*;

/// What a run of the scheme showed.
#[derive(Debug, Default)]
struct Seen {
    /// Steps without a contact between steps with one, each at most three long.
    drop_outs: u32,
    /// Largest work U_θ·p of a single contact, relative to ‖p‖ times its speeds.
    largest_work: f64,
    without: u32,
    had: bool,
}

impl Observer<2> for Seen {
    fn observe(&mut self, _: &Model<2>, step: &StepReport<'_, 2>, _: &State) -> Result<ControlFlow<()>, ObserverError> {
        for contact in step.contacts {
            let mean = (contact.u_before + contact.u_after) * 0.5;
            let size = contact.p.norm() * (contact.u_before.norm() + contact.u_after.norm()).max(1e-6);
            if size > 0.0 {
                self.largest_work = self.largest_work.max(mean.dot(&contact.p) / size);
            }
        }
        if step.contacts.iter().any(|contact| contact.p[0] > 0.0) {
            if self.had && (1..=3).contains(&self.without) {
                self.drop_outs += 1;
            }
            (self.had, self.without) = (true, 0);
        } else {
            self.without += 1;
        }
        Ok(ControlFlow::Continue(()))
    }
}

fn take(model: &Model<2>, q: &[f64], v: &[f64], h: f64, steps: u64, closed: bool) -> (State, Seen) {
    let mut state = State::new(model, q, v, h).unwrap();
    let mut work = workspace(model);
    let plan = Plan { steps, require_convergence: true };
    let mut seen = Seen::default();
    let mut scheme: Box<dyn Scheme<2>> = if closed {
        Box::new(MoreauJeanClosed::new(MoreauJeanClosedSettings::default()).unwrap())
    } else {
        Box::new(MoreauJean::new(MoreauJeanSettings::default()).unwrap())
    };
    let ended = run(model, scheme.as_mut(), &mut state, &mut work, &plan, &mut [&mut seen]).unwrap();
    assert_eq!(ended, Ended::Complete);
    (state, seen)
}

fn ground(law: PairLaw) -> Model<2> {
    model(&PAPER_BLOCK, Vector2::new(0.0, -9.81), law, Kinematics::Deformed, Box::new(Ground::flat(0.0)))
}

/// The paper's block tilted by 5° about its bottom left corner, which is at the origin.
fn tilted() -> [f64; 3] {
    let (sin, cos) = 5.0_f64.to_radians().sin_cos();
    [0.015 * cos - 0.0675 * sin, 0.015 * sin + 0.0675 * cos, 5.0_f64.to_radians()]
}

#[test]
fn explore() {
    for h in [1e-3, 1e-4, 1e-5] {
        for closed in [false, true] {
            let (state, seen) =
                take(&ground(PairLaw::new(0.5, 0.0)), &tilted(), &[0.0; 3], h, (1.0 / h) as u64, closed);
            println!(
                "{h:e} {closed} {:?} {seen:?} {:?} pen {:e} res {:e}",
                state.q,
                state.ledger.positive_contact_work,
                state.tally.max_penetration,
                state.ledger.relative_residual()
            );
        }
    }
    let beam = Arc::new(
        Beam::new(BeamSpec {
            span: 0.36,
            elements: 20,
            section: Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap(),
            supports: [Support::Pinned, Support::Pinned],
            damping: Damping { viscous: 0.405083279, rayleigh_mass: 0.0, rayleigh_stiffness: 0.0 },
        })
        .unwrap(),
    );
    for e in [0.0, 0.3] {
        for h in [1e-4, 1e-5] {
            for closed in [false, true] {
                let model = model(
                    &PAPER_BLOCK,
                    Vector2::new(0.0, -9.81),
                    PairLaw::new(0.5, e),
                    Kinematics::Deformed,
                    Box::new(beam_body(&beam)),
                );
                let mut q = tilted().to_vec();
                q[0] += 0.165;
                q.resize(3 + beam.dofs(), 0.0);
                let v = vec![0.0; q.len()];
                let (state, seen) = take(&model, &q, &v, h, (0.3 / h) as u64, closed);
                println!(
                    "beam {e} {h:e} {closed} {:?} {seen:?} {:?} pen {:e} res {:e}",
                    &state.q[..3],
                    state.ledger.positive_contact_work,
                    state.tally.max_penetration,
                    state.ledger.relative_residual()
                );
            }
        }
    }
    let _ = BlockSpec { width: 0.0, height: 0.0, depth: 0.0, density: 0.0 };
}
