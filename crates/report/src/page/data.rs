//! The data of the page: what its script draws.

use super::bands::{BAND_COLUMNS, BAND_NAMES};
use super::crowd::CrowdCurve;
use super::network::Link;
use super::packed::Packed;
use super::panels::{Panels, Place};
use super::recorder::{BLOCK_FRAME, MANY_IMPACTS, PageRecorder};
use super::scenery::Scenery;
use super::{DIGITS, TIME_DIGITS, means, rounded};
use crate::{Summary, with_digits};
use serde::Serialize;
use teeter_integrator::ContactState;
use teeter_scenario::scene::{History, LoadKind, SupportingBody};

#[derive(Serialize)]
struct Data<'a> {
    dt: f64,
    scenery: &'a Scenery,
    frames: FrameData,
    curves: CurveData,
    #[serde(skip_serializing_if = "Option::is_none")]
    crowd: Option<CrowdData>,
    #[serde(skip_serializing_if = "Option::is_none")]
    network: Option<NetworkData>,
    loads: Vec<LoadData>,
    forces: ForceData,
    impacts: Vec<ImpactData>,
    impact_count: u64,
    /// Where they are many: how many in each part of the run up to `end`, of all contacts and of each.
    #[serde(skip_serializing_if = "Option::is_none")]
    density: Option<DensityData>,
    panels: Vec<PanelData>,
    portraits: Vec<PortraitData>,
}

#[derive(Serialize)]
struct DensityData {
    end: f64,
    all: Vec<u32>,
    contacts: std::collections::BTreeMap<usize, Vec<u32>>,
}

/// Contacts whose own density is on the page.
const OWN_DENSITY: usize = 20;

fn density(recorder: &PageRecorder) -> Option<DensityData> {
    let kept = &recorder.kept;
    (kept.impact_count > MANY_IMPACTS).then(|| DensityData {
        end: time(recorder.end),
        all: recorder.impacts_about(None).into_iter().map(|(_, count)| count).collect(),
        contacts: kept.density.iter().take(OWN_DENSITY).map(|(pair, counts)| (*pair, counts.clone())).collect(),
    })
}

/// A plot over time.
#[derive(Serialize)]
struct PanelData {
    id: String,
    title: String,
    unit: String,
    least: f64,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    guides: Vec<f64>,
    /// Whether the peaks of impacts are cut.
    cut: bool,
    /// The contact whose it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    contact: Option<usize>,
    /// Whether it stands after the contacts.
    late: bool,
    series: Vec<SeriesData>,
}

#[derive(Serialize)]
struct SeriesData {
    label: String,
    index: usize,
    /// Whether its times are the borders of the forces, not those of the curves.
    at_borders: bool,
    y: Vec<f64>,
}

/// A coordinate and its velocity, at times of their own.
#[derive(Serialize)]
struct PortraitData {
    id: &'static str,
    title: String,
    x_label: String,
    unit: String,
    least: [f64; 2],
    guides: Vec<f64>,
    series: Vec<PortraitSeries>,
}

#[derive(Serialize)]
struct PortraitSeries {
    label: String,
    index: usize,
    t: Vec<f64>,
    x: Vec<f64>,
    y: Vec<f64>,
}

/// The pictures: `blocks[k].x[i]` at `t[i]`, of many blocks packed; `beams[k].w` row by row in units of `beams[k].unit`. Displacements of supports
/// and ground where they move.
#[derive(Serialize)]
struct FrameData {
    t: Vec<f64>,
    blocks: Vec<BlockFrames>,
    #[serde(skip_serializing_if = "Option::is_none")]
    packed: Option<PackedFrames>,
    beams: Vec<BeamFrames>,
    ground: Option<GroundFrames>,
}

/// Poses of many blocks, block by block: x in all pictures, then y, then φ, each as differences from the picture
/// before, in these units.
#[derive(Serialize)]
struct PackedFrames {
    length: f64,
    angle: f64,
    blocks: Vec<String>,
}

