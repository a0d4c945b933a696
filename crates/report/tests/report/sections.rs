//! What beams bear, in the files of a run: exact where statics is, extremes over all steps, and who asks for nothing gets nothing.

use crate::page::{data, numbers, panel};
use crate::table::{column, columns_of};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use teeter_report::{EndedWord, Results, RunRecorder, Summary, envelopes, figures, render, shortest, with_digits};
use teeter_scenario::simulation::Simulation;

struct Run {
    folder: PathBuf,
    summary: Value,
    html: String,
    figures: Vec<(String, String)>,
    envelopes: Option<String>,
}

fn scenario(name: &str) -> Vec<u8> {
    fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../scenarios/{name}.toml"))).unwrap()
}

fn run(name: &str, sets: &[(&str, &str)]) -> Run {
    run_of(name, &scenario("free-rocking-on-beam"), sets)
}

fn run_of(name: &str, text: &[u8], sets: &[(&str, &str)]) -> Run {
    let sets: Vec<(String, String)> = sets.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
    let resolved = teeter_scenario::load(text, name, name, &sets).unwrap();
    let mut simulation = Simulation::new(&resolved.scene).unwrap();
    let layout = simulation.layout.clone();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("sections-{}", std::process::id())).join(name);
    let results = Results::create(&folder, true).unwrap();
    let mut tell = |_: &str| {};
    let mut recorder = RunRecorder::new(&results, &resolved.scene, &layout, None, None, &mut tell).unwrap();
    let ended = simulation.run(&mut [&mut recorder]).unwrap();
    let (record, page, _) = recorder.into_parts();
    let summary = Summary::new(&resolved.scene, &layout, &simulation.state, &record, EndedWord::from(&ended), 0.25);
    let html = render(&page, &summary, "");
    fs::write(folder.join("report.html"), &html).unwrap();
    Run {
        folder,
        summary: serde_json::to_value(&summary).unwrap(),
        html,
        figures: figures(&page),
        envelopes: envelopes(&layout, &record.beams),
    }
}

const ASKED: [(&str, &str); 6] = [
    ("output.every", "\"100 us\""),
    ("beam.table.probes", "[\"9 cm\", \"18 cm\"]"),
    ("beam.table.record", "[\"moment\", \"w\", \"shear\", \"stress\", \"axial_force\"]"),
    ("beam.table.reactions", "true"),
    ("beam.table.envelope", "true"),
    ("material.aluminium.yield_strength", "\"30 MPa\""),
];

