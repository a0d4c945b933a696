//! Settings of a scene that trade speed for accuracy: one entry per axis. A scene has those that
//! apply to it.
//!
//! Schemes, kinematics and solvers are the words of scene files, so new ones are included
//! automatically.

use crate::Setting;
use teeter_scenario::document::Document;
use teeter_scenario::keys::{self, Kind, PathTarget};
use teeter_scenario::resolve::Resolved;
use teeter_scenario::scene::{BeamScene, ContactScene, Scene, SchemeName, SupportingBody};

/// An axis of settings.
#[derive(Debug, Clone, PartialEq)]
pub struct SettingAxis {
    /// Its name.
    pub name: &'static str,
    /// The keys that it changes.
    pub keys: Vec<String>,
    /// Its options; the scene's own has no keys.
    pub options: Vec<Setting>,
}

impl SettingAxis {
    /// A setting with another option of this axis.
    #[must_use]
    pub fn apply(&self, option: &Setting, to: &Setting) -> Setting {
        to.clone().without(&self.keys).with(option)
    }

    /// The part of a setting on this axis.
    #[must_use]
    pub fn part_of(&self, setting: &Setting) -> Setting {
        let others: Vec<String> =
            setting.pairs().into_iter().map(|(key, _)| key).filter(|key| !self.keys.contains(key)).collect();
        setting.clone().without(&others)
    }
}

/// The axes of a scene. Those of the grid are tried in all combinations, as the cheapest option on
/// one axis depends on the others: with a coarse mesh few modes suffice, with few modes a long
/// step. The others are tried one at a time.
#[derive(Debug, Clone, PartialEq)]
pub struct Axes {
    /// The time schemes.
    pub scheme: SettingAxis,
    /// The steps, from coarse to fine.
    pub step: SettingAxis,
    /// The other axes of the grid that the scene has.
    pub grid: Vec<SettingAxis>,
    /// The axes outside the grid that the scene has.
    pub others: Vec<SettingAxis>,
}

/// Creates an axis, if a scene has it.
type Make = fn(&Resolved) -> Option<SettingAxis>;
/// The registry of the grid, besides scheme and step.
const GRID: [Make; 3] = [theta, mesh, modes];
/// The registry of the others.
const OTHERS: [Make; 3] = [kinematics, solver, tolerance];

/// Steps as multiples of the scene's own, from coarse to fine.
const STEPS: [f64; 12] = [50.0, 20.0, 10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01];
/// Least number of steps of a run.
const FEWEST_STEPS: f64 = 20.0;

/// Values of θ that are tried: no dissipation, some, most.
const THETAS: [f64; 3] = [0.5, 0.6, 1.0];
/// Elements as multiples of the scene's own.
const MESHES: [f64; 4] = [0.25, 0.5, 1.0, 2.0];
/// Numbers of modes; besides these, the default number is tried.
const MODES: [&str; 4] = ["4", "8", "16", "32"];
const TOLERANCES: [f64; 4] = [1e-4, 1e-6, 1e-10, 1e-13];
/// Contact solvers that are tried.
const QUICK: [&str; 3] = ["auto", "pgs", "enumeration"];

impl Axes {
    /// The axes of a scene.
    #[must_use]
    pub fn of(resolved: &Resolved) -> Self {
        let time = resolved.scene.time;
        let mut steps: Vec<f64> = STEPS.iter().map(|factor| factor * time.step).collect();
        steps.retain(|step| *step <= time.step || time.end / step >= FEWEST_STEPS);
        let key = "time.step".to_owned();
        let step = SettingAxis {
            name: "step",
            options: steps
                .iter()
                .map(|&h| if h == time.step { Setting::none() } else { Setting::none().set(&key, in_seconds(h)) })
                .collect(),
            keys: vec![key],
        };
        let taken = |scheme: &str| has_steps(scheme) && suits(scheme, &resolved.scene);
        let scheme = words(resolved, "scheme", &["time.scheme".to_owned()], taken).unwrap_or_else(|| SettingAxis {
            name: "scheme",
            keys: Vec::new(),
            options: vec![Setting::none()],
        });
        let made = |all: [Make; 3]| all.iter().filter_map(|axis| axis(resolved)).collect();
        Self { scheme, step, grid: made(GRID), others: made(OTHERS) }
    }

    /// All axes.
    pub fn iter(&self) -> impl Iterator<Item = &SettingAxis> {
        [&self.scheme, &self.step].into_iter().chain(&self.grid).chain(&self.others)
    }

    /// All combinations of the schemes with the options of the grid, without the steps: the scene's
    /// own first.
    #[must_use]
    pub fn combinations(&self) -> Vec<Setting> {
        let mut all = self.scheme.options.clone();
        for axis in &self.grid {
            all = all.iter().flat_map(|base| axis.options.iter().map(|option| axis.apply(option, base))).collect();
        }
        all
    }

