//! The sentence on what became of a scene, where a word would say more than is true.

use crate::page::{run, run_from, scenario};
use crate::plots::table;
use crate::sizes::tile;
use teeter_report::half_cycles;

const BOUNCING: &str = "[time]\nend = '3 s'\nstep = '500 us'\n[ground]\nmotion = { displacement = ['0 mm', '8 mm'], signal = 'shake' }\n\
    [signal.shake]\nshape = 'harmonic'\nphase = '90 deg'\nfrequency = '9 Hz'\n[block.cube]\ndensity = '1000 kg/m^3'\nwidth = '20 cm'\n\
    height = '6 cm'\ndepth = '10 cm'\non = 'ground'\nat = '0 m'\ntilt = '4 deg'\n[contact.feet]\nbetween = ['cube', 'ground']\n\
    friction = 0.4\nrestitution = 0.6\n";

#[test]
fn what_bounces_neither_rocks_nor_slides() {
    let bouncing = run("bouncing", BOUNCING);
    let headline = &bouncing.summary.headline;
    assert!(headline.starts_with("`cube` is still bouncing, on ground that moves"), "{headline}");
    assert!(!headline.contains("rocks") && !headline.contains("slid"), "{headline}");
    assert!(!bouncing.summary.crossings.is_empty() && half_cycles(&bouncing.page, &bouncing.summary).is_empty());
    assert!(!bouncing.html.contains("id=\"rocking\""));
    assert!(bouncing.html.contains("id=\"no-half-cycles\""), "it says why");
}

/// Its passages are those of the beam's axis: from the line between its feet it swings by less than counts, of which no half cycle is listed.
#[test]
fn why_a_block_on_a_beam_has_no_half_cycles_is_told() {
    let text = "[time]\nend = '0.8 s'\nstep = '50 us'\n[material.alu]\ndensity = '2700 kg/m^3'\nyoungs_modulus = '69 GPa'\n[beam.table]\n\
        material = 'alu'\nspan = '50 cm'\nwidth = '4 cm'\nthickness = '2.5 mm'\nelements = 40\nsupports = ['clamped', 'clamped']\n\
        start = 'static'\ndamping_ratio = { mode = 1, ratio = 0.02 }\n[block.tall]\nmaterial = 'alu'\nwidth = '3 cm'\nheight = '12 cm'\n\
        depth = '3 cm'\non = 'table'\nat = '17 cm'\ntilt = '6 deg'\n[block.wide]\nmaterial = 'alu'\nwidth = '6 cm'\nheight = '5 cm'\n\
        depth = '3 cm'\non = 'table'\nat = '24 cm'\n[contact.feet]\nbetween = ['*', 'table']\nfriction = 0.5\n\
        [contact.sides]\nbetween = ['tall', 'wide']\nfriction = 0.3\n";
    let beside = run("wide-beside-tall", text);
    let cycles = half_cycles(&beside.page, &beside.summary);
    assert!(!cycles.is_empty() && cycles.iter().all(|cycle| cycle.body == "tall"));
    let passed = beside.summary.crossings.iter().filter(|crossing| crossing.body == "wide").count();
    assert!(passed > 1, "{passed}");
    let told = format!("against the beam’s undeformed axis: wide passed {passed} times through φ = 0.");
    assert!(beside.html.contains(&told), "{told}");
}

const CANTILEVER: &str = "[time]\nend = '0.2 s'\nstep = '100 us'\n[material.steel]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n[beam.shelf]\n\
        material = 'steel'\nspan = '60 cm'\nwidth = '4 cm'\nthickness = '6 mm'\nelements = 24\nsupports = ['clamped', 'free']\n\
        damping_ratio = { mode = 1, ratio = 0.02 }\n[block.cube]\ndensity = '2000 kg/m^3'\nwidth = '4 cm'\nheight = '4 cm'\ndepth = '4 cm'\n\
        position = ['50 cm', '7 cm']\n[contact.c]\nbetween = ['cube', 'shelf']\nfriction = 0.4\nrestitution = 0.3\n";

/// A cube that is dropped near the end of a cantilever bounces, and turns by degrees as it does; 0.2 s later it still does, whatever the step.
#[test]
fn why_what_bounces_on_a_beam_has_no_half_cycles_is_told() {
    let html = run("cube-on-cantilever", CANTILEVER).html;
    assert!(html.contains(
        "of what turns to and fro only before it has settled on its beam, as what bounces does: cube passed "
    ));
}

/// At 0.8 s its last swing is 0.3 s ago; it slips to and fro by 60 µm as its corners bounce on the tip.
#[test]
fn what_slips_a_little_as_its_contacts_open_and_close_chatters() {
    let text = CANTILEVER.replace("end = '0.2 s'", "end = '0.8 s'").replace("'50 cm', '7 cm'", "'57 cm', '7 cm'");
    let headline = run("chatters-on-a-tip", &text).summary.headline;
    let told = "`cube` stopped rocking at t = 475.5 ms, is still chattering where it stands, on a beam that moves (";
    assert!(headline.starts_with(told), "{headline}");
}

/// It is thrown to the right and turns counter-clockwise, to its left: neither side alone says what it did.
#[test]
fn what_turns_over_against_its_way_is_told_how_it_turned_and_where_it_is() {
    let thrown = |velocity: f64| {
        let text = format!(
            "[time]\nend = '2 s'\nstep = '200 us'\n[ground]\n[block.b]\ndensity = '2400 kg/m^3'\nwidth = '10 cm'\nheight = '30 cm'\n\
             depth = '10 cm'\non = 'ground'\nat = '0 m'\nvelocity = ['{velocity} m/s', '0 m/s']\nspin = '8 rad/s'\n\
             [contact.c]\nbetween = ['b', 'ground']\nfriction = 0.05\n"
        );
        run(&format!("thrown-{velocity}"), &text)
    };
    let right = thrown(2.0);
    let headline = &right.summary.headline;
    let rest =
        headline.strip_prefix("`b` overturned counter-clockwise at t = ").unwrap_or_else(|| panic!("{headline}"));
    let (at, _) = rest
        .split_once(" ms, in the end ")
        .and_then(|(_, place)| place.split_once(" m right of its start"))
        .unwrap_or_else(|| panic!("{headline}"));
    let rows = table(&right.folder.join("trajectory.csv"));
    let (_, x) = rows.iter().find(|(name, _)| name == "b.x").unwrap();
    assert!((x[x.len() - 1] - x[0] - at.parse::<f64>().unwrap()).abs() < 1e-3, "{headline}");
    let left = thrown(-2.0).summary.headline;
    assert!(left.starts_with("`b` overturned to the left at t = ") && !left.contains("in the end"), "{left}");
}

