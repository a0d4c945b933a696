//! Every subsystem of the crate through the conformance harness, and that the harness finds what is wrong.

use nalgebra::Vector2;
use std::sync::Arc;
use teeter_beam::{Axial, Beam, BeamSpec, Damping, ModalBasis, Section, Support};
use teeter_detect::{Frame, Kinematics, SurfacePoint};
use teeter_integrator::conformance::{Case, Property, check, check_scheme};
use teeter_integrator::*;
use teeter_rigid::{MassProperties, Rectangle};

/// A θ = ½ step of 1e-4 s.
const WEIGHTS: Weights = Weights { mass: 1.0, damping: 0.5e-4, stiffness: 0.25e-8 };

fn motion(amplitude: f64) -> Motion {
    Motion::still().with(Given::Displacement, amplitude, Arc::new(Formula::harmonic(0.0, 3.0, 0.2).unwrap()))
}

#[test]
fn blocks_conform() {
    let shape = Rectangle::new(0.1, 0.2).unwrap();
    let block = Block::new(MassProperties::rectangle(&shape, 0.1, 2700.0).unwrap(), &shape);
    let points = (0..2).flat_map(|body| shape.corners().map(|corner| (body, corner))).collect();
    let case = Case { q: vec![0.3, 0.1, 0.2, -0.4, 0.2, -1.1], t: 0.3, weights: WEIGHTS, points, ..Case::default() };
    let blocks = Blocks::new(vec![block; 2], Vector2::new(0.5, -9.81));
    assert_eq!(check(&blocks, &case), []);
    let load = BlockLoad {
        block: 1,
        force: Vector2::new(1.0, 2.0),
        couple: 0.3,
        signal: Arc::new(Formula::constant(2.0).unwrap()),
    };
    assert_eq!(
        check(
            &blocks
                .with_load(load)
                .unwrap()
                .with_motion(0, BlockCoordinate::Turn, motion(0.1))
                .unwrap()
                .with_motion(1, BlockCoordinate::X, motion(0.2))
                .unwrap(),
            &case
        ),
        []
    );
}

#[test]
fn grounds_conform() {
    let places = vec![(0, Vector2::new(0.3, 0.4)), (0, Vector2::new(-0.2, 0.1))];
    let still = Case { t: 0.3, weights: WEIGHTS, places: places.clone(), ..Case::default() };
    assert_eq!(check(&Ground::flat(0.2), &still), []);
    assert_eq!(check(&Ground::inclined(0.3), &still), []);
    let moving = Ground::moving(0.3, [motion(0.1), motion(0.2), motion(0.05)]);
    assert_eq!(check(&moving, &Case { q: vec![0.1, -0.2, 0.35], ..still }), []);
}

fn beam(elements: usize, supports: [Support; 2]) -> Arc<Beam> {
    axial_beam(elements, supports, Axial::Free)
}

fn axial_beam(elements: usize, supports: [Support; 2], axial: Axial) -> Arc<Beam> {
    let section = Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap();
    let damping = Damping::none().with_viscous(0.4).with_rayleigh_mass(0.3).with_rayleigh_stiffness(1e-5);
    Arc::new(
        Beam::new(BeamSpec::new(0.36, elements, section).supported(supports).damped(damping).axial(axial)).unwrap(),
    )
}

/// A deformed beam, touched at so many places all along it.
fn touched(beam: &Beam, contacts: usize) -> Case {
    let mut q = vec![0.0; beam.dofs()];
    beam.add_uniform_load(-30.0, &mut q).unwrap();
    beam.add_point_load(0.1, 1.0, &mut q).unwrap();
    beam.solve_static(&mut q).unwrap();
    let place = |k: usize| (0, Vector2::new(0.1 + 0.36 * (k as f64 + 0.3) / contacts as f64, 0.5));
    Case { q, t: 0.3, weights: WEIGHTS, places: (0..contacts).map(place).collect(), points: vec![] }
}

