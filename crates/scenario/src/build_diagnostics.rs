//! Errors of building a model as diagnostics of the scene: the key, its value, and how to correct
//! it.

use crate::diagnostic::Diagnostic;
use crate::document::Document;
use crate::placement::{InstabilityMode, PlacementError};
use crate::resolve::names::table_of;
use crate::simulation::{BuildError, beyond, touching};
use teeter_beam::{BeamError, ModalError, ModesError, StaticError};
use teeter_integrator::{EquilibriumError, ModelError};
use teeter_text::readable::with_digits;

impl BuildError {
    /// The error as a diagnostic of its scene, at the key that causes it.
    ///
    /// ```
    /// use teeter_scenario::simulation::Simulation;
    ///
    /// let text = "[time]\nend = '1 s'\nstep = '1 ms'\n[ground]\n[material.oak]\ndensity = '700 kg/m^3'\n\
    ///     [block.cube]\nmaterial = 'oak'\nwidth = '1 m'\nheight = '1 m'\ndepth = '1 m'\nposition = ['0 m', '40 cm']\n\
    ///     [contact.floor]\nbetween = ['cube', 'ground']\nfriction = 0.5\n";
    /// let resolved = teeter_scenario::load(text.as_bytes(), "cube.toml", "cube", &[])?;
    /// let error = Simulation::new(&resolved.scene).unwrap_err();
    /// let found = error.diagnostic(&resolved.document);
    /// assert_eq!((found.path.as_str(), found.position), ("block.cube.position", Some((12, 12))));
    /// assert!(found.rule.contains("100 mm below the surface of `ground`"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn diagnostic(&self, document: &Document) -> Diagnostic {
        match self {
            Self::Block(name, error) => document.error(
                &format!("block.{}", table_of(document, name)),
                error.to_string(),
                "check its width, height and depth, and the density of its material",
            ),
            Self::Beam(name, error) => beam(name, error, document),
            Self::Modes(name, error) => modes(name, error, document),
            Self::Placement(error) => placement(error, document),
            Self::Model(error) => law(error, document),
            Self::State(error) => document.error(
                "",
                format!("the initial state can't be computed: {error}"),
                "check sizes, positions and velocities for extreme values",
            ),
            Self::Mismatch(error) => document.error(
                "",
                format!("the parts of the model are inconsistent: {error}"),
                "this is a bug of the program: report it with the scene",
            ),
            Self::Scheme(error) => {
                document.error("time", error.to_string(), "check theta, activation_gamma and gap_tolerance")
            }
            Self::Solver(_) => document.error("solver.method", self.to_string(), "use one of the available solvers"),
            Self::Penetration { block, corner, on_side, lower, surface, depth, tolerance } => {
                let rule = format!(
                    "{} starts {} {} `{surface}`; up to {} are taken for rounding",
                    touching(*on_side, corner),
                    with_digits(*depth, "m", 2),
                    beyond(*on_side, *lower),
                    with_digits(*tolerance, "m", 2)
                );
                let remedy = if document.has(&format!("block.{}.position", table_of(document, block))) {
                    "move the block up, or give on, at and tilt instead of position: it then stands on the surface"
                } else {
                    "move one of the two, so that the corner is clear of the surface"
                };
                document.error(&place_of(block, document), rule, remedy)
            }
            Self::CrestInside { block, crest } => document.error(
                &place_of(block, document),
                format!("the ground's crest-{crest}, point {crest} of its profile, starts inside the block"),
                "move the block, or the point",
            ),
            Self::Overlap { first, second, depth } => document.error(
                &place_beside(first, second, document),
                format!("`{second}` overlaps `{first}` by {} at the start", with_digits(*depth, "m", 2)),
                "move one of the two",
            ),
            Self::Shape(_) | Self::Wiring(_) => document.error(
                "",
                format!("contact can't be computed with the shapes of the blocks: {self}"),
                "check widths and heights for extreme values",
            ),
        }
    }
}

/// The key that gives the position of a block: of one that starts where it is drawn, its shape.
fn place_of(block: &str, document: &Document) -> String {
    let path = |key: &str| format!("block.{}.{key}", table_of(document, block));
    let keys = ["position", "at", "centre", "points", "parts"];
    let key = keys.into_iter().find(|key| document.has(&path(key)));
    let drawn = if document.has(&path("shape.kind")) { "shape.kind" } else { "at" };
    path(key.unwrap_or(drawn))
}

/// The key that gives the position of the second block beside the first one: of voussoirs of one table the angle from one to the next.
fn place_beside(first: &str, second: &str, document: &Document) -> String {
    let table = table_of(document, second);
    if table_of(document, first) != table || document.text(&format!("block.{table}.shape.kind")) != Some("voussoir") {
        return place_of(second, document);
    }
    let turn = format!("block.{table}.repeat.turn");
    if document.has(&turn) { turn } else { format!("block.{table}.repeat") }
}

