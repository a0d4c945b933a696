//! What the sentence at the head tells of beams beside blocks.

use crate::page::run;

/// A bar that nothing holds lies on two piers that move, and a stone stands beside them.
fn bar(motion: [&str; 2]) -> String {
    let pier = |name: &str, x: &str, motion: &str| {
        format!(
            "[block.{name}]\ndensity = '2400 kg/m^3'\nwidth = '10 cm'\nheight = '20 cm'\ndepth = '10 cm'\nposition = ['{x}', '90 cm']\n\
             motion = {{ velocity = {motion}, angle = '0 deg', signal = 'on' }}\n[contact.{name}]\nbetween = ['{name}', 'bar']\nfriction = 0\n"
        )
    };
    format!(
        "[time]\nend = '0.5 s'\nstep = '500 us'\n[ground]\n[signal.on]\nshape = 'constant'\n[beam.bar]\nsection = 'direct'\n\
         bending_stiffness = '200 N m^2'\nmass_per_length = '1 kg/m'\nspan = '1 m'\nelements = 4\nsupports = ['free', 'free']\nself_weight = true\n\
         position = ['0 m', '1 m']\n{}{}[block.stone]\ndensity = '2400 kg/m^3'\nwidth = '10 cm'\nheight = '10 cm'\ndepth = '10 cm'\non = 'ground'\n\
         at = '2 m'\n[contact.floor]\nbetween = ['stone', 'ground']\nfriction = 0.5\n",
        pier("left", "0.1 m", motion[0]),
        pier("right", "0.9 m", motion[1])
    )
}

#[test]
fn a_beam_that_loses_the_blocks_it_lies_on_is_told_to_have_fallen() {
    // Both piers are past the ends after 0.15 s and more: it has fallen freely for less than the rest.
    let fell = run("bar-falls", &bar(["['-1 m/s', '0 m/s']", "['1 m/s', '0 m/s']"]));
    let headline = &fell.summary.headline;
    assert!(headline.starts_with("`stone` stood still throughout; `bar` fell, "), "{headline}");
    let fall = headline.split("fell, ").nth(1).and_then(|rest| rest.strip_suffix(" mm lower at the end"));
    let fall: f64 = fall.unwrap().parse().unwrap();
    assert!(fall > 400.0 && fall < 500.0 * 9.81 * 0.35 * 0.35, "{headline}");
}

#[test]
fn a_beam_that_is_let_down_with_what_it_lies_on_has_not_fallen() {
    let down = run("bar-let-down", &bar(["['0 m/s', '-0.4 m/s']", "['0 m/s', '-0.4 m/s']"]));
    assert_eq!(down.summary.headline, "`stone` stood still throughout");
}

/// What rests on a beam that is in equilibrium from the start strikes nothing: the stress is known as exactly as that of a beam alone.
#[test]
fn a_stress_is_told_with_about_only_where_impacts_make_it_uncertain() {
    let text = |place: &str| {
        format!(
            "[time]\nend = '20 ms'\nstep = '100 us'\n[material.steel]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n\
             yield_strength = '235 MPa'\n[beam.table]\nmaterial = 'steel'\nspan = '1 m'\nwidth = '10 cm'\nthickness = '1 cm'\nelements = 10\n\
             start = 'static'\nself_weight = true\n[block.cube]\ndensity = '2400 kg/m^3'\nwidth = '10 cm'\nheight = '10 cm'\ndepth = '10 cm'\n{place}\n\
             [contact.feet]\nbetween = ['cube', 'table']\nfriction = 0.5\n"
        )
    };
    let stands = run("stands-on-table", &text("on = 'table'\nat = '0.4 m'"));
    assert_eq!(stands.summary.impact_count, 0);
    let headline = &stands.summary.headline;
    assert!(headline.contains("stressed to ") && !headline.contains("about"), "{headline}");
    let told = stands.html.lines().find(|line| line.contains("data-stress=")).unwrap();
    assert!(told.contains(" of the yield strength") && !told.contains("about"), "{told}");
    let dropped = run("dropped-on-table", &text("position = ['0.4 m', '5.02 cm']"));
    assert!(dropped.summary.impact_count > 0);
    let headline = &dropped.summary.headline;
    assert!(headline.contains("stressed to about "), "{headline}");
}

