//! What every step of any scene must balance: the law of its contacts, momentum, energy.

use super::drawn::{Damping, Drawn, Law, Scheme, Support};
use super::motion::{NoMotion, ready};
use super::{Checked, check};
use proptest::prelude::*;
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex};
use teeter_contact::{ContactProblem, ContactSolver, Outcome, Stop, Vector};
use teeter_integrator::{BeamForces, Contact, Ended, Model, Observer, ObserverError, State, StepReport};
use teeter_scenario::resolve::Resolved;
use teeter_scenario::simulation::{BeamPlace, Simulation};

/// Rounding of a sum of some ten terms, each of some operations, as a part of the sum of their
/// sizes.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// A step with the state before it.
struct Step<'a> {
    q: &'a [f64],
    v: &'a [f64],
    report: &'a StepReport<'a, 2>,
    state: &'a State,
    /// What the solves of the step leave open, in energy and in impulse.
    open: Open,
}

/// Judges every step.
struct Judge<F> {
    q: Vec<f64>,
    v: Vec<f64>,
    open: Arc<Mutex<Open>>,
    judge: F,
    steps: usize,
    wrong: Option<String>,
}

impl<F: FnMut(&Step<'_>) -> Result<(), String>> Observer<2> for Judge<F> {
    fn start(&mut self, _: &Model<2>, state: &State) -> Result<(), ObserverError> {
        (self.q, self.v) = (state.q.clone(), state.v.clone());
        Ok(())
    }

    fn observe(
        &mut self,
        _: &Model<2>,
        report: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError> {
        let open = std::mem::take(&mut *self.open.lock().unwrap());
        let found = (self.judge)(&Step { q: &self.q, v: &self.v, report, state, open });
        (self.q, self.v) = (state.q.clone(), state.v.clone());
        self.steps += 1;
        self.wrong = found.err().map(|wrong| format!("in step {}: {wrong}", report.step));
        Ok(if self.wrong.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    }
}

/// What solutions that are not exact may be wrong by.
///
/// The residual of a solve is ‖r‖ = err·S with S = max(‖p‖, ρ‖q‖): p − r obeys the law exactly with
/// velocities changed by r/ρ (`docs/theory.md` §6). So a product u·p that the law makes ≤ 0 is up
/// to ‖r‖ (‖p‖/ρ + ‖û‖ + ‖r‖/ρ), and ‖û‖ ≤ (1 + μ)(‖q‖ + ‖H‖‖p‖) with ‖H‖ ≤ 2n/ρ.
#[derive(Clone, Copy, Default)]
struct Open {
    energy: f64,
    impulse: f64,
}

/// A solver that notes what it leaves open.
struct Watched {
    solver: Box<dyn ContactSolver<2>>,
    open: Arc<Mutex<Open>>,
}

impl ContactSolver<2> for Watched {
    fn name(&self) -> &'static str {
        self.solver.name()
    }

    fn law(&self) -> teeter_contact::Law {
        self.solver.law()
    }

    fn reserve(&mut self, contacts: usize, blocks: usize) {
        self.solver.reserve(contacts, blocks);
    }

    fn solve(&mut self, problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector<2>]) -> Outcome {
        let outcome = self.solver.solve(problem, stop, p);
        let norm = |x: &[Vector<2>]| x.iter().map(Vector::norm_squared).sum::<f64>().sqrt();
        let mu = problem.mu().iter().copied().fold(0.0, f64::max);
        let size = norm(p).max(problem.scale() * norm(problem.q()));
        let r = outcome.residual.global.max(f64::EPSILON) * size;
        let mut open = self.open.lock().unwrap();
        open.impulse += r * (1.0 + mu);
        open.energy += r * size / problem.scale() * (2.0 + (1.0 + mu) * (1.0 + 2.0 * problem.contacts() as f64));
        outcome
    }

    fn fork(&self) -> Box<dyn ContactSolver<2>> {
        Box::new(Self { solver: self.solver.fork(), open: Arc::clone(&self.open) })
    }
}

