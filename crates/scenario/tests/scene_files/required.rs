//! What a model does without: a run with it gives the same numbers, and each bound holds against
//! scenes that try to break it.

mod random;

use super::running::companion;
use super::{ROCKING, sets};
use std::ops::ControlFlow;
use std::path::Path;
use teeter_integrator::{Ended, Model, Observer, ObserverError, State, StepReport};
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Simulation;
use teeter_scenario::{Extent, Required, load, load_with};

/// All numbers of all steps in one, and whether the limits held.
#[derive(Clone, Debug, Default, PartialEq)]
struct Seen {
    hash: u64,
    steps: u64,
    /// Largest |φ| of each block, rad.
    tilts: Vec<f64>,

    broken: bool,
    required: Required,
}

impl Seen {
    fn mix(&mut self, x: f64) {
        self.hash = (self.hash ^ x.to_bits()).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(17);
    }
}

impl Observer<2> for Seen {
    fn observe(
        &mut self,
        _: &Model<2>,
        step: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError> {
        self.steps += 1;
        let energy = state.ledger.current;
        let account = [energy.kinetic, energy.elastic, energy.gravity, step.energy().contact, step.penetration];
        state.q.iter().chain(&state.v).chain(&account).for_each(|x| self.mix(*x));
        for contact in step.contacts() {
            contact.p.iter().chain(contact.u_after.iter()).for_each(|x| self.mix(*x));
            self.mix(contact.id.pair() as f64 + 0.1 * contact.id.point() as f64);
        }
        for (tilt, q) in self.tilts.iter_mut().zip(state.q.chunks_exact(3)) {
            *tilt = tilt.max(q[2].abs());
        }
        self.broken |= self.required.limits.is_some_and(|limits| !limits.hold(state));
        Ok(ControlFlow::Continue(()))
    }
}

fn scene(text: &str, pairs: &[(&str, &str)]) -> Scene {
    let loaded = load_with(text.as_bytes(), "scene", "scene", &sets(pairs), &mut companion);
    loaded.unwrap_or_else(|errors| panic!("{errors}")).scene
}

fn simulation(scene: &Scene, extent: Extent) -> Simulation {
    Simulation::with_extent(scene, extent, |solver| solver).unwrap_or_else(|error| panic!("{error}"))
}

fn run(scene: &Scene, extent: Extent) -> (Seen, State) {
    let mut simulation = simulation(scene, extent);
    let required = simulation.layout.required.clone();
    let mut seen = Seen { tilts: vec![0.0; scene.blocks.len()], required, ..Seen::default() };
    let ended = simulation.run(&mut [&mut seen]).unwrap();
    assert_eq!(ended, Ended::Complete);
    (seen, simulation.state)
}

/// Runs both; the numbers must be the same to the last bit.
fn same(scene: &Scene) -> Seen {
    let (full, required) = (run(scene, Extent::Full).0, run(scene, Extent::Required).0);
    assert!(full.required.removed.is_empty(), "the full model has all");
    assert!(required.steps > 0);
    assert_eq!((full.hash, full.steps), (required.hash, required.steps), "{:#?}", required.required.removed);
    required
}

fn scenarios() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios");
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    files.sort();
    let name = |path: &Path| path.file_stem().unwrap().to_string_lossy().into_owned();
    files.iter().map(|path| (name(path), std::fs::read_to_string(path).unwrap())).collect()
}

#[test]
fn every_scenario_has_the_same_numbers_in_the_full_model() {
    for (name, text) in scenarios() {
        for scheme in ["moreau-jean", "moreau-jean-closed"] {
            let seen = same(&scene(&text, &[("time.scheme", scheme)]));
            assert!(!seen.broken, "{name} {scheme}: {:?}", seen.required.limits);
        }
    }
}

/// Numbers in a fixed order that looks like none.
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

fn has_removed(seen: &Seen, what: &str) -> bool {
    seen.required.removed.iter().any(|removed| removed.what.contains(what))
}

