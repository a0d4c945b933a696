//! Random scenes made to be on the border of what may be left out, with and without it: the same
//! bytes where a removal is called exact, and beams within the stated accuracy of their rest
//! elsewhere.
//!
//! `TEETER_REQUIRED=2000` tries so many scenes from which something is removed,
//! `TEETER_REQUIRED_SEED=7` others.

use super::{Dice, MATERIALS, simulation};
use std::fmt::Write as _;
use std::ops::ControlFlow;
use teeter_integrator::{Ended, Model, Observer, ObserverError, State, StepReport};
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::{BeamPlace, Simulation};
use teeter_scenario::{Extent, load_with};

/// Scenes with removals in CI.
const FEW: usize = 100;

/// Draws for each of them at most.
const DRAWS: usize = 20;

impl Dice {
    fn is(&mut self, chance: f64) -> bool {
        self.next() < chance
    }

    fn one_of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[(self.next() * choices.len() as f64) as usize]
    }

    /// Of both signs, some 0.
    fn about(&mut self, most: f64) -> f64 {
        if self.is(0.4) { 0.0 } else { self.between(-most, most) }
    }
}

/// A run, step by step.
struct Trace<'a> {
    /// Coordinates, velocities, energies and contacts up to each step, in one number each.
    all: Vec<u64>,
    /// The same of all but the beams whose rest is not exact, and the energies.
    others: Vec<u64>,
    /// The beams whose rest is not exact: their places, start, and how far any of their points was
    /// from it, m.
    resting: Vec<(&'a BeamPlace, Vec<f64>, f64)>,
    /// The first step that is past the limits of the model.
    broken: Option<usize>,
    limits: Option<teeter_scenario::Limits>,
    hash: [u64; 2],
}

fn mix(hash: &mut u64, x: f64) {
    *hash = (*hash ^ x.to_bits()).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(17);
}

impl Observer<2> for Trace<'_> {
    fn observe(
        &mut self,
        _: &Model<2>,
        step: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError> {
        let energy = state.ledger.current;
        let account = [energy.kinetic, energy.elastic, energy.gravity, step.energy().contact];
        account.iter().for_each(|x| mix(&mut self.hash[0], *x));
        let rests = |k: usize| self.resting.iter().any(|(place, ..)| place.range.contains(&k));
        for (k, (q, v)) in state.q.iter().zip(&state.v).enumerate() {
            for x in [*q, *v] {
                mix(&mut self.hash[0], x);
                if !rests(k) {
                    mix(&mut self.hash[1], x);
                }
            }
        }
        for contact in step.contacts() {
            let id = contact.id.pair() as f64 + 0.1 * contact.id.point() as f64;
            let numbers = contact.p.iter().chain(contact.u_after.iter()).chain([&step.penetration, &id]);
            numbers.for_each(|x| self.hash.iter_mut().for_each(|hash| mix(hash, *x)));
        }
        for (place, start, most) in &mut self.resting {
            let off: Vec<f64> = state.q[place.range.clone()].iter().zip(&*start).map(|(q, start)| q - start).collect();
            *most = most.max(place.beam.deflection_extremes(&off).largest());
        }
        self.all.push(self.hash[0]);
        self.others.push(self.hash[1]);
        if self.limits.is_some_and(|limits| !limits.hold(state)) {
            self.broken.get_or_insert(self.all.len());
        }
        Ok(ControlFlow::Continue(()))
    }
}

/// What was found of a scene.
struct Found {
    exact: bool,
    broken: bool,
    barrier: bool,
    /// A contact with a beam.
    contact: bool,
    beam: bool,
}

