//! A pile of polygons in a trough that grows with their number: time a step, by what it goes into,
//! while they fall and once they lie. After the word `tower`, a tower of so many boxes of 0.1 m, and
//! how far any of them has moved.
//!
//! ```text
//! cargo bench -p teeter-benches --bench pile -- 100 300 1000 tower 20 1000
//! ```
//!
//! `SECONDS_RUN`, `TOLERANCE`, `METHOD` (a solver) and `SCHEME` change the run. `WRITE`, a folder, writes
//! each pile there before it falls, for other programs (`benches/peers/piles.py`). `COMPARE`, a list of solvers or
//! nothing, adds what each method was given to solve: those of the list solve every problem of more
//! than three contacts beside it, from the same start.
#![allow(clippy::expect_used, clippy::print_stdout)] // a measurement that can't be set up has nothing to go on with

use nalgebra::Vector2;
use std::time::Instant;
use teeter_contact::{ContactProblem, ContactSolver, Law, Outcome, Stop};
use teeter_detect::{Groups, Polygon, Profile, ProfilePair, Shape, ShapeDetector};
use teeter_integrator::*;
use teeter_rigid::MassProperties;

/// Mean diameter of a stone, m.
const SIZE: f64 = 0.1;

/// Step, s.
const H: f64 = 1e-3;

/// Numbers in [0, 1), the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A pile as text: half the width of the trough, then a line for each stone: its mass centre and its
/// corners, seen from there, in m.
fn written(half: f64, outlines: &[Vec<Vector2<f64>>], q: &[f64]) -> String {
    let mut text = format!("{half:?}\n");
    for (place, outline) in q.chunks(3).zip(outlines) {
        text.push_str(&format!("{:?} {:?}", place[0], place[1]));
        outline.iter().for_each(|x| text.push_str(&format!(" {:?} {:?}", x.x, x.y)));
        text.push('\n');
    }
    text
}

/// A model of so many stones, and where they start: in rows above a trough.
fn pile(n: usize) -> (Model<2>, Vec<f64>) {
    let mut random = Random(n as u64);
    let columns = ((n as f64).sqrt() * 1.2).ceil() as usize;
    let width = columns as f64 * 1.25 * SIZE;
    let mut parts = ModelBuilder::new();
    let (mut bodies, mut outlines, mut q) = (Vec::new(), Vec::new(), Vec::new());
    for k in 0..n {
        let corners = 4 + (random.next() * 4.0) as usize;
        let radius = 0.5 * SIZE * (0.7 + 0.5 * random.next());
        let turn = random.next();
        let angle = |i: usize, r: f64| std::f64::consts::TAU * (i as f64 + 0.5 * r + turn) / corners as f64;
        let points: Vec<_> =
            (0..corners).map(|i| angle(i, random.next())).map(|a| radius * Vector2::new(a.cos(), a.sin())).collect();
        let (mass, centre) = MassProperties::polygon(&points, 0.1, 2000.0).expect("a stone");
        let points: Vec<_> = points.iter().map(|x| x - centre).collect();
        let reach = points.iter().map(|x| x.norm()).fold(0.0, f64::max);
        bodies.push(Block::within(mass, reach));
        outlines.push(points);
        let (column, row) = (k % columns, k / columns);
        let x = (column as f64 + 0.5 + 0.1 * random.next()) * 1.25 * SIZE - 0.5 * width;
        q.extend([x, (row as f64 + 1.0) * 1.25 * SIZE, 0.0]);
    }
    let half = 0.5 * width + 0.5 * SIZE;
    if let Ok(folder) = std::env::var("WRITE") {
        let file = std::path::Path::new(&folder).join(format!("pile-{n}.txt"));
        std::fs::write(file, written(half, &outlines, &q)).expect("a folder to write to");
    }
    let blocks = parts.add(Blocks::new(bodies, Vector2::new(0.0, -9.81)));
    let ground = parts.add(Ground::flat(0.0)).body();
    let law = parts.law(PairLaw::new(0.5, 0.0));
    let shapes = outlines.into_iter().enumerate();
    let shapes: Vec<(_, Shape)> =
        shapes.map(|(k, points)| (blocks.nth_body(k as u32), Polygon::new(points).expect("a stone").into())).collect();
    let pairs = (0..n as u32).map(|k| ProfilePair { pair: k, law, body: blocks.nth_body(k), ground }).collect();
    let groups =
        Groups::new((0..n as u32).map(|k| (blocks.nth_body(k), 0)).collect(), vec![vec![Some(law)]]).expect("groups");
    let walls = [[-half - 10.0, 100.0], [-half, 0.0], [half, 0.0], [half + 10.0, 100.0]].map(Vector2::from).to_vec();
    let detector = ShapeDetector::new(shapes, Vec::new()).expect("shapes");
    let detector = detector.with_profile(Profile::new(walls).expect("a trough"), pairs).expect("pairs");
    let model = parts.build(Box::new(detector.with_groups(groups, n as u32).expect("groups"))).expect("a model");
    (model, q)
}

