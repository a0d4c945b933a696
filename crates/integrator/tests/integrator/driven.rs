//! Subsystems with prescribed velocities, by themselves: places, rows, masses, inverses belong together.

use crate::scenes::all_schemes;
use nalgebra::Vector2;
use std::sync::Arc;
use teeter_beam::{Beam, BeamSpec, Damping, Section, Support};
use teeter_detect::{Kinematics, plane_frame};
use teeter_integrator::*;
use teeter_rigid::{MassProperties, Rectangle};

fn sine(given: Given, amplitude: f64) -> Motion {
    Motion::still().with(given, amplitude, Arc::new(Formula::harmonic(0.0, 2.0, 0.3).unwrap()))
}

fn moving_ground() -> Ground {
    Ground::moving(0.2, [Given::Displacement, Given::Velocity, Given::Acceleration].map(|given| sine(given, 0.4)))
}

fn beam(supports: [Support; 2]) -> Arc<Beam> {
    let damping = Damping::none().with_viscous(0.7).with_rayleigh_mass(0.3).with_rayleigh_stiffness(0.01);
    let section = Section::new(2.0, 3.0).unwrap();
    Arc::new(Beam::new(BeamSpec::new(1.0, 4, section).supported(supports).damped(damping)).unwrap())
}

fn moving_beam(supports: [Support; 2], surface: BeamSurface) -> BeamBody {
    BeamBody::new(beam(supports), Vector2::new(0.1, -0.2), surface)
        .with_motion([sine(Given::Velocity, 0.5), sine(Given::Acceleration, 3.0)])
}

fn driven_blocks() -> Blocks {
    let shape = Rectangle::new(0.2, 0.3).unwrap();
    let mass = MassProperties::rectangle(&shape, 0.1, 900.0).unwrap();
    Blocks::new(vec![Block::new(mass, &shape); 2], Vector2::new(0.0, -9.81))
        .with_motion(1, BlockCoordinate::Turn, sine(Given::Velocity, 0.1))
        .and_then(|blocks| blocks.with_motion(0, BlockCoordinate::Y, sine(Given::Displacement, 0.2)))
        .unwrap()
}

fn all() -> Vec<Box<dyn Subsystem<2>>> {
    vec![
        Box::new(moving_ground()),
        Box::new(moving_beam([Support::Pinned; 2], BeamSurface::Axis)),
        Box::new(moving_beam([Support::Clamped, Support::Free], BeamSurface::Top { offset: 0.02 })),
        Box::new(driven_blocks()),
    ]
}

/// Small values without a pattern.
fn wave(len: usize, phase: f64) -> Vec<f64> {
    (0..len).map(|i| 0.05 * (1.3 * i as f64 + phase).sin()).collect()
}

#[test]
fn rows_are_the_velocity_of_the_point_that_they_are_asked_for() {
    for system in all() {
        let size = system.size();
        let q = wave(size.q, 0.4);
        // A point of the surface where there is one, else of the body.
        let found = system.surface(0, &q, Kinematics::Deformed, &Vector2::new(0.43, 0.1));
        let (point, frame) = match &found {
            Some(foot) => (foot.material, plane_frame(&foot.normal)),
            None => (Vector2::new(0.1, -0.15), plane_frame(&Vector2::new(-0.6, 0.8))),
        };
        let place = |q: &[f64]| {
            let mut at = [Vector2::zeros()];
            system.place(0, q, &[point], &mut at);
            at[0]
        };
        let (mut columns, mut values) = (vec![0; size.row], vec![Vector2::zeros(); size.row]);
        let count = system.rows(0, &q, &point, &frame, &mut Rows::new(&mut columns, &mut values));
        for k in 0..size.v {
            let row: Vector2<f64> =
                (0..count).filter(|i| columns[*i] == k).map(|i| values[i]).fold(Vector2::zeros(), |a, b| a + b);
            let h = 1e-6;
            let shifted = |h: f64| {
                let mut q = q.clone();
                q[k] += h;
                place(&q)
            };
            let difference = frame * (shifted(h) - shifted(-h)) / (2.0 * h);
            assert!((row - difference).norm() < 1e-9, "column {k}: {row:?} {difference:?}");
        }
    }
}