#[test]
fn beams_conform_however_w_is_held() {
    // Few contacts; more than responses are kept of; more dofs than columns are kept of.
    for (elements, contacts) in [(4, 3), (20, 12), (60, 40)] {
        for supports in [[Support::Pinned; 2], [Support::Clamped, Support::Free]] {
            let beam = beam(elements, supports);
            for surface in [BeamSurface::Axis, BeamSurface::Top { offset: 0.00075 }] {
                for backend in [WBackend::Auto, WBackend::Banded, WBackend::Sparse, WBackend::CachedColumns] {
                    let body = || {
                        let body = BeamBody::new(Arc::clone(&beam), Vector2::new(0.1, 0.2), surface);
                        body.with_backend(backend)
                    };
                    let mut case = touched(&beam, contacts);
                    assert_eq!(check(&body(), &case), [], "{elements} {supports:?} {surface:?} {backend:?}");
                    case.q.extend([0.001, -0.02]);
                    let moving = body().with_motion([motion(0.1), motion(0.2)]);
                    assert_eq!(check(&moving, &case), [], "moving {elements} {supports:?} {surface:?} {backend:?}");
                }
            }
        }
    }
}

/// All four bodies of a beam, on its elements and in its modes: places below are feet of the lower surface, points of both fibres move
/// as the sections turn.
#[test]
fn both_faces_of_beams_and_their_fibres_conform() {
    let beam = beam(8, [Support::Pinned, Support::Clamped]);
    let basis = ModalBasis::new(&beam, 6, &[]).unwrap();
    for offset in [0.0, 0.00075] {
        let surface = if offset > 0.0 { BeamSurface::Top { offset } } else { BeamSurface::Axis };
        let mut case = touched(&beam, 3);
        case.places.extend([0.15, 0.3].map(|x| (BeamFace::Lower.body(), Vector2::new(x, -0.2))));
        case.points = [0.0, 0.07, 0.36]
            .iter()
            .flat_map(|x| {
                [(BeamFace::Upper, offset), (BeamFace::Lower, -offset)]
                    .map(|(face, y)| (face.fibre(), Vector2::new(*x, y)))
            })
            .collect();
        let elements = BeamBody::new(Arc::clone(&beam), Vector2::new(0.1, 0.2), surface);
        assert_eq!(check(&elements, &case), [], "offset {offset}");
        let place = Vector2::new(0.1, 0.2);
        let ratios = vec![0.01; basis.len()];
        let modes = ModalBeam::with_ratios(Arc::clone(&beam), basis.clone(), &ratios, place, surface).unwrap();
        case.q = (0..basis.len()).map(|k| 1e-3 / (k + 1) as f64).collect();
        assert_eq!(check(&modes, &case), [], "in modes, offset {offset}");
    }
}

/// Where a beam comes out furthest along a direction, against a fine search over its surface; and its ends.
#[test]
fn summits_of_a_beam_are_where_a_fine_search_finds_them() {
    let beam = beam(8, [Support::Pinned, Support::Clamped]);
    let mut q = vec![0.0; beam.dofs()];
    for (x, force) in [(0.06, 3.0), (0.16, -5.0), (0.27, 9.0)] {
        beam.add_point_load(x, force, &mut q).unwrap();
    }
    beam.solve_static(&mut q).unwrap();
    let at = Vector2::new(0.1, 0.2);
    for surface in [BeamSurface::Axis, BeamSurface::Top { offset: 0.002 }] {
        let body = BeamBody::new(Arc::clone(&beam), at, surface);
        for (face, sign) in [(BeamFace::Upper, 1.0), (BeamFace::Lower, -1.0)] {
            let number = face.fibre();
            let offset = sign * if surface == BeamSurface::Axis { 0.0 } else { 0.002 };
            let place = |x: f64| {
                let mut out = [Vector2::zeros()];
                body.place(number, &q, &[Vector2::new(x, offset)], &mut out);
                out[0]
            };
            for tilt in [-0.01_f64, 0.0, 0.02] {
                let direction = Vector2::new(-tilt.sin(), tilt.cos()) * sign;
                let between = [Vector2::new(0.12, 0.2), Vector2::new(0.44, 0.2)];
                let mut found = Vec::new();
                body.summits(number, &q, &direction, &between, &mut |summit| found.push(summit.point));
                let n = 20_000;
                let height = |k: usize| direction.dot(&place(0.02 + 0.32 * k as f64 / n as f64));
                let searched: Vec<usize> =
                    (1..n).filter(|k| height(*k) > height(k - 1) && height(*k) >= height(k + 1)).collect();
                assert_eq!(found.len(), searched.len(), "{surface:?} {face:?} {tilt}");
                for (summit, k) in found.iter().zip(searched) {
                    assert!((summit.material.x - 0.02 - 0.32 * k as f64 / n as f64).abs() < 2e-5);
                    assert!((summit.place - place(summit.material.x)).norm() < 1e-15);
                    assert!((summit.normal - direction).norm() < 1e-9, "{} {direction}", summit.normal);
                }
            }
            for (end, x) in body.ends(number, &q).iter().zip([0.0, 0.36]) {
                let end = end.unwrap();
                assert_eq!((end.material, end.place), (Vector2::new(x, offset), place(x)));
            }
        }
    }
}

