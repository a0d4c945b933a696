//! What is plotted, against the tables: what moves, what is probed, what slips, what is prescribed; and what isn't.

use crate::page::{SCENARIOS, assert_well_formed, data, numbers, panel, run, scenario};
use crate::table::{column, columns_of};
use std::fs;
use std::path::Path;
use teeter_report::{columns, figures};
use teeter_scenario::simulation::Simulation;

/// A table's columns by name.
pub(crate) fn table(path: &Path) -> Vec<(String, Vec<f64>)> {
    columns_of(&fs::read_to_string(path).unwrap())
}

fn scenario_text(name: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../scenarios/{name}.toml"))).unwrap()
}

#[test]
fn a_coordinate_is_plotted_where_the_trajectory_moves_in_it() {
    for name in SCENARIOS {
        let run = scenario(name);
        let page = data(&run.html);
        let trajectory = table(&run.folder.join("trajectory.csv"));
        for (id, rate, scale) in [("x", "vx", 0.05), ("y", "vy", 0.05), ("phi", "omega", 1.0)] {
            let (_, values) = trajectory.iter().find(|(column, _)| column.ends_with(&format!(".{id}"))).unwrap();
            let travel = values.iter().map(|x| (x - values[0]).abs()).fold(0.0, f64::max);
            // Between rounding and a motion there is nothing in these scenes: neither 1e-6 nor 1e-10 of the scale.
            assert!(travel > 1e-6 * scale || travel < 1e-10 * scale, "{name}: {id} {travel}");
            assert_eq!(panel(&page, id).is_some(), travel > 1e-6 * scale, "{name}: {id} {travel}");
            assert_eq!(panel(&page, rate).is_some(), panel(&page, id).is_some(), "{name}: {rate}");
        }
        // One block, one portrait, of a coordinate that is plotted.
        let portraits = page["portraits"].as_array().unwrap();
        assert_eq!(portraits.len(), 1, "{name}");
        let of = portraits[0]["id"].as_str().unwrap();
        assert!(panel(&page, of.strip_prefix("phase_").unwrap_or("phi")).is_some(), "{name}: {of}");
    }
}

#[test]
fn a_block_at_rest_on_an_incline_has_no_plot_of_rounding() {
    let run = run("resting-on-incline", &scenario_text("incline"));
    let page = data(&run.html);
    let ids: Vec<&str> = page["panels"].as_array().unwrap().iter().map(|panel| panel["id"].as_str().unwrap()).collect();
    assert!(ids.is_empty(), "nothing moves: {ids:?}");
    assert!(page["portraits"].as_array().unwrap().is_empty());
    let start = run.html.find("id=\"not-drawn\"").unwrap();
    let told = &run.html[start..start + run.html[start..].find("</p>").unwrap()];
    for what in ["φ of cube", "x of cube", "energy: kinetic, gravity, total", "slip"] {
        assert!(told.contains(what), "{what}: {told}");
    }
    // What carries the block is there.
    assert!(figures(&run.page).iter().any(|(file, _)| file == "contact_forces.svg"));
}

#[test]
fn forces_that_equilibrium_leaves_open_are_told_as_one_of_many_sets() {
    // 16 joints of 15 voussoirs: 48 unknowns, 45 equations. Near the load that brings it down joints open, and it is determinate.
    let text = scenario_text("masonry-arch").replace("end  = \"1 s\"", "end  = \"20 ms\"").replace("-900 N", "-1 N");
    let arch = run("arch-of-many", &text);
    let page = data(&arch.html);
    assert_eq!(page["forces"]["redundant"].as_array().unwrap().len(), 16);
    let svg = |name: &str| figures(&arch.page).into_iter().find(|(file, _)| file == name).unwrap().1;
    assert!(svg("thrust_line.svg").contains("many equilibria of rigid bodies"));
    assert!(svg("contact_forces-v1-on-ground.svg").contains("many equilibria of rigid bodies"));
    assert!(arch.html.contains("many equilibria of rigid bodies"));
    // A stack has as many equations as unknowns: three of each a block.
    let stack = run("stack-of-one", &scenario_text("stack-of-blocks"));
    assert!(data(&stack.html)["forces"]["redundant"].is_null());
    // On level ground the sums over its feet are what the first steps leave of shares that face each other.
    let forces = &data(&stack.html)["forces"];
    assert!(forces["shares"].as_array().unwrap().len() == 20 && forces["frictionless"] == forces["shares"]);
    assert!(!figures(&stack.page).iter().any(|(_, svg)| svg.contains("many equilibria")));
}

