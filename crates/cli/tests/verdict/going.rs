//! What moves at the end says how.

use super::{FLOOR, ROCKER, TIME, scenario, scene, what};

#[test]
fn what_turns_on_at_the_end_is_still_tipping() {
    // Pushed by a tenth of what turns it over, it turns for a while and comes back.
    let text = |end: &str, spin: f64| {
        format!(
            "[time]\nend = '{end}'\nstep = '200 us'\n[ground]\n{ROCKER}spin = '{spin} rad/s'\nvelocity = ['{} m/s', '{} m/s']\n{FLOOR}",
            -0.0675 * spin,
            0.015 * spin.abs()
        )
    };
    let headline = |end: &str, spin: f64| {
        scene(&format!("tips-{end}-{spin}"), &text(end, spin)).summary["headline"].as_str().unwrap().to_owned()
    };
    assert!(headline("20 ms", 1.0).contains("`b` is still tipping to the left: φ 0.8"), "{}", headline("20 ms", 1.0));
    assert!(headline("20 ms", -1.0).contains("`b` is still tipping to the right: φ \u{2212}0.8"));
    let back = headline("70 ms", 1.0);
    assert!(back.contains("has not been upright yet"), "{back}");
}

#[test]
fn a_disc_that_rolls_does_not_overturn() {
    let text = format!(
        "{TIME}[ground]\n[block.b]\nmaterial = 'a'\nradius = '5 cm'\ndepth = '3 cm'\nposition = ['0 m', '5 cm']\n\
         velocity = ['1 m/s', '0 m/s']\nspin = '-20 rad/s'\n{FLOOR}"
    );
    let ran = scene("disc", &text);
    assert!(ran.column("b.phi").last().unwrap().abs() > std::f64::consts::TAU);
    assert_eq!(what(&ran), ("moves", None));
    assert!(ran.verdict("b")["max_phi_over_alpha"].is_null() && ran.summary["overturned_at"].is_null());
}

#[test]
fn what_moves_at_the_end_says_how() {
    let round = "[block.b]\nmaterial = 'a'\nradius = '5 cm'\ndepth = '5 cm'\n";
    let rolling = format!("{round}on = 'ground'\nat = '0 m'\nvelocity = ['1 m/s', '0 m/s']\nspin = '-20 rad/s'\n");
    let falling = format!("{round}position = ['0 m', '30 m']\n");
    let bouncing = format!("{round}position = ['0 m', '1 m']\n");
    let lively = FLOOR.replace("friction = 0.5", "friction = 0.5\nrestitution = 0.95");
    for (name, block, floor, how) in [
        ("rolls", &rolling, FLOOR, "rolling"),
        ("falls", &falling, FLOOR, "falling"),
        ("bounces", &bouncing, &lively, "bouncing"),
    ] {
        let ran =
            scene(&format!("going-{name}"), &format!("[time]\nend = '1.3 s'\nstep = '1 ms'\n[ground]\n{block}{floor}"));
        // The disc goes 1 m/s for 1.3 s.
        let far = if name == "rolls" { ", by 1.3 m to the right (4.14 turns) so far" } else { "" };
        assert_eq!(ran.summary["headline"].as_str().unwrap(), format!("`b` is still {how}{far}"));
    }
}

#[test]
fn a_plate_that_a_beam_lifts_by_micrometres_does_not_bounce() {
    let text = "[time]\nend = '0.5 s'\nstep = '100 us'\n[material.steel]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n\
        [beam.t]\nmaterial = 'steel'\nspan = '1 m'\nwidth = '5 cm'\nthickness = '5 mm'\nelements = 20\n\
        damping_ratio = { mode = 1, ratio = 0.01 }\n[block.plate]\nmaterial = 'steel'\nwidth = '10 cm'\nheight = '1 cm'\n\
        depth = '5 cm'\nposition = ['50 cm', '1.5 cm']\n[contact.f]\nbetween = ['plate', 't']\nfriction = 0.3\n";
    // By tens of micrometres in the last 0.1 s, or by less than can be seen, also where it was thrown higher before, and by 0.16 mm.
    let trembles = "trembling where it stands, on a beam that moves";
    let hops = "`plate` is at rest but for hops of less than a ten-thousandth of its size, on a beam that moves";
    for (restitution, end, how) in
        [("0.5", "0.5 s", trembles), ("0.9", "0.28 s", "bouncing, on a beam that moves"), ("0.9", "0.5 s", trembles)]
    {
        let text = text.replace("0.5 s", end);
        let ran = scene(&format!("plate-{restitution}-{end}"), &format!("{text}restitution = {restitution}\n"));
        let headline = ran.summary["headline"].as_str().unwrap();
        assert!(headline == format!("`plate` is still {how}") || (how == trembles && headline == hops), "{headline}");
    }
}

