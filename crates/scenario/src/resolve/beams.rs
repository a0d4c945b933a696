//! Resolves beams: sections, supports, damping, initial shapes.

use std::sync::Arc;
use teeter_beam::{
    Axial, Beam, BeamError, BeamSpec, Damping, DampingRatio, Foundation, Hold, MAX_ELEMENTS, ModesError, StaticError,
    Support,
};
use teeter_integrator::WBackend;

use super::sections::SectionProfile;
use super::{Resolver, Unheld};
use crate::build_diagnostics;
use crate::scene::{BeamScene, Reduction, SignalScene};
use crate::words::{AxialModel, Backend, ContactSurface};

/// The same support without dashpots.
fn undamped(support: Support) -> Support {
    let [deflection, rotation] = support.holds().map(|hold| match hold {
        Hold::Spring { stiffness, .. } => Hold::Spring { stiffness, damping: 0.0 },
        other => other,
    });
    Support::Elastic { deflection, rotation }
}

/// Most elements of all beams together: limits memory and the time to factorise in `check`.
const MOST_ELEMENTS: usize = 2 * MAX_ELEMENTS;

impl Resolver<'_, '_> {
    /// All beams, in the order of the scene.
    pub(super) fn all_beams(&mut self, signals: &[Option<SignalScene>]) -> Vec<Option<BeamScene>> {
        let mut beams: Vec<_> = self.doc.names("beam").into_iter().map(|name| self.beam(name, signals)).collect();
        if self.mesh_sizes(&beams) {
            beams.iter_mut().flatten().for_each(|beam| self.assembled(beam));
        }
        beams
    }

    fn beam(&mut self, name: &str, signals: &[Option<SignalScene>]) -> Option<BeamScene> {
        let path = format!("beam.{name}");
        let at = |key: &str| format!("{path}.{key}");
        let material = (self.doc.text(&at("section")) != Some("direct")).then(|| self.material(&path)).flatten();
        let profiled = self.section(&path, material.as_deref(), &path);
        let segments = self.segments(&path, material.as_deref());
        let span = self.quantity(&at("span"));
        let mesh = self.mesh(&path, span);
        let supports = self.supports(&at("supports"));
        let inner_supports = self.inner_supports(&path, span);
        let lumps = self.lumps(&path, span);
        let foundations = self.foundations(&path, span);
        let axial = self.axial(&path);
        let reduction = self.reduction(&path, span);
        let axial_force = self.quantity(&at("axial_force"));
        let position = self.pair(&at("position"));
        let probes = self.probes(&at("probes"), span);
        let static_start = self.doc.text(&at("start")) == Some("static");
        let top = self.choice(&at("surface")).map(|lies| match lies {
            ContactSurface::Axis => false,
            ContactSurface::Top => true,
        });
        let self_weight = self.doc.flag(&at("self_weight"));
        let motion = self.motion(&path, signals);
        self.check_damping_given_once(&path);
        self.check_ends_held(&path, axial, supports);
        let parts = segments.iter().flatten().map(|segment| &segment.section);
        let output = self.beam_output(&path, profiled.iter().map(|profiled| &profiled.section).chain(parts));
        let SectionProfile { section, thickness } = profiled?;
        if top == Some(true) && thickness.is_none() {
            self.error(
                &at("thickness"),
                "missing, where surface = top",
                "add it: contacts are half of it above the axis",
            );
        }
        let (elements, nodes) = mesh?;
        let mut spec = BeamSpec::new(span?, elements, section).supported(supports?).meshed(nodes);
        spec.segments = segments?;
        spec.inner_supports = inner_supports?;
        spec.lumps = lumps?;
        spec.foundations = foundations?;
        spec.axial = axial?;
        spec.axial_force = axial_force?;
        spec.damping = self.damping(&path, &spec)?;
        let beam = BeamScene {
            name: name.to_owned(),
            spec,
            thickness: thickness.unwrap_or(0.0),
            yield_strength: material.and_then(|m| self.doc.quantity(&format!("{m}.yield_strength"))),
            top: top?,
            static_start,
            shape: Vec::new(),
            position: position?,
            self_weight: self_weight?,
            reduction: reduction?,
            backend: self.backend(&at("backend"))?,
            probes: probes?,
            output: output?,
            motion: motion?,
        };
        self.check_moving_supports(&beam);
        Some(beam)
    }