#[test]
fn a_tangential_force_that_feet_share_in_one_of_many_ways_is_drawn_as_their_sum() {
    let run = run("shaken-sum", &scenario_text("shaken-ground"));
    let page = data(&run.html);
    assert_eq!(page["forces"]["shares"], serde_json::json!([0]));
    let svg = figures(&run.page).into_iter().find(|(file, _)| file == "contact_forces.svg").unwrap().1;
    let (_, tangential) = svg.split_once("Tangential force").unwrap();
    assert!(svg.contains("sum over the points"));
    // In the colour of none of the feet, with a name of its own.
    assert_eq!(svg.matches(">sum</text>").count(), 1);
    assert_eq!(svg.matches("Tangential force (").count(), 1, "{tangential}");
    // A short rest before a column of drums is shaken is enough for a square wave between the feet of its lowest drum.
    let drums = crate::page::run("drums-at-rest", &scenario_text("column-of-drums"));
    assert!(data(&drums.html)["forces"]["shares"].as_array().unwrap().contains(&0.into()));
    // One foot slips to and fro with the fibre of the beam, while the plate lies still on it.
    let plate = scenario_text("two-blocks-on-beam").replace("end    = \"0.5 s\"", "end    = \"60 ms\"");
    let plate = crate::page::run("plate-on-beam", &plate);
    assert!(data(&plate.html)["forces"]["shares"].as_array().unwrap().contains(&0.into()));
    // So is the rest of a block on a beam, whose vibrations decide the shares.
    let standing = scenario_text("free-rocking-on-beam").replacen("tilt     = \"5 deg\"", "tilt     = \"0 deg\"", 1);
    assert!(standing.contains("0 deg"));
    assert_eq!(data(&crate::page::run("beam-at-rest", &standing).html)["forces"]["shares"], serde_json::json!([0]));
    // One that rocks stands on one foot at a time, whose force is known.
    let rocks = scenario("free-rocking-on-beam");
    assert_eq!(data(&rocks.html)["forces"]["shares"].as_array().map_or(0, Vec::len), 0);
}

#[test]
fn the_largest_shape_is_near_the_largest_deflection_where_pictures_are_several_steps_apart() {
    // 5000 steps, 2000 pictures at most.
    let thinned = &scenario("free-rocking-on-beam").html;
    assert!(thinned.contains("near the largest, t = ") && !thinned.contains(">largest, t = "));
    let short = scenario_text("free-rocking-on-beam").replacen("end  = \"0.5 s\"", "end  = \"0.1 s\"", 1);
    let whole = run("shapes-of-all-steps", &short).html;
    assert!(whole.contains("largest, t = ") && !whole.contains("near the largest"));
}

#[test]
fn the_peak_of_a_compliant_contact_is_plotted_as_large_as_it_is() {
    let text = format!("{}\n[output]\nevery = '50 us'\n", scenario_text("compliant-drop"));
    let run = run("compliant-peak", &text);
    let written = table(&run.folder.join("contacts.csv"));
    let most = |values: &[f64]| values.iter().copied().filter(|x| x.is_finite()).fold(0.0, f64::max);
    let page = data(&run.html);
    let points = page["forces"]["points"].as_array().unwrap();
    let drawn = points.iter().map(|point| most(&numbers(&point["course"][0]["y"]))).fold(0.0, f64::max);
    let peak = most(column(&written, "p_n")) / 50e-6;
    assert!((drawn / peak - 1.0).abs() < 1e-3, "{drawn} N, not {peak} N");
    // 20 000 steps are more than are drawn one by one.
    assert_eq!(page["forces"]["springs"], "the least and the largest of every 800 µs");
    let (_, svg) = figures(&run.page).into_iter().find(|(file, _)| file == "contact_forces.svg").unwrap();
    assert!(svg.contains("the least and the largest of every"));
}