/// A straight beam comes out nowhere, but bears at a support between its ends; one that is bent there at the crest beside it.
#[test]
fn a_beam_bears_at_its_supports_and_where_it_comes_out() {
    let section = Section::rectangle(0.03, 0.002, 69e9, 2700.0).unwrap();
    let spec = BeamSpec::new(0.6, 12, section).support_at(0.2, Support::Pinned).support_at(0.4, Support::Guided);
    let beam = Arc::new(Beam::new(spec).unwrap());
    let body = BeamBody::new(Arc::clone(&beam), Vector2::new(0.1, 0.2), BeamSurface::Axis);
    let found = |q: &[f64], from: f64, tilt: f64| {
        let direction = Vector2::new(-tilt.sin(), tilt.cos());
        let between = [Vector2::new(from, 0.2), Vector2::new(0.62, 0.2)];
        let mut found = Vec::new();
        let number = BeamFace::Upper.fibre();
        body.summits(number, q, &direction, &between, &mut |summit| {
            found.push((summit.point.material.x, summit.support.is_some()))
        });
        found
    };
    let mut q = vec![0.0; beam.dofs()];
    // Guided, the beam is held against turning only.
    let node = beam.node_positions()[4];
    assert_eq!(found(&q, 0.15, 0.0), [(node, true)]);
    assert_eq!(found(&q, 0.15, 1e-3), [(node, true)], "a side at an angle comes down on it, too");
    assert_eq!(found(&q, 0.31, 0.0), [], "beside it");
    beam.add_point_load(0.1, -1.0, &mut q).unwrap();
    beam.add_point_load(0.3, -1.0, &mut q).unwrap();
    beam.solve_static(&mut q).unwrap();
    let crest = found(&q, 0.15, 0.0);
    let [(x, supported)] = crest[..] else { panic!("{crest:?}") };
    assert!(!supported && (x - 0.2).abs() < 0.05, "{crest:?}");
    // Bent by so little that a base may come down flat on it, it bears at both.
    q.iter_mut().for_each(|q| *q *= 1e-2);
    let both = found(&q, 0.15, 0.0);
    assert!(both.len() == 2 && both.contains(&(node, true)), "{both:?}");
}

#[test]
fn beams_with_axial_forces_conform() {
    for axial in [Axial::Held, Axial::elastic([true, false])] {
        let beam = axial_beam(24, [Support::Pinned, Support::Clamped], axial);
        let mut case = touched(&axial_beam(24, [Support::Pinned, Support::Clamped], Axial::Free), 5);
        case.q.resize(beam.dofs(), 0.0);
        for backend in [WBackend::Auto, WBackend::Banded, WBackend::Sparse, WBackend::CachedColumns] {
            let body = BeamBody::new(Arc::clone(&beam), Vector2::new(0.1, 0.2), BeamSurface::Top { offset: 0.00075 });
            assert_eq!(check(&body.with_backend(backend), &case), [], "{axial:?} {backend:?}");
        }
    }
}

