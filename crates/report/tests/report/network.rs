//! The network of contact forces and the line of thrust, against tables and against statics.

use crate::page::{Run, assert_well_formed, data, numbers, run};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fs;
use std::path::Path;
use teeter_report::{ThrustLine, figures, thrust_lines};
use teeter_scenario::scene::Scene;

/// A semicircular arch of voussoirs from 0.925 m to 1.075 m, as made by the generator of scenes.
fn arch(count: usize, end: &str) -> String {
    let angle = 180.0 / count as f64;
    format!(
        "[time]\nend = '{end}'\nstep = '1 ms'\n[ground]\n[material.stone]\ndensity = '2400 kg/m^3'\n\
         [block.v]\nmaterial = 'stone'\ndepth = '30 cm'\ncentre = ['0 m', '0 m']\n\
         shape = {{ kind = 'voussoir', inner = '0.925 m', outer = '1.075 m', from = '0 deg', to = '{angle:.14} deg' }}\n\
         repeat = {{ count = {count}, turn = '{angle:.14} deg' }}\n\
         [contact.joints]\nbetween = ['v-*', 'v-*']\nfriction = 0.6\n\
         [contact.ground]\nbetween = ['v-*', 'ground']\nfriction = 0.6\n[output]\nevery = '1 ms'\n"
    )
}

/// The numbers of packed text: base64, then seven bits a byte, lowest first.
pub(crate) fn unpacked(text: &str) -> Vec<u64> {
    let digit = |c: u8| match c {
        b'A'..=b'Z' => c - b'A',
        b'a'..=b'z' => c - b'a' + 26,
        b'0'..=b'9' => c - b'0' + 52,
        b'+' => 62,
        _ => 63,
    };
    let mut bytes = Vec::new();
    for four in text.as_bytes().chunks(4) {
        let bits = four.iter().fold(0_u32, |bits, &c| bits << 6 | if c == b'=' { 0 } else { u32::from(digit(c)) });
        let padding = four.iter().filter(|c| **c == b'=').count();
        bytes.extend_from_slice(&bits.to_be_bytes()[1..4 - padding]);
    }
    let (mut numbers, mut now, mut shift) = (Vec::new(), 0, 0);
    for byte in bytes {
        now |= u64::from(byte & 0x7f) << shift;
        shift += 7;
        if byte < 0x80 {
            numbers.push(now);
            (now, shift) = (0, 0);
        }
    }
    numbers
}

fn signed(x: u64) -> i64 {
    (x >> 1) as i64 ^ -((x & 1) as i64)
}

#[test]
fn the_network_has_the_impulses_of_contacts_csv() {
    let run = run("arch-network", &arch(9, "60 ms"));
    let page = data(&run.html);
    let (t, network) = (numbers(&page["frames"]["t"]), &page["network"]);
    let largest = numbers(&network["largest"]);
    let names: Vec<&str> =
        page["scenery"]["blocks"].as_array().unwrap().iter().map(|block| block["name"].as_str().unwrap()).collect();
    // Impulses of each pair by the time of the row: joints and feet don't turn, so those of a pair's points add up.
    let mut written: BTreeMap<(String, String, u64), [f64; 2]> = BTreeMap::new();
    for line in fs::read_to_string(run.folder.join("contacts.csv")).unwrap().lines().skip(1) {
        let row: Vec<&str> = line.split(',').collect();
        let step = (row[0].parse::<f64>().unwrap() * 1e3).round() as u64;
        let sum = written.entry((row[2].to_owned(), row[3].to_owned(), step)).or_default();
        for k in 0..2 {
            sum[k] += row[6 + k].parse::<f64>().unwrap();
        }
    }
    let mut compared = 0;
    for (picture, links) in network["links"].as_array().unwrap().iter().enumerate().skip(1) {
        let step = (t[picture] * 1e3).round() as u64;
        let mut pair = 0;
        for link in unpacked(links.as_str().unwrap()).chunks(4) {
            pair += link[0] as usize / 4;
            let shown = link[1] as f64 / 4095.0 * largest[picture];
            let bodies = network["pairs"][pair].as_array().unwrap();
            let first = names[bodies[0].as_u64().unwrap() as usize];
            let other = bodies[1].as_i64().unwrap();
            let second = usize::try_from(other).map_or("ground", |other| names[other]);
            let p = written[&(first.to_owned(), second.to_owned(), step)];
            let force = p[0].hypot(p[1]) / (t[picture] - t[picture - 1]);
            // Forces are sent in 4095ths of the largest.
            assert!((shown - force).abs() <= 0.51 / 4095.0 * largest[picture], "{shown} {force} at step {step}");
            compared += 1;
        }
    }
    assert!(compared >= 59 * 10, "nine voussoirs have ten joints: {compared}");
}