    fn probes(&mut self, path: &str, span: Option<f64>) -> Option<Vec<f64>> {
        let probes = self.doc.list(path).unwrap_or_default().to_vec();
        let outside = span.and_then(|span| Some((span, probes.iter().find(|x| **x > span)?)));
        if let Some((span, x)) = outside {
            self.error(
                path,
                format!("the probe at {x} m lies outside the span [0, {span}] m"),
                "give positions along the beam, from its left end",
            );
        }
        if let Some(twice) = (1..probes.len()).find(|&k| probes[..k].contains(&probes[k])) {
            // Two columns would have the same name.
            let rule = format!("the probe at {} m is given twice", probes[twice]);
            self.error(path, rule, "give each position once");
        }
        (!self.doc.is_refused(path)).then_some(probes)
    }

    /// A beam in modes has no such key.
    fn backend(&mut self, path: &str) -> Option<WBackend> {
        let word = if self.doc.text(path).is_some() { self.choice(path)? } else { Backend::Auto };
        Some(match word {
            Backend::Auto => WBackend::Auto,
            Backend::Banded => WBackend::Banded,
            Backend::Sparse => WBackend::Sparse,
            Backend::CachedColumns => WBackend::CachedColumns,
        })
    }

    fn axial(&mut self, path: &str) -> Option<Axial> {
        Some(match self.choice(&format!("{path}.axial"))? {
            AxialModel::Held => Axial::Held,
            AxialModel::Elastic => {
                let ends = self.doc.text_pair(&format!("{path}.axial_supports"));
                let held = ends.map(|ends| ends.map(|end| end == "held"));
                Axial::elastic(self.required(&format!("{path}.axial_supports"), held)?)
            }
            AxialModel::Free => Axial::Free,
        })
    }

    /// The modal basis of a beam.
    fn reduction(&mut self, path: &str, span: Option<f64>) -> Option<Option<Reduction>> {
        let (table, model) = (format!("{path}.modes"), format!("{path}.model"));
        let at = |key: &str| format!("{table}.{key}");
        let (doc, given) = (self.doc, self.doc.has_table(&table));
        if self.word(&model)? != "modes" {
            if given {
                self.error(&table, "applies only with model = modes", "write model = \"modes\", or leave it out");
            }
            return (!given).then_some(None);
        }
        if doc.text(&format!("{path}.axial")) == Some("held") {
            let rule = "a beam held along its axis stretches as it deflects, which modes can't represent";
            self.error(&model, rule, "use model = \"full\", or axial = \"free\"");
            return None;
        }
        let backend = format!("{path}.backend");
        if doc.text(&backend).is_some_and(|word| word != "auto") {
            self.error(&backend, "a beam in modes has a diagonal matrix", "leave it out, or use model = \"full\"");
            return None;
        }
        if doc.is_refused(&at("count")) || doc.is_refused(&at("tolerance")) {
            return None;
        }
        if let Some(count) = doc.integer(&at("count")) {
            if let Some(key) = ["tolerance", "from", "to"].into_iter().find(|key| doc.has(&at(key))) {
                let remedy = "keep count, or tolerance with from and to";
                self.error(&at(key), "count already gives the number of modes", remedy);
                return None;
            }
            return Some(Some(Reduction::Modes(usize::try_from(count).ok()?)));
        }
        let tolerance = doc.number(&at("tolerance")).unwrap_or(Reduction::TOLERANCE);
        let region = self.part(&table, span)?;
        Some(Some(Reduction::Flexibility { tolerance, region }))
    }

