//! What doesn't belong together is refused: another model's workspace or scheme, wiring that can't work, a law that nobody handles.

use crate::scenes::{PAPER_BLOCK, all_schemes, beam_body, workspace};
use nalgebra::Vector2;
use std::sync::Arc;
use teeter_beam::{Beam, BeamSpec, Section};
use teeter_detect::{
    Anchor, BodyId, Candidate, Candidates, ContactDetector, ContactId, DetectorMemory, Geometry, Kinematics, LawId,
    PointDetector, PointPair, plane_frame,
};
use teeter_integrator::*;
use teeter_rigid::{MassProperties, Rectangle};

fn on_ground(law: PairLaw) -> Model<2> {
    let ground = Box::new(Ground::flat(0.0));
    crate::scenes::model(&PAPER_BLOCK, Vector2::new(0.0, -9.81), law, Kinematics::Deformed, ground)
}

fn start(model: &Model<2>) -> State {
    let mut q = vec![0.1, 0.0775, 0.02];
    q.resize(model.size().q, 0.0);
    State::new(model, &q, &vec![0.0; model.size().v], 1e-4).unwrap()
}

fn beam_of(height: f64) -> Model<2> {
    let section = Section::rectangle(0.03, height, 69e9, 2700.0).unwrap();
    let beam = Arc::new(Beam::new(BeamSpec::new(0.36, 4, section)).unwrap());
    let law = PairLaw::new(0.5, 0.0);
    let surface = Box::new(beam_body(&beam));
    crate::scenes::model(&PAPER_BLOCK, Vector2::new(0.0, -9.81), law, Kinematics::Deformed, surface)
}

#[test]
fn a_workspace_of_another_model_of_the_same_sizes_is_refused() {
    // A beam twice as thick: the same sizes, other numbers.
    let (one, other) = (beam_of(0.0015), beam_of(0.003));
    for mut scheme in all_schemes(&[]) {
        let (mut state, mut work) = (start(&one), workspace(&one));
        scheme.start(&one, &mut state, &mut work).unwrap();
        scheme.advance(&one, &mut state, f64::INFINITY, &mut work).unwrap();
        let before = state.clone();
        let error = scheme.advance(&other, &mut state, f64::INFINITY, &mut work).unwrap_err();
        assert!(matches!(error, StepError::Mismatch(Mismatch::OtherModel { .. })), "{error}");
        assert_eq!(state, before, "the state is as before");

        // A workspace of its own, but the scheme was started with the other.
        let mut own = workspace(&other);
        let error = scheme.advance(&other, &mut state, f64::INFINITY, &mut own).unwrap_err().to_string();
        assert_eq!(
            error,
            "the scheme was started with that of another model: start it with this one before its first step"
        );
        // Started anew it serves it, but not with the old workspace.
        let error = scheme.start(&other, &mut state, &mut work).unwrap_err().to_string();
        assert!(error.starts_with("the workspace is that of another model"), "{error}");
        scheme.start(&other, &mut state, &mut own).unwrap();
        scheme.advance(&other, &mut state, f64::INFINITY, &mut own).unwrap();
    }
    let (mut state, mut work) = (start(&other), workspace(&one));
    let mut scheme = MoreauJean::new(MoreauJeanSettings::default()).unwrap();
    let plan = Plan::steps(5).when_unsolved(Unsolved::End);
    let ended = run(&other, &mut scheme, &mut state, &mut work, &plan, &mut []).unwrap();
    assert!(matches!(ended, Ended::Failed(StepError::Mismatch(Mismatch::OtherModel { .. }))), "{ended:?}");
    let limits = SettlingLimits { reach: &[], margin: 0.0, tau: SettlingLimits::FIRST_TAU };
    let error = settle(&other, 0.0, &state.q, &limits, &mut work).unwrap_err();
    assert!(matches!(error, EquilibriumError::Mismatch(Mismatch::OtherModel { .. })), "{error}");
}

#[test]
fn contacts_of_one_model_are_not_solved_in_another() {
    let (one, other) = (on_ground(PairLaw::new(0.5, 0.0)), on_ground(PairLaw::new(0.5, 0.0)));
    let (state, mut of_one, mut of_other) = (start(&one), workspace(&one), workspace(&other));
    let mut stage = ContactStage::new();
    stage.find(&one, &state, &Look::new(&state.q, 1.0), &mut of_one).unwrap();
    let (over, w) = (Over::Step { h: 1e-4, weight: 0.5 }, Weights { mass: 1.0, ..Weights::default() });
    stage.pose(&one, &state, &state.v, &state.v, over).unwrap();
    of_other.factors(&other, w, &state.q, Keep::Pinned).unwrap();
    let error = stage.solve(&other, &mut of_other, &Responses::Of(w), over).unwrap_err();
    assert!(matches!(error, ContactError::Mismatch(Mismatch::OtherModel { .. })), "{error}");
    let candidate = of_one.candidates[0];
    let error = stage.add(&other, &state.q, &candidate, &state.warm, &state.memory).unwrap_err();
    assert!(matches!(error, Mismatch::OtherModel { .. }), "{error}");
    // Nor with factors that nobody asked for.
    let error = stage.solve(&one, &mut of_one, &Responses::Of(w), over).unwrap_err();
    assert_eq!(error, ContactError::Factors { part: 0 });
}