/// Runs a scene in both models; `None` where nothing is removed.
fn compare(scene: &Scene, text: &str) -> Option<Found> {
    let mut less = Simulation::new(scene).ok()?;
    let required = less.layout.required.clone();
    if required.removed.is_empty() {
        return None;
    }
    let mut full = simulation(scene, Extent::Full);
    let stated: Vec<(String, f64)> = required
        .removed
        .iter()
        .filter_map(|removed| {
            let accuracy = removed.accuracy.as_ref()?.split(' ').next()?.parse().unwrap();
            Some((removed.what.clone(), accuracy))
        })
        .collect();
    let layouts = [full.layout.clone(), less.layout.clone()];
    let start = full.state.q.clone();
    let trace = |of: usize| {
        let beams = layouts[of].beams.iter().filter(|place| {
            let what = format!("beam `{}`: its motion", place.name);
            stated.iter().any(|(stated, _)| *stated == what)
        });
        let resting = beams.map(|place| (place, start[place.range.clone()].to_vec(), 0.0)).collect();
        let limits = (of == 1).then_some(required.limits).flatten();
        Trace { all: Vec::new(), others: Vec::new(), resting, broken: None, limits, hash: [0; 2] }
    };
    let mut traces = [trace(0), trace(1)];
    let ended = |ended: Ended| assert_eq!(ended, Ended::Complete, "{text}");
    ended(full.run(&mut [&mut traces[0]]).unwrap());
    ended(less.run(&mut [&mut traces[1]]).unwrap());
    let [full, less] = &traces;
    // Past its limits the model says so, and claims nothing.
    let steps = less.broken.unwrap_or(less.all.len());
    let (a, b) = if stated.is_empty() { (&full.all, &less.all) } else { (&full.others, &less.others) };
    let parted = (0..steps).find(|k| a.get(*k) != b.get(*k));
    assert_eq!(parted, None, "the models part at this step of {steps}\n{:#?}\n{text}", required.removed);
    for (place, _, moved) in &full.resting {
        let accuracy = stated.iter().find(|(what, _)| what.contains(&format!("`{}`", place.name))).unwrap().1;
        assert!(*moved <= accuracy, "{moved:e} m, {accuracy:e} m stated\n{text}");
    }
    let has = |what: &str| required.removed.iter().any(|removed| removed.what.contains(what));
    let on_beam = |what: &str| what.contains("-table`: all") || what.contains("-shelf`: all");
    let contact = required.removed.iter().any(|removed| on_beam(&removed.what));
    let (barrier, beam) = (has("upper corners"), has("its motion"));
    Some(Found { exact: stated.is_empty(), broken: less.broken.is_some(), barrier, contact, beam })
}

/// Up to where a beam may start deflected, in parts of its span.
const BULGE: f64 = 0.05;

/// What a scene is for.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// Stiff beams, slow blocks that stand, nothing that gives energy: blocks may stay in their
    /// wells.
    Calm,
    /// Anything, with theta = 0.5.
    Wild,
    /// Anything, with another theta, which no beam held along its axis takes.
    Damped,
}

