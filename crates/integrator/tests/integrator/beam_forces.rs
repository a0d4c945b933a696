//! Section forces and reactions of steps with contacts: everything balances, at every step.

use crate::scenes::{PAPER_BLOCK, model, workspace};
use nalgebra::Vector2;
use std::sync::Arc;
use teeter_beam::{Axial, Beam, BeamSpec, Damping, Section, SpanLoad, Support};
use teeter_detect::{BodyId, Kinematics};
use teeter_integrator::*;

fn spec() -> BeamSpec {
    BeamSpec::new(0.36, 20, Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap())
}

fn damped(spec: BeamSpec) -> BeamSpec {
    spec.damped(Damping::none().with_viscous(0.4).with_rayleigh_stiffness(1e-6).with_rayleigh_mass(0.2))
}

fn moreau_jean(theta: f64) -> Box<dyn Scheme<2>> {
    Box::new(MoreauJean::new(MoreauJeanSettings { theta, ..MoreauJeanSettings::default() }).unwrap())
}

/// A force at a place, a weight, and a load on a part of the span, by one signal.
#[derive(Debug)]
struct Loads(Arc<dyn Signal>);

fn loads(s: f64) -> [SpanLoad; 3] {
    [
        SpanLoad::Point { x: 0.1, force: -2.0 * s, couple: 0.05 * s },
        SpanLoad::Uniform { from: 0.05, to: 0.25, load: -4.0 * s },
        SpanLoad::Weight { gravity: -9.81 * s },
    ]
}

impl SpanLoads for Loads {
    fn add(&self, t: f64, to: &mut Vec<SpanLoad>) {
        to.extend(loads(self.0.value(t)));
    }

    fn add_mean(&self, [from, until]: [f64; 2], to: &mut Vec<SpanLoad>) {
        to.extend(loads(self.0.mean(from, until)));
    }
}

fn loaded(body: BeamBody, signal: &Arc<dyn Signal>) -> BeamBody {
    let beam = Arc::clone(body.beam());
    let mut pattern = vec![0.0; beam.dofs()];
    beam.add_point_load(0.1, -2.0, &mut pattern).unwrap();
    beam.add_point_couple(0.1, 0.05, &mut pattern).unwrap();
    beam.add_partial_load([0.05, 0.25], -4.0, &mut pattern).unwrap();
    beam.add_self_weight(-9.81, &mut pattern).unwrap();
    body.with_load(Box::new(SignalLoad::new(pattern, Arc::clone(signal))))
}

/// What was left over at worst, relative to the largest force of its step (couples relative to that times the span).
#[derive(Debug, Default)]
struct Leftover {
    force: f64,
    couple: f64,
    /// Jumps of V and M at nodes where nothing acts.
    shear: f64,
    moment: f64,
    contacts: usize,
    largest: f64,
}

/// The paper's block on a beam for 0.3 s, with all that balances looked at in every step.
fn run(beam: Beam, surface: BeamSurface, mut scheme: Box<dyn Scheme<2>>, driven: bool) -> Leftover {
    let (beam, span) = (Arc::new(beam), 0.36);
    let mut body = BeamBody::new(Arc::clone(&beam), Vector2::zeros(), surface);
    let mut forces = BeamForces::new(&beam, BodyId(1), 3..3 + beam.dofs());
    if driven {
        let signal: Arc<dyn Signal> = Arc::new(Formula::harmonic(0.0, 7.0, 0.3).unwrap());
        let motion =
            || Motion::still().with(Given::Velocity, 0.02, Arc::new(Formula::harmonic(0.0, 5.0, 0.0).unwrap()));
        body = loaded(body, &signal).with_motion([motion(), motion()]);
        forces = forces.with_loads(Box::new(Loads(signal))).with_supports(3 + beam.dofs() + 1);
    }
    let size = 3 + body.size().q;
    let law = PairLaw::new(0.5, 0.2);
    let model = model(&PAPER_BLOCK, Vector2::new(0.0, -9.81), law, Kinematics::Deformed, Box::new(body));
    let mut q = vec![0.17405990783590924, 0.0685504782624077 + surface_height(surface), 0.08726646259971647];
    q.resize(size, 0.0);
    let mut state = State::new(&model, &q, &vec![0.0; size], 1e-4).unwrap();
    let mut work = workspace(&model);
    scheme.start(&model, &mut state, &mut work).unwrap();
    forces.start(&state, None).unwrap();
    // Rigid motions, held dofs and all.
    let rise: Vec<f64> = (0..beam.dofs()).map(|k| f64::from(u8::from(k % 2 == 0))).collect();
    let turn: Vec<f64> = beam.node_positions().iter().flat_map(|x| [*x, 1.0]).collect();
    let mut left = Leftover::default();
    for _ in 0..3000 {
        let step = scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap();
        left.contacts = left.contacts.max(step.contacts().count());
        let phase = step.phases().next().unwrap();
        let found = forces.enter(&phase).unwrap().unwrap();
        let mut most = found.reactions().iter().fold(1e-3, |most: f64, r| most.max(r.force.abs()));
        let mut force: f64 = found.reactions().iter().map(|r| r.force).sum();
        let mut couple: f64 = found.reactions().iter().map(|r| r.couple + r.x * r.force).sum();
        let mut f = vec![0.0; beam.dofs()];
        for load in forces.loads() {
            match *load {
                SpanLoad::Point { x, force: p, couple: c } => {
                    most = most.max(p.abs());
                    (force, couple) = (force + p, couple + c + x * p);
                }
                SpanLoad::Uniform { from, to, load } => {
                    let p = load * (to - from);
                    (force, couple) = (force + p, couple + 0.5 * (from + to) * p);
                }
                SpanLoad::Weight { gravity } => {
                    let p = gravity * beam.total_mass();
                    (force, couple) = (force + p, couple + 0.5 * span * p);
                }
                _ => unreachable!(),
            }
        }
        // Rate of momentum, and what damping in the ground takes.
        beam.add_mass_product(-1.0, forces.acceleration(), &mut f);
        beam.add_damping_product(-1.0, forces.velocity(), &mut f);
        let dot = |shape: &[f64]| shape.iter().zip(&f).map(|(s, f)| s * f).sum::<f64>();
        (force, couple) = (force + dot(&rise), couple + dot(&turn));
        left.force = left.force.max(force.abs() / most);
        left.couple = left.couple.max(couple.abs() / (most * span));
        left.largest = left.largest.max(most);
        for e in 1..beam.elements() {
            if forces.forces().reactions().iter().any(|r| r.x == beam.node_positions()[e]) {
                continue;
            }
            let (a, b) = (forces.forces().ends(e - 1)[1], forces.forces().ends(e)[0]);
            left.shear = left.shear.max((a.shear - b.shear).abs() / most);
            left.moment = left.moment.max((a.moment - b.moment).abs() / (most * span));
        }
    }
    left
}

