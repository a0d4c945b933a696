//! Pages and figures of scenes of any size: units, ticks and digits that suit, names that fit, figures that fit a page.

use crate::page::{data, numbers, panel, run, scenario};
use teeter_report::figures;

/// A block on ground, of a width and a height, with one line for the time and one for its place.
fn block(time: &str, size: [&str; 2], place: &str) -> String {
    let [width, height] = size;
    format!(
        "[time]\n{time}\n[ground]\n[material.m]\ndensity = '2500 kg/m^3'\n[block.chip]\nmaterial = 'm'\nwidth = '{width}'\n\
         height = '{height}'\ndepth = '{width}'\n{place}\n[contact.feet]\nbetween = ['chip', 'ground']\nfriction = 0.5\n"
    )
}

fn figure(of: &[(String, String)], name: &str) -> String {
    of.iter().find(|(file, _)| file == name).unwrap_or_else(|| panic!("no {name}")).1.clone()
}

#[test]
fn a_chip_of_a_micrometre_has_axes_that_one_can_read() {
    let text = block("end = '3 ms'\nstep = '1 us'", ["1 um", "4 um"], "on = 'ground'\nat = '0 um'\ntilt = '8 deg'");
    let run = run("micrometre", &text);
    let page = data(&run.html);
    let unit = |id: &str| panel(&page, id).unwrap()["unit"].as_str().unwrap().to_owned();
    assert_eq!(["x", "y", "energy"].map(unit), ["µm", "µm", "zJ"], "one unit for both coordinates");
    // The weight is 91 fN; impacts have impulses, of some 1e-18 N s.
    let unit = &page["forces"]["units"][0][0];
    assert_eq!((&unit[0], &unit[1]), (&"f".into(), &1e15.into()));
    let figures = figures(&run.page);
    let forces = figure(&figures, "contact_forces.svg");
    for wanted in ["Normal force (fN)", "Time t (ms)", "Impulse of impacts (aN s)"] {
        assert!(forces.contains(wanted), "{wanted}");
    }
    assert!(!forces.contains("peaks cut"), "without the impacts there are no peaks");
    for (name, svg) in &figures {
        assert!(!svg.contains("0.0030<") && !svg.contains("e\u{2212}"), "{name} has a label that is none");
    }
    // What the model leaves out, and why: with energies that one can read.
    assert!(
        run.html.contains("the total energy is 2.0") && run.html.contains("e-19 J, and 2.0"),
        "energies of 1e-19 J"
    );
    assert!(run.html.contains("· t\u{a0}=\u{a0}3\u{a0}ms ·"));
}

#[test]
fn a_creeping_block_far_from_the_origin_is_seen_to_creep() {
    let text = "[time]\nend = '10 s'\nstep = '1 ms'\n[material.m]\ndensity = '2500 kg/m^3'\n[world]\ngravity = '0 m/s^2'\n[block.probe]\n\
        material = 'm'\nwidth = '20 cm'\nheight = '10 cm'\ndepth = '5 cm'\nposition = ['1234.5 m', '5 cm']\nvelocity = ['3e-6 m/s', '0 m/s']\n";
    let run = run("creeping", text);
    let page = data(&run.html);
    let x = panel(&page, "x").unwrap();
    assert_eq!(x["unit"], "m", "numbers of cm would be too large");
    let values = numbers(&x["series"][0]["y"]);
    let [first, middle, last] = [0, values.len() / 2, values.len() - 1].map(|k| values[k] - 1234.5);
    assert!(
        first.abs() < 1e-7 && (middle - 15e-6).abs() < 1e-6 && (last - 30e-6).abs() < 1e-6,
        "{first} {middle} {last}"
    );
    let svg = figure(&figures(&run.page), "x.svg");
    assert!(
        svg.contains("Position x \u{2212} 1234.5000 (10<tspan"),
        "the digits that all values share are in the title"
    );
    assert!(svg.contains(">30</text>"), "micrometres");
}

/// Two blocks of 20 cm that slide at 1 m/s for 1 s, at these places.
fn sliding(places: [&str; 2]) -> String {
    let block = |name: &str, at: &str| {
        format!(
            "[block.{name}]\nmaterial = 'm'\nwidth = '20 cm'\nheight = '10 cm'\ndepth = '5 cm'\nposition = ['{at}', '5 cm']\n\
             velocity = ['1 m/s', '0 m/s']\n"
        )
    };
    let start =
        "[time]\nend = '1 s'\nstep = '1 ms'\n[world]\ngravity = '0 m/s^2'\n[material.m]\ndensity = '2500 kg/m^3'\n";
    format!("{start}{}{}", block("near", places[0]), block("far", places[1]))
}

