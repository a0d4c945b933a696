//! What became of a scene, as the summary says it, is what `trajectory.csv` says: recomputed here from the rows alone, with the sizes of blocks and the
//! ground's slope and motion from the scene.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod columns;
mod moving;
mod shaken;
mod standing;

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;
use teeter_scenario::scene::{BlockScene, Placement, Scene, SupportingBody};

/// `docs/verdict.md`: still below this part of √(gR), fallen past this part of the way to the next side.
const STILL: f64 = 1e-3;

fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// A run's columns, summary and scene.
struct Ran {
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
    summary: Value,
    scene: Scene,
    stderr: String,
    folder: PathBuf,
}

impl Ran {
    fn of(file: &Path, out: &Path, sets: &[&str]) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_teeter"));
        command.args(["run", "--no-report", "--out"]).arg(out).arg(file);
        sets.iter().for_each(|set| _ = command.args(["--set", set]));
        let output = command.output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{}: {stderr}", file.display());
        assert!(!out.join("report.html").exists() && !out.join("figures").exists(), "--no-report writes no page");
        let text = std::fs::read_to_string(out.join("trajectory.csv")).unwrap();
        let mut lines = text.lines();
        let names = lines.next().unwrap().split(',').map(str::to_owned).collect();
        let rows = lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
        let summary = serde_json::from_str(&std::fs::read_to_string(out.join("summary.json")).unwrap()).unwrap();
        let toml = out.join("scene.toml");
        let scene = teeter_run::SceneSource::file(&toml).load(&[]).unwrap().scene;
        Self { names, rows, summary, scene, stderr, folder: out.to_owned() }
    }

    fn column(&self, name: &str) -> Vec<f64> {
        let at = self.names.iter().position(|column| column == name).unwrap_or_else(|| panic!("no column {name}"));
        self.rows.iter().map(|row| row[at]).collect()
    }

    fn verdict(&self, block: &str) -> &Value {
        let all = self.summary["verdict"].as_array().unwrap();
        all.iter().find(|of| of["body"] == block).unwrap_or_else(|| panic!("no verdict of {block}"))
    }
}

/// The number of the beam that a block stands on, directly or by others; `None` if that is the ground, or nothing.
fn beam_under(scene: &Scene, mut block: usize) -> Option<usize> {
    loop {
        match scene.blocks[block].placement {
            Placement::On { support: SupportingBody::Beam(beam), .. } => return Some(beam),
            Placement::On { support: SupportingBody::Block(below), .. } => block = below,
            Placement::On { .. } => return None,
            Placement::Free { .. } => {
                let contact = scene.contacts.iter().find(|contact| contact.block == block)?;
                let SupportingBody::Beam(beam) = contact.surface else { return None };
                return Some(beam);
            }
        }
    }
}

/// The block at the foot of the stack that a block is in, if that stands on a beam, and which beam.
fn foot_on_beam(scene: &Scene, mut block: usize) -> Option<(usize, usize)> {
    loop {
        match scene.blocks[block].placement {
            Placement::On { support: SupportingBody::Beam(beam), .. } => return Some((block, beam)),
            Placement::On { support: SupportingBody::Block(below), .. } => block = below,
            _ => return None,
        }
    }
}

/// Settings by which tables have the deflections of beams close together where blocks stand on them at the start.
fn probed(scene: &Scene) -> Vec<String> {
    let mut probes = vec![Vec::new(); scene.beams.len()];
    for block in &scene.blocks {
        if let Placement::On { support: SupportingBody::Beam(beam), at, .. } = block.placement {
            let beam_scene = &scene.beams[beam];
            let near = (-96..=96).map(|k| at - beam_scene.position[0] + f64::from(k) / 64.0 * block.width);
            probes[beam]
                .extend(near.filter(|x| (0.0..=beam_scene.spec.span).contains(x)).map(|x| format!("'{x:.9} m'")));
        }
    }
    let named = scene.beams.iter().zip(probes).filter(|(_, probes)| !probes.is_empty());
    named.map(|(beam, probes)| format!("beam.{}.probes=[{}]", beam.name, probes.join(","))).collect()
}

/// The slope of the line between the feet of a block on a beam, put flat about the foot on which it is tilted, in each row, rad; 0 of other blocks.
/// Deflections are those of the beam's probes, cubic between them.
fn chords(ran: &Ran, number: usize) -> Vec<f64> {
    let Some((lowest, beam)) = foot_on_beam(&ran.scene, number) else { return vec![0.0; ran.rows.len()] };
    let (block, beam) = (&ran.scene.blocks[lowest], &ran.scene.beams[beam]);
    let start = format!("{}.w@", beam.name);
    let names = ran.names.iter().enumerate();
    let mut probes: Vec<(f64, usize)> =
        names.filter_map(|(column, name)| Some((name.strip_prefix(&start)?.parse().ok()?, column))).collect();
    probes.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert!(probes.len() > 100, "{} has {} probes", beam.name, probes.len());
    let (dx, dy) = (0.5 * block.width, -0.5 * block.height);
    let [x, phi] = ["x", "phi"].map(|axis| ran.column(&format!("{}.{axis}", block.name)));
    let deflection = |x: f64, row: &[f64]| {
        let x = x.clamp(probes[0].0, probes[probes.len() - 1].0);
        let first = probes.partition_point(|probe| probe.0 < x).saturating_sub(2).min(probes.len() - 4);
        let near = &probes[first..first + 4];
        let of = |k: usize| {
            let weight: f64 = (0..4).filter(|j| *j != k).map(|j| (x - near[j].0) / (near[k].0 - near[j].0)).product();
            weight * row[near[k].1]
        };
        (0..4).map(of).sum::<f64>()
    };
    let slope = |k: usize| {
        let side = if phi[k] >= 0.0 { -1.0 } else { 1.0 };
        let (sin, cos) = phi[k].sin_cos();
        let middle = x[k] + cos * side * dx - sin * dy - side * dx - beam.position[0];
        let row = &ran.rows[k];
        ((deflection(middle + dx, row) - deflection(middle - dx, row)) / block.width).atan()
    };
    (0..ran.rows.len()).map(slope).collect()
}

