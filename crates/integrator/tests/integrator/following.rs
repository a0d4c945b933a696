//! Matrices that change with the coordinates, and potentials for which a θ step conserves another energy.

use nalgebra::Vector2;
use std::sync::{Arc, Mutex};
use teeter_beam::{Axial, Beam, BeamSpec, Section};
use teeter_detect::{Frame, PointDetector};
use teeter_integrator::*;

/// Mass m = 1 on a spring of force −k q − c q³.
struct Spring {
    k: f64,
    c: f64,
    /// Whether K = k + 3c q² is part of W.
    implicit: bool,
    /// Coordinates that W was updated to.
    updates: Arc<Mutex<Vec<f64>>>,
}

struct SpringCompliance {
    weights: Weights,
    spring: [f64; 2],
    matrix: f64,
    updates: Arc<Mutex<Vec<f64>>>,
}

impl Spring {
    fn stiffness(&self, q: f64) -> f64 {
        if self.implicit { self.k + 3.0 * self.c * q * q } else { 0.0 }
    }
}

impl Dynamics<2> for Spring {
    fn size(&self) -> Size {
        Size { q: 1, v: 1, bodies: 0, row: 0 }
    }

    fn traits(&self) -> Traits {
        Traits::free().following_coordinates(self.implicit && self.c != 0.0)
    }

    fn internal_force(&self, q: &[f64], _v: &[f64], f: &mut [f64]) {
        f[0] -= self.k * q[0] + self.c * q[0].powi(3);
    }

    fn apply(&self, w: Weights, q: &[f64], x: &[f64], y: &mut [f64]) {
        y[0] += (w.mass + w.stiffness * self.stiffness(q[0])) * x[0];
    }

    fn energy(&self, q: &[f64], v: &[f64]) -> Energy {
        let elastic = 0.5 * self.k * q[0].powi(2) + 0.25 * self.c * q[0].powi(4);
        Energy { kinetic: 0.5 * v[0] * v[0], elastic, gravity: 0.0 }
    }

    fn factor(&self, w: Weights, q: &[f64]) -> Result<Box<dyn Compliance<2>>, FactorError> {
        let matrix = w.mass + w.stiffness * self.stiffness(q[0]);
        let spring = if self.implicit { [self.k, self.c] } else { [0.0; 2] };
        Ok(Box::new(SpringCompliance { weights: w, spring, matrix, updates: Arc::clone(&self.updates) }))
    }

    fn linearised(&self) -> Option<&dyn Linearised> {
        Some(self)
    }
}

impl Bodies<2> for Spring {
    fn place(&self, _: u32, _: &[f64], _: &[Vector2<f64>], _: &mut [Vector2<f64>]) {}

    fn rows(&self, _: u32, _: &[f64], _: &Vector2<f64>, _: &Frame<2>, _: &mut Rows<'_, 2>) -> usize {
        0
    }
}

impl Linearised for Spring {
    /// With θ = ½ and M alone in W the step is the leapfrog, which keeps ½ k q² + ½ (1 − h²k/4) v².
    fn modified_energy(&self, h: f64, _q: &[f64], v: &[f64]) -> f64 {
        if self.implicit { 0.0 } else { -h * h * self.k * v[0] * v[0] / 8.0 }
    }
}

impl Compliance<2> for SpringCompliance {
    fn weights(&self) -> Weights {
        self.weights
    }

    fn refactor(&mut self, w: Weights, q: &[f64]) -> Result<(), FactorError> {
        self.weights = w;
        self.matrix = w.mass + w.stiffness * (self.spring[0] + 3.0 * self.spring[1] * q[0] * q[0]);
        Ok(())
    }

    fn update(&mut self, q: &[f64]) {
        self.updates.lock().unwrap().push(q[0]);
        self.matrix =
            self.weights.mass + self.weights.stiffness * (self.spring[0] + 3.0 * self.spring[1] * q[0] * q[0]);
    }

    fn solve(&mut self, f: &mut [f64]) {
        f[0] /= self.matrix;
    }
}

