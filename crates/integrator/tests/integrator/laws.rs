//! Impact laws against exact answers: balls in a row, a rod that Newton's law makes energy with, spin, springs.

use crate::scenes::workspace;
use nalgebra::Vector2;
use teeter_detect::{
    Anchor, BodyId, Candidate, Candidates, ContactDetector, ContactId, DetectorMemory, Frame, Geometry, Kinematics,
    LawId, PointDetector, PointPair, plane_frame,
};
use teeter_integrator::*;
use teeter_rigid::{MassProperties, Rectangle};

/// Touching pairs of blocks, their contact point given in both; frames as they are at the start.
#[derive(Clone, Debug)]
struct Touching(Vec<Candidate<2>>);

impl ContactDetector<2> for Touching {
    fn detect(&self, at: &dyn Geometry<2>, margin: f64, _: &mut DetectorMemory, out: &mut Candidates<2>) {
        out.clear();
        for candidate in &self.0 {
            let [a, b] = candidate.sides.map(|side| {
                let mut place = [Vector2::zeros()];
                at.place(side.body, &[side.point], &mut place);
                place[0]
            });
            let gap = (candidate.frame * (a - b))[0];
            if gap <= margin {
                out.push(Candidate { gap, ..*candidate });
            }
        }
    }

    fn capacity(&self) -> usize {
        self.0.len()
    }
}

fn touching(law: LawId, sides: [(u32, Vector2<f64>); 2], normal: Vector2<f64>) -> Candidate<2> {
    let sides = sides.map(|(body, point)| Anchor { body: BodyId(body), point });
    let frame: Frame<2> = plane_frame(&normal);
    Candidate { id: ContactId::new(law.0, 0), law, sides, frame, gap: 0.0 }
}

/// Equal bodies of mass 1 in a row that touch, without gravity; a law for each contact.
fn row(laws: &[PairLaw]) -> Model<2> {
    let shape = Rectangle::new(1.0, 1.0).unwrap();
    let mass = MassProperties::rectangle(&shape, 1.0, 1.0).unwrap();
    let mut parts = ModelBuilder::new();
    parts.add(Blocks::new(vec![Block::new(mass, &shape); laws.len() + 1], Vector2::zeros()));
    let mut candidates = Vec::new();
    for (k, &law) in laws.iter().enumerate() {
        let k = k as u32;
        let law = parts.law(law);
        // Of the right one on the left one: u > 0 parts them.
        candidates.push(touching(law, [(k + 1, Vector2::new(-0.5, 0.0)), (k, Vector2::new(0.5, 0.0))], Vector2::x()));
    }
    parts.build(Box::new(Touching(candidates))).unwrap()
}

/// The velocities along the row after one step of `scheme`.
fn collide(model: &Model<2>, v: &[f64], closed: bool) -> (Vec<f64>, State) {
    let bodies = v.len();
    let mut q = vec![0.0; 3 * bodies];
    (0..bodies).for_each(|k| q[3 * k] = k as f64);
    let mut start = vec![0.0; 3 * bodies];
    (0..bodies).for_each(|k| start[3 * k] = v[k]);
    step(model, &q, &start, closed, |state| state.v.iter().step_by(3).copied().collect())
}

fn scheme(closed: bool) -> Box<dyn Scheme<2>> {
    if closed {
        Box::new(MoreauJeanClosed::new(MoreauJeanClosedSettings { gap_tolerance: 0.0 }).unwrap())
    } else {
        Box::new(MoreauJean::new(MoreauJeanSettings::default()).unwrap())
    }
}

fn step<T>(model: &Model<2>, q: &[f64], v: &[f64], closed: bool, get: impl Fn(&State) -> T) -> (T, State) {
    let mut state = State::new(model, q, v, 1e-12).unwrap();
    let mut work = workspace(model);
    let mut scheme = scheme(closed);
    scheme.start(model, &mut state, &mut work).unwrap();
    let report = scheme.advance(model, &mut state, f64::INFINITY, &mut work).unwrap();
    assert!(report.outcome().is_some_and(|outcome| outcome.converged()), "{:?}", report.outcome());
    (get(&state), state)
}