fn surface_height(surface: BeamSurface) -> f64 {
    match surface {
        BeamSurface::Axis => 0.0,
        BeamSurface::Top { offset } => offset,
    }
}

/// Rounding of K q: a beam of twenty elements loses four of the sixteen digits (see `Beam::add_stiffness_product`). Measured: sums
/// 5e-13, jumps of the transverse force 5e-12.
const ROUNDING: f64 = 2e-11;

#[test]
fn reactions_contacts_loads_and_momentum_balance_at_every_step() {
    let clamped = || spec().supported([Support::Clamped, Support::Pinned]).support_at(0.09, Support::Pinned);
    let top = BeamSurface::Top { offset: 0.00075 };
    let closed = || Box::new(MoreauJeanClosed::new(MoreauJeanClosedSettings::default()).unwrap());
    let projected = || Box::new(MoreauJeanProjected::new(MoreauJeanProjectedSettings::default()).unwrap());
    let alpha = |spectral_radius| {
        let settings = GeneralizedAlphaSettings { spectral_radius, ..GeneralizedAlphaSettings::default() };
        Box::new(GeneralizedAlpha::new(settings).unwrap())
    };
    let runs = [
        ("paper", run(Beam::new(spec()).unwrap(), BeamSurface::Axis, moreau_jean(0.5), false)),
        ("theta", run(Beam::new(damped(spec())).unwrap(), BeamSurface::Axis, moreau_jean(0.75), false)),
        ("closed", run(Beam::new(damped(spec())).unwrap(), BeamSurface::Axis, closed(), false)),
        ("projected", run(Beam::new(damped(spec())).unwrap(), BeamSurface::Axis, projected(), false)),
        ("alpha", run(Beam::new(damped(spec())).unwrap(), BeamSurface::Axis, alpha(0.8), false)),
        ("alpha 0", run(Beam::new(spec()).unwrap(), BeamSurface::Axis, alpha(0.0), false)),
        ("alpha driven", run(Beam::new(damped(clamped())).unwrap(), top, alpha(0.8), true)),
        ("driven", run(Beam::new(damped(spec())).unwrap(), BeamSurface::Axis, moreau_jean(0.5), true)),
        ("top", run(Beam::new(damped(clamped())).unwrap(), top, moreau_jean(0.5), true)),
        ("held", run(Beam::new(spec().axial(Axial::Held)).unwrap(), BeamSurface::Axis, moreau_jean(0.5), true)),
    ];
    for (name, left) in runs {
        assert_eq!(left.contacts, 2, "{name}: it is meant to have contacts");
        for (what, value) in
            [("force", left.force), ("couple", left.couple), ("shear", left.shear), ("moment", left.moment)]
        {
            assert!(value < ROUNDING, "{name}: {what} {value:e} of {} N", left.largest);
        }
    }
}