/// A run that goes on from the state of another one begins with what stands there standing: it wasn't released in flight.
#[test]
fn what_stands_in_the_state_that_a_run_begins_with_has_stood_from_its_start() {
    let text = |end: &str| {
        format!(
            "[time]\nend = '{end}'\nstep = '500 us'\n[ground]\n[block.stands]\ndensity = '2400 kg/m^3'\nwidth = '10 cm'\nheight = '20 cm'\n\
             depth = '10 cm'\non = 'ground'\nat = '0 m'\n[block.rocks]\ndensity = '2400 kg/m^3'\nwidth = '10 cm'\nheight = '30 cm'\n\
             depth = '10 cm'\non = 'ground'\nat = '1 m'\ntilt = '8 deg'\n[contact.feet]\nbetween = ['*', 'ground']\nfriction = 0.5\n"
        )
    };
    let (_, state) = run_from("goes-on", &text("0.5 s"), None);
    let (on, _) = run_from("went-on", &text("1 s"), Some(state));
    let headline = &on.summary.headline;
    assert!(headline.starts_with("`stands` stood still throughout; `rocks` rocks on, last peak "), "{headline}");
    assert!(
        !headline.contains("since it could no longer turn over")
            && !on.html.contains("since it could no longer turn over"),
        "{headline}"
    );
    assert_eq!(on.summary.verdict[0].rests_from, Some(0.5));
    assert!(on.summary.verdict[0].displaced.is_some());
}

fn dropped(name: &str, end: &str, step: &str, block: &str, floor: &str) -> String {
    let text = format!(
        "[time]\nend = '{end}'\nstep = '{step}'\n[ground]\n[block.b]\ndepth = '10 cm'\n{block}[contact.feet]\nbetween = ['b', 'ground']\n{floor}"
    );
    run(name, &text).summary.headline
}

/// Nothing pushes it sideways: its mass centre stays over one place, however it turns in the air.
#[test]
fn what_flies_is_where_its_mass_centre_is() {
    let block =
        "density = '700 kg/m^3'\nwidth = '30 cm'\nheight = '10 cm'\nposition = ['0 m', '50 cm']\nangle = '10 deg'\n";
    let headline = dropped("puck", "20 s", "500 us", block, "friction = 0\nrestitution = 0.98\n");
    assert!(headline.contains("is still bouncing") && !headline.contains(" of "), "{headline}");
}

/// It slid by no more than 8 mm of more than a metre.
#[test]
fn what_flew_before_it_slid_is_told_where_it_is() {
    let block = "density = '2000 kg/m^3'\nwidth = '12 cm'\nheight = '20 cm'\nposition = ['0 m', '80 cm']\nangle = '35 deg'\n\
        spin = '4 rad/s'\nvelocity = ['0.8 m/s', '0 m/s']\n";
    let headline = dropped("die", "3 s", "200 us", block, "friction = 0.4\nrestitution = 0.5\n");
    assert!(headline.contains("`b` slid by 7.") && headline.contains(" (1.13"), "{headline}");
    assert!(headline.contains(" m right of where it was released) and came to rest"), "{headline}");
}

/// The two have a contact that is listed, but neither stands on the other.
#[test]
fn blocks_beside_each_other_do_not_stand_on_each_other() {
    let block = |name: &str, at: &str| {
        format!(
            "[block.{name}]\ndensity = '2000 kg/m^3'\nwidth = '10 cm'\nheight = '40 cm'\ndepth = '10 cm'\non = 'ground'\nat = '{at}'\n\
             tilt = '5 deg'\n"
        )
    };
    let text = format!(
        "[time]\nend = '1 s'\nstep = '200 us'\n[ground]\n{}{}[contact.feet]\nbetween = ['*', 'ground']\nfriction = 0.6\n\
         [contact.sides]\nbetween = ['a', 'b']\nfriction = 0.3\n",
        block("a", "0 m"),
        block("b", "30 cm")
    );
    let beside = run("beside", &text);
    assert!(half_cycles(&beside.page, &beside.summary).iter().any(|cycle| cycle.omega.is_some()));
    assert!(!beside.html.contains("stands on another one"));
}

/// A joint closes with the foot of the column, which then falls: neither velocities nor a peak are known.
#[test]
fn no_half_cycle_is_a_row_of_dashes() {
    let text = "[time]\nend = '1 s'\nstep = '500 us'\n[signal.pulse]\nshape = 'one-sine'\nfrequency = '1.6 Hz'\nstart = '0.2 s'\n\
        [ground]\nmotion = { acceleration = ['3.8 m/s^2', '0 m/s^2'], signal = 'pulse' }\n[block.stone]\ndensity = '2400 kg/m^3'\n\
        width = '14 cm'\nheight = '20 cm'\ndepth = '14 cm'\non = 'ground'\nat = '75 cm'\nrepeat = { count = 3, stacked = true }\n\
        [contact.base]\nbetween = ['stone-*', 'ground']\nfriction = 0.7\n[contact.joints]\nbetween = ['stone-*', 'stone-*']\nfriction = 0.7\n";
    let falls = run("column-falls-after-a-swing", text);
    assert!(!falls.summary.crossings.is_empty());
    for cycle in half_cycles(&falls.page, &falls.summary) {
        assert!(cycle.omega.is_some() || cycle.peak_after.is_some(), "{cycle:?}");
    }
}