fn near(found: &[f64], wanted: &[f64]) {
    let off = found.iter().zip(wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off <= 1e-12, "{found:?}, but must be {wanted:?}");
}

/// Newton's law looks at each contact's own velocity: the second one has none, so its e is lost. Poisson's looks at the
/// impulse, which the second one has. With e = 1 both keep the energy, neither is what a row of steel balls does, (0, 0, 1):
/// that takes impacts one after the other.
#[test]
fn three_balls_in_a_row() {
    let laws = |impact, e: [f64; 2]| row(&e.map(|e| PairLaw::new(0.0, e).with_impact(impact)));
    let (third, sixth) = (1.0 / 3.0, 1.0 / 6.0);
    let v = |model: &Model<2>| collide(model, &[1.0, 0.0, 0.0], false).0;
    near(&v(&laws(ImpactLaw::Newton, [0.0, 1.0])), &[third, third, third]);
    near(&v(&laws(ImpactLaw::Poisson, [0.0, 1.0])), &[sixth, sixth, 4.0 * sixth]);
    for impact in [ImpactLaw::Newton, ImpactLaw::Poisson, ImpactLaw::Energetic] {
        near(&v(&laws(impact, [1.0, 1.0])), &[-third, 2.0 * third, 2.0 * third]);
        near(&v(&laws(impact, [0.0, 0.0])), &[third, third, third]);
    }
    // One after the other: each pair alone swaps its velocities.
    let pair = row(&[PairLaw::new(0.0, 1.0)]);
    let first = collide(&pair, &[1.0, 0.0], false).0;
    let second = collide(&pair, &[first[1], 0.0], false).0;
    near(&[first[0], second[0], second[1]], &[0.0, 0.0, 1.0]);
}

#[test]
fn poissons_law_of_one_contact_is_newtons_without_friction() {
    for e in [0.0, 0.3, 1.0] {
        let after = |impact| collide(&row(&[PairLaw::new(0.0, e).with_impact(impact)]), &[1.0, -0.5], false).0;
        near(&after(ImpactLaw::Poisson), &after(ImpactLaw::Newton));
        let (v, state) = collide(&row(&[PairLaw::new(0.0, 1.0).with_impact(ImpactLaw::Poisson)]), &[1.0, 0.0], false);
        near(&v, &[0.0, 1.0]);
        assert!((state.ledger.current.kinetic - 0.5).abs() < 1e-15, "e = 1 keeps the energy");
    }
}

/// A body with its centre `height` above fixed ground that it touches at these places right now; no gravity.
fn on_ground(law: PairLaw, phi: f64, height: f64, places: &[f64]) -> Model<2> {
    let shape = Rectangle::new(0.2, 1.0).unwrap();
    let mass = MassProperties::rectangle(&shape, 1.0, 5.0).unwrap();
    let mut parts = ModelBuilder::new();
    let body = parts.add(Blocks::new(vec![Block::new(mass, &shape)], Vector2::zeros())).body();
    let surface = parts.add(Ground::flat(0.0)).body();
    let law = parts.law(law);
    let points = places.iter().map(|&x| nalgebra::Rotation2::new(-phi) * Vector2::new(x, -height)).collect();
    let kinematics = Kinematics::Deformed;
    parts
        .build(Box::new(PointDetector::new(vec![PointPair { pair: 0, law, points, body, surface, kinematics }])))
        .unwrap()
}

/// Numbers in [−1, 1], the same in every run.
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// The work of contact in 400 impacts of random blocks with this law, each relative to the kinetic energy; where `keep` is
/// told, the final velocities too.
fn works(impact: ImpactLaw, corners: usize, closed: bool, e_t: f64) -> Vec<(f64, State)> {
    let mut dice = Dice(1);
    (0..400)
        .map(|_| {
            let law = PairLaw::new(0.5 + 0.5 * dice.roll(), 0.5 + 0.5 * dice.roll())
                .with_impact(impact)
                .with_tangential_restitution(e_t);
            let (phi, height) = (dice.roll(), 0.6 + 0.4 * dice.roll());
            let left = 0.3 * dice.roll();
            let model = on_ground(law, phi, height, &[left, left + 0.2][..corners]);
            let mut v = [dice.roll(), dice.roll(), 3.0 * dice.roll()];
            // Down, faster than any corner rises by spin.
            v[1] -= 4.0;
            let (_, state) = step(&model, &[0.0, height, phi], &v, closed, |_| ());
            let sum = state.ledger.sum;
            ((sum.contact + sum.friction) / state.ledger.initial.kinetic, state)
        })
        .collect()
}