/// The network of contact forces: for each picture the links since the one before, each as the difference of its pair's
/// number in `pairs` from that of the link before, its force in 4095ths of `largest` and the centre of pressure in the
/// first body's own coordinates, in 1000ths of its reach.
#[derive(Serialize)]
struct NetworkData {
    /// The bodies of each pair: block and block, or −1 for ground, −2 for the first beam and so on.
    pairs: Vec<(usize, i64)>,
    /// The largest force of each picture, N.
    largest: Vec<f64>,
    links: Vec<String>,
}

/// Steps of a force, and of a place within a body.
const FORCE_STEPS: f64 = 4095.0;
const PLACE_STEPS: f64 = 1000.0;

/// Many bodies over time: bands, and a few bodies one by one.
#[derive(Serialize)]
struct CrowdData {
    names: [&'static str; BAND_COLUMNS],
    /// Of φ and φ̇, at the times of the curves.
    phi: Vec<Vec<f64>>,
    omega: Vec<Vec<f64>>,
    /// At the times of the pictures, with the bodies that turned and moved furthest.
    turns: ChosenData,
    distances: ChosenData,
}

#[derive(Serialize)]
struct ChosenData {
    bands: Vec<Vec<f64>>,
    /// Numbers of blocks.
    chosen: Vec<usize>,
    values: Vec<Vec<f64>>,
}

/// A force on a block or a beam at the times of the pictures: N and N·m, and where.
#[derive(Serialize)]
struct LoadData {
    name: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    block: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    beam: Option<usize>,
    /// Force along x and y at full size, N; the couple, N·m.
    force: [f64; 2],
    couple: f64,
    /// Places along the beam where it begins and ends, m, and how fast they move, m/s.
    span: [f64; 2],
    speed: f64,
    /// By what force and couple are multiplied.
    factor: Vec<f64>,
}

#[derive(Serialize)]
struct GroundFrames {
    x: Vec<f64>,
    y: Vec<f64>,
    slope: Vec<f64>,
}

#[derive(Serialize)]
struct BlockFrames {
    x: Vec<f64>,
    y: Vec<f64>,
    phi: Vec<f64>,
}

#[derive(Serialize)]
struct BeamFrames {
    unit: f64,
    w: Vec<i64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    supports: Option<[Vec<f64>; 2]>,
}

#[derive(Serialize)]
struct CurveData {
    t: Vec<f64>,
}

/// Means between the times `borders`.
#[derive(Serialize)]
struct ForceData {
    borders: Vec<f64>,
    /// Of the unit in which they are plotted: its prefix, and by what N are multiplied.
    prefix: &'static str,
    factor: f64,
    /// Length of the windows of `mean`, with its unit.
    window: String,
    /// Contacts whose tangential forces are rounding.
    frictionless: Vec<usize>,
    points: Vec<PointForces>,
}

#[derive(Serialize)]
struct PointForces {
    contact: usize,
    point: usize,
    normal: Vec<f64>,
    /// The mean of `normal` over windows about the borders, where it differs.
    #[serde(skip_serializing_if = "Option::is_none")]
    mean: Option<Vec<f64>>,
    tangential: Vec<f64>,
    /// A letter a value: `o` open, `k` stick, `l` slip.
    state: String,
}

#[derive(Serialize)]
struct ImpactData {
    t: f64,
    contact: usize,
    block: usize,
    point: usize,
    impulse: [f64; 2],
}

/// A deflection is sent in this part of the span: finer than a picture shows, with few digits.
const BEAM_UNIT: f64 = 1e-7;

/// The data as JSON that is safe inside a `script` element.
pub(crate) fn json(recorder: &PageRecorder, panels: &Panels, summary: &Summary) -> String {
    let data = Data {
        dt: summary.dt,
        scenery: &recorder.scenery,
        frames: frames(recorder),
        curves: CurveData { t: panels.curves.times().into_iter().map(time).collect() },
        crowd: recorder.scenery.is_crowded().then(|| crowd(recorder, panels)),
        network: recorder.scenery.has_network().then(|| network(recorder)).filter(|network| !network.pairs.is_empty()),
        loads: loads(recorder),
        forces: forces(recorder, panels),
        impacts: recorder
            .kept
            .impacts
            .iter()
            .map(|i| ImpactData {
                t: time(i.t),
                contact: i.contact,
                block: i.block,
                point: i.point,
                impulse: i.impulse.map(digits),
            })
            .collect(),
        impact_count: recorder.kept.impact_count,
        density: density(recorder),
        panels: time_panels(panels),
        portraits: portraits(panels),
    };
    // Strings, vectors and numbers (null where not finite) always serialise.
    serde_json::to_string(&data).unwrap_or_default().replace('<', "\\u003c")
}

fn digits(x: f64) -> f64 {
    rounded(x, DIGITS)
}

/// The values of a curve: with so many digits that its course is seen, however far from zero it is.
fn course<'a>(values: impl Iterator<Item = &'a f64> + Clone) -> Vec<f64> {
    let finite = values.clone().filter(|x| x.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &x| (a.min(x), b.max(x)));
    let part = (high - low) / low.abs().max(high.abs());
    // Less than that is rounding, which digits would only show.
    let more = if part > CONSTANT { (SEEN - part.log10()).ceil() as usize } else { 0 };
    values.map(|x| rounded(*x, DIGITS.max(more))).collect()
}

