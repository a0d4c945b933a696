//! The θ step of `docs/theory.md` §5 with the beam alone, and what it does to the energy.

use teeter_beam::{Beam, Factor, Load, MatrixWeights, Support};

pub(crate) struct Stepper<'a> {
    beam: &'a Beam,
    load: Option<&'a dyn Load>,
    h: f64,
    theta: f64,
    factor: Factor,
    pub(crate) step: u32,
    pub(crate) q: Vec<f64>,
    pub(crate) v: Vec<f64>,
    p: [Vec<f64>; 2],
    f: Vec<f64>,
}

impl<'a> Stepper<'a> {
    pub(crate) fn new(
        beam: &'a Beam,
        h: f64,
        theta: f64,
        q: Vec<f64>,
        v: Vec<f64>,
        load: Option<&'a dyn Load>,
    ) -> Self {
        let k = h * theta;
        let factor = beam.factor(MatrixWeights { mass: 1.0, damping: k, stiffness: k * k }).unwrap();
        let zero = vec![0.0; beam.dofs()];
        let mut p = [zero.clone(), zero.clone()];
        if let Some(load) = load {
            load.add(beam, 0.0, &mut p[1]);
        }
        Self { beam, load, h, theta, factor, step: 0, q, v, p, f: zero }
    }

    pub(crate) fn time(&self) -> f64 {
        f64::from(self.step) * self.h
    }

    pub(crate) fn advance(&mut self) {
        let (h, theta) = (self.h, self.theta);
        self.step += 1;
        self.p.swap(0, 1);
        self.p[1].fill(0.0);
        if let Some(load) = self.load {
            load.add(self.beam, self.time(), &mut self.p[1]);
        }
        for i in 0..self.f.len() {
            self.f[i] = theta * self.p[1][i] + (1.0 - theta) * self.p[0][i];
        }
        self.beam.add_stiffness_product(-1.0, &self.q, &mut self.f);
        self.beam.add_stiffness_product(-h * theta, &self.v, &mut self.f);
        self.beam.add_damping_product(-1.0, &self.v, &mut self.f);
        self.factor.solve(&mut self.f);
        for i in 0..self.f.len() {
            let v1 = self.v[i] + h * self.f[i];
            self.q[i] += h * (theta * v1 + (1.0 - theta) * self.v[i]);
            self.v[i] = v1;
        }
    }

    pub(crate) fn energy(&self) -> f64 {
        self.beam.kinetic_energy(&self.v) + self.beam.elastic_energy(&self.q)
    }
}

/// Nodes of the sum of sines Σ a_k sin(kπx/L), with their slopes.
pub(crate) fn sines(beam: &Beam, terms: &[(f64, f64)]) -> Vec<f64> {
    let span = beam.spec().span;
    let nodes: Vec<[f64; 2]> = (0..beam.nodes())
        .map(|i| i as f64 / (beam.nodes() - 1) as f64 * std::f64::consts::PI)
        .map(|s| {
            terms.iter().fold([0.0, 0.0], |[w, slope], (k, a)| {
                [w + a * (k * s).sin(), slope + a * k * std::f64::consts::PI / span * (k * s).cos()]
            })
        })
        .collect();
    beam.from_nodes(&nodes).unwrap()
}

/// θ = ½ conserves the energy of an undamped beam. Measured: relative drift 1.5e-12 at most, a random walk of rounding.
#[test]
fn energy_of_an_undamped_beam_stays_for_a_hundred_thousand_steps() {
    let beam = super::beam(20, [Support::Pinned; 2]);
    let mut run = Stepper::new(&beam, 1e-3, 0.5, vec![0.0; beam.dofs()], sines(&beam, &[(1.0, 1.0), (3.0, 0.5)]), None);
    let start = run.energy();
    let mut drift = 0.0_f64;
    for _ in 0..100_000 {
        run.advance();
        drift = drift.max((run.energy() / start - 1.0).abs());
    }
    assert!(drift < 3e-11, "{drift:e}");
}

/// `docs/theory.md` §7 for one beam: what θ = 1 takes is ½(ΔvᵀM Δv + ΔqᵀK Δq), to rounding.
#[test]
fn a_larger_theta_takes_the_energy_that_the_identity_says() {
    let beam = super::beam(20, [Support::Clamped, Support::Pinned]);
    let nodes: Vec<[f64; 2]> =
        (0..21).map(|i| f64::from(i) / 20.0).map(|s| [s * s * (1.0 - s), (2.0 * s - 3.0 * s * s) / 0.36]).collect();
    let mut run = Stepper::new(&beam, 1e-3, 1.0, beam.from_nodes(&nodes).unwrap(), vec![0.0; beam.dofs()], None);
    let start = run.energy();
    for _ in 0..100 {
        let (q, v, before) = (run.q.clone(), run.v.clone(), run.energy());
        run.advance();
        let jump = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>();
        let lost = beam.kinetic_energy(&jump(&run.v, &v)) + beam.elastic_energy(&jump(&run.q, &q));
        assert!((run.energy() - before + lost).abs() < 1e-11 * start);
    }
    assert!(run.energy() < 0.1 * start);
}

/// Viscous damping alone: the envelope of mode 1 falls like exp(−c t/(2ρA)).
#[test]
fn the_first_mode_decays_with_the_damping_ratio_it_was_given() {
    let mut spec = super::spec(20, [Support::Pinned; 2]);
    spec.damping.viscous = spec.viscous_for_ratio(1, 0.01).unwrap();
    let beam = Beam::new(spec.clone()).unwrap();
    let mut run = Stepper::new(&beam, 1e-4, 0.5, sines(&beam, &[(1.0, 1e-3)]), vec![0.0; beam.dofs()], None);
    let start = run.energy();
    while run.step < 5000 {
        run.advance();
    }
    let omega = spec.circular_frequency(1).unwrap();
    let expected = (-2.0 * 0.01 * omega * run.time()).exp();
    // The energy of a damped oscillation swings about its mean by ± ζ.
    assert!((run.energy() / start / expected - 1.0).abs() < 0.02);
}