/// Kane and Levinson (1985): Newton's law with friction makes energy in some impacts. The energetic law makes none, and
/// where Newton's makes none either, they agree.
#[test]
fn the_energetic_law_is_newtons_without_its_gain() {
    for corners in [1, 2] {
        let newton = works(ImpactLaw::Newton, corners, false, 0.0);
        let energetic = works(ImpactLaw::Energetic, corners, false, 0.0);
        let gains = newton.iter().filter(|(work, _)| *work > 1e-6).count();
        assert!(gains >= 3, "{corners} corners: Newton's law is known to make energy; it did {gains} times");
        for ((newton, by_newton), (energetic, by_energy)) in newton.iter().zip(&energetic) {
            assert!(*energetic <= 1e-13, "{energetic}");
            if *newton <= 0.0 {
                near(&by_energy.v, &by_newton.v);
            } else {
                assert!(
                    *energetic >= -1e-9,
                    "the largest f leaves no loss: {energetic} where Newton's law gives {newton}"
                );
            }
        }
    }
}

/// Two to five bodies that touch at so many random places, each contact with a law of its own: the work of contact in one step,
/// relative to the kinetic energy before. `None` where the solver doesn't get to its tolerance.
fn work_in_a_heap(dice: &mut Dice, laws: &[ImpactLaw]) -> Option<f64> {
    let shape = Rectangle::new(0.2, 1.0).unwrap();
    let mut pick = |n: usize| (0.5 * (1.0 + dice.roll()) * n as f64) as usize % n;
    let (bodies, contacts) = (2 + pick(4), 1 + pick(5));
    let ends: Vec<[usize; 2]> = (0..contacts).map(|_| [pick(bodies), pick(bodies - 1)]).collect();
    let chosen: Vec<ImpactLaw> = (0..contacts).map(|_| laws[pick(laws.len())]).collect();
    let blocks = (0..bodies).map(|_| {
        let mass = MassProperties::rectangle(&shape, 1.0, 1.05 + dice.roll()).unwrap();
        Block::new(mass, &shape)
    });
    let mut parts = ModelBuilder::new();
    parts.add(Blocks::new(blocks.collect(), Vector2::zeros()));
    let mut touch = Vec::new();
    let q: Vec<f64> = (0..3 * bodies).map(|k| if k % 3 == 2 { 0.0 } else { dice.roll() }).collect();
    for ([a, b], impact) in ends.into_iter().zip(chosen) {
        let law = PairLaw::new(0.5 + 0.5 * dice.roll(), 0.5 + 0.5 * dice.roll())
            .with_impact(impact)
            .with_tangential_restitution((2.0 * dice.roll()).clamp(0.0, 1.0));
        let b = if b >= a { b + 1 } else { b };
        let turn = 3.2 * dice.roll();
        let place = Vector2::new(dice.roll(), dice.roll());
        let points = [a, b].map(|body| (body as u32, place - Vector2::new(q[3 * body], q[3 * body + 1])));
        touch.push(touching(parts.law(law), points, Vector2::new(turn.cos(), turn.sin())));
    }
    let model = parts.build(Box::new(Touching(touch))).unwrap();
    let v: Vec<f64> = (0..3 * bodies).map(|_| dice.roll()).collect();
    let mut scheme = scheme(true);
    let (mut state, mut work) = (State::new(&model, &q, &v, 1e-12).unwrap(), workspace(&model));
    scheme.start(&model, &mut state, &mut work).unwrap();
    let report = scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap();
    let solved = report.outcome().is_none_or(|outcome| outcome.converged());
    let sum = state.ledger.sum;
    solved.then_some((sum.contact + sum.friction) / state.ledger.initial.kinetic)
}