fn scene(text: &str) -> Scene {
    teeter_scenario::load(text.as_bytes(), "arch", "arch", &[]).unwrap().scene
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn only_line(run: &Run) -> ThrustLine {
    let mut lines = thrust_lines(&run.page);
    assert_eq!(lines.len(), 1, "{lines:?}");
    lines.remove(0)
}

#[test]
fn the_line_of_thrust_is_that_of_statics() {
    for count in [3, 15, 28] {
        let text = arch(count, "0.5 s");
        let (run, scene) = (run(&format!("arch-{count}"), &text), scene(&text));
        let line = only_line(&run);
        assert_eq!((line.blocks.len(), line.joints.len()), (count, count + 1));
        assert_eq!((line.joints[0].between[0].as_str(), line.joints[count].between[1].as_str()), ("ground", "ground"));
        let weight = -scene.gravity[1] * scene.blocks[0].mass();
        let scale = weight * count as f64;
        for (k, joints) in line.joints.windows(2).enumerate() {
            // The forces of the two joints of a voussoir carry its weight.
            let sum = [joints[0].force[0] - joints[1].force[0], joints[0].force[1] - joints[1].force[1] - weight];
            assert!(sum[0].hypot(sum[1]) <= 1e-8 * scale, "{count}: voussoir {k}: {sum:?} N of {scale} N");
        }
        for joint in &line.joints {
            let (e, depth) = (joint.eccentricity.unwrap(), joint.depth.unwrap());
            assert!(e.abs() <= 0.5 * depth * (1.0 + 1e-9), "the resultant stays in the joint: {joint:?}");
            assert!((depth - 0.15).abs() < 1e-6, "{joint:?}");
            let [normal, shear] = joint.normal_and_shear.unwrap();
            assert!(normal > 0.0 && shear.abs() <= 0.6 * normal * (1.0 + 1e-9), "{joint:?}");
        }
        half_arch_by_statics(&line, count, weight);
    }
}

/// The line from the force in the first joint alone: what a chain of weights asks of each further joint, whose line of
/// action is cut with the joint's plane, a ray from the arch's centre.
fn half_arch_by_statics(line: &ThrustLine, count: usize, weight: f64) {
    let first = &line.joints[0];
    let (inner, outer) = (0.925_f64, 1.075_f64);
    let angle = PI / count as f64;
    // Of the polygon with two corners on either circle: the centroid's distance from the arch's centre, from the two
    // trapezoid halves.
    let (a, b) = (2.0 * inner * (0.5 * angle).sin(), 2.0 * outer * (0.5 * angle).sin());
    let height = (outer - inner) * (0.5 * angle).cos();
    let centroid = inner * (0.5 * angle).cos() + height / 3.0 * (a + 2.0 * b) / (a + b);
    let (mut force, mut moment) = (first.force, cross(first.at, first.force));
    for (k, joint) in line.joints.iter().enumerate().skip(1) {
        // From the left springer on.
        let middle = PI - angle * (k as f64 - 0.5);
        force[1] -= weight;
        moment -= centroid * middle.cos() * weight;
        let ray = PI - angle * k as f64;
        let out = [ray.cos(), ray.sin()];
        // r out × F = M.
        let r = moment / cross(out, force);
        let there = [r * out[0], r * out[1]];
        let off = (there[0] - joint.at[0]).hypot(there[1] - joint.at[1]);
        assert!(off < 1e-6, "{count}: joint {k} is {off} m from {there:?}");
        let e = r - 0.5 * (inner + outer);
        assert!((e - joint.eccentricity.unwrap()).abs() < 1e-6, "{count}: joint {k}: {e} against {joint:?}");
    }
}

#[test]
fn a_figure_of_many_blocks_is_as_smooth_as_the_motion() {
    let shaken = arch(28, "0.6 s").replace(
        "[ground]\n",
        "[ground]\nmotion = { acceleration = ['0.5 m/s^2', '0 m/s^2'], signal = 'shake' }\n\
         [signal.shake]\nshape = 'one-sine'\nstart = '0.1 s'\nperiod = '0.2 s'\n",
    );
    let run = run("shaken-arch", &shaken);
    let (_, svg) = figures(&run.page).into_iter().find(|(file, _)| file == "ground_a.svg").unwrap();
    let longest = svg.split("<path d=\"").map(|path| path.split('"').next().unwrap().matches('L').count()).max();
    // The page, which has to stay small, has some dozens of points.
    assert!(longest.unwrap() > 200, "{longest:?}");
}

#[test]
fn there_is_no_line_of_thrust_through_a_lintel_on_its_posts() {
    let block = |name: &str, width: &str, height: &str, place: &str| {
        format!(
            "[block.{name}]\nmaterial = 'stone'\nwidth = '{width}'\nheight = '{height}'\ndepth = '40 cm'\n{place}\n"
        )
    };
    let text = format!(
        "[time]\nend = '20 ms'\nstep = '1 ms'\n[ground]\n[material.stone]\ndensity = '2500 kg/m^3'\n{}{}{}\
         [contact.joints]\nbetween = ['lintel', '*t']\nfriction = 0.6\n[contact.ground]\nbetween = ['*t', 'ground']\nfriction = 0.6\n",
        block("left", "40 cm", "1.8 m", "on = 'ground'\nat = '-1 m'"),
        block("right", "40 cm", "1.8 m", "on = 'ground'\nat = '1 m'"),
        block("lintel", "2.6 m", "40 cm", "position = ['0 m', '2 m']"),
    );
    let portal = run("portal", &text);
    assert!(thrust_lines(&portal.page).is_empty());
    let files: Vec<String> = figures(&portal.page).into_iter().map(|(file, _)| file).collect();
    assert!(files.iter().any(|file| file == "force_chains.svg") && files.iter().all(|file| file != "thrust_line.svg"));
}

#[test]
fn chains_are_found_by_what_touches_not_by_names() {
    let scenarios = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios");
    let text = |name: &str| fs::read_to_string(scenarios.join(format!("{name}.toml"))).unwrap();
    let arch = run("masonry-arch", &text("masonry-arch").replace("end  = \"1 s\"", "end  = \"0.1 s\""));
    assert_eq!(only_line(&arch).blocks.len(), 15);
    let files: Vec<String> = figures(&arch.page).into_iter().map(|(file, _)| file).collect();
    for file in ["force_chains.svg", "thrust_line.svg", "eccentricity.svg"] {
        assert!(files.iter().any(|known| known == file), "{file}");
    }
    for (file, svg) in figures(&arch.page) {
        assert_well_formed(&file, &svg);
        assert!(file != "eccentricity.svg" || svg.contains(">line of thrust<"), "the curve has a name, too");
    }
    // In a wall each stone touches several: no chain.
    let wall = run("wall", &text("dry-stone-wall").replace("end  = \"2 s\"", "end  = \"50 ms\""));
    assert!(thrust_lines(&wall.page).is_empty());
    let files: Vec<String> = figures(&wall.page).into_iter().map(|(file, _)| file).collect();
    assert!(files.iter().any(|file| file == "force_chains.svg") && files.iter().all(|file| file != "thrust_line.svg"));
    assert!(data(&wall.html)["network"]["pairs"].as_array().unwrap().len() > 20);
}

#[test]
fn blocks_that_contacts_do_not_link_have_no_force_chains() {
    let scene = |places: &[[&str; 2]]| {
        let mut text = String::from(
            "[time]\nend = '20 ms'\nstep = '1 ms'\n[ground]\n[material.stone]\ndensity = '2400 kg/m^3'\n\
             [contact.floor]\nbetween = ['*', 'ground']\nfriction = 0.5\n[contact.stones]\nbetween = ['*', '*']\nfriction = 0.4\n",
        );
        for (number, [x, y]) in places.iter().enumerate() {
            text += &format!(
                "[block.b{number}]\nmaterial = 'stone'\nwidth = '10 cm'\nheight = '10 cm'\ndepth = '10 cm'\nposition = ['{x}', '{y}']\n"
            );
        }
        text
    };
    let drawn = |name: &str, places: &[[&str; 2]]| {
        figures(&run(name, &scene(places)).page).iter().any(|(file, _)| file == "force_chains.svg")
    };
    let column = [["0 m", "5 cm"], ["0 m", "15 cm"], ["0 m", "25 cm"]];
    assert!(drawn("column", &column));
    assert!(!drawn("two", &column[..2]) && !drawn("beside", &[["0 m", "5 cm"], ["0.2 m", "5 cm"], ["0.4 m", "5 cm"]]));
}

#[test]
fn many_bodies_have_bands_and_the_few_that_go_furthest() {
    let mut text = String::from(
        "[time]\nend = '0.3 s'\nstep = '1 ms'\n[ground]\n[material.stone]\ndensity = '2400 kg/m^3'\n\
         [contact.floor]\nbetween = ['*', 'ground']\nfriction = 0.5\n[contact.stones]\nbetween = ['*', '*']\nfriction = 0.4\n",
    );
    for row in 0..25 {
        // All stand but for the last one, which falls from the right end.
        let y = if row == 24 { "0.55 m" } else { "5 cm" };
        text += &format!(
            "[block.b{row}]\nmaterial = 'stone'\nwidth = '10 cm'\nheight = '10 cm'\ndepth = '10 cm'\nposition = ['{} m', '{y}']\n",
            0.2 * f64::from(row)
        );
    }
    let run = run("many-bands", &text);
    let page = data(&run.html);
    assert!(run.html.len() < 1_200_000, "{} bytes", run.html.len());
    let crowd = &page["crowd"];
    assert_eq!(crowd["distances"]["chosen"][0], 24, "the block that falls goes furthest");
    let fallen = numbers(&crowd["distances"]["values"][0]);
    assert!((fallen[fallen.len() - 1] - 0.44).abs() < 0.07, "{fallen:?}");
    let bands = crowd["distances"]["bands"].as_array().unwrap();
    assert_eq!(numbers(&bands[4]), fallen);
    assert!(numbers(&bands[3]).iter().all(|x| *x < 1e-6), "nine of ten stand");
    // Poses are sent as differences, in steps finer than a picture shows.
    let packed = &page["frames"]["packed"];
    let (length, pictures) = (packed["length"].as_f64().unwrap(), numbers(&page["frames"]["t"]).len());
    let steps = unpacked(packed["blocks"][24].as_str().unwrap());
    assert_eq!(steps.len(), 3 * pictures);
    let y: i64 = steps[pictures..2 * pictures].iter().map(|x| signed(*x)).sum();
    let end = 0.55 - fallen[fallen.len() - 1];
    assert!((y as f64 * length - end).abs() < length, "{} m against {end} m", y as f64 * length);
    let names: Vec<String> = figures(&run.page).into_iter().map(|(file, _)| file).collect();
    assert!(
        names.iter().any(|file| file == "displacement.svg") && names.iter().all(|file| file != "phase.svg"),
        "{names:?}"
    );
}

#[test]
fn the_page_says_that_it_hides_contact_forces() {
    // 40 blocks of which each may touch each other, too many pairs to list: only those with the ground are.
    let crowded = data(&run("hidden", &arch(40, "5 ms")).html);
    assert_eq!((&crowded["scenery"]["hidden_points"], &crowded["scenery"]["unlisted"]), (&0.into(), &true.into()));
    assert!(crowded["scenery"]["contacts"].as_array().unwrap().iter().all(|contact| contact["surface"] == "ground"));
    assert!(!crowded["network"]["pairs"].as_array().unwrap().is_empty());
    // 600 blocks on ground with four corners each.
    let stones = "[time]\nend = '5 ms'\nstep = '1 ms'\n[ground]\n[material.stone]\ndensity = '2400 kg/m^3'\n\
        [block.b]\nmaterial = 'stone'\nwidth = '10 cm'\nheight = '10 cm'\ndepth = '10 cm'\nposition = ['0 m', '5 cm']\n\
        repeat = { count = 600, shift = ['20 cm', '0 cm'] }\n[contact.floor]\nbetween = ['*', 'ground']\nfriction = 0.5\n";
    let page = data(&run("hidden-points", stones).html);
    assert_eq!(page["scenery"]["hidden_points"], 2400);
    assert_eq!(page["forces"]["points"].as_array().unwrap().len(), 0);
    assert!(!page["network"]["pairs"].as_array().unwrap().is_empty(), "the network shows them");
}

#[test]
fn loads_are_on_the_page_as_they_act() {
    let text = "[time]\nend = '0.1 s'\nstep = '1 ms'\n[material.m]\ndensity = '600 kg/m^3'\nyoungs_modulus = '10 GPa'\n\
        [beam.plank]\nmaterial = 'm'\nspan = '1 m'\nwidth = '5 cm'\nthickness = '2 cm'\nelements = 4\n\
        [load.crane]\non = 'plank'\nforce = '-5 N'\nat = '10 cm'\nspeed = '2 m/s'\n";
    let resolved = teeter_scenario::load(text.as_bytes(), "loads", "loads", &[]);
    let Ok(_) = resolved else { panic!("{:?}", resolved.err()) };
    let load = data(&run("loads", text).html)["loads"][0].clone();
    assert_eq!(
        (load["force"][1].as_f64(), load["speed"].as_f64(), load["span"][0].as_f64()),
        (Some(-5.0), Some(2.0), Some(0.1))
    );
    assert!(numbers(&load["factor"]).iter().all(|x| *x == 1.0));
}

/// A ball that has rolled far off would make the column in the drawings a stump.
#[test]
fn what_is_far_from_the_chain_is_left_out_of_its_drawings() {
    let scene = |ball: &str| {
        format!(
            "[time]\nend = '20 ms'\nstep = '1 ms'\n[ground]\n[block.drum]\ndensity = '2400 kg/m^3'\nwidth = '40 cm'\nheight = '30 cm'\n\
             depth = '40 cm'\nposition = ['0 m', '15 cm']\nrepeat = {{ count = 4, shift = ['0 m', '30 cm'] }}\n[block.ball]\n\
             density = '7800 kg/m^3'\nradius = '6 cm'\ndepth = '20 cm'\nposition = ['{ball}', '6 cm']\n[contact.all]\n\
             between = ['*', '*']\nfriction = 0.7\n"
        )
    };
    let drawn = |name: &str, ball: &str| {
        let figures = teeter_report::figures(&crate::page::run(name, &scene(ball)).page);
        ["thrust_line.svg", "force_chains.svg"]
            .map(|name| figures.iter().find(|(file, _)| file == name).unwrap().1.clone())
    };
    for svg in drawn("ball-far", "8 m") {
        assert!(svg.contains(">ball is farther off</text>"), "{svg}");
        // The column is as high as the drawing: its scale is no longer one of metres.
        assert!(svg.contains(">50 cm</text>") || svg.contains(">20 cm</text>"), "{svg}");
    }
    for svg in drawn("ball-near", "40 cm") {
        assert!(!svg.contains("farther off"), "{svg}");
    }
}