/// Runs a scene and judges its steps; `judge` is made for the simulation.
fn steps<F: FnMut(&Step<'_>) -> Result<(), String>>(
    drawn: &Drawn,
    judge: impl FnOnce(&Resolved, &Simulation) -> F,
) -> Result<Result<Checked, String>, NoMotion> {
    let open = Arc::new(Mutex::new(Open::default()));
    let (resolved, mut simulation) = ready(drawn, |solver| Box::new(Watched { solver, open: Arc::clone(&open) }))?;
    let judge = judge(&resolved, &simulation);
    let mut judge = Judge { q: Vec::new(), v: Vec::new(), open, judge, steps: 0, wrong: None };
    let ended = simulation.run(&mut [&mut judge]);
    Ok(match (judge.wrong, ended) {
        (Some(wrong), _) => Err(wrong),
        (None, Ok(Ended::Complete)) => Ok(Checked { judged: judge.steps, of: judge.steps }),
        (None, ended) => return Err(NoMotion::Failed(format!("the run ended as {ended:?}"))),
    })
}

impl Drawn {
    fn mass(&self, block: usize) -> f64 {
        let [width, height, depth] = self.blocks[block].size;
        self.blocks[block].density * width * height * depth
    }

    fn inertia(&self, block: usize) -> f64 {
        let [width, height, _] = self.blocks[block].size;
        self.mass(block) * (width * width + height * height) / 12.0
    }

    fn theta(&self) -> f64 {
        if let Scheme::MoreauJean { theta, .. } = self.scheme { theta } else { 0.5 }
    }

    /// The signal's mean over a step.
    fn mean_signal(&self, step: &StepReport<'_, 2>) -> f64 {
        self.signal.mean(step.t_start, step.t_end)
    }

    /// A speed that no contact point of the block exceeds, m/s.
    fn speed(&self, block: usize, v: &[f64]) -> f64 {
        let [width, height, _] = self.blocks[block].size;
        let v = &v[3 * block..3 * block + 3];
        v[0].abs() + v[1].abs() + v[2].abs() * width.hypot(height)
    }

    fn law_of(&self, contact: &Contact<2>) -> (usize, f64, Law) {
        let drawn = &self.contacts[contact.id.pair() as usize];
        (drawn.block, drawn.friction, drawn.law)
    }
}

#[test]
fn friction_opposes_the_slide_and_stays_in_its_cone() {
    check("friction", "proptest-regressions/friction.txt", Just(()), |drawn, ()| {
        steps(drawn, |_, _| {
            |step: &Step<'_>| {
                // In its impacts every contact has two phases, and friction in each.
                let phased = step.report.contacts().any(|contact| drawn.law_of(contact).2.is_poisson());
                for contact in step.report.contacts() {
                    let (block, mu, law) = drawn.law_of(contact);
                    let [p_n, p_t] = [contact.p[0], contact.p[1]];
                    let open = step.open.impulse + ROUNDING * contact.p.norm();
                    if p_n < -open || p_t.abs() > mu * p_n + open {
                        return Err(format!(
                            "p = ({p_n:e}, {p_t:e}) outside the cone of {mu} by more than {open:e} N s"
                        ));
                    }
                    let theta = drawn.theta();
                    let u_mean = theta * contact.u_after[1] + (1.0 - theta) * contact.u_before[1];
                    if phased {
                        continue;
                    }
                    let work = match law {
                        Law::Instant { .. } => contact.u_law[1] * p_t,
                        // By the velocity at the end, or by the mean one where that would give
                        // energy.
                        Law::KelvinVoigt { .. } | Law::HuntCrossley { .. } => {
                            (contact.u_law[1] * p_t).min(u_mean * p_t)
                        }
                    };
                    let speed =
                        drawn.speed(block, step.v) + drawn.speed(block, &step.state.v) + contact.u_before.norm();
                    let open = step.open.energy + ROUNDING * contact.p.norm() * speed;
                    if !(work <= open) {
                        return Err(format!(
                            "friction pushes: u_t p_t = {work:e} J, more than {open:e} J; {contact:?}"
                        ));
                    }
                }
                Ok(())
            }
        })
    });
}