#[test]
fn a_static_start_is_written_as_statics_has_it() {
    let run = run("asked", &[&ASKED[..], &[("time.scheme", "moreau-jean")]].concat());
    let table = columns_of(&fs::read_to_string(run.folder.join("trajectory.csv")).unwrap());
    let names: Vec<&str> =
        table.iter().skip_while(|(name, _)| name != "table.v_mid").map(|(name, _)| name.as_str()).collect();
    assert_eq!(
        names,
        [
            "table.v_mid",
            "table.moment@0.09",
            "table.moment@0.18",
            "table.w@0.09",
            "table.w@0.18",
            "table.shear@0.09",
            "table.shear@0.18",
            "table.stress@0.09",
            "table.stress@0.18",
            "table.axial_force",
            "table.reaction@0",
            "table.reaction_couple@0",
            "table.reaction@0.36",
            "table.reaction_couple@0.36",
        ]
    );
    let first = |name: &str| column(&table, name)[0];
    // The block stands on its left corner, at 0.165.
    let weight = 2700.0 * 0.03 * 0.03 * 0.135 * 9.81;
    let (left, right) = (weight * 0.195 / 0.36, weight * 0.165 / 0.36);
    for (name, exact) in [
        ("table.reaction@0", left),
        ("table.reaction@0.36", right),
        ("table.shear@0.09", left),
        ("table.shear@0.18", -right),
        ("table.moment@0.09", 0.09 * left),
        ("table.moment@0.18", 0.18 * right),
        ("table.stress@0.18", 0.18 * right / (0.03 * 0.0015 * 0.0015 / 6.0)),
    ] {
        // What the contact forces of the static start are solved to.
        assert!((first(name) / exact - 1.0).abs() < 1e-11, "{name}: {} {exact}", first(name));
    }
    assert_eq!(first("table.reaction_couple@0"), 0.0);

    // Every step is a row, so the extremes of the columns are those of the envelope at the nodes that are probes, and of the summary.
    let envelope = columns_of(run.envelopes.as_ref().unwrap());
    let node = |x: f64| column(&envelope, "x").iter().position(|node| (node - x).abs() < 1e-12).unwrap();
    let extreme =
        |name: &str, fold: fn(f64, f64) -> f64, start: f64| column(&table, name).iter().copied().fold(start, fold);
    for (x, place) in [(0.09, "0.09"), (0.18, "0.18")] {
        for (quantity, exact) in [("w", true), ("moment", true), ("shear", false)] {
            let name = format!("table.{quantity}@{place}");
            let (low, high) = (extreme(&name, f64::min, f64::INFINITY), extreme(&name, f64::max, f64::NEG_INFINITY));
            let (least, most) = (
                column(&envelope, &format!("{quantity}_min"))[node(x)],
                column(&envelope, &format!("{quantity}_max"))[node(x)],
            );
            // The envelope has both sides of the node, the probe the right one; a mass between two steps makes V jump by rounding only.
            let room = if exact { 1e-12 } else { 1e-9 };
            assert!((least - low).abs() <= room && (most - high).abs() <= room, "{name}: {least} {low} {most} {high}");
        }
    }
    let support = &run.summary["beams"][0]["reactions"][1];
    assert_eq!(support["force"][1].as_f64().unwrap(), extreme("table.reaction@0.36", f64::max, f64::NEG_INFINITY));
    assert_eq!(support["start"][0].as_f64().unwrap(), first("table.reaction@0.36"));
    let largest = &run.summary["beams"][0]["largest_stress"];
    assert!(largest["stress"].as_f64().unwrap() >= extreme("table.stress@0.18", f64::max, 0.0));
    let part = run.summary["beams"][0]["part_of_yield_strength"].as_f64().unwrap();
    assert!((part - largest["stress"].as_f64().unwrap() / 30e6).abs() < 1e-14 && part > 1.0);
    let warnings = run.summary["warnings"].as_array().unwrap();
    // One, with the largest of all steps.
    let told: Vec<&Value> = warnings.iter().filter(|warning| warning["code"] == "yield").collect();
    let most = run.summary["beams"][0]["largest_stress_with_own_weight"]["stress"].as_f64().unwrap();
    let [warning] = told[..] else { panic!("{warnings:?}") };
    assert!(warning["count"].as_u64().unwrap() > 1);
    let text = warning["text"].as_str().unwrap();
    assert!(text.contains(&format!("up to {} of 30 MPa", with_digits(most, "Pa", 4))), "{most}: {text}");

    let names: Vec<&str> = run.figures.iter().map(|(name, _)| name.as_str()).collect();
    assert!(names.contains(&"section_forces.svg") && names.contains(&"envelopes.svg"), "{names:?}");
    for part in [
        "id=\"reactions\"",
        "id=\"envelopes\"",
        "id=\"stress\"",
        "\"id\":\"section-moment\"",
        "\"id\":\"section-reaction\"",
    ] {
        assert!(run.html.contains(part), "{part}");
    }
}

#[test]
fn a_beam_in_all_its_modes_writes_what_the_elements_write() {
    let sets = [
        ("time.end", "\"20 ms\""),
        ("beam.table.probes", "[\"9 cm\", \"0.18 m\"]"),
        ("beam.table.record", "[\"w\", \"moment\", \"shear\"]"),
        ("beam.table.reactions", "true"),
        ("beam.table.envelope", "true"),
    ];
    let modes = [("beam.table.model", "modes"), ("beam.table.modes", "{ count = 40 }")];
    let (full, reduced) = (run("in-full", &sets), run("in-modes", &[&sets[..], &modes].concat()));
    let read = |run: &Run| columns_of(&fs::read_to_string(run.folder.join("trajectory.csv")).unwrap());
    for (full, reduced) in [
        (read(&full), read(&reduced)),
        (columns_of(full.envelopes.as_ref().unwrap()), columns_of(reduced.envelopes.as_ref().unwrap())),
    ] {
        assert_eq!(full.len(), reduced.len());
        for ((name, full), (_, reduced)) in full.iter().zip(&reduced).filter(|((name, _), _)| name != "beam") {
            let largest = full.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
            for (a, b) in full.iter().zip(reduced).filter(|(a, _)| !a.is_nan()) {
                assert!((a - b).abs() <= 1e-6 * largest.max(1e-6), "{name}: {a} {b}");
            }
        }
    }
    let beam = &reduced.summary["model"]["beams"][0];
    assert_eq!((&beam["dofs"], &beam["backend"]), (&40.into(), &"diagonal".into()));
    assert_eq!(beam["shapes"], serde_json::json!({ "modes": 40, "corrections": 0 }));
    assert!(reduced.html.contains("20 elements in 40 modes, 40 dofs, diagonal"));
}

