//! What stands in the picture: sizes and places that don't change.

use super::bands::BAND_COLUMNS;
use super::recorder::{BEAM_MOVED, BLOCK_COLUMNS, ENERGIES, MOST_CURVES, MOTION_COLUMNS};
use super::{DIGITS, rounded};
use crate::driven::Driven;
use crate::own_weight;
use crate::probe::Probe;
use crate::verdict::is_carried;
use serde::Serialize;
use std::collections::BTreeSet;
use std::sync::Arc;
use teeter_beam::{Axial, Hold, Support};
use teeter_detect::OnSide;
use teeter_integrator::{BeamFace, State};
use teeter_scenario::physical::{self, PhysicalTable};
use teeter_scenario::scene::{
    self, BlockScene, Crowd, Display, ForceScene, LoadScene, Placement, RecordScene, Scene, SupportingBody,
};
use teeter_scenario::simulation::{BeamPlace, Layout};
use teeter_scenario::wording;

/// A block as drawn.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct BlockDrawn {
    pub(crate) name: String,
    /// Corners about its mass centre, counter-clockwise, m: of round parts those of the core.
    pub(crate) corners: Vec<[f64; 2]>,
    /// How many of them each part has, and how far it reaches beyond them, m.
    pub(crate) parts: Vec<(usize, f64)>,
    /// Whether it is a rectangle, its first corner bottom left.
    pub(crate) upright: bool,
    /// Critical angle of a rectangle, rad.
    pub(crate) alpha: Option<f64>,
    /// Largest distance from its mass centre to its outline, m.
    pub(crate) reach: f64,
    /// Whether all of its motion is prescribed, as of a fixed wall.
    pub(crate) driven: bool,
    /// Which of x, y and φ are.
    #[serde(skip)]
    pub(crate) prescribed: [bool; 3],
}