    /// A setting with each of the steps, from coarse to fine.
    #[must_use]
    pub fn ladder(&self, setting: &Setting) -> Vec<Setting> {
        self.step.options.iter().map(|option| self.step.apply(option, setting)).collect()
    }

    /// The index of a setting's step on the ladder.
    pub(crate) fn rung(&self, setting: &Setting) -> Option<usize> {
        let step = self.step.part_of(setting);
        self.step.options.iter().position(|option| *option == step)
    }

    /// The same setting with the next finer step; `None` at the end of the ladder.
    #[must_use]
    pub fn finer(&self, setting: &Setting) -> Option<Setting> {
        Some(self.step.apply(self.step.options.get(self.rung(setting)? + 1)?, setting))
    }

    /// The settings that differ in one axis, the steps in one rung or two.
    pub(crate) fn neighbours(&self, setting: &Setting) -> Vec<Setting> {
        let ladder = self.ladder(setting);
        let steps = self.rung(setting).map_or(0..0, |rung| rung.saturating_sub(2)..(rung + 3).min(ladder.len()));
        let mut near = ladder[steps].to_vec();
        for axis in self.iter().filter(|axis| axis.name != self.step.name) {
            near.extend(axis.options.iter().map(|option| axis.apply(option, setting)));
        }
        near.retain(|one| one != setting);
        near
    }
}

/// A time in the syntax of scene files, in the unit that gives the shortest text.
#[must_use]
pub(crate) fn in_seconds(t: f64) -> String {
    const UNITS: [(f64, &str); 4] = [(1.0, "s"), (1e3, "ms"), (1e6, "us"), (1e9, "ns")];
    let (factor, unit) = UNITS.into_iter().find(|(factor, _)| t * factor >= 0.9995).unwrap_or(UNITS[3]);
    // Twelve digits, as multiples of a decimal step have, without the rounding of the product.
    let digits = format!("{:.11e}", t * factor).parse::<f64>().unwrap_or(t * factor);
    format!("{digits} {unit}")
}

/// Whether the step determines accuracy and work of a scheme: `auto` is another name of one of
/// them, and `event-driven` has its own steps.
fn has_steps(scheme: &str) -> bool {
    !["auto", teeter_integrator::EventDriven::NAME].contains(&scheme)
}

/// Whether a scheme suits a scene: `resolved` needs beams, without restitution there.
fn suits(scheme: &str, scene: &Scene) -> bool {
    let at_beams = || scene.contacts.iter().filter(|contact| matches!(contact.surface, SupportingBody::Beam(_)));
    scheme != SchemeName::Resolved.word() || (at_beams().next().is_some() && !at_beams().any(ContactScene::gives_back))
}

/// An axis of words of the table of keys, for all keys at once.
fn words(
    resolved: &Resolved,
    name: &'static str,
    keys: &[String],
    taken: impl Fn(&str) -> bool,
) -> Option<SettingAxis> {
    let Some(PathTarget::Key(_, key)) = keys.first().and_then(|key| keys::find(key)) else { return None };
    let Kind::Choice(words) = key.kind else { return None };
    let mut options = vec![Setting::none()];
    for word in words.iter().filter(|word| taken(word)) {
        let own = keys.iter().all(|key| resolved.document.text(key) == Some(word));
        if !own {
            options.push(keys.iter().fold(Setting::none(), |setting, key| setting.set(key, *word)));
        }
    }
    Some(SettingAxis { name, keys: keys.to_vec(), options })
}

/// An axis of one number.
fn numbers(name: &'static str, key: &str, own: f64, values: &[f64]) -> SettingAxis {
    let others = values.iter().filter(|value| **value != own);
    let options = others.map(|value| Setting::none().set(key, format!("{value:?}")));
    SettingAxis { name, keys: vec![key.to_owned()], options: std::iter::once(Setting::none()).chain(options).collect() }
}

fn theta(resolved: &Resolved) -> Option<SettingAxis> {
    Some(numbers("theta", "time.theta", resolved.scene.time.theta, &THETAS))
}

fn tolerance(resolved: &Resolved) -> Option<SettingAxis> {
    let scene = &resolved.scene;
    scene.has_contacts().then(|| numbers("tolerance", "solver.tolerance", scene.solver.tolerance, &TOLERANCES))
}

fn solver(resolved: &Resolved) -> Option<SettingAxis> {
    // The convex law is another model, not a cheaper method. Of the other solvers only those that
    // may be faster with a scene's few contacts.
    let exact = |name: &str| {
        if !QUICK.contains(&name) {
            return false;
        }
        let known = teeter_solvers::SOLVERS.iter().find(|info| info.name == name);
        known.is_some_and(|info| info.law == teeter_contact::Law::Exact && info.dimensions.contains(&2))
    };
    let axis = words(resolved, "solver", &["solver.method".to_owned()], exact)?;
    resolved.scene.has_contacts().then_some(axis)
}