#[test]
fn who_does_not_ask_gets_what_was_there_before() {
    let run = run("unasked", &[("time.end", "\"20 ms\"")]);
    let header = fs::read_to_string(run.folder.join("trajectory.csv")).unwrap();
    assert!(header.lines().next().unwrap().ends_with(",table.w_mid,table.v_mid"));
    assert_eq!(run.envelopes, None);
    assert_eq!(run.summary.get("beams"), None);
    assert!(!run.html.contains("id=\"reactions\"") && run.figures.iter().all(|(name, _)| name != "envelopes.svg"));
}

#[test]
fn what_leaves_the_model_is_warned_of_in_the_summary() {
    let count = |name: &str, code: &str, sets: &[(&str, &str)]| {
        let run = run(name, sets);
        let warnings = run.summary["warnings"].as_array().unwrap();
        warnings.iter().find(|warning| warning["code"] == code).map_or(0, |warning| warning["count"].as_u64().unwrap())
    };
    let thickness = |thickness| [("beam.table.thickness", thickness), ("time.end", "20 ms"), ("output.every", "1 ms")];
    assert_eq!(count("small", "large-deflection", &thickness("1.5 mm")), 0);
    // In equilibrium already it sags by more than 1/9 of the span.
    assert_eq!(count("large", "large-deflection", &thickness("0.75 mm")), 21);
    let coarse = |step| [("time.scheme", "moreau-jean"), ("time.step", step), ("output.every", step)];
    assert_eq!(count("shallow", "deep-penetration", &coarse("1 ms")), 0);
    assert!(count("deep", "deep-penetration", &coarse("50 ms")) > 0);
}

/// A block that rocks on a beam with two supports more, which ring under it.
const ON_FOUR_SUPPORTS: &str = "[time]\nend = '0.4 s'\nstep = '100 us'\n[material.a]\ndensity = '7850 kg/m^3'\n\
    youngs_modulus = '210 GPa'\n[beam.plank]\nmaterial = 'a'\nspan = '3 m'\nwidth = '10 cm'\nthickness = '2 cm'\nelements = 24\n\
    supports = ['pinned', 'clamped']\nself_weight = true\nstart = 'static'\nprobes = ['50 cm']\nrecord = ['shear', 'stress']\n\
    reactions = true\nsupport.a = { at = '1 m', spring = '5 MN/m' }\nsupport.b = { at = '2 m', spring = '5 MN/m' }\n\
    [block.b]\nmaterial = 'a'\nwidth = '10 cm'\nheight = '15 cm'\ndepth = '10 cm'\non = 'plank'\nat = '1.4 m'\ntilt = '4 deg'\n\
    [contact.feet]\nbetween = ['b', 'plank']\nfriction = 0.5\n";

