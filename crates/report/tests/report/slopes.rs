//! Blocks on ground of several slopes, and those that hop, roll or slide before they overturn.

use crate::page::run;

const STONE: &str =
    "[material.m]\ndensity = '2000 kg/m^3'\n[block.b]\nmaterial = 'm'\ndepth = '10 cm'\non = 'ground'\n";

fn floor(friction: f64) -> String {
    format!("[contact.g]\nbetween = ['b', 'ground']\nfriction = {friction}\n")
}

/// Down a slope of 26.6° and out on level ground, where it stops: `motion` is that of the ground.
fn down_a_slope(name: &str, motion: &str) -> crate::page::Run {
    let text = format!(
        "[time]\nend = '3 s'\nstep = '500 us'\nscheme = 'moreau-jean-located'\n[ground]\n{motion}[ground.profile]\n\
         points = [['-1 m', '0.5 m'], ['0 m', '0 m'], ['4 m', '0 m']]\n{STONE}width = '10 cm'\nheight = '4 cm'\nat = '-0.5 m'\n{}",
        floor(0.25)
    );
    run(name, &text)
}

#[test]
fn what_slid_to_another_slope_lies_flat_there() {
    let still = down_a_slope("slid-to-another-slope", "");
    let shaken =
        "motion = { displacement = ['1 um', '0 m'], signal = 's' }\n[signal.s]\nshape = 'one-sine'\nperiod = '10 ms'\n";
    let shaken = down_a_slope("slid-to-another-slope-moved", shaken);
    for ran in [&still, &shaken] {
        let (summary, of) = (&ran.summary, &ran.summary.verdict[0]);
        let headline = &summary.headline;
        assert!(
            headline.contains("came to rest") && !headline.contains('φ') && !headline.contains("hops"),
            "{headline}"
        );
        assert_eq!(of.lies_on.as_ref().unwrap().word(), "base");
        // It falls by 25 cm less its share of friction, and turns only as it comes round the foot of the slope.
        assert!(of.max_phi_over_alpha.unwrap() < 0.05, "{:?}", of.max_phi_over_alpha);
        let (slid, displaced) = (of.slid.unwrap(), of.displaced.unwrap());
        assert!(slid > 0.8 && (displaced - slid).abs() < 0.02, "{slid} {displaced}");
        assert!(summary.peaks.iter().all(|peak| peak.phi.abs() < 0.03), "{:?}", summary.peaks);
    }
}

/// It lies as flat on a slope on which it didn't start, above the point of no return of level ground for a taller one.
#[test]
fn what_began_on_level_ground_and_came_down_on_a_slope_is_measured_from_that() {
    let text = format!(
        "[time]\nend = '2 s'\nstep = '500 us'\n[ground.profile]\npoints = [['-1 m', '0 m'], ['0 m', '0 m'], ['1 m', '0.36397 m'], ['2 m', '0.36397 m']]\n\
         {STONE}width = '10 cm'\nheight = '4 cm'\nat = '-20 cm'\nvelocity = ['2 m/s', '0 m/s']\n{}",
        floor(0.45)
    );
    let ran = run("came-up-a-slope", &text);
    let of = &ran.summary.verdict[0];
    assert_eq!(of.lies_on.as_ref().unwrap().word(), "base", "{}", ran.summary.headline);
    assert!(!ran.summary.headline.contains("at φ"), "{}", ran.summary.headline);
}

#[test]
fn what_hopped_further_than_its_base_is_told_where_it_is() {
    let text = format!(
        "[time]\nend = '2 s'\nstep = '200 us'\n[ground]\n{STONE}width = '10 cm'\nheight = '1 cm'\nat = '0 m'\nvelocity = ['0.6 m/s', '2 m/s']\n{}",
        floor(0.9)
    );
    let ran = run("hopped-aside", &text);
    let of = &ran.summary.verdict[0];
    let displaced = of.displaced.unwrap();
    // 2 · 2/9.81 s in the air.
    assert!((displaced - 0.6 * 4.0 / 9.81).abs() < 0.01 && of.slid.unwrap().abs() < 1e-3, "{displaced} {:?}", of.slid);
    let headline = &ran.summary.headline;
    assert!(
        headline.contains("came to rest") && headline.contains(" right of its start by hops and flights"),
        "{headline}"
    );
}