/// A beam: its table, and the table of its shape where that is of a file.
fn beam(dice: &mut Dice, name: &str, [x, y]: [f64; 2], span: f64, kind: Kind) -> (String, Option<String>) {
    let calm = kind == Kind::Calm;
    let elements = dice.one_of(&[1, 1, 1, 2, 2, 3]);
    let [thin, thick] = if calm { [-2.3, -1.3] } else { [-3.3, -2.0] };
    let thickness = 10f64.powf(dice.between(thin, thick)) * span;
    let mut text = format!(
        "[beam.{name}]\nmaterial = 'a'\nspan = '{span} m'\nwidth = '3 cm'\nthickness = '{thickness} m'\n\
         position = ['{x} m', '{y} m']\n"
    );
    let mut put = |line: String| writeln!(text, "{line}").unwrap();
    // Nodes where an inner support is, too: all that a shape by file needs to know.
    let inner = dice.is(0.25).then(|| dice.between(0.3, 0.7));
    let mut nodes: Vec<f64> = (0..=elements).map(|k| k as f64 / elements as f64).collect();
    if let Some(at) = inner {
        nodes.push(at);
        nodes.sort_by(f64::total_cmp);
        nodes.dedup_by(|a, b| (*a - *b).abs() < 0.02 && *a != at);
    }
    let places: Vec<f64> = nodes.iter().map(|part| part * span).collect();
    let listed: Vec<String> = places.iter().map(|x| format!("'{x} m'")).collect();
    put(format!("nodes = [{}]", listed.join(", ")));
    let elastic = "{ spring = '3 kN/m', rotational_spring = '1 N m/rad' }";
    let supports = [
        dice.one_of(&["'pinned'", "'pinned'", "'clamped'", elastic]),
        dice.one_of(&["'pinned'", "'pinned'", "'clamped'", "'free'", "'guided'", elastic]),
    ];
    put(format!("supports = [{}, {}]", supports[0], supports[1]));
    let mut tail = String::new();
    if let Some(at) = inner.and_then(|at| nodes.iter().position(|x| *x == at)) {
        write!(tail, "[beam.{name}.support.s]\nat = '{} m'\nkind = 'pinned'\n", places[at]).unwrap();
    }
    if dice.is(0.15) {
        let stiffness = dice.between(1.0, 1e4);
        write!(tail, "[beam.{name}.foundation.f]\nfrom = '0 m'\nto = '{span} m'\nstiffness = '{stiffness} N/m^2'\n")
            .unwrap();
    }
    let axial = match (dice.is(0.75), kind) {
        (true, _) => "free",
        (_, Kind::Damped) => "elastic",
        _ => dice.one_of(&["held", "elastic"]),
    };
    put(format!("axial = '{axial}'"));
    if dice.is(0.2) {
        put(format!("axial_force = '{} N'", dice.between(-0.05, 20.0)));
    }
    if dice.is(0.5) {
        put("damping_ratio = { mode = 1, ratio = 0.02 }".to_owned());
    }
    if axial != "held" && dice.is(0.15) {
        put("model = 'modes'\nmodes = { count = 1 }".to_owned());
    }
    if dice.is(0.15) {
        put("surface = 'top'".to_owned());
    }
    let sags = !calm && dice.is(0.5);
    if !calm {
        if sags || dice.is(0.2) {
            put("self_weight = true".to_owned());
        }
        if dice.is(0.1) {
            let axis = dice.one_of(&["['0 m/s', '0.2 m/s']", "['0.1 m/s', '0 m/s']"]);
            put(format!("motion = {{ velocity = {axis}, signal = 'shake' }}"));
        }
    }
    let clamped = |k: usize| supports[k] == "'clamped'" || supports[k] == "'guided'";
    let slope = |dice: &mut Dice, k: usize| match k {
        0 if clamped(0) => 0.0,
        k if k + 1 == nodes.len() && clamped(1) => 0.0,
        _ => dice.about(if calm { 0.02 } else { 4.0 } * BULGE),
    };
    let starts: &[i32] = match (calm, sags) {
        (true, _) => &[0, 0, 1, 1, 2, 3],
        (_, true) => &[1, 1, 1, 1, 2, 3],
        _ => &[0, 1, 2, 3, 3],
    };
    let file = match dice.one_of(starts) {
        0 => None,
        1 => {
            put("start = 'static'".to_owned());
            None
        }
        2 => {
            let amplitude = dice.about(if calm { 0.01 } else { 1.0 } * BULGE * span);
            put(format!("start = {{ mode = 1, amplitude = '{amplitude} m' }}"));
            None
        }
        _ => {
            put(format!("start = {{ file = '{name}.csv' }}"));
            let rows = (0..places.len()).map(|k| format!("{},0,{}\n", places[k], slope(dice, k)));
            Some(rows.collect())
        }
    };
    (text + &tail, file)
}