const MATERIALS: &str = "[material.a]\ndensity = '2700 kg/m^3'\nyoungs_modulus = '69 GPa'\n";

const TABLE: &str = "[beam.table]\nmaterial = 'a'\nspan = '36 cm'\nwidth = '3 cm'\nthickness = '0.15 cm'\nelements = 6\n\
    damping_ratio = { mode = 1, ratio = 0.01 }\n";

#[test]
fn a_flight_that_misses_is_no_contact_and_one_that_hits_is() {
    let mut dice = Dice(1);
    let (mut removed, mut kept) = (0, 0);
    for _ in 0..300 {
        let [incline, gx, gy] = [(-30.0, 30.0), (-3.0, 3.0), (-12.0, 3.0)].map(|(low, high)| dice.between(low, high));
        let [x, y] = [dice.between(-0.6, 0.6), dice.between(0.1, 0.9)];
        let [vx, vy, spin] = [(-2.0, 2.0), (-2.0, 2.0), (-8.0, 8.0)].map(|(low, high)| dice.between(low, high));
        let spin = if dice.next() < 0.5 { 0.0 } else { spin };
        let (theta, end) = (dice.between(0.5, 1.0), dice.between(0.05, 0.5));
        let text = format!(
            "[time]\nend = '{end} s'\nstep = '2 ms'\ntheta = {theta}\n[world]\ngravity = ['{gx} m/s^2', '{gy} m/s^2']\n\
             {MATERIALS}{TABLE}position = ['-0.18 m', '-0.2 m']\n[ground]\nincline = '{incline} deg'\n\
             [block.b]\nmaterial = 'a'\nwidth = '4 cm'\nheight = '10 cm'\ndepth = '3 cm'\nposition = ['{x} m', '{y} m']\n\
             angle = '{} rad'\nvelocity = ['{vx} m/s', '{vy} m/s']\nspin = '{spin} rad/s'\n\
             [contact.g]\nbetween = ['b', 'ground']\nfriction = 0.4\nrestitution = 0.5\n\
             [contact.t]\nbetween = ['b', 'table']\nfriction = 0.4\n",
            dice.between(-1.5, 1.5)
        );
        let resolved = load(text.as_bytes(), "scene", "scene", &[]).unwrap_or_else(|errors| panic!("{errors}"));
        // Some start in the incline.
        if Simulation::new(&resolved.scene).is_err() {
            continue;
        }
        let seen = same(&resolved.scene);
        removed += usize::from(has_removed(&seen, "`g`: all"));
        kept += usize::from(!has_removed(&seen, "`g`: all"));
    }
    assert!(removed > 30 && kept > 30, "{removed} {kept}");
}