/// A block, and a block or the ground.
fn wired(change: impl Fn(&mut Vec<PointPair<2>>)) -> Result<Model<2>, ModelError> {
    let shape = Rectangle::new(0.1, 0.1).unwrap();
    let mass = MassProperties::rectangle(&shape, 0.1, 1000.0).unwrap();
    let mut parts = ModelBuilder::new();
    let body = parts.add(Blocks::new(vec![Block::new(mass, &shape); 2], Vector2::zeros())).body();
    let surface = parts.add(Ground::flat(0.0)).body();
    let (first, second) = (parts.law(PairLaw::new(0.5, 0.0)), parts.law(PairLaw::new(0.1, 0.0)));
    let pair = |pair, law, body| PointPair {
        pair,
        law,
        points: shape.corners().to_vec(),
        body,
        surface,
        kinematics: Kinematics::Deformed,
    };
    let mut pairs = vec![pair(0, first, body), pair(1, second, BodyId(1))];
    change(&mut pairs);
    parts.build(Box::new(PointDetector::new(pairs)))
}

#[test]
fn wiring_that_cannot_work_is_refused_when_the_model_is_built() {
    assert!(wired(|_| {}).is_ok());
    let refused = |change: &dyn Fn(&mut Vec<PointPair<2>>)| wired(change).unwrap_err();
    assert_eq!(refused(&|pairs| pairs[0].law = LawId(7)), ModelError::NoLaw { pair: 0, law: LawId(7), laws: 2 });
    assert_eq!(refused(&|pairs| pairs[1].pair = 0), ModelError::PairTwice { pair: 0 });
    assert_eq!(refused(&|pairs| pairs[0].body = BodyId(3)), ModelError::Body { pair: 0, body: BodyId(3), bodies: 3 });
    assert_eq!(
        refused(&|pairs| pairs[1].surface = BodyId(9)),
        ModelError::Body { pair: 1, body: BodyId(9), bodies: 3 }
    );
    assert_eq!(refused(&|pairs| pairs[0].surface = BodyId(1)), ModelError::NoSurface { pair: 0, body: BodyId(1) });
    assert_eq!(refused(&|pairs| pairs[0].surface = BodyId(0)), ModelError::Itself { pair: 0, body: BodyId(0) });
    assert_eq!(refused(&|pairs| pairs[1].points.clear()), ModelError::NoPoints { pair: 1 });
    assert_eq!(refused(&|pairs| pairs[0].points[1].x = f64::NAN).to_string(), "point 1 of pair 0 is not finite");
}

#[test]
fn loads_and_motions_of_blocks_that_are_not_there_are_refused() {
    let shape = Rectangle::new(0.1, 0.1).unwrap();
    let mass = MassProperties::rectangle(&shape, 0.1, 1000.0).unwrap();
    let blocks = || Blocks::new(vec![Block::new(mass, &shape); 2], Vector2::zeros());
    let signal: Arc<dyn Signal> = Arc::new(Formula::constant(0.0).unwrap());
    let load = |block, force| BlockLoad { block, force, couple: 0.0, signal: Arc::clone(&signal) };
    assert!(blocks().with_load(load(1, Vector2::zeros())).is_ok());
    assert_eq!(blocks().with_load(load(2, Vector2::zeros())).unwrap_err(), ModelError::Block { block: 2, blocks: 2 });
    let infinite = Vector2::new(0.0, f64::INFINITY);
    assert_eq!(blocks().with_load(load(0, infinite)).unwrap_err(), ModelError::Load { block: 0 });
    assert!(blocks().with_motion(1, BlockCoordinate::Turn, Motion::still()).is_ok());
    let refused = blocks().with_motion(usize::MAX, BlockCoordinate::X, Motion::still()).unwrap_err();
    assert_eq!(refused, ModelError::Block { block: usize::MAX, blocks: 2 });
}

