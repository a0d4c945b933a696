#![allow(missing_docs, clippy::all)]
use std::time::Instant;
use teeter_contact::*;
use teeter_fclib::*;
fn run<const D: usize>(name: &str, lp: &LocalProblem<D>, tols: &[f64], log: bool) {
    let problem = lp.problem().unwrap();
    for &tol in tols {
        let mut solver: Box<dyn ContactSolver<D>> = make::<D>(&std::env::var("S").unwrap_or("auto".into()));
        let stop = Stop { tolerance: tol, max_iterations: 10000, ..Stop::default() };
        let mut best = f64::INFINITY;
        let mut o = None;
        let t0 = Instant::now();
        for _ in 0..50 {
            let mut p = vec![Vector::<D>::zeros(); problem.contacts()];
            let t = Instant::now();
            o = Some(solver.solve(&problem, &stop, &mut p));
            best = best.min(t.elapsed().as_secs_f64());
            if t0.elapsed().as_secs_f64() > 0.2 {
                break;
            }
        }
        let o = o.unwrap();
        println!(
            "{name:45} n {:5} tol {tol:.0e} {:?} {} it {} res {:.2e} worst {:.1e} time {:.4} ms",
            problem.contacts(),
            o.status,
            o.used,
            o.iterations,
            o.residual.global,
            o.residual.worst,
            best * 1e3
        );
    }
}
fn make<const D: usize>(name: &str) -> Box<dyn ContactSolver<D>> {
    let any: Box<dyn std::any::Any> = if D == 2 {
        Box::new(teeter_solvers::plane_solver(name).unwrap())
    } else {
        Box::new(teeter_solvers::space_solver(name).unwrap())
    };
    *any.downcast::<Box<dyn ContactSolver<D>>>().unwrap()
}
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let log = std::env::var("LOG").is_ok();
    let tols: Vec<f64> = std::env::var("TOL")
        .map(|t| t.split(',').map(|x| x.parse().unwrap()).collect())
        .unwrap_or(vec![1e-4, 1e-8, 1e-12]);
    for f in &args[1..] {
        let name = f.rsplit('/').next().unwrap();
        match teeter_fclib::read(f.as_ref() as &std::path::Path).unwrap() {
            FclibProblem::Plane(lp) => run(name, &lp, &tols, log),
            FclibProblem::Space(lp) => run(name, &lp, &tols, log),
            _ => {}
        }
    }
}