/// A curve that varies by a smaller part of its size is constant.
const CONSTANT: f64 = 1e-9;

/// A curve has at least this power of ten of steps between its least and its largest value.
const SEEN: f64 = 5.0;

fn time(t: f64) -> f64 {
    rounded(t, TIME_DIGITS)
}

fn frames(recorder: &PageRecorder) -> FrameData {
    let scenery = &recorder.scenery;
    let column = |k: usize| {
        let values: Vec<f64> = recorder.kept.frames.rows().map(|(_, row)| row[k]).collect();
        course(values.iter())
    };
    let blocks = (0..scenery.blocks.len()).map(|k| BLOCK_FRAME * k);
    let mut start = BLOCK_FRAME * scenery.blocks.len();
    let mut moved = start + scenery.beams.iter().map(|beam| beam.points).sum::<usize>();
    let beams = scenery.beams.iter().zip(&recorder.layout.beams).map(|(beam, place)| {
        let unit = rounded(BEAM_UNIT * beam.span, DIGITS);
        let points = start..start + beam.points;
        start = points.end;
        let w = |row: &[f64]| row[points.clone()].iter().map(|w| (w / unit).round() as i64).collect::<Vec<_>>();
        let supports = place.supports.as_ref().map(|range| {
            let first = moved;
            moved += range.len();
            [column(first), column(first + 1)]
        });
        BeamFrames { unit, w: recorder.kept.frames.rows().flat_map(|(_, row)| w(row)).collect(), supports }
    });
    let beams: Vec<BeamFrames> = beams.collect();
    let ground = recorder.layout.ground.as_ref().map(|_| GroundFrames {
        x: column(moved),
        y: column(moved + 1),
        slope: column(moved + 2),
    });
    let packed = scenery.is_crowded().then(|| packed(recorder));
    let blocks = blocks.filter(|_| packed.is_none());
    FrameData {
        t: recorder.kept.frames.rows().map(|(t, _)| time(t)).collect(),
        blocks: blocks.map(|k| BlockFrames { x: column(k), y: column(k + 1), phi: column(k + 2) }).collect(),
        packed,
        beams,
        ground,
    }
}

/// Lengths are sent in this part of the scene's size, angles in this part of a radian: finer than a picture shows.
const LENGTH_UNIT: f64 = 2e-5;
const ANGLE_UNIT: f64 = 1e-3;