#[test]
fn a_law_that_is_not_there_is_an_error() {
    let model = on_ground(PairLaw::new(0.5, 0.25));
    assert_eq!(model.law(LawId(0)), Ok(PairLaw::new(0.5, 0.25)));
    assert_eq!(model.law(LawId(1)), Err(Mismatch::Law { law: LawId(1), laws: 1 }));
}

/// A detector from outside that doesn't say whom it joins.
struct Fixed(Candidate<2>);

impl ContactDetector<2> for Fixed {
    fn detect(&self, _: &dyn Geometry<2>, _: f64, _: &mut DetectorMemory, out: &mut Candidates<2>) {
        out.clear();
        out.push(self.0);
    }

    fn capacity(&self) -> usize {
        1
    }
}

#[test]
fn candidates_of_pairs_and_bodies_that_are_not_there_end_the_step() {
    let candidate = |pair, bodies: [u32; 2]| Candidate {
        id: ContactId::new(pair, 0),
        law: LawId(pair),
        sides: bodies.map(|body| Anchor { body: BodyId(body), point: Vector2::new(0.0, -0.05) }),
        frame: plane_frame(&Vector2::y()),
        gap: -1e-3,
    };
    for (candidate, expected) in [
        (candidate(3, [0, 1]), "there is no law 3: the model has 1, numbered from 0"),
        (candidate(0, [5, 1]), "there is no body 5: the model has 2, numbered from 0"),
        (candidate(0, [0, 2]), "there is no body 2: the model has 2, numbered from 0"),
    ] {
        let shape = Rectangle::new(0.1, 0.1).unwrap();
        let mass = MassProperties::rectangle(&shape, 0.1, 1000.0).unwrap();
        let mut parts = ModelBuilder::new();
        parts.add(Blocks::new(vec![Block::new(mass, &shape)], Vector2::new(0.0, -9.81)));
        parts.add(Ground::flat(0.0));
        parts.law(PairLaw::new(0.5, 0.0));
        let model = parts.build(Box::new(Fixed(candidate))).unwrap();
        for mut scheme in all_schemes(&[]) {
            let mut state = State::new(&model, &[0.0; 3], &[0.0, -1.0, 0.0], 1e-3).unwrap();
            let mut work = workspace(&model);
            let error = (0..3)
                .find_map(|_| scheme.advance(&model, &mut state, f64::INFINITY, &mut work).err())
                .unwrap()
                .to_string();
            assert!(error.ends_with(expected), "{}: {error}", scheme.name());
        }
    }
}

#[test]
fn stages_share_a_workspace_and_a_rule_can_be_taken_back() {
    let model = beam_of(0.0015);
    let mut work = workspace(&model);
    let w = Weights { mass: 1.0, damping: 0.5e-4, stiffness: 0.25e-8 };
    let (over, responses) = (Over::Step { h: 1e-4, weight: 0.5 }, Responses::Of(w));
    let mut q = vec![0.18, 0.0675, 0.0];
    q.resize(model.size().q, 0.0);
    let mut v = vec![0.3, -1.0, 0.0];
    v.resize(model.size().v, 0.0);
    let state = State::new(&model, &q, &v, 1e-4).unwrap();
    work.factors(&model, w, &q, Keep::Pinned).unwrap();
    let solved = |stage: &mut ContactStage<2>, work: &mut Workspace<2>| {
        stage.find(&model, &state, &Look::new(&q, 1e-9), work).unwrap();
        assert_eq!(stage.len(), 2, "both feet");
        stage.pose(&model, &state, &v, &v, over).unwrap();
        stage.solve(&model, work, &responses, over).unwrap();
    };
    let (mut alone, mut one, mut other) = (ContactStage::new(), ContactStage::new(), ContactStage::new());
    solved(&mut alone, &mut work);
    let mut expected = v.clone();
    alone.respond(&model, &mut work, &responses, &mut expected).unwrap();
    // What the second stage leaves behind in the factors is not the first one's.
    solved(&mut one, &mut work);
    other.add(&model, &q, &work.candidates[1].clone(), &state.warm, &state.memory).unwrap();
    other.pose(&model, &state, &v, &v, over).unwrap();
    other.solve(&model, &mut work, &responses, over).unwrap();
    let mut found = v.clone();
    one.respond(&model, &mut work, &responses, &mut found).unwrap();
    let off = found.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 1e-12, "{off:e}");

    // Without friction and with it again.
    let tangential = |stage: &ContactStage<2>| (0..2).map(|i| stage.impulse(i).unwrap()[1].abs()).sum::<f64>();
    let rubbed = tangential(&one);
    for i in 0..2 {
        let u = one.velocity(i, &v).unwrap();
        one.set(i, u, u, Vector2::zeros(), Rule::Frictionless).unwrap();
    }
    one.solve(&model, &mut work, &responses, over).unwrap();
    assert!(tangential(&one) == 0.0 && rubbed > 0.0, "{rubbed}");
    one.pose(&model, &state, &v, &v, over).unwrap();
    one.solve(&model, &mut work, &responses, over).unwrap();
    assert!((tangential(&one) - rubbed).abs() < 1e-9 * rubbed, "friction is back");

    // In a direction that is given: as much as μ allows, along it.
    for i in 0..2 {
        let u = one.velocity(i, &v).unwrap();
        one.set(i, u, u, Vector2::zeros(), Rule::SlidesAlong(Vector2::new(0.0, 1.0))).unwrap();
    }
    one.solve(&model, &mut work, &responses, over).unwrap();
    for i in 0..2 {
        let p = one.impulse(i).unwrap();
        assert!(p[0] >= 0.0 && (p[1] + 0.5 * p[0]).abs() <= 1e-12 * p[0], "{p}");
    }
}