#[test]
fn blocks_that_stand_far_apart_are_plotted_from_their_starts() {
    for (places, title, first) in
        [(["0 m", "10 m"], "Displacement x \u{2212} x₀", [0.0, 0.0]), (["0 m", "50 cm"], "Position x", [0.0, 0.5])]
    {
        let run = run("sliding", &sliding(places));
        let page = data(&run.html);
        let x = panel(&page, "x").unwrap();
        assert_eq!((&x["title"], &x["unit"]), (&title.into(), &"cm".into()), "{places:?}");
        for (k, start) in first.into_iter().enumerate() {
            let values = numbers(&x["series"][k]["y"]);
            let [from, to] = [values[0], values[values.len() - 1]].map(|x| x / 100.0);
            assert!((from - start).abs() < 1e-4 && (to - start - 1.0).abs() < 1e-4, "{places:?} {k}: {from} {to}");
        }
        assert!(figure(&figures(&run.page), "x.svg").contains(title), "{places:?}");
    }
}

/// One of three goes farther than the range in which they stand: the others would be flat lines at their places.
#[test]
fn where_most_blocks_hardly_move_all_are_plotted_from_their_starts() {
    let third = |velocity: &str| {
        format!(
            "{}[block.third]\nmaterial = 'm'\nwidth = '20 cm'\nheight = '10 cm'\ndepth = '5 cm'\nposition = ['1 m', '35 cm']\n\
             velocity = ['{velocity} m/s', '0 m/s']\n",
            sliding(["0 m", "50 cm"]).replace("'1 m/s', '0 m/s'", "'1 mm/s', '0 m/s'")
        )
    };
    for (velocity, title) in [("3", "Displacement x \u{2212} x₀"), ("0.002", "Displacement x \u{2212} x₀")] {
        let page = data(&run("most-still", &third(velocity)).html);
        let x = panel(&page, "x").unwrap();
        assert_eq!(x["title"], title, "{velocity} m/s");
        let starts: Vec<f64> = (0..3).map(|k| numbers(&x["series"][k]["y"])[0]).collect();
        assert!(starts.iter().all(|start| start.abs() < 1e-9), "{starts:?}");
    }
}

#[test]
fn rounding_is_no_loss_of_energy() {
    let text =
        std::fs::read_to_string(std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/incline.toml"));
    let html = &run("still", &text.unwrap()).html;
    let tile = &html[html.find("data-summary=\"energy.dissipated\"").unwrap()..];
    let shown = &tile[tile.find('>').unwrap() + 1..tile.find("</dd>").unwrap()];
    assert_eq!(shown, "0\u{a0}J");
    let drop = &scenario("drop").html;
    let tile = &drop[drop.find("data-summary=\"energy.dissipated\"").unwrap()..];
    assert!(
        tile[..tile.find("</dd>").unwrap()].ends_with("mJ") || tile[..tile.find("</dd>").unwrap()].ends_with("\u{a0}J")
    );
    assert!(!tile[..tile.find("</dd>").unwrap()].ends_with(">0\u{a0}J"), "what is lost is told");
}

#[test]
fn what_the_scheme_takes_is_no_dissipation() {
    let text = std::fs::read_to_string(
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/free-rocking-on-beam.toml"),
    );
    let text = text.unwrap();
    let theta = run("theta-one", &text.replacen("[time]", "[time]\nscheme = 'moreau-jean'\ntheta = 1.0", 1));
    let energy = &theta.summary.energy;
    assert!(energy.lost_by_scheme > 1e-3 * energy.scale, "{energy:?}");
    assert!((energy.dissipated + energy.lost_by_scheme - energy.lost).abs() < 1e-12 * energy.scale);
    assert!(tile(&theta.html, "energy.lost_by_scheme").is_some_and(|shown| shown.ends_with('J')));
    let mark = "<div class=\"tile numeric\"><dt>Energy lost by the scheme";
    assert!(theta.html.contains(mark), "it is among the numbers of the computation");
    assert!(!scenario("free-rocking-on-ground").html.contains(mark));
}

/// What the tile of a number shows; none if there is no such tile.
pub(crate) fn tile<'a>(html: &'a str, path: &str) -> Option<&'a str> {
    let tile = &html[html.find(&format!("data-summary=\"{path}\""))?..];
    Some(&tile[tile.find('>')? + 1..tile.find("</dd>")?])
}