#[test]
fn what_nothing_touches_rests_and_takes_no_dofs() {
    let text = format!(
        "[time]\nend = '0.2 s'\nstep = '100 us'\n{MATERIALS}{TABLE}{}position = ['1 m', '0 m']\naxial = 'held'\n[ground]\n\
         [block.b]\nmaterial = 'a'\nwidth = '10 cm'\nheight = '5 cm'\ndepth = '3 cm'\non = 'table'\nat = '18 cm'\n\
         [contact.t]\nbetween = ['b', 'table']\nfriction = 0.4\n[contact.s]\nbetween = ['b', 'shelf']\nfriction = 0.4\n\
         [contact.g]\nbetween = ['b', 'ground']\nfriction = 0.4\n",
        TABLE.replace("table", "shelf")
    );
    let on_table = scene(&text, &[("beam.table.position", "['0 m', '20 cm']")]);
    let seen = same(&on_table);
    assert!(has_removed(&seen, "beam `shelf`") && has_removed(&seen, "`s`: all"), "{:#?}", seen.required);
    assert!(has_removed(&seen, "`g`: all") && has_removed(&seen, "`t`: the upper"), "{:#?}", seen.required);
    let (full, less) = (simulation(&on_table, Extent::Full), simulation(&on_table, Extent::Required));
    assert_eq!((full.dofs(), less.dofs()), (3 + 12 + 12, 3 + 12));
    // Four corners of each pair, two of the one that stays; and for each of four sides of a block on
    // a beam two ends, of roundings as well, and eight humps.
    let sides = 4 * (4 + 8);
    assert_eq!((full.model.detector().capacity(), less.model.detector().capacity()), (12 + 2 * sides, 2 + sides));
    assert_eq!(full.state, less.state, "the state has its places all the same");
    // Each of these moves it.
    for pairs in [
        [("beam.shelf.self_weight", "true")],
        [("beam.shelf.position", "['0.1 m', '0.19 m']")],
        [("beam.shelf.motion", "{ velocity = ['0 m/s', '1 m/s'], signal = 'shake' }")],
        [("load.l", "{ on = 'shelf', at = '10 cm', force = '-1 N', signal = 'shake' }")],
    ] {
        let text = format!("{text}[signal.shake]\nshape = 'harmonic'\nfrequency = '3 Hz'\n");
        let mut all = vec![("beam.table.position", "['0 m', '20 cm']")];
        all.extend(pairs);
        let seen = same(&scene(&text, &all));
        let about_shelf = if pairs[0].0.ends_with("position") { "`s`: all" } else { "beam `shelf`" };
        assert!(!has_removed(&seen, about_shelf), "{pairs:?} {:#?}", seen.required);
    }
}

#[test]
fn a_beam_in_equilibrium_rests_within_the_stated_accuracy() {
    let text = format!(
        "[time]\nend = '1 s'\nstep = '500 us'\n{MATERIALS}{}self_weight = true\nstart = 'static'\n",
        TABLE.replace("elements = 6", "elements = 24")
    );
    let scene = scene(&text, &[]);
    let ((full, at_end), (seen, rest)) = (run(&scene, Extent::Full), run(&scene, Extent::Required));
    let accuracy = seen.required.removed[0].accuracy.clone().unwrap();
    let stated: f64 = accuracy.split(' ').next().unwrap().parse().unwrap();
    let place = &simulation(&scene, Extent::Full).layout.beams[0];
    let off: Vec<f64> = at_end.q.iter().zip(&rest.q).map(|(a, b)| a - b).collect();
    let off = place.beam.to_nodes(&off).iter().map(|[w, _]| w.abs()).fold(0.0, f64::max);
    let deflection = place.beam.to_nodes(&rest.q).iter().map(|[w, _]| w.abs()).fold(0.0, f64::max);
    assert!(off <= stated && stated <= 1e-9 * deflection, "{off:e} m off, {stated:e} m stated");
    assert!(full.hash != seen.hash && off > 0.0, "the full model trembles");
}

/// The paper's scene with a coarser mesh.
fn rocking(pairs: &[(&str, &str)]) -> Scene {
    let mut all = vec![("beam.table.elements", "6"), ("time.end", "0.4 s")];
    all.extend(pairs);
    scene(ROCKING, &all)
}

const UPPER: &str = "the upper corners";

