//! Resolves blocks: shape, position, and whether they fit on what they stand on.

use std::sync::Arc;

use nalgebra::Vector2;
use teeter_detect::{MOST_CORNERS, Shape, ShapeError};
use teeter_integrator::{Formula, Given};
use teeter_rigid::{MassProperties, RigidError};

use super::Resolver;
use super::contacts::Joined;
use super::jitter;
use super::names::BlockName;
use super::outlines::{self, Drawn, Refusal, ShapeKeys, Way, few_digits};
use crate::scene::{
    AxisScene, BeamScene, BlockPart, BlockScene, ContactScene, History, Matter, MotionScene, Placement, SignalScene,
    SupportingBody, mass_of,
};

/// An error that has been reported.
struct AlreadyReported;

/// A block's shape about its mass centre.
#[derive(Debug, Clone)]
pub(super) struct BlockShape {
    /// `None` for a rectangle with sharp corners.
    parts: Option<Arc<[BlockPart]>>,
    /// The mass centre in the coordinates of the drawing, m.
    centre: [f64; 2],
    /// Whether it starts where it is drawn if no position is given.
    is_in_place: bool,
    /// Width and height, or the largest and the smallest extent across sides, m.
    pub(super) extents: [f64; 2],
    matter: Matter,
}

impl Resolver<'_, '_> {
    /// All blocks, in the order of the scene: their shapes and placements with what else they have.
    pub(super) fn all_blocks(
        &mut self,
        shapes: &[Option<BlockShape>],
        placements: Vec<Option<Placement>>,
        beams: &[Option<BeamScene>],
        contacts: &[Option<ContactScene>],
        signals: &[Option<SignalScene>],
    ) -> Vec<Option<BlockScene>> {
        let names = self.block_names.clone();
        let of_blocks = names.iter().zip(shapes).zip(placements);
        of_blocks.map(|((name, shape), placed)| self.block(name, shape, placed, beams, contacts, signals)).collect()
    }

    /// The shapes of all blocks.
    pub(super) fn block_shapes(&mut self) -> Vec<Option<BlockShape>> {
        let names = self.block_names.clone();
        names.iter().map(|name| self.block_shape(name)).collect()
    }

    /// Where all blocks start; one without a shape has no place.
    pub(super) fn placements(
        &mut self,
        shapes: &[Option<BlockShape>],
        contacts: &[Option<ContactScene>],
        joined: &Joined,
    ) -> Vec<Option<Placement>> {
        let names = self.block_names.clone();
        let of_blocks = names.iter().zip(shapes);
        of_blocks.map(|(name, shape)| self.placement(name, shape.as_ref()?, contacts, joined)).collect()
    }

    fn block(
        &mut self,
        block: &BlockName,
        shape: &Option<BlockShape>,
        placement: Option<Placement>,
        beams: &[Option<BeamScene>],
        contacts: &[Option<ContactScene>],
        signals: &[Option<SignalScene>],
    ) -> Option<BlockScene> {
        let path = format!("block.{}", block.table);
        let at = |key: &str| format!("{path}.{key}");
        let velocity = self.pair(&at("velocity"));
        let spin = self.quantity(&at("spin"));
        let motion = self.block_motion(&path, signals);
        if let (Some(motion), Some([x, y]), Some(spin)) = (&motion, velocity, spin) {
            for (key, value, axis) in [("velocity", x, 0), ("velocity", y, 1), ("spin", spin, 2)] {
                if value != 0.0 && motion.0[axis].is_some() {
                    let remedy =
                        "leave it out, or set the prescribed components to 0: the motion has its own velocity at 0 s";
                    self.error(&at(key), "the motion of the block prescribes this velocity", remedy);
                }
            }
        }
        let BlockShape { parts, extents: [width, height], matter, .. } = shape.clone()?;
        let of = BlockScene {
            name: block.name.clone(),
            width,
            height,
            parts,
            matter,
            placement: placement?,
            velocity: velocity?,
            spin: spin?,
            motion: motion?,
        };
        self.stands(&block.table, &of, beams, contacts);
        Some(of)
    }

