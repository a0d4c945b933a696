//! What slides, rides or rests on what moves: the same is said wherever the run ends.

use super::{Ran, folder, written};

/// A statue on a pedestal on harmonically shaken ground, up to a time, with a friction of the pedestal.
fn statue(name: &str, end: &str, friction: f64) -> Ran {
    let text = format!(
        "[time]\nend = '{end}'\nstep = '1 ms'\n[ground]\nmotion = {{ acceleration = ['3 m/s^2', '0 m/s^2'], signal = 'shake' }}\n\
         [signal.shake]\nshape = 'harmonic'\nfrequency = '1.5 Hz'\n[material.marble]\ndensity = '2700 kg/m^3'\n\
         [block.pedestal]\nmaterial = 'marble'\nwidth = '40 cm'\nheight = '40 cm'\ndepth = '40 cm'\non = 'ground'\nat = '0 m'\n\
         [block.statue]\nmaterial = 'marble'\nwidth = '20 cm'\nheight = '80 cm'\ndepth = '20 cm'\non = 'pedestal'\nat = '0 m'\n\
         [contact.base]\nbetween = ['pedestal', 'ground']\nfriction = {friction}\n\
         [contact.top]\nbetween = ['statue', 'pedestal']\nfriction = 0.5\n"
    );
    written(&folder(&format!("verdict-shaken-{name}")), &text)
}

fn headline(ran: &Ran) -> &str {
    ran.summary["headline"].as_str().unwrap()
}

#[test]
fn what_ground_shakes_slides_to_and_fro_whenever_the_run_ends() {
    for (name, friction, ends) in
        [("slips", 0.2, ["4 s", "4.1 s", "4.2 s", "4.3 s"]), ("sticks", 0.25, ["4 s", "4.15 s", "4.25 s", "4.4 s"])]
    {
        for (number, end) in ends.into_iter().enumerate() {
            let ran = statue(&format!("{name}-{number}"), end, friction);
            let slips: Vec<f64> =
                ran.column("pedestal.x").iter().zip(ran.column("ground.x")).map(|(x, ground)| x - ground).collect();
            let farthest = slips.iter().fold(0.0_f64, |most, slip| most.max((slip - slips[0]).abs()));
            let told = headline(&ran);
            assert!(told.starts_with("`pedestal` slides to and fro on the moving ground, up to "), "{end}: {told}");
            let told_farthest = told.split_once("up to ").unwrap().1.split_once(' ').unwrap().0;
            let told_farthest: f64 = told_farthest.parse().unwrap();
            // Rows are fewer than steps.
            assert!((1e-3 * told_farthest - farthest).abs() < 0.02 * farthest, "{end}: {told}, {farthest}");
            assert!(told.contains("`statue` is standing still on the block below it, on ground that moves"), "{told}");
            assert!(ran.verdict("pedestal")["rests_from"].is_null(), "{told}");
            let in_all: f64 = slips.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum();
            let told_in_all = ran.verdict("pedestal")["slid_in_all"].as_f64().unwrap();
            assert!((told_in_all - in_all).abs() < 0.02 * in_all && in_all > 1.5 * farthest, "{told_in_all} {in_all}");
            assert!(told.contains(" in all)"), "{told}");
        }
    }
}

#[test]
fn a_slide_up_a_slope_and_down_again_is_not_to_and_fro() {
    let text = "[time]\nend = '1 s'\nstep = '1 ms'\n[ground]\nincline = '25 deg'\n[material.oak]\ndensity = '700 kg/m^3'\n\
                [block.crate]\nmaterial = 'oak'\nwidth = '20 cm'\nheight = '10 cm'\ndepth = '10 cm'\non = 'ground'\nat = '0 m'\n\
                velocity = ['2.7189 m/s', '1.2679 m/s']\n[contact.base]\nbetween = ['crate', 'ground']\nfriction = 0.3\n";
    let ran = written(&folder("verdict-shaken-slope"), text);
    assert!(headline(&ran).contains("up the slope, then"), "{}", headline(&ran));
}

/// Long after its ground has stopped it slides down, far farther than it went to and fro.
#[test]
fn what_slides_on_after_it_was_shaken_does_not_go_to_and_fro() {
    let text = "[time]\nend = '2 s'\nstep = '1 ms'\n[ground]\nincline = '10 deg'\n\
                motion = { acceleration = ['12 m/s^2', '0 m/s^2'], signal = 's' }\n[signal.s]\nshape = 'one-sine'\nperiod = '0.3 s'\n\
                [material.m]\ndensity = '2000 kg/m^3'\n[block.b]\nmaterial = 'm'\nwidth = '30 cm'\nheight = '5 cm'\ndepth = '10 cm'\n\
                on = 'ground'\nat = '0 m'\nvelocity = ['0.8 m/s', '0.141 m/s']\n[contact.c]\nbetween = ['b', 'ground']\nfriction = 0.1\n";
    let ran = written(&folder("verdict-shaken-once"), text);
    let told = headline(&ran);
    assert!(
        told.starts_with("`b` slides on, slid 38.43 mm up the slope, then to ") && told.ends_with(" so far"),
        "{told}"
    );
}