    /// Limits the elements of all beams together; those of a single beam are limited by the table
    /// of keys. Returns whether they are within the limit.
    fn mesh_sizes(&mut self, beams: &[Option<BeamScene>]) -> bool {
        let mut sum = 0;
        for beam in beams.iter().flatten() {
            sum += beam.spec.nodes.len().saturating_sub(1).max(beam.spec.elements);
            if sum > MOST_ELEMENTS {
                let rule = format!("with this beam the scene has {sum} elements, over the limit of {MOST_ELEMENTS}");
                let remedy = "20 to 100 elements per beam are more accurate than the model";
                self.error(&format!("beam.{}.elements", beam.name), rule, remedy);
                return false;
            }
        }
        true
    }

    /// Checks that need the assembled beam: consistency of its values, rigid motions, and the shape
    /// from a file.
    fn assembled(&mut self, beam: &mut BeamScene) {
        let path = format!("beam.{}", beam.name);
        let start = format!("{path}.start");
        // A basis can't be found for every beam; that is told elsewhere.
        let shared = self.shared.filter(|_| beam.reduction.is_none()).and_then(|shared| shared.beam(beam).ok());
        let made = match &shared {
            Some(shared) => Ok(Arc::clone(shared.factors.beam())),
            None => Beam::new(beam.spec.clone()).map(Arc::new),
        };
        let model = match made {
            Ok(model) => model,
            Err(error) => {
                self.errors.push(build_diagnostics::beam(&beam.name, &error, self.doc));
                return;
            }
        };
        if let (true, Some(motion)) = (beam.static_start, model.rigid_motion()) {
            let (motion, remedy) = (motion.description(), motion.remedy());
            let rule = format!("the beam can move as a rigid body, so it has no static equilibrium: {motion}");
            self.unheld.push(Unheld {
                beam: beam.name.clone(),
                rule,
                remedy: format!("{remedy} (supports), or start undeformed"),
            });
        }
        // For any initial shape. Its modes would only repeat the error at the wrong keys.
        if !self.check_axial_force(&path, &model) {
            return;
        }
        beam.shape = self.start_shape(&start, &model).unwrap_or_default();
        if let Err(BeamError::NoFrequencyEquation) = beam.spec.circular_frequency(1)
            && let Some(c) = self.viscous_for_ratio(&path, &model)
        {
            beam.spec.damping.viscous = c;
        }
    }

    /// Reports an axial force beyond the buckling load, at which the straight beam is not stable;
    /// returns whether it is within.
    fn check_axial_force(&mut self, path: &str, model: &Beam) -> bool {
        if model.spec().axial_force >= 0.0 {
            return true;
        }
        let Err(error @ StaticError::Buckled { .. }) = model.solve_static(&mut vec![0.0; model.dofs()]) else {
            return true;
        };
        let rule = error.to_string();
        let rule = rule.split_once(": ").map_or(rule.as_str(), |(_, rule)| rule);
        self.error(&format!("{path}.axial_force"), rule, "tension is positive");
        false
    }

    /// Reports why the modes requested by a key can't be found: if its axial force or its springs
    /// are the cause, at their keys.
    fn no_modes<T>(&mut self, path: &str, beam: &Beam, error: &ModesError) -> Option<T> {
        let of = path.rsplit_once('.').map_or(path, |(beam, _)| beam);
        let asked = format!("the modes requested by {path} can't be found");
        let soft = || matches!(beam.solve_static(&mut vec![0.0; beam.dofs()]), Err(StaticError::Soft));
        if beam.spec().axial_force < 0.0 && matches!(error, ModesError::Unstable { .. } | ModesError::Factor(_)) {
            let rule = format!("the straight beam is not stable under it: {asked}");
            self.error(
                &format!("{of}.axial_force"),
                rule,
                "tension is positive; reduce the compression, or leave that key out",
            );
        } else if soft() {
            let rule = format!("{asked}: {}", StaticError::Soft);
            self.error(
                &self.holding(of),
                rule,
                "a free end needs no spring: leave out springs that are too soft to hold the beam",
            );
        } else {
            self.error(path, error.to_string(), "use a lower mode, or fewer elements, or leave it out");
        }
        None
    }