    /// The prescribed motion of a block, which is none at all of a fixed one.
    fn block_motion(&mut self, path: &str, signals: &[Option<SignalScene>]) -> Option<MotionScene> {
        let motion = self.motion(path, signals);
        let fixed = format!("{path}.fixed");
        if self.doc.flag(&fixed) != Some(true) {
            return motion;
        }
        if motion.as_ref().is_none_or(MotionScene::is_given) {
            self.error(&fixed, "a fixed block has no motion", "leave out fixed or motion");
            return None;
        }
        let still = History::Formula(Formula::constant(0.0).ok()?);
        let axis = AxisScene { given: Given::Velocity, amplitude: 0.0, history: still };
        Some(MotionScene([Some(axis.clone()), Some(axis.clone()), Some(axis)]))
    }

    fn placement(
        &mut self,
        block: &BlockName,
        shape: &BlockShape,
        contacts: &[Option<ContactScene>],
        joined: &Joined,
    ) -> Option<Placement> {
        let path = format!("block.{}", block.table);
        let at = |key: &str| format!("{path}.{key}");
        let along = |key: &str, steps: usize| {
            let shift = self.doc.pair(&at(key)).unwrap_or_default();
            shift.map(|shift| steps as f64 * shift)
        };
        let (shift, of_row) = (along("repeat.shift", block.place[0]), along("repeat.row_shift", block.place[1]));
        let (jitter, turned) = self.jitter(block);
        let shift = [0, 1].map(|axis| shift[axis] + of_row[axis] + jitter[axis]);
        self.check_placement_keys(&path, block.copy == 0).ok()?;
        let free = |[x, y]: [f64; 2], angle: f64| Placement::Free { position: [x + shift[0], y + shift[1]], angle };
        if self.is_written(&at("position")) {
            let (position, angle) = (self.pair(&at("position")), self.quantity(&at("angle")));
            return Some(free(position?, angle? + turned));
        }
        let [x, y] = shape.centre;
        if self.is_written(&at("centre")) {
            if self.doc.text(&at("shape.kind")) != Some("voussoir") {
                self.error(&at("centre"), "only a voussoir is placed by the arch's centre", "give its position");
                return None;
            }
            let [cx, cy] = self.pair(&at("centre"))?;
            return Some(free([cx + x, cy + y], 0.0));
        }
        if shape.is_in_place && !self.is_written(&at("on")) {
            return Some(free([x, y], 0.0));
        }
        self.placement_on(block, shift, contacts, joined)
    }

    /// By how much a copy is displaced (m) and turned (rad) at random.
    fn jitter(&self, block: &BlockName) -> ([f64; 2], f64) {
        let at = |key: &str| format!("block.{}.repeat.{key}", block.table);
        let most = self.doc.pair(&at("jitter")).unwrap_or_default();
        let most_angle = self.doc.quantity(&at("jitter_angle")).unwrap_or_default();
        let seed = self.doc.integer(&at("seed")).unwrap_or_default();
        let [x, y, angle] = jitter::of_copy(seed, &block.table, block.copy);
        ([x * most[0], y * most[1]], angle * most_angle)
    }

    /// Whether the document has a value at a path, valid or not.
    fn is_written(&self, path: &str) -> bool {
        self.doc.is_given(path) || self.doc.is_refused(path)
    }

    /// Refuses mutually exclusive keys of the placement of a block.
    fn check_placement_keys(&mut self, path: &str, is_first: bool) -> Result<(), AlreadyReported> {
        let at = |key: &str| format!("{path}.{key}");
        let standing = ["on", "at", "tilt"].into_iter().find(|key| self.is_written(&at(key)));
        let position = self.is_written(&at("position"));
        let centre = self.is_written(&at("centre"));
        let (key, rule, remedy) = match standing {
            Some(key) if position => {
                (key, "position already gives the place of the block", "keep position and angle, or on, at and tilt")
            }
            Some(key) if centre => {
                (key, "centre already gives the place of the block", "keep centre, or on, at and tilt")
            }
            _ if !position && self.doc.quantity(&at("repeat.jitter_angle")).is_some_and(|angle| angle > 0.0) => (
                "repeat.jitter_angle",
                "blocks are turned at random only about a position",
                "leave it out, or give position instead of on, at or centre",
            ),
            _ if position && centre => ("centre", "position already gives the place of the block", "keep one of them"),
            _ if position && self.doc.flag(&at("repeat.stacked")) == Some(true) => (
                "repeat.stacked",
                "stacked blocks stand on each other, but position gives their place",
                "give on and at, or shift instead of stacked",
            ),
            _ if self.doc.integer(&at("repeat.rows")).is_some_and(|rows| rows > 1)
                && self.doc.flag(&at("repeat.stacked")) == Some(true) =>
            {
                ("repeat.rows", "stacked blocks stand on each other in one pile", "give a table for each pile")
            }
            _ if !position && self.is_written(&at("angle")) => {
                ("angle", "angle applies only with position", "use tilt instead, or give position")
            }
            _ => return Ok(()),
        };
        // Once for all copies.
        if is_first {
            self.error(&at(key), rule, remedy);
        }
        Err(AlreadyReported)
    }