fn kinematics(resolved: &Resolved) -> Option<SettingAxis> {
    let on_beam = resolved.scene.contacts.iter().filter(|contact| matches!(contact.surface, SupportingBody::Beam(_)));
    let keys: Vec<String> = on_beam.map(|contact| format!("contact.{}.kinematics", contact.name)).collect();
    words(resolved, "kinematics", &keys, |_| true)
}

/// The beams whose mesh is given by a number of elements, with that number.
fn meshed(resolved: &Resolved) -> Vec<(&BeamScene, i64)> {
    let of = |document: &Document, beam: &BeamScene| document.integer(&elements_key(beam));
    resolved.scene.beams.iter().filter_map(|beam| Some((beam, of(&resolved.document, beam)?))).collect()
}

fn elements_key(beam: &BeamScene) -> String {
    format!("beam.{}.elements", beam.name)
}

/// All beams with their elements multiplied by this factor; the scene's own if that changes
/// nothing.
pub(crate) fn refined(resolved: &Resolved, factor: f64) -> Setting {
    meshed(resolved).into_iter().fold(Setting::none(), |setting, (beam, own)| {
        let elements = ((own as f64 * factor).round() as i64).clamp(2, teeter_beam::MAX_ELEMENTS as i64);
        if elements == own { setting } else { setting.set(elements_key(beam), elements.to_string()) }
    })
}

/// Full beams with deformed kinematics, where the scene has others.
pub(crate) fn unreduced(resolved: &Resolved) -> Setting {
    let mut setting = Setting::none();
    for contact in resolved.scene.contacts.iter().filter(|contact| matches!(contact.surface, SupportingBody::Beam(_))) {
        let key = format!("contact.{}.kinematics", contact.name);
        if resolved.document.text(&key) != Some("deformed") {
            setting = setting.set(key, "deformed");
        }
    }
    setting
}

fn mesh(resolved: &Resolved) -> Option<SettingAxis> {
    let keys: Vec<String> = meshed(resolved).into_iter().map(|(beam, _)| elements_key(beam)).collect();
    if keys.is_empty() {
        return None;
    }
    let mut options = vec![Setting::none()];
    for setting in MESHES.iter().map(|factor| refined(resolved, *factor)) {
        if !options.contains(&setting) {
            options.push(setting);
        }
    }
    Some(SettingAxis { name: "mesh", keys, options })
}

fn modes(resolved: &Resolved) -> Option<SettingAxis> {
    let beams = &resolved.scene.beams;
    if beams.is_empty() {
        return None;
    }
    let model = |beam: &BeamScene| format!("beam.{}.model", beam.name);
    let shapes = |beam: &BeamScene| format!("beam.{}.modes", beam.name);
    let all = |set: &dyn Fn(Setting, &BeamScene) -> Setting| beams.iter().fold(Setting::none(), set);
    let mut options = vec![Setting::none()];
    if beams.iter().all(|beam| beam.reduction.is_none()) {
        options.push(all(&|setting, beam| setting.set(model(beam), "modes")));
        options.extend(MODES.iter().map(|count| {
            all(&|setting, beam| setting.set(model(beam), "modes").set(shapes(beam), format!("{{ count = {count} }}")))
        }));
    } else {
        options.push(all(&|setting, beam| setting.set(model(beam), "full")));
    }
    let keys = beams.iter().flat_map(|beam| [model(beam), shapes(beam)]).collect();
    Some(SettingAxis { name: "modes", keys, options })
}

#[cfg(test)]
mod tests {
    use super::*;

    const GROUND: &str = "[time]\nend = \"0.1 s\"\nstep = \"1 ms\"\n[ground]\n[material.wood]\n\
        density = \"600 kg/m^3\"\nyoungs_modulus = \"10 GPa\"\n[block.cube]\nmaterial = \"wood\"\nwidth = \"10 cm\"\nheight = \"10 cm\"\n\
        depth = \"10 cm\"\nposition = [\"0 m\", \"6 cm\"]\n[contact.floor]\nbetween = [\"cube\", \"ground\"]\nfriction = 0.4\n";

    fn axes(text: &str) -> (Resolved, Axes) {
        let resolved = teeter_scenario::load(text.as_bytes(), "s.toml", "s", &[]).unwrap();
        let axes = Axes::of(&resolved);
        (resolved, axes)
    }

