//! The observer that keeps what the page shows.

use super::bands::{BAND_COLUMNS, Bands};
use super::curves::{Curves, Of};
use super::frames::Frames;
use super::network::Network;
use super::orbit::Orbit;
use super::rounded;
use super::scenery::{ContactDrawn, Scenery};
use crate::closed::Closed;
use crate::contacts::slip;
use crate::sections::{BeamRecord, Column, Kind, columns_of};
use crate::verdict::points_of_no_return;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use teeter_integrator::{
    Active, Closing, ClosingMonitor, Contact, ContactState, Model, Observer, ObserverError, PhaseKind, State,
    StepReport,
};
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Layout;

/// An impact as the page marks it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct ImpactMark {
    /// End of the step, s.
    pub(crate) t: f64,
    /// Number of the contact pair.
    pub(crate) contact: usize,
    /// Number of the block.
    pub(crate) block: usize,
    /// Number of the corner.
    pub(crate) point: usize,
    /// Normal and tangential impulse, N·s.
    pub(crate) impulse: [f64; 2],
    /// The block's angular velocity before the step and after it, relative to what carries it, rad/s.
    pub(crate) omega: [f64; 2],
}

/// The energies and works of [`Curves`], after the blocks' and the beams' columns.
pub(crate) const ENERGIES: [&str; 11] = [
    "kinetic",
    "elastic",
    "gravity",
    "total",
    "contact",
    "friction",
    "viscous",
    "numerical",
    "external",
    "projection",
    "residual",
];

/// Columns of a block in [`Curves`]: x, y, φ and their velocities, x and y from what carries them where that moves ([`Scenery::bases`]). Of many blocks there are bands instead.
pub(crate) const BLOCK_COLUMNS: usize = 6;

/// Coordinates of a block.
pub(crate) const BLOCK_COORDINATES: usize = 3;

/// Columns of a prescribed coordinate: displacement, velocity, acceleration.
pub(crate) const MOTION_COLUMNS: usize = 3;

/// Most blocks whose curves are kept one by one: there are as many colours and dashes to tell them
/// apart.
pub(super) const MOST_CURVES: usize = 21;

/// Numbers of a block in [`Frames`]: x, y and φ.
pub(crate) const BLOCK_FRAME: usize = 3;

/// Numbers of a beam that moves as a whole at the end of a row of [`Frames`], before those of moving ground, x, y and slope: how far along x and y.
pub(crate) const BEAM_MOVED: usize = 2;

/// Most pictures of the animation.
const FRAMES: usize = 2000;

/// Most buckets of the curves, each two points.
const BUCKETS: usize = 2000;

/// Most numbers on the page for curves, and as many again for pictures of few bodies: at some 10 bytes each the page of
/// ten bodies stays below 1.2 MB.
pub(super) const NUMBERS: usize = 80_000;

/// Most numbers kept for curves during the run.
const KEPT_NUMBERS: usize = 480_000;

/// Most numbers for pictures of many bodies: [packed](super::packed), one takes 1.3 to 2.7 bytes.
const PACKED_NUMBERS: usize = 750_000;

/// Impacts that the page marks; `impacts.csv` has all.
const MARKED_IMPACTS: usize = 1000;

/// What a page recorder knows of the run so far.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Kept {
    pub(crate) frames: Frames,
    pub(crate) network: Network,
    pub(crate) curves: Curves,
    /// x, y and φ of each block with their velocities; none of many blocks.
    pub(crate) orbits: Vec<Orbit>,
    pub(crate) impacts: Vec<ImpactMark>,
    /// All impacts, marked or not.
    pub(crate) impact_count: u64,
    /// How many there were in each part of the run, of each contact.
    pub(crate) density: BTreeMap<usize, Vec<u32>>,
}

/// Parts of the run in which impacts are counted.
pub(crate) const PARTS: usize = 400;

/// More impacts than this are drawn as a density, not one by one.
pub(crate) const MANY_IMPACTS: u64 = 60;