/// On ground that is shaken for a while.
#[test]
fn what_slid_to_both_sides_and_came_to_rest_is_told_to_both() {
    let text = "[time]\nend = '5 s'\nstep = '1 ms'\n[ground]\nmotion = { acceleration = ['3 m/s^2', '0 m/s^2'], signal = 's' }\n\
        [signal.s]\nshape = 'product'\nfactors = ['sine', 'envelope']\n[signal.sine]\nshape = 'harmonic'\nfrequency = '1 Hz'\n\
        [signal.envelope]\nshape = 'half-sine'\nduration = '3.5 s'\n[block.b]\ndensity = '2500 kg/m^3'\nwidth = '1 m'\nheight = '20 cm'\n\
        depth = '1 m'\non = 'ground'\nat = '0 m'\n[contact.c]\nbetween = ['b', 'ground']\nfriction = 0.1\n";
    let ran = run("both-sides", text);
    let headline = &ran.summary.headline;
    assert!(headline.starts_with("`b` slid to and fro, up to "), "{headline}");
    for told in [" left of and ", " right of its start, in the end ", " mm left of it (", " in all) and came to rest"] {
        assert!(headline.contains(told), "{told}: {headline}");
    }
}

/// Three blocks on each other, tilted as one, which rock on the base of the lowest.
#[test]
fn blocks_that_turn_as_one_rock_as_a_column() {
    let text = "[time]\nend = '2 s'\nstep = '500 us'\n[ground]\nmotion = { acceleration = ['2.5 m/s^2', '0 m/s^2'], signal = 'shake' }\n\
        [signal.shake]\nshape = 'one-sine'\nperiod = '0.8 s'\n[block.drum]\ndensity = '2700 kg/m^3'\nwidth = '1 m'\nheight = '1.5 m'\n\
        depth = '1 m'\non = 'ground'\nat = '0 m'\nrepeat = { count = COUNT, stacked = true }\n[contact.floor]\nbetween = ['*', 'ground']\n\
        friction = 0.7\n[contact.joints]\nbetween = ['*', '*']\nfriction = 0.7\n";
    let four = run("column-of-four", &text.replace("COUNT", "4"));
    let headline = &four.summary.headline;
    let told = "all 4 blocks rock on as one column on the base of `drum-1`; largest φ/α of the column ";
    let share: f64 = headline.strip_prefix(told).unwrap_or_else(|| panic!("{headline}")).parse().unwrap();
    // The angle is that of all of them, α not: atan(1/6) of the column, atan(1/1.5) of a drum.
    let own = four.summary.max_phi_over_alpha.unwrap();
    let wanted = own * (1.0_f64 / 1.5).atan() / (1.0_f64 / 6.0).atan();
    assert!((share / wanted - 1.0).abs() < 0.02, "{share} {wanted}");
    let two = run("column-of-two", &text.replace("COUNT", "2").replace("1.5 m", "3 m"));
    let headline = &two.summary.headline;
    assert!(
        headline.contains("`drum-1` rocks on") && headline.contains("`drum-2` rocks as one with `drum-1`"),
        "{headline}"
    );
    assert!(headline.contains("largest φ/α of the column"), "{headline}");
}

/// Past the point of no return of all of them together, atan(14/60), nothing brings them back, long before it is a single one's, atan(14/20).
#[test]
fn a_column_overturns_where_all_of_it_is_past_its_point_of_no_return() {
    let falling = |end: &str| {
        let text = format!(
            "[time]\nend = '{end}'\nstep = '500 us'\n[signal.pulse]\nshape = 'one-sine'\nfrequency = '1.6 Hz'\nstart = '0.2 s'\n\
             [ground]\nmotion = {{ acceleration = ['3.4 m/s^2', '0 m/s^2'], signal = 'pulse' }}\n[block.stone]\ndensity = '2400 kg/m^3'\n\
             width = '14 cm'\nheight = '20 cm'\ndepth = '14 cm'\non = 'ground'\nat = '75 cm'\nrepeat = {{ count = 3, stacked = true }}\n\
             [contact.base]\nbetween = ['stone-*', 'ground']\nfriction = 0.7\n[contact.joints]\nbetween = ['stone-*', 'stone-*']\n\
             friction = 0.7\n"
        );
        run(&format!("falling-column-{}", end.replace(' ', "-")), &text)
    };
    let told = "all 3 blocks overturned as one column on the base of `stone-1` to the right at t = ";
    let mut times = Vec::new();
    for end in ["0.95 s", "2.5 s"] {
        let falling = falling(end);
        assert!(falling.summary.headline.starts_with(told), "{}", falling.summary.headline);
        assert!(!falling.summary.headline.contains("φ/α"), "{}", falling.summary.headline);
        for of in &falling.summary.verdict {
            times.push(of.overturned_at.unwrap());
        }
        assert_eq!(falling.summary.overturned_at, falling.summary.verdict[0].overturned_at);
    }
    assert!(times.iter().all(|t| (t - times[0]).abs() < 1e-4), "{times:?}");
    // It doesn't say so before.
    let before = falling(&format!("{:.4} s", times[0] - 1e-3)).summary;
    assert!(before.overturned_at.is_none() && before.headline.contains("rock on as one column"), "{}", before.headline);
    let share = before.verdict[0].column.unwrap();
    assert!((0.97..1.0).contains(&share), "{share}");
}

/// A couple of 0.14 N m lifts an edge of a plate that 0.137 N m would balance.
#[test]
fn a_plate_that_tips_does_not_tremble() {
    let tipping = |end: &str| {
        let text = format!(
            "[time]\nend = '{end}'\nstep = '100 us'\n[ground]\n[block.b]\ndensity = '700 kg/m^3'\nwidth = '20 cm'\nheight = '1 cm'\n\
             depth = '10 cm'\non = 'ground'\nat = '0 cm'\n[contact.c]\nbetween = ['b', 'ground']\nfriction = 0.6\n\
             [force.f]\non = 'b'\nforce = ['0 N', '0 N']\ncouple = '0.14 N m'\n"
        );
        run(&format!("tipping-{}", end.replace(' ', "-")), &text).summary.headline
    };
    assert_eq!(tipping("15 ms"), "`b` still moves");
    assert!(tipping("50 ms").starts_with("`b` is still tipping to the left: φ 0."), "{}", tipping("50 ms"));
}