#[test]
fn mass_damping_and_stiffness_are_symmetric_and_the_kinetic_energy_is_that_of_the_mass() {
    for system in all() {
        let n = system.size().v;
        let (q, a, b) = (wave(n, 0.1), wave(n, 0.7), wave(n, 2.0));
        let product = |w: Weights, x: &[f64]| {
            let mut y = vec![0.0; n];
            system.apply(w, &q, x, &mut y);
            y
        };
        let dot = |x: &[f64], y: &[f64]| -> f64 { x.iter().zip(y).map(|(x, y)| x * y).sum() };
        for (mass, damping, stiffness) in [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.3, 0.2, 0.1)] {
            let w = Weights { mass, damping, stiffness };
            let (ab, ba) = (dot(&a, &product(w, &b)), dot(&b, &product(w, &a)));
            assert!((ab - ba).abs() <= 1e-14 * (dot(&a, &a) + dot(&b, &b)), "{ab} {ba}");
        }
        let mass = Weights { mass: 1.0, damping: 0.0, stiffness: 0.0 };
        let (kinetic, twice) = (system.energy(&q, &a).kinetic, dot(&a, &product(mass, &a)));
        assert!((kinetic - 0.5 * twice).abs() <= 1e-15 * twice.max(1.0), "{kinetic} {twice}");
    }
}

#[test]
fn a_beam_that_only_follows_its_supports_has_all_its_mass() {
    for supports in [[Support::Pinned; 2], [Support::Clamped; 2], [Support::Free, Support::Clamped]] {
        let body = moving_beam(supports, BeamSurface::Axis);
        let n = body.size().v;
        let mut v = vec![0.0; n];
        (v[n - 2], v[n - 1]) = (2.0, -3.0);
        assert_eq!(body.energy(&vec![0.0; n], &v).kinetic, 0.5 * 3.0 * (4.0 + 9.0));
        // Damping and stiffness don't know the common motion.
        let mut f = vec![0.0; n];
        body.internal_force(&v, &v, &mut f);
        body.apply(Weights { mass: 0.0, damping: 1.0, stiffness: 1.0 }, &v, &v, &mut f);
        assert!(f.iter().all(|f| *f == 0.0));
    }
    // Free ends alone reach the motion of the whole by their own dofs: the same energy either way.
    let free = moving_beam([Support::Free, Support::Clamped], BeamSurface::Axis);
    let clamped = beam([Support::Free, Support::Clamped]);
    let shape: Vec<[f64; 2]> = (0..5).map(|i| [0.3 * f64::from(4 - i).powi(2), 0.0]).collect();
    let mut v = clamped.from_nodes(&shape).unwrap();
    let alone = clamped.kinetic_energy(&v);
    v.extend([0.0, 0.0]);
    assert_eq!(free.energy(&vec![0.0; v.len()], &v).kinetic, alone);
}

#[test]
fn the_compliance_is_the_inverse_for_the_free_velocities_and_zero_for_the_others() {
    for system in all() {
        let n = system.size().v;
        let q = wave(n, 0.1);
        let w = Weights { mass: 1.0, damping: 1e-3, stiffness: 1e-6 };
        let mut factor = system.factor(w, &q).unwrap();
        let f = wave(n, 0.9);
        let mut x = f.clone();
        factor.solve(&mut x);
        let mut back = vec![0.0; n];
        system.apply(w, &q, &x, &mut back);
        for k in 0..n {
            if system.traits().driven.contains(&k) || system.traits().held.contains(&k) {
                assert_eq!(x[k], 0.0);
            } else {
                assert!((back[k] - f[k]).abs() < 1e-14, "{k}: {} {}", back[k], f[k]);
            }
        }
    }
}

#[test]
fn only_driven_velocities_are_written_and_they_are_those_of_the_motion() {
    for system in all() {
        let driven = system.traits().driven;
        assert!(driven.is_sorted() && !driven.is_empty());
        let mut v = vec![f64::NAN; system.size().v];
        system.drive(0.3, &mut v);
        for (k, v) in v.iter().enumerate() {
            assert_eq!(v.is_finite(), driven.contains(&k));
        }
    }
    let mut v = [0.0; 6];
    driven_blocks().drive(0.3, &mut v);
    assert_eq!([v[1], v[5]], [sine(Given::Displacement, 0.2), sine(Given::Velocity, 0.1)].map(|m| m.velocity(0.3)));
}

