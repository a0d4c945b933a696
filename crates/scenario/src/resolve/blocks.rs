//! Resolves blocks: shape, position, and whether they fit on what they stand on.

use std::sync::Arc;

use nalgebra::Vector2;
use teeter_detect::Polygon;
use teeter_rigid::MassProperties;

use super::Resolver;
use super::contacts::Joined;
use super::names::BlockName;
use crate::scene::{BeamScene, BlockScene, ContactScene, Placement, SignalScene, SupportingBody};

/// An error that has been reported.
struct AlreadyReported;

/// The polygon of a block given by its points.
struct PolygonScene {
    /// Corners relative to its mass centre.
    corners: Arc<[Vector2<f64>]>,
    /// Its mass centre in the coordinates of the points, m.
    centre: [f64; 2],
    /// The largest and the smallest of its extents across its sides, m.
    extents: [f64; 2],
}

impl PolygonScene {
    fn new(points: &[[f64; 2]]) -> Result<Self, String> {
        let drawn = Polygon::new(points.iter().copied().map(Vector2::from).collect()).map_err(|why| why.to_string())?;
        let corners = drawn.corners();
        let (_, centre) = MassProperties::polygon(corners, 1.0, 1.0).map_err(|why| why.to_string())?;
        let corners: Arc<[Vector2<f64>]> = corners.iter().map(|corner| corner - centre).collect();
        let across = |k: usize| {
            let side = (corners[(k + 1) % corners.len()] - corners[k]).normalize();
            corners.iter().map(|corner| side.perp(&(corner - corners[k]))).fold(0.0, f64::max)
        };
        let extents = (0..corners.len()).map(across);
        let [large, small] = extents.fold([0.0_f64, f64::INFINITY], |[large, small], x| [large.max(x), small.min(x)]);
        Ok(Self { corners, centre: [centre.x, centre.y], extents: [large, small] })
    }
}

impl Resolver<'_, '_> {
    pub(super) fn block(
        &mut self,
        block: &BlockName,
        beams: &[Option<BeamScene>],
        contacts: &[Option<ContactScene>],
        joined: &Joined,
        signals: &[Option<SignalScene>],
    ) -> Option<BlockScene> {
        let path = format!("block.{}", block.table);
        let at = |key: &str| format!("{path}.{key}");
        let density = self.material(&path).and_then(|m| self.quantity(&format!("{m}.density")));
        let (polygon, width, height) = match self.polygon(block) {
            Ok(Some(polygon)) => {
                let [width, height] = polygon.extents;
                (Some(polygon), Some(width), Some(height))
            }
            Ok(None) => (None, self.quantity(&at("width")), self.quantity(&at("height"))),
            Err(AlreadyReported) => return None,
        };
        let depth = self.quantity(&at("depth"));
        let velocity = self.pair(&at("velocity"));
        let spin = self.quantity(&at("spin"));
        let motion = self.motion(&path, signals);
        if let (Some(motion), Some([x, y]), Some(spin)) = (&motion, velocity, spin) {
            for (key, value, axis) in [("velocity", x, 0), ("velocity", y, 1), ("spin", spin, 2)] {
                if value != 0.0 && motion.0[axis].is_some() {
                    let remedy =
                        "leave it out, or set the prescribed components to 0: the motion has its own velocity at 0 s";
                    self.error(&at(key), "the motion of the block prescribes this velocity", remedy);
                }
            }
        }
        let drawn = polygon.as_ref().map(|polygon| polygon.centre);
        let placement = self.placement(block, drawn, contacts, joined);
        if let (Some(width), Some(placement)) = (width, &placement) {
            self.stands(&block.table, width, placement, beams);
        }
        Some(BlockScene {
            name: block.name.clone(),
            width: width?,
            height: height?,
            polygon: polygon.map(|polygon| polygon.corners),
            depth: depth?,
            density: density?,
            placement: placement?,
            velocity: velocity?,
            spin: spin?,
            motion: motion?,
        })
    }

    fn placement(
        &mut self,
        block: &BlockName,
        drawn: Option<[f64; 2]>,
        contacts: &[Option<ContactScene>],
        joined: &Joined,
    ) -> Option<Placement> {
        let path = format!("block.{}", block.table);
        let at = |key: &str| format!("{path}.{key}");
        let shift = self.doc.pair(&at("repeat.shift")).unwrap_or_default().map(|shift| block.copy as f64 * shift);
        self.check_placement_keys(&path, drawn.is_some()).ok()?;
        if self.is_written(&at("position")) {
            let (position, angle) = (self.pair(&at("position")), self.quantity(&at("angle")));
            let [x, y] = position?;
            return Some(Placement::Free { position: [x + shift[0], y + shift[1]], angle: angle? });
        }
        if let Some([x, y]) = drawn {
            return Some(Placement::Free { position: [x + shift[0], y + shift[1]], angle: 0.0 });
        }
        self.placement_on(block, shift, contacts, joined)
    }

    /// Whether the document has a value at a path, valid or not.
    fn is_written(&self, path: &str) -> bool {
        self.doc.is_given(path) || self.doc.is_refused(path)
    }