#[test]
fn the_deepest_penetration_is_the_one_that_the_terminal_tells() {
    let run = scenario("drop");
    let told = teeter_report::with_digits(run.summary.max_penetration, "m", 2).replace(' ', "\u{a0}");
    assert_eq!(tile(&run.html, "max_penetration"), Some(told.as_str()));
    let tiny = scenario("free-rocking-on-ground");
    assert!(tiny.summary.max_penetration > 0.0);
    let digits = teeter_report::with_digits(tiny.summary.max_penetration, "m", 2);
    let shown = tile(&tiny.html, "max_penetration").unwrap();
    assert_eq!(shown.split('\u{a0}').next(), digits.split(' ').next(), "{shown}");
}

#[test]
fn what_does_not_rock_has_no_share_of_its_critical_angle() {
    let text =
        std::fs::read_to_string(std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/incline.toml"));
    let html = &run("still-at-depth", &text.unwrap()).html;
    assert_eq!(tile(html, "max_phi_over_alpha"), None);
    let rocks = &scenario("free-rocking-on-ground").html;
    assert!(tile(rocks, "max_phi_over_alpha").is_some_and(|share| share.starts_with("0.39")));
}

/// A block dropped askew: no corner stands while the other one comes down.
const DROPPED: &str = "time = { end = '1.5 s', step = '200 us' }\nground = {}\nmaterial.oak.density = '700 kg/m^3'\n\
    block.box = { material = 'oak', width = '20 cm', height = '10 cm', depth = '10 cm', position = ['0 cm', '40 cm'], angle = '20 deg' }\n\
    contact.base = { between = ['box', 'ground'], friction = 0.4, restitution = 0.5 }\n";

#[test]
fn a_column_of_half_cycles_without_a_value_is_left_out() {
    let heads = |html: &str| {
        let table = &html[html.find("id=\"rocking-title\"")?..];
        Some(table[..table.find("</thead>")?].matches("<th ").count())
    };
    // So wide that Housner's ratio would be negative.
    let soft = DROPPED
        .replace("position = ['0 cm', '40 cm'], angle = '20 deg'", "on = 'ground', at = '0 cm', tilt = '20 deg'")
        .replace("restitution = 0.5", "law = 'kelvin-voigt', stiffness = '20 kN/m', damping = '20 N s/m'");
    assert_eq!(heads(&run("soft", &soft).html), Some(6), "all but Housner");
    assert_eq!(heads(&scenario("free-rocking-on-ground").html), Some(7));
    // What bounces passes the upright, too, with a value in a few rows at most.
    assert_eq!(heads(&run("dropped", DROPPED).html), None);
}

#[test]
fn a_block_that_rocks_on_ground_going_far_has_its_portrait_in_the_angle() {
    // By 10 m with the ground, and to and fro by 4 degrees on it.
    let text = "time = { end = '2 s', step = '1 ms' }\nground.motion = { velocity = ['5 m/s', '0 m/s'], signal = 'even' }\n\
        signal.even.shape = 'constant'\nmaterial.marble.density = '2700 kg/m^3'\n\
        block.slab = { material = 'marble', width = '12.7 cm', height = '49.7 cm', depth = '10 cm', on = 'ground', at = '0 cm', \
        tilt = '4 deg', velocity = ['5 m/s', '0 m/s'] }\ncontact.base = { between = ['slab', 'ground'], friction = 2.0 }\n";
    let page = data(&run("carried", text).html);
    let portraits: Vec<&str> =
        page["portraits"].as_array().unwrap().iter().map(|one| one["id"].as_str().unwrap()).collect();
    assert_eq!(portraits, ["phase"]);
}

/// Height of a figure, mm.
fn height(svg: &str) -> f64 {
    let rest = &svg[svg.find("height=\"").unwrap() + 8..];
    rest[..rest.find("mm").unwrap()].parse().unwrap()
}

#[test]
fn each_of_many_pairs_has_a_figure_that_fits_a_page() {
    let text = "[time]\nend = '20 ms'\nstep = '1 ms'\n[ground]\n[material.m]\ndensity = '2500 kg/m^3'\n[block.box]\nmaterial = 'm'\nwidth = '10 cm'\n\
        height = '10 cm'\ndepth = '10 cm'\non = 'ground'\nat = '0 cm'\nrepeat = { count = COUNT, stacked = true }\n[contact.floor]\n\
        between = ['*', 'ground']\nfriction = 0.5\n[contact.joints]\nbetween = ['*', '*']\nfriction = 0.5\n";
    let names = |count: &str| {
        let run = run(&format!("pairs-{count}"), &text.replace("COUNT", count));
        let figures = figures(&run.page);
        let own: Vec<_> = figures.into_iter().filter(|(name, _)| name.starts_with("contact_forces")).collect();
        assert!(own.iter().all(|(_, svg)| height(svg) < 240.0), "A4 has 297 mm");
        own.into_iter().map(|(name, _)| name).collect::<Vec<_>>()
    };
    assert_eq!(names("2"), ["contact_forces.svg"]);
    // Of two pairs with three panels and many points each all together would be taller than a page.
    let both = std::fs::read_to_string(
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/two-blocks-on-beam.toml"),
    );
    let both = figures(&run("two-pairs", &both.unwrap()).page);
    let own = both.iter().filter(|(name, _)| name.starts_with("contact_forces"));
    let own: Vec<(&str, f64)> = own.map(|(name, svg)| (name.as_str(), height(svg))).collect();
    assert!(own.len() == 2 && own.iter().all(|(_, height)| *height < 250.0), "{own:?}");
    let of_four = names("4");
    assert_eq!(of_four.len(), 4);
    // The one that lies on the other comes first.
    for name in ["box-1-on-ground", "box-2-on-box-1", "box-4-on-box-3"] {
        assert!(of_four.contains(&format!("contact_forces-{name}.svg")), "{of_four:?}");
    }
}

#[test]
fn half_cycles_name_their_block_and_tell_housner_only_of_one_that_stands_alone() {
    let table = |html: &str| {
        let start = html.find("<section id=\"rocking\"")?;
        let section = &html[start..start + html[start..].find("</section>").unwrap()];
        Some(section.to_owned())
    };
    let text = std::fs::read_to_string(
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/column-of-drums.toml"),
    );
    let drums = table(&run("drums", &text.unwrap()).html).unwrap();
    assert!(drums.contains(">Block</th>") && drums.contains("<th scope=\"row\">drum-1</th>"), "{drums}");
    assert!(!drums.contains("0.0400") && !drums.contains("\u{2212}0.0000"), "{drums}");
    // Its joints close one after the other in the milliseconds after its corner: no instant within that tells what is left.
    assert!(
        drums.contains("<td>0.76000</td><td class=\"wide\">–</td><td class=\"wide\">–</td><td>–</td>")
            && !drums.contains(">0.00000<"),
        "{drums}"
    );
    let alone = table(&scenario("free-rocking-on-ground").html).unwrap();
    assert!(!alone.contains(">Block</th>") && alone.contains("<td class=\"wide\">0.9294</td>"), "{alone}");
}

#[test]
fn what_tumbles_has_no_half_cycles_and_a_run_too_short_says_so() {
    let scene = |end: &str, height: &str, place: &str| {
        format!(
            "[time]\nend = '{end}'\nstep = '500 us'\n[ground]\n[material.m]\ndensity = '2500 kg/m^3'\n[block.cube]\nmaterial = 'm'\n\
             width = '6 cm'\nheight = '{height}'\ndepth = '6 cm'\n{place}\n[contact.floor]\nbetween = ['cube', 'ground']\n\
             friction = 0.5\nrestitution = 0.6\n"
        )
    };
    // It turns to and fro about the upright as it hits the ground, without ever standing.
    let flies = "position = ['0 m', '10 cm']\nangle = '8 deg'\nspin = '-2 rad/s'";
    let tumbling = run("tumbling", &scene("300 ms", "6 cm", flies));
    assert!(!tumbling.summary.crossings.is_empty());
    let stands = tumbling.summary.max_phi_over_alpha.is_some();
    assert!(!stands && teeter_report::half_cycles(&tumbling.page, &tumbling.summary).is_empty());
    let short = run("short", &scene("1 ms", "24 cm", "on = 'ground'\nat = '0 m'\ntilt = '5 deg'"));
    assert_eq!(
        short.summary.headline,
        "`cube` has not been upright yet, too short a run to tell how it rocks: φ 5.00° at t = 1 ms, largest 5° at t = 0 s"
    );
}

#[test]
fn figures_and_page_of_a_long_run_open_where_something_moves() {
    let text = "[time]\nend = '20 s'\nstep = '1 ms'\n[ground]\n[signal.kick]\nshape = 'half-sine'\nstart = '8 s'\nduration = '1 s'\n\
        [force.push]\non = 'box'\nforce = ['85 N', '0 N']\nsignal = 'kick'\n[block.box]\ndensity = '800 kg/m^3'\nwidth = '20 cm'\n\
        height = '40 cm'\ndepth = '20 cm'\non = 'ground'\nat = '0 m'\n[contact.base]\nbetween = ['box', 'ground']\nfriction = 0.4\n";
    let run = run("long-wait", text);
    let ends = numbers(&data(&run.html)["moving"]["moves"]);
    assert!((8.0..8.5).contains(&ends[0]) && (9.0..9.5).contains(&ends[1]), "{ends:?}");
    // The push grows from 8 s on, before anything moves.
    let shown = numbers(&data(&run.html)["moving"]["shown"]);
    assert!(shown[0] < 8.0 && shown[1] > ends[1], "{shown:?}");
    let svg = figure(&figures(&run.page), "x.svg");
    assert!(svg.contains("Time t (s), of a run to 20 s") && svg.contains(">9.0<") && !svg.contains(">15<"), "{svg}");
    // Forces and energies may change where nothing moves.
    for file in ["contact_forces.svg", "energy.svg"] {
        assert!(!figure(&figures(&run.page), file).contains("of a run to"), "{file}");
    }
    assert!(data(&scenario("sliding").html)["moving"].is_null(), "it moves for most of the run");
    // Where half of the axis and more would be rest they open on the motion, too.
    let sliding = include_str!("../../../../scenarios/sliding.toml");
    let longer = crate::page::run("slides-and-rests", &sliding.replace("end  = \"0.5 s\"", "end  = \"1 s\""));
    let shown = numbers(&data(&longer.html)["moving"]["shown"]);
    assert!(shown[0] == 0.0 && (0.4..0.5).contains(&shown[1]), "{shown:?}");
    // What falls from the start on has hardly moved at first: that is no rest before.
    let falls = "[time]\nend = '2 s'\nstep = '100 us'\n[ground]\n[block.b]\ndensity = '2400 kg/m^3'\nwidth = '20 cm'\nheight = '10 cm'\n\
        depth = '10 cm'\nposition = ['0 m', '60 cm']\nangle = '3 deg'\n[contact.c]\nbetween = ['b', 'ground']\nfriction = 0.4\n";
    let falls = crate::page::run("falls-at-once", falls);
    let moving = &data(&falls.html)["moving"];
    let [moves, shown] = ["moves", "shown"].map(|key| numbers(&moving[key]));
    assert!(moves[0] == 0.0 && shown[0] == 0.0 && moves[1] < 0.8, "{moves:?} {shown:?}");
    // It is thrown over by the first of many cycles, and lies still on ground that goes on.
    let shaken = "[time]\nend = '20 s'\nstep = '1 ms'\n[ground]\nmotion = { acceleration = ['4 m/s^2', '0 m/s^2'], signal = 'shake' }\n\
        [signal.shake]\nshape = 'harmonic'\nfrequency = '1 Hz'\n[block.box]\ndensity = '800 kg/m^3'\nwidth = '10 cm'\nheight = '50 cm'\n\
        depth = '20 cm'\non = 'ground'\nat = '0 m'\n[contact.base]\nbetween = ['box', 'ground']\nfriction = 0.8\n";
    let shaken = crate::page::run("thrown-over", shaken);
    let page = data(&shaken.html);
    let ends = numbers(&page["moving"]["moves"]);
    assert!(ends[0] < 0.5 && ends[1] < 4.0, "{ends:?}");
    let x = crate::page::panel(&page, "x").unwrap();
    assert_eq!(x["title"], "Position x relative to the ground");
    let travel = numbers(&x["series"][0]["y"]).iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let unit = if x["unit"] == "m" { 1.0 } else { 100.0 };
    assert!((0.1..1.5).contains(&(travel / unit)), "the ground goes 12 m: {travel} {}", x["unit"]);
    // A post that isn't on that ground would seem to move.
    let beside = "[time]\nend = '1 s'\nstep = '1 ms'\n[ground]\nmotion = { acceleration = ['4 m/s^2', '0 m/s^2'], signal = 'shake' }\n\
        [signal.shake]\nshape = 'harmonic'\nfrequency = '1 Hz'\n[block.box]\ndensity = '800 kg/m^3'\nwidth = '30 cm'\nheight = '20 cm'\n\
        depth = '20 cm'\non = 'ground'\nat = '0 m'\n[block.post]\nfixed = true\nwidth = '10 cm'\nheight = '20 cm'\ndepth = '20 cm'\n\
        density = '800 kg/m^3'\nposition = ['5 m', '1 m']\n[contact.base]\nbetween = ['box', 'ground']\nfriction = 0.2\n";
    let page = data(&crate::page::run("post-beside", beside).html);
    let x = crate::page::panel(&page, "x").unwrap();
    assert!(!x["title"].as_str().unwrap().contains("relative") && !x["series"].to_string().contains("post"), "{x}");
    // Of many bodies only the ground has a plot of its own.
    let crowd = "[time]\nend = '0.4 s'\nstep = '1 ms'\n[ground]\nmotion = { acceleration = ['1 m/s^2', '0 m/s^2'], signal = 'kick' }\n\
        [signal.kick]\nshape = 'one-sine'\nperiod = '20 ms'\n[block.b]\ndensity = '800 kg/m^3'\nwidth = '20 cm'\nheight = '20 cm'\n\
        depth = '20 cm'\nposition = ['0 cm', '10 cm']\nrepeat = { count = 40, shift = ['50 cm', '0 cm'] }\n[contact.base]\nbetween = ['*', 'ground']\n\
        friction = 0.4\n";
    let crowd = data(&crate::page::run("shaken-crowd", crowd).html);
    assert!(!crowd["crowd"].is_null() && crowd["moving"].is_null());
}

/// Supports that are shaken would hide how what stands on their beam rocks and slides.
#[test]
fn on_a_beam_whose_supports_move_places_are_measured_from_these() {
    let text = "[time]\nend = '1 s'\nstep = '1 ms'\n[material.steel]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n[signal.shake]\n\
        shape = 'harmonic'\nfrequency = '2 Hz'\n[beam.shelf]\nmaterial = 'steel'\nspan = '1 m'\nwidth = '20 cm'\nthickness = '8 mm'\nelements = 20\n\
        supports = ['pinned', 'pinned']\ndamping_ratio = { mode = 1, ratio = 0.02 }\nstart = 'static'\n\
        motion = { acceleration = ['1 m/s^2', '0 m/s^2'], signal = 'shake' }\n[block.statue]\ndensity = '2600 kg/m^3'\nwidth = '10 cm'\n\
        height = '15 cm'\ndepth = '10 cm'\non = 'shelf'\nat = '50 cm'\n[contact.c]\nbetween = ['statue', 'shelf']\nfriction = 0.05\n";
    let page = data(&crate::page::run("shelf-shaken", text).html);
    let x = crate::page::panel(&page, "x").unwrap();
    assert_eq!(x["title"], "Position x relative to the supports");
    let of = |panel: &str, column: &str| {
        let panel = crate::page::panel(&page, panel).unwrap();
        let per_metre =
            [("m", 1.0), ("cm", 1e2), ("mm", 1e3)].into_iter().find(|(unit, _)| panel["unit"] == *unit).unwrap().1;
        let series = panel["series"].as_array().unwrap().iter().find(|line| line["label"] == column).unwrap();
        numbers(&series["y"]).iter().map(|x| x / per_metre).collect::<Vec<_>>()
    };
    let own = of("x", "");
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    let table = folder.join(format!("page-{}", std::process::id())).join("shelf-shaken/trajectory.csv");
    let table = crate::plots::table(&table);
    let column = |name: &str| &table.iter().find(|(column, _)| column == name).unwrap().1;
    let [statue, support] = ["statue.x", "shelf.support.x"].map(|name| *column(name).last().unwrap());
    assert!(support.abs() > 0.05, "the supports go {support} m");
    assert!((own.last().unwrap() - (statue - support)).abs() < 1e-5, "{:?} {statue} {support}", own.last());
    // Where there is ground beside the beam it may stand on either.
    let beside = data(&crate::page::run("shelf-and-ground", &format!("{text}[ground]\n")).html);
    assert_eq!(crate::page::panel(&beside, "x").unwrap()["title"], "Position x");
}