    /// The placement of a block on a body.
    fn placement_on(
        &mut self,
        block: &BlockName,
        shift: [f64; 2],
        contacts: &[Option<ContactScene>],
        joined: &Joined,
    ) -> Option<Placement> {
        let doc = self.doc;
        let (name, path) = (block.name.as_str(), format!("block.{}", block.table));
        let at = |key: &str| format!("{path}.{key}");
        if !self.is_written(&at("on")) {
            let remedy = "give on and at (and tilt), or position (and angle)";
            self.error(&path, "the position of the block is missing", remedy);
            return None;
        }
        if !self.is_written(&at("at")) {
            self.error(&at("at"), "required with on", "give x of the midpoint of its base, such as at = \"18 cm\"");
        }
        // Told at the key that does it, once for all copies.
        for (key, of) in [("repeat.shift", [1, 0]), ("repeat.row_shift", [0, 1]), ("repeat.jitter", [0, 0])] {
            let lifts = doc.pair(&at(key)).is_some_and(|shift| shift[1] != 0.0);
            if lifts && block.place == of {
                let rule = "blocks that stand on something can be shifted only along x";
                self.error(&at(key), rule, "set y to 0, or give a position instead of on and at");
            }
        }
        let on = block.stands_on.as_deref().map_or_else(|| doc.text(&at("on")), Some)?;
        let (x, tilt) = (doc.quantity(&at("at")), doc.quantity(&at("tilt")));
        let support = self.supporting_body(&at("on"), name, on).ok()?;
        let contact = joined.get(&(self.blocks.get(name).copied()?, support)).copied();
        if contact.is_none() && contacts.iter().all(Option::is_some) && !doc.is_refused("contact") {
            self.stands_without_contact(&at("on"), [name, on], support);
        }
        // A stacked block lies flat on the one before.
        let stacked = block.stands_on.is_some();
        let along_side = self.jitter(block).0[0];
        let (at, tilt) = if stacked {
            ((shift[0] - along_side) / block.copy as f64 + along_side, 0.0)
        } else {
            (x? + shift[0], tilt?)
        };
        Some(Placement::On { support, at, stacked, tilt, contact: contact? })
    }

    /// The body `on` on which the block `name` stands, given at `path`.
    fn supporting_body(&mut self, path: &str, name: &str, on: &str) -> Result<SupportingBody, AlreadyReported> {
        let Some(support) = self.support(on) else {
            self.no_body(path, on);
            return Err(AlreadyReported);
        };
        if on == name {
            self.error(path, "a block can't stand on itself", self.known_bodies());
            return Err(AlreadyReported);
        }
        Ok(support)
    }