fn packed(recorder: &PageRecorder) -> PackedFrames {
    let blocks = recorder.scenery.blocks.len();
    // Where the bodies began: one that flies off doesn't make all others coarse.
    let first = recorder.kept.frames.rows().next().map_or(&[][..], |(_, row)| row);
    let extent = |k: usize| {
        let places = first.chunks_exact(BLOCK_FRAME).take(blocks).map(|pose| pose[k]).filter(|x| x.is_finite());
        let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        high - low
    };
    let reach = recorder.scenery.blocks.iter().fold(0.0, |most: f64, block| most.max(block.reach));
    let length = rounded(LENGTH_UNIT * (extent(0).max(extent(1)) + 2.0 * reach), 3);
    let of_block = |block: usize| {
        let mut packed = Packed::default();
        for (k, unit) in [(0, length), (1, length), (2, ANGLE_UNIT)] {
            let mut before = 0;
            for (_, row) in recorder.kept.frames.rows() {
                // Far away it stays at the largest number; what isn't finite becomes 0.
                let now = (row[BLOCK_FRAME * block + k] / unit).round().clamp(-1e15, 1e15) as i64;
                packed.push_signed(now - before);
                before = now;
            }
        }
        packed.text()
    };
    PackedFrames { length, angle: ANGLE_UNIT, blocks: (0..blocks).map(of_block).collect() }
}

fn network(recorder: &PageRecorder) -> NetworkData {
    let scenery = &recorder.scenery;
    let times: Vec<f64> = recorder.kept.frames.rows().map(|(t, _)| t).collect();
    let pictures = || recorder.kept.network.pictures(times.len());
    let mut numbers: Vec<u32> = pictures().flatten().map(|link| link.pair).collect();
    numbers.sort_unstable();
    numbers.dedup();
    numbers.retain(|pair| scenery.bodies_of(*pair).is_some());
    let bodies = numbers.iter().filter_map(|pair| {
        let (block, other) = scenery.bodies_of(*pair)?;
        let other = match other {
            SupportingBody::Block(other) => other as i64,
            SupportingBody::Ground => -1,
            SupportingBody::Beam(beam) => -2 - beam as i64,
        };
        Some((block, other))
    });
    let mut data = NetworkData { pairs: bodies.collect(), largest: Vec::new(), links: Vec::new() };
    for (picture, links) in pictures().enumerate() {
        let duration = picture.checked_sub(1).map_or(1.0, |before| times[picture] - times[before]);
        let size = |link: &Link| link.impulse[0].hypot(link.impulse[1]) / duration;
        let largest = links.iter().map(size).fold(0.0, f64::max);
        let (mut packed, mut before) = (Packed::default(), 0);
        for link in links {
            let (Ok(number), Some(place)) = (numbers.binary_search(&link.pair), link.place()) else { continue };
            let force = (size(link) / largest * FORCE_STEPS).round() as u64;
            if force == 0 {
                continue;
            }
            packed.push((number - before) as u64);
            before = number;
            packed.push(force);
            let reach = scenery.blocks[data.pairs[number].0].reach;
            place.into_iter().for_each(|x| packed.push_signed((x / reach * PLACE_STEPS).round() as i64));
        }
        data.largest.push(digits(largest));
        data.links.push(packed.text());
    }
    data
}

fn crowd(recorder: &PageRecorder, panels: &Panels) -> CrowdData {
    // A picture doesn't show more.
    let short = |values: Vec<f64>| values.into_iter().map(|x| rounded(x, 4)).collect::<Vec<f64>>();
    let band = |first: usize| (first..first + BAND_COLUMNS).map(|k| short(panels.curves.curve(k))).collect();
    let chosen = |curve: CrowdCurve| {
        let (chosen, values): (Vec<usize>, Vec<_>) = curve.chosen.into_iter().unzip();
        let values = values.into_iter().map(short).collect();
        ChosenData { bands: curve.bands.into_iter().map(short).collect(), chosen, values }
    };
    CrowdData {
        names: BAND_NAMES,
        phi: band(0),
        omega: band(BAND_COLUMNS),
        turns: chosen(CrowdCurve::turns(recorder)),
        distances: chosen(CrowdCurve::distances(recorder)),
    }
}