/// A mass on a spring, with one thing wrong.
struct Wrong(Property);

struct WrongCompliance {
    weights: Weights,
    wrong: Property,
    coupled: u32,
}

impl Dynamics<2> for Wrong {
    fn size(&self) -> Size {
        Size { q: 2, v: 2, bodies: 1, row: 2 }
    }

    fn traits(&self) -> Traits {
        Traits::free().driven(if self.0 == Property::Sizes { vec![2] } else { vec![] })
    }

    fn stretching(&self) -> Option<&dyn teeter_integrator::Stretching> {
        if self.0 == Property::Stretching { Some(self) } else { None }
    }

    fn internal_force(&self, q: &[f64], v: &[f64], f: &mut [f64]) {
        let c = if self.0 == Property::Damping { 1.0 } else { 0.0 };
        f[0] -= q[0] + c * v[0];
        f[1] -= if self.0 == Property::Force { 1.01 } else { 1.0 } * q[1];
    }

    fn apply(&self, w: Weights, _q: &[f64], x: &[f64], y: &mut [f64]) {
        let c = if self.0 == Property::Damping { w.damping } else { 0.0 };
        y[0] += (w.mass + w.stiffness + c) * x[0];
        y[1] += (w.mass + w.stiffness) * x[1] + if self.0 == Property::Product { 1e-3 * w.mass * x[0] } else { 0.0 };
    }

    fn retract(&self, q: &[f64], v: &[f64], tau: f64, out: &mut [f64]) {
        out[0] = q[0] + tau * v[0];
        out[1] = q[1] + tau * v[1] + if self.0 == Property::Retract { 1e-3 * tau * tau } else { 0.0 };
    }

    fn energy(&self, q: &[f64], v: &[f64]) -> Energy {
        let mass = if self.0 == Property::KineticEnergy { 1.1 } else { 1.0 };
        let kinetic = 0.5 * mass * (v[0] * v[0] + v[1] * v[1]);
        Energy { kinetic, elastic: 0.5 * (q[0] * q[0] + q[1] * q[1]), gravity: 0.0 }
    }

    fn load(&self, _t: f64, f: &mut [f64]) {
        f[0] += if self.0 == Property::Load { 1.0 } else { 0.0 };
    }

    fn drive(&self, _t: f64, v: &mut [f64]) {
        v[0] *= if self.0 == Property::Drive { 2.0 } else { 1.0 };
    }

    fn factor(&self, w: Weights, _q: &[f64]) -> Result<Box<dyn Compliance<2>>, FactorError> {
        Ok(Box::new(WrongCompliance { weights: w, wrong: self.0, coupled: 0 }))
    }
}

impl teeter_integrator::Stretching for Wrong {
    fn stiffness(&self) -> f64 {
        2.0
    }

    fn form(&self, x: &[f64], y: &[f64]) -> f64 {
        x[0] * y[0] + x[1] * y[1]
    }

    fn add_product(&self, a: f64, x: &[f64], y: &mut [f64]) {
        y.iter_mut().zip(x).for_each(|(y, x)| *y += a * x);
    }

    /// All of them, while the tension is said to act beside them.
    fn force_beside(&self, q: &[f64], v: &[f64], f: &mut [f64]) {
        self.internal_force(q, v, f);
    }
}

impl Bodies<2> for Wrong {
    fn place(&self, _: u32, q: &[f64], local: &[Vector2<f64>], out: &mut [Vector2<f64>]) {
        for (x, l) in out.iter_mut().zip(local) {
            *x = l + Vector2::new(q[0], q[1]);
        }
    }

    fn has_surface(&self, _body: u32) -> bool {
        true
    }

    fn surface(&self, _: u32, q: &[f64], _: Kinematics, at: &Vector2<f64>) -> Option<SurfacePoint<2>> {
        let place = Vector2::new(at.x, q[1]);
        let off = if self.0 == Property::Foot { 1e-6 } else { 0.0 };
        Some(SurfacePoint { place, normal: Vector2::y(), material: Vector2::new(at.x - q[0] + off, 0.0) })
    }

