//! Resolves prescribed motion of the ground, of supports and of blocks, forces on blocks, loads on
//! beams.

use super::Resolver;
use crate::scene::{
    AxisScene, BeamScene, BlockScene, ContactScene, ForceScene, History, LoadKind, LoadScene, MotionScene, Placement,
    SignalScene, SupportingBody,
};
use std::fmt::Write;
use teeter_integrator::{Formula, Given};

/// The keys of a motion: translation x, y, and rotation.
const SHIFTS: [(&str, Given); 3] =
    [("displacement", Given::Displacement), ("velocity", Given::Velocity), ("acceleration", Given::Acceleration)];
const TURNS: [(&str, Given); 3] = [
    ("angle", Given::Displacement),
    ("angular_velocity", Given::Velocity),
    ("angular_acceleration", Given::Acceleration),
];

/// What multiplies an amplitude.
#[derive(Clone)]
struct Factor {
    history: History,
    /// Of its signal.
    scale: f64,
}

/// A load times a factor.
fn scaled(kind: LoadKind, factor: f64) -> LoadKind {
    match kind {
        LoadKind::Point { at, force, couple } => LoadKind::Point { at, force: force * factor, couple: couple * factor },
        LoadKind::Moving { force, at, speed } => LoadKind::Moving { force: force * factor, at, speed },
        LoadKind::Distributed { load, from, to } => LoadKind::Distributed { load: load * factor, from, to },
    }
}

impl Resolver<'_, '_> {
    /// The motion `owner.motion`; empty if there is no such table.
    pub(super) fn motion(&mut self, owner: &str, signals: &[Option<SignalScene>]) -> Option<MotionScene> {
        let path = format!("{owner}.motion");
        if !self.doc.has_table(&path) {
            return Some(MotionScene::default());
        }
        let Some(shared) = self.shared.filter(|_| signals.is_empty()) else {
            return self.given_motion(owner, signals);
        };
        // Without signals it depends on the values in its table and the files alone.
        let mut keys = String::new();
        for (path, entry) in self.doc.entries_from(&format!("{path}.")) {
            let _ = write!(keys, "{path} = {:?}; ", entry.value);
        }
        shared.motion(keys, || self.given_motion(owner, signals)).map(|motion| MotionScene::clone(&motion))
    }

    fn given_motion(&mut self, owner: &str, signals: &[Option<SignalScene>]) -> Option<MotionScene> {
        let path = format!("{owner}.motion");
        let at = |key: &str| format!("{path}.{key}");
        let (shift, turn) = (self.one_of(&path, &SHIFTS)?, self.one_of(&path, &TURNS)?);
        let recorded = self.recorded(&path)?;
        let first = ["x", "y"].into_iter().zip(&recorded).find_map(|(name, axis)| axis.as_ref().map(|_| name));
        if let (Some(name), Some((key, _))) = (first, shift) {
            let rule = format!("{name} and {key} prescribe the same motion");
            self.error(&at(key), rule, "keep the records or the other; a component without a record is not shaken");
            return None;
        }
        if shift.is_none() && turn.is_none() && first.is_none() {
            let remedy = if owner.starts_with("beam") {
                "give one of displacement, velocity, acceleration, such as acceleration = [\"3 m/s^2\", \"0 m/s^2\"], or a \
                 record, such as x = { record = \"quake.at2\" }"
            } else {
                "give one of displacement, velocity, acceleration, or a record, such as x = { record = \"quake.at2\" }, or one of \
                 angle, angular_velocity, angular_acceleration, or one of each"
            };
            self.error(&path, "the motion is missing", remedy);
            return None;
        }
        let [across, up] = self.pair_of_signals(&path, turn.is_some(), signals)?;
        if first.is_some() {
            let given = |key: &str| self.doc.has(&at(key));
            let idle = if given("signals") { Some("signals") } else { given("signal").then_some("signal") };
            if let Some(key) = idle.filter(|key| *key == "signals" || turn.is_none()) {
                self.error(&at(key), "no signal multiplies a record", "leave it out; scale or peak set its size");
                return None;
            }
        }
        let [x, y] = recorded;
        let mut axes: [Option<AxisScene>; 3] = [x, y, None];
        if let Some((key, given)) = shift {
            let [x, y] = self.pair(&at(key))?;
            let only = self.doc.text(&at("only"));
            for (k, amplitude, history, name) in [(0, x, across.clone(), "x"), (1, y, up, "y")] {
                if only.is_none_or(|only| only == name) {
                    axes[k] = Some(self.axis(&at(key), given, amplitude, history)?);
                }
            }
        } else if self.doc.has(&at("only")) {
            self.error(&at("only"), "it applies only with displacement, velocity or acceleration", "leave it out");
        }
        if let Some((key, given)) = turn {
            let amplitude = self.quantity(&at(key))?;
            let history = self.history(&at("signal"), signals)?;
            axes[2] = Some(self.axis(&at(key), given, amplitude, history)?);
        }
        Some(MotionScene(axes))
    }