fn loads(recorder: &PageRecorder) -> Vec<LoadData> {
    let factor = |history: &History| {
        let signal = history.signal();
        recorder.kept.frames.rows().map(|(t, _)| rounded(signal.value(t), 4)).collect()
    };
    let on_blocks = recorder.scenery.forces.iter().map(|force| LoadData {
        name: force.name.clone(),
        block: Some(force.block),
        beam: None,
        force: force.force,
        couple: force.couple,
        span: [0.0; 2],
        speed: 0.0,
        factor: factor(&force.history),
    });
    let on_beams = recorder.scenery.loads.iter().map(|load| {
        let (up, couple, span, speed) = match load.kind {
            LoadKind::Point { at, force, couple } => (force, couple, [at; 2], 0.0),
            LoadKind::Distributed { load, from, to } => (load * (to - from), 0.0, [from, to], 0.0),
            LoadKind::Moving { force, at, speed } => (force, 0.0, [at; 2], speed),
        };
        LoadData {
            name: load.name.clone(),
            block: None,
            beam: Some(load.beam),
            force: [0.0, up],
            couple,
            span,
            speed,
            factor: factor(&load.history),
        }
    });
    on_blocks.chain(on_beams).collect()
}

fn time_panels(panels: &Panels) -> Vec<PanelData> {
    let panel = |panel: &super::panels::TimePanel| PanelData {
        id: panel.id.clone(),
        title: match &panel.of_contact {
            Some((_, name)) if !name.is_empty() => format!("{}, {name}", panel.title),
            _ => panel.title.clone(),
        },
        contact: panel.of_contact.as_ref().map(|(pair, _)| *pair),
        unit: panel.unit.clone(),
        least: digits(panel.least),
        guides: panel.guides.iter().copied().map(digits).collect(),
        cut: panel.cut,
        late: panel.place == Place::Forces,
        series: panel
            .lines
            .iter()
            .map(|line| SeriesData {
                label: line.label.clone(),
                index: line.number,
                at_borders: line.at_borders,
                y: course(line.y.iter()),
            })
            .collect(),
    };
    panels.panels.iter().map(panel).collect()
}

fn portraits(panels: &Panels) -> Vec<PortraitData> {
    let portrait = |portrait: &super::panels::Portrait| PortraitData {
        id: portrait.id,
        title: portrait.title.clone(),
        x_label: format!("{} ({})", portrait.x_label, portrait.x_unit),
        unit: portrait.y_unit.clone(),
        least: portrait.least.map(digits),
        guides: portrait.guides.iter().copied().map(digits).collect(),
        series: portrait
            .lines
            .iter()
            .map(|line| {
                let [x, y] = [&line.x, &line.v].map(|values| course(values.iter()));
                let t = line.t.iter().copied().map(time).collect();
                PortraitSeries { label: line.label.clone(), index: line.number, t, x, y }
            })
            .collect(),
    };
    panels.portraits.iter().map(portrait).collect()
}

fn forces(recorder: &PageRecorder, panels: &Panels) -> ForceData {
    let window = means::window(&panels.curves);
    let contacts = recorder.scenery.contacts.iter().enumerate();
    let all = contacts.flat_map(|(contact, drawn)| (0..drawn.points.len()).map(move |point| (contact, drawn, point)));
    let points = all.filter_map(|(contact, drawn, point)| {
        let forces = panels.forces[drawn.first + point].as_ref()?;
        let state = forces.state.iter().map(|state| match state {
            ContactState::Open => 'o',
            ContactState::Stick => 'k',
            ContactState::Slip => 'l',
        });
        Some(PointForces {
            contact,
            point,
            normal: forces.normal.iter().copied().map(digits).collect(),
            mean: means::normal(&panels.curves, forces, window).map(|means| means.into_iter().map(digits).collect()),
            tangential: forces.tangential.iter().copied().map(digits).collect(),
            state: state.collect(),
        })
    });
    ForceData {
        borders: panels.curves.borders().into_iter().map(time).collect(),
        prefix: panels.force_unit.0,
        factor: panels.force_unit.1,
        window: with_digits(window, "s", 3),
        frictionless: (0..panels.tangential.len()).filter(|pair| !panels.tangential[*pair]).collect(),
        points: points.collect(),
    }
}