/// Checks the verdict of a sharp rectangle that stands upright at the start against its rows.
fn check(ran: &Ran, number: usize, what: &str) {
    let block: &BlockScene = &ran.scene.blocks[number];
    let (scene, name) = (&ran.scene, block.name.as_str());
    let said = ran.verdict(name);
    let t = &ran.column("t")[..];
    let of = |column: &str| ran.column(&format!("{name}.{column}"));
    let (x, y, phi, omega) = (of("x"), of("y"), of("phi"), of("omega"));
    let alpha = (block.width / block.height).atan();
    let on_ground = matches!(block.placement, Placement::On { support: SupportingBody::Ground, .. });
    let slope = if on_ground { scene.ground.as_ref().map_or(0.0, |ground| ground.incline) } else { 0.0 };
    let last = t.len() - 1;
    let what = format!("{what}, {name}: {said}");

    // The largest |φ|/α: at least that of every row, and not much more, as rows come often. On a beam from what the beam slopes there.
    let part = |(phi, chord): (&f64, &f64)| {
        let slope = slope + chord;
        let turned = phi - slope;
        turned / if turned > 0.0 { alpha - slope } else { -alpha - slope }
    };
    let largest = phi.iter().zip(&chords(ran, number)).map(part).fold(0.0, f64::max);
    let told = said["max_phi_over_alpha"].as_f64().unwrap();
    assert!(told >= largest - 1e-6 && told <= 1.02 * largest + 0.01, "{largest} {what}");

    // Overturned: past ±α at the end, without the energy to come back; since the row before which it was within.
    let (gravity, radius) = (scene.gravity[0].hypot(scene.gravity[1]), 0.5 * block.width.hypot(block.height));
    let past = phi[last].abs() > alpha;
    let turning_back = omega[last] * phi[last] < 0.0 && {
        // About its corner, of a homogeneous rectangle: I = 4/3 m R².
        let spin = omega[last] * radius;
        0.5 * 4.0 / 3.0 * spin * spin > gravity * radius * (1.0 - (phi[last].abs() - alpha).cos())
    };
    let overturned = past && !turning_back;
    assert_eq!(said["what"] == "overturned", overturned, "{what}");
    if overturned {
        let within = (0..=last).rev().find(|k| phi[*k].abs() <= alpha || phi[*k] * phi[last] < 0.0).unwrap();
        let when = said["overturned_at"].as_f64().unwrap();
        assert!(
            t[within] <= when && when <= t[within + 1],
            "{when} between {} and {}, {what}",
            t[within],
            t[within + 1]
        );
        assert_eq!(said["way"], if phi[last] > 0.0 { "left" } else { "right" }, "{what}");
        assert_eq!(said["t"], said["overturned_at"], "{what}");
    } else {
        assert!(said["overturned_at"].is_null(), "{what}");
    }

    // At rest: below the speed in every row from then on, and not in one before, unless rows come too seldom to see it.
    let moving = scene.ground.as_ref().map(|ground| ground.motion.motions());
    let beam = beam_under(scene, number);
    let beam = beam.map(|beam| (ran.column(&format!("{}.v_mid", scene.beams[beam].name)), beam));
    let (vx, vy) = (of("vx"), of("vy"));
    let speed = |k: usize| {
        let ground = moving.as_ref().map_or([0.0; 2], |axes| [axes[0].velocity(t[k]), axes[1].velocity(t[k])]);
        let carrier = beam.as_ref().map_or(ground, |(rate, _)| [0.0, rate[k]]);
        let relative = (vx[k] - carrier[0]).hypot(vy[k] - carrier[1]);
        // Over a beam that rings it is still if it is so relative to the supports.
        let supports_stand = beam.as_ref().is_some_and(|(_, beam)| !scene.beams[*beam].motion.is_given());
        let least = if supports_stand { relative.min(vx[k].hypot(vy[k])) } else { relative };
        least + radius * omega[k].abs()
    };
    let still = STILL * (gravity * radius).sqrt();
    let least = (radius / gravity).sqrt();
    let in_the_middle = beam.as_ref().is_none_or(|(_, beam)| {
        let beam = &scene.beams[*beam];
        (x[last] - beam.position[0] - 0.5 * beam.spec.span).abs() < 1e-3
    });
    if in_the_middle {
        let late = |from: f64| (0..=last).filter(move |k| t[*k] >= from);
        match said["rests_from"].as_f64() {
            Some(from) => {
                assert!(late(from).all(|k| speed(k) <= 1.001 * still + 1e-12), "it moves after its rest, {what}");
                assert!(t[last] - from >= least * (1.0 - 1e-9), "{what}");
            }
            None => {
                let fastest = late(t[last] - least).map(speed).fold(0.0, f64::max);
                assert!(fastest > 0.1 * still, "it rests by its rows: {fastest} of {still}, {what}");
            }
        }
    }

    // The side that faces down at the end, of a block at rest that leans on nothing.
    let quarter = (phi[last] - slope) / std::f64::consts::FRAC_PI_2;
    let flat = (quarter - quarter.round()).abs() * 90.0;
    let side = ["base", "left side", "top", "right side"][(quarter.round() as i64).rem_euclid(4) as usize];
    match said["rests_from"].as_f64() {
        // Beams bend under what stands on them, and their slope is in no column.
        Some(_) if flat < 5.0 => assert_eq!(said["lies_on"], side, "{what}"),
        Some(_) if flat > 15.0 => assert!(said["lies_on"].is_null(), "{what}"),
        Some(_) => {}
        None => assert!(said["lies_on"].is_null(), "{what}"),
    }

    // Slid: the foot on which it leans, at the start and at the end.
    if on_ground && !overturned && scene.ground.as_ref().is_some_and(|ground| !ground.motion.is_given()) {
        let foot = |k: usize| {
            let side = if phi[k] >= slope { -1.0 } else { 1.0 };
            let (dx, dy) = (side * 0.5 * block.width, -0.5 * block.height);
            let (sin, cos) = phi[k].sin_cos();
            let [fx, fy] = [x[k] + cos * dx - sin * dy, y[k] + sin * dx + cos * dy];
            slope.cos() * fx + slope.sin() * fy - side * 0.5 * block.width
        };
        let (slid, wanted) = (said["slid"].as_f64().unwrap(), foot(last) - foot(0));
        assert!((slid - wanted).abs() < 1e-9, "{slid} {wanted}, {what}");
    }

    // Left: its mass centre is past an end of the beam on which it was placed.
    if let Placement::On { support: SupportingBody::Beam(beam), .. } = block.placement {
        let beam = &scene.beams[beam];
        let at = x[last] - beam.position[0];
        let left = at < 0.0 || at > beam.spec.span;
        assert!(overturned || (said["what"] == "left") == left, "{what}");
    }
}