/// 70 ms after it has landed it hops by some nanometres, faster than what is still.
#[test]
fn what_hops_by_less_than_can_be_seen_is_at_rest() {
    let text = |end: &str| {
        format!(
            "[time]\nend = '{end}'\nstep = '50 us'\n[ground]\n[block.b]\nmaterial = 'a'\nwidth = '10 cm'\nheight = '2 cm'\n\
             depth = '5 cm'\nposition = ['0 cm', '1.5 cm']\n[contact.f]\nbetween = ['b', 'ground']\nfriction = 0.3\n\
             restitution = 0.5\n"
        )
    };
    // 5 mm takes 32 ms, bounces as long again: v = 0.31 m/s, then 0.16, 0.08 … m/s, each for 2v/g.
    let late = scene("hops", &text("93 ms"));
    let headline = late.summary["headline"].as_str().unwrap();
    assert_eq!(headline, "`b` is at rest but for hops of less than a ten-thousandth of its size");
    let early = scene("hops-early", &text("60 ms"));
    assert_eq!(early.summary["headline"], "`b` is still bouncing");
}

/// A couple of 0.14 N m lifts an edge of a plate that 0.137 N m would balance: it turns faster and faster, by 2 mrad after 40 ms, and never flies.
#[test]
fn a_plate_that_tips_up_does_not_hop() {
    for end in ["5 ms", "15 ms", "40 ms"] {
        let text = format!(
            "[time]\nend = '{end}'\nstep = '100 us'\n[ground]\n[block.b]\ndensity = '700 kg/m^3'\nwidth = '20 cm'\nheight = '1 cm'\n\
             depth = '10 cm'\non = 'ground'\nat = '0 cm'\n[contact.c]\nbetween = ['b', 'ground']\nfriction = 0.6\n\
             [force.f]\non = 'b'\nforce = ['0 N', '0 N']\ncouple = '0.14 N m'\n"
        );
        let ran = scene(&format!("tips-{}", end.replace(' ', "-")), &text);
        let omega = ran.column("b.omega");
        let [before, last] = [omega[omega.len() / 2], omega[omega.len() - 1]];
        assert!(before.abs() > 0.0 && last.abs() > before.abs(), "{end}: {before} and {last} rad/s");
        let headline = ran.summary["headline"].as_str().unwrap();
        assert!(!headline.contains("at rest"), "{end}: {headline}");
    }
}

#[test]
fn a_block_on_springs_vibrates_when_it_no_longer_leaves_them() {
    let ran = scenario("compliant-drop", "verdict-springs", &[]);
    assert_eq!(ran.summary["headline"], "`box` is still vibrating on its contacts");
    // While flights go on it bounces.
    let early = scenario("compliant-drop", "verdict-springs-early", &["time.end=\"0.3 s\""]);
    assert_eq!(early.summary["headline"], "`box` is still bouncing");
}

#[test]
fn what_hands_a_blow_on_within_a_step_did_not_stand_still() {
    let ran = scenario("newtons-cradle", "verdict-cradle", &[]);
    let headline = ran.summary["headline"].as_str().unwrap();
    assert!(headline.starts_with("4 of 5 blocks came to rest, last at t = 100.3 ms"), "{headline}");
}

/// It comes down on one corner after the other, and at each of these ends is a little lower than when it last touched the ground.
#[test]
fn what_comes_down_on_its_next_corner_does_not_fall() {
    for end in ["0.335 s", "0.34 s", "0.345 s"] {
        let text = format!(
            "[time]\nend = '{end}'\nstep = '200 us'\n[ground]\n[block.b]\nmaterial = 'a'\nwidth = '12 cm'\nheight = '10 cm'\ndepth = '10 cm'\n\
             position = ['0 m', '20 cm']\nangle = '30 deg'\nspin = '3 rad/s'\n[contact.f]\nbetween = ['b', 'ground']\nfriction = 0.6\n\
             restitution = 0.6\n"
        );
        let ran = scene(&format!("next-corner-{}", end.replace(' ', "-")), &text);
        assert!(ran.summary["impact_count"].as_u64().unwrap() > 0, "it has landed");
        assert_eq!(ran.summary["headline"], "`b` is still bouncing", "{end}");
    }
}