    /// The shape of a block, and what it is made of.
    fn block_shape(&mut self, block: &BlockName) -> Option<BlockShape> {
        let path = format!("block.{}", block.table);
        let doc = self.doc;
        let is_voussoir = doc.text(&format!("{path}.shape.kind")) == Some("voussoir");
        let turn = doc.quantity(&format!("{path}.repeat.turn"));
        if turn.is_some() && !is_voussoir {
            let rule = "only voussoirs are turned about the centre of their arch";
            self.error(&format!("{path}.repeat.turn"), rule, "give shift or stacked instead");
            return None;
        }
        let keys = ShapeKeys::Block(doc, &path, turn.unwrap_or_default() * block.place[0] as f64);
        let way = self.told(&path, keys.way())?;
        let drawn = if way == Way::Parts {
            self.parts(&path)?
        } else {
            let drawn = self.told(&path, keys.drawn(way));
            let density = self.given_density(&path);
            vec![(drawn??, density)]
        };
        let depth = doc.quantity(&format!("{path}.depth"));
        let given = self.given_mass(&path)?;
        let of_part = |(part, density): &(Drawn, Option<f64>)| {
            // Where the mass is given only its centre counts, which is that of the area.
            let (density, depth) = if given.is_some() { (1.0, 1.0) } else { ((*density)?, depth?) };
            Some(mass_of(&part.shape, depth, density))
        };
        let masses: Vec<_> = drawn.iter().map(of_part).collect::<Option<_>>()?;
        let all = masses.into_iter().collect::<Result<Vec<_>, RigidError>>().and_then(|masses| {
            let together = if let [one] = *masses { one } else { MassProperties::together(&masses)? };
            Ok(together)
        });
        let (mass, centre) = match all {
            Ok(all) => all,
            Err(why) => {
                self.error(&path, why.to_string(), "correct its sizes or its density");
                return None;
            }
        };
        if let Some(given) = given {
            self.check_inertia(&path, given, &drawn, centre)?;
        }
        let matter = match (given, drawn.as_slice()) {
            (Some(given), _) => Matter::Given(given),
            (None, [(_, density)]) => Matter::Homogeneous { density: (*density)?, depth: depth? },
            (None, _) => Matter::Given(mass),
        };
        let is_sharp = matches!(drawn.as_slice(), [(Drawn { shape: Shape::Polygon(_), is_rectangle: true }, _)]);
        if is_sharp && way == Way::Sides {
            let extents = [doc.quantity(&format!("{path}.width"))?, doc.quantity(&format!("{path}.height"))?];
            return Some(BlockShape { parts: None, centre: [0.0; 2], is_in_place: false, extents, matter });
        }
        let about_centre = |(part, _): (Drawn, Option<f64>)| {
            let shape = outlines::moved(&part.shape, 0.0, -centre)?;
            Ok(BlockPart { shape, is_rectangle: part.is_rectangle })
        };
        let parts = match drawn.into_iter().map(about_centre).collect::<Result<Vec<_>, ShapeError>>() {
            Ok(parts) => parts,
            Err(why) => {
                self.error(&path, why.to_string(), "correct its shape");
                return None;
            }
        };
        let extents = match way {
            // Up to rounding the same, but these are the numbers that are given.
            Way::Sides => [doc.quantity(&format!("{path}.width"))?, doc.quantity(&format!("{path}.height"))?],
            _ => parts
                .iter()
                .map(|part| outlines::extents(&part.shape))
                .fold([0.0_f64, f64::INFINITY], |[large, small], [a, b]| [large.max(a), small.min(b)]),
        };
        let corners: usize = parts.iter().map(|part| part.shape.core().len()).sum();
        if corners > MOST_CORNERS {
            let rule = format!("the block has {corners} corners, more than the limit of {MOST_CORNERS}");
            self.error(&path, rule, "use fewer or simpler parts");
            return None;
        }
        // A voussoir is drawn about the centre of its arch, at the origin.
        let is_in_place = is_voussoir || matches!(way, Way::Points | Way::Parts);
        Some(BlockShape { parts: Some(parts.into()), centre: [centre.x, centre.y], is_in_place, extents, matter })
    }

    /// Reports a refused shape of the table at `path`.
    fn told<T>(&mut self, path: &str, found: Result<T, Refusal>) -> Option<T> {
        found
            .map_err(|Refusal { key, rule, remedy }| {
                let at = if key.is_empty() { path.to_owned() } else { format!("{path}.{key}") };
                // A value that was refused has its message, and so has a missing table.
                if !(self.doc.is_refused(&at) || (key.is_empty() && self.partial)) {
                    self.error(&at, rule, remedy);
                }
            })
            .ok()
    }