#[test]
fn momentum_changes_by_impulses_only() {
    check("momentum", "proptest-regressions/momentum.txt", Just(()), |drawn, ()| {
        steps(drawn, |_, _| |step: &Step<'_>| blocks_balance(drawn, step))
    });
}

/// Of every block: m Δv and I Δω by weight, loads, and impulses of contacts at its corners.
fn blocks_balance(drawn: &Drawn, step: &Step<'_>) -> Result<(), String> {
    let (h, signal) = (step.state.dt, drawn.mean_signal(step.report));
    for (k, block) in drawn.blocks.iter().enumerate() {
        let (m, inertia) = (drawn.mass(k), drawn.inertia(k));
        let before = &step.v[3 * k..3 * k + 3];
        let after = &step.state.v[3 * k..3 * k + 3];
        let load = block.load.unwrap_or_default().map(|load| h * signal * load);
        let mut gained = [m * (after[0] - before[0]), m * (after[1] - before[1]), inertia * (after[2] - before[2])];
        let size = |a: f64, b: f64| a.abs() + b.abs();
        let mut sizes =
            [m * size(before[0], after[0]), m * size(before[1], after[1]), inertia * size(before[2], after[2])];
        let mut give = |k: usize, impulse: f64| {
            gained[k] -= impulse;
            sizes[k] += impulse.abs();
        };
        give(0, h * m * drawn.gravity[0]);
        give(1, h * m * drawn.gravity[1]);
        (0..3).for_each(|k| give(k, load[k]));
        // Where the schemes take the corners' levers.
        let spin = before[2];
        let angle = step.q[3 * k + 2]
            + match drawn.scheme {
                Scheme::MoreauJean { gamma, .. } => gamma * h * spin,
                _ => 0.25 * h * (spin + spin + load[2] / inertia),
            };
        let (sin, cos) = angle.sin_cos();
        for contact in step.report.contacts().filter(|contact| drawn.law_of(contact).0 == k) {
            let impulse = contact.frame.transpose() * contact.p;
            let point = contact.sides[0].point;
            let lever = [cos * point.x - sin * point.y, sin * point.x + cos * point.y];
            give(0, impulse.x);
            give(1, impulse.y);
            give(2, lever[0] * impulse.y);
            give(2, -lever[1] * impulse.x);
        }
        // Each part of a divided step has levers of its own.
        let known = if step.report.phases().count() > 1 { 2 } else { 3 };
        if let Some(k) = (0..known).find(|&k| !(gained[k].abs() <= ROUNDING * sizes[k])) {
            return Err(format!(
                "{}: component {k} of its momentum is off by {:e} of {:e}",
                block.name, gained[k], sizes[k]
            ));
        }
    }
    Ok(())
}

#[test]
fn a_beam_gains_the_momentum_that_supports_and_contacts_give() {
    check("beam-momentum", "proptest-regressions/beam-momentum.txt", Just(()), |drawn, ()| {
        let mut drawn = drawn.clone();
        for beam in &mut drawn.beams {
            // Of these the whole is not known without the beam's own matrices, or balances only as
            // far as modes reach.
            (beam.foundation, beam.modes, beam.motion) = (None, None, None);
            if let Damping::Rayleigh(_) = beam.damping {
                beam.damping = Damping::None;
            }
            // There a couple of friction turns the axis in the motion, and the section in the
            // account (`docs/beams.md`).
            beam.timoshenko &= !beam.top;
        }
        let drawn = &drawn;
        steps(drawn, |resolved, simulation| {
            let mut beams: Vec<(BeamPlace, BeamForces, f64, bool)> = Vec::new();
            for (k, place) in simulation.layout.beams.iter().enumerate() {
                let mut forces = simulation.layout.beam_forces(&resolved.scene, k);
                forces.start(&simulation.state, None).unwrap();
                let viscous = resolved.scene.beams[k].spec.damping.viscous;
                beams.push((place.clone(), forces, viscous, resolved.scene.beams[k].self_weight));
            }
            move |step: &Step<'_>| {
                for (k, (place, forces, viscous, heavy)) in beams.iter_mut().enumerate() {
                    if step.report.phases().count() > 1 {
                        continue;
                    }
                    for phase in step.report.phases() {
                        forces.enter(&phase).map_err(|error| error.to_string())?;
                    }
                    let reactions: Vec<f64> =
                        forces.forces().reactions().iter().map(|reaction| reaction.force).collect();
                    beam_balance(drawn, k, place, *viscous, *heavy, &reactions, step)?;
                }
                Ok(())
            }
        })
    });
}