/// It slides down a slope and stumbles over a step at its foot.
#[test]
fn what_overturned_is_told_how_far_it_slid_before() {
    let text = format!(
        "[time]\nend = '1.5 s'\nstep = '200 us'\n[ground.profile]\n\
         points = [['-2 m', '1 m'], ['0 m', '0 m'], ['1 mm', '4 cm'], ['3 m', '4 cm']]\n{STONE}width = '10 cm'\nheight = '12 cm'\nat = '-0.6 m'\n{}",
        floor(0.1)
    );
    let ran = run("slid-and-overturned", &text);
    let of = &ran.summary.verdict[0];
    assert!(ran.summary.headline.contains("overturned"), "{}", ran.summary.headline);
    // From 5 cm before the foot of the slope its lower edge is at the step.
    let slid = of.slid.unwrap();
    assert!((slid - (0.6_f64.hypot(0.3) - 0.05)).abs() < 0.06, "{slid}");
    assert!(of.slid_in_all.unwrap() >= slid && of.displaced.is_none());
}

#[test]
fn a_disc_that_rolls_is_told_to_have_rolled() {
    let rolling = |end: &str, friction: f64, spin: f64| {
        let text = format!(
            "[time]\nend = '{end}'\nstep = '1 ms'\n[ground.profile]\npoints = [['-9 m', '0 m'], ['1 m', '0 m'], ['2 m', '1 m'], ['9 m', '1 m']]\n\
             [material.m]\ndensity = '2000 kg/m^3'\n[block.b]\nmaterial = 'm'\nradius = '5 cm'\ndepth = '10 cm'\nposition = ['0 m', '5 cm']\n\
             velocity = ['1 m/s', '0 m/s']\nspin = '{spin} rad/s'\n{}",
            floor(friction)
        );
        run(&format!("rolled-{end}-{friction}"), &text).summary.headline
    };
    let so_far = rolling("0.6283 s", 0.5, -20.0);
    assert_eq!(so_far, "`b` is still rolling, by 629 mm to the right (2.00 turns) so far");
    // What turns backwards as it goes doesn't roll.
    let slides = rolling("50 ms", 0.01, 400.0);
    assert!(
        slides.starts_with("`b` is still sliding, by 49.88 mm to the right so far; in all turned by 3."),
        "{slides}"
    );
    // In a valley from side to side.
    let text = format!(
        "[time]\nend = '8 s'\nstep = '1 ms'\n[ground.profile]\npoints = [['-2 m', '0.6 m'], ['0 m', '0 m'], ['1 m', '0 m'], ['3 m', '0.6 m']]\n\
         [block.b]\ndensity = '800 kg/m^3'\nradius = '10 cm'\ndepth = '10 cm'\non = 'ground'\nat = '-1.2 m'\n{}",
        floor(0.3)
    );
    let to_and_fro = run("rolled-in-a-valley", &text).summary.headline;
    let (in_all, at) =
        to_and_fro.strip_prefix("`b` is still rolling to and fro, ").unwrap().split_once(" m in all, by ").unwrap();
    let (at, _) = at.split_once(" m to the right (").unwrap();
    let [in_all, at] = [in_all, at].map(|of| of.parse::<f64>().unwrap());
    assert!(in_all > 2.0 * at && to_and_fro.ends_with(" turns) so far"), "{to_and_fro}");
}