#[test]
fn a_step_that_was_not_begun_or_whose_contacts_are_out_of_order_is_refused() {
    let model = on_ground(PairLaw::new(0.5, 0.0));
    let (mut state, mut work) = (start(&model), workspace(&model));
    let (q, v) = (state.q.clone(), state.v.clone());
    let phase = PhaseEnd::new(PhaseKind::Step, 1e-4, &q, &v);
    assert_eq!(work.phase(&model, &phase, None), Err(StepError::NotBegun));
    work.begin(&model, &state, state.next_step(f64::INFINITY)).unwrap();
    assert!(matches!(work.finish(&model, &mut state, None, |_, _| true), Err(StepError::NoPhase)));
    work.phase(&model, &phase, None).unwrap();
    work.finish(&model, &mut state, None, |_, _| true).unwrap();
    assert!(matches!(work.finish(&model, &mut state, None, |_, _| true), Err(StepError::NotBegun)));
    assert_eq!(state.step, 1, "counted once");

    let mut stage = ContactStage::new();
    work.detect(&model, &q, 1.0).unwrap();
    for k in [1, 0] {
        let candidate = work.candidates[k];
        stage.add(&model, &q, &candidate, &state.warm, &state.memory).unwrap();
    }
    work.begin(&model, &state, state.next_step(f64::INFINITY)).unwrap();
    let error = work.phase(&model, &phase, Some(&mut stage)).unwrap_err();
    assert_eq!(error, StepError::Mismatch(Mismatch::ContactOrder { contact: 1 }));
}

/// A block that turns about the corner on which it stands: the corner would fall with g less what the turning takes, ω² r_y, and the
/// floor's force stops that.
#[test]
fn forces_over_accelerations_know_that_a_turning_corner_is_accelerated() {
    let model = on_ground(PairLaw::new(0.0, 0.0));
    let (phi, omega): (f64, f64) = (0.3, 5.0);
    let (half_width, half_height) = (0.5 * PAPER_BLOCK.width, 0.5 * PAPER_BLOCK.height);
    // From the centre to the lower left corner: turned by φ > 0, the lower right one is lifted.
    let corner = Vector2::new(-half_width, -half_height);
    let (sin, cos) = phi.sin_cos();
    let r = Vector2::new(cos * corner.x - sin * corner.y, sin * corner.x + cos * corner.y);
    let q = [0.0, -r.y, phi];
    let state = State::new(&model, &q, &[0.0, -omega * r.x, omega], 1e-4).unwrap();
    let (mut work, mut stage) = (workspace(&model), ContactStage::new());
    let w = Weights { mass: 1.0, ..Weights::default() };
    let responses = Responses::Of(w);
    work.factors(&model, w, &q, Keep::Pinned).unwrap();
    stage.find(&model, &state, &Look::new(&q, 1e-12), &mut work).unwrap();
    assert_eq!(stage.len(), 1);
    let free = [0.0, -9.81, 0.0];
    stage.pose(&model, &state, &[0.0; 3], &free, Over::Acceleration).unwrap();
    stage.solve(&model, &mut work, &responses, Over::Acceleration).unwrap();
    let mass = PAPER_BLOCK.width * PAPER_BLOCK.height * PAPER_BLOCK.depth * PAPER_BLOCK.density;
    let inertia = mass / 3.0 * (half_width.powi(2) + half_height.powi(2));
    // a_n = −g − ω² r_y + f (1/m + r_x²/I) = 0.
    let expected = (9.81 + omega * omega * r.y) / (mass.recip() + r.x * r.x / inertia);
    let found = stage.impulse(0).unwrap()[0];
    assert!((found - expected).abs() < 1e-9 * expected, "{found} {expected}");
}
