//! The page and the figures of real runs: what they hold, what they must not hold, how large they are.

use crate::network::unpacked;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::LazyLock;
use teeter_integrator::{Observer, State};
use teeter_report::{EndedWord, PageRecorder, Recorder, Results, Summary, figures, half_cycles, render};
use teeter_scenario::simulation::Simulation;

pub(crate) struct Run {
    pub(crate) page: PageRecorder,
    pub(crate) summary: Summary,
    pub(crate) html: String,
    pub(crate) folder: std::path::PathBuf,
}

/// Runs a scene, and leaves its page and figures where they can be looked at.
pub(crate) fn run(name: &str, text: &str) -> Run {
    run_from(name, text, None).0
}

/// The same, from the state of another run if there is one; with the state at the end.
pub(crate) fn run_from(name: &str, text: &str, from: Option<State>) -> (Run, State) {
    let resolved = teeter_scenario::load(text.as_bytes(), name, name, &[]).unwrap();
    let mut simulation = Simulation::new(&resolved.scene).unwrap();
    simulation.state = from.unwrap_or(simulation.state);
    let layout = simulation.layout.clone();
    // By process: a runner that gives each test its own would have them write over one another.
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("page-{}", std::process::id())).join(name);
    let results = Results::create(&folder, true).unwrap();
    let mut tell = |_: &str| {};
    let mut recorder = Recorder::new(&results, &resolved.scene, &layout, &mut tell).unwrap();
    recorder.note(&resolved.warnings);
    let mut page = PageRecorder::new(&resolved.scene, &layout);
    let mut observers: [&mut dyn Observer<2>; 2] = [&mut recorder, &mut page];
    let ended = simulation.run(&mut observers).unwrap();
    let record = recorder.into_record();
    let summary = Summary::new(&resolved.scene, &layout, &simulation.state, &record, EndedWord::from(&ended), 0.25);
    let html = render(&page, &summary, &resolved.document.to_toml());
    fs::write(folder.join("report.html"), &html).unwrap();
    for (file, svg) in figures(&page) {
        fs::write(folder.join(file), svg).unwrap();
    }
    (Run { page, summary, html, folder }, simulation.state)
}

/// Each scenario runs once, for all tests: they read the same folder.
static RUNS: LazyLock<BTreeMap<&str, Run>> = LazyLock::new(|| {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios");
    let text = |name| fs::read_to_string(folder.join(format!("{name}.toml"))).unwrap();
    SCENARIOS.into_iter().map(|name| (name, run(name, &text(name)))).collect()
});

pub(crate) fn scenario(name: &str) -> &'static Run {
    &RUNS[name]
}

pub(crate) const SCENARIOS: [&str; 5] =
    ["free-rocking-on-beam", "free-rocking-on-beam-undeformed-start", "free-rocking-on-ground", "drop", "sliding"];

pub(crate) fn data(html: &str) -> Value {
    let start = html.find("id=\"data\">").unwrap() + "id=\"data\">".len();
    let text = &html[start..start + html[start..].find("</script>").unwrap()];
    serde_json::from_str(text).unwrap()
}

pub(crate) fn numbers(value: &Value) -> Vec<f64> {
    if let Some(all) = value.as_array() {
        return all.iter().map(|x| x.as_f64().unwrap_or(f64::NAN)).collect();
    }
    let (unit, second) = (value["unit"].as_f64().unwrap(), value["order"] == 2);
    let mut before = [0_i64; 2];
    let number = |n: u64| {
        let Some(n) = n.checked_sub(1) else { return f64::NAN };
        let difference = if n % 2 == 1 { -((n / 2) as i64) - 1 } else { (n / 2) as i64 };
        let now = difference + if second { 2 * before[1] - before[0] } else { before[1] };
        before = [before[1], now];
        now as f64 * unit
    };
    unpacked(value["packed"].as_str().unwrap()).into_iter().map(number).collect()
}