/// Whatever meets whatever by whichever laws in the same instant, with closed contacts none is made.
#[test]
fn several_impacts_at_once_give_no_energy() {
    use ImpactLaw::{Energetic, Newton, Poisson};
    for laws in [&[Newton, Poisson, Energetic][..], &[Poisson]] {
        let mut dice = Dice(7);
        let (mut largest, mut impacts, mut unsolved) = (f64::MIN, 0, 0);
        for _ in 0..1000 {
            let Some(work) = work_in_a_heap(&mut dice, laws) else {
                unsolved += 1;
                continue;
            };
            largest = largest.max(work);
            impacts += u32::from(work < -1e-6);
        }
        assert!(impacts > 500 && unsolved < 10, "{laws:?}: {impacts} were impacts, {unsolved} not solved");
        assert!(largest <= 1e-12, "{laws:?}: {largest:e}");
    }
}

/// In none of these impacts of single bodies does Poisson's law make energy, where Newton's does in some.
#[test]
fn poissons_law_makes_no_energy_where_newtons_does() {
    for corners in [1, 2] {
        let poisson = works(ImpactLaw::Poisson, corners, false, 0.0);
        let largest = poisson.iter().map(|(work, _)| *work).fold(f64::MIN, f64::max);
        assert!(largest <= 1e-13, "{corners}: {largest}");
    }
}

#[test]
fn with_closed_contacts_no_law_gives_energy() {
    for corners in [1, 2] {
        for impact in [ImpactLaw::Newton, ImpactLaw::Poisson, ImpactLaw::Energetic] {
            for e_t in [0.0, 0.7] {
                let largest = works(impact, corners, true, e_t).iter().map(|(work, _)| *work).fold(f64::MIN, f64::max);
                assert!(largest <= 1e-13, "{impact:?} {corners} {e_t}: {largest}");
            }
        }
    }
}

/// Garwin's superball: with e = e_t = 1 and friction enough, a disc-like body keeps its energy and its spin about the contact
/// is reversed: here a body hit at a point straight below its centre, so that H is diagonal.
#[test]
fn tangential_restitution_reverses_the_velocity_of_an_impact_that_sticks() {
    for impact in [ImpactLaw::Newton, ImpactLaw::Poisson] {
        for closed in [false, true] {
            for (e_t, mu, sticks) in [(1.0, 10.0, true), (0.4, 10.0, true), (1.0, 0.01, false)] {
                let law = PairLaw::new(mu, 1.0).with_impact(impact).with_tangential_restitution(e_t);
                let model = on_ground(law, 0.0, 0.5, &[0.0]);
                let (v, state) = step(&model, &[0.0, 0.5, 0.0], &[0.3, -1.0, 0.5], closed, |state| state.v.clone());
                let (before, after) = (0.3 + 0.5 * 0.5, v[0] + 0.5 * v[2]);
                let wanted = if sticks { -e_t * before } else { before - 0.01 * 2.0 * (1.0 + 0.25 * 12.0 / 1.04) };
                assert!(
                    (after - wanted).abs() < 1e-11 && (v[1] - 1.0).abs() < 1e-11,
                    "{impact:?} {e_t} {mu}: {after} {wanted} {v:?}"
                );
                if e_t == 1.0 && sticks {
                    assert!((state.ledger.current.kinetic / state.ledger.initial.kinetic - 1.0).abs() < 1e-14);
                }
            }
        }
    }
}

/// From how high the block falls, m.
const FALL: f64 = 0.0125;

/// The energy above that of rest after so many seconds of flat bounces with e, in steps of `h`, as a part of that at the start.
fn bouncing(impact: ImpactLaw, e: f64, theta: f64, closed: bool, seconds: f64, h: f64) -> f64 {
    let law = PairLaw::new(0.0, e).with_impact(impact);
    let gravity = Vector2::new(0.0, -9.81);
    let surface = Box::new(Ground::flat(0.0));
    let model = crate::scenes::model(&crate::scenes::PAPER_BLOCK, gravity, law, Kinematics::Deformed, surface);
    let mut state = State::new(&model, &[0.0, 0.0675 + FALL, 0.0], &[0.0; 3], h).unwrap();
    let mut work = workspace(&model);
    let mut scheme: Box<dyn Scheme<2>> = if closed {
        Box::new(MoreauJeanClosed::new(MoreauJeanClosedSettings::default()).unwrap())
    } else {
        Box::new(MoreauJean::new(MoreauJeanSettings { theta, ..MoreauJeanSettings::default() }).unwrap())
    };
    let plan = Plan::steps((seconds / h) as u64).when_unsolved(Unsolved::End);
    let ended = run(&model, scheme.as_mut(), &mut state, &mut work, &plan, &mut []).unwrap();
    assert_eq!(ended, Ended::Complete);
    let weight = 2700.0 * 0.03 * 0.135 * 0.03 * 9.81;
    (state.ledger.current.total() - weight * 0.0675) / (weight * FALL)
}