#[test]
fn what_stands_on_a_beam_that_moves_says_so() {
    let text = "[time]\nend = '2 s'\nstep = '200 us'\n[material.steel]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n\
        [beam.bridge]\nmaterial = 'steel'\nsection = 'i-section'\nspan = '12 m'\nwidth = '10 cm'\nheight = '20 cm'\nweb = '5.6 mm'\n\
        flange = '8.5 mm'\nelements = 48\ndamping_ratio = { mode = 1, ratio = 0.01 }\nself_weight = true\nstart = 'static'\n\
        support.mid = { at = '5 m', kind = 'pinned' }\n[load.wagon]\non = 'bridge'\nat = '0 m'\nspeed = '8 m/s'\nforce = '-8 kN'\n\
        [block.crate]\ndensity = '1000 kg/m^3'\nwidth = '20 cm'\nheight = '60 cm'\ndepth = '50 cm'\non = 'bridge'\nat = '8 m'\n\
        [contact.b]\nbetween = ['crate', 'bridge']\nfriction = 0.4\n";
    let headline = run("on-a-bridge", text).summary.headline;
    assert_eq!(headline, "`crate` stood on `bridge` throughout");
    // Until the wagon is off it is as still as the beam, which begins to swing then.
    let off = run("off-a-bridge", &text.replace("end = '2 s'", "end = '2.5 s'"));
    assert!(off.summary.rests_from.is_some_and(|t| t > 0.0), "{:?}", off.summary.rests_from);
    assert_eq!(off.summary.headline, "`crate` stood on `bridge` throughout");
    assert!(!off.html.contains("<dt>All at rest"));
    // Its corners, and the ends of the beam, which its sides could touch.
    assert!(off.html.contains("; 4 possible contacts, and those of ends and humps of beams with sides of blocks"));
    // What moves is the beam under both.
    let lid = "[block.lid]\ndensity = '1000 kg/m^3'\nwidth = '16 cm'\nheight = '10 cm'\ndepth = '50 cm'\non = 'crate'\nat = '8 m'\n\
        [contact.lid]\nbetween = ['lid', 'crate']\nfriction = 0.4\n";
    let headline = run("lid-on-a-bridge", &format!("{}{lid}", text.replace("'2 s'", "'1.4 s'"))).summary.headline;
    assert!(headline.ends_with("`lid` is standing still on the block below it, on a beam that moves"), "{headline}");
}

/// The sentence at the head doesn't stand beside a warning against it as if that were not there.
#[test]
fn a_motion_that_steps_do_not_resolve_is_told_with_a_reserve() {
    let text = include_str!("../../../../scenarios/free-rocking-on-ground.toml");
    let [head, rest] = text.split_once("[time]").map(|(head, rest)| [head, rest]).unwrap();
    let own = |line: &&str| !line.starts_with("step") && !line.starts_with("scheme") && !line.starts_with("every");
    let rest = rest.lines().filter(own).collect::<Vec<_>>().join("\n");
    let coarse = run("coarse", &format!("{head}[time]\nstep = '2 ms'\nscheme = 'moreau-jean'{rest}"));
    let warning = coarse.summary.warnings.iter().find(|warning| warning.code == "under-resolved").unwrap();
    assert!(!warning.text.contains("all together") && !warning.text.contains("  "), "{}", warning.text);
    let verdict = &coarse.html[coarse.html.find("id=\"verdict\"").unwrap()..];
    let reserve = coarse.summary.reserve().unwrap();
    assert!(verdict[..verdict.find("</p>").unwrap()].contains(&format!("; {reserve}")));
    assert_eq!(scenario("free-rocking-on-ground").summary.reserve(), None);
    // A plate that falls at 4 m/s goes 8 cm in a step.
    let deep = run(
        "deep",
        "[time]\nend = '1 s'\nstep = '20 ms'\nscheme = 'moreau-jean'\n[ground]\n[block.b]\ndensity = '1000 kg/m^3'\nwidth = '20 cm'\nheight = '5 cm'\n\
         depth = '10 cm'\nposition = ['0 m', '84 cm']\n[contact.c]\nbetween = ['b', 'ground']\nfriction = 0.4\n",
    );
    let codes: Vec<_> = deep.summary.warnings.iter().map(|warning| warning.code.as_ref()).collect();
    assert!(codes.contains(&"deep-penetration"), "{codes:?}");
    assert_eq!(deep.summary.reserve(), Some("see the warnings"));
}

#[test]
fn the_last_peak_of_the_headline_is_the_last_of_the_summary() {
    for name in ["free-rocking-on-beam", "free-rocking-on-ground"] {
        let summary = &scenario(name).summary;
        let last = summary.peaks.last().unwrap();
        assert_eq!((Some(last.phi), Some(last.t)), (summary.verdict[0].last_peak, summary.verdict[0].t), "{name}");
    }
}

/// A block that rides on one that rocks is tilted against it by rounding only.
#[test]
fn what_rides_on_a_block_that_rocks_does_not_tip() {
    for end in ["1.0 s", "1.15 s", "1.25 s"] {
        let text = format!(
            "[time]\nend = '{end}'\nstep = '500 us'\n[ground]\n\
             motion = {{ acceleration = ['3.6 m/s^2', '0 m/s^2'], signal = 'shake' }}\n[signal.shake]\nshape = 'one-sine'\n\
             period = '0.8 s'\n[block.base]\ndensity = '2700 kg/m^3'\nwidth = '1.2 m'\nheight = '4 m'\ndepth = '1 m'\n\
             on = 'ground'\nat = '0 m'\n[block.right]\ndensity = '2700 kg/m^3'\nwidth = '0.3 m'\nheight = '0.5 m'\n\
             depth = '1 m'\non = 'base'\nat = '0.3 m'\n[contact.floor]\nbetween = ['base', 'ground']\nfriction = 0.7\n\
             [contact.joint]\nbetween = ['right', 'base']\nfriction = 0.7\n"
        );
        let rider = run(&format!("rider-{}", end.replace(' ', "-")), &text);
        let headline = &rider.summary.headline;
        let (_, right) = headline.split_once("; `right` ").unwrap_or_else(|| panic!("{headline}"));
        assert!(
            !right.contains("tipping") && !right.contains("upright") && !right.contains("e\u{2212}"),
            "{end}: {headline}"
        );
    }
}