#[test]
fn what_rolls_has_an_axis_of_its_own_beside_what_rocks() {
    let text = "ground = {}\n[time]\nend = '0.6 s'\nstep = '1 ms'\n[material.stone]\ndensity = '2400 kg/m^3'\n\
        [block.statue]\nmaterial = 'stone'\nwidth = '30 cm'\nheight = '1 m'\ndepth = '30 cm'\non = 'ground'\nat = '0 m'\ntilt = '5 deg'\n\
        [block.ball]\nmaterial = 'stone'\nradius = '8 cm'\ndepth = '16 cm'\non = 'ground'\nat = '2 m'\nvelocity = ['2 m/s', '0 m/s']\n\
        [contact.g]\nbetween = ['*', 'ground']\nfriction = 0.6\n";
    let page = data(&run("ball-beside-statue", text).html);
    let of = |id: &str| {
        panel(&page, id).unwrap()["series"]
            .as_array()
            .unwrap()
            .iter()
            .map(|one| one["index"].as_u64().unwrap())
            .collect::<Vec<_>>()
    };
    assert_eq!([of("phi"), of("omega"), of("phi_rolling"), of("omega_rolling")], [[0], [0], [1], [1]]);
    let portraits: Vec<&str> =
        page["portraits"].as_array().unwrap().iter().map(|one| one["id"].as_str().unwrap()).collect();
    assert_eq!(portraits, ["phase", "phase_x"]);
    // Alone it has the usual one.
    let alone = text.split("[block.statue]").next().unwrap().to_owned()
        + "[block.ball]"
        + text.split("[block.ball]").nth(1).unwrap();
    let page = data(&run("ball-alone", &alone).html);
    assert!(panel(&page, "phi").is_some() && panel(&page, "phi_rolling").is_none());
}

#[test]
fn the_model_lists_its_loads() {
    let bridge = scenario_text("two-span-beam").replace("end  = \"1.5 s\"", "end  = \"10 ms\"");
    let told = [
        (bridge, "lorry on bridge: 5 kN downwards, at 0 m at first, then by 20 m/s"),
        (scenario_text("pushed-block"), "hand on box: 6 N to the right"),
    ];
    for (text, load) in told {
        let crate::page::Run { summary, html, .. } = run("loads", &text);
        assert_eq!(summary.model.loads, [load]);
        assert!(html.contains(&format!("<dt>Loads</dt><dd>{load}</dd>")));
    }
}