/// A beam as drawn.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct BeamDrawn {
    pub(crate) name: String,
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) span: f64,
    pub(crate) thickness: f64,
    /// Whether contact is with its top fibre.
    pub(crate) top: bool,
    pub(crate) supports: [&'static str; 2],
    /// Supports between the ends: where, and how.
    pub(crate) inner: Vec<(f64, &'static str)>,
    /// Foundations: from where to where, m.
    pub(crate) foundations: Vec<(f64, f64)>,
    /// Masses that it carries: where.
    pub(crate) masses: Vec<f64>,
    /// Of its supports at the ends and between, in their order, whether they have dashpots.
    pub(crate) dashpots: Vec<bool>,
    /// Whether its left and its right end are held along the axis.
    pub(crate) held: [bool; 2],
    /// Whether a support or a foundation carries it.
    #[serde(skip)]
    pub(crate) is_carried: bool,
    /// Whether the scene leaves out its own weight.
    #[serde(skip)]
    pub(crate) is_without_weight: bool,
    /// Points along the span, evenly spread.
    pub(crate) points: usize,
    #[serde(skip)]
    pub(crate) places: Vec<Probe>,
    #[serde(skip)]
    pub(crate) middle: Probe,
    /// Whether it moves along its axis as a whole, as where neither end is held along it. What it stretches by can't be seen.
    #[serde(skip)]
    pub(crate) drifts: bool,
    /// The probes whose deflection is recorded, but for one at midspan, and free ends: where, m, and how.
    #[serde(skip)]
    pub(crate) probes: Vec<(f64, Probe)>,
    /// Whether one of them is at midspan.
    #[serde(skip)]
    pub(crate) probed_middle: bool,
}

impl BeamDrawn {
    /// Whether no support and no foundation holds it: it lies on blocks or ground, or flies.
    pub(crate) fn is_free(&self) -> bool {
        !self.is_carried
    }

    /// Whether it moves as a whole: with its supports, or along its axis.
    pub(crate) fn moves(&self, place: &BeamPlace) -> bool {
        place.supports.is_some() || self.drifts
    }

    /// How far it has moved as a whole along x and y, m: as its supports have, and along its axis.
    pub(crate) fn moved(&self, place: &BeamPlace, state: &State) -> [f64; 2] {
        let [x, y] = place.support_displacement(&state.q);
        let along =
            if self.drifts { place.axial_displacement_at(&state.q[place.range.clone()], 0.5 * self.span) } else { 0.0 };
        [x + along, y]
    }

    /// A deflection (m) at this part of the span, from the line through the ends (whose deflections are `ends`) of a beam that nothing holds, as its
    /// motion as a whole is no bending.
    pub(crate) fn off_line(&self, part: f64, w: f64, [left, right]: [f64; 2]) -> f64 {
        if self.is_free() { w - left - (right - left) * part } else { w }
    }

    /// The same at x (m), with the deflections of the ends from the coordinates of the beam.
    pub(crate) fn bending(&self, x: f64, w: f64, q: &[f64]) -> f64 {
        let (Some(first), Some(last), true) = (self.places.first(), self.places.last(), self.is_free()) else {
            return w;
        };
        self.off_line(x / self.span, w, [first.deflection(q), last.deflection(q)])
    }
}

/// A contact pair as drawn.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct ContactDrawn {
    pub(crate) name: String,
    pub(crate) block: usize,
    /// The name of what the block touches.
    pub(crate) surface: String,
    /// The beam's number; none for ground and blocks.
    pub(crate) beam: Option<usize>,
    /// The other block's number; none for ground and beams.
    pub(crate) other: Option<usize>,
    /// Whether the normal stays upright.
    pub(crate) linear: bool,
    /// Whether it is with the lower face of a beam.
    pub(crate) lower: bool,
    /// Where it can touch.
    pub(crate) points: Vec<PointDrawn>,
    /// Whether its law has springs, whose forces follow from the motion.
    #[serde(skip)]
    pub(crate) has_duration: bool,
    /// Whether a beam carries what touches, directly or by other blocks, so that its ringing is in the forces.
    #[serde(skip)]
    pub(crate) rings: bool,
    /// Whether it has friction.
    #[serde(skip)]
    pub(crate) has_friction: bool,
    /// The number of its first point among those of all contacts.
    #[serde(skip)]
    pub(crate) first: usize,
}

/// A point at which a pair can touch.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct PointDrawn {
    /// What it is called in legends.
    pub(crate) label: String,
    /// The block that has it.
    pub(crate) block: usize,
    /// The corner of the block.
    pub(crate) corner: usize,
    /// Its initials, or its number.
    pub(crate) short: String,
    /// The point of the ground's profile that touches, in the ground's coordinates, m; none for a
    /// corner.
    pub(crate) crest: Option<[f64; 2]>,
    /// What of a beam touches a side of the block; none for a corner.
    pub(crate) on_side: Option<OnSideDrawn>,
}

/// What of a beam touches a side of a block.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum OnSideDrawn {
    /// Its left end (0), or its right one (1).
    End(usize),
    /// Where it comes up furthest.
    Hump,
}

