//! Contacts of bodies that stand apart, solved on several threads.

use teeter_integrator::{Ended, WorkCounts};
use teeter_scenario::load;
use teeter_scenario::simulation::Simulation;

/// Columns of unequal width, which slide, rock and fall apart on shaken ground; a column is an island, and one of them, of many
/// blocks, takes longer than the rest.
fn columns(law: &str) -> String {
    let mut text = "[time]\nend = '0.2 s'\nstep = '2 ms'\nscheme = 'moreau-jean'\n[ground]\nmotion = { acceleration = ['4 m/s^2', '0 m/s^2'], signal = 'shake' }\n\
         [signal.shake]\nshape = 'one-sine'\nperiod = '0.4 s'\n[material.m]\ndensity = '2700 kg/m^3'\n"
        .to_owned();
    for k in 0..18 {
        let (width, count) = (10 + k, if k == 11 { 30 } else { 5 });
        text += &format!(
            "[block.c{k}]\nmaterial = 'm'\nwidth = '{width} cm'\nheight = '20 cm'\ndepth = '10 cm'\non = 'ground'\nat = '{} m'\n\
             repeat = {{ count = {count}, stacked = true }}\n",
            10 * k
        );
    }
    text + &format!(
        "[contact.all]\nbetween = ['*', '*']\nfriction = 0.3\n{law}\n[contact.floor]\nbetween = ['*', 'ground']\nfriction = 0.6\n{law}\n"
    )
}

/// The state at the end, bit by bit, and the work that led there.
fn end(text: &str, threads: usize) -> (Vec<u64>, WorkCounts) {
    let resolved = load(text.as_bytes(), "scene", "scene", &[]);
    let scene = resolved.unwrap_or_else(|errors| panic!("{errors}\n{text}")).scene;
    let mut simulation = Simulation::new(&scene).unwrap();
    simulation.set_threads(threads);
    assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
    let state = &simulation.state;
    (state.q.iter().chain(&state.v).map(|x| x.to_bits()).collect(), simulation.work_counts())
}

#[test]
fn any_number_of_threads_leads_to_the_same_bits() {
    for law in ["", "restitution = 0.4\nlaw = 'poisson'", "restitution = 0.4\nlaw = 'energetic'"] {
        let text = columns(law);
        let alone = end(&text, 1);
        for threads in [2, 5] {
            let together = end(&text, threads);
            assert_eq!(together.1, alone.1, "{law}, {threads} threads");
            assert!(together.0 == alone.0, "{law}, {threads} threads");
        }
    }
}