const BLOCKS: &str = "[time]\nend = '1.1 s'\nstep = '500 us'\n[ground]\n\
    motion = { acceleration = ['PEAK m/s^2', '0 m/s^2'], signal = 'shake' }\n[signal.shake]\nshape = 'one-sine'\nperiod = '0.8 s'\n\
    [contact.floor]\nbetween = ['*', 'ground']\nfriction = 0.7\n[contact.joints]\nbetween = ['*', '*']\nfriction = 0.7\n";

fn block(name: &str, [width, height]: [f64; 2], on: &str, at: f64) -> String {
    format!(
        "[block.{name}]\ndensity = '2700 kg/m^3'\nwidth = '{width} m'\nheight = '{height} m'\ndepth = '1 m'\non = '{on}'\nat = '{at} m'\n"
    )
}

#[test]
fn two_blocks_beside_each_other_on_a_third_are_no_column() {
    let blocks = [
        block("base", [1.2, 4.0], "ground", 0.0),
        block("left", [0.3, 0.5], "base", -0.3),
        block("right", [0.3, 0.5], "base", 0.3),
    ];
    let headline = run("no-column", &(BLOCKS.replace("PEAK", "3.6") + &blocks.concat())).summary.headline;
    assert!(
        headline.starts_with("all 3 blocks turn as one on the base of `base`; largest φ/α of all 0."),
        "{headline}"
    );
}

/// The mass centre of the two blocks is 0.52857 m from the left foot, 0.47143 m from the right one, and 1.75 m high.
#[test]
fn a_column_that_leans_has_a_critical_angle_on_each_side() {
    for (peak, name) in [("3.6", "leaning-left"), ("-3.6", "leaning-right")] {
        let blocks = [block("base", [1.0, 3.0], "ground", 0.0), block("top", [1.0, 0.5], "base", 0.2)];
        let ran = run(name, &(BLOCKS.replace("PEAK", peak) + &blocks.concat()));
        let (headline, table) = (&ran.summary.headline, crate::plots::table(&ran.folder.join("trajectory.csv")));
        let phi = &table.iter().find(|(column, _)| column == "base.phi").unwrap().1;
        let part = |phi: &f64| phi.abs() / (if *phi > 0.0 { 0.52857_f64 } else { 0.47143 } / 1.75).atan();
        let wanted = phi.iter().map(part).fold(0.0, f64::max);
        let (_, told) = headline.split_once("largest φ/α of the column ").unwrap_or_else(|| panic!("{headline}"));
        let told: f64 = told.split([')', ';']).next().unwrap().parse().unwrap();
        assert!((told / wanted - 1.0).abs() < 0.02, "{headline}: {wanted}");
    }
}

/// A push of four times its weight for 30 ms lifts it by a centimetre once.
#[test]
fn what_hopped_once_and_rocks_since_does_not_bounce() {
    let text = "[time]\nend = '300 ms'\nstep = '200 us'\n[ground]\n[signal.kick]\nshape = 'half-sine'\nstart = '1 ms'\nduration = '30 ms'\n\
        [force.push]\non = 'box'\nforce = ['0 N', '78 N']\nsignal = 'kick'\n[block.box]\ndensity = '1000 kg/m^3'\nwidth = '10 cm'\n\
        height = '20 cm'\ndepth = '10 cm'\non = 'ground'\nat = '0 m'\ntilt = '4 deg'\n[contact.base]\nbetween = ['box', 'ground']\nfriction = 0.6\n";
    let headline = run("hopped-once", text).summary.headline;
    assert!(headline.starts_with("`box` rocks on"), "{headline}");
}

/// Its deck sags by 0.24° under the block by its own weight, and more under the load: nothing of that is rocking.
#[test]
fn what_stands_flat_on_a_beam_that_bends_does_not_rock() {
    let text = "[time]\nend = '1 s'\nstep = '100 us'\n[material.steel]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n\
        [beam.deck]\nmaterial = 'steel'\nspan = '3 m'\nwidth = '20 cm'\nthickness = '25 mm'\nelements = 40\nstart = 'static'\n\
        self_weight = true\ndamping_ratio = { mode = 1, ratio = 0.02 }\n[load.cart]\non = 'deck'\nat = '-0.5 m'\nforce = '-600 N'\n\
        speed = '4 m/s'\n[block.post]\ndensity = '2400 kg/m^3'\nwidth = '8 cm'\nheight = '40 cm'\ndepth = '10 cm'\non = 'deck'\n\
        at = '2 m'\n[contact.c]\nbetween = ['post', 'deck']\nfriction = 0.5\n";
    let ran = run("moving-load", text);
    assert_eq!(ran.summary.headline, "`post` stood on `deck` throughout");
    assert_eq!(ran.summary.impact_count, 0);
    let largest = ran.summary.max_phi_over_alpha.unwrap();
    assert!(largest < 1e-5, "{largest} of what it is turned against the line between its feet");
    assert_eq!(tile(&ran.html, "max_phi_over_alpha"), None);
    // In the sentence on many blocks, too.
    let more = ["b", "c"].map(|name| {
        let block = text.split("[block.post]").nth(1).unwrap().split("[contact").next().unwrap();
        let at = if name == "b" { "0.5 m" } else { "1 m" };
        format!("[block.{name}]{}", block.replace("2 m'", &format!("{at}'")).replace("'40 cm'", "'8 cm'"))
    });
    let many =
        run("moving-load-many", &format!("{}{}", text.replace("['post', 'deck']", "['*', 'deck']"), more.concat()));
    assert_eq!(many.summary.headline, "all 3 blocks stood on their beams throughout");
}