/// Watches a run for [`render`](super::render) and [`figures`](super::figures); its memory doesn't grow with the run.
///
/// ```
/// use teeter_report::PageRecorder;
/// use teeter_scenario::simulation::Simulation;
/// # let text = r#"
/// # time = { end = "0.01 s", step = "1 ms" }
/// # ground = {}
/// # material.wood.density = "600 kg/m^3"
/// # block.cube = { material = "wood", width = "10 cm", height = "10 cm", depth = "10 cm", position = ["0 m", "6 cm"] }
/// # contact.floor = { between = ["cube", "ground"], friction = 0.4 }
/// # "#;
/// let resolved = teeter_scenario::load(text.as_bytes(), "cube.toml", "cube", &[])?;
/// let mut simulation = Simulation::new(&resolved.scene)?;
/// let mut page = PageRecorder::new(&resolved.scene, &simulation.layout);
/// simulation.run(&mut [&mut page])?;
/// assert!(teeter_report::figures(&page).iter().any(|(file, _)| file == "energy.svg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct PageRecorder {
    pub(crate) scenery: Scenery,
    pub(crate) kept: Kept,
    pub(crate) layout: Layout,
    bucket_capacity: usize,
    /// The scene's end, s.
    pub(crate) end: f64,
    /// The contact points with springs, whose normal and tangential forces have columns of their own in the curves, before [`Self::sections`].
    pub(crate) springs: Vec<usize>,
    /// By contact pairs: where after the contact points in the curves the forces of all of its points together are, as the sum of extremes is none
    /// of the sum.
    sums: Vec<Option<usize>>,
    /// What beams bear, after all other columns of the curves.
    pub(crate) sections: Vec<Column>,
    /// What beams bore in the whole run; nothing before its end.
    pub(crate) beams: Vec<BeamRecord>,
    /// Between which angles each block stood, rad; before the end of the run as it was placed.
    pub(crate) points_of_no_return: Vec<Option<[f64; 2]>>,
    /// Values of the curves at the end of the step.
    row: Vec<f64>,
    bands: Bands,
    /// Tells impacts, where nobody else does.
    closings: ClosingMonitor<2>,
    /// The contacts that closed in the step.
    closed: Vec<Closed>,
    /// By blocks: whether they feel the impacts of a step. Memory.
    struck: Vec<bool>,
    /// By contact points: the number of the last part of a step in which they had an impulse; and that of the part looked at. Memory.
    struck_in: Vec<u64>,
    part: u64,
    /// By contact points: for how long of a step they stick and slip, s; and those that do. Memory.
    lasting: Vec<[f64; 2]>,
    pressing: Vec<usize>,
}

impl PageRecorder {
    /// A recorder for a run of `scene`.
    #[must_use]
    pub fn new(scene: &Scene, layout: &Layout) -> Self {
        let scenery = Scenery::new(scene, layout);
        let frame = BLOCK_FRAME * scenery.blocks.len()
            + scenery.beams.iter().map(|beam| beam.points).sum::<usize>()
            + scenery.moved_columns(layout);
        let beams = scene.beams.iter().zip(&layout.beams).enumerate();
        let sections = beams.flat_map(|(number, (of, place))| columns_of(number, of, place));
        let sections: Vec<Column> = sections.filter(|column| column.kind != Kind::Deflection).collect();
        let with_springs = scenery.contacts.iter().filter(|contact| contact.has_duration);
        let springs: Vec<usize> =
            with_springs.flat_map(|contact| contact.first..contact.first + contact.points.len()).collect();
        let columns = scenery.driven_column(scenery.driven.len()) + 2 * springs.len() + sections.len();
        let points = scenery.points;
        let mut entries = points;
        let sum_of = |contact: &ContactDrawn| {
            let has_sum = contact.has_friction && contact.points.len() > 1;
            entries += usize::from(has_sum);
            has_sum.then(|| entries - 1)
        };
        let sums = scenery.contacts.iter().map(sum_of).collect();
        let even = |n: usize| n - n % 2;
        let capacity = |most: usize, width: usize| even((NUMBERS / width).clamp(10, most));
        // What is drawn of it is known at the end only: then there may be fewer buckets.
        let bucket_capacity = even((KEPT_NUMBERS / (2 * columns + 3 * entries + 3)).clamp(10, BUCKETS));
        let pictures = if scenery.is_crowded() {
            even((PACKED_NUMBERS / (frame + 1)).clamp(10, FRAMES))
        } else {
            capacity(FRAMES, frame + 1)
        };
        Self {
            kept: Kept {
                frames: Frames::new(pictures, frame),
                network: if scenery.has_network() {
                    Network::new(pictures, scenery.blocks.len())
                } else {
                    Network::default()
                },
                curves: Curves::new(bucket_capacity, 0.0, vec![0.0; columns], entries),
                orbits: Vec::new(),
                impacts: Vec::new(),
                impact_count: 0,
                density: BTreeMap::new(),
            },
            layout: layout.clone(),
            bucket_capacity,
            end: scene.time.steps() as f64 * scene.time.step,
            springs,
            sums,
            sections,
            beams: Vec::new(),
            points_of_no_return: points_of_no_return(scene),
            row: vec![f64::NAN; columns],
            bands: Bands::default(),
            closings: ClosingMonitor::default(),
            closed: Vec::new(),
            struck: Vec::new(),
            struck_in: vec![0; points],
            part: 0,
            lasting: vec![[0.0; 2]; points],
            pressing: Vec::new(),
            scenery,
        }
    }