/// Whether a block begins clear of everything: of all other blocks by their sizes, and above ground and beams by more than it would have to be lifted to
/// turn over.
fn in_flight(ran: &Ran, number: usize) -> bool {
    let (scene, block) = (&ran.scene, &ran.scene.blocks[number]);
    if !matches!(block.placement, Placement::Free { .. }) {
        return false;
    }
    let at = |block: &BlockScene| ["x", "y"].map(|axis| ran.column(&format!("{}.{axis}", block.name))[0]);
    let [x, y] = at(block);
    let clear = |other: &BlockScene| {
        let [ox, oy] = at(other);
        other.name == block.name || (x - ox).hypot(y - oy) > block.radius() + other.radius()
    };
    let floor = |bottom: f64| y - bottom > 2.0 * block.radius();
    scene.blocks.iter().all(clear)
        && scene.ground.as_ref().is_none_or(|ground| floor(x * ground.incline.tan()))
        && scene.beams.iter().all(|beam| floor(beam.position[1]))
}

fn check_all(ran: &Ran, what: &str) -> usize {
    let scene = &ran.scene;
    let free: Vec<usize> = (0..scene.blocks.len()).filter(|k| !scene.blocks[*k].motion.is_given()).collect();
    assert_eq!(ran.summary["verdict"].as_array().unwrap().len(), free.len(), "{what}");
    let mut checked = 0;
    for number in free {
        let block = &scene.blocks[number];
        let upright = match block.placement {
            Placement::Free { angle, .. } => angle.abs() < 0.5,
            Placement::On { .. } => true,
        };
        let flat = scene.ground.as_ref().is_none_or(|ground| ground.profile.is_none() && ground.motion.0[2].is_none());
        if block.critical_angle().is_none() || !upright || !flat {
            continue;
        }
        if in_flight(ran, number) {
            // It has no stance, until it has landed on some side; only of what stood it is told that it overturned.
            assert!(
                ran.verdict(&block.name)["overturned_at"].as_f64() != Some(0.0),
                "{what}: {}",
                ran.verdict(&block.name)
            );
            continue;
        }
        check(ran, number, what);
        checked += 1;
    }
    // The numbers of the whole scene are those of its blocks, and the sentence is on the terminal.
    let all = ran.summary["verdict"].as_array().unwrap();
    let values = |key: &str| all.iter().filter_map(|of| of[key].as_f64()).collect::<Vec<_>>();
    assert_eq!(ran.summary["max_phi_over_alpha"].as_f64(), values("max_phi_over_alpha").into_iter().reduce(f64::max));
    assert_eq!(ran.summary["overturned_at"].as_f64(), values("overturned_at").into_iter().reduce(f64::min));
    assert!(ran.stderr.contains(ran.summary["headline"].as_str().unwrap()), "{what}: {}", ran.stderr);
    checked
}

#[test]
fn the_verdict_of_every_scenario_is_what_its_trajectory_says() {
    let out = folder("verdict-scenarios");
    let scenarios = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios");
    let mut checked = 0;
    for entry in std::fs::read_dir(scenarios).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            let probes = probed(&teeter_run::SceneSource::file(&path).load(&[]).unwrap().scene);
            let probes: Vec<_> = probes.iter().map(String::as_str).collect();
            checked += check_all(&Ran::of(&path, &out.join(&name), &probes), &name);
        }
    }
    assert!(checked > 50, "{checked} blocks were checked");
}

/// Stones that lie on others without being placed `on` them slide along those, not along their neighbours.
#[test]
fn a_course_of_a_wall_slides_on_the_one_below() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/dry-stone-wall.toml");
    let ran = Ran::of(&file, &folder("verdict-wall"), &[]);
    for (block, below) in
        [("second-1", "lowest-1"), ("second-3", "lowest-3"), ("second-5", "lowest-6"), ("third-4", "second-5")]
    {
        let [x, base] = [block, below].map(|name| ran.column(&format!("{name}.x")));
        let moved = |x: &[f64]| x[x.len() - 1] - x[0];
        let slid = ran.verdict(block)["slid"].as_f64().unwrap();
        assert!((slid - (moved(&x) - moved(&base))).abs() < 1e-6, "{block}: {slid}");
    }
    let headline = ran.summary["headline"].as_str().unwrap();
    assert!(headline.contains("(5 after sliding)"), "{headline}");
}

const HEAD: &str =
    "[world]\ngravity = '9.81 m/s^2'\n[material.a]\ndensity = '2700 kg/m^3'\nyoungs_modulus = '69 GPa'\n";

/// Blocks of 3 cm × 13.5 cm on ground: α is 12.53°.
const ROCKER: &str =
    "[block.b]\nmaterial = 'a'\nwidth = '3 cm'\nheight = '13.5 cm'\ndepth = '3 cm'\non = 'ground'\nat = '0 m'\n";
const FLOOR: &str = "[contact.f]\nbetween = ['b', 'ground']\nfriction = 0.5\n";

fn scene(name: &str, text: &str) -> Ran {
    scene_beside(name, text, "")
}

/// A scene beside a file `quake.csv` with these rows.
fn scene_beside(name: &str, text: &str, rows: &str) -> Ran {
    let folder = folder(&format!("verdict-{name}"));
    std::fs::write(folder.join("quake.csv"), rows).unwrap();
    written(&folder, &format!("{HEAD}{text}"))
}