/// A scene, and the files that it names.
fn draw(dice: &mut Dice) -> (String, Vec<(String, String)>) {
    let kind = dice.one_of(&[Kind::Calm, Kind::Calm, Kind::Wild, Kind::Wild, Kind::Damped]);
    let calm = kind == Kind::Calm;
    let down = if calm {
        [0.0, -dice.between(1.0, 12.0)]
    } else {
        dice.one_of(&[[0.0, -9.81], [0.0, 9.81], [0.0, 9.81], [9.81, 0.0], [-4.0, 3.0], [0.0, 0.0]])
    };
    let (theta, closed) = match kind {
        Kind::Damped => (dice.between(0.5, 1.0), false),
        _ => (0.5, dice.is(0.4)),
    };
    let step = dice.one_of(if calm { &[20e-6, 50e-6, 200e-6] } else { &[50e-6, 200e-6, 1e-3] });
    let steps = if calm { 400 } else { dice.one_of(&[100, 150, 400]) };
    let scheme = if closed { "scheme = 'moreau-jean-closed'".to_owned() } else { format!("theta = {theta}") };
    let mut text = format!(
        "[time]\nend = '{} s'\nstep = '{step} s'\n{scheme}\n[world]\ngravity = ['{} m/s^2', '{} m/s^2']\n{MATERIALS}\
         [signal.shake]\nshape = 'harmonic'\nfrequency = '30 Hz'\n",
        step * f64::from(steps),
        down[0],
        down[1]
    );
    if dice.is(0.15) && !closed {
        text = text.replace("[world]", &format!("gap_tolerance = '{} m'\n[world]", dice.one_of(&[0.0, 1e-4, 1e-6])));
    }
    let moving_ground = !calm && dice.is(0.15);
    writeln!(text, "[ground]\nincline = '{} deg'", if calm { 0.0 } else { dice.about(20.0) }).unwrap();
    if moving_ground {
        writeln!(text, "motion = {{ velocity = ['0.1 m/s', '0.1 m/s'], signal = 'shake' }}").unwrap();
    }
    let span = dice.between(0.2, 1.0);
    let level = dice.between(0.8, 1.0);
    let mut files = Vec::new();
    let two = dice.is(0.6);
    let shelf = [dice.between(-0.5, 1.2) * span, level + dice.about(0.1)];
    for (name, place) in [("table", [0.0, level]), ("shelf", shelf)].into_iter().take(1 + usize::from(two)) {
        let (table, file) = beam(dice, name, place, span, kind);
        text.push_str(&table);
        files.extend(file.map(|rows| (format!("{name}.csv"), rows)));
    }
    if !calm && dice.is(0.15) {
        let on = if two { dice.one_of(&["table", "shelf"]) } else { "table" };
        writeln!(
            text,
            "[load.l]\non = '{on}'\nat = '{} m'\nforce = '-1 N'\nsignal = 'shake'",
            dice.between(0.1, 0.9) * span
        )
        .unwrap();
    }
    let blocks = if dice.is(0.3) { 2 } else { 1 };
    for k in 0..blocks {
        let [width, height] = [dice.between(0.02, 0.15) * span, dice.between(0.05, 0.3) * span];
        writeln!(text, "[block.b{k}]\nmaterial = 'a'\nwidth = '{width} m'\nheight = '{height} m'\ndepth = '2 cm'")
            .unwrap();
        let critical = width.atan2(height);
        let spin = if dice.is(0.6) { 0.0 } else { dice.about(5.0) };
        let over = if two && dice.is(0.6) { shelf } else { [0.0, level] };
        let x = over[0] + span * dice.between(-0.2, 1.2).clamp(0.0, if k == 0 { 0.45 } else { 1.2 });
        if dice.is(if calm { 0.85 } else { 0.5 }) {
            let on = dice.one_of(&["table", "table", "ground"]);
            let at = if on == "table" { span * (0.3 + 0.4 * k as f64) } else { x };
            let tilt = if dice.is(0.4) { 0.0 } else { critical * dice.between(-1.0, 1.0) };
            let spin = if calm { 0.3 * spin } else { spin };
            writeln!(text, "on = '{on}'\nat = '{at} m'\ntilt = '{tilt} rad'\nspin = '{spin} rad/s'").unwrap();
        } else {
            // So high that it turns back, or the run ends, near the surface.
            let (angle, lowest) =
                if dice.is(0.5) { (0.0, 0.5 * height) } else { (dice.between(-1.5, 1.5), 0.5 * width.hypot(height)) };
            let clear = dice.between(0.02, 0.2) * span;
            let time = step * f64::from(steps);
            let bulge = clear - dice.between(-0.3, 1.2) * BULGE * span;
            let speed = if down[1] > 0.0 {
                (2.0 * down[1] * bulge.max(0.0)).sqrt()
            } else {
                (bulge / time + 0.5 * down[1] * time).clamp(-5.0, 5.0)
            };
            let from_below = dice.is(0.15);
            let (x, y, speed) = if from_below {
                (over[0] - dice.between(0.02, 0.3) * span - lowest, over[1] - clear, -speed)
            } else {
                (x, over[1] + clear + lowest, speed)
            };
            let across = if from_below { dice.between(0.0, 2.0) } else { dice.about(0.5) };
            writeln!(
                text,
                "position = ['{x} m', '{y} m']\nangle = '{angle} rad'\nvelocity = ['{across} m/s', '{} m/s']\nspin = '{spin} rad/s'",
                -speed
            )
            .unwrap();
        }
        let restitution = if calm { 0.0 } else { dice.one_of(&[0.0, 0.5, 0.9]) };
        for on in ["ground", "table", "shelf"].into_iter().take(if two { 3 } else { 2 }) {
            let kinematics = dice.one_of(&["deformed", "deformed", "linear"]);
            writeln!(
                text,
                "[contact.b{k}-{on}]\nbetween = ['b{k}', '{on}']\nfriction = 0.4\nrestitution = {restitution}\nkinematics = '{kinematics}'"
            )
            .unwrap();
        }
        if !calm && dice.is(0.1) {
            writeln!(text, "[force.f{k}]\non = 'b{k}'\nforce = ['0.1 N', '0 N']\nsignal = 'shake'").unwrap();
        }
    }
    (text, files)
}