    pub(crate) fn keep(&self) -> &Kept {
        &self.kept
    }

    pub(crate) fn restore(&mut self, kept: Kept) {
        self.kept = kept;
    }

    /// The number of the first column of the curves that is of what beams bear.
    pub(crate) fn first_section(&self) -> usize {
        self.first_spring() + 2 * self.springs.len()
    }

    /// The number of the first column of the curves that is of a contact with springs.
    fn first_spring(&self) -> usize {
        self.scenery.driven_column(self.scenery.driven.len())
    }

    /// The column of a contact point's normal force, before that of the tangential one, if it has springs.
    pub(crate) fn spring_column(&self, point: usize) -> Option<usize> {
        Some(self.first_spring() + 2 * self.springs.binary_search(&point).ok()?)
    }

    /// How many contact points and pairs with a sum over them the curves have.
    fn entries(&self) -> usize {
        self.scenery.points + self.sums.iter().flatten().count()
    }

    /// Where in the curves the forces of all points of a pair together are, if it has several.
    pub(crate) fn sum_entry(&self, pair: usize) -> Option<usize> {
        self.sums[pair]
    }

    /// What tells a curve of what beams bear from others of its kind: the place, and the beam where there are several.
    pub(crate) fn section_label(&self, column: &Column) -> String {
        let beam = &self.scenery.beams[column.beam];
        let name = (self.scenery.beams.len() > 1).then(|| beam.name.clone());
        let place = column.x.map(|x| self.place(x));
        name.into_iter().chain(place).collect::<Vec<_>>().join(" ")
    }