#[test]
fn a_block_that_can_tip_over_keeps_its_upper_corners() {
    let kept = |pairs: &[(&str, &str)]| {
        let seen = same(&rocking(pairs));
        assert!(!has_removed(&seen, UPPER), "{pairs:?} {:#?}", seen.required);
        seen
    };
    assert!(has_removed(&same(&rocking(&[])), UPPER));
    // It does tip over.
    let seen = kept(&[("beam.table.start", "undeformed")]);
    assert!(seen.tilts[0] > 0.23, "{:?}", seen.tilts);
    kept(&[("block.rocker.tilt", "10 deg")]);
    kept(&[("block.rocker.spin", "3 rad/s")]);
    kept(&[("block.rocker.velocity", "['0.4 m/s', '0 m/s']")]);
    // Off the end of the beam it may fall.
    kept(&[("block.rocker.at", "4 cm")]);
    kept(&[("block.rocker.at", "18 cm"), ("time.end", "2 s")]);
    // These give energy, or may; or the bounds aren't for them.
    kept(&[("contact.feet.restitution", "0.2")]);
    let compliant = "law = 'kelvin-voigt'\nstiffness = '1e6 N/m'\ndamping = '10 N s/m'";
    let compliant = scene(&ROCKING.replace("restitution = 0.0", compliant), &[("beam.table.elements", "6")]);
    assert!(!has_removed(&same(&compliant), UPPER));
    kept(&[("beam.table.surface", "top")]);
    kept(&[("beam.table.self_weight", "true")]);
    kept(&[("world.gravity", "['0.1 m/s^2', '-9.81 m/s^2']"), ("block.rocker.tilt", "3 deg")]);
    kept(&[("force.f", "{ on = 'rocker', force = ['0.1 N', '0 N'] }")]);
    kept(&[("beam.table.axial", "elastic")]);
    kept(&[("time.step", "5 ms"), ("beam.table.elements", "1")]);
    kept(&[("time.theta", "0.4"), ("time.allow_conditional_stability", "true"), ("time.end", "60 ms")]);
}

#[test]
fn a_block_at_the_edge_of_tipping_over_is_not_taken_for_one_that_can_not() {
    let mut dice = Dice(2);
    let (mut removed, mut tipped) = (0, 0);
    for k in 0..120 {
        let (height, width) = (dice.between(5.0, 15.0), dice.between(2.0, 8.0));
        let critical = (width / height).atan();
        let (tilt, spin) = (critical * dice.between(-1.0, 1.0), dice.between(-8.0, 8.0));
        let (start, kinematics) =
            (["static", "undeformed"][k % 2], ["deformed", "linear"][usize::from(dice.next() < 0.3)]);
        let scheme = ["moreau-jean", "moreau-jean-closed"][usize::from(dice.next() < 0.5)];
        let on = ["table", "ground"][usize::from(dice.next() < 0.5)];
        let text = format!(
            "[time]\nend = '0.4 s'\nstep = '200 us'\nscheme = '{scheme}'\n{MATERIALS}{TABLE}start = '{start}'\n\
             position = ['-18 cm', '0 m']\n[ground]\n\
             [block.b]\nmaterial = 'a'\nwidth = '{width} cm'\nheight = '{height} cm'\ndepth = '1 cm'\non = '{on}'\n\
             at = '{} cm'\ntilt = '{tilt} rad'\nspin = '{} rad/s'\n\
             [contact.c]\nbetween = ['b', '{on}']\nfriction = {}\nkinematics = '{kinematics}'\n",
            dice.between(-4.0, 4.0),
            if dice.next() < 0.5 { 0.0 } else { spin },
            dice.between(0.0, 1.0)
        );
        let resolved = load(text.as_bytes(), "scene", "scene", &[]).unwrap_or_else(|errors| panic!("{errors}"));
        // Some have no static start.
        if Simulation::new(&resolved.scene).is_err() {
            continue;
        }
        let seen = same(&resolved.scene);
        assert!(!seen.broken, "{text} {:?}", seen.required);
        let is_removed = has_removed(&seen, UPPER);
        assert!(!is_removed || seen.tilts[0] < critical, "{text}");
        removed += usize::from(is_removed);
        tipped += usize::from(seen.tilts[0] > critical);
    }
    assert!(removed > 20 && tipped > 5, "{removed} {tipped}");
}

#[test]
fn a_run_that_leaves_its_limits_shows_it() {
    let scene = rocking(&[]);
    let mut kicked = simulation(&scene, Extent::Required);
    kicked.state.v[2] += 8.0;
    let required = kicked.layout.required.clone();
    let mut seen = Seen { tilts: vec![0.0], required, ..Seen::default() };
    assert_eq!(kicked.run(&mut [&mut seen]).unwrap(), teeter_integrator::Ended::Complete);
    assert!(seen.broken && seen.tilts[0] > 0.3, "{seen:?}");
}