/// The plot over time of this name.
pub(crate) fn panel<'d>(data: &'d Value, id: &str) -> Option<&'d Value> {
    data["panels"].as_array().unwrap().iter().find(|panel| panel["id"] == id)
}

/// The value of `[data-summary="path"]`.
pub(crate) fn shown<'a>(html: &'a str, path: &str) -> &'a str {
    let mark = format!("data-summary=\"{path}\" data-value=\"");
    let start = html.find(&mark).unwrap_or_else(|| panic!("{path}")) + mark.len();
    html[start..].split('"').next().unwrap()
}

/// Tags that open and close in order, attributes in quotes: all that XML asks of files like ours.
pub(crate) fn assert_well_formed(name: &str, svg: &str) {
    let mut open: Vec<&str> = Vec::new();
    for piece in svg.split('<').skip(1) {
        let (tag, text) = piece.split_once('>').unwrap_or_else(|| panic!("{name}: no end of <{piece}"));
        assert!(!text.contains('>'), "{name}: {text}");
        assert!(text.split('&').skip(1).all(|rest| rest.contains(';')), "{name}: {text}");
        assert!(tag.matches('"').count() % 2 == 0, "{name}: {tag}");
        if let Some(end) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(end), "{name}");
        } else if !tag.ends_with('/') {
            open.push(tag.split([' ', '\n']).next().unwrap());
        }
    }
    assert!(open.is_empty(), "{name}: {open:?}");
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name}");
}

/// A bar is the largest of its stretch, and a point that stays closed while another lands has one, too: rows of `impacts.csv` alone don't make the bars.
#[test]
fn bars_of_impulses_say_what_they_are() {
    let run = scenario("free-rocking-on-ground");
    let forces = &data(&run.html)["forces"];
    let told = forces["struck"].as_str().unwrap();
    assert!(told.starts_with("the largest of every ") && told.contains("impacts.csv leaves out"), "{told}");
    let (_, svg) = figures(&run.page).into_iter().find(|(file, _)| file == "contact_forces.svg").unwrap();
    let words = svg.split('<').filter_map(|tag| tag.split_once('>')).flat_map(|(_, text)| text.split_whitespace());
    let words = words.collect::<Vec<_>>().join(" ");
    assert!(words.contains("also at points that stay closed"), "{words}");
    // Each is one of the rows, or of a point that closes in none.
    let rows: Vec<f64> = run.summary.impacts.iter().map(|row| row.impulse_n).collect();
    for point in forces["points"].as_array().unwrap() {
        for bar in numbers(&point["impacts"]).into_iter().filter(|bar| *bar > 0.0) {
            assert!(rows.iter().any(|row| (row - bar).abs() < 1e-4 * row), "{bar} of {rows:?}");
        }
    }
}

#[test]
fn pages_are_small_and_load_nothing() {
    for name in SCENARIOS {
        let html = &scenario(name).html;
        assert!(html.len() < 1_200_000, "{name}: {} bytes", html.len());
        for load in ["src=", "href=", "@import", "fetch(", "XMLHttpRequest", "import("] {
            assert!(!html.contains(load), "{name}: {load}");
        }
        assert_eq!(html.matches("url(").count(), html.matches("url(#").count(), "{name}: only its own marks and clips");
        let outside = html.matches("http").count();
        let namespaces = html.matches("http://www.w3.org/2000/svg").count() + html.matches("http-equiv").count();
        // The scene's own comments are not in `scene.toml`, so no address of a user's is either.
        assert_eq!(outside, namespaces, "{name}");
    }
}

#[test]
fn the_page_shows_the_numbers_of_the_summary() {
    for name in SCENARIOS {
        let run = scenario(name);
        let json = run.summary.to_json().unwrap();
        for path in [
            "impact_count",
            "reclosure_count",
            "max_penetration",
            "energy.largest_residual",
            "energy.final",
            "energy.positive_contact_work.sum",
            "contact.unconverged_steps",
            "contact.max_iterations",
            "steps",
            "dt",
        ] {
            let line = format!("\"{}\": {}", path.rsplit('.').next().unwrap(), shown(&run.html, path));
            assert!(json.lines().any(|l| l.trim().trim_end_matches(',') == line), "{name}: {line}");
        }
        assert_eq!(shown(&run.html, "ended"), "complete");
        for clocked in ["wall_seconds", "us_per_step"] {
            assert!(!run.html.contains(clocked), "the same run must give the same page");
        }
    }
}