#[test]
fn ground_with_an_amplitude_of_zero_does_not_move() {
    let text = "[time]\nend = '2 s'\nstep = '1 ms'\n[ground]\nmotion = { acceleration = ['0 m/s^2', '0 m/s^2'], signal = 'shake' }\n\
                [signal.shake]\nshape = 'harmonic'\nfrequency = '1.5 Hz'\n[material.m]\ndensity = '2000 kg/m^3'\n[block.b]\n\
                material = 'm'\nwidth = '30 cm'\nheight = '5 cm'\ndepth = '10 cm'\non = 'ground'\nat = '0 m'\nvelocity = ['0.8 m/s', '0 m/s']\n\
                [contact.c]\nbetween = ['b', 'ground']\nfriction = 0.4\n";
    let ran = written(&folder("verdict-shaken-by-nothing"), text);
    let told = headline(&ran);
    assert!(told.contains("to the right and came to rest at t = "), "{told}");
}

/// A slab that ground with a period of 5/6 s overturns.
fn slab(name: &str, end: &str) -> Ran {
    let text = format!(
        "[time]\nend = '{end}'\nstep = '1 ms'\n[ground]\nmotion = {{ acceleration = ['2.8 m/s^2', '0 m/s^2'], signal = 'shake' }}\n\
         [signal.shake]\nshape = 'harmonic'\nfrequency = '1.2 Hz'\n[material.marble]\ndensity = '2700 kg/m^3'\n\
         [block.slab]\nmaterial = 'marble'\nwidth = '25 cm'\nheight = '1 m'\ndepth = '20 cm'\non = 'ground'\nat = '0 m'\n\
         [contact.base]\nbetween = ['slab', 'ground']\nfriction = 0.6\n"
    );
    written(&folder(&format!("verdict-shaken-{name}")), &text)
}

#[test]
fn ground_that_stands_for_an_instant_still_moves() {
    // After whole periods the ground is still.
    for (number, end) in ["10 s", "10.2 s", "15 s"].into_iter().enumerate() {
        let ran = slab(&format!("slab-{number}"), end);
        assert!(headline(&ran).contains("side on the moving ground at t = "), "{end}: {}", headline(&ran));
    }
}

#[test]
fn the_swing_in_which_a_block_settles_counts() {
    let text = "[time]\nend = '1.5 s'\nstep = '500 us'\n[ground]\n[material.oak]\ndensity = '700 kg/m^3'\n[block.brick]\n\
                material = 'oak'\nwidth = '10 cm'\nheight = '20 cm'\ndepth = '10 cm'\nposition = ['0 m', '0.35 m']\nangle = '20 deg'\n\
                [contact.base]\nbetween = ['brick', 'ground']\nfriction = 0.4\nrestitution = 0.3\n";
    let ran = written(&folder("verdict-shaken-brick"), text);
    let (t, phi) = (ran.column("t"), ran.column("brick.phi"));
    let swing = t.iter().zip(&phi).filter(|(t, _)| **t > 0.45).fold(0.0_f64, |most, (_, phi)| most.max(phi.abs()));
    let told = ran.verdict("brick")["max_phi_over_alpha"].as_f64().unwrap();
    assert!((told - swing / 0.5_f64.atan()).abs() < 1e-3, "{told}, {swing}");
}

/// Ground that is jerked to one side time and again, gently back: what slides on it only goes one way.
#[test]
fn what_creeps_along_on_shaken_ground_is_told_alike_while_it_slides_and_while_it_sticks() {
    let mut slides = [false; 2];
    for end in ["2.9 s", "3 s", "3.1 s", "3.2 s", "3.3 s", "3.4 s"] {
        let text = format!(
            "[time]\nend = '{end}'\nstep = '1 ms'\n[ground]\nincline = '6 deg'\n\
             motion = {{ acceleration = ['3 m/s^2', '0 m/s^2'], signal = 'shake' }}\n[signal.shake]\nshape = 'harmonic'\nfrequency = '2 Hz'\n\
             [material.m]\ndensity = '2000 kg/m^3'\n[block.b]\nmaterial = 'm'\nwidth = '30 cm'\nheight = '5 cm'\ndepth = '10 cm'\n\
             on = 'ground'\nat = '0 m'\n[contact.c]\nbetween = ['b', 'ground']\nfriction = 0.3\n"
        );
        let ran = written(&folder(&format!("verdict-shaken-creeps-{}", end.replace(' ', "-"))), &text);
        let told = headline(&ran);
        assert!(
            told.starts_with("`b` slid by ") && told.ends_with(" down the slope on the moving ground"),
            "{end}: {told}"
        );
        slides[usize::from(ran.verdict("b")["speed"].is_null())] = true;
    }
    assert_eq!(slides, [true; 2], "some runs end while it slides, others while it sticks");
}
