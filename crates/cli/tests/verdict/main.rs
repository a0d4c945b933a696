//! What became of a scene, as the summary says it, is what `trajectory.csv` says: recomputed here from the rows alone, with the sizes of blocks and the
//! ground's slope and motion from the scene.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod columns;
mod flight;
mod going;
mod moving;
mod shaken;
mod slides;
mod slopes;
mod standing;
mod stops;

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
fn a_stone_still_on_a_beam_that_rings_under_it_rests() {
    let ran = scenario("lintel", "verdict-lintel", &["time.end=\"0.6 s\"", "beam.lintel.elements=16"]);
    let headline = ran.summary["headline"].as_str().unwrap();
    assert!(headline.starts_with("all 3 blocks came to rest"), "{headline}");
}
