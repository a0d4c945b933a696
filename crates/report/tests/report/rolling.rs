//! Round blocks: what they roll and what they skid, and what they do on something that moves.

use crate::page::run;

fn wheel(name: &str, end: &str, velocity: f64, spin: f64) -> (String, [f64; 2]) {
    let text = format!(
        "[time]\nend = '{end}'\nstep = '0.5 ms'\n[ground]\n[block.wheel]\ndensity = '1100 kg/m^3'\nradius = '20 cm'\ndepth = '5 cm'\n\
         on = 'ground'\nat = '0 m'\nvelocity = ['{velocity} m/s', '0 m/s']\nspin = '{spin} rad/s'\n[contact.c]\nbetween = ['wheel', 'ground']\n\
         friction = 0.3\n"
    );
    let ran = run(name, &text);
    let rows = std::fs::read_to_string(ran.folder.join("trajectory.csv")).unwrap();
    let last: Vec<f64> = rows.lines().last().unwrap().split(',').map(|field| field.parse().unwrap()).collect();
    (ran.summary.headline, [last[1], last[3]])
}

/// It goes to the right while it skids, and rolls back: where it is and how far it has turned are those of the plots.
#[test]
fn what_skids_before_it_rolls_has_both_told() {
    let (headline, [x, phi]) = wheel("spins-backwards", "3 s", 2.0, 30.0);
    // Until the point that touches slips at a twentieth of the centre's speed.
    let (slows, until) = (0.3 * 9.81, 8.1 / (3.05 * 0.3 * 9.81));
    let skidded = 2.0 * until - 0.5 * slows * until * until;
    let (by, rest) = headline.strip_prefix("`wheel` skidded by ").unwrap().split_once(" mm to the right, ").unwrap();
    assert!((1e-3 * by.parse::<f64>().unwrap() / skidded - 1.0).abs() < 0.01, "{headline} {skidded}");
    let (by, rest) = rest.strip_prefix("is still rolling, by ").unwrap().split_once(" m to the left (").unwrap();
    assert!((by.parse::<f64>().unwrap() - (skidded - x)).abs() < 0.005, "{headline}");
    let in_all = format!(
        "so far; in all {:.1} mm left of its start, turned by {:.2} turns counter-clockwise",
        -1e3 * x,
        phi / std::f64::consts::TAU
    );
    assert!(rest.ends_with(&in_all), "{headline} {in_all}");
}

#[test]
fn what_only_rolls_or_only_skids_has_one_way_told() {
    let (rolls, _) = wheel("only-rolls", "1 s", 1.0, -5.0);
    assert_eq!(rolls, "`wheel` is still rolling, by 1 m to the right (286°) so far");
    let (skids, [x, phi]) = wheel("only-skids", "0.2 s", 2.0, 30.0);
    let told = format!(
        "`wheel` is still sliding, by {:.1} mm to the right so far; in all turned by {:.0}° counter-clockwise",
        1e3 * x,
        phi.to_degrees()
    );
    assert_eq!(skids, told);
}