    fn bias(&self, _: u32, _: &[f64], _: &[f64], _: &Vector2<f64>, _: &Frame<2>) -> Option<Vector2<f64>> {
        Some(Vector2::new(0.0, if self.0 == Property::Bias { 1e-3 } else { 0.0 }))
    }

    fn rows(&self, _: u32, _: &[f64], _: &Vector2<f64>, frame: &Frame<2>, out: &mut Rows<'_, 2>) -> usize {
        for k in 0..2 {
            out.columns[k] = k;
            out.values[k] = frame.column(k).into();
        }
        out.values[1] *= if self.0 == Property::Rows { 1.001 } else { 1.0 };
        2
    }
}

impl Compliance<2> for WrongCompliance {
    fn weights(&self) -> Weights {
        self.weights
    }

    fn refactor(&mut self, w: Weights, _q: &[f64]) -> Result<(), FactorError> {
        if self.wrong != Property::Refactor {
            self.weights = w;
        }
        Ok(())
    }

    fn solve(&mut self, f: &mut [f64]) {
        let matrix = self.weights.mass + self.weights.stiffness;
        f[0] /= matrix + if self.wrong == Property::Damping { self.weights.damping } else { 0.0 };
        f[1] /= matrix * if self.wrong == Property::Inverse { 1.1 } else { 1.0 };
    }

    fn couple(&mut self, rows: &PartRows<'_, 2>, _scratch: &mut [f64], h: &mut Coupling<'_, 2>) {
        self.coupled += 1;
        let drift = if self.wrong == Property::Couple { 1e-15 * f64::from(self.coupled) } else { 0.0 };
        for (i, columns_i, values_i) in rows.iter() {
            for (j, _, values_j) in rows.iter() {
                for (&c, (a, b)) in columns_i.iter().zip(values_i.iter().zip(values_j)) {
                    let mut unit = [0.0; 2];
                    unit[c] = 1.0 + drift;
                    self.solve(&mut unit);
                    h.add(i, j, &(a * b.transpose() * unit[c]));
                }
            }
        }
    }

    fn respond(&mut self, rows: &PartRows<'_, 2>, p: &[Vector2<f64>], scratch: &mut [f64], v: &mut [f64]) {
        scratch.fill(0.0);
        rows.add_generalised_impulse(p, scratch);
        self.solve(scratch);
        let factor = if self.wrong == Property::Respond { 0.99 } else { 1.0 };
        v.iter_mut().zip(scratch.iter()).for_each(|(v, dv)| *v += factor * dv);
    }
}

#[test]
fn the_harness_finds_what_is_wrong_and_nothing_else() {
    let case = Case {
        q: vec![0.3, -0.2],
        t: 0.1,
        weights: Weights { mass: 1.0, damping: 0.1, stiffness: 0.01 },
        points: vec![(0, Vector2::new(0.1, 0.0))],
        places: vec![(0, Vector2::new(0.5, 1.0))],
    };
    use Property::*;
    for wrong in [
        Sizes,
        Retract,
        Drive,
        Load,
        Foot,
        Rows,
        Bias,
        Product,
        Damping,
        KineticEnergy,
        Force,
        Inverse,
        Refactor,
        Stretching,
        Couple,
        Respond,
    ] {
        let found: Vec<Property> = check(&Wrong(wrong), &case).iter().map(|failure| failure.property).collect();
        assert!(!found.is_empty() && found.contains(&wrong), "{wrong:?}: {found:?}");
    }
}

#[test]
fn schemes_conform() {
    for entry in schemes() {
        let made = (
            || entry.make().unwrap(),
            || -> Box<dyn teeter_contact::ContactSolver<2>> { Box::new(teeter_solvers::Auto::new()) },
        );
        assert_eq!(check_scheme(&made).unwrap(), [], "{}", entry.name);
    }
}