#[test]
fn a_support_in_the_middle_of_a_beam_is_no_midspan() {
    let short = scenario_text("two-span-beam").replace("end  = \"1.5 s\"", "end  = \"0.2 s\"");
    let labels = |text: &str| {
        let page = data(&run("two-spans", text).html);
        let series = panel(&page, "w_mid").unwrap()["series"].as_array().unwrap().clone();
        series.iter().map(|one| one["label"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    assert!(labels(&short).contains(&"support, 8 m".to_owned()));
    assert!(labels(&short.replace("at     = \"8 m\"", "at     = \"6 m\"")).contains(&"middle, 8 m".to_owned()));
    // Of three spans it is that of the second one.
    let three = short.replace("at     = \"8 m\"", "at     = \"6 m\"")
        + "[beam.bridge.support.other]\nat = '10 m'\nspring = '50 MN/m'\n";
    assert!(labels(&three).contains(&"midspan, 8 m".to_owned()));
}

#[test]
fn plots_open_on_no_part_of_which_they_have_only_a_few_extremes() {
    // They fall within the first twentieth of a second of ten.
    let text = |step: &str| {
        format!(
            "ground = {{}}\n[time]\nend = '10 s'\nstep = '{step}'\n[material.stone]\ndensity = '2400 kg/m^3'\n\
         [block.one]\nmaterial = 'stone'\nwidth = '10 cm'\nheight = '10 cm'\ndepth = '10 cm'\nposition = ['0 m', '6 cm']\n\
         repeat = {{ count = 4, shift = ['20 cm', '0 cm'] }}\n[contact.g]\nbetween = ['*', 'ground']\nfriction = 0.6\n"
        )
    };
    let opens = |step: &str| !data(&run("opening", &text(step)).html)["moving"].is_null();
    assert!(opens("5 ms"), "every step is drawn");
    assert!(!opens("100 us"), "a few points of each curve");
}

#[test]
fn friction_that_rises_in_impacts_says_that_it_shares_their_work() {
    let tilted = "title = 't'\n[time]\nend = '0.6 s'\nstep = '100 us'\n[ground]\n[material.a]\ndensity = '2000 kg/m^3'\n[block.b]\n\
        material = 'a'\nwidth = '10 cm'\nheight = '20 cm'\ndepth = '10 cm'\nposition = ['0 m', '60 cm']\nangle = '25 deg'\n\
        spin = '6 rad/s'\n[contact.f]\nbetween = ['b', 'ground']\nfriction = 0.6\nrestitution = 0.5\n";
    let run = run("drop-tilted-note", tilted);
    let page = data(&run.html);
    let works = panel(&page, "works").unwrap();
    let friction = works["series"].as_array().unwrap().iter().find(|line| line["label"] == "friction").unwrap();
    let y = numbers(&friction["y"]);
    let mut least = f64::INFINITY;
    let rise = y
        .iter()
        .map(|x| {
            least = least.min(*x);
            x - least
        })
        .fold(0.0, f64::max);
    let largest = y.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    assert_eq!(works["note"].is_string(), rise > 0.01 * largest, "{rise} of {largest}");
    let slides = scenario("sliding");
    assert!(panel(&data(&slides.html), "works").unwrap()["note"].is_null(), "friction alone only takes");
}

#[test]
fn slip_is_the_way_that_a_block_slides() {
    let run = scenario("sliding");
    let trajectory = table(&run.folder.join("trajectory.csv"));
    let x = column(&trajectory, "slider.x");
    let way = x[x.len() - 1] - x[0];
    let contacts = table(&run.folder.join("contacts.csv"));
    let slip = column(&contacts, "slip");
    // The same at both corners of the base, as it doesn't turn; the last two rows are theirs.
    for slip in &slip[slip.len() - 2..] {
        assert!((slip.abs() - way).abs() < 1e-12, "{slip} m against {way} m");
    }
    // v²/(2 μ g), to a step at the first speed.
    assert!((way - 1.0 / (2.0 * 0.3 * 9.81)).abs() < 1e-3);
    let page = data(&run.html);
    let drawn = numbers(&panel(&page, "slip-0").unwrap()["series"][0]["y"]);
    assert!((drawn[drawn.len() - 1].abs() - 100.0 * way).abs() < 1e-4, "in cm, as the scene");
    assert_eq!(panel(&page, "slip-0").unwrap()["unit"], "cm");
    // It never goes back.
    assert!(drawn.windows(2).all(|pair| pair[1].abs() >= pair[0].abs() - 1e-9));
}

#[test]
fn the_motion_of_the_ground_is_in_the_table_and_on_the_page() {
    let run = run("shaken", &scenario_text("shaken-ground"));
    let trajectory = table(&run.folder.join("trajectory.csv"));
    let names: Vec<&str> = trajectory.iter().map(|(name, _)| name.as_str()).collect();
    let ends = ["slab.omega", "ground.x", "ground.vx", "ground.ax", "ground.y", "ground.vy", "ground.ay"];
    assert!(names.ends_with(&ends), "{names:?}");
    let [t, x, v, a] = ["t", "ground.x", "ground.vx", "ground.ax"].map(|name| column(&trajectory, name));
    let largest = |values: &[f64]| values.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    // Each is the rate of the one before: differences over two rows, but where the acceleration jumps.
    let rates = |of: &[f64], rate: &[f64]| {
        let off = |k: usize| (of[k + 1] - of[k - 1]) / (t[k + 1] - t[k - 1]) - rate[k];
        (1..t.len() - 1).filter(|k| off(*k).abs() > 1e-3 * largest(rate)).count()
    };
    assert!(rates(x, v) <= 4 && rates(v, a) <= 4, "{} {}", rates(x, v), rates(v, a));
    assert!((largest(a) - 3.0059).abs() < 1e-3);
    let page = data(&run.html);
    for (id, unit) in [("ground", "cm"), ("ground_v", "cm/s"), ("ground_a", "m/s²")] {
        assert_eq!(panel(&page, id).unwrap()["unit"], unit, "{id}");
    }
    let drawn = numbers(&panel(&page, "ground").unwrap()["series"][0]["y"]);
    assert!((largest(&drawn) - 100.0 * largest(x)).abs() < 1e-4 * largest(&drawn));
    // Each column has its unit.
    let resolved = teeter_scenario::load(scenario_text("shaken-ground").as_bytes(), "s", "s", &[]).unwrap();
    let simulation = Simulation::new(&resolved.scene).unwrap();
    let units = columns(&resolved.scene, &simulation.layout).unwrap();
    let units: serde_json::Value = serde_json::from_str(&units).unwrap();
    let of = units["trajectory.csv"].as_array().unwrap();
    assert_eq!(of[of.len() - 1], serde_json::json!(["ground.ay", "m/s^2"]));
}

const BRIDGE: &str = r#"
    time = { end = "60 ms", step = "0.2 ms" }
    output.figure_width = "WIDTH"
    material.steel = { density = "7850 kg/m^3", youngs_modulus = "210 GPa" }
    [beam.deck]
    material = "steel"
    span = "600 mm"
    width = "30 mm"
    thickness = "4 mm"
    elements = 12
    self_weight = true
    probes = ["150 mm", "300 mm", "450 mm", "600 mm"]
    record = ["w", "moment", "shear"]
    [beam.deck.support.pier]
    at = "200 mm"
    kind = "pinned"
"#;

#[test]
fn every_probe_has_its_curve_unless_it_is_rounding() {
    let run = run("bridge", &BRIDGE.replace("WIDTH", "84 mm"));
    let page = data(&run.html);
    let deflections = panel(&page, "w_mid").unwrap();
    let labels: Vec<&str> =
        deflections["series"].as_array().unwrap().iter().map(|series| series["label"].as_str().unwrap()).collect();
    // The right end is a support: it doesn't move.
    assert_eq!(labels, ["middle, 300 mm", "150 mm", "450 mm"]);
    assert!(run.html.contains("w at the probe 600\u{a0}mm (0)"));
    assert!(run.html.contains("id=\"shapes\""));
    let names: Vec<String> = figures(&run.page).into_iter().map(|(file, _)| file).collect();
    assert!(names.iter().any(|file| file == "shapes.svg"), "{names:?}");
}

#[test]
fn figures_have_the_width_of_a_journals_column() {
    for (width, units) in [("84 mm", 336), ("174 mm", 696)] {
        let run = run(&format!("bridge-{units}"), &BRIDGE.replace("WIDTH", width));
        let figures = figures(&run.page);
        assert!(figures.len() >= 3);
        for (file, svg) in figures {
            assert_well_formed(&file, &svg);
            assert!(svg.contains(&format!("width=\"{}mm\"", units / 4)), "{file}");
            // 4 units are a millimetre: 7 pt are 9.9, 9 pt are 12.7.
            for size in svg.split("font-size=\"").skip(1).map(|rest| rest.split('"').next().unwrap()) {
                assert!((9.9..12.7).contains(&size.parse::<f64>().unwrap()), "{file}: {size}");
            }
        }
    }
}

#[test]
fn a_portrait_is_as_smooth_as_the_motion() {
    let run = scenario("free-rocking-on-ground");
    let page = data(&run.html);
    let portrait = &page["portraits"][0]["series"][0];
    let (phi, omega) = (numbers(&portrait["x"]), numbers(&portrait["y"]));
    let borders = numbers(&portrait["t"]);
    assert_eq!((phi.len(), omega.len()), (borders.len(), borders.len()));
    // Both at one instant: φ changes by the mean of its rate, but in the few stretches in which a corner hits.
    let off = (1..phi.len()).filter(|&k| {
        let rate = (phi[k] - phi[k - 1]).to_radians() / (borders[k] - borders[k - 1]);
        (rate - 0.5 * (omega[k] + omega[k - 1])).abs() > 0.01
    });
    let (off, impacts) = (off.count(), run.summary.impacts.len());
    assert!(off <= 2 * impacts && impacts < 60, "{off} of {} with {impacts} impacts", phi.len());
}

#[test]
fn where_a_curve_shows_extremes_the_values_at_the_pictures_are_those_of_the_trajectory() {
    let text = "[time]\nend = '2 s'\nstep = '100 us'\n[beam.t]\nsection = 'direct'\nbending_stiffness = '1 N m^2'\n\
        mass_per_length = '0.066 kg/m'\nspan = '1 m'\nelements = 4\nstart = { mode = 3, amplitude = '1 mm' }\n\
        probes = ['20 cm']\n[output]\nevery = '100 us'\n";
    let run = run("ringing", text);
    let page = data(&run.html);
    assert_eq!(page["curves"]["thinned"], true);
    let series = &panel(&page, "w_mid").unwrap()["series"][0];
    let at: Vec<usize> = numbers(&series["other_at"]).into_iter().map(|x| x as usize).collect();
    let (others, t) = (numbers(&series["others"]), numbers(&page["frames"]["t"]));
    assert!(others.len() == at.len() && others.len() > 50, "{}", others.len());
    let trajectory = table(&run.folder.join("trajectory.csv"));
    let of = |name: &str| &trajectory.iter().find(|(column, _)| column == name).unwrap().1;
    let (times, w) = (of("t"), of("t.w_mid"));
    let mut picture = 0;
    let range =
        others.iter().fold(0.0, |most: f64, w| most.max(*w)) - others.iter().fold(0.0, |least: f64, w| least.min(*w));
    for (after, shown) in at.into_iter().zip(others) {
        picture += after;
        let row = times.iter().position(|row| (row - t[picture]).abs() < 1e-9).unwrap();
        let millimetres = 1e3 * w[row];
        // To the step in which the page has them, a hundred-thousandth of their range.
        assert!((shown - millimetres).abs() <= 0.6e-5 * range, "{shown} at {}, {millimetres}", t[picture]);
    }
}

#[test]
fn lines_of_a_plot_are_where_a_block_that_lies_on_its_side_overturns() {
    let text = "[time]\nend = '100 ms'\nstep = '1 ms'\n[ground]\n[material.m]\ndensity = '2500 kg/m^3'\n[block.slab]\nmaterial = 'm'\n\
        width = '3 cm'\nheight = '6 cm'\ndepth = '3 cm'\nposition = ['0 m', '3 cm']\nangle = '80 deg'\n[contact.feet]\n\
        between = ['slab', 'ground']\nfriction = 0.5\n";
    let page = data(&run("on-its-side", text).html);
    let guides = numbers(&page["portraits"][0]["guides"]);
    let beta = 2.0_f64.atan().to_degrees();
    assert!(
        guides.len() == 2 && (guides[0] - 90.0 + beta).abs() < 1e-3 && (guides[1] - 90.0 - beta).abs() < 1e-3,
        "{guides:?}"
    );
}

/// A cube that bounces, and is pressed down long after, has its impacts drawn: in 5 ms that push gives more than any of them.
#[test]
fn a_large_force_at_another_time_hides_no_impact() {
    let text = "[time]\nend = '3 s'\nstep = '5 ms'\n[ground]\n[signal.on]\nshape = 'constant'\nstart = '2.5 s'\n[force.push]\non = 'cube'\n\
        force = ['0 N', '-300 N']\nsignal = 'on'\n[block.cube]\ndensity = '1000 kg/m^3'\nwidth = '10 cm'\nheight = '10 cm'\ndepth = '10 cm'\n\
        position = ['0 m', '10 cm']\n[contact.floor]\nbetween = ['cube', 'ground']\nfriction = 0.5\nrestitution = 0.6\n";
    for (name, run) in
        [("pressed-cube", &run("pressed-cube", text)), ("free-rocking-on-beam", scenario("free-rocking-on-beam"))]
    {
        let page = data(&run.html);
        let points = page["forces"]["points"].as_array().unwrap_or_else(|| panic!("{}", page["forces"]));
        let borders = numbers(&page["forces"]["borders"]);
        let impacts = table(&run.folder.join("impacts.csv"));
        let struck = column(&impacts, "t");
        let drawn: Vec<f64> = (0..borders.len() - 1)
            .filter(|k| points.iter().any(|point| !point["impacts"].is_null() && numbers(&point["impacts"])[*k] > 0.0))
            .map(|k| borders[k + 1])
            .collect();
        let stretch = borders.windows(2).map(|ends| ends[1] - ends[0]).fold(0.0, f64::max) * 1.01;
        for t in struck {
            assert!(drawn.iter().any(|at| (at - t).abs() <= stretch), "{name}: {t} of {drawn:?}");
        }
        for at in &drawn {
            assert!(struck.iter().any(|t| (at - t).abs() <= stretch), "{name}: {at} of {struck:?}");
        }
    }
}

/// A crest of the bending deck touches the block for an instant: what it bears then is no measure for the feet.
#[test]
fn a_point_that_touches_for_an_instant_cuts_no_forces_of_the_others() {
    let text = r#"
time = { end = "0.6 s", step = "200 us" }
signal.s = { shape = "ricker", frequency = "3 Hz", peak = "0.5 s" }
[material.al]
density = "2700 kg/m^3"
youngs_modulus = "69 GPa"
[beam.deck]
material = "al"
span = "1.2 m"
width = "5 cm"
thickness = "6 mm"
elements = 30
supports = ["pinned", "pinned"]
start = "static"
damping_ratio = { mode = 1, ratio = 0.02 }
motion = { acceleration = ["0 m/s^2", "6 m/s^2"], signal = "s" }
[beam.deck.support.mid]
at = "0.6 m"
kind = "pinned"
[block.a]
material = "al"
width = "5 cm"
height = "15 cm"
depth = "5 cm"
on = "deck"
at = "0.3 m"
tilt = "3 deg"
[contact.c]
between = ["a", "deck"]
friction = 0.5
"#;
    let page = data(&run("crest-touches", text).html);
    let points = page["forces"]["points"].as_array().unwrap();
    assert!(points.iter().any(|point| point["mean"].is_null()) && points.iter().any(|point| !point["mean"].is_null()));
    let means = points.iter().filter(|point| !point["mean"].is_null()).map(|point| numbers(&point["mean"]));
    let strongest = means.flatten().fold(0.0, f64::max);
    let limit = page["forces"]["cuts"][0][0]["limit"].as_f64();
    assert!(strongest > 10.0 && limit.is_none_or(|limit| limit >= 1.4 * strongest), "{limit:?} N of {strongest} N");
}

/// Its curve is no polygon through the extremes of stretches of steps.
#[test]
fn a_sine_of_the_ground_is_one_in_a_long_run() {
    let text = "[time]\nend = '2 s'\nstep = '50 us'\n[ground]\nmotion = { displacement = ['8 mm', '0 mm'], signal = 'shake' }\n[signal.shake]\n\
        shape = 'harmonic'\nphase = '90 deg'\nfrequency = '2 Hz'\n[block.b]\ndensity = '2400 kg/m^3'\nwidth = '20 cm'\nheight = '10 cm'\n\
        depth = '10 cm'\non = 'ground'\nat = '0 m'\n[contact.feet]\nbetween = ['b', 'ground']\nfriction = 0.5\n";
    let shaken = run("long-sine", text);
    let data = data(&shaken.html);
    assert_eq!(data["curves"]["thinned"], true, "each step is drawn");
    let panel = panel(&data, "ground_a").unwrap();
    let (t, y) = (numbers(&panel["t"]), numbers(&panel["series"][0]["y"]));
    assert_eq!(t.len(), y.len());
    assert!(t.len() > 1000, "{}", t.len());
    let omega = 4.0 * std::f64::consts::PI;
    for (t, y) in t.iter().zip(&y) {
        // The page has a hundred-thousandth of the range of a curve.
        let wanted = -8e-3 * omega * omega * (omega * t).cos();
        assert!((y - wanted).abs() < 1e-4, "{y}, not {wanted} at {t}");
    }
}

/// A crate that ends on its right side bears alike on both feet, one of which rings by a little more than the other.
#[test]
fn two_feet_that_bear_alike_both_have_a_mean_or_neither() {
    let text = r#"
time = { end = "1.3 s", step = "50 us" }
material.steel = { density = "7850 kg/m^3", youngs_modulus = "210 GPa" }
beam.deck = { material = "steel", span = "2 m", width = "10 cm", thickness = "1 cm", elements = 40, supports = ["pinned", "pinned"], damping_ratio = { mode = 1, ratio = 0.02 }, support.mid = { at = "1 m", kind = "pinned" } }
block.crate = { material = "steel", width = "8 cm", height = "12 cm", depth = "8 cm", position = ["55 cm", "16 cm"], angle = "10 deg" }
contact.c = { between = ["crate", "deck"], friction = 0.4, restitution = 0.3 }
"#;
    let run = run("two-feet", text);
    let page = data(&run.html);
    let points = page["forces"]["points"].as_array().unwrap().iter();
    let feet = points.filter(|point| !point["mean"].is_null()).map(|point| point["point"].as_u64().unwrap());
    let names = &page["scenery"]["contacts"][0]["points"];
    let feet: Vec<&str> = feet.map(|point| names[point as usize]["label"].as_str().unwrap()).collect();
    assert_eq!(feet, ["bottom right", "top right"]);
    // The others are drawn as they are, in the same plot, and it says so.
    let told = page["forces"]["unsmoothed"][0][1].as_str().unwrap();
    assert!(told.ends_with(" not smoothed: they press only now and then"), "{told}");
    let svg = figures(&run.page).into_iter().find(|(file, _)| file == "contact_forces.svg").unwrap().1;
    let pale = |colour: &str| {
        svg.matches(&format!(
            "stroke=\"{colour}\" stroke-dasharray=\"none\" stroke-width=\".5\" stroke-opacity=\".35\""
        ))
        .count()
    };
    // The note is broken into lines.
    assert!(["now and then", "press only"].iter().any(|words| svg.contains(words)), "{svg}");
    assert!(pale("#e05206") > 0 && pale("#e05206") == pale("#00a078"), "{} {}", pale("#e05206"), pale("#00a078"));
}

/// Numbers of energies are read as a sum: those of the start, too, which are small beside the largest.
#[test]
fn energies_on_the_page_are_those_of_the_table_to_a_millionth_of_their_range() {
    let run = scenario("drop");
    let table = table(&run.folder.join("energy.csv"));
    let total: Vec<f64> = ["kinetic", "elastic", "gravity"].iter().fold(Vec::new(), |sum, of| {
        let own = &table.iter().find(|(name, _)| name == of).unwrap().1;
        if sum.is_empty() { own.clone() } else { sum.iter().zip(own).map(|(a, b)| a + b).collect() }
    });
    let page = data(&run.html);
    let panel = panel(&page, "energy").unwrap();
    let per_joule = match panel["unit"].as_str().unwrap() {
        "mJ" => 1e3,
        "J" => 1.0,
        other => panic!("{other}"),
    };
    let line = panel["series"].as_array().unwrap().iter().find(|line| line["label"] == "total").unwrap();
    let y = numbers(&line["y"]);
    let (low, high) = y.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), y| (a.min(*y), b.max(*y)));
    assert!(line["y"]["unit"].as_f64().unwrap() <= 1.01e-6 * (high - low), "{}", line["y"]["unit"]);
    let lost = (total[total.len() - 1] - total[0]) * per_joule;
    assert!((y[y.len() - 1] - y[0] - lost).abs() <= 2e-6 * (high - low), "{} {lost}", y[y.len() - 1] - y[0]);
}

/// Blocks that stand apart are drawn from their starts in the portrait of a coordinate, as in its plot: the curves lie over each other.
#[test]
fn a_portrait_of_blocks_that_stand_apart_is_from_their_starts() {
    let text = include_str!("../../../../scenarios/dry-stone-wall.toml");
    let run = run("wall-portrait", text);
    let portrait = &data(&run.html)["portraits"][0].clone();
    assert_eq!(portrait["title"], "Phase portrait: ẋ over x − x₀");
    assert_eq!(portrait["x_label"], "Displacement x − x₀ relative to the ground (cm)");
    let series = portrait["series"].as_array().unwrap();
    assert!(series.len() > 5);
    for line in series {
        let x = numbers(&line["x"]);
        assert!(x[0].abs() < 1e-6 && x.iter().all(|x| x.abs() < 3.0), "{}", line["label"]);
    }
    let (_, figure) = figures(&run.page).into_iter().find(|(file, _)| file == "phase_x.svg").unwrap();
    assert!(figure.contains("Displacement x − x₀ relative to the ground (cm)"));
}

/// A disc on a table that is shaken: each portrait is of the disc, and says so, as the other one could be another block's.
#[test]
fn what_is_prescribed_has_no_portrait() {
    let text = "[time]\nend = '1 s'\nstep = '1 ms'\n[block.table]\ndensity = '700 kg/m^3'\nwidth = '4 m'\nheight = '40 cm'\ndepth = '30 cm'\n\
        position = ['0 cm', '20 cm']\nmotion = { acceleration = ['2 m/s^2', '0 m/s^2'], angle = '0 deg', signal = 's' }\n[signal.s]\nshape = 'harmonic'\n\
        frequency = '2 Hz'\n[block.disc]\ndensity = '700 kg/m^3'\nradius = '5 cm'\ndepth = '5 cm'\non = 'table'\nat = '0 cm'\n\
        [contact.c]\nbetween = ['disc', 'table']\nfriction = 0.4\n";
    let page = data(&run("portraits-on-table", text).html);
    let titles = page["portraits"].as_array().unwrap().iter().map(|portrait| portrait["title"].as_str().unwrap());
    let titles: Vec<&str> = titles.collect();
    assert_eq!(titles, ["Phase portrait of disc: ω over φ"]);
}