    /// The key whose springs support a beam: its ends, otherwise the supports between them.
    fn holding(&self, path: &str) -> String {
        let keys = ["supports", "support", "foundation"].map(|key| format!("{path}.{key}"));
        let given = keys.iter().find(|key| self.doc.has(key) || !self.doc.names(key).is_empty());
        given.unwrap_or(&keys[0]).clone()
    }

    /// The initial coordinates, if they come from a file or a mode.
    fn start_shape(&mut self, path: &str, beam: &Beam) -> Option<Vec<f64>> {
        let item = self.doc.item(path)?;
        if self.doc.text(path).is_some() {
            return None; // a word
        }
        match (item.text("file"), item.integer("mode"), item.number("amplitude")) {
            (Some(file), None, None) => self.shape(path, file, beam),
            (None, Some(mode), Some(amplitude)) => {
                let shape = self.elastic_mode(path, beam, usize::try_from(mode).ok()?)?.1;
                let size = largest_deflection(beam, &shape);
                Some(shape.iter().map(|q| amplitude / size * q).collect())
            }
            (Some(_), ..) => {
                self.error(path, "file and mode both give the shape", "keep one of them");
                None
            }
            _ => {
                let remedy = "write { mode = 1, amplitude = \"1 mm\" }, or { file = \"shape.csv\" }";
                self.error(path, "the shape is missing", remedy);
                None
            }
        }
    }

    /// Circular frequency and shape of an elastic mode, from 1, of the finite elements.
    fn elastic_mode(&mut self, path: &str, beam: &Beam, mode: usize) -> Option<(f64, Vec<f64>)> {
        const MOST_MODES: usize = 20;
        let rule = if mode > MOST_MODES {
            format!(
                "mode {mode} of this beam must be computed by finite elements, which is possible for the first {MOST_MODES} only"
            )
        } else {
            let rigid = usize::from(beam.rigid_motion().is_some()) * RIGID;
            match beam.modes((mode + rigid).min(beam.free_dofs())) {
                Ok(modes) if modes.rigid() + mode <= modes.count() => {
                    let index = modes.rigid() + mode - 1;
                    return Some((modes.circular_frequencies()[index], modes.shape(index).to_vec()));
                }
                Ok(modes) => format!("the finite elements have {} elastic modes", modes.count() - modes.rigid()),
                Err(error) => return self.no_modes(path, beam, &error),
            }
        };
        self.error(path, rule, "use a lower mode, or more elements");
        None
    }

    /// The viscous damping c for a given damping ratio of a mode of the finite elements: φᵀC φ =
    /// 2ζω.
    fn viscous_for_ratio(&mut self, path: &str, beam: &Beam) -> Option<f64> {
        let path = format!("{path}.damping_ratio");
        let mode = self.doc.integer(&format!("{path}.mode")).and_then(|mode| usize::try_from(mode).ok())?;
        let ratio = self.doc.number(&format!("{path}.ratio"))?;
        let (omega, shape) = self.elastic_mode(&path, beam, mode)?;
        // Without the damping of supports and foundations, which is added and may be much larger.
        let mut alone = beam.spec().clone();
        alone.damping = Damping::none().with_viscous(1.0);
        alone.supports = alone.supports.map(undamped);
        alone.inner_supports.iter_mut().for_each(|inner| inner.support = undamped(inner.support));
        alone.foundations.iter_mut().for_each(|foundation| foundation.damping = 0.0);
        let mut damped = vec![0.0; shape.len()];
        Beam::new(alone).ok()?.add_damping_product(1.0, &shape, &mut damped);
        let unit: f64 = damped.iter().zip(&shape).map(|(c, x)| c * x).sum();
        Some(2.0 * ratio * omega / unit)
    }