/// Drums of 0.67 rad that turn by a hundredth of it as a column of 0.17 rad.
#[test]
fn a_column_that_came_to_rest_is_told_as_one() {
    let text = "[time]\nend = '9 s'\nstep = '500 us'\n[ground]\nmotion = { acceleration = ['2.3 m/s^2', '0 m/s^2'], signal = 'shake' }\n\
        [signal.shake]\nshape = 'one-sine'\nperiod = '0.3 s'\n[block.drum]\ndensity = '2700 kg/m^3'\nwidth = '0.8 m'\nheight = '1 m'\n\
        depth = '1 m'\non = 'ground'\nat = '0 m'\nrepeat = { count = 5, stacked = true }\n[contact.floor]\nbetween = ['*', 'ground']\n\
        friction = 0.7\n[contact.joints]\nbetween = ['*', '*']\nfriction = 0.7\n";
    let column = run("column-at-rest", text);
    let headline = &column.summary.headline;
    let told = "all 5 blocks rocked as one column on the base of `drum-1`, came to rest, last at t = ";
    assert!(headline.starts_with(told), "{headline}");
    let (_, share) = headline.split_once("; largest φ/α of the column ").unwrap_or_else(|| panic!("{headline}"));
    let wanted = column.summary.max_phi_over_alpha.unwrap() * 0.8_f64.atan() / 0.16_f64.atan();
    let value: f64 = share.parse().unwrap();
    assert!((value / wanted - 1.0).abs() < 0.02, "{headline}: {wanted}");
    let lowest = column.summary.verdict.iter().position(|of| of.body == "drum-1").unwrap();
    // The tile has the number of the sentence.
    assert_eq!(tile(&column.html, &format!("verdict.{lowest}.column_phi_over_alpha")), Some(share));
    assert!(
        column.html.contains("<dt>Largest φ/α of the column</dt>")
            && tile(&column.html, "max_phi_over_alpha").is_none()
    );
}

#[test]
fn what_nothing_holds_from_the_start_has_no_part_of_its_critical_angle_left() {
    let overhang = run("overhang", include_str!("../../../../scenarios/overhang.toml"));
    let headline = &overhang.summary.headline;
    let told = "`tips` is still tipping, its mass centre past the edge that it stood on from the start";
    assert!(headline.ends_with(told), "{headline}");
    assert!(!overhang.html.contains("<dt>Largest φ/α"));
}

#[test]
fn the_largest_angle_of_what_flew_counts_since_it_settled() {
    let text = "[time]\nend = '2 s'\nstep = '100 us'\n[ground]\n[block.brick]\ndensity = '2400 kg/m^3'\nwidth = '24 cm'\n\
        height = '12 cm'\ndepth = '12 cm'\nposition = ['0 m', '60 cm']\nangle = '25 deg'\n[contact.c]\nbetween = ['brick', 'ground']\n\
        friction = 0.4\nrestitution = 0.3\n";
    let ran = run("dropped-tilted", text);
    assert!(
        ran.summary.headline.contains(" (largest φ/α since it could no longer turn over 0.1"),
        "{}",
        ran.summary.headline
    );
    assert!(ran.html.contains("<dt>Largest φ/α since it could no longer turn over, from t = "));
    // Among more than two, too.
    let others = ["left", "right"].map(|name| {
        let at = if name == "left" { "-1 m" } else { "1 m" };
        format!(
            "[block.{name}]\ndensity = '2400 kg/m^3'\nwidth = '20 cm'\nheight = '10 cm'\ndepth = '10 cm'\non = 'ground'\nat = '{at}'\n\
             [contact.{name}]\nbetween = ['{name}', 'ground']\nfriction = 0.4\n"
        )
    });
    let three = run("dropped-beside", &format!("{text}{}", others.concat())).summary.headline;
    assert!(
        three.contains("; largest φ/α of all 0.1") && three.ends_with(" (`brick`, since it could no longer turn over)"),
        "{three}"
    );
}

#[test]
fn first_is_said_of_several_only() {
    let text = |tilts: [f64; 3]| {
        let block = |(k, tilt)| {
            format!(
                "[block.b{k}]\ndensity = '1000 kg/m^3'\nwidth = '3 cm'\nheight = '13.5 cm'\ndepth = '3 cm'\non = 'ground'\nat = '{k} m'\n\
                 tilt = '{tilt} deg'\n"
            )
        };
        let blocks: String = tilts.into_iter().enumerate().map(block).collect();
        format!(
            "[time]\nend = '1.5 s'\nstep = '500 us'\n[ground]\n{blocks}[contact.c]\nbetween = ['*', 'ground']\nfriction = 0.5\n"
        )
    };
    let one = run("one-of-three", &text([0.0, 13.0, 0.0]));
    let headline = &one.summary.headline;
    let told = "`b1` began past its critical angle and overturned to the left, came to rest on its left side at t = ";
    assert!(headline.starts_with(told) && headline.ends_with("; 2 stood still throughout"), "{headline}");
    assert!(one.html.contains("<dt>Overturned at (b1)</dt>"));
    let two = run("two-of-three", &text([0.0, 13.0, -13.0]));
    assert!(
        two.summary
            .headline
            .starts_with("2 of 3 blocks overturned (1 to the left, 1 to the right), first `b1` to the left"),
        "{}",
        two.summary.headline
    );
    assert!(two.html.contains("<dt>First overturned at</dt>"));
}

#[test]
fn lengths_of_one_sentence_are_in_one_unit() {
    let text = "[time]\nend = '2 s'\nstep = '500 us'\n[ground]\nincline = '20 deg'\n[block.b]\ndensity = '1000 kg/m^3'\nwidth = '20 cm'\n\
        height = '20 cm'\ndepth = '20 cm'\non = 'ground'\nat = '0 m'\nvelocity = ['2.3 m/s', '0.84 m/s']\n[contact.c]\n\
        between = ['b', 'ground']\nfriction = 0.05\n";
    let headline = run("up-and-down", text).summary.headline;
    assert!(headline.contains("slid 0.7") && headline.contains(" m up the slope, then to "), "{headline}");
    assert!(!headline.contains(" mm "), "{headline}");
}