fn number(name: &str, otherwise: usize) -> usize {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(otherwise)
}

#[test]
fn random_scenes_have_the_same_bytes_in_the_full_model() {
    let count = number("TEETER_REQUIRED", FEW);
    let mut dice = Dice(number("TEETER_REQUIRED_SEED", 3) as u64);
    let (mut removed, mut draws, mut refused) = (0, 0, Vec::new());
    let (mut exact, mut broken, mut barriers, mut contacts, mut beams) = (0, 0, 0, 0, 0);
    while removed < count && draws < DRAWS * count {
        draws += 1;
        let (text, files) = draw(&mut dice);
        let mut read = |name: &str| {
            let file = files.iter().find(|(file, _)| file == name).ok_or("no such file")?;
            Ok(file.1.clone().into_bytes())
        };
        // Some have no static start, or overlap.
        let resolved = match load_with(text.as_bytes(), "scene", "scene", &[], &mut read) {
            Ok(resolved) => resolved,
            Err(errors) => {
                refused.push(errors.to_string());
                continue;
            }
        };
        let Some(found) = compare(&resolved.scene, &format!("{text}\n{files:?}")) else { continue };
        // Ground that is far below is no news.
        if !(found.contact || found.beam || found.barrier) {
            continue;
        }
        removed += 1;
        exact += usize::from(found.exact);
        broken += usize::from(found.broken);
        barriers += usize::from(found.barrier);
        contacts += usize::from(found.contact);
        beams += usize::from(found.beam);
    }
    eprintln!(
        "{removed} of {draws} scenes with removals: {exact} exact, {broken} past their limits; contacts {contacts}, beams {beams}, upper corners \
         {barriers}; {} refused, the first: {:?}",
        refused.len(),
        refused.first()
    );
    assert!(removed == count, "{removed} of {draws} scenes have removals");
    assert!(3 * refused.len() < draws, "most draws should be scenes");
    let part = count / 15;
    assert!(contacts > part && beams > part && barriers > part && removed - exact > part / 8, "each kind of removal");
}