#[test]
fn what_slid_back_past_its_start_is_down_the_slope_from_it() {
    let (sin, cos) = 20_f64.to_radians().sin_cos();
    let text = format!(
        "[time]\nend = '1.5 s'\nstep = '500 us'\n[ground]\nincline = '20 deg'\n{STONE}width = '10 cm'\nheight = '4 cm'\nat = '0 m'\n\
         velocity = ['{} m/s', '{} m/s']\n{}",
        2.0 * cos,
        2.0 * sin,
        floor(0.2)
    );
    let headline = run("slid-up-and-down", &text).summary.headline;
    assert!(
        headline.contains(" up the slope, then to ") && headline.ends_with(" down the slope from its start so far"),
        "{headline}"
    );
}

/// Its rocking dies out while the ground moves, which it does up to the end of the run.
#[test]
fn what_came_to_rest_on_ground_that_moves_up_to_the_end_says_so() {
    let text = format!(
        "[time]\nend = '2 s'\nstep = '500 us'\n[ground]\nmotion = {{ acceleration = ['0.05 m/s^2', '0 m/s^2'], signal = 's' }}\n\
         [signal.s]\nshape = 'one-sine'\nperiod = '2 s'\n{STONE}width = '10 cm'\nheight = '10 cm'\nat = '0 m'\ntilt = '1 deg'\n{}",
        floor(0.6)
    );
    let headline = run("rests-on-moving-ground", &text).summary.headline;
    assert!(headline.contains("came to rest on the moving ground at t = "), "{headline}");
}

/// At a turning point of the beam, and between two, what trembles on it stands on a beam that moves.
#[test]
fn whether_a_beam_moves_is_not_asked_of_the_last_instant() {
    for end in ["1.95 s", "2 s"] {
        let text = format!(
            "[time]\nend = '{end}'\nstep = '50 us'\n[material.steel]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n[beam.arm]\n\
             material = 'steel'\nspan = '1.2 m'\nwidth = '8 cm'\nthickness = '12 mm'\nelements = 24\nsupports = ['clamped', 'free']\n\
             damping_ratio = {{ mode = 1, ratio = 0.01 }}\nstart = 'static'\n[block.vase]\ndensity = '2700 kg/m^3'\nwidth = '8 cm'\n\
             height = '24 cm'\ndepth = '8 cm'\non = 'arm'\nat = '90 cm'\ntilt = '5 deg'\n[contact.feet]\nbetween = ['vase', 'arm']\n\
             friction = 0.6\n"
        );
        let headline = run(&format!("trembles-{end}"), &text).summary.headline;
        assert!(headline.contains("trembling where it stands, on a beam that moves"), "{end}: {headline}");
    }
}

/// The upper ones lie flat, too, on blocks on the slope, and have turned by nothing.
#[test]
fn a_stack_on_a_slope_stands_upright_on_that() {
    for (name, ground) in [
        ("incline", "[ground]\nincline = '20 deg'\n"),
        ("profile", "[ground.profile]\npoints = [['-1 m', '0 m'], ['0 m', '0 m'], ['1 m', '0.36397 m']]\n"),
    ] {
        let stone = STONE.replace("material = 'm'", "material = 'm'\nrepeat = { count = 2, stacked = true }");
        let text = format!(
            "[time]\nend = '0.4 s'\nstep = '1 ms'\n{ground}{stone}width = '20 cm'\nheight = '10 cm'\nat = '0.5 m'\n\
             [contact.g]\nbetween = ['*', 'ground']\nfriction = 0.6\n[contact.j]\nbetween = ['*', '*']\nfriction = 0.6\n"
        );
        let ran = run(&format!("stack-on-{name}"), &text);
        assert_eq!(ran.summary.headline, "`b-1` stood still throughout; `b-2` stood still throughout", "{name}");
        for of in &ran.summary.verdict {
            assert_eq!(of.lies_on.as_ref().unwrap().word(), "base", "{name}");
            assert!(of.max_phi_over_alpha.unwrap() < 1e-9, "{name}: {:?}", of.max_phi_over_alpha);
        }
    }
}