/// What comes back is of the blow, not of the weight that acts in the step of the blow.
#[test]
fn bounces_with_e_one_keep_the_energy_by_every_law() {
    for impact in [ImpactLaw::Newton, ImpactLaw::Poisson, ImpactLaw::Energetic] {
        for closed in [false, true] {
            let kept = bouncing(impact, 1.0, 0.5, closed, 60.0, 1e-3);
            assert!((kept - 1.0).abs() < 1e-9, "{impact:?}, closed {closed}: {kept}");
        }
    }
}

/// Each bounce leaves e² of the energy, to the velocity that gravity makes in a step; and in the end the block lies on the ground, to
/// the way of the slowest approach that is an impact, g h/e, in a step.
#[test]
fn bounces_leave_what_restitution_leaves() {
    for impact in [ImpactLaw::Newton, ImpactLaw::Poisson, ImpactLaw::Energetic] {
        for closed in [false, true] {
            for e in [0.9_f64, 0.7] {
                // After the third impact, of a series at √(2 FALL/g) (1 + 2e + 2e² + …).
                let after_three = (2.0 * FALL / 9.81).sqrt() * (1.0 + 2.0 * e + 2.0 * e * e + 0.5 * e * e * e);
                let h = 1e-4;
                let left = bouncing(impact, e, 0.5, closed, after_three, h);
                let off: f64 = (0..3).map(|n| 2.0 * 9.81 * h / (e.powi(n) * (2.0 * 9.81 * FALL).sqrt())).sum();
                assert!((left / e.powi(6) - 1.0).abs() < off, "{impact:?} {e}, closed {closed}: {left} {off}");
                let h = 1e-3;
                let left = bouncing(impact, e, 0.5, closed, 60.0, h);
                assert!(left.abs() <= 9.81 * h * h / e / FALL, "{impact:?} {e}, closed {closed}: {left}");
            }
        }
    }
}

/// What θ > ½ takes is numerical: the law's work is judged without it, so restitution is what it was.
#[test]
fn restitution_is_the_same_for_every_theta() {
    for theta in [0.5, 0.7, 1.0] {
        let left =
            [ImpactLaw::Newton, ImpactLaw::Energetic].map(|impact| bouncing(impact, 0.8, theta, false, 0.2, 1e-3));
        assert!((left[0] - left[1]).abs() < 1e-12, "{theta}: {left:?}");
    }
}

/// Kane and Levinson's impact that sticks: closed contacts give less back, but friction stays friction.
#[test]
fn an_impact_that_sticks_is_not_turned_into_a_superball() {
    for impact in [ImpactLaw::Newton, ImpactLaw::Energetic] {
        let law = PairLaw::new(10.0, 1.0).with_impact(impact);
        let (phi, height) = (0.35_f64, 0.5);
        let model = on_ground(law, phi, height, &[-0.1]);
        let (v, state) = step(&model, &[0.0, height, phi], &[-0.1, -1.0, -0.6], true, |state| state.v.clone());
        // At (−0.1, −0.5) from the centre.
        let (before, after) = ([-0.1 - 0.6 * 0.5, -1.0 + 0.6 * 0.1], [v[0] + v[2] * 0.5, v[1] - v[2] * 0.1]);
        let sum = state.ledger.sum;
        assert!(sum.contact + sum.friction <= 1e-13, "{impact:?}");
        assert!(before[0] < -0.3 && after[0].abs() < 1e-9 && after[1] > 0.5, "{impact:?}: {before:?} {after:?}");
    }
}