    /// The one of several keys that is given.
    fn one_of(&mut self, path: &str, keys: &[(&'static str, Given)]) -> Option<Option<(&'static str, Given)>> {
        let doc = self.doc;
        let at = |key: &str| format!("{path}.{key}");
        let mut given = keys.iter().filter(|(key, _)| doc.has(&at(key)) || doc.is_refused(&at(key)));
        match (given.next(), given.next()) {
            (Some((first, _)), Some((second, _))) => {
                let rule = format!("{first} and {second} prescribe the same motion");
                self.error(&at(second), rule, "keep one of them");
                None
            }
            (Some((key, _)), None) if doc.is_refused(&at(key)) => None,
            (first, _) => Some(first.copied()),
        }
    }

    /// The histories of x and y: `signals`, or `signal` for both.
    fn pair_of_signals(&mut self, path: &str, turns: bool, signals: &[Option<SignalScene>]) -> Option<[Factor; 2]> {
        let (one, two) = (format!("{path}.signal"), format!("{path}.signals"));
        let Some(names) = self.doc.text_pair(&two).map(|pair| pair.map(str::to_owned)) else {
            let history = self.history(&one, signals)?;
            return Some([history.clone(), history]);
        };
        if self.doc.has(&one) && !turns {
            self.error(&two, "signal and signals multiply the same motion", "keep one of them");
            return None;
        }
        let [x, y] = names.map(|name| self.named(&two, &name, signals));
        Some([x?, y?])
    }

    /// The history named at a path; constant if none is given.
    fn history(&mut self, path: &str, signals: &[Option<SignalScene>]) -> Option<Factor> {
        match self.doc.text(path).map(str::to_owned) {
            Some(name) => self.named(path, &name, signals),
            None if self.doc.is_refused(path) => None,
            None => {
                Formula::constant(0.0).ok().map(|constant| Factor { history: History::Formula(constant), scale: 1.0 })
            }
        }
    }

    fn named(&mut self, path: &str, name: &str, signals: &[Option<SignalScene>]) -> Option<Factor> {
        if let Some(number) = self.signals.get(name) {
            let signal = signals.get(*number)?.as_ref()?;
            return Some(Factor { history: signal.history.clone(), scale: signal.scale });
        }
        self.not_defined(path, name);
        None
    }

    /// Reports the name of a signal that there isn't.
    pub(super) fn not_defined(&mut self, path: &str, name: &str) {
        if !self.doc.is_refused("signal") {
            let known = self.doc.names("signal");
            let remedy = if known.is_empty() {
                format!("define it: [signal.{name}]")
            } else {
                format!("signals defined: {}", super::listed(&known))
            };
            let near = crate::suggest::nearest(name, known).map(str::to_owned);
            self.error(path, format!("the signal `{name}` is not defined"), remedy);
            self.suggest(near);
        }
    }

    fn axis(&mut self, path: &str, given: Given, amplitude: f64, factor: Factor) -> Option<AxisScene> {
        let (amplitude, history) = (amplitude * factor.scale, factor.history);
        let jump = history.signal().jump().filter(|_| given == Given::Displacement && amplitude != 0.0);
        let end = self.doc.quantity("time.end").unwrap_or(f64::INFINITY);
        if let Some(t) = jump.filter(|t| *t <= end) {
            let rule = format!("the displacement jumps at {t} s, which is not possible");
            self.error(
                path,
                rule,
                "let the signal start at 0 s or without a jump, or give a velocity or an acceleration",
            );
            return None;
        }
        Some(AxisScene { given, amplitude, history })
    }

    /// Reports prescribed motion of missing supports, or of those that can't move yet.
    pub(super) fn check_moving_supports(&mut self, beam: &BeamScene) {
        let spec = &beam.spec;
        let none = spec.supports == [teeter_beam::Support::Free; 2]
            && spec.inner_supports.is_empty()
            && spec.foundations.is_empty();
        if beam.motion.is_given() && none {
            let rule = "the supports move, but the beam has none";
            self.error(&format!("beam.{}.motion", beam.name), rule, "support an end (supports), or leave motion out");
        }
        if beam.motion.is_given() && matches!(spec.axial, teeter_beam::Axial::Elastic { .. }) {
            let rule = "moving supports can't move an elastic beam along its axis yet";
            self.error(&format!("beam.{}.motion", beam.name), rule, "use axial = free or held, or leave motion out");
        }
    }

    /// Reports contacts between two bodies that are both fully prescribed.
    pub(super) fn check_contacts_can_move(&mut self, blocks: &[Option<BlockScene>], contacts: &[Option<ContactScene>]) {
        let is_prescribed = |block: &BlockScene| block.motion.is_whole();
        let listed = contacts.iter().enumerate().filter_map(|(number, contact)| Some((number, contact.as_ref()?)));
        for (number, contact) in listed {
            let Some(Some(block)) = blocks.get(contact.block) else { continue };
            let other = match contact.surface {
                SupportingBody::Ground => "the ground".to_owned(),
                SupportingBody::Beam(_) => continue,
                SupportingBody::Block(other) => match blocks.get(other) {
                    Some(Some(other)) if is_prescribed(other) => format!("`{}`", other.name),
                    _ => continue,
                },
            };
            if is_prescribed(block) {
                let rule = format!("`{}` is fully prescribed, and {other} can't yield to it", block.name);
                let placed_by_it = [Some(block), contact.other_block().and_then(|other| blocks.get(other)?.as_ref())]
                    .into_iter()
                    .flatten()
                    .any(|block| matches!(block.placement, Placement::On { contact, .. } if contact == number));
                let remedy = if placed_by_it {
                    "leave a direction or the angle free, or leave the contact out and give position instead of on, at and tilt"
                } else {
                    "leave a direction or the angle free, or leave the contact out"
                };
                self.error(&format!("contact.{}.between", contact.name), rule, remedy);
            }
        }
    }

    pub(super) fn force(&mut self, name: &str, signals: &[Option<SignalScene>]) -> Option<ForceScene> {
        let path = format!("force.{name}");
        let at = |key: &str| format!("{path}.{key}");
        let on = self.word(&at("on"));
        let factor = self.history(&at("signal"), signals);
        let doc = self.doc;
        let (force, couple) = (doc.pair(&at("force")), doc.quantity(&at("couple")));
        if force.is_none() && couple.is_none() && !["force", "couple"].iter().any(|key| doc.is_refused(&at(key))) {
            self.error(&path, "neither force nor couple is given", "add one, such as force = [\"5 N\", \"0 N\"]");
            return None;
        }
        let on = on?;
        let Some(block) = self.blocks.get(on.as_str()).copied() else {
            if self.surface(&on).is_some() {
                let remedy = "name a block; loads on beams go under [load.NAME], and the ground takes none";
                self.error(&at("on"), format!("`{on}` is not a block"), remedy);
            } else {
                self.no_body(&at("on"), &on);
            }
            return None;
        };
        let Factor { history, scale } = factor?;
        let (force, couple) = (force.unwrap_or_default().map(|part| part * scale), couple.unwrap_or_default() * scale);
        Some(ForceScene { name: name.to_owned(), block, force, couple, history })
    }

    pub(super) fn load(
        &mut self,
        name: &str,
        beams: &[Option<BeamScene>],
        signals: &[Option<SignalScene>],
    ) -> Option<LoadScene> {
        let path = format!("load.{name}");
        let at = |key: &str| format!("{path}.{key}");
        let on = self.word(&at("on"));
        let factor = self.history(&at("signal"), signals);
        let on = on?;
        let Some(beam) = self.beams.get(on.as_str()).copied() else {
            if self.blocks.contains_key(on.as_str()) || on == "ground" {
                self.error(
                    &at("on"),
                    format!("`{on}` is not a beam"),
                    "name a beam; forces on blocks go under [force.NAME]",
                );
            } else {
                self.no_body(&at("on"), &on);
            }
            return None;
        };
        let span = beams.get(beam).and_then(|beam| Some(beam.as_ref()?.spec.span));
        let kind = self.load_kind(&path, span)?;
        // A moving force may start outside the beam.
        if let (LoadKind::Point { at: x, .. }, Some(span)) = (kind, span)
            && !(0.0..=span).contains(&x)
        {
            let rule = format!("the load at {x} m is outside the span [0, {span}] m");
            self.error(&at("at"), rule, "give a place along the beam, from its left end");
            return None;
        }
        let Factor { history, scale } = factor?;
        Some(LoadScene { name: name.to_owned(), beam, kind: scaled(kind, scale), history })
    }

    fn load_kind(&mut self, path: &str, span: Option<f64>) -> Option<LoadKind> {
        let at = |key: &str| format!("{path}.{key}");
        let doc = self.doc;
        let written = |key: &str| doc.has(&at(key)) || doc.is_refused(&at(key));
        if written("distributed") {
            if let Some(key) = ["at", "force", "couple", "speed"].into_iter().find(|key| written(key)) {
                let remedy =
                    "keep either distributed, or at with force and couple; use another table for a second load";
                self.error(&at(key), "it doesn't apply to a distributed load", remedy);
                return None;
            }
            let ([from, to], load) = (self.part(path, span)?, doc.quantity(&at("distributed"))?);
            return Some(LoadKind::Distributed { load, from, to });
        }
        if let Some(key) = ["from", "to"].into_iter().find(|key| written(key)) {
            self.error(&at(key), "it applies only with distributed", "leave it out, or add distributed = \"-10 N/m\"");
            return None;
        }
        if !(written("force") || written("couple")) {
            let remedy = "add distributed = \"-10 N/m\", or at with force or couple";
            self.error(path, "the size of the load is missing", remedy);
            return None;
        }
        if !written("at") {
            self.error(
                &at("at"),
                "required with force or couple",
                "give a position along the beam, such as at = \"9 cm\"",
            );
            return None;
        }
        let of = |key: &str| if written(key) { doc.quantity(&at(key)) } else { Some(0.0) };
        if written("speed") {
            if written("couple") {
                self.error(&at("couple"), "only a force can move along the beam", "leave out couple or speed");
                return None;
            }
            let (force, speed) = (doc.quantity(&at("force"))?, doc.quantity(&at("speed"))?);
            return Some(LoadKind::Moving { force, at: doc.quantity(&at("at"))?, speed });
        }
        Some(LoadKind::Point { at: doc.quantity(&at("at"))?, force: of("force")?, couple: of("couple")? })
    }
}