/// A scene with a head of its own.
fn written(folder: &Path, text: &str) -> Ran {
    let file = folder.join("scene.toml");
    std::fs::write(&file, text).unwrap();
    Ran::of(&file, &folder.join("out"), &[])
}

fn what(ran: &Ran) -> (&str, Option<&str>) {
    let of = ran.verdict("b");
    (of["what"].as_str().unwrap(), of["way"].as_str())
}

const TIME: &str = "[time]\nend = '1.5 s'\nstep = '200 us'\n";

#[test]
fn a_block_overturns_to_the_side_to_which_it_is_tilted_past_alpha() {
    for (tilt, wanted) in
        [(13, ("overturned", Some("left"))), (-13, ("overturned", Some("right"))), (12, ("rocks", None))]
    {
        let name = format!("tilt-{tilt}");
        let ran = scene(&name, &format!("{TIME}[ground]\n{ROCKER}tilt = '{tilt} deg'\n{FLOOR}"));
        assert_eq!(what(&ran), wanted, "{}", ran.summary["headline"]);
        if tilt == 12 {
            check_all(&ran, &name);
        } else {
            // It began past the point of no return.
            assert_eq!(ran.summary["overturned_at"].as_f64(), Some(0.0));
        }
    }
}

/// A block of 5 cm × 15 cm that begins somewhere above the ground.
const THROWN: &str = "[block.b]\nmaterial = 'a'\nwidth = '5 cm'\nheight = '15 cm'\ndepth = '5 cm'\n";

#[test]
fn what_comes_down_on_a_side_says_on_which() {
    for (name, start, side) in [
        ("right", "position = ['0 m', '30 cm']\nspin = '-4 rad/s'", "right side"),
        ("left", "position = ['0 m', '30 cm']\nspin = '4 rad/s'", "left side"),
        ("turned", "position = ['0 m', '20 cm']\nangle = '20 deg'", "left side"),
        ("upright", "position = ['0 m', '8 cm']", "base"),
    ] {
        let text = format!("{TIME}[ground]\n{THROWN}{start}\n[contact.f]\nbetween = ['b', 'ground']\nfriction = 0.6\n");
        let ran = scene(&format!("side-{name}"), &text);
        let (said, headline) = (ran.verdict("b"), ran.summary["headline"].as_str().unwrap());
        assert_eq!(said["lies_on"], side, "{said}");
        // It stood nowhere before, so it did not overturn.
        assert!(said["overturned_at"].is_null() && said["rests_from"].as_f64().unwrap() > 0.0, "{said}");
        assert_eq!(headline.contains(&format!(" on its {side}")), side != "base", "{headline}");
        let phi = ran.column("b.phi").last().unwrap().to_degrees();
        let wanted = match side {
            "right side" => -90.0,
            "left side" => 90.0,
            _ => 0.0,
        };
        assert!((phi - wanted).abs() < 0.01, "{phi} {headline}");
        assert!(ran.stderr.contains(headline), "{}", ran.stderr);
    }
}

#[test]
fn what_overturned_says_on_which_side_it_ended() {
    let ran = scene("ended", &format!("{TIME}[ground]\n{ROCKER}tilt = '-13 deg'\n{FLOOR}"));
    let headline = ran.summary["headline"].as_str().unwrap();
    assert!(
        headline.starts_with(
            "`b` began past its critical angle and overturned to the right, came to rest on its right side at t = "
        ),
        "{headline}"
    );
    assert_eq!(ran.verdict("b")["lies_on"], "right side");
}

#[test]
fn on_an_incline_it_overturns_downhill_sooner_than_uphill() {
    // Uphill to the right by 5°: 7.5° are left downhill, to the left, and 17.5° uphill.
    for (tilt, wanted) in [(8, "overturned"), (7, "rocks"), (-15, "other"), (-18, "overturned")] {
        let name = format!("incline-{tilt}");
        let text = format!("{TIME}[ground]\nincline = '5 deg'\n{ROCKER}tilt = '{tilt} deg'\n{FLOOR}");
        let ran = scene(&name, &text);
        let found = what(&ran);
        if tilt == -18 {
            assert_eq!(found, (wanted, Some("right")));
        } else if tilt == 8 {
            assert_eq!(found, (wanted, Some("left")));
        } else {
            check_all(&ran, &name);
            let part = ran.summary["max_phi_over_alpha"].as_f64().unwrap();
            // It begins within its point of no return, and comes back through upright.
            assert!(ran.column("b.phi").iter().any(|phi| (phi.to_degrees() - 5.0) * f64::from(tilt) < 0.0), "{tilt}");
            assert!(part > 0.8, "{part}");
        }
    }
}

#[test]
fn on_an_incline_beyond_alpha_what_stands_on_its_base_overturns() {
    // α is 12.5°: it is past the point of no return, and lies on its side in the end.
    for tilt in [0, -2] {
        let name = format!("steep-incline-{tilt}");
        let text = format!("{TIME}[ground]\nincline = '15 deg'\n{ROCKER}tilt = '{tilt} deg'\n{FLOOR}");
        let ran = scene(&name, &text);
        assert_eq!(what(&ran), ("overturned", Some("left")), "{tilt}: {}", ran.summary["headline"]);
        assert!(*ran.column("b.phi").last().unwrap() > 1.5, "{tilt}");
    }
}