/// Seconds that this thread has run, so that other work on the machine doesn't count; wall clock where the system doesn't say.
fn spent(clock: &Instant) -> f64 {
    let known = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = known.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| clock.elapsed().as_secs_f64(), |nanoseconds| 1e-9 * nanoseconds)
}

/// By size class and method: solves, solved, iterations, seconds, worst residual.
type Sums = std::collections::BTreeMap<(usize, String), (u32, u32, u64, f64, f64)>;

/// The solver of the run, which hands every problem of some contacts to others as well and measures
/// all of them.
struct Comparing {
    chosen: Box<dyn ContactSolver<2>>,
    others: Vec<Box<dyn ContactSolver<2>>>,
    sums: std::sync::Arc<std::sync::Mutex<Sums>>,
}

impl ContactSolver<2> for Comparing {
    fn name(&self) -> &'static str {
        self.chosen.name()
    }
    fn law(&self) -> Law {
        self.chosen.law()
    }
    fn reserve(&mut self, contacts: usize, blocks: usize) {
        self.chosen.reserve(contacts, blocks);
    }
    fn solve(&mut self, problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector2<f64>]) -> Outcome {
        let (start, clock) = (p.to_vec(), Instant::now());
        let class = [3, 12, 40, 100, 200, 400, usize::MAX].iter().position(|most| p.len() <= *most).unwrap_or(0);
        let mut sums = self.sums.lock().expect("one thread");
        let mut add = |name: String, o: &Outcome, s: f64| {
            let sum = sums.entry((class, name)).or_default();
            sum.0 += 1;
            sum.1 += u32::from(o.converged());
            sum.2 += u64::from(o.iterations);
            sum.3 += s;
            sum.4 = sum.4.max(o.residual.global);
        };
        if p.len() > 3 {
            for other in &mut self.others {
                let mut q = start.clone();
                let before = spent(&clock);
                let outcome = other.solve(problem, stop, &mut q);
                add(other.name().into(), &outcome, spent(&clock) - before);
            }
        }
        let before = spent(&clock);
        let outcome = self.chosen.solve(problem, stop, p);
        let s = spent(&clock) - before;
        add(format!("* {}", outcome.used), &outcome, s);
        outcome
    }
    fn fork(&self) -> Box<dyn ContactSolver<2>> {
        self.chosen.fork()
    }
}

/// A model of a tower of so many boxes, and where they stand: exactly on each other.
fn tower(n: usize) -> (Model<2>, Vec<f64>) {
    let mut parts = ModelBuilder::new();
    let half = 0.5 * SIZE;
    let corners = [[-half, -half], [half, -half], [half, half], [-half, half]].map(Vector2::from).to_vec();
    let (mass, _) = MassProperties::polygon(&corners, 0.1, 700.0).expect("a box");
    let bodies = vec![Block::within(mass, SIZE); n];
    let q = (0..n).flat_map(|k| [0.0, SIZE * (k as f64 + 0.5), 0.0]).collect();
    let blocks = parts.add(Blocks::new(bodies, Vector2::new(0.0, -9.81)));
    let ground = parts.add(Ground::flat(0.0)).body();
    let law = parts.law(PairLaw::new(0.5, 0.0));
    let shape = |k: u32| (blocks.nth_body(k), Polygon::new(corners.clone()).expect("a box").into());
    let shapes: Vec<(_, Shape)> = (0..n as u32).map(shape).collect();
    let pairs = (0..n as u32).map(|k| ProfilePair { pair: k, law, body: blocks.nth_body(k), ground }).collect();
    let groups =
        Groups::new((0..n as u32).map(|k| (blocks.nth_body(k), 0)).collect(), vec![vec![Some(law)]]).expect("groups");
    let level = [[-10.0, 0.0], [10.0, 0.0]].map(Vector2::from).to_vec();
    let detector = ShapeDetector::new(shapes, Vec::new()).expect("shapes");
    let detector = detector.with_profile(Profile::new(level).expect("level ground"), pairs).expect("pairs");
    (parts.build(Box::new(detector.with_groups(groups, n as u32).expect("groups"))).expect("a model"), q)
}

