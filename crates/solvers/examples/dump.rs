//! x
#![allow(warnings)]
use nalgebra::*; use teeter_contact::*; use teeter_solvers::crossover::Crossover;
fn main() {
    let mut files: Vec<_> = std::fs::read_dir(std::env::var("DUMP").unwrap_or("/work/proto/dump".into())).unwrap().map(|e| e.unwrap().path()).collect(); files.sort();
    let only: Vec<usize> = std::env::args().skip(1).filter_map(|a| a.parse().ok()).collect();
    let mut solver = Crossover::new(); let (mut solved, mut total, mut count) = (0, 0.0, 0);
    let from_start = std::env::var("FROM").is_ok();
    for (k, f) in files.iter().enumerate() {
        if !only.is_empty() && !only.contains(&k) { continue }
        let text = std::fs::read_to_string(f).unwrap(); let mut lines = text.lines();
        let head: Vec<&str> = lines.next().unwrap().split(' ').collect(); let n: usize = head[0].parse().unwrap();
        let num = |l: &str| -> Vec<f64> { l.split(' ').map(|x| x.parse().unwrap()).collect() };
        let a: Vec<Vec<f64>> = (0..n).map(|_| num(lines.next().unwrap())).collect();
        let mut rows = vec![vec![]; n];
        for l in lines { let x = num(l); rows[x[0] as usize].push((x[1] as usize, Matrix2::new(x[2], x[3], x[4], x[5]))); }
        let h = BlockSparse::from_rows(&rows).unwrap();
        let q: Vec<_> = a.iter().map(|x| Vector2::new(x[1], x[2])).collect(); let mu: Vec<f64> = a.iter().map(|x| x[0]).collect();
        let mut p: Vec<_> = a.iter().map(|x| if from_start { Vector2::new(x[3], x[4]) } else { Vector2::new(x[5], x[6]) }).collect();
        let problem = ContactProblem::new(Delassus::Blocks(&h), &q, &mu).unwrap();
        let stop = Stop::default().with_tolerance(1e-10);
        let had = judge(&problem, &p).global;
        if let Ok(m) = std::env::var("METHOD") {
            let mut s = teeter_solvers::plane_solver(&m).unwrap();
            let clock = std::time::Instant::now();
            let o = s.solve(&problem, &stop, &mut p);
            println!("{k} n {n} {m} {:?} {} {} res {:.1e} {:.1} ms", o.status, o.used, o.iterations, o.residual.global, 1e3 * clock.elapsed().as_secs_f64());
            solved += o.converged() as usize; count += 1; total += clock.elapsed().as_secs_f64();
            continue;
        }
        let clock = std::time::Instant::now();
        let o = solver.solve(&problem, &stop, &mut p);
        let s = clock.elapsed().as_secs_f64();
        solved += o.converged() as usize; count += 1; total += s;
        println!("{k} n {n} had {had:.1e} {:?} {} res {:.1e} {:.1} ms {}", o.status, o.iterations, o.residual.global, 1e3 * s, "");
    }
    println!("solved {solved} of {count}, {:.1} ms each", 1e3 * total / count as f64);
}