#[test]
fn gravity_that_leans_is_the_same_as_an_incline() {
    // α is 12.5°, so that it begins past its critical angle on the second.
    for (degrees, tilt) in [(5.0_f64, 0), (5.0, 4), (5.0, -10), (15.0, 0), (15.0, -2)] {
        let lean = degrees.to_radians();
        // Downhill is to the left of a slope that rises to the right.
        let gravity = format!("['{} m/s^2', '{} m/s^2']", -9.81 * lean.sin(), -9.81 * lean.cos());
        let (head, name) = (HEAD.replace("'9.81 m/s^2'", &gravity), format!("{degrees}-{tilt}"));
        let rocker = format!("{ROCKER}tilt = '{tilt} deg'\n{FLOOR}");
        let slope = format!("{TIME}[ground]\nincline = '{degrees} deg'\n{rocker}");
        let incline = scene(&format!("slope-{name}"), &slope);
        let leaning = written(&folder(&format!("verdict-leaning-{name}")), &format!("{head}{TIME}[ground]\n{rocker}"));
        let part = |ran: &Ran| ran.verdict("b")["max_phi_over_alpha"].as_f64();
        match (part(&incline), part(&leaning)) {
            (Some(a), Some(b)) => assert!((a - b).abs() < 1e-6, "{name}: {a} {b}"),
            (a, b) => assert_eq!(a, b, "{name}"),
        }
        assert_eq!(what(&incline), what(&leaning), "{name}");
        assert_eq!(incline.verdict("b")["lies_on"], leaning.verdict("b")["lies_on"], "{name}");
    }
}

#[test]
fn what_stopped_just_before_the_end_does_not_slide_on() {
    // √(R/g) is 40 ms; friction stops it after 204 ms.
    let block = ROCKER.replace("height = '13.5 cm'", "height = '1 cm'");
    let floor = FLOOR.replace("friction = 0.5", "friction = 0.25");
    let text = |end: &str| {
        format!("[time]\nend = '{end}'\nstep = '200 us'\n[ground]\n{block}velocity = ['0.5 m/s', '0 m/s']\n{floor}")
    };
    let headline = |name: &str, end: &str| scene(name, &text(end)).summary["headline"].as_str().unwrap().to_owned();
    assert!(headline("slides", "0.19 s").contains("slides on"));
    let still = headline("still", "0.21 s");
    assert!(still.contains("and has been still since t = 20"), "{still}");
    assert!(headline("rested", "0.4 s").contains("came to rest"));
    // What is shaken may slide again.
    let shaken = "motion = { acceleration = ['1 m/s^2', '0 m/s^2'], signal = 's' }\n[signal.s]\nshape = 'harmonic'\nfrequency = '3 Hz'\n";
    let shaken = text("0.18 s").replace("[ground]\n", &format!("[ground]\n{shaken}"));
    let headline = scene("shaken-still", &shaken).summary["headline"].as_str().unwrap().to_owned();
    assert!(headline.ends_with("to the right and is still at the end"), "{headline}");
}

#[test]
fn what_slides_on_a_slope_does_so_up_or_down_it() {
    let block = ROCKER.replace("height = '13.5 cm'", "height = '1 cm'");
    for (incline, speed, way) in [
        ("20 deg", 0.5, "up the slope"),
        ("20 deg", -0.5, "down the slope"),
        ("-20 deg", -0.5, "up the slope"),
        ("0 deg", 0.5, "to the right"),
        ("0 deg", -0.5, "to the left"),
    ] {
        let text = format!(
            "[time]\nend = '0.4 s'\nstep = '200 us'\n[ground]\nincline = '{incline}'\n{block}velocity = ['{speed} m/s', '0 m/s']\n{FLOOR}"
        );
        let ran = scene(&format!("up-{incline}-{speed}"), &text.replace("friction = 0.5", "friction = 0.6"));
        let headline = ran.summary["headline"].as_str().unwrap();
        assert!(headline.contains("slid by") && headline.contains(way), "{incline} {speed}: {headline}");
    }
}

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
fn shaken_past_alpha_and_back_is_not_overturned() {
    // A push past α, and one back while it still hangs there: the ground goes the other way.
    let text = format!(
        "{TIME}[ground]\nmotion = {{ acceleration = ['4.6 m/s^2', '0 m/s^2'], signal = 'shake' }}\n\
         [signal.shake]\nshape = 'table'\nfile = 'quake.csv'\n{ROCKER}{FLOOR}"
    );
    let text = text.replace("friction = 0.5", "friction = 1.5");
    let rows = "0,1\n0.13,1\n0.1301,-1.8\n0.21,-1.8\n0.2101,0\n1.5,0\n";
    let ran = scene_beside("shaken", &text, rows);
    let past = ran.summary["max_phi_over_alpha"].as_f64().unwrap();
    let phi = ran.column("b.phi");
    let alpha = (3.0_f64 / 13.5).atan();
    let came_back = phi
        .iter()
        .position(|phi| phi.abs() > alpha)
        .is_some_and(|k| phi[k..].iter().any(|phi| phi.abs() < 0.5 * alpha));
    assert!(past > 1.0 && came_back, "the scene must pass α and come back: {past}");
    check_all(&ran, "shaken");
    assert_eq!(what(&ran).0, "rocks", "{}", ran.summary["headline"]);
}

#[test]
fn a_block_that_slides_on_to_the_next_beam_has_not_left_it() {
    let beam = |name: &str, x: &str| {
        format!(
            "[beam.{name}]\nmaterial = 'a'\nspan = '36 cm'\nwidth = '3 cm'\nthickness = '1 cm'\nelements = 10\nposition = ['{x}', '0 m']\n"
        )
    };
    let text = format!(
        "[time]\nend = '0.3 s'\nstep = '200 us'\n{}{}\
         [block.b]\nmaterial = 'a'\nwidth = '4 cm'\nheight = '1 cm'\ndepth = '3 cm'\non = 't'\nat = '30 cm'\nvelocity = ['1 m/s', '0 m/s']\n\
         [contact.f]\nbetween = ['b', '*']\nfriction = 0.05\n",
        beam("t", "0 m"),
        beam("u", "36 cm")
    );
    let ran = scene("next-beam", &text);
    assert!(*ran.column("b.x").last().unwrap() > 0.45);
    assert_eq!(what(&ran), ("slid", None), "{}", ran.summary["headline"]);
}