/// All of it.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Scenery {
    pub(crate) ground: bool,
    /// Slope of ground that stands still, rad.
    pub(crate) incline: f64,
    /// Points of the ground's profile, in its coordinates, m; empty for a straight line.
    pub(crate) profile: Vec<[f64; 2]>,
    pub(crate) blocks: Vec<BlockDrawn>,
    pub(crate) beams: Vec<BeamDrawn>,
    pub(crate) contacts: Vec<ContactDrawn>,
    /// Points of all contacts.
    #[serde(skip)]
    pub(crate) points: usize,
    /// Points that can touch where there are too many to draw them one by one; 0 otherwise.
    pub(crate) hidden_points: usize,
    /// Whether pairs of blocks aren't even listed.
    pub(crate) unlisted: bool,
    /// The bodies of each pair of the model: a block, and what it touches.
    #[serde(skip)]
    listed: Vec<(usize, SupportingBody)>,
    #[serde(skip)]
    crowd: Option<Arc<Crowd>>,
    /// Of each block whether it was placed on another one.
    #[serde(skip)]
    on_blocks: Vec<bool>,
    /// The forces on blocks, and the loads on beams.
    #[serde(skip)]
    pub(crate) forces: Vec<ForceScene>,
    #[serde(skip)]
    pub(crate) loads: Vec<LoadScene>,
    /// The records that prescribe motions.
    #[serde(skip)]
    pub(crate) records: Vec<Arc<RecordScene>>,
    /// What else is prescribed of ground and supports: all of it.
    #[serde(skip)]
    pub(crate) driven: Vec<Driven>,
    /// The prescribed motions, by their numbers, from which x and y of the blocks are plotted: of the ground or of a beam's supports, which would hide how they slide
    /// and rock on it. Not where they may stand on something else.
    #[serde(skip)]
    pub(crate) bases: [Option<usize>; 2],
    /// Sizes, masses, sections, friction.
    #[serde(skip)]
    pub(crate) physical: Vec<PhysicalTable>,
    /// Units of axes, width of figures.
    #[serde(skip)]
    pub(crate) display: Display,
    /// The energy that lifts every block by its own size, J: what energies are measured by.
    #[serde(skip)]
    pub(crate) weight_energy: f64,
}

/// BL of bottom-left, 3 of corner-3, 2 R of part-2.rim.
fn short(corner: &str) -> String {
    if let Some((part, corner)) = corner.strip_prefix("part-").and_then(|rest| rest.split_once('.')) {
        return format!("{part} {}", short(corner));
    }
    match corner.strip_prefix("corner-") {
        Some(number) => number.to_owned(),
        None => {
            corner.split('-').filter_map(|word| word.chars().next()).map(|first| first.to_ascii_uppercase()).collect()
        }
    }
}

/// Of each block, whether it can touch a beam, or other blocks that can, and so on.
fn on_beams(scene: &Scene) -> Vec<bool> {
    let mut found = vec![false; scene.blocks.len()];
    let mut grows = true;
    while grows {
        grows = false;
        for contact in &scene.contacts {
            let other = contact.other_block();
            let rings = matches!(contact.surface, SupportingBody::Beam(_))
                || found[contact.block]
                || other.is_some_and(|other| found[other]);
            for block in [Some(contact.block), other].into_iter().flatten().filter(|_| rings) {
                grows |= !std::mem::replace(&mut found[block], true);
            }
        }
    }
    found
}

/// Most points of contacts that are drawn one by one: of more nobody could tell whose curve is
/// whose, and the page would be large.
const MOST_POINTS: usize = 2000;

/// Pieces of a beam's line: enough that the eye sees a curve.
const PIECES: usize = 40;

/// Most pieces of a beam's line.
const MOST_PIECES: usize = 80;

/// Whether a support has a dashpot across the axis.
fn has_dashpot(support: Support) -> bool {
    matches!(support, Support::Elastic { deflection: Hold::Spring { damping, .. }, .. } if damping > 0.0)
}

/// The word for an end that nothing holds.
pub(crate) const FREE: &str = "free";

/// Whether a place is midspan, up to rounding.
fn is_middle(x: f64, span: f64) -> bool {
    (x - 0.5 * span).abs() <= 1e-9 * span
}

impl Scenery {
    /// Whether a block may touch other blocks.
    pub(crate) fn touches_blocks(&self, block: usize) -> bool {
        self.listed.iter().any(|(one, other)| match other {
            SupportingBody::Block(other) => [*one, *other].contains(&block),
            SupportingBody::Ground | SupportingBody::Beam(_) => false,
        }) || self.crowd.is_some()
    }

    /// Whether a block stands on another one, against which its angle counts.
    pub(crate) fn is_on_block(&self, block: usize) -> bool {
        self.on_blocks.get(block).is_some_and(|is_on_block| *is_on_block)
    }