/// Beside Housner's 0.93 a ratio of 1.00 would be an impact that loses nothing: of a beam it is one bounce of many.
#[test]
fn a_beam_gives_no_ratio_of_velocities_to_compare_with_that_of_rigid_ground() {
    let head = |html: &str| {
        let table = &html[html.find("id=\"rocking-title\"").unwrap()..];
        table[..table.find("</thead>").unwrap()].to_owned()
    };
    let (beam, ground) = (scenario("free-rocking-on-beam"), scenario("free-rocking-on-ground"));
    assert!(["ω⁺/ω⁻", "Housner"].iter().all(|column| head(&ground.html).contains(column)));
    assert!(![">ω⁺/ω⁻<", ">Housner<"].iter().any(|column| head(&beam.html).contains(column)));
    assert!(head(&beam.html).contains("Next lift / previous") && !head(&beam.html).contains("Next peak / previous"));
    assert!(beam.html.contains("On a beam no ω⁺/ω⁻ is given") && !ground.html.contains("On a beam no ω⁺/ω⁻ is given"));
}

#[test]
fn energies_have_a_prefix_with_one_to_three_digits_before_the_point() {
    let text = "[time]\nend = '1 s'\nstep = '500 us'\n[ground]\n[block.b]\ndensity = '1000 kg/m^3'\nwidth = '20 cm'\nheight = '20 cm'\n\
        depth = '20 cm'\nposition = ['0 m', 'HEIGHT']\n[contact.c]\nbetween = ['b', 'ground']\nfriction = 0.5\n";
    for height in ["0.1001 m", "0.11 m", "1.1 m", "4 m"] {
        let ran = run(&format!("energy-{}", &height[..3]), &text.replace("HEIGHT", height));
        let shown = tile(&ran.html, "energy.dissipated").unwrap();
        let number: f64 = shown.split('\u{a0}').next().unwrap().parse().unwrap();
        assert!((1.0..1e3).contains(&number), "{height}: {shown}");
    }
}

/// A post off midspan rocks about the slope of the sagging deck: from there it is lifted less and less, while every other peak grows.
#[test]
fn rocking_on_a_sloping_deck_counts_from_the_line_between_the_feet() {
    let text = "[time]\nend = '1.6 s'\nstep = '50 us'\n[material.steel]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n[beam.deck]\n\
        material = 'steel'\nspan = '2 m'\nwidth = '12 cm'\nthickness = '12 mm'\nelements = 20\nsupports = ['pinned', 'pinned']\n\
        damping_ratio = { mode = 1, ratio = 0.02 }\nstart = 'static'\nself_weight = true\n[block.post]\ndensity = '2400 kg/m^3'\n\
        width = '6 cm'\nheight = '30 cm'\ndepth = '8 cm'\non = 'deck'\nat = '30 cm'\ntilt = '5 deg'\n[contact.c]\n\
        between = ['post', 'deck']\nfriction = 0.5\n";
    let rocks = run("post-on-a-sloping-deck", text);
    // The deck's own weight, 110.9 N/m, slopes it there by w L³/24EI (1 − 6ξ² + 4ξ³) = 0.513°, that of the post, 33.9 N, by P a b (b − a)/3EI L = 0.064°.
    let cycles = half_cycles(&rocks.page, &rocks.summary);
    let release = cycles[0].peak_before.unwrap().to_degrees();
    assert!((release - 5.577).abs() < 0.03, "{release}");
    // The summary's peaks are those of the trajectory, from the deck's undeformed axis.
    let peak = rocks.summary.peaks[0].phi.to_degrees();
    assert!((peak - 5.0).abs() < 1e-9, "{peak}");
    let lifts: Vec<f64> = cycles.iter().filter_map(|of| of.lift).collect();
    let housner = cycles[0].housner.unwrap().powi(2);
    assert!(lifts.len() >= 3 && (lifts[0] - housner).abs() < 0.02, "{lifts:?} against {housner}");
    assert!(lifts.iter().all(|lift| (0.75..1.0).contains(lift)), "{lifts:?}");
    let peaks = cycles.iter().filter_map(teeter_report::HalfCycle::decay);
    assert!(peaks.fold(0.0, f64::max) > 1.0, "downhill it swings farther");
    assert!(rocks.html.contains("about which it rocks") && rocks.html.contains("Plots have φ from the horizontal"));
}

/// The angle of the plots is from the horizontal: what a peak counts from instead is said, unless that is level.
#[test]
fn a_last_peak_is_told_with_what_it_counts_from() {
    let ground = "[time]\nend = '0.5 s'\nstep = '200 us'\n[ground]\nincline = 'SLOPE'\n[block.b]\ndensity = '2400 kg/m^3'\nwidth = '6 cm'\n\
        height = '30 cm'\ndepth = '8 cm'\non = 'ground'\nat = '0 m'\ntilt = '3 deg'\n[contact.c]\nbetween = ['b', 'ground']\nfriction = 0.5\n";
    let on_ground = |slope| run(&format!("peak-on-{slope}"), &ground.replace("SLOPE", slope)).summary.headline;
    assert!(on_ground("0 deg").contains("rocks on, last peak ") && !on_ground("0 deg").contains("against"));
    assert!(on_ground("2 deg").contains("° against the ground at t = "), "{}", on_ground("2 deg"));
    let blocks = std::fs::read_to_string(
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/two-blocks-on-beam.toml"),
    );
    let blocks = run("peak-on-a-block", &blocks.unwrap());
    assert!(blocks.summary.headline.contains("° against `plate` at t = "), "{}", blocks.summary.headline);
}

/// The beam bends under the block, which rocks about the line between its feet: the head of the page and its table of half cycles have one number.
#[test]
fn the_last_peak_on_a_beam_is_that_of_the_table_of_half_cycles() {
    let rocks = scenario("free-rocking-on-beam");
    let last = half_cycles(&rocks.page, &rocks.summary).iter().rev().find_map(|cycle| cycle.peak_after).unwrap();
    let of_axis = rocks.summary.peaks.last().unwrap().phi;
    assert!((of_axis - last).abs() > 2e-4, "nothing to tell apart: {of_axis} {last}");
    let told = format!("last peak {:.2}° against the line between its feet at t = ", last.to_degrees());
    assert!(rocks.summary.headline.contains(&told), "{}", rocks.summary.headline);
    assert_eq!(rocks.summary.verdict[0].last_peak, Some(of_axis), "the file's counts from the axis, as its peaks");
}