/// Of a beam: the change of ∫ρA ẇ by reactions, weight, damping and the impulses of contacts, all
/// vertical.
fn beam_balance(
    drawn: &Drawn,
    number: usize,
    place: &BeamPlace,
    viscous: f64,
    heavy: bool,
    reactions: &[f64],
    step: &Step<'_>,
) -> Result<(), String> {
    let (h, theta, drawn_beam) = (step.state.dt, drawn.theta(), &drawn.beams[number]);
    let x = place.beam.node_positions();
    let area = |from: f64, to: f64| {
        let inside = |segment: super::drawn::Segment| (segment.from..segment.to).contains(&(0.5 * (from + to)));
        let thickness = drawn_beam.segment.filter(|segment| inside(*segment)).map(|segment| segment.thickness);
        drawn_beam.width * thickness.unwrap_or(drawn_beam.thickness)
    };
    // ∫ f w dx of the cubics (a shear term takes nothing from it), and what it is made of.
    let integral = |v: &[f64], density: &dyn Fn(f64, f64) -> f64| {
        let nodes = place.beam.to_nodes(&v[place.range.clone()]);
        let (mut sum, mut size) = (0.0, 0.0);
        for e in 1..x.len() {
            let (l, f) = (x[e] - x[e - 1], density(x[e - 1], x[e]));
            for part in [
                0.5 * l * nodes[e - 1][0],
                0.5 * l * nodes[e][0],
                l * l / 12.0 * nodes[e - 1][1],
                -l * l / 12.0 * nodes[e][1],
            ] {
                sum += f * part;
                size += (f * part).abs();
            }
        }
        (sum, size)
    };
    let mass = |from: f64, to: f64| drawn_beam.density * area(from, to);
    let (mut gained, mut sizes) = (0.0, 0.0);
    let mut give = |(impulse, size): (f64, f64)| {
        gained -= impulse;
        sizes += size;
    };
    let own = |impulse: f64| (impulse, impulse.abs());
    let times = |factor: f64, (sum, size): (f64, f64)| (factor * sum, factor.abs() * size);
    give(times(-1.0, integral(&step.state.v, &mass)));
    give(times(1.0, integral(step.v, &mass)));
    match step.report.phases().next().and_then(|phase| phase.mean_velocity) {
        Some(mean) => give(times(-h * viscous, integral(mean, &|_, _| 1.0))),
        None => {
            give(times(-h * viscous * theta, integral(&step.state.v, &|_, _| 1.0)));
            give(times(-h * viscous * (1.0 - theta), integral(step.v, &|_, _| 1.0)));
        }
    }
    let mut weight = x.windows(2).map(|x| mass(x[0], x[1]) * (x[1] - x[0])).sum::<f64>();
    if let Some([at, lump]) = drawn_beam.lump {
        let w = |v: &[f64]| place.deflection_at(&v[place.range.clone()], at).unwrap().w;
        give(own(-lump * w(&step.state.v)));
        give(own(lump * w(step.v)));
        weight += lump;
    }
    if heavy {
        give(own(h * weight * drawn.gravity[1]));
    }
    reactions.iter().for_each(|force| give(own(h * force)));
    for contact in step.report.contacts().filter(|contact| contact.sides[1].body == place.body) {
        give(own(-(contact.frame.transpose() * contact.p).y));
    }
    if !(gained.abs() <= BEAM_ROUNDING * sizes) {
        return Err(format!("{}: its momentum is off by {gained:e} of {sizes:e} N s", place.name));
    }
    Ok(())
}

/// What the solution of a step leaves of the balance of a beam.
const BEAM_ROUNDING: f64 = 1e-11;