    /// Whether a block stands on a beam.
    pub(crate) fn is_on_beam(&self, block: usize) -> bool {
        self.listed.iter().any(|(one, surface)| *one == block && matches!(surface, SupportingBody::Beam(_)))
    }

    /// Whether none of a block's contacts has springs.
    pub(crate) fn touches_rigidly(&self, block: usize) -> bool {
        let own = |contact: &&ContactDrawn| contact.block == block || contact.other == Some(block);
        self.contacts.iter().filter(own).all(|contact| !contact.has_duration)
    }

    /// Whether a block stands on one thing only, which is ground or a beam on supports: Housner's ratio is of such a block on rigid ground. It says
    /// nothing of a column with a beam on it, or of a stone on a beam that lies on columns.
    pub(crate) fn stands_alone(&self, block: usize) -> bool {
        let mut on = self.listed.iter().filter(|(one, _)| *one == block).map(|(_, surface)| *surface);
        let carries = |surface| match surface {
            SupportingBody::Ground => true,
            SupportingBody::Beam(beam) => !self.beams[beam].is_free(),
            SupportingBody::Block(_) => false,
        };
        let first = on.next();
        first.is_some_and(carries) && on.all(|other| Some(other) == first) && !self.touches_blocks(block)
    }

    /// What is said of forces in these beams: nothing unless they are without the own weight of some.
    pub(crate) fn without_weight(&self, beams: impl Iterator<Item = usize>) -> Option<String> {
        let shown: BTreeSet<usize> = beams.collect();
        let without = shown.iter().map(|beam| &self.beams[*beam]).filter(|beam| beam.is_without_weight);
        own_weight::told(&without.map(|beam| beam.name.as_str()).collect::<Vec<_>>(), shown.len())
    }