    /// The parts of a block where they are in it, with their densities.
    fn parts(&mut self, path: &str) -> Option<Vec<(Drawn, Option<f64>)>> {
        let doc = self.doc;
        let at = format!("{path}.parts");
        let parts = doc.items(&at)?;
        if parts.is_empty() {
            self.error(&at, "there are no parts", "give at least one, such as { radius = \"2 cm\" }");
            return None;
        }
        if let Some(key) = ["rounding", "chamfer"].into_iter().find(|key| doc.is_given(&format!("{path}.{key}"))) {
            self.error(&format!("{path}.{key}"), "it belongs to the parts of this block", "give it in the parts");
            return None;
        }
        let own = ["material", "density"].iter().any(|key| doc.is_given(&format!("{path}.{key}")));
        let of_block = if own { self.given_density(path) } else { None };
        let mut all = Vec::new();
        for (number, part) in parts.iter().enumerate() {
            let keys = ShapeKeys::Part(part);
            let refused = |Refusal { key, rule, remedy }: Refusal| {
                let key = if key.is_empty() { String::new() } else { format!("{key}: ") };
                Refusal { key: "parts", rule: format!("part {}: {key}{rule}", number + 1), remedy }
            };
            let drawn = keys.way().and_then(|way| keys.drawn(way)).map_err(refused);
            let drawn = self.told(path, drawn)??;
            let by = Vector2::from(part.pair("at").unwrap_or_default());
            let shape = outlines::moved(&drawn.shape, part.number("angle").unwrap_or_default(), by);
            let shape = shape
                .map_err(|why| refused(Refusal { key: "", rule: why.to_string(), remedy: "correct it".to_owned() }));
            let shape = self.told(path, shape)?;
            let density = match part.text("material") {
                Some(name) => {
                    Some(self.material_named(&at, name)?).and_then(|m| self.quantity(&format!("{m}.density")))
                }
                None => of_block,
            };
            if density.is_none() && !doc.is_given(&format!("{path}.mass")) {
                let rule = format!("part {} has no material, and the block has none", number + 1);
                self.error(&at, rule, "give each part a material, or the block one");
                return None;
            }
            all.push((Drawn { shape, is_rectangle: drawn.is_rectangle }, density));
        }
        Some(all)
    }

    /// The density of a block, by its material or by itself; `None` if its mass is given, too.
    fn given_density(&mut self, path: &str) -> Option<f64> {
        let doc = self.doc;
        let (material, density) = (format!("{path}.material"), format!("{path}.density"));
        match (doc.is_given(&material), doc.is_given(&density)) {
            (true, true) => {
                self.error(&density, "the material has a density already", "give material or density");
                None
            }
            (false, true) => doc.quantity(&density),
            (false, false) if doc.is_given(&format!("{path}.mass")) || doc.is_refused(&format!("{path}.mass")) => None,
            _ => self.material(path).and_then(|material| self.quantity(&format!("{material}.density"))),
        }
    }

    /// Mass and moment of inertia, if they are given: both or neither.
    fn given_mass(&mut self, path: &str) -> Option<Option<MassProperties>> {
        let doc = self.doc;
        let at = |key: &str| format!("{path}.{key}");
        let (mass, inertia) = (doc.quantity(&at("mass")), doc.quantity(&at("inertia")));
        let (mass, inertia) = match (mass, inertia) {
            (Some(mass), Some(inertia)) => (mass, inertia),
            (None, None) if self.is_written(&at("mass")) || self.is_written(&at("inertia")) => return None,
            (None, None) => return Some(None),
            (one, _) => {
                let [has, lacks] = if one.is_some() { ["mass", "inertia"] } else { ["inertia", "mass"] };
                if !doc.is_refused(&at(lacks)) {
                    let remedy = format!("add {lacks}, or give material and depth instead of both");
                    self.error(&at(has), format!("{has} needs {lacks}, too"), remedy);
                }
                return None;
            }
        };
        let density = ["density", "depth"].into_iter().find(|key| doc.is_given(&at(key)));
        if let Some(key) = density {
            self.error(&at(key), "mass and inertia are given already", "give mass and inertia, or material and depth");
            return None;
        }
        MassProperties::new(mass, inertia)
            .map_err(|why| self.error(&at("mass"), why.to_string(), "give a positive mass and inertia"))
            .ok()
            .map(Some)
    }

    /// Refuses a moment of inertia that is larger than with all of the mass at the shape's furthest point from the mass centre.
    fn check_inertia(
        &mut self,
        path: &str,
        given: MassProperties,
        drawn: &[(Drawn, Option<f64>)],
        centre: Vector2<f64>,
    ) -> Option<()> {
        /// Relative: the limit may be given with the six digits that the message has.
        const ROUNDING: f64 = 1e-5;
        let reach = |(part, _): &(Drawn, Option<f64>)| {
            let furthest = part.shape.core().iter().map(|corner| (corner - centre).norm()).fold(0.0, f64::max);
            furthest + part.shape.radius()
        };
        let reach = drawn.iter().map(reach).fold(0.0, f64::max);
        let most = given.mass * reach * reach;
        if given.inertia <= most * (1.0 + ROUNDING) {
            return Some(());
        }
        let rule = format!(
            "no distribution of {} kg over this shape has so much: its furthest point is {} m from the mass centre",
            few_digits(given.mass),
            few_digits(reach)
        );
        let remedy = format!("give at most {} kg m^2 about the mass centre, or a larger shape", few_digits(most));
        self.error(&format!("{path}.inertia"), rule, remedy);
        None
    }