#[test]
fn the_picture_is_where_the_trajectory_is() {
    let run = scenario("free-rocking-on-beam");
    let frames = &data(&run.html)["frames"];
    let (t, block) = (numbers(&frames["t"]), &frames["blocks"][0]);
    let (x, y, phi) = (numbers(&block["x"]), numbers(&block["y"]), numbers(&block["phi"]));
    assert_eq!((t[0], *t.last().unwrap()), (0.0, 0.5));
    let mut compared = 0;
    for line in fs::read_to_string(run.folder.join("trajectory.csv")).unwrap().lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|x| x.parse().unwrap()).collect();
        let Some(i) = t.iter().position(|t| (t - row[0]).abs() < 1e-9) else { continue };
        for (column, written) in [&x, &y, &phi].into_iter().zip(&row[1..4]) {
            // To half of the step in which the page has them, a millionth of their range.
            let shown = column[i];
            assert!((shown - written).abs() <= 0.51e-6 * range(column), "{shown} {written} at {}", t[i]);
        }
        compared += 1;
    }
    assert!(compared > 100, "{compared}");
}

fn range(values: &[f64]) -> f64 {
    let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(*x), b.max(*x)));
    high - low
}

#[test]
fn the_curves_miss_no_peak_and_the_forces_no_impulse() {
    let run = scenario("free-rocking-on-ground");
    let data = data(&run.html);
    let phi: Vec<f64> =
        numbers(&panel(&data, "phi").unwrap()["series"][0]["y"]).iter().map(|phi| phi.to_radians()).collect();
    for peak in &run.summary.peaks {
        // To half of the step in which the page has a curve, a hundred-thousandth of its range.
        assert!(phi.iter().any(|shown| (shown - peak.phi).abs() <= 0.51e-5 * range(&phi)), "{peak:?}");
    }
    assert_eq!(data["impacts"].as_array().unwrap().len(), run.summary.impacts.len());
    // Gravity takes m g t from the momentum, the contacts give it back: at t = 1 s the block is nearly at rest again.
    let borders = numbers(&data["forces"]["borders"]);
    let impulse: f64 = data["forces"]["points"].as_array().unwrap().iter().fold(0.0, |sum, point| {
        let forces = numbers(&point["normal"]);
        sum + forces.iter().zip(borders.windows(2)).map(|(f, ends)| f * (ends[1] - ends[0])).sum::<f64>()
    });
    // Impacts have impulses of their own.
    let impacts: f64 = run.summary.impacts.iter().map(|impact| impact.impulse_n).sum();
    let shown = data["forces"]["points"].as_array().unwrap().iter().flat_map(|point| numbers(&point["impacts"]));
    let [_, factor] = data["forces"]["impulse_units"][0].as_array().unwrap().as_slice() else { panic!("{data}") };
    assert!(factor.as_f64().is_some());
    let shown: f64 = shown.sum();
    // What the other foot gets of an impact is shown, too: next to nothing, as it lifts.
    assert!(impacts > 0.0 && (0.999..1.02).contains(&(shown / impacts)), "{shown} N s against {impacts}");
    let impulse = impulse + shown;
    let weight = 2700.0 * 0.03 * 0.135 * 0.03 * 9.81;
    assert!((impulse / weight - 1.0).abs() < 0.02, "{impulse} N s against {weight} N for 1 s");
}