    pub(crate) fn new(scene: &Scene, layout: &Layout) -> Self {
        let blocks = scene.blocks.iter().map(|block| BlockDrawn {
            name: block.name.clone(),
            corners: block.corners().iter().map(|corner| [corner.x, corner.y]).collect(),
            parts: match &block.parts {
                None => vec![(block.corner_count(), 0.0)],
                Some(parts) => parts.iter().map(|part| (part.shape.core().len(), part.shape.radius())).collect(),
            },
            upright: block.parts.is_none(),
            alpha: block.critical_angle(),
            reach: rounded(block.radius(), DIGITS),
            driven: block.motion.is_whole(),
            prescribed: [0, 1, 2].map(|axis| block.motion.0[axis].is_some()),
        });
        let beams = scene.beams.iter().zip(&layout.beams).map(|(drawn, place)| {
            let (elements, span) = (place.beam.elements(), drawn.spec.span);
            // A multiple of the elements, so that every node is a point, where that is not too many.
            let pieces = (elements * PIECES.div_ceil(elements)).min(MOST_PIECES);
            let at = |x: f64| Probe::new(place, place.beam.shape_clamped(x));
            let supports = drawn.spec.supports.map(wording::support);
            let is_carried = is_carried(&drawn.spec);
            let held = match drawn.spec.axial {
                Axial::Held => [true; 2],
                Axial::Elastic { held, .. } => held,
                // Its left end stays where it is.
                _ => [true, false],
            };
            BeamDrawn {
                name: drawn.name.clone(),
                x: drawn.position[0],
                y: drawn.position[1],
                span,
                thickness: drawn.thickness,
                top: drawn.top,
                supports,
                inner: drawn
                    .spec
                    .inner_supports
                    .iter()
                    .map(|inner| (inner.x, wording::support(inner.support)))
                    .collect(),
                foundations: drawn.spec.foundations.iter().map(|of| (of.from, of.to)).collect(),
                masses: drawn.spec.lumps.iter().map(|lump| lump.x).collect(),
                dashpots: {
                    let inner = drawn.spec.inner_supports.iter().map(|inner| inner.support);
                    drawn.spec.supports.into_iter().chain(inner).map(has_dashpot).collect()
                },
                held,
                is_carried,
                is_without_weight: own_weight::is_left_out(scene, drawn),
                points: pieces + 1,
                places: (0..=pieces).map(|k| at(span * (k as f64 / pieces as f64))).collect(),
                middle: at(0.5 * span),
                drifts: held == [false; 2],
                probes: {
                    let recorded = drawn.output.quantities.contains(&scene::BeamQuantity::Deflection);
                    let asked = place.probes.iter().copied().filter(|x| recorded && !is_middle(*x, span));
                    // The end of a cantilever deflects most; of a beam that nothing holds it is no place of its own.
                    let ends = [0.0, span].into_iter().zip(supports);
                    let free = ends.filter(|(_, support)| is_carried && *support == FREE);
                    let mut places: Vec<f64> = asked.chain(free.map(|(end, _)| end)).collect();
                    places.sort_by(f64::total_cmp);
                    places.dedup();
                    places.into_iter().map(|x| (x, at(x))).collect()
                },
                probed_middle: place.probes.iter().any(|x| is_middle(*x, span)),
            }
        });
        let profile = scene.ground.as_ref().and_then(|ground| ground.profile.as_ref());
        let profile = profile.map(|profile| profile.points().map(|point| [point.x, point.y]).collect());
        let profile: Vec<[f64; 2]> = profile.unwrap_or_default();
        let mut points = 0;
        let all: usize = layout.pairs.iter().map(|pair| pair.points.len()).sum();
        let shown = if all > MOST_POINTS { 0 } else { scene.contacts.len() };
        let on_beams = on_beams(scene);
        let contacts = scene.contacts.iter().zip(&layout.pairs).take(shown).map(|(contact, pair)| {
            let drawn = pair.points.iter().map(|point| PointDrawn {
                label: match point.on_side {
                    // The beam's, not the block's.
                    Some(_) => format!("{} of {}", point.name.replace('-', " "), scene.name_of(contact.surface)),
                    None => point.name.replace(['-', '.'], " "),
                },
                block: point.block,
                corner: point.corner,
                short: match (point.crest, point.on_side) {
                    (Some(crest), _) => format!("crest {}", crest + 1),
                    (None, Some(_)) => point.name.replace('-', " "),
                    (None, None) => short(&scene.blocks[point.block].corner_name(point.corner)),
                },
                crest: point.crest.and_then(|crest| profile.get(crest).copied()),
                on_side: match point.on_side {
                    Some(OnSide::End(which) | OnSide::EndAtRounding(which)) => Some(OnSideDrawn::End(which)),
                    Some(OnSide::Summit(_)) => Some(OnSideDrawn::Hump),
                    None => None,
                },
            });
            let first = points;
            points += pair.points.len();
            ContactDrawn {
                name: contact.name.clone(),
                block: contact.block,
                surface: scene.name_of(contact.surface).to_owned(),
                beam: match contact.surface {
                    scene::SupportingBody::Beam(k) => Some(k),
                    scene::SupportingBody::Ground | scene::SupportingBody::Block(_) => None,
                },
                other: contact.other_block(),
                linear: contact.kinematics == teeter_detect::Kinematics::Linear,
                lower: contact.face == BeamFace::Lower,
                points: drawn.collect(),
                has_duration: contact.law.impact.has_duration(),
                rings: on_beams[contact.block],
                has_friction: contact.law.friction > 0.0,
                first,
            }
        });
        let contacts: Vec<_> = contacts.collect();
        let (beams, driven): (Vec<BeamDrawn>, _) = (beams.collect(), Driven::of(scene, layout));
        // Only where all bodies may stand on what moves, and where it doesn't turn: on the ground, or on the only beam, which its supports take along.
        let on_ground = scene.ground.is_some() && beams.iter().all(BeamDrawn::is_free);
        let on_beam = scene.ground.is_none() && beams.len() == 1 && !beams[0].drifts;
        let is_base = (on_ground || on_beam)
            && driven.iter().all(|driven| driven.component != 2 && (on_beam || driven.name == "ground"))
            && scene.blocks.iter().all(|block| !block.motion.is_given());
        let moving = |axis| driven.iter().position(|driven| driven.component == axis).filter(|_| is_base);
        let bases = [0, 1].map(moving);
        Self {
            ground: scene.ground.is_some(),
            incline: scene.ground.as_ref().map_or(0.0, |ground| ground.incline),
            profile,
            blocks: blocks.collect(),
            beams,
            contacts,
            points,
            hidden_points: if all > MOST_POINTS { all } else { 0 },
            unlisted: scene.crowd.is_some(),
            listed: scene.contacts.iter().map(|contact| (contact.block, contact.surface)).collect(),
            on_blocks: {
                let is_on_block = |block: &BlockScene| {
                    matches!(block.placement, Placement::On { support: SupportingBody::Block(_), .. })
                };
                scene.blocks.iter().map(is_on_block).collect()
            },
            crowd: layout.crowd.as_ref().map(|place| Arc::clone(&place.crowd)),
            forces: scene.forces.clone(),
            loads: scene.loads.clone(),
            records: scene.records().cloned().collect(),
            driven,
            bases,
            display: scene.display,
            physical: physical::tables(scene, layout),
            weight_energy: {
                let g = scene.gravity[0].hypot(scene.gravity[1]);
                scene.blocks.iter().map(|block| block.mass() * g * block.radius()).filter(|e| e.is_finite()).sum()
            },
        }
    }