#[test]
fn energy_is_accounted_for_and_never_made() {
    check("ledger", "proptest-regressions/ledger.txt", Just(()), |drawn, ()| {
        let shaken = drawn.ground.is_some_and(|ground| ground.motion.is_some())
            || drawn.beams.iter().any(|beam| beam.motion.is_some());
        steps(drawn, |_, simulation| {
            let beams = simulation.layout.beams.clone();
            move |step: &Step<'_>| {
                let (energy, ledger) = (step.report.energy(), &step.state.ledger);
                // Heights count from the origin.
                let weights = (0..drawn.blocks.len()).map(|k| {
                    let (g, q) = (drawn.gravity, &step.state.q[3 * k..3 * k + 2]);
                    drawn.mass(k) * ((g[0] * q[0]).abs() + (g[1] * q[1]).abs())
                });
                // A beam that moves as a whole stores nothing, but for the rounding of its stiffest
                // element.
                let bent = beams.iter().zip(&drawn.beams).map(|(place, beam)| {
                    beam.stiffness(place.beam.node_positions()) * largest_deflection(place, &step.state.q).powi(2)
                });
                let rounding = ROUNDING * (ledger.scale + weights.sum::<f64>() + bent.sum::<f64>());
                if !(energy.residual.abs() <= rounding) {
                    return Err(format!(
                        "{:e} J of {:e} J are not accounted for",
                        energy.residual,
                        rounding / ROUNDING
                    ));
                }
                // A recursion takes in sum, not in every step.
                let numerical = if drawn.scheme == Scheme::GeneralizedAlpha { 0.0 } else { energy.numerical };
                for (what, work) in [("viscous", energy.viscous), ("numerical", numerical)] {
                    if !(work <= rounding) {
                        return Err(format!("{what} forces give {work:e} J"));
                    }
                }
                let contact = energy.contact + energy.friction;
                if drawn.scheme.is_closed() && !shaken && !(contact <= rounding + step.open.energy) {
                    return Err(format!("contacts give {contact:e} J, more than {:e} J", rounding + step.open.energy));
                }
                Ok(())
            }
        })
    });
}

/// Found by the property above: a block that slides, and beside it on the same beam one by
/// Poisson's law, whose blow is handed on to it.
#[test]
fn a_blow_handed_on_beside_friction_gives_no_energy() {
    let text = include_bytes!("found/poisson-gain.toml");
    let resolved = teeter_scenario::load(text, "poisson-gain.toml", "poisson-gain", &[]).unwrap();
    let mut simulation = Simulation::new(&resolved.scene).unwrap();
    assert_eq!(simulation.run(&mut []).unwrap(), teeter_integrator::Ended::Complete);
    let (ledger, tally) = (&simulation.state.ledger, &simulation.state.tally);
    assert_eq!(tally.unconverged_steps, 0);
    assert!(ledger.sum.contact < -1e-3 * ledger.scale, "there are impacts: {ledger:?}");
    assert!(ledger.positive_contact_work.largest <= 1e-12 * ledger.scale, "{:?}", ledger.positive_contact_work);
}

fn largest_deflection(place: &BeamPlace, q: &[f64]) -> f64 {
    let x = place.beam.node_positions();
    let at = |x: &f64| place.deflection_at(&q[place.range.clone()], *x).unwrap().w.abs();
    x.iter().map(at).fold(0.0, f64::max)
}

impl super::drawn::Beam {
    /// The largest entry of its stiffness for deflections, N/m: 12 EI/l³ of the stiffest element,
    /// and springs.
    fn stiffness(&self, nodes: &[f64]) -> f64 {
        let shortest = nodes.windows(2).map(|x| x[1] - x[0]).fold(f64::INFINITY, f64::min);
        let thickest = self.segment.map_or(0.0, |segment| segment.thickness).max(self.thickness);
        let springs = self.supports.iter().map(|support| match support {
            Support::Spring([spring, ..]) => *spring,
            Support::Word(_) => 0.0,
        });
        let bed = self.foundation.map_or(0.0, |[stiffness, _]| stiffness * self.span);
        self.modulus * self.width * (thickest / shortest).powi(3) + springs.sum::<f64>() + bed
    }
}