fn schemes(theta: f64) -> Vec<Box<dyn Scheme<2>>> {
    let page = MoreauJean::new(MoreauJeanSettings { theta, ..MoreauJeanSettings::default() }).unwrap();
    let mut schemes: Vec<Box<dyn Scheme<2>>> = vec![Box::new(page)];
    if theta == 0.5 {
        schemes.push(Box::new(MoreauJeanClosed::new(MoreauJeanClosedSettings::default()).unwrap()));
    }
    schemes
}

fn model(spring: Spring) -> Model<2> {
    let mut parts = ModelBuilder::new();
    parts.add(spring);
    parts.build(Box::new(PointDetector::new(vec![]))).unwrap()
}

#[test]
fn a_step_takes_w_where_it_takes_the_forces() {
    let (k, c, h) = (4.0, 3.0, 0.1);
    let (q0, v0) = (0.7, -0.3);
    for theta in [0.5, 0.8] {
        for mut scheme in schemes(theta) {
            let updates = Arc::default();
            let model = model(Spring { k, c, implicit: true, updates: Arc::clone(&updates) });
            let mut state = State::new(&model, &[q0], &[v0], h).unwrap();
            let mut work = crate::scenes::workspace(&model);
            scheme.start(&model, &mut state, &mut work).unwrap();
            scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap();
            let at = q0 + h * theta * v0;
            assert_eq!(*updates.lock().unwrap(), [at], "{}: once", scheme.name());
            let matrix = 1.0 + (h * theta).powi(2) * (k + 3.0 * c * at * at);
            let v1 = v0 - h * (k * at + c * at.powi(3)) / matrix;
            assert!((state.v[0] - v1).abs() < 1e-15, "{}: {} {v1}", scheme.name(), state.v[0]);
        }
    }
}

#[test]
fn what_the_step_conserves_in_place_of_the_energy_is_booked_as_numerical() {
    for mut scheme in schemes(0.5) {
        let model = model(Spring { k: 4.0, c: 0.0, implicit: false, updates: Arc::default() });
        let mut state = State::new(&model, &[0.7], &[-0.3], 0.3).unwrap();
        let mut work = crate::scenes::workspace(&model);
        scheme.start(&model, &mut state, &mut work).unwrap();
        let mut largest = 0.0_f64;
        for _ in 0..1000 {
            largest = largest
                .max(scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap().energy().numerical.abs());
        }
        assert!(largest > 1e-3 && state.ledger.relative_residual() < 1e-15, "{largest} {:?}", state.ledger);
    }
}

#[test]
fn a_beam_held_along_its_axis_keeps_the_energy_identity_where_it_is_stretched() {
    let section = Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap();
    let beam = Arc::new(Beam::new(BeamSpec::new(0.36, 20, section).axial(Axial::Held)).unwrap());
    // Half a sine, deflected by some six thicknesses: the axial force is most of the stiffness.
    let (size, k) = (0.01, std::f64::consts::PI / 0.36);
    let nodes: Vec<_> =
        beam.node_positions().iter().map(|x| [size * (k * x).sin(), size * k * (k * x).cos()]).collect();
    let q = beam.from_nodes(&nodes).unwrap();
    for backend in [WBackend::Auto, WBackend::CachedColumns] {
        for mut scheme in schemes(0.5) {
            let mut parts = ModelBuilder::new();
            parts.add(crate::scenes::beam_body(&beam).with_backend(backend));
            let model = parts.build(Box::new(PointDetector::new(vec![]))).unwrap();
            let mut state = State::new(&model, &q, &vec![0.0; q.len()], 1e-4).unwrap();
            let mut work = crate::scenes::workspace(&model);
            scheme.start(&model, &mut state, &mut work).unwrap();
            let start = state.ledger.current.total();
            for _ in 0..2000 {
                let step = scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap();
                let numerical = step.energy().numerical.abs();
                // Where the rounds for the tension end; with σ in place of s it is 1e-6 and more.
                assert!(numerical < 1e-12 * start, "{numerical:e} of {start}");
            }
            assert!((state.ledger.current.total() / start - 1.0).abs() < 1e-11, "the energy itself");
            assert!(state.ledger.relative_residual() < 1e-14, "{:e}", state.ledger.relative_residual());
        }
    }
}