    /// What x and y of blocks may be plotted from.
    pub(crate) fn base(&self) -> &'static str {
        if self.ground { "the ground" } else { "the supports" }
    }

    /// Whether there are too many blocks for a curve each.
    pub(crate) fn is_crowded(&self) -> bool {
        self.blocks.len() > MOST_CURVES
    }

    /// Columns of all blocks in the curves.
    pub(crate) fn block_columns(&self) -> usize {
        if self.is_crowded() { 2 * BAND_COLUMNS } else { BLOCK_COLUMNS * self.blocks.len() }
    }

    /// The first column of a beam's deflections: at midspan, then at its probes.
    pub(crate) fn beam_column(&self, beam: usize) -> usize {
        self.block_columns() + self.beams[..beam].iter().map(|beam| 1 + beam.probes.len()).sum::<usize>()
    }

    /// The first column of the energies.
    pub(crate) fn energy_column(&self) -> usize {
        self.beam_column(self.beams.len())
    }

    /// The first column of a prescribed coordinate: its displacement, velocity and acceleration.
    pub(crate) fn driven_column(&self, number: usize) -> usize {
        self.energy_column() + ENERGIES.len() + MOTION_COLUMNS * number
    }

    /// Columns of what moves beams and ground as a whole, in a row of [`Frames`](super::frames::Frames).
    pub(crate) fn moved_columns(&self, layout: &Layout) -> usize {
        let beams = self.beams.iter().zip(&layout.beams).filter(|(drawn, place)| drawn.moves(place)).count();
        BEAM_MOVED * beams + layout.ground.as_ref().map_or(0, ExactSizeIterator::len)
    }

    /// Whether contact forces are drawn as a network: of a single block it would be a star.
    pub(crate) fn has_network(&self) -> bool {
        self.blocks.len() > 1
    }

    /// The bodies of a pair, by its number in the model.
    pub(crate) fn bodies_of(&self, pair: u32) -> Option<(usize, SupportingBody)> {
        if let Some(bodies) = self.listed.get(pair as usize) {
            return Some(*bodies);
        }
        let [block, other] = self.crowd.as_ref()?.blocks_of(self.listed.len(), pair)?;
        Some((block, SupportingBody::Block(other)))
    }
}
