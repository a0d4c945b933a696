#![allow(missing_docs,clippy::all)]
use teeter_contact::*;
use teeter_fclib::*;
use std::time::Instant;
fn run<const D:usize>(name:&str, lp:&LocalProblem<D>, tols:&[f64], log:bool){
    let problem=lp.problem().unwrap();
    for &tol in tols {
        let mut a=teeter_solvers::Newton::<D>::new(); a.log=log;
        let mut b=teeter_solvers::Smoothing::<D>::new(); b.log=log;
        let s:&mut dyn ContactSolver<D>= if std::env::var("S").is_ok(){&mut b}else{&mut a};
        let stop=Stop{tolerance:tol,max_iterations:200,..Stop::default()};
        let mut p=vec![Vector::<D>::zeros();problem.contacts()];
        let t=Instant::now();
        let o=s.solve(&problem,&stop,&mut p);
        println!("{name:45} n {:5} tol {tol:.0e} {:?} {} it {} res {:.2e} worst {:.1e} time {:.4} ms",problem.contacts(),o.status,o.used,o.iterations,o.residual.global,o.residual.worst,t.elapsed().as_secs_f64()*1e3);
    }
}
fn main(){
    let args:Vec<String>=std::env::args().collect();
    let log=std::env::var("LOG").is_ok();
    let tols:Vec<f64>=std::env::var("TOL").map(|t|t.split(',').map(|x|x.parse().unwrap()).collect()).unwrap_or(vec![1e-4,1e-8,1e-12]);
    for f in &args[1..]{
        let name=f.rsplit('/').next().unwrap();
        match teeter_fclib::read(f.as_ref() as &std::path::Path).unwrap(){
            FclibProblem::Plane(lp)=>run(name,&lp,&tols,log),
            FclibProblem::Space(lp)=>run(name,&lp,&tols,log),
            _=>{}
        }
    }
}