/// The scheme of the environment, `moreau-jean-closed` unless it says otherwise.
fn scheme() -> Box<dyn Scheme<2>> {
    let name = std::env::var("SCHEME").unwrap_or("moreau-jean-closed".into());
    match name.as_str() {
        "moreau-jean" => Box::new(MoreauJean::new(MoreauJeanSettings::default()).expect("a scheme")),
        "moreau-jean-projected" => {
            Box::new(MoreauJeanProjected::new(MoreauJeanProjectedSettings::default()).expect("a scheme"))
        }
        _ => Box::new(MoreauJeanClosed::new(MoreauJeanClosedSettings::default()).expect("a scheme")),
    }
}

fn main() {
    let mut stands = false;
    let mut counts: Vec<(usize, bool)> = Vec::new();
    for word in std::env::args().skip(1) {
        stands |= word == "tower";
        counts.extend(word.parse().ok().map(|count| (count, stands)));
    }
    let seconds = std::env::var("SECONDS_RUN").ok().and_then(|s| s.parse().ok()).unwrap_or(2.0);
    let tolerance = std::env::var("TOLERANCE").ok().and_then(|s| s.parse().ok()).unwrap_or(1e-10);
    let method = std::env::var("METHOD").unwrap_or("auto".into());
    for (n, stands) in counts {
        let (model, q) = if stands { tower(n) } else { pile(n) };
        let mut state = State::new(&model, &q, &vec![0.0; q.len()], H).expect("a state");
        let settings = SolverSettings { tolerance, ..SolverSettings::default() };
        let mut chosen = teeter_solvers::plane_solver(&method).expect("a solver");
        let sums = std::sync::Arc::default();
        if let Ok(others) = std::env::var("COMPARE") {
            let others = others
                .split(',')
                .filter(|name| !name.is_empty())
                .map(|name| teeter_solvers::plane_solver(name).expect("a solver"))
                .collect();
            chosen = Box::new(Comparing { chosen, others, sums: std::sync::Arc::clone(&sums) });
        }
        let mut work = Workspace::new(&model, chosen, settings);
        let mut scheme = scheme();
        let steps = (seconds / H).round() as u64;
        let part = steps / 10;
        for k in 0..10 {
            let counts = work.counts;
            state.tally.max_residual = 0.0;
            let from = state.q.clone();
            let clock = Instant::now();
            let before = spent(&clock);
            let ended = run(&model, scheme.as_mut(), &mut state, &mut work, &Plan::steps((k + 1) * part), &mut [])
                .expect("a run");
            let spent = spent(&clock) - before;
            let now = work.counts;
            let most = state.v.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
            // A tower from where it stood, a pile within this part of the run.
            let from = if stands { &q } else { &from };
            let moved = state.q.iter().zip(from).fold(0.0_f64, |most, (now, start)| most.max((now - start).abs()));
            println!(
                "{n} t {:.2} {:.1} us/step, contacts {:.0}, problems/step {:.2}, iterations/step {:.1}, detections {:.1}, unsolved {}, v {most:.1e}, residual {:.1e}, penetration {:.1e}, kinetic {:.2e}, moved {moved:.1e} {ended:?}",
                state.t,
                1e6 * spent / part as f64,
                (now.contacts - counts.contacts) as f64 / (now.problems - counts.problems).max(1) as f64,
                (now.problems - counts.problems) as f64 / part as f64,
                (now.iterations - counts.iterations) as f64 / part as f64,
                (now.detections - counts.detections) as f64 / part as f64,
                state.tally.unconverged_steps,
                state.tally.max_residual,
                state.tally.max_penetration,
                state.ledger.current.kinetic,
            );
        }
        let classes = ["1-3", "4-12", "13-40", "41-100", "101-200", "201-400", "401-"];
        for ((class, name), (solves, solved, iterations, seconds, worst)) in sums.lock().expect("one thread").iter() {
            println!(
                "{n} contacts {:8} {name:16} solves {solves:6} solved {solved:6} iterations/solve {:8.1} us/solve {:9.1} worst {worst:.1e}",
                classes[*class],
                *iterations as f64 / f64::from(*solves),
                1e6 * seconds / f64::from(*solves),
            );
        }
    }
}