/// What moves as prescribed has no verdict, but a place among the blocks before it: each of these is told by its own peaks.
#[test]
fn a_fixed_block_that_comes_first_leaves_the_last_peak_of_the_next_one_alone() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/free-rocking-on-beam.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let shelf = "[block.shelf]\nmaterial = 'aluminium'\nwidth = '30 cm'\nheight = '2 cm'\ndepth = '3 cm'\n\
        position = ['18 cm', '-1 m']\nfixed = true\n";
    let with_shelf = run("shelf-first", &text.replace("[block.rocker]", &format!("{shelf}[block.rocker]")));
    let alone = scenario("free-rocking-on-beam");
    assert!(alone.summary.headline.contains("against the line between its feet"), "{}", alone.summary.headline);
    assert_eq!(with_shelf.summary.headline, alone.summary.headline);
}

/// It ends on its way to a peak, while the beam's vibration turns the line between its feet to and fro.
#[test]
fn a_beam_that_vibrates_makes_no_peak_of_a_swing_that_goes_on() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/held-beam.toml");
    let held = run("held", &std::fs::read_to_string(path).unwrap());
    let cycles = half_cycles(&held.page, &held.summary);
    let [.., before, last] = &cycles[..] else { panic!("{cycles:?}") };
    assert_eq!(last.peak_after, None, "−1.2° in the midst of a swing");
    let told = format!("last peak {:.2}° against the line between its feet", before.peak_after.unwrap().to_degrees());
    assert!(held.summary.headline.contains(&told), "{}", held.summary.headline);
}

/// "Overturned" alone leaves open that a stone isn't there any more.
#[test]
fn what_overturned_and_fell_off_its_beam_is_told_to() {
    let text = "[time]\nend = '1.2 s'\nstep = '200 us'\n[material.steel]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n[beam.deck]\n\
        material = 'steel'\nspan = '50 cm'\nwidth = '12 cm'\nthickness = '12 mm'\nelements = 10\nsupports = ['clamped', 'free']\n\
        [block.post]\ndensity = '2400 kg/m^3'\nwidth = '6 cm'\nheight = '30 cm'\ndepth = '8 cm'\non = 'deck'\nat = 'AT'\n\
        tilt = '-13 deg'\n[contact.c]\nbetween = ['post', 'deck']\nfriction = 0.5\n";
    let told = |at: &str| run(&format!("off-{}", &at[..2]), &text.replace("AT", at)).summary.headline;
    let off = "overturned to the right, then fell off the right end of `deck`";
    assert!(told("46 cm").contains(off), "{}", told("46 cm"));
    assert!(
        told("10 cm").contains("overturned to the right") && !told("10 cm").contains("fell off"),
        "{}",
        told("10 cm")
    );
}

/// A block that lands in a step ends some micrometres deep in rigid ground, and stays there; one that bounces up again leaves it.
#[test]
fn a_penetration_that_stays_is_told_to() {
    let text = |end: &str, height: &str| {
        format!(
            "[time]\nend = '{end}'\nstep = '500 us'\nscheme = 'moreau-jean'\n[ground]\n[block.b]\ndensity = '2000 kg/m^3'\n\
             width = '20 cm'\nheight = '10 cm'\ndepth = '10 cm'\nposition = ['0 m', '{height}']\n[contact.feet]\nbetween = ['b', 'ground']\nfriction = 0.5\nrestitution = 0.5\n"
        )
    };
    let (lies, state) = run_from("lies-deep", &text("1 s", "80 mm"), None);
    let depth = 0.05 - state.q[1];
    assert!(depth > 1e-8 && lies.summary.max_penetration >= depth, "{depth}");
    let digits = |x: f64| teeter_report::with_digits(x, "m", 2);
    let told = lies.summary.penetration_at_end(digits).unwrap();
    assert!(told.ends_with("at the end"), "{told}");
    assert!(lies.html.contains(&format!("<dt>Deepest penetration, {told}</dt>")));
    let (flies, state) = run_from("bounced-out", &text("110 ms", "85 mm"), None);
    assert!(state.q[1] > 0.05 && flies.summary.max_penetration > 1e-5);
    assert_eq!(flies.summary.penetration_at_end(digits), None);
}

/// Two beams and no block: the second is bent by a load, the first isn't; by their elements and by modes, of supports that move, too.
#[test]
fn of_beams_alone_the_deflections_are_their_own() {
    let beam = |name: &str, more: &str| {
        format!(
            "[beam.{name}]\nsection = 'direct'\nbending_stiffness = '40 N m^2'\nmass_per_length = '0.4 kg/m'\nspan = '1 m'\nelements = 8\n{more}"
        )
    };
    let load = "[load.step]\non = 'loaded'\nat = '50 cm'\nforce = '-8 N'\n";
    for model in ["", "model = 'modes'\nmodes = { count = 4 }\n"] {
        let text =
            format!("[time]\nend = '0.2 s'\nstep = '100 us'\n{}{}{load}", beam("idle", model), beam("loaded", model));
        let found = run("beams-alone", &text).summary.deflections;
        let of = |name: &str| found.iter().find(|of| of.beam == name).unwrap().w;
        assert_eq!(of("idle"), 0.0, "{model}");
        // Twice the static 8 N (1 m)³/(48 EI).
        assert!((of("loaded") / (-2.0 * 8.0 / (48.0 * 40.0)) - 1.0).abs() < 0.1, "{model}: {}", of("loaded"));

        let moved = beam("shaken", model) + "motion = { acceleration = ['0 m/s^2', '3 m/s^2'] }\n";
        let of = run("beam-moved", &format!("[time]\nend = '0.2 s'\nstep = '100 us'\n{moved}")).summary.deflections;
        // Twice the static 5 q l⁴/(384 EI) of q = 0.4 kg/m · 3 m/s².
        assert!((of[0].w / (-2.0 * 5.0 * 1.2 / (384.0 * 40.0)) - 1.0).abs() < 0.1, "{model}: {}", of[0].w);
    }
}