/// The stone that a beam carries along goes with it: it stands, and doesn't hop.
#[test]
fn what_stands_on_a_beam_that_is_taken_along_stands_on_it() {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../.ci/scenes/beam-taken-along.toml");
    let taken = run("taken-along", &std::fs::read_to_string(file).unwrap());
    let headline = &taken.summary.headline;
    assert_eq!(headline, "`stone` stood on `lintel` throughout");
    assert!(!taken.html.contains("All at rest"));
}

#[test]
fn what_leaves_a_beam_and_turns_as_it_falls_is_told_in_that_order() {
    let text = "[time]\nend = '2.5 s'\nstep = '500 us'\n[beam.plank]\nsection = 'direct'\nbending_stiffness = '2e4 N m^2'\nmass_per_length = '20 kg/m'\n\
        span = '1 m'\nelements = 4\n[block.box]\ndensity = '700 kg/m^3'\nwidth = '12 cm'\nheight = '10 cm'\ndepth = '10 cm'\n\
        position = ['0.7 m', '5 cm']\nvelocity = ['1.6 m/s', '0 m/s']\n[contact.c]\nbetween = ['box', 'plank']\nfriction = 0.02\n";
    let left = run("leaves-and-turns", text);
    let headline = &left.summary.headline;
    assert!(headline.starts_with("`box` left `plank` at its right end at t = "), "{headline}");
    assert!(headline.contains(", turned by ") && headline.contains("° in all"), "{headline}");
}

#[test]
fn a_tile_names_what_a_block_slid_on_where_that_is_several() {
    let text = |x: &str| {
        format!(
            "[time]\nend = '0.3 s'\nstep = '500 us'\n[ground]\n[block.plate]\ndensity = '2400 kg/m^3'\nwidth = '40 cm'\nheight = '1 mm'\ndepth = '10 cm'\n\
             position = ['0 m', '0.5 mm']\nfixed = true\n[block.box]\ndensity = '700 kg/m^3'\nwidth = '12 cm'\nheight = '5 cm'\ndepth = '10 cm'\n\
             position = ['{x}', '26 mm']\nvelocity = ['2 m/s', '0 m/s']\n[contact.floor]\nbetween = ['box', 'ground']\nfriction = 0.2\n\
             [contact.plate]\nbetween = ['box', 'plate']\nfriction = 0.2\n"
        )
    };
    let both = run("slides-on-two", &text("0 m")).html;
    assert!(
        both.contains("<dt>Slid to the right by, on ground and plate</dt>")
            || both.contains("<dt>Slid to the right by, on plate and ground</dt>")
    );
    let one = run("slides-on-one", &text("-1 m").replace("26 mm", "25 mm").replace("2 m/s", "1 m/s")).html;
    assert!(one.contains("<dt>Slid to the right by</dt>"));
}

/// It leaves the plate that its last millimetres lie on, and slides on the ground for a metre.
#[test]
fn a_tile_names_nothing_that_a_block_only_brushed_against() {
    let text = "[time]\nend = '1 s'\nstep = '500 us'\n[ground]\n[block.plate]\ndensity = '2400 kg/m^3'\nwidth = '40 cm'\nheight = '1 mm'\n\
        depth = '10 cm'\nposition = ['0 m', '0.5 mm']\nfixed = true\n[block.box]\ndensity = '700 kg/m^3'\nwidth = '12 cm'\nheight = '5 cm'\n\
        depth = '10 cm'\nposition = ['25.5 cm', '26 mm']\nvelocity = ['2 m/s', '0 m/s']\n[contact.floor]\nbetween = ['box', 'ground']\n\
        friction = 0.2\n[contact.plate]\nbetween = ['box', 'plate']\nfriction = 0.2\n";
    let html = run("brushed-a-plate", text).html;
    assert!(html.contains("<dt>Slid to the right by</dt>"));
}