    /// Reports free ends of a beam with axial = held.
    fn check_ends_held(&mut self, path: &str, axial: Option<Axial>, supports: Option<[Support; 2]>) {
        let (Some(Axial::Held), Some(supports)) = (axial, supports) else { return };
        let ends = supports.iter().zip(["left", "right"]);
        if let Some((_, end)) = ends.into_iter().find(|(support, _)| support.holds() == [Hold::Free; 2]) {
            let rule = format!("the {end} end is free, so nothing holds it along the axis");
            let remedy = "support that end, or use axial = free or elastic";
            self.error(&format!("{path}.axial"), rule, remedy);
        }
    }

    fn check_damping_given_once(&mut self, path: &str) {
        let given = ["damping_ratio", "viscous_damping"].map(|key| format!("{path}.{key}"));
        if given.iter().all(|path| self.doc.has(path) || self.doc.has_table(path)) {
            let rule = "damping_ratio and viscous_damping both set the same coefficient";
            self.error(&given[1], rule, "keep one of them");
        }
    }

    fn damping(&mut self, path: &str, spec: &BeamSpec) -> Option<Damping> {
        let mut damping = self.rayleigh(&format!("{path}.rayleigh"))?;
        damping.viscous = self.doc.quantity(&format!("{path}.viscous_damping")).unwrap_or(0.0);
        damping.modal = self.doc.list(&format!("{path}.modal_damping")).unwrap_or_default().to_vec();
        let ratio = format!("{path}.damping_ratio");
        if self.doc.has_table(&ratio) {
            let mode = self.doc.integer(&format!("{ratio}.mode")).and_then(|mode| usize::try_from(mode).ok())?;
            let zeta = self.number(&format!("{ratio}.ratio"))?;
            damping.viscous = match spec.viscous_for_ratio(mode, zeta) {
                Ok(c) => c,
                // Computed from the finite elements, later.
                Err(BeamError::NoFrequencyEquation) => 0.0,
                Err(error) => {
                    self.error(&ratio, error.to_string(), "give the number of a mode and a ratio of at least 0");
                    return None;
                }
            };
        }
        Some(damping)
    }

    /// Rayleigh's factors, given or fitted.
    fn rayleigh(&mut self, path: &str) -> Option<Damping> {
        if !self.doc.has_table(path) {
            return Some(Damping::default());
        }
        let at = |key: &str| format!("{path}.{key}");
        let doc = self.doc;
        let (frequencies, ratios) = (doc.pair(&at("frequencies")), doc.list(&at("ratios")));
        let Some(frequencies) = frequencies else {
            if doc.is_refused(&at("frequencies")) {
                return None;
            }
            if doc.has(&at("ratios")) {
                let remedy = "add frequencies = [\"10 Hz\", \"80 Hz\"], at which these are the damping ratios";
                self.error(&at("ratios"), "the frequencies of these ratios are missing", remedy);
                return None;
            }
            // Both have defaults.
            if ["a0", "a1"].iter().all(|key| !doc.is_given(&at(key)) && !doc.is_refused(&at(key))) {
                let remedy = "give a0 and a1, or frequencies and ratios";
                self.error(path, "the amount of damping is missing", remedy);
                return None;
            }
            let (mass, stiffness) = (self.quantity(&at("a0")), self.quantity(&at("a1")));
            return Some(Damping::none().with_rayleigh_mass(mass?).with_rayleigh_stiffness(stiffness?));
        };
        if let Some(key) = ["a0", "a1"].into_iter().find(|key| doc.has(&at(key))) {
            self.error(&at(key), "frequencies and ratios already determine the factors", "keep these, or a0 and a1");
            return None;
        }
        let &[first, second] = ratios.unwrap_or_default() else {
            if !doc.is_refused(&at("ratios")) {
                let rule =
                    format!("two ratios are expected, one for each frequency, got {}", ratios.map_or(0, <[_]>::len));
                self.error(&at("ratios"), rule, "write ratios = [0.01, 0.01]");
            }
            return None;
        };
        let [low, high] = frequencies.map(|frequency| std::f64::consts::TAU * frequency);
        match Damping::rayleigh([DampingRatio::new(low, first), DampingRatio::new(high, second)]) {
            Ok(damping) => Some(damping),
            Err(BeamError::Value { field, rule, .. }) => {
                let key = if field == "ratio" { "ratios" } else { "frequencies" };
                let remedy = "equal ratios are possible for any two different frequencies";
                self.error(&at(key), format!("the second one must be {rule}"), remedy);
                None
            }
            Err(error) => {
                self.error(path, error.to_string(), "check frequencies and ratios");
                None
            }
        }
    }