#[test]
fn ground_slopes_through_the_origin_and_its_gap_is_perpendicular() {
    let slope = 0.3_f64;
    let at = Vector2::new(0.7, 1.9);
    let (still, moving) = (Ground::inclined(slope), Ground::moving(slope, [(); 3].map(|()| Motion::still())));
    let q = moving.coordinates(0.0);
    assert_eq!(q, [0.0, 0.0, slope]);
    assert!(still.coordinates(0.0).is_empty() && still.size() == Size { q: 0, v: 0, bodies: 1, row: 0 });
    for (ground, q) in [(&still, &[][..]), (&moving, &q[..])] {
        let foot = ground.surface(0, q, Kinematics::Deformed, &at).unwrap();
        assert!((foot.normal - Vector2::new(-slope.sin(), slope.cos())).norm() < 1e-16);
        assert!((foot.place.y - foot.place.x * slope.tan()).abs() < 1e-15, "on the line");
        let across = at - foot.place;
        assert!((across - foot.normal * across.norm()).norm() < 1e-15, "along the normal");
        let mut back = [Vector2::zeros()];
        ground.place(0, q, &[foot.material], &mut back);
        assert!((back[0] - foot.place).norm() < 1e-15);
    }
}

#[test]
fn loads_on_blocks_and_beams_follow_their_signal() {
    let pulse: Arc<dyn Signal> = Arc::new(Formula::half_sine(0.0, 1.0).unwrap());
    let load = BlockLoad { block: 1, force: Vector2::new(2.0, -3.0), couple: 0.5, signal: Arc::clone(&pulse) };
    let blocks = driven_blocks().with_load(load).unwrap();
    let mut f = [0.0; 6];
    blocks.load(0.5, &mut f);
    blocks.load(2.0, &mut f);
    assert!(blocks.traits().loaded && f == [0.0, 0.0, 0.0, 2.0, -3.0, 0.5]);

    let beam = beam([Support::Pinned; 2]);
    let mut pattern = vec![0.0; beam.dofs()];
    beam.add_point_couple(0.3, 2.0, &mut pattern).unwrap();
    let body = moving_beam([Support::Pinned; 2], BeamSurface::Axis)
        .with_load(Box::new(SignalLoad::new(pattern.clone(), pulse)));
    let mut f = vec![0.0; body.size().v];
    body.load(0.5, &mut f);
    pattern.extend([0.0, 0.0]);
    assert_eq!(f, pattern);
}