    /// The names of what a contact is between, what lies on the other first: of two blocks the one that is higher at the start.
    pub(crate) fn upper_and_lower<'a>(&'a self, contact: &'a ContactDrawn) -> [&'a str; 2] {
        let names = [self.scenery.blocks[contact.block].name.as_str(), contact.surface.as_str()];
        let start = self.kept.frames.rows().next().map(|(_, row)| row);
        let height = |block: usize| start.and_then(|row| row.get(BLOCK_FRAME * block + 1).copied());
        let below = contact.other.and_then(|other| Some(height(contact.block)? < height(other)?));
        if below == Some(true) { [names[1], names[0]] } else { names }
    }

    /// What a contact is between, as a name: `upper on lower`.
    pub(crate) fn pair_name(&self, contact: &ContactDrawn) -> String {
        self.upper_and_lower(contact).join(" on ")
    }

    /// How many probes the beams have.
    pub(crate) fn probe_count(&self) -> usize {
        self.layout.beams.iter().map(|beam| beam.probes.len()).sum()
    }

    /// The number of the probe at `x` (m) of a beam among those of all beams, which is that of its colour: a place looks alike in all plots.
    pub(crate) fn number_of_probe(&self, beam: usize, x: f64) -> Option<usize> {
        let before: usize = self.layout.beams[..beam].iter().map(|beam| beam.probes.len()).sum();
        let near = |probe: &f64| (probe - x).abs() <= 1e-9 * self.scenery.beams[beam].span;
        Some(before + self.layout.beams[beam].probes.iter().position(near)?)
    }

    /// A place along a beam in the scene's unit.
    pub(crate) fn place(&self, x: f64) -> String {
        let unit = self.scenery.display.length;
        format!("{} {}", rounded(x * unit.per_metre(), 6), unit.word())
    }

    /// Takes the values of what beams bear, to be entered with the next step; without them there are no such curves.
    pub(crate) fn see_sections(&mut self, values: &[f64]) {
        if values.len() == self.sections.len() {
            let before = self.row.len() - values.len();
            self.row[before..].iter_mut().zip(values).for_each(|(own, value)| *own = *value);
        }
    }

    fn take_frame(&mut self, state: &State) {
        let Kept { frames, network, .. } = &mut self.kept;
        let entered = frames.enter(state.t, |row| fill_frame(&self.layout, &self.scenery, state, row));
        network.follow(entered);
        if network.is_full() {
            frames.halve();
            network.halve();
        }
    }

    fn take_row(&mut self, state: &State) {
        let (of_blocks, rest) = self.row.split_at_mut(self.scenery.block_columns());
        let places = self.layout.blocks.iter().map(|block| block.range.start + 2);
        if self.scenery.is_crowded() {
            let (angles, rates) = of_blocks.split_at_mut(BAND_COLUMNS);
            self.bands.fill(places.clone().map(|phi| state.q[phi]), angles);
            self.bands.fill(places.map(|phi| state.v[phi]), rates);
        } else {
            for (out, block) in of_blocks.chunks_exact_mut(BLOCK_COLUMNS).zip(&self.layout.blocks) {
                let (q, v) = out.split_at_mut(3);
                q.copy_from_slice(&state.q[block.range.clone()]);
                v.copy_from_slice(&state.v[block.range.clone()]);
                for (axis, base) in self.scenery.bases.iter().enumerate() {
                    let Some(base) = base.and_then(|base| self.scenery.driven.get(base)) else { continue };
                    let [displacement, velocity, _] = base.values(state);
                    q[axis] -= displacement;
                    v[axis] -= velocity;
                }
            }
        }
        let (of_beams, rest) = rest.split_at_mut(self.scenery.energy_column() - self.scenery.block_columns());
        let mut of_beams = of_beams.iter_mut();
        for (place, drawn) in self.layout.beams.iter().zip(&self.scenery.beams) {
            let q = &state.q[place.range.clone()];
            let middle = (0.5 * drawn.span, &drawn.middle);
            let probes = std::iter::once(middle).chain(drawn.probes.iter().map(|(x, probe)| (*x, probe)));
            // The other way round a row too many would be taken before it is seen that there is no more probe.
            probes.zip(&mut of_beams).for_each(|((x, probe), out)| *out = drawn.bending(x, probe.deflection(q), q));
        }
        let energies = &mut rest[..ENERGIES.len()];
        let (now, initial, sum) = (&state.ledger.current, &state.ledger.initial, &state.ledger.sum);
        let gravity = now.gravity - initial.gravity;
        energies.copy_from_slice(&[
            now.kinetic,
            now.elastic,
            gravity,
            now.kinetic + now.elastic + gravity,
            sum.contact,
            sum.friction,
            sum.viscous,
            sum.numerical,
            sum.external,
            sum.projection,
            sum.residual,
        ]);
        for (out, driven) in rest[ENERGIES.len()..].chunks_exact_mut(MOTION_COLUMNS).zip(&self.scenery.driven) {
            out.copy_from_slice(&driven.values(state));
        }
    }

    /// Takes the forces of springs: as they change through an impact, no peak of theirs is to be missed.
    fn take_springs(&mut self, step: &StepReport<'_, 2>) {
        if self.springs.is_empty() {
            return;
        }
        let columns = self.first_spring()..self.first_section();
        self.row[columns].fill(0.0);
        let lasting = step.t_end - step.t_start;
        for contact in step.active().flat_map(|part| part.contacts) {
            let Some((pair, point)) = place(&self.layout, contact) else { continue };
            let Some(point) = self.scenery.contacts.get(pair).map(|drawn| drawn.first + point) else { continue };
            if let Some(column) = self.spring_column(point) {
                self.row[column..].iter_mut().zip(&contact.p).for_each(|(force, impulse)| *force += impulse / lasting);
            }
        }
    }

    fn take_orbits(&mut self, t: f64) {
        let of_blocks = self.row.chunks_exact(BLOCK_COLUMNS);
        for (orbits, row) in self.kept.orbits.chunks_exact_mut(BLOCK_COORDINATES).zip(of_blocks) {
            for (k, orbit) in orbits.iter_mut().enumerate() {
                orbit.enter([t, row[k], row[BLOCK_COORDINATES + k]]);
            }
        }
    }

    /// What a run begins with: contacts that are there from the start and approach then. No table lists their impulses as impacts, as they don't follow
    /// a flight, but forces they are none.
    fn struck_at_start(step: &StepReport<'_, 2>) -> Vec<Closed> {
        let of_part = |part: Active<'_, 2>| {
            let strikes = |contact: &&Contact<2>| contact.p[0] > 0.0 && contact.u_before[0] < -contact.still;
            let closed =
                move |contact: &Contact<2>| Closed { t: part.end, contact: *contact, closing: Closing::Impact };
            part.contacts.iter().filter(strikes).map(closed).collect::<Vec<_>>()
        };
        step.active().flat_map(of_part).collect()
    }

    fn take_contacts(&mut self, step: &StepReport<'_, 2>, closed: &[Closed]) {
        for part in step.active() {
            if self.scenery.has_network() {
                self.kept.network.add(part.contacts);
            }
            // What closes at an instant of its own has no part in the stretch of time before it.
            let is_instant = |other: &Active<'_, 2>| other.kind == PhaseKind::Impact && other.end == part.end;
            let strikers = if step.active().any(|other| is_instant(&other)) { &[] } else { closed };
            self.find_struck(part.contacts, part.end, strikers);
            let is_impact = closed.iter().any(|of| of.closing == Closing::Impact && of.t == part.end);
            let mut before = None;
            self.part += 1;
            for contact in part.contacts {
                let Some((pair, point)) = place(&self.layout, contact) else { continue };
                let Some(drawn) = self.scenery.contacts.get(pair) else { continue };
                let strikes =
                    part.kind == PhaseKind::Impact || self.free_blocks(contact).any(|block| self.struck[block]);
                let lasting = part.duration;
                // Springs give the force of an impact its course.
                let of = match strikes && !drawn.has_duration {
                    true if is_impact => Of::Impact { lasting },
                    true => Of::Reclosure { lasting },
                    false => Of::Force,
                };
                if let Some(sum) = self.sums[pair] {
                    // The points of a pair follow each other; the time is that of the first.
                    let of = if before == Some(pair) { of.again() } else { of };
                    self.kept.curves.add(sum, [contact.p[0], contact.p[1]], of, ContactState::Open, 0.0);
                }
                before = Some(pair);
                let slip = slip(contact, part.duration, part.balance);
                let (point, state) = (drawn.first + point, contact.state());
                // A point that touches two pieces of a profile, or two sides, comes twice, but the part of the step lasts once.
                let last = self.struck_in.get_mut(point).filter(|_| of != Of::Force);
                let again = last.is_some_and(|last| std::mem::replace(last, self.part) == self.part);
                let of = if again { of.again() } else { of };
                self.kept.curves.add(point, [contact.p[0], contact.p[1]], of, ContactState::Open, slip);
                if let Some(lasting) = self.lasting.get_mut(point).filter(|_| state != ContactState::Open) {
                    self.pressing.extend((*lasting == [0.0; 2]).then_some(point));
                    lasting[usize::from(state == ContactState::Slip)] += part.duration;
                }
            }
        }
        // An instant, or a fraction of a step, isn't what it does in the step.
        let half = 0.5 * (step.t_end - step.t_start);
        for point in &self.pressing {
            let [sticking, slipping] = self.lasting[*point];
            if sticking + slipping > half {
                let state = if sticking >= slipping { ContactState::Stick } else { ContactState::Slip };
                self.kept.curves.count(*point, state);
            }
            // Listed once more if instants came first.
            self.lasting[*point] = [0.0; 2];
        }
        self.pressing.clear();
    }

    /// The blocks of a contact whose motion isn't prescribed.
    fn free_blocks(&self, contact: &Contact<2>) -> impl Iterator<Item = usize> {
        let blocks = &self.scenery.blocks;
        let bodies = contact.sides.map(|side| side.body.0 as usize);
        bodies.into_iter().filter(|body| blocks.get(*body).is_some_and(|block| !block.driven))
    }

    /// Finds the blocks that feel the impacts at the end of a part of a step: those that strike or are struck, and those
    /// that press on these, as a rigid block hands an impact on at once.
    fn find_struck(&mut self, contacts: &[Contact<2>], end: f64, closed: &[Closed]) {
        let mut struck = std::mem::take(&mut self.struck);
        struck.clear();
        struck.resize(self.scenery.blocks.len(), false);
        let rigid = |of: &&Closed| {
            let pair = self.scenery.contacts.get(of.contact.id.pair() as usize);
            of.closing == Closing::Impact && of.t == end && pair.is_some_and(|pair| !pair.has_duration)
        };
        let mut spreads = false;
        for of in closed.iter().filter(rigid) {
            self.free_blocks(&of.contact).for_each(|block| struck[block] = true);
            spreads = true;
        }
        while std::mem::take(&mut spreads) {
            for contact in contacts.iter().filter(|contact| contact.p[0] > 0.0) {
                let count = self.free_blocks(contact).filter(|block| struck[*block]).count();
                if count > 0 && count < self.free_blocks(contact).count() {
                    self.free_blocks(contact).for_each(|block| struck[block] = true);
                    spreads = true;
                }
            }
        }
        self.struck = struck;
    }

    /// Marks the impacts among the contacts that closed in a step.
    fn mark(&mut self, step: &StepReport<'_, 2>, state: &State, closed: &[Closed]) {
        for Closed { t, contact, .. } in closed.iter().filter(|closed| closed.closing == Closing::Impact) {
            self.kept.impact_count += 1;
            let Some((pair, point)) = place(&self.layout, contact) else { continue };
            let part = ((t / self.end * PARTS as f64) as usize).min(PARTS - 1);
            self.kept.density.entry(pair).or_insert_with(|| vec![0; PARTS])[part] += 1;
            if self.kept.impacts.len() >= MARKED_IMPACTS {
                continue;
            }
            let Some(block) = self.scenery.contacts.get(pair).map(|contact| contact.block) else { continue };
            let before = step.phases().next().map_or(state.v.as_slice(), |first| first.v[0]);
            self.kept.impacts.push(ImpactMark {
                t: *t,
                contact: pair,
                block,
                point,
                impulse: [contact.p[0], contact.p[1]],
                omega: [before, &state.v].map(|v| self.layout.tilt_rate(block, v)),
            });
        }
    }

    /// How many impacts there were about each time, s; of one contact, or of all.
    pub(crate) fn impacts_about(&self, contact: Option<usize>) -> Vec<(f64, u32)> {
        let mut counts = vec![0; PARTS];
        for (_, density) in self.kept.density.iter().filter(|(pair, _)| contact.is_none_or(|asked| asked == **pair)) {
            counts.iter_mut().zip(density).for_each(|(sum, count)| *sum += count);
        }
        let middle = |part: usize| (part as f64 + 0.5) * self.end / PARTS as f64;
        counts.into_iter().enumerate().map(|(part, count)| (middle(part), count)).collect()
    }

    /// Takes a step in, with the contacts that closed in it.
    pub(crate) fn see_step(&mut self, step: &StepReport<'_, 2>, state: &State, closed: &[Closed]) {
        self.take_row(state);
        self.take_springs(step);
        self.kept.curves.enter(state.t, &self.row);
        self.take_orbits(state.t);
        if state.step == 1 {
            self.take_contacts(step, &[closed, &Self::struck_at_start(step)].concat());
        } else {
            self.take_contacts(step, closed);
        }
        // After the contacts: what they did belongs to the picture at the step's end.
        self.take_frame(state);
        self.mark(step, state, closed);
    }
}

