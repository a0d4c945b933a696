//! Scenes of many blocks: what they are told to cost, and when they are too many.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use teeter_contact::{ContactProblem, ContactSolver, Law, Outcome, Stop, Vector};
use teeter_scenario::load;
use teeter_scenario::output_size::{MOST_OPERATOR_BYTES, accuracy_of_seconds, expected_seconds, operator_bytes};
use teeter_scenario::simulation::Simulation;

/// So many blocks of 1 cm beside each other, on the ground or on a beam.
fn row_of_blocks(blocks: usize, on: &str) -> String {
    let mut text = String::from(
        "[time]\nend = '20 ms'\nstep = '100 us'\n[ground]\n[material.m]\ndensity = '2700 kg/m^3'\nyoungs_modulus = '69 GPa'\n\
         [beam.b]\nmaterial = 'm'\nspan = '50 m'\nwidth = '3 cm'\nthickness = '1 m'\nelements = 200\n\
         supports = ['pinned', 'pinned']\nposition = ['0 m', '-9 m']\n",
    );
    for k in 0..blocks {
        let at = 0.1 + 0.02 * k as f64;
        text.push_str(&format!(
            "[block.b{k}]\nmaterial = 'm'\nwidth = '1 cm'\nheight = '1 cm'\ndepth = '1 cm'\non = '{on}'\nat = '{at} m'\n\
             [contact.c{k}]\nbetween = ['b{k}', '{on}']\nfriction = 0.3\n",
        ));
    }
    text
}

#[test]
fn many_contacts_are_told_to_cost_more_than_their_number() {
    // Times of a trial: 20 cubes on a beam 0.12 s, 3000 blocks on the ground 0.7 s a step; either
    // was told as less than a tenth.
    let told = |blocks, on, dofs| {
        let scene = load(row_of_blocks(blocks, on).as_bytes(), "f", "f", &[]).unwrap().scene;
        assert!(accuracy_of_seconds(&scene).contains("order of magnitude"));
        expected_seconds(&scene, dofs)
    };
    let cubes = told(20, "b", 400);
    assert!(cubes > 0.04 && cubes < 0.4, "{cubes}");
    // On the ground each is an island of its own.
    let (few, many) = (told(30, "ground", 0), told(300, "ground", 0));
    assert!(many > 9.0 * few && many < 11.0 * few, "{few} {many}");
    let (few, many) = (told(30, "b", 400), told(300, "b", 400));
    assert!(many > 12.0 * few, "{few} {many}");
    let one = load(row_of_blocks(1, "b").as_bytes(), "f", "f", &[]).unwrap().scene;
    assert!(accuracy_of_seconds(&one).contains("three") && expected_seconds(&one, 400) < 0.01);
}

#[test]
fn more_contacts_than_memory_holds_are_refused_before_anything_is_made() {
    assert_eq!(operator_bytes(40_000), 51.2e9);
    assert!(operator_bytes(2 * 3000) < MOST_OPERATOR_BYTES);
    // On the ground they are islands, and no operator of all of them is made.
    assert!(load(row_of_blocks(6000, "ground").as_bytes(), "f", "f", &[]).is_ok());
    let refused = load(row_of_blocks(6000, "b").as_bytes(), "f", "f", &[]).expect_err("taken").to_string();
    assert!(
        refused.contains("6000 contacts of blocks with beams")
            && refused.contains("4.6 GB")
            && refused.contains("limit of 4.0 GB"),
        "{refused}"
    );
}

/// Notes the most contacts that it is given at once.
struct Largest(Box<dyn ContactSolver<2>>, Arc<AtomicUsize>);

impl ContactSolver<2> for Largest {
    fn name(&self) -> &'static str {
        self.0.name()
    }
    fn law(&self) -> Law {
        self.0.law()
    }
    fn reserve(&mut self, contacts: usize, blocks: usize) {
        self.0.reserve(contacts, blocks);
    }
    fn solve(&mut self, problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector<2>]) -> Outcome {
        self.1.fetch_max(p.len(), Ordering::Relaxed);
        self.0.solve(problem, stop, p)
    }
    fn fork(&self) -> Box<dyn ContactSolver<2>> {
        Box::new(Self(self.0.fork(), Arc::clone(&self.1)))
    }
}

