//! Every subsystem of the crate through the conformance harness, and that the harness finds what is wrong.

use nalgebra::Vector2;
use std::sync::Arc;
use teeter_beam::{Axial, Beam, BeamSpec, Damping, Section, Support};
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
    let damping = Damping { viscous: 0.4, rayleigh_mass: 0.3, rayleigh_stiffness: 1e-5, ..Damping::default() };
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

#[test]
fn beams_with_axial_forces_conform() {
    for axial in [Axial::Held, Axial::Elastic { held: [true, false] }] {
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
