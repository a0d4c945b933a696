//! x
use teeter_scenario::simulation::Simulation;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let bytes = std::fs::read(&a[1]).unwrap();
    let sets: Vec<(String, String)> = a[3..]
        .iter()
        .map(|s| {
            let (k, v) = s.split_once('=').unwrap();
            (k.to_owned(), v.to_owned())
        })
        .collect();
    let r = teeter_scenario::load(&bytes, "x", "x", &sets).unwrap();
    let mut s = Simulation::new(&r.scene).unwrap();
    let every: u64 = a[2].parse().unwrap();
    let n = (r.scene.time.end / r.scene.time.step).round() as u64;
    let mut t = std::time::Instant::now();
    let (mut pp, mut ii, mut rr, mut ff) = (0, 0, 0, 0);
    for k in 0..n {
        s.step().unwrap();
        if (k + 1) % every == 0 {
            let w = s.work_counts();
            println!(
                "{:.4} problems {} iterations {} refused {} fact {} unsolved {} contacts {} us {:.0}",
                s.state.t,
                w.problems - pp,
                w.iterations - ii,
                w.refused_attempts - rr,
                w.factorisations - ff,
                w.unsolved,
                0,
                t.elapsed().as_secs_f64() * 1e6 / every as f64
            );
            pp = w.problems;
            ii = w.iterations;
            rr = w.refused_attempts;
            ff = w.factorisations;
            t = std::time::Instant::now();
        }
    }
}
