//! How blocks that slide, or have stopped, are told.

use crate::page::run;
use crate::plots::table;
use crate::table::column;

/// The number of a length in mm that stands before these words, in m.
fn before(text: &str, words: &str) -> f64 {
    let number = text.split_once(words).unwrap().0.rsplit_once(' ').unwrap().1;
    1e-3 * number.parse::<f64>().unwrap()
}

/// A beam that rings under what slides on it takes some of its way while it doesn't press: the slides alone add up to 15.5 mm to the right, and to an end
/// where it isn't.
#[test]
fn what_slid_to_and_fro_is_told_where_it_was() {
    let text = "[time]\nend = '2.7 s'\nstep = '200 us'\n[material.steel]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n[beam.floor]\n\
        material = 'steel'\nspan = '3 m'\nwidth = '30 cm'\nthickness = '6 cm'\nelements = 6\nsupports = ['clamped', 'pinned']\n\
        damping_ratio = { mode = 1, ratio = 0.03 }\nstart = 'static'\nself_weight = true\n[beam.floor.motion]\n\
        acceleration = ['2.5 m/s^2', '0 m/s^2']\nsignal = 's'\n[signal.s]\nshape = 'product'\nfactors = ['h', 'w']\n[signal.h]\n\
        shape = 'harmonic'\nfrequency = '1.5 Hz'\n[signal.w]\nshape = 'half-sine'\nduration = '2.5 s'\n[block.cabinet]\n\
        density = '500 kg/m^3'\nwidth = '40 cm'\nheight = '1.8 m'\ndepth = '60 cm'\non = 'floor'\nat = '1.2 m'\n[block.crate]\n\
        density = '500 kg/m^3'\nwidth = '40 cm'\nheight = '30 cm'\ndepth = '60 cm'\non = 'floor'\nat = '2.2 m'\n[contact.a]\n\
        between = ['cabinet', 'floor']\nfriction = 0.6\n[contact.b]\nbetween = ['crate', 'floor']\nfriction = 0.12\n[output]\nevery = '2 ms'\n";
    let ran = run("slides-on-shaken-supports", text);
    let rows = table(&ran.folder.join("trajectory.csv"));
    let (x, support) = (column(&rows, "crate.x"), column(&rows, "floor.support.x"));
    let start = x[0] - support[0];
    let at: Vec<f64> = x.iter().zip(support).map(|(x, support)| x - support - start).collect();
    let (left, right) = at.iter().fold((0.0_f64, 0.0_f64), |(left, right), at| (left.max(-at), right.max(*at)));
    let headline = &ran.summary.headline;
    let told_of_crate = headline.split_once("`crate` slid to and fro, up to ").unwrap().1;
    // It tilts by some 1e-4 rad on the beam that bends, which moves its mass centre by as much of 15 cm.
    for (told, was) in
        [(" mm left of and", left), (" mm right of its start", right), (" mm left of it", -at[at.len() - 1])]
    {
        let found = before(&format!(" {told_of_crate}"), told);
        assert!((found - was).abs() < 1e-4, "{found} {was}: {headline}");
    }
}

/// It has sat down 12 ms before the end, which is too short a time to rest.
#[test]
fn what_has_sat_down_does_not_rock_on() {
    let text = "[time]\nend = '2 s'\nstep = '100 us'\n[ground]\n[block.runner]\ndensity = '2400 kg/m^3'\nwidth = '20 cm'\n\
        height = '20 cm'\ndepth = '20 cm'\non = 'ground'\nat = '-1 m'\nvelocity = ['3 m/s', '0 m/s']\n[block.target]\n\
        density = '2400 kg/m^3'\nwidth = '20 cm'\nheight = '50 cm'\ndepth = '20 cm'\non = 'ground'\nat = '0 m'\n[contact.g]\n\
        between = ['*', 'ground']\nfriction = 0.3\n[contact.b]\nbetween = ['runner', 'target']\nfriction = 0.2\nrestitution = 0.3\n";
    let ran = run("sat-down", text);
    let rows = table(&ran.folder.join("trajectory.csv"));
    let (t, omega) = (column(&rows, "t"), column(&rows, "target.omega"));
    let moved = t.iter().zip(omega).filter(|(_, omega)| omega.abs() > 0.01).map(|(t, _)| *t).fold(0.0, f64::max);
    let target = ran.summary.headline.split_once("; `target` rocked, last peak ").unwrap().1;
    let since: f64 =
        target.split_once(" and has been still since t = ").unwrap().1.split_once(" s,").unwrap().0.parse().unwrap();
    assert!(since >= moved && since < 2.0, "{since} {moved}: {target}");
    // At a peak it is slow, too, but rocks on; among three blocks, too.
    let swings = run("still-swings", &text.replace("end = '2 s'", "end = '1.5 s'")).summary.headline;
    assert!(swings.contains("; `target` rocks on, last peak "), "{swings}");
    let third = "[block.third]\ndensity = '2400 kg/m^3'\nwidth = '20 cm'\nheight = '20 cm'\ndepth = '20 cm'\non = 'ground'\nat = '3 m'\n";
    let three = run("sat-down-of-three", &format!("{text}{third}")).summary.headline;
    assert!(three.contains("`target` stands still at the end") && !three.contains("rocks on"), "{three}");
}