#[test]
fn reactions_that_ring_are_pale_behind_their_means() {
    let run = run_of("four-supports", ON_FOUR_SUPPORTS.as_bytes(), &[]);
    let page = data(&run.html);
    let reactions = panel(&page, "section-reaction").unwrap();
    let series = reactions["series"].as_array().unwrap();
    let (raw, means): (Vec<_>, Vec<_>) = series.iter().partition(|line| line["raw"] == true);
    assert_eq!([raw.len(), means.len()], [4, 4]);
    assert_eq!(series.iter().position(|line| line["raw"] != true), Some(4), "what is pale lies behind");
    assert!(means.iter().all(|line| line["label"] != "" && line["at_borders"] == true));
    let note = |what: &str| {
        format!(
            "pale: all steps; strong: {what} 10 ms, not across impacts further apart than that; peaks after impacts depend on step and elements"
        )
    };
    assert_eq!(reactions["note"], note("without vibrations of periods below"));
    let range =
        |lines: &[&Value]| lines.iter().flat_map(|line| numbers(&line["y"])).fold(0.0_f64, |most, y| most.max(y.abs()));
    assert!(range(&raw) > 2.0 * range(&means), "{} {}", range(&raw), range(&means));
    // At the start all stands still, so that the means are statics.
    let start = |lines: &[&Value]| lines.iter().map(|line| numbers(&line["y"])[0]).sum::<f64>();
    assert!((start(&means) / start(&raw) - 1.0).abs() < 0.05, "{} {}", start(&means), start(&raw));
    // A size has no mean that carries, but a largest value in each period.
    let stress = panel(&page, "section-stress").unwrap();
    assert_eq!(stress["note"], note("the stress itself, where it rings dashed, through the largest of every"));
    let (pale, strong): (Vec<_>, Vec<_>) =
        stress["series"].as_array().unwrap().iter().partition(|line| line["raw"] == true);
    assert!(pale.len() == strong.len() && (range(&strong) / range(&pale) - 1.0).abs() < 1e-3, "{}", range(&strong));
    // A beam under a moving force swings slowly, and is drawn as it is.
    let slow = data(&run_of("two-span", &scenario("two-span-beam"), &[]).html);
    let reactions = panel(&slow, "section-reaction").unwrap()["series"].as_array().unwrap();
    assert!(reactions.iter().all(|line| line["raw"] != true) && reactions.len() == 3);
    let svg = run.figures.iter().find(|(file, _)| file == "section_forces.svg").unwrap().1.as_str();
    // Once for all panels.
    assert_eq!(svg.matches("trong: without vibrations of periods below 10 ms").count(), 1);
}

#[test]
fn a_place_has_one_colour_whatever_is_plotted_of_it() {
    let page = data(&run("places", &ASKED).html);
    let colours = |id: &str| {
        let series = panel(&page, id).unwrap()["series"].as_array().unwrap();
        let named = series.iter().map(|one| (one["label"].as_str().unwrap(), one["index"].as_u64().unwrap()));
        named.filter(|(label, _)| !label.is_empty()).collect::<Vec<_>>()
    };
    let [first, middle] = [("9 cm", 0), ("18 cm", 1)];
    assert_eq!(colours("w_mid"), [("midspan, 18 cm", 1), first]);
    for id in ["section-moment", "section-shear", "section-stress"] {
        assert!(colours(id).contains(&first) && colours(id).contains(&middle), "{id}: {:?}", colours(id));
    }
}

#[test]
fn forces_of_contacts_and_of_beams_have_one_unit() {
    let page = data(&run_of("units", ON_FOUR_SUPPORTS.as_bytes(), &[]).html);
    let unit = |id: &str| panel(&page, id).unwrap()["unit"].as_str().unwrap().to_owned();
    let [reaction, shear] = ["section-reaction", "section-shear"].map(unit);
    let contact = format!("{}N", page["forces"]["units"][0][0][0].as_str().unwrap());
    assert_eq!([reaction.as_str(), shear.as_str()], [contact.as_str(); 2]);
    assert_eq!(unit("energy"), unit("works"));
}

/// A beam that stands as it is has its largest values all along: which step of them is largest by rounding tells nothing.
#[test]
fn what_is_largest_all_along_is_so_from_the_start() {
    let text = "[time]\nend = '0.2 s'\nstep = '100 us'\n[material.s]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n\
        yield_strength = '235 MPa'\n[beam.t]\nmaterial = 's'\nspan = '2 m'\nwidth = '5 cm'\nthickness = '2 cm'\nelements = 12\n\
        start = 'static'\nprobes = ['1 m']\nrecord = ['stress']\n[load.l]\non = 't'\nat = '0.7 m'\nforce = '-150 N'\n";
    let run = crate::page::run("constant", text);
    let stress = run.summary.beams[0].largest_stress.unwrap();
    assert_eq!((run.summary.deflections[0].t, stress.t), (0.0, 0.0));
    assert!(run.summary.deflections[0].w < -1e-3 && stress.stress > 1e7);
}