#[test]
fn on_rigid_ground_the_table_has_housners_ratio() {
    let run = scenario("free-rocking-on-ground");
    let cycles = half_cycles(&run.page, &run.summary);
    assert_eq!(cycles.len(), run.summary.crossings.len());
    for cycle in &cycles {
        let ratio = cycle.ratio().unwrap();
        // The step of the impact holds a step of gravity, too: p² α dt = 23 rad/s² · 1e-4 s of 1.2 to 1.8 rad/s.
        assert!((ratio - cycle.housner.unwrap()).abs() < 2e-3, "{ratio} against {:?} at {}", cycle.housner, cycle.t);
    }
    assert!(cycles[0].decay().unwrap() < 1.0);
    assert!(cycles.last().unwrap().decay().is_none(), "the last swing is not complete");
}

#[test]
fn figures_are_those_of_the_scene_and_well_formed() {
    for name in SCENARIOS {
        let run = scenario(name);
        let figures = figures(&run.page);
        let names: Vec<&str> = figures.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names.contains(&"w_mid.svg"), name.contains("beam"), "{name}");
        let moves: &[&str] = match name {
            "drop" => &["y.svg", "vy.svg", "phase_y.svg"],
            "sliding" => &["x.svg", "vx.svg", "phase_x.svg", "slip.svg"],
            _ => &["phi.svg", "omega.svg", "x.svg", "y.svg", "phase.svg"],
        };
        for file in ["phi.svg", "x.svg", "y.svg", "phase.svg"] {
            assert_eq!(names.contains(&file), moves.contains(&file), "{name}: {file}");
        }
        for expected in moves.iter().chain(&["contact_forces.svg", "energy.svg"]) {
            assert!(names.contains(expected), "{name}: {expected}");
        }
        for (file, svg) in &figures {
            assert_well_formed(&format!("{name}/{file}"), svg);
            assert!(svg.len() < 1_000_000, "{name}/{file}: {} bytes", svg.len());
        }
    }
}

const WOOD: &str =
    "[time]\nend = \"END\"\nstep = \"1 ms\"\n[material.wood]\ndensity = \"600 kg/m^3\"\nyoungs_modulus = \"10 GPa\"\n";

fn wood(end: &str, rest: &str) -> String {
    WOOD.replace("END", end) + rest
}

#[test]
fn scenes_without_contact_or_with_hostile_names_have_a_page() {
    let falling = "[block.stone]\nmaterial = \"wood\"\nwidth = \"1 m\"\nheight = \"1 m\"\ndepth = \"1 m\"\n\
        position = [\"0 m\", \"9 m\"]\nspin = \"2 rad/s\"\n";
    let title = "title = \"</script><script>alert(1)</script> {{data}} & \\\"co\\\"\"\n";
    let run = run("no-contact", &format!("{title}{}", wood("1 s", falling)));
    assert!(!run.html.contains("<script>alert"));
    assert!(data(&run.html)["forces"]["points"].as_array().unwrap().is_empty());
    let figures = figures(&run.page);
    assert!(figures.iter().all(|(file, _)| file != "contact_forces.svg" && file != "w_mid.svg"));
    figures.iter().for_each(|(file, svg)| assert_well_formed(file, svg));
}

#[test]
fn scenes_with_many_blocks_and_long_runs_stay_small() {
    let mut scene = wood("30 s", "[ground]\n");
    scene.push_str("[beam.plank]\nmaterial = \"wood\"\nspan = \"2 m\"\nwidth = \"10 cm\"\nthickness = \"2 cm\"\n");
    scene.push_str("elements = 8\nsupports = [\"clamped\", \"free\"]\nposition = [\"5 m\", \"1 m\"]\n");
    for k in 0..12 {
        let (x, y) = (0.4 * f64::from(k), 0.3 + 0.1 * f64::from(k));
        scene.push_str(&format!(
            "[block.b{k}]\nmaterial = \"wood\"\nwidth = \"10 cm\"\nheight = \"20 cm\"\ndepth = \"10 cm\"\n\
             position = [\"{x} m\", \"{y} m\"]\nangle = \"{k} deg\"\n\
             [contact.c{k}]\nbetween = [\"b{k}\", \"ground\"]\nfriction = 0.4\nrestitution = 0.5\n"
        ));
    }
    let run = run("many-blocks", &scene);
    assert!(run.html.len() < 5_000_000, "{} bytes", run.html.len());
    assert_eq!(data(&run.html)["scenery"]["beams"][0]["supports"][0], "clamped");
    figures(&run.page).iter().for_each(|(file, svg)| assert_well_formed(file, svg));
}