#[test]
fn a_block_that_slides_past_the_end_of_its_beam_has_left_it() {
    let text = "[time]\nend = '0.5 s'\nstep = '200 us'\n\
         [beam.t]\nmaterial = 'a'\nspan = '36 cm'\nwidth = '3 cm'\nthickness = '1 cm'\nelements = 10\n\
         [block.b]\nmaterial = 'a'\nwidth = '4 cm'\nheight = '1 cm'\ndepth = '3 cm'\non = 't'\nat = '30 cm'\nvelocity = ['1 m/s', '0 m/s']\n\
         [contact.f]\nbetween = ['b', 't']\nfriction = 0.05\n";
    let ran = scene("left", text);
    let at = ran.column("b.x");
    let gone = at.iter().position(|x| *x > 0.36).unwrap();
    let (kind, way) = what(&ran);
    assert_eq!((kind, way), ("left", Some("right")), "it has left, though it turns over as it falls");
    let when = ran.verdict("b")["t"].as_f64().unwrap();
    let t = ran.column("t");
    // It tips over the end first, and leaves it when the end presses on it for the last time.
    let contacts = std::fs::read_to_string(ran.folder.join("contacts.csv")).unwrap();
    let mut lines = contacts.lines();
    let p_n = lines.next().unwrap().split(',').position(|name| name == "p_n").unwrap();
    let rows = lines.map(|line| line.split(',').collect::<Vec<_>>());
    let pressed = rows.filter(|row| row[p_n].parse::<f64>().unwrap() > 0.0).map(|row| row[0].parse().unwrap());
    let last = pressed.fold(0.0, f64::max);
    assert!(last > t[gone], "{last}");
    assert_eq!(when, last);
    let early = scene("left-early", &text.replace("0.5 s", &format!("{} s", t[gone + 5])));
    let headline = early.summary["headline"].as_str().unwrap();
    assert!(headline.starts_with("`b` tipped over the right end of `t` at t = "), "{headline}");
    assert!(headline.ends_with(" and still touches it"), "{headline}");
    let tipped = early.verdict("b")["t"].as_f64().unwrap();
    assert!(t[gone - 1] <= tipped && tipped <= t[gone], "{tipped}");
    // Ten steps after the end pressed for the last time.
    let just = scene("left-just", &text.replace("0.5 s", &format!("{} s", last + 2e-3)));
    let headline = just.summary["headline"].as_str().unwrap();
    assert!(!headline.contains("still touches") && just.verdict("b")["t"] == last, "{headline}");
    assert!(ran.column("b.phi").last().unwrap() < &-1.5 && ran.summary["overturned_at"].is_null());
}

#[test]
fn a_run_stops_where_the_scene_says_and_tells() {
    let stop = |name: &str, words: &str, text: &str| {
        scene(name, &format!("[time]\nend = '3 s'\nstep = '200 us'\nstop = {words}\n{text}"))
    };
    let fall = format!("[ground]\n{ROCKER}tilt = '13 deg'\n{FLOOR}");
    let ran = stop("stop-overturned", "['overturned', 'rest']", &fall);
    assert_eq!(
        (ran.summary["ended"].as_str(), ran.summary["stopped_by"].as_str()),
        (Some("stopped"), Some("overturned"))
    );
    let end = *ran.column("t").last().unwrap();
    assert!(
        end < 3.0 && ran.summary["t"].as_f64() == Some(end) && ran.stderr.contains("stopped at t = "),
        "{}",
        ran.stderr
    );
    assert!(*ran.column("b.phi").last().unwrap() > 1.2, "it lies nearly on its side");
    // The rows up to there are those of the run that goes on.
    let on = scene("stop-not", &format!("[time]\nend = '3 s'\nstep = '200 us'\n{fall}"));
    assert_eq!(ran.rows[..ran.rows.len() - 1], on.rows[..ran.rows.len() - 1]);
    assert_eq!(on.summary["ended"], "complete");

    let slide = format!("[ground]\n{ROCKER}velocity = ['0.2 m/s', '0 m/s']\n{FLOOR}").replace("0.5", "0.1");
    let ran = stop("stop-rest", "['rest']", &slide);
    assert_eq!(ran.summary["stopped_by"], "rest");
    assert!(ran.verdict("b")["rests_from"].as_f64().unwrap() < ran.summary["t"].as_f64().unwrap());

    let through = ROCKER.replace("on = 'ground'\nat = '0 m'", "position = ['9 m', '1 m']");
    let beam = "[beam.t]\nmaterial = 'a'\nspan = '36 cm'\nwidth = '3 cm'\nthickness = '1 cm'\nelements = 4\n";
    let ran =
        stop("stop-sunk", "['sunk']", &format!("{beam}{through}[contact.f]\nbetween = ['b', 't']\nfriction = 0.5\n"));
    assert_eq!((ran.summary["stopped_by"].as_str(), what(&ran).0), (Some("sunk"), "sunk"));
}

#[test]
fn rest_does_not_stop_a_run_before_the_shaking_begins() {
    let text = format!(
        "[time]\nend = '3 s'\nstep = '200 us'\nstop = ['rest']\n\
         [ground]\nmotion = {{ acceleration = ['4 m/s^2', '0 m/s^2'], signal = 'shake' }}\n\
         [signal.shake]\nshape = 'one-sine'\nstart = '1 s'\nperiod = '0.2 s'\n{ROCKER}{FLOOR}"
    );
    let ran = scene("rest-later", &text);
    assert!(ran.summary["t"].as_f64().unwrap() > 1.2, "{}", ran.summary["t"]);
}

/// A box of 3 cm × 13.5 cm or others that begins in the air.
fn from_the_air(name: &str, block: &str, rest: &str) -> Ran {
    let text = format!(
        "[time]\nend = '3 s'\nstep = '200 us'\n[block.b]\nmaterial = 'a'\ndepth = '3 cm'\n{block}\n{FLOOR}{rest}"
    );
    scene(name, &text)
}