/// The state at the end, and the most contacts of a problem.
fn ran(blocks: usize) -> (Simulation, usize) {
    let text = row_of_blocks(blocks, "ground").replace("friction = 0.3", "friction = 0.3\nrestitution = 0.0");
    let sets = [("ground.incline".to_owned(), "10 deg".to_owned()), ("time.end".to_owned(), "5 ms".to_owned())];
    let scene = load(text.as_bytes(), "f", "f", &sets).unwrap().scene;
    let largest = Arc::new(AtomicUsize::new(0));
    let mut simulation =
        Simulation::with_solver(&scene, |solver| Box::new(Largest(solver, Arc::clone(&largest)))).unwrap();
    assert_eq!(simulation.run(&mut []).unwrap(), teeter_integrator::Ended::Complete);
    (simulation, largest.load(Ordering::Relaxed))
}

#[test]
fn blocks_that_stand_apart_are_solved_one_by_one_to_the_same_bytes() {
    let ((few, dense), (many, apart)) = (ran(20), ran(70));
    // 40 contacts are one dense problem; of 140, each block's two are one.
    assert_eq!((dense, apart), (40, 2));
    assert_eq!(few.state.q[..60], many.state.q[..60]);
    assert_eq!(few.state.v[..60], many.state.v[..60]);
    assert_eq!((few.state.tally.max_contacts, many.state.tally.max_contacts), (40, 140));
    assert_eq!(many.state.tally.unconverged_steps, 0);
    assert!(many.state.tally.max_residual < 1e-14);
}

/// Sets a flag in its solve of a given number, and then spoils what it has found, as a solver does that is cut short.
struct CutShort {
    solver: Box<dyn ContactSolver<2>>,
    left: u32,
    flag: Arc<AtomicBool>,
}

impl ContactSolver<2> for CutShort {
    fn name(&self) -> &'static str {
        self.solver.name()
    }
    fn law(&self) -> Law {
        self.solver.law()
    }
    fn reserve(&mut self, contacts: usize, blocks: usize) {
        self.solver.reserve(contacts, blocks);
    }
    fn solve(&mut self, problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector<2>]) -> Outcome {
        self.left = self.left.wrapping_sub(1);
        self.flag.fetch_or(self.left == 0, Ordering::Relaxed);
        let outcome = self.solver.solve(problem, stop, p);
        if stop.cancelled() {
            p.iter_mut().for_each(|p| *p *= 1.5);
        }
        outcome
    }
    fn fork(&self) -> Box<dyn ContactSolver<2>> {
        Box::new(Self { solver: self.solver.fork(), left: self.left, flag: Arc::clone(&self.flag) })
    }
}

#[test]
fn a_step_that_is_abandoned_leaves_the_last_whole_one_and_is_taken_again_to_the_same_bytes() {
    let schemes = ["moreau-jean", "moreau-jean-closed", "moreau-jean-located", "moreau-jean-projected"];
    let more = ["generalized-alpha", "event-driven", "resolved"];
    for (scheme, solves) in schemes.into_iter().chain(more).flat_map(|scheme| [(scheme, 1), (scheme, 3)]) {
        let sets = [("time.scheme".to_owned(), scheme.to_owned()), ("time.end".to_owned(), "5 ms".to_owned())];
        // That one is for beams only.
        let on = if scheme == "resolved" { "b" } else { "ground" };
        let scene = load(row_of_blocks(3, on).as_bytes(), "f", "f", &sets).unwrap().scene;
        let mut alone = Simulation::new(&scene).unwrap();
        assert_eq!(alone.run(&mut []).unwrap(), teeter_integrator::Ended::Complete, "{scheme}");

        let flag = Arc::new(AtomicBool::new(false));
        let cut = |solver| Box::new(CutShort { solver, left: solves, flag: Arc::clone(&flag) }) as _;
        let mut parts = Simulation::with_solver(&scene, cut).unwrap();
        parts.cancelled_by(Arc::clone(&flag));
        let ended = parts.run(&mut []).unwrap();
        if solves > 1 && !flag.load(Ordering::Relaxed) {
            // Blocks at rest need no more of them.
            assert_eq!((ended, scheme), (teeter_integrator::Ended::Complete, "event-driven"));
            continue;
        }
        assert_eq!(ended, teeter_integrator::Ended::Interrupted, "{scheme}");
        assert!(flag.swap(false, Ordering::Relaxed) && parts.state.step < alone.state.step, "{scheme}");
        let mut whole = Simulation::new(&scene).unwrap();
        while whole.state.step < parts.state.step {
            whole.step().unwrap();
        }
        assert_eq!(parts.state, whole.state, "{scheme}");
        assert_eq!(parts.run(&mut []).unwrap(), teeter_integrator::Ended::Complete, "{scheme}");
        assert_eq!(parts.state, alone.state, "{scheme}");
    }
}