#[test]
fn the_page_of_ten_bodies_stays_small() {
    // 4000 steps fill what the page has room for.
    let mut scene = wood("0.8 s", "[ground]\n").replace("1 ms", "0.2 ms");
    for k in 0..10 {
        let (x, y) = (0.3 * f64::from(k), 0.3 + 0.05 * f64::from(k));
        scene.push_str(&format!(
            "[block.b{k}]\nmaterial = \"wood\"\nwidth = \"10 cm\"\nheight = \"20 cm\"\ndepth = \"10 cm\"\n\
             position = [\"{x} m\", \"{y} m\"]\nangle = \"{k} deg\"\n"
        ));
    }
    scene.push_str("[contact.floor]\nbetween = [\"*\", \"ground\"]\nfriction = 0.4\nrestitution = 0.5\n");
    let size = run("ten-blocks", &scene).html.len();
    assert!((250_000..600_000).contains(&size), "{size} bytes");
}

#[test]
fn a_scene_without_blocks_has_a_page() {
    let beam =
        "[beam.plank]\nmaterial = \"wood\"\nspan = \"2 m\"\nwidth = \"10 cm\"\nthickness = \"2 cm\"\nelements = 3\n";
    let run = run("no-blocks", &wood("20 ms", beam));
    assert!(data(&run.html)["scenery"]["blocks"].as_array().unwrap().is_empty());
    let names: Vec<String> = figures(&run.page).into_iter().map(|(file, _)| file).collect();
    assert!(names.is_empty(), "a beam that nothing bends: {names:?}");
    assert!(run.html.contains("w at midspan, 100\u{a0}cm (0); energy: kinetic, elastic, gravity, total (0)"));
}

#[test]
fn what_moves_is_drawn_where_it_is() {
    let scene = "[time]\nend = '0.2 s'\nstep = '1 ms'\n\
        [ground]\nincline = '5 deg'\nmotion = { velocity = ['1 m/s', '0 m/s'], angular_velocity = '0.5 rad/s' }\n\
        [material.m]\ndensity = '600 kg/m^3'\nyoungs_modulus = '10 GPa'\n\
        [beam.still]\nmaterial = 'm'\nspan = '1 m'\nwidth = '5 cm'\nthickness = '2 cm'\nelements = 4\n\
        [beam.shaken]\nmaterial = 'm'\nspan = '1 m'\nwidth = '5 cm'\nthickness = '2 cm'\nelements = 4\n\
        motion = { displacement = ['0.3 m', '0.2 m'], signal = 'slow' }\n\
        [signal.slow]\nshape = 'ramp'\nduration = '0.1 s'\n";
    let run = run("moving", scene);
    let page = data(&run.html);
    let last = |value: &Value| *numbers(value).last().unwrap();
    assert!(page["frames"]["beams"][0].get("moved").is_none());
    let moved = &page["frames"]["beams"][1]["moved"];
    // The velocity of the ramp jumps twice: half a step of it is lost.
    assert!((last(&moved[0]) - 0.3).abs() < 2e-3 && (last(&moved[1]) - 0.2).abs() < 2e-3, "{moved}");
    let ground = &page["frames"]["ground"];
    assert!((last(&ground["x"]) - 0.2).abs() < 1e-6 && last(&ground["y"]) == 0.0);
    assert!((last(&ground["slope"]) - 5_f64.to_radians() - 0.1).abs() < 1e-6);
    let still = data(&scenario("sliding").html);
    assert!(still["frames"]["ground"].is_null() && still["scenery"]["incline"] == 0.0);
}