#[test]
fn what_tumbles_through_the_air_does_not_overturn() {
    let thrown = "width = '6 cm'\nheight = '4 cm'\nposition = ['0 m', '1 m']\nvelocity = ['0.3 m/s', '1 m/s']\nspin = '15 rad/s'";
    let ran = from_the_air("thrown", thrown, "[ground]\n");
    assert!(ran.column("b.phi").iter().any(|phi| phi.abs() > std::f64::consts::TAU), "it turns over in the air");
    let of = ran.verdict("b");
    assert_eq!(of["what"], "rests", "{of}");
    assert!(ran.summary["overturned_at"].is_null() && of["overturned_at"].is_null(), "{of}");
    // From when it has settled φ/α is told, and by itself it stays below 1 then; how far it flew is no slide.
    assert!(of["max_phi_over_alpha"].as_f64().is_some_and(|part| part < 1.0), "{of}");
    assert!(of["slid"].as_f64().is_some_and(|slid| slid.abs() < 1e-3), "{of}");
    let turned = ran.column("b.phi").last().unwrap().abs().to_degrees();
    let headline = ran.summary["headline"].as_str().unwrap();
    assert!(headline.contains(&format!("tumbled by {turned:.0}°, then came to rest")), "{headline}");

    // One that never lands has no fate but that it moves.
    let ran = from_the_air("aloft", &thrown.replace("1 m/s", "40 m/s"), "[ground]\n");
    let of = ran.verdict("b");
    assert_eq!((&of["what"], &of["t"]), (&Value::from("moves"), &Value::Null), "{of}");
    assert!(of["slid"].is_null() && of["max_phi_over_alpha"].is_null(), "{of}");
    assert!(ran.summary["headline"].as_str().unwrap().contains("is still in flight"), "{}", ran.summary["headline"]);
}

#[test]
fn what_lands_and_is_then_knocked_over_has_overturned() {
    let dropped = "width = '3 cm'\nheight = '13.5 cm'\nposition = ['0 m', '0.1 m']";
    let push = "[force.push]\non = 'b'\ncouple = '0.3 N m'\nsignal = 'late'\n[signal.late]\nshape = 'one-sine'\nstart = '1.5 s'\nperiod = '0.4 s'\n";
    let ran = from_the_air("knocked", dropped, &format!("[ground]\n{push}"));
    let of = ran.verdict("b");
    assert_eq!(of["what"], "overturned", "{of}");
    assert!(of["t"].as_f64().is_some_and(|t| t > 1.5), "{of}");
}

#[test]
fn a_gap_too_small_to_turn_it_over_is_as_good_as_none() {
    // Half a millimetre above ground that takes it down before it could have settled.
    let placed = "width = '3 cm'\nheight = '13.5 cm'\nposition = ['0 m', '6.8 cm']";
    let ground = "[ground]\nmotion = { acceleration = ['5 m/s^2', '0 m/s^2'], signal = 'pulse' }\n[signal.pulse]\nshape = 'one-sine'\nstart = '0 s'\nperiod = '0.6 s'\n";
    let ran = from_the_air("gap", placed, ground);
    let of = ran.verdict("b");
    assert_eq!(of["what"], "overturned", "{of}");
    assert!(of["t"].as_f64().is_some_and(|t| t < 1.0), "{of}");
}

/// A run of a scenario with settings, and the verdict on it.
fn scenario(name: &str, out: &str, sets: &[&str]) -> Ran {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../scenarios/{name}.toml"));
    Ran::of(&file, &folder(out), sets)
}

#[test]
fn an_arch_that_falls_is_told_as_collapsed_and_one_that_stands_is_not() {
    let fallen = scenario(
        "masonry-arch",
        "verdict-arch-falls",
        &["force.load.force=[\"0 N\", \"-1.1 kN\"]", "time.end=\"1.2 s\""],
    );
    let headline = fallen.summary["headline"].as_str().unwrap();
    assert!(headline.starts_with("collapsed: ") && headline.contains(" of 15 blocks fell"), "{headline}");
    // The crown is on the ground: as thick as the ring is, 15 cm, or less above it.
    let crown = fallen.verdict("v8");
    assert_eq!(crown["what"], "fell", "{crown}");
    let y = fallen.column("v8.y");
    assert!(y[0] > 0.9 && y.last().is_some_and(|y| *y < 0.3), "{y:?}");
    // By its least width, the length of a joint or of the shorter arc, whichever is less.
    let at = crown["fell_at"].as_f64().unwrap();
    let row = fallen.column("t").iter().position(|t| *t >= at).unwrap();
    assert!((0.1..0.25).contains(&(y[0] - y[row])), "{} m", y[0] - y[row]);
    // The springers stand on the ground from the start: they can't fall from their places.
    assert_ne!(fallen.verdict("v1")["what"], "fell");

    let stands = scenario("masonry-arch", "verdict-arch-stands", &["time.end=\"0.3 s\""]);
    let headline = stands.summary["headline"].as_str().unwrap();
    assert_eq!(headline, "all 15 blocks stood still throughout");
    assert!(stands.summary["verdict"].as_array().unwrap().iter().all(|of| of.get("fell_at").is_none()));
}

/// Two blocks of 10 cm, the upper one on the lower, which slides down a slope of 30° by more than they are high.
const RIDERS: &str = "[block.b]\nmaterial = 'a'\nwidth = '20 cm'\nheight = '10 cm'\ndepth = '10 cm'\non = 'ground'\nat = '0 m'\n\
    [block.rider]\nmaterial = 'a'\nwidth = '10 cm'\nheight = '5 cm'\ndepth = '10 cm'\non = 'b'\nat = '0 m'\n\
    [contact.rides]\nbetween = ['rider', 'b']\nfriction = 2.0\n";

#[test]
fn what_rides_down_a_slope_has_not_fallen() {
    let text = format!(
        "[time]\nend = '0.6 s'\nstep = '1 ms'\n[ground]\nincline = '-30 deg'\n{RIDERS}[contact.f]\nbetween = ['b', 'ground']\nfriction = 0.1\n"
    );
    let ran = scene("riders", &text);
    let y = ran.column("rider.y");
    assert!(y[0] - y.last().unwrap() > 0.2, "{y:?}");
    assert_ne!(ran.verdict("rider")["what"], "fell", "{}", ran.verdict("rider"));
}