/// The numbers of a contact's pair and of its point.
#[inline]
fn place(layout: &Layout, contact: &Contact<2>) -> Option<(usize, usize)> {
    let pair = contact.id.pair() as usize;
    Some((pair, layout.pairs.get(pair)?.point(contact.id)?))
}

fn fill_frame(layout: &Layout, scenery: &Scenery, state: &State, row: &mut [f64]) {
    let (blocks, mut beams) = row.split_at_mut(BLOCK_FRAME * layout.blocks.len());
    for (out, block) in blocks.chunks_exact_mut(BLOCK_FRAME).zip(&layout.blocks) {
        out.copy_from_slice(&state.q[block.range.clone()]);
    }
    for (place, drawn) in layout.beams.iter().zip(&scenery.beams) {
        let (points, rest) = beams.split_at_mut(drawn.points);
        let q = &state.q[place.range.clone()];
        points.iter_mut().zip(&drawn.places).for_each(|(w, at)| *w = at.deflection(q));
        beams = rest;
    }
    let moving = layout.beams.iter().zip(&scenery.beams).filter(|(place, drawn)| drawn.moves(place));
    let (of_beams, of_ground) = beams.split_at_mut(BEAM_MOVED * moving.clone().count());
    for (out, (place, drawn)) in of_beams.chunks_exact_mut(BEAM_MOVED).zip(moving) {
        out.copy_from_slice(&drawn.moved(place, state));
    }
    if let Some(range) = &layout.ground {
        of_ground.copy_from_slice(&state.q[range.clone()]);
    }
}

