//! Times of a step and of its parts; see `benches/README.md`.

mod beam;
mod contacts;
mod free_beam;
mod many;
mod modal_beam;
mod scenes;
mod solvers;

use criterion::Criterion;
use std::time::Duration;

fn main() {
    // By hand: the macros of criterion would make public items without documentation.
    // Half of criterion's usual times: what varies here is the machine, over minutes, and no sample is long enough for that.
    let brief = Criterion::default().warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(3));
    let mut criterion = brief.configure_from_args();
    scenes::bench(&mut criterion);
    free_beam::bench(&mut criterion);
    contacts::bench(&mut criterion);
    many::bench(&mut criterion);
    modal_beam::bench(&mut criterion);
    solvers::bench(&mut criterion);
    beam::bench(&mut criterion);
    criterion.final_summary();
}