#[test]
fn what_stands_on_shaken_ground_did_not_stand_still() {
    let ground = "[ground]\nmotion = { acceleration = ['0.5 m/s^2', '0 m/s^2'], signal = 's' }\n[signal.s]\nshape = 'harmonic'\nfrequency = '2 Hz'\n";
    let wide = ROCKER.replace("width = '3 cm'", "width = '20 cm'");
    let ran = scene("moves-along", &format!("{TIME}{ground}{wide}{FLOOR}"));
    assert_eq!(ran.summary["headline"], "`b` stood on the moving ground throughout");
    let x = ran.column("b.x");
    let goes = x.iter().map(|at| (at - x[0]).abs()).fold(0.0, f64::max);
    assert!(goes > 1e-3, "{goes}");
}

#[test]
fn what_slides_back_is_told_with_how_far_it_was() {
    // It starts at 1 m/s to the right; friction of 0.1 m g and a force of 0.3 m g to the left stop it after 127 mm, then it comes back with 0.2 g.
    let block = "[block.b]\nmaterial = 'a'\nwidth = '20 cm'\nheight = '2 cm'\ndepth = '10 cm'\non = 'ground'\nat = '0 m'\nvelocity = ['1 m/s', '0 m/s']\n";
    let mass = 2700.0 * 0.2 * 0.02 * 0.1;
    let force = format!("[force.back]\non = 'b'\nforce = ['{} N', '0 N']\n", -0.3 * 9.81 * mass);
    let floor = FLOOR.replace("0.5", "0.1");
    let ran = scene("back", &format!("[time]\nend = '0.5 s'\nstep = '200 us'\n[ground]\n{block}{force}{floor}"));
    let of = ran.verdict("b");
    let farthest = of["farthest"].as_f64().unwrap();
    // v²/(2 a) with a = 0.4 g, to the steps of a first-order scheme.
    assert!((farthest - 1.0 / (2.0 * 0.4 * 9.81)).abs() < 1e-3, "{of}");
    let headline = ran.summary["headline"].as_str().unwrap();
    assert!(headline.contains("slid 12") && headline.contains("mm to the right, then back to "), "{headline}");
    assert!(headline.ends_with("mm right of its start so far"), "{headline}");
    // From the turning point on with 0.2 g, for what is left of 0.5 s.
    let turned_at = 1.0 / (0.4 * 9.81);
    assert!((of["speed"].as_f64().unwrap() - 0.2 * 9.81 * (0.5 - turned_at)).abs() < 3e-3, "{of}");
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
        assert_eq!(ran.summary["headline"].as_str().unwrap(), format!("`b` is still {how}"));
    }
}

#[test]
fn a_plate_that_a_beam_lifts_by_micrometres_does_not_bounce() {
    let text = "[time]\nend = '0.5 s'\nstep = '100 us'\n[material.steel]\ndensity = '7850 kg/m^3'\nyoungs_modulus = '210 GPa'\n\
        [beam.t]\nmaterial = 'steel'\nspan = '1 m'\nwidth = '5 cm'\nthickness = '5 mm'\nelements = 20\n\
        damping_ratio = { mode = 1, ratio = 0.01 }\n[block.plate]\nmaterial = 'steel'\nwidth = '10 cm'\nheight = '1 cm'\n\
        depth = '5 cm'\nposition = ['50 cm', '1.5 cm']\n[contact.f]\nbetween = ['plate', 't']\nfriction = 0.3\n";
    // By tens of micrometres in the last 0.1 s, also where it was thrown higher before, and by 0.16 mm.
    let trembles = "trembling where it stands, on a beam that moves";
    for (restitution, end, how) in
        [("0.5", "0.5 s", trembles), ("0.9", "0.28 s", "bouncing"), ("0.9", "0.5 s", trembles)]
    {
        let text = text.replace("0.5 s", end);
        let ran = scene(&format!("plate-{restitution}-{end}"), &format!("{text}restitution = {restitution}\n"));
        assert_eq!(ran.summary["headline"], format!("`plate` is still {how}"));
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
fn a_tilted_block_that_came_down_and_slides_on_is_told_as_sliding() {
    let text = "[time]\nend = '1.2 s'\nstep = '1 ms'\n[ground]\nincline = '25 deg'\n\
        [block.b]\nmaterial = 'a'\nwidth = '10 cm'\nheight = '6 cm'\ndepth = '10 cm'\non = 'ground'\nat = '0 m'\ntilt = '0.532 deg'\n\
        [contact.f]\nbetween = ['b', 'ground']\nfriction = 0.3\n";
    let ran = scene("tilted-slides", text);
    assert_eq!(ran.summary["verdict"][0]["what"], "slid");
    let headline = ran.summary["headline"].as_str().unwrap();
    assert!(
        headline.starts_with("`b` slides on, slid by 1.06") && headline.contains("down the slope so far"),
        "{headline}"
    );
    assert!(!headline.contains("peak"), "{headline}");
}

#[test]
fn a_stone_still_on_a_beam_that_rings_under_it_rests() {
    let ran = scenario("lintel", "verdict-lintel", &["time.end=\"0.6 s\"", "beam.lintel.elements=16"]);
    let headline = ran.summary["headline"].as_str().unwrap();
    assert!(headline.starts_with("all 3 blocks came to rest"), "{headline}");
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

#[test]
fn a_block_that_rolls_over_sides_is_told_with_its_turns_and_on_what_it_rests() {
    let cube = ROCKER.replace("3 cm", "10 cm").replace("height = '13.5 cm'", "height = '10 cm'");
    let text = format!("{TIME}[ground]\n{cube}velocity = ['4 m/s', '0 m/s']\nspin = '-40 rad/s'\n{FLOOR}")
        .replace("friction = 0.5", "friction = 0.9\nrestitution = 0.4");
    let ran = scene("rolls-over", &text);
    let headline = ran.summary["headline"].as_str().unwrap();
    let phi = ran.column("b.phi");
    let turns = (phi.last().unwrap() - phi[0]).abs() / std::f64::consts::TAU;
    let told = if turns < 2.0 {
        format!(", turned by {:.0}° in all", 360.0 * turns)
    } else {
        format!(", made {turns:.2} turns in all").replace("0 turns", " turns")
    };
    assert!(turns > 0.4 && headline.contains(&told), "{turns}: {headline}");
}