/// A coordinate of a block in a row of [`Frames`], as in [`Curves`].
pub(crate) fn coordinate_in(recorder: &PageRecorder, row: &[f64], block: usize, coordinate: usize) -> f64 {
    let own = row[BLOCK_FRAME * block + coordinate];
    match recorder.scenery.bases.get(coordinate) {
        // The ground's x, y and slope come last, or how far the only beam has moved.
        Some(Some(_)) => own - row[row.len() - if recorder.scenery.ground { 3 } else { BEAM_MOVED } + coordinate],
        _ => own,
    }
}

impl Observer<2> for PageRecorder {
    fn start(&mut self, model: &Model<2>, state: &State) -> Result<(), ObserverError> {
        self.take_frame(state);
        self.take_row(state);
        self.closings = ClosingMonitor::new(model, state, &self.layout.openings)?;
        self.kept.curves = Curves::new(self.bucket_capacity, state.t, self.row.clone(), self.entries());
        let drawn = if self.scenery.is_crowded() { 0 } else { self.scenery.blocks.len() };
        // Not clones of one, which would lack its capacity.
        self.kept.orbits = (0..BLOCK_COORDINATES * drawn).map(|_| Orbit::default()).collect();
        self.take_orbits(state.t);
        Ok(())
    }

    fn observe(
        &mut self,
        model: &Model<2>,
        step: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError> {
        let mut closed = std::mem::take(&mut self.closed);
        Closed::of_step(&mut self.closings, model, step, state, &self.layout, &mut closed)?;
        self.see_step(step, state, &closed);
        self.closed = closed;
        Ok(ControlFlow::Continue(()))
    }

    fn finish(&mut self, _model: &Model<2>, state: &State) -> Result<(), ObserverError> {
        self.kept.frames.end(state.t, |row| fill_frame(&self.layout, &self.scenery, state, row));
        Ok(())
    }
}