    #[test]
    fn a_scene_has_the_axes_that_mean_something_in_it() {
        let names = |axes: &Axes| axes.iter().map(|axis| axis.name).collect::<Vec<_>>();
        let (_, ground) = axes(GROUND);
        assert_eq!(names(&ground), ["scheme", "step", "theta", "solver", "tolerance"]);
        let beam = "[time]\nend = \"0.1 s\"\nstep = \"1 ms\"\n[material.wood]\ndensity = \"600 kg/m^3\"\nyoungs_modulus = \"10 GPa\"\n\
            [beam.table]\nmaterial = \"wood\"\nspan = \"1 m\"\nwidth = \"3 cm\"\nthickness = \"1 cm\"\nelements = 10\n";
        let (resolved, axes) = axes(beam);
        assert_eq!(names(&axes), ["scheme", "step", "theta", "mesh", "modes"]);
        let mesh = &axes.grid[1];
        let elements: Vec<_> = mesh.options.iter().map(|option| option.get("beam.table.elements")).collect();
        assert_eq!(elements, [None, Some("3"), Some("5"), Some("20")]);
        assert_eq!(refined(&resolved, 1.0), Setting::none());
    }

    /// A block on a beam of four elements: 16 modes are more than it has.
    const BEAM: &str = "[time]\nend = \"0.1 s\"\nstep = \"1 ms\"\n[material.wood]\n\
        density = \"600 kg/m^3\"\nyoungs_modulus = \"10 GPa\"\n[beam.table]\nmaterial = \"wood\"\nspan = \"1 m\"\nwidth = \"5 cm\"\n\
        thickness = \"2 cm\"\nelements = 4\nsupports = [\"pinned\", \"pinned\"]\n[block.cube]\nmaterial = \"wood\"\nwidth = \"5 cm\"\n\
        height = \"5 cm\"\ndepth = \"5 cm\"\non = \"table\"\nat = \"50 cm\"\n[contact.feet]\nbetween = [\"cube\", \"table\"]\nfriction = 0.4\n";

    #[test]
    fn every_option_of_every_axis_is_a_scene_or_refused_with_a_reason() {
        let mut refused = Vec::new();
        for (text, names) in [
            (GROUND, &["scheme", "step", "theta", "solver", "tolerance"][..]),
            (BEAM, &["scheme", "step", "theta", "mesh", "modes", "kinematics", "solver", "tolerance"][..]),
        ] {
            let mut read = |_: &str| Err("no other file".to_owned());
            let (source, resolved) =
                crate::StudyScene::new(text.as_bytes().to_vec(), "s.toml", "s", &[], &mut read).unwrap();
            let axes = Axes::of(&resolved);
            assert_eq!(axes.iter().map(|axis| axis.name).collect::<Vec<_>>(), names);
            for axis in axes.iter() {
                assert!(axis.options.contains(&Setting::none()), "{}: the scene's own is one", axis.name);
                assert!(axis.options.len() > 1, "{}: nothing to choose", axis.name);
                for option in &axis.options {
                    match crate::simulate::expect(&source, option) {
                        Ok(work) => assert!(work.steps > 0, "{option}"),
                        Err(crate::Failure::Refused(reason)) => {
                            let said = |part: &str| reason.contains(part.trim_matches(['{', '}', ' ']));
                            let named = option.pairs().iter().any(|(key, value)| said(key) || said(value));
                            assert!(named, "{option}: the reason says neither key nor value: {reason}");
                            refused.push(option.to_string());
                        }
                        Err(other) => panic!("{option}: {other}"),
                    }
                }
            }
        }
        let modes = |count| format!("--set beam.table.model=modes --set beam.table.modes=\"{{ count = {count} }}\"");
        assert_eq!(refused, [modes(16), modes(32)], "these, and no other");
    }

    #[test]
    fn steps_go_from_coarse_to_fine_in_texts_that_read_back() {
        let (resolved, axes) = axes(GROUND);
        let texts: Vec<_> = axes.step.options.iter().map(|option| option.get("time.step").unwrap_or("1 ms")).collect();
        assert_eq!(texts, ["5 ms", "2 ms", "1 ms", "500 us", "200 us", "100 us", "50 us", "20 us", "10 us"]);
        assert_eq!(resolved.scene.time.step, 1e-3);
        assert_eq!(in_seconds(0.1 * 3.0 * 1e-3), "300 us");
        assert_eq!(in_seconds(2.5e-10), "0.25 ns");
    }

    #[test]
    fn an_option_replaces_what_the_axis_had_before() {
        let (_, axes) = axes(GROUND);
        let [coarse, .., fine] = axes.step.options.as_slice() else { panic!("a ladder") };
        let both = axes.step.apply(fine, &axes.step.apply(coarse, &Setting::none().set("time.theta", "1.0")));
        assert_eq!(both.get("time.step"), Some("10 us"));
        assert_eq!(axes.step.part_of(&both), *fine);
        assert_eq!(axes.step.apply(&Setting::none(), &both), Setting::none().set("time.theta", "1.0"));
    }
}