/// Of many bodies one that slides or rolls on is told how far, as it is alone; of several the one that went farthest.
#[test]
fn what_goes_on_among_many_is_told_how_far() {
    let scene = |first: f64, friction: f64, second: f64| {
        let disc = |name: &str, at: f64, velocity: f64| {
            format!(
                "[block.{name}]\ndensity = '1100 kg/m^3'\nradius = '5 cm'\ndepth = '5 cm'\non = 'ground'\nat = '{at} m'\n\
                 velocity = ['{velocity} m/s', '0 m/s']\nspin = '{} rad/s'\n",
                if friction > 0.0 { -20.0 * velocity } else { 0.0 }
            )
        };
        format!(
            "[time]\nend = '0.5 s'\nstep = '1 ms'\n[ground]\n{}{}{}[contact.c]\nbetween = ['*', 'ground']\nfriction = {friction}\n",
            disc("a", 0.0, 0.0),
            disc("b", 1.0, first),
            disc("c", 2.0, second)
        )
    };
    let headline = |name: &str, text: &str| run(name, text).summary.headline;
    let one = headline("one-slides", &scene(0.0, 0.0, 0.4));
    assert!(one.ends_with("; `c` is still sliding, by 200 mm to the right so far"), "{one}");
    let one = headline("one-rolls", &scene(0.0, 0.3, 0.4));
    assert!(one.ends_with("; `c` is still rolling, by 200 mm to the right (229°) so far"), "{one}");
    let two = headline("two-slide", &scene(-0.6, 0.0, 0.4));
    assert!(two.ends_with("; 2 are still sliding, by up to 300 mm (`b`)"), "{two}");
    // One that hops first has gone by more than it rolled.
    let hops = scene(-0.6, 0.3, 0.4)
        .replace("at = '1 m'\nvelocity = ['-0.6 m/s', '0 m/s']", "at = '1 m'\nvelocity = ['-0.6 m/s', '1 m/s']");
    let two = headline("one-of-two-hopped", &hops);
    assert!(two.ends_with("; 2 are still rolling"), "{two}");
    let two = headline("two-roll", &scene(-0.6, 0.3, 0.4));
    assert!(two.ends_with("; 2 are still rolling, by up to 300 mm (`b`)"), "{two}");
    let box_on = |name: &str, velocity: f64| {
        format!(
            "[block.{name}]\ndensity = '1100 kg/m^3'\nwidth = '10 cm'\nheight = '5 cm'\ndepth = '5 cm'\non = 'ground'\nat = '{} m'\n\
             velocity = ['{velocity} m/s', '0 m/s']\n",
            f64::from(name.as_bytes()[0])
        )
    };
    let boxes = |second: f64| {
        format!(
            "[time]\nend = '0.5 s'\nstep = '1 ms'\n[ground]\n{}{}{}[contact.c]\nbetween = ['*', 'ground']\nfriction = 0.01\n",
            box_on("a", 0.0),
            box_on("b", second),
            box_on("c", 1.0)
        )
    };
    let one = headline("one-box-slides", &boxes(0.0));
    assert!(one.contains("; `c` slides on, slid by 487") && one.ends_with(" mm to the right so far"), "{one}");
    let two = headline("two-boxes-slide", &boxes(0.5));
    assert!(two.contains("; 2 slide on, by up to 487") && two.ends_with(" mm (`c`)"), "{two}");
}

/// The beam goes up and down by millimetres, which is no slide: nor is the chatter with which bounces on a beam end.
#[test]
fn what_a_beam_takes_up_and_down_does_not_slide() {
    let text = |end: &str, ball: &str, load: &str| {
        format!(
            "[time]\nend = '{end}'\nstep = '50 us'\n[material.steel]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n[beam.bar]\n\
             material = 'steel'\nspan = '80 cm'\nwidth = '5 cm'\nthickness = '5 mm'\nelements = 24\nsupports = ['pinned', 'pinned']\n\
             damping_ratio = {{ mode = 1, ratio = 0.02 }}\nstart = 'static'\n{load}[block.ball]\nmaterial = 'steel'\nradius = '2 cm'\n\
             depth = '3 cm'\n{ball}[contact.c]\nbetween = ['ball', 'bar']\nfriction = 0.3\n"
        )
    };
    let load = "[signal.s]\nshape = 'harmonic'\nfrequency = '7 Hz'\n[load.f]\non = 'bar'\nat = '20 cm'\nforce = '15 N'\nsignal = 's'\n";
    let laid = run("laid-on-a-shaken-beam", &text("0.5 s", "on = 'bar'\nat = '40 cm'\n", load)).summary;
    assert_eq!(laid.verdict[0].rests_from, None);
    assert!(laid.headline.starts_with("`ball` lay on `bar` throughout"), "{}", laid.headline);
    let dropped = text("0.8 s", "position = ['40 cm', '5 cm']\n", "") + "restitution = 0.3\n";
    let dropped = run("dropped-on-a-beam", &dropped).summary.headline;
    assert!(dropped.starts_with("`ball` is still trembling where it stands, on a beam that moves"), "{dropped}");
}