/// Beams that are deformed between their nodes alone, or along their axis alone, are not at rest.
#[test]
fn a_beam_that_is_deformed_by_any_of_its_dofs_moves() {
    let beam = |elements: usize, rest: &str| {
        format!(
            "[time]\nend = '20 ms'\nstep = '100 us'\n[world]\ngravity = ['9.81 m/s^2', '0 m/s^2']\n[beam.t]\nsection = 'direct'\n\
             bending_stiffness = '0.2 N m^2'\nmass_per_length = '0.08 kg/m'\naxial_stiffness = '1 MN'\nspan = '36 cm'\nelements = {elements}\n{rest}"
        )
    };
    let mode = "start = { mode = 1, amplitude = '1 mm' }\n";
    let two_spans = format!("{mode}[beam.t.support.middle]\nat = '18 cm'\nkind = 'pinned'\n");
    let file = "start = { file = 'shape.csv' }\n";
    let along = "axial = 'elastic'\nself_weight = true\n";
    for (elements, rest) in [(1, mode), (2, &two_spans), (1, file), (2, along), (3, along)] {
        let text = beam(elements, rest);
        let mut read = |_: &str| Ok(b"0,0,0.01\n0.36,0,0.002\n".to_vec());
        let loaded = teeter_scenario::load_with(text.as_bytes(), "scene", "scene", &[], &mut read);
        let scene = loaded.unwrap_or_else(|errors| panic!("{errors}")).scene;
        let start = simulation(&scene, Extent::Required).state;
        let seen = same(&scene);
        assert!(seen.required.removed.is_empty(), "{text} {:#?}", seen.required.removed);
        assert_ne!(run(&scene, Extent::Required).1.q, start.q, "{text}");
    }
}

/// What grows from rounding is not at rest.
#[test]
fn an_unstable_scheme_moves_a_beam_from_its_equilibrium() {
    let scene = scene(
        &format!("{MATERIALS}{TABLE}self_weight = true\nstart = 'static'\n[time]\nend = '50 ms'\nstep = '1 ms'\n"),
        &[("time.theta", "0.1"), ("time.allow_conditional_stability", "true")],
    );
    assert!(!has_removed(&same(&scene), "its motion"));
}

/// A beam with one element has no deflection at its nodes: the bulge of its own weight in gravity
/// that points up is between them.
#[test]
fn a_block_hits_a_beam_that_bulges_between_its_nodes() {
    let text = "[time]\nend = '0.3 s'\nstep = '100 us'\n[world]\ngravity = ['0 m/s^2', '9.81 m/s^2']\n[beam.t]\nsection = 'direct'\n\
        bending_stiffness = '0.02 N m^2'\nmass_per_length = '0.08 kg/m'\nspan = '36 cm'\nelements = 1\nself_weight = true\n\
        start = 'static'\n[material.a]\ndensity = '2700 kg/m^3'\n[block.b]\nmaterial = 'a'\nwidth = '2 cm'\nheight = '2 cm'\n\
        depth = '1 cm'\nposition = ['0.18 m', '0.31 m']\nvelocity = ['0 m/s', '-2.40 m/s']\n\
        [contact.c]\nbetween = ['b', 't']\nfriction = 0.3\n";
    let scene = scene(text, &[]);
    let bulge = simulation(&scene, Extent::Full);
    let highest = bulge.layout.beams[0].beam.deflection_extremes(&bulge.state.q[3..]).highest;
    // It turns back at 0.3 m − v²/2g over the axis.
    let turns = 0.3 - 2.40f64.powi(2) / (2.0 * 9.81);
    assert!(0.0 < turns && turns < highest, "{turns} {highest}");
    let seen = same(&scene);
    assert!(seen.required.removed.is_empty(), "{:#?}", seen.required.removed);
}