/// A load that goes slowly: the beam is never stressed as much as at the start, in the static equilibrium under all of it.
#[test]
fn the_stress_of_the_start_is_warned_of_if_it_is_the_largest() {
    let text = "[time]\nend = '0.2 s'\nstep = '100 us'\n[material.s]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n\
        yield_strength = '60 MPa'\n[beam.t]\nmaterial = 's'\nspan = '1 m'\nwidth = '5 cm'\nthickness = '2 cm'\nelements = 12\n\
        start = 'static'\nself_weight = true\ndamping_ratio = { mode = 1, ratio = 0.1 }\n\
        [signal.on]\nshape = 'constant'\n[signal.fall]\nshape = 'ramp'\nduration = '0.5 s'\nscale = -1\n\
        [signal.off]\nshape = 'sum'\nterms = ['on', 'fall']\n[load.l]\non = 't'\nat = '0.5 m'\nforce = '-1000 N'\nsignal = 'off'\n";
    let summary = crate::page::run("unloaded", text).summary;
    let largest = summary.beams[0].largest_stress.unwrap();
    assert_eq!(largest.t, 0.0);
    let warning = summary.warnings.iter().find(|warning| warning.code == "yield").unwrap();
    let told = format!("up to {} of 60 MPa at x = 500 mm, at the start", with_digits(largest.stress, "Pa", 4));
    assert!(warning.text.contains(&told), "{told}: {}", warning.text);
    assert_eq!(warning.first_t, Some(0.0));
}

/// A block at rest at the tip of a cantilever whose own weight alone takes it to 63 % of its yield strength.
#[test]
fn a_beam_is_judged_with_the_weight_that_its_model_leaves_out() {
    let run = |name: &str, weight: bool, span: &str| {
        let text = format!(
            "[time]\nend = '50 ms'\nstep = '100 us'\n[material.s]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n\
             yield_strength = '235 MPa'\n[beam.arm]\nmaterial = 's'\nspan = '{span}'\nwidth = '8 cm'\nthickness = '1.6 cm'\n\
             elements = 24\nsupports = ['clamped', 'free']\nself_weight = {weight}\nstart = 'static'\nprobes = ['1 m']\n\
             record = ['moment', 'stress']\nreactions = true\nenvelope = true\n[load.hook]\non = 'arm'\nat = '3 m'\nforce = '-20 N'\n"
        );
        run_of(name, text.as_bytes(), &[])
    };
    let (without, with) = (run("own-weight-left-out", false, "3.2 m"), run("own-weight", true, "3.2 m"));
    let [bare, full] = [&without, &with].map(|run| &run.summary["beams"][0]);
    // M = ρ A g L²/2 + F a of a section of 8 cm × 1.6 cm.
    let modulus = 0.08 * 0.016 * 0.016 / 6.0;
    let own = 7850.0 * 0.08 * 0.016 * 9.81 * 3.2 * 3.2 / 2.0 / modulus;
    let (load, sum) = (60.0 / modulus, own + 60.0 / modulus);
    let stress = |of: &Value, key: &str| of[key]["stress"].as_f64().unwrap();
    for (found, exact) in [
        (stress(bare, "largest_stress"), load),
        (stress(bare, "largest_stress_with_own_weight"), sum),
        (stress(full, "largest_stress"), sum),
    ] {
        assert!((found / exact - 1.0).abs() < 1e-6, "{found} {exact}");
    }
    assert!(full.get("largest_stress_with_own_weight").is_none() && full.get("part_with_own_weight").is_none());
    let percent = |part: f64| format!("{} %", shortest(100.0 * part, 3));
    let [bare, sum] = [load / 235e6, sum / 235e6].map(percent);
    let headline = |run: &Run| run.summary["headline"].as_str().unwrap().to_owned();
    let told = format!("stressed to {bare} of its yield strength without its own weight, {sum} with it");
    assert!(headline(&without).ends_with(&told), "{}", headline(&without));
    assert!(headline(&with).ends_with(&format!("stressed to {sum} of its yield strength")), "{}", headline(&with));
    // Beside the plots of M and of the reactions, the envelopes and the table.
    let said = "without the beam\u{2019}s own weight";
    let count = without.html.matches(said).count();
    assert!(count >= 4 && !with.html.contains(said), "{count}");
    // Less than a metre longer it would yield under its own weight, which nothing in the run without it tells.
    let longer = run("own-weight-yields", false, "4.1 m").summary;
    let warnings = longer["warnings"].as_array().unwrap();
    let warning = warnings.iter().find(|warning| warning["code"] == "yield").unwrap()["text"].as_str().unwrap();
    assert!(warning.contains("with the beam's own weight, which `self_weight = false` leaves out"), "{warning}");
    let [bare, full] =
        ["part_of_yield_strength", "part_with_own_weight"].map(|key| longer["beams"][0][key].as_f64().unwrap());
    assert!(bare < 0.1 && full > 1.0, "{bare} {full}");
}