    /// Refuses mutually exclusive keys of the placement of a block, which may be drawn by its
    /// points.
    fn check_placement_keys(&mut self, path: &str, drawn: bool) -> Result<(), AlreadyReported> {
        let at = |key: &str| format!("{path}.{key}");
        let standing = ["on", "at", "tilt"].into_iter().find(|key| self.is_written(&at(key)));
        let position = self.is_written(&at("position"));
        let (key, rule, remedy) = match standing {
            Some(key) if drawn => (
                key,
                "a block given by its points has no base to stand on",
                "leave it out, as the block starts where its points are, or give position and angle",
            ),
            Some(key) if position => {
                (key, "position already gives the place of the block", "keep position and angle, or on, at and tilt")
            }
            _ if position && self.doc.flag(&at("repeat.stacked")) == Some(true) => (
                "repeat.stacked",
                "stacked blocks stand on each other, but position gives their place",
                "give on and at, or shift instead of stacked",
            ),
            _ if !position && self.is_written(&at("angle")) => {
                ("angle", "angle applies only with position", "use tilt instead, or give position")
            }
            _ => return Ok(()),
        };
        self.error(&at(key), rule, remedy);
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
        if shift[1] != 0.0 {
            let rule = "blocks that stand on something can be shifted only along x";
            self.error(&at("repeat.shift"), rule, "set y to 0, or give a position instead of on and at");
        }
        let on = block.stands_on.as_deref().map_or_else(|| doc.text(&at("on")), Some)?;
        let (x, tilt) = (doc.quantity(&at("at")), doc.quantity(&at("tilt")));
        let support = self.supporting_body(&at("on"), name, on).ok()?;
        let contact = joined.get(&(self.blocks.get(name).copied()?, support)).copied();
        if contact.is_none() && contacts.iter().all(Option::is_some) && !doc.is_refused("contact") {
            let rule = format!("the block stands on `{on}`, but there is no contact between the two");
            let remedy = format!("add [contact.NAME] with between = [\"{name}\", \"{on}\"]");
            self.error(&at("on"), rule, remedy);
        }
        // A stacked block lies flat on the one before.
        let stacked = block.stands_on.is_some();
        let (at, tilt) = if stacked { (shift[0] / block.copy as f64, 0.0) } else { (x? + shift[0], tilt?) };
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
        if let SupportingBody::Block(below) = support
            && self.doc.is_given(&format!("block.{}.points", self.block_names[below].table))
        {
            let rule = format!("`{on}` is a block given by its points, which has no upper side to stand on");
            self.error(path, rule, "give position and angle instead of on, at and tilt");
            return Err(AlreadyReported);
        }
        Ok(support)
    }

    /// The polygon of a block, if it is given by its points.
    fn polygon(&mut self, block: &BlockName) -> Result<Option<PolygonScene>, AlreadyReported> {
        let path = format!("block.{}.points", block.table);
        if self.doc.is_refused(&path) {
            return Err(AlreadyReported);
        }
        let Some(points) = self.doc.points(&path) else { return Ok(None) };
        for key in ["width", "height"] {
            let at = format!("block.{}.{key}", block.table);
            if self.doc.is_given(&at) {
                self.error(&at, "points already give the shape of the block", "keep points, or width and height");
                return Err(AlreadyReported);
            }
        }
        PolygonScene::new(points)
            .map_err(|why| {
                self.error(&path, why, "give at least three corners of a convex polygon, in order around it");
                AlreadyReported
            })
            .map(Some)
    }

    /// Reports blocks that stand on each other in a cycle.
    pub(super) fn check_support_cycles(&mut self, blocks: &[Option<BlockScene>]) {
        let below = |block: usize| match blocks.get(block) {
            Some(Some(BlockScene {
                placement: Placement::On { support: SupportingBody::Block(below), .. }, ..
            })) => Some(*below),
            _ => None,
        };
        // The lowest block of a pile stands on no block; following more blocks than there are means
        // a cycle.
        let circle = (0..blocks.len()).find(|&block| (0..blocks.len()).try_fold(block, |at, _| below(at)).is_some());
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
    fn stands(&mut self, name: &str, width: f64, placement: &Placement, beams: &[Option<BeamScene>]) {
        let Placement::On { support: SupportingBody::Beam(number), at, tilt, .. } = *placement else { return };
        let path = |key: &str| format!("block.{name}.{key}");
        let Some(Some(beam)) = beams.get(number) else { return };
        let (left, span) = (beam.position[0], beam.spec.span);
        if width > span {
            let rule = format!("the block is {width} m wide, but the span of `{}` is {span} m", beam.name);
            self.error(&path("width"), rule, "use a block narrower than the span");
            return;
        }
        let feet = [("bottom-left", at - 0.5 * width), ("bottom-right", at + 0.5 * width)];
        // The ends belong to the beam, and decimal positions reach them only up to rounding.
        let rounding = 4.0 * f64::EPSILON * (left.abs() + span + at.abs());
        for (corner, x) in feet {
            // The corner lifted by a tilt may be beyond the end.
            let lifted = if tilt > 0.0 { "bottom-right" } else { "bottom-left" };
            if (tilt == 0.0 || corner != lifted) && !(left - rounding..=left + span + rounding).contains(&x) {
                let rule = format!(
                    "the corner {corner} at x = {x} m is outside `{}`, which extends from {left} m to {} m",
                    beam.name,
                    left + span
                );
                let (low, high) = (left + 0.5 * width, left + span - 0.5 * width);
                self.error(&path("at"), rule, format!("place the midpoint of its base between {low} m and {high} m"));
            }
        }
    }
}