/// Blocks whose base is from 14 cm left to 6 cm right of a crest, beyond which the ground goes down: what one and three on each other are told.
fn over_a_crest(name: &str, down: f64, shake: f64, [storeys, height]: [usize; 2]) -> crate::page::Run {
    let stone =
        STONE.replace("material = 'm'", &format!("material = 'm'\nrepeat = {{ count = {storeys}, stacked = true }}"));
    let stone = if storeys == 1 { STONE.to_owned() } else { stone };
    run(
        name,
        &format!(
            "[time]\nend = '3 s'\nstep = '500 us'\n[ground]\nprofile = {{ points = [['-2 m', '0 m'], ['0 m', '0 m'], ['2 m', '-{down} m']] }}\n\
             motion = {{ acceleration = ['{shake} m/s^2', '0 m/s^2'], signal = 's' }}\n[signal.s]\nshape = 'one-sine'\nperiod = '0.5 s'\n\
             {stone}width = '20 cm'\nheight = '{height} cm'\nat = '-4 cm'\n[contact.c]\nbetween = ['*', '*']\nfriction = 0.9\n"
        ),
    )
}

/// It turns about the crest, even on to lying flat beyond it, but its mass centre stays on this side, to which it falls back.
#[test]
fn what_rocks_about_a_crest_counts_from_where_it_falls_back_to() {
    let tower = over_a_crest("tower-rocks-on-crest", 0.2, 2.5, [1, 72]).summary;
    let column = over_a_crest("column-rocks-on-crest", 0.2, 2.5, [3, 24]).summary;
    // The peak is at 6.02°, and atan(10/36) is 15.52°.
    assert!((tower.verdict[0].max_phi_over_alpha.unwrap() - 0.388).abs() < 1e-3, "{}", tower.headline);
    assert!(tower.headline.starts_with("`b` rocks on, last peak −3.06°"), "{}", tower.headline);
    assert!(column.headline.starts_with("all 3 blocks rock on as one column"), "{}", column.headline);
    assert!(column.headline.ends_with("largest φ/α of the column 0.388"), "{}", column.headline);
    for of in [&tower, &column] {
        let peaks: Vec<f64> = of.peaks.iter().filter(|peak| peak.body.starts_with('b')).map(|peak| peak.phi).collect();
        assert!(peaks.len() >= 5 && (peaks[0] + 0.105).abs() < 1e-3, "{peaks:?}");
    }
}

/// On the slope beyond the crest neither could stand.
#[test]
fn what_overturns_over_a_crest_does_so_as_from_level_ground() {
    let tower = over_a_crest("tower-over-crest", 1.0, 3.4, [1, 72]).summary;
    let column = over_a_crest("column-over-crest", 1.0, 3.4, [3, 24]).summary;
    assert!(
        column
            .headline
            .starts_with("all 3 blocks overturned as one column on the base of `b-1` to the right at t = 591.")
    );
    let of = &tower.verdict[0];
    assert!((of.overturned_at.unwrap() - 0.5912).abs() < 1e-3, "{:?}", of.overturned_at);
    assert!(of.max_phi_over_alpha.unwrap() > 2.0, "{:?}", of.max_phi_over_alpha);
    assert_eq!(of.lies_on.as_ref().unwrap().word(), "right side");
    assert!(tower.peaks.iter().all(|peak| peak.phi < 0.1), "{:?}", tower.peaks);
}

/// Its right foot is over the slope beyond the crest, and its angle is zero but for rounding.
#[test]
fn what_stands_over_a_crest_is_displaced_by_nothing() {
    let text = format!(
        "[time]\nend = '1 s'\nstep = '500 us'\n[ground.profile]\npoints = [['-2 m', '0 m'], ['0 m', '0 m'], ['2 m', '-1 m']]\n\
         {STONE}width = '20 cm'\nheight = '10 cm'\nat = '-3 cm'\n{}",
        floor(0.8)
    );
    let ran = run("still-over-a-crest", &text);
    assert_eq!(ran.summary.headline, "`b` stood still throughout");
    assert!(ran.summary.verdict[0].displaced.unwrap().abs() < 1e-12, "{:?}", ran.summary.verdict[0].displaced);
}
