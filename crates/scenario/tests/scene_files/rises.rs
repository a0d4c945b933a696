//! Loads of many rows in `moreau-jean-located`, which divides its steps where loads jump or rise steeply.

use super::located::pose;
use teeter_integrator::Ended;
use teeter_scenario::simulation::Simulation;

/// A block with friction 0.3 on the ground, and what else there is.
fn block(more: &str) -> String {
    format!(
        "[time]\nend = '0.1 s'\n[ground]\n[block.b]\nmass = '1 kg'\ninertia = '0.04 kg m^2'\nwidth = '0.4 m'\nheight = '0.02 m'\n\
         on = 'ground'\nat = '0 m'\n[contact.c]\nbetween = ['b', 'ground']\nfriction = 0.3\n{more}"
    )
}

/// A scene, in steps of this size, whose one table is in a file of these rows.
fn simulation(scene: &str, rows: &str, step: &str) -> Simulation {
    let sets = [("time.scheme", "moreau-jean-located"), ("time.step", step)];
    let sets = sets.map(|(key, value)| (key.to_owned(), format!("\"{value}\"")));
    let read = &mut |_: &str| Ok(rows.as_bytes().to_vec());
    Simulation::new(&teeter_scenario::load_with(scene.as_bytes(), "rises", "rises", &sets, read).unwrap().scene)
        .unwrap()
}

/// Steady up and down, nowhere steep.
fn ripple(row: u32) -> f64 {
    f64::from(row * 41 % 101) * 1e-3
}

/// The rows of one force hide no rise of another: neither by their number in a step nor by one that lies within the rise.
#[test]
fn rows_of_another_force_hide_no_rise() {
    let rows: String = (0..4000).map(|row| format!("{} {}\n", f64::from(row) * 5e-5, ripple(row))).collect();
    let other = |on: &str| {
        format!(
            "[block.other]\nmass = '1 kg'\ninertia = '0.04 kg m^2'\nwidth = '0.4 m'\nheight = '0.02 m'\non = 'ground'\nat = '2 m'\n\
             [contact.d]\nbetween = ['other', 'ground']\nfriction = 0.3\n[signal.rows]\nshape = 'table'\nfile = 'rows.csv'\n\
             [force.g]\non = '{on}'\nforce = ['0 N', '0.001 N']\nsignal = 'rows'\n"
        )
    };
    for lasting in [1e-9, 1e-4, 4e-4] {
        for step in ["5 ms", "1 ms"] {
            let place = |more: &str| {
                let scene = block(&format!(
                    "[signal.s]\nshape = 'ramp'\nstart = '20.35 ms'\nduration = '{lasting} s'\n\
                     [force.f]\non = 'b'\nforce = ['4 N', '0 N']\nsignal = 's'\n{more}"
                ));
                let mut simulation = simulation(&scene, &rows, step);
                assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
                pose(&simulation, "b")[0]
            };
            let (alone, beside) = (place(""), place(&other("other")));
            // It slides by 3.3 mm; where a step of 5 ms isn't divided, by 2 % less.
            assert!((beside - alone).abs() < 1e-12, "{lasting} s, {step}: {beside} {alone}");
            // On the block itself it changes the friction a little.
            let beside = place(&other("b"));
            assert!((beside / alone - 1.0).abs() < 1e-3, "{lasting} s, {step}: {beside} {alone}");
        }
    }
}

/// A force of 80 rows a step, more than are looked at, that jumps up at the fiftieth: a run that goes on from the end of any step divides the same
/// steps as one from the beginning.
#[test]
fn a_run_goes_on_the_same_among_more_rows_than_are_looked_at() {
    let row = |row: u32| {
        let (t, force) = (f64::from(row) * 62.5e-6, |of: u32| if (50..70).contains(&(of % 80)) { 5.0 } else { 0.0 });
        let jump =
            if row % 80 == 50 { format!("{} {}\n", t - 1e-8, force(row - 1) + ripple(row)) } else { String::new() };
        format!("{jump}{t} {}\n", force(row) + ripple(row))
    };
    let rows: String = (0..2000).map(row).collect();
    let scene = block(
        "[signal.rows]\nshape = 'table'\nfile = 'rows.csv'\n[force.g]\non = 'b'\nforce = ['1 N', '0 N']\nsignal = 'rows'\n",
    );
    let whole = |until: f64| {
        let mut simulation = simulation(&scene, &rows, "5 ms");
        assert_eq!(simulation.run_until(until, &mut []).unwrap(), Ended::Complete);
        simulation
    };
    let end = whole(0.1);
    assert!(pose(&end, "b")[0] > 1e-5, "it doesn't slide: no step is divided");
    for steps in 1..20 {
        let mut part = simulation(&scene, &rows, "5 ms");
        part.state = whole(f64::from(steps) * 5e-3).state;
        assert_eq!(part.run_until(0.1, &mut []).unwrap(), Ended::Complete);
        assert_eq!((&part.state.q, &part.state.v), (&end.state.q, &end.state.v), "from step {steps} on");
    }
}