pub(crate) fn beam(name: &str, error: &BeamError, document: &Document) -> Diagnostic {
    let path = |key: &str| format!("beam.{name}.{key}");
    match error {
        BeamError::Value { field: "span", rule, .. } => document.error(
            &path("span"),
            format!("must be {rule}"),
            "check span, thickness and elements for extreme values",
        ),
        BeamError::Value { field: "nodes", value, rule } => document.error(
            &path("nodes"),
            format!("the node at {value} m must be {rule}"),
            "give the positions of all nodes from the left end to the right end",
        ),
        BeamError::Count { field: "damping.modal", value, rule } => document.error(
            &path("modal_damping"),
            format!("{value} ratios: must be {rule}"),
            "give ratios only for the first modes",
        ),
        BeamError::Count { field: "elements", rule, .. } => {
            document.error(&path("elements"), format!("must be {rule}"), "20 to 100 elements suit most beams")
        }
        _ => document.error(&format!("beam.{name}"), error.to_string(), "check the keys of this beam and its material"),
    }
}

fn modes(name: &str, error: &ModalError, document: &Document) -> Diagnostic {
    let path = |key: &str| format!("beam.{name}.{key}");
    match error {
        ModalError::CoupledDamping { relative, .. } => document.error(
            &path("model"),
            format!("the damping of this beam couples its modes ({relative:.1e} of their own damping), which must be uncoupled"),
            "leave out dashpots, damped foundations and other damping that is not proportional to mass or stiffness, or use model = \"full\"",
        ),
        ModalError::Modes(ModesError::Count { count, unknowns }) => document.error(
            &path("modes.count"),
            format!("{count} modes are more than the {} of the beam that can move", plural(*unknowns, "dof")),
            "use fewer modes, or more elements",
        ),
        ModalError::Tolerance { .. } => document.error(
            &path("modes.tolerance"),
            "must be at least 1e-8 and less than 1: the compared flexibilities have no more digits",
            "1e-4 is usual",
        ),
        _ => document.error(&path("model"), error.to_string(), "use model = \"full\", or a coarser mesh"),
    }
}

fn plural(count: usize, what: &str) -> String {
    if count == 1 { format!("1 {what}") } else { format!("{count} {what}s") }
}

fn placement(error: &PlacementError, document: &Document) -> Diagnostic {
    let start = |beam: &str, rule: String, remedy: &str| document.error(&format!("beam.{beam}.start"), rule, remedy);
    match error {
        PlacementError::Static { beam, source: source @ StaticError::RigidMotion { .. } } => {
            start(beam, format!("no static equilibrium: {source}"), "change supports, or start undeformed")
        }
        PlacementError::Static { beam, source } => start(
            beam,
            format!("no static equilibrium: {source}"),
            "use fewer elements or a stiffer beam, or start undeformed",
        ),
        PlacementError::NoEquilibrium { block, motion } => document.error(
            &format!("block.{}.at", table_of(document, block)),
            format!("no static equilibrium: the block {motion}"),
            match motion {
                InstabilityMode::Slides => "increase the friction, place the block where the beam stays level, or start undeformed",
                InstabilityMode::Tips => "move the block, use a stiffer beam, or start undeformed",
                InstabilityMode::Rolls => "place it where the beam stays level, hold it between other blocks, or start undeformed",
                InstabilityMode::FallsOver => "turn it so that it stands on a side, or start undeformed",
                InstabilityMode::ChangesFoot => "tilt it more, or the other way, use a stiffer beam, or start undeformed",
                InstabilityMode::LiftsOff => "check gravity and forces at t = 0, or start undeformed",
            },
        ),
        PlacementError::Unsettled { beam, rounds, change } => start(
            beam,
            format!(
                "no static equilibrium found in {rounds} iterations (relative change in the last one: {change:.1e})"
            ),
            "use a stiffer beam or lighter blocks, or start undeformed; where a base would lie flush on a part of the beam, try points = \"corners\"",
        ),
        PlacementError::Search { beam, source: EquilibriumError::Factor(_) } => start(
            beam,
            "no static equilibrium found: the softest of beam and supports is too soft, relative to the stiffest, for double precision".to_owned(),
            "use stiffer springs or foundations, a support, or a coarser mesh, or start undeformed",
        ),
        PlacementError::Search { beam, source } => start(
            beam,
            format!("no static equilibrium found: {source}"),
            "check the values of the beam and of the blocks on it, or start undeformed",
        ),
        PlacementError::TooSteep { block, at } => document.error(
            &format!("block.{}.at", table_of(document, block)),
            format!("the base of the block finds no rest on the ground at x = {at} m, which is too steep there"),
            "move the block to where the ground is less steep, or give position and angle",
        ),
        PlacementError::OffSurface { block, corner, x } => document.error(
            &format!("block.{}.at", table_of(document, block)),
            format!("the corner {corner} at x = {x} m is not above the surface that the block stands on"),
            "move the block so that the corners it stands on are above the surface",
        ),
    }
}

fn law(error: &ModelError, document: &Document) -> Diagnostic {
    let ModelError::Law { law, .. } = error else {
        return document.error("contact", error.to_string(), "check the keys of the contacts");
    };
    let names = document.names("contact");
    // Each contact of a scene has its own law.
    let contact = usize::try_from(law.0).ok().and_then(|law| names.get(law).copied()).unwrap_or_default();
    document.error(&format!("contact.{contact}"), error.to_string(), "check the values of its law")
}