    /// Reports blocks that stand on each other in a cycle.
    pub(super) fn check_support_cycles(&mut self, blocks: &[Option<BlockScene>]) {
        let below = |block: usize| match blocks.get(block) {
            Some(Some(BlockScene {
                placement: Placement::On { support: SupportingBody::Block(below), .. }, ..
            })) => Some(*below),
            _ => None,
        };
        // The lowest block of a pile stands on no block. What is known to lead there is not followed
        // again, so that a tall pile is passed through once.
        let mut ends = vec![false; blocks.len()];
        let circle = (0..blocks.len()).find(|&block| {
            let (mut way, mut at) = (Vec::new(), Some(block));
            while let Some(now) = at.filter(|now| ends.get(*now) == Some(&false)) {
                if way.len() > blocks.len() {
                    return true;
                }
                way.push(now);
                at = below(now);
            }
            way.into_iter().for_each(|passed| ends[passed] = true);
            false
        });
        if let Some(Some(block)) = circle.and_then(|block| blocks.get(block)) {
            let rule = "blocks stand on each other in a cycle, and none of them on anything else";
            self.error(
                &format!("block.{}.on", block.name),
                rule,
                "place one of them on the ground or a beam, or give it a position",
            );
        }
    }

    /// Reports a block that doesn't fit on the beam it stands on.
    fn stands(
        &mut self,
        name: &str,
        block: &BlockScene,
        beams: &[Option<BeamScene>],
        contacts: &[Option<ContactScene>],
    ) {
        let Placement::On { support: SupportingBody::Beam(number), at, tilt, contact, .. } = block.placement else {
            return;
        };
        let path = |key: &str| format!("block.{name}.{key}");
        let Some(Some(beam)) = beams.get(number) else { return };
        let (left, span, width) = (beam.start_position()[0], beam.spec.span, block.base());
        if width > span {
            let rule = format!("the block is {width} m wide, but the span of `{}` is {span} m", beam.name);
            let key = if block.parts.is_none() { path("width") } else { path("at") };
            self.error(&key, rule, "use a block narrower than the span");
            return;
        }
        let [first, second] = block.feet().map(|foot| block.corner_name(foot));
        let feet = [(&first, at - 0.5 * width), (&second, at + 0.5 * width)];
        // The ends belong to the beam, and decimal positions reach them only up to rounding.
        let rounding = 4.0 * f64::EPSILON * (left.abs() + span + at.abs());
        // Its base may overhang an end where that can touch it; as it is more often a slip, this must be
        // asked for.
        let over = |x: f64| (left - rounding..=left + span + rounding).contains(&x);
        let contact = contacts.get(contact).and_then(Option::as_ref);
        let ask = contact.filter(|contact| contact.sides && tilt == 0.0 && feet.iter().any(|(_, x)| over(*x)));
        let asking = ask.map(|contact| format!("contact.{}.points", contact.name));
        if asking.as_ref().is_some_and(|key| self.doc.is_given(key)) {
            return;
        }
        for (number, (corner, x)) in feet.into_iter().enumerate() {
            // The corner lifted by a tilt may be beyond the end.
            let lifted = usize::from(tilt > 0.0);
            if (tilt == 0.0 || number != lifted) && !over(x) {
                let rule = format!(
                    "the corner {corner} at x = {x} m is outside `{}`, which extends from {left} m to {} m",
                    beam.name,
                    left + span
                );
                let (low, high) = (left + 0.5 * width, left + span - 0.5 * width);
                let mut remedy = format!("place the midpoint of its base between {low} m and {high} m");
                if let Some(key) = &asking {
                    remedy += &format!("; if it is to overhang the end, write {key} = \"all\"");
                }
                self.error(&path("at"), rule, remedy);
            }
        }
    }
}