/// What a round block rolls below, after it has fallen, is told after the fall, and that it goes on there.
#[test]
fn what_rolls_off_an_edge_has_its_ways_before_and_after_told() {
    let disc = |on: &str, friction: &str| {
        format!(
            "[time]\nend = '2 s'\nstep = '0.5 ms'\n[ground]\n[block.disc]\ndensity = '700 kg/m^3'\nradius = '5 cm'\ndepth = '5 cm'\n\
             on = '{on}'\nat = '10 cm'\nvelocity = ['0.6 m/s', '0 m/s']\nspin = '-12 rad/s'\n\
             [contact.c]\nbetween = ['disc', '{on}']\nfriction = 0.4\n[contact.g]\nbetween = ['disc', 'ground']\n{friction}\n"
        )
    };
    let table = "[block.table]\ndensity = '700 kg/m^3'\nwidth = '80 cm'\nheight = '40 cm'\ndepth = '30 cm'\nposition = ['0 cm', '20 cm']\n\
                 fixed = true\n";
    let beam = "[material.steel]\nyoungs_modulus = '210 GPa'\ndensity = '7850 kg/m^3'\n[beam.shelf]\nmaterial = 'steel'\nspan = '40 cm'\n\
                width = '4 cm'\nthickness = '2 cm'\nelements = 4\nsupports = ['clamped', 'free']\nposition = ['0 m', '40 cm']\n\
                damping_ratio = { mode = 1, ratio = 0.02 }\n";
    let metres = |text: &str| -> f64 {
        let (by, _) = text.split_once(" to the right").unwrap();
        let (number, unit) = by.split_once(' ').unwrap();
        number.parse::<f64>().unwrap() * if unit == "mm" { 1e-3 } else { 1.0 }
    };
    for (name, on, holder, fell) in [
        ("off-a-table", "table", table, ", then fell from its place at "),
        ("off-a-beam", "shelf", beam, ", then left `shelf` at its right end at "),
    ] {
        let ran = run(name, &format!("{}{holder}", disc(on, "friction = 0.4\nrestitution = 0.4")));
        let headline = ran.summary.headline;
        let rows = std::fs::read_to_string(ran.folder.join("trajectory.csv")).unwrap();
        let x = rows.lines().skip(1).map(|row| row.split(',').nth(1).unwrap().parse::<f64>().unwrap()).last().unwrap();
        let (before, after) = headline.strip_prefix("`disc` rolled by ").unwrap().split_once(fell).unwrap();
        // From 10 cm to the edge, 30 cm away: it goes round the edge before it falls.
        assert!((metres(before) - 0.3).abs() < 0.03, "{name}: {headline}");
        let (_, on) = after.split_once(", and is still rolling, by ").unwrap();
        assert!(on.ends_with(" so far"), "{name}: {headline}");
        // It flew about 17 cm before.
        let below = x - 0.4;
        assert!(metres(on) < below && metres(on) > 0.5 * below, "{name}: {headline}; {x}");
    }
}

/// A block that slides off a table fell before it turned over.
#[test]
fn what_fell_before_it_overturned_is_told_to_have() {
    let text = "[time]\nend = '1.5 s'\nstep = '0.5 ms'\n[ground]\n[block.table]\ndensity = '700 kg/m^3'\nwidth = '60 cm'\nheight = '50 cm'\n\
                depth = '30 cm'\nposition = ['0 cm', '25 cm']\nfixed = true\n[block.book]\ndensity = '900 kg/m^3'\nwidth = '20 cm'\nheight = '4 cm'\n\
                depth = '15 cm'\non = 'table'\nat = '10 cm'\nvelocity = ['1.5 m/s', '0 m/s']\n[contact.a]\nbetween = ['book', 'table']\n\
                friction = 0.3\n[contact.b]\nbetween = ['book', 'ground']\nfriction = 0.5\nrestitution = 0.2\n";
    let headline = run("book-off-table", text).summary.headline;
    assert!(headline.starts_with("`book` fell from its place at t = 28"), "{headline}");
    assert!(headline.contains(" ms, overturned to the right at t = "), "{headline}");
}