/// The work of drives is what closes the account, for every θ: of ground that shakes and turns under a rocking block, of a beam's
/// supports, of a block that is moved while another one's ground stands still.
#[test]
fn the_energy_account_holds_the_work_of_the_drives() {
    let block = crate::scenes::PAPER_BLOCK;
    let gravity = Vector2::new(0.0, -9.81);
    let surfaces: [fn() -> Box<dyn Subsystem<2>>; 3] = [
        || Box::new(Ground::moving(0.0, [0.05, 0.02, 0.05].map(|a| sine(Given::Velocity, a)))),
        || {
            let spec = BeamSpec::new(0.36, 20, Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap())
                .damped(Damping::none().with_viscous(0.4).with_rayleigh_mass(0.1).with_rayleigh_stiffness(1e-6));
            let beam = BeamBody::new(Arc::new(Beam::new(spec).unwrap()), Vector2::new(-0.18, 0.0), BeamSurface::Axis);
            Box::new(beam.with_motion([sine(Given::Velocity, 0.05), sine(Given::Acceleration, 2.0)]))
        },
        || Box::new(Ground::flat(0.0)),
    ];
    for (k, surface) in surfaces.iter().enumerate() {
        let law = PairLaw::new(0.5, 0.0);
        let model = if k < 2 {
            crate::scenes::model(&block, gravity, law, Kinematics::Deformed, surface())
        } else {
            // Pulled to the right and let down by its own weight.
            let shape = Rectangle::new(block.width, block.height).unwrap();
            let mass = MassProperties::rectangle(&shape, block.depth, block.density).unwrap();
            let mut parts = ModelBuilder::new();
            let pulled = Blocks::new(vec![Block::new(mass, &shape)], gravity);
            let body = parts.add(pulled.with_motion(0, BlockCoordinate::X, sine(Given::Velocity, 0.3)).unwrap()).body();
            let surface = parts.add_boxed(surface()).body();
            let law = parts.law(law);
            let (points, kinematics) = (shape.corners().to_vec(), Kinematics::Deformed);
            let pairs = vec![teeter_detect::PointPair { pair: 0, law, points, body, surface, kinematics }];
            parts.build(Box::new(teeter_detect::PointDetector::new(pairs))).unwrap()
        };
        for mut scheme in all_schemes(&[0.75, 1.0]) {
            let mut q = vec![0.0, 0.0675 * 0.05_f64.cos() + 0.015 * 0.05_f64.sin(), 0.05];
            q.resize(model.size().q, 0.0);
            let mut state = State::new(&model, &q, &vec![0.0; model.size().v], 1e-4).unwrap();
            let mut work = crate::scenes::workspace(&model);
            let plan = Plan::steps(2000).when_unsolved(Unsolved::End);
            let ended = run(&model, scheme.as_mut(), &mut state, &mut work, &plan, &mut []).unwrap();
            assert_eq!(ended, Ended::Complete);
            let (residual, external) = (state.ledger.relative_residual(), state.ledger.sum.external);
            assert!(state.tally.contact_steps > 100 && external.abs() > 1e-6, "{k}: it is hit and driven: {external}");
            assert!(residual <= 1e-14, "surface {k}, {}: {residual:e}", scheme.name());
        }
    }
}

/// Where everything that a contact could move is prescribed there is no impulse to be found, and no step fails for it.
#[test]
fn a_block_on_rails_goes_through_the_ground() {
    let block = crate::scenes::PAPER_BLOCK;
    let shape = Rectangle::new(block.width, block.height).unwrap();
    let mass = MassProperties::rectangle(&shape, block.depth, block.density).unwrap();
    for coordinates in [
        &[BlockCoordinate::X, BlockCoordinate::Y, BlockCoordinate::Turn][..],
        &[BlockCoordinate::Y, BlockCoordinate::Turn],
    ] {
        // With x left free nothing but the normal velocity is prescribed.
        let blocks = coordinates
            .iter()
            .fold(Blocks::new(vec![Block::new(mass, &shape)], Vector2::new(0.0, -9.81)), |blocks, axis| {
                blocks.with_motion(0, *axis, sine(Given::Velocity, 0.1)).unwrap()
            });
        let level = Ground::moving(0.0, [0.4, 0.2, 0.0].map(|a| sine(Given::Velocity, a)));
        for ground in [Ground::flat(0.0), level] {
            let mut parts = ModelBuilder::new();
            let body = parts.add(blocks.clone()).body();
            let surface = parts.add(ground).body();
            let law = parts.law(PairLaw::new(0.5, 0.0));
            let (points, kinematics) = (shape.corners().to_vec(), Kinematics::Deformed);
            let pairs = vec![teeter_detect::PointPair { pair: 0, law, points, body, surface, kinematics }];
            let model = parts.build(Box::new(teeter_detect::PointDetector::new(pairs))).unwrap();
            for mut scheme in all_schemes(&[0.75, 1.0]) {
                let mut q = vec![0.0, 0.0675, 0.0];
                q.resize(model.size().q, 0.0);
                let mut state = State::new(&model, &q, &vec![0.0; model.size().v], 1e-3).unwrap();
                let mut work = crate::scenes::workspace(&model);
                let plan = Plan::steps(500).when_unsolved(Unsolved::End);
                let ended = run(&model, scheme.as_mut(), &mut state, &mut work, &plan, &mut []).unwrap();
                assert_eq!((ended, state.tally.contact_steps), (Ended::Complete, 0), "{}", scheme.name());
                assert!(state.ledger.relative_residual() <= 1e-14);
            }
        }
    }
}