    /// The interval [from, to] of the span of a table.
    pub(super) fn part(&mut self, path: &str, span: Option<f64>) -> Option<[f64; 2]> {
        let span = span?;
        let (key, doc) = (|key: &str| format!("{path}.{key}"), self.doc);
        if doc.is_refused(&key("from")) || doc.is_refused(&key("to")) {
            return None;
        }
        let (from, to) = (doc.quantity(&key("from")).unwrap_or(0.0), doc.quantity(&key("to")).unwrap_or(span));
        for (key, x) in [(key("from"), from), (key("to"), to)] {
            if x > span {
                let rule = format!("{x} m lies outside the span [0, {span}] m");
                self.error(&key, rule, "give a position along the beam, from its left end");
                return None;
            }
        }
        if to <= from {
            let rule = format!("must be greater than from, {from} m");
            self.error(&key("to"), rule, "give the right end of the interval");
            return None;
        }
        Some([from, to])
    }

    /// The foundations under the beam.
    fn foundations(&mut self, path: &str, span: Option<f64>) -> Option<Vec<Foundation>> {
        let group = format!("{path}.foundation");
        let doc = self.doc;
        let of = |resolver: &mut Self, name: &str| {
            let path = format!("{group}.{name}");
            let part = resolver.part(&path, span);
            let stiffness = resolver.quantity(&format!("{path}.stiffness"));
            let damping = resolver.quantity(&format!("{path}.damping"));
            let [from, to] = part?;
            Some(Foundation::new(from, to, stiffness?).with_damping(damping?))
        };
        let all: Vec<_> = doc.names(&group).into_iter().map(|name| of(self, name)).collect();
        all.into_iter().collect()
    }
}

/// The deflection of largest absolute value, the leftmost of equal ones, including the interior of
/// elements, where a mode may have its whole deflection.
fn largest_deflection(beam: &Beam, shape: &[f64]) -> f64 {
    const PLACES: u32 = 16;
    /// Deflections that differ by less are equal: rounding must not choose a mode's sign.
    const ROUNDING: f64 = 1e-6;
    let deflections = || {
        let inside = beam.node_positions().windows(2).flat_map(|ends| {
            let (left, side) = (ends[0], ends[1] - ends[0]);
            (1..=PLACES).map(move |k| left + side * f64::from(k) / f64::from(PLACES))
        });
        std::iter::once(0.0).chain(inside).map(|x| beam.shape_clamped(x).deflection(shape).w)
    };
    let size = deflections().fold(0.0, |size: f64, w| size.max(w.abs()));
    let first = deflections().find(|w| w.abs() >= (1.0 - ROUNDING) * size);
    size.copysign(first.unwrap_or(size))
}

/// Most rigid motions of a beam: vertical, rotational, and axial.
const RIGID: usize = 3;
